"""Where curves pass from one piece to the next."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.placed_curve import PlacedCurve
from vectorplot.curves.splines.spline_curve import SplineCurve


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
    curve = _at_home(curve)
    return curve.breaks if isinstance(curve, PiecewiseCurve) and len(curve.breaks) > 2 else np.zeros(0)


def degree_of(curve: Curve) -> int:
    """Of which degree the polynomials are that the pieces of a curve are, or their quotients; 0 if there are none."""
    curve = _at_home(curve)
    return curve.order - 1 if isinstance(curve, SplineCurve) else 0


def weights_of(curve: Curve, t: Floats) -> Floats:
    """(k,) what the polynomials of a curve are divided by at parameters (k,): 1 where there is nothing."""
    curve = _at_home(curve)
    return curve.weight(t) if isinstance(curve, SplineCurve) else np.ones(len(t))


def is_weighted(curve: Curve) -> bool:
    """Whether the pieces of a curve are quotients of polynomials."""
    curve = _at_home(curve)
    return isinstance(curve, SplineCurve) and curve.weights is not None


def _at_home(curve: Curve) -> Curve:
    """What is placed, if it is."""
    while isinstance(curve, PlacedCurve):
        curve = curve.curve
    return curve
