"""What smooth surfaces hide of curves and lines: the second engine, as a sentence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import Budget
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.chord_parts import ChordParts
from vectorplot.visibility.smooth.events.crossings import crossings
from vectorplot.visibility.smooth.events.events import all_events
from vectorplot.visibility.smooth.events.missed_events import missed_events
from vectorplot.visibility.smooth.events.own_events import edge_on_curves, facing_of, own_events
from vectorplot.visibility.smooth.events.piercings import piercings
from vectorplot.visibility.smooth.hidden_pieces import Counts, Pieces, believed, carried, counted, cut, recounted
from vectorplot.visibility.smooth.runs import without_short_runs
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.targets import targets_of
from vectorplot.visibility.smooth.tracing.traced import TracedScene
from vectorplot.visibility.smooth.tracing.traced_curves import Curves


@dataclass(frozen=True, eq=False)
class HiddenCurves:
    """Pieces of curves, and the number (p,) of items with smooth surfaces that hide each; short: items for which the
    budget did not do."""

    pieces: Pieces
    hidden_by: Ints
    short: tuple[int, ...]


def hidden_curves(
    view: View,
    traced: TracedScene,
    curves: Curves,
    tolerance: float,
    budget: Budget,
    done: Callable[[float], None],
) -> HiddenCurves:
    """By how many items with smooth surfaces each piece of the curves is hidden.

    traced: the sheets, and the edges of those that hide; tolerance: how far chords are off their curves, in the image;
    done: is told the part of the work that is done.
    The number of sheets in front of a curve changes only where its image crosses that of a fold or border in front, at
    a cusp of a contour, and where it pierces a sheet or passes the contour of its own: there the curves are cut. Then
    each piece is decided once, by the sight line of its safest point, or by the changes from a neighbour. Runs shorter
    than two tolerances are none.
    Source: Glaeser, section 8.4 and figure 13 for what is drawn; the decisions are this package's own.
    """
    # Only items with sheets that hide are counted: a scene may have thousands of others.
    hiding = np.unique(traced.sheets.item[traced.sheets.hides])
    sheets = replace(traced.sheets, counted_as=np.searchsorted(hiding, traced.sheets.item))
    edges = replace(traced.edges, item=np.searchsorted(hiding, traced.edges.item))
    targets = targets_of(view, sheets)
    facing = facing_of(view, sheets, curves)
    edge_on = edge_on_curves(curves, facing)
    own = own_events(view, sheets, curves, facing, edge_on)
    done(0.2)
    crossed, short_of_crossings = crossings(view, sheets, curves, edges, edge_on, tolerance, budget.pairs)
    done(0.4)
    pierced, short_of_piercings = piercings(view, sheets, targets, curves, traced.meets_itself, budget.pairs)
    done(0.6)
    events = all_events([own, crossed, pierced])
    pieces = cut(curves, events)

    def count(pieces: Pieces) -> Counts:
        return counted(view, sheets, targets, curves, edges, edge_on, pieces, tolerance, budget.pairs)

    counts = count(pieces)
    done(0.8)
    more, short_of_halvings = missed_events(view, sheets, targets, curves, edge_on, pieces, counts, budget.pairs)
    if len(more):
        again = cut(curves, all_events([events, more]))
        pieces, counts = again, recounted(pieces, counts, again, count)
    unlooked = [*short_of_piercings, *short_of_halvings, *counts.unlooked]
    short = {*short_of_crossings, *hiding[unlooked].tolist()} if unlooked else {*short_of_crossings}
    hidden_by = np.bincount(carried(pieces, believed(pieces, counts)).row, minlength=len(pieces))
    hidden_by = without_short_runs(view, curves, pieces, hidden_by, 2.0 * tolerance)
    return HiddenCurves(pieces, hidden_by, tuple(sorted(short)))


def cut_curves(sheets: Sheets, curves: Curves, found: HiddenCurves) -> tuple[Floats, Floats, ChordParts, Ints]:
    """The chords of all pieces on sheets, cut at events: start and end (c,3), which parts of chords, hidden_by (c,)."""
    pieces = found.pieces
    count = pieces.end_chord - pieces.begin_chord + 1
    first = ragged.starts(count)
    owner = ragged.owner(count)
    step = np.arange(len(owner)) - first[owner]
    chord = pieces.begin_chord[owner] + step
    start, end = curves.points[chord].copy(), curves.points[chord + 1].copy()
    begin_part, end_part = np.zeros(len(chord)), np.ones(len(chord))
    begin_part[first], end_part[first + count - 1] = pieces.begin_part, pieces.end_part
    inner = np.flatnonzero(pieces.begin_part > 0.0)
    start[first[inner]] = curves.at(pieces.begin_chord[inner], pieces.begin_part[inner]).points
    inner = np.flatnonzero(pieces.end_part < 1.0)
    end[(first + count - 1)[inner]] = curves.at(pieces.end_chord[inner], pieces.end_part[inner]).points
    return start, end, ChordParts(sheets, curves, chord, begin_part, end_part), found.hidden_by[owner]
