"""A view from a light: which faces are lit, and what lies before what on the rays of light.

A light system is a camera without twist; but a light may stand in the midst of the scene. Then it has six images, one
on each side of a cube about it. They only say which pairs of faces share rays; what is dark, is decided in the view.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping.clipped_polygons import Polygons, cut_polygons
from vectorplot.geometry.convex.plane_cuts import planes_of
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell

FAR = 1e12
"""A light this many times the scene's extent away has parallel rays: they turn by less than what counts as zero."""

NEAREST_OF_FARTHEST = 0.02
"""A light has one image if no point of the scene is nearer to it, along its axis, than this part of the farthest."""

CUBE = np.array(
    [
        [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, 1, 0], [1, 0, 0], [0, 0, -1]],
    ],
    dtype=np.float64,
)
"""Axes of the six images of a light in the scene: right, up, away from the light."""


@dataclass(frozen=True, eq=False)
class FacePlanes:
    """The planes of the faces of a view: planes (4,f) unit normals and constants, first (3,f) a corner of each, area
    (f,) twice the areas, arm (f,) the greatest distance of a corner from that one."""

    planes: Floats
    first: Floats
    area: Floats
    arm: Floats

    @classmethod
    def of(cls, view: View) -> FacePlanes:
        """The planes of all faces."""
        normal, arm, first = newell(view, np.arange(view.face_count))
        point = view.points[:, first]
        return cls(planes_of(normal, point), point, np.sqrt((normal * normal).sum(axis=0)), arm)


@dataclass(frozen=True, eq=False)
class LightSystem:
    """A light in a view's coordinates: position (3,), or for parallel rays the unit vector towards the light; axes
    (k,3,3) of its images: right, up, away from the light; whether each image stops at a window, the side of a cube."""

    position: Floats
    parallel: bool
    axes: Floats
    windowed: bool

    def towards(self, points: Floats) -> Floats:
        """(3,n) vectors from points (3,n) to the light."""
        if self.parallel:
            return np.broadcast_to(self.position[:, None], points.shape)
        return np.asarray(self.position[:, None] - points)

    def facing(self, faces: FacePlanes, tolerance: float) -> Ints:
        """(f,) 1 for faces that turn their outside to the light, -1 their inside, 0 for those that it grazes: whose
        images are narrower than the tolerance."""
        ray = self.towards(faces.first)
        cosine = (faces.planes[:3] * ray).sum(axis=0) * faces.area
        distance = np.sqrt((ray * ray).sum(axis=0))
        limit = tolerance * faces.arm * np.maximum(distance, tolerance)
        return np.where(np.abs(cosine) <= limit, 0, np.sign(cosine)).astype(np.intp)


def light_system(view: View, light: Light) -> LightSystem:
    """The light system of a light of the scene.

    Errors: InputError for a position that is not finite, or parallel rays from no direction.
    Source: Glaeser, sections 2.3 and 6.3.
    """
    given = np.asarray(light.position, dtype=np.float64)
    if given.shape != (3,) or not np.isfinite(given).all():
        raise InputError(f"light {light.name}: its position must be three finite numbers")
    if light.parallel:
        position = matmul(view.axes, _unit(given, light))
    else:
        position = view.points_of(given[None])[:, 0]
        if not np.isfinite(position).all():
            raise InputError(f"light {light.name}: it is out of range")
    distance = float(np.sqrt((np.minimum(np.abs(position), FAR) ** 2).sum()))
    parallel = light.parallel or distance >= FAR
    away = -_unit(position, light) if distance > 0.0 else np.array([0.0, 0.0, -1.0])
    if parallel:
        return LightSystem(-away, True, _axes(away)[None], False)
    depth = matmul(away, view.points - position[:, None])
    if depth.size and not depth.min() > NEAREST_OF_FARTHEST * depth.max():
        return LightSystem(position, False, CUBE, True)
    return LightSystem(position, False, _axes(away)[None], False)


def _unit(vector: Floats, light: Light) -> Floats:
    largest = float(np.abs(vector).max())
    if not largest > 0.0:
        raise InputError(f"light {light.name}: parallel rays need a direction that is not zero")
    scaled = vector / largest
    return np.asarray(scaled / np.sqrt(matmul(scaled, scaled)), dtype=np.float64)


def _axes(away: Floats) -> Floats:
    """(3,3) right, up and away from the light."""
    right = np.cross(np.eye(3)[int(np.argmin(np.abs(away)))], away)
    right = right / np.sqrt(matmul(right, right))
    return np.array([right, np.cross(away, right), away])


@dataclass(frozen=True, eq=False)
class LightBoxes:
    """Where faces are in one image of a light: which (n,), ascending; box (6,n): smallest and largest x and y, nearest
    and farthest depth."""

    which: Ints
    box: Floats

    def grouped(self, group: Ints) -> LightBoxes:
        """The boxes of groups of faces: group (m,) is the group of the face that which numbers, ascending with it."""
        number = group[self.which]
        starts = np.flatnonzero(np.concatenate([[True], number[1:] != number[:-1]])) if len(number) else number
        rows = [
            (np.maximum if k % 2 else np.minimum).reduceat(row, starts) if len(starts) else row
            for k, row in enumerate(self.box)
        ]
        return LightBoxes(number[starts], np.stack(rows))


def light_boxes(view: View, system: LightSystem, faces: Ints) -> list[LightBoxes]:
    """The boxes of some faces in each image of the light; which numbers them as they come."""
    position, offsets = ragged.take(view.offsets, faces)
    points = view.points[:, view.corners[position]]
    if not system.parallel:
        points = points - system.position[:, None]
    numbers = np.arange(len(faces))
    result = []
    for axes in system.axes:
        x, y, depth = matmul(axes, points)
        which, ends = numbers, offsets
        if system.windowed:
            (x, y, depth), ends, which = _in_window(np.stack([x, y, depth]), offsets, view.tolerance)
        if not system.parallel:
            x, y = x / depth, y / depth
        result.append(LightBoxes(which, _boxes(np.stack([x, y, depth]), ends)))
    return result


def _in_window(points: Floats, offsets: Ints, tolerance: float) -> tuple[Floats, Ints, Ints]:
    """The parts of polygons before the light and in the window from -1 to 1 of its image, and which polygons have one.

    A face that comes nearer to the light than half the tolerance has the light in its plane, and casts no shadow.
    """
    depth = points[2]
    possible = np.logical_or.reduceat(depth > 0.0, offsets[:-1]) if len(offsets) > 1 else np.zeros(0, dtype=np.bool_)
    which = np.flatnonzero(possible)
    position, ends = ragged.take(offsets, which)
    polygons = Polygons(np.ascontiguousarray(points[:, position].T), ends)
    polygons, _ = cut_polygons(polygons, polygons.points[:, 2] - 0.25 * tolerance)
    for axis, sign in ((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)):
        reach = sign * polygons.points[:, axis]
        polygons, _ = cut_polygons(polygons, (1.0 + tolerance) * polygons.points[:, 2] - reach)
    filled = np.flatnonzero(np.diff(polygons.offsets))
    ends = np.append(polygons.offsets[filled], len(polygons.points))
    return polygons.points.T, ends, which[filled]


def _boxes(points: Floats, offsets: Ints) -> Floats:
    """(6,n) smallest and largest x, y and depth."""
    if len(offsets) == 1:
        return np.zeros((6, 0))
    return np.stack([f.reduceat(row, offsets[:-1]) for row in points for f in (np.minimum, np.maximum)])
