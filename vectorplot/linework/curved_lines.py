"""The lines of smooth surfaces, and what these hide of all lines."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import Budget, line_each
from vectorplot.scene.scene import Scene
from vectorplot.scene.unbounded_items import tell_of_empty_surface
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.tolerances.of_extent import FINEST_CHORD_OF_EXTENT
from vectorplot.visibility.cut_edges import with_kinds_of_cuts
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.visibility.quadrics.closed_forms import ClosedForms
    from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet
    from vectorplot.visibility.smooth.tracing.traced import TracedScene


OF_F = "f is what is 0 on the contours, sections or other lines of the surface that are looked for"
"""What doubts about curves f = 0 are of, for those who asked for a picture."""


def smooth_sheets(walk: Walk, scene: Scene, view: View, forms: ClosedForms | None) -> tuple[SmoothSheet, ...]:
    """The smooth surfaces of the scene that are not drawn in closed form, if it has any."""
    if not walk.calls_for("curves"):
        return ()
    from vectorplot.visibility.smooth.tracing.traced import scene_sheets

    sheets = scene_sheets(scene, view, frozenset() if forms is None else forms.items)
    for sheet in sheets:
        if not len(sheet.corners):
            tell_of_empty_surface(scene.items[sheet.item], stacklevel=4)
    return sheets


def lines_and_chords(
    walk: Walk,
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    forms: ClosedForms | None,
    kinds: frozenset[LineKind],
    lines: Lines,
    tolerance: float,
    budget: Budget,
) -> Lines:
    """The lines and the curves of smooth surfaces, cut where one of these begins to hide them or ends, if they hide;
    those of balls as they are seen among these."""
    if not walk.calls_for("curves"):
        return lines
    from vectorplot.visibility.smooth.smooth_lines import cut_lines_and_chords, whole_lines_and_chords

    if tolerance < FINEST_CHORD_OF_EXTENT:
        text = "the picture shows so small a part of the scene that smooth curves are off by more than the tolerance"
        warnings.warn(text, InputWarning, stacklevel=3)
    tolerance = max(tolerance, FINEST_CHORD_OF_EXTENT)
    done = walk.fraction("curves")
    traced = walk.run("curves", _all_curves, scene, view, sheets, forms, kinds, tolerance, budget, done)
    if not sheets or not walk.calls_for("smooth surfaces"):
        _say(traced.doubts)
        return with_kinds_of_cuts(scene, view, whole_lines_and_chords(traced, lines), kinds)
    done = walk.fraction("smooth surfaces")
    cut, unsure = walk.run("smooth surfaces", cut_lines_and_chords, view, traced, lines, tolerance, budget, done)
    _say([*traced.doubts, *((scene.items[item].name, text) for item, text in unsure)])
    cut = replace(cut, behind=np.where(cut.kind == LineKind.CENTRE, 0, cut.behind))
    cut = with_kinds_of_cuts(scene, view, cut, kinds)
    return cut if not walk.calls_for("visible lines") else cut.some(cut.behind == 0)


def _say(doubts: Iterable[tuple[str, str]]) -> None:
    """An InputWarning for each item, or items, of which something is in doubt, given by name."""
    told = ((name, f"{text} ({OF_F})" if text.startswith("f ") else text) for name, text in doubts)
    for line in line_each(told):
        warnings.warn(line, InputWarning, stacklevel=4)


def _all_curves(
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    forms: ClosedForms | None,
    kinds: frozenset[LineKind],
    tolerance: float,
    budget: Budget,
    done: Callable[[float], None],
) -> TracedScene:
    """The curves of sheets, the arcs of what is drawn in closed form, and the curves in which the latter meet that are
    no arcs."""
    from vectorplot.visibility.smooth.tracing.traced import traced_scene, tracing_of

    traced = traced_scene(scene, view, sheets, kinds, tolerance, budget, done)
    if forms is None:
        return traced
    from vectorplot.visibility.quadrics.conic_curves import conic_curves

    traced = traced.joined(conic_curves(view, forms.arcs, forms.behind, tolerance))
    if not len(forms.traced) and not len(forms.in_faces):
        return traced
    from vectorplot.visibility.quadrics.traced_meetings import traced_meetings

    met, doubts = traced_meetings(scene, view, forms, kinds, tracing_of(view, tolerance, budget))
    return replace(traced.joined(met), doubts=(*traced.doubts, *doubts))
