"""Shadows, patterns and light by way of mirrors on the faces of a scene and in mirrors, as filled polygons."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, fills_on_page
from vectorplot.effects.decals import Decals, Laid, convex_decals, joined_decals, laid
from vectorplot.effects.windows import SeenThrough
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.illumination import LEVELS, shadow_shades
from vectorplot.shading.painted_colours import Lighting, colours_of, corner_shades_of, opacities, smooth_faces
from vectorplot.shading.palettes import COLOUR_MAP, Colours, shaded_colours
from vectorplot.shading.shaded_faces import Shades, face_shades, view_lights
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
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
    overlapping: Bools | None = None,
) -> Decals:
    """The shadows of opaque items, of every grade, with soft borders of some width in the image; off (i,): how far the
    faces of items may be off the surfaces that they stand for; receivers (f,): the faces that they may fall on (None:
    all); overlapping (f,): as in graded. An InputWarning names the items (i,) for which the budget did not do."""
    from vectorplot.effects.shadows import cast_within, graded, shadow_decals_of, tell_missing_shadows
    from vectorplot.effects.soft_shadows import shadow_borders, united_shadows

    # Light goes through what is transparent: there patterns show shadows, and nothing else.
    shows = np.array([item.material.opacity >= 1.0 or bool(item.patterns) for item in items], dtype=np.bool_)
    shown = shows[view.shown_item] if receivers is None else receivers & shows[view.shown_item]
    cast = cast_within(view, lights, budget.pairs, receivers=shown, projected=projected, off=off)
    tell_missing_shadows(items, lights, cast.left_out)
    # Borders are made of the regions that cells are made of.
    single = cast.shadows if aura == 0.0 else united_shadows(view, cast.shadows)
    cells = graded(view, single, overlapping)
    dark = shadow_decals_of(cells, FillKind.SHADOW)
    return dark if aura == 0.0 else joined_decals(dark, shadow_borders(view, single, cells, aura))


def scene_mirror_light(
    scene: Scene, view: View, projected: ProjectedFaces, lighting: Lighting, shadows: Decals, off: Floats
) -> tuple[Decals, tuple[Light, ...]]:
    """Where light falls by way of mirrors, and the doubles of lights that it comes from, in the view; off (i,) as of
    scene_shadows."""
    from vectorplot.effects.decals import united_decals
    from vectorplot.effects.mirror_lights import light_doubles, mirror_light
    from vectorplot.effects.mirrors import mirror_faces, mirrors_of
    from vectorplot.effects.patterns import patterns_in_shadows

    mirrors = mirrors_of(view, mirror_faces(scene, view))
    doubles = light_doubles(view, mirrors, scene.lights)
    lit = mirror_light(view, mirrors, doubles, projected, off)
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


# Decals as filled polygons on the page, each painted after the polygon it lies on.


def decal_fills(
    view: View, lighting: Lighting, decals: Decals, faces: ImageFaces | SeenThrough, placement: Placement
) -> Overlay:
    """Decals on what is painted of their faces, in the shades of their faces, those that lack lights darker.

    faces: the painted polygons. On transparent faces there are patterns only: light goes through them.
    Source: Glaeser, sections 6.3, 6.5 and 6.6.
    """
    decals = shown_decals(view, lighting, decals)
    parts = laid(view, decals, faces.points, faces.offsets, faces.source)
    return Overlay(laid_fills(view, lighting, decals, parts, placement), parts.piece)


def shown_decals(view: View, lighting: Lighting, decals: Decals) -> Decals:
    """Those of decals that show, as convex polygons: on transparent faces there are patterns only."""
    opaque = opacities(lighting.items)[view.shown_item[decals.face]] >= 1.0
    decals = decals.of(np.flatnonzero(opaque | (decals.kind == FillKind.PATTERN)))
    return convex_decals(view, decals, smooth_faces(view, lighting.normals))


def laid_fills(view: View, lighting: Lighting, decals: Decals, parts: Laid, placement: Placement) -> Fills:
    """Parts of decals in the shades of their faces, those that lack lights darker."""
    points = view_points(view, parts.points)
    shades = corner_shades_of(view, lighting, points, parts.offsets, decals.face[parts.decal])
    shade = _shades(decals, parts, shades)
    for number in np.unique(decals.light[(decals.kind == FillKind.LIGHT) & (decals.light >= 0)]).tolist():
        corner, brighter = _with_double(view, lighting, decals, parts, points, shades, number)
        shade[..., corner] = brighter
    return fills_on_page(
        view,
        parts.points,
        parts.offsets,
        placement,
        colours=_colours(view, lighting, decals, parts, shade),
        opacity=decals.opacities[parts.decal],
        item=view.face_item[decals.face[parts.decal]],
        kind=decals.kind[parts.decal],
    )


def _shades(decals: Decals, parts: Laid, shades: Shades) -> Floats:
    """(c,) the shades at the corners of parts of decals; in coloured light (3,c)."""
    sizes = np.diff(parts.offsets)
    lacking = np.repeat(decals.lights_lacking[parts.decal], sizes)
    border = decals.kind[parts.decal] == FillKind.SHADOW_BORDER
    dimmed = np.repeat(np.where(border, decals.light[parts.decal], -1), sizes)
    step = np.repeat(np.where(border, decals.level[parts.decal] % LEVELS, 1), sizes)
    dark = shadow_shades(
        _without_highlights(shades, lacking), shades.intensity, lacking, shades.cue, dimmed=dimmed, step=step
    )
    return np.where((lacking > 0) | (dimmed >= 0), dark, shades.total)


def _without_highlights(shades: Shades, lacking: Ints) -> Floats:
    """(l,n) the shares of points, without highlights of the lights that do not get there."""
    number = np.arange(len(shades.shares))[:, None]
    return np.where((lacking[None] >> number) & 1 == 1, shades.matt, shades.shares)


def _with_double(
    view: View, lighting: Lighting, decals: Decals, parts: Laid, points: Floats, shades: Shades, number: int
) -> tuple[Ints, Floats]:
    """The corners (n,) where the double of a light in a mirror shines too, and their shades (n,) or (3,n)."""
    kind, of = decals.kind[parts.decal], decals.light[parts.decal]
    lit = np.flatnonzero((kind == FillKind.LIGHT) & (of == number))
    corner, offsets = ragged.take(parts.offsets, lit)
    only = replace(lighting, lights=(lighting.doubles[number],))
    own = corner_shades_of(view, only, points[:, corner], offsets, decals.face[parts.decal[lit]])
    lacking = np.repeat(decals.lights_lacking[parts.decal[lit]], np.diff(offsets))
    here = replace(shades, shares=shades.shares[:, corner], matt=shades.matt[:, corner])
    shares = np.concatenate([_without_highlights(here, lacking), own.shares])
    # White lights beside coloured ones send as much of red, green and blue.
    one, other = shades.intensity, own.intensity
    if one.ndim != other.ndim:
        one, other = (np.tile(some[:, None], 3) if some.ndim == 1 else some for some in (one, other))
    intensity = np.concatenate([one, other])
    return corner, shadow_shades(shares, intensity, lacking, shades.cue[corner])


def _colours(view: View, lighting: Lighting, decals: Decals, parts: Laid, shade: Floats) -> Colours:
    """(c,3) the colours at the corners of parts of decals: their own, or those of their faces; in the soft borders of
    shadows without steps of palettes."""
    sizes = np.diff(parts.offsets)
    colour = np.repeat(decals.colour[parts.decal], sizes)
    face = np.repeat(decals.face[parts.decal], sizes)
    found = colours_of(view, lighting, face, shade)
    soft = np.flatnonzero(np.repeat(decals.kind[parts.decal] == FillKind.SHADOW_BORDER, sizes))
    if len(soft):
        found[soft] = colours_of(view, replace(lighting, size=COLOUR_MAP), face[soft], shade[..., soft])
    own = np.flatnonzero(colour >= 0)
    if len(own):
        found[own] = shaded_colours(decals.colours, colour[own], shade[..., own], lighting.size)
    return found
