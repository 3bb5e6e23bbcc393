"""The ways of points that were led over a surface: step by step, and all that is between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.charts import Charts
from vectorplot.features.integral.dormand_prince import Steps
from vectorplot.features.integral.flows import Flow
from vectorplot.geometry import ragged, records
from vectorplot.geometry.vectors import dot, norm

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
        stops = charts.parameters(chart[every], steps.some(every).at(shares.ravel())[:, :2])
        for stop in stops.reshape(PARTS, -1, 2):
            last = charts.near_to(stop, last)
        result[around] = last
    return result


@dataclass(frozen=True, eq=False)
class Leaps:
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

    leaps, steps (s,); offsets (m+1,): point i has the steps offsets[i] to offsets[i+1]; closed (m,): whether it came
    back to its start; stalled, spent (m,): whether it ended where no step succeeds, or for want of steps.
    """

    flow: Flow
    leaps: Leaps
    steps: Steps
    offsets: Ints
    closed: Bools
    stalled: Bools
    spent: Bools

    def states(self, step: Ints, part: Floats) -> Floats:
        """(k,d) the states at parts (k,) of what counts of steps (k,)."""
        return self.steps.some(step).at(part * self.leaps.part[step])

    def places(self, step: Ints, part: Floats) -> Floats:
        """(k,2) u and v there, running on over seams."""
        leaps, steps = self.leaps, self.steps.some(step)
        to = part * leaps.part[step]
        return running_on(self.flow.charts, leaps.chart[step], steps, steps.at(to), leaps.before[step], to)

    def points(self, step: Ints, part: Floats) -> Floats:
        """(k,3) points there."""
        charts = self.flow.charts
        found = charts.parameters(self.leaps.chart[step], self.states(step, part)[:, :2])
        return self.flow.surface.points(*charts.within(found))

    def directions(self, step: Ints, part: Floats) -> Floats:
        """(k,2) how u and v grow there by the length of the ways: as the flow leads at these places, and not only as
        what is between the ends of steps does; NaN at poles."""
        charts, chart, to = self.flow.charts, self.leaps.chart[step], part * self.leaps.part[step]
        steps = self.steps.some(step)
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
        total = np.cumsum(self.leaps.length)
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
        every = self.ends + long * self.leaps.row
        step = np.searchsorted(every, along + long * row)
        step = np.clip(step, self.offsets[row], self.offsets[row + 1] - 1)
        length = self.leaps.length[step]
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
        leaps = replace(records.joined([part.leaps for part in parts]), row=ragged.owner(sizes))
        steps = records.joined([part.steps for part in parts])
        return cls(parts[0].flow, leaps, steps, ragged.offsets(sizes), closed, stalled, spent)

    def some(self, rows: Ints) -> Courses:
        """The ways of some of the points."""
        which, offsets = ragged.take(self.offsets, rows)
        leaps = replace(records.some(self.leaps, which), row=ragged.owner(np.diff(offsets)))
        return Courses(
            self.flow, leaps, self.steps.some(which), offsets, self.closed[rows], self.stalled[rows], self.spent[rows]
        )

    def up_to(self, lengths: Floats) -> Courses:
        """The ways up to lengths (m,) along them; those that are cut are not closed."""
        begins = self.ends - self.leaps.length
        left = np.repeat(lengths, np.diff(self.offsets)) - begins
        kept = np.flatnonzero(left > 0.0)
        leaps = records.some(self.leaps, kept)
        length = np.minimum(leaps.length, left[kept])
        with np.errstate(all="ignore"):
            part = leaps.part * np.where(leaps.length > 0.0, length / leaps.length, 1.0)
        counts = np.bincount(leaps.row, minlength=len(lengths))
        cut = lengths < self.lengths
        return Courses(
            self.flow,
            replace(leaps, part=part, length=length),
            self.steps.some(kept),
            ragged.offsets(counts),
            self.closed & ~cut,
            self.stalled & ~cut,
            self.spent & ~cut,
        )
