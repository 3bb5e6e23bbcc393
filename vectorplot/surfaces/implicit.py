"""Implicit surfaces of functions that users write, and implicit surfaces boxed in or cut by planes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces.placed_surface import MovableImplicit, placed_shape
from vectorplot.surfaces.quadrics import checked_box
from vectorplot.surfaces.surface import ImplicitSurface, hessians

# Implicit surfaces of functions that users write.

# The places of xx, xy, xz, yy, yz and zz in a matrix.
_SYMMETRIC = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


@dataclass(frozen=True, eq=False)
class ImplicitFunction(MovableImplicit):
    """The zeros of a user's function within a box.

    box: (2, 3) the smallest and the largest coordinates; function: F; gradient: its gradient; degree: that of an
    algebraic surface, if known; bends: the second derivatives by xx, xy, xz, yy, yz and zz.
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


# Implicit surfaces of which a part is looked at.


@dataclass(frozen=True, eq=False)
class PartOfImplicit(MovableImplicit):
    """A part of an implicit surface; F is that of the whole one, everywhere."""

    surface: ImplicitSurface

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        return self.surface.values(points)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of F."""
        return self.surface.gradients(points)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives of F."""
        return np.asarray(hessians(self.surface, points))


# Implicit surfaces of which less is looked at than there is.


@dataclass(frozen=True, eq=False)
class BoxedImplicit(PartOfImplicit):
    """The part of an implicit surface within a box of its own.

    surface: F; box: (2, 3) smallest and largest coordinates of the part that is looked at, in world units.
    """

    box: Floats


# Implicit surfaces of which parts are cut away by planes.


@dataclass(frozen=True, eq=False)
class CutImplicit(PartOfImplicit):
    """What is left of an implicit surface outside of some regions, or inside of one.

    surface: what is cut; regions: where nothing of it is left; within: and where all is that is left.
    """

    regions: tuple[HalfSpaces, ...]
    within: HalfSpaces | None = None

    @property
    def box(self) -> Floats:
        """(2,3) that of the surface."""
        return np.asarray(self.surface.box, dtype=np.float64)

    def transformed(self, matrix: ArrayLike) -> CutImplicit:  # type: ignore[override]
        """The surface and its planes under a matrix (4,4) that acts on columns."""
        rows = np.asarray(matrix, dtype=np.float64)
        regions = tuple(region.transformed(rows) for region in self.regions)
        within = None if self.within is None else self.within.transformed(rows)
        moved: ImplicitSurface = placed_shape(self.surface, rows)  # type: ignore[assignment]
        return CutImplicit(moved, regions, within)

    @property
    def inward(self) -> Floats:
        """(k,3) unit normals of all planes: those of the regions, one after the other, into what is left, then those of
        what it is within."""
        gone = [np.negative(region.normals) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [np.array(self.within.normals)])])

    @property
    def offsets(self) -> Floats:
        """(k,) of these planes: normal . p = offset."""
        gone = [np.negative(region.offsets) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [np.array(self.within.offsets)])])

    def heights(self, points: Floats) -> Floats:
        """(k, ...) how far points (..., 3) are before these planes, on the side of what is left."""
        gone = [-region.heights(points) for region in self.regions]
        return np.concatenate([*gone, *([] if self.within is None else [self.within.heights(points)])])

    def beyond(self, points: Floats) -> Floats:
        """(...,) how far points (..., 3) are beyond the borders of what is left; negative: how far before them."""
        gone = [region.heights(points).min(axis=0) for region in self.regions]
        within = [] if self.within is None else [-self.within.heights(points).min(axis=0)]
        return np.asarray(np.max([*gone, *within], axis=0))

    def on_borders(self, points: Floats, tolerance: float) -> Bools:
        """(..., k) on which of the planes points (..., 3) lie, where these are borders."""
        on = [
            (np.abs(heights := region.heights(points)) <= tolerance) & (heights >= -tolerance).all(axis=0)
            for region in (*self.regions, *([] if self.within is None else [self.within]))
        ]
        return np.moveaxis(np.concatenate(on), 0, -1)
