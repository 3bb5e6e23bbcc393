"""The painter's order of polyhedral surfaces of revolution by rings, without a single comparison."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.visibility.painter.cuts.slices import eye_coordinate, slice_order


def sliced_meridian(meridian: ArrayLike) -> Floats:
    """The meridian with more points where it passes the height of one of its points.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius, not negative, and height.

    Returns
    -------
    (n, 2) array of float
        Every side lies between two neighbouring heights.

    Raises
    ------
    InputError
        For fewer than two points, negative radii, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 5.2, figure 3.

    Examples
    --------
    >>> from vectorplot.textbook import sliced_meridian
    >>> sliced_meridian([(0, 2), (2, 0), (1, 1)]).tolist()
    [[0.0, 2.0], [1.0, 1.0], [2.0, 0.0], [1.0, 1.0]]
    """
    line = _checked(meridian)
    level = np.unique(line[:, 1])
    pieces = []
    for start, end in pairwise(line):
        low, high = sorted((start[1], end[1]))
        between = level[(level > low) & (level < high)]
        between = between if end[1] > start[1] else between[::-1]
        share = (between - start[1]) / (end[1] - start[1] or 1.0)
        pieces.append(
            np.concatenate([start[None], np.stack([start[0] + share * (end[0] - start[0]), between], axis=1)])
        )
    return np.concatenate([*pieces, line[-1:]])


def ring_order(meridian: ArrayLike, order: int, eye: ArrayLike) -> Ints:
    """The faces of a surface of revolution about the z-axis, back to front.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius and height, sliced as by sliced_meridian and not crossing itself.
    order : int
        How many faces go round.
    eye : (3,) or (4,) array_like of float
        In coordinates in which z is the axis, or (x, y, z, 0) for a direction towards it.

    Returns
    -------
    ((k-1) order,) array of int
        Face i order + j is swept by the side from point i to i+1 between the azimuths j and j+1 times 2 pi / order.

    Raises
    ------
    InputError
        Where a side of the meridian passes the height of a point, and for what sliced_meridian refuses.

    Notes
    -----
    Slices are drawn in the order of slice_order; within a slice first what the rays leave its rings through, outer
    rings before inner ones, then what they enter them through, inner rings before outer ones. Right wherever the eye
    is: above, below, inside.

    Source: Glaeser, section 5.2, figure 3; erratum G5-09.

    Examples
    --------
    >>> from vectorplot.textbook import ring_order
    >>> ring_order([(1, 0), (1, 1)], order=4, eye=(9, 1, 0.5)).tolist()
    [1, 2, 0, 3]
    """
    line = _checked(meridian)
    place = np.asarray(eye, dtype=np.float64)
    radius, height = line[:-1], line[1:]
    low, high = np.minimum(radius[:, 1], height[:, 1]), np.maximum(radius[:, 1], height[:, 1])
    level = np.unique(line[:, 1])
    bottom, top = np.searchsorted(level, low), np.searchsorted(level, high)
    if (top - bottom > 1).any():
        raise InputError("a side of the meridian passes the height of another point: cut it there first")
    leading = _places(level, bottom, top, eye_coordinate(place, 2))
    entered = _entered(line, order, place)
    middle = (radius[:, 0] + height[:, 0]) / 2.0
    rank = np.argsort(np.argsort(middle, kind="stable"), kind="stable")[:, None]
    within = np.where(entered, rank, -1 - rank)
    return np.lexsort((within.ravel(), np.repeat(leading, order)))


def _checked(meridian: ArrayLike) -> Floats:
    line = np.asarray(meridian, dtype=np.float64)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all() or (line[:, 0] < 0.0).any():
        raise InputError("a meridian has two points at least, each a radius, not negative, and a height")
    return line


def _places(level: Floats, bottom: Ints, top: Ints, eye: float) -> Ints:
    """(k,) the place in the order of drawing of sides between levels and, where bottom and top are the same, in one."""
    between = np.zeros(len(level), dtype=np.intp)
    if len(level) > 1:
        between[slice_order(level, eye)] = 2 * np.arange(len(level) - 1) + 1
    # A plane below the eye is drawn just after the slice below it, one above the eye after the slice above it.
    within = np.where(level < eye, np.append(0, between[: len(level) - 1] + 1), between + 1)
    within[-1:] = np.where(level[-1] < eye, within[-1], 0)
    return np.where(top > bottom, between[bottom], within[bottom])


def _entered(line: Floats, order: int, eye: Floats) -> Bools:
    """(k-1, order) whether rays to the eye come out of faces on the side away from the axis."""
    azimuth = 2.0 * np.pi * (np.arange(order) + 0.5) / order
    (radius, height), (rise_out, rise_up) = line[:-1].T, np.diff(line, axis=0).T
    # Upwards along the meridian the outside is on the right.
    sign = np.where(rise_up < 0.0, -1.0, 1.0)
    flatter = np.cos(np.pi / order)
    out = np.cos(azimuth) * eye[0] + np.sin(azimuth) * eye[1]
    finite = 1.0 if len(eye) == 3 else 0.0
    above = np.outer(sign * rise_up, out) - (sign * rise_out * flatter * eye[2])[:, None]
    return np.asarray(above - finite * (sign * flatter * (rise_up * radius - rise_out * height))[:, None] > 0.0)
