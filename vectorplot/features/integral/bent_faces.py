"""How the faces of a mesh bend, where it is smooth but for creases."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.feature_lines.mesh_bending import noisy_bending
from vectorplot.features.meshes.mesh_curves import face_triangles
from vectorplot.features.meshes.smooth_patches import apart_at_creases
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot

USUAL_CREASE_DEG = 25.0
"""Edges at which faces turn by more are creases, where nothing is said: as in drawings."""

TRUST_AT_RIMS = 1.0 / 1024.0
"""How much a normal at a border counts beside those of inner vertices: where there are some, nothing that is seen."""


@dataclass(frozen=True, eq=False)
class BentFaces:
    """A mesh, and how it bends beside the edges at which faces turn by more than an angle."""

    mesh: Mesh
    crease_angle_deg: float = USUAL_CREASE_DEG

    def __post_init__(self) -> None:
        if not 0.0 <= self.crease_angle_deg <= 180.0:
            raise InputError(f"a crease angle of {self.crease_angle_deg:g} degrees: expected 0 to 180")

    @cached_property
    def tensors(self) -> tuple[Floats, Floats]:
        """(f,3,3) the curvature tensors of faces, positive where they bend towards their normals, the means of those at
        their corners; and by how much (f,) curvatures may be wrong.

        Source: Rusinkiewicz (2004), section 3, for means of tensors: directions have no sense, and no means.
        """
        mesh = self.mesh
        if not len(mesh.corners):
            return np.zeros((mesh.face_count, 3, 3)), np.full(mesh.face_count, np.inf)
        smooth = apart_at_creases(mesh, self.crease_angle_deg)
        faces = face_triangles(smooth)
        trust = _trust(len(smooth.vertices), faces.triangles)
        bending, noise = noisy_bending(faces, trust)
        axes = np.stack([bending.along, bending.aside], axis=1)
        p, m, q = bending.second.T
        forms = np.stack([np.stack([p, m], axis=1), np.stack([m, q], axis=1)], axis=1)
        own = (matmul(matmul(np.swapaxes(axes, 1, 2), forms), axes)).reshape(-1, 9)
        corner, owner = smooth.corners, ragged.owner(np.diff(mesh.offsets))
        # Where some corners are not at rims, the others do not count.
        best = np.maximum.reduceat(trust[corner], mesh.offsets[:-1])
        used = np.flatnonzero(trust[corner] == best[owner])
        corner, owner = corner[used], owner[used]
        count = np.bincount(owner, minlength=mesh.face_count)
        means = [np.bincount(owner, each[corner], mesh.face_count) / count for each in (*own.T, noise)]
        return np.stack(means[:-1], axis=1).reshape(-1, 3, 3), means[-1]

    def forms(self, faces: Ints, along: Floats, aside: Floats) -> tuple[Floats, Floats]:
        """(k,3) the second fundamental forms p, m, q of faces (k,), by unit vectors (k,3) in their planes; and by how
        much (k,) curvatures may be wrong."""
        tensors, wrong = self.tensors
        turned = np.einsum("kij,kj->ki", tensors[faces], along)
        p, m = dot(turned, along), dot(turned, aside)
        q = dot(np.einsum("kij,kj->ki", tensors[faces], aside), aside)
        return np.stack([p, m, q], axis=1), wrong[faces]


def _trust(count: int, triangles: Ints) -> Floats:
    """(n,) how much the normals at vertices count: those at borders and creases, which have faces on one side only, are
    off by the edges themselves, those of inner vertices by their square."""
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    key, uses = np.unique(sides[:, 0] * count + sides[:, 1], return_counts=True)
    rim = np.concatenate(np.divmod(key[uses == 1], count))
    trust = np.ones(count)
    trust[rim] = TRUST_AT_RIMS
    return trust
