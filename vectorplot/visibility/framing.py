"""What part of a segment is in front of the eye, and inside the picture."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, field_of_vision
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.lines import Lines


def window_planes(view: View, low: Floats, high: Floats) -> Floats:
    """(4,4) planes (unit normal, constant) of a window in the image plane from low to high (2,), positive inside."""
    (left, bottom), (right, top) = low, high
    if view.eye is None:
        x, y = view.target[:2]
        rows = [[1, 0, 0, x + left], [-1, 0, 0, -x - right], [0, 1, 0, y + bottom], [0, -1, 0, -y - top]]
        return np.array(rows, dtype=np.float64)
    d = view.focus
    normals = np.array([[d, 0, left], [-d, 0, -right], [0, d, bottom], [0, -d, -top]])
    normals /= np.sqrt((normals * normals).sum(axis=1))[:, None]
    return np.column_stack([normals, matmul(normals, view.eye)])


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


def frame_of(view: View, lines: Lines, page: Page, fit: bool) -> Placement | None:
    """The frame of a picture of lines: the camera's field of vision where they are not to be fitted to the page, or
    reach too far; else None."""
    if fit and not view.reaches_too_far(lines.start, lines.end):
        return None
    return field_of_vision(view, page, fit)


def in_frame(view: View, lines: Lines, frame: Placement | None) -> Lines:
    """The lines in front of the eye, and inside the frame of the picture if it has one."""
    planes = near_plane(view)
    if frame is not None:
        planes = np.concatenate([planes, window_planes(view, *frame.window)])
    if not len(planes):
        return lines
    low, high = inside(planes, lines.start, lines.end)
    kept = np.flatnonzero(low < high)
    return lines.cut(view, kept, low[kept], high[kept])
