"""Curves of one kind on one sheet: what is known of them between the points of their polylines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.implicit.implicit_conditions import SpatialCondition
from vectorplot.features.implicit.singular.singular_equations import SingularEquations, line_tangents, onto_lines
from vectorplot.features.parametric.conditions import SurfaceCondition
from vectorplot.features.parametric.holes.holes import beside_rim_chords
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import cross, dot, from_components
from vectorplot.surfaces.jets import first_jets
from vectorplot.surfaces.splines.spline_surface import SplineSurface
from vectorplot.surfaces.stacked import of_some
from vectorplot.tolerances.of_lengths import FAMILY_SETTLED
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import JUST_BEFORE
from vectorplot.visibility.smooth.sheets.implicit_sheet import ImplicitSheet
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised, inside

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

    def some(self, which: Ints | slice) -> Chords:
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

    def some(self, which: Ints | slice) -> Along:
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
