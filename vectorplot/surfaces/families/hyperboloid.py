"""Hyperboloids and elliptic paraboloids about the z-axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number, parameter_range, positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import cosh, sinh
from vectorplot.surfaces.families.elliptic_sections import EllipticSections, OnSemiAxes, Profile
from vectorplot.surfaces.surface import Domain


def _semi_axes(name: str, value: ArrayLike) -> Floats:
    axes = vector(f"{name}: semi-axes", value)
    if not (axes > 0.0).all():
        raise InputError(f"{name}: semi-axes must be positive")
    return axes


def _check_heights(semi_axes: Floats, *heights: float) -> None:
    """Errors: InputError for a height that has no parameter, so large it is for its semi-axis."""
    with np.errstate(over="ignore"):
        if not np.isfinite(np.asarray(heights) / semi_axes[2]).all():
            raise InputError(f"hyperboloid: its heights are out of range for a semi-axis of {semi_axes[2]:g}")


@dataclass(frozen=True, eq=False)
class Hyperboloid(OnSemiAxes):
    """The hyperboloid of one sheet x^2/a^2 + y^2/b^2 - z^2/c^2 = 1, from height bottom to top.

    Parameters
    ----------
    semi_axes : (3,) array_like of float
        a, b and c, positive, in world units.
    bottom, top : float
        Heights above the centre; the waist is at 0.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For semi-axes that are not positive, a top that is not above the bottom, a centre that is not three finite
        numbers.

    Notes
    -----
    (a p cos u, b p sin u, c sinh v) with p = cosh v. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Hyperboloid
    >>> tower = Hyperboloid((2, 2, 3), bottom=-4, top=4)
    >>> tower.points(np.array(0.0), np.array(0.0)).tolist()
    [2.0, 0.0, 0.0]
    """

    semi_axes: ArrayLike = (1.0, 1.0, 1.0)
    bottom: float = -1.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "semi_axes", _semi_axes("hyperboloid", self.semi_axes))
        object.__setattr__(self, "centre", vector("hyperboloid: centre", self.centre))
        parameter_range("hyperboloid", self.bottom, self.top)
        _check_heights(np.asarray(self.semi_axes), self.bottom, self.top)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("semi_axes", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and v where the height is c sinh v."""
        c = np.asarray(self.semi_axes)[2]
        return Domain(0.0, 2.0 * np.pi, math.asinh(self.bottom / c), math.asinh(self.top / c), closed_u=True)

    def _profile(self, v: Floats) -> Profile:
        c = np.asarray(self.semi_axes)[..., 2]
        ch, sh = cosh(v), sinh(v)
        return (ch, c * sh), (sh, c * ch), (ch, c * sh)


@dataclass(frozen=True, eq=False)
class HyperboloidSheet(OnSemiAxes):
    """The upper sheet of x^2/a^2 + y^2/b^2 - z^2/c^2 = -1, from its lowest point z = c up to the height top.

    Parameters
    ----------
    semi_axes : (3,) array_like of float
        a, b and c, positive, in world units.
    top : float
        A height above the centre, more than c.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For semi-axes that are not positive, a top not above c, a centre that is not three finite numbers.

    Notes
    -----
    (a p cos u, b p sin u, c cosh v) with p = sinh v; v = 0 is a pole. Normals point out of the bowl, downwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import HyperboloidSheet
    >>> bowl = HyperboloidSheet((1, 1, 2), top=5)
    >>> bowl.points(np.array(0.0), np.array(0.0)).tolist()
    [0.0, 0.0, 2.0]
    """

    semi_axes: ArrayLike = (1.0, 1.0, 1.0)
    top: float = 2.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "semi_axes", _semi_axes("hyperboloid", self.semi_axes))
        object.__setattr__(self, "centre", vector("hyperboloid: centre", self.centre))
        if not number("hyperboloid: top", self.top) > np.asarray(self.semi_axes)[2]:
            raise InputError("hyperboloid: the top must be above the vertex")
        _check_heights(np.asarray(self.semi_axes), self.top)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("semi_axes", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and v where the height is c cosh v."""
        c = np.asarray(self.semi_axes)[2]
        return Domain(0.0, 2.0 * np.pi, 0.0, math.acosh(self.top / c), closed_u=True)

    def _profile(self, v: Floats) -> Profile:
        c = np.asarray(self.semi_axes)[..., 2]
        ch, sh = cosh(v), sinh(v)
        return (sh, c * ch), (ch, c * sh), (sh, c * ch)


@dataclass(frozen=True, eq=False)
class Paraboloid(EllipticSections):
    """The elliptic paraboloid z = x^2/a^2 + y^2/b^2 up to the height top.

    Parameters
    ----------
    a, b : float
        Positive.
    top : float
        A height above the vertex, positive, in world units.
    centre : (3,) array_like of float
        The vertex, in world units.

    Raises
    ------
    InputError
        For a, b or top not positive, a centre that is not three finite numbers.

    Notes
    -----
    (a v cos u, b v sin u, v^2); v = 0 is a pole. Normals point outwards (down).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Paraboloid
    >>> dish = Paraboloid(top=4.0)
    >>> dish.domain.v_end, dish.points(np.array(0.0), np.array(2.0)).tolist()
    (2.0, [2.0, 0.0, 4.0])
    """

    a: float = 1.0
    b: float = 1.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("paraboloid: a", self.a)
        positive("paraboloid: b", self.b)
        positive("paraboloid: top", self.top)
        object.__setattr__(self, "centre", vector("paraboloid: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("a", "b", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and the root of the height."""
        return Domain(0.0, 2.0 * np.pi, 0.0, float(np.sqrt(self.top)), closed_u=True)

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return self.a, self.b

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (v, v * v), (zero + 1.0, 2.0 * v), (zero, zero + 2.0)
