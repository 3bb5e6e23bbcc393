"""Where somebody stands who looks all round, and which part of the round a picture shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.errors import InputError

MOST_STRIPS = 36
"""Strips that a panorama is cut into, at most."""

STEEPEST_DEG = 80.0
"""Elevations are shown up to this angle: on the page what is higher is wider and wider."""


@dataclass(frozen=True)
class Panorama:
    """Somebody who looks all round, in place of a camera: bearings run evenly along the page, elevations up it.

    Parameters
    ----------
    place : (float, float, float) or (float, float)
        The eye, in world coordinates; or x and y of a place on a terrain, above which the eye is.
    above : float, optional
        How high above the terrain the eye is, where the place has no height; a five-hundredth of the width of the scene
        where None.
    middle_deg : float
        The bearing in the middle of the picture, clockwise from north, which is along y: 180 is south.
    width_deg : float
        How much of the round is shown; more than 0, at most 360.
    strips : int, optional
        Into how many strips, one below the other, the picture is cut, 1 to 36; where None as many as make it largest.
    lowest_deg, highest_deg : float
        Elevations between which lines are shown; between -80 and 80.

    Raises
    ------
    InputError
        For numbers out of range, or that are not finite.

    Notes
    -----
    A straight line of the world is no straight line on the page: the tangent of its elevation is a sine of the bearing.
    Circles of equal elevation, the horizon among them, are straight.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Panorama((3.0, 4.0)).bearings_deg
    (0.0, 360.0)
    """

    place: tuple[float, ...]
    above: float | None = None
    middle_deg: float = 180.0
    width_deg: float = 360.0
    strips: int | None = None
    lowest_deg: float = -20.0
    highest_deg: float = 60.0

    def __post_init__(self) -> None:
        place = tuple(float(x) for x in self.place)
        if len(place) not in (2, 3) or not np.isfinite(place).all():
            raise InputError("panorama: expected a place of two or three finite numbers")
        object.__setattr__(self, "place", place)
        if self.above is not None and not np.isfinite(self.above):
            raise InputError("panorama: expected a finite height above the terrain")
        if self.above is not None and len(place) > 2:
            raise InputError("panorama: a place with a height is above nothing; expected x and y only")
        if not np.isfinite(self.middle_deg):
            raise InputError("panorama: expected a finite bearing in the middle")
        if not 0.0 < self.width_deg <= 360.0:
            raise InputError(f"panorama: {self.width_deg:g} degrees wide, expected more than 0 and at most 360")
        if self.strips is not None and not 1 <= self.strips <= MOST_STRIPS:
            raise InputError(f"panorama: {self.strips} strips, expected 1 to {MOST_STRIPS}")
        if not -STEEPEST_DEG <= self.lowest_deg < self.highest_deg <= STEEPEST_DEG:
            raise InputError(
                f"panorama: elevations from {self.lowest_deg:g} to {self.highest_deg:g} degrees, expected them to rise "
                f"from {-STEEPEST_DEG:g} to {STEEPEST_DEG:g} at most"
            )

    @property
    def bearings_deg(self) -> tuple[float, float]:
        """The bearings at the left and at the right end."""
        return self.middle_deg - 0.5 * self.width_deg, self.middle_deg + 0.5 * self.width_deg
