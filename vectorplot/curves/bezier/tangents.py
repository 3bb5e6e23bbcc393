"""Corners and tangents of polylines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.elementary import arccos
from vectorplot.tolerances.of_lengths import SLACK_OF_LENGTH


@dataclass(frozen=True, eq=False)
class FitLines:
    """Polylines ready for fitting: no repeated points, closed ones with their first point repeated at the end.

    points (d,n); length (n,) along all of them, one after the other; first, last (m,) indices of each line's ends;
    closed (m,); line (n,) the line of each point.
    """

    points: Floats
    length: Floats
    first: Ints
    last: Ints
    closed: Bools
    line: Ints


@dataclass(frozen=True, eq=False)
class Directions:
    """Unit tangents (d,n) with which curves arrive at the points and leave them, and corners (n,), ends included."""

    arriving: Floats
    leaving: Floats
    corner: Bools


BEND = 24.0
"""At a point of a smooth curve the product of turn and shorter chord is eight times how far chords are off the curve,
if both are equally far off; so many times that far it is a corner."""


SMOOTHED = 8.0
"""Where two tangents meet, a smooth curve through points on both sides passes by at the product of their angle and the
shorter chord by so much, about."""


def directions(
    lines: FitLines, given: Floats, window: Floats, corner_angle: float, tolerance: float, sag: float = np.inf
) -> Directions:
    """Corners and tangents of lines.

    given (2,d,n): tangents with which curves are known to arrive at points and to leave them; zero at a corner, NaN
    where nothing is known. A tangent that is not known is that of the circle through the point and its neighbours at
    the distance window (m,) of its line, so that noise below the tolerance does not turn it; at ends and corners that
    of the circle through the next point with the tangent known there, or through the two next ones.
    A point with known tangents is a corner if they differ by so much that no smooth curve could pass it within the
    tolerance, or by more than corner_angle. Another one is a corner if the line turns by more than corner_angle there,
    and still within the window, or by more than chords allow that are no farther than sag off their curve; if one
    tangent is known, and it turns away, moreover, by a third of corner_angle from the circle's.
    """
    ends = _ends(lines)
    before, after = _next_chords(lines)
    said: Bools = np.asarray(~np.isnan(given).any(axis=1))
    sides = np.where(said[:, None], _unit(np.moveaxis(given, 1, 0)).swapaxes(0, 1), 0.0)
    known: Bools = np.asarray(np.abs(sides).sum(axis=1) > 0.0)
    both, either = known.all(axis=0), known.any(axis=0)
    # What is known of one side only holds on both unless there is a corner.
    one_side = np.where(known[0], sides[0], sides[1])
    turn = arccos(np.clip(_cosine(*sides), -1.0, 1.0))
    corner: Bools = both & ((turn > corner_angle) | (turn * _shorter(before, after) > SMOOTHED * tolerance))
    if not both.all():
        pairs = ((before, after), _chords(lines, window, ends))
        bent = np.all([_cosine(*pair) < np.cos(corner_angle) for pair in pairs], axis=0)
        bent |= np.all([_bend(*pair) > BEND * sag for pair in pairs], axis=0)
        bent &= ~either | (_cosine(one_side, _through(before, after)) < np.cos(corner_angle / 3.0))
        corner |= ~both & bent | (said & ~known).any(axis=0)
    corner &= ~ends
    # The seam of a loop is one point.
    loop = lines.closed
    corner[lines.last[loop]] = corner[lines.first[loop]]
    stops = corner | ends
    smooth = np.where(both, _unit(sides[0] + sides[1]), one_side)
    if not either.all():
        smooth = np.where(either, smooth, _through(*_chords(lines, window, stops)))
    arriving, leaving = smooth, smooth.copy()
    at = np.flatnonzero(stops)
    for side, tangent in ((0, arriving), (1, leaving)):
        own, guessed = at[known[side, at]], at[~known[side, at]]
        tangent[:, own] = sides[side][:, own]
        tangent[:, guessed] = _one_sided(lines, guessed, 2.0 * side - 1.0, stops, window, sides, known)
    return Directions(arriving, leaving, stops)


def _shorter(before: Floats, after: Floats) -> Floats:
    """(n,) the lengths of the shorter ones of vectors."""
    return np.asarray(np.sqrt(np.minimum((before * before).sum(axis=0), (after * after).sum(axis=0))))


def _bend(before: Floats, after: Floats) -> Floats:
    """(n,) the angles between vectors times the lengths of the shorter ones."""
    return np.asarray(arccos(np.clip(_cosine(before, after), -1.0, 1.0)) * _shorter(before, after))


def _ends(lines: FitLines) -> Bools:
    """Ends of open lines."""
    ends = np.zeros(len(lines.line), dtype=np.bool_)
    ends[lines.first[~lines.closed]] = ends[lines.last[~lines.closed]] = True
    return ends


def _next_chords(lines: FitLines) -> tuple[Floats, Floats]:
    """(d,n) vectors from the point before and to the next one; zero beyond the ends of open lines."""
    step = np.diff(lines.points, axis=1)
    before, after = np.zeros_like(lines.points), np.zeros_like(lines.points)
    before[:, 1:], after[:, :-1] = step, step
    before[:, lines.first] = after[:, lines.last] = 0.0
    first, last = lines.first[lines.closed], lines.last[lines.closed]
    before[:, first], after[:, last] = before[:, last], after[:, first]
    return before, after


def _chords(lines: FitLines, window: Floats, stops: Bools) -> tuple[Floats, Floats]:
    """(d,n) vectors from the point that lies a window before, and to the one after, none beyond a stop."""
    everything = np.arange(len(lines.line))
    reach = window[lines.line]
    before = _neighbour(lines, everything, -reach, stops)
    after = _neighbour(lines, everything, reach, stops)
    return lines.points - lines.points[:, before], lines.points[:, after] - lines.points


def _neighbour(lines: FitLines, at: Ints, step: Floats, stops: Bools) -> Ints:
    """The nearest point not nearer than |step| along its line, but no point beyond a stop; at least the next one."""
    line = lines.line[at]
    start, end = lines.length[lines.first[line]], lines.length[lines.last[line]]
    total, loop = end - start, lines.closed[line]
    backwards = np.signbit(step)
    own = lines.length[at]
    slack = SLACK_OF_LENGTH * total
    place = own + step
    # In a loop the place may lie beyond the seam.
    low = np.where(loop, -np.inf, start)
    high = np.where(loop, np.inf, end)
    where = lines.length[stops]
    if len(where):
        left = np.searchsorted(where, own - slack, side="left") - 1
        right = np.searchsorted(where, own + slack, side="right")
        previous, following = where[np.maximum(left, 0)], where[np.minimum(right, len(where) - 1)]
        low = np.where((left >= 0) & (previous >= start), previous, _beyond(where, end, start, -total, low, loop))
        high = np.where(
            (right < len(where)) & (following <= end), following, _beyond(where, start, end, total, high, loop)
        )
    place = np.clip(place, low, high)
    wrapped = np.where(loop & backwards & (place < start + slack), place + total, place)
    wrapped = np.where(loop & ~backwards & (place > end - slack), place - total, wrapped)
    index = np.where(
        backwards,
        np.searchsorted(lines.length, wrapped + slack, side="right") - 1,
        np.searchsorted(lines.length, wrapped - slack, side="left"),
    )
    # A window of nothing means the very next point.
    stay = index == at
    index = np.where(stay & backwards, at - 1, np.where(stay, at + 1, index))
    index = np.where(loop & (index < lines.first[line]), lines.last[line] - 1, index)
    index = np.where(loop & (index > lines.last[line]), lines.first[line] + 1, index)
    return np.asarray(np.clip(index, lines.first[line], lines.last[line]), dtype=np.intp)


def _beyond(where: Floats, near: Floats, far: Floats, total: Floats, otherwise: Floats, loop: Bools) -> Floats:
    """The first stop beyond the seam of a loop, as a length that runs on; otherwise if the loop has none."""
    if not len(where):
        return otherwise
    if (total < 0).any():
        index = np.searchsorted(where, near, side="right") - 1
        found = where[np.maximum(index, 0)]
        there = loop & (index >= 0) & (found >= far)
    else:
        index = np.searchsorted(where, near, side="left")
        found = where[np.minimum(index, len(where) - 1)]
        there = loop & (index < len(where)) & (found <= far)
    return np.where(there, found + total, otherwise)


def _one_sided(
    lines: FitLines, at: Ints, side: float, stops: Bools, window: Floats, given: Floats, known: Bools
) -> Floats:
    """(d,k) tangents with which the line arrives at stops (side -1) or leaves them (1): those of circles through the
    next point with the tangent given there (2,d,n), where it is known (2,n), or through two more points."""
    reach = window[lines.line[at]]
    middle = _neighbour(lines, at, side * reach, stops)
    end = np.where(stops[middle], middle, _neighbour(lines, middle, side * reach, stops))
    first = side * (lines.points[:, middle] - lines.points[:, at])
    second = side * (lines.points[:, end] - lines.points[:, middle])
    chord = _unit(first)
    there = np.where(np.abs(second).sum(axis=0) > 0.0, _through(first, second), chord)
    facing = 0 if side > 0.0 else 1
    there = np.where(known[facing, middle], given[facing][:, middle], there)
    return _unit(2.0 * (chord * there).sum(axis=0) * chord - there)


def _through(before: Floats, after: Floats) -> Floats:
    """(d,n) unit tangents, at the middle point, of circles through three points with these chords."""
    one, two = np.sqrt((before * before).sum(axis=0)), np.sqrt((after * after).sum(axis=0))
    tangent = _unit(_unit(before) * two + _unit(after) * one)
    return np.where(np.abs(tangent).sum(axis=0) > 0.0, tangent, _unit(after))


def _unit(vectors: Floats) -> Floats:
    """(d,n) vectors of length 1; zero for those that are zero or not finite."""
    with np.errstate(all="ignore"):
        size = np.sqrt((vectors * vectors).sum(axis=0))
        good = np.isfinite(size) & (size > 0.0)
        return np.where(good, vectors / np.where(good, size, 1.0), 0.0)


def _cosine(one: Floats, two: Floats) -> Floats:
    """(n,) cosines of angles; 1 where a vector is zero."""
    first, second = _unit(one), _unit(two)
    there = (np.abs(first).sum(axis=0) > 0.0) & (np.abs(second).sum(axis=0) > 0.0)
    return np.where(there, (first * second).sum(axis=0), 1.0)
