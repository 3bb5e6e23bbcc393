"""Legs of roads up a terrain and the hairpin bends between them, of many roads at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.on_meshes.mesh_courses import MeshCourses, mesh_courses
from vectorplot.features.integral.on_meshes.mesh_flows import Onward
from vectorplot.features.terrains.hillsides import Hillsides, SlopeFlow
from vectorplot.features.terrains.places import Ground
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.tolerances.of_extent import ROAD_ARRIVES

FARTHEST_TURN = 1.5 * np.pi
"""A bend turns by so much at most."""

TURNS = 72
"""Parts of the farthest turn at which bends are tried, and drawn."""

FINER, ROUNDS = 64, 5
"""Parts of one of these, and of one of those again, in which a bend ends on an edge."""

LONGEST_LEG = 40.0
"""Times the extent of the terrain that a leg is long, at most."""


class Legs(NamedTuple):
    """Legs (k,) of roads: their course; stop (k,): the segment of it in which they end, -1 where they come to an end
    of the terrain; last (k,3): where; arrived (k,): whether at the height of the road's end."""

    course: MeshCourses
    stop: Ints
    last: Floats
    arrived: Bools


class Bends(NamedTuple):
    """Arcs (k,) of the plan about centre (k,2) by an angle turn (k,), counter-clockwise; end (k,3): where they end on
    the terrain, and in which of its triangles (k,), -1 where there is no bend."""

    centre: Floats
    turn: Floats
    end: Floats
    face: Ints


@dataclass(frozen=True, eq=False)
class Climb:
    """Roads from the lower of two points (2,3) of a terrain to the higher one: the largest sine of their slope, and the
    radius of their bends."""

    hills: Hillsides
    ground: Ground
    points: Floats
    sine: float
    radius: float

    def aside(self, points: Floats) -> Floats:
        """(k,) how far to the left of the straight line between both points others (k,3) are, in the plan."""
        return np.asarray(matmul(points[:, :2] - self.points[0, :2], self._across))

    @cached_property
    def _across(self) -> Floats:
        return np.asarray(_left(_plan(np.diff(self.points, axis=0)))[0])

    def legs(self, face: Ints, start: Floats, side: Floats, width: Floats) -> Legs:
        """Legs from points in faces (k,) on one side of the steepest way, up to the height of the end or to a width
        (k,) on that side of the straight line."""
        count, top = len(face), self.points[1, 2]
        # A leg goes on beyond its bend, which is inside of a triangle.
        far = width + self.hills.sides.lengths.max()
        flow = _LegFlow(self.hills, np.full(count, self.sine), side, self, far)
        line = np.arange(count)
        longest = LONGEST_LEG * self.hills.sides.extent
        found = mesh_courses(
            self.hills.sides, flow, face, start, flow.directions(face, line), line.astype(np.float64), longest
        )
        above, out = found.end[:, 2] - top, side[found.line] * self.aside(found.end) - width[found.line]
        high = _first(found.line, above >= -ROAD_ARRIVES * self.hills.sides.extent, count)
        outside = _first(found.line, out >= 0.0, count)
        arrived = (high >= 0) & ((outside < 0) | (high <= outside))
        stop = np.where(arrived, high, outside)
        ends = np.flatnonzero(stop >= 0)
        at, begin, end = stop[ends], found.begin[stop[ends]], found.end[stop[ends]]
        before = np.where(arrived[ends], begin[:, 2] - top, side[ends] * self.aside(begin) - width[ends])
        behind = np.where(arrived[ends], above[at], out[at])
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.clip(np.nan_to_num(-before / (behind - before)), 0.0, 1.0)
        last = np.full((count, 3), np.nan)
        last[ends] = begin + part[:, None] * (end - begin)
        return Legs(found, stop, last, arrived)

    def bends(self, legs: Legs, side: Floats) -> Bends:
        """Bends behind legs that have not arrived, to the first direction of a leg on the other side."""
        count = len(side)
        bends = Bends(np.full((count, 2), np.nan), np.zeros(count), np.full((count, 3), np.nan), np.full(count, -1))
        rows = np.flatnonzero((legs.stop >= 0) & ~legs.arrived)
        if not len(rows):
            return bends
        stop = legs.stop[rows]
        heading = _plan(legs.course.end[stop] - legs.course.begin[stop])
        # A leg to the left of the steepest way turns to the right, through it.
        sense, start = -side[rows], legs.last[rows, :2]
        centre = start + (self.radius * sense)[:, None] * _left(heading)
        turn = self._turns(start, centre, heading, sense)
        known = np.isfinite(turn)
        rows, start, centre, turn = rows[known], start[known], centre[known], (sense * turn)[known]
        face, end = self.ground.below(turned(start, centre, turn))
        good = (face >= 0) & (end[:, 2] < self.points[1, 2])
        rows = rows[good]
        bends.centre[rows], bends.turn[rows] = centre[good], turn[good]
        bends.end[rows], bends.face[rows] = end[good], self._part_of(face[good])
        return bends

    def _turns(self, start: Floats, centre: Floats, heading: Floats, sense: Floats) -> Floats:
        """(k,) by how much bends turn in their sense; NaN where they leave the terrain before, or turn too far."""
        every = np.arange(len(start))
        low, high = np.zeros(len(start)), np.full(len(start), FARTHEST_TURN)
        turn = np.full(len(start), np.nan)
        for parts in (TURNS, *[FINER] * ROUNDS):
            tried = np.linspace(low[every], high[every], parts + 1, axis=1)
            row = np.repeat(every, parts + 1)
            left, face = self._turn_left(start[row], centre[row], heading[row], sense[row], tried.ravel())
            left, face = left.reshape(tried.shape), face.reshape(tried.shape)
            over = (left <= 0.0) & (left > -0.5 * np.pi)
            over[:, 0] = False
            first = over.argmax(axis=1)
            k = np.arange(len(every))
            # All of a bend lies on the terrain.
            good = over.any(axis=1) & np.logical_and.accumulate(face >= 0, axis=1)[k, first]
            every, tried, left, face, first = every[good], tried[good], left[good], face[good], first[good]
            k = np.arange(len(every))
            low[every], high[every] = tried[k, first - 1], tried[k, first]
            # In one triangle the next leg has one direction; on an edge it may jump over that of the bend.
            turn[every] = high[every] + left[k, first]
            alike = face[k, first] == face[k, first - 1]
            turn[every[~alike]] = high[every[~alike]]
            every = every[~alike]
        return turn

    def _turn_left(
        self, start: Floats, centre: Floats, heading: Floats, sense: Floats, turn: Floats
    ) -> tuple[Floats, Ints]:
        """(k,) by how much bends have to turn on in their sense, after so much (k,), to the direction of the next leg,
        NaN on level ground; the triangles (k,) where they are then, -1 beside the terrain."""
        face, _ = self.ground.below(turned(start, centre, sense * turn))
        on = np.flatnonzero(face >= 0)
        left = np.full(len(turn), np.nan)
        # The sense of a bend is the side of the leg behind it.
        way = _plan(self.directions(self._part_of(face[on]), sense[on]))
        now = _rotated(heading[on], (sense * turn)[on])
        crossing = now[:, 0] * way[:, 1] - now[:, 1] * way[:, 0]
        left[on] = sense[on] * arctan2(crossing, (now * way).sum(axis=1))
        return left, face

    def directions(self, face: Ints, side: Floats) -> Floats:
        """(k,3) of legs in faces (k,): straight up where the ground is less steep."""
        return self.hills.directions(face, np.minimum(self.sine, self.hills.sine[face]), side)

    def _part_of(self, face: Ints) -> Ints:
        """(k,) triangles as faces of the hillsides."""
        return np.asarray(np.searchsorted(self.hills.sides.source, face))


@dataclass(frozen=True, eq=False)
class _LegFlow(SlopeFlow):
    """Legs of a climb, straight up where the ground is less steep, until an edge lies farther than far (k,) to
    their side of its straight line."""

    climb: Climb
    far: Floats

    def directions(self, face: Ints, line: Ints) -> Floats:
        """(k,3) the directions of legs in faces (k,)."""
        return self.climb.directions(face, self.side[line])

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the other face, where its direction leads away from the edge."""
        onward, sides, line = super().over_edge(side, directions, way), self.hills.sides, way.astype(np.intp)
        middle = 0.5 * (sides.starts(side) + sides.ends(side))
        beyond = self.side[line] * self.climb.aside(middle) > self.far[line]
        return onward._replace(face=np.where(beyond, -1, onward.face))


def turned(start: Floats, centre: Floats, angle: Floats) -> Floats:
    """(k,2) points, or one, turned about centres, or one."""
    return np.asarray(centre + _rotated(start - centre, angle))


def _first(line: Ints, flag: Bools, count: int) -> Ints:
    """(count,) the first segment of each line that has a flag, -1 where none has."""
    result = np.full(count, -1, dtype=np.intp)
    which = np.flatnonzero(flag)[::-1]
    result[line[which]] = which
    return result


def _plan(ways: Floats) -> Floats:
    """(k,2) unit directions of the plan."""
    flat = ways[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(flat / np.linalg.norm(flat, axis=1, keepdims=True))


def _left(ways: Floats) -> Floats:
    return np.column_stack([-ways[:, 1], ways[:, 0]])


def _rotated(ways: Floats, angle: Floats) -> Floats:
    return np.asarray(np.cos(angle)[:, None] * ways + np.sin(angle)[:, None] * _left(ways))
