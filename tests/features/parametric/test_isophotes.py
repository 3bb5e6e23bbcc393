"""Isophotes of surfaces against closed forms."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.contours_and_isophotes import isophotes, point_light_isophotes
from vectorplot.features.curve_tracing import Tracing
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus

LIGHT = np.array([2.0, 1.0, 3.0]) / np.sqrt(14.0)


def distance(p, x):
    """Of a point from a polyline."""
    chord = p[1:] - p[:-1]
    t = np.clip(((x - p[:-1]) * chord).sum(axis=1) / (chord * chord).sum(axis=1), 0, 1)
    return np.linalg.norm(p[:-1] + t[:, None] * chord - x, axis=1).min()


@pytest.mark.capability("G8.4-isophote")
def test_isophotes_of_a_sphere_are_parallel_circles_about_the_light():
    levels = np.linspace(-0.8, 0.8, 9)
    curves = isophotes(Sphere(2.0), LIGHT, levels)
    assert len(curves) == 9 and curves.closed.all() and np.array_equal(curves.levels, levels)
    for k, level in enumerate(levels):
        assert np.abs(curves[k] @ LIGHT - 2.0 * level).max() < 1e-10
        length = np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum()
        assert abs(length - 4 * np.pi * np.sqrt(1 - level**2)) < 0.03


@pytest.mark.capability("G8.4-isophote")
@pytest.mark.parametrize(("size", "offset"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_isophotes_of_sun_and_lamp_are_the_same_at_any_size_and_place(size, offset):
    far = np.array([offset, -offset, offset])
    digits = 1e-10 if offset == 0.0 else 1e-8
    for found in (
        isophotes(Sphere(2.0 * size, far), LIGHT, [-0.5, 0.3]),
        point_light_isophotes(Sphere(2.0 * size, far), 4.0 * size * LIGHT + far, [-0.5, 0.3]),
    ):
        assert len(found) == 2 and found.closed.all() and not found.doubts
        for k in range(2):
            along = (found[k] - far) / size @ LIGHT
            assert np.ptp(along) < 10 * digits and np.allclose(np.linalg.norm(found[k] - far, axis=1), 2.0 * size)
    # Of the lamp the circle where the angle between normal and ray has that cosine.
    arm = 4.0 * LIGHT - (found[1] - far) / size
    cosine = ((found[1] - far) / size * arm).sum(axis=1) / 2.0 / np.linalg.norm(arm, axis=1)
    assert np.allclose(cosine, 0.3, atol=100 * digits)


@pytest.mark.slow
@pytest.mark.capability("G8.4-isophote")
def test_isophote_of_the_torus_meets_the_meridian_of_the_test_values():
    # The test values have the tube angle pi - v and normals that point out of the tube.
    torus = Torus(3.0, 2.0)
    curves = isophotes(torus, LIGHT, -np.cos(0.8), tracing=Tracing(tolerance=1e-7))
    n = unit_normals(torus, curves.u, curves.v)
    assert np.abs(-n @ LIGHT - np.cos(0.8)).max() < 1e-11
    expected = torus.points(np.full(2, 1.0), np.pi - np.array([0.250947749701766, 1.75103718202499]))
    assert all(min(distance(curves[k], x) for k in range(len(curves))) < 1e-7 for x in expected)


def test_isophotes_of_a_cylinder_are_rulings():
    curves = isophotes(Cylinder(1.0, 0.0, 2.0), (1.0, 0.0, 0.0), [0.5])
    assert len(curves) == 2 and np.abs(curves.points[:, 0] - 0.5).max() < 1e-11


def test_the_point_that_faces_the_light_is_isolated():
    curves = isophotes(Sphere(), LIGHT, [1.0])
    assert len(curves) == 0 and len(curves.isolated) == 1
    assert np.linalg.norm(Sphere().points(*curves.isolated.T)[0] - LIGHT) < 1e-6


@pytest.mark.capability("G8.4-isophote")
def test_isophotes_of_a_point_light_on_the_axis_are_level_circles():
    # On the unit sphere, lamp at height 3: cosine = (3 z - 1) / sqrt(10 - 6 z).
    curves = point_light_isophotes(Sphere(), (0.0, 0.0, 3.0), [0.2, 0.6])
    z = curves.points[:, 2]
    level = np.repeat(curves.levels, np.diff(curves.offsets))
    assert len(curves) == 2 and curves.closed.all()
    assert np.abs((3 * z - 1) / np.sqrt(10 - 6 * z) - level).max() < 1e-11


@pytest.mark.hard(47)
@pytest.mark.parametrize("wobble", [0.0, 1e-16, 1e-12])
def test_isophote_on_a_flat_surface_gives_no_noise(wobble):
    plane = graph(lambda x, y: 0.3 * x + 0.2 * y + wobble * np.sin(40 * x), Domain(-1, 1, -1, 1))
    n = unit_normals(plane, np.array(0.1), np.array(0.2))
    curves = isophotes(plane, LIGHT, [float(n @ LIGHT)])
    assert len(curves) == 0 and len(curves.doubts) == 1


@pytest.mark.hard(47)
def test_isophote_on_a_flat_part_gives_one_border_at_most():
    half = graph(lambda x, y: np.where(x > 0, x * x * x, 0.0 * x) + 0.1 * y, Domain(-1, 1, -1, 1))
    n = unit_normals(half, np.array(-0.5), np.array(0.2))
    curves = isophotes(half, (0.0, 0.0, 1.0), [float(n[2])])
    assert len(curves) <= 1 and curves.doubts
    assert np.abs(curves.points[:, 0]).max(initial=0.0) < 0.05


def test_levels_beyond_one_are_refused():
    with pytest.raises(InputError, match="cosines"):
        isophotes(Sphere(), LIGHT, [1.5])


@pytest.mark.parametrize(
    ("found", "light"), [(isophotes, (1.0, 2.0, 3.0)), (point_light_isophotes, (9.0, 4.0, 7.0))], ids=["sun", "lamp"]
)
def test_on_several_levels_they_are_those_on_each(found, light):
    ring, levels = Torus(3.0, 1.0), [-0.6, 0.0, 0.3, 0.8]
    whole, each = found(ring, light, levels), [found(ring, light, c) for c in levels]
    assert whole.levels.tolist() == [c for c, own in zip(levels, each, strict=True) for _ in range(len(own))]
    assert np.allclose(whole.points, np.concatenate([own.points for own in each]), rtol=0.0, atol=1e-12)
    assert np.diff(whole.offsets).tolist() == [size for own in each for size in np.diff(own.offsets)]
