"""Contour polygons in space, edges joined to branches, polygons made counter-clockwise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.exact.predicates import polygon_orientation
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances import ROUNDING


@dataclass(frozen=True, eq=False)
class Branches:
    """Polylines of vertex indices.

    points: (p,) of all branches, one after the other; offsets: (b+1,) branch i has the points offsets[i] to
    offsets[i+1]; closed: (b,) the last point joins the first, which is not repeated.
    """

    points: Ints
    offsets: Ints
    closed: Bools

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, index: int) -> Ints:
        return self.points[self.offsets[index] : self.offsets[index + 1]]


def counterclockwise(polygon: ArrayLike) -> Floats:
    """The polygon (n, 2 or more columns) with its points in counter-clockwise order in x and y, the first one staying
    first.

    The sign of its area is exact, so tiny areas far from the origin are turned the right way too.
    Edge cases: a polygon of area zero stays as it is. Source: Glaeser, section 6.1; errata G6-03, G6-08.
    """
    p = np.asarray(polygon, dtype=np.float64)
    return np.concatenate([p[:1], p[:0:-1]]) if polygon_orientation(p) < 0 else p


def concat(edges: ArrayLike) -> Branches:
    """The branches, open or closed, that edges (e, 2) of vertex indices form when joined end to end, each edge used
    once.

    A branch runs forward along the edge of it that is listed first, a closed one starts there; branches come in the
    order of these edges. At a vertex where more than two edges meet they are joined in pairs, in the order of the
    list, heads to tails as far as possible.
    Edge cases: edges from a vertex to itself are left out.
    Source: Glaeser, sections 6.1 and 8.4; erratum G8-11.
    """
    pairs = np.asarray(edges, dtype=np.intp).reshape(-1, 2)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    if not len(pairs):
        return Branches(np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_))
    # A dart 2 e + s runs along edge e, starting at its end s; darts follow one another where ends are joined.
    following = _joined_ends(pairs)[np.arange(2 * len(pairs)) ^ 1]
    chain, first_edge, closed = _chains(following)
    # A branch is found twice, once each way; the way that runs forward along its first edge is kept.
    kept = np.flatnonzero(chain[2 * first_edge] == chain)
    rank = _ranks(following, closed, first_edge)[kept]
    # Ranks count the darts still to come.
    order = kept[np.lexsort((-rank, first_edge[kept]))]
    return _branches(pairs, order, first_edge[order], closed[order])


def _branches(pairs: Ints, darts: Ints, branch: Ints, closed: Bools) -> Branches:
    """Branches from their darts in order: the start of every dart, and of open branches the end of the last."""
    start = pairs[darts >> 1, darts & 1]
    last = np.concatenate([branch[1:] != branch[:-1], [True]])
    copies = 1 + (last & ~closed)
    points = np.repeat(start, copies)
    ends = np.cumsum(copies)
    opened = last & ~closed
    points[ends[opened] - 1] = pairs[darts[opened] >> 1, 1 - (darts[opened] & 1)]
    return Branches(points, np.concatenate([[0], ends[last]]), closed[last])


def _joined_ends(pairs: Ints) -> Ints:
    """(2 e,) for the end s of edge e, number 2 e + s, the end it is joined to at their vertex, or -1."""
    ends = np.arange(2 * len(pairs))
    vertex, side = pairs.ravel(), ends & 1
    rank = _ranks_within(2 * vertex + side)
    tails, heads = (np.bincount(pairs[:, s], minlength=int(pairs.max()) + 1) for s in (0, 1))
    matched = np.minimum(tails, heads)[vertex]
    # Heads go with tails of the same rank; what is left over of one sort goes by twos.
    group = np.where(rank < matched, rank, matched + (rank - matched) // 2)
    order = np.lexsort((group, vertex))
    same = (vertex[order][1:] == vertex[order][:-1]) & (group[order][1:] == group[order][:-1])
    joined = np.full(len(ends), -1)
    joined[order[:-1][same]] = order[1:][same]
    joined[order[1:][same]] = order[:-1][same]
    return joined


def _ranks_within(keys: Ints) -> Ints:
    """(n,) how many equal keys stand before each."""
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    starts = np.concatenate([[True], ordered[1:] != ordered[:-1]])
    position = np.arange(len(keys))
    rank = np.zeros(len(keys), dtype=np.intp)
    rank[order] = position - np.maximum.accumulate(np.where(starts, position, 0))
    return rank


def _chains(following: Ints) -> tuple[Ints, Ints, Bools]:
    """(n,) a dart that stands for the chain of each dart, the smallest edge in the chain, and whether the chain is
    closed.

    Source: pointer jumping.
    """
    here = np.arange(len(following))
    jump = np.where(following < 0, here, following)
    least = here.copy()
    for _ in range(len(following).bit_length()):
        least = np.minimum(least, least[jump])
        jump = jump[jump]
    closed = following[jump] >= 0
    # An open chain saw only what comes after each dart: gather at its last dart.
    smallest = here.copy()
    np.minimum.at(smallest, jump[~closed], least[~closed])
    return np.where(closed, least, jump), np.where(closed, least, smallest[jump]) >> 1, np.asarray(closed)


def _ranks(following: Ints, closed: Bools, first_edge: Ints) -> Ints:
    """(n,) how many darts come after each in its chain; closed chains are cut before their first edge's dart."""
    cut = closed & (following == 2 * first_edge)
    here = np.arange(len(following))
    jump = np.where((following < 0) | cut, here, following)
    rank = (jump != here).astype(np.intp)
    for _ in range(len(following).bit_length()):
        rank = rank + rank[jump]
        jump = jump[jump]
    return np.asarray(rank)


def contour_edges(mesh: Mesh, centre: ArrayLike) -> Ints:
    """The edges of a mesh between a face that shows its outside and one that does not.

    centre: (3,) the eye or lamp; result: (e, 2) indices of vertices, the front face on the left.
    Source: Glaeser, section 6.1; erratum G6-01.
    """
    whole = closed_by_borders(mesh)
    front = _faces_towards(whole, np.asarray(centre, dtype=np.float64))[whole.corner_face]
    a, b = whole.corners[front], whole.corners[whole.next_corner[front]]
    return np.stack([a, b], axis=1)[~_has_reverse(a, b, len(mesh.vertices))]


def closed_by_borders(mesh: Mesh) -> Mesh:
    """The mesh with one more face for every closed border, wound as its neighbours demand; all faces are present.

    Source: Glaeser, section 6.1 (single polygons, removed faces).
    """
    a, b = mesh.corners, mesh.corners[mesh.next_corner]
    single = ~_has_reverse(a, b, len(mesh.vertices))
    borders = concat(np.stack([b[single], a[single]], axis=1))
    kept = borders.closed & (np.diff(borders.offsets) >= 3)
    sizes = np.diff(borders.offsets)
    corners = np.concatenate([mesh.corners, borders.points[np.repeat(kept, sizes)]])
    offsets = np.concatenate([mesh.offsets, len(mesh.corners) + np.cumsum(sizes[kept])])
    return Mesh(mesh.vertices, corners, offsets)


def _has_reverse(a: Ints, b: Ints, count: int) -> Bools:
    """(e,) which directed edges a->b also run b->a in the list."""
    return np.isin(a * count + b, b * count + a)


def _faces_towards(mesh: Mesh, centre: Floats) -> Bools:
    """(f,) the faces that show their outside to an eye, or to a direction (x, y, z, 0)."""
    area = mesh.area_vectors
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    ray = np.broadcast_to(centre[:3], first.shape) if len(centre) == 4 else centre - first
    size = np.sqrt((area * area).sum(axis=1))
    largest = float(np.abs(mesh.vertices).max(initial=0.0))
    # An offset of the scene costs digits of the normal: as many as the face is smaller than its coordinates.
    noise = ROUNDING * (1.0 + largest / np.sqrt(np.where(size > 0.0, size, 1.0)))
    return np.asarray((area * ray).sum(axis=1) > noise * size * np.sqrt((ray * ray).sum(axis=1)))


def spatial_hull(mesh: Mesh, centre: ArrayLike) -> Ints:
    """The contour polygon in space of a polyhedron with a convex outline.

    Parameters
    ----------
    mesh : Mesh
        A convex body, or what looks like one.
    centre : (3,) or (4,) array_like of float
        As of contour_edges.

    Returns
    -------
    (k,) array of int
        Indices of vertices, counter-clockwise as seen from the eye or lamp. The image of the polygon is the convex hull
        of the images of all vertices.

    Raises
    ------
    InputError
        Where the contour has several branches: then there is no such outline.

    Notes
    -----
    Edge cases: no points for an eye inside, or a single polygon seen edge-on.

    Source: Glaeser, section 6.1; erratum G6-01.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> len(geometry.spatial_hull(geometry.box((2, 2, 2)), centre=(9, 8, 7)))
    6
    """
    contour = concat(contour_edges(mesh, centre))
    if len(contour) > 1:
        raise InputError(f"the contour has {len(contour)} branches: the outline is not that of a convex polyhedron")
    return contour.points


def contour_branches(mesh: Mesh, centre: ArrayLike) -> Branches:
    """The contour of any polyhedron, joined to closed branches: a faceted torus has two.

    centre: (3,) as of contour_edges.
    Source: Glaeser, section 6.1.
    """
    return concat(contour_edges(mesh, centre))
