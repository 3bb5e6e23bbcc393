"""The lines that are seen from a place all round, by bearing and elevation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.drawing import NO_CURVE, Paths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.panoramic_view import Panorama
from vectorplot.geometry.elementary import arctan, arctan2, tan
from vectorplot.scene.pages.page import Page
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

WIDEST_DEG = 90.0
"""Of one camera: from its middle to its sides 45 degrees, and no line is larger there than twice."""

MOST_HALVINGS = 24
"""Of a line that passes just above or below the eye."""

Trace = Callable[[Camera, Page], Paths]
"""The visible lines that a camera sees on a page that its picture fills, as straight parts of two points."""


def lines_all_round(
    given: Panorama, eye: Floats, radius_mm: float, trace: Trace, done: Callable[[float], None] | None = None
) -> Paths:
    """The lines that are seen, as straight parts of two points: bearings and elevations in radians; parts of lines of
    the world that are curves there are not divided yet.

    radius_mm: how long a radian is on the page, for what is only drawn as well as it is seen.
    """
    first, last = np.radians(given.bearings_deg)
    count = int(np.ceil(given.width_deg / WIDEST_DEG))
    half = 0.5 * (last - first) / count
    steepest = np.radians(max(abs(given.lowest_deg), abs(given.highest_deg)))
    # A cone of one elevation is highest in the picture at its sides.
    top, side = float(tan(steepest) / np.cos(half)), float(tan(half))
    page = Page(2.0 * radius_mm * side, 2.0 * radius_mm * top, 0.0)
    found, curves = [Paths.empty()], 0
    for number in range(count):
        bearing = first + (2 * number + 1) * half
        ahead = np.array([np.sin(bearing), np.cos(bearing), 0.0])
        # Far from the origin a unit would be lost in rounding.
        target = eye + max(1.0, float(np.abs(eye).max())) * ahead
        camera = Camera(tuple(eye), tuple(target), up=(0.0, 0.0, 1.0), fov_deg=float(np.degrees(2.0 * arctan(top))))
        seen = trace(camera, page)
        seen = replace(seen, curve=np.where(seen.curve == NO_CURVE, NO_CURVE, seen.curve + curves))
        curves = max(curves, int(seen.curve.max(initial=NO_CURVE)) + 1)
        found.append(_unrolled(seen, eye, ahead, bearing))
        if done is not None:
            done((number + 1) / count)
    return concatenated(tuple(found))


def _unrolled(seen: Paths, eye: Floats, ahead: Floats, middle: float) -> Paths:
    """The strokes of one camera, by bearing and elevation. middle: the bearing ahead."""
    return replace(
        seen,
        points=bearings_and_elevations(seen.points3d - eye, ahead, middle),
        directions=np.full_like(seen.directions, np.nan),
        handles=np.full_like(seen.handles, np.nan),
    )


def bearings_and_elevations(ways: Floats, ahead: Floats, middle: float) -> Floats:
    """(k,2) of ways (k,3) from the eye, of which those ahead have the bearing middle."""
    right = np.array([ahead[1], -ahead[0], 0.0])
    level = np.hypot(ways[:, 0], ways[:, 1])
    bearing = middle + arctan2(matmul(ways, right), matmul(ways, ahead))
    return np.stack([bearing, arctan2(ways[:, 2], level)], axis=1)


def with_chords(lines: Paths, eye: Floats, apart: float) -> Paths:
    """Lines by bearing and elevation in parts that are so short that none is off its line by more than apart, in
    radians.

    The parts are halved where one sees their middles, as often as needed.
    """
    done = [Paths.empty()]
    for _ in range(MOST_HALVINGS):
        if not len(lines):
            break
        ways = (lines.points3d - eye).reshape(-1, 2, 3)
        flat = lines.points.reshape(-1, 2, 2)
        far = np.linalg.norm(ways, axis=2)
        share = far[:, 0] / np.maximum(far.sum(axis=1), LEAST_DIVISOR)
        middle = ways[:, 0] + share[:, None] * (ways[:, 1] - ways[:, 0])
        seen = _between(middle, flat)
        off = np.linalg.norm(seen - flat.mean(axis=1), axis=1)
        fine: Bools = ~(off > apart) | ~np.isfinite(seen).all(axis=1)
        done.append(chosen(lines, fine))
        flat, ways, middle, seen = flat[~fine], ways[~fine], middle[~fine], seen[~fine]
        lines = chosen(lines, np.repeat(np.flatnonzero(~fine), 2))
        if len(lines):
            both = np.stack([flat[:, 0], seen, seen, flat[:, 1]], axis=1).reshape(-1, 2)
            solid = np.stack([ways[:, 0], middle, middle, ways[:, 1]], axis=1).reshape(-1, 3) + eye
            lines = replace(lines, points=both, points3d=solid)
    return concatenated((*done, lines))


def _between(middle: Floats, flat: Floats) -> Floats:
    """(k,2) bearing and elevation of ways (k,3) between the ends (k,2,2) of parts: of its bearings the one there."""
    turn = 2.0 * np.pi
    bearing = arctan2(middle[:, 0], middle[:, 1])
    bearing += turn * np.round((flat[:, :, 0].mean(axis=1) - bearing) / turn)
    return np.stack([bearing, arctan2(middle[:, 2], np.hypot(middle[:, 0], middle[:, 1]))], axis=1)
