"""Places on parametrised sheets, one sheet or many: what is known there."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.parametric.holes.holes import along_rims, into_surface, is_known
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.vectors import cross, dot, from_components
from vectorplot.surfaces.jets import first_jets
from vectorplot.surfaces.normals import tangent_planes, unit_normals, unit_normals_of
from vectorplot.surfaces.stacked import StackedSurfaces, of_some
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import OFF_RIM, OUTSIDE_DOMAIN
from vectorplot.visibility.smooth.sheets.surface_sheet import solved

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
        u, v = inside(surface.domain, places)
        along_u, along_v = surface.partials(u, v)
        uu, uv, vv = surface.second_partials(u, v)
        # Both partials have one direction: that of a x_u + b x_v = 0, in proportion to the domain.
        width, height = surface.domain.size
        along_u, along_v = along_u * np.asarray(width)[..., None], along_v * np.asarray(height)[..., None]
        long = dot(along_u, along_u) >= dot(along_v, along_v)
        product = dot(along_u, along_v)
        a = np.where(long, -product, dot(along_v, along_v))
        b = np.where(long, dot(along_u, along_u), -product)
        a, b = (a * width)[:, None], (b * height)[:, None]
        return np.asarray(uu * a * a + 2.0 * uv * a * b + vv * b * b)

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
        domain = self.surface_at(places).domain
        within = np.isfinite(places).all(axis=1)
        if not domain.closed_u:
            part = (places[:, 0] - domain.u_start) / domain.size[0]
            within &= (part >= -OUTSIDE_DOMAIN) & (part <= 1.0 + OUTSIDE_DOMAIN)
        if not domain.closed_v:
            part = (places[:, 1] - domain.v_start) / domain.size[1]
            within &= (part >= -OUTSIDE_DOMAIN) & (part <= 1.0 + OUTSIDE_DOMAIN)
        return np.asarray(within)


@dataclass(frozen=True, eq=False)
class StackedSheets(OnParametrised):
    """Many parametrised sheets as one; the third number of a place says on which of them it is."""

    surfaces: StackedSurfaces
    holed: bool = False

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


def _moved(places: Floats, along_u: Floats, along_v: Floats, steps: Floats) -> Floats:
    """(k,3) the places that small steps (k,3) in the planes of the derivatives lead to."""
    step = solved(along_u, along_v, cross(along_u, along_v), steps)
    step[:, 2] = 0.0
    return places + step


def inside(domain: Domain, places: Floats) -> tuple[Floats, Floats]:
    """(k,) u and v of places within the domain: a place beyond an open border is the border's."""
    u, v = wrapped(domain, places[:, 0], places[:, 1])
    if not domain.closed_u:
        u = np.clip(u, domain.u_start, domain.u_end)
    if not domain.closed_v:
        v = np.clip(v, domain.v_start, domain.v_end)
    return u, v
