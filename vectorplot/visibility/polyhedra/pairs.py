"""One segment against one convex occluder, for many pairs at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.columns import cross
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.occluders import Occluders

FULL = 0.75
"""Pairs that are done with are taken out when they are more than the rest of this part."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Straight segments in the view's coordinates, all of them beyond the near plane.

    Parameters
    ----------
    start, end : (3, n) array of float
        Their ends, such as points_of of a view gives them.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> len(visibility.Segments(start=np.zeros((3, 4)), end=np.ones((3, 4))))
    4
    """

    start: Floats
    end: Floats

    def __len__(self) -> int:
        return int(self.start.shape[1])


@dataclass(frozen=True, eq=False)
class Hits:
    """Hidden zones of single pairs: pair (h,) which one, low and high (h,) parameters, and side (h,): 0, or where the
    segment runs along a border of the occluder's shadow, 1 with the shadow on its left, -1 on its right."""

    pair: Ints
    low: Floats
    high: Floats
    side: Ints


def clip_pairs(
    view: View,
    segments: Segments,
    occluders: Occluders,
    segment: Ints,
    occluder: Ints,
    low: Floats,
    high: Floats,
    beyond: Bools,
) -> Hits:
    """What occluders hide of segments between the parameters low and high, pair by pair.

    The points that a convex thing hides, itself included, form a convex set, so a zone is one interval: the segment
    clipped by the occluder's planes, those towards the eye first; beyond (n,) tells the pairs that need not be
    clipped by these, since the part lies behind all of the occluder. A distance below the view's tolerance is zero,
    and zero does not hide; where a segment lies in a plane of the outline, only the shadow's side counts.
    Source: Glaeser, section 7.2; errata G7-01 and G7-02.
    """
    skipped = occluders.behind.take(occluder) * beyond
    pair, reach = _over_first_plane(
        view, segments, occluders, segment, occluders.first.take(occluder) + skipped, beyond
    )
    low, high, side = low.take(pair), high.take(pair), np.zeros(len(pair), dtype=np.intp)
    of = segment.take(pair)
    ends = np.concatenate([segments.start.take(of, axis=1), segments.end.take(of, axis=1)])
    occluder, skipped = occluder.take(pair), skipped.take(pair)
    first, behind = occluders.first.take(occluder) + skipped, occluders.behind.take(occluder) - skipped
    count = occluders.first.take(occluder + 1) - first
    through = [(pair[:0], low[:0], high[:0], side[:0])]
    final = occluders.planes.shape[1] - 1
    for step in range(int(count.max(initial=0))):
        if step:
            reach = _heights(view, occluders, np.minimum(first + step, final), ends)
        at_start, at_end = reach
        product = at_start * at_end
        inside = np.maximum(at_start, at_end) > 0.0
        along = np.flatnonzero((product == 0.0) & (at_start == at_end) & (step >= behind))
        if len(along):
            inward = occluders.planes[:3].take(np.minimum(first[along] + step, final), axis=1)
            new = _shadow_side(view, ends[:3].take(along, axis=1), ends[3:].take(along, axis=1), inward)
            inside[along] = (side[along] == 0) | (side[along] == new)
            side[along] = new
        crossing = np.flatnonzero(product < 0.0)
        if len(crossing):
            begin, end = at_start.take(crossing), at_end.take(crossing)
            where, leaving = begin / (begin - end), begin > 0.0
            out, into = crossing.compress(leaving), crossing.compress(~leaving)
            high[out] = np.minimum(high.take(out), where.compress(leaving))
            low[into] = np.maximum(low.take(into), where.compress(~leaving))
        inside &= low < high
        last = inside & (count == step + 1)
        if last.any():
            done = np.flatnonzero(last)
            through.append((pair.take(done), low.take(done), high.take(done), side.take(done)))
            inside &= ~last
        if np.count_nonzero(inside) > FULL * len(inside):
            # Few are done with: they stay, marked by an empty interval, since moving the others costs more.
            np.putmask(high, ~inside, -1.0)
        else:
            kept = np.flatnonzero(inside)
            ends = ends.take(kept, axis=1)
            low, high = low.take(kept), high.take(kept)
            pair, side, first, count, behind = (of.take(kept) for of in (pair, side, first, count, behind))
    pair, low, high, side = (np.concatenate(column) for column in zip(*through, strict=True))
    return Hits(pair, low, high, side)


def _over_first_plane(
    view: View, segments: Segments, occluders: Occluders, segment: Ints, plane: Ints, beyond: Bools
) -> tuple[Ints, tuple[Floats, Floats]]:
    """The pairs of which the segment reaches over the first plane that is looked at, and both ends' distances from it.

    Most pairs of a mesh end here: the faces around a line do not hide it. A line in a plane of the outline stays.
    """
    a, b, c, d = (row.take(plane) for row in occluders.planes)
    x, y, z = (row.take(segment) for row in segments.start)
    at_start = a * x + b * y + c * z - d
    x, y, z = (row.take(segment) for row in segments.end)
    at_end = a * x + b * y + c * z - d
    least = np.where(beyond, -view.tolerance, view.tolerance)
    pair = np.flatnonzero(np.maximum(at_start, at_end) > least)
    return pair, (_snapped(at_start.take(pair), view.tolerance), _snapped(at_end.take(pair), view.tolerance))


def _heights(view: View, occluders: Occluders, plane: Ints, ends: Floats) -> tuple[Floats, Floats]:
    """Distances of both ends (6,n) of segments from planes, snapped to zero."""
    normals = occluders.planes.take(plane, axis=1)
    return _height(normals, ends[:3], view.tolerance), _height(normals, ends[3:], view.tolerance)


def _height(planes: Floats, points: Floats, tolerance: float) -> Floats:
    """Distances of points (3,n) from planes (4,n), snapped to zero."""
    height = planes[0] * points[0]
    term = planes[1] * points[1]
    height += term
    height += np.multiply(planes[2], points[2], out=term)
    height -= planes[3]
    return _snapped(height, tolerance)


def _snapped(distance: Floats, tolerance: float) -> Floats:
    distance *= np.abs(distance) > tolerance
    return distance


def _shadow_side(view: View, start: Floats, end: Floats, inward: Floats) -> Ints:
    """(n,) 1 where the inward normals (3,n) point to the left of start -> end in the image, else -1."""
    along = end - start
    if view.eye is None:
        left = np.stack([-along[1], along[0], np.zeros(along.shape[1])])
    else:
        left = cross(along, start - view.eye[:, None])
    return np.where((left * inward).sum(axis=0) > 0.0, 1, -1)
