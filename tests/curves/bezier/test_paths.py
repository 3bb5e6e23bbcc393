"""Cubic paths: evaluated, split, flattened, measured; arcs as cubics and back."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.curves.arcs import EllipseArc, arc_error, arc_path
from vectorplot.curves.bezier import BezierPath, bezier_points, flattened, lengths, split
from vectorplot.errors import InputError
from vectorplot.testing.curves import Tree

CONTROL = np.array([[[0, 0, 0], [1, 2, 0], [3, 2, 1], [4, 0, 1]], [[4, 0, 1], [5, -2, 1], [7, 3, 0], [8, 0, 0]]], float)
PATH = BezierPath(CONTROL)


def ellipse(a: float, b: float, angle: float, t: np.ndarray) -> np.ndarray:
    x, y = a * np.cos(t), b * np.sin(t)
    return np.column_stack((5 + x * np.cos(angle) - y * np.sin(angle), -2 + x * np.sin(angle) + y * np.cos(angle)))


def test_points_are_those_of_the_polynomial_and_ends_are_exact():
    t = np.linspace(0, 1, 9)
    weights = np.stack(((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3), axis=1)
    np.testing.assert_allclose(PATH.points(t), weights @ CONTROL[0], atol=1e-14)
    assert (PATH.points(np.array([0.0, 1.0, 2.0])) == [[0, 0, 0], [4, 0, 1], [8, 0, 0]]).all()
    assert PATH.points(np.zeros((3, 4))).shape == (3, 4, 3)
    h = 1e-6
    inside = np.array([0.3, 0.7, 1.2, 1.9])
    differences = (PATH.points(inside + h) - PATH.points(inside - h)) / (2 * h)
    np.testing.assert_allclose(PATH.tangents(inside), differences, atol=1e-7)


def test_parts_lie_on_the_path():
    s = np.linspace(0, 1, 7)
    before, after = split(CONTROL[0], 0.3)
    np.testing.assert_allclose(bezier_points(before, s), PATH.points(0.3 * s), atol=1e-14)
    np.testing.assert_allclose(bezier_points(after, s), PATH.points(0.3 + 0.7 * s), atol=1e-14)
    for first, last in [(0.2, 0.6), (0.2, 1.7), (0, 1), (1, 2), (0.5, 2), (1.25, 1.5)]:
        part = PATH.part(first, last)
        np.testing.assert_allclose(
            part.points(np.array([0.0, part.end])), PATH.points(np.array([first, last])), atol=1e-14
        )
    left, right = PATH.split(1.3)
    assert left.length() + right.length() == pytest.approx(PATH.length(), rel=1e-12)
    for wrong in [(0.5, 0.5), (-1, 1), (1, 3)]:
        with pytest.raises(InputError, match="no part"):
            PATH.part(*wrong)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
def test_flattening_keeps_its_promise_and_is_not_wasteful(tolerance):
    line = PATH.flattened(tolerance)
    dense = PATH.points(np.linspace(0, 2, 3001))
    distance = Tree(np.stack([line[:-1], line[1:]], axis=1)).nearest(dense, 0.0)[0].max()
    assert distance <= tolerance
    assert len(line) <= 4 or distance > tolerance / 12
    assert (line[0] == CONTROL[0, 0]).all() and (line[-1] == CONTROL[-1, -1]).all()


def test_flattening_of_many_paths_and_its_bounds():
    points, offsets = flattened(CONTROL, np.array([0, 1, 1, 2]), 1e-2)
    assert offsets[1] == offsets[2] and offsets[-1] == len(points)
    assert (points[0] == CONTROL[0, 0]).all() and (points[offsets[2]] == CONTROL[1, 0]).all()
    straight = np.linspace([0.0, 0.0], [3.0, 3.0], 4)[None]
    assert BezierPath(straight).flattened(1e-9).tolist() == [[0, 0], [3, 3]]
    with pytest.raises(InputError, match="points"):
        PATH.flattened(1e-30)
    with pytest.raises(InputError, match="positive"):
        PATH.flattened(0.0)


def test_lengths_of_lines_parabolas_and_cusps():
    line = np.linspace([0.0, 0.0], [3.0, 4.0], 4)
    parabola = np.array([[0, 0], [1 / 3, 0], [2 / 3, 1 / 3], [1, 1]])  # y = x^2 from 0 to 1
    cusp = np.array([[1, -1], [-1 / 3, 1], [-1 / 3, -1], [1, 1]])  # (t^2, t^3) for t from -1 to 1
    found = lengths(np.stack((line, parabola, cusp)))
    expected = [5, (2 * np.sqrt(5) + np.arcsinh(2)) / 4, 2 * (13**1.5 - 8) / 27]
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert lengths(np.zeros((1, 4, 2)))[0] == 0


@pytest.mark.parametrize(("count", "error"), [(4, 2.8e-4), (6, 2.5e-5), (8, 4.3e-6)])
def test_circle_arcs_have_the_error_they_state(count, error):
    circle = EllipseArc(np.array([3.0, -1.0]), np.array([2.0, 0.0]), np.array([0.0, 2.0]))
    path = arc_path(circle, tolerance=2.0 * error)
    assert len(path.control) == count and path.closed
    radius = np.hypot(*(path.points(np.linspace(0, path.end, 8001)) - [3, -1]).T) / 2.0
    assert np.abs(radius - 1).max() == pytest.approx(arc_error(2 * np.pi / count), rel=1e-4)
    assert arc_error(2 * np.pi / count) < error
    assert path.error == pytest.approx(2 * arc_error(2 * np.pi / count))
    if count == 8:
        assert arc_error(2 * np.pi / count) < 2e-5


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6, 1e-8])
def test_ellipse_arcs_in_space_lie_within_the_tolerance(tolerance):
    arc = EllipseArc(np.array([1.0, 2, 3]), np.array([4.0, 0, 1]), np.array([0.0, 1, 1]), 0.3, 5.0)
    path = arc_path(arc, tolerance=tolerance)
    points = path.points(np.linspace(0, path.end, 4001)) - arc.centre
    frame = np.stack((arc.first, arc.second), axis=1)
    unit, rest = np.linalg.lstsq(frame, points.T, rcond=None)[:2]
    assert np.abs(rest).max() < 1e-20
    angle = np.arctan2(unit[1], unit[0])
    assert np.linalg.norm(arc.points(angle) - arc.centre - points, axis=1).max() <= tolerance
    assert (path.points(np.array([0.0, path.end])) == arc.points(np.array([0.3, 5.0]))).all()


def test_semi_axes_of_conjugate_diameters():
    arc = EllipseArc(np.zeros(2), np.array([3.0, 0.0]), np.array([3.0, 1.0]))
    long, short = arc.semi_axes()
    radii = np.linalg.norm(arc.points(np.linspace(0, 2 * np.pi, 100001)), axis=1)
    assert np.linalg.norm(long) == pytest.approx(radii.max(), rel=1e-8)
    assert np.linalg.norm(short) == pytest.approx(radii.min(), rel=1e-8)
    assert abs(long @ short) < 1e-14
