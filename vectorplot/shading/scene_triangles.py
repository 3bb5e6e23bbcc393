"""A scene's faces as triangles ready for a depth buffer, in the coordinates of its view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.shading.corner_normals import CornerNormals, view_normals
from vectorplot.shading.screen import fans


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


def scene_triangles(view: View, normals: Sequence[Floats | None], crease_angle_deg: float) -> SceneTriangles:
    """The faces of a view; normals and crease angle as of view_normals."""
    corners, face = fans(view.corners, view.offsets)
    points = np.ascontiguousarray(view.points.T)
    return SceneTriangles(points, corners, face, view.face_item[face], view_normals(view, normals, crease_angle_deg))


def camera_in_view(view: View, camera: Camera) -> Camera:
    """The camera in view coordinates: it looks along -z, with y upwards."""
    x, y, z = view.target.tolist()
    eye = (x, y, z + 1.0) if view.eye is None else tuple(view.eye.tolist())
    height = view.picture_height if camera.parallel else None
    return replace(camera, eye=eye, target=(x, y, z), up=(0.0, 1.0, 0.0), twist_deg=0.0, height=height)
