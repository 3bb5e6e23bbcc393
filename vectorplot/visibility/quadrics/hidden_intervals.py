"""What convex quadrics hide of arcs and lines: intervals between the roots of polynomials in Bernstein form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import intervals, ragged, records
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances import ROUNDING, ULP
from vectorplot.visibility.polyhedra.hidden_lines import SLIVER, Progress, Visibility
from vectorplot.visibility.quadrics.conic_arcs import Arcs, OwnSides, Pieces, cut_arcs, packed_box
from vectorplot.visibility.quadrics.occlusion_volumes import (
    Bodies,
    OcclusionVolumes,
    close_pairs,
    grid_of,
    typical_size,
)

# Polynomials of degree two and four over [0, 1] in Bernstein form, many at once: values and roots.

HALVINGS = 26
"""After so many halvings roots that still lie together are one double root, at which nothing changes."""

ROUNDS = 60
"""Steps of the search for a root between two ends; halving alone takes 53."""


def squares(a: Floats) -> Floats:
    """(5,n) coefficients of the squares of polynomials (3,n)."""
    return np.stack([a[0] * a[0], a[0] * a[1], (a[0] * a[2] + 2.0 * a[1] * a[1]) / 3.0, a[1] * a[2], a[2] * a[2]])


def value_of_two(c: Floats, t: Floats) -> Floats:
    """Values at t of polynomials of degree two, coefficients first (3,...)."""
    s = 1.0 - t
    return np.asarray((c[0] * s + 2.0 * c[1] * t) * s + c[2] * t * t)


def value_of_four(c: Floats, t: Floats) -> Floats:
    """Values at t of polynomials of degree four, coefficients first (5,...)."""
    s = 1.0 - t
    tt, ss = t * t, s * s
    return np.asarray((c[0] * ss + 4.0 * c[1] * s * t + 6.0 * c[2] * tt) * ss + (4.0 * c[3] * s + c[4] * t) * tt * t)


def roots_of_two(c: Floats) -> Floats:
    """(2,n) the roots within (0, 1) of polynomials (3,n); 1 where there is none."""
    a, b = c[0] - 2.0 * c[1] + c[2], c[1] - c[0]
    square = b * b - a * c[0]
    with np.errstate(all="ignore"):
        q = -(b + np.where(b >= 0.0, 1.0, -1.0) * np.sqrt(np.maximum(square, 0.0)))
        roots = np.stack([q / a, c[0] / q])
        inside = (roots > 0.0) & (roots < 1.0) & (square >= 0.0)
    return np.where(inside, roots, 1.0)


def roots_of_four(c: Floats) -> tuple[Ints, Floats]:
    """Which polynomial (r,), and where (r,), of all roots within (0, 1) of polynomials (5,n) that change their sign.

    Halved until each part has one change of sign among its coefficients, or none: then it has as many roots. Source:
    Descartes' rule in Bernstein form.
    """
    index, low, width = np.arange(c.shape[1]), np.zeros(c.shape[1]), np.ones(c.shape[1])
    single = [(index[:0], low[:0], width[:0], c[:, :0])]
    for _ in range(HALVINGS):
        changes = _sign_changes(c)
        one = np.flatnonzero(changes == 1)
        single.append((index[one], low[one], width[one], c[:, one]))
        more = np.flatnonzero(changes > 1)
        if not len(more):
            break
        index, low, width = index[more], low[more], 0.5 * width[more]
        left, right = _halves(c[:, more])
        c = np.concatenate([left, right], axis=1)
        index, low, width = np.tile(index, 2), np.concatenate([low, low + width]), np.tile(width, 2)
    index, low, width, c = (np.concatenate(column, axis=-1) for column in zip(*single, strict=True))
    return index, low + width * _single_roots(c)


def _sign_changes(c: Floats) -> Ints:
    """(n,) changes of sign along the coefficients (5,n); zeros have the sign before them."""
    sign = np.sign(c)
    for k in range(1, 5):
        sign[k] = np.where(sign[k] == 0.0, sign[k - 1], sign[k])
    return np.asarray((sign[1:] * sign[:-1] < 0.0).sum(axis=0))


def _halves(c: Floats) -> tuple[Floats, Floats]:
    """Coefficients of both halves of polynomials (5,n). Source: de Casteljau."""
    levels = [c]
    for _ in range(4):
        levels.append(0.5 * (levels[-1][:-1] + levels[-1][1:]))
    return np.stack([level[0] for level in levels]), np.stack([level[-1] for level in reversed(levels)])


def _single_roots(c: Floats) -> Floats:
    """(n,) the root of each polynomial (5,n) that has one: Newton's steps, halving where they leave the bracket."""
    low, high = np.zeros(c.shape[1]), np.ones(c.shape[1])
    rising = np.where(c[0] != 0.0, c[0] < 0.0, c[4] > 0.0)
    with np.errstate(all="ignore"):
        t = c[0] / (c[0] - c[4])
    t = np.where((t > 0.0) & (t < 1.0), t, 0.5)
    slope = 4.0 * (c[1:] - c[:-1])
    found, who = t.copy(), np.arange(len(t))
    for _ in range(ROUNDS):
        value, s = value_of_four(c, t), 1.0 - t
        rate = ((slope[0] * s + 3.0 * slope[1] * t) * s + 3.0 * slope[2] * t * t) * s + slope[3] * t * t * t
        below = (value < 0.0) == rising
        low, high = np.where(below, t, low), np.where(below, high, t)
        with np.errstate(all="ignore"):
            new = t - value / rate
        # The end of the bracket may be the root.
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        new = np.where(value == 0.0, t, new)
        busy = np.flatnonzero(np.abs(new - t) > 2.0 * ULP)
        found[who] = t = new
        if not len(busy):
            break
        who, t, low, high, rising = who[busy], t[busy], low[busy], high[busy], rising[busy]
        c, slope = c[:, busy], slope[:, busy]
    return found


# What volumes hide of pieces of arcs, pair by pair: between the roots of polynomials along each piece.


@dataclass(frozen=True, eq=False)
class OccludedIntervals:
    """Hidden parts of pieces: pair (z,) which one, from low to high (z,), 0 to 1 along the piece."""

    pair: Ints
    low: Floats
    high: Floats


def occluded_intervals(
    pieces: Pieces, volumes: OcclusionVolumes, piece: Ints, volume: Ints, tolerance: float
) -> OccludedIntervals:
    """The hidden intervals of pairs (piece, volume).

    A linear form along a piece has degree two, the difference of squares degree four. Where no coefficient is positive
    nothing is hidden, where none is negative all of it may be; else a part between two roots is decided at its middle.
    What is no larger than the tolerance counts as zero, and zero does not hide.
    """
    pair, control = np.arange(len(piece)), pieces.control[:, :, piece]
    linear = np.empty((len(volumes.linear), 3, len(piece)))
    some, whole = np.ones(len(piece), dtype=np.bool_), np.ones(len(piece), dtype=np.bool_)
    for number, form in enumerate(volumes.linear):
        c = _along(form[:, volume], control)
        c[np.abs(c) <= tolerance] = 0.0
        some &= (c > 0.0).any(axis=0)
        whole &= (c >= 0.0).all(axis=0)
        linear[number] = c
    kept = np.flatnonzero(some)
    pair, volume, control, whole, linear = (
        pair[kept],
        volume[kept],
        control[:, :, kept],
        whole[kept],
        linear[:, :, kept],
    )
    square = np.zeros((5, 0))
    if len(volumes.squares):
        square = _difference(volumes, volume, control)
        kept = np.flatnonzero((square > 0.0).any(axis=0))
        pair, whole, linear, square = pair[kept], whole[kept], linear[:, :, kept], square[:, kept]
        whole = whole & (square >= 0.0).all(axis=0)
    all_of_it = pair[whole]
    rest = np.flatnonzero(~whole)
    found, low, high = _between_roots(linear[:, :, rest], square[:, rest] if len(square[0]) else square)
    return OccludedIntervals(
        np.concatenate([all_of_it, pair[rest][found]]),
        np.concatenate([np.zeros(len(all_of_it)), low]),
        np.concatenate([np.ones(len(all_of_it)), high]),
    )


def _along(form: Floats, control: Floats) -> Floats:
    """(3,n) a linear form (4,n) along pieces with control points (3,4,n)."""
    return np.asarray(
        form[0] * control[:, 0] + form[1] * control[:, 1] + form[2] * control[:, 2] + form[3] * control[:, 3]
    )


def _difference(volumes: OcclusionVolumes, volume: Ints, control: Floats) -> Floats:
    """(5,n) the square of the first form less those of the others, snapped to zero."""
    first = squares(_along(volumes.squares[0][:, volume], control))
    square, size = first.copy(), np.abs(first).max(axis=0)
    slack = volumes.slack[volume] * size
    for form in volumes.squares[1:]:
        other = squares(_along(form[:, volume], control))
        square -= other
        np.maximum(size, np.maximum(other[0], other[4]), out=size)
    square[np.abs(square) <= np.maximum(slack, ROUNDING * size)] = 0.0
    return square


def _between_roots(linear: Floats, square: Floats) -> tuple[Ints, Floats, Floats]:
    """Which column (z,), and from where to where (z,), all the polynomials (l,3,n) and (5,n) are positive."""
    count = linear.shape[2]
    columns = [np.zeros((1, count)), np.ones((1, count)), *(roots_of_two(c) for c in linear)]
    if square.shape[1]:
        of, root = roots_of_four(square)
        order = np.argsort(of, kind="stable")
        of, root = of[order], root[order]
        rank = np.arange(len(of)) - np.searchsorted(of, of)
        roots = np.ones((int(rank.max(initial=-1)) + 1, count))
        roots[rank, of] = root
        columns.append(roots)
    ends = np.sort(np.concatenate(columns), axis=0)
    middle = 0.5 * (ends[1:] + ends[:-1])
    inside = ends[1:] > ends[:-1]
    for c in linear:
        inside &= value_of_two(c[:, None], middle) > 0.0
    if square.shape[1]:
        inside &= value_of_four(square[:, None], middle) > 0.0
    part, column = np.nonzero(inside)
    return column, ends[part, column], ends[part + 1, column]


IN_SLAB, FEWEST_SLABS, MOST_SLABS = 1500, 4, 24
"""OcclusionVolumes are tried front to back in slabs of about so many, so that what is hidden early drops out."""

OWN_AT_ONCE = 1 << 16
"""Arcs that their own bodies hide are looked at so many at once: more would need much memory."""


@dataclass(frozen=True, eq=False)
class _Hidden:
    """Hidden parts of arcs: arc (z,), from low to high (z,) of its way, 0 to 1; item (z,) that hides; piece (z,) of the
    arc, and whole (z,): whether all of it is hidden."""

    arc: Ints
    low: Floats
    high: Floats
    item: Ints
    piece: Ints
    whole: Bools


def visible_arcs(bodies: Bodies, arcs: Arcs, sides: OwnSides, progress: Progress) -> Visibility:
    """The visible parts of arcs among bodies, as parts of their way from low to high.

    What lies on a contour is visible. Parts below ten tolerances are left out.
    Source: as hidden_lines; the forms along rational arcs are this package's own.
    """
    # Of equal bodies one hides what all of them do.
    hiding = np.flatnonzero(bodies.hides)
    _, first = np.unique(bodies.same[hiding], return_index=True)
    volumes = bodies.volumes(hiding[first])
    pieces = cut_arcs(bodies.sight, arcs, typical_size(volumes))
    alive = np.ones(len(pieces), dtype=np.bool_)
    found = []
    for hidden in _occluded_intervals(bodies, volumes, pieces, alive, arcs, sides, MOST_SLABS, progress):
        alive[hidden.piece[hidden.whole]] = False
        found.append(hidden)
    hidden = records.joined(found)
    gap = _gaps(arcs, bodies.tolerance)
    union = intervals.union(hidden.arc, hidden.low, hidden.high, gap)
    owner, low, high = intervals.complement(len(arcs), *union, gap)
    return Visibility(owner, low, high, np.zeros(len(owner), dtype=np.intp))


def counted_arcs(bodies: Bodies, arcs: Arcs, sides: OwnSides, items: int, progress: Progress) -> Visibility:
    """All parts of arcs with the number of items, of so many in all, that hide each.

    The visible parts are those of visible_arcs.
    """
    volumes = bodies.volumes(np.flatnonzero(bodies.hides))
    side, body = bodies.hiding_alike(sides.body)
    sides = OwnSides(sides.arc[side], sides.form[side], body)
    pieces = cut_arcs(bodies.sight, arcs, typical_size(volumes))
    alive = np.ones(len(pieces), dtype=np.bool_)
    hidden = records.joined(list(_occluded_intervals(bodies, volumes, pieces, alive, arcs, sides, 1, progress)))
    gap = _gaps(arcs, bodies.tolerance)
    key, owner = np.unique(hidden.arc * items + hidden.item, return_inverse=True)
    of, low, high = intervals.union(owner.reshape(-1), hidden.low, hidden.high, gap[key // items])
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


def _occluded_intervals(
    bodies: Bodies,
    volumes: tuple[OcclusionVolumes, ...],
    pieces: Pieces,
    alive: Bools,
    arcs: Arcs,
    sides: OwnSides,
    slabs: int,
    progress: Progress,
) -> Iterator[_Hidden]:
    """What bodies hide of the pieces of arcs that are alive, front to back; first what they hide of themselves."""
    for turned, piece, side in _own_pairs(bodies, pieces, sides, len(arcs)):
        yield _hidden_of_pairs(pieces, arcs, turned, piece, side, bodies.tolerance)
    grid = grid_of(pieces, typical_size(volumes))
    own = np.where(arcs.own >= 0, bodies.same[arcs.own] if len(bodies) else -1, -1)
    steps = list(_slabs(volumes, slabs))
    for number, (some, slab) in enumerate(steps):
        for piece, volume in close_pairs(grid, pieces, alive, some, slab):
            body = bodies.same[some.body[volume]]
            other = (own[pieces.arc[piece]] != body[:, None]).all(axis=1)
            yield _hidden_of_pairs(pieces, arcs, some, piece[other], volume[other], bodies.tolerance)
        progress((number + 1.0) / len(steps))


def _slabs(volumes: tuple[OcclusionVolumes, ...], most: int) -> Iterator[tuple[OcclusionVolumes, Ints]]:
    """The volumes of all kinds front to back, slab by slab."""
    nearest = np.concatenate([np.zeros(0), *(some.nearest for some in volumes)])
    if not len(nearest):
        return
    count = min(max(len(nearest) // IN_SLAB, FEWEST_SLABS), most)
    bounds = np.quantile(nearest, np.linspace(0.0, 1.0, count + 1))
    bounds[0], bounds[-1] = -np.inf, np.inf
    orders = [np.argsort(some.nearest, kind="stable") for some in volumes]
    for low, high in pairwise(bounds.tolist()):
        for some, order in zip(volumes, orders, strict=True):
            begin, end = np.searchsorted(some.nearest[order], [low, high])
            if begin < end:
                yield some, order[begin:end]


def _own_pairs(
    bodies: Bodies, pieces: Pieces, sides: OwnSides, arcs: int
) -> Iterator[tuple[OcclusionVolumes, Ints, Ints]]:
    """Blocks (volumes, piece, volume) of what bodies hide of arcs on themselves."""
    offsets = np.searchsorted(pieces.arc, np.arange(arcs + 1))
    for low in range(0, max(len(sides.arc), 1), OWN_AT_ONCE):
        block = slice(low, low + OWN_AT_ONCE)
        arc, form, body = sides.arc[block], sides.form[block], sides.body[block]
        size = offsets[arc + 1] - offsets[arc]
        none = np.zeros(len(arc))
        nowhere = packed_box(np.zeros((2, len(arc))), np.zeros((2, len(arc))))
        turned = OcclusionVolumes(
            -form.T[None], np.zeros((0, 4, len(arc))), none, body, bodies.item[body], nowhere, none, none
        )
        yield turned, ragged.ranges(offsets[arc], size), ragged.owner(size)


def _hidden_of_pairs(
    pieces: Pieces, arcs: Arcs, volumes: OcclusionVolumes, piece: Ints, volume: Ints, tolerance: float
) -> _Hidden:
    """The hidden intervals of pairs as parts of arcs."""
    hidden = occluded_intervals(pieces, volumes, piece, volume, tolerance)
    of, item = piece[hidden.pair], volumes.item[volume[hidden.pair]]
    arc = pieces.arc[of]
    span, start = (arcs.high - arcs.low)[arc], arcs.low[arc]
    low, high = (np.clip((pieces.parameters(arcs, of, t) - start) / span, 0.0, 1.0) for t in (hidden.low, hidden.high))
    return _Hidden(arc, low, high, item, of, (hidden.low <= 0.0) & (hidden.high >= 1.0))
