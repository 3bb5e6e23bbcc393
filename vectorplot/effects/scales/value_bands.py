"""Triangles cut where a number at their corners, linear in each, comes to some levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

TRIANGLE = 3


@dataclass(frozen=True, eq=False)
class Valued:
    """Triangles (t,3) of points (n,3), with a number (n,) at each."""

    points: Floats
    values: Floats
    triangles: Ints


def bands(whole: Valued, levels: Floats) -> list[Valued]:
    """The parts between ascending levels (k,), one more than these, the lowest first; some may have no triangle."""
    found = []
    for level in levels.tolist():
        low, whole = _cut(whole, level)
        found.append(_used(low))
    return [*found, _used(whole)]


def _cut(whole: Valued, level: float) -> tuple[Valued, Valued]:
    """What is below a level, and what is not."""
    triangles, points = whole.triangles, whole.points
    # What is on the level but for rounding is on it: else a level line along sides goes to and fro.
    slack = ZERO_OF_EXTENT * float(np.ptp(whole.values)) if len(whole.values) else 0.0
    values = np.where(np.abs(whole.values - level) <= slack, level, whole.values)
    below = (values < level)[triangles]
    count = below.sum(axis=1)
    row = np.flatnonzero(count % TRIANGLE != 0)
    alone = count[row] == 1
    lone = np.where(alone, below[row].argmax(axis=1), (~below[row]).argmax(axis=1))
    corner, after, before = (triangles[row, (lone + k) % TRIANGLE] for k in range(TRIANGLE))
    one, two = np.concatenate([corner, corner]), np.concatenate([after, before])
    low, high = np.minimum(one, two), np.maximum(one, two)
    _, first, side = np.unique(low * len(points) + high, return_index=True, return_inverse=True)
    a, b = low[first], high[first]
    share = ((level - values[a]) / (values[b] - values[a]))[:, None]
    way = points[b] - points[a]
    # Exact at both ends.
    between = np.where(share < 0.5, points[a] + share * way, points[b] - (1.0 - share) * way)
    every = np.concatenate([points, between])
    all_values = np.concatenate([values, np.full(len(a), level)])
    out, back = len(points) + side[: len(row)], len(points) + side[len(row) :]
    tip = np.stack([corner, out, back], axis=1)
    rest = np.concatenate([np.stack([out, after, before], axis=1), np.stack([out, before, back], axis=1)])
    twice = np.concatenate([alone, alone])
    lower = np.concatenate([triangles[count == TRIANGLE], tip[alone], rest[~twice]])
    upper = np.concatenate([triangles[count == 0], tip[~alone], rest[twice]])
    return Valued(every, all_values, lower), Valued(every, all_values, upper)


def _used(part: Valued) -> Valued:
    """The same, with the points that triangles with three different corners have, and these."""
    a, b, c = (part.points[part.triangles[:, k]] for k in range(TRIANGLE))
    real = part.triangles[(a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)]
    used, corners = np.unique(real, return_inverse=True)
    return Valued(part.points[used], part.values[used], corners.reshape(-1, TRIANGLE))
