"""Directions all over a mesh: those of its curvatures where it bends, and what goes on smoothly from there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import NO_SIDE, MeshSides, mesh_sides
from vectorplot.features.surface_points import BentFaces, FaceSites, TangentPlanes, unit
from vectorplot.features.tangent_fields import principal
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.geometry.winding import face_barycentres
from vectorplot.tolerances import FLAT_SLOPE

ROUNDS = 128
"""So often each direction becomes the mean of its own and its neighbours'."""

CURVED = 0.5
"""How much the direction of a face's own curvature counts against that of one neighbour, where one of the two
curvatures is zero; less where they are alike."""

SYMMETRIES = 4
"""A cross looks the same after so many turns."""


@dataclass(frozen=True, eq=False)
class CombedCurvature:
    """Principal directions of a mesh, combed: a direction in every face, and as few turns as there can be.

    Crosses in the planes of faces, which have no sense and no first arm, are means of their neighbours' and of those of
    the principal directions, as much as the two curvatures differ; where no curvature tells any, what is level does.
    Then one arm in each is of the family that the neighbours have, too. They are not smoothed over creases.

    bent: the mesh; family: 1 for the arms that follow the larger curvature, or 2.
    Source: Hertzmann and Zorin, Illustrating smooth surfaces, 2000, section 5; Knoeppel et al., Globally optimal
    direction fields, 2013, for crosses as fourth powers of complex numbers.
    """

    bent: BentFaces
    family: int
    directed: ClassVar[bool] = False

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(2,k,3) unit tangent vectors, those of the family first. Errors: InputError for other places than faces."""
        if not isinstance(sites, FaceSites) or sites.faces is None:
            raise InputError("combed directions: expected places in faces of their mesh")
        most = self._most[sites.faces]
        most = unit(most - dot(most, sites.normals)[:, None] * sites.normals)
        both = np.stack([most, cross(sites.normals, most)])
        return both if self.family == 1 else both[::-1]

    @cached_property
    def _most(self) -> Floats:
        """(f,3) the arm in every face of the mesh that is of the first family."""
        sides, mesh = mesh_sides(self.bent.mesh), self.bent.mesh
        found = np.full((mesh.face_count, 3), np.nan)
        # Of a face in several parts, the first one tells.
        source, part = np.unique(sides.source, return_index=True)
        found[source] = _combed(self.bent, sides)[part]
        return found


def _combed(bent: BentFaces, sides: MeshSides) -> Floats:
    """(f,3) the arms of the first family in the parts of faces."""
    may_stop()
    mesh = sides.mesh
    normals = np.nan_to_num(unit(mesh.face_normals))
    first = unit(np.nan_to_num(sides.along[mesh.offsets[:-1]]))
    frame = np.stack([first, cross(normals, first)])
    places = FaceSites(face_barycentres(bent.mesh)[sides.source], normals, bent, sides.source)
    (most, _), (larger, smaller) = principal(places, "combed directions")
    may_stop()
    known = np.asarray(np.isfinite(most).all(axis=1), dtype=np.bool_)
    most = np.where(known[:, None], most, _level(normals))
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = np.nan_to_num(CURVED * (larger - smaller) / (np.abs(larger) + np.abs(smaller)))
    weight = np.where(known, np.clip(weight, 0.0, CURVED), 0.0)
    own = _angles(most, frame)
    one, other, turn = _links(bent, sides, frame)
    spread = _Links(one, other, len(own))
    four = SYMMETRIES * turn
    angle = (
        _smoothed(spread, np.stack([np.cos(SYMMETRIES * own), np.sin(SYMMETRIES * own)]), weight, _turned_by(four))
        / SYMMETRIES
    )
    # Which arm: as lines that may be turned by a right angle, 1 or -1 times the same line.
    line = np.cos(2.0 * (own - angle))
    same = np.sign(np.cos(2.0 * (angle[one] - angle[other] - turn)))
    arm = _voted(spread, line * weight, same)
    angle = np.where(arm < 0.0, angle + 0.5 * np.pi, angle)
    return np.asarray(np.cos(angle)[:, None] * frame[0] + np.sin(angle)[:, None] * frame[1])


def _level(normals: Floats) -> Floats:
    """(f,3) what is level in planes; in level ones the x axis."""
    level = cross(np.array([0.0, 0.0, 1.0]), normals)
    level[np.flatnonzero(norm(level) <= FLAT_SLOPE)] = (1.0, 0.0, 0.0)
    return unit(level)


def _angles(vectors: Floats, frame: Floats) -> Floats:
    """(n,) the angles of vectors (n,3) in frames (2,n,3)."""
    return arctan2(dot(vectors, frame[1]), dot(vectors, frame[0]))


def _links(bent: BentFaces, sides: MeshSides, frame: Floats) -> tuple[Ints, Ints, Floats]:
    """Pairs of faces with a common side that is no crease, both ways, and by how much angles are larger in the frame of
    the first than in that of the other."""
    side = np.flatnonzero(sides.across != NO_SIDE)
    face = sides.mesh.corner_face
    one, other = face[side], face[sides.across[side]]
    normals = np.nan_to_num(unit(sides.mesh.face_normals))
    smooth = dot(normals[one], normals[other]) >= np.cos(np.radians(bent.crease_angle_deg))
    one, other, along = one[smooth], other[smooth], sides.along[side[smooth]]
    return one, other, _angles(along, frame[:, one]) - _angles(along, frame[:, other])


@dataclass(frozen=True, eq=False)
class _Links:
    """Pairs of neighbours among so many faces: what each has of the other."""

    one: Ints
    other: Ints
    count: int

    def sums(self, values: Floats) -> Floats:
        """(count,) sums of values (n,) over the neighbours of each."""
        return np.asarray(np.bincount(self.one, values, self.count), dtype=np.float64)


def _turned_by(angle: Floats) -> Callable[[Floats], Floats]:
    """What turns vectors (2,n) by angles (n,)."""
    c, s = np.cos(angle), np.sin(angle)
    return lambda vectors: np.stack([c * vectors[0] - s * vectors[1], s * vectors[0] + c * vectors[1]])


def _smoothed(links: _Links, own: Floats, weight: Floats, turned: Callable[[Floats], Floats]) -> Floats:
    """(n,) the angles of unit vectors that are means of what is known, own (2,n) by weight (n,), and of neighbours'."""
    now = np.where(weight > 0.0, own, 0.0)
    while True:
        may_stop()
        # From where something is known to where nothing is yet.
        near = _means(links, now, turned)
        empty = (now == 0.0).all(axis=0) & (near != 0.0).any(axis=0)
        if not empty.any():
            break
        now = np.where(empty, _unit(near), now)
    now = np.where((now == 0.0).all(axis=0), own, now)
    for _ in in_turn(range(ROUNDS)):
        now = _unit(weight * own + now + _means(links, now, turned))
    return arctan2(now[1], now[0])


def _means(links: _Links, now: Floats, turned: Callable[[Floats], Floats]) -> Floats:
    """(2,n) the sums of neighbours' vectors, each in the frame of the one whose neighbour it is."""
    return np.stack([links.sums(row) for row in turned(now[:, links.other])])


def _unit(vectors: Floats) -> Floats:
    """(2,n) vectors of length one; zeros stay zeros."""
    length = np.sqrt(vectors[0] * vectors[0] + vectors[1] * vectors[1])
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def _voted(links: _Links, own: Floats, same: Floats) -> Floats:
    """(n,) which of two arms, 1 or -1, counts in each face: own (n,) is what it says itself; same (m,): whether
    neighbours that have the same have the same number, 1 or -1."""
    now = np.sign(own)
    while True:
        may_stop()
        near = np.sign(links.sums(same * now[links.other]))
        empty = (now == 0.0) & (near != 0.0)
        if not empty.any():
            break
        now = np.where(empty, near, now)
    for _ in in_turn(range(ROUNDS)):
        now = np.clip(own + 0.5 * now + links.sums(same * now[links.other]), -1.0, 1.0)
    return np.asarray(np.where(now < 0.0, -1.0, 1.0))
