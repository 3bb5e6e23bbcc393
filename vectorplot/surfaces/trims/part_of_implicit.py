"""Implicit surfaces of which a part is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.placed_surface import MovableImplicit
from vectorplot.surfaces.surface import ImplicitSurface, hessians


@dataclass(frozen=True, eq=False)
class PartOfImplicit(MovableImplicit):
    """A part of an implicit surface; F is that of the whole one, everywhere."""

    surface: ImplicitSurface

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        return self.surface.values(points)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of F."""
        return self.surface.gradients(points)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives of F."""
        return np.asarray(hessians(self.surface, points))
