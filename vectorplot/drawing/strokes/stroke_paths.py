"""Choosing, reordering and cutting polylines, all at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import joined, some, with_points


def world_per_mm(paths: Paths) -> float:
    """The extent of the strokes in the world by that on the page; 0 without points or without extent."""
    if not len(paths.points):
        return 0.0
    mm, world = (float(max(np.ptp(axis) for axis in points.T)) for points in (paths.points, paths.points3d))
    return world / mm if mm > 0.0 else 0.0


def chosen(paths: Paths, which: Ints | Bools) -> Paths:
    """The strokes with these indices, in this order; or those where a mask is true."""
    return some(paths, which)


def concatenated(parts: tuple[Paths, ...]) -> Paths:
    """The strokes of all parts, one part after the other."""
    return joined(parts) if parts else Paths.empty()


def unrolled(paths: Paths, start: Ints, extra: Ints) -> Paths:
    """The same strokes as open ones: stroke i begins at its point start[i], goes round once, and extra[i] points on.

    extra of 1 closes a loop by repeating its first point; the number of points gives a second lap; 0 is for open
    strokes, which begin at 0.
    """
    counts = np.diff(paths.offsets)
    longer = counts + extra
    local = ragged.ranges(start, longer)
    index = np.repeat(paths.offsets[:-1], longer) + local % np.maximum(np.repeat(counts, longer), 1)
    open_ = np.zeros(len(paths), dtype=np.bool_)
    return replace(with_points(paths, index, np.arange(len(paths)), ragged.offsets(longer)), closed=open_)


def directed(directions: Floats, backwards: Bools) -> Floats:
    """(p,2) the directions at points, turned round at those that strokes run through backwards (p,) now."""
    turned = _known(directions, backwards)
    if not len(turned):
        return directions
    there, result = directions.take(turned, axis=0), directions.copy()
    result[turned] = np.where(there > 0.0, there - np.pi, there + np.pi)[:, ::-1]
    return result


def swapped(handles: Floats, backwards: Bools) -> Floats:
    """(p,2) the lengths of handles at points, those back and ahead changed where strokes run backwards (p,) now."""
    turned = _known(handles, backwards)
    if not len(turned):
        return handles
    result = handles.copy()
    result[turned] = handles.take(turned, axis=0)[:, ::-1]
    return result


def _known(values: Floats, which: Bools) -> Ints:
    """Those of some points (p,) of which one of two values (p,2) at least is known."""
    return np.flatnonzero(which & ~(np.isnan(values[:, 0]) & np.isnan(values[:, 1])))


def sections(
    paths: Paths, stroke: Ints, first: Ints, t_first: Floats, last: Ints, t_last: Floats, page_from_world: Floats
) -> Paths:
    """Parts of open strokes, as strokes of their own.

    Part i belongs to stroke[i]; it begins on the segment that starts at point first[i], at the fraction t_first[i],
    and ends on the segment of last[i] at t_last[i]. The points in the world divide their segments so that their
    images are the points on the page: for a central projection the fraction differs from that on the page. Directions
    and handles are those of the points; in the middle of a segment none is known.
    """
    offsets = ragged.offsets(last - first + 2)
    index = ragged.ranges(first, last - first + 2)
    points, points3d = paths.points.take(index, axis=0), paths.points3d.take(index, axis=0)
    directions, handles = (values.take(index, axis=0) for values in (paths.directions, paths.handles))
    for places, segment, t, there, point in (
        (offsets[:-1], first, t_first, t_first == 1.0, first + 1),
        (offsets[1:] - 1, last, t_last, t_last == 0.0, last),
    ):
        inside = np.flatnonzero((t != 0.0) & (t != 1.0))
        cut = places[inside]
        points[cut], points3d[cut] = _divided(paths, segment[inside], t[inside], page_from_world)
        directions[cut] = handles[cut] = np.nan
        # Parts that begin where their segment ends, or end where it begins.
        ends = np.flatnonzero(there)
        at, of = places.take(ends), point.take(ends)
        points[at], points3d[at] = paths.points.take(of, axis=0), paths.points3d.take(of, axis=0)
        directions[at], handles[at] = paths.directions.take(of, axis=0), paths.handles.take(of, axis=0)
    open_ = np.zeros(len(stroke), dtype=np.bool_)
    return Paths(
        points,
        offsets,
        open_,
        paths.kind[stroke],
        paths.item[stroke],
        paths.hidden_by[stroke],
        points3d,
        paths.smooth[stroke],
        directions,
        paths.curve[stroke],
        handles,
    )


def _divided(paths: Paths, segment: Ints, t: Floats, page_from_world: Floats) -> tuple[Floats, Floats]:
    """The points at the fractions t of the segments, on the page and in the world; exact at 0 and 1."""
    a, b = paths.points.take(segment, axis=0), paths.points.take(segment + 1, axis=0)
    a3, b3 = paths.points3d.take(segment, axis=0), paths.points3d.take(segment + 1, axis=0)
    # Depths count by their ratio alone: powers of two keep what is very large within range, and all digits.
    reach, weight = (int(np.frexp(np.abs(some).max(initial=1.0))[1]) for some in ((a3, b3), page_from_world[3]))
    row = np.ldexp(page_from_world[3], (-weight, -weight, -weight, -weight - reach))
    depth_a, depth_b = (np.abs(matmul(np.ldexp(ends, -reach), row[:3]) + row[3]) for ends in (a3, b3))
    whole = t * depth_a + (1.0 - t) * depth_b
    # Both depths vanish only for points that have no image; they are divided as on the page.
    s = np.where(whole > 0.0, t * depth_a / np.where(whole > 0.0, whole, 1.0), t)
    return _mixed(a, b, t[:, None]), _mixed(a3, b3, s[:, None])


def _mixed(a: Floats, b: Floats, t: Floats) -> Floats:
    return np.where(t < 0.5, a + t * (b - a), b - (1.0 - t) * (b - a))
