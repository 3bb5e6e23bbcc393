"""Pictures made finer than they are shown, against steps along edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats


def averaged(picture: ArrayLike, samples: int) -> Floats:
    """(rows, columns, ...) the means of squares of samples x samples pixels of a finer picture.

    The finer one is made with raster_system(camera, samples * columns, samples * rows).
    Errors: InputError where the sides are no multiples of samples.
    """
    p = np.asarray(picture)
    if samples < 1 or p.ndim < 2 or p.shape[0] % samples or p.shape[1] % samples:
        raise InputError(f"a picture of shape {p.shape} has no squares of {samples} x {samples} pixels")
    rows, columns = p.shape[0] // samples, p.shape[1] // samples
    blocks = p.reshape(rows, samples, columns, samples, *p.shape[2:])
    total = np.zeros((rows, columns, *p.shape[2:]))
    for down in range(samples):
        for along in range(samples):
            total += blocks[:, down, :, along]
    return np.asarray(total / float(samples * samples))
