"""Surfaces of functions that users write."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, cut_off, numeric_function
from vectorplot.errors import InputError
from vectorplot.surfaces.placed_surface import MovableSurface, PlacedSurface
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets, Surface
from vectorplot.tolerances import GAP_OF_EXTENT, WRONG_DERIVATIVE

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

    domain: where it is defined; function: the points; first: the derivatives by u and by v, or empty: they are found
    from the points; second: the second derivatives by uu, uv and vv, or empty; jets: points and first derivatives at
    once, and these with the second derivatives.
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
    Edge cases: where the function is not finite the surface has a hole, NaN; a function that runs to infinity is cut
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


def completed(surface: Surface, name: str) -> Surface:
    """A surface of a user's own class, with the derivatives that it lacks, see surface_of_function.

    Errors: InputError, with the name, for members that are missing or of a wrong shape, and for derivatives that are
    not those of its points.
    """
    if not isinstance(surface.domain, Domain) or not callable(getattr(surface, "points", None)):
        raise InputError(f"{name}: a surface needs a domain (surfaces.Domain) and a method points(u, v)")
    u, v = (start + size * _SAMPLES for start, size in zip(_starts(surface.domain), surface.domain.size, strict=True))
    u, v = (some.ravel() for some in np.meshgrid(u, v))
    _check_shapes(name, "points", (surface.points(u, v),), 1, len(u))
    counts = {"partials": 2, "second_partials": 3}
    given = {what: getattr(surface, what, None) for what in counts}
    for what, member in given.items():
        if member is not None:
            _check_shapes(name, what, member(u, v), counts[what], len(u))
    own = {
        what: [(lambda u, v, member=member, k=k: member(u, v)[k]) for k in range(counts[what])]
        for what, member in given.items()
        if member is not None
    }
    by_points = surface_of_function(surface.points, surface.domain)
    if "partials" in own:
        _check_derivatives(name, "partials", surface.partials(u, v), by_points.partials(u, v), u, v)
    if "second_partials" in own:
        expected = surface_of_function(surface.points, surface.domain, partials=own.get("partials", ()))
        _check_derivatives(name, "second_partials", surface.second_partials(u, v), expected.second_partials(u, v), u, v)
    return surface if len(own) == 2 else surface_of_function(surface.points, surface.domain, **own)


def with_derivatives(surface: Surface) -> Surface:
    """The surface itself if it has partials and second partials; else, of a user's class, one that finds them;
    placed where the surface was.

    Errors: InputError as in completed.
    """
    if isinstance(surface, PlacedSurface):
        whole = with_derivatives(surface.surface)
        return surface if whole is surface.surface else replace(surface, surface=whole)
    if hasattr(surface, "partials") and hasattr(surface, "second_partials"):
        return surface
    return completed(surface, type(surface).__name__)


_SAMPLES = np.array([0.17, 0.41, 0.58, 0.83])
"""Where between the ends of the ranges derivatives are compared."""


def _starts(domain: Domain) -> tuple[float, float]:
    return domain.u_start, domain.v_start


def _check_shapes(name: str, what: str, values: Any, count: int, points: int) -> None:
    shapes = [np.shape(value) for value in values] if isinstance(values, tuple | list) else [np.shape(values)]
    if shapes != [(points, 3)] * count:
        many = "" if count == 1 else f"{count} arrays of "
        raise InputError(f"{name}: {what}(u, v) must return {many}shape (n, 3) for u and v of shape (n,)")


def _check_derivatives(
    name: str, what: str, given: Sequence[Floats], expected: Sequence[Floats], u: Floats, v: Floats
) -> None:
    for k, (own, found) in enumerate(zip(given, expected, strict=True)):
        off = np.abs(own - found).max(axis=1)
        largest = max(float(np.nanmax(np.abs(found), initial=0.0)), float(np.nanmax(np.abs(own), initial=0.0)))
        wrong = off > WRONG_DERIVATIVE * largest
        if 2 * wrong.sum() > len(wrong):
            at = int(np.argmax(wrong))
            raise InputError(
                f"{name}: {what}(u, v)[{k}] is not the derivative of points: "
                f"{np.round(own[at], 6).tolist()} in place of {np.round(found[at], 6).tolist()} "
                f"at u = {u[at]:g}, v = {v[at]:g}"
            )
