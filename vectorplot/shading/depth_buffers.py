"""Depth buffers with depths as whole numbers, for every pixel the triangle in front, and faces in one plane."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices
from vectorplot.scene.view import View
from vectorplot.shading import pixel_coverage
from vectorplot.shading.pixel_coverage import Boxes, Fragments, Snapped
from vectorplot.shading.screen import SceneTriangles, ScreenTriangles, front_facing, raster_size
from vectorplot.shading.shaded_faces import face_normals
from vectorplot.tolerances import ZERO_OF_EXTENT
from vectorplot.visibility.painter.image_faces import image_faces

# Depths as whole numbers: the finest there is room for, and 16 bits.


@dataclass(frozen=True)
class DepthCode:
    """Depths as whole numbers: first + steps * (depth - minimum) / (maximum - minimum), cut off.

    Parameters
    ----------
    minimum, maximum : float
        The depths that there are.
    first : float
        The code of the smallest depth; 0 is left for pixels without one.
    steps : float
        How many steps there are from the smallest to the largest.

    Raises
    ------
    InputError
        For an empty range.

    Notes
    -----
    Edge cases: where all depths are the same, so are the codes.

    Examples
    --------
    >>> from vectorplot.shading import DepthCode
    >>> code = DepthCode.ushort(0.0, 1.0)
    >>> code.code([0.0, 0.5, 1.0]).tolist()
    [1000, 33000, 65000]
    >>> code.depth([33000]).tolist(), code.step
    ([0.5], 1.5625e-05)
    """

    minimum: float
    maximum: float
    first: float
    steps: float

    def __post_init__(self) -> None:
        if not (-np.inf < self.minimum <= self.maximum < np.inf):
            raise InputError(f"depths from {self.minimum:g} to {self.maximum:g} are no range")

    @classmethod
    def ushort(cls, minimum: float, maximum: float) -> DepthCode:
        """The 16-bit code, from 1000 to 65000; 0 is left for pixels without a depth.

        minimum, maximum: the depths that there are; result: of 64000 steps.
        Source: Glaeser, section 7.3.
        Errors: for an empty range.
        """
        return cls(minimum, maximum, 1000.0, 64000.0)

    @classmethod
    def fine(cls, minimum: float, maximum: float, bits: int) -> DepthCode:
        """The finest code of so many bits.

        minimum, maximum: the depths that there are; bits: codes are less than 2^bits; result: from the code 2 on.
        Errors: for an empty range.
        """
        return cls(minimum, maximum, 2.0, float((1 << bits) - 5))

    @property
    def step(self) -> float:
        """How much depth a step is."""
        return (self.maximum - self.minimum) / self.steps

    def scaled(self, depth: ArrayLike) -> Floats:
        """The codes of depths before they are cut off.

        depth (...): from minimum to maximum; result: (...) from first to first + steps.
        Errors: for depths outside the range: clip first.
        """
        d = np.asarray(depth, dtype=np.float64)
        if d.size and not (d.min() >= self.minimum and d.max() <= self.maximum):
            raise InputError(f"a depth lies outside the range from {self.minimum:g} to {self.maximum:g}: clip first")
        return self.of_any(d)

    def of_any(self, depth: ArrayLike) -> Floats:
        """The codes of depths before they are cut off, outside the range too.

        depth (...): any; result: (...) below first and above first + steps for those outside the range.
        """
        d = np.asarray(depth, dtype=np.float64)
        size = self.maximum - self.minimum
        return np.asarray(self.first + self.steps * ((d - self.minimum) / (size if size > 0.0 else 1.0)))

    @property
    def rate(self) -> float:
        """How many steps a unit of depth is."""
        size = self.maximum - self.minimum
        return self.steps / (size if size > 0.0 else 1.0)

    def code(self, depth: ArrayLike) -> NDArray[np.int64]:
        """The codes of depths.

        depth (...): from minimum to maximum; result: (...) from first to first + steps.
        Errors: for depths outside the range: clip first.
        """
        return self.scaled(depth).astype(np.int64)

    def depth(self, code: ArrayLike) -> Floats:
        """The depths of codes, right to one step.

        code (...): from first to first + steps; result: (...) from minimum to maximum.
        """
        return np.asarray(self.minimum + (np.asarray(code, dtype=np.float64) - self.first) * self.step)


# The key in front in every pixel: a triangle's depth there above its number.
#
# Every covered pixel of every triangle offers its key, and the largest of a pixel stays. So the result does not depend
# on the order of the triangles, except that of equally deep ones the first is kept. For what one can see through all
# keys in front of the others are kept.

Keys = NDArray[np.int64]

Take = Callable[[Ints, Keys], None]
"""What is done with pixels and the keys that are offered for them."""

KEY_BITS = 62

SETUP_AT_ONCE = 1 << 16
"""So many triangles are set up at a time."""

SMALL_AT_ONCE = 1 << 15
"""So many triangles are looked for small ones at once: their fragments are all held until it is their turn."""

TILES_AT_ONCE = 1 << 11
"""So many pairs of a triangle and a tile are looked at before the tiles' depths are taken anew."""

LARGE_SIDE = 128
"""From this side on a triangle is large."""

THINNEST = 12.0
"""Subpixels: the depths of thinner triangles are those of their corners wherever these are moved to."""

TILE, SMALL_TILE = 64, 16
"""Sides of the tiles of large and of middling triangles, in pixels."""


@dataclass(frozen=True, eq=False)
class Task:
    """Triangles to be covered. grid (2,n): subpixels; beside (2,n): how far the points are beside these; depths (n,):
    codes before clipping; corners (t,3); sheet (t,): the plane of slopes (3,k) with the codes of a triangle (at the
    first column and row, and their growth), -1 for none, so coplanar triangles have the same codes; first, last:
    smallest and largest of all.
    """

    grid: NDArray[np.int32]
    beside: Floats
    depths: Floats
    corners: Ints
    number_bits: int
    columns: int
    rows: int
    sheet: Ints
    slopes: Floats
    first: float
    last: float

    @cached_property
    def nearest(self) -> Floats:
        """(t,) codes that no fragment of a triangle exceeds by more than one."""
        a, b, c = (self.depths[corner] for corner in self.corners.T)
        found = np.maximum(np.maximum(a, b), c)
        found += (found - np.minimum(np.minimum(a, b), c)) / THINNEST
        return np.where(self.sheet >= 0, self.last, found) if len(self.sheet) else found

    @property
    def stride(self) -> int:
        """Columns, and some more so that the last tile is whole."""
        return -(-self.columns // TILE) * TILE

    @property
    def padded_rows(self) -> int:
        """Rows, and some more so that the last tile is whole."""
        return -(-self.rows // TILE) * TILE


@dataclass(frozen=True, eq=False)
class Planes:
    """Some triangles ready to be covered: number (k,) in the task; the code of the depth at a fragment is
    base + second * rise + third * other_rise, each (k,)."""

    triangles: Snapped
    box: Boxes
    number: Ints
    base: Floats
    rise: Floats
    other_rise: Floats


def front_keys(task: Task, number: Ints) -> Keys:
    """(rows, columns) the largest keys of the triangles with some numbers, 0 where none of them is.

    A key is the code of the depth, shifted by number_bits, plus 2^number_bits - 1 - triangle.
    """
    keys = np.zeros(task.padded_rows * task.stride, dtype=np.int64)

    def keep_largest(pixel: Ints, key: Keys) -> None:
        np.maximum.at(keys, pixel, key)

    _cover(keys, task, number, keep_largest)
    return keys.reshape(-1, task.stride)[: task.rows, : task.columns]


def keys_before(task: Task, number: Ints, opaque: Keys) -> tuple[Ints, Keys]:
    """Every pixel of every triangle with one of some numbers that is closer than what is opaque (rows, columns) there:
    pixel = row * columns + column, and key, each (f,)."""
    padded = np.zeros((task.padded_rows, task.stride), dtype=np.int64)
    padded[: task.rows, : task.columns] = opaque
    keys = padded.reshape(-1)
    pixels, found = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.int64)]

    def collect(pixel: Ints, key: Keys) -> None:
        row, column = np.divmod(pixel, task.stride)
        # Of equal depths, the smaller number.
        closer = (key > keys[pixel]) & (column < task.columns)
        closer &= row < task.rows
        pixels.append((row * task.columns + column)[closer])
        found.append(key[closer])

    _cover(keys, task, number, collect)
    return np.concatenate(pixels), np.concatenate(found)


def _cover(keys: Keys, task: Task, number: Ints, take: Take) -> None:
    """Offer the keys of the triangles with some numbers; keys: those that are in front so far."""
    others = [np.zeros(0, dtype=np.intp)]

    def small_ones(some: slice) -> tuple[Ints, list[tuple[Ints, Keys]]]:
        planes = _planes(task, number[some])
        small = np.flatnonzero(planes.box.small)
        every = pixel_coverage.small_fragments(planes.triangles, planes.box, small, task.stride)
        return planes.number[~planes.box.small], [(found.pixel, _keys(task, planes, found)) for found in every]

    for larger, found in mapped(small_ones, slices(len(number), SMALL_AT_ONCE)):
        others.append(larger)
        for pixel, key in found:
            take(pixel, key)
    _cover_by_tiles(keys, task, np.concatenate(others), take)


def _planes(task: Task, number: Ints) -> Planes:
    """The triangles of some numbers that can cover a pixel of the raster."""
    x, y = pixel_coverage.corner_grid(task.grid, task.corners[number])
    box = pixel_coverage.boxes(x, y, task.columns, task.rows)
    kept = np.flatnonzero((box.left < box.right) & (box.top < box.bottom))
    triangles = pixel_coverage.turned_right(x[:, kept], y[:, kept])
    with_area = np.flatnonzero(triangles.area)
    if len(with_area) < len(kept):
        kept, triangles = kept[with_area], triangles[with_area]
    corner = task.corners[number[kept]].T
    corner[1:] = np.where(triangles.turned, corner[:0:-1], corner[1:])
    first, second, third = _snapped_depths(task, triangles, corner)
    rise, other = (second - first) / triangles.area, (third - first) / triangles.area
    # What the ownership of edges took away from the edge functions comes back here.
    base = first + pixel_coverage.lowered(triangles, 1) * rise + pixel_coverage.lowered(triangles, 2) * other
    return Planes(triangles, box[kept], number[kept], base, rise, other)


def _snapped_depths(task: Task, triangles: Snapped, corner: Ints) -> Floats:
    """(3, t) the depths that the planes of triangles, with vertices corner (3, t), have at their corners on the grid:
    so every pixel has the depth of the true triangle there, however far its corners were moved."""
    depth, (aside, below) = task.depths[corner], task.beside[:, corner]
    u = (triangles.x[1:] - triangles.x[0]) + (aside[1:] - aside[0])
    v = (triangles.y[1:] - triangles.y[0]) + (below[1:] - below[0])
    rise = depth[1:] - depth[0]
    area = u[0] * v[1] - u[1] * v[0]
    longest = np.sqrt(np.maximum((u * u + v * v).max(axis=0), (u[1] - u[0]) ** 2 + (v[1] - v[0]) ** 2))
    wide = np.abs(area) > THINNEST * longest
    share = np.where(wide, 1.0, 0.0) / np.where(wide, area, 1.0)
    by_x, by_y = (rise[0] * v[1] - rise[1] * v[0]) * share, (u[0] * rise[1] - u[1] * rise[0]) * share
    return np.asarray(np.clip(depth - by_x * aside - by_y * below, task.first, task.last))


def _keys(task: Task, planes: Planes, found: Fragments) -> Keys:
    """(f,) the keys of fragments."""
    t = found.triangle
    depth = planes.base.take(t) + found.second * planes.rise.take(t) + found.third * planes.other_rise.take(t)
    if len(task.sheet):
        sheet = task.sheet[planes.number[t]]
        flat = np.flatnonzero(sheet >= 0)
        row, column = np.divmod(found.pixel[flat], task.stride)
        start, by_column, by_row = task.slopes[:, sheet[flat]]
        depth[flat] = np.clip(start + column * by_column + row * by_row, 1.0, task.last)
    key = depth.astype(np.int64)
    key <<= task.number_bits
    key += ((1 << task.number_bits) - 1 - planes.number).take(t)
    return key


def _cover_by_tiles(keys: Keys, task: Task, number: Ints, take: Take) -> None:
    """Offer the keys of triangles that are not small, the nearest first."""
    number = number[np.argsort(-task.nearest[number], kind="stable")]
    for begin in in_turn(range(0, len(number), SETUP_AT_ONCE)):
        planes = _planes(task, number[begin : begin + SETUP_AT_ONCE])
        side = np.maximum(planes.box.right - planes.box.left, planes.box.bottom - planes.box.top)
        _tiles(keys, task, planes, np.flatnonzero(side >= LARGE_SIDE), TILE, take)
        _tiles(keys, task, planes, np.flatnonzero(side < LARGE_SIDE), SMALL_TILE, take)


def _tiles(keys: Keys, task: Task, planes: Planes, chosen: Ints, side: int, take: Take) -> None:
    """Offer the keys of some triangles, tile by tile; tiles in which everything is closer are passed over."""
    count = pixel_coverage.tile_counts(planes.box, chosen, side)
    across = task.stride // side
    # Rows first: along short last axes numpy takes several times as long.
    farthest = keys.reshape(-1, side, across * side).min(axis=1).reshape(-1, side).min(axis=1)
    nearest = task.nearest[planes.number]
    for begin, end in ragged.batches(count, TILES_AT_ONCE):
        index, column, row = pixel_coverage.tile_pairs(planes.box, chosen[begin:end], side)
        tile = row * across + column
        open_ = np.flatnonzero(nearest[index] + 1.0 >= farthest[tile] >> task.number_bits)
        index, left, top, tile = index[open_], column[open_] * side, row[open_] * side, tile[open_]
        met = np.flatnonzero(pixel_coverage.may_cover(planes.triangles, index, left, top, side))
        index, left, top, tile = index[met], left[met], top[met], tile[met]
        step = max(1, pixel_coverage.CANDIDATES // side**2)
        for first in in_turn(range(0, len(index), step)):
            part = slice(first, first + step)
            found = pixel_coverage.covered(
                planes.triangles, index[part], left[part], top[part], (side, side), task.stride, np.int64
            )
            take(found.pixel, _keys(task, planes, found))
        touched = np.unique(tile)
        blocks = keys.reshape(-1, side, across, side)[touched // across, :, touched % across]
        farthest[touched] = blocks.min(axis=(1, 2))


# Depth buffers: for every pixel the triangle in front, found for all triangles at once.
#
# Source: Glaeser, section 7.3; errata G7-04 to G7-07.

FINEST_BITS = 48
"""More bits for the depth than this would be below the rounding of its interpolation."""


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """What is in front in every pixel, and how far.

    code: (rows, columns) codes of the depths, 0 where there is nothing; triangle: (rows, columns) number in triangles,
    -1 where there is nothing; depth_code: what the codes mean; triangles: what the picture is of; top: the row of the
    whole picture that is row 0 here; body: (rows, columns) number of the quadric body in front, -1 where there is none.
    Source: Glaeser, section 7.3.
    """

    code: NDArray[np.int64]
    triangle: NDArray[np.int32]
    depth_code: DepthCode
    triangles: ScreenTriangles
    top: int = 0
    body: NDArray[np.int32] | None = None

    @property
    def depth(self) -> Floats:
        """(rows, columns) depths after T2, larger = closer; -inf where there is nothing."""
        return np.asarray(np.where(self.code > 0, self.depth_code.depth(self.code), -np.inf))

    @property
    def source(self) -> Ints:
        """(rows, columns) the triangles as they were before clipping, -1 where there is nothing."""
        before = np.append(self.triangles.source, -1)
        return np.asarray(before[self.triangle])


def depth_range(triangles: ScreenTriangles) -> tuple[float, float]:
    """The smallest and the largest depth of the corners.

    result: (float, float) points that are no corners do not count.
    Edge cases: (0, 0) without triangles.
    """
    depth = triangles.points[_used(triangles), 2]
    return (float(depth.min()), float(depth.max())) if len(depth) else (0.0, 0.0)


def _used(triangles: ScreenTriangles) -> Bools:
    used = np.zeros(len(triangles.points), dtype=np.bool_)
    used[triangles.corners] = True
    return used


def depth_buffer(
    triangles: ScreenTriangles, columns: int, rows: int, *, depth_code: DepthCode | None = None
) -> DepthBuffer:
    """The depth buffer of a picture.

    Parameters
    ----------
    triangles : ScreenTriangles
        What the picture is of.
    columns, rows : int
        Its size in pixels.
    depth_code : DepthCode, optional
        How depths become whole numbers; the finest there is room for where None.

    Returns
    -------
    DepthBuffer
        The triangle in front in every pixel, and its depth.

    Raises
    ------
    InputError
        For a raster too large, for depths outside the code's range, and for a code too fine for so many triangles.

    Notes
    -----
    Triangles with a common edge leave no gap and share no pixel. Edge cases: no triangles leave it empty; triangles
    without area cover nothing.

    Source: Glaeser, section 7.3.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> camera = vp.Camera((0, 0, 5), up=(0, 1, 0), parallel=True, height=8.0)
    >>> system = shading.raster_system(camera, 8, 8)
    >>> corners = [(-4, -4, 0), (4, -4, 0), (4, 4, 0)]
    >>> half = shading.screen_triangles(system.homogeneous(corners), [(0, 1, 2)])
    >>> buffer = shading.depth_buffer(half, 8, 8)
    >>> (buffer.triangle >= 0).sum(axis=1).tolist()
    [1, 2, 3, 4, 5, 6, 7, 8]
    """
    return strip(triangles, columns, rows, 0, rows, depth_code=depth_code)


def strips(
    triangles: ScreenTriangles, columns: int, rows: int, count: int, *, depth_code: DepthCode | None = None
) -> Iterator[DepthBuffer]:
    """The picture in horizontal strips from the top, one after the other, to save memory: together they are the same as
    one. Source: Glaeser, section 7.3."""
    if not 1 <= count <= rows:
        raise InputError(f"{rows} rows cannot be divided into {count} strips")
    borders = [rows * k // count for k in range(count + 1)]
    for top, bottom in pairwise(borders):
        yield strip(triangles, columns, rows, top, bottom, depth_code=depth_code)


def strip(
    triangles: ScreenTriangles,
    columns: int,
    rows: int,
    top: int,
    bottom: int,
    *,
    depth_code: DepthCode | None = None,
    chosen: Bools | None = None,
) -> DepthBuffer:
    """The depth buffer of the rows top to bottom (exclusive) of a picture; chosen (t,): only some of the triangles."""
    columns, rows = raster_size(columns, rows)
    if not 0 <= top < bottom <= rows:
        raise InputError(f"rows {top} to {bottom} are no strip of a picture of {rows} rows")
    code = finest_code(triangles) if depth_code is None else depth_code
    task = _task(triangles, code, columns, top, bottom)
    keys = front_keys(task, np.arange(len(triangles)) if chosen is None else np.flatnonzero(chosen))
    return DepthBuffer(keys >> task.number_bits, _numbers(keys, task.number_bits), code, triangles, top)


def depth_codes(triangles: ScreenTriangles, columns: int, rows: int) -> tuple[NDArray[np.int64], DepthCode]:
    """(rows, columns) the codes of a depth buffer alone, 0 where there is nothing, and what they mean."""
    columns, rows = raster_size(columns, rows)
    code = finest_code(triangles)
    task = _task(triangles, code, columns, 0, rows)
    return front_keys(task, np.arange(len(triangles))) >> task.number_bits, code


def layers_before(buffer: DepthBuffer, chosen: Bools) -> tuple[Ints, Ints, NDArray[np.int64]]:
    """What one can see through before a buffer: for every pixel of every chosen triangle (t,) that is closer than what
    the buffer holds there pixel, triangle and code of the depth, each (f,). Within a pixel the farthest come first."""
    rows, columns = buffer.code.shape
    task = _task(buffer.triangles, buffer.depth_code, columns, buffer.top, buffer.top + rows)
    mask = (1 << task.number_bits) - 1
    opaque = np.where(buffer.code > 0, (buffer.code << task.number_bits) + mask - buffer.triangle, 0)
    pixel, key = keys_before(task, np.flatnonzero(chosen), opaque)
    order = np.lexsort((key, pixel))
    pixel, key = pixel[order], key[order]
    return pixel, np.asarray(mask - (key & mask), dtype=np.intp), key >> task.number_bits


def finest_code(triangles: ScreenTriangles, others: tuple[float, float] = (np.inf, -np.inf)) -> DepthCode:
    """The finest code of the depths of triangles, and of others between two limits, that there is room for."""
    low, high = depth_range(triangles)
    if others[0] <= others[1]:
        low, high = (min(low, others[0]), max(high, others[1])) if len(triangles) else others
    margin = (high - low) / THINNEST
    bits = min(KEY_BITS - len(triangles).bit_length(), FINEST_BITS)
    return DepthCode.fine(low - margin, high + margin, bits)


def _task(triangles: ScreenTriangles, depth_code: DepthCode, columns: int, top: int, bottom: int) -> Task:
    bits, first = len(triangles).bit_length(), depth_code.first
    last = first + depth_code.steps
    if not last < 2.0 ** (KEY_BITS - bits):
        raise InputError(
            f"depths in {depth_code.steps:g} steps leave no room for the numbers of {len(triangles)} triangles"
        )
    used = _used(triangles)
    depths = np.zeros(len(used))
    depths[used] = depth_code.scaled(triangles.points[used, 2])
    grid = pixel_coverage.snap(triangles.points)
    beside = triangles.points[:, :2].T * float(pixel_coverage.SUBPIXELS) - grid
    grid[1] -= top << pixel_coverage.SUBPIXEL_BITS
    sheet, slopes = np.zeros(0, dtype=np.intp), np.zeros((3, 0))
    if triangles.sheet is not None and triangles.slopes is not None:
        start, by_column, by_row = triangles.slopes
        sheet = triangles.sheet
        slopes = np.stack(
            [depth_code.of_any(start + top * by_row), *(depth_code.rate * by for by in (by_column, by_row))]
        )
    return Task(grid, beside, depths, triangles.corners, bits, columns, bottom - top, sheet, slopes, first, last)


def _numbers(keys: NDArray[np.int64], bits: int) -> NDArray[np.int32]:
    mask = (1 << bits) - 1
    numbers = (~keys & mask).astype(np.int32)
    numbers[keys == 0] = -1
    return numbers


# Faces that lie in one plane, and which of them is seen: the one that paint paints last.

SAME_NORMAL, SAME_DISTANCE = 4.0 * ZERO_OF_EXTENT, ZERO_OF_EXTENT
"""Unit normals, coordinate by coordinate, and distances of planes that differ by less, in the unit box, are those of
one plane: paint tells apart what is farther apart."""


@dataclass(frozen=True, eq=False)
class CoplanarFaces:
    """plane (f,): which plane faces share with others, -1 for those that lie alone in theirs; rank (f,): of those in
    one plane the larger number is seen."""

    plane: Ints
    rank: Ints


def coplanar_faces(view: View) -> CoplanarFaces:
    """The faces of a view that share a plane with others, and which of them is seen where they overlap: the smaller one
    in the image, as paint has it. Edge cases: faces without area, and those seen edge-on, have no rank."""
    plane = _planes_of_faces(view)
    rank = np.full(view.face_count, -1, dtype=np.intp)
    shared = np.flatnonzero(plane >= 0)
    if len(shared):
        found = image_faces(view, shared)
        rank[found.source] = found.rank
    return CoplanarFaces(plane, rank)


def ranked(
    triangles: ScreenTriangles,
    scene: SceneTriangles,
    homogeneous: Floats,
    coplanar: CoplanarFaces,
    eye: tuple[float, float, float, float],
    outer_side: Ints,
) -> ScreenTriangles:
    """Triangles of a scene in pixels, those in one plane at exactly the same depths and, for the sake of equal depths,
    those first that are seen; homogeneous (n, 4): the points of the scene there; eye: where one looks from, in the
    scene's own space; outer_side (i,): 1 and -1 for items of which only the outside is seen."""
    may_stop()
    face = scene.face[triangles.source]
    shared = np.flatnonzero(coplanar.plane[face] >= 0)
    if not len(shared):
        return triangles
    source = triangles.source[shared]
    side = outer_side[scene.item[source]]
    outside = (side == 0) | (front_facing(scene.points, scene.corners[source], eye) == (side > 0))
    order = np.arange(len(triangles))
    # Triangles that lie alone keep their places: no depth of theirs is exactly that of others.
    order[shared] = shared[np.lexsort((-coplanar.rank[face[shared]], ~outside))]
    sheet = np.full(len(triangles), -1, dtype=np.intp)
    names, sheet[shared] = np.unique(coplanar.plane[face[shared]], return_inverse=True)
    may_stop()
    slopes, flat = _depth_planes(scene, homogeneous, coplanar, names)
    sheet[shared] = np.where(flat[sheet[shared]], sheet[shared], -1)
    corners, source = triangles.corners[order], triangles.source[order]
    return replace(triangles, corners=corners, source=source, sheet=sheet[order], slopes=slopes)


def _planes_of_faces(view: View) -> Ints:
    """(f,) numbers of planes that several faces lie in, -1 for other faces."""
    may_stop()
    count = view.face_count
    plane = np.full(count, -1, dtype=np.intp)
    if count < 2:
        return plane
    normal = face_normals(view)
    first = view.points[:, view.corners[view.offsets[:-1]]]
    rows = np.concatenate([normal, (normal * first).sum(axis=0)[None]])
    # Both sides of a plane are the same plane.
    largest = np.take_along_axis(normal, np.abs(np.round(normal, 6)).argmax(axis=0)[None], axis=0)[0]
    rows *= np.where(largest < 0.0, -1.0, 1.0)
    here = np.flatnonzero(largest != 0.0)
    label = np.zeros(len(here), dtype=np.intp)
    for row, same in in_turn(zip(rows[::-1], (SAME_DISTANCE, *[SAME_NORMAL] * 3), strict=True)):
        along = row[here]
        order = np.lexsort((along, label))
        new = (np.diff(label[order], prepend=-1) != 0) | (np.diff(along[order], prepend=-np.inf) > same)
        group = np.cumsum(new) - 1
        several = np.bincount(group)[group] > 1
        here, label = here[order[several]], group[several]
    plane[here] = label
    return plane


def _depth_planes(
    scene: SceneTriangles, homogeneous: Floats, coplanar: CoplanarFaces, names: Ints
) -> tuple[Floats, Bools]:
    """(3, k) the depth at column 0 and row 0 of planes (k,), and how it grows with column and row; and (k,) which of
    them are not seen edge-on. Each is that of its largest triangle."""
    may_stop()
    a, b, c = (scene.points[scene.corners[:, k]] for k in range(3))
    number = coplanar.plane[scene.face]
    own = np.flatnonzero(np.isin(number, names))
    area = np.linalg.norm(np.cross(b[own] - a[own], c[own] - a[own]), axis=1)
    may_stop()
    order = own[np.lexsort((own, -area, number[own]))]
    leader = order[np.unique(number[order], return_index=True)[1]]
    p, q, r = (homogeneous[scene.corners[leader, k]] for k in range(3))
    rows = np.stack([p, q, r], axis=1)
    # The plane through three homogeneous points: the minors of their coordinates.
    plane = np.stack([(-1) ** k * determinant(np.delete(rows, k, axis=2)) for k in range(4)], axis=1)
    x, y, z, w = plane.T
    steep = np.abs(z) > ZERO_OF_EXTENT * np.abs(plane).max(axis=1)
    z = np.where(steep, z, 1.0)
    return np.stack([-w / z, -x / z, -y / z]), steep
