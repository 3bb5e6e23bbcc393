"""Which points a surface hides, by rays against a dense net or the signs of its equation: nothing is known of normals,
contours or borders, so singular places are places like others."""

from __future__ import annotations

import numpy as np

from support.triangle_rays import TriangleRays
from vectorplot.geometry.camera import Camera
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_parametrised

CELLS, STEPS, AT_ONCE = 200, 1000, 2000
"""A chord of a circle of so many is off it by 1.2e-4 of its radius, far less than rays beside one another are apart."""

FAR = 1e30

AROUND = 4e-3
"""A point is sure where all rays beside its own, at this part of the extent, and from before and behind it, agree."""


class DenseRays:
    """A surface to shoot at; points, eyes and directions may be those of the same surface placed elsewhere."""

    def __init__(self, surface: Surface | ImplicitSurface) -> None:
        self.surface = surface
        self.is_net = is_parametrised(surface)
        if not self.is_net:
            self.low, self.high = (np.asarray(corner, dtype=np.float64) for corner in surface.box)
            self.size = float((self.high - self.low).max())
            return
        u, v = (a.ravel() for a in np.meshgrid(*surface.domain.grid(CELLS, CELLS), indexing="ij"))
        points = surface.points(u, v)
        at = np.arange(len(u)).reshape(CELLS + 1, CELLS + 1)
        a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
        triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
        self.size = float(np.ptp(points, axis=0).max())
        self.net = TriangleRays(points[triangles])

    def hidden(
        self, shape: Surface | ImplicitSurface, camera: Camera, points: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Which points (n,3) the surface, placed as this shape is, hides from a camera, and which of them are sure."""
        eye, target, points = (_back(shape, p) for p in (camera.eye, camera.target, points))
        if camera.parallel:
            way = np.broadcast_to(eye - target, points.shape)
            reach = np.full(len(points), FAR)
        else:
            way = eye - points
            reach = np.linalg.norm(way, axis=1)
        way = way / np.linalg.norm(way, axis=1, keepdims=True)
        one = np.cross(way, (0.3, 0.5, 0.81))
        one /= np.linalg.norm(one, axis=1, keepdims=True)
        two, step = np.cross(way, one), AROUND * self.size
        beside = [np.cos(a) * one + np.sin(a) * two for a in np.arange(6) * np.pi / 3.0]
        starts = [points, *(points + step * arm for arm in (way, -way, *beside))]
        met = np.array([self._met(start, way, reach) for start in starts])
        return met[0], met.all(axis=0) | ~met.any(axis=0)

    def _met(self, start: np.ndarray, way: np.ndarray, reach: np.ndarray) -> np.ndarray:
        if self.is_net:
            return self.net.stopped(start, way, reach)
        found = np.zeros(len(start), dtype=np.bool_)
        for low in range(0, len(start), AT_ONCE):
            some = slice(low, low + AT_ONCE)
            along = np.linspace(0.0, 1.0, STEPS)[:, None] * np.minimum(reach[some], 4.0 * self.size)
            at = start[some] + along[:, :, None] * way[some]
            inside = ((at >= self.low) & (at <= self.high)).all(axis=2)
            sign = np.sign(self.surface.values(at))
            found[some] = ((sign[1:] * sign[:-1] < 0.0) & inside[1:] & inside[:-1]).any(axis=0)
        return found


def _back(shape: Surface | ImplicitSurface, points: np.ndarray) -> np.ndarray:
    placed = isinstance(shape, PlacedSurface | PlacedImplicit)
    x = np.asarray(points, dtype=np.float64)
    return (x - np.asarray(shape.shift)) @ np.linalg.inv(np.asarray(shape.matrix)) if placed else x
