"""Coordinates as text, whole arrays at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Ints


def formatted(first: NDArray[np.uint8], x: Ints, y: Ints, last: NDArray[np.uint8]) -> bytes:
    """Rows of ``<first>x,y<last>`` as bytes, x and y in mm from thousandths of them; a zero in last is left out."""
    comma = np.full(len(x), ord(","), np.uint8)
    table = np.column_stack((first, millimetres(x), comma, millimetres(y), last))
    text: NDArray[np.uint8] = table[table != 0]
    return text.tobytes()


def millimetres(microns: Ints) -> NDArray[np.uint8]:
    """Decimals in mm as rows of characters, with 0 where a row has no character: no leading or trailing zeros."""
    whole, part = np.divmod(np.abs(microns).astype(np.uint32), np.uint32(1000))
    digits = len(str(int(whole.max(initial=0)))) + 1
    text = np.zeros((len(microns), digits + 4), np.uint8)
    text[:, 0] = np.where(microns < 0, ord("-"), 0)
    rest = whole
    for column in range(digits - 1, 0, -1):
        rest, digit = np.divmod(rest, np.uint32(10))
        shown = (digit + rest > 0) | (column == digits - 1)
        text[:, column] = np.where(shown, digit + ord("0"), 0)
    text[:, digits] = np.where(part > 0, ord("."), 0)
    for column, unit in ((1, 100), (2, 10), (3, 1)):
        # A decimal is shown if it or a later one is not zero.
        shown = part % (unit * 10) > 0
        text[:, digits + column] = np.where(shown, part // unit % 10 + ord("0"), 0)
    return text


def path_data(points: Ints, first: Ints, opening: NDArray[np.uint8], closing: NDArray[np.uint8]) -> bytes:
    """Polygons as the data of paths: their first points (m,) among all points (n,2), in thousandths of a mm, written
    whole after opening (m,), all others as ways from those before them; closing (m,) follows the last one, if it is not
    zero."""
    ways = np.diff(points, axis=0, prepend=points[:1])
    ways[first] = points[first]
    lead, last = np.zeros(len(points), np.uint8), np.zeros(len(points), np.uint8)
    second = np.delete(first + 1, np.flatnonzero(np.append(first[1:], len(points)) == first + 1))
    lead[ways[:, 0] >= 0] = ord(" ")
    lead[second] = ord("l")
    lead[first] = opening
    last[np.append(first[1:], len(points)) - 1] = closing
    comma = np.where(ways[:, 1] < 0, 0, ord(",")).astype(np.uint8)
    table = np.column_stack((lead, _short(ways[:, 0]), comma, _short(ways[:, 1]), last))
    text: NDArray[np.uint8] = table[table != 0]
    return text.tobytes()


def _short(microns: Ints) -> NDArray[np.uint8]:
    """The same as millimetres, without a zero before the point."""
    text = millimetres(microns)
    column = text.shape[1] - 5
    small = (np.abs(microns) < 1000) & (microns != 0)
    text[small, column] = 0
    return text
