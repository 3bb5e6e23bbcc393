"""Control points with weights, and the points and derivatives of rational splines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError


@dataclass(frozen=True, eq=False)
class Homogeneous:
    """Control points (..., 3) about their middle (3,), or (..., 4) those times their weights and the weights: sums near
    the middle lose no digits where a scene is far away."""

    middle: Floats
    controls: Floats

    @classmethod
    def of(cls, controls: Floats, weights: Floats | None) -> Homogeneous:
        """Those of control points (..., 3) and weights (...)."""
        flat = controls.reshape(-1, 3)
        middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        about = controls - middle
        if weights is None:
            return cls(middle, about)
        return cls(middle, np.concatenate([about * weights[..., None], weights[..., None]], axis=-1))

    @property
    def rational(self) -> bool:
        """Whether there are weights."""
        return bool(self.controls.shape[-1] == 4)

    def points(self, sums: Floats) -> Floats:
        """(..., 3) points from sums of control points."""
        return np.asarray((sums[..., :3] / sums[..., 3:] if self.rational else sums) + self.middle)

    def back(self, controls: Floats) -> tuple[Floats, Floats | None]:
        """Control points (..., 3) and weights (...) from those of the same spline over other knots."""
        if not self.rational:
            return controls + self.middle, None
        return controls[..., :3] / controls[..., 3:] + self.middle, np.asarray(controls[..., 3])


def first_quotient(sums: Floats, slopes: Floats) -> Floats:
    """(..., 3) derivatives from the sums and their derivatives."""
    if sums.shape[-1] == 3:
        return slopes
    x = sums[..., :3] / sums[..., 3:]
    return np.asarray((slopes[..., :3] - x * slopes[..., 3:]) / sums[..., 3:])


def second_quotient(sums: Floats, by_a: Floats, by_b: Floats, by_both: Floats) -> Floats:
    """(..., 3) second derivatives, by a and b, from the sums and their derivatives."""
    if sums.shape[-1] == 3:
        return by_both
    x, a, b = sums[..., :3] / sums[..., 3:], first_quotient(sums, by_a), first_quotient(sums, by_b)
    rest = by_both[..., :3] - a * by_b[..., 3:] - b * by_a[..., 3:] - x * by_both[..., 3:]
    return np.asarray(rest / sums[..., 3:])


def checked_controls(name: str, points: ArrayLike, dimensions: int) -> Floats:
    """A line (n,3) or a grid (m,n,3) of points. Errors: InputError, naming the spline, for others, and points that are
    not finite."""
    expected = "a line of points" if dimensions == 1 else "a grid of points, all its lines equally long"
    try:
        p = np.array(points, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected {expected} of three numbers each") from None
    if p.ndim != dimensions + 1 or p.shape[-1] != 3:
        raise InputError(f"{name}: expected {expected} of three numbers each, not shape {p.shape}")
    bad = np.argwhere(~np.isfinite(p).all(axis=-1))
    if len(bad):
        raise InputError(f"{name}: point {' , '.join(str(k + 1) for k in bad[0])} is not finite")
    return p


def checked_weights(name: str, weights: ArrayLike | None, shape: tuple[int, ...]) -> Floats | None:
    """Weights of this shape, one for each point. Errors: InputError for others, and for those that are not positive."""
    if weights is None:
        return None
    try:
        w = np.array(weights, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: weights must be numbers") from None
    if w.shape != shape:
        said, wanted = (" by ".join(str(k) for k in size) for size in (w.shape, shape))
        raise InputError(f"{name}: {said or 1} weights for {wanted} points")
    if not np.isfinite(w).all() or not (w > 0.0).all():
        raise InputError(f"{name}: weights must be positive and finite")
    return w
