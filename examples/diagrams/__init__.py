"""What diagrams are made of: inks, lines in space, painted faces below drawn lines, arrow heads and dots on the page.

Sizes of heads, dots and pens are in millimetres on the page, places are points in space; on a page that shows no scene
they are millimetres, too.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.drawing import Fills

INK, RED, BLUE, GREEN, OCHRE, GREY = "#1b2733", "#c8352b", "#1f5fa8", "#2c7d4f", "#c2810c", "#8f99a3"
"""Pens."""

CREAM, ROSE, SKY, MINT, SAND, MIST = "#fbf3e2", "#f6cfc4", "#cfe2f3", "#d3ebd6", "#f7e0ad", "#e8ebee"
"""Tints that go with them."""


def line(name: str, start, end, colour: str = INK) -> vp.Item:
    """A segment in space."""
    return vp.Item(name, Line.through(np.asarray(start, float), np.asarray(end, float)), colour)


def outline(name: str, points, colour: str = INK, *, closed: bool = True) -> tuple[vp.Item, ...]:
    """The sides of a polygon in space, or of a polyline."""
    corners = [*points, points[0]] if closed else list(points)
    return tuple(line(f"{name}{k}", a, b, colour) for k, (a, b) in enumerate(itertools.pairwise(corners)))


def sheet(name: str, corners, colour: str, **options) -> vp.Item:
    """A polygon in space."""
    return vp.Item(name, vp.Mesh.from_polygons(corners, [range(len(corners))]), colour, **options)


def on_page(drawing: vp.Drawing, points) -> np.ndarray:
    """(n,2) where points (n,3) of the world are on the page."""
    flat = np.column_stack([points, np.ones(len(points))]) @ drawing.page_from_world.T
    return flat[:, :2] / flat[:, 3:]


def inked(drawing: vp.Drawing, widths: Mapping[str, float]) -> vp.Drawing:
    """A drawing with layers by colour, with a pen as wide as is said for each of them."""
    pens = {
        layer.name: replace(layer.pen, width_mm=widths.get(layer.name, layer.pen.width_mm)) for layer in drawing.layers
    }
    return replace(drawing, layers=tuple(replace(layer, pen=pens[layer.name]) for layer in drawing.layers))


def drawn(scene: vp.Scene, camera: vp.Camera, page: vp.Page, widths: Mapping[str, float], **options) -> vp.Drawing:
    """The lines of a scene with a pen for every colour, as wide as is said or 0.25 mm."""
    return inked(vp.draw(scene, camera, page=page, layers="colour", **options), widths)


def tinted(
    drawing: vp.Drawing, scene: vp.Scene, camera: vp.Camera, *, flat: tuple[str, ...] = (), **options
) -> vp.Drawing:
    """A drawing with the faces of a scene painted below it, as the same camera sees them.

    flat: items of these names have their colour everywhere, whatever the light.
    """
    painted = vp.paint(scene, camera, page=vp.Page(drawing.width_mm, drawing.height_mm, 5), **options)
    (fills,) = painted.layers[0].fills
    owner, colours = np.repeat(fills.item, np.diff(fills.offsets)), fills.colours.copy()
    for number, item in enumerate(scene.items):
        if item.name in flat:
            colours[owner == number] = rgb(item.colour)
    below = layer("faces", replace(fills, points=on_page(drawing, fills.points3d), colours=colours))
    return replace(drawing, layers=(below, *drawing.layers))


def shown(drawing: vp.Drawing, points) -> np.ndarray:
    """(n,) which points (n,3) of the world are ends of visible strokes."""
    lines = [paths for layer in drawing.layers if layer.name != "hidden" for paths in layer.strokes if len(paths)]
    ends = np.concatenate([p.points3d[np.concatenate([p.offsets[:-1], p.offsets[1:] - 1])] for p in lines])
    gap = np.linalg.norm(np.asarray(points)[:, None] - ends, axis=2).min(axis=1)
    return gap < 1e-9 * np.ptp(ends, axis=0).max()


def rgb(colour: str) -> np.ndarray:
    """Red, green and blue of #rrggbb."""
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], dtype=np.uint8)


def polygons(parts: Sequence, colours, **options) -> Fills:
    """Filled polygons on a page, each (n,2) in mm; one colour for all, or one for each."""
    each = [colours] * len(parts) if isinstance(colours, str) else list(colours)
    bytes_of = np.array(list(map(rgb, each)), dtype=np.uint8).reshape(-1, 3)
    ends = np.cumsum([0, *map(len, parts)])
    return Fills.flat(np.concatenate([np.zeros((0, 2)), *parts]), ends, bytes_of, **options)


def strokes(parts: Iterable, *, closed: bool = False) -> vp.Paths:
    """Polylines on a page, each (n,2) in mm."""
    parts = [np.asarray(part, dtype=float) for part in parts]
    points, zeros = np.concatenate([np.zeros((0, 2)), *parts]), np.zeros(len(parts), dtype=np.intp)
    kind = np.full(len(parts), vp.LineKind.CURVE, dtype=np.intp)
    space = np.column_stack([points, np.zeros(len(points))])
    offsets = np.cumsum([0, *map(len, parts)])
    return vp.Paths(points, offsets, np.full(len(parts), closed), kind, zeros, zeros, space)


def layer(name: str, marks, colour: str = INK, width_mm: float = 0.25) -> vp.Layer:
    """Marks that share a pen."""
    return vp.Layer(name, vp.Pen(width_mm, colour), tuple(marks) if isinstance(marks, list | tuple) else (marks,))


def dashes(start, end, length_mm: float = 1.6) -> list[np.ndarray]:
    """The dashes of a straight line on the page, half of them gaps; it begins and ends with one."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    count = 2 * max(1, round(np.linalg.norm(end - start) / length_mm / 2)) + 1
    stops = start + np.linspace(0, 1, count + 1)[:, None] * (end - start)
    return [stops[k : k + 2] for k in range(0, count, 2)]


def circle(centre, radius: float, count: int = 72) -> np.ndarray:
    """(count,2) points of a circle on the page."""
    turn = 2 * np.pi * np.arange(count) / count
    return np.asarray(centre) + radius * np.column_stack([np.cos(turn), np.sin(turn)])


def heads(starts, ends, colour: str, length_mm: float = 2.6) -> Fills:
    """Arrow heads at the ends of lines (n,2) on the page."""
    starts, ends = np.asarray(starts, float), np.asarray(ends, float)
    way = (ends - starts) / np.linalg.norm(ends - starts, axis=1, keepdims=True) * length_mm
    side = 0.33 * np.column_stack([-way[:, 1], way[:, 0]])
    return polygons(list(np.stack([ends, ends - way + side, ends - 0.75 * way, ends - way - side], axis=1)), colour)


def with_arrows(
    drawing: vp.Drawing, starts, ends, colour: str, length_mm: float = 2.6, shaft_mm: float = 0.0
) -> vp.Drawing:
    """A drawing with heads at the ends of lines from and to points (n,3) of the world, and their shafts if so wide."""
    tails, tips = on_page(drawing, starts), on_page(drawing, ends)
    shafts = [strokes(np.stack([tails, tips], axis=1))] if shaft_mm else []
    marks = (*shafts, heads(tails, tips, colour, length_mm))
    return replace(drawing, layers=(*drawing.layers, layer("arrows", marks, colour, shaft_mm or 0.25)))


def with_dots(drawing: vp.Drawing, points, colour: str, radius_mm: float = 0.8) -> vp.Drawing:
    """A drawing with dots at points (n,3) of the world."""
    marks = polygons([circle(place, radius_mm) for place in on_page(drawing, points)], colour)
    return replace(drawing, layers=(*drawing.layers, layer("dots", marks)))


def with_faces(drawing: vp.Drawing, faces: Sequence, colours, opacity: float = 1.0) -> vp.Drawing:
    """A drawing with flat polygons, each (n,3) in the world, over what is painted and below its lines."""
    marks = polygons([on_page(drawing, face) for face in faces], colours, opacity=opacity)
    painted = sum(not below.strokes for below in drawing.layers[:1])
    return replace(drawing, layers=(*drawing.layers[:painted], layer("tints", marks), *drawing.layers[painted:]))
