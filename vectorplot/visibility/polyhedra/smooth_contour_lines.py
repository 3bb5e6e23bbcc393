"""Contours of polyhedra that are taken for smooth shapes: across their faces, as they are in a view.

Faces beside such a contour reach beyond it here and stay behind it there, by no more than the mesh is off the shape it
is a mesh of. So what is seen of it is what is seen of a line beside it, a little outside of all these faces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.meshes.smooth_contours import smooth_contours
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.feature_lines import sight_in_world


@dataclass(frozen=True, eq=False)
class SmoothContourLines:
    """Segments from start to end (3,s) in the view's coordinates, aside (3,s) what leads from them to the lines beside
    them, and side (s,) on which side the shape lies in the image: 1 to the left, -1 to the right."""

    start: Floats
    end: Floats
    aside: Floats
    side: Ints


def smooth_contour_lines(mesh: Mesh, view: View, crease_angle_deg: float) -> SmoothContourLines:
    """The contours across the faces of a mesh; they end at its creases."""
    found = smooth_contours(mesh, sight_in_world(view), crease_angle_deg)
    start, end = view.points_of(found.start), view.points_of(found.end)
    aside = view.points_of(found.start + found.aside) - start
    with np.errstate(divide="ignore", invalid="ignore"):
        along = view.image_of(end) - view.image_of(start)
        out = view.image_of(start + aside) - view.image_of(start)
        left = along[0] * out[1] - along[1] * out[0] > 0.0
    return SmoothContourLines(start, end, aside, np.where(left, -1, 1))
