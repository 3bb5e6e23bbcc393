"""Shadows in pixels: exact ones, standard maps, and trapezoidal ones."""

from __future__ import annotations

from functools import partial

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.wrong_pixels import wrong_share
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.render import render
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.shading.raster.image import Image
from vectorplot.testing.shapes import box

ROWS, DISTANCE = 9, 4.0
"""Rows of pillars along the way, and how far they are apart."""

CAMERA = Camera(eye=(-7.0, -2.0, 3.0), target=(6.0, 2.0, 0.0), fov_deg=40.0)

SUN = Light((-3.0, 5.0, 6.0), parallel=True)

SIZE = (480, 360)
"""Columns and rows of the pictures."""


def avenue() -> Scene:
    """Pillars along a way, on a floor, which the camera sees from the near end to the far one."""
    pillars = [
        Item(f"pillar {row + 1} {side}", box((DISTANCE * row, y, 0.0), (DISTANCE * row + 0.5, y + 0.5, 2.5)), "orange")
        for row in range(ROWS)
        for side, y in (("left", 2.0), ("right", -2.5))
    ]
    floor = Item("floor", box((-8.0, -9.0, -0.5), (DISTANCE * ROWS + 4.0, 12.0, 0.0)), "gray")
    return Scene((floor, *pillars), lights=(SUN,))


def _study() -> Study:
    scene = avenue()

    def rendered(shadows: str, size: float) -> Image:
        keys = {"shadows": shadows, "shadow_size": int(size), "size": SIZE, "samples": 1, "fit": False, "jobs": 1}
        return render(scene, CAMERA, **keys)  # type: ignore[arg-type]

    exact = partial(rendered, "exact", 1)
    truth = exact().pixels

    def error(picture: Image) -> float:
        return wrong_share(picture.pixels, truth)

    ways = (
        Way("standard map", partial(rendered, "buffer"), -1.0),
        Way("trapezoidal map", partial(rendered, "trapezoid"), -1.0),
    )
    return Study(ways, error, lambda picture: picture.pixels[..., 0].size, exact=exact)


SHADOW_MAPS = Approximation(
    name="shadow-maps",
    title="Shadows by maps of what the light sees",
    about="An avenue of pillars in the sun, from its near end. The error is how many pixels are not as light as with "
    "exact shadows. Trapezoidal maps show most of what is near the eye.",
    knob="texels along a side",
    values=(128, 256, 512, 1024, 2048),
    limits=(16, 8192),
    unit="% of the pixels",
    counts="pixels",
    study=_study,
)
