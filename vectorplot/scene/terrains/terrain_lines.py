"""Lines that a terrain asks for: water, watersheds, valleys and roads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number, positive
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, matmul

Pair = tuple[float, float]

MOST_SOURCES = 10_000
"""Places that water is asked to run from, at most."""


@dataclass(frozen=True)
class WaterCourses:
    """The ways of water from given places, down where it is steepest.

    Parameters
    ----------
    places : tuple of (float, float)
        x and y of the sources, in world coordinates.

    Raises
    ------
    InputError
        For places that are not pairs of finite numbers, more than 10000 of them.

    Notes
    -----
    See `water_courses` of the room features.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(terrain=(scene.WaterCourses(((3.0, 4.0),)),)))
    True
    """

    places: tuple[Pair, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", _pairs("water", self.places))

    def transformed(self, matrix: Floats) -> WaterCourses:
        """The same places under a 4x4 matrix acting on columns that keeps verticals. Errors: InputError for others."""
        return replace(self, places=_moved("water", self.places, matrix))


@dataclass(frozen=True)
class Watersheds:
    """The lines that part waters, from saddles up to summits; or valley lines, from saddles down to pits.

    Parameters
    ----------
    valleys : bool
        Whether they are valley lines.

    Notes
    -----
    See `watersheds` and `valley_lines` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Watersheds().valleys
    False
    """

    valleys: bool = False

    def transformed(self, matrix: Floats) -> Watersheds:
        """The same."""
        return self


@dataclass(frozen=True)
class Roads:
    """The roads of constant slope between two places: to the left of the steepest way up, and to its right.

    Parameters
    ----------
    start, end : (float, float)
        x and y, in world coordinates.

    Raises
    ------
    InputError
        For places that are not two finite numbers.

    Notes
    -----
    See `roads` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Roads((0, 0), (3, 4)).end
    (3.0, 4.0)
    """

    start: Pair
    end: Pair

    def __post_init__(self) -> None:
        start, end = _pairs("road", (self.start, self.end))
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)

    def transformed(self, matrix: Floats) -> Roads:
        """The same places under a 4x4 matrix acting on columns that keeps verticals. Errors: InputError for others."""
        return Roads(*_moved("road", (self.start, self.end), matrix))


@dataclass(frozen=True)
class Serpentine:
    """A road with hairpin bends between two places, of at most a given slope.

    Parameters
    ----------
    start, end : (float, float)
        x and y, in world coordinates.
    slope_deg : float
        The largest slope of its legs, in degrees.
    radius, width : float, optional
        Of the bends, and how far from the straight line of the plan they begin at most, in world units; a thirtieth of
        the distance of the ends, and all of it, where None.

    Raises
    ------
    InputError
        For places that are not two finite numbers, a slope that is not between 0 and 90 degrees, a radius or a width
        that is not positive.

    Notes
    -----
    See `serpentine` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Serpentine((0, 0), (3, 4), slope_deg=7).end
    (3.0, 4.0)
    """

    start: Pair
    end: Pair
    slope_deg: float
    radius: float | None = None
    width: float | None = None

    def __post_init__(self) -> None:
        start, end = _pairs("serpentine", (self.start, self.end))
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)
        if not 0.0 < number("serpentine: slope", self.slope_deg) < 90.0:
            raise InputError(f"serpentine: slope {self.slope_deg:g}, expected an angle between 0 and 90 degrees")
        for name in ("radius", "width"):
            if getattr(self, name) is not None:
                positive(f"serpentine: {name}", getattr(self, name))

    def transformed(self, matrix: Floats) -> Serpentine:
        """The same places under a 4x4 matrix acting on columns that keeps verticals, with lengths as areas of the plan
        grow. Errors: InputError for others."""
        scale = float(np.sqrt(abs(determinant(matrix[:2, :2]))))
        radius, width = (None if size is None else scale * size for size in (self.radius, self.width))
        start, end = _moved("serpentine", (self.start, self.end), matrix)
        return Serpentine(start, end, self.slope_deg, radius, width)


TerrainLines = WaterCourses | Watersheds | Roads | Serpentine


def _pairs(name: str, pairs: tuple[Pair, ...]) -> tuple[Pair, ...]:
    if len(pairs) > MOST_SOURCES:
        raise InputError(f"{name}: {len(pairs)} places, expected at most {MOST_SOURCES}")
    try:
        values = np.array(pairs, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.full((1, 0), np.nan)
    if values.ndim != 2 or values.shape[1] != 2 or not np.isfinite(values).all():
        raise InputError(f"{name}: expected two finite numbers for each place, x and y")
    return tuple((x, y) for x, y in values.tolist())


def _moved(name: str, pairs: tuple[Pair, ...], matrix: Floats) -> tuple[Pair, ...]:
    if matrix[:2, 2].any() or matrix[2, :2].any():
        raise InputError(f"{name}: a terrain that is tilted has no places x and y any more")
    return tuple((x, y) for x, y in (matmul(np.array(pairs), matrix[:2, :2].T) + matrix[:2, 3]).tolist())
