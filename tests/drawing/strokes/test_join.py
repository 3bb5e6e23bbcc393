import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.sample_paths import canonical, length_mm, lines_of, pieces, polylines

from vectorplot.drawing.strokes import chosen, joined

TOL = 1e-4


def all_joined(paths, group=None):
    return joined(paths, np.zeros(len(paths), dtype=np.intp) if group is None else np.asarray(group), TOL)


@pytest.mark.capability("G6.1-concat")
def test_shuffled_edges_become_open_and_closed_branches():
    rng = np.random.default_rng(1)
    angle = np.linspace(0, 2 * np.pi, 41)
    ring = np.c_[100 + 30 * np.cos(angle), 100 + 30 * np.sin(angle)]
    ring[-1] = ring[0]
    curve = np.c_[np.linspace(0, 50, 31), np.sin(np.linspace(0, 5, 31))]
    starts, ends = np.r_[ring[:-1], curve[:-1]], np.r_[ring[1:], curve[1:]]
    order, turn = rng.permutation(70), rng.random(70) < 0.5
    starts, ends = np.where(turn[:, None], ends, starts)[order], np.where(turn[:, None], starts, ends)[order]
    result = all_joined(pieces(starts, ends))
    assert sorted(zip(result.closed.tolist(), np.diff(result.offsets).tolist(), strict=True)) == [
        (False, 31),
        (True, 40),
    ]
    assert canonical(result) == canonical(pieces(starts, ends))
    np.testing.assert_array_equal(result.points3d[:, :2], result.points)


def test_at_a_crossing_strokes_go_straight_on():
    center, tips = (50.0, 50.0), [(0, 50), (100, 51), (50, 0), (50, 100), (80, 80), (20, 19)]
    result = all_joined(pieces([center] * 6, tips))
    ends = {frozenset(map(tuple, (line[0], line[-1]))) for line in lines_of(result)}
    assert ends == {frozenset(((0, 50), (100, 51))), frozenset(((50, 0), (50, 100))), frozenset(((80, 80), (20, 19)))}


def test_the_straightest_pair_goes_first_and_the_odd_one_stays():
    result = all_joined(pieces([(0, 0)] * 3, [(-10, 0), (10, 0.5), (10, -1)]))
    assert sorted(len(line) for line in lines_of(result)) == [2, 3]
    long = next(line for line in lines_of(result) if len(line) == 3)
    assert {tuple(long[0]), tuple(long[-1])} == {(-10, 0), (10, 0.5)}


def test_only_strokes_of_a_group_are_joined():
    lines = pieces([(0, 0), (1, 0), (2, 0)], [(1, 0), (2, 0), (3, 0)])
    assert len(all_joined(lines, [5, 5, 10**15])) == 2
    assert len(all_joined(lines)) == 1


def test_ends_meet_across_every_rounding_border():
    rng = np.random.default_rng(2)
    nodes = np.round(rng.uniform(0, 200, (4000, 2)) / (8 * TOL)) * (8 * TOL)
    off = rng.uniform(-0.35 * TOL, 0.35 * TOL, (2, 4000, 2))
    lines = pieces(nodes + off[0], np.roll(nodes, -1, axis=0) + off[1])
    result = all_joined(lines)
    assert len(result) == 1 and result.closed.all() and len(result.points) == 4000


def test_ends_further_apart_than_the_tolerance_stay_apart():
    assert len(all_joined(pieces([(0, 0), (10 + 2 * TOL, 0)], [(10, 0), (20, 0)]))) == 2


def test_the_attributes_are_those_of_the_first_part_and_closed_strokes_stay():
    lines = polylines([(0, 0), (1, 0), (1, 1)], [(5, 5), (6, 5), (6, 6)], [(1, 1), (0, 1)], closed=[1], kind=[3, 1, 3])
    result = all_joined(lines)
    assert result.closed.tolist() == [False, True]
    assert result.kind.tolist() == [3, 1]
    assert lines_of(result)[0].tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert lines_of(result)[1].tolist() == [[5, 5], [6, 5], [6, 6], [5, 5]]


@pytest.mark.hard(56)
def test_strokes_without_length_leave_nothing_behind():
    assert len(all_joined(pieces([(5, 5), (7, 7)], [(5, 5), (7, 7)]))) == 0
    assert len(all_joined(polylines([(1, 1)], []))) == 0
    assert len(all_joined(pieces(np.zeros((0, 2)), np.zeros((0, 2))))) == 0
    chain = pieces([(0, 0), (5, 0), (5, 0)], [(5, 0), (5, 0), (9, 0)])
    assert [line.tolist() for line in lines_of(all_joined(chain))] == [[[0, 0], [5, 0], [9, 0]]]


def test_a_polyline_that_returns_to_its_start_is_closed_and_a_hairpin_is_one_line():
    loop = polylines([(0, 0), (5, 0), (5, 5), (0, 0)])
    assert all_joined(loop).closed.tolist() == [True] and len(all_joined(loop).points) == 3
    hairpin = pieces([(0, 0), (9, 9)], [(9, 9), (0, 0)])
    assert canonical(all_joined(hairpin)) == [((0.0, 0.0), (9.0, 9.0))] and not all_joined(hairpin).closed.any()


def test_a_fan_of_many_spokes_is_paired_across():
    angle = np.arange(600) * np.pi / 300
    result = all_joined(pieces(np.full((600, 2), 100.0), np.c_[100 + 50 * np.cos(angle), 100 + 50 * np.sin(angle)]))
    assert len(result) == 300
    assert all(np.allclose(line[0] + line[2], 200.0) for line in lines_of(result))


@st.composite
def graphs(draw):
    """Different edges between the nodes of a small grid, each in one of two groups."""
    nodes = [(x, y) for x in range(4) for y in range(4)]
    pairs = [(a, b) for a in range(16) for b in range(a)]
    edges = draw(st.lists(st.sampled_from(pairs), min_size=1, max_size=40, unique=True))
    groups = draw(st.lists(st.integers(0, 1), min_size=len(edges), max_size=len(edges)))
    at = np.array(nodes, dtype=float) * 10 + 3.3
    return pieces([at[a] for a, _ in edges], [at[b] for _, b in edges]), np.array(groups), edges


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(graphs(), st.randoms(use_true_random=False))
def test_joining_keeps_every_segment_and_leaves_at_most_one_free_end_a_node(graph, random):
    lines, group, edges = graph
    result = joined(lines, group, TOL)
    assert canonical(result) == canonical(lines)
    assert np.isclose(length_mm(result), length_mm(lines), rtol=1e-12)
    # Every node joins all its ends but one where their number is odd: so many strokes there are, no more.
    odd = sum(
        sum(edge.count(node) for edge, g in zip(edges, group, strict=True) if g == which) % 2
        for which in (0, 1)
        for node in range(16)
    )
    assert 2 * int((~result.closed).sum()) == odd
    order = np.array(random.sample(range(len(lines)), len(lines)))
    assert canonical(joined(chosen(lines, order), group[order], TOL)) == canonical(result)


def test_shuffled_turned_and_joined_again_nothing_changes():
    rng = np.random.default_rng(8)
    walk = np.cumsum(rng.normal(size=(5000, 2)), axis=0)
    order = rng.permutation(4999)
    result = all_joined(pieces(walk[:-1][order], walk[1:][order]))
    assert len(result) == 1
    line = result.points if np.allclose(result.points[0], walk[0]) else result.points[::-1]
    np.testing.assert_array_equal(line, walk)
    assert len(all_joined(result)) == 1


def test_ends_one_behind_the_other_are_not_joined():
    both = pieces([(0, 0), (10, 0), (0, 5), (10, 5)], [(10, 0), (20, 0), (10, 5), (20, 5)])
    both.points3d[2:4, 2] = 7.0
    result = all_joined(both)
    assert sorted(line.tolist() for line in lines_of(result)) == [
        [[0, 0], [10, 0]],
        [[0, 5], [10, 5], [20, 5]],
        [[10, 0], [20, 0]],
    ]


def test_of_four_ends_those_at_the_same_depth_are_joined():
    cross = pieces([(0, 0), (10, 0), (10, 10), (10, 0)], [(10, 0), (20, 0), (10, 0), (10, -10)])
    cross.points3d[[0, 1, 4, 5], 2] = 9.0
    depths = [set(line.tolist()) for line in np.split(all_joined(cross).points3d[:, 2], [3])]
    assert depths == [{9.0}, {1.0}]
