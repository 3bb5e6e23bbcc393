"""Shaded triangles as larger polygons with one gradient each, and polygons that reach under their neighbours."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page import Areas, places_of
from vectorplot.errors import InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_boxes, overlapping_pairs
from vectorplot.geometry.budget import in_turn, slices
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.regions import polygons_of
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances import LEAST_DIVISOR

if TYPE_CHECKING:
    import shapely

# Shaded triangles as larger polygons with one gradient each.

ROUNDS = 5
"""Neighbours are taken together two and two, so many times."""


@dataclass(frozen=True, eq=False)
class Merged:
    """Convex polygons, counter-clockwise: microns (p,2), offsets (m+1,); values (p,) at the corners, which are linear
    on each within what was allowed; first, last (m,) the triangles that each is made of, which follow each other."""

    microns: Ints
    offsets: Ints
    values: Floats
    first: Ints
    last: Ints

    def __len__(self) -> int:
        return len(self.first)


def merged(corners: Ints, values: Floats, follows: Bools, allowed: Floats) -> Merged:
    """Triangles that follow each other, with common sides, as convex polygons on which values are linear.

    corners (t,3,2) in microns, counter-clockwise; values (t,3) at them; follows (t,): whether nothing is painted
    between a triangle and the one before it, and both may be one; allowed (t,): by how much values may be off.
    """
    every = np.arange(len(corners))
    found = Merged(corners.reshape(-1, 2), np.arange(0, 3 * len(corners) + 1, 3), values.ravel(), every, every)
    for _ in range(ROUNDS):
        joined = _round(found, follows, allowed)
        if len(joined) == len(found):
            break
        found = joined
    return found


def slopes(found: Merged) -> tuple[Floats, Floats, Floats]:
    """(m,2) middles of polygons, (m,) values there, and (m,2) how values change by the way, by least squares."""
    size = np.diff(found.offsets)
    start = found.offsets[:-1]
    middle = np.add.reduceat(found.microns.astype(np.float64), start) / size[:, None]
    value = np.add.reduceat(found.values, start) / size
    arm = found.microns - np.repeat(middle, size, axis=0)
    step = found.values - np.repeat(value, size)
    xx, xy, yy = (np.add.reduceat(arm[:, i] * arm[:, j], start) for i, j in ((0, 0), (0, 1), (1, 1)))
    xv, yv = (np.add.reduceat(arm[:, i] * step, start) for i in (0, 1))
    whole = xx * yy - xy * xy
    return middle, value, np.stack([yy * xv - xy * yv, xx * yv - xy * xv], axis=1) / whole[:, None]


def _round(found: Merged, follows: Bools, allowed: Floats) -> Merged:
    """The same with polygons and the ones after them as one, where that does."""
    start, end = _common_sides(found)
    owner = ragged.owner(np.diff(found.offsets))
    one = owner[start]
    near = follows[found.first[one + 1]]
    # The corners of the first from the end of the side on, then those of the second that are not on it.
    start, end, one = start[near], end[near], one[near]
    pairs = _joined(found, start, end, one)
    middle, value, slope = slopes(pairs) if len(pairs) else (np.zeros((0, 2)), np.zeros(0), np.zeros((0, 2)))
    size = np.diff(pairs.offsets)
    of = ragged.owner(size)
    linear = value[of] + ((pairs.microns - middle[of]) * slope[of]).sum(axis=1)
    good = np.ones(len(pairs), dtype=np.bool_)
    good[of[np.abs(linear - pairs.values) > allowed[pairs.first[of]]]] = False
    good[of[_turns(pairs) < 0]] = False
    one = one[good]
    # Of several that follow each other every second one.
    new = np.append(True, np.diff(one) != 1)[: len(one)]
    step = np.arange(len(one)) - np.maximum.accumulate(np.where(new, np.arange(len(one)), 0))
    chosen = np.flatnonzero(good)[step % 2 == 0]
    one = one[step % 2 == 0]
    left = np.ones(len(found), dtype=np.bool_)
    left[one] = left[one + 1] = False
    rest = np.flatnonzero(left)
    return _in_order((found, rest, rest), (pairs, chosen, one))


def _common_sides(found: Merged) -> tuple[Ints, Ints]:
    """The corners at which the only common side of a polygon and the next one begins, in the one and in the other."""
    place = places_of(found.microns)
    owner = ragged.owner(np.diff(found.offsets))
    after = next_positions(found.offsets, np.arange(len(place)))
    count = len(place)
    # Sides by their ends, whichever way they run, and by their polygons: numbers, which compare faster than pairs.
    ahead = place <= place[after]
    ends = np.minimum(place, place[after]) * count + np.maximum(place, place[after])
    side = np.unique(ends, return_inverse=True)[1].ravel()
    keys = 2 * (owner * count + side) + ahead
    # The same side, turned, in the polygon behind.
    asked = 2 * ((owner + 1) * count + side) + ~ahead
    order = np.argsort(keys, kind="stable")
    rows = keys[order]
    at = np.minimum(np.searchsorted(rows, asked), len(rows) - 1)
    start = np.flatnonzero(rows[at] == asked)
    other = order[at[start]]
    single = np.bincount(owner[start], minlength=len(found))[owner[start]] == 1
    start, other = start[single], other[single]
    # Where shades jump on the side it is an edge that is to be seen.
    same = (found.values[start] == found.values[after[other]]) & (found.values[after[start]] == found.values[other])
    return start[same], other[same]


def _joined(found: Merged, start: Ints, end: Ints, one: Ints) -> Merged:
    """Polygons (n,) with the next ones, the common sides of which begin at start (n,), and there at end (n,)."""
    size = np.diff(found.offsets)
    own, other = size[one], size[one + 1] - 2
    total = own + other
    step = ragged.place(total)
    of = ragged.owner(total)
    of_first = step < own[of]
    first, second = found.offsets[one][of], found.offsets[one + 1][of]
    corner = np.where(
        of_first,
        first + (start[of] - first + 1 + step) % size[one][of],
        second + (end[of] - second + 2 + step - own[of]) % size[one + 1][of],
    )
    return Merged(
        found.microns[corner], ragged.offsets(total), found.values[corner], found.first[one], found.last[one + 1]
    )


def _turns(found: Merged) -> Ints:
    """(p,) twice the areas of the triangles of corners and those before and after them."""
    if not len(found):
        return np.zeros(0, dtype=np.int64)
    after = next_positions(found.offsets, np.arange(len(found.microns)))
    way = found.microns[after] - found.microns
    back = np.empty_like(way)
    back[after] = way
    return np.asarray(back[:, 0] * way[:, 1] - back[:, 1] * way[:, 0])


def _in_order(*parts: tuple[Merged, Ints, Ints]) -> Merged:
    """Some of the polygons of each part by their places: parts of polygons, numbers and places (n,)."""
    place = np.concatenate([part[2] for part in parts])
    order = np.argsort(place, kind="stable")
    sizes = np.concatenate([np.diff(found.offsets)[which] for found, which, _ in parts])
    corner = [ragged.ranges(found.offsets[which], np.diff(found.offsets)[which]) for found, which, _ in parts]
    moved = ragged.ranges(ragged.offsets(sizes)[order], sizes[order])
    microns = np.concatenate([part[0].microns[k] for part, k in zip(parts, corner, strict=True)])
    values = np.concatenate([part[0].values[k] for part, k in zip(parts, corner, strict=True)])
    first, last = (np.concatenate([getattr(part[0], row)[part[1]] for part in parts]) for row in ("first", "last"))
    return Merged(microns[moved], ragged.offsets(sizes[order]), values[moved], first[order], last[order])


# Polygons that reach a little under their neighbours.
#
# Along a common side each of two polygons covers pixels in part, and what is behind shines through. So the one that is
# painted first goes on under the other, inside it, where nothing of it is seen but what the other lets through. Around
# a common corner the first one of all goes on under all others. Sides that have a part in common only are treated
# alike. A side without a neighbour stays where it is: what is behind it was painted before, and goes on there.

REACH_MICRONS = 320.0
"""So far polygons reach under others: more than a pixel of a screen of 96 dots per inch, slantwise as well."""

AROUND_MICRONS = 600.0
"""So far they reach around corners: then a square about the corner covers the pixels next to it."""

INSIDE = 0.9
"""Part of the height of the other polygon that is used at most."""

THIN_MICRONS = 700.0
"""Of polygons that are thinner several sides run through one pixel: amid others of about their colour, what reaches
under them goes on beyond."""

BEYOND_MICRONS = 75.0
"""So far that is."""

FARTHEST_MICRONS = 1300.0
"""So far they reach along the other sides of these at most."""

LOOKS = np.array((0.0, 0.05, 0.5, 0.95, 1.0))
"""Where along sides it is looked for what is beside them."""

ALIKE = 32.0
"""By no more of 255 are colours alike."""

CELLS_WIDE, _CELLS_A_POLYGON, _FEW_CELLS = 2.0, 16, 1 << 16
"""Cells are so many times as wide as half of the polygons; there are no more of them than so many a polygon, or so few,
and polygons reach into no more."""

HOLLOW_MICRONS = 75.0
"""So far polygons reach under others that are not convex, where these are twice as wide."""

APART_MICRONS = 20.0
"""Sides that are no farther apart, and run against each other, are common ones as far as both go."""

MOST_NEAR = 64
"""Neighbours are looked for if no more boxes are around a side, or a place, in the mean of some of them."""

FEW_NEAR = 1 << 22
"""Or if there are no more of them in all."""

CROWDED = (
    "so many polygons lie on one another that neighbours with a part of a side in common are not looked for: the edges "
    "between them may be seen as faint lines"
)
"""What is said where there are more."""

_ASKED_AT_ONCE = 1 << 12

MOST_CORNERS = 8
"""Nothing is added around corners of polygons that have more."""


@dataclass(frozen=True, eq=False)
class Underlaps:
    """What polygons are drawn as. side (k,): corners from which sides start that lie beside polygons painted later;
    near, far (k,2): corners, in microns, of what is added there, next to the start and to the end of the side. owner
    (n,): the polygons that whole polygons of four corners (n,4,2), counter-clockwise, are added to, ascending; along
    (n,): corners from which the sides start that these lie along, or around which they lie. open
    (m,): polygons with sides that are no common ones, or too little of which lies under the other, amid others of
    about their colour or in a group, which is cut off at its outline: elsewhere a line around them would be seen."""

    side: Ints
    near: Floats
    far: Floats
    open: Bools
    owner: Ints
    along: Ints
    added: Ints


@dataclass(frozen=True, eq=False)
class _Sides:
    """The sides of polygons by the corners that they start from: microns (p,2), after, before and owner (p,); which
    polygons cover what is below them, and which are convex (m,)."""

    areas: Areas
    microns: Ints
    after: Ints
    before: Ints
    owner: Ints
    covers: Bools
    convex: Bools

    def along(self, side: Ints) -> Floats:
        """(k,2) the ways from the starts of sides to their ends."""
        return (self.microns[self.after[side]] - self.microns[side]).astype(np.float64)

    def outwards(self, side: Ints) -> Floats:
        """(k,2) unit vectors across sides, out of their polygons."""
        way = self.along(side)
        return np.asarray(np.stack((way[:, 1], -way[:, 0]), axis=1) / np.hypot(*way.T)[:, None])

    def width(self) -> Floats:
        """(m,) the widths of polygons that are long strips, more than those of others."""
        x, y = self.microns.T.astype(np.float64)
        doubled = x * y[self.after] - x[self.after] * y
        length = np.hypot(*self.along(np.arange(len(self.microns))).T)
        count = len(self.covers)
        return np.bincount(self.owner, doubled, count) / np.bincount(self.owner, length, count)

    @cached_property
    def mean(self) -> Floats:
        """(m,3) the colours of polygons in the middle."""
        sums = np.add.reduceat(self.areas.colours.astype(np.float64), self.areas.offsets[:-1])
        return np.asarray(sums / self.areas.sizes[:, None])

    def alike(self, one: Ints, two: Ints) -> Bools:
        """(k,) whether polygons (k,) are of one item and kind and have about one colour."""
        near = (np.abs(self.mean[one] - self.mean[two]) <= ALIKE).all(axis=1)
        return np.asarray(near & (self.areas.look[one] == self.areas.look[two]))


def underlaps(areas: Areas) -> Underlaps:
    """What is added to polygons. Only those that hide what is below them grow, under each other; those that are blended
    together under those of their own group only."""
    microns, offsets, covers, group = areas.microns, areas.offsets, areas.solid, areas.group
    owner = ragged.owner(areas.sizes)
    after, before = ragged.following(offsets), ragged.preceding(offsets)
    sides = _Sides(areas, microns, after, before, owner, covers, _convex(microns, offsets, after, before))
    place = places_of(microns)
    able = np.flatnonzero(covers[owner])
    key, back = place * len(microns) + place[after], place[after] * len(microns) + place
    order = able[np.argsort(key[able], kind="stable")]
    at = np.searchsorted(key[order], back, side="right") - 1
    # The last one of the polygons on the other side.
    other = order[np.maximum(at, 0)] if len(order) else np.zeros(len(microns), dtype=np.intp)
    met = covers[owner] & (at >= 0)
    met[met] = (key[other[met]] == back[met]) & (group[owner[other[met]]] == group[owner[met]])
    later = np.flatnonzero(met & (owner[other] > owner))
    hollow = later[~sides.convex[owner[other[later]]]]
    later = later[sides.convex[owner[other[later]]]]
    beyond = other[later]
    # The other polygon comes along this side from its end to its start.
    under = np.flatnonzero(met)[owner[other[met]] < owner[met]]
    turns = ((beyond, before[beyond], before[beyond]), (after[beyond], after[after[beyond]], after[beyond]))
    ways, high, part = zip(
        *(_inwards(sides, beyond, end, beside, np.isin(own, under)) for end, beside, own in turns), strict=True
    )
    far, near = microns[after[later]] + part[0] * ways[0], microns[later] + part[1] * ways[1]
    found = _partly_common(sides, np.flatnonzero(covers[owner] & ~met))
    thin = np.minimum(*high) < THIN_MICRONS
    open_ = np.zeros(len(covers), dtype=np.bool_)
    open_[owner[~met]] = open_[owner[hollow]] = open_[owner[later[thin]]] = open_[owner[beyond[thin]]] = True
    beside = np.append(np.flatnonzero(met), found.side), np.append(owner[other[met]], owner[found.other])
    looked = open_ & covers & ~_with_unlike_sides(sides, *beside)
    plainly = _plainly_amid(sides, looked, np.flatnonzero(covers[owner] & ~met))
    amid = plainly | _amid(sides, looked & ~plainly)
    # A line around those that are open does the same, but meshes have none.
    thin = later[thin & amid[owner[beyond]] & areas.meshed[owner[later]]]
    # A group is cut off at its outline.
    open_ &= covers & (amid | (group >= 0))
    reach = np.concatenate((np.full(len(thin), BEYOND_MICRONS), _under_hollow(sides, other[hollow])))
    wide = np.concatenate((thin, hollow))
    strips = [_strips(sides, wide, microns[wide], microns[after[wide]], reach)]
    strips += _along_parts(sides, found, amid)
    whole = covers[owner] & sides.convex[owner] & met & met[before]
    side = np.concatenate([number for number, _ in strips])
    around, squares = _squares(microns, owner, place, _rooms(microns, offsets, owner), whole)
    side = np.append(side, around)
    first = np.argsort(owner[side], kind="stable")
    added = np.concatenate((*(corners for _, corners in strips), squares))[first]
    return Underlaps(later, near, far, open_, owner[side[first]], side[first], added)


def _inwards(sides: _Sides, side: Ints, end: Ints, beside: Ints, closed: Bools) -> tuple[Floats, Floats, Floats]:
    """(k,2) ways into polygons from ends of their sides (k,), as corners, how far each leads from the line of the side,
    and (k,1) the part of it that is gone: along the next side, which joins the end to a corner beside it. Where that
    goes on nearly straight, and far, and is closed by a third polygon that goes on under it: straight inwards, for what
    lies along a border is seen at it."""
    way, along = (sides.microns[beside] - sides.microns[end]).astype(np.float64), sides.along(side)
    length = np.hypot(*along.T)
    high = np.abs(cross(along, way)) / length
    part = np.minimum(REACH_MICRONS / np.maximum(high, LEAST_DIVISOR), INSIDE)
    onwards = np.where(end == side, -1.0, 1.0)[:, None] * along / length[:, None]
    ahead = (onwards * way).sum(axis=1)
    far = np.flatnonzero(closed & (ahead > 0.0) & (part * np.hypot(*way.T) > FARTHEST_MICRONS))
    # A polygon has the triangle between both sides and its middle, at least.
    of = sides.owner[side[far]]
    middle = np.add.reduceat(sides.microns, sides.areas.offsets[:-1])[of] / sides.areas.sizes[of, None]
    arm, straight = middle - sides.microns[end[far]], -sides.outwards(side[far])
    x = (onwards[far] * arm).sum(axis=1)
    base = np.where(x > 0.0, length[far], ahead[far])
    room = (straight * arm).sum(axis=1) * base / (base + np.abs(x))
    # Under thin ones nothing goes so far that they need none of each other.
    wide = room >= REACH_MICRONS
    high[far[wide]] = room[wide]
    way[far[wide]] = straight[wide] * room[wide, None]
    return way, high, np.minimum(REACH_MICRONS / np.maximum(high, LEAST_DIVISOR), INSIDE)[:, None]


def _with_unlike_sides(sides: _Sides, side: Ints, neighbour: Ints) -> Bools:
    """(m,) the polygons that have a side, but for where the picture ends, without a neighbour of about their colour;
    neighbour (k,): polygons beside sides (k,)."""
    unlike = np.ones(len(sides.owner), dtype=np.bool_)
    unlike[side] = False
    unlike[side[~sides.alike(sides.owner[side], neighbour)]] = True
    ends = np.stack((sides.microns, sides.microns[sides.after]))
    border = (ends == sides.microns.min(axis=0, initial=0)) | (ends == sides.microns.max(axis=0, initial=0))
    unlike &= ~border.all(axis=0).any(axis=1)
    return np.asarray(np.bincount(sides.owner, weights=unlike, minlength=len(sides.covers)) > 0.0)


def _plainly_amid(sides: _Sides, which: Bools, ends: Ints) -> Bools:
    """(m,) those of some polygons (m,) that lie amid others as in _amid, and in a neighbourhood that says so by itself:
    in cells around them there are polygons of their item and about their colour alone, and no side that is no common
    one, ends (k,): then others cover all places there."""
    covers = np.flatnonzero(sides.covers)
    corner, offsets = ragged.take(sides.areas.offsets, covers)
    if not which.any():
        return which
    points = sides.microns[corner]
    low, high = (f.reduceat(points, offsets[:-1]) for f in (np.minimum, np.maximum))
    cell = max(CELLS_WIDE * float(np.median(high - low)), 2.0 * BEYOND_MICRONS)
    origin, far = points.min(axis=0) - BEYOND_MICRONS, points.max(axis=0) + BEYOND_MICRONS
    columns, rows = (((far - origin) // cell).astype(np.intp) + 1).tolist()
    if columns * rows > max(_CELLS_A_POLYGON * len(covers), _FEW_CELLS):
        return np.zeros_like(which)

    def cells(low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """(p,) the cells that boxes (n,2) reach into, those of one after those of another, and (n+1,) offsets."""
        (x, y), (right, top) = (((end - origin) // cell).astype(np.intp).T for end in (low, high))
        wide = right - x + 1
        sizes = wide * (top - y + 1)
        at, box = ragged.place(sizes), ragged.owner(sizes)
        return (y[box] + at // wide[box]) * columns + x[box] + at % wide[box], ragged.offsets(sizes)

    spans = (((high - low) // cell) + 2).prod(axis=1).sum()
    if spans > _CELLS_A_POLYGON * len(covers) + _FEW_CELLS:
        return np.zeros_like(which)
    rows_of = np.column_stack([sides.mean, sides.areas.look])[covers]
    within, first = cells(low, high)
    of = ragged.owner(np.diff(first))
    least, most = np.full((columns * rows, 4), np.inf), np.full((columns * rows, 4), -np.inf)
    for k in range(4):
        np.minimum.at(least[:, k], within, rows_of[of, k])
        np.maximum.at(most[:, k], within, rows_of[of, k])
    open_ = np.zeros(columns * rows, dtype=np.bool_)
    side = np.stack((sides.microns[ends], sides.microns[sides.after[ends]]))
    open_[cells(side.min(axis=0), side.max(axis=0))[0]] = True
    asked = np.flatnonzero(which[covers])
    around, first = cells(low[asked] - BEYOND_MICRONS, high[asked] + BEYOND_MICRONS)
    least, most = np.minimum.reduceat(least[around], first[:-1]), np.maximum.reduceat(most[around], first[:-1])
    own, may = rows_of[asked], np.array((ALIKE, ALIKE, ALIKE, 0.0))
    alike = ((own - least <= may) & (most - own <= may)).all(axis=1)
    found = np.zeros_like(which)
    found[covers[asked]] = alike & ~np.logical_or.reduceat(open_[around], first[:-1])
    return found


def _amid(sides: _Sides, which: Bools) -> Bools:
    """(m,) which of some polygons (m,) lie amid others of their item and of about their colour: so do all places
    BEYOND_MICRONS beside their sides, with none of another colour over these that would be painted over, but for those
    beyond where the picture ends."""
    import shapely

    side = np.flatnonzero(which[sides.owner])
    if not len(side):
        return which
    start, way = sides.microns[side], sides.along(side)
    places = start + LOOKS[:, None, None] * way + BEYOND_MICRONS * sides.outwards(side)
    owner = np.tile(sides.owner[side], len(LOOKS))
    places = places.reshape(-1, 2)
    low, high = sides.microns.min(axis=0), sides.microns.max(axis=0)
    inside = ((places < low) | (places > high)).any(axis=1)
    solid = np.flatnonzero(sides.covers)
    corner, offsets = ragged.take(sides.areas.offsets, solid)
    tree = shapely.STRtree(polygons_of(sides.microns[corner].T.astype(np.float64), offsets))
    for some, (place, found) in _near(tree, places):
        own, there = owner[some], solid[found]
        # What reaches there is painted over by later ones, and over earlier ones: the last one is seen but for it.
        top = np.full(len(own), -1, dtype=np.intp)
        np.maximum.at(top, place, there)
        hidden = (top > own) | sides.alike(own, top)
        inside[some][place[sides.alike(own[place], there) & hidden[place]]] = True
    return np.asarray(which & (np.bincount(owner, weights=~inside, minlength=len(which)) == 0.0))


def _is_crowded(found: int, asked: int, count: int) -> bool:
    """Whether more boxes are in one another's way than MOST_NEAR allows, by those found around some of all, which is
    said in an InputWarning."""
    crowded = found * (count / max(asked, 1)) > max(MOST_NEAR * count, FEW_NEAR)
    if crowded:
        warnings.warn(CROWDED, InputWarning, stacklevel=6)
    return crowded


def _near(tree: shapely.STRtree, places: Floats) -> Iterator[tuple[slice, NDArray[np.int64]]]:
    """Runs of places (n,2), and (2,k) which of each meet which shapes of a tree, all of one place before those of the
    next; nothing where they are crowded."""
    import shapely

    some = shapely.points(places[:: 1 + len(places) // _ASKED_AT_ONCE])
    if _is_crowded(tree.query(some).shape[1], len(some), len(places)):
        return
    for run in in_turn(slices(len(places), _ASKED_AT_ONCE)):
        yield run, tree.query(shapely.points(places[run]), predicate="intersects")


def _under_hollow(sides: _Sides, other: Ints) -> Floats:
    """(k,) how far one reaches under polygons that are not convex, by sides (k,) of these."""
    return np.minimum(HOLLOW_MICRONS, sides.width()[sides.owner[other]]) if len(other) else np.zeros(0)


def _strips(sides: _Sides, side: Ints, start: Ints, end: Ints, reach: Floats) -> tuple[Ints, Ints]:
    """Sides (k,), and (k,4,2) rectangles of widths (k,) beside their parts from start to end (k,2)."""
    out = reach[:, None] * sides.outwards(side)
    corners = np.stack((end.astype(np.float64), start.astype(np.float64), start + out, end + out), axis=1)
    return side, np.rint(corners).astype(np.int64)


@dataclass(frozen=True, eq=False)
class _Parts:
    """Sides (k,) that run against other sides (k,) along a part of them, from low to high (k,2)."""

    side: Ints
    other: Ints
    low: Floats
    high: Floats


def _partly_common(sides: _Sides, alone: Ints) -> _Parts:
    """The common parts of sides without a partner, alone (n,): each of two by the one and by the other."""
    alone = alone[np.hypot(*sides.along(alone).T) > APART_MICRONS]
    ends = np.stack((sides.microns[alone], sides.microns[sides.after[alone]])).astype(np.float64)
    flat = np.zeros((1, len(alone)))
    low, high = np.vstack((ends.min(axis=0).T - APART_MICRONS, flat)), np.vstack((ends.max(axis=0).T, flat))
    some = slice(None, None, 1 + len(alone) // _ASKED_AT_ONCE)
    found = len(overlapping_boxes(low[:, some], high[:, some], low, high)[0])
    if _is_crowded(found, len(flat[0, some]), len(alone)):
        return _Parts(alone[:0], alone[:0], np.zeros((0, 2)), np.zeros((0, 2)))
    pair = np.column_stack(overlapping_pairs(low, high))
    pair = np.concatenate((pair, pair[:, ::-1]))
    pair = alone[pair[np.lexsort(pair.T[::-1])]]
    parts = [_common_parts(sides, *pair[chunk].T) for chunk in in_turn(slices(max(len(pair), 1), PAIRS_AT_ONCE))]
    joined = [np.concatenate([getattr(part, name) for part in parts]) for name in ("side", "other", "low", "high")]
    return _Parts(*joined)


def _common_parts(sides: _Sides, one: Ints, two: Ints) -> _Parts:
    """The common parts of pairs of sides (n,) of polygons of one group, by the first of each."""
    own, next_ = sides.owner[one], sides.owner[two]
    kept = (own != next_) & (sides.areas.group[own] == sides.areas.group[next_])
    one, two = one[kept], two[kept]
    way, start = sides.along(one), sides.microns[one]
    length = np.hypot(*way.T)
    way /= length[:, None]
    # Where the other side, which runs back, begins and ends along this one, and how far beside it.
    arms = np.stack((sides.microns[two], sides.microns[sides.after[two]])) - start
    last, first = (arms * way).sum(axis=2)
    beside = cross(arms, way)
    span = np.stack((np.maximum(first, 0.0), np.minimum(last, length)))
    off = beside[1] + (span - first) * (beside[0] - beside[1]) / np.maximum(last - first, 1.0)
    kept = (span[1] - span[0] > APART_MICRONS) & (np.abs(off) <= APART_MICRONS).all(axis=0)
    low, high = start + span[0][:, None] * way, start + span[1][:, None] * way
    return _Parts(one[kept], two[kept], low[kept], high[kept])


def _along_parts(sides: _Sides, parts: _Parts, amid: Bools) -> list[tuple[Ints, Ints]]:
    """What is added along the common parts of sides, under the later ones of their polygons: sides, and (k,4,2)
    corners; amid (m,): polygons beyond which there are others of their colour."""
    later = sides.owner[parts.side] < sides.owner[parts.other]
    one, two, low, high = parts.side[later], parts.other[later], parts.low[later], parts.high[later]
    below = sides.owner[two]
    # Towards the middle of a convex polygon one stays inside.
    number, inverse = np.unique(below, return_inverse=True)
    corner, offsets = ragged.take(sides.areas.offsets, number)
    sums = np.diff(np.concatenate((np.zeros((1, 2)), np.cumsum(sides.microns[corner], axis=0)))[offsets], axis=0)
    middle = (sums / np.diff(offsets)[:, None])[inverse]
    deep = ((middle - low) * sides.outwards(one)).sum(axis=1)
    part = np.clip(REACH_MICRONS / np.maximum(deep, LEAST_DIVISOR), 0.0, INSIDE)[:, None]
    inner = np.stack((high, low, low + part * (middle - low), high + part * (middle - high)), axis=1)
    convex = sides.convex[below] & (deep > 0.0)
    thin = convex & amid[below] & (2.0 * deep < THIN_MICRONS) & sides.areas.meshed[sides.owner[one]]
    reach = np.where(convex, BEYOND_MICRONS, _under_hollow(sides, two))
    wide = thin | ~sides.convex[below]
    return [
        (one[convex], np.rint(inner[convex]).astype(np.int64)),
        _strips(sides, one[wide], low[wide], high[wide], reach[wide]),
    ]


def _squares(microns: Ints, owner: Ints, place: Ints, room: Floats, whole: Bools) -> tuple[Ints, Ints]:
    """The squares around corners on all sides of which there are polygons: these, and (n,4,2) corners.

    place (p,): numbers of the places of corners; room (p,): how far their polygons reach there; whole (p,): whether
    both sides there are common ones.
    """
    count = int(place.max(initial=-1)) + 1
    inner = np.bincount(place, weights=~whole, minlength=count) == 0.0
    least = np.full(count, np.inf)
    np.minimum.at(least, place, room)
    first = np.full(count, len(owner), dtype=np.intp)
    np.minimum.at(first, place, np.arange(len(owner)))
    used = np.flatnonzero(inner & (least > 0.0))
    corner = np.sort(first[used])
    half = np.minimum(AROUND_MICRONS, INSIDE * least[place[corner]]) / np.sqrt(2.0)
    turns = np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return corner, microns[corner][:, None] + np.rint(half).astype(np.int64)[:, None, None] * turns


def _rooms(microns: Ints, offsets: Ints, owner: Ints) -> Floats:
    """(p,) how far corners of polygons are from the sides that do not end there; 0 in those of MOST_CORNERS or more."""
    sizes = np.diff(offsets)[owner]
    at, start = np.arange(len(microns)) - offsets[owner], offsets[owner]
    room = np.where(sizes <= MOST_CORNERS, np.inf, 0.0)
    for step in range(1, MOST_CORNERS - 1):
        some = np.flatnonzero((sizes > step + 1) & (sizes <= MOST_CORNERS))
        one = start[some] + (at[some] + step) % sizes[some]
        two = start[some] + (at[some] + step + 1) % sizes[some]
        way, arm = (microns[two] - microns[one]).astype(np.float64), (microns[some] - microns[one]).astype(np.float64)
        far = np.abs(cross(way, arm)) / np.hypot(way[:, 0], way[:, 1])
        room[some] = np.minimum(room[some], far)
    return room


def grown(areas: Areas, found: Underlaps) -> tuple[Ints, Ints, Ints]:
    """The polygons with what is added to them: corners, offsets, and (m+1,) where the parts of each begin."""
    outlines, ends = _with_laps(areas.microns, areas.offsets, found)
    count = len(areas)
    corners = np.concatenate((outlines, found.added.reshape(-1, 2)))
    place = np.concatenate((ragged.owner(np.diff(ends)), np.repeat(found.owner, 4)))
    sizes = np.concatenate((np.diff(ends), np.full(len(found.owner), 4)))
    part = np.argsort(np.concatenate((np.arange(count), found.owner)), kind="stable")
    first = np.searchsorted(np.sort(np.concatenate((np.arange(count), found.owner))), np.arange(count + 1))
    return corners[np.argsort(place, kind="stable")], ragged.offsets(sizes[part]), first


def _with_laps(microns: Ints, offsets: Ints, found: Underlaps) -> tuple[Ints, Ints]:
    """Corners and offsets of the polygons with what is added along their sides."""
    added = np.rint(np.stack((found.near, found.far), axis=1)).astype(np.int64).reshape(-1, 2)
    place = np.concatenate((np.arange(len(microns)), np.repeat(found.side, 2)))
    order = np.argsort(place, kind="stable")
    sizes = np.diff(offsets) + 2 * np.bincount(ragged.owner(np.diff(offsets))[found.side], minlength=len(offsets) - 1)
    return np.concatenate((microns, added))[order], ragged.offsets(sizes)


def _convex(microns: Ints, offsets: Ints, after: Ints, before: Ints) -> Bools:
    """(m,) which polygons turn to the left at all corners."""
    one, two = microns - microns[before], microns[after] - microns
    right = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0] < 0
    count = ragged.offsets(right)[offsets]
    return np.asarray(count[1:] == count[:-1])
