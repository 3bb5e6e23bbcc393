"""From pieces to what a pen draws: long strokes in a good order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from operator import itemgetter

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import NO_CURVE, STROKES, Layer, Paths, Pen
from vectorplot.drawing.strokes.curved_strokes import curved_strokes
from vectorplot.drawing.strokes.dashes import CHAIN_MM, dashed
from vectorplot.drawing.strokes.join import joined
from vectorplot.drawing.strokes.long_strokes import split_long
from vectorplot.drawing.strokes.pen_order.order import pen_ordered
from vectorplot.drawing.strokes.rows import going_on, in_rows, without_dots
from vectorplot.drawing.strokes.simplify import without_collinear_points
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import mapped
from vectorplot.geometry.polylines import split
from vectorplot.tolerances.of_the_page import COINCIDENT_MM, COLLINEAR_MM
from vectorplot.words import LineKind

DASH_MM = (2.0, 1.0)
"""Dash and gap of hidden lines."""

CHAINED = (LineKind.CENTRE, LineKind.TRACE)
"""Kinds of lines that are drawn as long dashes and dots."""

MANY_PARTS = 32
"""The strokes of so many layers are joined and put in order layer by layer; those of more layers, which are small, all
at once, in a little more travel: a call costs as much as hundreds of strokes."""


FEW_POINTS = 2048
"""The strokes of few layers are joined at once too where they have no more points than so many in all."""


def inked(
    layers: tuple[Layer, ...],
    hidden: str,
    world: Floats,
    curve_tolerance_mm: float | None = None,
    longest_mm: float | None = None,
    thinned: bool = False,
) -> tuple[Layer, ...]:
    """Each layer's strokes joined, without collinear points, dashed as its pen says, hidden ones also if asked for, in
    the order of the pen, in parts where they are longer than longest_mm; smooth ones as curves within
    curve_tolerance_mm, or as polylines where it is None. thinned: ends that converge stop early. Filled polygons
    and texts stay."""
    parts = [paths for layer in layers for paths in layer.strokes]
    pens = [layer.pen for layer in layers for _ in layer.strokes]
    strokes = _pen_strokes(parts, pens, hidden, world, thinned)
    if longest_mm is not None:
        strokes = [split_long(paths, longest_mm, world) for paths in strokes]
    drawn = iter(strokes if curve_tolerance_mm is None else (curved_strokes(s, curve_tolerance_mm) for s in strokes))
    return tuple(
        replace(layer, marks=tuple(next(drawn) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


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


def chain_lines_dashed(paths: Paths, world: Floats, mm: float = 1.0) -> Paths:
    """The strokes, of which centre lines and traces are broken into long dashes and dots; mm: how long a millimetre is
    in units of the page."""
    chained = np.isin(paths.kind, CHAINED)
    if not chained.any():
        return paths
    dash, gap, dot = (mm * length for length in CHAIN_MM)
    broken = dashed(long_strokes(chosen(paths, chained)), dash, gap, world, dot_mm=dot)
    return concatenated((chosen(paths, ~chained), broken))


def with_dashes(layers: Sequence[Layer], world: Floats) -> list[Layer]:
    """Layers of strokes, broken into dashes where their pens have some, in units of the page."""
    return [
        replace(layer, marks=tuple(dashed(paths, *layer.pen.dash_mm, world) for paths in layer.strokes))
        if layer.pen.dash_mm is not None and any(layer.pen.dash_mm)
        else layer
        for layer in layers
    ]


def _group(paths: Paths) -> Ints:
    """(m,) equal for strokes of the same item, kind and count."""
    return (paths.item * len(LineKind) + paths.kind) * (int(paths.hidden_by.max(initial=0)) + 1) + paths.hidden_by


def _pen_strokes(parts: Sequence[Paths], pens: Sequence[Pen], hidden: str, world: Floats, thinned: bool) -> list[Paths]:
    """The strokes of each part, joined and in the order of the pen."""
    alike = len({pen.dash_mm for pen in pens}) == 1 and not thinned
    many = len(parts) > MANY_PARTS
    if not alike or (not many and sum(len(paths.points) for paths in parts) > FEW_POINTS):
        # The longest part begins first, so that the others are done beside it.
        first = sorted(range(len(parts)), key=lambda k: -len(parts[k]))
        done = mapped(lambda k: pen_ordered(_drawn(parts[k], pens[k], hidden, world, thinned)), first)
        return [paths for _, paths in sorted(zip(first, done, strict=True), key=itemgetter(0))]
    every = concatenated(tuple(parts))
    part = ragged.owner([len(paths) for paths in parts])
    low, high = int(every.item.min(initial=0)), int(every.item.max(initial=0)) + 1
    # Until they are in order, what is said of their items tells the parts of strokes too: no two parts are joined.
    long = _drawn(replace(every, item=part * (high - low) + every.item - low), pens[0], hidden, world, thinned)
    part, item = np.divmod(long.item, high - low)
    order = np.argsort(part, kind="stable")
    long, part = chosen(replace(long, item=item + low), order), part[order]
    own = split(pen_ordered(long, part) if many else long, np.searchsorted(part, np.arange(len(parts) + 1)))
    return own if many else [pen_ordered(paths) for paths in own]


def _drawn(paths: Paths, pen: Pen, hidden: str, world: Floats, thinned: bool) -> Paths:
    """The long strokes of a pen, with its dashes."""
    long = long_strokes(paths)
    if thinned:
        from vectorplot.drawing.pens.thinned_ends import thinned_ends

        long = thinned_ends(long, pen.width_mm, world)
    if pen.dash_mm is not None:
        return dashed(long, *pen.dash_mm, world) if any(pen.dash_mm) else long
    chained = np.isin(long.kind, CHAINED)
    behind = (((long.hidden_by > 0) & (hidden == "dashed")) | (long.kind == int(LineKind.GHOST))) & ~chained
    parts = [chosen(long, ~(behind | chained))]
    if behind.any():
        parts.append(dashed(chosen(long, behind), *DASH_MM, world))
    if chained.any():
        parts.append(chain_lines_dashed(chosen(long, chained), world))
    return concatenated(tuple(parts)) if len(parts) > 1 else long
