"""Shadow buffering: a pixel lies in the shadow of a light where the light sees something else before it.

Two lamps; the shade of a pixel depends on how many of them reach it. First buffers of 500 x 500 depths of 16 bits,
then of 100 x 100 with 8 bits, which were small once. Source: Glaeser, section 8.6, figure 19.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import curve_of_function
from vectorplot.geometry import box
from vectorplot.surfaces import PlacedSurface, Sphere, Torus, revolution_surface

SMALL = (240, 160)


def scene() -> vp.Scene:
    """Things on a table under two lamps."""
    vase = revolution_surface(curve_of_function(lambda t: (0.5 + 0.25 * np.sin(2.2 * t), 0 * t, t), 0, 2.4))
    place = np.eye(4)
    place[:3, 3] = -3.9, -2.5, -0.3
    items = (
        vp.Item("TABLE", box((7.8, 4.9, 0.3)).transformed(place), "gray"),
        vp.Item("VASE", PlacedSurface(vase, np.eye(3), (-1.6, 0.6, 0)), "cyan"),
        vp.Item("BALL", PlacedSurface(Sphere(0.7), np.eye(3), (0.2, -1.2, 0.7)), "orange", vp.Material("plastic")),
        vp.Item("RING", PlacedSurface(Torus(1.0, 0.28), np.eye(3), (2.2, 0.9, 0.28)), "yellow"),
    )
    lamps = (vp.Light((-6, -5, 9), intensity=0.6), vp.Light((5, -7, 7), intensity=0.6))
    return vp.Scene(items, lamps, title="Shadow buffering")


def main(folder: Path, width: int = 1600) -> None:
    camera = vp.Camera(eye=(1, -13, 8), target=(0, 0, 0.4), fov_deg=36)
    exact = vp.render(scene(), camera, size=SMALL, samples=1, shadows="exact").pixels.astype(int)
    wrong = []
    for name, side, bits in (("fine", 500, 16), ("coarse", 100, 8)):
        options = {"shadows": "buffer", "shadow_size": side, "shadow_bits": bits}
        vp.save(
            vp.render(scene(), camera, size=(width, width * 5 // 8), samples=3, **options),
            folder / f"shadow_buffering_{name}.png",
        )
        small = vp.render(scene(), camera, size=SMALL, samples=1, **options).pixels
        wrong.append((np.abs(small - exact).max(axis=2) > 8).mean())
    assert wrong[0] < 0.01, "right but for the borders of shadows"
    assert wrong[0] < wrong[1] < 0.08, "a coarse buffer is less so"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
