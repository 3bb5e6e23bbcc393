"""What is seen through windows, as filled polygons on the page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, fills_on_page
from vectorplot.effects.windows.window_polygons import SeenThrough
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.light.painted_colours import Lighting, colours_of, corner_shades_of, opacities
from vectorplot.visibility.painter.image_faces import view_points


def seen_fills(view: View, lighting: Lighting, seen: SeenThrough, placement: Placement, kind: FillKind) -> Overlay:
    """Polygons seen through windows, in the shades of their faces, each to be painted after its window.

    Degenerate: nothing seen gives nothing. Source: Glaeser, sections 6.4 and 6.6.
    """
    shades = corner_shades_of(view, lighting, view_points(view, seen.points), seen.offsets, seen.source)
    source = np.repeat(seen.source, np.diff(seen.offsets))
    fills = fills_on_page(
        view,
        seen.points,
        seen.offsets,
        placement,
        colours=colours_of(view, lighting, source, shades.total),
        opacity=opacities(lighting.items)[view.face_item[seen.source]],
        item=view.face_item[seen.source],
        kind=np.full(len(seen), int(kind)),
    )
    return Overlay(fills, seen.window)


def mixed(fills: Fills, tint: Colours, amount: Floats) -> Fills:
    """Polygons with some amount (m,) of other colours (m,3)."""
    sizes = np.diff(fills.offsets)
    share = np.repeat(amount, sizes)[:, None]
    colours = (1.0 - share) * fills.colours + share * np.repeat(tint, sizes, axis=0)
    return replace(fills, colours=np.rint(colours).astype(np.uint8))
