"""Half spaces: what lies before several planes at once, such as the corner that is cut out of a body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import ROUNDING

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class HalfSpaces:
    """The points p with normal . p > offset for all of some planes: a convex region, with or without bounds.

    Parameters
    ----------
    normals : tuple of (float, float, float)
        Unit vectors that lead into the region.
    offsets : tuple of float
        In world units, as many.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.geometry import HalfSpaces
    >>> quarter = HalfSpaces(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), (0.0, 2.0))
    >>> quarter.heights(np.array([(1.0, 5.0, 0.0), (1.0, 1.0, 0.0)])).tolist()
    [[1.0, 1.0], [3.0, -1.0]]
    """

    normals: tuple[Vector, ...]
    offsets: tuple[float, ...]

    def heights(self, points: Floats) -> Floats:
        """How far points lie before each of the planes.

        Parameters
        ----------
        points : (..., 3) array of float
            In world units.

        Returns
        -------
        (k, ...) array of float
            Negative behind a plane.
        """
        normals = np.array(self.normals)
        feet = normals * np.array(self.offsets)[:, None]
        # From a point of the plane: far from the origin nothing is lost.
        return np.stack([matmul(points - foot, normal) for normal, foot in zip(normals, feet, strict=True)])

    def is_inside(self, points: Floats) -> np.ndarray:
        """Which points are in the region.

        Parameters
        ----------
        points : (..., 3) array of float
            In world units.

        Returns
        -------
        (...,) array of bool
            False on the planes.
        """
        return np.asarray((self.heights(points) > 0.0).all(axis=0))

    def is_border(self, points: Floats, tolerance: float) -> np.ndarray:
        """Which points are on the border of the region.

        Parameters
        ----------
        points : (..., 3) array of float
            In world units.
        tolerance : float
            A distance that counts as none.

        Returns
        -------
        (...,) array of bool
            Whether each is before no plane's back, and on one of them.
        """
        heights = self.heights(points)
        on = (np.abs(heights) <= tolerance).any(axis=0)
        return np.asarray(on & (heights >= -tolerance).all(axis=0))

    def transformed(self, matrix: Floats) -> HalfSpaces:
        """The same planes under a 4x4 matrix acting on columns.

        Parameters
        ----------
        matrix : (4, 4) array of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        HalfSpaces
            The moved region.
        """
        normals, offsets = moved_planes(np.array(self.normals), np.array(self.offsets), matrix)
        return HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))


def moved_planes(normals: Floats, offsets: Floats, matrix: Floats) -> tuple[Floats, Floats]:
    """(n,3) unit normals and (n,) offsets of planes, n . x = offset, under a 4x4 matrix acting on columns. One normal
    (1,3) may serve for all offsets.

    Degenerate: numpy's LinAlgError for a matrix that flattens space.
    """
    moved = linear_solution(matrix[:3, :3].T, normals.T).T
    lengths = np.linalg.norm(moved, axis=1)
    return moved / lengths[:, None], (offsets + matmul(moved, matrix[:3, 3])) / lengths


def nothing_beside(points: Floats) -> float:
    """The distance from a plane that counts as none for points (n,3): by their extent, and by what rounding does."""
    if not len(points):
        return 0.0
    extent = float(np.ptp(points, axis=0).max())
    return max(ZERO_OF_EXTENT * extent, ROUNDING * float(np.abs(points).max()))
