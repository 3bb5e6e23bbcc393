"""What mirrors show, as filled polygons on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.fill_visibility import flattened
from vectorplot.drawing.fills import Colours as Colours_of_fills
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.effects.decals import Decals, joined_decals
from vectorplot.effects.mirrors import DIMMED, Mirrors, backwards, doubled, mirrors_of, reflections
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
from vectorplot.visibility.painter.image_faces import ImageFaces, polygons_of
from vectorplot.visibility.projected_faces import project_faces

Moved = Callable[[Floats], Floats]
"""Where points (3,n) of a view are in a double of it."""

DecalsOf = Callable[[View, Moved, Lighting, Bools], Sequence[Decals]]
"""The decals in a double of a view: the double, where points are there, and the light; (f,) the faces they are for."""


WEAK_ON_MIRRORS = (FillKind.SHADOW, FillKind.SHADOW_BORDER, FillKind.CLEAR_SHADOW, FillKind.LIGHT)
"""What hardly shows on mirrors."""


def reflection_fills(
    view: View,
    lighting: Lighting,
    mirrors: Mirrors,
    decals_of: DecalsOf,
    faces: ImageFaces,
    placement: Placement,
    paper: Colours_of_fills,
    reflections_left: int = 1,
    moved: Moved = np.asarray,
) -> Overlay:
    """The doubles of all faces in mirrors, with the decals that lie on them, dimmed; paper (1,3): the colour of what
    mirrors show where nothing is; reflections_left: with 1 mirrors in mirrors are plain faces, with more they show so
    many less; moved: where points of the scene's view are in this one.

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
            double, there = doubled(view, mirrors, number), _mirrored_light(view, lighting, mirrors, number)
            way = partial(_moved_on, mirrors, number, moved)
            shown = np.isin(np.arange(view.face_count), here.source)
            decals = decals_of(double, way, there, shown)
            deeper = None
            if reflections_left > 1:
                deeper = _in_double(double, there, decals_of, here, placement, paper, reflections_left - 1, way)
            parts.append(_of_double(double, there, decals, here, placement, deeper, paper))
    if not parts:
        return Overlay(Fills.empty(), np.zeros(0, dtype=np.intp))
    return Overlay(Fills.joined(*(part.fills for part in parts)), np.concatenate([part.after for part in parts]))


def _moved_on(mirrors: Mirrors, number: int, moved: Moved, points: Floats) -> Floats:
    return mirrors.reflected(number, moved(points))


@dataclass(frozen=True, eq=False)
class _Deeper:
    """What mirrors show that are seen in a mirror: which faces (f,) they are, and what comes after polygons there."""

    pane: Bools
    shown: Overlay


def _in_double(
    double: View,
    lighting: Lighting,
    decals_of: DecalsOf,
    here: SeenThrough,
    placement: Placement,
    paper: Colours_of_fills,
    reflections_left: int,
    moved: Moved,
) -> _Deeper:
    """What the mirrors show that are among the polygons of a double."""
    face = np.unique(here.source)
    shines = np.array([item.material.is_mirror for item in lighting.items], dtype=np.bool_)[double.shown_item[face]]
    mirrors = mirrors_of(double, face[shines & (project_faces(double).facing[face] > 0)])
    polygons = polygons_of(here.points, here.offsets, np.arange(len(here)), double.tolerance)
    painted = replace(polygons, source=here.source[polygons.source])
    found = reflection_fills(double, lighting, mirrors, decals_of, painted, placement, paper, reflections_left, moved)
    pane = np.isin(np.arange(double.face_count), mirrors.face)
    return _Deeper(pane, replace(found, after=polygons.source[found.after]))


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
    mirrored: View,
    lighting: Lighting,
    decals: Sequence[Decals],
    seen: SeenThrough,
    placement: Placement,
    deeper: _Deeper | None,
    paper: Colours_of_fills,
) -> Overlay:
    points, offsets, parent = refined(
        mirrored, lighting, seen.points, seen.offsets, seen.source, SHORTEST_MM / placement.scale, USUAL.facets
    )
    seen = replace(seen.take(parent), points=points, offsets=offsets)
    shown = seen_fills(mirrored, lighting, seen, placement, FillKind.REFLECTION)
    laid = [decal_fills(mirrored, lighting, some, seen, placement) for some in decals]
    if deeper is not None:
        fills, weak = silvered(shown.fills, deeper.pane[seen.source], paper, laid)
        shown, laid = replace(shown, fills=fills), list(weak)
    polygon, whole = parent, shown
    if laid:
        flat = flattened(shown.fills, laid, placement.page_from_world)
        polygon, whole = parent[flat.after], Overlay(flat.fills, shown.after[flat.after])
    if deeper is not None and len(deeper.shown.fills):
        window = np.zeros(int(parent.max(initial=-1)) + 1, dtype=np.intp)
        window[parent] = shown.after
        order = np.argsort(np.concatenate([polygon, deeper.shown.after]), kind="stable")
        after = np.concatenate([whole.after, window[deeper.shown.after]])
        whole = Overlay(Fills.joined(whole.fills, deeper.shown.fills).take(order), after[order])
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
    mirrored: View,
    moved: Moved,
    lighting: Lighting,
    shown: Bools,
    aura: float | None,
    off: Floats,
    budget: Budget = USUAL,
) -> tuple[Decals, ...]:
    """The decals on the doubles of faces shown (f,): those of a mirrored scene in mirrored light. mirrored: the double
    of the view; moved: where points are in it; lighting: there; aura: the width of soft borders in the image, None
    without shadows; off (i,): see scene_shadows; budget: of the work. Source: Glaeser, section 6.4.
    """
    lights = () if aura is None else tuple(_in_world(view, light) for light in lighting.lights[: len(scene.lights)])
    projected = project_faces(mirrored)
    found: list[Decals] = []
    if lights and aura is not None:
        found.append(scene_shadows(mirrored, scene.items, lights, projected, aura, off, budget, shown))
    if any(item.patterns for item in scene.items):
        from vectorplot.effects.patterns import pattern_decals

        patterns = pattern_decals(scene, view)
        patterns = replace(patterns, points=moved(patterns.points))
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
