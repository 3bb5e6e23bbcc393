"""Surfaces moved to where they are wanted: turned, mirrored, scaled, shifted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.placed_curves import Placed, PlacedCurve, rows_and_shift
from vectorplot.geometry.algebra import inverse_matrix, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import Movable
from vectorplot.surfaces.surface import (
    Domain,
    FirstJets,
    ImplicitSurface,
    SecondJets,
    Surface,
    first_jets,
    hessians,
    is_implicit,
    is_parametrised,
    second_jets,
)


class MovableSurface(Movable["PlacedSurface"]):
    """A parametrised surface that can be moved: it becomes a placed one."""

    def transformed(self, matrix: ArrayLike) -> PlacedSurface:
        """The surface under a matrix (4,4) that acts on columns."""
        surface: Any = self
        return PlacedSurface(surface, *rows_and_shift(matrix))


class MovableImplicit(Movable["PlacedImplicit"]):
    """An implicit surface that can be moved: it becomes a placed one."""

    def transformed(self, matrix: ArrayLike) -> PlacedImplicit:
        """The surface under a matrix (4,4) that acts on columns."""
        surface: Any = self
        return PlacedImplicit(surface, *rows_and_shift(matrix))


@dataclass(frozen=True, eq=False)
class PlacedSurface(Placed, MovableSurface):
    """A surface moved to where it is wanted: its points x at x @ matrix + shift.

    Parameters
    ----------
    surface : Surface
        What is placed.
    matrix : (3, 3) array_like of float
        Turns, mirrors and scales, such as the rotations of the room geometry.
    shift : (3,) array_like of float
        What is added, in world units.

    Raises
    ------
    InputError
        For a matrix that cannot be inverted, a shift that is not three numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> egg = surfaces.PlacedSurface(surfaces.Sphere(), np.diag([1.0, 1.0, 1.5]), (0, 0, 4))
    >>> bool(np.allclose(egg.points(np.array(0.0), np.array(np.pi / 2)), (0.0, 0.0, 5.5)))
    True
    """

    surface: Surface
    matrix: ArrayLike
    shift: ArrayLike = (0.0, 0.0, 0.0)

    @cached_property
    def domain(self) -> Domain:
        """That of the surface."""
        return self.surface.domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.placed_points(self.surface.points(u, v))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        a, b = self.surface.partials(u, v)
        return self.placed_vectors(a), self.placed_vectors(b)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        uu, uv, vv = self.surface.second_partials(u, v)
        return self.placed_vectors(uu), self.placed_vectors(uv), self.placed_vectors(vv)

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once."""
        points, a, b = first_jets(self.surface, u, v)
        return self.placed_points(points), self.placed_vectors(a), self.placed_vectors(b)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once."""
        points, a, b, uu, uv, vv = second_jets(self.surface, u, v)
        turned = self.placed_vectors
        return self.placed_points(points), turned(a), turned(b), turned(uu), turned(uv), turned(vv)


@runtime_checkable
class Centred(Protocol):
    """A surface that says itself where it stands."""

    @property
    def place(self) -> Floats:
        """(3,) its centre."""
        ...

    def about_origin(self) -> Surface:
        """The same surface with its centre in the origin."""
        ...


def placed_once(surface: Surface, matrix: ArrayLike, shift: ArrayLike, origin: ArrayLike) -> PlacedSurface:
    """The surface with its points x at (x - origin) @ matrix + shift, in a single placement.

    Placements in placements, and the centres of surfaces, are put together: so a surface far from the world's origin,
    near which the place looked at lies, keeps all digits of its shape.
    """
    own, away = np.eye(3), np.zeros(3)
    while True:
        if isinstance(surface, PlacedSurface):
            # The last placement of these stands outermost: points go through the inner ones first.
            inner, inner_shift = np.asarray(surface.matrix), np.asarray(surface.shift)
            away, own, surface = matmul(inner_shift, own) + away, matmul(inner, own), surface.surface
        elif isinstance(surface, Centred):
            away, surface = matmul(surface.place, own) + away, surface.about_origin()
            break
        else:
            break
    m = np.asarray(matrix)
    return PlacedSurface(surface, matmul(own, m), matmul(away - np.asarray(origin), m) + np.asarray(shift))


@dataclass(frozen=True, eq=False)
class PlacedImplicit(Placed, MovableImplicit):
    """An implicit surface moved to where it is wanted: its points x at x @ matrix + shift.

    surface: what is placed; matrix: (3, 3) turns, mirrors and scales, such as the rotations of the room geometry;
    shift: (3,) what is added, in world units.
    """

    surface: ImplicitSurface
    matrix: ArrayLike
    shift: ArrayLike = (0.0, 0.0, 0.0)

    @property
    def box(self) -> Floats:
        """(2,3) the box around the eight moved corners."""
        corners = np.array([[box[i] for box, i in zip(self.surface.box.T, pick, strict=True)] for pick in _PICKS])
        moved = self.placed_points(corners)
        return np.stack([moved.min(axis=0), moved.max(axis=0)])

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        return self.surface.values(self._home(points))

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        return np.asarray(matmul(self.surface.gradients(self._home(points)), self._inverse.T))

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        return np.asarray(matmul(matmul(self._inverse, hessians(self.surface, self._home(points))), self._inverse.T))

    @cached_property
    def _inverse(self) -> Floats:
        return inverse_matrix(np.asarray(self.matrix))

    def _home(self, points: Floats) -> Floats:
        return np.asarray(matmul(points - np.asarray(self.shift), self._inverse))


_PICKS = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]


def placed_shape(shape: Any, matrix: ArrayLike) -> Mesh | Surface | ImplicitSurface | Curve:
    """A mesh, surface or curve, of this package or of a user, under a matrix (4,4) that acts on columns."""
    if isinstance(shape, Movable):
        moved: Mesh | Surface | ImplicitSurface | Curve = shape.transformed(matrix)
        return moved
    if is_curve(shape):
        return PlacedCurve(shape, *rows_and_shift(matrix))
    if is_parametrised(shape):
        return PlacedSurface(shape, *rows_and_shift(matrix))
    assert is_implicit(shape)
    return PlacedImplicit(shape, *rows_and_shift(matrix))
