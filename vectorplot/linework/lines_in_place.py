"""The visible lines of a scene on a picture that has its place already, for paintings, pixels and panoramas."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.geometry.budget import budget_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.linework.placed_lines import PlacedLines
from vectorplot.linework.traceable import traceable
from vectorplot.plan import plan_draw
from vectorplot.scene.placement import Placement
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
