"""Curves on implicit surfaces against closed forms, and against the tracer on parametrised surfaces."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.contours_and_isophotes import contour, isophotes, point_light_isophotes
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.implicit_curves import (
    ImplicitTracing,
    implicit_borders,
    implicit_contour,
    implicit_intersection,
    implicit_isophotes,
    implicit_parallel_contour,
    implicit_plane_sections,
    implicit_point_light_isophotes,
)
from vectorplot.features.implicit_meshes import implicit_mesh
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.quadrics import (
    Ellipsoid,
    Quadric,
    Sphere,
    implicit_cone,
    implicit_cylinder,
    implicit_ellipsoid,
    implicit_plane,
    implicit_sphere,
)
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, ImplicitTorusByDistance, Torus, dupin_cyclide
from vectorplot.testing import assert_contour, assert_isophote, assert_on_both, assert_on_surface, assert_same_curve

EYE = np.array([8.0, -3.0, 6.0])
LIGHT = np.array([2.0, 1.0, 3.0])
BOX = np.array([[-2.0] * 3, [2.0] * 3])
CENTRE = (1.0, 0.5, 0.2)
FINE = ImplicitTracing(tolerance=1e-5)
PAIRS = {
    "sphere": (implicit_sphere(2.0), Sphere(2.0), 1.0),
    "ellipsoid": (implicit_ellipsoid((3, 2, 1)), Ellipsoid((3, 2, 1)), 1.0),
    # The parametrised ones have normals into the tube.
    "torus": (ImplicitTorus(3, 1), Torus(3, 1), -1.0),
    "fat torus": (ImplicitTorus(3, 2), Torus(3, 2), -1.0),
    "torus by distance": (ImplicitTorusByDistance(3, 1), Torus(3, 1), -1.0),
    "cyclide": (ImplicitCyclide(3, 1, CENTRE, 2), dupin_cyclide(3, 1, CENTRE, 2), None),
}
both_ways = pytest.mark.parametrize(("surface", "same", "sign"), PAIRS.values(), ids=PAIRS.keys())


def lines(curves):
    return [curves[k] for k in range(len(curves))]


def residual(surface, curves):
    """Of F, as a part of the extent."""
    p = curves.points
    return (np.abs(surface.values(p)) / np.linalg.norm(surface.gradients(p), axis=1)).max() / np.ptp(surface.box)


@pytest.mark.slow
@both_ways
@pytest.mark.spread(parts=2)
@pytest.mark.capability("G8.4-contour")
def test_contours_are_those_of_the_parametrised_surfaces(surface, same, sign):
    eye = EYE if sign else np.array([3.0, 5.0, 4.0])
    curves = implicit_contour(surface, eye, tracing=FINE)
    assert curves.closed.all() and not curves.doubts and residual(surface, curves) < 1e-12
    assert_contour(curves.points, surface, eye, 1e-10)
    other = contour(same, eye, tracing=Tracing(tolerance=1e-5))
    assert len(curves) == len(other)
    assert_same_curve(lines(curves), lines(other), 2.1e-5)


@pytest.mark.slow
@both_ways
@pytest.mark.spread(parts=2)
@pytest.mark.capability("G8.4-isophote")
def test_isophotes_are_those_of_the_parametrised_surfaces(surface, same, sign):
    cosines = np.array([-0.7, 0.05, 0.6])
    curves = implicit_isophotes(surface, LIGHT, cosines, tracing=FINE)
    assert curves.closed.all() and not curves.doubts
    for cosine in cosines:
        mine = [curves[k] for k in np.flatnonzero(curves.levels == cosine)]
        assert_isophote(np.concatenate(mine), surface, LIGHT, np.arccos(cosine), 1e-10)
        if sign:
            other = isophotes(same, LIGHT, [sign * cosine], tracing=Tracing(tolerance=1e-5))
            assert len(mine) == len(other)
            assert_same_curve(mine, lines(other), 2.1e-5)


@pytest.mark.slow
def test_isophotes_of_a_point_light():
    lamp = (5.0, 1.0, 4.0)
    curves = implicit_point_light_isophotes(ImplicitTorus(3, 1), lamp, [0.4], tracing=FINE)
    other = point_light_isophotes(Torus(3, 1), lamp, [-0.4], tracing=Tracing(tolerance=1e-5))
    assert len(curves) == len(other) and curves.closed.all()
    assert_same_curve(lines(curves), lines(other), 2.1e-5)


def test_the_condition_is_positive_on_the_left():
    surface = implicit_sphere(2.0)
    (curve,) = lines(implicit_plane_sections(surface, (0, 0, 1), [0.5]))
    middle, along = (curve[1:] + curve[:-1]) / 2, np.diff(curve, axis=0)
    assert (np.cross(surface.gradients(middle), along)[:, 2] > 0).all()


def test_contour_of_an_ellipsoid_lies_in_the_polar_plane():
    axes = np.array([3.0, 2.0, 1.0])
    curves = implicit_contour(implicit_ellipsoid(axes), EYE)
    assert len(curves) == 1 and curves.closed.all()
    assert np.abs(curves.points @ (EYE / axes**2) - 1.0).max() < 1e-11


def test_contours_of_cylinder_and_hyperboloid_end_on_the_sides_of_the_box():
    rod = implicit_contour(implicit_cylinder(1.0, (0, 0, 0), (0, 0, 1), BOX), (4.0, 0.0, 7.0))
    assert len(rod) == 2 and not rod.closed.any() and not rod.doubts
    assert np.abs(rod.points[:, 0] - 0.25).max() < 1e-11
    assert all(sorted(rod[k][[0, -1], 2]) == [-2.0, 2.0] for k in range(2))
    waist = Quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, -0.5], BOX)
    eye = np.array([6.0, 1.0, 2.0])
    curves = implicit_contour(waist, eye)
    assert np.abs((curves.points * [1, 1, -1]) @ eye - 0.5).max() < 1e-11
    ends = np.concatenate([curves[k][[0, -1]] for k in range(len(curves))])
    assert not curves.closed.any() and (np.abs(ends).max(axis=1) == 2.0).all()


@pytest.mark.hard(46)
@pytest.mark.parametrize("apex", [(0.0, 0.0, 0.0), (0.1, 0.03, -0.21)])
def test_contour_of_a_cone_runs_through_the_apex_without_a_spike(apex):
    cone = implicit_cone(0.5, apex, (0, 0, 1), BOX)
    curves = implicit_contour(cone, (5.0, 1.0, -0.5), tracing=ImplicitTracing(mesh=implicit_mesh(cone, 64)))
    assert len(curves.nodes) == 1 and np.abs(curves.nodes[0] - apex).max() < 1e-12
    assert len(curves) == 2 and not curves.closed.any()
    for k in range(2):
        p = curves[k] - apex
        direction = p[np.argmax(np.linalg.norm(p, axis=1))]
        assert np.linalg.norm(np.cross(p, direction / np.linalg.norm(direction)), axis=1).max() < 1e-9


@pytest.mark.capability("G8.4-intersection")
def test_steinmetz_curve_is_two_ellipses_through_two_nodes():
    one, two = (implicit_cylinder(1.0, (0, 0, 0), axis, BOX) for axis in ((0, 0, 1), (1, 0, 0)))
    curves = implicit_intersection(one, two)
    assert_on_both(curves.points, one, two, 1e-11)
    assert len(curves) == 2 and curves.closed.all() and len(curves.nodes) == 2
    assert np.abs(np.abs(curves.nodes) - (0, 1, 0)).max() < 1e-9
    for p in lines(curves):
        assert min(np.abs(p[:, 2] - p[:, 0]).max(), np.abs(p[:, 2] + p[:, 0]).max()) < 1e-9


@pytest.mark.slow
@pytest.mark.capability("G8.4-intersection")
def test_viviani_curve_is_one_closed_curve_through_its_node():
    ball, rod = implicit_sphere(2.0), implicit_cylinder(1.0, (1, 0, 0), (0, 0, 1), BOX)
    t = np.linspace(0, 4 * np.pi, 20001)
    true = np.stack([1 + np.cos(t), np.sin(t), 2 * np.sin(t / 2)], axis=1)
    curves = implicit_intersection(ball, rod, tracing=ImplicitTracing(tolerance=1e-5))
    assert len(curves) == 1 and curves.closed.all() and np.abs(curves.nodes - (2, 0, 0)).max() < 1e-9
    assert_same_curve(curves[0], true, 2e-5)


@pytest.mark.capability("G8.4-intersection")
@pytest.mark.parametrize("cells", [24, 48, 64])
def test_villarceau_circles_cross_in_two_nodes(cells):
    curves = implicit_plane_sections(
        ImplicitTorus(3, 1), (0, -1, np.sqrt(8)), [0.0], tracing=ImplicitTracing(cells=cells)
    )
    assert len(curves) == 2 and curves.closed.all() and len(curves.nodes) == 2
    for p in lines(curves):
        off = [np.abs(np.linalg.norm(p - (s, 0, 0), axis=1) - 3.0).max() for s in (1, -1)]
        assert min(off) < 1e-9


def test_a_tangent_plane_at_the_inner_equator_gives_a_curve_with_a_node():
    curves = implicit_plane_sections(ImplicitTorus(3, 1), (1, 0, 0), [2.0, 3.9999])
    assert [int((curves.levels == x).sum()) for x in (2.0, 3.9999)] == [1, 1]
    assert np.abs(curves.nodes - (2, 0, 0)).max() < 1e-7 and curves.closed.all()


@pytest.mark.hard(40)
@pytest.mark.parametrize("height", [0.99, 0.999, 0.99999])
def test_tiny_ovals_are_found_by_local_subdivision(height):
    # Much smaller than a cell of 0.02.
    centre = (0.013, 0.021, 0.0)
    curves = implicit_plane_sections(
        implicit_sphere(1.0, centre), (0, 0, 1), [height], tracing=ImplicitTracing(tolerance=1e-6)
    )
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts
    away = np.linalg.norm(curves.points[:, :2] - centre[:2], axis=1)
    assert np.abs(away - np.sqrt(1.0 - height**2)).max() < 1e-10
    turns = np.arctan2(*(curves[0][:, :2] - centre[:2]).T[::-1])
    assert abs(abs(np.diff(np.unwrap(turns)).sum()) - 2 * np.pi) < 1e-9


@pytest.mark.hard(43)
@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 2, 0.3), (0, -1, 0)])
def test_a_plane_that_touches_a_sphere_gives_a_point(normal):
    n = np.array(normal) / np.linalg.norm(normal)
    curves = implicit_plane_sections(implicit_sphere(2.0), normal, [2.0])
    assert len(curves) == 0 and len(curves.isolated) == 1
    assert np.linalg.norm(curves.isolated[0] - 2.0 * n) < 1e-6


@pytest.mark.hard(44)
def test_coinciding_surfaces_and_those_seen_edge_on_say_so():
    curves = implicit_intersection(implicit_sphere(2.0), implicit_sphere(2.0))
    assert len(curves) == 0 and len(curves.doubts) == 1
    rod = implicit_cylinder(1.0, (0, 0, 0), (0, 0, 1), BOX)
    assert implicit_parallel_contour(rod, (0, 0, 1)).doubts


@pytest.mark.hard(47)
def test_an_isophote_on_a_flat_part_is_not_filled():
    flat = implicit_plane((0, 0, 0.1), (0, 0, 1), BOX)
    curves = implicit_isophotes(flat, (0, 0, 1), [1.0])
    assert len(curves) == 0 and curves.doubts


@pytest.mark.slow
@pytest.mark.hard(39)
def test_touching_along_a_line_is_said():
    curves = implicit_plane_sections(ImplicitTorus(3, 1), (0, 0, 1), [1.0])
    assert len(curves) == 0 and curves.doubts


@pytest.mark.hard(42)
def test_a_plane_that_misses_gives_nothing():
    curves = implicit_plane_sections(implicit_sphere(2.0), (0, 0, 1), [2.1])
    assert len(curves) == 0 and curves.points.shape == (0, 3) and not curves.doubts
    empty = implicit_of_function(lambda x, y, z: x * x + 1.0, BOX)
    assert len(implicit_contour(empty, EYE)) == 0 and len(implicit_borders(empty, tracing=ImplicitTracing())) == 0


def test_borders_lie_on_the_sides_of_the_box_and_meet_at_its_edges():
    ball = implicit_sphere(2.5)
    inner = Quadric(ball.coefficients, BOX)
    curves = implicit_borders(inner, tracing=ImplicitTracing(tolerance=1e-4))
    assert len(curves) == 6 and curves.closed.all() and residual(inner, curves) < 1e-12
    assert (np.abs(curves.points).max(axis=1) == 2.0).all()
    for p in lines(curves):
        assert abs(np.linalg.norm(np.diff(p, axis=0), axis=1).sum() - 2 * np.pi * 1.5) < 2e-3
    slab = implicit_plane((0.1, 0.2, 0.3), (1, 2, 3), BOX)
    rim = implicit_borders(slab, tracing=ImplicitTracing())
    total = sum(np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in lines(rim))
    corner = np.abs(rim.points) == 2.0
    assert corner.any(axis=1).all() and (corner.sum(axis=1) == 2).sum() == 2 * len(rim)
    assert not rim.closed.any() and total > 8.0


@pytest.mark.slow
def test_on_a_mesh_as_coarse_as_to_be_folded_no_curve_runs_to_and_fro_and_no_arc_is_met_twice():
    def waist(x, y, z):
        return (x * x + y * y + z * z) ** 2 - 2 * (x * x - y * y) - 0.02 + 0.3 * z * z

    surface = implicit_of_function(waist, BOX)
    eye = np.array([8.2018916, -1.9960486, -8.5290537])
    for cells in (32, 48, 80):
        curves = implicit_contour(surface, eye, tracing=ImplicitTracing(cells=cells, tolerance=1e-3))
        assert len(curves) == 3 and curves.closed.all()
        for p in lines(curves):
            chord = np.diff(p, axis=0)
            assert ((chord[1:] * chord[:-1]).sum(axis=1) > 0).all()


@pytest.mark.slow
def test_a_user_function_without_derivatives():
    def blobs(x, y, z):
        return np.exp(-3 * ((x - 0.5) ** 2 + y * y + z * z)) + np.exp(-3 * ((x + 0.5) ** 2 + y * y + z * z)) - 0.6

    surface = implicit_of_function(blobs, BOX)
    curves = implicit_contour(surface, EYE)
    assert_on_surface(curves.points, surface, 1e-11)
    assert_contour(curves.points, surface, EYE, 1e-9)
    assert len(curves) and curves.closed.all()
    stacked = implicit_of_function(lambda x, y, z: blobs(x, y, np.hypot(z, 0.0)), BOX)
    assert_same_curve(lines(implicit_contour(stacked, EYE)), lines(curves), 1e-2)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_scaled_and_shifted_scenes_are_the_same(scale, offset):
    centre = np.array([offset, 0.0, 0.0]) * scale
    surface, eye = ImplicitTorus(3 * scale, 2 * scale, centre), EYE * scale + centre
    curves = implicit_contour(surface, eye)
    assert len(curves) == 2 and curves.closed.all() and not curves.doubts
    assert residual(surface, curves) < (1e-12 if not offset else 1e-9)
    section = implicit_plane_sections(surface, (1, 0, 0), [centre[0]])
    assert len(section) == 2 and section.closed.all()


def test_chords_keep_the_tolerance_where_the_picture_measures_it():
    surface = implicit_sphere(1.0)
    curves = implicit_plane_sections(
        surface, (0, 0, 1), [0.2], tracing=ImplicitTracing(tolerance=0.01, picture=lambda p: 100.0 * p)
    )
    p = curves[0]
    middle = np.linalg.norm((p[1:, :2] + p[:-1, :2]) / 2, axis=1)
    assert np.abs(middle - np.sqrt(0.96)).max() < 1e-4
    assert len(p) < 1000


def test_wrong_input_is_named():
    ball = implicit_sphere(1.0)
    for call in (
        lambda: implicit_isophotes(ball, LIGHT, [1.2]),
        lambda: implicit_plane_sections(ball, (0, 0, 1), [np.nan]),
        lambda: implicit_plane_sections(ball, (0, 0, 0), [0.0]),
        lambda: implicit_contour(ball, (np.nan, 0, 0)),
        lambda: implicit_contour(ball, EYE, tracing=ImplicitTracing(tolerance=-1.0)),
        lambda: implicit_contour(ball, EYE, tracing=ImplicitTracing(resolution=0.0)),
    ):
        with pytest.raises(InputError):
            call()
