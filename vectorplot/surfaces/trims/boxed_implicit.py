"""Implicit surfaces of which less is looked at than there is."""

from __future__ import annotations

from dataclasses import dataclass

from vectorplot.arrays import Floats
from vectorplot.surfaces.trims.part_of_implicit import PartOfImplicit


@dataclass(frozen=True, eq=False)
class BoxedImplicit(PartOfImplicit):
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

    box: Floats
