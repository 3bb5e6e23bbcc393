"""Outlines of patterns in space."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh


def face_frames(mesh: Mesh, faces: Ints) -> tuple[Floats, Floats, Floats]:
    """The own coordinates of faces (n,) in space, (n,3) each: origin at the barycentre of the corners, unit vectors
    along the first edge and to the left of it.

    Errors: InputError for a face that is not there, or has no area.
    Source: Glaeser, section 6.5; the frame is ours, see docs/scene-language.md.
    """
    missing = (faces < 0) | (faces >= mesh.face_count)
    if missing.any():
        raise InputError(f"pattern on face {int(faces[missing][0]) + 1}: there are {mesh.face_count} faces")
    if not len(faces):
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3))
    sizes = mesh.face_sizes[faces]
    starts = ragged.starts(sizes)
    position = ragged.ranges(mesh.offsets[faces], sizes)
    first = mesh.vertices[mesh.corners[mesh.offsets[faces]]]
    arms = mesh.vertices[mesh.corners[position]] - np.repeat(first, sizes, axis=0)
    origin = first + np.add.reduceat(arms, starts, axis=0) / sizes[:, None]
    normal = mesh.face_normals[faces]
    along = arms[starts + 1]
    along = along - normal * (normal * along).sum(axis=1, keepdims=True)
    length = np.sqrt((along * along).sum(axis=1))
    flat = ~(length > 0.0) | ~normal.any(axis=1)
    if flat.any():
        raise InputError(f"pattern on face {int(faces[flat][0]) + 1}: the face has no area")
    along = along / length[:, None]
    return origin, along, np.cross(normal, along)


def pattern_outline(mesh: Mesh, face: int, points: Floats) -> Floats:
    """(k,3) the points (k,2) given in a face's own coordinates, in space. Errors: as of face_frames."""
    origin, along, left = face_frames(mesh, np.array([face]))
    return np.asarray(origin + points[:, :1] * along + points[:, 1:] * left, dtype=np.float64)
