"""Curves of one kind on one sheet: what is known of them between the points of their polylines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vectorplot.features.conditions import Condition
from vectorplot.features.implicit_conditions import SpatialCondition
from vectorplot.geometry.mesh import Floats
from vectorplot.visibility.smooth.implicit_sheet import ImplicitSheet
from vectorplot.visibility.smooth.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.sheet import dot

ROUNDS, RENEWED = 8, 4
"""Steps of Newton from a chord to its curve; the one at which slopes are computed anew."""

SETTLED = 1e-9
"""The step of Newton after one of this part of a chord is rounding."""

FARTHEST = 0.5
"""So many lengths of its chord a curve may be away from it."""


@dataclass(frozen=True, eq=False)
class Along:
    """Points of curves: places and points (k,3); slopes (k,3): derivatives by the part of the chord."""

    places: Floats
    points: Floats
    slopes: Floats


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

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part (k,) of chords from one place (k,3) and point (k,3) to another; level (k,): of each
        curve."""
        ...


@dataclass(frozen=True, eq=False)
class StraightLines:
    """Lines that are their own chords."""

    sheet: int = -1
    second: int = -1

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part of their chords."""
        slopes = points[1] - points[0]
        middle = points[0] + part[:, None] * slopes
        return Along(middle, middle, slopes)


@dataclass(frozen=True, eq=False)
class ParameterCurves:
    """Curves that are straight in the parameters: parameter lines, borders; and, nearly, those known by points only."""

    surface: ParametricSheet
    sheet: int
    second: int = -1

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part of their chords."""
        way = places[1] - places[0]
        at = places[0] + part[:, None] * way
        along_u, along_v = self.surface.partials(at)
        return Along(at, self.surface.points(at), way[:, :1] * along_u + way[:, 1:2] * along_v)


@dataclass(frozen=True, eq=False)
class ConditionCurves:
    """Curves of a parametrised surface along which a condition has the value of their level."""

    surface: ParametricSheet
    sheet: int
    condition: Condition
    second: int = -1

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part of their chords: from the chord straight across to where the condition holds."""
        size = np.array(self.surface.surface.domain.size)
        way = (places[1] - places[0])[:, :2] / size
        base = places[0][:, :2] / size + part[:, None] * way
        across = np.stack([-way[:, 1], way[:, 0]], axis=1)
        off = np.zeros(len(part))
        for again in range(ROUNDS):
            u, v = self.surface.parameters((base + off[:, None] * across) * size)
            # The chord is close to the curve: the slopes on it do, unless that does not lead there.
            if again in (0, RENEWED):
                slopes = np.stack(self.condition.slopes(u, v), axis=1) * size
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                step = (self.condition.values(u, v) - level) / (slopes * across).sum(axis=1)
            step = np.clip(np.where(np.isfinite(step), step, 0.0), -FARTHEST, FARTHEST)
            off = np.clip(off - step, -FARTHEST, FARTHEST)
            if not (np.abs(step) > SETTLED).any():
                break
        at = base + off[:, None] * across
        tangent = np.stack([-slopes[:, 1], slopes[:, 0]], axis=1)
        forward = (tangent * way).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            tangent = tangent * ((way * way).sum(axis=1) / forward)[:, None]
        tangent = np.where(np.isfinite(tangent).all(axis=1)[:, None], tangent, way)
        places_at = np.concatenate([at * size, np.zeros((len(at), 1))], axis=1)
        along_u, along_v = self.surface.partials(places_at)
        moved = tangent * size
        return Along(places_at, self.surface.points(places_at), moved[:, :1] * along_u + moved[:, 1:] * along_v)


@dataclass(frozen=True, eq=False)
class SpatialCurves:
    """Curves of an implicit surface along which a condition in space has the value of their level."""

    surface: ImplicitSheet
    sheet: int
    condition: SpatialCondition
    second: int = -1

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part of their chords: in the plane across the chord to where surface and condition meet."""
        way = points[1] - points[0]
        base = points[0] + part[:, None] * way
        farthest = FARTHEST * np.sqrt(dot(way, way))
        off = np.zeros_like(base)
        placed = self.surface.surface
        with np.errstate(all="ignore"):
            for again in range(ROUNDS):
                at = base + off
                if again in (0, RENEWED):
                    one, two = placed.gradients(at), self.condition.gradients(at)
                    across_one, across_two = np.cross(two, way), np.cross(way, one)
                    volume = dot(one, across_one)
                f, g = placed.values(at), self.condition.values(at) - level
                step = -(f[:, None] * across_one + g[:, None] * across_two) / volume[:, None]
                step = _no_longer(step, farthest)
                off = _no_longer(off + step, farthest)
                if not (np.sqrt(dot(step, step)) > SETTLED * farthest).any():
                    break
            tangent = np.cross(one, two)
            tangent = tangent * (dot(way, way) / dot(tangent, way))[:, None]
        at = base + off
        return Along(at, at, np.where(np.isfinite(tangent.sum(axis=1, keepdims=True)), tangent, way))


@dataclass(frozen=True, eq=False)
class NearChords:
    """Curves of an implicit surface known by points only: between these, what lies on the surface above the chord."""

    surface: ImplicitSheet
    sheet: int
    second: int = -1

    def between(
        self, places: tuple[Floats, Floats], points: tuple[Floats, Floats], part: Floats, level: Floats
    ) -> Along:
        """The curves at a part of their chords."""
        way = points[1] - points[0]
        at = points[0] + part[:, None] * way
        for _ in range(ROUNDS):
            at = self.surface.points(at)
        normal = self.surface.normals(at)
        slopes = way - dot(way, normal)[:, None] * normal
        return Along(at, at, np.where(np.isfinite(slopes), slopes, way))


def _no_longer(steps: Floats, longest: Floats) -> Floats:
    """(k,3) the steps, those longer than this (k,) shortened; none where they are not finite."""
    steps = np.where(np.isfinite(steps.sum(axis=1, keepdims=True)), steps, 0.0)
    long = np.sqrt(dot(steps, steps))
    return np.asarray(steps * np.minimum(1.0, longest / np.maximum(long, 1e-300))[:, None])
