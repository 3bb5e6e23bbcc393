"""A scene's faces as triangles ready for a depth buffer, in the coordinates of its view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.shading.light.corner_normals import CornerNormals, TrueNormals, view_normals


@dataclass(frozen=True, eq=False)
class SceneTriangles:
    """points (n, 3) in view coordinates; corners (t, 3) of them; face (t,) of the view, item (t,); normals: of the
    corners."""

    points: Floats
    corners: Ints
    face: Ints
    item: Ints
    normals: CornerNormals

    def __len__(self) -> int:
        return len(self.corners)


def scene_triangles(view: View, normals: Sequence[TrueNormals | None], crease_angle_deg: float) -> SceneTriangles:
    """The faces of a view; normals and crease angle as of view_normals."""
    fans, face = ragged.fans(view.offsets)
    points = np.ascontiguousarray(view.points.T)
    corner_normals = view_normals(view, normals, crease_angle_deg)
    return SceneTriangles(points, view.corners[fans], face, view.face_item[face], corner_normals)
