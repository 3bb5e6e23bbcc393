"""Windows of pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError


@dataclass(frozen=True)
class PixelWindow:
    """A window of width x height pixels.

    Parameters
    ----------
    width, height : float
        In pixels.
    pixel_ratio : float
        What a unit upwards is in pixels against one to the right; about -1 where rows count downwards.

    Raises
    ------
    InputError
        For sides that are not positive and finite, and a ratio that is zero or not finite.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.PixelWindow(640, 480).normalized([(320, 240), (640, 480)]).tolist()
    [[0.5, 0.5], [1.0, 1.0]]
    """

    width: float
    height: float
    pixel_ratio: float = 1.0

    def __post_init__(self) -> None:
        if not (0.0 < self.width < np.inf and 0.0 < self.height < np.inf and 0.0 < abs(self.pixel_ratio) < np.inf):
            raise InputError(f"a window of {self.width:g} x {self.height:g} pixels shows nothing")

    def normalized(self, pixels: ArrayLike) -> Floats:
        """Normalised device coordinates of pixels.

        Parameters
        ----------
        pixels : (..., 2 or more) array_like of float
            Further columns do not matter.

        Returns
        -------
        (..., 2) array of float
            0 to 1 from left to right and from the bottom to the top of the picture.

        Notes
        -----
        Source: Glaeser, section 2.3, equation 13, with the correction of erratum G2-02.
        """
        p = np.asarray(pixels, dtype=np.float64)[..., :2]
        half = np.array([self.width, self.height]) / 2.0
        return np.asarray(0.5 + (p - half) / (2.0 * half * np.array([1.0, np.sign(self.pixel_ratio)])))
