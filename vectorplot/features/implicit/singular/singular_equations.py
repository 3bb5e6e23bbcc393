"""What holds on the lines along which the gradient of F vanishes: equations of rank two, with Newton's method for them.

Where two sheets cross, the second derivatives H of F have rank two, and the gradient alone leads there. Along a
cuspidal edge H has rank one, and the gradient vanishes twice over: there H says how fast. The sum of the principal
minors of H, which is the product of its two larger eigenvalues, vanishes there once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.polygonize import checked_values
from vectorplot.geometry.algebra import singular_decomposition, symmetric_eigen
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances.of_extent import SECOND_DIFFERENCE_IN_SPACE, SETTLED_ON_LINE
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import RANK_OF_BENDING, SHALLOW_CROSSING, VANISHED_ON_LINE

ROUNDS = 10
"""Steps of Newton's method onto a singular line."""

PATIENCE, HALF = 3, 0.5
"""After so many steps each must be shorter than this part of the one before: otherwise there is nothing to be found."""


class SingularEquations(Protocol):
    """Equations of the singular lines of one kind, of a surface that is about extent large."""

    @property
    def surface(self) -> ImplicitSurface:
        """The surface."""
        ...

    @property
    def extent(self) -> float:
        """How large it is."""
        ...

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,r) what is zero on the lines, as lengths, at points (n,3); and (n,r,3) the slopes."""
        ...

    def real(self, points: Floats) -> Bools:
        """(n,) whether sheets end or cross at singular points, as those of this kind do."""
        ...


@dataclass(frozen=True, eq=False)
class DoubleLines:
    """Lines in which two sheets of a surface cross: its gradient vanishes, and H has eigenvalues of both signs across.

    Where both are of one sign the line is no part of a sheet (the handle of Whitney's umbrella).
    """

    surface: ImplicitSurface
    extent: float

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,3) and (n,3,3): as for SingularEquations."""
        return _gradient_rows(self.surface, points)

    def real(self, points: Floats) -> Bools:
        """(n,) where the sheets that cross are real ones."""
        with np.errstate(all="ignore"):
            return np.asarray(_flatness(hessians(self.surface, points)) < -SHALLOW_CROSSING, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class CuspidalEdges:
    """Lines at which a surface turns back: its gradient vanishes, and of the second derivatives all but one.

    Source: Arnold, Gusein-Zade and Varchenko, Singularities of differentiable maps (1985), on fronts.
    """

    surface: ImplicitSurface
    extent: float

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,4) and (n,4,3): as for SingularEquations."""
        away, slopes = _gradient_rows(self.surface, points)
        flat, along = self.flatness(points)
        return (
            np.concatenate([away, flat[:, None] * self.extent], axis=1),
            np.concatenate([slopes, along[:, None] * self.extent], axis=1),
        )

    def real(self, points: Floats) -> Bools:
        """(n,) everywhere: in any section across the edge F is that of a cusp."""
        return np.ones(len(points), dtype=np.bool_)

    def flatness(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,) the ratio of the second largest eigenvalue of H to the largest, about, and (n,3) its gradient."""
        h = SECOND_DIFFERENCE_IN_SPACE * self.extent
        around = points + h * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])[:, None]
        with np.errstate(all="ignore"):
            own, *beside = _flatness(hessians(self.surface, around.reshape(-1, 3))).reshape(7, -1)
        ahead, behind = np.stack(beside[:3], axis=-1), np.stack(beside[3:], axis=-1)
        return own, (ahead - behind) / (2.0 * h)

    def turnings(self, points: Floats) -> Floats:
        """(n,3) into the sheets, from points on the edge: both wings go that way.

        Across the edge F is a z^2 + b y^3, and its sheets lie where the signs of both terms differ.
        """
        with np.errstate(all="ignore"):
            values, vectors = symmetric_eigen(np.nan_to_num(hessians(self.surface, points)))
            steepest = np.abs(values).argmax(axis=1)
            normal = np.take_along_axis(vectors, steepest[:, None, None], axis=2)[..., 0]
            # Its sign is that of b / a, whatever that of a is.
            along = self.flatness(points)[1]
        along = along - (along * normal).sum(axis=1, keepdims=True) * normal
        return np.asarray(np.nan_to_num(-along))


def onto_lines(
    equations: SingularEquations, points: Floats, reach: Floats, across: Floats | None = None
) -> tuple[Floats, Bools]:
    """Points (n,3) led onto singular lines, not further than reach (n,), and which of them got there.

    across (n,3): unit normals of the planes that points stay in; without them they take the shortest way.
    """
    x, settled = points.copy(), np.zeros(len(points), dtype=np.bool_)
    digits = 16.0 * np.spacing(np.abs(points).max(axis=1, initial=0.0)) + SETTLED_ON_LINE * equations.extent
    active: Ints = np.arange(len(points))
    before = np.full(len(points), np.inf)
    for again in range(ROUNDS):
        if not len(active):
            break
        away, slopes = equations.rows(x[active])
        if across is not None:
            level = (across[active] * (x - points)[active]).sum(axis=1)
            away = np.concatenate([away, level[:, None]], axis=1)
            slopes = np.concatenate([slopes, across[active][:, None]], axis=1)
        step = _least_step(away, slopes, 2 if across is None else 3)
        length = np.linalg.norm(step, axis=1)
        with np.errstate(over="ignore"):
            step *= np.minimum(1.0, reach[active] / np.maximum(length, LEAST_DIVISOR))[:, None]
        usable = np.isfinite(length)
        x[active[usable]] += step[usable]
        settled[active] = usable & (length <= digits[active])
        # Once it is near, every step is shorter by far than the one before.
        comes_near = (again < PATIENCE) | (length < HALF * before[active])
        before[active] = length
        active = active[usable & comes_near & ~settled[active]]
    near = np.linalg.norm(x - points, axis=1) <= reach
    found = np.flatnonzero(settled & near)
    settled[:] = False
    settled[found] = _vanishes(equations, x[found]) & equations.real(x[found])
    return np.where(settled[:, None], x, points), settled


def line_tangents(equations: SingularEquations, points: Floats) -> Floats:
    """(n,3) unit tangents, of either sense, of the lines at points on them."""
    slopes = np.nan_to_num(equations.rows(points)[1])
    return np.asarray(singular_decomposition(slopes)[2][:, 2])


def _least_step(away: Floats, slopes: Floats, rank: int) -> Floats:
    """(n,3) Newton's steps of least length for equations (n,r) with slopes (n,r,3) of a rank."""
    known: Bools = np.asarray(np.isfinite(away).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2)))
    left, sizes, right = singular_decomposition(np.where(known[:, None, None], slopes, 0.0))
    sizes = np.where(sizes > RANK_OF_BENDING * sizes[:, :1], sizes, np.inf)
    sizes[:, rank:] = np.inf
    with np.errstate(all="ignore"):
        parts = np.einsum("nrk,nr->nk", left, np.where(known[:, None], away, 0.0)) / sizes
    step = -np.einsum("nk,nkc->nc", parts, right)
    return np.where(known[:, None], step, np.nan)


def _vanishes(equations: SingularEquations, points: Floats) -> Bools:
    """(n,) whether F and all that the equations speak of vanish indeed, measured by second derivatives."""
    surface, extent = equations.surface, equations.extent
    with np.errstate(all="ignore"):
        away = np.linalg.norm(equations.rows(points)[0], axis=1)
        bend = np.linalg.norm(hessians(surface, points), axis=(1, 2))
        on = np.abs(checked_values(surface, points)) <= VANISHED_ON_LINE * extent**2 * bend
    return np.asarray((away <= VANISHED_ON_LINE * extent) & on & (bend > 0.0), dtype=np.bool_)


def _gradient_rows(surface: ImplicitSurface, points: Floats) -> tuple[Floats, Floats]:
    """(n,3) the gradient and (n,3,3) its slopes, both by the size of the second derivatives."""
    with np.errstate(all="ignore"):
        bend = hessians(surface, points)
        size = np.linalg.norm(bend, axis=(1, 2))[:, None]
        return np.asarray(surface.gradients(points) / size), np.asarray(bend / size[..., None])


def _flatness(bend: Floats) -> Floats:
    """(n,) the sums of the principal minors of matrices (n,3,3), by the squares of their sizes."""
    minors = [bend[:, i, i] * bend[:, j, j] - bend[:, i, j] * bend[:, j, i] for i, j in ((0, 1), (1, 2), (2, 0))]
    return np.asarray(sum(minors) / (bend * bend).sum(axis=(1, 2)))
