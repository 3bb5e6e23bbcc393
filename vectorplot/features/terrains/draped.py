"""Lines of a plan laid onto a terrain."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.terrains.places import Ground
from vectorplot.geometry.mesh import TRIANGLE
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def draped(ground: Ground, plan: Floats) -> tuple[Floats, Ints]:
    """The points (n,3) on a terrain above a line (k,2) of the plan, those in which it passes from one triangle to the
    next among them, and the triangles (n-1,) between these.

    Degenerate: -1 and NaN heights beside the terrain.
    """
    mesh = ground.mesh
    centre = mesh.bounds.mean(axis=0)[:2]
    line = plan - centre
    segments = np.stack([line[:-1], line[1:]], axis=1)
    row, face = ground.near(plan)
    sides = TRIANGLE * np.repeat(face, TRIANGLE) + np.tile(np.arange(TRIANGLE), len(face))
    row = np.repeat(row, TRIANGLE)
    # Both triangles of an edge have it from the same end: where it is met is the same number.
    ends = np.sort(np.stack([mesh.corners[sides], mesh.corners[mesh.next_corner[sides]]], axis=1), axis=1)
    edges = mesh.vertices[ends][..., :2] - centre
    start, way = segments[row, 0], segments[row, 1] - segments[row, 0]
    base, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        part, place = _cross(base - start, along) / _cross(way, along), _cross(base - start, way) / _cross(way, along)
    inner = (part > ZERO_OF_EXTENT) & (part < 1.0 - ZERO_OF_EXTENT) & (place >= 0.0) & (place <= 1.0)
    where = np.unique(np.concatenate([np.arange(len(line), dtype=np.float64), row[inner] + part[inner]]))
    number = np.minimum(where.astype(np.intp), len(segments) - 1)
    places = plan[number] + (where - number)[:, None] * (plan[number + 1] - plan[number])
    _, points = ground.below(places)
    faces, _ = ground.below(0.5 * (places[:-1] + places[1:]))
    return points, faces


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
