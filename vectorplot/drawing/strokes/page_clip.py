"""Cutting a drawing's strokes off at a rectangle of the page."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated, sections, unrolled
from vectorplot.geometry import ragged

Rectangle = tuple[float, float, float, float]
"""Left, bottom, right, top in mm."""


def clipped(paths: Paths, rectangle: Rectangle, page_from_world: Floats | None = None) -> Paths:
    """The parts of the strokes inside the rectangle, as clipped_parts gives them."""
    return clipped_parts(paths, rectangle, page_from_world)[0]


def clipped_parts(paths: Paths, rectangle: Rectangle, page_from_world: Floats | None = None) -> tuple[Paths, Ints]:
    """The parts of the strokes inside the rectangle, its border included, and the stroke that each comes from.

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
        return paths, np.arange(len(paths))
    leaves = _any_in_each(outside, paths.offsets)
    index = np.flatnonzero(leaves)
    cut = chosen(paths, index)
    cut = unrolled(
        cut, np.where(cut.closed, _first_in_each(outside, paths.offsets, index), 0), cut.closed.astype(np.intp)
    )
    world = np.eye(4) if page_from_world is None else page_from_world
    parts, stroke = _inside(cut, low, high, world)
    whole = chosen(paths, ~leaves)
    source = np.concatenate((np.flatnonzero(~leaves), index[stroke]))
    order = np.argsort(source, kind="stable")
    return chosen(concatenated((whole, parts)), order), source[order]


def _any_in_each(flags: Bools, offsets: Ints) -> Bools:
    before = ragged.offsets(flags)[offsets]
    return before[1:] > before[:-1]


def _first_in_each(flags: Bools, offsets: Ints, index: Ints) -> Ints:
    """For each of the strokes of the index the place of its first flagged point within the stroke."""
    places = np.flatnonzero(flags)
    return places[np.searchsorted(places, offsets[index])] - offsets[index]


def _inside(paths: Paths, low: Floats, high: Floats, page_from_world: Floats) -> tuple[Paths, Ints]:
    """The parts of open strokes inside the box, and the stroke each one comes from."""
    counts = np.diff(paths.offsets)
    owner = ragged.owner(np.maximum(counts - 1, 0))
    starts = np.delete(np.arange(len(paths.points)), paths.offsets[1:][counts > 0] - 1)
    a, b = paths.points[starts], paths.points[starts + 1]
    t0, axis0 = _entered(a, b, low, high)
    t1, axis1 = _entered(b, a, low, high)
    t1 = 1.0 - t1
    kept = np.flatnonzero(t0 < t1)
    goes_on = (np.diff(starts[kept]) == 1) & (t1[kept[:-1]] == 1.0) & (t0[kept[1:]] == 0.0)
    goes_on &= owner[kept[1:]] == owner[kept[:-1]]
    begin = kept[np.concatenate(([True], ~goes_on))[: len(kept)]]
    end = kept[np.concatenate((~goes_on, [True]))[: len(kept)]]
    parts = sections(paths, owner[begin], starts[begin], t0[begin], starts[end], t1[end], page_from_world)
    # Rounding may leave a cut beside the border it lies on, far beside it if the segment is very long.
    _pinned(parts.points, parts.offsets[:-1], axis0[begin], (b > a)[begin], low, high)
    _pinned(parts.points, parts.offsets[1:] - 1, axis1[end], (a > b)[end], low, high)
    np.clip(parts.points, low, high, out=parts.points)
    return parts, owner[begin]


def _pinned(points: Floats, places: Ints, axis: Ints, rises: Bools, low: Floats, high: Floats) -> None:
    """Put cut ends on the border they cross: the lower one where the segment rises into the box. axis -1 is no cut."""
    cut = np.flatnonzero(axis >= 0)
    side = axis[cut]
    points[places[cut], side] = np.where(rises[cut, side], low[side], high[side])


def _entered(a: Floats, b: Floats, low: Floats, high: Floats) -> tuple[Floats, Ints]:
    """The parameter at which each segment from a to b enters the box, and through a border across which axis.

    0 and -1 where a is inside; infinite where the segment runs beside the box.
    """
    t, across = np.zeros(len(a)), np.full(len(a), -1)
    for axis in (0, 1):
        start, run = a[:, axis], b[:, axis] - a[:, axis]
        border = np.where(run > 0.0, low[axis], high[axis])
        before = np.where(run > 0.0, start < border, start > border)
        outside = (start < low[axis]) | (start > high[axis])
        with np.errstate(over="ignore"):  # a run of almost nothing: that it ends outside is all that counts
            entry = (border - start) / np.where(run != 0.0, run, 1.0)
        entry = np.where(outside & ((run == 0.0) | ~before), np.inf, np.where(before, entry, 0.0))
        across = np.where(entry > t, axis, across)
        t = np.maximum(t, entry)
    return t, across
