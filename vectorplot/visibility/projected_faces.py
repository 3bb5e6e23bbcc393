"""Faces in the image: which side they show, and the box each one fills; closed bodies, of which only that is seen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_pairs
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.weld import distinct_points
from vectorplot.geometry.winding import components, edge_uses, inside_out, signed_volumes, turned_faces
from vectorplot.scene.view import View
from vectorplot.tolerances import LEAST_DIVISOR, SINGLE_BOX_LEAST, SINGLE_BOX_SHARE

Floats32 = NDArray[np.float32]
Bytes = NDArray[np.int8]

CHUNK = 1 << 16
"""Faces handled at once: few enough for the processor's cache."""

EVERYWHERE = np.float32(1e30)


@dataclass(frozen=True, eq=False)
class ProjectedFaces:
    """Faces in the image: which side they show, and the box each one fills.

    view: whose faces they are; facing: (f,) 1 for a face that shows its outside, -1 its inside, 0 edge-on: then it
    hides nothing; box: (4, f) smallest and largest x, smallest and largest y in the image, rounded outwards; nearest:
    (f,) the smallest depth.
    """

    view: View
    facing: Bytes
    box: Floats32
    nearest: Floats32

    def __len__(self) -> int:
        return len(self.facing)

    @cached_property
    def sides(self) -> Ints:
        """(i,) the sides of closed items from which they are seen, as of body_sides."""
        return body_sides(self.view)


def project_faces(view: View) -> ProjectedFaces:
    """The faces of a view in the image.

    view: see scene.look; result: one entry for each face of the view.
    A face is edge-on where its image is narrower than the view's tolerance.
    Source: Glaeser, section 5.1 (backfaces and frontfaces).
    """
    count = view.face_count
    faces = ProjectedFaces(
        view, np.empty(count, np.int8), np.empty((4, count), np.float32), np.empty(count, np.float32)
    )
    x, y = view.image
    depth = view.depth
    stages = _triangles if view.is_triangular else _polygons

    def project(block: slice) -> None:
        stages(view, faces, x, y, depth, block.start, block.stop)

    for _ in mapped(project, slices(count, CHUNK)):
        pass
    _through_near_plane(view, faces)
    return faces


def _store(
    faces: ProjectedFaces, low: int, high: int, box: list[Floats], nearest: Floats, area: Floats, tol: float
) -> None:
    left, right, bottom, top = box
    size = np.maximum(right - left, top - bottom)
    faces.facing[low:high] = (area > tol * size).astype(np.int8) - (area < -tol * size).astype(np.int8)
    for row, value in enumerate(box):
        _rounded(value, np.add if row % 2 else np.subtract, faces.box[row, low:high])
    _rounded(nearest, np.subtract, faces.nearest[low:high])


def _rounded(value: Floats, outwards: np.ufunc, out: Floats32) -> None:
    """Put values into single precision, moved up (add) or down (subtract) by a little more than its steps."""
    out[:] = value
    step = np.abs(out)
    step *= np.float32(SINGLE_BOX_SHARE)
    step += np.float32(SINGLE_BOX_LEAST)
    outwards(out, step, out=out)


def _triangles(view: View, faces: ProjectedFaces, x: Floats, y: Floats, depth: Floats, low: int, high: int) -> None:
    a, b, c = np.ascontiguousarray(view.corners[3 * low : 3 * high].reshape(-1, 3).T)
    xa, xb, xc = x[a], x[b], x[c]
    ya, yb, yc = y[a], y[b], y[c]
    area = (xb - xa) * (yc - ya) - (xc - xa) * (yb - ya)
    box = [
        np.minimum(np.minimum(xa, xb), xc),
        np.maximum(np.maximum(xa, xb), xc),
        np.minimum(np.minimum(ya, yb), yc),
        np.maximum(np.maximum(ya, yb), yc),
    ]
    nearest = np.minimum(np.minimum(depth[a], depth[b]), depth[c])
    _store(faces, low, high, box, nearest, area, view.tolerance)


def _polygons(view: View, faces: ProjectedFaces, x: Floats, y: Floats, depth: Floats, low: int, high: int) -> None:
    first, last = view.offsets[low], view.offsets[high]
    starts = view.offsets[low:high] - first
    px, py = x[view.corners[first:last]], y[view.corners[first:last]]
    following = view.after(np.arange(first, last)) - first
    owner = ragged.owner(view.face_sizes[low:high])
    rx, ry = px - px[starts][owner], py - py[starts][owner]
    area = np.add.reduceat(rx * ry[following] - rx[following] * ry, starts)
    box = [
        np.minimum.reduceat(px, starts),
        np.maximum.reduceat(px, starts),
        np.minimum.reduceat(py, starts),
        np.maximum.reduceat(py, starts),
    ]
    nearest = np.minimum.reduceat(depth[view.corners[first:last]], starts)
    _store(faces, low, high, box, nearest, area, view.tolerance)


def _through_near_plane(view: View, faces: ProjectedFaces) -> None:
    """Faces with corners behind the near plane: their images are no polygons, so decide in space."""
    if view.eye is None or not (behind := view.depth < view.near).any():
        return
    corner_behind = behind[view.corners]
    some = np.logical_or.reduceat(corner_behind, view.offsets[:-1])
    every = np.logical_and.reduceat(corner_behind, view.offsets[:-1])
    touched = np.flatnonzero(some)
    if not len(touched):
        return
    normal, arm_length, first = newell(view, touched)
    toward = view.eye[:, None] - view.points.take(first, axis=1)
    distance = np.sqrt((toward * toward).sum(axis=0))
    area = (normal * toward).sum(axis=0)
    limit = view.tolerance * arm_length * np.maximum(distance, view.tolerance)
    faces.facing[touched] = np.where(np.abs(area) <= limit, 0, np.sign(area)).astype(np.int8)
    faces.box[:, touched] = np.array([[-EVERYWHERE], [EVERYWHERE], [-EVERYWHERE], [EVERYWHERE]])
    faces.nearest[touched] = np.where(every[touched], np.inf, 0.0)


def newell(view: View, faces: Ints) -> tuple[Floats, Floats, Ints]:
    """Area vectors (3,n) of some faces, the length of the longest arm from their first corner, and that corner."""
    start, size = view.offsets[faces], view.face_sizes[faces]
    first = view.corners[start]
    a = view.points.take(first, axis=1)
    before = view.points.take(view.corners[start + 1], axis=1) - a
    normal, longest = np.zeros_like(a), _square(before)
    for step in range(2, int(size.max(initial=0))):
        # Where a face has no such corner the arm stays, and adds nothing.
        arm = view.points.take(view.corners[start + np.minimum(step, size - 1)], axis=1) - a
        normal += cross(before, arm)
        longest = np.maximum(longest, _square(arm))
        before = arm
    return normal, np.sqrt(longest), first


def _square(a: Floats) -> Floats:
    return np.asarray(a[0] * a[0] + a[1] * a[1] + a[2] * a[2], dtype=np.float64)


# Closed bodies that do not cross themselves: of them only the outside can be seen.

ONE_PLACE = 64.0
"""Corners in one cell of so many tolerances are in one place."""

AXIS_SHIFT = 16.0
"""The extent of a view is less: items that are moved apart by multiples of it do not meet."""


def closed_items(view: View) -> Bools:
    """(i,) the items whose faces close, wound alike."""
    closed = np.ones(len(view.item_vertices) - 1, dtype=np.bool_)
    loose = np.flatnonzero(unbalanced_vertices(view.points.shape[1], view.corners, view.offsets))
    closed[np.searchsorted(view.item_vertices, loose, side="right") - 1] = False
    return closed


def body_sides(view: View) -> Ints:
    """(i,) 1 for items that close, do not cross themselves and are wound counter-clockwise as seen from outside, -1 for
    such that are wound the other way round, 0 for all others, both sides of whose faces can be seen.

    A body without crossings keeps its inside on one side everywhere; pieces of it that are wound against the others are
    cavities, or else it counts as crossing itself. Faces of different pieces that touch, and such of one piece that
    touch without sharing a corner, and in more than one, cross.
    """
    side = np.zeros(len(view.item_vertices) - 1, dtype=np.intp)
    face = np.flatnonzero(closed_items(view)[view.face_item])
    if not len(face):
        return side
    position, offsets = ragged.take(view.offsets, face)
    body = Mesh(np.ascontiguousarray(view.points.T), view.corners[position], offsets)
    item = view.face_item[face]
    sixfold = np.bincount(item, signed_volumes(body), minlength=len(side))
    side[:] = np.sign(sixfold)
    upright = turned_faces(body, sixfold[item] < 0.0)
    may_stop()
    number, piece = components(upright, edge_uses(upright))
    volume = np.bincount(piece, signed_volumes(upright), minlength=number)
    # One at a time: cavities lie in pieces of their own item.
    for one in np.unique(item[volume[piece] < 0.0]).tolist():
        own = np.flatnonzero(item == one)
        position, ends = ragged.take(upright.offsets, own)
        alone = Mesh(upright.vertices, upright.corners[position], ends)
        which, number_of = np.unique(piece[own], return_inverse=True)
        if inside_out(alone, number_of.ravel(), len(which)).any():
            side[one] = 0
    side[crossing_items(view, face[side[item] != 0])] = 0
    return side


def crossing_items(view: View, face: Ints) -> Ints:
    """The items of which some faces (n,) meet others of the same item with which they share no corner, nor have one in
    one place alone, as at an apex."""
    may_stop()
    position, offsets = ragged.take(view.offsets, face)
    fans, of = ragged.fans(offsets)
    triangles = view.corners[position[fans]]
    may_stop()
    steps = np.round(view.points / (ONE_PLACE * view.tolerance))
    place = distinct_points(np.ascontiguousarray(steps.T))[1][triangles]
    may_stop()
    wide = np.flatnonzero((place != np.roll(place, 1, axis=1)).all(axis=1))
    triangles, place, of = triangles[wide], place[wide], of[wide]
    item = view.face_item[face[of]]
    left = ~_star_shaped(view, triangles, item)[item]
    triangles, place, of, item = triangles[left], place[left], of[left], item[left]
    may_stop()
    points = view.points[:, triangles]
    shift = np.zeros((3, len(item)))
    shift[0] = AXIS_SHIFT * item
    low, high = points.min(axis=2) + shift - view.tolerance, points.max(axis=2) + shift + view.tolerance
    one, two = overlapping_pairs(low, high)
    found = np.zeros(len(view.item_vertices) - 1, dtype=np.bool_)
    for some in in_turn(slices(len(one), PAIRS_AT_ONCE)):
        a, b = one[some], two[some]
        kept, common = ~found[item[a]] & (of[a] != of[b]), np.zeros(len(a), dtype=np.intp)
        for k in range(3):
            for m in range(3):
                kept &= triangles[a, k] != triangles[b, m]
                common += place[a, k] == place[b, m]
        kept &= common != 1
        a, b = a[kept], b[kept]
        met = _meet(points[:, a], points[:, b], view.tolerance)
        found[item[a[met]]] = True
    return np.flatnonzero(found)


def _star_shaped(view: View, triangles: Ints, item: Ints) -> Bools:
    """(i,) which closed items with triangles (n,3), of items (n,), are seen whole from their middle, so that they never
    cross themselves: the planes of all triangles leave it, by more than a tolerance, on one side, and a ray from there
    meets one of them, as all rays then do, for how many are met never changes.

    Source: Preparata and Shamos, Computational Geometry (1985): star-shaped polygons and their kernels.
    """
    count, batches = len(view.item_vertices) - 1, slices(len(item), PAIRS_AT_ONCE)
    size = np.maximum(np.bincount(item, minlength=count), 1)
    corners = np.zeros((3, count))
    for batch in in_turn(batches):
        mean = view.points[:, triangles[batch]].mean(axis=2)
        corners += [np.bincount(item[batch], along, minlength=count) for along in mean]
    middle, height = corners / size, np.empty(len(item))
    for batch in in_turn(batches):
        a, b, c = np.moveaxis(view.points[:, triangles[batch]] - middle[:, item[batch], None], 2, 0)
        normal = cross(b - a, c - a)
        height[batch] = dot(a, normal) / np.maximum(np.sqrt(dot(normal, normal)), LEAST_DIVISOR)
    side = np.sign(np.bincount(item, height, minlength=count))
    aside = np.bincount(item, side[item] * height <= view.tolerance, minlength=count)
    number, first = np.unique(item, return_index=True)
    ray, met = np.zeros((3, count)), np.zeros(count)
    ray[:, number] = view.points[:, triangles[first]].sum(axis=2) - 3.0 * middle[:, number]
    for batch in in_turn(batches):
        a, b, c = np.moveaxis(view.points[:, triangles[batch]] - middle[:, item[batch], None], 2, 0)
        turned = side[item[batch]]
        within = [turned * dot(ray[:, item[batch]], cross(*two)) >= 0.0 for two in ((a, b), (b, c), (c, a))]
        met += np.bincount(item[batch], np.logical_and.reduce(within), minlength=count)
    return np.asarray((aside == 0) & (met == 1), dtype=np.bool_)


def _meet(one: Floats, two: Floats, tolerance: float) -> Ints:
    """Which pairs of triangles (3,n,3) no plane keeps apart by more than a tolerance: none that is parallel to one of
    both, nor to an edge of each.

    Source: Gottschalk, Lin, Manocha, OBBTree (1996): separating axes of convex polyhedra.
    """
    left = np.arange(one.shape[1])
    edges = [[shape[:, :, (k + 1) % 3] - shape[:, :, k] for k in range(3)] for shape in (one, two)]
    axes = [(edges[0][0], edges[0][1]), (edges[1][0], edges[1][1])]
    axes += [(along, across) for along in edges[0] for across in edges[1]]
    normals = [cross(*axes[0]), cross(*axes[1])]
    for along, across in axes:
        left = left[~_apart(one, two, left, cross(along[:, left], across[:, left]), tolerance)]
    # Of triangles in one plane: what is across their edges.
    for shape, normal in zip(edges, normals, strict=True):
        for edge in shape:
            left = left[~_apart(one, two, left, cross(edge[:, left], normal[:, left]), tolerance)]
    return left


def _apart(one: Floats, two: Floats, which: Ints, axis: Floats, tolerance: float) -> Bools:
    """(k,) whether pairs of triangles leave a gap along axes (3,k)."""
    gap = tolerance * np.sqrt(dot(axis, axis))
    first, second = (np.stack([dot(axis, shape[:, which, k]) for k in range(3)]) for shape in (one, two))
    below, above = first.max(axis=0) + gap < second.min(axis=0), second.max(axis=0) + gap < first.min(axis=0)
    return np.asarray(below | above)
