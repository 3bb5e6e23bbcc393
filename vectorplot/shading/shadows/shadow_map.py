"""What a lamp sees: a depth buffer in its own system, and which points lie behind what is in it.

What the lamp does not see lies in the shadow. Depths are those after T2 in the lamp's system, larger = closer to the
lamp, for every kind of map: where the map is tapered they are kept in the lamp's own space too, texel by texel, so that
one bias fits all of it.
Sources: Glaeser, section 8.6; Martin and Tan, TSM recipe, polygon offset.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, inverse_matrix, matmul
from vectorplot.geometry.cameras.coordinate_system import CoordinateSystem
from vectorplot.geometry.chunks import mapped, slices
from vectorplot.geometry.elementary import power
from vectorplot.shading.depth.depth_buffer import depth_codes
from vectorplot.shading.depth.depth_code import DepthCode
from vectorplot.shading.raster.screen import HalfSpace, screen_triangles
from vectorplot.shading.shadows.seen_region import SeenRegion
from vectorplot.shading.shadows.trapezoid import Axis, focus_distance, line_of_sight, taper_of_focus, tapered_map
from vectorplot.shading.shadows.trapezoid_matrix import four_by_four
from vectorplot.tolerances.of_extent import MAP_BIAS, NEAR_OF_DISTANCE, ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import INFINITE, LEAST_DIVISOR

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
    """The depths that a lamp sees.

    Parameters
    ----------
    system : CoordinateSystem
        The lamp's.
    texel_from_light : (3, 3) array of float
        From (x, y, 1) of its image plane to column, row and weight.
    code : (rows, columns) array of uint8, uint16 or uint32
        0 where the lamp sees nothing.
    depth_code : DepthCode
        What the codes mean.
    biased : bool
        Whether depths are compared with a margin, against faces that shade themselves.

    Notes
    -----
    Source: Glaeser, section 8.6; Martin and Tan, recipe, polygon offset.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> roof, corners = [(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], np.array([(0, 1, 2), (0, 2, 3)])
    >>> (found,) = shading.shadow_buffer(vp.Light((0, 0, 1), parallel=True), roof, corners, size=8, bits=16).maps
    >>> (found.code > 0).sum(axis=1).tolist()
    [0, 6, 6, 6, 6, 6, 6, 0]
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

        Parameters
        ----------
        code : (...) array of uint8, uint16 or uint32
            As the map holds them.

        Returns
        -------
        (...) array of float
            -inf where the lamp sees nothing.
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

    Degenerate: a rectangle without width or height gets a billionth of the other.
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
    Errors: InputError for other bits and impossible sizes. Degenerate: without triangles nothing is in the shadow.
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


def vertices_with_own_depth(system: CoordinateSystem, texel_from_light: Floats, points: ArrayLike) -> Floats:
    """(n, 4) homogeneous points in texels whose depth, after division, is that of the lamp's own space.

    Right at the vertices (n, 3) only: within a triangle such depths are not interpolated linearly, and bend. Good for
    meshes much finer than the map; shadow_map corrects every texel instead.
    Errors: InputError for points behind the lamp.
    Source: Martin and Tan, recipe, polygon offset without fragment programs.
    """
    h = system.homogeneous(points)
    if not (h[:, 3] > 0.0).all():
        raise InputError("a point on or behind the neutral plane of the lamp has no image")
    texels = matmul(h, four_by_four(texel_from_light).T)
    texels[:, 2] = h[:, 2] / h[:, 3] * texels[:, 3]
    return np.asarray(texels)


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
    image plane, each (n,). Degenerate: a plane through the lamp rises without end: a very large number."""
    n = matmul(normals, system.rotation)
    if system.distance == INFINITE:
        facing = n[:, 2]
    else:
        facing = n[:, 2] * system.distance - np.einsum("ij,ij->i", n, system.rotated(points))
    tiny = LEAST_DIVISOR
    facing = np.where(np.abs(facing) > tiny, facing, tiny)
    with np.errstate(over="ignore"):
        return np.asarray(-n[:, 0] / facing), np.asarray(-n[:, 1] / facing)


def texels_per_unit(found: ShadowMap, points: ArrayLike) -> Floats:
    """How many texels there are on a unit of area of the lamp's image plane.

    Parameters
    ----------
    found : ShadowMap
        The map.
    points : (n, 3) array_like of float
        In the world.

    Returns
    -------
    (n,) array of float
        Where the points have their images.

    Raises
    ------
    InputError
        For points on or behind the neutral plane of the lamp.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> roof, corners = [(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], np.array([(0, 1, 2), (0, 2, 3)])
    >>> (found,) = shading.shadow_buffer(vp.Light((0, 0, 1), parallel=True), roof, corners, size=8).maps
    >>> shading.texels_per_unit(found, [(0, 0, 0)]).round(6).tolist()
    [9.0]
    """
    p = light_plane(found.system, points)
    m = found.texel_from_light
    weight = matmul(p, m[2, :2]) + m[2, 2]
    return np.asarray(np.abs(determinant(m)) / power(np.abs(weight), 3))
