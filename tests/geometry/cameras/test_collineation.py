from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import CoordinateSystem, collineate, depth_of, project, uncollineate, unproject

EYE, TARGET, P = (10.0, 5.0, 7.0), (1.0, 2.0, -1.0), np.array([3.0, -2.0, 4.0])
BOOK = Camera(eye=EYE, target=TARGET, twist_deg=np.degrees(0.3))
ROTATED = np.array([-3.22036094214311, 4.5704502690719, 3.70678563451675])
component = st.floats(-3, 3)
point3 = st.tuples(component, component, component).map(np.array)


def cloud():
    return np.random.default_rng(7).uniform(-3, 3, (200, 3))


@pytest.mark.capability("G2.3-T1")
def test_tv06_t1_image():
    image = CoordinateSystem.of_image(BOOK).from_world(P)
    assert np.allclose(image, (-4.5919961582411, 6.51712353182474, 3.70678563451675), rtol=0, atol=1e-12)
    assert np.allclose(project(ROTATED, BOOK.distance), image, rtol=0, atol=1e-12)


@pytest.mark.capability("G2.3-T1")
def test_t1_with_an_infinite_centre_is_the_orthogonal_image():
    points = cloud()
    assert np.array_equal(project(points, np.inf), points)
    assert np.array_equal(unproject(points, np.inf), points)
    assert np.allclose(unproject(project(points, 5.0), 5.0), points, atol=1e-14)


@pytest.mark.capability("G2.3-T2")
def test_tv07_t2_image():
    image = collineate(CoordinateSystem.of_image(BOOK).rotated(P), BOOK.distance)
    assert np.allclose(image, (-4.5919961582411, 6.51712353182474, 0.425925925925926), rtol=0, atol=1e-12)


@pytest.mark.capability("G2.3-T2")
@pytest.mark.parametrize("k", [None, 1.0, 1 / 7, -0.4, 3.0])
def test_t2_carries_planes_to_planes_and_fixes_the_image_plane(k):
    d = 7.0
    rng = np.random.default_rng(8)
    n, c = np.array([0.3, -0.8, 0.5]), 1.3
    points = rng.uniform(-3, 3, (100, 3))
    points += ((c - points @ n) / (n @ n))[:, None] * n
    images = collineate(points, d, k)
    singular = np.linalg.svd(images - images.mean(axis=0), compute_uv=False)
    assert singular[2] < 1e-13 * singular[0] * len(points)
    ground = points * (1, 1, 0)
    assert np.allclose(collineate(ground, d, k), ground, atol=1e-15)
    # Erratum G2-04: joining lines meet in (0, 0, d (1 - k)).
    factor = 1 / d if k is None else k
    centre = np.array([0, 0, d * (1 - factor)])
    assert np.abs(np.cross(points - centre, images - centre)).max() < 1e-11
    assert np.allclose(uncollineate(images, d, k), points, atol=1e-13)


@pytest.mark.capability("G2.3-T2")
@given(st.floats(-50, 6.9), st.floats(-50, 6.9))
def test_t2_keeps_the_order_of_depths(z, w):
    first, second = (float(collineate(np.array([0.0, 0.0, x]), 7.0)[2]) for x in (z, w))
    assert first > -1.0
    if abs(z - w) > 1e-9:
        assert (first < second) == (z < w)


@pytest.mark.capability("G2.3-undoT2")
def test_tv08_depths_of_the_initial_near_and_far_planes():
    z = depth_of([-0.8, 4.0], BOOK.distance)
    assert np.allclose(z, (-49.6386945839634, 9.92773891679269), rtol=0, atol=1e-12)
    assert np.allclose(z / BOOK.distance, (-4.0, 0.8), atol=1e-15)


@pytest.mark.capability("G2.3-undoT2")
@given(point3)
def test_t2_and_back(p):
    assert np.allclose(uncollineate(collineate(p, 5.0), 5.0), p, atol=1e-13)
    star = collineate(p, 5.0)[2]
    assert depth_of(star, 5.0) == pytest.approx(p[2], abs=1e-13)
    assert np.array_equal(collineate(p, np.inf), p)


def test_a_collineation_needs_a_factor():
    with pytest.raises(InputError):
        collineate(P, 5.0, 0.0)
