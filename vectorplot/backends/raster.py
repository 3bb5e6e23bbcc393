"""Drawings in a framebuffer: pixels without another library, and over pictures that are there already.

Nothing is smoothed: a pixel is in a stroke or a polygon, or it is not. Make the picture larger and average it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page import LARGEST_PAGE_MM
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Paths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping import Polygons
from vectorplot.geometry.vectors import cross
from vectorplot.scene.page import MM_PER_INCH
from vectorplot.shading.image import DPI, Bytes, averaged
from vectorplot.shading.image import png_bytes as pixels_as_png
from vectorplot.shading.pixel_coverage import (
    GUARD_BAND,
    PixelRuns,
    PolygonPixels,
    crossed_pixels,
    line_pixels,
    polygon_pixels,
    with_specks_grown,
)
from vectorplot.shading.screen import raster_size

JOIN_SIDES = 12
"""Ends and joins of strokes are polygons of so many sides."""

HAIRLINE = 1.5
"""Strokes thinner than so many pixels are lines of single pixels."""


def png_bytes(drawing: Drawing, dpi: float = DPI, samples: int = 3) -> bytes:
    """The drawing as a PNG picture on white, averaged from samples x samples pixels each.

    Errors: InputError for a resolution that gives too many pixels.
    """
    if not 0.0 < dpi < np.inf or not 1 <= samples <= 16:
        raise InputError(f"a picture of {dpi:g} dpi with {samples} samples is out of range")
    columns, rows = (max(1, round(side * dpi / MM_PER_INCH)) for side in (drawing.width_mm, drawing.height_mm))
    columns, rows = raster_size(columns * samples, rows * samples)
    blank = np.full((rows, columns, 3), 255, dtype=np.uint8)
    fine = painted(blank, drawing)
    return pixels_as_png(np.rint(averaged(fine, samples)).astype(np.uint8), dpi=dpi)


def painted(picture: Bytes, drawing: Drawing) -> Bytes:
    """The picture (rows, columns, 3) with a drawing over it, its page stretched to the picture's borders.

    Strokes have the width of their pens, at least a pixel; smooth ones are drawn as their polylines.
    Errors: InputError for a page that is no size or points that are not finite.
    """
    if not (0.0 < drawing.width_mm <= LARGEST_PAGE_MM and 0.0 < drawing.height_mm <= LARGEST_PAGE_MM):
        raise InputError(f"a page of {drawing.width_mm:g} x {drawing.height_mm:g} mm")
    rows, columns = picture.shape[:2]
    result = picture.copy()
    flat = result.reshape(-1, 3)
    scale = np.array([columns / drawing.width_mm, -rows / drawing.height_mm])
    origin = np.array([-0.5, rows - 0.5])
    for layer in drawing.layers:
        colour = np.array([int(layer.pen.colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.uint8)
        width = layer.pen.width_mm * float(np.abs(scale).mean())
        for mark in layer.marks:
            if isinstance(mark, Fills):
                _fill(
                    flat, mark, _pixels(mark.points, scale, origin), partial(polygon_pixels, columns=columns, rows=rows)
                )
                continue
            if isinstance(mark, Texts):
                # There is no font here.
                continue
            paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
            for pixel in _stroke_pixels(paths, _pixels(paths.points, scale, origin), width, columns, rows):
                flat[pixel] = colour
    return result


def smoothly_painted(picture: Bytes, drawing: Drawing, samples: int) -> Bytes:
    """As painted, for drawings of polygons: each pixel is the mean of samples x samples places in it.

    Source: the places are looked at where sides of polygons cross a pixel; elsewhere the middle is the mean.
    """
    rows, columns = picture.shape[:2]
    scale = np.array([columns / drawing.width_mm, -rows / drawing.height_mm])
    result, origin = painted(picture, drawing), np.array([-0.5, rows - 0.5])
    marks = [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, Fills)]
    shapes = [shape for mark in marks for shape, _ in _runs(mark, _pixels(mark.points, scale, origin))]
    start = np.concatenate([np.empty((0, 2)), *(shape.points[:, :2] for shape in shapes)])
    end = np.concatenate([np.empty((0, 2)), *(s.points[ragged.following(s.offsets), :2] for s in shapes)])
    crossed = crossed_pixels(start, end, columns, rows)
    number = np.cumsum(crossed).reshape(crossed.shape) - 1
    fine = np.repeat(picture[crossed], samples * samples, axis=0)
    runs = PixelRuns.of(crossed, samples)

    def pixels(polygons: Polygons) -> Iterator[PolygonPixels]:
        for found in polygon_pixels(polygons, samples * columns, samples * rows, runs):
            row, column = np.divmod(found.pixel, samples * columns)
            place = (row % samples) * samples + column % samples
            pixel = number[row // samples, column // samples] * (samples * samples) + place
            yield PolygonPixels(pixel, found.polygon, found.values)

    for mark in marks:
        places = _pixels(mark.points, samples * scale, np.array([-0.5, samples * rows - 0.5]))
        _fill(fine, mark, places, pixels)
    result[crossed] = np.rint(fine.reshape(-1, samples * samples, 3).mean(axis=1)).astype(np.uint8)
    return result


def _pixels(points: Floats, scale: Floats, origin: Floats) -> Floats:
    p = points * scale + origin
    if not (np.abs(p) < GUARD_BAND).all():
        raise InputError("a point of the drawing is not finite, or too far off the page")
    return np.asarray(p)


def _stroke_pixels(paths: Paths, points: Floats, width: float, columns: int, rows: int) -> Iterator[Ints]:
    """The pixels of strokes of some width, in portions, one pixel perhaps several times."""
    start, end = _segments(paths)
    if width < HAIRLINE:
        for part in line_pixels(points[start], points[end], columns, rows):
            yield part.row * columns + part.column
        return
    arm = points[end] - points[start]
    length = np.hypot(*arm.T)
    side = 0.5 * width * np.stack([-arm[:, 1], arm[:, 0]], axis=1) / np.where(length > 0.0, length, 1.0)[:, None]
    bars = np.stack([points[start] + side, points[end] + side, points[end] - side, points[start] - side], axis=1)
    angle = 2.0 * np.pi * (np.arange(JOIN_SIDES) + 0.5) / JOIN_SIDES
    rim = 0.5 * width * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    discs = points[:, None] + rim
    for shapes in (bars, discs):
        offsets = np.arange(0, shapes.shape[0] * shapes.shape[1] + 1, shapes.shape[1])
        for found in polygon_pixels(with_specks_grown(Polygons(shapes.reshape(-1, 2), offsets)), columns, rows):
            yield found.pixel


def _segments(paths: Paths) -> tuple[Ints, Ints]:
    """Positions of both ends of every segment; a stroke of one point is one to itself."""
    sizes = np.diff(paths.offsets)
    after = np.arange(1, len(paths.points) + 1)
    last = paths.offsets[1:][sizes > 0] - 1
    after[last] = np.where((paths.closed & (sizes > 1))[sizes > 0], paths.offsets[:-1][sizes > 0], -1)
    alone = paths.offsets[:-1][sizes == 1]
    after[alone] = alone
    start = np.flatnonzero(after >= 0)
    return start, after[start]


def _fill(flat: Bytes, fills: Fills, points: Floats, pixels: Callable[[Polygons], Iterator[PolygonPixels]]) -> None:
    """Paint polygons, one over the other: changes the picture."""
    for polygons, opacity in _runs(fills, points):
        for found in pixels(with_specks_grown(polygons)):
            under = flat[found.pixel].astype(np.float64) if opacity < 1.0 else 0.0
            flat[found.pixel] = np.rint(opacity * found.values + (1.0 - opacity) * under).astype(np.uint8)


def _runs(fills: Fills, points: Floats) -> Iterator[tuple[Polygons, float]]:
    """Polygons that are painted at once, with their colours and their opacity: flat opaque ones, the triangles of
    shaded ones, and those one sees through, one by one."""
    sizes = np.diff(fills.offsets)
    polygon = ragged.owner(sizes)
    same = (fills.colours == fills.colours[fills.offsets[:-1][polygon]]).all(axis=1)
    even = np.ones(len(fills), dtype=np.bool_)
    even[polygon[~same]] = False
    # Convex ones may be painted as shaded ones are: so runs are long.
    even &= ~_convex(points, fills.offsets)
    kind = np.where(fills.opacity < 1.0, 2 + np.arange(len(fills)), np.where(even, 0, 1))
    borders = np.append(np.flatnonzero(np.diff(kind, prepend=-1)), len(fills)).tolist()
    for begin, end in pairwise(borders):
        part = slice(fills.offsets[begin], fills.offsets[end])
        shaded = np.column_stack([points[part], fills.colours[part]])
        polygons = Polygons(shaded, fills.offsets[begin : end + 1] - fills.offsets[begin])
        yield polygons if even[begin:end].all() else _fan_triangles(polygons), float(fills.opacity[begin])


def _convex(points: Floats, offsets: Ints) -> Bools:
    """(m,) which polygons of no more than four corners are convex; of more they might run around twice."""
    side = points[ragged.following(offsets)] - points
    before = side[ragged.preceding(offsets)]
    turn = cross(before, side)
    least, most = (np.zeros(len(offsets) - 1) for _ in range(2))
    filled = np.flatnonzero(np.diff(offsets))
    least[filled], most[filled] = (f.reduceat(turn, offsets[filled]) for f in (np.minimum, np.maximum))
    return np.asarray((np.diff(offsets) <= 4) & ((least >= 0.0) | (most <= 0.0)))


def _fan_triangles(polygons: Polygons) -> Polygons:
    """The triangles around the first corner of each polygon."""
    corner = ragged.fans(polygons.offsets)[0].ravel()
    return Polygons(polygons.points[corner], np.arange(0, len(corner) + 1, 3))
