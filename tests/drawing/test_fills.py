from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.finishing import inked
from vectorplot.errors import InputError
from vectorplot.testing import assert_drawings_equal

SQUARE = np.array([(10.0, 10), (20, 10), (20, 20), (10, 20)])


def sample(count=5, seed=1) -> Fills:
    """Polygons of 0 to 5 corners."""
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 6, count)
    total = int(sizes.sum())
    return Fills(
        rng.uniform(0, 50, (total, 2)),
        np.concatenate(([0], np.cumsum(sizes))),
        rng.integers(0, 256, (total, 3)).astype(np.uint8),
        rng.uniform(0, 1, count),
        rng.integers(-1, 3, count),
        rng.uniform(-1, 1, (total, 3)),
        rng.integers(0, len(FillKind), count),
    )


def polygon(fills: Fills, k: int) -> list:
    part = slice(fills.offsets[k], fills.offsets[k + 1])
    columns = (fills.points[part], fills.colours[part], fills.points3d[part])
    return [*(column.tolist() for column in columns), fills.opacity[k], fills.item[k], fills.kind[k]]


def test_some_and_joined_keep_every_column_in_order():
    fills = sample(30)
    which = np.array([7, 3, 3, 29, 0])
    some = fills.take(which)
    assert [polygon(some, k) for k in range(5)] == [polygon(fills, k) for k in which]
    both = Fills.joined(some, Fills.empty(), fills)
    assert len(both) == 35
    assert [polygon(both, k) for k in range(35)] == [
        *(polygon(some, k) for k in range(5)),
        *(polygon(fills, k) for k in range(30)),
    ]
    assert len(Fills.joined()) == len(Fills.empty()) == len(fills.take(np.zeros(0, dtype=np.intp))) == 0


def test_flat_polygons_have_one_colour_and_lie_on_the_page_if_not_said_otherwise():
    fills = Fills.flat(np.tile(SQUARE, (2, 1)), np.array([0, 4, 8]), np.array([(1, 2, 3), (4, 5, 6)], np.uint8), item=2)
    assert fills.colours.tolist() == [[1, 2, 3]] * 4 + [[4, 5, 6]] * 4
    assert fills.item.tolist() == [2, 2] and fills.opacity.tolist() == [1, 1] and not fills.kind.any()
    assert np.array_equal(fills.points3d[:, :2], fills.points) and not fills.points3d[:, 2].any()
    assert "2 polygons" in repr(fills)


@pytest.mark.parametrize(
    "change",
    [
        {"points": np.zeros((3, 2))},
        {"points3d": np.zeros((4, 2))},
        {"offsets": np.array([0, 3])},
        {"offsets": np.array([0, 5, 4])},
        {"opacity": np.ones(2)},
        {"item": np.zeros(0, dtype=np.intp)},
        {"colours": np.zeros((4, 3))},
        {"colours": np.zeros((4, 4), dtype=np.uint8)},
    ],
)
def test_columns_that_do_not_fit_are_refused(change):
    with pytest.raises(InputError, match="fills"):
        replace(Fills.flat(SQUARE, np.array([0, 4]), np.zeros((1, 3), np.uint8)), **change)


def drawing_with(*marks) -> Drawing:
    return Drawing(60.0, 40.0, (Layer("visible", Pen(), marks),), ("box",))


def line(*points) -> Paths:
    none = np.zeros(1, dtype=np.intp)
    page = np.array(points, dtype=np.float64)
    offsets, world = np.array([0, len(page)]), np.column_stack((page, np.zeros(len(page))))
    return Paths(page, offsets, none > 0, none, none, none, world)


def test_ink_joins_strokes_and_leaves_fills_in_their_places():
    first, second = sample(4), sample(5)
    strokes = line((0, 0), (10, 10), (20, 20))
    layer = Layer("visible", Pen(), (first, strokes, second))
    (done,) = inked((layer,), "none", np.eye(4), 0.01)
    assert done.marks[0] is first and done.marks[2] is second
    assert len(done.marks[1]) == 1 and len(done.marks) == 3
    assert [len(paths.points) for paths in done.strokes] == [2]
    assert done.fills == (first, second)


def test_the_helpers_that_compare_strokes_do_not_see_fills():
    strokes = line((0, 0), (10, 10))
    assert_drawings_equal(drawing_with(sample(), strokes), drawing_with(strokes))
    with pytest.raises(AssertionError):
        assert_drawings_equal(drawing_with(sample()), drawing_with(strokes))


def test_a_drawing_says_how_many_marks_it_has():
    assert "visible 6" in repr(drawing_with(sample(), line((0, 0), (10, 10))))
