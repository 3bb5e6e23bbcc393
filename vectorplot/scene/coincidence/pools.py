"""The pools of a scene: the points, edges and faces of all polyhedra, one item after the other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.adjacency import mesh_edges
from vectorplot.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class Pools:
    """What all items of a scene are made of, found by index.

    points (v,3); corners (c,) indices of points, offsets (f+1,) as in Mesh, of the faces that are present; face_item
    (f,); item_vertices (i+1,): item k has the points item_vertices[k] to item_vertices[k+1]. Smooth surfaces and curves
    have none. Indices of a scene stay what they are when items are added behind its own.
    Source: Glaeser, section 3.1; errata G3-02, G3-03.
    """

    points: Floats
    corners: Ints
    offsets: Ints
    face_item: Ints
    item_vertices: Ints

    @cached_property
    def edges(self) -> Ints:
        """(e,2) the points of every edge of every item, each edge once, one item after the other."""
        return mesh_edges(Mesh(self.points, self.corners, self.offsets))

    @cached_property
    def item_edges(self) -> Ints:
        """(i+1,): item k has the edges item_edges[k] to item_edges[k+1]."""
        return np.searchsorted(self.edges[:, 0], self.item_vertices)

    @cached_property
    def item_faces(self) -> Ints:
        """(i+1,): item k has the faces item_faces[k] to item_faces[k+1]."""
        return np.searchsorted(self.face_item, np.arange(len(self.item_vertices)))


def pools(scene: Scene) -> Pools:
    """The pools of a scene. Degenerate: those of an empty scene are empty."""
    meshes = [item.mesh for item in scene.items]
    counts = np.array([len(mesh.vertices) for mesh in meshes], dtype=np.intp)
    first_vertex = ragged.offsets(counts)
    return Pools(scene.vertices, *_faces(meshes, first_vertex), first_vertex)


def _faces(meshes: list[Mesh], first_vertex: Ints) -> tuple[Ints, Ints, Ints]:
    """Corners, offsets and item of all present faces."""
    if len(meshes) == 1 and meshes[0].present is None:
        return meshes[0].corners, meshes[0].offsets, np.zeros(meshes[0].face_count, dtype=np.intp)
    none = np.zeros(0, dtype=np.intp)
    corner_counts = np.array([len(m.corners) for m in meshes], dtype=np.intp)
    corners = np.concatenate([m.corners for m in meshes] or [none]) + np.repeat(first_vertex[:-1], corner_counts)
    ends = np.concatenate([m.offsets[1:] for m in meshes] or [none])
    face_counts = np.array([len(m.offsets) for m in meshes], dtype=np.intp) - 1
    starts = ragged.offsets(corner_counts)[:-1]
    offsets = np.concatenate([[0], ends + np.repeat(starts, face_counts)])
    face_item = ragged.owner(face_counts)
    if all(m.present is None for m in meshes):
        return corners, offsets, face_item
    present = np.concatenate(
        [np.ones(m.face_count, dtype=np.bool_) if m.present is None else m.present for m in meshes]
    )
    sizes = np.diff(offsets)
    kept = np.repeat(present, sizes)
    return corners[kept], ragged.offsets(sizes[present]), face_item[present]
