"""Blank polygons with the visible lines on them: hidden lines by erasing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted_fills import fills_on_page
from vectorplot.linework.ruler import PEN, Ruler
from vectorplot.painting.painted_paper import paper
from vectorplot.painting.seen import Seen
from vectorplot.scene.scene import Scene
from vectorplot.shading.light.face_shades import item_colours
from vectorplot.shading.light.palettes import shaded_colours
from vectorplot.stages.walk import Walk
from vectorplot.words import LineKind


def erased(walk: Walk, seen: Seen, scene: Scene, ruler: Ruler, kinds: frozenset[LineKind], size: int) -> Fills:
    """Blank polygons, and the lines of the scene on them."""
    from vectorplot.drawing.erasing_fills import erased_fills, line_fills

    view, faces = seen.view, seen.faces
    blank = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=np.repeat(paper(scene), faces.points.shape[1], axis=0),
        opacity=np.ones(len(faces)),
        item=view.face_item[faces.source],
        kind=np.full(len(faces), int(FillKind.BACKGROUND)),
    )
    drawn = walk.run("outlines", _coloured_strokes, scene, ruler, kinds, size)
    lines = Fills.joined(*(line_fills(strokes, ink) for strokes, ink in drawn))
    return walk.run("erasing", erased_fills, blank, lines, PEN.width_mm)


def _coloured_strokes(scene: Scene, ruler: Ruler, kinds: frozenset[LineKind], size: int) -> list[tuple[Paths, Colours]]:
    """The visible lines of a scene, and their inks (m,3): the middle shades of the palettes of items, and of those of
    patterns."""
    from vectorplot.drawing.strokes.stroke_paths import chosen
    from vectorplot.shading.light.depth_cueing import MIDDLE

    strokes = ruler.strokes(scene, kinds)
    plain = chosen(strokes, strokes.kind != LineKind.PATTERN)
    found = [(plain, item_colours(scene.items, plain.item, np.full(len(plain), MIDDLE), size))]
    colours = dict.fromkeys(pattern.colour for item in scene.items for pattern in item.patterns)
    for colour in colours if (strokes.kind == LineKind.PATTERN).any() else ():
        items = (replace(i, patterns=tuple(p for p in i.patterns if p.colour == colour)) for i in scene.items)
        strokes = ruler.strokes(replace(scene, items=tuple(items)), kinds)
        own = chosen(strokes, strokes.kind == LineKind.PATTERN)
        found.append((own, shaded_colours((colour,), np.zeros_like(own.item), np.full(len(own), MIDDLE), size)))
    return found
