"""Patches: shapes whose intersections are looked for, known by places, tangent planes and a tessellation."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import TURN, extent, poles
from vectorplot.features.grid_triangulation import average_normals, cut_cells
from vectorplot.features.holes import clipped, ways_between, wrapped
from vectorplot.geometry import ragged
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import component_sum, cross, norm
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import StackedSurfaces, unit_normals
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances import LEAST_SINE_SQUARED, ZERO_OF_EXTENT

# Triangles that stand in for a surface while its intersections are looked for.

UNEVEN = 0.17
"""Part of a cell by which grid points are moved at most: symmetric surfaces then meet in no corner, along no edge."""

MOST_CELLS = 1 << 20
"""Cells a tessellation may have."""

FINER = (2, 4)
"""How many times as fine a grid is made when its triangles cannot tell what the surfaces do."""

MOST_FINER = 1 << 17
"""Cells up to which a grid is made finer unasked."""

FREE = -1
"""The constraint of an edge that is no border."""


@dataclass(frozen=True, eq=False)
class Tessellation:
    """Triangles with the places on the true surface that their corners have.

    points: (n, 3) in world coordinates; triangles: (t, 3) of points; places: (t, 3, d) of their corners, such as u and
    v; cells: (t,) the cell a triangle belongs to; edges: (e, 2) of points, the smaller one first; sides: (t, 3) the
    edge from corner k to the next; constraints: (e,) what a point on the edge must stay on, as its sheet numbers such
    lines; border: (e,) edges of one triangle."""

    points: Floats
    triangles: Ints
    places: Floats
    cells: Ints
    edges: Ints
    sides: Ints
    constraints: Ints
    border: Bools

    @cached_property
    def boxes(self) -> tuple[Floats, Floats]:
        """Smallest and largest coordinates (3,t) of the triangles."""
        corners = self.points[self.triangles]
        return corners.min(axis=1).T, corners.max(axis=1).T


def finer_grids(columns: int, rows: int) -> list[tuple[int, int]]:
    """Columns and rows of grids to try one after the other: the one asked for, then finer ones."""
    finer = [(n * columns, n * rows) for n in FINER if n * n * columns * rows <= MOST_FINER]
    return [(columns, rows), *finer]


@dataclass(frozen=True, eq=False)
class GridNodes:
    """The points (n,) of an uneven grid on a surface, or of one grid after the other: places (n,d) and points (n,3);
    numbers (n,): on seams and at poles several are one point; normals (n,3): see `average_normals`; open_ways: the
    axes, 0 for u and 1 for v, in which the domains are not closed."""

    places: Floats
    points: Floats
    numbers: Ints
    normals: Floats
    open_ways: tuple[int, ...]

    def tessellation(self, corners: Ints, cells: Ints, ends: Floats) -> Tessellation:
        """The triangles of cells (k,), by their corners (4,k) among the points; ends (4,k) or (4,1): where u starts and
        ends in their domains, and v."""
        grid_triangles = cut_cells(corners, self.points[corners], self.normals[corners])
        triangles = self.numbers[grid_triangles]
        good = np.isfinite(self.points[grid_triangles]).all(axis=(1, 2))
        good &= (triangles != np.roll(triangles, -1, axis=1)).all(axis=1)
        triangles, grid_triangles = triangles[good], grid_triangles[good]
        edges, sides, uses = edges_of(triangles, len(self.points))
        own = self.places[grid_triangles]
        constraints = np.full(len(edges), FREE)
        ends = np.repeat(np.broadcast_to(ends, (4, len(cells))), 2, axis=1)[:, good, None]
        for axis in self.open_ways:
            for end in ends[2 * axis : 2 * axis + 2]:
                on = (own[..., axis] == end) & (np.roll(own[..., axis], -1, axis=1) == end)
                constraints[sides[on]] = axis
        border = np.asarray(uses == 1, dtype=np.bool_)
        constraints[~border] = FREE
        return Tessellation(self.points, triangles, own, np.repeat(cells, 2)[good], edges, sides, constraints, border)


def grid_nodes(surface: Surface, columns: int, rows: int) -> GridNodes:
    """The points of a grid of columns times rows cells.

    Errors: see `surface_tessellation`.
    """
    _check(columns, rows)
    domain = surface.domain
    places = _uneven_grid(domain, columns, rows)
    with np.errstate(all="ignore"):
        points = surface.points(*wrapped(domain, places[..., 0], places[..., 1]))
        normals = average_normals(points, closed_u=domain.closed_u, closed_v=domain.closed_v)
    numbers = grid_numbers(surface, columns, rows)
    open_ways = tuple(axis for axis, closed in enumerate((domain.closed_u, domain.closed_v)) if not closed)
    return GridNodes(places.reshape(-1, 2), points.reshape(-1, 3), numbers.ravel(), normals.reshape(-1, 3), open_ways)


def cell_corners(columns: int, rows: int) -> Ints:
    """(4,c) the corners of the cells of a grid among its points, in cyclic order."""
    at = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    return np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]]).reshape(4, -1)


def _check(columns: int, rows: int) -> None:
    if min(columns, rows) < 3 or columns * rows > MOST_CELLS:
        raise InputError(
            f"a tessellation of {columns} columns and {rows} rows: expected 3 or more, at most {MOST_CELLS} cells"
        )


def _uneven_grid(domain: Domain, columns: int, rows: int) -> Floats:
    """(columns+1, rows+1, 2) parameters; the borders stay where they are, seams meet."""
    shape = (columns + 1, rows + 1)
    # The same numbers every time: a drawing made twice is the same.
    moves = np.random.default_rng(8).uniform(-UNEVEN, UNEVEN, (*shape, 2))
    result = np.zeros((*shape, 2))
    starts = (domain.u_start, domain.v_start)
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        count, start, size = shape[axis] - 1, starts[axis], domain.size[axis]
        step = np.moveaxis(moves[..., axis], axis, 0)
        other_closed = (domain.closed_v, domain.closed_u)[axis]
        if other_closed:
            step[:, -1] = step[:, 0]
        if closed:
            step[-1] = step[0]
            line = start + (np.arange(count + 1) / count + TURN) * size
        else:
            step[[0, -1]] = 0.0
            line = np.linspace(start, start + size, count + 1)
            line[-1] = (domain.u_end, domain.v_end)[axis]
        moved = line[:, None] + step * (size / count)
        if closed:
            moved[-1] = moved[0] + size
        result[..., axis] = np.moveaxis(moved, 0, axis)
    return result


def seam_numbers(domain: Domain, columns: int, rows: int) -> Ints:
    """(columns+1, rows+1) numbers of grid points; on seams two are one point."""
    number = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    if domain.closed_u:
        number[-1] = number[0]
    if domain.closed_v:
        number[:, -1] = number[:, 0]
    return number


def grid_numbers(surface: Surface, columns: int, rows: int) -> Ints:
    """(columns+1, rows+1) numbers of grid points; on seams and at poles several are one point."""
    number = seam_numbers(surface.domain, columns, rows)
    for pole in poles(surface):
        border = np.moveaxis(number, pole.axis, 0)[0 if pole.inwards > 0.0 else -1]
        border[:] = border[0]
    return number


class Patch(Protocol):
    """A shape on which places (k,d) are points, or several that are asked as one. All functions take many places at
    once."""

    @property
    def tessellation(self) -> Tessellation:
        """Triangles near the shapes, with the places of their corners."""
        ...

    @property
    def sizes(self) -> Floats:
        """(2,p) of each of the shapes the diagonal of the box around it, and its largest coordinate."""
        ...

    def numbers(self, places: Floats) -> Ints:
        """(k,) on which of the shapes places are."""
        ...

    def points(self, places: Floats) -> Floats:
        """(k,3) points; NaN in holes."""
        ...

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals; NaN where there is none."""
        ...

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,d) places moved by steps (k,3) in their tangent planes, to first order; never over a border."""
        ...

    def along_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) directions of the lines that constraints (k,) name, at places on them."""
        ...

    def on_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,d) places put on their constraints, FREE ones left alone, where rounding took them off."""
        ...

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) second derivatives of the height above the first two axes of frames (k,3,3), along the third."""
        ...

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """(k,d) the same places, as many whole periods on as brings them nearest to other places (k,d)."""
        ...

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) how many cells lie between places and others, the short way round; infinite from shape to shape."""
        ...


class SingleShape(ABC):
    """What patches of one shape answer alike."""

    @property
    @abstractmethod
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around it, and its largest coordinate."""

    @property
    def sizes(self) -> Floats:
        """(2,1) the same."""
        return np.array(self.size)[:, None]

    def numbers(self, places: Floats) -> Ints:
        """(k,) zeros: there is but one."""
        return np.zeros(len(places), dtype=np.intp)


@dataclass(frozen=True, eq=False)
class MeshPatch(SingleShape):
    """The faces of a mesh; places are x, y, z and the number of a triangle. Faces that are not planar and convex are
    cut into triangles; a planar face has one plane."""

    mesh: Mesh

    @cached_property
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around it, and its largest coordinate."""
        vertices = self.mesh.vertices
        if not len(vertices):
            return 0.0, 0.0
        return float(norm(np.ptp(vertices, axis=0))), float(np.abs(vertices).max())

    @cached_property
    def faces(self) -> Ints:
        """(t,) the face of the mesh that every triangle belongs to."""
        return self._cut[1]

    @cached_property
    def tessellation(self) -> Tessellation:
        """The triangles. Rails are the numbers of edges, of those between faces; diagonals are free."""
        triangles, faces = self._cut
        points = self.mesh.vertices
        edges, sides, uses = edges_of(triangles, len(points))
        low, high = np.full(len(edges), len(faces)), np.full(len(edges), -1)
        np.minimum.at(low, sides.ravel(), np.repeat(faces, 3))
        np.maximum.at(high, sides.ravel(), np.repeat(faces, 3))
        bent = np.zeros(len(edges), dtype=np.bool_)
        bent[sides.ravel()] = np.repeat(self._is_bent, 3)
        inner = (low == high) & (uses == 2) & ~bent
        places = np.concatenate(
            [points[triangles], np.broadcast_to(np.arange(len(faces))[:, None, None], (len(faces), 3, 1))], axis=2
        )
        constraints = np.where(inner, FREE, np.arange(len(edges)))
        return Tessellation(points, triangles, places, np.arange(len(faces)), edges, sides, constraints, uses == 1)

    @cached_property
    def edge_uses(self) -> Ints:
        """(e,) how many triangles every edge of the tessellation has."""
        return edges_of(self._cut[0], len(self.mesh.vertices))[2]

    def points(self, places: Floats) -> Floats:
        """(k,3) points."""
        return places[..., :3]

    def normals(self, places: Floats) -> Floats:
        """(k,3) normals of the planes of the triangles."""
        return np.asarray(self._planes[0][_triangle(places)])

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,4) places moved, and put into the plane of their triangle."""
        triangle = _triangle(places)
        normal, origin = (x[triangle] for x in self._planes)
        points = places[:, :3] + steps
        points = points - ((points - origin) * normal).sum(axis=1, keepdims=True) * normal
        return np.concatenate([points, places[:, 3:]], axis=1)

    def along_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) directions of edges."""
        ends = self.mesh.vertices[self.tessellation.edges[constraints]]
        return np.asarray(ends[:, 1] - ends[:, 0])

    def on_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """The places: edges are met to rounding."""
        return places

    def holds(self, places: Floats) -> Bools:
        """(k,) places within their face, its border included, not beside it in its plane."""
        triangle, own = _triangle(places), self.tessellation
        normal = self._planes[0][triangle]
        by_face = np.argsort(self.faces, kind="stable")
        first = np.searchsorted(self.faces[by_face], self.faces[triangle])
        count = np.searchsorted(self.faces[by_face], self.faces[triangle], side="right") - first
        inside = np.zeros(len(places), dtype=np.bool_)
        # A face has few triangles: each pass looks at one more of every face.
        for step in range(int(count.max(initial=0))):
            corners = own.points[own.triangles[by_face[first + np.minimum(step, count - 1)]]]
            sides = np.roll(corners, -1, axis=1) - corners
            heights = component_sum(cross(sides, places[:, None, :3] - corners) * normal[:, None])
            zero = ZERO_OF_EXTENT * self.size[0] * np.linalg.norm(sides, axis=2)
            inside |= (heights >= -zero).all(axis=1) | (heights <= zero).all(axis=1)
        return inside

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) zeros: faces are flat."""
        return np.zeros((len(places), 2, 2))

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """The places."""
        return places

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) distances, measured by the boxes of the triangles the others lie on."""
        low, high = self.tessellation.boxes
        size = np.linalg.norm(high - low, axis=0)[_triangle(others)]
        return np.asarray(np.linalg.norm(places[..., :3] - others[..., :3], axis=-1) / size)

    @cached_property
    def _cut(self) -> tuple[Ints, Ints]:
        """Triangles (t,3) with an area, and the faces (t,) they come from."""
        mesh = self.mesh
        parts = convex_faces(mesh.vertices.T, mesh.corners, mesh.offsets, ZERO_OF_EXTENT * self.size[0])
        sizes = np.diff(parts.offsets) - 2
        part = ragged.owner(sizes)
        step = ragged.place(sizes)
        first = parts.offsets[part]
        triangles = parts.corners[np.stack([first, first + step + 1, first + step + 2], axis=1)]
        face = parts.source[part]
        a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
        good = (cross(b - a, c - a) != 0.0).any(axis=1)
        if mesh.present is not None:
            good &= mesh.present[face]
        return triangles[good], face[good]

    @cached_property
    def _is_bent(self) -> Bools:
        """(t,) triangles of faces that are not planar."""
        triangles, faces = self._cut
        origin = self.mesh.vertices[self.mesh.corners[self.mesh.offsets[faces]]]
        arms = self.mesh.vertices[triangles] - origin[:, None]
        off = np.abs((arms * self.mesh.face_normals[faces][:, None]).sum(axis=2)).max(axis=1, initial=0.0)
        bent = np.zeros(self.mesh.face_count, dtype=np.bool_)
        bent[faces[off > ZERO_OF_EXTENT * self.size[0]]] = True
        return np.asarray(bent[faces])

    @cached_property
    def _planes(self) -> tuple[Floats, Floats]:
        """Unit normals and points (t,3) of the planes: of the face where it is planar, else of the triangle."""
        triangles, faces = self._cut
        a, b, c = (self.mesh.vertices[triangles[:, k]] for k in range(3))
        own = cross(b - a, c - a)
        own /= np.linalg.norm(own, axis=1, keepdims=True)
        origin = self.mesh.vertices[self.mesh.corners[self.mesh.offsets[faces]]]
        bent = self._is_bent[:, None]
        return np.where(bent, own, self.mesh.face_normals[faces]), np.where(bent, a, origin)


def _triangle(places: Floats) -> Ints:
    """The triangle that a place on a mesh names; weighted means of one number are that number but for rounding."""
    return np.asarray(np.rint(places[..., 3]), dtype=np.intp)


# Patches of parametrised surfaces: one of them, or many that are asked as one.

LONGEST_STEP = 2.0
"""Cells that a parameter is moved by at most in one step."""

LONGEST_PART = 0.125
"""Part of the domain that a parameter may be moved by all the same: near a pole that is not far."""


OFF_CELL = 0.5
"""Part of its size that a surface may be off the corners of a cell; a torus of the usual grid is a hundredth off."""


class OnSurfaces(ABC):
    """What patches of parametrised surfaces know at places, which are (u, v), beyond seams too, and where there are
    several the number of the one."""

    columns: int
    rows: int

    @abstractmethod
    def surface_at(self, places: Floats) -> Surface:
        """The surface to be asked for parameters at these places (k,d)."""

    def points(self, places: Floats) -> Floats:
        """(k,3) points; NaN in holes."""
        surface = self.surface_at(places)
        return surface.points(*_home(surface, places))

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals."""
        surface = self.surface_at(places)
        return unit_normals(surface, *_home(surface, places))

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,d) places moved; a direction in which the surface stands still is not moved in."""
        surface = self.surface_at(places)
        along_u, along_v = surface.partials(*_home(surface, places))
        long_u, long_v = (np.sqrt(component_sum(a * a)) for a in (along_u, along_v))
        with np.errstate(all="ignore"):
            a, b = along_u / long_u[:, None], along_v / long_v[:, None]
            a, b = (np.where(np.isfinite(x), x, 0.0) for x in (a, b))
            cosine, by_a, by_b = component_sum(a * b), component_sum(a * steps), component_sum(b * steps)
            sine = np.maximum(1.0 - cosine * cosine, LEAST_SINE_SQUARED)
            change = np.stack([(by_a - cosine * by_b) / sine / long_u, (by_b - cosine * by_a) / sine / long_v], axis=1)
        change = np.where(np.isfinite(change), change, 0.0)
        # Each parameter by itself: near a pole one of them runs far while the other hardly moves.
        size = _size(surface)
        longest = np.maximum(LONGEST_STEP * size / self.grid, LONGEST_PART * size)
        return _with_numbers(clipped(surface.domain, places[:, :2] + np.clip(change, -longest, longest)), places)

    def along_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) derivatives by the other parameter than the one that constraints (k,), 0 or 1, keep."""
        surface = self.surface_at(places)
        along_u, along_v = surface.partials(*_home(surface, places))
        return np.where((constraints == 0)[:, None], along_v, along_u)

    def on_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,d) places whose parameter that does not change on its constraint is an end of the domain exactly."""
        domain, result = self.surface_at(places).domain, places.copy()
        ends = ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))
        for axis in (0, 1):
            x, (low, high) = places[:, axis], ends[axis]
            result[:, axis] = np.where(constraints == axis, np.where(x - low < high - x, low, high), x)
        return result

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) second derivatives of the height above the first two axes of frames (k,3,3), along the third."""
        surface = self.surface_at(places)
        at = _home(surface, places)
        along_u, along_v = surface.partials(*at)
        uu, uv, vv = surface.second_partials(*at)
        with np.errstate(all="ignore"):
            product = cross(along_u, along_v)
            height = product / component_sum(product * frames[:, 2])[..., None]
            bend = np.stack([component_sum(d * height) for d in (uu, uv, uv, vv)], axis=1).reshape(-1, 2, 2)
            flat = np.stack([np.einsum("kij,kj->ki", frames[:, :2], d) for d in (along_u, along_v)], axis=2)
            inverse = _inverse(flat)
            return np.asarray(np.einsum("kji,kjl,klm->kim", inverse, bend, inverse))

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """(k,d) the same places, as many whole periods on as brings them nearest to other places."""
        return _with_numbers(others[..., :2] + self._between(places, others), places)

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) the larger number of cells in u and in v, the short way round."""
        cell = _size(self.surface_at(places)) / self.grid
        return np.asarray(np.abs(self._between(places, others) / cell).max(axis=-1, initial=0.0))

    @property
    def grid(self) -> Ints:
        """(2,) the numbers of columns and rows."""
        return np.array([self.columns, self.rows])

    def _between(self, places: Floats, others: Floats) -> Floats:
        return ways_between(self.surface_at(places).domain, others[..., :2], places[..., :2])


@dataclass(frozen=True, eq=False)
class SurfacePatch(OnSurfaces, SingleShape):
    """A parametrised surface, tessellated by columns times rows cells; places are (u, v)."""

    surface: Surface
    columns: int
    rows: int

    @cached_property
    def nodes(self) -> GridNodes:
        """The points of its grid."""
        return grid_nodes(self.surface, self.columns, self.rows)

    @cached_property
    def ends(self) -> Floats:
        """(4,1) where u starts and ends, and v."""
        domain = self.surface.domain
        return np.array([domain.u_start, domain.u_end, domain.v_start, domain.v_end])[:, None]

    @cached_property
    def tessellation(self) -> Tessellation:
        """All triangles, as `surface_tessellation` makes them."""
        # The points first: they refuse a grid of too many cells before anything is made for each of them.
        nodes, corners = self.nodes, cell_corners(self.columns, self.rows)
        return nodes.tessellation(corners, np.arange(corners.shape[1]), self.ends)

    @cached_property
    def cell_boxes(self) -> tuple[Floats, Floats]:
        """(3,c) and (3,c) smallest and largest coordinates of the surface in every cell, about; those of a cell in a
        hole are infinite, the smallest the larger ones."""
        corners = self.nodes.points[cell_corners(self.columns, self.rows)]
        corners = np.where(np.isfinite(corners).all(axis=2, keepdims=True), corners, np.nan)
        low, high = np.fmin.reduce(corners).T, np.fmax.reduce(corners).T
        known = np.isfinite(low).all(axis=0)
        slack = OFF_CELL * np.linalg.norm(np.where(known, high - low, 0.0), axis=0)
        return np.where(known, low - slack, np.inf), np.where(known, high + slack, -np.inf)

    @cached_property
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around it, and its largest coordinate."""
        return extent(self.surface)

    @cached_property
    def cell(self) -> Floats:
        """(2,) the size of a cell in u and v."""
        return np.asarray(self.surface.domain.size, dtype=np.float64) / (self.columns, self.rows)

    def surface_at(self, places: Floats) -> Surface:
        """The surface."""
        return self.surface

    def home(self, places: Floats) -> tuple[Floats, Floats]:
        """u and v (k,) within the domain."""
        return _home(self.surface, places)


@dataclass(frozen=True, eq=False)
class SurfaceGrids:
    """A surface that is polygonised once by each grid, however many others it may meet."""

    surface: Surface
    made: dict[tuple[int, int], SurfacePatch] = field(default_factory=dict)

    def patch(self, columns: int, rows: int) -> SurfacePatch:
        """Its patch of so many columns times rows cells."""
        if (columns, rows) not in self.made:
            self.made[columns, rows] = SurfacePatch(self.surface, columns, rows)
        return self.made[columns, rows]


@dataclass(frozen=True, eq=False)
class StackedPatches(OnSurfaces):
    """Patches (p,), at least one, of placed surfaces that are closed in the same directions, as one; the third number
    of a place says on which of them it is. cells: those of each (c,) that count."""

    patches: tuple[SurfacePatch, ...]
    cells: tuple[Ints, ...]

    @property
    def columns(self) -> int:  # type: ignore[override]
        """Cells along u of each."""
        return self.patches[0].columns

    @property
    def rows(self) -> int:  # type: ignore[override]
        """Cells along v of each."""
        return self.patches[0].rows

    @cached_property
    def surfaces(self) -> StackedSurfaces:
        """The surfaces."""
        return StackedSurfaces(tuple(p.surface for p in self.patches if isinstance(p.surface, PlacedSurface)))

    @cached_property
    def sizes(self) -> Floats:
        """(2,p) of each surface the diagonal of the box around it, and its largest coordinate."""
        return np.array([patch.size for patch in self.patches]).T

    @cached_property
    def tessellation(self) -> Tessellation:
        """The triangles of the cells that count, surface after surface; at those that do not there is a border too."""
        own, count = [patch.nodes for patch in self.patches], (self.columns + 1) * (self.rows + 1)
        number = np.repeat(np.arange(len(own)), count)
        nodes = GridNodes(
            np.column_stack([np.concatenate([nodes.places for nodes in own]), number]),
            np.concatenate([nodes.points for nodes in own]),
            np.concatenate([nodes.numbers for nodes in own]) + number * count,
            np.concatenate([nodes.normals for nodes in own]),
            own[0].open_ways,
        )
        cells, of = np.concatenate(self.cells), ragged.owner([len(cells) for cells in self.cells])
        corners = cell_corners(self.columns, self.rows)[:, cells] + of * count
        ends = np.concatenate([patch.ends for patch in self.patches], axis=1)[:, of]
        return nodes.tessellation(corners, cells + of * (self.columns * self.rows), ends)

    def surface_at(self, places: Floats) -> Surface:
        """That of the patch of each place."""
        return self.surfaces.at(self.numbers(places))

    def numbers(self, places: Floats) -> Ints:
        """(k,) the patches of places; weighted means of one number are that number but for rounding."""
        return np.asarray(np.rint(places[..., 2]), dtype=np.intp)

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) the larger number of cells in u and in v, the short way round; infinite between two patches."""
        return np.where(self.numbers(places) == self.numbers(others), super().cells_apart(places, others), np.inf)


def _home(surface: Surface, places: Floats) -> tuple[Floats, Floats]:
    """u and v (k,) within the domain."""
    return wrapped(surface.domain, places[..., 0], places[..., 1])


def _size(surface: Surface) -> Floats:
    """(2,) or (k,2) the lengths of the domain."""
    return np.stack(np.broadcast_arrays(*surface.domain.size), axis=-1).astype(np.float64)


def _with_numbers(parameters: Floats, places: Floats) -> Floats:
    """(k,d) places of these parameters (k,2) on the patches of other places."""
    return np.concatenate([parameters, places[..., 2:]], axis=-1) if places.shape[-1] > 2 else parameters


def _inverse(matrices: Floats) -> Floats:
    """(k,2,2) inverses; not finite where there is none."""
    (a, b), (c, d) = matrices[:, 0].T, matrices[:, 1].T
    return np.asarray(np.stack([d, -b, -c, a], axis=1).reshape(-1, 2, 2) / (a * d - b * c)[:, None, None])
