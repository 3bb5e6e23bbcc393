"""Pictures of pixels: the value Image, PNG files, and supersampling against steps along edges."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import power

if TYPE_CHECKING:
    from vectorplot.save import Destination

# Pixels as a PNG file.

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
    """The picture as a PNG file: row 0 on top, colours in sRGB.

    pixels: (rows, columns, 3) red, green and blue; colours: (n, 3) up to 256 colours that the pixels are numbers of.
    Source: W3C, Portable Network Graphics, sections 5 and 11.
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


# A picture of pixels: what render gives.


@dataclass(frozen=True, eq=False)
class Image:
    """A picture of pixels.

    Parameters
    ----------
    pixels : (rows, columns, 3) array of uint8
        Red, green and blue, row 0 on top.
    title : str
        What it shows.
    dpi : float
        The dots per inch that its file says, those of drawings saved as pixels unless told otherwise.

    Raises
    ------
    InputError
        For other shapes or types.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> vp.Image(np.zeros((40, 60, 3), dtype=np.uint8), "Night")
    <Image 'Night': 60 x 40 pixels>
    """

    pixels: Bytes
    title: str = ""
    dpi: float = DPI

    def __post_init__(self) -> None:
        if self.pixels.dtype != "uint8" or self.pixels.ndim != 3 or self.pixels.shape[2] != 3 or not self.pixels.size:
            raise InputError(f"an image needs bytes of shape (rows, columns, 3), not {self.pixels.shape}")

    def __repr__(self) -> str:
        return f"<Image {self.title!r}: {self.columns} x {self.rows} pixels>"

    @property
    def columns(self) -> int:
        """How many columns of pixels there are."""
        return int(self.pixels.shape[1])

    @property
    def rows(self) -> int:
        """How many rows of pixels there are."""
        return int(self.pixels.shape[0])

    def save(self, path: Destination, *, format: str | None = None) -> None:
        """Write the picture as PNG, as `vp.save` does.

        Parameters
        ----------
        path : str, path or file object
            The file, whose name ends in .png, or an open one that takes bytes.
        format : str, optional
            ``png``; needed for an open file.

        Raises
        ------
        InputError
            For another suffix or format.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import os, tempfile
        >>> import numpy as np
        >>> import vectorplot as vp
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     vp.Image(np.zeros((4, 6, 3), dtype=np.uint8)).save(os.path.join(folder, "night.png"))
        ...     os.listdir(folder)
        ['night.png']
        """
        from vectorplot.save import save

        save(self, path, format=format)

    def png(self) -> bytes:
        """The picture as a PNG file. The same picture gives the same bytes."""
        return png_bytes(self.pixels, dpi=self.dpi)

    def _repr_png_(self) -> bytes:
        return self.png()


# Pictures made finer than they are shown, against steps along edges.
#
# Colours are numbers of sRGB, which are not proportional to light: means of light are taken where pixels are to look,
# from afar, like the finer ones.

LEVELS = np.arange(256) / 255.0

LIGHT = np.where(LEVELS <= 0.04045, LEVELS / 12.92, power((LEVELS + 0.055) / 1.055, 2.4))
"""(256,) how much light a component of a pixel stands for, 0 to 1. Source: IEC 61966-2-1."""


def averaged(picture: ArrayLike, samples: int) -> Floats:
    """(rows, columns, ...) the means of squares of samples x samples pixels of a finer picture.

    The finer one is made with raster_system(camera, samples * columns, samples * rows).
    Errors: InputError where the sides are no multiples of samples.
    """
    return _means(np.asarray(picture), samples, None)


def _means(p: NDArray[Any], samples: int, meaning: Floats | None) -> Floats:
    """As averaged, of what the numbers of the picture mean, if they do not stand for themselves."""
    if samples < 1 or p.ndim < 2 or p.shape[0] % samples or p.shape[1] % samples:
        raise InputError(f"a picture of shape {p.shape} has no squares of {samples} x {samples} pixels")
    rows, columns = p.shape[0] // samples, p.shape[1] // samples
    blocks = p.reshape(rows, samples, columns, samples, *p.shape[2:])
    total = np.zeros((rows, columns, *p.shape[2:]))
    for down in range(samples):
        for along in range(samples):
            part = blocks[:, down, :, along]
            total += part if meaning is None else np.take(meaning, part)
    return np.asarray(total / float(samples * samples))


def averaged_light(picture: Bytes, samples: int) -> Bytes:
    """(rows, columns, 3) uint8 the pixels of the mean light of squares of samples x samples pixels of a finer picture.

    Pixels of one colour keep it. Errors: see averaged.
    """
    if samples == 1:
        return picture
    half_way = (LIGHT[1:] + LIGHT[:-1]) / 2.0
    return np.searchsorted(half_way, _means(picture, samples, LIGHT)).astype(np.uint8)
