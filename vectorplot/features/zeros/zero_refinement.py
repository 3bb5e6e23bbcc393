"""Points brought onto a curve f(u, v) = 0, polylines refined where it turns, ends led up to holes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.zeros.scalar_field import ScalarField
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Refined, Traces, refined, torn
from vectorplot.tolerances.of_parameters import DOT_OF_DOMAIN, REPEATED_OF_DOMAIN

Positions = Callable[[Floats, Floats], Floats]


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


def refined_on_curve(
    field: ScalarField, lines: Traces, positions: Positions, tolerance: float, zero: float, most: int
) -> Refined:
    """The polylines with points of the curve put in where chords deviate from it by more than tolerance, measured
    between positions(u, v) (k, 2 or 3), or until there are most of them; interrupted where positions jump."""

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        chord = (end - start) / field.size
        across = np.stack([-chord[:, 1], chord[:, 0]], axis=1) * field.size
        return onto_curve(field, start + part[:, None] * (end - start), across, zero)

    def image(points: Floats) -> Floats:
        return positions(points[:, 0], points[:, 1])

    found = refined(lines, between, image, tolerance, most)
    return replace(found, lines=torn(found.lines, image, tolerance, field.size))


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


def without_repeats(lines: Traces, size: Floats) -> tuple[Traces, Floats]:
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
    first = lines.starts
    drop[first] = False
    path = ragged.owner(np.diff(np.append(first, len(drop))))
    step[lines.last[:-1]] = 0.0
    dot = np.bincount(path[1:], weights=step, minlength=len(first)) <= DOT_OF_DOMAIN
    kept = ~drop & ~dot[path]
    return lines.some(kept), lines.points[first[dot]]
