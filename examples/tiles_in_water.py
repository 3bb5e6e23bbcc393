"""A pool seen from near by, in lines: tiles rise towards the far side, and a stick and a block are seen twice.

A perspective: no line in the water stays straight. What is blue is seen through the top of the water or through its
sides, through each elsewhere; rays that leave by the walls would show what is behind. Every point is where a ray from
the eye, bent by Snell's law, meets it. Source: Glaeser, section 6.6, figure 12.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import on_page

import vectorplot as vp
from vectorplot.effects import seen_in_surface
from vectorplot.geometry import box

REFRACTION, DEPTH = 1.333, 1.8


def main(folder: Path) -> None:
    water = vp.Material("transparent", refraction=REFRACTION)
    floor = vp.Item("FLOOR", box((6, 4, 0.2)), lines=("contour", "crease", "section")).moved(0, 0, -0.2)
    grid = [vp.Section((1, 0, 0), tuple(np.arange(0.5, 6, 0.5))), vp.Section((0, 1, 0), tuple(np.arange(0.5, 4, 0.5)))]
    floor = replace(floor, curves=vp.SurfaceLines(sections=tuple(grid)))
    turn, s = np.eye(4), np.sqrt(0.5)
    turn[:3, :3] = [[s, 0, s], [0, 1, 0], [-s, 0, s]]
    turn[:3, 3] = (1.0, 1.9, 0.15)
    stick = vp.Item("STICK", box((0.16, 0.16, 5.0))).transformed(turn)
    block = vp.Item("BLOCK", box((0.8, 0.8, 0.8))).moved(3.4, 2.4, 0)
    scene = vp.Scene((vp.Item("WATER", box((6, 4, DEPTH)), material=water), floor, stick, block), title="A pool")
    camera = vp.Camera((7, -5, 6), (3, 2, 0.9))
    drawing = vp.draw(scene, camera, page=vp.Page(150, 110, 5), pens="refracted=0.15:#2f6fb0")
    vp.save(drawing, folder / "tiles_in_water.svg")

    # A row of points on a joint between tiles is seen in the surface where Snell's law says.
    joint = np.stack([np.linspace(0.5, 1.7, 7), np.full(7, 3.5), np.zeros(7)], axis=1)
    places = on_page(drawing, seen_in_surface(camera.eye, joint, (0, 0, 1), (0, 0, DEPTH), REFRACTION))
    chords = vp.draw(scene, camera, page=vp.Page(150, 110, 5), curves="polyline")
    (bent,) = next(one for one in chords.layers if one.name == "refracted").strokes
    own = np.repeat(np.arange(len(bent)), np.diff(bent.offsets))
    a, b = bent.points[:-1][own[1:] == own[:-1]], bent.points[1:][own[1:] == own[:-1]]
    for place in places:
        share = np.clip(((place - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0.0, 1.0)
        assert np.hypot(*(a + share[:, None] * (b - a) - place).T).min() < 0.03


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
