"""The visible lines of a scene on a picture that has its place already, for paintings, pixels and panoramas."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.drawing import Paths
from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import budget_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.linework.placed_lines import PlacedLines
from vectorplot.linework.traceable import traceable
from vectorplot.plan import plan_draw
from vectorplot.scene.naming.annotations import annotation_points, is_annotation
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, box_corners, mm_per_image
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.stages.walk import Walk
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import LineKind


def with_smooth_surfaces(scene: Scene, view: View, faces: ProjectedFaces | None) -> tuple[View, ProjectedFaces]:
    """The view of a scene, and its faces in the image, in the projection of a view of it that has triangles in place of
    smooth surfaces: the same where there are none. faces: of that view, where they are known."""
    if not all(isinstance(item.shape, Mesh) for item in scene.items):
        view, faces = view_of(scene, view), None
    view = replace(view, occludes=np.array([item.hides for item in scene.items], dtype=np.bool_))
    return view, project_faces(view) if faces is None else faces


def places_beside_faces(
    scene: Scene,
    view: View,
    faces: ProjectedFaces | None,
    page: Page,
    fit: bool,
    kinds: frozenset[LineKind],
    tolerance_mm: float,
    budget: float,
) -> Floats:
    """(n,3) places in the world that a picture of faces has to fit besides these: those of annotations, and of what is
    seen of the other curves of a scene where lines of some kinds are drawn on top.

    view: of the scene, surfaces as triangles; faces: its faces in the image, where they are known; page, fit: of the
    picture; tolerance_mm: as of draw. Curves that reach too far to be fitted are there as a whole.
    """
    notes = annotation_points(scene)
    curves = [is_curve(item.shape) and not is_annotation(item) for item in scene.items]
    if not fit or not kinds or not any(curves):
        return notes
    items = (item if one else replace(item, lines=()) for item, one in zip(scene.items, curves, strict=True))
    alone = replace(scene, items=tuple(items))
    view, faces = with_smooth_surfaces(alone, view, faces)
    scale = mm_per_image(view, view.points_of(np.concatenate([scene.vertices, box_corners(scene.bounds)])), page, fit)
    allowed = budget_of(budget)
    with warnings.catch_warnings():
        # They are told when the lines are drawn.
        warnings.simplefilter("ignore", InputWarning)
        shapes = traceable(
            Walk(plan_draw(alone, kinds, "none", 0.0), None, None), alone, view, faces, kinds, 180.0, allowed
        )
        every = shapes.lines(0.5 * tolerance_mm / scale, allowed)
    if view.reaches_too_far(every.start, every.end):
        return np.concatenate([notes, view.world_of(np.concatenate([every.start, every.end], axis=1))])
    framed = shapes.framed(every, None)
    seen = shapes.seen(framed)
    ends = np.concatenate(framed.ends(view, seen.segment, seen.low, seen.high), axis=1)
    return np.concatenate([notes, view.world_of(ends)])


def lines_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    kinds: frozenset[LineKind],
    *,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
    progress: Callable[[float], None] | None = None,
) -> Paths:
    """The visible parts of the lines of a scene, as they come, where a picture of it already has its place on the page.

    view: of the scene, in the projection of the picture; progress(fraction) is called while it works. All else as of
    draw.
    """
    told = None if progress is None else lambda stage, fraction: progress(fraction)
    walk = Walk(plan_draw(scene, kinds, "none", 0.0), None, told)
    allowed = budget_of(budget)
    shapes = traceable(walk, scene, view, faces, kinds, crease_angle_deg, allowed)
    every = shapes.lines(0.5 * tolerance_mm / placement.scale, allowed)
    # Lines may reach too far where what the picture was fitted to does not.
    cut = not placement.whole or view.reaches_too_far(every.start, every.end)
    framed = shapes.framed(every, placement if cut else None)
    return PlacedLines(shapes, framed, shapes.seen(framed), placement).strokes()
