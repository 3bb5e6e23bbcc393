"""Which convex bodies are apart: told by planes between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot

ROUNDS = 48
"""Steps of the search for a plane between two bodies: those that are apart by a hundredth of their size need a few."""

Farthest = Callable[[Ints, Floats], Floats]
"""The points (k,3) of some bodies (k,) that reach as far in directions (k,3) as these do."""


@dataclass(frozen=True, eq=False)
class Convex:
    """Convex bodies, by the points in which they reach farthest."""

    farthest: Farthest
    which: Ints

    def some(self, index: Ints) -> Convex:
        """Some of the bodies."""
        return Convex(self.farthest, self.which[index])

    def at(self, directions: Floats) -> Floats:
        """(k,3) the points that are farthest in directions (k,3)."""
        return self.farthest(self.which, directions)


def are_apart(one: Convex, other: Convex, guesses: Iterator[Floats], tolerance: float) -> Bools:
    """(k,) which pairs of bodies have a plane between them, or one that both touch.

    guesses: normals (k,3) of planes that may be such. Degenerate: bodies that touch in a plane that is not among the
    guesses, or are nearer to each other than about a thousandth of their size, may not be found to be apart.
    Source: Gilbert, Johnson and Keerthi, a fast procedure for computing the distance between complex objects; of it the
    step along a line, which needs the points farthest in a direction only.
    """
    result = np.zeros(len(one.which), dtype=np.bool_)
    for normals in guesses:
        left = np.flatnonzero(~result)
        for sign in (1.0, -1.0):
            result[left] |= _separates(one.some(left), other.some(left), sign * normals[left], tolerance)
    left = np.flatnonzero(~result)
    one, other = one.some(left), other.some(left)
    start = np.broadcast_to(np.array([1.0, 0.0, 0.0]), (len(left), 3))
    between = one.at(start) - other.at(-start)
    for _ in range(ROUNDS):
        if not len(left):
            break
        # The differences of points of both are a convex body too: is there a plane between it and the origin?
        next_ = one.at(-between) - other.at(between)
        length = np.sqrt(dot(between, between))
        apart = (dot(between, next_) >= -tolerance * length) & (length > 0.0)
        result[left[apart]] = True
        step = between - next_
        square = dot(step, step)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.clip(np.where(square > 0.0, dot(between, step) / square, 0.0), 0.0, 1.0)
        between = between - part[:, None] * step
        kept = np.flatnonzero(~apart & (length > tolerance))
        left, between, one, other = left[kept], between[kept], one.some(kept), other.some(kept)
    return result


def _separates(one: Convex, other: Convex, normals: Floats, tolerance: float) -> Bools:
    """(k,) whether planes with these normals (k,3), of any length, lie between bodies, the one before the other."""
    size = np.sqrt(dot(normals, normals))
    gap = dot(other.at(-normals) - one.at(normals), normals)
    return np.asarray((gap >= -tolerance * size) & (size > 0.0))
