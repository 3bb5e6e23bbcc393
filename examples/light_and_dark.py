"""Light and dark on a staircase: where a ball and a ring turn away from the sun, and the edges of their shadows.

On the ball the line is half of a great circle, on the steps shadows end along parts of ellipses; that of the ring
climbs the steps.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere, Torus

SUN = vp.Light((-0.52, -0.62, 0.6), parallel=True, name="SUN")
CAMERA = vp.Camera(eye=(6.5, -15.0, 9.5), target=(0.6, 0.4, 0.7), fov_deg=30)
PENS = "contour=0.5,crease=0.25,terminator=0.35:#b03a2e,shadow=0.35:#1f4fa3"


def moved(item: vp.Item, x: float, y: float, z: float, tilt_deg: float = 0.0) -> vp.Item:
    matrix, turn = np.eye(4), np.radians(tilt_deg)
    matrix[1:3, 1:3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    matrix[:3, 3] = x, y, z
    return item.transformed(matrix)


def staircase() -> vp.Scene:
    ground = [(-3.2, -4.0, 0.0), (5.2, -4.0, 0.0), (5.2, -1.0, 0.0), (-3.2, -1.0, 0.0)]
    floor = vp.Item("FLOOR", vp.Mesh.from_polygons(ground, [(0, 1, 2, 3)]))
    steps = [moved(vp.Item(f"STEP{k}", box((8.4, 1.2, 0.5 * (k + 1)))), -3.2, 1.2 * k - 1.0, 0.0) for k in range(4)]
    ball = moved(vp.Item("BALL", Sphere(0.9)), -1.1, -2.0, 0.9)
    ring = moved(vp.Item("RING", Torus(0.95, 0.34)), 1.9, -0.9, 1.9, 55.0)
    return vp.Scene((floor, *steps, ball, ring), (SUN,), title="Light and dark")


def main(folder: Path) -> None:
    lines = "contour,boundary,crease,terminator,shadow"
    drawing = vp.draw(staircase(), CAMERA, page="170x110", lines=lines, pens=PENS)
    vp.save(drawing, folder / "light_and_dark.svg")
    found = {layer.name: layer.strokes[0] for layer in drawing.layers if layer.strokes}
    towards = np.array(SUN.position) / np.linalg.norm(SUN.position)
    turning = found["terminator"]
    of_ball = np.flatnonzero(np.repeat(turning.item, np.diff(turning.offsets)) == 5)
    centre = np.array([-1.1, -2.0, 0.9])
    assert np.abs((turning.points3d[of_ball] - centre) @ towards).max() < 1e-9
    assert len(found["shadow"]) > 4


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
