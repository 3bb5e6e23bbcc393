"""Lines led across the faces of a mesh, all of them face by face at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.on_meshes.mesh_flows import MeshFlow, Onward
from vectorplot.features.integral.on_meshes.mesh_sides import NO_SIDE, MeshSides
from vectorplot.geometry import ragged
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import dot, norm, point_on_line
from vectorplot.tolerances.of_extent import CLOSED_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

MOST_FACES = 100_000
"""A line runs across so many faces at most."""

FAR = 4.0
"""Times the distance at which lines are beside where they have been, that they run before that is looked for, and
beyond."""


class MeshCourses(NamedTuple):
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


def mesh_courses(
    sides: MeshSides,
    flow: MeshFlow,
    face: Ints,
    points: Floats,
    directions: Floats,
    way: Floats,
    length: Floats | float,
    beside: float = 0.0,
) -> MeshCourses:
    """Lines from points (k,3) in faces (k,) along directions (k,3), with a flow or (way: -1) against it; length: of
    all, or (k,) of each. beside: those that come back so near to where they have been do not run on for many rounds;
    all do where it is zero.

    A line ends where the flow does not lead on, where it is as long as it may be, and where it comes back to where it
    left its first face, into the same face in the same direction: it is closed then.
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
    for step in range(MOST_FACES):
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
    return MeshCourses(
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
