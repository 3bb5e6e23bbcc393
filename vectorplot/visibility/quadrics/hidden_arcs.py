"""What convex quadrics hide of arcs and lines, as a sentence."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.exact import intervals
from vectorplot.geometry import ragged, records
from vectorplot.geometry.vectors import dot
from vectorplot.visibility.polyhedra.hidden_lines import SLIVER, Progress, Visibility
from vectorplot.visibility.quadrics.arc_pieces import Pieces, cut_arcs, packed_box
from vectorplot.visibility.quadrics.bodies.covers import Covers
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.clip import hidden_zones
from vectorplot.visibility.quadrics.conic_arcs import Arcs, OwnSides
from vectorplot.visibility.quadrics.cover_candidates import close_pairs, grid_of, typical_size

IN_SLAB, FEWEST_SLABS, MOST_SLABS = 1500, 4, 24
"""Covers are tried front to back in slabs of about so many, so that what is hidden early drops out."""

OWN_AT_ONCE = 1 << 16
"""Arcs that their own bodies hide are looked at so many at once: more would need much memory."""


@dataclass(frozen=True, eq=False)
class _Hidden:
    """Hidden zones of arcs: arc (z,), from low to high (z,) of its way, 0 to 1; item (z,) that hides; piece (z,) of the
    arc, and whole (z,): whether all of it is hidden."""

    arc: Ints
    low: Floats
    high: Floats
    item: Ints
    piece: Ints
    whole: Bools


def whole_arcs(arcs: Arcs) -> Visibility:
    """All of every arc, as if nothing hid it."""
    count = len(arcs)
    return Visibility(np.arange(count), np.zeros(count), np.ones(count), np.zeros(count, dtype=np.intp))


def visible_arcs(bodies: Bodies, arcs: Arcs, sides: OwnSides, progress: Progress) -> Visibility:
    """The visible parts of arcs among bodies, as parts of their way from low to high.

    What lies on a contour is visible. Parts below ten tolerances are left out.
    Source: as hidden_lines; the forms along rational arcs are this package's own.
    """
    # Of equal bodies one hides what all of them do.
    hiding = np.flatnonzero(bodies.hides)
    _, first = np.unique(bodies.same[hiding], return_index=True)
    covers = bodies.covers(hiding[first])
    pieces = cut_arcs(bodies.sight, arcs, typical_size(covers))
    alive = np.ones(len(pieces), dtype=np.bool_)
    found = []
    for hidden in _hidden_zones(bodies, covers, pieces, alive, arcs, sides, MOST_SLABS, progress):
        alive[hidden.piece[hidden.whole]] = False
        found.append(hidden)
    zones = records.joined(found)
    gap = _gaps(arcs, bodies.tolerance)
    union = intervals.union(zones.arc, zones.low, zones.high, gap)
    owner, low, high = intervals.complement(len(arcs), *union, gap)
    return Visibility(owner, low, high, np.zeros(len(owner), dtype=np.intp))


def counted_arcs(bodies: Bodies, arcs: Arcs, sides: OwnSides, items: int, progress: Progress) -> Visibility:
    """All parts of arcs with the number of items, of so many in all, that hide each.

    The visible parts are those of visible_arcs.
    """
    covers = bodies.covers(np.flatnonzero(bodies.hides))
    side, body = bodies.hiding_alike(sides.body)
    sides = OwnSides(sides.arc[side], sides.form[side], body)
    pieces = cut_arcs(bodies.sight, arcs, typical_size(covers))
    alive = np.ones(len(pieces), dtype=np.bool_)
    zones = records.joined(list(_hidden_zones(bodies, covers, pieces, alive, arcs, sides, 1, progress)))
    gap = _gaps(arcs, bodies.tolerance)
    key, owner = np.unique(zones.arc * items + zones.item, return_inverse=True)
    of, low, high = intervals.union(owner.reshape(-1), zones.low, zones.high, gap[key // items])
    arc = key[of] // items
    covered = intervals.coverage(arc, low, high, np.zeros(len(arc), dtype=np.intp))
    long = covered[2] - covered[1] > gap[covered[0]]
    arc, low, high, count = covered[0][long], covered[1][long], covered[2][long], covered[3][long]
    free, free_low, free_high = intervals.complement(len(arcs), *intervals.union(arc, low, high, gap), gap)
    arc, count = np.concatenate([arc, free]), np.concatenate([count, np.zeros_like(free)])
    low, high = np.concatenate([low, free_low]), np.concatenate([high, free_high])
    order = np.lexsort((low, arc))
    return Visibility(arc[order], low[order], high[order], count[order])


def _gaps(arcs: Arcs, tolerance: float) -> Floats:
    """(n,) the part of each arc that is too short to count."""
    radius = np.sqrt(np.maximum(dot(arcs.first, arcs.first), dot(arcs.second, arcs.second)))
    length = radius * (arcs.high - arcs.low)
    return np.minimum(SLIVER * tolerance / np.where(length > 0.0, length, 1.0), 1.0)


def _hidden_zones(
    bodies: Bodies,
    covers: tuple[Covers, ...],
    pieces: Pieces,
    alive: Bools,
    arcs: Arcs,
    sides: OwnSides,
    slabs: int,
    progress: Progress,
) -> Iterator[_Hidden]:
    """What bodies hide of the pieces of arcs that are alive, front to back; first what they hide of themselves."""
    for turned, piece, side in _own_pairs(bodies, pieces, sides, len(arcs)):
        yield _zones(pieces, arcs, turned, piece, side, bodies.tolerance)
    grid = grid_of(pieces, typical_size(covers))
    own = np.where(arcs.own >= 0, bodies.same[arcs.own] if len(bodies) else -1, -1)
    steps = list(_slabs(covers, slabs))
    for number, (some, slab) in enumerate(steps):
        for piece, cover in close_pairs(grid, pieces, alive, some, slab):
            body = bodies.same[some.body[cover]]
            other = (own[pieces.arc[piece]] != body[:, None]).all(axis=1)
            yield _zones(pieces, arcs, some, piece[other], cover[other], bodies.tolerance)
        progress((number + 1.0) / len(steps))


def _slabs(covers: tuple[Covers, ...], most: int) -> Iterator[tuple[Covers, Ints]]:
    """The covers of all kinds front to back, slab by slab."""
    nearest = np.concatenate([np.zeros(0), *(some.nearest for some in covers)])
    if not len(nearest):
        return
    count = min(max(len(nearest) // IN_SLAB, FEWEST_SLABS), most)
    bounds = np.quantile(nearest, np.linspace(0.0, 1.0, count + 1))
    bounds[0], bounds[-1] = -np.inf, np.inf
    orders = [np.argsort(some.nearest, kind="stable") for some in covers]
    for low, high in pairwise(bounds.tolist()):
        for some, order in zip(covers, orders, strict=True):
            begin, end = np.searchsorted(some.nearest[order], [low, high])
            if begin < end:
                yield some, order[begin:end]


def _own_pairs(bodies: Bodies, pieces: Pieces, sides: OwnSides, arcs: int) -> Iterator[tuple[Covers, Ints, Ints]]:
    """Blocks (covers, piece, cover) of what bodies hide of arcs on themselves."""
    offsets = np.searchsorted(pieces.arc, np.arange(arcs + 1))
    for low in range(0, max(len(sides.arc), 1), OWN_AT_ONCE):
        block = slice(low, low + OWN_AT_ONCE)
        arc, form, body = sides.arc[block], sides.form[block], sides.body[block]
        size = offsets[arc + 1] - offsets[arc]
        none = np.zeros(len(arc))
        nowhere = packed_box(np.zeros((2, len(arc))), np.zeros((2, len(arc))))
        turned = Covers(-form.T[None], np.zeros((0, 4, len(arc))), none, body, bodies.item[body], nowhere, none, none)
        yield turned, ragged.ranges(offsets[arc], size), ragged.owner(size)


def _zones(pieces: Pieces, arcs: Arcs, covers: Covers, piece: Ints, cover: Ints, tolerance: float) -> _Hidden:
    """The zones of pairs as parts of arcs."""
    zones = hidden_zones(pieces, covers, piece, cover, tolerance)
    of, item = piece[zones.pair], covers.item[cover[zones.pair]]
    arc = pieces.arc[of]
    span, start = (arcs.high - arcs.low)[arc], arcs.low[arc]
    low, high = (np.clip((pieces.parameters(arcs, of, t) - start) / span, 0.0, 1.0) for t in (zones.low, zones.high))
    return _Hidden(arc, low, high, item, of, (zones.low <= 0.0) & (zones.high >= 1.0))
