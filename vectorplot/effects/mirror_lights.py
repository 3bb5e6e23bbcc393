"""Lit mirrors as further lights: the doubles of lights behind mirrors, and where their light falls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, convex_decals, joined_decals, no_decals
from vectorplot.effects.mirrors import Mirrors, doubled, half_of_view
from vectorplot.effects.patterns import in_shadows
from vectorplot.effects.shadow_casters import FacePlanes, LightSystem, light_system
from vectorplot.effects.shadows import cast_within, shadow_decals_of
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polygon_cuts import PlaneBundles, cut_by_planes, planes_of
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

MIRRORED_SHARE = 0.5
"""How bright a light is by way of a mirror, against the light itself: less, since mirrors keep some of it."""


@dataclass(frozen=True)
class LightDouble:
    """A light as seen in a mirror: light, with the place of the double and its weaker intensity; source: which light of
    the scene it is the double of; plane: which plane of the mirrors."""

    light: Light
    source: int
    plane: int


def light_doubles(view: View, mirrors: Mirrors, lights: Sequence[Light]) -> tuple[LightDouble, ...]:
    """The doubles of all lights in all mirrors that they stand in front of, in world coordinates.

    Give the mirrors that turn away from the eye too: they send light all the same.
    Source: Glaeser, section 6.4.
    """
    found = []
    for source, light in enumerate(lights):
        given = 1.0 / np.sqrt(len(lights)) if light.intensity is None else light.intensity
        for plane in range(len(mirrors)):
            normal = matmul(view.axes.T, mirrors.normal[:, plane])
            place = np.asarray(light.position, dtype=np.float64)
            point = np.zeros(3) if light.parallel else view.world_of(mirrors.point[:, plane : plane + 1])[0]
            height = float(matmul(place - point, normal))
            size = float(np.abs(place).max()) if light.parallel else view.scale
            if height > view.tolerance * size:
                x, y, z = (place - 2.0 * height * normal).tolist()
                double = replace(light, position=(x, y, z), intensity=MIRRORED_SHARE * given, name=f"{light.name}*")
                found.append(LightDouble(double, source, plane))
    return tuple(found)


def mirror_light(
    view: View,
    mirrors: Mirrors,
    doubles: Sequence[LightDouble],
    projected: ProjectedFaces | None = None,
    off: Floats | None = None,
) -> Decals:
    """Where the light of doubles falls through the windows of their mirrors, on faces seen on the lit side: decals of
    the kind LIGHT, light the number of the double. On them, with light -1, lie the parts that the scene or its
    double keeps dark, to be painted as if there were no mirror. Both must still be clipped with the scene's shadows
    by patterns_in_shadows. off (i,): see cast_within.
    Edge cases: where several doubles shine only the last is painted. Source: Glaeser, section 6.4.
    """
    projected = project_faces(view) if projected is None else projected
    found: list[Decals] = []
    planes, seen = FacePlanes.of(view), drawn_faces(view, projected)
    # They are what shadows of the scene's own lights are clipped with.
    everywhere = np.ones(view.face_count, dtype=np.bool_)
    for number, double in enumerate(doubles):
        system = light_system(view, double.light)
        facing = system.facing(planes, view.tolerance)
        face = seen[facing[seen] * projected.facing[seen] > 0]
        lit = _through_windows(view, mirrors, double, number, system, face)
        if len(lit):
            obscured = _obscured(view, mirrors, double, lit.face, off)
            dark = in_shadows(view, lit, convex_decals(view, obscured, everywhere))
            nothing = np.zeros(len(dark), dtype=np.intp)
            found += [lit, replace(dark, light=nothing - 1, grade=nothing, lacking=nothing)]
    return joined_decals(*found)


def _through_windows(
    view: View, mirrors: Mirrors, double: LightDouble, number: int, system: LightSystem, face: Ints
) -> Decals:
    """The parts of faces before a mirror that the double of a light shines on through its windows."""
    window = mirrors.face[mirrors.plane == double.plane]
    corner, offsets = ragged.take(view.offsets, face)
    polygon, bundle = (grid.ravel() for grid in np.meshgrid(np.arange(len(face)), np.arange(len(window))))
    volumes = _window_volumes(view, mirrors, double.plane, window, system)
    parts = cut_by_planes(view.points[:, view.corners[corner]], offsets, volumes, polygon, bundle, view.tolerance)
    if not len(parts):
        return no_decals()
    zero = np.zeros(len(parts), dtype=np.intp)
    on = face[polygon[parts.pair]]
    return Decals(
        parts.points,
        parts.offsets,
        on,
        zero + FillKind.LIGHT,
        zero,
        zero + number,
        zero - 1,
        zero + 2 * number,
        lacking=zero,
    )


def _window_volumes(view: View, mirrors: Mirrors, plane: int, window: Ints, system: LightSystem) -> PlaneBundles:
    """What light from behind a mirror's plane reaches through faces in it: the cones of rays, before the mirror."""
    corner, offsets = ragged.take(view.offsets, window)
    start, end = view.points[:, view.corners[corner]], view.points[:, view.corners[view.after(corner)]]
    inwards = np.cross(mirrors.normal[:, plane, None], end - start, axis=0)
    normal = np.cross(end - start, system.towards(start), axis=0)
    normal *= np.sign((normal * inwards).sum(axis=0))
    front = planes_of(mirrors.normal[:, plane, None], mirrors.point[:, plane, None])
    last = offsets[1:]
    return PlaneBundles(np.insert(planes_of(normal, start), last, front, axis=1), offsets + np.arange(len(offsets)))


def _obscured(view: View, mirrors: Mirrors, double: LightDouble, lit: Ints, off: Floats | None) -> Decals:
    """The shadows that the scene before a mirror and its double behind it cast in the light of a double, on those faces
    of the view that it gets to."""
    height = mirrors.heights(double.plane, view.points)
    # Light leaves through the mirror, which in a body is not above its plane, and of an open thing is.
    pane = np.zeros(view.face_count, dtype=np.bool_)
    pane[mirrors.face[mirrors.plane == double.plane]] = True
    before, source = _casting_half(view, height, pane, view)
    behind, _ = _casting_half(view, height, pane, doubled(view, mirrors, double.plane))
    both = joined_views(before, behind)
    receivers = np.zeros(both.face_count, dtype=np.bool_)
    receivers[: len(source)] = np.isin(source, lit)
    if off is not None:
        # Faces that the plane cuts are those of an item more.
        off = np.tile(np.append(off, off.max(initial=0.0)), 2)
    cast = cast_within(both, [double.light], np.inf, receivers=receivers, off=off)
    shadows = shadow_decals_of(cast.shadows, FillKind.SHADOW)
    return replace(shadows, face=source[shadows.face])


def _casting_half(view: View, height: Floats, pane: Bools, placed: View) -> tuple[View, Ints]:
    """The occluding faces of a view on the upper side of a plane, but for the panes (f,) of the mirror in it, as they
    stand in a view of the same faces."""
    items = len(view.item_vertices) - 1
    upright = np.zeros(items)
    filled = np.flatnonzero(np.diff(view.item_vertices))
    if len(filled):
        upright[filled] = np.minimum.reduceat(height, view.item_vertices[:-1][filled])
    return half_of_view(placed, height, view.occludes[view.face_item] & ~pane, upright >= -view.tolerance)


def joined_views(one: View, two: View) -> View:
    """The faces of two views of one camera, those of the first one first."""
    return replace(
        one,
        points=np.concatenate([one.points, two.points], axis=1),
        corners=np.concatenate([one.corners, two.corners + one.points.shape[1]]),
        offsets=np.concatenate([one.offsets, two.offsets[1:] + one.offsets[-1]]),
        inner=np.concatenate([one.inner, two.inner]),
        face_item=np.concatenate([one.face_item, two.face_item + len(one.item_vertices) - 1]),
        item_vertices=np.concatenate([one.item_vertices, two.item_vertices[1:] + one.item_vertices[-1]]),
        occludes=np.concatenate([one.occludes, two.occludes]),
        face_look=None,
    )
