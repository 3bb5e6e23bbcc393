"""Ends of strokes where many of them run into one point, as in the apex of a cone: there ink would make a blot."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.dashes import parts_between, stroke_lengths
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated, unrolled
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import with_points
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.tolerances.of_the_page import COINCIDENT_MM

FEWEST = 8
"""So many lines that end in one point converge; fewer make a corner, as of a mesh."""


def thinned_ends(paths: Paths, width_mm: float, page_from_world: Floats) -> Paths:
    """The strokes, those that converge ending early: where many lines of that width meet in a point, every second one
    stops where the gaps to its neighbours would be narrower than the lines, every fourth one at half of that distance,
    and so on; one reaches the point. Strokes that go on through the point are divided there.

    Degenerate: strokes that would lose more than a third of their length at one end lose only that.
    """
    paths = _divided(paths)
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


def _divided(paths: Paths) -> Paths:
    """The strokes, divided in the points where lines converge."""
    if not len(paths):
        return paths
    size = np.diff(paths.offsets)
    place = np.unique(np.rint(paths.points / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    inside = np.ones(len(paths.points), dtype=np.bool_)
    open_ = ~paths.closed & (size > 0)
    inside[paths.offsets[:-1][open_]] = False
    inside[paths.offsets[1:][open_] - 1] = False
    meeting = np.bincount(place, weights=np.where(inside, 2.0, 1.0))[place] >= FEWEST
    owner = ragged.owner(size)
    loops = np.unique(owner[meeting & paths.closed[owner]])
    if len(loops):
        first = np.array([np.flatnonzero(meeting[paths.offsets[k] : paths.offsets[k + 1]])[0] for k in loops.tolist()])
        kept = np.ones(len(paths), dtype=np.bool_)
        kept[loops] = False
        opened = unrolled(chosen(paths, loops), first, np.ones(len(loops), dtype=np.intp))
        return _divided(concatenated((chosen(paths, kept), opened)))
    cut = meeting & inside
    if not cut.any():
        return paths
    copies = np.where(cut, 2, 1)
    point = np.repeat(np.arange(len(paths.points)), copies)
    again = ragged.place(copies) == 1
    begins = np.zeros(len(point) + 1, dtype=np.bool_)
    begins[np.flatnonzero(again)] = True
    begins[(paths.offsets + np.concatenate([[0], np.cumsum(cut)])[paths.offsets])] = True
    offsets = np.flatnonzero(begins)
    return with_points(paths, point, owner[point[offsets[:-1]]], offsets)


def _cuts(ends: Floats, inner: Floats, width_mm: float) -> Floats:
    """(n,) how much is cut from each of the ends (n,2) of strokes that go on towards inner points (n,2)."""
    place = np.unique(np.rint(ends / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    count = np.bincount(place)
    many = np.flatnonzero(count[place] >= FEWEST)
    cut = np.zeros(len(ends))
    if not len(many):
        return cut
    way = inner[many] - ends[many]
    angle = arctan2(way[:, 1], way[:, 0])
    order = np.lexsort((angle, place[many]))
    sizes = np.diff(np.flatnonzero(np.concatenate([[True], np.diff(place[many][order]) > 0, [True]])))
    turn: Ints = ragged.place(sizes)
    # The first one reaches the point; of the others the power of two in their place says how far they come.
    power = turn & -turn
    meeting = 2.0 * width_mm / _spacing(angle[order], ragged.offsets(sizes))
    cut[many[order]] = np.where(turn > 0, meeting / np.maximum(power, 1), 0.0)
    return cut


def _spacing(angle: Floats, offsets: Ints) -> Floats:
    """(n,) the angle from each line to its neighbours, on average, of the lines through several points, one after the
    other; those next to the widest gap of all about a point count the other neighbour only, where that is nearer."""
    before = ragged.preceding(offsets)
    gap = np.mod(angle - angle[before], 2.0 * np.pi)
    widest = np.maximum.reduceat(gap, offsets[:-1])
    outside = gap >= np.repeat(widest, np.diff(offsets))
    back = np.where(outside, np.nan, gap)
    ahead = np.empty_like(back)
    ahead[before] = back
    one = np.where(np.isnan(back), ahead, np.where(np.isnan(ahead), back, 0.5 * (back + ahead)))
    return np.maximum(np.where(np.isnan(one), gap, one), ROUNDING)
