"""The trapezoid in the lamp's image plane, step by step.

The images of the corners of what the eye sees, with their hull and the line of sight from the near to the far plane;
the top and the base line, upright on it; the point in which the sides have to meet so that what lies in focus, rose,
comes onto the line of 80 percent; the trapezoid; and the square it is brought to, in which the focus has most of the
room. Source: Martin and Tan, recipe; Ressler, Notes on implementation, equations 1 to 10.
"""

import sys
from pathlib import Path

import diagrams as d
import numpy as np
from diagrams import circle, dashes, heads, layer, polygons, strokes

import vectorplot as vp
from vectorplot.geometry import convex_hull
from vectorplot.shading import line_of_sight
from vectorplot.textbook import bounding_trapezoid, square_map

NEAR = np.array([(-1.0, 0.2), (0.2, -0.7), (0.9, -0.1), (-0.3, 0.9)])
FAR = np.array([(3.4, 5.4), (8.6, 1.4), (9.8, 4.0), (4.6, 8.2)])
FOCUS = 3.6
PAGE_MM = np.array([96.0, 84.0])


def on_page(points):
    return np.array([17.0, 14.0]) + 6.6 * np.asarray(points, dtype=float)


def images(points, matrix):
    flat = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return flat[:, :2] / flat[:, 2:]


def main(folder: Path) -> None:
    points = np.vstack([NEAR, FAR])
    hull = points[convex_hull(points)]
    axis = line_of_sight(points, NEAR.mean(axis=0), FAR.mean(axis=0))
    start, along, left = axis.origin, axis.direction, np.array([-axis.direction[1], axis.direction[0]])
    corners = bounding_trapezoid(points, axis, FOCUS)
    matrix = square_map(corners).matrix
    flat = images(corners, matrix)
    assert np.allclose(flat, [(-1, -1), (1, -1), (1, 1), (-1, 1)])
    behind = start + (axis.top + FOCUS) * along
    assert np.isclose(images([behind], matrix)[0, 1], 0.6), "the focus comes onto the line of 80 percent"
    tip = crossing(corners[0], corners[3], corners[1], corners[2])
    low, high = (crossing(behind, behind + left, a, b) for a, b in ((corners[0], corners[3]), (corners[1], corners[2])))
    focus = np.array([corners[0], corners[1], high, low])
    ends = on_page([start - 1.0 * along, start + (axis.base + 1.0) * along])
    seen = layer("seen", polygons([on_page(hull)], d.SKY))
    outline = layer("hull", strokes(map(on_page, (hull, NEAR, FAR)), closed=True), d.BLUE, 0.3)
    line = layer("sight", (strokes([ends]), heads(ends[:1], ends[1:], d.OCHRE, 3.0)), d.OCHRE, 0.4)
    dots = layer("dots", polygons([circle(p, 0.9) for p in on_page(points)], d.BLUE))
    across = [start + t * along + h * np.array([-left, left]) for t, h in ((axis.top, 2.0), (axis.base, 4.8))]
    bars = layer("top and base", strokes(map(on_page, across)), d.RED, 0.5)
    sides = [part for end in (corners[2], corners[3]) for part in dashes(on_page(tip), on_page(end), 2.0)]
    meet = layer("meeting", (strokes(sides), polygons([circle(on_page(tip), 1.2)], d.RED)), d.RED, 0.3)
    tinted = layer("focus", polygons([on_page(corners), on_page(focus)], [d.CREAM, d.ROSE]))
    result = layer("trapezoid", strokes([on_page(corners)], closed=True), d.INK, 0.7)
    steps = (
        (seen, outline, line, dots),
        (seen, outline, line, bars, dots),
        (tinted, outline, meet, bars, line, dots),
        (tinted, outline, result, dots),
    )
    for number, layers in enumerate(steps):
        vp.save(vp.Drawing(*PAGE_MM, layers, title="Trapezoid"), folder / f"trapezoid_steps_{number + 1}.svg")

    heights = images([start + t * along for t in np.arange(axis.top, axis.base, 1)], matrix)[:, 1]
    rungs = [PAGE_MM / 2 + 38.0 * np.array([(-1, y), (1, y)]) for y in heights]
    square, inner, places, *shapes = (
        PAGE_MM / 2 + 38.0 * images(p, matrix) for p in (corners, focus, points, hull, NEAR, FAR)
    )
    tints = polygons([square, inner], [d.CREAM, d.ROSE])
    lines = (layer("rungs", strokes(rungs), d.GREY, 0.2), layer("hull", strokes(shapes, closed=True), d.BLUE, 0.4))
    frame = layer("square", strokes([square], closed=True), d.INK, 0.7)
    corner = layer("dots", polygons([circle(p, 0.9) for p in places], d.BLUE))
    layers = (layer("focus", tints), *lines, frame, corner)
    vp.save(vp.Drawing(*PAGE_MM, layers, title="Square"), folder / "trapezoid_steps_5.svg")


def crossing(a, b, c, d):
    """Where the lines through a and b and through c and d meet."""
    s, _ = np.linalg.solve(np.column_stack([b - a, c - d]), c - a)
    return a + s * (b - a)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
