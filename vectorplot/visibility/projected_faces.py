"""Faces in the image: which side they show, and the box each one fills."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import cross
from vectorplot.scene.view import View
from vectorplot.tolerances import SINGLE_BOX_LEAST, SINGLE_BOX_SHARE

Floats32 = NDArray[np.float32]
Bytes = NDArray[np.int8]

CHUNK = 1 << 16
"""Faces handled at once: few enough for the processor's cache."""

EVERYWHERE = np.float32(1e30)


@dataclass(frozen=True, eq=False)
class ProjectedFaces:
    """Faces in the image: which side they show, and the box each one fills.

    facing: (f,) 1 for a face that shows its outside, -1 its inside, 0 edge-on: then it hides nothing; box: (4, f)
    smallest and largest x, smallest and largest y in the image, rounded outwards; nearest: (f,) the smallest depth.
    """

    facing: Bytes
    box: Floats32
    nearest: Floats32

    def __len__(self) -> int:
        return len(self.facing)


def project_faces(view: View) -> ProjectedFaces:
    """The faces of a view in the image.

    view: see scene.look; result: one entry for each face of the view.
    A face is edge-on where its image is narrower than the view's tolerance.
    Source: Glaeser, section 5.1 (backfaces and frontfaces).
    """
    count = view.face_count
    faces = ProjectedFaces(np.empty(count, np.int8), np.empty((4, count), np.float32), np.empty(count, np.float32))
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
