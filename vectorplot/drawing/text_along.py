"""Texts whose letters stand along curves, and strokes that stop before letters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.formulas import FORMULA
from vectorplot.drawing.letters import (
    ALIGNED,
    CAPITAL,
    Glyph,
    Lettering,
    as_one,
    check_size,
    clusters,
    glyph,
    measured,
    no_strokes,
    reach_of,
    rectangles,
    set_glyphs,
    turned,
)
from vectorplot.drawing.strokes import chosen, concatenated, kept_parts, segments_of, unrolled
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import intervals
from vectorplot.geometry.elementary import arctan2
from vectorplot.scene.page import in_latex
from vectorplot.tolerances import UNION_OF_SEGMENT

# Texts whose letters stand along curves.

BACK = 6
"""How many letters before each one along a curve may be in its way."""

NEAREST = 0.2
"""Letters along a curve may stand so far in each other's boxes, which are larger than they, in heights of capitals."""

STEEP_SINE = 0.26
"""Texts that are less than 15 degrees from upright are all read from the right (ISO 129), whichever way they lean."""

STEP, MOST_STEPS = 0.05, 120
"""By such steps, in heights of capitals, letters go on along a curve until they stand clear, by so many at most."""


def lettered_along(
    text: str,
    path: ArrayLike,
    *,
    size_mm: float = 3.5,
    align: Literal["left", "centre", "right"] = "centre",
    level: Literal["base", "middle", "top"] = "middle",
    at: float = 0.5,
    off_mm: float = 0.0,
) -> Lettering:
    """A text whose letters stand along a curve, each upright to it.

    Parameters
    ----------
    text : str
        In one line, see lettered.
    path : (n, 2) array_like of float
        Points of the curve in mm, n >= 2.
    size_mm, align : float and str
        See lettered.
    level : {"base", "middle", "top"}
        Whether the curve runs under the letters, through their middle, or above them.
    at : float
        At what part of the length of the curve the text is.
    off_mm : float
        How far above the curve the letters are, as one reads them; negative: below.

    Returns
    -------
    Lettering
        In mm; a text that would be upside down, or nearly upright downwards, runs along the curve the other way.

    Raises
    ------
    InputError
        See lettered; for a path without length.

    Notes
    -----
    What does not fit goes on straight ahead at the ends of the curve.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import drawing
    >>> angle = np.linspace(np.pi, 0.0, 91)
    >>> arch = 50.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    >>> text = drawing.lettered_along("Vitruvius", arch, level="base")
    >>> len(text.boxes), bool(np.hypot(*text.strokes.points.T).min() > 48.0)
    (9, True)
    """
    found, unit = [glyph(cluster) for cluster in clusters(text)], size_mm / CAPITAL
    course = _trace(found, path, size_mm, align, level, at, off_mm)
    return Lettering(set_glyphs(found, unit, course.foot, course.turn), course.boxes)


def typeset_along(
    text: str,
    path: ArrayLike,
    *,
    size_mm: float = 3.5,
    align: Literal["left", "centre", "right"] = "centre",
    level: Literal["base", "middle", "top"] = "middle",
    at: float = 0.5,
    off_mm: float = 0.0,
) -> Lettering:
    """A text of which each letter is set in a font, upright to a curve; one with a formula is set as a whole.

    Parameters
    ----------
    text : str
        See typeset, in one line.
    path, size_mm, align, level, at, off_mm : array_like, float, str, str, float and float
        See lettered_along.

    Returns
    -------
    Lettering
        In mm, without strokes.

    Raises
    ------
    InputError
        See typeset; for a path without length.

    Examples
    --------
    >>> from vectorplot import drawing
    >>> river = drawing.typeset_along("Inn", [(0, 0), (30, 0), (60, 20)])
    >>> river.texts.strings
    ('I', 'n', 'n')
    """
    letters = [text] if FORMULA.search(text) else clusters(text)
    found = [as_one(measured(letter)) for letter in letters]
    course = _trace(found, path, size_mm, align, level, at, off_mm)
    shown = np.array([k for k, letter in enumerate(letters) if letter.strip()], dtype=np.intp)
    count = len(shown)
    texts = Texts(
        tuple(letters[k] for k in shown),
        course.foot[shown],
        np.full(count, size_mm),
        course.turn_deg[shown],
        np.zeros(count),
        np.array([one.advance for one in found])[shown] * size_mm / CAPITAL,
        np.zeros(count, dtype=np.intp),
        (in_latex(size_mm),) * count,
    )
    # A font's letters are narrower or wider than strokes: in the middle of their room they stay evenly apart.
    return Lettering(no_strokes(), course.boxes, texts.anchored(0.5))


@dataclass(frozen=True, eq=False)
class _Course:
    """Letters along a curve: their feet (n,2), left ends, the directions (n,) and matrices (n,2,2) they are turned by,
    their boxes (n,4,2)."""

    foot: Floats
    turn_deg: Floats
    turn: Floats
    boxes: Floats


def _trace(
    found: Sequence[Glyph], path: ArrayLike, size_mm: float, align: str, level: str, at: float, off_mm: float
) -> _Course:
    check_size(size_mm)
    unit = size_mm / CAPITAL
    points = np.asarray(path, dtype=np.float64)
    steps = np.hypot(*np.diff(points, axis=0).T) if points.ndim == 2 and points.shape[1] == 2 else np.zeros(0)
    kept = np.append(True, steps > 0.0)[: len(points)]
    points, whole = points[kept], float(steps.sum())
    if not 0.0 < whole < np.inf:
        raise InputError("a text along a curve: the curve has no length")
    advance = np.array([one.advance for one in found], dtype=np.float64) * unit
    length = float(advance.sum())
    begin, end = (at * whole + part * length for part in (-ALIGNED[align], 1.0 - ALIGNED[align]))
    (from_, to), _ = _along(points, np.array([begin, end]))
    if reads_backwards(*(to - from_).tolist()):
        points, begin = points[::-1], whole - end
    middle = begin + np.cumsum(advance) - 0.5 * advance
    down = {"base": 0.0, "middle": 0.5 * size_mm, "top": size_mm}[level] - off_mm
    low, high = (unit * end for end in reach_of(found))
    course = _upright(points, middle, advance, down, low, high)
    boxes, slack = course.boxes, NEAREST * size_mm
    if any(_overlaps(boxes[:-lag], boxes[lag:], slack).any() for lag in range(1, min(BACK, len(boxes)))):
        middle = _apart(points, middle, advance, down, low, high, size_mm)
        course = _upright(points, middle, advance, down, low, high)
    return course


def reads_backwards(across: float, upwards: float) -> bool:
    """Whether a text in this direction would be upside down, or nearly upright downwards."""
    return upwards < 0.0 if abs(across) < STEEP_SINE * math.hypot(across, upwards) else across < 0.0


def _upright(points: Floats, middle: Floats, advance: Floats, down: float, low: float, high: float) -> _Course:
    """Letters of some widths whose middles are at these lengths along a curve."""
    place, way = _along(points, middle)
    turn_deg = np.degrees(arctan2(way[:, 1], way[:, 0]))
    turn = turned(turn_deg)
    foot = place - np.einsum("nij,nj->ni", turn, np.stack([0.5 * advance, np.full(len(advance), down)], axis=1))
    corner = np.tile([0.0, low], (len(advance), 1))
    boxes = rectangles(corner, advance, np.full(len(advance), high - low))
    return _Course(foot, turn_deg, turn, np.einsum("nij,nkj->nki", turn, boxes) + foot[:, None])


def _apart(
    points: Floats, middle: Floats, advance: Floats, down: float, low: float, high: float, size_mm: float
) -> Floats:
    """(n,) lengths along a curve so far apart that letters do not overlap where it turns sharply: each goes on until
    it stands clear of the one before it, and all of them back by one half of what the last one has gone."""
    steps = STEP * size_mm * np.arange(MOST_STEPS)
    found, gone = middle, 0.0
    for part in (0.0, 0.5):
        # The second time the text has its middle about where it is to be.
        found, gone = np.zeros(len(middle)), -part * gone
        taken = np.zeros((0, 4, 2))
        for k, (at, wide) in enumerate(zip(middle.tolist(), advance.tolist(), strict=True)):
            tried = at + gone + steps
            boxes = _upright(points, tried, np.full(len(tried), wide), down, low, high).boxes
            pairs = np.tile(taken, (len(tried), 1, 1)), np.repeat(boxes, len(taken), axis=0)
            clear = ~_overlaps(*pairs, NEAREST * size_mm).reshape(len(tried), len(taken)).any(axis=1)
            which = int(np.argmax(clear)) if clear.any() else 0
            found[k], gone = tried[which], gone + float(steps[which])
            taken = np.concatenate([taken, boxes[which : which + 1]])[-BACK:]
    return found


def _overlaps(boxes: Floats, others: Floats, slack: float) -> Bools:
    """(n,) whether rectangles (n,4,2) reach more than slack into each other."""
    apart = np.full(len(boxes), -np.inf)
    for one in (boxes, others):
        for axis in (one[:, 1] - one[:, 0], one[:, 3] - one[:, 0]):
            long = np.sqrt((axis * axis).sum(axis=1, keepdims=True))
            unit = axis / np.where(long > 0.0, long, 1.0)
            first, second = (np.einsum("nkj,nj->nk", some, unit) for some in (boxes, others))
            gap = np.maximum(second.min(axis=1) - first.max(axis=1), first.min(axis=1) - second.max(axis=1))
            apart = np.maximum(apart, gap)
    return apart < -slack


def _along(points: Floats, length: Floats) -> tuple[Floats, Floats]:
    """(n,2) the points after so much (n,) of a polyline, and (n,2) the unit directions it has there; straight on
    beyond its ends."""
    steps = np.diff(points, axis=0)
    long = np.hypot(*steps.T)
    passed = np.concatenate([[0.0], np.cumsum(long)])
    segment = np.clip(np.searchsorted(passed, length, side="right") - 1, 0, len(long) - 1)
    way = steps[segment] / long[segment][:, None]
    return points[segment] + (length - passed[segment])[:, None] * way, way


# Strokes that stop before letters.


def grown(boxes: Floats, margin_mm: float) -> Floats:
    """(b,4,2) the rectangles, wider and higher by a margin on every side."""
    sides = np.stack([boxes[:, 1] - boxes[:, 0], boxes[:, 3] - boxes[:, 0]], axis=1)
    long = np.sqrt((sides * sides).sum(axis=2, keepdims=True))
    step = margin_mm * sides / np.where(long > 0.0, long, 1.0)
    across, up = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    return np.asarray(boxes + across[:, None] * step[:, :1] + up[:, None] * step[:, 1:])


def outside_boxes(paths: Paths, boxes: Floats, page_from_world: Floats) -> Paths:
    """The parts of strokes outside of rectangles, in order. boxes (b,4,2): corners, counter-clockwise; page_from_world
    (4,4) as in Drawing: points in the world are cut where the page is. A closed stroke that is cut becomes open
    ones. Edge cases: what only touches stays.
    Source: Cyrus and Beck, Generalized two- and three-dimensional clipping, Computers & Graphics 3 (1978).
    """
    touched = _touched(paths, boxes)
    if not len(touched):
        return paths
    cut = chosen(paths, touched)
    cut = unrolled(cut, np.zeros(len(cut), dtype=np.intp), cut.closed.astype(np.intp))
    owner, starts = segments_of(cut)
    a, b = cut.points[starts], cut.points[starts + 1]
    segment, box = near_boxes(a, b, boxes)
    low, high = inside_box(a[segment], b[segment], boxes[box])
    hit = low < high
    fine = np.full(len(starts), UNION_OF_SEGMENT)
    covered = intervals.union(segment[hit], low[hit], high[hit], fine)
    segment, low, high = intervals.complement(len(starts), *covered, fine)
    parts, stroke = kept_parts(cut, owner, starts, segment, low, high, page_from_world)
    whole = np.ones(len(paths), dtype=np.bool_)
    whole[touched] = False
    source = np.concatenate([np.flatnonzero(whole), touched[stroke]])
    return chosen(concatenated((chosen(paths, whole), parts)), np.argsort(source, kind="stable"))


def outside_others(lines: Floats, own: Ints, boxes: Floats, owner: Ints) -> tuple[Floats, Ints]:
    """The parts (m,2,2) of straight lines (k,2,2) outside of the rectangles (b,4,2) of other owners, and the line (m,)
    each is of; own (k,), owner (b,): whose they are."""
    segment, box = near_boxes(lines[:, 0], lines[:, 1], boxes)
    low, high = inside_box(lines[segment, 0], lines[segment, 1], boxes[box])
    hit = (low < high) & (own[segment] != owner[box])
    fine = np.full(len(lines), UNION_OF_SEGMENT)
    covered = intervals.union(segment[hit], low[hit], high[hit], fine)
    line, low, high = intervals.complement(len(lines), *covered, fine)
    part = np.stack([low, high], axis=1)[:, :, None]
    return (1.0 - part) * lines[line, :1] + part * lines[line, 1:], line


def near_boxes(start: Floats, end: Floats, boxes: Floats) -> tuple[Ints, Ints]:
    """Pairs of a segment, from start to end (s,2), and one of the rectangles (b,4,2) whose bounds overlap."""
    import shapely

    low, high = boxes.min(axis=1), boxes.max(axis=1)
    left, right = np.minimum(start, end), np.maximum(start, end)
    reach = ((left <= high.max(axis=0, initial=-np.inf)) & (right >= low.min(axis=0, initial=np.inf))).all(axis=1)
    some = np.flatnonzero(reach)
    tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    segment, box = tree.query(shapely.box(left[some, 0], left[some, 1], right[some, 0], right[some, 1]))
    return some[segment], np.asarray(box)


def inside_box(start: Floats, end: Floats, boxes: Floats) -> tuple[Floats, Floats]:
    """(n,) and (n,) between which parameters each segment, from start to end (n,2), is inside of its rectangle (n,4,2);
    low >= high: nowhere."""
    along = np.roll(boxes, -1, axis=1) - boxes
    inward = np.stack([-along[:, :, 1], along[:, :, 0]], axis=2)
    first, last = (((point[:, None] - boxes) * inward).sum(axis=2) for point in (start, end))
    run = last - first
    at = -first / np.where(run != 0.0, run, 1.0)
    low = np.where(run > 0.0, at, np.where((run == 0.0) & (first <= 0.0), np.inf, -np.inf)).max(axis=1, initial=0.0)
    high = np.where(run < 0.0, at, np.inf).min(axis=1, initial=1.0)
    return low, high


def _touched(paths: Paths, boxes: Floats) -> Ints:
    """The strokes whose bounds overlap those of a rectangle."""
    filled = np.flatnonzero(np.diff(paths.offsets) > 0)
    if not len(filled) or not len(boxes):
        return np.zeros(0, dtype=np.intp)
    first = paths.offsets[filled]
    low, high = np.minimum.reduceat(paths.points, first), np.maximum.reduceat(paths.points, first)
    return filled[np.unique(near_boxes(low, high, boxes)[0])]
