"""The filled polygons of an SVG file."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import numpy as np

from support.svg_strokes import LABEL, SVG

HREF = "{http://www.w3.org/1999/xlink}href"

_NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)")


def filled_polygons(layer: ElementTree.Element) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points (n,2) and mean colour (3,) of each filled polygon of a layer, in the order of painting; lines have two
    points."""
    gradients = {gradient.get("id"): gradient for gradient in layer.iter(f"{SVG}linearGradient")}
    colours = {
        identity: np.mean([_rgb(stop.get("stop-color")) for stop in gradient], axis=0)
        for identity, gradient in gradients.items()
        if len(gradient)
    }
    stops = {
        f"url(#{identity})": colours[(gradient.get(HREF) or f"#{identity}")[1:]]
        for identity, gradient in gradients.items()
    }
    found = []
    clips = {path for clip in layer.iter(f"{SVG}clipPath") for path in clip}
    for path in layer.iter(f"{SVG}path"):
        if path in clips:
            continue
        fill = path.get("fill", path.get("stroke"))
        colour = stops[fill] if fill in stops else _rgb(fill)
        found += [(points, colour) for points in points_of(path)]
    return found


def points_of(path: ElementTree.Element) -> list[np.ndarray]:
    """The corners (n,2) of the polygons of a path: the first one is written, then the ways from corner to corner."""
    parts = [np.array(_NUMBER.findall(text), dtype=np.float64) for text in path.get("d").split("M")[1:]]
    return [np.cumsum(part.reshape(-1, 2), axis=0) for part in parts]


def painted_by_layer(root: ElementTree.Element) -> dict[str, list[tuple[np.ndarray, np.ndarray]]]:
    """The filled polygons of each layer that has some, under its label."""
    layers = [layer for layer in root.iter(f"{SVG}g") if layer.get(LABEL) and layer.find(f"{SVG}g") is not None]
    return {
        layer.get(LABEL): [polygon for group in layer.findall(f"{SVG}g") for polygon in filled_polygons(group)]
        for layer in layers
    }


def area(points: np.ndarray) -> float:
    """The area of a polygon (n,2), wound either way."""
    x, y = (points - points[0]).T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0)


def _rgb(text: str) -> np.ndarray:
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)], dtype=np.float64)
