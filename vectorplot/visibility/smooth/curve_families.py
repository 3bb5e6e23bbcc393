"""Families of curves on sheets, and what is known of them between the points of their polylines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.conditions import ImplicitSection, Planes, SpatialCondition, SurfaceCondition
from vectorplot.features.holes import beside_rim_chords, inside
from vectorplot.features.implicit_singular_lines import SingularEquations, line_tangents, onto_lines
from vectorplot.geometry import records
from vectorplot.geometry.vectors import all_finite, cross, dot, from_components
from vectorplot.surfaces.parameter_regions import RegionBorders
from vectorplot.surfaces.splines import SplineSurface
from vectorplot.surfaces.stacked import of_some
from vectorplot.surfaces.surface import Surface, first_jets
from vectorplot.tolerances import FAMILY_SETTLED, JUST_BEFORE, LEAST_DIVISOR, MISSED_OF_CHORD, TOUCHING_SHEETS_SINE
from vectorplot.visibility.smooth.sheets import ImplicitSheet, OnParametrised, TangentPlanes

# Curves of one kind on one sheet: what is known of them between the points of their polylines.

ROUNDS, RENEWED = 8, 4
"""Steps of Newton from a chord to its curve; the one at which slopes are computed anew."""

RIM_STEP = 1.0 / 64.0
"""Parts of a chord to both sides over which the slope of a rim is taken."""

FARTHEST = 0.5
"""So many lengths of its chord a curve may be away from it."""


@dataclass(frozen=True, eq=False)
class Chords:
    """Chords of curves of one family: places, points and second places (k,3) at both of their ends; level (k,): of the
    curves."""

    places: tuple[Floats, Floats]
    points: tuple[Floats, Floats]
    second_places: tuple[Floats, Floats]
    level: Floats

    def take(self, which: Ints | slice) -> Chords:
        """Some of the chords."""
        if isinstance(which, slice):
            return self._chosen(lambda values: values[which])
        # take is several times as fast as an index between brackets.
        return self._chosen(lambda values: values.take(which, axis=0))

    def _chosen(self, rows: Callable[[Floats], Floats]) -> Chords:
        places, points, second = (
            (rows(start), rows(end)) for start, end in (self.places, self.points, self.second_places)
        )
        return Chords(places, points, second, rows(self.level))


def joined_chords(parts: Sequence[Chords]) -> Chords:
    """The chords of all parts, one part after the other."""
    if len(parts) == 1:
        return parts[0]
    places, points, second = (
        (np.concatenate([start for start, _ in ends]), np.concatenate([end for _, end in ends]))
        for ends in ([p.places for p in parts], [p.points for p in parts], [p.second_places for p in parts])
    )
    return Chords(places, points, second, np.concatenate([p.level for p in parts]))


@dataclass(frozen=True, eq=False)
class Along:
    """Points of curves: places and points (k,3); slopes (k,3): derivatives by the part of the chord; second_places
    (k,3), none unless the curves lie on a second sheet."""

    places: Floats
    points: Floats
    slopes: Floats
    second_places: Floats = field(default_factory=lambda: np.zeros((0, 3)))

    def take(self, which: Ints | slice) -> Along:
        """Some of the points, of those that have second places."""
        return Along(self.places[which], self.points[which], self.slopes[which], self.second_places[which])


class Family(Protocol):
    """Curves of one kind on one sheet."""

    @property
    def sheet(self) -> int:
        """The sheet they lie on, or -1."""
        ...

    @property
    def second(self) -> int:
        """Another sheet they lie on, or -1."""
        ...

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part (k,) of chords (k,)."""
        ...


@runtime_checkable
class FamilyOfPolynomials(Protocol):
    """Curves of which some may be polynomials in their parameter, or quotients of two."""

    def degrees(self, chords: Chords) -> Ints:
        """(k,) of which degree the polynomials are; 0 where a chord is of no such curve."""
        ...

    @property
    def rational(self) -> bool:
        """Whether they are quotients."""
        ...

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) what the polynomials are divided by at a part (k,) of chords."""
        ...


@dataclass(frozen=True, eq=False)
class StraightLines:
    """Lines that are their own chords."""

    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        start, end = chords.points
        slopes = end - start
        middle = start + part[:, None] * slopes
        return Along(middle, middle, slopes)


@dataclass(frozen=True, eq=False)
class ParameterCurves:
    """Curves that are straight in the parameters: parameter lines, borders; and, nearly, those known by points only.

    degrees_along: of the polynomials that the lines are along which u grows, and those along which v grows, 0 where
    they are none; no chord runs over a break of these then. weighted: where they are divided by its weights."""

    surface: OnParametrised
    sheet: int
    second: int = -1
    degrees_along: tuple[int, int] = (0, 0)
    weighted: SplineSurface | None = None

    @property
    def rational(self) -> bool:
        """Whether there are weights."""
        return self.weighted is not None

    def degrees(self, chords: Chords) -> Ints:
        """(k,) of which degree the polynomials are; 0 where a chord is of no such curve."""
        start, end = chords.places
        stays = start[:, :2] == end[:, :2]
        return np.where(stays[:, 1], self.degrees_along[0], np.where(stays[:, 0], self.degrees_along[1], 0))

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) what the polynomials are divided by at a part (k,) of chords."""
        start, end = chords.places
        if self.weighted is None:
            return np.ones(len(part))
        at = start + part[:, None] * (end - start)
        return self.weighted.weight(*inside(self.weighted.domain, at))

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        start, end = chords.places
        way = end - start
        at = start + part[:, None] * way
        surface = self.surface.surface_at(start)
        u, v = inside(surface.domain, at)
        points, along_u, along_v = first_jets(surface, u, v)
        if any(self.degrees_along):
            # At a break derivatives may jump: those of the piece that the chord belongs to.
            piece = start + inner_part(part)[:, None] * way
            along_u, along_v = surface.partials(*inside(surface.domain, piece))
        return Along(at, points, way[:, :1] * along_u + way[:, 1:2] * along_v)


@dataclass(frozen=True, eq=False)
class RimCurves:
    """Rims of the holes of a parametrised surface."""

    surface: OnParametrised
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The rims at a part of their chords: straight across in the parameters. There is no derivative at a rim that
        the surface comes to with a vertical tangent: slopes are differences."""
        count, middle = len(part), np.clip(part, RIM_STEP, 1.0 - RIM_STEP)
        # All are looked for at once: what takes time is how often the surface is asked.
        start, end = (np.tile(ends, (3, 1)) for ends in chords.places)
        surface = self.surface.surface_at(start)
        each = np.concatenate([part, middle + RIM_STEP, middle - RIM_STEP])
        beside, _ = beside_rim_chords(surface, start[:, :2], end[:, :2], each)
        places = np.concatenate([beside, start[:, 2:]], axis=1)
        points = surface.points(*inside(surface.domain, places))
        at, after, before = points.reshape(3, count, 3)
        return Along(places[:count], at, (after - before) / (2.0 * RIM_STEP))


@dataclass(frozen=True, eq=False)
class TrimCurves:
    """Borders that curves in u and v make of a parametrised surface; first of their second places are the numbers of
    places as `RegionBorders` has them."""

    surface: OnParametrised
    borders: RegionBorders
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        first, last = (ends[:, 0] for ends in chords.second_places)
        start = chords.places[0]
        surface = self.surface.surface_at(start)
        long = self.borders.lengths(first, last)
        at = self.borders.at(first, part * long)[0]
        # At a corner derivatives are those of the piece that the chord belongs to.
        slopes = self.borders.at(first, inner_part(part) * long)[1] * long[:, None]
        # The border runs on over seams; its chord may be whole rounds further on.
        at = at + np.round((start[:, :2] - self.borders.at(first, 0.0 * part)[0]) / _sizes(surface)) * _sizes(surface)
        places = np.concatenate([at, start[:, 2:]], axis=1)
        points, along_u, along_v = first_jets(surface, *inside(surface.domain, places))
        numbers = from_components(self.borders.number(first, part * long), 0.0, 0.0)
        return Along(places, points, slopes[:, :1] * along_u + slopes[:, 1:] * along_v, numbers)


def _sizes(surface: Surface) -> Floats:
    """(2,) or (k,2) the sizes of domains."""
    return from_components(*surface.domain.size)


@dataclass(frozen=True, eq=False)
class ConditionCurves:
    """Curves of a parametrised surface along which a condition has the value of their level; it holds on the second
    sheet, if there is one, whose places are points."""

    surface: OnParametrised
    sheet: int
    condition: SurfaceCondition
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords: from the chord straight across to where the condition holds."""
        start, end = chords.places
        surface = self.surface.surface_at(start)
        domain = surface.domain
        size = np.broadcast_to(from_components(*domain.size), (len(part), 2))
        way = (end - start)[:, :2] / size
        base = start[:, :2] / size + part[:, None] * way
        across = from_components(-way[:, 1], way[:, 0])
        off, slopes = np.zeros(len(part)), np.empty((len(part), 2))
        # Of many chords a few, mostly those much shorter than others, take longer than all the rest.
        active = np.arange(len(part))
        for again in range(ROUNDS):
            if not len(active):
                break
            condition = self.condition.on(of_some(surface, active), active)
            u, v = inside(condition.surface.domain, (base[active] + off[active, None] * across[active]) * size[active])
            # The chord is close to the curve: the slopes on it do, unless that does not lead there.
            if again in (0, RENEWED):
                values, along = condition.values_and_slopes(u, v)
                slopes[active] = from_components(*along) * size[active]
            else:
                values = condition.values(u, v)
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                step = (values - chords.level[active]) / dot(slopes[active], across[active])
            step = np.where(np.isfinite(step), step, 0.0).clip(-FARTHEST, FARTHEST)
            off[active] = (off[active] - step).clip(-FARTHEST, FARTHEST)
            active = active[np.abs(step) > FAMILY_SETTLED]
        at = base + off[:, None] * across
        tangent = from_components(-slopes[:, 1], slopes[:, 0])
        forward = dot(tangent, way)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            tangent = tangent * (dot(way, way) / forward)[:, None]
        tangent = np.where(all_finite(tangent)[..., None], tangent, way)
        places_at = np.concatenate([at * size, start[:, 2:]], axis=1)
        u, v = inside(domain, places_at)
        points, along_u, along_v = first_jets(surface, u, v)
        moved = tangent * size
        second = points[: len(points) if self.second >= 0 else 0]
        return Along(places_at, points, moved[:, :1] * along_u + moved[:, 1:] * along_v, second)


@dataclass(frozen=True, eq=False)
class SpatialCurves:
    """Curves of an implicit surface along which a condition in space has the value of their level; it holds on the
    second sheet, if there is one, whose places are points."""

    surface: ImplicitSheet
    sheet: int
    condition: SpatialCondition
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords: in the plane across the chord to where surface and condition meet."""
        start, end = chords.points
        way = end - start
        base = start + part[:, None] * way
        farthest = FARTHEST * np.sqrt(dot(way, way))
        off = np.zeros_like(base)
        placed = self.surface.surface
        with np.errstate(all="ignore"):
            for again in range(ROUNDS):
                at = base + off
                if again in (0, RENEWED):
                    one, two = placed.gradients(at), self.condition.gradients(at)
                    across_one, across_two = cross(two, way), cross(way, one)
                    volume = dot(one, across_one)
                f, g = placed.values(at), self.condition.values(at) - chords.level
                step = -(f[:, None] * across_one + g[:, None] * across_two) / volume[:, None]
                step = no_longer(step, farthest)
                off = no_longer(off + step, farthest)
                if not (np.sqrt(dot(step, step)) > FAMILY_SETTLED * farthest).any():
                    break
            tangent = cross(one, two)
            tangent = tangent * (dot(way, way) / dot(tangent, way))[:, None]
        at = base + off
        slopes = np.where(np.isfinite(tangent).all(axis=1, keepdims=True), tangent, way)
        return Along(at, at, slopes, at[: len(at) if self.second >= 0 else 0])


@dataclass(frozen=True, eq=False)
class SingularCurves:
    """Cuspidal edges or double lines of an implicit surface, with the equations that hold on them."""

    equations: SingularEquations
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The lines at a part of their chords: in the plane across the chord."""
        start, end = chords.points
        way = end - start
        long = np.sqrt(dot(way, way))
        across = way / np.maximum(long, LEAST_DIVISOR)[:, None]
        at, on = onto_lines(self.equations, start + part[:, None] * way, FARTHEST * long, across=across)
        tangent = line_tangents(self.equations, at)
        with np.errstate(all="ignore"):
            tangent = tangent * (dot(way, way) / dot(tangent, way))[:, None]
        known = on & np.isfinite(tangent).all(axis=1)
        return Along(at, at, np.where(known[:, None], tangent, way))


@dataclass(frozen=True, eq=False)
class NearChords:
    """Curves of an implicit surface known by points only: between these, what lies on the surface above the chord."""

    surface: ImplicitSheet
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        start, end = chords.points
        way = end - start
        at = start + part[:, None] * way
        for _ in range(ROUNDS):
            at = self.surface.points(at)
        normal = self.surface.normals(at)
        slopes = way - dot(way, normal)[:, None] * normal
        return Along(at, at, np.where(np.isfinite(slopes), slopes, way))


def inner_part(part: Floats) -> Floats:
    """(k,) parts of chords, those at their ends moved a little inside."""
    return np.clip(part, JUST_BEFORE, 1.0 - JUST_BEFORE)


def no_longer(steps: Floats, longest: Floats) -> Floats:
    """(k,3) the steps, those longer than this (k,) shortened; none where they are not finite."""
    steps = np.where(all_finite(steps)[..., None], steps, 0.0)
    long = np.sqrt(dot(steps, steps))
    return np.asarray(steps * np.minimum(1.0, longest / np.maximum(long, LEAST_DIVISOR))[:, None])


# Curves in which a sheet meets another one, or the faces of a mesh: between their points they lie on both.

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
            # Where the sheets touch, and curves cross, it is rounding: nothing is known but the chord.
            touching = dot(tangent, tangent) <= TOUCHING_SHEETS_SINE**2
            tangent *= (dot(way, way) / dot(tangent, way))[:, None]
            tangent[touching] = way[touching]
        p, q = self._points(at, there)
        met = (last <= MISSED_OF_CHORD * long) & (np.sqrt(dot(p - q, p - q)) <= MISSED_OF_CHORD * long)
        found, known = Along(at, p, tangent, there), np.isfinite(tangent).all(axis=1)
        rough = np.flatnonzero(~(met & known))
        if len(rough):
            other, lost = self._roughly(chords.take(rough), part[rough]), ~met[rough]
            found.slopes[rough] = other.slopes
            rough, other = rough[lost], other.take(np.flatnonzero(lost))
            at[rough], p[rough], there[rough] = other.places, other.points, other.second_places
        return found

    def _planes(self, places: Floats, second_places: Floats) -> tuple[TangentPlanes, TangentPlanes]:
        """The tangent planes of both sheets: of one that meets itself all at once."""
        if self.other is not self.surface:
            return self.surface.planes(places), self.other.planes(second_places)
        both, half = self.surface.planes(np.concatenate([places, second_places])), len(places)
        return records.take(both, np.arange(half)), records.take(both, np.arange(half, 2 * half))

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
        faces = ImplicitSection(self.surface.surface_at(chords.places[0]), Planes(normals, dot(points, normals)))
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
        faces = Planes(normals, dot(points, normals))
        return SpatialCurves(self.surface, self.sheet, faces).between(_level(chords), part)


def _level(chords: Chords) -> Chords:
    """The chords at level 0."""
    return Chords(chords.places, chords.points, chords.second_places, np.zeros_like(chords.level))


def _finite(places: Floats, else_: Floats) -> Floats:
    return np.where(np.isfinite(places).all(axis=1, keepdims=True), places, else_)


# Curves on a parametrised sheet that are known by points and by their directions there.

STEEPEST = 2.0
"""Where the parameters change faster at an end of a chord than so many times what they do along it, or not forwards,
their change says nothing of what is between, as beside a pole."""


@dataclass(frozen=True, eq=False)
class DirectedCurves:
    """Curves of which second places are directions: how the parameters grow by the length. Between two points they are
    cubic in the parameters, and straight where a direction is not known."""

    surface: OnParametrised
    sheet: int
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords.

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        start, end = chords.places
        surface = self.surface.surface_at(start)
        size = np.broadcast_to(from_components(*surface.domain.size), (len(part), 2))
        way = (end - start)[:, :2] / size
        one, two = (each[:, :2] / size for each in chords.second_places)
        both, far = one + two, STEEPEST * np.sqrt(dot(way, way))
        with np.errstate(all="ignore"):
            # As long as the way is if the parameters grow by the mean of both.
            long = 2.0 * dot(way, both) / dot(both, both)
            speed = long * np.sqrt(np.maximum(dot(one, one), dot(two, two)))
            known = (long > 0.0) & (speed <= far) & (dot(one, way) > 0.0) & (dot(two, way) > 0.0)
            leaving, arriving = (np.where(known[:, None], long[:, None] * each, way) for each in (one, two))
        t = part[:, None]
        bent, turned = 3.0 * way - 2.0 * leaving - arriving, leaving + arriving - 2.0 * way
        at = start + np.concatenate([t * (leaving + t * (bent + t * turned)) * size, 0.0 * t], axis=1)
        moved = (leaving + t * (2.0 * bent + 3.0 * t * turned)) * size
        u, v = inside(surface.domain, at)
        points, along_u, along_v = first_jets(surface, u, v)
        with np.errstate(all="ignore"):
            directions = np.where(known[:, None], np.insert(moved / long[:, None], 2, 0.0, axis=1), np.nan)
        return Along(at, points, moved[:, :1] * along_u + moved[:, 1:] * along_v, directions)
