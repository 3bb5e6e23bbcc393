"""Where faces of different shapes, of different parts of one, or of one part that meets itself, pierce each other."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.mesh_edge_lines import Faces, unit_normals
from vectorplot.geometry import ragged, records
from vectorplot.geometry.boxes import overlapping_boxes, overlapping_pairs
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices
from vectorplot.geometry.component_arrays import cross, dot, first_of_equal
from vectorplot.geometry.connectivity import pieces_of_faces
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import FACES_APART, LEAST_DIVISOR

SLIM_FACES, FEWEST_PAIRS = 12, 1024
"""Parts of so few faces are looked at more closely where so many pairs of boxes overlap."""

FACES_AT_ONCE = 1 << 15
"""Pairs of faces, or of slim parts, looked at at once."""

BOXES_AT_ONCE = 1 << 20
"""About so many boxes of faces of pairs of parts are swept at once."""

FEW_FACES = 1 << 8
"""Of parts of so few faces all pairs are looked at."""

PATCH_FACES = 48
"""Faces in a patch of a larger part, on the average."""

LEAST_COSINE = 0.1
"""The faces of a patch, or of two patches that touch, do not meet each other where all normals are within this cosine
of one direction: they lie side by side, seen from there."""

_MIX = np.uint32(0x9E3779B1)
"""Odd, with bits all over: it spreads numbers over a table."""


AXIS_SHIFT = 16.0
"""Coordinates stay below this; pairs of parts are kept apart on a sweep's axis by multiples of it."""


@dataclass(frozen=True, eq=False)
class Intersections:
    """Segments in which two faces meet.

    start, end: (3, n) their ends, in the coordinates of the faces; one, two: (n,) the two faces.
    """

    start: Floats = field(metadata=IN_COLUMNS)
    end: Floats = field(metadata=IN_COLUMNS)
    one: Ints
    two: Ints


def face_intersections(faces: Faces, part: Ints, tolerance: float) -> Intersections:
    """The segments in which convex faces of different parts meet.

    part: (f,) faces with the same number are not compared.
    Source: Glaeser, section 1.3, equations 21 and 22; errata G1-01 to G1-03.
    """
    none = np.zeros((3, 0))
    found = [Intersections(none, none, np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    one, two = _pairs_of_faces(faces, part, tolerance)
    chunks = slices(len(one), FACES_AT_ONCE)
    normals = _normals_of(faces, one, two)
    found.extend(mapped(lambda some: _meet(faces, normals, one[some], two[some], tolerance), chunks))
    whole = records.joined(found)
    return records.take(whole, _first_of_equal(whole.start, whole.end, tolerance))


def self_intersections_of_parts(faces: Faces, part: Ints, tolerance: float) -> Intersections:
    """The segments in which convex faces of one part pierce each other; see face_intersections for different parts. Of
    piercing faces each reaches to both sides of the other; an edge in a face has its two faces on different sides;
    edges in one place have alternating faces. So neighbours and mere contact do not count.
    Source: Glaeser, section 8.4; patches as in Volino and Magnenat Thalmann, Efficient self-collision detection (1994).
    """
    one, two = _pairs_within_parts(faces, part, tolerance)
    normals = _normals_of(faces, one, two)

    def pierce(some: slice) -> tuple[Intersections, Intersections, Ints]:
        """What pierces; and what has an edge (of one) in a face (two), with the side on which the face (one) is."""
        a, b = one[some], two[some]
        over_a, over_b = (_over_planes(faces, normals, *pair, tolerance) for pair in ((b, a), (a, b)))
        across = [(low < 0.0) & (high > 0.0) for low, high, _ in (over_a, over_b)]
        both = np.flatnonzero(across[0] & across[1])
        piercing = _meet(faces, normals, a[both], b[both], tolerance)
        lying, sides = [], []
        for edge, face, (low, high, in_plane), straddles in ((a, b, over_b, across[0]), (b, a, over_a, across[1])):
            kept = np.flatnonzero(straddles & (in_plane > 1) & (low < high) & ((low == 0.0) | (high == 0.0)))
            found = _meet(faces, normals, edge[kept], face[kept], tolerance)
            low, _, _ = _over_planes(faces, normals, found.one, found.two, tolerance)
            lying.append(found)
            sides.append(np.where(low < 0.0, -1, 1))
        return piercing, records.joined(lying), np.concatenate(sides)

    none = _meet(faces, normals, one[:0], two[:0], tolerance)
    found = list(mapped(pierce, slices(len(one), FACES_AT_ONCE)))
    lying = records.joined([none, *(edges for _, edges, _ in found)])
    side = np.concatenate([np.zeros(0, dtype=np.intp), *(sides for _, _, sides in found)])
    whole = records.joined(
        [
            none,
            *(piercing for piercing, _, _ in found),
            records.take(lying, _on_both_sides(lying, side, tolerance)),
            _crossing_edges(faces, part, tolerance),
        ]
    )
    return records.take(whole, _first_of_equal(whole.start, whole.end, tolerance))


def _over_planes(
    faces: Faces, normals: Floats, which: Ints, planes: Ints, tolerance: float
) -> tuple[Floats, Floats, NDArray[np.int8]]:
    """See _reach, over the planes of other faces."""
    origin = faces.points.take(faces.corners[faces.offsets[planes]], axis=1)
    return _reach(faces, which, normals.take(planes, axis=1), origin, tolerance)


def _on_both_sides(lying: Intersections, side: Ints, tolerance: float) -> Ints:
    """The edges (in faces two) of faces (one) on one side of which another face has the same one, on the other side."""
    one, other = (np.round(ends / (8.0 * tolerance)) for ends in (lying.start, lying.end))
    turned = (one[0] > other[0]) | (one[0] == other[0]) & (
        (one[1] > other[1]) | (one[1] == other[1]) & (one[2] > other[2])
    )
    key = np.concatenate([np.where(turned, other, one), np.where(turned, one, other), lying.two[None]])
    order = np.lexsort((side, *key))
    key, side = key.take(order, axis=1), side[order]
    same = (key[:, 1:] == key[:, :-1]).all(axis=0)
    return order[np.flatnonzero(same & (side[1:] > side[:-1]))]


def _crossing_edges(faces: Faces, part: Ints, tolerance: float) -> Intersections:
    """The edges of four faces of a part, in one place, about which the faces of two surfaces alternate: those of the
    same two vertices are of one surface, or where all four have these, the first and the third one in turn."""
    may_stop()
    place = _places(np.round(faces.points / (8.0 * tolerance))).astype(np.uint32)
    a = place[faces.corners]
    b = a[next_positions(faces.offsets, np.arange(len(a)))]
    # Most sides are alone with their twin in a cell of a table: so few are sorted.
    cell = ((a + b) * _MIX + a * b) & np.uint32((1 << len(a).bit_length()) - 1)
    shared = np.flatnonzero((np.bincount(cell) > 3)[cell])
    del cell
    at = np.sort(np.stack([a[shared], b[shared]]).astype(np.intp), axis=0)
    del a, b
    ends = np.stack([faces.corners[shared], faces.corners[next_positions(faces.offsets, shared)]])
    face = ragged.owner(np.diff(faces.offsets))[shared]
    key = at[0] * len(place) + at[1]
    order = np.argsort(key, kind="stable")
    start = np.flatnonzero(np.diff(key[order], prepend=-1))
    size = np.diff(start, append=len(order))
    four = order[start[size == 4][:, None] + np.arange(4)]
    four = four[(part[face[four]] == part[face[four[:, :1]]]).all(axis=1) & (at[0] < at[1])[four[:, 0]]]
    if not len(four):
        none = np.zeros(0, dtype=np.intp)
        return Intersections(np.zeros((3, 0)), np.zeros((3, 0)), none, none)
    base, tip = (faces.points.take(at[k][four[:, 0]], axis=1) for k in (0, 1))
    along = tip - base
    # The arms: to the middles of the faces, across the edge.
    middle = _middles(faces)[:, face[four]] - base[..., None]
    first = middle[..., 0] - along * (dot(middle[..., 0], along) / dot(along, along))
    second = cross(along, first) / np.maximum(np.sqrt(dot(along, along)), LEAST_DIVISOR)
    x, y = (dot(middle, np.repeat(axis[..., None], 4, axis=2)) for axis in (first, second))
    turn = arctan2(y, x)
    turn[:, 0] = 0.0
    turn = np.where(turn < 0.0, turn + 2.0 * np.pi, turn)
    rank = np.argsort(np.argsort(turn, axis=1, kind="stable"), axis=1, kind="stable")
    gaps = np.diff(np.sort(turn, axis=1), axis=1, append=2.0 * np.pi)
    own = np.sort(ends, axis=0)
    mate = (own[:, four] == own[:, four[:, :1]]).all(axis=0)
    # The mate of the first face is across where two others lie between them, one on each side.
    across = (mate & (rank == 2)).any(axis=1)
    opposite = (mate.sum(axis=1) == 2) & across | mate.all(axis=1)
    kept = np.flatnonzero(opposite & (gaps.min(axis=1) > FACES_APART))
    return Intersections(base[:, kept], tip[:, kept], face[four[kept, 0]], face[four[kept, 1]])


def _places(points: Floats) -> Ints:
    """(n,) the first of the points (3,n) that are in the same place as each."""
    if first_of_equal(points).all():
        return np.arange(points.shape[1])
    order = np.lexsort(points)
    new = np.ones(len(order), dtype=np.bool_)
    new[1:] = (np.diff(points.take(order, axis=1), axis=1) != 0.0).any(axis=0)
    place = np.empty(len(order), dtype=np.intp)
    place[order] = order[np.maximum.accumulate(np.where(new, np.arange(len(order)), 0))]
    return place


def _middles(faces: Faces) -> Floats:
    """(3,f) the means of the corners of all faces."""
    total = np.add.reduceat(faces.points.take(faces.corners, axis=1), faces.offsets[:-1], axis=1)
    return np.asarray(total / np.diff(faces.offsets))


def _pairs_within_parts(faces: Faces, part: Ints, tolerance: float) -> tuple[Ints, Ints]:
    """Pairs of faces of a part whose boxes overlap, but for those of which patches tell that they do not meet."""
    none = np.zeros(0, dtype=np.intp)
    if not len(part):
        return none, none
    low, high = _boxes(faces, np.arange(len(part)), tolerance)
    many = np.bincount(part)[part] > FEW_FACES
    found = [_pairs_in_groups(low, high, part, np.flatnonzero(~many))]
    if many.any():
        patch = _patches(faces, part, low, high, np.flatnonzero(many))
        found.extend(_pairs_of_patches(faces, part, patch, low, high))
    one, two = (np.concatenate(column) for column in zip(*found, strict=True))
    return one, two


def _pairs_in_groups(low: Floats, high: Floats, group: Ints, face: Ints) -> tuple[Ints, Ints]:
    """Pairs of some faces of the same group whose boxes (3,f) overlap."""
    shift = np.array([[AXIS_SHIFT], [0.0], [0.0]]) * group[face]
    one, two = overlapping_pairs(low.take(face, axis=1) + shift, high.take(face, axis=1) + shift)
    return face[one], face[two]


def _patches(faces: Faces, part: Ints, low: Floats, high: Floats, face: Ints) -> Ints:
    """(f,) a patch of every one of some faces, -1 of the others: those of a part in a cell of a grid that are connected
    by vertices."""
    may_stop()
    middle = (low.take(face, axis=1) + high.take(face, axis=1)) / 2.0
    size = (high - low).take(face, axis=1)
    base, reach = middle.min(axis=1), middle.max(axis=1) - middle.min(axis=1)
    # The middle one of three sides of a box is about a side of its face.
    width = max(np.sqrt(PATCH_FACES / 2.0) * float(np.sort(size, axis=0)[1].mean()), float(reach.max()) / (1 << 10))
    cells = ((middle - base[:, None]) / (width or 1.0)).astype(np.intp)
    key = ((part[face] << 11 | cells[0]) << 11 | cells[1]) << 11 | cells[2]
    group = np.unique(key, return_inverse=True)[1]
    may_stop()
    corners, offsets = ragged.take(faces.offsets, face)
    vertex, of = faces.corners[corners], group[ragged.owner(np.diff(offsets))]
    # Every group has vertices of its own.
    owner = np.zeros(faces.points.shape[1], dtype=np.intp)
    owner[vertex] = of
    strange = np.flatnonzero(owner[vertex] != of)
    copies, number = np.unique(of[strange] * faces.points.shape[1] + vertex[strange], return_inverse=True)
    vertex[strange] = faces.points.shape[1] + number
    patch = np.full(len(part), -1, dtype=np.intp)
    patch[face] = pieces_of_faces(faces.points.shape[1] + len(copies), vertex, offsets)[1]
    return patch


def _pairs_of_patches(faces: Faces, part: Ints, patch: Ints, low: Floats, high: Floats) -> list[tuple[Ints, Ints]]:
    """Pairs of faces with overlapping boxes (3,f), of patches (f,) that do not lie side by side, and of each patch
    that does not face one way."""
    may_stop()
    face = np.flatnonzero(patch >= 0)
    face = face[np.argsort(patch[face], kind="stable")]
    starts = np.flatnonzero(np.diff(patch[face], prepend=-1))
    normals = unit_normals(faces, face)
    axes = np.add.reduceat(normals, starts, axis=1)
    axes /= np.maximum(np.sqrt(dot(axes, axes)), LEAST_DIVISOR)
    # Faces without area have no normal, and are as good as not there.
    cosine = np.where(dot(normals, normals) > 0.0, dot(normals, axes.take(patch[face], axis=1)), 1.0)
    least = np.minimum.reduceat(cosine, starts)
    patch_low = np.minimum.reduceat(low.take(face, axis=1), starts, axis=1)
    patch_high = np.maximum.reduceat(high.take(face, axis=1), starts, axis=1)
    may_stop()
    found = [_pairs_in_groups(low, high, patch, face[least[patch[face]] <= LEAST_COSINE])]
    one, two = overlapping_pairs(patch_low, patch_high)
    of = part[face[starts]]
    one, two = _picked(np.flatnonzero(of[one] == of[two]), one, two)
    # Both face one way where the cones of their normals have a common axis: that between their own ones.
    between = axes.take(one, axis=1) + axes.take(two, axis=1)
    between /= np.maximum(np.sqrt(dot(between, between)), LEAST_DIVISOR)
    together = _cosine_beyond(dot(between, axes.take(one, axis=1)), np.minimum(least[one], least[two])) > LEAST_COSINE
    doubtful = np.flatnonzero(~(together & _touch(faces, patch, one, two)))
    if len(doubtful):
        pairs = one[doubtful], two[doubtful]
        first, second = _within_pairs(
            low.take(face, axis=1), high.take(face, axis=1), patch[face], pairs, patch_low, patch_high
        )
        found.append((face[first], face[second]))
    return found


def _cosine_beyond(one: Floats, two: Floats) -> Floats:
    """The cosine of the sum of two angles of given cosines, -1 from two right angles on."""
    sines = np.sqrt(np.maximum((1.0 - one * one) * (1.0 - two * two), 0.0))
    return np.where(one + two > 0.0, one * two - sines, -1.0)


def _touch(faces: Faces, patch: Ints, one: Ints, two: Ints) -> Bools:
    """(n,) which pairs of patches have a vertex in common."""
    may_stop()
    owner = patch[ragged.owner(np.diff(faces.offsets))]
    patches = int(patch.max()) + 1
    last = np.zeros(faces.points.shape[1], dtype=np.intp)
    last[faces.corners] = owner
    shared = np.zeros(len(last), dtype=np.bool_)
    shared[faces.corners[last[faces.corners] != owner]] = True
    inside = (owner >= 0) & shared[faces.corners]
    may_stop()
    key = np.unique(faces.corners[inside] * patches + owner[inside])
    vertex, of = np.divmod(key, patches)
    touching = [np.zeros(0, dtype=np.intp)]
    # The patches about a vertex are a run, in order; a pair that is far apart in a long one is looked at in vain only.
    for step in in_turn(range(1, 5)):
        same = np.flatnonzero(vertex[step:] == vertex[:-step])
        touching.append(of[same] * patches + of[same + step])
    return np.isin(one * patches + two, np.concatenate(touching))


def _normals_of(faces: Faces, one: Ints, two: Ints) -> Floats:
    """(3,f) unit normals of all faces that are in a pair."""
    normals = np.zeros((3, len(faces.offsets) - 1))
    paired = np.zeros(normals.shape[1], dtype=np.bool_)
    paired[one] = paired[two] = True
    which = np.flatnonzero(paired)
    normals[:, which] = unit_normals(faces, which)
    return normals


def _first_of_equal(start: Floats, end: Floats, tolerance: float) -> Ints:
    """The segments of which no earlier one is the same: many faces may meet in one edge."""
    # The products of the components of a way are the same there and back, and tell mirrored ways apart.
    way = end - start
    x, y, z = way / np.sqrt(np.maximum(norm(way.T), LEAST_DIVISOR))
    steps = np.round(np.concatenate([start + end, [x * x, y * y, z * z, x * y, y * z, z * x]]) / (8.0 * tolerance))
    return np.flatnonzero(first_of_equal(steps))


def _pairs_of_faces(faces: Faces, part: Ints, tolerance: float) -> tuple[Ints, Ints]:
    """Pairs of faces of different parts whose boxes overlap."""
    none = np.zeros(0, dtype=np.intp)
    parts = int(part.max(initial=-1)) + 1
    if parts < 2:
        return none, none
    low, high = _part_boxes(faces, part, parts)
    low, high = low - tolerance, high + tolerance
    a, b = overlapping_pairs(low, high)
    near = _may_meet(faces, part, a, b, tolerance)
    a, b = a[near], b[near]
    beside = ~_within_hollow(faces, part, (low, high), a, b, tolerance)
    a, b = a[beside], b[beside]
    meeting = np.zeros(parts, dtype=np.bool_)
    meeting[a], meeting[b] = True, True
    face = np.flatnonzero(meeting[part])
    if not len(face):
        return none, none
    one, two = _within_pairs(*_boxes(faces, face, tolerance), part[face], (a, b), low, high)
    return face[one], face[two]


def _may_meet(faces: Faces, part: Ints, one: Ints, two: Ints, tolerance: float) -> Bools:
    """(n,) which pairs of parts no plane along the longest edges of both keeps apart: the boxes of long thin things,
    such as bars, overlap nearly always, and hardly any meet."""
    size = np.bincount(part)[part]
    slim = np.flatnonzero(size <= SLIM_FACES)
    close = np.ones(len(one), dtype=np.bool_)
    if not len(slim) or len(one) < FEWEST_PAIRS:
        return close
    position, face, _ = _corners_of(faces, slim)
    # Sorted by hand: the keys come nearly in order, which a sort makes use of and the hash table of np.unique does not.
    key = np.sort(part[slim[face]] * faces.points.shape[1] + faces.corners[position])
    of, corner = np.divmod(key[np.diff(key, prepend=-1) > 0], faces.points.shape[1])
    offsets = np.searchsorted(of, np.arange(int(part.max()) + 2))
    along = _longest_edges(faces, part)
    kept = np.flatnonzero((np.diff(offsets)[one] > 0) & (np.diff(offsets)[two] > 0))

    def apart(some: slice) -> Ints:
        pair = kept[some]
        axis = cross(along.take(one[pair], axis=1), along.take(two[pair], axis=1))
        spans = [_spans(faces, corner, offsets, which[pair], axis) for which in (one, two)]
        gap = tolerance * np.sqrt(dot(axis, axis))
        away = (spans[0][0] > spans[1][1] + gap) | (spans[1][0] > spans[0][1] + gap)
        return np.asarray(pair[away], dtype=np.intp)

    for pairs in mapped(apart, slices(len(kept), FACES_AT_ONCE)):
        close[pairs] = False
    return close


def _within_hollow(
    faces: Faces, part: Ints, boxes: tuple[Floats, Floats], one: Ints, two: Ints, tolerance: float
) -> Bools:
    """(n,) of which pairs of parts, with boxes (3,p), one lies in a ball about the middle of the other that the planes
    of this one's faces leave free: shells in each other, all boxes of which overlap."""
    parts = boxes[0].shape[1]
    size = np.bincount(part, minlength=parts)
    large = np.flatnonzero(np.minimum(size[one], size[two]) > SLIM_FACES)
    result = np.zeros(len(one), dtype=np.bool_)
    if not len(large):
        return result
    asked, middle = np.zeros(parts, dtype=np.bool_), np.zeros((3, parts))
    asked[one[large]] = asked[two[large]] = True
    middle[:, asked] = (boxes[0][:, asked] + boxes[1][:, asked]) / 2.0
    which = np.flatnonzero(asked[part])
    position, face, starts = _corners_of(faces, which)
    arm = faces.points.take(faces.corners[position], axis=1) - middle.take(part[which[face]], axis=1)
    free, reach = np.full(parts, np.inf), np.zeros(parts)
    np.maximum.at(reach, part[which[face]], np.sqrt(dot(arm, arm)))
    normals = unit_normals(faces, which)
    np.minimum.at(free, part[which], np.abs(dot(normals, arm.take(starts, axis=1))))
    way = middle.take(one[large], axis=1) - middle.take(two[large], axis=1)
    apart = np.sqrt(dot(way, way)) + tolerance
    inside = apart + reach[one[large]] < free[two[large]]
    result[large] = inside | (apart + reach[two[large]] < free[one[large]])
    return result


def _longest_edges(faces: Faces, part: Ints) -> Floats:
    """(3,p) a longest edge of every part."""
    after = next_positions(faces.offsets, np.arange(len(faces.corners)))
    edge = faces.points.take(faces.corners[after], axis=1) - faces.points.take(faces.corners, axis=1)
    owner = np.repeat(part, np.diff(faces.offsets))
    length, most = dot(edge, edge), np.zeros(int(part.max()) + 1)
    np.maximum.at(most, owner, length)
    longest = np.flatnonzero(length == most[owner])
    last = np.zeros(len(most), dtype=np.intp)
    last[owner[longest]] = longest
    return edge.take(last, axis=1)


def _spans(faces: Faces, corner: Ints, offsets: Ints, which: Ints, axis: Floats) -> tuple[Floats, Floats]:
    """From where to where (n,) parts reach along axes (3,n); corner: of all parts, one after the other."""
    size = offsets[which + 1] - offsets[which]
    points = faces.points.take(corner[ragged.ranges(offsets[which], size)], axis=1)
    height = dot(points, np.repeat(axis, size, axis=1))
    starts = ragged.starts(size)
    return np.minimum.reduceat(height, starts), np.maximum.reduceat(height, starts)


def _part_boxes(faces: Faces, part: Ints, parts: int) -> tuple[Floats, Floats]:
    """Smallest and largest coordinates (3,p) of every part."""
    # Parts may share points: each has all corners of its faces.
    starts = faces.offsets[:-1]
    low, high = np.full((3, parts), np.inf), np.full((3, parts), -np.inf)
    for axis in range(3):
        at_corner = faces.points[axis, faces.corners]
        np.minimum.at(low[axis], part, np.minimum.reduceat(at_corner, starts))
        np.maximum.at(high[axis], part, np.maximum.reduceat(at_corner, starts))
    return low, high


def _boxes(faces: Faces, which: Ints, tolerance: float) -> tuple[Floats, Floats]:
    """Smallest and largest coordinates (3,n) of some faces, widened by the tolerance."""
    position, _, starts = _corners_of(faces, which)
    at_corner = faces.points.take(faces.corners[position], axis=1)
    return np.minimum.reduceat(at_corner, starts, axis=1) - tolerance, np.maximum.reduceat(
        at_corner, starts, axis=1
    ) + tolerance


def _within_pairs(
    low: Floats, high: Floats, part: Ints, pairs: tuple[Ints, Ints], part_low: Floats, part_high: Floats
) -> tuple[Ints, Ints]:
    """Pairs of faces with overlapping boxes (3,n), one of each part of a pair of parts."""
    a, b = pairs
    by_part = np.argsort(part, kind="stable")
    first = np.searchsorted(part[by_part], np.arange(part_low.shape[1] + 1))
    common_low = np.maximum(part_low.take(a, axis=1), part_low.take(b, axis=1))
    common_high = np.minimum(part_high.take(a, axis=1), part_high.take(b, axis=1))
    sizes = np.diff(first)[a] + np.diff(first)[b]
    none = np.zeros(0, dtype=np.intp)
    found = [(none, none, none.astype(np.bool_))]
    for begin, end in ragged.batches(sizes, BOXES_AT_ONCE):
        sides = []
        for which in (a[begin:end], b[begin:end]):
            size = first[which + 1] - first[which]
            pair = begin + ragged.owner(size)
            face = by_part[np.arange(len(pair)) - np.repeat(ragged.starts(size) - first[which], size)]
            near = np.ones(len(pair), dtype=np.bool_)
            for axis in range(3):
                near &= low[axis, face] <= common_high[axis, pair]
                near &= high[axis, face] >= common_low[axis, pair]
            sides.append((pair[near], face[near]))
        # Faces of different pairs are kept apart by a shift on one axis: so one sweep serves many pairs.
        (one_low, one_high), (two_low, two_high) = (
            [np.stack([ends[0, face] + AXIS_SHIFT * pair, ends[1, face], ends[2, face]]) for ends in (low, high)]
            for pair, face in sides
        )
        one, two = overlapping_boxes(one_low, one_high, two_low, two_high, axis=0)
        found.append((sides[0][1][one], sides[1][1][two], two_low[0, two] < one_low[0, one]))
    one, two, before = (np.concatenate(column) for column in zip(*found, strict=True))
    # First those of which the second face begins within the first one.
    order = np.argsort(before, kind="stable")
    return one[order], two[order]


def _meet(faces: Faces, normals: Floats, one: Ints, two: Ints, tolerance: float) -> Intersections:
    """The segments of these pairs of faces that do meet: the first face cut by the second's plane, then clipped by the
    second's edges."""
    normal_one, normal_two = normals.take(one, axis=1), normals.take(two, axis=1)
    origin_one, origin_two = (faces.points.take(faces.corners[faces.offsets[f]], axis=1) for f in (one, two))
    across = cross(normal_one, normal_two)
    meet = _reaches_over(faces, two, normal_one, origin_one, tolerance) & (dot(across, across) > 0.0)
    some = np.flatnonzero(meet)
    one, two, across, normal_two, origin_two = _picked(some, one, two, across, normal_two, origin_two)
    kept = np.flatnonzero(_reaches_over(faces, one, normal_two, origin_two, tolerance))
    one, two, across, normal_two, origin_two = _picked(kept, one, two, across, normal_two, origin_two)
    start, end, cut = _cut_by_plane(faces, one, normal_two, origin_two, across, tolerance)
    one, two, start, end, normal_two = _picked(np.flatnonzero(cut), one, two, start, end, normal_two)
    low, high = _clip_by_edges(faces, two, normal_two, start, end, tolerance)
    length = np.sqrt(dot(end - start, end - start))
    met = np.flatnonzero((high - low) * length > tolerance)
    one, two, start, end, low, high = _picked(met, one, two, start, end, low, high)
    along = end - start
    return Intersections(start + low * along, start + high * along, one, two)


def _picked(which: Ints, *arrays: NDArray[Any]) -> list[NDArray[Any]]:
    """Some of the columns, or elements, of each of the arrays."""
    return [values.take(which, axis=-1) for values in arrays]


def _corners_of(faces: Faces, which: Ints) -> tuple[Ints, Ints, Ints]:
    """Positions of all corners of some faces (repeats allowed), which of them each belongs to, and where each
    starts."""
    size = faces.offsets[which + 1] - faces.offsets[which]
    starts = ragged.starts(size)
    owner = ragged.owner(size)
    return np.arange(len(owner)) - (starts - faces.offsets[which])[owner], owner, starts


def _heights(
    faces: Faces, which: Ints, normal: Floats, origin: Floats, tolerance: float
) -> tuple[Floats, Ints, Ints, Ints]:
    """Distances of the corners of some faces from planes, snapped to zero, with _corners_of."""
    position, owner, starts = _corners_of(faces, which)
    arm = faces.points.take(faces.corners[position], axis=1) - origin.take(owner, axis=1)
    return _snapped(dot(arm, normal.take(owner, axis=1)), tolerance), position, owner, starts


def _snapped(height: Floats, tolerance: float) -> Floats:
    height *= np.abs(height) > tolerance
    return height


def _reaches_over(faces: Faces, which: Ints, normal: Floats, origin: Floats, tolerance: float) -> Bools:
    """Which faces reach both sides of a plane, or have an edge in it without lying in it."""
    low, high, in_plane = _reach(faces, which, normal, origin, tolerance)
    return np.asarray((low < 0.0) & (high > 0.0) | (in_plane > 1) & (low < high), dtype=np.bool_)


def _reach(
    faces: Faces, which: Ints, normal: Floats, origin: Floats, tolerance: float
) -> tuple[Floats, Floats, NDArray[np.int8]]:
    """The lowest and the highest corner of faces over planes, and how many (2: or more) are in them."""
    size = faces.offsets[which + 1] - faces.offsets[which]
    low, high = np.full(len(which), np.inf), np.full(len(which), -np.inf)
    in_plane = np.zeros(len(which), dtype=np.int8)
    left, first = np.arange(len(which)), faces.offsets[which]
    for step in range(int(size.max(initial=0))):
        more = size[left] > step
        if not more.all():
            left, first = left[more], first[more]
            normal, origin = normal.take(np.flatnonzero(more), axis=1), origin.take(np.flatnonzero(more), axis=1)
        arm = faces.points.take(faces.corners.take(first + step), axis=1)
        arm -= origin
        height = _snapped(dot(arm, normal), tolerance)
        own = slice(None) if len(left) == len(which) else left
        low[own], high[own] = np.minimum(low[own], height), np.maximum(high[own], height)
        in_plane[own] = np.minimum(in_plane[own] + (height == 0.0), 2)
    return low, high, in_plane


def _cut_by_plane(
    faces: Faces, which: Ints, normal: Floats, origin: Floats, across: Floats, tolerance: float
) -> tuple[Floats, Floats, Bools]:
    """Where planes cut faces: ends (3,n) of the cuts, and which faces are cut at more than a point."""
    if not len(which):
        return np.zeros((3, 0)), np.zeros((3, 0)), np.zeros(0, dtype=np.bool_)
    height, position, owner, starts = _heights(faces, which, normal, origin, tolerance)
    here = faces.points.take(faces.corners[position], axis=1)
    after = ragged.following(np.append(starts, len(position)))
    step = np.where(
        height * height[after] < 0.0, height / np.where(height == height[after], 1.0, height - height[after]), 0.0
    )
    on_plane = here + step * (here.take(after, axis=1) - here)
    along = dot(on_plane, across.take(owner, axis=1))
    hit = (height == 0.0) | (height * height[after] < 0.0)
    first, last = np.where(hit, along, np.inf), np.where(hit, along, -np.inf)
    low, high = np.minimum.reduceat(first, starts), np.maximum.reduceat(last, starts)
    some = low < high
    start, end = np.zeros_like(across), np.zeros_like(across)
    for extreme, value, into in ((low, first, start), (high, last, end)):
        at = np.flatnonzero(value == extreme[owner])
        into[:, owner[at]] = on_plane.take(at, axis=1)
    lowest, highest = np.minimum.reduceat(height, starts), np.maximum.reduceat(height, starts)
    return start, end, np.asarray(some & (lowest < highest), dtype=np.bool_)


def _clip_by_edges(
    faces: Faces, which: Ints, normal: Floats, start: Floats, end: Floats, tolerance: float
) -> tuple[Floats, Floats]:
    """Parameters between which segments lying in the planes of faces are inside them."""
    low, high = np.zeros(len(which)), np.ones(len(which))
    size = faces.offsets[which + 1] - faces.offsets[which]
    for step in range(int(size.max(initial=0))):
        here = np.minimum(step, size - 1)
        there = np.where(here + 1 < size, here + 1, 0)
        a, b = (faces.points.take(faces.corners[faces.offsets[which] + place], axis=1) for place in (here, there))
        side = b - a
        inward = cross(normal, side)
        inward /= np.maximum(np.sqrt(dot(inward, inward)), LEAST_DIVISOR)
        at_start, at_end = (_snapped(dot(inward, p - a), tolerance) for p in (start, end))
        crossing = at_start * at_end < 0.0
        where = at_start / np.where(crossing, at_start - at_end, 1.0)
        low = np.where(crossing & (at_end > 0.0), np.maximum(low, where), low)
        high = np.where(crossing & (at_start > 0.0), np.minimum(high, where), high)
        high = np.where((at_start < 0.0) & (at_end <= 0.0) | (at_start <= 0.0) & (at_end < 0.0), -1.0, high)
    return low, high
