"""What a scene file says of how it is drawn: its style, pens and dashes; and how its parts are moved apart."""

from __future__ import annotations

from dataclasses import replace
from json import dumps
from typing import NoReturn

from vectorplot.errors import InputError
from vectorplot.io.named_files import NamedFiles
from vectorplot.io.scenes.scene_words import SCENE_WORDS, Words
from vectorplot.scene.cuts.explosion import AXES, Explosion
from vectorplot.scene.pages.inks import FINEST_MM, LONGEST_MM, PEN_KINDS, WIDEST_MM, Inks
from vectorplot.scene.pages.paper import LENGTH, length_mm
from vectorplot.words import COLOURS, STYLE_WORDS, is_colour, nearest

INK_WORDS = ("style", "pen", "dash")
"""The statements."""

STYLE_FILE = ".toml"
"""What the names of files with styles end in."""


def read_ink(words: Words, at: int, now: Inks | None, files: NamedFiles | None) -> tuple[Inks, int]:
    """The inks with what the words from style, pen or dash on say, and the word behind them."""
    inks = Inks() if now is None else now
    word = words.words[at]
    if word == "style":
        if inks.style is not None:
            words.fail(at, "a second 'style'")
        style, at = _style(words, at + 1, files)
        return replace(inks, style=style), at
    start, (target, at) = at, _target(words, at + 1, word)
    own = inks.pens if word == "pen" else inks.dashes
    if target in own:
        words.fail(start, f"a second '{word}' for {target or 'all lines'}")
    said, at = (_pen if word == "pen" else _dash)(words, at)
    told = {**own, target: said}
    return replace(inks, pens=told) if word == "pen" else replace(inks, dashes=told), at


def pen_target(words: Words, at: int) -> str:
    """What the pen or the dash at a word is for; nothing for all lines, and for a style."""
    return "" if words.words[at] == "style" else _target(words, at + 1, words.words[at])[0]


def read_explosion(words: Words, at: int) -> tuple[Explosion, int]:
    """How the words from ``explode`` on move parts apart, and the word behind them."""
    start, axis = at, words.words[at + 1]
    way: str | tuple[float, float, float] = axis
    if words.is_number(at + 1):
        (x, y, z), at = words.numbers(at + 1, 3, "explode: ", "the axis")
        way = (x, y, z)
    elif axis in AXES:
        at += 2
    else:
        words.fail(at + 1, f"explode: expected x, y, z or a direction, got {words.shown(at + 1)}")
    try:
        if words.is_number(at):
            return Explosion(way, words.number(at, "explode: ", "the factor")), at + 1
        return Explosion(way), at
    except InputError as error:
        words.fail(start, error.cause)


def ink_texts(inks: Inks) -> list[str]:
    """The statements that say it, as read_ink reads them."""
    found = [] if inks.style is None else [f"style {_quoted(inks.style, inks.style in STYLE_WORDS)}"]
    for target, said in inks.pens.items():
        width, colour = _halves(said)
        found.append(_statement("pen", target, width, colour and _quoted(colour, colour in COLOURS)))
    for target, said in inks.dashes.items():
        found.append(_statement("dash", target, *(part.replace(" ", "") for part in said.split(","))))
    return found


def _statement(word: str, target: str, *values: str) -> str:
    owner = target and _quoted(target, target in PEN_KINDS)
    return " ".join(part for part in (word, owner, *values) if part)


def _style(words: Words, at: int, files: NamedFiles | None) -> tuple[str, int]:
    """The name of a style, or the path of its file."""
    if words.words[at].startswith('"') and words.string(at).lower().endswith(STYLE_FILE):
        if files is None:
            words.fail(at, "style: a text without a file names no files")
        return str(files.named(words, at, "style: ", (STYLE_FILE,))), at + 1
    word = words.string(at)
    if word not in STYLE_WORDS:
        near = nearest(word.lower(), STYLE_WORDS) if word else None
        hint = f" (did you mean {near!r}?)" if near else ""
        known = f"one of {', '.join(STYLE_WORDS)}, or a file that ends in {STYLE_FILE}, in quotes"
        words.fail(at, f"style: expected {known}, got {words.shown(at)}{hint}")
    return word, at + 1


def _target(words: Words, at: int, owner: str) -> tuple[str, int]:
    """What a pen or a dash is for, nothing for all lines; and the word behind it."""
    said = _is_length(words, at) or (owner == "dash" and words.words[at] == "none")
    if said or (owner == "pen" and _is_colour(words, at) and not _is_length(words, at + 1)):
        return "", at
    if words.words[at] in ("", ",") or words.words[at] in SCENE_WORDS:
        _fail_value(words, at, owner)
    return words.string(at), at + 1


def _pen(words: Words, at: int) -> tuple[str, int]:
    """WIDTH, COLOUR or WIDTH:COLOUR of a pen, and the word behind it."""
    said, start = [], at
    if _is_length(words, at):
        _check_length(words, at, "pen")
        said.append(words.words[at])
        at += 1
    if _is_colour(words, at):
        said.append(words.string(at))
        at += 1
    elif at == start or words.words[at].startswith('"#') or words.misspelled(start, at, COLOURS):
        _fail_value(words, at, "pen")
    return ":".join(said), at


def _dash(words: Words, at: int) -> tuple[str, int]:
    """DASH,GAP or none, and the word behind it."""
    if words.words[at] == "none":
        return "none", at + 1
    _check_length(words, at, "dash")
    gap = at + 2 if words.words[at + 1] == "," else at + 1
    _check_length(words, gap, "dash")
    return f"{words.words[at]},{words.words[gap]}", gap + 1


def _is_length(words: Words, at: int) -> bool:
    return words.is_number(at) and LENGTH.fullmatch(words.words[at]) is not None


def _is_colour(words: Words, at: int) -> bool:
    word = words.words[at]
    return is_colour(words.string(at)) if word.startswith('"#') else word in COLOURS


def _check_length(words: Words, at: int, owner: str) -> None:
    if not _is_length(words, at):
        _fail_value(words, at, owner)
    try:
        length = length_mm(words.words[at])
    except InputError as error:
        words.fail(at, f"{owner}: {error.cause}")
    most = WIDEST_MM if owner == "pen" else LONGEST_MM
    if not FINEST_MM <= length <= most:
        words.fail(at, f"{owner}: expected {FINEST_MM:g} to {most:g} mm, got {words.shown(at)}")


def _fail_value(words: Words, at: int, owner: str) -> NoReturn:
    what = "a width in mm or a colour" if owner == "pen" else "DASH GAP in mm such as 3 1, or none"
    word = words.words[at].lower().strip('"')
    near = nearest(word, COLOURS) if owner == "pen" and word and not words.is_number(at) else None
    hint = f" (did you mean {near!r}?)" if near else ""
    words.fail(at, f"{owner}: expected {what}, got {words.shown(at)}{hint}")


def _halves(said: str) -> tuple[str, str]:
    """Width and colour of a pen, nothing for what is not said."""
    width, colon, colour = said.partition(":")
    if not colon and not LENGTH.fullmatch(width):
        width, colour = "", width
    return width.replace(" ", ""), colour.strip().lower()


def _quoted(text: str, bare: bool) -> str:
    return text if bare else dumps(text)
