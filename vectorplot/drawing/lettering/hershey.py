"""Hershey's letters by the characters they stand for."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from functools import cache
from typing import Any

from vectorplot.drawing.lettering.accents import (
    ABOVE,
    BELOW,
    CAPITAL,
    SAME,
    SHAPES,
    SIDE_BY_SIDE,
    THROUGH,
    Point,
    Strokes,
    moved,
    scaled,
)
from vectorplot.errors import InputError

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
