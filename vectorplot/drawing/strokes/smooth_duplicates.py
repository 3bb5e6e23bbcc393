"""Smooth curves that lie on each other are drawn once, however differently they are sampled."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.chains import NO_END, chains
from vectorplot.drawing.strokes.join import linked_ends
from vectorplot.drawing.strokes.paths import chosen
from vectorplot.tolerances.of_the_page import TOUCHING_AT_MM

HEIGHT_SHARE = 0.05
"""Between two points a curve is known but for less than this part of its height above the chord."""

TOUCHING_MM = 3.0
"""A shorter part of a curve on another one only touches it, as lines of a surface touch its contour: it stays. Curves
of a sheet of paper's size that touch in four points at once are so close over that length; where points are known less
well, over more of it, by the fourth root."""

_STEEPEST = 1.0


def without_smooth_duplicates(paths: Paths, rank: Ints, tolerance_mm: float) -> Paths:
    """The same picture without the chords of smooth curves that lie on more important smooth curves.

    paths: strokes of two points; those that are smooth are chords between points of a curve; rank (m,): equal for all
    chords of a curve, which gives way to curves of smaller rank only. A chord goes if its ends and the middle of its
    own arc lie on arcs of smaller rank, within tolerance_mm and a little of the arcs' height, and so does all
    of its curve, or TOUCHING_MM of it in a row; chords without length go too. Strokes keep their order.
    Degenerate: curves that overlap in part may go on doing so over less than a chord at the ends of the common part.
    Source: cubic Hermite arcs over the chords, with the tangents of circles through three neighbouring points.
    """
    along = paths.points[paths.offsets[1:] - 1] - paths.points[paths.offsets[:-1]]
    long = ~paths.smooth | along.any(axis=1)
    if not long.all():
        paths, rank = chosen(paths, long), rank[long]
    smooth = np.flatnonzero(paths.smooth)
    if len(smooth) < 2 or (rank[smooth] == rank[smooth[0]]).all():
        return paths
    chords = chosen(paths, smooth)
    group = np.unique(rank[smooth], return_inverse=True)[1].astype(np.intp)
    ends = chords.points.reshape(-1, 2, 2)
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    mate = linked_ends(chords, group, tolerance_mm)
    slopes = _slopes(ends, mate)
    covered = _covered(ends, slopes, group, tolerance_mm)
    if not covered.any():
        return paths
    room = tolerance_mm + HEIGHT_SHARE * float((length * np.abs(slopes).max(axis=1)).max()) / 4.0
    touching = TOUCHING_MM * (room / TOUCHING_AT_MM) ** 0.25
    covered = _in_rows(covered, mate, length, touching)
    if not covered.any():
        return paths
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[smooth[covered]] = False
    return chosen(paths, kept)


def _slopes(ends: Floats, mate: Ints) -> Floats:
    """(m,2) slopes of the curve against its chords (m,2,2) at their ends; mate (2m,) as linked_ends gives it.

    Where a curve ends its last arc is one of a circle; a chord alone is straight.
    """
    along = ends[:, 1] - ends[:, 0]
    far = ends.reshape(-1, 2)[mate ^ 1].reshape(-1, 2, 2)
    linked = (mate != NO_END).reshape(-1, 2)
    slopes = np.full(linked.shape, np.nan)
    for side, step in ((0, ends[:, 0] - far[:, 0]), (1, far[:, 1] - ends[:, 1])):
        size, other = np.hypot(*along.T), np.hypot(*step.T)
        # The tangent of the circle through three points leans to each chord as the other one is long.
        tangent = along * (other / size)[:, None] + step * (size / np.where(other > 0.0, other, 1.0))[:, None]
        rise = along[:, 0] * tangent[:, 1] - along[:, 1] * tangent[:, 0]
        run = (along * tangent).sum(axis=1)
        good = linked[:, side] & (np.abs(rise) < _STEEPEST * run)
        slopes[good, side] = rise[good] / run[good]
    slopes = np.where(np.isnan(slopes), -slopes[:, ::-1], slopes)
    return np.nan_to_num(slopes, nan=0.0)


def _covered(ends: Floats, slopes: Floats, rank: Ints, tolerance: float) -> Bools:
    """(m,) which chords (m,2,2) lie on arcs over chords of smaller rank."""
    along = ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)
    normal = np.column_stack((-along[:, 1], along[:, 0])) / length[:, None]
    height = length * np.abs(slopes).max(axis=1) / 4.0
    middle = ends.mean(axis=1) + (length * (slopes[:, 0] - slopes[:, 1]) / 8.0)[:, None] * normal
    # The ends are points of the curve; the middle is known but for a little. Few middles lie on other curves, while
    # many ends do.
    some = np.flatnonzero(rank > rank.min())
    for points, room in (
        (middle, tolerance + HEIGHT_SHARE * height),
        (ends[:, 0], np.full(len(ends), tolerance)),
        (ends[:, 1], np.full(len(ends), tolerance)),
    ):
        some = some[_on_arcs(points[some], room[some], rank[some], ends, slopes, rank, tolerance)]
    covered = np.zeros(len(ends), dtype=np.bool_)
    covered[some] = True
    return covered


def _on_arcs(
    points: Floats, room: Floats, rank: Ints, ends: Floats, slopes: Floats, arc_rank: Ints, tolerance: float
) -> Bools:
    """(k,) which points (k,2) lie within room (k,) on arcs over chords (m,2,2) of smaller rank."""
    import shapely

    on_some = np.zeros(len(points), dtype=np.bool_)
    if not len(points):
        return on_some
    along = ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)
    unit = along / length[:, None]
    height = length * np.abs(slopes).max(axis=1) / 4.0
    # Each arc looks no farther than its own height: one long chord would else call for all pairs.
    tree = shapely.STRtree(shapely.points(points))
    reach = tolerance + (1.0 + HEIGHT_SHARE) * height + HEIGHT_SHARE * float(height.max())
    arc, point = tree.query(shapely.linestrings(ends), predicate="dwithin", distance=reach)
    better = arc_rank[arc] < rank[point]
    point, arc = point[better], arc[better]
    arm = points[point] - ends[arc, 0]
    s = (arm * unit[arc]).sum(axis=1) / length[arc]
    rise = length[arc] * (slopes[arc, 0] * s * (1.0 - s) ** 2 - slopes[arc, 1] * s * s * (1.0 - s))
    off = np.abs(unit[arc, 0] * arm[:, 1] - unit[arc, 1] * arm[:, 0] - rise)
    slack = tolerance / length[arc]
    on = (s >= -slack) & (s <= 1.0 + slack) & (off <= room[point] + HEIGHT_SHARE * height[arc])
    on_some[point[on]] = True
    return on_some


def _in_rows(covered: Bools, mate: Ints, length: Floats, touching: float) -> Bools:
    """(m,) the chords of these, of some lengths, that stand in rows long enough, or are all of their curve."""
    both = np.repeat(covered, 2) & (mate != NO_END)
    both &= np.repeat(covered, 2)[mate]
    row_length, row_size = _along_chains(np.where(both, mate, NO_END), length)
    whole_size = _along_chains(mate, length)[1]
    return np.asarray(covered & ((row_length >= touching) | (row_size == whole_size)))


def _along_chains(mate: Ints, length: Floats) -> tuple[Floats, Ints]:
    """(m,) for every chord the length and the number of chords of its chain."""
    rows = chains(mate)
    chord, count = rows.entry >> 1, np.diff(rows.offsets)
    total, size = np.zeros(len(length)), np.zeros(len(length), dtype=np.intp)
    if len(chord):
        total[chord] = np.repeat(np.add.reduceat(length[chord], rows.offsets[:-1]), count)
        size[chord] = np.repeat(count, count)
    return total, size
