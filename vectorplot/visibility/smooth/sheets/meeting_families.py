"""Curves in which a sheet meets another one, or the faces of a mesh: between their points they lie on both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.parametric.conditions import Slopes
from vectorplot.geometry.vectors import dot
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
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised


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
        one, two, (start, end) = self.surface, self.other, chords.points
        way = end - start
        base, long = start + part[:, None] * way, np.sqrt(dot(way, way))
        at, there = (a + part[:, None] * (b - a) for a, b in (chords.places, chords.second_places))
        n, m, last = np.empty_like(base), np.empty_like(base), np.full(len(base), np.inf)
        active = np.arange(len(base))
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                if not len(active):
                    break
                a, b, w = at[active], there[active], way[active]
                p, q = one.points(a), two.points(b)
                n_a, m_a = one.normals(a), two.normals(b)
                across_n, across_m = np.cross(m_a, w), np.cross(w, n_a)
                x = base[active]
                heights = dot(n_a, p - x)[:, None] * across_n + dot(m_a, q - x)[:, None] * across_m
                aim = x + no_longer(heights / dot(n_a, across_n)[:, None], FARTHEST * long[active])
                steps = [no_longer(aim - x, long[active]) for x in (p, q)]
                at[active] = _finite(one.moved(a, steps[0]), a)
                there[active] = _finite(two.moved(b, steps[1]), b)
                n[active], m[active] = n_a, m_a
                last[active] = np.sqrt(np.fmax(dot(steps[0], steps[0]), dot(steps[1], steps[1])))
                active = active[last[active] > FAMILY_SETTLED * long[active]]
            tangent = np.cross(n, m)
            tangent *= (dot(way, way) / dot(tangent, way))[:, None]
        p, q = one.points(at), two.points(there)
        roughly = ParameterCurves(one, self.sheet).between(chords, part)
        met = (last <= MISSED_OF_CHORD * long) & (np.sqrt(dot(p - q, p - q)) <= MISSED_OF_CHORD * long)
        a, b = chords.second_places
        places, second = (
            np.where(met[:, None], at, roughly.places),
            np.where(met[:, None], there, a + part[:, None] * (b - a)),
        )
        slopes = np.where((met & np.isfinite(tangent).all(axis=1))[:, None], tangent, roughly.slopes)
        return Along(places, np.where(met[:, None], p, roughly.points), slopes, second)


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
