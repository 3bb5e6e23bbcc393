"""Strokes that go on where the one before them ends, as they come: chords of one curve are traced one after the other,
and need no search for what they touch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.drawing.drawing import NO_CURVE, Paths
from vectorplot.drawing.strokes.stroke_paths import chosen, world_per_mm
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import with_points

SAME_PLACE = 100.0
"""Ends further apart in the world than so many tolerances on the page lie one behind the other."""


def going_on(paths: Paths, group: Ints, tolerance_mm: float) -> Bools:
    """(m,) which strokes begin where the one before them ends, within the tolerance on the page and in the world not
    behind it, both of them open parts of one curve, smooth or not, and of equal group (m,)."""
    result = np.zeros(len(paths), dtype=np.bool_)
    drawn = ~paths.closed & (np.diff(paths.offsets) > 1) & (paths.curve != NO_CURVE)
    same = drawn[1:] & drawn[:-1]
    for said in (paths.curve, paths.smooth, group):
        same &= said[1:] == said[:-1]
    which = np.flatnonzero(same)
    first = paths.offsets[1:][which]
    for places, reach in (
        (paths.points, tolerance_mm),
        (paths.points3d, SAME_PLACE * tolerance_mm * world_per_mm(paths)),
    ):
        apart = sum((axis[first] - axis[first - 1]) ** 2 for axis in places.T)
        which, first = (part[apart <= reach * reach] for part in (which, first))
    result[which + 1] = True
    return result


def in_rows(paths: Paths, going: Bools) -> Paths:
    """The strokes with those that go on (m,) from the one before them joined to it: they are of its kind, item, count
    and curve. Curves may change their direction at the joints."""
    if not going.any():
        return paths
    head = np.flatnonzero(~going)
    dropped = paths.offsets[:-1][going]
    kept = np.ones(len(paths.points), dtype=np.bool_)
    kept[dropped] = False
    counts = np.add.reduceat(np.diff(paths.offsets) - going, head)
    rows = with_points(paths, np.flatnonzero(kept), head, ragged.offsets(counts))
    directions, handles = paths.directions.copy(), paths.handles.copy()
    for values in (directions, handles):
        values[dropped - 1, 1] = values[dropped, 1]
    return replace(rows, directions=directions[kept], handles=handles[kept])


def without_dots(paths: Paths, tolerance_mm: float) -> Paths:
    """The strokes without the open ones of two points that are no longer than the tolerance."""
    two = np.flatnonzero(~paths.closed & (np.diff(paths.offsets) == 2))
    x, y = (axis[paths.offsets[two] + 1] - axis[paths.offsets[two]] for axis in paths.points.T)
    dots = two[x * x + y * y <= tolerance_mm * tolerance_mm]
    if not len(dots):
        return paths
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[dots] = False
    return chosen(paths, kept)
