"""Shaded polygons cut so small that shading between their corners shows what the light does."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.shading.painted_colours import Lighting, corner_shades_of, smooth_faces
from vectorplot.shading.screen import fans
from vectorplot.visibility.painter.image_faces import corner_positions, unmapped

SHADE_ERROR = 2.0 / 255.0
"""By how much of a palette shades in the middle of sides may be off."""

SHORTEST_MM = 1.0
"""Sides of shaded polygons on the page that are no longer are not cut any more."""

DEEPEST = 8
"""So many times triangles are cut in four at most."""


def refined(
    view: View, lighting: Lighting, points: Floats, offsets: Ints, source: Ints, shortest: float
) -> tuple[Floats, Ints, Ints]:
    """Convex polygons with triangles in place of those on which linear shading would be off by more than SHADE_ERROR:
    points (3,c) of the image, offsets (m+1,), and parent (m,), ascending, the polygon that each is a part of.

    points, offsets (n+1,) and source (n,) as of ImageFaces; sides in the image that are shorter than shortest are not
    cut any more. Polygons with one shade stay as they are.
    """
    smooth = np.flatnonzero(smooth_faces(view, lighting.normals)[source])
    position, ends = corner_positions(offsets, smooth)
    corners, of = fans(position, ends)
    triangles, parent = points[:, corners].transpose(1, 2, 0), smooth[of]
    bad = _badly_shaded(view, lighting, triangles, source[parent], shortest)
    cut = np.zeros(len(source), dtype=np.bool_)
    cut[parent[bad]] = True
    if not bad.any():
        return points, offsets, np.arange(len(source))
    inside = cut[parent]
    triangles, parent, bad = triangles[inside], parent[inside], bad[inside]
    done, done_parent = [triangles[~bad]], [parent[~bad]]
    for _ in range(DEEPEST):
        triangles, parent = _quartered(triangles[bad]), np.repeat(parent[bad], 4)
        bad = _badly_shaded(view, lighting, triangles, source[parent], shortest)
        done.append(triangles[~bad])
        done_parent.append(parent[~bad])
        if not bad.any():
            break
    done.append(triangles[bad])
    done_parent.append(parent[bad])
    made, of_made = np.concatenate(done), np.concatenate(done_parent)
    kept = np.flatnonzero(~cut)
    position, ends = corner_positions(offsets, kept)
    every = np.concatenate([points[:, position], made.reshape(-1, 3).T], axis=1)
    starts = np.concatenate([ends, ends[-1] + 3 * np.arange(1, len(made) + 1)])
    number = np.concatenate([kept, of_made])
    order = np.argsort(number, kind="stable")
    position, starts = corner_positions(starts, order)
    return every[:, position], starts, number[order]


def _badly_shaded(view: View, lighting: Lighting, triangles: Floats, source: Ints, shortest: float) -> Bools:
    """(t,) which of triangles (t,3,3) of the image have a side that is long enough, and in the middle of which the
    shade is not that between its ends."""
    if not len(triangles):
        return np.zeros(0, dtype=np.bool_)
    after = triangles[:, [1, 2, 0]]
    both = np.concatenate([triangles, (triangles + after) / 2.0], axis=1)
    flat = unmapped(view, np.ascontiguousarray(both.reshape(-1, 3).T))
    total = corner_shades_of(view, lighting, flat, np.arange(0, 6 * len(triangles) + 1, 6), source).total
    shade = np.atleast_2d(total).reshape(-1, len(triangles), 6)
    ends, middles = shade[..., :3], shade[..., 3:]
    off = np.abs(middles - (ends + ends[..., [1, 2, 0]]) / 2.0).max(axis=0)
    length = np.hypot(*(after - triangles)[..., :2].transpose(2, 0, 1))
    return np.asarray(((off > SHADE_ERROR) & (length > shortest)).any(axis=1))


def _quartered(triangles: Floats) -> Floats:
    """(4 t,3,3) the quarters of triangles (t,3,3)."""
    a, b, c = (triangles[:, k] for k in range(3))
    ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
    parts = [np.stack(part, axis=1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.stack(parts, axis=1).reshape(-1, 3, 3)
