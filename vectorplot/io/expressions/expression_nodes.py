"""The parts of an expression: operations in the order of their evaluation, equal ones shared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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


def _cbrt(x: Values) -> Values:
    if not np.iscomplexobj(x):
        return np.asarray(np.cbrt(x))
    side = np.where(np.real(x) < 0, -1.0, 1.0)
    return np.asarray(side * (side * x) ** (1 / 3))


def _atan2(y: Values, x: Values) -> Values:
    angle = np.arctan2(np.real(y), np.real(x))
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


OPERATIONS: Mapping[str, Callable[..., Values]] = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negative": np.negative,
    "power": np.power,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": _atan2,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "exp": np.exp,
    "log": np.log,
    "log2": np.log2,
    "log10": np.log10,
    "sqrt": np.sqrt,
    "cbrt": _cbrt,
    "abs": _abs,
    "sign": lambda x: np.sign(np.real(x)),
    "floor": lambda x: np.floor(np.real(x)),
    "ceil": lambda x: np.ceil(np.real(x)),
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


def evaluated(nodes: Sequence[Node], arrays: Mapping[str, Values]) -> Values:
    """The values of the last node, for arrays of one shape or scalars; an array is let go after its last use."""
    last_use = list(range(len(nodes)))
    for place, node in enumerate(nodes):
        for operand in node.operands:
            last_use[operand] = place
    values: list[Any] = [None] * len(nodes)
    with np.errstate(all="ignore"):
        for place, node in enumerate(nodes):
            if node.operation == "number":
                values[place] = np.float64(node.number)
            elif node.operation == "variable":
                values[place] = arrays[node.name]
            else:
                values[place] = OPERATIONS[node.operation](*(values[k] for k in node.operands))
                for operand in node.operands:
                    if last_use[operand] == place:
                        values[operand] = None
    return np.asarray(values[-1])
