"""Triangles divided until a number is linear in each of them, nearly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conforming_triangles import divided
from vectorplot.geometry.triangles.triangle_edges import edges_of
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

LOOKS = (0.21, 0.5, 0.79)
"""Where on sides the number is compared with its ends; uneven, so that waves are not met in step."""

ROUNDS = 12
"""Times that a side is halved at most."""

MOST = 60_000
"""Triangles of a body: what jumps is never linear."""


def linear_triangles(
    points: Floats, triangles: Ints, numbers: Callable[[Floats], Floats], far: float
) -> tuple[Floats, Ints]:
    """Points (n,3) and triangles (t,3) with sides halved where a number, at points (m,3), is farther than that from
    linear along them; neighbours share all points, and the first points are those given.

    Degenerate: what is not finite is left as it is; sides are halved until there are MOST triangles; none where far is
    0.
    """
    if far <= 0.0:
        return points, triangles
    for _ in range(ROUNDS):
        edges, sides, _ = edges_of(triangles, len(points))
        split = np.flatnonzero(_is_bent(points[edges], numbers, far))
        middle = np.full(len(edges), -1, dtype=np.intp)
        middle[split] = len(points) + np.arange(len(split))
        if not len(split) or len(triangles) + int((middle[sides] >= 0).sum()) > MOST:
            break
        points = np.concatenate([points, points[edges[split]].mean(axis=1)])
        triangles, _ = divided(triangles, middle[sides], points)
    return points, triangles


def reached(points: Floats, triangles: Ints, numbers: Callable[[Floats], Floats]) -> float:
    """How far the numbers at points of the sides of triangles are apart; 0 where they differ by rounding alone."""
    edges, _, _ = edges_of(triangles, len(points))
    ends = points[edges]
    parts = np.array([0.0, *LOOKS, 1.0])[:, None, None]
    values = numbers((ends[:, 0] + parts * (ends[:, 1] - ends[:, 0])).reshape(-1, 3))
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0
    low, high = float(values.min()), float(values.max())
    apart = high / 2.0 - low / 2.0
    return 2.0 * apart if apart > ZERO_OF_EXTENT * max(abs(low), abs(high)) else 0.0


def _is_bent(ends: Floats, numbers: Callable[[Floats], Floats], far: float) -> Bools:
    """(e,) along which sides (e,2,3) the number is not linear."""
    first, last = numbers(ends[:, 0]), numbers(ends[:, 1])
    found = np.zeros(len(ends), dtype=np.bool_)
    with np.errstate(invalid="ignore", over="ignore"):
        for part in LOOKS:
            on = numbers(ends[:, 0] + part * (ends[:, 1] - ends[:, 0]))
            found |= np.abs(on - (first + part * (last - first))) > far
    return found
