"""How a shape bends at points of it: its curvatures, and how these change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross, dot


@dataclass(frozen=True, eq=False)
class Bending:
    """Points of a shape, each with the shape's third-order approximation there.

    points (n,3); normals (n,3), of length one; along (n,3): a unit tangent; second (n,3): the second fundamental form
    p, m, q by along and the tangent a quarter turn to its left, positive where the shape bends towards its normal;
    third (n,4): its derivatives d, e, f, g, those of p by the first tangent, of p by the second, of q by the first and
    of q by the second. What is not known is NaN.
    """

    points: Floats
    normals: Floats
    along: Floats
    second: Floats
    third: Floats

    def __len__(self) -> int:
        return len(self.points)

    @property
    def aside(self) -> Floats:
        """(n,3) unit tangents a quarter turn to the left of along."""
        return cross(self.normals, self.along)

    def some(self, which: Ints) -> Bending:
        """What is known of some of the points."""
        return records.some(self, which)

    def turned_over(self, side: Floats) -> Bending:
        """The same where sides (n,) are 1, and seen from the other side, but in the same tangents, where they are -1:
        only for what asks for no normals."""
        return Bending(self.points, self.normals, self.along, side[:, None] * self.second, side[:, None] * self.third)

    def in_plane(self, vectors: Floats) -> Floats:
        """(n,2) the tangential parts of vectors (n,3)."""
        return np.stack([dot(vectors, self.along), dot(vectors, self.aside)], axis=1)

    def in_space(self, tangents: Floats) -> Floats:
        """(n,3) vectors from their tangential parts (n,2)."""
        return np.asarray(tangents[:, :1] * self.along + tangents[:, 1:] * self.aside)

    def bent(self, tangents: Floats) -> Floats:
        """(n,2) the shape operator applied to tangents (n,2)."""
        return applied(self.second, tangents)

    def changing(self, tangents: Floats) -> Floats:
        """(n,3) the derivatives of the second fundamental form in the directions of tangents (n,2)."""
        x, y = tangents.T
        d, e, f, g = self.third.T
        return np.stack([x * d + y * e, x * e + y * f, x * f + y * g], axis=1)

    def cubed(self, tangents: Floats) -> Floats:
        """(n,) how fast the normal curvature changes along tangents (n,2), in their direction."""
        return dot(applied(self.changing(tangents), tangents), tangents)


def applied(form: Floats, tangents: Floats) -> Floats:
    """(n,2) symmetric matrices (n,3), by p, m and q, applied to vectors (n,2)."""
    x, y = tangents.T
    p, m, q = form.T
    return np.stack([p * x + m * y, m * x + q * y], axis=1)


def principal_axes(form: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """The larger and the smaller eigenvalues (n,) of symmetric matrices (n,3), by p, m and q, and their unit
    eigenvectors (n,2), of either sense."""
    p, m, q = form.T
    angle = 0.5 * arctan2(2.0 * m, p - q)
    one = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    other = np.stack([-one[:, 1], one[:, 0]], axis=1)
    middle, apart = 0.5 * (p + q), np.hypot(0.5 * (p - q), m)
    return middle + apart, middle - apart, one, other


@dataclass(frozen=True, eq=False)
class Sight:
    """From where one looks: at an eye (3,), or from infinitely far away in a direction (3,) of length one."""

    eye: Floats | None
    direction: Floats

    def ways(self, points: Floats) -> tuple[Floats, Floats]:
        """Unit vectors (n,3) to the eye from points (n,3), and one over the distances (n,)."""
        if self.eye is None:
            return np.broadcast_to(self.direction, points.shape), np.zeros(len(points))
        way = self.eye - points
        far = np.sqrt(dot(way, way))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(way / far[:, None]), np.asarray(1.0 / far)
