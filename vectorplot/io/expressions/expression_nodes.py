"""The parts of an expression: operations in the order of their evaluation, equal ones shared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.geometry import elementary

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
