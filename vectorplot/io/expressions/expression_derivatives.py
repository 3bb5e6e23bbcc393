"""Derivatives of expressions, node by node."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import log

from vectorplot.errors import InputError
from vectorplot.io.expressions.expression_nodes import Node, Nodes

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
