"""Smooth strokes as curves: within the tolerance of the true curve, from end to end, in the order of the pen."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from support.sample_paths import lines_of, polylines

from vectorplot.curves.bezier import bezier_points, bezier_tangents
from vectorplot.drawing.drawing import CurvedStrokes, Layer, Paths, Pen
from vectorplot.drawing.finishing import inked
from vectorplot.drawing.stroke_curves import curved_strokes, one_mark
from vectorplot.errors import InputError

TOLERANCE = 0.02


def sampled(curve, start, end, tolerance=TOLERANCE / 2, closed=False):
    """Points exactly on a curve whose chords lie within tolerance of it, as tracing leaves them."""
    count = 8
    while True:
        t = np.linspace(start, end, count + 1)
        points, middle = curve(t), curve((t[1:] + t[:-1]) / 2)
        chord = np.diff(points, axis=0)
        arm = middle - points[:-1]
        off = np.abs(chord[:, 0] * arm[:, 1] - chord[:, 1] * arm[:, 0]) / np.maximum(np.hypot(*chord.T), 1e-300)
        if off.max() <= tolerance:
            return points[:-1] if closed else points
        count += 1 + count // 8


def farthest(curve, start, end, beziers):
    """How far the first path and a curve are from each other, at most, both ways."""
    path = beziers.path(0)
    drawn = path.points(np.linspace(path.start, path.end, 400 * len(path.control) + 1))
    true = curve(np.linspace(start, end, 10001))
    return max(distance(drawn[::17], true), distance(true[::17], drawn))


def distance(points, line):
    """The largest distance of points from a finely sampled line."""
    return shapely.distance(shapely.points(points), shapely.linestrings(line)).max()


def circle(radius):
    return lambda t: np.column_stack((100 + radius * np.cos(t), 100 + radius * np.sin(t)))


def torus_contour(elevation_deg):
    """The image of the contour of a torus of radii 3 and 1 in a parallel projection: the parallel curve of an ellipse,
    with cusps for low elevations."""
    sine = np.sin(np.radians(elevation_deg))

    def curve(t, sign=-1.0):
        x, y = 3 * np.cos(t), 3 * np.sin(t) * sine
        nx, ny = np.cos(t) * sine, np.sin(t)
        size = np.hypot(nx, ny)
        return np.column_stack((100 + 20 * (x + sign * nx / size), 100 + 20 * (y + sign * ny / size)))

    return curve


def wave(t):
    return np.column_stack((100 * t, 60 + 20 * np.sin(12 * t) + 5 * np.cos(31 * t)))


CURVES = {
    "wave": (wave, 0.0, 2.0, False),
    "spiral": (lambda t: np.column_stack((100 + 3 * t * np.cos(t), 100 + 3 * t * np.sin(t))), 0.5, 25.0, False),
    "figure eight": (lambda t: np.column_stack((90 * np.sin(t), 50 * np.sin(2 * t))), 0.0, 2 * np.pi, True),
    "contour of a torus from above": (torus_contour(60.0), 0.0, 2 * np.pi, True),
    "outer contour": (lambda t: torus_contour(20.0)(t, 1.0), 0.0, 2 * np.pi, True),
    "narrow bend": (lambda t: np.column_stack((40 * np.cosh(t), 4 * np.sinh(t))), -2.0, 2.0, False),
}


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("tolerance", [0.2, 0.02, 0.002])
@pytest.mark.parametrize("name", CURVES)
def test_curves_lie_within_the_tolerance_of_the_true_ones(name, tolerance):
    curve, start, end, closed = CURVES[name]
    line = sampled(curve, start, end, tolerance / 2, closed)
    drawn = curved_strokes(polylines(line, smooth=(0,), closed=(0,) if closed else ()), tolerance)
    away = farthest(curve, start, end, drawn.beziers)
    print(f"{name}: {len(line)} points, {len(drawn.beziers.control)} segments, {away:.5f} mm")
    assert away <= tolerance
    assert len(drawn.beziers.control) < len(line) / 2
    assert not len(drawn.arcs)


@pytest.mark.parametrize("radius", [0.05, 0.3, 1.0, 7.0, 30.0, 95.0, 3000.0])
def test_a_circle_is_round(radius):
    line = sampled(circle(radius), 0.0, 2 * np.pi, closed=True)
    drawn = curved_strokes(polylines(line, smooth=(0,), closed=(0,)), TOLERANCE)
    control = drawn.beziers.control
    points = bezier_points(control[:, None], np.linspace(0, 1, 50)[None].repeat(len(control), axis=0)) - 100
    assert np.abs(np.hypot(points[..., 0], points[..., 1]) - radius).max() <= TOLERANCE / 2
    assert len(drawn.arcs) == 1
    np.testing.assert_allclose(np.hypot(*drawn.arcs.first.T), radius, rtol=1e-9)
    np.testing.assert_allclose(drawn.arcs.centre, [[100, 100]], atol=1e-9 * radius)


def test_the_contour_of_a_torus_has_corners_at_its_cusps_and_nowhere_else():
    # At an elevation of 20 degrees the inner branch has four cusps; all of them are samples.
    curve = torus_contour(20.0)
    sine = np.sin(np.radians(20.0))
    # The parallel curve at the distance r has a cusp where r is the ellipse's radius of curvature.
    a, b = 3.0, 3.0 * sine
    square = ((a * b) ** (2 / 3) - b * b) / (a * a - b * b)
    t = np.arcsin(np.sqrt(square))
    cusps = np.array([t, np.pi - t, np.pi + t, 2 * np.pi - t])
    bounds = np.concatenate(([cusps[-1] - 2 * np.pi], cusps))
    line = np.concatenate([sampled(curve, a, b)[:-1] for a, b in pairwise(bounds)])
    drawn = curved_strokes(polylines(line, smooth=(0,), closed=(0,)), TOLERANCE)
    assert farthest(curve, 0.0, 2 * np.pi, drawn.beziers) <= TOLERANCE
    corners = control_corners(drawn.beziers.control, closed=True)
    assert len(corners) == 4
    expected = curve(cusps)
    assert max(np.hypot(*(expected - corner).T).min() for corner in corners) < 1e-9


def control_corners(control, closed):
    """Where a path changes its direction from one segment to the next."""
    after = np.roll(control, -1, axis=0) if closed else control[1:]
    before = control if closed else control[:-1]
    one = bezier_tangents(before, np.ones(len(before)))
    two = bezier_tangents(after, np.zeros(len(after)))
    cosine = (one * two).sum(1) / np.maximum(np.hypot(*one.T) * np.hypot(*two.T), 1e-300)
    return before[cosine < np.cos(1e-3), 3]


@pytest.mark.parametrize("name", ["wave", "spiral", "contour of a torus from above", "narrow bend"])
def test_the_direction_is_continuous(name):
    curve, start, end, closed = CURVES[name]
    line = sampled(curve, start, end, closed=closed)
    drawn = curved_strokes(polylines(line, smooth=(0,), closed=(0,) if closed else ()), TOLERANCE)
    assert not len(control_corners(drawn.beziers.control, closed))


def mixed():
    """Straight strokes, curves, arcs, a short smooth stroke, one with two points and one without points."""
    t = np.linspace(0, 1, 40)
    return polylines(
        [(0, 0), (10, 5), (20, 0)],
        wave(t),
        circle(20)(t),
        [(5, 5), (6, 6)],
        [(7, 7), (8, 8)],
        [(1, 1), (2, 2.5), (3, 3)],
        [],
        circle(30)(2 * np.pi * t[:-1]),
        closed=(7,),
        smooth=(1, 2, 4, 5, 6, 7),
    )


def test_strokes_keep_their_order_and_straight_ones_stay_polylines():
    drawn = curved_strokes(mixed(), TOLERANCE)
    assert isinstance(drawn, CurvedStrokes) and len(drawn) == 8
    assert (np.diff(drawn.beziers.offsets) > 0).tolist() == [False, True, True, False, False, True, False, True]
    assert drawn.arcs.stroke.tolist() == [2, 7]
    np.testing.assert_array_equal(drawn.paths.points, mixed().points)
    for i in (1, 2, 5, 7):
        control = drawn.beziers.path(i).control
        line = lines_of(drawn.paths)[i]
        np.testing.assert_array_equal(control[[0, -1], [0, 3]], line[[0, -1]])
        np.testing.assert_array_equal(control[1:, 0], control[:-1, 3])


def test_without_smooth_strokes_there_are_no_curves():
    straight = polylines([(0, 0), (1, 1), (2, 0)], [(0, 0), (5, 5)], smooth=(1,))
    assert curved_strokes(straight, TOLERANCE) is straight
    assert len(curved_strokes(Paths.empty(), TOLERANCE)) == 0


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan, np.inf])
def test_impossible_tolerances_are_refused(tolerance):
    with pytest.raises(InputError, match="positive tolerance"):
        curved_strokes(mixed(), tolerance)


def test_marks_of_a_layer_become_one():
    curves = curved_strokes(mixed(), TOLERANCE)
    plain = polylines([(0, 0), (1, 1)], [(3, 3), (4, 4)])
    whole = one_mark((plain, curves, Paths.empty(), curves))
    assert len(whole) == len(whole.beziers) == 18
    assert whole.arcs.stroke.tolist() == [4, 9, 12, 17]
    np.testing.assert_array_equal(whole.beziers.path(3).control, curves.beziers.path(1).control)
    np.testing.assert_array_equal(whole.beziers.path(11).control, curves.beziers.path(1).control)
    assert len(one_mark(())) == 0
    layer = Layer("a", Pen(), (plain, curves))
    assert layer.strokes == (plain, curves.paths)


def chords(curve, start, end, count, order=None):
    """The chords of a curve as strokes of two points, as visibility leaves them."""
    t = np.linspace(start, end, count + 1)
    points = curve(t)
    pairs = [points[[k, k + 1]] for k in (np.arange(count) if order is None else order)]
    return polylines(*pairs, smooth=range(count), hidden_by=[0] * count)


@pytest.mark.slow
def test_ink_joins_the_chords_of_a_curve_and_fits_it_once():
    order = np.random.default_rng(4).permutation(1200)
    layers = (Layer("visible", Pen(), (chords(wave, 0.0, 2.0, 1200, order),)),)
    (layer,) = inked(layers, "none", np.eye(4), TOLERANCE)
    (mark,) = layer.marks
    assert isinstance(mark, CurvedStrokes) and len(mark) == 1
    assert farthest(wave, 0.0, 2.0, mark.beziers) <= TOLERANCE
    (plain,) = inked(layers, "none", np.eye(4))[0].marks
    np.testing.assert_array_equal(plain.points, mark.paths.points)


def test_ink_closes_a_circle():
    paths = chords(circle(40), 0.0, 2 * np.pi, 200)
    (mark,) = inked((Layer("visible", Pen(), (paths,)),), "none", np.eye(4), TOLERANCE)[0].marks
    assert mark.paths.closed.tolist() == [True] and mark.arcs.stroke.tolist() == [0]


def test_dashes_of_a_smooth_stroke_are_curves():
    paths = chords(wave, 0.0, 2.0, 600)
    hidden = Paths(
        paths.points, paths.offsets, *[paths.closed] + [paths.kind] * 2 + [paths.kind + 1], paths.points3d, paths.smooth
    )
    (mark,) = inked((Layer("hidden", Pen(), (hidden,)),), "dashed", np.eye(4), TOLERANCE)[0].marks
    assert len(mark) > 50
    assert (np.diff(mark.beziers.offsets) > 0).mean() > 0.9
    true = wave(np.linspace(0.0, 2.0, 20001))
    for i in np.flatnonzero(np.diff(mark.beziers.offsets)):
        control = mark.beziers.path(i).control
        assert distance(bezier_points(control, np.full(len(control), 0.5)), true) <= TOLERANCE
