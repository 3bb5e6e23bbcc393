"""How the parts of a scene are to be moved apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import norm

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""Axes by their names."""


@dataclass(frozen=True)
class Explosion:
    """The parts of a scene are moved apart along an axis, as `vp.exploded` does it, when the scene is shown.

    Parameters
    ----------
    axis : {"x", "y", "z"} or (float, float, float)
        The first part stays, the others move along it.
    factor : float
        As of `vp.exploded`; 1 or more.

    Raises
    ------
    InputError
        For another axis, and a factor out of range.

    Examples
    --------
    >>> from vectorplot.scene import Explosion
    >>> Explosion("z").way.tolist()
    [0.0, 0.0, 1.0]
    """

    axis: str | tuple[float, float, float] = "z"
    factor: float = 1.5

    def __post_init__(self) -> None:
        _ = self.way
        if not 1.0 <= self.factor < np.inf:
            raise InputError(f"explode: a factor of {self.factor:g}: expected a finite number, 1 or more")

    @property
    def way(self) -> Floats:
        """(3,) the direction of the axis, of length 1."""
        return direction_of(self.axis)

    def transformed(self, matrix: ArrayLike) -> Explosion:
        """The explosion under a 4x4 matrix acting on columns.

        Parameters
        ----------
        matrix : (4, 4) array_like of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        Explosion
            Along the moved axis.

        Examples
        --------
        >>> import numpy as np
        >>> from vectorplot.scene import Explosion
        >>> Explosion("x").transformed(np.diag([-2.0, 1.0, 1.0, 1.0])).way.tolist()
        [-1.0, 0.0, 0.0]
        """
        x, y, z = (matmul(np.asarray(matrix, dtype=np.float64)[:3, :3], self.way)).tolist()
        return replace(self, axis=(x, y, z))


def direction_of(axis: str | Sequence[float] | ArrayLike) -> Floats:
    """(3,) the direction, of length 1, of an axis by its name or its numbers. Errors: InputError for what is none."""
    way = np.asarray(AXES.get(axis, (0.0, 0.0, 0.0)) if isinstance(axis, str) else axis, dtype=np.float64)
    if way.shape != (3,) or not np.isfinite(way).all() or not way.any():
        raise InputError(f"explode: an axis {axis!r}: expected x, y, z or a direction")
    way = way / np.abs(way).max()
    return np.asarray(way / norm(way))
