"""Bézier paths cut off at a rectangle: what is inside stays, to the last bit of length."""

import numpy as np
import pytest

from vectorplot.curves.bezier import BezierPaths, bezier_points, bezier_tangents, clipped_paths, lengths

LOW, HIGH = np.zeros(2), np.array([10.0, 7.0])


def paths_of(*controls, closed=False):
    size = [len(control) for control in controls]
    offsets = np.concatenate(([0], np.cumsum(size))).astype(np.intp)
    control = np.concatenate([np.zeros((0, 4, 2)), *(np.asarray(c, dtype=float) for c in controls)])
    return BezierPaths(control, offsets, np.full(len(size), closed), np.arange(len(size), dtype=float))


def random_paths(seed, count=120):
    rng = np.random.default_rng(seed)
    size = rng.integers(0, 6, count)
    paths = paths_of(*(rng.uniform(-6, 14, (n, 4, 2)) for n in size))
    closed = rng.random(count) < 0.5
    control = paths.control
    for first, last, loop in zip(paths.offsets[:-1], paths.offsets[1:], closed, strict=True):
        control[first + 1 : last, 0] = control[first : last - 1, 3] if last > first else control[:0, 3]
        if loop and last > first:
            control[last - 1, 3] = control[first, 0]
    return BezierPaths(control, paths.offsets, closed, paths.error)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_the_length_inside_stays_and_nothing_lies_outside(seed):
    paths = random_paths(seed)
    parts, source = clipped_paths(paths, LOW, HIGH)
    t = (np.arange(4000) + 0.5) / 4000
    points = bezier_points(paths.control[:, None], t[None].repeat(len(paths.control), axis=0))
    speed = np.linalg.norm(bezier_tangents(paths.control[:, None], t[None].repeat(len(paths.control), axis=0)), axis=2)
    inside = ((points >= LOW) & (points <= HIGH)).all(axis=2)
    assert lengths(parts.control).sum() == pytest.approx((speed * inside).sum() / 4000, rel=1e-3)
    flat, _ = parts.flattened(1e-3)
    assert (flat >= LOW - 1e-12).all() and (flat <= HIGH + 1e-12).all()
    np.testing.assert_array_equal(parts.error, paths.error[source])
    assert (np.diff(source) >= 0).all()


def test_parts_hang_together_and_are_cut_only_at_the_border():
    parts, _ = clipped_paths(random_paths(9), LOW, HIGH)
    heads = np.zeros(len(parts.control), dtype=bool)
    heads[parts.offsets[:-1]] = True
    np.testing.assert_array_equal(parts.control[1:, 0][~heads[1:]], parts.control[:-1, 3][~heads[1:]])
    originals = random_paths(9).control[:, ::3].reshape(-1, 2)
    ends = np.concatenate((parts.control[heads, 0], parts.control[parts.offsets[1:] - 1, 3]))
    on_border = ((np.abs(ends - LOW) < 1e-12) | (np.abs(ends - HIGH) < 1e-12)).any(axis=1)
    assert all(on or (end == originals).all(axis=1).any() for end, on in zip(ends, on_border, strict=True))


def test_what_is_inside_stays_as_it_is():
    control = np.random.default_rng(0).uniform(1, 6, (4, 4, 2))
    paths = paths_of(control[:1], control[:0], control[1:], closed=True)
    parts, source = clipped_paths(paths, LOW, HIGH)
    assert source.tolist() == [0, 2] and parts.closed.all()
    np.testing.assert_array_equal(parts.control, control)


def circle(centre, radius):
    """Four cubic segments."""
    k = 4 / 3 * np.tan(np.pi / 8)
    quarter = np.array([[1, 0], [1, k], [k, 1], [0, 1]])
    turns = [np.array([[c, -s], [s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    return np.stack([quarter @ turn.T for turn in turns]) * radius + centre


def test_a_loop_across_a_border_becomes_one_open_part():
    # It begins and ends inside: the part goes on over its first point.
    parts, _ = clipped_paths(paths_of(circle((0, 3.5), 2), closed=True), LOW, HIGH)
    assert len(parts) == 1 and not parts.closed[0]
    np.testing.assert_allclose(parts.control[[0, -1], [0, 3]], [[0, 1.5], [0, 5.5]], atol=1e-12)


def test_a_loop_whose_handles_alone_leave_the_box_stays_closed():
    control = circle((5, 3.5), 2.0)
    control[0, 1, 0] = 10.1
    parts, _ = clipped_paths(paths_of(control, closed=True), LOW, HIGH)
    assert len(parts) == 1 and parts.closed[0]
    assert lengths(parts.control).sum() == pytest.approx(lengths(control).sum(), rel=1e-12)


def test_what_only_touches_the_border_from_outside_leaves_nothing():
    arch = [[[2, -3], [3, 1], [5, 1], [6, -3]]]  # its top is at y = 0
    parts, _ = clipped_paths(paths_of(arch), LOW, HIGH)
    assert lengths(parts.control).sum() < 1e-6
    away = paths_of([[[20, 20], [21, 20], [22, 20], [23, 20]]])
    assert len(clipped_paths(away, LOW, HIGH)[0]) == 0
    assert len(clipped_paths(paths_of(), LOW, HIGH)[1]) == 0


@pytest.mark.hard(54)
def test_hard_54_a_curve_from_far_away_is_cut_to_handles_near_the_page():
    far = paths_of([[[-1e9, 3], [-3e8, 4], [3e8, 2], [1e9, 3]]])
    parts, _ = clipped_paths(far, LOW, HIGH)
    assert len(parts) == 1
    np.testing.assert_allclose(parts.control[0, [0, 3], 0], [0, 10], atol=1e-6)
    assert np.abs(parts.control).max() < 100
