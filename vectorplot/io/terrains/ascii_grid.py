"""Esri's ASCII grid: a head of six lines, then heights row by row from north to south."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import TextFile, check_announced, text_file
from vectorplot.surfaces.graphs.height_grid import MOST_POINTS
from vectorplot.surfaces.terrains.terrain import Terrain
from vectorplot.tolerances.of_numbers import SINGLE_ULP

_HEAD_LINE = re.compile(rb"[ \t]*([A-Za-z_]+)[ \t]+([^\s]+)[ \t\r]*\n")

_COUNTS = ("ncols", "nrows")
_CELLS = ("cellsize", "dx", "dy")
_PLACES = ("xllcorner", "yllcorner", "xllcenter", "yllcenter")
_HOLE = "nodata_value"

LARGEST_HEIGHT = 1e30
"""Beyond this a number stands for a hole."""


def read_ascii_grid(path: Path) -> Terrain:
    """The terrain in an Esri ASCII grid; heights with the value of NODATA_value, and nan, are holes.

    Corners are those of the cells around the heights, centres places of heights.
    Errors: InputError with the line.
    """
    file = text_file(path)
    head, lines, file = _head(file)
    columns, rows = (_count(file, head, lines, word) for word in _COUNTS)
    # The shortest height is one digit and what parts it from the next.
    check_announced(file.name, {"heights": columns * rows}, 2 * columns * rows - 1, len(file.data))
    if columns * rows > MOST_POINTS:
        raise InputError(f"{columns} by {rows} heights, expected at most {MOST_POINTS} in all", file=file.name)
    if columns < 2 or rows < 2:
        raise InputError(f"{columns} columns and {rows} rows, expected at least two of each", file=file.name)
    cell = _cell(file, head, lines)
    corner = tuple(_corner(file, head, lines, axis, step) for axis, step in zip("xy", cell, strict=True))
    hole = _value(file, head, lines, _HOLE) if _HOLE in head else np.nan
    heights = _heights(file, columns, rows)
    # The least number of single precision is written in many ways, and no height.
    least = abs(hole) > LARGEST_HEIGHT
    heights = np.where(np.isclose(heights, hole, rtol=100.0 * SINGLE_ULP) if least else heights == hole, np.nan, heights)
    if np.isnan(heights).all():
        raise InputError("nothing but holes", file=file.name)
    # Rows come from north to south.
    return Terrain(heights[::-1].T, (corner[0], corner[1]), cell)


def is_ascii_grid(beginning: bytes) -> bool:
    """Whether a file begins as an ASCII grid."""
    return beginning.lstrip()[:5].lower() in (b"ncols", b"nrows")


def _head(file: TextFile) -> tuple[dict[str, str], dict[str, int], TextFile]:
    """The values of the head by their words in lower case, the lines they stand on, and the file behind it."""
    values: dict[str, str] = {}
    lines: dict[str, int] = {}
    at = 0
    while (found := _HEAD_LINE.match(file.data, at)) is not None and found[1].lower() != b"nan":
        word, line = found[1].decode("ascii").lower(), len(lines) + 1
        if word not in (*_COUNTS, *_CELLS, *_PLACES, _HOLE):
            raise InputError(f"unknown word '{word[:40]}' in the head of a grid", file=file.name, line=line)
        if word in values:
            raise InputError(f"a second '{word}'", file=file.name, line=line)
        values[word], lines[word] = found[2].decode("utf-8", "replace"), line
        at = found.end()
    return values, lines, TextFile(file.name, file.data, at)


def _count(file: TextFile, head: dict[str, str], lines: dict[str, int], word: str) -> int:
    if word not in head:
        raise InputError(f"expected '{word}' in the head of a grid", file=file.name)
    text = head[word]
    if not text.isascii() or not text.isdigit() or len(text) > 18:
        raise InputError(f"{word}: expected a count, got '{text[:40]}'", file=file.name, line=lines[word])
    return int(text)


def _value(file: TextFile, head: dict[str, str], lines: dict[str, int], word: str) -> float:
    try:
        value = float(head[word])
    except ValueError:
        value = np.inf
    if np.isinf(value) or (np.isnan(value) and word != _HOLE):
        raise InputError(f"{word}: expected a number, got '{head[word][:40]}'", file=file.name, line=lines[word])
    return value


def _cell(file: TextFile, head: dict[str, str], lines: dict[str, int]) -> tuple[float, float]:
    words = ("cellsize", "cellsize") if "cellsize" in head else ("dx", "dy")
    steps = []
    for word in words:
        if word not in head:
            raise InputError("expected 'cellsize' in the head of a grid", file=file.name)
        step = _value(file, head, lines, word)
        if step <= 0.0:
            raise InputError(f"{word}: {step:g} is not positive", file=file.name, line=lines[word])
        steps.append(step)
    return steps[0], steps[1]


def _corner(file: TextFile, head: dict[str, str], lines: dict[str, int], axis: str, step: float) -> float:
    """Where the first height stands."""
    corner, centre = f"{axis}llcorner", f"{axis}llcenter"
    if (corner in head) == (centre in head):
        raise InputError(f"expected '{corner}' or '{centre}' in the head of a grid", file=file.name)
    if centre in head:
        return _value(file, head, lines, centre)
    return _value(file, head, lines, corner) + step / 2.0


def _heights(file: TextFile, columns: int, rows: int) -> Floats:
    """(rows,columns) the heights in the order of the file."""
    found: list[Floats] = []
    count, total = 0, columns * rows
    for piece in file.lines(comment=b""):
        words = np.arange(len(piece.starts))
        if count + len(words) > total:
            piece.fail(total - count, f"more than the {columns} x {rows} heights that the head announces")
        values = np.full(len(words), np.nan)
        lead = piece.text[piece.starts] if len(words) else piece.text[:0]
        odd = np.flatnonzero((lead == ord("n")) | (lead == ord("N")))
        missing = [k for k in odd.tolist() if piece.word(k).lower() == "nan"]
        there = np.ones(len(words), dtype=np.bool_)
        there[missing] = False
        values[there] = piece.decimals(words[there])
        found.append(values)
        count += len(words)
    if count < total:
        file.fail_at_end(f"the file ends after {count} of {columns} x {rows} heights")
    return np.concatenate(found).reshape(rows, columns)
