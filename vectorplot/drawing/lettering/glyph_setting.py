"""Glyphs set in rows: how wide they are, where their strokes and their boxes come to stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.lettering.formulas import without_formulas
from vectorplot.drawing.lettering.hershey import Glyph, clusters, room_of
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import Polylines


def measured(line: str) -> list[Glyph]:
    """The room that the letters of a line take: that of their strokes, or a square where there are none; of formulas
    that of the signs they show."""
    return [room_of(cluster) for cluster in clusters(without_formulas(line))]


def as_one(letters: Sequence[Glyph]) -> Glyph:
    """Letters side by side as one, so far as their room goes."""
    low, high = reach_of(letters)
    return Glyph(sum(one.advance for one in letters), (((0.0, low), (0.0, high)),) if high > low else ())


def no_strokes() -> Polylines:
    """Letters without strokes."""
    return Polylines(np.zeros((0, 2)), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_))


def check_size(size_mm: float) -> None:
    """An InputError for a size that is not finite and positive."""
    if not 0.0 < size_mm < np.inf:
        raise InputError(f"a size of {size_mm:g} mm: expected a length that is finite and positive")


def set_glyphs(found: Sequence[Glyph], unit: float, place: Floats, turn: Floats) -> Polylines:
    """The strokes of letters, each at its place (n,2) and turned by a matrix (n,2,2)."""
    strokes = [one.strokes for one in found]
    letter = ragged.owner([len(some) for some in strokes])
    sizes = [len(stroke) for some in strokes for stroke in some]
    points = np.array([point for some in strokes for stroke in some for point in stroke]).reshape(-1, 2)
    owner: Ints = np.repeat(letter, sizes)
    placed = np.einsum("nij,nj->ni", turn[owner], unit * points) + place[owner]
    return Polylines(placed, ragged.offsets(sizes), np.zeros(len(sizes), dtype=np.bool_))


def turned(degrees: Floats) -> Floats:
    """(n,2,2) rotations; exact for right angles."""
    quarter = np.mod(np.rint(degrees / 90.0), 4.0)
    right = quarter * 90.0 == np.mod(degrees, 360.0)
    cosine = np.where(right, np.array([1.0, 0.0, -1.0, 0.0])[quarter.astype(np.intp)], np.cos(np.radians(degrees)))
    sine = np.where(right, np.array([0.0, 1.0, 0.0, -1.0])[quarter.astype(np.intp)], np.sin(np.radians(degrees)))
    return np.stack([np.stack([cosine, -sine], axis=1), np.stack([sine, cosine], axis=1)], axis=1)


def rectangles(corner: Floats, width: Floats, height: Floats) -> Floats:
    """(n,4,2) the corners of upright rectangles from their lower left ones (n,2), their widths and heights (n,)."""
    across, up = np.array([0.0, 1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0, 1.0])
    right, top = width[:, None] * across, height[:, None] * up
    return np.asarray(np.stack([corner[:, :1] + right, corner[:, 1:] + top], axis=2))


def reach_of(line: Sequence[Glyph]) -> tuple[float, float]:
    """The lowest and the highest point of a line of letters; 0 and 0 for blanks."""
    heights = [y for one in line for stroke in one.strokes for _, y in stroke]
    return min(heights, default=0.0), max(heights, default=0.0)
