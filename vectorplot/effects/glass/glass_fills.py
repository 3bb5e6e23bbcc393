"""What is seen in and behind transparent solids, as filled polygons on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.drawing.united_fills import united
from vectorplot.effects.decals.decal_fills import laid_fills, shown_decals
from vectorplot.effects.decals.decal_polygons import Decals, joined_decals
from vectorplot.effects.decals.decals_on_pieces import Laid
from vectorplot.effects.glass.glass_polygons import seen_in_glass
from vectorplot.effects.windows.window_fills import mixed, seen_fills
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.painted_colours import Lighting
from vectorplot.shading.light.palettes import Colours
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.projected_faces import ProjectedFaces


def glass_fills(
    scene: Scene,
    view: View,
    projected: ProjectedFaces,
    lighting: Lighting,
    faces: ImageFaces,
    placement: Placement,
    tolerance_mm: float,
    decals: Sequence[Decals] = (),
) -> Overlay:
    """What refracting solids show, after the painted polygons of their front faces.

    tolerance_mm: how far sides of refracted polygons may be off the curves that they stand for; decals: what lies on
    faces, in the order in which it is painted.
    Source: Glaeser, section 6.6, figure 12.
    """
    shown = [shown_decals(view, lighting, some) for some in decals]
    lying = joined_decals(*(some.of(some.painting_order) for some in shown))
    seen = seen_in_glass(scene, view, projected, faces, tolerance_mm / placement.scale, lying)
    bare, marked = np.flatnonzero(seen.decal < 0), np.flatnonzero(seen.decal >= 0)
    base = seen_fills(view, lighting, seen.some(bare), placement, FillKind.GLASS).fills
    marks = seen.some(marked)
    laid = laid_fills(view, lighting, lying, Laid(marks.points, marks.offsets, marks.decal, marks.window), placement)
    laid = replace(laid, kind=np.full(len(laid), int(FillKind.GLASS)))
    order = np.argsort(np.concatenate([bare, marked]), kind="stable")
    return united(Overlay(Fills.joined(base, laid).some(order), seen.window), seen.decal)


def tinted(
    fills: Fills, clear: Bools, opacity: Floats, paper: Colours, overlays: Sequence[Overlay]
) -> tuple[Fills, tuple[Overlay, ...]]:
    """Painted polygons, those of refracting solids (m,) in the colour of the paper as it is seen through them, and
    overlays, those after such polygons as they are seen through them.

    Colours are mixed here once for all: transparent polygons that meet would leave a line between them.
    """
    tint, amount = fills.colours[fills.offsets[:-1]], np.where(clear, opacity, 0.0)
    corner = np.repeat(clear, np.diff(fills.offsets))
    sheet = replace(fills, colours=np.where(corner[:, None], paper, fills.colours).astype(np.uint8))
    blank = np.where(clear, int(FillKind.BACKGROUND), fills.kind)
    base = replace(mixed(sheet, tint, amount), opacity=np.where(clear, 1.0, fills.opacity), kind=blank)
    seen = (Overlay(mixed(o.fills, tint[o.after], amount[o.after]), o.after) for o in overlays)
    return base, tuple(seen)
