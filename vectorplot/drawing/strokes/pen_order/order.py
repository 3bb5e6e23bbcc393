"""The order in which a pen draws strokes: little travel with the pen up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.pen_order.tour import greedy_tour
from vectorplot.drawing.strokes.pen_order.tour_ends import Places, curves_through
from vectorplot.drawing.strokes.pen_order.tour_moves import shortened
from vectorplot.drawing.strokes.stroke_paths import chosen, directed, swapped
from vectorplot.errors import InputError
from vectorplot.exact.radix import radix_order
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import modulus
from vectorplot.geometry.polylines import with_points

# In so many bits strokes are put in order from left to right; what falls together is looked at again.
_PLACE_BITS = 32


def pen_ordered(paths: Paths, layer: Ints | None = None) -> Paths:
    """The same strokes in an order, with directions and (closed ones) first points that make the pen's travel short.

    Parameters
    ----------
    paths : Paths
        Strokes that one pen draws.
    layer : array (m,), optional
        The layer of each stroke, where there are several: each is ordered for itself, one after the other.

    Returns
    -------
    Paths
        Each stroke once, some of them turned round or begun elsewhere.

    Notes
    -----
    The pen begins anywhere; the end of the tour nearer to the page's corner comes first. The result does not depend on
    the order or the directions of the given strokes, except among strokes with equal ends.

    Degenerate: strokes without points come last, as given.

    Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): greedy
    matching, 2-opt, Or-opt with neighbour lists.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import Paths, pen_ordered, travel_mm
    >>> points = np.array([(0.0, 0.0), (0.0, 50.0), (20.0, 0.0), (20.0, 50.0), (10.0, 0.0), (10.0, 50.0)])
    >>> none, open_ = np.zeros(3, dtype=int), np.zeros(3, dtype=bool)
    >>> lines = Paths(points, np.array([0, 2, 4, 6]), open_, none, none, none, np.zeros((6, 3)))
    >>> ordered = pen_ordered(lines)
    >>> round(travel_mm(lines), 1), round(travel_mm(ordered), 1)
    (104.8, 20.0)
    """
    if layer is None:
        layer = np.zeros(len(paths), dtype=np.intp)
    empty = np.diff(paths.offsets) == 0
    if empty.any():
        last = np.argsort(empty, kind="stable")
        layer, paths = layer[last], chosen(paths, last)
    many = int(len(paths) - empty.sum())
    if many == 0:
        return paths
    spots = _spots(paths)
    start = _canonical_starts(paths, spots)
    rank, ends = _canonical_ends(paths, spots, start, layer[:many])
    tour, bounds = np.zeros(1, dtype=np.intp), np.array([0, 1])
    # A single stroke leaves no choice, and of many layers most have no more.
    if many > 1:
        layer = np.repeat(layer[rank], 2)
        curves = curves_through(ends, layer)
        tour = greedy_tour(ends, layer, curves)
        bounds = np.append(np.flatnonzero(np.diff(layer[tour], prepend=layer[0] - 1)), many)
        if np.any(paths.closed[:many]):
            entry, start = _entered(paths, spots, start, rank, ends, tour, bounds)
            ends, curves = entry, curves_through(entry, layer)
        tour = shortened(ends, tour, layer, curves)
        if np.any(paths.closed[:many]):
            ends, start = _entered(paths, spots, start, rank, ends, tour, bounds)
    tour = _from_the_corner(ends, tour, bounds)
    return _drawn(paths, start, rank[tour >> 1], _reversed(paths, spots, rank, tour))


def travel_mm(paths: Paths) -> float:
    """The way of the pen while it is up, from the end of each stroke to the beginning of the next, in mm.

    Parameters
    ----------
    paths : Paths
        In the order in which they are drawn.

    Returns
    -------
    float
        In mm; a closed stroke ends where it begins.

    Raises
    ------
    InputError
        For what is no Paths.

    Notes
    -----
    Degenerate: 0 for no stroke or one; strokes without points count as none.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import Paths, travel_mm
    >>> points = np.array([(0.0, 0.0), (50.0, 0.0), (50.0, 10.0), (0.0, 10.0)])
    >>> none, open_ = np.zeros(2, dtype=int), np.zeros(2, dtype=bool)
    >>> travel_mm(Paths(points, np.array([0, 2, 4]), open_, none, none, none, np.zeros((4, 3))))
    10.0
    """
    if not isinstance(paths, Paths):
        raise InputError(f"travel_mm: expected the Paths of a layer, of its strokes, got a {type(paths).__name__}")
    drawn = np.diff(paths.offsets) > 0
    first = paths.offsets[:-1][drawn]
    last = np.where(paths.closed[drawn], first, paths.offsets[1:][drawn] - 1)
    return float(np.hypot(*(paths.points[first[1:]] - paths.points[last[:-1]]).T).sum())


def _from_the_corner(ends: Places, tour: Ints, bounds: Ints) -> Ints:
    """The tours of layers, which begin at bounds, turned round where they end nearer to the corner than they begin."""
    first, last = bounds[:-1], bounds[1:] - 1
    turned = modulus(ends[tour[last] ^ 1]) < modulus(ends[tour[first]])
    counts = np.diff(bounds)
    position = np.arange(len(tour))
    backwards = np.repeat(turned, counts)
    position = np.where(backwards, np.repeat(first + last, counts) - position, position)
    return np.where(backwards, tour[position] ^ 1, tour[position])


# Canonical numbering ---------------------------------------------------------------------------------------------


def _spots(paths: Paths) -> Places:
    spots: Places = np.ascontiguousarray(paths.points, dtype=np.float64).view(np.complex128).ravel()
    return spots


def _canonical_starts(paths: Paths, spots: Places) -> Ints:
    """Where each stroke begins, as a place in it: its leftmost point for a closed one, 0 for an open one."""
    start = np.zeros(len(paths), dtype=np.intp)
    loops = np.flatnonzero(paths.closed & (np.diff(paths.offsets) > 1))
    if len(loops):
        first, counts = paths.offsets[:-1][loops], np.diff(paths.offsets)[loops]
        index = ragged.ranges(first, counts)
        start[loops] = _least(spots[index].real, spots[index].imag, counts)
    return start


def _least(value: Floats, tie: Floats, counts: Ints) -> Ints:
    """The place in each run of the least value, the least tie among equal values."""
    begin = ragged.starts(counts)
    run = ragged.owner(counts)
    at = np.flatnonzero(value == np.minimum.reduceat(value, begin)[run])
    at = at[np.lexsort((tie[at], run[at]))]
    place: Ints = at[np.searchsorted(run[at], np.arange(len(counts)))] - begin
    return place


def _canonical_ends(paths: Paths, spots: Places, start: Ints, layer: Ints) -> tuple[Ints, Places]:
    """The first strokes, of which the layers (k,) are given, sorted by these and by where they are; and the places of
    their two ends, the lesser one first."""
    many = len(layer)
    first, last = _given_ends(paths, spots, start)
    a, b = np.minimum(first, last)[:many], np.maximum(first, last)[:many]
    from_left = (a.real - a.real.min()) / (np.ptp(a.real) or 1.0)
    key = np.ldexp(from_left, _PLACE_BITS - 1).astype(np.uint64)
    layer = layer - layer.min()
    if layer.max() >> (64 - _PLACE_BITS):
        layer = np.unique(layer, return_inverse=True)[1]
    if layer.any():
        key |= layer.astype(np.uint64) << np.uint64(_PLACE_BITS)
    rank = radix_order(key, _PLACE_BITS + int(layer.max()).bit_length())
    # Few are equal so far, and only these are looked at again.
    same = np.diff(key.take(rank)) == 0
    tied = np.flatnonzero(np.append(same, False) | np.append(False, same))
    if len(tied):
        run, of = np.cumsum(~same[tied[1:] - 1]), rank[tied]
        rank[tied] = of[np.lexsort((b[of].imag, b[of].real, a[of].imag, a[of].real, np.append(0, run)))]
    return rank, np.stack((a[rank], b[rank]), axis=1).ravel()


def _given_ends(paths: Paths, spots: Places, start: Ints) -> tuple[Places, Places]:
    """The first and last place of each stroke; they agree for closed ones. 0 for strokes without points."""
    spots = np.append(spots, 0.0)
    first = paths.offsets[:-1] + start
    return spots[first], spots[np.where(paths.closed, first, np.maximum(paths.offsets[1:] - 1, first))]


def _reversed(paths: Paths, spots: Places, rank: Ints, tour: Ints) -> Bools:
    """True where the tour draws a stroke against its given direction."""
    first, last = _given_ends(paths, spots, np.zeros(len(paths), dtype=np.intp))
    swapped = np.minimum(first, last) != first
    stroke = rank[tour >> 1]
    against: Bools = (swapped[stroke] != (tour & 1 == 1)) & ~paths.closed[stroke]
    return against


def _drawn(paths: Paths, start: Ints, order: Ints, against: Bools) -> Paths:
    """The strokes in this order, some of them backwards, closed ones from their starts on; empty ones last."""
    rest = np.arange(len(order), len(paths))
    order = np.concatenate((order, rest))
    against = np.concatenate((against, np.zeros(len(rest), dtype=np.bool_)))
    counts = np.diff(paths.offsets)[order]
    begin = np.where(against, counts - 1, start[order])
    step = np.where(against, -1, 1)
    local = ragged.place(counts) * np.repeat(step, counts) + np.repeat(begin, counts)
    size = np.repeat(counts, counts)
    local -= np.where(local >= size, size, 0)
    index = np.repeat(paths.offsets[:-1][order], counts) + local
    drawn = with_points(paths, index, order, ragged.offsets(counts))
    turned = np.repeat(against, counts)
    return replace(drawn, directions=directed(drawn.directions, turned), handles=swapped(drawn.handles, turned))


# Closed strokes ---------------------------------------------------------------------------------------------------


def _entered(
    paths: Paths, spots: Places, start: Ints, rank: Ints, ends: Places, tour: Ints, bounds: Ints
) -> tuple[Places, Ints]:
    """Ends and starts with the closed strokes entered where the way from the stroke before to the next is shortest;
    bounds: where the tours of layers begin, and the last one ends.

    Every other stroke moves at a time, between neighbours that stay, so that each step shortens the way.
    """
    ends, start = ends.copy(), start.copy()
    counts = np.diff(paths.offsets)
    layers = np.diff(bounds)
    position, first, last = ragged.place(layers), np.repeat(bounds[:-1], layers), np.repeat(bounds[1:] - 1, layers)
    loops = paths.closed[rank[tour >> 1]] & (first < last)
    for turn in (0, 1, 0, 1):
        at = np.flatnonzero(loops & (position % 2 == turn))
        if not len(at):
            continue
        stroke = rank[tour[at] >> 1]
        before = ends[tour[np.maximum(at - 1, first[at])] ^ 1]
        after = ends[tour[np.minimum(at + 1, last[at])]]
        before, after = np.where(at == first[at], after, before), np.where(at == last[at], before, after)
        many = counts[stroke]
        spot = spots[ragged.ranges(paths.offsets[:-1][stroke], many)]
        way = modulus(spot - np.repeat(before, many)) + modulus(spot - np.repeat(after, many))
        start[stroke] = _least(way, spot.real, many)
        entry = spots[paths.offsets[:-1][stroke] + start[stroke]]
        ends[tour[at]] = ends[tour[at] ^ 1] = entry
    return ends, start
