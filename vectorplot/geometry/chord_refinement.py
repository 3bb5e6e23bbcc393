"""Polylines on curves of any kind refined until chords are near the curves, and changes along ways found by halving."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.polylines import Rounds
from vectorplot.geometry.vectors import all_components, any_component, component_sum
from vectorplot.tolerances import JUMP_OF_DOMAIN, STANDSTILL_OF_SPEED

# Polylines on curves refined until their chords are near the curves: one way for every kind of curve.

PROBES = (0.35, 0.7)
"""Where between two points a curve is compared with its chord: not symmetric, so that no S-shape passes."""

MISSED = 0.8
"""Part of the largest deviation of a parabola that the probes see at least."""

SURE = 0.5
"""Part of the deviation that is allowed: where probes not quite on the curve deviate less than that a chord will do."""

ONE_STEP = 0.95
"""Part of a chord beyond which a step between neighbouring probes is all of it: theirs are no more than 0.35 of a curve
that runs evenly."""

HALVINGS = 52
"""How often the way between two points is halved until it is known where a curve turns back: to the last bit."""

ROUNDS = 20
"""How often chords are cut by three at most."""

Between = Callable[[Floats, Floats, Floats], tuple[Floats, Bools]]
"""Points (k,c) of the curve near parts (k,) of the ways from points (k,c) to points (k,c) of it, and (k,) which of them
were found."""

Image = Callable[[Floats], Floats]
"""Takes points (k,c) to where chords are measured, (k,d); not finite where there is no image."""


@dataclass(frozen=True, eq=False)
class Traces:
    """Polylines on their way to a curve: points (n,c), one row for all that is known of a point, its coordinates or its
    parameters; last (n,): the point is the last of its polyline. Closed ones repeat their first point."""

    points: Floats
    last: Bools

    @classmethod
    def of(cls, points: Floats, rounds: Rounds) -> Traces:
        """Polylines led back to where they begin, none of them empty; points (k,c): what their indices speak of."""
        last = np.zeros(len(rounds.index), dtype=np.bool_)
        last[rounds.offsets[1:] - 1] = True
        return cls(points[rounds.index], last)

    @property
    def starts(self) -> Ints:
        """(m,) positions of the first points of polylines."""
        return np.flatnonzero(np.concatenate([[True], self.last[:-1]])[: len(self.last)])

    @property
    def ends(self) -> Ints:
        """(m,) positions of the last points of polylines."""
        return np.flatnonzero(self.last)

    def take(self, kept: Bools) -> Traces:
        """The points that are kept; the last one of a polyline has to be."""
        return records.take(self, kept)

    def unrepeated(self, closed: Bools) -> tuple[Bools, Ints]:
        """Which points (n,) to keep where closed (m,) polylines do not repeat their first one, and the offsets (m+1,)
        of the polylines then."""
        kept = np.ones(len(self.last), dtype=np.bool_)
        kept[self.ends[closed]] = False
        return kept, ragged.offsets(np.diff(self.ends, prepend=-1) - closed)


@dataclass(frozen=True, eq=False)
class Refined:
    """The polylines with points put in; unsure (m,): at how many long chords of each the curve was not found; enough
    (m,): whether as many points as there may be were enough for it."""

    lines: Traces
    unsure: Ints
    enough: Bools


def straight_between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
    """The points between two of a curve that is given by what runs evenly along it: a Between."""
    return start + part[:, None] * (end - start), np.ones(len(start), dtype=np.bool_)


def refined(
    lines: Traces,
    between: Between,
    image: Image,
    tolerance: float | Floats,
    most: float | Floats,
    share: Ints | None = None,
    near: Between | None = None,
) -> Refined:
    """The polylines with points of their curves added until chords deviate by no more than tolerance in the image, or
    there are most points; both one or (m,). share (m,): polylines of one number have most together; near: a cheaper
    approximation of between, to judge chords by. Refinement ends where the curve is not found or has no finite
    image.
    """
    points, last = lines.points, lines.last
    count = int(last.sum())
    share = np.zeros(count, dtype=np.intp) if share is None else share
    limit = np.broadcast_to(np.asarray(tolerance, dtype=np.float64), count)
    allowed = np.broadcast_to(np.asarray(most, dtype=np.float64), count)
    # A chord belongs to the point it starts at; open ones are still to be looked at.
    open_, unsure = ~last, np.zeros(count, dtype=np.intp)
    # Images are made once: the probes of one round are ends of chords in the next.
    images = _seen(image, points) if len(points) else points
    # Of each polyline by itself, so that it is cut as if it were alone.
    starts = lines.starts
    extent = np.fmax.reduceat(points, starts) - np.fmin.reduceat(points, starts) if len(points) else points
    least = 0.1 * JUMP_OF_DOMAIN * extent
    for _ in range(ROUNDS):
        first = np.flatnonzero(open_)
        line = _line(last)
        used = np.bincount(share, weights=np.bincount(line, minlength=count))
        first = first[(used[share] <= allowed)[line[first]]]
        if not len(first):
            break
        if near is not None:
            _, found, seen, far, long = _probed(near, image, points, images, first)
            allowing = limit[line[first]]
            wall = _one_step(points, images, first, seen, least[line[first]]) & (long > allowing)
            does = found & (far <= SURE * MISSED * allowing) & ~wall
            open_[first[does]] = False
            first = first[~does]
        of = line[first]
        probes, found, seen, far, long = _probed(between, image, points, images, first)
        unsure += np.bincount(of[~found & (long > limit[of])], minlength=count)
        # A wall narrower than the tolerance is no chord: it is cut until it is known whether the curve jumps there.
        wall = _one_step(points, images, first, seen, least[of]) & (long > limit[of])
        bad = found & ((far > MISSED * limit[of]) | wall)
        split = first[bad]
        open_[first] = False
        open_[split] = True
        at = np.repeat(split + 1, len(PROBES))
        points, images = (
            np.insert(whole, at, new[:, bad].transpose(1, 0, 2).reshape(-1, whole.shape[1]), axis=0)
            for whole, new in ((points, probes), (images, seen))
        )
        last, open_ = np.insert(last, at, False), np.insert(open_, at, True)
    enough = np.bincount(_line(last)[open_], minlength=count) == 0
    return Refined(Traces(points, last), unsure, np.asarray(enough))


def _probed(
    between: Between, image: Image, points: Floats, images: Floats, first: Ints
) -> tuple[Floats, Bools, Floats, Floats, Floats]:
    """Of the chords from points first (k,) to the next ones: the probes (j,k,c) of their curves, whether (k,) all of
    them are found, their images (j,k,d), and as in `deviation` how far these are from the chord, and its length."""
    a, b = points[first], points[first + 1]
    starts, ends = (np.concatenate([x] * len(PROBES)) for x in (a, b))
    places, on = between(starts, ends, np.repeat(PROBES, len(first)))
    seen = _seen(image, places).reshape(len(PROBES), len(first), images.shape[1])
    far, long = deviation(images[first], images[first + 1], seen)
    found: Bools = np.asarray(on.reshape(len(PROBES), -1).all(axis=0))
    return places.reshape(len(PROBES), *a.shape), found, seen, far, long


def _one_step(points: Floats, images: Floats, first: Ints, seen: Floats, least: Floats) -> Bools:
    """(k,) which chords from points first (k,) to the next ones are gone all but at once, between two of the probes
    seen (j,k,d) and the ends, and are longer than the least (k,c) over which curves jump."""
    nodes = np.concatenate([images[first][None], seen, images[first + 1][None]])
    with np.errstate(invalid="ignore"):
        steps, whole = np.diff(nodes, axis=0), nodes[-1] - nodes[0]
        longest = component_sum(steps * steps).max(axis=0)
        at_once = longest > ONE_STEP * ONE_STEP * component_sum(whole * whole)
    return np.asarray(at_once & any_component(np.abs(points[first + 1] - points[first]) > least), dtype=np.bool_)


def _line(last: Bools) -> Ints:
    """(n,) the polyline that each point belongs to."""
    return np.asarray(np.cumsum(last) - last, dtype=np.intp)


def with_standstills(lines: Traces, slopes: Callable[[Floats], Floats]) -> Traces:
    """The polylines of curves that are given by what runs evenly along them, with the points put in at which a curve
    stands still and turns back: its cusps.

    slopes: takes points (k,c) to the derivatives (k,d) of the curves there, by what runs along them.
    Edge cases: of two cusps between neighbouring points none is seen.
    """
    points, way = lines.points, _seen(slopes, lines.points)
    with np.errstate(invalid="ignore"):
        back = (way[1:] * way[:-1]).sum(axis=1) < 0.0
    first = np.flatnonzero(back & ~lines.last[:-1])
    if not len(first):
        return lines
    start, run, ahead = points[first], points[first + 1] - points[first], way[first]

    def goes_on(which: Ints, part: Floats) -> Bools:
        return np.asarray((_seen(slopes, start[which] + part[:, None] * run[which]) * ahead[which]).sum(axis=1) > 0.0)

    _, high = bisected(goes_on, np.zeros(len(first)), np.ones(len(first)), HALVINGS)
    there = start + high[:, None] * run
    speed, before, after = (np.sqrt((x * x).sum(axis=1)) for x in (_seen(slopes, there), ahead, way[first + 1]))
    stands = speed <= STANDSTILL_OF_SPEED * np.minimum(before, after)
    stands &= (there != start).any(axis=1) & (there != points[first + 1]).any(axis=1)
    at = first[stands] + 1
    return Traces(np.insert(points, at, there[stands], axis=0), np.insert(lines.last, at, False))


def deviation(start: Floats, end: Floats, probes: Floats) -> tuple[Floats, Floats]:
    """(k,) largest distances of images probes (j,k,c) from the chords between start and end (k,c), and the lengths of
    these; what has no finite image is at no distance."""
    with np.errstate(invalid="ignore"):
        chord = end - start
    square = component_sum(chord * chord)
    most = np.zeros(len(start))
    for probe in probes:
        with np.errstate(invalid="ignore"):
            arm = probe - start
            t = np.clip(component_sum(arm * chord) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
            away = arm - t[:, None] * chord
            most = np.fmax(most, np.sqrt(component_sum(away * away)))
    return most, np.nan_to_num(np.sqrt(square))


def torn(lines: Traces, image: Image, tolerance: float | Floats, size: Floats) -> Traces:
    """The polylines, interrupted where their image jumps by more than the tolerance, one for all or one for each (m,),
    without what is only a point then; size (c,) or (m,c): of the domain of the points."""
    p, last = lines.points, lines.last.copy()
    line = _line(last)[:-1]
    size = np.broadcast_to(size, (int(last.sum()), p.shape[1]))[line]
    limit = np.broadcast_to(np.asarray(tolerance, dtype=np.float64), int(last.sum()))[line]
    step = np.abs(np.diff(p, axis=0)) / size
    at = np.flatnonzero(all_components(step <= JUMP_OF_DOMAIN) & any_component(step > 0.0) & ~last[:-1])
    way = _seen(image, p[at + 1]) - _seen(image, p[at])
    at = at[np.sqrt((way * way).sum(axis=1)) > limit[at]]
    if not len(at):
        return lines
    last[at] = True
    alone = last & np.concatenate([[True], last[:-1]])
    return Traces(p, last).take(~alone)


def _seen(image: Image, points: Floats) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(image(points), dtype=np.float64)


# Where something changes along ways, many at once: found as by halving, in fewer calls.

AT_ONCE = 1 << 10
"""Places that are looked at in one call, at least one on each way: few of them take about as long as one."""

MOST_HALVINGS = 4
"""What is left of a way is cut in one call as fine as by no more halvings than that."""


def bisected(
    goes_on: Callable[[Ints, Floats], Bools], low: Floats, high: Floats, halvings: int
) -> tuple[Floats, Floats]:
    """(k,) the last parameters between low and high (k,) up to which something is as it is at low, and the first at
    which it is not, as near to each other as so many halvings lead.

    goes_on: takes which of the k ways (n,) and parameters (n,) on these to whether (n,) it is as at low there.
    Edge cases: of several changes one is found; where nothing changes it is taken to do so at high.
    """
    if not len(low):
        return low, high
    at_once = int(np.clip(np.log2(AT_ONCE / len(low)), 1, MOST_HALVINGS))
    parts = 1 << at_once
    ways = np.tile(np.arange(len(low)), parts - 1)
    return narrowed(
        lambda tried: goes_on(ways, tried.ravel()).reshape(tried.shape), low, high, parts, -(-halvings // at_once)
    )


def narrowed(
    goes_on: Callable[[Floats], Bools], low: Floats, high: Floats, parts: int, rounds: int
) -> tuple[Floats, Floats]:
    """The same where what is left of all ways is cut into so many parts at a time, in so many rounds; goes_on takes
    parameters on each of the ways (n,k) to whether (n,k) it is as at low there."""
    way, inner = np.arange(len(low)), np.arange(1, parts)[:, None] / parts
    for _ in range(rounds):
        tried = low + inner * (high - low)
        alike = goes_on(tried)
        last = np.where(alike.all(axis=0), parts - 1, np.argmin(alike, axis=0))
        nodes = np.concatenate([low[None], tried, high[None]])
        low, high = nodes[last, way], nodes[last + 1, way]
    return low, high
