"""Faces no part of which is seen: those covered by opaque ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unheard
from vectorplot.geometry.component_arrays import dot
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra.hidden_lines import Segments, tried_pairs, visible_parts
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import EVERYWHERE, ProjectedFaces, newell

# Faces no part of which is seen, because opaque ones cover all of it.

IN_ONE_CELL = 64
"""So many pairs of a side and a face in one cell of the image are as much work as one that is looked at closely."""


def unseen_faces(view: View, projected: ProjectedFaces, asked: Bools, cut: Bools, pairs: float) -> Bools:
    """(f,) which of the faces asked about (f,) are wholly covered by faces of items that occlude.

    What can be seen of a face is bounded by its own sides and, where something in front of it ends, by sides with faces
    on one side only in the image; so a face none of whose sides is seen, and nothing of which is seen right behind such
    a side that is seen itself, is not seen either. That holds for faces that nothing pierces.
    cut (f,): the faces that the painter had to cut; where they are, something may pierce another, and all is seen.
    Edge cases: nothing is unseen where faces reach through the near plane, or where so many lie on each other that
    finding out costs more than so many pairs; a face along the border of what covers it is seen.
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
    if tried_pairs(view, projected, solid, segments) > IN_ONE_CELL * pairs:
        return none
    seen = visible_parts(view, projected, solid, segments, unheard)
    open_side = np.zeros(len(start), dtype=np.bool_)
    open_side[which[seen.segment]] = True
    face = ragged.owner(view.face_sizes)
    covered = asked.copy()
    covered[face[open_side[of_corner]]] = False
    rims = np.flatnonzero(ends_there[which[seen.segment]])
    number, low, high = seen.segment[rims], seen.low[rims], seen.high[rims]
    way = segments.end - segments.start
    parts = [view.image_of(segments.start[:, number] + t * way[:, number]) for t in (low, high)]
    covered &= ~_meeting(view, covered, _images(view, np.flatnonzero(cut)))
    rim, over, behind = _behind(view, projected, np.flatnonzero(covered), *parts)
    if len(rim) > pairs:
        covered[over] = False
    else:
        covered[over[visible_parts(view, projected, solid, behind, unheard).segment]] = False
    return covered


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


def _meeting(view: View, covered: Bools, others: NDArray[np.object_]) -> Bools:
    """(f,) the covered faces (f,) whose images meet other shapes."""
    import shapely

    face = np.flatnonzero(covered)
    found = np.zeros_like(covered)
    if len(face) and len(others):
        found[face[shapely.STRtree(_images(view, face)).query(others, predicate="intersects")[1]]] = True
    return found


def _behind(
    view: View, projected: ProjectedFaces, face: Ints, start: Floats, end: Floats
) -> tuple[Ints, Ints, Segments]:
    """Where lines of the image from start to end (2,m) run over faces (n,): lines (k,), faces (k,), and the parts of
    these that are seen there, were there nothing before them."""
    import shapely

    tree = shapely.STRtree(_images(view, face))
    line, over = tree.query(shapely.linestrings(np.stack([start, end]).transpose(2, 0, 1)), predicate="intersects")
    over = face[over]
    low, high = np.zeros(len(line)), np.ones(len(line))
    sizes, turned = view.face_sizes[over], projected.facing[over]
    for step in range(int(sizes.max(initial=0))):
        corner = view.corners[view.offsets[over] + np.minimum(step, sizes - 1)]
        after = view.corners[view.offsets[over] + np.where(step + 1 < sizes, step + 1, 0)]
        at, way = view.image[:, corner], turned * (view.image[:, after] - view.image[:, corner])
        way[:, step >= sizes] = 0.0
        here, there = (way[0] * (ends[1, line] - at[1]) - way[1] * (ends[0, line] - at[0]) for ends in (start, end))
        part = here / np.where(here != there, here - there, 1.0)
        low = np.where((here < 0.0) & (there > here), np.maximum(low, part), low)
        high = np.where((there < 0.0) & (here > there), np.minimum(high, part), high)
        high[(here < 0.0) & (there < 0.0)] = -1.0
    kept = np.flatnonzero(low < high)
    line, over = line[kept], over[kept]
    along = end[:, line] - start[:, line]
    ends = [_on_faces(view, start[:, line] + part[kept] * along, over) for part in (low, high)]
    return line, over, Segments(*ends)


def _on_faces(view: View, image: Floats, face: Ints) -> Floats:
    """(3,n) what points (2,n) of the image show of the planes of faces (n,)."""
    normal, _, first = newell(view, face)
    place = view.in_image_plane(image)
    way = np.broadcast_to([[0.0], [0.0], [1.0]], place.shape) if view.eye is None else place - view.eye[:, None]
    far = dot(normal, view.points[:, first] - place) / dot(normal, way)
    return np.asarray(place + far * way)


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
