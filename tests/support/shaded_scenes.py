"""Triangles to be shaded."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.shading.depth_buffers import depth_buffer
from vectorplot.shading.lighting import visible_points
from vectorplot.shading.screen import raster_system, screen_triangles
from vectorplot.testing.shapes import box, bumpy_icosphere, grid_graph, rotated_boxes, torus_mesh

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
        corners.append(mesh.corners[ragged.fans(mesh.offsets)[0]] + first)
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
        return triangles_of(Mesh.from_triangles(*triangles_of(torus)), floor(5.0, -0.8), box((0, 0, 0), (1, 1, 2)))
    return triangles_of(grid_graph(20))


def visible(points, corners, camera, columns=COLUMNS, rows=ROWS):
    """What is seen: the visible points, their places in the world, and unit normals of their faces towards the eye."""
    homogeneous = raster_system(camera, columns, rows).homogeneous(points)
    found = visible_points(depth_buffer(screen_triangles(homogeneous, corners), columns, rows), homogeneous, corners)
    places = found.interpolated(points)
    a, b, c = (points[found.corners[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    way = np.asarray(camera.eye) - places if not camera.parallel else np.broadcast_to(camera.direction, places.shape)
    return found, places, np.where((normals * way).sum(axis=1)[:, None] < 0.0, -normals, normals)


def field(count=300, seed=0):
    """Blocks on a large square, down to the corner where the eye stands."""
    rng = np.random.default_rng(seed)
    blocks = [floor(100.0, 0.0)]
    for number in range(count):
        x, y = rng.uniform(-98.0, 98.0, 2) if number % 3 else (rng.uniform(-8.0, 8.0), rng.uniform(-95.0, -75.0))
        size = np.append(rng.uniform(0.3, 1.5, 2), rng.uniform(0.5, 4.0))
        blocks.append(box((x, y, 0.0), (x + size[0], y + size[1], size[2])))
    return triangles_of(*blocks)


FIELD_CAMERA = Camera((0.0, -100.0, 5.0), (0.0, -60.0, 0.0), fov_deg=40.0)
