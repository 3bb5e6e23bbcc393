"""Rays from points to the eye, as plainly as possible, against triangles and their edges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import (
    IN_TRIANGLE,
    NO_AREA,
    PARALLEL_SINE,
    REACH_OF_CLEARANCE,
    ZERO_OF_EXTENT,
)

# Triangles for the rays: polygons cut by their ears, on their own and as plainly as possible.


def triangulated(mesh: Mesh) -> tuple[Ints, Ints]:
    """Triangles (t,3) of vertex indices that cover the faces that are there, and (t,) the face each belongs to.

    Edge cases: a convex face without area gives triangles without area; ears without area are left out. A face that is
    not planar is the triangles that convex_faces makes of it: nothing but that convention says which surface
    it is.
    """
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    convex, bent = faces_are_convex(mesh), faces_are_bent(mesh)
    fans, face = ragged.fans(mesh.offsets)
    wanted = (present & convex & ~bent)[face]
    triangles, faces = mesh.corners[fans[wanted]], face[wanted]
    ears = [(ear_clipping(mesh, face), face) for face in np.flatnonzero(present & ~convex & ~bent).tolist()]
    more = [with_area(mesh, np.asarray(cut, dtype=np.intp).reshape(-1, 3)) for cut, _ in ears]
    owner = [np.full(len(cut), face, dtype=np.intp) for cut, (_, face) in zip(more, ears, strict=True)]
    cut, source = bent_triangles(mesh, np.flatnonzero(present & bent))
    return np.concatenate([triangles, *more, cut]), np.concatenate([faces, *owner, source])


def faces_are_bent(mesh: Mesh) -> Bools:
    """(f,) whether a face has a corner off its mean plane through its first corner."""
    if not mesh.face_count:
        return np.zeros(0, dtype=np.bool_)
    arm = mesh.vertices[mesh.corners] - mesh.vertices[mesh.corners[mesh.offsets[:-1]]][mesh.corner_face]
    height = np.abs(np.einsum("ij,ij->i", arm, mesh.face_normals[mesh.corner_face]))
    limit = ZERO_OF_EXTENT * float((mesh.bounds[1] - mesh.bounds[0]).max())
    return np.asarray(np.maximum.reduceat(height, mesh.offsets[:-1]) > limit)


def bent_triangles(mesh: Mesh, faces: Ints) -> tuple[Ints, Ints]:
    """Triangles of faces that are not planar, and their faces."""
    if not len(faces):
        return np.zeros((0, 3), dtype=np.intp), faces
    corners = mesh.corners[np.isin(mesh.corner_face, faces)]
    offsets = ragged.offsets(mesh.face_sizes[faces])
    cut = convex_faces(np.ascontiguousarray(mesh.vertices.T), corners, offsets, 0.0)
    return cut.corners.reshape(-1, 3), faces[cut.source]


def faces_are_convex(mesh: Mesh) -> Bools:
    """(f,) whether a face turns left at every corner."""
    here = mesh.vertices[mesh.corners]
    leaving = here[mesh.next_corner] - here
    arriving = np.empty_like(leaving)
    arriving[mesh.next_corner] = leaving
    turn = np.cross(arriving, leaving)
    scale = norm(arriving) * norm(leaving)
    left = np.einsum("ij,ij->i", turn, mesh.face_normals[mesh.corner_face]) >= -PARALLEL_SINE * scale
    return np.asarray(np.bincount(mesh.corner_face[~left], minlength=mesh.face_count) == 0)


def ear_clipping(mesh: Mesh, face: int) -> list[list[int]]:
    """Triangles of one simple polygon of any form, as vertex indices."""
    ring = mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]].tolist()
    normal = mesh.face_normals[face]
    axis = int(np.argmax(np.abs(normal)))
    keep = [(axis + 1) % 3, (axis + 2) % 3]
    plane = mesh.vertices[ring][:, keep] - mesh.vertices[ring[0]][keep]
    if normal[axis] < 0.0:
        plane = plane[:, ::-1]
    left = list(range(len(ring)))
    triangles = []
    while len(left) > 3:
        k = next_ear(plane, left)
        corners = [left[k - 1], left[k], left[(k + 1) % len(left)]]
        triangles.append([ring[corner] for corner in corners])
        del left[k]
    triangles.append([ring[corner] for corner in left])
    return triangles


def with_area(mesh: Mesh, triangles: Ints) -> Ints:
    """Those of some triangles that have an area."""
    corners = mesh.vertices[triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    twice = norm(np.cross(sides[:, 0], sides[:, 1]))
    kept = np.asarray(twice > 2.0 * NO_AREA * (sides**2).sum(axis=2).max(axis=1, initial=0.0))
    return np.asarray(triangles[kept], dtype=np.intp)


def next_ear(plane: Floats, left: list[int]) -> int:
    """Position of a corner that can be cut off: a straight one, else one whose triangle holds no other corner."""
    here = plane[left]
    before, after = np.roll(here, 1, axis=0), np.roll(here, -1, axis=0)
    turns = area(before, here, after)
    scale = norm(here - before) * norm(after - here)
    straight = np.flatnonzero(np.abs(turns) <= PARALLEL_SINE * scale)
    if len(straight):
        return int(straight[0])
    for k in np.flatnonzero(turns > 0.0).tolist():
        a, b, c = before[k], here[k], after[k]
        inside = (area(a, b, here) >= 0.0) & (area(b, c, here) >= 0.0) & (area(c, a, here) >= 0.0)
        corner = (here == a).all(axis=1) | (here == b).all(axis=1) | (here == c).all(axis=1)
        if not (inside & ~corner).any():
            return int(k)
    return int(np.argmax(turns))


def area(a: Floats, b: Floats, c: Floats) -> Floats:
    """Twice the signed area of triangles in the plane, positive when counter-clockwise."""
    u, v = b - a, c - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


# Sight rays from points to the eye, against every triangle of the scene.
#
# Slow and plain, and independent of the engine it checks. Trees and grids are replaced by two rounds of bounding
# spheres.

CHUNK = 1 << 18
CLUSTER = 16


@dataclass(frozen=True)
class Rays:
    """Sight rays: origin (n,3), unit direction to the eye (n,3), length (n,); whether the eye is at their end."""

    origin: Floats
    direction: Floats
    length: Floats
    ends_in_eye: bool


@dataclass(frozen=True)
class Solids:
    """Simplexes (m,k,3), triangles or edges, of items (m,), in clusters of neighbours with bounding spheres."""

    corners: Floats
    item: Ints

    def __len__(self) -> int:
        return len(self.item)

    @cached_property
    def centre(self) -> Floats:
        """(m,3) their middles."""
        return middles(self.corners)

    @cached_property
    def radius(self) -> Floats:
        """(m,) the distances of their farthest corners from these."""
        reach = np.zeros(len(self))
        for corner in np.moveaxis(self.corners, 1, 0):
            np.maximum(reach, norm(corner - self.centre), out=reach)
        return reach


def middles(corners: Floats) -> Floats:
    """(m,3) the means of the corners (m,k,3) of each simplex."""
    total = corners[:, 0].copy()
    for k in range(1, corners.shape[1]):
        total += corners[:, k]
    return np.asarray(total / corners.shape[1])


def sight_rays(camera: Camera, points: Floats, middle: Floats, size: float) -> Rays:
    """The rays from the points to the eye in coordinates in which the scene fits into the unit cube about 0."""
    origin = (points - middle) / size
    # Beyond this every ray has left the scene, whose corners lie within 0.87 of its middle.
    out = norm(origin) + 1.0
    if camera.parallel:
        direction = np.subtract(camera.eye, camera.target) / camera.distance
        return Rays(origin, np.broadcast_to(direction, origin.shape), out, False)
    arm = (np.asarray(camera.eye) - points) / size
    length = norm(arm)
    unit = arm / np.where(length > 0.0, length, 1.0)[:, None]
    return Rays(origin, unit, np.minimum(length, out), True)


def occluders(scene: Scene, middle: Floats, size: float, items: Sequence[int] | None) -> tuple[Solids, Solids]:
    """The triangles and the edges of the faces that can hide something, in unit coordinates, near ones together."""
    wanted = range(len(scene.items)) if items is None else items
    owners = [index for index in wanted if scene.items[index].hides]
    triangles, edges = [np.zeros((0, 3, 3))], [np.zeros((0, 2, 3))]
    for index in owners:
        mesh = scene.items[index].mesh
        vertices = (mesh.vertices - middle) / size
        triangles.append(vertices[triangulated(mesh)[0]])
        edges.append(vertices[edges_of_faces(mesh)])
    which = np.array(owners, dtype=np.intp)
    return (
        near_together(np.concatenate(triangles), np.repeat(which, [len(part) for part in triangles[1:]])),
        near_together(np.concatenate(edges), np.repeat(which, [len(part) for part in edges[1:]])),
    )


def edges_of_faces(mesh: Mesh) -> Ints:
    """(e,2) vertices of the edges of the faces that are there, each edge once."""
    pairs = np.sort(np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1), axis=1)
    if mesh.present is not None:
        pairs = pairs[mesh.present[mesh.corner_face]]
    many = max(len(mesh.vertices), 1)
    key = np.unique(pairs[:, 0] * many + pairs[:, 1])
    return np.stack(np.divmod(key, many), axis=1)


def near_together(corners: Floats, item: Ints) -> Solids:
    """The simplexes in the order of a space-filling curve through their middles."""
    cell = np.clip(((middles(corners) + 0.5) * 1024.0), 0.0, 1023.0).astype(np.int64)
    code = np.zeros(len(item), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    order = np.argsort(code, kind="stable")
    return Solids(corners[order], item[order])


def near_pairs(rays: Rays, solids: Solids) -> Iterator[tuple[Ints, Ints]]:
    """Pairs (ray, simplex) in portions; every pair that is no further apart than REACH_OF_CLEARANCE is among them."""
    centre, radius = solids.centre, solids.radius
    starts = np.arange(0, len(solids), CLUSTER)
    if len(starts) == 0:
        return
    sizes = np.diff(np.append(starts, len(solids)))
    low = np.minimum.reduceat(centre - radius[:, None], starts, axis=0)
    high = np.maximum.reduceat(centre + radius[:, None], starts, axis=0)
    cluster_centre, cluster_radius = (low + high) / 2.0, norm(high - low) / 2.0
    step = max(1, CHUNK // len(starts))
    for begin in range(0, len(rays.length), step):
        ray, cluster = np.nonzero(near_each(rays, slice(begin, begin + step), cluster_centre, cluster_radius))
        ray += begin
        for part in range(0, len(ray), CHUNK // CLUSTER):
            some = slice(part, part + CHUNK // CLUSTER)
            count = sizes[cluster[some]]
            inner = ragged.place(count)
            simplex = np.repeat(starts[cluster[some]], count) + inner
            of_ray = np.repeat(ray[some], count)
            kept = near(rays, of_ray, centre.take(simplex, axis=0), radius.take(simplex))
            yield of_ray[kept], simplex[kept]


def near(rays: Rays, ray: Ints, centre: Floats, radius: Floats) -> Ints:
    """Indices of the pairs whose ray comes nearer to the sphere than REACH_OF_CLEARANCE."""
    # Rows are taken in half the time in which they are indexed.
    arm = centre - rays.origin.take(ray, axis=0)
    along = dot(arm, rays.direction.take(ray, axis=0))
    foot = np.clip(along, 0.0, rays.length.take(ray))
    square = dot(arm, arm) - foot * (2.0 * along - foot)
    return np.flatnonzero(square <= (radius + 2.0 * REACH_OF_CLEARANCE) ** 2)


def near_each(rays: Rays, some: slice, centre: Floats, radius: Floats) -> Bools:
    """(r,m) whether each of some rays comes nearer to each sphere than REACH_OF_CLEARANCE."""
    origin, direction = rays.origin[some], rays.direction[some]
    # Products of matrices instead of differences: within the unit cube, rounding is far below the reach.
    along = matmul(direction, centre.T) - dot(direction, origin)[:, None]
    square = dot(centre, centre) - 2.0 * (matmul(origin, centre.T)) + dot(origin, origin)[:, None]
    foot = np.clip(along, 0.0, rays.length[some, None])
    return np.asarray(square - foot * (2.0 * along - foot) <= (radius + 2.0 * REACH_OF_CLEARANCE) ** 2)


def near_any(rays: Rays, centre: Floats, radius: Floats) -> Bools:
    """(m,) whether some ray comes nearer to a sphere than REACH_OF_CLEARANCE."""
    found = np.zeros(len(radius), dtype=np.bool_)
    step = max(1, CHUNK // max(len(radius), 1))
    for begin in range(0, len(rays.length), step):
        found |= near_each(rays, slice(begin, begin + step), centre, radius).any(axis=0)
    return found


def hits(rays: Rays, triangles: Solids, item_count: int) -> tuple[Ints, Floats]:
    """How many items each ray meets, and the distance from its point to the nearest triangle on its line."""
    clearance = np.full(len(rays.length), REACH_OF_CLEARANCE)
    met = [np.zeros(0, dtype=np.int64)]
    for ray, index in near_pairs(rays, triangles):
        a, b, c = (triangles.corners[:, k].take(index, axis=0) for k in range(3))
        origin, direction, length = (part.take(ray, axis=0) for part in (rays.origin, rays.direction, rays.length))
        along = meeting(origin, direction, a, b, c)
        on_line = np.isfinite(along)
        ray, index, along, length = ray[on_line], index[on_line], along[on_line], length[on_line]
        distance = distance_to_triangle(origin[on_line], a[on_line], b[on_line], c[on_line])
        free = distance > ZERO_OF_EXTENT
        np.minimum.at(clearance, ray[free], distance[free])
        if rays.ends_in_eye:
            np.minimum.at(clearance, ray[free], np.abs(length - along)[free])
        hit = free & (along > 0.0) & (along < length)
        met.append(ray[hit].astype(np.int64) * item_count + triangles.item[index[hit]])
    once = np.unique(np.concatenate(met))
    return np.bincount(once // max(item_count, 1), minlength=len(rays.length)), clearance


def meeting(origin: Floats, direction: Floats, a: Floats, b: Floats, c: Floats) -> Floats:
    """Signed distances along the lines to the closed triangles; NaN where they do not meet or are parallel."""
    u, v = b - a, c - a
    normal = cross(u, v)
    length = norm(normal)
    slope = np.einsum("ij,ij->i", normal, direction)
    crossing = np.abs(slope) > PARALLEL_SINE * length
    safe = np.where(crossing, slope, 1.0)
    arm = origin - a
    along = -np.einsum("ij,ij->i", normal, arm) / safe
    turned = cross(direction, arm)
    # Barycentric coordinates of the meeting point, from the volumes that the line spans with the edges.
    second = np.einsum("ij,ij->i", v, turned) / safe
    third = -np.einsum("ij,ij->i", u, turned) / safe
    inside = (second >= -IN_TRIANGLE) & (third >= -IN_TRIANGLE) & (second + third <= 1.0 + IN_TRIANGLE)
    return np.where(crossing & inside, along, np.nan)


def distance_to_triangle(point: Floats, a: Floats, b: Floats, c: Floats) -> Floats:
    """Distances of points from triangles, pair by pair."""
    normal = cross(b - a, c - a)
    length = norm(normal)
    height = np.einsum("ij,ij->i", normal, point - a) / np.where(length > 0.0, length, 1.0)
    above = np.ones(len(point), dtype=np.bool_)
    for start, end in ((a, b), (b, c), (c, a)):
        above &= np.einsum("ij,ij->i", cross(end - start, point - start), normal) >= 0.0
    border = np.minimum(distance_to_segment(point, a, b), distance_to_segment(point, b, c))
    border = np.minimum(border, distance_to_segment(point, c, a))
    return np.where(above & (length > 0.0), np.abs(height), border)


def distance_to_segment(point: Floats, a: Floats, b: Floats) -> Floats:
    """Distances of points from segments, pair by pair."""
    edge, arm = b - a, point - a
    square = np.einsum("ij,ij->i", edge, edge)
    share = np.clip(np.einsum("ij,ij->i", arm, edge) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.asarray(norm(arm - share[:, None] * edge))


def edge_distances(rays: Rays, edges: Solids, own: Floats | None = None, off: Floats | None = None) -> Floats:
    """(n,) distance from each ray to the nearest edge that its point does not touch, at most REACH_OF_CLEARANCE.

    own (n,): edges no further from the point than this do not count either; None: those that touch it. off (m,): how
    far edges may be off; the distances are less by that, but no less than 0. None: they are exact.
    """
    touching = np.full(len(rays.length), ZERO_OF_EXTENT) if own is None else own
    nearer = np.zeros(len(edges)) if off is None else off
    # Edges beyond the reach are not looked at; they may be nearer than that.
    clearance = np.full(len(rays.length), REACH_OF_CLEARANCE - nearer.max(initial=0.0))
    for ray, index in near_pairs(rays, edges):
        start, end = edges.corners[index, 0], edges.corners[index, 1]
        free = distance_to_segment(rays.origin[ray], start, end) > touching[ray]
        ray, index, start, end = ray[free], index[free], start[free], end[free]
        origin = rays.origin[ray]
        tip = origin + rays.direction[ray] * rays.length[ray][:, None]
        np.minimum.at(clearance, ray, distance_of_segments(origin, tip, start, end) - nearer[index])
    return np.asarray(np.maximum(clearance, 0.0))


def distance_of_segments(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    """Distances of the segments ab from the segments cd, pair by pair."""
    u, v, w = b - a, d - c, c - a
    normal = cross(u, v)
    square = np.einsum("ij,ij->i", normal, normal)
    bound = np.einsum("ij,ij->i", u, u) * np.einsum("ij,ij->i", v, v)
    askew = square > PARALLEL_SINE**2 * bound
    safe = np.where(askew, square, 1.0)
    s = np.einsum("ij,ij->i", cross(w, v), normal) / safe
    t = np.einsum("ij,ij->i", cross(w, u), normal) / safe
    crossing = askew & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    inner = np.abs(np.einsum("ij,ij->i", w, normal)) / np.sqrt(safe)
    ends = np.minimum(distance_to_segment(a, c, d), distance_to_segment(b, c, d))
    ends = np.minimum(ends, np.minimum(distance_to_segment(c, a, b), distance_to_segment(d, a, b)))
    return np.where(crossing, inner, ends)
