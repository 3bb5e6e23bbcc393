"""Bodies as unions of convex parts, and what a polyhedron has in common with a convex one."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import crossed_sides
from vectorplot.geometry.convex_polygons import convex_polygon_parts, flattened, plane_axes, signed_area
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import (
    has_convex_outline,
    zero_distance,
)
from vectorplot.geometry.winding import is_closed_oriented

# Faces that are not convex as unions of convex parts.


def split_faces(mesh: Mesh, chosen: Bools) -> Mesh:
    """The mesh with some faces cut into convex parts.

    chosen: (f,) the faces to be cut, which are planar.
    """
    polygons = mesh.polygons()
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    numbers = np.flatnonzero(~chosen).tolist()
    faces = [polygons[k] for k in numbers]
    for k in np.flatnonzero(chosen).tolist():
        polygon = np.array(polygons[k])
        flat, order = flattened(mesh.vertices[polygon], mesh.area_vectors[k])
        parts = convex_polygon_parts(flat)
        faces.extend(polygon[order[part]].tolist() for part in parts)
        numbers.extend([k] * len(parts))
    return Mesh.from_polygons(mesh.vertices, faces, present=present[numbers])


# What a polyhedron and a convex one have in common: the polyhedron cut by one plane of the other after another.

MAX_PLANES = 10_000
"""The largest number of faces of the convex polyhedron: the other one is cut once for each."""


def polyhedron_intersection(body: Mesh, convex: Mesh) -> Mesh:
    """The part of a closed polyhedron that lies inside a closed convex one.

    Parameters
    ----------
    body : Mesh
        Closed, its faces turned outwards.
    convex : Mesh
        The same, and convex, with at most 10000 faces.

    Returns
    -------
    Mesh
        Faces of body first, in their order, then those of convex that close the cuts; a face that is not present stays
        so.

    Raises
    ------
    InputError
        If a mesh is not closed with all its faces (also those not present) turned outwards, or neither is convex; for a
        convex one of too many faces; where coordinates have no digits left to tell what lies in what.

    Notes
    -----
    If body is convex too, so is the result, and the order of the two does not matter.

    Edge cases: bodies that only touch have an empty intersection; of two faces in one plane that of body stays;
    distances below 1e-9 of the extent are zero. A cut with holes is closed by several convex faces.

    Source: Glaeser, section 3.6; errata G3-12 to G3-15.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> one, other = geometry.box((2, 2, 2)), geometry.box((2, 2, 2), placement=(1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1))
    >>> geometry.polyhedron_intersection(one, other).bounds.tolist()
    [[1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]
    """
    for mesh in (body, convex):
        if not is_closed_oriented(mesh):
            raise InputError("an intersection needs closed bodies whose faces all turn outwards")
    if not has_convex_outline(convex):
        if not has_convex_outline(body):
            raise InputError("the intersection of two bodies that are both not convex is not supported")
        body, convex = convex, body
    if convex.face_count > MAX_PLANES:
        raise InputError(f"the convex body of an intersection has more than {MAX_PLANES} faces")
    corner = convex.vertices[convex.corners[convex.offsets[:-1]]]
    zero = max(zero_distance(mesh.vertices) for mesh in (body, convex))
    for normal, point, shown in zip(convex.face_normals, corner, _present(convex), strict=True):
        if not body.face_count:
            break
        if normal.any():
            body = cut_body(body, normal, point, zero, bool(shown))
    return _compact(body)


def sides_of_plane(distance: Floats, zero: float) -> Ints:
    """(n,) the sides of a plane that points at distances (n,) are on: 0 within zero of it."""
    return np.where(np.abs(distance) <= zero, 0, np.sign(distance)).astype(np.intp)


def cut_body(body: Mesh, normal: Floats, point: Floats, zero: float, shown: bool) -> Mesh:
    """The part of a closed polyhedron behind a plane with an outer normal.

    normal, point: (3,) of the plane: a unit vector, and a point in it.
    Source: Glaeser, section 3.6.
    """
    distance = matmul(body.vertices - point, normal)
    side = sides_of_plane(distance, zero)
    if not (side[body.corners] > 0).any():
        return body
    body, corner_side = _splittable(body, side)
    starts = body.offsets[:-1]
    lowest, highest = np.minimum.reduceat(corner_side, starts), np.maximum.reduceat(corner_side, starts)
    stays = (lowest < 0) | ((lowest == 0) & (highest == 0) & (matmul(body.area_vectors, normal) > 0.0))
    vertices, crossing = _crossings(body, distance, corner_side)
    # Every corner gives itself if it is not outside, and the crossing behind it if there is one.
    woven = np.stack([body.corners, crossing], axis=1)
    keep = np.stack([corner_side <= 0, crossing >= 0], axis=1) & stays[body.corner_face][:, None]
    sizes = np.add.reduceat(keep.sum(axis=1), starts)
    corners = woven[keep]
    on_plane = np.concatenate([side == 0, np.ones(len(vertices) - len(side), dtype=np.bool_)])
    sizes = sizes[sizes > 0]
    caps = _caps(vertices, _border(corners, sizes, on_plane), normal)
    present = np.concatenate([_present(body)[stays], np.full(len(caps), shown)])
    all_sizes = np.concatenate([sizes, [len(cap) for cap in caps]]).astype(np.intp)
    offsets = ragged.offsets(all_sizes)
    return Mesh(vertices, np.concatenate([corners, *caps]), offsets, present)


def _present(body: Mesh) -> Bools:
    return np.ones(body.face_count, dtype=np.bool_) if body.present is None else body.present


def _splittable(body: Mesh, side: Ints) -> tuple[Mesh, Ints]:
    """The body, its faces cut into convex parts where they meet the plane more than twice; (c,) sides of corners."""
    corner_side = side[body.corners]
    starts = body.offsets[:-1]
    meets = (corner_side == 0) | (corner_side * corner_side[body.next_corner] < 0)
    through = (np.minimum.reduceat(corner_side, starts) < 0) & (np.maximum.reduceat(corner_side, starts) > 0)
    many = through & (np.add.reduceat(meets.astype(np.intp), starts) > 2)
    if not many.any():
        return body, corner_side
    body = split_faces(body, many)
    return body, side[body.corners]


def _crossings(body: Mesh, distance: Floats, corner_side: Ints) -> tuple[Floats, Ints]:
    """All vertices and those where edges cross the plane; (c,) the vertex where a corner's edge crosses, or -1."""
    cut = corner_side * corner_side[body.next_corner] < 0
    (low, high), t, number = crossed_sides(body.corners, body.corners[body.next_corner], cut, distance)
    new = body.vertices[low] + t[:, None] * (body.vertices[high] - body.vertices[low])
    return np.concatenate([body.vertices, new]), np.where(cut, len(body.vertices) + number, -1)


def _border(corners: Ints, sizes: Ints, on_plane: Bools) -> list[tuple[int, int]]:
    """The sides of faces in the plane that have no face on their other hand, turned round."""
    a, b = corners, corners[ragged.following(ragged.offsets(sizes))]
    flat = on_plane[a] & on_plane[b] & (a != b)
    a, b = a[flat], b[flat]
    alone = ~np.isin(b * len(on_plane) + a, a * len(on_plane) + b)
    return list(zip(b[alone].tolist(), a[alone].tolist(), strict=True))


def _caps(vertices: Floats, border: list[tuple[int, int]], normal: Floats) -> list[Ints]:
    """The polygons in the plane that the border bounds, counter-clockwise about the normal."""
    if not border:
        return []
    x, y = plane_axes(normal)
    flat = matmul(vertices, np.stack([x, y], axis=1))
    loops = [np.array(loop, dtype=np.intp) for loop in _loops(border, flat)]
    areas = [signed_area(flat[loop]) for loop in loops]
    outer = [loop for loop, area in zip(loops, areas, strict=True) if area > 0.0]
    holes = [loop for loop, area in zip(loops, areas, strict=True) if area < 0.0]
    if not holes:
        return outer
    return _perforated(flat, outer, holes)


def _loops(border: list[tuple[int, int]], flat: Floats) -> list[list[int]]:
    """Closed chains of the border; where it touches itself each chain turns left as sharply as it can."""
    after: dict[int, list[int]] = {}
    for a, b in border:
        after.setdefault(a, []).append(b)
    loops = []
    while after:
        start = next(iter(after))
        loop = [start]
        here = _step(after, None, start, flat)
        while here != start:
            loop.append(here)
            if here not in after:
                raise InputError("an intersection needs closed bodies")
            here = _step(after, loop[-2], here, flat)
        if len(loop) > 2:
            loops.append(loop)
    return loops


def _step(after: dict[int, list[int]], before: int | None, here: int, flat: Floats) -> int:
    """The vertex that follows; its edge is used up."""
    choices = after[here]
    chosen = choices[0]
    if len(choices) > 1 and before is not None:
        u, v = flat[here] - flat[before]

        def turn(choice: int) -> float:
            p, q = flat[choice] - flat[here]
            return float(arctan2(u * q - v * p, u * p + v * q))

        chosen = max(choices, key=turn)
    choices.remove(chosen)
    if not choices:
        del after[here]
    return chosen


def _perforated(flat: Floats, outer: list[Ints], holes: list[Ints]) -> list[Ints]:
    """Convex parts of the polygons that have holes; the others as they are."""
    import shapely

    shapes = [shapely.Polygon(flat[loop]) for loop in outer]
    inside: list[list[Ints]] = [[] for _ in outer]
    for hole in holes:
        shape = shapely.Polygon(flat[hole])
        around = [k for k, candidate in enumerate(shapes) if candidate.covers(shape)]
        if not around:
            raise InputError("coordinates have no digits left to tell in which face of the intersection a hole lies")
        inside[min(around, key=lambda k: shapes[k].area)].append(hole)
    faces: list[Ints] = []
    for loop, cut_out in zip(outer, inside, strict=True):
        numbers = np.concatenate([loop, *cut_out])
        if cut_out:
            parts = convex_polygon_parts(flat[loop], [flat[hole] for hole in cut_out])
            faces.extend(numbers[part] for part in parts)
        else:
            faces.append(loop)
    return faces


def _compact(body: Mesh) -> Mesh:
    """The mesh without vertices that no face uses."""
    used, corners = np.unique(body.corners, return_inverse=True)
    return Mesh(body.vertices[used], corners.astype(np.intp), body.offsets, body.present)
