"""Surfaces of functions that users write."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, cut_off, numeric_function
from vectorplot.errors import InputError
from vectorplot.surfaces.jets import FirstJets, SecondJets
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_extent import GAP_OF_EXTENT

LOOKS = 16
"""Columns and rows of the points at which a seam is looked at."""


def ranges_of(domain: Domain) -> tuple[Range, Range]:
    """The ranges of u and v."""
    return (
        Range(domain.u_start, domain.u_end, domain.closed_u),
        Range(domain.v_start, domain.v_end, domain.closed_v),
    )


@dataclass(frozen=True, eq=False)
class FunctionSurface(MovableSurface):
    """The surface of a user's function, with its derivatives.

    Parameters
    ----------
    domain : Domain
        Where it is defined.
    function : NumericFunction
        The points.
    first : tuple of NumericFunction
        The derivatives by u and by v, or empty: they are found from the points.
    second : tuple of NumericFunction
        The second derivatives by uu, uv and vv, or empty.
    jets : tuple of NumericFunction
        Points and first derivatives at once, and these with the second derivatives; or empty.

    Notes
    -----
    Made by `surface_of_function`. Where the function has no value the points are NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> plane = surfaces.surface_of_function(lambda u, v: (u, v, u + v), surfaces.Domain(0, 1, 0, 1))
    >>> isinstance(plane, surfaces.FunctionSurface), plane.points(np.array(0.5), np.array(1.0)).tolist()
    (True, [0.5, 1.0, 1.5])
    """

    domain: Domain
    function: NumericFunction
    first: tuple[NumericFunction, ...] = ()
    second: tuple[NumericFunction, ...] = ()
    jets: tuple[NumericFunction, ...] = ()

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points, NaN where the function is."""
        return self.function.values(u, v)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        if self.first:
            return self.first[0].values(u, v), self.first[1].values(u, v)
        by_u, by_v = self.function.gradient(u, v)
        return by_u, by_v

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        if self.second:
            uu, uv, vv = self.second
            return uu.values(u, v), uv.values(u, v), vv.values(u, v)
        if self.first:
            by_u, by_v = self.first
            by_uu, by_uv = by_u.gradient(u, v)
            return by_uu, by_uv, by_v.derivatives(1, u, v)
        by_uu, by_uv, by_vv = self.function.hessian(u, v)
        return by_uu, by_uv, by_vv

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once where they are known at once."""
        if self.jets:
            points, by_u, by_v = _vectors(self.jets[0].values(u, v))
        elif self.first:
            return self.points(u, v), *self.partials(u, v)
        else:
            points, by_u, by_v = self.function.values_and_gradient(u, v)
        return points, by_u, by_v

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once where they are known at once."""
        if not self.jets:
            return *self.first_jets(u, v), *self.second_partials(u, v)
        points, by_u, by_v, uu, uv, vv = _vectors(self.jets[1].values(u, v))
        return points, by_u, by_v, uu, uv, vv


def _vectors(values: Floats) -> list[Floats]:
    """The vectors (..., 3) that stand side by side in values (..., 3k)."""
    return [np.ascontiguousarray(values[..., k : k + 3]) for k in range(0, values.shape[-1], 3)]


def surface_of_function(
    function: Callable[..., Any],
    domain: Domain,
    *,
    partials: Sequence[Callable[..., Any]] = (),
    second_partials: Sequence[Callable[..., Any]] = (),
) -> FunctionSurface:
    """The surface of the points that a user's function gives.

    Parameters
    ----------
    function : callable
        Takes arrays u, v (n,) and returns x, y, z, each (n,) or one number, or an array (n, 3) or (3, n). One that
        takes single numbers works too, slower.
    domain : Domain
        Where the function is asked.
    partials : sequence of callables
        Two such functions, by u and by v, or none.
    second_partials : sequence of callables
        Three such functions, by uu, uv and vv, or none.

    Returns
    -------
    FunctionSurface
        What is not given comes by complex step if the function takes complex numbers, else by differences of fourth
        order: first derivatives to about 1e-12 of the largest, second ones to about 1e-9.

    Raises
    ------
    InputError
        Naming the function, when it raises, returns complex numbers or the wrong shape; for a domain that is closed in
        a direction in which the function does not come back to where it began; for one partial, or one or two second
        ones.

    Warns
    -----
    InputWarning
        Once for a function that takes one number at a time.

    Notes
    -----
    Degenerate: where the function is not finite the surface has a hole, NaN; a function that runs to infinity is cut
    off (see `limits_of`), and pictures of it say so.

    Source: Glaeser, section 8.2, equation 9.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> def moebius(u, v):
    ...     return (2 + v * np.cos(u / 2)) * np.cos(u), (2 + v * np.cos(u / 2)) * np.sin(u), v * np.sin(u / 2)
    >>> band = surfaces.surface_of_function(moebius, surfaces.Domain(0.0, 2.0 * np.pi, -0.5, 0.5))
    >>> by_u, by_v = band.partials(np.array(0.0), np.array(0.5))
    >>> by_v.tolist()
    [1.0, 0.0, 0.0]
    """
    if len(partials) not in (0, 2) or len(second_partials) not in (0, 3):
        raise InputError("give both partials and all three second partials, or none")
    ranges = ranges_of(domain)
    points = cut_off(numeric_function(function, 3, ranges))
    inside = None if points.limits is None else points.is_finite
    surface = FunctionSurface(
        domain,
        points,
        tuple(numeric_function(f, 3, ranges, inside=inside) for f in partials),
        tuple(numeric_function(f, 3, ranges, inside=inside) for f in second_partials),
    )
    _check_seams(surface)
    return surface


def _check_seams(surface: FunctionSurface) -> None:
    """The function is the same on both sides of a seam."""
    domain = surface.domain
    if not (domain.closed_u or domain.closed_v):
        return
    points = surface.points(*np.meshgrid(*domain.grid(LOOKS, LOOKS), indexing="ij"))
    if np.isnan(points).all():
        return
    extent = float(np.nanmax(np.nanmax(points, axis=(0, 1)) - np.nanmin(points, axis=(0, 1))))
    for name, closed, along in (("u", domain.closed_u, points), ("v", domain.closed_v, points.swapaxes(0, 1))):
        apart = np.linalg.norm(along[-1] - along[0], axis=1)
        if closed and (apart > GAP_OF_EXTENT * extent).any():
            gap = float(np.nanmax(apart))
            raise InputError(f"a domain closed in {name}, but the surface ends up to {gap:.3g} from where it began")
