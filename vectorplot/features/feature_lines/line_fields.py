"""The functions on a shape whose zeros are its feature lines, and how strong a line is where they vanish.

Curvatures count as positive where a shape bends away from who looks at it, or from what is outside of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.feature_lines.bending import Bending, Sight, applied, principal_axes
from vectorplot.geometry.elementary import power
from vectorplot.geometry.vectors import dot
from vectorplot.words import LineKind

LineFunction = Callable[[Bending], "LineField"]

ROUND = 0.1
"""Where the curvature falls off beside a ridge by less than so many times its third power it is nearly a circle's."""


@dataclass(frozen=True, eq=False)
class LineField:
    """A function at points of a shape.

    values (n,): lines are where they vanish; strength (n,): how clear a line there is, a number that does not change
    when all is made larger, NaN where there is none; directions (n,3), or None: those that values belong to, which
    change sign with them: a line is where what they are derivatives of is largest. height (n,): that size. sides (n,):
    -1 where the shape turns away from the eye, where that matters.
    """

    values: Floats
    strength: Floats
    directions: Floats | None
    height: Floats | None = None
    sides: Floats | None = None


def line_function(kind: LineKind, sight: Sight, extent: float, outward: float | None) -> LineFunction:
    """The function whose zeros are lines of a kind, on a body of an extent.

    outward: 1 or -1 as the normals of a closed body point out of or into it, or None, where the side one sees counts.
    """
    if kind == LineKind.SUGGESTIVE:
        return lambda bending: _suggestive(bending, sight, extent)
    if kind == LineKind.APPARENT:
        return lambda bending: _apparent(bending, sight, extent)
    sign = 1.0 if kind == LineKind.RIDGE else -1.0
    return lambda bending: _ridge(bending.turned_over(sign * _sides(bending, sight, outward)), extent)


def _sides(bending: Bending, sight: Sight, outward: float | None) -> Floats:
    """(n,) -1 where normals point outwards, or to the eye, else 1: where curvatures are those of the convex."""
    if outward is not None:
        return np.full(len(bending), -outward)
    return np.where(dot(sight.ways(bending.points)[0], bending.normals) < 0.0, 1.0, -1.0)


def _suggestive(bending: Bending, sight: Sight, extent: float) -> LineField:
    """The radial curvature, and how fast it grows towards the eye.

    With w the part of the way to the eye in the tangent plane: values are the second fundamental form of w; a line is
    where it grows along w. Source: DeCarlo, Finkelstein, Rusinkiewicz, Santella (2003), section 3.
    """
    ways, _ = sight.ways(bending.points)
    cosine = dot(ways, bending.normals)
    seen = bending.turned_over(np.where(cosine < 0.0, 1.0, -1.0))
    w = bending.in_plane(ways)
    aside = np.stack([-w[:, 1], w[:, 0]], axis=1)
    values = dot(bending.bent(w), w)
    sine = np.sqrt(dot(w, w))
    twist = dot(seen.bent(w), aside)
    with np.errstate(divide="ignore", invalid="ignore"):
        # Divided by the cosine: where the surface nearly turns away, a faint line will soon be a contour.
        growth = (seen.cubed(w) / sine - 2.0 * np.abs(cosine) * (twist / sine) ** 2 / sine) / np.abs(cosine)
    return LineField(values, extent * extent * growth, None, sides=np.sign(cosine))


def _ridge(bending: Bending, extent: float) -> LineField:
    """The derivative of the largest curvature along its own direction.

    A line is where it is largest, and larger than the other curvature turned the other way.
    Source: Ohtake, Belyaev, Seidel (2004), section 2.
    """
    most, least, direction, _ = principal_axes(bending.second)
    clear = np.maximum(most - np.abs(least), 0.0)
    return LineField(bending.cubed(direction), extent * clear, bending.in_space(direction), most)


def _apparent(bending: Bending, sight: Sight, extent: float) -> LineField:
    """The derivative of the view-dependent curvature along its own direction.

    That curvature is how fast the normal turns over the image: the larger singular value of S P^-1, S the shape
    operator and P the projection of the tangent plane to the image. Its square is the larger eigenvalue of
    A = S S + (S w) (S w)' / c^2, w the tangential part of the way to the eye and c its part along the normal.
    Source: Judd, Durand, Adelson (2007), section 3.
    """
    ways, nearness = sight.ways(bending.points)
    cosine, w = dot(ways, bending.normals), bending.in_plane(ways)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        tangent = bending.bent(w) / cosine[:, None]
        p, m, q = bending.second.T
        one, two = tangent.T
        form = np.stack([p * p + m * m + one * one, m * (p + q) + one * two, m * m + q * q + two * two], axis=1)
        square, other, a, _ = principal_axes(form)
        turning = bending.bent(a)
        # The direction in the tangent plane whose image is that of the curvature.
        x = turning + (dot(turning, w) / cosine**2)[:, None] * w
        x = x / np.sqrt(dot(x, x))[:, None]
        change = bending.changing(x)
        bent = bending.bent(x)
        along = dot(x, w)
        turn = dot(a, bending.bent(w))
        way_turns = dot(turning, -(x - along[:, None] * w)) * nearness
        normal_turns = -dot(bent, w) + along * cosine * nearness
        twisted = dot(a, applied(change, w)) + dot(a, bending.bent(bent)) * cosine + way_turns
        derivative = (
            2.0 * dot(turning, applied(change, a))
            + 2.0 * turn * twisted / cosine**2
            - 2.0 * turn * turn * normal_turns / power(cosine, 3)
        )
        # Where one looks straight at a ball all directions are alike.
        clear = np.sqrt(square) - np.sqrt(np.maximum(other, 0.0))
        return LineField(
            derivative / (np.maximum(square, 0.0) * np.sqrt(np.maximum(square, 0.0))),
            extent * clear,
            bending.in_space(x),
            None,
            np.sign(cosine),
        )


def sharpness(falls: Floats, height: Floats) -> Floats:
    """(n,) 0 to 1: how clearly a curvature falls off beside a ridge, by falls (n,), where it has a height (n,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.clip(-falls / (ROUND * height**3), 0.0, 1.0)
