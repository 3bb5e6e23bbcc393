"""Strokes of which every chord is known to be a Bézier curve, as few such curves."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier.paths import BezierPaths
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import segments


def exact_cubics(paths: Paths, tolerance: float) -> tuple[Ints, BezierPaths]:
    """The strokes (k,) of which all handles are known, and their Bézier curves, with error 0.

    Neighbouring curves that are parts of one, as the chords between two knots of a spline are, become that one where it
    has their control points within the tolerance.
    Source: Farin, Curves and Surfaces for CAGD, de Casteljau's scheme.
    """
    sizes = np.diff(paths.offsets)
    known = np.zeros(len(paths), dtype=np.bool_)
    some = np.isfinite(paths.handles).any(axis=1)
    if some.any():
        unknown = np.isnan(paths.handles)
        # Nothing comes before the start of an open stroke, and nothing behind its end.
        filled = np.flatnonzero(~paths.closed & (sizes > 0))
        unknown[paths.offsets[filled], 0] = unknown[paths.offsets[filled + 1] - 1, 1] = False
        lacking = np.bincount(ragged.owner(sizes)[unknown.any(axis=1)], minlength=len(paths)) > 0
        known = ~lacking & (sizes > 1)
    which = np.flatnonzero(known)
    exact = chosen(paths, which)
    start, end = segments(exact).T if len(exact) else np.zeros((2, 0), dtype=np.intp)
    leaving, arriving = _ways(exact, start, 1), _ways(exact, end, 0)
    first, last = exact.points[start], exact.points[end]
    control = np.stack([first, first + leaving, last - arriving, last], axis=1)
    owner = ragged.owner(np.diff(exact.offsets) - ~exact.closed)
    control, owner = _merged(control, owner, tolerance)
    offsets = ragged.offsets(np.bincount(owner, minlength=len(exact)))
    return which, BezierPaths(control, offsets, exact.closed, np.zeros(len(exact)))


def _ways(paths: Paths, point: Ints, side: int) -> Floats:
    """(s,2) the handles at points, forwards: back (0) or ahead (1) of them."""
    angle = np.nan_to_num(paths.directions[point, side])
    return np.asarray(paths.handles[point, side, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def _merged(control: Floats, owner: Ints, tolerance: float) -> tuple[Floats, Ints]:
    """Fewer segments (k,4,2), and their strokes (k,)."""
    vain, turn = 0, 0
    while vain < 2 and len(owner) > 1:
        pair = np.arange(turn % 2, len(owner) - 1, 2)
        pair = pair[owner[pair] == owner[pair + 1]]
        whole, good = _one_of_two(control[pair], control[pair + 1], tolerance)
        vain, turn = (0, turn) if good.any() else (vain + 1, turn + 1)
        kept = np.ones(len(owner), dtype=np.bool_)
        kept[pair[good] + 1] = False
        control = control.copy()
        control[pair[good]] = whole[good]
        control, owner = control[kept], owner[kept]
    return control, owner


def _one_of_two(a: Floats, b: Floats, tolerance: float) -> tuple[Floats, Bools]:
    """(k,4,2) the curves of which two neighbours are the parts, and whether (k,) they are."""
    ahead, back = (np.linalg.norm(way, axis=1) for way in (b[:, 1] - b[:, 0], a[:, 3] - a[:, 2]))
    moves = (ahead > 0.0) & (back > 0.0)
    share = np.where(moves, back / np.where(moves, ahead + back, 1.0), 0.5)[:, None]
    one, two = a[:, 0] + (a[:, 1] - a[:, 0]) / share, b[:, 3] - (b[:, 3] - b[:, 2]) / (1.0 - share)
    whole = np.stack([a[:, 0], one, two, b[:, 3]], axis=1)
    low, high, points = [whole[:, 0]], [whole[:, 3]], whole
    for _ in range(3):
        points = points[:, :-1] + share[:, None] * (points[:, 1:] - points[:, :-1])
        low.append(points[:, 0])
        high.append(points[:, -1])
    off = np.abs(np.stack([np.stack(low, axis=1) - a, np.stack(high[::-1], axis=1) - b])).max(axis=(0, 2, 3))
    return whole, np.asarray(moves & (off <= tolerance))
