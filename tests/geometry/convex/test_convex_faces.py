"""Polygons that are not convex as triangles that are."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.draw import draw
from vectorplot.testing import assert_drawings_equal
from vectorplot.testing.shapes import box, scene_of

OUTER = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
HOLE = [(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]


def test_a_hole_on_a_bridge_of_no_width_is_a_hole() -> None:
    plate = Mesh.from_polygons(OUTER + HOLE, [[0, 1, 2, 3, 0, 4, 7, 6, 5, 4]])
    cut = convex_faces(np.ascontiguousarray(plate.vertices.T), plate.corners, plate.offsets, 1e-9)
    areas = np.linalg.norm(Mesh(plate.vertices, cut.corners, cut.offsets).area_vectors, axis=1) / 2.0
    assert areas.sum() == pytest.approx(3.0)
    assert (~cut.inner).sum() == 8, "four sides outside, four inside, and not the bridge"
    frame = Mesh.from_polygons(OUTER + HOLE, [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    behind = box((-0.8, -0.3, -1), (0.8, 0.3, -0.5))
    lines = ("contour", "boundary", "crease")
    for camera in (Camera((1, -2, 7)), Camera((2, 1, 5), parallel=True)):
        pair = [draw(scene_of(P=p, BOX=behind), camera, hidden="solid", lines=lines) for p in (plate, frame)]
        assert_drawings_equal(*pair, 1e-6)


def test_a_polygon_that_crosses_itself_is_reported() -> None:
    star = [(np.cos(a), np.sin(a), 0.0) for a in 4.0 * np.pi * np.arange(5) / 5]
    with pytest.warns(InputWarning, match="1 faces cross themselves"):
        cut = convex_faces(np.array(star).T.copy(), np.arange(5), np.array([0, 5]), 1e-9)
    assert len(cut.offsets) == 4
