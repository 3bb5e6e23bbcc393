"""Unions of polyhedra: what closed bodies that touch or overlap are together, without the faces inside of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, not_installed
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.budget import in_pieces, in_turn, may_stop, slices
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import without_loose_vertices
from vectorplot.geometry.regions import POLYGON, REGIONS_AT_ONCE, mosaics, polygons_of, unions, without_splinters
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.solids import zero_distance
from vectorplot.geometry.vectors import component_sum, cross, dot
from vectorplot.geometry.weld import close_points, distinct_points
from vectorplot.geometry.winding import mesh_edges
from vectorplot.tolerances import LEAST_DIVISOR, SAME_POINT_OF_ZERO, UNITED_GRID_OF_ZERO

UPWARDS = np.array([0.0, 0.0, 1.0])
"""The normal of faces without area."""

FACES_AT_ONCE = 1 << 14
"""About so many faces are compared with all bodies before work may stop."""


def polyhedron_union(bodies: Sequence[Mesh]) -> Mesh:
    """The body that closed polyhedra are together.

    Parameters
    ----------
    bodies : sequence of Mesh
        Each closed, its faces turned outwards.

    Returns
    -------
    Mesh
        Without what lies inside, and faces in one plane that have a side in common as one: a convex polygon, or
        triangles. Vertices of the bodies keep their coordinates.

    Raises
    ------
    InputError
        If a body is not closed with all its faces (also those not present) turned outwards; where bodies are not
        convex and manifold3d (the extra ``union``) is not installed; where coordinates have no digits left to tell what
        lies in what.

    Notes
    -----
    Convex bodies are united by their planes: of the faces in a plane stays what is covered neither by sections of
    other bodies nor by faces that look the other way. Bodies that are not convex are left to manifold3d, and what comes
    of it is joined plane by plane, or left in triangles where bodies touch so nearly that this does not close.

    Edge cases: a single body stays as it is; no body is a mesh without faces; bodies that touch in a point, along an
    edge or not at all stay pieces of one mesh; distances below 1e-9 of the extent are zero.

    Source: Requicha and Voelcker (1985), Boolean operations in solid modeling: boundary evaluation.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> wide, high = geometry.box((2, 1, 1)), geometry.box((1, 1, 2))
    >>> body = geometry.polyhedron_union([wide, high])
    >>> body.is_closed, len(body.vertices), body.bounds.tolist()
    (True, 12, [[0.0, 0.0, 0.0], [2.0, 1.0, 2.0]])
    """
    if len(bodies) == 1:
        return bodies[0]
    stack = _Stack.of(bodies)
    if not stack.mesh.is_closed:
        number = next(k for k, body in enumerate(bodies, 1) if not body.is_closed)
        raise InputError(f"body {number} of {len(bodies)} is not closed: only closed bodies are united")
    if not stack.mesh.face_count:
        return stack.mesh
    planes, whole = _Planes.of(stack), None
    if stack.are_convex:
        regions, plane, turned = planes.outer_regions()
    else:
        whole = _by_manifold(stack)
        stack = _Stack.of([whole])
        planes = _Planes.of(stack)
        regions, plane, turned = planes.regions()
    found = _Outline.of(planes, regions, plane, turned).mesh()
    if not found.is_closed and whole is not None and whole.is_closed:
        # Faces so thin that they do not tell which plane they are in: they stay as manifold3d has made them.
        return whole
    if not found.is_closed:
        raise InputError("union: bodies so nearly touch that coordinates do not tell what lies in what")
    return stack.placed(found)


# The bodies, all in one mesh in the unit box.


@dataclass(frozen=True, eq=False)
class _Stack:
    """Bodies as one mesh in the unit box, their vertices that are the same made one.

    zero: what counts as none; middle, size: where the box lies; vertices: (v,3) as the bodies had them; first_vertex,
    first_face: (b+1,) those of each body; number: (v,) which vertex each one is; mesh: with its own vertices still.
    """

    mesh: Mesh
    vertices: Floats
    number: Ints
    first_vertex: Ints
    first_face: Ints
    middle: Floats
    size: float
    zero: float

    @classmethod
    def of(cls, bodies: Sequence[Mesh]) -> _Stack:
        """That of bodies."""
        none = np.zeros((0, 3))
        vertices = np.concatenate([none, *(body.vertices for body in bodies)])
        first_vertex = ragged.offsets([len(body.vertices) for body in bodies])
        corners = [body.corners + first for body, first in zip(bodies, first_vertex.tolist(), strict=False)]
        sizes = np.concatenate([np.zeros(0, dtype=np.intp), *(body.face_sizes for body in bodies)])
        low, high = (vertices.min(axis=0), vertices.max(axis=0)) if len(vertices) else np.zeros((2, 3))
        middle = (low + high) / 2.0
        # A power of two: no digit is lost.
        size = float(2.0 ** np.frexp(max(float((high - low).max()), LEAST_DIVISOR))[1])
        zero = zero_distance(vertices) / size if len(vertices) else 0.0
        points = (vertices - middle) / size
        number = _alike(points, zero)
        mesh = Mesh(points[number], np.concatenate([number[:0], *corners]), ragged.offsets(sizes))
        first_face = ragged.offsets([body.face_count for body in bodies])
        return cls(mesh, vertices, number, first_vertex, first_face, middle, size, zero)

    @property
    def are_convex(self) -> bool:
        """Whether no vertex of any body lies outside the plane of one of its faces."""
        mesh = self.mesh
        normal, at = mesh.face_normals, mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
        body = ragged.owner(np.diff(self.first_face))
        many = np.diff(self.first_vertex)[body]
        for low, high in ragged.batches(many, PAIRS_AT_ONCE):
            some = body[low:high]
            vertex = ragged.ranges(self.first_vertex[some], many[low:high])
            face = np.repeat(np.arange(low, high), many[low:high])
            if float(dot(mesh.vertices[vertex] - at[face], normal[face]).max(initial=0.0)) > self.zero:
                return False
        return True

    def placed(self, mesh: Mesh) -> Mesh:
        """A mesh of the vertices of the stack, and others behind them, where the bodies stand."""
        own = len(self.vertices)
        new = mesh.vertices[own:] * self.size + self.middle
        return without_loose_vertices(Mesh(np.concatenate([self.vertices, new]), mesh.corners, mesh.offsets))


# The planes that faces lie in, and what is left of the faces in each.


@dataclass(frozen=True, eq=False)
class _Planes:
    """The planes of the faces of a stack: plane p is where the last row of frames[p] times a point is heights[p].

    plane: (f,) that of each face; turned: (f,) whether the face looks against its plane's normal.
    """

    stack: _Stack
    frames: Floats
    heights: Floats
    plane: Ints
    turned: Bools

    @classmethod
    def of(cls, stack: _Stack) -> _Planes:
        """Those of the faces; planes that differ by less than zero are one."""
        mesh, zero = stack.mesh, stack.zero
        normals = mesh.face_normals
        both = np.concatenate([normals, -normals])
        label = _alike(both, zero)
        along, against = label[: len(normals)], label[len(normals) :]
        turned, axis = along > against, np.minimum(along, against)
        at = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
        height = dot(at, both[axis])
        order = np.lexsort((height, axis))
        new = (np.diff(axis[order], prepend=-1) != 0) | (np.diff(height[order], prepend=-np.inf) > zero)
        plane = np.zeros(len(normals), dtype=np.intp)
        plane[order] = np.cumsum(new) - 1
        kept = order[new]
        directed = both[axis[kept]]
        directed = np.where(directed.any(axis=1)[:, None], directed, UPWARDS)
        return cls(stack, axis_frame(directed), height[kept], plane, turned)

    def flat(self, points: Floats, plane: Ints) -> Floats:
        """(2,n) points (n,3) in the coordinates of planes (n,)."""
        return np.stack([dot(points, self.frames[plane, row]) for row in (0, 1)])

    def raised(self, xy: Floats, plane: Ints) -> Floats:
        """(n,3) the points with coordinates (n,2) in planes (n,)."""
        e, f, g = (self.frames[plane, row] for row in range(3))
        return np.asarray(xy[:, :1] * e + xy[:, 1:] * f + self.heights[plane, None] * g)

    def outer_regions(self) -> tuple[Any, Ints, Bools]:
        """Polygons (n,) that bound the union of convex bodies, the plane of each, and whether it is turned."""
        order = np.argsort(self.plane, kind="stable")
        sizes = np.bincount(self.plane)
        starts = ragged.offsets(sizes)
        edges = mesh_edges(self.stack.mesh)
        first_edge = np.searchsorted(edges[:, 0], self.stack.first_vertex)
        parts = []
        for low, high in ragged.batches(sizes, FACES_AT_ONCE):
            faces = order[starts[low] : starts[high]]
            parts.append(self._outer_regions(faces, edges, first_edge))
        return _in_a_row(parts)

    def regions(self) -> tuple[Any, Ints, Bools]:
        """The same of a body that has no face inside."""
        parts = []
        order = np.argsort(self.plane, kind="stable")
        for some in in_turn(slices(len(order), FACES_AT_ONCE)):
            parts.append(self._own_regions(order[some]))
        regions, key = (np.concatenate(column) for column in zip(*parts, strict=True))
        keys, which = np.unique(key, return_inverse=True)
        # Planes may have faces in two batches.
        regions = self._united(regions, which) if len(keys) < len(key) else regions
        parts, of = without_splinters(regions, self.grid)
        return parts, keys[of] >> 1, (keys[of] & 1).astype(np.bool_)

    @property
    def grid(self) -> float:
        """The meshes on which regions in the planes are united."""
        return UNITED_GRID_OF_ZERO * self.stack.zero

    def _own_regions(self, faces: Ints) -> tuple[Any, Ints]:
        """(k,) what faces cover of each plane, those of both sides apart; (k,) twice the plane, one more if turned."""
        mesh = self.stack.mesh
        corner, offsets = ragged.take(mesh.offsets, faces)
        flat = self.flat(mesh.vertices[mesh.corners[corner]], np.repeat(self.plane[faces], np.diff(offsets)))
        keys, group = np.unique(2 * self.plane[faces] + self.turned[faces], return_inverse=True)
        return self._united(polygons_of(flat, offsets), group), keys

    def _united(self, polygons: Any, group: Ints) -> Any:
        """(g,) the unions of groups 0, 1, ... of polygons, in a tenth of the time where no two of a group overlap."""
        import shapely

        alone = np.bincount(group) == 1
        first = np.argsort(group, kind="stable")[ragged.starts(np.bincount(group))]
        found: Any = np.where(alone, polygons[first], None)
        several = np.flatnonzero(~alone)
        if not len(several):
            return found
        some = ~alone[group]
        polygons, group = polygons[some], np.searchsorted(several, group[some])
        regions, sound = _mosaics(polygons, group, 0, len(several))
        # What overlaps is counted twice, or crosses itself.
        whole = np.bincount(group, shapely.area(polygons))
        sound &= np.abs(whole - shapely.area(regions)) <= self.grid * shapely.length(regions)
        sound &= shapely.is_valid(regions)
        if not sound.all():
            again = np.flatnonzero(~sound)
            rest = ~sound[group]
            regions[again] = unions(polygons[rest], np.searchsorted(again, group[rest]), self.grid)
        found[several] = regions
        return found

    def _outer_regions(self, faces: Ints, edges: Ints, first_edge: Ints) -> tuple[Any, Ints, Bools]:
        """Those in the planes of some faces."""
        import shapely

        own, keys = self._own_regions(faces)
        removed, of = [own], [keys ^ 1]
        plane, body = self._straddled(faces)
        many = np.diff(first_edge)[body]
        for low, high in ragged.batches(many, PAIRS_AT_ONCE):
            sections, which = self._sections(plane[low:high], body[low:high], edges, first_edge)
            for side in (0, 1):
                removed.append(sections)
                of.append(2 * which + side)
        gone, at = np.concatenate(removed), np.concatenate(of)
        place = np.minimum(np.searchsorted(keys, at), len(keys) - 1)
        known = keys[place] == at
        covered, group = np.unique(place[known], return_inverse=True)
        if len(covered):
            covers = self._united(gone[known], group)
            less = in_pieces(
                lambda some, cover: shapely.difference(some, cover, grid_size=self.grid),
                REGIONS_AT_ONCE,
                own[covered],
                covers,
            )
            own = own.copy()
            own[covered] = less
        parts, of_part = without_splinters(own, self.grid)
        return parts, keys[of_part] >> 1, (keys[of_part] & 1).astype(np.bool_)

    def _straddled(self, faces: Ints) -> tuple[Ints, Ints]:
        """The pairs (plane, body), by planes, of bodies that reach to both sides of a plane, near one of the faces."""
        stack, mesh = self.stack, self.stack.mesh
        corner, offsets = ragged.take(mesh.offsets, faces)
        at = mesh.vertices[mesh.corners[corner]]
        low, high = (best.reduceat(at, offsets[:-1], axis=0).T for best in (np.minimum, np.maximum))
        first = stack.first_vertex[:-1]
        body_low, body_high = (best.reduceat(mesh.vertices, first, axis=0).T for best in (np.minimum, np.maximum))
        face, body = overlapping_boxes(low, high, body_low + stack.zero, body_high - stack.zero)
        pair = np.unique(self.plane[faces][face] * len(first) + body)
        plane, body = pair // len(first), pair % len(first)
        many = np.diff(stack.first_vertex)[body]
        kept = [np.zeros(0, dtype=np.bool_)]
        for begin, end in ragged.batches(many, PAIRS_AT_ONCE):
            some, sizes = body[begin:end], many[begin:end]
            height = self._over(mesh.vertices[ragged.ranges(first[some], sizes)], np.repeat(plane[begin:end], sizes))
            least, most = (best.reduceat(height, ragged.starts(sizes)) for best in (np.minimum, np.maximum))
            kept.append((least < 0.0) & (most > 0.0))
        straddles = np.concatenate(kept)
        return plane[straddles], body[straddles]

    def _over(self, points: Floats, plane: Ints) -> Floats:
        """(n,) how far points lie over planes; zero where they lie in them."""
        height = dot(points, self.frames[plane, 2]) - self.heights[plane]
        return np.where(np.abs(height) <= self.stack.zero, 0.0, height)

    def _sections(self, plane: Ints, body: Ints, edges: Ints, first_edge: Ints) -> tuple[Any, Ints]:
        """Polygons that planes cut out of convex bodies, pair by pair, and the plane of each."""
        import shapely

        points = self.stack.mesh.vertices
        many = np.diff(first_edge)[body]
        pair = ragged.owner(many)
        a, b = points[edges[ragged.ranges(first_edge[body], many)]].transpose(1, 0, 2)
        over_a, over_b = self._over(a, plane[pair]), self._over(b, plane[pair])
        meets = over_a * over_b <= 0.0
        a, b, over_a, over_b, pair = a[meets], b[meets], over_a[meets], over_b[meets], pair[meets]
        length = over_a - over_b
        part = np.where(length != 0.0, over_a / np.where(length != 0.0, length, 1.0), 0.0)[:, None]
        met = np.where(part == 1.0, b, a + part * (b - a))
        flat = self.flat(met, plane[pair]).T
        which, group = np.unique(pair, return_inverse=True)
        hulls = shapely.convex_hull(shapely.multipoints(flat, indices=group))
        full = shapely.get_type_id(hulls) == POLYGON
        return hulls[full], plane[which[full]]


def _first_equal(points: Floats) -> Ints:
    """(n,) the smallest position of a point equal to each of the points (n,3)."""
    number = distinct_points(points)[1]
    first = np.zeros(int(number.max(initial=-1)) + 1, dtype=np.intp)
    first[number[::-1]] = np.arange(len(points))[::-1]
    return first[number]


def _alike(points: Floats, tolerance: float) -> Ints:
    """(n,) the smallest position among the points (n,3) that each one is chained to by steps within a tolerance."""
    equal = _first_equal(points)
    first, number = np.unique(equal, return_inverse=True)
    return first[close_points(points[first], tolerance)[number]]


def _mosaics(polygons: Any, group: Ints, low: int, high: int) -> tuple[Any, Bools]:
    """The unions of groups low to high of polygons, and which of them are found: those of polygons that overlap need
    not be."""
    import shapely

    some = (low <= group) & (group < high)
    try:
        return mosaics(polygons[some], group[some] - low), np.ones(high - low, dtype=np.bool_)
    except shapely.errors.GEOSException:
        if high - low == 1:
            return polygons[some][:1], np.zeros(1, dtype=np.bool_)
    middle = (low + high) // 2
    parts = (_mosaics(polygons, group, low, middle), _mosaics(polygons, group, middle, high))
    regions, found = (np.concatenate(column) for column in zip(*parts, strict=True))
    return regions, found


def _in_a_row(parts: list[tuple[Any, Ints, Bools]]) -> tuple[Any, Ints, Bools]:
    """Columns of several batches as one."""
    regions, plane, turned = (np.concatenate(column) for column in zip(*parts, strict=True))
    return regions, plane, turned


# From polygons in planes to a mesh: their corners made one, sides cut where others end.


@dataclass(frozen=True, eq=False)
class _Outline:
    """Rings around polygons in planes, the outer one of each first.

    points: (v,3) the vertices of the stack and others; vertex: (n,) the corners of all rings; offsets: (r+1,) of rings;
    ring: (p+1,) of polygons; plane, turned: (p,) of polygons.
    """

    planes: _Planes
    points: Floats
    vertex: Ints
    offsets: Ints
    ring: Ints
    plane: Ints
    turned: Bools

    @classmethod
    def of(cls, planes: _Planes, polygons: Any, plane: Ints, turned: Bools) -> _Outline:
        """That of polygons (p,) without splinters."""
        import shapely

        rings, part = shapely.get_rings(shapely.orient_polygons(polygons), return_index=True)
        xy, of = shapely.get_coordinates(rings, return_index=True)
        # A ring of shapely repeats its first point at its end.
        last = np.append(of[1:] != of[:-1], True)[: len(of)]
        xy, of = xy[~last], of[~last]
        own = planes.stack.mesh.vertices
        points = np.concatenate([own, planes.raised(xy, plane[part[of]])])
        vertex = _alike(points, SAME_POINT_OF_ZERO * planes.stack.zero)[len(own) :]
        offsets = np.searchsorted(of, np.arange(len(rings) + 1)).astype(np.intp)
        ring = np.searchsorted(part, np.arange(len(polygons) + 1)).astype(np.intp)
        return cls(planes, points, vertex, offsets, ring, plane, turned)._without_stutter()._without_straight_corners()

    def _without_stutter(self) -> _Outline:
        """The same without corners that follow themselves; rings of fewer than three corners are gone."""
        stays = self.vertex != self.vertex[ragged.following(self.offsets)]
        return self._with_corners(self.vertex[stays], np.add.reduceat(stays, self.offsets[:-1]))

    def _without_straight_corners(self) -> _Outline:
        """The same without corners at which nothing turns; where others need them they come back."""
        before, here, after = (
            self.points[self.vertex[step]]
            for step in (ragged.preceding(self.offsets), slice(None), ragged.following(self.offsets))
        )
        off, chord = cross(here - before, after - before), after - before
        bent = component_sum(off * off) > self.planes.grid**2 * component_sum(chord * chord)
        bent |= component_sum((here - before) * (after - here)) < 0.0
        return self._with_corners(self.vertex[bent], np.add.reduceat(bent, self.offsets[:-1]))

    def _with_corners(self, vertex: Ints, sizes: Ints) -> _Outline:
        """The same rings with other corners, so many each."""
        wide = sizes > 2
        part = ragged.owner(np.diff(self.ring))[wide]
        counts = np.bincount(part, minlength=len(self.plane))
        filled = counts > 0
        offsets = ragged.offsets(sizes[wide])
        kept = vertex[np.repeat(wide, sizes)]
        ring = ragged.offsets(counts[filled])
        return _Outline(self.planes, self.points, kept, offsets, ring, self.plane[filled], self.turned[filled])

    def mesh(self) -> Mesh:
        """The mesh that the polygons make: convex ones whole, others in triangles."""
        outline = self._with_ends_between()
        corners, offsets, _ = outline.faces()
        return Mesh(outline.points, corners, offsets)

    def _with_ends_between(self) -> _Outline:
        """The same with a corner wherever a corner of another ring lies on a side that no other ring has."""
        start, end = self.vertex, self.vertex[ragged.following(self.offsets)]
        turned = np.repeat(self.turned, np.add.reduceat(np.diff(self.offsets), self.ring[:-1]))
        count = len(self.points)
        way = np.where(turned, end * count + start, start * count + end)
        back = np.where(turned, start * count + end, end * count + start)
        alone = np.flatnonzero(~np.isin(way, back) | ~np.isin(back, way))
        if not len(alone):
            return self
        zero = SAME_POINT_OF_ZERO * self.planes.stack.zero
        loose = np.unique(np.concatenate([start[alone], end[alone]]))
        at, a, b = self.points[loose], self.points[start[alone]], self.points[end[alone]]
        low, high = np.minimum(a, b).T - zero, np.maximum(a, b).T + zero
        side, place = overlapping_boxes(low, high, at.T, at.T)
        may_stop()
        way_along = b[side] - a[side]
        arm = at[place] - a[side]
        square = component_sum(way_along * way_along)
        part = component_sum(arm * way_along) / square
        off = arm - part[:, None] * way_along
        inside = (component_sum(off * off) <= zero * zero) & (part > 0.0) & (part < 1.0)
        inside &= (loose[place] != start[alone[side]]) & (loose[place] != end[alone[side]])
        side, place, part = alone[side[inside]], place[inside], part[inside]
        position = np.concatenate([np.arange(len(start)), side])
        along = np.concatenate([np.zeros(len(start)), part])
        order = np.lexsort((along, position))
        vertex = np.concatenate([start, loose[place]])[order]
        ring = ragged.owner(np.diff(self.offsets))
        sizes = np.bincount(ring[position], minlength=len(self.offsets) - 1)
        return self._with_corners(vertex, sizes)._without_stutter()

    def faces(self) -> tuple[Ints, Ints, Ints]:
        """Corners and offsets of faces, and the polygon of each: convex polygons whole, others in triangles."""
        import shapely

        sizes = np.diff(self.offsets)
        plane = np.repeat(self.plane, np.add.reduceat(sizes, self.ring[:-1]))
        flat = np.ascontiguousarray(self.planes.flat(self.points[self.vertex], plane).T)
        closing = np.insert(np.arange(len(self.vertex)), self.offsets[1:], self.offsets[:-1])
        rings = self.offsets + np.arange(len(self.offsets))
        areas = shapely.from_ragged_array(shapely.GeometryType.POLYGON, flat[closing], (rings, self.ring))
        hull = shapely.area(shapely.convex_hull(areas))
        whole = hull - shapely.area(areas) <= self.planes.stack.zero * shapely.length(areas)
        whole &= np.diff(self.ring) == 1
        position, offsets = ragged.take(self.offsets, self.ring[:-1][whole])
        rest = np.flatnonzero(~whole)
        triangles, part = self._triangles(areas[rest], rest, flat)
        corners = np.concatenate([self.vertex[position], self.vertex[triangles].ravel()])
        turned = np.concatenate([self.turned[whole], self.turned[part]])
        offsets = ragged.offsets(np.concatenate([np.diff(offsets), np.full(len(part), 3)]))
        mirrored = (offsets[:-1] + offsets[1:] - 1).repeat(np.diff(offsets)) - np.arange(len(corners))
        which = np.concatenate([np.flatnonzero(whole), part])
        return np.where(turned.repeat(np.diff(offsets)), corners[mirrored], corners), offsets, which

    def _triangles(self, areas: Any, number: Ints, flat: Floats) -> tuple[Ints, Ints]:
        """Triangles (t,3) of places among the corners that some polygons with numbers consist of, and the number of the
        polygon of each."""
        import shapely

        found = in_pieces(shapely.constrained_delaunay_triangles, REGIONS_AT_ONCE, areas)
        triangles, of = shapely.get_parts(found, return_index=True)
        xy = shapely.get_coordinates(shapely.orient_polygons(triangles)).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
        sizes = np.add.reduceat(np.diff(self.offsets), self.ring[:-1])
        owner = ragged.owner(sizes)
        ours = np.column_stack([flat, owner])
        theirs = np.column_stack([xy, np.repeat(number[of], 3)])
        place = _first_equal(np.concatenate([ours, theirs]))[len(ours) :].reshape(-1, 3)
        # A corner that is none of the rings' is one where these cross: what is left there is no body.
        return place[(place < len(ours)).all(axis=1)], number[of][(place < len(ours)).all(axis=1)]


# Bodies that are not convex: by another library.


def _by_manifold(stack: _Stack) -> Mesh:
    """The union of all bodies, where they stand, in triangles."""
    try:
        import manifold3d
    except ImportError:
        raise not_installed("a union of bodies that are not convex", "manifold3d", "union") from None
    mesh, bodies = stack.mesh, len(stack.first_vertex) - 1
    plane, unturned = np.arange(mesh.face_count), np.zeros(mesh.face_count, dtype=np.bool_)
    across = np.where(np.asarray(mesh.area_vectors.any(axis=1))[:, None], mesh.area_vectors, UPWARDS)
    planes = _Planes(stack, axis_frame(across), np.zeros(mesh.face_count), plane, unturned)
    ring = np.arange(mesh.face_count + 1)
    outline = _Outline(planes, mesh.vertices, mesh.corners, mesh.offsets, ring, plane, unturned)
    corners, offsets, face = outline.faces()
    fans, of = ragged.fans(offsets)
    owner = (np.searchsorted(stack.first_face, face, side="right") - 1)[of]
    order = np.argsort(owner, kind="stable")
    triangles, first = corners[fans[order]], ragged.offsets(np.bincount(owner, minlength=bodies))
    solids = []
    for number in in_turn(range(bodies)):
        low, high = stack.first_vertex[number : number + 2]
        some = triangles[first[number] : first[number + 1]] - low
        given = manifold3d.Mesh64(mesh.vertices[low:high], np.ascontiguousarray(some, dtype=np.uint64))
        solids.append(manifold3d.Manifold(given))
        if solids[-1].status() != manifold3d.Error.NoError:
            raise InputError(f"body {number + 1} of {bodies} is not sound: manifold3d does not take it")
    found = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add).to_mesh64()
    points = np.asarray(found.vert_properties, dtype=np.float64)[:, :3] * stack.size + stack.middle
    return Mesh.from_triangles(points, np.asarray(found.tri_verts).astype(np.intp))
