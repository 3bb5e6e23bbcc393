"""Points brought onto a curve f(u, v) = 0, polylines refined where it turns, ends led up to holes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.scalar_field import ScalarField
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_parameters import DOT_OF_DOMAIN, JUMP_OF_DOMAIN, REPEATED_OF_DOMAIN

Positions = Callable[[Floats, Floats], Floats]

PROBES = (0.35, 0.7)
"""Where between two points the curve is compared with its chord: not symmetric, so that no S-shape passes."""

MISSED = 0.8
"""Part of the largest deviation of a parabola that the probes see at least."""


@dataclass(frozen=True, eq=False)
class Polylines:
    """points (p,2); last (p,): the point is the last of its polyline. Closed ones repeat their first point."""

    points: Floats
    last: Bools


def onto_curve(field: ScalarField, points: Floats, across: Floats, zero: float) -> tuple[Floats, Bools]:
    """Points (k,2) moved along directions across (k,2) onto f = 0, and which of them got there.

    The nearest zero within the length of across on either side is taken: by secants, or where they fail by looking at
    places along the line. Values up to zero count as zero.
    """
    s = np.zeros(len(points))
    active = np.arange(len(points))
    before, w_before = np.full(len(points), 0.01), field.values(points + 0.01 * across)
    # Next to a border or a hole the first step goes the other way.
    turned = np.flatnonzero(np.isnan(w_before))
    before[turned] *= -1.0
    w_before[turned] = field.values(points[turned] - 0.01 * across[turned])
    w = field.values(points)
    done = np.abs(w) <= zero
    active = active[~done]
    for _ in range(8):
        if not len(active):
            break
        with np.errstate(all="ignore"):
            step = w[active] * (s[active] - before[active]) / (w[active] - w_before[active])
        before[active], w_before[active] = s[active], w[active]
        s[active] -= step
        active = active[np.abs(s[active]) <= 0.5]
        w[active] = field.values(points[active] + s[active, None] * across[active])
        done[active] = np.abs(w[active]) <= zero
        active = active[~done[active]]
    failed = np.flatnonzero(~done)
    if len(failed):
        s[failed], done[failed] = _searched(field, points[failed], across[failed], zero)
    return points + np.where(done, s, 0.0)[:, None] * across, done


def _searched(field: ScalarField, points: Floats, across: Floats, zero: float) -> tuple[Floats, Bools]:
    """For each point where along across the nearest change of sign is a zero, and whether there is one."""
    places = np.linspace(-1.0, 1.0, 33)
    line = points[:, None] + places[:, None] * across[:, None]
    w = field.values(line.reshape(-1, 2)).reshape(len(points), -1)
    change = (w[:, 1:] < 0.0) != (w[:, :-1] < 0.0)
    change &= np.isfinite(w[:, 1:]) & np.isfinite(w[:, :-1])
    middle = np.abs(places[1:] + places[:-1])
    at = np.argmin(np.where(change, middle, np.inf), axis=1)
    found = np.flatnonzero(change[np.arange(len(at)), at])
    s, good = np.zeros(len(points)), np.zeros(len(points), dtype=np.bool_)
    low, step, at = places[at[found]], places[1] - places[0], at[found]
    t, rest = bracketed_zeros(
        lambda t, k: field.values(points[found[k]] + (low[k] + t * step)[:, None] * across[found[k]]),
        w[found, at],
        w[found, at + 1],
        np.full(len(found), 0.5),
        np.full(len(found), zero),
    )
    s[found], good[found] = low + t * step, np.abs(rest) <= zero
    return s, good


def refined(
    field: ScalarField, lines: Polylines, positions: Positions, tolerance: float, zero: float, most: int
) -> tuple[Polylines, int, bool]:
    """The polylines with points of the curve put in where chords deviate from it by more than tolerance, measured
    between positions(u, v) (k, 2 or 3), or until there are most of them; the number of segments that could not be
    refined; and whether points sufficed.

    Positions that are not finite (behind an eye) end the refinement there; where they jump polylines are interrupted.
    """
    points, last = lines.points, lines.last
    # A segment belongs to the point it starts at; open ones are still to be looked at.
    open_, unsure = ~last, 0
    for _ in range(20):
        first = np.flatnonzero(open_)
        if not len(first) or len(points) > most:
            break
        probes, on = _probed(field, points[first], points[first + 1], zero)
        bad = _deviation(positions, points[first], points[first + 1], probes) > tolerance * MISSED
        long = _lengths(positions, points[first], points[first + 1]) > tolerance
        unsure += int((long & ~on.all(axis=0)).sum())
        split = first[bad & on.all(axis=0)]
        open_[:] = False
        open_[split] = True
        at = np.repeat(split + 1, 2)
        points = np.insert(points, at, probes[:, bad & on.all(axis=0)].transpose(1, 0, 2).reshape(-1, 2), axis=0)
        last, open_ = np.insert(last, at, False), np.insert(open_, at, True)
    return _torn(field, Polylines(points, last), positions, tolerance), unsure, not open_.any()


def _torn(field: ScalarField, lines: Polylines, positions: Positions, tolerance: float) -> Polylines:
    """The polylines, interrupted where positions jump, without what is only a point then."""
    p, last = lines.points, lines.last.copy()
    step = np.abs(np.diff(p, axis=0)) / field.size
    at = np.flatnonzero((step <= JUMP_OF_DOMAIN).all(axis=1) & (step > 0.0).any(axis=1) & ~last[:-1])
    at = at[_lengths(positions, p[at], p[at + 1]) > tolerance]
    if not len(at):
        return lines
    last[at] = True
    alone = last & np.concatenate([[True], last[:-1]])
    return Polylines(p[~alone], last[~alone])


def _probed(field: ScalarField, start: Floats, end: Floats, zero: float) -> tuple[Floats, Bools]:
    """(2,k,2) points of the curve beside the probes of chords, and (2,k) whether they were found."""
    chord = (end - start) / field.size
    across = np.stack([-chord[:, 1], chord[:, 0]], axis=1) * field.size
    places = np.concatenate([start + p * (end - start) for p in PROBES])
    moved, on = onto_curve(field, places, np.concatenate([across] * len(PROBES)), zero)
    return moved.reshape(len(PROBES), -1, 2), on.reshape(len(PROBES), -1)


def _deviation(positions: Positions, start: Floats, end: Floats, probes: Floats) -> Floats:
    """(k,) largest distance of the probes' positions from the chord's."""
    a, b = _positions(positions, start), _positions(positions, end)
    chord = b - a
    square = (chord * chord).sum(axis=1)
    most = np.zeros(len(start))
    for probe in probes:
        arm = _positions(positions, probe) - a
        with np.errstate(invalid="ignore"):
            t = np.clip((arm * chord).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
            away = arm - t[:, None] * chord
            most = np.fmax(most, np.sqrt((away * away).sum(axis=1)))
    return most


def _lengths(positions: Positions, start: Floats, end: Floats) -> Floats:
    """(k,) distances between positions."""
    d = _positions(positions, end) - _positions(positions, start)
    return np.asarray(np.sqrt((d * d).sum(axis=1)))


def _positions(positions: Positions, points: Floats) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(positions(points[:, 0], points[:, 1]), dtype=np.float64)


def up_to_holes(field: ScalarField, end: Floats, before: Floats, reach: Floats, zero: float) -> tuple[Floats, Bools]:
    """(k,2) where the curve that arrives at end (k,2) from before (k,2) enters a hole of f, within reach (2,) cells of
    size; and whether it goes on at all.

    The way into the hole is halved until it is known to rounding; at each step the point is brought onto the curve.
    """
    way = (end - before) / reach
    length = np.sqrt((way * way).sum(axis=1, keepdims=True))
    way = way / np.where(length > 0.0, length, 1.0)
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) * reach
    way = way * reach
    low, high = np.zeros(len(end)), np.full(len(end), 2.0)
    best = end.copy()
    for _ in range(48):
        middle = (low + high) / 2.0
        moved, on = onto_curve(field, end + middle[:, None] * way, across * middle[:, None], zero)
        best[on] = moved[on]
        low, high = np.where(on, middle, low), np.where(on, high, middle)
    return best, np.asarray(low > 0.0, dtype=np.bool_)


def without_repeats(lines: Polylines, size: Floats) -> tuple[Polylines, Floats]:
    """The polylines without points that repeat the one before them to within a billionth of the domain, and the points
    (k,2) of those that were nothing but one point."""
    if not len(lines.points):
        return lines, lines.points
    step = (np.abs(np.diff(lines.points, axis=0)) / size).max(axis=1)
    step[lines.last[:-1]] = np.inf
    drop = np.concatenate([[False], step <= REPEATED_OF_DOMAIN])
    # The last point stays: the one before it goes instead.
    swap = np.flatnonzero(drop & lines.last)
    drop[swap], drop[swap - 1] = False, True
    first = starts_of(lines.last)
    drop[first] = False
    path = ragged.owner(np.diff(np.append(first, len(drop))))
    step[lines.last[:-1]] = 0.0
    dot = np.bincount(path[1:], weights=step, minlength=len(first)) <= DOT_OF_DOMAIN
    kept = ~drop & ~dot[path]
    return Polylines(lines.points[kept], lines.last[kept]), lines.points[first[dot]]


def starts_of(last: Bools) -> Ints:
    """(b,) positions of the first points of polylines."""
    return np.flatnonzero(np.concatenate([[True], last[:-1]])[: len(last)])
