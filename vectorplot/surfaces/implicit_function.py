"""Implicit surfaces of functions that users write."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.surfaces.families.quadric import checked_box
from vectorplot.surfaces.placed_surface import MovableImplicit

# The places of xx, xy, xz, yy, yz and zz in a matrix.
_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


@dataclass(frozen=True, eq=False)
class ImplicitFunction(MovableImplicit):
    """The zeros of a user's function within a box.

    Parameters
    ----------
    box : (2, 3) array of float
        The smallest and the largest coordinates.
    function : NumericFunction
        F.
    gradient : NumericFunction, optional
        Its gradient; without it, it is found from F.
    degree : int, optional
        That of an algebraic surface, if known.
    bends : NumericFunction, optional
        The second derivatives by xx, xy, xz, yy, yz and zz; without it, they are found from the first ones.

    Notes
    -----
    Made by `implicit_of_function`. Where the function is not finite F is NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> saddle = surfaces.implicit_of_function(lambda x, y, z: x * y - z, [(-1, -1, -1), (1, 1, 1)])
    >>> isinstance(saddle, surfaces.ImplicitFunction), float(saddle.values(np.array([1.0, 0.5, 0.0])))
    (True, 0.5)
    """

    box: Floats
    function: NumericFunction
    gradient: NumericFunction | None = None
    degree: int | None = None
    bends: NumericFunction | None = None

    def values(self, points: Floats) -> Floats:
        """(...,) F, NaN where the function is not finite."""
        return np.asarray(self.function.values(*_coordinates(points))[..., 0])

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        xyz = _coordinates(points)
        if self.gradient is not None:
            return self.gradient.values(*xyz)
        return np.concatenate(self.function.gradient(*xyz), axis=-1)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        xyz = _coordinates(points)
        if self.bends is not None:
            return np.asarray(self.bends.values(*xyz)[..., _SYMMETRIC])
        if self.gradient is not None:
            rows = np.stack(self.gradient.gradient(*xyz), axis=-2)
            return np.asarray(0.5 * (rows + np.swapaxes(rows, -1, -2)))
        return np.concatenate(self.function.hessian(*xyz), axis=-1)[..., _SYMMETRIC]


def _coordinates(points: Floats) -> tuple[Floats, Floats, Floats]:
    p = np.asarray(points, dtype=np.float64)
    return p[..., 0], p[..., 1], p[..., 2]


def implicit_of_function(
    function: Callable[..., Any],
    box: ArrayLike,
    *,
    gradient: Callable[..., Any] | None = None,
    degree: int | None = None,
) -> ImplicitFunction:
    """The surface function(x, y, z) = 0 within a box.

    Parameters
    ----------
    function : callable
        Takes arrays x, y, z (n,) and returns (n,). One that takes single numbers works too, slower.
    box : (2, 3) array_like of float
        The smallest and the largest coordinates of the part that is looked at, in world units.
    gradient : callable, optional
        Three numbers likewise; without it, by complex step if the function takes complex numbers, else by differences.
    degree : int, optional
        That of an algebraic surface, if known.

    Returns
    -------
    ImplicitFunction
        An ImplicitSurface that knows its second derivatives too.

    Raises
    ------
    InputError
        Naming the function, when it raises, returns complex numbers or the wrong shape; for an empty box.

    Warns
    -----
    InputWarning
        Once for a function that takes one number at a time.

    Notes
    -----
    Derivatives by differences are of fourth order: first ones to about 1e-12 of the largest, second ones to about 1e-9.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cube = surfaces.implicit_of_function(lambda x, y, z: x**4 + y**4 + z**4 - 1, [(-1.1,) * 3, (1.1,) * 3])
    >>> cube.gradients(np.array([1.0, 0.0, 0.0])).round(9).tolist()
    [4.0, 0.0, 0.0]
    """
    limits = checked_box(box)
    ranges = [Range(float(low), float(high)) for low, high in limits.T]
    slopes = None if gradient is None else numeric_function(gradient, 3, ranges)
    return ImplicitFunction(limits, numeric_function(function, 1, ranges), slopes, degree)
