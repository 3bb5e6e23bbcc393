"""The faces of a mesh as places with tangent planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.integral.bent_faces import USUAL_CREASE_DEG, BentFaces
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
    bent : BentFaces, optional
        How the mesh bends: fields that go by curvatures need it.
    faces : (f,) array of int, optional
        In which of its faces each place is.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> walls = features.face_sites(geometry.box((2, 2, 2)))
    >>> features.ConstantElevation(0.5).tangents(walls)[0, :4, 2].round(6).tolist()
    [0.479426, 0.479426, 0.479426, 0.479426]
    """

    centres: Floats
    facing: Floats
    bent: BentFaces | None = None
    faces: Ints | None = None

    @property
    def points(self) -> Floats:
        """(f,3) in world coordinates."""
        return self.centres

    @property
    def normals(self) -> Floats:
        """(f,3) unit outer normals."""
        return self.facing


def face_sites(mesh: Mesh, crease_angle_deg: float = USUAL_CREASE_DEG) -> FaceSites:
    """The barycentres of the faces of a mesh, with their planes, and how the mesh bends.

    Parameters
    ----------
    mesh : Mesh
        With f faces.
    crease_angle_deg : float
        At edges where faces turn by more, 0 to 180 degrees, the mesh is not smooth.

    Returns
    -------
    FaceSites
        f of them.

    Raises
    ------
    InputError
        For an angle that is not within 0 and 180.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> features.face_sites(geometry.box((2, 2, 2))).normals[4:].tolist()
    [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
    """
    bent = BentFaces(mesh, crease_angle_deg)
    return FaceSites(face_barycentres(mesh), unit(mesh.face_normals), bent, np.arange(mesh.face_count))
