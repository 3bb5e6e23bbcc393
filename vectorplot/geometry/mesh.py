"""Polygon meshes: vertices, and faces that stay polygons."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.connectivity import faces_are_closed, pieces_of_faces
from vectorplot.geometry.rotations import Movable
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances import LEAST_DIVISOR


def next_positions(offsets: Ints, position: Ints) -> Ints:
    """(n,) where the corners stand that follow those at some positions, in faces with the offsets (f+1,)."""
    if offsets[-1] == 3 * (len(offsets) - 1):
        return position + np.where(position % 3 == 2, -2, 1)
    return np.asarray(ragged.following(offsets)[position], dtype=np.intp)


TRIANGLE = 3
"""Corners of the faces that some functions take alone."""


@dataclass(frozen=True, eq=False)
class Mesh(Movable["Mesh"]):
    """Vertices and polygonal faces, counter-clockwise seen from outside.

    Parameters
    ----------
    vertices : (n, 3) array of float64
        In world units.
    corners : (c,) array of int
        Vertex indices of all faces one after the other.
    offsets : (f+1,) array of int
        Face i has the corners offsets[i] to offsets[i+1].
    present : (f,) array of bool, optional
        False for a face that only closes the body in the mind (the open top of a hollow body): it is stored, but
        neither drawn nor does it hide.

    Raises
    ------
    InputError
        For wrong shapes, coordinates that are not finite, indices out of range, faces of fewer than three corners.

    Notes
    -----
    Edge cases: a mesh without faces is allowed.

    Source: Glaeser, Fast Algorithms for 3D-Graphics, sections 3.1 to 3.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 2)]
    >>> pyramid = vp.Mesh.from_polygons(corners, [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> pyramid.face_count, pyramid.is_triangular
    (5, False)
    >>> pyramid.bounds.tolist()
    [[0.0, 0.0, 0.0], [2.0, 2.0, 2.0]]
    """

    vertices: Floats
    corners: Ints
    offsets: Ints
    present: Bools | None = None

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(self.vertices, dtype=np.float64)
        corners = np.ascontiguousarray(self.corners, dtype=np.intp)
        offsets = np.ascontiguousarray(self.offsets, dtype=np.intp)
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise InputError(f"vertices must have shape (n, 3), not {vertices.shape}")
        if corners.ndim != 1 or offsets.ndim != 1 or not len(offsets) or offsets[0] != 0 or offsets[-1] != len(corners):
            raise InputError("offsets must run from 0 to the number of corners")
        if len(offsets) > 1 and (offsets[1:] - offsets[:-1]).min() < 3:
            raise InputError(f"face {int(np.argmin(np.diff(offsets))) + 1} has fewer than three corners")
        if len(corners) and (corners.min() < 0 or corners.max() >= len(vertices)):
            bad = int(np.argmax((corners < 0) | (corners >= len(vertices))))
            face = int(np.searchsorted(offsets, bad, side="right")) - 1
            cause = f"face {face} names vertex {int(corners[bad])}, there are {len(vertices)}, counted from 0"
            raise InputError(cause)
        if len(vertices) and not np.isfinite(vertices.min() + vertices.max()):
            bad = int(np.argmax(~np.isfinite(vertices).all(axis=1)))
            raise InputError(f"vertex {bad}, counted from 0, has a coordinate that is not a finite number")
        for name, array in (("vertices", vertices), ("corners", corners), ("offsets", offsets)):
            object.__setattr__(self, name, array)
        if self.present is not None:
            present = np.ascontiguousarray(self.present, dtype=np.bool_)
            if present.shape != (len(offsets) - 1,):
                raise InputError(f"present must have one flag a face, not shape {present.shape}")
            object.__setattr__(self, "present", None if present.all() else present)

    @classmethod
    def from_polygons(
        cls, vertices: ArrayLike, faces: Iterable[Sequence[int]], *, present: ArrayLike | None = None
    ) -> Mesh:
        """The mesh of faces given as lists of vertex indices from 0.

        Parameters
        ----------
        vertices : (n, 3) array_like of float
            In world units.
        faces : iterable of sequences of int
            The corners of every face, counter-clockwise seen from outside.
        present : (f,) array_like of bool, optional
            See Mesh.

        Returns
        -------
        Mesh
            Its faces in the same order.

        Raises
        ------
        InputError
            For what Mesh refuses.

        Examples
        --------
        >>> import vectorplot as vp
        >>> square = vp.Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
        >>> square.polygons()
        [[0, 1, 2, 3]]
        """
        lists = [list(face) for face in faces]
        corners = whole_numbers(np.array([corner for face in lists for corner in face]))
        offsets = ragged.offsets([len(face) for face in lists])
        flags = None if present is None else np.asarray(present, dtype=np.bool_)
        return cls(np.asarray(vertices, dtype=np.float64).reshape(-1, 3), corners, offsets, flags)

    @classmethod
    def from_triangles(cls, vertices: ArrayLike, triangles: ArrayLike) -> Mesh:
        """The mesh of triangles of vertex indices from 0.

        Parameters
        ----------
        vertices : (n, 3) array_like of float
            In world units.
        triangles : (t, 3) array_like of int
            The corners of every triangle, counter-clockwise seen from outside.

        Returns
        -------
        Mesh
            Its faces in the same order.

        Raises
        ------
        InputError
            For what Mesh refuses.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]).is_triangular
        True
        """
        corners = whole_numbers(np.asarray(triangles)).reshape(-1)
        return cls(np.asarray(vertices, dtype=np.float64), corners, np.arange(0, len(corners) + 1, 3, dtype=np.intp))

    @classmethod
    def _trusted(cls, vertices: Floats, corners: Ints, offsets: Ints, present: Bools | None = None) -> Mesh:
        """The mesh of arrays that their maker knows to be right: contiguous, of the right types, finite, in range.

        present is None where all faces are. For makers of solids inside the package: the checks cost ten times the
        rest."""
        mesh = object.__new__(cls)
        mesh.__dict__.update(vertices=vertices, corners=corners, offsets=offsets, present=present)
        return mesh

    @property
    def face_count(self) -> int:
        """How many faces there are, present or not."""
        return len(self.offsets) - 1

    @property
    def is_triangular(self) -> bool:
        """Whether every face is a triangle."""
        return len(self.corners) == 3 * self.face_count

    @cached_property
    def face_sizes(self) -> Ints:
        """(f,) number of corners of every face."""
        return np.diff(self.offsets)

    @cached_property
    def corner_face(self) -> Ints:
        """(c,) the face every corner belongs to."""
        return ragged.owner(self.face_sizes)

    @cached_property
    def next_corner(self) -> Ints:
        """(c,) position in corners of the corner that follows in the same face."""
        return ragged.following(self.offsets)

    def polygons(self) -> list[list[int]]:
        """The faces as lists of vertex indices from 0."""
        corners = self.corners.tolist()
        return [corners[a:b] for a, b in zip(self.offsets[:-1].tolist(), self.offsets[1:].tolist(), strict=True)]

    @cached_property
    def area_vectors(self) -> Floats:
        """(f,3) vector along the outer normal, its length twice the area of the face.

        Newell's sum about the face's first corner, so that an offset of the scene costs no digits.
        """
        v = self.vertices
        if self.is_triangular:
            a, b, c = (v[self.corners[k::3]] for k in range(3))
            return cross(b - a, c - a)
        first = v[self.corners[self.offsets[:-1]]]
        arm = v[self.corners] - first[self.corner_face]
        return np.add.reduceat(cross(arm, arm[self.next_corner]), self.offsets[:-1], axis=0) if len(first) else first

    @cached_property
    def face_normals(self) -> Floats:
        """(f,3) unit outer normals; (0,0,0) for a face without area."""
        length = np.sqrt(np.einsum("ij,ij->i", self.area_vectors, self.area_vectors))
        return self.area_vectors / np.where(length > 0.0, length, 1.0)[:, None]

    @cached_property
    def is_closed(self) -> bool:
        """Whether every edge is run along as often in one direction as in the other (see is_closed_oriented)."""
        return faces_are_closed(len(self.vertices), self.corners, self.offsets)

    @cached_property
    def pieces(self) -> tuple[int, Ints]:
        """How many pieces the faces make, and (f,) the piece of each; pieces are joined where they share a vertex."""
        return pieces_of_faces(len(self.vertices), self.corners, self.offsets)

    @cached_property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates; zeros for a mesh without vertices."""
        if len(self.vertices) == 0:
            return np.zeros((2, 3))
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def transformed(self, matrix: ArrayLike) -> Mesh:
        """The same mesh under a 4x4 matrix acting on columns.

        Parameters
        ----------
        matrix : (4, 4) array_like of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        Mesh
            A mirroring matrix turns the faces round, so that they stay counter-clockwise from outside.

        Raises
        ------
        InputError
            For what Mesh refuses.

        Examples
        --------
        >>> import numpy as np
        >>> import vectorplot as vp
        >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        >>> triangle.transformed(np.diag([-1.0, 1.0, 1.0, 1.0])).polygons()
        [[2, 1, 0]]
        """
        m = np.asarray(matrix, dtype=np.float64)
        with np.errstate(over="ignore", invalid="ignore"):
            vertices = matmul(self.vertices, m[:3, :3].T) + m[:3, 3]
        if determinant(m[:3, :3] / max(float(np.abs(m[:3, :3]).max()), LEAST_DIVISOR)) >= 0.0:
            return Mesh(vertices, self.corners, self.offsets, self.present)
        return Mesh(vertices, self.corners, self.offsets, self.present).reversed()

    def reversed(self) -> Mesh:
        """The same mesh with every face listed the other way round."""
        mirrored = (self.offsets[:-1] + self.offsets[1:])[self.corner_face] - 1
        order = mirrored - np.arange(len(self.corners))
        return Mesh(self.vertices, self.corners[order], self.offsets, self.present)


def whole_numbers(indices: NDArray[Any]) -> Ints:
    """Indices as whole numbers, which floats may be too. Errors: InputError for what is none."""
    if indices.dtype.kind in "iu" or not indices.size:
        return indices.astype(np.intp)
    with np.errstate(invalid="ignore"):
        cut = indices.astype(np.intp)
    wrong = np.flatnonzero(cut.ravel() != indices.ravel())
    if len(wrong):
        raise InputError(f"faces: {indices.ravel()[wrong[0]]} is no index of a vertex")
    return cut
