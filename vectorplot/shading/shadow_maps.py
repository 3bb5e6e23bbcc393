"""Shadow maps: depth buffers of lamps, tapered by projective maps of trapezoids, and the settings they have."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import determinant, inverse_matrix, linear_solution, matmul
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.vectors import cross, norm
from vectorplot.scene.light import Light, is_amid
from vectorplot.shading.depth_buffers import DepthCode, depth_codes
from vectorplot.shading.map_settings import MapSettings
from vectorplot.shading.screen import HalfSpace, front_facing, screen_triangles
from vectorplot.shading.seen_region import SeenRegion
from vectorplot.shading.trapezoids import (
    LARGEST_TAPER,
    Axis,
    adapted_size,
    focus_area,
    focus_distance,
    line_of_sight,
    projective_images,
    searched_line,
    taper_of_focus,
    tapered_map,
)
from vectorplot.tolerances import INFINITE, LEAST_DIVISOR, MAP_BIAS, NEAR_OF_DISTANCE, ZERO_OF_EXTENT


def four_by_four(matrix: ArrayLike) -> Floats:
    """(4, 4) a map (3, 3) of x, y and w that leaves z alone."""
    m = np.asarray(matrix, dtype=np.float64)
    result = np.eye(4)
    result[np.ix_([0, 1, 3], [0, 1, 3])] = m
    return result


# What a lamp sees: a depth buffer in its own system, and which points lie behind what is in it.
#
# What the lamp does not see lies in the shadow. Depths are those after T2 in the lamp's system, larger = closer to the
# lamp, for every kind of map: where the map is tapered they are kept in the lamp's own space too, texel by texel, so
# that one bias fits all of it. Sources: Glaeser, section 8.6; Martin and Tan, TSM recipe, polygon offset.

STEEPEST = 0.5
"""Casters are cut where the map's weight is half of that at its top line: nearer its pole depths lose their digits."""

SLOPE_BIAS = 1.0
"""Depth by which a plane rises from one texel to the next, so many times: it does not hide itself."""

BITS = (8, 16, 32)
"""Sizes of a stored depth."""

MARGIN = 1.0
"""Texels left free around what a map shows."""

POINTS_AT_ONCE = 1 << 17
"""So many points are looked up at a time: what fits into the cache."""


@dataclass(frozen=True, eq=False)
class ShadowMap:
    """The depths that a lamp sees. system: the lamp's; texel_from_light (3,3): from (x, y, 1) of its image plane to
    column, row and weight; code (rows,columns): 0 for nothing; depth_code; biased: whether depths are compared with
    a margin. Source: Glaeser, section 8.6; Martin and Tan, recipe, polygon offset.
    """

    system: CoordinateSystem
    texel_from_light: Floats
    code: NDArray[np.unsignedinteger[Any]]
    depth_code: DepthCode
    biased: bool = True

    @cached_property
    def light_from_texel(self) -> Floats:
        """(3, 3) the inverse of texel_from_light."""
        return np.asarray(inverse_matrix(self.texel_from_light))

    @property
    def depth(self) -> Floats:
        """(rows, columns) depths in the lamp's system, -inf where it sees nothing."""
        return self.depths(self.code)

    def depths(self, code: NDArray[np.unsignedinteger[Any]]) -> Floats:
        """Depths in the lamp's system of codes of this map.

        code: (...) as the map holds them; result: (...) -inf where the lamp sees nothing.
        """
        return np.asarray(np.where(code > 0, self.depth_code.depth(code), -np.inf))


def light_plane(system: CoordinateSystem, points: ArrayLike) -> Floats:
    """(n, 2) images of world points (n, 3) in a lamp's image plane. Errors: InputError for points behind the lamp."""
    h = system.homogeneous(points)
    if not (h[:, 3] > 0.0).all():
        raise InputError("a point on or behind the neutral plane of the lamp has no image")
    return np.asarray(h[:, :2] / h[:, 3:])


def standard_frame(images: Floats) -> Floats:
    """(3, 3) the map of the rectangle about images (n, 2) onto the square from -1 to 1.

    Edge cases: a rectangle without width or height gets a billionth of the other.
    """
    low, high = images.min(axis=0), images.max(axis=0)
    size = max(float((high - low).max()), ZERO_OF_EXTENT * float(np.abs(images).max())) or 1.0
    half = np.maximum((high - low) / 2.0, ZERO_OF_EXTENT * size)
    frame = np.diag([1.0 / half[0], 1.0 / half[1], 1.0])
    frame[:2, 2] = -(low + high) / 2.0 / half
    return frame


def region_axis(system: CoordinateSystem, region: SeenRegion) -> tuple[Axis, float, Floats]:
    """The line of sight in the lamp's plane, the distance of the focus behind the top line, and the region's images."""
    images = light_plane(system, region.points)
    near, far, focus = light_plane(system, np.stack([region.near, region.far, region.focus]))
    axis = line_of_sight(images, near, far)
    return axis, focus_distance(axis, focus), images


def trapezoid_frame(system: CoordinateSystem, region: SeenRegion, line: float) -> Floats:
    """(3, 3) the map of the trapezoid around what the eye sees onto the square from -1 to 1; line: the focus line.

    Source: Ressler, Notes on implementation of trapezoidal shadow maps.
    """
    axis, focus, images = region_axis(system, region)
    return tapered_map(images, axis, taper_of_focus(axis, focus, line))


def perspective_frame(system: CoordinateSystem, region: SeenRegion) -> Floats | None:
    """(3,3) the map of a lamp's image plane to the square from -1 to 1 in which the lamp sees the space after the
    camera's perspective; None where it sees no side of what the camera sees, stands amid that cube, or the taper
    leaves no digits. Rays stay rays under the perspective, so it is projective, and depths may be the lamp's own.
    Source: Stamminger and Drettakis, Perspective shadow maps, 2002, sections 3 and 4.
    """
    picture, images = region.picture, light_plane(system, region.points)
    middle, size = images.mean(axis=0), max(float(np.ptp(images, axis=0).max()), LEAST_DIVISOR)
    # Three points of the world that the lamp sees at (0, 0), (1, 0) and (0, 1), counted from there in units of size.
    flat = np.array([[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]])
    places = picture.homogeneous(system.to_world(flat + np.append(middle, 0.0)))
    if system.distance == INFINITE:
        lamp = picture.homogeneous(system.target + system.rotation[:, 2]) - picture.homogeneous(system.target)
    else:
        lamp = picture.homogeneous(system.centre)
    seen = picture.homogeneous(region.points)
    cube = np.stack([(seen[:, :3] / seen[:, 3:]).min(axis=0), (seen[:, :3] / seen[:, 3:]).max(axis=0)])
    half = np.maximum(np.ptp(cube, axis=0) / 2.0, ZERO_OF_EXTENT * np.abs(cube).max())
    after = [np.append((h[:3] - cube.mean(axis=0) * h[3]) / half, h[3]) for h in (*places, lamp)]
    columns = np.stack([after[1] - after[0], after[2] - after[0], after[0]], axis=1)
    way, weight = after[3][:3], after[3][3]
    distance = float(norm(way))
    if not distance > 0.0:
        return None
    toward = way / distance
    # Rows of the picture go with the depth of the view, as far as the lamp looks across it.
    across = cross(toward, np.eye(3)[2 if abs(toward[2]) < ALONG_VIEW else 1])
    across = across / norm(across)
    rows = np.zeros((3, 4))
    rows[0, :3], rows[1, :3] = across, cross(toward, across)
    rows[2] = *(-weight * toward), distance
    count = np.array([[1.0 / size, 0.0, -middle[0] / size], [0.0, 1.0 / size, -middle[1] / size], [0.0, 0.0, 1.0]])
    through = matmul(matmul(rows, columns), count)
    weights = matmul(images, through[2, :2]) + through[2, 2]
    through = through * np.sign(weights[0])
    # Turned, but not mirrored.
    through[0] *= np.sign(determinant(through))
    least, most = np.sort(weights * np.sign(weights[0]))[[0, -1]].tolist()
    if not least * LARGEST_TAPER > most:
        return None
    return np.asarray(matmul(standard_frame(projective_images(through, images)), through / least))


def in_texels(frame: Floats, columns: int, rows: int) -> Floats:
    """(3, 3) a map onto the square from -1 to 1 as one onto texels, with a free margin; centres are the integers."""
    half = np.array([columns, rows]) / 2.0 - MARGIN
    if not (half > 0.0).all():
        raise InputError(f"a shadow map of {columns} x {rows} texels shows nothing")
    texels = np.diag([half[0], -half[1], 1.0])
    texels[:2, 2] = (columns - 1) / 2.0, (rows - 1) / 2.0
    return np.asarray(matmul(texels, frame))


def shadow_map(
    system: CoordinateSystem,
    frame: Floats,
    points: ArrayLike,
    corners: Ints,
    columns: int,
    rows: int,
    *,
    bits: int = 32,
    near: float = NEAR_OF_DISTANCE,
    biased: bool = True,
) -> ShadowMap:
    """The map of triangles (t, 3) of world points (n, 3).

    frame (3, 3): what part of the lamp's image plane it shows, as a map onto the square from -1 to 1, of weight 1 on
    the line where it shows most; bits: 8, 16 or 32 for a depth; near: the smallest weight in the lamp's system.
    Errors: InputError for other bits and impossible sizes. Edge cases: without triangles nothing is in the shadow.
    Source: Glaeser, section 8.6; Martin and Tan, recipe.
    """
    if bits not in BITS:
        raise InputError(f"depths of {bits} bits: expected {', '.join(map(str, BITS))}")
    matrix = in_texels(frame, columns, rows)
    inverse = np.asarray(inverse_matrix(matrix), dtype=np.float64)
    texels = matmul(system.homogeneous(points), four_by_four(matrix).T)
    weight = np.array([inverse[2, 0], inverse[2, 1], 0.0, inverse[2, 2]])
    steep = np.array([0.0, 0.0, 0.0, 1.0]) - STEEPEST * weight
    sides = [HalfSpace((*weight.tolist(),), near), HalfSpace((*steep.tolist(),))]
    flat = screen_triangles(texels, corners, near=STEEPEST * near / 2.0, sides=sides)
    codes, fine = depth_codes(flat, columns, rows)
    seen = codes > 0
    depth = _own_depth(inverse, seen, fine.depth(codes[seen]))
    code = np.zeros((rows, columns), dtype=f"uint{bits}")
    depth_code = _code(depth, bits)
    code[seen] = depth_code.code(depth)
    return ShadowMap(system, matrix, code, depth_code, biased)


def _own_depth(inverse: Floats, seen: Bools, depth: ArrayLike) -> Floats:
    """(k,) the lamp's own depths at the texels that see something, from those of the tapered map."""
    if not inverse[2, :2].any():
        return np.asarray(np.asarray(depth) / inverse[2, 2])
    row, column = np.divmod(np.flatnonzero(seen), seen.shape[1])
    return np.asarray(np.asarray(depth) / (inverse[2, 0] * column + inverse[2, 1] * row + inverse[2, 2]))


def _code(depth: Floats, bits: int) -> DepthCode:
    low, high = (float(depth.min()), float(depth.max())) if len(depth) else (0.0, 0.0)
    if bits == 16:
        return DepthCode.ushort(low, high)
    return DepthCode(low, high, 1.0, 254.0 if bits == 8 else float(2**32 - 8))


def blocked(found: ShadowMap, points: ArrayLike, normals: ArrayLike) -> Bools:
    """(n,) which world points (n, 3) lie in the shadow; normals (n, 3): of the faces they lie on, of any length.

    Points outside the map or behind the lamp lie in no shadow of this map.
    Error: about a texel along the borders of shadows; what rises less above a face than the bias casts none on it.
    Source: Glaeser, section 8.6.
    """
    p, n = (np.asarray(x, dtype=np.float64).reshape(-1, 3) for x in (points, normals))
    result = np.zeros(len(p), dtype=np.bool_)
    parts = slices(len(p), POINTS_AT_ONCE)
    for part, behind in zip(parts, mapped(lambda part: _behind(found, p[part], n[part]), parts), strict=True):
        result[part] = behind
    return result


def _behind(found: ShadowMap, points: Floats, normals: Floats) -> Bools:
    result = np.zeros(len(points), dtype=np.bool_)
    rows, columns = found.code.shape
    m, inverse = found.texel_from_light, found.light_from_texel
    h = found.system.homogeneous(points)
    # What the map does not show is left out, step by step: of the six maps around a lamp one shows each point.
    inside = np.flatnonzero(h[:, 3] > 0.0)
    x, y, z = (h[inside, axis] / h[inside, 3] for axis in range(3))
    weight = m[2, 0] * x + m[2, 1] * y + m[2, 2]
    inside, x, y, z, weight = _chosen(weight > STEEPEST, inside, x, y, z, weight)
    column = (m[0, 0] * x + m[0, 1] * y + m[0, 2]) / weight
    row = (m[1, 0] * x + m[1, 1] * y + m[1, 2]) / weight
    shown = (column > -0.5) & (column < columns - 0.5) & (row > -0.5) & (row < rows - 0.5)
    inside, x, y, z, weight, column, row = _chosen(shown, inside, x, y, z, weight, column, row)
    stored = found.depths(found.code[np.rint(row).astype(np.intp), np.rint(column).astype(np.intp)])
    if found.biased:
        # How the depth rises in the lamp's plane, and how far that plane reaches from one texel to the next.
        by_x, by_y = slopes(found.system, points[inside], normals[inside])
        by_column = np.abs(by_x * (inverse[0, 0] - x * inverse[2, 0]) + by_y * (inverse[1, 0] - y * inverse[2, 0]))
        by_row = np.abs(by_x * (inverse[0, 1] - x * inverse[2, 1]) + by_y * (inverse[1, 1] - y * inverse[2, 1]))
        bias = SLOPE_BIAS * weight * np.maximum(by_column, by_row) + _constant_bias(found, z)
    else:
        bias = np.full(len(z), found.depth_code.step)
    result[inside] = z < stored - bias
    return result


def _chosen(which: Bools, *columns: NDArray[Any]) -> tuple[NDArray[Any], ...]:
    """The values of columns (n,) where which (n,) is true."""
    return tuple(column[which] for column in columns)


def _constant_bias(found: ShadowMap, depth: Floats) -> Floats:
    """(n,) a step of the code, and the same length of space at all depths (n,); never less than the rounding of what
    the map shows: a lamp that sees one plane only has no depth."""
    code, d = found.depth_code, found.system.distance
    rows, columns = found.code.shape
    texel = found.light_from_texel / found.light_from_texel[2, 2]
    wide = float(np.hypot(texel[0, 0], texel[1, 0])) * columns + float(np.hypot(texel[0, 1], texel[1, 1])) * rows
    if d == INFINITE:
        rounding = ZERO_OF_EXTENT * (wide + np.abs(depth))
        return np.asarray(MAP_BIAS * (code.maximum - code.minimum) + code.step + rounding)
    rounding = ZERO_OF_EXTENT * (wide / d + 1.0 + np.abs(depth))
    nearest, farthest = d / (1.0 + code.maximum), d / (1.0 + code.minimum)
    return np.asarray(MAP_BIAS * (farthest - nearest) / d * (1.0 + depth) ** 2 + code.step + rounding)


def slopes(system: CoordinateSystem, points: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """How the depth after T2 of planes through world points (n, 3) with normals (n, 3) grows along x and y of a lamp's
    image plane, each (n,). Edge cases: a plane through the lamp rises without end: a very large number."""
    n = matmul(normals, system.rotation)
    if system.distance == INFINITE:
        facing = n[:, 2]
    else:
        facing = n[:, 2] * system.distance - np.einsum("ij,ij->i", n, system.rotated(points))
    tiny = LEAST_DIVISOR
    facing = np.where(np.abs(facing) > tiny, facing, tiny)
    with np.errstate(over="ignore"):
        return np.asarray(-n[:, 0] / facing), np.asarray(-n[:, 1] / facing)


# Shadow buffers: for every light of a scene the maps of what it sees.
#
# Source: Glaeser, section 8.6; for the tapered maps Ressler, and Martin and Tan.

Frame = Literal["standard", "box", "trapezoid", "perspective"]

ALONG_VIEW = 0.9
"""Cosine from which on a lamp looks along the view rather than across it, after the perspective."""

Blocks = Callable[[Floats, Floats, Ints], Bools]

LONGEST = 4.0
"""A map is no longer than so many times its width."""

MOST_TEXELS = 1 << 28
"""The shadow maps of all lights have no more texels together: a gigabyte of 32-bit depths."""

SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""The directions of the six maps of a lamp in the scene."""


@dataclass(frozen=True, eq=False)
class ShadowBuffer:
    """The maps of one light: a single one, or six around a lamp within the scene.

    maps: empty where nothing casts shadows.
    Source: Glaeser, section 8.6.
    """

    maps: tuple[ShadowMap, ...]

    def blocks(self, points: ArrayLike, normals: ArrayLike) -> Bools:
        """Whether something stands between the light and points of the world.

        points: (n, 3) in the world; normals: (n, 3) of the faces they lie on, of any length; result: (n,) false for
        points outside the maps and behind the lamp.
        Source: Glaeser, section 8.6.
        """
        p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        found = np.zeros(len(p), dtype=np.bool_)
        for one in self.maps:
            found |= blocked(one, p, normals)
        return found


def shadow_buffer(
    light: Light,
    points: ArrayLike,
    corners: Ints,
    *,
    size: int = 1024,
    rows: int | None = None,
    bits: int = 32,
    frame: Frame = "standard",
    region: SeenRegion | None = None,
    casting: Literal["all", "away"] = "all",
    wanted_focus: float | None = None,
) -> ShadowBuffer:
    """The shadow buffer of a light for triangles in the world.

    Parameters
    ----------
    light : Light
        A lamp, or parallel rays.
    points : (n, 3) array_like of float
        In the world.
    corners : (t, 3) array of int
        Into points.
    size : int
        The map has as many texels as a square of this side, and is as wide against its height as what it shows; with
        rows, the number of columns.
    rows : int, optional
        The number of rows.
    bits : int
        Of a depth: 8, 16 or 32.
    frame : {"standard", "box", "trapezoid", "perspective"}
        The map shows the whole scene, the box about what is seen, the trapezoid around it, of which most is what is
        near the eye, or what is seen as the lamp sees it after the camera's perspective.
    region : SeenRegion, optional
        What the camera sees, for all but the first.
    casting : {"all", "away"}
        All faces, or, where all bodies are closed, only those that turn away from the light: then depths need no
        margin.
    wanted_focus : float, optional
        A trapezoidal map grows until what is in focus gets such a part of as many texels as size says, to four times
        the size at most.

    Returns
    -------
    ShadowBuffer
        With one map; for a lamp within the scene six maps of half the size, whole ones.

    Raises
    ------
    InputError
        For impossible sizes, bits, frames and casting, for a tapered map without a region.

    Notes
    -----
    Edge cases: where nothing is seen, and where the eye's line of sight runs behind the lamp, the map is standard; a
    perspective one that would have a lamp amid it is that of the box; without points there is no map.

    Source: Glaeser, section 8.6; Martin and Tan, recipe; Stamminger and Drettakis, Perspective shadow maps, 2002.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    >>> points = [(x, y, 2) for x, y in square] + [(4 * x, 4 * y, 0) for x, y in square]
    >>> corners = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    >>> buffer = shading.shadow_buffer(vp.Light((0, 0, 1), parallel=True), points, corners, size=64)
    >>> len(buffer.maps), buffer.maps[0].code.shape
    (1, (64, 64))
    """
    if casting not in ("all", "away"):
        raise InputError(f"casting {casting!r}: expected all or away")
    if frame not in ("standard", "box", "trapezoid", "perspective"):
        raise InputError(f"frame {frame!r}: expected standard, box, trapezoid or perspective")
    if frame != "standard" and region is None:
        raise InputError(f"a shadow map of the frame {frame} needs the region that is seen")
    p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if not len(p):
        return ShadowBuffer(())
    biased = casting == "all"
    if not biased:
        corners = corners[~front_facing(p, corners, (*light.position, 0.0 if light.parallel else 1.0))]
    if is_amid(light, p):
        half = max(size // 2, 4), max((rows or size) // 2, 4)
        maps = (_side_map(light, way, p, corners, half, bits, biased) for way in SIDES)
        return ShadowBuffer(tuple(maps))
    system = aimed_system(light, p)
    matrix = _frame(system, p, frame, region)
    if wanted_focus is not None and region is not None and len(region.points):
        size = adapted_size(size, _focus_share(system, matrix, region), wanted_focus, int(LONGEST) * size)
    columns, rows = shape_of(matrix, size) if rows is None else (size, rows)
    return ShadowBuffer((shadow_map(system, matrix, p, corners, columns, rows, bits=bits, biased=biased),))


def _focus_share(system: CoordinateSystem, frame: Floats, region: SeenRegion) -> float:
    """What part of a map what is in focus fills; none of it where some is behind the lamp."""
    if not (system.homogeneous(region.focus_points)[:, 3] > 0.0).all():
        return 0.0
    return focus_area(frame, light_plane(system, region.focus_points))


def shape_of(frame: Floats, size: int) -> tuple[int, int]:
    """Columns and rows of a map of about size x size texels that are square in the middle of what it shows.

    frame (3, 3): see shadow_map. No side is longer than four times the other.
    Source: Martin and Tan, recipe, tips (textures that are no squares).
    """
    ends = np.array([[-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 1.0], np.ones(4)])
    there = linear_solution(frame, ends)
    left, right, low, high = (there[:2] / there[2]).T
    wide, long = float(norm(right - left)), float(norm(high - low))
    stretch = np.sqrt(min(max(wide / long, 1.0 / LONGEST), LONGEST)) if long > 0.0 else 1.0
    return round(size * stretch), round(size / stretch)


def shadow_buffers(
    lights: Sequence[Light], points: Floats, corners: Ints, maps: MapSettings, region: SeenRegion | None
) -> tuple[Blocks, ...]:
    """For every light the function of places (m, 3), normals of their faces (m, 3), and triangles (m,), which it does
    not need, that tells which of them it does not reach; with a region maps are tapered for it as maps say.

    Edge cases: maps of more texels together than MOST_TEXELS are made smaller, all alike, and an InputWarning says so.
    """
    frame: Frame = "standard" if region is None else maps.tapered
    size = _affordable_size(lights, points, maps)

    def blocks(buffer: ShadowBuffer, places: Floats, normals: Floats, triangle: Ints) -> Bools:
        return buffer.blocks(places, normals)

    made = (
        shadow_buffer(
            one,
            points,
            corners,
            size=size,
            bits=maps.bits,
            frame=frame,
            region=region,
            casting=maps.casting,
            wanted_focus=maps.wanted_focus,
        )
        for one in lights
    )
    return tuple(partial(blocks, buffer) for buffer in made)


def _affordable_size(lights: Sequence[Light], points: Floats, maps: MapSettings) -> int:
    """The size of maps, or the largest one of which the maps of all lights have room, grown for their focus too."""
    size, growth = maps.size, 1.0 if maps.wanted_focus is None else LONGEST**2
    squares = growth * sum(len(SIDES) / 4.0 if len(points) and is_amid(light, points) else 1.0 for light in lights)
    # A size that one map alone cannot have is refused where maps are made.
    if squares * size * size <= MOST_TEXELS or size * size > MOST_TEXELS:
        return size
    smaller = int(np.sqrt(MOST_TEXELS / squares))
    cause = f"the shadow maps of {len(lights)} lights are {smaller} texels wide, not {size}: there is no room for more"
    warnings.warn(cause, InputWarning, stacklevel=2)
    return smaller


def aimed_system(light: Light, points: Floats) -> CoordinateSystem:
    """The coordinate system of a light that looks at the middle of the points (n, 3)."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    if light.parallel:
        return CoordinateSystem.of_parallel_light(light.position, middle)
    return CoordinateSystem.of_light(light.position, middle)


def _side_map(
    light: Light, way: Floats, points: Floats, corners: Ints, size: tuple[int, int], bits: int, biased: bool
) -> ShadowMap:
    """The map of a quarter turn about one direction from a lamp."""
    place = np.asarray(light.position, dtype=np.float64)
    reach = float(np.abs(points - place).max()) or 1.0
    system = CoordinateSystem.of_light(place, place + reach * way)
    return shadow_map(
        system, np.diag([1.0 / reach, 1.0 / reach, 1.0]), points, corners, *size, bits=bits, biased=biased
    )


def _frame(system: CoordinateSystem, points: Floats, frame: Frame, region: SeenRegion | None) -> Floats:
    if frame == "standard" or region is None or not len(region.points):
        return standard_frame(light_plane(system, points))
    if frame in ("box", "perspective"):
        found = perspective_frame(system, region) if frame == "perspective" else None
        return standard_frame(light_plane(system, region.points)) if found is None else found
    centres = np.stack([region.near, region.far, region.focus])
    if not (system.homogeneous(centres)[:, 3] > 0.0).all():
        return standard_frame(light_plane(system, points))
    axis, focus, images = region_axis(system, region)
    line = searched_line(images, axis, focus, light_plane(system, region.focus_points))
    return trapezoid_frame(system, region, line)
