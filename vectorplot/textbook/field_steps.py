"""Integral curves of a tangent field by equal steps in the parameters: Euler's, and those of Runge and Kutta."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.surface_integration import FieldFlow
from vectorplot.features.surface_points import MAIN, Sites, charts
from vectorplot.features.tangent_fields import TangentField
from vectorplot.surfaces.surface import Surface

Rates = Callable[[Floats], Floats]
"""Takes u and v (k,2) to their derivatives (k,2) by the length of the curve."""

Move = Callable[[Rates, Floats, Floats, float], Floats]
"""Takes the rates, u and v (k,2), their derivatives there (k,2) and the length of a step to what it leads by (k,2)."""


def euler_curves(surface: Surface, field: TangentField, starts: ArrayLike, length: float, steps: int) -> Floats:
    """The parameters of points along integral curves by Euler's method: every step follows the tangent at its start.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    field : TangentField
        What they follow.
    starts : (k, 2) array_like of float
        Parameters u, v within the domain.
    length : float
        Of the curves, in world units.
    steps : int
        How many equal ones they consist of.

    Returns
    -------
    (k, steps + 1, 2) array of float
        u and v, running on over seams; NaN from where a curve leaves the domain or the field has no direction.

    Raises
    ------
    InputError
        For starts that are not pairs of finite numbers, a length that is not positive, and fewer than one step.

    Notes
    -----
    The error is like the first power of the step: on curves that bend one way it always falls to the same side, and
    closed ones do not close. Edge cases: at poles there is no step.

    Source: Glaeser, section 9.4, equations 18 and 19, errata G9-13 and G9-14: derivatives are exact here, and the
    length of a step is one on the surface.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> from vectorplot.textbook import euler_curves
    >>> course, end = features.loxodromes(np.radians(225)), 2.0 * np.arctanh(np.tan(0.5))
    >>> one, other = (euler_curves(surfaces.Sphere(), course, [(0, 0)], 2**0.5, n)[0, -1] for n in (50, 100))
    >>> ((end - one) / (end - other)).round(1).tolist()[:1]
    [2.0]
    """
    return _curves(surface, field, starts, length, steps, _euler)


def runge_kutta_curves(surface: Surface, field: TangentField, starts: ArrayLike, length: float, steps: int) -> Floats:
    """The parameters of points along integral curves by the classical method of Runge and Kutta.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    field : TangentField
        What they follow.
    starts : (k, 2) array_like of float
        Parameters u, v within the domain.
    length : float
        Of the curves, in world units.
    steps : int
        How many equal ones they consist of.

    Returns
    -------
    (k, steps + 1, 2) array of float
        u and v, see `euler_curves`.

    Raises
    ------
    InputError
        For what `euler_curves` refuses.

    Notes
    -----
    Every step looks at four tangents: its own, two half-way, one at its end. The error is like the fourth power of the
    step.

    Source: Kutta, Beitrag zur näherungsweisen Integration totaler Differentialgleichungen (1901); erratum G9-13.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> from vectorplot.textbook import runge_kutta_curves
    >>> course, end = features.loxodromes(np.radians(225)), 2.0 * np.arctanh(np.tan(0.5))
    >>> at = runge_kutta_curves(surfaces.Sphere(), course, [(0, 0)], 2**0.5, 100)[0, -1]
    >>> bool(np.abs(at - (end, -1.0)).max() < 1e-7)
    True
    """
    return _curves(surface, field, starts, length, steps, _runge_kutta)


def _curves(surface: Surface, field: TangentField, starts: ArrayLike, length: float, steps: int, move: Move) -> Floats:
    at = np.atleast_2d(np.asarray(starts, dtype=np.float64))
    if at.ndim != 2 or at.shape[1] != 2 or not np.isfinite(at).all():
        raise InputError("steps of a field: starts must be pairs of finite parameters")
    if steps < 1:
        raise InputError(f"steps of a field: expected at least 1, not {steps}")
    step = positive("steps of a field: length", length) / steps
    flow = FieldFlow(surface, charts(surface), field)
    domain = surface.domain
    low, high = (domain.u_start, domain.v_start), (domain.u_end, domain.v_end)
    tangents = field.tangents(Sites(surface, *flow.charts.inside(at)))[0]
    found = np.full((len(at), steps + 1, 2), np.nan)
    on = np.arange(len(at))
    for number in range(steps + 1):
        inside = ((at >= low) & (at <= high) | (domain.closed_u, domain.closed_v)).all(axis=1)
        here = inside & np.isfinite(at).all(axis=1)
        on, at, last = on[here], at[here], tangents[here]
        found[on, number] = at
        chart, way = np.full(len(on), MAIN), np.ones(len(on))

        def rates(places: Floats, chart: Ints = chart, last: Floats = last, way: Floats = way) -> Floats:
            return flow.rates(chart, places, last, way)[0]

        first, tangents, _ = flow.rates(chart, at, last, way)
        at = at + move(rates, at, first, step)
    return found


def _euler(rates: Rates, at: Floats, first: Floats, step: float) -> Floats:
    return step * first


def _runge_kutta(rates: Rates, at: Floats, first: Floats, step: float) -> Floats:
    second = rates(at + 0.5 * step * first)
    third = rates(at + 0.5 * step * second)
    fourth = rates(at + step * third)
    return np.asarray(step / 6.0 * (first + 2.0 * (second + third) + fourth))
