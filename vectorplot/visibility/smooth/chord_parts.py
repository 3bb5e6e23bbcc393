"""Lines that are chords of curves, or parts of chords: cut, they end on their curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier.cubic_error import bernstein, cubic_error, places
from vectorplot.geometry.components import all_components, any_component
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_parameters import BESIDE_STANDSTILL
from vectorplot.visibility.smooth.events.edge_sides import covered_sides, sides_of_rims
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

NONE = -1

OUTLINES = (LineKind.CONTOUR, LineKind.BOUNDARY)
"""Kinds of curves to one side of which there is nothing of their sheet."""

STEPS = 3
"""Steps of Newton from the part of a chord to that of its curve, which is close to it."""

STANDING = 0.02
"""Where the image of a curve moves slower than this part of its mean speed along a chord it stands still there or has
come from a standstill near by."""


@dataclass(frozen=True, eq=False)
class ChordParts:
    """What lines (n,) are of curves on sheets: chord (n,) by the point at which it begins, -1 for lines that are of
    none; begin and end (n,): the part of the curve above it."""

    sheets: Sheets
    curves: Curves
    chord: Ints
    begin: Floats
    end: Floats

    def some(self, which: Ints | Bools) -> ChordParts:
        """That of some of the lines."""
        return ChordParts(self.sheets, self.curves, self.chord[which], self.begin[which], self.end[which])

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
        edge, both = at.some(rim), (one[rim], two[rim])
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
