"""A smooth surface as the engine sees it: known exactly at places, and roughly by a tessellation."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import MOST_PARAMETERS, stacks
from vectorplot.features.hole_rims import cut_at_holes, grid_triangles
from vectorplot.features.holes import along_rims, in_domain, inside, into_surface, is_known
from vectorplot.features.implicit_meshes import ImplicitMesh, mesh_with_lines
from vectorplot.features.implicit_singular_lines import CuspidalEdges, default_gradient, singular_lines
from vectorplot.features.polygonization import polygonized, sides_of
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse
from vectorplot.geometry.vectors import any_component, cross, dot, from_components, norm
from vectorplot.scene.view import View
from vectorplot.surfaces.implicit import CutImplicit
from vectorplot.surfaces.parameter_regions import ParameterRegions
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.stacked import (
    StackedSurfaces,
    jumping_cells,
    jumps,
    of_some,
    tangent_planes,
    unit_normals,
    unit_normals_of,
)
from vectorplot.surfaces.surface import ImplicitSurface, Surface, first_jets
from vectorplot.surfaces.trimmed import trims_of, uncut
from vectorplot.tolerances import (
    LEAST_DIVISOR,
    NOISE_OF_GRADIENT,
    OFF_RIM,
    OUTSIDE_DOMAIN,
    ROUNDING,
    SAME_DIRECTION_SINE,
)

BESIDE_EDGE = 1.0 / 256.0
"""Part of the domain from a cuspidal edge, at which its wings are compared."""


class OnSheet(Protocol):
    """What is known at places (k,3) on a smooth surface, in the view's coordinates.

    A place says where on the sheet something is: parameters (u, v, 0) of a parametrised surface, the point itself of an
    implicit one; and on which of several, where they are asked as one (see parametric_places).
    """

    def points(self, places: Floats) -> Floats:
        """(k,3) points."""
        ...

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals; NaN at singular points."""
        ...

    def bends(self, places: Floats, directions: Floats) -> Floats:
        """(k,) how strongly the sheet bends towards its normal along the tangential parts of directions (k,3): the
        normal part of the acceleration of a path with that velocity."""
        ...

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps (k,3) lead to, to first order."""
        ...

    def inwards(self, places: Floats) -> Floats:
        """(k,3) tangents into the sheet at places on its border; 0 elsewhere."""
        ...

    def turnings(self, places: Floats) -> Floats:
        """(k,3) the direction to which both wings of a cuspidal edge turn, at places on it."""
        ...

    def wings(self, places: Floats, ahead: Floats) -> Floats:
        """(k,3) short ways from the one wing of a cuspidal edge to that on which other places lie, ahead, at places on
        the edge; 0 where that is not known."""
        ...

    def missed(self, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3): one Newton step for where lines points + t ways meet the sheet: t, and the places there; and
        the points (k,3) of the sheet at the places from which the step is taken."""
        ...

    def apart(self, one: Floats, two: Floats) -> Floats:
        """(k,) how far places are from each other as parts of the domain; whole periods do not count."""
        ...

    def on_sheet(self, places: Floats) -> Bools:
        """(k,) whether places lie in the domain."""
        ...


class Sheet(OnSheet, Protocol):
    """A smooth surface in the view's coordinates."""

    @property
    def item(self) -> int:
        """The item it belongs to."""
        ...

    @property
    def hides(self) -> bool:
        """Whether it hides what is behind it."""
        ...

    @property
    def vertices(self) -> Floats:
        """(m,3) points of a tessellation, on the sheet."""
        ...

    @property
    def vertex_places(self) -> Floats:
        """(m,3) their places."""
        ...

    @property
    def corners(self) -> Ints:
        """(t,3) the vertices of its triangles."""
        ...

    @property
    def deviations(self) -> Floats:
        """(t,) how far its triangles are off the sheet, about."""
        ...


def solved(a: Floats, b: Floats, c: Floats, right: Floats) -> Floats:
    """(k,3) the x with x0 a + x1 b + x2 c = right, for rows of vectors (k,3); not finite where they lie in a plane."""
    bc = cross(b, c)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        factor = 1.0 / dot(a, bc)
        return np.stack(
            [dot(right, bc) * factor, dot(right, cross(c, a)) * factor, dot(right, cross(a, b)) * factor], axis=1
        )


# Places on parametrised sheets, one sheet or many: what is known there.

LONGEST_STEP = 0.05
"""Part of the domain that one step of Newton may go: a longer one leads anywhere."""


@dataclass(frozen=True, eq=False)
class TangentPlanes:
    """Tangent planes at places (k,3) of sheets: points (k,3) there, derivatives (k,3) by u and by v, unit normals
    (k,3), NaN at singular points."""

    places: Floats
    points: Floats
    along_u: Floats
    along_v: Floats
    normals: Floats

    def moved(self, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps (k,3) lead to."""
        return _moved(self.places, self.along_u, self.along_v, steps)


class OnParametrised(ABC):
    """What a sheet knows at places (k,3), which are (u, v) and, where it is made of several, the number of the one."""

    @abstractmethod
    def surface_at(self, places: Floats) -> Surface:
        """The surface, in the view's coordinates, to be asked for parameters at these places (k,3)."""

    @property
    @abstractmethod
    def holed(self) -> bool:
        """Whether there is a surface with holes."""

    @property
    @abstractmethod
    def trims(self) -> ParameterRegions | None:
        """What curves leave of the domains of surfaces that they trim; None where there is none of these."""

    @abstractmethod
    def trim_at(self, places: Floats) -> Ints:
        """(k,) which of these regions each place belongs to, -1 for one on a surface that is not trimmed."""

    def points(self, places: Floats) -> Floats:
        """(k,3) points."""
        surface = self.surface_at(places)
        return surface.points(*inside(surface.domain, places))

    def partials(self, places: Floats) -> tuple[Floats, Floats]:
        """(k,3) derivatives by u and by v."""
        surface = self.surface_at(places)
        return surface.partials(*inside(surface.domain, places))

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit normals; NaN at singular points."""
        surface = self.surface_at(places)
        return unit_normals(surface, *inside(surface.domain, places))

    def planes(self, places: Floats) -> TangentPlanes:
        """The tangent planes."""
        surface = self.surface_at(places)
        u, v = inside(surface.domain, places)
        jets, normals = tangent_planes(surface, u, v)
        return TangentPlanes(places, *jets, normals)

    def bends(self, places: Floats, directions: Floats) -> Floats:
        """(k,) normal parts of the accelerations along tangential directions; 0 at singular points; at rims of holes
        those a little inside: there is no second derivative where a surface ends with a vertical tangent."""
        surface = self.surface_at(places)
        if self.holed:
            places = off_rims(surface, places)
        u, v = inside(surface.domain, places)
        along_u, along_v = surface.partials(u, v)
        uu, uv, vv = surface.second_partials(u, v)
        n = unit_normals_of(surface, u, v, (along_u, along_v))
        with np.errstate(invalid="ignore", divide="ignore"):
            a, b, _ = solved(along_u, along_v, n, directions).T
            bend = dot(n, uu) * a * a + 2.0 * dot(n, uv) * a * b + dot(n, vv) * b * b
        return np.where(np.isfinite(bend), bend, 0.0)

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps lead to."""
        return _moved(places, *self.partials(places), steps)

    def inwards(self, places: Floats) -> Floats:
        """(k,3) tangents into the sheet at places on its border, at right angles to it; 0 elsewhere."""
        surface = self.surface_at(places)
        domain = surface.domain
        along_u, along_v = surface.partials(*inside(domain, places))
        on_u, on_v = (
            np.zeros((len(places), 1)) if closed else _at_ends((places[:, axis] - start) / size)[:, None]
            for axis, closed, start, size in (
                (0, domain.closed_u, domain.u_start, domain.size[0]),
                (1, domain.closed_v, domain.v_start, domain.size[1]),
            )
        )
        # A border of u runs along v. In a corner nothing is at right angles to both: there it is between them.
        border = (on_u == 0.0) * along_u + (on_v == 0.0) * along_v
        inner = _across(on_u * along_u + on_v * along_v, border)
        inside_domain = np.flatnonzero(~inner.any(axis=1))
        if self.holed and len(inside_domain):
            inner[inside_domain] = self._into_holed(places[inside_domain])
        if self.trims is not None:
            trim = self.trim_at(places)
            at = np.flatnonzero(trim >= 0)
            ways = self.trims.inwards(places[at, :2], trim[at])
            into, along = (way[:, :1] * along_u[at] + way[:, 1:] * along_v[at] for way in ways)
            inner[at] = _unit(inner[at]) + _unit(_across(into, along))
        return inner

    def _into_holed(self, places: Floats) -> Floats:
        """(k,3) short ways into the sheet from places on rims of holes, at right angles to them; 0 elsewhere.
        Differences: where a surface comes to its rim with a vertical tangent there is no derivative."""
        result = np.zeros_like(places)
        way = into_surface(self.surface_at(places), places[:, :2])
        rim = np.flatnonzero(way.any(axis=1))
        if len(rim):
            at, way = places[rim], way[rim]
            one, two = along_rims(self.surface_at(at), at[:, :2], way)
            here, inner, one, two = (
                self.points(np.concatenate([of, at[:, 2:]], axis=1)) for of in (at[:, :2], at[:, :2] + way, one, two)
            )
            result[rim] = _across(inner - here, two - one)
        return np.where(np.isfinite(result), result, 0.0)

    def turnings(self, places: Floats) -> Floats:
        """(k,3) second derivatives along the direction in which the point stands still."""
        surface = self.surface_at(places)
        uu, uv, vv = surface.second_partials(*inside(surface.domain, places))
        a, b = (part[:, None] for part in self._standing(places))
        return np.asarray(uu * a * a + 2.0 * uv * a * b + vv * b * b)

    def wings(self, places: Floats, ahead: Floats) -> Floats:
        """(k,3) from points of one wing to those of the other that are as far from the edge."""
        width, height = self.surface_at(places).domain.size
        a, b = self._standing(places)
        size = np.maximum(np.hypot(a / width, b / height), LEAST_DIVISOR) / BESIDE_EDGE
        step = from_components(a / size, b / size, 0.0)
        turned = np.sign(dot(self.normals(places + step), self.normals(ahead)))
        return np.asarray(turned[:, None] * (self.points(places + step) - self.points(places - step)))

    def _standing(self, places: Floats) -> tuple[Floats, Floats]:
        """(k,) each: u and v of the direction in which the point stands still, at places on cuspidal edges."""
        surface = self.surface_at(places)
        along_u, along_v = surface.partials(*inside(surface.domain, places))
        # Both partials have one direction: that of a x_u + b x_v = 0, in proportion to the domain.
        width, height = surface.domain.size
        along_u, along_v = along_u * np.asarray(width)[..., None], along_v * np.asarray(height)[..., None]
        long = dot(along_u, along_u) >= dot(along_v, along_v)
        product = dot(along_u, along_v)
        a = np.where(long, -product, dot(along_v, along_v))
        b = np.where(long, dot(along_u, along_u), -product)
        return a * width, b * height

    def missed(self, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3) one Newton step for where lines meet the sheet; and the points (k,3) at the places."""
        surface = self.surface_at(places)
        u, v = inside(surface.domain, places)
        here, along_u, along_v = first_jets(surface, u, v)
        step = solved(along_u, along_v, -ways, points - here)
        t = np.where(np.isfinite(step[:, 2]), step[:, 2], np.nan)
        step[:, 2] = 0.0
        width, height = surface.domain.size
        with np.errstate(invalid="ignore"):
            long = np.maximum(np.abs(step[:, 0]) / width, np.abs(step[:, 1]) / height)
            step *= np.minimum(1.0, LONGEST_STEP / np.maximum(long, LEAST_DIVISOR))[:, None]
        return t, from_components(u, v, places[:, 2]) + step, here

    def apart(self, one: Floats, two: Floats) -> Floats:
        """(k,) the larger of the distances in u and v, as parts of the domain."""
        domain = self.surface_at(one).domain
        du = np.abs(one[:, 0] - two[:, 0]) / domain.size[0]
        dv = np.abs(one[:, 1] - two[:, 1]) / domain.size[1]
        if domain.closed_u:
            du = np.abs(du - np.round(du))
        if domain.closed_v:
            dv = np.abs(dv - np.round(dv))
        return np.maximum(du, dv)

    def on_sheet(self, places: Floats) -> Bools:
        """(k,) whether places lie in the domain."""
        on = in_domain(self.surface_at(places).domain, places[:, :2]) & np.isfinite(places).all(axis=1)
        if self.trims is not None:
            trim = self.trim_at(places)
            at = np.flatnonzero(on & (trim >= 0))
            on[at] = self.trims.contains(places[at, 0], places[at, 1], trim[at])
        return on


@dataclass(frozen=True, eq=False)
class StackedSheets(OnParametrised):
    """Many parametrised sheets as one; the third number of a place says on which of them it is. trims: of those that
    curves trim, and trim (s,): which of these regions each sheet has, or -1."""

    surfaces: StackedSurfaces
    holed: bool = False
    trims: ParameterRegions | None = None
    trim: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))

    @classmethod
    def of(cls, sheets: Sequence[ParametricSheet]) -> StackedSheets:
        """These sheets."""
        surfaces = tuple(sheet.asked for sheet in sheets if isinstance(sheet.asked, PlacedSurface))
        trimmed = [sheet.trims for sheet in sheets if sheet.trims is not None]
        own = np.array([sheet.trims is not None for sheet in sheets])
        return cls(
            StackedSurfaces(surfaces),
            any(sheet.holed for sheet in sheets),
            ParameterRegions.together(trimmed) if trimmed else None,
            np.where(own, np.cumsum(own) - 1, -1),
        )

    def trim_at(self, places: Floats) -> Ints:
        """That of the sheet of each place."""
        return self.trim[places[:, 2].astype(np.intp)]

    def surface_at(self, places: Floats) -> Surface:
        """That of the sheet of each place."""
        return self.surfaces.at(places[:, 2].astype(np.intp))


def off_rims(surface: Surface, places: Floats) -> Floats:
    """The places (k,3), those on the rims of holes moved away from them into the surface by a part of the domain."""
    way = into_surface(surface, places[:, :2])
    at = np.flatnonzero(way.any(axis=1))
    if not len(at):
        return places
    own = of_some(surface, at)
    size = from_components(*own.domain.size)
    long = np.linalg.norm(way[at] / size, axis=1, keepdims=True)
    inner = places[at, :2] + OFF_RIM * way[at] / long
    good = is_known(own, inner)
    result = places.copy()
    result[at[good], :2] = inner[good]
    return result


def _at_ends(part: Floats) -> Floats:
    """(k,) 1 for parts of a range at its start, -1 for those at its end; else 0."""
    return (part <= OUTSIDE_DOMAIN).astype(np.float64) - (part >= 1.0 - OUTSIDE_DOMAIN)


def _across(vectors: Floats, along: Floats) -> Floats:
    """(k,3) the parts of vectors at right angles to others; all of them where these have no length."""
    return np.asarray(vectors - (dot(vectors, along) / dot(along, along).clip(LEAST_DIVISOR))[:, None] * along)


def _unit(vectors: Floats) -> Floats:
    """(k,3) of length 1; 0 where they have none."""
    return np.asarray(vectors / np.maximum(norm(vectors), LEAST_DIVISOR)[:, None])


def _moved(places: Floats, along_u: Floats, along_v: Floats, steps: Floats) -> Floats:
    """(k,3) the places that small steps (k,3) in the planes of the derivatives lead to."""
    step = solved(along_u, along_v, cross(along_u, along_v), steps)
    step[:, 2] = 0.0
    return places + step


# How fine the tessellations of sheets are, and how close to their surfaces.

FEWEST, MOST = 32, 512
"""Cells of the tessellation in each direction, at least and at most."""

MOST_CELLS = 1 << 17

LINES = 16
"""Lines along which chords are looked at, about."""

SAG = 2e-3
"""The tessellation is made finer until its chords are no further from the sheet than this part of half the scene."""

VAIN, MOST_VAIN = 0.8, 2
"""Where finer cells leave more than the one of what chords are off, as where waves crowd towards a point, they are in
vain; after so many times nothing finer is tried. At a vertical tangent they leave less."""


def fineness(surfaces: StackedSurfaces, fewest: int = FEWEST) -> tuple[Ints, Ints, Floats]:
    """(s,) columns and rows of tessellations that are close enough to their surfaces, so many at least, and how close
    (s,) they are."""
    count = len(surfaces)
    columns, rows = np.full(count, fewest), np.full(count, fewest)
    deviation, best, vain = np.zeros(count), np.full(count, np.inf), np.zeros(count, dtype=np.intp)
    across, along = np.zeros(count), np.zeros(count)
    active = np.arange(count)
    while len(active):
        for some in alike(columns[active], rows[active]):
            own = active[some]
            across[own], along[own] = _deviations(surfaces.take(own), int(columns[own[0]]), int(rows[own[0]]))
        deviation[active] = np.maximum(across, along)[active]
        vain[active] += (deviation > VAIN * best)[active]
        best[active] = np.minimum(best, deviation)[active]
        more_columns, more_rows = (across > SAG) & (2 * columns <= MOST), (along > SAG) & (2 * rows <= MOST)
        finer = (more_columns | more_rows) & (columns * rows * 2 <= MOST_CELLS) & (vain != MOST_VAIN)
        active = active[finer[active]]
        columns[active] <<= more_columns[active]
        rows[active] <<= more_rows[active]
    return columns, rows, deviation


def alike(columns: Ints, rows: Ints) -> Iterator[Ints]:
    """The numbers of grids (k,) of as many columns and rows, as many at a time as fit into memory."""
    key, of = np.unique(np.stack([columns, rows]), axis=1, return_inverse=True)
    for number, (across, along) in enumerate(key.T.tolist()):
        own = np.flatnonzero(of.ravel() == number)
        most = max(1, MOST_PARAMETERS // ((across + 1) * (along + 1)))
        yield from (own[k : k + most] for k in range(0, len(own), most))


def _deviations(surfaces: StackedSurfaces, columns: int, rows: int) -> tuple[Floats, Floats]:
    """(s,) how far the middles of chords are off the surfaces, along u and along v; the worst of a thousand."""
    u, v = surfaces.grid_lines(2 * columns, 2 * rows)
    few_u, few_v = u[:, :: max(2, columns // LINES)], v[:, :: max(2, rows // LINES)]
    along = np.broadcast_arrays(few_u[:, None, :], v[:, :, None])
    return _deviation(surfaces, *np.broadcast_arrays(u[:, :, None], few_v[:, None, :])), _deviation(surfaces, *along)


def _deviation(surfaces: StackedSurfaces, u: Floats, v: Floats) -> Floats:
    """(s,) how far every second of the places u, v (s or 1,m,n) is off the chord between those beside it; where a
    surface jumps there is no chord."""
    each, shape = len(u), u.shape[1:]
    points = surfaces.points_of_all(u.reshape(each, -1), v.reshape(each, -1)).reshape(len(surfaces), *shape, 3)
    long = np.nan_to_num(norm(points[:, 1::2] - 0.5 * (points[:, :-1:2] + points[:, 2::2])))
    surface, row, column = far = np.nonzero(long > SAG)
    if len(surface):
        of = surface if each > 1 else np.zeros_like(surface)
        start, end = (np.stack([u[of, k, column], v[of, k, column]], axis=1) for k in (2 * row, 2 * row + 2))
        long[far] *= ~jumps(surfaces.at(surface), start, end)
    return np.asarray(long.max(axis=(1, 2)))


# Parametrised surfaces as sheets.

HALF = 0.1
"""Part of its longest side by which the surface may be off a triangle at the rim of a hole."""


@dataclass(frozen=True, eq=False)
class ParametricSheet(OnParametrised):
    """A parametrised surface, already in the view's coordinates, and its tessellation; jumps: whether it has triangles
    that were left out, because the surface jumps beneath them; holed: whether it has holes; creases: the v at which
    another sheet of the item begins behind a sharp edge; is_cap: whether it is a flat end, without parameter lines;
    trims: the part of the domain that curves leave, if these are all that ends it: then what is beyond them is known,
    as of no hole, and the tessellation goes on a little; of_body: whether it is a face of a body, of which no curve
    pierces another face."""

    surface: Surface
    item: int
    hides: bool
    vertices: Floats
    vertex_places: Floats
    corners: Ints
    deviations: Floats
    jumps: bool
    holed: bool = False
    creases: tuple[float, ...] = ()
    is_cap: bool = False
    trims: ParameterRegions | None = None
    of_body: bool = False

    @cached_property
    def whole(self) -> ParametricSheet:
        """The same on the surface before planes cut it or curves trimmed it: where they do so at a flat angle chords of
        its curves, and ways across these, lead beyond them."""
        surface = uncut(self.surface) if self.trims is None else self.asked
        return self if surface is self.surface else replace(self, surface=surface, trims=None)

    @cached_property
    def asked(self) -> Surface:
        """What is known at places: beyond trims too."""
        return self.surface if self.trims is None else uncut(self.surface)

    def surface_at(self, places: Floats) -> Surface:
        """That, whatever the places."""
        return self.asked

    def trim_at(self, places: Floats) -> Ints:
        """The only one, if there is one."""
        return np.zeros(len(places), dtype=np.intp)


def parametric_sheets(
    surfaces: Sequence[Surface],
    items: Sequence[int],
    hides: Sequence[bool],
    trims: Sequence[ParameterRegions | None] | None = None,
    fewest: int = FEWEST,
) -> list[ParametricSheet]:
    """The sheets of surfaces that are given in the view's coordinates, made together as far as these are alike.

    trims: what is left of whole surfaces; of each what it says itself where None. fewest: cells of tessellations.
    Edge cases: triangles beneath which a surface jumps are left out; those with a corner in a hole end at its rim;
    those that trims cross are whole.
    """
    sheets: dict[int, ParametricSheet] = {}
    trims = [trims_of(surface) for surface in surfaces] if trims is None else trims
    asked = [s if trim is None else uncut(s) for s, trim in zip(surfaces, trims, strict=True)]
    for part in stacks(asked, (fewest + 1) ** 2):
        stack = StackedSurfaces.of([asked[k] for k in part.tolist()])
        columns, rows, deviation = fineness(stack, fewest)
        for own in alike(columns, rows):
            grids = _Grids.of(stack.take(own), int(columns[own[0]]), int(rows[own[0]]), deviation[own])
            for row, number in enumerate(part[own].tolist()):
                sheets[number] = grids.sheet(row, asked[number], items[number], hides[number])
    trimmed = {number: trim for number, trim in enumerate(trims) if trim is not None}
    ended = _trimmed([sheets[number] for number in trimmed], list(trimmed.values()))
    for number, sheet in zip(trimmed, ended, strict=True):
        sheets[number] = replace(sheet, surface=surfaces[number])
    return [sheets[number] for number in range(len(surfaces))]


@dataclass(frozen=True, eq=False)
class _Grids:
    """Grids (s,) of as many points p on as many surfaces.

    places (s or 1,p,3) of the points on the surfaces, the same for all where these have one domain; points (s,p,3);
    corners (t,3) of their triangles; whole (s,t): those beneath which the surface does not jump; deviations (s,t): how
    far they are off it."""

    places: Floats
    points: Floats
    corners: Ints
    whole: Bools
    deviations: Floats

    @classmethod
    def of(cls, surfaces: StackedSurfaces, columns: int, rows: int, deviation: Floats) -> _Grids:
        """Those of so many columns and rows; deviation (s,): how far chords are off the surfaces."""
        u_line, v_line = surfaces.grid_lines(columns, rows)
        u, v = np.broadcast_arrays(u_line[:, :, None], v_line[:, None, :])
        u, v = (t.reshape(len(u_line), -1) for t in (u, v))
        points = surfaces.points_of_all(u, v)
        grids = points.reshape(len(surfaces), columns + 1, rows + 1, 3)
        torn = jumping_cells(surfaces, u_line, v_line, grids)
        off = np.broadcast_to(deviation[:, None, None], torn.shape).copy()
        bent = np.flatnonzero(deviation > SAG)
        if len(bent):
            off[bent] = np.maximum(_cell_deviations(grids[bent]), SAG)
        deviations = np.minimum(off, _around(grids))
        corners = grid_triangles(columns, rows)
        twice = (np.tile(cells.reshape(len(surfaces), -1), 2) for cells in (~torn, deviations))
        return cls(from_components(u, v, 0.0), points, corners, *twice)

    def sheet(self, row: int, surface: Surface, item: int, hides: bool) -> ParametricSheet:
        """That on one of the surfaces. What is the same for all of them is theirs together."""
        points, deviations = self.points[row], self.deviations[row]
        places, whole = self.places[row if len(self.places) > 1 else 0], self.whole[row]
        known: Bools = np.asarray(np.isfinite(points).all(axis=1))
        if known.all() and whole.all():
            return ParametricSheet(surface, item, hides, points, places, self.corners, deviations, False)
        own = np.flatnonzero(whole)
        cut = cut_at_holes(surface, places[:, :2], self.corners[own], known)
        new = cut.places[len(points) :]
        points = np.concatenate([points, surface.points(*np.ascontiguousarray(new.T))])
        deviations = deviations[own[cut.of]]
        # Beside a rim nothing is told by what is beyond.
        at_rim = cut.on_rim[cut.triangles].any(axis=1)
        deviations[at_rim] = np.maximum(deviations[at_rim], HALF * _longest(points[cut.triangles[at_rim]]))
        places = from_components(*cut.places.T, 0.0)
        return ParametricSheet(
            surface, item, hides, points, places, cut.triangles, deviations, not whole.all(), not known.all()
        )


def _trimmed(sheets: Sequence[ParametricSheet], trims: Sequence[ParameterRegions]) -> Iterator[ParametricSheet]:
    """Sheets with those triangles of their tessellations of which a part may be within their trims."""
    if not sheets:
        return
    sizes = np.array([len(sheet.vertex_places) for sheet in sheets])
    places = np.concatenate([sheet.vertex_places for sheet in sheets])
    # All are asked at once: a few places take as long as many.
    inner = ParameterRegions.together(trims).contains(places[:, 0], places[:, 1], ragged.owner(sizes))
    for sheet, trim, first, size in zip(sheets, trims, ragged.starts(sizes).tolist(), sizes.tolist(), strict=True):
        kept = any_component(inner[first : first + size][sheet.corners])
        rest = np.flatnonzero(~kept)
        ends = sheet.vertex_places[sheet.corners[rest], :2]
        kept[rest] = trim.borders_within(*(some(ends, axis=1) for some in (np.min, np.max)))
        used, corners = np.unique(sheet.corners[kept], return_inverse=True)
        yield replace(
            sheet,
            vertices=sheet.vertices[used],
            vertex_places=sheet.vertex_places[used],
            corners=corners.reshape(-1, 3),
            deviations=sheet.deviations[kept],
            trims=trim,
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


def _cell_deviations(points: Floats) -> Floats:
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


# Implicit surfaces as sheets.

FEWEST_IMPLICIT, MOST_IMPLICIT = 48, 192
"""Cells along the longest side of the box on which a surface is polygonised, at least and at most."""

SAG_IMPLICIT = 3e-3
"""Cells are made smaller until most triangles are no further from the sheet than this part of half the scene."""

MOST_OF_ALL = 0.99
"""Which part of the triangles that is: those at singular points stay far off."""


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
    deviations: Floats
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
        return NOISE_OF_GRADIENT * default_gradient(self.surface, self.vertices)

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

    def wings(self, places: Floats, ahead: Floats) -> Floats:
        """(k,3) zero."""
        return np.zeros((len(places), 3))

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

    Errors: as for `polygonized`. Edge cases: F of one sign gives a sheet without triangles.
    """
    placed = placed_in_view(view, surface)
    cells = FEWEST_IMPLICIT
    mesh = polygonized(surface, cells)
    lines = singular_lines(surface, mesh)
    while True:
        own = mesh_with_lines(surface, mesh, lines, cells)
        vertices = np.ascontiguousarray(view.points_of(own.mesh.vertices).T)
        corners = own.mesh.corners.reshape(-1, 3)
        off = _implicit_deviations(placed, vertices[corners])
        if np.quantile(np.append(off, 0.0), MOST_OF_ALL) <= SAG_IMPLICIT or own.doubts or 2 * cells > MOST_IMPLICIT:
            # Those at singular points stay far off; of the others the worst speaks for all.
            deviations = np.maximum(off, min(float(off.max(initial=0.0)), SAG_IMPLICIT))
            return ImplicitSheet(placed, surface, view, item, hides, vertices, corners, deviations, own)
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


def _implicit_deviations(surface: PlacedImplicit, triangles: Floats) -> Floats:
    """(t,) how far the middles of triangles (t,3,3) are off the surface, not more than they are large."""
    middles = triangles.mean(axis=1)
    size = norm(triangles - np.roll(triangles, 1, axis=1)).max(axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        off = np.abs(surface.values(middles)) / np.linalg.norm(surface.gradients(middles), axis=1)
    return np.asarray(np.fmin(off, size))


def _tangential(vectors: Floats, normals: Floats) -> Floats:
    """(k,3) the parts of vectors across unit normals."""
    return np.asarray(vectors - dot(vectors, normals)[:, None] * normals)


# All sheets of a scene, asked at once: those that can be are asked as one.

Rows = Ints | slice
"""Some of the rows of arrays, by their indices, or all of them."""


@dataclass(frozen=True, eq=False)
class SheetGroup:
    """Sheets that are asked as one, and their numbers (g,) among all sheets; stacked: whether the third number of a
    place says which of them it is on."""

    as_one: OnSheet
    numbers: Ints
    stacked: bool


@dataclass(frozen=True, eq=False)
class Sheets:
    """Sheets, asked at places (k,3) by their numbers (k,). Where the number is -1 the answer is NaN, or no.

    counted_as (s,): the numbers of the items they belong to, where these are not those of the scene.
    """

    sheets: tuple[Sheet, ...]
    counted_as: Ints | None = None

    def __len__(self) -> int:
        return len(self.sheets)

    def __iter__(self) -> Iterator[Sheet]:
        return iter(self.sheets)

    def __getitem__(self, number: int) -> Sheet:
        return self.sheets[number]

    @cached_property
    def item(self) -> Ints:
        """(s,) the items they belong to."""
        if self.counted_as is not None:
            return self.counted_as
        return np.array([sheet.item for sheet in self.sheets], dtype=np.intp)

    @cached_property
    def hides(self) -> Bools:
        """(s,) whether they hide what is behind them."""
        return np.array([sheet.hides for sheet in self.sheets], dtype=np.bool_)

    @cached_property
    def of_body(self) -> Bools:
        """(s,) whether they are faces of bodies."""
        own = (isinstance(sheet, ParametricSheet) and sheet.of_body for sheet in self.sheets)
        return np.fromiter(own, dtype=np.bool_, count=len(self.sheets))

    @cached_property
    def groups(self) -> tuple[SheetGroup, ...]:
        """Placed surfaces that are closed in the same directions are asked as one, others each alone."""
        members: dict[object, list[int]] = {}
        for number, sheet in enumerate(self.sheets):
            placed = isinstance(sheet, ParametricSheet) and isinstance(sheet.asked, PlacedSurface)
            members.setdefault(_closed(sheet) if placed else number, []).append(number)
        return tuple(self._group(numbers) for numbers in members.values())

    def _group(self, numbers: Sequence[int]) -> SheetGroup:
        of = np.array(numbers, dtype=np.intp)
        if len(of) == 1:
            return SheetGroup(self.sheets[of[0]], of, False)
        sheets = [sheet for sheet in map(self.__getitem__, numbers) if isinstance(sheet, ParametricSheet)]
        return SheetGroup(StackedSheets.of(sheets), of, True)

    @cached_property
    def group(self) -> Ints:
        """(s+1,) the group of each, and -1 for no sheet."""
        result = np.full(len(self.sheets) + 1, -1)
        for number, group in enumerate(self.groups):
            result[group.numbers] = number
        return result

    @cached_property
    def row(self) -> Ints:
        """(s+1,) which one of its group each is."""
        result = np.zeros(len(self.sheets) + 1, dtype=np.intp)
        for group in self.groups:
            result[group.numbers] = np.arange(len(group.numbers))
        return result

    def places(self, number: Ints, places: Floats) -> Floats:
        """(k,3) the places as the groups take them."""
        result = places.copy()
        stacked = np.array([*(group.stacked for group in self.groups), False])[self.group[number]]
        result[stacked, 2] = self.row[number[stacked]]
        return result

    def points(self, number: Ints, places: Floats) -> Floats:
        """(k,3) points."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.points(at))

    def normals(self, number: Ints, places: Floats) -> Floats:
        """(k,3) unit normals; NaN at singular points."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.normals(at))

    def bends(self, number: Ints, places: Floats, directions: Floats) -> Floats:
        """(k,) how strongly the sheets bend towards their normals along directions (k,3)."""
        result = np.full(len(number), np.nan)
        for sheet, which, at in self._each(number, places):
            result[which] = sheet.bends(at, directions[which])
        return result

    def moved(self, number: Ints, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps (k,3) lead to, to first order."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.moved(at, steps[which]))

    def inwards(self, number: Ints, places: Floats) -> Floats:
        """(k,3) tangents into the sheets at places on their borders; 0 elsewhere."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.inwards(at))

    def turnings(self, number: Ints, places: Floats) -> Floats:
        """(k,3) the direction to which both wings of cuspidal edges turn, at places on them."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.turnings(at))

    def wings(self, number: Ints, places: Floats, ahead: Floats) -> Floats:
        """(k,3) short ways from one wing of cuspidal edges to that on which places ahead (k,3) lie."""
        ahead = self.places(number, ahead)
        return self._vectors(number, places, lambda sheet, which, at: sheet.wings(at, ahead[which]))

    def missed(self, number: Ints, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3): one Newton step for where lines points + t ways meet the sheets: t, and the places there; and
        the points (k,3) of the sheets at the places from which the step is taken."""
        t = np.full(len(number), np.nan)
        met, here = (np.full((len(number), 3), np.nan) for _ in range(2))
        for sheet, which, at in self._each(number, places):
            t[which], met[which], here[which] = sheet.missed(points[which], ways[which], at)
        return t, met, here

    def apart(self, number: Ints, one: Floats, two: Floats) -> Floats:
        """(k,) how far places are from each other as parts of the domains."""
        result = np.full(len(number), np.nan)
        for sheet, which, at in self._each(number, one):
            result[which] = sheet.apart(at, two[which])
        return result

    def on_sheet(self, number: Ints, places: Floats) -> Bools:
        """(k,) whether places lie in the domains."""
        result = np.zeros(len(number), dtype=np.bool_)
        for sheet, which, at in self._each(number, places):
            result[which] = sheet.on_sheet(at)
        return result

    def _vectors(self, number: Ints, places: Floats, ask: Callable[[OnSheet, Rows, Floats], Floats]) -> Floats:
        result = np.full((len(number), 3), np.nan)
        for sheet, which, at in self._each(number, places):
            result[which] = ask(sheet, which, at)
        return result

    def _each(self, number: Ints, places: Floats) -> Iterator[tuple[OnSheet, Rows, Floats]]:
        """Each group that is asked, which rows it is asked for, and the places as it takes them."""
        of = self.group[number]
        counts = np.bincount(of + 1, minlength=1)[1:]
        for one in np.flatnonzero(counts).tolist():
            # Where one group is asked for everything there is nothing to choose.
            which: Rows = slice(None) if counts[one] == len(of) else np.flatnonzero(of == one)
            group, at = self.groups[one], places[which]
            if group.stacked:
                at = from_components(at[:, 0], at[:, 1], self.row[number[which]])
            yield group.as_one, which, at


def _closed(sheet: Sheet) -> object:
    domain = sheet.surface.domain if isinstance(sheet, ParametricSheet) else None
    return None if domain is None else ("closed", domain.closed_u, domain.closed_v)
