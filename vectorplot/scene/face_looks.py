"""Colours and materials that single faces of a polyhedron have for themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.material import Material
from vectorplot.words import check_colour


@dataclass(frozen=True)
class FaceLook:
    """How a face looks.

    Parameters
    ----------
    colour : str, optional
        The name of a palette, a plain colour or #rrggbb (None: that of its item).
    material : Material, optional
        How it takes light (None: as its item).

    Raises
    ------
    InputError
        For an unknown colour.

    Examples
    --------
    >>> from vectorplot.scene import FaceLook
    >>> from vectorplot.scene.material import Material
    >>> FaceLook("red", Material("mirror")).material.is_mirror
    True
    """

    colour: str | None = None
    material: Material | None = None

    def __post_init__(self) -> None:
        if self.colour is not None:
            check_colour(self.colour, "a face: ")


@dataclass(frozen=True, eq=False)
class FaceLooks:
    """Which faces of a mesh have a look of their own.

    Parameters
    ----------
    mesh : Mesh
        As it was when faces got their looks; what is drawn may be repaired, cut and divided since.
    looks : tuple of FaceLook
        All that there are.
    of_face : (f,) array of int
        Which of them a face of the mesh has, -1 for that of its item.
    first : int
        The number in the scene of the item without faces that stands for the first look; -1 where there is none.

    Raises
    ------
    InputError
        Where there is not one number a face, and for numbers of no look.

    Notes
    -----
    A face has the look of the face of this mesh in which its middle lies.

    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> from vectorplot.scene import FaceLook, FaceLooks
    >>> from vectorplot.scene.item import Item
    >>> box = geometry.box((1, 1, 1))
    >>> looks = FaceLooks.of(box, {5: FaceLook("red")})
    >>> looks.at(box).tolist()
    [-1, -1, -1, -1, -1, 0]
    >>> vp.paint(Item("box", box, face_looks=looks), vp.Camera((3, 2, 2)))
    <Drawing '': 210x297 mm, marks: fills 9>
    """

    mesh: Mesh
    looks: tuple[FaceLook, ...]
    of_face: Ints
    first: int = -1

    def __post_init__(self) -> None:
        of_face = np.ascontiguousarray(self.of_face, dtype=np.intp)
        if of_face.shape != (self.mesh.face_count,):
            raise InputError(f"looks of faces: expected one number a face, not shape {of_face.shape}")
        if len(of_face) and not -1 <= of_face.min() <= of_face.max() < len(self.looks):
            raise InputError(f"looks of faces: expected -1 to {len(self.looks) - 1}")
        object.__setattr__(self, "of_face", of_face)

    @classmethod
    def of(cls, mesh: Mesh, looks: Mapping[int, FaceLook]) -> FaceLooks:
        """The looks of faces by their indices from 0. Errors: InputError for a face that is not there."""
        kinds = list(dict.fromkeys(looks.values()))
        of_face = np.full(mesh.face_count, -1, dtype=np.intp)
        for face, own in looks.items():
            if not 0 <= face < mesh.face_count:
                cause = f"there is no face {face + 1}, faces run from 1 to {mesh.face_count}"
                raise InputError(f"looks of faces: {cause}")
            of_face[face] = kinds.index(own)
        return cls(mesh, tuple(kinds), of_face)

    def at(self, mesh: Mesh) -> Ints:
        """(f,) which look each face of a mesh has that was made of this one, -1 for that of its item."""
        same = mesh is self.mesh or (
            np.array_equal(mesh.offsets, self.mesh.offsets)
            and np.array_equal(mesh.corners, self.mesh.corners)
            and np.array_equal(mesh.vertices, self.mesh.vertices)
        )
        if same:
            return self.of_face
        found = np.full(mesh.face_count, -1, dtype=np.intp)
        place, _, _, face = PlacedTriangles(self.mesh).places(_middles(mesh))
        found[place] = self.of_face[face]
        return found

    def seen_at(self, mesh: Mesh, points: Floats, eye: Floats, distance: float) -> Ints:
        """(n,) the look of the face of a mesh made of this one on which each of some points (n,3) lies, -1 for that of
        its item.

        eye: (x, y, z, 1), or (x, y, z, 0) for parallel rays from there; distance: what is no farther from a face lies
        on it. Where faces meet, the one that is turned to the eye counts, of several the one listed first.
        """
        if not mesh.face_count:
            return np.full(len(points), -1, dtype=np.intp)
        point, face = PlacedTriangles(mesh).faces_at(points, distance)
        if mesh.present is not None:
            point, face = point[mesh.present[face]], face[mesh.present[face]]
        away = dot(mesh.face_normals, eye[:3] - eye[3] * mesh.vertices[mesh.corners[mesh.offsets[:-1]]]) <= 0.0
        order = np.lexsort((face, away[face], point))
        first = order[np.diff(point[order], prepend=-1) > 0]
        found = np.full(len(points), -1, dtype=np.intp)
        found[point[first]] = self.at(mesh)[face[first]]
        return found

    def transformed(self, matrix: ArrayLike) -> FaceLooks:
        """The looks on the mesh under a 4x4 matrix acting on columns."""
        return replace(self, mesh=self.mesh.transformed(matrix))


def _middles(mesh: Mesh) -> Floats:
    """(f,3) a point inside of every face: the middle of the largest triangle of its fan."""
    if not mesh.face_count:
        return np.zeros((0, 3))
    fans, face = ragged.fans(mesh.offsets)
    corners = mesh.vertices[mesh.corners[fans]]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Triangles of a fan that are turned round lie outside of a face that is not convex.
    area = dot(normal, mesh.area_vectors[face])
    order = np.lexsort((-area, face))
    first = order[np.diff(face[order], prepend=-1) > 0]
    return np.asarray(corners[first].mean(axis=1))
