"""Meshes as they come in files, mended: welded, without degenerate faces, consistently wound; and what there was."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.degenerate import chosen_faces, without_degenerate
from vectorplot.geometry.repair.weld import close_points, distinct_points
from vectorplot.geometry.repair.winding import (
    EdgeUses,
    components,
    consistent_winding,
    edge_uses,
    inside_out,
    is_closed_oriented,
    repeated_faces,
    turned_faces,
)
from vectorplot.tolerances.of_angles import SOLID_ANGLE_ROUNDING
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

__all__ = [
    "Mending",
    "MeshReport",
    "is_closed_oriented",
    "mended",
    "mesh_report",
    "welded",
    "without_loose_vertices",
]


@dataclass(frozen=True)
class Mending:
    """What was done to a mesh, and what is left, in numbers.

    Parameters
    ----------
    welded : int
        Vertices made one with others.
    degenerate, repeated : int
        Faces dropped as degenerate, and as repeated.
    turned : int
        Faces turned round.
    boundary_edges, nonmanifold_edges : int
        What is left: edges of one face, and of more than two.
    one_sided : bool
        Whether some piece is one-sided.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> flat = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2), (0, 1, 1)])
    >>> mesh, done = geometry.mended(flat, precision=2.0**-52)
    >>> str(done)
    'dropped 1 degenerate face; open mesh (3 boundary edges)'
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
    """What a mesh is like.

    Parameters
    ----------
    vertices, faces, edges : int
        How many there are.
    boundary_edges : int
        Edges of one face only.
    nonmanifold_edges : int
        Edges of more than two faces.
    components : int
        Pieces that hang together.
    closed : bool
        No boundary edge.
    oriented : bool
        Neighbours agree about the outside.
    convex : bool
        Closed, oriented and convex within 1e-9 of its extent.
    size : (float, float, float)
        Extents along x, y and z.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> report = geometry.mesh_report(geometry.box((1, 2, 3)))
    >>> report.edges, report.closed, report.convex, report.size
    (12, True, True, (1.0, 2.0, 3.0))
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
    size: tuple[float, float, float]


def mesh_report(mesh: Mesh) -> MeshReport:
    """The report on a mesh, in one sort of its edges.

    Parameters
    ----------
    mesh : Mesh
        Any.

    Returns
    -------
    MeshReport
        Counts of faces and edges, and whether it bounds a body.

    Notes
    -----
    Degenerate: a mesh without faces is closed and not convex.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> report = geometry.mesh_report(triangle)
    >>> report.boundary_edges, report.closed, report.components
    (3, False, 1)
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
        size=(float(high[0] - low[0]), float(high[1] - low[1]), float(high[2] - low[2])),
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
    """(c,) solid angles of the triangles from each face's first corner to each of its edges, seen from eye.

    Source: van Oosterom and Strackee, The solid angle of a plane triangle, equation 8.
    """
    b = mesh.vertices[mesh.corners] - eye
    a = b[mesh.offsets[:-1]][mesh.corner_face]
    c = b[mesh.next_corner]
    la, lb, lc = (np.linalg.norm(arm, axis=1) for arm in (a, b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return np.asarray(
        2.0 * arctan2(np.einsum("ij,ij->i", a, np.cross(b, c)), la * lb * lc + ab * lc + bc * la + ca * lb)
    )


def mended(mesh: Mesh, precision: float) -> tuple[Mesh, Mending]:
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
        What cannot be mended (open, non-manifold, one-sided) is kept.
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
    >>> mesh, done = geometry.mended(soup, precision=2.0**-23)
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

    Parameters
    ----------
    mesh : Mesh
        With vertices that may stand several times.

    Returns
    -------
    Mesh
        With the same faces.
    int
        How many vertices it has less.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    >>> mesh, lost = geometry.welded(vp.Mesh.from_triangles(corners, [(0, 1, 2), (3, 4, 5)]))
    >>> len(mesh.vertices), lost
    (4, 2)
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

    Pieces that touch in a point do not hang together: where else they pierce each other an intersection is drawn.
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
