"""What is known of a curve's directions and of its identity goes with its points, whatever is done to strokes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.sample_paths import polylines

from vectorplot.curves.bezier import bezier_tangents
from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.finishing import long_strokes, without_collinear_points
from vectorplot.drawing.pen_order import pen_ordered
from vectorplot.drawing.stroke_curves import curved_strokes
from vectorplot.drawing.strokes import chosen, clipped, concatenated, joined, split_long


def ellipse(t):
    return np.column_stack((100 + 60 * np.cos(t), 80 + 25 * np.sin(t)))


def angle_there(points):
    """The direction of the ellipse at its points, counter-clockwise."""
    x, y = (points[:, 0] - 100) / 60, (points[:, 1] - 80) / 25
    return np.arctan2(25 * x, -60 * y)


def chords(t, curve=0):
    """The chords of the ellipse between parameters, as strokes of two points that know their directions."""
    points = ellipse(t)
    count = len(t) - 1
    both = np.stack((points[:-1], points[1:]), axis=1).reshape(-1, 2)
    paths = polylines(*both.reshape(-1, 2, 2), smooth=range(count))
    directions = np.full((2 * count, 2), np.nan)
    directions[::2, 1], directions[1::2, 0] = angle_there(both[::2]), angle_there(both[1::2])
    return replace(paths, directions=directions, curve=np.full(count, curve))


def backwards(paths, which):
    """Some of strokes of two points against their direction."""
    index = np.arange(len(paths.points)).reshape(-1, 2)
    index[which] = index[which][:, ::-1]
    index = index.ravel()
    turned = np.repeat(which, 2)
    directions = paths.directions[index]
    directions[turned] = directions[turned][:, ::-1] + np.pi
    return replace(paths, points=paths.points[index], points3d=paths.points3d[index], directions=directions)


def apart(one, two):
    return np.abs((one - two + np.pi) % (2 * np.pi) - np.pi)


def assert_right(paths: Paths, cuts: int = 0) -> None:
    """Every direction is that of the ellipse, the way the stroke runs; none is missing but at ends, which cuts have."""
    lines = np.split(np.arange(len(paths.points)), paths.offsets[1:-1])
    for number, line in enumerate(lines):
        points, given = paths.points[line], paths.directions[line]
        ahead = points[1] - points[0]
        first = angle_there(points[:1])[0]
        way = 0.0 if ahead @ (np.cos(first), np.sin(first)) > 0 else np.pi
        known = np.isfinite(given)
        assert apart(given, angle_there(points)[:, None] + way)[known].max(initial=0.0) < 1e-9
        expected = np.ones_like(known)
        if not paths.closed[number]:
            expected[0, 0] = expected[-1, 1] = False
            expected[0, 1] &= not cuts or known[0, 1]
            expected[-1, 0] &= not cuts or known[-1, 0]
            known[0, 0] = known[-1, 1] = False
        assert (known == expected).all()


T = np.linspace(0.0, 2.0 * np.pi, 90)
RANDOM = np.random.default_rng(2)
SHUFFLED = chosen(backwards(chords(T), RANDOM.random(89) < 0.5), RANDOM.permutation(89))


def test_joined_rings_and_open_strokes_know_both_sides_of_every_point():
    ring = joined(SHUFFLED, np.zeros(89, dtype=np.intp), 1e-3)
    assert len(ring) == 1 and ring.closed.all()
    assert_right(ring)
    some = joined(chosen(SHUFFLED, np.arange(80)), np.zeros(80, dtype=np.intp), 1e-3)
    assert 1 < len(some) < 10 and not some.closed.any()
    assert_right(some)


@pytest.mark.parametrize(
    ("change", "cuts"),
    [
        (pen_ordered, 0),
        (lambda paths: without_collinear_points(paths, 0.05), 0),
        (lambda paths: split_long(paths, 30.0), 1),
        (lambda paths: dashed(paths, 7.0, 3.0), 1),
        (lambda paths: clipped(paths, (45.0, 60.0, 140.0, 90.0)), 1),
        (lambda paths: pen_ordered(split_long(paths, 30.0)), 1),
        (lambda paths: concatenated((paths, chosen(paths, np.array([0])))), 0),
    ],
    ids=["pen order", "simplify", "split", "dashes", "clip", "split and order", "concatenate"],
)
def test_directions_go_with_the_points(change, cuts):
    for count in (89, 80):
        strokes = joined(chosen(SHUFFLED, np.arange(count)), np.zeros(count, dtype=np.intp), 1e-3)
        changed = change(strokes)
        assert (changed.curve == 0).all()
        assert_right(changed, cuts)


def test_curves_that_meet_are_joined_each_to_itself_first():
    # Two chords of each of two curves end in one place, the straighter way leads from one curve to the other.
    lines = [[(0, 0), (10, 0)], [(10, 0), (20, 6)], [(0, 6), (10, 0)], [(10, 0), (20, 0)]]
    one = replace(polylines(*lines, smooth=range(4)), curve=np.array([0, 0, 1, 1]))
    strokes = long_strokes(one)
    assert len(strokes) == 2
    assert sorted(map(int, strokes.curve)) == [0, 1]
    ends = {int(c): sorted(map(tuple, strokes.points[[a, b - 1]].tolist())) for c, a, b in spans(strokes)}
    assert ends == {0: [(0.0, 0.0), (20.0, 6.0)], 1: [(0.0, 6.0), (20.0, 0.0)]}
    # What is left over is joined across curves.
    assert len(long_strokes(replace(chosen(one, np.array([0, 3])), curve=np.array([0, 1])))) == 1


def spans(paths):
    return zip(paths.curve, paths.offsets[:-1], paths.offsets[1:], strict=True)


def test_the_path_has_the_directions_that_are_known():
    ring = joined(chords(np.linspace(0.0, 2.0 * np.pi, 400)), np.zeros(399, dtype=np.intp), 1e-3)
    # Pressed together, so that it is no ellipse any more.
    x = ring.points[:, 0] - 100
    bent = np.column_stack((ring.points[:, 0], ring.points[:, 1] + 0.002 * x * x))
    angle = np.arctan2(np.sin(ring.directions) + 0.004 * x[:, None] * np.cos(ring.directions), np.cos(ring.directions))
    beziers = curved_strokes(replace(ring, points=bent, directions=angle), 0.02).beziers
    knots = beziers.control[:, 0]
    place = np.argmin(np.linalg.norm(bent[:, None] - knots, axis=2), axis=0)
    way = bezier_tangents(beziers.control, np.zeros(len(knots)))
    assert apart(np.arctan2(way[:, 1], way[:, 0]), angle[place, 1]).max() < 1e-9
