"""Cylinders and cones about the z-axis, circular or elliptic; without end faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number, parameter_range, positive, vector
from vectorplot.errors import InputError
from vectorplot.surfaces.families.elliptic_sections import EllipticSections, Profile
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True, eq=False)
class Cylinder(EllipticSections):
    """The cylinder about an upright axis, from height bottom to top, without end faces.

    Parameters
    ----------
    radius : float
        The semi-axis along x, positive, in world units.
    bottom, top : float
        Heights above the centre.
    centre : (3,) array_like of float
        On the axis.
    depth : float, optional
        The semi-axis along y, where it is not the radius.

    Raises
    ------
    InputError
        For radii that are not positive, a top that is not above the bottom, a centre that is not three finite numbers.

    Notes
    -----
    u is the angle, v the height. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Cylinder
    >>> can = Cylinder(radius=2.0, top=3.0)
    >>> can.points(np.array(0.0), np.array(3.0)).tolist(), can.domain.closed_u
    ([2.0, 0.0, 3.0], True)
    """

    radius: float = 1.0
    bottom: float = 0.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    depth: float | None = None

    def __post_init__(self) -> None:
        positive("cylinder: radius", self.radius)
        if self.depth is not None:
            positive("cylinder: depth", self.depth)
        parameter_range("cylinder", self.bottom, self.top)
        object.__setattr__(self, "centre", vector("cylinder: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("radius", "depth", "centre")

    @property
    def domain(self) -> Domain:
        """Angle and height."""
        return Domain(0.0, 2.0 * np.pi, self.bottom, self.top, closed_u=True)

    def _ellipse(self) -> tuple[float, float]:
        return self.radius, self.radius if self.depth is None else self.depth

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (zero + 1.0, v), (zero, zero + 1.0), (zero, zero)


@dataclass(frozen=True, eq=False)
class Cone(EllipticSections):
    """The cone with its apex at the centre: at height v the radius is slope * abs(v).

    Parameters
    ----------
    slope : float
        Radius over height, positive.
    bottom, top : float
        Heights above the apex; bottom < 0 < top gives the double cone.
    centre : (3,) array_like of float
        The apex, in world units.
    depth_slope : float, optional
        The slope along y, where it is another.

    Raises
    ------
    InputError
        For slopes that are not positive, a top that is not above the bottom, a centre that is not three finite numbers.

    Notes
    -----
    u is the angle, v the height, from bottom to top. The apex is a pole, each ruling with a normal of its own. Normals
    of the upper half point outwards, those of the lower half inwards.

    Examples
    --------
    >>> from vectorplot.surfaces import Cone
    >>> hat = Cone.standing(radius=1.0, height=4.0)
    >>> hat.slope, hat.bottom, hat.centre.tolist()
    (0.25, -4.0, [0.0, 0.0, 4.0])
    """

    slope: float = 1.0
    bottom: float = 0.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    depth_slope: float | None = None

    def __post_init__(self) -> None:
        positive("cone: slope", self.slope)
        if self.depth_slope is not None:
            positive("cone: depth_slope", self.depth_slope)
        parameter_range("cone", self.bottom, self.top)
        object.__setattr__(self, "centre", vector("cone: centre", self.centre))

    @classmethod
    def standing(cls, radius: float, height: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Cone:
        """The cone whose base circle has this radius and centre, its apex at this height above (or below) it."""
        tall = number("cone: height", height)
        if tall == 0.0:
            raise InputError("cone: a height of 0")
        apex = vector("cone: centre", centre) + np.array([0.0, 0.0, tall])
        return cls(positive("cone: radius", radius) / abs(tall), min(-tall, 0.0), max(-tall, 0.0), apex)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("slope", "depth_slope", "centre")

    @property
    def domain(self) -> Domain:
        """Angle and height above the apex."""
        return Domain(0.0, 2.0 * np.pi, self.bottom, self.top, closed_u=True)

    @property
    def embedded(self) -> bool:
        """Whether it is no double cone, which meets itself in its apex."""
        return not self.bottom < 0.0 < self.top

    def _ellipse(self) -> tuple[float, float]:
        return self.slope, self.slope if self.depth_slope is None else self.depth_slope

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (v, v), (zero + 1.0, zero + 1.0), (zero, zero)
