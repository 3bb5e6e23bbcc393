"""Sweeps of painted and rendered pictures."""

from __future__ import annotations

import numpy as np
from support.drawn import plate
from support.top_fills import covering, fills_of, last_at, pixel_places
from sweeps.sweep import Sweep

import vectorplot as vp
from vectorplot.tolerances import ZERO_OF_EXTENT

ABOVE = vp.Camera((0.3, -0.4, 8.0), (0.0, 0.0, 0.0))
PIXELS = (160, 160)


def two_plates(gap: float) -> vp.Scene:
    """A small plate, and a larger one above it by a gap."""
    return vp.Scene(
        (
            vp.Item("SMALL", plate((-0.5, -0.5), (0.5, 0.5), 0.0), "red"),
            vp.Item("LARGE", plate((-1, -1), (1, 1), gap), "blue"),
        )
    )


def small_in_pixels(gap: float) -> float:
    """How many pixels of a rendered picture show a plate that lies under a larger one."""
    pixels = vp.render(two_plates(gap), ABOVE, size=PIXELS, samples=1, shadows="none").pixels.astype(int)
    return float(((pixels[..., 0] - pixels[..., 2]) > 60).sum())


def small_in_paint(gap: float) -> float:
    """The same for a painted picture, looked at in as many places."""
    drawing = vp.paint(two_plates(gap), ABOVE, page=vp.Page(160.0, 160.0, 0.0), fit=False, lines=())
    fills = fills_of(drawing)
    place, polygon = covering(fills, pixel_places(drawing, *PIXELS))
    last = last_at(place, polygon, PIXELS[0] * PIXELS[1])
    colour = fills.colours[fills.offsets[last[last >= 0]]].astype(int)
    return float((colour[:, 0] - colour[:, 2] > 60).sum())


GAPS = 3.0 * 10.0 ** -np.arange(1.0, 16.0)
NO_DISTANCE = "faces less than 1e-9 of the extent apart lie in one plane: the smaller one is on top"

SWEEPS = tuple(
    Sweep(
        f"plate close above a smaller one, {word}",
        (76, 24),
        "gap",
        "pixels that show the smaller one",
        GAPS,
        found,
        lambda gap, found=found: 0.0 if gap > ZERO_OF_EXTENT else found(-1e-6),
        lambda gap: 0.0,
        (ZERO_OF_EXTENT, NO_DISTANCE),
    )
    for word, found in (("painted", small_in_paint), ("rendered", small_in_pixels))
)
