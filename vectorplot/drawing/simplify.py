"""Strokes with fewer points."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import world_per_mm
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import with_points
from vectorplot.tolerances import ZERO_OF_EXTENT

_ROUNDS = 6
_DENSE = 32
"""After so many rounds, a chord that still replaces more points than this is split in its middle too: a spiral, whose
farthest points lie at its end, would take a round for every turn."""

_SAMPLE = 16
_MANY = 2048
"""Of more candidates than this, every sixteenth is looked at first: the many rounds that a smooth curve takes are cheap
on these, and leave little to do for all."""

_SAMPLE_TOLERANCE = 0.95
"""Between the points of the sample others lie a little further away."""


def without_collinear_points(paths: Paths, tolerance_mm: float) -> Paths:
    """The same strokes without points on the straight line between their neighbours: each is within tolerance_mm of the
    segment in its place, on the page and, to scale, in the world; along it they only go forward. A closed stroke
    begins at its first point that stays. Strokes with known Bézier curves keep all points unless they are straight.
    Edge cases: of repeated points one stays; a closed stroke of two points becomes open; strokes of fewer than three
    points stay. Source: Douglas and Peucker, Cartographica 10 (1973), between the points that must stay.
    """
    straight = _goes_straight(paths, tolerance_mm) if len(paths.points) else np.zeros(0, dtype=np.bool_)
    if not straight.any():
        return paths
    counts = np.diff(paths.offsets)
    some = np.flatnonzero(np.bincount(np.searchsorted(paths.offsets, np.flatnonzero(straight), side="right") - 1))
    source, line = _laid_out(paths, some, straight)
    kept = ~straight[source]
    kept[line.offsets[:-1]] = kept[line.offsets[1:] - 1] = True
    _thin(line, kept, tolerance_mm)
    _keep_cubics(kept, line.offsets, np.asarray(np.isfinite(paths.handles[source]).any(axis=1)))
    stays = np.ones(len(paths.points), dtype=np.bool_)
    stays[source[~kept]] = False
    left = counts.copy()
    left[some] = np.add.reduceat(kept.astype(np.intp), line.offsets[:-1]) - paths.closed[some]
    fewer = with_points(paths, np.flatnonzero(stays), np.arange(len(paths)), ragged.offsets(left))
    return replace(fewer, closed=paths.closed & ((left > 2) | (left == counts)))


def _goes_straight(paths: Paths, tolerance_mm: float) -> Bools:
    """(p,) whether each point lies between its neighbours, or on one; False for the ends of open strokes."""
    inner, before, after = _inner_points(paths)
    (into_x, out_x), (into_y, out_y) = (
        (here - column.take(before), column.take(after) - here)
        for column, here in ((column, column.take(inner)) for column in paths.points.T)
    )
    good: Bools = into_x * out_x + into_y * out_y >= 0.0
    area = into_x * out_y - into_y * out_x
    chord_x, chord_y = into_x + out_x, into_y + out_y
    good &= area * area <= tolerance_mm * tolerance_mm * (chord_x * chord_x + chord_y * chord_y)
    # Whether a step of no length goes on or back is seen along the chord only.
    zero = (ZERO_OF_EXTENT * _extent(paths)) ** 2
    good |= (into_x * into_x + into_y * into_y <= zero) | (out_x * out_x + out_y * out_y <= zero)
    straight = np.zeros(len(paths.points), dtype=np.bool_)
    straight[inner.compress(good)] = True
    return straight


def _inner_points(paths: Paths) -> tuple[Ints, Ints, Ints]:
    """(n,) the points that have neighbours on both sides, and these; the last point of a closed stroke joins the
    first."""
    counts = np.diff(paths.offsets)
    drawn = counts > 0
    first, last = paths.offsets[:-1][drawn], paths.offsets[1:][drawn] - 1
    ring = paths.closed[drawn] & (counts[drawn] > 2)
    has_two = np.ones(len(paths.points), dtype=np.bool_)
    has_two[first[~ring]] = has_two[last[~ring]] = False
    inner = np.flatnonzero(has_two)
    before, after = inner - 1, inner + 1
    first, last = first[ring], last[ring]
    before[np.searchsorted(inner, first)], after[np.searchsorted(inner, last)] = last, first
    return inner, before, after


def _extent(paths: Paths) -> float:
    return float(max(np.ptp(axis) for axis in paths.points.T))


@dataclass(frozen=True, eq=False)
class _Line:
    """Strokes as open ones; a closed one repeats its first point. page, world: the coordinates, one array for each
    axis; ring (m,): was closed; zero: a length on the page that is rounding."""

    page: tuple[Floats, ...]
    world: tuple[Floats, ...]
    offsets: Ints
    ring: Bools
    zero: float
    world_per_mm: float


def _laid_out(paths: Paths, some: Ints, straight: Bools) -> tuple[Ints, _Line]:
    """The points of some strokes in the order of the line, and the line. Closed strokes begin at a point that stays, if
    there is one."""
    first, counts, ring = paths.offsets[:-1][some], np.diff(paths.offsets)[some], paths.closed[some]
    stays = np.append(np.flatnonzero(~straight), len(straight))
    begin = stays[np.searchsorted(stays, first)]
    begin = np.where(ring & (begin < first + counts), begin, first)
    offsets = ragged.offsets(counts + ring)
    source = ragged.ranges(begin, counts + ring)
    over = np.flatnonzero(begin + counts + ring > first + counts)
    again = ragged.ranges(offsets[over] + (first + counts - begin)[over], (begin - first + ring)[over])
    source[again] -= np.repeat(counts[over], (begin - first + ring)[over])
    page, world = (
        tuple(np.ascontiguousarray(axis[source]) for axis in points.T) for points in (paths.points, paths.points3d)
    )
    return source, _Line(page, world, offsets, ring, ZERO_OF_EXTENT * _extent(paths), world_per_mm(paths) or 1.0)


def _keep_cubics(kept: Bools, offsets: Ints, known: Bools) -> None:
    """Keep all points of strokes that are not straight and of which handles are known (p,): these belong to the chords
    between all of them."""
    bent = np.add.reduceat(kept.astype(np.intp), offsets[:-1]) > 2
    kept |= np.repeat(bent & np.logical_or.reduceat(known, offsets[:-1]), np.diff(offsets))


def _thin(line: _Line, kept: Bools, tolerance_mm: float) -> None:
    """Keep of the points not kept yet what their chords do not replace."""
    left_out = np.flatnonzero(~kept)
    if len(left_out) > _MANY:
        _keep_what_is_far(line, kept, left_out[::_SAMPLE], _SAMPLE_TOLERANCE * tolerance_mm)
        left_out = np.flatnonzero(~kept)
    while len(left_out):
        _keep_what_is_far(line, kept, left_out, tolerance_mm)
        left_out = _keep_where_it_turns_back(line, kept, left_out[~kept[left_out]])


@dataclass(frozen=True, eq=False)
class _Chords:
    """Points left out, in the order of the line, and the chords that replace them.

    left_out (n,); chord k replaces size[k] of them from begin[k] on, and goes from point before[k] to after[k].
    """

    left_out: Ints
    begin: Ints
    size: Ints
    before: Ints
    after: Ints

    def only(self, which: Bools) -> _Chords:
        """Some of the chords."""
        size = self.size[which]
        left_out = self.left_out[np.repeat(which, self.size)]
        return _Chords(left_out, ragged.starts(size), size, self.before[which], self.after[which])


def _chords(kept: Bools, left_out: Ints) -> _Chords:
    stays = np.flatnonzero(kept)
    if len(stays) < len(left_out):
        bounds = np.searchsorted(left_out, stays)
        chord = np.flatnonzero(np.diff(bounds))
        begin, size = bounds[chord], np.diff(bounds)[chord]
    else:
        place = np.searchsorted(stays, left_out) - 1
        begin = np.flatnonzero(np.concatenate(([True], place[1:] != place[:-1])))
        chord, size = place[begin], np.diff(np.append(begin, len(place)))
    return _Chords(left_out, begin, size, stays[chord], stays[chord + 1])


def _keep_what_is_far(line: _Line, kept: Bools, left_out: Ints, tolerance_mm: float) -> None:
    """Keep of the points between kept ones the farthest, until all lie within the tolerance of what replaces them."""
    rounds = 0
    while len(left_out):
        at = _chords(kept, left_out)
        away = _square_distance(line.page, at)
        split = np.maximum.reduceat(away, at.begin) > _least_square(line, at, tolerance_mm)
        farthest = _farthest(at, away, split)
        # What is near on the page may be far in the world.
        near = at.only(~split)
        if len(near.size):
            away = _square_distance(line.world, near)
            deep = np.maximum.reduceat(away, near.begin) > (tolerance_mm * line.world_per_mm) ** 2
            farthest = np.concatenate((farthest, _farthest(near, away, deep)))
            split[~split] = deep
        kept[farthest] = True
        if rounds >= _ROUNDS:
            dense = split & (at.size > _DENSE)
            kept[left_out[at.begin[dense] + at.size[dense] // 2]] = True
        left_out = at.only(split).left_out
        left_out = left_out[~kept[left_out]]
        rounds += 1


def _least_square(line: _Line, at: _Chords, tolerance_mm: float) -> Floats:
    """(k,) the square of the distance that points may have from each chord: of a chord without direction, rounding
    only, and of a whole ring nothing, as its farthest point stays in any case."""
    least = np.full(len(at.size), tolerance_mm * tolerance_mm)
    none = np.flatnonzero(sum((c[at.after] - c[at.before]) ** 2 for c in line.page) <= line.zero**2)
    stroke = np.searchsorted(line.offsets, at.before[none], side="right") - 1
    first, last = line.offsets[stroke], line.offsets[stroke + 1] - 1
    whole = line.ring[stroke] & (at.before[none] == first) & (at.after[none] == last)
    least[none] = np.where(whole, -1.0, line.zero**2)
    return least


def _farthest(at: _Chords, away: Floats, split: Bools) -> Ints:
    """The first of the farthest points of each chord that is split."""
    away = away[np.repeat(split, at.size)]
    parts = at.only(split)
    if not len(parts.size):
        return parts.left_out
    chord = ragged.owner(parts.size)
    most = np.flatnonzero(away == np.maximum.reduceat(away, parts.begin)[chord])
    chord = chord[most]
    return parts.left_out[most[np.concatenate(([True], chord[1:] != chord[:-1]))]]


def _keep_where_it_turns_back(line: _Line, kept: Bools, left_out: Ints) -> Ints:
    """Keep both ends of every step that goes back along the chord that replaces it; the points left out that have new
    chords now."""
    if not len(left_out):
        return left_out
    at = _chords(kept, left_out)
    _, _, along, length = _along(line.page, at)
    # On the way into each point, and out of the last one of each chord.
    gain = np.diff(along, prepend=0.0)
    gain[at.begin] = along[at.begin]
    last = at.begin + at.size - 1
    back = np.flatnonzero(gain < -line.zero)
    over = last[length - along[last] < -line.zero]
    if not len(back) + len(over):
        return left_out[:0]
    kept[left_out[back]] = kept[left_out[back] - 1] = kept[left_out[over]] = True
    split = np.logical_or.reduceat(kept[left_out], at.begin)
    left_out = at.only(split).left_out
    return left_out[~kept[left_out]]


def _along(columns: tuple[Floats, ...], at: _Chords) -> tuple[list[Floats], list[Floats], Floats, Floats]:
    """Of the points left out: the way from the beginnings of their chords, the directions of these, how far along them
    the points lie; and (k,) the lengths of the chords."""
    chord = [c[at.after] - c[at.before] for c in columns]
    length = np.sqrt(sum(c * c for c in chord))
    some = np.where(length > 0.0, length, 1.0)
    unit = [np.repeat(c / some, at.size) for c in chord]
    arm = [c[at.left_out] - np.repeat(c[at.before], at.size) for c in columns]
    along: Floats = sum(a * u for a, u in zip(arm, unit, strict=True)) + np.zeros(1)
    return arm, unit, along, length


def _square_distance(columns: tuple[Floats, ...], at: _Chords) -> Floats:
    """(n,) from the points left out to their chords, squared."""
    arm, unit, along, length = _along(columns, at)
    along = np.minimum(np.maximum(along, 0.0), np.repeat(length, at.size))
    away = np.zeros(len(along))
    for a, u in zip(arm, unit, strict=True):
        u *= along
        u -= a
        u *= u
        away += u
    return away
