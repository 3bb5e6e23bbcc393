"""The frame of a camera: right, up and back in the eye, and the frustum of what it sees, down to the image plane.

The principal ray runs through the middle of the picture; back points away from the target. Source: Glaeser, sections
2.1 and 2.3.
"""

import itertools
import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.geometry import box, revolution

CAMERA = vp.Camera(eye=(-5.5, -6.5, 4.2), target=(0.0, 0.0, 0.8), fov_deg=22)
WIDE = 1.4
"""Width of the picture over its height."""


def arrow(name, start, way, colour):
    """A line, and a small cone at its end."""
    length = np.linalg.norm(way)
    back = way / length
    across = np.cross(back, (0.3, 0.5, 0.8))
    across /= np.linalg.norm(across)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([across, np.cross(back, across), back])
    frame[:3, 3] = start + way
    tip = revolution([(0.07, 0, -0.28), (0, 0, 0)], 12).transformed(frame)
    return vp.Item(name, Line(start, way - 0.28 * back), colour), vp.Item(f"{name} TIP", tip, colour)


def main(folder: Path) -> None:
    eye, target = np.array(CAMERA.eye), np.array(CAMERA.target)
    right, up, back = CAMERA.axes
    half = 0.5 * CAMERA.picture_height
    corners = [target + half * (s * WIDE * right + t * up) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    sides = [np.array([eye, corner]) for corner in corners]
    frame = [np.array(pair) for pair in itertools.pairwise([*corners, corners[0]])]
    assert np.allclose(np.cross(right, up), back), "a right-handed frame"
    assert np.allclose((eye - target) / np.linalg.norm(eye - target), back), "back points away from the target"

    ground = [np.array(p, dtype=float) for p in ((-6.5, -7, 0), (1.6, -7, 0), (1.6, 2.2, 0), (-6.5, 2.2, 0))]

    items = [
        vp.Item("BOX", box((1.2, 1.2, 1.2), placement=(1, 0, 0, -1.7, 0, 1, 0, -0.4, 0, 0, 1, 0)), "orange"),
        vp.Item("TOWER", revolution([(0.5, 0, 0), (0.5, 0, 1.1), (0, 0, 1.9)], 8), "orange"),
        vp.Item("PRINCIPAL", Line(eye, target - eye), "blue"),
        vp.Item("PLUMB", Line(eye, (0, 0, -eye[2])), "gray"),
    ]
    items += [vp.Item(f"SIDE{k}", Line(a, b - a), "cyan") for k, (a, b) in enumerate([*sides, *frame])]
    items += [
        vp.Item(f"G{k}", Line(a, b - a), "gray") for k, (a, b) in enumerate(itertools.pairwise([*ground, ground[0]]))
    ]
    for name, way in (("RIGHT", right), ("UP", up), ("BACK", back)):
        items += arrow(name, eye, 1.7 * way, "magenta")
    scene = vp.Scene(tuple(items), title="The frame of a camera")
    seen_from = vp.Camera(eye=(6.5, -19, 11), target=(-2.6, -2.4, 1.9), fov_deg=30)
    vp.save(vp.draw(scene, seen_from, page=vp.Page(150, 105, 5), layers="colour"), folder / "camera_frame.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
