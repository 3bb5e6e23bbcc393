"""The triangles of a view, the rays of its image, and the polygons on top of points."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View


def triangles(view: View) -> tuple[Floats, Ints]:
    """(t,3,3) triangles of all faces, and the face of each."""
    corners, faces = [], []
    for face in range(view.face_count):
        ring = view.corners[view.offsets[face] : view.offsets[face + 1]]
        for k in range(1, len(ring) - 1):
            corners.append(view.points[:, [ring[0], ring[k], ring[k + 1]]].T)
            faces.append(face)
    return np.array(corners).reshape(-1, 3, 3), np.array(faces, dtype=np.intp)


def sight_rays(view: View, image: Floats) -> tuple[Floats, Floats]:
    """Origins and directions (n,3) of the rays of points (2,n) of the image; one direction is one unit of depth."""
    if view.eye is None:
        origin = np.stack([*(image + view.target[:2, None]), np.full(image.shape[1], 10.0)], axis=1)
        return origin, np.broadcast_to([0.0, 0.0, -1.0], origin.shape)
    direction = np.stack([*(image / view.focus), np.full(image.shape[1], -1.0)], axis=1)
    return np.broadcast_to(view.eye, direction.shape), direction


def topmost(points: Floats, offsets: Ints, samples: Floats) -> Ints:
    """(n,) the last polygon (simple, 2 or more rows) that contains each sample (2,n), -1 for none."""
    found = np.full(samples.shape[1], -1)
    for k in range(len(offsets) - 1):
        ring = points[:2, offsets[k] : offsets[k + 1]]
        after = np.roll(ring, -1, axis=1)
        crossed = (ring[1][:, None] <= samples[1]) != (after[1][:, None] <= samples[1])
        rise = np.where(after[1] == ring[1], 1.0, after[1] - ring[1])[:, None]
        reached = ring[0][:, None] + (samples[1] - ring[1][:, None]) / rise * (after[0] - ring[0])[:, None]
        found[(crossed & (reached > samples[0])).sum(axis=0) % 2 == 1] = k
    return found
