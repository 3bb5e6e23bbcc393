"""The lines of polyhedra."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools
from vectorplot.drawing.strokes.duplicates.shared_kinds import with_shared_kinds
from vectorplot.geometry.budget import Budget
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.visibility.cut_edges import with_kinds_of_cuts
from vectorplot.visibility.polyhedra.lines import (
    Lines,
    edge_lines,
    intersection_lines,
    joined_lines,
    mesh_curve_lines,
    pattern_lines,
)
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import LineKind


def straight_lines(
    walk: Walk,
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
    backs = ~solid if walk.calls_for("visible lines") else np.ones(len(solid), dtype=np.bool_)
    if walk.calls_for("edges"):
        found.append(walk.run("edges", edge_lines, scene, view, faces, kinds, crease_angle_deg, backs))
    if walk.calls_for("intersections"):
        found.append(walk.run("intersections", intersection_lines, scene, view, faces, kinds, solid, backs))
    if walk.calls_for("patterns"):
        found.append(walk.run("patterns", pattern_lines, scene, view, kinds))
    if walk.calls_for("lines on meshes"):
        done = walk.fraction("lines on meshes")
        how = (kinds, crease_angle_deg, budget, done)
        found.append(walk.run("lines on meshes", mesh_curve_lines, scene, view, *how))
    return with_kinds_of_cuts(scene, view, with_shared_kinds(view, joined_lines(found)), kinds)
