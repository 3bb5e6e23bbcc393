"""What covers hide of pieces of arcs, pair by pair: between the roots of polynomials along each piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.visibility.quadrics import bernstein
from vectorplot.visibility.quadrics.arc_pieces import Pieces
from vectorplot.visibility.quadrics.bodies.covers import Covers


@dataclass(frozen=True, eq=False)
class Zones:
    """Hidden parts of pieces: pair (z,) which one, from low to high (z,), 0 to 1 along the piece."""

    pair: Ints
    low: Floats
    high: Floats


def hidden_zones(pieces: Pieces, covers: Covers, piece: Ints, cover: Ints, tolerance: float) -> Zones:
    """The zones of pairs (piece, cover).

    A linear form along a piece has degree two, the difference of squares degree four. Where no coefficient is positive
    nothing is hidden, where none is negative all of it may be; else a part between two roots is decided at its middle.
    What is no larger than the tolerance counts as zero, and zero does not hide.
    """
    pair, control = np.arange(len(piece)), pieces.control[:, :, piece]
    linear = np.empty((len(covers.linear), 3, len(piece)))
    some, whole = np.ones(len(piece), dtype=np.bool_), np.ones(len(piece), dtype=np.bool_)
    for number, form in enumerate(covers.linear):
        c = _along(form[:, cover], control)
        c[np.abs(c) <= tolerance] = 0.0
        some &= (c > 0.0).any(axis=0)
        whole &= (c >= 0.0).all(axis=0)
        linear[number] = c
    kept = np.flatnonzero(some)
    pair, cover, control, whole, linear = pair[kept], cover[kept], control[:, :, kept], whole[kept], linear[:, :, kept]
    square = np.zeros((5, 0))
    if len(covers.squares):
        square = _difference(covers, cover, control)
        kept = np.flatnonzero((square > 0.0).any(axis=0))
        pair, whole, linear, square = pair[kept], whole[kept], linear[:, :, kept], square[:, kept]
        whole = whole & (square >= 0.0).all(axis=0)
    all_of_it = pair[whole]
    rest = np.flatnonzero(~whole)
    found, low, high = _between_roots(linear[:, :, rest], square[:, rest] if len(square[0]) else square)
    return Zones(
        np.concatenate([all_of_it, pair[rest][found]]),
        np.concatenate([np.zeros(len(all_of_it)), low]),
        np.concatenate([np.ones(len(all_of_it)), high]),
    )


def _along(form: Floats, control: Floats) -> Floats:
    """(3,n) a linear form (4,n) along pieces with control points (3,4,n)."""
    return np.asarray(
        form[0] * control[:, 0] + form[1] * control[:, 1] + form[2] * control[:, 2] + form[3] * control[:, 3]
    )


def _difference(covers: Covers, cover: Ints, control: Floats) -> Floats:
    """(5,n) the square of the first form less those of the others, snapped to zero."""
    first = bernstein.squares(_along(covers.squares[0][:, cover], control))
    square, size = first.copy(), np.abs(first).max(axis=0)
    slack = covers.slack[cover] * size
    for form in covers.squares[1:]:
        other = bernstein.squares(_along(form[:, cover], control))
        square -= other
        np.maximum(size, np.maximum(other[0], other[4]), out=size)
    square[np.abs(square) <= np.maximum(slack, ROUNDING * size)] = 0.0
    return square


def _between_roots(linear: Floats, square: Floats) -> tuple[Ints, Floats, Floats]:
    """Which column (z,), and from where to where (z,), all the polynomials (l,3,n) and (5,n) are positive."""
    count = linear.shape[2]
    columns = [np.zeros((1, count)), np.ones((1, count)), *(bernstein.roots_of_two(c) for c in linear)]
    if square.shape[1]:
        of, root = bernstein.roots_of_four(square)
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
        inside &= bernstein.value_of_two(c[:, None], middle) > 0.0
    if square.shape[1]:
        inside &= bernstein.value_of_four(square[:, None], middle) > 0.0
    part, column = np.nonzero(inside)
    return column, ends[part, column], ends[part + 1, column]
