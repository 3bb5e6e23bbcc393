"""Cubic Bézier paths: evaluated, split, flattened, measured, clipped; how far they are off rational curves."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import least_squares, linear_solution, matmul
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.elementary import power
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take
from vectorplot.tolerances import ABOVE_WHOLE, LENGTH_SETTLED, ROUNDING

# Cubic Bézier paths: evaluated, split, flattened, measured.

MAX_FLAT_POINTS = 10_000_000
"""Flattening refuses to make more points than this."""

_LENGTH_ROUNDS = 30


@dataclass(frozen=True, eq=False)
class BezierPath:
    """A path of cubic Bézier segments, each beginning where the one before ends; a Curve where d is 3.

    control: (k, 4, d) the control points of the segments; closed: whether the end joins the start, smoothly or as a
    corner of a loop; error: how far from the points it was fitted to it lies, at most.
    """

    control: Floats
    closed: bool = False
    error: float = 0.0

    @property
    def start(self) -> float:
        """The first parameter, 0."""
        return 0.0

    @property
    def end(self) -> float:
        """The last parameter, the number of segments."""
        return float(len(self.control))

    def points(self, t: Floats) -> Floats:
        """(..., d) points at the parameters t (...)."""
        control, rest = self._located(t)
        return bezier_points(control, rest)

    def tangents(self, t: Floats) -> Floats:
        """(..., d) derivatives by t."""
        control, rest = self._located(t)
        return bezier_tangents(control, rest)

    def part(self, first: float, last: float) -> BezierPath:
        """The open path between two parameters. Errors: InputError unless first < last, both inside."""
        if not 0.0 <= first < last <= self.end:
            raise InputError(f"no part from {first:g} to {last:g} of a path from 0 to {self.end:g}")
        begin, end = int(np.floor(first)), int(np.ceil(last))
        control = self.control[begin:end].copy()
        control[-1] = split(control[-1], last - (end - 1))[0]
        scale = last - (end - 1) if end - 1 == begin else 1.0
        control[0] = split(control[0], (first - begin) / scale)[1]
        return BezierPath(control, False, self.error)

    def split(self, t: float) -> tuple[BezierPath, BezierPath]:
        """The open paths before and after a parameter inside."""
        return self.part(0.0, t), self.part(t, self.end)

    def flattened(self, tolerance: float) -> Floats:
        """(n,d) a polyline within tolerance; of a closed path the first point is repeated."""
        return flattened(self.control, np.array([0, len(self.control)]), tolerance)[0]

    def length(self) -> float:
        """The length, to about 1e-12 of it; at a cusp to about 1e-9."""
        return float(lengths(self.control).sum())

    def _located(self, t: Floats) -> tuple[Floats, Floats]:
        t = np.asarray(t, dtype=np.float64)
        segment = np.clip(np.floor(t).astype(np.intp), 0, len(self.control) - 1)
        return self.control[segment], t - segment


@dataclass(frozen=True, eq=False)
class BezierPaths:
    """Many paths of cubic Bézier segments.

    control: (k, 4, d) the control points of the segments of all paths, one after the other; offsets: (m+1,) path i has
    the segments offsets[i] to offsets[i+1]; closed: (m,) which of them end where they start; error: (m,) how far each
    lies from the points it was fitted to, at most.
    """

    control: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    error: Floats = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.closed)

    def path(self, index: int) -> BezierPath:
        """One of the paths."""
        first, last = self.offsets[index], self.offsets[index + 1]
        return BezierPath(self.control[first:last], bool(self.closed[index]), float(self.error[index]))

    def flattened(self, tolerance: float) -> tuple[Floats, Ints]:
        """Polylines within tolerance: points (p,d) and offsets (m+1,); closed ones repeat their first point."""
        return flattened(self.control, self.offsets, tolerance)


def bezier_points(control: Floats, t: Floats) -> Floats:
    """(..., d) points of segments (..., 4, d) at t (...), 0 to 1; exact at both ends."""
    t = t[..., None]
    s = 1.0 - t
    p0, p1, p2, p3 = (control[..., k, :] for k in range(4))
    return np.asarray(s * s * s * p0 + 3.0 * t * s * (s * p1 + t * p2) + t * t * t * p3)


def bezier_tangents(control: Floats, t: Floats) -> Floats:
    """(..., d) derivatives of segments (..., 4, d) at t (...)."""
    t = t[..., None]
    s = 1.0 - t
    step = 3.0 * np.diff(control, axis=-2)
    return np.asarray(s * s * step[..., 0, :] + 2.0 * s * t * step[..., 1, :] + t * t * step[..., 2, :])


def split(control: Floats, t: Floats | float) -> tuple[Floats, Floats]:
    """(..., 4, d) the parts of segments before and after t, a number or (...).

    Source: de Casteljau's scheme; Farin, Curves and Surfaces for CAGD, section 4.
    """
    t = np.asarray(t, dtype=np.float64)[..., None, None]
    rows = [control]
    for _ in range(3):
        rows.append((1.0 - t) * rows[-1][..., :-1, :] + t * rows[-1][..., 1:, :])
    before = np.concatenate([row[..., :1, :] for row in rows], axis=-2)
    after = np.concatenate([row[..., -1:, :] for row in reversed(rows)], axis=-2)
    return before, after


def flattened(control: Floats, offsets: Ints, tolerance: float) -> tuple[Floats, Ints]:
    """Polylines within tolerance of paths: points (p,d) and offsets (m+1,). Edge cases: a path without segments has no
    points; a straight segment is one chord. Errors: InputError for a tolerance not positive, or more than
    MAX_FLAT_POINTS points.
    Source: Wang's bound, Goldman, Pyramid Algorithms, section 5.6: a chord of width 1/n is off by at most 6/8 of the
    largest second difference over n squared.
    """
    if not tolerance > 0.0:
        raise InputError(f"flattening needs a positive tolerance, not {tolerance:g}")
    bend = np.linalg.norm(np.diff(control, n=2, axis=1), axis=2).max(axis=1, initial=0.0)
    chords = np.maximum(np.ceil(np.sqrt(0.75 * bend / tolerance) - ABOVE_WHOLE), 1.0)
    if chords.sum() > MAX_FLAT_POINTS:
        raise InputError(f"a tolerance of {tolerance:g} takes more than {MAX_FLAT_POINTS} points")
    count = chords.astype(np.intp)
    ends = np.cumsum(count)
    owner = ragged.owner(count)
    t = (np.arange(len(owner)) - (ends - count)[owner] + 1.0) / count[owner]
    points = bezier_points(control[owner], t)
    filled = np.flatnonzero(np.diff(offsets) > 0)
    heads = np.concatenate(([0], ends))[offsets[:-1]]
    points = np.insert(points, heads[filled], control[offsets[filled], 0], axis=0)
    sizes = np.diff(np.concatenate(([0], ends))[offsets]) + (np.diff(offsets) > 0)
    return points, ragged.offsets(sizes)


def lengths(control: Floats) -> Floats:
    """(k,) lengths of segments (k,4,d), by Gauss-Legendre integration; segments halve until it settles to 1e-12."""
    node, weight = np.polynomial.legendre.leggauss(16)
    total = np.zeros(len(control))
    owner = np.arange(len(control))
    scale = np.linalg.norm(np.diff(control, axis=1), axis=2).sum(axis=1)
    for _ in range(_LENGTH_ROUNDS):
        whole = _integrated(control, node, weight)
        before, after = split(control, 0.5)
        halves = _integrated(before, node, weight) + _integrated(after, node, weight)
        done = np.abs(whole - halves) <= LENGTH_SETTLED * scale[owner]
        np.add.at(total, owner[done], halves[done])
        control, owner = np.concatenate((before[~done], after[~done])), np.tile(owner[~done], 2)
        if not len(control):
            return total
    np.add.at(total, owner, _integrated(control, node, weight))
    return total


def _integrated(control: Floats, node: Floats, weight: Floats) -> Floats:
    t = np.broadcast_to((node + 1.0) / 2.0, (len(control), len(node)))
    speed = np.linalg.norm(bezier_tangents(control[:, None], t), axis=2)
    return np.asarray(matmul(speed, weight) / 2.0)


# The parts of Bézier paths inside a rectangle.

_HALVINGS = 55
"""From 1 down to the rounding of a double."""


def clipped_paths(paths: BezierPaths, low: Floats, high: Floats) -> tuple[BezierPaths, Ints]:
    """The parts of plane paths within the box low (2,) to high (2,), border included, in order, and the path each comes
    from. Segments are divided at the border, exact but for rounding; a closed path that is cut becomes open ones.
    Edge cases: what only touches the border, and paths without segments, leave nothing. Source: de Casteljau's scheme
    at the roots of the coordinate polynomials.
    """
    size = np.diff(paths.offsets)
    owner = ragged.owner(size)
    out = _any_outside(paths.control, low, high)
    leaves = np.bincount(owner[out], minlength=len(paths)) > 0
    if not leaves.any():
        which = np.flatnonzero(size)
        return take(paths, which), which
    whole = np.flatnonzero(~leaves & (size > 0))
    parts, source = _inside(paths, owner, out, np.flatnonzero(leaves[owner]), (low, high))
    both = joined((take(paths, whole), parts))
    owners = np.concatenate((whole, source))
    order = np.argsort(owners, kind="stable")
    return take(both, order), owners[order]


def _any_outside(points: Floats, low: Floats, high: Floats) -> Bools:
    """(n,) whether any of the points (n,k,2) is outside the box."""
    return np.asarray(((points < low) | (points > high)).any(axis=(1, 2)))


def _inside(
    paths: BezierPaths, owner: Ints, out: Bools, segment: Ints, box: tuple[Floats, Floats]
) -> tuple[BezierPaths, Ints]:
    """The parts of the paths of these segments that are inside, and the path that each comes from."""
    control, piece = _divided(paths.control[segment], out[segment], box)
    owner = owner[segment][piece]
    middle = bezier_points(control, np.full(len(control), 0.5))
    kept = ~_any_outside(middle[:, None], *box)
    index = _from_outside(owner, kept, paths.closed)
    control, owner, kept = control[index], owner[index], kept[index]
    goes_on = np.zeros(len(kept), dtype=np.bool_)
    goes_on[1:] = kept[1:] & kept[:-1] & (owner[1:] == owner[:-1])
    begin = np.flatnonzero((kept & ~goes_on)[kept])
    source = owner[kept][begin]
    broken = np.bincount(owner[~kept], minlength=len(paths)) > 0
    # Rounding may leave a cut beside the border it lies on.
    control[:, ::3] = np.clip(control[:, ::3], *box)
    offsets = np.append(begin, int(kept.sum())).astype(np.intp)
    return BezierPaths(control[kept], offsets, paths.closed[source] & ~broken[source], paths.error[source]), source


def _from_outside(owner: Ints, kept: Bools, closed: Bools) -> Ints:
    """The order of pieces in which a closed path begins with one that is not kept, if there is one."""
    first = np.flatnonzero(np.concatenate(([True], owner[1:] != owner[:-1])))
    count = np.diff(np.append(first, len(owner)))
    dropped = np.append(np.flatnonzero(~kept), len(owner))
    start = dropped[np.searchsorted(dropped, first)] - first
    start = np.where(closed[owner[first]] & (start < count), start, 0)
    local = np.arange(len(owner)) - np.repeat(first, count) + np.repeat(start, count)
    return np.asarray(np.repeat(first, count) + local % np.repeat(count, count), dtype=np.intp)


def _divided(control: Floats, out: Bools, box: tuple[Floats, Floats]) -> tuple[Floats, Ints]:
    """Segments divided where those that reach out cross the border, and the number of the segment of each piece."""
    number = np.flatnonzero(out)
    some = control[number]
    roots = [_roots(some[:, :, axis] - border[axis]) for border in box for axis in (0, 1)]
    cuts = np.sort(np.concatenate(roots, axis=1), axis=1)
    row, column = np.nonzero(cuts < 1.0)
    piece = np.concatenate((np.arange(len(control)), number[row]))
    low = np.concatenate((np.zeros(len(control)), cuts[row, column]))
    order = np.lexsort((low, piece))
    piece, low = piece[order], low[order]
    last = np.append(piece[1:] != piece[:-1], True)
    high = np.where(last, 1.0, np.roll(low, -1))
    before = np.where(last[:, None, None], control[piece], split(control[piece], high)[0])
    return np.where((low > 0.0)[:, None, None], split(before, low / high)[1], before), piece


def _roots(values: Floats) -> Floats:
    """(n,3) where cubic polynomials with these Bernstein coefficients (n,4) change their sign between 0 and 1; infinite
    where they do not. They are bisected between the places where the polynomials turn."""
    step = np.diff(values, axis=1)
    a, b, c = step[:, 0] - 2.0 * step[:, 1] + step[:, 2], 2.0 * (step[:, 1] - step[:, 0]), step[:, 0]
    with np.errstate(all="ignore"):
        q = -0.5 * (b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(b * b - 4.0 * a * c))
        turns = np.nan_to_num(np.stack((q / a, c / q), axis=1), nan=0.0, posinf=0.0, neginf=0.0)
    knots = np.concatenate((np.zeros((len(a), 1)), np.sort(np.clip(turns, 0.0, 1.0), axis=1), np.ones((len(a), 1))), 1)
    below = bezier_points(values[:, None, :, None], knots)[..., 0] < 0.0
    piece, turn = np.nonzero(below[:, 1:] != below[:, :-1])
    start, coefficients = below[piece, turn], values[piece, :, None]

    def alike(which: Ints, t: Floats) -> Bools:
        return np.asarray((bezier_points(coefficients[which], t)[:, 0] < 0.0) == start[which])

    root = np.full((len(values), 3), np.inf)
    before, after = bisected(alike, knots[piece, turn], knots[piece, turn + 1], _HALVINGS)
    middle = 0.5 * (before + after)
    root[piece, turn] = np.where((middle > 0.0) & (middle < 1.0), middle, np.inf)
    return root


# How far a cubic is off a piece of a rational curve that has the same ends and the same derivatives there.
#
# Times the weight of the curve the difference is a polynomial with double zeros at both ends: t^2 (1 - t)^2 q(t). So
# many places as q has coefficients tell all of it, and in Bernstein's basis it is nowhere larger than its coefficients
# are.
#
# Source: Farin, Curves and Surfaces for CAGD, sections 6.5 (cubic Hermite interpolation) and 13 (rational curves).

MOST_OF_ENDS = 1.0 / 16.0
"""The largest value of t^2 (1 - t)^2 between 0 and 1."""

HIGHEST = 12
"""The degree up to which Bernstein's coefficients are told from values without loss."""


def places(degree: int, rational: bool) -> Floats:
    """(c,) the parameters from 0 to 1 at which the difference has to be known: none where the cubic is the curve."""
    count = degree if rational else max(degree - 3, 0)
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / max(count, 1)))


def cubic_error(degree: int, off: Floats, weights: Floats | None) -> Floats:
    """(k,) how far cubics are off curves of a degree, at most: off (c,k,d) is how far they are at the places, weights
    (c+2,k) those of the curves at the start, at the places and at the end, None where they have none.

    Edge cases: infinite where the weights may vanish, and for degrees of more than HIGHEST.
    """
    count, many = off.shape[:2]
    if degree > HIGHEST:
        return np.full(many, np.inf)
    if not count:
        return np.zeros(many)
    t = places(degree, weights is not None)
    rest = off / (t * t * (1.0 - t) ** 2)[:, None, None]
    least = np.ones(many)
    if weights is not None:
        rest = rest * weights[1:-1, :, None]
        whole = np.concatenate([[0.0], t, [1.0]])
        least = least_squares(bernstein(degree, whole), weights, rcond=ROUNDING)[0].min(axis=0)
    own = linear_solution(bernstein(count - 1, t), rest.reshape(count, -1)).reshape(rest.shape)
    size = MOST_OF_ENDS * np.sqrt((own * own).sum(axis=2)).max(axis=0)
    return np.where(least > 0.0, size / np.where(least > 0.0, least, 1.0), np.inf)


def bernstein(degree: int, t: Floats) -> Floats:
    """(c,degree+1) Bernstein's polynomials at parameters (c,)."""
    k = np.arange(degree + 1)
    binomials = np.cumprod(np.concatenate([[1.0], (degree - k[:-1]) / (k[:-1] + 1.0)]))
    return np.asarray(binomials * power(t[:, None], k) * power(1.0 - t[:, None], degree - k))
