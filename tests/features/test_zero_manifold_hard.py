"""The zero manifold where it is hard: cases 36 to 42 and 45."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-1, 1, -1, 1)
TURN = 2 * np.pi
RING = Domain(0, TURN, 0, TURN, closed_u=True, closed_v=True)


def traced(f, domain=SQUARE, cells=40, **options):
    return zero_manifold_of_f_uv(f, domain, columns=cells, rows=cells, **options)


@pytest.mark.hard(36)
@pytest.mark.parametrize(
    "f",
    [
        lambda u, v: v,
        lambda u, v: -v,
        lambda u, v: u,
        lambda u, v: u - v,
        lambda u, v: u + v,
        lambda u, v: np.round(v, 12) + 1e-17 * np.cos(1e5 * u),
    ],
)
def test_curve_along_grid_lines_and_through_grid_points_is_one_polyline(f):
    curve = traced(f)
    assert len(curve) == 1 and not curve.closed.any()
    steps = np.linalg.norm(np.diff(curve[0], axis=0), axis=1)
    length = np.linalg.norm(curve[0][-1] - curve[0][0])
    # No step back: the steps add up to the distance of the ends.
    assert abs(steps.sum() - length) < 1e-12 and length > 2 - 1e-12 and steps.min() > 1e-9


@pytest.mark.hard(36)
def test_circle_through_grid_points_is_one_polyline():
    # Passes exactly through (0.6, 0.8) and its like, which are grid points.
    curve = traced(lambda u, v: u * u + v * v - 1, Domain(-2, 2, -2, 2), 40)
    assert len(curve) == 1 and curve.closed.all()
    steps = np.linalg.norm(np.diff(curve[0], axis=0), axis=1)
    assert steps.min() > 1e-9 and abs(steps.sum() - TURN) < 0.02


def crossings(p, q):
    """How many segments of one polyline properly cross those of another."""

    def side(a, b, c):
        return (b - a)[..., 0] * (c - a)[..., 1] - (b - a)[..., 1] * (c - a)[..., 0]

    a, b = p[:-1, None], p[1:, None]
    c, d = q[None, :-1], q[None, 1:]
    return int(((side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)).sum())


@pytest.mark.slow
@pytest.mark.hard(37)
@given(st.floats(0, np.pi), st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-0.15, 0.15), st.floats(1e-3, 0.1))
@settings(max_examples=examples(25))
def test_levels_of_a_saddle_never_cross(angle, a, b, level, gap):
    def height(u, v):
        x, y = np.cos(angle) * (u - a) + np.sin(angle) * (v - b), np.cos(angle) * (v - b) - np.sin(angle) * (u - a)
        return x * y

    low, high = (traced(lambda u, v, c=c: height(u, v) - c, cells=7, tolerance=1e-5) for c in (level, level + gap))
    assert sum(crossings(low[i], high[j]) for i in range(len(low)) for j in range(len(high))) == 0
    for curve, c in ((low, level), (high, level + gap)):
        if abs(c) > 1e-6:
            assert sum(crossings(curve[i], curve[j]) for i in range(len(curve)) for j in range(i)) == 0


@pytest.mark.hard(37)
@pytest.mark.parametrize("level", [1e-4, -1e-4, 1e-7, -1e-7])
def test_saddle_in_a_cell_joins_the_right_sides(level):
    curve = traced(lambda u, v: (u - 0.013) * (v - 0.027) - level, cells=10)
    assert len(curve) == 2 and not len(curve.nodes)
    for k in range(2):
        x, y = np.sign(curve[k][[0, -1]] - (0.013, 0.027)).T
        assert (x * y == np.sign(level)).all() and x[0] == x[1]


@pytest.mark.hard(38)
@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.013, -0.027)])
def test_lemniscate_joins_its_branches_at_the_node(shift):
    def f(u, v):
        x, y = u - shift[0], v - shift[1]
        return (x * x + y * y) ** 2 - 0.5 * (x * x - y * y)

    curve = traced(f, tolerance=1e-4)
    assert len(curve.nodes) == 1 and np.abs(curve.nodes[0] - shift).max() < 1e-9
    assert len(curve) == 1 and curve.closed.all()
    through = np.flatnonzero(np.abs(curve.points - shift).max(axis=1) < 1e-9)
    assert len(through) == 2
    # It goes straight on through the node, along one of the two tangents there.
    for k in through:
        before, after = (
            curve.points[k] - curve.points[k - 1],
            curve.points[(k + 1) % len(curve.points)] - curve.points[k],
        )
        assert before @ after > 0.99 * np.linalg.norm(before) * np.linalg.norm(after)
    length = np.linalg.norm(np.diff(curve[0], axis=0), axis=1).sum()
    assert abs(length - 5.244115108584239 * np.sqrt(0.5)) < 1e-3


@pytest.mark.hard(38)
def test_three_lines_through_one_point():
    curve = traced(lambda u, v: (u - 0.1) * ((u - 0.1) ** 2 - 3 * (v - 0.2) ** 2))
    assert len(curve.nodes) == 1 and np.abs(curve.nodes[0] - (0.1, 0.2)).max() < 1e-4
    assert len(curve) == 3


@pytest.mark.hard(39)
def test_isolated_double_point_is_found_by_its_gradient():
    curve = traced(lambda u, v: (u - 0.3) ** 2 + 2 * (v - 0.005123) ** 2)
    assert len(curve) == 0
    assert curve.isolated.shape == (1, 2) and np.abs(curve.isolated[0] - (0.3, 0.005123)).max() < 1e-9


@pytest.mark.hard(39)
def test_double_line_is_reported_where_it_touches_zero():
    curve = traced(lambda u, v: (v - 0.0051 - 0.3 * u) ** 2)
    assert len(curve) == 0 and "without changing its sign" in curve.doubts[0]
    u, v = curve.touching.T
    assert np.abs(v - 0.0051 - 0.3 * u).max() < 1e-6
    assert np.diff(np.sort(u)).max() < 0.01 and u.min() < -0.98 and u.max() > 0.98


@pytest.mark.hard(40)
@given(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9))
@settings(max_examples=examples(25))
def test_tiny_oval_of_a_thousandth_of_the_domain_is_found(a, b):
    # Resolution 1e-3, the default: smaller ones are promised by asking for a smaller resolution.
    curve = traced(lambda u, v: (u - a) ** 2 + (v - b) ** 2 - 4e-6)
    assert len(curve) == 1 and curve.closed.all()
    assert np.abs(np.hypot(*(curve.points - (a, b)).T) - 2e-3).max() < 1e-9


@pytest.mark.hard(40)
def test_tiny_oval_beside_a_large_branch_and_a_finer_resolution():
    def f(u, v):
        return (u * u + v * v - 0.5) * ((u - 0.1) ** 2 + (v - 0.05) ** 2 - 1e-8)

    curve = traced(f, resolution=5e-5)
    assert len(curve) == 2 and curve.closed.all()


@pytest.mark.hard(41)
def test_sign_change_through_a_pole_is_no_zero():
    curve = traced(lambda u, v: 1 / (u - 0.0123))
    assert len(curve) == 0 and "poles" in curve.doubts[0]
    curve = traced(lambda u, v: np.tan(3 * u) + v)
    assert np.abs(np.tan(3 * curve.points[:, 0]) + curve.points[:, 1]).max() < 1e-9
    assert len(curve) == 3


@pytest.mark.hard(41)
def test_jump_is_no_zero():
    curve = traced(lambda u, v: np.where(u + 0.3 * v > 0.0123, 1.0, -2.0))
    assert len(curve) == 0 and "jumps" in curve.doubts[0]


@pytest.mark.hard(42)
@pytest.mark.parametrize("sign", [1, -1])
def test_one_sign_is_an_empty_curve(sign):
    curve = traced(lambda u, v: sign * (1 + u * u))
    assert len(curve) == 0 and curve.points.shape == (0, 2) and not curve.doubts
    assert len(traced(lambda u, v: np.full(u.shape, np.nan))) == 0


@pytest.mark.hard(45)
@pytest.mark.parametrize(
    ("f", "turns"),
    [
        (lambda u, v: np.sin(u) + 0.3 * np.cos(v) + 0.1, (0, 1)),
        (lambda u, v: np.sin(u - v), (1, 1)),
        (lambda u, v: np.sin(2 * u - v), (1, 2)),
    ],
)
def test_loops_around_the_torus_are_one_closed_path_each(f, turns):
    curve = traced(f, RING, 24, tolerance=1e-3)
    assert len(curve) == 2 and curve.closed.all()
    assert all(tuple(np.abs(t)) == turns for t in curve.turns)
    for k in range(2):
        assert np.linalg.norm(np.diff(curve[k], axis=0), axis=1).max() < 0.6
        assert np.abs(f(*curve[k].T)).max() < 1e-11


@pytest.mark.hard(45)
@pytest.mark.parametrize("at", [(0.0, 0.0), (0.0, 2.0), (6.2, 0.1)])
def test_loop_across_the_seam_is_one_closed_path(at):
    curve = traced(lambda u, v: np.cos(u - at[0]) + np.cos(v - at[1]) - 1.2, RING, 24)
    assert len(curve) == 1 and curve.closed.all() and not curve.turns.any()


@pytest.mark.hard(45)
def test_node_on_the_seam():
    curve = traced(lambda u, v: np.sin(u) * np.sin(v), RING, 24)
    assert len(curve.nodes) == 4 and len(curve) == 4 and curve.closed.all()


def test_paths_end_at_the_border_of_a_hole():
    def f(u, v):
        return np.where(u * u + v * v < 0.25, np.nan, v - 0.3 * u - 0.0123)

    curve = traced(f)
    assert len(curve) == 2
    ends = np.concatenate([curve[k][[0, -1]] for k in range(2)])
    inner = ends[np.abs(ends).max(axis=1) < 0.9]
    assert len(inner) == 2 and np.abs(np.hypot(*inner.T) - 0.5).max() < 1e-9


def test_removable_points_are_no_holes():
    curve = traced(lambda u, v: (u * u - v * u) / u)
    assert len(curve) == 1 and np.abs(curve.points[:, 0] - curve.points[:, 1]).max() < 1e-9
    curve = traced(lambda u, v: np.sin(9 * np.hypot(u, v)) / np.hypot(u, v) - 8)
    assert len(curve) == 1 and curve.closed.all()


def test_a_function_that_is_zero_over_an_area_gives_no_noise():
    def noise(u, v):
        return 1e-16 * np.sin(1e4 * u + 1e5 * v)

    assert len(traced(lambda u, v: 0 * u)) == 0
    curve = traced(lambda u, v: np.where(u < 0.0123, 0.3 * np.round(noise(u, v), 18) + 1e-16, 1 + u) - 1e-16)
    assert len(curve) == 0 and len(curve.touching) == 0
    assert any("zero all over" in text for text in curve.doubts)


@pytest.mark.hard(40)
def test_oval_below_the_resolution_is_found_or_said_to_be_missing():
    curve = traced(lambda u, v: (u - 0.1234) ** 2 + (v + 0.0456) ** 2 - 1e-8)
    assert len(curve) == 0 and "smaller than the resolution" in curve.doubts[0]
    assert len(traced(lambda u, v: (u - 0.1234) ** 2 + (v + 0.0456) ** 2 - 1e-8, resolution=5e-5)) == 1


@pytest.mark.hard(39)
def test_circles_that_touch_meet_in_one_node():
    curve = traced(lambda u, v: (u * u + v * v - 0.49) * ((u - 1.2) ** 2 + v * v - 0.25), cells=20)
    assert len(curve.nodes) == 1 and np.abs(curve.nodes[0] - (0.7, 0.0)).max() < 2e-3
    assert not len(curve.isolated) and not len(curve.touching)


def test_a_circle_that_touches_the_border_is_one_closed_branch():
    curve = traced(lambda u, v: u * u + v * v - 1, cells=10, tolerance=1e-3)
    assert len(curve) == 1 and curve.closed.all() and not curve.doubts
    assert abs(np.linalg.norm(np.diff(curve[0], axis=0), axis=1).sum() - TURN) < 5e-3
