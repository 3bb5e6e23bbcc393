"""Approximations and studies of them: knobs, ways, errors, and the distances that errors are measured with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import projection_of
from vectorplot.scene.page import Page
from vectorplot.scene.placement import box_corners, fitted_picture
from vectorplot.testing.curves import Curves, Segments, Tree

# What an approximation is: a knob, ways that depend on it, and an error that can be measured.


def decades(first: float, last: float, count: int) -> tuple[float, ...]:
    """Powers of ten, the first and the last exponent included, in even steps of these: values of a knob."""
    step = (last - first) / (count - 1)
    return tuple(float(f"{10.0 ** (first + step * number):.3g}") for number in range(count))


@dataclass(frozen=True)
class Way:
    """A way to an approximate result, which depends on the knob.

    Parameters
    ----------
    name : str
        What the curve of its errors is called.
    result : callable
        Takes a value of the knob; what it does is timed.
    slope : float, optional
        By theory errors go like the value of the knob to this power; None where theory knows no such power.

    Examples
    --------
    >>> from vectorplot.accuracy import Way
    >>> polygon = Way("polygon", lambda corners: corners, slope=-2.0)
    >>> polygon.result(6.0)
    6.0
    """

    name: str
    result: Callable[[float], Any]
    slope: float | None = None


@dataclass(frozen=True)
class Study:
    """All that is needed to measure an approximation: its ways, and the truth.

    Parameters
    ----------
    ways : tuple of Way
        Compared with each other over the same knob.
    error : callable
        Takes a result, measures it against the truth, and returns a number that is not negative.
    count : callable
        Takes a result and returns how many things it consists of.
    exact : callable, optional
        Makes the exact result, or the finest one that there is; it is timed and measured too.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.accuracy import Study, Way
    >>> polygon = Way("polygon", lambda corners: corners, slope=-2.0)
    >>> deviation = Study((polygon,), error=lambda corners: 1.0 - np.cos(np.pi / corners), count=int)
    >>> round(float(deviation.error(deviation.ways[0].result(6.0))), 3)
    0.134
    """

    ways: tuple[Way, ...]
    error: Callable[[Any], float]
    count: Callable[[Any], int]
    exact: Callable[[], Any] | None = None


@dataclass(frozen=True)
class Approximation:
    """An approximation of the package, and how its error is measured.

    Parameters
    ----------
    name : str
        What the command calls it: a word, with hyphens.
    title : str
        What it is, in a few words.
    about : str
        A sentence or two: what is approximated on what, and what the error is.
    knob : str
        What can be chosen, with its unit.
    values : tuple of float
        Positive values of the knob, from the coarsest result to the finest. If all of them are whole numbers, only such
        are meant.
    limits : (float, float)
        The smallest and the largest value that makes sense and stays within a few seconds and a gigabyte.
    unit : str
        What errors are measured in.
    counts : str
        What a result consists of.
    study : callable
        Makes the Study; scenes and truth are made then, and not before.

    Notes
    -----
    Nothing here is computed when it is imported.

    Examples
    --------
    >>> from vectorplot.accuracy.verb import APPROXIMATIONS
    >>> fit = next(one for one in APPROXIMATIONS if one.name == "bezier-fit")
    >>> fit.knob, fit.unit, fit.counts
    ('tolerance in mm', 'mm', 'pieces')
    """

    name: str
    title: str
    about: str
    knob: str
    values: tuple[float, ...]
    limits: tuple[float, float]
    unit: str
    counts: str
    study: Callable[[], Study]


def check_values(one: Approximation, values: Sequence[float]) -> None:
    """Nothing, where these are values of the knob of an approximation.

    Errors: InputError for none, for one outside of the limits, and for one that is not whole where only such are meant.
    """
    least, most = one.limits
    whole = all(float(value).is_integer() for value in one.values)
    said = f"{one.name}: expected {'whole numbers' if whole else 'numbers'} from {least:g} to {most:g}"
    if not len(values):
        raise InputError(f"{said} for the {one.knob}, one or more")
    for value in values:
        if not least <= value <= most or (whole and not float(value).is_integer()):
            raise InputError(f"{said} for the {one.knob}, not {value:g}")


# What errors are measured with: places on the page, and distances of points from curves.


def page_from_world(camera: Camera, bounds: Floats) -> Floats:
    """(4,4) the matrix from the world to mm on the usual sheet, which the box bounds (2,3) fills."""
    projection = projection_of(camera, bounds)
    image = projection.image_of(projection.points_of(box_corners(bounds)))
    return fitted_picture(projection, Page(), image).page_from_world


def on_page(matrix: Floats, points: Floats) -> Floats:
    """(...,2) points (...,3) of the world in mm."""
    place = matmul(np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1), matrix.T)
    return np.asarray(place[..., :2] / place[..., 3:])


def farthest(points: Floats, curves: Curves) -> float:
    """How far that of the points (n,d) is from curves that is farthest from them."""
    return float(Tree(Segments.of(curves, False).ends).nearest(points, 0.0)[0].max(initial=0.0))
