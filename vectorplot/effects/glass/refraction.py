"""Light that enters and leaves transparent material: Snell's law in the plane and in space, and its inversion.

The constant c of a refraction is sin(alpha) / sin(beta), alpha the angle between ray and normal on the side the ray
comes from, beta on the other side: about 4/3 for a ray that enters water, 3/4 for one that leaves it.
Source: Glaeser, section 6.6, figure 11.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import normalize
from vectorplot.tolerances.of_extent import IN_SURFACE_OF_DISTANCE
from vectorplot.tolerances.of_numbers import ROUNDING, ULP

MOST_STEPS = 100
"""Newton's iteration for a ray from point to point ends after so many steps; it has never been seen to take 40."""


def angle_of_refraction(alpha: ArrayLike, c: ArrayLike) -> Floats:
    """(...) the angle beta, in radians, of which sin(alpha) = c sin(beta); NaN where the ray is totally reflected.

    Errors: InputError for a constant that is not positive and finite.
    Source: Glaeser, section 6.6, equation 3.
    """
    sine = np.sin(np.asarray(alpha, dtype=np.float64)) / _constant(c)
    beta = np.arcsin(np.clip(sine, -1.0, 1.0))
    return np.asarray(np.where(np.abs(sine) <= 1.0, beta, np.nan))


def plate_shift(alpha: ArrayLike, thickness: ArrayLike, c: ArrayLike) -> Floats:
    """(...) how far a plane-parallel plate shifts a ray, measured along the plate: a (tan(alpha) - tan(beta)).

    The ray leaves the plate in its old direction; across itself it is shifted by cos(alpha) times this. NaN where the
    ray does not enter. Errors: InputError for a constant that is not positive and finite.
    Source: Glaeser, section 6.6, equation 4, figure 11.
    """
    alpha = np.asarray(alpha, dtype=np.float64)
    beta = angle_of_refraction(alpha, c)
    return np.asarray(np.asarray(thickness, dtype=np.float64) * (np.tan(alpha) - np.tan(beta)))


def refracted(directions: ArrayLike, normals: ArrayLike, c: ArrayLike) -> tuple[Floats, Bools]:
    """(..., 3) unit directions of rays behind surfaces with some normals, and (...) which rays are totally reflected:
    these get the direction in which they go on.

    directions, normals (..., 3) of any length; the normals point to either side; c (...) for rays in these directions.
    Errors: InputError for vectors without length and constants that are not positive and finite.
    Source: Glaeser, section 6.6, equation 3; section 8.5, equation 30.
    """
    d, n, c = normalize(directions), normalize(normals), _constant(c)[..., None]
    height = (d * n).sum(axis=-1, keepdims=True)
    along = (d - height * n) / c
    square = 1.0 - (along * along).sum(axis=-1, keepdims=True)
    total = square < 0.0
    through = along + np.copysign(np.sqrt(np.maximum(square, 0.0)), height) * n
    result = np.where(total, d - 2.0 * height * n, normalize(through))
    return np.asarray(result), np.asarray(total[..., 0], dtype=np.bool_)


def tangents_of_rays(p1: ArrayLike, p2: ArrayLike, a: ArrayLike, c: ArrayLike) -> tuple[Floats, Floats]:
    """(...) tan(alpha) and tan(beta) of the rays from a point below a plane surface to an eye above it.

    p1: how far the eye is from the point, measured along the surface; p2: how high it is above the point; a: how deep
    the point is below the surface, so that the eye is p2 - a above it; c: of rays from the eye into the water.
    (p2 - a) tan(alpha) + a tan(beta) = p1 to a few rounding steps.
    Errors: InputError for numbers that are not finite, a < 0 or p2 <= a, and constants that are not positive.
    Degenerate: an eye right above the point looks straight down; a point in the surface is seen where it is, or, from
    the denser side, at the angle of total reflection if that is smaller.
    Source: Glaeser, section 6.6, equations 4 and 5; erratum G6-11 (the equation is algebraic).
    """
    p1, p2, a, c = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (p1, p2, a, c)))
    above = p2 - a
    if not (np.isfinite(p1).all() and np.isfinite(p2).all() and (a >= 0.0).all() and (above > 0.0).all()):
        raise InputError("a ray into the water needs finite distances, a depth >= 0 and an eye above the surface")
    c = _constant(c)
    # By the tangent t on the thinner side, where it is the larger one, the equation is concave for t > 0: Newton's
    # iteration from 0 climbs to the zero and never passes it.
    swap = c < 1.0
    ratio = np.where(swap, 1.0 / c, c)
    target = np.abs(p1)
    near, far = np.where(swap, a, above), np.where(swap, above, a)
    near = np.maximum(near, IN_SURFACE_OF_DISTANCE * (far + target))
    t = np.zeros(target.shape)
    excess = (ratio - 1.0) * (ratio + 1.0)
    for _ in range(MOST_STEPS):
        root = np.sqrt(ratio * ratio + excess * t * t)
        slope = near + far * (ratio / root) ** 2 / root
        step = (target - near * t - far * t / root) / slope
        before, t = t, np.maximum(t + step, t)
        if (t - before <= ULP * t).all():
            break
    other = t / np.sqrt(ratio * ratio + excess * t * t)
    sign = np.sign(p1)
    return np.asarray(sign * np.where(swap, other, t)), np.asarray(sign * np.where(swap, t, other))


def inverse_refraction(p1: ArrayLike, p2: ArrayLike, a: ArrayLike, c: ArrayLike) -> Floats:
    """(...) the angle of incidence alpha, in radians, of the rays of tangents_of_rays.

    Errors, Degenerate and Source: as there.
    """
    return np.asarray(np.arctan(tangents_of_rays(p1, p2, a, c)[0]))


def seen_in_surface(eye: ArrayLike, points: ArrayLike, normal: ArrayLike, on_surface: ArrayLike, c: float) -> Floats:
    """(n, 3) where in a plane surface an eye above it sees points (n, 3) that lie below it.

    normal (3,) points to the eye's side; on_surface (3,): a point of the plane; or (n, 3), a plane for each point.
    c: of rays from the eye into the material.
    Errors: as of tangents_of_rays.
    Degenerate: as there; points above the surface by no more than rounding are in it.
    Source: Glaeser, section 6.6, figure 12 (the swimming pool).
    """
    n = normalize(normal)
    e, p, origin = (np.asarray(x, dtype=np.float64) for x in (eye, points, on_surface))
    high, deep = ((e - origin) * n).sum(axis=-1), -((p - origin) * n).sum(axis=-1)
    noise = ROUNDING * max(float(np.abs(x).max(initial=0.0)) for x in (e, p, origin))
    deep = np.where((deep < 0.0) & (deep >= -noise), 0.0, deep)
    arm = p - e
    along = arm + (high + deep)[:, None] * n
    far = np.sqrt((along * along).sum(axis=1))
    tangent, _ = tangents_of_rays(far, high + deep, deep, c)
    share = high * tangent / np.where(far > 0.0, far, 1.0)
    return np.asarray(e - high[..., None] * n + share[:, None] * along)


def _constant(c: ArrayLike) -> Floats:
    """The constants as an array. Errors: InputError where one is not positive and finite."""
    constant = np.asarray(c, dtype=np.float64)
    if not ((constant > 0.0) & (constant < np.inf)).all():
        raise InputError("the constant of a refraction must be a positive number")
    return constant
