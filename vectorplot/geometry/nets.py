"""Nets of polyhedra: faces unfolded into the plane along a spanning tree, in pieces that do not overlap."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import DIRECTIONS
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.convex_bodies import split_faces
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.regions import polygons_of
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.solids import zero_distance
from vectorplot.geometry.vectors import component_sum, cross, dot, norm
from vectorplot.geometry.winding import edge_uses, face_barycentres
from vectorplot.tolerances import LEAST_DIVISOR, SAME_SCORE

MOST_FACES = 50_000
"""A net of more faces is nothing that anybody cuts out."""

FEW_FACES, FEW_TREES = 512, 3
"""Of meshes of more than so few faces so few trees are tried, and none any more once there is one piece."""


GRID_OF_TOLERANCE = 0.125
"""What faces have in common is measured on a grid as fine as this part of the tolerance."""


@dataclass(frozen=True, eq=False)
class Net:
    """The faces of a mesh in the plane.

    mesh: with planar convex faces; frames (f,2,3), origins (f,3): the axes of each face in space, and a point of it;
    turns (f,2): cosine and sine by which it is turned in the plane; shifts (f,2): where its origin lies then; piece
    (f,): what it hangs together with; first, second (e,): the corners from which the edges between two faces run, one
    in each; angle (e,): by how much faces turn there, positive where the edge stands out; joined (e,): whether the
    faces lie side by side along it; gap: how far apart corners are at most that count as one, in world units.
    """

    mesh: Mesh
    frames: Floats
    origins: Floats
    turns: Floats
    shifts: Floats
    piece: Ints
    first: Ints
    second: Ints
    angle: Floats
    joined: Bools
    gap: float

    def placed(self, points: Floats, faces: Ints) -> Floats:
        """(n,2) where points (n,3) of faces (n,) lie in the plane of their piece."""
        arm = points - self.origins[faces]
        x, y = (dot(arm, self.frames[faces, row]) for row in (0, 1))
        cosine, sine = self.turns[faces].T
        turned = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=1)
        return np.asarray(turned + self.shifts[faces])

    @property
    def corners(self) -> Floats:
        """(c,2) where the corners of the faces lie."""
        return self.placed(self.mesh.vertices[self.mesh.corners], self.mesh.corner_face)


def net_of(mesh: Mesh, tolerance: float = 0.0) -> Net:
    """The net of a mesh: as few pieces as are found, then as little to cut.

    tolerance: corners so near in the plane, in world units, count as one: so meshes of developable surfaces unroll
    without cuts.
    Errors: InputError for a mesh without faces, and for too many.
    Edge cases: edges of more than two faces, or of faces that do not agree about the outside, are cut. Where all trees
    that are tried overlap, that with the fewest pieces is cut once more.
    Source: Schlickenrieder (1997), Nets of polyhedra; Straub and Prautzsch (2011), Creating optimized cut-out sheets
    for paper models from meshes.
    """
    mesh = of_convex_faces(mesh)
    if not mesh.face_count:
        raise InputError("a mesh without faces has no development")
    if mesh.face_count > MOST_FACES:
        raise InputError(f"{mesh.face_count} faces: a net has {MOST_FACES} at most")
    flat = _unfoldable(mesh)
    allowed = tolerance + zero_distance(mesh.vertices)
    best, lowest = None, (np.inf, np.inf)
    whole = max(float(_lengths(flat).sum()), LEAST_DIVISOR)
    few = mesh.face_count <= FEW_FACES
    for parent, edge in islice(_trees(flat), None if few else FEW_TREES):
        may_stop()
        net = _without_overlaps(flat, parent, edge, allowed)
        pieces = float(net.piece.max() + 1)
        cut = float(_lengths(net)[~net.joined].sum()) / whole
        if pieces < lowest[0] or (pieces == lowest[0] and cut < lowest[1] - SAME_SCORE):
            best, lowest = net, (pieces, cut)
        if not few and lowest[0] == 1.0:
            break
    assert best is not None
    return best


def of_convex_faces(mesh: Mesh) -> Mesh:
    """The present faces of a mesh, those that are not planar in triangles, those that are not convex in parts."""
    from vectorplot.geometry.mesh_repair import chosen_faces, without_loose_vertices

    if mesh.present is not None:
        mesh = replace(chosen_faces(mesh, mesh.present), present=None)
    mesh = chosen_faces(mesh, np.asarray(mesh.area_vectors.any(axis=1)))
    if mesh.is_triangular or not mesh.face_count:
        return without_loose_vertices(mesh)
    at, face = mesh.vertices[mesh.corners], mesh.corner_face
    first = at[mesh.offsets[:-1]]
    height = np.abs(dot(at - first[face], mesh.face_normals[face]))
    bent = np.maximum.reduceat(height, mesh.offsets[:-1]) > zero_distance(mesh.vertices)
    fans, of = ragged.fans(mesh.offsets)
    some = bent[of]
    whole = ~bent
    kept, offsets = ragged.take(mesh.offsets, whole)
    corners = np.concatenate([mesh.corners[kept], mesh.corners[fans[some]].ravel()])
    sizes = np.concatenate([np.diff(offsets), np.full(int(some.sum()), 3)])
    mesh = Mesh(mesh.vertices, corners, ragged.offsets(sizes))
    before, here, after = (
        mesh.vertices[mesh.corners[step]]
        for step in (ragged.preceding(mesh.offsets), slice(None), ragged.following(mesh.offsets))
    )
    turn = dot(cross(here - before, after - here), mesh.face_normals[mesh.corner_face])
    reflex = turn < -zero_distance(mesh.vertices) * norm(after - before)
    concave = np.logical_or.reduceat(reflex, mesh.offsets[:-1])
    return without_loose_vertices(split_faces(mesh, concave) if concave.any() else mesh)


def _unfoldable(mesh: Mesh) -> Net:
    """The faces each in its own place, none joined."""
    uses = edge_uses(mesh)
    first = uses.first[uses.agree]
    one, two = uses.corner[first], uses.corner[first + 1]
    left, right = mesh.corner_face[one], mesh.corner_face[two]
    normals, count = mesh.face_normals, mesh.face_count
    way = mesh.vertices[mesh.corners[mesh.next_corner[one]]] - mesh.vertices[mesh.corners[one]]
    sine = dot(cross(normals[left], normals[right]), way) / np.maximum(norm(way), LEAST_DIVISOR)
    return Net(
        mesh,
        axis_frame(mesh.area_vectors)[:, :2],
        face_barycentres(mesh),
        np.tile([1.0, 0.0], (count, 1)),
        np.zeros((count, 2)),
        np.arange(count),
        one,
        two,
        arctan2(sine, dot(normals[left], normals[right])),
        np.zeros(len(one), dtype=np.bool_),
        0.0,
    )


def _lengths(net: Net) -> Floats:
    """(e,) of the edges between two faces."""
    mesh = net.mesh
    return norm(mesh.vertices[mesh.corners[mesh.next_corner[net.first]]] - mesh.vertices[mesh.corners[net.first]])


# Spanning trees of the faces: who hangs on whom.


def _trees(net: Net) -> Iterator[tuple[Ints, Ints]]:
    """Trees that are thought of: parent (f,), itself for a root, and the edge (f,) to it, -1 for a root."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    mesh, count = net.mesh, net.mesh.face_count
    one, two = mesh.corner_face[net.first], mesh.corner_face[net.second]
    apart = np.flatnonzero(one != two)
    length = _lengths(net)
    long = length / max(float(length.max(initial=0.0)), LEAST_DIVISOR)
    bend = np.abs(net.angle) / np.pi
    way = mesh.vertices[mesh.corners[mesh.next_corner[net.first]]] - mesh.vertices[mesh.corners[net.first]]
    way = way / np.maximum(length, LEAST_DIVISOR)[:, None]
    if count <= FEW_FACES:
        yield _rooted(net, apart, by_rings=True)
    weights = [bend + SAME_SCORE * (1.0 - long), 1.0 - long, bend * long]
    weights += [np.abs(dot(way, direction)) for direction in DIRECTIONS]
    for weight in weights:
        # Of several edges between two faces the lightest counts.
        order = apart[np.argsort(weight[apart], kind="stable")]
        low, high = np.minimum(one[order], two[order]), np.maximum(one[order], two[order])
        _, lightest = np.unique(low * count + high, return_index=True)
        chosen = order[lightest]
        graph = coo_matrix((1.0 + weight[chosen], (low[lightest], high[lightest])), shape=(count, count)).tocsr()
        tree = minimum_spanning_tree(graph).tocoo()
        key = low[lightest] * count + high[lightest]
        found = chosen[np.searchsorted(key, np.minimum(tree.row, tree.col) * count + np.maximum(tree.row, tree.col))]
        yield _rooted(net, found, by_rings=False)


def _rooted(net: Net, edges: Ints, *, by_rings: bool) -> tuple[Ints, Ints]:
    """The tree of the shortest ways along some edges from roots: of each component of the mesh the lowest face, or,
    where the edges are a tree already, the largest one."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    mesh, count = net.mesh, net.mesh.face_count
    one, two = mesh.corner_face[net.first[edges]], mesh.corner_face[net.second[edges]]
    graph = coo_matrix((np.ones(len(edges)), (one, two)), shape=(count, count)).tocsr()
    _, component = connected_components(graph, directed=False)
    rank = face_barycentres(mesh)[:, 2] if by_rings else -norm(mesh.area_vectors)
    order = np.lexsort((np.arange(count), rank, component))
    roots = order[np.concatenate([[True], np.diff(component[order]) > 0])]
    # One more node, on which all roots hang.
    row, column = np.concatenate([one, np.full(len(roots), count)]), np.concatenate([two, roots])
    whole = coo_matrix((np.ones(len(row)), (row, column)), shape=(count + 1, count + 1)).tocsr()
    _, before = breadth_first_order(whole, count, directed=False)
    parent = np.asarray(before[:count], dtype=np.intp)
    parent[roots] = roots
    key = np.minimum(one, two) * count + np.maximum(one, two)
    by_key = np.argsort(key, kind="stable")
    own = np.minimum(parent, np.arange(count)) * count + np.maximum(parent, np.arange(count))
    edge = np.full(count, -1)
    hanging = np.flatnonzero(parent != np.arange(count))
    edge[hanging] = edges[by_key[np.searchsorted(key[by_key], own[hanging])]]
    return parent, edge


# Faces unfolded along a tree.


def _unfolded(net: Net, parent: Ints, edge: Ints, tolerance: float) -> Net:
    """The faces in the planes of the pieces that a tree makes."""
    mesh, count = net.mesh, net.mesh.face_count
    flat = net.corners
    turns, shifts = np.tile([1.0, 0.0], (count, 1)), np.zeros((count, 2))
    hanging = np.flatnonzero(edge >= 0)
    own, other = net.first[edge[hanging]], net.second[edge[hanging]]
    swapped = mesh.corner_face[own] != hanging
    own, other = np.where(swapped, other, own), np.where(swapped, own, other)
    # The edge runs from a to b in the parent, and from b to a in the face.
    a, b = flat[other], flat[mesh.next_corner[other]]
    near_b, near_a = flat[own], flat[mesh.next_corner[own]]
    there, here = b - a, near_b - near_a
    size = np.maximum(norm(there) * norm(here), LEAST_DIVISOR)
    cosine = component_sum(there * here) / size
    sine = cross(here, there) / size
    turns[hanging] = np.stack([cosine, sine], axis=1)
    middle = (near_a + near_b) / 2.0
    shifts[hanging] = (a + b) / 2.0 - turned(turns[hanging], middle)
    root = parent.copy()
    # Every step joins the way to a face's ancestor with that one's own way: as many as the depth has digits.
    while (root != root[root]).any():
        may_stop()
        shifts = shifts[root] + turned(turns[root], shifts)
        turns = turned(turns[root], turns)
        root = root[root]
    turns = turns / norm(turns)[:, None]
    piece = np.unique(root, return_inverse=True)[1]
    found = replace(net, turns=turns, shifts=shifts, piece=piece)
    corners = found.corners
    one, two = net.first, net.second
    gaps = np.stack([corners[one] - corners[mesh.next_corner[two]], corners[mesh.next_corner[one]] - corners[two]])
    off = norm(gaps).max(axis=0)
    same = piece[mesh.corner_face[one]] == piece[mesh.corner_face[two]]
    joined = same & (off <= tolerance)
    joined[edge[hanging]] = True
    return replace(found, joined=joined, gap=float(off[joined].max(initial=0.0)))


def turned(turns: Floats, points: Floats) -> Floats:
    """(n,2) points, or turns, turned by turns (n,2)."""
    (cosine, sine), (x, y) = turns.T, points.T
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=1)


def _without_overlaps(net: Net, parent: Ints, edge: Ints, tolerance: float) -> Net:
    """The faces unfolded along a tree that is cut where pieces overlap: at the edges that most overlapping faces hang
    together by."""
    found = _unfolded(net, parent, edge, tolerance)
    one, two = _overlapping(found, tolerance)
    if not len(one):
        return found
    pair, child = _ways(parent, one, two)
    while len(pair):
        may_stop()
        cut = int(np.argmax(np.bincount(child)))
        parent, edge = parent.copy(), edge.copy()
        parent[cut], edge[cut] = cut, -1
        left = ~np.isin(pair, pair[child == cut])
        pair, child = pair[left], child[left]
    return _unfolded(net, parent, edge, tolerance)


def _overlapping(net: Net, tolerance: float) -> tuple[Ints, Ints]:
    """The pairs of faces of one piece whose common part is wider than the tolerance: twice its area by its perimeter is
    the radius of the circle in a triangle, and about half the width of a strip. Faces that are joined lie on both sides
    of their edge."""
    import shapely

    areas = polygons_of(net.corners.T, net.mesh.offsets)
    one, two = shapely.STRtree(areas).query(areas, predicate="intersects")
    sides = np.sort(net.mesh.corner_face[np.stack([net.first, net.second])[:, net.joined]], axis=0)
    count = len(areas)
    beside = np.isin(one * count + two, sides[0] * count + sides[1])
    some = (one < two) & (net.piece[one] == net.piece[two]) & ~beside
    one, two = one[some], two[some]
    may_stop()
    # Without a grid GEOS may take one of two triangles that touch for what they have in common.
    common = shapely.intersection(areas[one], areas[two], grid_size=GRID_OF_TOLERANCE * tolerance)
    deep = 2.0 * shapely.area(common) > tolerance * shapely.length(common)
    return one[deep], two[deep]


def _ways(parent: Ints, one: Ints, two: Ints) -> tuple[Ints, Ints]:
    """For pairs of faces of one tree the faces whose edges to their parents the way between the two takes: (n,) the
    pair, (n,) the face."""
    up = parent
    depth = np.where(up != np.arange(len(parent)), 1, 0)
    while (up != up[up]).any():
        depth, up = depth + depth[up], up[up]
    pairs, faces = [], []
    number = np.arange(len(one))
    while len(number):
        may_stop()
        climbs = depth[one] >= depth[two]
        pairs.append(number)
        faces.append(np.where(climbs, one, two))
        one, two = np.where(climbs, parent[one], one), np.where(climbs, two, parent[two])
        left = one != two
        one, two, number = one[left], two[left], number[left]
    return np.concatenate(pairs), np.concatenate(faces)
