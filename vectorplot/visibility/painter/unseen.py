"""Faces no part of which is seen: those covered by opaque ones, and the inside of closed bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_pairs
from vectorplot.geometry.budget import in_turn, may_stop, slices, unheard
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.weld import distinct_points
from vectorplot.geometry.winding import components, edge_uses, inside_out, signed_volumes, turned_faces
from vectorplot.scene.view import View
from vectorplot.tolerances import LEAST_DIVISOR
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
