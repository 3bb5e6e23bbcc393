"""Integral curves of one field that cover a mesh evenly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.curves.parameters import positive
from vectorplot.features.integral.bent_faces import USUAL_CREASE_DEG, BentFaces
from vectorplot.features.integral.on_meshes.combed_mesh import CombedMesh
from vectorplot.features.integral.on_meshes.mesh_combing import combed
from vectorplot.features.integral.on_meshes.mesh_flows import face_field_flow
from vectorplot.features.integral.on_meshes.mesh_sides import mesh_sides
from vectorplot.features.integral.tangent_fields import TangentField, TurnedField
from vectorplot.features.meshes.mesh_curves import MeshCurves, all_mesh_curves
from vectorplot.geometry.mesh import Mesh


def evenly_spaced_mesh_curves(
    mesh: Mesh, field: TangentField, apart: float, *, crease_angle_deg: float = USUAL_CREASE_DEG
) -> MeshCurves:
    """Integral curves of a field that cover a mesh evenly.

    Parameters
    ----------
    mesh : Mesh
        On which they run; open or closed.
    field : TangentField
        What they follow, as of `mesh_integral_curves`.
    apart : float
        About how far neighbours are from each other, in world units, as of `evenly_spaced_curves`.
    crease_angle_deg : float
        As of `mesh_integral_curves`.

    Returns
    -------
    MeshCurves
        Polylines from edge to edge. A curve ends where it comes too near to another one, or to itself.

    Raises
    ------
    InputError
        For a distance that is not positive, or less than a five-hundredth of the extent of the mesh; for fields that
        need parameters, or give what are no directions in faces; an angle that is not within 0 and 180.

    Notes
    -----
    As `evenly_spaced_curves`. Those that run together in one edge (water in a valley) are one from there on.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.evenly_spaced_mesh_curves(geometry.box((2, 2, 2)), features.SteepestSlope(), 0.25)
    >>> len(curves) > 20
    True
    """
    return evenly_spaced_on_faces(BentFaces(mesh, crease_angle_deg), field, apart)


def evenly_spaced_on_faces(bent: BentFaces, field: TangentField, apart: float) -> MeshCurves:
    """The same on a mesh of which is known how it bends."""
    positive("evenly spaced curves: distance", apart)
    sides, none = mesh_sides(bent.mesh), all_mesh_curves([])
    if not bent.mesh.face_count or sides.extent == 0.0:
        return none
    flow = face_field_flow(sides, bent, field)
    across = face_field_flow(sides, bent, TurnedField(field, 0.5 * np.pi))
    result = combed(CombedMesh(bent, field, apart, sides, flow, across))
    return replace(result, levels=np.zeros(len(result)))
