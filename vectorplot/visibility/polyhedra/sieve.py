"""Which pairs of a piece of a line and an occluder need a closer look: those that nothing in the image keeps apart.

All of it is in single precision and errs on the side of the closer look. What is said of a piece or of an occluder is
packed into single values of 16 bytes: so the processor fetches it at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.tolerances.of_numbers import SINGLE_LINE_SHARE
from vectorplot.visibility.polyhedra.grid import Floats32, Grid, Pieces
from vectorplot.visibility.polyhedra.occluders import Occluders

Packed = NDArray[np.complex128]

SIDES = 2
"""So many sides of an outline are tried: the first ones, which for convex solids are the longest."""


@dataclass(frozen=True, eq=False)
class Sieve:
    """Pieces and occluders in the image, packed.

    piece_boxes (p,): (right, -left, top, -bottom), boxes (k,): (left, -right, bottom, -top); ends (p,): x and y of the
    first end of each piece, then of the last; sides: for each of the SIDES (k,) lines as (a, b, c, 0), where
    a x + b y + c is below zero for what lies outside for certain.
    """

    piece_boxes: Packed
    boxes: Packed
    ends: Packed
    sides: tuple[Packed, ...]

    def passing(self, piece: Ints, occluder: Ints) -> Ints:
        """The pairs, by their positions, whose boxes overlap and of which no side of the outline keeps the piece
        outside."""
        passing = np.flatnonzero(_overlapping(self.piece_boxes.take(piece), self.boxes.take(occluder)))
        for side in self.sides:
            reaching = _reaching(self.ends.take(piece.take(passing)), side.take(occluder.take(passing)))
            passing = passing.compress(reaching)
        return passing


def sieve(view: View, grid: Grid, pieces: Pieces, occluders: Occluders) -> Sieve:
    """The sieve for pieces in a grid, which holds all of them, and occluders."""
    left, right, bottom, top = pieces.box
    piece_boxes = _packed(np.stack([right, -left, top, -bottom]))
    left, right, bottom, top = occluders.box
    boxes = _packed(np.stack([left, -right, bottom, -top]))
    return Sieve(piece_boxes, boxes, _packed(pieces.ends), _sides(view, grid, occluders))


def _sides(view: View, grid: Grid, occluders: Occluders) -> tuple[Packed, ...]:
    """The first sides of every outline as lines in the image, moved outwards by more than what rounding may do."""
    reach = max(
        abs(grid.left),
        abs(grid.bottom),
        abs(grid.left + grid.cell * float(grid.columns[0])),
        abs(grid.bottom + grid.cell * float(grid.rows[0])),
    )
    last = occluders.first[1:] - 1
    sides = []
    for number in range(SIDES):
        plane = np.minimum(occluders.first[:-1] + occluders.behind + number, last)
        a, b, c, d = occluders.planes.take(plane, axis=1)
        shift = _shift(view, a, b, c) - d
        size = (np.abs(a) + np.abs(b)) * reach + np.abs(shift)
        # An occluder without an outline fills the image.
        outline = occluders.first[:-1] + occluders.behind <= last
        line = np.stack([a, b, shift + SINGLE_LINE_SHARE * size, np.zeros_like(a)]) / np.where(size > 0.0, size, 1.0)
        line[:3, ~outline] = [[0.0], [0.0], [1.0]]
        sides.append(_packed(line.astype(np.float32)))
    return tuple(sides)


def _shift(view: View, a: Floats, b: Floats, c: Floats) -> Floats:
    """What the middle of the image plane adds to the heights above planes with these normals."""
    if view.eye is None:
        x, y = view.target[:2]
        return np.asarray(a * x + b * y, dtype=np.float64)
    x, y, z = view.eye
    return np.asarray(a * x + b * y + c * (z - view.focus), dtype=np.float64)


def _packed(rows: Floats32) -> Packed:
    """(n,) columns (4,n) of single precision, each packed into one value."""
    return np.ascontiguousarray(rows.T).view(np.complex128).ravel()


def _overlapping(piece_box: Packed, box: Packed) -> Bools:
    """Which pairs of packed boxes overlap."""
    below = box.view(np.float32) < piece_box.view(np.float32)
    return np.asarray(below.view(np.uint32) == np.uint32(0x01010101), dtype=np.bool_)


def _reaching(ends: Packed, side: Packed) -> Bools:
    """Which pairs of packed ends and lines have an end that is not outside for certain."""
    x, y, last_x, last_y = ends.view(np.float32).reshape(-1, 4).T
    a, b, c, _ = side.view(np.float32).reshape(-1, 4).T
    return np.asarray(np.maximum(a * x + b * y, a * last_x + b * last_y) >= -c, dtype=np.bool_)
