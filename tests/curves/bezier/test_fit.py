"""Smooth paths through polylines and curves: the tolerance is kept, corners stay, everything else is smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from support.effort import examples

from vectorplot.curves.bezier import BezierPath
from vectorplot.curves.bezier_fit import fitted, fitted_curve, fitted_paths
from vectorplot.errors import InputError
from vectorplot.testing.curves import Tree

TURN = np.linspace(0, 2 * np.pi, 401)[:-1]


def distance(points: np.ndarray, line: np.ndarray) -> float:
    """The largest distance of points from a polyline."""
    return float(Tree(np.stack([line[:-1], line[1:]], axis=1)).nearest(points, 0.0)[0].max())


def dense(path: BezierPath, each: int = 40) -> np.ndarray:
    return path.points(np.linspace(0, path.end, each * len(path.control) + 1))


def kinks(path: BezierPath) -> np.ndarray:
    """The angles by which a path turns between its segments, and at its seam."""
    arriving = path.control[:, 3] - path.control[:, 2]
    leaving = np.roll(path.control[:, 1] - path.control[:, 0], -1, axis=0)
    if not path.closed:
        arriving, leaving = arriving[:-1], leaving[:-1]
    one = arriving / np.linalg.norm(arriving, axis=1)[:, None]
    two = leaving / np.linalg.norm(leaving, axis=1)[:, None]
    return 2 * np.arcsin(np.clip(np.linalg.norm(one - two, axis=1) / 2, 0, 1))


def joined_exactly(path: BezierPath) -> bool:
    ends, starts = path.control[:, 3], np.roll(path.control[:, 0], -1, axis=0)
    return bool((ends == starts)[: None if path.closed else -1].all())


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_a_circle_is_smooth_and_within_the_tolerance(tolerance):
    path = fitted(np.column_stack((np.cos(TURN), np.sin(TURN))), tolerance=tolerance, closed=True)
    assert path.closed and joined_exactly(path) and kinks(path).max() < 1e-7
    assert np.abs(np.hypot(*dense(path).T) - 1).max() <= tolerance * 1.02
    assert path.error <= tolerance
    # The fewest segments of equal length that can do it, by the law of Goldapp, and not many more.
    assert len(path.control) <= max(4, 2 * np.ceil((2.73e-4 / tolerance) ** (1 / 6) * 4))


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("with_tangents", [False, True])
def test_the_tolerance_is_kept_on_sine_ellipse_and_helix(tolerance, with_tangents):
    x = np.linspace(0, 4 * np.pi, 500)
    sine = np.column_stack((x, np.sin(x))), np.column_stack((np.ones(500), np.cos(x)))
    ellipse = np.column_stack((3 * np.cos(x / 3), np.sin(x / 3))), np.column_stack((-3 * np.sin(x / 3), np.cos(x / 3)))
    helix = np.column_stack((np.cos(x), np.sin(x), x / 4)), np.column_stack((-np.sin(x), np.cos(x), 0 * x + 0.25))
    for points, tangents in (sine, ellipse, helix):
        path = fitted(points, tangents if with_tangents else None, tolerance=tolerance)
        assert joined_exactly(path) and kinks(path).max(initial=0.0) < 1e-7
        assert (path.control[0, 0] == points[0]).all() and (path.control[-1, 3] == points[-1]).all()
        assert path.error <= tolerance
        assert distance(points, path.flattened(tolerance / 20)) <= tolerance * 1.06
        # The sagitta of the chords between samples, below 3e-4, is the polyline's fault.
        assert distance(dense(path), points) <= tolerance + 3e-4
        assert len(path.control) <= 8 * (1 + (1e-2 / tolerance) ** (1 / 4))


@pytest.mark.parametrize("tolerance", [1e-3, 1e-9])
def test_a_parabola_with_its_tangents_is_one_exact_segment(tolerance):
    x = np.linspace(-1, 2, 60)
    path = fitted(np.column_stack((x, x * x)), np.column_stack((0 * x + 1, 2 * x)), tolerance=tolerance)
    assert len(path.control) == 1
    if tolerance < 1e-6:
        y = dense(path)
        assert np.abs(y[:, 1] - y[:, 0] ** 2).max() < 1e-9


def test_straight_lines_are_one_straight_segment():
    for count in (2, 3, 4, 50):
        line = np.linspace([1.0, 2.0, 3.0], [4.0, 6.0, 3.0], count)
        path = fitted(line, tolerance=1e-9)
        np.testing.assert_allclose(path.control, np.linspace(line[0], line[-1], 4)[None], atol=1e-12)
    turned_back = fitted(np.array([[0.0, 0], [1, 0], [2, 0], [1, 0], [0.5, 0]]), tolerance=1e-6)
    assert turned_back.control[:, 0, 0].tolist() == [0, 2]


def test_corners_stay():
    square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
    path = fitted(square, tolerance=1e-3, closed=True)
    assert path.control[:, 0].tolist() == square.tolist()
    np.testing.assert_allclose(kinks(path), np.pi / 2)
    side = np.linspace(0, 4, 200)
    dented = np.concatenate(
        (np.column_stack((side, np.sin(side))), np.column_stack((4 + 0 * side, np.sin(4) + side))[1:])
    )
    path = fitted(dented, tolerance=1e-3)
    assert (kinks(path) > 0.3).sum() == 1 and dented[199].tolist() in path.control[:, 0].tolist()
    # A turn of 20 degrees is a corner only for those who say so.
    bent = np.concatenate((np.linspace([0, 0], [1, 0], 30), np.linspace([1, 0], [1.94, 0.342], 30)[1:]))
    assert kinks(fitted(bent, tolerance=1e-3)).max(initial=0.0) < 1e-7
    assert len(fitted(bent, tolerance=1e-3, corner_angle=0.2).control) == 2


def test_a_loop_with_a_corner_away_from_its_seam():
    t = np.linspace(0, 1, 300)
    drop = np.column_stack((np.sin(2 * np.pi * t), np.abs(np.cos(np.pi * t)) * 2))  # a corner where t is a half
    for shift in (0, 1, 77, 150, 299):
        path = fitted(np.roll(drop[:-1], shift, axis=0), tolerance=1e-3, closed=True)
        assert joined_exactly(path) and path.error <= 1e-3
        assert distance(dense(path), np.vstack((drop, drop[:1]))) <= 1.1e-3 + 1e-4


def test_a_cusp_is_a_corner():
    t = np.linspace(-1, 1, 201)
    cusp = np.column_stack((t**2, t**3))
    path = fitted(cusp, tolerance=1e-4)
    assert [0.0, 0.0] in path.control[:, 0].tolist() and (kinks(path) > 3.0).sum() == 1
    with_zero = fitted(cusp, np.column_stack((2 * t, 3 * t**2)), tolerance=1e-4)
    assert (kinks(with_zero) > 3.0).sum() == 1 and np.abs(with_zero.control[:, 0]).sum(axis=1).min() < 1e-15


def test_repeated_points_count_once():
    x = np.linspace(0, 3, 50)
    line = np.column_stack((x, np.cos(x)))
    plain, repeated = fitted(line, tolerance=1e-3), fitted(np.repeat(line, 3, axis=0), tolerance=1e-3)
    np.testing.assert_allclose(repeated.control, plain.control, atol=1e-12)
    loop = np.column_stack((np.cos(TURN), np.sin(TURN)))
    again = fitted(np.vstack((loop, loop[:1])), tolerance=1e-3, closed=True)
    np.testing.assert_allclose(again.control, fitted(loop, tolerance=1e-3, closed=True).control, atol=1e-12)
    for closed in (False, True):
        dot = fitted(np.full((4, 2), 7.0), tolerance=1e-3, closed=closed)
        assert dot.control.shape == (1, 4, 2) and (dot.control == 7).all()
        assert fitted(np.array([[1.0, 2.0]]), tolerance=1e-3, closed=closed).control.tolist() == [[[1, 2]] * 4]
    assert fitted(np.zeros((0, 2)), tolerance=1e-3).control.shape == (0, 4, 2)
    there_and_back = fitted(np.array([[0.0, 0.0], [1.0, 0.0]]), tolerance=1e-3, closed=True)
    assert len(there_and_back.control) == 2 and joined_exactly(there_and_back)


def test_noise_below_the_tolerance_makes_no_segments():
    rng = np.random.default_rng(5)
    x = np.linspace(0, 20, 2000)
    rough = np.column_stack((x, 3 * np.sin(x / 3))) + rng.uniform(-0.004, 0.004, (2000, 2))
    path = fitted(rough, tolerance=0.02)
    assert len(path.control) <= 12 and distance(rough, path.flattened(1e-4)) <= 0.0201


@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_scale_and_place_change_nothing(scale, shift):
    line = np.column_stack((np.cos(TURN) * (1 + 0.2 * np.cos(3 * TURN)), np.sin(TURN)))
    path = fitted(line, tolerance=1e-3, closed=True)
    other = fitted(line * scale + shift, tolerance=1e-3 * scale, closed=True)
    assert len(other.control) == len(path.control)
    np.testing.assert_allclose((other.control - shift) / scale, path.control, atol=1e-6)


def test_many_lines_are_fitted_as_each_alone():
    rng = np.random.default_rng(3)
    lines = [rng.normal(size=(n, 2)).cumsum(axis=0) for n in (1, 2, 3, 7, 40, 5)]
    lines += [np.zeros((0, 2)), np.column_stack((np.cos(TURN), np.sin(TURN)))]
    closed = np.array([False, True, True, False, True, False, False, True])
    offsets = np.concatenate(([0], np.cumsum([len(line) for line in lines])))
    paths = fitted_paths(np.concatenate(lines), offsets, closed, tolerance=0.05)
    assert len(paths) == len(lines)
    for k, line in enumerate(lines):
        alone = fitted(line, tolerance=0.05, closed=bool(closed[k]))
        np.testing.assert_allclose(paths.path(k).control, alone.control, atol=1e-9)
    points, flat = paths.flattened(1e-3)
    assert len(flat) == len(lines) + 1 and flat[-1] == len(points)


@pytest.mark.slow
@settings(max_examples=examples(150))
@given(
    st.lists(st.tuples(*[st.integers(-8, 8)] * 3), min_size=1, max_size=14),
    st.booleans(),
    st.sampled_from([2, 3]),
    st.sampled_from([1e-3, 0.1, 2.0]),
)
def test_any_polyline_is_followed(points, closed, size, tolerance):
    line = np.array(points, dtype=float)[:, :size]
    path = fitted(line, tolerance=tolerance, closed=closed)
    assert np.isfinite(path.control).all() and joined_exactly(path)
    assert path.error <= tolerance
    assert distance(line, path.flattened(tolerance / 20)) <= tolerance * 1.06
    # Between points a curve takes room: for turns up to 30 degrees, less than a seventh of the chord.
    whole = np.vstack((line, line[:1])) if closed or len(line) == 1 else line
    longest = np.linalg.norm(np.diff(whole, axis=0), axis=1).max(initial=0.0)
    assert distance(dense(path), whole) <= tolerance + longest


@dataclass(frozen=True)
class Knot:
    """A closed curve with narrow bends."""

    start: float = 0.0
    end: float = 2 * np.pi
    closed: bool = True

    def points(self, t: np.ndarray) -> np.ndarray:
        radius = 2 + np.cos(9 * t)
        return np.stack((radius * np.cos(2 * t), radius * np.sin(2 * t), np.sin(9 * t)), axis=-1)

    def tangents(self, t: np.ndarray) -> np.ndarray:
        step = 1e-30j
        return self.points(t + step).imag / 1e-30


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-4, 1e-6])
def test_a_curve_is_within_the_tolerance_between_the_samples_too(tolerance):
    path = fitted_curve(Knot(), tolerance=tolerance)
    assert path.closed and joined_exactly(path) and kinks(path).max() < 1e-7 and path.error <= tolerance
    truth = Knot().points(np.linspace(0, 2 * np.pi, 997))
    t = np.linspace(0, path.end, 20 * len(path.control) + 1)
    nearest = t[cKDTree(path.points(t)).query(truth)[1]]
    for _ in range(6):
        apart, speed = path.points(nearest) - truth, path.tangents(nearest)
        nearest = np.clip(nearest - (apart * speed).sum(axis=1) / (speed**2).sum(axis=1), 0, path.end)
    assert np.linalg.norm(path.points(nearest) - truth, axis=1).max() <= 1.05 * tolerance


def test_bad_input_is_refused():
    line = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])
    with pytest.raises(InputError, match="tolerance"):
        fitted(line, tolerance=0.0)
    with pytest.raises(InputError, match="point 2"):
        fitted(np.array([[0.0, 0.0], [np.nan, 1.0]]), tolerance=0.1)
    with pytest.raises(InputError, match="shape"):
        fitted(np.zeros((3, 4)), tolerance=0.1)
    with pytest.raises(InputError, match="tangents"):
        fitted(line, line[:2], tolerance=0.1)
    with pytest.raises(InputError, match="offsets"):
        fitted_paths(line, np.array([0, 2]), np.array([False]), tolerance=0.1)


def test_a_blunt_corner_beside_a_long_chord_stays_a_corner():
    t = np.linspace(0.0, 0.5, 40)
    arc = np.column_stack((20.0 * np.sin(t), 20.0 * np.cos(t)))
    # A straight side of 30, met at 35 degrees, as a ruling is by the border it ends on.
    turn = np.radians(-0.5 / np.pi * 180.0 + 35.0)
    side = arc[-1] + np.outer(np.array([1.0]), 30.0 * np.array([np.cos(turn), np.sin(turn)]))
    line = np.concatenate((arc, side))
    path = fitted_paths(line, np.array([0, len(line)]), np.array([False]), tolerance=0.01, deviation=0.01)
    s = np.linspace(0.0, 1.0, 200)[:, None]
    c = path.control[:, :, None]
    points = (1 - s) ** 3 * c[:, 0] + 3 * s * (1 - s) ** 2 * c[:, 1] + 3 * s * s * (1 - s) * c[:, 2] + s**3 * c[:, 3]
    apart = shapely.distance(shapely.points(points.reshape(-1, 2)), shapely.linestrings(line))
    assert apart.max() < 0.02


def test_a_chord_whose_tangents_would_lead_far_away_is_straight():
    line = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.3], [40.0, 0.3]])
    path = fitted_paths(line, np.array([0, 4]), np.array([False]), tolerance=0.01, corner_angle=np.pi, deviation=0.4)
    s = np.linspace(0.0, 1.0, 200)[:, None]
    c = path.control[:, :, None]
    points = (1 - s) ** 3 * c[:, 0] + 3 * s * (1 - s) ** 2 * c[:, 1] + 3 * s * s * (1 - s) * c[:, 2] + s**3 * c[:, 3]
    assert shapely.distance(shapely.points(points.reshape(-1, 2)), shapely.linestrings(line)).max() < 0.42


def both_sides(angle: np.ndarray) -> np.ndarray:
    """(p,2,2) tangents from angles (p,2) at which a line arrives at points and leaves them."""
    return np.stack((np.cos(angle), np.sin(angle)), axis=2)


def test_corners_are_where_known_tangents_differ_and_nowhere_else():
    # Two arcs meet at 10 degrees: less than any guess would call a corner.
    t = np.linspace(0.0, 1.0, 60)
    one, two = np.radians(90.0) * (1.0 - t), np.radians(10.0) - np.radians(90.0) * t
    first = np.column_stack((10 * np.sin(np.pi / 2 * t), 10 - 10 * np.cos(np.pi / 2 * t)))
    first, one = first[:, ::-1], np.pi / 2 - np.pi / 2 * t
    swung = first[-1] + 10 * np.column_stack((np.sin(two), -np.cos(two))) * -1.0
    second = swung - swung[0] + first[-1]
    angle = np.concatenate((one, two[1:] + 0.0))
    points = np.concatenate((first, second[1:]))
    sides = np.column_stack((angle, angle))
    sides[59] = one[-1], two[0]
    path = fitted(points, both_sides(sides), tolerance=1e-3)
    assert np.isclose(np.degrees(kinks(path).max()), 10.0, atol=1e-6) and (kinks(path) > 1e-6).sum() == 1
    assert distance(dense(path), points) < 2e-3
    # A turn by 70 degrees at one point is no corner where the tangents say that the curve goes through it.
    narrow = np.array([[-3.0, 0.0], [-0.02, 0.0], [0.02, 0.07], [0.05, 3.0]])
    sides = np.radians([[0, 0], [20, 20], [80, 80], [89, 89]])
    assert kinks(fitted(narrow, both_sides(sides), tolerance=0.2)).max(initial=0.0) < 1e-7


def test_a_cusp_that_is_known_is_left_the_way_it_was_entered():
    t = np.linspace(-1.0, 1.0, 81)
    points = np.column_stack((t * t, t**3))
    angle = np.arctan2(3 * t * t, 2 * t)
    sides = np.column_stack((angle, angle))
    sides[40] = np.pi, 0.0
    path = fitted(points, both_sides(sides), tolerance=1e-4)
    assert kinks(path).max() == pytest.approx(np.pi, abs=1e-9)
    assert [0.0, 0.0] in path.control[:, 0].tolist()
    assert distance(points, dense(path)) < 1.1e-4


def test_tangents_that_are_not_known_are_found_beside_those_that_are():
    x = np.linspace(0, 6, 300)
    points = np.column_stack((x, np.sin(x)))
    angle = np.column_stack((np.arctan(np.cos(x)),) * 2)
    some = angle.copy()
    some[::3] = np.nan
    some[0] = some[-1] = np.nan
    some[5, 0] = some[8, 1] = np.nan
    paths = [fitted(points, both_sides(sides), tolerance=1e-4) for sides in (angle, some)]
    assert all(kinks(path).max() < 1e-7 and path.error <= 1e-4 for path in paths)
    # An end is that of the circle through the next point with the tangent there.
    leaving = paths[1].control[0, 1] - paths[1].control[0, 0]
    assert abs(np.arctan2(leaving[1], leaving[0]) - angle[0, 0]) < 1e-4
    # Nothing known at all is the same as nothing said.
    nothing = fitted(points, both_sides(np.full_like(angle, np.nan)), tolerance=1e-4)
    assert np.array_equal(nothing.control, fitted(points, tolerance=1e-4).control)
