"""Smooth surfaces as fine meshes that know the true normals at their vertices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import triangulate_surface
from vectorplot.features.polygonize import settled_mesh
from vectorplot.features.tessellation import grid_numbers
from vectorplot.geometry.mesh import Floats, Ints, Mesh
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised

FEWEST, MOST = 8, 1024
"""Cells in each direction, at least and at most."""

MOST_CELLS = 1 << 19
"""Cells of a surface at most; beyond it the tolerance is not kept."""

IMPLICIT_CELLS = (32, 160)
"""Cells along the longest side of an implicit surface's box, at least and at most."""


Allowed = Callable[[Floats], Floats]
"""How far (...) triangles may be off a surface at points (..., 3)."""


TURN, JUMP, LOOKS = np.radians(6.0), np.radians(45.0), 64
"""Normals turn by no more than the one from a vertex to its neighbours, or shades would come out jagged; where they
turn by more than the other between two of so many points in each direction, they jump."""


@dataclass(frozen=True, eq=False)
class Facets:
    """A mesh, and the unit normals (v,3) of the true surface at its vertices, NaN where it has none."""

    mesh: Mesh
    normals: Floats


def facets(shape: Surface | ImplicitSurface, allowed: Allowed) -> Facets:
    """Triangles that are no farther from a smooth surface than is allowed, every vertex on it.

    Triangles turn as u to v does; those of an implicit surface are counter-clockwise from where F > 0. Vertices on
    seams and at poles are one. Triangles are small enough for smooth shades, too: normals turn little on them.
    Error: MOST_CELLS and MOST bound the triangles; distances are measured on some of the cells. Details
    smaller than a FEWESTth of the domain, or a cell of an implicit surface, may be missed.
    Errors: InputError for what is no smooth surface.
    Degenerate: triangles with a corner in a hole, and those without area, are left out.
    Source: Glaeser, section 8.4 (polygonised surfaces).
    """
    if is_parametrised(shape):
        return _parametrised(shape, allowed)
    if is_implicit(shape):
        return _implicit(shape, allowed)
    raise InputError(f"a {type(shape).__name__} is no smooth surface")


def _parametrised(surface: Surface, allowed: Allowed) -> Facets:
    columns, rows = _fineness(surface, allowed)
    u, v = np.meshgrid(*surface.domain.grid(columns, rows), indexing="ij")
    points = np.asarray(surface.points(u, v), dtype=np.float64)
    number = grid_numbers(surface, columns, rows).ravel()
    cut, _ = triangulate_surface(points, closed_u=surface.domain.closed_u, closed_v=surface.domain.closed_v)
    triangles, flat = number[cut], points.reshape(-1, 3)
    good = np.isfinite(flat[triangles]).all(axis=(1, 2))
    good &= (triangles != np.roll(triangles, -1, axis=1)).all(axis=1)
    used, corners = np.unique(triangles[good], return_inverse=True)
    normals = unit_normals(surface, u.ravel()[used], v.ravel()[used])
    return Facets(Mesh.from_triangles(flat[used], corners), normals)


def _fineness(surface: Surface, allowed: Allowed) -> tuple[int, int]:
    """Columns and rows of a grid that is close enough: a chord's distance falls like the square of its length.

    The diagonal of a cell bends as much as both its sides together, and more where the cell is twisted.
    """
    columns = rows = FEWEST
    for _ in range(4):
        across, along = _excesses(surface, allowed, columns, rows)
        worst = max(across, along, _twist(surface, allowed, columns, rows))
        if worst <= 1.0:
            break
        across, along = _shared(across, along, worst)
        columns, rows = _more(columns, across), _more(rows, along)
    turning_columns, turning_rows = _turning(surface)
    columns, rows = max(columns, turning_columns), max(rows, turning_rows)
    while columns * rows > MOST_CELLS:
        columns, rows = columns // 2 + 1, rows // 2 + 1
    return columns, rows


def _turning(surface: Surface) -> tuple[int, int]:
    """Columns and rows of a grid from point to point of which normals turn by no more than TURN, or nearly so: along
    rulings they may turn though chords lie on the surface. Normals that jump, as on creases, tell nothing."""
    u, v = np.meshgrid(*surface.domain.grid(LOOKS, LOOKS), indexing="ij")
    normals = unit_normals(surface, u.ravel(), v.ravel()).reshape(*u.shape, 3)
    counts = []
    for grid in (normals, normals.swapaxes(0, 1)):
        with np.errstate(invalid="ignore"):
            turn = np.arccos(np.clip((grid[1:] * grid[:-1]).sum(axis=-1), -1.0, 1.0))
        smooth = turn[np.isfinite(turn) & (turn < JUMP)]
        largest = float(np.quantile(smooth, 0.98)) if len(smooth) else 0.0
        counts.append(min(int(np.ceil(LOOKS * largest / TURN)), MOST))
    return counts[0], counts[1]


def _more(count: int, excess: float) -> int:
    return count if excess <= 1.0 else min(int(np.ceil(count * np.sqrt(1.05 * excess))), MOST)


def _shared(across: float, along: float, worst: float) -> tuple[float, float]:
    """By how much finer, squared, columns and rows must be, so that what remains is within the tolerance together.

    across, along: the excesses of chords; worst: the largest of all, diagonals included.
    """
    sides = across + along
    if worst > sides:
        across, along = across + (worst - sides) / 2.0, along + (worst - sides) / 2.0
    else:
        across, along = across * worst / sides, along * worst / sides
    # With as few cells as possible both have half of the tolerance, unless one needs less than that as it is.
    if min(across, along) <= 0.5:
        return (1.0, along / (1.0 - across)) if across <= along else (across / (1.0 - along), 1.0)
    return 2.0 * across, 2.0 * along


def _twist(surface: Surface, allowed: Allowed, columns: int, rows: int) -> float:
    """By how many times the middles of diagonals are farther off the surface than is allowed; the worst of some
    cells."""
    u, v = surface.domain.grid(2 * columns, 2 * rows)
    at_u, at_v = (1 + 2 * np.arange(0, count, max(1, count // 24)) for count in (columns, rows))
    grids = {
        (i, j): np.asarray(surface.points(*np.meshgrid(u[at_u + i], v[at_v + j], indexing="ij")), dtype=np.float64)
        for i, j in ((0, 0), (-1, -1), (1, 1), (-1, 1), (1, -1))
    }
    middle = grids[0, 0]
    normals = unit_normals(surface, *(some.ravel() for some in np.meshgrid(u[at_u], v[at_v], indexing="ij")))
    worst = 0.0
    for one, other in (((-1, -1), (1, 1)), ((-1, 1), (1, -1))):
        with np.errstate(invalid="ignore"):
            off = middle - 0.5 * (grids[one] + grids[other])
            far = np.abs((off * normals.reshape(off.shape)).sum(axis=-1)) / allowed(middle)
        worst = max(worst, float(np.where(np.isfinite(far), far, 0.0).max(initial=0.0)))
    return worst


def _excesses(surface: Surface, allowed: Allowed, columns: int, rows: int) -> tuple[float, float]:
    """By how many times the middles of chords are farther off the surface than is allowed, along u and along v; the
    worst of some rows and columns."""
    u, v = surface.domain.grid(2 * columns, 2 * rows)
    few_u, few_v = u[:: max(1, columns // 16)], v[:: max(1, rows // 16)]
    across = _excess(surface.points(*np.meshgrid(u, few_v, indexing="ij")), allowed)
    along = _excess(np.swapaxes(surface.points(*np.meshgrid(few_u, v, indexing="ij")), 0, 1), allowed)
    return across, along


def _excess(points: Floats, allowed: Allowed) -> float:
    with np.errstate(invalid="ignore"):
        off = points[1::2] - 0.5 * (points[:-1:2] + points[2::2])
        along = points[2::2] - points[:-1:2]
        length = np.linalg.norm(along, axis=-1, keepdims=True)
        along = np.divide(along, length, out=np.zeros_like(along), where=length > 0.0)
        off = off - (off * along).sum(axis=-1, keepdims=True) * along
        long = np.linalg.norm(off, axis=-1) / allowed(points[1::2])
    return float(np.where(np.isfinite(long), long, 0.0).max(initial=0.0))


def _implicit(surface: ImplicitSurface, allowed: Allowed) -> Facets:
    fewest, most = IMPLICIT_CELLS
    mesh, _ = settled_mesh(surface, fewest)
    excess = _implicit_excess(surface, mesh, allowed)
    if excess > 1.0:
        mesh, _ = settled_mesh(surface, min(int(np.ceil(fewest * np.sqrt(excess))), most))
    return Facets(mesh, _unit_gradients(surface, mesh.vertices))


def _implicit_excess(surface: ImplicitSurface, mesh: Mesh, allowed: Allowed) -> float:
    """By how many times the middles of triangles are farther off the surface than is allowed, to first order."""
    middles = mesh.vertices[_triangles(mesh)].mean(axis=1)
    if not len(middles):
        return 0.0
    with np.errstate(all="ignore"):
        off = np.abs(surface.values(middles)) / np.linalg.norm(surface.gradients(middles), axis=1) / allowed(middles)
    return float(np.quantile(np.where(np.isfinite(off), off, 0.0), 0.99))


def _triangles(mesh: Mesh) -> Ints:
    return np.asarray(mesh.corners.reshape(-1, 3))


def _unit_gradients(surface: ImplicitSurface, points: Floats) -> Floats:
    with np.errstate(all="ignore"):
        slopes = np.asarray(surface.gradients(points), dtype=np.float64)
        return np.asarray(slopes / np.linalg.norm(slopes, axis=1, keepdims=True))
