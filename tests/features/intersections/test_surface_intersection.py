"""Intersections of two parametrised surfaces, against closed forms and against sections with implicit surfaces."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.errors import InputError
from vectorplot.features.contours_and_isophotes import section_by_implicit
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.intersections import intersections_of_grids, surface_intersection
from vectorplot.features.patches import SurfaceGrids
from vectorplot.geometry.rotations import rotation_about
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Ellipsoid, Sphere, implicit_ellipsoid, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus

QUARTER = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])


def length(curves):
    return sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves)))


def sharpest_turn(curves):
    """The smallest cosine between the directions of neighbouring chords."""
    worst = 1.0
    for k in range(len(curves)):
        chords = np.diff(curves[k], axis=0)
        size = np.linalg.norm(chords, axis=1)
        chords = chords[size > 0] / size[size > 0][:, None]
        worst = min(worst, (chords[1:] * chords[:-1]).sum(axis=1).min(initial=1.0))
    return worst


def residual(one, two, curves):
    """How far apart the points on both surfaces are."""
    return np.abs(one.points(*curves.one.T) - two.points(*curves.two.T)).max(initial=0.0)


@pytest.mark.capability("G8.4-intersection")
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_two_spheres_meet_in_a_circle(scale, offset):
    far = np.array([offset, -offset, 0.5 * offset]) * scale
    one, two = Sphere(2.0 * scale, far), Sphere(2.0 * scale, far + np.array([1.0, 0.5, 0.0]) * scale)
    curves = surface_intersection(one, two)
    noise = 1e-12 if offset == 0.0 else 1e-9
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts
    assert residual(one, two, curves) < 4 * noise * scale
    assert np.abs((curves.points - far) @ (1.0, 0.5, 0.0) - 0.625 * scale).max() < 8 * noise * scale
    assert abs(length(curves) - 2 * np.pi * np.sqrt(4 - 0.3125) * scale) < 0.02 * scale


def test_chords_keep_the_tolerance_where_the_picture_measures_it():
    one, two = Sphere(2.0), Sphere(2.0, (1.0, 0.5, 0.0))
    centre, radius = np.array([0.5, 0.25, 0.0]), np.sqrt(4 - 0.3125)
    sizes = []
    for tolerance in (0.1, 1e-3):
        fine = Tracing(columns=8, rows=8, tolerance=tolerance, picture=lambda p: 100.0 * p)
        curve = surface_intersection(one, two, tracing=fine)[0]
        middles = 0.5 * (curve[1:] + curve[:-1])
        off = radius - np.linalg.norm(middles - centre, axis=1)
        assert 0.0 < 100.0 * off.max() < tolerance
        sizes.append(len(curve))
    assert sizes[1] > 5 * sizes[0]


@pytest.mark.hard(38)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_steinmetz_curve_is_two_ellipses_through_two_nodes(scale):
    one = PlacedSurface(Cylinder(1.0, -2.0, 2.0), scale * np.eye(3))
    curves = surface_intersection(one, PlacedSurface(Cylinder(1.0, -2.0, 2.0), scale * QUARTER))
    assert len(curves) == 2 and curves.closed.all() and not curves.doubts
    assert np.abs(np.abs(curves.nodes / scale) - (0, 1, 0)).max() < 1e-9 and len(curves.nodes) == 2
    for k in range(2):
        x, _, z = curves[k].T / scale
        assert min(np.abs(z - x).max(), np.abs(z + x).max()) < 1e-9


@pytest.mark.hard(38)
def test_viviani_curve_passes_the_poles_and_its_node():
    curves = surface_intersection(Sphere(2.0), Cylinder(1.0, -3.0, 3.0, (1, 0, 0)))
    x, y, z = curves.points.T
    assert np.abs((x - 1) ** 2 + y * y - 1).max() < 1e-11 and np.abs(x * x + y * y + z * z - 4).max() < 1e-11
    assert len(curves) == 1 and curves.closed.all() and np.abs(curves.nodes - (2, 0, 0)).max() < 1e-9
    t = np.linspace(0, 4 * np.pi, 20001)
    true = np.stack([1 + np.cos(t), np.sin(t), 2 * np.sin(t / 2)], axis=1)
    assert abs(length(curves) - np.linalg.norm(np.diff(true, axis=0), axis=1).sum()) < 0.02


@pytest.mark.parametrize(("radius", "sign"), [(1.0001, 1), (0.9999, -1)])
def test_a_crossing_that_is_just_avoided_is_avoided_the_right_way(radius, sign):
    curves = surface_intersection(Cylinder(1.0, -2.0, 2.0), PlacedSurface(Cylinder(radius, -2.0, 2.0), QUARTER))
    assert len(curves) == 2 and curves.closed.all() and not len(curves.nodes)
    # The thinner cylinder pierces the thicker one: each curve stays on one side of it.
    across = 0 if sign > 0 else 2
    for k in range(2):
        side = curves[k][:, across]
        assert (side > 0).all() or (side < 0).all() or np.abs(curves[k][:, 2 - across]).max() > 0.9


@pytest.mark.slow
@given(
    st.sampled_from(["sphere", "torus", "ellipsoid"]),
    st.sampled_from([Torus(2.0, 0.8), Ellipsoid((1.0, 2.0, 1.4)), Sphere(1.6)]),
    st.tuples(*[st.floats(-1.5, 1.5)] * 3),
)
@settings(max_examples=examples(12))
def test_the_same_curves_as_the_section_with_the_implicit_surface(kind, base, centre):
    pairs = {
        "sphere": lambda: (Sphere(1.3, centre), implicit_sphere(1.3, centre)),
        "torus": lambda: (Torus(1.5, 0.6, centre), ImplicitTorus(1.5, 0.6, centre)),
        "ellipsoid": lambda: (Ellipsoid((2, 0.3, 0.7), centre), implicit_ellipsoid((2, 0.3, 0.7), centre)),
    }
    shape, implicit = pairs[kind]()
    expected = section_by_implicit(base, implicit, tracing=Tracing(tolerance=1e-4))
    curves = surface_intersection(base, shape, tracing=Tracing(tolerance=1e-4))
    if len(expected.nodes) or len(expected.isolated) or expected.doubts:
        return
    assert len(curves) == len(expected) and residual(base, shape, curves) < 2e-11
    assert abs(length(curves) - length(expected)) < 2e-3
    assert np.abs(implicit.values(curves.points)).max(initial=0.0) < 1e-9


@pytest.mark.hard(40)
@pytest.mark.parametrize("gap", [1e-4, 1e-6])
def test_a_loop_far_below_the_tessellation_is_found(gap):
    way = np.array([0.6, 0.0, 0.8])
    curves = surface_intersection(Sphere(1.0), Sphere(1.0, (2.0 - gap) * way))
    assert len(curves) == 1 and curves.closed.all()
    radius = np.sqrt(1.0 - (1.0 - gap / 2) ** 2)
    assert np.abs(np.linalg.norm(curves.points - (1.0 - gap / 2) * way, axis=1) - radius).max() < 1e-9


@pytest.mark.hard(43)
@pytest.mark.parametrize("way", [(0.6, 0.0, 0.8), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])
def test_touching_spheres_give_an_isolated_point(way):
    curves = surface_intersection(Sphere(1.0), Sphere(1.0, 2.0 * np.array(way)))
    assert len(curves) == 0 and np.abs(curves.isolated - way).max() < 1e-8 and len(curves.isolated) == 1


@pytest.mark.slow
@pytest.mark.hard(44)
@pytest.mark.parametrize(
    ("one", "two"),
    [
        (Sphere(2.0), Sphere(2.0)),
        (Sphere(1.0), PlacedSurface(Sphere(1.0), rotation_about((1, 2, 3), 0.7))),
        (Cylinder(1.0, -2.0, 2.0), Cylinder(1.0, -1.0, 3.3)),
        (Sphere(1.0, (1e6, 0, 0)), PlacedSurface(Sphere(1.0), rotation_about((1, 2, 3), 0.7), (1e6, 0, 0))),
    ],
)
def test_coincident_patches_are_reported_without_noise(one, two):
    curves = surface_intersection(one, two)
    assert len(curves) == 0 and len(curves.isolated) == 0
    assert len(curves.doubts) == 1 and "coincide in an area" in curves.doubts[0]


def _bent(u, v):
    return np.stack([u, v, np.sin(u) * np.cos(v)], axis=-1)


def _tube(u, v):
    return np.stack([np.cos(u), np.sin(u), v], axis=-1)


def _ring(u, v):
    return np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)


def _roof(u, v):
    return np.stack([u, v, -np.abs(u)], axis=-1)


def _rolled(u, v):
    """Meets itself where u = 1 and u = -1."""
    return np.stack([u**2, u**3 - u, v], axis=-1)


def _part(points, *domain, closed_v=False):
    return surface_of_function(lambda u, v: points(*np.broadcast_arrays(u, v)), Domain(*domain, closed_v=closed_v))


@pytest.mark.parametrize(
    ("one", "two"),
    [
        (_part(_tube, 0, np.pi, -1, 1), _part(_tube, np.pi, 2 * np.pi, -1, 1)),
        (_part(_tube, 0, np.pi, -1, 1), _part(_tube, np.pi, 5, -1, 1)),
        (_part(_bent, -1, 0.3, -1, 1), _part(_bent, 0.3, 1, -1, 1)),
        (_part(_bent, -1, 0.3, -1, 1), _part(_bent, 0.3, 1, -0.5, 1.5)),
        (_part(_bent, -1, 1, 0.3, 1), _part(_bent, -1, 1, -1, 0.3)),
        (_part(_ring, 0, np.pi, 0, 2 * np.pi, closed_v=True), _part(_ring, np.pi, 2 * np.pi, 0, 2 * np.pi)),
        (_part(_roof, -1, 0, -1, 1), _part(_roof, 0, 1, -1, 1)),
    ],
)
def test_patches_with_a_common_border_meet_nowhere_else(one, two):
    curves = surface_intersection(one, two)
    assert len(curves) == 0 and not curves.doubts
    assert len(curves.touching) == 0 and len(curves.isolated) == 0


def test_patches_with_a_common_border_that_cross_elsewhere_meet_there():
    curves = surface_intersection(_part(_rolled, -1.5, 0.2, 0, 1), _part(_rolled, 0.2, 1.5, 0, 1))
    assert len(curves) == 1 and not curves.doubts
    assert abs(length(curves) - 1.0) < 1e-9 and np.abs(curves.points[:, :2] - (1.0, 0.0)).max() < 1e-9


@pytest.mark.hard(44)
@pytest.mark.parametrize("overlap", [0.1, 0.001])
def test_patches_that_overlap_in_a_strip_are_reported(overlap):
    curves = surface_intersection(_part(_bent, -1, 0.3, -1, 1), _part(_bent, 0.3 - overlap, 1, -1, 1))
    assert len(curves) == 0 and any("coincide in an area" in text for text in curves.doubts)


@pytest.mark.hard(44)
def test_touching_along_a_line_is_reported_without_noise():
    curves = surface_intersection(Sphere(1.0), Cylinder(1.0, -2.0, 2.0))
    assert len(curves) == 0 and "along a line" in curves.doubts[0]
    assert np.abs(curves.touching[:, 2]).max() < 1e-6


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("distance", [0.1, 0.01, 0.001])
def test_nearly_coincident_spheres_meet_in_one_circle_that_does_not_turn_back(distance):
    way = np.array([1.0, 0.3, 0.7]) / np.linalg.norm([1.0, 0.3, 0.7])
    curves = surface_intersection(Sphere(1.0), Sphere(1.0, distance * way))
    assert len(curves) == 1 and curves.closed.all() and sharpest_turn(curves) > 0.98
    assert abs(length(curves) - 2 * np.pi * np.sqrt(1 - distance**2 / 4)) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("gap", [1e-2, 1e-3])
def test_two_circles_close_to_one_another_are_two(gap):
    curves = surface_intersection(Torus(3.0, 1.0), Torus(3.0, 1.0, (0.0, 0.0, 2.0 - gap)))
    assert len(curves) == 2 and curves.closed.all() and not curves.doubts and sharpest_turn(curves) > 0.98
    width = np.sqrt(1 - (1 - gap / 2) ** 2)
    radii = sorted(np.hypot(*curves[k][:, :2].T).mean() for k in range(2))
    assert np.abs(np.array(radii) - (3 - width, 3 + width)).max() < 1e-9


@pytest.mark.slow
def test_curves_too_close_for_the_triangles_are_doubted():
    curves = surface_intersection(Torus(3.0, 1.0), Torus(3.0, 1.0, (0.0, 0.0, 2.0 - 1e-6)))
    assert any("too close" in text for text in curves.doubts)


def test_curves_end_at_borders_exactly():
    patch = surface_of_function(lambda u, v: (u, v, 0.3 + 0.1 * u * v), Domain(-1, 2, 0, 2))
    curves = surface_intersection(Sphere(1.5), patch)
    assert len(curves) == 1 and not curves.closed.any()
    ends = np.sort(curves.two[[0, -1]], axis=0)
    assert ends[0, 0] == -1.0 and ends[0, 1] == 0.0


def test_surfaces_that_miss_each_other_give_nothing():
    curves = surface_intersection(Sphere(1.0), Sphere(1.0, (5.0, 0.0, 0.0)))
    assert len(curves) == 0 and curves.points.shape == (0, 3) and not curves.doubts


def test_holes_end_curves_and_empty_surfaces_have_none():
    holey = surface_of_function(lambda u, v: (u, v, np.where(u > 0.7, np.nan, 0.0 * u)), Domain(-2, 2, -2, 2))
    curves = surface_intersection(Sphere(1.0), holey)
    assert len(curves) == 1 and not curves.closed.any() and np.isfinite(curves.points).all()
    nothing = surface_of_function(lambda u, v: (u, v, np.nan * u), Domain(-2, 2, -2, 2))
    assert len(surface_intersection(Sphere(1.0), nothing)) == 0


def test_grids_that_are_too_coarse_or_too_fine_are_refused():
    for columns in (2, 1 << 20):
        with pytest.raises(InputError, match="tessellation"):
            surface_intersection(Sphere(1.0), Sphere(1.0), tracing=Tracing(columns=columns))


@dataclass(frozen=True, eq=False)
class Unplaced:
    """A surface that says no more than it has to: it is intersected alone."""

    surface: PlacedSurface

    domain = property(lambda self: self.surface.domain)
    points = property(lambda self: self.surface.points)
    partials = property(lambda self: self.surface.partials)
    second_partials = property(lambda self: self.surface.second_partials)


@pytest.mark.slow
def test_many_pairs_at_once_have_the_curves_of_each_alone():
    rng = np.random.default_rng(3)
    wave = surface_of_function(lambda u, v: (u, v, 0.3 * np.sin(3 * u) * np.cos(2 * v)), Domain(-1, 1, -1, 1))
    made = [Torus(1.0, 0.3), Cylinder(0.5, -1.0, 1.0), wave, Sphere(0.8)]
    turned = [np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in made]
    placed = [PlacedSurface(s, m, rng.uniform(-0.4, 0.4, 3)) for s, m in zip(made, turned, strict=True)]
    # One that meets no other, and two that touch in a point.
    placed += [PlacedSurface(Torus(1.0, 0.3), np.eye(3), (9.0, 0.0, 0.0)), *touching_balls()]
    pairs = [(i, j) for i in range(len(placed)) for j in range(i + 1, len(placed)) if j < 5 or i == 5]
    tracing, grids = Tracing(columns=15, rows=13), [SurfaceGrids(surface) for surface in placed]
    found = intersections_of_grids([(grids[i], grids[j]) for i, j in pairs], tracing)
    for (i, j), curves in zip(pairs, found, strict=True):
        alone = surface_intersection(Unplaced(placed[i]), Unplaced(placed[j]), tracing=tracing)
        assert residual(placed[i], placed[j], curves) < 1e-9
        assert sorted(curves.closed) == sorted(alone.closed) and curves.doubts == alone.doubts
        assert [len(x) for x in (curves.isolated, curves.nodes)] == [len(x) for x in (alone.isolated, alone.nodes)]
        assert abs(length(curves) - length(alone)) <= 1e-3 * length(alone)
    assert sum(map(len, found)) > 8 and max(map(len, found)) > 1
    assert len(found[-1].isolated) == 1


def touching_balls():
    return [PlacedSurface(Sphere(1.0), QUARTER, (20.0 + x, 0.0, 0.0)) for x in (0.0, 2.0)]
