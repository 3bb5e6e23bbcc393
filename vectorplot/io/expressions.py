"""Formulas as text -> expressions: parsed without running code, with derivatives, evaluated with equal parts shared."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, log, pi
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.errors import InputError
from vectorplot.geometry import elementary
from vectorplot.words import nearest

# The parts of an expression: operations in the order of their evaluation, equal ones shared.

Values = NDArray[Any]
"""Arrays of float64 or complex128."""


@dataclass(frozen=True)
class Node:
    """One operation: its word, the places of its operands, and the number or name if it is a leaf."""

    operation: str
    operands: tuple[int, ...] = ()
    number: float = 0.0
    name: str = ""


def _by_real_part(first: Values, second: Values) -> Values:
    return np.asarray(np.real(first) <= np.real(second))


def _abs(x: Values) -> Values:
    return np.where(np.real(x) < 0, -x, x) if np.iscomplexobj(x) else np.abs(x)


def _sign(x: Values) -> Values:
    return np.asarray(np.sign(np.real(x)))


def _floor(x: Values) -> Values:
    return np.asarray(np.floor(np.real(x)))


def _ceil(x: Values) -> Values:
    return np.asarray(np.ceil(np.real(x)))


def _cbrt(x: Values) -> Values:
    if not np.iscomplexobj(x):
        return elementary.cbrt(x)
    side = np.where(np.real(x) < 0, -1.0, 1.0)
    return np.asarray(side * (side * x) ** (1 / 3))


def _atan2(y: Values, x: Values) -> Values:
    angle = elementary.arctan2(np.real(y), np.real(x))
    if not np.iscomplexobj(y) and not np.iscomplexobj(x):
        return np.asarray(angle)
    # Turned by the angle of the real parts the point lies beside the positive real axis, where arctan is safe.
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(angle + np.arctan((y * cosine - x * sine) / (x * cosine + y * sine)))


def _hypot(x: Values, y: Values) -> Values:
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        return np.asarray(np.sqrt(x * x + y * y))
    return np.asarray(np.hypot(x, y))


def _min(x: Values, y: Values) -> Values:
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        return np.where(_by_real_part(x, y), x, y)
    return np.asarray(np.minimum(x, y))


def _max(x: Values, y: Values) -> Values:
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        return np.where(_by_real_part(x, y), y, x)
    return np.asarray(np.maximum(x, y))


def _mod(x: Values, y: Values) -> Values:
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        return np.asarray(x - y * np.floor(np.real(x) / np.real(y)))
    return np.asarray(np.mod(x, y))


def _choose(x: Values, y: Values, lower: Values, upper: Values) -> Values:
    """Lower where x <= y, upper where x > y, else NaN."""
    a, b = np.real(x), np.real(y)
    return np.where(a <= b, lower, np.where(a > b, upper, np.nan))


def _power(x: Values, y: Values) -> Values:
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        return np.asarray(np.power(x, y))
    return elementary.power(x, y)


def _by_kind(real: Callable[[Values], Values], of_complex: Callable[[Values], Values]) -> Callable[[Values], Values]:
    """The first function on real arrays, the second one on complex ones."""
    return lambda x: of_complex(x) if np.iscomplexobj(x) else real(x)


OPERATIONS: Mapping[str, Callable[..., Values]] = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negative": np.negative,
    "power": _power,
    "sin": np.sin,
    "cos": np.cos,
    "tan": _by_kind(elementary.tan, np.tan),
    "asin": _by_kind(elementary.arcsin, np.arcsin),
    "acos": _by_kind(elementary.arccos, np.arccos),
    "atan": _by_kind(elementary.arctan, np.arctan),
    "atan2": _atan2,
    "sinh": _by_kind(elementary.sinh, np.sinh),
    "cosh": _by_kind(elementary.cosh, np.cosh),
    "tanh": _by_kind(elementary.tanh, np.tanh),
    "exp": _by_kind(elementary.exp, np.exp),
    "log": _by_kind(elementary.log, np.log),
    "log2": np.log2,
    "log10": np.log10,
    "sqrt": np.sqrt,
    "cbrt": _cbrt,
    "abs": _abs,
    "sign": _sign,
    "floor": _floor,
    "ceil": _ceil,
    "min": _min,
    "max": _max,
    "hypot": _hypot,
    "mod": _mod,
    "choose": _choose,
}
"""What each operation computes, on arrays. On complex ones it continues the real function from the real axis."""


class Nodes:
    """A growing list of nodes; a node that is there already is not added again, and constants are folded."""

    def __init__(self, nodes: Sequence[Node] = ()) -> None:
        self.nodes = list(nodes)
        self._places = {_key(node): place for place, node in enumerate(self.nodes)}

    def _place(self, node: Node) -> int:
        place = self._places.setdefault(_key(node), len(self.nodes))
        if place == len(self.nodes):
            self.nodes.append(node)
        return place

    def number(self, value: float) -> int:
        """The place of a constant."""
        return self._place(Node("number", number=float(value)))

    def variable(self, name: str) -> int:
        """The place of a variable."""
        return self._place(Node("variable", name=name))

    def constant(self, place: int) -> float | None:
        """The number at a place, or None if it is not constant."""
        node = self.nodes[place]
        return node.number if node.operation == "number" else None

    def apply(self, operation: str, *operands: int) -> int:
        """The place of an operation; of a number if all operands are numbers and the result is finite."""
        numbers = [np.float64(self.nodes[k].number) for k in operands if self.nodes[k].operation == "number"]
        if len(numbers) == len(operands):
            with np.errstate(all="ignore"):
                value = float(OPERATIONS[operation](*numbers))
            if np.isfinite(value):
                return self.number(value)
        return self._place(Node(operation, operands))

    def joined(self, nodes: Sequence[Node]) -> int:
        """The place of the last one of nodes from elsewhere, all of which are added."""
        places: list[int] = []
        for node in nodes:
            operands = tuple(places[k] for k in node.operands)
            places.append(self._place(Node(node.operation, operands, node.number, node.name)))
        return places[-1]

    def needed_for(self, place: int) -> tuple[Node, ...]:
        """The nodes that one depends on, in order, that one last."""
        needed = [False] * (place + 1)
        needed[place] = True
        for k in range(place, -1, -1):
            if needed[k]:
                for operand in self.nodes[k].operands:
                    needed[operand] = True
        old = [k for k in range(place + 1) if needed[k]]
        new = {k: i for i, k in enumerate(old)}
        found = [self.nodes[k] for k in old]
        return tuple(Node(n.operation, tuple(new[k] for k in n.operands), n.number, n.name) for n in found)


def _key(node: Node) -> tuple[object, ...]:
    # -0.0 equals 0.0, but is another number.
    return node.operation, node.operands, repr(node.number), node.name


def _cube(x: Values) -> Values:
    return np.asarray(x * x * x)


def _fourth(x: Values) -> Values:
    square = np.square(x)
    return np.asarray(square * square)


_POWERS: Mapping[float, Callable[[Values], Values]] = {2.0: np.square, 3.0: _cube, 4.0: _fourth}
"""What computes powers with these exponents; numpy's own takes six times as long."""


def _computed(nodes: Sequence[Node], node: Node) -> tuple[Callable[..., Values], tuple[int, ...]]:
    """What computes a node, and the places of what it is computed from."""
    if node.operation == "power" and nodes[node.operands[1]].operation == "number":
        exponent = nodes[node.operands[1]].number
        if exponent in _POWERS:
            return _POWERS[exponent], node.operands[:1]
    return OPERATIONS[node.operation], node.operands


@dataclass(frozen=True, eq=False)
class Program:
    """Nodes made ready to be evaluated again and again: for few numbers nothing takes longer than to look at them.

    leaves: the numbers at the places of numbers, None elsewhere; variables: places and names; steps: the place of a
    result, what computes it, the places of its operands, and those that are not needed any more; results: places.
    """

    leaves: tuple[Any, ...]
    variables: tuple[tuple[int, str], ...]
    steps: tuple[tuple[int, Callable[..., Values], tuple[int, ...], tuple[int, ...]], ...]
    results: tuple[int, ...]

    @classmethod
    def of(cls, nodes: Sequence[Node], results: Sequence[int]) -> Program:
        """The program of nodes for the values at some of their places."""
        last_use = {operand: place for place, node in enumerate(nodes) for operand in node.operands}
        steps = tuple(
            (
                place,
                *_computed(nodes, node),
                tuple(k for k in set(node.operands) if last_use[k] == place and k not in results),
            )
            for place, node in enumerate(nodes)
            if node.operation in OPERATIONS
        )
        numbers = tuple(np.float64(node.number) if node.operation == "number" else None for node in nodes)
        names = tuple((place, node.name) for place, node in enumerate(nodes) if node.operation == "variable")
        return cls(numbers, names, steps, tuple(results))

    def __call__(self, arrays: Mapping[str, Values]) -> list[Values]:
        """The values at the places asked for, for arrays of one shape or scalars; an array is let go after its last
        use."""
        values = list(self.leaves)
        for place, name in self.variables:
            values[place] = arrays[name]
        with np.errstate(all="ignore"):
            for place, operation, operands, done in self.steps:
                values[place] = operation(*[values[k] for k in operands])
                for k in done:
                    values[k] = None
        return [values[place] for place in self.results]


# Derivatives of expressions, node by node.

MAX_DERIVED_NODES = 100_000
"""A derivative, and a derivative of derivatives, has no more operations than this."""


def derivative_nodes(nodes: Sequence[Node], variable: str) -> tuple[Node, ...]:
    """The nodes of the derivative of the last node by a variable.

    Operations that occur twice are shared, so a derivative is a few times as long as its expression, not exponentially.
    Errors: InputError if it needs more than MAX_DERIVED_NODES.
    """
    rules = _Rules(nodes)
    slopes: list[int] = []
    for place, node in enumerate(nodes):
        if node.operation in ("number", "variable"):
            slopes.append(rules.one if node.operation == "variable" and node.name == variable else rules.zero)
        elif all(slopes[k] == rules.zero for k in node.operands):
            slopes.append(rules.zero)
        else:
            slopes.append(rules.slope(place, [slopes[k] for k in node.operands]))
        if len(rules.tape.nodes) > MAX_DERIVED_NODES:
            raise InputError(f"the derivative by {variable} takes more than {MAX_DERIVED_NODES} operations")
    return rules.tape.needed_for(slopes[-1])


class _Rules:
    """The rules of differentiation, writing on a copy of the nodes."""

    def __init__(self, nodes: Sequence[Node]) -> None:
        self.tape = Nodes(nodes)
        self.zero = self.tape.number(0.0)
        self.one = self.tape.number(1.0)

    def slope(self, place: int, slopes: list[int]) -> int:
        """The derivative of a node, given those of its operands."""
        node = self.tape.nodes[place]
        x = node.operands[0]
        if node.operation in _CHAIN:
            return self.times(_CHAIN[node.operation](self, x, place), slopes[0])
        if node.operation == "negative":
            return self.negative(slopes[0])
        if node.operation == "choose":
            return self.tape.apply("choose", *node.operands[:2], *slopes[2:])
        return _PAIRS[node.operation](self, place, x, node.operands[1], slopes[0], slopes[1])

    def number(self, value: float) -> int:
        return self.tape.number(value)

    def call(self, operation: str, *operands: int) -> int:
        return self.tape.apply(operation, *operands)

    def plus(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return b if a == self.zero else a
        return self.call("add", a, b)

    def minus(self, a: int, b: int) -> int:
        if b == self.zero:
            return a
        return self.negative(b) if a == self.zero else self.zero if a == b else self.call("subtract", a, b)

    def negative(self, a: int) -> int:
        node = self.tape.nodes[a]
        if a == self.zero:
            return a
        return node.operands[0] if node.operation == "negative" else self.call("negative", a)

    def times(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return self.zero
        if self.one in (a, b):
            return b if a == self.one else a
        return self.call("multiply", a, b)

    def over(self, a: int, b: int) -> int:
        return a if a == self.zero or b == self.one else self.call("divide", a, b)

    def square(self, a: int) -> int:
        return self.call("multiply", a, a)

    def reciprocal(self, a: int) -> int:
        return self.over(self.one, a)

    def power(self, a: int, exponent: int) -> int:
        value = self.tape.constant(exponent)
        return self.one if value == 0 else a if value == 1 else self.call("power", a, exponent)

    def logarithm(self, x: int, base: float) -> int:
        return self.reciprocal(self.times(x, self.number(log(base))))

    def product_slope(self, place: int, f: int, g: int, df: int, dg: int) -> int:
        return self.plus(self.times(df, g), self.times(f, dg))

    def quotient_slope(self, place: int, f: int, g: int, df: int, dg: int) -> int:
        return self.over(self.minus(df, self.times(place, dg)), g)

    def power_slope(self, place: int, f: int, g: int, df: int, dg: int) -> int:
        through_base = self.times(self.times(g, self.power(f, self.minus(g, self.one))), df)
        if dg == self.zero:
            return through_base
        return self.plus(through_base, self.times(self.times(place, self.call("log", f)), dg))

    def atan2_slope(self, place: int, y: int, x: int, dy: int, dx: int) -> int:
        top = self.minus(self.times(x, dy), self.times(y, dx))
        return self.over(top, self.plus(self.square(x), self.square(y)))

    def hypot_slope(self, place: int, x: int, y: int, dx: int, dy: int) -> int:
        return self.over(self.plus(self.times(x, dx), self.times(y, dy)), place)

    def mod_slope(self, place: int, x: int, y: int, dx: int, dy: int) -> int:
        return self.minus(dx, self.times(self.call("floor", self.over(x, y)), dy))


_CHAIN: dict[str, Callable[[_Rules, int, int], int]] = {
    "sin": lambda r, x, y: r.call("cos", x),
    "cos": lambda r, x, y: r.negative(r.call("sin", x)),
    "tan": lambda r, x, y: r.plus(r.one, r.square(y)),
    "asin": lambda r, x, y: r.reciprocal(r.call("sqrt", r.minus(r.one, r.square(x)))),
    "acos": lambda r, x, y: r.negative(r.reciprocal(r.call("sqrt", r.minus(r.one, r.square(x))))),
    "atan": lambda r, x, y: r.reciprocal(r.plus(r.one, r.square(x))),
    "sinh": lambda r, x, y: r.call("cosh", x),
    "cosh": lambda r, x, y: r.call("sinh", x),
    "tanh": lambda r, x, y: r.minus(r.one, r.square(y)),
    "exp": lambda r, x, y: y,
    "log": lambda r, x, y: r.reciprocal(x),
    "log2": lambda r, x, y: r.logarithm(x, 2.0),
    "log10": lambda r, x, y: r.logarithm(x, 10.0),
    "sqrt": lambda r, x, y: r.reciprocal(r.times(r.number(2.0), y)),
    "cbrt": lambda r, x, y: r.reciprocal(r.times(r.number(3.0), r.square(y))),
    "abs": lambda r, x, y: r.call("sign", x),
    "sign": lambda r, x, y: r.zero,
    "floor": lambda r, x, y: r.zero,
    "ceil": lambda r, x, y: r.zero,
}
"""The derivative of a function of one operand x whose value is y."""

_PAIRS: dict[str, Callable[[_Rules, int, int, int, int, int], int]] = {
    "add": lambda r, place, f, g, df, dg: r.plus(df, dg),
    "subtract": lambda r, place, f, g, df, dg: r.minus(df, dg),
    "multiply": _Rules.product_slope,
    "divide": _Rules.quotient_slope,
    "power": _Rules.power_slope,
    "atan2": _Rules.atan2_slope,
    "hypot": _Rules.hypot_slope,
    "mod": _Rules.mod_slope,
    "min": lambda r, place, f, g, df, dg: r.call("choose", f, g, df, dg),
    "max": lambda r, place, f, g, df, dg: r.call("choose", f, g, dg, df),
}
"""The derivative of an operation on f and g, with their derivatives df and dg."""


# Formulas read: a text cut into tokens, and the precedence of operators.

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
    close = name.lower() if name.lower() in known else nearest(name.lower(), known)
    meant = f"did you mean '{close}'" if close else "known are " + " ".join(known)
    return f"unknown {kind} ({meant})"


# Formulas in scene files and on the command line: read by a parser of our own, never run as code.


@dataclass(frozen=True)
class Expression:
    """A formula in named variables: a function of whole arrays, and of its derivatives the source.

    text: the formula as it was written; variables: the names it may use; nodes: its operations in the order of
    evaluation, the result last.
    """

    text: str
    variables: tuple[str, ...]
    nodes: tuple[Node, ...]

    def __call__(self, **arrays: ArrayLike) -> NDArray[Any]:
        """The values of the formula.

        Edge cases: outside the domain of a function the value is NaN, at a pole infinite; no warnings.
        """
        if not self.used <= arrays.keys() or not arrays.keys() <= set(self.variables):
            raise self._misnamed(arrays)
        values = {name: np.asarray(array) for name, array in arrays.items()}
        kind = np.complex128 if any(np.iscomplexobj(array) for array in values.values()) else np.float64
        try:
            shape = np.broadcast_shapes(*(array.shape for array in values.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in values.items())
            raise InputError(f"the formula '{self._shown}' got arrays of shapes that do not fit: {shapes}") from None
        (result,) = self._program({name: array.astype(kind, copy=False) for name, array in values.items()})
        return np.array(np.broadcast_to(result, shape), dtype=kind)

    @cached_property
    def _program(self) -> Program:
        return Program.of(self.nodes, (len(self.nodes) - 1,))

    def _misnamed(self, arrays: Mapping[str, ArrayLike]) -> InputError:
        unknown = sorted(set(arrays) - set(self.variables))
        if unknown:
            return InputError(f"the formula '{self._shown}' has no variable {unknown[0]}")
        missing = sorted(self.used - set(arrays))
        return InputError(f"the formula '{self._shown}' needs a value of {missing[0]}")

    @property
    def _shown(self) -> str:
        return self.text if len(self.text) <= 60 else self.text[:57] + "..."

    @cached_property
    def used(self) -> frozenset[str]:
        """The variables that occur in the formula."""
        return frozenset(node.name for node in self.nodes if node.operation == "variable")

    def derivative(self, variable: str) -> Expression:
        """The exact partial derivative by a variable.

        Edge cases: at a kink (abs at 0, min and max of equal values) the slope of one side, or 0; at steps 0; where the
        formula has no value the derivative may have one.
        """
        if variable not in self.variables:
            raise InputError(f"the formula '{self._shown}' has no variable {variable}")
        return Expression(f"d({self.text})/d{variable}", self.variables, derivative_nodes(self.nodes, variable))


def parse_expression(
    text: str, variables: Sequence[str], *, file: str | None = None, line: int | None = None
) -> Expression:
    """The expression that a text spells, such as ``sin(u)*cosh(v/2) - 3^-u``."""
    names = tuple(variables)
    for name in names:
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
            raise InputError(f"{name[:40]!a} is no name for a variable", file=file, line=line)
        if name in FUNCTIONS or name in CONSTANTS:
            kind = "function" if name in FUNCTIONS else "constant"
            raise InputError(f"{name} is a {kind} and cannot name a variable", file=file, line=line)
    parser = Parser(text, names, file, line)
    place = parser.formula()
    return Expression(text, names, parser.tape.needed_for(place))
