"""The part of a scene that a camera can see at all: its viewing frustum, cut with the box about the scene."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Floats
from vectorplot.geometry.tolerance import ZERO_OF_EXTENT
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


def seen_region(camera: Camera, columns: int, rows: int, bounds: ArrayLike, focus: float = FOCUS) -> SeenRegion:
    """What a picture of so many pixels can show of the box bounds (2, 3).

    The near and the far plane touch the box; the focus plane lies a part ``focus`` of the way from one to the other.
    Errors: InputError for a focus that is not between 0 and 1.
    Source: Martin and Tan, recipe, and Ressler, Notes on implementation of trapezoidal shadow maps, section 2.
    """
    if not 0.0 < focus < 1.0:
        raise InputError(f"a focus at {focus:g} of the depth: expected a part between 0 and 1")
    low, high = np.asarray(bounds, dtype=np.float64)
    middle = (low + high) / 2.0
    size = float((high - low).max()) or camera.distance
    eye = (np.asarray(camera.eye) - middle) / size
    right, up, back = camera.axes
    box = np.concatenate([np.eye(3), -np.eye(3)]), np.concatenate([high - middle, middle - low]) / size
    depth = -_box_corners(box[1]) @ back + eye @ back
    least = -np.inf if camera.parallel else NEAR * camera.distance / size
    near, far = max(float(depth.min()), least), max(float(depth.max()), least)
    half = 0.5 * camera.picture_height / size
    rows_of, limits = [np.array(row) for row in box[0]], list(box[1])
    for way, reach in ((right, half * columns / rows), (up, half)):
        for sign in (1.0, -1.0):
            # Straight ahead in a parallel projection, else through the eye and the border of the picture.
            slope = 0.0 if camera.parallel else reach / (camera.distance / size)
            normal = sign * way + slope * back
            rows_of.append(normal)
            limits.append(float(normal @ eye) + (reach if camera.parallel else 0.0))
    at_focus = near + focus * (far - near)
    corners = _cut_at(rows_of, limits, back, eye, near, far)
    centres = [middle + size * (eye - distance * back) for distance in (near, far, at_focus)]
    focus_corners = _cut_at(rows_of, limits, back, eye, near, at_focus)
    return SeenRegion(middle + size * corners, centres[0], centres[1], centres[2], middle + size * focus_corners)


def _box_corners(halves: Floats) -> Floats:
    signs = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    return np.asarray(signs * halves[:3])


def _cut_at(normals: list[Floats], limits: list[float], back: Floats, eye: Floats, near: float, far: float) -> Floats:
    """Corners of the half-spaces between two depths before the eye."""
    ahead = float(back @ eye)
    return half_space_corners(np.stack([*normals, back, -back]), np.array([*limits, ahead - near, far - ahead]))


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
