"""How far two curves are apart, as sets of points: the Hausdorff distance of polylines in the plane or in space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import dot, norm
from vectorplot.testing.curve_points import Curves, points_of, polylines_of
from vectorplot.tolerances.of_extent import DISTANCE_ACCURACY

PAIRS = 1 << 20

NEAR = 0.75
"""Part of a distance that is not looked into within which a segment is taken that is near but not the nearest: the rest
is for the lengths of pieces, which are halved until they are as short."""


class Worst(NamedTuple):
    """The point of one curve that is furthest from the other one: its distance, the point, the polyline and the
    parameter it has there (index of a segment and share of it), and which of the two it lies on."""

    distance: float
    point: Floats
    curve: int
    parameter: float
    which: str


def hausdorff(a: Curves, b: Curves, *, closed: bool = False, accuracy: float | None = None) -> float:
    """The Hausdorff distance of two curves: how far the points of either can be from the other one.

    Parameters
    ----------
    a, b : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3), or several of them, as sets of segments; of a drawing those in the world.
    closed : bool
        Both close even where the last point does not repeat the first.
    accuracy : float, optional
        By how much the result may be too small; 1e-9 of the extent of both where None.

    Returns
    -------
    float
        The same for both orders, directions and any splitting.

    Raises
    ------
    AssertionError
        For curves without points or with points that are not finite.
    InputError
        For what is no curve, and for one in the plane and one in space.

    Notes
    -----
    Error: the true distance is larger by no more than the accuracy, and not smaller but for rounding.

    Degenerate: a single point is a curve too.

    Examples
    --------
    >>> from vectorplot.testing import hausdorff
    >>> hausdorff([(0, 0), (4, 0)], [(0, 0), (2, 1), (4, 0)])
    1.0
    """
    return worst_of_both(a, b, closed=closed, accuracy=accuracy).distance


def worst_of_both(
    a: Curves, b: Curves, *, closed: bool = False, accuracy: float | None = None, enough: float = 0.0
) -> Worst:
    """The point of two curves that is furthest from the other one, see hausdorff; of distances that are not larger
    than enough, any."""
    first, second = Segments.of(a, closed), Segments.of(b, closed)
    if first.ends.shape[2] != second.ends.shape[2]:
        raise InputError("one curve lies in the plane, the other in space")
    corners = np.concatenate([first.ends, second.ends]).reshape(-1, first.ends.shape[2])
    middle, extent = corners.mean(axis=0), float(norm(np.ptp(corners, axis=0)))
    # Below the rounding of the coordinates nothing can be told.
    rounding = 16.0 * float(np.spacing(np.abs(corners).max()))
    fine = max(DISTANCE_ACCURACY * extent if accuracy is None else accuracy, rounding)
    first, second = first.moved(-middle), second.moved(-middle)
    there = furthest(first, second, fine, enough, "first")
    back = furthest(second, first, fine, max(enough, there.distance), "second")
    worst = max(there, back, key=lambda found: found.distance)
    return worst._replace(point=worst.point + middle)


@dataclass(frozen=True, eq=False)
class Segments:
    """ends (n,2,d) of segments; curve (n,) and index (n,) of each: its polyline, and its place there."""

    ends: Floats
    curve: Ints
    index: Ints

    @classmethod
    def of(cls, curves: Curves, closed: bool) -> Segments:
        """The segments of curves; a polyline of one point is a segment without length."""
        parts = polylines_of(curves)
        if closed:
            parts = [np.concatenate([part, part[:1]]) for part in parts]
        parts = [np.repeat(part, 2, axis=0) if len(part) == 1 else part for part in parts]
        found = points_of(parts)
        start = np.flatnonzero(found.curve[:-1] == found.curve[1:])
        return cls(np.stack([found.points[start], found.points[start + 1]], axis=1), found.curve[start], start)._own()

    def _own(self) -> Segments:
        """The same, the index counted from the start of each polyline."""
        first = np.searchsorted(self.curve, self.curve)
        return Segments(self.ends, self.curve, self.index - self.index[first])

    def moved(self, by: Floats) -> Segments:
        """The same segments, moved."""
        return Segments(self.ends + by, self.curve, self.index)


class Tree:
    """Segments in short pieces, for the nearest segment to a point."""

    def __init__(self, ends: Floats) -> None:
        from scipy.spatial import cKDTree

        long = norm(ends[:, 1] - ends[:, 0])
        piece = float(long.sum()) / max(len(ends), 64)
        count = np.maximum(np.ceil(long / piece), 1.0).astype(np.intp) if piece > 0.0 else np.ones(len(ends), np.intp)
        self.owner = ragged.owner(count)
        place = np.arange(len(self.owner)) - ragged.starts(count)[self.owner]
        share = ((place + 0.5) / count[self.owner])[:, None]
        self.ends = ends
        self.half = 0.5 * float((long / count).max())
        self.tree: Any = cKDTree(ends[self.owner, 0] * (1.0 - share) + ends[self.owner, 1] * share)

    def nearest(self, points: Floats, floor: float, tried: Sequence[Ints] = ()) -> tuple[Floats, Ints]:
        """(n,) distance of points from the nearest segment, and its index; where the distance from some segment is no
        larger than floor, that one may do. tried: segments (n,) that are looked at first and may do where they are
        nearer still."""
        distance, segment = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.intp)
        for by in tried:
            far = to_segments(points, self.ends[by])
            segment, distance = np.where(far < distance, by, segment), np.minimum(far, distance)
        left, count = np.flatnonzero(distance > NEAR * floor), 2
        while len(left):
            count = min(count, len(self.owner))
            sure = np.zeros(len(left), dtype=np.bool_)
            chunk = max(PAIRS // count, 1)
            for first in range(0, len(left), chunk):
                rows = left[first : first + chunk]
                middles, piece = self.tree.query(points[rows], k=np.arange(1, count + 1))
                candidates = self.owner[piece]
                far = to_segments(points[rows][:, None], self.ends[candidates])
                best = np.argmin(far, axis=1)
                each = np.arange(len(rows))
                distance[rows], segment[rows] = far[each, best], candidates[each, best]
                # Any segment not asked for has its nearest piece's middle at least as far away as the last one's.
                reached = distance[rows] <= np.maximum(middles[:, -1] - self.half, floor)
                sure[first : first + chunk] = reached
            if count == len(self.owner):
                break
            left, count = left[~sure], 4 * count
        return distance, segment


def to_segments(points: Floats, ends: Floats) -> Floats:
    """(...,) distances of points (..., d) from segments (..., 2, d)."""
    start, way = ends[..., 0, :], ends[..., 1, :] - ends[..., 0, :]
    arm = points - start
    square = dot(way, way)
    share = np.clip(dot(arm, way) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.asarray(norm(arm - share[..., None] * way))


def furthest(segments: Segments, others: Segments, accuracy: float, enough: float, which: str) -> Worst:
    """The point of segments that is furthest from others, its distance right to accuracy; or any within enough.

    Pieces are halved while the distance might exceed the largest found so far. It cannot exceed what is reached from
    the ends at the piece's own length; nor, since the distance from one segment is convex along another, the larger of
    the two ends' distances from any one segment.
    """
    tree = Tree(others.ends)
    best = Worst(0.0, segments.ends[0, 0], int(segments.curve[0]), 0.0, which)

    def looked(owner: Ints, share: Floats, seen: Worst, tried: Sequence[Ints] = ()) -> tuple[Seen, Worst]:
        points = _along(segments.ends[owner], share)
        # Half the accuracy is for distances that are not looked into, half for pieces that are not halved.
        floor = max(seen.distance + 0.5 * accuracy, enough)
        distance, by = tree.nearest(points, floor, tried)
        k = int(np.argmax(distance))
        if distance[k] > floor:
            s = owner[k]
            parameter = float(segments.index[s] + share[k])
            seen = Worst(float(distance[k]), points[k], int(segments.curve[s]), parameter, which)
        return Seen(share, points, distance, by), seen

    owner = np.arange(len(segments.ends))
    # A few true distances first spare the others: those that are smaller need not be known exactly.
    few = owner[:: max(len(owner) // 64, 1)]
    best = looked(few, np.zeros(len(few)), best)[1]
    low, best = looked(owner, np.zeros(len(owner)), best)
    # Most segments end where the next one begins.
    follows = (segments.ends[:-1, 1] == segments.ends[1:, 0]).all(axis=1)
    last = np.append(np.flatnonzero(~follows), len(owner) - 1)
    ends, best = looked(last, np.ones(len(last)), best)
    high = low.rows(np.minimum(owner + 1, len(owner) - 1))
    for all_, own in zip(high[1:], ends[1:], strict=True):
        all_[last] = own
    high = high._replace(share=np.ones(len(owner)))
    while len(owner):
        middle, best = looked(owner, 0.5 * (low.share + high.share), best, (low.by, high.by))
        open_ = _beyond(max(best.distance + accuracy, enough), others.ends, low, middle, high)
        low, middle, high = low.rows(open_), middle.rows(open_), high.rows(open_)
        owner = np.tile(owner[open_], 2)
        low, high = low.and_(middle), middle.and_(high)
    return best


class Seen(NamedTuple):
    """Points (n,d) at shares of segments, their distances from other segments, and the index of one of these that is
    as near."""

    share: Floats
    points: Floats
    distance: Floats
    by: Ints

    def rows(self, kept: Ints) -> Seen:
        """Some of them."""
        return Seen(self.share[kept], self.points[kept], self.distance[kept], self.by[kept])

    def and_(self, more: Seen) -> Seen:
        """These, and more."""
        return Seen(*(np.concatenate(pair) for pair in zip(self, more, strict=True)))


def _beyond(limit: float, others: Floats, low: Seen, middle: Seen, high: Seen) -> Ints:
    """Which pieces from low to high may be farther away than the limit, by all that is known of them."""
    found = np.flatnonzero(0.5 * (low.distance + high.distance + norm(high.points - low.points)) > limit)
    for by in (low.by, middle.by, high.by):
        one = others[by[found]]
        far = np.maximum(to_segments(low.points[found], one), to_segments(high.points[found], one))
        found = found[far > limit]
    return found


def _along(ends: Floats, share: Floats) -> Floats:
    return np.asarray(ends[:, 0] * (1.0 - share[:, None]) + ends[:, 1] * share[:, None])
