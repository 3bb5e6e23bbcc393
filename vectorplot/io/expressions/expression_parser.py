"""Formulas read: a text cut into tokens, and the precedence of operators."""

from __future__ import annotations

import re
from math import isfinite, pi
from typing import NoReturn

from vectorplot.errors import InputError
from vectorplot.io.expressions.expression_nodes import OPERATIONS, Nodes
from vectorplot.words import nearest

MAX_LENGTH = 10_000
"""A formula has no more characters than this."""

MAX_DEPTH = 50
"""Parentheses, signs and powers are nested no deeper than this."""

MAX_NODES = 2_000
"""A formula has no more operations, numbers and names than this, equal ones counted once."""

CONSTANTS = {"pi": pi, "e": 2.718281828459045, "tau": 2 * pi}
"""Names of numbers."""

_OPERATORS = ("add", "subtract", "multiply", "divide", "negative", "power", "choose")
_PAIRED = ("atan2", "mod")
_FOLDED = ("min", "max", "hypot")

FUNCTIONS = tuple(word for word in OPERATIONS if word not in _OPERATORS)
"""Names of functions: of one argument; of two for atan2 and mod; of two or more for min, max and hypot."""

_TOKEN = re.compile(r"\s*((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[A-Za-z_]\w*|\*\*|[-+*/^(),])", re.ASCII)
_BLANKS = " \t\n\r\f\v"
_BINARY = {
    "+": (1, "add"),
    "-": (1, "subtract"),
    "*": (2, "multiply"),
    "/": (2, "divide"),
    "^": (4, "power"),
    "**": (4, "power"),
}
_SIGN = 3
"""A sign binds weaker than a power, stronger than a product: -x^2 is -(x^2)."""

_OPERAND = "a number, a name, '(' or a sign"


class Parser:
    """One formula on its way into nodes."""

    def __init__(self, text: str, variables: tuple[str, ...], file: str | None, line: int | None) -> None:
        self.tape = Nodes()
        self._text, self._variables, self._file, self._line = text, variables, file, line
        self._depth = 0
        if len(text) > MAX_LENGTH:
            raise InputError(f"a formula of {len(text)} characters, at most {MAX_LENGTH}", file=file, line=line)
        self._tokens: list[str] = []
        self._starts: list[int] = []
        end = 0
        while match := _TOKEN.match(text, end):
            self._tokens.append(match[1])
            self._starts.append(match.start(1))
            end = match.end()
        self._tokens.append("")
        self._starts.append(end + len(text[end:]) - len(text[end:].lstrip(_BLANKS)))
        if self._starts[-1] < len(text):
            self._fail(len(self._tokens) - 1, "expected a number, a name or an operator")
        self._next = 0

    def formula(self) -> int:
        """The place of the whole formula among the nodes."""
        place = self._expression(0)
        if self._token:
            hint = "" if not self._starts_operand(self._token) else "; a product is written with *"
            self._fail(self._next, "expected an operator" + hint)
        return place

    @property
    def _token(self) -> str:
        return self._tokens[self._next]

    def _starts_operand(self, token: str) -> bool:
        return token == "(" or token[:1].isalnum() or token[:1] in ("_", ".")

    def _fail(self, index: int, cause: str) -> NoReturn:
        start = self._starts[index]
        token = self._tokens[index] or self._text[start : start + 1]
        got = f"got '{token[:40]}'" if token else "got the end"
        around = self._text[max(start - 20, 0) : start + 20]
        before = "..." if start > 20 else ""
        after = "..." if start + 20 < len(self._text) else ""
        place = f"position {start + 1} of '{before}{around}{after}'"
        raise InputError(f"{place}: {cause}, {got}", file=self._file, line=self._line)

    def _enter(self) -> None:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._fail(self._next, f"nested deeper than {MAX_DEPTH}")

    def _expression(self, weakest: int) -> int:
        """Operands and the operators between them that bind stronger than the weakest."""
        self._enter()
        left = self._operand()
        while self._token in _BINARY and _BINARY[self._token][0] > weakest:
            strength, operation = _BINARY[self._token]
            self._next += 1
            # A power groups from the right, and its exponent may have a sign.
            right = self._expression(strength - 1 if operation == "power" else strength)
            left = self._apply(operation, left, right)
        self._depth -= 1
        return left

    def _operand(self) -> int:
        token = self._token
        if token == "-" or token == "+":
            self._next += 1
            place = self._expression(_SIGN)
            return self._apply("negative", place) if token == "-" else place
        if token == "(":
            self._next += 1
            place = self._expression(0)
            self._expect(")", "an operator or ')'")
            return place
        if token[:1].isdigit() or token[:1] == ".":
            return self._number()
        if token[:1].isalpha() or token[:1] == "_":
            return self._name()
        self._fail(self._next, f"expected {_OPERAND}")

    def _expect(self, token: str, what: str) -> None:
        if self._token != token:
            self._fail(self._next, f"expected {what}")
        self._next += 1

    def _number(self) -> int:
        value = float(self._token)
        if not isfinite(value):
            self._fail(self._next, "expected a finite number")
        self._next += 1
        return self.tape.number(value)

    def _name(self) -> int:
        name = self._token
        called = self._tokens[self._next + 1] == "("
        if name in FUNCTIONS:
            self._next += 1
            return self._call(name)
        if called and name not in self._variables and name not in CONSTANTS:
            self._fail(self._next, _unknown("function", name, FUNCTIONS))
        if name not in self._variables and name not in CONSTANTS:
            self._fail(self._next, _unknown("name", name, (*self._variables, *CONSTANTS)))
        self._next += 1
        return self.tape.number(CONSTANTS[name]) if name in CONSTANTS else self.tape.variable(name)

    def _call(self, name: str) -> int:
        self._expect("(", f"'(' after {name}")
        arguments = [self._expression(0)]
        least = 2 if name in _PAIRED or name in _FOLDED else 1
        while self._token == "," and (len(arguments) < least or name in _FOLDED):
            self._next += 1
            arguments.append(self._expression(0))
        count = "two or more arguments" if name in _FOLDED else "one argument" if least == 1 else "two arguments"
        self._expect(")" if len(arguments) >= least else ",", f"an operator or ',' or ')': {name} takes {count}")
        if least == 1:
            return self._apply(name, arguments[0])
        place = arguments[0]
        for argument in arguments[1:]:
            place = self._apply(name, place, argument)
        return place

    def _apply(self, operation: str, *operands: int) -> int:
        place = self.tape.apply(operation, *operands)
        if len(self.tape.nodes) > MAX_NODES:
            self._fail(self._next, f"more than {MAX_NODES} operations")
        return place


def _unknown(kind: str, name: str, known: tuple[str, ...]) -> str:
    close = name.lower() if name.lower() in known else nearest(name, known)
    meant = f"did you mean '{close}'" if close else "known are " + " ".join(known)
    return f"unknown {kind} ({meant})"
