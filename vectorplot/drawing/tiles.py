"""A large page on several sheets: parts side by side, with crosses at their corners by which they are put together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.finishing import put_in_order
from vectorplot.drawing.sheets import Mark, moved_mark, page_strokes
from vectorplot.drawing.strokes import Rectangle, clipped
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import Window, clip_lines_2d
from vectorplot.geometry.polygon_cuts import clipped_by_convex

MARGIN_MM = 10.0
"""Around the part of the page that a sheet shows: plotters do not reach the edge of the paper."""

ARM_MM = 5.0
"""From the middle of a registration mark to its ends: to both sides, in the margin and on the picture."""

MOST_TILES = 50
"""In a row or a column."""


def tiled(
    drawing: Drawing, columns: int, rows: int, *, margin_mm: float = MARGIN_MM, tolerance_mm: float = 0.02
) -> tuple[tuple[Drawing, ...], ...]:
    """The page of a drawing cut into equal parts, each on a sheet with a margin around it.

    Parameters
    ----------
    drawing : Drawing
        The whole.
    columns, rows : int
        How many parts lie side by side, and how many above each other; 1 to 50.
    margin_mm : float
        What sheets have around their parts; 0 or more.
    tolerance_mm : float
        How far curves that are cut may be off the true ones.

    Returns
    -------
    tuple of tuple of Drawing
        Rows of sheets, the upper one first, each from the left: strokes and filled polygons end where their part of the
        page does, and strokes are in an order with little travel again. A first layer, registration, has crosses at the
        corners of the part, by the pen of the first layer that is plotted.

    Raises
    ------
    InputError
        For numbers that are none, and a margin below 0.

    Notes
    -----
    Edge cases: real texts cannot be cut: they are on every sheet that they reach, whole.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import tiled
    >>> paths = vp.Paths.of_polylines([[(0, 10), (100, 10)]])
    >>> page = vp.Drawing(100, 80, (vp.Layer("line", vp.Pen(), (paths,)),))
    >>> sheets = tiled(page, 2, 2)
    >>> sheets[1][0].width_mm, [len(sheet.layers[1].strokes[0]) for row in sheets for sheet in row]
    (70.0, [0, 0, 1, 1])
    """
    if not all(isinstance(n, int) and 1 <= n <= MOST_TILES for n in (columns, rows)):
        raise InputError(f"tiles {columns}x{rows}: expected whole numbers from 1 to {MOST_TILES}")
    if not 0.0 <= margin_mm < np.inf:
        raise InputError(f"a margin of {margin_mm:g} mm around tiles: expected 0 or more")
    return tuple(
        tuple(tile(drawing, columns, rows, row, column, margin_mm, tolerance_mm) for column in range(columns))
        for row in range(rows)
    )


def tile(
    drawing: Drawing,
    columns: int,
    rows: int,
    row: int,
    column: int,
    margin: float = MARGIN_MM,
    tolerance_mm: float = 0.02,
) -> Drawing:
    """One of the sheets of tiled, in the row from the top and the column from the left, counted from 0."""
    wide, high = drawing.width_mm / columns, drawing.height_mm / rows
    left, low = column * wide, (rows - 1 - row) * high
    right, top = left + wide, low + high
    part = left, low, right, top
    by = margin - np.array([left, low])
    curved = any(isinstance(mark, CurvedStrokes) for layer in drawing.layers for mark in layer.marks)
    cut = tuple(replace(layer, marks=tuple(_cut(drawing, layer, part))) for layer in drawing.layers)
    cut = put_in_order(cut, drawing.page_from_world, tolerance_mm if curved else None, None)
    moved = (replace(layer, marks=tuple(moved_mark(mark, 1.0, by) for mark in layer.marks)) for layer in cut)
    world = drawing.page_from_world.copy()
    world[:2] += by[:, None] * world[3]
    pen = next((layer.pen for layer in drawing.layers if layer.plotted), Pen())
    sheet = replace(
        drawing,
        width_mm=right - left + 2.0 * margin,
        height_mm=top - low + 2.0 * margin,
        layers=tuple(moved),
        page_from_world=world,
    )
    marks = page_strokes(_crosses(np.array([[margin, margin], [margin + right - left, margin + top - low]])))
    return replace(sheet, layers=(Layer("registration", pen, (marks,)), *sheet.layers))


def _cut(drawing: Drawing, layer: Layer, part: Rectangle) -> Iterator[Mark]:
    """The marks of a layer, in a part of the page: strokes as polylines, fills cut, texts that reach it whole."""
    for mark in layer.marks:
        strokes = mark.paths if isinstance(mark, CurvedStrokes) else mark
        if isinstance(strokes, Paths):
            yield clipped(strokes, part, drawing.page_from_world)
        elif isinstance(strokes, Fills):
            yield _cut_fills(strokes, part, drawing.page_from_world)
        else:
            yield _reaching(strokes, part)


def _cut_fills(fills: Fills, part: Rectangle, page_from_world: Floats) -> Fills:
    """What is left of filled polygons in a part of the page, in their order."""
    fills = fills.take(np.flatnonzero(np.diff(fills.offsets) > 1)).in_triangles()
    if not len(fills):
        return fills
    low, high = (best.reduceat(fills.points, fills.offsets[:-1], axis=0) for best in (np.minimum, np.maximum))
    inside = ((low >= part[:2]) & (high <= part[2:])).all(axis=1)
    crossing = ~inside & ((low <= part[2:]) & (high >= part[:2])).all(axis=1)
    is_line = np.diff(fills.offsets) == 2
    kept, lines, areas = (np.flatnonzero(which) for which in (inside, crossing & is_line, crossing & ~is_line))
    # What is linear in the image, also where this is a perspective one: places divided by their depths.
    depth = matmul(fills.points3d, page_from_world[3, :3]) + page_from_world[3, 3]
    rows = np.column_stack([fills.points, fills.points3d / depth[:, None], 1.0 / depth, fills.colours])
    left, bottom, right, top = part
    first = fills.offsets[lines]
    ends = clip_lines_2d(rows[first], rows[first + 1], Window(left, right, bottom, top))
    ways = np.stack([ends.start, ends.end], axis=1)[ends.exists].reshape(-1, rows.shape[1])
    lines = lines[ends.exists]
    corner, offsets = ragged.take(fills.offsets, areas)
    square = np.tile([(left, right, right, left), (bottom, bottom, top, top)], len(areas))
    cut, offsets, of = clipped_by_convex(rows[corner].T, offsets, square, 4 * np.arange(len(areas) + 1))
    number = np.concatenate([kept, lines, areas[of]])
    parts = np.concatenate([ways, cut.T])
    sizes = np.concatenate([np.full(len(lines), 2), np.diff(offsets)])
    some = fills.take(number[len(kept) :])
    made = Fills(
        np.ascontiguousarray(parts[:, :2]),
        ragged.offsets(sizes),
        np.rint(parts[:, 6:]).astype(np.uint8),
        some.opacity,
        some.item,
        parts[:, 2:5] / parts[:, 5:6],
        some.kind,
    )
    return Fills.joined(fills.take(kept), made).take(np.argsort(number, kind="stable"))


def _reaching(texts: Texts, part: Rectangle) -> Texts:
    """The texts whose boxes reach into a part of the page."""
    turn = np.radians(texts.turn_deg)
    along = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    up = np.stack([-along[:, 1], along[:, 0]], axis=1) * texts.size_mm[:, None]
    begin = texts.points - (texts.anchor * texts.room_mm)[:, None] * along
    end = begin + texts.room_mm[:, None] * along
    corners = np.stack([begin - up / 2.0, end - up / 2.0, begin + up, end + up])
    meets = ((corners.min(axis=0) <= part[2:]) & (corners.max(axis=0) >= part[:2])).all(axis=1)
    return texts.take(np.flatnonzero(meets))


def _crosses(box: Floats) -> list[Floats]:
    """Two lines (2,2) at each corner of the box (2,2)."""
    arms = ARM_MM * np.array([[(-1.0, 0.0), (1.0, 0.0)], [(0.0, -1.0), (0.0, 1.0)]])
    return [np.array([x, y]) + arm for x in box[:, 0] for y in box[:, 1] for arm in arms]
