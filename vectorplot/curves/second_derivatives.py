"""How a curve bends, whether it says so itself or not."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.derivatives import Range, numeric_function


@runtime_checkable
class BendingCurve(Protocol):
    """A curve that knows its second derivatives; all curves of this package do."""

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        ...


def second_derivatives(curve: Curve, t: Floats) -> Floats:
    """(..., 3) second derivatives of the curve at the parameters t (...).

    Error: those a curve gives itself are as good as it says; else differences of its tangents, about 1e-12.
    """
    if isinstance(curve, BendingCurve):
        return curve.second_derivatives(t)
    tangents = numeric_function(curve.tangents, 3, [Range(curve.start, curve.end, curve.closed)], name="tangents")
    return tangents.derivatives(0, np.asarray(t, dtype=np.float64))
