"""Integral curves that an item asks for: of fields of directions, and geodesics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError

if TYPE_CHECKING:
    # What runs along fields is loaded when they are traced.
    from vectorplot.features.integral.tangent_fields import TangentField

MOST_STARTS = 10_000
"""The largest number of points that curves of one field are asked for through."""


@dataclass(frozen=True)
class FieldLines:
    """Lines of a surface that follow a field of directions: through given points, or evenly all over it.

    Parameters
    ----------
    field : TangentField
        Such as PrincipalDirections() of the room features.
    apart : float, optional
        How far neighbours are from each other, in world units; a twenty-fourth of the extent of the surface where None.
    through : tuple of (float, float)
        Parameters u, v of points; where there are some, the lines through these are drawn and no others.

    Raises
    ------
    InputError
        For a distance that is not positive, points that are not pairs of finite numbers, more than 10000 of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import features, scene
    >>> lines = scene.FieldLines(features.SteepestSlope(), apart=0.25)
    >>> bool(vp.SurfaceLines(integral=(lines,)))
    True
    """

    field: TangentField
    apart: float | None = None
    through: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        if self.apart is not None:
            positive("field lines: distance", self.apart)
        object.__setattr__(self, "through", _rows("field lines", self.through, 2))

    def scaled(self, factor: float) -> FieldLines:
        """The lines of the surface where it is so many times larger."""
        return self if self.apart is None else replace(self, apart=factor * self.apart)


@dataclass(frozen=True)
class GeodesicLines:
    """Geodesics of a surface, from given points in given directions.

    Parameters
    ----------
    starts : tuple of (float, float, float)
        Parameters u, v, and the angle in radians from the direction in which u grows, counter-clockwise about the
        normals.
    length : float, optional
        How long they are at most, in world units; ten times the extent of the surface where None.

    Raises
    ------
    InputError
        For a length that is not positive, starts that are not three finite numbers each, more than 10000 of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(integral=(scene.GeodesicLines(((0.0, 0.0, 1.0),), length=20.0),)))
    True
    """

    starts: tuple[tuple[float, float, float], ...]
    length: float | None = None

    def __post_init__(self) -> None:
        if self.length is not None:
            positive("geodesics: length", self.length)
        object.__setattr__(self, "starts", _rows("geodesics", self.starts, 3))

    def scaled(self, factor: float) -> GeodesicLines:
        """The lines of the surface where it is so many times larger."""
        return self if self.length is None else replace(self, length=factor * self.length)


IntegralLines = FieldLines | GeodesicLines


def _rows(name: str, rows: tuple[tuple[float, ...], ...], width: int) -> tuple[tuple[float, ...], ...]:
    """The rows as numbers."""
    if len(rows) > MOST_STARTS:
        raise InputError(f"{name}: {len(rows)} points, expected at most {MOST_STARTS}")
    try:
        values = np.array(rows, dtype=np.float64).reshape(len(rows), -1 if rows else width)
    except (TypeError, ValueError):
        values = np.full((1, 0), np.nan)
    if values.shape[1] != width or not np.isfinite(values).all():
        raise InputError(f"{name}: expected {width} finite numbers for each point")
    return tuple(tuple(row) for row in values.tolist())
