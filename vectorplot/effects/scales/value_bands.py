"""Triangles cut where a number at their corners, linear in each, comes to some levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.cuts.divided_triangles import divided_triangles
from vectorplot.geometry.mesh import TRIANGLE
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


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
    points = whole.points
    # What is on the level but for rounding is on it: else a level line along sides goes to and fro.
    slack = ZERO_OF_EXTENT * float(np.ptp(whole.values)) if len(whole.values) else 0.0
    values = np.where(np.abs(whole.values - level) <= slack, level, whole.values)
    cut = divided_triangles(whole.triangles, values < level)
    a, b = cut.low, cut.high
    share = ((level - values[a]) / (values[b] - values[a]))[:, None]
    way = points[b] - points[a]
    # Exact at both ends.
    between = np.where(share < 0.5, points[a] + share * way, points[b] - (1.0 - share) * way)
    every = np.concatenate([points, between])
    all_values = np.concatenate([values, np.full(len(a), level)])
    return Valued(every, all_values, cut.below), Valued(every, all_values, cut.above)


def _used(part: Valued) -> Valued:
    """The same, with the points that triangles with three different corners have, and these."""
    a, b, c = (part.points[part.triangles[:, k]] for k in range(TRIANGLE))
    real = part.triangles[(a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)]
    used, corners = np.unique(real, return_inverse=True)
    return Valued(part.points[used], part.values[used], corners.reshape(-1, TRIANGLE))
