"""One condition on many surfaces, or on many levels, asked at once: every pair of parameters may be another's."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.parametric.conditions import Condition, Slopes, SurfaceCondition
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import StackedSurfaces
from vectorplot.surfaces.surface import Domain, Surface

MOST_PARAMETERS = 1 << 16
"""Pairs of parameters that grids on the surfaces asked at once may have in all: what is known of them fills memory."""

C = TypeVar("C", bound=Condition)
S = TypeVar("S", bound=SurfaceCondition)
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class SurfacesAtOnce:
    """Several surfaces that are closed in the same directions.

    surfaces (s,): at least one; surface: what is asked for k pairs of parameters, each of the surface with the number
    of (k,).
    """

    surfaces: tuple[Surface, ...]
    surface: Callable[[Ints], Surface]

    @classmethod
    def of(cls, surfaces: Sequence[Surface]) -> SurfacesAtOnce:
        """A single surface of any kind, or the surfaces of one of `stacks`."""
        if len(surfaces) == 1:
            return cls(tuple(surfaces), lambda of: surfaces[0])
        placed = (surface for surface in surfaces if isinstance(surface, PlacedSurface))
        return cls(tuple(surfaces), StackedSurfaces(tuple(placed)).at)

    def __len__(self) -> int:
        return len(self.surfaces)

    @property
    def domains(self) -> list[Domain]:
        """(s,) those of the surfaces."""
        return [surface.domain for surface in self.surfaces]

    def on_grids(self, columns: int, rows: int) -> tuple[Floats, Floats, Ints]:
        """Parameters u, v that divide the domains evenly, surface after surface, and the numbers of these, each
        (s (columns+1) (rows+1),)."""
        pairs = [np.meshgrid(*domain.grid(columns, rows), indexing="ij") for domain in self.domains]
        u, v = (np.stack([pair[axis] for pair in pairs]).ravel() for axis in (0, 1))
        return u, v, np.repeat(np.arange(len(self)), (columns + 1) * (rows + 1))


@dataclass(frozen=True, eq=False)
class StackedConditions(SurfacesAtOnce, Generic[C]):
    """A condition on each of several surfaces; at: that on the surfaces with the numbers (k,), asked for k pairs of
    parameters."""

    at: Callable[[Ints], C]


def alone(surface: Surface, condition: C) -> StackedConditions[C]:
    """A condition on a single surface of any kind."""
    return StackedConditions((surface,), lambda of: surface, lambda of: condition)


@dataclass(frozen=True, eq=False)
class OnLevels:
    """f = c of a condition f = 0, with a level c for each pair of parameters (k,)."""

    condition: Condition
    levels: Floats

    def values(self, u: Floats, v: Floats) -> Floats:
        """(k,) f, less c."""
        return self.condition.values(u, v) - self.levels

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(k,) derivatives by u and by v."""
        return self.condition.slopes(u, v)


def on_levels(surface: Surface, condition: Condition, levels: Floats) -> StackedConditions[OnLevels]:
    """A condition on a single surface of any kind, on each of levels (s,)."""
    return StackedConditions((surface,) * len(levels), lambda of: surface, lambda of: OnLevels(condition, levels[of]))


def stacked(surfaces: Sequence[Surface], condition: S) -> StackedConditions[S]:
    """A condition on the first of several surfaces, and the same on the others: one of `stacks`."""
    if len(surfaces) == 1:
        return alone(surfaces[0], condition)
    together = SurfacesAtOnce.of(surfaces)
    surface = together.surface
    return StackedConditions(together.surfaces, surface, lambda of: condition.on(surface(of), of))


def stacks(surfaces: Sequence[Surface], parameters: int) -> list[Ints]:
    """The numbers of surfaces, in parts that can be asked at once for so many pairs of parameters of each: placed ones
    that are closed in the same directions; others stand alone."""
    members: dict[object, list[int]] = {}
    for number, surface in enumerate(surfaces):
        domain = surface.domain
        key = (domain.closed_u, domain.closed_v) if isinstance(surface, PlacedSurface) else number
        members.setdefault(key, []).append(number)
    most = max(1, MOST_PARAMETERS // parameters)
    return [np.array(own[k : k + most]) for own in members.values() for k in range(0, len(own), most)]


def for_each(
    surfaces: Sequence[Surface], parameters: int, found: Callable[[tuple[Surface, ...]], Sequence[T]]
) -> list[T]:
    """What is found of each of the surfaces, asked stack by stack for so many pairs of parameters of each."""
    results: dict[int, T] = {}
    for which in stacks(surfaces, parameters):
        numbers = which.tolist()
        results.update(zip(numbers, found(tuple(surfaces[k] for k in numbers)), strict=True))
    return [results[k] for k in range(len(surfaces))]
