"""Roads with hairpin bends between two places of a terrain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.parameters import number, positive
from vectorplot.errors import InputError
from vectorplot.features.meshes.mesh_curves import NO_FACE, MeshCurves
from vectorplot.features.terrains.draped import draped
from vectorplot.features.terrains.hairpins import TURNS, Bends, Climb, Legs, turned
from vectorplot.features.terrains.hillsides import hillsides_of
from vectorplot.features.terrains.places import Ground, places_on_terrain
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import power
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ROAD_ARRIVES, ZERO_OF_EXTENT

USUAL_RADIUS = 1.0 / 30.0
"""Part of the distance of its ends that the bends of a road have as radius."""

GENTLER = (1.0, 0.97, 0.94, 0.9, 0.85, 0.8)
"""Parts of the given slope that are tried, one after the other."""

TRIED = 48
"""Widths that are tried first, to each side."""

MOST_PASSING = 4
"""Pairs of widths that pass the end on different sides which are looked into."""

ROUNDS = 9
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

    Degenerate: without bends where one leg leads to the end. Legs that come to a narrow ridge, a valley or level
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
    turn = USUAL_RADIUS * distance if radius is None else positive("serpentine: radius", radius)
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
        for _ in range(ROUNDS):
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
