"""Strokes as Bézier paths and arcs of ellipses: exact cubics, as few as a tolerance allows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.arcs import EllipseArcs, arc_segments, recognised_arcs
from vectorplot.curves.bezier import BezierPaths
from vectorplot.curves.bezier_fit import fitted_paths
from vectorplot.drawing.drawing import STROKES, CurvedStrokes, Layer, Paths
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import joined, segments, take, with_points
from vectorplot.geometry.vectors import cross, norm
from vectorplot.tolerances import (
    ARC_OF_TOLERANCE,
    CUBIC_OF_TOLERANCE,
    ONE_CIRCLE_OF_RADIUS,
    STRAIGHT_TURN,
    WHOLE_TURN,
)

# Strokes of which every chord is known to be a Bézier curve, as few such curves.


def exact_cubics(paths: Paths, tolerance: float) -> tuple[Ints, BezierPaths]:
    """The strokes (k,) of which all handles are known, and their Bézier curves, with error 0.

    Neighbouring curves that are parts of one, as the chords between two knots of a spline are, become that one where it
    has their control points within the tolerance.
    Source: Farin, Curves and Surfaces for CAGD, de Casteljau's scheme.
    """
    sizes = np.diff(paths.offsets)
    known = np.zeros(len(paths), dtype=np.bool_)
    some = np.isfinite(paths.handles).any(axis=1)
    if some.any():
        unknown = np.isnan(paths.handles)
        # Nothing comes before the start of an open stroke, and nothing behind its end.
        filled = np.flatnonzero(~paths.closed & (sizes > 0))
        unknown[paths.offsets[filled], 0] = unknown[paths.offsets[filled + 1] - 1, 1] = False
        lacking = np.bincount(ragged.owner(sizes)[unknown.any(axis=1)], minlength=len(paths)) > 0
        known = ~lacking & (sizes > 1)
    which = np.flatnonzero(known)
    exact = chosen(paths, which)
    start, end = segments(exact).T if len(exact) else np.zeros((2, 0), dtype=np.intp)
    leaving, arriving = _ways(exact, start, 1), _ways(exact, end, 0)
    first, last = exact.points[start], exact.points[end]
    control = np.stack([first, first + leaving, last - arriving, last], axis=1)
    owner = ragged.owner(np.diff(exact.offsets) - ~exact.closed)
    control, owner = _merged(control, owner, tolerance)
    offsets = ragged.offsets(np.bincount(owner, minlength=len(exact)))
    return which, BezierPaths(control, offsets, exact.closed, np.zeros(len(exact)))


def _ways(paths: Paths, point: Ints, side: int) -> Floats:
    """(s,2) the handles at points, forwards: back (0) or ahead (1) of them."""
    angle = np.nan_to_num(paths.directions[point, side])
    return np.asarray(paths.handles[point, side, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def _merged(control: Floats, owner: Ints, tolerance: float) -> tuple[Floats, Ints]:
    """Fewer segments (k,4,2), and their strokes (k,)."""
    vain, turn = 0, 0
    while vain < 2 and len(owner) > 1:
        pair = np.arange(turn % 2, len(owner) - 1, 2)
        pair = pair[owner[pair] == owner[pair + 1]]
        whole, good = _one_of_two(control[pair], control[pair + 1], tolerance)
        vain, turn = (0, turn) if good.any() else (vain + 1, turn + 1)
        kept = np.ones(len(owner), dtype=np.bool_)
        kept[pair[good] + 1] = False
        control = control.copy()
        control[pair[good]] = whole[good]
        control, owner = control[kept], owner[kept]
    return control, owner


def _one_of_two(a: Floats, b: Floats, tolerance: float) -> tuple[Floats, Bools]:
    """(k,4,2) the curves of which two neighbours are the parts, and whether (k,) they are."""
    ahead, back = (np.linalg.norm(way, axis=1) for way in (b[:, 1] - b[:, 0], a[:, 3] - a[:, 2]))
    moves = (ahead > 0.0) & (back > 0.0)
    share = np.where(moves, back / np.where(moves, ahead + back, 1.0), 0.5)[:, None]
    one, two = a[:, 0] + (a[:, 1] - a[:, 0]) / share, b[:, 3] - (b[:, 3] - b[:, 2]) / (1.0 - share)
    whole = np.stack([a[:, 0], one, two, b[:, 3]], axis=1)
    low, high, points = [whole[:, 0]], [whole[:, 3]], whole
    for _ in range(3):
        points = points[:, :-1] + share[:, None] * (points[:, 1:] - points[:, :-1])
        low.append(points[:, 0])
        high.append(points[:, -1])
    off = np.abs(np.stack([np.stack(low, axis=1) - a, np.stack(high[::-1], axis=1) - b])).max(axis=(0, 2, 3))
    return whole, np.asarray(moves & (off <= tolerance))


# Strokes that are known as Bézier curves, as fewer of them within a tolerance.

FIT_OF_KNOWN = 0.9
"""The part of the tolerance for the fit, where the curve is known: chords take hardly any of it."""

SAG_OF_KNOWN = 0.03
"""The part of the tolerance that the samples which the fit goes by are apart from the curve in their middles."""

CORNER_ANGLE = np.radians(1.0)
"""Known directions that differ by more at one point are those of a corner."""

MOST_SAMPLES = 1024
"""Of one curve, at most: one that would need more is drawn far beyond any page, and stays."""


def fewer_cubics(paths: BezierPaths, tolerance: float) -> BezierPaths:
    """The paths, with fewer curves where these serve within the tolerance of the given ones and their error. They are
    sampled with true tangents, chords within a part of the tolerance, and refitted between the same ends in the same
    directions.
    Source: Farin, Curves and Surfaces for CAGD, section 6.9: a chord is off its curve by at most an eighth of the
    second derivative.
    """
    count, samples = np.diff(paths.offsets), _samples_needed(paths, SAG_OF_KNOWN * tolerance)
    too_large = np.bincount(ragged.owner(count)[samples > MOST_SAMPLES], minlength=len(count)) > 0
    which = np.flatnonzero((count > 1) & ~too_large)
    if not len(which):
        return paths
    many = take(paths, which)
    points, offsets, tangents = _samples(many, SAG_OF_KNOWN * tolerance)
    found = fitted_paths(
        points,
        offsets,
        many.closed,
        tangents,
        tolerance=FIT_OF_KNOWN * tolerance,
        corner_angle=CORNER_ANGLE,
        deviation=SAG_OF_KNOWN * tolerance,
    )
    better = (np.diff(found.offsets) < count[which]) & (found.error <= FIT_OF_KNOWN * tolerance)
    return _put(paths, which[better], take(found, np.flatnonzero(better)))


def _put(paths: BezierPaths, which: Ints, others: BezierPaths) -> BezierPaths:
    """The paths with others in the places of some of them."""
    count, error = np.diff(paths.offsets), paths.error.copy()
    kept = np.ones(len(count), dtype=np.bool_)
    kept[which] = False
    own = ragged.owner(count)
    control = np.concatenate([paths.control[kept[own]], others.control])
    owner = np.concatenate([own[kept[own]], which[ragged.owner(np.diff(others.offsets))]])
    count[which], error[which] = np.diff(others.offsets), others.error
    order = np.argsort(owner, kind="stable")
    return BezierPaths(control[order], ragged.offsets(count), paths.closed, error)


def _samples(paths: BezierPaths, deviation: float) -> tuple[Floats, Ints, Floats]:
    """Points (p,2) on paths, their offsets (m+1,), and the tangents (p,2,2) with which the paths arrive and leave."""
    control, pieces = paths.control, np.diff(paths.offsets)
    count = _samples_needed(paths, deviation).astype(np.intp)
    own, part = ragged.owner(count), ragged.place(count) / count[ragged.owner(count)]
    points, leaving = _at(control[own], part)
    first = ragged.starts(count)
    arriving = leaving.copy()
    before = ragged.preceding(paths.offsets)
    arriving[first] = _at(control[before], np.ones(len(before)))[1]
    # An open path begins with nothing behind, and ends in a point of its own.
    line = ragged.owner(pieces)
    begins, ends = paths.offsets[:-1][~paths.closed], paths.offsets[1:][~paths.closed] - 1
    arriving[first[begins]] = leaving[first[begins]]
    last, last_way = _at(control[ends], np.ones(len(ends)))
    rank = np.concatenate([np.arange(len(own)), first[ends] + count[ends] - 0.5])
    owner = np.concatenate([line[own], line[ends]])
    order = np.argsort(rank, kind="stable")
    ways = np.stack([np.concatenate([arriving, last_way]), np.concatenate([leaving, last_way])], axis=1)[order]
    # Where a curve stands still nothing is known of its direction.
    ways[(ways == 0.0).all(axis=2)] = np.nan
    sizes = np.bincount(owner, minlength=len(pieces))
    return np.concatenate([points, last])[order], ragged.offsets(sizes), ways


def _samples_needed(paths: BezierPaths, deviation: float) -> Floats:
    """(s,) into how many parts of equal parameters each curve has to go for chords to be no farther off."""
    control = paths.control
    bend = np.linalg.norm(control[:, 2:] - 2.0 * control[:, 1:-1] + control[:, :-2], axis=2).max(axis=1, initial=0.0)
    return np.asarray(np.maximum(np.ceil(np.sqrt(0.75 * bend / deviation)), 1.0))


def _at(control: Floats, part: Floats) -> tuple[Floats, Floats]:
    """(k,2) points of curves (k,4,2) at parameters (k,), and their derivatives."""
    t = part[:, None]
    two = [control[:, k] + t * (control[:, k + 1] - control[:, k]) for k in range(3)]
    one = [two[k] + t * (two[k + 1] - two[k]) for k in range(2)]
    return one[0] + t * (one[1] - one[0]), 3.0 * (one[1] - one[0])


# Strokes of smooth curves as Bézier paths and arcs of ellipses.

CHORD_SHARE = 0.5
"""The part of the tolerance that chords may be off their curves."""

FIT_SHARE = 0.45
"""The part of the tolerance for the fit. Half of it is spent on the chords; the rest is for rounding in files."""

STROKE_CORNER_ANGLE = np.radians(60.0)
"""A smooth stroke that turns by more at one point has a cusp there: the chords of a curve that is only narrow, traced
within half a tolerance, turn by less unless it is no larger than a few tolerances."""


def curved_strokes(paths: Paths, tolerance_mm: float) -> Paths | CurvedStrokes:
    """The strokes with curves for the smooth ones: arcs of ellipses where they are, cubic Bézier paths elsewhere.

    Parameters
    ----------
    paths : Paths
        Polylines, those of smooth curves marked as smooth.
    tolerance_mm : float
        How far a curve may be off the one that the stroke samples, if the stroke's chords lie within half of that.

    Returns
    -------
    Paths or CurvedStrokes
        In the same order and directions; each curve begins and ends where its stroke does.

    Raises
    ------
    InputError
        Unless the tolerance is positive and finite.

    Notes
    -----
    Strokes of which all handles are known leave as the Bézier curves that they are, without an error, or as fewer that
    are fitted to these, with true tangents and within nearly the whole tolerance.

    Edge cases: without smooth strokes of three points or more the strokes themselves.

    Source: vectorplot.curves.bezier.fit and vectorplot.curves.bezier.elliptic_arcs.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import numpy as np
    >>> from vectorplot.drawing import curved_strokes
    >>> from vectorplot.drawing.drawing import Paths
    >>> t = np.linspace(0.0, np.pi, 60)
    >>> arch = np.column_stack([50.0 + 30.0 * np.cos(t), 20.0 + 30.0 * np.sin(t)])
    >>> one, solid = np.zeros(1, dtype=int), np.column_stack([arch, 0.0 * t])
    >>> paths = Paths(arch, np.array([0, 60]), np.array([False]), one, one, one, solid, np.array([True]))
    >>> curves = curved_strokes(paths, tolerance_mm=0.05)
    >>> curves.arcs.centre.round(6).tolist(), np.linalg.norm(curves.arcs.first, axis=1).round(6).tolist()
    ([[50.0, 20.0]], [30.0])
    >>> curved_strokes(replace(paths, smooth=np.array([False])), tolerance_mm=0.05) is paths
    False
    """
    if not 0.0 < tolerance_mm < np.inf:
        raise InputError(f"curves need a positive tolerance in mm, not {tolerance_mm:g}")
    which = np.flatnonzero(paths.smooth & (np.diff(paths.offsets) > 2))
    if not len(which):
        return paths
    smooth = chosen(paths, which)
    arcs = recognised_arcs(smooth.points, smooth.offsets, smooth.closed, tolerance=ARC_OF_TOLERANCE * tolerance_mm)
    arcs = replace(arcs, stroke=which[arcs.stroke])
    fit = FIT_SHARE * tolerance_mm
    round_ones = arc_segments(arcs, paths.closed[arcs.stroke], tolerance=fit)
    which = np.setdiff1d(which, arcs.stroke, assume_unique=True)
    known, cubics = exact_cubics(chosen(paths, which), tolerance=CUBIC_OF_TOLERANCE * tolerance_mm)
    cubics = fewer_cubics(cubics, tolerance_mm)
    exact, which = which[known], np.delete(which, known)
    rest = chosen(paths, which)
    fitted = fitted_paths(
        rest.points,
        rest.offsets,
        rest.closed,
        np.stack([np.cos(rest.directions), np.sin(rest.directions)], axis=2),
        tolerance=fit,
        corner_angle=STROKE_CORNER_ANGLE,
        deviation=CHORD_SHARE * tolerance_mm,
    )
    beziers = _in_places((cubics, round_ones, fitted), (exact, arcs.stroke, which), paths)
    return CurvedStrokes(paths, beziers, arcs)


def one_mark(marks: tuple[Paths | CurvedStrokes, ...]) -> CurvedStrokes:
    """All marks of a layer as one, one after the other; what was Paths stays polylines."""
    some = [mark if isinstance(mark, CurvedStrokes) else _polylines(mark) for mark in marks]
    first = ragged.offsets(np.array([len(mark) for mark in some], dtype=np.intp))
    arcs = [mark.arcs for mark in some]
    return CurvedStrokes(
        concatenated(tuple(mark.paths for mark in some)),
        joined([_polylines(Paths.empty()).beziers, *(mark.beziers for mark in some)]),
        EllipseArcs.joined(
            [replace(part, stroke=part.stroke + k) for part, k in zip(arcs, first.tolist(), strict=False)]
        ),
    )


def _polylines(paths: Paths) -> CurvedStrokes:
    none = BezierPaths(np.zeros((0, 4, 2)), np.zeros(len(paths) + 1, np.intp), paths.closed, np.zeros(len(paths)))
    return CurvedStrokes(paths, none, EllipseArcs.none())


def _in_places(parts: tuple[BezierPaths, ...], strokes: tuple[Ints, ...], paths: Paths) -> BezierPaths:
    """One path for each stroke, the numbers of which come with the parts; without segments where no part has one."""
    count, error = np.zeros(len(paths), dtype=np.intp), np.zeros(len(paths))
    for part, stroke in zip(parts, strokes, strict=True):
        count[stroke], error[stroke] = np.diff(part.offsets), part.error
    offsets = ragged.offsets(count)
    control = np.zeros((offsets[-1], 4, 2))
    for part, stroke in zip(parts, strokes, strict=True):
        control[ragged.ranges(offsets[stroke], count[stroke])] = part.control
    drawn = np.flatnonzero(count)
    control[offsets[drawn], 0] = paths.points[paths.offsets[drawn]]
    last = np.where(paths.closed[drawn], paths.offsets[drawn], paths.offsets[drawn + 1] - 1)
    control[offsets[drawn + 1] - 1, 3] = paths.points[last]
    return BezierPaths(control, offsets, paths.closed, error)


# Polygons that stand for circles and ellipses, as meshes have them, as arcs of these.

FEWEST_SIDES = 12
"""Of a polygon that is taken for a whole circle; an arc has as many in proportion. Nuts and other prisms have fewer."""

LONGEST_CHORD = 1.5
"""Of a polygon that stands for an arc, as a part of the longer one of its neighbours."""

ON_ARC = 0.1
"""The part of the tolerance by which corners may be off the arc."""


def with_round_polygons(layers: Iterable[Layer], tolerance_mm: float) -> tuple[Layer, ...]:
    """The layers, strokes of which are arcs of circles and ellipses where they are polygons that stand for such, and
    straight lines and arcs of circles in turn where they are polygons of both.

    Parameters
    ----------
    layers : iterable of Layer
        With strokes as they are drawn.
    tolerance_mm : float
        All corners of a polygon lie on its arc within a tenth of it.

    Returns
    -------
    tuple of Layer
        The error of each arc is how far it leaves the sides of its polygon, at most.

    Notes
    -----
    Edge cases: polygons that turn by more than a twelfth of a circle at a corner stay, and so do dashes too short to
    tell. Axes that differ by less than the corners are off are those of a circle.
    """
    return tuple(
        replace(
            layer,
            marks=tuple(
                _with_arc_runs(_rounded(mark, tolerance_mm), tolerance_mm) if isinstance(mark, STROKES) else mark
                for mark in layer.marks
            ),
        )
        for layer in layers
    )


def rounding_error_mm(layers: Iterable[Layer]) -> float | None:
    """How far arcs leave the sides of the polygons that stand for them, at most; None without such arcs."""
    marks = (mark for layer in layers for mark in layer.marks if isinstance(mark, CurvedStrokes))
    found = [mark.beziers.error[~mark.paths.smooth & (np.diff(mark.beziers.offsets) > 0)] for mark in marks]
    errors = np.concatenate([np.zeros(0), *found])
    return float(errors.max()) if len(errors) else None


def _rounded(mark: Paths | CurvedStrokes, tolerance_mm: float) -> Paths | CurvedStrokes:
    drawn = one_mark((mark,))
    paths = drawn.paths
    which = np.flatnonzero(~paths.smooth)
    polygons = chosen(paths, which)
    near = ON_ARC * tolerance_mm
    arcs = recognised_arcs(polygons.points, polygons.offsets, polygons.closed, tolerance=near)
    step = _widest_steps(polygons, arcs)
    fine = step <= 2.0 * np.pi / FEWEST_SIDES + WHOLE_TURN
    arcs, step = _circles(arcs.take(fine), near), step[fine]
    if not len(arcs):
        return mark
    arcs = replace(arcs, stroke=which[arcs.stroke])
    curves = arc_segments(arcs, paths.closed[arcs.stroke], tolerance=FIT_SHARE * tolerance_mm)
    # No chord of an ellipse is farther off than that of a circle about its longer axis.
    sagitta = norm(arcs.first) * (1.0 - np.cos(step / 2.0))
    round_ones = replace(curves, error=curves.error + sagitta + near)
    known = np.flatnonzero(np.diff(drawn.beziers.offsets))
    beziers = _in_places((take(drawn.beziers, known), round_ones), (known, arcs.stroke), paths)
    every = EllipseArcs.joined((drawn.arcs, arcs))
    return CurvedStrokes(paths, beziers, every.take(np.argsort(every.stroke, kind="stable")))


# Strokes of straight lines and arcs of circles in turn: slots, rounded corners, keyways.


def _with_arc_runs(mark: Paths | CurvedStrokes, tolerance_mm: float) -> Paths | CurvedStrokes:
    """The mark with strokes as Bézier curves where some of their points in a row lie on a circle; others stay. Smooth
    strokes are such if they are straight elsewhere."""
    drawn = one_mark((mark,))
    paths, near = drawn.paths, ON_ARC * tolerance_mm
    plain = (paths.smooth | (np.diff(drawn.beziers.offsets) == 0)) & (np.diff(paths.offsets) > 2)
    plain[drawn.arcs.stroke] = False
    which = np.flatnonzero(plain)
    if not len(which):
        return mark
    some = chosen(paths, which)
    same = _on_one_circle(some.points, some.offsets, some.closed)
    inner = same | same[ragged.preceding(some.offsets)]
    kept = np.logical_or.reduceat(inner, some.offsets[:-1])
    which, some = which[kept], chosen(some, np.flatnonzero(kept))
    if not len(which):
        return mark
    # Loops begin where no run goes on.
    inner = inner[np.repeat(kept, np.diff(chosen(paths, np.flatnonzero(plain)).offsets))]
    sizes = np.diff(some.offsets)
    number = np.where(inner, sizes.max(), ragged.place(sizes))
    start = np.where(some.closed, np.minimum(np.minimum.reduceat(number, some.offsets[:-1]), sizes - 1), 0)
    count = sizes + some.closed
    place = (ragged.place(count) + np.repeat(start, count)) % np.repeat(sizes, count)
    at = np.repeat(some.offsets[:-1], count) + place
    points, directions, offsets = some.points[at], some.directions[at], ragged.offsets(count)
    same = _on_one_circle(points, offsets, np.zeros(len(some), dtype=np.bool_))
    first = np.flatnonzero(same & ~np.concatenate([[False], same[:-1]]))
    last = np.flatnonzero(same & ~np.concatenate([same[1:], [False]]))
    # A run of points on one circle reaches from the one before the first of them to the one behind the last.
    begin, length = first - 1, last - first + 4
    run_offsets = ragged.offsets(length)
    run_points = points[ragged.ranges(begin, length)]
    arcs = recognised_arcs(run_points, run_offsets, np.zeros(len(first), dtype=np.bool_), tolerance=near)
    arcs = _circles(arcs, near)
    arcs = arcs.take(np.abs(norm(arcs.first) - norm(arcs.second)) <= near)
    if not len(arcs):
        return mark
    curves = arc_segments(arcs, np.zeros(len(arcs), dtype=np.bool_), tolerance=FIT_SHARE * tolerance_mm)
    begin, length = begin[arcs.stroke], length[arcs.stroke]
    covered = np.zeros(len(points), dtype=np.bool_)
    covered[ragged.ranges(begin, length - 1)] = True
    covered[offsets[1:] - 1] = True
    straight = np.flatnonzero(~covered)
    ends = np.stack([points[straight], points[straight + 1]], axis=1)
    thirds = ends[:, :1] + np.array([0.0, 1.0, 2.0, 3.0])[None, :, None] / 3.0 * (ends[:, 1:] - ends[:, :1])
    pieces = np.diff(curves.offsets)
    control = np.concatenate([thirds, curves.control])
    at = np.concatenate([straight, np.repeat(begin, pieces)])
    order = np.lexsort((np.concatenate([np.zeros(len(straight), dtype=np.intp), ragged.place(pieces)]), at))
    stroke = np.searchsorted(offsets, at[order], side="right") - 1
    has_arc = np.isin(np.arange(len(some)), np.searchsorted(offsets, begin, side="right") - 1)
    leaves = np.stack([directions[straight, 1], directions[straight + 1, 0]], axis=1)
    bow = np.abs(_crossed(ends[:, 1] - ends[:, 0], leaves)).max(axis=1, initial=0.0) / 4.0
    owner = np.searchsorted(offsets, straight, side="right") - 1
    has_arc[owner[some.smooth[owner] & ~(bow <= near)]] = False
    control, stroke = control[order][has_arc[stroke]], stroke[has_arc[stroke]]
    own = np.flatnonzero(has_arc)
    off = np.zeros(len(some))
    of_arc = np.searchsorted(offsets, begin, side="right") - 1
    widest = np.abs(arcs.end - arcs.start) / (length - 1)
    # Smooth strokes are no polygons that stand for a curve.
    sagitta = np.where(some.smooth[of_arc], 0.0, norm(arcs.first) * (1.0 - np.cos(widest / 2.0)))
    np.maximum.at(off, of_arc, curves.error + sagitta + near)
    per_stroke = np.bincount(stroke, minlength=len(some))[own]
    mixed = BezierPaths(control, ragged.offsets(per_stroke), some.closed[own], off[own])
    shift = np.zeros(len(paths), dtype=np.intp)
    shift[which[own]] = start[own]
    sizes = np.diff(paths.offsets)
    place = (ragged.place(sizes) + np.repeat(shift, sizes)) % np.repeat(sizes, sizes)
    paths = with_points(paths, np.repeat(paths.offsets[:-1], sizes) + place, np.arange(len(paths)), paths.offsets)
    known = np.setdiff1d(np.flatnonzero(np.diff(drawn.beziers.offsets)), which[own])
    beziers = _in_places((take(drawn.beziers, known), mixed), (known, which[own]), paths)
    return CurvedStrokes(paths, beziers, drawn.arcs)


def _crossed(ways: Floats, angles: Floats) -> Floats:
    """(n,k) how far unit vectors at angles (n,k) are across vectors (n,2), times the lengths of these."""
    return ways[:, :1] * np.sin(angles) - ways[:, 1:] * np.cos(angles)


def _on_one_circle(points: Floats, offsets: Ints, closed: Bools) -> Bools:
    """(p,) whether the circle through a point of polygons (p,2) and its neighbours is, roughly, that of the point after
    it, and both turn by a twelfth of a circle at most."""
    before, after = ragged.preceding(offsets), ragged.following(offsets)
    back, ahead = points[before] - points, points[after] - points
    double = 2.0 * cross(back, ahead)
    turn = arctan2(-0.5 * double, -(back * ahead).sum(axis=1))
    sound = (np.abs(turn) <= 2.0 * np.pi / FEWEST_SIDES + WHOLE_TURN) & (np.abs(turn) > STRAIGHT_TURN)
    ends = np.flatnonzero(~closed)
    sound[offsets[:-1][ends]] = sound[offsets[1:][ends] - 1] = False
    squares = (back * back).sum(axis=1), (ahead * ahead).sum(axis=1)
    safe = np.where(sound, double, 1.0)
    x = (ahead[:, 1] * squares[0] - back[:, 1] * squares[1]) / safe
    y = (back[:, 0] * squares[1] - ahead[:, 0] * squares[0]) / safe
    arm = np.stack([x, y], axis=1)
    centre, radius = points + arm, norm(arm)
    # A side of a twelfth of the circle at most.
    sound &= np.maximum(*squares) <= (2.0 * radius * np.sin(np.pi / FEWEST_SIDES) * (1.0 + WHOLE_TURN)) ** 2
    same = sound & sound[after] & (turn * turn[after] > 0.0)
    # Between two arcs that are mirror images a straight line is a chord of a large circle through their ends.
    same &= squares[1] <= LONGEST_CHORD**2 * np.maximum(squares[0], squares[1][after])
    return np.asarray(same & (norm(centre - centre[after]) <= ONE_CIRCLE_OF_RADIUS * radius))


def _widest_steps(paths: Paths, arcs: EllipseArcs) -> Floats:
    """(a,) the widest angle, in the parameter of its arc, between neighbouring points of each path that is one."""
    some = chosen(paths, arcs.stroke)
    owner: Ints = ragged.owner(np.diff(some.offsets))
    arm = some.points - arcs.centre[owner]
    along, across = (
        (arm * axis[owner]).sum(axis=1) / (axis**2).sum(axis=1)[owner] for axis in (arcs.first, arcs.second)
    )
    angle = arctan2(across, along)
    ends = segments(some)
    turn = np.abs(np.mod(angle[ends[:, 1]] - angle[ends[:, 0]] + np.pi, 2.0 * np.pi) - np.pi)
    widest = np.zeros(len(arcs))
    np.maximum.at(widest, owner[ends[:, 0]], turn)
    return widest


def _circles(arcs: EllipseArcs, near: float) -> EllipseArcs:
    """The arcs, those of ellipses whose axes are nearly of one length as arcs of circles; the longer axis first."""
    long, short = norm(arcs.first), norm(arcs.second)
    swapped = short > long
    quarter = np.where(swapped, 0.5 * np.pi, 0.0)
    first = np.where(swapped[:, None], arcs.second, arcs.first)
    second = np.where(swapped[:, None], -arcs.first, arcs.second)
    long, short = np.maximum(long, short), np.minimum(long, short)
    across = np.stack([-first[:, 1], first[:, 0]], axis=1)
    across *= np.sign((across * second).sum(axis=1))[:, None]
    size = (0.5 * (long + short) / long)[:, None]
    equal = (long - short <= 2.0 * near)[:, None]
    return replace(
        arcs,
        first=np.where(equal, size * first, first),
        second=np.where(equal, size * across, second),
        start=arcs.start - quarter,
        end=arcs.end - quarter,
    )
