"""Many placed surfaces asked at once: every pair of parameters may be another surface's.

Numpy takes as long for one point as for a hundred; a scene of many surfaces asks each of them for a few points, again
and again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, TypeVar, cast

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import component_sum, cross, largest_component, norm
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets, Surface, first_jets, second_jets
from vectorplot.tolerances import ASIDE_OF_POLE, SINGULAR_PRODUCT, SUSPECT_PRODUCT

T = TypeVar("T")


def dimensions_of(surface: Surface) -> tuple[str, ...]:
    """The names of the fields of a surface on which its points depend, if it can be asked for many of its family at
    once: then it is a dataclass whose dimensions, numbers or vectors, may be columns with one value or row for each
    pair of parameters."""
    names: tuple[str, ...] = getattr(surface, "dimensions", ())
    return names


@dataclass(frozen=True, eq=False)
class DomainRows:
    """The domains (k,) of many surfaces that are closed in the same directions: like a Domain, with columns in place of
    numbers."""

    u_start: Floats
    u_end: Floats
    v_start: Floats
    v_end: Floats
    closed_u: bool
    closed_v: bool

    @property
    def size(self) -> tuple[Floats, Floats]:
        """(k,) lengths of the ranges of u and v."""
        return self.u_end - self.u_start, self.v_end - self.v_start


@dataclass(frozen=True, eq=False)
class StackedSurfaces:
    """Placed surfaces (s,), at least one, that are closed in the same directions."""

    surfaces: tuple[PlacedSurface, ...]

    @classmethod
    def of(cls, surfaces: Sequence[Surface]) -> StackedSurfaces:
        """Any surfaces, those that are not placed where they are."""
        return cls(tuple(s if isinstance(s, PlacedSurface) else PlacedSurface(s, np.eye(3)) for s in surfaces))

    def __len__(self) -> int:
        return len(self.surfaces)

    def take(self, rows: Ints) -> StackedSurfaces:
        """Some of them, by their rows (k,)."""
        return StackedSurfaces(tuple(self.surfaces[row] for row in rows.tolist()))

    def at(self, row: Ints) -> Surface:
        """What is asked for k pairs of parameters, each of the surface with the number row (k,); the surface itself if
        there is only one."""
        return self.surfaces[0] if len(self.surfaces) == 1 else SurfaceRows(self, row)

    def grid_lines(self, columns: int, rows: int) -> tuple[Floats, Floats]:
        """Parameters u (s, columns+1) and v (s, rows+1) that divide the domains evenly, both ends included; (1, ...) if
        the domains are one."""
        ends = self.ends if self.common_domain is None else self.ends[:, :1]
        u_start, u_end, v_start, v_end = ends
        return np.linspace(u_start, u_end, columns + 1, axis=1), np.linspace(v_start, v_end, rows + 1, axis=1)

    def points_of_all(self, u: Floats, v: Floats) -> Floats:
        """(s,p,3) points of each surface at parameters (s,p) of its own, or (1,p) that are the same for all: what these
        are turned into is then found once for a kind."""
        result = np.empty((len(self), u.shape[1], 3))
        for kind in self.kinds:
            own_u, own_v = (t if len(t) == 1 else t[kind.rows] for t in (u, v))
            at_home = kind.at(kind.rows[:, None]).points(own_u, own_v)
            result[kind.rows] = matmul(at_home, self.matrices[kind.rows]) + self.shifts[kind.rows, None]
        return result

    @cached_property
    def matrices(self) -> Floats:
        """(s,3,3) of the placements."""
        return np.array([surface.matrix for surface in self.surfaces], dtype=np.float64)

    @cached_property
    def shifts(self) -> Floats:
        """(s,3) of the placements."""
        return np.array([surface.shift for surface in self.surfaces], dtype=np.float64)

    @cached_property
    def ends(self) -> Floats:
        """(4,s) where u starts and ends, and v."""
        domains = [surface.domain for surface in self.surfaces]
        return np.array([(d.u_start, d.u_end, d.v_start, d.v_end) for d in domains]).T

    @cached_property
    def common_domain(self) -> Domain | None:
        """The domain of all of them, if it is one."""
        first = self.surfaces[0].domain
        return first if (self.ends == self.ends[:, :1]).all() else None

    @cached_property
    def kinds(self) -> tuple[_Kind, ...]:
        """Those that can be asked together."""
        members: dict[object, list[int]] = {}
        for number, surface in enumerate(self.surfaces):
            members.setdefault(_key(surface.surface), []).append(number)
        return tuple(_Kind.of([self.surfaces[k].surface for k in of], np.array(of)) for of in members.values())

    @cached_property
    def kind(self) -> Ints:
        """(s,) the kind of each."""
        result = np.zeros(len(self.surfaces), dtype=np.intp)
        for number, kind in enumerate(self.kinds):
            result[kind.rows] = number
        return result


@dataclass(frozen=True, eq=False)
class SurfaceRows:
    """Surfaces of a stack, one for each of k pairs of parameters: a surface that is asked for arrays (...,k) only."""

    stack: StackedSurfaces
    row: Ints

    def take(self, which: Ints | Bools) -> SurfaceRows:
        """Those of some of the pairs of parameters."""
        return replace(self, row=self.row[which])

    @cached_property
    def domain(self) -> Domain:
        """Columns in place of numbers, unless all have the same."""
        if self.stack.common_domain is not None:
            return self.stack.common_domain
        first = self.stack.surfaces[0].domain
        u_start, u_end, v_start, v_end = self.stack.ends[:, self.row]
        return cast(Domain, DomainRows(u_start, u_end, v_start, v_end, first.closed_u, first.closed_v))

    def points(self, u: Floats, v: Floats) -> Floats:
        """(...,k,3) points."""
        (points,) = self._turned(self._asked(lambda surface, u, v: (surface.points(u, v),), 1, u, v))
        return np.asarray(points + self._shifts)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(...,k,3) derivatives by u and by v."""
        by_u, by_v = self._turned(self._asked(lambda surface, u, v: surface.partials(u, v), 2, u, v))
        return by_u, by_v

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(...,k,3) second derivatives: by u twice, by u and v, by v twice."""
        uu, uv, vv = self._turned(self._asked(lambda surface, u, v: surface.second_partials(u, v), 3, u, v))
        return uu, uv, vv

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(...,k,3) points and derivatives by u and by v, at once."""
        points, by_u, by_v = self._turned(self._asked(first_jets, 3, u, v))
        return points + self._shifts, by_u, by_v

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(...,k,3) these and the second derivatives, at once."""
        points, by_u, by_v, uu, uv, vv = self._turned(self._asked(second_jets, 6, u, v))
        return points + self._shifts, by_u, by_v, uu, uv, vv

    def _turned(self, vectors: Sequence[Floats]) -> Floats:
        """(n,...,k,3) some vectors (...,k,3) as they are placed."""
        # Component by component: einsum takes twice as long for matrices that are small.
        x, y, z = (np.array([each[..., axis] for each in vectors]) for axis in range(3))
        result = np.empty((*x.shape, 3))
        for axis, (a, b, c) in enumerate(self._columns):
            own = x * a
            own += y * b
            own += z * c
            result[..., axis] = own
        return result

    @cached_property
    def _shifts(self) -> Floats:
        """(k,3) of the placements."""
        return self.stack.shifts.take(self.row, axis=0)

    @cached_property
    def _columns(self) -> Floats:
        """(3,3,k) the columns of the placements' matrices, each by its rows."""
        return self.stack.matrices.T.take(self.row, axis=2)

    def _asked(
        self, question: Callable[[Surface, Floats, Floats], Sequence[Floats]], answers: int, u: Floats, v: Floats
    ) -> Sequence[Floats]:
        """What the surfaces say before they are placed, so many arrays (...,k,3), each kind asked once."""
        kinds = self.stack.kinds
        if len(kinds) == 1:
            return question(kinds[0].at(self.row), u, v)
        result = [np.empty((*np.shape(u), 3)) for _ in range(answers)]
        of = self.stack.kind[self.row]
        order = np.argsort(of, kind="stable")
        for own in np.split(order, np.flatnonzero(np.diff(of[order])) + 1) if len(order) else ():
            found = question(kinds[of[own[0]]].at(self.row[own]), u[..., own], v[..., own])
            for whole, part in zip(result, found, strict=True):
                whole[..., own, :] = part
        return result


@dataclass(frozen=True, eq=False)
class ExactRows(SurfaceRows):
    """As SurfaceRows; to the last bit what every placed surface says alone."""

    def _turned(self, vectors: Sequence[Floats]) -> Floats:
        """(n,...,k,3) some vectors (...,k,3) as they are placed, each by a product of its own."""
        matrices = self.stack.matrices.take(self.row, axis=0)
        return np.asarray((matmul(np.array(vectors)[..., None, :], matrices))[..., 0, :])


def of_some(surface: Surface, which: Ints | Bools) -> Surface:
    """The surface of some of the pairs of parameters that it is asked for."""
    return surface.take(which) if isinstance(surface, SurfaceRows) else surface


@dataclass(frozen=True, eq=False)
class _Kind:
    """Surfaces that can be asked together: the first one, their rows (m,) in the stack, and for each field that is not
    the same in all of them the values, by rows of the stack."""

    one: Surface
    rows: Ints
    columns: dict[str, Floats]

    @classmethod
    def of(cls, surfaces: Sequence[Surface], rows: Ints) -> _Kind:
        """These surfaces, in these rows."""
        columns: dict[str, Floats] = {}
        for name in dimensions_of(surfaces[0]):
            values = [getattr(surface, name) for surface in surfaces]
            if values[0] is None or all(np.array_equal(value, values[0]) for value in values):
                continue
            own = np.asarray(values, dtype=np.float64)
            columns[name] = np.zeros((int(rows.max()) + 1, *own.shape[1:]))
            columns[name][rows] = own
        return cls(surfaces[0], rows, columns)

    def at(self, row: Ints) -> Surface:
        """The one surface, with the columns of rows (k,) of the stack."""
        if not self.columns:
            return self.one
        return _with_columns(self.one, {name: values[row] for name, values in self.columns.items()})


def _key(surface: Surface) -> object:
    """Equal for surfaces that can be asked together."""
    names = dimensions_of(surface)
    if not names:
        return id(surface)
    known = tuple(getattr(surface, name) is None for name in names)
    # What is no dimension is the same in all of them, or does not matter for points.
    return type(surface), known


def _with_columns(one: T, columns: dict[str, Floats]) -> T:
    """A copy of a dataclass with columns in place of numbers: its checks are about single ones."""
    copy: Any = object.__new__(type(one))
    for f in fields(cast(Any, one)):
        object.__setattr__(copy, f.name, columns.get(f.name, getattr(one, f.name)))
    return cast(T, copy)


# Unit normals and how they turn, at poles and singular points too.

Partials = tuple[Floats, Floats]
SecondPartials = tuple[Floats, Floats, Floats]


def unit_normals(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The unit normals of a surface, along x_u cross x_v; at poles their limits.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array_like of float
        Parameters; they are broadcast.

    Returns
    -------
    (..., 3) array of float
        Vectors of length 1.

    Notes
    -----
    Where the cross product vanishes the normal is the limit from the side of the middle of the domain: along the line v
    = const. at a pole where u does not move the point (top of a sphere), along u = const. where v does not; so that
    normals near the pole run into it without a spike. An apex has one limit for each line that ends there. Where a
    surface passes through its axis (spindle torus) the normals of the two sides are opposite, and that side decides. At
    a pole the normals are as good as the second partials; where the first derivative of the cross product vanishes too
    they are those a millionth of the domain inside.

    Edge cases: NaN in holes, and where the surface is a line or a point there.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> north = surfaces.unit_normals(surfaces.Sphere(2.0), 0.3, np.pi / 2)
    >>> bool(np.allclose(north, (0.0, 0.0, 1.0)))
    True
    """
    from vectorplot.surfaces.function_surface import with_derivatives

    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    return unit_normals_of(surface, u, v, with_derivatives(surface).partials(u, v))


def tangent_planes(surface: Surface, u: Floats, v: Floats) -> tuple[FirstJets, Floats]:
    """Points and derivatives by u and by v, and unit normals as in `unit_normals`, each (..., 3), at parameters u, v
    (...)."""
    points, along_u, along_v = first_jets(surface, u, v)
    return (points, along_u, along_v), unit_normals_of(surface, u, v, (along_u, along_v))


def points_and_normals(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Points, and unit normals as in `unit_normals`, each (..., 3)."""
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    (points, _, _), normals = tangent_planes(surface, u, v)
    return points, normals


def unit_normals_of(surface: Surface, u: Floats, v: Floats, partials: Partials) -> Floats:
    """(..., 3) the unit normals at parameters u, v (...), where the surface has these partials."""
    product = cross(*partials)
    suspect = _small(product, *partials, surface.domain)
    if suspect.any():
        known = (partials[0][suspect], partials[1][suspect])
        product[suspect] = _with_limits(of_some(surface, suspect), u[suspect], v[suspect], known, product[suspect])
    # Divided by the largest component first: a product of tiny partials has a square that underflows.
    with np.errstate(divide="ignore", invalid="ignore"):
        product /= largest_component(product)[..., None]
        return np.asarray(product / norm(product)[..., None])


def normal_partials(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """Unit normals and their derivatives by u and by v, each (..., 3): N = n / |n|, N_u = (n_u - (n_u.N) N) / |n|.

    n = x_u cross x_v, n_u = x_uu cross x_v + x_u cross x_uv. At a pole the derivatives are those a millionth of the
    domain inside.
    Edge cases: NaN in holes, and where the normals are NaN. Error: as good as the second partials.
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    return _normal_partials(surface, u, v, surface.partials(u, v), surface.second_partials(u, v))


def points_and_normal_partials(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, tuple[Floats, Floats, Floats]]:
    """Points (..., 3), and what `normal_partials` says there."""
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    points, along_u, along_v, *second = second_jets(surface, u, v)
    uu, uv, vv = second
    return points, _normal_partials(surface, u, v, (along_u, along_v), (uu, uv, vv))


def _normal_partials(
    surface: Surface, u: Floats, v: Floats, partials: Partials, second: SecondPartials
) -> tuple[Floats, Floats, Floats]:
    """As `normal_partials`, where the surface has these partials and second partials."""
    unit = unit_normals_of(surface, u, v, partials)
    by_u, by_v, vanished = _turning(surface.domain, partials, second, unit)
    if vanished.any():
        own = of_some(surface, vanished)
        domain, u, v = own.domain, u[vanished], v[vanished]
        inner_u = u + _inwards(u, domain.u_start, domain.u_end) * ASIDE_OF_POLE * domain.size[0]
        inner_v = v + _inwards(v, domain.v_start, domain.v_end) * ASIDE_OF_POLE * domain.size[1]
        inner = own.partials(inner_u, inner_v)
        inside = unit_normals_of(own, inner_u, inner_v, inner)
        bent = own.second_partials(inner_u, inner_v)
        by_u[vanished], by_v[vanished], _ = _turning(own.domain, inner, bent, inside)
    return unit, by_u, by_v


def _turning(domain: Domain, partials: Partials, second: SecondPartials, unit: Floats) -> tuple[Floats, Floats, Bools]:
    """Derivatives (..., 3) of the unit normals by u and by v, and (...,) where they are lost at a pole."""
    along_u, along_v = partials
    uu, uv, vv = second
    product = cross(along_u, along_v)
    vanished = norm(product) <= SINGULAR_PRODUCT * _bound(domain, partials, second)
    size = largest_component(product)[..., None]
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (norm(product / size)[..., None] * size)
        turned = [
            np.asarray((d - component_sum(d * unit)[..., None] * unit) * inverse)
            for d in (cross(uu, along_v) + cross(along_u, uv), cross(uv, along_v) + cross(along_u, vv))
        ]
    return turned[0], turned[1], np.asarray(vanished, dtype=np.bool_)


def _small(product: Floats, along_u: Floats, along_v: Floats, domain: Domain) -> Bools:
    """(...,) where the product is small beside the squared size of the surface, as far as partials tell it."""
    width, height = domain.size
    size = norm(along_u) * width + norm(along_v) * height
    return np.asarray(norm(product) * width * height <= SUSPECT_PRODUCT * size * size)


def _with_limits(surface: Surface, u: Floats, v: Floats, partials: tuple[Floats, Floats], product: Floats) -> Floats:
    """(n, 3) the product of the partials where it is one, else its derivative towards the middle of the domain, or,
    where that vanishes too, the product a little that way; NaN where the partials there are parallel."""
    along_u, along_v = partials
    uu, uv, vv = surface.second_partials(u, v)
    domain = surface.domain
    width, height = domain.size
    a = (_inwards(u, domain.u_start, domain.u_end) * width)[:, None]
    b = (_inwards(v, domain.v_start, domain.v_end) * height)[:, None]
    towards_u, towards_v = a * uu + b * uv, a * uv + b * vv
    limit = cross(towards_u, along_v) + cross(along_u, towards_v)
    bound = _bound(domain, partials, (uu, uv, vv))
    vanished = norm(product) <= SINGULAR_PRODUCT * bound
    gone = np.flatnonzero(vanished & (norm(limit) <= SINGULAR_PRODUCT * bound))
    result = np.where(vanished[:, None], limit, product)
    if len(gone):
        inner = (u[gone] + ASIDE_OF_POLE * a[gone, 0], v[gone] + ASIDE_OF_POLE * b[gone, 0])
        one, two = of_some(surface, gone).partials(*inner)
        inside = cross(one, two)
        known = norm(inside) > SINGULAR_PRODUCT * norm(one) * norm(two)
        result[gone] = np.where(known[:, None], inside, np.nan)
    return result


def _bound(domain: Domain, first: Partials, second: SecondPartials) -> Floats:
    """(...,) how large the cross product can be on a domain with these partials."""
    (width, height), (uu, uv, vv) = domain.size, second
    return np.asarray(
        (norm(first[0]) + norm(uu) * width + norm(uv) * height)
        * (norm(first[1]) + norm(uv) * width + norm(vv) * height)
    )


def _inwards(t: Floats, start: float, end: float) -> Floats:
    """(n,) the sign of the way to the middle. The way along the line of a pole itself does not count: it stands."""
    return np.where(t <= 0.5 * (start + end), 1.0, -1.0)


# Where a surface jumps: places next to each other in its domain whose points stay apart.

HALVINGS = 40
"""How often a way in the domain is halved: what is left of it is 1e-12 of its length."""

STAYS = 0.05
"""Part of a chord that must be left at the end of that: of the chord of a cube root, which is as steep as anything
continuous that people draw, a ten-thousandth is."""

UNEVEN = 0.8
"""Part of a chord that the longer of the chords of its halves has at least where the surface jumps beneath it."""

LONG = 2.0
"""Times the usual length of the sides of cells: shorter ones are not looked at."""

MOST = 1 << 15
"""Sides of cells that are looked at closely at most, the longest ones."""


def jumps(surface: Surface, start: Floats, end: Floats) -> Bools:
    """(k,) whether the surface jumps, or runs through a pole, on the straight way in the domain from start to end
    (k,2).

    The half of the way with the longer chord is taken, again and again. Edge cases: where the middle of what is left
    of the way is in a hole, the surface is interrupted, which is as good as a jump.
    """
    start, end = start.copy(), end.copy()
    low, high = _points(surface, start), _points(surface, end)
    first = _lengths(low, high)
    result = np.zeros(len(start), dtype=np.bool_)
    active = np.flatnonzero(np.isfinite(first) & (first > 0.0))
    for step in range(HALVINGS):
        if not len(active):
            break
        middle = 0.5 * (start[active] + end[active])
        between = _points(of_some(surface, active), middle)
        one, two = _lengths(low[active], between), _lengths(between, high[active])
        left = np.nan_to_num(one, nan=-1.0) >= np.nan_to_num(two, nan=-1.0)
        here, there = active[left], active[~left]
        end[here], high[here] = middle[left], between[left]
        start[there], low[there] = middle[~left], between[~left]
        longer = np.where(left, one, two)
        least = STAYS if step else UNEVEN
        interrupted = ~np.isfinite(between).all(axis=1)
        result[active[interrupted]] = True
        active = active[~interrupted & (longer >= least * first[active])]
    result[active] = True
    return result


def jumping_cells(surfaces: StackedSurfaces, u: Floats, v: Floats, points: Floats) -> Bools:
    """(s,m-1,n-1) cells of the grids of parameters u (s,m) and v (s,n), (1,m) and (1,n) if they are the same for all,
    with a side along which the surface jumps.

    points (s,m,n,3): of the surfaces there. Sides that are not longer than usual are not looked at: a jump that small
    is no larger than a cell.
    """
    places = np.stack(np.broadcast_arrays(u[:, :, None], v[:, None, :]), axis=-1)
    across = _jumping_sides(surfaces, (places[:, :-1], places[:, 1:]), _lengths(points[:, :-1], points[:, 1:]))
    along = _jumping_sides(
        surfaces, (places[:, :, :-1], places[:, :, 1:]), _lengths(points[:, :, :-1], points[:, :, 1:])
    )
    return np.asarray(across[:, :, :-1] | across[:, :, 1:] | along[:, :-1] | along[:, 1:])


def _jumping_sides(surfaces: StackedSurfaces, ends: tuple[Floats, Floats], lengths: Floats) -> Bools:
    """(s,m,n) which sides of these lengths (s,m,n), from some places to others (s or 1,m,n,2), jump."""
    result = np.zeros(lengths.shape, dtype=np.bool_)
    lengths = lengths.reshape(len(lengths), -1)
    long = np.nan_to_num(lengths)
    surface, side = np.nonzero(long > LONG * _typical(lengths)[:, None])
    if not len(side):
        return result
    # The longest of each surface.
    order = np.lexsort((-long[surface, side], surface))
    rank = np.arange(len(side)) - np.searchsorted(surface, surface)
    own = order[rank < MOST]
    surface, side = surface[own], side[own]
    of = surface if len(ends[0]) > 1 else np.zeros_like(surface)
    start, end = (places.reshape(len(places), -1, 2)[of, side] for places in ends)
    result.reshape(long.shape)[surface, side] = jumps(surfaces.at(surface), start, end)
    return result


def _typical(lengths: Floats) -> Floats:
    """(s,) the medians of lengths (s,k) that are positive and finite; infinite where there are none."""
    known = np.isfinite(lengths) & (lengths > 0.0)
    ordered, count = np.sort(np.where(known, lengths, np.inf), axis=1), known.sum(axis=1)
    every, most = np.arange(len(lengths)), lengths.shape[1] - 1
    low, high = ordered[every, np.maximum(count - 1, 0) // 2], ordered[every, np.minimum(count // 2, most)]
    return np.asarray(0.5 * low + 0.5 * high)


def _points(surface: Surface, places: Floats) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(surface.points(places[:, 0], places[:, 1]), dtype=np.float64)


def _lengths(a: Floats, b: Floats) -> Floats:
    """(...,) distances of points."""
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(((b - a) ** 2).sum(axis=-1)))
