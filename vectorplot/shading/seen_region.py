"""The part of a scene that a camera can see at all: its viewing frustum, cut with the box about the scene."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats
from vectorplot.geometry.projection import CoordinateSystem
from vectorplot.geometry.tolerance import INFINITE, ZERO_OF_EXTENT
from vectorplot.shading.screen import NEAR

FOCUS = 0.3
"""Part of the seen depth that is in focus unless said otherwise."""


@dataclass(frozen=True, eq=False)
class SeenRegion:
    """A convex body in the world. points (k, 3): its corners, none where nothing is in the frustum; near, far, focus
    (3,): the centres of its planes; focus_points (l, 3): corners of the part before the focus plane."""

    points: Floats
    near: Floats
    far: Floats
    focus: Floats
    focus_points: Floats


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
    size = float((high - low).max()) or 1.0
    box = np.concatenate([np.eye(3), -np.eye(3)]), np.concatenate([high - middle, middle - low]) / size
    back = system.rotation[:, 2]
    parallel = system.distance == INFINITE
    # In a parallel projection depths count from the target.
    eye = ((system.target if parallel else system.centre) - middle) / size
    depth = eye @ back - _box_corners(box[1]) @ back
    least = -np.inf if parallel else NEAR * system.distance / size
    near, far = max(float(depth.min()), least), max(float(depth.max()), least)
    normals, limits = _window_sides(system, columns, rows, middle, size)
    normals, limits = np.concatenate([box[0], normals]), np.concatenate([box[1], limits])
    at_focus = near + focus * (far - near)
    corners = _cut_at(normals, limits, back, eye, near, far)
    focus_corners = _cut_at(normals, limits, back, eye, near, at_focus)
    ray = _principal_ray(system, columns, rows)
    centres = [middle + size * eye + size * distance * ray for distance in (near, far, at_focus)]
    if parallel:
        shift = system.to_world(np.array([(columns - 1) / 2.0, (rows - 1) / 2.0, 0.0])) - system.target
        centres = [centre + shift for centre in centres]
    return SeenRegion(middle + size * corners, centres[0], centres[1], centres[2], middle + size * focus_corners)


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
    ahead = float(back @ eye)
    planes = np.concatenate([normals, back[None], -back[None]])
    return half_space_corners(planes, np.append(limits, [ahead - near, far - ahead]))


def half_space_corners(normals: Floats, limits: Floats) -> Floats:
    """(k, 3) the corners of the convex body of all points p with normals (h, 3) . p <= limits (h,), for a handful of
    half-spaces about the unit box; corners where many planes meet may come several times."""
    lengths = np.linalg.norm(normals, axis=1)
    n, d = normals / lengths[:, None], limits / lengths
    three = np.array(list(combinations(range(len(n)), 3)))
    planes = n[three]
    good = np.abs(np.linalg.det(planes)) > ZERO_OF_EXTENT
    points = np.linalg.solve(planes[good], d[three[good]][..., None])[..., 0]
    slack = ZERO_OF_EXTENT * (1.0 + np.abs(points).max(axis=1, initial=0.0))
    return np.asarray(points[(points @ n.T <= d + slack[:, None]).all(axis=1)])
