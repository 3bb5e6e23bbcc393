"""Parametrised surfaces of which parts are cut away by planes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain, Surface


@dataclass(frozen=True, eq=False)
class CutSurface(MovableSurface):
    """What is left of a parametrised surface outside of some regions, or inside of one.

    Parameters
    ----------
    surface : Surface
        What is cut.
    regions : tuple of HalfSpaces
        Where nothing of it is left.
    within : HalfSpaces, optional
        And where all is that is left.

    Notes
    -----
    Its points are those of the surface, exactly; what is cut away is a hole.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> from vectorplot.geometry import HalfSpaces
    >>> bowl = surfaces.CutSurface(surfaces.Sphere(), (HalfSpaces(((0.0, 0.0, 1.0),), (0.0,)),))
    >>> bowl.points(np.zeros(2), np.array([-0.5, 0.5]))[:, 2].round(6).tolist()
    [-0.479426, nan]
    """

    surface: Surface
    regions: tuple[HalfSpaces, ...]
    within: HalfSpaces | None = None

    @cached_property
    def domain(self) -> Domain:
        """That of the surface."""
        return self.surface.domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points; NaN where the surface is cut away."""
        points = np.asarray(self.surface.points(u, v), dtype=np.float64)
        gone = np.zeros(points.shape[:-1], dtype=np.bool_)
        with np.errstate(invalid="ignore"):
            for region in self.regions:
                gone |= region.is_inside(points)
            if self.within is not None:
                gone |= (self.within.heights(points) < 0.0).any(axis=0)
        return np.where(gone[..., None], np.nan, points)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)
