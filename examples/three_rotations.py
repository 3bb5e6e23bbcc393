"""From the world to the screen in three rotations.

The world is turned about z until the eye stands over the y-axis, about x until it stands on the z-axis, and about z
again by the twist. Then the image plane is z = 0, and projecting is easy. The green arrow is the axis that the world
turns about next; ochre is the eye with its principal ray, rose the image plane, which turns with them.
Source: Glaeser, section 2.1, figure 2.
"""

import sys
from dataclasses import replace
from itertools import accumulate
from pathlib import Path

import numpy as np
from diagrams import GREEN, GREY, INK, OCHRE, RED, ROSE, drawn, line, outline, sheet, tinted, with_arrows, with_dots

import vectorplot as vp
from vectorplot.geometry import CoordinateSystem, prism, rotation_x, rotation_z

EYE, TWIST_DEG = (2.4, -2.2, 1.7), 25.0
GABLE = [(-0.8, -0.6, 0), (0.8, -0.6, 0), (0.8, -0.6, 0.8), (0, -0.6, 1.5), (-0.8, -0.6, 0.8)]
CAMERA = vp.Camera(eye=(9.25, -13.85, 8.7), target=(0.25, 0.15, 0.75), parallel=True, height=6.1)
PAGE = vp.Page(76, 80, 0)


def main(folder: Path) -> None:
    eye = vp.Camera(EYE, twist_deg=TWIST_DEG)
    alpha, beta, gamma = eye.euler_angles
    turns = list(accumulate([np.eye(3), rotation_z(-gamma), rotation_x(-beta), rotation_z(-alpha)], np.matmul))
    house, axes = prism(GABLE, (0, 1.2, 0)), 2.9 * np.eye(3)
    right, up, _ = eye.axes
    plane = np.array([1.5 * (s * np.array(right) + t * np.array(up)) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    lights = tuple(vp.Light(way, parallel=True, intensity=0.6) for way in ((2, -5, 6), CAMERA.eye, (-5, -5, 2)))
    for number, turn in enumerate(turns):
        body = replace(house, vertices=house.vertices @ turn)
        about = {0: 2, 1: 0, 2: 2}.get(number)
        items = (
            vp.Item("HOUSE", body, INK),
            *(line(f"AXIS{k}", -0.55 * end, end, GREEN if k == about else GREY) for k, end in enumerate(axes)),
            line("RAY", EYE @ turn, (0, 0, 0), OCHRE),
            *outline("PLANE", plane @ turn, RED),
        )
        scene = vp.Scene(items, title="Three rotations")
        widths = {INK: 0.35, GREEN: 0.7, GREY: 0.3, OCHRE: 0.5, RED: 0.35}
        drawing = drawn(scene, CAMERA, PAGE, widths, fit=False)
        glass = sheet("PLANE", plane @ turn, ROSE, material=vp.Material("transparent", 0.5))
        shown = vp.Scene((vp.Item("HOUSE", body, "#bcd3ea"), glass), lights)
        drawing = tinted(drawing, shown, CAMERA, shadows="none", flat=("PLANE",))
        for k, end in enumerate(axes):
            drawing = with_arrows(drawing, [0 * end], [end], GREEN if k == about else GREY, 3.6 if k == about else 2.6)
        vp.save(with_dots(drawing, [EYE @ turn], OCHRE, 1.8), folder / f"three_rotations_{number + 1}.svg")

    assert np.isclose((EYE @ turns[1])[0], 0) and np.allclose(EYE @ turns[2], (0, 0, eye.distance))
    assert np.allclose(turns[3], CoordinateSystem.of_image(eye).rotation)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
