"""What is painted, and how finely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.budget import Budget
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import Shades
from vectorplot.shading.light.fineness.faceted import FacetedScene
from vectorplot.shading.light.fineness.refinement import SHORTEST_MM, refined
from vectorplot.shading.light.painted_colours import Lighting, corner_shades_of
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.painter.painters_order import Painted
from vectorplot.visibility.painter.unseen import unseen_faces
from vectorplot.visibility.projected_faces import ProjectedFaces

OUTLINES_OFF = 3.0
"""So many tolerances outlines of faces may be off those of the surface, or off their convex hulls: sides are compared
with the surface in a few places only."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What is painted: a scene without smooth surfaces, its view, its faces in the image, the polygons of the picture
    back to front, and where the picture goes; smooth (i,): the items whose faces stand for those of smooth surfaces."""

    scene: Scene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces
    placement: Placement
    smooth: Bools


def without_unseen_facets(
    faceted: FacetedScene, view: View, projected: ProjectedFaces, painted: Painted, budget: Budget
) -> ImageFaces:
    """The polygons without those of smooth surfaces that are wholly covered; all of them where the budget does not do
    to find these."""
    smooth = smooth_items(faceted)
    pieces = np.bincount(painted.faces.source, minlength=view.face_count)
    unseen = unseen_faces(view, projected, (pieces > 0) & smooth[view.face_item], pieces > 1, budget)
    return painted.faces.some(np.flatnonzero(~unseen[painted.faces.source]))


def smooth_items(faceted: FacetedScene) -> Bools:
    """(i,) the items whose faces stand for those of a smooth surface."""
    return np.array([normals is not None for normals in faceted.normals], dtype=np.bool_)


def off_surfaces(seen: Seen, tolerance_mm: float) -> Floats:
    """(i,) how far outlines of the faces of items may be off those of the surfaces that they stand for, in the view."""
    view = seen.view
    off = np.where(seen.smooth, OUTLINES_OFF * tolerance_mm / seen.placement.scale, 0.0)
    if view.eye is None:
        return off
    nearest = np.full(len(off), view.focus)
    item = np.searchsorted(view.item_vertices, np.arange(view.points.shape[1]), side="right") - 1
    np.minimum.at(nearest, item, view.depth)
    return np.asarray(off * np.maximum(nearest, view.near) / view.focus)


def finer(seen: Seen, lighting: Lighting, most: int, error: float) -> ImageFaces:
    """The polygons, those that are shaded so small that shades are off by no more than error, or as many as may be."""
    faces = seen.faces
    shortest = SHORTEST_MM / seen.placement.scale
    points, offsets, parent = refined(
        seen.view, lighting, faces.points, faces.offsets, faces.source, shortest, most, error
    )
    if len(parent) == len(faces):
        return faces
    return ImageFaces(points, offsets, faces.planes[:, parent], faces.source[parent], faces.rank[parent])


def shades_of_faces(seen: Seen, lighting: Lighting) -> Shades:
    """What every light gives to the corners of the polygons."""
    faces = seen.faces
    points = view_points(seen.view, faces.points)
    return corner_shades_of(seen.view, lighting, points, faces.offsets, faces.source)
