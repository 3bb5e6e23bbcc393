"""A framebuffer with a depth buffer: two pages of pixels, lines and polygons in them, and hidden lines by painting.

Pixel centres are the integers, row 0 is on top. One page is shown while the other is drawn.

Source: Glaeser, sections 4.2 and 4.6.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping import Polygons
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.view import View
from vectorplot.shading.depth_buffers import DepthBuffer
from vectorplot.shading.image import Bytes, png_bytes
from vectorplot.shading.pixel_coverage import (
    SUBPIXELS,
    PolygonPixels,
    line_pixels,
    polygon_pixels,
    whole_pixels,
    with_specks_grown,
)
from vectorplot.shading.screen import raster_size
from vectorplot.tolerances import PARALLEL_SINE, ZERO_OF_EXTENT
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points

# A framebuffer: two pages of pixels, in colour numbers or in red, green and blue.

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
    >>> from vectorplot.textbook import Framebuffer, swapped_buffers
    >>> from vectorplot.textbook.framebuffer import with_pixels
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

        columns, rows: the size in pixels; result: its colours are 256 grays.
        Errors: for a raster too large or without pixels.
        """
        columns, rows = raster_size(columns, rows)
        return cls(np.zeros((2, rows, columns, 1), dtype=np.uint8), GRAYS)

    @classmethod
    def of_rgb(cls, columns: int, rows: int) -> Framebuffer:
        """Pages of red, green and blue, all black.

        columns, rows: the size in pixels; result: without a colour table.
        Errors: for a raster too large or without pixels.
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

        page: 0 or 1; the page that is shown where None; result: (rows,columns,3) row 0 on top.
        """
        pixels = self.pages[self.shown if page is None else page]
        return np.asarray(pixels if self.colours is None else self.colours[pixels[..., 0]])

    def png(self) -> bytes:
        """The page that is shown as a PNG file."""
        pixels = self.pages[self.shown]
        return png_bytes(pixels) if self.colours is None else png_bytes(pixels[..., 0], self.colours)


def with_colour(frame: Framebuffer, number: int, red: int, green: int, blue: int) -> Framebuffer:
    """The framebuffer with another colour in its table, which all pixels of that number take at once.

    number: 0 to 255; red, green, blue: 0 to 255; result: with the same pages.
    Errors: for numbers and components outside 0 to 255, and without a colour table.
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
    >>> from vectorplot.textbook import Framebuffer, swapped_buffers
    >>> from vectorplot.textbook.framebuffer import cleared
    >>> frame = cleared(Framebuffer.of_numbers(4, 2), 9)
    >>> frame.picture().max().item(), swapped_buffers(frame).picture().min().item()
    (0, 9)
    """
    return replace(frame, shown=frame.drawn)


def cleared(frame: Framebuffer, colour: Colour) -> Framebuffer:
    """The framebuffer with the drawn page in one colour.

    colour: a number, or red, green and blue, as the pages hold them; 0 to 255; result: the page that is shown is as it
    was.
    Errors: for what is no colour of the pages.
    """
    pages = frame.pages.copy()
    pages[frame.drawn] = value_of(frame, colour)
    return replace(frame, pages=pages)


def pixel_colours(frame: Framebuffer, points: ArrayLike) -> Bytes:
    """What stands on the drawn page at some points.

    points (n,2): column and row; the nearest pixel counts; result: (n,k) numbers, or red, green and blue.
    Errors: for points outside the raster, or not finite.
    """
    column, row = whole_pixels(points).T
    if not ((column >= 0) & (column < frame.columns) & (row >= 0) & (row < frame.rows)).all():
        raise InputError(f"a pixel lies outside the raster of {frame.columns} x {frame.rows}")
    return np.asarray(frame.pages[frame.drawn, row, column])


def with_pixels(frame: Framebuffer, points: ArrayLike, colours: ArrayLike) -> Framebuffer:
    """The framebuffer with pixels at points in one colour or in n.

    points (n,2): column and row; those outside the raster are left out; colours (k,) or (n,k): as the pages hold them;
    a number alone where k = 1; result: with a new drawn page.
    Errors: for what is no colour of the pages, for points that are not finite or too far away.
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


# Lines and polygons in a framebuffer.


def with_lines(frame: Framebuffer, start: ArrayLike, end: ArrayLike, colours: ArrayLike) -> Framebuffer:
    """The framebuffer with lines start to end (n,2 or more: column, row) in one colour (k,) or in n (n,k), later over
    earlier, cut off at the raster. Edge cases: a line without length is one pixel.
    Source: Glaeser, section 4.6 (Bresenham); erratum G4-09. Errors: InputError for other colours, points not finite or
    too far, and different numbers of ends.
    """
    values = values_of(frame, colours, len(np.atleast_2d(np.asarray(start))))
    pages = frame.pages.copy()
    for part in line_pixels(start, end, frame.columns, frame.rows):
        pages[frame.drawn, part.row, part.column] = values[part.line]
    return replace(frame, pages=pages)


def with_rubber_bands(frame: Framebuffer, start: ArrayLike, end: ArrayLike, colour: Colour) -> Framebuffer:
    """The framebuffer with lines drawn by exclusive or: drawn again they vanish, and what was there is back.

    start, end: (n, 2 or more) column and row.
    Source: Glaeser, section 4.6.
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


# What a depth buffer answers: is a point visible, which pixels of a line are, which plane a polygon lies in.
#
# Source: Glaeser, section 7.3; errata G7-05, G7-07.

STEPS = 2.0
"""A point is not hidden by what is closer by so few steps of the depth code."""


def points_visible(buffer: DepthBuffer, points: ArrayLike) -> Bools:
    """(n,) which points (n,3: column, row, depth after T2) nothing in a depth buffer hides; none outside the raster.
    Compared with the plane of the triangle in the pixel, within what snapping moves that plane and a step of the
    code.
    Source: Glaeser, section 7.3. Errors: InputError for points not finite.
    """
    p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if not np.isfinite(p).all():
        raise InputError("a point has a coordinate that is not a finite number")
    rows, columns = buffer.code.shape
    cell = np.floor(p[:, :2] + 0.5)
    inside = ((cell >= (0, buffer.top)) & (cell < (columns, buffer.top + rows))).all(axis=1)
    visible = np.zeros(len(p), dtype=np.bool_)
    here = np.flatnonzero(inside)
    column, row = cell[here].astype(np.intp).T
    triangle = buffer.triangle[row - buffer.top, column]
    visible[here[triangle < 0]] = True
    here, triangle = here[triangle >= 0], triangle[triangle >= 0]
    corners = buffer.triangles.points[buffer.triangles.corners[triangle]]
    depth, slope = _plane_depth(corners, p[here, :2])
    rounding = ZERO_OF_EXTENT * (buffer.depth_code.maximum - buffer.depth_code.minimum)
    slack = slope / SUBPIXELS + STEPS * buffer.depth_code.step + rounding
    visible[here] = p[here, 2] >= depth - slack
    return visible


def _plane_depth(corners: Floats, at: Floats) -> tuple[Floats, Floats]:
    """(n,) depths of the planes of triangles (n, 3, 3) at points (n, 2), and how much they change from one pixel to the
    next; never beyond the depths of the corners."""
    origin = corners[:, 0]
    u, v = corners[:, 1] - origin, corners[:, 2] - origin
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    safe = np.where(area != 0.0, area, 1.0)
    along = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / safe
    down = (v[:, 2] * u[:, 0] - u[:, 2] * v[:, 0]) / safe
    depth = origin[:, 2] + along * (at[:, 0] - origin[:, 0]) + down * (at[:, 1] - origin[:, 1])
    low, high = corners[:, :, 2].min(axis=1), corners[:, :, 2].max(axis=1)
    depth = np.clip(np.where(area != 0.0, depth, low), low, high)
    return depth, np.minimum(np.abs(along) + np.abs(down), SUBPIXELS * (high - low))


def visible_line_pixels(buffer: DepthBuffer, start: ArrayLike, end: ArrayLike) -> tuple[Ints, Ints, Ints]:
    """Columns, rows and lines (p,) of the visible pixels of lines start to end (n,3: column, row, depth after T2),
    clipped at the near plane before; depths run linearly between the ends, as T2 keeps lines straight.
    Source: Glaeser, section 7.3 (hidden lines on the screen); erratum G7-07. Errors: InputError for points not finite
    or too far.
    """
    p, q = (np.asarray(x, dtype=np.float64).reshape(-1, 3) for x in (start, end))
    rows, columns = buffer.code.shape
    none = np.zeros(0, dtype=np.intp)
    found = [(none, none, none)]
    for part in line_pixels(p - (0, buffer.top, 0), q - (0, buffer.top, 0), columns, rows):
        at = p[part.line] + part.share[:, None] * (q - p)[part.line]
        # The place on the line may lie in the next pixel, by rounding of its ends: the pixel that is set is asked.
        low = np.stack([part.column, part.row + buffer.top], axis=1) - 0.5
        at[:, :2] = np.clip(at[:, :2], low, np.nextafter(low + 1.0, low))
        seen = points_visible(buffer, at)
        found.append((part.column[seen], part.row[seen] + buffer.top, part.line[seen]))
    columns_seen, rows_seen, lines = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return columns_seen, rows_seen, lines


def depth_planes(polygons: Polygons) -> Floats:
    """The planes a, b, c of polygons in the image: depth = a column + b row + c.

    polygons: columns of their points: column, row and depth; n polygons; result: (n,3) NaN for polygons all of whose
    corners lie on a line, seen from the eye: those cover no pixel.
    They go through the first three corners that do not lie on a line.
    Source: Glaeser, section 7.3; erratum G7-05.
    """
    points, offsets = polygons.points, polygons.offsets
    planes = np.full((len(polygons), 3), np.nan)
    filled = np.flatnonzero(np.diff(offsets))
    if not len(filled):
        return planes
    owner = ragged.owner(np.diff(offsets)[filled])
    starts = offsets[:-1][filled]
    arm = points - points[starts][owner]
    second = _first(np.abs(arm[:, :2]).max(axis=1) > 0.0, starts)
    u = arm[np.minimum(second, len(points) - 1)][owner]
    turn = u[:, 0] * arm[:, 1] - u[:, 1] * arm[:, 0]
    sizes = np.hypot(u[:, 0], u[:, 1]) * np.hypot(arm[:, 0], arm[:, 1])
    third = _first(np.abs(turn) > PARALLEL_SINE * sizes, starts)
    known = np.flatnonzero(third < len(points))
    u, v, area = arm[second[known]], arm[third[known]], turn[third[known]]
    along = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / area
    down = (v[:, 2] * u[:, 0] - u[:, 2] * v[:, 0]) / area
    origin = points[starts[known]]
    constant = origin[:, 2] - along * origin[:, 0] - down * origin[:, 1]
    planes[filled[known]] = np.stack([along, down, constant], axis=1)
    return planes


def _first(wanted: Bools, starts: Ints) -> Ints:
    """(n,) the first wanted position in each run that begins at starts; the number of positions where there is none."""
    position = np.where(wanted, np.arange(len(wanted)), len(wanted))
    return np.asarray(np.minimum.reduceat(position, starts), dtype=np.intp)


# Hidden lines by painting: every face erases what is behind it, and then its edges are drawn.


@dataclass(frozen=True, eq=False)
class Erased:
    """A sequence of fills in the colour of the paper and of edges, which leaves the lines that one sees.

    start, end: (3, e) the edges in the image, see ImageFaces; first: (n+1,) after the polygon k of the painted faces
    is filled, the edges first[k] to first[k+1] are drawn.
    """

    start: Floats
    end: Floats
    first: Ints

    def __len__(self) -> int:
        return int(self.start.shape[1])


def erasing_edges(view: View, painted: ImageFaces, drawn: Bools | None = None) -> Erased:
    """The edges to be drawn after each face has been erased, in the painter's order.

    Parameters
    ----------
    view : View
        What is drawn.
    painted : ImageFaces
        The polygons, back to front.
    drawn : (c,) array of bool, optional
        Which sides of the faces of the view, from each corner to the next, are drawn at all; all but the diagonals of
        cut faces where None.

    Returns
    -------
    Erased
        Sides along which the painter cut a face are no edges.

    Notes
    -----
    Source: Glaeser, section 7.1, figure 1.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import erasing_edges
    >>> from vectorplot.visibility import painters_order
    >>> view = look(vp.Scene((vp.Item("cube", box((1, 1, 1))),)), vp.Camera((5, 4, 3)))
    >>> faces = painters_order(view).faces
    >>> len(faces), len(erasing_edges(view, faces)), len(erasing_edges(view, faces, np.zeros(24, dtype=bool)))
    (3, 12, 0)
    """
    drawn = ~view.inner if drawn is None else drawn
    edge = np.flatnonzero(drawn)
    face = ragged.owner(view.face_sizes)[edge]
    start, end, known = _images(view, view.corners[edge], view.corners[view.after(edge)])
    edge_of = np.searchsorted(face[known], np.arange(view.face_count + 1))
    start, end = start[:, known], end[:, known]
    owner = ragged.owner(np.diff(painted.offsets))
    side_end = next_positions(painted.offsets, np.arange(len(owner))) if len(owner) else owner
    source = painted.source[owner]
    counts = np.diff(edge_of)[source]
    side = ragged.owner(counts)
    which = edge_of[:-1][source[side]] + np.arange(len(side)) - np.repeat(ragged.starts(counts), counts)
    on = _on(painted.points[:2, side], start[:2, which], end[:2, which], view.tolerance)
    on &= _on(painted.points[:2, side_end[side]], start[:2, which], end[:2, which], view.tolerance)
    kept = np.unique(side[on])
    counts = np.bincount(owner[kept], minlength=len(painted))
    return Erased(painted.points[:, kept], painted.points[:, side_end[kept]], ragged.offsets(counts))


def _images(view: View, first: Ints, second: Ints) -> tuple[Floats, Floats, Ints]:
    """The images of edges between vertices, cut off at the near plane, and which edges have one."""
    start, end = view.points[:, first], view.points[:, second]
    if view.eye is None:
        return image_points(view, start), image_points(view, end), np.arange(len(first))
    near, far = view.depth[first] - view.near, view.depth[second] - view.near
    gap = np.where((near < 0.0) != (far < 0.0), near - far, 1.0)
    crossing = start + (near / gap) * (end - start)
    begin = np.where(near < 0.0, crossing, start)
    finish = np.where(far < 0.0, crossing, end)
    known = np.flatnonzero((near >= 0.0) | (far >= 0.0))
    image = [np.zeros((3, len(first))), np.zeros((3, len(first)))]
    image[0][:, known], image[1][:, known] = image_points(view, begin[:, known]), image_points(view, finish[:, known])
    return image[0], image[1], known


def _on(points: Floats, start: Floats, end: Floats, tolerance: float) -> Bools:
    """(n,) which points (2,n) lie on segments; near means within a few tolerances."""
    along = end - start
    length = np.sqrt((along * along).sum(axis=0))
    unit = along / np.where(length > 0.0, length, 1.0)
    arm = points - start
    off = np.abs(unit[0] * arm[1] - unit[1] * arm[0])
    at = (unit * arm).sum(axis=0)
    # Places of cuts are rounded in the image, where edges may be long.
    limit = 4.0 * tolerance * (1.0 + length)
    return np.asarray((off <= limit) & (at >= -limit) & (at <= length + limit), dtype=np.bool_)


def interleaved(painted: ImageFaces, erased: Erased) -> list[tuple[Floats, Floats, Floats]]:
    """The sequence for a format that is written one mark after the other.

    Parameters
    ----------
    painted : ImageFaces
        The polygons, back to front.
    erased : Erased
        See erasing_edges.

    Returns
    -------
    list of ((3, k) array, (3, e) array, (3, e) array)
        The corners of a polygon, then the starts and the ends of the edges to be drawn on it.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import erasing_edges, interleaved
    >>> from vectorplot.visibility import painters_order
    >>> view = look(vp.Scene((vp.Item("cube", box((1, 1, 1))),)), vp.Camera((5, 4, 3)))
    >>> faces = painters_order(view).faces
    >>> marks = interleaved(faces, erasing_edges(view, faces))
    >>> [(corners.shape[1], starts.shape[1]) for corners, starts, ends in marks]
    [(4, 4), (4, 4), (4, 4)]
    """
    result = []
    for number in range(len(painted)):
        position, _ = ragged.take(painted.offsets, np.array([number]))
        edges = slice(int(erased.first[number]), int(erased.first[number + 1]))
        result.append((painted.points[:, position], erased.start[:, edges], erased.end[:, edges]))
    return result
