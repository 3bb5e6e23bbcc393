"""Polygons that stand for circles and ellipses, as meshes have them, as arcs of these."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.arcs import EllipseArcs, arc_segments, recognised_arcs
from vectorplot.drawing.drawing import STROKES, CurvedStrokes, Layer, Paths
from vectorplot.drawing.stroke_curves import FIT_SHARE, in_places, one_mark
from vectorplot.drawing.strokes import chosen
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import segments, take
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import WHOLE_TURN

FEWEST_SIDES = 12
"""Of a polygon that is taken for a whole circle; an arc has as many in proportion. Nuts and other prisms have fewer."""

ON_ARC = 0.1
"""The part of the tolerance by which corners may be off the arc."""


def with_round_polygons(layers: Iterable[Layer], tolerance_mm: float) -> tuple[Layer, ...]:
    """The layers, strokes of which are arcs of circles and ellipses where they are polygons that stand for such.

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
            marks=tuple(_rounded(mark, tolerance_mm) if isinstance(mark, STROKES) else mark for mark in layer.marks),
        )
        for layer in layers
    )


def rounding_error_mm(layers: Iterable[Layer]) -> float | None:
    """How far arcs leave the sides of the polygons that stand for them, at most; None without such arcs."""
    marks = (mark for layer in layers for mark in layer.marks if isinstance(mark, CurvedStrokes))
    found = [mark.beziers.error[mark.arcs.stroke][~mark.paths.smooth[mark.arcs.stroke]] for mark in marks]
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
    beziers = in_places((take(drawn.beziers, known), round_ones), (known, arcs.stroke), paths)
    every = EllipseArcs.joined((drawn.arcs, arcs))
    return CurvedStrokes(paths, beziers, every.take(np.argsort(every.stroke, kind="stable")))


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
