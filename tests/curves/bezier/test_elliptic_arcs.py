"""Arcs of ellipses among many polylines: found where they are, and nowhere else."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.curves.arcs import EllipseArcs, arc_segments, recognised_arcs
from vectorplot.curves.bezier import bezier_points
from vectorplot.errors import InputError

TOL = 2e-5


def ellipse(t, a=40.0, b=25.0, turn=0.4, centre=(100.0, 70.0)):
    x, y = a * np.cos(t), b * np.sin(t)
    return np.column_stack((x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn))) + centre


def recognised(*lines, closed=False, tolerance=TOL):
    offsets = np.concatenate(([0], np.cumsum([len(line) for line in lines]))).astype(np.intp)
    points = np.concatenate([np.zeros((0, 2)), *lines])
    return recognised_arcs(points, offsets, np.full(len(lines), closed), tolerance=tolerance)


def radii(arcs):
    return np.sort(np.stack((np.hypot(*arcs.first.T), np.hypot(*arcs.second.T))), axis=0).T


FULL = np.linspace(0, 2 * np.pi, 61)[:-1]


@given(
    a=st.floats(1.0, 100.0),
    ratio=st.floats(0.05, 1.0),
    turn=st.floats(0.0, 7.0),
    start=st.floats(0.0, 7.0),
    angle=st.floats(0.5, 6.2),
    backwards=st.booleans(),
)
@settings(max_examples=examples(60))
def test_an_arc_is_the_one_that_was_sampled(a, ratio, turn, start, angle, backwards):
    t = start + np.linspace(0.0, angle, 40)
    line = ellipse(t[::-1] if backwards else t, a, ratio * a, turn)
    arcs = recognised(line)
    if not len(arcs):
        assert min(a * ratio, 1e9) * (1.0 - np.cos(min(angle / 2.0, np.pi / 2.0))) < 101.0 * TOL
        return
    middle = (arcs.start + arcs.end) / 2.0
    along = np.stack((arcs.start, middle, arcs.end), axis=1)
    expected = ellipse(start + angle * np.array([1.0, 0.5, 0.0] if backwards else [0.0, 0.5, 1.0]), a, ratio * a, turn)
    assert np.abs(arcs.points(along)[0] - expected).max() < TOL
    assert abs(abs(arcs.end - arcs.start)[0] - angle) < 1e-2


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_size_does_not_matter(scale):
    arcs = recognised(scale * ellipse(FULL), closed=True, tolerance=scale * TOL)
    np.testing.assert_allclose(radii(arcs), [[25 * scale, 40 * scale]], rtol=1e-9)
    np.testing.assert_allclose(arcs.centre, [[100 * scale, 70 * scale]], rtol=1e-9)


def test_far_from_the_origin_rounding_alone_limits_it():
    arcs = recognised(ellipse(FULL, centre=(1e7, -1e7)), closed=True)
    assert np.abs(arcs.centre - (1e7, -1e7)).max() < 1e-6


def test_among_many_each_arc_knows_its_stroke():
    t = np.linspace(0.0, 1.0, 30)
    wave = np.column_stack((100 * t, 10 * np.sin(9 * t)))
    arcs = recognised(wave, ellipse(3 * t), wave + 1, ellipse(5 * t, 30, 30), wave[:3])
    assert arcs.stroke.tolist() == [1, 3]
    np.testing.assert_allclose(radii(arcs), [[25, 40], [30, 30]], rtol=1e-9)


T = np.linspace(-1.0, 1.0, 50)
NO_ARCS = {
    "parabola": np.column_stack((30 * T, 20 * T**2)),
    "hyperbola": np.column_stack((20 * np.sinh(T), 10 * np.cosh(T))),
    "straight line": np.column_stack((30 * T, 10 * T)),
    "cubic": np.column_stack((30 * T, 20 * T**3)),
    "spiral": np.column_stack(((30 + T) * np.cos(3 * T), (30 + T) * np.sin(3 * T))),
    "one point": np.full((50, 2), 3.0),
    "two turns": ellipse(6.5 * (T + 1)),
    "there and back": ellipse(3 * np.abs(T)),
    "nearly straight": ellipse(0.1 * T),
    "few points": ellipse(np.linspace(0, 3, 7)),
    "wide steps": ellipse(np.linspace(0, 1.9 * 8, 9)),
    "nothing": np.zeros((0, 2)),
}


@pytest.mark.parametrize("name", NO_ARCS)
def test_nothing_else_is_an_arc(name):
    assert len(recognised(NO_ARCS[name])) == 0


def test_a_single_point_beside_it_spoils_the_arc():
    line = ellipse(FULL)
    line[17] += (0.0, 3.0 * TOL)
    assert len(recognised(line, closed=True)) == 0
    line[17] -= (0.0, 2.5 * TOL)
    assert len(recognised(line, closed=True)) == 1


def test_a_loop_closes_and_an_open_line_round_it_does_not():
    whole = recognised(ellipse(FULL), closed=True)
    np.testing.assert_allclose(np.abs(whole.end - whole.start), 2 * np.pi, rtol=1e-15)
    part = recognised(ellipse(FULL))
    np.testing.assert_allclose(np.abs(part.end - part.start), FULL[-1], rtol=1e-9)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-3, 1e-6])
def test_segments_lie_within_the_tolerance_of_their_arcs(tolerance):
    t = np.linspace(0.0, 1.0, 40)
    arcs = recognised(ellipse(5 * t), ellipse(-2 * t, 90, 30), ellipse(0.5 * t, 10, 10))
    paths = arc_segments(arcs, np.zeros(3, np.bool_), tolerance=tolerance)
    owner = np.repeat(np.arange(3), np.diff(paths.offsets))
    points = bezier_points(paths.control[:, None], np.linspace(0, 1, 33)[None].repeat(len(owner), axis=0))
    arm = points - arcs.centre[owner, None]
    first, second = arcs.first[owner, None], arcs.second[owner, None]
    angle = np.arctan2((arm * second).sum(2) / (second**2).sum(2), (arm * first).sum(2) / (first**2).sum(2))
    off = arm - np.cos(angle)[..., None] * first - np.sin(angle)[..., None] * second
    assert np.hypot(off[..., 0], off[..., 1]).max() <= tolerance
    assert paths.error.max() <= tolerance
    ends = np.stack((paths.control[paths.offsets[:-1], 0], paths.control[paths.offsets[1:] - 1, 3]), axis=1)
    assert np.abs(ends - arcs.points(np.stack((arcs.start, arcs.end), axis=1))).max() < 1e-12


def test_without_arcs_there_are_no_segments():
    assert len(arc_segments(EllipseArcs.none(), np.zeros(0, np.bool_), tolerance=1.0)) == 0


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, 1e-40])
def test_impossible_tolerances_are_refused(tolerance):
    with pytest.raises(InputError, match="tolerance"):
        arc_segments(recognised(ellipse(FULL), closed=True), np.ones(1, np.bool_), tolerance=tolerance)
