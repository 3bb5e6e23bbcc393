"""Strokes with fewer points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pieces import chosen, concatenated, offsets_of, ranges, unrolled, world_per_mm
from vectorplot.geometry.mesh import Bools, Floats, Ints

_ROUNDS = 6
_CROWD = 32
"""After so many rounds, a chord that still replaces more points than this is split in its middle too: a spiral, whose
farthest points lie at its end, would take a round for every turn."""


def without_collinear_points(paths: Paths, tolerance_mm: float) -> Paths:
    """The same strokes without the points on the straight line between their neighbours.

    Every point left out lies within tolerance_mm of the segment that takes its place, however many are left out in a
    row, and in the world within as much of it on the scale of the drawing; a point where the stroke turns back stays. A
    closed stroke begins where it did if that point stays, otherwise at the next one that stays. points3d keeps the
    points that stay.
    Degenerate: a closed stroke of which two points stay becomes an open one; strokes of fewer than three points stay.
    Source: Douglas and Peucker, Algorithms for the reduction of the number of points, Cartographica 10 (1973), between
    the points that are no candidates.
    """
    long = np.diff(paths.offsets) > 2
    if not long.any():
        return paths
    if not long.all():
        thinned = without_collinear_points(chosen(paths, long), tolerance_mm)
        order = np.argsort(np.concatenate((np.flatnonzero(~long), np.flatnonzero(long))))
        return chosen(concatenated((chosen(paths, ~long), thinned)), order)
    straight = _goes_straight(paths, tolerance_mm)
    straight[straight] = _goes_straight_in_space(paths, np.flatnonzero(straight), tolerance_mm * world_per_mm(paths))
    if not straight.any():
        return paths
    start = np.where(paths.closed, _first_false(straight, paths.offsets), 0)
    line = unrolled(paths, start, paths.closed.astype(np.intp))
    kept = ~np.concatenate([straight, [False]])[_unrolled_index(paths, line, start)]
    kept[line.offsets[:-1]] = kept[line.offsets[1:] - 1] = True
    _keep_what_is_far(line, kept, paths.closed, tolerance_mm)
    # The repeated first point of a closed stroke has done its work.
    kept[line.offsets[1:][paths.closed] - 1] = False
    counts = np.add.reduceat(kept.astype(np.intp), line.offsets[:-1])
    return replace(
        line,
        points=line.points[kept],
        points3d=line.points3d[kept],
        offsets=offsets_of(counts),
        closed=paths.closed & (counts > 2),
    )


def _goes_straight(paths: Paths, tolerance_mm: float) -> Bools:
    """(p,) whether each point lies between its neighbours; False for the ends of open strokes."""
    first, last = paths.offsets[:-1], paths.offsets[1:] - 1
    into = np.zeros_like(paths.points)
    into[1:] = paths.points[1:] - paths.points[:-1]
    into[first] = paths.points[first] - paths.points[last]
    out = np.concatenate((into[1:], into[:1]))
    out[last] = into[first]
    chord = into + out
    along = into[:, 0] * out[:, 0] + into[:, 1] * out[:, 1] >= 0.0
    area = np.abs(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0])
    straight: Bools = along & (area <= tolerance_mm * np.hypot(chord[:, 0], chord[:, 1]))
    ends = np.concatenate((first[~paths.closed], last[~paths.closed]))
    straight[ends] = False
    return straight


def _goes_straight_in_space(paths: Paths, points: Ints, tolerance: float) -> Bools:
    """(n,) whether some points lie in the world within a tolerance of the segment between their neighbours."""
    stroke = np.searchsorted(paths.offsets, points, side="right") - 1
    first, last = paths.offsets[stroke], paths.offsets[stroke + 1] - 1
    before = paths.points3d[np.where(points > first, points - 1, last)]
    after = paths.points3d[np.where(points < last, points + 1, first)]
    return np.asarray(_distance(paths.points3d[points], before, after) <= tolerance)


def _first_false(flags: Bools, offsets: Ints) -> Ints:
    """(m,) the place of the first False in each run, 0 where there is none."""
    places = np.append(np.flatnonzero(~flags), len(flags))
    found = places[np.searchsorted(places, offsets[:-1])]
    return np.where(found < offsets[1:], found - offsets[:-1], 0)


def _unrolled_index(paths: Paths, line: Paths, start: Ints) -> Ints:
    """Where the points of unrolled strokes come from."""
    counts, longer = np.diff(paths.offsets), np.diff(line.offsets)
    local = ranges(start, longer)
    size = np.repeat(counts, longer)
    index: Ints = np.repeat(paths.offsets[:-1], longer) + np.where(local >= size, local - size, local)
    return index


def _keep_what_is_far(line: Paths, kept: Bools, closed: Bools, tolerance_mm: float) -> None:
    """Keep of the points between kept ones the farthest, until all lie within the tolerance of what replaces them."""
    unit = world_per_mm(line) or 1.0
    # A chord of a whole loop has no direction: its farthest point stays in any case.
    loops = np.zeros(len(kept), dtype=np.bool_)
    loops[line.offsets[:-1][closed]] = True
    open_points = np.flatnonzero(~kept)
    rounds = 0
    while len(open_points):
        stays = np.flatnonzero(kept)
        place = np.cumsum(kept)[open_points]
        before, after = stays[place - 1], stays[place]
        away = _distance(line.points[open_points], line.points[before], line.points[after])
        in_space = _distance(line.points3d[open_points], line.points3d[before], line.points3d[after])
        away = np.maximum(away, in_space / unit)
        begin = np.flatnonzero(np.concatenate(([True], before[1:] != before[:-1])))
        size = np.diff(np.append(begin, len(before)))
        most = np.maximum.reduceat(away, begin)
        whole = loops[before[begin]] & (after[begin] == _ends_of(line, before[begin]))
        split = (most > tolerance_mm) | whole
        chord = np.repeat(np.arange(len(begin)), size)
        farthest = np.flatnonzero((away == most[chord]) & split[chord])
        farthest = farthest[np.concatenate(([True], chord[farthest][1:] != chord[farthest][:-1]))[: len(farthest)]]
        if rounds >= _ROUNDS:
            crowded = split & (size > _CROWD)
            farthest = np.concatenate((farthest, begin[crowded] + size[crowded] // 2))
        kept[open_points[farthest]] = True
        again = split[chord]
        again[farthest] = False
        open_points = open_points[again]
        rounds += 1


def _ends_of(line: Paths, point: Ints) -> Ints:
    """The last points of the strokes that points belong to."""
    last: Ints = line.offsets[np.searchsorted(line.offsets, point, side="right")] - 1
    return last


def _distance(points: Floats, start: Floats, end: Floats) -> Floats:
    """(n,) from points to segments."""
    along, arm = end - start, points - start
    square = (along * along).sum(axis=1)
    t = np.clip((arm * along).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away = arm - t[:, None] * along
    return np.asarray(np.sqrt((away * away).sum(axis=1)), dtype=np.float64)
