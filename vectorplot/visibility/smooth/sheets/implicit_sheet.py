"""Implicit surfaces as sheets."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.implicit_mesh import ImplicitMesh, mesh_with_lines
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.polygonize import polygonized
from vectorplot.features.implicit.singular.implicit_singular_lines import singular_lines, usual_gradient
from vectorplot.features.implicit.singular.singular_equations import CuspidalEdges
from vectorplot.geometry.algebra import matmul, pseudo_inverse
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.surfaces.placed_surface import PlacedImplicit
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.surfaces.trims.cut_implicit import CutImplicit
from vectorplot.tolerances.of_angles import SAME_DIRECTION_SINE
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.tolerances.of_parameters import OUTSIDE_DOMAIN
from vectorplot.tolerances.of_values import NOISE_OF_GRADIENT

FEWEST, MOST = 48, 192
"""Cells along the longest side of the box on which a surface is polygonised, at least and at most."""

SAG = 3e-3
"""Cells are made smaller until most triangles are no further from the sheet than this part of half the scene."""

MOST_OF_ALL = 0.99
"""Which part of the triangles that is: those at singular points stay far off."""

LONGEST_STEP = 0.05
"""Part of half the scene that one step of Newton may go: a longer one leads anywhere."""


@dataclass(frozen=True, eq=False)
class ImplicitSheet:
    """An implicit surface within its box, and its tessellation; places are points in the view's coordinates.

    surface: in the view's coordinates; home: the same one as it was given, in the world, where its box is; view: the
    way from the one to the other; own: the surface polygonised, in the world.
    """

    surface: PlacedImplicit
    home: ImplicitSurface
    view: View
    item: int
    hides: bool
    vertices: Floats
    corners: Ints
    sags: Floats
    own: ImplicitMesh

    @property
    def vertex_places(self) -> Floats:
        """(m,3) the vertices."""
        return self.vertices

    def points(self, places: Floats) -> Floats:
        """(k,3) points of the sheet: one step of Newton from places that are a little off it."""
        with np.errstate(all="ignore"):
            slopes = self.surface.gradients(places)
            off = self.surface.values(places) / dot(slopes, slopes)
        step = off[:, None] * slopes
        # On the sheet the step is rounding, and at a singular point it is none.
        return np.asarray(places - np.where(np.isfinite(step) | ~np.isfinite(places), step, 0.0))

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit gradients; NaN at singular points."""
        with np.errstate(all="ignore"):
            slopes = self.surface.gradients(places)
            return np.asarray(slopes / np.linalg.norm(slopes, axis=1, keepdims=True))

    def bends(self, places: Floats, directions: Floats) -> Floats:
        """(k,) normal parts of the accelerations along tangential parts of directions; 0 at singular points.

        Along a path on F = 0 with velocity w, gradient and acceleration have the product -w.H.w, H the second
        derivatives of F.
        """
        with np.errstate(all="ignore"):
            slopes = self.surface.gradients(places)
            long = np.linalg.norm(slopes, axis=1)
            way = _tangential(directions, slopes / long[:, None])
            bend = -np.einsum("ki,kij,kj->k", way, self.surface.hessians(places), way) / long
        return np.where(np.isfinite(bend) & (long > self.least), bend, 0.0)

    @cached_property
    def least(self) -> float:
        """The length of gradients that are rounding: at singular points."""
        return NOISE_OF_GRADIENT * usual_gradient(self.surface, self.vertices)

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps lead to."""
        return np.asarray(places + _tangential(steps, self.normals(places)))

    def inwards(self, places: Floats) -> Floats:
        """(k,3) tangents into the sheet at places on the sides of the box and planes that cut it; 0 elsewhere."""
        part = self._parts(places)
        sides = (part <= self._beyond).astype(np.float64) - (part >= 1.0 - self._beyond)
        if self._cuts is not None:
            on = self._cuts.on_borders(self.view.world_of(places.T), self._nothing)
            sides = np.concatenate([sides, on.astype(np.float64)], axis=1)
        inner = np.zeros_like(places)
        at = np.flatnonzero(sides.any(axis=1))
        # One row for each side: its normal into the box, as far as it is tangential. At edges of the box the way is
        # into both of its sides.
        normals = np.nan_to_num(self.normals(places[at]))
        along = sides[at, :, None] * (matmul(sides_of(self.home).normals, self.view.axes.T))
        along = along - np.einsum("kij,kj->ki", along, normals)[:, :, None] * normals[:, None]
        inner[at] = np.einsum("kij,kj->ki", pseudo_inverse(along, rcond=SAME_DIRECTION_SINE), np.abs(sides[at]))
        return inner

    def turnings(self, places: Floats) -> Floats:
        """(k,3) into both wings of cuspidal edges."""
        return CuspidalEdges(self.surface, 1.0).turnings(places)

    def missed(self, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3) one Newton step along lines, from the points of them that are nearest to places; and the
        points (k,3) of the sheet at these."""
        square = dot(ways, ways)
        with np.errstate(all="ignore"):
            t = dot(places - points, ways) / square
            at = points + t[:, None] * ways
            step = self.surface.values(at) / dot(self.surface.gradients(at), ways)
            longest = LONGEST_STEP / np.sqrt(square)
        t = t - np.clip(step, -longest, longest)
        return t, points + t[:, None] * ways, self.points(places)

    def apart(self, one: Floats, two: Floats) -> Floats:
        """(k,) distances in space."""
        return np.asarray(np.linalg.norm(one - two, axis=1))

    def on_sheet(self, places: Floats) -> Bools:
        """(k,) whether places lie in the box, and are not cut away."""
        part = self._parts(places)
        on = np.asarray(((part >= -self._beyond) & (part <= 1.0 + self._beyond)).all(axis=1), dtype=np.bool_)
        if self._cuts is not None:
            on &= self._cuts.beyond(self.view.world_of(places.T)) <= self._nothing
        return on

    def depths_in_box(self, places: Floats) -> Floats:
        """(k,) how far places are from the nearest side of the box, as parts of it, or cut; negative outside."""
        part = self._parts(places)
        inside = np.minimum(part, 1.0 - part).min(axis=1)
        if self._cuts is not None:
            inside = np.minimum(inside, -self._cuts.beyond(self.view.world_of(places.T)) / self._extent)
        return np.asarray(inside)

    @property
    def _cuts(self) -> CutImplicit | None:
        """The surface, if planes cut it."""
        return self.home if isinstance(self.home, CutImplicit) else None

    @property
    def _extent(self) -> float:
        """The longest side of the box."""
        return float(np.ptp(np.asarray(self.home.box, dtype=np.float64), axis=0).max())

    @property
    def _nothing(self) -> float:
        """The distance from a plane that rounding may make."""
        return float(self._beyond.max()) * self._extent

    def _parts(self, places: Floats) -> Floats:
        """(k,3) where places are between the sides of the box: 0 to 1 along each."""
        low, high = np.asarray(self.home.box, dtype=np.float64)
        return np.asarray((self.view.world_of(places.T) - low) / (high - low))

    @property
    def _beyond(self) -> Floats:
        """(3,) what rounding may make of these."""
        low, high = np.asarray(self.home.box, dtype=np.float64)
        return np.asarray(OUTSIDE_DOMAIN + 16.0 * ROUNDING * np.maximum(np.abs(low), np.abs(high)) / (high - low))


def implicit_sheet(view: View, surface: ImplicitSurface, item: int, hides: bool) -> ImplicitSheet:
    """The sheet of a surface in the world as a view sees it.

    Errors: as for `polygonized`. Degenerate: F of one sign gives a sheet without triangles.
    """
    placed = placed_in_view(view, surface)
    cells = FEWEST
    mesh = polygonized(surface, cells)
    lines = singular_lines(surface, mesh)
    while True:
        own = mesh_with_lines(surface, mesh, lines, cells)
        vertices = np.ascontiguousarray(view.points_of(own.mesh.vertices).T)
        corners = own.mesh.corners.reshape(-1, 3)
        off = _sags(placed, vertices[corners])
        if np.quantile(np.append(off, 0.0), MOST_OF_ALL) <= SAG or own.doubts or 2 * cells > MOST:
            # Those at singular points stay far off; of the others the worst speaks for all.
            sags = np.maximum(off, min(float(off.max(initial=0.0)), SAG))
            return ImplicitSheet(placed, surface, view, item, hides, vertices, corners, sags, own)
        cells *= 2
        mesh = polygonized(surface, cells)


def placed_in_view(view: View, surface: ImplicitSurface) -> PlacedImplicit:
    """A surface of the world in the view's coordinates; its box is the one around the turned box."""
    matrix, centre = view.axes.T / view.scale, view.centre
    if isinstance(surface, PlacedImplicit):
        # One placement instead of two keeps the digits of what is far from the origin.
        own, shift = np.asarray(surface.matrix), np.asarray(surface.shift)
        return PlacedImplicit(surface.surface, matmul(own, matrix), matmul(shift - centre, matrix))
    return PlacedImplicit(surface, matrix, matmul(-centre, matrix))


def _sags(surface: PlacedImplicit, triangles: Floats) -> Floats:
    """(t,) how far the middles of triangles (t,3,3) are off the surface, not more than they are large."""
    middles = triangles.mean(axis=1)
    size = norm(triangles - np.roll(triangles, 1, axis=1)).max(axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        off = np.abs(surface.values(middles)) / np.linalg.norm(surface.gradients(middles), axis=1)
    return np.asarray(np.fmin(off, size))


def _tangential(vectors: Floats, normals: Floats) -> Floats:
    """(k,3) the parts of vectors across unit normals."""
    return np.asarray(vectors - dot(vectors, normals)[:, None] * normals)
