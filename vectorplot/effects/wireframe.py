"""Wireframes: all lines, hidden or not, in the shades of their items' palettes.

Source: Glaeser, section 4.4.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.layers import PENS, layers_of, shown_items
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.illumination import MIDDLE, edge_shades, shade_numbers
from vectorplot.shading.palettes import PALETTE_SIZE, palette
from vectorplot.shading.shaded_faces import limited_depths
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines

BACKGROUND = "gray"
"""Its darkest shade is behind wireframes where the scene names no background."""


def all_lines(lines: Lines) -> Visibility:
    """Every line, from end to end, as if nothing hid it."""
    count = len(lines)
    return Visibility(np.arange(count), np.zeros(count), np.ones(count), np.zeros(count, dtype=np.intp))


def wire_layers(
    scene: Scene, view: View, strokes: Paths, page: Page, style: Literal["wireframe", "depth-cue"]
) -> tuple[Layer, ...]:
    """The background, and a layer for every shade of every colour, the darkest first; strokes of two points. wireframe:
    the middle shade of the item's palette, or its face's; depth-cue: the mean of the shades at its ends, from a
    fifth of the palette for the farthest to its brightest for the nearest. Palettes have 32 shades.
    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    shade = np.full(len(strokes), MIDDLE) if style == "wireframe" else _cued(view, strokes.points3d)
    names = list(dict.fromkeys(item.colour for item in scene.items))
    of_item = np.array([names.index(item.colour) for item in scene.items], dtype=np.intp)
    key = shade_numbers(shade, PALETTE_SIZE) * len(names) + of_item[shown_items(scene, strokes, view.world_eye)]
    used, which = np.unique(key, return_inverse=True)
    pens = [_pen(names[k % len(names)], k // len(names)) for k in used.tolist()]
    return (_background(scene, page), *layers_of(strokes, which, pens))


def _background(scene: Scene, page: Page) -> Layer:
    """The sheet behind a wireframe, which is not plotted: in the scene's own colour, or in the darkest gray.

    Source: Glaeser, section 4.3.
    """
    named = scene.background is not None
    colour = palette(scene.background or BACKGROUND)[-1 if named else 0]
    return Layer("background", Pen(), (Fills.whole_page(page.width_mm, page.height_mm, colour),), plotted=False)


def _cued(view: View, world: Floats) -> Floats:
    depths = view.points_of(world)[2]
    return edge_shades(depths[::2], depths[1::2], *limited_depths(view, depths))


def _pen(colour: str, shade: int) -> tuple[str, Pen, bool]:
    red, green, blue = palette(colour)[shade].tolist()
    return f"{colour} {shade}", Pen(PENS["visible"].width_mm, f"#{red:02x}{green:02x}{blue:02x}"), True
