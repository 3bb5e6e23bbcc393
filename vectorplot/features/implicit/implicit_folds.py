"""Polylines on a smooth curve that run to and fro, straightened out."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.polylines import Polylines, closed_round

BACK = -0.7
"""Cosine between two chords below which the second runs back: that of a triangle around a tiny oval is -0.5."""


def without_folds(lines: Traces, closed: Bools) -> tuple[Traces, Bools]:
    """The polylines without the points at which they turn back: where a mesh is folded, crossings of its edges are not
    in the order in which they lie on the curve, and an arc can be met twice more, or as a closed curve of its own.

    closed (m,): which polylines are. Closed ones of which no three points are left are dropped.
    """
    kept, offsets = lines.unrepeated(closed)
    points, line = lines.points[kept], ragged.owner(np.diff(offsets))
    for _ in range(len(points)):
        back = _turns_back(points, line, closed)
        # Of two that follow one another the first goes, then it is looked at again.
        back[1:] &= ~back[:-1]
        if not back.any():
            break
        points, line = points[~back], line[~back]
    counts = np.bincount(line, minlength=len(closed))
    real = counts >= np.where(closed, 3, 2)
    left = Polylines(points[real[line]], ragged.offsets(counts[real]), closed[real])
    return Traces.of(left.points, closed_round(left)), left.closed


def _turns_back(points: Floats, line: Ints, closed: Bools) -> Bools:
    """(p,) points at which polylines turn back."""
    if not len(points):
        return np.zeros(0, dtype=np.bool_)
    first = np.concatenate([[True], line[1:] != line[:-1]])
    starts = np.flatnonzero(first)
    ends = np.append(starts[1:], len(points)) - 1
    before, after = np.arange(-1, len(points) - 1), np.arange(1, len(points) + 1)
    before[starts], after[ends] = ends, starts
    come, go = points - points[before], points[after] - points
    sizes = np.linalg.norm(come, axis=1) * np.linalg.norm(go, axis=1)
    back = (come * go).sum(axis=1) < BACK * sizes
    open_ends = ~closed[line[starts]]
    back[starts[open_ends]] = back[ends[open_ends]] = False
    return np.asarray(back, dtype=np.bool_)
