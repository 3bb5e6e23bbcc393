"""Lights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import norm
from vectorplot.words import check_colour

Exposure = float | Literal["fitted"]
"""What the intensities of all lights are taken times; fitted: such that what is brightest is not too bright."""

LARGEST_EXPOSURE = 1e6
"""Brighter pictures show light and dark alone."""


def check_exposure(exposure: object) -> None:
    """An InputError for what is no exposure."""
    right = isinstance(exposure, int | float) and 0.0 < exposure <= LARGEST_EXPOSURE
    if exposure != "fitted" and not right:
        told = f"{exposure:g}" if isinstance(exposure, int | float) else repr(exposure)
        raise InputError(f"exposure {told}: expected fitted, or a positive factor of at most {LARGEST_EXPOSURE:g}")


@dataclass(frozen=True)
class Light:
    """A light source at a point, or with parallel rays coming from the direction ``position``.

    Parameters
    ----------
    position : (float, float, float)
        The point in world coordinates, or the direction that parallel rays come from.
    parallel : bool
        Whether its rays are parallel.
    intensity : float, optional
        0 to 1 (None: 1 / sqrt(l) in a scene with l lights).
    name : str
        What messages call it.
    colour : str
        white, a palette or #rrggbb.
    fading : bool
        The light of a lamp becomes weaker with the square of the distance.

    Raises
    ------
    InputError
        For unknown colours and intensities out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> sun = vp.Light((1, -1, 2), parallel=True, intensity=0.8, name="SUN")
    >>> sun.colour
    'white'
    """

    position: tuple[float, float, float]
    parallel: bool = False
    intensity: float | None = None
    name: str = ""
    colour: str = "white"
    fading: bool = False

    def __post_init__(self) -> None:
        check_colour(self.colour, f"light {self.name}: " if self.name else "light: ")
        if self.intensity is not None and not 0.0 <= self.intensity <= 1.0:
            raise InputError(f"light {self.name}: an intensity of {self.intensity:g}: expected 0 to 1")


WIDEST_COSINE = 0.5
"""A lamp that sees a corner of something more than 60 degrees off its middle needs six images of it."""


def is_amid(light: Light, points: Floats) -> bool:
    """Whether a lamp stands in the box about points (n,3), or so close to it that one image would be too wide."""
    if light.parallel:
        return False
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
    place = np.asarray(light.position, dtype=np.float64)
    arm, middle = corners - place, (low + high) / 2.0 - place
    cosine = matmul(arm, middle)
    return bool((cosine <= WIDEST_COSINE * np.linalg.norm(arm, axis=1) * norm(middle)).any())
