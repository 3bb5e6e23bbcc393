"""Where no curves are yet on a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.sites import Sites
from vectorplot.features.integral.spacing.crowd import Crowd, Ground
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.geometry.vectors import norm

WIDEST = 0.9
"""Part of the distance of curves from which on a place is away from all of them."""

GRID = 160
"""Places along u, and along v, at which gaps are looked for, at most."""

AT_ONCE = 24
"""Gaps that are filled at a time."""

SEPARATE = 4.0
"""Times the distance of curves that gaps which are filled at a time are from each other."""

BESIDE = 2.0
"""And times what is empty around the one that is filled first."""

BLOCK = 128
"""So many places are compared with each other at a time, and what is taken of them with all."""


@dataclass(frozen=True, eq=False)
class Gaps:
    """Places, u and v (k,2), where (k,6), that no curve has come near yet; away (k,): how far all of them are."""

    ground: Ground
    places: Floats
    where: Floats
    away: Floats

    def widest(self) -> Ints:
        """Which of the places to fill next, the farthest ones first, apart from each other; where nothing is taken yet
        that in the middle."""
        if not len(self.places):
            return np.zeros(0, dtype=np.intp)
        if not np.isfinite(self.away).any():
            points = self.where[:, :3]
            return np.array([np.argmin(norm(points - np.median(points, axis=0)))])
        return widest_first(self.where, self.away, self.ground.apart, AT_ONCE)

    def left_by(self, crowd: Crowd, tried: Ints) -> Gaps:
        """Those that are left now that these places are taken, and some have been tried: a gap that nothing fits into
        is one no more."""
        reach = WIDEST * self.ground.apart
        spent = Crowd(self.ground).with_places(self.places[tried], self.where[tried])
        taken = (each.near(self.places, self.where, reach) for each in (crowd, spent))
        kept = np.flatnonzero(~np.logical_or(*taken))
        where = self.where[kept]
        return replace(self, places=self.places[kept], where=where, away=crowd.away(where))


def widest_first(where: Floats, away: Floats, apart: float, most: int) -> Ints:
    """Which of the places where (n,6), away (n,) from all that is taken, to fill next, so many at most: the farthest
    ones first, none of them in what is empty around one before."""
    from scipy.spatial import cKDTree

    every, open_ = cKDTree(where), np.ones(len(where), dtype=np.bool_)
    left = np.argsort(-away, kind="stable")
    chosen = [np.zeros(0, dtype=np.intp)]
    while len(left) and most > 0:
        block = left[:BLOCK]
        # Where much is empty, what begins in one gap fills those about it too.
        empty = np.maximum(SEPARATE * apart, BESIDE * away[block])
        picked = _one_after_the_other(norm(where[block, None] - where[block]) > empty[:, None])[:most]
        chosen.append(block[picked])
        most -= len(picked)
        pairs = cKDTree(where[chosen[-1]]).sparse_distance_matrix(every, float(empty[0]), output_type="ndarray")
        open_[pairs["j"][pairs["v"] <= empty[picked][pairs["i"]]]] = False
        left = left[BLOCK:]
        left = left[open_[left]]
    return np.concatenate(chosen)


def _one_after_the_other(apart: Bools) -> Ints:
    """Which of some places to take, one after the other, of which apart (b,b) tells whether a later one is none of
    those about an earlier one."""
    free, taken = np.ones(len(apart), dtype=np.bool_), []
    for place in range(len(apart)):
        if free[place]:
            taken.append(place)
            free &= apart[place]
    return np.array(taken, dtype=np.intp)


def gaps_all_over(ground: Ground, field: TangentField) -> Gaps:
    """Places all over a surface where a field has a direction."""
    surface = ground.surface
    domain = surface.domain
    u, v = domain.grid(16, 16)
    points = surface.points(*np.meshgrid(u, v, indexing="ij"))
    with np.errstate(invalid="ignore"):
        across = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=0)).sum(axis=0)))
        along = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=1)).sum(axis=1)))
    columns, rows = (int(np.clip(2.0 * long / ground.apart, 8, GRID)) for long in (across, along))
    u, v = domain.grid(columns, rows)
    middles = np.meshgrid(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij")
    places = np.stack(middles, axis=-1).reshape(-1, 2)
    known = np.isfinite(field.tangents(Sites(surface, *places.T))[0]).all(axis=1)
    places = places[known]
    return Gaps(ground, places, ground.where(places), np.full(len(places), np.inf))
