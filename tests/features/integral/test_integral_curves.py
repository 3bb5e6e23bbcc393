"""Integral curves: right to the digits asked for, over seams and through poles, closed where they close."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features
from vectorplot.curves import Loxodrome
from vectorplot.errors import InputError
from vectorplot.features import geodesics, integral_curves
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.geodesic_curves import geodesics_between
from vectorplot.features.streamlines import evenly_spaced_curves
from vectorplot.features.surface_integration import Accuracy
from vectorplot.features.surface_points import Sites
from vectorplot.features.tangent_fields import ParameterField, principal
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.scene import FieldLines
from vectorplot.surfaces import (
    Cone,
    Cylinder,
    Domain,
    Ellipsoid,
    HyperbolicParaboloid,
    ImplicitTorus,
    PlacedSurface,
    Sphere,
    Torus,
    graph,
    helicoid_to_catenoid,
)
from vectorplot.surfaces.trimmed import CutSurface
from vectorplot.testing import assert_geodesic, assert_integral_curve

FINE, COARSE = Tracing(tolerance=1e-3), Tracing(tolerance=0.05)

EIGHT_DIGITS = Accuracy(1e-7)
"""What keeps eight digits: estimates are of the step of order 4, and the one of order 5 is taken."""


def at(surface, u, v):
    return Sites(surface, np.array([u]), np.array([v]))


@pytest.mark.capability("G9.4-field")
@pytest.mark.capability("G9.4-loxodrome")
def test_a_loxodrome_of_the_sphere_is_that_of_the_formula_over_ten_turns():
    trace = np.radians(88.5)
    found = integral_curves(
        Sphere(),
        features.loxodromes(np.pi + trace),
        (0, 0),
        length=46.0,
        both_ways=False,
        tracing=COARSE,
    )
    assert found.u[-1] > 20.0 * np.pi
    exact = Loxodrome(1.0, trace, 0.0, 30.0 * np.pi).points(found.u)
    assert np.abs(found.points - exact).max() < 1e-8


@pytest.mark.capability("G9.4-helix")
def test_the_unit_tangent_of_a_helix_is_that_of_the_test_value():
    normal = np.array([0.3, -0.5, 0.8])
    plane = graph(lambda x, y: -(0.3 * x - 0.5 * y) / 0.8, Domain(-1, 1, -1, 1))
    sites = at(plane, 0.0, 0.0)
    assert np.allclose(sites.normals[0], normal / np.linalg.norm(normal), atol=1e-12)
    both = [features.ConstantElevation(0.3, side).tangents(sites)[0, 0] for side in (1, -1)]
    expected = (0.533155051330184, 0.792725361456254, 0.29552020666134)
    assert min(np.abs(tangent - expected).max() for tangent in both) < 1e-12


@pytest.mark.slow
@pytest.mark.capability("G9.4-helix")
@pytest.mark.hard(51)
def test_a_helix_keeps_its_elevation_and_ends_where_it_is_no_longer_real():
    for side in (1, -1):
        found = integral_curves(Sphere(2.0), features.ConstantElevation(0.3, side), (0, 0), tracing=FINE)
        # On a sphere the slope at the height z is the angle from the pole.
        ends = np.array([-1.0, 1.0]) * 2.0 * np.cos(0.3)
        assert np.allclose(found.points[[0, -1], 2], ends, atol=1e-5)
        field = features.ConstantElevation(0.3, side)
        assert_integral_curve(found[0][5:-5], Sphere(2.0), field, 2e-3)
        assert (np.diff(found.points[:, 2]) > 0.0).all()
    # The rise of a helix of a cylinder is its length times the sine.
    helix = integral_curves(
        Cylinder(1.0, 0.0, 9.0),
        features.ConstantElevation(0.2),
        (0, 0),
        both_ways=False,
        tracing=COARSE,
    )
    turn = -helix.u * np.tan(0.2)
    assert np.abs(helix.points[:, 2] - turn).max() < 1e-8 and abs(helix.v[-1] - 9.0) < 1e-12


def fitted_circle(x, y):
    """The centre and the radius of the circle that fits points best, which are on it to eight digits."""
    a, b, c = np.linalg.lstsq(np.stack([x, y, np.ones_like(x)], axis=1), x * x + y * y, rcond=None)[0]
    centre = np.array([0.5 * a, 0.5 * b])
    radius = np.sqrt(c + centre @ centre)
    assert np.abs(np.hypot(x - centre[0], y - centre[1]) - radius).max() < 1e-8
    return centre, radius


@pytest.mark.slow
@pytest.mark.capability("G9.5-potential")
def test_level_lines_of_the_potential_and_their_trajectories_are_circles():
    def height(x, y):
        return np.hypot(x - 1.0, y) / np.hypot(x + 1.0, y)

    assert abs(height(0.7, -1.3) - 0.623415020840537) < 1e-14
    surface = graph(height, Domain(0.1, 4.0, -2.0, 2.0))
    slope = features.SteepestSlope()
    for field in (slope, features.TurnedField(slope, np.pi / 2)):
        found = integral_curves(surface, field, [(0.7, -1.3), (1.4, 0.6)], accuracy=Accuracy(1e-8), tracing=COARSE)
        assert len(found) == 2
        for curve, level in enumerate(found.offsets[:-1]):
            x, y, z = found.points[level : found.offsets[curve + 1]].T
            if field is slope:
                # Circles through 1 and -1: x^2 + y^2 - 1 is a multiple of y. Near the pole itself nothing is known.
                away = np.abs(y) > 0.1
                ratio = ((x * x + y * y - 1.0) / y)[away]
                assert np.ptp(ratio) < 1e-8
                centre, radius = fitted_circle(x[away], y[away])
                assert abs(centre[0]) < 1e-7 and radius == pytest.approx(np.hypot(1.0, centre[1]), rel=1e-8)
            else:
                assert np.ptp(z) < 1e-8
                # Circles of Apollonius, on which distances from 1 and -1 have one ratio.
                centre, radius = fitted_circle(x, y)
                ratio = height(x[0], y[0]) ** 2
                assert centre == pytest.approx([(1.0 + ratio) / (1.0 - ratio), 0.0], rel=1e-7, abs=1e-7)
                assert radius == pytest.approx(2.0 * np.sqrt(ratio) / abs(1.0 - ratio), rel=1e-7)


@pytest.mark.slow
@pytest.mark.hard(50)
@pytest.mark.capability("G9.4-field")
def test_curves_end_at_critical_points_and_orbits_close_exactly():
    hill = graph(lambda x, y: 4.0 - x**2 - 0.5 * y**2, Domain(-1, 1, -1, 1))
    up = integral_curves(hill, features.SteepestSlope(), [(0.5, 0.7), (0.0, 0.0)], tracing=FINE)
    assert len(up) == 1 and np.abs(up.points[-1, :2]).max() < 1e-5
    assert np.abs(up.points[0, :2]).max() == pytest.approx(1.0, rel=1e-14)
    level = features.TurnedField(features.SteepestSlope(), np.pi / 2)
    round_ = integral_curves(hill, level, (0.5, 0.1), tracing=FINE)
    assert round_.closed.tolist() == [True] and round_.turns.tolist() == [[0, 0]]
    far = np.linalg.norm(np.diff(round_[0], axis=0), axis=1)
    assert far.max() < 3.0 * np.median(far)
    parallels = integral_curves(Sphere(), features.loxodromes(np.pi / 2), [(0.0, 0.3), (6.0, -1.5)], tracing=FINE)
    assert parallels.closed.all() and np.abs(parallels.turns).tolist() == [[1, 0], [1, 0]]


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_size_and_place_do_not_matter(scale):
    def curves(surface):
        return integral_curves(
            surface,
            features.SteepestSlope((1, 2, 3)),
            (0.4, 2.0),
            accuracy=EIGHT_DIGITS,
            tracing=Tracing(tolerance=scale * 0.01),
        )

    one = integral_curves(Torus(), features.SteepestSlope((1, 2, 3)), (0.4, 2.0), accuracy=EIGHT_DIGITS, tracing=COARSE)
    two = curves(PlacedSurface(Torus(), scale * np.eye(3), scale * np.array([1e3, 0.0, 0.0])))
    ends = [0, -1]
    assert np.allclose(one.points[ends], two.points[ends] / scale - np.array([1e3, 0.0, 0.0]), atol=1e-4)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field", "G8.0-curvature")
def test_lines_of_curvature_of_an_ellipsoid_lie_on_confocal_quadrics():
    a2, b2, c2 = 9.0, 4.0, 1.0
    surface = Ellipsoid((3, 2, 1))

    def confocal(points):
        # x^2/(a2-t) + y^2/(b2-t) + z^2/(c2-t) = 1 has the roots 0 and these two.
        x, y, z = np.moveaxis(points**2, -1, 0)
        total = a2 + b2 + c2 - (x + y + z)
        product = a2 * b2 + b2 * c2 + c2 * a2 - x * (b2 + c2) - y * (a2 + c2) - z * (a2 + b2)
        root = np.sqrt(np.maximum(total * total - 4.0 * product, 0.0))
        return 0.5 * (total - root), 0.5 * (total + root)

    starts = [(0.3, 0.2), (1.0, 0.5), (0.1, 1.0)]
    for family in (1, 2):
        found = integral_curves(
            surface,
            features.PrincipalDirections(family),
            starts,
            accuracy=Accuracy(1e-8),
            tracing=COARSE,
        )
        assert found.closed.all()
        for curve in range(len(found)):
            assert min(np.ptp(root) for root in confocal(found[curve])) < 1e-8


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
@pytest.mark.hard(50)
def test_the_line_of_curvature_through_the_umbilics_goes_straight_on_through_all_four():
    surface = Ellipsoid((3, 2, 1))
    found = integral_curves(surface, features.PrincipalDirections(1), (0.0, 1.2), accuracy=EIGHT_DIGITS, tracing=COARSE)
    through = (
        found
        if np.abs(found.points[:, 1]).max() < 1e-6
        else integral_curves(
            surface, features.PrincipalDirections(2), (0.0, 1.2), accuracy=EIGHT_DIGITS, tracing=COARSE
        )
    )
    x, y, z = through[0].T
    assert through.closed.all() and np.abs(y).max() < 1e-6 and x.max() > 2.99 and x.min() < -2.99 and np.ptp(z) > 1.99


@pytest.mark.slow
@pytest.mark.capability("G9.4-field", "G8.0-curvature")
def test_asymptotic_lines_are_the_rulings_and_end_where_the_surface_is_domed():
    saddle = HyperbolicParaboloid()
    for family in (1, 2):
        found = integral_curves(saddle, features.AsymptoticDirections(family), (0.2, 0.1), tracing=FINE)
        ends = found.points[-1] - found.points[0]
        way = found.points - found.points[0]
        assert np.linalg.norm(np.cross(way, ends), axis=1).max() < 1e-8 * np.linalg.norm(ends) ** 2
    ring = integral_curves(Torus(), features.AsymptoticDirections(), (0.0, 0.3), tracing=FINE)
    # From circle to circle of points with zero curvature, v = pi / 2 and v = -pi / 2.
    assert np.allclose(np.sort(np.abs(ring.v[[0, -1]])), np.pi / 2, atol=1e-3)
    # On a minimal surface both families are at right angles.
    sites = at(helicoid_to_catenoid(bending=0.4), 0.7, 0.3)
    one, two = (features.AsymptoticDirections(k).tangents(sites)[0, 0] for k in (1, 2))
    assert abs(one @ two) < 1e-9
    _, (most, least) = principal(sites, "asymptotic lines")
    assert np.allclose(most, -least)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_geodesics_of_sphere_cylinder_cone_and_torus():
    every = geodesics(Sphere(), [(0.3, 0.2)] * 3, np.radians([90, 89.99, 20]), accuracy=EIGHT_DIGITS, tracing=COARSE)
    assert every.closed.all()
    for curve in range(3):
        points = every[curve]
        assert np.abs(points @ np.cross(points[0], points[7] / np.linalg.norm(points[7]))).max() < 1e-8
    helix = geodesics(Cylinder(1, 0, 5), (0, 0), 0.5, accuracy=EIGHT_DIGITS, tracing=COARSE)
    assert np.abs(helix.v - helix.u * np.tan(0.5)).max() < 1e-8
    # A cone unrolls: distance from the apex by the cosine of the angle run through stays the same.
    cone = Cone(1.0, -3.0, -0.5)
    line = geodesics(cone, (0.0, -2.0), np.radians(70.0), length=3.0, accuracy=EIGHT_DIGITS, tracing=COARSE)
    apart = np.linalg.norm(line.points, axis=1)
    angle = line.u / np.sqrt(2.0)
    x, y = apart * np.cos(angle), apart * np.sin(angle)
    bend = (x - x[0]) * (y[-1] - y[0]) - (y - y[0]) * (x[-1] - x[0])
    assert np.abs(bend).max() < 1e-8
    ring = geodesics(
        Torus(3, 1), (0.0, np.pi), 0.8, length=12.0, accuracy=EIGHT_DIGITS, tracing=Tracing(tolerance=2e-3)
    )
    assert_geodesic(ring, Torus(3, 1), 1e-3)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_a_geodesic_of_the_torus_keeps_clairauts_constant():
    from vectorplot.features.surface_integration import GeodesicFlow, traces
    from vectorplot.features.surface_points import charts

    torus = Torus(3, 1)
    flow = GeodesicFlow(torus, charts(torus))
    tangents = np.array([[0.0, np.cos(0.8), np.sin(0.8)], [0.0, np.cos(1.3), np.sin(1.3)]])
    run = traces(flow, np.array([[0.0, np.pi]] * 2), tangents, np.ones(2), np.full(2, 20.0), 11.0, 4.0, EIGHT_DIGITS)
    every = np.arange(len(run.strides.row))
    states = run.states(every, np.ones(len(every)))
    points = run.points(every, np.ones(len(every)))
    constant = points[:, 0] * states[:, 3] - points[:, 1] * states[:, 2]
    for row, angle in enumerate((0.8, 1.3)):
        assert np.abs(constant[run.strides.row == row] - 4.0 * np.cos(angle)).max() < 1e-8


@pytest.mark.capability("G9.4-field")
def test_the_error_follows_the_accuracy_that_is_asked_for():
    field = features.loxodromes(1.2)
    exact = np.sin(np.cos(1.2) * 1.2)
    errors = []
    for error in (1e-4, 1e-6, 1e-8):
        found = integral_curves(
            Sphere(),
            field,
            (0, 0),
            length=1.2,
            both_ways=False,
            accuracy=Accuracy(error),
            tracing=COARSE,
        )
        errors.append(abs(found.points[-1, 2] - exact))
        assert errors[-1] < 3.0 * error
    assert errors[2] < 1e-3 * max(errors[0], 1e-6)


@pytest.mark.capability("G9.4-field")
def test_fields_of_ones_own_and_what_is_wrong_with_them():
    winds = features.VectorField(lambda points: np.cross((0.0, 0.0, 1.0), points))
    rates = ParameterField(lambda u, v: np.stack([np.ones_like(u), np.zeros_like(v)], axis=1))
    for field in (winds, rates):
        found = integral_curves(Sphere(), field, (1.0, 0.5), tracing=FINE)
        assert found.closed.all() and np.allclose(found.v, 0.5)
        assert_integral_curve(found[0], Sphere(), field, 2e-3)
    with pytest.raises(AssertionError, match="not on a curve of the field"):
        assert_integral_curve(found[0], Sphere(), features.loxodromes(1.0), 1e-3)
    with pytest.raises(AssertionError, match="not on a geodesic"):
        assert_geodesic(found, Sphere(), 1e-6)
    with pytest.raises(InputError, match=r"the function gave float64 \(1,\)"):
        integral_curves(Sphere(), features.VectorField(lambda points: points[:, 0]), (0, 0))
    for starts, cause in (((0.0, 9.0), "start v = 9"), ((np.nan, 0.0), "finite"), ((1.0, 2.0, 3.0), "pairs")):
        with pytest.raises(InputError, match=cause):
            integral_curves(Sphere(), winds, starts)
    with pytest.raises(InputError, match="less than 90 degrees"):
        features.ConstantElevation(np.pi / 2)
    assert len(integral_curves(Sphere(), features.PrincipalDirections(), (0.3, 0.3))) == 0
    assert len(integral_curves(Sphere(), winds, np.zeros((0, 2)))) == 0


def world(surface, found):
    """The directions of curves in space."""
    along_u, along_v = surface.partials(found.u, found.v)
    return found.directions[:, :1] * along_u + found.directions[:, 1:] * along_v


@pytest.mark.slow
@pytest.mark.capability("G9.4-loxodrome")
def test_curves_know_their_directions_there_and_back_and_on_the_page():
    ball, field = Sphere(2.0), features.loxodromes(1.1)
    starts = ((0.1, 0.2), (2.0, -0.4))
    found = integral_curves(ball, field, starts, length=2.0, tracing=COARSE)
    run = world(ball, found)
    assert np.allclose(np.linalg.norm(run, axis=1), 1.0, atol=1e-9)
    ways = np.diff(found.points, axis=0)[np.arange(len(run) - 1) != found.offsets[1] - 1]
    assert (np.delete(run, found.offsets[1:] - 1, axis=0) * ways).sum(axis=1).min() > 0.0
    # Polylines alone say it by far less.
    with pytest.raises(AssertionError, match="not on a curve"):
        assert_integral_curve([found[0], found[1]], ball, field, 1e-5)
    lines = vp.SurfaceLines(integral=(FieldLines(field, through=starts),))
    scene = vp.Scene((vp.Item("BALL", ball, curves=lines),))
    drawing = vp.draw(scene, vp.Camera(eye=(9, -14, 9)), lines="integral")
    assert_integral_curve(drawing, ball, field, 1e-9)
    assert_integral_curve(found, ball, field, 1e-10)
    with pytest.raises(AssertionError, match="directions are not those of the field"):
        assert_integral_curve(found, ball, features.loxodromes(1.1 + 1e-6), 1e-7)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_geodesics_meridians_and_lines_of_curvature_know_theirs_too():
    ball = Sphere()
    circle = geodesics(ball, (0.3, 0.2), 1.1, tracing=COARSE)
    plane = np.cross(circle.points[0], world(ball, circle)[0])
    assert circle.closed.all() and np.abs(world(ball, circle) @ plane).max() < 1e-8
    meridian = integral_curves(ball, features.loxodromes(0.0), (0.4, 0.0), tracing=COARSE)
    known = np.isfinite(meridian.directions).all(axis=1)
    assert known.sum() > len(known) - 3 and np.abs(np.abs(meridian.directions[known]) - (0.0, 1.0)).max() < 1e-9
    egg, field = Ellipsoid((3.0, 2.0, 1.4)), features.PrincipalDirections(2)
    assert_integral_curve(integral_curves(egg, field, (0.7, 0.0), tracing=COARSE), egg, field, 1e-6)


@pytest.mark.parametrize("along", [features.loxodromes(0.5), None])
def test_curves_end_where_their_surface_is_cut(along):
    bowl = CutSurface(Torus(2.0, 0.7), (HalfSpaces(((0.0, 0.0, 1.0),), (0.3,)),))
    start = [[0.1, -1.0]]
    found = integral_curves(bowl, along, start) if along else geodesics(bowl, start, [0.8], length=9.0)
    height = found.points[:, 2]
    assert len(found) == 1 and np.isfinite(found.points).all()
    assert height.max() == pytest.approx(0.3, abs=1e-6) and height.max() <= 0.3


@pytest.mark.slow
def test_evenly_spaced_curves_keep_to_what_a_cut_leaves():
    bowl = CutSurface(Torus(2.0, 0.7), (HalfSpaces(((0.6, 0.8, 0.0),), (0.3,)),))
    found = evenly_spaced_curves(bowl, features.SteepestSlope(), 0.4)
    assert len(found) > 10 and (found.points @ (0.6, 0.8, 0.0)).max() <= 0.3


def test_shapes_without_parameters_are_told():
    ring, slope = ImplicitTorus(3, 1), features.SteepestSlope()
    for work in (
        lambda: features.integral_curves(ring, slope, (0.0, 0.0)),
        lambda: features.geodesics(ring, (0.0, 0.0), 0.3),
        lambda: geodesics_between(ring, (0.0, 0.0), (1.0, 0.0)),
        lambda: evenly_spaced_curves(ring, slope, 0.5),
    ):
        with pytest.raises(InputError, match="ImplicitTorus is no surface with parameters u and v"):
            work()
