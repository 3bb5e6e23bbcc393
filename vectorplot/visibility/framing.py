"""What part of a segment is in front of the eye, and inside the picture."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.scene.scene import Page
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.lines import Lines

WIDEST_DEG = 60.0
"""A picture that is fitted to the page shows what lies up to so many degrees off the principal ray."""


def window_planes(view: View, half_width: float, half_height: float) -> Floats:
    """(4,4) planes (unit normal, constant) of a window in the image plane, positive inside."""
    if view.eye is None:
        x, y = view.target[:2]
        rows = [
            [1, 0, 0, x - half_width],
            [-1, 0, 0, -x - half_width],
            [0, 1, 0, y - half_height],
            [0, -1, 0, -y - half_height],
        ]
        return np.array(rows, dtype=np.float64)
    x, y, z = view.eye
    normals = np.array(
        [
            [view.focus, 0, -half_width],
            [-view.focus, 0, -half_width],
            [0, view.focus, -half_height],
            [0, -view.focus, -half_height],
        ]
    )
    normals /= np.sqrt((normals * normals).sum(axis=1))[:, None]
    return np.column_stack([normals, normals @ [x, y, z]])


def near_plane(view: View) -> Floats:
    """(1,4) the near plane, positive beyond it; no row in a parallel projection."""
    if view.eye is None:
        return np.zeros((0, 4))
    return np.array([[0.0, 0.0, -1.0, view.near - view.eye[2]]])


def inside(planes: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Parameters (n,) between which segments (3,n) have no negative distance from any plane; low > high: nowhere.

    Source: Glaeser, section 2.5, with the near plane first (errata G2-08, G2-09).
    """
    low, high = np.zeros(start.shape[1]), np.ones(start.shape[1])
    for a, b, c, d in planes:
        at_start = a * start[0] + b * start[1] + c * start[2] - d
        at_end = a * end[0] + b * end[1] + c * end[2] - d
        crossing = (at_start < 0.0) != (at_end < 0.0)
        where = at_start / np.where(crossing, at_start - at_end, 1.0)
        entering = crossing & (at_start < 0.0)
        low = np.where(entering, np.maximum(low, where), low)
        high = np.where(crossing & ~entering, np.minimum(high, where), high)
        high = np.where((at_start < 0.0) & (at_end < 0.0), -1.0, high)
    return low, high


def reaches_too_far(view: View, start: Floats, end: Floats) -> bool:
    """Whether segments (3,n) reach behind the near plane, or too far off the principal ray to be fitted to a page."""
    if view.eye is None or not start.shape[1]:
        return False
    limit = view.focus * np.tan(np.radians(WIDEST_DEG))
    for points in (start, end):
        if view.depth_of(points).min() < view.near or np.abs(view.image_of(points)).max() > limit:
            return True
    return False


def in_frame(view: View, lines: Lines, page: Page, fit: bool) -> tuple[Lines, bool]:
    """The lines in front of the eye and inside the picture, and whether all of them fit a page.

    Without fit, and where the scene reaches too far to be fitted, the picture is the camera's field of vision.
    """
    fitted = fit and not reaches_too_far(view, lines.start, lines.end)
    planes = near_plane(view)
    if not fitted:
        width, height = page.width_mm - 2.0 * page.margin_mm, page.height_mm - 2.0 * page.margin_mm
        unit = view.picture_height / (height if fit else page.height_mm)
        planes = np.concatenate([planes, window_planes(view, unit * width / 2.0, unit * height / 2.0)])
    if len(planes):
        low, high = inside(planes, lines.start, lines.end)
        kept = np.flatnonzero(low < high)
        lines = lines.cut(view, kept, low[kept], high[kept])
    return lines, fitted
