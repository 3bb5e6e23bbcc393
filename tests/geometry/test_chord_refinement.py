"""Polylines on curves, refined until their chords are near."""

import numpy as np
import pytest

from vectorplot.geometry.chord_refinement import PROBES, Traces, refined, straight_between, torn, with_standstills


def on_circle(start, end, part):
    x = start + part[:, None] * (end - start)
    return x / np.linalg.norm(x, axis=1, keepdims=True), np.ones(len(x), dtype=bool)


def polygon(corners, turns=1.0):
    t = np.linspace(0.0, 2.0 * np.pi * turns, corners + 1)
    return np.stack([np.cos(t), np.sin(t)], axis=1)


def same(points):
    return points


def farthest_chord(lines):
    a, b = lines.points[:-1][~lines.last[:-1]], lines.points[1:][~lines.last[:-1]]
    middle = (a + b) / 2.0
    return np.abs(1.0 - np.linalg.norm(middle, axis=1)).max()


@pytest.mark.parametrize("tolerance", [1e-1, 1e-3, 1e-5])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_chords_are_within_the_tolerance_at_any_scale(tolerance, scale):
    def between(start, end, part):
        x, found = on_circle(start / scale, end / scale, part)
        return scale * x, found

    whole = Traces(np.concatenate([polygon(5), polygon(4, 0.4)]) * scale, np.isin(np.arange(11), [5, 10]))
    found = refined(whole, between, same, tolerance * scale, most=1 << 20)
    assert found.enough.all() and not found.unsure.any()
    assert farthest_chord(Traces(found.lines.points / scale, found.lines.last)) <= tolerance
    assert found.lines.last.sum() == 2
    assert np.array_equal(found.lines.points[found.lines.starts], whole.points[whole.starts])
    assert np.array_equal(found.lines.points[found.lines.ends], whole.points[whole.ends])


def test_points_come_in_the_order_of_the_curve():
    found = refined(Traces(polygon(3), np.arange(4) == 3), on_circle, same, 1e-4, most=1 << 20).lines
    angle = np.unwrap(np.arctan2(found.points[:, 1], found.points[:, 0]))
    assert (np.diff(angle) > 0.0).all()


def test_what_is_nearly_on_the_curve_tells_which_chords_will_do():
    asked = []

    def between(start, end, part):
        asked.append(len(start))
        return on_circle(start, end, part)

    def near(start, end, part):
        x, found = on_circle(start, end, part)
        return 1.0001 * x - 0.0001 * (start + part[:, None] * (end - start)), found

    def lost(start, end, part):
        return start, np.zeros(len(start), dtype=bool)

    whole = Traces(polygon(5), np.arange(6) == 5)
    exact = refined(whole, between, same, 1e-4, most=1 << 20).lines
    all_of_them = sum(asked)
    for nearly, fewer in ((near, True), (lost, False)):
        asked.clear()
        found = refined(whole, between, same, 1e-4, most=1 << 20, near=nearly).lines
        assert np.array_equal(found.points, exact.points) and np.array_equal(found.last, exact.last)
        assert (sum(asked) < all_of_them) == fewer


def test_all_that_is_known_of_a_point_goes_with_it():
    points = np.stack([np.linspace(0.0, 1.0, 3), np.full(3, 7.0)], axis=1)

    def image(rows):
        return np.stack([rows[:, 0], rows[:, 0] ** 2], axis=1)

    found = refined(Traces(points, np.arange(3) == 2), straight_between, image, 1e-3, most=1 << 20).lines
    assert len(found.points) > 10
    assert (found.points[:, 1] == 7.0).all()


def test_points_may_run_short_and_that_is_said():
    found = refined(Traces(polygon(3), np.arange(4) == 3), on_circle, same, 1e-12, most=100)
    assert not found.enough.any()
    assert 100 < len(found.lines.points) < 400


def test_a_chord_beside_which_the_curve_is_not_found_stays_and_is_counted():
    def blind(start, end, part):
        x, found = on_circle(start, end, part)
        return x, found & (x[:, 1] > 0.0)

    found = refined(Traces(polygon(4), np.arange(5) == 4), blind, same, 1e-4, most=1 << 20)
    assert found.unsure.tolist() == [2] and found.enough.all()
    assert (found.lines.points[:, 1] < -1e-9).sum() == 1


def test_where_there_is_no_image_nothing_is_refined():
    def behind(points):
        return np.where(points[:, :1] > 0.0, points, np.nan)

    found = refined(Traces(polygon(8), np.arange(9) == 8), on_circle, behind, 1e-4, most=1 << 20)
    assert found.enough.all()
    assert (found.lines.points[:, 0] < -0.1).sum() == 3


def test_lines_are_torn_where_their_image_jumps():

    def pole(rows):
        return np.concatenate([rows, 1.0 / (rows - 0.3)], axis=1)

    whole = Traces(np.linspace(0.0, 1.0, 4)[:, None], np.arange(4) == 3)
    found = refined(whole, straight_between, pole, 1e-3, most=1 << 20).lines
    pieces = torn(found, pole, 1e-3, np.ones(1))
    assert pieces.last.sum() == 2
    assert abs(pieces.points[pieces.ends[0], 0] - 0.3) < 1e-8
    assert torn(whole, pole, 1e-3, np.ones(1)) is whole


def test_closed_lines_without_their_repeated_points():
    lines = Traces(np.arange(9.0)[:, None], np.isin(np.arange(9), [3, 5, 8]))
    kept, offsets = lines.unrepeated(np.array([True, False, True]))
    assert np.flatnonzero(~kept).tolist() == [3, 8]
    assert offsets.tolist() == [0, 3, 5, 7]
    none, bounds = Traces(np.zeros((0, 2)), np.zeros(0, dtype=bool)).unrepeated(np.zeros(0, dtype=bool))
    assert len(none) == 0 and bounds.tolist() == [0]


def test_nothing_to_refine():
    nothing = Traces(np.zeros((0, 3)), np.zeros(0, dtype=bool))
    found = refined(nothing, straight_between, same, 1.0, most=10)
    assert found.enough.all() and not len(found.lines.points)
    assert not len(torn(nothing, same, 1.0, np.ones(3)).points)


def test_probes_are_not_symmetric():
    assert not np.isclose(sum(PROBES), 1.0)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e3])
def test_cusps_are_among_the_points(scale, offset):
    # An astroid that does not begin in a cusp, and a circle, which has none.
    t = np.linspace(0.1, 0.1 + 2.0 * np.pi, 23)
    lines = Traces(
        np.stack([np.concatenate([t, t]) + offset, np.repeat([1.0, 0.0], 23)], axis=1), np.arange(46) % 23 == 22
    )

    def slopes(p):
        x, astroid = p[:, 0] - offset, p[:, 1:]
        cusped = np.stack([-(np.cos(x) ** 2) * np.sin(x), np.sin(x) ** 2 * np.cos(x)], axis=1)
        return scale * np.where(astroid > 0.0, cusped, np.stack([-np.sin(x), np.cos(x)], axis=1))

    found = with_standstills(lines, slopes)
    assert found.last.sum() == 2 and len(found.points) == 50
    added = np.setdiff1d(found.points[found.points[:, 1] == 1.0, 0], lines.points[:, 0]) - offset
    assert np.abs(added - np.pi / 2.0 * np.arange(1, 5)).max() < 1e-12 * (1.0 + offset)


def test_a_sharp_turn_is_no_cusp_and_a_point_on_a_cusp_is_not_doubled():
    t = np.linspace(-1.0, 1.0, 8)[:, None]
    ends = np.arange(8) == 7
    assert len(with_standstills(Traces(t, ends), lambda p: np.column_stack([p, np.full(len(p), 1e-3)])).points) == 8
    through = Traces(np.linspace(-1.0, 1.0, 9)[:, None], np.arange(9) == 8)
    assert len(with_standstills(through, lambda p: np.column_stack([2.0 * p, 3.0 * p * p])).points) == 9


def test_a_wall_is_found_alike_alone_and_beside_longer_lines():
    """However narrow on the page: the points at both sides of it lie as close as jumps are known to."""

    def step(points):
        return np.stack([1e-6 * points[:, 0], np.floor(points[:, 0])], axis=1)

    def over(low, high):
        return np.stack([np.linspace(low, high, 5), np.zeros(5)], axis=1)

    short, long = over(0.4, 1.7), over(-900.3, 800.4)
    alone = refined(Traces(short, np.arange(5) == 4), straight_between, step, 0.01, most=1 << 16)
    both = Traces(np.concatenate([short, long, [(np.nan, 0.0), (1.0, 0.0)]]), np.isin(np.arange(12), [4, 9, 11]))
    among = refined(both, straight_between, step, 0.01, most=1 << 16)
    count = len(alone.lines.points)
    assert alone.enough.all() and np.array_equal(among.lines.points[:count], alone.lines.points)
    gaps = np.diff(alone.lines.points[:, 0])[np.diff(np.floor(alone.lines.points[:, 0])) > 0.0]
    assert len(gaps) == 1 and gaps[0] < 1e-8 * 1.3
