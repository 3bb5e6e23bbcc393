"""Curves of smooth surfaces as lines for the engine of polyhedra, and its lines cut by smooth surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from vectorplot.geometry.budget import USUAL, Budget, unheard, unresolved
from vectorplot.scene.view import View
from vectorplot.tolerances.of_parameters import LEAST_PART
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.visibility.smooth.events.events import all_events
from vectorplot.visibility.smooth.hidden_curves import HiddenCurves, cut_curves, hidden_curves
from vectorplot.visibility.smooth.hidden_pieces import cut
from vectorplot.visibility.smooth.sheets.family import StraightLines
from vectorplot.visibility.smooth.tracing.traced import TracedScene
from vectorplot.visibility.smooth.tracing.traced_curves import Curves, together


def cut_lines_and_chords(
    view: View,
    traced: TracedScene,
    lines: Lines,
    tolerance: float,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> tuple[Lines, tuple[tuple[int, str], ...]]:
    """Straight lines and the chords of curves, all cut where smooth surfaces begin or end to hide them; and items with
    a doubt about each that could not be decided.

    tolerance: how far chords are off their curves, in the image; budget: of the work; done: is told the part of it that
    is done.
    """
    curves = together([traced.curves, _straight(lines)])
    found = hidden_curves(view, traced, curves, tolerance, budget, done)
    doubts = tuple((item, unresolved("lines in front of or behind it may be drawn wrong")) for item in found.short)
    return _as_lines(traced, lines, curves, found), doubts


def whole_lines_and_chords(traced: TracedScene, lines: Lines) -> Lines:
    """Straight lines and the chords of curves, from end to end, as if nothing hid them."""
    curves = together([traced.curves, _straight(lines)])
    pieces = cut(curves, all_events([]))
    whole = HiddenCurves(pieces, np.zeros(len(pieces), dtype=np.intp), ())
    return _as_lines(traced, lines, curves, whole)


def _as_lines(traced: TracedScene, lines: Lines, curves: Curves, found: HiddenCurves) -> Lines:
    """The chords of pieces of curves: those of the scene, and after them the straight lines."""
    start, end, chords, behind = cut_curves(traced.sheets, curves, found)
    long = (start != end).any(axis=1) & (chords.end - chords.begin > LEAST_PART)
    start, end, chords, behind = start[long], end[long], chords.some(long), behind[long]
    chord, curve = chords.chord, curves.owner[chords.chord]
    smooth = curve < len(traced.curves)
    side = np.zeros(len(chord), dtype=np.intp)
    side[~smooth] = lines.side[curve[~smooth] - len(traced.curves)]
    aside = np.zeros((3, len(chord)))
    aside[:, ~smooth] = lines.aside[:, curve[~smooth] - len(traced.curves)]
    side[smooth] = curves.side[curve[smooth]]
    behind = behind + curves.behind[curve]
    chords = replace(chords, chord=np.where(smooth, chord, -1))
    return Lines(start.T, end.T, curves.kind[curve], curves.item[curve], side, smooth, behind, aside, chords)


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
