"""Text as polylines on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.lettering.accents import CAPITAL
from vectorplot.drawing.lettering.formulas import FORMULA, without_formulas
from vectorplot.drawing.lettering.hershey import Glyph, clusters, glyph, room_of
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import Polylines

ALIGNED = {"left": 0.0, "centre": 0.5, "right": 1.0}
"""What part of a text lies before the point it is at."""

LEVELS = ("base", "middle", "top", "bottom")
"""What of a text is as high as the point it is at: the first line's foot, the middle, or the ends of all lines."""

LINES_APART = 1.7
"""From one line of text to the next, in heights of capitals."""

NEAREST = 0.2
"""Letters along a curve may stand so far in each other's boxes, which are larger than they, in heights of capitals."""

STEP, MOST_STEPS = 0.05, 120
"""By such steps, in heights of capitals, letters go on along a curve until they stand clear, by so many at most."""

BACK = 6
"""How many letters before each one along a curve may be in its way."""

DESCENT = 1.0 / 3.0
"""How far letters reach below their line, in heights of capitals."""


@dataclass(frozen=True, eq=False)
class Lettering:
    """A text on the page: strokes of a pen, or lines in a font.

    Parameters
    ----------
    strokes : Polylines
        Points (p, 2) in mm, y upwards; letter by letter as one reads. None where it is typeset.
    boxes : (b, 4, 2) array of float
        The corners of the rectangles that the text fills, counter-clockwise from the lower left one as one reads: one
        for each line, as high as its letters; or of a text along a curve one for each letter.
    texts : Texts
        Its lines where it is typeset, or of a text along a curve its letters.

    Examples
    --------
    >>> from vectorplot import drawing
    >>> text = drawing.lettered("I", size_mm=7)
    >>> text.strokes.points.max(axis=0).round(6).tolist()
    [1.333333, 7.0]
    """

    strokes: Polylines
    boxes: Floats
    texts: Texts = field(default_factory=Texts.none)

    def __len__(self) -> int:
        return len(self.strokes) + len(self.texts)

    @property
    def bounds(self) -> Floats:
        """(2, 2) smallest and largest coordinates of its boxes; zeros for an empty text."""
        corners = self.boxes.reshape(-1, 2)
        return np.stack([corners.min(axis=0), corners.max(axis=0)]) if len(corners) else np.zeros((2, 2))

    def moved(self, way: Floats) -> Lettering:
        """The same, moved on the page by (2,)."""
        strokes = replace(self.strokes, points=self.strokes.points + way)
        return Lettering(strokes, self.boxes + way, self.texts.moved(way))


def lettered(
    text: str,
    at: ArrayLike = (0.0, 0.0),
    *,
    size_mm: float = 3.5,
    align: Literal["left", "centre", "right"] = "left",
    level: Literal["base", "middle", "top", "bottom"] = "base",
    rotation_deg: float = 0.0,
) -> Lettering:
    """A text in letters of single strokes, in one line or several.

    Parameters
    ----------
    text : str
        Characters; a line feed begins a new line. Latin letters with any accents, Greek and Cyrillic ones, figures,
        also high and low ones, and signs of arithmetic are known.
    at : (float, float)
        In mm, where the text is.
    size_mm : float
        The height of capitals.
    align : {"left", "centre", "right"}
        Whether it begins, has its middle, or ends there; so does each of several lines.
    level : {"base", "middle", "top", "bottom"}
        Whether the foot of its first line, the middle of its capitals, or the highest or lowest that letters reach is
        there.
    rotation_deg : float
        How far it is turned about that point, counter-clockwise.

    Returns
    -------
    Lettering
        In mm.

    Raises
    ------
    InputError
        For a character that there are no strokes for, and a size that is not finite and positive.

    Notes
    -----
    Degenerate: an empty text, and one of blanks, has no strokes.

    Source: Hershey, Calligraphy for computers, U.S. Naval Weapons Laboratory, report 2101 (1967).

    Examples
    --------
    >>> from vectorplot import drawing
    >>> name = drawing.lettered("Ångström", at=(50, 20), size_mm=5, align="centre", level="middle")
    >>> name.bounds.mean(axis=0).round(6).tolist()[0]
    50.0
    """
    _check_size(size_mm)
    lines = [[glyph(cluster) for cluster in clusters(line)] for line in text.split("\n")]
    unit = size_mm / CAPITAL
    origin = np.asarray(at, dtype=np.float64)
    layout = _layout(lines, origin, size_mm, align, level, rotation_deg)
    advance = np.array([one.advance for one in chain(*lines)], dtype=np.float64) * unit
    counts = [len(line) for line in lines]
    line = ragged.owner(counts)
    passed = np.concatenate([[0.0], np.cumsum(advance)])
    along = passed[:-1] - passed[ragged.starts(counts)][line]
    place = np.stack([layout.begin[line] + along, layout.foot[line]], axis=1)
    turn = _turn(np.full(len(advance), rotation_deg))
    return Lettering(_set([*chain(*lines)], unit, origin + place @ layout.turn.T, turn), layout.boxes)


def typeset(
    text: str,
    at: ArrayLike = (0.0, 0.0),
    *,
    size_mm: float = 3.5,
    align: Literal["left", "centre", "right"] = "left",
    level: Literal["base", "middle", "top", "bottom"] = "base",
    rotation_deg: float = 0.0,
) -> Lettering:
    """A text that is set in a font by what reads the file, in one line or several.

    Parameters
    ----------
    text : str
        As of lettered, but of any characters.
    at, size_mm, align, level, rotation_deg : (float, float), float, str, str and float
        As of lettered.

    Returns
    -------
    Lettering
        In mm, without strokes. The room it takes is that of the same text in single strokes: no font is known here.

    Raises
    ------
    InputError
        For a size that is not finite and positive.

    Notes
    -----
    Degenerate: an empty line, and one of blanks, is none.

    Examples
    --------
    >>> from vectorplot import drawing
    >>> name = drawing.typeset("東京", at=(50, 20), align="centre")
    >>> name.texts.strings, name.texts.anchor.tolist(), len(name.boxes)
    (('東京',), [0.5], 1)
    """
    _check_size(size_mm)
    written = text.split("\n")
    origin = np.asarray(at, dtype=np.float64)
    layout = _layout([_measured(line) for line in written], origin, size_mm, align, level, rotation_deg)
    rows = np.array([k for k, line in enumerate(written) if line.strip()], dtype=np.intp)
    foot = np.stack([np.zeros(len(rows)), layout.foot[rows]], axis=1)
    count = len(rows)
    texts = Texts(
        tuple(written[k].strip() for k in rows),
        origin + foot @ layout.turn.T,
        np.full(count, size_mm),
        np.full(count, rotation_deg),
        np.full(count, ALIGNED[align]),
        layout.length[rows],
        np.zeros(count, dtype=np.intp),
    )
    return Lettering(_no_strokes(), layout.boxes, texts)


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
        In one line, as of lettered.
    path : (n, 2) array_like of float
        Points of the curve in mm, n >= 2.
    size_mm, align : float and str
        As of lettered.
    level : {"base", "middle", "top"}
        Whether the curve runs under the letters, through their middle, or above them.
    at : float
        At what part of the length of the curve the text is.
    off_mm : float
        How far above the curve the letters are, as one reads them; negative: below.

    Returns
    -------
    Lettering
        In mm; a text that would be upside down runs along the curve the other way.

    Raises
    ------
    InputError
        As of lettered; for a path without length.

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
    course = _course(found, path, size_mm, align, level, at, off_mm)
    return Lettering(_set(found, unit, course.foot, course.turn), course.boxes)


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
        As of typeset, in one line.
    path, size_mm, align, level, at, off_mm : array_like, float, str, str, float and float
        As of lettered_along.

    Returns
    -------
    Lettering
        In mm, without strokes.

    Raises
    ------
    InputError
        As of typeset; for a path without length.

    Examples
    --------
    >>> from vectorplot import drawing
    >>> river = drawing.typeset_along("Inn", [(0, 0), (30, 0), (60, 20)])
    >>> river.texts.strings
    ('I', 'n', 'n')
    """
    letters = [text] if FORMULA.search(text) else clusters(text)
    found = [_as_one(_measured(letter)) for letter in letters]
    course = _course(found, path, size_mm, align, level, at, off_mm)
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
    )
    # A font's letters are narrower or wider than strokes: in the middle of their room they stay evenly apart.
    return Lettering(_no_strokes(), course.boxes, texts.anchored(0.5))


@dataclass(frozen=True, eq=False)
class _Layout:
    """Lines of text: where each begins (l,) and how high (l,) its foot is, from the point that the text is at, before
    it is turned by a matrix (2,2); their lengths (l,); the boxes (b,4,2) of those that are not blank."""

    begin: Floats
    foot: Floats
    length: Floats
    turn: Floats
    boxes: Floats


def _layout(
    lines: Sequence[Sequence[Glyph]], origin: Floats, size_mm: float, align: str, level: str, rotation_deg: float
) -> _Layout:
    unit = size_mm / CAPITAL
    length = np.array([sum(one.advance for one in line) for line in lines]) * unit
    begin = -ALIGNED[align] * length
    foot = -LINES_APART * size_mm * np.arange(len(lines))
    high, low = size_mm, foot[-1] - DESCENT * size_mm
    foot -= {"base": 0.0, "top": high, "bottom": low, "middle": 0.5 * (foot[-1] + high)}[level]
    reach = unit * np.array([_reach(some) for some in lines])
    rows = np.flatnonzero(reach[:, 1] > reach[:, 0])
    low_left = np.stack([begin, foot + reach[:, 0]], axis=1)[rows]
    turn = _turn(np.array([rotation_deg]))[0]
    boxes = _rectangles(low_left, length[rows], np.ptp(reach[rows], axis=1)) @ turn.T + origin
    return _Layout(begin, np.asarray(foot), np.asarray(length), turn, np.asarray(boxes))


@dataclass(frozen=True, eq=False)
class _Course:
    """Letters along a curve: their feet (n,2), left ends, the directions (n,) and matrices (n,2,2) they are turned by,
    their boxes (n,4,2)."""

    foot: Floats
    turn_deg: Floats
    turn: Floats
    boxes: Floats


def _course(
    found: Sequence[Glyph], path: ArrayLike, size_mm: float, align: str, level: str, at: float, off_mm: float
) -> _Course:
    _check_size(size_mm)
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
    if to[0] < from_[0]:
        points, begin = points[::-1], whole - end
    middle = begin + np.cumsum(advance) - 0.5 * advance
    down = {"base": 0.0, "middle": 0.5 * size_mm, "top": size_mm}[level] - off_mm
    low, high = (unit * end for end in _reach(found))
    course = _upright(points, middle, advance, down, low, high)
    boxes, slack = course.boxes, NEAREST * size_mm
    if any(_overlaps(boxes[:-lag], boxes[lag:], slack).any() for lag in range(1, min(BACK, len(boxes)))):
        middle = _apart(points, middle, advance, down, low, high, size_mm)
        course = _upright(points, middle, advance, down, low, high)
    return course


def _upright(points: Floats, middle: Floats, advance: Floats, down: float, low: float, high: float) -> _Course:
    """Letters of some widths whose middles are at these lengths along a curve."""
    place, way = _along(points, middle)
    turn_deg = np.degrees(np.arctan2(way[:, 1], way[:, 0]))
    turn = _turn(turn_deg)
    foot = place - np.einsum("nij,nj->ni", turn, np.stack([0.5 * advance, np.full(len(advance), down)], axis=1))
    corner = np.tile([0.0, low], (len(advance), 1))
    boxes = _rectangles(corner, advance, np.full(len(advance), high - low))
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


def _measured(line: str) -> list[Glyph]:
    """The room that the letters of a line take: that of their strokes, or a square where there are none; of formulas
    that of the signs they show."""
    return [room_of(cluster) for cluster in clusters(without_formulas(line))]


def _as_one(letters: Sequence[Glyph]) -> Glyph:
    """Letters side by side as one, so far as their room goes."""
    low, high = _reach(letters)
    return Glyph(sum(one.advance for one in letters), (((0.0, low), (0.0, high)),) if high > low else ())


def _no_strokes() -> Polylines:
    return Polylines(np.zeros((0, 2)), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_))


def _check_size(size_mm: float) -> None:
    if not 0.0 < size_mm < np.inf:
        raise InputError(f"a size of {size_mm:g} mm: expected a length that is finite and positive")


def _set(found: Sequence[Glyph], unit: float, place: Floats, turn: Floats) -> Polylines:
    """The strokes of letters, each at its place (n,2) and turned by a matrix (n,2,2)."""
    strokes = [one.strokes for one in found]
    letter = ragged.owner([len(some) for some in strokes])
    sizes = [len(stroke) for some in strokes for stroke in some]
    points = np.array([point for some in strokes for stroke in some for point in stroke]).reshape(-1, 2)
    owner: Ints = np.repeat(letter, sizes)
    placed = np.einsum("nij,nj->ni", turn[owner], unit * points) + place[owner]
    return Polylines(placed, ragged.offsets(sizes), np.zeros(len(sizes), dtype=np.bool_))


def _turn(degrees: Floats) -> Floats:
    """(n,2,2) rotations; exact for right angles."""
    quarter = np.mod(np.rint(degrees / 90.0), 4.0)
    right = quarter * 90.0 == np.mod(degrees, 360.0)
    cosine = np.where(right, np.array([1.0, 0.0, -1.0, 0.0])[quarter.astype(np.intp)], np.cos(np.radians(degrees)))
    sine = np.where(right, np.array([0.0, 1.0, 0.0, -1.0])[quarter.astype(np.intp)], np.sin(np.radians(degrees)))
    return np.stack([np.stack([cosine, -sine], axis=1), np.stack([sine, cosine], axis=1)], axis=1)


def _rectangles(corner: Floats, width: Floats, height: Floats) -> Floats:
    """(n,4,2) the corners of upright rectangles from their lower left ones (n,2), their widths and heights (n,)."""
    across, up = np.array([0.0, 1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0, 1.0])
    right, top = width[:, None] * across, height[:, None] * up
    return np.asarray(np.stack([corner[:, :1] + right, corner[:, 1:] + top], axis=2))


def _reach(line: Sequence[Glyph]) -> tuple[float, float]:
    """The lowest and the highest point of a line of letters; 0 and 0 for blanks."""
    heights = [y for one in line for stroke in one.strokes for _, y in stroke]
    return min(heights, default=0.0), max(heights, default=0.0)


def _along(points: Floats, length: Floats) -> tuple[Floats, Floats]:
    """(n,2) the points after so much (n,) of a polyline, and (n,2) the unit directions it has there; straight on
    beyond its ends."""
    steps = np.diff(points, axis=0)
    long = np.hypot(*steps.T)
    passed = np.concatenate([[0.0], np.cumsum(long)])
    segment = np.clip(np.searchsorted(passed, length, side="right") - 1, 0, len(long) - 1)
    way = steps[segment] / long[segment][:, None]
    return points[segment] + (length - passed[segment])[:, None] * way, way
