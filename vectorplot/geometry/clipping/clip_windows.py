"""Windows and boxes to clip by, and where points lie about them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError

LEFT, RIGHT, ABOVE, BELOW, INFRONT, BEHIND = 1, 2, 4, 8, 16, 32
"""Region codes; a point outside in two ways has their sum. Source: Cohen and Sutherland."""

Codes = NDArray[np.uint8]


@dataclass(frozen=True)
class Window:
    """A rectangle of the image: the clipping region.

    Parameters
    ----------
    min_x, max_x, min_y, max_y : float
        Its sides, min_x < max_x and min_y < max_y.

    Raises
    ------
    InputError
        Where it is empty.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.Window.of_size(640, 480)
    Window(min_x=0.0, max_x=640, min_y=0.0, max_y=480)
    """

    min_x: float
    max_x: float
    min_y: float
    max_y: float

    def __post_init__(self) -> None:
        if not (self.min_x < self.max_x and self.min_y < self.max_y):
            raise InputError("a clipping window needs min_x < max_x and min_y < max_y")

    @classmethod
    def of_size(cls, width: float, height: float) -> Window:
        """The whole window, from (0, 0) to (width, height).

        Parameters
        ----------
        width, height : float
            Both positive.

        Returns
        -------
        Window
            With min_x and min_y 0.

        Raises
        ------
        InputError
            Where it is empty.
        """
        return cls(0.0, width, 0.0, height)

    @property
    def sides(self) -> tuple[tuple[int, int, float, float], ...]:
        """Code, axis, limit and sign of each side: sign * (coordinate - limit) is negative outside."""
        return (
            (LEFT, 0, self.min_x, 1.0),
            (RIGHT, 0, self.max_x, -1.0),
            (ABOVE, 1, self.max_y, -1.0),
            (BELOW, 1, self.min_y, 1.0),
        )


@dataclass(frozen=True)
class Box:
    """A clipping window with depths after T2: far and near plane.

    Parameters
    ----------
    window : Window
        Its sides in the image.
    min_z : float
        The far plane.
    max_z : float
        The near plane.

    Raises
    ------
    InputError
        Where it is empty.

    Notes
    -----
    The initial values are z = -4 d and z = 0.8 d for an eye at the distance d.

    Source: Glaeser, section 2.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> box = geometry.Box(geometry.Window(-1, 1, -1, 1))
    >>> box.min_z, box.max_z, box.planes.shape
    (-0.8, 4.0, (6, 4))
    """

    window: Window
    min_z: float = -0.8
    max_z: float = 4.0

    def __post_init__(self) -> None:
        if not self.min_z < self.max_z:
            raise InputError("a clipping box needs min_z < max_z")

    @property
    def planes(self) -> Floats:
        """(6, 4) far, near, left, right, above, below: homogeneous points inside have products >= 0 with all rows."""
        w = self.window
        return np.array(
            [
                [0.0, 0.0, 1.0, -self.min_z],
                [0.0, 0.0, -1.0, self.max_z],
                [1.0, 0.0, 0.0, -w.min_x],
                [-1.0, 0.0, 0.0, w.max_x],
                [0.0, -1.0, 0.0, w.max_y],
                [0.0, 1.0, 0.0, -w.min_y],
            ]
        )


def region_codes(points: ArrayLike, region: Window | Box) -> Codes:
    """Sums of region codes of points: on which sides of a window or box they are outside.

    Parameters
    ----------
    points : (..., 2 or more) array_like of float
        x and y; for a box also the depth after T2.
    region : Window or Box
        The clipping region.

    Returns
    -------
    (...) array of uint8
        0 inside; 1 left, 2 right, 4 above, 8 below, of a box also 16 in front of it and 32 behind it.

    Notes
    -----
    A point is in front of a box also where z* < -1: it lies behind the eye.

    Source: Cohen and Sutherland; Glaeser, section 2.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> window = geometry.Window(0, 10, 0, 10)
    >>> geometry.region_codes([(5, 5), (-1, 5), (12, 12)], window).tolist()
    [0, 1, 6]
    """
    p = np.asarray(points, dtype=np.float64)
    codes = np.zeros(p.shape[:-1], dtype=np.uint8)
    window = region.window if isinstance(region, Box) else region
    for code, axis, limit, sign in window.sides:
        codes |= np.where(sign * (p[..., axis] - limit) < 0.0, code, 0).astype(np.uint8)
    if isinstance(region, Box):
        z = p[..., 2]
        front = (z > region.max_z) | (z < -1.0)
        codes |= np.where(front, INFRONT, np.where(z < region.min_z, BEHIND, 0)).astype(np.uint8)
    return codes
