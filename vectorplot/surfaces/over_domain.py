"""Surfaces over other domains than their own, which close otherwise."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.arrays import Floats
from vectorplot.surfaces.surface import Domain, Surface


@dataclass(frozen=True, eq=False)
class OverDomain:
    """The points of a surface over a part of its domain, or over one that does not close where its own does."""

    surface: Surface
    domain: Domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.surface.points(u, v)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)
