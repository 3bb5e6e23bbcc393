"""Pixels of a picture, made in bands."""

from __future__ import annotations

import numpy as np

from vectorplot.shading.raster.png import Bytes
from vectorplot.shading.raster.scene_pixels import Picture, opaque_buffer, shaded, with_glass, with_mirrors
from vectorplot.stages.walk import Walk

BAND_PIXELS = 1 << 22
"""So many pixels are in memory at a time."""


def pixels_in_bands(walk: Walk, picture: Picture, samples: int) -> Bytes:
    """(rows, columns, 3) the finer picture, made in bands."""
    result = np.zeros((picture.rows, picture.columns, 3), dtype=np.uint8)
    step = max(1, BAND_PIXELS // (picture.columns * samples)) * samples
    tops = range(0, picture.rows, step)
    for number, top in enumerate(tops):
        bottom = min(top + step, picture.rows)
        band = walk.repetition(("depth", "shading", "mirrors", "transparency"), number, len(tops))
        buffer = band.run("depth", opaque_buffer, picture, top, bottom)
        colours = band.run("shading", shaded, picture, buffer)
        if band.calls_for("mirrors"):
            colours = band.run("mirrors", with_mirrors, picture, buffer, colours)
        if band.calls_for("transparency"):
            colours = band.run("transparency", with_glass, picture, buffer, colours)
        result[top:bottom] = np.rint(colours)
    return result
