"""Smooth Bézier paths through polylines and curves, within a tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier.paths import BezierPath, BezierPaths
from vectorplot.curves.bezier.spans import Spans, fitted_spans, measured_spans
from vectorplot.curves.bezier.tangents import Directions, FitLines, directions
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arccos, power, tan
from vectorplot.geometry.polylines import Polylines, closed_round
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import FIT_OF_TOLERANCE
from vectorplot.tolerances.of_parameters import JUST_BEFORE

CORNER_ANGLE = np.radians(30.0)
"""A polyline that turns by more at one point has a corner there."""

_WINDOW = 8.0
"""Tangents are taken over so many tolerances to both sides, at least to the next points."""

_MOST_PARTS = 8
_MERGE_ROUNDS = 4
_CURVE_SAMPLES = 64
_MOST_SAMPLES = 1 << 17
_FINER = 4
"""A curve is compared with so many times the samples that its path is fitted to."""


def fitted(
    points: Floats,
    tangents: Floats | None = None,
    *,
    tolerance: float,
    closed: bool = False,
    corner_angle: float = CORNER_ANGLE,
) -> BezierPath:
    """The path of fitted_paths for one polyline: points (n,d) with d 2 or 3, tangents (n,d) or None."""
    points = np.asarray(points, dtype=np.float64)
    offsets = np.array([0, len(points)])
    flags = np.array([closed])
    return fitted_paths(points, offsets, flags, tangents, tolerance=tolerance, corner_angle=corner_angle).path(0)


def fitted_paths(
    points: Floats,
    offsets: Ints,
    closed: Bools,
    tangents: Floats | None = None,
    *,
    tolerance: float,
    corner_angle: float = CORNER_ANGLE,
    sag: float = np.inf,
) -> BezierPaths:
    """Smooth Bézier paths within a tolerance of polylines, all fitted at once.

    Parameters
    ----------
    points : (p, d) array of float
        The points of all polylines, one after the other; d is 2 or 3.
    offsets : (m+1,) array of int
        Polyline i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first, which is not repeated (it may be).
    tangents : (p, d) or (p, 2, d) array of float, optional
        Forwards and of any length; zero where the curve has a corner, NaN where nothing is known. Two of them: with
        which the curve arrives at the point and with which it leaves it.
    tolerance : float
        How far a point may be off its path, in the units of the points.
    corner_angle : float
        A polyline that turns by more at one point, where no tangents are known, has a corner there; in radians, 30
        degrees where nothing is said.
    sag : float
        How far the polylines are off the curves that they sample, at most.

    Returns
    -------
    BezierPaths
        One path for each polyline, with its error.

    Raises
    ------
    InputError
        For wrong shapes, points that are not finite, a tolerance that is not positive.

    Notes
    -----
    Every point lies within tolerance of its path, as the paths' error says; between two points the path keeps within
    tolerance, plus c/2 tan(a), of their chord c, where a is the angle between chord and tangents: the room a smooth
    curve through the points takes, at most sag. The direction is continuous except at ends and corners, and where a
    chord has to stay straight to be so near. Corners are where known tangents say so; where none are known, where the
    polyline turns by more than corner_angle at one point, or by more than that of a smooth curve with chords so near.

    Degenerate: repeated points count once; two points, or points on a straight line, give one straight segment; a
    single point a segment of length 0; a line without points a path without segments.

    Source: Schneider, An algorithm for automatically fitting digitized curves, Graphics Gems (1990), for tangents first
    and handles by least squares; spans that fail are divided evenly by the sixth-order law of their error.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> t = np.linspace(0.0, np.pi, 50)
    >>> half = np.stack([np.cos(t), np.sin(t)], axis=1)
    >>> paths = curves.fitted_paths(half, np.array([0, 50]), np.array([False]), tolerance=1e-3)
    >>> len(paths), bool(paths.error[0] <= 1e-3), round(paths.path(0).length(), 2)
    (1, True, 3.14)
    """
    _check(points, offsets, tangents, tolerance)
    lines, given, kept = _lines(np.asarray(points, dtype=np.float64), offsets, closed, tangents)
    if not len(lines.first):
        none = np.zeros((0, 4, points.shape[1]))
        return BezierPaths(none, np.zeros(len(closed) + 1, dtype=np.intp), closed.copy(), np.zeros(len(closed)))
    fit = _Fit.of(lines, given, tolerance, corner_angle, sag)
    spans = fit.merged(fit.divided(fit.first_knots()))
    count = np.zeros(len(closed), dtype=np.intp)
    error = np.zeros(len(closed))
    owner = lines.line[spans.first]
    count[kept] = np.bincount(owner, minlength=len(kept))
    error[kept] = np.maximum.reduceat(spans.error, np.searchsorted(owner, np.arange(len(kept))))
    return BezierPaths(fit.control(spans), ragged.offsets(count), closed.copy(), error)


def fitted_curve(curve: Curve, *, tolerance: float) -> BezierPath:
    """A smooth Bézier path within a tolerance of a curve, from its start to its end.

    Parameters
    ----------
    curve : Curve
        With points and tangents that are finite.
    tolerance : float
        How far the path may be off the curve, in the units of the curve.

    Returns
    -------
    BezierPath
        With its error; closed where the curve is.

    Raises
    ------
    InputError
        For a curve with points that are not finite, or one that is not within tolerance with 2^17 samples; for a
        tolerance that is not positive.

    Notes
    -----
    The curve is sampled with its tangents, ever finer, until a path fitted to the samples lies within tolerance of
    three more between each two of them.

    Source: as of fitted_paths.

    Examples
    --------
    >>> from vectorplot import curves
    >>> path = curves.fitted_curve(curves.Helix(radius=1.0, rise=0.1), tolerance=1e-3)
    >>> bool(path.error <= 1e-3), path.points(path.end).round(9).tolist() == [1.0, 0.0, 0.628318531]
    (True, True)
    """
    count = _CURVE_SAMPLES
    while count <= _MOST_SAMPLES:
        samples = [_sampled(curve, n) for n in (count, _FINER * count)]
        _check(samples[0][0], np.array([0, count + 1]), samples[0][1], tolerance)
        coarse, fine = (
            _Fit.of(_open_line(*s, closed=curve.closed), np.stack([s[1].T] * 2), tolerance, CORNER_ANGLE)
            for s in samples
        )
        spans = coarse.merged(coarse.divided(coarse.first_knots()))
        check = measured_spans(fine.lines, fine.tangent, fine.room, spans, (_FINER * spans.first, _FINER * spans.last))
        if check.error.max() <= tolerance:
            return BezierPath(coarse.control(spans), curve.closed, float(check.error.max()))
        count *= 2
    raise InputError(f"the curve is not within {tolerance:g} of a path through {_MOST_SAMPLES} samples")


@dataclass(frozen=True, eq=False)
class _Fit:
    """Lines, their tangents, the room (n,) between each point and the next, and the tolerance."""

    lines: FitLines
    tangent: Directions
    room: Floats
    tolerance: float

    @classmethod
    def of(cls, lines: FitLines, given: Floats, tolerance: float, corner_angle: float, sag: float = np.inf) -> _Fit:
        total = lines.length[lines.last] - lines.length[lines.first]
        tangent = directions(lines, given, np.minimum(_WINDOW * tolerance, total / 8.0), corner_angle, tolerance, sag)
        chord = np.diff(lines.points, axis=1, append=lines.points[:, -1:])
        size = np.sqrt((chord * chord).sum(axis=0))
        chord /= np.where(size > 0.0, size, 1.0)
        ahead = np.roll(tangent.arriving, -1, axis=1)
        cosine = np.minimum((tangent.leaving * chord).sum(axis=0), (ahead * chord).sum(axis=0))
        room = size / 2.0 * tan(arccos(np.clip(cosine, 0.5, 1.0)))
        return cls(lines, tangent, np.minimum(room, sag), tolerance)

    def first_knots(self) -> Bools:
        """(n,) ends and corners, and the quarters of smooth loops."""
        lines = self.lines
        knots = self.tangent.corner.copy()
        cornered = np.bincount(lines.line[knots], minlength=len(lines.first)) > 0
        knots[lines.first] = knots[lines.last] = True
        loop = np.flatnonzero(lines.closed & ~cornered)
        start, end = lines.length[lines.first[loop]], lines.length[lines.last[loop]]
        quarters = start + (end - start) * (np.array([[0.25], [0.5], [0.75]]) - JUST_BEFORE)
        knots[np.searchsorted(lines.length, quarters)] = True
        return knots

    def spans(self, first: Ints, last: Ints) -> Spans:
        """Segments from points to points."""
        return fitted_spans(self.lines, self.tangent, self.room, self.tolerance, (first, last))

    def divided(self, knots: Bools) -> Spans:
        """Segments between knots and as many more knots as they need."""
        first = _between(self.lines, knots)
        found = []
        while len(first[0]):
            spans = self.spans(*first)
            done = (spans.excess <= self.tolerance) | (spans.last - spans.first <= 1)
            found.append(_chosen(spans, done))
            first = self._parts(_chosen(spans, ~done))
        spans = _joined(found)
        return _chosen(spans, np.argsort(spans.first, kind="stable"))

    def _parts(self, spans: Spans) -> tuple[Ints, Ints]:
        """Smaller spans in place of those that fail, of equal length."""
        ratio = np.nan_to_num(spans.excess / self.tolerance, nan=np.inf)
        parts = np.clip(np.ceil(power(ratio, 1.0 / 6.0) * 1.05), 2, _MOST_PARTS).astype(np.intp)
        parts = np.minimum(parts, spans.last - spans.first)
        knots = np.zeros(len(self.lines.line), dtype=np.bool_)
        owner = ragged.owner(parts - 1)
        number = ragged.place(parts - 1) + 1
        length = self.lines.length
        start, end = length[spans.first[owner]], length[spans.last[owner]]
        # A little less than the part: where a point lies on it, rounding does not choose.
        index = np.searchsorted(length, start + (end - start) * (number / parts[owner] - JUST_BEFORE))
        knots[np.clip(index, spans.first[owner] + 1, spans.last[owner] - 1)] = True
        inside = np.flatnonzero(knots)
        first = np.sort(np.concatenate((spans.first, inside)))
        last = np.sort(np.concatenate((spans.last, inside)))
        return first, last

    def merged(self, spans: Spans) -> Spans:
        """Fewer segments: neighbours that one segment replaces within the tolerance."""
        for turn in range(_MERGE_ROUNDS):
            size = self.lines.length[spans.last] - self.lines.length[spans.first]
            error = np.maximum(spans.excess, FIT_OF_TOLERANCE * self.tolerance)
            both = size[:-1] + size[1:]
            with np.errstate(all="ignore"):
                guess = np.maximum(error[:-1] * power(both / size[:-1], 4), error[1:] * power(both / size[1:], 4))
            smooth = (spans.last[:-1] == spans.first[1:]) & ~self.tangent.corner[spans.last[:-1]]
            smooth &= self.lines.line[spans.first[:-1]] == self.lines.line[spans.first[1:]]
            pair = np.flatnonzero(smooth & (guess <= 4.0 * self.tolerance))
            pair = pair[pair % 2 == turn % 2]
            if not len(pair):
                continue
            trial = self.spans(spans.first[pair], spans.last[pair + 1])
            good = trial.excess <= self.tolerance
            keep = np.ones(len(spans.first), dtype=np.bool_)
            keep[pair[good]] = keep[pair[good] + 1] = False
            spans = _joined([_chosen(spans, keep), _chosen(trial, good)])
            spans = _chosen(spans, np.argsort(spans.first, kind="stable"))
        return spans

    def control(self, spans: Spans) -> Floats:
        """(k,4,d) control points."""
        start, end = self.lines.points[:, spans.first], self.lines.points[:, spans.last]
        one = start + spans.handles[0] * self.tangent.leaving[:, spans.first]
        two = end - spans.handles[1] * self.tangent.arriving[:, spans.last]
        # Between two points nothing is known of the curve but that it is near the chord.
        straight = (spans.last - spans.first <= 1) & (spans.excess > self.tolerance)
        one = np.where(straight, start + (end - start) / 3.0, one)
        two = np.where(straight, end - (end - start) / 3.0, two)
        return np.stack((start, one, two, end)).transpose(2, 0, 1)


def _between(lines: FitLines, knots: Bools) -> tuple[Ints, Ints]:
    index = np.flatnonzero(knots)
    same = lines.line[index[:-1]] == lines.line[index[1:]]
    return index[:-1][same], index[1:][same]


def _chosen(spans: Spans, which: Bools | Ints) -> Spans:
    return Spans(
        spans.first[which], spans.last[which], spans.handles[:, which], spans.error[which], spans.excess[which]
    )


def _joined(parts: list[Spans]) -> Spans:
    return Spans(
        np.concatenate([part.first for part in parts]),
        np.concatenate([part.last for part in parts]),
        np.concatenate([part.handles for part in parts], axis=1),
        np.concatenate([part.error for part in parts]),
        np.concatenate([part.excess for part in parts]),
    )


def _check(points: Floats, offsets: Ints, tangents: Floats | None, tolerance: float) -> None:
    points = np.asarray(points)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InputError(f"points to fit must have shape (n, 2) or (n, 3), not {points.shape}")
    if len(offsets) == 0 or offsets[0] != 0 or offsets[-1] != len(points) or (np.diff(offsets) < 0).any():
        raise InputError("offsets must run from 0 to the number of points")
    both = (len(points), 2, points.shape[1])
    if tangents is not None and np.shape(tangents) not in (points.shape, both):
        expected = f"the shape {points.shape} of the points or {both}"
        raise InputError(f"tangents must have {expected}, not {np.shape(tangents)}")
    if not (tolerance > 0.0 and np.isfinite(tolerance)):
        raise InputError(f"a fit needs a positive tolerance, not {tolerance:g}")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise InputError(f"point {int(np.argmax(bad)) + 1} of those to fit is not finite")


def _lines(points: Floats, offsets: Ints, closed: Bools, tangents: Floats | None) -> tuple[FitLines, Floats, Ints]:
    """Lines without repeated points, loops with their first point at the end too; tangents (2,d,n), NaN where they are
    not known; which they are."""
    counts = np.diff(offsets)
    kept = np.flatnonzero(counts > 0)
    if not len(kept):
        nothing = np.zeros(0, dtype=np.intp)
        return (
            FitLines(points.T, np.zeros(0), nothing, nothing, closed[:0], nothing),
            np.zeros((2, *points.T.shape)),
            kept,
        )
    # Open lines may end with a point that repeats; a loop gets its first point again, and a single point too.
    rounds = closed_round(Polylines(points, offsets, closed | (counts == 1)))
    index = rounds.index
    sizes = np.diff(rounds.offsets)[kept]
    starts, line = ragged.starts(sizes), ragged.owner(sizes)
    spread = points[index]
    extent = (np.maximum.reduceat(spread, starts) - np.minimum.reduceat(spread, starts)).max(axis=1)
    step = np.linalg.norm(np.diff(spread, axis=0), axis=1)
    fresh = np.ones(len(index), dtype=np.bool_)
    fresh[1:] = (step > ZERO_OF_EXTENT * extent[line[1:]]) | (line[1:] != line[:-1])
    # The end of a line stays; what it repeats goes, unless that is the start.
    ends = starts + sizes - 1
    fresh[np.maximum(ends - 1, starts)] &= fresh[ends] | (ends - 1 == starts)
    fresh[ends] = True
    index, line = index[fresh], line[fresh]
    given = np.full((2, points.shape[1], len(index)), np.nan)
    if tangents is not None:
        sides = np.asarray(tangents, dtype=np.float64).reshape(len(points), -1, points.shape[1])
        given[:] = sides[index].transpose(1, 2, 0)
    return _measured(points[index], line, closed[kept]), given, kept


def _measured(points: Floats, line: Ints, closed: Bools) -> FitLines:
    """Lines with their lengths, from points (n,d) and the line of each."""
    count = len(closed)
    step = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)
    first = np.searchsorted(line, np.arange(count))
    last = np.searchsorted(line, np.arange(count), side="right") - 1
    # A gap, so that the end of a line and the start of the next differ in length.
    step[first] = 0.0
    step[first[1:]] = step.mean() + (step.mean() == 0.0)
    return FitLines(np.ascontiguousarray(points.T), np.cumsum(step), first, last, closed, line)


def _sampled(curve: Curve, count: int) -> tuple[Floats, Floats]:
    t = np.linspace(curve.start, curve.end, count + 1)
    points, tangents = np.array(curve.points(t)), np.array(curve.tangents(t))
    if curve.closed:
        points[-1], tangents[-1] = points[0], tangents[0]
    return points, tangents


def _open_line(points: Floats, tangents: Floats, *, closed: bool) -> FitLines:
    """One line through all the points, repeated ones too, so that places of points are those of parameters."""
    return _measured(points, np.zeros(len(points), dtype=np.intp), np.array([closed]))
