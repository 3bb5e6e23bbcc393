"""Meshes over grids of lines along x and y, as graphs of functions are: their painter's order without a comparison."""

from __future__ import annotations

from functools import reduce

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.painter.slices import eye_coordinate, slice_order

Bytes = NDArray[np.int8]
Ints32 = NDArray[np.int32]

EMPTY = 4
"""A grid may have so many places for each vertex; where more stay empty it is none."""

FEWEST = 64
"""Of items with fewer faces it is not worth asking for a grid."""

NONE, UPWARDS, DOWNWARDS, WHOLE = 0, 1, 2, 3
"""How a face fills its cell: not as it should, or on one side of the diagonal from the lower left corner to the upper
right one, or of that from the upper left one to the lower right one, or wholly."""

CUTS = np.full(16, NONE, dtype=np.int8)
CUTS[[0b1011, 0b1101, 0b0111, 0b1110, 0b1111]] = UPWARDS, UPWARDS, DOWNWARDS, DOWNWARDS, WHOLE
"""How a face fills its cell, by its corners: bits for lower left, lower right, upper left, upper right."""

IS_LEFT = np.zeros(16, dtype=np.bool_)
IS_LEFT[[0b1101, 0b1110]] = True
"""Whether it lies on the left of its diagonal, seen towards x."""


def known_orders(scene: Scene, view: View) -> dict[int, Ints]:
    """For every item whose faces, FEWEST or more, lie over the cells of a grid of the world, at most one face over any
    place, all its faces in the view, back to front.

    Wherever the eye is, of two faces over different cells the one beyond a vertical plane between them goes first.
    Source: Glaeser, section 5.4, figure 7.
    """
    if view.eye is None:
        eye = np.append(view.axes[2], 0.0)
    else:
        eye = view.world_of(view.eye[:, None])[0]
    found = {}
    first = np.searchsorted(view.face_item, np.arange(len(scene.items) + 1))
    for number in np.flatnonzero(np.diff(first) >= FEWEST).tolist():
        low, high = first[number : number + 2].tolist()
        corners = view.corners[view.offsets[low] : view.offsets[high]] - view.item_vertices[number]
        order = field_order(scene.items[number].mesh.vertices, corners, view.face_sizes[low:high], eye)
        if order is not None:
            found[number] = low + order
    return found


def field_order(vertices: Floats, corners: Ints, sizes: Ints, eye: Floats) -> Ints | None:
    """The faces (f,) of a mesh over a grid of lines along x and y, back to front; None if it is no such mesh.

    vertices (v,3); corners (c,) and sizes (f,) of faces; eye (3,), or (x, y, z, 0) for a direction towards it.
    Every face fills a cell of the grid, or a half of one on one side of a diagonal; where cells are empty the mesh has
    holes.
    Source: Glaeser, section 5.4, figure 7.
    """
    if not len(sizes) or sizes.min() != sizes.max() or sizes[0] not in (3, 4):
        return None
    lines, place = [], []
    for axis in (0, 1):
        line = _lines(vertices[:, axis])
        if len(line) < 2 or len(line) > len(vertices) // 2 + 1:
            return None
        lines.append(line)
        place.append(np.searchsorted(line, vertices[:, axis]))
    if len(lines[0]) * len(lines[1]) > EMPTY * len(vertices):
        return None
    across, along = ([p.astype(np.int32)[corners[k :: sizes[0]]] for k in range(sizes[0])] for p in place)
    low = [reduce(np.minimum, own) for own in (across, along)]
    if any((reduce(np.maximum, own) - least).max() > 1 for own, least in zip((across, along), low, strict=True)):
        return None
    steps = [(x - low[0] + 2 * (y - low[1])).astype(np.int8) for x, y in zip(across, along, strict=True)]
    return _in_order(lines, low, reduce(np.bitwise_or, [np.left_shift(np.int8(1), step) for step in steps]), eye)


def _lines(values: Floats) -> Floats:
    """The lines of a grid that some coordinates (v,) are on; those of a row, or a column, come many times."""
    return np.unique(values[np.append(True, values[1:] != values[:-1])])


def _in_order(lines: list[Floats], low: list[Ints32], filled: Bytes, eye: Floats) -> Ints | None:
    """The order of faces by the numbers of their cells on both axes, and the corners of the cells that they fill."""
    rows, columns = (len(line) - 1 for line in lines)
    cut = CUTS[filled]
    if (cut == NONE).any():
        return None
    cell = low[0].astype(np.intp) * columns + low[1]
    of_cell = np.zeros(rows * columns, dtype=np.int8)
    of_cell[cell] = cut
    if (of_cell[cell] != cut).any():
        return None
    row, column = (_places(line, eye_coordinate(eye, axis)) for axis, line in enumerate(lines))
    eye_left = _eye_left(lines, eye, of_cell.reshape(rows, columns)).ravel()
    later = (IS_LEFT[filled] == eye_left[cell]) & (cut != WHOLE)
    slot = 2 * (row[:, None] * columns + column).ravel()[cell] + later
    found = np.full(2 * rows * columns, -1, dtype=np.intp)
    found[slot] = np.arange(len(slot))
    order = found[found >= 0]
    return order if len(order) == len(slot) else None


def _places(line: Floats, eye: float) -> Ints:
    """(k,) the place of each slice between lines in the order of drawing."""
    order = slice_order(line, eye)
    places = np.empty(len(order), dtype=np.intp)
    places[order] = np.arange(len(order))
    return places


def _eye_left(lines: list[Floats], eye: Floats, cut: Bytes) -> Bools:
    """(m,n) whether the eye is on the left of the diagonals of cells that are cut in some way (m,n)."""
    (width, height), down = (np.diff(line) for line in lines), cut == DOWNWARDS
    if len(eye) == 3:
        x, y = (eye[0] - lines[0][:-1])[:, None], eye[1] - lines[1][:-1] - np.where(down, height, 0.0)
    else:
        x, y = np.full((len(width), 1), eye[0]), np.full(cut.shape, eye[1])
    return np.asarray(width[:, None] * y - np.where(down, -height, height) * x > 0.0, dtype=np.bool_)
