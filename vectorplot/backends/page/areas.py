"""Filled polygons as backends see them: clipped to the page, in thousandths of a millimetre, flat or triangles."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page.fringes import clipped_parts_of, fringes
from vectorplot.backends.page.transparency_groups import groups_of, outline
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import SEAM_MM, Colours, FillKind, Fills
from vectorplot.drawing.strokes.page_clip import clipped_parts
from vectorplot.geometry import ragged
from vectorplot.geometry.components import any_component
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some

RUN_LENGTH = 1000
"""So many polygons are painted at once; one huge path makes the rasterisers of all readers slow."""


MESH_LENGTH = 1 << 16
"""Triangles of a mesh."""


@dataclass(frozen=True, eq=False)
class Areas:
    """Filled polygons, each painted over those before it.

    microns (p,2) int64, y upwards; offsets (m+1,); colours (p,3) of the corners; opacity (m,), more than 0; bare (m,):
    those without a line around them: transparent ones, and blank ones that are there to hide things; group (m,): the
    transparency groups, ascending, -1 for none: those of a group are opaque, and their opacity is that of all; part
    (m,): of those of several items in a group, ascending, the runs that are clipped to their own outlines, -1 for the
    first one and outside of groups; fringe (m,): what is painted first in a group, under others, and is no part of its
    outline; item (m,): of the drawing. A polygon of two corners is a line. All others are counter-clockwise, have an
    area, and no two neighbouring corners that are equal; they are flat, or triangles that are shaded linearly.
    """

    microns: Ints
    offsets: Ints
    colours: Colours
    opacity: Floats
    bare: Bools
    group: Ints
    part: Ints
    fringe: Bools
    item: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @cached_property
    def sizes(self) -> Ints:
        """(m,) numbers of corners."""
        return np.diff(self.offsets)

    @cached_property
    def shaded(self) -> Bools:
        """(m,) whether the corners of a polygon differ in colour."""
        return _differ(self.colours, self.offsets)

    @cached_property
    def solid(self) -> Bools:
        """(m,) which hide what is below them, and have a colour."""
        return np.asarray((self.own_opacity == 1.0) & (self.sizes > 2) & ~self.bare, dtype=np.bool_)

    @cached_property
    def meshed(self) -> Bools:
        """(m,) triangles that are shaded, or follow each other with such ones: together they are a mesh."""
        able = self.solid & (self.sizes == 3)
        new = np.ones(len(self), dtype=np.bool_)
        new[1:] = (able[1:] != able[:-1]) | (self.group[1:] != self.group[:-1])
        new[1:] |= self.part[1:] != self.part[:-1]
        run = np.cumsum(new) - 1
        some = np.bincount(run, weights=self.shaded, minlength=int(new.sum())) > 0.0
        return np.asarray(self.shaded | (able & some[run]), dtype=np.bool_)

    @cached_property
    def own_opacity(self) -> Floats:
        """(m,) what each polygon is painted with: 1 in groups."""
        return np.where(self.group < 0, self.opacity, 1.0)

    @cached_property
    def group_ends(self) -> Ints:
        """(g,2) the first polygon of every group, and the one behind its last."""
        return _ends(self.group)

    @cached_property
    def part_ends(self) -> Ints:
        """(q,2) the first polygon of every part that is clipped, and the one behind its last."""
        return _ends(self.part)

    def outline(self, first: int, last: int) -> tuple[Floats, Ints]:
        """The borders of polygons from first to before last together, but for fringes, see
        transparency_groups.outline."""
        which = first + np.flatnonzero(~self.fringe[first:last])
        position, offsets = ragged.take(self.offsets, which)
        return outline(self.microns[position], offsets)

    @cached_property
    def runs(self) -> Ints:
        """(r+1,) runs of neighbours that may be painted at once, as the union of their areas, without a change of the
        picture: opaque and of one colour, all of them lines or none; or opaque and shaded. All others stand alone."""
        if not len(self):
            return np.zeros(1, dtype=np.intp)
        colour = self.colours[self.offsets[:-1]].astype(np.intp) @ (65536, 256, 1)
        colour = np.where(self.meshed, -1, 4 * colour + 2 * self.bare + (self.sizes == 2))
        alone = self.own_opacity < 1.0
        new = np.ones(len(self), dtype=np.bool_)
        new[1:] = (colour[1:] != colour[:-1]) | alone[1:] | alone[:-1]
        new[1:] |= (self.group[1:] != self.group[:-1]) | (self.part[1:] != self.part[:-1])
        starts = np.flatnonzero(new)
        since = np.arange(len(self)) - np.repeat(starts, np.diff(np.append(starts, len(self))))
        length = np.where(self.meshed, MESH_LENGTH, RUN_LENGTH)
        return np.append(np.flatnonzero(since % length == 0), len(self))


def areas(fills: Fills, width_mm: float, height_mm: float) -> Areas:
    """The polygons on a page, clipped a seam's width beyond it, so that what is stroked along the cuts is not on it.

    Shaded polygons become triangles, those that nearly have one colour become flat. Polygons without area, without
    opacity or off the page are dropped.
    """
    solid = fills if (fills.opacity > 0.0).all() else fills.some(np.flatnonzero(fills.opacity > 0.0))
    sizes = np.diff(solid.offsets)
    drawn = _with_flat_lines(Polygons(solid.points, solid.offsets, solid.colours, np.arange(len(solid))), sizes == 2)
    drawn = _fanned(drawn)
    drawn = _fanned(_clipped(drawn, width_mm, height_mm))
    microns, offsets, colours, kept = rounded(drawn)
    source = drawn.source[kept]
    opacity, blank = solid.opacity[source], solid.kind[source] == FillKind.BACKGROUND
    item = solid.item[source]
    run, part = _alike(solid, source, np.diff(offsets))
    group = groups_of(microns, offsets, run, part)
    bare = blank | ((opacity < 1.0) & (group < 0))
    none = np.full(len(group), -1), np.zeros(len(group), dtype=np.bool_)
    return with_fringes(Areas(microns, offsets, colours, opacity, bare, group, *none, item))


def with_fringes(areas: Areas) -> Areas:
    """The same, groups of several items with fringes, and told which of their parts are clipped."""
    part = clipped_parts_of(areas.group, areas.item)
    if not (part >= 0).any():
        return areas
    several = np.isin(areas.group, areas.group[part >= 0])
    corners, owner, colours = fringes(areas.microns, areas.offsets, areas.colours, np.flatnonzero(several), part)
    first = areas.group_ends[np.searchsorted(areas.group_ends[:, 1], owner, side="right"), 0]
    order = np.argsort(np.concatenate((np.arange(len(areas)), first - 0.5)), kind="stable")
    sizes = np.concatenate((areas.sizes, np.full(len(owner), 4)))
    starts = np.concatenate((areas.offsets[:-1], areas.offsets[-1] + 4 * np.arange(len(owner))))
    corner = ragged.ranges(starts[order], sizes[order])
    every = np.concatenate((np.arange(len(areas)), owner))[order]
    fringe = order >= len(areas)
    return Areas(
        np.concatenate((areas.microns, corners.reshape(-1, 2)))[corner],
        ragged.offsets(sizes[order]),
        np.concatenate((areas.colours, np.repeat(colours, 4, axis=0)))[corner],
        areas.opacity[every],
        areas.bare[every] | fringe,
        areas.group[every],
        np.where(fringe, -1, part[every]),
        fringe,
        areas.item[every],
    )


def _ends(number: Ints) -> Ints:
    """(k,2) the first of those of each number of at least 0, and the one behind their last."""
    inside = np.flatnonzero(number >= 0)
    _, first, count = np.unique(number[inside], return_index=True, return_counts=True)
    return np.stack((inside[first], inside[first] + count), axis=1)


def _alike(fills: Fills, source: Ints, sizes: Ints) -> tuple[Ints, Ints]:
    """(m,) numbers of the runs of neighbours that are equally transparent, -1 for all other polygons, and (m,) of those
    of neighbours that are of one item and kind as well."""
    clear = (fills.opacity[source] < 1.0) & (fills.kind[source] != FillKind.BACKGROUND) & (sizes > 2)
    run = _runs(fills.opacity[source, None])
    return np.where(clear, run, -1), _runs(
        np.stack((run, fills.item[source], fills.kind[source]), axis=1).astype(np.float64)
    )


def _runs(rows: Floats) -> Ints:
    """(m,) numbers of the runs of equal rows (m,k)."""
    new = np.ones(len(rows), dtype=np.bool_)
    new[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    return np.cumsum(new) - 1


@dataclass(frozen=True, eq=False)
class Polygons:
    """Polygons on their way to the page: points (p,2) in mm, offsets (m+1,), colours (p,3), source (m,): the fill that
    each polygon is a part of."""

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    colours: Colours = field(metadata=EACH_POINT)
    source: Ints = field(metadata=EACH_LINE)


def _in_order(parts: tuple[Polygons, ...], place: tuple[Ints, ...]) -> Polygons:
    """The polygons of all parts by their places, those of one place in the order in which they come."""
    return some(joined(parts), np.argsort(np.concatenate(place), kind="stable"))


def _differ(colours: Colours, offsets: Ints) -> Bools:
    """(m,) whether the colours of a polygon's corners differ. Degenerate: those of none do not."""
    sizes = np.diff(offsets)
    other = any_component(colours != colours[np.repeat(np.minimum(offsets[:-1], max(len(colours) - 1, 0)), sizes)])
    count = ragged.offsets(other)[offsets]
    return np.asarray(count[1:] > count[:-1])


def _with_flat_lines(polygons: Polygons, line: Bools) -> Polygons:
    """The same, but both ends of lines have the mean of their colours."""
    which = np.flatnonzero(line & _differ(polygons.colours, polygons.offsets))
    if not len(which):
        return polygons
    colours = polygons.colours.copy()
    first = polygons.offsets[which]
    mean = ((colours[first].astype(np.intp) + colours[first + 1] + 1) // 2).astype(np.uint8)
    colours[first] = colours[first + 1] = mean
    return Polygons(polygons.points, polygons.offsets, colours, polygons.source)


def _fanned(polygons: Polygons) -> Polygons:
    """The same with the triangles of their fans instead of shaded polygons of more than three corners."""
    sizes = np.diff(polygons.offsets)
    split = (sizes > 3) & _differ(polygons.colours, polygons.offsets)
    if not split.any():
        return polygons
    others = np.flatnonzero(~split)
    triangles, owner = ragged.fans(polygons.offsets)
    corner, owner = triangles[split[owner]].ravel(), owner[split[owner]]
    fans = Polygons(
        polygons.points[corner],
        np.arange(0, len(corner) + 1, 3),
        polygons.colours[corner],
        polygons.source[owner],
    )
    return _in_order((some(polygons, others), fans), (others, owner))


def _clipped(polygons: Polygons, width_mm: float, height_mm: float) -> Polygons:
    low, high = np.full(2, -SEAM_MM), np.array((width_mm, height_mm)) + SEAM_MM
    beyond = np.any((polygons.points < low) | (polygons.points > high), axis=1)
    if not beyond.any():
        return polygons
    count = ragged.offsets(beyond)[polygons.offsets]
    out, line = count[1:] > count[:-1], np.diff(polygons.offsets) == 2
    inside, cut, crossing = (np.flatnonzero(which) for which in (~out, out & ~line, out & line))
    parts, owner = _cut(some(polygons, cut), low, high)
    lines, of_line = _cut_lines(some(polygons, crossing), low, high)
    return _in_order((some(polygons, inside), parts, lines), (inside, cut[owner], crossing[of_line]))


def _cut(polygons: Polygons, low: Floats, high: Floats) -> tuple[Polygons, Ints]:
    """The parts of polygons inside the rectangle, and which polygon each is a part of."""
    rectangle = np.array([(low[0], high[0], high[0], low[0]), (low[1], low[1], high[1], high[1])])
    count = len(polygons.source)
    rows = np.concatenate((polygons.points.T, polygons.colours.T.astype(np.float64)))
    rows, offsets, owner = clipped_by_convex(
        rows, polygons.offsets, np.tile(rectangle, count), np.arange(0, 4 * count + 1, 4)
    )
    points = np.clip(rows[:2].T, low, high)  # rounding may leave a cut beside its side, far beside it if it is long
    colours = np.rint(np.clip(rows[2:].T, 0.0, 255.0)).astype(np.uint8)
    return Polygons(points, offsets, colours, polygons.source[owner]), owner


def _cut_lines(lines: Polygons, low: Floats, high: Floats) -> tuple[Polygons, Ints]:
    """The parts of lines inside the rectangle, and which line each is a part of."""
    none = np.zeros(len(lines.source), dtype=np.intp)
    world = np.column_stack((lines.points, np.zeros(len(lines.points))))
    paths = Paths(lines.points, lines.offsets, none > 0, none, none, none, world)
    parts, owner = clipped_parts(paths, (low[0], low[1], high[0], high[1]))
    colours = np.repeat(lines.colours[lines.offsets[owner]], np.diff(parts.offsets), axis=0)
    return Polygons(parts.points, parts.offsets, colours, lines.source[owner]), owner


def rounded(polygons: Polygons) -> tuple[Ints, Ints, Colours, Ints]:
    """Corners in microns, offsets and colours of the polygons, all turned counter-clockwise, and which ones remain."""
    microns = np.rint(polygons.points * 1000.0).astype(np.int64)
    sizes = np.diff(polygons.offsets)
    new = any_component(microns != microns[_before(polygons.offsets)])
    kept_before = ragged.offsets(new)
    left = np.diff(kept_before[polygons.offsets])
    kept = np.flatnonzero((left >= 3) | ((left == 2) & (sizes == 2)))
    offsets, corner = polygons.offsets, np.arange(len(microns))
    if not new.all():
        corner, offsets = corner[new], kept_before[polygons.offsets]
    area = _areas(microns[corner], offsets)
    kept = kept[(area[kept] != 0) | (sizes[kept] == 2)]
    count = np.diff(offsets)[kept]
    first = ragged.ranges(offsets[kept], count)
    back = np.repeat((2 * offsets[kept] + count - 1), count) - first
    corner = corner[np.where(np.repeat(area[kept] < 0, count), back, first)]
    return microns[corner], ragged.offsets(count), polygons.colours[corner], kept


def _before(offsets: Ints) -> Ints:
    """(p,) where the corner stands that precedes each one in its polygon."""
    before = np.arange(-1, int(offsets[-1]) - 1)
    filled = offsets[1:] > offsets[:-1]
    before[offsets[:-1][filled]] = offsets[1:][filled] - 1
    return before


def _areas(microns: Ints, offsets: Ints) -> Ints:
    """(m,) twice the signed areas of polygons, exactly."""
    sizes = np.diff(offsets)
    filled = np.flatnonzero(sizes > 0)
    area = np.zeros(len(sizes), dtype=np.int64)
    if len(filled):
        arm = microns - np.repeat(microns[offsets[filled]], sizes[filled], axis=0)
        before = arm[_before(offsets)]
        cross = before[:, 0] * arm[:, 1] - before[:, 1] * arm[:, 0]
        area[filled] = np.add.reduceat(cross, offsets[filled])
    return area
