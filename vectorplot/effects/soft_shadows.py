"""Soft borders of shadows, see lamps that are no points, and shadows that overlap, united."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, FaceFrames, joined_decals, no_decals
from vectorplot.effects.shadows import Shadows, joined_shadows
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.regions import corners_of, insides_of, polygons_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View
from vectorplot.shading.illumination import LEVELS
from vectorplot.visibility.painter.image_faces import image_faces, view_points

BEVEL = 1.0
"""Borders are cut off around corners of shadows so many times their width outside of them."""


def shadow_borders(view: View, single: Shadows, cells: Shadows, width: float) -> Decals:
    """Strips around shadows, as wide as the width in the image, painted before them: the narrower, the darker. single:
    shadows of single lights; cells: of all grades, see graded. Strips lie on what their light reaches, also on cells
    that lack others; all shadows of a light on a face share one border. lacking: lights wholly absent; light: the
    one partly present; grade: of the shadow beside; level: a multiple of LEVELS for what it lies on plus the step, 1
    outside to LEVELS - 1.
    Edge cases: none for width 0 and around wholly dark faces. Errors: InputError for a negative or infinite width.
    Source: Glaeser, section 6.3 (aura).
    """
    if not 0.0 <= width < np.inf:
        raise InputError(f"a border of width {width:g}: expected a number that is not negative")
    import shapely

    near = np.minimum.reduceat(view.depth_of(single.points), single.offsets[:-1]) <= view.near if len(single) else True
    single = single.take(np.flatnonzero(~single.whole & ~near))
    if width == 0.0 or not len(single):
        return no_decals()
    rows = np.stack([single.face, single.lacking], axis=1)
    kinds, group = np.unique(rows, axis=0, return_inverse=True)
    region = unions(polygons_of(view.image_of(single.points), single.offsets), group.ravel(), view.tolerance)
    ground = _lit_somewhere(view, single, cells)
    inside = insides_of(polygons_of(view.image_of(ground.points), ground.offsets))
    # Pairs of shadows and what is on the same faces.
    low, high = (np.searchsorted(kinds[:, 0], ground.face, side=side) for side in ("left", "right"))
    on, strip = ragged.owner(high - low), ragged.ranges(low, high - low)
    useful = ground.lacking[on] & kinds[strip, 1] == 0
    strip, on = strip[useful], on[useful]
    steps = np.arange(1, LEVELS)
    found = []
    for step in steps.tolist():
        reach = width * (LEVELS - step) / (LEVELS - 1)
        around = shapely.buffer(region, reach, join_style="mitre", mitre_limit=BEVEL)
        parts = shapely.intersection(around[strip], inside[on])
        found.append(_step(view, ground, parts, on, kinds[strip, 1], step))
    return joined_decals(*found)


def _step(view: View, ground: Shadows, region: Any, on: Ints, lacking: Ints, step: int) -> Decals:
    """The strips of one step: regions of the image on polygons of the ground, where the light in lacking gets in part;
    those of the first step are as wide as the border, and hardly dark."""
    parts, of = without_holes(*without_splinters(region, view.tolerance))
    flat, offsets = corners_of(parts)
    on, light = on[of], np.frexp(lacking[of])[1].astype(np.intp) - 1
    faces = image_faces(view, ground.face[on])
    # Faces that are seen edge-on have no image.
    there = np.flatnonzero(np.isin(ground.face[on], faces.source))
    position, offsets = ragged.take(offsets, there)
    on, light = on[there], light[there]
    _, first = np.unique(faces.source, return_index=True)
    number = first[np.searchsorted(faces.source[first], ground.face[on])]
    x, y = flat[:, position]
    height = faces.heights(np.repeat(number, np.diff(offsets)), x, y)
    return Decals(
        view_points(view, np.stack([x, y, height])),
        offsets,
        ground.face[on],
        np.full(len(on), int(FillKind.SHADOW_BORDER), dtype=np.intp),
        ground.grade[on] + 1,
        light,
        np.full(len(on), -1, dtype=np.intp),
        LEVELS * ground.grade[on] + step,
        lacking=ground.lacking[on],
    )


def _lit_somewhere(view: View, single: Shadows, cells: Shadows) -> Shadows:
    """The faces that shadows fall on, as polygons that lack no light, and the cells on them, before the near plane."""
    face = np.unique(single.face)
    position, offsets = ragged.take(view.offsets, face)
    bare = np.zeros(len(face), dtype=np.intp)
    faces = Shadows(view.points[:, view.corners[position]], offsets, face, bare, bare == 0)
    every = joined_shadows([faces, cells.take(np.flatnonzero(np.isin(cells.face, face)))])
    beyond = view.depth_of(every.points) - view.near
    if view.eye is None or not (beyond < 0.0).any():
        return every
    cut, _ = cut_polygons(Polygons(every.points.T, every.offsets), beyond)
    full = np.flatnonzero(np.diff(cut.offsets))
    offsets = np.append(cut.offsets[full], len(cut.points))
    left = every.take(full)
    return Shadows(np.ascontiguousarray(cut.points.T), offsets, left.face, left.lacking, left.whole)


# Shadows that overlap, united once for all that is made of them.


def united_shadows(view: View, shadows: Shadows) -> Shadows:
    """Shadows of single lights, those for want of one light on a face as one region, cut into simple polygons where it
    has holes.

    Shadows of whole faces, those alone on theirs, and those that reach behind the near plane stay as they are; regions
    move by less than a few tolerances. Edge cases: regions narrower than a few tolerances are left out.
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
    many = shadows.take(which)
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
    return joined_shadows([shadows.take(np.flatnonzero(rest)), united])
