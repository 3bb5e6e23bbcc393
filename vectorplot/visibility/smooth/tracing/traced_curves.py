"""All curves of a scene with smooth surfaces: polylines of which every point is exact, and what they are between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some
from vectorplot.visibility.smooth.sheets.family import Along, Chords, Family, FamilyOfPolynomials, joined_chords


def _none() -> Ints:
    return np.zeros(0, dtype=np.intp)


@dataclass(frozen=True, eq=False)
class Curves:
    """Polylines in the view's coordinates.

    points (n,3); places (n,3) of them on their sheets; second_places (n,3) those on a second sheet, of curves in which
    two sheets meet; of those in faces of a mesh the normal of the face in which the chord from the point lies; of those
    with known directions these; else NaN; offsets (m+1,); closed (m,): the last point is the first again, its place
    whole periods away; kind (m,) LineKind values; item (m,); family (m,) indices into families; level (m,) the value
    that the condition of its family has along a curve; side (m,): of an outline 1 or -1 where its surface lies to its
    left or right and that is known already, else 0; behind (m,): by how many items it is hidden already; sheet (m,):
    the sheet that it lies on, -1 for straight lines, and second_sheet (m,) another one, or -1: as its family says, if
    not given.
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

    def __post_init__(self) -> None:
        for name, of_family in (("sheet", "sheet"), ("second_sheet", "second")):
            if len(self) and not len(getattr(self, name)):
                values = np.array([*(getattr(family, of_family) for family in self.families), -1], dtype=np.intp)
                object.__setattr__(self, name, values[self.family])
        for name in ("side", "behind"):
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

        A part a little below 0 or above 1 lies on the curve too, beyond the ends of the chord. Degenerate: over a hole
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
            whole, to = self.chords_from(chord[inner]), found.some(inner)
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

    def some(self, which: Ints) -> Curves:
        """Some of the curves."""
        return some(self, which)


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
    return [found.some(slice(first, end)) for first, end in pairwise(ends)]


def _between(families: Sequence[Family], chords: Chords, family: Ints, part: Floats) -> Along:
    """The curves of families (k,) at a part (k,) of their chords."""
    places, points, slopes = (np.empty((len(part), 3)) for _ in range(3))
    second = np.full((len(part), 3), np.nan)
    numbers = np.flatnonzero(np.bincount(family)).tolist()
    for number in numbers:
        which = np.flatnonzero(family == number) if len(numbers) > 1 else slice(None)
        found = families[number].between(chords.some(which), part[which])
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
