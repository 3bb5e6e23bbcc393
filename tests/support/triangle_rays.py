"""Rays against triangles, the one oracle of tests on pictures: by embreex in single precision, and every ray against
every triangle in double precision where a hair decides."""

from __future__ import annotations

import embreex.mesh_construction
import embreex.rtcore_scene
import numpy as np

from vectorplot.arrays import Bools, Floats, Ints

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
    normal = np.cross(u, v)
    uu, uv, vv = (u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)
    area = (uu * vv - uv * uv)[:, None]
    # Products with these are the barycentric coordinates of what is in the plane.
    along_u, along_v = (vv[:, None] * u - uv[:, None] * v) / area, (uu[:, None] * v - uv[:, None] * u) / area
    slope, start = way @ normal.T, origin @ normal.T - (a * normal).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -start / slope
        s, r = (origin @ axis.T - (a * axis).sum(axis=1) + t * (way @ axis.T) for axis in (along_u, along_v))
    t = np.where((s >= 0) & (r >= 0) & (s + r <= 1) & (t > CLEARANCE), t, np.inf)
    which, here = t.argmin(axis=1), np.arange(len(origin))
    nearest = t[here, which]
    return np.where(np.isfinite(nearest), faces[which], -1), nearest


def blocked(points: Floats, rays: Floats, triangles: Floats) -> tuple[Bools, Floats]:
    """(n,) whether a triangle lies across the rays (n,3) from points (n,3), and how sure that is.

    A triangle that touches a point is not across its ray.
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.sqrt((normal * normal).sum(axis=1)), 1e-300)[:, None]
    length = np.sqrt((rays * rays).sum(axis=1))[:, None]
    height = (normal * a).sum(axis=1) - points @ normal.T
    slope = rays @ normal.T
    across = (np.abs(slope) > 1e-9 * length) & (np.abs(height) > 1e-9)
    share = np.where(across, height / np.where(across, slope, 1.0), -1.0)
    ray, triangle = np.nonzero((share * length > -1e-5) & ((share - 1.0) * length < 1e-5) & across)
    share, reach = share[ray, triangle], length[ray, 0]
    hit = points[ray] + share[:, None] * rays[ray]
    inside = np.full(len(ray), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along = (end - start)[triangle]
        inward = np.cross(normal[triangle], along) / np.sqrt((along * along).sum(axis=1))[:, None]
        inside = np.minimum(inside, (inward * (hit - start[triangle])).sum(axis=1))
    before = np.minimum(share, 1.0 - share) * reach
    met = (inside > 0.0) & (before > 0.0)
    # A small step of the point turns the answer where a side of the triangle or one of its ends is near the ray.
    doubtful = np.where(met, np.minimum(inside, before), -np.minimum(inside, before))
    result = np.zeros(len(points), dtype=np.bool_)
    result[ray[met]] = True
    sure = np.full(len(points), np.inf)
    np.minimum.at(sure, ray, np.abs(doubtful))
    return result, sure
