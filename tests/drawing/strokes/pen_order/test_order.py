import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples, several
from support.pace import cpu_seconds
from support.sample_paths import pieces, polylines

from vectorplot.drawing.pen_order import pen_ordered, travel_mm
from vectorplot.drawing.strokes import chosen
from vectorplot.speed.results import cpu_seconds as least_cpu_seconds


def numbered(paths):
    """The strokes with their number as item, and the number of each point as its depth in the world."""
    count = len(paths)
    paths.item[:] = np.arange(count)
    paths.kind[:] = np.arange(count) % 5
    paths.hidden_by[:] = np.arange(count) % 3
    paths.points3d[:, 2] = np.arange(len(paths.points))
    return paths


def separate(paths):
    zeros = np.zeros((3, len(paths)), dtype=np.intp)
    return numbered(type(paths)(paths.points, paths.offsets, paths.closed, *zeros, paths.points3d))


def nearest_neighbour_mm(ends):
    """Travel of the plain rule: on to the nearest end of a stroke not drawn yet, from the first stroke on."""
    left = np.ones(len(ends), dtype=bool)
    left[0] = False
    pen, way = ends[0, 1], 0.0
    for _ in range(len(ends) - 1):
        apart = np.hypot(ends[:, :, 0] - pen[0], ends[:, :, 1] - pen[1])
        apart[~left] = np.inf
        stroke, end = divmod(int(apart.argmin()), 2)
        way += apart[stroke, end]
        left[stroke] = False
        pen = ends[stroke, 1 - end]
    return way


def random_ends(count, seed=0):
    return np.random.default_rng(seed).random((count, 2, 2)) * 200.0


def ordered(ends):
    return pen_ordered(pieces(ends[:, 0], ends[:, 1]))


def shortest_mm(ends):
    """Travel of the best order and directions, by trying all."""
    from itertools import permutations, product

    ways = []
    for order in permutations(range(len(ends))):
        for turned in product((0, 1), repeat=len(ends)):
            first = np.array([ends[i, t] for i, t in zip(order, turned, strict=True)])
            last = np.array([ends[i, 1 - t] for i, t in zip(order, turned, strict=True)])
            ways.append(np.hypot(*(first[1:] - last[:-1]).T).sum())
    return min(ways)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_less_travel_than_the_nearest_neighbour_on_random_strokes(seed):
    ends = random_ends(several(1000, long=2000), seed)
    assert travel_mm(ordered(ends)) < 0.92 * nearest_neighbour_mm(ends)


def test_less_travel_than_the_nearest_neighbour_where_strokes_crowd_at_a_spot():
    ends = random_ends(1000)
    ends[:500] = 50.0 + ends[:500] * 1e-5
    assert travel_mm(ordered(ends)) < 0.95 * nearest_neighbour_mm(ends)


def test_a_hatching_is_drawn_to_and_fro():
    rng = np.random.default_rng(3)
    rows = rng.permutation(500) * 0.4
    ends = np.stack((np.c_[np.zeros(500), rows], np.c_[np.full(500, 100.0), rows]), axis=1)
    assert travel_mm(ordered(ends)) == pytest.approx(499 * 0.4, rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_four_strokes_take_little_more_than_the_shortest_way(seed):
    ends = random_ends(4, seed)
    assert travel_mm(ordered(ends)) <= 1.35 * shortest_mm(ends)


def test_strokes_that_touch_are_drawn_without_lifting_the_pen():
    corners = np.cumsum(np.random.default_rng(4).random((301, 2)), axis=0)
    ends = np.stack((corners[:-1], corners[1:]), axis=1)[np.random.default_rng(5).permutation(300)]
    assert travel_mm(ordered(ends)) == 0.0


def test_a_thousand_rays_from_one_point():
    angle = np.arange(1000) * (2 * np.pi / 1000)
    ends = np.stack((np.zeros((1000, 2)), 100 * np.c_[np.cos(angle), np.sin(angle)]), axis=1)
    assert travel_mm(ordered(ends)) <= 1.001 * nearest_neighbour_mm(ends)


def test_a_loop_is_entered_where_the_pen_comes_by():
    square = [(10, -5), (20, -5), (20, 5), (10, 5), (10, 0)]
    paths = polylines([(0, 0), (9, 0)], square, [(50, 5), (21, 5)], closed=[1])
    result = pen_ordered(paths)
    assert result.closed.tolist() == [False, True, False]
    assert result.points[2:7].tolist() == [[10, 0], [10, -5], [20, -5], [20, 5], [10, 5]]
    assert travel_mm(result) == pytest.approx(1 + np.hypot(11, 5))


def test_the_tour_begins_at_the_end_nearer_to_the_corner_of_the_page():
    result = pen_ordered(polylines([(90, 90), (60, 60)], [(20, 20), (50, 50)]))
    assert result.points[0].tolist() == [20, 20]


@pytest.mark.hard(56)
def test_nothing_one_stroke_points_and_empty_strokes():
    assert len(pen_ordered(polylines())) == 0
    assert pen_ordered(polylines([(5, 5), (1, 1)])).points.tolist() == [[1, 1], [5, 5]]
    same = separate(polylines([(3, 3)], [], [(3, 3), (3, 3)], [(3, 3)], [], closed=[0, 1]))
    result = pen_ordered(same)
    assert sorted(result.item.tolist()) == [0, 1, 2, 3, 4]
    assert result.item[-2:].tolist() == [1, 4] and travel_mm(result) == 0.0


POINT = st.tuples(st.integers(0, 5), st.integers(0, 5))
STROKES = st.lists(st.tuples(st.lists(POINT, max_size=6), st.booleans()), max_size=30)


@pytest.mark.slow
@settings(max_examples=examples(150))
@given(STROKES)
def test_the_strokes_are_the_given_ones_forwards_backwards_or_rolled(strokes):
    given_ = separate(
        polylines(*[line for line, _ in strokes], closed=[i for i, (_, loop) in enumerate(strokes) if loop])
    )
    result = pen_ordered(given_)
    assert sorted(result.item.tolist()) == list(range(len(strokes)))
    assert np.array_equal(result.points, result.points3d[:, :2])
    assert np.array_equal(result.kind, result.item % 5) and np.array_equal(result.hidden_by, result.item % 3)
    assert np.array_equal(result.closed, given_.closed[result.item])
    for place, stroke in enumerate(result.item):
        drawn = result.points3d[result.offsets[place] : result.offsets[place + 1], 2].astype(int).tolist()
        before = list(range(given_.offsets[stroke], given_.offsets[stroke + 1]))
        if given_.closed[stroke] and before:
            turn = drawn[0] - before[0]
            assert drawn == before[turn:] + before[:turn]
        else:
            assert drawn in (before, before[::-1])


@pytest.mark.parametrize("count", [5, 40, 700])
def test_neither_the_order_nor_the_directions_given_matter(count):
    ends = random_ends(count, 7)
    rng = np.random.default_rng(8)
    shuffled = ends[rng.permutation(count)]
    turned = rng.random(count) < 0.5
    shuffled[turned] = shuffled[turned, ::-1]
    assert np.array_equal(ordered(ends).points, ordered(shuffled).points)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [2.0**-20, 2.0**20])
def test_scale_does_not_matter(factor):
    ends = random_ends(500, 9)
    assert np.array_equal(ordered(ends).points * factor, ordered(ends * factor).points)


@pytest.mark.slow
def test_twenty_thousand_strokes_and_a_few_take_no_time_to_speak_of():
    many, few = random_ends(20000), random_ends(5)
    ordered(few)
    with cpu_seconds(1.0):
        ordered(many)
    with cpu_seconds(0.8):
        for _ in range(100):
            ordered(few)


@pytest.mark.slow
def test_ordering_does_not_import_scipy():
    code = (
        "import sys; from vectorplot.drawing.pen_order import pen_ordered;"
        "from vectorplot.drawing.drawing import Paths; pen_ordered(Paths.empty()); sys.exit('scipy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_chosen_strokes_travel_as_measured():
    paths = polylines([(0, 0), (1, 0)], [(1, 3), (2, 3)], [(2, 7), (2, 8), (3, 8)], closed=[2])
    assert travel_mm(paths) == 3.0 + 4.0
    assert travel_mm(chosen(paths, np.array([2, 0]))) == pytest.approx(np.hypot(2, 7))


def layered(count, layers, seed=5):
    """Strokes at random, some of them rings, and the layers of them."""
    rng = np.random.default_rng(seed)
    lines = [rng.uniform(0.0, 300.0, 2) + rng.normal(0.0, 8.0, (3, 2)) for _ in range(count)]
    return polylines(*lines, closed=range(0, count, 7)), rng.integers(0, layers, count)


@pytest.mark.parametrize("layers", [1, 3, 40, 400])
def test_each_layer_is_ordered_for_itself(layers):
    paths, layer = layered(400, layers)
    # The item tells the layer.
    ordered = pen_ordered(replace(paths, item=layer), layer)
    assert (np.diff(ordered.item) >= 0).all()
    assert np.array_equal(np.bincount(ordered.item, minlength=layers), np.bincount(layer, minlength=layers))
    together = alone = 0.0
    for one in range(layers):
        of_it = chosen(paths, np.flatnonzero(layer == one))
        together += travel_mm(chosen(ordered, np.flatnonzero(ordered.item == one)))
        alone += travel_mm(pen_ordered(of_it))
    assert together <= 1.03 * alone


def test_strokes_of_several_layers_that_touch_are_not_linked():
    rays = [((0.0, 0.0), (np.cos(t), np.sin(t))) for t in np.linspace(0.0, 6.0, 12)]
    ordered = pen_ordered(replace(polylines(*rays), item=np.arange(12) % 2), np.arange(12) % 2)
    assert ordered.item.tolist() == [0] * 6 + [1] * 6
    for part in (chosen(ordered, ordered.item == k) for k in (0, 1)):
        assert travel_mm(part) < 4.0


@pytest.mark.slow
def test_thousands_of_layers_take_hardly_longer_than_one():
    paths, layer = layered(6000, 3000)
    whole = least_cpu_seconds(lambda: pen_ordered(paths), 2)
    assert least_cpu_seconds(lambda: pen_ordered(paths, layer), 2) < 4.0 * whole


@pytest.mark.parametrize("step", [2**31, 2**40])
def test_numbers_of_layers_may_be_far_apart(step):
    paths, layer = layered(60, 3)
    near, far = pen_ordered(paths, layer), pen_ordered(paths, layer * step)
    assert np.array_equal(near.points, far.points)
