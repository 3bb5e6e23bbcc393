"""Pinch points of surfaces, and the condition of a contour that goes through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import Contour, Isophote, Slopes
from vectorplot.features.holes import clipped, wrapped
from vectorplot.geometry.vectors import all_finite, cross, dot, from_components
from vectorplot.geometry.weld import close_points
from vectorplot.surfaces.surface import Domain, Surface, normals, second_jets
from vectorplot.surfaces.trimmed import is_embedded
from vectorplot.tolerances import PINCH_SETTLED, RANK_OF_PINCH, SINGULAR_PRODUCT

COLUMNS, ROWS = 47, 45
"""Cells of the grid on which pinch points are looked for, along u and along v."""

REACH = 3.0
"""Cells from a least normal within which a pinch point is looked for."""

ROUNDS = 12
"""Steps of the search for one."""

AROUND = 0.05
"""Part of the domain around a pinch point in which normals are divided by more than their lengths."""


@dataclass(frozen=True, eq=False)
class PinchPoints:
    """Single points of a surface at which x_u x x_v vanishes, and turns as one goes round: at (k,2) their parameters,
    turning (k,) squares of how much the product grows over the domain."""

    at: Floats
    turning: Floats

    def __len__(self) -> int:
        return len(self.at)


def pinch_points(surface: Surface) -> PinchPoints:
    """The pinch points of a surface, found by Gauss and Newton's method from the shortest normals on a grid.

    Edge cases: points of cuspidal edges, and poles, are none: there the product keeps its direction.
    """
    none = PinchPoints(np.zeros((0, 2)), np.zeros(0))
    if is_embedded(surface):
        return none
    domain = surface.domain
    start, size, cell = _start(domain), np.array(domain.size), np.array((COLUMNS, ROWS))
    places = np.stack(np.meshgrid(*domain.grid(COLUMNS, ROWS), indexing="ij"), axis=-1)
    products = normals(surface, places[..., 0], places[..., 1])
    squares = dot(products, products)
    begin = places[_least(squares, domain)]
    at, settled = begin.copy(), np.zeros(len(begin), dtype=np.bool_)
    found = _Products.at(surface, at)
    for _ in range(ROUNDS if len(at) else 0):
        step = found.step()
        at = np.where(all_finite(step)[:, None], clipped(domain, at + np.nan_to_num(step) * size), at)
        settled = np.abs(step).max(axis=1) <= PINCH_SETTLED
        found = _Products.at(surface, at)
        if settled.all():
            break
    usual = float(np.nanquantile(squares, 0.95)) if np.isfinite(squares).any() else 0.0
    near = np.abs((at - begin) / size * cell).max(axis=1, initial=0.0) <= REACH
    kept = near & settled & found.of_full_rank() & (found.square <= SINGULAR_PRODUCT**2 * usual)
    if not kept.any():
        return none
    at = np.stack(wrapped(domain, *at[kept].T), axis=1)
    once = np.unique(close_points(from_components(*((at - start) / size).T, 0.0), AROUND / COLUMNS), return_index=True)[
        1
    ]
    return PinchPoints(at[once], found.trace[kept][once])


def _start(domain: Domain) -> Floats:
    return np.array((domain.u_start, domain.v_start))


def _least(values: Floats, domain: Domain) -> Bools:
    """(m,n) the values on a grid that are the least of those around them."""
    around = np.pad(np.where(np.isfinite(values), values, np.inf), 1, constant_values=np.inf)
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        ends = np.moveaxis(around, axis, 0)
        if closed:
            # The last point is the first again.
            ends[0], ends[-1] = ends[-3].copy(), ends[2].copy()
    m, n = values.shape
    shifted = [around[a : a + m, b : b + n] for a in range(3) for b in range(3)]
    return np.asarray((values <= np.minimum.reduce(shifted)) & np.isfinite(values))


@dataclass(frozen=True, eq=False)
class _Products:
    """x_u x x_v and its derivatives at some places, by parameters of which the domain spans one."""

    product: Floats
    by_u: Floats
    by_v: Floats

    @classmethod
    def at(cls, surface: Surface, at: Floats) -> _Products:
        """Those at places (k,2)."""
        product, by_u, by_v = _turning(surface, *wrapped(surface.domain, *at.T))[1:]
        width, height = surface.domain.size
        return cls(product, width * by_u, height * by_v)

    @property
    def square(self) -> Floats:
        """(k,) the squared lengths of the products."""
        return dot(self.product, self.product)

    @property
    def trace(self) -> Floats:
        """(k,) the squared lengths of both derivatives."""
        return np.asarray(dot(self.by_u, self.by_u) + dot(self.by_v, self.by_v))

    @property
    def determinant(self) -> Floats:
        """(k,) the squared area between them."""
        area = cross(self.by_u, self.by_v)
        return dot(area, area)

    def of_full_rank(self) -> Bools:
        """(k,) whether the product turns round."""
        return np.asarray(self.determinant > (RANK_OF_PINCH * self.trace) ** 2)

    def step(self) -> Floats:
        """(k,2) the step to where the product would be least if it were linear."""
        p, q = dot(self.by_u, self.product), dot(self.by_v, self.product)
        e, f, g = dot(self.by_u, self.by_u), dot(self.by_u, self.by_v), dot(self.by_v, self.by_v)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.stack([f * q - g * p, f * p - e * q], axis=1) / self.determinant[:, None]


def through_pinch_points(contour: Contour) -> Contour | ThroughPinchPoints:
    """The condition of a contour as it is followed: smooth at the pinch points of its surface, if that has any."""
    pinches = pinch_points(contour.surface)
    return ThroughPinchPoints(contour, pinches) if len(pinches) else contour


def _turning(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """(..., 3) points, x_u x x_v, and its derivatives by u and by v."""
    points, along_u, along_v, uu, uv, vv = second_jets(surface, u, v)
    return (
        points,
        cross(along_u, along_v),
        cross(uu, along_v) + cross(along_u, uv),
        cross(uv, along_v) + cross(along_u, vv),
    )


@dataclass(frozen=True, eq=False)
class ThroughPinchPoints:
    """The condition of a contour, its unit normals replaced by n / sqrt(|n|^2 + e^2), n = x_u x x_v, where e vanishes
    away from pinch points.

    Its zeros are those of the contour, but it is smooth at pinch points, where the unit normal has no limit.
    """

    contour: Contour
    pinches: PinchPoints

    def on(self, surface: Surface, which: Ints) -> ThroughPinchPoints:
        """The same: other surfaces have other pinch points."""
        return self

    @property
    def surface(self) -> Surface:
        """The surface."""
        return self.contour.surface

    def values(self, u: Floats, v: Floats) -> Floats:
        """(k,) f."""
        values = self.contour.values(u, v)
        near = self._near(u, v)
        if near.any():
            values[near] = self._jets(u[near], v[near])[0]
        return values

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(k,) derivatives by u and by v."""
        return self.values_and_slopes(u, v)[1]

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        values, (by_u, by_v) = self.contour.values_and_slopes(u, v)
        near = self._near(u, v)
        if near.any():
            values, by_u, by_v = np.array(values), np.array(by_u), np.array(by_v)
            values[near], by_u[near], by_v[near] = self._jets(u[near], v[near])
        return values, (by_u, by_v)

    def _arms(self, u: Floats, v: Floats) -> Floats:
        """(p,k,2) ways from the pinch points, in parts of AROUND."""
        domain = self.surface.domain
        way = (np.stack([u, v], axis=-1) - self.pinches.at[:, None]) / domain.size
        way -= np.where((domain.closed_u, domain.closed_v), np.round(way), 0.0)
        return np.asarray(way / AROUND)

    def _near(self, u: Floats, v: Floats) -> Bools:
        arms = self._arms(u, v)
        return np.asarray((dot(arms, arms) < 1.0).any(axis=0))

    def _jets(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) f and its derivatives by u and by v, next to pinch points."""
        points, product, by_u, by_v = _turning(self.surface, u, v)
        contour = self.contour
        if isinstance(contour, Isophote):
            sight = np.broadcast_to(np.asarray(contour.light), points.shape)
        else:
            sight = points - np.asarray(contour.eye)
        arms, width = self._arms(u, v), np.array(self.surface.domain.size)
        rest = 1.0 - dot(arms, arms)
        own = np.argmax(rest * self.pinches.turning[:, None], axis=0)
        each = np.arange(len(own))
        rest, arm = np.maximum(rest[own, each], 0.0), arms[own, each]
        size = AROUND**2 * self.pinches.turning[own]
        square = dot(product, product) + size * rest * rest
        inverse = 1.0 / np.sqrt(square)
        value = dot(product, sight) * inverse
        slopes = [
            (dot(turned, sight) - value * inverse * (dot(product, turned) + part)) * inverse
            for turned, part in zip(
                (by_u, by_v), (-2.0 * size * rest * arm.T).reshape(2, -1) / (AROUND * width[:, None]), strict=True
            )
        ]
        value[~all_finite(points)] = np.nan
        return value, slopes[0], slopes[1]
