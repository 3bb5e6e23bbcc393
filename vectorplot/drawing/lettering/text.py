"""Text as polylines on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.drawing.lettering.accents import CAPITAL
from vectorplot.drawing.lettering.glyph_setting import (
    check_size,
    measured,
    no_strokes,
    reach_of,
    rectangles,
    set_glyphs,
    turned,
)
from vectorplot.drawing.lettering.hershey import Glyph, clusters, glyph
from vectorplot.drawing.texts import Texts
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import Polylines

ALIGNED = {"left": 0.0, "centre": 0.5, "right": 1.0}
"""What part of a text lies before the point it is at."""

LEVELS = ("base", "middle", "top", "bottom")
"""What of a text is as high as the point it is at: the first line's foot, the middle, or the ends of all lines."""

LINES_APART = 1.7
"""From one line of text to the next, in heights of capitals."""

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


def broken_at_blanks(text: str, fits: Callable[[str], bool]) -> str:
    """A text in lines that fit, parted at blanks; a word that does not fit alone has a line of its own."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".lstrip()
        if lines[-1] and not fits(longer):
            lines.append(word)
        else:
            lines[-1] = longer
    return "\n".join(lines)


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
    check_size(size_mm)
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
    turn = turned(np.full(len(advance), rotation_deg))
    return Lettering(set_glyphs([*chain(*lines)], unit, origin + matmul(place, layout.turn.T), turn), layout.boxes)


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
    check_size(size_mm)
    written = text.split("\n")
    origin = np.asarray(at, dtype=np.float64)
    layout = _layout([measured(line) for line in written], origin, size_mm, align, level, rotation_deg)
    rows = np.array([k for k, line in enumerate(written) if line.strip()], dtype=np.intp)
    foot = np.stack([np.zeros(len(rows)), layout.foot[rows]], axis=1)
    count = len(rows)
    texts = Texts(
        tuple(written[k].strip() for k in rows),
        origin + matmul(foot, layout.turn.T),
        np.full(count, size_mm),
        np.full(count, rotation_deg),
        np.full(count, ALIGNED[align]),
        layout.length[rows],
        np.zeros(count, dtype=np.intp),
    )
    return Lettering(no_strokes(), layout.boxes, texts)


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
    reach = unit * np.array([reach_of(some) for some in lines])
    rows = np.flatnonzero(reach[:, 1] > reach[:, 0])
    low_left = np.stack([begin, foot + reach[:, 0]], axis=1)[rows]
    turn = turned(np.array([rotation_deg]))[0]
    boxes = matmul(rectangles(low_left, length[rows], np.ptp(reach[rows], axis=1)), turn.T) + origin
    return _Layout(begin, np.asarray(foot), np.asarray(length), turn, np.asarray(boxes))
