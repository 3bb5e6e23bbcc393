"""The part of a scene that a camera can see at all: its viewing frustum, cut with the box about the scene, or with the
scene itself."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, linear_solution, matmul
from vectorplot.geometry.projections import CoordinateSystem, depth_of
from vectorplot.shading.screen import HalfSpace, screen_triangles
from vectorplot.shading.trapezoids import FOCUS_LINE
from vectorplot.tolerances import INFINITE, ZERO_OF_EXTENT

FOCUS = 0.3
"""Part of the seen depth that is in focus unless said otherwise."""


@dataclass(frozen=True, eq=False)
class SeenRegion:
    """A part of the world that a picture shows.

    points: (k, 3) its corners, none where nothing is in the frustum; near, far, focus: (3,) the centres of its planes;
    focus_points: (l, 3) corners of the part before the focus plane; picture: the system of the picture, in pixels.
    Source: Martin and Tan, recipe, and Ressler, Notes on implementation of trapezoidal shadow maps, section 2.
    """

    points: Floats
    near: Floats
    far: Floats
    focus: Floats
    focus_points: Floats
    picture: CoordinateSystem


def seen_region(
    system: CoordinateSystem, columns: int, rows: int, bounds: ArrayLike, focus: float = FOCUS
) -> SeenRegion:
    """What a picture of so many pixels can show of the box bounds (2, 3). system: a camera's, in pixels.

    The near and the far plane touch the box; the focus plane lies a part ``focus`` of the way from one to the other.
    Errors: InputError for a focus that is not between 0 and 1.
    Source: Martin and Tan, recipe, and Ressler, Notes on implementation of trapezoidal shadow maps, section 2.
    """
    if not 0.0 < focus < 1.0:
        raise InputError(f"a focus at {focus:g} of the depth: expected a part between 0 and 1")
    low, high = np.asarray(bounds, dtype=np.float64)
    middle = (low + high) / 2.0
    corners = _box_corners(np.concatenate([high - middle, middle - low])) + middle
    near, far = depths_seen(system, corners)
    return _region(system, columns, rows, np.stack([low, high]), near, far, focus)


def region_in_picture(system: CoordinateSystem, columns: int, rows: int, points: Floats, corners: Ints) -> SeenRegion:
    """What a picture of so many pixels can show of some triangles: they are cut with the frustum.

    Parameters
    ----------
    system : CoordinateSystem
        A camera's, in pixels.
    columns, rows : int
        The size of the picture.
    points : (n, 3) array of float
        In the world.
    corners : (t, 3) array of int
        Into points.

    Returns
    -------
    SeenRegion
        The near and the far plane touch what is left.

    Raises
    ------
    InputError
        For coordinates that are not finite, and corners out of range.

    Notes
    -----
    The focus is where the picture of a scene lit from the side is as sharp near the eye as far away.

    Error: nearer than the near plane of the system nothing is seen.

    Edge cases: no points where nothing is in the frustum.

    Source: Wimmer, Scherzer and Purgathofer, Light space perspective shadow maps, section 4 (the focus).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> system = shading.raster_system(vp.Camera((0, 0, 10), up=(0, 1, 0)), 60, 40)
    >>> points = np.array([(-1.0, -1.0, 1.0), (1.0, -1.0, 1.0), (0.0, 1.0, 3.0)])
    >>> region = shading.region_in_picture(system, 60, 40, points, np.array([(0, 1, 2)]))
    >>> region.near.round(6).tolist(), region.far.round(6).tolist()
    ([0.0, 0.0, 3.0], [0.0, 0.0, 1.0])
    """
    sides = [
        HalfSpace((1.0, 0.0, 0.0, 0.5)),
        HalfSpace((-1.0, 0.0, 0.0, columns - 0.5)),
        HalfSpace((0.0, 1.0, 0.0, 0.5)),
        HalfSpace((0.0, -1.0, 0.0, rows - 0.5)),
    ]
    flat = screen_triangles(system.homogeneous(points), corners, near=system.near, sides=sides)
    used = np.zeros(len(flat.points), dtype=np.bool_)
    used[flat.corners] = True
    if not used.any():
        nothing, nowhere = np.zeros((0, 3)), np.zeros(3)
        return SeenRegion(nothing, nowhere, nowhere, nowhere, nothing, system)
    seen = flat.points[used]
    if system.distance != INFINITE:
        seen[:, 2] = depth_of(seen[:, 2], system.distance)
    seen = system.to_world(seen)
    near, far = depths_seen(system, seen)
    share = FOCUS_LINE if system.distance == INFINITE else focus_of_depths(near, far)
    found = _region(system, columns, rows, np.stack([seen.min(axis=0), seen.max(axis=0)]), near, far, share)
    return replace(found, points=seen)


def depths_seen(system: CoordinateSystem, points: Floats) -> tuple[float, float]:
    """The smallest and the largest depth of points (n, 3) before the eye, in a parallel projection before the target;
    none nearer than the near plane."""
    parallel = system.distance == INFINITE
    depth = matmul((system.target if parallel else system.centre) - points, system.rotation[:, 2])
    least = -np.inf if parallel else system.near * system.distance
    return max(float(depth.min()), least), max(float(depth.max()), least)


def focus_of_depths(near: float, far: float) -> float:
    """The part of the depth from near to far, before the eye, that is to get FOCUS_LINE of the map, so that at a right
    angle to the light all that is seen is equally sharp in the picture, as far as one perspective can do it.

    Such a map's base is sqrt(far / near) as wide as its top line. Edge cases: without depth nothing is widened.
    Source: Wimmer, Scherzer and Purgathofer, Light space perspective shadow maps, section 4 (the best n); Ressler,
    section 2, solved for the focus.
    """
    taper = np.sqrt(far / near) - 1.0 if 0.0 < near < far else 0.0
    return float(FOCUS_LINE / (1.0 + (1.0 - FOCUS_LINE) * taper))


def _region(
    system: CoordinateSystem, columns: int, rows: int, bounds: Floats, near: float, far: float, focus: float
) -> SeenRegion:
    """The frustum between two depths, in a box."""
    low, high = bounds
    middle = (low + high) / 2.0
    size = float((high - low).max()) or 1.0
    box = np.concatenate([np.eye(3), -np.eye(3)]), np.concatenate([high - middle, middle - low]) / size
    parallel = system.distance == INFINITE
    # In a parallel projection depths count from the target.
    eye = ((system.target if parallel else system.centre) - middle) / size
    back, depths = system.rotation[:, 2], np.array([near, far, near + focus * (far - near)]) / size
    normals, limits = _window_sides(system, columns, rows, middle, size)
    normals, limits = np.concatenate([box[0], normals]), np.concatenate([box[1], limits])
    corners = _cut_at(normals, limits, back, eye, depths[0], depths[1])
    focus_corners = _cut_at(normals, limits, back, eye, depths[0], depths[2])
    ray = _principal_ray(system, columns, rows)
    centres = [middle + size * (eye + depth * ray) for depth in depths]
    if parallel:
        shift = system.to_world(np.array([(columns - 1) / 2.0, (rows - 1) / 2.0, 0.0])) - system.target
        centres = [centre + shift for centre in centres]
    seen, before = middle + size * corners, middle + size * focus_corners
    return SeenRegion(seen, centres[0], centres[1], centres[2], before, system)


def _principal_ray(system: CoordinateSystem, columns: int, rows: int) -> Floats:
    """(3,) the way through the middle of the picture, of length 1 along the view."""
    if system.distance == INFINITE:
        return np.asarray(-system.rotation[:, 2])
    there = system.to_world(np.array([(columns - 1) / 2.0, (rows - 1) / 2.0, 0.0]))
    return np.asarray((there - system.centre) / system.distance)


def _window_sides(
    system: CoordinateSystem, columns: int, rows: int, middle: Floats, size: float
) -> tuple[Floats, Floats]:
    """Normals (4, 3) and limits (4,) of the half-spaces of the picture's borders, scaled to a box of size 1."""
    origin = system.homogeneous(middle)
    steps = system.homogeneous(middle + size * np.eye(3)) - origin
    normals, limits = [], []
    for axis, count in ((0, columns), (1, rows)):
        for sign, border in ((1.0, -0.5), (-1.0, count - 0.5)):
            plane = sign * (steps[:, axis] - border * steps[:, 3])
            normals.append(-plane)
            limits.append(sign * (origin[axis] - border * origin[3]))
    return np.array(normals), np.array(limits)


def _box_corners(halves: Floats) -> Floats:
    signs = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    return np.asarray(signs * halves[:3])


def _cut_at(normals: Floats, limits: Floats, back: Floats, eye: Floats, near: float, far: float) -> Floats:
    """Corners of the half-spaces between two depths before the eye."""
    ahead = float(matmul(back, eye))
    planes = np.concatenate([normals, back[None], -back[None]])
    return half_space_corners(planes, np.append(limits, [ahead - near, far - ahead]))


def half_space_corners(normals: Floats, limits: Floats) -> Floats:
    """(k, 3) the corners of the convex body of all points p with normals (h, 3) . p <= limits (h,), for a handful of
    half-spaces about the unit box; corners where many planes meet may come several times."""
    lengths = np.linalg.norm(normals, axis=1)
    n, d = normals / lengths[:, None], limits / lengths
    three = np.array(list(combinations(range(len(n)), 3)))
    planes = n[three]
    good = np.abs(determinant(planes)) > ZERO_OF_EXTENT
    points = linear_solution(planes[good], d[three[good]][..., None])[..., 0]
    slack = ZERO_OF_EXTENT * (1.0 + np.abs(points).max(axis=1, initial=0.0))
    return np.asarray(points[(matmul(points, n.T) <= d + slack[:, None]).all(axis=1)])
