"""Twelve-bit numbers in bytes, eight of them in a block of twelve."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Ints
from vectorplot.errors import InputError

LARGEST_12_BIT = 4095
"""The largest number that twelve bits hold."""

BLOCK = 8
"""Numbers of one block, which are twelve bytes."""


def packed(numbers: ArrayLike) -> bytes:
    """Numbers of twelve bits as bytes, the first bit of each first.

    Parameters
    ----------
    numbers : (n,) array_like of int
        From 0 to 4095.

    Returns
    -------
    bytes
        Blocks of twelve bytes for eight numbers each, the last one filled up with zeros.

    Raises
    ------
    InputError
        For numbers out of range.

    Notes
    -----
    The order of the bytes does not depend on the machine. No numbers are no bytes.

    Source: Glaeser, section 10.1, figure 1; errata G10-01 to G10-03, G10-11; decision D-8.

    Examples
    --------
    >>> from vectorplot import animation
    >>> animation.packed([0xABC, 0xDEF, 0x123, 0x456, 0x789, 0xFED, 0xCBA, 0x987]).hex()
    'abcdef123456789fedcba987'
    """
    values = np.asarray(numbers, dtype=np.int64)
    if len(values) and not (values.min() >= 0 and values.max() <= LARGEST_12_BIT):
        raise InputError(f"a number of twelve bits is one from 0 to {LARGEST_12_BIT}")
    filled = np.zeros(-(-len(values) // BLOCK) * BLOCK, dtype=np.int64)
    filled[: len(values)] = values
    one, other = filled[::2], filled[1::2]
    triples = np.stack([one >> 4, (one & 15) << 4 | other >> 8, other & 255], axis=1)
    return triples.astype(np.uint8).tobytes()


def unpacked(content: bytes) -> Ints:
    """The numbers of twelve bits that bytes hold.

    Parameters
    ----------
    content : bytes
        Whole blocks of twelve bytes.

    Returns
    -------
    (n,) array of int
        Eight for each block, with the zeros that fill the last one.

    Raises
    ------
    InputError
        For a part of a block.

    Notes
    -----
    Source: Glaeser, section 10.1; erratum G10-02.

    Examples
    --------
    >>> from vectorplot import animation
    >>> animation.unpacked(bytes.fromhex("000fff0018000ffff00074d2")).tolist()
    [0, 4095, 1, 2048, 255, 4080, 7, 1234]
    """
    if len(content) % 12:
        raise InputError(f"{len(content)} bytes: expected blocks of 12")
    triples = np.frombuffer(content, dtype=np.uint8).reshape(-1, 3).astype(np.intp)
    first, middle, last = triples.T
    return np.stack([first << 4 | middle >> 4, (middle & 15) << 8 | last], axis=1).ravel()
