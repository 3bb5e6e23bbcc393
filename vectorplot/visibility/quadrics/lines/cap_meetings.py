"""The straight lines in which flat caps meet."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.vectors import cross, dot
from vectorplot.visibility.quadrics.lines.ruled_quadrics import Discs


def cap_meetings(one: Discs, two: Discs, tolerance: float) -> tuple[Floats, Floats, Bools]:
    """Start and end (k,3) of what caps in the same rows have in common, and whether it is anything.

    Degenerate: caps in one plane, but for the tolerance, have no line in common.
    """
    n, m = one.normal, two.normal
    way = cross(n, m)
    square = dot(way, way)
    arm = two.centre - one.centre
    reach = np.sqrt(np.fmax(dot(two.across, two.across), dot(two.along, two.along)) * square)
    apart = np.abs(dot(arm, n)) + reach > tolerance
    with np.errstate(divide="ignore", invalid="ignore"):
        # The point of both planes and of the one across them through the middle of the first cap.
        base = one.centre + (dot(arm, m) / square)[:, None] * cross(way, n)
        first, last = _inside(one, base, way)
        begin, end = _inside(two, base, way)
        low, high = np.fmax(first, begin), np.fmin(last, end)
        met = apart & np.isfinite(first + begin) & (low < high)
    low, high = np.where(met, low, 0.0), np.where(met, high, 0.0)
    base = np.where(met[:, None], base, one.centre)
    return base + low[:, None] * way, base + high[:, None] * way, met


def _inside(discs: Discs, base: Floats, way: Floats) -> tuple[Floats, Floats]:
    """Between which w base + w way is in the disc; NaN where it never is."""
    row = np.arange(len(base))
    p = np.stack(discs.plane(row, base), axis=1)
    d = np.stack(discs.plane(row, base + way), axis=1) - p
    a, b, c = dot(d, d), dot(d, p), dot(p, p) - 1.0
    root = np.sqrt(b * b - a * c)
    return (-b - root) / a, (-b + root) / a
