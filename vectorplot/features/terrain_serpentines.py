"""Roads with hairpin bends up a terrain: legs and bends, and lines of a plan laid onto the terrain."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import number, positive
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import MeshTraces, Onward, mesh_traces
from vectorplot.features.mesh_lines import NO_FACE, MeshCurves
from vectorplot.features.terrain_roads import Hillsides, SlopeFlow, hillsides_of
from vectorplot.features.terrain_water import Ground, places_on_terrain
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2, power
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.vectors import cross, norm
from vectorplot.tolerances import ROAD_ARRIVES, ZERO_OF_EXTENT

# Legs of roads up a terrain and the hairpin bends between them, of many roads at once.

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

    course: MeshTraces
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
        found = mesh_traces(
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
        crossing = cross(now, way)
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


# Lines of a plan laid onto a terrain.


def draped(ground: Ground, plan: Floats) -> tuple[Floats, Ints]:
    """The points (n,3) on a terrain above a line (k,2) of the plan, those in which it passes from one triangle to the
    next among them, and the triangles (n-1,) between these.

    Edge cases: -1 and NaN heights beside the terrain.
    """
    mesh = ground.mesh
    centre = mesh.bounds.mean(axis=0)[:2]
    line = plan - centre
    segments = np.stack([line[:-1], line[1:]], axis=1)
    row, face = ground.near(plan)
    sides = TRIANGLE * np.repeat(face, TRIANGLE) + np.tile(np.arange(TRIANGLE), len(face))
    row = np.repeat(row, TRIANGLE)
    # Both triangles of an edge have it from the same end: where it is met is the same number.
    ends = np.sort(np.stack([mesh.corners[sides], mesh.corners[mesh.next_corner[sides]]], axis=1), axis=1)
    edges = mesh.vertices[ends][..., :2] - centre
    start, way = segments[row, 0], segments[row, 1] - segments[row, 0]
    base, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        part, place = cross(base - start, along) / cross(way, along), cross(base - start, way) / cross(way, along)
    inner = (part > ZERO_OF_EXTENT) & (part < 1.0 - ZERO_OF_EXTENT) & (place >= 0.0) & (place <= 1.0)
    where = np.unique(np.concatenate([np.arange(len(line), dtype=np.float64), row[inner] + part[inner]]))
    number = np.minimum(where.astype(np.intp), len(segments) - 1)
    places = plan[number] + (where - number)[:, None] * (plan[number + 1] - plan[number])
    _, points = ground.below(places)
    faces, _ = ground.below(0.5 * (places[:-1] + places[1:]))
    return points, faces


# Roads with hairpin bends between two places of a terrain.

DEFAULT_RADIUS = 1.0 / 30.0
"""Part of the distance of its ends that the bends of a road have as radius."""

GENTLER = (1.0, 0.97, 0.94, 0.9, 0.85, 0.8)
"""Parts of the given slope that are tried, one after the other."""

TRIED = 48
"""Widths that are tried first, to each side."""

MOST_PASSING = 4
"""Pairs of widths that pass the end on different sides which are looked into."""

SERPENTINE_ROUNDS = 9
"""How often finer widths are tried between two."""

EVEN = np.linspace(0.0, 1.0, 9)
"""Parts of the way from one width to the next that are tried then,"""

_STEPS = [0.1**k for k in range(1, 7)]
NEAR = np.array([*(-step for step in _STEPS), 0.0, *reversed(_STEPS)])
"""and how far from where a straight line between both would come to the end."""

MOST_BENDS = 40
"""A road that is not at the height of its end after so many is given up."""


def serpentine(
    mesh: Mesh,
    start: ArrayLike,
    end: ArrayLike,
    slope: float,
    *,
    radius: float | None = None,
    width: float | None = None,
) -> MeshCurves:
    """A road with hairpin bends between two places of a terrain, nowhere steeper than a slope but in its bends.

    Parameters
    ----------
    mesh : Mesh
        Of triangles, none above another.
    start, end : (2,) array_like of float
        x and y of both.
    slope : float
        The largest angle with the horizontal plane, in radians, between 0 and pi/2.
    radius : float, optional
        Of the bends in the plan, in world units; a thirtieth of the distance of the ends where None.
    width : float, optional
        How far from the straight line between the ends, in the plan, bends begin at most, in world units; as far as the
        ends are from each other where None. The less, the more bends.

    Returns
    -------
    MeshCurves
        One road from the start to the end. Its level is the slope of its legs, negative downwards.

    Raises
    ------
    InputError
        For places beside the terrain, both in one or of one height; for a slope, a radius or a width that is not
        positive; and where no such road is found: the terrain ends, it has its summit below, or there is no room for
        bends.

    Notes
    -----
    The legs keep to a constant slope, bearing to the left of the steepest way up and to its right in turn; where the
    ground is less steep they go straight up. A bend is an arc of a circle in the plan that leaves one leg and comes to
    the next one along tangents; in it the ground may be steeper: there roads are cut into it. All legs end as far from
    the straight line between the ends; which distance leads to the end is found by trying distances, and then finer
    ones between those that pass the end on different sides: the road with the fewest bends is taken. Where no distance
    does, smaller slopes are tried, down to eight tenths.

    Edge cases: without bends where one leg leads to the end. Legs that come to a narrow ridge, a valley or level
    ground end.

    Source: Glaeser, section 9.5, example 1, for legs.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, scene, surfaces
    >>> x, y = np.meshgrid(np.linspace(-4, 4, 33), np.linspace(-4, 4, 33), indexing="ij")
    >>> hillside = scene.terrain_mesh(surfaces.terrain(0.5 * y, (-4, 4), (-4, 4)))
    >>> road = features.serpentine(hillside, (0, -3), (0, 3), np.radians(10), radius=0.2)
    >>> bool(np.degrees(road.levels[0]) <= 10), road[0][-1].round(6).tolist()
    (True, [0.0, 3.0, 1.5])
    """
    faces, points = places_on_terrain(mesh, np.array([start, end], dtype=np.float64), "serpentine")
    extent = float(np.ptp(mesh.bounds, axis=0).max())
    rise = float(points[1, 2] - points[0, 2])
    distance = float(norm((points[1] - points[0])[:2]))
    if distance <= ZERO_OF_EXTENT * extent:
        raise InputError("serpentine: both ends are in one place")
    if abs(rise) <= ZERO_OF_EXTENT * extent:
        raise InputError("serpentine: both ends are of one height: the road would be a level line")
    if not 0.0 < number("serpentine: slope", slope) < 0.5 * np.pi:
        raise InputError(f"serpentine: slope {np.degrees(slope):g}, expected an angle between 0 and 90 degrees")
    turn = DEFAULT_RADIUS * distance if radius is None else positive("serpentine: radius", radius)
    widest = distance if width is None else positive("serpentine: width", width)
    order = [0, 1] if rise > 0.0 else [1, 0]
    hills, ground = hillsides_of(mesh), Ground(mesh)
    for part in GENTLER:
        climb = Climb(hills, ground, points[order], float(np.sin(part * slope)), turn)
        found = _Search(climb, np.searchsorted(hills.sides.source, faces[order]), widest).road()
        if found is not None:
            return _as_curve(found, part * slope, rise < 0.0)
    raise InputError(
        f"serpentine: no road of at most {np.degrees(slope):g} degrees found from {points[0, 0]:g} {points[0, 1]:g} to "
        f"{points[1, 0]:g} {points[1, 1]:g} with bends of radius {turn:g}"
    )


class _Stage(NamedTuple):
    """Legs of roads (k,), and the bends behind them."""

    road: Ints
    legs: Legs
    bends: Bends


class _Ends(NamedTuple):
    """How roads (k,) end: whether at the height of the end, how far to the left of it and how far from it, after how
    many bends."""

    reached: Bools
    off: Floats
    far: Floats
    bends: Ints


class _Road(NamedTuple):
    """Points (n,3), and the faces (n-1,) of the segments between them."""

    points: Floats
    faces: Ints


@dataclass(frozen=True, eq=False)
class _Search:
    """A climb from one face of its hillsides to another (2,), with bends not farther aside than the widest."""

    climb: Climb
    faces: Ints
    widest: float

    def road(self) -> _Road | None:
        """The road with the fewest bends, None where none is found."""
        least = 0.5 * min(self.climb.radius, self.widest)
        wide = least * power(self.widest / least, np.linspace(0.0, 1.0, TRIED))
        width, side = np.tile(wide, 2), np.repeat([1.0, -1.0], TRIED)
        ends, _ = self._led(width, side)
        passing = _passing(ends)
        passing = passing[side[passing] == side[passing + 1]]
        for k in passing[np.argsort(ends.bends[passing], kind="stable")][:MOST_PASSING].tolist():
            found = self._between(width[k : k + 2], ends.off[k : k + 2], float(side[k]))
            if found is not None:
                return found
        return None

    def _between(self, width: Floats, off: Floats, side: float) -> _Road | None:
        """The road whose width is between two (2,) that pass the end on different sides, so far (2,) off; None where
        roads jump over it."""
        for _ in range(SERPENTINE_ROUNDS):
            straight = off[0] / (off[0] - off[1])
            part = np.unique(np.clip(np.concatenate([EVEN, straight + NEAR]), 0.0, 1.0))
            tried = width[0] + part * (width[1] - width[0])
            ends, stages = self._led(tried, np.full(len(tried), side))
            best = int(np.where(ends.reached, np.abs(ends.off), np.inf).argmin())
            near = ROAD_ARRIVES * self.climb.hills.sides.extent
            if ends.reached[best] and abs(ends.off[best]) <= near:
                # A level line may come back to the line across the end, behind a summit.
                return self._composed(stages, best) if ends.far[best] <= 2.0 * near else None
            passing = _passing(ends)
            if not len(passing):
                return None
            both = slice(passing[0], passing[0] + 2)
            width, off = tried[both], ends.off[both]
        return None

    def _led(self, width: Floats, side: Floats) -> tuple[_Ends, list[_Stage]]:
        """How roads end that bend so far (k,) from the straight line and begin on one side (k,), and their stages."""
        count = len(width)
        ends = _Ends(np.zeros(count, dtype=np.bool_), np.zeros(count), np.zeros(count), np.zeros(count, dtype=np.intp))
        road, face, side = np.arange(count), np.full(count, self.faces[0]), side.copy()
        here, stages = np.broadcast_to(self.climb.points[0], (count, 3)), []
        for number_of_bends in range(MOST_BENDS):
            legs = self.climb.legs(face, here, side[road], width[road])
            done = road[legs.arrived]
            ends.reached[done] = True
            beside = legs.last[legs.arrived] - self.climb.points[1]
            ends.off[done], ends.far[done] = matmul(beside, self.climb.hills.left[self.faces[1]]), norm(beside)
            ends.bends[done] = number_of_bends
            bends = self.climb.bends(legs, side[road])
            stages.append(_Stage(road, legs, bends))
            going = bends.face >= 0
            road, face, here = road[going], bends.face[going], bends.end[going]
            if not len(road):
                break
            side[road] = -side[road]
        return ends, stages

    def _composed(self, stages: list[_Stage], road: int) -> _Road:
        """One of the roads."""
        source, ends = self.climb.hills.sides.source, self.climb.points
        points, faces = [ends[:1]], []
        for stage in stages:
            own = np.flatnonzero(stage.road == road)
            if not len(own):
                break
            k = int(own[0])
            legs, bends = stage.legs, stage.bends
            segments = np.arange(np.searchsorted(legs.course.line, k), legs.stop[k] + 1)
            points += [legs.course.end[segments[:-1]], legs.last[k : k + 1]]
            faces.append(source[legs.course.face[segments]])
            if bends.face[k] >= 0:
                angles = np.linspace(0.0, bends.turn[k], TURNS + 1)
                line, over = draped(self.climb.ground, turned(legs.last[k : k + 1, :2], bends.centre[k], angles))
                points.append(line[1:])
                faces.append(over)
        line, over = np.concatenate(points), np.concatenate(faces)
        line[-1] = ends[1]
        moves = np.linalg.norm(np.diff(line, axis=0), axis=1) > ZERO_OF_EXTENT * self.climb.hills.sides.extent
        return _Road(line[np.append(moves, True)], over[moves])


def _passing(ends: _Ends) -> Ints:
    """The first of each two neighbours of as many bends of which one passes the end on its left and one on its
    right, or meets it."""
    alike = ends.reached[:-1] & ends.reached[1:] & (ends.bends[:-1] == ends.bends[1:])
    return np.flatnonzero(alike & (np.sign(ends.off[:-1]) * np.sign(ends.off[1:]) <= 0.0))


def _as_curve(road: _Road, slope: float, back: bool) -> MeshCurves:
    """The road as a curve, turned round where it leads down."""
    sign = -1 if back else 1
    faces = np.append(road.faces[::sign], NO_FACE)
    offsets = np.array([0, len(road.points)])
    return MeshCurves(road.points[::sign], offsets, np.zeros(1, dtype=np.bool_), faces, np.array([sign * slope]))
