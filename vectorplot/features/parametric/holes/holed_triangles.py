"""Triangles in the domain of a surface, cut along the rims of its holes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.holes.holes import (
    around,
    into_surface,
    is_known,
    just_inside,
    last_alike,
    ways_between,
)
from vectorplot.features.parametric.holes.resolved_rims import resolved
from vectorplot.geometry.components import all_components, any_component
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_parameters import REPEATED_OF_DOMAIN

HALVINGS = 30
"""Halvings of a side along a line with no surface beside it, until its first place without one is known."""


@dataclass(frozen=True, eq=False)
class CutTriangles:
    """Triangles (t,3) of places (n,2) in a domain, none of them with a corner in a hole; rims (r,2): the sides that lie
    along a rim, with the hole to their right; of (t,): the triangle that each is, or is a part of; on_rim (n,): the
    places at the ends of sides along rims."""

    places: Floats
    triangles: Ints
    rims: Ints
    of: Ints

    @property
    def on_rim(self) -> Bools:
        """(n,) the ends of sides along rims."""
        result = np.zeros(len(self.places), dtype=np.bool_)
        result[self.rims] = True
        return result


def cut_at_holes(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> CutTriangles:
    """Triangles (t,3) of places (n,2), those with some corners in holes cut along the rims; known (n,): places that are
    in none. They turn as before.

    A corner that lies on a rim to within 1e-9 of a side is taken for a place on it.
    Degenerate: lines and points without a surface on either side have no rim: they count as parts of the hole.
    """
    known = _with_surface(surface, places, triangles, known)
    finer = resolved(surface, places, triangles, known)
    places, triangles = finer.places, finer.triangles
    known = _with_surface(surface, places, triangles, finer.known)
    inside = known[triangles].sum(axis=1)
    whole, cut_up = np.flatnonzero(inside == 3), np.flatnonzero((inside == 1) | (inside == 2))
    if not len(cut_up):
        return CutTriangles(places, triangles[whole], np.zeros((0, 2), dtype=np.intp), finer.of[whole])
    mixed = triangles[cut_up]
    # Turned so that the last corner is the one that differs from the two others.
    count = known[mixed].sum(axis=1)
    odd = np.argmax(known[mixed] == (count == 1)[:, None], axis=1)
    a, b, c = np.take_along_axis(mixed, (odd[:, None] + 1 + np.arange(3)) % 3, axis=1).T
    new, end = _crossings(surface, places, known, np.concatenate([a, b]), np.concatenate([c, c]))
    on_a, on_b = np.split(end, 2)
    alone = count == 1
    # Beside the rim stands the triangle with the corner that is farther from it: a narrow one may reach over the hole.
    far = (_steps(places, new, a, on_a) > _steps(places, new, b, on_b))[~alone, None]
    one, two, three, four = (
        np.stack(some, axis=1)[~alone] for some in ((a, b, on_b), (b, on_b, on_a), (a, on_b, on_a), (a, b, on_a))
    )
    parts = [np.stack([c, on_a, on_b], axis=1)[alone], np.where(far, one, two), np.where(far, three, four)]
    every = np.concatenate([triangles[whole], *parts])
    of = np.concatenate([whole, cut_up[alone], cut_up[~alone], cut_up[~alone]])
    kept = all_components(every != np.roll(every, 1, axis=1))
    rims = np.where(alone[:, None], np.stack([on_a, on_b], axis=1), np.stack([on_b, on_a], axis=1))
    return CutTriangles(np.concatenate([places, new]), every[kept], _once(rims), finer.of[of[kept]])


def _with_surface(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Bools:
    """(n,) the known places but those beside holes around which nothing is known: x^y at whole y and x < 0."""
    mixed = triangles[any_component(known[triangles]) & ~all_components(known[triangles])]
    beside = np.unique(mixed[known[mixed]])
    result = known.copy()
    result[beside] = _has_surface(surface, places[beside])
    return result


def _has_surface(surface: Surface, places: Floats) -> Bools:
    """(k,) which places (k,2) have something known around them."""
    return np.asarray(is_known(surface, around(surface, places)).any(axis=0), dtype=np.bool_)


def _crossings(surface: Surface, places: Floats, known: Bools, one: Ints, two: Ints) -> tuple[Floats, Ints]:
    """The places (m,2) that are new, and the numbers (k,) of those at which sides between places one and two (k,), one
    of which is in a hole, leave the surface: of a place that there was, or of a new one."""
    pair, side = np.unique(np.stack([one, two], axis=1).min(axis=1) << 32 | np.maximum(one, two), return_inverse=True)
    low, high = pair >> 32, pair & 0xFFFFFFFF
    start, end = np.where(known[low], low, high), np.where(known[low], high, low)
    way = ways_between(surface.domain, places[start], places[end])
    part, _ = last_alike(surface, places[start], way, np.zeros(len(pair)), np.ones(len(pair)))
    # A side along a line with values and no surface beside them: all of it is known.
    line = np.flatnonzero(part >= 1.0 - REPEATED_OF_DOMAIN)
    inner, outer = np.zeros(len(line)), np.ones(len(line))
    for _ in range(HALVINGS if len(line) else 0):
        middle = 0.5 * (inner + outer)
        there = _has_surface(surface, places[start[line]] + middle[:, None] * way[line])
        inner, outer = np.where(there, middle, inner), np.where(there, outer, middle)
    part[line] = np.where(_has_surface(surface, places[end[line]]), part[line], inner)
    # Sides that end in one place have one crossing where the rim runs through it.
    number = len(places) + np.arange(len(pair))
    through = part >= 1.0 - REPEATED_OF_DOMAIN
    first = np.full(len(places), -1)
    first[end[through][::-1]] = number[through][::-1]
    number = np.where(part <= REPEATED_OF_DOMAIN, start, np.where(through, first[end], number))
    found = places[start] + part[:, None] * way
    return just_inside(surface, found, into_surface(surface, found)), number[side]


def _steps(places: Floats, new: Floats, start: Ints, end: Ints) -> Floats:
    """(k,) how far it is from places (n,2), numbered start (k,), to these, or new ones (m,2), numbered end."""
    every = np.concatenate([places, new])
    return np.asarray(np.hypot(*(every[end] - every[start]).T))


def _once(rims: Ints) -> Ints:
    """The sides (r,2) that are more than a point, and not there the other way round too."""
    rims = rims[rims[:, 0] != rims[:, 1]]
    key = rims.min(axis=1) << 32 | rims.max(axis=1)
    _, where, uses = np.unique(key, return_inverse=True, return_counts=True)
    return np.asarray(rims[uses[where] == 1])
