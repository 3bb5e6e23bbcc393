"""Items of grids, functions and thick curves."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle, Helix, Line

TURN, HEIGHT = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 25), np.linspace(-np.pi / 2, np.pi / 2, 13))
BALL = (np.cos(HEIGHT) * np.cos(TURN), np.cos(HEIGHT) * np.sin(TURN), np.sin(HEIGHT))


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_seams_and_poles_of_a_grid_are_welded(size):
    mesh = vp.surface(*(size * axis for axis in BALL)).mesh
    assert mesh.is_closed
    assert (len(mesh.vertices), mesh.face_count) == (24 * 11 + 2, 24 * 12)
    assert set(mesh.face_sizes.tolist()) == {3, 4}


def test_a_grid_may_have_holes_and_be_given_by_its_sides():
    heights = np.add.outer(np.arange(4.0), np.arange(5.0))
    heights[1, 1] = np.nan
    item = vp.surface(np.arange(5), np.arange(4), heights, "green", "hill")
    assert (item.mesh.face_count, item.colour, item.name) == (12 - 4, "green", "hill")
    assert item.mesh.bounds.tolist() == [[0, 0, 2], [4, 3, 7]]
    for bad in (np.zeros(4), np.zeros((3, 3)), np.full((4, 5), np.nan)):
        with pytest.raises(vp.InputError, match="surface: "):
            vp.surface(np.arange(5), np.arange(4), bad)


def test_rows_and_columns_that_were_mistaken_are_told():
    with pytest.raises(vp.InputError, match=r"\(5, 4\) are no grid: expected z \(4, 5\), a row for each y"):
        vp.surface(np.arange(5), np.arange(4), np.zeros((5, 4)))


def test_a_graph_has_the_lines_of_its_samples():
    item = vp.graph(lambda x, y: x * y, (0, 2), np.linspace(-1, 1, 5))
    assert (item.curves.columns, item.curves.rows) == (20, 4)
    assert vp.Scene((item,)).bounds.round(6).tolist() == [[0, -1, -2], [2, 1, 2]]
    with pytest.raises(vp.InputError, match="where x and y begin"):
        vp.graph(lambda x, y: x, (0,), (1, 2))


@pytest.mark.parametrize(
    "curve", [Circle(radius=3.0), Helix(radius=3.0, rise=0.5, end=9.0), Line((0, 0, 0), (1, 2, 3))]
)
def test_a_tube_is_as_far_from_its_curve_everywhere_and_shows_its_outside(curve):
    shape = vp.tube(curve, 0.5).shape
    u, v = (axis.ravel() for axis in np.meshgrid(*shape.domain.grid(8, 40)))
    out = shape.points(u, v) - curve.points(v)
    assert np.abs(np.linalg.norm(out, axis=1) - 0.5).max() < 1e-12
    assert np.abs((out * curve.tangents(v)).sum(axis=1)).max() < 1e-10
    by_u, by_v = shape.partials(u, v)
    normal = np.cross(by_u, by_v)
    assert (np.einsum("ij,ij->i", normal, out) > 0.999 * 0.5 * np.linalg.norm(normal, axis=1)).all()
    assert (shape.domain.closed_u, shape.domain.closed_v) == (True, curve.closed)


def test_a_tube_needs_a_radius_and_a_curve_that_goes_on():
    for radius in (0.0, -1.0, np.nan):
        with pytest.raises(vp.InputError, match="radius"):
            vp.tube(Circle(), radius)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_tube_about_points_that_come_back_is_a_ring_whatever_rounding_left(size):
    turn = np.linspace(0.0, 2.0 * np.pi, 25)
    points = size * np.stack([3.0 * np.cos(turn), 3.0 * np.sin(turn), 0.0 * turn], axis=1)
    assert (points[0] != points[-1]).any()
    assert vp.tube(points, 0.5 * size).shape.domain.closed_v
    assert not vp.tube(points[:-1], 0.5 * size).shape.domain.closed_v
