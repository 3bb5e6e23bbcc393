import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.effects.refraction import (
    angle_of_refraction,
    inverse_refraction,
    plate_shift,
    refracted,
    seen_in_surface,
    tangents_of_rays,
)
from vectorplot.errors import InputError

WATER = 4.0 / 3.0


@pytest.mark.capability("G6.6-snell")
def test_the_worked_example_of_the_book() -> None:
    alpha = 1.05408375667294
    assert abs(angle_of_refraction(alpha, WATER) - 0.710332591269137) < 1e-14
    assert abs(plate_shift(alpha, 2.0, WATER) - 1.79964287725909) < 1e-13


@pytest.mark.capability("G6.6-inverse")
def test_the_inverse_of_the_worked_example() -> None:
    assert abs(inverse_refraction(7.0, 5.0, 2.0, WATER) - 1.05408375667294) < 1e-14


LENGTH = st.floats(1e-6, 1e6)


@pytest.mark.capability("G6.6-inverse")
@given(st.floats(-1e6, 1e6), LENGTH, LENGTH, st.floats(0.2, 5.0))
def test_a_ray_to_any_point_meets_it_and_snells_law(p1: float, above: float, a: float, c: float) -> None:
    p2 = above + a
    tan_alpha, tan_beta = tangents_of_rays(p1, p2, a, c)
    assert abs((p2 - a) * tan_alpha + a * tan_beta - p1) <= 1e-12 * max(abs(p1), 1.0)
    sines = [t / np.hypot(1.0, t) for t in (tan_alpha, tan_beta)]
    assert abs(sines[0] - c * sines[1]) <= 1e-14 * max(1.0, c)


def test_the_equation_of_the_book_holds_for_whole_arrays() -> None:
    random = np.random.default_rng(7)
    p1, above, a = random.uniform(0.0, 20.0, 5000), random.uniform(0.01, 9.0, 5000), random.uniform(0.0, 9.0, 5000)
    alpha = inverse_refraction(p1, above + a, a, WATER)
    sine = np.sin(alpha)
    residual = above * np.tan(alpha) + a * sine / np.sqrt(WATER**2 - sine**2) - p1
    # tan(alpha) itself is known to an ulp of alpha only, which counts cos^-2 times.
    assert (np.abs(residual) < 1e-12 + 1e-15 * above / np.cos(alpha) ** 2).all()


def test_total_reflection_turns_rays_back() -> None:
    critical = np.arcsin(0.75)
    assert np.isnan(angle_of_refraction(critical + 1e-6, 1.0 / WATER))
    assert np.isfinite(angle_of_refraction(critical - 1e-6, 1.0 / WATER))
    ray = np.array([[np.sin(1.0), 0.0, np.cos(1.0)], [np.sin(0.5), 0.0, np.cos(0.5)]])
    direction, total = refracted(ray, [0.0, 0.0, 1.0], 0.75)
    assert total.tolist() == [True, False]
    assert np.allclose(direction[0], [np.sin(1.0), 0.0, -np.cos(1.0)], atol=1e-15)
    assert np.isclose(direction[1, 0], np.sin(0.5) / 0.75, atol=1e-15)


@pytest.mark.parametrize("side", [1.0, -3.0])
def test_refracted_rays_stay_in_the_plane_of_incidence(side: float) -> None:
    random = np.random.default_rng(3)
    rays, normals = random.normal(size=(2, 500, 3))
    through, total = refracted(rays, side * normals, 1.7)
    assert not total.any()
    assert np.allclose(np.linalg.norm(through, axis=1), 1.0, atol=1e-15)
    unit = rays / np.linalg.norm(rays, axis=1)[:, None]
    normal = normals / np.linalg.norm(normals, axis=1)[:, None]
    # n x d is c times n x t: Snell's law and the common plane in one.
    assert np.allclose(np.cross(normal, unit), 1.7 * np.cross(normal, through), atol=1e-15)
    assert ((unit * normal).sum(axis=1) * (through * normal).sum(axis=1) > 0.0).all()
    back, _ = refracted(through, normals, 1.0 / 1.7)
    assert np.allclose(back, unit, atol=1e-14)


@pytest.mark.capability("G6.6-pool")
def test_a_floor_seen_from_straight_above_is_raised_to_its_depth_over_c() -> None:
    a, high = 2.0, 5.0
    p1 = np.array([1e-3, 1e-4, 1e-5])
    alpha = inverse_refraction(p1, high + a, a, WATER)
    apparent = p1 / np.tan(alpha) - high
    assert np.allclose(apparent, a / WATER, atol=1e-6)
    assert abs(apparent[-1] - a / WATER) < 1e-9


@pytest.mark.capability("G6.6-pool")
def test_points_of_the_floor_appear_raised_and_the_more_so_the_flatter_one_looks() -> None:
    along = np.linspace(0.1, 60.0, 200)
    floor = np.column_stack([along, np.zeros(200), np.full(200, -2.0)])
    eye = np.array([0.0, 0.0, 3.0])
    surface = seen_in_surface(eye, floor, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), WATER)
    assert np.allclose(surface[:, 2], 0.0, atol=1e-15)
    raised = 3.0 - along / surface[:, 0] * 3.0
    assert (raised > -2.0 / WATER - 1e-3).all() and (np.diff(raised) > 0.0).all()
    assert raised[-1] > -0.6


@pytest.mark.hard(18)
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_water_is_the_same_at_any_size_and_place(scale: float, shift: float) -> None:
    random = np.random.default_rng(11)
    points = random.uniform(-3.0, 3.0, (50, 3)) - [0.0, 0.0, 3.0]
    eye = np.array([1.0, 2.0, 4.0])
    plain = seen_in_surface(eye, points, (0.0, 0.0, 1.0), np.zeros(3), WATER)
    moved = seen_in_surface(scale * eye + shift, scale * points + shift, (0.0, 0.0, 2.0), np.full(3, shift), WATER)
    assert np.allclose((moved - shift) / scale, plain, atol=1e-8 if shift else 1e-13)


def test_points_in_the_surface_and_right_below_the_eye() -> None:
    points = np.array([[1.0, 2.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 0.0]])
    assert np.allclose(seen_in_surface((0, 0, 1), points, (0, 0, 1), (0, 0, 0), WATER), points * [1, 1, 0], atol=1e-15)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf])
def test_constants_that_are_none(wrong: float) -> None:
    for call in (
        lambda: angle_of_refraction(0.1, wrong),
        lambda: refracted([0, 0, 1], [0, 0, 1], wrong),
        lambda: inverse_refraction(1.0, 3.0, 1.0, wrong),
    ):
        with pytest.raises(InputError):
            call()


@pytest.mark.parametrize("numbers", [(1.0, 1.0, 1.0), (np.nan, 3.0, 1.0), (1.0, np.inf, 1.0), (1.0, 3.0, -1.0)])
def test_eyes_that_are_not_above_the_water(numbers: tuple[float, float, float]) -> None:
    with pytest.raises(InputError):
        inverse_refraction(*numbers, WATER)
