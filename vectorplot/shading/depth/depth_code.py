"""Depths as whole numbers: the finest there is room for, and 16 bits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError


@dataclass(frozen=True)
class DepthCode:
    """Depths as whole numbers: first + steps * (depth - minimum) / (maximum - minimum), cut off.

    Parameters
    ----------
    minimum, maximum : float
        The depths that there are.
    first : float
        The code of the smallest depth; 0 is left for pixels without one.
    steps : float
        How many steps there are from the smallest to the largest.

    Raises
    ------
    InputError
        For an empty range.

    Notes
    -----
    Degenerate: where all depths are the same, so are the codes.

    Examples
    --------
    >>> from vectorplot.shading import DepthCode
    >>> code = DepthCode.ushort(0.0, 1.0)
    >>> code.code([0.0, 0.5, 1.0]).tolist()
    [1000, 33000, 65000]
    >>> code.depth([33000]).tolist(), code.step
    ([0.5], 1.5625e-05)
    """

    minimum: float
    maximum: float
    first: float
    steps: float

    def __post_init__(self) -> None:
        if not (-np.inf < self.minimum <= self.maximum < np.inf):
            raise InputError(f"depths from {self.minimum:g} to {self.maximum:g} are no range")

    @classmethod
    def ushort(cls, minimum: float, maximum: float) -> DepthCode:
        """The 16-bit code, from 1000 to 65000; 0 is left for pixels without a depth.

        Parameters
        ----------
        minimum, maximum : float
            The depths that there are.

        Returns
        -------
        DepthCode
            Of 64000 steps.

        Raises
        ------
        InputError
            For an empty range.

        Notes
        -----
        Source: Glaeser, section 7.3.
        """
        return cls(minimum, maximum, 1000.0, 64000.0)

    @classmethod
    def fine(cls, minimum: float, maximum: float, bits: int) -> DepthCode:
        """The finest code of so many bits.

        Parameters
        ----------
        minimum, maximum : float
            The depths that there are.
        bits : int
            Codes are less than 2^bits.

        Returns
        -------
        DepthCode
            From the code 2 on.

        Raises
        ------
        InputError
            For an empty range.
        """
        return cls(minimum, maximum, 2.0, float((1 << bits) - 5))

    @property
    def step(self) -> float:
        """How much depth a step is."""
        return (self.maximum - self.minimum) / self.steps

    def scaled(self, depth: ArrayLike) -> Floats:
        """The codes of depths before they are cut off.

        Parameters
        ----------
        depth : (...) array_like of float
            From minimum to maximum.

        Returns
        -------
        (...) array of float
            From first to first + steps.

        Raises
        ------
        InputError
            For depths outside the range: clip first.
        """
        d = np.asarray(depth, dtype=np.float64)
        if d.size and not (d.min() >= self.minimum and d.max() <= self.maximum):
            raise InputError(f"a depth lies outside the range from {self.minimum:g} to {self.maximum:g}: clip first")
        return self.of_any(d)

    def of_any(self, depth: ArrayLike) -> Floats:
        """The codes of depths before they are cut off, outside the range too.

        Parameters
        ----------
        depth : (...) array_like of float
            Any.

        Returns
        -------
        (...) array of float
            Below first and above first + steps for those outside the range.
        """
        d = np.asarray(depth, dtype=np.float64)
        size = self.maximum - self.minimum
        return np.asarray(self.first + self.steps * ((d - self.minimum) / (size if size > 0.0 else 1.0)))

    @property
    def rate(self) -> float:
        """How many steps a unit of depth is."""
        size = self.maximum - self.minimum
        return self.steps / (size if size > 0.0 else 1.0)

    def code(self, depth: ArrayLike) -> NDArray[np.int64]:
        """The codes of depths.

        Parameters
        ----------
        depth : (...) array_like of float
            From minimum to maximum.

        Returns
        -------
        (...) array of int64
            From first to first + steps.

        Raises
        ------
        InputError
            For depths outside the range: clip first.
        """
        return self.scaled(depth).astype(np.int64)

    def depth(self, code: ArrayLike) -> Floats:
        """The depths of codes, right to one step.

        Parameters
        ----------
        code : (...) array_like of int
            From first to first + steps.

        Returns
        -------
        (...) array of float
            From minimum to maximum.
        """
        return np.asarray(self.minimum + (np.asarray(code, dtype=np.float64) - self.first) * self.step)
