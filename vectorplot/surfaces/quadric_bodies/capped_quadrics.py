"""Frusta, cylinders and parts of balls between flat ends, whatever they are placed by: convex bodies of quadrics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.surfaces.families.capped import Capped, Frustum
from vectorplot.surfaces.families.cylinder import Cone, Cylinder
from vectorplot.surfaces.families.ellipsoid import Ellipsoid, Sphere
from vectorplot.surfaces.placed_surface import PlacedSurface


@dataclass(frozen=True, eq=False)
class CappedQuadric:
    """The points centre + s @ frame for the points s of a unit body: centre (3,), frame (3,3).

    The unit body lies between the planes z = low and z = high. Of a frustum the radius there is radii[0] and radii[1],
    the larger one is 1, and low and high are 0 and 1; if it is round the body is that part of the unit ball.
    """

    centre: Floats
    frame: Floats
    low: float
    high: float
    radii: tuple[float, float]
    is_round: bool


def capped_quadric_of(shape: object) -> CappedQuadric | None:
    """The frustum or the part of a ball that a shape is the whole surface of, u its angle; else None."""
    if isinstance(shape, PlacedSurface) and (inner := capped_quadric_of(shape.surface)):
        matrix = np.asarray(shape.matrix)
        centre, frame = (
            matmul(inner.centre, matrix) + np.asarray(shape.shift),
            matmul(inner.frame, matrix),
        )
        return CappedQuadric(centre, frame, inner.low, inner.high, inner.radii, inner.is_round)
    if not isinstance(shape, Capped):
        return None
    surface = shape.surface
    bottom, top = shape.ends
    if isinstance(surface, Cylinder | Cone | Frustum):
        largest = max(bottom.radius, top.radius)
        a, b = (largest * axis for axis in shape.semi_axes)
        centre = surface.place + np.array([0.0, 0.0, bottom.height])
        frame = np.diag([a, b, top.height - bottom.height])
        return CappedQuadric(centre, frame, 0.0, 1.0, (bottom.radius / largest, top.radius / largest), False)
    if isinstance(surface, Sphere | Ellipsoid):
        axes = surface.radius * np.ones(3) if isinstance(surface, Sphere) else np.asarray(surface.semi_axes)
        low, high = np.sin(shape.mantle).tolist()
        return CappedQuadric(surface.place, np.diag(axes), low, high, (bottom.radius, top.radius), True)
    return None


def bounds_of_capped_quadrics(bodies: Sequence[CappedQuadric]) -> Floats:
    """(n,2,3) smallest and largest coordinates of bodies."""
    centre = np.array([body.centre for body in bodies]).reshape(-1, 3)
    frame = np.array([body.frame for body in bodies]).reshape(-1, 3, 3)
    low, high = (np.array([getattr(body, name) for body in bodies])[:, None] for name in ("low", "high"))
    radii = np.array([body.radii for body in bodies]).reshape(-1, 2, 1)
    is_round = np.array([body.is_round for body in bodies], dtype=np.bool_)[:, None]
    across, along = np.hypot(frame[:, 0], frame[:, 1]), frame[:, 2]
    size = np.hypot(across, along)
    ends = []
    for sign in (-1.0, 1.0):
        # Farthest along an axis reaches an end, or the ball where its pole of that direction is between the ends.
        at_ends = np.maximum(across * radii[:, 0] + sign * low * along, across * radii[:, 1] + sign * high * along)
        with np.errstate(invalid="ignore", divide="ignore"):
            height = sign * along / size
        ends.append(np.where(is_round & (low <= height) & (height <= high), size, at_ends))
    return np.stack([centre - ends[0], centre + ends[1]], axis=1)
