"""Strokes of smooth curves as Bézier paths and arcs of ellipses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.curves.bezier.elliptic_arcs import EllipseArcs, arc_segments, recognised_arcs
from vectorplot.curves.bezier.fit import fitted_paths
from vectorplot.curves.bezier.paths import BezierPaths
from vectorplot.drawing.drawing import CurvedStrokes, Paths
from vectorplot.drawing.strokes.exact_cubics import exact_cubics
from vectorplot.drawing.strokes.fewer_cubics import fewer_cubics
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import joined
from vectorplot.tolerances.of_lengths import ARC_OF_TOLERANCE, CUBIC_OF_TOLERANCE

CHORD_SHARE = 0.5
"""The part of the tolerance that chords may be off their curves."""

FIT_SHARE = 0.45
"""The part of the tolerance for the fit. Half of it is spent on the chords; the rest is for rounding in files."""

CORNER_ANGLE = np.radians(60.0)
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

    Degenerate: without smooth strokes of three points or more the strokes themselves.

    Source: vectorplot.curves.bezier.fit and vectorplot.curves.bezier.elliptic_arcs.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import numpy as np
    >>> from vectorplot.drawing import Paths, curved_strokes
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
        corner_angle=CORNER_ANGLE,
        sag=CHORD_SHARE * tolerance_mm,
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
