"""What hides: convex faces one by one, and convex solids by their outlines."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.scene.view import View
from vectorplot.tolerances import SINGLE_DEPTH_LEAST, SINGLE_DEPTH_SHARE
from vectorplot.visibility.projected_faces import CHUNK, Floats32, ProjectedFaces, newell

PAIRS_AT_ONCE = 1 << 20
"""So many corners of bodies are looked at together."""

MAX_SOLID_FACES = 128
"""A convex solid with more faces hides through its faces: few of them matter to a line, but all of its outline
would."""


@dataclass(frozen=True, eq=False)
class Occluders:
    """Convex things that hide.

    Occluder k hides the points with a positive distance from its planes offsets[k] to offsets[k+1]: planes (4,p) unit
    normal and constant; of these the first behind[k] bound it towards the eye, the others are its outline's planes
    through the eye, those of a solid by the lengths of their edges in the image, the longest first. box (4,k), nearest
    (k,), farthest (k,): in the image, as in ProjectedFaces; item (k,)."""

    planes: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    behind: Ints = field(metadata=EACH_LINE)
    box: Floats32 = field(metadata=EACH_LINE | IN_COLUMNS)
    nearest: Floats32 = field(metadata=EACH_LINE)
    farthest: Floats32 = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.behind)


def solid_items(view: View, faces: ProjectedFaces, *, most_faces: int = MAX_SOLID_FACES) -> Bools:
    """(i,) the items that hide as convex solids: closed, convex (tested: every vertex behind every face), of at most
    most_faces (others hide through their faces, few of which matter to a line), seen from outside. Source: Glaeser,
    sections 5.1 and 7.2.
    """
    items = len(view.item_vertices) - 1
    face_counts = np.bincount(view.face_item, minlength=items)
    vertex_counts = np.diff(view.item_vertices)
    chosen = view.occludes & (face_counts > 3) & (face_counts <= most_faces) & (vertex_counts <= 2 * most_faces)
    if not chosen.any():
        return chosen
    face = np.flatnonzero(chosen[view.face_item])
    of = view.face_item[face]
    open_vertex = unbalanced_vertices(view.points.shape[1], view.corners, view.offsets)
    chosen[np.searchsorted(view.item_vertices, np.flatnonzero(open_vertex), side="right") - 1] = False
    normal, _, first = newell(view, face)
    length = np.sqrt((normal * normal).sum(axis=0))
    normal = normal / np.where(length > 0.0, length, 1.0)
    constant = (normal * view.points.take(first, axis=1)).sum(axis=0)
    for low, high in ragged.batches(vertex_counts[of], PAIRS_AT_ONCE):
        pair_face = np.repeat(np.arange(low, high), vertex_counts[of[low:high]])
        starts = ragged.starts(vertex_counts[of[low:high]])
        vertex = np.arange(len(pair_face)) + (view.item_vertices[of[low:high]] - starts)[pair_face - low]
        height = (
            normal[0, pair_face] * view.points[0, vertex]
            + normal[1, pair_face] * view.points[1, vertex]
            + normal[2, pair_face] * view.points[2, vertex]
            - constant[pair_face]
        )
        chosen[of[pair_face[height > view.tolerance]]] = False
    seen = np.zeros(items, dtype=np.bool_)
    seen[view.face_item[(faces.facing > 0) & np.isfinite(faces.nearest)]] = True
    return np.asarray(chosen & seen, dtype=np.bool_)


def face_occluders(view: View, faces: ProjectedFaces, which: Ints) -> Occluders:
    """Some faces as occluders, whichever side they show; none of them may be edge-on."""
    chunks = slices(len(which), CHUNK) or [slice(0, 0)]
    return joined([*mapped(lambda some: _faces_as_occluders(view, faces, which[some]), chunks)])


def _faces_as_occluders(view: View, faces: ProjectedFaces, which: Ints) -> Occluders:
    sizes = view.face_sizes[which]
    normal, _, first = newell(view, which)
    toward = -faces.facing[which].astype(np.float64)
    depth_planes = _planes(normal * toward, view.points.take(first, axis=1))
    position = ragged.ranges(view.offsets[which], sizes)
    side = _side_planes(view, view.corners[position], view.corners[view.after(position)])
    side *= np.repeat(-toward, sizes)
    return _interleaved(
        view, depth_planes, np.ones(len(which), dtype=np.intp), side, sizes, faces, which, view.face_item[which]
    )


def solid_occluders(view: View, faces: ProjectedFaces, items: Ints) -> Occluders:
    """Convex solids as occluders: the planes of their outlines and of the faces that show.

    Source: Glaeser, sections 6.1 and 7.2.
    """
    number = np.full(len(view.item_vertices) - 1, -1, dtype=np.intp)
    number[items] = np.arange(len(items))
    which = np.flatnonzero((faces.facing > 0) & (number[view.face_item] >= 0))
    owner = number[view.face_item[which]]
    normal, _, first = newell(view, which)
    depth_planes = _planes(-normal, view.points.take(first, axis=1))
    sizes = view.face_sizes[which]
    position = ragged.ranges(view.offsets[which], sizes)
    a, b = view.corners[position], view.corners[view.after(position)]
    key = np.minimum(a, b) * view.points.shape[1] + np.maximum(a, b)
    order = np.argsort(key, kind="stable")
    begin = np.flatnonzero(np.concatenate([key[:1] >= 0, key[order][1:] != key[order][:-1]]))
    # Faces may be listed several times: an edge is on the outline where uses in both directions do not cancel.
    net = np.add.reduceat(np.where(a < b, 1, -1)[order], begin) if len(begin) else begin
    turned = np.zeros(len(key), dtype=np.bool_)
    turned[order[begin]] = (net > 0) != (a < b)[order[begin]]
    outline = np.sort(order[begin[net != 0]])
    start, end = np.where(turned, b, a)[outline], np.where(turned, a, b)[outline]
    side_owner = np.repeat(owner, sizes)[outline]
    # The longest sides keep most things out.
    along = view.image.take(end, axis=1) - view.image.take(start, axis=1)
    longest = np.lexsort((-np.hypot(along[0], along[1]), side_owner))
    side, side_owner = _side_planes(view, start[longest], end[longest]), side_owner[longest]
    depth_counts = np.bincount(owner, minlength=len(items))
    side_counts = np.bincount(side_owner, minlength=len(items))
    return _interleaved(view, depth_planes, depth_counts, side, side_counts, faces, which, items)


def _planes(normal: Floats, point: Floats) -> Floats:
    """(4,n) unit normals and constants of planes through points."""
    length = np.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
    normal = normal / np.where(length > 0.0, length, 1.0)
    constant = normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2]
    return np.concatenate([normal, constant[None]])


def _side_planes(view: View, start: Ints, end: Ints) -> Floats:
    """(4,n) planes through the eye and edges, positive on the left of start -> end as the eye sees it."""
    a = view.points.take(start, axis=1)
    along = view.points.take(end, axis=1) - a
    if view.eye is None:
        normal = np.stack([-along[1], along[0], np.zeros(len(start))])
    else:
        normal = cross(along, a - view.eye[:, None])
    return _planes(normal, a)


def _interleaved(
    view: View,
    depth: Floats,
    depth_counts: Ints,
    side: Floats,
    side_counts: Ints,
    faces: ProjectedFaces,
    which: Ints,
    item: Ints,
) -> Occluders:
    """Occluders from their depth planes and side planes, both listed occluder by occluder."""
    counts = depth_counts + side_counts
    first = ragged.offsets(counts)
    planes = np.empty((4, int(first[-1])))
    shift = first[:-1] - ragged.starts(depth_counts)
    planes[:, np.arange(depth.shape[1]) + np.repeat(shift, depth_counts)] = depth
    shift = first[:-1] + depth_counts - ragged.starts(side_counts)
    planes[:, np.arange(side.shape[1]) + np.repeat(shift, side_counts)] = side
    starts = ragged.starts(depth_counts)
    box = faces.box.take(which, axis=1)
    if len(which) != len(item):
        smallest = np.minimum.reduceat(box[[0, 2]], starts, axis=1)
        largest = np.maximum.reduceat(box[[1, 3]], starts, axis=1)
        box = np.stack([smallest[0], largest[0], smallest[1], largest[1]])
    farthest = _farthest(view, which)
    nearest = faces.nearest[which]
    return Occluders(
        planes,
        first,
        depth_counts,
        box,
        np.minimum.reduceat(nearest, starts) if len(starts) else nearest,
        np.maximum.reduceat(farthest, starts) if len(starts) else farthest,
        item,
    )


def _farthest(view: View, which: Ints) -> Floats32:
    """(n,) the largest depth of some faces, rounded up."""
    sizes = view.face_sizes[which]
    if not len(which):
        return np.zeros(0, dtype=np.float32)
    position = ragged.ranges(view.offsets[which], sizes)
    depth = np.maximum.reduceat(view.depth[view.corners[position]], ragged.starts(sizes))
    return (depth + SINGLE_DEPTH_SHARE * np.abs(depth) + SINGLE_DEPTH_LEAST).astype(np.float32)
