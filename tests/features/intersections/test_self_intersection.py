"""Double curves of surfaces that meet themselves."""

import numpy as np
import pytest

from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.intersections import self_intersections
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus

TURN = 2.0 * np.pi
SQUARE = Domain(-1, 1, -1, 1)


def umbrella(domain=SQUARE):
    return surface_of_function(lambda u, v: (u * v, u, v * v), domain)


def klein_bottle():
    def points(u, v):
        arm = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
        return arm * np.cos(u), arm * np.sin(u), np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)

    return surface_of_function(points, Domain(0, TURN, 0, TURN, closed_v=True))


def residual(surface, curves):
    return np.abs(surface.points(*curves.one.T) - surface.points(*curves.two.T)).max(initial=0.0)


def length(curves):
    return sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves)))


@pytest.mark.capability("G8.4-selfint")
def test_figure_eight_turned_about_an_axis_meets_itself_in_a_circle():
    def points(u, v):
        radius = 3 + np.sin(u)
        return radius * np.cos(v), radius * np.sin(v), np.sin(2 * u) / 2

    ring = surface_of_function(points, Domain(0, TURN, 0, TURN, closed_u=True, closed_v=True))
    curves = self_intersections(ring)
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts and residual(ring, curves) < 1e-11
    assert np.abs(np.hypot(*curves.points[:, :2].T) - 3).max() < 1e-11 and np.abs(curves.points[:, 2]).max() < 1e-11
    assert abs(length(curves) - 3 * TURN) < 0.01


@pytest.mark.slow
@pytest.mark.capability("G8.4-selfint")
def test_figure_eight_on_a_screw_meets_itself_in_a_helix_from_border_to_border():
    def points(u, v):
        radius = 3 + np.sin(u)
        return radius * np.cos(v), radius * np.sin(v), np.sin(2 * u) / 2 + 0.5 * v

    curves = self_intersections(surface_of_function(points, Domain(0, TURN, 0, 9, closed_u=True)))
    x, y, z = curves.points.T
    assert len(curves) == 1 and not curves.closed.any()
    assert np.abs(np.stack([x - 3 * np.cos(2 * z), y - 3 * np.sin(2 * z)])).max() < 1e-10
    assert sorted(curves[0][[0, -1], 2]) == pytest.approx([0.0, 4.5], abs=1e-12)


@pytest.mark.capability("G8.4-selfint")
def test_figure_eight_translated_along_a_line_meets_itself_in_a_line():
    eight = surface_of_function(lambda u, v: (np.sin(u), np.sin(2 * u) / 2, v), Domain(0, TURN, 0, 2, closed_u=True))
    curves = self_intersections(eight)
    assert len(curves) == 1 and np.abs(curves.points[:, :2]).max() < 1e-12
    assert sorted(curves[0][[0, -1], 2]) == [0.0, 2.0]


@pytest.mark.capability("G8.4-selfint")
def test_enneper_surface_meets_itself_in_two_plane_curves():
    def points(u, v):
        return u - u**3 / 3 + u * v * v, v - v**3 / 3 + v * u * u, u * u - v * v

    curves = self_intersections(surface_of_function(points, Domain(-2.2, 2.2, -2.2, 2.2)))
    assert len(curves) == 2 and not curves.closed.any() and not curves.doubts
    # x = 0 where u^2 = 3 + 3 v^2, and y = 0 likewise.
    for k in range(2):
        own = slice(curves.offsets[k], curves.offsets[k + 1])
        axis = int(np.abs(curves.points[own, 1]).max() < 1e-9)
        assert np.abs(curves.points[own, axis]).max() < 1e-9
        a, b = curves.one[own, axis], curves.one[own, 1 - axis]
        assert np.abs(a * a - 3 - 3 * b * b).max() < 1e-9
        assert np.abs(curves.one[own, axis] + curves.two[own, axis]).max() < 1e-9


@pytest.mark.slow
@pytest.mark.capability("G8.4-selfint")
def test_double_curve_of_a_klein_bottle_closes_though_its_domain_does_not():
    bottle = klein_bottle()
    curves = self_intersections(bottle)
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts and residual(bottle, curves) < 1e-11
    assert np.abs(np.hypot(*curves.points[:, :2].T) - 2).max() < 1e-11
    assert abs(length(curves) - 2 * TURN) < 0.01


@pytest.mark.slow
@pytest.mark.hard(48)
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_double_line_of_the_umbrella_ends_in_the_pinch_point(scale, offset):
    shift = np.array([offset, -offset, offset]) * scale
    surface = PlacedSurface(umbrella(), scale * np.eye(3), shift)
    curves = self_intersections(surface)
    noise = 1e-9 if offset == 0.0 else 1e-6
    assert len(curves) == 1 and not curves.doubts
    first, last = sorted((0, -1), key=lambda k: curves.points[k, 2])
    assert np.abs((curves.points[first] - shift) / scale).max() < noise
    assert (curves.one[first] == curves.two[first]).all() and np.abs(curves.one[first]).max() < noise
    assert np.abs((curves.points[last] - shift) / scale - (0, 0, 1)).max() < noise
    assert np.abs((curves.points[:, :2] - shift[:2]) / scale).max() < noise


@pytest.mark.hard(48)
@pytest.mark.parametrize("domain", [Domain(-1, 1.3, -0.8, 1), Domain(-0.7, 1.0, -1.21, 1.1)])
def test_pinch_point_is_met_wherever_the_grid_lies(domain):
    curves = self_intersections(umbrella(domain))
    assert len(curves) == 1
    assert min(np.abs(curves.points[[0, -1]]).max(axis=1)) < 1e-9


@pytest.mark.slow
@pytest.mark.hard(48)
def test_many_pinch_points_each_end_one_double_curve():
    # A circle, held level, moved along a knot: at every summit and hollow its double curve runs between two pinches.
    def points(u, v):
        arm = 2 + np.cos(3 * v)
        return arm * np.cos(2 * v) + 0.1 * np.cos(u), arm * np.sin(2 * v) + 0.1 * np.sin(u), np.sin(3 * v)

    knot = surface_of_function(points, Domain(0, TURN, 0, TURN, closed_u=True, closed_v=True))
    curves = self_intersections(knot, tracing=Tracing(columns=20, rows=150))
    assert len(curves) == 6 and not curves.closed.any()
    ends = np.sort(np.concatenate([curves.offsets[:-1], curves.offsets[1:] - 1]))
    turns = (curves.one[ends] - curves.two[ends]) / TURN
    assert np.abs(turns - np.round(turns)).max() < 1e-12
    assert np.abs(np.abs(curves.points[ends, 2]) - 1).max() < 1e-9


@pytest.mark.slow
@pytest.mark.hard(49)
def test_double_curve_of_the_swallowtail_ends_in_its_tip():
    tail = surface_of_function(lambda u, v: (3 * v**4 + u * v * v, 4 * v**3 + 2 * u * v, u), SQUARE)
    curves = self_intersections(tail)
    assert len(curves) == 1 and not curves.doubts
    # v = +-sqrt(-u / 2).
    assert np.abs(curves.one[:, 0] + 2 * curves.one[:, 1] ** 2).max() < 1e-9
    assert np.abs(curves.one[:, 1] + curves.two[:, 1]).max() < 1e-9
    ends = curves.points[[0, -1]][np.argsort(curves.points[[0, -1], 2])]
    assert np.abs(ends - [(0.25, 0, -1), (0, 0, 0)]).max() < 1e-9


@pytest.mark.slow
@pytest.mark.hard(49)
def test_a_cuspidal_edge_is_no_double_curve():
    def points(u, v):
        return np.cos(v) - u * np.sin(v), np.sin(v) + u * np.cos(v), v + u

    curves = self_intersections(surface_of_function(points, Domain(-1, 1, 0, 6)))
    assert len(curves) == 0 and len(curves.isolated) == 0


@pytest.mark.slow
@pytest.mark.capability("G8.4-selfint")
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_spindle_torus_meets_itself_in_two_points_of_its_axis(scale):
    curves = self_intersections(Torus(1.0 * scale, 2.0 * scale))
    assert len(curves) == 0
    tips = curves.isolated[np.argsort(curves.isolated[:, 2])] / scale
    assert tips.shape == (2, 3) and np.abs(tips - [(0, 0, -np.sqrt(3)), (0, 0, np.sqrt(3))]).max() < 1e-6


@pytest.mark.slow
def test_apex_of_a_double_cone_is_isolated():
    cone = surface_of_function(lambda u, v: (v * np.cos(u), v * np.sin(u), v), Domain(0, TURN, -1, 1.2, closed_u=True))
    curves = self_intersections(cone)
    assert len(curves) == 0 and len(curves.isolated) == 1 and np.abs(curves.isolated).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize(
    "surface",
    [
        Torus(2.0, 1.0),
        Sphere(1.0),
        Cylinder(),
        surface_of_function(lambda u, v: (np.cos(u), np.sin(u), v), Domain(0, TURN, 0, 1)),
    ],
)
def test_seams_and_poles_are_no_self_intersections(surface):
    curves = self_intersections(surface)
    assert len(curves) == 0 and len(curves.isolated) == 0 and not curves.doubts


@pytest.mark.slow
@pytest.mark.hard(44)
def test_a_surface_that_covers_itself_says_so():
    twice = surface_of_function(lambda u, v: (np.cos(u), np.sin(u), v), Domain(0, 3 * np.pi, 0, 1))
    curves = self_intersections(twice)
    assert len(curves) == 0 and "coincide in an area" in curves.doubts[0]


@pytest.mark.slow
def test_a_surface_that_all_but_covers_itself_says_so_at_once():
    scene = parse_scene("S surface rotoidal 3.9 -0.7 loxodrome 3.2 course 90")
    found = self_intersections(scene.items[0].shape)
    assert len(found.points) == 0 and any("very many curves" in doubt for doubt in found.doubts)


def knot(u):
    """A trefoil on a torus, and its two derivatives."""
    arm, slope, bend = 3 + np.cos(3 * u), -3 * np.sin(3 * u), -9 * np.cos(3 * u)
    c, s = np.cos(2 * u), np.sin(2 * u)
    at = np.stack([arm * c, arm * s, np.sin(3 * u)], axis=-1)
    way = np.stack([slope * c - 2 * arm * s, slope * s + 2 * arm * c, 3 * np.cos(3 * u)], axis=-1)
    turn = np.stack(
        [(bend - 4 * arm) * c - 4 * slope * s, (bend - 4 * arm) * s + 4 * slope * c, -9 * np.sin(3 * u)], axis=-1
    )
    return at, way, turn


def tube(u, v):
    """Of radius 0.4 about the trefoil, which comes no nearer to itself than 1.5."""
    u, v = np.broadcast_arrays(u, v)
    at, way, turn = knot(u)
    beside = np.cross(way, turn)
    beside /= np.linalg.norm(beside, axis=-1, keepdims=True)
    out = np.cross(beside, way / np.linalg.norm(way, axis=-1, keepdims=True))
    return at + 0.4 * (np.cos(v)[..., None] * out + np.sin(v)[..., None] * beside)


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize(("closed_u", "closed_v"), [(True, True), (False, True), (False, False)])
def test_a_tube_about_a_knot_does_not_meet_itself_a_period_apart(closed_u, closed_v):
    domain = Domain(0.4, 0.4 + TURN, 0.4, 0.4 + TURN, closed_u=closed_u, closed_v=closed_v)
    curves = self_intersections(surface_of_function(tube, domain), tracing=Tracing(columns=48, rows=12))
    assert len(curves) == 0 and len(curves.isolated) == 0 and not curves.doubts


@pytest.mark.slow
def test_a_tube_about_a_knot_does_not_meet_itself_one_period_on():
    """It turns about the knot as it runs along it, so that triangles are much larger than it is thick."""
    u, ring = "(u+5.995)", "(v-2*u)"
    out = f"(3+(1.2+0.2*cos{ring})*cos(3*{u})-0.2*sin{ring}*sin(3*{u}))"
    up = f"(1.2+0.2*cos{ring})*sin(3*{u})+0.2*sin{ring}*cos(3*{u})"
    formulas = f'"{out}*cos(2*{u})" "{out}*sin(2*{u})" "{up}"'
    text = f'A gray surface function {formulas} u 0 "2*pi" v 0.914 "0.914+2*pi" closed_u closed_v\n'
    (item,) = parse_scene(text).items
    found = self_intersections(item.shape)
    assert len(found) == 0 and not found.doubts
