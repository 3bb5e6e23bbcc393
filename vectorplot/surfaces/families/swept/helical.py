"""Helical surfaces: any curve screwed along the z-axis."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number
from vectorplot.surfaces.families.swept.motions import Screw
from vectorplot.surfaces.families.swept.swept import Swept


def helical_surface(generator: Curve, rise: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and raised by rise v.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    rise : float
        World units a radian: above 0 the surface is right-handed, and 2 pi rise is the height of one turn.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        A line sweeps a ruled helical surface, a circle a tubular one.

    Raises
    ------
    InputError
        For a rise that is not finite, an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> stairs = surfaces.helical_surface(curves.Line((0, 0, 0), (1, 0, 0)), rise=0.5)
    >>> stairs.points(np.array(1.0), np.array(2.0 * np.pi)).round(9).tolist() == [1.0, 0.0, 3.141592654]
    True
    """
    return Swept(generator, Screw(number("helical surface: rise", rise)), start, end)
