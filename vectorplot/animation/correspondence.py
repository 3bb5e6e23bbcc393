"""Strokes in correspondence from frame to frame of a film, and one fit to the page for all frames."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Layer, Paths
from vectorplot.drawing.strokes import directed, swapped, unrolled, world_per_mm
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import joined, take, with_points
from vectorplot.geometry.projections import projection_of
from vectorplot.geometry.vectors import cross
from vectorplot.scene.extent import GRID, smooth_bounds
from vectorplot.scene.page import Page
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import is_parametrised
from vectorplot.tolerances import COINCIDENT_MM

# Strokes in correspondence from frame to frame: the same order, and the same ends first.


def corresponding(drawing: Drawing, scene: Scene) -> Drawing:
    """The drawing with the strokes of each layer in an order that does not depend on the eye: by item, kind,
    visibility, and the item's vertices nearest to their ends. A stroke begins at the end, a loop at the corner, that
    comes first among these.
    Where three or more lines of a layer meet in a vertex all of them end there, since which two a pen would join
    depends on the picture. The pen order is lost. Closed curves keep their start and run counter-clockwise.
    """
    nearest = _Nearest(drawing, scene)
    layers = []
    for layer in drawing.layers:
        marks = [_sorted(mark, nearest) if isinstance(mark, Paths | CurvedStrokes) else mark for mark in layer.marks]
        layers.append(Layer(layer.name, layer.pen, tuple(marks), layer.plotted))
    return replace(drawing, layers=tuple(layers))


class _Nearest:
    """Which vertex of its item each point is nearest to: items move, their vertices keep their numbers."""

    def __init__(self, drawing: Drawing, scene: Scene) -> None:
        meshes = {item.name: item.mesh for item in reversed(scene.items)}
        self.vertices = [meshes[name].vertices if name in meshes else np.zeros((0, 3)) for name in drawing.items]
        self.trees: dict[int, Any] = {}

    def vertex(self, points: Floats, item: Ints) -> tuple[Ints, Floats]:
        """(n,) numbers and (n,) distances; of items without vertices 0 and the height, then the width."""
        number = np.zeros(len(points), dtype=np.intp)
        far = points[:, 2].copy() if len(points) else np.zeros(0)
        for which in np.unique(item).tolist():
            tree = self._tree(which)
            if tree is not None:
                here = np.flatnonzero(item == which)
                far[here], number[here] = tree.query(points[here])
        return number, far

    def known(self, item: Ints) -> Bools:
        """(n,) whether items have vertices."""
        has = np.array([len(vertices) > 0 for vertices in self.vertices] + [False], dtype=np.bool_)
        return np.asarray(has[np.clip(item, -1, len(has) - 1)], dtype=np.bool_)

    def _tree(self, item: int) -> Any:
        from scipy.spatial import KDTree

        if item not in self.trees:
            vertices = self.vertices[item] if 0 <= item < len(self.vertices) else np.zeros((0, 3))
            self.trees[item] = KDTree(vertices) if len(vertices) else None
        return self.trees[item]


def _sorted(mark: Paths | CurvedStrokes, nearest: _Nearest) -> Paths | CurvedStrokes:
    """The strokes in their order; polylines turned as well."""
    paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
    if not len(paths):
        return mark
    if isinstance(mark, Paths):
        paths = _cut_at_junctions(paths, nearest)
        number, far = nearest.vertex(paths.points3d, np.repeat(paths.item, np.diff(paths.offsets)))
        index, backwards = _ways(paths, number, far)
        turned = with_points(paths, index, np.arange(len(paths)), paths.offsets)
        directions, handles = directed(turned.directions, backwards), swapped(turned.handles, backwards)
        paths, number, far = replace(turned, directions=directions, handles=handles), number[index], far[index]
    else:
        mark = _turned(mark, nearest)
        paths = mark.paths
        number, far = nearest.vertex(paths.points3d, np.repeat(paths.item, np.diff(paths.offsets)))
    first, last = paths.offsets[:-1], paths.offsets[1:] - 1
    keys = (far[first], number[last], number[first], paths.curve, paths.hidden_by > 0, paths.kind, paths.item)
    rank = np.lexsort(keys)
    found = take(paths, rank)
    if isinstance(mark, Paths):
        return found
    place = np.empty(len(rank), dtype=np.intp)
    place[rank] = np.arange(len(rank))
    arcs = replace(mark.arcs, stroke=place[mark.arcs.stroke])
    return CurvedStrokes(found, take(mark.beziers, rank), arcs.take(np.argsort(arcs.stroke, kind="stable")))


def _turned(mark: CurvedStrokes, nearest: _Nearest) -> CurvedStrokes:
    """The strokes with all that draws them, each in the sense that does not depend on how a pen came to it."""
    paths = mark.paths
    number, far = nearest.vertex(paths.points3d, np.repeat(paths.item, np.diff(paths.offsets)))
    begin, last = paths.offsets[:-1], paths.offsets[1:] - 1
    later = (number[last] < number[begin]) | ((number[last] == number[begin]) & (far[last] < far[begin]))
    back = np.asarray(np.where(paths.closed, _clockwise(paths), later), dtype=np.bool_)
    index, backwards = _run(paths.offsets, back, paths.closed)
    turned = with_points(paths, index, np.arange(len(paths)), paths.offsets)
    directions, handles = directed(turned.directions, backwards), swapped(turned.handles, backwards)
    # Of segments, closed or not, the last one becomes the first.
    segment, other_way = _run(mark.beziers.offsets, back, np.zeros(len(back), dtype=np.bool_))
    control = mark.beziers.control[segment]
    control = np.where(other_way[:, None, None], control[:, ::-1], control)
    arcs, swap = mark.arcs, back[mark.arcs.stroke]
    start, end = np.where(swap, arcs.end, arcs.start), np.where(swap, arcs.start, arcs.end)
    return CurvedStrokes(
        replace(turned, directions=directions, handles=handles),
        replace(mark.beziers, control=control),
        replace(arcs, start=start, end=end),
    )


def _run(offsets: Ints, back: Bools, closed: Bools) -> tuple[Ints, Bools]:
    """(p,) rows of groups, those of groups that run back in reverse, of closed ones behind the first; (p,) whether."""
    count, owner = np.diff(offsets), ragged.owner(np.diff(offsets))
    local = ragged.place(count)
    start = np.where(closed, 0, count - 1)[owner]
    index = offsets[:-1][owner] + np.where(back[owner], (start - local) % np.maximum(count[owner], 1), local)
    return index, back[owner]


def _clockwise(paths: Paths) -> Bools:
    """(m,) whether strokes, closed by a straight line, run round a negative area on the page."""
    owner, begin = ragged.owner(np.diff(paths.offsets)), paths.offsets[:-1]
    after = np.arange(1, len(owner) + 1)
    after[paths.offsets[1:] - 1] = begin
    # About their first points: the area is that of small numbers.
    here = paths.points - paths.points[begin][owner]
    there = paths.points[after] - paths.points[begin][owner]
    twice = cross(here, there)
    return np.asarray(np.bincount(owner, twice, len(begin)) < 0.0, dtype=np.bool_)


def _cut_at_junctions(paths: Paths, nearest: _Nearest) -> Paths:
    """The strokes, cut in the vertices where three segments or more meet that are on one layer."""
    cut = _junctions(paths, nearest)
    owner = ragged.owner(np.diff(paths.offsets))
    round_ = np.zeros(len(paths), dtype=np.bool_)
    round_[owner[cut]] = True
    round_ &= paths.closed
    if round_.any():
        some_cut = np.flatnonzero(cut)
        begin = some_cut[np.searchsorted(some_cut, paths.offsets[:-1]) % max(len(some_cut), 1)] - paths.offsets[:-1]
        loops = take(unrolled(paths, np.where(round_, begin, 0), round_.astype(np.intp)), round_)
        paths = joined([take(paths, ~round_), loops])
        cut = _junctions(paths, nearest)
    ends = np.zeros(len(cut), dtype=np.bool_)
    ends[paths.offsets[:-1]] = ends[paths.offsets[1:] - 1] = True
    cut &= ~ends
    index = np.repeat(np.arange(len(cut)), 1 + cut)
    first = np.zeros(len(index), dtype=np.bool_)
    where = ragged.starts(1 + cut)
    first[where[paths.offsets[:-1]]] = True
    first[where[cut] + 1] = True
    offsets = np.append(np.flatnonzero(first), len(index))
    which = ragged.owner(np.diff(paths.offsets))[index[first]]
    return with_points(paths, index, which, offsets)


def _junctions(paths: Paths, nearest: _Nearest) -> Bools:
    """(p,) the points in vertices of their items where three segments or more meet."""
    sizes = np.diff(paths.offsets)
    item = np.repeat(paths.item, sizes)
    number, far = nearest.vertex(paths.points3d, item)
    degree = np.full(len(number), 2)
    open_ = ~paths.closed
    degree[paths.offsets[:-1][open_]] = degree[paths.offsets[1:][open_] - 1] = 1
    at = np.flatnonzero(nearest.known(item) & (far <= COINCIDENT_MM * world_per_mm(paths)))
    _, place = np.unique(np.stack([item[at], number[at]]), axis=1, return_inverse=True)
    place = place.reshape(-1)
    found = np.zeros(len(number), dtype=np.bool_)
    found[at] = np.bincount(place, degree[at])[place] > 2 if len(at) else False
    return found


def _ways(paths: Paths, number: Ints, far: Floats) -> tuple[Ints, Bools]:
    """(p,) the points of strokes in the order in which they are run through: from the end that comes first, of loops
    from the corner that does, towards that of its neighbours that does; (p,) whether that is backwards."""
    count, owner = np.diff(paths.offsets), ragged.owner(np.diff(paths.offsets))
    begin, local = paths.offsets[:-1], ragged.place(np.diff(paths.offsets))
    order = np.lexsort((far, number, owner))
    least = order[begin] - begin
    last = np.maximum(count - 1, 0)

    def comes_first(one: Ints, other: Ints) -> Bools:
        a, b = begin + one % np.maximum(count, 1), begin + other % np.maximum(count, 1)
        return np.asarray((number[a] < number[b]) | ((number[a] == number[b]) & (far[a] < far[b])), dtype=np.bool_)

    back = np.where(paths.closed, comes_first(least - 1, least + 1), comes_first(last, 0 * last))
    start = np.where(paths.closed, least, np.where(back, last, 0))
    step = np.where(back, -1, 1)
    index = begin[owner] + (start[owner] + step[owner] * local) % np.maximum(count[owner], 1)
    return index, back[owner]


# One fit for a whole film: so that the picture neither jumps nor grows from frame to frame, unless the camera does.

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

    views: the scene and the camera of each frame. Edge cases: where one of them reaches behind the eye, or too far off
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
