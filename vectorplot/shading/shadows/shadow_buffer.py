"""Shadow buffers: for every light of a scene the maps of what it sees.

Source: Glaeser, section 8.6; for the tapered maps Ressler, and Martin and Tan.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.geometry.cameras.coordinate_system import CoordinateSystem
from vectorplot.geometry.vectors import norm
from vectorplot.scene.light import Light
from vectorplot.shading.raster.screen import front_facing
from vectorplot.shading.shadows.map_settings import MapSettings
from vectorplot.shading.shadows.seen_region import SeenRegion
from vectorplot.shading.shadows.shadow_map import (
    ShadowMap,
    blocked,
    light_plane,
    region_axis,
    shadow_map,
    standard_frame,
    trapezoid_frame,
)
from vectorplot.shading.shadows.trapezoid import adapted_size, focus_area, searched_line

Frame = Literal["standard", "box", "trapezoid"]

Blocks = Callable[[Floats, Floats, Ints], Bools]

WIDEST_COSINE = 0.5
"""A lamp that sees a corner of the scene more than 60 degrees off its middle needs six maps."""

LONGEST = 4.0
"""A map is no longer than so many times its width."""

MOST_TEXELS = 1 << 28
"""The shadow maps of all lights have no more texels together: a gigabyte of 32-bit depths."""

SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""The directions of the six maps of a lamp in the scene."""


@dataclass(frozen=True, eq=False)
class ShadowBuffer:
    """The maps of one light: a single one, or six around a lamp within the scene.

    Parameters
    ----------
    maps : tuple of ShadowMap
        Empty where nothing casts shadows.

    Notes
    -----
    Source: Glaeser, section 8.6.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> roof, corners = [(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], np.array([(0, 1, 2), (0, 2, 3)])
    >>> buffer = shading.shadow_buffer(vp.Light((0, 0, 1), parallel=True), roof, corners, size=64)
    >>> buffer.blocks(points=[(0, 0, 0), (3, 3, 0)], normals=[(0, 0, 1), (0, 0, 1)]).tolist()
    [True, False]
    """

    maps: tuple[ShadowMap, ...]

    def blocks(self, points: ArrayLike, normals: ArrayLike) -> Bools:
        """Whether something stands between the light and points of the world.

        Parameters
        ----------
        points : (n, 3) array_like of float
            In the world.
        normals : (n, 3) array_like of float
            Of the faces they lie on, of any length.

        Returns
        -------
        (n,) array of bool
            False for points outside the maps and behind the lamp.

        Notes
        -----
        Error: about a texel along the borders of shadows; what rises less above a face than the bias casts none on it.

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
    frame : {"standard", "box", "trapezoid"}
        The map shows the whole scene, the box about what is seen, or the trapezoid around it, of which most is what is
        near the eye.
    region : SeenRegion, optional
        What the camera sees, for box and trapezoid.
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
    Degenerate: where nothing is seen, and where the eye's line of sight runs behind the lamp, the map is standard;
    without points there is no map.

    Source: Glaeser, section 8.6; Martin and Tan, recipe.

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
    if frame not in ("standard", "box", "trapezoid"):
        raise InputError(f"frame {frame!r}: expected standard, box or trapezoid")
    if frame != "standard" and region is None:
        raise InputError(f"a shadow map of the frame {frame} needs the region that is seen")
    p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if not len(p):
        return ShadowBuffer(())
    biased = casting == "all"
    if not biased:
        corners = corners[~front_facing(p, corners, (*light.position, 0.0 if light.parallel else 1.0))]
    if is_inside(light, p):
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

    frame (3, 3): as of shadow_map. No side is longer than four times the other.
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
    not need, that tells which of them it does not reach; with a region maps are trapezoids around it.

    Degenerate: maps of more texels together than MOST_TEXELS are made smaller, all alike, and an InputWarning says so.
    """
    frame: Frame = "standard" if region is None else "trapezoid"
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
    squares = growth * sum(len(SIDES) / 4.0 if len(points) and is_inside(light, points) else 1.0 for light in lights)
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


def is_inside(light: Light, points: Floats) -> bool:
    """Whether a lamp stands in the box about points (n, 3), or so close to it that one map would be too wide."""
    if light.parallel:
        return False
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
    place = np.asarray(light.position, dtype=np.float64)
    arm, middle = corners - place, (low + high) / 2.0 - place
    cosine = matmul(arm, middle)
    return bool((cosine <= WIDEST_COSINE * np.linalg.norm(arm, axis=1) * norm(middle)).any())


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
    if frame == "box":
        return standard_frame(light_plane(system, region.points))
    centres = np.stack([region.near, region.far, region.focus])
    if not (system.homogeneous(centres)[:, 3] > 0.0).all():
        return standard_frame(light_plane(system, points))
    axis, focus, images = region_axis(system, region)
    line = searched_line(images, axis, focus, light_plane(system, region.focus_points))
    return trapezoid_frame(system, region, line)
