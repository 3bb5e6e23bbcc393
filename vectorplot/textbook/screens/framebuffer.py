"""A framebuffer: two pages of pixels, in colour numbers or in red, green and blue.

Pixel centres are the integers, row 0 is on top. One page is shown while the other is drawn.
Source: Glaeser, sections 4.2 and 4.6.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.shading.raster.pixel_lines import whole_pixels
from vectorplot.shading.raster.png import Bytes, png_bytes
from vectorplot.shading.raster.screen import raster_size

Colour = int | tuple[int, int, int]
"""A colour number, or for a framebuffer without a colour table red, green and blue, 0 to 255."""

GRAYS = np.repeat(np.arange(256, dtype=np.uint8)[:, None], 3, axis=1)
"""The colour table until colours are created: number n is a gray of brightness n."""


@dataclass(frozen=True, eq=False)
class Framebuffer:
    """Two pages of pixels, one that is seen and one that is drawn on.

    Parameters
    ----------
    pages : (2, rows, columns, k) array of uint8
        k = 1 for numbers of colours, k = 3 for red, green and blue.
    colours : (256, 3) array of uint8, optional
        What the numbers mean; None where pages are red, green and blue.
    shown : int
        The page that is seen; the other one is drawn on.

    Notes
    -----
    Source: Glaeser, section 4.6.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, swapped_buffers, with_pixels
    >>> frame = with_pixels(Framebuffer.of_rgb(4, 2), [(1, 0)], (255, 0, 0))
    >>> frame.picture()[0, 1].tolist(), swapped_buffers(frame).picture()[0, 1].tolist()
    ([0, 0, 0], [255, 0, 0])
    """

    pages: Bytes
    colours: Bytes | None
    shown: int = 0

    @classmethod
    def of_numbers(cls, columns: int, rows: int) -> Framebuffer:
        """Pages of colour numbers, all 0.

        Parameters
        ----------
        columns, rows : int
            The size in pixels.

        Returns
        -------
        Framebuffer
            Its colours are 256 grays.

        Raises
        ------
        InputError
            For a raster too large or without pixels.
        """
        columns, rows = raster_size(columns, rows)
        return cls(np.zeros((2, rows, columns, 1), dtype=np.uint8), GRAYS)

    @classmethod
    def of_rgb(cls, columns: int, rows: int) -> Framebuffer:
        """Pages of red, green and blue, all black.

        Parameters
        ----------
        columns, rows : int
            The size in pixels.

        Returns
        -------
        Framebuffer
            Without a colour table.

        Raises
        ------
        InputError
            For a raster too large or without pixels.
        """
        columns, rows = raster_size(columns, rows)
        return cls(np.zeros((2, rows, columns, 3), dtype=np.uint8), None)

    @property
    def rows(self) -> int:
        """How many rows of pixels there are."""
        return int(self.pages.shape[1])

    @property
    def columns(self) -> int:
        """How many columns of pixels there are."""
        return int(self.pages.shape[2])

    @property
    def drawn(self) -> int:
        """The page that is drawn on."""
        return 1 - self.shown

    def picture(self, page: int | None = None) -> Bytes:
        """Red, green and blue of a page.

        Parameters
        ----------
        page : int, optional
            0 or 1; the page that is shown where None.

        Returns
        -------
        (rows, columns, 3) array of uint8
            Row 0 on top.
        """
        pixels = self.pages[self.shown if page is None else page]
        return np.asarray(pixels if self.colours is None else self.colours[pixels[..., 0]])

    def png(self) -> bytes:
        """The page that is shown as a PNG file."""
        pixels = self.pages[self.shown]
        return png_bytes(pixels) if self.colours is None else png_bytes(pixels[..., 0], self.colours)


def with_colour(frame: Framebuffer, number: int, red: int, green: int, blue: int) -> Framebuffer:
    """The framebuffer with another colour in its table, which all pixels of that number take at once.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    number : int
        0 to 255.
    red, green, blue : int
        0 to 255.

    Returns
    -------
    Framebuffer
        With the same pages.

    Raises
    ------
    InputError
        For numbers and components outside 0 to 255, and without a colour table.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, with_colour
    >>> with_colour(Framebuffer.of_numbers(4, 2), 0, 255, 0, 0).picture()[0, 0].tolist()
    [255, 0, 0]
    """
    if frame.colours is None or not 0 <= number <= 255 or not all(0 <= c <= 255 for c in (red, green, blue)):
        raise InputError(f"colour {number}: {red}, {green}, {blue} does not fit into the colour table")
    colours = frame.colours.copy()
    colours[number] = red, green, blue
    return replace(frame, colours=colours)


def swapped_buffers(frame: Framebuffer) -> Framebuffer:
    """The framebuffer with the drawn page shown, and the other one to be drawn on.

    Parameters
    ----------
    frame : Framebuffer
        As it is.

    Returns
    -------
    Framebuffer
        With the same pages.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, cleared, swapped_buffers
    >>> frame = cleared(Framebuffer.of_numbers(4, 2), 9)
    >>> frame.picture().max().item(), swapped_buffers(frame).picture().min().item()
    (0, 9)
    """
    return replace(frame, shown=frame.drawn)


def cleared(frame: Framebuffer, colour: Colour) -> Framebuffer:
    """The framebuffer with the drawn page in one colour.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    colour : int or (int, int, int)
        A number, or red, green and blue, as the pages hold them; 0 to 255.

    Returns
    -------
    Framebuffer
        The page that is shown is as it was.

    Raises
    ------
    InputError
        For what is no colour of the pages.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, cleared, pixel_colours
    >>> pixel_colours(cleared(Framebuffer.of_rgb(4, 2), (0, 0, 255)), [(3, 1)]).tolist()
    [[0, 0, 255]]
    """
    pages = frame.pages.copy()
    pages[frame.drawn] = value_of(frame, colour)
    return replace(frame, pages=pages)


def pixel_colours(frame: Framebuffer, points: ArrayLike) -> Bytes:
    """What stands on the drawn page at some points.

    Parameters
    ----------
    frame : Framebuffer
        What is asked.
    points : (n, 2) array_like of float
        Column and row; the nearest pixel counts.

    Returns
    -------
    (n, k) array of uint8
        Numbers, or red, green and blue.

    Raises
    ------
    InputError
        For points outside the raster, or not finite.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, pixel_colours, with_pixels
    >>> frame = with_pixels(Framebuffer.of_numbers(4, 2), [(0, 0), (3, 1)], [5, 6])
    >>> pixel_colours(frame, [(0, 0), (2.7, 1.2)]).tolist()
    [[5], [6]]
    """
    column, row = whole_pixels(points).T
    if not ((column >= 0) & (column < frame.columns) & (row >= 0) & (row < frame.rows)).all():
        raise InputError(f"a pixel lies outside the raster of {frame.columns} x {frame.rows}")
    return np.asarray(frame.pages[frame.drawn, row, column])


def with_pixels(frame: Framebuffer, points: ArrayLike, colours: ArrayLike) -> Framebuffer:
    """The framebuffer with pixels at points in one colour or in n.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    points : (n, 2) array_like of float
        Column and row; those outside the raster are left out.
    colours : (k,) or (n, k) array_like of int
        As the pages hold them; a number alone where k = 1.

    Returns
    -------
    Framebuffer
        With a new drawn page.

    Raises
    ------
    InputError
        For what is no colour of the pages, for points that are not finite or too far away.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, with_pixels
    >>> frame = with_pixels(Framebuffer.of_numbers(4, 2), [(0, 0), (3, 1), (9, 9)], 7)
    >>> frame.pages[frame.drawn, ..., 0].tolist()
    [[7, 0, 0, 0], [0, 0, 0, 7]]
    """
    column, row = whole_pixels(points).T
    inside = np.flatnonzero((column >= 0) & (column < frame.columns) & (row >= 0) & (row < frame.rows))
    pages = frame.pages.copy()
    values = values_of(frame, colours, len(column))
    pages[frame.drawn, row[inside], column[inside]] = values[inside]
    return replace(frame, pages=pages)


def value_of(frame: Framebuffer, colour: Colour) -> Bytes:
    """(k,) a colour as the pages hold it."""
    return np.asarray(values_of(frame, colour, 1)[0])


def values_of(frame: Framebuffer, colours: ArrayLike, count: int) -> Bytes:
    """(count, k) one colour, or count of them, as the pages hold them."""
    c = np.asarray(colours)
    k = frame.pages.shape[3]
    if k == 1:
        c = c[..., None] if c.ndim == 0 or c.shape[-1] != 1 or c.ndim == 1 else c
    if c.dtype.kind not in "iu" or c.shape[-1:] != (k,) or c.ndim > 2 or (c.ndim == 2 and len(c) != count):
        raise InputError(f"{count} colours of {k} whole numbers are needed")
    if c.size and not (c.min() >= 0 and c.max() <= 255):
        raise InputError("colours are numbers from 0 to 255")
    return np.broadcast_to(c.astype(np.uint8), (count, k))
