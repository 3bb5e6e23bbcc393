"""Faces no part of which is seen: those covered by opaque ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import Budget
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.hidden_lines import Segments, tried_pairs, visible_parts
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import EVERYWHERE, ProjectedFaces

# Faces no part of which is seen, because opaque ones cover all of it.

IN_ONE_CELL = 64
"""So many pairs of a side and a face in one cell of the image are as much work as one that is looked at closely."""


def unseen_faces(view: View, projected: ProjectedFaces, asked: Bools, cut: Bools, budget: Budget) -> Bools:
    """(f,) which of the faces asked about (f,) are wholly covered by faces of items that occlude.

    What can be seen of a face is bounded by its own sides and, where something in front of it ends, by sides with faces
    on one side only in the image; so a face none of whose sides is seen, and over which no such side is seen, is not
    seen either. That holds for faces that nothing pierces.
    cut (f,): the faces that the painter had to cut; where they are, something may pierce another, and all is seen.
    Edge cases: nothing is unseen where faces reach through the near plane, or where so many lie on each other that
    finding out costs more than the budget's pairs; a face along the border of what covers it is seen.
    Source: Glaeser, section 7.2 (visibility changes only at contours).
    """
    none = np.zeros(view.face_count, dtype=np.bool_)
    if not asked.any() or (projected.box[1] >= EVERYWHERE).any() or not np.isfinite(projected.nearest).all():
        return none
    start, end, of_corner, ends_there = _sides(view, projected)
    needed = ends_there.copy()
    corner = np.flatnonzero(np.repeat(asked, view.face_sizes))
    needed[of_corner[corner]] = True
    which = np.flatnonzero(needed)
    segments = Segments(view.points[:, start[which]], view.points[:, end[which]])
    solid = solid_items(view, projected)
    if tried_pairs(view, projected, solid, segments) > IN_ONE_CELL * budget.pairs:
        return none
    seen = visible_parts(view, projected, solid, segments, lambda _: None)
    open_side = np.zeros(len(start), dtype=np.bool_)
    open_side[which[seen.segment]] = True
    face = ragged.owner(view.face_sizes)
    covered = asked.copy()
    covered[face[open_side[of_corner]]] = False
    rims = np.flatnonzero(ends_there[which[seen.segment]])
    number, low, high = seen.segment[rims], seen.low[rims], seen.high[rims]
    way = segments.end - segments.start
    parts = [view.image_of(segments.start[:, number] + t * way[:, number]) for t in (low, high)]
    return _without_crossed(view, covered, cut, np.stack(parts, axis=-1).transpose(1, 2, 0))


def _sides(view: View, projected: ProjectedFaces) -> tuple[Ints, Ints, Ints, Bools]:
    """The different sides of all faces: the numbers of their ends (s,) and (s,); (c,) the side that begins at each
    corner; (s,) those at which what occludes ends in the image: with more faces of it on one of their sides than on the
    other."""
    first = view.corners
    last = first[ragged.following(view.offsets)]
    low, high = np.minimum(first, last), np.maximum(first, last)
    count = max(view.points.shape[1], 1)
    keys, of_corner = np.unique(low * count + high, return_inverse=True)
    face = ragged.owner(view.face_sizes)
    left = projected.facing[face] * np.where(first == low, 1, -1)
    left = np.where(view.occludes[view.face_item[face]], left, 0)
    surplus = np.bincount(of_corner.ravel(), weights=left, minlength=len(keys))
    return keys // count, keys % count, of_corner.ravel(), surplus != 0.0


def _without_crossed(view: View, covered: Bools, cut: Bools, lines: Floats) -> Bools:
    """The covered faces (f,) but for those with images that meet lines (m,2,2) of the image, or images of cut faces."""
    import shapely

    face = np.flatnonzero(covered)
    found = covered.copy()
    if len(face):
        tree = shapely.STRtree(_images(view, face))
        others = np.concatenate((shapely.linestrings(lines), _images(view, np.flatnonzero(cut))))
        found[face[tree.query(others, predicate="intersects")[1]]] = False
    return found


def _images(view: View, face: Ints) -> NDArray[np.object_]:
    """(n,) the images of faces (n,) as polygons of shapely."""
    import shapely

    corner, offsets = ragged.take(view.offsets, face)
    of = ragged.owner(np.diff(offsets))
    points = view.image[:, view.corners[corner]].T
    order = np.argsort(np.concatenate((of, np.arange(len(face)))), kind="stable")
    closed = np.concatenate((np.arange(len(points)), offsets[:-1]))[order]
    rings = shapely.linearrings(points[closed], indices=np.concatenate((of, np.arange(len(face))))[order])
    return np.asarray(shapely.polygons(rings), dtype=np.object_)
