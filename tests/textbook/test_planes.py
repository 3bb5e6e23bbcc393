from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.textbook.intersections import Plane


@pytest.mark.capability("G1.1-plane")
def test_tv12_plane_through_three_points():
    plane = Plane.through((1, 0, 2), (3, 1, -1), (0, 4, 1))
    assert plane.normal.tolist() == [11.0, 5.0, 9.0]
    assert plane.constant == 29.0


@pytest.mark.capability("G1.1-plane")
def test_the_plane_contains_its_points_at_any_scale_and_offset():
    rng = np.random.default_rng(4)
    p, q, r = rng.normal(size=(3, 100, 3))
    for scale, offset in ((1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        points = [scale * x + offset for x in (p, q, r)]
        plane = Plane.through(*points)
        for x in points:
            assert np.abs(plane.distance(x)).max() <= 1e-13 * scale + 1e-12 * offset * 1e-1
    with pytest.raises(InputError, match="line"):
        Plane.through((0, 0, 0), (1, 1, 1), (3, 3, 3))
    with pytest.raises(InputError, match="line"):
        Plane.through((1e6, 0.1 + 0.2, 0), (1e6, 0.3, 0), (1e6 + 1, 0.3, 0))


@pytest.mark.capability("G1.1-plane")
def test_a_plane_given_by_its_equation():
    plane = Plane.of_equation(((1.0, 2.0, 2.0), (0.0, 0.0, 4.0)), (5.0, 2.0))
    assert np.allclose(plane.constant, (5.0, 2.0))
    assert np.allclose(plane.distance((3.0, -2.0, 4.0)), (2 / 3, 3.5))
    with pytest.raises(InputError):
        Plane.of_equation((0.0, 0.0, 0.0), 1.0)
    with pytest.raises(InputError):
        Plane(np.zeros(3), np.zeros(3))


@pytest.mark.capability("G1.1-side")
def test_sides_of_a_plane_and_zero_counts_as_plus():
    plane = Plane.through((1, 0, 2), (3, 1, -1), (0, 4, 1))
    n = plane.normal
    points = np.array([plane.point + 1e-6 * n, plane.point - 1e-6 * n, (3, 1, -1), (0, 4, 1)])
    assert plane.side(points).tolist() == [1, -1, 1, 1]
    slanted = Plane.through((0.1, 0.7, 0.3), (1.3, 0.2, 0.9), (0.4, 1.1, -0.6))
    inside = 0.1 * np.array([0.1, 0.7, 0.3]) + 0.7 * np.array([1.3, 0.2, 0.9]) + 0.2 * np.array([0.4, 1.1, -0.6])
    assert slanted.side(inside) == 1


@pytest.mark.capability("G1.1-side")
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_points_in_a_plane_count_as_plus_whatever_rounding_does(scale, offset):
    rng = np.random.default_rng(17)
    p, q, r = scale * rng.normal(size=(3, 500, 3)) + offset
    plane = Plane.through(p, q, r)
    weight = rng.dirichlet((1, 1, 1), 500).T[..., None]
    inside = weight[0] * p + weight[1] * q + weight[2] * r
    assert (plane.side(inside) == 1).all()
    unit = plane.normal / np.linalg.norm(plane.normal, axis=1, keepdims=True)
    assert (plane.side(inside - 1e-6 * scale * unit) == -1).all()
