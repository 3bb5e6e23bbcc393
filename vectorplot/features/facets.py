"""Smooth surfaces as fine meshes that know the true normals at their vertices."""

from __future__ import annotations

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


@dataclass(frozen=True, eq=False)
class Facets:
    """A mesh, and the unit normals (v,3) of the true surface at its vertices, NaN where it has none."""

    mesh: Mesh
    normals: Floats


def facets(shape: Surface | ImplicitSurface, tolerance: float) -> Facets:
    """Triangles whose edges are no farther than the tolerance from a smooth surface, every vertex on it.

    Triangles turn as u to v does; those of an implicit surface are counter-clockwise from where F > 0. Vertices on
    seams and at poles are one.
    Error: MOST_CELLS and MOST bound the triangles, and the middles of triangles may be twice as far away. Details
    smaller than a FEWESTth of the domain, or a cell of an implicit surface, may be missed.
    Errors: InputError for a tolerance that is not positive, and for what is no smooth surface.
    Degenerate: triangles with a corner in a hole, and those without area, are left out.
    Source: Glaeser, section 8.4 (polygonised surfaces).
    """
    if not tolerance > 0.0:
        raise InputError(f"a tolerance of {tolerance:g}: expected a positive length")
    if is_parametrised(shape):
        return _parametrised(shape, tolerance)
    if is_implicit(shape):
        return _implicit(shape, tolerance)
    raise InputError(f"a {type(shape).__name__} is no smooth surface")


def _parametrised(surface: Surface, tolerance: float) -> Facets:
    columns, rows = _fineness(surface, tolerance)
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


def _fineness(surface: Surface, tolerance: float) -> tuple[int, int]:
    """Columns and rows of a grid that is close enough: a chord's distance falls like the square of its length."""
    columns = rows = FEWEST
    for _ in range(3):
        across, along = _sags(surface, columns, rows)
        if max(across, along) <= tolerance:
            break
        columns = _more(columns, across / tolerance)
        rows = _more(rows, along / tolerance)
    while columns * rows > MOST_CELLS:
        columns, rows = columns // 2 + 1, rows // 2 + 1
    return columns, rows


def _more(count: int, excess: float) -> int:
    return count if excess <= 1.0 else min(int(np.ceil(count * np.sqrt(1.05 * excess))), MOST)


def _sags(surface: Surface, columns: int, rows: int) -> tuple[float, float]:
    """How far the middles of chords are off the surface, along u and along v; the worst of some rows and columns."""
    u, v = surface.domain.grid(2 * columns, 2 * rows)
    few_u, few_v = u[:: max(1, columns // 16)], v[:: max(1, rows // 16)]
    across = _sag(surface.points(*np.meshgrid(u, few_v, indexing="ij")))
    along = _sag(np.swapaxes(surface.points(*np.meshgrid(few_u, v, indexing="ij")), 0, 1))
    return across, along


def _sag(points: Floats) -> float:
    with np.errstate(invalid="ignore"):
        off = points[1::2] - 0.5 * (points[:-1:2] + points[2::2])
        along = points[2::2] - points[:-1:2]
        length = np.linalg.norm(along, axis=-1, keepdims=True)
        along = np.divide(along, length, out=np.zeros_like(along), where=length > 0.0)
        off = off - (off * along).sum(axis=-1, keepdims=True) * along
    long = np.linalg.norm(off, axis=-1)
    return float(np.nanmax(np.where(np.isfinite(long), long, 0.0), initial=0.0))


def _implicit(surface: ImplicitSurface, tolerance: float) -> Facets:
    fewest, most = IMPLICIT_CELLS
    mesh, _ = settled_mesh(surface, fewest)
    excess = _implicit_sag(surface, mesh) / tolerance
    if excess > 1.0:
        mesh, _ = settled_mesh(surface, min(int(np.ceil(fewest * np.sqrt(excess))), most))
    return Facets(mesh, _unit_gradients(surface, mesh.vertices))


def _implicit_sag(surface: ImplicitSurface, mesh: Mesh) -> float:
    """The distance of the middles of triangles from the surface, to first order."""
    middles = mesh.vertices[_triangles(mesh)].mean(axis=1)
    if not len(middles):
        return 0.0
    with np.errstate(all="ignore"):
        off = np.abs(surface.values(middles)) / np.linalg.norm(surface.gradients(middles), axis=1)
    return float(np.quantile(np.where(np.isfinite(off), off, 0.0), 0.99))


def _triangles(mesh: Mesh) -> Ints:
    return np.asarray(mesh.corners.reshape(-1, 3))


def _unit_gradients(surface: ImplicitSurface, points: Floats) -> Floats:
    with np.errstate(all="ignore"):
        slopes = np.asarray(surface.gradients(points), dtype=np.float64)
        return np.asarray(slopes / np.linalg.norm(slopes, axis=1, keepdims=True))
