"""Pens and styles: which pen draws what, styles by name and in TOML files, and those a scene asks for."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from numbers import Real
from pathlib import Path
from typing import Any, Literal, NoReturn

from vectorplot.drawing.drawing import Pen
from vectorplot.errors import InputError
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.page import LENGTH, length_mm
from vectorplot.scene.pens import FINEST_MM, FRAME, HIDDEN, LONGEST_MM, WIDEST_MM, PenOverrides, target_of, unknown_item
from vectorplot.words import COLOURS, LineKind, check_colour, check_word, is_colour, nearest, unknown

# The pens of layers, and the inks of colours.

BLACK = "#000000"

PENS = {
    "visible": Pen(0.25, BLACK),
    "contour": Pen(0.5, BLACK),
    "intersection": Pen(0.35, BLACK),
    "hidden": Pen(0.13, BLACK),
    "pattern": Pen(0.18, BLACK),
    "isophote": Pen(0.18, BLACK),
    "section": Pen(0.18, BLACK),
    "curve": Pen(0.5, BLACK),
    "integral": Pen(0.18, BLACK),
    "hatch": Pen(0.18, BLACK),
    "index": Pen(0.35, BLACK),
    "label": Pen(0.25, BLACK),
    "centre": Pen(0.18, BLACK),
    "suggestive": Pen(0.35, BLACK),
    "ridge": Pen(0.25, BLACK),
    "valley": Pen(0.25, BLACK),
    "apparent": Pen(0.35, BLACK),
    "cut": Pen(0.7, BLACK),
    "ghost": Pen(0.13, BLACK),
    "trace": Pen(0.13, BLACK),
    "outline": Pen(0.5, BLACK),
    "tangent": Pen(0.13, BLACK),
    "terminator": Pen(0.25, BLACK),
    "shadow": Pen(0.25, BLACK),
    "reflected": Pen(0.18, BLACK),
    "refracted": Pen(0.18, BLACK),
}
"""The pens of layers by kind, as a draughtsman would choose them."""

KIND_LAYER = {
    LineKind.CONTOUR: "contour",
    LineKind.BOUNDARY: "contour",
    LineKind.CREASE: "visible",
    LineKind.EDGES: "visible",
    LineKind.INTERSECTION: "intersection",
    LineKind.PATTERN: "pattern",
    LineKind.PARAMETER: "visible",
    LineKind.ISOPHOTE: "isophote",
    LineKind.SECTION: "section",
    LineKind.CURVE: "curve",
    LineKind.INTEGRAL: "integral",
    LineKind.HATCH: "hatch",
    LineKind.INDEX: "index",
    LineKind.LABEL: "label",
    LineKind.CENTRE: "centre",
    LineKind.SUGGESTIVE: "suggestive",
    LineKind.RIDGE: "ridge",
    LineKind.VALLEY: "valley",
    LineKind.APPARENT: "apparent",
    LineKind.CUT: "cut",
    LineKind.GHOST: "ghost",
    LineKind.TRACE: "trace",
    LineKind.OUTLINE: "outline",
    LineKind.TANGENT: "tangent",
    LineKind.TERMINATOR: "terminator",
    LineKind.SHADOW: "shadow",
    LineKind.REFLECTED: "reflected",
    LineKind.REFRACTED: "refracted",
}

INKS = {
    "gray": "#4d4d4d",
    "green": "#1a7a1a",
    "yellow": "#b8860b",
    "blue": "#1f4fa3",
    "pink": "#c2185b",
    "cyan": "#00838f",
    "magenta": "#a0139f",
    "orange": "#d35400",
    "white": "#bdbdbd",
    "black": BLACK,
    "red": "#c00000",
}
"""Inks for the names of palettes: dark enough for a line on white paper."""


FRAME_PEN = Pen(0.5)
"""What draws frames and titles."""


def ink(colour: str) -> str:
    """The ink, #rrggbb, for the name of a palette; light and dark ones share that of their parent.

    A colour given as #rrggbb is its own ink.
    """
    if colour.startswith("#"):
        return colour
    return INKS.get(colour.removeprefix("light").removeprefix("dark"), INKS["gray"])


# Which pen draws what: rules by kind of line, by item and by both, as people write them.

_NEXT = re.compile(r",(?=[^,=]*=)")
"""The commas between rules, where a rule has commas of its own."""

DEFAULT_HATCHING_MM = (Hatching.width_mm, Stippling.width_mm)
"""The widths of the pens that hatch, or make dots, where nothing else is said."""


@dataclass(frozen=True)
class PenRule:
    """What some lines are drawn with, as far as it is said.

    kind: a word of PEN_KINDS, or None for all; item: the name of an item, or None for all; colour: #rrggbb; dash_mm:
    dash and gap, of length 0 for a line without.
    """

    kind: str | None = None
    item: str | None = None
    width_mm: float | None = None
    colour: str | None = None
    dash_mm: tuple[float, float] | None = None

    def applied(self, pen: Pen) -> Pen:
        """The pen with what the rule says."""
        width = pen.width_mm if self.width_mm is None else self.width_mm
        colour = pen.colour if self.colour is None else self.colour
        return Pen(width, colour, pen.dash_mm if self.dash_mm is None else self.dash_mm)


def scaled_pen(pen: Pen, factor: float) -> Pen:
    """The pen for a page that is so many times larger."""
    dash = None if pen.dash_mm is None else (factor * pen.dash_mm[0], factor * pen.dash_mm[1])
    return Pen(factor * pen.width_mm, pen.colour, dash)


RulesByTarget = Mapping[tuple[str | None, str | None], Sequence[PenRule]]
"""What is said of each kind and item."""

Pens = str | Pen | Mapping[str, "str | float | Pen"] | Iterable[str]
"""What pens may be said in: one text or several such as ``contour=0.5:black,house=red``, a mapping, or a single pen."""


def pen_rules(pens: Pens | None, dashes: str | Mapping[str, str] | Iterable[str] | None = None) -> tuple[PenRule, ...]:
    """The rules that pens and dashes say, in their order.

    Errors: InputError for what is no pen, or no dash.
    """
    rules = [_pen_rule(target, value) for target, value in _pen_pairs(pens)]
    return (*rules, *(_dash_rule(target, value) for target, value in _dash_pairs(dashes)))


def _pen_pairs(pens: Pens | None) -> list[tuple[str, str | float | Pen]]:
    if pens is None:
        return []
    if isinstance(pens, Pen):
        return [("", pens)]
    if isinstance(pens, Mapping):
        return list(pens.items())
    texts = [pens] if isinstance(pens, str) else list(pens)
    return [_halves(one) for text in texts for one in text.split(",")]


def _dash_pairs(dashes: str | Mapping[str, str] | Iterable[str] | None) -> list[tuple[str, str]]:
    if dashes is None:
        return []
    if isinstance(dashes, Mapping):
        return list(dashes.items())
    texts = [dashes] if isinstance(dashes, str) else list(dashes)
    return [_halves(one) for text in texts for one in _NEXT.split(text)]


def _halves(text: str) -> tuple[str, str]:
    """What a rule is for, and what it says; the former is nothing where there is no sign of equality."""
    target, equal, value = text.rpartition("=")
    if equal and not target.strip():
        raise InputError(f"pen {text!r}: expected a kind of line or an item before '='")
    return target.strip(), value.strip()


def _pen_rule(target: str, value: str | float | Pen) -> PenRule:
    kind, item = target_of(target)
    if isinstance(value, Pen):
        return PenRule(kind, item, value.width_mm, value.colour, value.dash_mm)
    if not isinstance(value, str):
        if not isinstance(value, Real) or isinstance(value, bool):
            raise InputError(f"pen {target}={value!r}: expected WIDTH, COLOUR or WIDTH:COLOUR, a number or a Pen")
        value = f"{float(value):.17g}"
    width, _, colour = value.partition(":")
    if not colour and not LENGTH.fullmatch(width):
        width, colour = "", width
    if not width.strip() and not colour.strip():
        raise InputError(f"pen {target}={value}: expected WIDTH, COLOUR or WIDTH:COLOUR")
    if not target and colour and width.strip() and not LENGTH.fullmatch(width):
        raise InputError(f"pen {value}: expected WIDTH, COLOUR, WIDTH:COLOUR, or KIND=WIDTH such as contour=0.5")
    found = _length(width, f"pen {target}={value}", WIDEST_MM) if width.strip() else None
    return PenRule(kind, item, found, pen_colour(colour, f"pen {target}={value}: ") if colour.strip() else None)


def _dash_rule(target: str, value: str) -> PenRule:
    kind, item = target_of(target)
    if not isinstance(value, str):
        raise InputError(f"dash {target}={value!r}: expected a text such as '3,1'")
    if value.strip().lower() == "none":
        return PenRule(kind, item, dash_mm=(0.0, 0.0))
    parts = value.split(",")
    if len(parts) != 2:
        raise InputError(f"dash {target}={value}: expected DASH,GAP such as 3,1 or 8pt,3pt; or none")
    dash, gap = (_length(part, f"dash {target}={value}", LONGEST_MM) for part in parts)
    return PenRule(kind, item, dash_mm=(dash, gap))


def _length(text: str, owner: str, most: float) -> float:
    """A length on paper in mm, from the finest pen to the most that there is."""
    try:
        size = length_mm(text)
    except InputError:
        raise InputError(f"{owner}: {text.strip()!r} is no length in mm or pt") from None
    if size < FINEST_MM:
        raise InputError(f"{owner}: expected {FINEST_MM:g} mm or more")
    if size > most:
        raise InputError(f"{owner}: expected {most:g} mm or less")
    return size


def pen_colour(word: str, owner: str = "") -> str:
    """The ink, #rrggbb, of a colour by its name; white is white. Errors: InputError for another word."""
    word = word.strip().lower()
    if word == "white":
        return "#ffffff"
    if not is_colour(word):
        near = nearest(word, COLOURS)
        hint = f" (did you mean {near!r}?)" if near else ""
        raise InputError(f"{owner}unknown colour {word!r}: expected a palette, black, white, red or #rrggbb{hint}")
    return ink(word)


def check_targets(rules: Sequence[PenRule], items: Sequence[str]) -> None:
    """An InputError for a rule for an item that is not there, with the word that may be meant."""
    known = set(items)
    for rule in rules:
        if rule.item is not None and rule.item not in known:
            raise unknown_item(rule.item, items)


def frame_pen(rules: Sequence[PenRule], pen: Pen) -> Pen:
    """The pen of a frame and a title with what the rules for all lines say, and then those for these."""
    for kind in (None, FRAME):
        for rule in rules:
            if rule.kind == kind and rule.item is None:
                pen = rule.applied(pen)
    return pen


def rules_by_target(rules: Sequence[PenRule]) -> RulesByTarget:
    """The rules for each kind and item, in their order."""
    found: dict[tuple[str | None, str | None], list[PenRule]] = {}
    for rule in rules:
        found.setdefault((rule.kind, rule.item), []).append(rule)
    return found


def pen_of(rules: RulesByTarget, pen: Pen, kind: int, hidden: bool, item: str) -> Pen:
    """The pen of lines of one kind and item: their layer's, with the rules for all lines, then for the kind, for the
    item, and for both, later rules first. Hidden lines are of the kind hidden only, and rules for an item without a
    kind do not apply to them. Of hatchings these rules change the colour only, and those for all lines the width too
    where it is the default, since the spacing follows the width.
    """
    word = HIDDEN if hidden else LineKind(kind).word
    hatching = kind == LineKind.HATCH
    usual = pen.width_mm in DEFAULT_HATCHING_MM
    for target in [(None, None), (word, None), *(() if hidden else ((None, item),)), (word, item)]:
        for rule in rules.get(target, ()):
            if hatching and rule.kind is None:
                width = rule.width_mm if usual and rule.item is None else None
                rule = replace(rule, width_mm=width, dash_mm=None)
            pen = rule.applied(pen)
    return pen


# Styles: what lines are shown, and the pens, dashes and paper that go together.

LOOKS = ("plain", "wireframe", "depth-cue")
"""Hidden lines removed; or all lines shown, in one shade or by their depth."""

HIDDEN_WAYS = ("none", "dashed", "solid")
"""How hidden lines look."""


@dataclass(frozen=True)
class Style:
    """How a drawing looks, as far as it is not said for the drawing itself.

    Parameters
    ----------
    look : {"plain", "wireframe", "depth-cue"}
        Hidden lines removed; or all lines shown, in one shade or by their depth, in colours of their own.
    hidden : {"none", "dashed", "solid"}
        How hidden lines look.
    pens : mapping of str to str
        See `vp.draw`: kinds of lines, items, or item.kind, and WIDTH, COLOUR or WIDTH:COLOUR.
    dashes : mapping of str to str
        See `vp.draw`: the same, and DASH,GAP.
    background : str, optional
        The colour of the paper; none is drawn where None.
    layers : str
        What shares a layer, see `vp.draw`.

    Raises
    ------
    InputError
        For unknown words, and what is no pen.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> bold = vp.Style(pens={"contour": "0.8:red", "hidden": "0.2"}, hidden="dashed")
    >>> drawing = vp.draw(box((1, 2, 3)), style=bold)
    >>> next(layer.pen for layer in drawing.layers if layer.name == "contour").colour
    '#c00000'
    """

    look: Literal["plain", "wireframe", "depth-cue"] = "plain"
    hidden: Literal["none", "dashed", "solid"] = "none"
    pens: Mapping[str, str] = field(default_factory=dict)
    dashes: Mapping[str, str] = field(default_factory=dict)
    background: str | None = None
    layers: str = "kind"

    def __post_init__(self) -> None:
        check_word("look", self.look, LOOKS)
        check_word("hidden", self.hidden, HIDDEN_WAYS)
        if self.background is not None:
            check_colour(self.background, "background: ")
        _ = self.rules

    @property
    def rules(self) -> tuple[PenRule, ...]:
        """Its pens and dashes as rules."""
        return pen_rules(self.pens, self.dashes)


STYLES = {
    "plain": Style(),
    "wireframe": Style("wireframe"),
    "depth-cue": Style("depth-cue"),
    "plotter": Style(pens={"": "0.3"}, layers="kind,colour"),
    "book": Style(
        hidden="dashed",
        pens={"contour": "0.6", "boundary": "0.4", "crease": "0.3", "hidden": "0.13:gray", "parameter": "0.13"},
        dashes={"hidden": "1.6,0.9"},
    ),
    "draft": Style(hidden="solid", pens={"": "0.13:#4a4a4a", "contour": "0.25:black", "hidden": "0.09:#a8a8a8"}),
    "blueprint": Style(
        hidden="dashed",
        pens={"": "0.2:#dce8f7", "contour": "0.45:white", "boundary": "0.45:white", "hidden": "0.15:#86a8d8"},
        dashes={"hidden": "2,1.2"},
        background="#1f4788",
    ),
}
"""The styles that have a name."""


# Styles by their names, and in TOML files.

TOML = ".toml"

MOST_BYTES = 1 << 20
"""A larger file is no style."""

_TABLES = ("pens", "dashes")
_WORDS = tuple(field.name for field in fields(Style))


def read_style(path: str | os.PathLike[str]) -> Style:
    """The style in a TOML file: the fields of Style by their names, pens and dashes as tables.

    Errors: InputError with file, line where there is one, and cause.
    """
    said, text = read_toml(path, "style")
    return _style(said, text, os.fspath(path))


def read_toml(path: str | os.PathLike[str], what: str) -> tuple[Mapping[str, Any], str]:
    """What a TOML file says, and its text; what: it is to be. Errors: InputError with file, cause and line if known."""
    file = os.fspath(path)
    try:
        if Path(path).stat().st_size > MOST_BYTES:
            raise InputError(f"too large for a {what}", file=file)
        text = Path(path).read_text(encoding="utf-8-sig")
        return tomllib.loads(text), text
    except tomllib.TOMLDecodeError as error:
        cause, place = str(error), re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", str(error))
        line = int(place[1]) if place and place[1] else len(text.splitlines())
        raise InputError(cause[: place.start()] if place else cause, file=file, line=line) from None
    except UnicodeDecodeError:
        raise InputError(f"not UTF-8: this is no {what}", file=file) from None
    except OSError as error:
        raise InputError((error.strerror or "cannot be read").lower(), file=file) from None


def _style(said: Mapping[str, Any], text: str, file: str) -> Style:
    for word, value in said.items():
        if word not in _WORDS:
            near = nearest(word.lower(), _WORDS)
            known = f"did you mean {near!r}?" if near else f"known: {', '.join(_WORDS)}"
            _fail(f"unknown word {word!r} ({known})", word, text, file)
        if word in _TABLES:
            _check_table(word, value, text, file)
        elif not isinstance(value, str):
            _fail(f"{word}: expected a text in quotes", word, text, file)
        else:
            _made({word: value}, word, text, file)
    tables = {word: {key: str(value) for key, value in said[word].items()} for word in _TABLES if word in said}
    return Style(**{**said, **tables})


def _check_table(word: str, table: Any, text: str, file: str) -> None:
    if not isinstance(table, dict):
        _fail(f"{word}: expected a table", word, text, file)
    for key, value in table.items():
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            # A point in a key without quotes makes a table of it.
            _fail(f"{word}, {key}: expected a text or a number; quote 'item.kind'", key, text, file, word)
        _made({word: {key: str(value)}}, key, text, file, word)


def _made(said: Mapping[str, Any], word: str, text: str, file: str, table: str = "") -> None:
    """An InputError with its line for words of a style that make none."""
    try:
        Style(**said)
    except InputError as error:
        _fail(error.cause, word, text, file, table)


def _fail(cause: str, word: str, text: str, file: str, table: str = "") -> NoReturn:
    """Raise InputError for the line on which a word of a table (of none: of the file) begins."""
    begins = re.compile(rf"\s*[\"']?{re.escape(word)}[\"']?\s*[=.]|\s*\[\s*{re.escape(word)}\s*[\].]")
    section, line = "", None
    for number, one in enumerate(text.splitlines(), 1):
        if header := re.match(r"\s*\[\s*([^\]\s]+)\s*\]", one):
            section = header[1]
        if begins.match(one) and (section == table or (not table and section == word)):
            line = number
            break
    raise InputError(cause, file=file, line=line)


def style_of(style: Style | str) -> Style:
    """The style that is given, or has a name, or stands in a file that ends in .toml.

    Errors: InputError for another word, and with file and line for a file that is none.
    """
    if isinstance(style, Style):
        return style
    if not isinstance(style, str):
        raise InputError(f"style {style!r}: expected a Style, its name, or a file that ends in {TOML}")
    if style.lower().endswith(TOML):
        return read_style(style)
    check_style(style)
    return STYLES[style]


def check_style(word: str) -> None:
    """An InputError for what is no style's name."""
    if word not in STYLES:
        raise unknown("style", word, STYLES, f"or a file that ends in {TOML}")


# The style and the pens that a scene asks for itself.


def style_of_scene(inks: PenOverrides | None, asked: Style | str | None) -> tuple[Style, tuple[PenRule, ...]]:
    """The style that is asked for, else that of the scene, else plain; and the rules of the scene's own pens.

    Pens of the scene have nothing to do in a wireframe, which has colours of its own.

    Errors: InputError for unknown styles and what is no pen, and for a scene with pens and a wireframe of its own.
    """
    own = PenOverrides() if inks is None else inks
    style = style_of(asked if asked is not None else own.style or "plain")
    rules = pen_rules(own.pens, own.dashes)
    if style.look == "plain":
        return style, rules
    if rules and asked is None:
        raise InputError(f"pens do not go with the style {style.look}, which shows all lines, in colours of its own")
    return style, ()
