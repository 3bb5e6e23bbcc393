"""The polygons that lie on the faces that a mirror shows: shadows on sides that the eye does not see are among them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.effects.decals.decal_polygons import Decals, joined_decals
from vectorplot.effects.mirrors.reflections import Mirrors, doubled
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.painted_colours import Lighting
from vectorplot.visibility.projected_faces import project_faces


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
    """The decals on the doubles of faces shown (f,), in the double of the view: those of a mirrored scene in mirrored
    light, of which the same holds as of the scene.

    lighting: as it is in the mirror; aura: the width of soft borders in the image, None where lights cast no shadows;
    off (i,) as of scene_shadows; budget: of the work on these.
    Source: Glaeser, section 6.4.
    """
    mirrored = doubled(view, mirrors, number)
    lights = () if aura is None else tuple(_in_world(view, light) for light in lighting.lights[: len(scene.lights)])
    projected = project_faces(mirrored)
    found: list[Decals] = []
    if lights and aura is not None:
        from vectorplot.effects.decals.scene_decals import scene_shadows

        found.append(scene_shadows(mirrored, scene.items, lights, projected, aura, off, budget, shown))
    if any(item.patterns for item in scene.items):
        from vectorplot.effects.decals.pattern_decals import pattern_decals
        from vectorplot.effects.decals.scene_decals import shadowed_patterns

        patterns = pattern_decals(scene, view)
        patterns = replace(patterns, points=mirrors.reflected(number, patterns.points))
        found.append(shadowed_patterns(scene, mirrored, lighting, patterns, joined_decals(*found)))
    if lights and any(item.material.opacity < 1.0 for item in scene.items):
        from vectorplot.effects.shadows.transparent_shadows import transparent_shadows

        found.append(
            transparent_shadows(mirrored, scene, lights, found[0], receivers=shown, projected=projected, budget=budget)
        )
    return tuple(found)


def _in_world(view: View, light: Light) -> Light:
    """A light of the view in the world's coordinates."""
    place: Floats = np.array(light.position, dtype=np.float64)
    x, y, z = (matmul(view.axes.T, place) if light.parallel else view.world_of(place[:, None])[0]).tolist()
    return replace(light, position=(x, y, z))
