"""Polyhedra as the book keeps them: faces with neighbours, bodies with their pools, and the contour polygon."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.connectivity import Branches, concat
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.predicates import polygon_orientation
from vectorplot.geometry.winding import NO_FACE, edge_uses, face_barycentres, mesh_edges, signed_volumes
from vectorplot.tolerances import ROUNDING


def counterclockwise(polygon: ArrayLike) -> Floats:
    """The polygon (n, 2 or more columns) with its points in counter-clockwise order in x and y, the first one staying
    first.

    The sign of its area is exact, so tiny areas far from the origin are turned the right way too.
    Edge cases: a polygon of area zero stays as it is. Source: Glaeser, section 6.1; errata G6-03, G6-08.
    """
    p = np.asarray(polygon, dtype=np.float64)
    return np.concatenate([p[:1], p[:0:-1]]) if polygon_orientation(p) < 0 else p


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
    >>> from vectorplot import geometry, textbook
    >>> len(textbook.spatial_hull(geometry.box((2, 2, 2)), centre=(9, 8, 7)))
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


def neighbour_faces(mesh: Mesh) -> Ints:
    """For every corner the face across the edge from it to the next corner.

    result: (c,) numbers of faces.
    Edge cases: at an edge of more than two faces NO_FACE too: there is no single neighbour.
    Source: Glaeser, sections 3.2 and 6.1.
    """
    uses = edge_uses(mesh)
    across = np.full(len(mesh.corners), NO_FACE, dtype=np.intp)
    pairs = uses.first[uses.count == 2]
    one, other = uses.corner[pairs], uses.corner[pairs + 1]
    across[one] = mesh.corner_face[other]
    across[other] = mesh.corner_face[one]
    return across


def common_edge(mesh: Mesh, one: int, other: int) -> tuple[int, int] | None:
    """Where in a face the first edge is that it shares with another face.

    result: (int, int) the positions in face ``one`` (from 0) of the ends of the edge.
    Source: Glaeser, section 3.3; errata G3-09, G3-14.
    """
    a, b = (mesh.corners[mesh.offsets[f] : mesh.offsets[f + 1]] for f in (one, other))
    sides = np.stack([a, np.roll(a, -1)], axis=1)
    others = np.stack([b, np.roll(b, -1)], axis=1)
    same = (np.sort(sides, axis=1)[:, None] == np.sort(others, axis=1)[None]).all(axis=2).any(axis=1)
    if not same.any():
        return None
    first = int(np.argmax(same))
    return first, (first + 1) % len(a)


@dataclass(frozen=True, eq=False)
class FaceRecords:
    """What there is to know about every face.

    normals: (f, 3) outwards, of length one; constants: (f,) normal ; barycentres: (f, 3) of its vertices; neighbours:
    (c,) the face across the edge from every corner.
    Source: Glaeser, section 3.2.
    """

    normals: Floats
    constants: Floats
    barycentres: Floats
    neighbours: Ints


def face_records(mesh: Mesh) -> FaceRecords:
    """The records of all faces of a mesh.

    Source: Glaeser, section 3.2.
    """
    return FaceRecords(mesh.face_normals, face_constants(mesh), face_barycentres(mesh), neighbour_faces(mesh))


def face_constants(mesh: Mesh) -> Floats:
    """The c of the plane n . v = c of every face, n being its unit outer normal.

    result: (f,) signed distances of the planes from the origin.
    """
    return np.asarray(np.einsum("ij,ij->i", mesh.face_normals, face_barycentres(mesh)))


@dataclass(frozen=True, eq=False)
class BodyRecord:
    """What there is to know about a body.

    vertex_count, edge_count, face_count: how many there are; barycentre: (3,) of its vertices; max_radius: the largest
    distance of a vertex from it; bounds: (2, 3) smallest and largest coordinates; volume: of the closed body; area: of
    the faces that are present.
    Source: Glaeser, section 3.2.
    """

    vertex_count: int
    edge_count: int
    face_count: int
    barycentre: Floats
    max_radius: float
    bounds: Floats
    volume: float
    area: float


def body_record(mesh: Mesh) -> BodyRecord:
    """The record of a mesh: counts, extents, volume and area.

    Parameters
    ----------
    mesh : Mesh
        A body, or a part of its surface.

    Returns
    -------
    BodyRecord
        All of it in world units.

    Notes
    -----
    Edge cases: without vertices barycentre and bounds are zero.

    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> from vectorplot import geometry, textbook
    >>> record = textbook.body_record(geometry.box((2, 2, 2)))
    >>> record.barycentre.tolist(), round(record.max_radius, 6)
    ([1.0, 1.0, 1.0], 1.732051)
    """
    bounds = mesh.bounds
    if len(mesh.vertices):
        barycentre = bounds[0] + (mesh.vertices - bounds[0]).mean(axis=0)
        radius = float(np.sqrt(((mesh.vertices - barycentre) ** 2).sum(axis=1).max()))
    else:
        barycentre, radius = np.zeros(3), 0.0
    extent = float((bounds[1] - bounds[0]).max())
    areas = 0.5 * np.linalg.norm(mesh.area_vectors, axis=1)
    return BodyRecord(
        vertex_count=len(mesh.vertices),
        edge_count=len(mesh_edges(mesh)),
        face_count=mesh.face_count,
        barycentre=barycentre,
        max_radius=radius,
        bounds=bounds,
        volume=float(signed_volumes(mesh).sum()) / 6.0 * extent**3,
        area=float((areas if mesh.present is None else areas[mesh.present]).sum()),
    )
