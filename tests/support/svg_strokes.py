"""The strokes of an SVG file as polylines: lines as they are, Bézier curves and elliptic arcs sampled."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import numpy as np

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"

SAMPLES = np.linspace(0.0, 1.0, 65)[1:, None]
"""Of one curve or arc: so many that chords are off by less than what strokes may be, also on one that fills a page."""

_COMMAND = re.compile(r"([MCAZ])([^MCAZ]*)")
_NUMBER = re.compile(r"-?[\d.]+")


def strokes_by_layer(root: ElementTree.Element) -> dict[str, list[np.ndarray]]:
    """For each layer, under its label, the points (n,2) of its strokes; closed ones end where they begin. Filled
    polygons, which are in groups of their own, are left out."""
    others = (f"{SVG}title", f"{SVG}g")
    return {
        layer.get(LABEL): [polyline(node) for node in layer if node.tag not in others]
        for layer in root.iter(f"{SVG}g")
        if layer.get(LABEL) is not None
    }


def polyline(node: ElementTree.Element) -> np.ndarray:
    """The points (n,2) of a polyline, polygon or path element. Errors: ValueError for another element."""
    kind = node.tag.removeprefix(SVG)
    if kind == "path":
        return path(node.get("d"))
    if kind not in ("polyline", "polygon"):
        raise ValueError(f"{kind} is no stroke")
    points = np.array([pair.split(",") for pair in node.get("points").split()], dtype=np.float64)
    return np.concatenate([points, points[:1]]) if kind == "polygon" else points


def path(data: str) -> np.ndarray:
    """Points (n,2) on a path of the commands M, C, A and Z in absolute coordinates."""
    parts = []
    for command, text in _COMMAND.findall(data):
        numbers = np.array(_NUMBER.findall(text), dtype=np.float64)
        if command == "M":
            parts.append(numbers.reshape(1, 2))
        elif command == "C":
            for one, two, end in numbers.reshape(-1, 3, 2):
                parts.append(bezier(parts[-1][-1], one, two, end))
        elif command == "A":
            for *shape, large, sweep, x, y in numbers.reshape(-1, 7):
                parts.append(arc(parts[-1][-1], shape, (large, sweep), np.array([x, y])))
        else:
            parts.append(parts[0][:1])
    return np.concatenate(parts)


def bezier(start: np.ndarray, one: np.ndarray, two: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Points of a cubic Bézier curve, without its first."""
    s, t = 1.0 - SAMPLES, SAMPLES
    return s**3 * start + 3 * s * s * t * one + 3 * s * t * t * two + t**3 * end


def arc(start: np.ndarray, shape: list[float], flags: tuple[float, float], end: np.ndarray) -> np.ndarray:
    """Points of an elliptic arc, without its first. Source: SVG 1.1, implementation notes F.6.5 and F.6.6."""
    radii, tilt = np.array(shape[:2]), np.radians(shape[2])
    axes = np.array([[np.cos(tilt), np.sin(tilt)], [-np.sin(tilt), np.cos(tilt)]])
    # On the unit circle: halfway between the ends lies the foot of the centre.
    first, last = (axes @ point / radii for point in (start, end))
    half = (last - first) / 2.0
    reach = np.sqrt(max(0.0, 1.0 / (half @ half) - 1.0)) * (1.0 if flags[0] == flags[1] else -1.0)
    centre = (first + last) / 2.0 + reach * np.array([half[1], -half[0]])
    size = np.linalg.norm(first - centre)
    begin, stop = (np.arctan2(*(point - centre)[::-1]) for point in (first, last))
    turn = (stop - begin) % (2.0 * np.pi) - (0.0 if flags[1] else 2.0 * np.pi)
    angle = begin + turn * SAMPLES
    return (centre + size * np.hstack([np.cos(angle), np.sin(angle)])) * radii @ axes
