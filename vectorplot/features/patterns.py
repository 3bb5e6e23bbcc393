"""Outlines of patterns in space."""

from __future__ import annotations

import numpy as np

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats, Mesh


def face_frame(mesh: Mesh, face: int) -> tuple[Floats, Floats, Floats]:
    """A face's own coordinates in space: origin at its barycentre, unit vectors along its first edge and to the left
    of it.

    Errors: InputError for a face that is not there, or has no area.
    Source: Glaeser, section 6.5; the frame is ours, see docs/scene-language.md.
    """
    if not 0 <= face < mesh.face_count:
        raise InputError(f"pattern on face {face + 1}: there are {mesh.face_count} faces")
    corners = mesh.vertices[mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]]]
    normal = mesh.face_normals[face]
    along = corners[1] - corners[0]
    along = along - normal * (normal @ along)
    length = np.linalg.norm(along)
    if not length > 0.0 or not normal.any():
        raise InputError(f"pattern on face {face + 1}: the face has no area")
    along = along / length
    return corners.mean(axis=0), along, np.cross(normal, along)


def pattern_outline(mesh: Mesh, face: int, points: Floats) -> Floats:
    """(k,3) the points (k,2) given in a face's own coordinates, in space."""
    origin, along, left = face_frame(mesh, face)
    return np.asarray(origin + points[:, :1] * along + points[:, 1:] * left, dtype=np.float64)
