"""Patches: shapes whose intersections are looked for, known by places, tangent planes and a tessellation."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.tessellation import FREE, Tessellation
from vectorplot.geometry import ragged
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.triangles.triangle_edges import edges_of
from vectorplot.geometry.vectors import cross, norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


class Patch(Protocol):
    """A shape on which places (k,d) are points, or several that are asked as one. All functions take many places at
    once."""

    @property
    def tessellation(self) -> Tessellation:
        """Triangles near the shapes, with the places of their corners."""
        ...

    @property
    def sizes(self) -> Floats:
        """(2,p) of each of the shapes the diagonal of the box around it, and its largest coordinate."""
        ...

    def numbers(self, places: Floats) -> Ints:
        """(k,) on which of the shapes places are."""
        ...

    def points(self, places: Floats) -> Floats:
        """(k,3) points; NaN in holes."""
        ...

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals; NaN where there is none."""
        ...

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,d) places moved by steps (k,3) in their tangent planes, to first order; never over a border."""
        ...

    def along_rails(self, places: Floats, rails: Ints) -> Floats:
        """(k,3) directions of the lines that rails (k,) name, at places on them."""
        ...

    def on_rails(self, places: Floats, rails: Ints) -> Floats:
        """(k,d) places put on their rails, FREE ones left alone, where rounding took them off."""
        ...

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) second derivatives of the height above the first two axes of frames (k,3,3), along the third."""
        ...

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """(k,d) the same places, as many whole periods on as brings them nearest to other places (k,d)."""
        ...

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) how many cells lie between places and others, the short way round; infinite from shape to shape."""
        ...


class SingleShape(ABC):
    """What patches of one shape answer alike."""

    @property
    @abstractmethod
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around it, and its largest coordinate."""

    @property
    def sizes(self) -> Floats:
        """(2,1) the same."""
        return np.array(self.size)[:, None]

    def numbers(self, places: Floats) -> Ints:
        """(k,) zeros: there is but one."""
        return np.zeros(len(places), dtype=np.intp)


@dataclass(frozen=True, eq=False)
class MeshPatch(SingleShape):
    """The faces of a mesh; places are x, y, z and the number of a triangle. Faces that are not planar and convex are
    cut into triangles; a planar face has one plane."""

    mesh: Mesh

    @cached_property
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around it, and its largest coordinate."""
        vertices = self.mesh.vertices
        if not len(vertices):
            return 0.0, 0.0
        return float(norm(np.ptp(vertices, axis=0))), float(np.abs(vertices).max())

    @cached_property
    def faces(self) -> Ints:
        """(t,) the face of the mesh that every triangle belongs to."""
        return self._cut[1]

    @cached_property
    def tessellation(self) -> Tessellation:
        """The triangles. Rails are the numbers of edges, of those between faces; diagonals are free."""
        triangles, faces = self._cut
        points = self.mesh.vertices
        edges, sides, uses = edges_of(triangles, len(points))
        low, high = np.full(len(edges), len(faces)), np.full(len(edges), -1)
        np.minimum.at(low, sides.ravel(), np.repeat(faces, 3))
        np.maximum.at(high, sides.ravel(), np.repeat(faces, 3))
        bent = np.zeros(len(edges), dtype=np.bool_)
        bent[sides.ravel()] = np.repeat(self._is_bent, 3)
        inner = (low == high) & (uses == 2) & ~bent
        places = np.concatenate(
            [points[triangles], np.broadcast_to(np.arange(len(faces))[:, None, None], (len(faces), 3, 1))], axis=2
        )
        rails = np.where(inner, FREE, np.arange(len(edges)))
        return Tessellation(points, triangles, places, np.arange(len(faces)), edges, sides, rails, uses == 1)

    @cached_property
    def edge_uses(self) -> Ints:
        """(e,) how many triangles every edge of the tessellation has."""
        return edges_of(self._cut[0], len(self.mesh.vertices))[2]

    def points(self, places: Floats) -> Floats:
        """(k,3) points."""
        return places[..., :3]

    def normals(self, places: Floats) -> Floats:
        """(k,3) normals of the planes of the triangles."""
        return np.asarray(self._planes[0][_triangle(places)])

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,4) places moved, and put into the plane of their triangle."""
        triangle = _triangle(places)
        normal, origin = (x[triangle] for x in self._planes)
        points = places[:, :3] + steps
        points = points - ((points - origin) * normal).sum(axis=1, keepdims=True) * normal
        return np.concatenate([points, places[:, 3:]], axis=1)

    def along_rails(self, places: Floats, rails: Ints) -> Floats:
        """(k,3) directions of edges."""
        ends = self.mesh.vertices[self.tessellation.edges[rails]]
        return np.asarray(ends[:, 1] - ends[:, 0])

    def on_rails(self, places: Floats, rails: Ints) -> Floats:
        """The places: edges are met to rounding."""
        return places

    def holds(self, places: Floats) -> Bools:
        """(k,) places within their face, its border included, not beside it in its plane."""
        triangle, own = _triangle(places), self.tessellation
        normal = self._planes[0][triangle]
        by_face = np.argsort(self.faces, kind="stable")
        first = np.searchsorted(self.faces[by_face], self.faces[triangle])
        count = np.searchsorted(self.faces[by_face], self.faces[triangle], side="right") - first
        inside = np.zeros(len(places), dtype=np.bool_)
        # A face has few triangles: each pass looks at one more of every face.
        for step in range(int(count.max(initial=0))):
            corners = own.points[own.triangles[by_face[first + np.minimum(step, count - 1)]]]
            sides = np.roll(corners, -1, axis=1) - corners
            heights = component_sum(cross(sides, places[:, None, :3] - corners) * normal[:, None])
            zero = ZERO_OF_EXTENT * self.size[0] * np.linalg.norm(sides, axis=2)
            inside |= (heights >= -zero).all(axis=1) | (heights <= zero).all(axis=1)
        return inside

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) zeros: faces are flat."""
        return np.zeros((len(places), 2, 2))

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """The places."""
        return places

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) distances, measured by the boxes of the triangles the others lie on."""
        low, high = self.tessellation.boxes
        size = np.linalg.norm(high - low, axis=0)[_triangle(others)]
        return np.asarray(np.linalg.norm(places[..., :3] - others[..., :3], axis=-1) / size)

    @cached_property
    def _cut(self) -> tuple[Ints, Ints]:
        """Triangles (t,3) with an area, and the faces (t,) they come from."""
        mesh = self.mesh
        parts = convex_faces(mesh.vertices.T, mesh.corners, mesh.offsets, ZERO_OF_EXTENT * self.size[0])
        sizes = np.diff(parts.offsets) - 2
        part = ragged.owner(sizes)
        step = ragged.place(sizes)
        first = parts.offsets[part]
        triangles = parts.corners[np.stack([first, first + step + 1, first + step + 2], axis=1)]
        face = parts.source[part]
        a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
        good = (cross(b - a, c - a) != 0.0).any(axis=1)
        if mesh.present is not None:
            good &= mesh.present[face]
        return triangles[good], face[good]

    @cached_property
    def _is_bent(self) -> Bools:
        """(t,) triangles of faces that are not planar."""
        triangles, faces = self._cut
        origin = self.mesh.vertices[self.mesh.corners[self.mesh.offsets[faces]]]
        arms = self.mesh.vertices[triangles] - origin[:, None]
        off = np.abs((arms * self.mesh.face_normals[faces][:, None]).sum(axis=2)).max(axis=1, initial=0.0)
        bent = np.zeros(self.mesh.face_count, dtype=np.bool_)
        bent[faces[off > ZERO_OF_EXTENT * self.size[0]]] = True
        return np.asarray(bent[faces])

    @cached_property
    def _planes(self) -> tuple[Floats, Floats]:
        """Unit normals and points (t,3) of the planes: of the face where it is planar, else of the triangle."""
        triangles, faces = self._cut
        a, b, c = (self.mesh.vertices[triangles[:, k]] for k in range(3))
        own = cross(b - a, c - a)
        own /= np.linalg.norm(own, axis=1, keepdims=True)
        origin = self.mesh.vertices[self.mesh.corners[self.mesh.offsets[faces]]]
        bent = self._is_bent[:, None]
        return np.where(bent, own, self.mesh.face_normals[faces]), np.where(bent, a, origin)


def _triangle(places: Floats) -> Ints:
    """The triangle that a place on a mesh names; weighted means of one number are that number but for rounding."""
    return np.asarray(np.rint(places[..., 3]), dtype=np.intp)
