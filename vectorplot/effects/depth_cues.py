"""Strokes that are thinner, or paler, the farther away they are; wireframes in the shades of depth.

Source: Glaeser, section 4.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.layers import layers_of, shown_items
from vectorplot.drawing.pens import PENS
from vectorplot.drawing.strokes import chosen, concatenated, sections, unrolled
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.page import Page
from vectorplot.scene.pens import DepthCue
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.illumination import MIDDLE, depth_shades, edge_shades, shade_numbers
from vectorplot.shading.palettes import PALETTE_SIZE, palette
from vectorplot.shading.shaded_faces import limited_depths
from vectorplot.tolerances import ZERO_OF_EXTENT


def depth_cued(
    layers: Sequence[Layer], view: View, cue: DepthCue, paper: Sequence[int], page_from_world: Floats
) -> tuple[Layer, ...]:
    """The layers, one for each step of depth, the farthest first; strokes are divided between steps. view: in whose
    axes depth is measured, within its limits; paper: colour, three numbers of 0 to 255. The nearest part keeps its
    layer's name and pen, the others are numbered: contour, contour depth 2, ...
    Edge cases: empty layers are left out; strokes all at one depth are near. Source: Glaeser, section 4.4, figure 2;
    errata G4-03, G4-04.
    """
    strokes = [paths for layer in layers for paths in layer.strokes]
    depths = view.points_of(np.concatenate([np.zeros((0, 3)), *(paths.points3d for paths in strokes)]))[2]
    limits = limited_depths(view, depths)
    if not limits[1] - limits[0] > ZERO_OF_EXTENT:
        return tuple(layers)
    cued = [[_in_steps(paths, view, limits, cue.steps, page_from_world) for paths in layer.strokes] for layer in layers]
    shares = depth_shades(np.arange(cue.steps), 0.0, cue.steps - 1.0).tolist()
    found = []
    for step, share in enumerate(shares):
        for layer, parts in zip(layers, cued, strict=True):
            marks = tuple(chosen(paths, which == step) for paths, which in parts)
            if any(map(len, marks)):
                number = cue.steps - step
                name = layer.name if number == 1 else f"{layer.name} depth {number}"
                found.append(replace(layer, name=name, pen=_pen(layer.pen, cue, share, paper), marks=marks))
    return tuple(found)


def _in_steps(
    paths: Paths, view: View, limits: tuple[float, float], steps: int, page_from_world: Floats
) -> tuple[Paths, Ints]:
    """Strokes divided where the steps of depth do, and (m,) the step of each, 0 for the farthest."""
    paths = chosen(paths, np.diff(paths.offsets) > 0)
    step = _levels(paths, view, limits, steps)[1]
    first = step[paths.offsets[:-1]]
    mixed = np.zeros(len(paths), dtype=np.bool_)
    mixed[ragged.owner(np.diff(paths.offsets))[step != np.repeat(first, np.diff(paths.offsets))]] = True
    if not mixed.any():
        return paths, first
    laps = paths.closed[mixed].astype(np.intp)
    cut = unrolled(chosen(paths, mixed), np.zeros_like(laps), laps)
    divided, of_part = _divided(cut, *_levels(cut, view, limits, steps), page_from_world)
    return concatenated((chosen(paths, ~mixed), divided)), np.concatenate([first[~mixed], of_part])


def _levels(paths: Paths, view: View, limits: tuple[float, float], steps: int) -> tuple[Floats, Ints]:
    """(p,) how far up from the farthest limit points are, in steps, and (p,) in which step."""
    height = steps / (limits[1] - limits[0])
    level = height * (view.points_of(paths.points3d)[2] - limits[0])
    # What lies in the plane between two steps is in the nearer one, whatever rounding says.
    step = np.clip(np.floor(level + height * ZERO_OF_EXTENT), 0, steps - 1)
    return level, step.astype(np.intp)


def _divided(paths: Paths, level: Floats, step: Ints, page_from_world: Floats) -> tuple[Paths, Ints]:
    """Open strokes divided where they pass from step to step, and the step of each part; level, step (p,): of points,
    steps begin at whole levels."""
    start = np.delete(np.arange(len(level)), paths.offsets[1:] - 1)
    rise = step[start + 1] - step[start]
    pieces = np.abs(rise) + 1
    segment = np.repeat(start, pieces)
    place, way = ragged.place(pieces), np.repeat(np.clip(rise, -1, 1), pieces)
    of_piece = np.asarray(step[segment] + way * place, dtype=np.intp)
    run = level[segment + 1] - level[segment]
    share = (of_piece + (way < 0) - level[segment]) / np.where(run != 0.0, run, 1.0)
    low = np.where(place > 0, np.clip(share, 0.0, 1.0), 0.0)
    # A division in the world comes out nearer the far end on the page.
    weight = np.abs(matmul(paths.points3d, page_from_world[3, :3]) + page_from_world[3, 3])
    far = low * weight[segment + 1]
    low = far / ((1.0 - low) * weight[segment] + far)
    high = np.where(np.append(place[1:], 0) > 0, np.append(low[1:], 0.0), 1.0)
    some = np.flatnonzero(low < high)
    segment, of_piece, low, high = segment[some], of_piece[some], low[some], high[some]
    owner = np.searchsorted(paths.offsets, segment, side="right") - 1
    begins = np.concatenate([[True], (np.diff(of_piece) != 0) | (np.diff(owner) != 0)])
    begin = np.flatnonzero(begins)
    end = np.append(begin[1:], len(segment)) - 1
    ends = segment[begin], low[begin], segment[end], high[end]
    return sections(paths, owner[begin], *ends, page_from_world), of_piece[begin]


def _pen(pen: Pen, cue: DepthCue, share: float, paper: Sequence[int]) -> Pen:
    """A pen with what a share leaves of its width and its colour."""
    if "width" in cue.by:
        pen = replace(pen, width_mm=share * pen.width_mm)
    if "shade" in cue.by:
        ink = (int(pen.colour[k : k + 2], 16) for k in (1, 3, 5))
        mixed = (round(share * own + (1.0 - share) * other) for own, other in zip(ink, paper, strict=True))
        pen = replace(pen, colour="#{:02x}{:02x}{:02x}".format(*mixed))
    return pen


# Wireframes: all lines, hidden or not, in the shades of their items' palettes.

BACKGROUND = "gray"
"""Its darkest shade is behind wireframes where the scene names no background."""


def wire_layers(
    scene: Scene, view: View, strokes: Paths, page: Page, style: Literal["wireframe", "depth-cue"]
) -> tuple[Layer, ...]:
    """The background, and a layer for every shade of every colour, the darkest first; strokes of two points, or more.
    wireframe: the middle shade of the item's palette, or its face's; depth-cue: the mean of the shades at its first and
    last point, from a fifth of the palette for the farthest to its brightest for the nearest. Palettes have 32 shades.
    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    shade = np.full(len(strokes), MIDDLE) if style == "wireframe" else _cued(view, strokes)
    names = list(dict.fromkeys(item.colour for item in scene.items))
    of_item = np.array([names.index(item.colour) for item in scene.items], dtype=np.intp)
    key = shade_numbers(shade, PALETTE_SIZE) * len(names) + of_item[shown_items(scene, strokes, view.world_eye)]
    used, which = np.unique(key, return_inverse=True)
    pens = [_wire_pen(names[k % len(names)], k // len(names)) for k in used.tolist()]
    return (_background(scene, page), *layers_of(strokes, which, pens))


def _background(scene: Scene, page: Page) -> Layer:
    """The sheet behind a wireframe, which is not plotted: in the scene's own colour, or in the darkest gray.

    Source: Glaeser, section 4.3.
    """
    named = scene.background is not None
    colour = palette(scene.background or BACKGROUND)[-1 if named else 0]
    return Layer("background", Pen(), (Fills.whole_page(page.width_mm, page.height_mm, colour),), plotted=False)


def _cued(view: View, strokes: Paths) -> Floats:
    depths = view.points_of(strokes.points3d)[2]
    first, last = strokes.offsets[:-1], strokes.offsets[1:] - 1
    return edge_shades(depths[first], depths[last], *limited_depths(view, depths))


def _wire_pen(colour: str, shade: int) -> tuple[str, Pen, bool]:
    red, green, blue = palette(colour)[shade].tolist()
    return f"{colour} {shade}", Pen(PENS["visible"].width_mm, f"#{red:02x}{green:02x}{blue:02x}"), True
