"""Cubic Bézier paths: evaluated, split, flattened, measured."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT
from vectorplot.tolerances.of_lengths import LENGTH_SETTLED
from vectorplot.tolerances.of_parameters import ABOVE_WHOLE

MAX_FLAT_POINTS = 10_000_000
"""Flattening refuses to make more points than this."""

_LENGTH_ROUNDS = 30


@dataclass(frozen=True, eq=False)
class BezierPath:
    """A path of cubic Bézier segments, each beginning where the one before ends; a Curve where d is 3.

    Parameters
    ----------
    control : (k, 4, d) array of float
        The control points of the segments; d is 2 or 3.
    closed : bool
        Whether the end joins the start, smoothly or as a corner of a loop.
    error : float
        How far from the points it was fitted to it lies, at most.

    Raises
    ------
    InputError
        By part and split for parameters that are not inside, by flattened for a tolerance that is not positive or takes
        more than MAX_FLAT_POINTS points.

    Notes
    -----
    The parameter runs from 0 to k, by 1 in each segment.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> path = curves.BezierPath(np.array([[(0, 0), (0, 1), (2, 1), (2, 0)]], dtype=float))
    >>> path.points(np.array([0.0, 0.5, 1.0])).tolist()
    [[0.0, 0.0], [1.0, 0.75], [2.0, 0.0]]
    >>> before, after = path.split(0.5)
    >>> before.control[-1, -1].tolist(), len(path.flattened(tolerance=0.01))
    ([1.0, 0.75], 14)
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

    Parameters
    ----------
    control : (k, 4, d) array of float
        The control points of the segments of all paths, one after the other.
    offsets : (m+1,) array of int
        Path i has the segments offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        Which of them end where they start.
    error : (m,) array of float
        How far each lies from the points it was fitted to, at most.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> points = np.array([(0, 0), (3, 0), (0, 1), (0, 5)], dtype=float)
    >>> paths = curves.fitted_paths(points, np.array([0, 2, 4]), np.array([False, False]), tolerance=0.1)
    >>> [round(paths.path(i).length(), 9) for i in range(len(paths))]
    [3.0, 4.0]
    >>> paths.flattened(tolerance=0.1)[1].tolist()
    [0, 2, 4]
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
    """Polylines that lie within tolerance of paths: points (p,d) and their offsets (m+1,).

    Errors: InputError for a tolerance that is not positive, or one that takes more than MAX_FLAT_POINTS points.
    Degenerate: a path without segments gives no points; a straight segment one chord.
    Source: Wang's bound, Goldman, Pyramid Algorithms, section 5.6: a chord of width 1/n is off by at most the largest
    second difference times 6/8 over n squared.
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
