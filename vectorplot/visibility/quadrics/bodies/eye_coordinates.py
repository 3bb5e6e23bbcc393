"""Coordinates in which the eye is the origin, or a point at infinity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.cameras.unit_projection import Projection


@dataclass(frozen=True, eq=False)
class EyeCoordinates:
    """x to the right, y upwards, z the depth; central: the eye is the origin, else it is infinitely far, against z.

    What is seen of a homogeneous point (x,y,z,w) is (x,y,z), or of a parallel projection (x,y,w): homogeneous
    coordinates of its image. Its own inverse but for the shift. origin (3,): of the view; near: the least depth that is
    seen.
    """

    central: bool
    origin: Floats
    near: float

    def points(self, points: Floats) -> Floats:
        """(...,3) points of the view in these coordinates."""
        return self.vectors(points - self.origin)

    def vectors(self, vectors: Floats) -> Floats:
        """(...,3) vectors of the view in these coordinates, or back."""
        return np.asarray(vectors * _MIRROR)

    def points_of_view(self, points: Floats) -> Floats:
        """(...,3) points in these coordinates as points of the view."""
        return self.vectors(points) + self.origin

    @property
    def seen(self) -> list[int]:
        """Which homogeneous coordinates of a point are those of its image."""
        return [0, 1, 2] if self.central else [0, 1, 3]


def eye_coordinates(projection: Projection) -> EyeCoordinates:
    """Those of a projection."""
    eye = projection.eye
    return EyeCoordinates(eye is not None, np.zeros(3) if eye is None else eye, projection.near)


_MIRROR = np.array([1.0, 1.0, -1.0])
