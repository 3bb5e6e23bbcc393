"""How many sheets of each item are in front of points, by sight lines to the eye met with the true surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import inverse_matrix
from vectorplot.geometry.boxes import BoxStrips
from vectorplot.geometry.budget import Block, in_blocks, in_turn
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import (
    all_finite,
    cross,
    dot,
    from_components,
    greatest_component,
    least_component,
    norm,
)
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import ball_of
from vectorplot.tolerances import (
    CONTACT_MEETING,
    CONTACT_PLACES,
    GRAZING_ANGLE,
    LEAST_DIVISOR,
    LOCAL_MEETING,
    MET_OF_EXTENT,
    ONE_MEETING,
    ONE_MEETING_PLACES,
    SETTLED_OF_EXTENT,
    TOUCHING_OF_EXTENT,
)
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.sheets import ParametricSheet, Sheets

# Sheets as targets of sight lines and of curves: a tree over the images of their triangles.

STRIP = 16
"""Triangles, one beside the other, of which the tree has one box."""

BESIDE_EYE, MOST_HALVINGS = 1.0 / 16.0, 24
"""Triangles that reach before the near plane are divided, so many times at most, until their sides are no longer than
this part of their distance from the eye: those that still do so are then seen at more than 86 degrees."""


@dataclass(frozen=True, eq=False)
class Vertices:
    """The vertices (n,) of sheets that hide: points (n,3), places (n,3) on their sheets, image (n,2), depth (n,)."""

    points: Floats
    places: Floats
    image: Floats
    depth: Floats


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles (t,): the sheet of each; vertices (t,3); margin (t,): how far the image of the sheet may be off theirs;
    off (t,): how far the sheet is in space."""

    sheet: Ints
    vertices: Ints
    margin: Floats
    off: Floats


@dataclass(frozen=True, eq=False)
class Targets:
    """The triangles (t,) of sheets that hide, sheet after sheet, as far as they are in front of the eye, and the
    vertices that they have in common."""

    triangles: Triangles
    vertices: Vertices

    def __len__(self) -> int:
        return len(self.sheet)

    @property
    def sheet(self) -> Ints:
        """(t,) the sheet of each."""
        return self.triangles.sheet

    def take(self, which: Ints | Bools) -> Targets:
        """Some of the triangles, in their order."""
        return Targets(records.take(self.triangles, which), self.vertices)

    def range_of_sheet(self, number: int) -> slice:
        """Where the triangles of one sheet are."""
        first, last = np.searchsorted(self.sheet, [number, number + 1]).tolist()
        return slice(first, last)

    def of_sheet(self, number: int) -> Targets:
        """The triangles of one sheet."""
        return self.take(np.arange(len(self))[self.range_of_sheet(number)])

    def corners(self, which: Ints | slice) -> Floats:
        """(k,3,3) the corners in space of some of the triangles."""
        return self._of_corners(self.vertices.points, which)

    def places(self, which: Ints | slice) -> Floats:
        """(k,3,3) the places of the corners on their sheets."""
        return self._of_corners(self.vertices.places, which)

    def image(self, which: Ints | slice) -> Floats:
        """(k,3,2) the images of the corners."""
        return self._of_corners(self.vertices.image, which)

    def depth(self, which: Ints | slice) -> Floats:
        """(k,3) the depths of the corners."""
        return self._of_corners(self.vertices.depth, which)

    def _of_corners(self, values: Floats, which: Ints | slice) -> Floats:
        # take is several times as fast as an index between brackets.
        return values.take(self.triangles.vertices[which], axis=0)

    @cached_property
    def box(self) -> Floats:
        """(2,2) the box around the image, enlarged by the margins; empty without triangles."""
        low, high = self._boxes.low, self._boxes.high
        return np.stack([low.min(axis=1, initial=np.inf), high.max(axis=1, initial=-np.inf)])

    @cached_property
    def _boxes(self) -> BoxStrips:
        """(t,) boxes around the images of triangles, enlarged by their margins."""
        x, y = self.vertices.image.T
        margin = self.triangles.margin
        corners = [np.stack([x.take(column), y.take(column)]) for column in self.triangles.vertices.T]
        low, high = np.minimum(corners[0], corners[1]), np.maximum(corners[0], corners[1])
        return BoxStrips(np.minimum(low, corners[2]) - margin, np.maximum(high, corners[2]) + margin, STRIP)

    @property
    def boxes_of_sheets(self) -> tuple[Ints, BoxStrips]:
        """The sheets (s,) that there are triangles of, and a box around all triangles of each."""
        number, first = np.unique(self.sheet, return_index=True)
        low, high = self._boxes.low, self._boxes.high
        if not len(number):
            return number, BoxStrips(low, high, STRIP)
        low, high = np.minimum.reduceat(low, first, axis=1), np.maximum.reduceat(high, first, axis=1)
        return number, BoxStrips(low, high, 1)

    def may_reach(self, low: Floats, high: Floats) -> Bools:
        """(k,) which boxes (k,2), from low to high, overlap the one around all of them."""
        return np.asarray(((low <= self.box[1]) & (high >= self.box[0])).all(axis=1))

    def near_boxes(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Pairs of a box (k,2), from low to high, and a triangle whose box, enlarged by its margin, overlaps it."""
        close = np.flatnonzero(self.may_reach(low, high))
        if not len(close):
            return close, close
        box, triangle = self._boxes.overlapping(low[close].T, high[close].T)
        return close[box], triangle


def targets_of(view: View, sheets: Sheets) -> Targets:
    """The sheets as seen in a view; what is before the near plane is left out, and sheets that hide nothing."""
    hiding = [number for number, sheet in enumerate(sheets) if sheet.hides]
    own = [sheets[number] for number in hiding]
    none, nothing = np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp)
    points = np.concatenate([none, *(sheet.vertices for sheet in own)])
    places = np.concatenate([none, *(sheet.vertex_places for sheet in own)])
    image, depth = sight_lines.image(view, points), sight_lines.depth(view, points)
    first = ragged.starts([len(sheet.vertices) for sheet in own])
    corners = np.concatenate([nothing, *(sheet.corners + k for sheet, k in zip(own, first.tolist(), strict=True))])
    number = np.repeat(np.array(hiding, dtype=np.intp), [len(sheet.corners) for sheet in own])
    off = 2.0 * np.concatenate([none[:, 0], *(sheet.deviations for sheet in own)])
    nearest = np.minimum.reduce([depth.take(column) for column in corners.T])
    if not (nearest > view.near).all():
        points, places, corners, of = _divided_before_eye(view, points, places, corners)
        image, depth = sight_lines.image(view, points), sight_lines.depth(view, points)
        number, off = number[of], off[of]
        nearest = np.minimum.reduce([depth.take(column) for column in corners.T])
    scale = 1.0 if view.eye is None else view.focus / np.maximum(nearest, view.near)
    return Targets(Triangles(number, corners, off * scale, off), Vertices(points, places, image, depth))


def _divided_before_eye(view: View, points: Floats, places: Floats, corners: Ints) -> tuple[Floats, Floats, Ints, Ints]:
    """Vertices, points (n,3) and places (n,3), and triangles, corners (t,3), without those that reach before the near
    plane, which are divided as far as BESIDE_EYE says; and (t,) of which triangle each is a part."""
    of = np.arange(len(corners))
    for _ in in_turn(range(MOST_HALVINGS)):
        depth = sight_lines.depth(view, points)[corners]
        away = norm(sight_lines.sight(view, points))[corners].min(axis=1)
        ends = points[corners]
        size = np.max([norm(ends[:, k] - ends[:, k - 1]) for k in range(3)], axis=0)
        behind = depth.max(axis=1) <= view.near
        coarse = (depth.min(axis=1) <= view.near) & ~behind & (size > BESIDE_EYE * away)
        corners, of, coarse = corners[~behind], of[~behind], coarse[~behind]
        if not coarse.any():
            break
        a, b, c = corners[coarse].T
        ab, bc, ca = len(points) + np.arange(3 * len(a)).reshape(3, -1)
        points, places = (
            np.concatenate([one, *(0.5 * (one[x] + one[y]) for x, y in ((a, b), (b, c), (c, a)))])
            for one in (points, places)
        )
        count = np.where(coarse, 4, 1)
        first = ragged.starts(count)[coarse]
        corners, of = np.repeat(corners, count, axis=0), np.repeat(of, count)
        for k, parts in enumerate(((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))):
            corners[first + k] = np.stack(parts, axis=1)
    kept = sight_lines.depth(view, points)[corners].min(axis=1) > view.near
    return points, places, corners[kept], of[kept]


def weights(triangle: Floats, points: Floats) -> Floats:
    """(k,3) barycentric coordinates of points (k,2) in triangles (k,3,2); not finite for those seen edge-on."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    ab, ac, ap = b - a, c - a, points - a
    area = cross(ab, ac)
    with np.errstate(divide="ignore", invalid="ignore"):
        two = cross(ap, ac) / area
        three = cross(ab, ap) / area
        return np.stack([1.0 - two - three, two, three], axis=1)


def inside(weight: Floats) -> Floats:
    """(k,3) the nearest barycentric coordinates within the triangle, about."""
    # Triangles seen edge-on have no such coordinates: their middle is as good.
    clipped = np.clip(np.where(np.isfinite(weight), weight, 1.0 / 3.0), 0.0, 1.0)
    return np.asarray(clipped / clipped.sum(axis=1, keepdims=True))


def distance_to(triangle: Floats, points: Floats) -> Floats:
    """(k,) how far points (k,2) are from triangles (k,3,2), those seen edge-on as well; 0 in their insides."""
    corners = triangle.swapaxes(0, 1)
    away, turns = [], []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side, to = b - a, points - a
        along = np.clip(dot(side, to) / np.maximum(dot(side, side), LEAST_DIVISOR), 0.0, 1.0)
        off = to - along[:, None] * side
        away.append(dot(off, off))
        turns.append(cross(side, to))
    around = np.stack(turns, axis=1)
    within = (least_component(around) > 0.0) | (greatest_component(around) < 0.0)
    return np.where(within, 0.0, np.sqrt(least_component(np.stack(away, axis=1))))


# Numbers of sheets by item: of thousands of items a curve has to do with a few.


@dataclass(frozen=True, eq=False)
class Tally:
    """Whole numbers by row and item, 0 where there is no entry: row, item and value (n,) of each entry; entries of one
    row and item add up."""

    row: Ints
    item: Ints
    value: Ints

    def table(self, rows: int, items: int) -> Ints:
        """(rows, items) the numbers."""
        result = np.zeros((rows, items), dtype=np.intp)
        np.add.at(result, (self.row, self.item), self.value)
        return result

    def of_rows(self, which: Ints) -> Tally:
        """What is said of some rows (w,), which are numbered as they stand there."""
        order = np.argsort(self.row, kind="stable")
        row = self.row[order]
        first = np.searchsorted(row, which)
        sizes = np.searchsorted(row, which, side="right") - first
        own = order[ragged.ranges(first, sizes)]
        return Tally(ragged.owner(sizes), self.item[own], self.value[own])

    def in_rows(self, rows: Ints) -> Tally:
        """The same with these numbers (rows,) of the rows."""
        return Tally(rows[self.row], self.item, self.value)


def all_tallies(parts: Sequence[Tally]) -> Tally:
    """The entries of all parts."""
    none = np.zeros(0, dtype=np.intp)
    row, item, value = (
        np.concatenate([none, *columns])
        for columns in zip(*((part.row, part.item, part.value) for part in (no_tally(), *parts)), strict=True)
    )
    return Tally(row, item, value)


def no_tally() -> Tally:
    """Nothing but zeros."""
    none = np.zeros(0, dtype=np.intp)
    return Tally(none, none, none)


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells (c,) of a table of pieces and items in which something may stand: for every item that a curve has to do
    with one for each of its pieces, in a row.

    piece, item (c,): whose they are; pair (q,): curves and items in ascending order, as one number; first (q,): the
    first cell of each; items: how many there are; curve (p,): that of every piece, ascending; begin (p,): the first
    piece of that curve.
    """

    piece: Ints
    item: Ints
    pair: Ints
    first: Ints
    items: int
    curve: Ints
    begin: Ints

    @classmethod
    def of(cls, curve: Ints, tallies: Sequence[Tally]) -> Cells:
        """Those that tallies of pieces (p,) of curves (p,) say something of."""
        items = 1 + max((int(tally.item.max(initial=-1)) for tally in tallies), default=-1)
        pair = np.unique(np.concatenate([curve[tally.row] * items + tally.item for tally in tallies]))
        of, item = np.divmod(pair, max(items, 1))
        begin, end = np.searchsorted(curve, of), np.searchsorted(curve, of, side="right")
        sizes = end - begin
        return cls(
            ragged.ranges(begin, sizes),
            np.repeat(item, sizes),
            pair,
            ragged.starts(sizes),
            items,
            curve,
            np.searchsorted(curve, curve),
        )

    def values(self, tally: Tally) -> Ints:
        """(c,) the numbers of one of the tallies."""
        pair = np.searchsorted(self.pair, self.curve[tally.row] * self.items + tally.item)
        result = np.zeros(len(self.piece), dtype=np.intp)
        np.add.at(result, self.first[pair] + tally.row - self.begin[tally.row], tally.value)
        return result


ROUNDS = 12

ULPS = 16.0
"""Below the one there is nothing to gain; so many times the rounding of points is met too."""

SLANTING = 0.3
"""A sheet met at a lesser sine than this is met again near by, as its curvature says."""

FAR = 0.5
"""Farther away than this part of the extent curvature tells nothing of where a sheet is met again."""

NEAR_PLACES = 0.05
"""Places closer together than this part of the domain may be of one meeting near a point on its own sheet."""

FOUND = 3.0
"""A meeting up to so many times as far as curvature says is the one that was looked for."""

_Found = tuple[Ints, Ints, Ints]
"""Samples, and the sheets in front of them; and how many pairs with triangles of each sheet were looked at."""


@dataclass(frozen=True, eq=False)
class _Starts:
    """Where meetings are looked for: sample, sheet, place."""

    sample: Ints
    number: Ints
    places: Floats


@dataclass(frozen=True, eq=False)
class Met:
    """Meetings: sample, sheet, part of the sight line, place."""

    sample: Ints
    number: Ints
    t: Floats
    places: Floats


@dataclass(frozen=True, eq=False)
class Samples(Elements):
    """Points (k,3) to look from; own sheet (k,) or -1 and place (k,3) there; others (k,s) and other_places (k,s,3): s
    other sheets and places likewise; contour (k,): whether the point lies on the contour of its own sheet; cuspidal
    (k,): whether on a cuspidal edge of it."""

    points: Floats
    sheet: Ints
    places: Floats
    others: Ints
    other_places: Floats
    contour: Bools
    cuspidal: Bools

    def __len__(self) -> int:
        return len(self.points)

    @property
    def own(self) -> tuple[tuple[Ints, Floats, Bools], ...]:
        """The sheets of every point, one after the other: its number (k,), the place there (k,3), and whether (k,) the
        point lies on its contour."""
        none = np.zeros(len(self), dtype=np.bool_)
        others = zip(self.others.T, self.other_places.swapaxes(0, 1), strict=True)
        return (self.sheet, self.places, self.contour), *((number, places, none) for number, places in others)


def counts_in_front(view: View, sheets: Sheets, targets: Targets, samples: Samples, pairs: int) -> tuple[Tally, Tally]:
    """The number of sheets of items between the samples and the eye; and of which samples and items the budget's pairs,
    so many for each sheet, did not do: these samples see nothing of the sheets."""
    counts, unlooked = list[Tally](), list[Tally]()
    image = sight_lines.image(view, samples.points)
    rows = np.arange(len(samples))
    spent = np.zeros(len(sheets), dtype=np.intp)
    while len(rows) and len(targets):

        def look(rows: Ints, targets: Targets = targets) -> Block[_Found]:
            sample, triangle = targets.near_boxes(image[rows], image[rows])
            close = np.bincount(targets.sheet[triangle], minlength=len(sheets))
            found = _in_front(view, sheets, targets, samples.take(rows), (sample, triangle))
            return Block((rows[found[0]], found[1], close), len(sample), int(close.max(initial=0)))

        found, done = in_blocks(rows, pairs, len(targets), look)
        for sample, sheet, close in found:
            counts.append(Tally(sample, sheets.item[sheet], np.ones_like(sample)))
            spent += close
        rows = rows[done:]
        for number in np.flatnonzero(spent > pairs).tolist() if len(rows) else ():
            own = targets.of_sheet(number)
            mine = (samples.sheet[rows] == number) | (samples.others[rows] == number).any(axis=1)
            missed = rows[mine | own.may_reach(image[rows], image[rows])]
            unlooked.append(Tally(missed, np.full(len(missed), sheets.item[number]), np.ones_like(missed)))
            targets = targets.take(targets.sheet != number)
    return all_tallies(counts), all_tallies(unlooked)


AT_ONCE = 1 << 12
"""Sight lines that are met with everything at once."""


def meetings_along(view: View, sheets: Sheets, points: Floats, balls: Balls) -> Met:
    """All meetings of the sight lines of points (k,3) with sheets in front of these, each once; balls: those of the
    sheets, and all others."""
    none, nowhere = np.zeros(0, dtype=np.intp), np.zeros((0, 3))
    parts = [Met(none, none, np.zeros(0), nowhere)]
    image = sight_lines.image(view, points)
    for first in in_turn(range(0, len(points), AT_ONCE)):
        own = points[first : first + AT_ONCE]
        count = len(own)
        nothing, unknown = np.full(count, -1), np.full((count, 3), np.nan)
        no = np.zeros(count, dtype=np.bool_)
        samples = Samples(own, nothing, unknown, nothing[:, None], unknown[:, None], no, no)
        there = image[first : first + AT_ONCE]
        way = sight_lines.sight(view, own)
        found = [balls.met(view, own, way, *balls.near(there))]
        pairs = balls.others.near_boxes(there, there)
        if len(pairs[0]):
            found.append(_meetings(view, sheets, balls.others, samples, way, pairs))
        parts += [replace(each, sample=each.sample + first) for each in found]
    return records.joined(parts)


@dataclass(frozen=True, eq=False)
class Balls:
    """The whole spheres and ellipsoids among some sheets (s,), and what makes points of space points of the unit
    sphere: minus centre (s,3), times inverse (s,3,3). Lines meet them in closed form. number (b,): those that hide,
    boxes: around their images; others: the triangles of all other sheets."""

    centre: Floats
    inverse: Floats
    number: Ints
    boxes: BoxStrips
    others: Targets

    @classmethod
    def of(cls, sheets: Sheets, targets: Targets) -> Balls:
        """Those of some sheets and their triangles."""
        found = [ball_of(sheet.surface) if isinstance(sheet, ParametricSheet) else None for sheet in sheets]
        centre, frame = np.zeros((len(found), 3)), np.tile(np.eye(3), (len(found), 1, 1))
        for number, ball in enumerate(found):
            if ball is not None:
                centre[number], frame[number] = ball.centre, ball.frame
        known = np.array([ball is not None for ball in found], dtype=np.bool_)[targets.sheet]
        hiding, boxes = targets.take(known).boxes_of_sheets
        return cls(centre, inverse_matrix(frame), hiding, boxes, targets.take(~known))

    def near(self, image: Floats) -> tuple[Ints, Ints]:
        """Pairs of an image (k,2) and a ball in whose box it is, by the numbers of their sheets, in order."""
        sample, which = self.boxes.overlapping(image.T, image.T)
        order = np.lexsort((which, sample))
        return sample[order], self.number[which[order]]

    def met(self, view: View, points: Floats, ways: Floats, sample: Ints, number: Ints) -> Met:
        """Where the sight lines, along ways (k,3), of points (k,3) meet balls, for pairs of a sample and a sheet; not
        behind the eye."""
        inverse = self.inverse[number]
        here, way = (
            np.einsum("ki,kij->kj", rows, inverse) for rows in (points[sample] - self.centre[number], ways[sample])
        )
        square = dot(way, way)
        nearest = -dot(here, way) / square
        foot = here + nearest[:, None] * way
        depth = 1.0 - dot(foot, foot)
        crossing = np.flatnonzero(depth > 0.0)
        half = np.sqrt(depth[crossing] / square[crossing])
        t = (nearest[crossing] + np.array([[-1.0], [1.0]]) * half).T.ravel()
        both = np.repeat(crossing, 2)
        x, y, z = (here[both] + t[:, None] * way[both]).T
        u = np.mod(arctan2(y, x), 2.0 * np.pi)
        places = from_components(u, arctan2(z, np.hypot(x, y)), np.zeros_like(u))
        before = np.ones(len(t), dtype=np.bool_) if view.eye is None else t < 1.0
        return Met(sample[both][before], number[both][before], t[before], places[before])


def _in_front(
    view: View, sheets: Sheets, targets: Targets, samples: Samples, pairs: tuple[Ints, Ints]
) -> tuple[Ints, Ints]:
    """Samples (c,) and the sheets (c,) that lie between them and the eye, as often as they do; pairs: of a sample and a
    triangle that its sight line may meet."""
    way = sight_lines.sight(view, samples.points)
    long = np.linalg.norm(way, axis=1)
    met = _meetings(view, sheets, targets, samples, way, pairs)
    sample, number, meeting, places = met.sample, met.number, met.t, met.places
    distance = meeting * long[sample]
    grazing = np.abs(dot(sheets.normals(number, places), way[sample])) <= GRAZING_ANGLE * long[sample]
    front = (distance > TOUCHING_OF_EXTENT) & ~grazing
    if view.eye is not None:
        front &= meeting < 1.0
    looked_at = np.append(np.bincount(targets.sheet, minlength=len(sheets)) > 0, False)
    again_at: list[Ints] = []
    for own, own_places, contour in samples.own:
        mine = np.flatnonzero(own[sample] == number)
        apart = sheets.apart(number[mine], places[mine], own_places[sample[mine]])
        edge, near = contour[sample[mine]], distance[mine]
        close = np.flatnonzero(front[mine] & ~edge & (near < 0.5 * LOCAL_MEETING) & (apart < NEAR_PLACES))
        few, of = mine[close], sample[mine[close]]
        off = _off_own(sheets, number[few], own_places[of], samples.points[of], way[of])
        front[few] &= near[close] > FOUND * off
        front[mine] &= ~(edge & ((near < CONTACT_MEETING) | (apart < CONTACT_PLACES)))
        # The sheet itself and its second meeting nearby: the one is no meeting, the other is told below.
        # Both wings of a cuspidal edge leave it bent without bound: to second order tells nothing, and they end there.
        here = np.flatnonzero(looked_at[own] & ~contour & ~samples.cuspidal)
        again = np.full(len(samples), np.inf)
        again[here] = _second_meeting(sheets, own[here], way[here], own_places[here]) * long[here]
        nearby = np.abs(again) < LOCAL_MEETING
        reach = np.where(nearby, 2.0, 0.5) * LOCAL_MEETING
        # Nearer than curvature says the sheet is met again only beside a cuspidal edge: on its other wing.
        wing = np.abs(again[sample[mine]]) > FOUND * near
        front[mine] &= ~(~edge & ~wing & (np.abs(near) < reach[sample[mine]]) & (apart < NEAR_PLACES))
        here = here[nearby[here] & (again[here] > 0.0)]
        into = dot(sheets.inwards(own[here], own_places[here]), way[here]) >= 0.0
        again_at += [here[into], own[here[into]]]
    in_front = np.concatenate([sample[front], *again_at[::2]])
    return in_front, np.concatenate([number[front], *again_at[1::2]])


def _off_own(sheets: Sheets, number: Ints, places: Floats, points: Floats, way: Floats) -> Floats:
    """(k,) how far along sight lines points are from the sheets on which they lie at these places (k,3): edges of parts
    lie on their faces as well as files have it."""
    normals = sheets.normals(number, places)
    with np.errstate(divide="ignore", invalid="ignore"):
        part = dot(normals, sheets.points(number, places) - points) / dot(normals, way)
    return np.asarray(np.nan_to_num(np.abs(part) * np.linalg.norm(way, axis=1), posinf=0.0))


def _second_meeting(sheets: Sheets, number: Ints, way: Floats, places: Floats) -> Floats:
    """(k,) where the sight line meets the sheet again, to second order; in parts of the sight line."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(2.0 * dot(sheets.normals(number, places), way) / sheets.bends(number, places, way))


def _meetings(
    view: View, sheets: Sheets, targets: Targets, samples: Samples, way: Floats, pairs: tuple[Ints, Ints]
) -> Met:
    """All meetings of the sight lines with sheets in front of the points, each once, and some of those behind them."""
    image = sight_lines.image(view, samples.points)
    sample, triangle = pairs
    # What lies behind a point hides nothing of it.
    nearest = least_component(targets.depth(triangle)) - targets.triangles.off[triangle]
    before = nearest <= sight_lines.depth(view, samples.points)[sample]
    sample, triangle = sample[before], triangle[before]
    corners = targets.image(triangle)
    weight = weights(corners, image[sample])
    columns = corners.swapaxes(1, 2)
    size = greatest_component(greatest_component(columns) - least_component(columns))
    reach = targets.triangles.margin[triangle] + 0.02 * size
    near = distance_to(corners, image[sample]) <= reach
    sample, triangle, weight = sample[near], triangle[near], inside(weight[near])
    places, number = np.einsum("ij,ijk->ik", weight, targets.places(triangle)), targets.sheet[triangle]
    # Other starts where curvature says that the point's own sheets are met again.
    looked_at = np.append(np.bincount(targets.sheet, minlength=len(sheets)) > 0, False)
    starts = [_Starts(sample, number, places)]
    for sheet, at, contour in samples.own:
        mine = np.flatnonzero(looked_at[sheet] & ~contour)
        again = _second_meeting(sheets, sheet[mine], way[mine], at[mine])
        close = np.isfinite(again) & (np.abs(again) * np.linalg.norm(way[mine], axis=1) < FAR)
        mine, again = mine[close], again[close]
        there = sheets.moved(sheet[mine], at[mine], again[:, None] * way[mine])
        good = np.isfinite(there).all(axis=1)
        starts.append(_Starts(mine[good], sheet[mine[good]], there[good]))
    met = _solved(view, sheets, samples, way, records.joined(starts))
    met = _different(sheets, way, met)
    beside = _second_ones(sheets, way, met)
    if len(beside.sample):
        others = _solved(view, sheets, samples, way, beside)
        met = _different(sheets, way, records.joined((met, others)))
    return met


def _solved(view: View, sheets: Sheets, samples: Samples, way: Floats, starts: _Starts) -> Met:
    """What Newton's method finds from the starts, some of it more than once.

    From a point of a contour the sight line touches the sheet: steps towards the point only halve the way there, and
    what is found in the end is no meeting. They end where the place is that of the point.
    """
    sample, number, places = starts.sample, starts.number, starts.places.copy()
    t = np.zeros(len(sample))
    points, ways, own = samples.points[sample], way[sample], samples.places[sample]
    touching = samples.contour[sample] & (samples.sheet[sample] == number)
    off = np.full(len(sample), np.inf)
    active = np.arange(len(sample))
    for begun in range(ROUNDS):
        mine = np.flatnonzero(touching[active])
        these = active[mine]
        back = sheets.apart(number[these], places[these], own[these]) < CONTACT_PLACES
        off[these[back]] = np.inf
        active = np.delete(active, mine[back])
        if not len(active):
            break
        lines = (x.take(active, axis=0) for x in (points, ways, places))
        step, led_to, here = sheets.missed(number[active], *lines)
        if begun:
            # How far the last step missed is known where the next one is.
            off[active] = _apart(points[active], ways[active], t[active], here)
            on = np.flatnonzero((off[active] > SETTLED_OF_EXTENT) & np.isfinite(off[active]))
            active, step, led_to = active[on], step[on], led_to[on]
        t[active], places[active] = step, led_to
    off[active] = _apart(points[active], ways[active], t[active], sheets.points(number[active], places[active]))
    met = (off <= max(MET_OF_EXTENT, ULPS * sight_lines.rounding(view))) & sheets.on_sheet(number, places)
    return Met(sample[met], number[met], t[met], places[met])


def _second_ones(sheets: Sheets, way: Floats, met: Met) -> _Starts:
    """Where to look for the partners of meetings at a slant that none was found near.

    A sight line close to an outline meets the sheet twice close to each other, and the triangle of only one of the two
    meetings may be near it.
    """
    sample, number, t, places = met.sample, met.number, met.t, met.places
    long = np.linalg.norm(way, axis=1)[sample]
    slanting = np.abs(dot(sheets.normals(number, places), way[sample])) < SLANTING * long
    again = np.full(len(sample), np.inf)
    rows = np.flatnonzero(slanting)
    again[rows] = _second_meeting(sheets, number[rows], way[sample[rows]], places[rows])
    # Meetings stand sample after sample, sheet after sheet, in the order of their distances.
    one = (sample[1:] == sample[:-1]) & (number[1:] == number[:-1])
    gap = np.where(one, np.diff(t), np.inf)
    nearest = np.minimum(np.append(gap, np.inf), np.insert(gap, 0, np.inf))
    alone = np.flatnonzero((np.abs(again) * long < FAR) & (nearest > FOUND * np.abs(again)))
    sample, number, places = sample[alone], number[alone], places[alone]
    there = sheets.moved(number, places, again[alone, None] * way[sample])
    good = all_finite(there)
    return _Starts(sample[good], number[good], there[good])


def _apart(points: Floats, ways: Floats, t: Floats, others: Floats) -> Floats:
    """(k,) how far points + t ways are from other points."""
    away = points + t[:, None] * ways - others
    return np.sqrt(dot(away, away))


def _different(sheets: Sheets, way: Floats, met: Met) -> Met:
    """The meetings without repetitions, sorted by sample, sheet and distance."""
    distance = met.t * np.linalg.norm(way, axis=1)[met.sample]
    order = np.lexsort((distance, met.number, met.sample))
    for _ in range(3):
        s, n, d, at = met.sample[order], met.number[order], distance[order], met.places[order]
        same = (s[1:] == s[:-1]) & (n[1:] == n[:-1]) & (d[1:] - d[:-1] < ONE_MEETING)
        pair = np.flatnonzero(same)
        same[pair] = sheets.apart(n[pair], at[pair + 1], at[pair]) < ONE_MEETING_PLACES
        if not same.any():
            break
        order = order[np.concatenate([[True], ~same])]
    return records.take(met, order)
