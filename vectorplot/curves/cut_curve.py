"""Curves in space of which parts are cut away by planes, and where curves pass from one piece to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import Curve, second_derivatives
from vectorplot.curves.placed_curves import MovableCurve, PlacedCurve
from vectorplot.curves.splines import SplineCurve
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.mesh_cuts import HalfSpaces, nothing_beside
from vectorplot.tolerances import ROUNDING

# Where curves pass from one piece to the next.


@runtime_checkable
class PiecewiseCurve(Protocol):
    """A curve of several pieces, each of them smooth up to its ends: at breaks it may bend suddenly, or turn."""

    @property
    def breaks(self) -> Floats:
        """(k,) the parameters between which it is one piece, rising, start and end among them."""
        ...


def breaks_of(curve: Curve) -> Floats:
    """(k,) the parameters at which a curve passes from one piece to the next, those of its ends among them; none where
    it is a single piece."""
    curve = _at_home(curve)
    return curve.breaks if isinstance(curve, PiecewiseCurve) and len(curve.breaks) > 2 else np.zeros(0)


def degree_of(curve: Curve) -> int:
    """Of which degree the polynomials are that the pieces of a curve are, or their quotients; 0 if there are none."""
    curve = _at_home(curve)
    return curve.order - 1 if isinstance(curve, SplineCurve) else 0


def weights_of(curve: Curve, t: Floats) -> Floats:
    """(k,) what the polynomials of a curve are divided by at parameters (k,): 1 where there is nothing."""
    curve = _at_home(curve)
    return curve.weight(t) if isinstance(curve, SplineCurve) else np.ones(len(t))


def is_weighted(curve: Curve) -> bool:
    """Whether the pieces of a curve are quotients of polynomials."""
    curve = _at_home(curve)
    return isinstance(curve, SplineCurve) and curve.weights is not None


def _at_home(curve: Curve) -> Curve:
    """What is placed, if it is."""
    while isinstance(curve, PlacedCurve):
        curve = curve.curve
    return curve


PLACES = 4096
"""On a curve, from place to place of which it passes a plane once, or comes near to it once."""

HALVINGS = 60
"""Of the parameters between two places: they come down to rounding."""


@dataclass(frozen=True, eq=False)
class CutCurve(MovableCurve):
    """What is left of a curve between some of its parameters.

    curve: what is cut; parts: (k, 2) from where to where it is left, rising and apart from each other.
    """

    curve: Curve
    parts: Floats

    @property
    def start(self) -> float:
        """Where its first part begins."""
        return float(self.parts[0, 0])

    @property
    def end(self) -> float:
        """Where its last part ends."""
        return float(self.parts[-1, 1])

    @property
    def closed(self) -> bool:
        """False: what is closed is cut open."""
        return False

    @cached_property
    def breaks(self) -> Floats:
        """(k,) the ends of its parts, a place between any two, and where the curve itself bends suddenly."""
        between = 0.5 * (self.parts[:-1, 1] + self.parts[1:, 0])
        own = breaks_of(self.curve)
        own = own[(own > self.start) & (own < self.end)]
        return np.asarray(np.unique(np.concatenate([self.parts.ravel(), between, own])))

    def points(self, t: Floats) -> Floats:
        """(..., 3) points; NaN where the curve is cut away."""
        t = np.asarray(t, dtype=np.float64)
        slack = ROUNDING * max(abs(self.start), abs(self.end))
        part = np.maximum(np.searchsorted(self.parts[:, 0], t + slack, side="right") - 1, 0)
        low, high = self.parts[part, 0], self.parts[part, 1]
        there = (t >= low - slack) & (t <= high + slack)
        return np.where(there[..., None], self.curve.points(np.clip(t, low, high)), np.nan)

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return self.curve.tangents(t)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        return second_derivatives(self.curve, t)


def parts_outside(
    curve: Curve, regions: tuple[HalfSpaces, ...], within: HalfSpaces | None = None, places: Floats | None = None
) -> Floats:
    """(k,2) parameters between which a curve is outside of regions, and inside of one.

    places (n,): rising parameters, from one to the next of which it passes a plane once, or comes near to it once; a
    PLACES-th of the curve apart where None. Ends are zeros of the distance from a plane, down to rounding.
    Edge cases: what lies in a plane is outside, and inside of the one.
    """
    breaks = breaks_of(curve)
    t = np.union1d(np.linspace(curve.start, curve.end, PLACES + 1) if places is None else places, breaks)
    every = (*regions, *([] if within is None else [within]))
    with np.errstate(all="ignore"):
        points = curve.points(t)
        near = nothing_beside(points[np.isfinite(points).all(axis=1)])
        normals = np.concatenate([np.array(region.normals) for region in every])
        planes = [HalfSpaces((tuple(n),), (d,)) for n, d in zip(normals.tolist(), _offsets(every), strict=True)]
        ends = np.concatenate([t[[0, -1]], breaks, *(_zeros(curve, t, points, plane, near) for plane in planes)])
    ends = np.unique(ends)
    kept = _is_left(curve.points(0.5 * (ends[:-1] + ends[1:])), regions, within, near)
    first, last = kept & ~np.append(False, kept[:-1]), kept & ~np.append(kept[1:], False)
    return np.stack([ends[:-1][first], ends[1:][last]], axis=1)


def _offsets(regions: tuple[HalfSpaces, ...]) -> list[float]:
    return [offset for region in regions for offset in region.offsets]


def _is_left(points: Floats, regions: tuple[HalfSpaces, ...], within: HalfSpaces | None, near: float) -> Bools:
    left: Bools = np.asarray(np.isfinite(points).all(axis=1))
    for region in regions:
        left &= ~(region.heights(points) > near).all(axis=0)
    return left if within is None else np.asarray(left & (within.heights(points) >= -near).all(axis=0))


def _zeros(curve: Curve, t: Floats, points: Floats, plane: HalfSpaces, near: float) -> Floats:
    """(k,) parameters at which a curve passes a plane, from its points at rising t."""
    height = plane.heights(points)[0]
    height = np.where(np.abs(height) <= near, 0.0, height)
    slope = matmul(curve.tangents(t), np.array(plane.normals[0]))
    low, high = t[:-1], t[1:]
    # Between two places on one side the curve may come nearer, and pass the plane twice.
    comes = (height[:-1] * height[1:] > 0.0) & (height[:-1] * slope[:-1] < 0.0) & (height[1:] * slope[1:] > 0.0)
    turn = _halved(lambda at: matmul(curve.tangents(at), np.array(plane.normals[0])), low[comes], high[comes])
    t = np.union1d(t, turn)
    height = plane.heights(curve.points(t))[0]
    height = np.where(np.abs(height) <= near, 0.0, height)
    passed = height[:-1] * height[1:] < 0.0
    found = _halved(lambda at: plane.heights(curve.points(at))[0], t[:-1][passed], t[1:][passed])
    return np.concatenate([found, t[height == 0.0]])


def _halved(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """(k,) zeros of a function between parameters at which its signs differ."""
    if not len(low):
        return low
    sign = np.sign(function(low))
    before, after = bisected(lambda which, t: np.sign(function(t)) == sign[which], low, high, HALVINGS)
    return np.asarray(0.5 * (before + after))
