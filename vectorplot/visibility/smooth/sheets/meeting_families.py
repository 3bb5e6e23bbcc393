"""Curves in which a sheet meets another one, or the faces of a mesh: between their points they lie on both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.parametric.conditions import Slopes
from vectorplot.geometry import records
from vectorplot.geometry.vectors import cross, dot, from_components
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_lengths import FAMILY_SETTLED, MISSED_OF_CHORD
from vectorplot.visibility.smooth.sheets.family import (
    FARTHEST,
    ROUNDS,
    Along,
    Chords,
    ConditionCurves,
    ParameterCurves,
    SpatialCurves,
    no_longer,
)
from vectorplot.visibility.smooth.sheets.implicit_sheet import ImplicitSheet
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised, TangentPlanes

LED_AWAY, LED_APART = 4.0, 0.1
"""What is straight in the parameters between the ends of a chord leads elsewhere if it is more than the one times its
length away from it, and on that way runs through more than the other part of the domain."""


@dataclass(frozen=True, eq=False)
class SheetsMeet:
    """Curves in which two parametrised sheets meet, or one meets itself."""

    surface: OnParametrised
    sheet: int
    other: OnParametrised
    second: int

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords: in the plane across the chord to where both sheets are.

        Newton's method: the point of that plane and of both tangent planes.
        Source: as for `vectorplot.features.intersections.meeting_points.meetings`.
        """
        start, end = chords.points
        way = end - start
        base, long = start + part[:, None] * way, np.sqrt(dot(way, way))
        at, there = (a + part[:, None] * (b - a) for a, b in (chords.places, chords.second_places))
        n, m, last = np.empty_like(base), np.empty_like(base), np.full(len(base), np.inf)
        active = np.arange(len(base))
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                if not len(active):
                    break
                one, two = self._planes(at[active], there[active])
                w, x = way[active], base[active]
                across_n, across_m = cross(two.normals, w), cross(w, one.normals)
                heights = (
                    dot(one.normals, one.points - x)[:, None] * across_n
                    + dot(two.normals, two.points - x)[:, None] * across_m
                )
                aim = x + no_longer(heights / dot(one.normals, across_n)[:, None], FARTHEST * long[active])
                steps = [no_longer(aim - plane.points, long[active]) for plane in (one, two)]
                at[active] = _finite(one.moved(steps[0]), one.places)
                there[active] = _finite(two.moved(steps[1]), two.places)
                n[active], m[active] = one.normals, two.normals
                last[active] = np.sqrt(np.fmax(dot(steps[0], steps[0]), dot(steps[1], steps[1])))
                active = active[last[active] > FAMILY_SETTLED * long[active]]
            tangent = cross(n, m)
            tangent *= (dot(way, way) / dot(tangent, way))[:, None]
        p, q = self._points(at, there)
        met = (last <= MISSED_OF_CHORD * long) & (np.sqrt(dot(p - q, p - q)) <= MISSED_OF_CHORD * long)
        found, known = Along(at, p, tangent, there), np.isfinite(tangent).all(axis=1)
        rough = np.flatnonzero(~(met & known))
        if len(rough):
            other, lost = self._roughly(chords.some(rough), part[rough]), ~met[rough]
            found.slopes[rough] = other.slopes
            rough, other = rough[lost], other.some(np.flatnonzero(lost))
            at[rough], p[rough], there[rough] = other.places, other.points, other.second_places
        return found

    def _planes(self, places: Floats, second_places: Floats) -> tuple[TangentPlanes, TangentPlanes]:
        """The tangent planes of both sheets: of one that meets itself all at once."""
        if self.other is not self.surface:
            return self.surface.planes(places), self.other.planes(second_places)
        both, half = self.surface.planes(np.concatenate([places, second_places])), len(places)
        return records.some(both, np.arange(half)), records.some(both, np.arange(half, 2 * half))

    def _points(self, places: Floats, second_places: Floats) -> tuple[Floats, Floats]:
        """The points of both sheets, likewise."""
        if self.other is not self.surface:
            return self.surface.points(places), self.other.points(second_places)
        both, half = self.surface.points(np.concatenate([places, second_places])), len(places)
        return both[:half], both[half:]

    def _roughly(self, chords: Chords, part: Floats) -> Along:
        """What is straight in the parameters of the first sheet at a part of the chords; where that leads away from a
        chord, because its ends lie in different parts of the domain, the chord and the places of its nearer end."""
        (start, end), (a, b) = chords.points, chords.second_places
        way = end - start
        straight = start + part[:, None] * way
        found = ParameterCurves(self.surface, self.sheet).between(chords, part)
        away = found.points - straight
        led_away = np.sqrt(dot(away, away)) > LED_AWAY * np.sqrt(dot(way, way))
        size = from_components(*self.surface.surface_at(chords.places[0]).domain.size)
        apart = np.abs((chords.places[1] - chords.places[0])[:, :2] / size).max(axis=1)
        beside = ~(led_away & (apart > LED_APART))[:, None]
        nearer = [np.where((part < 0.5)[:, None], *ends) for ends in (chords.places, chords.second_places)]
        return Along(
            np.where(beside, found.places, nearer[0]),
            np.where(beside, found.points, straight),
            np.where(beside, found.slopes, way),
            np.where(beside, a + part[:, None] * (b - a), nearer[1]),
        )


@dataclass(frozen=True, eq=False)
class FaceCurves:
    """Curves of a parametrised surface in the faces of a mesh, the normals of which are their second places."""

    surface: OnParametrised
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        normals, points = chords.second_places[0], chords.points[0]
        faces = _PlaneSections(self.surface.surface_at(chords.places[0]), normals, dot(points, normals))
        return ConditionCurves(self.surface, self.sheet, faces).between(_level(chords), part)


@dataclass(frozen=True, eq=False)
class ImplicitFaceCurves:
    """Curves of an implicit surface in the faces of a mesh, the normals of which are their second places."""

    surface: ImplicitSheet
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        normals, points = chords.second_places[0], chords.points[0]
        faces = _Planes(normals, dot(points, normals))
        return SpatialCurves(self.surface, self.sheet, faces).between(_level(chords), part)


@dataclass(frozen=True, eq=False)
class _Planes:
    """Heights of points above planes of their own: normals (k,3), offsets (k,)."""

    normals: Floats
    offsets: Floats

    def values(self, points: Floats) -> Floats:
        """(k,) heights of points."""
        return dot(points, self.normals) - self.offsets

    def gradients(self, points: Floats) -> Floats:
        """(k,3) the normals."""
        return self.normals


@dataclass(frozen=True, eq=False)
class _PlaneSections:
    """The same for points of a surface."""

    surface: Surface
    normals: Floats
    offsets: Floats

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        return self.values(u, v), self.slopes(u, v)

    def on(self, surface: Surface, which: Ints) -> _PlaneSections:
        """Those of some points, of another surface."""
        return _PlaneSections(surface, self.normals[which], self.offsets[which])

    def values(self, u: Floats, v: Floats) -> Floats:
        """(k,) heights of points."""
        return dot(self.surface.points(u, v), self.normals) - self.offsets

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(k,) their derivatives by u and by v."""
        along_u, along_v = self.surface.partials(u, v)
        return dot(along_u, self.normals), dot(along_v, self.normals)


def _level(chords: Chords) -> Chords:
    """The chords at level 0."""
    return Chords(chords.places, chords.points, chords.second_places, np.zeros_like(chords.level))


def _finite(places: Floats, else_: Floats) -> Floats:
    return np.where(np.isfinite(places).all(axis=1, keepdims=True), places, else_)
