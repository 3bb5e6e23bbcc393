"""Shadows, patterns and light by way of mirrors on the faces of a scene and in mirrors, as filled polygons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.painted_colours import Lighting
from vectorplot.shading.shaded_faces import face_shades, view_lights
from vectorplot.visibility.projected_faces import ProjectedFaces

# The polygons that lie on the faces of a scene: shadows with their borders, patterns, light by way of mirrors.


def scene_shadows(
    view: View,
    items: Sequence[Item],
    lights: Sequence[Light],
    projected: ProjectedFaces,
    aura: float,
    off: Floats,
    budget: Budget = USUAL,
    receivers: Bools | None = None,
) -> Decals:
    """The shadows of opaque items, of every grade, with soft borders of some width in the image; off (i,): how far the
    faces of items may be off the surfaces that they stand for; receivers (f,): the faces that they may fall on (None:
    all). An InputWarning names the items (i,) for which the budget did not do."""
    from vectorplot.effects.shadows import cast_within, graded, shadow_decals_of, tell_missing_shadows
    from vectorplot.effects.soft_shadows import shadow_borders, united_shadows

    # Light goes through what is transparent: there patterns show shadows, and nothing else.
    shows = np.array([item.material.opacity >= 1.0 or bool(item.patterns) for item in items], dtype=np.bool_)
    shown = shows[view.shown_item] if receivers is None else receivers & shows[view.shown_item]
    cast = cast_within(view, lights, budget.pairs, receivers=shown, projected=projected, off=off)
    tell_missing_shadows(items, lights, cast.left_out)
    # Borders are made of the regions that cells are made of.
    single = cast.shadows if aura == 0.0 else united_shadows(view, cast.shadows)
    cells = graded(view, single)
    dark = shadow_decals_of(cells, FillKind.SHADOW)
    return dark if aura == 0.0 else joined_decals(dark, shadow_borders(view, single, cells, aura))


def scene_mirror_light(
    scene: Scene, view: View, projected: ProjectedFaces, lighting: Lighting, shadows: Decals
) -> tuple[Decals, tuple[Light, ...]]:
    """Where light falls by way of mirrors, and the doubles of lights that it comes from, in the view."""
    from vectorplot.effects.decals import united_decals
    from vectorplot.effects.mirror_lights import light_doubles, mirror_light
    from vectorplot.effects.mirrors import mirror_faces, mirrors_of
    from vectorplot.effects.patterns import patterns_in_shadows

    mirrors = mirrors_of(view, mirror_faces(scene, view))
    doubles = light_doubles(view, mirrors, scene.lights)
    lit = mirror_light(view, mirrors, doubles, projected)
    # Many small shadows on a face make few regions, each of which has to be cut with each part of the light.
    shadows = united_decals(view, shadows)
    nowhere = np.zeros(view.face_count, dtype=np.bool_)
    lights = tuple(double.light for double in doubles)
    return patterns_in_shadows(view, lit, shadows, nowhere, len(scene.lights)), view_lights(
        view, lights
    ) if lights else ()


def scene_patterns(scene: Scene, view: View, lighting: Lighting, shadows: Decals) -> Decals:
    """The patterns of all items, dark where shadows fall on them."""
    from vectorplot.effects.patterns import pattern_decals

    return shadowed_patterns(scene, view, lighting, pattern_decals(scene, view), shadows)


def shadowed_patterns(scene: Scene, view: View, lighting: Lighting, patterns: Decals, shadows: Decals) -> Decals:
    """Patterns on faces of a view, dark where shadows fall on them."""
    from vectorplot.effects.patterns import patterns_in_shadows

    found = face_shades(view, lighting.items, lighting.lights)
    lights = len(scene.lights)
    dark: Bools = np.asarray(found.backlit.all(axis=0) & (lights > 0), dtype=np.bool_)
    return patterns_in_shadows(view, patterns, shadows, dark, lights)
