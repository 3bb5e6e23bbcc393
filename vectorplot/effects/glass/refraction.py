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
from vectorplot.geometry.elementary import arcsin, arctan, tan
from vectorplot.geometry.vectors import normalize
from vectorplot.tolerances.of_extent import IN_SURFACE_OF_DISTANCE
from vectorplot.tolerances.of_numbers import ROUNDING, ULP

MOST_STEPS = 100
"""Newton's iteration for a ray from point to point ends after so many steps; it has never been seen to take 40."""


def angle_of_refraction(alpha: ArrayLike, c: ArrayLike) -> Floats:
    """The angle beta between a refracted ray and the normal, of which sin(alpha) = c sin(beta).

    Parameters
    ----------
    alpha : (...) array_like of float
        The angle between ray and normal on the side that the ray comes from, in radians.
    c : (...) array_like of float
        The constant of Snell's law, about 4/3 for rays into water and 3/4 for those out of it.

    Returns
    -------
    (...) array of float
        In radians; NaN where the ray is totally reflected.

    Raises
    ------
    InputError
        For a constant that is not positive and finite.

    Notes
    -----
    Source: Glaeser, section 6.6, equation 3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> beta = effects.angle_of_refraction(np.radians([0.0, 30.0, 60.0]), 4 / 3)
    >>> np.degrees(beta).round(2).tolist()
    [0.0, 22.02, 40.51]
    >>> np.isnan(effects.angle_of_refraction(np.radians(60.0), 3 / 4)).item()
    True
    """
    sine = np.sin(np.asarray(alpha, dtype=np.float64)) / _constant(c)
    beta = arcsin(np.clip(sine, -1.0, 1.0))
    return np.asarray(np.where(np.abs(sine) <= 1.0, beta, np.nan))


def plate_shift(alpha: ArrayLike, thickness: ArrayLike, c: ArrayLike) -> Floats:
    """How far a plane-parallel plate shifts a ray, measured along the plate: a (tan(alpha) - tan(beta)).

    Parameters
    ----------
    alpha : (...) array_like of float
        The angle of incidence, in radians.
    thickness : (...) array_like of float
        Of the plate, in world units: the a of the equation.
    c : (...) array_like of float
        As of angle_of_refraction, for rays into the plate.

    Returns
    -------
    (...) array of float
        In the units of the thickness; NaN where the ray does not enter.

    Raises
    ------
    InputError
        For a constant that is not positive and finite.

    Notes
    -----
    The ray leaves the plate in its old direction; across itself it is shifted by cos(alpha) times this.

    Source: Glaeser, section 6.6, equation 4, figure 11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> effects.plate_shift(np.radians([0.0, 45.0]), 10.0, 1.5).round(3).tolist()
    [0.0, 4.655]
    """
    alpha = np.asarray(alpha, dtype=np.float64)
    beta = angle_of_refraction(alpha, c)
    return np.asarray(np.asarray(thickness, dtype=np.float64) * (tan(alpha) - tan(beta)))


def refracted(directions: ArrayLike, normals: ArrayLike, c: ArrayLike) -> tuple[Floats, Bools]:
    """The directions of rays behind surfaces with some normals.

    Parameters
    ----------
    directions : (..., 3) array_like of float
        Of the rays, of any length.
    normals : (..., 3) array_like of float
        Of the surfaces, of any length, to either side.
    c : (...) array_like of float
        As of angle_of_refraction, for rays in these directions.

    Returns
    -------
    (..., 3) array of float
        Unit vectors.
    (...) array of bool
        Which rays are totally reflected: these get the direction in which they go on.

    Raises
    ------
    InputError
        For vectors without length and constants that are not positive and finite.

    Notes
    -----
    Source: Glaeser, section 6.6, equation 3; section 8.5, equation 30.

    Examples
    --------
    >>> from vectorplot import effects
    >>> into_water, reflected = effects.refracted((1, 0, -1), (0, 0, 1), 4 / 3)
    >>> into_water.round(3).tolist(), reflected.item()
    ([0.53, 0.0, -0.848], False)
    >>> back, reflected = effects.refracted((2, 0, 1), (0, 0, 1), 3 / 4)
    >>> back.round(3).tolist(), reflected.item()
    ([0.894, 0.0, -0.447], True)
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
    """The angles of incidence at which an eye above a plane surface sees points below it.

    Parameters
    ----------
    p1 : (...) array_like of float
        How far the eye is from the point, measured along the surface.
    p2 : (...) array_like of float
        How high the eye is above the point.
    a : (...) array_like of float
        How deep the point is below the surface, so that the eye is p2 - a above it.
    c : (...) array_like of float
        As of angle_of_refraction, for rays from the eye into the water.

    Returns
    -------
    (...) array of float
        The angle alpha between ray and normal on the eye's side, in radians.

    Raises
    ------
    InputError
        For numbers that are not finite, a < 0 or p2 <= a, and constants that are not positive and finite.

    Notes
    -----
    (p2 - a) tan(alpha) + a tan(beta) = p1 to a few rounding steps.

    Degenerate: an eye right above the point looks straight down; a point in the surface is seen where it is, or, from
    the denser side, at the angle of total reflection if that is smaller.

    Source: Glaeser, section 6.6, equations 4 and 5; erratum G6-11 (the equation is algebraic).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> alpha = effects.inverse_refraction(p1=3.0, p2=4.0, a=2.0, c=4 / 3)
    >>> round(np.degrees(alpha).item(), 2)
    42.41
    >>> beta = effects.angle_of_refraction(alpha, 4 / 3)
    >>> round((2.0 * np.tan(alpha) + 2.0 * np.tan(beta)).item(), 9)
    3.0
    """
    return np.asarray(arctan(tangents_of_rays(p1, p2, a, c)[0]))


def seen_in_surface(eye: ArrayLike, points: ArrayLike, normal: ArrayLike, on_surface: ArrayLike, c: float) -> Floats:
    """Where in a plane surface an eye above it sees points that lie below it.

    Parameters
    ----------
    eye : (3,) array_like of float
        Above the surface.
    points : (n, 3) array_like of float
        Below it, or in it.
    normal : (3,) or (n, 3) array_like of float
        Of the surface, towards the eye, of any length.
    on_surface : (3,) or (n, 3) array_like of float
        A point of the plane, or one for each point.
    c : float
        As of angle_of_refraction, for rays from the eye into the material.

    Returns
    -------
    (n, 3) array of float
        Points of the surface: the picture of the pool has them where their points are.

    Raises
    ------
    InputError
        For points above the surface, an eye that is not above it, coordinates that are not finite, a normal without
        length and a constant that is not positive and finite.

    Notes
    -----
    Degenerate: points above the surface by no more than rounding are in it; for those in it and right below the eye see
    inverse_refraction.

    Source: Glaeser, section 6.6, figure 12 (the swimming pool).

    Examples
    --------
    >>> from vectorplot import effects
    >>> coins = [(0, 0, -2), (3, 0, -2)]
    >>> effects.seen_in_surface((0, 0, 2), coins, (0, 0, 1), (0, 0, 0), 4 / 3).round(2).tolist()
    [[0.0, 0.0, 0.0], [1.83, 0.0, 0.0]]
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
