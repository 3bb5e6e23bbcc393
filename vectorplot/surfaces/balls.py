"""Whole spheres and ellipsoids, whatever they are placed by: images of the unit sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.families.ellipsoid import Ellipsoid, Sphere
from vectorplot.surfaces.placed import PlacedSurface


@dataclass(frozen=True, eq=False)
class Ball:
    """The points centre + s @ frame for the points s of the unit sphere: centre (3,), frame (3,3)."""

    centre: Floats
    frame: Floats

    @property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates."""
        reach = np.sqrt((self.frame * self.frame).sum(axis=0))
        return np.stack([self.centre - reach, self.centre + reach])


def ball_of(shape: object) -> Ball | None:
    """The ball that a shape is the whole surface of, u the longitude, v the latitude of the unit sphere; else None."""
    if isinstance(shape, Sphere):
        return Ball(np.asarray(shape.centre), shape.radius * _AXES)
    if isinstance(shape, Ellipsoid):
        return Ball(np.asarray(shape.centre), np.asarray(shape.semi_axes)[:, None] * _AXES)
    if isinstance(shape, PlacedSurface) and (inner := ball_of(shape.surface)):
        matrix = np.asarray(shape.matrix)
        return Ball(inner.centre @ matrix + np.asarray(shape.shift), inner.frame @ matrix)
    return None


_AXES = np.eye(3)
