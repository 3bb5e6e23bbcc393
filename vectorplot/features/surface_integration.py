"""Steps of differential equations by the method of Dormand and Prince, many at once, and what is between their ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent, no_curves
from vectorplot.features.scalar_fields import bracketed_zeros
from vectorplot.features.surface_points import Charts, Sites, charts, check_parametrised, unit
from vectorplot.features.tangent_fields import TangentField
from vectorplot.geometry import ragged, records
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Image, Traces, refined, straight_between
from vectorplot.geometry.elementary import power
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_finite, dot, from_components, norm
from vectorplot.surfaces.function_surface import with_derivatives
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances import (
    CHORD_OF_EXTENT,
    CLOSED_OF_EXTENT,
    INTEGRATED_OF_EXTENT,
    LEAST_DIVISOR,
    NEIGHBOURS_COUNT,
    ROUNDING_OF_POINTS,
    STALLED_OF_EXTENT,
    ZERO_OF_EXTENT,
)

STAGES = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
"""What the rates at earlier stages count at each later one; the last row gives the step of order 5."""

ERRORS = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
"""The step less that of order 4."""

BETWEEN = (
    -12715105075 / 11282082432,
    0.0,
    87487479700 / 32700410799,
    -10690763975 / 1880347072,
    701980252875 / 199316789632,
    -1453857185 / 822651844,
    69997945 / 29380423,
)
"""The part of order 4 of the way between the ends of a step."""

ORDER = 5

Rates = Callable[[Floats], Floats]
"""Takes states (k,d) to their derivatives (k,d)."""


@dataclass(frozen=True, eq=False)
class Steps(Elements):
    """Steps from states start (k,d) by move (k,d); error (k,d): difference from the step of one order less; rates
    (2,k,d): at both ends, times the step's length; bend (k,d): the rest of the dense output.
    Source: Dormand and Prince (1980); Hairer, Norsett and Wanner, Solving ordinary differential equations I, section
    II.6.
    """

    start: Floats
    move: Floats
    error: Floats
    first: Floats
    last: Floats
    bend: Floats

    def at(self, part: Floats) -> Floats:
        """(k,d) the states at parts (k,) of the steps."""
        x = part[:, None]
        y = 1.0 - x
        rise = self.first - self.move
        return np.asarray(
            self.start + x * (self.move + y * (rise + x * (self.move - self.last - rise + y * self.bend)))
        )

    def slopes(self, part: Floats) -> Floats:
        """(k,d) the derivatives there of the states by the part."""
        x = part[:, None]
        y = 1.0 - x
        rise = self.first - self.move
        bent = self.move - self.last - rise
        between = rise + x * (bent + y * self.bend)
        way = self.move + y * between
        return np.asarray(way + x * (y * (bent + (y - x) * self.bend) - between))


def steps(rates: Rates, start: Floats, first: Floats, length: Floats) -> Steps:
    """Steps of lengths (k,) from states start (k,d) with derivatives first (k,d) there."""
    h = length[:, None]
    found, move = [h * first], start
    for row in STAGES:
        move = _sum(row, found)
        found.append(h * rates(start + move))
    return Steps(start, move, _sum(ERRORS, found), found[0], found[-1], _sum(BETWEEN, found))


def _sum(weights: tuple[float, ...], parts: list[Floats]) -> Floats:
    total = weights[0] * parts[0]
    for weight, part in zip(weights[1:], parts[1:], strict=False):
        if weight:
            total = total + weight * part
    return total


# How the state of a point changes that runs over a surface: along a field of directions, or straight on.

StateRates = tuple[Floats, Floats, Sites]
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

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> StateRates:
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

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> StateRates:
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

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> StateRates:
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

    def rates(self, chart: Ints, states: Floats, last: Floats, way: Floats) -> StateRates:
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


# The ways of points that were led over a surface: step by step, and all that is between.

PARTS = 8
"""Of a step round a pole, in each of which it goes round less than half."""


def running_on(
    charts: Charts, chart: Ints, steps: Steps, states: Floats, before: Floats, part: Floats | float = 1.0
) -> Floats:
    """(k,2) u and v of states (k,d) at parts (k,) of steps in charts (k,), running on over seams, and round poles, from
    where the steps begin, before (k,2)."""
    result = charts.near_to(charts.parameters(chart, states[:, :2]), before)
    around = charts.round_poles(chart)
    if len(around):
        # Round a pole, u may run through more than a half of its period within one step.
        to, last, every = np.broadcast_to(part, len(chart))[around], before[around], np.tile(around, PARTS)
        shares = np.linspace(0.0, 1.0, PARTS + 1)[1:, None] * to
        stops = charts.parameters(chart[every], steps.take(every).at(shares.ravel())[:, :2])
        for stop in stops.reshape(PARTS, -1, 2):
            last = charts.near_to(stop, last)
        result[around] = last
    return result


@dataclass(frozen=True, eq=False)
class IntegrationSteps:
    """Steps of points over a surface: row (s,): which point each leads; chart (s,); part (s,): how much of the step
    counts; length (s,): of that; before (s,2): u and v where it begins, running on over seams."""

    row: Ints
    chart: Ints
    part: Floats
    length: Floats
    before: Floats


@dataclass(frozen=True, eq=False)
class Courses:
    """The ways of points over a surface, those of each point in the order in which they follow each other.

    strides, steps (s,): integration steps and what is between their ends; offsets (m+1,): point i has the steps
    offsets[i] to offsets[i+1]; closed (m,): whether it came back to its start; stalled, spent (m,): whether it ended
    where no step succeeds, or for want of steps.
    """

    flow: Flow
    strides: IntegrationSteps
    steps: Steps
    offsets: Ints
    closed: Bools
    stalled: Bools
    spent: Bools

    def states(self, step: Ints, part: Floats) -> Floats:
        """(k,d) the states at parts (k,) of what counts of steps (k,)."""
        return self.steps.take(step).at(part * self.strides.part[step])

    def places(self, step: Ints, part: Floats) -> Floats:
        """(k,2) u and v there, running on over seams."""
        strides, steps = self.strides, self.steps.take(step)
        to = part * strides.part[step]
        return running_on(self.flow.charts, strides.chart[step], steps, steps.at(to), strides.before[step], to)

    def points(self, step: Ints, part: Floats) -> Floats:
        """(k,3) points there."""
        charts = self.flow.charts
        found = charts.parameters(self.strides.chart[step], self.states(step, part)[:, :2])
        return self.flow.surface.points(*charts.within(found))

    def directions(self, step: Ints, part: Floats) -> Floats:
        """(k,2) how u and v grow there by the length of the ways: as the flow leads at these places, and not only as
        what is between the ends of steps does; NaN at poles."""
        charts, chart, to = (
            self.flow.charts,
            self.strides.chart[step],
            part * self.strides.part[step],
        )
        steps = self.steps.take(step)
        states = steps.at(to)
        u, v = charts.inside(charts.parameters(chart, states[:, :2]))
        nearly = charts.steps(chart, u, v, steps.slopes(to)[:, :2])
        along_u, along_v = self.flow.surface.partials(u, v)
        last = nearly[:, :1] * along_u + nearly[:, 1:] * along_v
        with np.errstate(all="ignore"):
            long = norm(last)[:, None]
            rates, tangents, _ = self.flow.rates(chart, states, last / long, np.ones(len(step)))
            found = charts.steps(chart, u, v, rates[:, :2])
            # Fields with a direction lead the way that they were followed.
            found = np.where(dot(tangents, last)[:, None] < 0.0, -found, found)
            known = np.isfinite(found).all(axis=1, keepdims=True)
            found = np.where(known, found, nearly / long)
        return np.where(np.isfinite(found).all(axis=1, keepdims=True), found, np.nan)

    @cached_property
    def ends(self) -> Floats:
        """(s,) how long each way is up to the end of each step."""
        total = np.cumsum(self.strides.length)
        before = np.concatenate([[0.0], total])[self.offsets[:-1]]
        return np.asarray(total - np.repeat(before, np.diff(self.offsets)))

    @cached_property
    def lengths(self) -> Floats:
        """(m,) how long each way is; 0 of those without a step."""
        some = self.offsets[1:] > self.offsets[:-1]
        return np.where(some, np.append(self.ends, 0.0)[self.offsets[1:] - 1], 0.0)

    def at(self, row: Ints, along: Floats) -> tuple[Ints, Floats]:
        """The steps, and the parts of them (k,), at lengths (k,) along the ways of points (k,) that have steps."""
        # The ways one after the other, each as long as the longest one: one ascending row of numbers.
        long = self.lengths.max(initial=0.0)
        every = self.ends + long * self.strides.row
        step = np.searchsorted(every, along + long * row)
        step = np.clip(step, self.offsets[row], self.offsets[row + 1] - 1)
        length = self.strides.length[step]
        with np.errstate(all="ignore"):
            part = (along - self.ends[step] + length) / length
        return step, np.clip(np.nan_to_num(part), 0.0, 1.0)

    @classmethod
    def joined(cls, parts: Sequence[Courses]) -> Courses:
        """The ways of all points of at least one, which one flow led."""
        sizes, closed, stalled, spent = (
            np.concatenate(each)
            for each in zip(*((np.diff(p.offsets), p.closed, p.stalled, p.spent) for p in parts), strict=True)
        )
        strides = replace(records.joined([part.strides for part in parts]), row=ragged.owner(sizes))
        steps = records.joined([part.steps for part in parts])
        return cls(parts[0].flow, strides, steps, ragged.offsets(sizes), closed, stalled, spent)

    def take(self, rows: Ints) -> Courses:
        """The ways of some of the points."""
        which, offsets = ragged.take(self.offsets, rows)
        strides = replace(records.take(self.strides, which), row=ragged.owner(np.diff(offsets)))
        return Courses(
            self.flow,
            strides,
            self.steps.take(which),
            offsets,
            self.closed[rows],
            self.stalled[rows],
            self.spent[rows],
        )

    def up_to(self, lengths: Floats) -> Courses:
        """The ways up to lengths (m,) along them; those that are cut are not closed."""
        begins = self.ends - self.strides.length
        left = np.repeat(lengths, np.diff(self.offsets)) - begins
        kept = np.flatnonzero(left > 0.0)
        strides = records.take(self.strides, kept)
        length = np.minimum(strides.length, left[kept])
        with np.errstate(all="ignore"):
            part = strides.part * np.where(strides.length > 0.0, length / strides.length, 1.0)
        counts = np.bincount(strides.row, minlength=len(lengths))
        cut = lengths < self.lengths
        return Courses(
            self.flow,
            replace(strides, part=part, length=length),
            self.steps.take(kept),
            ragged.offsets(counts),
            self.closed & ~cut,
            self.stalled & ~cut,
            self.spent & ~cut,
        )


# Points led over a surface by a flow, many at once, each with steps of its own.

LONGEST = 1.0 / 6.0
"""Part of the extent that one step may lead."""

FIRST = 1.0 / 64.0
"""Part of the extent that the first step tries to lead."""

CAUTION, SHRINK, GROW = 0.9, 0.2, 4.0
"""Part of the step that would just do which the next one is, and by what it may differ from the last at most."""

TURN = 0.5
"""Cosine of the angle by which a tangent may turn in one step."""

AWAY = 3.0
"""Steps after which a curve may have come back to its start, at least."""

WOUND = 8.0
"""Times the distance from a place within which a curve may not wind that it is long there, at most: more than that on
one sheet is nearer to itself than half the distance."""

CLOSED_OF_ERROR = 10.0
"""Times the error that curves are integrated with that one may miss its start by and is closed, at least."""

MOST_STEPS = 5_000
"""Steps of one curve at most."""


@dataclass(frozen=True)
class Accuracy:
    """How well curves are integrated.

    Parameters
    ----------
    error : float
        Part of the extent of the surface that the estimated errors of the steps of a curve, as long as the extent, add
        up to. Where neighbouring curves run apart, or together, errors grow, or shrink, with their distance.
    steps : int
        That one curve may have.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> rough, fine = features.Accuracy(1e-4), features.Accuracy(1e-7)
    >>> ball, field = surfaces.Sphere(), features.loxodromes(1.0)
    >>> runs = [features.integral_curves(ball, field, [(0, 0)], length=1.5, accuracy=each) for each in (rough, fine)]
    >>> ends = [run.points[-1] for run in runs]
    >>> bool(np.allclose(*ends, atol=1e-3))
    True
    """

    error: float = INTEGRATED_OF_EXTENT
    steps: int = MOST_STEPS


USUAL = Accuracy()


@dataclass(frozen=True, eq=False)
class Until:
    """Where curves end that need not go on: beside says of u and v (k,2), after a step there, whether they do (k,);
    tight: a distance within which of some place they may not wind round and round."""

    beside: Callable[[Floats], Bools] | None = None
    tight: float = 0.0


NOTHING_NEAR = Until()


@dataclass(frozen=True, eq=False)
class _Points:
    """Points on their way: which (k,), chart (k,), states (k,d), their derivatives (k,d), tangents (k,3), places (k,2)
    running on, points (k,3), the next steps (k,), how long they are still to run (k,), and steps done (k,); anchor
    (k,3): the point near which they have wound for a length (k,)."""

    which: Ints
    chart: Ints
    states: Floats
    rates: Floats
    tangents: Floats
    places: Floats
    points: Floats
    step: Floats
    left: Floats
    done: Floats
    anchor: Floats
    wound: Floats


def traces(
    flow: Flow,
    starts: Floats,
    tangents: Floats,
    way: Floats,
    lengths: Floats,
    size: float,
    large: float,
    accuracy: Accuracy = USUAL,
    until: Until = NOTHING_NEAR,
) -> Courses:
    """The traces of points from u, v (m,2) along unit tangents (m,3), up to lengths (m,); way (m,): -1 against the
    field; size, large: the extent and the largest coordinate. They end at borders, where they close, where no step
    succeeds, and by until.
    Source: Glaeser, section 9.4; errata G9-13 and G9-14: steps follow their error, and a curve closes only after it has
    been away.
    """
    charts = flow.charts
    shortest = max(STALLED_OF_EXTENT, accuracy.error) * size
    count = len(starts)
    closed, stalled, spent = (np.zeros(count, dtype=np.bool_) for _ in range(3))
    home = flow.surface.points(*charts.inside(starts))
    chart = charts.better(np.full(count, -1), starts)
    states = flow.states(charts.coordinates(chart, starts), tangents)
    now = _Points(
        np.arange(count),
        chart,
        states,
        flow.rates(chart, states, tangents, way)[0],
        tangents,
        starts,
        home,
        np.full(count, FIRST * size),
        lengths.astype(np.float64),
        np.zeros(count),
        home,
        np.zeros(count),
    )
    new, there = tangents, Sites(flow.surface, starts[:0, 0], starts[:0, 1])

    def rates(states: Floats) -> Floats:
        nonlocal new, there
        found, new, there = flow.rates(now.chart, states, now.tangents, way[now.which])
        return found

    strides: list[IntegrationSteps] = []
    found: list[Steps] = []
    now = records.take(now, all_finite(now.rates) & (now.left > 0.0))
    while len(now.which):
        step = np.minimum(now.step, now.left)
        with np.errstate(all="ignore"):
            # The last stage is the end of the step: its derivatives, tangents and places are those to go on with.
            tried = steps(rates, now.states, now.rates, step)
            end, ahead, points = tried.start + tried.move, tried.last / step[:, None], there.points
            off = _length_of(charts, now.chart, there, tried.error, size)
            allowed = accuracy.error * step + ROUNDING_OF_POINTS * large
            good = all_finite(ahead) & (off <= allowed) & (dot(new, now.tangents) > TURN)
            factor = CAUTION * power(allowed / np.maximum(off, LEAST_DIVISOR), 1.0 / ORDER)
            factor = np.minimum(np.maximum(factor, SHRINK), GROW)
            places = running_on(charts, now.chart, tried, end, now.places)
            out = good & (charts.beyond(places) > 0.0)
            gone = norm(points - now.anchor) > until.tight
        factor = np.where(good, factor, np.where(np.isfinite(off), np.minimum(factor, 0.5), SHRINK))
        following = np.minimum(factor * step, LONGEST * size)

        part = np.ones(len(step))
        if out.any():
            part[out] = _crossing(flow, now.chart[out], records.take(tried, out))
        back, share = _back(flow, now, good, tried, part, points, home, tangents, size, accuracy.error)
        part[back] = share
        closed[now.which[back]] = True
        length = step * part
        stride = IntegrationSteps(now.which, now.chart, part, length, now.places)
        strides.append(_those(stride, good))
        found.append(_those(tried, good))

        finished = out
        finished[back] = True
        if until.beside is not None:
            finished[good] |= until.beside(places[good])
        wound = np.where(gone, 0.0, now.wound + length)
        left = now.left - length
        finished |= good & ((wound > WOUND * until.tight) | (left <= ROUNDING_OF_POINTS * size))
        stuck = ~finished & (np.where(good, step, following) < shortest)
        stalled[now.which[stuck]] = True
        used = now.done + 1.0
        worn = ~finished & ~stuck & (used >= accuracy.steps)
        spent[now.which[worn]] = True
        anchor = np.where(gone[:, None], points, now.anchor)
        ends = _Points(now.which, now.chart, end, ahead, new, places, points, following, left, used, anchor, wound)
        if not good.all():
            ends = _either(good, ends, replace(now, step=following, done=used))
        now = _renewed(flow, _those(ends, ~(finished | stuck | worn)), way)
    order, offsets = np.zeros(0, dtype=np.intp), np.zeros(count + 1, dtype=np.intp)
    if not strides:
        none = IntegrationSteps(order, order, np.zeros(0), np.zeros(0), np.zeros((0, 2)))
        empty = states[:0]
        return Courses(flow, none, Steps(*[empty] * 6), offsets, closed, stalled, spent)
    every = records.joined(strides)
    order = np.argsort(every.row, kind="stable")
    offsets = ragged.offsets(np.bincount(every.row, minlength=count))
    return Courses(flow, records.take(every, order), records.joined(found).take(order), offsets, closed, stalled, spent)


R = TypeVar("R", bound=records.Record)


def _those(record: R, which: Bools) -> R:
    """Those of the elements where which (k,) is true: mostly all of them."""
    return record if which.all() else records.take(record, which)


def _either(which: Bools, one: _Points, two: _Points) -> _Points:
    """Points as one says where which (k,) is true, and as two says where it is not."""
    pairs = ((getattr(one, f.name), getattr(two, f.name)) for f in fields(_Points))
    return _Points(*(np.where(which if a.ndim == 1 else which[:, None], a, b) for a, b in pairs))


def _length_of(charts: Charts, chart: Ints, sites: Sites, error: Floats, size: float) -> Floats:
    """(k,) how long errors (k,d) of states at places are in space; what tangents are off counts over the extent."""
    moved = charts.steps(chart, sites.u, sites.v, error[:, :2])
    along_u, along_v, _ = sites.planes
    away = moved[:, :1] * along_u + moved[:, 1:] * along_v
    return np.asarray(np.sqrt(dot(away, away) + size * size * (error[:, 2:] ** 2).sum(axis=1)))


def _first(done: Steps, what: Callable[[Floats, Ints], Floats], last: Floats, small: float) -> Floats:
    """(k,) the parts of steps up to which what (k,) of their states is not positive: less than small there, and last
    (k,) at their ends. what(states, which): of some of the steps."""
    count = len(done.start)
    first = np.minimum(what(done.start, np.arange(count)), -LEAST_DIVISOR)

    def values(part: Floats, which: Ints) -> Floats:
        return what(done.take(which).at(part), which)

    with np.errstate(all="ignore"):
        guess = first / (first - last)
    found, _ = bracketed_zeros(values, first, last, guess, np.full(count, small))
    return np.asarray(found)


def _crossing(flow: Flow, chart: Ints, done: Steps) -> Floats:
    """(k,) the parts of steps in charts (k,) at which they leave the surface."""

    def beyond(states: Floats, which: Ints) -> Floats:
        return flow.charts.beyond(flow.charts.parameters(chart[which], states[:, :2]))

    ends = beyond(done.start + done.move, np.arange(len(chart)))
    return _first(done, beyond, ends, ROUNDING_OF_POINTS)


def _back(
    flow: Flow,
    now: _Points,
    good: Bools,
    done: Steps,
    part: Floats,
    here: Floats,
    home: Floats,
    tangents: Floats,
    size: float,
    error: float,
) -> tuple[Ints, Floats]:
    """Which of the good steps (k,) of points lead back to their starts, which are at home (m,3) with tangents (m,3),
    before a part (k,) of them; and where. here (k,3): the ends of the steps."""
    start, along = home[now.which], tangents[now.which]
    before, after = (np.asarray(dot(points - start, along)) for points in (now.points, here))
    rows = np.flatnonzero(good & (before < 0.0) & (after >= 0.0) & (now.done >= AWAY))
    if len(rows):
        one, two = (norm(points[rows] - start[rows]) for points in (now.points, here))
        rows = rows[np.minimum(one, two) <= 2.0 * norm(here[rows] - now.points[rows])]
    if not len(rows):
        return rows, np.zeros(0)
    chart, start, along = now.chart[rows], start[rows], along[rows]

    def way(states: Floats, some: Ints) -> Floats:
        places = flow.charts.parameters(chart[some], states[:, :2])
        return flow.surface.points(*flow.charts.inside(places)) - start[some]

    def ahead(states: Floats, some: Ints) -> Floats:
        return np.asarray(dot(way(states, some), along[some]))

    some = done.take(rows)
    there = _first(some, ahead, after[rows], ROUNDING_OF_POINTS * size)
    near = norm(way(some.at(there), np.arange(len(rows)))) <= max(CLOSED_OF_EXTENT, CLOSED_OF_ERROR * error) * size
    near &= there <= part[rows]
    return rows[near], there[near]


def _renewed(flow: Flow, now: _Points, way: Floats) -> _Points:
    """Points in the charts that do better where they are, with states and derivatives in these."""
    chart = flow.charts.better(now.chart, now.places)
    changed = np.flatnonzero(chart != now.chart)
    if not len(changed):
        return now
    states, rates, own = now.states.copy(), now.rates.copy(), chart[changed]
    at = flow.charts.coordinates(own, now.places[changed])
    states[changed] = np.concatenate([at, states[changed, 2:]], axis=1)
    rates[changed] = flow.rates(own, states[changed], now.tangents[changed], way[now.which[changed]])[0]
    return replace(now, chart=chart, states=states, rates=rates)


# Integral curves of fields of directions on a surface, and geodesics, from given points.

DEFAULT = Tracing()

DEFAULT_LENGTH = 10.0
"""Times the extent of its surface that a curve is long at most where nothing else is said, to each side."""

ROUNDS = 12
"""How often ways that are straight in the parameters are halved until they are near their curves."""


def integral_curves(
    surface: Surface,
    field: TangentField,
    starts: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = True,
    accuracy: Accuracy = USUAL,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """The curves of a surface that follow a field of directions, one through each of given points.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    field : TangentField
        What they follow, such as `loxodromes`, `SteepestSlope`, `ConstantElevation`, `PrincipalDirections`,
        `AsymptoticDirections`, `VectorField`.
    starts : (k, 2) array_like of float
        Parameters u, v; or one pair.
    length : float, optional
        How far they run from the start to each side at most, in world units; ten times the extent of the surface where
        None.
    both_ways : bool
        Whether they run against the field as well.
    accuracy : Accuracy
        How well they are integrated.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines along the field, with the number of the start as level. Every point is one of the integrated curve.

    Raises
    ------
    InputError
        For a shape without parameters, starts that are not finite pairs within the domain, a length that is not
        positive.

    Notes
    -----
    All curves are integrated at once. They go on over seams and through poles, and end at the borders of the surface,
    where they come back to their start (and are closed), at critical points, where the direction is no longer real, in
    holes, and where they are as long as they may be. Edge cases: no curve from where the field has no direction.

    Source: Glaeser, section 9.4, equations 18 and 19; errata G9-13 to G9-15.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball, east = surfaces.Sphere(), features.loxodromes(-np.pi / 2)
    >>> parallels = features.integral_curves(ball, east, [(0.0, 0.0), (0.0, 1.0)])
    >>> parallels.closed.tolist(), bool(np.allclose(parallels[1][:, 2], np.sin(1.0)))
    ([True, True], True)
    """
    at = starts_of(surface, starts)
    surface = with_derivatives(surface)
    flow = FieldFlow(surface, charts(surface), field)
    found = field.tangents(Sites(surface, *flow.charts.inside(at)))[0]
    return curves_from(flow, at, found, length, both_ways, accuracy, tracing)


def geodesics(
    surface: Surface,
    starts: ArrayLike,
    angles: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = False,
    accuracy: Accuracy = USUAL,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """The geodesics of a surface from given points in given directions: curves that never turn to a side.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    starts : (k, 2) array_like of float
        Parameters u, v; or one pair.
    angles : (k,) array_like of float
        In radians, counter-clockwise about the normals from the direction in which u grows; or one for all.
    length : float, optional
        How far they run at most, in world units; ten times the extent of the surface where None.
    both_ways : bool
        Whether they run backwards from the start as well.
    accuracy : Accuracy
        How well they are integrated.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines with the number of the start as level.

    Raises
    ------
    InputError
        See `integral_curves`; for angles that are not finite.

    Notes
    -----
    Edge cases: none from a pole or a singular point.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.geodesics(surfaces.Sphere(), (0.3, 0.2), np.radians(70))
    >>> curves.closed.tolist(), round(float(np.linalg.norm(np.diff(curves[0], axis=0), axis=1).sum()), 1)
    ([True], 6.3)
    """
    at = starts_of(surface, starts)
    surface = with_derivatives(surface)
    turn = np.broadcast_to(np.asarray(angles, dtype=np.float64), len(at))
    if not np.isfinite(turn).all():
        raise InputError("geodesics: angles must be finite numbers")
    sites = Sites(surface, *at.T)
    first = unit(sites.planes[0])
    left = sites.turned(first, 0.5 * np.pi)
    tangents = np.cos(turn)[:, None] * first + np.sin(turn)[:, None] * left
    return curves_from(GeodesicFlow(surface, charts(surface)), at, tangents, length, both_ways, accuracy, tracing)


def curves_from(
    flow: Flow,
    starts: Floats,
    tangents: Floats,
    length: float | None,
    both_ways: bool,
    accuracy: Accuracy,
    tracing: Tracing,
) -> SurfaceCurves:
    """The curves of a flow from u and v (k,2) along tangents (k,3); what else is said as in integral_curves."""
    size, large = extent(flow.surface)
    if size == 0.0 or not len(starts):
        return no_curves()
    longest = DEFAULT_LENGTH * size if length is None else positive("integral curves: length", length)
    sides = 2 if both_ways else 1
    return drawn(traces_from(flow, starts, tangents, longest, sides, (size, large), accuracy), sides, size, tracing)


def traces_from(
    flow: Flow,
    starts: Floats,
    tangents: Floats,
    longest: float | Floats,
    sides: int,
    extent_: tuple[float, float],
    accuracy: Accuracy,
    until: Until = NOTHING_NEAR,
) -> Courses:
    """The traces of a flow from u and v (k,2) along tangents (k,3), and, where there are two sides, as many more the
    other way. extent_: of the surface; until: see traces."""
    way = np.repeat([1.0, -1.0][:sides], len(starts))
    return traces(
        flow,
        np.tile(starts, (sides, 1)),
        np.tile(tangents, (sides, 1)) * way[:, None],
        way,
        np.tile(np.broadcast_to(longest, len(starts)), sides),
        *extent_,
        accuracy,
        until,
    )


def starts_of(surface: Surface, starts: ArrayLike, what: str = "integral curves: start") -> Floats:
    """(k,2) the parameters that curves are to begin with. Errors: InputError as in `integral_curves`."""
    check_parametrised(surface)
    at = np.atleast_2d(np.asarray(starts, dtype=np.float64))
    d = surface.domain
    if at.size == 0:
        return np.zeros((0, 2))
    if at.ndim != 2 or at.shape[1] != 2 or not np.isfinite(at).all():
        raise InputError("integral curves: starts must be pairs of finite parameters")
    for axis, (name, low, high, closed) in enumerate(
        (("u", d.u_start, d.u_end, d.closed_u), ("v", d.v_start, d.v_end, d.closed_v))
    ):
        slack = ZERO_OF_EXTENT * (high - low)
        bad = (at[:, axis] < low - slack) | (at[:, axis] > high + slack)
        if not closed and bad.any():
            value = at[np.argmax(bad), axis]
            raise InputError(f"{what} {name} = {value:g}, expected {low:g} to {high:g}")
    return at


def drawn(found: Courses, sides: int, size: float, tracing: Tracing) -> SurfaceCurves:
    """The curves as polylines, both ways joined, with as many points as the tolerance asks for."""
    counts = np.diff(found.offsets)
    starts = len(counts) // sides
    runs = counts > 0
    if sides == 2:
        # A closed curve needs no way back.
        runs[starts:] &= ~found.closed[:starts]
    rows = np.flatnonzero(runs)
    if not len(rows):
        return no_curves()
    step, part, offsets, enough = _fine(found, rows, size, tracing)
    places, turns = _shut(found, rows, step, part, offsets)
    # From the end of the way back over the start to the end of the way there. The start counts once, and so does the
    # last point of a closed curve, which is its first.
    counts = np.diff(offsets)
    row, position = np.repeat(rows, counts), ragged.place(counts)
    back = row >= starts
    kept = ~(back & (position == 0) & np.isin(row - starts, rows))
    kept[offsets[1:][found.closed[rows]] - 1] = False
    order = np.flatnonzero(kept)
    order = order[np.lexsort((np.where(back, -position, position)[order], row[order] % starts))]
    curve, first = np.unique(row[order] % starts, return_index=True)
    shut, own = np.zeros(len(curve), dtype=np.bool_), np.zeros((len(curve), 2), dtype=np.intp)
    goes_round = np.searchsorted(curve, rows[found.closed[rows]] % starts)
    shut[goes_round], own[goes_round] = True, turns
    u, v = np.ascontiguousarray(places[order].T)
    directions = found.directions(step[order], part[order]) * np.where(back[order], -1.0, 1.0)[:, None]
    points = found.flow.surface.points(*found.flow.charts.within(places[order]))
    doubts = [unresolved("an integral curve is off by more than the tolerance")] * (not enough)
    doubts += ["an integral curve ends for want of steps"] * bool(found.spent[rows].any())
    none = np.zeros((0, 2))
    bounds = np.append(first, len(order)).astype(np.intp)
    levels = curve.astype(np.float64)
    return SurfaceCurves(
        u, v, points, bounds, shut, own, levels, none, none, none, tuple(doubts), directions=directions
    )


def _shut(found: Courses, rows: Ints, step: Ints, part: Floats, offsets: Ints) -> tuple[Floats, Ints]:
    """u and v (p,2) at parts (p,) of steps (p,), those of closed curves moved a little so that they end where they
    begin, and the periods (c,2) that the closed ones of the rows have run through."""
    places = found.places(step, part)
    which = np.flatnonzero(found.closed[rows])
    first, last = places[offsets[which]], places[offsets[which + 1] - 1]
    domain = found.flow.charts.domain
    turns = np.rint((last - first) / domain.size) * (domain.closed_u, domain.closed_v)
    gap = last - first - turns * domain.size
    sizes = offsets[which + 1] - offsets[which]
    at = ragged.ranges(offsets[which], sizes)
    share = ragged.place(sizes) / np.repeat(np.maximum(sizes - 1, 1), sizes)
    places[at] -= share[:, None] * np.repeat(gap, sizes, axis=0)
    return places, turns.astype(np.intp)


def _fine(found: Courses, rows: Ints, size: float, tracing: Tracing) -> tuple[Ints, Floats, Ints, bool]:
    """Steps and parts of them (p,) of the points of polylines, offsets (r+1,) of these, one for each row; and whether
    the budget's points sufficed."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance
    steps, own = ragged.take(found.offsets, rows)
    counts = np.diff(own)
    # A point is known by its step and the part of it in one number; the last one of a curve ends its last step.
    first = ragged.ranges(own[:-1] + np.arange(len(rows)), counts + 1)
    last = np.zeros(len(first), dtype=np.bool_)
    last[np.cumsum(counts + 1) - 1] = True
    to_step = np.zeros(len(first), dtype=np.intp)
    to_step[~last] = steps
    to_step[last] = steps[own[1:] - 1]

    def split(t: Floats) -> tuple[Ints, Floats]:
        node = np.minimum(np.floor(t).astype(np.intp), len(first) - 1)
        return to_step[node], np.where(last[node], 1.0, t - node)

    def image(t: Floats) -> Floats:
        points = found.points(*split(t[:, 0]))
        return points if tracing.picture is None else tracing.picture(points)

    if not tolerance > 0.0:
        tolerance = np.inf
    most = tracing.budget.points * max(1.0, len(rows) / 16.0)
    done = refined(Traces(first[:, None].astype(np.float64), last), straight_between, image, tolerance, most)
    lines, near = _near_parameters(found, split, image, done.lines, tolerance, most, tracing)
    step, part = split(lines.points[:, 0])
    return step, part, np.concatenate([[0], lines.ends + 1]), bool(done.enough.all() and near)


def _near_parameters(
    found: Courses,
    split: Callable[[Floats], tuple[Ints, Floats]],
    image: Image,
    lines: Traces,
    tolerance: float,
    most: float,
    tracing: Tracing,
) -> tuple[Traces, bool]:
    """The polylines with points put in until what is straight in the parameters between two is near the curve."""
    open_ = ~lines.last
    for _ in range(ROUNDS):
        at = np.flatnonzero(open_)
        if not len(at) or len(lines.points) > most:
            return lines, not len(at)
        a, b = lines.points[at], lines.points[at + 1]
        middle = 0.5 * (a + b)
        one, two = found.places(*split(a[:, 0])), found.places(*split(b[:, 0]))
        charts = found.flow.charts
        flat = found.flow.surface.points(*charts.within(0.5 * (one + two)))
        flat = flat if tracing.picture is None else tracing.picture(flat)
        with np.errstate(all="ignore"):
            bad = np.linalg.norm(image(middle) - flat, axis=1) > tolerance
        open_[at[~bad]] = False
        put = at[bad]
        lines = Traces(np.insert(lines.points, put + 1, middle[bad], axis=0), np.insert(lines.last, put + 1, False))
        open_ = np.insert(open_, put + 1, True)
    return lines, False
