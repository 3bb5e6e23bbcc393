"""A room in a mirror ball and in a mirror column, in lines: each point where light is reflected from it to the eye.

The ball shows all of the room but what it hides, the walls behind the eye too, and the column draws it out in height.
Each point is shown where the way of light by way of the mirror is shortest (Fermat); what hides it in the mirror hides
it in the drawing. The window is behind the eye: it is seen in the mirrors only.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import on_page

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere, rod

CENTRE, RADIUS = np.array([-1.2, 0.6, 1.3]), 1.3


def board(name: str, low: tuple[float, ...], high: tuple[float, ...]) -> vp.Item:
    sizes = np.subtract(high, low)
    return vp.Item(name, box(tuple(sizes.tolist()))).moved(*low)


def main(folder: Path) -> None:
    mirror = vp.Material("mirror")
    floor = replace(board("FLOOR", (-5, -7, -0.1), (5, 3, 0)), lines=("contour", "crease", "section"))
    joints = (vp.Section((1, 0, 0), tuple(np.arange(-4.0, 5.0))), vp.Section((0, 1, 0), tuple(np.arange(-6.0, 3.0))))
    floor = replace(floor, curves=vp.SurfaceLines(sections=joints))
    ball = vp.Item("BALL", Sphere(RADIUS), material=mirror).moved(*CENTRE)
    column = vp.Item("COLUMN", rod((2.2, 1.2, 0), (2.2, 1.2, 3.6), 0.8), material=mirror)
    things = [board("CRATE", (-4.2, -2.0, 0), (-3.2, -1.0, 1)), board("CHEST", (0.2, -2.4, 0), (1.4, -1.6, 0.7))]
    # Behind the eye: a wall, and the bars of a window in it.
    wall = board("WALL", (-5, -7.1, 0), (5, -7, 5))
    bars = [board(f"BAR{k}", (-2.0 + k, -7.0, 1.2), (-1.9 + k, -6.95, 4.2)) for k in range(5)]
    sills = [board(f"SILL{k}", (-2.0, -7.0, 1.2 + 1.5 * k), (2.1, -6.95, 1.3 + 1.5 * k)) for k in range(3)]
    scene = vp.Scene((floor, ball, column, *things, wall, *bars, *sills), title="A mirror ball")
    camera = vp.Camera((0.6, -6.6, 3.0), (0.4, 0.5, 1.2), fov_deg=42)
    page, pens = vp.Page(150, 110, 5), "reflected=0.13:#2f6fb0"
    drawing = vp.draw(scene, camera, page=page, fit=False, pens=pens, tolerance_mm=0.08)
    vp.save(drawing, folder / "mirror_ball.svg")

    # Where the ball shows a corner of the chest, both rays have one angle with the normal.
    corner, eye = np.array([0.2, -2.4, 0.7]), np.array(camera.eye)
    to_eye = (eye - CENTRE) / np.linalg.norm(eye - CENTRE)
    side = np.cross(np.cross(to_eye, corner - CENTRE), to_eye)
    low, high, side = 0.0, 1.5, side / np.linalg.norm(side)
    for _ in range(60):
        turn = 0.5 * (low + high)
        normal = np.cos(turn) * to_eye + np.sin(turn) * side
        there, back = (end - CENTRE - RADIUS * normal for end in (corner, eye))
        nearer = normal @ there / np.linalg.norm(there) > normal @ back / np.linalg.norm(back)
        low, high = (low, turn) if nearer else (turn, high)
    (place,) = on_page(drawing, [CENTRE + RADIUS * normal])
    (shown,) = next(one for one in drawing.layers if one.name == "reflected").strokes
    assert np.hypot(*(shown.points - place).T).min() < 0.1


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
