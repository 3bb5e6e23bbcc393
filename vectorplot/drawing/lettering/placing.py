"""Where labels stand beside what they name: apart from lines and from each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.lettering.interrupted import inside_box, near_boxes

DIRECTIONS = {
    "right": (1.0, 0.0),
    "above_right": (1.0, 1.0),
    "above": (0.0, 1.0),
    "above_left": (-1.0, 1.0),
    "left": (-1.0, 0.0),
    "below_left": (-1.0, -1.0),
    "below": (0.0, -1.0),
    "below_right": (1.0, -1.0),
    "centre": (0.0, 0.0),
}
"""On which side of its point a label is, across and up."""

RINGS = (0.0, 1.2, 2.7, 4.7, 7.7)
"""How much farther than need be from its point a label is tried, in heights of capitals; at all but the first one it
has a leader."""

ON_A_RING = 16
"""Directions in which a label is tried on every ring but the first."""

CROSSED, FAR, INWARD, TAKEN, OFF_PAGE = 2.0, 2.0, 0.5, 100.0, 1000.0
"""What counts against a place: strokes in it, for each height of a capital of their length; every ring; that it lies
towards the middle of the picture; another label or its point there; that it leaves the page."""

PREFERRED = 0.02
"""What counts against each place more than against the one before it in the order of directions: so there are no
ties."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where labels are: middles (l,2) of their boxes; leaders (k,2,2) from a point to the letters that stand far off,
    and of which label (k,) each is."""

    middles: Floats
    leaders: Floats
    label: Sequence[int]


def places(
    anchors: Floats,
    sizes: Floats,
    height: Floats,
    gap: Floats,
    asked: Sequence[str],
    start: Floats,
    end: Floats,
    page: Floats,
    taken: Floats,
) -> Places:
    """Where labels stand: one after the other each is put where the least counts against it.

    anchors (l,2): what they name; sizes (l,2): width and height of their boxes; height (l,): of their capitals; gap
    (l,): from a point to the letters beside it; asked: the words of DIRECTIONS, or auto; start, end (s,2): the strokes
    of the picture; page (2,2): its corners; taken (b,2,2): boxes, smallest and largest coordinates, where no label is.
    All in mm.
    Source: Christensen, Marks and Shieber, An empirical study of algorithms for point-feature label placement, ACM
    Trans. Graphics 14 (1995): the greedy algorithm.
    """
    middle = (
        0.5 * (np.minimum(start, end).min(axis=0) + np.maximum(start, end).max(axis=0))
        if len(start)
        else 0.5 * page.sum(axis=0)
    )
    tried = [_tried(*row) for row in zip(anchors, sizes, height.tolist(), gap.tolist(), asked, strict=True)]
    counts = [len(one) for one in tried]
    every = np.concatenate([np.zeros((0, 3)), *tried])
    label = np.repeat(np.arange(len(tried)), counts)
    boxes = np.stack([every[:, :2] - 0.5 * sizes[label], every[:, :2] + 0.5 * sizes[label]], axis=1)
    against = CROSSED * _crossed(boxes, start, end) / height[label] + FAR * every[:, 2]
    against += OFF_PAGE * ((boxes[:, 0] < page[0]) | (boxes[:, 1] > page[1])).any(axis=1)
    against += INWARD * _inward(every[:, :2], anchors[label], middle)
    # The points of other labels are not covered.
    against += TAKEN * _covered(boxes, anchors, label)
    first = np.concatenate([[0], np.cumsum(counts)])
    chosen = np.zeros(len(tried), dtype=np.intp)
    occupied = taken
    # Labels that were told where to stand come first.
    fixed = np.array([word != "auto" for word in asked], dtype=np.bool_)
    for number in np.argsort(~fixed, kind="stable").tolist():
        mine = slice(int(first[number]), int(first[number + 1]))
        cost = against[mine] + PREFERRED * np.arange(counts[number])
        cost = cost + TAKEN * _overlapping(boxes[mine], occupied).sum(axis=1)
        chosen[number] = first[number] + int(np.argmin(cost))
        occupied = np.concatenate([occupied, boxes[chosen[number]][None]])
    far = np.flatnonzero(every[chosen, 2] > 0.0)
    feet = np.clip(anchors[far], boxes[chosen[far], 0], boxes[chosen[far], 1])
    return Places(every[chosen, :2], np.stack([anchors[far], feet], axis=1), far.tolist())


def _tried(anchor: Floats, size: Floats, height: float, gap: float, asked: str) -> Floats:
    """(c,3) middles of the boxes that are tried for a label, and the ring each is on."""
    if asked != "auto":
        way = np.array([DIRECTIONS[asked]])
        return np.column_stack([anchor + _beside(way, size, gap), np.zeros(1)])
    order = ("above_right", "above", "right", "above_left", "left", "below_right", "below", "below_left")
    found = []
    angle = np.arange(ON_A_RING) * (2.0 * np.pi / ON_A_RING) + np.pi / 4.0
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for ring, distance in enumerate(RINGS):
        way = circle if ring else np.array([DIRECTIONS[word] for word in order])
        middle = anchor + _beside(way, size, gap + distance * height)
        found.append(np.column_stack([middle, np.full(len(way), ring)]))
    return np.concatenate(found)


def _beside(way: Floats, size: Floats, gap: float) -> Floats:
    """(c,2) from a point to the middle of a box that lies beside it in directions (c,2), a gap between."""
    long = np.maximum(np.hypot(*way.T), 1.0)[:, None]
    sign = np.where(np.abs(way) > 0.5, np.sign(way), way)
    return np.asarray(0.5 * size * sign + gap * way / long)


def _crossed(boxes: Floats, start: Floats, end: Floats) -> Floats:
    """(c,) the length of strokes inside of boxes."""
    (low, high) = boxes[:, 0], boxes[:, 1]
    corners = np.stack([low, np.stack([high[:, 0], low[:, 1]], 1), high, np.stack([low[:, 0], high[:, 1]], 1)], axis=1)
    segment, box = near_boxes(start, end, corners)
    begin, stop = inside_box(start[segment], end[segment], corners[box])
    long = np.hypot(*(end - start)[segment].T) * np.maximum(stop - begin, 0.0)
    return np.asarray(np.bincount(box, long, minlength=len(boxes)), dtype=np.float64)


def _inward(middles: Floats, anchors: Floats, middle: Floats) -> Floats:
    """(c,) from 0 for what lies away from the middle of the picture to 1 for what lies towards it."""
    one, other = middles - anchors, middle - anchors
    long = np.hypot(*one.T) * np.hypot(*other.T)
    return np.asarray(0.5 + 0.5 * (one * other).sum(axis=1) / np.where(long > 0.0, long, 1.0))


def _covered(boxes: Floats, anchors: Floats, label: Ints) -> Floats:
    """(c,) how many points of other labels lie in the boxes (c,2,2) that are tried for labels (c,)."""
    import shapely

    tree = shapely.STRtree(shapely.points(anchors))
    box, point = tree.query(shapely.box(*boxes[:, 0].T, *boxes[:, 1].T))
    inside = ((anchors[point] > boxes[box, 0]) & (anchors[point] < boxes[box, 1])).all(axis=1)
    other = (anchors[point] != anchors[label[box]]).any(axis=1)
    return np.asarray(np.bincount(box[inside & other], minlength=len(boxes)), dtype=np.float64)


def _overlapping(boxes: Floats, others: Floats) -> Bools:
    """(c,n) which of boxes (c,2,2) and others (n,2,2) overlap."""
    low, high = others[None, :, 0], others[None, :, 1]
    return np.asarray(((boxes[:, None, 0] < high) & (boxes[:, None, 1] > low)).all(axis=2))
