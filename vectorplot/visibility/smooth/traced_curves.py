"""All curves of a scene with smooth surfaces: polylines of which every point is exact, and what they are between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import bernstein, cubic_error, places
from vectorplot.features.conditions import ImplicitSection
from vectorplot.features.curve_tracing import SurfaceCurves
from vectorplot.features.surface_singularities import ThroughPinchPoints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements, closed_round, joined
from vectorplot.geometry.records import APART, Elements
from vectorplot.geometry.vectors import all_components, all_finite, any_component, cross, dot, from_components, norm
from vectorplot.scene.view import View
from vectorplot.tolerances import BESIDE_STANDSTILL, LEAST_DIVISOR, SAME_DIRECTION_SINE
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import (
    Along,
    Chords,
    ConditionCurves,
    DirectedCurves,
    FaceCurves,
    Family,
    FamilyOfPolynomials,
    ParameterCurves,
    RimCurves,
    SheetsMeet,
    TrimCurves,
    joined_chords,
)
from vectorplot.visibility.smooth.sheets import OnParametrised, ParametricSheet, Sheets, StackedSheets
from vectorplot.words import LineKind


def _none() -> Ints:
    return np.zeros(0, dtype=np.intp)


@dataclass(frozen=True, eq=False)
class Curves(LineElements):
    """Polylines in the view's coordinates.

    points (n,3); places (n,3) of them on their sheets; second_places (n,3) those on a second sheet, of curves in which
    two sheets meet; of those in faces of a mesh the normal of the face in which the chord from the point lies; of those
    with known directions these; else NaN; offsets (m+1,); closed (m,): the last point is the first again, its place
    whole periods away; kind (m,) LineKind values; item (m,); family (m,) indices into families; level (m,) the value
    that the condition of its family has along a curve; side (m,): of an outline 1 or -1 where its surface lies to its
    left or right and that is known already, else 0; behind (m,): by how many items it is hidden already; sheet (m,):
    the sheet that it lies on, -1 for straight lines, and second_sheet (m,) another one, or -1: as its family says, if
    not given; lamp (m,): whose light ends there, by number, 0 for other curves.
    """

    points: Floats = field(metadata=EACH_POINT)
    places: Floats = field(metadata=EACH_POINT)
    second_places: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    kind: Ints = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)
    family: Ints = field(metadata=EACH_LINE)
    level: Floats = field(metadata=EACH_LINE)
    families: tuple[Family, ...]
    side: Ints = field(default_factory=_none, metadata=EACH_LINE)
    behind: Ints = field(default_factory=_none, metadata=EACH_LINE)
    sheet: Ints = field(default_factory=_none, metadata=EACH_LINE)
    second_sheet: Ints = field(default_factory=_none, metadata=EACH_LINE)
    lamp: Ints = field(default_factory=_none, metadata=EACH_LINE)

    def __post_init__(self) -> None:
        for name, of_family in (("sheet", "sheet"), ("second_sheet", "second")):
            if len(self) and not len(getattr(self, name)):
                values = np.array([*(getattr(family, of_family) for family in self.families), -1], dtype=np.intp)
                object.__setattr__(self, name, values[self.family])
        for name in ("side", "behind", "lamp"):
            if not len(getattr(self, name)):
                object.__setattr__(self, name, np.zeros(len(self), dtype=np.intp))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @cached_property
    def owner(self) -> Ints:
        """(n,) the curve of every point."""
        return ragged.owner(np.diff(self.offsets))

    @cached_property
    def chords(self) -> Ints:
        """(c,) the points at which chords begin: all but the last one of each curve."""
        first = np.ones(len(self.points), dtype=np.bool_)
        first[self.offsets[1:] - 1] = False
        return np.flatnonzero(first)

    def at(self, chord: Ints, part: Floats) -> Along:
        """The curves between two of their points: at the part (k,) of the chords that begin at the points chord (k,).

        A part a little below 0 or above 1 lies on the curve too, beyond the ends of the chord. Edge cases: over a hole
        of its surface, which may reach between two points of a curve, it is its chord.
        """
        return _between(self.families, self.chords_from(chord), self.family[self.owner[chord]], part)

    def with_exact_slopes(self, chord: Ints, part: Floats) -> Along:
        """The same for parts from 0 to 1, the directions of slopes those of the curves there.

        Inside of a chord those of at are off as the chord is off its curve. The point found ends a new chord, that to
        the farther end of the old one, at the ends of which slopes are exact.
        """
        found = self.at(chord, part)
        inner = np.flatnonzero((part > 0.0) & (part < 1.0))
        if len(inner):
            late = part[inner] > 0.5
            whole, to = self.chords_from(chord[inner]), found.take(inner)
            second = np.where(np.isfinite(to.second_places), to.second_places, whole.second_places[0])
            shorter = Chords(
                _with_end(whole.places, to.places, late),
                _with_end(whole.points, to.points, late),
                _with_end(whole.second_places, second, late),
                whole.level,
            )
            of = self.family[self.owner[chord[inner]]]
            again = _between(self.families, shorter, of, np.where(late, 1.0, 0.0))
            found.slopes[inner] = again.slopes / np.where(late, part[inner], 1.0 - part[inner])[:, None]
        return found

    def degrees(self, chord: Ints) -> tuple[Ints, Bools]:
        """(k,) of which degree the polynomials are that the chords which begin at these points (k,) belong to, 0 where
        they belong to none; and whether (k,) they are quotients of two."""
        family = self.family[self.owner[chord]]
        degree, rational = np.zeros(len(chord), dtype=np.intp), np.zeros(len(chord), dtype=np.bool_)
        for number in np.unique(family).tolist():
            curves = self.families[number]
            if isinstance(curves, FamilyOfPolynomials):
                which = np.flatnonzero(family == number)
                degree[which], rational[which] = curves.degrees(self.chords_from(chord[which])), curves.rational
        return degree, rational

    def weights(self, chord: Ints, part: Floats) -> Floats:
        """(k,) what the polynomials of chords are divided by at parts (k,) of them; 1 where there is nothing."""
        family, result = self.family[self.owner[chord]], np.ones(len(chord))
        for number in np.unique(family).tolist():
            curves = self.families[number]
            if isinstance(curves, FamilyOfPolynomials) and curves.rational:
                which = np.flatnonzero(family == number)
                result[which] = curves.weights(self.chords_from(chord[which]), part[which])
        return result

    def chords_from(self, begin: Ints) -> Chords:
        """The chords that begin at these points."""
        end = begin + 1
        places, points, second = (
            (x.take(begin, axis=0), x.take(end, axis=0)) for x in (self.places, self.points, self.second_places)
        )
        return Chords(places, points, second, self.level[self.owner[begin]])


def at_once(asked: Sequence[tuple[Curves, Ints, Floats]]) -> list[Along]:
    """What `Curves.at` says of several curves, each with its chords and parts: asked as one, for a few places take as
    long as many."""
    families: list[Family] = []
    number: dict[int, int] = {}
    of: list[Ints] = []
    for curves, chord, _ in asked:
        for family in curves.families:
            if number.setdefault(id(family), len(families)) == len(families):
                families.append(family)
        own = np.array([number[id(family)] for family in curves.families], dtype=np.intp)
        of.append(own[curves.family[curves.owner[chord]]])
    chords = joined_chords([curves.chords_from(chord) for curves, chord, _ in asked])
    found = _between(families, chords, np.concatenate(of), np.concatenate([part for _, _, part in asked]))
    ends = np.cumsum([0, *(len(chord) for _, chord, _ in asked)]).tolist()
    return [found.take(slice(first, end)) for first, end in pairwise(ends)]


def _between(families: Sequence[Family], chords: Chords, family: Ints, part: Floats) -> Along:
    """The curves of families (k,) at a part (k,) of their chords."""
    places, points, slopes = (np.empty((len(part), 3)) for _ in range(3))
    second = np.full((len(part), 3), np.nan)
    numbers = np.flatnonzero(np.bincount(family)).tolist()
    for number in in_turn(numbers):
        which = np.flatnonzero(family == number) if len(numbers) > 1 else slice(None)
        found = families[number].between(chords.take(which), part[which])
        places[which], points[which], slopes[which] = found.places, found.points, found.slopes
        if len(found.second_places):
            second[which] = found.second_places
    lost = np.flatnonzero(~all_finite(points + slopes))
    if len(lost):
        start, end = (ends[lost] for ends in chords.points)
        points[lost], slopes[lost] = start + part[lost, None] * (end - start), end - start
    return Along(places, points, slopes, second)


def _with_end(ends: tuple[Floats, Floats], new: Floats, last: Bools) -> tuple[Floats, Floats]:
    """What chords (k,) have at both ends, with new values in place of those at the last ones, or else at the first."""
    return np.where(last[:, None], ends[0], new), np.where(last[:, None], new, ends[1])


def together(parts: Sequence[Curves]) -> Curves:
    """All the curves of all parts."""
    parts = [no_curves(), *parts]
    shift = ragged.starts([len(p.families) for p in parts])
    numbered = [replace(p, family=p.family + s) for p, s in zip(parts, shift, strict=True)]
    return replace(joined(numbered), families=tuple(family for p in parts for family in p.families))


def no_curves() -> Curves:
    """No curve at all."""
    none, whole = np.zeros((0, 3)), np.zeros(0, dtype=np.intp)
    flags = np.zeros(0, dtype=np.bool_)
    return Curves(none, none, none, np.zeros(1, dtype=np.intp), flags, whole, whole, whole, np.zeros(0), ())


# To which side of its edges a sheet lies in the image.


def covered_sides(
    view: View, sheets: Sheets, number: Ints, kind: Ints, points: Floats, places: Floats, slopes: Floats
) -> Ints:
    """(k,) 1 where the image of a sheet lies to the left of its edge, -1 where to the right, 0 where neither is told.

    number (k,): of the sheet; kind (k,): CONTOUR for a fold, which the sheet bends away from to the side of its normal
    or against it; BOUNDARY for a border, which it lies inside of; CREASE for a cuspidal edge, from which both wings go
    the same way; points, places, slopes (k,3) on the edge and along it.
    """
    covered = np.zeros_like(points)
    way = sight_lines.sight(view, points)
    at = np.flatnonzero(kind == LineKind.CONTOUR)
    bends, normals = sheets.bends(number[at], places[at], way[at]), sheets.normals(number[at], places[at])
    covered[at] = np.sign(bends)[:, None] * normals
    at = np.flatnonzero(kind == LineKind.BOUNDARY)
    covered[at] = sheets.inwards(number[at], places[at])
    at = np.flatnonzero(kind == LineKind.CREASE)
    covered[at] = sheets.turnings(number[at], places[at])
    return _sides(view, points, slopes, covered)


def sides_of_rims(
    view: View, sheets: Sheets, number: tuple[Ints, Ints], points: Floats, places: tuple[Floats, Floats], slopes: Floats
) -> Ints:
    """(k,) 1 where the images of both sheets that meet at a sharp edge lie to the left of it, -1 where to the right.

    number (k,) and places (k,3) of the one sheet and of the other; points and slopes (k,3) on the edge and along it,
    where it is an outline: seen edge-on, a sheet tells nothing, but the other one does.
    """
    inwards = [sheets.inwards(*of) for of in zip(number, places, strict=True)]
    one, two = (way / np.linalg.norm(way, axis=1, keepdims=True).clip(LEAST_DIVISOR) for way in inwards)
    # Where the one sheet goes on as the other there is no side, but for rounding.
    both = np.where(norm(one + two)[:, None] > SAME_DIRECTION_SINE, one + two, 0.0)
    return _sides(view, points, slopes, both)


def _sides(view: View, points: Floats, slopes: Floats, covered: Floats) -> Ints:
    """(k,) the sides of edges to which directions (k,3) lead."""
    side = cross(sight_lines.image_slopes(view, points, slopes), sight_lines.image_slopes(view, points, covered))
    return np.where(np.isfinite(side), np.sign(side), 0.0).astype(np.intp)


# Lines that are chords of curves, or parts of chords: cut, they end on their curves.

NONE = -1

OUTLINES = (LineKind.CONTOUR, LineKind.BOUNDARY)
"""Kinds of curves to one side of which there is nothing of their sheet."""

STEPS = 3
"""Steps of Newton from the part of a chord to that of its curve, which is close to it."""

STANDING = 0.02
"""Where the image of a curve moves slower than this part of its mean speed along a chord it stands still there or has
come from a standstill near by."""


@dataclass(frozen=True, eq=False)
class ChordParts(Elements):
    """What lines (n,) are of curves on sheets: chord (n,) by the point at which it begins, -1 for lines that are of
    none; begin and end (n,): the part of the curve above it."""

    sheets: Sheets = field(metadata=APART)
    curves: Curves = field(metadata=APART)
    chord: Ints
    begin: Floats
    end: Floats

    def cut(self, view: View, low: Floats, high: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
        """Parts (n,) of the curves at which parts of the lines, from low to high (n,), begin and end; start and end
        (3,n) of these are put there.

        A place inside of a line becomes that of the curve of which the image is nearest.
        """
        return self._put(view, low, start, self.begin), self._put(view, high, end, self.end)

    @property
    def curve(self) -> Ints:
        """(n,) the curves that the lines are parts of; -1 for lines that are of none."""
        return np.where(self.chord >= 0, np.append(self.curves.owner, NONE)[self.chord], NONE)

    def sides(self, view: View) -> Ints:
        """(n,) 1 where the sheet of an outline lies to the left of the line in the image, -1 where to the right; 0 for
        all other lines. Seen from the middle of the chord."""
        result, curve = np.zeros(len(self.chord), dtype=np.intp), self.curve
        outline = np.isin(self.curves.kind, OUTLINES) & (self.curves.sheet >= 0)
        on = np.flatnonzero(np.append(outline, False)[curve])
        curve = curve[on]
        at, kind = self.curves.at(self.chord[on], np.full(len(on), 0.5)), self.curves.kind[curve]
        one, two = self.curves.sheet[curve], self.curves.second_sheet[curve]
        side = covered_sides(view, self.sheets, one, kind, at.points, at.places, at.slopes)
        rim = np.flatnonzero(two >= 0)
        edge, both = at.take(rim), (one[rim], two[rim])
        places = (edge.places, edge.second_places)
        side[rim] = sides_of_rims(view, self.sheets, both, edge.points, places, edge.slopes)
        result[on] = side
        return result

    def directions(self, view: View) -> Floats:
        """(n,2) the angles in the image, in radians from its first axis, at which curves leave the starts of the lines
        and arrive at their ends; NaN for lines that are of none.

        Where the image of a curve stands still, as in a cusp, its direction is the limit from inside of the line.
        """
        result = np.full((len(self.chord), 2), np.nan)
        on = np.flatnonzero(self.chord >= 0)
        count, span = len(on), (self.end - self.begin)[on]
        chord, part = np.tile(self.chord[on], 2), np.concatenate([self.begin[on], self.end[on]])
        image, way, straight = self._images(view, chord, part)
        long = np.linalg.norm(image[count:] - image[:count], axis=1) / np.where(span > 0.0, span, 1.0)
        # A standstill, or a place at which nothing is known but the chord.
        odd = np.flatnonzero(straight | ~(np.linalg.norm(way, axis=1) > STANDING * np.tile(long, 2)))
        if len(odd):
            inwards = BESIDE_STANDSTILL * np.concatenate([span, -span])
            way[odd] = self._limits(view, chord[odd], part[odd], inwards[odd])
        angle = np.where(any_component(way), arctan2(way[:, 1], way[:, 0]), np.nan)
        result[on] = angle.reshape(2, count).T
        return result

    def handles(self, view: View) -> tuple[Floats, Floats]:
        """(n,2) how long the handles are of the cubic Bézier curve with the ends and the derivatives of the image, at
        the starts of the lines and at their ends, and how far (n,) it is off the image, at most; NaN and infinite for
        lines that are of no rational curve."""
        handles, error = np.full((len(self.chord), 2), np.nan), np.full(len(self.chord), np.inf)
        on = np.flatnonzero(self.chord >= 0)
        degree, rational = self.curves.degrees(self.chord[on])
        # In a central image depths are weights.
        code = np.where(degree > 0, 2 * degree + (rational | (view.eye is not None)), 0)
        for own in np.unique(code[code > 0]).tolist():
            some = on[code == own]
            handles[some], error[some] = self._cubics(view, some, own // 2, own % 2 == 1)
        return handles, error

    def _cubics(self, view: View, which: Ints, degree: int, rational: bool) -> tuple[Floats, Floats]:
        """(k,2) how long the handles are of the cubics with the ends and derivatives of the images of lines (k,), and
        how far (k,) these are off the images, at most."""
        chord, begin, span = self.chord[which], self.begin[which], (self.end - self.begin)[which]
        start, end = (self.curves.with_exact_slopes(chord, part) for part in (begin, self.end[which]))
        leaving, arriving = (
            sight_lines.image_slopes(view, here.points, here.slopes) * span[:, None] / 3.0 for here in (start, end)
        )
        first, last = (sight_lines.image(view, here.points) for here in (start, end))
        if degree == 1:
            # Straight, however fast it is run along.
            return np.repeat(np.linalg.norm(last - first, axis=1)[:, None] / 3.0, 2, axis=1), np.zeros(len(chord))
        handles = np.stack([np.linalg.norm(leaving, axis=1), np.linalg.norm(arriving, axis=1)], axis=1)
        share = places(degree, rational)
        if not len(share):
            return handles, np.zeros(len(chord))
        control = np.stack([first, first + leaving, last - arriving, last])
        part = (begin + share[:, None] * span).ravel()
        there = self.curves.at(np.tile(chord, len(share)), part).points
        image = sight_lines.image(view, there).reshape(len(share), -1, 2)
        off = image - np.einsum("cj,jkd->ckd", bernstein(3, share), control)
        weights = None
        if rational:
            all_parts = np.concatenate([begin, part, self.end[which]])
            weights = self.curves.weights(np.tile(chord, len(share) + 2), all_parts)
            if view.eye is not None:
                weights = weights * sight_lines.depth(view, np.concatenate([start.points, there, end.points]))
            weights = weights.reshape(len(share) + 2, -1)
        return handles, cubic_error(degree, off, weights)

    def _images(self, view: View, chord: Ints, part: Floats) -> tuple[Floats, Floats, Bools]:
        """Places (k,2) in the image, how they move (k,2), and whether (k,) that is only how the chord runs."""
        here, points = self.curves.with_exact_slopes(chord, part), self.curves.points
        straight = all_components(here.slopes == points[chord + 1] - points[chord])
        way = sight_lines.image_slopes(view, here.points, here.slopes)
        return sight_lines.image(view, here.points), way, straight

    def _limits(self, view: View, chord: Ints, part: Floats, step: Floats) -> Floats:
        """(k,2) the limits of directions at parts of chords, from three places beside them."""
        beside = np.concatenate([part + many * step for many in (1.0, 2.0, 3.0)])
        way = self._images(view, np.tile(chord, 3), beside)[1]
        size = np.linalg.norm(way, axis=1, keepdims=True)
        one, two, three = (way / np.where(size > 0.0, size, 1.0)).reshape(3, len(chord), 2)
        return np.asarray(3.0 * one - 3.0 * two + three)

    def _put(self, view: View, share: Floats, points: Floats, outer: Floats) -> Floats:
        """(n,) parts of the curves; points (3,n) inside of lines are put onto them."""
        part = outer.copy()
        inner = np.flatnonzero((self.chord >= 0) & (share > 0.0) & (share < 1.0))
        if not len(inner):
            return part
        chord, low, high = self.chord[inner], self.begin[inner], self.end[inner]
        at, aim = low + share[inner] * (high - low), sight_lines.image(view, points[:, inner].T)
        for _ in range(STEPS):
            here = self.curves.at(chord, at)
            way = sight_lines.image_slopes(view, here.points, here.slopes)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = dot(aim - sight_lines.image(view, here.points), way) / dot(way, way)
            at = np.clip(at + np.where(np.isfinite(step), step, 0.0), low, high)
        part[inner], points[:, inner] = at, self.curves.at(chord, at).points.T
        return part


# Curves of one sort on sheets that are asked as one: one family of them all.

ON_ONE = (ParameterCurves, DirectedCurves, RimCurves, ConditionCurves, FaceCurves)
"""Families of curves that lie on one sheet."""


def with_merged_families(parts: Sequence[Curves], sheets: Sheets) -> list[Curves]:
    """The same curves, those of one sort on the sheets of a group in one family, the same in all parts: so they are
    asked at once.

    Their places say on which sheet of the group they are.
    """
    if not any(group.stacked for group in sheets.groups):
        return list(parts)
    known: dict[object, Family] = {}
    return [_with_merged(curves, sheets, known) for curves in parts]


def _with_merged(curves: Curves, sheets: Sheets, known: dict[object, Family]) -> Curves:
    """As with_merged_families; known: the families there are already, those that are new among them afterwards."""
    number: dict[object, int] = {}
    families: list[Family] = []
    new = np.zeros(len(curves.families), dtype=np.intp)
    first, second = (np.zeros(len(curves.families), dtype=np.bool_) for _ in range(2))
    for old, family in enumerate(curves.families):
        found = _merged(family, sheets)
        key = old if found is None else found.key
        if key not in number:
            number[key] = len(families)
            families.append(family if found is None else known.setdefault(key, found.family))
        new[old] = number[key]
        first[old], second[old] = (False, False) if found is None else (True, found.on_second)
    places, second_places = curves.places.copy(), curves.second_places.copy()
    for which, sheet, at in ((first, curves.sheet, places), (second, curves.second_sheet, second_places)):
        own = np.flatnonzero(which[curves.family][curves.owner])
        at[own] = sheets.places(sheet[curves.owner[own]], at[own])
    of, merged = new[curves.family], tuple(families)
    return replace(curves, places=places, second_places=second_places, family=of, families=merged)


@dataclass(frozen=True)
class _Merged:
    """A family of all curves of one sort: the sort, and whether second places are those on a sheet."""

    key: object
    family: Family
    on_second: bool


def _merged(family: Family, sheets: Sheets) -> _Merged | None:
    """What a family becomes; None where it stays alone."""
    if isinstance(family, SheetsMeet):
        one, two = (int(sheets.group[number]) for number in (family.sheet, family.second))
        surface, other = sheets.groups[one].as_one, sheets.groups[two].as_one
        if not isinstance(surface, OnParametrised) or not isinstance(other, OnParametrised):
            return None
        return _Merged(("meetings", one, two), replace(family, surface=surface, other=other), True)
    if not isinstance(family, ON_ONE) or family.second != NONE:
        return None
    group = int(sheets.group[family.sheet])
    surface = sheets.groups[group].as_one
    if group == NONE or not isinstance(surface, StackedSheets):
        return None
    if isinstance(family, ParameterCurves) and family.weighted is not None:
        return None
    if isinstance(family, ConditionCurves) and isinstance(family.condition, ThroughPinchPoints):
        return None
    sheet = sheets[family.sheet]
    if (
        isinstance(family, ConditionCurves)
        and isinstance(sheet, ParametricSheet)
        and sheet.asked is not sheet.whole.surface
    ):
        # These are curves of the surface before it was cut.
        return None
    degrees = family.degrees_along if isinstance(family, ParameterCurves) else ()
    key = (type(family), group, _said(family) if isinstance(family, ConditionCurves) else degrees)
    return _Merged(key, replace(family, surface=surface), False)


def _said(family: ConditionCurves) -> tuple[object, ...]:
    """Equal for conditions that differ in their surfaces only."""
    condition = family.condition
    own = condition.implicit if isinstance(condition, ImplicitSection) else condition
    values = [value for name, value in vars(own).items() if name != "surface"]
    return (type(condition), type(own), *(np.asarray(value, dtype=np.float64).tobytes() for value in values))


# Curves traced on parametrised surfaces as the engine takes them.

OnSurface = ConditionCurves | ParameterCurves | DirectedCurves | RimCurves | TrimCurves | FaceCurves


def as_curves(
    found: SurfaceCurves, kind: LineKind, item: int, family: OnSurface, second_places: Floats | None = None
) -> Curves:
    """Curves of a surface with closed ones led back to their first point; second_places (n,3) of the points found, or
    else their directions."""
    rounds = closed_round(found)
    index = rounds.index
    places = from_components(found.u.take(index), found.v.take(index), 0.0)
    size = np.stack(family.surface.surface_at(places[rounds.again]).domain.size, axis=-1)
    places[rounds.again, :2] += found.turns[found.closed] * size
    if second_places is None:
        second_places = from_components(found.directions[:, 0], found.directions[:, 1], 0.0)
    many = len(found)
    whole = np.full(many, item, dtype=np.intp)
    return Curves(
        found.points.take(index, axis=0),
        places,
        second_places.take(index, axis=0),
        rounds.offsets,
        found.closed,
        np.full(many, int(kind)),
        whole,
        np.zeros(many, dtype=np.intp),
        found.levels if kind in (LineKind.ISOPHOTE, LineKind.SECTION, LineKind.INDEX) else np.zeros(many),
        (family,),
    )
