"""Numbers written in text, converted in bulk: eight characters at a time, in integer arithmetic."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints

Bytes = NDArray[np.uint8]
Words = NDArray[np.uint64]

# A text has this many blanks in front, so that the window of any character stays inside, and is as long as whole words.
PAD = 24
_ZEROS = np.uint64(0x3030303030303030)
_HIGH = np.uint64(0x8080808080808080)
_POWERS = 10.0 ** np.arange(23)
_TENS = np.array([10**k for k in range(20)], dtype=np.uint64)
_ALLOWED = np.isin(np.arange(256), np.frombuffer(b"0123456789+-.eE", dtype=np.uint8))


class NumeralError(ValueError):
    """A word that is not the number wanted: its place among the words, and the cause."""

    def __init__(self, index: int, cause: str) -> None:
        self.index = index
        self.cause = cause
        super().__init__(cause)


def padded(data: bytes) -> Bytes:
    """The text with blanks before and after it, as the functions of this file want it."""
    text = np.full((PAD + len(data) + PAD + 7) // 8 * 8, 32, dtype=np.uint8)
    text[PAD : PAD + len(data)] = np.frombuffer(data, dtype=np.uint8)
    return text


def decimals(text: Bytes, starts: Ints, ends: Ints) -> Floats:
    """(n,) the numbers written in text[starts:ends], rounded correctly.

    Up to 8 digits before the point and 19 after it, less than 2^53 in all, are a quotient of two exact doubles, rounded
    once; less than 2^63 in all, one of long doubles; everything else goes through Python's own conversion.
    Errors: NumeralError for a word that is no decimal number, and for one that is not finite.
    Source: Clinger, How to read floating point numbers accurately, section 4 (the fast case).
    """
    words = text.view(np.uint64)
    lead = text[starts]
    negative = lead == ord("-")
    begin = starts + (negative | (lead == ord("+")))
    point = _points(text, starts, ends)
    before = point - begin
    after = np.maximum(ends - point - 1, 0)
    whole, good = _digits(words, point, np.minimum(before, 8))
    low, fine = _digits(words, ends, np.minimum(after, 8))
    good &= fine & (before <= 8) & (after <= 19) & (before + after > 0)
    if len(after) and after.max() > 8:
        high, fine = _digits(words, ends - 8, np.clip(after - 8, 0, 8))
        low += high * _TENS[8]
        good &= fine
    if len(after) and after.max() > 16:
        high, fine = _digits(words, ends - 16, np.clip(after - 16, 0, 3))
        low += high * _TENS[16]
        good &= fine
    mantissa = whole * _TENS[np.minimum(after, 19)] + low
    # More digits than these may not fit into 63 bits.
    good &= ((before + after <= 18) | (whole == 0)) & (mantissa < np.uint64(1 << 63))
    values = mantissa.astype(np.float64) / _POWERS[np.minimum(after, 22)]
    large = np.flatnonzero(good & (mantissa >= np.uint64(1 << 53)))
    if len(large):
        values[large], good[large] = _long_quotients(mantissa[large], after[large])
    np.negative(values, out=values, where=negative)
    if not good.all():
        odd = np.flatnonzero(~good)
        values[odd] = _one_by_one(text, starts, ends, odd)
    return np.asarray(values)


def integers(text: Bytes, starts: Ints, ends: Ints) -> Ints:
    """(n,) the integers written in text[starts:ends]. Errors: NumeralError for a word that is no integer."""
    lead = text[starts]
    negative = lead == ord("-")
    begin = starts + (negative | (lead == ord("+")))
    length = ends - begin
    digits, good = _digits(text.view(np.uint64), ends, np.minimum(length, 8))
    good &= (length >= 1) & (length <= 8)
    values = digits.astype(np.intp)
    np.negative(values, out=values, where=negative)
    for index in np.flatnonzero(~good).tolist():
        word = text[starts[index] : ends[index]].tobytes()
        if not word[word[:1] in (b"+", b"-") :].isdigit() or len(word) > 18:
            raise NumeralError(index, f"expected an integer, got {_quoted(word)}")
        values[index] = int(word)
    return values


def _points(text: Bytes, starts: Ints, ends: Ints) -> Ints:
    """(n,) where the first decimal point of every word stands; its end if there is none."""
    if len(starts) == 0:
        return ends
    points = np.flatnonzero(text[: ends[-1]] == ord("."))
    if len(points) == 0:
        return ends
    if len(points) != len(starts) or (points < starts).any() or (points >= ends).any():
        points = points[np.minimum(np.searchsorted(points, starts), len(points) - 1)]
    return np.where((points >= starts) & (points < ends), points, ends)


def _digits(words: Words, ends: Ints, length: Ints) -> tuple[Words, Bools]:
    """(n,) the integers of the 0 to 8 digits before ends, and whether they are digits.

    Source: Lemire and others, the well-known parallel conversion of eight digits: pairs, fours, eights.
    """
    place = ends - 8
    bits = ((place & 7) << 3).astype(np.uint64)
    place >>= 3
    window = words[place] >> bits
    # For a window that starts with a word the shift is by 64, which numpy defines to give 0.
    window |= words[place + 1] << (np.uint64(64) - bits)
    window ^= _ZEROS
    blank = ((8 - length) << 3).astype(np.uint64)
    window >>= blank
    window <<= blank
    good = ((window | (window + np.uint64(0x7676767676767676))) & _HIGH) == 0
    window = window * np.uint64(10) + (window >> np.uint64(8))
    mask = np.uint64(0x000000FF000000FF)
    fours = (window & mask) * np.uint64(0x000F424000000064)
    fours += ((window >> np.uint64(16)) & mask) * np.uint64(0x0000271000000001)
    return fours >> np.uint64(32), good


def _long_quotients(mantissa: Words, places: Ints) -> tuple[Floats, Bools]:
    """(n,) integers below 2^63 over powers of ten, and whether they are rounded correctly for sure.

    The quotient in 64 bits is rounded once, and again to 53: that is wrong only where the first rounding made it a tie,
    half a unit (below a power of two a quarter) from the result. Nothing is sure without a long double of 64 bits.
    """
    if np.finfo(np.longdouble).nmant != 63:
        return np.zeros(len(places)), np.zeros(len(places), dtype=np.bool_)
    long = mantissa.astype(np.longdouble) / _POWERS.astype(np.longdouble)[places]
    values = long.astype(np.float64)
    rest = np.abs(long - values).astype(np.float64) / np.spacing(values)
    return values, (rest != 0.5) & (rest != 0.25)


def _one_by_one(text: Bytes, starts: Ints, ends: Ints, odd: Ints) -> Floats:
    """Numbers of any length and with exponents, by Python's conversion."""
    lengths = (ends - starts)[odd]
    width = int(lengths.max())
    if width > 64:
        index = int(odd[int(lengths.argmax())])
        word = text[starts[index] : ends[index]].tobytes()
        raise NumeralError(index, f"expected a number, got {_quoted(word)}")
    columns = np.arange(width)
    inside = columns < lengths[:, None]
    characters = np.where(inside, text[np.minimum(starts[odd][:, None] + columns, len(text) - 1)], 0).astype(np.uint8)
    strange = ~(_ALLOWED[characters] | ~inside).all(axis=1)
    words = characters.view(f"S{width}").ravel()
    values = np.full(len(odd), np.nan)
    if not strange.any():
        try:
            values = words.astype(np.float64)
        except ValueError:
            values = np.array([_float_or_nan(word) for word in words.tolist()])
    bad = np.flatnonzero(strange | ~np.isfinite(values)) if strange.any() else np.flatnonzero(~np.isfinite(values))
    if len(bad):
        k = int(np.flatnonzero(strange)[0]) if strange.any() else int(bad[0])
        raise NumeralError(int(odd[k]), f"expected a finite number, got {_quoted(words[k])}")
    return np.asarray(values)


def _float_or_nan(word: bytes) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")


def _quoted(word: bytes) -> str:
    """The word in quotes, shortened."""
    return f"'{word[:40].decode('utf-8', 'replace')}{'...' if len(word) > 40 else ''}'"
