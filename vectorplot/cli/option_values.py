"""Values of options: text to numbers, points, pages and words. What does not fit is bad usage."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Self, TypeVar

import click

from vectorplot.errors import InputError
from vectorplot.pictures.options import OPTIONS
from vectorplot.words import LINE_WORDS, SUBDIVISIONS, check_colour, format_hint, line_words, nearest

if TYPE_CHECKING:
    from vectorplot.scene.light import Exposure, Light
    from vectorplot.scene.pens import DepthCue


Value = TypeVar("Value")


def number(text: str) -> float:
    """The finite number that a text spells."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise click.BadParameter(f"{text!r} is not a finite number")
    return value


def at_least(low: float, *, at_most: float = math.inf) -> Callable[[str], float]:
    """How to read a number that lies between low and at_most or is one of them."""

    def read(text: str) -> float:
        value = number(text)
        if value < low:
            raise click.BadParameter(f"{text} is less than {low:g}")
        if value > at_most:
            raise click.BadParameter(f"{text} is greater than {at_most:g}")
        return value

    return read


def between(low: float, high: float) -> Callable[[str], float]:
    """How to read a number that lies between low and high and is neither of them."""

    def read(text: str) -> float:
        value = number(text)
        if not low < value < high:
            upper = "" if high == math.inf else f" and less than {high:g}"
            raise click.BadParameter(f"{text} is not greater than {low:g}{upper}")
        return value

    return read


@cache
def of_option(name: str) -> click.ParamType[Any] | Callable[[str], float]:
    """How to read what an argument of the verbs may be, by its name: a word, a whole number or a number of a range."""
    option = OPTIONS[name]
    if option.words:
        return click.Choice(option.words)
    return (
        click.IntRange(int(option.least), int(option.most))
        if option.whole
        else at_least(option.least, at_most=option.most)
    )


def point(text: str) -> tuple[float, float, float]:
    """Three finite numbers with commas between them, such as -3,4,5."""
    parts = text.split(",")
    if len(parts) != 3:
        raise click.BadParameter(f"{text!r} is not three numbers X,Y,Z")
    x, y, z = (number(part.strip()) for part in parts)
    return (x, y, z)


AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""The axes of the world by name."""


def place(text: str) -> tuple[float, ...]:
    """X,Y on a terrain, or a point X,Y,Z."""
    found = numbers(text)
    if len(found) not in (2, 3):
        raise click.BadParameter(f"{text!r} is not X,Y or X,Y,Z")
    return found


def direction(text: str) -> tuple[float, float, float]:
    """A vector, or the name of an axis, perhaps with a sign before it."""
    axis = AXES.get(text.strip().lower().lstrip("+-"))
    if axis is None:
        return point(text)
    x, y, z = (-one if text.strip().startswith("-") and one else one for one in axis)
    return (x, y, z)


def upwards(text: str) -> tuple[float, float, float]:
    """A direction that has a length."""
    found = direction(text)
    if not any(found):
        raise click.BadParameter(f"{text!r} has no length: expected a direction such as y or 0,1,0")
    return found


def numbers(text: str) -> tuple[float, ...]:
    """Positive finite numbers with commas between them, such as 16,32,64."""
    positive = between(0.0, math.inf)
    return tuple(positive(part.strip()) for part in text.split(","))


def ascending(text: str) -> tuple[float, ...]:
    """Two or more numbers with commas between them, each larger than the one before."""
    found = tuple(number(part.strip()) for part in text.split(","))
    if len(found) < 2 or any(first >= second for first, second in pairwise(found)):
        raise click.BadParameter(f"{text!r}: expected ascending numbers with commas between them, such as 0,10,50")
    return found


def colour_word(text: str) -> str:
    """A colour by its name or as #rrggbb."""
    _said(text, check_colour)
    return text


def letter_size(text: str) -> float:
    """The height of capitals in mm of a size such as 2.5 or 8pt."""
    from vectorplot.scene.labels import capital_height

    try:
        return capital_height(text)
    except InputError as error:
        raise click.BadParameter(error.cause) from None


def length(text: str) -> float:
    """The mm of a length on paper, such as 8cm."""
    from vectorplot.scene.page import length_mm

    try:
        return length_mm(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from None


def tiles(text: str) -> tuple[int, int]:
    """Columns and rows of CxR."""
    from vectorplot.drawing.tiles import MOST_TILES

    columns, _, rows = text.lower().partition("x")
    found = [int(part) if part.isdecimal() else 0 for part in (columns, rows)]
    if not all(1 <= number <= MOST_TILES for number in found):
        raise click.BadParameter(f"{text!r} is not COLUMNSxROWS, such as 2x2, each from 1 to {MOST_TILES}")
    return found[0], found[1]


def page_size(text: str) -> tuple[float, float] | str:
    """Width and height in mm of a named page or of WIDTHxHEIGHT, perhaps landscape or portrait; the word FIT; or SCALE
    and a ratio."""
    from vectorplot.scene.page import FIT, SCALE, scale_ratio, sheet_size

    if text.strip().lower() == FIT:
        return FIT
    sheet, _, way = text.strip().partition(" ")
    word = way.strip().lower()
    try:
        if sheet.lower() == SCALE:
            scale_ratio(way)
            return f"{SCALE} {way.strip()}"
        sides = sheet_size(sheet if word in ("landscape", "portrait") else text)
        width, height = sorted(sides, reverse=word == "landscape") if word else sides
        return width, height
    except InputError as error:
        raise click.BadParameter(str(error)) from None


def pixels(text: str) -> tuple[int, int]:
    """Columns and rows of a picture, WIDTHxHEIGHT."""
    from vectorplot.shading.screen import raster_size

    sides = text.lower().split("x")
    if len(sides) != 2 or not all(side.strip().isdigit() for side in sides):
        raise click.BadParameter(f"{text!r} is not WIDTHxHEIGHT in pixels")
    try:
        return raster_size(int(sides[0]), int(sides[1]))
    except InputError as error:
        raise click.BadParameter(str(error)) from None


KINDS = f"some of {', '.join(LINE_WORDS)}; or none"
"""What help texts say of the values of ``--lines``."""


def kinds(text: str) -> tuple[str, ...]:
    """Kinds of lines with commas between them, each once; nothing for ``none``."""
    try:
        return line_words(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from None


def light(text: str) -> Light:
    """A lamp at X,Y,Z; after that, in any order, its intensity, its colour, and the words parallel and fading."""
    from vectorplot.scene.light import Light

    place, words = text.split(",")[:3], [word.strip() for word in text.split(",")[3:]]
    told: dict[str, Any] = {}
    for word in words:
        field, value = _of_light(word)
        if field in told:
            raise click.BadParameter(f"{text!r} says twice what its {field} is")
        told[field] = value
    if len(place) != 3:
        raise click.BadParameter(f"{text!r} is not a lamp X,Y,Z, perhaps with {LIGHT_WORDS}")
    x, y, z = (number(part.strip()) for part in place)
    try:
        return Light((x, y, z), **told)
    except InputError as error:
        raise click.BadParameter(error.cause) from None


LIGHT_WORDS = "an intensity, a colour, parallel, fading"
"""What may be said of a lamp."""


def _of_light(word: str) -> tuple[str, Any]:
    """The field of a light that a word is about, and its value."""
    if word in ("parallel", "fading"):
        return word, True
    try:
        return "intensity", float(word)
    except ValueError:
        return "colour", word


def exposure(text: str) -> Exposure:
    """The word fitted, or a positive factor."""
    from vectorplot.scene.light import check_exposure

    if text == "fitted":
        return "fitted"
    factor = number(text)
    try:
        check_exposure(factor)
    except InputError as error:
        raise click.BadParameter(error.cause) from None
    return factor


def depth_cue(text: str) -> DepthCue | str:
    """The word none, or width, shade or both, and a number of steps."""
    from vectorplot.scene.pens import DepthCue

    try:
        return text if text == "none" else DepthCue.read(text)
    except InputError as error:
        raise click.BadParameter(error.cause) from None


def said_or_none(context: click.Context, parameter: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...] | None:
    """The values of an option that may be repeated; None where it is not given."""
    return values or None


def pen(text: str) -> str:
    """Pens with commas between them, such as contour=0.5:black,house=red."""
    return _said(text, lambda pens: _rules(pens, None))


def dash(text: str) -> str:
    """Dash and gap of some lines, such as hidden=3,1."""
    return _said(text, lambda dashes: _rules(None, dashes))


def _rules(pens: str | None, dashes: str | None) -> None:
    from vectorplot.drawing.pens import pen_rules

    pen_rules(pens, dashes)


def layers(text: str) -> str:
    """What shares a layer, with commas."""
    from vectorplot.drawing.layers import layer_words

    return _said(text, layer_words)


def style(text: str) -> str:
    """The name of a style, or a file that ends in .toml."""
    from vectorplot.drawing.pens import TOML, check_style

    return text if text.lower().endswith(TOML) else _said(text, check_style)


def _said(text: str, check: Callable[[str], object]) -> str:
    """The text, where the check has nothing against it."""
    try:
        check(text)
    except InputError as error:
        raise click.BadParameter(str(error)) from None
    return text


def exclusive(given: Iterable[tuple[str, object]]) -> None:
    """Bad usage where more than one of some options is given (None and False: not given)."""
    used = [name for name, value in given if value is not None and value is not False]
    if len(used) > 1:
        raise click.UsageError(f"{used[0]} and {used[1]} exclude each other")


def chosen(value: Value | None, fallback: Value) -> Value:
    """The value, or the fallback where none is given."""
    return fallback if value is None else value


def format_of(path: str, given: str | None, known: Sequence[str]) -> str:
    """The format to write: the one given, or the suffix of the path."""
    if given is not None:
        return given
    if path == "-":
        raise click.UsageError("-o - needs --format")
    suffix = path.rpartition("/")[2].rpartition(".")
    word = suffix[2].lower() if suffix[1] and suffix[0] else ""
    if word not in known:
        choice = "" if len(known) == 1 else "one of "
        names = ", ".join("." + name for name in known)
        raise click.UsageError(f"{path}: the name must end in {choice}{names}{format_hint(word)}")
    return word


def subdivision_scheme(text: str) -> tuple[str, float | None]:
    """SCHEME[,DEG]: the scheme, and the angle of creases."""
    word, comma, angle = text.partition(",")
    if word not in SUBDIVISIONS:
        near = nearest(word.lower(), SUBDIVISIONS)
        meant = f"; did you mean {near}?" if near else ""
        raise click.BadParameter(f"{word!r} is none of {', '.join(SUBDIVISIONS)}{meant}")
    found = number(angle) if comma else None
    if found is not None and not 0.0 <= found <= 180.0:
        raise click.BadParameter(f"a crease angle of {found:g} degrees, expected 0 to 180")
    return word, found


@dataclass(frozen=True)
class OptionGroup:
    """What the user said with some options of a command: a field for each of them, by its name."""

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Self:
        """What a command that has these options was told."""
        return cls(**{field.name: options[field.name] for field in fields(cls)})
