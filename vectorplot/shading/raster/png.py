"""Pixels as a PNG file."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.errors import InputError

COMPRESSION = 6

DPI = 150.0
"""The dots per inch of pictures for which nobody says another number."""

SIGNATURE = b"\x89PNG\r\n\x1a\n"

HEADER_END = len(SIGNATURE) + 4 + 4 + 13 + 4
"""Behind the first chunk: its length, name, data and checksum."""

PERCEPTUAL = 0
"""How a device should bring colours into its own range."""

METRES_PER_INCH = 0.0254
"""An inch, in which dots are counted, in metres, in which PNG files count them."""

Bytes = NDArray[np.uint8]


def png_bytes(pixels: ArrayLike, colours: ArrayLike | None = None, dpi: float | None = None) -> bytes:
    r"""The picture as a PNG file: row 0 on top, colours in sRGB.

    Parameters
    ----------
    pixels : (rows, columns, 3) or (rows, columns) array_like of uint8
        Red, green and blue; or gray; or, with colours, indices into them.
    colours : (n, 3) array_like of uint8, optional
        Up to 256 colours that the pixels are numbers of.
    dpi : float, optional
        The dots per inch that the file says, None for none.

    Returns
    -------
    bytes
        The same for the same pixels.

    Raises
    ------
    InputError
        For other shapes or types, for an empty picture, for an index without a colour.

    Notes
    -----
    Source: W3C, Portable Network Graphics, sections 5 and 11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import shading
    >>> content = shading.png_bytes(np.zeros((40, 60), dtype=np.uint8), dpi=96)
    >>> content[:4], int.from_bytes(content[16:20], "big"), int.from_bytes(content[20:24], "big")
    (b'\x89PNG', 60, 40)
    """
    p = np.ascontiguousarray(pixels)
    if p.dtype != np.uint8 or p.ndim not in (2, 3) or not p.size or (p.ndim == 3 and p.shape[2] != 3):
        raise InputError(f"a picture must be bytes of shape (rows, columns) or (rows, columns, 3), not {p.shape}")
    table = b""
    if colours is not None:
        c = np.ascontiguousarray(colours, dtype=np.uint8)
        if p.ndim != 2 or c.ndim != 2 or c.shape[1] != 3 or not 1 <= len(c) <= 256 or p.max() >= len(c):
            raise InputError("a picture of colour numbers needs 1 to 256 colours, one for every number in it")
        table = _chunk(b"PLTE", c.tobytes())
    kind = 3 if table else 2 if p.ndim == 3 else 0
    rows, columns = p.shape[:2]
    # Every row starts with the number of its filter: none.
    data = np.concatenate([np.zeros((rows, 1), dtype=np.uint8), p.reshape(rows, -1)], axis=1)
    header = _chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, kind, 0, 0, 0)) + meaning(dpi)
    body = _chunk(b"IDAT", zlib.compress(data.tobytes(), COMPRESSION))
    return SIGNATURE + header + table + body + _chunk(b"IEND", b"")


def meaning(dpi: float | None) -> bytes:
    """The chunks that come right after a picture's header: that its colours are sRGB, and its dots per inch, if any.

    Source: W3C, Portable Network Graphics, sections 11.3.3.5 and 11.3.5.3.
    """
    colours = _chunk(b"sRGB", bytes([PERCEPTUAL]))
    if dpi is None:
        return colours
    per_metre = min(max(round(dpi / METRES_PER_INCH), 1), 0x7FFFFFFF)
    return colours + _chunk(b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1))


def with_meaning(png: bytes, dpi: float) -> bytes:
    """A PNG file of another maker that says what its colours and its size are."""
    return png[:HEADER_END] + meaning(dpi) + png[HEADER_END:]


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
