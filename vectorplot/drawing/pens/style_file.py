"""Styles by their names, and in TOML files."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, NoReturn

from vectorplot.drawing.pens.styles import STYLES, Style
from vectorplot.errors import InputError
from vectorplot.words import nearest, unknown

TOML = ".toml"

MOST_BYTES = 1 << 20
"""A larger file is no style."""

_TABLES = ("pens", "dashes")
_WORDS = tuple(field.name for field in fields(Style))


def read_style(path: str | os.PathLike[str]) -> Style:
    """The style in a TOML file: the fields of Style by their names, pens and dashes as tables.

    Errors: InputError with file, line where there is one, and cause.
    """
    file = os.fspath(path)
    try:
        if Path(path).stat().st_size > MOST_BYTES:
            raise InputError("too large for a style", file=file)
        text = Path(path).read_text(encoding="utf-8-sig")
        said = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        cause, place = str(error), re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", str(error))
        line = int(place[1]) if place and place[1] else len(text.splitlines())
        raise InputError(cause[: place.start()] if place else cause, file=file, line=line) from None
    except UnicodeDecodeError:
        raise InputError("not UTF-8: this is no style", file=file) from None
    except OSError as error:
        raise InputError((error.strerror or "cannot be read").lower(), file=file) from None
    return _style(said, text, file)


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
