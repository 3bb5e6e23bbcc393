"""The round edges of polyhedra, such as the rims of bores and of shafts, and the centre lines they call for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot
from vectorplot.scene.naming.dimensions import CROSS, centre_line, centre_mark
from vectorplot.scene.scene import Scene
from vectorplot.tolerances.of_measuring import ROUND_OF_RADIUS

FEWEST_SIDES = 12
"""A ring of fewer sides is a polygon, not a circle."""

BEYOND = 0.05
"""How far centre lines go on beyond what is round, as a part of the extent of the whole part."""


@dataclass(frozen=True)
class RoundEdge:
    """An edge that is a circle but for the chords of its mesh: across one of the axes (0, 1, 2)."""

    centre: tuple[float, float, float]
    radius: float
    axis: int


def round_edges(mesh: Mesh, crease_angle_deg: float) -> tuple[RoundEdge, ...]:
    """The rings of sharp edges of a mesh that are circles across a coordinate axis.

    Degenerate: rings that other sharp edges meet are none, nor are those of fewer than twelve sides.
    """
    ends = _sharp_edges(mesh, crease_angle_deg)
    if not len(ends):
        return ()
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    vertices, number = np.unique(ends, return_inverse=True)
    number = number.reshape(-1, 2)
    count = len(vertices)
    joined = coo_array((np.ones(len(ends)), (number[:, 0], number[:, 1])), shape=(count, count))
    rings, ring = connected_components(joined, directed=False)
    size = np.bincount(ring, minlength=rings)
    single = np.bincount(ring, np.bincount(number.ravel(), minlength=count) == 2, rings) == size
    points = mesh.vertices[vertices]
    totals = np.stack([np.bincount(ring, column, rings) for column in points.T], axis=1)
    centre = totals / size[:, None]
    away = points - centre[ring]
    order = np.argsort(ring, kind="stable")
    first = np.concatenate([[0], np.cumsum(size)[:-1]])
    reach = np.maximum.reduceat(np.abs(away[order]), first)
    found = []
    for axis in range(3):
        across = np.delete(away, axis, axis=1)
        far = np.hypot(*across.T)
        high, low = np.maximum.reduceat(far[order], first), np.minimum.reduceat(far[order], first)
        zero = ROUND_OF_RADIUS * high
        for k in np.flatnonzero(single & (size >= FEWEST_SIDES) & (reach[:, axis] <= zero) & (high - low <= zero)):
            x, y, z = centre[k].tolist()
            found.append(RoundEdge((x, y, z), float(high[k]), axis))
    return tuple(found)


def centre_lines_of(edges: Sequence[RoundEdge], extent: float) -> tuple[Scene, ...]:
    """The axis of every set of round edges in one line, and the centre mark of the largest of them.

    extent: of the part.
    """
    near = ROUND_OF_RADIUS * extent
    lines: dict[tuple[int, ...], list[RoundEdge]] = {}
    for edge in edges:
        across = [round(place / near) for number, place in enumerate(edge.centre) if number != edge.axis]
        lines.setdefault((edge.axis, *across), []).append(edge)
    found = []
    for same in lines.values():
        largest = max(same, key=lambda edge: edge.radius)
        along = np.eye(3)[largest.axis]
        heights = [edge.centre[largest.axis] for edge in same]
        foot = np.array(largest.centre) * (1.0 - along)
        low, high = min(heights) - BEYOND * extent, max(heights) + BEYOND * extent
        found.append(centre_line(foot + low * along, foot + high * along))
        beyond = min(BEYOND * extent, CROSS * largest.radius)
        found.append(centre_mark(largest.centre, largest.radius, along, beyond=beyond))
    return tuple(found)


def _sharp_edges(mesh: Mesh, angle_deg: float) -> Ints:
    """(k,2) the ends of edges between two faces that meet at a larger angle."""
    ends = np.sort(np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1), axis=1)
    key = ends[:, 0] * np.intp(len(mesh.vertices)) + ends[:, 1]
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    one, other = order[:-1][same], order[1:][same]
    normals: Floats = mesh.face_normals
    cosine = dot(normals[mesh.corner_face[one]], normals[mesh.corner_face[other]])
    sharp: Ints = ends[one[cosine < np.cos(np.radians(angle_deg))]]
    return sharp
