"""Pictures in pixels, and how many of them are wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.drawing.drawing import Drawing

Bytes = NDArray[np.uint8]


def pixels_of(drawing: Drawing, columns: int, rows: int) -> Bytes:
    """(rows, columns, 3) a drawing on white."""
    from vectorplot.backends.raster import painted

    return painted(np.full((rows, columns, 3), 255, dtype=np.uint8), drawing)


def wrong_share(pixels: Bytes, truth: Bytes, levels: int = 0) -> float:
    """In per cent, the pixels that differ from the true ones in some colour by more than so many levels."""
    apart = np.abs(pixels.astype(np.intp) - truth).max(axis=2)
    return 100.0 * float((apart > levels).mean())
