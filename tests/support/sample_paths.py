"""Strokes for the tests of this room, and what can be measured on them."""

import numpy as np

from vectorplot.drawing.drawing import Paths


def polylines(*lines, closed=(), kind=None, item=None, hidden_by=None, smooth=()):
    """Strokes through the given points; closed, smooth: their numbers. points3d is the page, one unit higher."""
    count = len(lines)
    points = np.concatenate([np.asarray(line, dtype=float).reshape(-1, 2) for line in lines] or [np.zeros((0, 2))])
    zeros = np.zeros(count, dtype=np.intp)
    return Paths(
        points,
        np.concatenate(([0], np.cumsum([len(line) for line in lines]))).astype(np.intp),
        np.isin(np.arange(count), closed),
        zeros if kind is None else np.asarray(kind, dtype=np.intp),
        zeros if item is None else np.asarray(item, dtype=np.intp),
        zeros if hidden_by is None else np.asarray(hidden_by, dtype=np.intp),
        np.column_stack((points, np.ones(len(points)))),
        np.isin(np.arange(count), smooth),
    )


def pieces(starts, ends):
    """Straight strokes of two points."""
    starts, ends = np.asarray(starts, dtype=float), np.asarray(ends, dtype=float)
    count = len(starts)
    points = np.stack((starts, ends), axis=1).reshape(-1, 2)
    zeros = np.zeros(count, dtype=np.intp)
    offsets = np.arange(0, 2 * count + 1, 2)
    above = np.column_stack((points, np.ones(2 * count)))
    return Paths(points, offsets, np.zeros(count, dtype=bool), zeros, zeros, zeros, above)


def lines_of(paths):
    """The points of each stroke, the first repeated at the end of a closed one."""
    found = []
    for i in range(len(paths)):
        line = paths.points[paths.offsets[i] : paths.offsets[i + 1]]
        found.append(np.concatenate((line, line[:1])) if paths.closed[i] else line)
    return found


def segments_of(paths):
    """(s,2,2) all straight segments."""
    parts = [np.stack((line[:-1], line[1:]), axis=1) for line in lines_of(paths)]
    return np.concatenate(parts or [np.zeros((0, 2, 2))])


def length_mm(paths):
    segments = segments_of(paths)
    return float(np.hypot(*(segments[:, 1] - segments[:, 0]).T).sum())


def canonical(paths, digits=9):
    """The segments as a sorted list, whatever their order and direction."""
    segments = np.round(segments_of(paths), digits) + 0.0
    return sorted(tuple(sorted(map(tuple, segment.tolist()))) for segment in segments)


def farthest_from(points, segments):
    """The largest distance of any of the points from the union of the segments."""
    if not len(points):
        return 0.0
    along = segments[:, 1] - segments[:, 0]
    arm = points[:, None] - segments[None, :, 0]
    square = np.maximum((along * along).sum(axis=1), 1e-300)
    t = np.clip((arm * along).sum(axis=2) / square, 0.0, 1.0)
    return float(np.hypot(*np.moveaxis(arm - t[:, :, None] * along, 2, 0)).min(axis=1).max())


def samples_of(paths, per_segment=21):
    """Points spread along all segments."""
    segments = segments_of(paths)
    t = np.linspace(0.0, 1.0, per_segment)[:, None, None]
    return (segments[None, :, 0] * (1 - t) + segments[None, :, 1] * t).reshape(-1, 2)
