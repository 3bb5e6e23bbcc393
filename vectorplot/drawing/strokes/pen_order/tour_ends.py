"""Places of the ends of strokes, curves through them, and which of them are each other's nearest."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.exact.radix import ShortKeys, radix_order
from vectorplot.geometry.chunks import mapped, slices, threads, workers
from vectorplot.geometry.elementary import modulus

Places = NDArray[np.complex128]
Curves = tuple[Ints, ...]
"""Orders of the same ends, (n,) each."""

# Up to this many ends, every pair is looked at.
ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
REACH = 4
# The curve is shifted by these parts of the extent.
_SHIFTS = (0.0, (1 + 1j) / 3, (2 + 2j) / 3)
# So many bits has a code of Morton's curve: in its finest cells no pen could tell places apart.
_CODE_BITS = 32
# So many ends are looked at at once: what is computed of them stays near the processor.
ENDS_AT_ONCE = 1 << 15


def extent(spots: Places) -> float:
    """The larger side of the box around the places."""
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def mutual_nearest(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1, as each must be the other's nearest; how far the nearest is.

    other: the end of the same fragment, which does not count, nor do those of other layers (n,); curves: through these
    ends.
    """
    if len(spots) <= ALL_PAIRS:
        one, two, nearest = _nearest_of_all(spots, other, layer)
    else:
        one, two, nearest = _nearest_along_curves(spots, other, layer, curves)
    mate = np.full(len(spots), -1, dtype=np.intp)
    # Of pairs that are as far apart and share an end the last one stays.
    pairs = np.stack((one, two), axis=1)
    mate[pairs.ravel()] = pairs[:, ::-1].ravel()
    return np.where((mate >= 0) & (mate.take(mate) == np.arange(len(mate))), mate, -1), nearest


def _nearest_of_all(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Ints, Floats]:
    apart = np.where(layer[:, None] == layer, modulus(spots[:, None] - spots), np.inf)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    nearest = apart[number, near]
    one = np.flatnonzero((near[near] == number) & (number < near) & (nearest < np.inf))
    return one, near[one], nearest


def _nearest_along_curves(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Ints, Floats]:
    several = layer[0] != layer[-1]

    def of_part(part: tuple[Ints, slice]) -> tuple[Ints, Floats, Ints, Ints, Floats]:
        """Some ends of a curve, and how far the nearest one along it is from each; pairs of them and ends after them
        that are each other's nearest along it, and how far apart these are."""
        curve, some = part
        # The curve goes on where it begins.
        ends = curve.take(np.arange(some.start - REACH, some.stop + 2 * REACH), mode="wrap")
        spot, opposite, of = spots.take(ends), other.take(ends), layer.take(ends) if several else None
        least, apart = np.full(len(ends), np.inf), []
        for lag in range(1, REACH + 1):
            length = modulus(spot[lag:] - spot[:-lag])
            length[np.flatnonzero(opposite[lag:] == ends[:-lag])] = np.inf
            if of is not None:
                length[np.flatnonzero(of[lag:] != of[:-lag])] = np.inf
            for side in (least[lag:], least[:-lag]):
                np.minimum(side, length, out=side)
            apart.append(length)
        count, pairs = some.stop - some.start, []
        ends, least = ends[REACH:], least[REACH:]
        for lag, length in enumerate(apart, start=1):
            length = length[REACH : REACH + count]
            near = np.flatnonzero((length == least[:count]) & (length == least[lag : lag + count]))
            pairs.append((ends.take(near), ends[lag:].take(near), length.take(near)))
        one, two, length = (np.concatenate(column) for column in zip(*pairs, strict=True))
        return ends[:count], least[:count], one, two, length

    nearest = np.full(len(spots), np.inf)
    pairs = []
    with threads(workers(len(spots))):
        for own, least, *found in mapped(of_part, product(curves, slices(len(spots), ENDS_AT_ONCE))):
            nearest[own] = np.minimum(nearest.take(own), least)
            pairs.append(found)
    one, two, apart = (np.concatenate(column) for column in zip(*pairs, strict=True))
    both = np.flatnonzero((apart == nearest.take(one)) & (apart == nearest.take(two)) & (apart < np.inf))
    return one.take(both), two.take(both), nearest


def curves_through(spots: Places, layer: Ints) -> Curves:
    """Orders of the places, layer (n,) ascending after layer, along Morton's curve, which keeps near places together
    whatever their density; and along the same curve shifted by a third and by two, since every curve separates some
    neighbours (Chan). Of so few places that every pair is looked at one order is all that is asked for."""
    shifts = _SHIFTS if len(spots) > ALL_PAIRS else _SHIFTS[:1]
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (extent(spots) or 1.0)
    if layer[0] == layer[-1]:
        return tuple(radix_order(_morton(unit + shift), _CODE_BITS) for shift in shifts)
    rank = np.zeros(len(spots), dtype=np.uint64)
    np.cumsum(layer[1:] != layer[:-1], out=rank[1:])
    bits = _CODE_BITS + int(rank[-1]).bit_length()
    rank <<= np.uint64(_CODE_BITS)
    return tuple(radix_order(rank | _morton(unit + shift), bits) for shift in shifts)


def _morton(unit: Places) -> ShortKeys:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint32(1)


def _every_other_bit(x: Floats) -> ShortKeys:
    bits = (x * 2.0 ** (_CODE_BITS // 2 - 1)).astype(np.uint32)
    for shift, mask in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        bits = (bits | bits << np.uint32(shift)) & np.uint32(mask)
    return bits
