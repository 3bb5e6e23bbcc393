"""Curves that say in which directions they run are held to the field along their chords too."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features
from vectorplot.drawing.drawing import Paths
from vectorplot.features import integral_curves
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.surface_points import Sites
from vectorplot.features.tangent_fields import IsophoteDirections
from vectorplot.scene import GeodesicLines
from vectorplot.surfaces import Ellipsoid, Sphere, Torus
from vectorplot.testing import assert_geodesic, assert_integral_curve, curves_in_space
from vectorplot.testing.curves import polylines_of
from vectorplot.words import LineKind

BALL, FIELD = Sphere(2.0), features.loxodromes(1.1)
CHORDS = "chords are not on a curve of the field"


@cache
def found(step=0.01, field=FIELD):
    return integral_curves(BALL, field, ((0.1, 0.2), (2.0, -0.4)), length=2.0, tracing=Tracing(tolerance=step))


def on_ball(curves, u, v, **changes):
    """The same curves with other points, in the directions that they had: u turns the ball."""
    return replace(curves, points=BALL.points(u, v), u=u, v=v, **changes)


@pytest.mark.parametrize("step", [1e-4, 0.01, 0.2])
def test_curves_of_the_field_pass_however_coarse_they_are(step):
    assert_integral_curve(found(step), BALL, FIELD, 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("aside", [0.3, 0.03])
def test_points_beside_the_curve_fail_though_directions_there_are_right(aside):
    right = found(1e-4)
    length = np.linalg.norm(np.diff(right.points, axis=0), axis=1).min()
    # Across the meridians, to and fro; the field is the same all round the axis.
    wrong = on_ball(right, right.u + aside * length / 2.0 * (np.arange(len(right.u)) % 2), right.v)
    with pytest.raises(AssertionError, match=CHORDS):
        assert_integral_curve(wrong, BALL, FIELD, 1e-6)


def test_a_curve_that_jumps_to_a_neighbour_fails():
    right = found()
    wrong = on_ball(right, right.u - 0.1 * (np.arange(len(right.u)) >= right.offsets[1] // 2), right.v)
    with pytest.raises(AssertionError, match="1 of .* " + CHORDS):
        assert_integral_curve(wrong, BALL, FIELD, 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("off", [0.2, 0.02])
def test_a_curve_of_another_field_fails_that_claims_the_directions_of_this_one(off):
    other = found(1e-4, features.loxodromes(1.1 + off))
    along_u, along_v = BALL.partials(other.u, other.v)
    field = FIELD.tangents(Sites(BALL, other.u, other.v))[0]
    parts = [(field * a).sum(axis=1) / (a * a).sum(axis=1) for a in (along_u, along_v)]
    with pytest.raises(AssertionError, match=CHORDS):
        assert_integral_curve(replace(other, directions=np.column_stack(parts)), BALL, FIELD, 1e-6)


def test_curves_with_inflections_pass():
    ring = Torus(3.0, 1.2)
    light = IsophoteDirections((2.0, -3.0, 4.0))
    curves = integral_curves(ring, light, (0.3, 0.7), length=3.0, tracing=Tracing(tolerance=0.05))
    assert_integral_curve(curves, ring, light, 1e-6)


@pytest.mark.slow
def test_geodesics_are_held_to_the_directions_that_they_know():
    """Chords alone tell a hundredth of the curvature of this one."""
    found = features.geodesics(Torus(3, 1), (1.0, 2.0), 1.1, length=5)
    assert_geodesic(found, Torus(3, 1), 1e-4)
    assert_geodesic(features.geodesics(Sphere(radius=2), (0.0, 0.0), 1.0, length=8), Sphere(radius=2), 1e-8)
    with pytest.raises(AssertionError, match="points are not on a geodesic"):
        assert_geodesic(replace(found, directions=found.directions * (1.0, 1.001)), Torus(3, 1), 1e-4)
    blind = replace(found, directions=np.full_like(found.directions, np.nan))
    with pytest.raises(AssertionError, match="at u, v = "):
        assert_geodesic(blind, Torus(3, 1), 1e-4)
    assert_geodesic(blind, Torus(3, 1), 0.05)


@pytest.mark.slow
@pytest.mark.parametrize("count", [2, 3])
def test_geodesics_from_one_point_that_the_pen_draws_in_one_stroke_are_geodesics_each(count):
    surface = Ellipsoid((3.0, 2.0, 1.2))
    starts = tuple((0.3, 0.1, angle) for angle in np.linspace(0.2, np.pi, count, endpoint=False))
    lines = vp.SurfaceLines(integral=(GeodesicLines(starts, length=9.0),))
    drawing = vp.draw(vp.Item("ellipsoid", surface, curves=lines), vp.Camera((8, 6, 6)), page="A5", hidden="solid")
    curves = curves_in_space(drawing, kind="integral")
    strokes = [layer.strokes for layer in drawing.layers]
    assert len(curves) > sum((paths.kind == LineKind.INTEGRAL).sum() for group in strokes for paths in group)
    # Points and no directions: the curvature is right but for what neighbouring chords differ by in length.
    assert_geodesic(curves, surface, 0.2)


def test_a_smooth_stroke_is_parted_at_its_corners_and_not_in_its_cusps():
    """A ring whose first point is no corner: what is before it goes on behind it."""
    points = np.array([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0)])
    angles = np.zeros((6, 2))
    angles[2, 1], angles[3], angles[4] = np.pi / 2.0, (np.pi / 2.0, np.pi), (np.pi, 0.0)
    angles[5, 1] = -np.pi / 2.0
    fields = {name: np.zeros(1, dtype=np.intp) for name in ("kind", "item", "hidden_by")}
    paths = Paths(
        points=points,
        offsets=np.array([0, 6]),
        closed=np.array([True]),
        points3d=np.column_stack([points, np.zeros(6)]),
        smooth=np.array([True]),
        directions=angles,
        **fields,
    )
    assert [len(curve) for curve in polylines_of(paths)] == [4, 2, 3]
    assert [len(curve) for curve in polylines_of(replace(paths, smooth=np.array([False])))] == [7]
