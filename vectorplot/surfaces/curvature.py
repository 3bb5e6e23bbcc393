"""Fundamental forms and curvatures of surfaces."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import dot
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import Surface


def first_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """The first fundamental form E, F, G of a surface, which measures lengths on it.

    Parameters
    ----------
    surface : Surface
        With its partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    three (...) arrays of float
        The scalar products x_u.x_u, x_u.x_v, x_v.x_v, in squared world units.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> e, f, g = surfaces.first_form(surfaces.Cylinder(radius=3.0), np.array(0.5), np.array(0.0))
    >>> round(float(e), 9), abs(round(float(f), 9)), round(float(g), 9)
    (9.0, 0.0, 1.0)
    """
    a, b = surface.partials(u, v)
    return dot(a, a), dot(a, b), dot(b, b)


def second_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """The second fundamental form L, M, N of a surface, which measures how it bends.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    three (...) arrays of float
        The parts of x_uu, x_uv, x_vv along the unit normal, in world units.

    Notes
    -----
    Degenerate: NaN where unit_normals are.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cylinder = surfaces.Cylinder(radius=3.0)  # bends away from its normals, which point outwards
    >>> [abs(round(float(part), 9)) for part in surfaces.second_form(cylinder, np.array(0.5), np.array(0.0))]
    [3.0, 0.0, 0.0]
    """
    n = unit_normals(surface, u, v)
    uu, uv, vv = surface.second_partials(u, v)
    return dot(n, uu), dot(n, uv), dot(n, vv)


def gaussian_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The products of the principal curvatures of a surface.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    (...) array of float
        One over squared world units; above 0 where the surface is dome-shaped, below 0 at a saddle.

    Notes
    -----
    Degenerate: NaN at poles and singular points.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> u, v = np.array([0.0, 1.0]), np.array([0.5, 0.7])
    >>> surfaces.gaussian_curvature(surfaces.Sphere(2.0), u, v).round(9).tolist()
    [0.25, 0.25]
    >>> bool((surfaces.gaussian_curvature(surfaces.HyperbolicParaboloid(), u, v) < 0.0).all())
    True
    """
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(p * q - m * m, e * g - f * f)


def mean_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The means of the principal curvatures of a surface.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    (...) array of float
        One over world units; positive where the surface bends towards its normal.

    Notes
    -----
    Degenerate: NaN at poles and singular points.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> u, v = np.array(1.0), np.array(0.5)
    >>> float(surfaces.mean_curvature(surfaces.Sphere(2.0), u, v).round(9))
    -0.5
    >>> bool(abs(surfaces.mean_curvature(surfaces.helicoid_to_catenoid(bending=0.3), u, v)) < 1e-12)
    True
    """
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(0.5 * (e * q - 2.0 * f * m + g * p), e * g - f * f)


def _ratio(above: Floats, below: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(below > 0.0, above / below, np.nan)
