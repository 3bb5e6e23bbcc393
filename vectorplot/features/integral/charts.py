"""Coordinates in which curves run over a surface: its parameters, and round its poles others, in which it is smooth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.parametric.poles import poles
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.surface import Domain, Surface, is_parametrised
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import AT_POLE

NEAR, FAR = 0.08, 0.12
"""Parts of the domain: nearer to a pole a curve changes to the coordinates round it, farther it changes back."""

MAIN = -1
"""The chart of the parameters themselves."""

NO_CHARTS = np.zeros(0, dtype=np.intp)


def check_parametrised(surface: object) -> None:
    """Errors: InputError for what has no parameters u and v; meshes have functions of their own."""
    if not is_parametrised(surface):
        raise InputError(f"integral curves: {type(surface).__name__} is no surface with parameters u and v")


@dataclass(frozen=True, eq=False)
class Charts:
    """The charts of a surface. Round a pole that the other parameter closes, a place is known by rho cos(theta) and rho
    sin(theta): rho is the way of a parameter from the pole, theta the other one as an angle.

    domain: of the surface; axis (p,): the parameter that is constant at each pole, 0 or 1; place (p,): its value there;
    inwards (p,): 1 or -1; size (p,): the range of that parameter; start, period (p,): of the other one.
    """

    domain: Domain
    axis: Ints
    place: Floats
    inwards: Floats
    size: Floats
    start: Floats
    period: Floats

    def round_poles(self, chart: Ints) -> Ints:
        """Which of charts (k,) are not the parameters themselves."""
        return (chart != MAIN).nonzero()[0] if len(self.axis) else NO_CHARTS

    def parameters(self, chart: Ints, at: Floats) -> Floats:
        """(k,2) u and v, those round poles of one period only; chart (k,), at (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return at
        result, c, p = at.copy(), chart[near], at[near]
        axis = self.axis[c]
        rho = np.hypot(p[:, 0], p[:, 1])
        turn = arctan2(p[:, 1], p[:, 0]) / (2.0 * np.pi)
        result[near, axis] = self.place[c] + self.inwards[c] * rho
        result[near, 1 - axis] = self.start[c] + self.period[c] * turn
        return result

    def coordinates(self, chart: Ints, places: Floats) -> Floats:
        """(k,2) the coordinates in charts (k,) of u and v (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return places
        result = places.copy()
        rho, theta = self._polar(chart[near], *places[near].T)
        result[near] = from_components(rho * np.cos(theta), rho * np.sin(theta))
        return result

    def rates(self, chart: Ints, u: Floats, v: Floats, du: Floats, dv: Floats) -> Floats:
        """(k,2) how coordinates change where u and v (k,) change by du and dv (k,)."""
        result = from_components(du, dv)
        near = self.round_poles(chart)
        if len(near):
            c = chart[near]
            rho, theta = self._polar(c, u[near], v[near])
            along, turn = self._polar_steps(c, result[near])
            cosine, sine = np.cos(theta), np.sin(theta)
            result[near] = from_components(along * cosine - rho * turn * sine, along * sine + rho * turn * cosine)
        return result

    def steps(self, chart: Ints, u: Floats, v: Floats, rates: Floats) -> Floats:
        """(k,2) how u and v (k,) change where coordinates change by rates (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return rates
        result, c, d = rates.copy(), chart[near], rates[near]
        rho, theta = self._polar(c, u[near], v[near])
        axis, cosine, sine = self.axis[c], np.cos(theta), np.sin(theta)
        result[near, axis] = self.inwards[c] * (d[:, 0] * cosine + d[:, 1] * sine)
        turn = (d[:, 1] * cosine - d[:, 0] * sine) / np.maximum(rho, LEAST_DIVISOR)
        result[near, 1 - axis] = turn * self.period[c] / (2.0 * np.pi)
        return result

    def better(self, chart: Ints, places: Floats) -> Ints:
        """(k,) the charts to go on in from u and v (k,2)."""
        result = chart
        for pole in range(len(self.axis)):
            part = np.abs(places[:, self.axis[pole]] - self.place[pole]) / self.size[pole]
            result = np.where((result == pole) & (part > FAR), MAIN, result)
            result = np.where((result == MAIN) & (part < NEAR), pole, result)
        return np.asarray(result, dtype=np.intp)

    def within(self, places: Floats) -> tuple[Floats, Floats]:
        """u and v (k,) of places (k,2) within the domain, those beyond a border on it."""
        d = self.domain
        return self._between(places, (d.u_start, d.u_end), (d.v_start, d.v_end))

    def inside(self, places: Floats) -> tuple[Floats, Floats]:
        """u and v (k,) within the domain, and beside poles, where the surface has no tangent plane."""
        return self._between(places, *self._beside_poles)

    def beyond(self, places: Floats) -> Floats:
        """(k,) by what part of the domain places (k,2) are beyond the nearest border that a curve cannot cross;
        negative inside."""
        result = np.full(len(places), -np.inf)
        for axis, border, outwards, size in self._walls:
            result = np.maximum(result, outwards * (places[:, axis] - border) / size)
        return result

    def near_to(self, places: Floats, others: Floats) -> Floats:
        """(k,2) the places, in closed directions whole periods away, that are nearest to others (k,2)."""
        result = places.copy()
        for axis, closed in enumerate((self.domain.closed_u, self.domain.closed_v)):
            if closed:
                period = self.domain.size[axis]
                result[:, axis] += period * np.rint((others[:, axis] - places[:, axis]) / period)
        return result

    @cached_property
    def _borders(self) -> tuple[tuple[int, float, float, float], ...]:
        """Where the domain ends that is not closed: the parameter that is constant there, 0 or 1, its value, 1 where it
        grows to the outside or -1, and its range."""
        d = self.domain
        both = ((d.u_start, d.u_end, d.closed_u), (d.v_start, d.v_end, d.closed_v))
        return tuple(
            (axis, border, outwards, high - low)
            for axis, (low, high, closed) in enumerate(both)
            for border, outwards in ((low, -1.0), (high, 1.0))
            if not closed
        )

    @cached_property
    def _walls(self) -> tuple[tuple[int, float, float, float], ...]:
        """Those of the borders that are no poles."""
        own = set(zip(self.axis.tolist(), self.place.tolist(), strict=True))
        return tuple(border for border in self._borders if border[:2] not in own)

    @cached_property
    def _beside_poles(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and of v without what is at poles."""
        d = self.domain
        ends = [[d.u_start, d.u_end], [d.v_start, d.v_end]]
        for axis, place, inwards, size in zip(self.axis, self.place, self.inwards, self.size, strict=True):
            ends[axis][0 if inwards > 0.0 else 1] = float(place + inwards * AT_POLE * size)
        return (ends[0][0], ends[0][1]), (ends[1][0], ends[1][1])

    def _between(self, places: Floats, us: tuple[float, float], vs: tuple[float, float]) -> tuple[Floats, Floats]:
        """u and v (k,) of places (k,2), in closed directions within a period, else between two values."""
        d = self.domain
        u, v = wrapped(d, places[:, 0], places[:, 1])
        u = u if d.closed_u else np.minimum(np.maximum(u, us[0]), us[1])
        v = v if d.closed_v else np.minimum(np.maximum(v, vs[0]), vs[1])
        return u, v

    def _polar(self, chart: Ints, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        across, along = np.where(self.axis[chart] == 0, (u, v), (v, u))
        rho = (across - self.place[chart]) * self.inwards[chart]
        return rho, (along - self.start[chart]) / self.period[chart] * 2.0 * np.pi

    def _polar_steps(self, chart: Ints, steps: Floats) -> tuple[Floats, Floats]:
        row, axis = np.arange(len(chart)), self.axis[chart]
        return steps[row, axis] * self.inwards[chart], steps[row, 1 - axis] / self.period[chart] * 2.0 * np.pi


def charts(surface: Surface) -> Charts:
    """The charts of a surface; a pole that the other parameter does not close round is a border like others."""
    domain = surface.domain
    closed, starts = (domain.closed_u, domain.closed_v), (domain.u_start, domain.v_start)
    found = [pole for pole in poles(surface) if closed[1 - pole.axis]]
    return Charts(
        domain,
        np.array([pole.axis for pole in found], dtype=np.intp),
        np.array([pole.place for pole in found], dtype=np.float64),
        np.array([pole.inwards for pole in found], dtype=np.float64),
        np.array([pole.size for pole in found], dtype=np.float64),
        np.array([starts[1 - pole.axis] for pole in found], dtype=np.float64),
        np.array([domain.size[1 - pole.axis] for pole in found], dtype=np.float64),
    )
