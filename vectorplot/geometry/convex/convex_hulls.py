"""Convex hulls in the plane, of many sets of points at once, and in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.exact.predicates import orient2d
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

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
    Degenerate: two corners where all points lie on a line, one where all are the same, of which the first listed, none
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
    """The convex hulls of many sets of points: set i has the points offsets[i] to offsets[i+1] of points (n, 2 or more
    columns). Returns the corners of all hulls (h,), as indices into points, and their offsets; each as of convex_hull.

    All sets are worked on at once: round by round the point that is farthest outside each side becomes a corner. On
    which side a point lies is decided exactly.
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
