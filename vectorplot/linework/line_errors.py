"""How far the strokes of a drawing are from the curves they show, measured on the page."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vectorplot.drawing.drawing import CurvedStrokes, Layer, Paths
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import segments


def chord_error_mm(strokes: Paths) -> float | None:
    """How far the chords of smooth strokes are from their curves, at most: in their middles, from the cubics that leave
    and arrive in the directions that the curves were traced with; None without such strokes.

    Error: of the fourth power of a chord's length, where what is measured is of the second.
    Source: Farin, Curves and Surfaces for CAGD, section 6.5 (cubic Hermite interpolation).
    """
    ends = segments(strokes)[np.repeat(strokes.smooth, np.diff(strokes.offsets) - ~strokes.closed)]
    chord = strokes.points[ends[:, 1]] - strokes.points[ends[:, 0]]
    length = np.hypot(*chord.T)
    leaving, arriving = strokes.directions[ends[:, 0], 1], strokes.directions[ends[:, 1], 0]
    along = arctan2(chord[:, 1], chord[:, 0])
    off = length / 8.0 * np.abs(np.sin(leaving - along) - np.sin(arriving - along))
    # Over a cusp the directions are those of two branches.
    turns = np.minimum(np.cos(leaving - along), np.cos(arriving - along))
    off = off[np.isfinite(off) & (turns > 0.0)]
    return float(off.max()) if len(off) else None


def fit_error_mm(layers: Iterable[Layer]) -> float | None:
    """How far fitted curves pass the points they were fitted to, at most, all of which lie on the true curves; None
    without fitted curves."""
    marks = (mark for layer in layers for mark in layer.marks if isinstance(mark, CurvedStrokes))
    found = [mark.beziers.error[np.diff(mark.beziers.offsets) > 0] for mark in marks]
    fitted = np.concatenate([np.zeros(0), *found])
    return float(fitted.max()) if len(fitted) else None
