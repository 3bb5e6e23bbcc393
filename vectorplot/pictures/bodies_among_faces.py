"""Quadric bodies that are painted as wholes among polyhedra and other things that are painted polygon by polygon."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, stacked
from vectorplot.effects.decals import Decals
from vectorplot.effects.shadow_casters import Casters, FacePlanes, LightSystem, light_system, shadow_casters
from vectorplot.effects.shadows import (
    MOST_FACES,
    cast_within,
    graded,
    joined_shadows,
    shadow_decals_of,
    tell_missing_shadows,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.budget import Budget
from vectorplot.geometry.polygon_cuts import PlaneBundles
from vectorplot.pictures.banded_bodies import (
    Shade,
    WholeBodies,
    band_error_steps,
    banded_fills,
    millimetres,
    whole_bodies,
)
from vectorplot.pictures.facet_errors import outline_error
from vectorplot.pictures.fills import FacePainter, VisiblePolygons, background, off_surfaces
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.shaded_faces import view_lights
from vectorplot.visibility.painter.body_order import order_among_bodies
from vectorplot.visibility.painter.image_faces import view_points
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.visibility.quadrics.clearances import Silhouettes, balls_around, is_within, silhouettes

FINER = 0.3
"""Of what the tolerance allows, silhouettes of bodies may be off: shadows are larger than what throws them."""

# Shadows that bodies throw on faces.


def shadows_of_bodies(
    whole: WholeBodies, seen: VisiblePolygons, items: Sequence[Item], tolerance_mm: float, budget: Budget
) -> Decals:
    """The shadows on the faces of what is seen, of these and of bodies, as of scene_shadows; items: of the scene. For
    each light flat things stand in place of the bodies, see silhouettes."""
    view, lights = seen.view, seen.scene.lights
    allowed = FINER * tolerance_mm * millimetres(whole, seen.placement)
    off = off_surfaces(seen, tolerance_mm)
    shows = np.array([item.material.opacity >= 1.0 or bool(item.patterns) for item in items], dtype=np.bool_)
    found, left_out = [], [np.zeros((3, 0), dtype=np.intp)]
    for number, (light, here) in enumerate(zip(lights, view_lights(view, lights), strict=True)):
        flat = silhouettes(whole.solids, here, allowed)
        every = _with_faces(view, flat)
        receivers = np.zeros(every.face_count, dtype=np.bool_)
        receivers[: view.face_count] = shows[view.shown_item]
        none = np.zeros(len(flat.body))
        cast = cast_within(every, [light], budget.pairs, receivers=receivers, off=np.concatenate([off, none]))
        found.append(replace(cast.shadows, lacking=cast.shadows.lacking << number))
        of = np.append(np.arange(len(items)), whole.solids.item[flat.body])
        left_out.append(np.stack([cast.left_out[0] + number, *of[cast.left_out[1:]]]))
    tell_missing_shadows(items, lights, np.concatenate(left_out, axis=1))
    return shadow_decals_of(graded(view, joined_shadows(found)), FillKind.SHADOW)


def _with_faces(view: View, flat: Silhouettes) -> View:
    """The view with more items behind its own, of one face each."""
    count, corners = len(flat.body), flat.points.shape[1]
    item = len(view.occludes) + np.arange(count)
    return replace(
        view,
        points=np.concatenate([view.points, flat.points], axis=1),
        corners=np.append(view.corners, view.points.shape[1] + np.arange(corners)),
        offsets=np.append(view.offsets, view.offsets[-1] + flat.offsets[1:]),
        inner=np.append(view.inner, np.zeros(corners, dtype=np.bool_)),
        face_item=np.append(view.face_item, item),
        item_vertices=np.append(view.item_vertices, view.item_vertices[-1] + flat.offsets[1:]),
        occludes=np.append(view.occludes, np.ones(count, dtype=np.bool_)),
        face_look=None if view.face_look is None else np.append(view.face_look, item),
    )


# Shadows that convex solids and single faces throw on bodies.


@dataclass(frozen=True, eq=False)
class _Volumes:
    """What convex casters keep dark, and for receivers one after the other those that may shadow them: caster (k,),
    offsets (n+1,). Called as Clearance: how far outside of all volumes places are."""

    volumes: PlaneBundles
    caster: Ints
    offsets: Ints

    def __call__(self, receiver: Ints, points: Floats) -> Floats:
        """(m,) in the view."""
        least = np.ones(len(receiver))
        count = np.diff(self.offsets)[receiver]
        some = np.flatnonzero(count)
        planes = np.diff(self.volumes.offsets)
        largest = int(planes.max(initial=1)) * max(int(count.max(initial=1)), 1)
        for begin in range(0, len(some), max(1, PAIRS_AT_ONCE // largest)):
            place = some[begin : begin + max(1, PAIRS_AT_ONCE // largest)]
            caster = self.caster[ragged.ranges(self.offsets[receiver[place]], count[place])]
            of = np.repeat(place, count[place])
            plane = ragged.ranges(self.volumes.offsets[caster], planes[caster])
            beyond = -_heights(self.volumes.planes[:, plane], points[:, np.repeat(of, planes[caster])])
            outside = np.maximum.reduceat(beyond, ragged.starts(planes[caster]))
            least[place] = np.minimum(least[place], np.minimum.reduceat(outside, ragged.starts(count[place])))
        return least


def _heights(planes: Floats, points: Floats) -> Floats:
    return np.asarray(planes[0] * points[0] + planes[1] * points[1] + planes[2] * points[2] - planes[3])


def shades_of_faces(
    whole: WholeBodies, view: View, projected: ProjectedFaces, lights: Sequence[Light]
) -> list[Shade | None] | None:
    """For each light what convex solids, and items of one convex face, keep dark of the visible parts of bodies, None
    where nothing; None where something else may throw a shadow on one."""
    items = view.occludes
    solids = solid_items(view, projected, most_faces=MOST_FACES)
    planes = FacePlanes.of(view)
    middle, radius = balls_around(whole.bodies)
    found: list[Shade | None] = []
    for light in lights:
        system = light_system(view, light)
        facing = system.facing(planes, view.tolerance)
        casters = shadow_casters(view, planes, system, facing, items, solids, projected.sides)
        pairs = [np.zeros((2, 0), dtype=np.intp)]
        sizes = np.diff(casters.volumes.offsets)
        for low, high in ragged.batches(sizes * max(len(radius), 1), PAIRS_AT_ONCE):
            part = casters.volumes.take(np.arange(low, high))
            beyond = -_heights(part.planes[:, :, None], middle[:, None])
            outside = np.maximum.reduceat(beyond, part.offsets[:-1], axis=0)
            caster, body = np.nonzero(outside < radius)
            pairs.append(np.stack([body, low + caster]))
        body, caster = np.concatenate(pairs, axis=1)
        shading = np.unique(caster)
        if not len(shading):
            found.append(None)
            continue
        if (np.bincount(casters.item)[casters.item[shading]] > 1).any():
            return None
        order = np.argsort(body, kind="stable")
        offsets = ragged.offsets(np.bincount(body, minlength=len(radius)))
        position, ends = ragged.take(offsets, whole.charts.body)
        volumes = _Volumes(casters.volumes, caster[order][position], ends)
        found.append(Shade(volumes, _narrowest(view, casters.take(shading), planes, system)))
    return found


def _narrowest(view: View, casters: Casters, planes: FacePlanes, system: LightSystem) -> float:
    """About how wide the narrowest of some casters is that the light sees: as wide as its lit faces would make one that
    is as long as the caster."""
    position, offsets = ragged.take(view.offsets, casters.face)
    points = view.points[:, view.corners[position]]
    first = ragged.starts(np.bincount(casters.caster, minlength=len(casters)))
    starts = offsets[first]
    low, high = (f.reduceat(points, starts, axis=1) for f in (np.minimum, np.maximum))
    ray = system.towards(planes.first[:, casters.face])
    cosine = np.abs((planes.planes[:3, casters.face] * ray).sum(axis=0)) / np.sqrt((ray * ray).sum(axis=0))
    area = 0.5 * np.add.reduceat(planes.area[casters.face] * cosine, first)
    return float((area / np.sqrt(((high - low) ** 2).sum(axis=0))).min())


# A picture of both.


def painted_bodies(
    painter: FacePainter, shown: Scene, beside: Callable[[View], Floats]
) -> tuple[View, Placement, Fills] | None:
    """The scene with bodies as wholes among polygons, back to front: its view, its place on the page, and the
    polygons; None where bodies cannot be painted as wholes, see whole_bodies, where they pierce other things or have a
    lamp inside, or where things that are no convex solids throw shadows on them.

    shown: what of the scene is painted; beside: the places (n,3) in the world that are to be on the page as well.
    """
    pipeline, tolerance_mm = painter.pipeline, painter.tolerance_mm
    casts = pipeline.calls_for("shadows")
    whole = pipeline.run("bodies", whole_bodies, shown, painter.projection)
    if whole is None:
        _tell_undone(pipeline, "they pierce each other, lie on each other in circles, or are too near the eye")
        return None
    some = np.setdiff1d(np.arange(len(shown.items)), whole.solids.item)
    if all(is_curve(shown.items[number].shape) for number in some.tolist()):
        placement = whole.placement(painter.sheet, painter.fit, beside(whole.view))
        bands = _banded(painter, whole, placement, whole.places, ())
        return whole.view, placement, Fills.joined(*background(painter.scene, placement.page), bands.fills)
    ordered = painter.ordered(whole.rest)
    placement = whole.placement(painter.sheet, painter.fit, beside(whole.view), ordered.faces)
    pipeline.measured("facets", "mm", outline_error, ordered.facets, ordered.view, placement)
    seen, lighting = painter.seen(ordered, placement)
    united = lighting.plane
    places = _places(whole, seen, united)
    if places is None:
        # What lies in one plane may be before and behind a body, as the faces around a hole are.
        united = np.arange(seen.view.face_count)
        places = _places(whole, seen, united)
    lights = seen.scene.lights if casts else ()
    shades = None if places is None else shades_of_faces(whole, seen.view, seen.projected, lights)
    lit_within = any(is_within(whole.solids, light) for light in view_lights(seen.view, lights)) if lights else False
    if places is None or shades is None or lit_within:
        _tell_undone(pipeline, "they pierce other things, are in their shadows, or have a lamp inside")
        return None
    of_faces, of_bodies = places

    def cast(seen: VisiblePolygons) -> Decals:
        return shadows_of_bodies(whole, seen, painter.scene.items, tolerance_mm, painter.budget)

    painted = painter.coloured(seen, lighting, cast, united)
    # What lies on a face comes right after it; paper comes first.
    leader = np.maximum.accumulate(np.where(painted.after >= 0, np.arange(len(painted.after)), -1))
    place = np.where(leader >= 0, of_faces[painted.after[leader]], -1)
    bands = _banded(painter, whole, placement, of_bodies, shades)
    for stage in ("order", "shadows"):
        pipeline.measured(stage, "mm", lambda: seen.view.tolerance * placement.scale)
    return whole.view, placement, stacked([replace(painted, after=place), bands]).fills


def _tell_undone(pipeline: Pipeline, why: str) -> None:
    """Tell the listener why there are triangles in place of bodies."""
    pipeline.tell("bodies undone", f"{why}: triangles in their place", 0)


def _banded(
    painter: FacePainter, whole: WholeBodies, placement: Placement, place: Ints, shades: Sequence[Shade | None]
) -> Overlay:
    """As of banded_fills, and what is off is measured."""
    pipeline, tolerance_mm = painter.pipeline, painter.tolerance_mm
    casts = pipeline.calls_for("shadows")
    bands, off_mm = pipeline.run("bands", banded_fills, whole, placement, casts, tolerance_mm, place, shades)
    pipeline.measured("bodies", "mm", lambda: off_mm)
    pipeline.measured("bands", "of 255", band_error_steps, whole, placement, tolerance_mm)
    return bands


def _places(whole: WholeBodies, seen: VisiblePolygons, united: Ints) -> tuple[Ints, Ints] | None:
    """The places (n,) of the polygons that are seen, and (m,) of bodies, in one order back to front; None where there
    is none. united (f,): faces of the view with one number keep together where they follow each other."""
    faces = seen.faces
    points = view_points(seen.view, faces.points)
    planes = FacePlanes.of(seen.view).planes[:, faces.source]
    tolerance = seen.view.tolerance
    return order_among_bodies(whole.ordered, whole.boxes, faces, points, planes, united[faces.source], tolerance)
