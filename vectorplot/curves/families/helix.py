"""Helices: circles that rise."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.families.circle import Circle
from vectorplot.curves.parameters import number
from vectorplot.curves.placed_curve import MovableCurve


@dataclass(frozen=True, eq=False)
class Helix(MovableCurve):
    """The path of a point that turns about an axis and rises along it by `rise` for each radian.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    rise : float
        World units a radian: above 0 the helix is right-handed, and 2 pi rise is the height of one turn.
    centre : (3,) array_like of float
        Of the circle that the point is on at t = 0.
    axis : (3,) array_like of float
        Of any length; z where nothing is said.
    start, end : float
        The angles of the two ends, in radians.

    Raises
    ------
    InputError
        For a radius that is not positive, an axis without length, an empty range of angles, and numbers that are not
        finite.

    Notes
    -----
    At t = 0 the point is where the circle of the same centre, radius and axis starts.

    Source: Glaeser, section 8.2, equation 12, u constant.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Helix
    >>> spring = Helix(radius=2, rise=1 / (2 * np.pi), end=6 * np.pi)
    >>> spring.points(np.array([spring.start, spring.end])).round(9).tolist() == [[2.0, 0.0, 0.0], [2.0, 0.0, 3.0]]
    True
    """

    radius: float
    rise: float
    centre: ArrayLike = (0.0, 0.0, 0.0)
    axis: ArrayLike = (0.0, 0.0, 1.0)
    start: float = 0.0
    end: float = 2.0 * np.pi
    closed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        number("helix: rise", self.rise)
        circle = self._round
        object.__setattr__(self, "centre", circle.centre)
        object.__setattr__(self, "axis", circle.axis)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(self._round.points(t) + np.asarray(t)[..., None] * self._upwards)

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return np.asarray(self._round.tangents(t) + self._upwards)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t: those of the circle."""
        return self._round.second_derivatives(t)

    @cached_property
    def _round(self) -> Circle:
        return Circle(self.centre, self.radius, self.axis, self.start, self.end)

    @cached_property
    def _upwards(self) -> Floats:
        return np.asarray(self.rise * self._round.frame[2])
