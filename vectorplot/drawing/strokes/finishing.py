"""From pieces to what a pen draws: long strokes in a good order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import NO_CURVE, Layer, Paths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.curved_strokes import curved_strokes
from vectorplot.drawing.strokes.dashes import dashed
from vectorplot.drawing.strokes.join import joined
from vectorplot.drawing.strokes.long_strokes import split_long
from vectorplot.drawing.strokes.paths import chosen, concatenated
from vectorplot.drawing.strokes.pen_order.order import pen_ordered
from vectorplot.drawing.strokes.rows import going_on, in_rows, without_dots
from vectorplot.drawing.strokes.simplify import without_collinear_points
from vectorplot.tolerances.of_the_page import COINCIDENT_MM, COLLINEAR_MM
from vectorplot.words import LineKind

DASH_MM = (2.0, 1.0)
"""Dash and gap of hidden lines."""


def inked(
    layers: tuple[Layer, ...],
    hidden: str,
    world: Floats,
    curve_tolerance_mm: float | None = None,
    longest_mm: float | None = None,
) -> tuple[Layer, ...]:
    """Each layer's strokes joined, without collinear points, hidden ones dashed if asked for, in the order of the
    pen, in parts where they are longer than longest_mm; smooth ones as curves within curve_tolerance_mm, or as
    polylines where it is None. Filled polygons stay."""
    found = []
    for layer in layers:
        strokes = tuple(_pen_strokes(paths, hidden, world) for paths in layer.strokes)
        if longest_mm is not None:
            strokes = tuple(split_long(paths, longest_mm, world) for paths in strokes)
        drawn = iter(
            strokes if curve_tolerance_mm is None else (curved_strokes(s, curve_tolerance_mm) for s in strokes)
        )
        marks = tuple(mark if isinstance(mark, Fills) else next(drawn) for mark in layer.marks)
        found.append(replace(layer, marks=marks))
    return tuple(found)


def long_strokes(paths: Paths) -> Paths:
    """Strokes of one item, kind and count that follow one another joined, without collinear points: those of one curve
    first, then those of different curves, or of none, that meet end to end."""
    if not len(paths):
        return paths
    known = paths.curve != NO_CURVE
    if known.any():
        curves = without_dots(chosen(paths, known), COINCIDENT_MM)
        curves = in_rows(curves, going_on(curves, _group(curves), COINCIDENT_MM))
        own = np.unique(np.stack([_group(curves), curves.curve]), axis=1, return_inverse=True)[1]
        paths = concatenated((joined(curves, own.ravel(), COINCIDENT_MM), chosen(paths, ~known)))
    return without_collinear_points(joined(paths, _group(paths), COINCIDENT_MM), COLLINEAR_MM)


def _group(paths: Paths) -> Ints:
    """(m,) equal for strokes of the same item, kind and count."""
    return (paths.item * len(LineKind) + paths.kind) * (int(paths.hidden_by.max(initial=0)) + 1) + paths.hidden_by


def _pen_strokes(paths: Paths, hidden: str, world: Floats) -> Paths:
    if not len(paths):
        return paths
    long = long_strokes(paths)
    if hidden == "dashed" and (long.hidden_by > 0).any():
        behind = np.flatnonzero(long.hidden_by > 0)
        dashes = dashed(chosen(long, behind), *DASH_MM, world)
        long = concatenated((chosen(long, np.flatnonzero(long.hidden_by == 0)), dashes))
    return pen_ordered(long)
