"""Smooth curves that lie on each other, sampled differently."""

from dataclasses import replace

import numpy as np
import pytest
from support.pace import cpu_seconds
from support.sample_paths import length_mm, polylines

from vectorplot.drawing.duplicates import without_smooth_duplicates
from vectorplot.drawing.strokes import chosen, concatenated

TOL = 1e-4


def chords(curve, start, end, count, smooth=True):
    points = curve(np.linspace(start, end, count + 1))
    return polylines(*np.stack((points[:-1], points[1:]), axis=1), smooth=range(count) if smooth else ())


def cleaned(*curves):
    paths = concatenated(curves)
    rank = np.repeat(np.arange(len(curves)), [len(curve) for curve in curves])
    result = without_smooth_duplicates(replace(paths, item=rank), rank, TOL)
    return [chosen(result, result.item == k) for k in range(len(curves))]


def ellipse(t, a=50.0, b=20.0):
    return np.column_stack((100 + a * np.cos(t), 100 + b * np.sin(t)))


def wave(t):
    return np.column_stack((100 * t, 50 + 20 * np.sin(9 * t)))


@pytest.mark.hard(8)
@pytest.mark.parametrize("counts", [(500, 443), (443, 500), (700, 410)])
@pytest.mark.parametrize("curve", [ellipse, wave])
def test_the_less_important_of_two_samplings_of_a_curve_goes(curve, counts):
    # The chords lie within about 0.01 mm of the curve, as tracing leaves them.
    first, second = chords(curve, 0.0, 2.0, counts[0]), chords(curve, 0.0, 2.0, counts[1])
    one, two = cleaned(first, second)
    assert len(one) == counts[0] and len(two) == 0


def test_a_part_that_sticks_out_stays():
    one, two = cleaned(chords(wave, 0.0, 1.0, 350), chords(wave, 0.5, 1.5, 370))
    assert len(one) == 350
    assert length_mm(two) == pytest.approx(length_mm(chords(wave, 1.0, 1.5, 85)), abs=length_mm(two) / len(two))


def test_curves_that_cross_touch_or_run_close_stay():
    base = chords(ellipse, 0.0, 2 * np.pi, 400)
    others = [
        chords(lambda t: ellipse(t, 20, 50), 0.0, 2 * np.pi, 390),
        chords(lambda t: ellipse(t, 50, 15), 0.0, 2 * np.pi, 390),
        chords(lambda t: ellipse(t, 50.002, 20.002), 0.0, 2 * np.pi, 390),
    ]
    assert [len(left) for left in cleaned(base, *others)] == [400, 390, 390, 390]


def test_a_curve_that_ends_where_it_touches_another_keeps_its_end():
    # A circle in an ellipse that it touches from inside; its last chords are short and lie on the ellipse.
    radius = 6.0
    touching = chords(lambda t: (150 - radius, 100) + radius * np.column_stack((np.cos(t), np.sin(t))), -2.0, -0.02, 70)
    end = chords(lambda t: (150 - radius, 100) + radius * np.column_stack((np.cos(t), np.sin(t))), -0.02, 0.0, 3)
    base = chords(ellipse, 0.0, 2 * np.pi, 400)
    assert [len(left) for left in cleaned(base, concatenated((touching, end)))] == [400, 73]


def test_straight_strokes_and_a_single_curve_are_left_alone():
    straight = chords(wave, 0.0, 1.0, 50, smooth=False)
    assert [len(left) for left in cleaned(straight, straight)] == [50, 50]
    both = concatenated((straight, chords(wave, 0.0, 1.0, 50)))
    assert without_smooth_duplicates(both, np.zeros(100, dtype=np.intp), TOL) is both


def test_of_three_one_stays():
    left = cleaned(*(chords(wave, 0.0, 1.0, count) for count in (311, 320, 333)))
    assert [len(paths) for paths in left] == [311, 0, 0]


@pytest.mark.slow
def test_time_for_a_hundred_thousand_chords():
    curves = [chords(lambda t, k=k: np.add(wave(t), (0.0, 0.37 * k)), 0.0, 1.0, 500) for k in range(200)]
    paths = concatenated(curves)
    with cpu_seconds(5.0):
        result = without_smooth_duplicates(paths, np.repeat(np.arange(200), 500), TOL)
    assert len(result) == len(paths)


def test_chords_without_length_go():
    one, two = chords(wave, 0.0, 1.0, 50), chords(wave, 0.0, 1.0, 40)
    points = one.points.reshape(-1, 2, 2).copy()
    points[20:30] = points[20, 0]
    still = replace(one, points=points.reshape(-1, 2))
    left = without_smooth_duplicates(concatenated((still, two)), np.repeat([0, 1], [50, 40]), TOL)
    along = left.points[left.offsets[1:] - 1] - left.points[left.offsets[:-1]]
    assert along.any(axis=1).all()
    assert np.isfinite(left.points).all()
