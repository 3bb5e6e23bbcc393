"""Where implicit surfaces may end: the sides of their boxes, and the planes that cut them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.algebra import matmul, pseudo_inverse
from vectorplot.geometry.cuts.half_spaces import nothing_beside
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.surfaces.trims.cut_implicit import CutImplicit
from vectorplot.tolerances.of_angles import SAME_DIRECTION_SINE

BOXED = 3
"""Sides of the box: across x, y and z."""


@dataclass(frozen=True, eq=False)
class Plane:
    """The plane of a side, normal . p = offset; normal (3,)."""

    side: int
    normal: Floats
    offset: float

    def holds(self, points: Floats, nothing: float) -> Bools:
        """(n,) which points (n,3) lie in it: in sides of the box to the last bit, else within a distance."""
        if self.side < BOXED:
            return np.asarray(points[:, self.side] == self.offset, dtype=np.bool_)
        return np.asarray(np.abs(self._heights(points)) <= nothing, dtype=np.bool_)

    def put(self, points: Floats) -> Floats:
        """(n,3) points next to it, in it."""
        if self.side < BOXED:
            return np.where(np.arange(BOXED) == self.side, self.offset, points)
        return np.asarray(points - self._heights(points)[:, None] * self.normal)

    def _heights(self, points: Floats) -> Floats:
        return np.asarray(matmul(points - self.offset * self.normal, self.normal))


@dataclass(frozen=True, eq=False)
class Sides:
    """The sides of what is looked at of an implicit surface: 0, 1, 2 those of its box across x, y and z, then the
    planes that cut it. box (2,3); cuts: None where it is not cut; nothing: a distance that counts as none."""

    box: Floats
    cuts: CutImplicit | None
    nothing: float

    @property
    def normals(self) -> Floats:
        """(3+k,3) unit normals; of planes that cut, into what is left."""
        return np.eye(BOXED) if self.cuts is None else np.concatenate([np.eye(BOXED), self.cuts.inward])

    def on(self, points: Floats) -> Bools:
        """(n,3+k) on which sides points (n,3) lie; on those of the box to the last bit."""
        own = np.asarray((points == self.box[0]) | (points == self.box[1]), dtype=np.bool_)
        return own if self.cuts is None else np.concatenate([own, self.cuts.on_borders(points, self.nothing)], axis=1)

    def along(self, vectors: Floats, held: Bools) -> Floats:
        """(n,3) the parts of vectors along the sides that are held, (n,3) those of the box or (n,3+k) all."""
        free = np.where(held[:, :BOXED], 0.0, vectors)
        if not held[:, BOXED:].any():
            return free
        patterns, which = np.unique(held, axis=0, return_inverse=True)
        for number in np.flatnonzero(patterns[:, BOXED:].any(axis=1)).tolist():
            normals = self.normals[patterns[number]]
            rows = which.reshape(-1) == number
            free[rows] = matmul(
                vectors[rows], np.eye(3) - matmul(pseudo_inverse(normals, rcond=SAME_DIRECTION_SINE), normals)
            )
        return free

    def has(self, points: Floats) -> Bools:
        """(n,) which points are in the box and not cut away; those on sides are."""
        inside = np.asarray(((points >= self.box[0]) & (points <= self.box[1])).all(axis=1), dtype=np.bool_)
        return inside if self.cuts is None else inside & (self.cuts.beyond(points) <= self.nothing)

    def planes(self, side: int) -> list[Plane]:
        """The planes of a side: two across an axis, or the one that cuts."""
        if side < BOXED:
            return [Plane(side, np.eye(BOXED)[side], float(row[side])) for row in self.box]
        assert self.cuts is not None
        return [Plane(side, self.normals[side], float(self.cuts.offsets[side - BOXED]))]

    def clipped(self, points: Floats) -> Floats:
        """(n,3) points of the box, those that are cut away put into the nearest plane."""
        x = np.clip(points, *self.box)
        if self.cuts is None:
            return x
        first = BOXED
        for region in self.cuts.regions:
            heights = region.heights(x)
            nearest = np.argmin(heights, axis=0)
            gone = np.flatnonzero((heights > 0.0).all(axis=0))
            x[gone] -= heights[nearest[gone], gone, None] * np.array(region.normals)[nearest[gone]]
            first += len(region.normals)
        for normal, side in zip(self.normals[first:], range(first - BOXED, len(self.normals) - BOXED), strict=True):
            x -= np.minimum(self.cuts.heights(x)[side], 0.0)[:, None] * normal
        return x


def sides_of(surface: ImplicitSurface) -> Sides:
    """The sides of a surface."""
    box = np.asarray(surface.box, dtype=np.float64)
    return Sides(box, surface if isinstance(surface, CutImplicit) else None, nothing_beside(box))
