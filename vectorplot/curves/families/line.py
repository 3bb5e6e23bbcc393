"""Straight lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import parameter_range, vector
from vectorplot.curves.placed_curve import MovableCurve
from vectorplot.errors import InputError


@dataclass(frozen=True, eq=False)
class Line(MovableCurve):
    """The points p + t q of a straight line, start <= t <= end.

    Parameters
    ----------
    point : (3,) array_like of float
        Where t is 0.
    direction : (3,) array_like of float
        From there to where t is 1.
    start, end : float
        The first and the last parameter.

    Raises
    ------
    InputError
        For a direction without length, an empty range, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 8.1, equation 2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Line
    >>> Line.through((0, 0, 0), (2, 0, 4)).points(np.array([0.0, 0.5, 1.0])).tolist()
    [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [2.0, 0.0, 4.0]]
    """

    point: ArrayLike
    direction: ArrayLike
    start: float = 0.0
    end: float = 1.0
    closed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", vector("line: point", self.point))
        object.__setattr__(self, "direction", vector("line: direction", self.direction))
        if not np.any(self.direction):
            raise InputError("line: a direction without length")
        parameter_range("line", self.start, self.end)

    @classmethod
    def through(cls, p: ArrayLike, q: ArrayLike) -> Line:
        """The line from P (t = 0) to Q (t = 1)."""
        first = vector("line: point", p)
        return cls(first, vector("line: point", q) - first)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.point) + np.asarray(t)[..., None] * np.asarray(self.direction))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) the direction, everywhere."""
        return np.broadcast_to(np.asarray(self.direction), (*np.shape(t), 3)).copy()

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) zeros."""
        return np.zeros((*np.shape(t), 3))
