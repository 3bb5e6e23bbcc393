"""The sharp edges at which the sheets of an item meet, as lines of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.narrowing import narrowed
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.family import Along, Chords, ParameterCurves
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

HALVINGS = 60
"""Steps of halving from a chord to the place where a sheet turns away: what is left is rounding."""


@dataclass(frozen=True, eq=False)
class Rims:
    """Curves on the common border of two sheets, on which both have the same places."""

    surface: ParametricSheet
    sheet: int
    second: int

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        found = ParameterCurves(self.surface, self.sheet).between(chords, part)
        return replace(found, second_places=found.places)


def with_rims(view: View, sheets: tuple[SmoothSheet, ...], number: int, parts: Sequence[Curves]) -> list[Curves]:
    """The curves of a sheet, its borders at sharp edges cut into what is outline, a contour, and what is a crease.

    An edge belongs to the first of the two sheets that meet there; that of the second one is left out.
    """
    sheet = sheets[number]
    if not isinstance(sheet, ParametricSheet) or not sheet.creases:
        return list(parts)
    result = []
    for part in parts:
        v = part.places[part.offsets[:-1], 1] if len(part) else np.zeros(0)
        along = part.places[part.offsets[1:] - 1, 1] if len(part) else v
        rim = (part.kind == LineKind.BOUNDARY) & (v == along) & np.isin(v, sheet.creases)
        result.append(part.some(np.flatnonzero(~rim)))
        own = rim & (v == sheet.surface.domain.v_end)
        if own.any():
            other = sheets[number + 1]
            assert isinstance(other, ParametricSheet)
            curves = _cut(view, sheet, other, part.some(np.flatnonzero(own)))
            families = tuple(Rims(sheet, family.sheet, number + 1) for family in curves.families)
            second = np.full(len(curves), number + 1)
            result.append(replace(curves, families=families, second_places=curves.places, second_sheet=second))
    return result


def _cut(view: View, one: ParametricSheet, other: ParametricSheet, curves: Curves) -> Curves:
    """Edges between two sheets, cut where one of the sheets turns away: contours where one faces the eye and the other
    does not, else creases."""

    def outline(places: Floats) -> Bools:
        return np.asarray(_faces(view, one, places) != _faces(view, other, places))

    there = outline(curves.places)
    chord = curves.chords
    chord = chord[there[chord] != there[chord + 1]]
    start, way = curves.places[chord], curves.places[chord + 1] - curves.places[chord]

    def goes_on(which: Ints, part: Floats) -> Bools:
        return np.asarray(outline(start[which] + part[:, None] * way[which]) == there[chord[which]])

    last, _ = narrowed(goes_on, np.zeros(len(chord)), np.ones(len(chord)), HALVINGS)
    places = start + last[:, None] * way
    points = one.points(places)
    return _pieces(curves, chord, places, points, there)


def _faces(view: View, sheet: ParametricSheet, places: Floats) -> Bools:
    """(k,) whether a sheet shows its front at places."""
    return np.asarray(dot(sheet.normals(places), sight_lines.sight(view, sheet.points(places))) > 0.0)


def _pieces(curves: Curves, chord: Ints, places: Floats, points: Floats, outline: Bools) -> Curves:
    """The curves, cut at points of the chords that begin at chord (k,); outline (n,): where old points lie on one.

    Each cut ends a piece and begins the next one.
    """
    after = np.repeat(chord + 1, 2)
    bounds = ragged.offsets(np.diff(curves.offsets) + 2 * np.bincount(curves.owner[chord], minlength=len(curves)))
    begin = np.concatenate([bounds[:-1], chord + 2 + 2 * np.arange(len(chord))])
    turned = np.concatenate([outline[curves.offsets[:-1]], outline[chord + 1]])
    of = np.concatenate([np.arange(len(curves)), curves.owner[chord]])
    order = np.argsort(begin, kind="stable")
    of, turned = of[order], turned[order]
    whole = np.bincount(of, minlength=len(curves))[of] == 1

    def put(values: Floats, new: Floats) -> Floats:
        return np.insert(values, after, np.repeat(new, 2, axis=0), axis=0)

    return replace(
        curves.some(of),
        points=put(curves.points, points),
        places=put(curves.places, places),
        second_places=put(curves.second_places, np.full_like(places, np.nan)),
        offsets=np.append(begin[order], bounds[-1]),
        closed=curves.closed[of] & whole,
        kind=np.where(turned, int(LineKind.CONTOUR), int(LineKind.CREASE)),
    )
