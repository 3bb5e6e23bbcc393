import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.effects.refraction import (
    SightWays,
    plate_shift,
    seen_in_surface,
    tangents_of_rays,
    traced,
    virtual_points,
)
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box

WATER = 4.0 / 3.0
DOWN = np.array([0.0, 0.0, -1.0])


def view_of(eye: tuple[float, float, float], parallel: bool = False) -> View:
    """A view of the cube of side 2 about the origin: one unit of the world is one of the view."""
    scene = Scene((Item("A", box((-1, -1, -1), (1, 1, 1))),))
    return look(scene, Camera(eye=eye, parallel=parallel))


def horizontal(view: View, *surfaces: tuple[float, float]) -> SightWays:
    """Surfaces at some heights in the world, with constants, passed downwards."""
    normal = np.repeat((view.axes @ DOWN)[:, None], len(surfaces), axis=1)
    point = view.points_of(np.array([(0.0, 0.0, height) for height, _ in surfaces]))
    return SightWays(normal[..., None], point[..., None], np.array([constant for _, constant in surfaces]))


def in_world(view: View, points: np.ndarray) -> np.ndarray:
    return view.world_of(points)


POINT = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, -1e-3))


@pytest.mark.capability("G6.6-pool")
@given(POINT, st.floats(1.01, 2.5), st.floats(0.5, 6.0))
def test_points_in_water_are_seen_where_the_inverse_refraction_says(
    point: tuple[float, float, float], c: float, high: float
) -> None:
    eye = (2.0, -3.0, high)
    view = view_of(eye)
    points = np.array([point])
    virtual, seen = virtual_points(view, horizontal(view, (0.0, c)), view.points_of(points))
    assert seen.all()
    surface = seen_in_surface(eye, points, (0, 0, 1), (0, 0, 0), c)
    assert np.allclose(view.image_of(virtual), view.image_of(view.points_of(surface)), atol=1e-12)
    # As far behind the surface as light takes time to go there.
    below = np.linalg.norm(in_world(view, virtual) - surface)
    assert np.isclose(below, np.linalg.norm(points - surface) / c, atol=1e-12)


@pytest.mark.slow
@pytest.mark.capability("G6.6-solid")
@given(POINT, st.floats(1.01, 2.5), st.floats(0.05, 0.6))
def test_a_plane_parallel_block_shifts_as_the_formula_of_plates_says(
    point: tuple[float, float, float], c: float, thick: float
) -> None:
    eye = np.array([2.0, -3.0, 4.0])
    view = view_of(tuple(eye))
    target = np.array([[point[0], point[1], point[2] - thick]])
    block = horizontal(view, (0.0, c), (-thick, 1.0 / c))
    virtual, seen = virtual_points(view, block, view.points_of(target))
    assert seen.all()
    far = np.hypot(*(target[0, :2] - eye[:2]))
    # Above and below the block the ray has one direction: all the air counts as if it were above.
    tangent, inner = tangents_of_rays(far, eye[2] - target[0, 2], thick, c)
    shift = plate_shift(np.arctan(tangent), thick, c)
    assert np.isclose(shift, thick * (tangent - inner), atol=1e-12)
    ray = in_world(view, virtual)[0] - eye
    assert np.isclose(np.hypot(*ray[:2]) / -ray[2], tangent, atol=1e-12)
    # Without the block that ray would have arrived further on by the shift.
    assert np.isclose((eye[2] - target[0, 2]) * tangent - far, shift, atol=1e-12)


@pytest.mark.capability("G6.6-solid")
def test_in_a_parallel_projection_a_block_moves_everything_alike() -> None:
    random = np.random.default_rng(0)
    view = view_of((3.0, 1.0, 2.0), parallel=True)
    points = random.uniform(-1, 1, (200, 3)) - [0.0, 0.0, 1.5]
    virtual, seen = virtual_points(view, horizontal(view, (0.3, 1.5), (-0.2, 1 / 1.5)), view.points_of(points))
    assert seen.all()
    moved = view.image_of(virtual) - view.image_of(view.points_of(points))
    assert np.allclose(moved, moved[:, :1], atol=1e-13)
    alpha = np.arctan(np.hypot(3.0, 1.0) / 2.0)
    assert np.isclose(np.hypot(*moved[:, 0]), plate_shift(alpha, 0.5, 1.5) * np.cos(alpha), atol=1e-13)


def test_rays_that_are_traced_to_a_point_come_back_to_it() -> None:
    random = np.random.default_rng(4)
    for eye in ((3.0, -2.0, 4.0), (0.5, 0.2, 2.0)):
        view = view_of(eye)
        tilted = np.array([[0.1, -0.3], [0.2, 0.1], [-1.0, -1.0]])
        tilted = view.axes @ (tilted / np.linalg.norm(tilted, axis=0))
        corner = view.points_of(np.array([(0, 0, 0.8), (0, 0, 0.1)]))
        passage = SightWays(tilted[..., None], corner[..., None], np.array([1.5, 1 / 1.5]))
        points = view.points_of(random.uniform(-1, 1, (100, 3)) - [0, 0, 1.8])
        virtual, seen = virtual_points(view, passage, points)
        assert seen.all()
        rays = traced(view, passage, view.image_of(virtual))
        arm = points - rays.place
        off = np.cross(arm, rays.direction, axis=0)
        assert np.abs(off).max() < 1e-12 and rays.passes.all()


def test_the_order_along_a_ray_stays() -> None:
    view = view_of((3.0, -2.0, 4.0))
    passage = horizontal(view, (0.5, 1.5), (0.0, 1 / 1.5))
    rays = traced(view, passage, np.array([[0.1], [0.05]]))
    points = rays.place + np.linspace(0.0, 2.0, 30) * rays.direction
    virtual, seen = virtual_points(view, passage, points)
    assert seen.all()
    assert np.allclose(view.image_of(virtual), [[0.1], [0.05]], atol=1e-12)
    assert (np.diff(view.depth_of(virtual)) > 0.0).all()


def test_points_before_the_surface_and_beyond_total_reflection_are_not_seen() -> None:
    view = view_of((3.0, -2.0, 4.0))
    above = view.points_of(np.array([(0.0, 0.0, 0.5)]))
    assert not virtual_points(view, horizontal(view, (0.0, WATER)), above)[1].any()
    sideways = SightWays(
        (view.axes @ np.array([[0.0], [1.0], [0.0]]))[..., None], np.zeros((3, 1, 1)), np.array([WATER])
    )
    behind = view.points_of(np.array([(0.0, -9.0, 0.0)]))
    assert not virtual_points(view, sideways, behind)[1].any()
