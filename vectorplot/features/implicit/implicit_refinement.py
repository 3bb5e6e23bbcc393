"""Points brought onto a curve F = 0, g = 0 in space, and polylines on it refined where they leave it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.implicit_conditions import SpatialCondition
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.polygonize import checked_values, onto_surface
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry.chord_refinement import Refined, Traces, refined
from vectorplot.geometry.vectors import dot
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_extent import LAST_STEP_OF_EXTENT, RESIDUAL_OF_EXTENT
from vectorplot.tolerances.of_values import FALLS_BESIDE

Picture = Callable[[Floats], Floats]

ROUNDS = 16
"""Steps of Newton's method until another way is tried."""


@dataclass(frozen=True, eq=False)
class CurveInSpace:
    """The curve on which F of a surface and a condition g vanish. size: how large g is where it is far from zero;
    extent: of the surface; noise: what rounding makes of coordinates."""

    surface: ImplicitSurface
    condition: SpatialCondition
    size: float
    extent: float
    noise: float

    def values(self, points: Floats) -> Floats:
        """(...,) g; NaN where it is not finite."""
        with np.errstate(all="ignore"):
            w = np.array(self.condition.values(points), dtype=np.float64)
        w[~np.isfinite(w)] = np.nan
        return w

    def slopes(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,3) the unit normals N of the surface, and the gradients of g along the surface."""
        with np.errstate(all="ignore"):
            normal = self.surface.gradients(points)
            normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
            slope = self.condition.gradients(points)
            return np.asarray(normal), np.asarray(slope - dot(slope, normal)[..., None] * normal)

    def onto(self, points: Floats, reach: Floats, fixed: Bools | None = None) -> tuple[Floats, Bools]:
        """Points (n,3) moved the shortest way onto the curve, steps not longer than reach (n,), and which got there.

        fixed (n,3+k): sides that they stay on. A point that ends further off than twice its reach did not.
        """
        x, arrived = points.copy(), np.zeros(len(points), dtype=np.bool_)
        active: Ints = np.arange(len(points))
        for _ in range(ROUNDS):
            if not len(active):
                break
            held = None if fixed is None else fixed[active]
            step, there = self._step(x[active], held)
            arrived[active] = there
            length = np.linalg.norm(step, axis=1)
            usable = np.isfinite(length)
            with np.errstate(all="ignore"):
                step *= np.minimum(1.0, reach[active] / np.where(length > 0.0, length, 1.0))[:, None]
            # The last step of those that arrived costs nothing and gains digits, if it is a small one.
            goes = usable & (~there | (length <= LAST_STEP_OF_EXTENT * self.extent))
            x[active[goes]] += step[goes]
            active = active[usable & ~there]
        arrived &= np.linalg.norm(x - points, axis=1) <= 2.0 * reach
        return np.where(arrived[:, None], x, points), arrived

    def _step(self, x: Floats, fixed: Bools | None) -> tuple[Floats, Bools]:
        """(n,3) Newton's step of least length for both equations, and whether x satisfies them already."""
        with np.errstate(all="ignore"):
            f, g = checked_values(self.surface, x), self.values(x)
            slope_f, slope_g = self.surface.gradients(x), self.condition.gradients(x)
            if fixed is not None:
                sides = sides_of(self.surface)
                slope_f, slope_g = sides.along(slope_f, fixed), sides.along(slope_g, fixed)
            ff, fg, gg = dot(slope_f, slope_f), dot(slope_f, slope_g), dot(slope_g, slope_g)
            determinant = ff * gg - fg * fg
            of_f, of_g = (gg * f - fg * g) / determinant, (ff * g - fg * f) / determinant
            step = -(of_f[:, None] * slope_f + of_g[:, None] * slope_g)
            near = RESIDUAL_OF_EXTENT * self.extent + self.noise
            there = (np.abs(f) <= near * np.sqrt(ff)) & (
                np.abs(g) <= RESIDUAL_OF_EXTENT * self.size + self.noise * np.sqrt(gg)
            )
        return step, np.asarray(there)

    def between(self, a: Floats, b: Floats, fixed: Bools) -> tuple[Floats, Bools]:
        """(k,3) points of the curve between points a and b (k,3) of the surface on different sides of g = 0, and which
        are zeros of g indeed; slow and sure: by brackets on the surface."""
        reach = np.linalg.norm(b - a, axis=1)

        def place(t: Floats, which: Ints) -> Floats:
            chord = a[which] + t[:, None] * (b - a)[which]
            return onto_surface(self.surface, chord, reach=reach[which], fixed=fixed[which])[0]

        w0, w1 = self.values(a), self.values(b)
        small = np.full(len(a), RESIDUAL_OF_EXTENT * self.size)
        with np.errstate(all="ignore"):
            guess = np.clip(np.nan_to_num(w0 / (w0 - w1), nan=0.5), 0.0, 1.0)
        t, rest = bracketed_zeros(lambda t, which: self.values(place(t, which)), w0, w1, guess, small)
        exact = (w0 == 0.0) | (w1 == 0.0)
        t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
        falls = np.abs(rest) <= FALLS_BESIDE * np.minimum(np.abs(w0), np.abs(w1)) + small
        return place(t, np.arange(len(a))), np.asarray(exact | falls, dtype=np.bool_)


def curve_in_space(surface: ImplicitSurface, condition: SpatialCondition, size: float) -> CurveInSpace:
    """The curve on which a condition of this size holds."""
    box = np.asarray(surface.box, dtype=np.float64)
    noise = 4.0 * float(np.spacing(np.abs(box).max()))
    return CurveInSpace(surface, condition, size, float(np.ptp(box, axis=0).max()), noise)


def refined_chords(curve: CurveInSpace, lines: Traces, tolerance: float, picture: Picture | None, most: int) -> Refined:
    """Polylines (points (p,3)) with points of the curve put in until chords stay within tolerance of it, measured in
    the picture, or there are most of them."""

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        chord = end - start
        return curve.onto(start + part[:, None] * chord, np.linalg.norm(chord, axis=1))

    return refined(lines, between, picture or (lambda points: points), tolerance, most)
