"""Triangles in the domain of a surface divided where they meet holes, until one straight rim runs through each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conforming_triangles import divided
from vectorplot.features.parametric.holes.holes import is_known, ways_between
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.components import any_component
from vectorplot.geometry.narrowing import narrowed
from vectorplot.geometry.triangles.triangle_edges import edges_of
from vectorplot.surfaces.surface import Surface

ROUNDS = 12
"""Times that triangles are divided: around a corner of a rim, or where two of them cross, they then are a four
thousandth as large."""

LOOKS = np.arange(1, 8) / 8
"""Parts of a side, or of a way along a rim, at which is looked for what is there."""

HALVINGS = 12
"""Steps to the places at which the rim leaves a triangle, to tell how straight it is."""

STRAIGHT = 1.0 / 8.0
"""Part of its length by which a rim may be off the way straight through a triangle."""


@dataclass(frozen=True, eq=False)
class Resolved:
    """Triangles (t,3) of places (n,2) in which holes begin along one nearly straight line, as far as that is found;
    known (n,): the places that are in none; of (t,): the triangle that each is, or is a part of."""

    places: Floats
    triangles: Ints
    known: Bools
    of: Ints


def resolved(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Resolved:
    """Triangles (t,3) of places (n,2), divided where a rim in them has a corner or crosses another one, and where a
    side leads over a hole from surface to surface; known (n,): places that are in no hole.

    Holes are looked for in triangles with a corner in one, and in those around them.
    Degenerate: sides that lead over a hole in the end, and their triangles, are left out.
    """
    near = _around(triangles, _mixed(triangles, known))
    pool = _around(triangles, near)
    rest, rest_of = triangles[~pool], np.flatnonzero(~pool)
    triangles, of, near = triangles[pool], np.flatnonzero(pool), near[pool]
    for number in range(ROUNDS + 1):
        edges, sides, _ = edges_of(triangles, len(places))
        asked = np.zeros(len(edges), dtype=np.bool_)
        asked[sides[near]] = True
        hole = _holes(surface, places, edges, asked & known[edges].all(axis=1))
        over = np.isfinite(hole[:, 0])
        if number == ROUNDS:
            kept = ~over[sides].any(axis=1)
            triangles, of = triangles[kept], of[kept]
            break
        crooked = np.flatnonzero(_mixed(triangles, known))
        crooked = crooked[~_is_straight(surface, places, triangles[crooked], known)]
        split = over.copy()
        split[sides[crooked]] = True
        if not split.any():
            break
        halved = np.flatnonzero(split & ~over)
        start = places[edges[halved, 0]]
        hole[halved] = start + 0.5 * ways_between(surface.domain, start, places[edges[halved, 1]])
        new = np.stack(wrapped(surface.domain, *hole[split].T), axis=1)
        middle = np.full(len(edges), -1)
        middle[split] = len(places) + np.arange(len(new))
        places, known = np.concatenate([places, new]), np.append(known, is_known(surface, new))
        # Which diagonal is shorter is told in parts of the domain: the units of u and of v have nothing in common.
        triangles, part_of = divided(triangles, middle[sides], places / surface.domain.size)
        of, near = of[part_of], near[part_of]
    return Resolved(places, np.concatenate([rest, triangles]), known, np.concatenate([rest_of, of]))


def _mixed(triangles: Ints, known: Bools) -> Bools:
    """(t,) the triangles with corners on the surface and in holes."""
    count = known[triangles].sum(axis=1)
    return np.asarray((count == 1) | (count == 2), dtype=np.bool_)


def _around(triangles: Ints, some: Bools) -> Bools:
    """(t,) the triangles that share a corner with some of them."""
    if not some.any():
        return some
    used = np.zeros(int(triangles.max()) + 1, dtype=np.bool_)
    used[triangles[some]] = True
    return np.asarray(any_component(used[triangles]))


def _holes(surface: Surface, places: Floats, edges: Ints, asked: Bools) -> Floats:
    """(e,2) places in holes on some sides between places on the surface; NaN where there are none."""
    found = np.full((len(edges), 2), np.nan)
    both = np.flatnonzero(asked)
    start = places[edges[both, 0]]
    tried = start + LOOKS[:, None, None] * ways_between(surface.domain, start, places[edges[both, 1]])
    inside = is_known(surface, tried)
    over = np.flatnonzero(~inside.all(axis=0))
    found[both[over]] = tried[np.argmin(inside[:, over], axis=0), over]
    return found


def _is_straight(surface: Surface, places: Floats, triangles: Ints, known: Bools) -> Bools:
    """(t,) whether all is surface on one side of one straight line, and all hole on the other, as far as is looked, in
    triangles (t,3) with corners in both."""
    if not len(triangles):
        return np.zeros(0, dtype=np.bool_)
    inside = known[triangles]
    odd = np.argmax(inside == (inside.sum(axis=1) == 1)[:, None], axis=1)
    corner, *others = np.take_along_axis(triangles, (odd[:, None] + np.arange(3)) % 3, axis=1).T
    size = np.array(surface.domain.size)
    base, alone = places[corner], known[corner]
    ways, ends = [ways_between(surface.domain, base, places[other]) for other in others], []
    at_corners = np.ones(len(base), dtype=np.bool_)
    for way in ways:

        def goes_on(which: Ints, part: Floats, way: Floats = way) -> Bools:
            return np.asarray(is_known(surface, base[which] + part[:, None] * way[which]) == alone[which])

        low, high = narrowed(goes_on, np.zeros(len(base)), np.ones(len(base)), HALVINGS)
        ends.append(0.5 * (low + high)[:, None] * way / size)
        at_corners &= np.where(alone, low == 0.0, high == 1.0)
    chord = ends[1] - ends[0]
    along = ends[0] + LOOKS[:, None, None] * chord
    # The corner that differs lies to the right of the way, which turns as the triangle does.
    turn = np.sign(ends[0][:, 0] * ends[1][:, 1] - ends[0][:, 1] * ends[1][:, 0])[:, None]
    aside = STRAIGHT * turn * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    beyond, before = (is_known(surface, base + size * (along + way)) for way in (aside, -aside))
    straight = ((before == alone) & (beyond != alone)).all(axis=0)
    bare = np.flatnonzero(~straight & at_corners)
    straight[bare] = _is_bare(surface, base[bare], *(way[bare] for way in ways))
    return np.asarray(straight)


def _is_bare(surface: Surface, corner: Floats, one: Floats, two: Floats) -> Bools:
    """(t,) whether all is hole between the sides of triangles, as far as is looked; corner (t,2), one and two (t,2) the
    ways from it to the others. Where a surface is a line or a point and no more, triangles beside it would be divided
    for ever."""
    first, second = np.meshgrid(LOOKS, LOOKS)
    within = first + second < 1.0
    looks = corner + first[within][:, None, None] * one + second[within][:, None, None] * two
    return np.asarray(~is_known(surface, looks).any(axis=0))
