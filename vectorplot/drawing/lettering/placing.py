"""Where labels stand beside what they name: apart from lines and from each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.lettering.stroke_lengths import StrokeLengths

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

CROSSED, FAR, INWARD, MOVED, TAKEN, OFF_PAGE = 2.0, 2.0, 0.5, 0.3, 100.0, 1000.0
"""What counts against a place: strokes in it, for each height of a capital of their length; every ring; that it lies
towards the middle of the picture; that it was moved onto the page; another label, its point or the own one there; that
it leaves the page."""

PREFERRED = 0.02
"""What counts against each place more than against the one before it in the order of directions: so there are no
ties."""


CELL = 0.5
"""The sides of cells that tell how many strokes are in a place, in heights of capitals of the smallest labels."""

AT_ONCE = 4
"""So many places are looked at closely at once."""


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
    fixed = np.array([word != "auto" for word in asked], dtype=np.bool_)
    middles = np.where(fixed[label, None], every[:, :2], _onto(page, every[:, :2], sizes[label], gap[label]))
    moved = (middles != every[:, :2]).any(axis=1)
    boxes = np.stack([middles - 0.5 * sizes[label], middles + 0.5 * sizes[label]], axis=1)
    lengths = StrokeLengths.of(start, end, CELL * float(height.min(initial=np.inf)) if len(height) else 1.0)
    weight = CROSSED / height[label]
    against = weight * lengths.at_least(boxes) + FAR * every[:, 2]
    against += OFF_PAGE * ((boxes[:, 0] < page[0]) | (boxes[:, 1] > page[1])).any(axis=1)
    against += INWARD * _inward(middles, anchors[label], middle)
    own = ((boxes[:, 0] < anchors[label]) & (boxes[:, 1] > anchors[label])).all(axis=1)
    against += moved * (MOVED + TAKEN * own)
    # The points of other labels are not covered.
    against += TAKEN * _covered(boxes, anchors, label)
    first = np.concatenate([[0], np.cumsum(counts)])
    chosen = np.zeros(len(tried), dtype=np.intp)
    count, occupied = len(taken), np.concatenate([taken, np.zeros((len(tried), 2, 2))])
    # Labels that were told where to stand come first.
    for number in np.argsort(~fixed, kind="stable").tolist():
        mine = slice(int(first[number]), int(first[number + 1]))
        cost = against[mine] + PREFERRED * np.arange(counts[number])
        cost = cost + TAKEN * _overlapping(boxes[mine], occupied[:count])
        chosen[number] = first[number] + _cheapest(cost, weight[mine], lengths, boxes[mine])
        occupied[count] = boxes[chosen[number]]
        count += 1
    far = np.flatnonzero(every[chosen, 2] > 0.0)
    feet = np.clip(anchors[far], boxes[chosen[far], 0], boxes[chosen[far], 1])
    return Places(middles[chosen], np.stack([anchors[far], feet], axis=1), far.tolist())


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


def _onto(page: Floats, middles: Floats, sizes: Floats, gap: Floats) -> Floats:
    """(c,2) middles of boxes, moved so that these are a gap away from the edges of the page; as they are across or
    upwards where it has no room for them."""
    low, high = page[0] + 0.5 * sizes + gap[:, None], page[1] - 0.5 * sizes - gap[:, None]
    return np.where(low <= high, np.clip(middles, low, np.maximum(low, high)), middles)


def _beside(way: Floats, size: Floats, gap: float) -> Floats:
    """(c,2) from a point to the middle of a box that lies beside it in directions (c,2), a gap between."""
    long = np.maximum(np.hypot(*way.T), 1.0)[:, None]
    sign = np.where(np.abs(way) > 0.5, np.sign(way), way)
    return np.asarray(0.5 * size * sign + gap * way / long)


def _cheapest(cost: Floats, weight: Floats, lengths: StrokeLengths, boxes: Floats) -> int:
    """Which box costs least, where weights times the lengths of the strokes in them count; cost has those lengths only
    as far as they are known without looking at single strokes. So few boxes need that."""
    cost, exact = cost.copy(), np.zeros(len(cost), dtype=np.bool_)
    while not exact[np.argmin(cost)]:
        some = np.argsort(np.where(exact, np.inf, cost), kind="stable")[: min(AT_ONCE, int((~exact).sum()))]
        box = boxes[some]
        cost[some] += weight[some] * (lengths.inside(box) - lengths.at_least(box))
        exact[some] = True
    return int(np.argmin(cost))


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


def _overlapping(boxes: Floats, others: Floats) -> Ints:
    """(c,) how many of others (n,2,2) each of boxes (c,2,2) overlaps."""
    (left, bottom), (right, top) = boxes[:, 0].T[:, :, None], boxes[:, 1].T[:, :, None]
    over = (left < others[:, 1, 0]) & (right > others[:, 0, 0]) & (bottom < others[:, 1, 1]) & (top > others[:, 0, 1])
    return np.asarray(over.sum(axis=1))
