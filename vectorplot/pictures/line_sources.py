"""What the lines of a scene are traced on as a view shows it, and what is seen of them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.duplicates import with_shared_kinds
from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import Budget, line_each
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.scene.added_lines import lamps_of
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.item import Item
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene, tell_of_empty_surface
from vectorplot.scene.view import View
from vectorplot.tolerances import FINEST_CHORD_OF_EXTENT
from vectorplot.visibility.polyhedra.hidden_lines import (
    Segments,
    Visibility,
    counted_parts,
    unhidden,
    visible_parts,
    with_whole_lines,
)
from vectorplot.visibility.polyhedra.lines import (
    Lines,
    edge_lines,
    in_frame,
    inside,
    intersection_lines,
    joined_lines,
    mesh_curve_lines,
    pattern_lines,
    with_kinds_of_cuts,
)
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.effects.light_lines import LightLines
    from vectorplot.visibility.quadrics.closed_forms import ClosedForms, Seen
    from vectorplot.visibility.smooth.intersections import SmoothSheet
    from vectorplot.visibility.smooth.scene_curves import TracedScene
    from vectorplot.visibility.smooth.traced_curves import Curves


# The lines of smooth surfaces, and what these hide of all lines.

OF_F = "f is what is 0 on the contours, sections or other lines of the surface that are looked for"
"""What doubts about curves f = 0 are of, for those who asked for a picture."""


def smooth_sheets(pipeline: Pipeline, scene: Scene, view: View, forms: ClosedForms | None) -> tuple[SmoothSheet, ...]:
    """The smooth surfaces of the scene that are not drawn in closed form, if it has any."""
    if not pipeline.calls_for("curves"):
        return ()
    from vectorplot.visibility.smooth.scene_curves import scene_sheets

    sheets = scene_sheets(scene, view, frozenset() if forms is None else forms.items)
    for sheet in sheets:
        if not len(sheet.corners):
            tell_of_empty_surface(scene.items[sheet.item], stacklevel=4)
    return sheets


def lines_and_chords(
    pipeline: Pipeline,
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    forms: ClosedForms | None,
    kinds: frozenset[LineKind],
    lines: Lines,
    further: Curves | None,
    tolerance: float,
    budget: Budget,
) -> Lines:
    """The lines and the curves of smooth surfaces, and further ones, cut where one of these begins to hide them or
    ends, if they hide; those of balls as they are seen among these."""
    if not pipeline.calls_for("curves"):
        return lines
    from vectorplot.visibility.smooth.hidden_curves import cut_lines_and_chords, whole_lines_and_chords

    if tolerance < FINEST_CHORD_OF_EXTENT:
        text = "the picture shows so small a part of the scene that smooth curves are off by more than the tolerance"
        warnings.warn(text, InputWarning, stacklevel=3)
    tolerance = max(tolerance, FINEST_CHORD_OF_EXTENT)
    done = pipeline.fraction("curves")
    traced = pipeline.run("curves", _all_curves, scene, view, sheets, forms, kinds, tolerance, budget, done)
    traced = traced if further is None else traced.joined(further)
    if not sheets or not pipeline.calls_for("smooth surfaces"):
        _say(traced.doubts)
        return with_kinds_of_cuts(scene, view, whole_lines_and_chords(traced, lines), kinds)
    done = pipeline.fraction("smooth surfaces")
    cut, unsure = pipeline.run("smooth surfaces", cut_lines_and_chords, view, traced, lines, tolerance, budget, done)
    _say([*traced.doubts, *((scene.items[item].name, text) for item, text in unsure)])
    cut = replace(cut, behind=np.where(cut.kind == LineKind.CENTRE, 0, cut.behind))
    cut = with_kinds_of_cuts(scene, view, cut, kinds)
    return cut if not pipeline.calls_for("visible lines") else cut.take(cut.behind == 0)


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
    from vectorplot.visibility.smooth.scene_curves import traced_scene, tracing_of

    traced = traced_scene(scene, view, sheets, kinds, tolerance, budget, done)
    if forms is None:
        return traced
    from vectorplot.visibility.quadrics.conic_arcs import conic_curves

    traced = traced.joined(conic_curves(view, forms.arcs, forms.behind, tolerance))
    if not len(forms.traced) and not len(forms.in_faces):
        return traced
    from vectorplot.visibility.quadrics.traced_intersections import traced_meetings

    met, doubts = traced_meetings(scene, view, forms, kinds, tracing_of(view, tolerance, budget))
    return replace(traced.joined(met), doubts=(*traced.doubts, *doubts))


# Spheres, ellipsoids and capped bodies among what is drawn: their lines, and what they hide, in closed form.


def balls(pipeline: Pipeline, scene: Scene, view: View, kinds: frozenset[LineKind]) -> ClosedForms | None:
    """The spheres and ellipsoids of the scene, if it has any, and their lines as they are seen among them."""
    if not pipeline.calls_for("balls"):
        return None
    from vectorplot.visibility.quadrics.closed_forms import closed_forms

    hidden_too = not pipeline.calls_for("visible lines")
    return pipeline.run(
        "balls", closed_forms, scene, view, kinds, _seen_among_balls(pipeline, "balls", view), hidden_too
    )


def _seen_among_balls(pipeline: Pipeline, stage: str, view: View) -> Seen:
    """What becomes of the arcs on balls: all of them, the visible parts, or all parts counted."""
    from vectorplot.visibility.quadrics import hidden_intervals

    if pipeline.calls_for("all lines"):
        return lambda bodies, arcs, sides: unhidden(arcs)
    done = pipeline.fraction(stage)
    if pipeline.calls_for("visible lines"):
        return partial(hidden_intervals.visible_arcs, progress=done)
    return partial(hidden_intervals.counted_arcs, items=len(view.occludes), progress=done)


def behind_balls(pipeline: Pipeline, view: View, forms: ClosedForms | None, lines: Lines) -> Lines:
    """The lines cut where spheres and ellipsoids begin or end to hide them, if there are any."""
    if forms is None or not pipeline.calls_for("behind balls"):
        return lines
    from vectorplot.visibility.quadrics.closed_forms import lines_behind

    seen = _seen_among_balls(pipeline, "behind balls", view)
    over = lines.kind == LineKind.CENTRE
    cut = pipeline.run("behind balls", lines_behind, view, forms, lines.take(~over), seen)
    return joined_lines((cut, lines.take(over))) if over.any() else cut


# Which parts of lines are seen.


def seen_parts(pipeline: Pipeline, view: View, faces: ProjectedFaces, solid: Bools, lines: Lines) -> Visibility:
    """The visible parts of lines, all their parts counted, or whole lines, as the plan has it."""
    if pipeline.calls_for("all lines"):
        return pipeline.run("all lines", unhidden, lines)
    over = lines.kind == LineKind.CENTRE
    if over.any():
        rest = seen_parts(pipeline, view, faces, solid, lines.take(~over))
        return with_whole_lines(rest, over)
    segments = Segments(lines.start + lines.aside, lines.end + lines.aside)
    if pipeline.calls_for("visible lines"):
        return pipeline.run(
            "visible lines", visible_parts, view, faces, solid, segments, pipeline.fraction("visible lines")
        )
    seen = pipeline.run(
        "counted lines", counted_parts, view, faces, solid, segments, pipeline.fraction("counted lines")
    )
    return replace(seen, hidden_by=seen.hidden_by + lines.behind[seen.segment])


# The lines of polyhedra.


def straight_lines(
    pipeline: Pipeline,
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    solid: Bools,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    budget: Budget,
) -> Lines:
    """The lines of polyhedra."""
    found = []
    backs = ~solid if pipeline.calls_for("visible lines") else np.ones(len(solid), dtype=np.bool_)
    if pipeline.calls_for("edges"):
        found.append(pipeline.run("edges", edge_lines, scene, view, faces, kinds, crease_angle_deg, backs))
    if pipeline.calls_for("intersections"):
        found.append(pipeline.run("intersections", intersection_lines, scene, view, faces, kinds, solid, backs))
    if pipeline.calls_for("patterns"):
        found.append(pipeline.run("patterns", pattern_lines, scene, view, kinds))
    if pipeline.calls_for("lines on meshes"):
        done = pipeline.fraction("lines on meshes")
        how = (kinds, crease_angle_deg, budget, done)
        found.append(pipeline.run("lines on meshes", mesh_curve_lines, scene, view, *how))
    return with_kinds_of_cuts(scene, view, with_shared_kinds(view, joined_lines(found)), kinds)


# What the lines of a scene are traced on, as a view shows it.


@dataclass(frozen=True, eq=False)
class LineSources:
    """A scene in a view, for lines of some kinds: the faces of its polyhedra, which of its items are solid (i,), its
    balls, if it has any, its other smooth surfaces; and the lines of its polyhedra, which no tolerance changes, but the
    angle of creases."""

    pipeline: Pipeline
    scene: Scene
    view: View
    kinds: frozenset[LineKind]
    faces: ProjectedFaces
    solid: Bools
    straight: Lines
    balls: ClosedForms | None
    sheets: tuple[SmoothSheet, ...]
    crease_angle_deg: float

    @property
    def reached(self) -> Floats:
        """(3,n) points in whose box all of it is."""
        balls = () if self.balls is None else (self.balls.reached,)
        return np.concatenate([self.view.points, *balls, *(sheet.vertices.T for sheet in self.sheets)], axis=1)

    def lines(self, tolerance: float, budget: Budget) -> Lines:
        """All lines, curves as chords within a tolerance in the unit box."""
        straight, curves = self.straight, None
        if self.pipeline.calls_for("light and dark"):
            found = self.pipeline.run("light and dark", _light_and_dark, self, tolerance, budget)
            straight, curves = joined_lines((straight, found.straight)), found.curves
        smooth = (self.sheets, self.balls, self.kinds, straight, curves)
        return lines_and_chords(self.pipeline, self.scene, self.view, *smooth, tolerance, budget)

    def framed(self, lines: Lines, place: Placement | None) -> Lines:
        """What of lines is before the eye and, where the picture has its place, inside of it; cut where balls begin to
        hide them."""
        return self.before_balls(self.pipeline.run("frame", in_frame, self.view, lines, place))

    def before_balls(self, lines: Lines) -> Lines:
        """Lines cut where balls begin to hide them."""
        return behind_balls(self.pipeline, self.view, self.balls, lines)

    def seen(self, lines: Lines) -> Visibility:
        """Which parts of framed lines are seen."""
        return seen_parts(self.pipeline, self.view, self.faces, self.solid, lines)


def traceable(
    pipeline: Pipeline,
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    budget: Budget,
) -> LineSources:
    """What lines of these kinds are traced on. view: of the scene; faces: of that; budget: of shortest ways."""
    solid = solid_items(view, faces)
    straight = straight_lines(pipeline, scene, view, faces, solid, kinds, crease_angle_deg, budget)
    round_bodies = balls(pipeline, scene, view, kinds)
    sheets = smooth_sheets(pipeline, scene, view, round_bodies)
    return LineSources(pipeline, scene, view, kinds, faces, solid, straight, round_bodies, sheets, crease_angle_deg)


# Lines between light and dark: what lamps see.

BORDERS = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY})
"""The lines in which the image of a thing can end."""


def outlined(item: Item, asking: bool) -> Item:
    """An item with all its borders if it asks for an outline; one that draws and hides nothing otherwise."""
    if not asking or is_annotation(item):
        return replace(item, lines=(), occludes=False)
    curves = replace(item.curves, smooth_contours=False)
    bare = replace(item, drawn_edges=None, added_edges=None, tangent_edges=None)
    return replace(bare, lines=None, occludes=True, curves=curves)


FROM_LAMPS = 0.25
"""Chords of outlines that lamps see are off them by this part of what lines may be off on the page: their shadows may
be larger than they are."""


def _in_light(item: Item, across: bool) -> Item:
    """An item with all its borders, hiding what is behind it if it throws a shadow; across: its contours run across its
    faces where it asks for such."""
    found = outlined(item, not is_curve(item.shape))
    curves = replace(item.curves, smooth_contours=across and item.curves.smooth_contours)
    return replace(found, curves=curves, occludes=found.hides and item.casts_shadow)


def _light_and_dark(shapes: LineSources, tolerance: float, budget: Budget) -> LightLines:
    """The lines between light and dark of a scene, chords of curves within a tolerance in the unit box."""
    from vectorplot.effects.light_lines import LampPicture, light_lines
    from vectorplot.visibility.smooth.sheets import Sheets

    scene, fine = shapes.scene, max(FROM_LAMPS * tolerance, FINEST_CHORD_OF_EXTENT)

    def seen_from(view: View, planes: Floats, across: bool) -> LampPicture:
        alone = replace(scene, items=tuple(_in_light(item, across) for item in scene.items))
        stages = [stage for stage in plan_draw(alone, BORDERS, "none", 0.0) if "balls" not in stage.name]
        own = traceable(Pipeline(stages, None, None), alone, view, project_faces(view), BORDERS, 180.0, budget)
        lines = own.lines(fine, budget)
        low, high = inside(planes, lines.start, lines.end)
        kept = np.flatnonzero(low < high)
        lines = lines.cut(view, kept, low[kept], high[kept])
        seen = own.seen(lines)
        return LampPicture(lines.cut(view, seen.segment, seen.low, seen.high), own.faces, own.solid, Sheets(own.sheets))

    lamps = lamps_of(scene, shapes.view)
    sheets = Sheets(shapes.sheets)
    with warnings.catch_warnings():
        # What is in doubt about surfaces is told when they are drawn.
        warnings.simplefilter("ignore", InputWarning)
        return light_lines(scene, shapes.view, shapes.faces, sheets, lamps, shapes.kinds, seen_from, tolerance, budget)
