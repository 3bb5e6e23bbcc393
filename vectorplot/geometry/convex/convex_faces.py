"""Polygonal faces as planar convex ones: what hides must be convex."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.columns import cross, dot
from vectorplot.geometry.elementary import arctan2
from vectorplot.tolerances.of_angles import FOLDED_ANGLE_SQUARED
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR, ROUNDING


@dataclass(frozen=True, eq=False)
class ConvexFaces:
    """Planar convex faces: corners (c,), offsets (f+1,); source (f,): the face each one is (a part of); inner (c,):
    the side from this corner to the next is a diagonal, not an edge of the source."""

    corners: Ints
    offsets: Ints
    source: Ints
    inner: Bools


def convex_faces(points: Floats, corners: Ints, offsets: Ints, tolerance: float) -> ConvexFaces:
    """Faces with every polygon that is not planar and convex cut into triangles.

    points (3,v); a polygon is planar where no corner is further than tolerance from its mean plane. Quadrilaterals are
    cut along a diagonal that folds neither triangle over (the shorter one if both do), larger polygons by a constrained
    Delaunay triangulation in their mean plane.
    Degenerate: a hole that a bridge of no width joins to the border stays a hole; a polygon that crosses itself is cut
    as a fan and reported by an InputWarning.
    """
    sizes = np.diff(offsets)
    faces = np.arange(len(sizes))
    if not len(sizes) or sizes.max() == 3:
        return ConvexFaces(corners, offsets, faces, np.zeros(len(corners), dtype=np.bool_))
    bad = np.zeros(len(sizes), dtype=np.bool_)
    met = np.flatnonzero(np.bincount(sizes))
    for size in met[met > 3].tolist():
        same = np.flatnonzero(sizes == size)
        corner = [corners[offsets[same] + k] for k in range(size)]
        bad[same] = ~_planar_convex([points[:, c] for c in corner], tolerance)
    if not bad.any():
        return ConvexFaces(corners, offsets, faces, np.zeros(len(corners), dtype=np.bool_))
    kept = np.repeat(~bad, sizes)
    quads = np.flatnonzero(bad & (sizes == 4))
    more = np.flatnonzero(bad & (sizes > 4))
    quad_triangles, quad_inner = _cut_quads(points, corners[offsets[quads][:, None] + np.arange(4)])
    triangles, inner, source = _cut_polygons(points, corners, offsets, more)
    all_sizes = np.concatenate([sizes[~bad], np.full(len(quad_triangles) + len(triangles), 3)])
    all_source = np.concatenate([faces[~bad], np.repeat(quads, 2), source])
    all_corners = np.concatenate([corners[kept], quad_triangles.ravel(), triangles.ravel()])
    all_inner = np.concatenate([np.zeros(int(kept.sum()), dtype=np.bool_), quad_inner.ravel(), inner.ravel()])
    order = np.argsort(all_source, kind="stable")
    ends = ragged.offsets(all_sizes)
    positions, starts, _ = _runs(ends, order)
    return ConvexFaces(all_corners[positions], starts, all_source[order], all_inner[positions])


def _runs(offsets: Ints, faces: Ints) -> tuple[Ints, Ints, Ints]:
    """Positions of the corners of some faces, where each face starts in them, and the face (0, 1, ...) of each."""
    sizes = offsets[faces + 1] - offsets[faces]
    starts = ragged.offsets(sizes)
    owner = ragged.owner(sizes)
    return ragged.ranges(offsets[faces], sizes), starts, owner


def _planar_convex(p: list[Floats], tolerance: float) -> Bools:
    """Which polygons of one size, given by their first, second, ... corners (3,n), are planar and convex."""
    side = [after - here for here, after in zip(p, [*p[1:], p[0]], strict=True)]
    turn = [cross(here, after) for here, after in zip([side[-1], *side[:-1]], side, strict=True)]
    normal = cross(p[1] - p[0], p[2] - p[0])
    for k in range(3, len(p)):
        normal = normal + cross(p[k - 1] - p[0], p[k] - p[0])
    longest = np.max([dot(s, s) for s in side], axis=0)
    # The two halves of a bow tie cancel out.
    has_area = np.sqrt(dot(normal, normal)) > ROUNDING * longest
    normal = normal / np.maximum(np.sqrt(dot(normal, normal)), LEAST_DIVISOR)
    planar = np.ones(normal.shape[1], dtype=np.bool_)
    left = np.ones(normal.shape[1], dtype=np.bool_)
    length = [np.sqrt(dot(s, s)) for s in side]
    for k in range(len(p)):
        planar &= np.abs(dot(p[k] - p[0], normal)) <= tolerance
        left &= dot(turn[k], normal) >= -tolerance * np.maximum(length[k - 1], length[k])
    if len(p) == 4:
        return np.asarray(planar & left & has_area, dtype=np.bool_)
    angle = sum(arctan2(dot(turn[k], normal), dot(side[k - 1], side[k])) for k in range(len(p)))
    return np.asarray(planar & left & (angle < 3.0 * np.pi), dtype=np.bool_)


def _cut_quads(points: Floats, quads: Ints) -> tuple[Ints, Bools]:
    """Two triangles (2q,3) for each quadrilateral (q,4), and which of their sides is the diagonal."""
    if not len(quads):
        return np.zeros((0, 3), dtype=np.intp), np.zeros((0, 3), dtype=np.bool_)
    p = points[:, quads]
    mean = np.cross(p[:, :, 2] - p[:, :, 0], p[:, :, 3] - p[:, :, 1], axis=0)

    def folds(a: int, b: int, c: int) -> Bools:
        normal = np.cross(p[:, :, b] - p[:, :, a], p[:, :, c] - p[:, :, a], axis=0)
        return np.asarray((normal * mean).sum(axis=0) <= 0.0, dtype=np.bool_)

    crossing = int(_crossing_quads(p).sum())
    if crossing:
        warnings.warn(f"{crossing} faces cross themselves: cut along a diagonal", InputWarning, stacklevel=4)
    first_bad, second_bad = folds(0, 1, 2) | folds(0, 2, 3), folds(1, 2, 3) | folds(1, 3, 0)
    first = ((p[:, :, 2] - p[:, :, 0]) ** 2).sum(axis=0) <= ((p[:, :, 3] - p[:, :, 1]) ** 2).sum(axis=0)
    use_first = np.where(first_bad == second_bad, first, second_bad)
    turned = np.where(use_first[:, None], quads, np.roll(quads, -1, axis=1))
    triangles = np.stack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]], axis=1).reshape(-1, 3)
    return triangles, np.tile(np.array([[False, False, True], [True, False, False]]), (len(quads), 1))


def _crossing_quads(p: Floats) -> Bools:
    """(q,) which plane quadrilaterals (3,q,4) cross themselves: along either diagonal their halves lie over each
    other."""
    halves = [(0, 1, 2), (0, 2, 3), (1, 2, 3), (1, 3, 0)]
    normals = np.stack([cross(p[:, :, b] - p[:, :, a], p[:, :, c] - p[:, :, a]) for a, b, c in halves])
    sizes = (normals * normals).sum(axis=1)
    largest = normals[sizes.argmax(axis=0), :, np.arange(p.shape[1])]
    size = np.maximum(sizes.max(axis=0), LEAST_DIVISOR)
    heights = np.einsum("hkq,qk->hq", normals, largest) / size
    # Halves of a quadrilateral in space turn away from the plane of the largest one.
    plane = (heights * heights >= (1.0 - FOLDED_ANGLE_SQUARED) * sizes / size).all(axis=0)
    one, two, three, four = heights
    return np.asarray((one * two < 0.0) & (three * four < 0.0) & plane, dtype=np.bool_)


def _cut_polygons(points: Floats, corners: Ints, offsets: Ints, faces: Ints) -> tuple[Ints, Bools, Ints]:
    """Triangles of larger polygons: (t,3) vertices, which sides are diagonals, and the face each belongs to."""
    if not len(faces):
        return np.zeros((0, 3), dtype=np.intp), np.zeros((0, 3), dtype=np.bool_), faces
    import shapely

    positions, starts, owner = _runs(offsets, faces)
    flat = _in_mean_plane(points[:, corners[positions]], starts, owner)
    ring_points, ring_of = _closed(flat, starts, owner)
    polygons = shapely.polygons(shapely.linearrings(ring_points, indices=ring_of))
    touching = ~shapely.is_valid(polygons)
    # A hole on a bridge of no width makes a ring that touches itself: the same polygon, with a hole.
    polygons[touching] = shapely.make_valid(polygons[touching])
    parts, part_of = shapely.get_parts(shapely.constrained_delaunay_triangles(polygons), return_index=True)
    corner_of = _nearest_corner(shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3], part_of, flat, owner)
    # Where the ring crosses itself there are triangles with corners that the polygon does not have.
    sound = np.bincount(part_of, minlength=len(faces)) > 0
    sound[part_of[(corner_of < 0).any(axis=1)]] = False
    local, part_of = _counter_clockwise(corner_of[sound[part_of]], flat), part_of[sound[part_of]]
    if not sound.all():
        warnings.warn(f"{int((~sound).sum())} faces cross themselves: cut as fans", InputWarning, stacklevel=4)
        fans, fan_of = ragged.fans(starts)
        crossed = ~sound[fan_of]
        local, part_of = np.concatenate([local, fans[crossed]]), np.concatenate([part_of, fan_of[crossed]])
    following = ragged.following(starts)
    inner = following[local] != np.roll(local, -1, axis=1)
    if touching.any():
        some = touching[part_of]
        inner[some] = _inside_ring(local[some], flat, owner, following)
    return corners[positions][local], inner, faces[part_of]


def _inside_ring(local: Ints, flat: Floats, owner: Ints, following: Ints) -> Bools:
    """(t,3) whether sides of triangles are no sides of their polygon, or bridges: sides it has in both directions."""
    _, place = np.unique(np.column_stack([owner, flat]), axis=0, return_inverse=True)
    place = place.ravel()
    ring = place * len(place) + place[following]
    ring = ring[~np.isin(ring, place[following] * len(place) + place)]
    side = place[local] * len(place) + np.roll(place[local], -1, axis=1)
    return ~np.isin(side, ring)


def _in_mean_plane(p: Floats, starts: Ints, owner: Ints) -> Floats:
    """(c,2) coordinates of polygon corners in their polygon's mean plane, counter-clockwise."""
    following = ragged.following(starts)
    arm = p - p[:, starts[:-1]][:, owner]
    normal = np.add.reduceat(np.cross(arm, arm[:, following], axis=0), starts[:-1], axis=1)
    normal = normal / np.maximum(np.sqrt((normal * normal).sum(axis=0)), LEAST_DIVISOR)
    helper = np.eye(3)[np.argmin(np.abs(normal), axis=0)].T
    u = np.cross(helper, normal, axis=0)
    u = u / np.sqrt(np.maximum((u * u).sum(axis=0), LEAST_DIVISOR))
    w = np.cross(normal, u, axis=0)
    return np.stack([(arm * u[:, owner]).sum(axis=0), (arm * w[:, owner]).sum(axis=0)], axis=1)


def _closed(flat: Floats, starts: Ints, owner: Ints) -> tuple[Floats, Ints]:
    """Ring coordinates with each first point repeated, and the ring each belongs to."""
    order = np.insert(np.arange(len(owner)), starts[1:], starts[:-1])
    return flat[order], np.insert(owner, starts[1:], np.arange(len(starts) - 1))


def _nearest_corner(triangles: Floats, part_of: Ints, flat: Floats, owner: Ints) -> Ints:
    """(t,3) the polygon corners that have exactly these coordinates; -1 where there is none."""
    asked = np.column_stack([np.repeat(part_of, 3), triangles.reshape(-1, 2)])
    known = np.column_stack([owner, flat])
    both = np.concatenate([known, asked])
    _, label = np.unique(both, axis=0, return_inverse=True)
    label = label.ravel()
    first = np.full(int(label.max()) + 1, -1, dtype=np.intp)
    first[label[: len(known)][::-1]] = np.arange(len(known))[::-1]
    return np.asarray(first[label[len(known) :]].reshape(-1, 3), dtype=np.intp)


def _counter_clockwise(local: Ints, flat: Floats) -> Ints:
    a, b, c = (flat[local[:, k]] for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return np.where(area[:, None] < 0.0, local[:, ::-1], local)
