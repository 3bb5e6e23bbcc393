"""Plane polygons as unions of convex ones, convex hulls in the plane and in space, and convex faces."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.predicates import orient2d
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import FOLDED_ANGLE_SQUARED, LEAST_DIVISOR, ROUNDING, ZERO_OF_EXTENT

# Plane polygons: as unions of convex ones, and in the coordinates of their planes.


def convex_polygon_parts(outline: ArrayLike, holes: Sequence[ArrayLike] = ()) -> list[Ints]:
    """Convex polygons that together cover a plane polygon.

    outline: (n, 2) counter-clockwise.
    Edge cases: a convex outline without holes is its own part.
    Source: Glaeser, section 3.5; the joining is that of Hertel and Mehlhorn.
    """
    rings = [np.asarray(ring, dtype=np.float64).reshape(-1, 2) for ring in (outline, *holes)]
    if not len(rings) > 1 and is_convex_polygon(rings[0]):
        return [np.arange(len(rings[0]))]
    points = np.concatenate(rings)
    return _joined(points, _triangles(points, rings))


def is_convex_polygon(points: Floats) -> bool:
    """Whether a polygon turns left or goes straight on at every corner, and once round in all.

    points: (n, 2) the corners.
    """
    sides = np.roll(points, -1, axis=0) - points
    after = np.roll(sides, -1, axis=0)
    turn = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
    zero = ZERO_OF_EXTENT * norm(sides) * norm(after)
    angles = arctan2(turn, np.einsum("ij,ij->i", sides, after))
    return bool((turn >= -zero).all() and abs(angles.sum() - 2.0 * np.pi) < 1.0)


def _triangles(points: Floats, rings: list[Floats]) -> Ints:
    """(t,3) counter-clockwise triangles of a polygon with holes, as point numbers."""
    import shapely

    polygon = shapely.Polygon(rings[0], rings[1:])
    if not polygon.is_valid:
        raise InputError("a polygon crosses itself")
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
    both, number = np.unique(np.concatenate([points, corners]), axis=0, return_inverse=True)
    first = np.full(len(both), -1, dtype=np.intp)
    first[number[: len(points)]] = np.arange(len(points))
    triangles = first[number[len(points) :]].reshape(-1, 3)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    clockwise = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    triangles[clockwise] = triangles[clockwise, ::-1]
    return triangles


def _joined(points: Floats, triangles: Ints) -> list[Ints]:
    """The triangles joined to convex polygons, diagonal by diagonal."""
    polygons: dict[int, list[int]] = dict(enumerate(triangles.tolist()))
    owner = {(p[k - 1], p[k]): number for number, p in polygons.items() for k in range(3)}
    flat = points.tolist()

    def bends_left(a: int, b: int, c: int) -> bool:
        """Or goes straight on: a corner that turns back is none of a convex polygon, however thin that is."""
        (ax, ay), (bx, by), (cx, cy) = flat[a], flat[b], flat[c]
        before, after = (bx - ax, by - ay), (cx - bx, cy - by)
        zero = ZERO_OF_EXTENT * math.hypot(*before) * math.hypot(*after)
        turn = before[0] * after[1] - before[1] * after[0]
        return bool(turn > zero or (turn >= -zero and before[0] * after[0] + before[1] * after[1] > 0.0))

    for a, b in list(owner):
        left, right = owner.get((a, b)), owner.get((b, a))
        if left is None or right is None or left == right:
            continue
        p, q = polygons[left], polygons[right]
        i, j = p.index(b), q.index(a)
        # The left polygon from b round to a, then the right one between a and b.
        whole = p[i:] + p[:i] + (q[j:] + q[:j])[1:-1]
        k = len(p) - 1
        if bends_left(whole[k - 1], whole[k], whole[k + 1]) and bends_left(whole[-1], whole[0], whole[1]):
            polygons[left] = whole
            del polygons[right], owner[a, b], owner[b, a]
            for n in range(len(whole)):
                owner[whole[n - 1], whole[n]] = left
    return [np.array(polygon, dtype=np.intp) for polygon in polygons.values()]


def flattened(points: Floats, normal: Floats) -> tuple[Floats, Ints]:
    """(n,2) a planar polygon in its plane, counter-clockwise about the normal, and the numbers (n,) of its points."""
    x, y = plane_axes(normal)
    flat = matmul(points - points[0], np.stack([x, y], axis=1))
    numbers = np.arange(len(points))
    if signed_area(flat) < 0.0:
        flat, numbers = flat[::-1], numbers[::-1]
    return flat, numbers


def plane_axes(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors that span the plane across a normal; right-handed with it."""
    x = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    x = x / norm(x)
    y = np.cross(normal, x)
    return x, y / norm(y)


def signed_area(points: Floats) -> float:
    """Area of a polygon (n,2), positive if it runs counter-clockwise."""
    arm = points - points[0]
    after = np.roll(arm, -1, axis=0)
    return 0.5 * float((arm[:, 0] * after[:, 1] - arm[:, 1] * after[:, 0]).sum())


# Convex hulls in the plane, of many sets of points at once, and in space.

BOTTOM, TOP = 0, 1


def convex_hull(points: ArrayLike) -> Ints:
    """The corners of the convex hull of points in the plane, counter-clockwise from the leftmost one.

    Parameters
    ----------
    points : (n, 2 or more) array_like of float
        The first two columns count.

    Returns
    -------
    (h,) array of int
        Numbers of points; those on the hull's sides are no corners.

    Raises
    ------
    InputError
        For coordinates that are not finite, and for fewer than two columns.

    Notes
    -----
    Edge cases: two corners where all points lie on a line, one where all are the same, of which the first listed, none
    for no points.

    Source: Glaeser, section 6.1, figure 1 (Bykat); errata G6-02, G6-03.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.convex_hull([(0, 0), (2, 0), (1, 1), (2, 2), (0, 2), (1, 0)]).tolist()
    [0, 1, 3, 4]
    """
    p = np.asarray(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] < 2:
        raise InputError(f"points of a hull need two columns at least, not shape {p.shape}")
    return convex_hulls(p, np.array([0, len(p)]))[0]


def convex_hulls(points: Floats, offsets: Ints) -> tuple[Ints, Ints]:
    """The convex hulls of sets of points (n, 2 or more), set i offsets[i] to offsets[i+1]: corners (h,) and their
    offsets, see convex_hull. Round by round the point farthest outside each side becomes a corner; sides are decided
    exactly.
    Source: Bykat, Convex hull of a finite set of points in two dimensions (1978); Glaeser, section 6.1.
    """
    p = np.ascontiguousarray(points[:, :2], dtype=np.float64)
    if not np.isfinite(p).all():
        raise InputError("a coordinate is not a finite number")
    owner = ragged.owner(np.diff(offsets))
    by_place = np.lexsort((np.arange(len(p)), p[:, 1], p[:, 0], owner))
    filled = np.flatnonzero(np.diff(offsets))
    least, most = by_place[offsets[:-1][filled]], by_place[offsets[1:][filled] - 1]
    wide = (p[least] != p[most]).any(axis=1)
    corners, chains = [least, most[wide]], [np.full(len(least), BOTTOM), np.full(int(wide.sum()), TOP)]
    found, chain = _outermost(p, owner, least[wide], most[wide], filled[wide])
    corner, chain = np.concatenate([*corners, found]), np.concatenate([*chains, chain])
    return _without_flat_corners(p, owner, corner[_around(p, owner, corner, chain)], len(offsets) - 1)


def _outermost(p: Floats, owner: Ints, least: Ints, most: Ints, filled: Ints) -> tuple[Ints, Ints]:
    """Corners between the leftmost and the rightmost point of each set, and the chain, bottom or top, of each."""
    start, end = np.concatenate([least, most]), np.concatenate([most, least])
    chain = np.repeat([BOTTOM, TOP], len(least))
    # Each point is tried below the line from left to right, and above it.
    number = np.full(int(owner.max(initial=-1)) + 1, -1, dtype=np.intp)
    number[filled] = np.arange(len(filled))
    candidates = np.flatnonzero(number[owner] >= 0)
    point = np.concatenate([candidates, candidates])
    side = np.concatenate([number[owner[candidates]], number[owner[candidates]] + len(least)])
    corners, chains = [], []
    while len(point):
        outside = orient2d(p[start[side]], p[end[side]], p[point]) < 0
        point, side = point[outside], side[outside]
        used, farthest = _farthest(p, start, end, point, side)
        corners.append(farthest)
        chains.append(chain[used])
        number = np.full(len(start), -1, dtype=np.intp)
        number[used] = np.arange(len(used))
        near_start = orient2d(p[start[side]], p[farthest[number[side]]], p[point]) < 0
        side = number[side] + np.where(near_start, 0, len(used))
        start, end = np.concatenate([start[used], farthest]), np.concatenate([farthest, end[used]])
        chain = np.concatenate([chain[used], chain[used]])
    none = np.zeros(0, dtype=np.intp)
    return np.concatenate([none, *corners]), np.concatenate([none, *chains])


def _farthest(p: Floats, start: Ints, end: Ints, point: Ints, side: Ints) -> tuple[Ints, Ints]:
    """The sides that have points outside, and the farthest point of each; of equally far ones the last along it."""
    along = p[end[side]] - p[start[side]]
    arm = p[point] - p[start[side]]
    away = along[:, 1] * arm[:, 0] - along[:, 0] * arm[:, 1]
    order = np.lexsort(((along * arm).sum(axis=1), away, side))
    last = np.flatnonzero(np.append(side[order][1:] != side[order][:-1], True)[: len(order)])
    return side[order[last]], point[order[last]]


def _around(p: Floats, owner: Ints, corner: Ints, chain: Ints) -> Ints:
    """The order of corners by sets and around each: the bottom chain to the right, the top chain to the left."""
    sign = np.where(chain == BOTTOM, 1.0, -1.0)
    return np.lexsort((sign * p[corner, 1], sign * p[corner, 0], chain, owner[corner]))


def _without_flat_corners(p: Floats, owner: Ints, corner: Ints, count: int) -> tuple[Ints, Ints]:
    """The corners (h,) without those where a hull does not turn left, and the offsets of the hulls."""
    while True:
        offsets = np.searchsorted(owner[corner], np.arange(count + 1))
        sizes = np.repeat(np.diff(offsets), np.diff(offsets))
        position = np.arange(len(corner))
        first, last = (np.repeat(end, np.diff(offsets)) for end in (offsets[:-1], offsets[1:] - 1))
        before, after = np.where(position == first, last, position - 1), np.where(position == last, first, position + 1)
        flat = (sizes > 2) & (orient2d(p[corner[before]], p[corner], p[corner[after]]) <= 0)
        if not flat.any():
            return corner, offsets
        corner = corner[~flat]


def hull_mesh(points: ArrayLike) -> Mesh:
    """The convex hull of points in space as a polyhedron.

    Parameters
    ----------
    points : (n, 3) array_like of float
        Four or more, not in one plane.

    Returns
    -------
    Mesh
        Its vertices, in the order of the points, and its faces, whole polygons, counter-clockwise from outside.

    Raises
    ------
    InputError
        For fewer than four points, coordinates that are not finite, points in one plane.

    Notes
    -----
    Triangles whose planes are the same within a thousand-millionth of the extent are one face.

    Source: Barber, Dobkin and Huhdanpaa, The quickhull algorithm for convex hulls (1996), as scipy has it.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> base, top, inside = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], (0.5, 0.5, 1), (0.5, 0.5, 0.2)
    >>> pyramid = geometry.hull_mesh([*base, top, inside])
    >>> len(pyramid.vertices), sorted(pyramid.face_sizes.tolist())
    (5, [3, 3, 3, 3, 4])
    """
    from scipy.spatial import ConvexHull, QhullError

    p = np.asarray(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1:] != (3,) or len(p) < 4 or not np.isfinite(p).all():
        raise InputError("a hull in space needs four points at least, of three finite coordinates")
    low, high = p.min(axis=0), p.max(axis=0)
    unit = (p - (low + high) / 2.0) / (float((high - low).max()) or 1.0)
    try:
        hull = ConvexHull(unit)
    except QhullError:
        raise InputError("the points lie in one plane: they have no hull in space") from None
    triangles = np.asarray(hull.simplices, dtype=np.intp)
    a, b, c = unit[triangles.T]
    inwards = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    triangles[inwards] = triangles[inwards][:, ::-1]
    corners, offsets = _merged(triangles, _planes(hull.equations, hull.neighbors))
    used, corners = np.unique(corners, return_inverse=True)
    return Mesh(p[used], corners, offsets)


def _planes(equations: Floats, neighbours: Ints) -> Ints:
    """(t,) a number for each triangle, the same for neighbours in one plane."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    here = np.repeat(np.arange(len(neighbours)), neighbours.shape[1])
    there = neighbours.ravel()
    same = (np.abs(equations[here] - equations[there]) <= ZERO_OF_EXTENT).all(axis=1)
    links = coo_array((np.ones(int(same.sum())), (here[same], there[same])), shape=(len(equations),) * 2)
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)


def _merged(triangles: Ints, face: Ints) -> tuple[Ints, Ints]:
    """Corners and offsets of the polygons that triangles of the same face form: their borders, walked along all at
    once."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    owner, count = np.repeat(face, 3), int(triangles.max()) + 1
    key, back = (owner * count + start) * count + end, (owner * count + end) * count + start
    outer = ~np.isin(key, back)
    start, end, owner = start[outer], end[outer], owner[outer]
    place = np.argsort(owner * count + start, kind="stable")
    keys = (owner * count + start)[place]
    following = np.searchsorted(keys, (owner * count + end)[place])
    sizes = np.bincount(owner)
    offsets = ragged.offsets(sizes)
    here, corners = offsets[:-1].copy(), np.empty(len(start), dtype=np.intp)
    for step in range(int(sizes.max())):
        left = np.flatnonzero(sizes > step)
        corners[offsets[left] + step] = start[place[here[left]]]
        here[left] = following[here[left]]
    return corners, offsets


# Polygonal faces as planar convex ones: what hides must be convex.


@dataclass(frozen=True, eq=False)
class ConvexFaces:
    """Planar convex faces: corners (c,), offsets (f+1,); source (f,): the face each one is (a part of); inner (c,):
    the side from this corner to the next is a diagonal, not an edge of the source."""

    corners: Ints
    offsets: Ints
    source: Ints
    inner: Bools


def convex_faces(points: Floats, corners: Ints, offsets: Ints, tolerance: float) -> ConvexFaces:
    """Faces with every polygon that is not planar and convex cut into triangles. points (3,v); planar: no corner
    further than tolerance from the mean plane. Quadrilaterals are cut along a diagonal that folds neither triangle
    (the shorter if both do), others by a constrained Delaunay triangulation in the mean plane.
    Edge cases: a hole joined to the border by a bridge without width stays a hole; a polygon that crosses itself is cut
    as a fan, with an InputWarning.
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
