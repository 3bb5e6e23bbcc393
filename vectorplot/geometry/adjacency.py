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
