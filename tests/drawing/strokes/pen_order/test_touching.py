import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.sample_paths import pieces

from vectorplot.drawing import pen_order as touching
from vectorplot.drawing.pen_order import pen_ordered, trails, travel_mm


def ordered_travel(ends):
    ends = ends[np.random.default_rng(1).permutation(len(ends))]
    return travel_mm(pen_ordered(pieces(ends[:, 0], ends[:, 1])))


def lattice(cells, size):
    """The edges of a square lattice, one stroke each."""
    edges = [((x, y), (x + 1, y)) for x in range(cells) for y in range(cells + 1)]
    edges += [((x, y), (x, y + 1)) for x in range(cells + 1) for y in range(cells)]
    return np.array(edges, dtype=float) * size


def rays(count, centre=(0.0, 0.0)):
    angle = np.arange(count) * (2 * np.pi / count)
    tips = 100 * np.c_[np.cos(angle), np.sin(angle)]
    return np.stack((np.zeros((count, 2)), tips), axis=1) + centre


@pytest.mark.parametrize("cells", [4, 20, 50])
def test_a_lattice_is_drawn_with_little_more_than_the_fewest_jumps(cells):
    # 4 (cells - 1) nodes on the border are odd: all but two of them in pairs, a jump of one edge for each.
    fewest = 2 * (cells - 1) - 1
    assert fewest * 7.0 * (1 - 1e-9) <= ordered_travel(lattice(cells, 7.0)) < 1.06 * fewest * 7.0 + 7.0


@pytest.mark.parametrize("count", [12, 120, 1000])
def test_rays_from_one_point_are_drawn_outwards_and_inwards_by_turns(count):
    step = 200 * np.sin(np.pi / count)
    assert ordered_travel(rays(count)) == pytest.approx((count / 2 - 1) * step, rel=1e-6)


def test_a_figure_with_two_odd_nodes_is_drawn_without_lifting_the_pen():
    triangles = [
        (((i + j / 2), j * 0.75), ((i + di + (j + dj) / 2), (j + dj) * 0.75))
        for i in range(12)
        for j in range(12 - i)
        for (di, dj) in ((1, 0), (0, 1))
    ]
    triangles += [
        ((i + 1 + j / 2, j * 0.75), (i + (j + 1) / 2, (j + 1) * 0.75)) for i in range(12) for j in range(12 - i)
    ]
    assert ordered_travel(np.array(triangles) * 8.0) == 0.0


def test_two_stars_take_no_more_than_linked_one_by_one():
    assert ordered_travel(np.concatenate((rays(300), rays(200, (150.0, 150.0))))) < 1000.0


def test_strokes_to_and_fro_between_two_places_are_linked_in_a_few_rounds(monkeypatch):
    # Each two of them are a ring, and each ring meets the next one.
    rounds, parts = [], touching._parts
    monkeypatch.setattr(touching, "_parts", lambda *of: rounds.append(None) or parts(*of))
    assert ordered_travel(np.tile([[(5.0, 5.0), (8.0, 5.0)]], (2000, 1, 1))) == 0.0
    assert len(rounds) < 40


NODE = st.tuples(st.integers(0, 4), st.integers(0, 4))


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(st.lists(st.tuples(NODE, NODE), min_size=1, max_size=60))
def test_links_make_trails_with_two_free_ends_each(edges):
    ends = np.array([complex(*node) for edge in edges for node in edge])
    link = trails(ends, ends, np.zeros(len(ends), dtype=np.intp))
    joined = np.flatnonzero(link >= 0)
    assert np.array_equal(link[link[joined]], joined) and not np.any(link == np.arange(len(link)))
    free = np.flatnonzero(link < 0)
    met = set()
    for end in free:
        here = end
        while True:
            met.add(here >> 1)
            here = link[here ^ 1]
            if here < 0:
                break
    assert len(met) == len(edges)


@pytest.mark.slow
@settings(max_examples=examples(100))
@given(st.lists(st.tuples(NODE, NODE), min_size=1, max_size=60))
def test_a_connected_figure_takes_no_more_jumps_than_its_odd_nodes(edges):
    spokes = [((x, y), (2, 2)) for x, y in {node for edge in edges for node in edge}]
    every = edges + spokes
    _, uses = np.unique(np.array(every).reshape(-1, 2), axis=0, return_counts=True)
    ends = np.array([complex(*node) for edge in every for node in edge])
    link = trails(ends, ends, np.zeros(len(ends), dtype=np.intp))
    assert np.count_nonzero(link < 0) == 2
    joined = np.flatnonzero(link >= 0)
    jumps = np.count_nonzero(ends[joined] != ends[link[joined]]) // 2
    assert jumps == max(int((uses % 2).sum()) // 2 - 1, 0)
