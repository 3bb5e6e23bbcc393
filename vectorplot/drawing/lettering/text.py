"""Text as polylines on the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.lettering.accents import CAPITAL
from vectorplot.drawing.lettering.hershey import Glyph, clusters, glyph
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
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
    """A text as strokes of a pen on the page.

    Parameters
    ----------
    strokes : Polylines
        Points (p, 2) in mm, y upwards; letter by letter as one reads.
    boxes : (b, 4, 2) array of float
        The corners of the rectangles that the text fills, counter-clockwise from the lower left one as one reads: one
        for each line, as high as its letters; or of a text along a curve one for each letter.

    Examples
    --------
    >>> from vectorplot import drawing
    >>> text = drawing.lettered("I", size_mm=7)
    >>> text.strokes.points.max(axis=0).round(6).tolist()
    [1.333333, 7.0]
    """

    strokes: Polylines
    boxes: Floats

    def __len__(self) -> int:
        return len(self.strokes)

    @property
    def bounds(self) -> Floats:
        """(2, 2) smallest and largest coordinates of its boxes; zeros for an empty text."""
        corners = self.boxes.reshape(-1, 2)
        return np.stack([corners.min(axis=0), corners.max(axis=0)]) if len(corners) else np.zeros((2, 2))


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
    length = np.array([sum(one.advance for one in line) for line in lines]) * unit
    begin = -ALIGNED[align] * length
    foot = -LINES_APART * size_mm * np.arange(len(lines))
    high, low = size_mm, foot[-1] - DESCENT * size_mm
    foot -= {"base": 0.0, "top": high, "bottom": low, "middle": 0.5 * (foot[-1] + high)}[level]
    counts = [len(line) for line in lines]
    advance = np.array([one.advance for one in chain(*lines)], dtype=np.float64) * unit
    line = ragged.owner(counts)
    passed = np.concatenate([[0.0], np.cumsum(advance)])
    along = passed[:-1] - passed[ragged.starts(counts)][line]
    place = np.stack([begin[line] + along, foot[line]], axis=1)
    turn = _turn(np.full(len(advance), rotation_deg))
    origin = np.asarray(at, dtype=np.float64)
    reach = unit * np.array([_reach(some) for some in lines])
    rows = np.flatnonzero(reach[:, 1] > reach[:, 0])
    low_left = np.stack([begin, foot + reach[:, 0]], axis=1)[rows]
    boxes = _rectangles(low_left, length[rows], np.ptp(reach[rows], axis=1))
    whole = _turn(np.array([rotation_deg]))[0]
    return Lettering(
        _set([*chain(*lines)], unit, origin + place @ whole.T, turn),
        np.asarray(boxes @ whole.T + origin),
    )


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
    _check_size(size_mm)
    points = np.asarray(path, dtype=np.float64)
    steps = np.hypot(*np.diff(points, axis=0).T) if points.ndim == 2 and points.shape[1] == 2 else np.zeros(0)
    kept = np.append(True, steps > 0.0)[: len(points)]
    points, whole = points[kept], float(steps.sum())
    if not 0.0 < whole < np.inf:
        raise InputError("a text along a curve: the curve has no length")
    found, unit = [glyph(cluster) for cluster in clusters(text)], size_mm / CAPITAL
    advance = np.array([one.advance for one in found], dtype=np.float64) * unit
    length = float(advance.sum())
    begin, end = (at * whole + part * length for part in (-ALIGNED[align], 1.0 - ALIGNED[align]))
    (from_, to), _ = _along(points, np.array([begin, end]))
    if to[0] < from_[0]:
        points, begin = points[::-1], whole - end
    middle = begin + np.cumsum(advance) - 0.5 * advance
    place, way = _along(points, middle)
    turn = _turn(np.degrees(np.arctan2(way[:, 1], way[:, 0])))
    down = {"base": 0.0, "middle": 0.5 * size_mm, "top": size_mm}[level] - off_mm
    foot = place - np.einsum("nij,nj->ni", turn, np.stack([0.5 * advance, np.full(len(advance), down)], axis=1))
    low, high = (unit * end for end in _reach(found))
    corner = np.tile([0.0, low], (len(found), 1))
    boxes = _rectangles(corner, advance, np.full(len(advance), high - low))
    return Lettering(_set(found, unit, foot, turn), np.einsum("nij,nkj->nki", turn, boxes) + foot[:, None])


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
