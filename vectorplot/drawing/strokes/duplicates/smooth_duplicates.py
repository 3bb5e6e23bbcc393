"""Smooth curves that lie on each other are drawn once, however differently they are sampled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.chains import NO_END, chains
from vectorplot.drawing.strokes.join import linked_ends
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2, tan
from vectorplot.tolerances.of_the_page import TOUCHING_AT_MM
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import Entries, Floats32, Grid

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
    Source: cubic Hermite arcs over the chords, with the tangents of the curves, or where these are not known of circles
    through three neighbouring points.
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
    mate = linked_ends(chords, group, tolerance_mm)
    directions = chords.directions.reshape(-1, 2, 2)[:, [0, 1], [1, 0]]
    arcs = _arcs(ends, _slopes(ends, mate, directions), group, tolerance_mm)
    covered = _covered(arcs, tolerance_mm)
    if not covered.any():
        return paths
    room = tolerance_mm + HEIGHT_SHARE * float(arcs.height.max())
    touching = TOUCHING_MM * (room / TOUCHING_AT_MM) ** 0.25
    covered = _in_rows(covered, mate, arcs.length, touching)
    if not covered.any():
        return paths
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[smooth[covered]] = False
    return chosen(paths, kept)


def _slopes(ends: Floats, mate: Ints, directions: Floats) -> Floats:
    """(m,2) slopes of the curve against its chords (m,2,2) at their ends.

    mate (2m,): as linked_ends gives it; directions (m,2): the angles of the curve there, NaN where they are not known.
    Where they are not, and the curve ends, its last arc is one of a circle; a chord alone is straight.
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
    angle = directions - arctan2(along[:, 1], along[:, 0])[:, None]
    slopes = np.where((np.cos(angle) > 0.0) & (np.abs(tan(angle)) < _STEEPEST), tan(angle), slopes)
    slopes = np.where(np.isnan(slopes), -slopes[:, ::-1], slopes)
    return np.nan_to_num(slopes, nan=0.0)


@dataclass(frozen=True, eq=False)
class _Arcs:
    """Cubic arcs over the chords from x0, y0 (m,) along x, y (m,), of some lengths (m,), with slopes (m,2) against them
    at their ends, and (m,) ranks; height (m,): how far the arcs may be off the chords; box: what a point near enough to
    matter is in, around the corner of them all."""

    x0: Floats
    y0: Floats
    x: Floats
    y: Floats
    length: Floats
    slopes: Floats
    rank: Ints
    height: Floats
    corner: tuple[float, float]
    box: Floats32
    grid: Grid
    entries: Entries

    def near(self, x: Floats, y: Floats) -> tuple[Ints, Ints]:
        """All (point, arc) of points (k,) and the arcs whose boxes they are in."""
        px, py = (c - low for c, low in zip((x, y), self.corner, strict=True))
        column, row = self.grid.column_of(px), self.grid.row_of(py)
        px, py = px.astype(np.float32), py.astype(np.float32)
        found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
        for level in self.entries.levels():
            begin, count = self.entries.of(self.grid.numbers(column >> level, row >> level, level))
            point, arc = ragged.owner(count), self.entries.thing[ragged.ranges(begin, count)]
            left, right, bottom, top = self.box[:, arc]
            px_there, py_there = px[point], py[point]
            inside = (left <= px_there) & (px_there <= right) & (bottom <= py_there) & (py_there <= top)
            found.append((point[inside], arc[inside]))
        point, arc = (np.concatenate(column) for column in zip(*found, strict=True))
        return point, arc


def _arcs(ends: Floats, slopes: Floats, rank: Ints, tolerance: float) -> _Arcs:
    """The arcs over chords (m,2,2)."""
    x0, y0, x1, y1 = np.ascontiguousarray(ends.reshape(-1, 4).T)
    length = np.hypot(x1 - x0, y1 - y0)
    height = length * np.maximum(np.abs(slopes[:, 0]), np.abs(slopes[:, 1])) / 4.0
    # Each arc looks no farther than its own height: one long chord would else call for all pairs.
    reach = tolerance + (1.0 + HEIGHT_SHARE) * height + HEIGHT_SHARE * float(height.max())
    sides = [(np.minimum(a, b) - reach, np.maximum(a, b) + reach) for a, b in ((x0, x1), (y0, y1))]
    corner = float(sides[0][0].min()), float(sides[1][0].min())
    size = [float(high.max()) - low for (_, high), low in zip(sides, corner, strict=True)]
    # Single precision may not lose a point at the border of a box.
    slack = 2.0 * float(np.spacing(np.float32(max(size))))
    box = np.stack(
        [side for (a, b), low in zip(sides, corner, strict=True) for side in (a - low - slack, b - low + slack)]
    ).astype(np.float32)
    typical = float(np.median(np.maximum(box[1] - box[0], box[3] - box[2])))
    grid = Grid.over((0.0, size[0], 0.0, size[1]), typical)
    level = grids.entry_level(grid, box)
    arc, column, row = grids.touched(grid, box, level)
    entries = grids.entries(grid, arc, column, row, level[arc])
    return _Arcs(x0, y0, x1 - x0, y1 - y0, length, slopes, rank, height, corner, box, grid, entries)


def _covered(arcs: _Arcs, tolerance: float) -> Bools:
    """(m,) which chords lie on arcs over chords of smaller rank."""
    # The ends are points of the curve; the middle is known but for a little. Few middles lie on other curves, while
    # many ends do.
    some = np.flatnonzero(arcs.rank > arcs.rank.min())
    rise = (arcs.slopes[:, 0] - arcs.slopes[:, 1]) / 8.0
    for part, off, room in (
        (0.5, rise, tolerance + HEIGHT_SHARE * arcs.height),
        (0.0, np.zeros_like(rise), np.full(len(rise), tolerance)),
        (1.0, np.zeros_like(rise), np.full(len(rise), tolerance)),
    ):
        x = arcs.x0[some] + part * arcs.x[some] - off[some] * arcs.y[some]
        y = arcs.y0[some] + part * arcs.y[some] + off[some] * arcs.x[some]
        some = some[_on_arcs(x, y, room[some], arcs.rank[some], arcs, tolerance)]
    covered = np.zeros(len(rise), dtype=np.bool_)
    covered[some] = True
    return covered


def _on_arcs(x: Floats, y: Floats, room: Floats, rank: Ints, arcs: _Arcs, tolerance: float) -> Bools:
    """(k,) which points lie within room (k,) on arcs of smaller rank (k,)."""
    on_some = np.zeros(len(x), dtype=np.bool_)
    point, arc = arcs.near(x, y)
    better = arcs.rank[arc] < rank[point]
    point, arc = point[better], arc[better]
    length, ux, uy = arcs.length[arc], arcs.x[arc], arcs.y[arc]
    arm_x, arm_y = x[point] - arcs.x0[arc], y[point] - arcs.y0[arc]
    s = (arm_x * ux + arm_y * uy) / (length * length)
    first, last = arcs.slopes[arc].T
    rise = length * (first * s * (1.0 - s) ** 2 - last * s * s * (1.0 - s))
    off = np.abs((ux * arm_y - uy * arm_x) / length - rise)
    slack = tolerance / length
    on = (s >= -slack) & (s <= 1.0 + slack) & (off <= room[point] + HEIGHT_SHARE * arcs.height[arc])
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
