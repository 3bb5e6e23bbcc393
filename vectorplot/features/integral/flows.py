"""How the state of a point changes that runs over a surface: along a field of directions, or straight on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.integral.charts import Charts
from vectorplot.features.integral.sites import Sites, unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import dot, from_components
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_values import NEIGHBOURS_COUNT

Rates = tuple[Floats, Floats, Sites]
"""Derivatives (k,d) of states, unit tangents (k,3), and where that is."""


class Flow(Protocol):
    """What leads points over a surface. The first two numbers of a state are coordinates in a chart."""

    @property
    def surface(self) -> Surface:
        """Over which it leads."""
        ...

    @property
    def charts(self) -> Charts:
        """Those of the surface."""
        ...

    def states(self, at: Floats, tangents: Floats) -> Floats:
        """(k,d) the states of points at coordinates (k,2) that run along unit tangents (k,3)."""
        ...

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> Rates:
        """Derivatives (k,d) of states by the length of the curve, the unit tangents (k,3) there, and the places; last
        (k,3): the tangents a little before; way (k,): -1 where it leads against the field, else 1."""
        ...


@dataclass(frozen=True, eq=False)
class FieldFlow:
    """Along a field of directions. Where one that has several has none, as at an umbilic, it leads straight on."""

    surface: Surface
    charts: Charts
    field: TangentField

    def states(self, at: Floats, tangents: Floats) -> Floats:
        """The coordinates are all of it."""
        return at

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> Rates:
        """Derivatives, tangents and places."""
        sites = Sites(self.surface, *self.charts.inside(self.charts.parameters(chart, states)))
        found = self.field.tangents(sites)
        if self.field.directed:
            tangents = found[0] * way[:, None]
        else:
            tangents = aligned(found, last)
        if len(found) > 1 and not np.isfinite(tangents).all():
            lost = ~all_finite(tangents) & all_finite(last) & np.isfinite(sites.normals[:, 0])
            tangents[lost] = unit(sites.tangential(last))[lost]
        return self.charts.rates(chart, sites.u, sites.v, *sites.steps(tangents)), tangents, sites


@dataclass(frozen=True, eq=False)
class GeodesicFlow:
    """Straight on: the tangent turns with the tangent plane only. States are coordinates and unit tangents."""

    surface: Surface
    charts: Charts

    def states(self, at: Floats, tangents: Floats) -> Floats:
        """(k,5) coordinates and tangents."""
        return np.concatenate([at, tangents], axis=1)

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> Rates:
        """Derivatives, tangents and places: x'' is along the normal."""
        sites = self.sites(chart, states)
        return self.rates_at(chart, states, sites), states[:, 2:], sites

    def sites(self, chart: Ints, states: Floats) -> Sites:
        """Where points of states (k,d) in charts (k,) are."""
        return Sites(self.surface, *self.charts.inside(self.charts.parameters(chart, states[:, :2])))

    def rates_at(self, chart: Ints, states: Floats, sites: Sites) -> Floats:
        """Derivatives (k,5) of states (k,5) at their sites."""
        # All derivatives of the surface come at once where the second ones are asked for first.
        _, (du, dv) = sites.second_form, sites.steps(states[:, 2:])
        along = self.charts.rates(chart, sites.u, sites.v, du, dv)
        return np.concatenate([along, sites.bends_along(du, dv)[:, None] * sites.normals], axis=1)


@dataclass(frozen=True, eq=False)
class JacobiFlow:
    """Straight on, and how far neighbours that begin at the same place, an angle apart, are aside: states are those of
    geodesics, the distance aside for each unit of angle as part of the size, and its derivative, both times
    NEIGHBOURS_COUNT.

    Source: do Carmo, Differential geometry of curves and surfaces, section 5-5: J'' = -K J.
    """

    surface: Surface
    charts: Charts
    size: float

    def states(self, at: Floats, tangents: Floats) -> Floats:
        """(k,7) coordinates, tangents, no distance aside and its derivative."""
        aside = np.broadcast_to((0.0, NEIGHBOURS_COUNT), (len(at), 2))
        return np.concatenate([at, tangents, aside], axis=1)

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> Rates:
        """Derivatives, tangents and places."""
        straight = GeodesicFlow(self.surface, self.charts)
        sites = straight.sites(chart, states)
        (p, m, q), (e, f, g) = sites.second_form, sites.first_form
        with np.errstate(all="ignore"):
            curvature = (p * q - m * m) / (e * g - f * f)
        aside = from_components(states[:, 6] / self.size, -curvature * self.size * states[:, 5])
        return np.concatenate([straight.rates_at(chart, states[:, :5], sites), aside], axis=1), states[:, 2:5], sites


def aligned(candidates: Floats, last: Floats) -> Floats:
    """(k,3) of the unit tangents (j,k,3) at each place, and their opposites, the one nearest to the last (k,3)."""
    cosines = dot(candidates, last[None])
    cosines[np.isnan(cosines)] = 0.0
    best = np.argmax(np.abs(cosines), axis=0)
    row = np.arange(len(last))
    return np.asarray(candidates[best, row] * np.where(cosines[best, row] < 0.0, -1.0, 1.0)[:, None])
