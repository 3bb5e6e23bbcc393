"""Implicit surfaces of which less is looked at than there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.placed_surface import MovableImplicit
from vectorplot.surfaces.surface import ImplicitSurface, hessians


@dataclass(frozen=True, eq=False)
class BoxedImplicit(MovableImplicit):
    """The part of an implicit surface within a box of its own.

    Parameters
    ----------
    surface : ImplicitSurface
        F.
    box : (2, 3) array of float
        Smallest and largest coordinates of the part that is looked at, in world units.

    Notes
    -----
    It ends on the sides of the box, exactly.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> bowl = surfaces.BoxedImplicit(ball, np.array([(-1.1, -1.1, -1.1), (1.1, 1.1, 0.0)]))
    >>> bowl.values(np.array([(0.0, 0.0, -1.0)])).tolist()
    [0.0]
    """

    surface: ImplicitSurface
    box: Floats

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        return self.surface.values(points)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of F."""
        return self.surface.gradients(points)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives of F."""
        return np.asarray(hessians(self.surface, points))
