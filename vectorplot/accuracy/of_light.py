"""Approximations of refraction and of shadows in pixels, measured: Newton's iteration, and kinds of shadow maps."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.effects.refraction import angle_of_refraction, tangents_of_rays
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.elementary import arctan, tan
from vectorplot.pictures.render import render
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.shading.image import Image
from vectorplot.testing.shapes import box

# Where in the water an eye sees a point: Newton's iteration for the angle, and for its tangent.

WATER = 4.0 / 3.0

HEIGHT, DEPTHS, DISTANCES = 1.0, np.linspace(0.2, 3.0, 29), np.linspace(0.1, 8.0, 80)
"""An eye so high above the surface; depths of points, and how far they are from the eye along the surface."""


def _study() -> Study:
    far, deep = np.meshgrid(DISTANCES, DEPTHS)

    def exact() -> Floats:
        return tangents_of_rays(far, HEIGHT + deep, deep, WATER)[0]

    truth = exact()

    def error(tangent: Floats) -> float:
        return float((np.abs(tangent - truth) / truth).max())

    ways = (
        Way("by the angle", lambda steps: by_angle(far, deep, int(steps))),
        Way("by the tangent", lambda steps: by_tangent(far, deep, int(steps))),
    )
    return Study(ways, error, np.size, exact=exact)


def by_angle(far: Floats, deep: Floats, steps: int) -> Floats:
    """Tangents of the angles of incidence after some steps of Newton's method for the angle itself, from the straight
    line on.

    Source: Glaeser, section 6.6, equation 5.
    """
    alpha = arctan(far / (HEIGHT + deep))
    for _ in range(steps):
        beta = angle_of_refraction(alpha, WATER)
        error_ratio = HEIGHT * tan(alpha) + deep * tan(beta) - far
        bend = np.cos(alpha) / (WATER * np.cos(beta))
        slope = HEIGHT / np.cos(alpha) ** 2 + deep * bend / np.cos(beta) ** 2
        alpha = np.clip(alpha - error_ratio / slope, 0.0, arctan(far / HEIGHT))
    return np.asarray(tan(alpha))


def by_tangent(far: Floats, deep: Floats, steps: int) -> Floats:
    """The same by the tangent, as the package has it: from zero the iteration climbs to the solution and never passes
    it. The first step gives the apparent depth, deep / WATER."""
    t = np.zeros_like(far)
    for _ in range(steps):
        root = np.sqrt(WATER**2 + (WATER**2 - 1.0) * t * t)
        slope = HEIGHT + deep * (WATER / root) ** 2 / root
        t = t + (far - HEIGHT * t - deep * t / root) / slope
    return np.asarray(t)


REFRACTION = Approximation(
    name="refraction",
    title="Rays into water",
    about="The rays from points below the water to an eye above it, 2320 of them. The error is the largest one of the "
    "tangent of the angle of incidence, as a part of it; each step of Newton's method squares it. One step for the "
    "tangent is the rule that water looks three quarters as deep. Exact: as many steps as help.",
    knob="steps of Newton's method",
    values=(1, 2, 3, 4, 5, 6),
    limits=(1, 100),
    unit="parts of the tangent",
    counts="rays",
    study=_study,
)


# Pictures in pixels, and how many of them are wrong.

Bytes = NDArray[np.uint8]


def pixels_of(drawing: Drawing, columns: int, rows: int) -> Bytes:
    """(rows, columns, 3) a drawing on white."""
    from vectorplot.backends.raster import painted

    return painted(np.full((rows, columns, 3), 255, dtype=np.uint8), drawing)


def wrong_share(pixels: Bytes, truth: Bytes, levels: int = 0) -> float:
    """In per cent, the pixels that differ from the true ones in some colour by more than so many levels."""
    apart = np.abs(pixels.astype(np.intp) - truth).max(axis=2)
    return 100.0 * float((apart > levels).mean())


# Shadows in pixels: exact ones, standard, trapezoidal and perspective maps.

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


def _study_of_shadow_maps() -> Study:
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
        Way("perspective map", partial(rendered, "perspective"), -1.0),
    )
    return Study(ways, error, lambda picture: picture.pixels[..., 0].size, exact=exact)


SHADOW_MAPS = Approximation(
    name="shadow-maps",
    title="Shadows by maps of what the light sees",
    about="An avenue of pillars in the sun, from its near end. The error is how many pixels are not as light as with "
    "exact shadows. Trapezoidal and perspective maps show most of what is near the eye.",
    knob="texels along a side",
    values=(128, 256, 512, 1024, 2048),
    limits=(16, 8192),
    unit="% of the pixels",
    counts="pixels",
    study=_study_of_shadow_maps,
)
