"""Points led over a surface by a flow, many at once, each with steps of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.charts import Charts
from vectorplot.features.integral.courses import Courses, Leaps, running_on
from vectorplot.features.integral.dormand_prince import ORDER, Steps, steps
from vectorplot.features.integral.flows import Flow
from vectorplot.features.integral.sites import Sites
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged, records
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.elementary import power
from vectorplot.geometry.vectors import dot, norm
from vectorplot.tolerances.of_extent import (
    CLOSED_OF_EXTENT,
    INTEGRATED_OF_EXTENT,
    ROUNDING_OF_POINTS,
    STALLED_OF_EXTENT,
)
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

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


def courses(
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
    """The courses of points from u and v (m,2) along unit tangents (m,3), as long as lengths (m,) say at most.

    way (m,): -1 where they run against the field; size, large: the extent of the surface and its largest coordinate.
    They end at borders, where they close, where no step succeeds, and at what else is said.
    Source: Glaeser, section 9.4; errata G9-13 and G9-14: here steps have the length that their error allows, and a
    curve closes only after it has been away.
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

    leaps: list[Leaps] = []
    found: list[Steps] = []
    now = records.some(now, all_finite(now.rates) & (now.left > 0.0))
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
            part[out] = _crossing(flow, now.chart[out], records.some(tried, out))
        back, share = _back(flow, now, good, tried, part, points, home, tangents, size, accuracy.error)
        part[back] = share
        closed[now.which[back]] = True
        length = step * part
        leap = Leaps(now.which, now.chart, part, length, now.places)
        leaps.append(_those(leap, good))
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
    if not leaps:
        none = Leaps(order, order, np.zeros(0), np.zeros(0), np.zeros((0, 2)))
        empty = states[:0]
        return Courses(flow, none, Steps(*[empty] * 6), offsets, closed, stalled, spent)
    every = records.joined(leaps)
    order = np.argsort(every.row, kind="stable")
    offsets = ragged.offsets(np.bincount(every.row, minlength=count))
    return Courses(flow, records.some(every, order), records.joined(found).some(order), offsets, closed, stalled, spent)


R = TypeVar("R", bound=records.Record)


def _those(record: R, which: Bools) -> R:
    """Those of the elements where which (k,) is true: mostly all of them."""
    return record if which.all() else records.some(record, which)


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
        return what(done.some(which).at(part), which)

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

    some = done.some(rows)
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
