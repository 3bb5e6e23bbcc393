"""What single operations cost: of numbers in arrays, and of calls in Python."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from vectorplot.geometry.algebra import matmul
from vectorplot.speed.clock import cpu_seconds

COUNT = 1 << 18
"""So many numbers an array has: it stays in the processor's cache."""

CALLS = 50_000


@dataclass(frozen=True)
class Operation:
    """An operation and its cost: microseconds for one of them."""

    name: str
    microseconds: float


@dataclass(frozen=True)
class _Pair:
    x: float
    y: float

    def __add__(self, other: _Pair) -> _Pair:
        return _Pair(self.x + other.x, self.y + other.y)

    def total(self) -> float:
        return self.x + self.y


def array_operations() -> tuple[Operation, ...]:
    """Additions of bytes, integers and floats, and what all stages do most: multiply, divide, compare, gather, sort."""
    rng = np.random.default_rng(1)
    floats, other, index = rng.uniform(1.0, 2.0, COUNT), rng.uniform(1.0, 2.0, COUNT), rng.permutation(COUNT)
    every: list[tuple[str, Callable[[], object]]] = []
    for name, kind in (("float", np.float64), ("long", np.int64), ("int", np.int32), ("byte", np.int8)):
        a, b = floats.astype(kind), other.astype(kind)
        every.append((f"add {name}s", partial(np.add, a, b)))
    every += [
        ("multiply floats", lambda: floats * other),
        ("divide floats", lambda: floats / other),
        ("compare floats", lambda: floats < other),
        ("gather floats", lambda: floats[index]),
        ("sort longs", lambda: np.sort(index)),
        ("sort floats by index", lambda: np.argsort(floats, kind="stable")),
    ]
    return tuple(Operation(name, 1e6 * cpu_seconds(action, 7) / COUNT) for name, action in every)


def call_operations() -> tuple[Operation, ...]:
    """One sum in Python: written out, in functions that take numbers, a tuple or a record, as operator and method."""
    one, two = _Pair(1.0, 2.0), _Pair(3.0, 4.0)
    x, y = np.float64(1.0), np.float64(2.0)

    def by_value(a: float, b: float) -> float:
        return a + b

    def by_reference(pair: Sequence[float]) -> float:
        return pair[0] + pair[1]

    def by_record(pair: _Pair) -> float:
        return pair.x + pair.y

    couple = (1.0, 2.0)
    every: list[tuple[str, Callable[[], object]]] = [
        ("written out", lambda: [1.0 + k for k in range(CALLS)]),
        ("function of numbers", lambda: [by_value(1.0, k) for k in range(CALLS)]),
        ("function of a tuple", lambda: [by_reference(couple) for _ in range(CALLS)]),
        ("function of a record", lambda: [by_record(one) for _ in range(CALLS)]),
        ("method of a record", lambda: [one.total() for _ in range(CALLS)]),
        ("operator of records", lambda: [one + two for _ in range(CALLS)]),
        ("numpy of two numbers", lambda: [np.add(x, y) for _ in range(CALLS)]),
    ]
    return tuple(Operation(name, 1e6 * cpu_seconds(action) / CALLS) for name, action in every)


def point_cost() -> float:
    """What the bare work on a point costs, in microseconds: project it and put it in its place from front to back.

    Of this nothing that shows a scene can be spared; what pictures cost is told in it, so that machines do not matter.
    """
    rng = np.random.default_rng(2)
    points, axes = rng.normal(size=(3, COUNT)), rng.normal(size=(3, 3))

    def project() -> object:
        x, y, z = matmul(axes, points)
        z += 10.0
        return x / z, y / z, np.argsort(z, kind="stable")

    return 1e6 * cpu_seconds(project, 7) / COUNT
