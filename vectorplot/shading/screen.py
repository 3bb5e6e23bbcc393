"""Triangles on the way to pixels: projected, cut at the near plane, with depths; those of a scene's faces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision, fitted_picture
from vectorplot.scene.view import View
from vectorplot.shading.pixel_coverage import GUARD_BAND
from vectorplot.shading.shaded_faces import CornerNormals, TrueNormals, view_normals
from vectorplot.tolerances import INFINITE, NEAR_OF_DISTANCE

# Triangles on the way to pixels: projected, cut at the near plane, with a depth that is larger the closer it is.

LARGEST_SIDE_PIXELS = 32767
"""The limit of backends.cairo.surfaces, well inside the guard band."""

LARGEST_RASTER_PIXELS = 1 << 27
"""1 GB of depths."""


@dataclass(frozen=True, eq=False)
class ScreenTriangles:
    """Triangles in pixels, all of them in front of the near plane and inside the guard band.

    points (p,3): column, row and depth after T2: z / (d - z), in a parallel projection z; corners (t,3): into points;
    source (t,): the triangle each is a part of; sheet (t,): the plane that it shares with others, -1 for none; None:
    none shares any; slopes (3,k): the depth of each such plane at column 0 and row 0, and how it grows with these.
    """

    points: Floats
    corners: Ints
    source: Ints
    sheet: Ints | None = None
    slopes: Floats | None = None

    def __len__(self) -> int:
        return len(self.corners)


@dataclass(frozen=True)
class HalfSpace:
    """Homogeneous points p with normal . p >= limit.

    normal: (float, float, float, float) what the coordinates x, y, z and weight of a point are multiplied by; limit:
    the smallest product.
    """

    normal: tuple[float, float, float, float]
    limit: float = 0.0


def raster_size(columns: int, rows: int) -> tuple[int, int]:
    """The size in pixels, if there can be such a raster.

    result: (int, int) columns and rows.
    """
    if not (1 <= columns <= LARGEST_SIDE_PIXELS and 1 <= rows <= LARGEST_SIDE_PIXELS):
        raise InputError(f"a raster of {columns} x {rows} pixels: sides must be 1 to {LARGEST_SIDE_PIXELS}")
    if columns * rows > LARGEST_RASTER_PIXELS:
        raise InputError(f"a raster of {columns} x {rows} pixels is too large")
    return int(columns), int(rows)


def raster_system(camera: Camera, columns: int, rows: int) -> CoordinateSystem:
    """The camera's system in pixels with centres at integers and row 0 on top; the field of vision fills the height.

    Parameters
    ----------
    camera : Camera
        Whose picture it is.
    columns, rows : int
        Its size in pixels.

    Returns
    -------
    CoordinateSystem
        From the world to column, row and depth.

    Raises
    ------
    InputError
        For a raster too large or without pixels.

    Notes
    -----
    Source: Glaeser, section 2.3; decision D-1.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> camera = vp.Camera((0, 0, 5), up=(0, 1, 0), parallel=True, height=10.0)
    >>> system = shading.raster_system(camera, 10, 10)
    >>> system.from_world([(0, 0, 0), (4.5, 4.5, 1)]).round(9).tolist()
    [[4.5, 4.5, 0.0], [9.0, 0.0, 1.0]]
    """
    raster_size(columns, rows)
    system = CoordinateSystem.of_screen(camera, PixelWindow(columns, rows, -1.0))
    return replace(system, middle=((columns - 1) / 2.0, (rows - 1) / 2.0))


def picture_placement(view: View, page: Page, fit: bool, beside: Floats | None = None) -> Placement:
    """The place of a picture of a view on a page whose millimetres are pixels: if it is to fit, all points fill the
    page but for its margin. beside (n,3): further points of the world.

    Edge cases: without points, and where the scene reaches too far, it shows the camera's field of vision, and what
    is beside it in the margin.
    """
    others = view.points_of(np.zeros((0, 3)) if beside is None else beside)
    points = np.concatenate([view.points, others], axis=1)
    if not fit or not points.shape[1] or view.reaches_too_far(points):
        return field_of_vision(view, page, fit)
    return fitted_picture(view, page, np.concatenate([view.image, view.image_of(others)], axis=1))


def pixel_system(placement: Placement) -> CoordinateSystem:
    """The system from a projection's coordinates to pixels with centres at integers and row 0 on top, for a page whose
    millimetres are pixels."""
    projection = placement.projection
    x, y = placement.page_from_image[:2, 2].tolist()
    middle = (x - 0.5, placement.page.height_mm - 0.5 - y)
    if projection.eye is None:
        scale = (placement.scale, -placement.scale)
        return CoordinateSystem(projection.target, np.eye(3), INFINITE, scale, middle)
    # Of the image planes one is in the middle of the scene, the other goes through the target.
    distance = projection.distance
    across = placement.scale * projection.focus / distance
    near = projection.near / distance
    return CoordinateSystem(projection.target, np.eye(3), distance, (across, -across), middle, near)


def front_facing(points: ArrayLike, corners: Ints, eye: ArrayLike) -> Bools:
    """(t,) which triangles of points (n, 3) turn their outer side to the eye: (x, y, z, 1), or (x, y, z, 0) for rays
    that run to the direction (x, y, z). The others, of closed bodies, may be skipped.

    Source: Glaeser, sections 5.1 and 7.3.
    """
    p, e = np.asarray(points, dtype=np.float64), np.asarray(eye, dtype=np.float64)
    a, b, c = (p[corners[:, k]] for k in range(3))
    return np.asarray(np.einsum("ij,ij->i", np.cross(b - a, c - a), e[:3] - e[3] * a) > 0.0)


def screen_triangles(
    points: ArrayLike, corners: ArrayLike, *, near: float = NEAR_OF_DISTANCE, sides: Sequence[HalfSpace] = ()
) -> ScreenTriangles:
    """Triangles in pixels, cut to what is in front of the near plane.

    Parameters
    ----------
    points : (n, 4) array_like of float
        Homogeneous points, as CoordinateSystem.homogeneous gives them.
    corners : (t, 3) array_like of int
        Into points.
    near : float
        The smallest weight, 1 in the image plane and 0 at the eye.
    sides : sequence of HalfSpace
        What is outside of them is cut off first.

    Returns
    -------
    ScreenTriangles
        Their source says which of the triangles they are parts of.

    Raises
    ------
    InputError
        For coordinates that are not finite, corners out of range, and a near plane that is not positive and finite.

    Notes
    -----
    Triangles are dropped or cut where they leave the guard band. A cut edge gets its new corner by the same arithmetic
    in all triangles that have it, so that no gap opens.

    Source: Glaeser, section 2.5 (Hodgman and Sutherland); erratum G2-09.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> system = shading.raster_system(vp.Camera((0, 0, 10), up=(0, 1, 0)), 60, 40)
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 1, 20)]
    >>> triangles = shading.screen_triangles(system.homogeneous(corners), [(0, 1, 2), (0, 1, 3)])
    >>> triangles.source.tolist()
    [0, 1, 1]
    >>> triangles.points[0].round(6).tolist()
    [29.5, 19.5, 0.0]
    """
    p, corners = _checked(points, corners)
    if not 0.0 < near < np.inf:
        raise InputError(f"a near plane at {near:g} shows nothing")
    source = np.arange(len(corners), dtype=np.intp)
    for side in sides:
        p, corners, source = _kept(p, corners, source, matmul(p, np.asarray(side.normal)) - side.limit)
    # The near plane first, then the sides of the guard band.
    for axis, sign in in_turn(((3, 1.0), (0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0))):
        inside = p[:, 3] - near if axis == 3 else sign * p[:, axis] + GUARD_BAND * p[:, 3]
        p, corners, source = _kept(p, corners, source, inside)
    # Points that no triangle is left of may have no image.
    seen = p[:, 3] >= near / 2.0
    flat = p[:, :3] / np.where(seen, p[:, 3], 1.0)[:, None]
    flat[~seen] = 0.0
    # A new corner lies on the border up to rounding.
    np.clip(flat[:, :2], -GUARD_BAND, GUARD_BAND, out=flat[:, :2])
    return ScreenTriangles(flat, corners, source)


def _checked(points: ArrayLike, corners: ArrayLike) -> tuple[Floats, Ints]:
    p = np.asarray(points, dtype=np.float64).reshape(-1, 4)
    t = np.asarray(corners, dtype=np.intp).reshape(-1, 3)
    if not np.isfinite(p).all():
        raise InputError("a point of a triangle has a coordinate that is not a finite number")
    if len(t) and (t.min() < 0 or t.max() >= len(p)):
        raise InputError(f"a triangle names point {int(t.max() if t.max() >= len(p) else t.min())} of {len(p)}")
    return p, t


def _kept(points: Floats, corners: Ints, source: Ints, inside: Floats) -> tuple[Floats, Ints, Ints]:
    return _cut(points, corners, source, inside) if len(points) and inside.min() < 0.0 else (points, corners, source)


def _cut(points: Floats, corners: Ints, source: Ints, inside: Floats) -> tuple[Floats, Ints, Ints]:
    """The parts of triangles where inside (n,) is not negative, with new points behind the old ones."""
    out = inside[corners] < 0.0
    outside = out.sum(axis=1)
    whole = outside == 0
    pieces, owners, made = [corners[whole]], [source[whole]], [points]
    first = len(points)
    for number in in_turn((1, 2)):
        rows = np.flatnonzero(outside == number)
        # The corner that differs from the other two comes first.
        lone = np.argmax(out[rows] if number == 1 else ~out[rows], axis=1)
        a, b, c = (corners[rows, (lone + k) % 3] for k in range(3))
        new_b, new_c = (first + k * len(rows) + np.arange(len(rows)) for k in (0, 1))
        made += [_crossing(points, a, b, inside), _crossing(points, a, c, inside)]
        first += 2 * len(rows)
        if number == 2:
            pieces.append(np.stack([a, new_b, new_c], axis=1))
            owners.append(source[rows])
        else:
            pieces += [np.stack([new_b, b, c], axis=1), np.stack([new_b, c, new_c], axis=1)]
            owners += [source[rows], source[rows]]
    return np.concatenate(made), np.concatenate(pieces), np.concatenate(owners)


def _crossing(points: Floats, a: Ints, b: Ints, inside: Floats) -> Floats:
    """(k, 4) where the edges ab meet the border, computed from the point with the smaller coordinates."""
    p, q = points[a], points[b]
    differs = p != q
    axis = np.argmax(differs, axis=1)[:, None]
    swap = (np.take_along_axis(p, axis, 1) > np.take_along_axis(q, axis, 1))[:, 0]
    p, q = np.where(swap[:, None], q, p), np.where(swap[:, None], p, q)
    low, high = np.where(swap, inside[b], inside[a]), np.where(swap, inside[a], inside[b])
    share = low / (low - high)
    return np.asarray(p + share[:, None] * (q - p))


def every_nth(row: Ints, column: Ints, every: Ints | int) -> Bools:
    """(...) whether pixels are among every n-th: a checkerboard for 2, diagonals for 3, and knight's moves for 4.

    Source: Glaeser, section 6.6.
    """
    shift = np.where(np.asarray(every) == 4, 2, 1)
    return np.asarray((column + shift * row) % every == 0, dtype=np.bool_)


# A scene's faces as triangles ready for a depth buffer, in the coordinates of its view.


@dataclass(frozen=True, eq=False)
class SceneTriangles:
    """points (n, 3) in view coordinates; corners (t, 3) of them; face (t,) of the view, item (t,); normals: of the
    corners."""

    points: Floats
    corners: Ints
    face: Ints
    item: Ints
    normals: CornerNormals

    def __len__(self) -> int:
        return len(self.corners)

    def take(self, which: Bools) -> SceneTriangles:
        """Some of them, with all points."""
        normals = replace(self.normals, index=self.normals.index[which])
        return replace(self, corners=self.corners[which], face=self.face[which], item=self.item[which], normals=normals)


def scene_triangles(view: View, normals: Sequence[TrueNormals | None], crease_angle_deg: float) -> SceneTriangles:
    """The faces of a view; normals and crease angle as in view_normals."""
    may_stop()
    fans, face = ragged.fans(view.offsets)
    points = np.ascontiguousarray(view.points.T)
    corner_normals = view_normals(view, normals, crease_angle_deg)
    return SceneTriangles(points, view.corners[fans], face, view.shown_item[face], corner_normals)
