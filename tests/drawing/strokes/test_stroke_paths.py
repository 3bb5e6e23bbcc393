"""What a stroke is stays with its pieces: whether it samples a smooth curve."""

import numpy as np
from support.sample_paths import polylines

from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.finishing import without_collinear_points
from vectorplot.drawing.pen_order import pen_ordered
from vectorplot.drawing.strokes import chosen, clipped, concatenated, joined, split_long, unrolled

# The smooth strokes lie above y = 50, the others below.
STROKES = polylines(
    [(0, 0), (30, 1), (60, 0)],
    [(0, 60), (30, 65), (60, 60)],
    [(0, 10), (60, 10), (60, 40), (0, 40)],
    [(0, 80), (60, 80), (60, 99), (0, 99)],
    [(70, 20), (80, 20), (90, 20)],
    [(70, 70), (80, 70), (90, 70)],
    closed=(2, 3),
    smooth=(1, 3, 5),
)


def test_nothing_is_smooth_unless_said_so():
    number = np.zeros(2, dtype=np.intp)
    paths = Paths(np.zeros((4, 2)), np.array([0, 2, 4]), number > 0, number, number, number, np.zeros((4, 3)))
    assert paths.smooth.tolist() == [False, False]
    assert len(Paths.empty().smooth) == 0


def test_whatever_is_done_to_strokes_smooth_ones_stay_smooth():
    zeros = np.zeros(len(STROKES), dtype=np.intp)
    results = {
        "chosen": chosen(STROKES, np.array([5, 0, 3, 1])),
        "concatenated": concatenated((STROKES, STROKES)),
        "unrolled": unrolled(STROKES, zeros, STROKES.closed.astype(np.intp)),
        "clipped": clipped(STROKES, (5.0, 5.0, 75.0, 90.0)),
        "dashed": dashed(STROKES, 2.0, 1.0),
        "joined": joined(STROKES, zeros, 1e-4),
        "without collinear points": without_collinear_points(STROKES, 1e-4),
        "split": split_long(STROKES, 25.0),
        "pen order": pen_ordered(STROKES),
    }
    for name, paths in results.items():
        above = paths.points[paths.offsets[:-1], 1] > 50.0
        assert paths.smooth.tolist() == above.tolist(), name
        assert 0 < above.sum() < len(paths), name


def test_a_smooth_stroke_is_not_joined_to_a_straight_one():
    lines = [(0, 0), (10, 0)], [(10, 0), (20, 0)], [(20, 0), (30, 1)]
    apart = joined(polylines(*lines, smooth=(1, 2)), np.zeros(3, dtype=np.intp), 1e-4)
    assert sorted(zip(np.diff(apart.offsets).tolist(), apart.smooth.tolist(), strict=True)) == [(2, False), (3, True)]
