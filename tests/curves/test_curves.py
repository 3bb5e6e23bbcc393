"""Lines, circles, helices, loxodromes: closed forms, and what all curves have in common."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.curves.curve import second_derivatives
from vectorplot.curves.families import Circle, Helix, Line, Loxodrome, cylinder_intersection
from vectorplot.curves.placed_curves import PlacedCurve, curve_of_function
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul

FORMS = np.array([[0.0, 2.0, 0.0], [-1.0, 0.0, 0.5], [0.0, 0.0, 3.0]])
CURVES = {
    "line": Line((1, 2, 3), (0.5, -1, 2)),
    "circle": Circle((1, -2, 0.5), 2.5, (1, 2, 2)),
    "arc": Circle(radius=2, start=-1, end=1),
    "helix": Helix(2, 0.3, (1, 0, 2), (0, 1, 1)),
    "loxodrome": Loxodrome(2, 1.2),
    "thin": cylinder_intersection(3, 1, 0.5)[1],
    "thick": cylinder_intersection(1, 3, 0.5)[1],
    "single": cylinder_intersection(2, 2, 0.5)[0],
    "limit": cylinder_intersection(3, 2, 1)[0],
    "other limit": cylinder_intersection(2, 3, 1)[0],
    "steinmetz": cylinder_intersection(2, 2, 0)[1],
    "function": curve_of_function(lambda t: (np.cos(t), np.sin(2 * t), t), 0, 3),
    "placed": PlacedCurve(Helix(2, 0.3), FORMS, (1, 2, 3)),
}
every_curve = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES.keys())


def parameters(curve, count=41):
    return curve.start + (curve.end - curve.start) * (np.arange(count) + 0.437) / count


@every_curve
def test_tangents_are_the_derivatives_of_points(curve):
    t, h = parameters(curve), 1e-4
    # Fourth order, written out, to be independent of the package's own differences.
    p = [curve.points(t + k * h) for k in (-2, -1, 1, 2)]
    expected = (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h)
    assert np.abs(curve.tangents(t) - expected).max() < 1e-10 * max(1, np.abs(expected).max())


@every_curve
def test_second_derivatives_are_the_derivatives_of_tangents(curve):
    t, h = parameters(curve), 1e-4
    p = [curve.tangents(t + k * h) for k in (-2, -1, 1, 2)]
    expected = (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h)
    assert np.abs(second_derivatives(curve, t) - expected).max() < 1e-9 * max(1, np.abs(expected).max())


@every_curve
def test_closed_says_whether_the_curve_returns_with_its_tangent(curve):
    ends = np.array([curve.start, curve.end])
    p, d = curve.points(ends), curve.tangents(ends)
    returns = np.abs(p[1] - p[0]).max() < 1e-12 and np.abs(d[1] - d[0]).max() < 1e-12
    assert curve.closed == returns


@every_curve
def test_shapes_follow_the_parameters(curve):
    for shape in ((), (0,), (4,), (2, 3), (3, 3)):
        t = np.full(shape, 0.5)
        assert curve.points(t).shape == curve.tangents(t).shape == (*shape, 3)
        assert second_derivatives(curve, t).shape == (*shape, 3)


@pytest.mark.capability("G8.1-line")
def test_line_between_two_points():
    line = Line.through((1, 2, 3), (4, 6, 3))
    assert np.array_equal(line.points(np.array([0.0, 0.5, 1.0])), [(1, 2, 3), (2.5, 4, 3), (4, 6, 3)])
    assert not line.closed


@pytest.mark.capability("G8.1-circle")
def test_tv26_circle_in_space():
    circle = Circle((1, -2, 0.5), 2.5, np.array([1, 2, 2]) / 3)
    assert np.allclose(
        circle.points(np.array(0.7)), (-1.1904106364848, -2.10522346590025, 1.70042878414265), rtol=0, atol=1e-12
    )


@pytest.mark.capability("G8.1-circle")
@pytest.mark.parametrize("axis", [(1, 2, 2), (0, 0, 1), (0, 0, -3), (1e-9, 0, 1), (0, 5, 0), (1e-300, 0, 1e-300)])
def test_circle_has_its_radius_centre_and_axis(axis):
    circle = Circle((1, -2, 0.5), 2.5, axis)
    arms = circle.points(parameters(circle)) - (1, -2, 0.5)
    unit = np.array(axis) / np.max(np.abs(axis))
    assert np.allclose(np.linalg.norm(arms, axis=1), 2.5, rtol=1e-14)
    assert np.abs(arms @ unit).max() < 1e-14
    assert (np.cross(arms, circle.tangents(parameters(circle))) @ unit > 0).all()


@pytest.mark.capability("G8.1-circle")
def test_circle_with_an_upright_axis_starts_at_x():
    circle = Circle((5, 6, 7), 2)
    assert np.allclose(circle.points(np.array([0, np.pi / 2])), [(7, 6, 7), (5, 8, 7)], rtol=0, atol=1e-15)


def test_helix_is_on_its_cylinder_and_climbs_evenly():
    helix = Helix(2, 0.3)
    t = parameters(helix)
    assert np.allclose(helix.points(t), np.stack([2 * np.cos(t), 2 * np.sin(t), 0.3 * t], -1), rtol=0, atol=1e-15)


@pytest.mark.capability("G8.1-loxodrome")
def test_tv27_loxodrome():
    point = Loxodrome(2, np.radians(70)).points(np.array(0.8))
    assert np.allclose(point, (1.3363612895746, 1.37596910989556, -0.566434031763389), rtol=0, atol=1e-12)


@pytest.mark.capability("G8.1-loxodrome")
@pytest.mark.parametrize("alpha", [0.2, 1.0, np.pi / 2, 2.5])
def test_loxodrome_is_on_the_sphere_and_keeps_its_course(alpha):
    curve = Loxodrome(2, alpha, -5, 5)
    t = parameters(curve)
    p, d = curve.points(t), curve.tangents(t)
    assert np.allclose(np.linalg.norm(p, axis=1), 2, rtol=1e-14)
    south = np.stack([p[:, 0] * p[:, 2], p[:, 1] * p[:, 2], -(p[:, 0] ** 2 + p[:, 1] ** 2)], -1)
    course = np.einsum("ij,ij->i", south, d) / np.linalg.norm(south, axis=1) / np.linalg.norm(d, axis=1)
    assert np.allclose(course, np.cos(alpha), rtol=0, atol=1e-10)


def test_loxodrome_far_out_runs_into_the_poles_without_overflow():
    points = Loxodrome(2, 0.1, -1e4, 1e4).points(np.array([-1e4, 1e4]))
    assert np.array_equal(points, [(0, 0, 2), (0, 0, -2)])


@pytest.mark.capability("G8.1-curve")
def test_points_of_a_parametrised_curve_are_on_it():
    curve = curve_of_function(lambda u: (np.cos(u), np.sin(u), np.sin(u / 2)), 0, 4 * np.pi, closed=True)  # Viviani
    p = curve.points(np.linspace(curve.start, curve.end, 100))
    assert np.allclose(p[:, 0] ** 2 + p[:, 1] ** 2, 1)
    assert np.allclose((p[:, 0] + 1) ** 2 + p[:, 1] ** 2 + (2 * p[:, 2]) ** 2, 4)
    assert np.allclose(p[0], p[-1])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Line((0, 0, 0), (0, 0, 0)), "without length"),
        (lambda: Line((0, 0), (0, 0, 1)), "three finite numbers"),
        (lambda: Line((0, 0, 0), (1, 0, 0), 1, 1), "empty"),
        (lambda: Circle(radius=0), "radius must be positive"),
        (lambda: Circle(radius=np.nan), "finite"),
        (lambda: Circle(axis=(0, 0, 0)), "axis without length"),
        (lambda: Helix(1, np.inf), "finite"),
        (lambda: Helix(1, "steep"), "must be a number"),
        (lambda: Loxodrome(1, 0), "meridian"),
        (lambda: Loxodrome(1, np.pi), "meridian"),
    ],
)
def test_what_makes_no_curve_is_an_input_error(make, words):
    with pytest.raises(InputError, match=words):
        make()


# --- placed ---


@every_curve
def test_a_placed_curve_is_the_curve_after_the_map(curve):
    placed = PlacedCurve(curve, FORMS, (7, 8, 9))
    t = parameters(curve)
    assert np.array_equal(placed.points(t), matmul(curve.points(t), FORMS) + np.array((7, 8, 9)))
    assert np.array_equal(placed.tangents(t), matmul(curve.tangents(t), FORMS))
    assert (placed.start, placed.end, placed.closed) == (curve.start, curve.end, curve.closed)


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.full((3, 3), np.nan), np.eye(2), np.diag([1, 1, 0])])
def test_a_placement_that_cannot_be_undone_is_refused(matrix):
    with pytest.raises(InputError, match="a placement needs a matrix"):
        PlacedCurve(Circle(), matrix)
    with pytest.raises(InputError, match="shift"):
        PlacedCurve(Circle(), np.eye(3), (1, 2))
