"""Spiral surfaces: any curve turned about the z-axis while it grows, as shells do."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number
from vectorplot.surfaces.families.swept.motions import SpiralMotion
from vectorplot.surfaces.families.swept.swept import Swept


def spiral_surface(generator: Curve, growth: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and enlarged from the origin by exp(growth v), as shells are.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    growth : float
        A whole turn enlarges by exp(2 pi growth).
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        With exact derivatives where the curve's are.

    Raises
    ------
    InputError
        For a growth that is not finite, an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> snail = surfaces.spiral_surface(curves.Circle((2, 0, 0), 1.0, axis=(0, 1, 0)), growth=0.2, end=6.0 * np.pi)
    >>> snail.domain.closed_u, snail.domain.closed_v
    (True, False)
    """
    return Swept(generator, SpiralMotion(number("spiral surface: growth", growth)), start, end)
