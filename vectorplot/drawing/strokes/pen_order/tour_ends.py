"""Places of the ends of strokes, and which of them are near each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints

Places = NDArray[np.complex128]

# Up to this many ends, every pair is looked at.
ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
REACH = 5


def extent(spots: Places) -> float:
    """The larger side of the box around the places."""
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def mutual_nearest(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1, as each must be the other's nearest; how far that is.

    other: the end of the same fragment, which does not count, nor do those of other layers (n,).
    """
    nearest = _nearest_of_all if len(spots) <= ALL_PAIRS else _nearest_along_curves
    near, apart = nearest(spots, other, layer)
    return np.where((near[near] == np.arange(len(near))) & (apart < np.inf), near, -1), apart


def _nearest_of_all(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Floats]:
    apart = np.where(layer[:, None] == layer, np.abs(spots[:, None] - spots), np.inf)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    return near, apart[number, near]


def _nearest_along_curves(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Floats]:
    near = np.zeros(len(spots), dtype=np.intp)
    apart = np.full(len(spots), np.inf)
    for curve in curves_through(spots, layer):
        along, opposite, own = spots[curve], other[curve], layer[curve]
        best, best_apart = near[curve], apart[curve]
        for lag in range(1, REACH + 1):
            length = np.abs(along[lag:] - along[:-lag])
            np.copyto(length, np.inf, where=(opposite[lag:] == curve[:-lag]) | (own[lag:] != own[:-lag]))
            for here, there in ((slice(lag, None), slice(None, -lag)), (slice(None, -lag), slice(lag, None))):
                nearer = length < best_apart[here]
                np.copyto(best[here], curve[there], where=nearer)
                np.copyto(best_apart[here], length, where=nearer)
        near[curve], apart[curve] = best, best_apart
    return near, apart


def curves_through(spots: Places, layer: Ints) -> tuple[Ints, ...]:
    """Orders of the places, layer after layer, along Morton's curve, which keeps near places together whatever their
    density; and along the same curve shifted by a third, since every curve separates some neighbours (Chan)."""
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (extent(spots) or 1.0)
    curves = (np.argsort(_morton(unit + shift), kind="stable") for shift in (0.0, (1 + 1j) / 3))
    return tuple(curve[np.argsort(layer[curve], kind="stable")] for curve in curves)


def _morton(unit: Places) -> NDArray[np.uint64]:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint64(1)


def _every_other_bit(x: Floats) -> NDArray[np.uint64]:
    bits = (x * 2.0**29).astype(np.uint64)
    for shift, mask in (
        (16, 0x0000FFFF0000FFFF),
        (8, 0x00FF00FF00FF00FF),
        (4, 0x0F0F0F0F0F0F0F0F),
        (2, 0x3333333333333333),
        (1, 0x5555555555555555),
    ):
        bits = (bits | bits << np.uint64(shift)) & np.uint64(mask)
    return bits


def neighbours(spots: Places, layer: Ints) -> Ints:
    """(n,k) for every end some ends near it, most of them of its layer, perhaps itself, perhaps one twice."""
    return neighbourhood(spots, layer).of(slice(0, len(spots)))


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """Ends along curves that keep near places together, to look up what is near some of them.

    around (c,n+2r): the ends along each curve, the last r of them once more before, the first r after them; place (c,n)
    where along the curve each end is; steps (k,) from there to what counts as near.
    """

    around: Ints
    place: Ints
    steps: Ints

    def of(self, some: slice) -> Ints:
        """(m,k) the ends near some of the ends, as neighbours says."""
        near = [row.take(place[some, None] + self.steps) for row, place in zip(self.around, self.place, strict=True)]
        return np.concatenate(near, axis=1)


def neighbourhood(spots: Places, layer: Ints) -> Neighbourhood:
    """The ends at these places, those of one layer nearer to each other than to others."""
    number = np.arange(len(spots))
    if len(spots) <= ALL_PAIRS:
        return Neighbourhood(number[None], np.zeros((1, len(spots)), dtype=np.intp), number)
    curves = np.stack(curves_through(spots, layer))
    place = np.empty_like(curves)
    np.put_along_axis(place, curves, number[None], axis=1)
    around = np.concatenate([curves[:, -REACH:], curves, curves[:, :REACH]], axis=1)
    return Neighbourhood(around, place, np.delete(np.arange(2 * REACH, -1, -1), REACH))
