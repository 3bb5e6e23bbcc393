"""Parametrised surfaces as sheets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.holes.holed_triangles import cut_at_holes
from vectorplot.surfaces.jumps import jumping_cells, jumps
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised

FEWEST, MOST = 32, 512
"""Cells of the tessellation in each direction, at least and at most."""

MOST_CELLS = 1 << 17

SAG = 2e-3
"""The tessellation is made finer until its chords are no further from the sheet than this part of half the scene."""

VAIN, MOST_VAIN = 0.8, 2
"""Where finer cells leave more than the one of what chords are off, as where waves crowd towards a point, they are in
vain; after so many times nothing finer is tried. At a vertical tangent they leave less."""


HALF = 0.1
"""Part of its longest side by which the surface may be off a triangle at the rim of a hole."""


@dataclass(frozen=True, eq=False)
class ParametricSheet(OnParametrised):
    """A parametrised surface, already in the view's coordinates, and its tessellation; jumps: whether it has triangles
    that were left out, because the surface jumps beneath them; holed: whether it has holes; creases: the v at which
    another sheet of the item begins behind a sharp edge; is_cap: whether it is a flat end, without parameter lines."""

    surface: Surface
    item: int
    hides: bool
    vertices: Floats
    vertex_places: Floats
    corners: Ints
    sags: Floats
    jumps: bool
    holed: bool = False
    creases: tuple[float, ...] = ()
    is_cap: bool = False

    def surface_at(self, places: Floats) -> Surface:
        """The surface, whatever the places."""
        return self.surface


def parametric_sheet(surface: Surface, item: int, hides: bool) -> ParametricSheet:
    """The sheet of a surface that is given in the view's coordinates.

    Degenerate: triangles beneath which the surface jumps are left out; those with a corner in a hole end at its rim.
    """
    columns, rows, sag = _fineness(surface)
    u_line, v_line = surface.domain.grid(columns, rows)
    u, v = (a.ravel() for a in np.meshgrid(u_line, v_line, indexing="ij"))
    vertices = surface.points(u, v)
    grid = vertices.reshape(columns + 1, rows + 1, 3)
    torn = jumping_cells(surface, u_line, v_line, grid).ravel()
    lower = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    right, upper = lower + rows + 1, lower + 1
    corners = np.concatenate([np.stack([lower, right, right + 1], 1), np.stack([lower, right + 1, upper], 1)])
    own = np.flatnonzero(~np.tile(torn, 2))
    known: Bools = np.asarray(np.isfinite(vertices).all(axis=1))
    cut = cut_at_holes(surface, np.stack([u, v], axis=1), corners[own], known)
    u, v = np.ascontiguousarray(cut.places.T)
    points = np.concatenate([vertices, surface.points(u[len(vertices) :], v[len(vertices) :])])
    off = np.maximum(_cell_sags(grid), SAG) if sag > SAG else np.full((columns, rows), sag)
    sags = np.tile(np.minimum(off, _around(grid)).ravel(), 2)[own[cut.of]]
    # Beside a rim nothing is told by what is beyond.
    at_rim = cut.on_rim[cut.triangles].any(axis=1)
    sags[at_rim] = np.maximum(sags[at_rim], HALF * _longest(points[cut.triangles[at_rim]]))
    places = np.stack([u, v, np.zeros_like(u)], axis=1)
    return ParametricSheet(surface, item, hides, points, places, cut.triangles, sags, bool(torn.any()), not known.all())


def _longest(triangles: Floats) -> Floats:
    """(t,) the longest sides of triangles (t,3,3)."""
    return np.asarray(np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1))


def _fineness(surface: Surface) -> tuple[int, int, float]:
    """Columns and rows of a tessellation that is close enough to the surface, and how close it is."""
    columns = rows = FEWEST
    best, vain = np.inf, 0
    while True:
        across, along = _sags(surface, surface.domain, columns, rows)
        more_columns = across > SAG and 2 * columns <= MOST
        more_rows = along > SAG and 2 * rows <= MOST
        worst = max(across, along)
        vain, best = vain + (worst > VAIN * best), min(best, worst)
        if not (more_columns or more_rows) or columns * rows * 2 > MOST_CELLS or vain == MOST_VAIN:
            return columns, rows, worst
        columns, rows = columns << more_columns, rows << more_rows


def _sags(surface: Surface, domain: Domain, columns: int, rows: int) -> tuple[float, float]:
    """How far the middles of chords are off the surface, along u and along v; the worst of a thousand."""
    u, v = domain.grid(2 * columns, 2 * rows)
    places = np.stack(np.meshgrid(u, v[:: max(2, rows // 16)], indexing="ij"), axis=-1)
    across = _sag(surface, places)
    places = np.stack(np.meshgrid(u[:: max(2, columns // 16)], v, indexing="ij"), axis=-1)
    return across, _sag(surface, np.swapaxes(places, 0, 1))


def _sag(surface: Surface, places: Floats) -> float:
    """How far every second of places (m,n,2) is off the chord between those beside it; where the surface jumps there
    is no chord."""
    points = surface.points(places[..., 0], places[..., 1])
    off = points[1::2] - 0.5 * (points[:-1:2] + points[2::2])
    long = np.nan_to_num(np.linalg.norm(off, axis=-1))
    far = np.nonzero(long > SAG)
    if len(far[0]):
        long[far] *= ~jumps(surface, places[:-1:2][far], places[2::2][far])
    return float(long.max(initial=0.0))


def _around(points: Floats) -> Floats:
    """(m-1,n-1) how large the largest is of each cell of a grid of points (m,n,3) and its neighbours: the surface is
    not farther off, however much smaller cells are than elsewhere."""
    with np.errstate(invalid="ignore"):
        diagonal = [points[1:, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, 1:]]
    long = np.maximum(*(np.linalg.norm(way, axis=-1) for way in diagonal))
    long[~np.isfinite(long)] = np.inf
    padded = np.pad(long, 1, mode="edge")
    one_way = np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
    return np.asarray(np.maximum(np.maximum(one_way[:, :-2], one_way[:, 1:-1]), one_way[:, 2:]))


def _cell_sags(points: Floats) -> Floats:
    """(m-1,n-1) how far the surface may be off the cells of a grid of its points (m,n,3), by second differences in
    them and their neighbours."""
    with np.errstate(invalid="ignore"):
        bent: Floats = np.zeros((len(points), points.shape[1]))
        bent[1:-1] += np.nan_to_num(np.linalg.norm(points[2:] - 2.0 * points[1:-1] + points[:-2], axis=-1))
        bent[:, 1:-1] += np.nan_to_num(np.linalg.norm(points[:, 2:] - 2.0 * points[:, 1:-1] + points[:, :-2], axis=-1))
        twist = points[1:, 1:] - points[1:, :-1] - points[:-1, 1:] + points[:-1, :-1]
    # Twice an eighth of the second difference: it grows towards a pole.
    corners = [bent[a : a + len(bent) - 1, b : b + bent.shape[1] - 1] for a in (0, 1) for b in (0, 1)]
    return np.asarray(0.25 * np.maximum.reduce(corners) + 0.25 * np.nan_to_num(np.linalg.norm(twist, axis=-1)))
