"""Pictures that keep a promise: an error on the page, or a time. Their accuracy is chosen for it, and measured."""

from __future__ import annotations

import math
import re
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from vectorplot.errors import InputError, InputWarning
from vectorplot.pictures.pipeline import StageReport, peak_mb
from vectorplot.scene.page import MM_PER
from vectorplot.tolerances import ERROR_SAID, FINEST_DRAWN_MM, FINEST_PAINTED_MM, LEAST_TOLERANCE_MM

R = TypeVar("R")

PROMISE, BROKEN = "promise", "broken promise"
"""The names under which a listener is told what became of a promise."""

_QUANTITY = re.compile(r"\s*([0-9.]+(?:e[-+]?[0-9]+)?)\s*([a-z]*)\s*", re.IGNORECASE)
"""A number, and perhaps a unit."""

_SECONDS = {"ms": 1.0 / 1000.0, "s": 1.0, "min": 60.0}

_STEPS = "shades"
"""The unit of errors of colours: steps of 255."""


def off_by_of(asked: float | str, *units: str) -> dict[str, float]:
    """The largest errors, by their units, of a number (of the first unit) or a text such as ``0.01mm`` or
    ``0.01mm,4shades``: lengths in mm on paper, pixels as px, colours as shades, steps of 255; InputError for what is
    none of the units, or no positive number."""
    if not isinstance(asked, str):
        asked = repr(float(asked))
    found: dict[str, float] = {}
    for part in asked.split(","):
        value, unit = _quantity(part)
        unit = unit or units[0]
        if unit in MM_PER and "mm" in units:
            value, unit = value * MM_PER[unit], "mm"
        if unit not in units or unit in found or not 0.0 < value < math.inf:
            expected = ", ".join(f"a positive number of {unit}" for unit in units)
            raise InputError(f"off_by {asked.strip()!r}: expected {expected}; each once, with commas between them")
        found[unit] = value
    return found


def within_of(asked: float | str) -> float:
    """Seconds of a number, or of a text such as ``0.5s``, ``300ms`` or ``2min``. InputError for others, and zero."""
    value, unit = _quantity(asked) if isinstance(asked, str) else (float(asked), "s")
    seconds = value * _SECONDS.get(unit or "s", math.nan)
    if not 0.0 < seconds < math.inf:
        raise InputError(f"within {asked!r}: expected a positive time in {', '.join(_SECONDS)}, such as '0.5s'")
    return seconds


def _quantity(text: str) -> tuple[float, str]:
    found = _QUANTITY.fullmatch(text)
    try:
        return (float(found[1]), found[2].lower()) if found else (math.nan, "")
    except ValueError:
        return math.nan, ""


@dataclass(frozen=True)
class Parameter:
    """The argument of a verb that decides how accurate its pictures are.

    name: of the argument; usual: its value where nobody chooses; coarse, fine: the ends of its range; first, finest:
    the values that time is spent on at first and at last; power: of what work grows with fineness; aim: the value at
    which a picture keeps errors, by their units; units: of errors that it may be asked for.
    """

    name: str
    usual: float | None
    coarse: float
    fine: float
    first: float
    finest: float
    power: float
    aim: Callable[[Mapping[str, float]], float]
    units: tuple[str, ...]

    def of(self, value: float) -> float:
        """The nearest value in the range that is no coarser; whole, where the ends are."""
        low, high = sorted((self.coarse, self.fine))
        value = min(max(value, low), high)
        return math.ceil(value) if isinstance(self.fine, int) else value

    def finer(self, value: float, factor: float) -> float:
        """A value at which errors are so many times smaller, if they go like it."""
        return self.of(value / factor if self.fine < self.coarse else value * factor)

    def is_finer(self, value: float, other: float, factor: float = 1.0) -> bool:
        """Whether errors are more than so many times smaller than at another value."""
        return factor * value < other if self.fine < self.coarse else value > factor * other


def _tolerance_for(asked: Mapping[str, float]) -> float:
    """Strokes and outlines are no farther off than their tolerance; shades are off by two steps of 255 at 0.02 mm, and
    in proportion (see paint)."""
    return min(asked.get("mm", math.inf), 0.01 * asked.get(_STEPS, math.inf))


def _samples_for(asked: Mapping[str, float]) -> float:
    """What is seen is decided in the middles of samples, and triangles are off by a fifth of one."""
    return 0.7 / asked["px"]


DRAWING = Parameter("tolerance_mm", 0.02, 1.0, LEAST_TOLERANCE_MM, 0.1, FINEST_DRAWN_MM, 0.5, _tolerance_for, ("mm",))
"""The parameter of draw: chords of smooth curves get more with the root of the tolerance."""

PAINTING = Parameter(
    "tolerance_mm", 0.02, 1.0, LEAST_TOLERANCE_MM, 0.1, FINEST_PAINTED_MM, 0.7, _tolerance_for, ("mm", _STEPS)
)
"""The parameter of paint: triangles of smooth surfaces get more with the tolerance."""

RENDERING = Parameter("samples", None, 1, 8, 1, 8, 2.0, _samples_for, ("px",))
"""The parameter of render: samples along the side of a pixel."""

TRIES = 4
"""So many pictures are made at most for an error."""

SURE = 0.9
"""A finer picture aims at this part of the error."""

SPENT, FIXED = 0.8, 0.5
"""So much of the time that is left the next picture may be expected to take; and such a part of what the last one took
is the same at every accuracy."""

WORTH, GAIN = 1.4, 30.0
"""A picture that is less than so many times finer than the last one is not worth its time; and by how much it may be
finer at most, for what it costs is foretold from the last one."""


UNTIL = 0.9
"""A picture is given up after this part of the time: some stages take a while until they hear of it."""


class _TimeIsOver(Exception):
    """A picture is given up for which there is a coarser one."""


@dataclass(frozen=True)
class _Made(Generic[R]):
    """A picture, the value of the parameter and the seconds it took, and what was said while it was made."""

    picture: R
    value: float
    seconds: float
    reports: list[StageReport]
    warned: list[warnings.WarningMessage]

    @property
    def errors(self) -> dict[str, float]:
        """What was measured, by unit: the errors of the stages of a unit add up."""
        worst: dict[tuple[str, str], float] = {}
        for report in self.reports:
            if report.error is not None:
                key = report.unit, report.name
                worst[key] = max(worst.get(key, 0.0), report.error)
        sums: dict[str, float] = {}
        for (unit, _), error in worst.items():
            sums[unit] = sums.get(unit, 0.0) + error
        return sums

    @property
    def hidden_lines_are_exact(self) -> bool:
        """Whether a stage has told so."""
        return any(report.name in ("visible lines", "counted lines") for report in self.reports)


def promised(verb: Callable[..., R], parameter: Parameter, arguments: Mapping[str, Any]) -> R:
    """The picture of a verb that keeps what its arguments off_by and within ask for.

    For an error, the verb's parameter is set to what keeps it as a rule; what was reached is measured, and where that
    is more, a finer picture is made. For a time, a coarse picture is made first, then finer ones as long as they are
    expected to be done in time; one that is not is given up. For both, the error decides, and a finer picture
    that is not done in time is given up.

    A listener (explain) is told the stages of the picture that is taken, and as "promise" or "broken promise" what was
    reached, and by how many pictures.

    Errors: InputError for impossible promises, and for a parameter that is set besides. Warns: InputWarning where a
    promise could not be kept, with what was reached.
    """
    told = {name: value for name, value in arguments.items() if name not in ("off_by", "within")}
    asked = {} if arguments["off_by"] is None else off_by_of(arguments["off_by"], *parameter.units)
    seconds = math.inf if arguments["within"] is None else within_of(arguments["within"])
    if told[parameter.name] != parameter.usual:
        raise InputError(f"{parameter.name} does not go with off_by and within, which choose it")
    if asked and told.get("shadows") == "auto" and parameter is RENDERING:
        # Shadow maps have errors of their own, which have no bound in pixels.
        told["shadows"] = "exact"
    start = time.perf_counter()

    def make(value: float, last: _Made[R] | None) -> _Made[R]:
        """The picture at a value; _TimeIsOver where time ends before it is done, and there is another."""
        reports: list[StageReport] = []
        began, listener = time.perf_counter(), told["progress"]

        def progress(stage: str, fraction: float) -> None:
            if last is not None and time.perf_counter() - start > UNTIL * seconds:
                raise _TimeIsOver
            if listener is not None:
                listener(stage, fraction)

        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always", InputWarning)
            own = {parameter.name: value, "progress": progress, "explain": reports.append}
            picture = verb(**(told | own))
        return _Made(picture, value, time.perf_counter() - began, reports, warned)

    def reached(made: _Made[R]) -> dict[str, float]:
        """Its errors, by the units of promises."""
        found = {unit: made.errors[name] for unit, name in (("mm", "mm"), (_STEPS, "of 255")) if name in made.errors}
        if parameter is RENDERING:
            found = {"px": (0.5 + made.errors.get("samples", 0.0)) / made.value}
        return found

    def next_value(made: _Made[R]) -> float | None:
        """A finer value that is worth a picture; None where there is none."""
        if asked:
            found = reached(made)
            excess = {unit: found.get(unit, 0.0) / most for unit, most in asked.items()}
            # Errors of shades go like sides of triangles, those of outlines like their squares.
            factor = max((over / SURE) ** (2 if unit == _STEPS else 1) for unit, over in excess.items())
            return parameter.finer(made.value, factor) if max(excess.values()) > 1.0 else None
        # Pictures without approximations are as good as they get.
        approximate = {report.name for report in made.reports if report.error is not None} - _EXACT
        left = seconds - (time.perf_counter() - start)
        if not (approximate or parameter is RENDERING) or left <= 0.0:
            return None
        share = (SPENT * left / made.seconds - FIXED) / (1.0 - FIXED)
        factor = min(max(share, 0.0) ** (1.0 / parameter.power), GAIN)
        if parameter is RENDERING:
            return parameter.of(math.floor(made.value * factor))
        return max(parameter.finer(made.value, max(factor, 1.0)), parameter.finest)

    made = make(parameter.of(parameter.aim(asked)) if asked else parameter.first, None)
    count, value = 1, next_value(made)
    while (
        value is not None
        and parameter.is_finer(value, made.value, 1.0 if asked else WORTH)
        and (not asked or count < TRIES)
    ):
        try:
            made, count = make(value, made), count + 1
        except _TimeIsOver:
            break
        value = next_value(made)
    spent, found = time.perf_counter() - start, reached(made)
    kept = spent <= seconds and all(found.get(unit, 0.0) <= most for unit, most in asked.items())
    for entry in made.warned:
        warnings.warn_explicit(entry.message, entry.category, entry.filename, entry.lineno)
    text = _sentence(found, made, spent)
    if told["explain"] is not None:
        for report in made.reports:
            told["explain"](report)
        told["explain"](StageReport(PROMISE if kept else BROKEN, text, 0.0, count, peak_mb()))
    if not kept:
        wanted = [f"{most:g} {unit}" for unit, most in asked.items()] + [f"{seconds:g} s"] * (seconds < math.inf)
        warnings.warn(f"{' and '.join(wanted)} could not be kept: {text}", InputWarning, stacklevel=3)
    return made.picture


_EXACT = {"visible lines", "counted lines", "order", "shadows"}
"""Stages whose errors are those of rounding, at any accuracy."""


def _sentence(found: Mapping[str, float], made: _Made[Any], spent: float) -> str:
    """What was reached, such as ``off by 0.008 mm (hidden lines exact), 0.31 s``."""
    errors = " and ".join(f"{error:.2g} {unit}" for unit, error in found.items() if error >= ERROR_SAID) or "nothing"
    exact = " (hidden lines exact)" if made.hidden_lines_are_exact else ""
    return f"off by {errors}{exact}, {spent:.2f} s"
