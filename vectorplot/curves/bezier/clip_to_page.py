"""The parts of Bézier paths inside a rectangle."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier.paths import BezierPaths, bezier_points, split
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import joined, some

_HALVINGS = 55
"""From 1 down to the rounding of a double."""


def clipped_paths(paths: BezierPaths, low: Floats, high: Floats) -> tuple[BezierPaths, Ints]:
    """The parts of plane paths inside the box from low (2,) to high (2,), its border included, and the path that each
    comes from.

    Segments are divided where they cross the border, which is exact but for rounding.
    Paths keep their order; a closed path that is cut becomes open ones.
    Degenerate: what only touches the border leaves nothing; a path without segments is left out.
    Source: de Casteljau's scheme at the roots of the coordinates' polynomials.
    """
    size = np.diff(paths.offsets)
    owner = ragged.owner(size)
    out = _any_outside(paths.control, low, high)
    leaves = np.bincount(owner[out], minlength=len(paths)) > 0
    if not leaves.any():
        which = np.flatnonzero(size)
        return some(paths, which), which
    whole = np.flatnonzero(~leaves & (size > 0))
    parts, source = _inside(paths, owner, out, np.flatnonzero(leaves[owner]), (low, high))
    both = joined((some(paths, whole), parts))
    owners = np.concatenate((whole, source))
    order = np.argsort(owners, kind="stable")
    return some(both, order), owners[order]


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
    low, high = knots[:, :-1].copy(), knots[:, 1:].copy()
    coefficients = values[:, None, :, None]
    below, above = (bezier_points(coefficients, t)[..., 0] < 0.0 for t in (low, high))
    changes = below != above
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        left = (bezier_points(coefficients, middle)[..., 0] < 0.0) == below
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    root = 0.5 * (low + high)
    return np.where(changes & (root > 0.0) & (root < 1.0), root, np.inf)
