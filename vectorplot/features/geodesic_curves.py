"""The geodesics of a surface from one place to another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent, no_curves
from vectorplot.features.streamlines import Ground
from vectorplot.features.surface_integration import (
    DEFAULT,
    Accuracy,
    Courses,
    JacobiFlow,
    drawn,
    starts_of,
    traces_from,
)
from vectorplot.features.surface_points import Sites, charts, unit
from vectorplot.geometry import ragged, records
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances import (
    GEODESIC_MET,
    INTEGRATED_AS_DRAWN,
    INTEGRATED_TO_MEET,
    LENGTH_ROUGHLY,
    MET_OF_INTEGRATED,
    NEIGHBOURS_COUNT,
    ONE_GEODESIC_OF_EXTENT,
)

LONGEST = 3.0
"""Times the extent of its surface that a geodesic is long at most where nothing else is said."""

DIRECTIONS = 240
"""In which geodesics leave the first place to be led to the second one."""

SAMPLES = 96
"""Places for each extent along them at which it is asked whether they come by."""

ASIDE = 1.5
"""Times the angle between two of them that one may have to be turned so that it meets."""

TRIED = 240
"""Of those that come by, the shortest, so many are led there."""

ROUNDS = 12
"""Steps of Newton's method."""

FARTHEST = 0.1
"""The angle by which one of them turns a geodesic at most."""

NEARER = (1 / 6, 1 / 2, 1.0)
"""Parts of the usual length within which geodesics are looked for, one after the other; then longer ones."""

MOST_EXTENTS = 100.0
"""Times the extent of the surface that geodesics may be long: longer ones take minutes, and most of them are missed."""

EIGHT_DIGITS = Accuracy(INTEGRATED_TO_MEET)
"""How well they are integrated where nothing else is said."""

SAME = 100.0
"""Times the part of the extent by which they may miss the end that geodesics differ by at least, if they are two."""

ROUGH = Accuracy(INTEGRATED_AS_DRAWN)
"""How well those are integrated that only say where to begin."""


@dataclass(frozen=True, eq=False)
class _Shots:
    """Geodesics from one place: angle (k,) in which they leave, length (k,)."""

    angle: Floats
    length: Floats


def geodesics_between(
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    most: int | None = 1,
    longest: float | None = None,
    accuracy: Accuracy = EIGHT_DIGITS,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """The geodesics of a surface from one place to another, shortest first, with exact lengths as levels. start, end
    (2,): u, v; most: how many, None for all found; longest: in world units, three times the extent where None;
    tracing: its tolerance, picture and budget count. Geodesics in 240 directions are shot; those that pass the end
    are corrected by Newton's method with Jacobi's field. Of many that wind round far, or diverge fast, some may be
    missed.
    Edge cases: none past borders and holes; between conjugate points one of infinitely many, reported in doubts.
    Errors: InputError for places outside the domain, equal, or without a tangent plane; most or longest not positive,
    or over a hundred extents. Source: do Carmo, Differential geometry of curves and surfaces, sections 4-6 and 5-5.
    """
    if most is not None and most < 1:
        raise InputError(f"geodesics between two places: {most} of them, expected 1 or more")
    places = np.concatenate(
        [
            starts_of(surface, at, f"geodesics between two places: {what}")
            for at, what in ((start, "start"), (end, "end"))
        ]
    )
    size, large = extent(surface)
    if len(places) != 2:
        raise InputError("geodesics between two places: expected one start and one end")
    limit = LONGEST * size if longest is None else positive("geodesics between two places: length", longest)
    if limit > MOST_EXTENTS * size:
        raise InputError(
            f"geodesics between two places: a length of {limit:g} on a surface of {size:g}: expected at most "
            f"{MOST_EXTENTS * size:g}"
        )
    chart = charts(surface)
    points = surface.points(*chart.within(places))
    if not norm(points[1] - points[0]) > ONE_GEODESIC_OF_EXTENT * size:
        raise InputError("geodesics between two places: start and end are the same point")
    flow = JacobiFlow(surface, chart, size)
    shooting = _Shooting(flow, places[0], places[1], (size, large))
    at_pole = np.not_equal(chart.inside(places[:1]), chart.within(places[:1])).any()
    if at_pole or not np.isfinite(shooting.frame).all():
        raise InputError("geodesics between two places: the surface has no tangent plane where they start")
    # Those that are short are shorter than all others: where these are enough the others are not looked for.
    for reach in (limit,) if most is None else _reaches(limit, LONGEST * size):
        roughly, _, _ = shooting.met(shooting.passing(reach), (1.0 + LENGTH_ROUGHLY) * reach, ROUGH, ROUGH.error)
        if most is not None and len(roughly.length) >= most:
            break
    # Which are the shortest is known but for the error of these.
    last = np.inf if most is None else roughly.length[:most].max(initial=0.0)
    wanted = np.flatnonzero(roughly.length <= (1.0 + LENGTH_ROUGHLY) * last)
    near = max(GEODESIC_MET, MET_OF_INTEGRATED * accuracy.error)
    found, aside, runs = shooting.met(records.take(roughly, wanted), limit, accuracy, near)
    if not len(found.length):
        return no_curves()
    order = np.arange(len(found.length))[:most]
    curves = drawn(runs.take(order), 1, size, tracing)
    doubts = ("of infinitely many geodesics between conjugate points there is one",)
    conjugate = bool((aside[order] <= ONE_GEODESIC_OF_EXTENT * size).any())
    return replace(
        curves, levels=found.length[order][curves.levels.astype(np.intp)], doubts=curves.doubts + doubts * conjugate
    )


def _reaches(limit: float, usual: float) -> list[float]:
    """Lengths within which geodesics are looked for, one after the other: parts of the usual one, then twice as long
    each time, up to the limit."""
    base = min(limit, usual)
    found = [part * base for part in NEARER]
    while found[-1] < limit:
        found.append(min(2.0 * found[-1], limit))
    return found


@dataclass(frozen=True, eq=False)
class _Shooting:
    """Geodesics from u and v (2,) to u and v (2,); extent: of the surface."""

    flow: JacobiFlow
    start: Floats
    end: Floats
    extent: tuple[float, float]

    @property
    def frame(self) -> Floats:
        """(2,3) unit tangents at the start: that in which u grows, and that a quarter turn to its left."""
        sites = Sites(self.flow.surface, *self.start[:, None])
        first = unit(sites.planes[0])
        return np.concatenate([first, sites.turned(first, 0.5 * np.pi)])

    def runs(self, shots: _Shots, accuracy: Accuracy) -> Courses:
        """Their traces."""
        ahead, left = self.frame
        tangents = np.cos(shots.angle)[:, None] * ahead + np.sin(shots.angle)[:, None] * left
        starts = np.tile(self.start, (len(tangents), 1))
        return traces_from(self.flow, starts, tangents, shots.length, 1, self.extent, accuracy)

    def passing(self, longest: float) -> _Shots:
        """Those that come by the end, turned and as long as they should be to meet it, the shortest first."""
        step, turned = self.extent[0] / SAMPLES, ASIDE * 2.0 * np.pi / DIRECTIONS
        angle = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
        runs = self.runs(_Shots(angle, np.full(DIRECTIONS, longest)), ROUGH)
        counts = np.ceil(runs.lengths / step).astype(np.intp)
        row = ragged.owner(counts)
        along = np.minimum(step * (ragged.place(counts) + 1.0), runs.lengths[row])
        way, ahead, left, aside = self.missed(runs, row, along)
        # The last place before the end is passed; or the last one of all, where it is near.
        goes_on = np.append(row[1:] == row[:-1], False)
        passes = np.where(goes_on, (ahead > 0.0) & (np.append(ahead[1:], 0.0) <= 0.0), np.abs(ahead) <= 2.0 * step)
        at = np.flatnonzero(passes & (way <= turned * np.abs(aside) + 2.0 * step))
        with np.errstate(all="ignore"):
            turn = np.clip(np.nan_to_num(left[at] / aside[at]), -turned, turned)
        found = _Shots(angle[row[at]] + turn, np.clip(along[at] + ahead[at], step, longest))
        return records.take(found, np.argsort(found.length, kind="stable")[:TRIED])

    def missed(self, runs: Courses, row: Ints, along: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """How far (k,) the end is from places along traces; how much of that is ahead, and to the left; and how far
        the places would move to the left for each unit of the angle that their traces are turned by."""
        step, part = runs.at(row, along)
        states = runs.states(step, part)
        surface, chart = self.flow.surface, self.flow.charts
        places = chart.parameters(runs.strides.chart[step], states[:, :2])
        sites = Sites(surface, *chart.inside(places))
        goal = surface.points(*chart.within(self.end[None]))
        way = goal - surface.points(*chart.within(places))
        tangents = states[:, 2:5]
        left = np.nan_to_num(dot(way, cross(sites.normals, tangents)))
        return norm(way), dot(way, tangents), left, states[:, 5] * self.extent[0] / NEIGHBOURS_COUNT

    def met(self, shots: _Shots, longest: float, accuracy: Accuracy, near: float) -> tuple[_Shots, Floats, Courses]:
        """Those of the shots that meet the end, as near as a part of the extent, each once, the shortest first; how far
        (k,) its neighbours are aside there for each unit of angle; and their traces."""
        size = self.extent[0]
        met, sides, traces = [_Shots(np.zeros(0), np.zeros(0))], [np.zeros(0)], list[Courses]()
        last = np.full(len(shots.angle), np.inf)
        for _ in range(ROUNDS):
            runs = self.runs(shots, accuracy)
            begun = np.flatnonzero(runs.lengths > 0.0)
            along = runs.lengths[begun]
            way, ahead, left, aside = self.missed(runs, begun, along)
            angle = shots.angle[begun]
            done = (way <= near * size) & self._on_its_sheet(runs, begun, along) & (along <= longest)
            met.append(_Shots(angle[done], along[done]))
            sides.append(np.abs(aside[done]))
            traces.append(runs.take(begun[done]))
            with np.errstate(all="ignore"):
                turn = np.clip(np.nan_to_num(left / aside), -FARTHEST, FARTHEST)
            length = along + ahead
            # Newton's method comes nearer with every step, or not at all.
            goes_on = np.flatnonzero((way > near * size) & (length > 0.0) & (way < last[begun]))
            shots, last = records.take(_Shots(angle + turn, length), goes_on), way[goes_on]
            if not len(goes_on):
                break
        found, aside = records.joined(met), np.concatenate(sides)
        order = np.argsort(found.length, kind="stable")
        found, aside = records.take(found, order), aside[order]
        # At a conjugate point all that are as long as each other count as one.
        least = max(ONE_GEODESIC_OF_EXTENT, SAME * near)
        single = aside > least * size
        key = np.stack([found.length / size, single * np.cos(found.angle), single * np.sin(found.angle)], axis=1)
        left_over, chosen = np.arange(len(key)), []
        while len(left_over):
            chosen.append(int(left_over[0]))
            left_over = left_over[norm(key[left_over] - key[left_over[0]]) > least]
        kept = np.array(chosen, dtype=np.intp)
        return records.take(found, kept), aside[kept], Courses.joined(traces).take(order[kept])

    def _on_its_sheet(self, runs: Courses, row: Ints, along: Floats) -> Bools:
        """(k,) whether places along traces are near the end along the surface, if they are in space."""
        ground = Ground(self.flow.surface, self.flow.charts, 1.0)
        ends = np.tile(self.end, (len(row), 1))
        return ground.on_one_sheet(runs.places(*runs.at(row, along)), ends, ROUGH.error * self.extent[0])
