"""Where straight lines that sweep a mantle or a cap meet a quadric, and where these meetings begin, end and turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import inverse_matrix, symmetric_eigen
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN


@dataclass(frozen=True, eq=False)
class Quadrics:
    """Mantles of bodies, by a row each: the points centre + s @ frame with x^2 + y^2 + bend z^2 + 2 slope z + constant
    = 0 and ends[:,0] < z < ends[:,1], s = (x, y, z).

    centre (k,3); frame (k,3,3); bend, slope, constant (k,); ends (k,2), infinite for balls.
    """

    centre: Floats
    frame: Floats
    bend: Floats
    slope: Floats
    constant: Floats
    ends: Floats

    @cached_property
    def inverse(self) -> Floats:
        """(k,3,3): s = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(self.frame))

    def unit(self, row: Ints, points: Floats) -> Floats:
        """(n,3) s of points."""
        return np.asarray(np.einsum("ni,nij->nj", points - self.centre[row], self.inverse[row]))

    def product(self, row: Ints, one: Floats, two: Floats) -> Floats:
        """(n,) the quadratic part for two vectors s."""
        x = one[:, 0] * two[:, 0] + one[:, 1] * two[:, 1]
        return np.asarray(x + self.bend[row] * one[:, 2] * two[:, 2])

    def values(self, row: Ints, points: Floats) -> Floats:
        """(n,) 0 on the quadric, negative inside."""
        s = self.unit(row, points)
        return self.product(row, s, s) + 2.0 * self.slope[row] * s[:, 2] + self.constant[row]

    def along(self, row: Ints, start: Floats, way: Floats) -> tuple[Floats, Floats, Floats]:
        """(n,) a, b, c: the value at start + v way is a v^2 + 2 b v + c."""
        p, d = self.unit(row, start), np.einsum("ni,nij->nj", way, self.inverse[row])
        slope = self.slope[row]
        c = self.product(row, p, p) + 2.0 * slope * p[:, 2] + self.constant[row]
        return self.product(row, d, d), self.product(row, d, p) + slope * d[:, 2], c

    def holds(self, row: Ints, points: Floats) -> Bools:
        """(n,) whether points are between the ends."""
        return self.holds_height(row, self.unit(row, points)[:, 2])

    def holds_height(self, row: Ints, z: Floats) -> Bools:
        """(n,) whether heights are between the ends; what runs along an end is not."""
        low, high = self.ends[row].T
        return np.asarray((z - low > ON_BORDER_OF_DOMAIN) & (high - z > ON_BORDER_OF_DOMAIN))

    def rims(self, row: Ints, end: int, angle: Floats) -> Floats:
        """(n,3) points of the rim at an end; NaN of one that is no circle or infinitely far."""
        z = self.ends[row, end]
        with np.errstate(invalid="ignore"):
            radius = np.sqrt(-(self.bend[row] * z * z + 2.0 * self.slope[row] * z + self.constant[row]))
            s = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
            return np.asarray(self.centre[row] + np.einsum("ni,nij->nj", s, self.frame[row]))


class Ruled(Protocol):
    """What straight lines sweep, by a row each: the line at t runs from p(t) along d(t)."""

    @property
    def low(self) -> Floats:
        """(k,) the least t."""

    @property
    def high(self) -> Floats:
        """(k,) the largest t."""

    @property
    def goes_round(self) -> bool:
        """Whether the line at the largest t is that at the least one."""

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) p and d."""

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether p + v d is inside of the borders."""

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) 0 where points are on what is swept."""

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) t of points that are on it."""

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the border circle at end 0 or 1, and (n,) their t; NaN where there is none."""


SEAM = 0.7
"""The angle at which a mantle is cut open: at none at which things usually are."""


@dataclass(frozen=True, eq=False)
class Mantles:
    """The mantles of frusta; t is the angle, v the height. base, growth (k,): radii are base + growth z."""

    quadrics: Quadrics
    base: Floats
    growth: Floats

    @property
    def low(self) -> Floats:
        """(k,) where it is cut open."""
        return np.full(len(self.base), SEAM - 2.0 * np.pi)

    @property
    def high(self) -> Floats:
        """(k,) a turn further."""
        return np.full(len(self.base), SEAM)

    @property
    def goes_round(self) -> bool:
        """Yes."""
        return True

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the circle at z = 0, and the ways to those at z = 1."""
        frame = self.quadrics.frame[row]
        out = np.cos(t)[:, None] * frame[:, 0] + np.sin(t)[:, None] * frame[:, 1]
        return (
            self.quadrics.centre[row] + self.base[row, None] * out,
            self.growth[row, None] * out + frame[:, 2],
        )

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether between the ends."""
        return self.quadrics.holds_height(row, v)

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) values of the quadric."""
        return self.quadrics.values(row, points)

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) the angles."""
        s = self.quadrics.unit(row, points)
        angle = arctan2(s[:, 1], s[:, 0])
        return np.where(angle > SEAM, angle - 2.0 * np.pi, angle)

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of a rim."""
        return self.quadrics.rims(row, end, angle), angle


@dataclass(frozen=True, eq=False)
class Discs:
    """Caps, swept by parallel chords: the points centre + t across + v along, t^2 + v^2 < 1; all (k,3), across and
    along conjugate radii."""

    centre: Floats
    across: Floats
    along: Floats

    @property
    def low(self) -> Floats:
        """(k,) the rim."""
        return np.full(len(self.centre), -1.0)

    @property
    def high(self) -> Floats:
        """(k,) the rim."""
        return np.ones(len(self.centre))

    @property
    def goes_round(self) -> bool:
        """No."""
        return False

    @cached_property
    def normal(self) -> Floats:
        """(k,3) of unit length."""
        normal = np.cross(self.across, self.along)
        return np.asarray(normal / np.sqrt(dot(normal, normal))[:, None])

    @cached_property
    def _inverse(self) -> Floats:
        """(k,3,3): t, v and the height = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(np.stack([self.across, self.along, self.normal], axis=1)))

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) middles of chords, and half the chord through the middle."""
        return self.centre[row] + t[:, None] * self.across[row], self.along[row]

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether in the disc."""
        return np.asarray(t * t + v * v < 1.0 - ON_BORDER_OF_DOMAIN)

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) over the plane."""
        return dot(points - self.centre[row], self.normal[row])

    def plane(self, row: Ints, points: Floats) -> tuple[Floats, Floats]:
        """(n,) t and v of points of the plane."""
        t, v, _ = np.einsum("ni,nij->jn", points - self.centre[row], self._inverse[row])
        return t, v

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) t."""
        return self.plane(row, points)[0]

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the rim, which is the border at end 0."""
        t = np.cos(angle) if end == 0 else np.full(len(angle), np.nan)
        points = self.centre[row] + t[:, None] * self.across[row] + np.sin(angle)[:, None] * self.along[row]
        return points, t


def chords_across(discs: Discs, quadrics: Quadrics) -> Discs:
    """The same discs with the chords along which a quadric in the same row bends most: its section is no steeper over
    the way across them than it has to be."""
    row = np.arange(len(discs.centre))
    one, two = (np.einsum("ni,nij->nj", way, quadrics.inverse) for way in (discs.across, discs.along))
    form = np.empty((len(row), 2, 2))
    form[:, 0, 0], form[:, 1, 1] = quadrics.product(row, one, one), quadrics.product(row, two, two)
    form[:, 0, 1] = form[:, 1, 0] = quadrics.product(row, one, two)
    bends, ways = symmetric_eigen(form)
    most = np.abs(bends).argmax(axis=1)
    a, b = ways[row, :, most].T
    return Discs(
        discs.centre,
        b[:, None] * discs.across - a[:, None] * discs.along,
        a[:, None] * discs.across + b[:, None] * discs.along,
    )
