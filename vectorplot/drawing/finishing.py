"""Strokes made ready for the pen: long strokes in a good order, chain lines, dashes, trimmed ends, and no specks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from operator import itemgetter

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.dashes import CHAIN_MM, dashed, parts_between, stroke_lengths
from vectorplot.drawing.drawing import NO_CURVE, STROKES, Layer, Paths, Pen
from vectorplot.drawing.pen_order import pen_ordered
from vectorplot.drawing.simplify import without_collinear_points
from vectorplot.drawing.stroke_curves import curved_strokes
from vectorplot.drawing.strokes import (
    chosen,
    clusters,
    concatenated,
    connected,
    going_on,
    in_rows,
    joined,
    split_long,
    unrolled,
    without_dots,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import split, with_points
from vectorplot.scene.hatching import DOT_MM
from vectorplot.tolerances import COINCIDENT_MM, COLLINEAR_MM, LONE_STROKE_MM, ROUNDING
from vectorplot.words import LineKind

# Ends of strokes where many of them run into one point, as in the apex of a cone: there ink would make a blot.

FEWEST = 8
"""So many lines that end in one point converge; fewer make a corner, as on a mesh."""


def trimmed_ends(paths: Paths, width_mm: float, page_from_world: Floats) -> Paths:
    """The strokes, those that converge ending early: where many lines of that width meet in a point, every second one
    stops where the gaps to its neighbours would be narrower than the lines, every fourth one at half of that distance,
    and so on; one reaches the point. Strokes that go on through the point are divided there.

    Edge cases: strokes that would lose more than a third of their length at one end lose only that.
    """
    paths = _divided(paths)
    open_ = np.flatnonzero(~paths.closed & (np.diff(paths.offsets) > 1))
    if len(open_) < FEWEST:
        return paths
    first, last = paths.offsets[:-1][open_], paths.offsets[1:][open_] - 1
    ends = paths.points[np.concatenate([first, last])]
    inner = paths.points[np.concatenate([first + 1, last - 1])]
    cut = _cuts(ends, inner, width_mm)
    length = stroke_lengths(paths)
    cut = np.minimum(cut.reshape(2, -1), length[open_] / 3.0)
    short = (cut > 0.0).any(axis=0)
    if not short.any():
        return paths
    which = open_[short]
    begin, end = cut[0, short], length[which] - cut[1, short]
    parts = parts_between(chosen(paths, which), np.arange(len(which)), begin, end, page_from_world)
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[which] = False
    order = np.argsort(np.concatenate([np.flatnonzero(kept), which]), kind="stable")
    return chosen(concatenated((chosen(paths, kept), parts)), order)


def _divided(paths: Paths) -> Paths:
    """The strokes, divided in the points where lines converge."""
    if not len(paths):
        return paths
    size = np.diff(paths.offsets)
    place = np.unique(np.rint(paths.points / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    inside = np.ones(len(paths.points), dtype=np.bool_)
    open_ = ~paths.closed & (size > 0)
    inside[paths.offsets[:-1][open_]] = False
    inside[paths.offsets[1:][open_] - 1] = False
    meeting = np.bincount(place, weights=np.where(inside, 2.0, 1.0))[place] >= FEWEST
    owner = ragged.owner(size)
    loops = np.unique(owner[meeting & paths.closed[owner]])
    if len(loops):
        first = np.array([np.flatnonzero(meeting[paths.offsets[k] : paths.offsets[k + 1]])[0] for k in loops.tolist()])
        kept = np.ones(len(paths), dtype=np.bool_)
        kept[loops] = False
        opened = unrolled(chosen(paths, loops), first, np.ones(len(loops), dtype=np.intp))
        return _divided(concatenated((chosen(paths, kept), opened)))
    cut = meeting & inside
    if not cut.any():
        return paths
    copies = np.where(cut, 2, 1)
    point = np.repeat(np.arange(len(paths.points)), copies)
    again = ragged.place(copies) == 1
    begins = np.zeros(len(point) + 1, dtype=np.bool_)
    begins[np.flatnonzero(again)] = True
    begins[(paths.offsets + np.concatenate([[0], np.cumsum(cut)])[paths.offsets])] = True
    offsets = np.flatnonzero(begins)
    return with_points(paths, point, owner[point[offsets[:-1]]], offsets)


def _cuts(ends: Floats, inner: Floats, width_mm: float) -> Floats:
    """(n,) how much is cut from each of the ends (n,2) of strokes that go on towards inner points (n,2)."""
    place = np.unique(np.rint(ends / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    count = np.bincount(place)
    many = np.flatnonzero(count[place] >= FEWEST)
    cut = np.zeros(len(ends))
    if not len(many):
        return cut
    way = inner[many] - ends[many]
    angle = arctan2(way[:, 1], way[:, 0])
    order = np.lexsort((angle, place[many]))
    sizes = np.diff(np.flatnonzero(np.concatenate([[True], np.diff(place[many][order]) > 0, [True]])))
    turn: Ints = ragged.place(sizes)
    # The first one reaches the point; of the others the power of two in their place says how far they come.
    power = turn & -turn
    meeting = 2.0 * width_mm / _spacing(angle[order], ragged.offsets(sizes))
    cut[many[order]] = np.where(turn > 0, meeting / np.maximum(power, 1), 0.0)
    return cut


def _spacing(angle: Floats, offsets: Ints) -> Floats:
    """(n,) the angle from each line to its neighbours, on average, of the lines through several points, one after the
    other; those next to the widest gap of all about a point count the other neighbour only, where that is nearer."""
    before = ragged.preceding(offsets)
    gap = np.mod(angle - angle[before], 2.0 * np.pi)
    widest = np.maximum.reduceat(gap, offsets[:-1])
    outside = gap >= np.repeat(widest, np.diff(offsets))
    back = np.where(outside, np.nan, gap)
    ahead = np.empty_like(back)
    ahead[before] = back
    one = np.where(np.isnan(back), ahead, np.where(np.isnan(ahead), back, 0.5 * (back + ahead)))
    return np.maximum(np.where(np.isnan(one), gap, one), ROUNDING)


# From pieces to what a pen draws: long strokes in a good order.

DASH_MM = (2.0, 1.0)
"""Dash and gap of hidden lines."""

CHAINED = (LineKind.CENTRE, LineKind.TRACE)
"""Kinds of lines that are drawn as long dashes and dots."""

MANY_PARTS = 32
"""The strokes of so many layers are joined and put in order layer by layer; those of more layers, which are small, all
at once, in a little more travel: a call costs as much as hundreds of strokes."""


FEW_POINTS = 2048
"""The strokes of few layers are joined at once too where they have no more points than so many in all."""


Grouping = Callable[[Paths], Ints]
"""Which strokes may be joined: those that get equal numbers (m,)."""


def by_line(paths: Paths) -> Ints:
    """(m,) equal for strokes of the same item, kind and count."""
    return (paths.item * len(LineKind) + paths.kind) * (int(paths.hidden_by.max(initial=0)) + 1) + paths.hidden_by


def by_dashes(paths: Paths) -> Ints:
    """(m,) equal for strokes that a pen draws alike, whatever they are lines of: through, or in the same dashes."""
    behind = (paths.hidden_by > 0) | (paths.kind == int(LineKind.GHOST))
    return np.where(np.isin(paths.kind, CHAINED), 2 + paths.kind, behind.astype(np.intp))


def inked(
    layers: tuple[Layer, ...],
    hidden: str,
    world: Floats,
    curve_tolerance_mm: float | None = None,
    longest_mm: float | None = None,
    thinned: bool = False,
    group: Grouping = by_line,
) -> tuple[Layer, ...]:
    """Each layer's strokes joined, without collinear points, dashed as its pen says, hidden ones also if asked for, in
    the order of the pen, in parts where they are longer than longest_mm; smooth ones as curves within
    curve_tolerance_mm, or as polylines where it is None. thinned: ends that converge stop early; group: which strokes
    are joined. Filled polygons and texts stay."""
    parts = [paths for layer in layers for paths in layer.strokes]
    pens = [layer.pen for layer in layers for _ in layer.strokes]
    strokes = _pen_strokes(parts, pens, hidden, world, thinned, group)
    return _fitted(layers, strokes, world, curve_tolerance_mm, longest_mm)


def put_in_order(
    layers: tuple[Layer, ...], world: Floats, curve_tolerance_mm: float | None, longest_mm: float | None
) -> tuple[Layer, ...]:
    """Layers of strokes that are joined and dashed already in the order of the pen, then as in inked."""
    strokes = list(mapped(pen_ordered, [paths for layer in layers for paths in layer.strokes]))
    return _fitted(layers, strokes, world, curve_tolerance_mm, longest_mm)


def _fitted(
    layers: tuple[Layer, ...],
    strokes: list[Paths],
    world: Floats,
    curve_tolerance_mm: float | None,
    longest_mm: float | None,
) -> tuple[Layer, ...]:
    """The layers with these strokes, long ones in parts, smooth ones as curves."""
    if longest_mm is not None:
        strokes = [split_long(paths, longest_mm, world) for paths in strokes]
    drawn = iter(strokes if curve_tolerance_mm is None else (curved_strokes(s, curve_tolerance_mm) for s in strokes))
    return tuple(
        replace(layer, marks=tuple(next(drawn) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


def long_strokes(paths: Paths, group: Grouping = by_line) -> Paths:
    """Strokes of one group that follow one another joined, without collinear points: those of one curve first, then
    those of different curves, or of none, that meet end to end."""
    if not len(paths):
        return paths
    known = paths.curve != NO_CURVE
    if known.any():
        curves = without_dots(chosen(paths, known), COINCIDENT_MM)
        curves = in_rows(curves, going_on(curves, group(curves), COINCIDENT_MM))
        own = np.unique(np.stack([group(curves), curves.curve]), axis=1, return_inverse=True)[1]
        paths = concatenated((joined(curves, own.ravel(), COINCIDENT_MM), chosen(paths, ~known)))
    return without_collinear_points(joined(paths, group(paths), COINCIDENT_MM), COLLINEAR_MM)


def chain_lines_dashed(paths: Paths, world: Floats, mm: float = 1.0) -> Paths:
    """The strokes, of which centre lines and traces are broken into long dashes and dots; mm: how long a millimetre is
    in units of the page."""
    chained = np.isin(paths.kind, CHAINED)
    if not chained.any():
        return paths
    dash, gap, dot = (mm * length for length in CHAIN_MM)
    broken = dashed(long_strokes(chosen(paths, chained)), dash, gap, world, dot_mm=dot)
    return concatenated((chosen(paths, ~chained), broken))


def with_dashes(layers: Sequence[Layer], world: Floats) -> list[Layer]:
    """Layers of strokes, broken into dashes where their pens have some, in units of the page."""
    return [
        replace(layer, marks=tuple(dashed(paths, *layer.pen.dash_mm, world) for paths in layer.strokes))
        if layer.pen.dash_mm is not None and any(layer.pen.dash_mm)
        else layer
        for layer in layers
    ]


def _pen_strokes(
    parts: Sequence[Paths], pens: Sequence[Pen], hidden: str, world: Floats, thinned: bool, group: Grouping
) -> list[Paths]:
    """The strokes of each part, joined and in the order of the pen."""
    alike = len({pen.dash_mm for pen in pens}) == 1 and not thinned and group is by_line
    many = len(parts) > MANY_PARTS
    if not alike or (not many and sum(len(paths.points) for paths in parts) > FEW_POINTS):
        # The longest part begins first, so that the others are done beside it.
        first = sorted(range(len(parts)), key=lambda k: -len(parts[k]))
        done = mapped(lambda k: pen_ordered(_drawn(parts[k], pens[k], hidden, world, thinned, group)), first)
        return [paths for _, paths in sorted(zip(first, done, strict=True), key=itemgetter(0))]
    every = concatenated(tuple(parts))
    part = ragged.owner([len(paths) for paths in parts])
    low, high = int(every.item.min(initial=0)), int(every.item.max(initial=0)) + 1
    # Until they are in order, what is said of their items tells the parts of strokes too: no two parts are joined.
    long = _drawn(replace(every, item=part * (high - low) + every.item - low), pens[0], hidden, world, thinned, group)
    part, item = np.divmod(long.item, high - low)
    order = np.argsort(part, kind="stable")
    long, part = chosen(replace(long, item=item + low), order), part[order]
    own = split(pen_ordered(long, part) if many else long, np.searchsorted(part, np.arange(len(parts) + 1)))
    return own if many else [pen_ordered(paths) for paths in own]


def _drawn(paths: Paths, pen: Pen, hidden: str, world: Floats, thinned: bool, group: Grouping) -> Paths:
    """The long strokes of a pen, with its dashes."""
    long = long_strokes(paths, group)
    if thinned:
        long = trimmed_ends(long, pen.width_mm, world)
    if pen.dash_mm is not None:
        return dashed(long, *pen.dash_mm, world) if any(pen.dash_mm) else long
    chained = np.isin(long.kind, CHAINED)
    behind = (((long.hidden_by > 0) & (hidden == "dashed")) | (long.kind == int(LineKind.GHOST))) & ~chained
    parts = [chosen(long, ~(behind | chained))]
    if behind.any():
        parts.append(dashed(chosen(long, behind), *DASH_MM, world))
    if chained.any():
        parts.append(chain_lines_dashed(chosen(long, chained), world))
    return concatenated(tuple(parts)) if len(parts) > 1 else long


# Strokes too short for a pen: specks that nothing goes on from, and all below a length that is asked for.


def without_specks(layers: Sequence[Layer]) -> tuple[Layer, ...]:
    """The layers without specks: open strokes that are shorter than LONE_STROKE_MM together with all that they hang
    together with, end to end, on whichever layers.

    Edge cases: dots of stipplings are none, nor are closed strokes, which show something whole, nor what only touches
    another stroke amid its way.
    """
    parts = [paths for layer in layers for paths in layer.strokes]
    every = concatenated(tuple(parts))
    length = stroke_lengths(every)
    short = (length < LONE_STROKE_MM) & ~every.closed & (np.diff(every.offsets) > 0) & ~_dots(every, length)
    if not short.any():
        return tuple(layers)
    ends, kept = _ends(every), np.ones(len(every), dtype=np.bool_)
    kept[short] = ~_alone(ends[short], ends[~short & ~every.closed], length[short])
    return _chosen(layers, parts, np.split(kept, np.cumsum([len(paths) for paths in parts])[:-1]))


def without_short(
    layers: Sequence[Layer], shortest_mm: float, group: Grouping = by_line
) -> tuple[tuple[Layer, ...], int]:
    """The layers with strokes joined, those shorter than shortest_mm left out, and how many these are.

    group: see inked. Edge case: dots of stipplings stay.
    """
    parts = list(mapped(lambda paths: long_strokes(paths, group), [p for layer in layers for p in layer.strokes]))
    lengths = [stroke_lengths(paths) for paths in parts]
    kept = [(length >= shortest_mm) | _dots(paths, length) for paths, length in zip(parts, lengths, strict=True)]
    return _chosen(layers, parts, kept), sum(int((~some).sum()) for some in kept)


def stroke_count(layers: Sequence[Layer]) -> int:
    """How many strokes there are."""
    return sum(len(paths) for layer in layers for paths in layer.strokes)


def _chosen(layers: Sequence[Layer], parts: Sequence[Paths], kept: Sequence[Bools]) -> tuple[Layer, ...]:
    """The layers with those of these strokes, one mark after the other, that are kept."""
    left = iter([chosen(paths, some) for paths, some in zip(parts, kept, strict=True)])
    return tuple(
        replace(layer, marks=tuple(next(left) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


def _dots(paths: Paths, length: Floats) -> Bools:
    """(m,) which strokes are dots of stipplings."""
    return np.asarray((paths.kind == int(LineKind.HATCH)) & (np.abs(length - DOT_MM) < COINCIDENT_MM))


def _ends(paths: Paths) -> Floats:
    """(m,2,2) the first and the last point of every stroke; zero of those without points."""
    ends = np.zeros((len(paths), 2, 2))
    filled = np.diff(paths.offsets) > 0
    ends[filled, 0] = paths.points[paths.offsets[:-1][filled]]
    ends[filled, 1] = paths.points[paths.offsets[1:][filled] - 1]
    return ends


def _alone(ends: Floats, others: Floats, length: Floats) -> Bools:
    """(s,) which short strokes, by their ends (s,2,2), are specks: they meet no end of others (r,2,2), not even through
    each other, and what hangs together is no longer than one."""
    # Of the others few are near in x.
    x = np.sort(ends[..., 0].ravel())
    far = others[..., 0].ravel()
    near = np.searchsorted(x, far - COINCIDENT_MM) < np.searchsorted(x, far + COINCIDENT_MM, side="right")
    spots = np.concatenate([ends.reshape(-1, 2), others.reshape(-1, 2)[near]])
    x, y = (axis - axis.min() for axis in spots.T)
    place = clusters(x, y, np.zeros(len(spots), dtype=np.intp), COINCIDENT_MM)
    of_ends = place[: 2 * len(ends)].reshape(-1, 2)
    longer = of_ends[:, 0] != of_ends[:, 1]
    whole = connected(len(spots), of_ends[longer].max(axis=1), of_ends[longer].min(axis=1))[place]
    total = np.bincount(whole[: 2 * len(ends) : 2], length, len(spots))
    total[whole[2 * len(ends) :]] = np.inf
    return np.asarray(total[whole[: 2 * len(ends) : 2]] < LONE_STROKE_MM)
