"""Arcs of conics and straight lines in space: as rational Bézier pieces, as chords, and cut by planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import intervals, ragged, records
from vectorplot.geometry.elementary import arccos, arctan, arctan2, tan
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances import LEAST_DIVISOR, UNION_OF_SEGMENT, WHOLE_TURN
from vectorplot.visibility.polyhedra.grid import Floats32
from vectorplot.visibility.polyhedra.hidden_lines import SLIVER
from vectorplot.visibility.quadrics.bodies import EyeCoordinates, eye_coordinates
from vectorplot.visibility.smooth.curve_families import Along, Chords
from vectorplot.visibility.smooth.traced_curves import Curves
from vectorplot.words import LineKind

# Arcs of conics in space, and straight lines: what the engine of convex quadrics hides.


@dataclass(frozen=True, eq=False)
class Arcs(Elements):
    """The points middle + cos(t) first + sin(t) second, low <= t <= high, divided by 1 + cos(t) weight; for straight
    lines middle + t first. middle, first, second (n,3) in the coordinates of sight; straight, kind, item (n,); own
    (n,2): the bodies of an arc, or -1; side (n,): 1 or -1 for an outline with its body left or right, else 0; weight
    (n,): 0 of ellipses and lines, larger of other conics, which reach no further than a quarter turn from t = 0.
    """

    middle: Floats
    first: Floats
    second: Floats
    low: Floats
    high: Floats
    straight: Bools
    kind: Ints
    item: Ints
    own: Ints
    side: Ints
    weight: Floats

    def __len__(self) -> int:
        return len(self.low)

    def at(self, which: Ints, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Points (k,3) of arcs which (k,) at t (k,), and their first and second derivatives by t."""
        middle, first, second = self.middle[which], self.first[which], self.second[which]
        straight = self.straight[which][:, None]
        cosine, sine = np.cos(t)[:, None], np.sin(t)[:, None]
        along = cosine * first + sine * second
        points = middle + np.where(straight, t[:, None] * first, along)
        slopes = np.where(straight, first, cosine * second - sine * first)
        bends = np.where(straight, 0.0, -along)
        weight = self.weight[which][:, None]
        if not weight.any():
            return points, slopes, bends
        divisor = 1.0 + weight * cosine
        points = points / divisor
        slopes = (slopes + weight * sine * points) / divisor
        return points, slopes, (bends + weight * (2.0 * sine * slopes + cosine * points)) / divisor

    def in_view(self, sight: EyeCoordinates) -> Arcs:
        """The arcs in the coordinates of the view."""
        origin = sight.points_of_view(np.zeros(3))
        first = sight.vectors(self.first) + self.weight[:, None] * origin
        second = sight.vectors(self.second)
        return replace(self, middle=sight.points_of_view(self.middle), first=first, second=second)


@dataclass(frozen=True, eq=False)
class OwnSides:
    """What bodies hide of curves on themselves: where the linear form (k,4) is negative, arc (k,) is turned away on the
    body (k,), and on those that are equal to it."""

    arc: Ints
    form: Floats
    body: Ints


def arcs_on(
    circles: tuple[Floats, Floats, Floats],
    span: tuple[Floats, Floats],
    kind: LineKind,
    item: Ints,
    own: Ints,
    side: Ints | None = None,
    weight: Floats | None = None,
) -> Arcs:
    """Arcs of one kind: their middles and conjugate radii, and from where to where (n,) they go; of ellipses where
    there is no weight."""
    count = len(item)
    straight = np.zeros(count, dtype=np.bool_)
    sides = np.zeros(count, dtype=np.intp) if side is None else side
    weights = np.zeros(count) if weight is None else weight
    return Arcs(*circles, *span, straight, np.full(count, int(kind)), item, own, sides, weights)


def lines_on(start: Floats, way: Floats, kind: LineKind, item: Ints, own: Ints, side: Ints | None = None) -> Arcs:
    """Straight lines of one kind from start (n,3) all their way (n,3)."""
    count = len(item)
    arcs = arcs_on((start, way, np.zeros_like(way)), (np.zeros(count), np.ones(count)), kind, item, own, side)
    return replace(arcs, straight=np.ones(count, dtype=np.bool_))


def joined_arcs(parts: Sequence[tuple[Arcs, OwnSides]]) -> tuple[Arcs, OwnSides]:
    """All arcs of all parts, and what their own bodies hide of them."""
    none, number = np.zeros((0, 3)), np.zeros(0)
    whole = np.zeros(0, dtype=np.intp)
    flags = np.zeros(0, dtype=np.bool_)
    pairs = np.zeros((0, 2), dtype=np.intp)
    empty = Arcs(none, none, none, number, number, flags, whole, whole, pairs, whole, number)
    arcs = [empty, *(arcs for arcs, _ in parts)]
    shift = ragged.starts([len(some) for some in arcs])[1:]
    sides = [OwnSides(whole, np.zeros((0, 4)), whole)]
    sides += [replace(own, arc=own.arc + first) for (_, own), first in zip(parts, shift.tolist(), strict=True)]
    return records.joined(arcs), records.joined(sides)


def beyond_near(sight: EyeCoordinates, arcs: Arcs, sides: OwnSides) -> tuple[Arcs, OwnSides]:
    """The parts of arcs that are no nearer to the eye than the near plane."""
    if not sight.central:
        return arcs, sides
    # Depth, times what is divided by, less so much of near as that is above 1: base + reach cos(t - turn), which is no
    # less than near within half of turn.
    base, ahead = arcs.middle[:, 2], arcs.first[:, 2] - sight.near * arcs.weight
    reach = np.hypot(ahead, arcs.second[:, 2])
    reach = np.where(arcs.straight, np.abs(arcs.first[:, 2]) * np.maximum(np.abs(arcs.low), np.abs(arcs.high)), reach)
    doubtful = base - reach < sight.near
    if not doubtful.any():
        return arcs, sides
    turn = arctan2(arcs.second[:, 2], ahead)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = arccos(np.clip((sight.near - base) / reach, -1.0, 1.0))
    half = np.where(base + reach < sight.near, -1.0, np.where(reach > 0.0, half, np.pi))
    which, low, high = [np.flatnonzero(~doubtful)], [arcs.low[~doubtful]], [arcs.high[~doubtful]]
    some = np.flatnonzero(doubtful & arcs.straight)
    begin, end = _beyond(sight.near - base[some], arcs.first[some, 2], arcs.low[some], arcs.high[some])
    which.append(some[begin < end])
    low.append(begin[begin < end])
    high.append(end[begin < end])
    some = np.flatnonzero(doubtful & ~arcs.straight)
    for turns in (-1.0, 0.0, 1.0):
        middle = turn[some] + 2.0 * np.pi * turns
        begin, end = np.maximum(middle - half[some], arcs.low[some]), np.minimum(middle + half[some], arcs.high[some])
        there = begin < end
        which.append(some[there])
        low.append(begin[there])
        high.append(end[there])
    chosen = np.concatenate(which)
    cut = replace(arcs.take(chosen), low=np.concatenate(low), high=np.concatenate(high))
    order = np.argsort(sides.arc, kind="stable")
    first = np.searchsorted(sides.arc[order], np.arange(len(arcs) + 1))
    count = np.diff(first)[chosen]
    index = order[ragged.ranges(first[chosen], count)]
    return cut, OwnSides(ragged.owner(count), sides.form[index], sides.body[index])


def _beyond(least: Floats, slope: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """From where to where (n,), between low and high, t times the slope is at least so much."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = least / slope
    begin = np.where(slope > 0.0, np.maximum(low, at), low)
    end = np.where(slope < 0.0, np.minimum(high, at), high)
    return begin, np.where((slope == 0.0) & (least > 0.0), low, end)


# Arcs cut into pieces of less than a half turn, as rational Bézier curves of degree two.

IN_A_TURN = 8
"""Pieces of a whole turn: fewer have larger boxes, which more things overlap; more cost more."""

LARGE, MOST = 2.0, 512
"""An arc so many times larger in the picture than what hides is cut finer, into so many pieces at most."""


@dataclass(frozen=True, eq=False)
class Pieces(Elements):
    """Parts of arcs: control (3,4,n) homogeneous control points; arc (n,); middle, half (n,):
    from middle - half to middle + half in the arc's parameter; box (4,n) left, right, bottom, top in the image; nearest
    and farthest (n,) depth."""

    control: Floats = field(metadata=IN_COLUMNS)
    arc: Ints
    middle: Floats
    half: Floats
    box: Floats32 = field(metadata=IN_COLUMNS)
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.arc)

    def parameters(self, arcs: Arcs, which: Ints, t: Floats) -> Floats:
        """(k,) the arcs' parameters at t, 0 to 1 along pieces which (k,)."""
        middle, half = self.middle[which], self.half[which]
        s = 2.0 * t - 1.0
        # The tangent of the half angle goes evenly along the weighted curve.
        straight = arcs.straight[self.arc[which]]
        turned = 2.0 * arctan(tan(np.where(straight, 0.0, 0.5 * half)) * s)
        turned = np.where(straight, half * s, turned)
        return np.where(t <= 0.0, middle - half, np.where(t >= 1.0, middle + half, middle + turned))


def cut_arcs(sight: EyeCoordinates, arcs: Arcs, typical: float) -> Pieces:
    """The arcs in pieces; typical: the size of what hides, in the image."""
    reach = np.sqrt(arcs.first * arcs.first + arcs.second * arcs.second)
    size = reach.max(axis=1, initial=0.0)
    if sight.central:
        size = size / np.maximum(np.abs(arcs.middle[:, 2]) - reach[:, 2], 0.1 * np.abs(arcs.middle[:, 2]) + sight.near)
    span = arcs.high - arcs.low
    wide = size * np.where(arcs.straight, span, 1.0) / (LARGE * typical)
    turns = np.where(arcs.straight, 1.0, span / (2.0 * np.pi))
    in_all = np.where(arcs.straight, np.ceil(wide), np.ceil(turns * np.maximum(IN_A_TURN, 8.0 * wide)))
    # No piece may turn by more than a third of a half turn: its weights stay above a half.
    fewest = np.where(arcs.straight, 1.0, np.ceil(span / (np.pi / 3.0)))
    count = np.maximum(np.clip(in_all, 1.0, MOST), fewest).astype(np.intp)
    arc, step = ragged.owner(count), ragged.place(count)
    half = 0.5 * span[arc] / count[arc]
    middle = arcs.low[arc] + (2 * step + 1) * half
    control = _control(arcs, arc, middle, half)
    depth = control[:, 2] / control[:, 3]
    nearest, farthest = depth.min(axis=0), depth.max(axis=0)
    image = control[:, :2] / control[:, 3:4]
    if sight.central:
        image = image / np.maximum(depth, sight.near)[:, None]
        image[:, :, nearest < sight.near] = np.nan
    low, high = image.min(axis=0), image.max(axis=0)
    return Pieces(control, arc, middle, half, packed_box(low, high), nearest, farthest)


def _control(arcs: Arcs, arc: Ints, middle: Floats, half: Floats) -> Floats:
    """(3,4,n) control points: both ends, and where the tangents meet, with its weight."""
    straight = arcs.straight[arc]
    weight = np.where(straight, 1.0, np.cos(half))
    centre, first, second = arcs.middle[arc].T, arcs.first[arc].T, arcs.second[arc].T
    divisor = arcs.weight[arc]
    control = np.empty((3, 4, len(arc)))
    one = np.ones(len(arc))
    for k, (t, w) in enumerate(((middle - half, one), (middle, weight), (middle + half, one))):
        along = np.where(straight, t, np.cos(t)), np.where(straight, 0.0, np.sin(t))
        control[k, :3] = centre * w + first * along[0] + second * along[1]
        control[k, 3] = w + divisor * along[0]
    return control


def packed_box(low: Floats, high: Floats) -> Floats32:
    """(4,n) boxes from lower left to upper right corners (2,n), rounded outwards; everything where these are not
    numbers."""
    below, above = np.float32(-np.inf), np.float32(np.inf)
    left, bottom = np.nextafter(np.where(np.isnan(low), -np.inf, low).astype(np.float32), below)
    right, top = np.nextafter(np.where(np.isnan(high), np.inf, high).astype(np.float32), above)
    return np.stack([left, right, bottom, top])


# Arcs of conics as the curves of the second engine: chords within a tolerance, and all of the arc between them.

LOOKS = 9
"""Places along an arc at which one looks how sharply its image bends."""

FEWEST, CHORDS = 8, 4096
"""Chords of an arc, at least and at most: nine points tell an arc from another curve."""

SAFE = 1.2
"""The image may bend so much more between the places looked at."""


@dataclass(frozen=True, eq=False)
class ConicArcs:
    """Arcs in the view's coordinates. The place of a point is (t, 0, 0), the level of a curve its number among arcs."""

    arcs: Arcs
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        start, end = chords.places
        way = (end - start)[:, 0]
        t = start[:, 0] + part * way
        points, slopes, _ = self.arcs.at(chords.level.astype(np.intp), t)
        places = np.zeros_like(points)
        places[:, 0] = t
        return Along(places, points, slopes * way[:, None])


def conic_curves(view: View, arcs: Arcs, behind: Ints, tolerance: float) -> Curves:
    """Arcs, hidden by behind (n,) items already, with chords off them by no more than the tolerance in the image."""
    sight = eye_coordinates(view)
    count = np.clip(np.ceil(_bends(sight, view.focus, arcs) / np.sqrt(8.0 * tolerance)), FEWEST, CHORDS).astype(np.intp)
    count[arcs.straight] = 1
    arc, step = ragged.owner(count + 1), ragged.place(count + 1)
    t = arcs.low[arc] + (arcs.high - arcs.low)[arc] * step / count[arc]
    last = step == count[arc]
    t[last] = arcs.high[arc[last]]
    whole = np.abs(arcs.high - arcs.low - 2.0 * np.pi) <= WHOLE_TURN
    in_view = arcs.in_view(sight)
    points = in_view.at(arc, np.where(last & whole[arc], arcs.low[arc], t))[0]
    places = np.zeros_like(points)
    places[:, 0] = t
    return Curves(
        points,
        places,
        np.full_like(points, np.nan),
        ragged.offsets(count + 1),
        whole,
        arcs.kind,
        arcs.item,
        np.zeros(len(arcs), dtype=np.intp),
        np.arange(len(arcs), dtype=np.float64),
        (ConicArcs(in_view),),
        arcs.side,
        behind,
    )


def _bends(sight: EyeCoordinates, focus: float, arcs: Arcs) -> Floats:
    """(n,) the length of each arc's way times the root of the largest second derivative of its image: with that many
    chords, times the root of an eighth, they are a unit off."""
    span = arcs.high - arcs.low
    largest = np.zeros(len(arcs))
    every = np.arange(len(arcs))
    for part in np.linspace(0.0, 1.0, LOOKS).tolist():
        point, slope, second = arcs.at(every, arcs.low + part * span)
        if sight.central:
            depth = np.maximum(point[:, 2:], max(sight.near, LEAST_DIVISOR))
            image = point[:, :2] / depth
            image_slope = (slope[:, :2] - image * slope[:, 2:]) / depth
            bend = (second[:, :2] - 2.0 * image_slope * slope[:, 2:] - image * second[:, 2:]) / depth * focus
        else:
            bend = second[:, :2]
        largest = np.maximum(largest, np.hypot(bend[:, 0], bend[:, 1]))
    return np.asarray(span * np.sqrt(SAFE * largest))


# The parts of circles that lie to one side of planes.


def parts_inside(
    circles: tuple[Floats, Floats, Floats], circle: Ints, forms: Floats, tolerance: float
) -> tuple[Ints, Floats, Floats]:
    """The parts of circles that are nowhere outside of planes: which circle (k,), and from where to where (k,) in its
    angle.

    circles: middles and conjugate radii (n,3); forms (p,4) of unit gradient, negative outside, each for a circle (p,).
    Parts below ten tolerances are left out. Edge cases: what is not finite cuts nothing.
    """
    middle, first, second = circles
    # Outside of the plane where base + reach cos(t - turn) < 0.
    base = dot(middle[circle], forms[:, :3]) + forms[:, 3]
    x, y = dot(first[circle], forms[:, :3]), dot(second[circle], forms[:, :3])
    reach, turn = np.hypot(x, y), arctan2(y, x)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = arccos(np.clip(base / reach, -1.0, 1.0))
    out = np.isfinite(base) & (base < reach)
    circle, turn, half = circle[out], turn[out], np.where(base[out] <= -reach[out], np.pi, half[out])
    low = np.mod(turn + np.pi - half, 2.0 * np.pi) / (2.0 * np.pi)
    high = low + half / np.pi
    round_ = high > 1.0
    owner = np.concatenate([circle, circle[round_]])
    low, high = np.concatenate([low, np.zeros(round_.sum())]), np.concatenate([np.minimum(high, 1.0), high[round_] - 1])
    gap = np.full(len(middle), UNION_OF_SEGMENT)
    of, low, high = intervals.complement(len(middle), *intervals.union(owner, low, high, gap), gap)
    radius = np.sqrt(np.maximum(dot(first, first), dot(second, second)))[of]
    long = (high - low) * 2.0 * np.pi * radius > SLIVER * tolerance
    return of[long], low[long] * 2.0 * np.pi, high[long] * 2.0 * np.pi
