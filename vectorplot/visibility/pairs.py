"""One segment against one convex occluder, for many pairs at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.occluders import Occluders
from vectorplot.visibility.projected_faces import cross


@dataclass(frozen=True, eq=False)
class Segments:
    """Straight segments in the view's coordinates: start and end (3,n), all of them beyond the near plane."""

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
    view: View, segments: Segments, occluders: Occluders, segment: Ints, occluder: Ints, low: Floats, high: Floats
) -> Hits:
    """What occluders hide of segments between the parameters low and high, pair by pair.

    The points that a convex thing hides, itself included, form a convex set, so a zone is one interval: the segment
    clipped by the occluder's planes, those towards the eye first. A distance below the view's tolerance is zero, and
    zero does not hide; where a segment lies in a plane of the outline, only the shadow's side counts.
    Source: Glaeser, section 7.2; errata G7-01 and G7-02.
    """
    pair, reach = _behind_first_plane(view, segments, occluders, segment, occluder)
    low, high, side = low[pair], high[pair], np.zeros(len(pair), dtype=np.intp)
    ends = np.concatenate([segments.start[:, segment[pair]], segments.end[:, segment[pair]]])
    first, behind = occluders.first[occluder[pair]], occluders.behind[occluder[pair]]
    count = occluders.first[occluder[pair] + 1] - first
    for step in range(int(count.max(initial=0))):
        if step:
            plane = first + np.minimum(step, count - 1)
            reach = _heights(view, occluders, plane, ends)
        at_start, at_end = reach
        inside = (at_start > 0.0) | (at_end > 0.0)
        along = np.flatnonzero((at_start == 0.0) & (at_end == 0.0) & (step >= behind) & (step < count))
        if len(along):
            inward = occluders.planes[:3, first[along] + np.minimum(step, count[along] - 1)]
            new = _shadow_side(view, ends[:3, along], ends[3:, along], inward)
            inside[along] = (side[along] == 0) | (side[along] == new)
            side[along] = new
        crossing = np.flatnonzero(at_start * at_end < 0.0)
        if len(crossing):
            where = at_start[crossing] / (at_start[crossing] - at_end[crossing])
            leaving = at_start[crossing] > 0.0
            low[crossing] = np.where(leaving, low[crossing], np.maximum(low[crossing], where))
            high[crossing] = np.where(leaving, np.minimum(high[crossing], where), high[crossing])
        inside |= step >= count
        inside &= low < high
        if not inside.all():
            kept = np.flatnonzero(inside)
            pair, side, low, high, ends = pair[kept], side[kept], low[kept], high[kept], ends[:, kept]
            first, count, behind = first[kept], count[kept], behind[kept]
        if not len(pair):
            break
    return Hits(pair, low, high, side)


def _behind_first_plane(
    view: View, segments: Segments, occluders: Occluders, segment: Ints, occluder: Ints
) -> tuple[Ints, tuple[Floats, Floats]]:
    """The pairs of which the segment reaches behind the occluder's first plane, and both ends' distances from it.

    Most pairs of a mesh end here: the faces around a line do not hide it.
    """
    a, b, c, d = (row[occluders.first[occluder]] for row in occluders.planes)
    x, y, z = segments.start
    at_start = a * x[segment] + b * y[segment] + c * z[segment] - d
    x, y, z = segments.end
    at_end = a * x[segment] + b * y[segment] + c * z[segment] - d
    pair = np.flatnonzero(np.maximum(at_start, at_end) > view.tolerance)
    return pair, (_snapped(at_start[pair], view.tolerance), _snapped(at_end[pair], view.tolerance))


def _heights(view: View, occluders: Occluders, plane: Ints, ends: Floats) -> tuple[Floats, Floats]:
    """Distances of both ends (6,n) of segments from planes, snapped to zero."""
    a, b, c, d = (row[plane] for row in occluders.planes)
    at_start = a * ends[0] + b * ends[1] + c * ends[2] - d
    at_end = a * ends[3] + b * ends[4] + c * ends[5] - d
    return _snapped(at_start, view.tolerance), _snapped(at_end, view.tolerance)


def _snapped(distance: Floats, tolerance: float) -> Floats:
    distance[np.abs(distance) <= tolerance] = 0.0
    return distance


def _shadow_side(view: View, start: Floats, end: Floats, inward: Floats) -> Ints:
    """(n,) 1 where the inward normals (3,n) point to the left of start -> end in the image, else -1."""
    along = end - start
    if view.eye is None:
        left = np.stack([-along[1], along[0], np.zeros(along.shape[1])])
    else:
        left = cross(along, start - view.eye[:, None])
    return np.where((left * inward).sum(axis=0) > 0.0, 1, -1)
