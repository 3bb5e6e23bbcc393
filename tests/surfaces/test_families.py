"""Surfaces swept by a moving curve: closed forms and the motions behind them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.curves.families import Circle, Helix, Line
from vectorplot.curves.placed_curves import curve_of_function
from vectorplot.errors import InputError
from vectorplot.geometry.rotations import rotation_z
from vectorplot.surfaces.algebraic import first_form, gaussian_curvature, mean_curvature
from vectorplot.surfaces.minimal import helicoid_to_catenoid, minimal_spiral_surface
from vectorplot.surfaces.quadrics import HyperbolicParaboloid, Hyperboloid
from vectorplot.surfaces.swept import (
    Rotoid,
    Screw,
    SpiralMotion,
    helical_surface,
    revolution_surface,
    rotoidal_surface,
    spiral_surface,
    translation_surface,
)
from vectorplot.surfaces.tori import Torus

POINT = np.array([2, 0.5, -1])
THROUGH_POINT = Line(POINT, (1, 0, 0))
SWARM = np.random.default_rng(5).normal(size=(7, 3))
number = st.floats(-3, 3)


def distances(points):
    return np.linalg.norm(points[:, None] - points[None], axis=-1)


@pytest.mark.capability("G8.2-helical")
def test_tv31_helical_image():
    image = helical_surface(THROUGH_POINT, 0.4).points(np.array(0.0), np.array(1.3))
    assert np.allclose(image, (0.0532185645405782, 2.06086578514668, -0.48), rtol=0, atol=1e-12)


@pytest.mark.capability("G8.2-spiral")
def test_tv32_spiral_image():
    image = spiral_surface(THROUGH_POINT, 0.4).points(np.array(0.0), np.array(1.3))
    assert np.allclose(image, (0.0895150970345373, 3.46643323293512, -1.68202764969889), rtol=0, atol=1e-12)


@pytest.mark.capability("G8.2-rotoidal")
def test_tv33_rotoidal_image():
    image = rotoidal_surface(THROUGH_POINT, 0.4, 3).points(np.array(0.0), np.array(1.3))
    assert np.allclose(image, (-0.0443380756965792, 1.70945677253288, -0.370939041833913), rtol=0, atol=1e-12)


@pytest.mark.capability("G8.2-rotoidal")
@pytest.mark.capability("G8.2-helical")
@given(number, number, st.floats(-20, 20))
def test_rotoidal_and_helical_motions_are_rigid(c, distance, v):
    for motion in (Rotoid(c, distance), Screw(c)):
        moved = motion.moved(SWARM, 1.0, np.full(7, v))
        assert np.allclose(distances(moved), distances(SWARM), rtol=0, atol=1e-12)
        frame = motion.moved(np.eye(3), 0.0, np.full(3, v))
        assert np.isclose(np.linalg.det(frame), 1)
        assert np.allclose(motion.moved(SWARM, 1.0, np.zeros(7)), SWARM, atol=1e-15)


@pytest.mark.capability("G8.2-rotoidal")
@given(number, st.floats(0.5, 3), st.floats(-20, 20))
def test_a_rotoidal_motion_keeps_the_distance_from_the_turning_axis(c, distance, v):
    """In the frame that turns with v about z, the axis b stands still, and so does the distance from it."""
    moved = Rotoid(c, distance).moved(SWARM, 1.0, np.full(7, v))
    back = moved @ rotation_z(-v)
    from_b = np.hypot(back[:, 0] - distance, back[:, 2])
    assert np.allclose(from_b, np.hypot(SWARM[:, 0] - distance, SWARM[:, 2]), atol=1e-12)
    assert np.allclose(back[:, 1], SWARM[:, 1], atol=1e-12)


@pytest.mark.capability("G8.2-spiral")
@given(st.floats(-0.5, 0.5), st.floats(-5, 5), st.floats(-5, 5))
def test_a_spiral_surface_moves_into_itself_by_a_similarity(c, v, t):
    surface = spiral_surface(Circle((3, 0, 1), 1, (0, 1, 0)), c)
    u = np.linspace(0, 6, 9)
    there = surface.points(u, np.full(9, v + t))
    here = surface.points(u, np.full(9, v))
    assert np.allclose(there, np.exp(c * t) * here @ rotation_z(t), rtol=1e-12, atol=1e-12)
    motion = SpiralMotion(c).moved(SWARM, 1.0, np.full(7, t))
    assert np.allclose(distances(motion), np.exp(c * t) * distances(SWARM), rtol=1e-12)


@pytest.mark.capability("G8.2-translation")
def test_translation_differences_do_not_depend_on_u():
    surface = translation_surface(Circle((1, 2, 3), 2, (1, 1, 0)), Helix(2, 0.5))
    u = np.linspace(0, 6, 13)
    between = surface.points(u, np.full(13, 0.3)) - surface.points(u, np.full(13, 2.9))
    assert np.abs(between - between[0]).max() < 1e-14


@pytest.mark.capability("G8.2-translation")
def test_the_hyperbolic_paraboloid_is_a_translation_surface_of_two_parabolas():
    saddle = HyperbolicParaboloid(1, 2, 2, 1)
    along = curve_of_function(lambda t: (t, 0.0, t * t), -2, 2)
    across = curve_of_function(lambda t: (0.0, t, -((t / 2) ** 2)), -1, 1)
    u, v = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-1, 1, 7))
    assert np.allclose(translation_surface(along, across).points(u, v), saddle.points(u, v), atol=1e-15)
    assert saddle.domain == translation_surface(along, across).domain


def test_the_hyperbolic_paraboloid_carries_two_families_of_lines():
    saddle = HyperbolicParaboloid(1, 2, 2, 1)
    t = np.linspace(-1, 1, 5)
    for sign in (1, -1):
        p = saddle.points(0.3 + t, sign * 2 * t)
        assert np.abs(np.diff(p, 2, axis=0)).max() < 1e-15


@pytest.mark.capability("G8.2-revolution")
@given(st.floats(-10, 10))
def test_revolution_keeps_distance_from_the_axis_and_height(v):
    line = Line((2, 0.5, -1), (0.4, 1, 0.7))
    u = np.linspace(0, 1, 9)
    p, g = revolution_surface(line).points(u, np.full(9, v)), line.points(u)
    assert np.allclose(np.hypot(p[:, 0], p[:, 1]), np.hypot(g[:, 0], g[:, 1]), rtol=1e-14)
    assert np.array_equal(p[:, 2], g[:, 2])


@pytest.mark.capability("G8.2-revolution")
def test_a_turned_skew_line_is_a_hyperboloid_of_one_sheet():
    surface = revolution_surface(Line((2, -3, -1.5), (0, 6, 3)))
    u, v = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 6, 11))
    x, y, z = np.moveaxis(surface.points(u, v), -1, 0)
    assert np.allclose((x * x + y * y) / 4 - z * z, 1)
    assert np.allclose(gaussian_curvature(surface, u, v) < 0, True)
    p = Hyperboloid((2, 2, 1), -1.5, 1.5).points(v, 0.1 * u)
    assert np.allclose((p[..., 0] ** 2 + p[..., 1] ** 2) / 4 - p[..., 2] ** 2, 1)


@pytest.mark.capability("G8.2-revolution")
@pytest.mark.capability("G8.2-translation")
def test_a_turned_helix_beside_the_axis_is_a_translation_surface_too():
    turned = revolution_surface(Helix(1, 0.5, (3, 0, 0)))
    slid = translation_surface(Helix(1, 0.5), Helix(3, -0.5))
    u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(0, 6, 11))
    assert np.allclose(turned.points(u, v), slid.points(u + v, v), atol=1e-13)


@pytest.mark.capability("G8.2-ruled/tubular")
@pytest.mark.parametrize(
    "family",
    [
        lambda g: translation_surface(g, Helix(1, 0.4)),
        revolution_surface,
        lambda g: helical_surface(g, 0.4),
        lambda g: rotoidal_surface(g, 0.4, 3),
        lambda g: spiral_surface(g, 0.1),
    ],
    ids=["translation", "revolution", "helical", "rotoidal", "spiral"],
)
def test_lines_sweep_ruled_surfaces_and_circles_tubes(family):
    ruled = family(Line((2, 0.5, -1), (0.4, 1, 0.7)))
    tube = family(Circle((3, 0.2, 0.1), 0.8, (0.3, 1, 0.2)))
    assert not ruled.domain.closed_u
    assert tube.domain.closed_u
    for v in (0.0, 1.3, 5.0):
        straight = ruled.points(np.linspace(0, 1, 7), np.full(7, v))
        assert np.abs(np.diff(straight, 2, axis=0)).max() < 1e-13
        ring = tube.points(np.linspace(0, 2 * np.pi, 13)[:-1], np.full(12, v))
        radii = np.linalg.norm(ring - ring.mean(axis=0), axis=1)
        assert np.ptp(radii) < 1e-13
        assert np.linalg.matrix_rank(ring - ring.mean(axis=0), tol=1e-12) == 2
    u, v = np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 5, 7))
    assert (gaussian_curvature(ruled, u, v) < 1e-12).all()


def test_a_turned_circle_is_the_torus():
    ring = revolution_surface(Circle((3, 0, 0), 1, (0, -1, 0)))
    u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(0, 6, 11))
    # The circle starts at the direction (1, 0, 0) of the horizontal, the torus inside.
    p = ring.points(u, v)
    assert np.allclose((np.hypot(p[..., 0], p[..., 1]) - 3) ** 2 + p[..., 2] ** 2, 1)
    assert ring.domain.closed_u
    assert ring.domain.closed_v
    expected = np.sort(np.abs(gaussian_curvature(Torus(3, 1), v, u + np.pi)).ravel())
    assert np.allclose(np.sort(np.abs(gaussian_curvature(ring, u, v)).ravel()), expected, atol=1e-12)


@pytest.mark.parametrize(
    ("surface", "closed"),
    [
        (rotoidal_surface(THROUGH_POINT, 2, 3), True),
        (rotoidal_surface(THROUGH_POINT, 0.5, 3), False),
        (rotoidal_surface(THROUGH_POINT, 0.5, 3, end=4 * np.pi), True),
        (rotoidal_surface(THROUGH_POINT, 1 / 3, 3, start=1, end=1 + 6 * np.pi), True),
        (revolution_surface(THROUGH_POINT, end=np.pi), False),
        (helical_surface(THROUGH_POINT, 0.1), False),
        (helical_surface(THROUGH_POINT, 0.0), True),
        (spiral_surface(THROUGH_POINT, 0.1), False),
        (translation_surface(THROUGH_POINT, Circle()), True),
    ],
)
def test_surfaces_close_when_their_motion_repeats(surface, closed):
    assert surface.domain.closed_v == closed


@pytest.mark.capability("G8.2-minimal")
@pytest.mark.parametrize("bending", [0.0, 0.4, 1.0, np.pi / 2, 2.5])
@pytest.mark.parametrize(
    "family",
    [helicoid_to_catenoid, lambda t: minimal_spiral_surface(0.2, t), lambda t: minimal_spiral_surface(-0.7, t)],
)
def test_bent_minimal_surfaces_have_no_mean_curvature_and_one_metric(family, bending):
    u, v = np.meshgrid(np.linspace(-1.4, 1.4, 9), np.linspace(0, 6, 11))
    bent, straight = family(bending), family(0.0)
    bends = np.sqrt(np.abs(gaussian_curvature(straight, u, v)))
    assert (np.abs(mean_curvature(bent, u, v)) <= 1e-13 * (1 + bends)).all()
    for ours, theirs in zip(first_form(bent, u, v), first_form(straight, u, v), strict=True):
        assert np.allclose(ours, theirs, rtol=1e-12, atol=1e-11)
    assert (gaussian_curvature(bent, u, v) < 0).all()


@pytest.mark.capability("G8.2-minimal")
def test_helicoid_and_catenoid_are_what_their_names_say():
    u, v = np.meshgrid(np.linspace(-1.4, 1.4, 9), np.linspace(0, 6, 11))
    x, y, z = np.moveaxis(helicoid_to_catenoid(0.0).points(u, v), -1, 0)
    assert np.allclose(z, v)
    assert np.allclose(np.hypot(x, y), np.abs(np.sinh(u)))
    assert np.allclose(np.abs(np.cos(z) * y - np.sin(z) * x), np.hypot(x, y)) or np.allclose(
        np.cos(z) * y - np.sin(z) * x, 0, atol=1e-12
    )
    x, y, z = np.moveaxis(helicoid_to_catenoid(np.pi / 2).points(u, v), -1, 0)
    assert np.allclose(np.hypot(x, y), np.cosh(z))
    assert helicoid_to_catenoid(np.pi / 2).domain.closed_v
    assert not helicoid_to_catenoid(1.0).domain.closed_v


@pytest.mark.capability("G8.2-minimal")
@given(st.floats(0, 3), st.floats(-3, 3))
def test_every_bending_of_the_minimal_spiral_surface_is_spiral(bending, a):
    surface = minimal_spiral_surface(0.3, bending)
    u, v = np.meshgrid(np.linspace(-1, 1, 5), np.linspace(0, 2, 5))
    there = surface.points(u, v + a)
    here = surface.points(u, v)
    assert np.allclose(there, np.exp(0.3 * a) * here @ rotation_z(a), rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(
    "make",
    [
        lambda: minimal_spiral_surface(0.0),
        lambda: spiral_surface(THROUGH_POINT, np.nan),
        lambda: helical_surface(THROUGH_POINT, np.inf),
        lambda: revolution_surface(THROUGH_POINT, start=1, end=1),
        lambda: rotoidal_surface(THROUGH_POINT, 1, np.nan),
        lambda: helicoid_to_catenoid(np.nan),
    ],
)
def test_bad_numbers_are_input_errors(make):
    with pytest.raises(InputError):
        make()


def test_a_catenoid_whose_cosine_is_out_of_range_is_refused():
    with pytest.raises(InputError, match="width 1000: the hyperbolic cosine of it is out of range"):
        helicoid_to_catenoid(np.pi / 2, width=1000.0)
