"""Cast shadows as polygons on the faces they fall on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals.decal_polygons import Decals
from vectorplot.effects.shadows.light_system import FacePlanes, LightBoxes, LightSystem, light_boxes, light_system
from vectorplot.effects.shadows.shadow_casters import Casters, shadow_casters
from vectorplot.effects.shadows.shadow_grades import Shadows, graded, joined_shadows, shadow_decals_of
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.plane_cuts import Crossings, crossings_of, parts_of
from vectorplot.scene.scene import Light
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

MOST_LIGHTS = 52
"""So many lights have each a bit of a number."""

MOST_FACES = 1024
"""A convex solid with more faces casts shadows face by face: to see that it is convex would take longer."""

CASTERS_FIRST = 1 << 8
"""Casters whose partners are looked up first: how many they have says how many casters come next."""

PAIRS_AT_ONCE = 1 << 20
"""About so many pairs of casters and receivers are handled at once."""


@dataclass(frozen=True, eq=False)
class Receivers:
    """Faces that shadows may fall on: face (r,) of the view; points (3,c), offsets (r+1,)."""

    face: Ints
    points: Floats
    offsets: Ints

    @classmethod
    def of(cls, view: View, face: Ints) -> Receivers:
        """Some faces of a view."""
        position, offsets = ragged.take(view.offsets, face)
        return cls(face, view.points[:, view.corners[position]], offsets)


def cast_shadows(
    view: View,
    lights: Sequence[Light],
    *,
    casters: Bools | None = None,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
) -> Shadows:
    """The shadows of grade 1, light by light, on the faces that can be seen and are lit on the side that is seen.

    casters (i,): the items that cast shadows (None: those that occlude); receivers (f,): the faces that they may fall
    on (None: all). Where every point of a face is in the shadow of one thing, the others that shadow it from this light
    are left out.
    Errors: InputError for lights out of range, or more than MOST_LIGHTS of them.
    Degenerate: faces that the light grazes, and dark sides, have no shadows; what touches a face or lies in its plane
    casts none on it.
    Source: Glaeser, section 6.3, figures 4 and 5.
    """
    if len(lights) > MOST_LIGHTS:
        raise InputError(f"{len(lights)} lights cast shadows: at most {MOST_LIGHTS} can")
    projected = project_faces(view) if projected is None else projected
    items = view.occludes if casters is None else np.asarray(casters, dtype=np.bool_)
    solids = solid_items(replace(view, occludes=items), projected, most_faces=MOST_FACES)
    planes = FacePlanes.of(view)
    seen = drawn_faces(view, projected)
    seen = seen if receivers is None else seen[receivers[seen]]
    found = []
    for number, light in enumerate(lights):
        system = light_system(view, light)
        facing = system.facing(planes, view.tolerance)
        lit = seen[facing[seen] * projected.facing[seen] > 0]
        dark = shadow_casters(view, planes, system, facing, items, solids)
        found.append(_of_light(view, system, dark, Receivers.of(view, lit), number))
    return joined_shadows(found)


def _of_light(view: View, system: LightSystem, casters: Casters, receivers: Receivers, number: int) -> Shadows:
    """The shadows that the casters throw on the receivers; on a face that one of them darkens whole, only that one."""
    parts = []
    dark = np.zeros(len(receivers.face), dtype=np.bool_)
    for caster, receiver in candidates(view, system, casters, receivers):
        light = np.flatnonzero(~dark[receiver])
        caster, receiver = caster[light], receiver[light]
        found = shadow_crossings(view, casters, receivers, caster, receiver)
        first = _first_whole(found, receiver, len(dark))
        dark[receiver[found.pair[first]]] = True
        useful = ~dark[receiver[found.pair]]
        useful[first] = True
        found = found.some(np.flatnonzero(useful))
        cut = parts_of(receivers.points, receivers.offsets, receiver, found, view.tolerance)
        parts.append(Shadows.of_light(cut, receivers.face[receiver[cut.pair]], number))
    # What was found of a face before it was found to be dark.
    return joined_shadows(parts).without_needless()


def _first_whole(found: Crossings, receiver: Ints, count: int) -> Ints:
    """Of each receiver that is dark as a whole, the first pair that says so."""
    whole = np.flatnonzero(found.whole)
    _, first = np.unique(receiver[found.pair[whole]], return_index=True)
    return whole[first]


def shadow_crossings(view: View, casters: Casters, receivers: Receivers, caster: Ints, receiver: Ints) -> Crossings:
    """Where things cut the light off from faces, pair by pair. Source: Glaeser, section 6.3, figure 4."""
    return crossings_of(receivers.points, receivers.offsets, casters.volumes, receiver, caster, view.tolerance)


def candidates(view: View, system: LightSystem, casters: Casters, receivers: Receivers) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of casters and receivers whose boxes overlap in an image of the light, the caster not behind; each pair
    once, in lots.

    Source: Glaeser, section 6.3 (bounding rectangles and priorities in the light systems).
    """
    if not len(casters) or not len(receivers.face):
        return
    givers = [boxes.grouped(casters.caster) for boxes in light_boxes(view, system, casters.face)]
    takers = light_boxes(view, system, receivers.face)
    trees = [_Tree.of(boxes, view.tolerance) for boxes in takers]
    low, count = 0, CASTERS_FIRST
    while low < len(casters):
        lot = [tree.partners(boxes, low, low + count) for tree, boxes in zip(trees, givers, strict=True)]
        low += count
        caster, receiver = (np.concatenate([pairs[k] for pairs in lot]) for k in (0, 1))
        if len(lot) > 1:
            key = np.unique(caster * len(receivers.face) + receiver)
            caster, receiver = np.divmod(key, len(receivers.face))
        yield caster, receiver
        count = int(np.clip(count * PAIRS_AT_ONCE / max(len(caster), 1), 1, 8 * count))


@dataclass(frozen=True, eq=False)
class _Tree:
    """A tree over boxes in an image of the light."""

    boxes: LightBoxes
    tree: object
    tolerance: float

    @classmethod
    def of(cls, boxes: LightBoxes, tolerance: float) -> _Tree:
        import shapely

        left, right, bottom, top = boxes.box[:4]
        return cls(boxes, shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16), tolerance)

    def partners(self, boxes: LightBoxes, low: int, high: int) -> tuple[Ints, Ints]:
        """Pairs of other boxes, with numbers from low to high, and boxes in the tree that they overlap, and do not lie
        behind."""
        import shapely

        begin, end = np.searchsorted(boxes.which, [low, high])
        left, right, bottom, top, nearest = boxes.box[:5, begin:end]
        asked, found = self.tree.query(shapely.box(left, bottom, right, top))  # type: ignore[attr-defined]
        before = np.flatnonzero(nearest[asked] < self.boxes.box[5, found] - self.tolerance)
        return boxes.which[begin + asked[before]], self.boxes.which[found[before]]


def shadow_decals(
    view: View, lights: Sequence[Light], *, casters: Bools | None = None, projected: ProjectedFaces | None = None
) -> Decals:
    """The shadows of every grade of all lights on the faces of a view, darker ones above: at any point the highest
    grade there is the number of lights that the face is turned to and does not get.

    Arguments, errors and degenerate cases as of cast_shadows; the shadows of one light may overlap.
    Source: Glaeser, section 6.3, figure 6.
    """
    shadows = cast_shadows(view, lights, casters=casters, projected=projected)
    return shadow_decals_of(graded(view, shadows), FillKind.SHADOW)
