"""Strokes that belong to the sheet and to nothing in the world: frames, title blocks, marks, letters."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import NO_CURVE, Paths
from vectorplot.geometry import ragged
from vectorplot.words import LineKind

NO_ITEM = -1
"""They belong to no item."""


def page_strokes(lines: Sequence[Floats], rings: Sequence[Floats] = ()) -> Paths:
    """Open and closed polylines on the page, in mm; their points in the world are those of the page at height 0."""
    every = [*rings, *lines]
    points = np.array([*chain(*every)]).reshape(-1, 2)
    count = len(every)
    return Paths(
        points,
        ragged.offsets([len(line) for line in every]),
        np.arange(count) < len(rings),
        np.full(count, int(LineKind.LABEL)),
        np.full(count, NO_ITEM),
        np.zeros(count, dtype=np.intp),
        np.column_stack([points, np.zeros(len(points))]),
        curve=np.full(count, NO_CURVE),
    )


def rectangle(left: float, low: float, right: float, top: float) -> Floats:
    """(4,2) its corners, counter-clockwise."""
    return np.array([(left, low), (right, low), (right, top), (left, top)])
