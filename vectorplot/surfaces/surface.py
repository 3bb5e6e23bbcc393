"""The interfaces of parametrised and of implicit surfaces: domains, holes, normals, derivatives, other domains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, TypeGuard, runtime_checkable

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.derivatives import Range, numeric_function
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import cross

# What every surface can do, and where it is defined.


@dataclass(frozen=True)
class Domain:
    """A rectangle of parameters: u_start <= u <= u_end, v_start <= v <= v_end.

    Parameters
    ----------
    u_start, u_end, v_start, v_end : float
        The ranges, in whatever unit the surface counts its parameters (angles in radians).
    closed_u, closed_v : bool
        The surface closes smoothly in that direction: the two borders are one line and no border of the surface.

    Raises
    ------
    InputError
        Unless the ranges are finite and not empty.

    Examples
    --------
    >>> from vectorplot.surfaces import Domain
    >>> domain = Domain(0, 4, -1, 1, closed_u=True)
    >>> domain.size
    (4, 2)
    >>> u, v = domain.grid(4, 2)
    >>> u.tolist(), v.tolist()
    ([0.0, 1.0, 2.0, 3.0, 4.0], [-1.0, 0.0, 1.0])
    """

    u_start: float
    u_end: float
    v_start: float
    v_end: float
    closed_u: bool = False
    closed_v: bool = False

    def __post_init__(self) -> None:
        ranges = (self.u_start, self.u_end, self.v_start, self.v_end)
        if not all(np.isfinite(ranges)) or not self.u_start < self.u_end or not self.v_start < self.v_end:
            raise InputError(
                f"parameters from {ranges[0]:g} to {ranges[1]:g} and {ranges[2]:g} to {ranges[3]:g}: no domain"
            )

    @property
    def transposed(self) -> Domain:
        """The domain with u and v in place of each other."""
        return Domain(self.v_start, self.v_end, self.u_start, self.u_end, self.closed_v, self.closed_u)

    @property
    def size(self) -> tuple[float, float]:
        """Lengths of the ranges of u and v."""
        return self.u_end - self.u_start, self.v_end - self.v_start

    def grid(self, columns: int, rows: int) -> tuple[Floats, Floats]:
        """Parameters u (columns+1,) and v (rows+1,) that divide the ranges evenly, both ends included."""
        return np.linspace(self.u_start, self.u_end, columns + 1), np.linspace(self.v_start, self.v_end, rows + 1)


class Surface(Protocol):
    """What every parametrised surface x(u, v) can do.

    A protocol: whatever has these members is a surface, of this package or of a user. domain says where it is defined;
    points(u, v) are (..., 3) in world units, NaN where the surface has a hole; partials are the two derivatives by u
    and by v, second_partials the three by u twice, by u and v, by v twice, (..., 3) each. All functions take arrays u,
    v of one shape (...) and are vectorised. The normal is x_u cross x_v.
    """

    @property
    def domain(self) -> Domain:
        """Where the surface is defined; within it points may still be NaN: holes."""
        ...

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points; NaN where the surface has a hole."""
        ...

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        ...

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        ...


class ImplicitSurface(Protocol):
    """What every surface F(x, y, z) = 0 within a box can do.

    A protocol: whatever has these members is an implicit surface, of this package or of a user. box is (2, 3), the
    smallest and the largest coordinates of the part that is looked at, in world units; values(points) is F (...) at
    points (..., 3), whose sign tells the sides; gradients(points) are (..., 3).
    """

    @property
    def box(self) -> Floats:
        """(2,3) smallest and largest coordinates of the part that is looked at."""
        ...

    def values(self, points: Floats) -> Floats:
        """(...,) F at points (..., 3); its sign tells the sides."""
        ...

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of F."""
        ...


def normals(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(..., 3) cross products of the partials, not normalised; zero at poles and singular points."""
    along_u, along_v = surface.partials(u, v)
    return cross(along_u, along_v)


def is_hole(points: Floats) -> Bools:
    """(...,) where points (..., 3) are not finite."""
    finite = np.isfinite(points)
    return np.asarray(~(finite[..., 0] & finite[..., 1] & finite[..., 2]), dtype=np.bool_)


def is_parametrised(shape: object) -> TypeGuard[Surface]:
    """Whether a shape is a parametrised surface: it has a domain."""
    return hasattr(shape, "domain")


def is_implicit(shape: object) -> TypeGuard[ImplicitSurface]:
    """Whether a shape is an implicit surface: it has a box and gradients, and no domain."""
    return hasattr(shape, "box") and hasattr(shape, "gradients") and not hasattr(shape, "domain")


@runtime_checkable
class BendingImplicit(Protocol):
    """An implicit surface that knows its second derivatives; most of this package do."""

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives of F."""
        ...


def hessians(surface: ImplicitSurface, points: Floats) -> Floats:
    """(..., 3, 3) second derivatives of F at points (..., 3).

    Error: those a surface gives itself are as good as it says; else differences of its gradients, about 1e-12.
    """
    if isinstance(surface, BendingImplicit):
        return surface.hessians(points)

    def gradient(x: Floats, y: Floats, z: Floats) -> Floats:
        return surface.gradients(np.stack([x, y, z], axis=-1))

    ranges = [Range(float(low), float(high)) for low, high in np.asarray(surface.box).T]
    slopes = numeric_function(gradient, 3, ranges)
    rows = np.stack(slopes.gradient(*np.moveaxis(np.asarray(points, dtype=np.float64), -1, 0)), axis=-2)
    return np.asarray(0.5 * (rows + np.swapaxes(rows, -1, -2)))


# Points and derivatives of a surface at once: what they have in common, sines say, is computed a single time.

FirstJets = tuple[Floats, Floats, Floats]
"""Points (..., 3), and their derivatives by u and by v."""

SecondJets = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
"""These, and the second derivatives: by u twice, by u and v, by v twice."""


class WithJets(Protocol):
    """A surface that tells its points and derivatives at once; to the last bit what it says when asked for each."""

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v."""
        ...

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these, and the second derivatives: by u twice, by u and v, by v twice."""
        ...


def tells_jets(surface: Surface) -> TypeGuard[WithJets]:
    """Whether a surface tells its points and derivatives at once.

    isinstance, which looks through all members of the protocol, takes as long as evaluating a few points.
    """
    return hasattr(surface, "first_jets") and hasattr(surface, "second_jets")


def first_jets(surface: Surface, u: Floats, v: Floats) -> FirstJets:
    """(..., 3) points of any surface and derivatives by u and by v, asked for one after the other where it does not
    tell them at once."""
    if tells_jets(surface):
        return surface.first_jets(u, v)
    return surface.points(u, v), *surface.partials(u, v)


def second_jets(surface: Surface, u: Floats, v: Floats) -> SecondJets:
    """(..., 3) these, and the second derivatives: by u twice, by u and v, by v twice."""
    if tells_jets(surface):
        return surface.second_jets(u, v)
    return surface.points(u, v), *surface.partials(u, v), *surface.second_partials(u, v)


# Surfaces over other domains than their own, which close otherwise.


@dataclass(frozen=True, eq=False)
class OverDomain:
    """The points of a surface over a part of its domain, or over one that does not close where its own does."""

    surface: Surface
    domain: Domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.surface.points(u, v)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self.surface.partials(u, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return self.surface.second_partials(u, v)


@dataclass(frozen=True, eq=False)
class Transposed:
    """A surface with u in place of v over a domain; embedded: whether it meets itself nowhere, as faces of bodies."""

    surface: Surface
    domain: Domain
    embedded: bool = False

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.surface.points(v, u)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        by_v, by_u = self.surface.partials(v, u)
        return by_u, by_v

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        vv, uv, uu = self.surface.second_partials(v, u)
        return uu, uv, vv

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v."""
        points, by_v, by_u = first_jets(self.surface, v, u)
        return points, by_u, by_v

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these, and the second derivatives: by u twice, by u and v, by v twice."""
        points, by_v, by_u, vv, uv, uu = second_jets(self.surface, v, u)
        return points, by_u, by_v, uu, uv, vv
