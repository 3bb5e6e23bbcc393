"""Curves of smooth surfaces as lines for the engine of polyhedra, and its lines cut by smooth surfaces."""

from __future__ import annotations

import numpy as np

from vectorplot.scene.view import View
from vectorplot.visibility.lines import Lines
from vectorplot.visibility.smooth.curves import Curves, together
from vectorplot.visibility.smooth.family import StraightLines
from vectorplot.visibility.smooth.hidden_curves import cut_curves, hidden_curves
from vectorplot.visibility.smooth.traced import TracedScene


def with_curves(view: View, traced: TracedScene, lines: Lines, items: int, tolerance: float) -> Lines:
    """Straight lines and the chords of curves, all cut where smooth surfaces begin or end to hide them.

    items: how many the scene has; tolerance: how far chords are off their curves, in the image.
    """
    curves = together([traced.curves, _straight(lines)])
    found = hidden_curves(view, traced, curves, items, tolerance)
    start, end, curve, behind = cut_curves(curves, found)
    long = (start != end).any(axis=1)
    start, end, curve, behind = start[long], end[long], curve[long], behind[long]
    side = np.concatenate([np.zeros(len(traced.curves), dtype=np.intp), lines.side])
    smooth = np.arange(len(curves)) < len(traced.curves)
    return Lines(start.T, end.T, curves.kind[curve], curves.item[curve], side[curve], smooth[curve], behind)


def _straight(lines: Lines) -> Curves:
    """Lines as curves of two points."""
    count = len(lines)
    points = np.stack([lines.start.T, lines.end.T], axis=1).reshape(-1, 3)
    none = np.full_like(points, np.nan)
    return Curves(
        points,
        points,
        none,
        np.arange(0, 2 * count + 1, 2),
        np.zeros(count, dtype=np.bool_),
        lines.kind,
        lines.item,
        np.zeros(count, dtype=np.intp),
        np.zeros(count),
        (StraightLines(),),
    )
