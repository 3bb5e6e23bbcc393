"""Roads of constant slope on a terrain: ways up its triangles, and roads between two places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import (
    NO_SIDE,
    MeshSides,
    MeshTraces,
    Onward,
    mesh_sides,
    mesh_traces,
    outwards,
)
from vectorplot.features.mesh_lines import NO_FACE, MeshCurves
from vectorplot.features.surface_points import face_sites, unit
from vectorplot.features.terrain_water import places_on_terrain
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arcsin, power
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances import FLAT_SLOPE, ROAD_ARRIVES, ZERO_OF_EXTENT

# Ways up the triangles of a terrain with a constant slope.


@dataclass(frozen=True, eq=False)
class Hillsides:
    """The triangles of a terrain and their sides; in each the steepest way up (f,3), the sine (f,) of its slope, NaN
    where it is level, and the way (f,3) to its left."""

    sides: MeshSides
    steepest: Floats
    sine: Floats
    left: Floats

    def directions(self, face: Ints, sine: Floats, side: Floats) -> Floats:
        """(k,3) up in faces (k,) with sines (k,) of slopes, to the left (1) or right (-1) of the steepest way; NaN
        where this is less steep."""
        with np.errstate(invalid="ignore"):
            part = sine / self.sine[face]
            across = side * np.sqrt(1.0 - part * part)
        return np.asarray(part[:, None] * self.steepest[face] + across[:, None] * self.left[face])


def hillsides_of(mesh: Mesh) -> Hillsides:
    """The hillsides of a mesh of triangles."""
    sides = mesh_sides(mesh)
    sites = face_sites(sides.mesh)
    up = sites.tangential(np.broadcast_to(np.array([0.0, 0.0, 1.0]), sites.normals.shape))
    sine = np.sqrt(dot(up, up))
    sine = np.where(sine > FLAT_SLOPE, sine, np.nan)
    steepest = unit(up)
    return Hillsides(sides, steepest, sine, cross(sites.normals, steepest))


@dataclass(frozen=True, eq=False)
class SlopeFlow:
    """Up with constant slopes: line k with sine[k], on side[k] of the steepest way; it ends where the ground is less
    steep, and where it had to slide along an edge."""

    hills: Hillsides
    sine: Floats
    side: Floats

    def directions(self, face: Ints, line: Ints) -> Floats:
        """(k,3) the directions of lines in faces (k,); NaN where these are less steep."""
        return self.hills.directions(face, self.sine[line], self.side[line])

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the other face, where its direction leads away from the edge."""
        sides, other = self.hills.sides, self.hills.sides.across[side]
        face = np.where(other != NO_SIDE, sides.mesh.corner_face[other], -1)
        onward = self.directions(face, way.astype(np.intp))
        leads = (other != NO_SIDE) & (outwards(sides, other, onward) < 0.0)
        return _onward(np.where(leads, face, -1), onward, other)

    def over_vertex(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the face whose direction leads away from the vertex, the nearest to the way it came of several."""
        sides = self.hills.sides
        listed, offsets = ragged.take(sides.vertex_offsets, sides.mesh.corners[side])
        around, owner = sides.at_vertex[listed], ragged.owner(np.diff(offsets))
        face, previous = sides.mesh.corner_face[around], sides.before[around]
        own = self.directions(face, way[owner].astype(np.intp))
        into = (outwards(sides, around, own) <= 0.0) & (outwards(sides, previous, own) <= 0.0)
        near = np.where(into, np.nan_to_num(dot(own, directions[owner])), -np.inf)
        best = np.lexsort((-near, owner))[ragged.starts(np.diff(offsets))]
        found = _onward(np.where(np.isfinite(near[best]), face[best], -1), own[best], around[best])
        return found._replace(second=previous[best])


def _onward(face: Ints, directions: Floats, first: Ints) -> Onward:
    none = np.full(len(face), NO_SIDE)
    return Onward(face, directions, first, none, np.zeros(len(face), dtype=np.bool_))


# Roads of constant slope between two places of a terrain.

DEFAULT_LONGEST = 6.0
"""Times the distance of its ends that a road is long, at most."""

TRIED = 160
"""Slopes that are tried to each side first."""

FINER = 64
"""Slopes that are tried between two."""

ROUNDS = 6
"""How often they are: so much finer than the first ones that doubles cannot tell them apart."""

MOST_PASSING = 6
"""Pairs of slopes that pass the end on different sides which are looked into."""

SIDES = (1.0, -1.0)
"""To the left of the steepest slope, and to its right."""


def roads(mesh: Mesh, start: ArrayLike, end: ArrayLike, *, longest: float | None = None) -> MeshCurves:
    """The roads of constant slope between two places of a terrain: the shortest that keeps to the left of the steepest
    way up, and the shortest to its right, with slopes (angles, negative downwards) as levels. start, end (2,): x and
    y; longest: in world units, six times the distance where None. In each triangle a road of given slope has two
    directions and keeps to one, as a generalised helix; the slope is found by sampling, then by refining where the
    end is passed on different sides. A road ends in a narrow ridge or valley that leads back over an edge.
    Source: Glaeser, sections 9.4, equations 20 to 23, and 9.5, example 1. Errors: InputError for places beside the
    terrain, equal or of one height, and without such a road.
    """
    faces, points = places_on_terrain(mesh, np.array([start, end], dtype=np.float64), "road")
    extent = float(np.ptp(mesh.bounds, axis=0).max())
    rise = float(points[1, 2] - points[0, 2])
    distance = float(norm(points[1] - points[0]))
    if distance <= ZERO_OF_EXTENT * extent:
        raise InputError("road: both ends are in one place")
    if abs(rise) <= ZERO_OF_EXTENT * extent:
        raise InputError("road: both ends are of one height: the road would be a level line")
    most = DEFAULT_LONGEST * distance if longest is None else positive("road: longest", longest)
    order = [0, 1] if rise > 0.0 else [1, 0]
    search = _Search(hillsides_of(mesh), faces[order], points[order], extent)
    found = [road for side in SIDES if (road := search.shortest(side, most)) is not None]
    if not found:
        raise InputError(
            f"road: no road of constant slope from {points[0, 0]:g} {points[0, 1]:g} to {points[1, 0]:g} "
            f"{points[1, 1]:g} within {most:g}: the ground is less steep somewhere, or the terrain ends"
        )
    return _joined(found, rise < 0.0)


@dataclass(frozen=True, eq=False)
class _Road:
    """The points (n,3) of a road, the faces (n-1,) of its segments, and its slope, an angle."""

    points: Floats
    faces: Ints
    slope: float


@dataclass(frozen=True, eq=False)
class _Search:
    """What is known about a road from the lower of two points to the higher one."""

    hills: Hillsides
    faces: Ints
    points: Floats
    extent: float

    def shortest(self, side: float, longest: float) -> _Road | None:
        """The steepest road on one side, None where there is none."""
        start, end = self.points
        rise = float(end[2] - start[2])
        steepest = float(np.nanmax(self.hills.sine, initial=0.0))
        high = min(rise / float(norm(end - start)), steepest)
        low = rise / longest
        if not 0.0 < low < high:
            return None
        tried = low * power(high / low, np.linspace(0.0, 1.0, TRIED))
        passing = _passing(*self._ends(tried, side)[:2])
        # The steepest ones first: they are the shortest.
        for k in passing[::-1][:MOST_PASSING].tolist():
            road = self._between(float(tried[k]), float(tried[k + 1]), side)
            if road is not None:
                return road
        return None

    def _between(self, low: float, high: float, side: float) -> _Road | None:
        """The road whose slope is between two that pass the end on different sides; None where roads jump over it."""
        for _ in range(ROUNDS):
            tried = np.linspace(low, high, FINER)
            reached, off, found = self._ends(tried, side)
            passing = _passing(reached, off)
            if not len(passing):
                return None
            low, high = float(tried[passing[-1]]), float(tried[passing[-1] + 1])
        best = int(np.where(reached, np.abs(off), np.inf).argmin())
        end = self.points[1]
        if norm(found.last[best] - end) > ROAD_ARRIVES * self.extent:
            return None
        # One that begins on an edge may leave its first face at once.
        rows = (found.line == best) & (found.begin != found.end).any(axis=1)
        points = np.concatenate([found.begin[rows], end[None]])
        return _Road(points, self.hills.sides.source[found.face[rows]], float(arcsin(tried[best])))

    def _ends(self, slope: Floats, side: float) -> tuple[Bools, Floats, MeshTraces]:
        """(k,) whether roads of slopes (k,) come to the height of the end, how far beside it, to its left (positive) or
        right, and the roads."""
        start, end = self.points
        flow = SlopeFlow(self.hills, slope, np.full(len(slope), side))
        line = np.arange(len(slope))
        face = np.full(len(slope), self.faces[0])
        length = (end[2] - start[2]) / slope
        first = np.broadcast_to(start, (len(slope), 3))
        found = mesh_traces(
            self.hills.sides, flow, face, first, flow.directions(face, line), line.astype(np.float64), length
        )
        way = found.last - end
        reached = np.abs(way[:, 2]) <= ROAD_ARRIVES * self.extent
        return reached, np.asarray(matmul(way, self.hills.left[self.faces[1]])), found


def _passing(reached: Bools, off: Floats) -> Ints:
    """The first of each two neighbours of which one passes the end on its left and one on its right, or meets it."""
    change = np.sign(off[:-1]) != np.sign(off[1:])
    return np.flatnonzero(reached[:-1] & reached[1:] & change)


def _joined(found: list[_Road], back: bool) -> MeshCurves:
    """The roads as curves, turned round where they lead down."""
    sign = -1 if back else 1
    points = np.concatenate([road.points[::sign] for road in found])
    faces = np.concatenate([np.append(road.faces[::sign], NO_FACE) for road in found])
    offsets = ragged.offsets(np.array([len(road.points) for road in found]))
    slopes = np.array([sign * road.slope for road in found])
    return MeshCurves(points, offsets, np.zeros(len(found), dtype=np.bool_), faces, slopes)
