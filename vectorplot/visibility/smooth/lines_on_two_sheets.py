"""Lines of a sheet that lie on a second one too, or on the same one again: in a double curve, on a common border."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import all_finite, dot, norm
from vectorplot.tolerances import APART_OF_DOMAIN, SETTLED_ON_SHEET, ZERO_OF_EXTENT
from vectorplot.visibility.smooth.curve_families import (
    Along,
    Chords,
    ConditionCurves,
    FamilyOfPolynomials,
    ParameterCurves,
)
from vectorplot.visibility.smooth.sheets import OnParametrised, Sheets
from vectorplot.visibility.smooth.traced_curves import Curves, together
from vectorplot.words import LineKind

NONE = -1

TESTED = (0.13, 0.31, 0.5, 0.71, 0.89)
"""Parts of a line at which it must lie on the second sheet for the rest of it to be looked at."""

ALONG_CHORD = (0.0, 0.25, 0.5, 0.75)
"""Parts of the chords of double curves and borders that lines are compared with."""

NEAREST = 8
"""Of so many of these places the one is taken at which a second sheet is found."""

ROUNDS = 12
"""Steps of Newton onto a sheet."""

JUMP = 0.2
"""Part of its domain by which the place on the second sheet may change from point to point."""


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


def with_second_sheets(curves: Curves, borders: Curves, sheets: Sheets) -> Curves:
    """The curves; those that lie on a double curve, or on a border, of sheets that hide, all along, know the second
    sheet.

    borders: the edges of sheets, those that are no borders among them. Edge cases: a line that lies on a second sheet
    in part, and one whose second place jumps, stays as it is.
    """
    families = [isinstance(f, ParameterCurves | ConditionCurves) and f.second == NONE for f in curves.families]
    alone = np.array([*families, False])[curves.family] & (curves.sheet >= 0) & (curves.second_sheet < 0)
    which = np.flatnonzero(alone & (curves.kind != LineKind.CONTOUR))
    places = _double_places(curves, borders, sheets)
    if not len(which) or not len(places.number):
        return curves
    tested = _at_parts(curves, which)
    row, number, _ = places.found(sheets, *tested)
    # Each line has one second sheet: that of its middle.
    middle = np.full(len(which), NONE)
    at_middle = row % len(TESTED) == len(TESTED) // 2
    middle[row[at_middle][::-1] // len(TESTED)] = number[at_middle][::-1]
    good = number == middle[row // len(TESTED)]
    hits = np.bincount(np.unique(row[good]) // len(TESTED), minlength=len(which))
    doubled = np.flatnonzero(hits == len(TESTED))
    if not len(doubled):
        return curves
    which, second = which[doubled], middle[doubled]
    return _with_places(curves, which, second, sheets, places)


def _at_parts(curves: Curves, which: Ints) -> tuple[Floats, Ints, Floats]:
    """Points (k,3) of some curves, their sheets and places."""
    count = np.diff(curves.offsets)[which] - 1
    at = np.multiply.outer(count, np.array(TESTED)).ravel()
    step = at.astype(np.intp)
    chord = np.repeat(curves.offsets[which], len(TESTED)) + step
    found = curves.at(chord, at - step)
    return found.points, np.repeat(curves.sheet[which], len(TESTED)), found.places


@dataclass(frozen=True, eq=False)
class _Doubles:
    """Places (k,3) on sheets (k,) at which there may be a second one, their points, and how far it is to the next."""

    points: Floats
    number: Ints
    places: Floats
    gap: Floats

    def found(self, sheets: Sheets, points: Floats, own: Ints, own_places: Floats) -> tuple[Ints, Ints, Floats]:
        """Which points, on sheets (n,) at places (n,3), lie on a second one, on which and where; the nearest first."""
        from scipy.spatial import cKDTree

        reach = float(self.gap.max())
        distance, nearest = cKDTree(self.points).query(points, k=NEAREST, distance_upper_bound=reach)
        row, column = np.nonzero(distance <= np.append(self.gap, -1.0)[nearest])
        at = nearest[row, column]
        number = self.number[at]
        there, off = _onto(sheets, number, self.places[at], points[row])
        good = off <= ZERO_OF_EXTENT
        same = np.flatnonzero(number == own[row])
        good[same] &= sheets.apart(number[same], there[same], own_places[row[same]]) > APART_OF_DOMAIN
        return row[good], number[good], there[good]


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


def _with_places(curves: Curves, which: Ints, second: Ints, sheets: Sheets, known: _Doubles) -> Curves:
    """The curves, those of these with their places on second sheets (k,)."""
    index, offsets = ragged.take(curves.offsets, which)
    owner = ragged.owner(np.diff(offsets))
    number = second[owner]
    row, of, there = known.found(sheets, curves.points[index], curves.sheet[curves.owner[index]], curves.places[index])
    right = of == number[row]
    row, there = row[right], there[right]
    places = np.full((len(index), 3), np.nan)
    places[row[::-1]] = there[::-1]
    # Where there are several, as where double curves cross, the line goes on as beside; so it does into poles.
    other = sheets.apart(number[row], there, places[row]) > APART_OF_DOMAIN
    places[row[other]] = np.nan
    points = curves.points[index]
    places = _filled(sheets, number, places, points, offsets)
    jumps = _jumps(sheets, number, places, offsets)
    places[jumps], places[jumps + 1] = np.nan, np.nan
    places = _filled(sheets, number, places, points, offsets)
    good = np.ones(len(which), dtype=np.bool_)
    good[owner[_jumps(sheets, number, places, offsets)]] = False
    chosen = good[owner]
    second_places, second_sheet, family = curves.second_places.copy(), curves.second_sheet.copy(), curves.family.copy()
    second_places[index[chosen]] = places[chosen]
    second_sheet[which[good]] = second[good]
    sorts, sort = np.unique(np.stack([family[which[good]], second[good]], axis=1), axis=0, return_inverse=True)
    family[which[good]] = len(curves.families) + sort.ravel()
    new = [OnSecond(curves.families[old], sheets, number) for old, number in sorts.tolist()]
    return replace(
        curves,
        second_places=second_places,
        second_sheet=second_sheet,
        family=family,
        families=(*curves.families, *new),
    )


def _filled(sheets: Sheets, number: Ints, places: Floats, points: Floats, offsets: Ints) -> Floats:
    """The places (n,3) of points of lines on sheets (n,), unknown ones found from those beside them."""
    known = np.isfinite(places[:, 0])
    first, numbers = np.repeat(offsets[:-1], np.diff(offsets)), np.arange(len(known))
    before = np.maximum.accumulate(np.where(known, numbers, -1))
    after = np.minimum.accumulate(np.where(known, numbers, len(known) - 1)[::-1])[::-1]
    result = places[np.where(before >= first, before, after)]
    result[~known] = _onto(sheets, number[~known], result[~known], points[~known])[0]
    return result


def _jumps(sheets: Sheets, number: Ints, places: Floats, offsets: Ints) -> Ints:
    """The points of lines, from which their places (n,3) on sheets (n,) jump to the next."""
    jumps = ~(sheets.apart(number[1:], places[1:], places[:-1]) <= JUMP)
    jumps[offsets[1:-1] - 1] = False
    return np.flatnonzero(jumps)


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
            domain = sheet.surface_at(places[which]).domain
            if not domain.closed_u:
                result[which, 0] = np.clip(places[which, 0], domain.u_start, domain.u_end)
            if not domain.closed_v:
                result[which, 1] = np.clip(places[which, 1], domain.v_start, domain.v_end)
    return result
