"""Coordinates in which curves run over a surface: its parameters, and round its poles others, in which it is smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.parametric.poles import poles
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.surface import Domain, Surface, is_parametrised
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import AT_POLE

NEAR, FAR = 0.08, 0.12
"""Parts of the domain: nearer to a pole a curve changes to the coordinates round it, farther it changes back."""

MAIN = -1
"""The chart of the parameters themselves."""


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

    def parameters(self, chart: Ints, at: Floats) -> Floats:
        """(k,2) u and v, those round poles of one period only; chart (k,), at (k,2)."""
        result = at.copy()
        near = np.flatnonzero(chart != MAIN)
        if len(near):
            c, p = chart[near], at[near]
            axis = self.axis[c]
            rho = np.hypot(p[:, 0], p[:, 1])
            turn = np.arctan2(p[:, 1], p[:, 0]) / (2.0 * np.pi)
            result[near, axis] = self.place[c] + self.inwards[c] * rho
            result[near, 1 - axis] = self.start[c] + self.period[c] * turn
        return result

    def coordinates(self, chart: Ints, places: Floats) -> Floats:
        """(k,2) the coordinates in charts (k,) of u and v (k,2)."""
        result = places.copy()
        near = np.flatnonzero(chart != MAIN)
        if len(near):
            c, p = chart[near], places[near]
            rho, theta = self._polar(c, p)
            result[near] = from_components(rho * np.cos(theta), rho * np.sin(theta))
        return result

    def rates(self, chart: Ints, places: Floats, steps: Floats) -> Floats:
        """(k,2) how coordinates change where u and v (k,2) change by steps (k,2)."""
        result = steps.copy()
        near = np.flatnonzero(chart != MAIN)
        if len(near):
            c, p, d = chart[near], places[near], steps[near]
            rho, theta = self._polar(c, p)
            along, turn = self._polar_steps(c, d)
            cosine, sine = np.cos(theta), np.sin(theta)
            result[near] = from_components(along * cosine - rho * turn * sine, along * sine + rho * turn * cosine)
        return result

    def steps(self, chart: Ints, places: Floats, rates: Floats) -> Floats:
        """(k,2) how u and v (k,2) change where coordinates change by rates (k,2)."""
        result = rates.copy()
        near = np.flatnonzero(chart != MAIN)
        if len(near):
            c, p, d = chart[near], places[near], rates[near]
            rho, theta = self._polar(c, p)
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

    def within(self, places: Floats) -> Floats:
        """(k,2) u and v within the domain, those beyond a border on it."""
        return from_components(*self._within(places))

    def inside(self, places: Floats) -> Floats:
        """(k,2) u and v within the domain, and beside poles, where the surface has no tangent plane."""
        u, v = self._within(places)
        for pole in range(len(self.axis)):
            own = u if self.axis[pole] == 0 else v
            if np.abs(own - self.place[pole]).min(initial=np.inf) >= AT_POLE * self.size[pole]:
                continue
            beside = self.place[pole] + self.inwards[pole] * AT_POLE * self.size[pole]
            moved = np.where(np.abs(own - self.place[pole]) < AT_POLE * self.size[pole], beside, own)
            u, v = (moved, v) if self.axis[pole] == 0 else (u, moved)
        return from_components(u, v)

    def beyond(self, places: Floats) -> Floats:
        """(k,) by what part of the domain places (k,2) are beyond the nearest border that a curve cannot cross;
        negative inside."""
        d = self.domain
        own = set(zip(self.axis.tolist(), self.place.tolist(), strict=True))
        result = np.full(len(places), -np.inf)
        for axis, (low, high, closed) in enumerate(
            ((d.u_start, d.u_end, d.closed_u), (d.v_start, d.v_end, d.closed_v))
        ):
            if not closed:
                if (axis, low) not in own:
                    result = np.maximum(result, (low - places[:, axis]) / (high - low))
                if (axis, high) not in own:
                    result = np.maximum(result, (places[:, axis] - high) / (high - low))
        return result

    def near_to(self, places: Floats, others: Floats) -> Floats:
        """(k,2) the places, in closed directions whole periods away, that are nearest to others (k,2)."""
        result = places.copy()
        for axis, closed in enumerate((self.domain.closed_u, self.domain.closed_v)):
            if closed:
                period = self.domain.size[axis]
                result[:, axis] += period * np.rint((others[:, axis] - places[:, axis]) / period)
        return result

    def _within(self, places: Floats) -> tuple[Floats, Floats]:
        d = self.domain
        u, v = wrapped(d, places[:, 0], places[:, 1])
        u = u if d.closed_u else np.minimum(np.maximum(u, d.u_start), d.u_end)
        v = v if d.closed_v else np.minimum(np.maximum(v, d.v_start), d.v_end)
        return u, v

    def _polar(self, chart: Ints, places: Floats) -> tuple[Floats, Floats]:
        row, axis = np.arange(len(chart)), self.axis[chart]
        rho = (places[row, axis] - self.place[chart]) * self.inwards[chart]
        return rho, (places[row, 1 - axis] - self.start[chart]) / self.period[chart] * 2.0 * np.pi

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
