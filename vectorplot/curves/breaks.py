"""Where curves pass from one piece to the next."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.placed import PlacedCurve


@runtime_checkable
class PiecewiseCurve(Protocol):
    """A curve of several pieces, each of them smooth up to its ends: at breaks it may bend suddenly, or turn."""

    @property
    def breaks(self) -> Floats:
        """(k,) the parameters between which it is one piece, rising, start and end among them."""
        ...


def breaks_of(curve: Curve) -> Floats:
    """(k,) the parameters at which a curve passes from one piece to the next, those of its ends among them; none where
    it is a single piece."""
    while isinstance(curve, PlacedCurve):
        curve = curve.curve
    return curve.breaks if isinstance(curve, PiecewiseCurve) and len(curve.breaks) > 2 else np.zeros(0)
