"""The marks of labels: dots, crosses, arrowheads and ticks."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.scene.naming.labels import Label, OnCurve
from vectorplot.scene.placement import Placement

MARK_MM = 0.6
"""Half of the size of marks at points."""

ARROW_MM, ARROW_SLOPE = 2.8, 0.18
"""The length of arrowheads, and half of their width as a part of it (ISO 129: between 15 and 30 degrees)."""

TICK = 1.5
"""Half of the length of ticks across curves, beside that of other marks."""


def direction_at(seen: SeenLabels, number: int, placement: Placement) -> Floats:
    """(2,) the unit direction on the page of the curve that a label is at a point of; at its beginning out of it."""
    course, at = seen.anchors.courses[number], seen.anchors.labels[number].at
    assert course is not None and isinstance(at, OnCurve)
    projection, last = placement.projection, len(course) - 1
    nearest = int(np.argmin(np.linalg.norm(course - seen.anchors.points[number], axis=1)))
    ends = projection.points_of(course[[max(nearest - 1, 0), min(nearest + 1, last)]])
    way = np.diff(placement.on_page(projection.image_of(ends)), axis=0)[0]
    long = float(np.hypot(*way))
    return np.asarray(way / long * (-1.0 if at.part == 0.0 else 1.0)) if long > 0.0 else np.zeros(2)


def marked(label: Label, point: Floats, way: Floats, mm: float) -> list[Floats]:
    """The strokes of the mark at the point of a label, where a curve has the direction way.

    Degenerate: no arrowheads and no ticks where the curve is seen end-on, way is zero.
    """
    if label.mark in ("arrow", "tick") and not way.any():
        return []
    size, left = MARK_MM * mm, np.array([-way[1], way[0]])
    if label.mark == "tick":
        return [np.stack([point - TICK * size * left, point + TICK * size * left])]
    if label.mark == "arrow":
        back = point - ARROW_MM * mm * way
        wings = ARROW_MM * mm * ARROW_SLOPE * left
        # The stroke along the middle makes it dark.
        return [np.stack([point, back + wings, back - wings, point, back])]
    if label.mark == "cross":
        return [point + size * np.array(ends) for ends in (((-1.0, 0.0), (1.0, 0.0)), ((0.0, -1.0), (0.0, 1.0)))]
    if label.mark == "dot":
        angle = np.linspace(0.0, 2.0 * np.pi, 17)
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        # Two rounds of a pen fill a dot.
        return [point + 0.7 * size * circle, point + 0.3 * size * circle]
    return []
