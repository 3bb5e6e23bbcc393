"""What keeps light away: convex solids by their outlines, all else face by face."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.effects.shadows.light_system import FacePlanes, LightSystem
from vectorplot.geometry import ragged
from vectorplot.geometry.columns import cross
from vectorplot.geometry.convex.plane_cuts import PlaneBundles, planes_of
from vectorplot.scene.view import View
from vectorplot.visibility.painter.embedded_bodies import body_sides


@dataclass(frozen=True, eq=False)
class Casters:
    """Convex things that cast shadows.

    volumes: the planes of what each keeps dark: the cone of rays through its outline, as far as it lies behind all its
    faces; item (k,): of the scene; face (g,): the faces of the view that they show the light, caster (g,), ascending:
    whose they are. No face of a convex body lies behind all others that are lit: the body never shadows its outside.
    known: of pairs (n,) of items and faces of the view, those whose shadows come from elsewhere.
    Source: Glaeser, section 6.3, figure 5.
    """

    volumes: PlaneBundles
    item: Ints
    face: Ints
    caster: Ints
    known: Callable[[Ints, Ints], Bools] | None = None

    def __len__(self) -> int:
        return len(self.item)

    def some(self, which: Ints) -> Casters:
        """Some of them, given by ascending numbers."""
        position, first = ragged.take(self.volumes.first, which)
        number = np.full(len(self), -1, dtype=np.intp)
        number[which] = np.arange(len(which))
        own = np.flatnonzero(number[self.caster] >= 0)
        volumes = PlaneBundles(self.volumes.planes[:, position], first)
        return replace(
            self, volumes=volumes, item=self.item[which], face=self.face[own], caster=number[self.caster[own]]
        )


def shadow_casters(
    view: View, planes: FacePlanes, system: LightSystem, facing: Ints, items: Bools, solids: Bools
) -> Casters:
    """What the items (i,) that cast shadows, solids (i,) among them, put before a light.

    A closed body that the light is outside of keeps it away with the faces that it turns to the light; any other item
    with all its faces. Degenerate: faces that the light grazes keep nothing away.
    """
    lit = np.zeros(len(items), dtype=np.bool_)
    lit[view.face_item[facing > 0]] = True
    whole = items & solids & lit
    of_solid = np.flatnonzero(whole[view.face_item] & (facing > 0))
    loose = items & ~whole
    one_sided, turned = turned_to_light(view, planes, system, facing)
    alone = np.flatnonzero(loose[view.face_item] & (facing != 0) & (~one_sided[view.face_item] | turned))
    item, owner = np.unique(view.face_item[of_solid], return_inverse=True)
    face = np.concatenate([of_solid, alone])
    caster = np.concatenate([owner, len(item) + np.arange(len(alone))])
    volumes = _volumes(view, planes, system, facing, of_solid, alone, caster)
    return Casters(volumes, np.concatenate([item, view.face_item[alone]]), face, caster)


def turned_to_light(view: View, planes: FacePlanes, system: LightSystem, facing: Ints) -> tuple[Bools, Bools]:
    """(i,) closed items, as of body_sides, that the light is outside of, and (f,) the faces that they turn to it."""
    side = np.where(_near_light(view, system), 0, body_sides(view))
    return side != 0, np.asarray(facing * side[view.face_item] > 0)


def _near_light(view: View, system: LightSystem) -> Bools:
    """(i,) the items with the light in the box of their vertices."""
    counts = np.diff(view.item_vertices)
    result = np.zeros(len(counts), dtype=np.bool_)
    filled = np.flatnonzero(counts)
    if system.parallel or not len(filled):
        return result
    starts = view.item_vertices[filled]
    low, high = (f.reduceat(view.points, starts, axis=1) for f in (np.minimum, np.maximum))
    light = system.position[:, None]
    result[filled] = ((light >= low - view.tolerance) & (light <= high + view.tolerance)).all(axis=0)
    return result


def _volumes(
    view: View, planes: FacePlanes, system: LightSystem, facing: Ints, of_solid: Ints, alone: Ints, caster: Ints
) -> PlaneBundles:
    """The planes of what casters keep dark: first those of their faces, then those of rays through their outlines."""
    face = np.concatenate([of_solid, alone])
    behind = planes.planes[:, face] * -facing[face]
    position, offsets = ragged.take(view.offsets, face)
    owner = ragged.owner(np.diff(offsets))
    sides = np.flatnonzero(view.only_sides(position[: offsets[len(of_solid)]]))
    used = np.concatenate([sides, np.arange(int(offsets[len(of_solid)]), len(position))])
    start = view.points[:, view.corners[position[used]]]
    along = view.points[:, view.corners[view.after(position[used])]] - start
    ray = system.towards(start)
    normal = -cross(along, ray) * facing[face[owner[used]]]
    # A side that the light sees as a point bounds nothing.
    size, distance = (np.sqrt((v * v).sum(axis=0)) for v in (normal, ray))
    kept = size > view.tolerance * distance
    side = planes_of(normal[:, kept], start[:, kept])
    of = np.concatenate([caster, caster[owner[used]][kept]])
    order = np.argsort(of, kind="stable")
    counts = np.bincount(of, minlength=int(caster[-1]) + 1 if len(caster) else 0)
    return PlaneBundles(np.concatenate([behind, side], axis=1)[:, order], ragged.offsets(counts))
