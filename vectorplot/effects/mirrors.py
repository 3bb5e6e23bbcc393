"""Plane mirrors: doubles of the scene behind them, and doubles of its lights, with where their light falls."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.windows import SeenThrough, joined_seen, near_windows, nothing_seen, seen_through
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces, drawn_faces
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, newell, project_faces

# Plane mirrors: the doubles of the scene behind them, and those of its lights.

DIMMED = 0.85
"""How bright doubles are against what they are doubles of: they appear slightly darker."""


@dataclass(frozen=True, eq=False)
class Mirrors:
    """Plane mirrors whose reflecting side is towards the eye: normal, point (3,k): unit normals to that side, and a
    point of each plane; face (n,) faces of the view that are mirrors, plane (n,) which plane each of them lies in."""

    normal: Floats
    point: Floats
    face: Ints
    plane: Ints

    def __len__(self) -> int:
        return int(self.normal.shape[1])

    def heights(self, plane: int, points: Floats) -> Floats:
        """(n,) heights of points (3,n) above one of the planes."""
        return np.asarray(matmul(self.normal[:, plane], points - self.point[:, plane : plane + 1]), dtype=np.float64)

    def reflected(self, plane: int, points: Floats) -> Floats:
        """(3,n) the mirror images of points (3,n) in one of the planes. Source: Glaeser, section 6.4."""
        return np.asarray(points - 2.0 * self.normal[:, plane, None] * self.heights(plane, points), dtype=np.float64)


def mirrors(scene: Scene, view: View, projected: ProjectedFaces) -> Mirrors:
    """The mirrors that the eye sees: faces of items of the material mirror that show their outside.

    Faces in one plane are one mirror. Source: Glaeser, section 6.4.
    """
    face = mirror_faces(scene, view)
    return mirrors_of(view, face[projected.facing[face] > 0])


def mirror_faces(scene: Scene, view: View) -> Ints:
    """(n,) the faces of the view of items of the material mirror."""
    shines = np.array([item.material.is_mirror for item in scene.items], dtype=np.bool_)
    return np.flatnonzero(shines[view.shown_item]) if len(shines) else np.zeros(0, dtype=np.intp)


def mirrors_of(view: View, face: Ints) -> Mirrors:
    """Faces as mirrors: those in one plane, with the same side outside, are one. Faces without area are left out."""
    normal, arm, first = newell(view, face)
    length = np.sqrt((normal * normal).sum(axis=0))
    full = length > view.tolerance * arm
    face, normal, point = face[full], normal[:, full] / length[full], view.points[:, first[full]]
    kept: list[int] = []
    plane = np.full(len(face), -1, dtype=np.intp)
    while (plane < 0).any():
        leader = int(np.argmax(plane < 0))
        same = (plane < 0) & _in_plane(view, face, normal[:, leader], point[:, leader])
        same &= matmul(normal[:, leader], normal) > 0.0
        same[leader] = True
        plane[same] = len(kept)
        kept.append(leader)
    return Mirrors(normal[:, kept], point[:, kept], face, plane)


def _in_plane(view: View, face: Ints, normal: Floats, point: Floats) -> Bools:
    """(n,) which faces have all corners in a plane."""
    corner, ends = ragged.take(view.offsets, face)
    height = np.abs(matmul(normal, view.points[:, view.corners[corner]] - point[:, None]))
    return np.maximum.reduceat(height, ends[:-1]) <= view.tolerance


def reflections(view: View, mirrors: Mirrors, painted: ImageFaces) -> SeenThrough:
    """The doubles of all faces on the reflecting sides of mirrors, clipped with what is painted (back to front) of the
    mirrors; to be painted right after their windows, DIMMED. In each other mirrors are plain faces; items cut by a
    mirror's plane are seen on its reflecting side.
    Source: Glaeser, section 6.4, figures 7 and 8.
    """
    return joined_seen([_reflected(view, mirrors, number, painted) for number in range(len(mirrors))])


def _reflected(view: View, mirrors: Mirrors, number: int, painted: ImageFaces) -> SeenThrough:
    windows = np.flatnonzero(np.isin(painted.source, mirrors.face[mirrors.plane == number]))
    if not len(windows):
        return nothing_seen()
    double, source = mirrored_view(view, mirrors, number, painted.box[:4, windows])
    if not len(source):
        return nothing_seen()
    order = painters_order(double)
    faces = replace(order.faces, source=source[order.faces.source])
    return seen_through(faces, painted, windows, view.tolerance)


def mirrored_view(view: View, mirrors: Mirrors, number: int, windows: Floats) -> tuple[View, Ints]:
    """The doubles of all faces on the reflecting side of a mirror that can be seen in windows (4,n), rectangles of the
    image, as a view with the same eye; and the face of the view each of its faces is the double of.

    Convex bodies stay whole; of all others only those faces are taken that show. Faces that the plane cuts become those
    of one item more, which comes last.
    """
    height = mirrors.heights(number, view.points)
    everything = doubled(view, mirrors, number)
    projected = project_faces(everything)
    near = near_windows(projected.box, windows)
    if not (near & (_face_spans(view, height)[1] > view.tolerance)).any():
        nothing = np.zeros(view.face_count, dtype=np.bool_)
        return half_of_view(everything, height, nothing, np.zeros(len(view.item_vertices) - 1, dtype=np.bool_))
    body = solid_items(everything, projected) & (_item_lows(view, height) >= -view.tolerance)
    in_body = body[view.face_item]
    shown = np.zeros(view.face_count, dtype=np.bool_)
    shown[drawn_faces(everything, projected)] = True
    near[in_body] = np.bincount(view.face_item[near], minlength=len(body))[view.face_item[in_body]] > 0
    return half_of_view(everything, height, near & (in_body | shown), body)


def doubled(view: View, mirrors: Mirrors, number: int) -> View:
    """The double of the whole view, with the same eye and the outsides of its faces outside."""
    return _turned_round(replace(view, points=mirrors.reflected(number, view.points)))


def half_of_view(view: View, height: Floats, wanted: Bools, body: Bools) -> tuple[View, Ints]:
    """Some wanted faces (f,) of a view, as far as a height (v,), linear in space, is not negative; and the face of the
    view that each of them is.

    body (i,): items with no vertex below, of which also faces at the height 0 are kept. Faces that are cut become those
    of one item more, which comes last.
    """
    low, high = _face_spans(view, height)
    # Faces in the plane have no double: they are the mirror, or lie on it.
    above = wanted & (high > view.tolerance)
    whole = np.flatnonzero((above & (low >= -view.tolerance)) | (wanted & body[view.face_item]))
    cut = np.flatnonzero(above & (low < -view.tolerance))
    return _with_cut_faces(view, whole, cut, height)


def backwards(view: View) -> Ints:
    """(c,) the corner of a view that each corner of its double is the double of."""
    last = np.repeat(view.offsets[:-1] + view.offsets[1:], view.face_sizes) - 1
    return np.asarray(last - np.arange(len(view.corners)), dtype=np.intp)


def _turned_round(view: View) -> View:
    """The view with every face listed the other way round."""
    order = backwards(view)
    # The side that leads away from a corner is the one that led to it.
    return replace(view, corners=view.corners[order], inner=view.inner[_before(view, order)])


def _before(view: View, position: Ints) -> Ints:
    """(n,) where the corners stand that go before those at some positions in their faces."""
    before = np.empty(len(view.corners), dtype=np.intp)
    every = np.arange(len(view.corners))
    before[view.after(every)] = every
    return np.asarray(before[position], dtype=np.intp)


def _face_spans(view: View, height: Floats) -> tuple[Floats, Floats]:
    """(f,) least and largest heights of the corners of faces."""
    if not view.face_count:
        return np.zeros(0), np.zeros(0)
    at_corner = height[view.corners]
    return np.minimum.reduceat(at_corner, view.offsets[:-1]), np.maximum.reduceat(at_corner, view.offsets[:-1])


def _item_lows(view: View, height: Floats) -> Floats:
    """(i,) the least heights of the vertices of items; 0 for one without vertices."""
    low = np.zeros(len(view.item_vertices) - 1)
    filled = np.flatnonzero(np.diff(view.item_vertices))
    if len(filled):
        low[filled] = np.minimum.reduceat(height, view.item_vertices[:-1][filled])
    return low


def _with_cut_faces(view: View, whole: Ints, cut: Ints, height: Floats) -> tuple[View, Ints]:
    """Some faces of a view whole, and others as far as the heights of their corners are not negative."""
    corner, offsets = ragged.take(view.offsets, cut)
    distance = np.where(np.abs(height) <= view.tolerance, 0.0, height)[view.corners[corner]]
    parts = Polygons(view.points[:, view.corners[corner]].T, offsets)
    if len(cut):
        parts, _ = cut_polygons(parts, distance)
    full = np.flatnonzero(np.diff(parts.offsets))
    position, ends = ragged.take(view.offsets, whole)
    count, items = view.points.shape[1], len(view.item_vertices) - 1
    sizes = np.diff(parts.offsets)[full]
    source = np.concatenate([whole, cut[full]])
    new = replace(
        view,
        points=np.concatenate([view.points, parts.points.T], axis=1),
        corners=np.concatenate([view.corners[position], count + np.arange(len(parts.points))]),
        offsets=np.concatenate([ends, ends[-1] + np.cumsum(sizes)]),
        inner=np.concatenate([view.inner[position], np.zeros(len(parts.points), dtype=np.bool_)]),
        face_item=np.concatenate([view.face_item[whole], np.full(len(full), items)]),
        item_vertices=np.append(view.item_vertices, count + len(parts.points)),
        occludes=np.append(view.occludes, True),
        face_look=None,
    )
    return new, source
