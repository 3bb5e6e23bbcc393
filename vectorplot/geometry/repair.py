"""Meshes as they come in files, mended: welded, without degenerate faces, consistently wound; and what there was."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.geometry.mesh import Bools, Floats, Ints, Mesh
from vectorplot.geometry.weld import close_points, distinct_points
from vectorplot.geometry.winding import (
    EdgeUses,
    components,
    consistent_winding,
    edge_uses,
    inside_out,
    is_closed_oriented,
    joined_pieces,
    repeated_faces,
    turned_faces,
)

__all__ = ["Mending", "MeshReport", "is_closed_oriented", "mended", "mesh_report", "welded"]

_PIECE = 1 << 15
# Below this ratio of height to longest side a triangle has no direction any more (a sliver of 1:1e8 still has).
_THIN = 1e-10


@dataclass(frozen=True)
class Mending:
    """What was done to a mesh, in numbers: vertices welded; faces dropped as degenerate or as repeated; faces turned
    round. And what is left: boundary edges, edges of more than two faces, and whether some piece is one-sided."""

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
    """What a mesh is like. size: extents along x, y, z; closed: no boundary edge; oriented: neighbours agree about the
    outside; convex: closed, oriented and convex within 1e-9 of its extent; mending: what was done to it on reading."""

    vertices: int
    faces: int
    edges: int
    boundary_edges: int
    nonmanifold_edges: int
    components: int
    closed: bool
    oriented: bool
    convex: bool
    size: tuple[float, float, float]
    mending: Mending = Mending()


def mesh_report(mesh: Mesh, mending: Mending | None = None) -> MeshReport:
    """The report on a mesh, in one sort of its edges. Degenerate: a mesh without faces is closed and not convex."""
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
        size=(float(high[0] - low[0]), float(high[1] - low[1]), float(high[2] - low[2])),
        mending=mending or Mending(),
    )


def _is_convex(mesh: Mesh, uses: EdgeUses) -> bool:
    """Whether a closed, oriented, connected manifold mesh is convex.

    Convex at every edge, and star-shaped about its centre with one cover of the sphere of directions: locally convex and
    embedded, hence convex (Tietze, Nakajima).
    """
    low, high = mesh.bounds
    zero = 1e-9 * float((high - low).max())
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
    return abs(float(_solid_angles(mesh, centre).sum()) - 4.0 * np.pi) < 1e-3


def _solid_angles(mesh: Mesh, eye: Floats) -> Floats:
    """(c,) solid angles of the triangles from each face's first corner to each of its edges, seen from eye.

    Source: van Oosterom and Strackee, The solid angle of a plane triangle, equation 8.
    """
    b = mesh.vertices[mesh.corners] - eye
    a = b[mesh.offsets[:-1]][mesh.corner_face]
    c = b[mesh.next_corner]
    la, lb, lc = (np.linalg.norm(arm, axis=1) for arm in (a, b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return np.asarray(
        2.0 * np.arctan2(np.einsum("ij,ij->i", a, np.cross(b, c)), la * lb * lc + ab * lc + bc * la + ca * lb)
    )


def mended(mesh: Mesh, precision: float) -> tuple[Mesh, Mending]:
    """The mesh without degenerate faces, welded where it is open, its faces agreeing about the outside; and what was done.

    precision: relative spacing of the coordinates in the file (2^-23 for 32-bit floats, 2^-52 for 64-bit). What cannot
    be mended (open, non-manifold, one-sided) is kept and counted. A closed consistent mesh is left as it is.
    """
    mesh, mending = _without_degenerate(mesh)
    if not is_closed_oriented(mesh):
        mesh, welds = _welded_where_open(mesh, precision)
        mesh, collapsed = _without_degenerate(mesh)
        mending = mending + welds + collapsed
        mesh, turns = _wound(mesh)
        mending = mending + turns
    elif mesh.face_count:
        number, piece = joined_pieces(mesh)
        turn = inside_out(mesh, piece, number)
        if turn.any():
            mesh, mending = turned_faces(mesh, turn), replace(mending, turned=int(turn.sum()))
    return _without_loose_vertices(mesh), mending


def welded(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh with equal vertices made one, and how many were lost."""
    first, number = distinct_points(mesh.vertices)
    return Mesh(mesh.vertices[first], number[mesh.corners], mesh.offsets, mesh.present), len(number) - len(first)


def _welded_where_open(mesh: Mesh, precision: float) -> tuple[Mesh, Mending]:
    mesh, count = welded(_without_loose_vertices(mesh))
    uses = edge_uses(mesh)
    border = uses.corner[uses.first[uses.count == 1]]
    if len(border):
        rim = np.unique(np.concatenate([mesh.corners[border], mesh.corners[mesh.next_corner[border]]]))
        tolerance = 4.0 * precision * float(np.abs(mesh.bounds).max())
        kept = rim[close_points(mesh.vertices[rim], tolerance)]
        number = np.arange(len(mesh.vertices))
        number[rim] = kept
        count += int((kept != rim).sum())
        mesh = Mesh(mesh.vertices, number[mesh.corners], mesh.offsets, mesh.present)
    return mesh, Mending(welded=count)


def _wound(mesh: Mesh) -> tuple[Mesh, Mending]:
    """The mesh with consistent winding where there is one, solids outside out; and the counts of what is left."""
    uses = edge_uses(mesh)
    repeated = 0
    if (uses.count > 2).any():
        again = repeated_faces(mesh)
        repeated = int(again.sum())
        if repeated:
            mesh = _only(mesh, ~again)
            uses = edge_uses(mesh)
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
    return mesh, Mending(
        repeated=repeated,
        turned=int(turn.sum()),
        boundary_edges=int((uses.count == 1).sum()),
        nonmanifold_edges=int((uses.count > 2).sum()),
        one_sided=not two_sided,
    )


def _without_degenerate(mesh: Mesh) -> tuple[Mesh, Mending]:
    """The mesh without faces that have no area, and without a corner that follows itself."""
    mesh, short = _without_stutter(mesh)
    thin = _thin_faces(mesh)
    dropped = short + int(thin.sum())
    return (_only(mesh, ~thin) if thin.any() else mesh), Mending(degenerate=dropped)


def _without_stutter(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh without corners equal to the next one, and the number of faces that left fewer than three."""
    if mesh.is_triangular:
        a, b, c = mesh.corners[0::3], mesh.corners[1::3], mesh.corners[2::3]
        bad = (a == b) | (b == c) | (c == a)
        return (_only(mesh, ~bad), int(bad.sum())) if bad.any() else (mesh, 0)
    stutter = mesh.corners == mesh.corners[mesh.next_corner]
    if not stutter.any():
        return mesh, 0
    sizes = mesh.face_sizes - np.bincount(mesh.corner_face[stutter], minlength=mesh.face_count)
    alive = sizes >= 3
    corners = mesh.corners[~stutter & alive[mesh.corner_face]]
    offsets = np.concatenate([[0], np.cumsum(sizes[alive])])
    present = None if mesh.present is None else mesh.present[alive]
    return Mesh(mesh.vertices, corners, offsets, present), int((~alive).sum())


def _only(mesh: Mesh, chosen: Bools) -> Mesh:
    """The mesh with the chosen faces (f,) alone; vertices stay."""
    corners = mesh.corners[np.repeat(chosen, mesh.face_sizes)]
    offsets = np.concatenate([[0], np.cumsum(mesh.face_sizes[chosen])])
    return Mesh(mesh.vertices, corners, offsets, None if mesh.present is None else mesh.present[chosen])


def _without_loose_vertices(mesh: Mesh) -> Mesh:
    """The mesh without vertices that no face names."""
    used = np.zeros(len(mesh.vertices), dtype=np.bool_)
    used[mesh.corners] = True
    if used.all():
        return mesh
    number = np.cumsum(used) - 1
    return Mesh(mesh.vertices[used], number[mesh.corners], mesh.offsets, mesh.present)


def _thin_faces(mesh: Mesh) -> Bools:
    """(f,) True for faces without area: height below 1e-10 of the longest side, or within the noise of the coordinates."""
    thin = np.zeros(mesh.face_count, dtype=np.bool_)
    low, high = mesh.bounds
    extent = float((high - low).max())
    if extent == 0.0 or mesh.face_count == 0:
        return np.asarray(~thin)
    noise = 4.0 * np.finfo(np.float64).eps * float(np.abs(mesh.bounds).max()) / extent
    for start in range(0, mesh.face_count, _PIECE):
        end = min(start + _PIECE, mesh.face_count)
        corners = mesh.corners[mesh.offsets[start] : mesh.offsets[end]]
        offsets = mesh.offsets[start : end + 1] - mesh.offsets[start]
        area, length = _squares(mesh.vertices, corners, offsets, 1.0 / extent)
        thin[start:end] = (area <= _THIN**2 * length * length) | (area <= noise**2 * length)
    return thin


def _squares(vertices: Floats, corners: Ints, offsets: Ints, scale: float) -> tuple[Floats, Floats]:
    """(f,) squares of twice the areas, and (f,) squared lengths of the order of the longest side, after scaling."""
    points = np.take(vertices, corners, axis=0)
    if len(corners) == 3 * (len(offsets) - 1):
        a = points[0::3]
        p, q = (points[1::3] - a) * scale, (points[2::3] - a) * scale
        return _cross_square(p, q), np.einsum("ij,ij->i", p, p) + np.einsum("ij,ij->i", q, q)
    sizes = np.diff(offsets)
    arms = (points - np.repeat(points[offsets[:-1]], sizes, axis=0)) * scale
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    vector = np.add.reduceat(np.cross(arms, arms[following]), offsets[:-1], axis=0)
    longest = np.maximum.reduceat(np.einsum("ij,ij->i", arms, arms), offsets[:-1])
    return np.einsum("ij,ij->i", vector, vector), longest


def _cross_square(p: Floats, q: Floats) -> Floats:
    x = p[:, 1] * q[:, 2] - p[:, 2] * q[:, 1]
    y = p[:, 2] * q[:, 0] - p[:, 0] * q[:, 2]
    z = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    return np.asarray(x * x + y * y + z * z)
