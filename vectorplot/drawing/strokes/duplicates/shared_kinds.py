"""Lines of several bodies that lie on each other in space are of one kind.

Where bodies touch, a contour of one may lie on a crease of the other. Both are there or both are hidden; but rounded
coordinates, such as those of files in single precision, put now the one and now the other in front.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.strokes.duplicates.duplicates import nearly_collinear, pairs_in_crowds
from vectorplot.exact import intervals
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import ONE_LINE_OF_EXTENT
from vectorplot.tolerances.of_lengths import COLLINEAR_OF_LENGTH
from vectorplot.visibility.polyhedra.lines import Lines, joined_lines
from vectorplot.words import LineKind


def with_shared_kinds(view: View, lines: Lines) -> Lines:
    """The lines; creases are contours where contours of other items lie on them in space.

    Only straight lines are looked at. Degenerate: lines of one item stay as they are.
    """
    straight = ~lines.smooth & np.isin(lines.kind, (LineKind.CONTOUR, LineKind.CREASE))
    which = np.flatnonzero(straight & _in_front(view, lines))
    if not len(which) or (lines.item[which] == lines.item[which[0]]).all():
        return lines
    start, end = (np.ascontiguousarray(view.image_of(p.take(which, axis=1)).T) for p in (lines.start, lines.end))
    long = np.flatnonzero(np.hypot(*(end - start).T) > ONE_LINE_OF_EXTENT)
    which, start, end = which[long], start[long], end[long]
    contour = lines.kind[which] == LineKind.CONTOUR
    if contour.all() or not contour.any():
        return lines
    number = np.arange(len(which))
    owner, starts = nearly_collinear(start, end, ONE_LINE_OF_EXTENT, number)
    run = ragged.owner(np.diff(starts))
    mixed = np.zeros((2, len(starts)), dtype=np.bool_)
    mixed[contour[owner].astype(np.intp), run] = True
    kept = (mixed[0] & mixed[1])[run]
    owner, run = owner[kept], run[kept]
    order = np.lexsort((~contour[owner], run))
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for one, other in pairs_in_crowds(owner[order], run, number):
        apart = contour[one] & ~contour[other] & (lines.item[which[one]] != lines.item[which[other]])
        outline, crease = which[one[apart]], which[other[apart]]
        on, low, high = _common(lines, outline, crease)
        found.append((crease[on], low[on], high[on]))
    crease, low, high = (np.concatenate(column) for column in zip(*found, strict=True))
    return _promoted(view, lines, crease, low, high)


def _in_front(view: View, lines: Lines) -> Bools:
    """(n,) the lines that lie before the eye."""
    near = [view.depth_of(points) > view.near for points in (lines.start, lines.end)]
    return np.asarray(near[0] & near[1])


def _common(lines: Lines, one: Ints, other: Ints) -> tuple[Bools, Floats, Floats]:
    """Which pairs of lines lie on each other in space, and from where to where (of each other) they do."""
    ends = [np.stack([lines.start.take(which, axis=1), lines.end.take(which, axis=1)]) for which in (one, other)]
    ways = [pair[1] - pair[0] for pair in ends]
    lengths = [np.sqrt((way * way).sum(axis=0)) for way in ways]
    shorter = lengths[0] <= lengths[1]
    short, long = (np.where(shorter, a, b) for a, b in ((ends[0], ends[1]), (ends[1], ends[0])))
    unit = np.where(shorter, ways[1] / lengths[1], ways[0] / lengths[0])
    arms = short - long[0]
    across = arms - (arms * unit).sum(axis=1, keepdims=True) * unit
    off = np.sqrt((across * across).sum(axis=1).max(axis=0))
    close = np.minimum(ONE_LINE_OF_EXTENT, COLLINEAR_OF_LENGTH * np.minimum(*lengths))
    places = ((ends[0] - ends[1][0]) * ways[1]).sum(axis=1) / lengths[1] ** 2
    low, high = (np.clip(edge, 0.0, 1.0) for edge in (places.min(axis=0), places.max(axis=0)))
    return np.asarray((off <= close) & ((high - low) * lengths[1] > ONE_LINE_OF_EXTENT)), low, high


def _promoted(view: View, lines: Lines, crease: Ints, low: Floats, high: Floats) -> Lines:
    """The lines with the parts from low to high (k,) of creases (k,) as contours."""
    if not len(crease):
        return lines
    touched, number = np.unique(crease, return_inverse=True)
    gap = ONE_LINE_OF_EXTENT / np.linalg.norm(lines.end[:, touched] - lines.start[:, touched], axis=0)
    number, low, high = intervals.union(number, low, high, gap)
    low, high = np.where(low <= gap[number], 0.0, low), np.where(high >= 1.0 - gap[number], 1.0, high)
    left, left_low, left_high = intervals.complement(len(touched), number, low, high, gap)
    shared = lines.cut(view, touched[number], low, high)
    return joined_lines(
        [
            lines.some(~np.isin(np.arange(len(lines)), touched)),
            replace(shared, kind=np.full_like(shared.kind, int(LineKind.CONTOUR))),
            lines.cut(view, touched[left], left_low, left_high),
        ]
    )
