"""Lines and polygons in a framebuffer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.clipping.clipped_polygons import Polygons
from vectorplot.shading.raster.pixel_lines import line_pixels
from vectorplot.shading.raster.png import Bytes
from vectorplot.shading.raster.scan_lines import PolygonPixels, polygon_pixels, with_specks_grown
from vectorplot.textbook.screens.framebuffer import Colour, Framebuffer, value_of, values_of


def with_lines(frame: Framebuffer, start: ArrayLike, end: ArrayLike, colours: ArrayLike) -> Framebuffer:
    """The framebuffer with lines in one colour or in n; later lines lie over earlier ones.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    start, end : (n, 2 or more) array_like of float
        Column and row; lines are cut off at the raster.
    colours : (k,) or (n, k) array_like of int
        As the pages hold them; a number alone where k = 1.

    Returns
    -------
    Framebuffer
        With a new drawn page.

    Raises
    ------
    InputError
        For what is no colour of the pages, for points that are not finite or too far away, and for other numbers of
        ends than of starts.

    Notes
    -----
    Degenerate: a line without length is one pixel.

    Source: Glaeser, section 4.6 (Bresenham); erratum G4-09.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, with_lines
    >>> frame = with_lines(Framebuffer.of_numbers(6, 3), [(0, 0)], [(5, 2)], 1)
    >>> frame.pages[frame.drawn, ..., 0].tolist()
    [[1, 1, 0, 0, 0, 0], [0, 0, 1, 1, 0, 0], [0, 0, 0, 0, 1, 1]]
    """
    values = values_of(frame, colours, len(np.atleast_2d(np.asarray(start))))
    pages = frame.pages.copy()
    for part in line_pixels(start, end, frame.columns, frame.rows):
        pages[frame.drawn, part.row, part.column] = values[part.line]
    return replace(frame, pages=pages)


def with_rubber_bands(frame: Framebuffer, start: ArrayLike, end: ArrayLike, colour: Colour) -> Framebuffer:
    """The framebuffer with lines drawn by exclusive or: drawn again they vanish, and what was there is back.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    start, end : (n, 2 or more) array_like of float
        Column and row.
    colour : int or (int, int, int)
        As the pages hold it.

    Returns
    -------
    Framebuffer
        With a new drawn page.

    Raises
    ------
    InputError
        For what with_lines refuses.

    Notes
    -----
    Source: Glaeser, section 4.6.

    Examples
    --------
    >>> from vectorplot.textbook import Framebuffer, cleared, with_rubber_bands
    >>> before = cleared(Framebuffer.of_numbers(6, 3), 12)
    >>> band = with_rubber_bands(before, [(0, 0)], [(5, 2)], 255)
    >>> after = with_rubber_bands(band, [(0, 0)], [(5, 2)], 255)
    >>> bool((band.pages == before.pages).all()), bool((after.pages == before.pages).all())
    (False, True)
    """
    value = value_of(frame, colour)
    pages = frame.pages.copy()
    page = pages[frame.drawn].reshape(-1, len(value))
    for part in line_pixels(start, end, frame.columns, frame.rows):
        # Bands that cross change a pixel twice.
        odd = np.bincount(part.row * frame.columns + part.column, minlength=len(page)) % 2 == 1
        page[odd] ^= value
    return replace(frame, pages=pages)


def with_polygons(frame: Framebuffer, polygons: Polygons, colours: ArrayLike) -> Framebuffer:
    """The framebuffer with filled polygons in one colour or in n; later polygons lie over earlier ones.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    polygons : Polygons
        Column and row of their corners.
    colours : (k,) or (n, k) array_like of int
        As the pages hold them; a number alone where k = 1.

    Returns
    -------
    Framebuffer
        With a new drawn page.

    Raises
    ------
    InputError
        For what is no colour of the pages, and for corners that are not finite or too far away.

    Notes
    -----
    Polygons with a common edge leave no gap and share no pixel; one that lies in a single pixel is drawn as that pixel.

    Source: Glaeser, section 4.6, figure 7.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.geometry import Polygons
    >>> from vectorplot.textbook import Framebuffer, with_polygons
    >>> square = Polygons.of(np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0)]))
    >>> frame = with_polygons(Framebuffer.of_numbers(5, 3), square, 9)
    >>> frame.pages[frame.drawn, ..., 0].tolist()
    [[9, 9, 9, 0, 0], [9, 9, 9, 0, 0], [0, 0, 0, 0, 0]]
    """
    values = values_of(frame, colours, len(polygons))
    return _painted(frame, polygons, lambda found: values[found.polygon])


def with_smooth_polygons(frame: Framebuffer, polygons: Polygons) -> Framebuffer:
    """The framebuffer with polygons filled in shades that run linearly between their corners.

    Parameters
    ----------
    frame : Framebuffer
        As it is.
    polygons : Polygons
        Column, row, and as further columns the colour number, or red, green and blue; shades beyond 0 to 255 are cut
        off.

    Returns
    -------
    Framebuffer
        With a new drawn page.

    Raises
    ------
    InputError
        For corners with another number of shades than the pages have, and for those that are not finite or too far
        away.

    Notes
    -----
    Source: Glaeser, section 4.6 (Gouraud shading); erratum G4-12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.geometry import Polygons
    >>> from vectorplot.textbook import Framebuffer, with_smooth_polygons
    >>> square = Polygons.of(np.array([(0.0, 0.0, 0.0), (4.0, 0.0, 200.0), (4.0, 2.0, 200.0), (0.0, 2.0, 0.0)]))
    >>> frame = with_smooth_polygons(Framebuffer.of_numbers(5, 3), square)
    >>> frame.pages[frame.drawn, 0, :, 0].tolist()
    [0, 50, 100, 150, 0]
    """
    if polygons.points.shape[1] - 2 != frame.pages.shape[3]:
        raise InputError(f"the corners need {frame.pages.shape[3]} shades, not {polygons.points.shape[1] - 2}")
    return _painted(frame, polygons, lambda found: np.clip(np.floor(found.values + 0.5), 0, 255).astype(np.uint8))


def _painted(frame: Framebuffer, polygons: Polygons, shade: Callable[[PolygonPixels], Bytes]) -> Framebuffer:
    pages = frame.pages.copy()
    page = pages[frame.drawn].reshape(-1, frame.pages.shape[3])
    for found in polygon_pixels(with_specks_grown(polygons), frame.columns, frame.rows):
        page[found.pixel] = shade(found)
    return replace(frame, pages=pages)
