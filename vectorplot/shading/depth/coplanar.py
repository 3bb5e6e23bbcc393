"""Faces that lie in one plane, and which of them is seen: the one that paint paints last."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import determinant
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import face_normals
from vectorplot.shading.raster.scene_triangles import SceneTriangles
from vectorplot.shading.raster.screen import ScreenTriangles, front_facing
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.visibility.painter.image_faces import image_faces

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
    in the image, as paint has it. Degenerate: faces without area, and those seen edge-on, have no rank."""
    plane = _planes(view)
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
    slopes, flat = _depth_planes(scene, homogeneous, coplanar, names)
    sheet[shared] = np.where(flat[sheet[shared]], sheet[shared], -1)
    corners, source = triangles.corners[order], triangles.source[order]
    return replace(triangles, corners=corners, source=source, sheet=sheet[order], slopes=slopes)


def _planes(view: View) -> Ints:
    """(f,) numbers of planes that several faces lie in, -1 for other faces."""
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
    for row, same in zip(rows[::-1], (SAME_DISTANCE, *[SAME_NORMAL] * 3), strict=True):
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
    a, b, c = (scene.points[scene.corners[:, k]] for k in range(3))
    number = coplanar.plane[scene.face]
    own = np.flatnonzero(np.isin(number, names))
    area = np.linalg.norm(np.cross(b[own] - a[own], c[own] - a[own]), axis=1)
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
