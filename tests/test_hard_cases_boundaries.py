"""The hard cases 71 and 73 through the front door: faces that meet only at vertices, and seams of arrays."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn import drawn

import vectorplot as vp
from vectorplot.testing import assert_drawing_is_right, assert_drawings_equal, edge_points
from vectorplot.testing.shapes import box, quads, scene_of

CAMERA = vp.Camera((5, -7, 4), (0, 0, 0))


def board(size: int, black: np.ndarray) -> vp.Mesh:
    """The squares of a board that are black (size * size,)."""
    line = np.linspace(-1.0, 1.0, size + 1)
    y, x = np.meshgrid(line, line, indexing="ij")
    cells = quads(size + 1, size + 1)[black]
    return vp.Mesh(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), cells.ravel(), np.arange(0, cells.size + 1, 4))


@pytest.mark.hard(71)
@pytest.mark.parametrize("size", [2, 3, 5, 8, 13, 40])
def test_a_checkerboard_shows_the_edges_of_all_its_squares(size: int) -> None:
    black = np.indices((size, size)).sum(axis=0).ravel() % 2 == 0
    found = drawn(vp.draw(scene_of(BOARD=board(size, black)), CAMERA))
    assert np.isclose(found.length, 4.0 * black.sum() * 2.0 / size, rtol=1e-9)


@pytest.mark.hard(71)
def test_holes_that_touch_diagonally_show_all_their_edges_as_rays_see_them() -> None:
    black = np.ones((9, 9), dtype=np.bool_)
    for k in range(1, 8):
        black[k, k] = black[k, 8 - k] = False
    scene = scene_of(BOARD=board(9, black.ravel()), BALL=box((-0.2, -0.3, -0.6), (0.3, 0.2, -0.2)))
    drawing = vp.draw(scene, CAMERA, lines=("contour", "boundary", "crease", "edges", "intersection"), hidden="solid")
    points, _ = edge_points(scene, 400)
    assert assert_drawing_is_right(drawing, scene, CAMERA, samples=400, must_show=points) > 300


@pytest.mark.hard(73)
@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_a_cube_whose_faces_have_vertices_of_their_own_is_a_cube(verb: str) -> None:
    cube = box((-1, -1, -1), (1, 1, 1))
    split = vp.Mesh(cube.vertices[cube.corners], np.arange(24), cube.offsets)
    one, two = (getattr(vp, verb)(scene_of(CUBE=mesh), CAMERA, lines=("contour", "boundary")) for mesh in (split, cube))
    assert_drawings_equal(one, two)
    assert len(drawn(one).of_kind("boundary")) == 0
