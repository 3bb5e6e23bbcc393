"""Letters of single strokes, as a pen writes them."""

from __future__ import annotations

from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul

CAPITAL = 6.0
"""Units from the foot of a letter to the top of a capital; small letters reach two thirds of that."""

FOOT = 2.0
"""The second digit of a point on the line that letters stand on."""

GAP = 2.0
"""Units between a letter and the next one."""

SPACE = 4.0
"""Units from the letter before a space to the one after it, the gap included."""

GLYPHS = {
    "A": "02 28 42|14 34",
    "B": "02 08 38 47 46 35 05|35 44 43 32 02",
    "C": "47 38 18 07 03 12 32 43",
    "D": "02 08 28 46 44 22 02",
    "E": "48 08 02 42|05 35",
    "F": "48 08 02|05 35",
    "G": "47 38 18 07 03 12 32 43 45 25",
    "H": "08 02|48 42|05 45",
    "I": "08 02",
    "J": "38 33 22 12 03",
    "K": "08 02|48 05 42",
    "L": "08 02 42",
    "M": "02 08 24 48 42",
    "N": "02 08 42 48",
    "O": "18 07 03 12 32 43 47 38 18",
    "P": "02 08 38 47 46 35 05",
    "Q": "18 07 03 12 32 43 47 38 18|24 42",
    "R": "02 08 38 47 46 35 05|25 42",
    "S": "47 38 18 07 06 15 35 44 43 32 12 03",
    "T": "08 48|28 22",
    "U": "08 03 12 32 43 48",
    "V": "08 22 48",
    "W": "08 12 26 32 48",
    "X": "08 42|48 02",
    "Y": "08 25 48|25 22",
    "Z": "08 48 02 42",
    "a": "36 32|35 26 16 05 03 12 22 33",
    "b": "08 02|05 16 26 35 33 22 12 03",
    "c": "35 26 16 05 03 12 22 33",
    "d": "38 32|35 26 16 05 03 12 22 33",
    "e": "04 34 35 26 16 05 03 12 22 33",
    "f": "28 18 07 02|06 26",
    "g": "36 31 20 10 01|35 26 16 05 03 12 22 33",
    "h": "08 02|05 16 26 35 32",
    "i": "06 02|08 07",
    "j": "16 11 00|18 17",
    "k": "08 02|36 04 32",
    "l": "08 02",
    "m": "06 02|05 16 25 22|25 36 45 42",
    "n": "06 02|05 16 26 35 32",
    "o": "16 05 03 12 22 33 35 26 16",
    "p": "06 00|05 16 26 35 33 22 12 03",
    "q": "36 30|35 26 16 05 03 12 22 33",
    "r": "06 02|05 16 26",
    "s": "35 26 16 05 14 24 33 22 12 03",
    "t": "18 13 22|06 26",
    "u": "06 03 12 22 33|36 32",
    "v": "06 22 46",
    "w": "06 12 25 32 46",
    "x": "06 32|36 02",
    "y": "06 22|46 10",
    "z": "06 36 02 32",
    "é": "04 34 35 26 16 05 03 12 22 33|17 28",
    "0": "18 07 03 12 22 33 37 28 18",
    "1": "07 18 12",
    "2": "07 18 28 37 36 02 32",
    "3": "07 18 28 37 36 25 34 33 22 12 03|15 25",
    "4": "28 04 34|28 22",
    "5": "38 08 05 25 34 33 22 12 03",
    "6": "37 28 18 07 03 12 22 33 34 25 15 04",
    "7": "08 38 12",
    "8": "18 07 06 15 25 36 37 28 18|15 04 03 12 22 33 34 25",
    "9": "03 12 22 33 37 28 18 07 06 15 25 36",
    ".": "02 03",
    ",": "13 01",
    ":": "02 03|05 06",
    "-": "05 35",
    "+": "05 45|27 23",
    "=": "06 36|04 34",
    "/": "01 48",
    "%": "02 48|07 08 18 17 07|32 33 43 42 32",
    "(": "18 06 04 12",
    ")": "08 16 14 02",
    "<": "37 05 33",
    ">": "07 35 03",
    "'": "08 06",
    "_": "01 41",
}
"""Strokes of every letter, a bar between them: points as two digits, to the right and up."""

UNKNOWN = "02 08 48 42 02"
"""A box, for a letter that is not in the table."""


def letters(
    text: str,
    at: tuple[float, float],
    height: float,
    *,
    along: Literal["left", "middle", "right"] = "left",
    upwards: bool = False,
) -> list[Floats]:
    """The strokes (k,2) of a text, capitals so high.

    at: the foot of its first letter, of its middle or of its end, as along says; upwards: it runs from below to above.
    """
    unit = height / CAPITAL
    strokes: list[Floats] = []
    place = 0.0
    for letter in text:
        if letter == " ":
            place += SPACE - GAP
            continue
        found = [_points(stroke) for stroke in GLYPHS.get(letter, UNKNOWN).split("|")]
        strokes += [stroke + np.array([place, 0.0]) for stroke in found]
        place += max(float(stroke[:, 0].max()) for stroke in found) + GAP
    width = max(place - GAP, 0.0)
    shift = {"left": 0.0, "middle": 0.5 * width, "right": width}[along]
    turn = np.array([(0.0, 1.0), (-1.0, 0.0)]) if upwards else np.eye(2)
    return [np.asarray(matmul(unit * (stroke - np.array([shift, 0.0])), turn) + at) for stroke in strokes]


def text_width(text: str, height: float) -> float:
    """How long a text is, capitals so high."""
    strokes = letters(text, (0.0, 0.0), height)
    return max((float(stroke[:, 0].max()) for stroke in strokes), default=0.0)


def _points(stroke: str) -> Floats:
    return np.array([(int(point[0]), int(point[1]) - FOOT) for point in stroke.split()])
