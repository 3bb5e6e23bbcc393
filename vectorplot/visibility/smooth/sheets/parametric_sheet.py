"""Parametrised surfaces as sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.holes.holed_triangles import cut_at_holes
from vectorplot.features.parametric.stacked_conditions import stacks
from vectorplot.geometry.vectors import from_components, norm
from vectorplot.surfaces.jumps import jumping_cells
from vectorplot.surfaces.stacked import StackedSurfaces
from vectorplot.surfaces.surface import Surface
from vectorplot.visibility.smooth.sheets.fineness import FEWEST, SAG, alike, fineness
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised

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
    """The sheet of a surface, as of `parametric_sheets`."""
    return parametric_sheets([surface], [item], [hides])[0]


def parametric_sheets(
    surfaces: Sequence[Surface], items: Sequence[int], hides: Sequence[bool]
) -> list[ParametricSheet]:
    """The sheets of surfaces that are given in the view's coordinates, made together as far as these are alike.

    Degenerate: triangles beneath which a surface jumps are left out; those with a corner in a hole end at its rim.
    """
    sheets: dict[int, ParametricSheet] = {}
    for part in stacks(surfaces, (FEWEST + 1) ** 2):
        stack = StackedSurfaces.of([surfaces[k] for k in part.tolist()])
        columns, rows, sag = fineness(stack)
        for own in alike(columns, rows):
            grids = _Grids.of(stack.some(own), int(columns[own[0]]), int(rows[own[0]]), sag[own])
            for row, number in enumerate(part[own].tolist()):
                sheets[number] = grids.sheet(row, surfaces[number], items[number], hides[number])
    return [sheets[number] for number in range(len(surfaces))]


@dataclass(frozen=True, eq=False)
class _Grids:
    """Grids (s,) of as many points p on as many surfaces.

    places (s or 1,p,3) of the points on the surfaces, the same for all where these have one domain; points (s,p,3);
    corners (t,3) of their triangles; whole (s,t): those beneath which the surface does not jump; sags (s,t): how far
    they are off it.
    """

    places: Floats
    points: Floats
    corners: Ints
    whole: Bools
    sags: Floats

    @classmethod
    def of(cls, surfaces: StackedSurfaces, columns: int, rows: int, sag: Floats) -> _Grids:
        """Those of so many columns and rows; sag (s,): how far chords are off the surfaces."""
        u_line, v_line = surfaces.grid_lines(columns, rows)
        u, v = np.broadcast_arrays(u_line[:, :, None], v_line[:, None, :])
        u, v = (t.reshape(len(u_line), -1) for t in (u, v))
        points = surfaces.points_of_all(u, v)
        grids = points.reshape(len(surfaces), columns + 1, rows + 1, 3)
        torn = jumping_cells(surfaces, u_line, v_line, grids)
        off = np.broadcast_to(sag[:, None, None], torn.shape).copy()
        bent = np.flatnonzero(sag > SAG)
        if len(bent):
            off[bent] = np.maximum(_cell_sags(grids[bent]), SAG)
        sags = np.minimum(off, _around(grids))
        lower = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
        right, upper = lower + rows + 1, lower + 1
        corners = np.concatenate([np.stack([lower, right, right + 1], 1), np.stack([lower, right + 1, upper], 1)])
        twice = (np.tile(cells.reshape(len(surfaces), -1), 2) for cells in (~torn, sags))
        return cls(from_components(u, v, 0.0), points, corners, *twice)

    def sheet(self, row: int, surface: Surface, item: int, hides: bool) -> ParametricSheet:
        """That on one of the surfaces. What is the same for all of them is theirs together."""
        points, sags = self.points[row], self.sags[row]
        places, whole = self.places[row if len(self.places) > 1 else 0], self.whole[row]
        known: Bools = np.asarray(np.isfinite(points).all(axis=1))
        if known.all() and whole.all():
            return ParametricSheet(surface, item, hides, points, places, self.corners, sags, False)
        own = np.flatnonzero(whole)
        cut = cut_at_holes(surface, places[:, :2], self.corners[own], known)
        new = cut.places[len(points) :]
        points = np.concatenate([points, surface.points(*np.ascontiguousarray(new.T))])
        sags = sags[own[cut.of]]
        # Beside a rim nothing is told by what is beyond.
        at_rim = cut.on_rim[cut.triangles].any(axis=1)
        sags[at_rim] = np.maximum(sags[at_rim], HALF * _longest(points[cut.triangles[at_rim]]))
        places = from_components(*cut.places.T, 0.0)
        return ParametricSheet(
            surface, item, hides, points, places, cut.triangles, sags, not whole.all(), not known.all()
        )


def _longest(triangles: Floats) -> Floats:
    """(t,) the longest sides of triangles (t,3,3)."""
    return np.asarray(np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1))


def _around(points: Floats) -> Floats:
    """(s,m-1,n-1) how large the largest is of each cell of grids of points (s,m,n,3) and its neighbours: the surface is
    not farther off, however much smaller cells are than elsewhere."""
    with np.errstate(invalid="ignore"):
        long = np.maximum(norm(points[:, 1:, 1:] - points[:, :-1, :-1]), norm(points[:, 1:, :-1] - points[:, :-1, 1:]))
    long[~np.isfinite(long)] = np.inf
    padded = np.pad(long, ((0, 0), (1, 1), (1, 1)), mode="edge")
    one_way = np.maximum(np.maximum(padded[:, :-2], padded[:, 1:-1]), padded[:, 2:])
    return np.asarray(np.maximum(np.maximum(one_way[..., :-2], one_way[..., 1:-1]), one_way[..., 2:]))


def _cell_sags(points: Floats) -> Floats:
    """(s,m-1,n-1) how far the surfaces may be off the cells of grids of their points (s,m,n,3), by second differences
    in them and their neighbours."""
    with np.errstate(invalid="ignore"):
        bent: Floats = np.zeros(points.shape[:3])
        bent[:, 1:-1] += np.nan_to_num(norm(points[:, 2:] - 2.0 * points[:, 1:-1] + points[:, :-2]))
        bent[..., 1:-1] += np.nan_to_num(norm(points[:, :, 2:] - 2.0 * points[:, :, 1:-1] + points[:, :, :-2]))
        twist = points[:, 1:, 1:] - points[:, 1:, :-1] - points[:, :-1, 1:] + points[:, :-1, :-1]
    # Twice an eighth of the second difference: it grows towards a pole.
    corners = [bent[:, a : a + bent.shape[1] - 1, b : b + bent.shape[2] - 1] for a in (0, 1) for b in (0, 1)]
    return np.asarray(0.25 * np.maximum.reduce(corners) + 0.25 * np.nan_to_num(norm(twist)))
