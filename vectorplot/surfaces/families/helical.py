"""Helical surfaces: any curve screwed along the z-axis."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number
from vectorplot.surfaces.families.motions import Screw
from vectorplot.surfaces.families.swept import Swept


def helical_surface(generator: Curve, rise: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and raised by rise v.

    rise > 0: right-handed; 2 pi rise is the height of one turn. A line sweeps a ruled helical surface, a circle a
    tubular one. Source: Glaeser, section 8.2, equation 12.
    """
    return Swept(generator, Screw(number("helical surface: rise", rise)), start, end)
