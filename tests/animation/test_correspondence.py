"""Curves of frames begin at the same end, and run the same way round, whatever way a pen came to them."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.animation.correspondence import _turned, corresponding
from vectorplot.drawing.drawing import CurvedStrokes
from vectorplot.surfaces import Sphere, Torus

SCENE = vp.Scene((vp.Item("ring", Torus(3, 1)), vp.Item("ball", Sphere(1.2)).moved(3, 0, 2)))


def strokes(drawing):
    return [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]


def frame(azimuth_deg):
    turn = np.radians(azimuth_deg)
    camera = vp.Camera((12 * np.cos(turn), 12 * np.sin(turn), 5))
    drawing = vp.draw(SCENE, camera, page="100x80", lines=("contour",))
    return drawing, corresponding(drawing, SCENE)


@pytest.fixture(scope="module")
def frames():
    return [frame(azimuth) for azimuth in (10, 25)]


def ends_of_curves(mark):
    """Where the curves of strokes begin and end: of arcs, else of paths; and where their polylines do."""
    found, offsets = [], mark.beziers.offsets
    for number in range(len(mark)):
        first, last = mark.paths.offsets[number], mark.paths.offsets[number + 1] - 1
        line = mark.paths.points[[first, first if mark.paths.closed[number] else last]]
        if offsets[number + 1] > offsets[number]:
            control = mark.beziers.control[offsets[number] : offsets[number + 1]]
            assert np.abs(control[1:, 0] - control[:-1, 3]).max(initial=0.0) < 1e-9
            found.append((line, control[[0, -1], [0, 3]]))
    arcs = mark.arcs.points(np.stack([mark.arcs.start, mark.arcs.end], axis=1))
    for number, curve in zip(mark.arcs.stroke.tolist(), arcs, strict=True):
        first, last = mark.paths.offsets[number], mark.paths.offsets[number + 1] - 1
        found.append((mark.paths.points[[first, first if mark.paths.closed[number] else last]], curve))
    return found


@pytest.mark.slow
def test_open_curves_begin_at_their_lower_end_and_loops_run_counter_clockwise(frames):
    seen = {"open": 0, "closed": 0}
    for _, drawing in frames:
        for mark in strokes(drawing):
            for number, closed in enumerate(mark.paths.closed):
                points = slice(*mark.paths.offsets[number : number + 2])
                if closed:
                    x, y = (mark.paths.points[points] - mark.paths.points[points.start]).T
                    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0
                elif mark.paths.item[number] >= 0:
                    heights = mark.paths.points3d[points, 2]
                    assert heights[0] <= heights[-1]
                seen["closed" if closed else "open"] += 1
    assert min(seen.values()) > 0


def test_what_draws_a_stroke_is_turned_with_it_and_draws_the_same(frames):
    for before, drawing in frames:
        for mark in strokes(drawing):
            ends = ends_of_curves(mark)
            assert ends and all(np.abs(line - curve).max() < 0.05 for line, curve in ends)
        lengths = [sorted(np.round(list(curve_lengths(one)), 6)) for one in (before, drawing)]
        assert lengths[0] == lengths[1]


def curve_lengths(drawing):
    """The length of the control polygon of every path, whatever way it runs."""
    for mark in strokes(drawing):
        for first, last in zip(mark.beziers.offsets[:-1], mark.beziers.offsets[1:], strict=True):
            yield np.linalg.norm(np.diff(mark.beziers.control[first:last], axis=1), axis=2).sum()


def test_turning_twice_is_turning_once(frames):
    class Heights:
        def vertex(self, points, item):
            return np.zeros(len(points), dtype=int), points[:, 2]

    for before, _ in frames:
        for mark in strokes(before):
            once = _turned(mark, Heights())
            again = _turned(once, Heights())
            assert (again.paths.points == once.paths.points).all()
            assert (again.beziers.control == once.beziers.control).all()
