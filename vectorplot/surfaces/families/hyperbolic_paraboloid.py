"""The hyperbolic paraboloid, a saddle."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True, eq=False)
class HyperbolicParaboloid(MovableSurface):
    """The saddle z = x^2/a^2 - y^2/b^2 above the rectangle from -width, -depth to width, depth.

    Parameters
    ----------
    a, b : float
        Positive.
    width, depth : float
        Half the sides of the rectangle, positive, in world units.
    centre : (3,) array_like of float
        The saddle point, in world units.

    Raises
    ------
    InputError
        For numbers that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    u is x, v is y; normals point upwards. It is the translation surface of its two parabolas u = const. and v = const.;
    u/a + v/b = const. and u/a - v/b = const. are its straight lines.

    Source: Glaeser, section 8.2, figure 3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import HyperbolicParaboloid
    >>> HyperbolicParaboloid(a=1.0, b=2.0).points(np.array(1.0), np.array(1.0)).tolist()
    [1.0, 1.0, 0.75]
    """

    a: float = 1.0
    b: float = 1.0
    width: float = 1.0
    depth: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("a", "b", "width", "depth"):
            positive(f"hyperbolic paraboloid: {name}", getattr(self, name))
        object.__setattr__(self, "centre", vector("hyperbolic paraboloid: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("a", "b", "centre")

    @property
    def domain(self) -> Domain:
        """The rectangle."""
        return Domain(-self.width, self.width, -self.depth, self.depth)

    @property
    def embedded(self) -> bool:
        """True: it is a graph."""
        return True

    @property
    def place(self) -> Floats:
        """(3,) the centre."""
        return np.asarray(self.centre)

    def about_origin(self) -> HyperbolicParaboloid:
        """The same surface with its centre in the origin."""
        return replace(self, centre=(0.0, 0.0, 0.0))

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.centre) + _vectors(u, v, (u / self.a) ** 2 - (v / self.b) ** 2))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        slope_u, slope_v = 2.0 * u / self.a**2 + 0.0 * v, -2.0 * v / self.b**2 + 0.0 * u
        return _vectors(1.0, 0.0, slope_u), _vectors(0.0, 1.0, slope_v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        zero = 0.0 * (u + v)
        return (
            _vectors(0.0, 0.0, zero + 2.0 / self.a**2),
            _vectors(0.0, 0.0, zero),
            _vectors(0.0, 0.0, zero - 2.0 / self.b**2),
        )


def _vectors(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Floats:
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1).astype(np.float64, copy=False)
