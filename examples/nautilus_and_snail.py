"""A nautilus and a snail: spiral surfaces in the light of a lamp, with the shadows their own whorls cast on them.

Each whorl is an enlarged copy of the last; what differs is the circle that turns and grows.
Source: Glaeser, section 8.6, figure 20, and section 8.2, example 5.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Circle
from vectorplot.geometry import rotation_z
from vectorplot.surfaces import spiral_surface

SHELLS = {
    # name: circle, growth, turns, eye, light, colour
    "nautilus": (Circle((1.0, 0, 0), 0.52, axis=(0, 1, 0)), 0.175, 3.2, (2, -5, 9), (-4, -3, 8), "orange"),
    "snail": (Circle((0.62, 0, -1.25), 0.5, axis=(0.15, 1, 0)), 0.085, 6.0, (3, -9, 2.5), (-5, -7, 9), "yellow"),
}


def main(folder: Path) -> None:
    for name, (circle, growth, turns, eye, light, colour) in SHELLS.items():
        shell = spiral_surface(circle, growth, start=-2 * np.pi * turns, end=0.0)
        item = vp.Item(name.upper(), shell, colour, vp.Material("plastic"))
        scene = vp.Scene((item,), (vp.Light(light, parallel=True, intensity=1.0),), title=name.capitalize())
        target = (0, 0, -0.7) if name == "snail" else (0, 0, 0)
        image = vp.render(scene, vp.Camera(eye, target, fov_deg=24), size=(300, 270), samples=2, shadows="trapezoid")
        vp.save(image, folder / f"{name}.png")

        u, v = np.meshgrid(np.linspace(0, 6, 9), np.linspace(-2 * np.pi * turns, -7, 9))
        whorl = np.exp(2 * np.pi * growth) * shell.points(u, v) @ rotation_z(2 * np.pi)
        assert np.allclose(shell.points(u, v + 2 * np.pi), whorl), "a whorl is the last one, enlarged"
        lit = vp.render(scene, vp.Camera(eye, target, fov_deg=24), size=(300, 270), samples=2, shadows="none").pixels
        assert (lit.astype(int) - image.pixels >= -2).all() and (lit != image.pixels).any(), "shadows only darken"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
