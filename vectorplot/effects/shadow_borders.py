"""Soft borders of shadows: lamps that are no points make auras around them."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals
from vectorplot.effects.shadow_grades import Shadows, upright_planes
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats, Ints, next_positions
from vectorplot.geometry.plane_cuts import Parts, PlaneBundles, cut_by_planes, planes_of
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import corner_positions

STRAIGHT_SINE = 1e-3
"""A corner that turns by an angle with a smaller sine needs no bevel."""


def shadow_borders(view: View, shadows: Shadows, width: float) -> Decals:
    """Strips around shadows of every grade, in the image as wide as the width, to be painted before them.

    Each strip is a whole polygon, larger than its shadow, which is painted over it; it ends where its face does, and
    around a shadow of a higher grade where all but one of its lights shine. lacking: the lights that do not get there
    at all; light: the one that gets there in part; grade: that of the shadow.
    Errors: InputError for a width that is negative or not finite.
    Degenerate: no borders for width zero, and around faces that are dark as wholes.
    Source: Glaeser, section 6.3 (aura).
    """
    if not 0.0 <= width < np.inf:
        raise InputError(f"a border of width {width:g}: expected a number that is not negative")
    grade = shadows.grade
    found = []
    for k in range(1, int(grade.max(initial=0)) + 1 if width > 0.0 else 1):
        for left_out in range(k):
            found.append(_strips(view, shadows, np.flatnonzero((grade == k) & ~shadows.whole), k, left_out, width))
    return joined_decals(*found)


def _strips(view: View, shadows: Shadows, which: Ints, grade: int, left_out: int, width: float) -> Decals:
    """The strips of shadows of one grade towards one of the lights that they lack."""
    around = _widened(view, shadows, which, width)
    kept = np.flatnonzero(np.diff(around.first))
    light = shadows.parents[left_out, which]
    others = [shadows.parents[row, which] for row in range(grade) if row != left_out]
    if others:
        points, offsets = shadows.points, shadows.offsets
        parts = cut_by_planes(points, offsets, around, others[0][kept], kept, view.tolerance)
        borders = upright_planes(view, shadows)
        for other in others[1:]:
            parts = _again(view, parts, borders, other)
    else:
        position, offsets = corner_positions(view.offsets, shadows.face[which])
        points = view.points[:, view.corners[position]]
        parts = cut_by_planes(points, offsets, around, kept, kept, view.tolerance)
    strip = kept[parts.pair]
    lacking = shadows.lacking[which[strip]] & ~shadows.lacking[light[strip]]
    count = np.zeros(len(strip), dtype=np.intp)
    return Decals(
        parts.points,
        parts.offsets,
        shadows.face[which[strip]],
        count + int(FillKind.SHADOW_BORDER),
        count + grade,
        np.log2(shadows.lacking[light[strip]]).astype(np.intp),
        count - 1,
        count + 2 * grade - 1,
        lacking=lacking,
    )


def _again(view: View, parts: Parts, borders: PlaneBundles, other: Ints) -> Parts:
    """Parts cut once more, by the borders of other shadows."""
    cut = cut_by_planes(parts.points, parts.offsets, borders, np.arange(len(parts)), other[parts.pair], view.tolerance)
    return Parts(cut.points, cut.offsets, parts.pair[cut.pair], cut.whole)


def _widened(view: View, shadows: Shadows, which: Ints, width: float) -> PlaneBundles:
    """The planes through the eye and the sides of images of shadows, moved outwards by the width, and across their
    corners as far outside. Bundles without planes: of shadows that reach behind the near plane, or have no image."""
    position, offsets = corner_positions(shadows.offsets, which)
    points = shadows.points[:, position]
    image = view.image_of(points)
    near = np.minimum.reduceat(view.depth_of(points), offsets[:-1]) <= view.near if len(which) else which > 0
    along = image[:, next_positions(offsets, np.arange(len(position)))] - image
    long = (along * along).sum(axis=0) > view.tolerance * view.tolerance
    long &= ~np.repeat(near, np.diff(offsets))
    counts = np.add.reduceat(long, offsets[:-1]).astype(np.intp) if len(which) else which
    long &= np.repeat(counts >= 3, np.diff(offsets))
    counts = np.where(counts >= 3, counts, 0)
    ends = np.concatenate([[0], np.cumsum(counts)])
    image, along = image[:, long], along[:, long]
    along /= np.sqrt((along * along).sum(axis=0))
    lines, owner = _outer_lines(image, along, ends, width)
    order = np.argsort(owner, kind="stable")
    first = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=len(which)))])
    planes = _sight_planes(view, lines[:, order])
    return PlaneBundles(planes, first)


def _outer_lines(image: Floats, along: Floats, ends: Ints, width: float) -> tuple[Floats, Ints]:
    """(3,k) lines a x + b y <= c of the image around convex polygons, and whose each is."""
    sizes = np.diff(ends)
    owner = np.repeat(np.arange(len(sizes)), sizes)
    turn = np.zeros(len(sizes))
    filled = sizes > 0
    # Those without sides left have no corners either.
    some = np.append(ends[:-1][filled], len(owner))
    after = next_positions(some, np.arange(len(owner))) if len(owner) else owner
    before = np.empty_like(after)
    before[after] = np.arange(len(owner))
    corner = along[0, before] * along[1] - along[1, before] * along[0]
    turn[filled] = np.add.reduceat(corner, ends[:-1][filled]) if filled.any() else 0.0
    outwards = np.stack([along[1], -along[0]]) * np.where(turn < 0.0, -1.0, 1.0)[owner]
    bevel = along[:, before] - along
    size = np.sqrt((bevel * bevel).sum(axis=0))
    sharp = np.flatnonzero(size > STRAIGHT_SINE)
    normal = np.concatenate([outwards, bevel[:, sharp] / size[sharp]], axis=1)
    point = np.concatenate([image, image[:, sharp]], axis=1)
    limit = (normal * point).sum(axis=0) + width
    return np.concatenate([normal, limit[None]]), np.concatenate([owner, owner[sharp]])


def _sight_planes(view: View, lines: Floats) -> Floats:
    """(4,k) the planes through the eye and lines a x + b y <= c of the image, positive on that side.

    Those of lines around a polygon leave nothing behind the eye: they meet in it.
    """
    a, b, c = lines
    if view.eye is None:
        normal = np.stack([-a, -b, np.zeros(len(a))])
        return np.concatenate([normal, -(c + a * view.target[0] + b * view.target[1])[None]])
    normal = np.stack([-a * view.focus, -b * view.focus, -c])
    return planes_of(normal, np.broadcast_to(view.eye[:, None], normal.shape))
