"""Lines of a sheet that lie on others too, or on the same one again: in double curves, on common borders."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.holes import clipped
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import all_finite, dot, norm
from vectorplot.tolerances import APART_OF_DOMAIN, SETTLED_ON_SHEET, ZERO_OF_EXTENT
from vectorplot.visibility.smooth.curve_families import (
    Along,
    Chords,
    ConditionCurves,
    Family,
    FamilyOfPolynomials,
    ParameterCurves,
    SheetsMeet,
    StraightLines,
)
from vectorplot.visibility.smooth.sheets import OnParametrised, Sheets
from vectorplot.visibility.smooth.traced_curves import Curves, no_curves, together
from vectorplot.words import LineKind

NONE = -1

TESTED = (0.13, 0.31, 0.5, 0.71, 0.89)
"""Parts of a line, at one of which it must lie on another sheet for the rest of it to be looked at."""

ALONG_CHORD = (0.0, 0.25, 0.5, 0.75)
"""Parts of the chords of double curves and borders that lines are compared with."""

NEAREST = 8
"""So many of these places, at most, are looked from for other sheets at a point."""

FEWEST = 4
"""Lines with fewer points in a row on another sheet only cross or touch it."""

LAGS = (1, 2, 3)
"""How far the next point with a place on the other sheet may be: where sheets grow together or cross there are none, or
too many."""

ROUNDS = 12
"""Steps of Newton onto a sheet."""

JUMP = 0.2
"""Part of its domain by which the place on another sheet may change from point to point."""


@dataclass(frozen=True, eq=False)
class OnSecond:
    """Curves of a family that lie on a second sheet."""

    family: ParameterCurves | ConditionCurves
    sheets: Sheets
    second: int

    @property
    def sheet(self) -> int:
        """That of the family."""
        return self.family.sheet

    @property
    def rational(self) -> bool:
        """Whether there are weights."""
        return isinstance(self.family, FamilyOfPolynomials) and self.family.rational

    def degrees(self, chords: Chords) -> Ints:
        """(k,) of which degree the polynomials are; 0 where a chord is of no such curve."""
        if isinstance(self.family, FamilyOfPolynomials):
            return self.family.degrees(chords)
        return np.zeros(len(chords.level), dtype=np.intp)

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) what the polynomials are divided by at a part (k,) of chords."""
        return self.family.weights(chords, part) if isinstance(self.family, FamilyOfPolynomials) else np.ones(len(part))

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        found = self.family.between(chords, part)
        start, end = chords.second_places
        number = np.full(len(part), self.second)
        there, _ = _onto(self.sheets, number, start + part[:, None] * (end - start), found.points)
        return replace(found, second_places=there)


@dataclass(frozen=True, eq=False)
class Stretches:
    """Stretches of curves that lie on a further sheet: curves, of which that is the second one; point (n,): the point
    of the curves that each of theirs is."""

    curves: Curves
    point: Ints

    def of_chords(self, chord: Ints) -> tuple[Ints, Ints]:
        """Which of the chords (k,) of curves lie on further sheets, as often as they do, and as which chords of the
        stretches."""
        own = self.curves.chords
        own = own[np.argsort(self.point[own], kind="stable")]
        first = np.searchsorted(self.point[own], chord)
        sizes = np.searchsorted(self.point[own], chord, side="right") - first
        return ragged.owner(sizes), own[ragged.ranges(first, sizes)]


def no_stretches() -> Stretches:
    """None at all."""
    return Stretches(no_curves(), np.zeros(0, dtype=np.intp))


def with_other_sheets(curves: Curves, borders: Curves, sheets: Sheets) -> tuple[Curves, Stretches]:
    """The curves, those that lie on a double curve, or on a border, of sheets that hide, all along, with a second
    sheet; and their stretches on further sheets, and on others in part.

    borders: the edges of sheets, those that are no borders among them. Edge cases: stretches between the parts of a
    line that are tested are not found.
    """
    alone, double = (
        np.array([*(isinstance(f, kinds) for f in curves.families), False])[curves.family]
        for kinds in (ParameterCurves | ConditionCurves, SheetsMeet)
    )
    alone &= curves.second_sheet < 0
    which = np.flatnonzero((alone | double) & (curves.sheet >= 0) & (curves.kind != LineKind.CONTOUR))
    places = _double_places(curves, borders, sheets)
    if not len(which) or not len(places.number):
        return curves, no_stretches()
    row, _, _ = _others(curves, *_at_parts(curves, which), sheets, places)
    hits = np.bincount(np.unique(row) // len(TESTED), minlength=len(which))
    # Straight lines have few points: between these the parts that are tested say whether they lie on the sheet.
    which = which[hits >= np.where(np.diff(curves.offsets)[which] < FEWEST, len(TESTED), 1)]
    on = _stretches(curves, which, sheets, places)
    whole = np.flatnonzero(alone[on.of] & (on.sizes == np.diff(curves.offsets)[on.of]))
    _, first = np.unique(on.of[whole], return_index=True)
    rest = np.delete(np.arange(len(on.of)), whole[first])
    return _with_seconds(curves, on.take(whole[first]), sheets), _further(curves, on.take(rest), sheets)


def _at_parts(curves: Curves, which: Ints) -> tuple[Along, Ints]:
    """Points (k,) of some curves, and the curves that they are of."""
    count = np.diff(curves.offsets)[which] - 1
    at = np.multiply.outer(count, np.array(TESTED)).ravel()
    step = at.astype(np.intp)
    chord = np.repeat(curves.offsets[which], len(TESTED)) + step
    return curves.at(chord, at - step), np.repeat(which, len(TESTED))


@dataclass(frozen=True, eq=False)
class _Doubles:
    """Places (k,3) on sheets (k,) at which there may be a second one, their points, and how far it is to the next."""

    points: Floats
    number: Ints
    places: Floats
    gap: Floats

    def found(self, sheets: Sheets, points: Floats) -> tuple[Ints, Ints, Floats]:
        """Which points (n,3) lie on sheets that come by there, on which and where, once each; the nearest first."""
        from scipy.spatial import cKDTree

        reach = float(self.gap.max())
        distance, nearest = cKDTree(self.points).query(points, k=NEAREST, distance_upper_bound=reach)
        row, column = np.nonzero(distance <= np.append(self.gap, -1.0)[nearest])
        at = nearest[row, column]
        number = self.number[at]
        there, off = _onto(sheets, number, self.places[at], points[row])
        good = off <= ZERO_OF_EXTENT
        row, number, there = row[good], number[good], there[good]
        new = np.ones(len(row), dtype=np.bool_)
        for lag in range(1, NEAREST):
            at = lag + np.flatnonzero((row[lag:] == row[:-lag]) & (number[lag:] == number[:-lag]))
            new[at] &= sheets.apart(number[at], there[at], there[at - lag]) > APART_OF_DOMAIN
        return row[new], number[new], there[new]


def _others(curves: Curves, at: Along, of: Ints, sheets: Sheets, known: _Doubles) -> tuple[Ints, Ints, Floats]:
    """Which points of curves (n,) lie on sheets other than those of the curves, on which and where."""
    row, number, there = known.found(sheets, at.points)
    other = np.ones(len(row), dtype=np.bool_)
    for own, places in ((curves.sheet, at.places), (curves.second_sheet, at.second_places)):
        same = np.flatnonzero(number == own[of[row]])
        other[same] &= sheets.apart(number[same], there[same], places[row[same]]) > APART_OF_DOMAIN
    return row[other], number[other], there[other]


def _double_places(curves: Curves, borders: Curves, sheets: Sheets) -> _Doubles:
    """Places on double curves, on both sheets, and on borders."""
    lines = together(
        [
            borders.take(np.flatnonzero(borders.kind == LineKind.BOUNDARY)),
            curves.take(np.flatnonzero((curves.kind == LineKind.INTERSECTION) & (curves.second_sheet >= 0))),
        ]
    )
    chord = np.repeat(lines.chords, len(ALONG_CHORD))
    at, of = lines.at(chord, np.tile(ALONG_CHORD, len(lines.chords))), lines.owner[chord]
    long = norm(lines.points[chord + 1] - lines.points[chord]) / (len(ALONG_CHORD) - 1)
    points, number = np.tile(at.points, (2, 1)), np.concatenate([lines.sheet[of], lines.second_sheet[of]])
    places, gap = np.concatenate([at.places, at.second_places]), np.tile(long, 2)
    kept = np.append(sheets.hides, False)[number] & all_finite(points) & all_finite(places)
    return _Doubles(points[kept], number[kept], places[kept], gap[kept])


@dataclass(frozen=True, eq=False)
class _On:
    """Stretches (s,) of curves on other sheets: of which curves, on which sheets, how many points, the first of them;
    and the places of all the points on the sheets."""

    of: Ints
    number: Ints
    sizes: Ints
    first: Ints
    places: Floats

    def take(self, which: Ints) -> _On:
        """Some of them."""
        index, _ = ragged.take(ragged.offsets(self.sizes), which)
        return _On(self.of[which], self.number[which], self.sizes[which], self.first[which], self.places[index])


def _stretches(curves: Curves, which: Ints, sheets: Sheets, known: _Doubles) -> _On:
    """Those of some curves: points that follow each other, with places on one sheet that do."""
    index, _ = ragged.take(curves.offsets, which)
    at = Along(curves.places[index], curves.points[index], np.zeros((0, 3)), curves.second_places[index])
    row, number, there = _others(curves, at, curves.owner[index], sheets, known)
    point = index[row]
    chain, count = _chains(curves, point, number, there, sheets)
    order = np.lexsort((point, chain))
    enough = np.minimum(FEWEST, np.diff(curves.offsets)[curves.owner[point]])
    order = order[(count[chain] >= enough)[order]]
    point, number, there, chain = point[order], number[order], there[order], chain[order]
    begin = np.flatnonzero(np.diff(chain, prepend=-1))
    of, number = curves.owner[point[begin]], number[begin]
    # The next point on either side too, if the sheet goes so far: where sheets grow together there is no other place.
    first = np.maximum(point[begin] - 1, curves.offsets[of])
    last = np.minimum(np.maximum.reduceat(point, begin) + 1 if len(begin) else begin, curves.offsets[of + 1] - 1)
    sizes = last + 1 - first
    offsets, owner, all_points = ragged.offsets(sizes), ragged.owner(sizes), ragged.ranges(first, sizes)
    places = np.full((len(all_points), 3), np.nan)
    stretch = ragged.owner(np.diff(np.append(begin, len(chain))))
    places[offsets[stretch] + point - first[stretch]] = there
    places = _filled(sheets, number[owner], places, curves.points[all_points], offsets)
    away = curves.points[all_points] - sheets.points(number[owner], places)
    ends = np.zeros(len(all_points), dtype=np.bool_)
    ends[offsets[:-1]], ends[offsets[1:] - 1] = True, True
    kept = ~ends | (norm(away) <= ZERO_OF_EXTENT)
    sizes = np.bincount(owner[kept], minlength=len(sizes))
    return _On(of, number, sizes, first + ~kept[offsets[:-1]], places[kept])


def _chains(curves: Curves, point: Ints, number: Ints, places: Floats, sheets: Sheets) -> tuple[Ints, Ints]:
    """(k,) the chain that each place of a point of a curve on a sheet is of, from every place to the nearest of the
    next point, if each is the nearest of the other; and how many places chains have."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    after, before = np.full(len(point), NONE), np.full(len(point), NONE)
    for lag in LAGS:
        first = np.searchsorted(point, point + lag)
        sizes = np.searchsorted(point, point + lag, side="right") - first
        one, two = ragged.owner(sizes), ragged.ranges(first, sizes)
        fits = (after[one] == NONE) & (before[two] == NONE) & (number[one] == number[two])
        fits &= curves.owner[point[one]] == curves.owner[point[two]]
        one, two = one[fits], two[fits]
        apart = sheets.apart(number[one], places[two], places[one])
        nearest = np.full((2, len(point)), JUMP)
        np.minimum.at(nearest[0], one, apart)
        np.minimum.at(nearest[1], two, apart)
        linked = (apart <= nearest[0, one]) & (apart <= nearest[1, two])
        after[one[linked]], before[two[linked]] = two[linked], one[linked]
    linked = np.flatnonzero(after != NONE)
    pairs = coo_array((np.ones(len(linked)), (linked, after[linked])), shape=(len(point), len(point)))
    _, chain = connected_components(pairs, directed=False)
    return chain, np.bincount(chain)


def _with_seconds(curves: Curves, on: _On, sheets: Sheets) -> Curves:
    """The curves, those that lie on other sheets all along with these as their second ones."""
    index, _ = ragged.take(curves.offsets, on.of)
    second_places, second_sheet, family = curves.second_places.copy(), curves.second_sheet.copy(), curves.family.copy()
    second_places[index], second_sheet[on.of] = on.places, on.number
    family[on.of], new = _families(curves, on, sheets)
    return replace(
        curves,
        second_places=second_places,
        second_sheet=second_sheet,
        family=family,
        families=(*curves.families, *new),
    )


def _further(curves: Curves, on: _On, sheets: Sheets) -> Stretches:
    """The stretches as curves of which the other sheet is the second one."""
    if not len(on.of):
        return no_stretches()
    point = ragged.ranges(on.first, on.sizes)
    family, new = _families(curves, on, sheets)
    lines = replace(
        curves.take(on.of),
        points=curves.points[point],
        places=curves.places[point],
        second_places=on.places,
        offsets=ragged.offsets(on.sizes),
        closed=np.zeros(len(on.of), dtype=np.bool_),
        family=family,
        families=(*curves.families, *new),
        second_sheet=on.number,
    )
    return Stretches(lines, point)


def _families(curves: Curves, on: _On, sheets: Sheets) -> tuple[Ints, list[Family]]:
    """The families of stretches, numbered after those of the curves, and these families."""
    both = np.stack([curves.family[on.of], on.number], axis=1)
    sorts, sort = np.unique(both, axis=0, return_inverse=True)
    new = [_on_second(curves.families[old], sheets, number) for old, number in sorts.tolist()]
    return len(curves.families) + sort.ravel(), new


def _on_second(family: Family, sheets: Sheets, number: int) -> Family:
    """What a family becomes with another second sheet."""
    if isinstance(family, SheetsMeet):
        other = sheets.groups[int(sheets.group[number])].as_one
        return replace(family, other=other, second=number) if isinstance(other, OnParametrised) else StraightLines()
    assert isinstance(family, ParameterCurves | ConditionCurves)
    return OnSecond(family, sheets, number)


def _filled(sheets: Sheets, number: Ints, places: Floats, points: Floats, offsets: Ints) -> Floats:
    """The places (n,3) of points of lines on sheets (n,), unknown ones found from those beside them."""
    known = np.isfinite(places[:, 0])
    first, numbers = np.repeat(offsets[:-1], np.diff(offsets)), np.arange(len(known))
    before = np.maximum.accumulate(np.where(known, numbers, -1))
    after = np.minimum.accumulate(np.where(known, numbers, len(known) - 1)[::-1])[::-1]
    result = places[np.where(before >= first, before, after)]
    result[~known] = _onto(sheets, number[~known], result[~known], points[~known])[0]
    return result


def _onto(sheets: Sheets, number: Ints, places: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Places (k,3) on sheets (k,) nearest to points, from places near them, and the distances (k,)."""
    away = points - sheets.points(number, places)
    for _ in range(ROUNDS):
        if not (dot(away, away) > SETTLED_ON_SHEET**2).any():
            break
        moved = _within(sheets, number, sheets.moved(number, places, away))
        places = np.where(all_finite(moved)[:, None], moved, places)
        away = points - sheets.points(number, places)
    return places, norm(away)


def _within(sheets: Sheets, number: Ints, places: Floats) -> Floats:
    """The places (k,3) on sheets (k,), those beyond open borders on these."""
    result, group = places.copy(), sheets.group[number]
    for one in np.unique(group).tolist():
        sheet, which = sheets.groups[one].as_one, np.flatnonzero(group == one)
        if isinstance(sheet, OnParametrised):
            result[which] = clipped(sheet.surface_at(places[which]).domain, places[which])
    return result
