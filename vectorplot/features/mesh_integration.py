"""Integral curves of fields of directions on the faces of a mesh, and straightest geodesics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import NO_FACE, MeshCurves, all_mesh_curves, without_inner
from vectorplot.features.surface_integration import DEFAULT_LENGTH
from vectorplot.features.surface_points import USUAL_CREASE_DEG, BentFaces, FaceSites, unit
from vectorplot.features.tangent_fields import TangentField
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import with_points_kept
from vectorplot.geometry.vectors import all_finite, cross, dot, norm, point_on_line
from vectorplot.geometry.winding import edge_uses, face_barycentres
from vectorplot.tolerances import (
    CLOSED_OF_EXTENT,
    LEAST_DIVISOR,
    NO_NORMAL,
    ROUNDING_OF_POINTS,
    UNIT_LENGTH,
    ZERO_OF_EXTENT,
)

# The convex faces that lines run across, with all that their sides are asked for.

NO_SIDE = -1


@dataclass(frozen=True, eq=False)
class MeshSides:
    """Plane convex faces and their sides: side c runs from corner c of its face to the next. source (f,): the given
    face; along, inwards (c,3): unit vectors along the side and into the face; lengths (c,); before, after (c,):
    neighbouring sides; across (c,): the same side in the other face, NO_SIDE at borders, where more than two faces
    meet or orientations differ; at_vertex (c,), vertex_offsets (v+1,): sides that begin at a vertex; slack (c,):
    error of cosines with a side; extent; rounding: error of points.
    """

    mesh: Mesh
    source: Ints
    along: Floats
    inwards: Floats
    lengths: Floats
    before: Ints
    after: Ints
    across: Ints
    at_vertex: Ints
    vertex_offsets: Ints
    slack: Floats
    extent: float
    rounding: float

    def starts(self, side: Ints) -> Floats:
        """(k,3) where sides begin."""
        return self._starts.take(side, axis=0)

    def ends(self, side: Ints) -> Floats:
        """(k,3) where sides end."""
        return self._starts.take(self.after[side], axis=0)

    @cached_property
    def _starts(self) -> Floats:
        """(c,3) where all sides begin."""
        return self.mesh.vertices[self.mesh.corners]


def mesh_sides(given: Mesh) -> MeshSides:
    """The sides of the faces of a mesh that are present."""
    low, high = given.bounds
    extent = float((high - low).max())
    faces = convex_faces(given.vertices.T, given.corners, given.offsets, ZERO_OF_EXTENT * extent)
    corners, offsets, source = faces.corners, faces.offsets, faces.source
    if given.present is not None:
        shown = np.flatnonzero(given.present[source])
        chosen, offsets = ragged.take(offsets, shown)
        corners, source = corners[chosen], source[shown]
    mesh = Mesh(given.vertices, corners, offsets)
    after = mesh.next_corner
    step = mesh.vertices[corners[after]] - mesh.vertices[corners]
    lengths = norm(step)
    along = step / np.maximum(lengths, LEAST_DIVISOR)[:, None]
    uses = edge_uses(mesh)
    pair = uses.first[uses.agree]
    across = np.full(len(corners), NO_SIDE, dtype=np.intp)
    across[uses.corner[pair]], across[uses.corner[pair + 1]] = uses.corner[pair + 1], uses.corner[pair]
    rounding = ROUNDING_OF_POINTS * max(float(np.abs(given.bounds).max()), extent)
    return MeshSides(
        mesh,
        source,
        along,
        cross(mesh.face_normals[mesh.corner_face], along),
        lengths,
        ragged.preceding(offsets),
        after,
        across,
        np.argsort(corners, kind="stable"),
        ragged.offsets(np.bincount(corners, minlength=len(mesh.vertices))),
        rounding / np.maximum(lengths, rounding + LEAST_DIVISOR),
        extent,
        rounding,
    )


def outwards(sides: MeshSides, side: Ints, directions: Floats) -> Floats:
    """(k,) how fast points with directions (k,3) in the faces of sides (k,) come nearer to these; zero along them."""
    speed = -dot(sides.inwards.take(side, axis=0), directions)
    return np.where(np.abs(speed) <= sides.slack[side], 0.0, speed)


# How lines on a mesh go on where they meet an edge or a vertex: along a field of directions, or straight on.


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

    Errors: InputError for fields that need parameters, and as in FaceFieldFlow.
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


# Lines led across the faces of a mesh, all of them face by face at once.

MOST_FACES = 100_000
"""A line runs across so many faces at most."""

FAR = 4.0
"""Times the distance at which lines are beside where they have been, that they run before that is looked for, and
beyond."""


class MeshTraces(NamedTuple):
    """The segments of lines on a mesh in their order: line (s,), the point (s,3) where each begins and where it ends,
    and its face (s,); last (k,3): where the lines end; closed (k,): which came back, their first segment is from the
    start to where they do."""

    line: Ints
    begin: Floats
    end: Floats
    face: Ints
    last: Floats
    closed: Bools


class _Exits(NamedTuple):
    """Where lines (k,) leave their faces: distance (k,), inf where they do not; points (k,3); over sides (k,), or,
    where at_vertex (k,), where these begin."""

    distance: Floats
    points: Floats
    side: Ints
    at_vertex: Bools


def mesh_traces(
    sides: MeshSides,
    flow: MeshFlow,
    face: Ints,
    points: Floats,
    directions: Floats,
    way: Floats,
    length: Floats | float,
    beside: float = 0.0,
) -> MeshTraces:
    """Lines from points (k,3) in faces (k,) along directions (k,3), with a flow or (way: -1) against it, up to length
    (or (k,)). beside: lines that return so near to their track do not run on for many rounds; 0 for all to do. A
    line ends where the flow does, at its length, or closed where it returns to the exit of its first face, into the
    same face in the same direction.
    """
    count = len(face)
    nowhere = np.full(count, NO_SIDE)
    now = Onward(face, directions, nowhere, nowhere, np.zeros(count, dtype=np.bool_))
    line, here, left = np.arange(count), points, np.array(np.broadcast_to(length, count), dtype=np.float64)
    longest_side = float(sides.lengths.max(initial=0.0))
    rounds = _Rounds(sides, beside, np.array(points), np.array(face), np.zeros(count), np.zeros(count))
    closed, last = np.zeros(count, dtype=np.bool_), np.array(points)
    first_point, first_way = np.full((count, 3), np.nan), np.zeros((count, 3))
    first_face = np.full(count, -1)
    segments: list[tuple[Ints, Floats, Floats, Ints]] = []
    for step in in_turn(range(MOST_FACES)):
        alive = all_finite(now.directions) & (now.face >= 0)
        if not alive.all():
            line, here, now = line[alive], here[alive], now.rows(alive)
        if not len(line):
            break
        exits = _exits(sides, here, now)
        # What has nowhere to leave its face goes nowhere.
        runs = np.isfinite(exits.distance)
        whole = exits.distance <= left[line]
        short = here + np.minimum(left[line], exits.distance)[:, None] * now.directions
        end = np.where(whole[:, None], exits.points, short)
        segments.append((line[runs], here[runs], end[runs], now.face[runs]))
        last[line[runs]] = end[runs]
        left[line] -= exits.distance
        about = rounds.done(line, here, end, now.face)
        # Far enough to close, at the side where the first face was left.
        left[line[about]] = np.minimum(left[line[about]], FAR * beside + longest_side)
        go = (runs & whole).nonzero()[0]
        line, here, old = line[go], end.take(go, axis=0), now.directions.take(go, axis=0)
        now = _onward(flow, exits.side[go], exits.at_vertex[go], old, way[line])
        if step == 0:
            first_point[line], first_way[line], first_face[line] = here, now.directions, now.face
            continue
        back = np.flatnonzero((now.face == first_face[line]) & (now.face >= 0))
        if len(back):
            own = line[back]
            home = norm(here[back] - first_point[own]) <= CLOSED_OF_EXTENT * sides.extent
            home &= norm(now.directions[back] - first_way[own]) <= CLOSED_OF_EXTENT
            closed[own[home]] = True
            face = now.face.copy()
            face[back[home]] = -1
            now = now._replace(face=face)
    parts = [np.concatenate([s[i] for s in segments]) if segments else np.zeros(0) for i in range(4)]
    order = np.argsort(parts[0], kind="stable")
    rows, begin, end, faces = (part[order] for part in parts)
    return MeshTraces(
        rows.astype(np.intp), begin.reshape(-1, 3), end.reshape(-1, 3), faces.astype(np.intp), last, closed
    )


@dataclass(frozen=True, eq=False)
class _Rounds:
    """Whether lines (k,) come back beside where they have been: a place on each (k,3), in a face (k,), and at what part
    of its way (k,), of which run (k,) is done. The place is their start, and moves on whenever they have run twice as
    far as to it: what runs into rounds is found in the third of them.

    Source: Brent, An improved Monte Carlo factorization algorithm, 1980, for a place that moves on.
    """

    sides: MeshSides
    beside: float
    place: Floats
    face: Ints
    at: Floats
    run: Floats

    def done(self, line: Ints, start: Floats, end: Floats, face: Ints) -> Bools:
        """(m,) which of the lines (m,) are back that run on from start to end (m,3) in faces (m,)."""
        if self.beside <= 0.0:
            return np.zeros(len(line), dtype=np.bool_)
        step, place = end - start, self.place[line]
        part = dot(place - start, step) / np.maximum(dot(step, step), LEAST_DIVISOR)
        part = np.minimum(np.maximum(part, 0.0), 1.0)
        near = norm(start + part[:, None] * step - place) <= self.beside
        near &= self.run[line] - self.at[line] > FAR * self.beside
        back, normals = np.flatnonzero(near), self.sides.mesh.face_normals
        near[back] = dot(normals[face[back]], normals[self.face[line[back]]]) > 0.0
        self.run[line] += norm(step)
        onward = self.run[line] >= np.maximum(2.0 * self.at[line], self.sides.extent)
        moved = line[onward]
        self.place[moved], self.face[moved], self.at[moved] = end[onward], face[onward], self.run[moved]
        return np.asarray(near)


def _onward(flow: MeshFlow, side: Ints, at_vertex: Bools, directions: Floats, way: Floats) -> Onward:
    """How lines go on that leave over sides, or where these begin."""
    if not at_vertex.any():
        return flow.over_edge(side, directions, way)
    edge, vertex = np.flatnonzero(~at_vertex), np.flatnonzero(at_vertex)
    over = flow.over_edge(side[edge], directions[edge], way[edge])
    beyond = flow.over_vertex(side[vertex], directions[vertex], way[vertex])
    order = np.argsort(np.concatenate([edge, vertex]), kind="stable")
    return Onward(*(np.concatenate([a, b])[order] for a, b in zip(over, beyond, strict=True)))


def _exits(sides: MeshSides, here: Floats, now: Onward) -> _Exits:
    """Where lines leave their faces that run from points (k,3)."""
    all_sides, offsets = ragged.take(sides.mesh.offsets, now.face)
    line = ragged.owner(np.diff(offsets))
    # take moves rows several times as fast as an index between brackets does.
    inwards = sides.inwards.take(all_sides, axis=0)
    off = np.maximum(dot(inwards, here.take(line, axis=0) - sides.starts(all_sides)), 0.0)
    speed = -dot(inwards, now.directions.take(line, axis=0))
    ahead = (speed > 0.0) & (all_sides != now.first[line]) & (all_sides != now.second[line])
    distance = np.where(ahead, off / np.where(ahead, speed, 1.0), np.inf)
    chosen = np.lexsort((distance, line))[offsets[:-1]]
    side, distance = all_sides[chosen], distance[chosen]
    # Along a side it is left at one of its ends.
    follow = np.flatnonzero(now.follows)
    side[follow] = now.first[follow]
    a, b, long = sides.starts(side), sides.ends(side), sides.lengths[side]
    if len(follow):
        along = dot(sides.along[side[follow]], now.directions[follow]) > 0.0
        distance[follow] = norm(np.where(along[:, None], b[follow], a[follow]) - here[follow])
    reached = here + np.where(np.isfinite(distance), distance, 0.0)[:, None] * now.directions
    place = np.minimum(np.maximum(dot(reached - a, sides.along.take(side, axis=0)), 0.0), long)
    if len(follow):
        place[follow] = np.where(along, long[follow], 0.0)
    at_start, at_end = place <= sides.rounding, long - place <= sides.rounding
    points = point_on_line(a, b, place / np.where(long > 0.0, long, 1.0))
    points = np.where(at_start[:, None], a, np.where(at_end[:, None], b, points))
    # A vertex is where a side of this face begins.
    return _Exits(distance, points, np.where(at_end & ~at_start, sides.after[side], side), at_start | at_end)


# Integral curves of fields of directions on the faces of a mesh, and straightest geodesics.


def mesh_integral_curves(
    mesh: Mesh,
    field: TangentField,
    faces: ArrayLike,
    points: ArrayLike | None = None,
    *,
    length: float | None = None,
    both_ways: bool = True,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> MeshCurves:
    """The lines across the faces of a mesh that follow a field of directions, one through each of given points.

    faces: (k,) in which faces they begin; points: (k, 3) where in these faces.
    Source: Glaeser, section 9.4, figure 8; errata G9-14. Filippov, Differential equations with discontinuous righthand
    sides, section 4, for edges.
    """
    sides = mesh_sides(mesh)
    face, own = starts_in_faces("integral curves", mesh, sides, faces, points)
    flow = face_field_flow(sides, BentFaces(mesh, crease_angle_deg), field)
    return led_curves(sides, flow, face, own, flow.candidates[0, face], length, both_ways)


def mesh_geodesics(
    mesh: Mesh,
    faces: ArrayLike,
    points: ArrayLike | None,
    directions: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = False,
) -> MeshCurves:
    """The straightest lines of a mesh, with the number of the start as level: straight where their faces are unfolded
    into a plane, with equal angles on both sides at a vertex; shortest near by unless they pass a vertex. faces (k,)
    or one; points (k,3): starts, barycentres where None; directions (k,3) or one: of any length, the part across the
    face ignored; length: at most, ten times the extent where None; both_ways: backwards too. Ends and closed lines:
    see `mesh_integral_curves`.
    Source: Polthier and Schmies, Straightest geodesics on polyhedral surfaces, 1998. Errors: see
    `mesh_integral_curves`; directions not finite, or without length in their face.
    """
    sides = mesh_sides(mesh)
    face, own = starts_in_faces("geodesics", mesh, sides, faces, points)
    given = np.asarray(directions, dtype=np.float64)
    if given.shape not in ((3,), (len(face), 3)) or not np.isfinite(given).all():
        raise InputError("geodesics: directions must be three finite numbers for each start")
    given = np.broadcast_to(given, (len(face), 3))
    given = given / np.maximum(np.abs(given).max(axis=1, initial=NO_NORMAL), NO_NORMAL)[:, None]
    normals = sides.mesh.face_normals[face]
    flat = given - dot(given, normals)[:, None] * normals
    none = np.sqrt(dot(flat, flat)) <= ZERO_OF_EXTENT
    if none.any():
        raise InputError(f"geodesics: direction {int(none.argmax()) + 1} has no length in its face")
    return led_curves(sides, StraightFlow(sides), face, own, unit(flat), length, both_ways)


def starts_in_faces(
    name: str, mesh: Mesh, sides: MeshSides, faces: ArrayLike, points: ArrayLike | None
) -> tuple[Ints, Floats]:
    """(k,) the parts of faces in which lines begin, and (k,3) where."""
    given = np.atleast_1d(np.asarray(faces))
    if given.size == 0:
        return np.zeros(0, dtype=np.intp), np.zeros((0, 3))
    if given.ndim != 1 or given.dtype.kind not in "iu":
        raise InputError(f"{name}: faces must be whole numbers")
    known = np.isin(given, sides.source)
    if not known.all():
        raise InputError(f"{name}: there is no face {int(given[~known][0])} among {mesh.face_count}")
    given = given.astype(np.intp)
    at = face_barycentres(mesh)[given] if points is None else np.atleast_2d(np.asarray(points, dtype=np.float64))
    if at.shape != (len(given), 3) or not np.isfinite(at).all():
        raise InputError(f"{name}: points must be three finite numbers for each face")
    # Of the parts of a face the one that a point is most inside of.
    order = np.argsort(sides.source, kind="stable")
    low, high = (np.searchsorted(sides.source[order], given, side) for side in ("left", "right"))
    part, start = order[ragged.ranges(low, high - low)], ragged.owner(high - low)
    corner, offsets = ragged.take(sides.mesh.offsets, part)
    arm = at[start][ragged.owner(np.diff(offsets))] - sides.starts(corner)
    inside = np.minimum.reduceat(dot(sides.inwards[corner], arm), offsets[:-1])
    height = dot(sides.mesh.face_normals[part], at[start] - sides.starts(corner[offsets[:-1]]))
    best = np.lexsort((-inside, start))[ragged.starts(high - low)]
    # The mean of the corners of a face that is not plane is not in it.
    slack = np.inf if points is None else max(ZERO_OF_EXTENT * sides.extent, sides.rounding)
    far = (inside[best] < -slack) | (np.abs(height[best]) > slack)
    if far.any():
        raise InputError(f"{name}: point {int(far.argmax()) + 1} is not in face {int(given[far.argmax()])}")
    own = at - height[best][:, None] * sides.mesh.face_normals[part[best]]
    return part[best].astype(np.intp), np.asarray(own)


def led_curves(
    sides: MeshSides,
    flow: MeshFlow,
    face: Ints,
    points: Floats,
    directions: Floats,
    length: float | None,
    both_ways: bool,
    beside: float = 0.0,
) -> MeshCurves:
    """The lines of a flow as curves, both ways joined; beside: see mesh_traces."""
    longest = DEFAULT_LENGTH * sides.extent if length is None else positive("integral curves: length", length)
    count = len(face)
    if not count:
        return all_mesh_curves([])
    ways = np.repeat([1.0, -1.0][: 1 + both_ways], count)
    found = mesh_traces(
        sides,
        flow,
        np.tile(face, 1 + both_ways),
        np.tile(points, (1 + both_ways, 1)),
        np.tile(directions, (1 + both_ways, 1)) * ways[:, None],
        ways,
        longest,
        beside,
    )
    return _joined_ways(sides, found, count)


def _joined_ways(sides: MeshSides, found: MeshTraces, count: int) -> MeshCurves:
    """Curves from courses, those back (count and more) before those there; closed ones have no way back, and do without
    the way from the start to where they come back to."""
    place = ragged.place(np.bincount(found.line, minlength=len(found.closed)))
    closed = found.closed[:count]
    curve, back = found.line % count, found.line >= count
    rows = np.flatnonzero(np.where(closed[curve], ~back & (place > 0), True))
    # Segments count where they begin on the whole curve, and an open one has a last point.
    open_ = np.flatnonzero(~closed)
    points = np.concatenate([np.where(back[rows, None], found.end[rows], found.begin[rows]), found.last[open_]])
    faces = np.concatenate([sides.source[found.face[rows]], np.full(len(open_), NO_FACE)])
    rank = np.concatenate([np.where(back[rows], -1 - place[rows], place[rows]), np.full(len(open_), len(place))])
    owner = np.concatenate([curve[rows], open_])
    order = np.lexsort((rank, owner))
    number, begin = np.unique(owner[order], return_index=True)
    offsets = np.append(begin, len(order)).astype(np.intp)
    curves = MeshCurves(points[order], offsets, closed[number], faces[order], number.astype(np.float64))
    return without_inner(_without_stops(curves), sides.extent)


def _without_stops(curves: MeshCurves) -> MeshCurves:
    """The curves without segments that have no length."""
    after = ragged.following(curves.offsets)
    still = (curves.points == curves.points[after]).all(axis=1) & (curves.faces != NO_FACE)
    return with_points_kept(curves, ~still)
