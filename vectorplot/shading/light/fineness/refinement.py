"""Shaded polygons cut so small that shading between their corners shows what the light does."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.shading.light.painted_colours import Lighting, corner_shades_of, smooth_faces
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.visibility.painter.image_faces import view_points

SHADE_ERROR, USUAL_MM = 2.0 / 255.0, 0.02
"""By how much of a palette shades along sides may be off, where polygons may be off by so many mm."""

SHADE_LIMITS = (0.5, 4.0)
"""By how many times as much shades may be off at least, and at most."""

SHORTEST_MM = 1.0
"""Sides of shaded polygons on the page that are no longer are not cut any more."""

DEEPEST = 8
"""So many times sides are halved at most."""

BETWEEN = np.array([0.25, 0.5, 0.75]).reshape(-1, 1, 1)
"""Where on their sides shades of triangles are compared."""

PARTS = {
    1: ((0, 3, 2), (3, 1, 2)),
    2: ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    3: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
}
"""The corners of the parts of a triangle with 1, 2 or 3 halved sides, the first ones: of its own and of the middles of
its sides."""


def shade_error(tolerance_mm: float) -> float:
    """By how much of a palette shades along sides may be off in a picture whose polygons may be off by so many mm: in
    proportion, from half of SHADE_ERROR to four times as much."""
    low, high = SHADE_LIMITS
    return SHADE_ERROR * min(max(tolerance_mm / USUAL_MM, low), high)


def refined(
    view: View,
    lighting: Lighting,
    points: Floats,
    offsets: Ints,
    source: Ints,
    shortest: float,
    most: int,
    error: float = SHADE_ERROR,
) -> tuple[Floats, Ints, Ints]:
    """Convex polygons with triangles in place of those on which linear shading would be off by more than error: points
    (3,c) of the image, offsets (m+1,), and parent (m,), ascending, the polygon that each is a part of.

    points, offsets (n+1,) and source (n,) as of ImageFaces; sides in the image that are shorter than shortest are not
    cut any more. Polygons with one shade stay as they are. Where there would be more than most polygons the longest
    sides are cut, and no others.
    """
    smooth = np.flatnonzero(smooth_faces(view, lighting.normals)[source])
    position, ends = ragged.take(offsets, smooth)
    fans, of = ragged.fans(ends)
    triangles, parent = points[:, position[fans]].transpose(1, 2, 0), smooth[of]
    bad = _longest(_badly_shaded(view, lighting, triangles, source[parent], shortest, error), most - len(source))
    cut = np.zeros(len(source), dtype=np.bool_)
    cut[parent[bad.any(axis=1)]] = True
    if not cut.any():
        return points, offsets, np.arange(len(source))
    inside = cut[parent]
    triangles, parent, bad = triangles[inside], parent[inside], bad[inside]
    done, done_parent = [], []
    count = len(source) + len(triangles)
    for turn in range(DEEPEST + 1):
        going = bad.any(axis=1) & (turn < DEEPEST)
        done.append(triangles[~going])
        done_parent.append(parent[~going])
        if not going.any():
            break
        triangles, whole = _halved(triangles[going], bad[going])
        parent = parent[going][whole]
        count += int(bad[going].sum())
        bad = _longest(_badly_shaded(view, lighting, triangles, source[parent], shortest, error), most - count)
    made, of_made = np.concatenate(done), np.concatenate(done_parent)
    kept = np.flatnonzero(~cut)
    position, ends = ragged.take(offsets, kept)
    every = np.concatenate([points[:, position], made.reshape(-1, 3).T], axis=1)
    starts = np.concatenate([ends, ends[-1] + 3 * np.arange(1, len(made) + 1)])
    number = np.concatenate([kept, of_made])
    order = np.argsort(number, kind="stable")
    position, starts = ragged.take(starts, order)
    return every[:, position], starts, number[order]


def _badly_shaded(
    view: View, lighting: Lighting, triangles: Floats, source: Ints, shortest: float, error: float
) -> Floats:
    """(t,3) the lengths of the sides of triangles (t,3,3) of the image, by the corners at which they begin, on which
    the shade is off that between their ends by more than error; 0 for the others, and for those that are no longer than
    shortest."""
    after = triangles[:, [1, 2, 0]]
    length = np.hypot(*(after - triangles)[..., :2].transpose(2, 0, 1))
    length = np.where(length > shortest, length, 0.0)
    some = np.flatnonzero(length.any(axis=1))
    if not len(some):
        return length
    one, two = triangles[some], after[some]
    within = (one[:, None] * (1.0 - BETWEEN) + two[:, None] * BETWEEN).reshape(len(some), -1, 3)
    both = np.concatenate([one, within], axis=1)
    flat, count = view_points(view, np.ascontiguousarray(both.reshape(-1, 3).T)), both.shape[1]
    offsets = np.arange(0, count * len(some) + 1, count)
    shade = np.atleast_2d(corner_shades_of(view, lighting, flat, offsets, source[some]).total)
    shade = shade.reshape(-1, len(some), 1 + len(BETWEEN), 3)
    ends, share = shade[:, :, :1], BETWEEN[..., 0]
    off = np.abs(shade[:, :, 1:] - (1.0 - share) * ends - share * ends[..., [1, 2, 0]]).max(axis=(0, 2))
    length[some] = np.where(off > error, length[some], 0.0)
    return length


def _longest(length: Floats, count: int) -> Bools:
    """(t,3) which of some sides are the longest ones, no more than count and none of length 0: both triangles at a side
    are told the same."""
    found = length > 0.0
    if int(found.sum()) <= count:
        return np.asarray(found)
    if count <= 0:
        return np.zeros(length.shape, dtype=np.bool_)
    limit = np.partition(length.ravel(), -count - 1)[-count - 1]
    return np.asarray(length > limit * (1.0 + ROUNDING))


def _halved(triangles: Floats, sides: Bools) -> tuple[Floats, Ints]:
    """What triangles (t,3,3) are cut into where some of their sides (t,3) are halved, one or more of each, and which
    one each part is of: neighbours, which halve a common side both, still meet along all of their sides."""
    count = sides.sum(axis=1)
    # Turned so that one halved side comes first, and of two the second one second.
    turn = np.where(count == 2, (sides.argmin(axis=1) + 1) % 3, sides.argmax(axis=1))
    order = (turn[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles, order[..., None], axis=1)
    nodes = np.concatenate([corners, (corners + corners[:, [1, 2, 0]]) / 2.0], axis=1)
    found, owner = [], []
    for number, parts in PARTS.items():
        own = np.flatnonzero(count == number)
        found.append(nodes[own][:, np.array(parts)].reshape(-1, 3, 3))
        owner.append(np.repeat(own, len(parts)))
    return np.concatenate(found), np.concatenate(owner)
