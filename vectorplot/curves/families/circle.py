"""Circles in space, and arcs of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import is_whole_turns, parameter_range, positive, vector
from vectorplot.curves.placed_curve import MovableCurve
from vectorplot.errors import InputError
from vectorplot.geometry.rotations import axis_frame


@dataclass(frozen=True, eq=False)
class Circle(MovableCurve):
    """The circle about an axis of any direction, t the angle; an arc of it where start and end say so.

    Parameters
    ----------
    centre : (3,) array_like of float
        In world units.
    radius : float
        Positive, in world units.
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
    It starts at the horizontal direction that stands on the axis, and turns counter-clockwise seen from the axis' tip.
    Degenerate: for an upright axis it starts in the direction of x.

    Source: Glaeser, section 8.1, equations 3 and 4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Circle
    >>> Circle(radius=2, axis=(1, 0, 0)).points(np.array([0.0, np.pi / 2])).round(9).tolist()
    [[0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]
    >>> Circle().closed, Circle(end=np.pi).closed
    (True, False)
    """

    centre: ArrayLike = (0.0, 0.0, 0.0)
    radius: float = 1.0
    axis: ArrayLike = (0.0, 0.0, 1.0)
    start: float = 0.0
    end: float = 2.0 * np.pi

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", vector("circle: centre", self.centre))
        object.__setattr__(self, "axis", vector("circle: axis", self.axis))
        positive("circle: radius", self.radius)
        parameter_range("circle", self.start, self.end)
        if not np.any(self.axis):
            raise InputError("circle: an axis without length")

    @cached_property
    def frame(self) -> Floats:
        """(3,3) rows: the direction of t = 0, that of a quarter turn, the axis."""
        return axis_frame(self.axis)

    @property
    def closed(self) -> bool:
        """Whether the arc is a whole circle."""
        return is_whole_turns(self.end - self.start)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.centre) + self._spokes(t))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        e, f, _ = self.radius * self.frame
        return np.asarray(np.cos(t)[..., None] * f - np.sin(t)[..., None] * e)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t: towards the centre."""
        return -self._spokes(t)

    def _spokes(self, t: Floats) -> Floats:
        e, f, _ = self.radius * self.frame
        return np.asarray(np.cos(t)[..., None] * e + np.sin(t)[..., None] * f)
