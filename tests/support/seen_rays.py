"""The triangles of a view, the rays of its image, and the polygons on top of points."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View


def triangles(view: View) -> tuple[Floats, Ints]:
    """(t,3,3) triangles of all faces, and the face of each."""
    corner, face = ragged.fans(view.offsets)
    return np.moveaxis(view.points[:, view.corners[corner]], 0, -1), face


def sight_rays(view: View, image: Floats) -> tuple[Floats, Floats]:
    """Origins and directions (n,3) of the rays of points (2,n) of the image; one direction is one unit of depth."""
    if view.eye is None:
        origin = np.stack([*(image + view.target[:2, None]), np.full(image.shape[1], 10.0)], axis=1)
        return origin, np.broadcast_to([0.0, 0.0, -1.0], origin.shape)
    direction = np.stack([*(image / view.focus), np.full(image.shape[1], -1.0)], axis=1)
    return np.broadcast_to(view.eye, direction.shape), direction


def topmost(points: Floats, offsets: Ints, samples: Floats) -> Ints:
    """(n,) the last polygon (simple, 2 or more rows) that contains each sample (2,n), -1 for none."""
    if len(offsets) < 2:
        return np.full(samples.shape[1], -1)
    after = np.arange(1, points.shape[1] + 1)
    after[offsets[1:] - 1] = offsets[:-1]
    x, y = points[0, :, None], points[1, :, None]
    crossed = (y <= samples[1]) != (y[after] <= samples[1])
    rise = np.where(y[after] == y, 1.0, y[after] - y)
    crossed &= x + (samples[1] - y) / rise * (x[after] - x) > samples[0]
    inside = np.logical_xor.reduceat(crossed, offsets[:-1], axis=0)
    return np.where(inside.any(axis=0), len(inside) - 1 - inside[::-1].argmax(axis=0), -1)
