"""The polygons of a picture in their colours, with all that lies on them and is seen in them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, fills_on_page, stacked
from vectorplot.geometry.budget import Budget
from vectorplot.painting.painted_paper import background, paper
from vectorplot.painting.seen import Seen, finer, off_surfaces, shades_of_faces
from vectorplot.painting.shade_errors import shade_error_steps
from vectorplot.painting.stepped import stepped
from vectorplot.scene.pages.page import Page
from vectorplot.shading.light.fineness.refinement import shade_error
from vectorplot.shading.light.painted_colours import Lighting, colours_of, opacities
from vectorplot.stages.walk import Walk

if TYPE_CHECKING:
    from vectorplot.effects.decals.decal_polygons import Decals


def coloured(
    walk: Walk, seen: Seen, lighting: Lighting, page: Page, aura_mm: float, tolerance_mm: float, budget: Budget
) -> Overlay:
    """The polygons of the picture in their colours, with all that lies on them and is seen in them; after: the polygon
    whose steps of shade they are, -1 for what lies on such, is seen in them, or is paper."""
    seen = replace(seen, faces=finer(seen, lighting, budget.facets, shade_error(tolerance_mm)))
    shades = walk.run("shades", shades_of_faces, seen, lighting).total
    walk.measured("shades", "of 255", shade_error_steps, seen, lighting)
    seen, shades, whole = stepped(seen, lighting, shades)
    aura = aura_mm / seen.placement.scale
    decals, lighting = _decals(walk, seen, lighting, aura, tolerance_mm, budget)
    laid = _laid(seen, lighting, decals)
    overlays = _overlays(walk, seen, lighting, decals, aura, tolerance_mm, budget)
    painted = walk.run("fills", _fills, walk, seen, lighting, shades, laid, overlays, page)
    # A face comes before all that lies on it.
    is_face = (painted.after >= 0) & (np.diff(painted.after, prepend=-1) != 0)
    return replace(painted, after=np.where(is_face, np.append(whole, -1)[painted.after], -1))


def _decals(
    walk: Walk, seen: Seen, lighting: Lighting, aura: float, tolerance_mm: float, budget: Budget
) -> tuple[tuple[Decals, ...], Lighting]:
    """The polygons that lie on faces, in the order in which they are painted."""
    scene, view, projected = seen.scene, seen.view, seen.projected
    found: list[Decals] = []
    if walk.calls_for("shadows"):
        from vectorplot.effects.decals.scene_decals import scene_shadows

        off = off_surfaces(seen, tolerance_mm)
        found.append(walk.run("shadows", scene_shadows, view, scene.items, scene.lights, projected, aura, off, budget))
    if walk.calls_for("mirror light"):
        from vectorplot.effects.decals.scene_decals import scene_mirror_light

        lit, doubles = walk.run("mirror light", scene_mirror_light, scene, view, projected, lighting, found[0])
        found.append(lit)
        lighting = replace(lighting, doubles=doubles)
    if walk.calls_for("patterns"):
        from vectorplot.effects.decals.decal_polygons import joined_decals
        from vectorplot.effects.decals.scene_decals import scene_patterns

        found.append(walk.run("patterns", scene_patterns, scene, view, lighting, joined_decals(*found[:1])))
    if walk.calls_for("transparent shadows"):
        from vectorplot.effects.shadows.transparent_shadows import transparent_shadows

        clear = partial(transparent_shadows, projected=projected, budget=budget)
        found.append(walk.run("transparent shadows", clear, view, scene, scene.lights, found[0] if found else None))
    return tuple(found), lighting


def _laid(seen: Seen, lighting: Lighting, decals: tuple[Decals, ...]) -> tuple[Overlay, ...]:
    """What lies on the polygons of the picture."""
    if not decals:
        return ()
    from vectorplot.effects.decals.decal_fills import decal_fills

    return tuple(decal_fills(seen.view, lighting, some, seen.faces, seen.placement) for some in decals)


def _overlays(
    walk: Walk,
    seen: Seen,
    lighting: Lighting,
    decals: tuple[Decals, ...],
    aura: float,
    tolerance_mm: float,
    budget: Budget,
) -> tuple[Overlay, ...]:
    """What polygons of the picture show, painted right after them and what lies on them.

    aura: the width of soft borders of shadows in the image.
    """
    found = []
    if walk.calls_for("reflections"):
        from vectorplot.effects.mirrors.reflected_decals import double_decals
        from vectorplot.effects.mirrors.reflection_fills import reflection_fills
        from vectorplot.effects.mirrors.reflections import mirrors

        shown = mirrors(seen.scene, seen.view, seen.projected)
        borders = aura if walk.calls_for("shadows") else None
        off = off_surfaces(seen, tolerance_mm)

        def decals_of(number: int, there: Lighting, which: Bools) -> tuple[Decals, ...]:
            return double_decals(seen.scene, seen.view, shown, number, there, which, borders, off, budget)

        found.append(
            walk.run("reflections", reflection_fills, seen.view, lighting, shown, decals_of, seen.faces, seen.placement)
        )
    if walk.calls_for("refraction"):
        from vectorplot.effects.glass.glass_fills import glass_fills

        found.append(
            walk.run(
                "refraction",
                glass_fills,
                seen.scene,
                seen.view,
                seen.projected,
                lighting,
                seen.faces,
                seen.placement,
                tolerance_mm,
                decals,
            )
        )
    return tuple(found)


def _fills(
    walk: Walk,
    seen: Seen,
    lighting: Lighting,
    shades: Floats,
    laid: tuple[Overlay, ...],
    overlays: tuple[Overlay, ...],
    page: Page,
) -> Overlay:
    """The polygons of the picture on the page, with what lies on them and what is painted between them."""
    view, faces = seen.view, seen.faces
    item = view.face_item[faces.source]
    opacity = opacities(seen.scene.items)[item]
    fills = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=colours_of(view, lighting, np.repeat(faces.source, np.diff(faces.offsets)), shades),
        opacity=opacity,
        item=item,
        kind=np.where(opacity < 1.0, int(FillKind.GLASS), int(FillKind.FACE)),
    )
    if walk.calls_for("reflections"):
        from vectorplot.effects.mirrors.reflection_fills import silvered
        from vectorplot.effects.mirrors.reflections import mirrors

        panes = np.isin(faces.source, mirrors(seen.scene, view, seen.projected).face)
        fills, laid = silvered(fills, panes, paper(seen.scene)[0], laid)
    if walk.calls_for("refraction"):
        from vectorplot.effects.glass.glass_fills import tinted
        from vectorplot.effects.glass.glass_polygons import refracting_items

        clear = refracting_items(seen.scene, view, seen.projected)[item]
        fills, both = tinted(fills, clear, opacity, paper(seen.scene)[0], (*laid, *overlays))
        laid, overlays = both[: len(laid)], both[len(laid) :]
    with_decals = stacked([Overlay(fills, np.arange(len(fills))), *(laid if walk.calls_for("visible fills") else ())])
    if not walk.calls_for("visible fills"):
        from vectorplot.drawing.flattened import flattened

        world, plane = seen.placement.page_from_world, lighting.plane[faces.source]
        with_decals = flattened(fills, laid, world, plane)
    every, below = stacked([with_decals, *overlays]), background(seen.scene, page)
    return Overlay(Fills.joined(*below, every.fills), np.concatenate([np.full(len(below), -1), every.after]))
