"""Spheres, ellipsoids and capped bodies among what is drawn: their lines, and what they hide, in closed form."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.visibility.polyhedra.lines import Lines, joined_lines
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.visibility.quadrics.closed_forms import ClosedForms, Seen


def balls(walk: Walk, scene: Scene, view: View, kinds: frozenset[LineKind]) -> ClosedForms | None:
    """The spheres and ellipsoids of the scene, if it has any, and their lines as they are seen among them."""
    if not walk.calls_for("balls"):
        return None
    from vectorplot.visibility.quadrics.closed_forms import closed_forms

    hidden_too = not walk.calls_for("visible lines")
    return walk.run("balls", closed_forms, scene, view, kinds, _seen_among_balls(walk, "balls", view), hidden_too)


def _seen_among_balls(walk: Walk, stage: str, view: View) -> Seen:
    """What becomes of the arcs on balls: all of them, the visible parts, or all parts counted."""
    from vectorplot.visibility.quadrics import hidden_arcs

    if walk.calls_for("all lines"):
        return lambda bodies, arcs, sides: hidden_arcs.whole_arcs(arcs)
    done = walk.fraction(stage)
    if walk.calls_for("visible lines"):
        return partial(hidden_arcs.visible_arcs, progress=done)
    return partial(hidden_arcs.counted_arcs, items=len(view.occludes), progress=done)


def behind_balls(walk: Walk, view: View, forms: ClosedForms | None, lines: Lines) -> Lines:
    """The lines cut where spheres and ellipsoids begin or end to hide them, if there are any."""
    if forms is None or not walk.calls_for("behind balls"):
        return lines
    from vectorplot.visibility.quadrics.closed_forms import lines_behind

    seen = _seen_among_balls(walk, "behind balls", view)
    over = lines.kind == LineKind.CENTRE
    cut = walk.run("behind balls", lines_behind, view, forms, lines.some(~over), seen)
    return joined_lines((cut, lines.some(over))) if over.any() else cut
