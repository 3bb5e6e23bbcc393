"""Whole spheres and ellipsoids, whatever they are placed by: images of the unit sphere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.surfaces.families.ellipsoid import Ellipsoid, Sphere
from vectorplot.surfaces.placed_surface import PlacedSurface


@dataclass(frozen=True, eq=False)
class Ball:
    """The points centre + s @ frame for the points s of the unit sphere: centre (3,), frame (3,3)."""

    centre: Floats
    frame: Floats


def ball_of(shape: object) -> Ball | None:
    """The ball that a shape is the whole surface of, u the longitude, v the latitude of the unit sphere; else None."""
    if isinstance(shape, Sphere):
        return Ball(np.asarray(shape.centre), shape.radius * _AXES)
    if isinstance(shape, Ellipsoid):
        return Ball(np.asarray(shape.centre), np.asarray(shape.semi_axes)[:, None] * _AXES)
    if isinstance(shape, PlacedSurface) and (inner := ball_of(shape.surface)):
        matrix = np.asarray(shape.matrix)
        return Ball(matmul(inner.centre, matrix) + np.asarray(shape.shift), matmul(inner.frame, matrix))
    return None


_AXES = np.eye(3)


def bounds_of_balls(balls: Sequence[Ball]) -> Floats:
    """(n,2,3) smallest and largest coordinates of balls."""
    centre = np.array([ball.centre for ball in balls]).reshape(-1, 1, 3)
    frame = np.array([ball.frame for ball in balls]).reshape(-1, 3, 3)
    with np.errstate(over="ignore"):
        reach = np.sqrt((frame * frame).sum(axis=1))[:, None]
    return np.concatenate([centre - reach, centre + reach], axis=1)
