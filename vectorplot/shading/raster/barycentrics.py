"""Where in its triangle every visible point lies, so that each pixel is shaded once, after visibility is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.components import component_sum
from vectorplot.shading.depth.depth_buffer import DepthBuffer


@dataclass(frozen=True, eq=False)
class VisiblePoints:
    """One point of space for every pixel that is not empty.

    pixel (m,): row * columns + column; triangle (m,): before clipping; weights (m, 3): of its corners, each 0 to 1,
    together 1; corners (m, 3): the indices of its points.
    """

    pixel: Ints
    triangle: Ints
    weights: Floats
    corners: Ints

    def __len__(self) -> int:
        return len(self.pixel)

    def interpolated(self, values: ArrayLike) -> Floats:
        """(m, ...) values (n, ...) given at the points of the triangles, such as points of space or normals."""
        v = np.asarray(values, dtype=np.float64)
        tail = (1,) * (v.ndim - 1)
        total = np.take(v, self.corners[:, 0], axis=0) * self.weights[:, 0].reshape(-1, *tail)
        for k in (1, 2):
            total += np.take(v, self.corners[:, k], axis=0) * self.weights[:, k].reshape(-1, *tail)
        return np.asarray(total)


def visible_points(buffer: DepthBuffer, points: ArrayLike, corners: ArrayLike) -> VisiblePoints:
    """The visible points of the triangles (t, 3) of homogeneous points (n, 4) that a depth buffer was made of.

    Pixels count from the buffer's own first row.
    """
    pixel = np.flatnonzero(buffer.triangle >= 0)
    return points_in_pixels(buffer, pixel, buffer.triangle.take(pixel).astype(np.intp), points, corners)


def points_in_pixels(
    buffer: DepthBuffer, pixel: Ints, triangle: Ints, points: ArrayLike, corners: ArrayLike
) -> VisiblePoints:
    """The points in which the rays through pixels (m,) of a buffer meet triangles (m,), numbers in buffer.triangles.

    The weights are those of space, not of the image, and hold for triangles that reach behind the eye too. The centre
    of a pixel may lie outside its triangle by the snapping of its corners; such weights are moved to its border.
    """
    p, t = np.asarray(points, dtype=np.float64).reshape(-1, 4), np.asarray(corners, dtype=np.intp).reshape(-1, 3)
    source = buffer.triangles.source[triangle]
    if len(source) and source.max() >= len(t):
        raise InputError("the depth buffer was made of other triangles")
    row, column = np.divmod(pixel, buffer.code.shape[1])
    row = row + buffer.top
    chosen = np.take(t, source, axis=0)
    # Homogeneous coordinates of the corners about the pixel's centre: their sum with the weights wanted is (0, 0).
    u, v = [], []
    for k in range(3):
        corner = np.take(p, chosen[:, k], axis=0)
        u.append(corner[:, 0] - column * corner[:, 3])
        v.append(corner[:, 1] - row * corner[:, 3])
    parts = [u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] for k in range(3)]
    return VisiblePoints(pixel, source, _normalized(np.stack(parts, axis=1)), chosen)


def _normalized(parts: Floats) -> Floats:
    """(m, 3) weights in proportion to parts; where these have no sum, as for a triangle seen edge-on, equal ones."""
    total = component_sum(parts)
    known = total != 0.0
    weights = parts / np.where(known, total, 1.0)[:, None]
    np.clip(weights, 0.0, 1.0, out=weights)
    weights[~known] = 1.0 / 3.0
    return np.asarray(weights / component_sum(weights)[:, None])
