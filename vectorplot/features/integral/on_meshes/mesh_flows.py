"""How lines on a mesh go on where they meet an edge or a vertex: along a field of directions, or straight on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.bent_faces import BentFaces
from vectorplot.features.integral.face_sites import FaceSites
from vectorplot.features.integral.on_meshes.mesh_sides import NO_SIDE, MeshSides, outwards
from vectorplot.features.integral.sites import unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.repair.adjacency import face_barycentres
from vectorplot.geometry.vectors import cross, dot
from vectorplot.tolerances.of_angles import UNIT_LENGTH


class Onward(NamedTuple):
    """How lines (k,) go on: in faces (k,), -1 where they end, along unit directions (k,3); first, second (k,): the
    sides of their faces on which they already are, NO_SIDE where there is none; follows (k,): whether the way is along
    the first of them."""

    face: Ints
    directions: Floats
    first: Ints
    second: Ints
    follows: Bools

    def rows(self, which: Bools) -> Onward:
        """How some of the lines go on."""
        face, directions, first, second, follows = self
        return Onward(face[which], directions[which], first[which], second[which], follows[which])


class MeshFlow(Protocol):
    """What leads lines over a mesh."""

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """From within faces over sides (k,), with directions (k,3); way (k,): what each line was begun with, for most
        flows -1 against the flow, else 1."""
        ...

    def over_vertex(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """From within the faces of sides (k,), to where these begin."""
        ...


@dataclass(frozen=True, eq=False)
class FaceFieldFlow:
    """Along the directions (j,f,3) of faces; directed: they differ from their opposites.

    Errors: InputError for directions that are not at least one for each face, and for such that are neither unit
    vectors in its plane nor NaN.
    """

    sides: MeshSides
    candidates: Floats
    directed: bool

    def __post_init__(self) -> None:
        given = np.asarray(self.candidates)
        count = self.sides.mesh.face_count
        if given.ndim != 3 or given.shape[1:] != (count, 3) or not len(given) or given.dtype.kind not in "fiu":
            raise InputError(f"field: directions are {given.dtype} {given.shape}, expected real (j, {count}, 3)")
        given = given.astype(np.float64)
        size, height = np.sqrt(dot(given, given)), np.abs(dot(given, self.sides.mesh.face_normals))
        none = np.isnan(given).all(axis=2)
        for wrong, told in (
            (~none & ~np.isfinite(given).all(axis=2), "finite, or NaN where there is none"),
            (np.abs(size - 1.0) > UNIT_LENGTH, "of length one, or NaN where there is none"),
            (height > UNIT_LENGTH, "in its plane"),
        ):
            if wrong.any():
                face = int(self.sides.source[np.flatnonzero(wrong.any(axis=0))[0]])
                raise InputError(f"field: the direction of face {face} is not {told}")
        object.__setattr__(self, "candidates", given)

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the other face, where its direction leads away from the edge; else along the edge, as both push.

        Source: Filippov, Differential equations with discontinuous righthand sides, 1988, section 4.
        """
        sides, other = self.sides, self.sides.across[side]
        inside = other != NO_SIDE
        face = sides.mesh.corner_face[other]
        here = self._nearest(face, unfolded(sides, side, other, directions), way)
        first, follows = np.array(other), np.zeros(len(side), dtype=np.bool_)
        # Mostly the other face leads on.
        pushed = np.flatnonzero(~(inside & (outwards(sides, other, here) < 0.0)))
        if len(pushed):
            edge = side[pushed]
            slide = _slide(sides, edge, other[pushed], directions[pushed], here[pushed])
            slides = inside[pushed] & (np.abs(slide) > sides.slack[edge])
            face[pushed] = np.where(slides, sides.mesh.corner_face[edge], -1)
            on, edge = pushed[slides], edge[slides]
            here[on], first[on], follows[on] = np.sign(slide[slides])[:, None] * sides.along[edge], edge, True
        return Onward(face, here, first, np.full(len(side), NO_SIDE), follows)

    def over_vertex(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the face, or along the edge, that leads away from the vertex and is nearest to the way it came."""
        sides = self.sides
        listed, offsets = ragged.take(sides.vertex_offsets, sides.mesh.corners[side])
        around = sides.at_vertex[listed]
        line = ragged.owner(np.diff(offsets))
        previous, other = sides.before[around], sides.across[around]
        face = sides.mesh.corner_face
        ways = []
        for own in self._of_faces(face[around], way[line]):
            beyond = self._nearest(face[other], unfolded(sides, around, other, own), way[line])
            into = (outwards(sides, around, own) < 0.0) & (outwards(sides, previous, own) < 0.0)
            ways.append((into, own, around, previous, False))
            out = np.where(other != NO_SIDE, outwards(sides, other, beyond), 0.0)
            pushed = np.where(other != NO_SIDE, outwards(sides, around, own) >= 0.0, outwards(sides, around, own) == 0)
            slide = _slide(sides, around, other, own, beyond)
            ways.append(
                (pushed & (out >= 0.0) & (slide > sides.slack[around]), sides.along[around], around, previous, True)
            )
            border = (sides.across[previous] == NO_SIDE) & (outwards(sides, previous, own) == 0.0)
            back = -sides.along[previous]
            ways.append((border & (dot(own, back) > sides.slack[previous]), back, previous, around, True))
        ok, direction, first, second = (np.concatenate([w[i] for w in ways]) for i in range(4))
        follows = np.repeat([w[4] for w in ways], len(around))
        owner = np.tile(line, len(ways))
        near = np.where(ok, dot(direction, directions[owner]), -np.inf)
        if not self.directed:
            # What has no sense does not turn back.
            ok &= near > 0.0
        order = np.lexsort((-near, owner))
        best = order[ragged.starts(np.bincount(owner, minlength=len(side)))]
        return Onward(
            np.where(ok[best], face[first[best]], -1), direction[best], first[best], second[best], follows[best]
        )

    def _nearest(self, face: Ints, wanted: Floats, way: Floats) -> Floats:
        """(k,3) of the directions that lines may take in faces (k,) those nearest to wanted ones (k,3)."""
        choice = self._of_faces(face, way)
        if self.directed:
            return np.array(choice[0])
        near = dot(choice, wanted[None])
        near[np.isnan(near)] = -np.inf
        return np.asarray(choice[near.argmax(axis=0), np.arange(len(face))])

    def first(self, face: Ints, way: Floats) -> Floats:
        """(k,3) the directions in which lines begin."""
        found = self.candidates[0, face]
        return np.asarray(found * way[:, None])

    def _of_faces(self, face: Ints, way: Floats) -> Floats:
        """(j,k,3) the directions that lines may take in faces (k,)."""
        if self.directed:
            return np.asarray(self.candidates[:1, face] * way[:, None])
        found = self.candidates.take(face, axis=1)
        return np.concatenate([found, -found])


def face_field_flow(sides: MeshSides, given: BentFaces, field: TangentField) -> FaceFieldFlow:
    """The flow of a field with one direction a face, that at its barycentre.

    Errors: InputError for fields that need parameters, and as of FaceFieldFlow.
    """
    # Parts of a face that is not plane have planes of their own.
    centres = face_barycentres(given.mesh)[sides.source]
    places = FaceSites(centres, unit(sides.mesh.face_normals), given, sides.source)
    return FaceFieldFlow(sides, field.tangents(places), field.directed)


@dataclass(frozen=True, eq=False)
class StraightFlow:
    """Straight on: faces are unfolded, and at a vertex there is as much angle to the left as to the right.

    Source: Polthier and Schmies, Straightest geodesics on polyhedral surfaces, 1998, section 3.
    """

    sides: MeshSides

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the other face, unfolded into the plane of this one."""
        other = self.sides.across[side]
        straight = unfolded(self.sides, side, other, directions)
        face = np.where(other != NO_SIDE, self.sides.mesh.corner_face[other], -1)
        return Onward(face, straight, other, np.full(len(side), NO_SIDE), np.zeros(len(side), dtype=np.bool_))

    def over_vertex(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Across the vertex, with half of its angle on each side; none at the border."""
        sides = self.sides
        total, inner = self._angles_around(side)
        # Round the vertex counter-clockwise, from the first side of the face that is left.
        wedge = corner_angles(sides, side)
        left = wedge - np.minimum(_between(-directions, -sides.along[sides.before[side]]), wedge) + 0.5 * total
        face, first, second = (np.full(len(side), NO_SIDE) for _ in range(3))
        result = np.array(directions)
        going = np.flatnonzero(inner)
        corner = side[going]
        while len(going):
            wedge = corner_angles(sides, corner)
            here = left[going] <= wedge
            found, at = going[here], corner[here]
            turn = left[found][:, None]
            result[found] = np.cos(turn) * sides.along[at] + np.sin(turn) * sides.inwards[at]
            face[found], first[found], second[found] = sides.mesh.corner_face[at], at, sides.before[at]
            left[going] -= wedge
            going, corner = going[~here], sides.across[sides.before[corner[~here]]]
        return Onward(face, unit(result), first, second, np.zeros(len(side), dtype=np.bool_))

    def _angles_around(self, side: Ints) -> tuple[Floats, Bools]:
        """(k,) the sums of the angles of all faces around where sides begin, and whether they go all the way round."""
        sides = self.sides
        total, inner = np.zeros(len(side)), np.ones(len(side), dtype=np.bool_)
        going, corner = np.arange(len(side)), side
        while len(going):
            total[going] += corner_angles(sides, corner)
            corner = sides.across[sides.before[corner]]
            inner[going[corner == NO_SIDE]] = False
            more = (corner != NO_SIDE) & (corner != side[going])
            going, corner = going[more], corner[more]
        return total, inner


def unfolded(sides: MeshSides, side: Ints, other: Ints, directions: Floats) -> Floats:
    """(k,3) directions of faces turned about sides (k,) into the planes of the faces beyond, where they are others."""
    ahead, inwards = sides.along.take(side, axis=0), sides.inwards.take(side, axis=0)
    along, beyond = dot(ahead, directions), -dot(inwards, directions)
    return unit(along[:, None] * ahead + beyond[:, None] * sides.inwards.take(other, axis=0))


def _slide(sides: MeshSides, side: Ints, other: Ints, own: Floats, beyond: Floats) -> Floats:
    """(k,) how fast, and in which sense, points run along sides (k,) that both faces push them to; where there is no
    face beyond, or both push along it only, as the faces say."""
    inside = other != NO_SIDE
    a, b = dot(own, sides.along[side]), np.maximum(outwards(sides, side, own), 0.0)
    c = np.where(inside, dot(beyond, sides.along[side]), a)
    d = np.where(inside, np.maximum(outwards(sides, other, beyond), 0.0), 0.0)
    # What pushes across cancels out; of two that do not push both count alike.
    level = (b == 0.0) & (d == 0.0)
    b, d = np.where(level, 1.0, b), np.where(level, 1.0, d)
    return np.asarray(np.nan_to_num((d * a + b * c) / (b + d)))


def corner_angles(sides: MeshSides, corner: Ints) -> Floats:
    """(k,) the angles of faces at corners (k,)."""
    return _between(sides.along[corner], -sides.along[sides.before[corner]])


def _between(a: Floats, b: Floats) -> Floats:
    across = cross(a, b)
    return np.asarray(arctan2(np.sqrt(dot(across, across)), dot(a, b)))
