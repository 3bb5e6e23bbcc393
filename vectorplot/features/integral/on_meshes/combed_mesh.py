"""A mesh and a field of directions as what curves are to cover evenly: places on it, and curves through them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.integral.bent_faces import BentFaces
from vectorplot.features.integral.face_sites import FaceSites
from vectorplot.features.integral.on_meshes.mesh_flows import FaceFieldFlow
from vectorplot.features.integral.on_meshes.mesh_integral_curves import led_curves, starts_in_faces
from vectorplot.features.integral.on_meshes.mesh_sides import MeshSides
from vectorplot.features.integral.sites import unit
from vectorplot.features.integral.spacing.uncrowded_lines import NEAREST
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.meshes.mesh_curves import NO_FACE, FaceTriangles, MeshCurves, face_triangles
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import norm

MOST_PLACES = 40_000
"""Places at which gaps are looked for, at most, as far as triangles need not be divided for them."""


@dataclass(frozen=True, eq=False)
class CombedMesh:
    """A mesh (bent: and how it bends), a field, and the distance of curves; turned: the flow at right angles to that of
    the field.

    Places are x, y, z and the number of the face (k,4); nodes (k,) count the points of curves that are led round, and
    what part of the way to the next one.
    """

    bent: BentFaces
    field: TangentField
    apart: float
    sides: MeshSides
    flow: FaceFieldFlow
    turned: FaceFieldFlow

    @property
    def mesh(self) -> Mesh:
        """On which they run."""
        return self.bent.mesh

    @property
    def extent(self) -> float:
        """Of the mesh."""
        return self.sides.extent

    @cached_property
    def normals(self) -> Floats:
        """(f,3) of the faces, zero of those without area."""
        return np.nan_to_num(unit(self.mesh.face_normals))

    def over(self) -> Floats:
        """Places all over the mesh where the field has a direction."""
        points, face = _all_over(face_triangles(self.mesh), self.apart)
        sites = FaceSites(points, unit(self.mesh.face_normals)[face], self.bent, face)
        known = np.isfinite(self.field.tangents(sites)[0]).all(axis=1)
        return np.asarray(np.column_stack([points, face])[known])

    def where(self, places: Floats) -> Floats:
        """(k,6) points, and normals of the length of the distance."""
        return np.concatenate([places[:, :3], self.apart * self.normals[places[:, 3].astype(np.intp)]], axis=1)

    def along(self, places: Floats) -> MeshCurves:
        """Curves of the field through places."""
        return self._led(self.flow, places, None)

    def across(self, places: Floats) -> MeshCurves:
        """Curves at right angles to the field."""
        return self._led(self.turned, places, self.extent)

    def _led(self, flow: FaceFieldFlow, places: Floats, length: float | None) -> MeshCurves:
        face, own = starts_in_faces(
            "evenly spaced curves", self.mesh, self.sides, places[:, 3].astype(np.intp), places[:, :3]
        )
        return led_curves(self.sides, flow, face, own, flow.candidates[0, face], length, True, NEAREST * self.apart)

    def at(self, curves: MeshCurves, node: Floats) -> Floats:
        """(k,4) the places at nodes of curves."""
        rounds = closed_round(curves)
        points = _between(curves.points[rounds.index], node)
        return np.column_stack([points, self._faces(curves, rounds.index, node)])

    def _faces(self, curves: MeshCurves, index: Ints, node: Floats) -> Ints:
        """(k,) the faces at nodes of curves that are led round; at the ends that of the last segment."""
        face = curves.faces[index]
        own = face[np.floor(node).astype(np.intp)]
        return np.where(own == NO_FACE, face[np.maximum(np.floor(node).astype(np.intp) - 1, 0)], own)

    def parts(self, curves: MeshCurves, line: Ints, first: Floats, last: Floats) -> MeshCurves:
        """Parts of curves as open ones, from node to node."""
        node, offsets = _inner_nodes(line, first, last)
        places = self.at(curves, node)
        faces = places[:, 3].astype(np.intp)
        faces[offsets[1:] - 1] = NO_FACE
        return MeshCurves(
            np.ascontiguousarray(places[:, :3]),
            offsets,
            np.zeros(len(line), dtype=np.bool_),
            faces,
            curves.levels[line],
        )


def _all_over(faces: FaceTriangles, apart: float) -> tuple[Floats, Ints]:
    """Points (k,3) about half a distance from each other all over triangles, and the face (k,) of each."""
    corners = faces.mesh.vertices[faces.triangles]
    longest = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
    rows = np.maximum(np.ceil(2.0 * longest / apart), 1.0)
    rows = np.maximum(np.floor(rows * np.sqrt(min(1.0, MOST_PLACES / (rows * rows).sum()))), 1.0).astype(np.intp)
    # Of the small triangles that each is divided into, row by row from its first corner, the middles.
    count = rows * rows
    place, own = ragged.place(count), ragged.owner(count)
    row = np.floor(np.sqrt(place)).astype(np.intp)
    column, upside = np.divmod(place - row * row, 2)
    down, aside = (3 * row + 2 - upside) / 3.0, (3 * column + 1 + upside) / 3.0
    weights = np.stack([rows[own] - down, down - aside, aside], axis=1) / rows[own, None]
    points = np.einsum("ij,ijk->ik", weights, corners[own])
    # Where triangles are smaller than needed, one of those that are as good as in one place is enough.
    cell = np.floor((points - faces.mesh.bounds[0]) / (0.5 * apart)).astype(np.int64)
    normals = np.nan_to_num(unit(faces.mesh.face_normals))[faces.face[own]]
    _, first = np.unique(np.column_stack([cell, np.rint(2.0 * normals)]), axis=0, return_index=True)
    first.sort()
    return points[first], faces.face[own][first]


def _inner_nodes(line: Ints, first: Floats, last: Floats) -> tuple[Floats, Ints]:
    """The nodes (n,) at the ends of parts of curves and at all points between, part after part, and offsets (k+1,)."""
    inner = np.floor(first).astype(np.intp) + 1
    sizes = np.maximum(np.ceil(last).astype(np.intp) - inner, 0)
    node = np.concatenate([first, ragged.ranges(inner, sizes).astype(np.float64), last])
    owner = np.concatenate([np.arange(len(line)), ragged.owner(sizes), np.arange(len(line))])
    order = np.lexsort((node, owner))
    return node[order], ragged.offsets(sizes + 2)


def _between(nodes: Floats, node: Floats) -> Floats:
    """(k,d) what is on the way from one of the points (n,d) of curves to the next one."""
    low = np.floor(node).astype(np.intp)
    high = np.minimum(low + 1, len(nodes) - 1)
    begin = nodes[low]
    return np.asarray(begin + (node - low)[:, None] * (nodes[high] - begin))
