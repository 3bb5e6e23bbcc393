"""The pixels of a scene: depth buffer first, then every visible point once, then mirrors and what one sees through."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.geometry.budget import in_turn, mapped, slices
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.vectors import norm
from vectorplot.shading.depth_buffers import CoplanarFaces, DepthBuffer, finest_code, layers_before, ranked, strip
from vectorplot.shading.lighting import Lighting, points_in_pixels, shaded_bodies, shaded_points, visible_points
from vectorplot.shading.quadric_pixels import PixelBodies, front_bodies, quadric_points
from vectorplot.shading.screen import (
    HalfSpace,
    SceneTriangles,
    ScreenTriangles,
    every_nth,
    front_facing,
    screen_triangles,
)
from vectorplot.tolerances import ZERO_OF_EXTENT

Colours = NDArray[np.float32]

POINTS_AT_ONCE, SHARES_AT_ONCE = 1 << 18, 1 << 23
"""So many visible points are shaded at a time, unless shadows are found for many points better than for few; with many
lights fewer, so that what points get of lights are no more numbers than these."""

MIRROR_SHARE = 0.85
"""The part of a mirror's colour that it gets from what it shows."""

MOST_MIRRORS = 32
"""So many mirroring faces are looked into, those with the most pixels; further ones only shine."""


@dataclass(frozen=True, eq=False)
class Picture:
    """What a picture is made of. system: view coordinates to pixels; homogeneous (n,4): the triangles' points there;
    screen: the triangles; opacity, mirror (i,): of items; outer_side (i,): 1 and -1 for items of which only the
    outside is seen, wound right or inside out, 0 for others; coplanar: faces in one plane; background (3,);
    points_at_once: shaded together; every (i,): a transparent item sets one of so many pixels, 0 to blend all; door:
    samples across such a pixel; bodies: opaque quadric bodies, of which there are no triangles.
    """

    triangles: SceneTriangles
    system: CoordinateSystem
    homogeneous: Floats
    screen: ScreenTriangles
    columns: int
    rows: int
    lighting: Lighting
    opacity: Floats
    mirror: Bools
    outer_side: Ints
    coplanar: CoplanarFaces
    background: Floats
    points_at_once: int = POINTS_AT_ONCE
    every: Ints | None = None
    door: int = 1
    bodies: PixelBodies | None = None

    @property
    def shaded_at_once(self) -> int:
        """So many points are shaded together, with regard to the number of lights."""
        return max(1, min(self.points_at_once, SHARES_AT_ONCE // max(1, len(self.lighting.lights))))

    @property
    def opaque(self) -> Bools:
        """(t,) which of the triangles in pixels are opaque."""
        return np.asarray(self.opacity[self.triangles.item[self.screen.source]] >= 1.0)


def picture_of(
    triangles: SceneTriangles,
    system: CoordinateSystem,
    size: tuple[int, int],
    lighting: Lighting,
    opacity: Floats,
    mirror: Bools,
    outer_side: Ints,
    coplanar: CoplanarFaces,
    background: Floats,
) -> Picture:
    """A picture of size columns x rows."""
    homogeneous = system.homogeneous(triangles.points)
    screen = screen_triangles(homogeneous, triangles.corners, near=system.near)
    screen = ranked(screen, triangles, homogeneous, coplanar, lighting.eye, outer_side)
    return Picture(
        triangles, system, homogeneous, screen, *size, lighting, opacity, mirror, outer_side, coplanar, background
    )


def opaque_buffer(picture: Picture, top: int, bottom: int) -> DepthBuffer:
    """The depth buffer of the opaque triangles and the quadric bodies in the rows from top to bottom (exclusive)."""
    chosen = None if (picture.opacity >= 1.0).all() else picture.opaque
    if picture.bodies is None:
        return strip(picture.screen, picture.columns, picture.rows, top, bottom, chosen=chosen)
    depths = finest_code(picture.screen, picture.bodies.depths)
    found = strip(picture.screen, picture.columns, picture.rows, top, bottom, depth_code=depths, chosen=chosen)
    code, body = front_bodies(picture.bodies, depths, picture.columns, top, bottom)
    nearer = code > found.code
    triangle = np.where(nearer, np.int32(-1), found.triangle)
    return replace(
        found, code=np.where(nearer, code, found.code), triangle=triangle, body=np.where(nearer, body, np.int32(-1))
    )


def shaded(picture: Picture, buffer: DepthBuffer) -> Colours:
    """(rows, columns, 3) the colours of what a buffer holds, before the background."""
    rows, columns = buffer.code.shape
    colours = np.empty((rows * columns, 3), dtype=np.float32)
    colours[:] = picture.background
    step = max(1, picture.shaded_at_once // columns)

    def shade(part: slice) -> None:
        piece = replace(buffer, code=buffer.code[part], triangle=buffer.triangle[part], top=buffer.top + part.start)
        found = visible_points(piece, picture.homogeneous, picture.triangles.corners)
        made = shaded_points(picture.triangles, found, picture.lighting)
        colours[found.pixel + part.start * columns] = made.colours
        if picture.bodies is not None and buffer.body is not None:
            met = quadric_points(picture.bodies, buffer.body[part], piece.top)
            colours[met.pixel + part.start * columns] = shaded_bodies(met, picture.lighting)

    for _ in mapped(shade, slices(rows, step)):
        pass
    return colours.reshape(rows, columns, 3)


def with_glass(picture: Picture, buffer: DepthBuffer, colours: Colours) -> Colours:
    """The colours with the transparent triangles that are before a buffer, each as a veil of its opacity: a
    closed body covers what is behind it once, wherever the line of sight enters it."""
    result = colours.reshape(-1, 3).copy()
    _veil(picture, buffer, result, np.ones(len(result), dtype=np.bool_))
    return result.reshape(colours.shape)


def _veil(picture: Picture, buffer: DepthBuffer, colours: Colours, wanted: Bools) -> None:
    """Lay the transparent triangles of the picture that are before a buffer over the colours (p, 3) of its wanted (p,)
    pixels: changes them."""
    clear = _veils(picture)[buffer.triangles.source]
    pixel, triangle, _ = layers_before(buffer, clear)
    pixel, triangle = pixel[wanted[pixel]], triangle[wanted[pixel]]
    for begin in in_turn(range(0, len(pixel), picture.shaded_at_once)):
        part = slice(begin, begin + picture.shaded_at_once)
        found = points_in_pixels(buffer, pixel[part], triangle[part], picture.homogeneous, picture.triangles.corners)
        made = shaded_points(picture.triangles, found, picture.lighting)
        blend(colours, pixel[part], made.colours, _shares(picture, buffer, pixel[part], found.triangle))


def _shares(picture: Picture, buffer: DepthBuffer, pixel: Ints, triangle: Ints) -> Floats:
    """(f,) how much of the colours of pixels (f,) of a buffer is that of the transparent triangles (f,) there: their
    opacity, or all or nothing. Source: Glaeser, section 6.6."""
    item = picture.triangles.item[triangle]
    if picture.every is None:
        return np.asarray(picture.opacity[item])
    row, column = np.divmod(pixel, picture.columns)
    set_ = every_nth((buffer.top + row) // picture.door, column // picture.door, np.maximum(picture.every[item], 1))
    return (set_ & (picture.every[item] > 0)).astype(np.float64)


def _veils(picture: Picture) -> Bools:
    """(t,) which triangles of the scene are veils: those that one sees through, of closed bodies their outsides."""
    triangles = picture.triangles
    clear = picture.opacity[triangles.item] < 1.0
    side = picture.outer_side[triangles.item]
    body = np.flatnonzero(clear & (side != 0))
    outside = front_facing(triangles.points, triangles.corners[body], picture.lighting.eye) == (side[body] > 0)
    clear[body[~outside]] = False
    return np.asarray(clear)


def blend(picture: Colours, pixel: Ints, colours: ArrayLike, opacity: Floats) -> None:
    """Lay colours (f, 3) of some opacity (f,) over pixels (f,), ascending, one after the other: changes the picture."""
    first = np.flatnonzero(np.diff(pixel, prepend=-1))
    rank = np.arange(len(pixel)) - np.repeat(first, np.diff(np.append(first, len(pixel))))
    order = np.argsort(rank, kind="stable")
    veils = np.asarray(colours, dtype=np.float32)
    ends = np.cumsum(np.bincount(rank)).tolist()
    begin = 0
    for end in ends:
        now = order[begin:end]
        share = opacity[now, None]
        picture[pixel[now]] = (1.0 - share) * picture[pixel[now]] + share * veils[now]
        begin = end


Moved = Callable[[Floats], Floats]
"""Where points (n,3) of the scene are seen, by way of mirrors."""


def with_mirrors(
    picture: Picture, buffer: DepthBuffer, colours: Colours, reflections: int = 1, moved: Moved = np.asarray
) -> Colours:
    """The colours with what the visible mirrors show; of further ones in these, reflections - 1 deep, the same: deeper
    ones only shine. moved: where points are seen of which it is the buffer.

    Source: Glaeser, section 6.4 (the mirrored double of a scene, seen through a window).
    """
    source = buffer.source
    pixel = np.flatnonzero(source.ravel() >= 0)
    triangle = source.ravel()[pixel]
    mirrored = picture.mirror[picture.triangles.item[triangle]]
    pixel, triangle = pixel[mirrored], triangle[mirrored]
    faces, first, count = np.unique(picture.triangles.face[triangle], return_index=True, return_counts=True)
    result = colours.reshape(-1, 3).copy()
    for number in np.argsort(-count, kind="stable")[:MOST_MIRRORS].tolist():
        own = pixel[picture.triangles.face[triangle] == faces[number]]
        seen = _reflection(picture, buffer, int(triangle[first[number]]), own, reflections, moved)
        result[own] += np.float32(MIRROR_SHARE) * (seen - result[own])
    return result.reshape(colours.shape)


def _reflection(
    picture: Picture, buffer: DepthBuffer, triangle: int, pixel: Ints, reflections: int, moved: Moved
) -> Colours:
    """(m, 3) what the mirror in the plane of a triangle shows in pixels (m,) of a buffer."""
    triangles, eye = picture.triangles, np.array(picture.lighting.eye)
    a, b, c = triangles.points[triangles.corners[triangle]]
    normal = np.cross(b - a, c - a)
    normal /= norm(normal)
    normal *= np.sign(matmul(eye[:3], normal) - eye[3] * (matmul(a, normal))) or 1.0

    def behind(points: Floats) -> Floats:
        return moved(points - 2.0 * matmul(points - a, normal)[:, None] * normal)

    double = picture.system.homogeneous(behind(triangles.points))
    # What is on the mirror's own side, as a half-space of the double.
    base, tip = moved(np.stack([a, a + normal]))
    side = HalfSpace(_in_pixels(picture.system, np.append(base - tip, matmul(base, tip - base))), ZERO_OF_EXTENT)
    x, y, z = (eye[:3] - 2.0 * (matmul(eye[:3], normal) - eye[3] * (matmul(a, normal))) * normal).tolist()
    lighting = replace(picture.lighting, eye=(x, y, z, float(eye[3])))
    flat = screen_triangles(double, triangles.corners, near=picture.system.near, sides=[side])
    flat = ranked(flat, triangles, double, picture.coplanar, lighting.eye, picture.outer_side)
    columns = picture.columns
    top, bottom = int(pixel.min()) // columns, int(pixel.max()) // columns + 1
    chosen = picture.opacity[triangles.item[flat.source]] >= 1.0
    window = strip(flat, columns, picture.rows, buffer.top + top, buffer.top + bottom, chosen=chosen)
    inside = pixel - top * columns
    number = window.triangle.ravel()[inside]
    colours = np.empty((len(pixel), 3), dtype=np.float32)
    colours[:] = picture.background
    met = np.flatnonzero(number >= 0)
    found = points_in_pixels(window, inside[met], number[met].astype(np.intp), double, triangles.corners)
    colours[met] = shaded_points(triangles, found, lighting).colours
    if reflections == 1 and (picture.opacity >= 1.0).all():
        return colours
    whole, wanted = np.zeros((window.code.size, 3), dtype=np.float32), np.zeros(window.code.size, dtype=np.bool_)
    whole[inside], wanted[inside] = colours, True
    there = replace(picture, homogeneous=double, lighting=lighting)
    if reflections > 1:
        opened = replace(window, triangle=np.where(wanted.reshape(window.code.shape), window.triangle, np.int32(-1)))
        whole = with_mirrors(there, opened, whole, reflections - 1, behind)
    if not (picture.opacity >= 1.0).all():
        _veil(there, window, whole, wanted)
    return whole[inside]


def _in_pixels(system: CoordinateSystem, plane: Floats) -> tuple[float, float, float, float]:
    """A plane (4,) of space, products with (x, y, z, 1), as one of homogeneous points in pixels."""
    origin = system.homogeneous(np.zeros(3))
    matrix = np.column_stack([*(system.homogeneous(np.eye(3)) - origin), origin])
    w, x, y, z = linear_solution(matrix.T, plane).tolist()
    return (w, x, y, z)
