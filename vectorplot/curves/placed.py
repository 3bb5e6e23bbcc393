"""Curves moved to where they are wanted: turned, mirrored, scaled, shifted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import invertible, vector
from vectorplot.curves.second_derivatives import second_derivatives


@dataclass(frozen=True, eq=False)
class PlacedCurve:
    """A curve with its points x at x @ matrix + shift; rotations as in geometry.rotations.

    Errors: InputError for a matrix (3,3) that cannot be inverted, a shift that is not three numbers.
    """

    curve: Curve
    matrix: ArrayLike
    shift: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", invertible("a placement", self.matrix))
        object.__setattr__(self, "shift", vector("placement: shift", self.shift))

    @property
    def start(self) -> float:
        """That of the curve."""
        return self.curve.start

    @property
    def end(self) -> float:
        """That of the curve."""
        return self.curve.end

    @property
    def closed(self) -> bool:
        """Whether the curve is a smooth loop."""
        return self.curve.closed

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(self.curve.points(t) @ np.asarray(self.matrix) + np.asarray(self.shift))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return np.asarray(self.curve.tangents(t) @ np.asarray(self.matrix))

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        return np.asarray(second_derivatives(self.curve, t) @ np.asarray(self.matrix))
