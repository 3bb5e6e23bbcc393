"""The pieces of a curve f(u, v) = 0 in triangles, between points on their sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.zero_cells import Lattice
from vectorplot.features.zeros.zero_crossings import bracketed_zeros, cubic_parabola, zero_of_cubic_parabola
from vectorplot.features.zeros.zero_triangles import Corners
from vectorplot.geometry.components import any_component, greatest_component, least_component
from vectorplot.tolerances.of_parameters import FIRST_GUESS
from vectorplot.tolerances.of_values import FALLS_BESIDE, GRID_NOISE, ZERO_RESIDUAL

SETTLED = ZERO_RESIDUAL / 16.0
"""Part of the scale of f below which a point need not come nearer to zero, however small f is beside it."""


@dataclass(frozen=True, eq=False)
class Segments:
    """points (p,3); pairs (q,2) of points, f positive on the left of first to second; poles (s,): how many changes of
    sign of each field are no zeros. A side of triangles along which f is zero without changing its sign is none."""

    points: Floats
    pairs: Ints
    poles: Ints


@dataclass(frozen=True, eq=False)
class Sides:
    """Sides of triangles that change sign, of lattices with the numbers of (k,): lattice positions start and along
    (k,2), values and slopes (k,2) at both ends, slopes by the parameter that runs from 0 to 1."""

    of: Ints
    start: Ints
    along: Ints
    w: Floats
    slope: Floats


def crossing_segments(lattice: Lattice, corners: Corners, scale: Floats, zero: Floats) -> Segments:
    """The piece of the curve in every triangle that changes sign; scale and zero (s,): of the fields.

    A side is one for both its triangles, and so is the point on it. Zero counts as positive, so a curve through a
    corner or along a side is met in one triangle of those around it, as one line.
    Source: Glaeser, section 8.4; errata G8-08, G8-14.
    """
    w = np.where(np.abs(corners.w) <= GRID_NOISE * scale[corners.of, None], 0.0, corners.w)
    negative = w < 0.0
    count = negative.sum(axis=1)
    row = np.flatnonzero((count % 3 != 0) & ~any_component(np.isnan(w)))
    alone = count[row] == 1
    lone = np.where(alone, negative[row].argmax(axis=1), (~negative[row]).argmax(axis=1))
    # The two sides at the lone corner; a positive one is on the left on the way from the first to the second.
    a, b = np.concatenate([lone, lone]), np.concatenate([(lone + 1) % 3, (lone + 2) % 3])
    rows = np.concatenate([row, row])
    ids = lattice.ids((corners.of[rows, None], corners.i[rows], corners.j[rows]))
    each = np.arange(len(rows))
    swap = ids[each, a] > ids[each, b]
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    first, side = _distinct(ids[each, a], ids[each, b])
    sides = _sides(corners, w, rows[first], a[first], b[first])
    points, genuine = _zeros(lattice, sides, scale, zero)
    one, two = side[: len(row)], side[len(row) :]
    pairs = np.stack([np.where(alone, two, one), np.where(alone, one, two)], axis=1)
    poles = np.bincount(sides.of[~genuine], minlength=len(scale))
    pairs = pairs[genuine[pairs].all(axis=1)]
    double = _there_and_back(_zero_corners(lattice, sides)[pairs])
    idle = np.zeros(len(points), dtype=np.bool_)
    idle[pairs[double]] = True
    idle[pairs[~double]] = False
    return Segments(points[~idle], (np.cumsum(~idle) - 1)[pairs[~double]], poles)


def _zero_corners(lattice: Lattice, sides: Sides) -> Ints:
    """(k,) the identity of the end of each side at which f is zero, -1 where there is none."""
    i, j = np.where(sides.w[:, :1] == 0.0, sides.start, sides.start + sides.along).T
    return np.where((sides.w == 0.0).any(axis=1), lattice.ids((sides.of, i, j)), -1)


def _there_and_back(corners: Ints) -> Bools:
    """(q,) pieces between corners (q,2) that are zeros of f, with f negative on both sides: they are there in both
    directions, once for each triangle beside them."""
    low, high = least_component(corners), greatest_component(corners)
    rows = np.flatnonzero((low >= 0) & (low < high))
    _, piece = np.unique(np.stack([low[rows], high[rows]], axis=1), axis=0, return_inverse=True)
    double = np.zeros(len(corners), dtype=np.bool_)
    double[rows] = np.bincount(piece.ravel())[piece.ravel()] > 1
    return double


def _distinct(low: Ints, high: Ints) -> tuple[Ints, Ints]:
    """Where each different pair stands first, and (k,) which of them each pair is."""
    at = np.unique(np.concatenate([low, high]), return_inverse=True)[1].ravel()
    key = at[: len(low)] * (len(at) + 1) + at[len(low) :]
    _, first, back = np.unique(key, return_index=True, return_inverse=True)
    return first, back.ravel()


def _sides(corners: Corners, w: Floats, row: Ints, a: Ints, b: Ints) -> Sides:
    """The sides from corner a to corner b of triangles."""
    start, end = (np.stack([corners.i[row, k], corners.j[row, k]], axis=1) for k in (a, b))
    along = end - start
    slope = [corners.slope_u[row, k] * along[:, 0] + corners.slope_v[row, k] * along[:, 1] for k in (a, b)]
    return Sides(corners.of[row], start, along, np.stack([w[row, a], w[row, b]], axis=1), np.stack(slope, axis=1))


def _zeros(lattice: Lattice, sides: Sides, scale: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """The points (k,3) of the curve on the sides, and which of them are zeros of f indeed."""
    w0, w1 = sides.w.T
    size = np.maximum(np.abs(w0), np.abs(w1))
    scale, zero = scale[sides.of], zero[sides.of]
    small = np.minimum(np.maximum(ZERO_RESIDUAL / 8.0 * size, SETTLED * scale), zero)

    def at(t: Floats, which: Ints) -> Floats:
        i, j = (sides.start[which] + t[:, None] * sides.along[which]).T
        return lattice.values_beside(lattice.points((sides.of[which], i, j)))

    t, rest = bracketed_zeros(at, w0, w1, _guess(sides), small)
    exact = (w0 == 0.0) | (w1 == 0.0)
    t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
    falls = np.abs(rest) <= np.maximum(
        FALLS_BESIDE * np.minimum(np.abs(w0), np.abs(w1)), _rounding(lattice, sides) + zero
    )
    i, j = (sides.start + t[:, None] * sides.along).T
    return lattice.points((sides.of, i, j)), np.asarray(exact | falls, dtype=np.bool_)


def _rounding(lattice: Lattice, sides: Sides) -> Floats:
    """(k,) what the rounding of the parameters alone makes of f: far from zero there are few of them in a cell."""
    field = lattice.field
    part = (np.spacing(np.abs(field.start) + field.size) * lattice.shape / field.size)[sides.of] / np.abs(
        sides.along
    ).max(axis=1)[:, None]
    return np.asarray(4.0 * part.sum(axis=1) * np.abs(sides.w[:, 1] - sides.w[:, 0]))


def _guess(sides: Sides) -> Floats:
    """Zeros of the cubic parabolas through the line elements at both ends; of the chords where slopes are unknown."""
    w0, w1 = sides.w.T
    guess = w0 / (w0 - w1)
    known = np.isfinite(sides.slope).all(axis=1)
    cubic = cubic_parabola(w0[known], w1[known], sides.slope[known, 0], sides.slope[known, 1])
    guess[known] = zero_of_cubic_parabola(cubic, tolerance=FIRST_GUESS)
    return np.asarray(guess)
