"""What every backend that makes a page draws: strokes, texts, filled polygons and their borders, in groups."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.arcs import EllipseArcs
from vectorplot.curves.bezier import BezierPaths, clipped_paths
from vectorplot.drawing.drawing import STROKES, CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import SEAM_MM, Colours, FillKind, Fills
from vectorplot.drawing.stroke_curves import one_mark
from vectorplot.drawing.strokes import Rectangle, chosen, clipped_parts
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take
from vectorplot.geometry.vectors import all_components, any_component
from vectorplot.scene.labels import TYPE_SIZE

# Texts as every backend sees them: one line each, without control characters, in thousandths of a millimetre.

FONTS = "Helvetica, Arial, sans-serif"
"""What text is set in where the format asks for a font by its name: the first one that the reader has."""


class TextLine(NamedTuple):
    """One line of text: as PageTexts, number by number."""

    x: int
    y: int
    type_mm: float
    turn_deg: float
    anchor: float
    colour: str
    string: str


@dataclass(frozen=True, eq=False)
class PageTexts:
    """Lines of text on the page: microns (n,2) int64, y upwards, of the point on the line that letters stand on; type
    (n,), the sizes of type in mm; turn_deg (n,); anchor (n,): 0 begins there, 0.5 has its middle there, 1 ends there;
    colours: #rrggbb of each; latex: the words that LaTeX has for the sizes, or
    none; font: see Drawing."""

    strings: tuple[str, ...]
    microns: Ints
    type_mm: Floats
    turn_deg: Floats
    anchor: Floats
    colours: tuple[str, ...]
    latex: tuple[str, ...]
    font: str

    def __len__(self) -> int:
        return len(self.strings)

    def lines(self, strings: Sequence[str]) -> Iterator[TextLine]:
        """The lines one by one, with these words in place of their own."""
        columns = (self.microns.tolist(), self.type_mm.tolist(), self.turn_deg.tolist(), self.anchor.tolist())
        for (x, y), size, turn, anchor, colour, string in zip(*columns, self.colours, strings, strict=True):
            yield TextLine(x, y, size, turn, anchor, colour, string)

    @property
    def plain(self) -> tuple[str, ...]:
        """The lines for readers that set no formulas."""
        from vectorplot.drawing.formulas import without_formulas

        return tuple(map(without_formulas, self.strings))


def page_texts(texts: Texts, colour: str, font: str = "") -> PageTexts:
    """Texts in the colour of a pen, and a font; those that are hidden in one half as strong."""
    faint = "#" + "".join(f"{(int(colour[k : k + 2], 16) + 255) // 2:02x}" for k in (1, 3, 5))
    return PageTexts(
        tuple(plain_text(string) for string in texts.strings),
        np.rint(texts.points * 1000.0).astype(np.int64),
        np.round(texts.size_mm / TYPE_SIZE, 3),
        np.round(texts.turn_deg, 3) + 0.0,
        texts.anchor,
        tuple(faint if by else colour for by in texts.hidden_by),
        texts.in_latex,
        font,
    )


def plain_text(text: str) -> str:
    """The text on one line, without control characters and what else XML forbids."""
    kept = (" " if c.isspace() else c for c in text if c.isspace() or unicodedata.category(c) not in ("Cc", "Cs", "Cn"))
    return " ".join("".join(kept).split())


# Where the triangles of a mesh on the page end, and what is put around them.

REACH_MICRONS = 450.0
"""The width of skirts."""

BESIDE_MICRONS = 40.0
"""So far from sides it is looked for what is next to them: less than what is put around them."""

LOOKS = np.array((0.01, 0.15, 0.3, 0.5, 0.7, 0.85, 0.99))
"""Where along sides."""


def border_sides(corners: Ints) -> Ints:
    """(s,2) the sides that more triangles have in one direction than in the other, by the numbers of their ends.

    corners (3 t, 2): whole coordinates; all triangles are counter-clockwise. Filled by the rule that counts turns,
    these sides enclose what the triangles cover together, overlapping ones too.
    """
    place = places_of(corners)
    start = np.arange(len(corners))
    end = start.reshape(-1, 3)[:, [1, 2, 0]].ravel()
    low, high = np.sort(np.stack((place[start], place[end])), axis=0)
    forth = np.where(place[start] == low, 1, -1)
    _, number = np.unique(low * len(corners) + high, return_inverse=True)
    surplus = np.bincount(number.ravel(), weights=forth).astype(np.intp)[number.ravel()]
    mine = np.flatnonzero(forth * surplus > 0)
    mine = mine[np.argsort(number.ravel()[mine], kind="stable")]
    of_side = number.ravel()[mine]
    first = np.searchsorted(of_side, of_side)
    kept = np.sort(mine[np.arange(len(mine)) - first < np.abs(surplus[mine])])
    return np.stack((start[kept], end[kept]), axis=1)


def last_of_sides(corners: Ints, sides: Ints) -> Ints:
    """Which of sides (s,2) are the last ones from their start to their end: where a surface folds over, the sides of
    two triangles are there, and the later one is seen."""
    place = places_of(corners)[sides]
    _, first = np.unique(place[::-1], axis=0, return_index=True)
    return np.sort(len(sides) - 1 - first)


def outer_sides(corners: Ints, sides: Ints) -> Ints:
    """Those of sides (s,2) of triangles (3 t, 2), counter-clockwise, with a place next to them, outside, that no
    triangle covers: where a surface folds over before itself its border needs nothing around it."""
    import shapely

    start, end = corners[sides[:, 0]].astype(np.float64), corners[sides[:, 1]].astype(np.float64)
    way = end - start
    out = np.stack((way[:, 1], -way[:, 0]), axis=1) * (BESIDE_MICRONS / np.hypot(*way.T))[:, None]
    places = start + LOOKS[:, None, None] * way + out
    closed = corners.reshape(-1, 3, 2)[:, [0, 1, 2, 0]].astype(np.float64)
    tree = shapely.STRtree(shapely.polygons(closed))
    inside = np.zeros(places.shape[0] * len(sides), dtype=np.bool_)
    inside[tree.query(shapely.points(places.reshape(-1, 2)), predicate="intersects")[0]] = True
    return sides[~inside.reshape(len(LOOKS), -1).all(axis=0)]


def places_of(corners: Ints) -> Ints:
    """(n,) numbers of different places; corners (n,2) whole coordinates."""
    return np.asarray(np.unique(corners[:, 0] << 32 | corners[:, 1] & 0xFFFFFFFF, return_inverse=True)[1].ravel())


def rings(corners: Ints, sides: Ints) -> list[list[int]]:
    """Sides of border_sides in closed rings, as numbers of corners. This loops over what is a border."""
    place = places_of(corners).tolist()
    leaving: dict[int, list[int]] = {}
    for number, (start, _) in enumerate(sides.tolist()):
        leaving.setdefault(place[start], []).append(number)
    ends = sides.tolist()
    found = []
    for place_, open_ in leaving.items():
        while open_:
            ring, at = [], place_
            while leaving.get(at):
                start, end = ends[leaving[at].pop()]
                ring.append(start)
                at = place[end]
            found.append(ring)
    return found


def skirts(corners: Ints, sides: Ints) -> Floats:
    """(s,4,2) rectangles outside along sides, longer than these; the first and the last corner belong to the start."""
    start, end = corners[sides[:, 0]].astype(np.float64), corners[sides[:, 1]].astype(np.float64)
    way = end - start
    way *= REACH_MICRONS / np.hypot(way[:, 0], way[:, 1])[:, None]
    out = np.stack((way[:, 1], -way[:, 0]), axis=1)
    return np.stack((start - way, end + way, end + way + out, start - way + out), axis=1)


# Parts of transparency groups that are of different items: where the one ends and the other begins there is an edge.
#
# It is to be seen exactly where other sheets of these items end. So what is painted later is clipped to its own outline
# there, and what is below goes on under it, as does the later one under the earlier one: fringes are painted before
# both.

FRINGE_REACH_MICRONS = 500.0
"""The width of fringes: more than a pixel of a screen of 72 dots per inch, slantwise as well."""

FRINGE_BESIDE_MICRONS = 10.0
"""So far beside the middle of a side it is looked at what is there: more than what rounding leaves between neighbours.
"""


def clipped_parts_of(group: Ints, item: Ints) -> Ints:
    """(m,) ascending numbers of the runs of polygons of one item in groups, -1 for the first run of each group and
    outside of groups (-1)."""
    new = np.ones(len(group), dtype=np.bool_)
    new[1:] = (group[1:] != group[:-1]) | (item[1:] != item[:-1])
    later = new & (group >= 0)
    later[1:] &= group[1:] == group[:-1]
    later[:1] = False
    starts = np.maximum.accumulate(np.where(new, np.arange(len(new)), 0))
    return np.where(later[starts], np.cumsum(later) - 1, -1) if len(group) else group


def _needed(corners: Ints, offsets: Ints, part: Ints, start: Ints, end: Ints, owner: Ints) -> Bools:
    """(s,) beside which sides of polygons, from corners start to end, something shows that is of another part: another
    part of the group, or what is beside the group where it is the part itself that is clipped (part >= 0)."""
    import shapely

    position = np.insert(np.arange(len(corners)), offsets[1:], offsets[:-1])
    rings = shapely.linearrings(corners[position], indices=ragged.owner(np.diff(offsets) + 1))
    tree = shapely.STRtree(shapely.polygons(rings))
    way = (corners[end] - corners[start]).astype(np.float64)
    out = np.stack((way[:, 1], -way[:, 0]), axis=1) * (FRINGE_BESIDE_MICRONS / np.hypot(*way.T))[:, None]
    beside = shapely.points((corners[start] + corners[end]) / 2.0 + out)
    point, polygon = tree.query(beside, predicate="dwithin", distance=FRINGE_BESIDE_MICRONS / 2.0)
    own = part[polygon] == part[owner[point]]
    inside, other = np.zeros((2, len(start)), dtype=np.bool_)
    inside[point[own]], other[point[~own]] = True, True
    return np.asarray(~inside & (other | (part[owner] >= 0)), dtype=np.bool_)


def fringes(microns: Ints, offsets: Ints, colours: Colours, which: Ints, part: Ints) -> tuple[Ints, Ints, Colours]:
    """Quadrilaterals outside of the sides of polygons beside which something else than their part is to be seen:
    corners (k,4,2) in microns, counter-clockwise, the polygon of each, ascending, and their colours (k,3).

    which: the polygons that are looked at; part (m,): those of one number are one.
    """
    position, ends = ragged.take(offsets, which)
    corners, owner = microns[position], which[ragged.owner(np.diff(ends))]
    after = next_positions(ends, np.arange(len(corners)))
    place = places_of(corners)
    own = part[owner] * np.int64(len(corners)) + place, part[owner] * np.int64(len(corners)) + place[after]
    forth, back = (np.stack(pair, axis=1) for pair in (own, own[::-1]))
    _, number = np.unique(np.concatenate((forth, back)), axis=0, return_inverse=True)
    number = number.ravel()
    side = np.flatnonzero(~np.isin(number[: len(corners)], number[len(corners) :]))
    side = side[_needed(corners, ends, part[which], side, after[side], ragged.owner(np.diff(ends))[side])]
    start, end = corners[side], corners[after[side]]
    way = (end - start).astype(np.float64)
    out = np.rint(np.stack((way[:, 1], -way[:, 0]), axis=1) * (FRINGE_REACH_MICRONS / np.hypot(*way.T))[:, None])
    quads = np.stack((start, start + out, end + out, end), axis=1).astype(np.int64)
    shades = colours[position]
    mean = (shades[side].astype(np.intp) + shades[after[side]] + 1) // 2
    return quads, owner[side], mean.astype(np.uint8)


# Neighbouring transparent polygons of one item, taken together: opaque to each other, transparent as a whole.
#
# Blended one by one, polygons with a common side let the paper through along it, or cover it twice. A transparency
# group is painted as if it were opaque, the lines along common sides included, and then blended once, inside its
# outline.

SIDE_BY_SIDE_MICRONS = 30.0
"""Polygons that overlap by no more than a strip of about this width lie side by side: their corners are rounded to
microns, and a tenth of a pixel of a screen that is blended once, not twice, is not seen."""

MOST_NEIGHBOURS = 64
"""With more boxes than this across that of a polygon, in the mean, they lie over each other in heaps, and stay alone:
to compare all pairs would take longer than to draw them."""

FEW_CORNERS = 6
"""Polygons of no more corners are looked at side by side before their common part is made."""

_SHAPES_AT_ONCE = 256


def groups_of(microns: Ints, offsets: Ints, run: Ints, part: Ints) -> Ints:
    """(m,) the transparency groups of polygons, ascending from 0; -1 for polygons in none.

    microns (p,2): corners, counter-clockwise; run (m,): equally transparent neighbours have one number, at least 0;
    part (m,): the item. Polygons of a group follow each other and touch, but do not overlap, since overlapping ones
    show through. A group ends before an item, or within an item before a polygon, that overlaps it. Polygons that cross
    themselves, and those in stacks, are in no group.
    """
    group = np.full(len(run), -1, dtype=np.intp)
    near = run[1:] == run[:-1]
    beside = np.zeros(len(run), dtype=np.bool_)
    beside[1:] |= near
    beside[:-1] |= near
    which = np.flatnonzero(beside & (run >= 0))
    if not len(which):
        return group
    import shapely

    sizes = np.diff(offsets)[which]
    corner = ragged.ranges(offsets[which], sizes)
    rings = shapely.linearrings(microns[corner], indices=ragged.owner(sizes))
    raw = shapely.polygons(rings)
    shapes = shapely.make_valid(raw)
    twisted = np.abs(shapely.area(shapes) - shapely.area(raw))
    simple = twisted <= np.maximum(SIDE_BY_SIDE_MICRONS * shapely.length(raw) / 2.0, 0.5)
    one, other = _neighbours(shapes, np.where(simple, run[which], -1))
    if not len(one):
        return group
    own = microns[corner], ragged.offsets(sizes)
    near = np.flatnonzero(~beside_a_side(*own, one, other) & ~beside_a_side(*own, other, one))
    common = shapely.intersection(shapes[one[near]], shapes[other[near]])
    over = np.zeros(len(one), dtype=np.bool_)
    over[near] = shapely.area(common) > SIDE_BY_SIDE_MICRONS * shapely.length(common) / 2.0
    new = np.append(True, (np.diff(which) > 1) | (np.diff(run[which]) != 0))
    new |= ~simple | np.append(False, ~simple[:-1])
    number = _split(new, part[which], one[over], other[over])
    touching = np.unique(number[one][number[one] == number[other]])
    member = np.isin(number, touching)
    group[which[member]] = np.searchsorted(touching, number[member])
    return group


def beside_a_side(microns: Ints, offsets: Ints, one: Ints, other: Ints) -> Bools:
    """(k,) whether polygons other (k,), counter-clockwise as all, lie on the outer side of a side of polygons one (k,)
    that are convex; of those with more than FEW_CORNERS, or of which one is not convex, it is not said."""
    sizes = np.diff(offsets)
    few = sizes <= FEW_CORNERS
    # Corners in tables, the last one repeated: (FEW_CORNERS, m).
    step = np.minimum(np.arange(FEW_CORNERS)[:, None], sizes - 1)
    table = microns[np.where(few, offsets[:-1] + step, 0)].astype(np.float64)
    way = np.roll(table, -1, axis=0) - table
    back = np.roll(way, 1, axis=0)
    # A corner repeated has no way: the turn at the last one is that of the polygon.
    turn = way[..., 0] * back[..., 1] - way[..., 1] * back[..., 0]
    row = np.arange(len(sizes))
    last = table[np.clip(sizes - 1, 0, FEW_CORNERS - 1), row]
    before, after = last - table[np.clip(sizes - 2, 0, FEW_CORNERS - 1), row], table[0] - last
    sound = few & (turn <= 0.0).all(axis=0) & (after[:, 0] * before[:, 1] - after[:, 1] * before[:, 0] <= 0.0)
    found = np.zeros(len(one), dtype=np.bool_)
    asked = np.flatnonzero(sound[one] & few[other])
    for side in range(FEW_CORNERS):
        start, along = table[side, one[asked]], way[side, one[asked]]
        arm = table[:, other[asked]] - start
        left = along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]
        found[asked] |= (left.max(axis=0) <= 0.0) & any_component(along)
    return found


def _neighbours(shapes: NDArray[np.object_], run: Ints) -> tuple[Ints, Ints]:
    """The pairs of shapes of one run that overlap or touch, the earlier one first; none at all if their boxes are in
    one another's way more often than MOST_NEIGHBOURS allows. Shapes of the run -1 have no neighbours."""
    import shapely

    tree, met, found = shapely.STRtree(shapes), 0, []
    for start in range(0, len(shapes), _SHAPES_AT_ONCE):
        one, other = tree.query(shapes[start : start + _SHAPES_AT_ONCE])
        met += len(one)
        if met > MOST_NEIGHBOURS * (len(shapes) + _SHAPES_AT_ONCE):
            return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
        one = one + start
        pair = (one < other) & (run[one] == run[other]) & (run[one] >= 0)
        one, other = one[pair], other[pair]
        found.append(np.stack((one, other))[:, shapely.intersects(shapes[one], shapes[other])])
    first, second = np.concatenate(found, axis=1)
    return first, second


def _split(new: Bools, part: Ints, one: Ints, other: Ints) -> Ints:
    """(n,) numbers of groups, ascending, that begin where new is true, and before each polygon (other) that overlaps an
    earlier one of its group (one), or before the part (n,) that it is of. They are as long as they can be."""
    number = np.arange(len(new))
    begins = np.maximum.accumulate(np.where(np.append(True, part[1:] != part[:-1])[: len(new)], number, 0))
    latest = np.where(new, number - 1, -1)
    np.maximum.at(latest, other, one)
    latest = np.maximum.accumulate(latest)
    starts, at = [], 0
    while at < len(new):
        starts.append(at)
        end = int(np.searchsorted(latest, at))
        at = int(begins[end]) if end < len(new) and not new[end] and begins[end] > at else end
    return np.searchsorted(np.array(starts), number, side="right") - 1


def outline(microns: Ints, offsets: Ints) -> tuple[Floats, Ints]:
    """The borders of the union of polygons, as rings to be filled by the rule of even and odd: corners (q,2) in whole
    microns, the first of each ring not repeated, and offsets (r+1,). Holes narrower than SIDE_BY_SIDE_MICRONS, which
    rounding leaves between neighbours, are filled, and parts that narrow beside others left out."""
    import shapely

    rings = shapely.linearrings(microns, indices=ragged.owner(np.diff(offsets)))
    # On the grid of the corners: crossings between it can cost the union whole polygons.
    united = shapely.union_all(shapely.make_valid(shapely.polygons(rings)), grid_size=1.0)
    parts = shapely.get_parts(united)
    borders = shapely.get_rings(parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON])
    enclosed = shapely.polygons(borders)
    wide = shapely.area(enclosed) > SIDE_BY_SIDE_MICRONS * shapely.length(enclosed) / 2.0
    borders = borders[wide] if wide.any() else borders
    corners, ring = shapely.get_coordinates(borders, return_index=True)
    first = np.append(True, ring[1:] != ring[:-1])[: len(ring)]
    return np.rint(corners[~first]), ragged.offsets(np.bincount(ring[~first], minlength=len(borders)))


# Filled polygons as backends see them: clipped to the page, in thousandths of a millimetre, flat or triangles.

RUN_LENGTH = 1000
"""So many polygons are painted at once; one huge path makes the rasterisers of all readers slow."""


MESH_LENGTH = 1 << 16
"""Triangles of a mesh."""


@dataclass(frozen=True, eq=False)
class Areas:
    """Filled polygons, each painted over those before it.

    microns (p,2) int64, y upwards; offsets (m+1,); colours (p,3) of the corners; opacity (m,) above 0; bare (m,):
    without an outline, as bands are; group (m,): transparency group, ascending, -1 for none, whose polygons are opaque
    and share one opacity; part (m,): runs of one item in a group that are clipped to their own outlines, -1 for the
    first; fringe (m,): painted first in a group and no part of its outline; item (m,); look (m,): alike for polygons of
    one item and kind. A polygon of two corners is a line; others are counter-clockwise, with area and without repeated
    corners, flat or linearly shaded triangles.
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
    look: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @cached_property
    def sizes(self) -> Ints:
        """(m,) numbers of corners."""
        return np.diff(self.offsets)

    @cached_property
    def shaded(self) -> Bools:
        """(m,) whether the corners of a polygon differ in colour."""
        return shaded(self.colours, self.offsets)

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
    solid = fills if (fills.opacity > 0.0).all() else fills.take(np.flatnonzero(fills.opacity > 0.0))
    sizes = np.diff(solid.offsets)
    drawn = _with_flat_lines(Polygons(solid.points, solid.offsets, solid.colours, np.arange(len(solid))), sizes == 2)
    drawn = _fanned(drawn)
    drawn = _fanned(_clipped(drawn, width_mm, height_mm))
    microns, offsets, colours, kept = rounded(drawn)
    source = drawn.source[kept]
    opacity, blank = solid.opacity[source], np.isin(solid.kind[source], (FillKind.BACKGROUND, FillKind.BAND))
    item, kind = solid.item[source], solid.kind[source]
    run, part = _alike(solid, source, np.diff(offsets))
    group = groups_of(microns, offsets, run, part)
    bare = blank | ((opacity < 1.0) & (group < 0))
    none = np.full(len(group), -1), np.zeros(len(group), dtype=np.bool_)
    return with_fringes(
        Areas(microns, offsets, colours, opacity, bare, group, *none, item, len(FillKind) * item + kind)
    )


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
        areas.look[every],
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
    return take(joined(parts), np.argsort(np.concatenate(place), kind="stable"))


def shaded(colours: Colours, offsets: Ints) -> Bools:
    """(m,) whether the colours of a polygon's corners differ. Edge cases: those of none do not."""
    sizes = np.diff(offsets)
    other = any_component(colours != colours[np.repeat(np.minimum(offsets[:-1], max(len(colours) - 1, 0)), sizes)])
    count = ragged.offsets(other)[offsets]
    return np.asarray(count[1:] > count[:-1])


def _with_flat_lines(polygons: Polygons, line: Bools) -> Polygons:
    """The same, but both ends of lines have the mean of their colours."""
    which = np.flatnonzero(line & shaded(polygons.colours, polygons.offsets))
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
    split = (sizes > 3) & shaded(polygons.colours, polygons.offsets)
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
    return _in_order((take(polygons, others), fans), (others, owner))


def _clipped(polygons: Polygons, width_mm: float, height_mm: float) -> Polygons:
    low, high = np.full(2, -SEAM_MM), np.array((width_mm, height_mm)) + SEAM_MM
    beyond = np.any((polygons.points < low) | (polygons.points > high), axis=1)
    if not beyond.any():
        return polygons
    count = ragged.offsets(beyond)[polygons.offsets]
    out, line = count[1:] > count[:-1], np.diff(polygons.offsets) == 2
    inside, cut, crossing = (np.flatnonzero(which) for which in (~out, out & ~line, out & line))
    parts, owner = _cut(take(polygons, cut), low, high)
    lines, of_line = _cut_lines(take(polygons, crossing), low, high)
    return _in_order((take(polygons, inside), parts, lines), (inside, cut[owner], crossing[of_line]))


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
    new = any_component(microns != microns[ragged.preceding(polygons.offsets)])
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


def _areas(microns: Ints, offsets: Ints) -> Ints:
    """(m,) twice the signed areas of polygons, exactly."""
    sizes = np.diff(offsets)
    filled = np.flatnonzero(sizes > 0)
    area = np.zeros(len(sizes), dtype=np.int64)
    if len(filled):
        arm = microns - np.repeat(microns[offsets[filled]], sizes[filled], axis=0)
        before = arm[ragged.preceding(offsets)]
        cross = before[:, 0] * arm[:, 1] - before[:, 1] * arm[:, 0]
        area[filled] = np.add.reduceat(cross, offsets[filled])
    return area


# What every backend that makes a page draws: checked, clipped strokes and areas in thousandths of a millimetre.
#
# A backend turns PageMarks into bytes and needs six primitives for it: a page, a pen, a polyline, a Bézier path, a
# filled polygon, a shaded triangle. Because all of them draw the same integers, their pictures agree.

LARGEST_PAGE_MM = 1_000_000.0
"""A kilometre: cairo's coordinates wrap round at about three (2^23 points)."""

_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


@dataclass(frozen=True, eq=False)
class PageStrokes:
    """Strokes of one layer on the page. microns (p,2) int64, y upwards; offsets (m+1,); closed (m,); curved (m,): a
    cubic Bézier path, its first point and three more for each segment, handles perhaps beyond the page; the others
    are polylines without repeated neighbours, of two points or more, three if closed. arcs: curves that are arcs of
    ellipses, in mm.
    """

    microns: Ints
    offsets: Ints
    closed: Bools
    curved: Bools
    arcs: EllipseArcs

    def __len__(self) -> int:
        return len(self.offsets) - 1


@dataclass(frozen=True, eq=False)
class Ink:
    """What one layer puts on the page: strokes, areas and texts in drawing order."""

    label: str
    pen: Pen
    parts: tuple[PageStrokes | Areas | PageTexts, ...]

    @property
    def areas(self) -> tuple[Areas, ...]:
        """The parts that are areas."""
        return tuple(part for part in self.parts if isinstance(part, Areas))


@dataclass(frozen=True, eq=False)
class PageMarks:
    """A page and its inks in drawing order. Width and height in microns; title: one line without control characters."""

    width: int
    height: int
    inks: tuple[Ink, ...]
    title: str


def page_marks(drawing: Drawing) -> PageMarks:
    """The drawing as a backend sees it: clipped to the page, rounded to thousandths of a mm, without strokes that have
    no length and polygons that have no area. A layer's label is its number from 1 and its name, with the prefix % if
    it is not plotted.
    Errors: InputError for a point, page or pen width not finite, a page without area or larger than LARGEST_PAGE_MM, a
    colour other than #rrggbb, an opacity beyond 0 to 1.
    """
    check(drawing)
    inks = tuple(_ink(drawing, layer, number) for number, layer in enumerate(drawing.layers, start=1))
    width, height = (max(1, round(side * 1000.0)) for side in (drawing.width_mm, drawing.height_mm))
    return PageMarks(width, height, inks, plain_text(drawing.title))


def check(drawing: Drawing) -> None:
    """Refuse what no file can hold.

    Errors: as page_marks.
    """
    for side in (drawing.width_mm, drawing.height_mm):
        if not 0.0 < side <= LARGEST_PAGE_MM:
            size = f"{drawing.width_mm:g} x {drawing.height_mm:g} mm"
            raise InputError(f"page of {size}: sides must be more than 0 and at most {LARGEST_PAGE_MM:.0f} mm")
    for layer in drawing.layers:
        if not _COLOUR.fullmatch(layer.pen.colour):
            raise InputError(f"layer {layer.name!r}: colour {layer.pen.colour!r} is not #rrggbb")
        if not 0.0 < layer.pen.width_mm <= LARGEST_PAGE_MM:
            raise InputError(f"layer {layer.name!r}: pen width of {layer.pen.width_mm:g} mm")
        points = [paths.points for paths in layer.strokes]
        points += [mark.beziers.control for mark in layer.marks if isinstance(mark, CurvedStrokes)]
        points += [fills.points for fills in layer.fills]
        points += [array for some in layer.texts for array in (some.points, some.size_mm, some.turn_deg, some.anchor)]
        if not all(np.isfinite(some).all() for some in points):
            raise InputError(f"layer {layer.name!r}: a point on the page is not finite")
        if not all(((fills.opacity >= 0.0) & (fills.opacity <= 1.0)).all() for fills in layer.fills):
            raise InputError(f"layer {layer.name!r}: an opacity is not a number from 0 to 1")


def _ink(drawing: Drawing, layer: Layer, number: int) -> Ink:
    label = f"{'' if layer.plotted else '%'}{number} {plain_text(layer.name)}".rstrip()
    parts: list[PageStrokes | Areas | PageTexts] = []
    for kind, marks in groupby(layer.marks, _sort):
        some = tuple(marks)
        if kind is Fills:
            fills = Fills.joined(*(mark for mark in some if isinstance(mark, Fills)))
            parts.append(areas(fills, drawing.width_mm, drawing.height_mm))
        elif kind is Texts:
            texts = Texts.joined([mark for mark in some if isinstance(mark, Texts)])
            parts.append(page_texts(texts, layer.pen.colour, drawing.font))
        else:
            parts.append(_lines(drawing, one_mark(tuple(mark for mark in some if isinstance(mark, STROKES)))))
    return Ink(label, layer.pen, tuple(parts))


def _sort(mark: object) -> type:
    """Marks of one sort that follow one another are drawn together."""
    return next(sort for sort in (Fills, Texts, object) if isinstance(mark, sort))


def _lines(drawing: Drawing, mark: CurvedStrokes) -> PageStrokes:
    page = (0.0, 0.0, drawing.width_mm, drawing.height_mm)
    drawn_straight = np.flatnonzero(np.diff(mark.beziers.offsets) == 0)
    lines, line = clipped_parts(chosen(mark.paths, drawn_straight), page, drawing.page_from_world)
    beziers, curve = clipped_paths(mark.beziers, np.array(page[:2]), np.array(page[2:]))
    straight, kept = _without_repeats(lines)
    curved, stays = _control_polygons(beziers)
    source = np.concatenate((drawn_straight[line[kept]], curve[stays]))
    order = np.argsort(source, kind="stable")
    count = np.concatenate((np.diff(straight.offsets), np.diff(curved.offsets)))[order]
    first = np.concatenate((straight.offsets[:-1], curved.offsets[:-1] + len(straight.microns)))[order]
    return PageStrokes(
        np.concatenate((straight.microns, curved.microns))[ragged.ranges(first, count)],
        ragged.offsets(count),
        np.concatenate((straight.closed, curved.closed))[order],
        order >= len(straight.closed),
        _whole_arcs(mark, page, source[order]),
    )


@dataclass(frozen=True, eq=False)
class _Rounded:
    """Strokes with points in microns (p,2), offsets (m+1,) and closed (m,)."""

    microns: Ints
    offsets: Ints
    closed: Bools


def _in_microns(points: Floats) -> Ints:
    return np.rint(points * 1000.0).astype(np.int64)


def _without_repeats(paths: Paths) -> tuple[_Rounded, Bools]:
    """The strokes rounded, without repeated points and without strokes of no length; (m,) which of them remain."""
    microns = _in_microns(paths.points)
    counts = np.diff(paths.offsets)
    filled = np.flatnonzero(counts > 0)
    starts, ends = paths.offsets[:-1][filled], paths.offsets[1:][filled]
    new = np.ones(len(microns), dtype=np.bool_)
    new[1:] = (microns[1:] != microns[:-1]).any(axis=1)
    new[starts] = True
    # The last run of equal points of a loop is dropped if it repeats the first point.
    seam = paths.closed[filled] & all_components(microns[starts] == microns[ends - 1])
    places = np.flatnonzero(new)
    last = places[np.searchsorted(places, ends) - 1]
    new[last[seam & (last > starts)]] = False
    counts = np.add.reduceat(new.astype(np.intp), starts) if len(filled) else counts[filled]
    long = counts > 1
    points = microns[new][np.repeat(long, counts)]
    remains = np.zeros(len(paths), dtype=np.bool_)
    remains[filled[long]] = True
    return _Rounded(points, ragged.offsets(counts[long]), (paths.closed[filled] & (counts > 2))[long]), remains


def _control_polygons(paths: BezierPaths) -> tuple[_Rounded, Bools]:
    """The control points of each path, one row; without paths that are no longer than the rounding; (m,) which of them
    remain."""
    control = _in_microns(paths.control)
    size = np.diff(paths.offsets)
    if not len(size):
        return _Rounded(np.zeros((0, 2), np.int64), paths.offsets, paths.closed), np.zeros(0, dtype=np.bool_)
    moves = (control != control[np.repeat(paths.offsets[:-1], size), :1]).any(axis=(1, 2))
    remains = np.logical_or.reduceat(moves, paths.offsets[:-1])
    control = control[np.repeat(remains, size)]
    offsets = ragged.offsets(3 * size[remains] + 1)
    heads = ragged.offsets(size[remains])[:-1]
    microns = np.insert(control[:, 1:].reshape(-1, 2), 3 * heads, control[heads, 0], axis=0)
    return _Rounded(microns, offsets, paths.closed[remains]), remains


def _whole_arcs(mark: CurvedStrokes, page: Rectangle, source: Ints) -> EllipseArcs:
    """The arcs of strokes that the page does not cut; source (m,): the stroke of the mark of each stroke that is drawn,
    ascending."""
    control = mark.beziers.control
    out = ((control < page[:2]) | (control > page[2:])).any(axis=(1, 2))
    owner = ragged.owner(np.diff(mark.beziers.offsets))
    cut = np.bincount(owner[out], minlength=len(mark))[mark.arcs.stroke] > 0
    arcs = mark.arcs.take(~cut & np.isin(mark.arcs.stroke, source))
    return replace(arcs, stroke=np.searchsorted(source, arcs.stroke))
