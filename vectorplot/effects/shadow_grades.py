"""Shadows of several lights on the same faces: where they overlap it is darker."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals
from vectorplot.features.edges import cross
from vectorplot.geometry.mesh import Bools, Floats, Ints, next_positions
from vectorplot.geometry.plane_cuts import Parts, PlaneBundles, crossings_of, cut_by_planes, planes_of, polygon_areas
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import corner_positions
from vectorplot.visibility.projected_faces import newell

PITCH = 4.0
"""Faces are spread out on a plane at this distance from each other, so that one tree holds them all: no face of a
view is wider than twice the root of 3."""

OUTWARDS = np.array([[-1.0], [1.0], [-1.0], [1.0]])
"""Which way the sides of a box look: smallest and largest x, smallest and largest y."""

POLYGONS_AT_ONCE = 1 << 14
"""Polygons whose partners are looked up at once."""


@dataclass(frozen=True, eq=False)
class Shadows:
    """Convex polygons on faces: points (3,c) in the view, offsets (m+1,); face (m,) of the view; lacking (m,): the
    lights that do not get there, bit k for light k; whole (m,): it is the whole face; parents (g,m): the shadows of
    grade 1, in the order of their lights, that it is the common part of, -1 where there are fewer."""

    points: Floats
    offsets: Ints
    face: Ints
    lacking: Ints
    whole: Bools
    parents: Ints

    def __len__(self) -> int:
        return len(self.face)

    @classmethod
    def of_light(cls, parts: Parts, face: Ints, light: int) -> Shadows:
        """Parts of faces that one light does not reach."""
        lacking = np.full(len(face), 1 << light, dtype=np.intp)
        return cls(parts.points, parts.offsets, face, lacking, parts.whole, np.zeros((0, len(face)), dtype=np.intp))

    @property
    def grade(self) -> Ints:
        """(m,) how many lights each lacks."""
        return np.bitwise_count(self.lacking).astype(np.intp)

    @cached_property
    def area(self) -> Floats:
        """(m,) twice their areas."""
        normal, _ = polygon_areas(self.points, self.offsets)
        return np.asarray(np.sqrt((normal * normal).sum(axis=0)), dtype=np.float64)

    def some(self, which: Ints) -> Shadows:
        """Some of them, in the order asked for."""
        position, offsets = corner_positions(self.offsets, which)
        return Shadows(
            self.points[:, position],
            offsets,
            self.face[which],
            self.lacking[which],
            self.whole[which],
            self.parents[:, which],
        )

    def without_needless(self) -> Shadows:
        """The same without those on faces that another shadow for want of the same lights covers whole."""
        order = np.lexsort((~self.whole, self.lacking, self.face))
        face, lacking = self.face[order], self.lacking[order]
        first = np.ones(len(order), dtype=np.bool_)
        first[1:] = (face[1:] != face[:-1]) | (lacking[1:] != lacking[:-1])
        leader = np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
        kept = first | ~self.whole[order][leader]
        return self if kept.all() else self.some(np.sort(order[kept]))


def joined_shadows(shadows: Sequence[Shadows]) -> Shadows:
    """All shadows one after the other."""
    none = np.zeros(0, dtype=np.intp)
    if not shadows:
        return Shadows(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none, none.astype(np.bool_), none[None][:0])
    sizes = np.concatenate([np.diff(s.offsets) for s in shadows])
    rows = max(len(s.parents) for s in shadows)
    parents = [np.pad(s.parents, ((0, rows - len(s.parents)), (0, 0)), constant_values=-1) for s in shadows]
    return Shadows(
        np.concatenate([s.points for s in shadows], axis=1),
        np.concatenate([[0], np.cumsum(sizes)]),
        np.concatenate([s.face for s in shadows]),
        np.concatenate([s.lacking for s in shadows]),
        np.concatenate([s.whole for s in shadows]),
        np.concatenate(parents, axis=1),
    )


def graded(view: View, shadows: Shadows, lights: int) -> Shadows:
    """Shadows of grade 1, and after them the common parts of those of different lights, of grade 2, 3 and so on up to
    the number of lights.

    Source: Glaeser, section 6.3, figure 6.
    """
    if lights > 1:
        shadows = without_covered(view, shadows)
    single = replace(shadows, parents=np.arange(len(shadows))[None])
    grades = [single]
    if lights < 2 or not len(shadows):
        return single
    tree, borders = _FaceTree.of(view, single), upright_planes(view, single)
    while len(grades) < lights and len(grades[-1]):
        grades.append(_next_grade(view, grades[-1], single, tree, borders).without_needless())
    return joined_shadows(grades)


def without_covered(view: View, shadows: Shadows) -> Shadows:
    """The same without those that lie in another one on the same face for want of the same lights.

    Of those that cover each other the first one stays.
    """
    if not len(shadows):
        return shadows
    tree, borders = _FaceTree.of(view, shadows), upright_planes(view, shadows)
    covered = np.zeros(len(shadows), dtype=np.bool_)
    for low in range(0, len(shadows), POLYGONS_AT_ONCE):
        lot = shadows.some(np.arange(low, min(low + POLYGONS_AT_ONCE, len(shadows))))
        mine, other = tree.partners(tree.box[:, low : low + POLYGONS_AT_ONCE])
        same = np.flatnonzero((shadows.lacking[other] == lot.lacking[mine]) & (other != mine + low))
        mine, other = mine[same], other[same]
        inner = tree.box[:, mine + low] * OUTWARDS
        inside = np.flatnonzero((inner <= tree.box[:, other] * OUTWARDS + view.tolerance).all(axis=0))
        mine, other = mine[inside], other[inside]
        found = crossings_of(lot.points, lot.offsets, borders, mine, other, view.tolerance)
        within = found.pair[found.whole]
        mine, other = mine[within] + low, other[within]
        # What covers it is not covered itself, or else the cover of that one covers it too.
        area = shadows.area
        larger = (area[other] > area[mine]) | ((area[other] == area[mine]) & (other < mine))
        covered[mine[larger]] = True
    return shadows.some(np.flatnonzero(~covered))


def _next_grade(view: View, shadows: Shadows, single: Shadows, tree: _FaceTree, borders: PlaneBundles) -> Shadows:
    """The common parts of shadows with those of grade 1 of lights with higher numbers."""
    found = []
    for low in range(0, len(shadows), POLYGONS_AT_ONCE):
        lot = shadows.some(np.arange(low, min(low + POLYGONS_AT_ONCE, len(shadows))))
        mine, other = tree.partners(_laid_out(view, lot))
        later = np.flatnonzero(single.lacking[other] > lot.lacking[mine])
        mine, other = mine[later], other[later]
        parts = cut_by_planes(lot.points, lot.offsets, borders, mine, other, view.tolerance)
        mine, other = mine[parts.pair], other[parts.pair]
        found.append(
            Shadows(
                parts.points,
                parts.offsets,
                lot.face[mine],
                lot.lacking[mine] | single.lacking[other],
                lot.whole[mine] & single.whole[other],
                np.concatenate([lot.parents[:, mine], other[None]]),
            )
        )
    return joined_shadows(found)


def upright_planes(view: View, shadows: Shadows) -> PlaneBundles:
    """The planes upright on the faces through the sides of shadows, positive inside."""
    normal, _ = polygon_areas(shadows.points, shadows.offsets)
    sizes = np.diff(shadows.offsets)
    owner = np.repeat(np.arange(len(sizes)), sizes)
    after = next_positions(shadows.offsets, np.arange(shadows.points.shape[1]))
    along = shadows.points[:, after] - shadows.points
    kept = np.flatnonzero((along * along).sum(axis=0) > view.tolerance * view.tolerance)
    # The area vector only tells the direction: divided by its length it does not vanish for small shadows.
    unit = normal / np.sqrt((normal * normal).sum(axis=0))
    planes = planes_of(cross(unit[:, owner[kept]], along[:, kept]), shadows.points[:, kept])
    counts = np.bincount(owner[kept], minlength=len(sizes))
    return PlaneBundles(planes, np.concatenate([[0], np.cumsum(counts)]))


@dataclass(frozen=True, eq=False)
class _FaceTree:
    """A tree over shadows, laid out so that only those on one face come together: box (4,m), smallest and largest x,
    smallest and largest y."""

    tree: Any
    box: Floats

    @classmethod
    def of(cls, view: View, shadows: Shadows) -> _FaceTree:
        import shapely

        box = _laid_out(view, shadows)
        left, right, bottom, top = box
        return cls(shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16), box)

    def partners(self, box: Floats) -> tuple[Ints, Ints]:
        """Pairs of boxes and shadows in the tree on the same face that they overlap."""
        import shapely

        left, right, bottom, top = box
        mine, other = self.tree.query(shapely.box(left, bottom, right, top))
        return mine, other


def _laid_out(view: View, shadows: Shadows) -> Floats:
    """(4,m) boxes of shadows, seen along the axis that their face is steepest to, each face on a field of its own."""
    normal, _, _ = newell(view, shadows.face)
    sizes = np.diff(shadows.offsets)
    axis = np.argmax(np.abs(normal), axis=0)
    position = np.arange(shadows.points.shape[1])
    row, column = np.divmod(shadows.face, int(np.sqrt(view.face_count)) + 1)
    result = []
    for step, field in ((1, column), (2, row)):
        x = shadows.points[np.repeat((axis + step) % 3, sizes), position]
        for extreme in (np.minimum, np.maximum):
            result.append(extreme.reduceat(x, shadows.offsets[:-1]) + PITCH * field)
    return np.stack(result)


def shadow_decals_of(shadows: Shadows, kind: FillKind) -> Decals:
    """Shadows as decals, higher grades above."""
    grade = shadows.grade
    none = np.full(len(shadows), -1, dtype=np.intp)
    light = np.where(grade == 1, np.log2(np.maximum(shadows.lacking, 1)).astype(np.intp), -1)
    return Decals(
        shadows.points,
        shadows.offsets,
        shadows.face,
        np.full(len(shadows), int(kind), dtype=np.intp),
        grade,
        light,
        none,
        2 * grade,
        lacking=shadows.lacking,
    )
