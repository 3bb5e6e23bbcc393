"""Strokes that stop before letters."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated, sections, unrolled
from vectorplot.exact import intervals
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_lengths import UNION_OF_SEGMENT


def grown(boxes: Floats, margin_mm: float) -> Floats:
    """(b,4,2) the rectangles, wider and higher by a margin on every side."""
    sides = np.stack([boxes[:, 1] - boxes[:, 0], boxes[:, 3] - boxes[:, 0]], axis=1)
    long = np.sqrt((sides * sides).sum(axis=2, keepdims=True))
    step = margin_mm * sides / np.where(long > 0.0, long, 1.0)
    across, up = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    return np.asarray(boxes + across[:, None] * step[:, :1] + up[:, None] * step[:, 1:])


def outside_boxes(paths: Paths, boxes: Floats, page_from_world: Floats) -> Paths:
    """The parts of strokes that lie outside of rectangles, in the order of the strokes.

    boxes (b,4,2): corners, counter-clockwise; page_from_world (4,4) as of Drawing: with it points in the world are cut
    where the page is. A closed stroke that is cut becomes open ones.
    Degenerate: what only touches a rectangle stays.
    Source: Cyrus and Beck, Generalized two- and three-dimensional clipping, Computers & Graphics 3 (1978).
    """
    touched = _touched(paths, boxes)
    if not len(touched):
        return paths
    cut = chosen(paths, touched)
    cut = unrolled(cut, np.zeros(len(cut), dtype=np.intp), cut.closed.astype(np.intp))
    counts = np.diff(cut.offsets)
    owner = ragged.owner(np.maximum(counts - 1, 0))
    starts = np.delete(np.arange(len(cut.points)), cut.offsets[1:][counts > 0] - 1)
    a, b = cut.points[starts], cut.points[starts + 1]
    segment, box = near_boxes(a, b, boxes)
    low, high = inside_box(a[segment], b[segment], boxes[box])
    hit = low < high
    fine = np.full(len(starts), UNION_OF_SEGMENT)
    covered = intervals.union(segment[hit], low[hit], high[hit], fine)
    segment, low, high = intervals.complement(len(starts), *covered, fine)
    goes_on = (np.diff(segment) == 1) & (high[:-1] == 1.0) & (low[1:] == 0.0)
    goes_on &= owner[segment[1:]] == owner[segment[:-1]]
    begin = np.flatnonzero(np.append(True, ~goes_on)[: len(segment)])
    end = np.flatnonzero(np.append(~goes_on, True)[-len(segment) :]) if len(segment) else begin
    first, last = segment[begin], segment[end]
    parts = sections(cut, owner[first], starts[first], low[begin], starts[last], high[end], page_from_world)
    whole = np.ones(len(paths), dtype=np.bool_)
    whole[touched] = False
    source = np.concatenate([np.flatnonzero(whole), touched[owner[first]]])
    return chosen(concatenated((chosen(paths, whole), parts)), np.argsort(source, kind="stable"))


def outside_others(lines: Floats, own: Ints, boxes: Floats, owner: Ints) -> tuple[Floats, Ints]:
    """The parts (m,2,2) of straight lines (k,2,2) outside of the rectangles (b,4,2) of other owners, and the line (m,)
    each is of; own (k,), owner (b,): whose they are."""
    segment, box = near_boxes(lines[:, 0], lines[:, 1], boxes)
    low, high = inside_box(lines[segment, 0], lines[segment, 1], boxes[box])
    hit = (low < high) & (own[segment] != owner[box])
    fine = np.full(len(lines), UNION_OF_SEGMENT)
    covered = intervals.union(segment[hit], low[hit], high[hit], fine)
    line, low, high = intervals.complement(len(lines), *covered, fine)
    part = np.stack([low, high], axis=1)[:, :, None]
    return (1.0 - part) * lines[line, :1] + part * lines[line, 1:], line


def near_boxes(start: Floats, end: Floats, boxes: Floats) -> tuple[Ints, Ints]:
    """Pairs of a segment, from start to end (s,2), and one of the rectangles (b,4,2) whose bounds overlap."""
    import shapely

    low, high = boxes.min(axis=1), boxes.max(axis=1)
    left, right = np.minimum(start, end), np.maximum(start, end)
    reach = ((left <= high.max(axis=0, initial=-np.inf)) & (right >= low.min(axis=0, initial=np.inf))).all(axis=1)
    some = np.flatnonzero(reach)
    tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    segment, box = tree.query(shapely.box(left[some, 0], left[some, 1], right[some, 0], right[some, 1]))
    return some[segment], np.asarray(box)


def inside_box(start: Floats, end: Floats, boxes: Floats) -> tuple[Floats, Floats]:
    """(n,) and (n,) between which parameters each segment, from start to end (n,2), is inside of its rectangle (n,4,2);
    low >= high: nowhere."""
    along = np.roll(boxes, -1, axis=1) - boxes
    inward = np.stack([-along[:, :, 1], along[:, :, 0]], axis=2)
    first, last = (((point[:, None] - boxes) * inward).sum(axis=2) for point in (start, end))
    run = last - first
    at = -first / np.where(run != 0.0, run, 1.0)
    low = np.where(run > 0.0, at, np.where((run == 0.0) & (first <= 0.0), np.inf, -np.inf)).max(axis=1, initial=0.0)
    high = np.where(run < 0.0, at, np.inf).min(axis=1, initial=1.0)
    return low, high


def _touched(paths: Paths, boxes: Floats) -> Ints:
    """The strokes whose bounds overlap those of a rectangle."""
    filled = np.flatnonzero(np.diff(paths.offsets) > 0)
    if not len(filled) or not len(boxes):
        return np.zeros(0, dtype=np.intp)
    first = paths.offsets[filled]
    low, high = np.minimum.reduceat(paths.points, first), np.maximum.reduceat(paths.points, first)
    return filled[np.unique(near_boxes(low, high, boxes)[0])]
