"""A mesh taken apart along its creases: what is left is smooth, and its normals may be averaged."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.geometry.vectors import dot


def apart_at_creases(mesh: Mesh, crease_angle_deg: float) -> Mesh:
    """The mesh with vertices of their own for faces that no way around the vertex joins but over edges at which two
    faces turn by more than an angle, or more than two meet; the same faces in the same order.

    Degenerate: faces without a normal turn by nothing. A mesh without creases is as it was.
    """
    part = _parts_at_vertices(mesh, crease_angle_deg)
    first = np.unique(part, return_index=True)[1]
    vertex = mesh.corners[first]
    # The first part at a vertex keeps its number.
    again = np.ones(len(first), dtype=np.bool_)
    again[np.unique(vertex, return_index=True)[1]] = False
    if not again.any():
        return mesh
    number = np.where(again, len(mesh.vertices) + np.cumsum(again) - 1, vertex)
    vertices = np.concatenate([mesh.vertices, mesh.vertices[vertex[again]]])
    return Mesh(vertices, number[part], mesh.offsets, mesh.present)


def _parts_at_vertices(mesh: Mesh, crease_angle_deg: float) -> Ints:
    """(c,) for each corner the number of the part at its vertex, 0, 1, ... as they come."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    uses = edge_uses(mesh)
    pair = uses.first[uses.count == 2]
    one, two = uses.corner[pair], uses.corner[pair + 1]
    normals = mesh.face_normals
    n, m = normals[mesh.corner_face[one]], normals[mesh.corner_face[two]]
    # Faces that go around the same way have opposite ways along their edge.
    alike = mesh.corners[one] == mesh.corners[two]
    cosine = np.where(alike, -1.0, 1.0) * dot(n, m)
    flat = ~n.any(axis=1) | ~m.any(axis=1)
    kept = np.flatnonzero(flat | (cosine >= np.cos(np.radians(crease_angle_deg))))
    one, two, alike = one[kept], two[kept], alike[kept]
    after_one, after_two = mesh.next_corner[one], mesh.next_corner[two]
    start = np.concatenate([one, after_one])
    end = np.concatenate([np.where(alike, two, after_two), np.where(alike, after_two, two)])
    count = len(mesh.corners)
    links = coo_array((np.ones(len(start), dtype=np.bool_), (start, end)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)
