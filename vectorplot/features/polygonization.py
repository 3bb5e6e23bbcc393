"""Implicit surfaces polygonised: their meshes, and the planes where they end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.scalar_fields import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import divided_mesh, nothing_beside
from vectorplot.geometry.vectors import all_components, from_components, greatest_component
from vectorplot.geometry.weld import close_points
from vectorplot.geometry.winding import components, edge_uses
from vectorplot.surfaces.implicit import CutImplicit
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances import (
    ABOVE_WHOLE,
    FALLS_BESIDE,
    LARGEST_OF_SINGLES,
    MERGED_OF_CELL,
    RESIDUAL_OF_EXTENT,
    ROUNDING,
    SAME_DIRECTION_SINE,
    SMALLEST_OF_SINGLES,
)

# Where implicit surfaces may end: the sides of their boxes, and the planes that cut them.

BOXED = 3
"""Sides of the box: across x, y and z."""


@dataclass(frozen=True, eq=False)
class Plane:
    """The plane of a side, normal . p = offset; normal (3,)."""

    side: int
    normal: Floats
    offset: float

    def holds(self, points: Floats, nothing: float) -> Bools:
        """(n,) which points (n,3) lie in it: in sides of the box to the last bit, else within a distance."""
        if self.side < BOXED:
            return np.asarray(points[:, self.side] == self.offset, dtype=np.bool_)
        return np.asarray(np.abs(self._heights(points)) <= nothing, dtype=np.bool_)

    def put(self, points: Floats) -> Floats:
        """(n,3) points next to it, in it."""
        if self.side < BOXED:
            return np.where(np.arange(BOXED) == self.side, self.offset, points)
        return np.asarray(points - self._heights(points)[:, None] * self.normal)

    def _heights(self, points: Floats) -> Floats:
        return np.asarray(matmul(points - self.offset * self.normal, self.normal))


@dataclass(frozen=True, eq=False)
class Sides:
    """The sides of what is looked at of an implicit surface: 0, 1, 2 those of its box across x, y and z, then the
    planes that cut it. box (2,3); cuts: None where it is not cut; nothing: a distance that counts as none."""

    box: Floats
    cuts: CutImplicit | None
    nothing: float

    @property
    def normals(self) -> Floats:
        """(3+k,3) unit normals; of planes that cut, into what is left."""
        return np.eye(BOXED) if self.cuts is None else np.concatenate([np.eye(BOXED), self.cuts.inward])

    def on(self, points: Floats) -> Bools:
        """(n,3+k) on which sides points (n,3) lie; on those of the box to the last bit."""
        own = np.asarray((points == self.box[0]) | (points == self.box[1]), dtype=np.bool_)
        return own if self.cuts is None else np.concatenate([own, self.cuts.on_borders(points, self.nothing)], axis=1)

    def along(self, vectors: Floats, held: Bools) -> Floats:
        """(n,3) the parts of vectors along the sides that are held, (n,3) those of the box or (n,3+k) all."""
        free = np.where(held[:, :BOXED], 0.0, vectors)
        if not held[:, BOXED:].any():
            return free
        patterns, which = np.unique(held, axis=0, return_inverse=True)
        for pattern in np.flatnonzero(patterns[:, BOXED:].any(axis=1)).tolist():
            normals = self.normals[patterns[pattern]]
            rows = which.reshape(-1) == pattern
            free[rows] = matmul(
                vectors[rows], np.eye(3) - matmul(pseudo_inverse(normals, rcond=SAME_DIRECTION_SINE), normals)
            )
        return free

    def has(self, points: Floats) -> Bools:
        """(n,) which points are in the box and not cut away; those on sides are."""
        inside = np.asarray(((points >= self.box[0]) & (points <= self.box[1])).all(axis=1), dtype=np.bool_)
        return inside if self.cuts is None else inside & (self.cuts.beyond(points) <= self.nothing)

    def planes(self, side: int) -> list[Plane]:
        """The planes of a side: two across an axis, or the one that cuts."""
        if side < BOXED:
            return [Plane(side, np.eye(BOXED)[side], float(row[side])) for row in self.box]
        assert self.cuts is not None
        return [Plane(side, self.normals[side], float(self.cuts.offsets[side - BOXED]))]

    def clipped(self, points: Floats) -> Floats:
        """(n,3) points of the box, those that are cut away put into the nearest plane."""
        x = np.clip(points, *self.box)
        if self.cuts is None:
            return x
        first = BOXED
        for region in self.cuts.regions:
            heights = region.heights(x)
            nearest = np.argmin(heights, axis=0)
            gone = np.flatnonzero((heights > 0.0).all(axis=0))
            x[gone] -= heights[nearest[gone], gone, None] * np.array(region.normals)[nearest[gone]]
            first += len(region.normals)
        for normal, side in zip(self.normals[first:], range(first - BOXED, len(self.normals) - BOXED), strict=True):
            x -= np.minimum(self.cuts.heights(x)[side], 0.0)[:, None] * normal
        return x


def sides_of(surface: ImplicitSurface) -> Sides:
    """The sides of a surface."""
    box = np.asarray(surface.box, dtype=np.float64)
    return Sides(box, surface if isinstance(surface, CutImplicit) else None, nothing_beside(box))


# Implicit surfaces as meshes, every vertex on the true surface.

MOST_CELLS = 1 << 24
"""Cells of the lattice at most: their values take 200 MB."""

SLAB = 1 << 18
"""Points at which F is evaluated at once."""

SIDE_ULPS = 8.0
"""Rounding steps of the largest coordinate that a vertex on a side of the box may be off it."""

ROUNDS = 12
"""Steps of Newton's method for the vertices inside cells."""

FINEST = 192
"""Cells along the longest side to which a lattice is refined to settle how a surface is connected."""


@dataclass(frozen=True, eq=False)
class _Lattice:
    """Points evenly spread over a box: low, high (3,) its corners; counts (3,) cells along each side."""

    low: Floats
    high: Floats
    counts: Ints

    @property
    def cell(self) -> Floats:
        """(3,) sides of a cell."""
        return np.asarray((self.high - self.low) / self.counts)

    def points(self, places: Floats | Ints) -> Floats:
        """(..., 3) points at places counted in cells; those on the sides of the box lie there to the last bit."""
        t = places / self.counts
        return np.asarray(
            np.where(t < 0.5, self.low + t * (self.high - self.low), self.high - (1 - t) * (self.high - self.low))
        )

    def values(self, surface: ImplicitSurface) -> Floats:
        """F (cx+1, cy+1, cz+1) at all points; NaN where it is not finite."""
        sides = [np.arange(count + 1, dtype=np.float64)[:, None] for count in self.counts]
        x, y, z = (self.points(side)[:, axis] for axis, side in enumerate(sides))
        result = np.empty((len(x), len(y), len(z)))
        step = max(1, SLAB // (len(y) * len(z)))
        for first in in_turn(range(0, len(x), step)):
            points = from_components(x[first : first + step, None, None], y[:, None], z)
            result[first : first + step] = checked_values(surface, points)
        result[~np.isfinite(result)] = np.nan
        return result


def polygonized(surface: ImplicitSurface, cells: int = 64) -> Mesh:
    """An implicit surface within its box as triangles, counter-clockwise seen from where F > 0.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    cells : int
        Of the cubic lattice along the longest side of the box.

    Returns
    -------
    Mesh
        Vertices lie on the edges of the lattice's cells, on the surface to 1e-13 of the extent or what rounding leaves;
        where it leaves the box, on the sides of the box exactly; where it is cut, on the planes.

    Raises
    ------
    InputError
        For fewer than two cells, more than MOST_CELLS (2^24) in all, values of the wrong shape.

    Notes
    -----
    Parts of the surface smaller than a cell, and sheets closer than that, may be missed or joined. Edge cases: F of one
    sign gives a mesh without faces. Cells at a corner of which F is not finite are holes. A change of sign at a pole or
    a jump of F is no surface. Triangles may be very thin.

    Source: Lorensen and Cline (1987); Lewiner and others (2003) for the cells that could be joined in two ways.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> mesh = features.polygonized(surfaces.implicit_sphere(1.0), cells=8)
    >>> mesh.is_triangular, bool(np.allclose(np.linalg.norm(mesh.vertices, axis=1), 1.0))
    (True, True)
    """
    if isinstance(surface, CutImplicit):
        return _cut(surface, polygonized(surface.surface, cells), float(_lattice(surface, cells).cell.min()))
    lattice = _lattice(surface, cells)
    w = lattice.values(surface)
    if not ((w > 0.0).any() and (w <= 0.0).any()):
        return _empty()
    places, triangles = _marched(w)
    triangles = triangles[_in_whole_cells(w, places, triangles)]
    vertices, on = _on_surface(surface, lattice, w, places)
    triangles = triangles[all_components(on[triangles])]
    return _compact(lattice, vertices, triangles)


def settled_mesh(surface: ImplicitSurface, cells: int = 64) -> tuple[Mesh, tuple[str, ...]]:
    """The surface polygonised so finely that halving the cells last did not change how it is connected: the number
    of its parts and their holes; and a sentence where that could not be reached.

    Errors: as for `polygonized`.
    """
    return settled_from(surface, polygonized(surface, cells), cells)


def settled_from(surface: ImplicitSurface, fine: Mesh, cells: int) -> tuple[Mesh, tuple[str, ...]]:
    """As `settled_mesh`, of a surface that is polygonised with so many cells already, as a mesh."""
    coarse = polygonized(surface, max(2, cells // 2))
    while _connection(coarse) != _connection(fine):
        cells *= 2
        if cells > FINEST:
            return fine, ("implicit surface: finer cells still change how it is connected (a singular point?)",)
        coarse, fine = fine, polygonized(surface, cells)
    return fine, ()


def checked_values(surface: ImplicitSurface, points: Floats) -> Floats:
    """F (...) at points (...,3). Errors: InputError for values of another shape."""
    with np.errstate(all="ignore"):
        w = np.asarray(surface.values(points), dtype=np.float64)
    if w.shape != points.shape[:-1]:
        raise InputError(f"F of {points[..., 0].size} points has the shape {w.shape}: expected one value for each")
    return w


def _lattice(surface: ImplicitSurface, cells: int) -> _Lattice:
    if cells < 2:
        raise InputError(f"polygonize: {cells} cells: at least 2")
    low, high = np.asarray(surface.box, dtype=np.float64)
    size = high - low
    counts = np.maximum(2.0, np.ceil(min(cells, MOST_CELLS) * size / size.max() - ABOVE_WHOLE))
    if cells > MOST_CELLS or counts.prod() > MOST_CELLS:
        raise InputError(f"polygonize: {cells} cells along the longest side: more than {MOST_CELLS} in all")
    return _Lattice(low, high, counts.astype(np.intp))


def _marched(w: Floats) -> tuple[Floats, Ints]:
    """Vertices (n,3) counted in cells and triangles (t,3) of the surface where the values w change their sign."""
    from skimage import measure

    size = np.abs(w)
    # Single precision must keep every sign.
    scale = float(np.nanmedian(size[size > 0.0])) if (size > 0.0).any() else 1.0
    volume = np.sign(w) * np.where(size > 0.0, np.clip(size / scale, SMALLEST_OF_SINGLES, LARGEST_OF_SINGLES), 0.0)
    march: Any = measure.marching_cubes
    single = np.nan_to_num(volume, nan=1.0).astype(np.float32)
    places, triangles, _, _ = march(single, 0.0, gradient_direction="descent")
    return places.astype(np.float64), triangles.astype(np.intp)


def _in_whole_cells(w: Floats, places: Floats, triangles: Ints) -> Bools:
    """(t,) triangles in cells at all corners of which F is finite."""
    hole = np.isnan(w)
    if not hole.any():
        return np.ones(len(triangles), dtype=np.bool_)
    for axis in range(3):
        pair = np.moveaxis(hole, axis, 0)
        hole = np.moveaxis(pair[1:] | pair[:-1], 0, axis)
    cell = np.floor(places[triangles].mean(axis=1)).astype(np.intp)
    i, j, k = np.minimum(cell, np.array(hole.shape) - 1).T
    return np.asarray(~hole[i, j, k], dtype=np.bool_)


def _on_surface(surface: ImplicitSurface, lattice: _Lattice, w: Floats, places: Floats) -> tuple[Floats, Bools]:
    """(n,3) the vertices moved onto F = 0, and (n,) which of them are zeros of F indeed."""
    low, high = np.floor(places).astype(np.intp), np.ceil(places).astype(np.intp)
    w0, w1 = w[tuple(low.T)], w[tuple(high.T)]
    along = ((low != high).sum(axis=1) == 1) & ((w0 < 0.0) != (w1 < 0.0))
    points, on = lattice.points(places), np.zeros(len(places), dtype=np.bool_)
    edge = np.flatnonzero(along)
    points[edge], on[edge] = _on_edges(surface, lattice, low[edge], high[edge], w0[edge], w1[edge])
    rest = np.flatnonzero(~along)
    fixed = (places[rest] == 0.0) | (places[rest] == lattice.counts)
    reach = float(lattice.cell.max())
    moved, arrived = onto_surface(surface, points[rest], fixed=fixed, reach=reach)
    # Where F ends its gradient may be infinite: points of the lattice that are zeros but for rounding are zeros.
    arrived |= _are_zeros(w, low[rest], high[rest])
    points[rest], on[rest] = np.clip(moved, lattice.low, lattice.high), arrived
    return points, on


def _are_zeros(w: Floats, low: Ints, high: Ints) -> Bools:
    """(k,) which points of the lattice, low and high the same, have values no larger than rounding makes beside those
    of their neighbours."""
    found = (low == high).all(axis=1)
    around = np.zeros(len(low))
    for step in np.concatenate([np.eye(3, dtype=np.intp), -np.eye(3, dtype=np.intp)]):
        beside = np.clip(low + step, 0, np.array(w.shape) - 1)
        around = np.fmax(around, np.abs(w[tuple(beside.T)]))
    return np.asarray(found & (np.abs(w[tuple(low.T)]) <= ROUNDING * around), dtype=np.bool_)


def _on_edges(
    surface: ImplicitSurface, lattice: _Lattice, low: Ints, high: Ints, w0: Floats, w1: Floats
) -> tuple[Floats, Bools]:
    """Zeros (k,3) of F between neighbours on the lattice where it has the values w0, w1 (k,), and which are genuine."""

    def at(t: Floats, which: Ints) -> Floats:
        return checked_values(surface, lattice.points(low[which] + t[:, None] * (high - low)[which]))

    change, extent = np.abs(w1 - w0), float((lattice.high - lattice.low).max())
    digits = float(np.spacing(np.abs(np.stack([lattice.low, lattice.high])).max()))
    small = change * RESIDUAL_OF_EXTENT * extent / float(lattice.cell.max())
    t, rest = bracketed_zeros(at, w0, w1, w0 / (w0 - w1), small)
    exact = (w0 == 0.0) | (w1 == 0.0)
    t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
    rounding = 8.0 * change * digits / float(lattice.cell.min())
    falls = np.abs(rest) <= FALLS_BESIDE * np.minimum(np.abs(w0), np.abs(w1)) + small + rounding
    return lattice.points(low + t[:, None] * (high - low)), np.asarray(exact | falls, dtype=np.bool_)


def onto_surface(
    surface: ImplicitSurface, points: Floats, *, reach: float | Floats, fixed: Bools | None = None
) -> tuple[Floats, Bools]:
    """Points (n,3) moved along the gradient onto F = 0, not further than reach (or (n,)), and which of them got there.

    fixed (n,3) or (n,3+k): sides of `sides_of` that they stay on.
    """
    sides = sides_of(surface)
    x, arrived = points.copy(), np.zeros(len(points), dtype=np.bool_)
    far = np.broadcast_to(np.asarray(reach, dtype=np.float64), len(points))
    active: Ints = np.arange(len(points))
    enough = RESIDUAL_OF_EXTENT * float(np.ptp(np.asarray(surface.box), axis=0).max())
    for _ in range(ROUNDS):
        if not len(active):
            break
        with np.errstate(all="ignore"):
            slope = surface.gradients(x[active])
            if fixed is not None:
                slope = sides.along(slope, fixed[active])
            length = np.linalg.norm(slope, axis=1)
            w = checked_values(surface, x[active])
            step = np.where(w == 0.0, 0.0, w / length)
            way = np.where(w[:, None] == 0.0, 0.0, slope / length[:, None])
        usable = np.isfinite(step)
        x[active[usable]] -= (np.clip(step, -far[active], far[active])[:, None] * way)[usable]
        digits = 4.0 * np.spacing(greatest_component(np.abs(points[active])))
        arrived[active] = usable & (np.abs(step) <= np.maximum(enough, digits))
        active = active[usable & ~arrived[active]]
    arrived &= np.linalg.norm(x - points, axis=1) <= 2.0 * far
    return np.where(arrived[:, None], x, points), arrived


def _compact(lattice: _Lattice, vertices: Floats, triangles: Ints) -> Mesh:
    """The mesh with vertices closer than MERGED_OF_CELL made one, without what that leaves of triangles; of such
    vertices one that lies on most sides of the box stays."""
    digits = SIDE_ULPS * np.spacing(np.abs(np.stack([lattice.low, lattice.high])).max())
    below, above = vertices - lattice.low <= digits, lattice.high - vertices <= digits
    vertices = np.where(below, lattice.low, np.where(above, lattice.high, vertices))
    return _merged(vertices, triangles, below | above, MERGED_OF_CELL * float(lattice.cell.min()))


def _merged(vertices: Floats, triangles: Ints, on_sides: Bools, distance: float) -> Mesh:
    """The mesh of triangles (t,3) with vertices closer than a distance made one, without those that are nothing then;
    of such vertices one that lies on most sides (v,k) stays."""
    order = np.argsort(-on_sides.sum(axis=1), kind="stable")
    heads = np.empty_like(order)
    heads[order] = order[close_points(vertices[order], distance)]
    triangles = heads[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    used, corners = np.unique(triangles, return_inverse=True)
    return Mesh.from_triangles(vertices[used], corners.reshape(-1, 3)) if len(used) else _empty()


def _cut(surface: CutImplicit, mesh: Mesh, cell: float) -> Mesh:
    """What is left of a mesh of a surface, whose cells are so large, behind the planes that cut it."""
    for region in surface.regions:
        mesh = divided_mesh(mesh, region).outside
    if surface.within is not None:
        mesh = divided_mesh(mesh, surface.within).inside
    if not mesh.face_count:
        return _empty()
    triangles, sides = mesh.corners[ragged.fans(mesh.offsets)[0]], sides_of(surface)
    points = onto_surface(surface, mesh.vertices, fixed=sides.on(mesh.vertices), reach=cell)[0]
    return _merged(points, triangles, sides.on(points), MERGED_OF_CELL * cell)


def _empty() -> Mesh:
    return Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp))


def _connection(mesh: Mesh) -> tuple[int, int, int]:
    """Parts of a mesh, its Euler characteristic, and edges with more than two faces: 0 or 1 for some."""
    uses = edge_uses(mesh)
    parts = components(mesh, uses)[0]
    return parts, len(mesh.vertices) - len(uses.first) + mesh.face_count, int((uses.count > 2).any())
