"""Triangles to be shaded."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box
from vectorplot.shading.screen import fans
from vectorplot.testing.shapes import rotated_boxes
from vectorplot.testing.surfaces import bumpy_icosphere, grid_graph, torus_mesh

COLUMNS, ROWS = 320, 240


def camera_of(points, seed):
    low, high = points.min(axis=0), points.max(axis=0)
    rng = np.random.default_rng(seed)
    way = rng.normal(size=3) + np.array((0.0, 0.0, 0.5))
    eye = (low + high) / 2.0 + 1.1 * np.linalg.norm(high - low) * way / np.linalg.norm(way)
    return Camera(tuple(eye), tuple((low + high) / 2.0), fov_deg=35.0, parallel=bool(seed % 3 == 2))


def triangles_of(*meshes: Mesh):
    """Vertices and triangles of meshes with convex faces, together."""
    points, corners, first = [], [], 0
    for mesh in meshes:
        points.append(mesh.vertices)
        corners.append(fans(mesh.corners, mesh.offsets)[0] + first)
        first += len(mesh.vertices)
    return np.concatenate(points), np.concatenate(corners)


def floor(size: float, height: float) -> Mesh:
    """A square of triangles, large against what stands on it."""
    corner = np.array([(-size, -size, height), (size, -size, height), (size, size, height), (-size, size, height)])
    return Mesh.from_triangles(corner, np.array([(0, 1, 2), (0, 2, 3)]))


def sample(seed: int):
    """One of several kinds of scenes: boxes that pierce each other, a bumpy sphere, a torus on a floor, a graph."""
    kind = seed % 4
    if kind == 0:
        scene = rotated_boxes(60, seed=seed)
        return triangles_of(*(item.mesh for item in scene.items))
    if kind == 1:
        return triangles_of(bumpy_icosphere(4))
    if kind == 2:
        torus = torus_mesh()
        return triangles_of(Mesh.from_triangles(*triangles_of(torus)), floor(5.0, -0.8), box((1, 1, 2)))
    return triangles_of(grid_graph(20))
