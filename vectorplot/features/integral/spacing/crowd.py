"""What curves have taken of a surface, and what is near it on the same sheet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.charts import Charts
from vectorplot.features.integral.sites import Sites
from vectorplot.features.integral.spacing.places_along import PlacesAlong
from vectorplot.geometry.chunks import workers
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import Surface

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

PORTION = 1024
"""So many places of one line are compared with each other at a time."""

AROUND = 2.0
"""Times the distance along a line within which it is not near itself."""

NEIGHBOURS = 12
"""So many of what is near a place are looked at until one is on its sheet."""

PAIRS_AT_ONCE = 1 << 16
"""Pairs of places that are looked at at a time."""

ROUGHLY = 0.25
"""Part by which distances may be off that only say which gap is wider."""

ON_THE_WAY = (0.0, 0.23, 0.5, 0.71, 1.0)
"""Parts of the way between two places, straight in the parameters, at which it is looked at: not even ones, as sheets
that are whole turns from each other are met at even parts of the way."""

DIRECT = 3.0
"""Times the distance asked for that this way is long at most where the places are on one sheet; round a pole it is half
a circle."""


@dataclass(frozen=True, eq=False)
class Ground:
    """A surface on which curves keep apart from each other: its charts, and the distance that they should have."""

    surface: Surface
    charts: Charts
    apart: float

    def where(self, places: Floats) -> Floats:
        """(k,6) the points at u and v (k,2), and the normals there, as long as the distance: the two sides of a thin
        shape are far from each other."""
        sites = Sites(self.surface, *self.charts.inside(places))
        return np.concatenate([sites.points, self.apart * np.nan_to_num(sites.normals)], axis=1)

    def on_one_sheet(self, one: Floats, two: Floats, reach: float) -> Bools:
        """(k,) whether places, u and v (k,2) each, that are within reach in space are near along the surface."""
        if len(one) > PAIRS_AT_ONCE:
            bounds = range(0, len(one), PAIRS_AT_ONCE)
            parts = [slice(first, first + PAIRS_AT_ONCE) for first in bounds]
            return np.concatenate([self.on_one_sheet(one[part], two[part], reach) for part in parts])
        way = self.charts.near_to(two, one) - one
        stops = one + np.array(ON_THE_WAY)[:, None, None] * way
        points = self.surface.points(*self.charts.within(stops.reshape(-1, 2))).reshape(*stops.shape[:2], 3)
        return np.asarray(norm(np.diff(points, axis=0)).sum(axis=0) <= DIRECT * reach)


@dataclass(frozen=True, eq=False)
class Taken:
    """Places u and v (n,2), and where they are (n,6)."""

    places: Floats
    where: Floats

    @cached_property
    def tree(self) -> cKDTree:
        """Of where they are; what is put together with more before anything is looked up in it needs none."""
        from scipy.spatial import cKDTree

        return cKDTree(self.where)


@dataclass(frozen=True, eq=False)
class Crowd:
    """What is taken of a surface, in groups of which each is more than twice as large as the next one: that many grow
    by little as they are added to, and are few."""

    ground: Ground
    groups: tuple[Taken, ...] = ()

    def with_places(self, places: Floats, where: Floats) -> Crowd:
        """With more places, u and v (k,2), where (k,6)."""
        if not len(places):
            return self
        groups = list(self.groups)
        while groups and len(groups[-1].places) <= 2 * len(places):
            last = groups.pop()
            places, where = np.concatenate([last.places, places]), np.concatenate([last.where, where])
        return replace(self, groups=(*groups, Taken(places, where)))

    def together(self, other: Crowd) -> Crowd:
        """With what another one has."""
        result = self
        for group in other.groups:
            result = result.with_places(group.places, group.where)
        return result

    def away(self, where: Floats) -> Floats:
        """(k,) distances in space, and of normals, from what is nearest, larger by a part, ROUGHLY, at most; not finite
        where nothing is taken; 0 in holes."""
        known = all_finite(where)
        result = np.where(known, np.inf, 0.0)
        for group in self.groups:
            away = group.tree.query(where[known], eps=ROUGHLY, workers=workers(len(where)))[0]
            result[known] = np.minimum(result[known], away)
        return result

    def near(self, places: Floats, where: Floats, reach: float) -> Bools:
        """(k,) which of the places, u and v (k,2), where (k,6), are within reach of what is taken on their sheet;
        and those in holes, which a line may run through for a step."""
        result = ~all_finite(where)
        for group in self.groups:
            at = np.flatnonzero(~result)
            away, nearest = group.tree.query(where[at], distance_upper_bound=reach, workers=workers(len(at)))
            at, nearest = at[np.isfinite(away)], nearest[np.isfinite(away)]
            # Mostly what is nearest is on the sheet, and the others need not be looked at.
            if len(at):
                same = self.ground.on_one_sheet(places[at], group.places[nearest], reach)
                result[at[same]] = True
                at = at[~same]
            if len(at):
                most = min(NEIGHBOURS, len(group.places))
                away, which = group.tree.query(where[at], most, distance_upper_bound=reach)
                away, which = away.reshape(len(at), -1), which.reshape(len(at), -1)
                row, column = np.nonzero(np.isfinite(away))
                same = self.ground.on_one_sheet(places[at[row]], group.places[which[row, column]], reach)
                result[at[row[same]]] = True
        return result


def crowds_itself(ground: Ground, line: PlacesAlong, where: Floats, which: Ints, reach: float) -> Bools:
    """(k,) which of some places (k,) of one line, where (p,6) it has them, are within reach of one that is nearer to
    where the line began, but not just a little before.

    Where a line is not near itself each place has few others around it; so it is looked at from where it began, portion
    after portion, until it is.
    """
    from scipy.spatial import cKDTree

    order = which[np.argsort(np.abs(line.along[which]), kind="stable")]
    result = np.zeros(len(line.along), dtype=np.bool_)
    for count in range(PORTION, len(order) + PORTION, PORTION):
        part = order[:count]
        one, two = part[cKDTree(where[part]).query_pairs(reach, output_type="ndarray")].T
        way = np.abs(line.along[one] - line.along[two])
        far = np.minimum(way, line.around[line.curve[one]] - way) > AROUND * ground.apart
        one, two = one[far], two[far]
        same = ground.on_one_sheet(line.places[one], line.places[two], reach)
        one, two = one[same], two[same]
        if len(one):
            result[np.where(np.abs(line.along[one]) >= np.abs(line.along[two]), one, two)] = True
            break
    return result[which]


def thinned(ground: Ground, places: Floats, reach: float) -> Ints:
    """Which of the places, u and v (k,2), to take, one after the other, so that none is within reach of those before on
    its sheet."""
    from scipy.spatial import cKDTree

    if not len(places):
        return np.zeros(0, dtype=np.intp)
    one, two = cKDTree(ground.where(places)).query_pairs(reach, output_type="ndarray").T
    same = ground.on_one_sheet(places[one], places[two], reach)
    one, two = one[same], two[same]
    first, later = np.minimum(one, two), np.maximum(one, two)
    order = np.argsort(first, kind="stable")
    later, bounds = later[order], np.searchsorted(first[order], np.arange(len(places) + 1)).tolist()
    left = np.ones(len(places), dtype=np.bool_)
    for number in range(len(places)):
        if left[number]:
            left[later[bounds[number] : bounds[number + 1]]] = False
    return np.flatnonzero(left)
