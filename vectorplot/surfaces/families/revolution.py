"""Surfaces of revolution: any curve turned about the z-axis."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.surfaces.families.motions import Screw
from vectorplot.surfaces.families.swept import Swept


def revolution_surface(generator: Curve, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v, closed after whole turns.

    Degenerate: where the curve meets the axis the surface has a pole; see `unit_normals`.
    Source: Glaeser, section 8.2, equation 11.
    """
    return Swept(generator, Screw(), start, end)
