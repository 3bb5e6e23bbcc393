"""Ends of strokes where many of them run into one point, as in the apex of a cone: there ink would make a blot."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.dashes import parts_between, stroke_lengths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_the_page import COINCIDENT_MM

FEWEST = 5
"""So many ends of strokes in one point converge; fewer make a corner."""


def thinned_ends(paths: Paths, width_mm: float, page_from_world: Floats) -> Paths:
    """The strokes, those that converge ending early: where n ends of lines of that width meet in a point, every second
    one stops where the lines would touch their neighbours, every fourth one at half of that distance, and so on; one
    reaches the point. Around the point lines stay apart by about their width.

    Degenerate: strokes that would lose more than a third of their length at one end lose only that.
    """
    open_ = np.flatnonzero(~paths.closed & (np.diff(paths.offsets) > 1))
    if len(open_) < FEWEST:
        return paths
    first, last = paths.offsets[:-1][open_], paths.offsets[1:][open_] - 1
    ends = paths.points[np.concatenate([first, last])]
    inner = paths.points[np.concatenate([first + 1, last - 1])]
    cut = _cuts(ends, inner, width_mm)
    length = stroke_lengths(paths)
    cut = np.minimum(cut.reshape(2, -1), length[open_] / 3.0)
    short = (cut > 0.0).any(axis=0)
    if not short.any():
        return paths
    which = open_[short]
    begin, end = cut[0, short], length[which] - cut[1, short]
    parts = parts_between(chosen(paths, which), np.arange(len(which)), begin, end, page_from_world)
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[which] = False
    order = np.argsort(np.concatenate([np.flatnonzero(kept), which]), kind="stable")
    return chosen(concatenated((chosen(paths, kept), parts)), order)


def _cuts(ends: Floats, inner: Floats, width_mm: float) -> Floats:
    """(n,) how much is cut from each of the ends (n,2) of strokes that go on towards inner points (n,2)."""
    place = np.unique(np.rint(ends / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    count = np.bincount(place)
    many = np.flatnonzero(count[place] >= FEWEST)
    cut = np.zeros(len(ends))
    if not len(many):
        return cut
    way = inner[many] - ends[many]
    order = np.lexsort((np.arctan2(way[:, 1], way[:, 0]), place[many]))
    sizes = np.diff(np.flatnonzero(np.concatenate([[True], np.diff(place[many][order]) > 0, [True]])))
    turn: Ints = ragged.place(sizes)
    meeting = np.repeat(sizes, sizes) * width_mm / np.pi
    # The first one reaches the point; of the others the power of two in their place says how far they come.
    power = turn & -turn
    cut[many[order]] = np.where(turn > 0, meeting / np.maximum(power, 1), 0.0)
    return cut
