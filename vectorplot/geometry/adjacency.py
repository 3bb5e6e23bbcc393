"""The edges of a mesh, the faces along them, and the records of faces and bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.winding import edge_uses, signed_volumes

NO_FACE = -1


def mesh_edges(mesh: Mesh) -> Ints:
    """(e,2) the edges of the mesh, smaller vertex number first, sorted: the sides of all faces, each once.

    Source: Glaeser, section 3.3; erratum G3-09: edges are pairs of consecutive corners, so the border of an open body
    belongs to them, and two faces that share vertices that are not neighbours get no false edge.
    """
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first]
    ends = np.stack([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]], axis=1)
    return np.sort(ends, axis=1)


def neighbour_faces(mesh: Mesh) -> Ints:
    """For every corner the face across the edge from it to the next corner.

    Parameters
    ----------
    mesh : Mesh
        With c corners.

    Returns
    -------
    (c,) array of int
        Numbers of faces; NO_FACE (-1) where there is none.

    Notes
    -----
    Degenerate: at an edge of more than two faces NO_FACE too: there is no single neighbour.

    Source: Glaeser, sections 3.2 and 6.1.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    >>> square = vp.Mesh.from_triangles(corners, [(0, 1, 2), (0, 2, 3)])
    >>> geometry.neighbour_faces(square).tolist()
    [-1, -1, 1, 0, -1, -1]
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

    Parameters
    ----------
    mesh : Mesh
        With both faces.
    one, other : int
        Numbers of faces from 0.

    Returns
    -------
    (int, int) or None
        The positions in face ``one`` (from 0) of the ends of the edge; None where there is no such edge.

    Notes
    -----
    Source: Glaeser, section 3.3; errata G3-09, G3-14.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> cube = geometry.box((1, 1, 1))
    >>> geometry.common_edge(cube, 0, 1), geometry.common_edge(cube, 4, 5)
    ((1, 2), None)
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

    Parameters
    ----------
    normals : (f, 3) array of float
        Outwards, of length one.
    constants : (f,) array of float
        normal . v of its vertices.
    barycentres : (f, 3) array of float
        Of its vertices.
    neighbours : (c,) array of int
        The face across the edge from every corner; -1 where there is none.

    Notes
    -----
    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> top = geometry.face_records(geometry.box((2, 2, 3)))
    >>> top.normals[5].tolist(), top.constants[5].item(), top.barycentres[5].tolist()
    ([0.0, 0.0, 1.0], 3.0, [1.0, 1.0, 3.0])
    """

    normals: Floats
    constants: Floats
    barycentres: Floats
    neighbours: Ints


def face_records(mesh: Mesh) -> FaceRecords:
    """The records of all faces of a mesh.

    Parameters
    ----------
    mesh : Mesh
        With f faces and c corners.

    Returns
    -------
    FaceRecords
        Normals, plane constants, barycentres and neighbours.

    Notes
    -----
    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> records = geometry.face_records(geometry.box((1, 1, 1)))
    >>> records.normals.shape, records.neighbours.shape
    ((6, 3), (24,))
    """
    return FaceRecords(mesh.face_normals, face_constants(mesh), face_barycentres(mesh), neighbour_faces(mesh))


def face_barycentres(mesh: Mesh) -> Floats:
    """The mean of the corners of every face.

    Parameters
    ----------
    mesh : Mesh
        With f faces.

    Returns
    -------
    (f, 3) array of float
        In world units.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.face_barycentres(geometry.box((2, 2, 2)))[4:].tolist()
    [[1.0, 1.0, 0.0], [1.0, 1.0, 2.0]]
    """
    if not mesh.face_count:
        return np.zeros((0, 3))
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    arms = mesh.vertices[mesh.corners] - first[mesh.corner_face]
    return np.asarray(first + np.add.reduceat(arms, mesh.offsets[:-1], axis=0) / mesh.face_sizes[:, None])


def face_constants(mesh: Mesh) -> Floats:
    """The c of the plane n . v = c of every face, n being its unit outer normal.

    Parameters
    ----------
    mesh : Mesh
        With f faces.

    Returns
    -------
    (f,) array of float
        Signed distances of the planes from the origin.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.face_constants(geometry.box((2, 3, 4)))[[1, 2, 5]].tolist()
    [2.0, 3.0, 4.0]
    """
    return np.asarray(np.einsum("ij,ij->i", mesh.face_normals, face_barycentres(mesh)))


@dataclass(frozen=True, eq=False)
class BodyRecord:
    """What there is to know about a body.

    Parameters
    ----------
    vertex_count, edge_count, face_count : int
        How many there are.
    barycentre : (3,) array of float
        Of its vertices.
    max_radius : float
        The largest distance of a vertex from it.
    bounds : (2, 3) array of float
        Smallest and largest coordinates.
    volume : float
        Of the closed body; for an open one it says nothing.
    area : float
        Of the faces that are present.

    Notes
    -----
    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> record = geometry.body_record(geometry.box((1, 2, 3)))
    >>> record.vertex_count, record.edge_count, record.face_count
    (8, 12, 6)
    >>> round(record.volume, 9), round(record.area, 9)
    (6.0, 22.0)
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
    Degenerate: without vertices barycentre and bounds are zero.

    Source: Glaeser, section 3.2.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> record = geometry.body_record(geometry.box((2, 2, 2)))
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
