"""Light on a scene, and what keeps it off: shadow buffers, and exact shadows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry.cameras.coordinate_system import CoordinateSystem
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.lighting import Blocked, Lighting, lighting_of
from vectorplot.shading.raster.scene_triangles import SceneTriangles
from vectorplot.shading.shadows.map_settings import MapSettings
from vectorplot.stages.walk import Walk

if TYPE_CHECKING:
    from vectorplot.shading.shadows.seen_region import SeenRegion


@dataclass(frozen=True, eq=False)
class ShadowMaps:
    """How shadows of some triangles are found: by which way, with what maps, tapered for what is seen (None: not).
    sides (i,): of items that are closed, as of outer_sides."""

    triangles: SceneTriangles
    lights: tuple[Light, ...]
    shadows: str
    settings: MapSettings
    region: SeenRegion | None
    sides: Ints

    def of_items(self, casts: Bools) -> tuple[Blocked, ...]:
        """For every light what it does not reach as items (i,) stand before it."""
        triangles = self.triangles
        shown = casts[triangles.item]
        if self.shadows == "exact":
            from vectorplot.shading.shadows.shadow_rays import exact_shadows

            number = np.where(shown, np.cumsum(shown) - 1, -1)
            return exact_shadows(self.lights, triangles.points, triangles.corners[shown], number)
        from vectorplot.shading.shadows.shadow_buffer import shadow_buffers

        side, corners = self.sides[triangles.item[shown]], triangles.corners[shown]
        settings = self.settings
        if settings.casting == "away":
            # Which way a face turns is known of closed bodies only.
            settings = settings if (side != 0).all() else replace(settings, casting="all")
            corners = np.where((side < 0)[:, None], corners[:, ::-1], corners)
        return shadow_buffers(self.lights, triangles.points, corners, settings, self.region)

    def of_clear_items(self, scene: Scene) -> tuple[tuple[str, float, tuple[Blocked, ...]], ...]:
        """The same for what light comes through: colours and opacities, and what is dimmed by things that have them."""
        groups: dict[tuple[str, float], Bools] = {}
        for number, item in enumerate(scene.items):
            if item.dims_light:
                same = (item.colour, item.material.opacity)
                groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
        return tuple((colour, opacity, self.of_items(casts)) for (colour, opacity), casts in groups.items())


def scene_lighting(walk: Walk, scene: Scene, view: View, maps: ShadowMaps) -> Lighting:
    """The lights and their shadows, as far as the plan has any."""
    blocked: tuple[Blocked, ...] = ()
    clear: tuple[tuple[str, float, tuple[Blocked, ...]], ...] = ()
    if walk.calls_for("shadows"):
        casts = np.array([item.casts_shadow for item in scene.items], dtype=np.bool_)
        blocked = walk.run("shadows", maps.of_items, casts)
    if walk.calls_for("transparent shadows"):
        clear = walk.run("transparent shadows", maps.of_clear_items, scene)
    return lighting_of(view, scene.items, maps.lights, blocked, clear)


def tapered_for(
    triangles: SceneTriangles, system: CoordinateSystem, size: tuple[int, int], shadows: str
) -> SeenRegion | None:
    """What is seen, for shadow maps that are tapered for it; None for others."""
    if shadows != "trapezoid":
        return None
    from vectorplot.shading.shadows.seen_region import region_in_picture

    return region_in_picture(system, *size, triangles.points, triangles.corners)
