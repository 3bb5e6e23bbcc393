"""The directions in which a surface bends most, least, and not at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.features.integral.sites import Sites, TangentPlanes, on_surface, unit
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances.of_values import UMBILIC


@dataclass(frozen=True)
class PrincipalDirections:
    """The directions of the principal curvatures: those of lines of curvature.

    Parameters
    ----------
    family : 1 or 2
        The lines along which the normal curvature is larger (1), or smaller (2); it is positive where the surface
        bends towards its normal.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. A curve through an umbilic, where all directions are principal ones, goes straight on; beyond it, it
    may be of the other family. Degenerate: no curve begins at an umbilic, and none on a sphere or in a plane.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> np.abs(features.PrincipalDirections(1).tangents(sites)[0]).round(9).tolist()  # straight: 0 is more than -1
    [[0.0, 0.0, 1.0]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"lines of curvature: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(2,k,3) unit tangent vectors, those of the family first."""
        (most, least), _ = principal(on_surface(sites, "lines of curvature"))
        return np.stack([most, least] if self.family == 1 else [least, most])


@dataclass(frozen=True)
class AsymptoticDirections:
    """The directions in which the normal curvature is zero: those of asymptotic lines.

    Parameters
    ----------
    family : 1 or 2
        The lines to the left (1), or right (2), of those along which the normal curvature is largest, by less than a
        right angle.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. Degenerate: no direction where the Gaussian curvature is positive: the solution is not real there; and
    where the surface is flat.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> saddle = surfaces.graph(lambda x, y: x * y, surfaces.Domain(-1, 1, -1, 1))
    >>> sites = features.Sites(saddle, np.array([0.0]), np.array([0.0]))
    >>> np.abs(features.AsymptoticDirections(1).tangents(sites)).round(6).tolist()
    [[[0.0, 1.0, 0.0]]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"asymptotic lines: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        (most, least), (largest, smallest) = principal(on_surface(sites, "asymptotic lines"))
        with np.errstate(all="ignore"):
            ahead, aside = np.sqrt(-smallest), np.sqrt(largest)
        side = 1.0 if self.family == 1 else -1.0
        return unit(ahead[:, None] * most + side * aside[:, None] * least)[None]


def principal(sites: Sites) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
    """The unit vectors (k,3) along which the normal curvature is largest, and those a quarter turn to the left of them,
    along which it is smallest; and both curvatures (k,). No directions at umbilics."""
    along_u, _, normals = sites.planes
    (e, f, g), (p, m, q) = sites.first_form, sites.second_form
    with np.errstate(all="ignore"):
        # Of the frame of x_u and what is at right angles to it.
        area = e * g - f * f
        straight = p / e
        mixed = (m - f * straight) / np.sqrt(area)
        across = (e * q - 2.0 * f * m + f * f * straight) / area
        half, mean = 0.5 * (straight - across), 0.5 * (straight + across)
        apart = np.hypot(half, mixed)
        angle = 0.5 * np.arctan2(mixed, half)
        known = apart > UMBILIC * np.maximum(np.abs(straight), np.abs(across))
        first = unit(along_u)
        most = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * cross(normals, first)
    most = np.where(known[:, None], most, np.nan)
    return (most, cross(normals, most)), (mean + apart, mean - apart)
