"""Which ends of strokes are near others, of those that are a few places away along curves through all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.strokes.pen_order.tour_ends import ALL_PAIRS, REACH, Curves, Places
from vectorplot.geometry.chunks import mapped, slices

# So many ends are looked at at once: what is computed of them stays near the processor.
_ENDS_AT_ONCE = 1 << 14
# Where more of all ends than one in so many look for others, all do.
_FEW = 3

_STEPS = np.delete(np.arange(-REACH, REACH + 1), REACH)


@dataclass(frozen=True, eq=False)
class Crowd:
    """Ends of strokes among which near ones are sought again and again. spots, layer (n,): of the ends; curves: through
    them; along: for each curve the spots along it, with REACH more on either side, as if it were closed; place: for
    each curve the place of each end along it."""

    spots: Places
    layer: Ints
    curves: Curves
    along: tuple[Places, ...]
    place: tuple[Ints, ...]


def crowd(spots: Places, layer: Ints, curves: Curves) -> Crowd:
    """The ends at these spots, of layers (n,), with curves through them."""
    if len(spots) <= ALL_PAIRS:
        return Crowd(spots, layer, curves, (), ())
    along = tuple(spots.take(np.concatenate((curve[-REACH:], curve, curve[:REACH]))) for curve in curves)
    places = []
    for curve in curves:
        place = np.empty_like(curve)
        place[curve] = np.arange(len(curve))
        places.append(place)
    return Crowd(spots, layer, curves, along, tuple(places))


def nearer_than(reach: Floats, opposite: Ints, among: Crowd) -> tuple[Ints, Ints, Floats]:
    """Ends (p,), ends of the same layer less than reach (n,) from them, and how far. Not all that are so near, if
    many others are nearer; some twice.

    opposite (n,): the end that does not count for each, besides itself.
    """
    spots, layer = among.spots, among.layer
    if len(spots) <= ALL_PAIRS:
        apart = np.abs(spots[:, None] - spots)
        one, other = np.nonzero(apart < reach[:, None])
        some = np.flatnonzero((one != other) & (opposite[one] != other) & (layer[one] == layer[other]))
        one, other = one[some], other[some]
        return one, other, apart[one, other]
    awake = np.flatnonzero(reach > 0.0)
    everybody = len(awake) * _FEW > len(spots)
    several = layer[0] != layer[-1]

    def of_part(number: int, some: Ints | slice) -> tuple[Ints, Ints, Floats]:
        curve = among.curves[number]
        if isinstance(some, slice):
            at, to, apart = _near_in_a_row(among.along[number], some, reach.take(curve[some]))
        else:
            at, to, apart = _near_places(among.along[number], some, reach.take(curve.take(some)))
        one, other = curve.take(at), curve.take(to, mode="wrap")
        good = opposite.take(one) != other
        if number:
            # Those that are so near along the first curve are known.
            good &= np.abs(among.place[0].take(one) - among.place[0].take(other)) > REACH
        if several:
            good &= layer.take(one) == layer.take(other)
        return one[good], other[good], apart[good]

    parts: list[tuple[int, Ints | slice]] = []
    for number, place in enumerate(among.place):
        if everybody:
            parts += [(number, part) for part in slices(len(spots), _ENDS_AT_ONCE)]
        else:
            some = np.sort(place.take(awake))
            parts += [(number, some[part]) for part in slices(len(some), _ENDS_AT_ONCE)]
    none = np.zeros(0, dtype=np.intp)
    pairs = [(none, none, np.zeros(0)), *mapped(lambda part: of_part(*part), parts)]
    one, other, apart = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return one, other, apart


def _near_in_a_row(along: Places, some: slice, far: Floats) -> tuple[Ints, Ints, Floats]:
    """Of all places of a slice, and those a few steps along the curve: which are less than far (k,) from them."""
    count = some.stop - some.start
    window = along[some.start : some.stop + 2 * REACH]
    apart = np.empty((len(_STEPS), count))
    for lag in range(1, REACH + 1):
        length = np.abs(window[lag:] - window[:-lag])
        apart[REACH - lag] = length[REACH - lag : REACH - lag + count]
        apart[REACH - 1 + lag] = length[REACH : REACH + count]
    near = np.flatnonzero(np.ascontiguousarray((apart < far).T))
    k, step = near // len(_STEPS), near % len(_STEPS)
    at = k + some.start
    return at, at + _STEPS.take(step), apart.ravel().take(step * count + k)


def _near_places(along: Places, some: Ints, far: Floats) -> tuple[Ints, Ints, Floats]:
    """Of some places, and those a few steps along the curve: which are less than far (k,) from them."""
    to = some[:, None] + _STEPS
    apart = np.abs(along.take(to + REACH) - along.take(some + REACH)[:, None])
    near = np.flatnonzero(apart < far[:, None])
    return some[near // len(_STEPS)], to.take(near), apart.take(near)
