"""Where the picture goes on the page."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Floats
from vectorplot.scene.scene import Page


def fitted(page: Page, low: Floats, high: Floats) -> Floats:
    """(3,3) matrix from image to page: the box from low to high (2,) fills the page but for its margin, in the middle.

    Degenerate: a box without extent goes to the middle at the scale 1; one without width or height fills the other.
    """
    room = np.array([page.width_mm, page.height_mm]) - 2.0 * page.margin_mm
    size = high - low
    scales = [r / s for r, s in zip(room.tolist(), size.tolist(), strict=True) if s > 1e-12 * size.max()]
    scale = min(scales, default=1.0)
    middle = np.array([page.width_mm, page.height_mm]) / 2.0
    offset = middle - scale * (low + high) / 2.0
    return np.array([[scale, 0.0, offset[0]], [0.0, scale, offset[1]], [0.0, 0.0, 1.0]])


def centred(page: Page, picture_height: float, height_mm: float) -> Floats:
    """(3,3) matrix from image to page: the image's origin goes to the middle, picture_height becomes height_mm."""
    scale = height_mm / picture_height
    return np.array([[scale, 0.0, page.width_mm / 2.0], [0.0, scale, page.height_mm / 2.0], [0.0, 0.0, 1.0]])
