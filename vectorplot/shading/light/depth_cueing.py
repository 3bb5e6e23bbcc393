"""Lines that fade with their depth.

Source: Glaeser, section 4.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats

MIDDLE = 0.5
"""The shade of all edges without depth cueing, in the palette of their item."""

LEAST = 0.2
"""The shade of what is farthest away: the darkest fifth of a palette is not used."""


def depth_shades(depth: ArrayLike, farthest: float, nearest: float) -> Floats:
    """(...) shades from 0.2 for depths at the farthest limit, and beyond, to 1 at the nearest, and before it.

    Depths grow towards the eye. Degenerate: without depth between the limits everything is near.
    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    z = np.asarray(depth, dtype=np.float64)
    if not nearest > farthest:
        return np.ones(z.shape)
    return np.asarray(LEAST + (1.0 - LEAST) * np.clip((z - farthest) / (nearest - farthest), 0.0, 1.0))


def edge_shades(start: ArrayLike, end: ArrayLike, farthest: float, nearest: float) -> Floats:
    """(...) the shades of edges with their ends at these depths: the mean of the shades of both.

    Source: Glaeser, section 4.4, figure 2; errata G4-03, G4-04.
    """
    both = depth_shades(start, farthest, nearest), depth_shades(end, farthest, nearest)
    return np.asarray((both[0] + both[1]) / 2.0)
