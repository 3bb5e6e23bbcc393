"""A stick in water, in lines: bent where it dips in, as the grid on the floor is raised.

A parallel picture of a basin; every blue line is seen through the water's surface, its place by Snell's law, hidden by
what stands before it on the bent ray. Gray dashes show where the stick is. Source: Glaeser, section 6.6, figure 12.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import dashes, layer, on_page, strokes

import vectorplot as vp
from vectorplot.effects import refracted
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere

REFRACTION = 1.333


def main(folder: Path) -> None:
    water = vp.Material("transparent", refraction=REFRACTION)
    floor = vp.Item("FLOOR", box((6, 4, 0.2)), lines=("contour", "crease", "section")).moved(0, 0, -0.2)
    grid = [vp.Section((1, 0, 0), tuple(np.arange(0.5, 6, 0.5))), vp.Section((0, 1, 0), tuple(np.arange(0.5, 4, 0.5)))]
    floor = replace(floor, curves=vp.SurfaceLines(sections=tuple(grid)))
    turn, s = np.eye(4), np.sqrt(0.5)
    turn[:3, :3] = [[s, 0, s], [0, 1, 0], [-s, 0, s]]
    turn[:3, 3] = (1.0, 1.9, 0.1)
    stick = vp.Item("STICK", box((0.16, 0.16, 5.0))).transformed(turn)
    ball = vp.Item("BALL", Sphere(0.55)).moved(4.6, 1.2, 0.55)
    scene = vp.Scene((vp.Item("WATER", box((6, 4, 1.8)), material=water), floor, stick, ball), title="A stick in water")
    camera = vp.Camera((12, -14, 10.5), (3, 2, 1), parallel=True)
    drawing = vp.draw(scene, camera, page=vp.Page(150, 110, 5), pens="refracted=0.15:#2f6fb0")

    ends = np.array([(1.08, 1.98, 0.2), (2.7, 1.98, 1.8)])
    ghost = layer("straight", strokes(dashes(*on_page(drawing, ends))), "#9a9a9a", 0.15)
    vp.save(replace(drawing, layers=(*drawing.layers, ghost)), folder / "stick_in_water.svg")

    # A tile's corner is seen in the surface where the ray from it is bent towards the eye.
    corner, way = np.array([2.0, 3.0, 0.0]), np.array(camera.target) - camera.eye
    inside, _ = refracted(way, (0, 0, 1), REFRACTION)
    (place,) = on_page(drawing, [corner + inside * (1.8 / inside[2])])
    (bent,) = next(one for one in drawing.layers if one.name == "refracted").strokes
    points = bent.points
    own = np.repeat(np.arange(len(bent)), np.diff(bent.offsets))
    a, b = points[:-1][own[1:] == own[:-1]], points[1:][own[1:] == own[:-1]]
    share = np.clip(((place - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0.0, 1.0)
    assert np.hypot(*(a + share[:, None] * (b - a) - place).T).min() < 1e-3


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
