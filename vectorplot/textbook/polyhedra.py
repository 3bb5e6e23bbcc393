"""Polyhedra as the book keeps them: faces with neighbours, bodies with their pools, contour polygons, convex parts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import left_corners
from vectorplot.geometry.connectivity import Branches, concat
from vectorplot.geometry.convex_bodies import sides_of_plane
from vectorplot.geometry.convex_polygons import convex_polygon_parts, flattened, signed_area
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.predicates import polygon_orientation
from vectorplot.geometry.solids import FULL_TURN, HALF_TURN, checked_points, polyhedron, prism, revolution
from vectorplot.geometry.vectors import norm
from vectorplot.geometry.winding import NO_FACE, edge_uses, face_barycentres, mesh_edges, signed_volumes
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT


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
        See contour_edges.

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

    centre: (3,) as in contour_edges.
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


def convex_prism_parts(base_points: ArrayLike, vector: ArrayLike) -> list[Mesh]:
    """Convex prisms that together fill the prism over a planar base.

    base_points: (b, 3) A planar polygon; vector: (3,) along which it is moved.
    Source: Glaeser, section 3.5.
    """
    whole = prism(base_points, vector)
    count = len(whole.vertices) // 2
    base, step = whole.vertices[:count], whole.vertices[count] - whole.vertices[0]
    normal = whole.area_vectors[-1]
    flat, turned = flattened(base, normal)
    parts = convex_polygon_parts(flat)
    return [prism(base[turned[part]], step) for part in parts]


def convex_revolution_parts(meridian: ArrayLike, order: int, *, angle_deg: float = FULL_TURN) -> list[Mesh]:
    """Convex polyhedra that together fill a body of revolution.

    Parameters
    ----------
    meridian : (s, 3) array_like of float
        In a half-plane through the z-axis.
    order : int
        See revolution.
    angle_deg : float
        See revolution.

    Returns
    -------
    list of Mesh
        Where every horizontal plane meets the meridian once, slices between horizontal planes, in parts of at most half
        a turn; else the convex parts of the profile, swept step by step.

    Raises
    ------
    InputError
        For what revolution refuses.

    Notes
    -----
    Source: Glaeser, section 3.4, figure 4.

    Examples
    --------
    >>> from vectorplot import textbook
    >>> spool = [(2, 0, 0), (1, 0, 1), (2, 0, 2)]
    >>> [part.face_count for part in textbook.convex_revolution_parts(spool, order=6)]
    [8, 8]
    """
    revolution(meridian, order, angle_deg=angle_deg)  # refuses what makes no body
    points = checked_points(meridian, "meridian")
    profile = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    if profile[-1, 1] < profile[0, 1]:
        profile = profile[::-1]
    extent = float(np.abs(profile - [0.0, profile[0, 1]]).max())
    azimuth = points[int(np.argmax(np.hypot(points[:, 0], points[:, 1]))), :2]
    azimuth = azimuth / norm(azimuth)
    if (np.diff(profile[:, 1]) > ZERO_OF_EXTENT * extent).all() and (angle_deg == FULL_TURN or angle_deg <= HALF_TURN):
        slices = [_in_space(profile[a : b + 1], azimuth) for a, b in _arches(profile)]
        return [revolution(piece, order, angle_deg=angle_deg) for piece in slices]
    return _sectors(profile, azimuth, order, angle_deg)


def _arches(profile: Floats) -> Iterable[tuple[int, int]]:
    """First and last point of the pieces of a rising profile that bulge outwards."""
    sides = np.diff(profile, axis=0)
    turn = sides[:-1, 0] * sides[1:, 1] - sides[:-1, 1] * sides[1:, 0]
    zero = ZERO_OF_EXTENT * float(np.abs(sides).max()) ** 2
    cuts = [0, *(np.flatnonzero(turn < -zero) + 1).tolist(), len(profile) - 1]
    return pairwise(cuts)


def cut_face(points: ArrayLike, normal: ArrayLike, constant: float) -> Floats:
    """The part of a convex face on the inner side of a plane: corners (k,3); (0,3) if nothing but its border is left.

    points (k,3) in order; the inner side is normal . p <= constant; points on the plane are kept.
    Source: Glaeser, section 3.6; erratum G3-13.
    """
    corners = np.asarray(points, dtype=np.float64)
    n = np.asarray(normal, dtype=np.float64)
    extent = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    distance = (matmul(corners, n) - constant) / float(norm(n))
    side = sides_of_plane(distance, ZERO_OF_EXTENT * extent)
    if not (side < 0).any() and (side != 0).any():
        return np.zeros((0, 3))
    height = np.where(side == 0, 0.0, -distance)
    return left_corners(np.array([0, len(corners)]), height).points(corners, 0)


def _in_space(profile: Floats, azimuth: Floats) -> Floats:
    return np.column_stack([profile[:, :1] * azimuth, profile[:, 1]])


def _sectors(profile: Floats, azimuth: Floats, order: int, angle_deg: float) -> list[Mesh]:
    """The convex parts of the profile, closed along the axis, between every two neighbouring meridians."""
    closed = bool((profile[0] == profile[-1]).all())
    outline = profile[:-1] if closed else profile
    if not closed:
        feet = [[[0.0, z]] if r > 0.0 else np.zeros((0, 2)) for r, z in (profile[0], profile[-1])]
        outline = np.concatenate([feet[0], outline, feet[1]])
    if signed_area(outline) < 0.0:
        outline = outline[::-1]
    steps = order if angle_deg == FULL_TURN else order - 1
    angle = np.radians(angle_deg * np.arange(steps + 1) / steps) + arctan2(azimuth[1], azimuth[0])
    parts = [outline[part] for part in convex_polygon_parts(outline)]
    return [_wedge(part, a, b) for part in parts for a, b in pairwise(angle.tolist())]


def _wedge(profile: Floats, first: float, second: float) -> Mesh:
    """The convex polyhedron between a convex profile in two half-planes through the axis."""
    r, z = profile[:, 0], profile[:, 1]
    count = len(r)
    rings = [np.column_stack([r * np.cos(a), r * np.sin(a), z]) for a in (first, second)]
    here = np.arange(count)
    there = np.roll(here, -1)
    on_axis = r <= 0.0
    twin = np.where(on_axis, here, here + count)
    sides = np.stack([here, twin, twin[there], there], axis=1)
    faces = [_without_repeats(side) for side in sides.tolist()]
    faces = [face for face in faces if len(face) > 2]
    used = np.unique(np.concatenate([here, twin]))
    place = dict(zip(used.tolist(), range(len(used)), strict=True))
    lists = [[place[v] for v in face] for face in [*faces, here.tolist(), twin[::-1].tolist()]]
    return polyhedron(np.concatenate(rings)[used], lists)


def _without_repeats(face: list[int]) -> list[int]:
    return [v for k, v in enumerate(face) if v != face[k - 1]]
