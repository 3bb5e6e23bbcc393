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
from vectorplot.surfaces.jets import FirstJets, SecondJets, first_jets, second_jets
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain, Surface

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

    def some(self, rows: Ints) -> StackedSurfaces:
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

    def some(self, which: Ints | Bools) -> SurfaceRows:
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
    return surface.some(which) if isinstance(surface, SurfaceRows) else surface


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
