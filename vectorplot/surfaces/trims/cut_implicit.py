"""Implicit surfaces of which parts are cut away by planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.surfaces.placed_surface import placed_shape
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.surfaces.trims.part_of_implicit import PartOfImplicit


@dataclass(frozen=True, eq=False)
class CutImplicit(PartOfImplicit):
    """What is left of an implicit surface outside of some regions, or inside of one.

    Parameters
    ----------
    surface : ImplicitSurface
        What is cut.
    regions : tuple of HalfSpaces
        Where nothing of it is left.
    within : HalfSpaces, optional
        And where all is that is left.

    Notes
    -----
    F is that of the surface, everywhere; it is looked at only where something is left, and ends on the planes, exactly.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> from vectorplot.geometry import HalfSpaces
    >>> bowl = surfaces.CutImplicit(surfaces.implicit_sphere(1.0), (HalfSpaces(((0.6, 0.0, 0.8),), (0.0,)),))
    >>> bowl.beyond(np.array([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)])).tolist()
    [0.8, -0.8]
    """

    regions: tuple[HalfSpaces, ...]
    within: HalfSpaces | None = None

    @property
    def box(self) -> Floats:
        """(2,3) that of the surface."""
        return np.asarray(self.surface.box, dtype=np.float64)

    def transformed(self, matrix: ArrayLike) -> CutImplicit:  # type: ignore[override]
        """The surface and its planes under a matrix (4,4) that acts on columns."""
        rows = np.asarray(matrix, dtype=np.float64)
        regions = tuple(region.transformed(rows) for region in self.regions)
        within = None if self.within is None else self.within.transformed(rows)
        moved: ImplicitSurface = placed_shape(self.surface, rows)  # type: ignore[assignment]
        return CutImplicit(moved, regions, within)

    @property
    def inward(self) -> Floats:
        """(k,3) unit normals of all planes: those of the regions, one after the other, into what is left, then those of
        what it is within."""
        gone = [np.negative(region.normals) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [np.array(self.within.normals)])])

    @property
    def offsets(self) -> Floats:
        """(k,) of these planes: normal . p = offset."""
        gone = [np.negative(region.offsets) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [np.array(self.within.offsets)])])

    def heights(self, points: Floats) -> Floats:
        """(k, ...) how far points (..., 3) are before these planes, on the side of what is left."""
        gone = [-region.heights(points) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [self.within.heights(points)])])

    def beyond(self, points: Floats) -> Floats:
        """(...,) how far points (..., 3) are beyond the borders of what is left; negative: how far before them."""
        gone = [region.heights(points).min(axis=0) for region in self.regions]
        within = [] if self.within is None else [-self.within.heights(points).min(axis=0)]
        return np.asarray(np.max([*gone, *within], axis=0))

    def on_borders(self, points: Floats, tolerance: float) -> Bools:
        """(..., k) on which of the planes points (..., 3) lie, where these are borders."""
        on = [
            (np.abs(heights := region.heights(points)) <= tolerance) & (heights >= -tolerance).all(axis=0)
            for region in (*self.regions, *([] if self.within is None else [self.within]))
        ]
        return np.moveaxis(np.concatenate(on), 0, -1)
