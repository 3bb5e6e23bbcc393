"""Rotoidal surfaces: any curve turned about an axis that turns itself."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number
from vectorplot.surfaces.families.swept.motions import Rotoid
from vectorplot.surfaces.families.swept.swept import Swept


def rotoidal_surface(
    generator: Curve, ratio: float, distance: float, *, start: float = 0.0, end: float = 2.0 * np.pi
) -> Swept:
    """The surface of a curve turned by ratio v about the axis b, while b turns by v about the z-axis.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    ratio : float
        Turns about b for each turn of b.
    distance : float
        Of b from the z-axis, in world units.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        Closed in v where both turns are whole ones: a ratio p/q closes after v = 2 pi q.

    Raises
    ------
    InputError
        For numbers that are not finite, an empty range.

    Notes
    -----
    b is at first the line x = distance, z = 0, parallel to y. Far away from b the motion is helical.

    Source: Glaeser, section 8.2, equation 13, in the general form of erratum G8-06.

    Examples
    --------
    >>> from vectorplot import curves, surfaces
    >>> moebius = surfaces.rotoidal_surface(curves.Line((2, 0, 0), (2, 0, 0)), ratio=0.5, distance=3.0)
    >>> moebius.domain.closed_v
    False
    """
    motion = Rotoid(number("rotoidal surface: ratio", ratio), number("rotoidal surface: distance", distance))
    return Swept(generator, motion, start, end)
