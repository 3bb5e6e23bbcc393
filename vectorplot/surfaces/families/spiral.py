"""Spiral surfaces: any curve turned about the z-axis while it grows, as shells do."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number
from vectorplot.surfaces.families.motions import SpiralMotion
from vectorplot.surfaces.families.swept import Swept


def spiral_surface(generator: Curve, growth: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and enlarged from the origin by exp(growth v).

    A whole turn enlarges by exp(2 pi growth). Source: Glaeser, section 8.2, equation 14.
    """
    return Swept(generator, SpiralMotion(number("spiral surface: growth", growth)), start, end)
