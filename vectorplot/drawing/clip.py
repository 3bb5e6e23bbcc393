"""Cutting a drawing's strokes off at a rectangle of the page."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pieces import chosen, concatenated, sections, unrolled
from vectorplot.geometry.mesh import Bools, Floats, Ints

Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top in mm."""


def clipped(paths: Paths, rectangle: Rectangle, page_from_world: Floats | None = None) -> Paths:
    """The parts of the strokes inside the rectangle, its border included.

    rectangle: left, bottom, right, top in mm; page_from_world (4,4) as in Drawing, by default a parallel projection:
    with it points3d is cut where the page is. Strokes keep their order; a closed stroke that is cut becomes open ones
    that begin where it enters.
    Degenerate: a stroke that only touches the border leaves nothing. Of a segment more than 1e15 times as long as the
    rectangle nothing may be left: doubles do not say where it crosses.
    Source: Liang and Barsky, A new concept and method for line clipping, ACM Trans. Graphics 3 (1984).
    """
    low, high = np.array(rectangle[:2]), np.array(rectangle[2:])
    outside: Bools = np.any((paths.points < low) | (paths.points > high), axis=1)
    if not outside.any():
        return paths
    leaves = _any_in_each(outside, paths.offsets)
    index = np.flatnonzero(leaves)
    cut = chosen(paths, index)
    cut = unrolled(
        cut, np.where(cut.closed, _first_in_each(outside, paths.offsets, index), 0), cut.closed.astype(np.intp)
    )
    world = np.eye(4) if page_from_world is None else page_from_world
    parts, stroke = _inside(cut, low, high, world)
    whole = chosen(paths, ~leaves)
    order = np.argsort(np.concatenate((np.flatnonzero(~leaves), index[stroke])), kind="stable")
    return chosen(concatenated((whole, parts)), order)


def _any_in_each(flags: Bools, offsets: Ints) -> Bools:
    before = np.concatenate(([0], np.cumsum(flags)))[offsets]
    return before[1:] > before[:-1]


def _first_in_each(flags: Bools, offsets: Ints, index: Ints) -> Ints:
    """For each of the strokes of the index the place of its first flagged point within the stroke."""
    places = np.flatnonzero(flags)
    return places[np.searchsorted(places, offsets[index])] - offsets[index]


def _inside(paths: Paths, low: Floats, high: Floats, page_from_world: Floats) -> tuple[Paths, Ints]:
    """The parts of open strokes inside the box, and the stroke each one comes from."""
    counts = np.diff(paths.offsets)
    owner = np.repeat(np.arange(len(paths)), np.maximum(counts - 1, 0))
    starts = np.delete(np.arange(len(paths.points)), paths.offsets[1:][counts > 0] - 1)
    t0, t1 = _kept(paths.points[starts], paths.points[starts + 1], low, high)
    kept = np.flatnonzero(t0 < t1)
    starts, owner, t0, t1 = starts[kept], owner[kept], t0[kept], t1[kept]
    goes_on = (starts[1:] == starts[:-1] + 1) & (owner[1:] == owner[:-1]) & (t1[:-1] == 1.0) & (t0[1:] == 0.0)
    begin = np.flatnonzero(np.concatenate(([True], ~goes_on))[: len(kept)])
    end = np.concatenate((begin[1:], [len(kept)]))[: len(begin)] - 1
    stroke = owner[begin]
    parts = sections(paths, stroke, starts[begin], t0[begin], starts[end], t1[end], page_from_world)
    # Rounding may leave a cut a few ulp outside; backends rely on the border.
    np.clip(parts.points, low, high, out=parts.points)
    return parts, stroke


def _kept(a: Floats, b: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """The interval of each segment's parameter inside the box; empty (t0 >= t1) where it misses it."""
    t0, t1 = np.zeros(len(a)), np.ones(len(a))
    for axis in (0, 1):
        start, run = a[:, axis], b[:, axis] - a[:, axis]
        moves = run != 0.0
        divisor = np.where(moves, run, 1.0)
        with np.errstate(
            over="ignore"
        ):  # a run of almost nothing: far outside the parameter's range is all that counts
            to_low, to_high = (low[axis] - start) / divisor, (high[axis] - start) / divisor
        misses = ~moves & ((start < low[axis]) | (start > high[axis]))
        t0 = np.maximum(t0, np.where(moves, np.minimum(to_low, to_high), -np.inf))
        t1 = np.minimum(t1, np.where(moves, np.maximum(to_low, to_high), np.inf))
        t1 = np.where(misses, -np.inf, t1)
    # An end that is inside belongs to the part, whatever the division rounds to.
    t0 = np.where(((a >= low) & (a <= high)).all(axis=1), 0.0, t0)
    t1 = np.where(((b >= low) & (b <= high)).all(axis=1), 1.0, t1)
    return t0, t1
