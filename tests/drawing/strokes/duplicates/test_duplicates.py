import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.sample_paths import canonical, farthest_from, length_mm, pieces, samples_of, segments_of

from vectorplot.drawing.duplicates import without_duplicates
from vectorplot.drawing.strokes import chosen

TOL = 1e-4


def once(paths, rank=None):
    return without_duplicates(paths, np.zeros(len(paths), dtype=np.intp) if rank is None else np.asarray(rank), TOL)


@pytest.mark.hard(8)
@pytest.mark.capability("G7.2-no-double")
def test_coincident_edges_of_two_objects_are_stroked_once():
    twice = pieces([(10, 10), (90, 50), (10, 10)], [(90, 50), (10, 10), (10, 80)])
    assert canonical(once(twice)) == [((10.0, 10.0), (10.0, 80.0)), ((10.0, 10.0), (90.0, 50.0))]


@pytest.mark.hard(9)
def test_the_hidden_twin_of_an_edge_that_projects_on_another_is_dropped():
    lines = pieces([(0, 0), (2, 1), (6, 3)], [(8, 4), (4, 2), (12, 6)])
    result = once(lines, [0, 1, 2])
    assert canonical(result) == [((0.0, 0.0), (8.0, 4.0)), ((8.0, 4.0), (12.0, 6.0))]


@pytest.mark.hard(56)
def test_strokes_without_length_are_dropped():
    assert len(once(pieces([(5, 5), (1, 1)], [(5, 5), (1, 1 + 1e-6)]))) == 0
    assert len(once(pieces(np.zeros((0, 2)), np.zeros((0, 2))))) == 0


def test_parts_of_one_line_are_not_compared_with_each_other():
    # Two parts of a line, a twin of both, and the same parts as if they lay on each other.
    lines = pieces([(0, 0), (6, 0), (0, 0), (1, 0)], [(5, 0), (9, 0), (9, 0), (4, 0)])
    rank, none = np.array([1, 2, 0, 3]), None
    assert canonical(without_duplicates(lines, rank, TOL, none, np.array([0, 0, 1, 0]))) == [((0.0, 0.0), (9.0, 0.0))]
    assert canonical(without_duplicates(lines, rank, TOL, none, np.zeros(4, dtype=np.intp))) == canonical(lines)


def test_the_smaller_rank_wins_whatever_its_length():
    lines = pieces([(0, 0), (3, 0)], [(10, 0), (4, 0)])
    result = once(lines, [1, 0])
    assert canonical(result) == [((0.0, 0.0), (3.0, 0.0)), ((3.0, 0.0), (4.0, 0.0)), ((4.0, 0.0), (10.0, 0.0))]
    np.testing.assert_array_equal(np.hypot(*np.diff(segments_of(result), axis=1)[:, 0].T), [3.0, 6.0, 1.0])


@pytest.mark.parametrize("angle", np.radians([0.0, 17.0, 45.0, 89.9999, 90.0, 134.99, 135.0, 179.99999]))
@pytest.mark.parametrize("gap", [0.01, 0.001, 2.5 * TOL])
def test_lines_side_by_side_stay_two(angle, gap):
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    starts = np.array([[100, 100], [100, 100] + gap * across])
    both = pieces(starts, starts + 60 * along)
    assert canonical(once(both)) == canonical(both)


@pytest.mark.spread
@pytest.mark.parametrize("angle", np.radians([0.0, 30.0, 44.9999, 45.0, 45.0001, 90.0, 135.0, 179.999999]))
@pytest.mark.parametrize("length", [0.05, 1.0, 40.0, 250.0])
def test_lines_within_the_tolerance_are_one_at_every_angle_and_length(angle, length):
    rng = np.random.default_rng(3)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    off = 0.45 * min(TOL, 1e-3 * length)
    for _ in range(20):
        start = rng.uniform(0, 200, 2)
        shift = rng.uniform(-off, off, 2)
        other = start + across * shift[0], start + along * length + across * shift[1]
        pair = pieces([start, other[1]], [start + along * length, other[0]])
        assert len(once(pair)) == 1


def test_lines_that_cross_at_a_small_angle_stay_two():
    lines = pieces([(0, 0), (0, 0.001)], [(200, 0), (200, -0.001)])
    assert canonical(once(lines)) == canonical(lines)


def test_strokes_one_after_the_other_stay_as_they_are():
    x = np.linspace(0, 200, 1001)
    chain = pieces(np.c_[x[:-1], x[:-1] / 3], np.c_[x[1:], x[1:] / 3])
    result = once(chain)
    np.testing.assert_array_equal(result.points, chain.points)


def test_world_points_are_cut_where_the_page_is():
    # A line from depth 1 to depth 3; the page shows x / depth.
    world = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 1.0, 0]])
    lines = pieces([(0, 0), (0, 0)], [(30, 0), (10, 0)])
    lines.points3d[:] = [(0, 0, 1), (90, 0, 3), (0, 0, 1), (10, 0, 1)]
    result = without_duplicates(lines, np.array([1, 0]), TOL, world)
    cut = result.points3d[0]
    assert np.allclose(cut[0] / cut[2], 10.0)
    assert np.allclose(cut[0], 45.0 * (cut[2] - 1.0))


@pytest.mark.slow
@pytest.mark.hard(25)
def test_hundreds_of_strokes_on_top_of_each_other_become_one_in_finite_time():
    x = np.linspace(0, 200, 201)
    rng = np.random.default_rng(0)
    many = pieces(np.tile(np.c_[x[:-1], x[:-1]], (200, 1)), np.tile(np.c_[x[1:], x[1:]], (200, 1)))
    low = rng.uniform(0, 190, 2000)
    many_more = pieces(np.c_[low, low], np.c_[low + 5, low + 5])
    assert len(once(many)) == 200
    result = once(many_more, np.arange(2000))
    assert abs(length_mm(result) - np.sqrt(2) * _union_length(low, low + 5)) < 2000 * 2 * TOL


def _union_length(low, high):
    order = np.argsort(low)
    total, reach = 0.0, -np.inf
    for a, b in zip(low[order], high[order], strict=True):
        total += max(0.0, b - max(a, reach))
        reach = max(reach, b)
    return total


@st.composite
def bundles(draw):
    """Strokes on a few lines, with ends on a few places, so that many of them overlap."""
    count = draw(st.integers(1, 14))
    angles = draw(st.lists(st.floats(0.0, np.pi), min_size=1, max_size=3))
    starts, ends = [], []
    for _ in range(count):
        angle = draw(st.sampled_from(angles))
        low = draw(st.integers(0, 8))
        size = draw(st.integers(1, 5)) * draw(st.sampled_from([-1, 1]))
        offset = draw(st.integers(0, 1))
        along = np.array([np.cos(angle), np.sin(angle)])
        base = np.array([100.0, 100.0]) + offset * np.array([-along[1], along[0]])
        starts.append(base + low * along)
        ends.append(base + (low + size) * along)
    ranks = draw(st.lists(st.integers(0, 3), min_size=count, max_size=count))
    return pieces(starts, ends), np.array(ranks)


@pytest.mark.slow
@settings(max_examples=examples(150))
@given(bundles(), st.randoms(use_true_random=False))
def test_the_picture_stays_nothing_is_drawn_twice_and_the_order_does_not_matter(bundle, random):
    lines, rank = bundle
    result = without_duplicates(lines, rank, TOL)
    assert farthest_from(samples_of(lines), segments_of(result)) < 3 * TOL
    assert farthest_from(samples_of(result), segments_of(lines)) < 3 * TOL
    again = without_duplicates(result, np.zeros(len(result), dtype=np.intp), TOL)
    assert abs(length_mm(again) - length_mm(result)) < 1e-9
    order = np.array(random.sample(range(len(lines)), len(lines)))
    shuffled = without_duplicates(chosen(lines, order), rank[order], TOL)
    assert canonical(shuffled, 7) == canonical(result, 7)


def test_among_random_strokes_the_same_pairs_are_found_as_by_trying_all():
    rng = np.random.default_rng(5)
    base = rng.uniform(0, 100, (300, 2))
    angle, length = rng.uniform(0, np.pi, 300), 10 ** rng.uniform(-1.5, 2, 300)
    along = np.c_[np.cos(angle), np.sin(angle)]
    # Each of them has a part of it drawn again, a little off.
    low, high = np.sort(rng.uniform(0, 1, (2, 300)), axis=0)
    high = np.maximum(high, low + 0.1)
    start, end = base, base + along * length[:, None]
    noise = 0.2 * np.minimum(TOL, 1e-3 * (high - low) * length)[:, None]
    copies = (base + along * (low * length)[:, None], base + along * (high * length)[:, None])
    copies = [at + noise * rng.uniform(-1, 1, (300, 2)) for at in copies]
    lines = pieces(np.r_[start, copies[0]], np.r_[end, copies[1]])
    result = without_duplicates(lines, np.repeat([0, 1], 300), TOL)
    outside = np.maximum(high - 1.0, 0.0) * length
    sticks_out = outside > 3 * TOL
    assert len(result) == 300 + sticks_out.sum()
    assert abs(length_mm(result) - length.sum() - outside[sticks_out].sum()) < 600 * TOL


def test_of_equal_rank_the_longer_wins_so_that_there_are_few_pieces():
    lines = pieces([(0, 0), (5, 5), (2, 2)], [(4, 4), (9, 9), (12, 12)])
    result = once(lines)
    assert canonical(result) == [((0.0, 0.0), (2.0, 2.0)), ((2.0, 2.0), (12.0, 12.0))]


def test_the_twin_is_found_among_many_close_parallels():
    height = np.append(100 + 0.001 * np.arange(60), 100.0)
    lines = pieces(np.c_[np.full(61, 10.0), height], np.c_[np.full(61, 60.0), height])
    assert canonical(once(lines)) == canonical(chosen(lines, np.arange(60)))
