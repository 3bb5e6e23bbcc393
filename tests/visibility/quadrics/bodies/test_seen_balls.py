"""Contours, polar planes and sections of balls in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import ball_of, bounds_of_balls
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Ellipsoid, Sphere
from vectorplot.visibility.quadrics.bodies import balls_of

SHEARED = np.array([[1.0, 0.2, 0.0], [0.0, 0.8, -0.3], [0.4, 0.0, 1.2]])
SHAPES = [
    Sphere(1.3, (2, -1, 0.5)),
    Ellipsoid((1, 2, 0.7), (-1, 3, 1)),
    PlacedSurface(Ellipsoid((1, 2, 0.7)), SHEARED, (0.5, 0.5, -2)),
    PlacedSurface(PlacedSurface(Sphere(0.8, (1, 1, 1)), SHEARED, (3, 0, 0)), np.diag([1.0, -1.0, 1.0])),
]


def balls(parallel):
    items = [Item(str(k), shape) for k, shape in enumerate(SHAPES)]
    view = look(Scene(tuple(items)), Camera(eye=(20, -14, 9), parallel=parallel))
    return balls_of(view, items, np.arange(len(items)), [ball_of(shape) for shape in SHAPES])


def test_points_of_the_surface_are_those_of_the_ball():
    u, v = np.random.default_rng(1).uniform((0.0, -1.5), (6.2, 1.5), (50, 2)).T
    unit = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=1)
    for shape in SHAPES:
        ball = ball_of(shape)
        assert shape.points(u, v) == pytest.approx(ball.centre + unit @ ball.frame, abs=1e-13)


def test_bounds_are_reached_and_not_left():
    u, v = (
        grid.ravel() for grid in np.meshgrid(np.linspace(0, 2 * np.pi, 401), np.linspace(-np.pi / 2, np.pi / 2, 201))
    )
    for shape, (low, high) in zip(SHAPES, bounds_of_balls([ball_of(s) for s in SHAPES]), strict=True):
        points = shape.points(u, v)
        assert (points >= low - 1e-12).all() and (points <= high + 1e-12).all()
        assert points.min(axis=0) == pytest.approx(low, abs=1e-3) and points.max(axis=0) == pytest.approx(
            high, abs=1e-3
        )


def test_what_is_no_whole_ball_is_none():
    assert ball_of(Cylinder()) is None
    assert ball_of(PlacedSurface(Cylinder(), SHEARED)) is None


@pytest.mark.parametrize("parallel", [False, True])
def test_sight_rays_touch_the_ball_along_its_contour_and_in_its_polar_plane(parallel):
    found = balls(parallel)
    which = np.arange(len(found))
    middle, first, second = found.contours(which)
    planes = found.polar_planes(which)
    for t in np.linspace(0.0, 6.0, 7):
        points = middle + np.cos(t) * first + np.sin(t) * second
        s = np.einsum("ni,nij->nj", points - found.centre, found.inverse)
        assert (s * s).sum(axis=1) == pytest.approx(1.0, abs=1e-12)
        towards = found.eye if parallel else found.eye - s
        assert (s * towards).sum(axis=1) == pytest.approx(0.0, abs=1e-10)
        assert (planes[:, :3] * points).sum(axis=1) + planes[:, 3] == pytest.approx(0.0, abs=1e-12)
    # The plane is positive where the eye is.
    eye = np.array([0.0, 0.0, -1e6 if parallel else 0.0])
    assert (planes[:, :3] @ eye + planes[:, 3] > 0.0).all()


def test_equal_balls_have_one_number():
    shapes = [Sphere(1.0), Ellipsoid((1, 1, 1)), Sphere(1.0, (0, 0, 1e-3)), PlacedSurface(Sphere(0.5), 2.0 * np.eye(3))]
    items = [Item(str(k), shape) for k, shape in enumerate(shapes)]
    view = look(Scene(tuple(items)), Camera(eye=(20, -14, 9)))
    found = balls_of(view, items, np.arange(4), [ball_of(shape) for shape in shapes])
    assert found.same.tolist() == [0, 0, 2, 0]
