"""Triangles that stand in for a surface while its intersections are looked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import TURN, poles
from vectorplot.features.grid_triangulation import average_normals, cut_cells
from vectorplot.features.holes import wrapped
from vectorplot.geometry.connectivity import edges_of
from vectorplot.surfaces.surface import Domain, Surface

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
