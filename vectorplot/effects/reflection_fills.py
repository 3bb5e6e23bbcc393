"""What mirrors show, as filled polygons on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.fill_visibility import flattened
from vectorplot.drawing.fills import Colours as Colours_of_fills
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.effects.decals import Decals, joined_decals
from vectorplot.effects.mirrors import DIMMED, Mirrors, backwards, doubled, reflections
from vectorplot.effects.scene_decals import decal_fills, scene_shadows, shadowed_patterns
from vectorplot.effects.windows import SeenThrough, mixed, seen_fills
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.facet_resolution import SHORTEST_MM, refined
from vectorplot.shading.painted_colours import Lighting
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.projected_faces import project_faces

DecalsOf = Callable[[int, Lighting, Bools], Sequence[Decals]]
"""The decals, in the double of a view, on what the mirror with a number shows; the light there; (f,) the faces."""


WEAK_ON_MIRRORS = (FillKind.SHADOW, FillKind.SHADOW_BORDER, FillKind.CLEAR_SHADOW, FillKind.LIGHT)
"""What hardly shows on mirrors."""


def reflection_fills(
    view: View, lighting: Lighting, mirrors: Mirrors, decals_of: DecalsOf, faces: ImageFaces, placement: Placement
) -> Overlay:
    """The doubles of all faces in mirrors, with the decals that lie on them, dimmed.

    The doubles are the faces of a mirrored scene in mirrored light: what holds for the scene holds for them. Other
    shadows fall on them than the eye sees, where it does not see the same sides.
    Source: Glaeser, section 6.4, figures 7 and 8.
    """
    seen = reflections(view, mirrors, faces)
    plane_of = np.full(view.face_count, -1, dtype=np.intp)
    plane_of[mirrors.face] = mirrors.plane
    parts = []
    for number in range(len(mirrors)):
        here = seen.take(np.flatnonzero(plane_of[seen.pane] == number))
        if len(here):
            there = _mirrored_light(view, lighting, mirrors, number)
            shown = np.isin(np.arange(view.face_count), here.source)
            decals = decals_of(number, there, shown)
            parts.append(_of_double(doubled(view, mirrors, number), there, decals, here, placement))
    if not parts:
        return Overlay(Fills.empty(), np.zeros(0, dtype=np.intp))
    return Overlay(Fills.joined(*(part.fills for part in parts)), np.concatenate([part.after for part in parts]))


def silvered(
    fills: Fills, pane: Bools, paper: Colours_of_fills, overlays: Sequence[Overlay]
) -> tuple[Fills, tuple[Overlay, ...]]:
    """Painted polygons, those of mirrors (m,) as they show the paper, and overlays, shadows and light on mirrors as
    weak as their own colours are: where a mirror shows nothing else it shows the paper, DIMMED."""
    base = mixed(fills, np.broadcast_to(paper, (len(fills), 3)), np.where(pane, DIMMED, 0.0))
    return base, tuple(_on_mirrors(overlay, pane, paper) for overlay in overlays)


def _on_mirrors(overlay: Overlay, pane: Bools, paper: Colours_of_fills) -> Overlay:
    fills = overlay.fills
    weak = pane[overlay.after] & np.isin(fills.kind, WEAK_ON_MIRRORS)
    found = mixed(fills, np.broadcast_to(paper, (len(fills), 3)), np.where(weak & (fills.opacity == 1.0), DIMMED, 0.0))
    veil = np.where(weak & (fills.opacity < 1.0), 1.0 - DIMMED, 1.0)
    return replace(overlay, fills=replace(found, opacity=veil * fills.opacity))


def _of_double(
    mirrored: View, lighting: Lighting, decals: Sequence[Decals], seen: SeenThrough, placement: Placement
) -> Overlay:
    points, offsets, parent = refined(
        mirrored, lighting, seen.points, seen.offsets, seen.source, SHORTEST_MM / placement.scale, USUAL.facets
    )
    seen = replace(seen.take(parent), points=points, offsets=offsets)
    shown = seen_fills(mirrored, lighting, seen, placement, FillKind.REFLECTION)
    laid = [decal_fills(mirrored, lighting, some, seen, placement) for some in decals]
    whole = shown
    if laid:
        flat = flattened(shown.fills, laid, placement.page_from_world)
        whole = Overlay(flat.fills, shown.after[flat.after])
    count = len(whole.fills)
    dimmed = np.rint(DIMMED * whole.fills.colours).astype(np.uint8)
    return replace(whole, fills=replace(whole.fills, colours=dimmed, kind=np.full(count, int(FillKind.REFLECTION))))


def _mirrored_light(view: View, lighting: Lighting, mirrors: Mirrors, number: int) -> Lighting:
    """Lights and normals as they are in the mirror."""
    lights = tuple(replace(light, position=_reflected(light, mirrors, number)) for light in lighting.lights)
    return replace(lighting, lights=lights, normals=_turned(lighting.normals[:, backwards(view)], mirrors, number))


def _reflected(light: Light, mirrors: Mirrors, number: int) -> tuple[float, float, float]:
    place = np.array(light.position, dtype=np.float64)[:, None]
    found = _turned(place, mirrors, number) if light.parallel else mirrors.reflected(number, place)
    x, y, z = found[:, 0].tolist()
    return (x, y, z)


def _turned(directions: Floats, mirrors: Mirrors, number: int) -> Floats:
    """(3,n) directions as they are in the mirror."""
    normal = mirrors.normal[:, number]
    return np.asarray(directions - 2.0 * normal[:, None] * (matmul(normal, directions)))


# The polygons that lie on the faces that a mirror shows: shadows on sides that the eye does not see are among them.


def double_decals(
    scene: Scene,
    view: View,
    mirrors: Mirrors,
    number: int,
    lighting: Lighting,
    shown: Bools,
    aura: float | None,
    off: Floats,
    budget: Budget = USUAL,
) -> tuple[Decals, ...]:
    """The decals on the doubles of faces shown (f,): those of the mirrored scene in mirrored light. lighting: in the
    mirror; aura: the width of soft borders in the image, None without shadows; off (i,): see scene_shadows; budget:
    of the work. Source: Glaeser, section 6.4.
    """
    mirrored = doubled(view, mirrors, number)
    lights = () if aura is None else tuple(_in_world(view, light) for light in lighting.lights[: len(scene.lights)])
    projected = project_faces(mirrored)
    found: list[Decals] = []
    if lights and aura is not None:
        found.append(scene_shadows(mirrored, scene.items, lights, projected, aura, off, budget, shown))
    if any(item.patterns for item in scene.items):
        from vectorplot.effects.patterns import pattern_decals

        patterns = pattern_decals(scene, view)
        patterns = replace(patterns, points=mirrors.reflected(number, patterns.points))
        found.append(shadowed_patterns(scene, mirrored, lighting, patterns, joined_decals(*found)))
    if lights and any(item.material.opacity < 1.0 for item in scene.items):
        from vectorplot.effects.shadows import transparent_shadows

        found.append(
            transparent_shadows(mirrored, scene, lights, found[0], receivers=shown, projected=projected, budget=budget)
        )
    return tuple(found)


def _in_world(view: View, light: Light) -> Light:
    """A light of the view in the world's coordinates."""
    place: Floats = np.array(light.position, dtype=np.float64)
    x, y, z = (matmul(view.axes.T, place) if light.parallel else view.world_of(place[:, None])[0]).tolist()
    return replace(light, position=(x, y, z))
