"""The normals of the smooth surface that a mesh was made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.algebra import determinant, inverse_matrix, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.triangles.triangle_places import PlacedTriangles
from vectorplot.geometry.vectors import norm


@dataclass(frozen=True, eq=False)
class SurfaceNormals:
    """What a smooth surface tells of its normals, at the vertices of a mesh close to it.

    Parameters
    ----------
    mesh : Mesh
        As it was made of the surface; what is painted may be divided and cut since.
    at_vertices : (v, 3) array of float
        Unit normals; zero where the surface has none.
    on_edge : (v,) array of bool
        Those on sharp edges, with the normal of one side of them.

    Notes
    -----
    Source: Glaeser, section 8.4 (polygonised surfaces and their normals).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import SurfaceNormals
    >>> triangle = vp.Mesh.from_triangles([(1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2)])
    >>> of_ball = SurfaceNormals(triangle, triangle.vertices, np.zeros(3, dtype=bool))
    >>> of_ball.transformed(np.diag([2.0, 1.0, 1.0, 1.0])).at_vertices[0].tolist()
    [1.0, 0.0, 0.0]
    """

    mesh: Mesh
    at_vertices: Floats
    on_edge: Bools

    def transformed(self, matrix: ArrayLike) -> SurfaceNormals:
        """The normals of the surface under a 4x4 matrix acting on columns."""
        linear = np.asarray(matrix, dtype=np.float64)[:3, :3]
        # The adjugate turns normals as the inverse does, and mirrors them as faces are.
        turned = matmul(self.at_vertices, inverse_matrix(linear) * abs(determinant(linear)))
        length = norm(turned)[:, None]
        return SurfaceNormals(self.mesh.transformed(matrix), turned / np.where(length > 0.0, length, 1.0), self.on_edge)

    @cached_property
    def triangles(self) -> PlacedTriangles:
        """The triangles of the mesh: what was divided and cut since is looked up in them, item after item."""
        return PlacedTriangles(self.mesh)
