"""Where faces of different shapes, or of different parts of one, pierce each other."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.meshes.edges import Faces, unit_normals
from vectorplot.geometry import ragged, records
from vectorplot.geometry.bounds.boxes import overlapping_boxes, overlapping_pairs
from vectorplot.geometry.chunks import mapped, slices
from vectorplot.geometry.columns import cross, dot, first_of_equal
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

SLIM_FACES, FEWEST_PAIRS = 12, 1024
"""Parts of so few faces are looked at more closely where so many pairs of boxes overlap."""

FACES_AT_ONCE = 1 << 15
"""Pairs of faces, or of slim parts, looked at at once."""

AXIS_SHIFT = 16.0
"""Coordinates stay below this; pairs of parts are kept apart on a sweep's axis by multiples of it."""


@dataclass(frozen=True, eq=False)
class Intersections:
    """Segments in which two faces meet.

    Parameters
    ----------
    start, end : (3, n) array of float
        Their ends, in the coordinates of the faces.
    one, two : (n,) array of int
        The two faces.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features
    >>> points = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0), (0, -1, -1), (0, 1, -1), (0, 0, 1)], dtype=float)
    >>> faces = features.Faces(points.T, np.arange(6), np.array([0, 3, 6]), np.zeros(6, bool), np.ones(2, np.int8))
    >>> meeting = features.face_intersections(faces, np.array([0, 1]), tolerance=1e-9)
    >>> isinstance(meeting, features.Intersections), meeting.one.tolist(), meeting.two.tolist()
    (True, [0], [1])
    """

    start: Floats = field(metadata=IN_COLUMNS)
    end: Floats = field(metadata=IN_COLUMNS)
    one: Ints
    two: Ints


def face_intersections(faces: Faces, part: Ints, tolerance: float) -> Intersections:
    """The segments in which convex faces of different parts meet.

    Parameters
    ----------
    faces : Faces
        Convex, or cut so that they are.
    part : (f,) array of int
        Faces with the same number are not compared.
    tolerance : float
        A distance below that is zero, in the units of the points.

    Returns
    -------
    Intersections
        start and end (3, n) of the segments, and the two faces one and two (n,) of each.

    Notes
    -----
    A face that only touches the other's plane with an edge counts, one that lies in it does not. Of equal segments the
    first one stays.

    Source: Glaeser, section 1.3, equations 21 and 22; errata G1-01 to G1-03.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features
    >>> points = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0), (0, -1, -1), (0, 1, -1), (0, 0, 1)], dtype=float)
    >>> faces = features.Faces(points.T, np.arange(6), np.array([0, 3, 6]), np.zeros(6, bool), np.ones(2, np.int8))
    >>> meeting = features.face_intersections(faces, np.array([0, 1]), tolerance=1e-9)
    >>> sorted([meeting.start[1, 0], meeting.end[1, 0]]) == [-0.5, 0.5]
    True
    """
    none = np.zeros((3, 0))
    found = [Intersections(none, none, np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    one, two = _pairs_of_faces(faces, part, tolerance)
    chunks = slices(len(one), FACES_AT_ONCE)
    normals = _normals_of(faces, one, two)
    found.extend(mapped(lambda some: _meet(faces, normals, one[some], two[some], tolerance), chunks))
    whole = records.joined(found)
    return records.some(whole, _first_of_equal(whole.start, whole.end, tolerance))


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
    sides = []
    for which in (a, b):
        size = first[which + 1] - first[which]
        pair = ragged.owner(size)
        face = by_part[np.arange(len(pair)) - np.repeat(ragged.starts(size) - first[which], size)]
        near = np.ones(len(pair), dtype=np.bool_)
        for axis in range(3):
            near &= low[axis, face] <= common_high[axis, pair]
            near &= high[axis, face] >= common_low[axis, pair]
        sides.append((pair[near], face[near]))
    # Faces of different pairs are kept apart by a shift on one axis: so one sweep serves all pairs.
    (one_low, one_high), (two_low, two_high) = (
        [np.stack([ends[0, face] + AXIS_SHIFT * pair, ends[1, face], ends[2, face]]) for ends in (low, high)]
        for pair, face in sides
    )
    one, two = overlapping_boxes(one_low, one_high, two_low, two_high, axis=0)
    return sides[0][1][one], sides[1][1][two]


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
    return np.asarray((low < 0.0) & (high > 0.0) | (in_plane > 1) & (low < high), dtype=np.bool_)


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
