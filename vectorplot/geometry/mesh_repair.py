"""Meshes as they come in files, repaired: seams, orientation, faces without area, parts that need no mending."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import cross, dot, triangle_corners
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh, next_positions
from vectorplot.geometry.vectors import solid_angles
from vectorplot.geometry.weld import chained, close_points, distinct_points
from vectorplot.geometry.winding import (
    EdgeUses,
    components,
    consistent_winding,
    edge_uses,
    inside_out,
    is_closed_oriented,
    repeated_faces,
    signed_volumes,
    turned_faces,
)
from vectorplot.tolerances import SOLID_ANGLE_ROUNDING, THIN_OF_LENGTH, ULP, ZERO_OF_EXTENT

# Faces without area, found and taken out.

_PIECE = 1 << 15
_ROUNDS = 8


def without_degenerate(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh without faces that have no area and corners that follow themselves, and how many faces went.

    In a mesh of triangles, one without area whose third corner lies in its longest side first trades places with the
    neighbour there, which is split at that corner: so no hole is left between the sides.
    """
    mesh, dropped = without_stutter(mesh)
    thin = thin_faces(mesh)
    dropped += int(thin.sum())
    for _ in range(_ROUNDS if mesh.is_triangular else 0):
        if not thin.any():
            break
        flipped = _with_flipped_caps(mesh, thin)
        still = thin_faces(flipped)
        if still.sum() >= thin.sum():
            break
        mesh, thin = flipped, still
    return (chosen_faces(mesh, ~thin) if thin.any() else mesh), dropped


def _with_flipped_caps(mesh: Mesh, thin: Bools) -> Mesh:
    """The mesh with the longest side a b of every thin triangle a b m replaced by the side from m to the neighbour's
    third corner c: the triangles a b m and b a c become a c m and c b m."""
    triangles = mesh.corners.reshape(-1, 3).copy()
    caps = np.flatnonzero(thin)
    points = mesh.vertices[triangles[caps]]
    sides = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    longest = sides.argmax(axis=1)
    a, b, m = (triangles[caps, (longest + k) % 3] for k in range(3))
    wanted = b * len(mesh.vertices) + a
    order = np.argsort(wanted, kind="stable")
    keys = mesh.corners * len(mesh.vertices) + mesh.corners[mesh.next_corner]
    place = np.minimum(np.searchsorted(wanted[order], keys), len(order) - 1)
    corner = np.flatnonzero(wanted[order][place] == keys)
    corner = corner[~thin[corner // 3]]
    # A neighbour is split once a round, and a side has one neighbour.
    corner = corner[np.unique(corner // 3, return_index=True)[1]]
    chosen, first = np.unique(order[place[corner]], return_index=True)
    corner = corner[first]
    c = mesh.corners[corner - corner % 3 + (corner + 2) % 3]
    good = c != m[chosen]
    chosen, corner, c = chosen[good], corner[good], c[good]
    triangles[caps[chosen]] = np.stack([a[chosen], c, m[chosen]], axis=1)
    triangles[corner // 3] = np.stack([c, b[chosen], m[chosen]], axis=1)
    return Mesh(mesh.vertices, triangles.ravel(), mesh.offsets, mesh.present)


def chosen_faces(mesh: Mesh, chosen: Bools) -> Mesh:
    """The mesh with the chosen faces (f,) alone; vertices stay."""
    corners = mesh.corners[np.repeat(chosen, mesh.face_sizes)]
    offsets = ragged.offsets(mesh.face_sizes[chosen])
    return Mesh(mesh.vertices, corners, offsets, None if mesh.present is None else mesh.present[chosen])


def without_stutter(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh without corners equal to the next one, and the number of faces that left fewer than three."""
    if mesh.is_triangular:
        a, b, c = mesh.corners[0::3], mesh.corners[1::3], mesh.corners[2::3]
        bad = (a == b) | (b == c) | (c == a)
        return (chosen_faces(mesh, ~bad), int(bad.sum())) if bad.any() else (mesh, 0)
    stutter = mesh.corners == mesh.corners[mesh.next_corner]
    if not stutter.any():
        return mesh, 0
    sizes = mesh.face_sizes - np.bincount(mesh.corner_face[stutter], minlength=mesh.face_count)
    alive = sizes >= 3
    corners = mesh.corners[~stutter & alive[mesh.corner_face]]
    offsets = ragged.offsets(sizes[alive])
    present = None if mesh.present is None else mesh.present[alive]
    return Mesh(mesh.vertices, corners, offsets, present), int((~alive).sum())


def thin_faces(mesh: Mesh) -> Bools:
    """(f,) True for faces without area: height below 1e-10 of the longest side, or the coordinates' noise."""
    thin = np.zeros(mesh.face_count, dtype=np.bool_)
    low, high = mesh.bounds
    extent = float((high - low).max())
    if extent == 0.0 or mesh.face_count == 0:
        return np.asarray(~thin)
    noise = 4.0 * ULP * float(np.abs(mesh.bounds).max()) / extent
    points = np.ascontiguousarray(mesh.vertices.T)

    def look(some: slice) -> None:
        corners = mesh.corners[mesh.offsets[some.start] : mesh.offsets[some.stop]]
        offsets = mesh.offsets[some.start : some.stop + 1] - mesh.offsets[some.start]
        area, length = _squares(points, corners, offsets, 1.0 / extent)
        thin[some] = (area <= THIN_OF_LENGTH**2 * length * length) | (area <= noise**2 * length)

    for _ in mapped(look, slices(mesh.face_count, _PIECE)):
        pass
    return thin


def _squares(points: Floats, corners: Ints, offsets: Ints, scale: float) -> tuple[Floats, Floats]:
    """(f,) squares of twice the areas, and (f,) squared lengths of the order of the longest side, after scaling, of
    faces with corners among points (3,v)."""
    if len(corners) == 3 * (len(offsets) - 1):
        a, b, c = triangle_corners(points, corners)
        p, q = (b - a) * scale, (c - a) * scale
        vector = cross(p, q)
        return dot(vector, vector), dot(p, p) + dot(q, q)
    at_corner, sizes = points.take(corners, axis=1), np.diff(offsets)
    arms = (at_corner - np.repeat(at_corner.take(offsets[:-1], axis=1), sizes, axis=1)) * scale
    sides = cross(arms, arms.take(ragged.following(offsets), axis=1))
    vector = np.add.reduceat(sides, offsets[:-1], axis=1)
    return dot(vector, vector), np.maximum.reduceat(dot(arms, arms), offsets[:-1])


# Meshes as they come in files, repaired: welded, without degenerate faces, consistently wound; and what there was.

__all__ = [
    "Mending",
    "MeshReport",
    "is_closed_oriented",
    "mesh_report",
    "repaired",
    "welded",
    "without_loose_vertices",
]


@dataclass(frozen=True)
class Mending:
    """What was done to a mesh, and what is left, in numbers.

    welded: vertices made one with others; degenerate, repeated: faces dropped as degenerate, and as repeated; turned:
    faces turned round; boundary_edges, nonmanifold_edges: what is left: edges of one face, and of more than two;
    one_sided: whether some piece is one-sided.
    """

    welded: int = 0
    degenerate: int = 0
    repeated: int = 0
    turned: int = 0
    boundary_edges: int = 0
    nonmanifold_edges: int = 0
    one_sided: bool = False

    def __add__(self, other: Mending) -> Mending:
        return Mending(
            self.welded + other.welded,
            self.degenerate + other.degenerate,
            self.repeated + other.repeated,
            self.turned + other.turned,
            self.boundary_edges + other.boundary_edges,
            self.nonmanifold_edges + other.nonmanifold_edges,
            self.one_sided or other.one_sided,
        )

    def __str__(self) -> str:
        """One line such as ``welded 12 vertices, dropped 3 degenerate faces; open mesh (38 boundary edges)``."""
        done = [
            self.welded and f"welded {_many(self.welded, 'vertex', 'vertices')}",
            self.degenerate and f"dropped {_many(self.degenerate, 'degenerate face', 'degenerate faces')}",
            self.repeated and f"dropped {_many(self.repeated, 'repeated face', 'repeated faces')}",
            self.turned and f"turned {_many(self.turned, 'face', 'faces')} round",
        ]
        left = [
            self.boundary_edges and f"open mesh ({_many(self.boundary_edges, 'boundary edge', 'boundary edges')})",
            self.nonmanifold_edges and _many(self.nonmanifold_edges, "non-manifold edge", "non-manifold edges"),
            self.one_sided and "one-sided (no consistent outside)",
        ]
        return "; ".join(", ".join(part for part in half if part) for half in (done, left) if any(half))


def _many(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


@dataclass(frozen=True)
class MeshReport:
    """What a mesh is like. vertices, faces, edges: counts; boundary_edges: of one face; nonmanifold_edges: of more than
    two; components: connected pieces; closed: no boundary edge; oriented: neighbours agree about the outside;
    convex: closed, oriented and convex within 1e-9 of the extent; bounds: smallest and largest coordinates.
    """

    vertices: int
    faces: int
    edges: int
    boundary_edges: int
    nonmanifold_edges: int
    components: int
    closed: bool
    oriented: bool
    convex: bool
    bounds: tuple[tuple[float, float, float], tuple[float, float, float]]


def mesh_report(mesh: Mesh) -> MeshReport:
    """The report on a mesh, in one sort of its edges.

    mesh: any; result: counts of faces and edges, and whether it bounds a body.
    Edge cases: a mesh without faces is closed and not convex.
    """
    uses = edge_uses(mesh)
    number, _ = components(mesh, uses) if mesh.face_count else (0, None)
    boundary = int((uses.count == 1).sum())
    oriented = not bool(uses.conflict.any()) and (boundary > 0 or is_closed_oriented(mesh))
    manifold = boundary == 0 and oriented and bool((uses.count == 2).all())
    low, high = mesh.bounds
    return MeshReport(
        vertices=len(mesh.vertices),
        faces=mesh.face_count,
        edges=len(uses.count),
        boundary_edges=boundary,
        nonmanifold_edges=int((uses.count > 2).sum()),
        components=number,
        closed=boundary == 0,
        oriented=oriented,
        convex=manifold and number == 1 and _is_convex(mesh, uses),
        bounds=(tuple(low.tolist()), tuple(high.tolist())),
    )


def _is_convex(mesh: Mesh, uses: EdgeUses) -> bool:
    """Whether a closed, oriented, connected manifold mesh is convex.

    Convex at every edge, and star-shaped about its centre with one cover of the sphere of directions: locally convex
    and embedded, hence convex (Tietze, Nakajima).
    """
    low, high = mesh.bounds
    zero = ZERO_OF_EXTENT * float((high - low).max())
    corner = uses.corner.reshape(-1, 2)
    face = mesh.corner_face[corner]
    normals, starts = mesh.face_normals, mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    for side in (0, 1):
        # Every corner of the neighbour must lie behind the face's plane; the one after the edge stands for all when the
        # neighbour is planar, which is checked against its own plane.
        beyond = mesh.vertices[mesh.corners[mesh.next_corner[mesh.next_corner[corner[:, 1 - side]]]]]
        if (np.einsum("ij,ij->i", beyond - starts[face[:, side]], normals[face[:, side]]) > zero).any():
            return False
    arms = mesh.vertices[mesh.corners] - starts[mesh.corner_face]
    if (np.abs(np.einsum("ij,ij->i", arms, normals[mesh.corner_face])) > zero).any():
        return False
    centre = mesh.vertices[np.unique(mesh.corners)].mean(axis=0)
    if (np.einsum("ij,ij->i", starts - centre, normals) < -zero).any():
        return False
    return abs(float(_solid_angles(mesh, centre).sum()) - 4.0 * np.pi) < SOLID_ANGLE_ROUNDING


def _solid_angles(mesh: Mesh, eye: Floats) -> Floats:
    """(c,) solid angles of the triangles from each face's first corner to each of its edges, seen from eye."""
    b = mesh.vertices[mesh.corners] - eye
    return solid_angles(b[mesh.offsets[:-1]][mesh.corner_face], b, b[mesh.next_corner])


def repaired(mesh: Mesh, precision: float) -> tuple[Mesh, Mending]:
    """The mesh without degenerate faces, welded where it is open, faces agreeing about the outside; and what was done.

    Parameters
    ----------
    mesh : Mesh
        As a file has it.
    precision : float
        Relative spacing of the coordinates in the file (2^-23 for 32-bit floats, 2^-52 for 64-bit).

    Returns
    -------
    Mesh
        What cannot be repaired (open, non-manifold, one-sided) is kept.
    Mending
        What was done, and what is left, in numbers.

    Notes
    -----
    A closed consistent mesh is left as it is, but turned where it shows its inside, and without vertices of no face.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    >>> soup = vp.Mesh.from_triangles(corners, [(0, 1, 2), (3, 5, 4)])
    >>> mesh, done = geometry.repaired(soup, precision=2.0**-23)
    >>> len(mesh.vertices), done.welded, done.turned
    (4, 2, 1)
    """
    mesh, dropped = without_degenerate(mesh)
    mending = Mending(degenerate=dropped)
    if not is_closed_oriented(mesh):
        mesh, uses, welds = _welded_where_open(mesh, precision)
        mesh, turns = _wound(mesh, uses)
        mending = mending + welds + turns
    elif mesh.face_count:
        number, piece = mesh.pieces
        turn = inside_out(mesh, piece, number)
        if turn.any():
            mesh, mending = turned_faces(mesh, turn), replace(mending, turned=int(turn.sum()))
    return without_loose_vertices(mesh), mending


def welded(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh with equal vertices made one, and how many were lost.

    mesh: with vertices that may stand several times; result: with the same faces; how many vertices it has less.
    """
    first, number = distinct_points(mesh.vertices)
    return Mesh(mesh.vertices[first] + 0.0, number[mesh.corners], mesh.offsets, mesh.present), len(number) - len(first)


def _welded_where_open(mesh: Mesh, precision: float) -> tuple[Mesh, EdgeUses, Mending]:
    """The mesh with equal vertices made one, and close ones on its border; its edges; and what was done."""
    mesh, count = welded(without_loose_vertices(mesh))
    mesh, dropped = without_degenerate(mesh) if count else (mesh, 0)
    uses = edge_uses(mesh)
    rim = _ends(mesh, uses, uses.count == 1)
    kept = rim[close_points(mesh.vertices[rim], 4.0 * precision * float(np.abs(mesh.bounds).max()))]
    close = int((kept != rim).sum())
    if close:
        number = np.arange(len(mesh.vertices))
        number[rim] = kept
        mesh = Mesh(mesh.vertices, number[mesh.corners], mesh.offsets, mesh.present)
        mesh, collapsed = without_degenerate(mesh)
        dropped += collapsed
        uses = edge_uses(mesh)
    return mesh, uses, Mending(welded=count + close, degenerate=dropped)


def _ends(mesh: Mesh, uses: EdgeUses, edges: Bools) -> Ints:
    """The vertices at the ends of some edges."""
    corner = uses.corner[uses.first[edges]]
    return np.unique(np.concatenate([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]]))


def _wound(mesh: Mesh, uses: EdgeUses) -> tuple[Mesh, Mending]:
    """The mesh with consistent winding where there is one, solids outside out; and the counts of what is left."""
    repeated = 0
    if (uses.count > 2).any():
        again = repeated_faces(mesh)
        repeated = int(again.sum())
        if repeated:
            mesh = chosen_faces(mesh, ~again)
            uses = edge_uses(mesh)
    shared = _ends(mesh, uses, uses.count > 2)
    turn = np.zeros(mesh.face_count, dtype=np.bool_)
    two_sided = True
    if uses.conflict.any():
        turn, two_sided = consistent_winding(mesh, uses)
        mesh = turned_faces(mesh, turn)
    number, piece = components(mesh, uses) if mesh.face_count else (0, np.zeros(0, dtype=np.intp))
    if number:
        outwards = inside_out(mesh, piece, number)
        mesh = turned_faces(mesh, outwards) if outwards.any() else mesh
        turn = turn ^ outwards
        mesh = _with_own_vertices(mesh, piece, shared)
    return mesh, Mending(
        repeated=repeated,
        turned=int(turn.sum()),
        boundary_edges=int((uses.count == 1).sum()),
        nonmanifold_edges=int((uses.count > 2).sum()),
        one_sided=not two_sided,
    )


def _with_own_vertices(mesh: Mesh, piece: Ints, shared: Ints) -> Mesh:
    """The mesh in which different pieces (f,) have no vertices in common but those that are shared (edges of several
    pieces end there).

    Pieces that touch in a point are not connected: where else they pierce each other an intersection is drawn.
    """
    of = piece[mesh.corner_face]
    owner = np.zeros(len(mesh.vertices), dtype=np.intp)
    owner[mesh.corners] = of
    strange = np.flatnonzero(owner[mesh.corners] != of)
    strange = strange[~np.isin(mesh.corners[strange], shared)]
    if not len(strange):
        return mesh
    twins, number = np.unique(np.stack([mesh.corners[strange], of[strange]]), axis=1, return_inverse=True)
    corners = mesh.corners.copy()
    corners[strange] = len(mesh.vertices) + number.ravel()
    return Mesh(np.concatenate([mesh.vertices, mesh.vertices[twins[0]]]), corners, mesh.offsets, mesh.present)


def without_loose_vertices(mesh: Mesh) -> Mesh:
    """The mesh without vertices that no face names."""
    used = np.zeros(len(mesh.vertices), dtype=np.bool_)
    used[mesh.corners] = True
    if used.all():
        return mesh
    number = np.cumsum(used) - 1
    return Mesh(mesh.vertices[used], number[mesh.corners], mesh.offsets, mesh.present)


# Seams: edges of meshes that lie in the same place under different numbers, made one.
#
# Programs that put textures or several normals on meshes store a vertex once for every pair of texture coordinates, or
# once for every face: the faces on both sides of such a seam do not share it by number, though nothing is open there.

MANY_FACES = 1 << 12
"""A mesh of so many faces is asked by itself whether it is closed, and knows it from then on; for smaller ones it costs
less to look at all together."""

FEW_COPIES = 8
"""Meshes that stand for so many others, on the average, are asked by themselves too."""


def joined_seams(meshes: Sequence[Mesh]) -> tuple[Mesh, ...]:
    """The meshes with coinciding boundary edges made one, and those without length one vertex. Vertices and face
    numbers stay; a face of fewer than three corners is no longer present; meshes without seams are returned
    themselves. Edge cases: vertices that no common edge joins, and closed meshes that touch, stay apart.
    """
    asked = _perhaps_open(meshes)
    result = list(meshes)
    for k, mesh in zip(asked, _joined_seams([meshes[k] for k in asked]), strict=True):
        result[k] = mesh
    return tuple(result)


def _perhaps_open(meshes: Sequence[Mesh]) -> list[int]:
    """The meshes that are not known to be closed and oriented. Where no edge is open is a matter of the corners alone:
    of small meshes with equal ones, as copies of one body have, the first is asked for all."""
    equal: dict[tuple[bytes, bytes], list[int]] = {}
    asked = []
    for k, mesh in enumerate(meshes):
        if len(mesh.offsets) <= MANY_FACES:
            equal.setdefault((mesh.corners.tobytes(), mesh.offsets.tobytes()), []).append(k)
        elif not mesh.is_closed:
            asked.append(k)
    if len(equal) <= len(meshes) // FEW_COPIES:
        return sorted(chain(asked, *(alike for alike in equal.values() if not meshes[alike[0]].is_closed)))
    return sorted(chain(asked, *equal.values()))


def _joined_seams(meshes: Sequence[Mesh]) -> Sequence[Mesh]:
    """As joined_seams, all looked at together."""
    counts = np.array([len(mesh.vertices) for mesh in meshes], dtype=np.intp)
    first = ragged.offsets(counts)
    corners, offsets = _stacked(meshes, first)
    loose = unbalanced_vertices(int(first[-1]), corners, offsets)
    if not loose.any():
        return meshes
    start, end = _boundary(corners, offsets, loose)
    if not len(start):
        return meshes
    ends, number = np.unique(np.concatenate([start, end]), return_inverse=True)
    owner = np.searchsorted(first, ends, side="right") - 1
    points = np.concatenate([meshes[k].vertices[ends[owner == k] - first[k]] for k in np.unique(owner).tolist()])
    stand_in = _joined_ends(points, owner, *number.reshape(2, -1))
    moved = np.flatnonzero(stand_in != np.arange(len(ends)))
    result = list(meshes)
    for k in np.unique(owner[moved]).tolist():
        here = moved[owner[moved] == k]
        renumbered = np.arange(counts[k])
        renumbered[ends[here] - first[k]] = ends[stand_in[here]] - first[k]
        result[k] = _without_stutter(replace(meshes[k], corners=renumbered[meshes[k].corners]))
    return result


def _stacked(meshes: Sequence[Mesh], first_vertex: Ints) -> tuple[Ints, Ints]:
    """Corners and offsets of the faces of all meshes, one mesh after the other."""
    if len(meshes) == 1:
        return meshes[0].corners, meshes[0].offsets
    counts = np.array([len(mesh.corners) for mesh in meshes], dtype=np.intp)
    none = np.zeros(0, dtype=np.intp)
    corners = np.concatenate([none, *(mesh.corners for mesh in meshes)]) + np.repeat(first_vertex[:-1], counts)
    ends = np.concatenate([none, *(mesh.offsets[1:] for mesh in meshes)])
    faces = np.array([len(mesh.offsets) for mesh in meshes], dtype=np.intp) - 1
    return corners, np.concatenate([[0], ends + np.repeat(ragged.starts(counts), faces)])


def _boundary(corners: Ints, offsets: Ints, loose: np.ndarray) -> tuple[Ints, Ints]:
    """The ends (b,) of the edges that one face has by their numbers, among those at loose vertices."""
    at_corner = loose[corners]
    near = np.flatnonzero(at_corner | at_corner[next_positions(offsets, np.arange(len(corners)))])
    start, end = corners[near], corners[next_positions(offsets, near)]
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = np.sort(low * len(loose) + high)
    new = np.concatenate([[True], key[1:] != key[:-1], [True]])
    return np.divmod(key[new[:-1] & new[1:]], len(loose))


def _joined_ends(points: Floats, owner: Ints, start: Ints, end: Ints) -> Ints:
    """(n,) for each of the points (n,3) of meshes (n,) that boundary edges from start to end (b,) end in, the smallest
    number of a point that such edges in the same places make one with it."""
    _, place = distinct_points(points)
    place = place * (int(owner[-1]) + 1) + owner
    turned = place[start] > place[end]
    one, two = np.where(turned, end, start), np.where(turned, start, end)
    order = np.lexsort((place[two], place[one]))
    one, two = one[order], two[order]
    same = (place[one][1:] == place[one][:-1]) & (place[two][1:] == place[two][:-1]) & (place[one] != place[two])[1:]
    still = place[one] == place[two]
    links = (one[:-1][same], two[:-1][same], one[still]), (one[1:][same], two[1:][same], two[still])
    return chained(len(points), *(np.concatenate(side) for side in links))


def _without_stutter(mesh: Mesh) -> Mesh:
    """The mesh without corners equal to the next one; faces with fewer than three others are not present."""
    stutter = mesh.corners == mesh.corners[mesh.next_corner]
    if not stutter.any():
        return mesh
    left = mesh.face_sizes - np.bincount(mesh.corner_face[stutter], minlength=mesh.face_count)
    gone = left < 3
    kept = ~stutter | gone[mesh.corner_face]
    sizes = np.where(gone, mesh.face_sizes, left)
    present = ~gone if mesh.present is None else mesh.present & ~gone
    return Mesh(mesh.vertices, mesh.corners[kept], ragged.offsets(sizes), present)


# Meshes of many parts: which of these need no mending.


def sound_parts(mesh: Mesh, part: Ints, count: int, precision: float) -> tuple[Bools, Ints]:
    """(p,) which of count parts of a mesh `repaired` would leave unchanged, and (p,) their boundary edges. part (f,):
    of each face; parts have no vertices in common but may touch, and are tested together at the cost of one mesh.
    precision: see repaired. A few that need no repair count as unsound too: those with points close by the largest
    coordinate of all parts, and closed ones without volume.
    """
    unsound = np.zeros(count, dtype=np.bool_)
    of_corner = part[mesh.corner_face]
    owner = np.full(len(mesh.vertices), -1, dtype=np.intp)
    owner[mesh.corners] = of_corner
    unsound[of_corner[mesh.corners == mesh.corners[mesh.next_corner]]] = True
    unsound[part[thin_faces(mesh)]] = True
    used = np.flatnonzero(owner >= 0)
    unsound[_twice(distinct_points(mesh.vertices)[1][used], owner[used], count)] = True
    uses = edge_uses(mesh)
    at_edge = uses.corner[uses.first]
    unsound[of_corner[at_edge[uses.conflict | (uses.count > 2)]]] = True
    border = at_edge[uses.count == 1]
    rim = np.unique(np.concatenate([mesh.corners[border], mesh.corners[mesh.next_corner[border]]]))
    near = close_points(mesh.vertices[rim], 4.0 * precision * float(np.abs(mesh.bounds).max()))
    unsound[_twice(near, owner[rim], count)] = True
    unsound[_with_wrong_pieces(mesh, part, owner, uses)] = True
    return ~unsound, np.bincount(of_corner[border], minlength=count)


def _twice(number: Ints, owner: Ints, count: int) -> Ints:
    """The owners, of count ones, that have some number (n,) twice."""
    key = np.sort(number * count + owner)
    return np.asarray(key[1:][key[1:] == key[:-1]] % max(count, 1))


def _with_wrong_pieces(mesh: Mesh, part: Ints, owner: Ints, uses: EdgeUses) -> Ints:
    """The parts with pieces that have a vertex in common, or are closed and not outside out."""
    number, piece = components(mesh, uses)
    of_corner = piece[mesh.corner_face]
    of_vertex = np.zeros(len(mesh.vertices), dtype=np.intp)
    of_vertex[mesh.corners] = of_corner
    meeting = np.flatnonzero(of_vertex[mesh.corners] != of_corner)
    is_open = np.zeros(number, dtype=np.bool_)
    is_open[of_corner[uses.corner[uses.first[uses.count == 1]]]] = True
    volume = np.bincount(piece, signed_volumes(_about_own_middles(mesh, owner)), minlength=number)
    wrong = ~is_open & ~(volume > 0.0)
    return np.concatenate([part[mesh.corner_face[meeting]], part[wrong[piece]]])


def _about_own_middles(mesh: Mesh, owner: Ints) -> Mesh:
    """The mesh with every part (v,) moved to the origin: far from it volumes would drown in rounding."""
    count = np.bincount(owner + 1)
    middle: Floats = np.stack([np.bincount(owner + 1, row) for row in mesh.vertices.T], axis=1) / np.maximum(
        count, 1
    ).reshape(-1, 1)
    return Mesh(mesh.vertices - middle[owner + 1], mesh.corners, mesh.offsets, mesh.present)
