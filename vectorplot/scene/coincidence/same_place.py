"""Surfaces that are made of the same points, however they are turned in themselves, whatever their parameters are."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR, ONE_SURFACE

SAMPLES = (11, 13)
"""Columns and rows of the points of one surface that have to lie on the other one: odd numbers, so that few of them are
where parameters are halved."""

STARTS = 48
"""Columns, and rows, of the places from which the way to a point begins."""

STEPS = 12
"""Steps of Gauss and Newton to a point."""


def are_in_one_place(one: Surface, other: Surface) -> bool:
    """Whether samples of each of two surfaces lie on the other one, and their borders there, too.

    Error: surfaces that differ by less than ONE_SURFACE of their extent are taken for one; so are those that differ
    between the samples only. Degenerate: those with holes are not, nor are those of which a point is not found.
    Source: Gauss and Newton's method for the foot of a perpendicular.
    """
    return _lies_on(one, other) and _lies_on(other, one)


def _lies_on(one: Surface, other: Surface) -> bool:
    """Whether samples of a surface, its borders included, lie on another one."""
    from scipy.spatial import cKDTree

    with np.errstate(all="ignore"):
        points = one.points(*(x.ravel() for x in np.meshgrid(*one.domain.grid(*SAMPLES)))).reshape(-1, 3)
        places = np.stack([x.ravel() for x in np.meshgrid(*other.domain.grid(STARTS, STARTS))], axis=1)
        starts = other.points(*places.T).reshape(-1, 3)
    if not (np.isfinite(points).all() and np.isfinite(starts).all()):
        return False
    extent = float(np.ptp(starts, axis=0).max())
    distance, nearest = cKDTree(starts).query(points)
    if distance.max() > extent:
        return False
    return bool(_distances(other, places[nearest], points).max() <= ONE_SURFACE * extent)


def _distances(surface: Surface, places: Floats, points: Floats) -> Floats:
    """(n,) distances of points (n,3) from a surface, found from places (n,2) near them; infinite where they are not."""
    domain = surface.domain
    low = np.array((domain.u_start, domain.v_start))
    high = np.array((domain.u_end, domain.v_end))
    closed = np.array((domain.closed_u, domain.closed_v))
    best = np.full(len(points), np.inf)
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            off = surface.points(*places.T) - points
            best = np.fmin(best, np.linalg.norm(off, axis=1))
            along = surface.partials(*places.T)
            a, b, c = (
                (x * y).sum(axis=1) for x, y in ((along[0], along[0]), (along[0], along[1]), (along[1], along[1]))
            )
            d, e = ((x * off).sum(axis=1) for x in along)
            whole = np.maximum(a * c - b * b, LEAST_DIVISOR)
            places = places - np.nan_to_num(np.stack((c * d - b * e, a * e - b * d), axis=1) / whole[:, None])
            places = np.where(closed, low + (places - low) % (high - low), np.clip(places, low, high))
    return best
