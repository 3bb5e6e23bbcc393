"""Points brought onto a curve f(u, v) = 0, polylines refined where it turns, ends led up to holes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.scalar_field import ScalarFields, moved, number
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Traces, refined, torn
from vectorplot.geometry.components import greatest_component
from vectorplot.geometry.narrowing import narrowed
from vectorplot.geometry.vectors import from_components
from vectorplot.tolerances.of_parameters import DOT_OF_DOMAIN, REPEATED_OF_DOMAIN

FIRST_STEP = 0.01
"""Part of the way along which a zero is looked for, to its slope."""

HALVINGS = 48
"""How often the way into a hole is halved until its border is known to rounding."""

Positions = Callable[[Floats, Floats, Ints], Floats]
"""Takes arrays u, v (k,) and the numbers of the functions whose parameters they are to (k, 2 or 3)."""


def onto_curve(field: ScalarFields, points: Floats, across: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """Points (k,3) moved along directions across (k,2) onto f = 0, and which of them got there.

    The nearest zero within the length of across on either side is taken: by secants, or where they fail by looking at
    places along the line. Values up to zero (s,) count as zero.
    """
    zero = zero[number(points)]
    s = np.zeros(len(points))
    active = np.arange(len(points))
    before, w_before = np.full(len(points), FIRST_STEP), field.values(moved(points, FIRST_STEP * across))
    # Next to a border or a hole the first step goes the other way.
    turned = np.flatnonzero(np.isnan(w_before))
    before[turned] *= -1.0
    w_before[turned] = field.values(moved(points[turned], -FIRST_STEP * across[turned]))
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
        w[active] = field.values(moved(points[active], s[active, None] * across[active]))
        done[active] = np.abs(w[active]) <= zero[active]
        active = active[~done[active]]
    failed = np.flatnonzero(~done)
    if len(failed):
        s[failed], done[failed] = _searched(field, points[failed], across[failed], zero[failed])
    return moved(points, np.where(done, s, 0.0)[:, None] * across), done


def near_curve(field: ScalarFields, points: Floats, across: Floats) -> tuple[Floats, Bools]:
    """The same after a single secant, which for points next to the curve leads to within a small part of the way; they
    are next to it that are no farther than two of the first steps."""
    w, aside = field.values(points), field.values(moved(points, FIRST_STEP * across))
    with np.errstate(all="ignore"):
        s = FIRST_STEP * w / (w - aside)
    found = np.abs(s) <= 2.0 * FIRST_STEP
    return moved(points, np.where(found, s, 0.0)[:, None] * across), found


def _searched(field: ScalarFields, points: Floats, across: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """For each point where along across the nearest change of sign is a zero, and whether there is one."""
    places = np.linspace(-1.0, 1.0, 33)
    line = moved(np.repeat(points[:, None], len(places), axis=1), places[:, None] * across[:, None])
    w = field.values(line.reshape(-1, 3)).reshape(len(points), -1)
    change = (w[:, 1:] < 0.0) != (w[:, :-1] < 0.0)
    change &= np.isfinite(w[:, 1:]) & np.isfinite(w[:, :-1])
    middle = np.abs(places[1:] + places[:-1])
    at = np.argmin(np.where(change, middle, np.inf), axis=1)
    found = np.flatnonzero(change[np.arange(len(at)), at])
    s, good = np.zeros(len(points)), np.zeros(len(points), dtype=np.bool_)
    low, step, at = places[at[found]], places[1] - places[0], at[found]
    t, rest = bracketed_zeros(
        lambda t, k: field.values(moved(points[found[k]], (low[k] + t * step)[:, None] * across[found[k]])),
        w[found, at],
        w[found, at + 1],
        np.full(len(found), 0.5),
        zero[found],
    )
    s[found], good[found] = low + t * step, np.abs(rest) <= zero[found]
    return s, good


def refined_on_curve(
    field: ScalarFields, lines: Traces, positions: Positions, tolerance: Floats, zero: Floats, most: int
) -> tuple[Traces, Ints, Bools]:
    """The polylines with points of the curves put in where chords deviate from these by more than the tolerance (s,),
    measured between positions, or until there are most of them of one function; interrupted where positions jump. And
    for each function (s,) at how many chords its curve was not found, and whether most points were enough."""

    def beside(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Floats]:
        size = field.size[number(start)]
        chord = (end - start)[:, :2] / size
        return start + part[:, None] * (end - start), from_components(-chord[:, 1], chord[:, 0]) * size

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return onto_curve(field, *beside(start, end, part), zero)

    def near(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return near_curve(field, *beside(start, end, part))

    def image(points: Floats) -> Floats:
        return positions(points[:, 0], points[:, 1], number(points))

    of = of_lines(lines)
    found = refined(lines, between, image, tolerance[of], most, share=of, near=near)
    size = np.concatenate([field.size, np.ones((len(field), 1))], axis=1)
    unsure = np.bincount(of, weights=found.unsure, minlength=len(field)).astype(np.intp)
    short = np.bincount(of[~found.enough], minlength=len(field))
    return torn(found.lines, image, tolerance[of], size[of]), unsure, np.asarray(short == 0)


def of_lines(lines: Traces) -> Ints:
    """(m,) the number of the function that each polyline belongs to."""
    return number(lines.points[lines.starts])


def up_to_holes(field: ScalarFields, end: Floats, before: Floats, reach: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """(k,3) where the curve that arrives at end (k,3) from before (k,3) enters a hole of f, within reach (k,2) cells of
    size; and whether it goes on at all.

    Along the way into the hole points are brought onto the curve, as far as there is one.
    """
    way = (end - before)[:, :2] / reach
    length = np.sqrt((way * way).sum(axis=1, keepdims=True))
    way = way / np.where(length > 0.0, length, 1.0)
    across = from_components(-way[:, 1], way[:, 0]) * reach
    way = way * reach

    def on_from(which: Ints, far: Floats) -> tuple[Floats, Bools]:
        return onto_curve(field, moved(end[which], far[:, None] * way[which]), far[:, None] * across[which], zero)

    last, _ = narrowed(lambda which, far: on_from(which, far)[1], np.zeros(len(end)), np.full(len(end), 2.0), HALVINGS)
    goes = last > 0.0
    best = end.copy()
    best[goes] = on_from(np.flatnonzero(goes), last[goes])[0]
    return best, goes


def without_repeats(lines: Traces, size: Floats) -> tuple[Traces, Floats]:
    """The polylines without points that repeat the one before them to within a billionth of the domain, of the size
    (s,2), and the points (k,3) of those that were nothing but one point."""
    if not len(lines.points):
        return lines, lines.points
    step = greatest_component(np.abs(np.diff(lines.points[:, :2], axis=0)) / size[number(lines.points[1:])])
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
