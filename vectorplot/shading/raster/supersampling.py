"""Pictures made finer than they are shown, against steps along edges.

Colours are numbers of sRGB, which are not proportional to light: means of light are taken where pixels are to look,
from afar, like the finer ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import power
from vectorplot.shading.raster.png import Bytes

LEVELS = np.arange(256) / 255.0

LIGHT = np.where(LEVELS <= 0.04045, LEVELS / 12.92, power((LEVELS + 0.055) / 1.055, 2.4))
"""(256,) how much light a component of a pixel stands for, 0 to 1. Source: IEC 61966-2-1."""


def averaged(picture: ArrayLike, samples: int) -> Floats:
    """(rows, columns, ...) the means of squares of samples x samples pixels of a finer picture.

    The finer one is made with raster_system(camera, samples * columns, samples * rows).
    Errors: InputError where the sides are no multiples of samples.
    """
    return _means(np.asarray(picture), samples, None)


def _means(p: NDArray[Any], samples: int, meaning: Floats | None) -> Floats:
    """As averaged, of what the numbers of the picture mean, if they do not stand for themselves."""
    if samples < 1 or p.ndim < 2 or p.shape[0] % samples or p.shape[1] % samples:
        raise InputError(f"a picture of shape {p.shape} has no squares of {samples} x {samples} pixels")
    rows, columns = p.shape[0] // samples, p.shape[1] // samples
    blocks = p.reshape(rows, samples, columns, samples, *p.shape[2:])
    total = np.zeros((rows, columns, *p.shape[2:]))
    for down in range(samples):
        for along in range(samples):
            part = blocks[:, down, :, along]
            total += part if meaning is None else np.take(meaning, part)
    return np.asarray(total / float(samples * samples))


def averaged_light(picture: Bytes, samples: int) -> Bytes:
    """(rows, columns, 3) uint8 the pixels of the mean light of squares of samples x samples pixels of a finer picture.

    Pixels of one colour keep it. Errors: as of averaged.
    """
    if samples == 1:
        return picture
    half_way = (LIGHT[1:] + LIGHT[:-1]) / 2.0
    return np.searchsorted(half_way, _means(picture, samples, LIGHT)).astype(np.uint8)
