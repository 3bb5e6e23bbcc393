"""What surfaces hide, in closed form: the roots of polynomials along sight rays; no net, no engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    Paraboloid,
    Sphere,
)
from vectorplot.surfaces.tori import Torus


class Hits(NamedTuple):
    """Distances along rays (n,k), NaN where there is no hit; margin (n,k): how far roots are from being other in number
    or from a border; own (n,): the point lies on the surface."""

    distance: np.ndarray
    margin: np.ndarray
    own: np.ndarray


def sight(camera: Camera, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit directions (n,3) from points to the eye, and distances to it."""
    if camera.parallel:
        return np.tile(camera.direction, (len(points), 1)), np.full(len(points), np.inf)
    arm = np.asarray(camera.eye) - points
    length = np.linalg.norm(arm, axis=1)
    return arm / length[:, None], length


def sheets_in_front(shape, camera: Camera, points: np.ndarray, margin: float = 1e-3) -> tuple[np.ndarray, np.ndarray]:
    """(n,) how many sheets of a surface are in front of points, and whether that is sure.

    margin: in units of the surface's own size.
    """
    direction, length = sight(camera, points)
    hits = torus_hits(shape, points, direction) if isinstance(shape, Torus) else quadric_hits(shape, points, direction)
    t = hits.distance
    with np.errstate(invalid="ignore"):
        front = (t > 0.0) & (t < length[:, None])
        sure = (hits.margin > margin) & ((np.abs(t) > margin) | np.isnan(t))
        sure &= ~(np.abs(t - length[:, None]) < margin)
    return front.sum(axis=1), sure.all(axis=1)


def torus_polynomial(torus: Torus, points: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """(n,5) coefficients of the equation of the distances at which rays meet the torus, highest first."""
    a, b = torus.major, torus.minor
    p, d = points - np.asarray(torus.centre), direction
    beta, square = (p * d).sum(axis=1), (p * p).sum(axis=1) + (a - b) * (a + b)
    dd, pd, pp = ((x[:, :2] * y[:, :2]).sum(axis=1) for x, y in ((d, d), (p, d), (p, p)))
    return np.stack(
        [
            np.ones(len(p)),
            4.0 * beta,
            4.0 * beta**2 + 2.0 * square - 4.0 * a * a * dd,
            4.0 * beta * square - 8.0 * a * a * pd,
            square**2 - 4.0 * a * a * pp,
        ],
        axis=1,
    )


def deflated(coefficients: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Polynomials of degree 4 without their roots at 0, multiplied by the variable instead, and how many roots went."""
    c = coefficients / size ** np.arange(5)
    once = np.abs(c[:, 4]) < 1e-11
    twice = once & (np.abs(c[:, 3]) < 1e-9)
    gone = once.astype(int) + twice
    c[once, 4] = 0.0
    c[twice, 3] = 0.0
    return c, gone


def torus_hits(torus: Torus, points: np.ndarray, direction: np.ndarray) -> Hits:
    size = torus.major + torus.minor
    c, gone = deflated(torus_polynomial(torus, points, direction), size)
    distance, margin = np.full((len(c), 4), np.nan), np.full((len(c), 4), np.inf)
    for count in (0, 1, 2):
        some, degree = np.flatnonzero(gone == count), 4 - count
        matrix = np.zeros((len(some), degree, degree))
        matrix[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
        matrix[:, 0, :] = -c[some, 1 : degree + 1]
        roots = np.linalg.eigvals(matrix) if len(some) else np.zeros((0, degree), dtype=complex)
        real = np.abs(roots.imag) < 1e-9
        for k in range(degree):
            others = np.delete(roots, k, axis=1)
            apart = np.abs(roots[:, k, None] - others).min(axis=1, initial=np.inf)
            margin[some, k] = np.where(roots[:, k].real < -0.05, np.inf, apart)
            distance[some, k] = np.where(real[:, k], roots[:, k].real * size, np.nan)
    return Hits(distance, margin, gone > 0)


def quadric(shape) -> tuple[np.ndarray, np.ndarray, float]:
    """A, b, c of x.A.x + b.x + c = 0 about the centre."""
    none = np.zeros(3)
    match shape:
        case Sphere():
            return np.eye(3) / shape.radius**2, none, -1.0
        case Ellipsoid():
            return np.diag(np.asarray(shape.semi_axes) ** -2.0), none, -1.0
        case Cylinder():
            return np.diag([shape.radius**-2, (shape.depth or shape.radius) ** -2, 0.0]), none, -1.0
        case Cone():
            return np.diag([shape.slope**-2, (shape.depth_slope or shape.slope) ** -2, -1.0]), none, 0.0
        case Hyperboloid():
            x, y, z = np.asarray(shape.semi_axes) ** -2.0
            return np.diag([x, y, -z]), none, -1.0
        case Paraboloid():
            return np.diag([shape.a**-2, shape.b**-2, 0.0]), np.array([0.0, 0.0, -1.0]), 0.0
        case HyperbolicParaboloid():
            return np.diag([shape.a**-2, -(shape.b**-2), 0.0]), np.array([0.0, 0.0, -1.0]), 0.0
    raise TypeError(shape)


def inside(shape, at: np.ndarray) -> np.ndarray:
    """How far points (..., 3) about the centre are within the borders; infinite where there are none."""
    z = at[..., 2]
    match shape:
        case Cylinder() | Cone() | Hyperboloid():
            return np.minimum(z - shape.bottom, shape.top - z)
        case Paraboloid():
            return shape.top - z
        case HyperbolicParaboloid():
            return np.minimum(shape.width - np.abs(at[..., 0]), shape.depth - np.abs(at[..., 1]))
    return np.full(z.shape, np.inf)


def quadric_hits(shape, points: np.ndarray, direction: np.ndarray) -> Hits:
    form, linear, constant = quadric(shape)
    p, d = points - np.asarray(shape.centre), direction
    a = np.einsum("ij,jk,ik->i", d, form, d)
    b = 2.0 * np.einsum("ij,jk,ik->i", p, form, d) + d @ linear
    c = np.einsum("ij,jk,ik->i", p, form, p) + p @ linear + constant
    own = np.abs(c) < 1e-11
    c = np.where(own, 0.0, c)
    b = np.where(own & (np.abs(b) < 1e-8), 0.0, b)
    root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
    q = -0.5 * (b + np.where(b >= 0.0, 1.0, -1.0) * root)
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = np.where(own, -b / a, q / a), np.where(own, 0.0, c / q)
    exists = b * b - 4.0 * a * c >= 0.0
    t = np.where(exists[:, None], np.stack([first, second], axis=1), np.nan)
    t = np.where(np.isfinite(t), t, np.nan)
    t[own, 1] = np.nan
    t[own & (b == 0.0), 0] = np.nan
    at = p[:, None] + np.nan_to_num(t)[..., None] * d[:, None]
    within = inside(shape, at)
    margin = np.where(np.isnan(t), np.inf, np.abs(within))
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(b * b - 4.0 * a * c) / np.abs(a)
    margin = np.minimum(margin, np.where(own, np.inf, apart)[:, None])
    # Rays along a ruling run in the surface: they neither meet it nor miss it.
    margin[own & (b == 0.0) & (np.abs(a) < 1e-12)] = 0.0
    t = np.where(within >= 0.0, t, np.nan)
    return Hits(t, margin, own)
