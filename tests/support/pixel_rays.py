"""Rays of another make through the centres of pixels."""

from __future__ import annotations

import numpy as np

from support.triangle_rays import TriangleRays
from vectorplot.geometry.camera import Camera
from vectorplot.shading.screen import raster_system


def pixel_rays(camera: Camera, columns: int, rows: int):
    """Origins and unit directions, each (rows * columns, 3), of the rays through the pixels' centres."""
    system = raster_system(camera, columns, rows)
    row, column = np.divmod(np.arange(rows * columns), columns)
    there = system.to_world(np.stack([column, row, np.zeros(len(row))], axis=1).astype(np.float64))
    if camera.parallel:
        forward = np.broadcast_to(-camera.direction, there.shape)
        return there - 3.0 * camera.distance * forward, forward
    forward = there - np.asarray(camera.eye)
    forward = forward / np.linalg.norm(forward, axis=1)[:, None]
    return np.broadcast_to(camera.eye, there.shape), forward


def first_triangles(vertices, triangles, origin, direction):
    """(n,) the triangle each ray meets first, -1 for none."""
    return TriangleRays(np.asarray(vertices)[triangles]).first(origin, direction)


def beside_edges(picture):
    """(rows, columns) which pixels have a neighbour, also across a corner, with another number."""
    padded = np.pad(picture, 1, mode="edge")
    rows, columns = picture.shape
    found = np.zeros(picture.shape, dtype=bool)
    for down in range(3):
        for along in range(3):
            found |= padded[down : down + rows, along : along + columns] != picture
    return found


def stopped(vertices, triangles, places, normals, light):
    """(n,) whether a ray from places (n, 3), a little above their faces, to a light meets a triangle; and (n,) which
    faces look at the light."""
    size = np.ptp(vertices, axis=0).max()
    target = np.asarray(light.position, dtype=np.float64)
    way = np.broadcast_to(target, places.shape) if light.parallel else target - places
    distance = np.linalg.norm(way, axis=1)
    way = way / distance[:, None]
    reach = np.full(len(places), 1e6 * size) if light.parallel else distance * (1.0 - 1e-4)
    rays = TriangleRays(np.asarray(vertices)[triangles])
    return rays.stopped(places + 1e-4 * size * normals, way, reach), (normals * way).sum(axis=1) > 0.02
