"""The parts of circles that lie to one side of planes."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.exact import intervals
from vectorplot.geometry.elementary import arccos, arctan2
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances.of_lengths import UNION_OF_SEGMENT
from vectorplot.visibility.polyhedra.hidden_lines import SLIVER


def parts_inside(
    circles: tuple[Floats, Floats, Floats], circle: Ints, forms: Floats, tolerance: float
) -> tuple[Ints, Floats, Floats]:
    """The parts of circles that are nowhere outside of planes: which circle (k,), and from where to where (k,) in its
    angle.

    circles: middles and conjugate radii (n,3); forms (p,4) of unit gradient, negative outside, each for a circle (p,).
    Parts below ten tolerances are left out. Degenerate: what is not finite cuts nothing.
    """
    middle, first, second = circles
    # Outside of the plane where base + reach cos(t - turn) < 0.
    base = dot(middle[circle], forms[:, :3]) + forms[:, 3]
    x, y = dot(first[circle], forms[:, :3]), dot(second[circle], forms[:, :3])
    reach, turn = np.hypot(x, y), arctan2(y, x)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = arccos(np.clip(base / reach, -1.0, 1.0))
    out = np.isfinite(base) & (base < reach)
    circle, turn, half = circle[out], turn[out], np.where(base[out] <= -reach[out], np.pi, half[out])
    low = np.mod(turn + np.pi - half, 2.0 * np.pi) / (2.0 * np.pi)
    high = low + half / np.pi
    round_ = high > 1.0
    owner = np.concatenate([circle, circle[round_]])
    low, high = np.concatenate([low, np.zeros(round_.sum())]), np.concatenate([np.minimum(high, 1.0), high[round_] - 1])
    gap = np.full(len(middle), UNION_OF_SEGMENT)
    of, low, high = intervals.complement(len(middle), *intervals.union(owner, low, high, gap), gap)
    radius = np.sqrt(np.maximum(dot(first, first), dot(second, second)))[of]
    long = (high - low) * 2.0 * np.pi * radius > SLIVER * tolerance
    return of[long], low[long] * 2.0 * np.pi, high[long] * 2.0 * np.pi
