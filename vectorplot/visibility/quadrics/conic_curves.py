"""Arcs of conics as the curves of the second engine: chords within a tolerance, and all of the arc between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import WHOLE_TURN
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates, eye_coordinates
from vectorplot.visibility.quadrics.conic_arcs import Arcs
from vectorplot.visibility.smooth.sheets.family import Along, Chords
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

LOOKS = 9
"""Places along an arc at which one looks how sharply its image bends."""

FEWEST, MOST = 8, 4096
"""Chords of an arc, at least and at most: nine points tell an arc from another curve."""

SAFE = 1.2
"""The image may bend so much more between the places looked at."""


@dataclass(frozen=True, eq=False)
class ConicArcs:
    """Arcs in the view's coordinates. The place of a point is (t, 0, 0), the level of a curve its number among arcs."""

    arcs: Arcs
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        start, end = chords.places
        way = (end - start)[:, 0]
        t = start[:, 0] + part * way
        points, slopes, _ = self.arcs.at(chords.level.astype(np.intp), t)
        places = np.zeros_like(points)
        places[:, 0] = t
        return Along(places, points, slopes * way[:, None])


def conic_curves(view: View, arcs: Arcs, behind: Ints, tolerance: float) -> Curves:
    """Arcs, hidden by behind (n,) items already, with chords off them by no more than the tolerance in the image."""
    sight = eye_coordinates(view)
    count = np.clip(np.ceil(_bends(sight, view.focus, arcs) / np.sqrt(8.0 * tolerance)), FEWEST, MOST).astype(np.intp)
    count[arcs.straight] = 1
    arc, step = ragged.owner(count + 1), ragged.place(count + 1)
    t = arcs.low[arc] + (arcs.high - arcs.low)[arc] * step / count[arc]
    last = step == count[arc]
    t[last] = arcs.high[arc[last]]
    whole = np.abs(arcs.high - arcs.low - 2.0 * np.pi) <= WHOLE_TURN
    in_view = arcs.in_view(sight)
    points = in_view.at(arc, np.where(last & whole[arc], arcs.low[arc], t))[0]
    places = np.zeros_like(points)
    places[:, 0] = t
    return Curves(
        points,
        places,
        np.full_like(points, np.nan),
        ragged.offsets(count + 1),
        whole,
        arcs.kind,
        arcs.item,
        np.zeros(len(arcs), dtype=np.intp),
        np.arange(len(arcs), dtype=np.float64),
        (ConicArcs(in_view),),
        arcs.side,
        behind,
    )


def _bends(sight: EyeCoordinates, focus: float, arcs: Arcs) -> Floats:
    """(n,) the length of each arc's way times the root of the largest second derivative of its image: with that many
    chords, times the root of an eighth, they are a unit off."""
    span = arcs.high - arcs.low
    largest = np.zeros(len(arcs))
    every = np.arange(len(arcs))
    for part in np.linspace(0.0, 1.0, LOOKS).tolist():
        point, slope, second = arcs.at(every, arcs.low + part * span)
        if sight.central:
            depth = np.maximum(point[:, 2:], max(sight.near, LEAST_DIVISOR))
            image = point[:, :2] / depth
            image_slope = (slope[:, :2] - image * slope[:, 2:]) / depth
            bend = (second[:, :2] - 2.0 * image_slope * slope[:, 2:] - image * second[:, 2:]) / depth * focus
        else:
            bend = second[:, :2]
        largest = np.maximum(largest, np.hypot(bend[:, 0], bend[:, 1]))
    return np.asarray(span * np.sqrt(SAFE * largest))
