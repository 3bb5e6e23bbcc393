"""The curves of a scene's smooth surfaces as a view shows them: those that are drawn, and the edges that hide."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import is_curve
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.budget import USUAL, Budget, unheard
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.visibility.polyhedra.lines import items_wanting, kinds_of
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.implicit_sheet import implicit_sheet
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tracing.implicit_items import curves_of_implicit
from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet, meetings
from vectorplot.visibility.smooth.tracing.merged_families import with_merged_families
from vectorplot.visibility.smooth.tracing.parametric_items import (
    contours_of_parametrised,
    curves_of_parametrised,
    parameter_lines_of_parametrised,
    sheets_of_items,
)
from vectorplot.visibility.smooth.tracing.rims import with_rims
from vectorplot.visibility.smooth.tracing.space_items import space_curve
from vectorplot.visibility.smooth.tracing.traced_curves import Curves, together
from vectorplot.words import LineKind

WIDEST_IMAGE = 4.0
"""Images further than so many focal lengths from the principal point are not looked at closely."""

HIDING = (LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE)
"""Kinds of curves behind which sheets begin."""


@dataclass(frozen=True, eq=False)
class TracedScene:
    """The sheets of all smooth items, and for each (s,) whether it may meet itself; the curves that are drawn; edges:
    the folds, borders and cuspidal edges of the sheets that hide; doubts: of what item or items,
    by name, what could not be decided."""

    sheets: Sheets
    meets_itself: Bools
    curves: Curves
    edges: Curves
    doubts: tuple[tuple[str, str], ...]

    def __len__(self) -> int:
        return len(self.curves)

    def joined(self, curves: Curves) -> TracedScene:
        """The same with more curves to draw."""
        return replace(self, curves=together([self.curves, curves]))


def scene_sheets(scene: Scene, view: View, without: Collection[int] = ()) -> tuple[SmoothSheet, ...]:
    """The sheets of all smooth items without some, given by their numbers."""
    items = [(number, item) for number, item in enumerate(scene.items) if number not in without]
    parametrised = [(item.shape, number, item.hides) for number, item in items if is_parametrised(item.shape)]
    sheets: list[SmoothSheet] = list(sheets_of_items(view, parametrised))
    sheets += [implicit_sheet(view, item.shape, n, item.hides) for n, item in items if is_implicit(item.shape)]
    return tuple(sorted(sheets, key=lambda sheet: sheet.item))


def traced_scene(
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    kinds: frozenset[LineKind],
    tolerance: float,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> TracedScene:
    """All curves of smooth items, and those that are items themselves, every point exact, chords within a tolerance in
    the image.

    budget: of the work on every item; done: is told the part of the work that is done.
    """
    tracing = tracing_of(view, tolerance, budget)
    drawn, edges, doubts = [], [], []
    own = {number: sheet for number, sheet in enumerate(sheets) if isinstance(sheet, ParametricSheet)}
    contours = contours_of_parametrised(view, own, tracing, lambda part: done(part / 2.0))
    lines_of = parameter_lines_of_parametrised(scene, own, kinds, tracing)
    for number, sheet in enumerate(sheets):
        item = scene.items[sheet.item]
        wanted = kinds_of(item, kinds)
        if isinstance(sheet, ParametricSheet):
            ready = contours[number], lines_of.get(number)
            parts, unsure = curves_of_parametrised(scene, view, sheet, number, *ready, wanted, tracing)
        else:
            parts, unsure = curves_of_implicit(scene, view, sheet, number, wanted, tracing)
        doubts += [(item.name, text) for text in unsure]
        done((1.0 + (number + 1) / (len(sheets) + 1)) / 2.0)
        lines = with_rims(view, sheets, number, parts)
        drawn += _of_kinds(lines, wanted)
        if item.hides:
            edges += _of_kinds(parts, HIDING)
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)
    met = meetings(scene, view, sheets, wants, tracing)
    doubts += met.doubts
    for number, item in enumerate(scene.items):
        wanted = kinds_of(item, kinds) & {LineKind.CURVE, LineKind.LABEL, LineKind.CENTRE, LineKind.TRACE}
        if is_curve(item.shape) and wanted:
            drawn.append(space_curve(view, item.shape, number, sheets, tracing, min(wanted)))
    all_sheets = Sheets(sheets)
    seen = [_with_images(view, together(parts)) for parts in ([*drawn, met.curves], edges)]
    curves, hiding = with_merged_families(seen, all_sheets)
    return TracedScene(all_sheets, met.meets_itself, curves, hiding, tuple(dict.fromkeys(doubts)))


def _of_kinds(parts: Sequence[Curves], kinds: Collection[LineKind]) -> list[Curves]:
    """What there is of some kinds in each of the parts that have any."""
    among = np.zeros(len(LineKind), dtype=np.bool_)
    among[list(kinds)] = True
    chosen = [(part, among[part.kind]) for part in parts if len(part)]
    return [part if wanted.all() else part.some(np.flatnonzero(wanted)) for part, wanted in chosen if wanted.any()]


def tracing_of(view: View, tolerance: float, budget: Budget = USUAL) -> Tracing:
    """How curves are traced whose chords are to be within a tolerance in the image."""
    return Tracing(tolerance=tolerance, picture=lambda points: _picture(view, points), budget=budget)


def _with_images(view: View, curves: Curves) -> Curves:
    """The curves but for those that run along sight rays, such as rulings seen end-on: their images are points."""
    if not len(curves):
        return curves
    image, first = _picture(view, curves.points), curves.offsets[:-1]
    extent = np.maximum.reduceat(image, first) - np.minimum.reduceat(image, first)
    return curves.some(np.flatnonzero((extent > view.tolerance).any(axis=1)))


def _picture(view: View, points: Floats) -> Floats:
    """(k,2) images, those far out of every picture drawn in."""
    limit = WIDEST_IMAGE * view.focus
    return np.clip(sight_lines.image(view, points), -limit, limit)
