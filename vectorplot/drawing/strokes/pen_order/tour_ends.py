"""Places of the ends of strokes, curves through them, and which of them are each other's nearest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints

Places = NDArray[np.complex128]
Curves = tuple[Ints, ...]
"""Orders of the same ends, (n,) each."""

# Up to this many ends, every pair is looked at.
ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
REACH = 4
# The curve is shifted by these parts of the extent.
_SHIFTS = (0.0, (1 + 1j) / 3, (2 + 2j) / 3)
# So many bits has a code of Morton's curve.
_CODE_BITS = 60


def extent(spots: Places) -> float:
    """The larger side of the box around the places."""
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def mutual_nearest(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1, as each must be the other's nearest; how far that is.

    other: the end of the same fragment, which does not count, nor do those of other layers (n,); curves: through these
    ends.
    """
    if len(spots) <= ALL_PAIRS:
        near, apart = _nearest_of_all(spots, other, layer)
    else:
        near, apart = _nearest_along_curves(spots, other, layer, curves)
    return np.where((near[near] == np.arange(len(near))) & (apart < np.inf), near, -1), apart


def _nearest_of_all(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Floats]:
    apart = np.where(layer[:, None] == layer, np.abs(spots[:, None] - spots), np.inf)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    return near, apart[number, near]


def _nearest_along_curves(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Floats]:
    near = np.zeros(len(spots), dtype=np.intp)
    apart = np.full(len(spots), np.inf)
    several = layer[0] != layer[-1]
    for curve in curves:
        along, opposite = spots.take(curve), other.take(curve)
        best, best_apart = near.take(curve), apart.take(curve)
        for lag in range(1, REACH + 1):
            length = np.abs(along[lag:] - along[:-lag])
            length[opposite[lag:] == curve[:-lag]] = np.inf
            if several:
                own = layer.take(curve)
                length[own[lag:] != own[:-lag]] = np.inf
            for here, there in ((slice(lag, None), slice(None, -lag)), (slice(None, -lag), slice(lag, None))):
                nearer = np.flatnonzero(length < best_apart[here])
                best[here][nearer] = curve[there][nearer]
                best_apart[here][nearer] = length[nearer]
        near[curve], apart[curve] = best, best_apart
    return near, apart


def curves_through(spots: Places, layer: Ints, before: Curves | None = None) -> Curves:
    """Orders of the places, layer (n,) ascending after layer, along Morton's curve, which keeps near places together
    whatever their density; and along the same curve shifted by a third and by two, since every curve separates some
    neighbours (Chan). before: the curves when most of the ends were where they are now: this costs less."""
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (extent(spots) or 1.0)
    number = np.arange(len(spots), dtype=np.uint64)
    rank = np.zeros(len(spots), dtype=np.uint64)
    np.cumsum(layer[1:] != layer[:-1], out=rank[1:])
    # Layer, code and number in one integer: what is sorted is the key alone. The code loses bits below a cell in which
    # no pen could tell places apart.
    of_number, of_layer = len(spots).bit_length(), int(rank[-1]).bit_length()
    coarser = np.uint64(max(of_number + of_layer - (64 - _CODE_BITS), 0))
    rank <<= np.uint64(64 - of_layer) if of_layer else np.uint64(0)
    mask = np.uint64((1 << of_number) - 1)

    def curve(shift: complex, order: Ints | None) -> Ints:
        key = rank | _morton(unit + shift) >> coarser << np.uint64(of_number) | number
        if order is None:
            key.sort()
        else:
            key = key.take(order)
            key.sort(kind="stable")  # merges what is in order
        return (key & mask).astype(np.intp)

    return tuple(curve(shift, order) for shift, order in zip(_SHIFTS, before or (None,) * 3, strict=True))


def thinned(curves: Curves, kept: Bools) -> Curves:
    """Curves through the ends that are kept (n,), in their new numbers."""
    number = np.cumsum(kept) - 1
    return tuple(number.take(curve[kept.take(curve)]) for curve in curves)


def _morton(unit: Places) -> NDArray[np.uint64]:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint64(1)


def _every_other_bit(x: Floats) -> NDArray[np.uint64]:
    bits = (x * 2.0 ** (_CODE_BITS // 2 - 1)).astype(np.uint64)
    for shift, mask in (
        (16, 0x0000FFFF0000FFFF),
        (8, 0x00FF00FF00FF00FF),
        (4, 0x0F0F0F0F0F0F0F0F),
        (2, 0x3333333333333333),
        (1, 0x5555555555555555),
    ):
        bits = (bits | bits << np.uint64(shift)) & np.uint64(mask)
    return bits
