"""Where the picture goes on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.duplicates import without_duplicates
from vectorplot.drawing.strokes.paths import chosen, concatenated
from vectorplot.drawing.strokes.smooth_duplicates import without_smooth_duplicates
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.scene import Page, Scene
from vectorplot.scene.view import View, look
from vectorplot.visibility.framing import reaches_too_far
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.words import LineKind

COINCIDENT_MM = 1e-4
"""Strokes that are no further apart than this lie on each other, ends on the same point."""


def fitted(page: Page, low: Floats, high: Floats) -> Floats:
    """(3,3) matrix from image to page: the box from low to high (2,) fills the page but for its margin, in the middle.

    Degenerate: a box without extent goes to the middle at the scale 1; one without width or height fills the other.
    """
    room = np.array([page.width_mm, page.height_mm]) - 2.0 * page.margin_mm
    size = high - low
    scales = [r / s for r, s in zip(room.tolist(), size.tolist(), strict=True) if s > 1e-12 * size.max()]
    scale = min(scales, default=1.0)
    middle = np.array([page.width_mm, page.height_mm]) / 2.0
    offset = middle - scale * (low + high) / 2.0
    return np.array([[scale, 0.0, offset[0]], [0.0, scale, offset[1]], [0.0, 0.0, 1.0]])


def centred(page: Page, picture_height: float, height_mm: float) -> Floats:
    """(3,3) matrix from image to page: the image's origin goes to the middle, picture_height becomes height_mm."""
    scale = height_mm / picture_height
    return np.array([[scale, 0.0, page.width_mm / 2.0], [0.0, scale, page.height_mm / 2.0], [0.0, 0.0, 1.0]])


def mm_per_image(view: View, surfaces: Sequence[Floats], page: Page, fit: bool) -> float:
    """About how many mm a unit of the image will be on the page; surfaces: points (k,3) of smooth ones."""
    if not fit:
        return float(page.height_mm / view.picture_height)
    points = np.concatenate([view.points, *(points.T for points in surfaces)], axis=1)
    points = points[:, np.isfinite(points).all(axis=0)]
    every = points.shape[1]
    points = points[:, view.depth_of(points) > view.near]
    if not points.shape[1]:
        return float(page.height_mm / view.picture_height)
    image = view.image_of(points)
    fitting = fitted(page, image.min(axis=1), image.max(axis=1))[0, 0]
    if len(points[0]) == every and not reaches_too_far(view, points, points):
        return float(fitting)
    return float(max(fitting, (page.height_mm - 2.0 * page.margin_mm) / view.picture_height))


def allowed_in_space(
    scene: Scene, camera: Camera, page: Page, fit: bool, tolerance_mm: float
) -> Callable[[Floats], Floats]:
    """How far (...) triangles may be off smooth surfaces at points (..., 3) of the world, so that they are off by no
    more than the tolerance on the page."""
    view = look(scene, camera)
    low, high = scene.bounds
    corners = np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, high, low)
    scale = mm_per_image(view, [view.points_of(corners).T], page, fit)

    def allowed(points: Floats) -> Floats:
        depth = view.depth_of(view.points_of(points.reshape(-1, 3))).reshape(points.shape[:-1])
        ahead = np.ones_like(depth) if view.eye is None else np.maximum(depth, view.near) / view.focus
        return np.asarray(tolerance_mm / scale * view.scale * ahead)

    return allowed


def page_from_image(view: View, lines: Lines, seen: Visibility, page: Page, fit: bool, whole: bool) -> Floats:
    """(3,3) matrix from image to page."""
    if not fit:
        return centred(page, view.picture_height, page.height_mm)
    if not whole:
        return centred(page, view.picture_height, page.height_mm - 2.0 * page.margin_mm)
    if not len(seen.segment):
        return fitted(page, np.zeros(2), np.zeros(2))
    start, end = lines.ends(view, seen.segment, seen.low, seen.high)
    images = np.concatenate([view.image_of(start), view.image_of(end)], axis=1)
    low, high = images.min(axis=1), images.max(axis=1)
    if (high - low).max() <= view.tolerance:
        # Lines along the sight rays: their image is a point, and rounding must not fill the page.
        return fitted(page, low, low)
    return fitted(page, low, high)


def strokes_on_page(view: View, lines: Lines, seen: Visibility, page_from_image: Floats) -> Paths:
    """The parts of lines as strokes on the page, each line once where several lie on each other.

    Of coincident strokes the visible one stays, then the one whose kind comes first, then the one nearer the eye.
    """
    ends = np.stack(lines.ends(view, seen.segment, seen.low, seen.high), axis=2).reshape(3, -1)
    image = view.image_of(ends)
    points = (page_from_image[:2, :2] @ image).T + page_from_image[:2, 2]
    count = len(seen.segment)
    kind, item = lines.kind[seen.segment], lines.item[seen.segment]
    offsets = np.arange(0, 2 * count + 1, 2)
    open_ = np.zeros(count, dtype=np.bool_)
    # Lines at the same depth but for rounding go by their items: so neither size nor place decides which one stays.
    depth = np.round(view.depth_of(ends).reshape(-1, 2).sum(axis=1), 8)
    order = np.lexsort((item, depth, kind, seen.hidden_by > 0))
    rank = np.empty(count, dtype=np.intp)
    rank[order] = np.arange(count)
    world = page_from_world(view, page_from_image)
    paths = Paths(points, offsets, open_, kind, item, seen.hidden_by, view.world_of(ends), lines.smooth[seen.segment])
    straight, smooth = np.flatnonzero(~paths.smooth), chosen(paths, paths.smooth)
    once = without_duplicates(chosen(paths, straight), rank[straight], COINCIDENT_MM, world)
    if not len(smooth):
        return once
    curve_rank = ((smooth.hidden_by > 0) * len(LineKind) + smooth.kind) * len(view.item_vertices) + smooth.item
    return concatenated((once, without_smooth_duplicates(smooth, curve_rank, COINCIDENT_MM)))


def page_from_world(view: View, page_from_image: Floats) -> Floats:
    """(4,4) matrix from points (x,y,z,1) of the world to homogeneous points of the page in mm; the third row keeps
    z."""
    scaled = np.diag([1.0 / view.scale, 1.0 / view.scale, 1.0])
    rows = page_from_image @ scaled @ view.image_from_world
    return np.vstack([rows[:2], [0.0, 0.0, 1.0, 0.0], rows[2:]])
