"""Labels, dimensions and numbers of level lines on the page: places apart from lines and each other, and marks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import Any, Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.formulas import FORMULA, without_formulas_in_strokes
from vectorplot.drawing.letters import Lettering, broken_at_blanks, lettered, typeset
from vectorplot.drawing.pens import PENS
from vectorplot.drawing.strokes import chosen, concatenated, joined, split_long
from vectorplot.drawing.text_along import (
    grown,
    inside_box,
    lettered_along,
    near_boxes,
    outside_boxes,
    outside_others,
    reads_backwards,
    typeset_along,
)
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import MeshCurves
from vectorplot.features.terrain_water import label_places
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import segments
from vectorplot.scene.annotations import LabelAnchors
from vectorplot.scene.labels import Along, BesidePoint, Label, OnCurve, OnPage, times
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances import COINCIDENT_MM, LEAST_DIVISOR
from vectorplot.visibility.hidden_points import points_hidden_by
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import LineKind

# How long the strokes in rectangles of the page are, by a grid over the page.

MOST_CELLS = 1 << 22
"""A finer grid would take more memory than the strokes."""


@dataclass(frozen=True, eq=False)
class StrokeLengths:
    """Strokes in pieces that lie in one cell of a grid each.

    begin, end (p,2): the pieces, cell by cell; first (c+1,): the first piece of each of the cells, row by row; corner
    (2,): of the grid; side: of its cells; columns, rows: how many there are; sums (rows+1, columns+1): how long the
    pieces are in all cells below and to the left.
    """

    begin: Floats
    end: Floats
    first: Ints
    corner: Floats
    side: float
    columns: int
    rows: int
    sums: Floats

    @classmethod
    def of(cls, start: Floats, end: Floats, side: float) -> StrokeLengths:
        """Of straight strokes from start to end (s,2), in cells of about this side."""
        every = np.concatenate([start, end, np.zeros((0 if len(start) else 1, 2))])
        corner, size = every.min(axis=0), np.ptp(every, axis=0)
        side = max(side, float(np.sqrt(size.prod() / MOST_CELLS)), float(size.max()) / MOST_CELLS)
        columns, rows = (int(count) + 1 for count in np.floor(size / side))
        a, b = (start - corner) / side, (end - corner) / side
        low, high = (np.floor(bound(a, b)).astype(np.intp) for bound in (np.minimum, np.maximum))
        cuts = high - low
        segment, at = [np.arange(len(a)), np.arange(len(a))], [np.zeros(len(a)), np.ones(len(a))]
        for axis in (0, 1):
            owner = ragged.owner(cuts[:, axis])
            line = ragged.ranges(low[:, axis] + 1, cuts[:, axis])
            segment.append(owner)
            at.append((line - a[owner, axis]) / (b - a)[owner, axis])
        number, t = np.concatenate(segment), np.clip(np.concatenate(at), 0.0, 1.0)
        order = np.lexsort((t, number))
        number, t = number[order], t[order]
        piece = np.flatnonzero(number[1:] == number[:-1])
        number, before, after = number[piece], t[piece], t[piece + 1]
        way = (b - a)[number]
        begin, stop = a[number] + before[:, None] * way, a[number] + after[:, None] * way
        column, row = (
            np.clip(np.floor(0.5 * (begin + stop)[:, axis]).astype(np.intp), 0, count - 1)
            for axis, count in enumerate((columns, rows))
        )
        cell = row * columns + column
        order = np.argsort(cell, kind="stable")
        begin, stop = corner + side * begin[order], corner + side * stop[order]
        first = np.searchsorted(cell[order], np.arange(rows * columns + 1))
        lengths = np.bincount(cell[order], np.hypot(*(stop - begin).T), minlength=rows * columns)
        sums = np.zeros((rows + 1, columns + 1))
        sums[1:, 1:] = lengths.reshape(rows, columns).cumsum(axis=0).cumsum(axis=1)
        return cls(begin, stop, first, corner, side, columns, rows, sums)

    def at_least(self, boxes: Floats) -> Floats:
        """(b,) the lengths in the cells that lie in boxes (b,2,2) as a whole: not more than those in the boxes."""
        low, high = self._whole(boxes)
        some = (high > low).all(axis=1)
        (left, bottom), (right, top) = low[some].T, high[some].T
        found = np.zeros(len(boxes))
        found[some] = self.sums[top, right] - self.sums[top, left] - self.sums[bottom, right] + self.sums[bottom, left]
        return np.maximum(found, 0.0)

    def inside(self, boxes: Floats) -> Floats:
        """(b,) the lengths in boxes (b,2,2), smallest and largest coordinates."""
        last = np.array([self.columns, self.rows]) - 1
        scaled = (boxes - self.corner) / self.side
        low = np.maximum(np.floor(scaled[:, 0]).astype(np.intp), 0)
        high = np.minimum(np.floor(scaled[:, 1]).astype(np.intp), last)
        rows = np.maximum(high[:, 1] - low[:, 1] + 1, 0)
        box = ragged.owner(rows)
        cells = ragged.ranges(low[:, 1], rows) * self.columns
        begin = self.first[cells + np.minimum(low[box, 0], self.columns)]
        end = self.first[cells + np.maximum(high[box, 0] + 1, 0)]
        count = np.maximum(end - begin, 0)
        piece, owner = ragged.ranges(begin, count), np.repeat(box, count)
        start, way = self.begin[piece], self.end[piece] - self.begin[piece]
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = ((boxes[owner, side] - start) / way for side in (0, 1))
        # What runs beside an axis is in between all the way, or nowhere.
        level = way == 0.0
        between = (start > boxes[owner, 0]) & (start < boxes[owner, 1])
        enters = np.where(level, np.where(between, 0.0, np.inf), np.minimum(one, other)).max(axis=1, initial=0.0)
        leaves = np.where(level, 1.0, np.maximum(one, other)).min(axis=1, initial=1.0)
        long = np.hypot(*way.T) * np.maximum(leaves - enters, 0.0)
        return np.asarray(np.bincount(owner, long, minlength=len(boxes)), dtype=np.float64)

    def _whole(self, boxes: Floats) -> tuple[Ints, Ints]:
        """(b,2) the first cells that lie in boxes as a whole, and (b,2) those after the last ones."""
        scaled = (boxes - self.corner) / self.side
        size = np.array([self.columns, self.rows])
        low = np.clip(np.ceil(scaled[:, 0]), 0, size).astype(np.intp)
        return low, np.clip(np.floor(scaled[:, 1]), 0, size).astype(np.intp)


# Where labels stand beside what they name: apart from lines and from each other.

DIRECTIONS = {
    "right": (1.0, 0.0),
    "above_right": (1.0, 1.0),
    "above": (0.0, 1.0),
    "above_left": (-1.0, 1.0),
    "left": (-1.0, 0.0),
    "below_left": (-1.0, -1.0),
    "below": (0.0, -1.0),
    "below_right": (1.0, -1.0),
    "centre": (0.0, 0.0),
}
"""On which side of its point a label is, across and up."""

RINGS = (0.0, 1.2, 2.7, 4.7, 7.7)
"""How much farther than need be from its point a label is tried, in heights of capitals; at all but the first one it
has a leader."""

ON_A_RING = 16
"""Directions in which a label is tried on every ring but the first."""

CROSSED, FAR, INWARD, MOVED, TAKEN, OFF_PAGE = 2.0, 2.0, 0.5, 0.3, 100.0, 1000.0
"""What counts against a place: strokes in it, for each height of a capital of their length; every ring; that it lies
towards the middle of the picture; that it was moved onto the page; another label, its point or the own one there; that
it leaves the page."""

PREFERRED = 0.02
"""What counts against each place more than against the one before it in the order of directions: so there are no
ties."""


CELL = 0.5
"""The sides of cells that tell how many strokes are in a place, in heights of capitals of the smallest labels."""

AT_ONCE = 4
"""So many places are looked at closely at once."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where labels are: middles (l,2) of their boxes; leaders (k,2,2) from a point to the letters that stand far off,
    and of which label (k,) each is."""

    middles: Floats
    leaders: Floats
    label: Sequence[int]


def places(
    anchors: Floats,
    sizes: Floats,
    height: Floats,
    gap: Floats,
    asked: Sequence[str],
    start: Floats,
    end: Floats,
    page: Floats,
    taken: Floats,
) -> Places:
    """Where labels stand: greedily, each at the least cost. anchors (l,2): what they name; sizes (l,2): of their boxes;
    height (l,): of capitals; gap (l,): from the point to the letters; asked: words of DIRECTIONS, or auto; start,
    end (s,2): strokes; page (2,2): corners; taken (b,2,2): boxes without labels, smallest and largest coordinates.
    All in mm.
    Source: Christensen, Marks and Shieber, An empirical study of algorithms for point-feature label placement, ACM
    Trans. Graphics 14 (1995).
    """
    middle = (
        0.5 * (np.minimum(start, end).min(axis=0) + np.maximum(start, end).max(axis=0))
        if len(start)
        else 0.5 * page.sum(axis=0)
    )
    tried = [_tried(*row) for row in zip(anchors, sizes, height.tolist(), gap.tolist(), asked, strict=True)]
    counts = [len(one) for one in tried]
    every = np.concatenate([np.zeros((0, 3)), *tried])
    label = np.repeat(np.arange(len(tried)), counts)
    fixed = np.array([word != "auto" for word in asked], dtype=np.bool_)
    middles = np.where(fixed[label, None], every[:, :2], _onto(page, every[:, :2], sizes[label], gap[label]))
    moved = (middles != every[:, :2]).any(axis=1)
    boxes = np.stack([middles - 0.5 * sizes[label], middles + 0.5 * sizes[label]], axis=1)
    lengths = StrokeLengths.of(start, end, CELL * float(height.min(initial=np.inf)) if len(height) else 1.0)
    weight = CROSSED / height[label]
    against = weight * lengths.at_least(boxes) + FAR * every[:, 2]
    against += OFF_PAGE * ((boxes[:, 0] < page[0]) | (boxes[:, 1] > page[1])).any(axis=1)
    against += INWARD * _inward(middles, anchors[label], middle)
    own = ((boxes[:, 0] < anchors[label]) & (boxes[:, 1] > anchors[label])).all(axis=1)
    against += moved * (MOVED + TAKEN * own)
    # The points of other labels are not covered.
    against += TAKEN * _covered(boxes, anchors, label)
    first = np.concatenate([[0], np.cumsum(counts)])
    chosen = np.zeros(len(tried), dtype=np.intp)
    count, occupied = len(taken), np.concatenate([taken, np.zeros((len(tried), 2, 2))])
    # Labels that were told where to stand come first.
    for number in np.argsort(~fixed, kind="stable").tolist():
        mine = slice(int(first[number]), int(first[number + 1]))
        cost = against[mine] + PREFERRED * np.arange(counts[number])
        cost = cost + TAKEN * _overlapping(boxes[mine], occupied[:count])
        chosen[number] = first[number] + _cheapest(cost, weight[mine], lengths, boxes[mine])
        occupied[count] = boxes[chosen[number]]
        count += 1
    far = np.flatnonzero(every[chosen, 2] > 0.0)
    feet = np.clip(anchors[far], boxes[chosen[far], 0], boxes[chosen[far], 1])
    return Places(middles[chosen], np.stack([anchors[far], feet], axis=1), far.tolist())


def _tried(anchor: Floats, size: Floats, height: float, gap: float, asked: str) -> Floats:
    """(c,3) middles of the boxes that are tried for a label, and the ring each is on."""
    if asked != "auto":
        way = np.array([DIRECTIONS[asked]])
        return np.column_stack([anchor + _beside(way, size, gap), np.zeros(1)])
    order = ("above_right", "above", "right", "above_left", "left", "below_right", "below", "below_left")
    found = []
    angle = np.arange(ON_A_RING) * (2.0 * np.pi / ON_A_RING) + np.pi / 4.0
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for ring, distance in enumerate(RINGS):
        way = circle if ring else np.array([DIRECTIONS[word] for word in order])
        middle = anchor + _beside(way, size, gap + distance * height)
        found.append(np.column_stack([middle, np.full(len(way), ring)]))
    return np.concatenate(found)


def _onto(page: Floats, middles: Floats, sizes: Floats, gap: Floats) -> Floats:
    """(c,2) middles of boxes, moved so that these are a gap away from the edges of the page; as they are across or
    upwards where it has no room for them."""
    low, high = page[0] + 0.5 * sizes + gap[:, None], page[1] - 0.5 * sizes - gap[:, None]
    return np.where(low <= high, np.clip(middles, low, np.maximum(low, high)), middles)


def _beside(way: Floats, size: Floats, gap: float) -> Floats:
    """(c,2) from a point to the middle of a box that lies beside it in directions (c,2), a gap between."""
    long = np.maximum(np.hypot(*way.T), 1.0)[:, None]
    sign = np.where(np.abs(way) > 0.5, np.sign(way), way)
    return np.asarray(0.5 * size * sign + gap * way / long)


def _cheapest(cost: Floats, weight: Floats, lengths: StrokeLengths, boxes: Floats) -> int:
    """Which box costs least, where weights times the lengths of the strokes in them count; cost has those lengths only
    as far as they are known without looking at single strokes. So few boxes need that."""
    cost, exact = cost.copy(), np.zeros(len(cost), dtype=np.bool_)
    while not exact[np.argmin(cost)]:
        some = np.argsort(np.where(exact, np.inf, cost), kind="stable")[: min(AT_ONCE, int((~exact).sum()))]
        box = boxes[some]
        cost[some] += weight[some] * (lengths.inside(box) - lengths.at_least(box))
        exact[some] = True
    return int(np.argmin(cost))


def _inward(middles: Floats, anchors: Floats, middle: Floats) -> Floats:
    """(c,) from 0 for what lies away from the middle of the picture to 1 for what lies towards it."""
    one, other = middles - anchors, middle - anchors
    long = np.hypot(*one.T) * np.hypot(*other.T)
    return np.asarray(0.5 + 0.5 * (one * other).sum(axis=1) / np.where(long > 0.0, long, 1.0))


def _covered(boxes: Floats, anchors: Floats, label: Ints) -> Floats:
    """(c,) how many points of other labels lie in the boxes (c,2,2) that are tried for labels (c,)."""
    import shapely

    tree = shapely.STRtree(shapely.points(anchors))
    box, point = tree.query(shapely.box(*boxes[:, 0].T, *boxes[:, 1].T))
    inside = ((anchors[point] > boxes[box, 0]) & (anchors[point] < boxes[box, 1])).all(axis=1)
    other = (anchors[point] != anchors[label[box]]).any(axis=1)
    return np.asarray(np.bincount(box[inside & other], minlength=len(boxes)), dtype=np.float64)


def _overlapping(boxes: Floats, others: Floats) -> Ints:
    """(c,) how many of others (n,2,2) each of boxes (c,2,2) overlaps."""
    (left, bottom), (right, top) = boxes[:, 0].T[:, :, None], boxes[:, 1].T[:, :, None]
    over = (left < others[:, 1, 0]) & (right > others[:, 0, 0]) & (bottom < others[:, 1, 1]) & (top > others[:, 0, 1])
    return np.asarray(over.sum(axis=1))


# The labels that a picture shows.


@dataclass(frozen=True, eq=False)
class SeenLabels:
    """Labels that a picture shows: anchors; points (l,2) on the page, by how many items (l,) each is hidden."""

    anchors: LabelAnchors
    points: Floats
    hidden_by: Ints

    def chosen(self, which: Ints) -> SeenLabels:
        """Some of them, in this order."""
        given = self.anchors
        labels, courses = (tuple(row[k] for k in which.tolist()) for row in (given.labels, given.courses))
        return SeenLabels(LabelAnchors(labels, given.points[which], courses), self.points[which], self.hidden_by[which])


def seen_labels(
    scene: Scene, view: View, faces: ProjectedFaces, placement: Placement, anchors: LabelAnchors, wires: bool, mm: float
) -> SeenLabels:
    """The labels on the page of which what they name is before the eye and on the page.

    anchors: of the scene as it was read; wires: nothing hides anything; mm: how long a millimetre is in
    units of the page.
    """
    on_page = np.array([isinstance(label.at, OnPage) for label in anchors.labels], dtype=np.bool_)
    inside = np.flatnonzero(~on_page)
    points = view.points_of(anchors.points[inside])
    ahead = view.depth_of(points) > view.near
    inside, points = inside[ahead], points.compress(ahead, axis=1)
    found = np.full((len(anchors), 2), np.nan)
    found[inside] = placement.on_page(view.image_of(points))
    for number in np.flatnonzero(on_page).tolist():
        at = anchors.labels[number].at
        assert isinstance(at, OnPage)
        found[number] = at.x_mm * mm, at.y_mm * mm
    hidden = np.zeros(len(anchors), dtype=np.intp)
    if not wires and len(inside):
        hidden[inside] = points_hidden_by(scene, view, faces, points)
    page = placement.page
    with np.errstate(invalid="ignore"):
        shown = ((found >= 0.0) & (found <= (page.width_mm, page.height_mm))).all(axis=1)
    return SeenLabels(anchors, found, hidden).chosen(np.flatnonzero(shown | on_page))


# The letters of labels: plain ones beside points, and those along curves.

HALO_MM = 0.6
"""Lines end so far before the letters."""

GAP = 0.4
"""From a point to the letters beside it, in heights of capitals."""


@dataclass(frozen=True)
class Letters:
    """How texts become letters: plain ones, and those along curves."""

    plain: Callable[..., Lettering]
    along: Callable[..., Lettering]


def _stroked(text: str, *where: Any, **how: Any) -> Lettering:
    return lettered(without_formulas_in_strokes(text), *where, **how)


def _stroked_along(text: str, *where: Any, **how: Any) -> Lettering:
    return lettered_along(without_formulas_in_strokes(text), *where, **how)


def _typeset_along(
    text: str, path: Floats, *, size_mm: float, level: Literal["base", "middle", "top"], at: float, off_mm: float
) -> Lettering:
    """Letters of a font along a course: one text where it is straight, as readers find it."""
    way = path[-1] - path[0]
    long = float(np.hypot(*way))
    away = path - path[0]
    if not long > 0.0 or np.abs(away[:, 0] * way[1] - away[:, 1] * way[0]).max() > COINCIDENT_MM * long:
        return typeset_along(text, path, size_mm=size_mm, level=level, at=at, off_mm=off_mm)
    x, y = (way / long).tolist()
    if reads_backwards(x, y):
        x, y = -x, -y
    middle = path[0] + at * way + off_mm * np.array([-y, x])
    turn = float(np.degrees(arctan2(y, x)))
    return typeset(text, tuple(middle.tolist()), size_mm=size_mm, align="centre", level=level, rotation_deg=turn)


LETTERS = {"strokes": Letters(_stroked, _stroked_along), "real": Letters(typeset, _typeset_along)}
"""What letters are: strokes of a pen, or those of the fonts of whatever reads the file."""


def set_label(letters: Letters, label: Label, room: float, mm: float) -> Lettering:
    """A label beside a point, in several lines where it is wider than there is room; no formula is broken.

    Errors: InputError, with its name, for a character without strokes.
    """

    def set_(text: str) -> Lettering:
        return letters.plain(text, size_mm=times(label.capitals_mm, mm), align="centre")

    def fits(text: str) -> bool:
        return float(np.ptp(set_(text).bounds, axis=0)[0]) <= room

    try:
        if FORMULA.search(label.text) or fits(label.text):
            return set_(label.text)
        return set_("\n".join(broken_at_blanks(line, fits) for line in label.text.split("\n")))
    except InputError as error:
        raise InputError(f"label {label.name}: {error.cause}") from None


def course_on_page(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(n,2) on the page, the course of the curve that a label stands along."""
    course, projection = seen.anchors.courses[number], placement.projection
    assert course is not None
    points = projection.points_of(course)
    ahead = projection.depth_of(points) > projection.near
    return placement.on_page(projection.image_of(points.compress(ahead, axis=1)))


def length_of(path: Floats) -> float:
    """The length of a polyline (n,2)."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def set_along(
    letters: Letters, seen: SeenLabels, number: int, path: Floats, mm: float, place: str = "", at: float | None = None
) -> Lettering:
    """Letters along the course of a curve on the page; place and at: other ones than those of the label."""
    label = seen.anchors.labels[number]
    steps = np.hypot(*np.diff(path, axis=0).T)
    nearest = int(np.argmin(np.hypot(*(path - seen.points[number]).T)))
    whole = float(steps.sum())
    part = float(steps[:nearest].sum()) / whole if whole else 0.0
    size = times(label.capitals_mm, mm)
    level, off = {"above": ("base", GAP), "below": ("top", -GAP)}.get(place or label.place, ("middle", 0.0))
    part = part if at is None else at
    try:
        return letters.along(label.text, path, size_mm=size, level=level, at=part, off_mm=off * size)
    except InputError as error:
        raise InputError(f"label {label.name}: {error.cause}") from None


# The marks of labels: dots, crosses, arrowheads and ticks.

MARK_MM = 0.6
"""Half of the size of marks at points."""

ARROW_MM, ARROW_SLOPE = 2.8, 0.18
"""The length of arrowheads, and half of their width as a part of it (ISO 129: between 15 and 30 degrees)."""

TICK = 1.5
"""Half of the length of ticks across curves, beside that of other marks."""


def direction_at(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(2,) the unit direction on the page of the curve that a label is at a point of; at its beginning out of it."""
    course, at = seen.anchors.courses[number], seen.anchors.labels[number].at
    assert course is not None and isinstance(at, OnCurve)
    projection, last = placement.projection, len(course) - 1
    nearest = int(np.argmin(np.linalg.norm(course - seen.anchors.points[number], axis=1)))
    ends = projection.points_of(course[[max(nearest - 1, 0), min(nearest + 1, last)]])
    way = np.diff(placement.on_page(projection.image_of(ends)), axis=0)[0]
    long = float(np.hypot(*way))
    return np.asarray(way / long * (-1.0 if at.part == 0.0 else 1.0)) if long > 0.0 else np.zeros(2)


def marked(label: Label, point: Floats, way: Floats, mm: float) -> list[Floats]:
    """The strokes of the mark at the point of a label, where a curve has the direction way.

    Edge cases: no arrowheads and no ticks where the curve is seen end-on, way is zero.
    """
    if label.mark in ("arrow", "tick") and not way.any():
        return []
    size, left = MARK_MM * mm, np.array([-way[1], way[0]])
    if label.mark == "tick":
        return [np.stack([point - TICK * size * left, point + TICK * size * left])]
    if label.mark == "arrow":
        back = point - ARROW_MM * mm * way
        wings = ARROW_MM * mm * ARROW_SLOPE * left
        # The stroke along the middle makes it dark.
        return [np.stack([point, back + wings, back - wings, point, back])]
    if label.mark == "cross":
        return [point + size * np.array(ends) for ends in (((-1.0, 0.0), (1.0, 0.0)), ((0.0, -1.0), (0.0, 1.0)))]
    if label.mark == "dot":
        angle = np.linspace(0.0, 2.0 * np.pi, 17)
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        # Two rounds of a pen fill a dot.
        return [point + 0.7 * size * circle, point + 0.3 * size * circle]
    return []


# Labels that are not to be missed, and of others those that there is room for.

TICKS_APART_MM = 1.0
"""Ticks that are nearer to each other are left out."""

BETWEEN = 0.3
"""From the number at a tick to the next one, at least, in heights of capitals."""


def labels_with_room(seen: SeenLabels, some: Sequence[int], mm: float) -> list[int]:
    """Of some labels, without those that are dispensable and would stand in the room of one before them; mm: how long a
    millimetre is in units of the page."""
    rooms = {k: at for k in some if isinstance(at := seen.anchors.labels[k].at, BesidePoint)}
    corners = mm * np.array([(at.low_mm, at.high_mm) for at in rooms.values()]).reshape(-1, 2, 2)
    corners += seen.points[[*rooms]][:, None]
    without, taken = set[int](), np.zeros((0, 2, 2))
    for (k, at), corner in zip(rooms.items(), corners, strict=True):
        if at.is_dispensable and ((taken[:, 0] < corner[1]) & (taken[:, 1] > corner[0])).all(axis=1).any():
            without.add(k)
        else:
            taken = np.concatenate([taken, corner[None]])
    return [k for k in some if k not in without]


def ticks_with_room(seen: SeenLabels, placement: Placement, mm: float) -> SeenLabels:
    """The labels without numbers at ticks that would stand in those before them on the same curve, and without ticks
    that are hardly apart: of a curve that is seen end-on there are none. mm: see labels_with_room."""
    curves: dict[str, list[tuple[float, int]]] = {}
    for number, label in enumerate(seen.anchors.labels):
        if isinstance(label.at, OnCurve) and label.mark == "tick":
            curves.setdefault(label.at.item, []).append((label.at.part, number))
    labels, kept = [*seen.anchors.labels], np.ones(len(seen.anchors), dtype=np.bool_)
    for ticks in curves.values():
        # Numbers keep half their length from the beginning, where those of other axes may be.
        tick = last = _beginning(seen, ticks[0][1], placement)
        share = 0.5
        for _, number in sorted(ticks):
            point, label = seen.points[number], labels[number]
            kept[number] = float(np.hypot(*(point - tick))) >= TICKS_APART_MM * mm
            if not kept[number]:
                continue
            tick = point
            if _is_clear(label, point - last, share, mm):
                last, share = point, 1.0
            else:
                labels[number] = replace(label, text="")
    anchors = replace(seen.anchors, labels=tuple(labels))
    return replace(seen, anchors=anchors).chosen(np.flatnonzero(kept))


def _is_clear(label: Label, way: Floats, share: float, mm: float) -> bool:
    """Whether a text that is moved by way (2,) is clear of a share of one of the same size where it was."""
    size = times(label.capitals_mm, mm)
    room = np.ptp(typeset(label.text, size_mm=size).bounds, axis=0) + BETWEEN * size
    return bool((np.abs(way) >= share * room).any())


def _beginning(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(2,) on the page, where the curve of a label begins before the eye."""
    course, projection = seen.anchors.courses[number], placement.projection
    assert course is not None
    points = projection.points_of(course)
    ahead = projection.depth_of(points) > projection.near
    return np.asarray(placement.on_page(projection.image_of(points.compress(ahead, axis=1)[:, :1]))[0])


# Where the texts of dimensions have room: above their lines, or else below them or beyond an arrowhead (ISO 129-1).

ROOM_FOR_HEAD = 1.25
"""A line that is shorter than so many arrowheads, for each of its own, has them outside, pointing at it."""

TAIL = 2.0
"""The line goes on so far outside, in arrowheads."""


@dataclass(frozen=True, eq=False)
class Measure:
    """A text of a dimension, and the strokes (n,2,2) on which its line goes on under it; under (2,): from the text to
    these."""

    text: Lettering
    tails: Floats
    under: Floats = field(default_factory=lambda: np.zeros(2))

    @property
    def room(self) -> Floats:
        """(b,4,2) what it takes, with its line."""
        boxes = self.text.boxes
        return np.concatenate([boxes, boxes + self.under]) if self.under.any() else boxes


def arrowheads(seen: SeenLabels) -> dict[str, tuple[float, ...]]:
    """At what parts of its length each curve has arrowheads, by the name of its item."""
    found: dict[str, tuple[float, ...]] = {}
    for label in seen.anchors.labels:
        if label.mark == "arrow" and isinstance(label.at, OnCurve):
            found[label.at.item] = (*found.get(label.at.item, ()), label.at.part)
    return found


def heads_outside(length: float, heads: Sequence[float], mm: float) -> bool:
    """Whether a line of a length on the page has no room for its arrowheads, several; mm: how long a millimetre is
    there."""
    return len(heads) > 1 and length < ROOM_FOR_HEAD * ARROW_MM * mm * len(heads)


def tail(point: Floats, way: Floats, mm: float) -> Floats:
    """(2,2) the line behind an arrowhead that points at its end along way (2,) from outside."""
    return np.stack([point, point - TAIL * ARROW_MM * mm * way])


def measures_tried(
    path: Floats,
    heads: Sequence[float],
    usual: Lettering,
    set_at: Callable[[str, float], Lettering],
    gap: float,
    mm: float,
) -> list[Measure]:
    """Where the text of a dimension may stand along its line (n,2), the best first; usual: the text above it.

    heads: see arrowheads; set_at: the text above or below, at a part of the length of the line, outside of 0 to 1
    beyond its ends; gap: from the end of the line to a text beyond it.
    """
    whole = float(np.hypot(*np.diff(path, axis=0).T).sum())
    none = np.zeros((0, 2, 2))
    found = [Measure(usual, none)]
    wide = float(np.ptp(matmul(usual.boxes.reshape(-1, 2), _way(path))))
    if whole > ASIDE * wide:
        found += [Measure(set_at("above", part), none) for part in (0.3, 0.7)]
    found.append(Measure(set_at("below", 0.5), none))
    begins = TAIL * ARROW_MM * mm if heads_outside(whole, heads, mm) else 0.0
    backwards = reads_backwards(*(path[-1] - path[0]).tolist())
    for at in sorted(set(heads), reverse=not backwards):
        end, before = (path[0], path[1]) if at == 0.0 else (path[-1], path[-2])
        step = end - before
        if not step.any():
            continue
        way = step / np.hypot(*step)
        wide = float(np.ptp(matmul(usual.boxes.reshape(-1, 2), way)))
        beyond = (begins + gap + 0.5 * wide) / whole
        text = set_at("above", -beyond if at == 0.0 else 1.0 + beyond)
        line = end + np.array([[[begins], [begins + gap + wide]]]) * way
        up = np.array([-way[1], way[0]])
        side = float(np.sign(matmul(text.boxes.reshape(-1, 2).mean(axis=0) - end, up))) if len(text.boxes) else 0.0
        found.append(Measure(text, line, -(2.0 * gap * side) * up))
    return [*found, *_raised(path, usual, gap)]


def _way(path: Floats) -> Floats:
    """(2,) the direction from the beginning to the end of a polyline, of length 1; zeros for one that closes."""
    way = path[-1] - path[0]
    long = float(np.hypot(*way))
    return np.asarray(way / long if long > 0.0 else np.zeros(2))


def _raised(path: Floats, usual: Lettering, gap: float) -> list[Measure]:
    """A text one and two rows farther from its line, at the end of a line from its middle."""
    middle = 0.5 * (path[0] + path[-1])
    box = usual.boxes.reshape(-1, 2)
    if not len(box):
        return []
    off = box.mean(axis=0) - middle
    way = _way(path)
    off = off - float(matmul(off, way)) * way
    long = float(np.hypot(*off))
    if not long > 0.0:
        return []
    out = off / long
    high = float(np.ptp(matmul(box, out)))
    rows = [(high + 2.0 * gap) * k for k in (1, 2)]
    return [Measure(usual.moved(row * out), np.array([[middle, middle + (row + 0.5 * gap) * out]])) for row in rows]


ASIDE = 2.2
"""A text may stand aside from the middle of a line that is so many times as long."""


def with_room(
    tried: Mapping[int, Sequence[Measure]], strokes: Paths, page: Floats, margin: float
) -> dict[int, Measure]:
    """Of each label the text on the page (2,2) that is over no other of them and interrupts least of the strokes, of
    several the first one.

    margin: what keeps letters and strokes apart; the thin lines of other annotations, such as extension lines, may end
    at the letters without one.
    """
    every = [(label, measure) for label, some in tried.items() for measure in some]
    boxes = [measure.room for _, measure in every]
    owner = np.repeat(np.arange(len(every)), [len(own) for own in boxes])
    corners = np.concatenate([np.zeros((0, 4, 2)), *boxes])
    thin = strokes.kind == int(LineKind.LABEL)
    long = np.zeros(len(every))
    for some, around in ((~thin, grown(corners, margin)), (thin, corners)):
        lines = chosen(strokes, some)
        start, end = lines.points[segments(lines)].transpose(1, 0, 2)
        segment, box = near_boxes(start, end, around)
        low, high = inside_box(start[segment], end[segment], around[box])
        inside = np.maximum(high - low, 0.0) * np.hypot(*(end - start)[segment].T)
        long += np.bincount(owner[box], inside, minlength=len(every))
    leaves = [bool(((own < page[0]) | (own > page[1])).any()) for own in boxes]
    cost: dict[int, list[tuple[bool, float, int]]] = {}
    for number, (label, _) in enumerate(every):
        cost.setdefault(label, []).append((leaves[number], float(long[number]), number))
    chosen_ones: dict[int, Measure] = {}
    taken = np.zeros((0, 2, 2))
    for label, some in cost.items():
        bounds = [_bounds(every[k][1].text.boxes, margin) for _, _, k in some]
        over = [_overlap_count(own, taken) for own in bounds]
        best = min(range(len(some)), key=lambda k: (some[k][0], over[k], *some[k][1:]))
        chosen_ones[label] = every[some[best][2]][1]
        taken = np.concatenate([taken, bounds[best][None]])
    return chosen_ones


def _bounds(boxes: Floats, margin: float) -> Floats:
    """(2,2) the bounds of rectangles (b,4,2), wider by a margin."""
    if not len(boxes):
        return np.zeros((2, 2))
    return np.stack([boxes.min(axis=(0, 1)) - margin, boxes.max(axis=(0, 1)) + margin])


def _overlap_count(box: Floats, others: Floats) -> int:
    """How many of some rectangles (b,2,2) one (2,2) overlaps."""
    return int(((box[0] < others[:, 1]) & (box[1] > others[:, 0])).all(axis=1).sum())


def measures_on_page(
    letters: Letters,
    seen: SeenLabels,
    paths: Mapping[int, Floats],
    usual: Mapping[int, Lettering],
    heads: Mapping[str, tuple[float, ...]],
    strokes: Paths,
    page: Floats,
    mm: float,
) -> dict[int, Measure]:
    """The texts above lines with arrowheads, each where it interrupts least of the strokes, without hatches.

    paths: the courses of lines by the numbers of labels along them; usual: these labels above them; heads: see
    arrowheads; page (2,2): its corners.
    """
    tried = {}
    for k, path in paths.items():
        label = seen.anchors.labels[k]
        if isinstance(label.at, Along) and label.place == "above" and label.at.item in heads:

            def set_at(place: str, part: float, k: int = k, path: Floats = path) -> Lettering:
                return set_along(letters, seen, k, path, mm, place, part)

            gap = GAP * label.capitals_mm * mm
            tried[k] = measures_tried(path, heads[label.at.item], usual[k], set_at, gap, mm)
    if not tried:
        return {}
    return with_room(tried, chosen(strokes, strokes.kind != int(LineKind.HATCH)), page, HALO_MM * mm)


def mark_with_room(
    seen: SeenLabels, number: int, heads: Mapping[str, tuple[float, ...]], placement: Placement, mm: float
) -> list[Floats]:
    """The strokes of the mark of a label; arrowheads that have no room in their line point at it from outside."""
    label, point = seen.anchors.labels[number], seen.points[number]
    if label.mark not in ("arrow", "tick") or not isinstance(label.at, OnCurve):
        return marked(label, point, np.zeros(2), mm)
    way = direction_at(seen, number, placement)
    own = heads.get(label.at.item, ())
    if label.mark != "arrow" or not way.any():
        return marked(label, point, way, mm)
    if heads_outside(length_of(course_on_page(seen, number, placement)), own, mm):
        return [*marked(label, point, -way, mm), tail(point, -way, mm)]
    return marked(label, point, way, mm)


# The labels of a scene on the page.

NO_ITEM = -1
"""Strokes of labels belong to no item."""

BESIDE = 0.4
"""A box whose middle lies farther from a point across, as a part of its width, stands beside it."""


@dataclass(frozen=True, eq=False)
class SceneLabels:
    """Labels on the page: letters, leaders and marks as strokes, those of what is hidden apart as faint; letters of a
    font as texts; boxes (b,4,2) before which the lines of the drawing end, faint_boxes (c,4,2) before which only
    hidden ones do; off_page: the names of those whose letters leave the page."""

    strokes: Paths
    faint: Paths
    texts: Texts
    boxes: Floats
    faint_boxes: Floats
    off_page: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.boxes) + len(self.faint_boxes)

    @property
    def every_box(self) -> Floats:
        """(b+c,4,2) all boxes."""
        return np.concatenate([self.boxes, self.faint_boxes])

    def interrupted(self, strokes: Paths, page_from_world: Floats) -> Paths:
        """The strokes of a drawing without what lies behind the letters."""
        whole = outside_boxes(strokes, self.boxes, page_from_world)
        if not len(self.faint_boxes):
            return whole
        hidden = outside_boxes(chosen(whole, whole.hidden_by > 0), self.faint_boxes, page_from_world)
        return concatenated((chosen(whole, whole.hidden_by == 0), hidden))

    def blanks(self, colour: Colours) -> Fills:
        """Polygons in the colour (1,3) of the paper under the letters: fills end before these, as lines do."""
        corners, count = self.boxes.reshape(-1, 2), len(self.boxes)
        return Fills.flat(corners, 4 * np.arange(count + 1), np.repeat(colour, count, axis=0), kind=FillKind.BACKGROUND)

    def on_top(
        self,
        layers: tuple[Layer, ...],
        by_kind: bool,
        longest_mm: float | None,
        page_from_world: Floats,
        pen: Pen = PENS["label"],
    ) -> tuple[Layer, ...]:
        """The layers of a drawing, and one of the labels; by_kind: it has its number among the layers by kind. Faint
        letters are on the layer of hidden lines.

        longest_mm: longer strokes leave in parts; pen: of the letters.
        """
        strokes, faint = (
            some if longest_mm is None else split_long(some, longest_mm, page_from_world)
            for some in (self.strokes, self.faint)
        )
        marks = (strokes, self.texts) if len(self.texts) else (strokes,)
        names = [layer.name for layer in layers]
        if "label" not in names:
            layers = _with_label_layer(layers, Layer("label", pen, ()), by_kind)
        if len(faint) and "hidden" not in names:
            at = [layer.name for layer in layers].index("label")
            hidden = Layer("hidden", replace(PENS["hidden"], colour=pen.colour), ())
            layers = (*layers[:at], hidden, *layers[at:])
        more = {"label": marks, "hidden": (faint,) if len(faint) else ()}
        return tuple(replace(layer, marks=(*layer.marks, *more.get(layer.name, ()))) for layer in layers)


def _with_label_layer(layers: tuple[Layer, ...], label: Layer, by_kind: bool) -> tuple[Layer, ...]:
    """The layers and that of the labels: with its number among the kinds, or behind the others."""
    if not by_kind:
        return (*layers, label)
    before = (*PENS,)[: (*PENS,).index("label")]
    alike = takewhile(lambda pair: pair[0].name.startswith(pair[1]), zip(layers, before, strict=False))
    kinds = len(list(alike))
    empty = (Layer(name, PENS[name], (Paths.empty(),)) for name in before[kinds:])
    return (*layers[:kinds], *empty, label, *layers[kinds:])


def labels_on_page(
    seen: SeenLabels, placement: Placement, strokes: Paths, hidden: str, text: str = "strokes", mm: float = 1.0
) -> SceneLabels:
    """The letters of labels, apart from strokes and each other; beside the point of a curve whose image is shorter than
    a letter. hidden: what becomes of hidden lines; text: a word of LETTERS; mm: a millimetre in units of the page.
    Errors: InputError, with the label's name, for a character without strokes.
    """
    letters, seen = LETTERS[text], ticks_with_room(seen, placement, mm)
    ways = [label.hidden or hidden for label in seen.anchors.labels]
    some = [k for k, way in enumerate(ways) if not seen.hidden_by[k] or way != "none"]
    some = labels_with_room(seen, some, mm)
    labels = [seen.anchors.labels[k] for k in some]
    paths = {k: course_on_page(seen, k, placement) for k in some if isinstance(seen.anchors.labels[k].at, Along)}
    heads = arrowheads(seen)
    along = [k for k, path in paths.items() if _has_room(seen.anchors.labels[k], path, heads, mm)]
    set_: dict[int, Lettering] = {k: set_along(letters, seen, k, paths[k], mm) for k in along}
    beside = [k for k in some if k not in set_]
    gap = np.array([_gap(seen.anchors.labels[k], mm) for k in beside])
    rooms = (placement.page.width_mm - 2.0 * gap).tolist()
    texts = [set_label(letters, seen.anchors.labels[k], room, mm) for k, room in zip(beside, rooms, strict=True)]
    shown = strokes if hidden != "none" else chosen(strokes, strokes.hidden_by == 0)
    begin, end = shown.points[segments(shown)].transpose(1, 0, 2)
    page = np.array([[0.0, 0.0], [placement.page.width_mm, placement.page.height_mm]])
    measures = measures_on_page(letters, seen, {k: paths[k] for k in along}, set_, heads, shown, page, mm)
    set_ |= {k: measure.text for k, measure in measures.items()}
    sizes = np.array([np.ptp(text.bounds, axis=0) for text in texts]).reshape(-1, 2)
    height = np.array([seen.anchors.labels[k].capitals_mm * mm for k in beside])
    taken = np.array([set_[k].bounds for k in along]).reshape(-1, 2, 2)
    asked = [_asked(seen.anchors.labels[k]) for k in beside]
    points = np.array([_named(seen, k, mm) for k in beside]).reshape(-1, 2)
    found = places(points, sizes, height, gap, asked, begin, end, page, taken)
    for number, k in enumerate(beside):
        middle = found.middles[number] - 0.5 * texts[number].bounds.sum(axis=0)
        text_ = texts[number].moved(middle)
        # In whatever font, letters keep their distance from what they stand beside.
        set_[k] = replace(
            text_, texts=text_.texts.anchored(_side(found.middles[number], sizes[number], seen.points[k]))
        )
    told = [*zip((beside[of] for of in found.label), found.leaders, strict=True)]
    told += [(k, line) for k, measure in measures.items() for line in measure.tails]
    lines_of = _outside_letters(told, set_, HALO_MM * mm)
    faint = [bool(seen.hidden_by[k]) and ways[k] == "dashed" for k in some]
    parts = []
    for k in some:
        lines = [*_lines(set_[k]), *mark_with_room(seen, k, heads, placement, mm)]
        parts.append(label_paths([*lines, *lines_of.get(k, [])], int(seen.hidden_by[k]), placement))
    both = []
    for wanted in (False, True):
        own = [n for n, is_faint in enumerate(faint) if is_faint is wanted]
        boxes = np.concatenate([np.zeros((0, 4, 2)), *(set_[some[n]].boxes for n in own)])
        both.append((concatenated((Paths.empty(), *(parts[n] for n in own))), grown(boxes, HALO_MM * mm)))
    (shown, boxes), (hidden_, faint_boxes) = both
    by = [int(seen.hidden_by[k]) if is_faint else 0 for k, is_faint in zip(some, faint, strict=True)]
    written = Texts.joined([set_[k].texts.hidden(count) for k, count in zip(some, by, strict=True)])
    off_page = tuple(label.name for k, label in zip(some, labels, strict=True) if _leaves(page, set_[k].boxes))
    return SceneLabels(shown, hidden_, written, boxes, faint_boxes, off_page)


def _has_room(label: Label, path: Floats, heads: Mapping[str, tuple[float, ...]], mm: float) -> bool:
    """Whether letters stand along a course (n,2): one longer than they are high, or a dimension line."""
    assert isinstance(label.at, Along)
    long = length_of(path)
    return long > label.capitals_mm * mm or (long > 0.0 and label.place == "above" and label.at.item in heads)


def _outside_letters(
    lines: Sequence[tuple[int, Floats]], letters: Mapping[int, Lettering], margin: float
) -> dict[int, list[Floats]]:
    """Of the straight lines (2,2) of labels, by their numbers, what is outside of the letters of others."""
    if not lines:
        return {}
    own = np.array([k for k, _ in lines])
    owner = np.repeat([*letters], [len(text.boxes) for text in letters.values()])
    boxes = grown(np.concatenate([text.boxes for text in letters.values()]), margin)
    parts, line = outside_others(np.array([line for _, line in lines]), own, boxes, owner)
    found: dict[int, list[Floats]] = {}
    for k, part in zip(own[line].tolist(), parts, strict=True):
        found.setdefault(k, []).append(part)
    return found


def with_letters(labels: SceneLabels, letters: Sequence[Lettering], placement: Placement, mm: float) -> SceneLabels:
    """Labels, and more letters that stand on lines, those that would stand in a label left out."""
    free = [text for text in letters if not _overlap(text.boxes, labels.every_box)]
    if not free:
        return labels
    strokes = label_paths([line for text in free for line in _lines(text)], 0, placement)
    boxes = grown(np.concatenate([text.boxes for text in free]), HALO_MM * mm)
    return replace(
        labels,
        strokes=concatenated((labels.strokes, strokes)),
        texts=Texts.joined([labels.texts, *(text.texts for text in free)]),
        boxes=np.concatenate([labels.boxes, boxes]),
    )


def _overlap(boxes: Floats, others: Floats) -> bool:
    """Whether bounds of any of boxes (b,4,2) overlap those of others (c,4,2)."""
    low, high = boxes.min(axis=1)[:, None], boxes.max(axis=1)[:, None]
    return bool(((low < others.max(axis=1)) & (high > others.min(axis=1))).all(axis=2).any())


def _leaves(page: Floats, boxes: Floats) -> bool:
    """Whether corners of boxes (b,4,2) are off the page, given by its corners (2,2)."""
    return bool(((boxes < page[0]) | (boxes > page[1])).any())


def rooms_of_labels(
    anchors: LabelAnchors, points: Floats, filled: Floats, margin_mm: float, mm: float = 1.0
) -> tuple[Ints, Floats, Floats]:
    """The labels (k,) beside points, and the corners low (k,2) and high (k,2) of what they need inside the margin, for
    letters may stand in it, counted from their points on the page. points (l,2): the images of what they name; filled
    (2,2): the lowest and the highest corner of the picture, in the image. Where a label may stand anywhere beside its
    point it is taken to be on the side that leads away from the middle of the picture.
    """
    some, low, high = [], [], []
    middle, reach = filled.mean(axis=0), np.maximum(np.ptp(filled, axis=0), LEAST_DIVISOR)
    order = [word for word in DIRECTIONS if word not in ("auto", "centre")]
    ways = np.array([DIRECTIONS[word] for word in order])
    for k, label in enumerate(anchors.labels):
        if (
            isinstance(label.at, (Along, OnPage, BesidePoint))
            or not label.text.strip()
            or not np.isfinite(points[k]).all()
        ):
            continue
        size = np.ptp(typeset(label.text, size_mm=label.capitals_mm * mm).bounds, axis=0)
        gap = _gap(label, mm)
        way = np.array([DIRECTIONS[label.place]]) if label.place != "auto" else ways
        outwards = matmul(way / np.maximum(np.hypot(*way.T), 1.0)[:, None], (points[k] - middle) / reach)
        beside = _beside(way, size, gap)[int(np.argmax(outwards))]
        # Letters keep their distance from the edge of the page.
        inside = margin_mm * mm - gap
        some.append(k)
        low.append(np.minimum(beside - 0.5 * size + inside, 0.0))
        high.append(np.maximum(beside + 0.5 * size - inside, 0.0))
    none = np.zeros((0, 2))
    return (
        np.array(some, dtype=np.intp),
        np.array([*none, *low]).reshape(-1, 2),
        np.array([*none, *high]).reshape(-1, 2),
    )


def _asked(label: Label) -> str:
    if not label.text.strip():
        return "centre"
    return "above_right" if isinstance(label.at, OnPage) and label.place == "auto" else label.place


def _gap(label: Label, mm: float) -> float:
    """From a point to the letters beside it: a mark there, and a little more than lines keep away."""
    mark = {"none": 0.0, "tick": TICK * MARK_MM, "arrow": ARROW_SLOPE * ARROW_MM}.get(label.mark, 0.7 * MARK_MM)
    return max(GAP * label.capitals_mm, 1.5 * HALO_MM) * mm + mark * mm


def _side(middle: Floats, size: Floats, point: Floats) -> float:
    """What part of the lines of a text lies before the side of its box that is next to a point: 0 on the right of it, 1
    on its left, 0.5 above and below."""
    across = float(middle[0] - point[0])
    beside = abs(across) >= BESIDE * float(size[0])
    return 0.5 - 0.5 * float(np.sign(across)) if beside else 0.5


def _named(seen: SeenLabels, number: int, mm: float) -> Floats:
    """(2,) the point on the page that a label stands at or beside."""
    at = seen.anchors.labels[number].at
    beside = at.middle_mm if isinstance(at, BesidePoint) else (0.0, 0.0)
    return np.asarray(seen.points[number] + mm * np.array(beside))


def _lines(text: Lettering) -> list[Floats]:
    return [text.strokes[k] for k in range(len(text.strokes))]


def label_paths(lines: Sequence[Floats], hidden_by: int, placement: Placement) -> Paths:
    """Polylines on the page as strokes of labels."""
    points = np.concatenate([np.zeros((0, 2)), *lines])
    count = len(lines)
    return Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(count, dtype=np.bool_),
        np.full(count, int(LineKind.LABEL)),
        np.full(count, NO_ITEM),
        np.full(count, hidden_by),
        _in_the_image_plane(points, placement),
    )


def _in_the_image_plane(points: Floats, placement: Placement) -> Floats:
    """(p,3) the points of the world whose images points on the page are, in the plane of the image."""
    projection = placement.projection
    image = (points - placement.page_from_image[:2, 2]).T / placement.scale
    foot = projection.target[:2] if projection.eye is None else projection.eye[:2]
    depth = 0.0 if projection.eye is None else projection.eye[2] - projection.focus
    return projection.world_of(np.vstack([image + foot[:, None], np.full(len(points), depth)]))


# The heights of level lines, on the lines.

SIZE_MM = 1.8
"""The height of figures on level lines."""

ON_A_LINE_MM = 60.0
"""From the middle of one number to that of the next one of the same height, at least."""

APART_MM = 6.0
"""From the middle of one number to that of any other one, at least."""

CROWDED = 2.5
"""Times its width that the lines are long, at most, which a number interrupts, its own one among them."""

OUTLINE = 3.0
"""Times that lines count which are no sections: contours, borders."""

FINE = 2
"""More digits that heights have than the first one of the step from one to the next."""

MOST_DIGITS = 12
"""Of a height."""

ROOM_MM = 1.2
"""Of line that is as straight as under the number before it, and behind it, together."""


def level_numbers(scene: Scene, strokes: Paths, text: str, mm: float) -> list[Lettering]:
    """The heights of numbered sections, upright on their lines where these are straight enough for them.

    strokes: of the picture; text, mm: see labels_on_page. A line that is nowhere visible and straight over the length
    of the longest number has none.
    """

    which, level, heights = _levels(scene, strokes)
    if not len(which):
        return []
    lines = joined(replace(chosen(strokes, which), curve=level), level, COINCIDENT_MM * mm)
    places = np.column_stack([lines.points, np.zeros(len(lines.points))])
    faces = np.zeros(len(places), dtype=np.intp)
    words = _words(heights)
    letters, size = LETTERS[text].plain, SIZE_MM * mm
    longest = max(float(np.ptp(letters(word, size_mm=size).bounds, axis=0)[0]) for word in words)
    numbers = MeshCurves(places, lines.offsets, lines.closed, faces, lines.curve.astype(np.float64))
    found = label_places(numbers, longest + ROOM_MM * mm, APART_MM * mm)
    way, level = found.directions, found.heights.astype(np.intp)
    # Read from below, and from the right where the line goes straight up.
    angle = np.degrees(arctan2(way[:, 1], way[:, 0]))
    angle -= 180.0 * np.round(angle / 180.0)
    tried = [
        letters(words[number], at[:2], size_mm=size, align="centre", level="middle", rotation_deg=turn)
        for number, at, turn in zip(level.tolist(), found.points, angle.tolist(), strict=True)
    ]
    return [tried[k] for k in _chosen(tried, level, found.points[:, :2], strokes, mm)]


def _words(heights: Floats) -> list[str]:
    """Heights, with so many digits that one can tell each from the next one."""
    steps = np.diff(np.unique(heights)) if len(np.unique(heights)) > 1 else np.abs(heights)
    step = float(steps.min())
    digits = FINE - int(np.floor(math.log10(step))) if step > 0.0 else 0
    return [f"{round(height, digits) + 0.0:.{MOST_DIGITS}g}" for height in heights.tolist()]


def _chosen(tried: Sequence[Lettering], level: Ints, middles: Floats, strokes: Paths, mm: float) -> list[int]:
    """Which numbers to keep, those first that interrupt the shortest lines."""
    boxes = np.array([text.bounds for text in tried]).reshape(-1, 2, 2)
    shown = chosen(strokes, strokes.hidden_by == 0)
    lines = segments(shown)
    begin, end = shown.points[lines].transpose(1, 0, 2)
    outline = ~np.isin(shown.kind, (LineKind.SECTION, LineKind.INDEX))[
        ragged.owner(np.diff(shown.offsets))[lines[:, 0]]
    ]
    wide = np.array([np.hypot(*(text.boxes[0, 1] - text.boxes[0, 0])) for text in tried])
    long = np.zeros(len(tried))
    for some, weight in ((~outline, 1.0), (outline, OUTLINE)):
        long += weight * StrokeLengths.of(begin[some], end[some], SIZE_MM * mm).inside(boxes)
    crossed = long / wide
    kept: list[int] = []
    for k in np.argsort(crossed.round(1), kind="stable").tolist():
        away = np.hypot(*(middles[kept] - middles[k]).T)
        least = np.where(level[kept] == level[k], ON_A_LINE_MM, APART_MM) * mm
        if crossed[k] <= CROWDED and (away >= least).all():
            kept.append(k)
    return kept


def _levels(scene: Scene, strokes: Paths) -> tuple[Ints, Ints, Floats]:
    """Which strokes (k,) are visible lines of numbered sections, the number (k,) of the height of each, and the heights
    (h,)."""
    seen = np.flatnonzero((strokes.hidden_by == 0) & (np.diff(strokes.offsets) > 1))
    ends = np.stack([strokes.points3d[strokes.offsets[seen]], strokes.points3d[strokes.offsets[seen + 1] - 1]])
    which, level, heights = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)], list[float]()
    for number, item in enumerate(scene.items):
        planes = [(section, d) for section in item.curves.sections if section.numbered for d in section.offsets]
        if not planes:
            continue
        kinds = [int(section.kind) for section, _ in planes]
        own = (strokes.item[seen] == number) & np.isin(strokes.kind[seen], kinds)
        normals, offsets = np.array([section.normal for section, _ in planes]), np.array([d for _, d in planes])
        away = np.abs(matmul(ends[:, own], normals.T) - offsets).max(axis=0)
        which.append(seen[own])
        level.append(len(heights) + away.argmin(axis=1))
        upright = np.abs(normals[:, 2]) == 1.0
        heights += np.where(upright, offsets / scene.exaggeration, offsets).tolist()
    return np.concatenate(which), np.concatenate(level), np.array(heights)
