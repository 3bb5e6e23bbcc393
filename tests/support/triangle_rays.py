"""Rays against triangles, the one oracle of tests on pictures: by embreex in single precision, and every ray against
every triangle in double precision where a hair decides."""

from __future__ import annotations

import embreex.mesh_construction
import embreex.rtcore_scene
import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import cross, dot, norm

CLEARANCE = 1e-7
"""Hits nearer to the start of a ray than this are its own start."""


class TriangleRays:
    """What rays meet of triangles (t,3,3), in single precision about the middle of them all."""

    def __init__(self, triangles: Floats) -> None:
        self.count = len(triangles)
        self.middle = triangles.reshape(-1, 3).mean(axis=0) if self.count else np.zeros(3)
        self.net = embreex.rtcore_scene.EmbreeScene()
        if self.count:
            embreex.mesh_construction.TriangleMesh(self.net, np.float32(triangles - self.middle))

    def first(self, origin: Floats, way: Floats) -> Ints:
        """(n,) the triangle each ray meets first, -1 for none."""
        return self._asked(origin, way, "INTERSECT").astype(np.intp) if self.count else np.full(len(origin), -1)

    def stopped(self, origin: Floats, way: Floats, reach: Floats) -> Bools:
        """(n,) whether a triangle lies on the ray, no further than at a reach (n,)."""
        if not self.count:
            return np.zeros(len(origin), dtype=np.bool_)
        return np.asarray(self._asked(origin, way, "OCCLUDED", dists=np.float32(reach)) >= 0)

    def _asked(self, origin: Floats, way: Floats, query: str, **more: np.ndarray) -> np.ndarray:
        rays = (np.ascontiguousarray(some, dtype=np.float32) for some in (origin - self.middle, way))
        return np.asarray(self.net.run(*rays, query=query, **more))


def first_hits(origin: Floats, way: Floats, triangles: Floats, faces: Ints) -> tuple[Ints, Floats]:
    """(n,) the first face (t,) of triangles (t,3,3) on each ray (n,3), -1 for none, and its distance in ways."""
    if not len(faces):
        return np.full(len(origin), -1), np.full(len(origin), np.inf)
    a = triangles[:, 0]
    u, v = triangles[:, 1] - a, triangles[:, 2] - a
    normal = cross(u, v)
    uu, uv, vv = dot(u, u), dot(u, v), dot(v, v)
    area = (uu * vv - uv * uv)[:, None]
    # Products with these are the barycentric coordinates of what is in the plane.
    along_u, along_v = (vv[:, None] * u - uv[:, None] * v) / area, (uu[:, None] * v - uv[:, None] * u) / area
    slope, start = way @ normal.T, origin @ normal.T - dot(a, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -start / slope
        s, r = (origin @ axis.T - dot(a, axis) + t * (way @ axis.T) for axis in (along_u, along_v))
    t = np.where((s >= 0) & (r >= 0) & (s + r <= 1) & (t > CLEARANCE), t, np.inf)
    which, here = t.argmin(axis=1), np.arange(len(origin))
    nearest = t[here, which]
    return np.where(np.isfinite(nearest), faces[which], -1), nearest


def blocked(points: Floats, rays: Floats, triangles: Floats) -> tuple[Bools, Floats]:
    """(n,) whether a triangle lies across the rays (n,3) from points (n,3), and how sure that is.

    A triangle that touches a point is not across its ray.
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = cross(b - a, c - a)
    normal /= np.maximum(norm(normal), 1e-300)[:, None]
    length = norm(rays)[:, None]
    height = dot(normal, a) - points @ normal.T
    slope = rays @ normal.T
    across = (np.abs(slope) > 1e-9 * length) & (np.abs(height) > 1e-9)
    share = np.where(across, height / np.where(across, slope, 1.0), -1.0)
    across &= (share * length > -1e-5) & ((share - 1.0) * length < 1e-5)
    inside = np.full(share.shape, np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        inward = cross(normal, end - start) / norm(end - start)[:, None]
        inside = np.minimum(inside, points @ inward.T - dot(inward, start) + share * (rays @ inward.T))
    before = np.minimum(share, 1.0 - share) * length
    met = across & (inside > 0.0) & (before > 0.0)
    # A small step of the point turns the answer where a side of the triangle or one of its ends is near the ray.
    doubtful = np.abs(np.minimum(inside, before))
    return met.any(axis=1), np.where(across, doubtful, np.inf).min(axis=1, initial=np.inf)
