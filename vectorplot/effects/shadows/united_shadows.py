"""Shadows that overlap, united once for all that is made of them."""

from __future__ import annotations

import numpy as np

from vectorplot.effects.decals.face_frames import FaceFrames
from vectorplot.effects.shadows.shadow_grades import Shadows, joined_shadows
from vectorplot.geometry import ragged
from vectorplot.geometry.regions import corners_of, polygons_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View


def united_shadows(view: View, shadows: Shadows) -> Shadows:
    """Shadows of single lights, those for want of one light on a face as one region, cut into simple polygons where it
    has holes.

    Shadows of whole faces, those alone on theirs, and those that reach behind the near plane stay as they are; regions
    move by less than a few tolerances. Degenerate: regions narrower than a few tolerances are left out.
    """
    if not len(shadows):
        return shadows
    near = np.minimum.reduceat(view.depth_of(shadows.points), shadows.offsets[:-1]) <= view.near
    which = np.flatnonzero(~shadows.whole & ~near)
    rows = np.stack([shadows.face, shadows.lacking], axis=1)[which]
    _, group, count = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
    which = which[count[group.ravel()] > 1]
    if not len(which):
        return shadows
    many = shadows.some(which)
    rows = np.stack([many.face, many.lacking], axis=1)
    _, leader, group = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    frames = FaceFrames.of(view, many.face)
    flat = frames.flat(many.points, ragged.owner(np.diff(many.offsets)))
    regions = unions(polygons_of(flat, many.offsets), group.ravel(), view.tolerance)
    parts, of = without_holes(*without_splinters(regions, view.tolerance))
    flat, offsets = corners_of(parts)
    first = leader[of]
    points = frames.lifted(flat, np.repeat(first, np.diff(offsets)))
    united = Shadows(points, offsets, many.face[first], many.lacking[first], many.whole[first])
    rest = np.ones(len(shadows), dtype=np.bool_)
    rest[which] = False
    return joined_shadows([shadows.some(np.flatnonzero(rest)), united])
