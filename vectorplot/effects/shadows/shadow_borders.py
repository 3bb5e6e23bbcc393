"""Soft borders of shadows: lamps that are no points make auras around them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals.decal_polygons import Decals, joined_decals, no_decals
from vectorplot.effects.shadows.shadow_grades import Shadows, joined_shadows
from vectorplot.effects.shadows.shadow_shades import LEVELS
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.plane_cuts import PlaneBundles, cut_by_planes, planes_of
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import STRAIGHT_SINE

BEVEL_REACH = 2.0
"""No point of a border is farther from the box of its shadow than so many widths: two sides and the bevel between them
meet within 1.5 widths."""

EVERYWHERE = 1e30
"""As far as boxes reach that have no end."""


def shadow_borders(view: View, single: Shadows, cells: Shadows, width: float) -> Decals:
    """Strips around shadows, in the image as wide as the width, to be painted before them: the narrower, the darker.

    single: the shadows of single lights; cells: those of all grades, as graded makes them. Strips lie on what their
    light reaches: faces, and on them cells that lack other lights; each is a whole polygon, larger than what is seen of
    it, that darker cells are painted over. lacking: the lights that do not get there at all; light: the one that gets
    there in part; grade: that of the shadow beside it; level: a multiple of LEVELS for what it lies on, and the step,
    1 at the outer side to LEVELS - 1 beside the shadow.
    Errors: InputError for a width that is negative or not finite.
    Degenerate: no borders for width zero, and around faces that are dark as wholes.
    Source: Glaeser, section 6.3 (aura).
    """
    if not 0.0 <= width < np.inf:
        raise InputError(f"a border of width {width:g}: expected a number that is not negative")
    single = single.some(np.flatnonzero(~single.whole))
    if width == 0.0 or not len(single):
        return no_decals()
    ground = _lit_somewhere(view, single, cells)
    strip, on = _neighbours(view, single, ground, width)
    useful = ground.face[on] == single.face[strip]
    useful &= ground.lacking[on] & single.lacking[strip] == 0
    strip, on = strip[useful], on[useful]
    steps = np.arange(1, LEVELS)
    return joined_decals(*(_step(view, single, ground, strip, on, width, step) for step in steps.tolist()))


def _step(view: View, single: Shadows, ground: Shadows, strip: Ints, on: Ints, width: float, step: int) -> Decals:
    """The strips of one step: those of the first one are as wide as the border, and hardly dark."""
    around = _widened(view, single, width * (LEVELS - step) / (LEVELS - 1))
    there = (np.diff(around.first) > 0)[strip]
    strip, on = strip[there], on[there]
    parts = cut_by_planes(ground.points, ground.offsets, around, on, strip, view.tolerance)
    strip, on = strip[parts.pair], on[parts.pair]
    return Decals(
        parts.points,
        parts.offsets,
        ground.face[on],
        np.full(len(on), int(FillKind.SHADOW_BORDER), dtype=np.intp),
        ground.grade[on] + 1,
        np.log2(single.lacking[strip]).astype(np.intp),
        np.full(len(on), -1, dtype=np.intp),
        LEVELS * ground.grade[on] + step,
        lacking=ground.lacking[on],
    )


def _lit_somewhere(view: View, single: Shadows, cells: Shadows) -> Shadows:
    """The faces that shadows fall on, as polygons that lack no light, and the cells on them."""
    face = np.unique(single.face)
    position, offsets = ragged.take(view.offsets, face)
    bare = np.zeros(len(face), dtype=np.intp)
    faces = Shadows(view.points[:, view.corners[position]], offsets, face, bare, bare == 0)
    return joined_shadows([faces, cells.some(np.flatnonzero(np.isin(cells.face, face)))])


def _neighbours(view: View, single: Shadows, ground: Shadows, width: float) -> tuple[Ints, Ints]:
    """Pairs of shadows and polygons that are no farther apart in the image than the width, as far as boxes tell."""
    import shapely

    left, bottom, right, top = _image_boxes(view, ground)
    tree = shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16)
    left, bottom, right, top = _image_boxes(view, single)
    reach = BEVEL_REACH * width
    strip, on = tree.query(shapely.box(left - reach, bottom - reach, right + reach, top + reach))
    return strip, on


def _image_boxes(view: View, shadows: Shadows) -> Floats:
    """(4,m) smallest x and y, largest x and y in the image; of what reaches behind the near plane, everything."""
    image = view.image_of(shadows.points)
    starts = shadows.offsets[:-1]
    boxes = np.concatenate([extreme.reduceat(image, starts, axis=1) for extreme in (np.minimum, np.maximum)])
    if view.eye is not None:
        behind = np.minimum.reduceat(view.depth_of(shadows.points), starts) <= view.near
        boxes[:, behind] = np.array([[-1.0], [-1.0], [1.0], [1.0]]) * EVERYWHERE
    return boxes


def _widened(view: View, shadows: Shadows, width: float) -> PlaneBundles:
    """The planes through the eye and the sides of images of shadows, moved outwards by the width, and across their
    corners as far outside. Bundles without planes: of shadows that reach behind the near plane, or have no image."""
    points, offsets = shadows.points, shadows.offsets
    image = view.image_of(points)
    near = np.minimum.reduceat(view.depth_of(points), offsets[:-1]) <= view.near
    along = image[:, next_positions(offsets, np.arange(points.shape[1]))] - image
    long = (along * along).sum(axis=0) > view.tolerance * view.tolerance
    long &= ~np.repeat(near, np.diff(offsets))
    counts = np.add.reduceat(long, offsets[:-1]).astype(np.intp)
    long &= np.repeat(counts >= 3, np.diff(offsets))
    counts = np.where(counts >= 3, counts, 0)
    ends = ragged.offsets(counts)
    image, along = image[:, long], along[:, long]
    along /= np.sqrt((along * along).sum(axis=0))
    lines, owner = _outer_lines(image, along, ends, width)
    order = np.argsort(owner, kind="stable")
    first = ragged.offsets(np.bincount(owner, minlength=len(shadows)))
    return PlaneBundles(_sight_planes(view, lines[:, order]), first)


def _outer_lines(image: Floats, along: Floats, ends: Ints, width: float) -> tuple[Floats, Ints]:
    """(3,k) lines a x + b y <= c of the image around convex polygons, and whose each is."""
    sizes = np.diff(ends)
    owner = ragged.owner(sizes)
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
