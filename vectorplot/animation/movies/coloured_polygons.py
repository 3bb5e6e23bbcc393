"""A drawing as polygons and lines of a movie: clipped, on its grid of 4096, each corner in its colour."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.animation.movies.movie import MOST_CORNERS
from vectorplot.animation.movies.packing import LARGEST_12_BIT
from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Paths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping.clip_windows import Window
from vectorplot.geometry.clipping.clipped_lines import clip_lines_2d
from vectorplot.geometry.clipping.clipped_polygons import Polygons, clip_polygons_2d
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, Polylines, joined, segments, some
from vectorplot.geometry.regions import corners_of, polygons_of, triangles_of

TINY = 4.0
"""Polygons of no more than so many units of the grid in area are left out."""

NO_ITEM = -1
"""Of what belongs to no item."""

PAPER = 255.0
"""White, which shines through what is transparent."""


@dataclass(frozen=True, eq=False)
class ColouredPolygons:
    """Polygons (three corners and more) and lines (two): points (p,2), offsets (m+1,), colours (p,3), item (m,) numbers
    of items or NO_ITEM."""

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    colours: Floats = field(metadata=EACH_POINT)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1


def coloured_polygons(drawing: Drawing) -> ColouredPolygons:
    """The polygons and lines of a drawing in drawing order, on the grid; the paper before them where the first polygon
    is not the whole page.

    What is transparent is mixed with white. Texts are left out. Polygons of more corners than a movie has are cut to
    triangles, of one colour each.
    """
    window = Window(0.0, drawing.width_mm, 0.0, drawing.height_mm)
    scale = LARGEST_12_BIT / max(drawing.width_mm, drawing.height_mm)
    parts = []
    for layer in drawing.layers:
        colour = np.array([int(layer.pen.colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.float64)
        for mark in layer.marks:
            if isinstance(mark, Fills):
                parts += _filled(mark, window)
            elif isinstance(mark, Paths | CurvedStrokes):
                parts.append(_stroked(mark, colour, window, 1.0 / scale))
    white = Fills.whole_page(drawing.width_mm, drawing.height_mm, np.full(3, 255, dtype=np.uint8))
    (paper,) = _filled(white, window)
    found = _on_grid(joined([*parts, paper]) if parts else paper, scale)
    sheet, rest = some(found, np.array([len(found) - 1])), some(found, np.arange(len(found) - 1))
    rest = some(rest, _areas(rest) > TINY)
    if len(rest) and _corners(rest) == _corners(sheet):
        return rest
    return joined([sheet, rest])


def _corners(polygons: ColouredPolygons) -> set[tuple[float, float]]:
    """The corners of the first polygon."""
    return {(x, y) for x, y in polygons.points[: polygons.offsets[1]].tolist()}


def _on_grid(polygons: ColouredPolygons, scale: float) -> ColouredPolygons:
    return replace(polygons, points=np.clip(np.rint(polygons.points * scale), 0.0, LARGEST_12_BIT))


def _areas(polygons: ColouredPolygons) -> Floats:
    """(m,) the areas of polygons; of lines without end."""
    first, sizes = polygons.offsets[:-1], np.diff(polygons.offsets)
    if not len(sizes):
        return np.zeros(0)
    arm = polygons.points - np.repeat(polygons.points[first], sizes, axis=0)
    after = arm[ragged.following(polygons.offsets)]
    area = np.abs(np.add.reduceat(arm[:, 0] * after[:, 1] - arm[:, 1] * after[:, 0], first)) / 2.0
    return np.where(sizes == 2, np.inf, area)


def _filled(fills: Fills, window: Window) -> list[ColouredPolygons]:
    """Filled polygons, and lines among them, as far as they lie on the page, in their order."""
    sizes = np.diff(fills.offsets)
    share = np.repeat(fills.opacity, sizes)[:, None]
    colours = share * fills.colours + (1.0 - share) * PAPER
    table = np.column_stack([fills.points, colours])
    of = np.flatnonzero(sizes >= 3)
    at, offsets = ragged.take(fills.offsets, of)
    inside = clip_polygons_2d(Polygons(table[at], offsets), window)
    faces = ColouredPolygons(inside.points[:, :2], inside.offsets, inside.points[:, 2:], fills.item[of])
    left = np.flatnonzero(np.diff(inside.offsets) > 0)
    faces, owner = _few_corners(some(faces, left), of[left])
    pairs = np.flatnonzero(sizes == 2)
    lines, line = _clipped(table[fills.offsets[pairs]], table[fills.offsets[pairs] + 1], fills.item[pairs], window)
    found = joined([faces, lines])
    return [some(found, np.argsort(np.concatenate([owner, pairs[line]]), kind="stable"))]


def _few_corners(faces: ColouredPolygons, owner: Ints) -> tuple[ColouredPolygons, Ints]:
    """Triangles in place of polygons with too many corners, and the owner of each; owner (m,): of the polygons."""
    many = np.diff(faces.offsets) > MOST_CORNERS
    if not many.any():
        return faces, owner
    large, small = some(faces, many), some(faces, ~many)
    triangles, of = triangles_of(polygons_of(large.points.T, large.offsets))
    points, offsets = corners_of(triangles)
    colours = np.repeat(large.colours[large.offsets[:-1]][of], np.diff(offsets), axis=0)
    cut = ColouredPolygons(points.T, offsets, colours, large.item[of])
    return joined([small, cut]), np.concatenate([owner[~many], owner[many][of]])


def _stroked(mark: Paths | CurvedStrokes, colour: Floats, window: Window, tolerance: float) -> ColouredPolygons:
    """The segments of strokes, those of curves within the tolerance, as far as they lie on the page."""
    if isinstance(mark, Paths):
        lines, item = Polylines(mark.points, mark.offsets, mark.closed), mark.item
    else:
        straight = np.flatnonzero(np.diff(mark.beziers.offsets) == 0)
        plain = chosen(mark.paths, straight)
        points, offsets = mark.beziers.flattened(tolerance)
        curved = np.flatnonzero(np.diff(mark.beziers.offsets) > 0)
        at, ends = ragged.take(offsets, curved)
        bent = Polylines(points[at], ends, np.zeros(len(curved), dtype=np.bool_))
        lines = joined([Polylines(plain.points, plain.offsets, plain.closed), bent])
        item = mark.paths.item[np.concatenate([straight, curved])]
    pairs = segments(lines)
    table = np.column_stack([lines.points, np.broadcast_to(colour, (len(lines.points), 3))])
    owner = ragged.owner(np.diff(lines.offsets))
    return _clipped(table[pairs[:, 0]], table[pairs[:, 1]], item[owner[pairs[:, 0]]], window)[0]


def _clipped(start: Floats, end: Floats, item: Ints, window: Window) -> tuple[ColouredPolygons, Ints]:
    """Lines between rows x, y, red, green and blue, each in the mean of its colours, and which ones are left."""
    found = clip_lines_2d(start, end, window)
    left = np.flatnonzero(found.exists)
    ends = np.stack([found.start[left], found.end[left]], axis=1)
    colours = np.repeat(ends[:, :, 2:].mean(axis=1), 2, axis=0)
    offsets = np.arange(0, 2 * len(left) + 1, 2)
    return ColouredPolygons(ends[:, :, :2].reshape(-1, 2), offsets, colours, item[left]), left
