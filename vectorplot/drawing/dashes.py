"""Dashed lines as real segments: what a pen plotter can draw."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import chosen, concatenated, sections, unrolled
from vectorplot.errors import InputError
from vectorplot.geometry import ragged

CHAIN_MM = (6.0, 2.0, 0.3)
"""Dash, gap and dot of centre lines (ISO 128-20, line 04)."""


SHORTEST = 1.0
"""An open stroke that is so many dashes long has a gap."""

WIDEST_GAP = 1.0 / 3.0
"""Of a stroke that has room for no two whole dashes."""


def dashed(
    paths: Paths, dash_mm: float, gap_mm: float, page_from_world: Floats | None = None, *, dot_mm: float = 0.0
) -> Paths:
    """The strokes broken into dashes, about length / (dash + gap) of them; every dash is a stroke, so clip to the page
    first. The pattern is stretched so that an open stroke begins and ends with a whole dash and a closed one joins
    up. page_from_world (4,4) as in Drawing, by default parallel; dot_mm: of dots in the middle of gaps.
    Edge cases: a short open stroke gets two shorter dashes with a gap; one shorter than a dash, or without room for two
    with dots, stays whole; a gap of 0 changes nothing. Errors: InputError unless the dash is positive, the gap not
    negative, and the dot no longer than the gap.
    """
    if not (0.0 < dash_mm < np.inf and 0.0 <= gap_mm < np.inf):
        raise InputError(f"dash and gap must be lengths in mm, got {dash_mm:g} and {gap_mm:g}")
    if not 0.0 <= dot_mm <= gap_mm:
        raise InputError(f"a dot of {dot_mm:g} mm in a gap of {gap_mm:g} mm has no room")
    length = stroke_lengths(paths)
    many = _number_of_dashes(paths, length, dash_mm, gap_mm)
    short = ~paths.closed & (many == 0) & (length >= SHORTEST * dash_mm) & (dot_mm == 0.0)
    many[short] = 2
    gap = np.where(short, np.minimum(gap_mm, WIDEST_GAP * length), gap_mm)
    dash = np.where(short, 0.5 * (length - gap), dash_mm)
    index = np.flatnonzero(many > 0)
    if gap_mm == 0.0 or not len(index):
        return paths
    broken = chosen(paths, index)
    laps = np.where(broken.closed, np.diff(broken.offsets), 0)
    world = np.eye(4) if page_from_world is None else page_from_world
    start, end, stroke = _dash_ends(many[index], length[index], broken.closed, dash[index], gap[index], dot_mm)
    parts = parts_between(unrolled(broken, np.zeros_like(laps), laps), stroke, start, end, world)
    whole = chosen(paths, many == 0)
    order = np.argsort(np.concatenate((np.flatnonzero(many == 0), index[stroke])), kind="stable")
    return chosen(concatenated((whole, parts)), order)


def stroke_lengths(paths: Paths) -> Floats:
    """The length of each stroke in mm, the closing segment included."""
    closing = paths.closed & (np.diff(paths.offsets) > 0)
    line = unrolled(paths, np.zeros(len(paths), dtype=np.intp), closing.astype(np.intp))
    along = _arc_length(line)
    filled = np.diff(line.offsets) > 0
    length = np.zeros(len(paths))
    length[filled] = along[line.offsets[1:][filled] - 1] - along[line.offsets[:-1][filled]]
    return length


def _arc_length(paths: Paths) -> Floats:
    """How far each point lies along its stroke, plus the lengths of all strokes before it."""
    steps = np.zeros(len(paths.points))
    steps[1:] = np.hypot(*np.diff(paths.points, axis=0).T)
    steps[paths.offsets[:-1][np.diff(paths.offsets) > 0]] = 0.0
    return np.cumsum(steps)


def _number_of_dashes(paths: Paths, length: Floats, dash_mm: float, gap_mm: float) -> Ints:
    """How many dashes a stroke is broken into; 0 where it stays whole."""
    open_ = np.rint((length + gap_mm) / (dash_mm + gap_mm))
    loop = np.rint(length / (dash_mm + gap_mm))
    count = np.where(paths.closed, loop, np.where(open_ >= 2.0, open_, 0.0))
    return count.astype(np.intp)


def _dash_ends(
    many: Ints, length: Floats, closed: Bools, dash_mm: Floats, gap_mm: Floats, dot_mm: float
) -> tuple[Floats, Floats, Ints]:
    """Where the dashes, and the dots before them, begin and end along their strokes, and whose they are; many, length,
    closed, dash_mm, gap_mm (m,): of each stroke."""
    stroke = ragged.owner(many)
    number = ragged.place(many)
    gaps = np.where(closed, many, many - 1)
    scale = length / (many * dash_mm + gaps * gap_mm)
    # On a loop the pattern starts half a dash later and its last dash lies over the seam, half on the second lap.
    shift = np.where(closed, 0.5 * dash_mm + gap_mm, 0.0)
    start = (number * (dash_mm + gap_mm)[stroke] + shift[stroke]) * scale[stroke]
    end = start + (dash_mm * scale)[stroke]
    last = ~closed[stroke] & (number == many[stroke] - 1)
    end = np.where(last, length[stroke], end)
    if not dot_mm:
        return start, end, stroke
    dotted = np.flatnonzero(closed[stroke] | (number > 0))
    dots = start[dotted] - (0.5 * (gap_mm + dot_mm) * scale)[stroke[dotted]]
    order = np.argsort(np.concatenate((2 * dotted, 2 * np.arange(len(start)) + 1)), kind="stable")
    start = np.concatenate((dots, start))[order]
    end = np.concatenate((dots + dot_mm * scale[stroke[dotted]], end))[order]
    return start, end, np.concatenate((stroke[dotted], stroke))[order]


def parts_between(paths: Paths, stroke: Ints, start: Floats, end: Floats, page_from_world: Floats) -> Paths:
    """The parts of open strokes from one length along them to another."""
    along = _arc_length(paths)
    first_point, last_point = paths.offsets[:-1][stroke], paths.offsets[1:][stroke] - 1
    base = along[first_point]
    start, end = base + start, base + end
    first = np.clip(np.searchsorted(along, start, side="right") - 1, first_point, last_point - 1)
    last = np.clip(np.searchsorted(along, end, side="left") - 1, first, last_point - 1)
    return sections(
        paths, stroke, first, _fraction(along, first, start), last, _fraction(along, last, end), page_from_world
    )


def _fraction(along: Floats, segment: Ints, place: Floats) -> Floats:
    run = along[segment + 1] - along[segment]
    t = (place - along[segment]) / np.where(run > 0.0, run, 1.0)
    return np.clip(t, 0.0, 1.0)
