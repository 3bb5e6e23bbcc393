"""What is seen along rays, the plain way: every ray against every triangle."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View

CLEARANCE = 1e-7
"""Hits nearer to the start of a ray than this are its own start."""


def triangles(view: View) -> tuple[Floats, Ints]:
    """(t,3,3) triangles of all faces, and the face of each."""
    corners, faces = [], []
    for face in range(view.face_count):
        ring = view.corners[view.offsets[face] : view.offsets[face + 1]]
        for k in range(1, len(ring) - 1):
            corners.append(view.points[:, [ring[0], ring[k], ring[k + 1]]].T)
            faces.append(face)
    return np.array(corners).reshape(-1, 3, 3), np.array(faces, dtype=np.intp)


def first_hits(origin: Floats, direction: Floats, corners: Floats, faces: Ints) -> tuple[Ints, Floats]:
    """(n,) the first face on each ray, -1 for none, and its distance in directions."""
    a = corners[:, 0]
    u, v = corners[:, 1] - a, corners[:, 2] - a
    normal = np.cross(u, v)
    uu, uv, vv = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
    area = (uu * vv - uv * uv)[:, None]
    # Products with these are the barycentric coordinates of what is in the plane.
    along_u, along_v = (vv[:, None] * u - uv[:, None] * v) / area, (uu[:, None] * v - uv[:, None] * u) / area
    slope, start = direction @ normal.T, origin @ normal.T - (a * normal).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -start / slope
        s, r = (origin @ axis.T - (a * axis).sum(axis=1) + t * (direction @ axis.T) for axis in (along_u, along_v))
    hit = (s >= 0) & (r >= 0) & (s + r <= 1) & (t > CLEARANCE)
    t = np.where(hit, t, np.inf)
    if not len(faces):
        return np.full(len(origin), -1), np.full(len(origin), np.inf)
    which, here = t.argmin(axis=1), np.arange(len(origin))
    nearest = t[here, which]
    return np.where(np.isfinite(nearest), faces[which], -1), nearest


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
