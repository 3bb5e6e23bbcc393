"""Decals as filled polygons on the page, each painted after the polygon it lies on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, fills_on_page
from vectorplot.effects.decals import Decals, Laid, convex_decals, laid
from vectorplot.effects.windows import SeenThrough
from vectorplot.geometry import ragged
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.illumination import LEVELS, shadow_shades
from vectorplot.shading.painted_colours import Lighting, colours_of, corner_shades_of, opacities, smooth_faces
from vectorplot.shading.palettes import COLOUR_MAP, Colours, shaded_colours
from vectorplot.shading.shaded_faces import Shades
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points


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
