"""The curves in which mantles and caps meet quadrics: the lines that sweep the former meet these twice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between
from vectorplot.geometry.outline import concat
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances.of_parameters import ONE_BREAK_OF_DOMAIN
from vectorplot.tolerances.of_values import ALONG_A_RULING, NODE_OF_RULINGS
from vectorplot.visibility.quadrics.lines.ruled_quadrics import Quadrics, Ruled
from vectorplot.visibility.quadrics.lines.sampled_zeros import zeros_of

MOST_POINTS = 1 << 21
"""Points of all curves at most: a tolerance that asks for more is not kept."""

BEGINNING = 9
"""Points of each piece of a curve before it is refined."""

LOOKED_AT = 24
"""Lines of each row that tell whether it can be decided."""

Picture = Callable[[Floats], Floats]


class Break(IntEnum):
    """What happens at a line that sweeps: a curve meets a border, or turns back, or two curves cross or nearly do."""

    BORDER = 0
    TURN = 1
    NODE = 2


@dataclass(frozen=True, eq=False)
class RuledCurves:
    """Polylines: points (n,3), those of closed ones with the first one once more at the end; offsets (m+1,);
    closed (m,); row (m,): which of the pairs of surfaces meet in them."""

    points: Floats
    offsets: Ints
    closed: Bools
    row: Ints


@dataclass(frozen=True, eq=False)
class _Breaks:
    """Lines at which something happens, row after row: row, t, kind (b,)."""

    row: Ints
    t: Floats
    kind: Ints


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Parts of curves over which nothing happens: row; start, end: of t; branch: -1 or 1, which of two meetings;
    is_round: all around; first, last: the nodes at both ends, which pieces share that go on in one another; flat (p,2):
    whether the two meetings are one at the ends."""

    row: Ints
    start: Floats
    end: Floats
    branch: Ints
    is_round: Bools
    first: Ints
    last: Ints
    flat: Bools


def ruled_meetings(
    ruled: Ruled, quadrics: Quadrics, picture: Picture | None, tolerance: float
) -> tuple[RuledCurves, Ints]:
    """The curves in which what lines sweep and quadrics in the same rows (k,) meet, and the rows left open: of those
    that have lines in common, or touch along them, or nearly do.

    Chords deviate from the curves by no more than the tolerance, measured in the picture, or in space.

    Notes
    -----
    A line meets a quadric where a v^2 + 2 b v + c = 0. Both meetings are one where b^2 - a c = 0; a curve begins or
    ends at a border of one of both. These places, zeros of trigonometric polynomials, are found first; between them
    each of both meetings is on both surfaces everywhere or nowhere, as one of them is in the middle. Degenerate: what
    is nearer than ONE_BREAK_OF_DOMAIN is one place.

    Source: Levin, Mathematical models for determining the intersections of quadric surfaces (1979).
    """
    open_ = _left_open(ruled, quadrics)
    breaks = _breaks(ruled, quadrics, open_)
    pieces = _pieces(ruled, quadrics, breaks, open_)
    return _curves(ruled, quadrics, pieces, picture, tolerance), np.flatnonzero(open_)


def _discriminant(ruled: Ruled, quadrics: Quadrics, row: Ints, t: Floats) -> Floats:
    """(n,) b^2 - a c."""
    a, b, c = quadrics.along(row, *ruled.lines(row, t))
    return b * b - a * c


def _left_open(ruled: Ruled, quadrics: Quadrics) -> Bools:
    """(k,) the rows all of whose lines, but for rounding, run along the quadric, or meet it once and infinitely far."""
    count = len(ruled.low)
    row = np.repeat(np.arange(count), LOOKED_AT)
    share = (np.arange(LOOKED_AT) + 0.5) / LOOKED_AT
    t = (ruled.low[:, None] + (ruled.high - ruled.low)[:, None] * share).reshape(-1)
    start, way = ruled.lines(row, t)
    p, d = quadrics.unit(row, start), np.einsum("ni,nij->nj", way, quadrics.inverse[row])
    size = dot(d, d) * (1.0 + dot(p, p))
    part = np.abs(_discriminant(ruled, quadrics, row, t)) / size
    return np.asarray(part.reshape(count, LOOKED_AT).max(axis=1, initial=0.0) <= ALONG_A_RULING)


def _breaks(ruled: Ruled, quadrics: Quadrics, open_: Bools) -> _Breaks:
    """All breaks, each once, and the ends of what does not go round."""
    low, high = ruled.low, ruled.high
    turn = np.full(len(low), np.pi)

    def zeros(values: Callable[[Ints, Floats], Floats], first: Floats, last: Floats, goes_round: bool) -> _Breaks:
        found = zeros_of(values, first, last, goes_round, NODE_OF_RULINGS)
        return _Breaks(found.row, found.t, np.where(found.single, Break.TURN, Break.NODE))

    parts = [zeros(lambda row, t: _discriminant(ruled, quadrics, row, t), low, high, ruled.goes_round)]
    for end in (0, 1):
        own = zeros(lambda row, w, end=end: quadrics.values(row, ruled.borders(row, end, w)[0]), -turn, turn, True)  # type: ignore[misc]
        parts.append(_Breaks(own.row, ruled.borders(own.row, end, own.t)[1], np.zeros_like(own.kind)))
        other = zeros(lambda row, w, end=end: ruled.heights(row, quadrics.rims(row, end, w)), -turn, turn, True)  # type: ignore[misc]
        at = ruled.parameter(other.row, quadrics.rims(other.row, end, other.t))
        parts.append(_Breaks(other.row, at, np.zeros_like(other.kind)))
    if not ruled.goes_round:
        every = np.arange(len(low))
        parts += [_Breaks(every, end, np.full(len(low), int(Break.BORDER))) for end in (low, high)]
    found = records.joined(parts)
    t = found.t
    if ruled.goes_round:
        t = high[found.row] - np.mod(high[found.row] - t, (high - low)[found.row])
    kept = np.flatnonzero(~open_[found.row] & (t >= low[found.row]) & (t <= high[found.row]))
    kept = kept[np.lexsort((t[kept], found.row[kept]))]
    return _once(_Breaks(found.row[kept], t[kept], found.kind[kept]), ONE_BREAK_OF_DOMAIN * (high - low))


def _once(breaks: _Breaks, near: Floats) -> _Breaks:
    """Breaks in order with those that are near each other as one; near (k,). Two turns are a node."""
    if not len(breaks.row):
        return breaks
    new = (np.diff(breaks.row, prepend=-1) > 0) | (np.diff(breaks.t, prepend=-np.inf) > near[breaks.row])
    first = np.flatnonzero(new)
    # What is known best about a place tells where it is.
    best = np.maximum.reduceat(breaks.kind, first)[np.cumsum(new) - 1] == breaks.kind
    t = np.add.reduceat(best * breaks.t, first) / np.add.reduceat(best.astype(np.float64), first)
    turns = np.add.reduceat((breaks.kind == Break.TURN).astype(np.intp), first)
    kind = np.maximum.reduceat(breaks.kind, first)
    return _Breaks(breaks.row[first], t, np.where(turns > 1, int(Break.NODE), kind))


def _pieces(ruled: Ruled, quadrics: Quadrics, breaks: _Breaks, open_: Bools) -> _Pieces:
    """The pieces between breaks, and all around without any, that are on both surfaces."""
    sizes = np.bincount(breaks.row, minlength=len(ruled.low))
    here = np.arange(len(breaks.row))
    there = ragged.following(ragged.offsets(sizes))
    wraps = there <= here
    ends = np.where(wraps, breaks.t[there] + (ruled.high - ruled.low)[breaks.row], breaks.t[there])
    if not ruled.goes_round:
        here, there, ends = here[~wraps], there[~wraps], ends[~wraps]
    whole = np.flatnonzero((sizes == 0) & ~open_ & ruled.goes_round)
    is_round = np.arange(len(here) + len(whole)) >= len(here)
    row = np.concatenate([breaks.row[here], whole])
    start = np.concatenate([breaks.t[here], ruled.low[whole]])
    end = np.concatenate([ends, ruled.high[whole]])
    none = np.full(len(whole), -1)
    at_start, at_end = np.concatenate([here, none]), np.concatenate([there, none])
    middle, no = 0.5 * (start + end), np.zeros(len(row), dtype=np.bool_)
    kind = np.append(breaks.kind, Break.BORDER)
    parts = []
    for branch in (-1, 1):
        v, real = _meeting(ruled, quadrics, row, middle, np.full(len(row), branch), no)
        p, d = ruled.lines(row, middle)
        with np.errstate(invalid="ignore"):
            on = np.flatnonzero(real & ruled.holds(row, middle, v) & quadrics.holds(row, p + v[:, None] * d))
        a, b = at_start[on], at_end[on]
        first, last = _node(kind, a, branch), _node(kind, b, branch)
        flat = np.stack([kind[a], kind[b]], axis=1) != Break.BORDER
        which = np.full(len(on), branch)
        parts.append(_Pieces(row[on], start[on], end[on], which, is_round[on], first, last, flat))
    return records.joined(parts)


def _node(kind: Ints, at: Ints, branch: int) -> Ints:
    """(n,) numbers of the ends of pieces at breaks of these kinds: both meetings have one where they are one; -1 where
    curves cross, and where there is no break, which is the last one."""
    number = 2 * at + np.where(kind[at] == Break.TURN, 0, branch > 0)
    return np.where((at < 0) | (kind[at] == Break.NODE), -1, number)


def _meeting(ruled: Ruled, quadrics: Quadrics, row: Ints, t: Floats, branch: Ints, flat: Bools) -> tuple[Floats, Bools]:
    """v (n,) of one of the two meetings of lines, and whether there is one; flat: both are one."""
    a, b, c = quadrics.along(row, *ruled.lines(row, t))
    square = b * b - a * c
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.where(flat, 0.0, np.sqrt(np.maximum(square, 0.0)))
        # Of b and the root with one sign nothing is cancelled.
        far = -(b + np.where(b >= 0.0, root, -root))
        v = np.where((b >= 0.0) == (branch < 0), far / a, c / far)
        v = np.where(flat, -b / a, v)
    return v, np.asarray((square > 0.0) & np.isfinite(v))


def _curves(
    ruled: Ruled, quadrics: Quadrics, pieces: _Pieces, picture: Picture | None, tolerance: float
) -> RuledCurves:
    """The pieces as refined polylines, joined where one goes on in another."""
    count = len(pieces.row)

    def points(rows: Floats) -> Floats:
        piece = rows[:, 0].astype(np.intp)
        row, share = pieces.row[piece], rows[:, 1]
        start, span = pieces.start[piece], pieces.end[piece] - pieces.start[piece]
        # Near a turn v runs as the root of the way to it.
        t = start + span * np.where(pieces.is_round[piece], share, 0.5 - 0.5 * np.cos(np.pi * share))
        first, last = pieces.flat[piece].T
        flat = ((share == 0.0) & first) | ((share == 1.0) & last)
        v, _ = _meeting(ruled, quadrics, row, t, pieces.branch[piece], flat)
        p, d = ruled.lines(row, t)
        return np.asarray(p + v[:, None] * d)

    share = np.tile(np.linspace(0.0, 1.0, BEGINNING), count)
    rows = np.stack([np.repeat(np.arange(count, dtype=np.float64), BEGINNING), share], axis=1)
    lines = Traces(rows, share == 1.0)

    def image(rows: Floats) -> Floats:
        return points(rows) if picture is None else picture(points(rows))

    traces = refined(lines, straight_between, image, tolerance, MOST_POINTS).lines
    piece = traces.points[:, 0].astype(np.intp)
    # Ends that pieces share are one point; every other point is by itself.
    number = np.arange(len(piece))
    starts, ends = traces.starts, traces.ends
    alone = len(piece)
    node = np.concatenate([pieces.first, pieces.last])
    at = np.concatenate([starts, ends])
    shared = np.flatnonzero(node >= 0)
    number[at[shared]] = alone + node[shared]
    loops = np.flatnonzero(pieces.is_round)
    number[ends[loops]] = starts[loops]
    segment = np.flatnonzero(~traces.last)
    edges = np.stack([number[segment], number[segment + 1]], axis=1)
    place, code = np.unique(number, return_index=True)
    branches = concat(edges)
    index = code[np.searchsorted(place, branches.points)]
    again = ragged.offsets(np.diff(branches.offsets) + branches.closed)
    first = branches.offsets[:-1]
    position = ragged.ranges(first, np.diff(again))
    position[again[1:][branches.closed] - 1] = first[branches.closed]
    index = index[position]
    return RuledCurves(points(traces.points[index]), again, branches.closed, pieces.row[piece[index[again[:-1]]]])
