"""Letters of single strokes: Hershey's alphabets with accents, set in rows, as polylines on the page."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import chain
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.formulas import without_formulas
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import Polylines
from vectorplot.scene.page import in_latex

# What the alphabets lack: accents, signs that are put together, and letters that others resemble.
#
# Points are in the units of Hershey's letters: capitals are 21 high, small ones 14, and y runs upwards from the line
# that letters stand on.

SMALL, CAPITAL = 14.0, 21.0
"""The heights of small letters and of capitals."""

Point = tuple[float, float]

Strokes = tuple[tuple[Point, ...], ...]
"""Points of strokes, x from the middle of what they belong to."""

_DOT: Strokes = (((-0.8, 0.0), (0.0, 0.8), (0.8, 0.0), (0.0, -0.8), (-0.8, 0.0)),)


def moved(strokes: Strokes, x: float, y: float) -> Strokes:
    """The strokes, so far to the right and up."""
    return tuple(tuple((a + x, b + y) for a, b in stroke) for stroke in strokes)


def scaled(strokes: Strokes, size: float) -> Strokes:
    """The strokes, so many times as large."""
    return tuple(tuple((size * a, size * b) for a, b in stroke) for stroke in strokes)


ABOVE: dict[str, Strokes] = {
    "\u0300": (((-2.0, 5.5), (2.0, 2.0)),),
    "\u0301": (((2.0, 5.5), (-2.0, 2.0)),),
    "\u0302": (((-4.0, 2.0), (0.0, 5.5), (4.0, 2.0)),),
    "\u0303": (((-5.0, 2.5), (-3.5, 4.0), (-2.0, 4.2), (2.0, 2.8), (3.5, 3.0), (5.0, 4.5)),),
    "\u0304": (((-4.0, 3.5), (4.0, 3.5)),),
    "\u0305": (((-8.0, 3.5), (8.0, 3.5)),),
    "\u0306": (((-4.0, 5.5), (-3.0, 3.5), (-1.0, 2.5), (1.0, 2.5), (3.0, 3.5), (4.0, 5.5)),),
    "\u0307": moved(_DOT, 0.0, 3.5),
    "\u0308": (*moved(_DOT, -3.0, 3.5), *moved(_DOT, 3.0, 3.5)),
    "\u030a": (
        ((0.0, 1.5), (1.5, 2.0), (2.2, 3.7), (1.5, 5.4), (0.0, 6.0), (-1.5, 5.4), (-2.2, 3.7), (-1.5, 2.0), (0.0, 1.5)),
    ),
    "\u030b": (((-1.0, 5.5), (-4.0, 2.0)), ((4.0, 5.5), (1.0, 2.0))),
    "\u030c": (((-4.0, 5.5), (0.0, 2.0), (4.0, 5.5)),),
    "\u0313": (((0.8, 6.0), (1.2, 4.8), (-0.4, 2.5)),),
    "\u0314": (((-0.8, 6.0), (-1.2, 4.8), (0.4, 2.5)),),
    "\u0342": (((-4.0, 2.5), (-2.5, 4.8), (0.0, 5.5), (2.5, 4.8), (4.0, 2.5)),),
    "\u20d7": (((-7.0, 4.5), (7.0, 4.5)), ((3.5, 7.0), (7.0, 4.5), (3.5, 2.0))),
}
"""Accents over letters, y from the top of the letter."""

BELOW: dict[str, Strokes] = {
    "\u0323": moved(_DOT, 0.0, -3.5),
    "\u0326": (((0.5, -2.0), (-1.0, -6.0)),),
    "\u0327": (((0.0, 0.0), (0.0, -2.0), (1.8, -2.6), (2.4, -4.2), (1.2, -5.6), (-2.0, -6.0)),),
    "\u0345": (((0.0, -2.0), (0.0, -5.0), (1.2, -6.0)),),
    "\u0328": (((1.5, 0.0), (0.0, -2.0), (-0.3, -4.0), (0.8, -5.5), (3.0, -5.5)),),
}
"""Accents under letters, y from the line."""

THROUGH: dict[str, tuple[str, Strokes]] = {
    "ø": ("o", (((-7.0, -2.0), (7.0, 16.0)),)),
    "Ø": ("O", (((-9.0, -2.0), (9.0, 23.0)),)),
    "⌀": ("O", (((-9.0, -2.0), (9.0, 23.0)),)),
    "ł": ("l", (((-4.0, 8.0), (4.0, 13.0)),)),
    "Ł": ("L", (((-9.0, 8.0), (1.0, 13.0)),)),
    "đ": ("d", (((0.0, 17.0), (9.0, 17.0)),)),
    "Đ": ("D", (((-11.0, 10.5), (-1.0, 10.5)),)),
    "ħ": ("h", (((-9.0, 17.0), (0.0, 17.0)),)),
    "Ħ": ("H", (((-10.0, 16.0), (10.0, 16.0)),)),
    "€": ("C", (((-11.0, 12.5), (4.0, 12.5)), ((-11.0, 8.5), (3.0, 8.5)))),
    "£": ("L", (((-9.0, 9.0), (2.0, 9.0)), ((-5.0, 17.0), (-3.5, 20.0), (0.0, 21.0), (3.0, 20.0), (4.0, 18.0)))),
    "ı": ("i", ()),
    "ȷ": ("j", ()),
}
"""Letters that are others with more strokes; those without a dot are what is below it."""

SIDE_BY_SIDE: dict[str, tuple[str, float]] = {
    "æ": ("ae", -5.5),
    "œ": ("oe", -6.0),
    "Æ": ("AE", -8.5),
    "Œ": ("OE", -7.0),
    "“": ("‘‘", -4.0),
    "”": ("’’", -4.0),
    "„": (",,", -4.0),
    "…": ("...", 0.0),
    "ĳ": ("ij", 0.0),
    "«": ("‹‹", -4.0),
    "»": ("››", -4.0),
    "″": ("′′", -3.0),
    "№": ("Nº", 0.0),
}
"""Letters that are several others, and how far these are moved apart; negative: together."""

SHAPES: dict[str, tuple[float, Strokes]] = {
    "ß": (
        19.0,
        (
            (
                *((-6.5, 0.0), (-6.5, 16.0), (-5.5, 19.0), (-3.0, 21.0), (1.0, 21.0), (3.5, 19.0), (4.0, 16.5)),
                *((3.0, 14.0), (-1.0, 12.0), (2.5, 11.0), (5.0, 9.0), (6.0, 6.0), (5.0, 2.0), (2.0, 0.0), (-1.0, 0.0)),
            ),
        ),
    ),
    "‹": (12.0, (((3.0, 13.0), (-2.0, 8.0), (3.0, 3.0)),)),
    "›": (12.0, (((-3.0, 13.0), (2.0, 8.0), (-3.0, 3.0)),)),
    "′": (8.0, (((1.5, 21.0), (-1.5, 14.0)),)),
    "•": (12.0, scaled(moved(_DOT, 0.0, 3.0), 3.0)),
    "¡": (10.0, (((0.0, -7.0), (0.0, 7.0)), *moved(_DOT, 0.0, 13.0))),
    "-": (14.0, (((-4.0, 8.5), (4.0, 8.5)),)),
    "—": (34.0, (((-15.0, 8.5), (15.0, 8.5)),)),
    "_": (18.0, (((-9.0, -4.0), (9.0, -4.0)),)),
    "⌴": (26.0, (((-10.0, 14.0), (-10.0, 1.0), (10.0, 1.0), (10.0, 14.0)),)),
    "⌵": (26.0, (((-10.0, 15.0), (0.0, 1.0), (10.0, 15.0)),)),
    "↧": (20.0, (((-7.0, 19.0), (7.0, 19.0)), ((0.0, 19.0), (0.0, 1.0)), ((-4.5, 8.0), (0.0, 1.0), (4.5, 8.0)))),
    "□": (24.0, (((-9.0, 0.0), (9.0, 0.0), (9.0, 18.0), (-9.0, 18.0), (-9.0, 0.0)),)),
}
"""Signs of our own: how much room they take, and their strokes from the middle of it."""

SAME: dict[str, str] = {
    "\u00a0": " ",
    "\u2009": " ",
    "\u202f": " ",
    "−": "–",
    "\u2010": "-",
    "\u2011": "-",
    "µ": "μ",
    "∆": "Δ",
    "Ω": "Ω",
    "ϑ": "θ",
    "ϕ": "φ",
    "ϵ": "ε",
    "⋅": "·",
    "∙": "·",
    "∗": "*",
    "∕": "/",
    "∶": ":",
    "∼": "~",
    "˚": "°",
    "ʼ": "’",
    "ℓ": "l",
    "⟂": "⊥",
    "⟨": "‹",
    "⟩": "›",
    "≦": "≤",
    "≧": "≥",
    "ё": "е\u0308",
}
"""Signs that look like others."""


# Hershey's letters by the characters they stand for.

BASE_LINE = 9.0
"""The line that letters stand on, downwards from the middle of Hershey's letters."""

_ASCII = "".join(map(chr, range(33, 127)))
_GREEK_CAPITALS, _GREEK = "ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩ", "αβγδεζηθικλμνξοπρστυφχψω"
_LATIN_CAPITALS, _LATIN = "ABCDEFGHIJKLMNOPQRSTUVWX", "abcdefghijklmnopqrstuvwx"

ALPHABETS = (
    ("rowmans", _ASCII + "–’‘°", _ASCII + "-'`\x7f"),
    ("futural", "^", "^"),
    ("greeks", _GREEK_CAPITALS + _GREEK, _LATIN_CAPITALS + _LATIN),
    ("cyrilc_1", "АБВГДЕЖЗИЙКЛМНОПРСТУФХЦЧШЩ", "ABCDEFGHIJKLMNOPQRSTUVWXYZ"),
    ("cyrilc_1", "абвгдежзийклмнопрстуфхцчшщ", "abcdefghijklmnopqrstuvwxyz"),
    ("cyrillic", "ЫыЭЮюЪъЬьЯя", "$&CUu]|_~^}"),
    ("mathlow", "±∓×·≤≥≠≡∝∞√⊂∪⊃∩∈→↑←↓∂∇∫÷∥⊥∠∴∃", "!\"#$&'?@^_bdefghijklmnpxyz|~v"),
    ("symbolic", "ς§†‡", "vijk"),
)
"""Fonts, the characters taken from each, and the letters that stand for these there."""

_PLACES = {
    character: (font, letter)
    for font, characters, letters in ALPHABETS
    for character, letter in zip(characters, letters, strict=True)
}
"""The font of each character that is taken from one, and its letter there."""

SMALLER = 0.6
"""The size of letters that stand high or low, of others."""

DOTS = 15.0
"""Dots of i and j are higher than this."""

WIDE = 1.3
"""The width of letters that fill the square of a type, beside the height of capitals."""

RAISED, LOWERED = 9.5, -5.0
"""Where the line of letters that stand high or low is."""

LOST = ("circle", "font", "vertical", "initial", "medial", "final", "isolated")
"""Forms of characters that are others without them: a figure in a circle is no figure."""


@dataclass(frozen=True)
class Glyph:
    """A letter: how much room it takes, and its strokes, x from its left end, y from the line it stands on.

    In Hershey's units, of which a capital is 21 high.
    """

    advance: float
    strokes: Strokes

    @property
    def top(self) -> float:
        """The highest point of its strokes."""
        return max((y for stroke in self.strokes for _, y in stroke), default=0.0)


def clusters(line: str) -> list[str]:
    """The letters of a line, each with the accents that follow it."""
    found: list[str] = []
    for character in unicodedata.normalize("NFC", line):
        if unicodedata.combining(character) and found:
            found[-1] += character
        else:
            found.append(character)
    return found


def glyph(cluster: str) -> Glyph:
    """The letter for a character and the accents that follow it.

    Errors: InputError for one that neither the fonts nor accents.py have.
    """
    found = _letter(cluster)
    if found is None:
        codes = " ".join(f"U+{ord(character):04X}" for character in cluster)
        raise InputError(f"there are no strokes for the character {cluster!r} ({codes})")
    return found


def room_of(cluster: str) -> Glyph:
    """A letter by the room it takes: that of its strokes, or a square as high as capitals where there are none."""
    found = _letter(cluster)
    wide = CAPITAL * (WIDE if unicodedata.east_asian_width(cluster[0]) in "WF" else 1.0)
    return found or Glyph(wide, (((0.0, 0.0), (wide, CAPITAL)),))


@cache
def _font(name: str) -> dict[str, Any]:
    """The letters of a font: to unpack one takes as long as to draw many small pictures."""
    from HersheyFonts import HersheyFonts

    font = HersheyFonts()
    font.load_default_font(name)
    return dict(font.all_glyphs)


def _of_a_font(character: str) -> Glyph:
    """A character that is taken from a font as it is."""
    font, letter = _PLACES[character]
    one = _font(font)[letter]
    strokes = tuple(tuple((x - one.left_offset, BASE_LINE - y) for x, y in stroke) for stroke in one.strokes)
    return Glyph(float(one.char_width), strokes)


@cache
def _letter(cluster: str) -> Glyph | None:
    if cluster == " ":
        return Glyph(12.0, ())
    if cluster in SHAPES:
        advance, strokes = SHAPES[cluster]
        return Glyph(advance, moved(strokes, 0.5 * advance, 0.0))
    if cluster == "э":
        return _smaller(_of_a_font("Э"), 2.0 / 3.0, 0.0)
    if cluster in _PLACES:
        return _of_a_font(cluster)
    if cluster in SAME:
        return _letter(SAME[cluster])
    if cluster in SIDE_BY_SIDE:
        return _side_by_side(*SIDE_BY_SIDE[cluster])
    if cluster in THROUGH:
        base, strokes = THROUGH[cluster]
        found = _of_a_font(base)
        # A letter without its dot is what reaches no higher than small letters do.
        body = found.strokes if strokes else tuple(s for s in found.strokes if min(y for _, y in s) < DOTS)
        return Glyph(found.advance, (*body, *moved(strokes, 0.5 * found.advance, 0.0)))
    tag, parts = _decomposed(cluster)
    if tag in ("super", "sub"):
        inner = _side_by_side(parts, 0.0)
        return inner and _smaller(inner, SMALLER, RAISED if tag == "super" else LOWERED)
    if tag == "fraction":
        return _fraction(*parts.split("/"))
    if tag and tag not in LOST:
        return _side_by_side(parts, 0.0)
    return _accented(parts[0], parts[1:]) if len(parts) > 1 else None


def _accented(base: str, marks: str) -> Glyph | None:
    """A letter with accents, the first nearest to it."""
    above = any(mark in ABOVE for mark in marks)
    found = _letter({"i": "ı", "j": "ȷ"}.get(base, base) if above else base)
    for mark in marks if found else "":
        if found is None or mark not in (*ABOVE, *BELOW):
            return None
        high = mark in ABOVE
        strokes = moved(ABOVE[mark] if high else BELOW[mark], 0.5 * found.advance, found.top if high else 0.0)
        found = Glyph(found.advance, found.strokes + strokes)
    return found


def _fraction(above: str, below: str) -> Glyph | None:
    """Small figures to both sides of a slash."""
    high, slash, low = (_side_by_side(parts, 0.0) for parts in (above, "/", below))
    if high is None or slash is None or low is None:
        return None
    high, low = _smaller(high, SMALLER, RAISED), _smaller(low, SMALLER, LOWERED)
    beside = moved(slash.strokes, high.advance, 0.0)
    strokes = (*high.strokes, *beside, *moved(low.strokes, high.advance + slash.advance, 0.0))
    return Glyph(high.advance + slash.advance + low.advance, strokes)


def _side_by_side(parts: str, apart: float) -> Glyph | None:
    """Letters as one, so far apart."""
    place = 0.0
    strokes: list[tuple[Point, ...]] = []
    for part in parts:
        found = _letter(part)
        if found is None:
            return None
        strokes += moved(found.strokes, place, 0.0)
        place += found.advance + apart
    return Glyph(place - apart, tuple(strokes))


def _decomposed(cluster: str) -> tuple[str, str]:
    """What Unicode says a character is a form of, super and sub among them, and the characters it consists of."""
    said = unicodedata.decomposition(cluster).split() if len(cluster) == 1 else []
    if said and said[0].startswith("<"):
        parts = "".join(chr(int(code, 16)) for code in said[1:])
        return said[0].strip("<>"), parts.replace("\u2044", "/")
    return "", unicodedata.normalize("NFD", cluster)


def _smaller(one: Glyph, size: float, y: float) -> Glyph:
    return Glyph(size * one.advance, moved(scaled(one.strokes, size), 0.0, y))


# Glyphs set in rows: how wide they are, where their strokes and their boxes come to stand.


def measured(line: str) -> list[Glyph]:
    """The room that the letters of a line take: that of their strokes, or a square where there are none; of formulas
    that of the signs they show."""
    return [room_of(cluster) for cluster in clusters(without_formulas(line))]


def as_one(letters: Sequence[Glyph]) -> Glyph:
    """Letters side by side as one, so far as their room goes."""
    low, high = reach_of(letters)
    return Glyph(sum(one.advance for one in letters), (((0.0, low), (0.0, high)),) if high > low else ())


def no_strokes() -> Polylines:
    """Letters without strokes."""
    return Polylines(np.zeros((0, 2)), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_))


def check_size(size_mm: float) -> None:
    """An InputError for a size that is not finite and positive."""
    if not 0.0 < size_mm < np.inf:
        raise InputError(f"a size of {size_mm:g} mm: expected a length that is finite and positive")


def set_glyphs(found: Sequence[Glyph], unit: float, place: Floats, turn: Floats) -> Polylines:
    """The strokes of letters, each at its place (n,2) and turned by a matrix (n,2,2)."""
    strokes = [one.strokes for one in found]
    letter = ragged.owner([len(some) for some in strokes])
    sizes = [len(stroke) for some in strokes for stroke in some]
    points = np.array([point for some in strokes for stroke in some for point in stroke]).reshape(-1, 2)
    owner: Ints = np.repeat(letter, sizes)
    placed = np.einsum("nij,nj->ni", turn[owner], unit * points) + place[owner]
    return Polylines(placed, ragged.offsets(sizes), np.zeros(len(sizes), dtype=np.bool_))


def turned(degrees: Floats) -> Floats:
    """(n,2,2) rotations; exact for right angles."""
    quarter = np.mod(np.rint(degrees / 90.0), 4.0)
    right = quarter * 90.0 == np.mod(degrees, 360.0)
    cosine = np.where(right, np.array([1.0, 0.0, -1.0, 0.0])[quarter.astype(np.intp)], np.cos(np.radians(degrees)))
    sine = np.where(right, np.array([0.0, 1.0, 0.0, -1.0])[quarter.astype(np.intp)], np.sin(np.radians(degrees)))
    return np.stack([np.stack([cosine, -sine], axis=1), np.stack([sine, cosine], axis=1)], axis=1)


def rectangles(corner: Floats, width: Floats, height: Floats) -> Floats:
    """(n,4,2) the corners of upright rectangles from their lower left ones (n,2), their widths and heights (n,)."""
    across, up = np.array([0.0, 1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0, 1.0])
    right, top = width[:, None] * across, height[:, None] * up
    return np.asarray(np.stack([corner[:, :1] + right, corner[:, 1:] + top], axis=2))


def reach_of(line: Sequence[Glyph]) -> tuple[float, float]:
    """The lowest and the highest point of a line of letters; 0 and 0 for blanks."""
    heights = [y for one in line for stroke in one.strokes for _, y in stroke]
    return min(heights, default=0.0), max(heights, default=0.0)


# Text as polylines on the page.

ALIGNED = {"left": 0.0, "centre": 0.5, "right": 1.0}
"""What part of a text lies before the point it is at."""

LINES_APART = 1.7
"""From one line of text to the next, in heights of capitals."""

DESCENT = 1.0 / 3.0
"""How far letters reach below their line, in heights of capitals."""


@dataclass(frozen=True, eq=False)
class Lettering:
    """A text on the page: strokes of a pen, or lines in a font.

    strokes: points (p, 2) in mm, y upwards; boxes: (b, 4, 2) the corners of the rectangles that the text fills,
    counter-clockwise from the lower left one as one reads: one for each line, as high as its letters; texts: its lines
    where it is typeset, or of a text along a curve its letters.
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
    Edge cases: an empty text, and one of blanks, has no strokes.

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
        As in lettered, but of any characters.
    at, size_mm, align, level, rotation_deg : (float, float), float, str, str and float
        See lettered.

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
    Edge cases: an empty line, and one of blanks, is none.

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
        (in_latex(size_mm),) * count,
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
