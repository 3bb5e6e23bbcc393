"""Charts as drawings: panels of curves over logarithmic axes, with letters of single strokes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import log
from vectorplot.tolerances import PLAIN_NUMBER
from vectorplot.words import LineKind

# Logarithmic axes: their ends, and where they are marked and how.

LARGEST_PLAIN = 1e4
"""Up to this size numbers at an axis are written out, from PLAIN_NUMBER on; others as powers of ten."""

FEW_DECADES = 2.2
"""An axis of so many powers of ten or less is numbered between them too."""

MOST_NUMBERS = 7
"""So many powers of ten are numbered; of more every second one, every third one, and so on."""


@dataclass(frozen=True)
class Tick:
    """A mark at a value; text: the number there, an exponent of ten after ^, or nothing."""

    value: float
    text: str


@dataclass(frozen=True)
class LogAxis:
    """A logarithmic axis from low to high, both positive, with what it says."""

    label: str
    low: float
    high: float

    @classmethod
    def around(cls, label: str, values: Iterable[float]) -> LogAxis:
        """The axis with all values that are positive and finite inside, and a little room.

        Edge cases: no such value gives the axis from 0.1 to 10, a single one a power of ten about it.
        """
        usable = [value for value in values if 0.0 < value < np.inf]
        if not usable:
            return cls(label, 0.1, 10.0)
        low, high = math.log10(min(usable)), math.log10(max(usable))
        room = max(0.06 * (high - low), 0.5 - 0.5 * (high - low))
        return cls(label, float(10.0 ** (low - room)), float(10.0 ** (high + room)))

    def place(self, values: Floats | float) -> Floats:
        """Where values are along the axis, 0 to 1; NaN for what is not positive."""
        given = np.asarray(values, dtype=np.float64)
        known = np.where(given > 0.0, given, np.nan)
        return np.asarray(log(known / self.low) / log(self.high / self.low))

    def ticks(self) -> tuple[Tick, ...]:
        """The marks, from low to high."""
        first, last = int(np.floor(math.log10(self.low))), int(np.ceil(math.log10(self.high)))
        decades = math.log10(self.high / self.low)
        numbered = {1, 2, 5} if decades <= FEW_DECADES else {1}
        every = int(np.ceil(decades / MOST_NUMBERS))
        found = []
        for exponent in range(first, last + 1):
            for digit in range(1, 10):
                value = float(f"{digit}e{exponent}")
                if self.low <= value <= self.high:
                    text = number(value) if digit in numbered and exponent % every == 0 else ""
                    found.append(Tick(value, text))
        return tuple(found)


def number(value: float) -> str:
    """A number as an axis says it."""
    if PLAIN_NUMBER <= value <= LARGEST_PLAIN:
        return f"{value:.10f}".rstrip("0").rstrip(".")
    digit, _, exponent = f"{value:.0e}".partition("e")
    return f"10^{int(exponent)}" if digit == "1" else f"{digit} 10^{int(exponent)}"


# Letters of single strokes, as a pen writes them.

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


# Charts as drawings: panels side by side, each with curves over logarithmic axes, and what the curves are.

COLOURS = ("#1f4e8c", "#b8321f", "#2b7a3d", "#8a5a00", "#6a3d9a", "#00717a")
"""PenOverrides of curves, one after the other; they differ in print and for eyes that see few colours."""

PANEL_MM = (84.0, 66.0)
"""Width and height of the area between the axes of a panel."""

LEFT_MM, BELOW_MM, ABOVE_MM, RIGHT_MM = 26.0, 18.0, 22.0, 6.0
"""Room for the numbers of a panel, for those below it, for title and names, and at the right border of the page."""

TITLE_MM, LABEL_MM, NUMBER_MM, EXPONENT_MM = 4.0, 2.8, 2.4, 1.8
"""How high capitals are."""

ROW_MM = 6.0
"""From one row of a legend to the next one."""

TICK_MM, SHORT_TICK_MM, MARKER_MM = 1.6, 0.8, 0.9
DASH_MM, GAP_MM = 2.0, 1.4

SAMPLE_MM = 8.0
"""How long the pieces of curves in the legend are, and the gaps between its names."""

AXES, GRID, LETTERS, CURVE = Pen(0.25), Pen(0.1, "#c8c8c8"), Pen(0.25), 0.45


@dataclass(frozen=True)
class Curve:
    """A curve of a chart: what it is called, its points, and whether these are marked; colour: which ink; dashed: it is
    a dashed line. Points that are not positive interrupt it; where y is zero they are marked at the foot."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    colour: int
    marked: bool = True
    dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves over axes; uprights: values of x with a dashed line each, and what is written at it."""

    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    uprights: tuple[tuple[float, str], ...] = ()

    def axes(self) -> tuple[LogAxis, LogAxis]:
        """The axes around the marked curves."""
        marked = [curve for curve in self.curves if curve.marked]
        x = [value for curve in marked for value in curve.x] + [value for value, _ in self.uprights]
        return LogAxis.around(self.x_label, x), LogAxis.around(
            self.y_label, [value for curve in marked for value in curve.y]
        )


def chart(title: str, panels: Sequence[Panel], note: str = "") -> Drawing:
    """Panels from left to right on a page that fits them, with a title, a legend of the marked curves of all of them,
    each name once, in as many rows as it needs, and a note after that."""
    width, height = PANEL_MM
    step = LEFT_MM + width
    rows = _entries(panels, note, len(panels) * step - LEFT_MM)
    page = (len(panels) * step + RIGHT_MM, BELOW_MM + height + ABOVE_MM + (len(rows) - 1) * ROW_MM)
    grid: list[Floats] = []
    frame: list[Floats] = []
    inked: dict[int, list[Floats]] = {}
    dashes: dict[int, list[Floats]] = {}
    texts = letters(title, (LEFT_MM, page[1] - 2.0 - TITLE_MM), TITLE_MM)
    for number, panel in enumerate(panels):
        corner = np.array([number * step + LEFT_MM, BELOW_MM])
        x, y = panel.axes()
        frame.append(corner + np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]) * PANEL_MM)
        for axis, along in ((x, 0), (y, 1)):
            parts = _axis(axis, along, corner)
            grid += parts[0]
            frame += parts[1]
            texts += parts[2]
        for curve in panel.curves:
            where = np.stack([x.place(np.asarray(curve.x)), y.place(np.asarray(curve.y))], axis=1)
            mine = dashes if curve.dashed else inked
            lines = _clipped(where) if curve.dashed else _runs(where)
            mine.setdefault(curve.colour, []).extend(corner + line * PANEL_MM for line in lines)
            if curve.marked:
                where[np.asarray(curve.y) == 0.0, 1] = 0.0
                seen = where[np.isfinite(where).all(axis=1)]
                inked.setdefault(curve.colour, []).extend(_markers(corner + seen * PANEL_MM, curve.colour))
        for value, text in panel.uprights:
            right = float(corner[0] + x.place(value) * width)
            dashes.setdefault(-1, []).append(np.array([(right, BELOW_MM), (right, BELOW_MM + height)]))
            texts += letters(text, (right - 1.0, BELOW_MM + 2.0), NUMBER_MM, upwards=True)
    names = _legend(rows, (LEFT_MM, BELOW_MM + height + 4.0), inked)
    layers = [Layer("grid", GRID, (_paths(grid),)), Layer("axes", AXES, (_paths(frame),))]
    for colour in sorted({*inked, *dashes}):
        pen = Pen(CURVE, COLOURS[colour % len(COLOURS)]) if colour >= 0 else Pen(0.25)
        broken = dashed(_paths(dashes.get(colour, [])), DASH_MM, GAP_MM)
        layers.append(Layer(f"curve {colour + 1}", pen, (_paths(inked.get(colour, [])), broken)))
    layers.append(Layer("letters", LETTERS, (_paths([*texts, *names]),)))
    return Drawing(*page, tuple(layers), items=("chart",), title=title)


def _axis(axis: LogAxis, along: int, corner: Floats) -> tuple[list[Floats], list[Floats], list[Floats]]:
    """Lines across the panel, ticks and letters of an axis; along: 0 for x, 1 for y."""
    unit, other = np.eye(2)[along], np.eye(2)[1 - along]
    size = np.array(PANEL_MM)
    lines, ticks, texts = [], [], []
    for tick in axis.ticks():
        foot = corner + float(axis.place(tick.value)) * unit * size
        ticks.append(np.array([foot, foot + (TICK_MM if tick.text else SHORT_TICK_MM) * other]))
        if tick.text:
            lines.append(np.array([foot, foot + other * size]))
            texts += _number(tick.text, foot, along)
    middle = corner + 0.5 * unit * size
    if along == 0:
        texts += letters(axis.label, (middle[0], middle[1] - 11.0), LABEL_MM, along="middle")
    else:
        texts += letters(axis.label, (middle[0] - 16.0, middle[1]), LABEL_MM, along="middle", upwards=True)
    return lines, ticks, texts


def _number(text: str, foot: Floats, along: int) -> list[Floats]:
    """The letters of a number at a tick, an exponent raised."""
    base, _, exponent = text.partition("^")
    width = text_width(base, NUMBER_MM) + (0.6 + text_width(exponent, EXPONENT_MM) if exponent else 0.0)
    x = foot[0] - 0.5 * width if along == 0 else foot[0] - 1.5 - width
    y = foot[1] - 2.0 - NUMBER_MM if along == 0 else foot[1] - 0.5 * NUMBER_MM
    found = letters(base, (x, y), NUMBER_MM)
    if exponent:
        found += letters(exponent, (x + width, y + 0.55 * NUMBER_MM), EXPONENT_MM, along="right")
    return found


def _entries(panels: Sequence[Panel], note: str, room: float) -> list[list[tuple[str, int | None]]]:
    """The rows of a legend no wider than there is room: names of marked curves with their inks, each once, and a note,
    which has none."""
    named = {curve.name: curve.colour for panel in panels for curve in panel.curves if curve.marked}
    rows: list[list[tuple[str, int | None]]] = [[]]
    taken = 0.0
    for name, colour in (*named.items(), *([(note, None)] if note else [])):
        width = _entry_width(name, colour)
        if rows[-1] and taken + width - SAMPLE_MM > room:
            rows.append([])
            taken = 0.0
        rows[-1].append((name, colour))
        taken += width
    return rows


def _entry_width(name: str, colour: int | None) -> float:
    """What a name takes of a row, with its sample of line, and the room behind it."""
    return text_width(name, LABEL_MM) + SAMPLE_MM + (0.0 if colour is None else SAMPLE_MM + 2.0)


def _legend(
    rows: list[list[tuple[str, int | None]]], at: tuple[float, float], inked: dict[int, list[Floats]]
) -> list[Floats]:
    """The letters of a legend, the last of its rows at a place; samples of lines join those of the curves."""
    found: list[Floats] = []
    for number, row in enumerate(rows):
        x, y = at[0], at[1] + (len(rows) - 1 - number) * ROW_MM
        for name, colour in row:
            start = x
            if colour is not None:
                middle = y + 0.5 * LABEL_MM
                sample = np.array([(x, middle), (x + SAMPLE_MM, middle)])
                marker = _markers(sample.mean(axis=0, keepdims=True), colour)
                inked.setdefault(colour, []).extend([sample, *marker])
                start += SAMPLE_MM + 2.0
            found += letters(name, (start, y), LABEL_MM)
            x += _entry_width(name, colour)
    return found


def _markers(points: Floats, colour: int) -> list[Floats]:
    """A small figure around every point: a circle, a square, a triangle, a diamond, one for each ink."""
    sides, turn = ((16, 0.0), (4, 0.25 * np.pi), (3, 0.5 * np.pi), (4, 0.0))[colour % 4]
    angle = turn + np.linspace(0.0, 2.0 * np.pi, sides + 1)
    figure = MARKER_MM * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return [point + figure for point in points]


def _runs(places: Floats) -> list[Floats]:
    """The parts of a polyline (n,2) between points that are not finite."""
    known = np.isfinite(places).all(axis=1)
    runs = [run[np.isfinite(run).all(axis=1)] for run in np.split(places, np.flatnonzero(~known))]
    return [run for run in runs if len(run) > 1]


def _clipped(places: Floats) -> list[Floats]:
    """The part of a straight line from the first to the last of some places that is in the unit square, if any."""
    start, way = places[0], places[-1] - places[0]
    if not np.isfinite(places).all() or not way.any():
        return []
    with np.errstate(divide="ignore", invalid="ignore"):
        sides = np.stack([-start / way, (1.0 - start) / way])
    into, out = np.where(way == 0.0, 0.0, sides.min(axis=0)), np.where(way == 0.0, 1.0, sides.max(axis=0))
    low, high = max(float(into.max()), 0.0), min(float(out.min()), 1.0)
    return [np.stack([start + low * way, start + high * way])] if low < high else []


def _paths(lines: Iterable[Floats]) -> Paths:
    """Polylines on the page as strokes of item 0."""
    parts = list(lines)
    if not parts:
        return Paths.empty()
    count = np.array([len(part) for part in parts], dtype=np.intp)
    points, zeros = np.concatenate(parts), np.zeros(len(parts), dtype=np.intp)
    space = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
    kind = np.full(len(parts), LineKind.CURVE, dtype=np.intp)
    return Paths(points, ragged.offsets(count), np.zeros(len(parts), dtype=np.bool_), kind, zeros, zeros, space)
