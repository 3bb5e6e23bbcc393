"""One fit for a whole film: so that the picture neither jumps nor grows from frame to frame, unless the camera does."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.unit_projection import projection_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.extent import GRID, smooth_bounds
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import is_parametrised

BETWEEN_SAMPLES = 1.005
"""A round body reaches so much farther than points of a grid of GRID x GRID on it, and a bit more."""


def half_extents(scene: Scene, camera: Camera) -> tuple[float, float] | None:
    """How far a scene reaches from the camera's principal ray, to the side and upwards, as parts of the height of its
    picture; None where it reaches behind the eye, or too far off the ray to be fitted."""
    projection = projection_of(camera, scene.bounds)
    points = projection.points_of(reached_points(scene))
    if projection.reaches_too_far(points):
        return None
    image = np.abs(projection.image_of(points)) / projection.picture_height
    width, height = image.max(axis=1, initial=0.0).tolist()
    return width, height


def reached_points(scene: Scene) -> Floats:
    """(n,3) points as far out as the scene reaches: vertices, points on curves and surfaces, corners of boxes around
    implicit ones."""
    found = [scene.vertices]
    for item in scene.items:
        shape = item.shape
        if isinstance(shape, Mesh):
            continue
        if is_curve(shape):
            points = shape.points(np.linspace(shape.start, shape.end, GRID * GRID + 1))
        elif is_parametrised(shape):
            u, v = np.meshgrid(*shape.domain.grid(GRID, GRID), indexing="ij")
            with np.errstate(invalid="ignore", over="ignore"):
                points = shape.points(u.ravel(), v.ravel())
        else:
            points = box_corners(smooth_bounds(shape))
        found.append(points[np.isfinite(points).all(axis=1)])
    return np.concatenate(found)


def steady_fit(views: Iterable[tuple[Scene, Camera]], page: Page) -> tuple[Page, float]:
    """The page of all frames, and by how much the heights of their cameras' pictures are to be multiplied, so that all
    that is ever seen fills what the margin leaves, the target in the middle.

    views: the scene and the camera of each frame. Degenerate: where one of them reaches behind the eye, or too far off
    the principal ray, the camera's field of vision is what the margin leaves; so it is of nothing.
    """
    width = height = 0.0
    for scene, camera in views:
        found = half_extents(scene, camera)
        if found is None:
            return _of_vision(page)
        width, height = max(width, found[0]), max(height, found[1])
    room = page.room
    sides = [room[0] / width if width else math.inf, room[1] / height if height else math.inf]
    half = min(sides) / BETWEEN_SAMPLES
    if not math.isfinite(half):
        return _of_vision(page)
    # Pictures reach as far on either side of the target.
    sheet = page.around(width * half, height * half)
    return sheet, sheet.height_mm / (0.5 * half)


def _of_vision(page: Page) -> tuple[Page, float]:
    sheet = Page(page.width_mm, page.height_mm, page.margin_mm)
    return sheet, sheet.height_mm / sheet.room[1]


def widened(camera: Camera, factor: float) -> Camera:
    """The camera with a picture so many times as high; the eye stays, and with it the perspective."""
    if camera.parallel:
        return replace(camera, height=camera.picture_height * factor)
    half = math.tan(math.radians(camera.fov_deg) / 2.0)
    return replace(camera, fov_deg=2.0 * math.degrees(math.atan(half * factor)))
