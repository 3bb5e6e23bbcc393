"""The faces of a mesh as places with tangent planes."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.arrays import Floats
from vectorplot.features.integral.sites import TangentPlanes, unit
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.adjacency import face_barycentres


@dataclass(frozen=True, eq=False)
class FaceSites(TangentPlanes):
    """Places in faces, one in each, with the planes of the faces: where fields are asked for directions of faces.

    Parameters
    ----------
    centres : (f, 3) array of float
        In world coordinates.
    facing : (f, 3) array of float
        Unit normals; NaN of faces without area.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> walls = features.face_sites(geometry.box((2, 2, 2)))
    >>> features.ConstantElevation(0.5).tangents(walls)[0, :4, 2].round(6).tolist()
    [0.479426, 0.479426, 0.479426, 0.479426]
    """

    centres: Floats
    facing: Floats

    @property
    def points(self) -> Floats:
        """(f,3) in world coordinates."""
        return self.centres

    @property
    def normals(self) -> Floats:
        """(f,3) unit outer normals."""
        return self.facing


def face_sites(mesh: Mesh) -> FaceSites:
    """The barycentres of the faces of a mesh, with their planes.

    Parameters
    ----------
    mesh : Mesh
        With f faces.

    Returns
    -------
    FaceSites
        f of them.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> features.face_sites(geometry.box((2, 2, 2))).normals[4:].tolist()
    [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
    """
    return FaceSites(face_barycentres(mesh), unit(mesh.face_normals))
