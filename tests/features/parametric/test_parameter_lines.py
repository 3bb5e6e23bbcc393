"""Parameter lines and borders."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.parameter_curves import borders, parameter_lines, parameter_lines_of_each, u_lines, v_lines
from vectorplot.surfaces.graphs import Disc, graph
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Cylinder, HyperbolicParaboloid, Sphere
from vectorplot.surfaces.tori import Torus


def test_parameter_lines_of_the_torus_are_closed_circles_within_the_tolerance():
    curves = parameter_lines(Torus(3.0, 1.0), 24, 12, tracing=Tracing(tolerance=1e-3))
    assert len(curves) == 36 and curves.closed.all()
    assert curves.turns[:24].tolist() == [[0, 1]] * 24 and curves.turns[24:].tolist() == [[1, 0]] * 12
    for k in range(24):
        centre = 3.0 * np.array([np.cos(curves.levels[k]), np.sin(curves.levels[k]), 0.0])
        p = curves[k]
        assert np.abs(np.linalg.norm(p - centre, axis=1) - 1.0).max() < 1e-12
        assert np.abs(np.linalg.norm((p[1:] + p[:-1]) / 2 - centre, axis=1) - 1.0).max() < 1e-3


def test_meridians_of_a_sphere_run_from_pole_to_pole_and_poles_are_no_lines():
    curves = u_lines(Sphere(), [0.0, 1.0])
    assert len(curves) == 2 and not curves.closed.any()
    assert np.allclose(curves[0][[0, -1]], [(0, 0, -1), (0, 0, 1)], atol=1e-15)
    assert len(v_lines(Sphere(), [-np.pi / 2, np.pi / 2])) == 0
    assert len(parameter_lines(Sphere(), 12, 6)) == 12 + 5
    assert [len(parameter_lines(Sphere(), *counts)) for counts in ((12, 0), (0, 6), (0, 0))] == [12, 5, 0]


def test_borders_are_where_a_surface_ends():
    assert len(borders(Torus())) == 0 and len(borders(Sphere())) == 0
    assert len(borders(HyperbolicParaboloid())) == 4
    circles = borders(Cylinder(1.0, 0.0, 2.0))
    assert len(circles) == 2 and circles.closed.all() and set(circles.points[:, 2]) == {0.0, 2.0}
    assert len(borders(Cone(1.0, 0.0, 1.0))) == 1


def test_straight_lines_need_no_more_points():
    curves = u_lines(Cylinder(1.0, 0.0, 2.0), [0.3])
    assert len(curves.u) == 25


def test_lines_end_at_the_border_of_a_hole():
    cap = graph(lambda x, y: x * x + y * y, Disc(1.0))
    curves = u_lines(cap, [-0.5, 0.0, 0.7])
    assert len(curves) == 3
    for k, u in enumerate((-0.5, 0.0, 0.7)):
        assert np.allclose(curves[k][[0, -1], 1], np.array([-1, 1]) * np.sqrt(1 - u * u), atol=1e-12)
        assert np.isfinite(curves[k]).all()


def test_a_hole_in_the_middle_makes_two_lines():
    ring = graph(lambda x, y: np.sqrt(np.where(x * x + y * y < 0.25, np.nan, 1.0) * 1.0), HyperbolicParaboloid().domain)
    curves = v_lines(ring, [0.0])
    assert len(curves) == 2 and np.allclose(sorted(np.abs(curves.u))[:2], 0.5, atol=1e-12)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scaled_surfaces_have_the_same_lines(scale):
    plain, scaled = parameter_lines(Torus(3.0, 1.0), 5, 4), parameter_lines(Torus(3.0 * scale, scale), 5, 4)
    assert len(plain.u) == len(scaled.u) and np.allclose(
        plain.points * scale, scaled.points, rtol=0, atol=1e-12 * scale
    )


def test_negative_columns_are_refused():
    with pytest.raises(InputError, match="columns"):
        parameter_lines(Sphere(), -1, 3)


def test_of_many_surfaces_each_has_the_lines_that_it_has_alone():
    turned = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    cap = graph(lambda x, y: x * x + y * y, Disc(1.0))
    shapes = [Torus(3.0, 1.0), Sphere(), Torus(2.0, 0.3), Cone(1.0, 0.0, 1.0), cap, Cylinder(1.0, 0.0, 2.0)]
    placed = [PlacedSurface(shape, (1.0 + k) * turned, (k, 0.0, -k)) for k, shape in enumerate(shapes)]
    surfaces, counts = (
        [*placed, Torus(), HyperbolicParaboloid()],
        [(5, 4), (6, 0), (0, 3), (4, 4), (3, 3)] + 3 * [(2, 7)],
    )
    for surface, (columns, rows), found in zip(
        surfaces, counts, parameter_lines_of_each(surfaces, counts, tracing=Tracing(tolerance=1e-2)), strict=True
    ):
        alone = parameter_lines(surface, columns, rows, tracing=Tracing(tolerance=1e-2))
        assert np.array_equal(found.offsets, alone.offsets) and np.array_equal(found.closed, alone.closed)
        assert np.array_equal(found.levels, alone.levels) and np.array_equal(found.turns, alone.turns)
        assert np.allclose(found.points, alone.points, rtol=0.0, atol=1e-12) and found.doubts == alone.doubts
