"""The numbers along an axis: round ones, with what is common to them said once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.scene.terrains.level_lines import round_heights
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

TICKS = 5
"""About so many on every axis."""

MOST_DIGITS = 4
"""Numbers that need more digits to be told apart are counted from a round one."""

LONGEST = 6
"""Numbers with more letters are told as parts of a power of ten."""

_HIGH = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


@dataclass(frozen=True)
class AxisNumbers:
    """Where an axis is marked: values, ascending, what stands at each, and what these are to be taken times and added
    to, if that is not 1 and 0."""

    values: tuple[float, ...]
    texts: tuple[str, ...]
    common: str = ""

    def drawn(self, times: float) -> AxisNumbers:
        """The same numbers where they are drawn times as far from the origin."""
        return replace(self, values=tuple(times * value for value in self.values))


def axis_numbers(low: float, high: float) -> AxisNumbers:
    """Round numbers from one end of an axis to the other, both included where they are round.

    Degenerate: where both ends are the same that one.
    """
    values = _round(low, high)
    if len(values) < 2:
        return AxisNumbers(values, tuple(f"{value:.6g}" for value in values))
    step = values[1] - values[0]
    offset = _offset(values, step)
    counted = np.rint((np.array(values) - offset) / step) * step
    texts = _texts(counted.tolist(), step, 0)
    power = _power(float(np.abs(counted).max())) if max(map(len, texts)) > LONGEST else 0
    common = [*([f"× 10{str(power).translate(_HIGH)}"] if power else []), *([_added(offset)] if offset else [])]
    return AxisNumbers(values, _texts(counted.tolist(), step, power), " ".join(common))


def single_number(low: float, high: float) -> AxisNumbers:
    """One number between the ends of an axis that are too near each other for more: zero, or a round one."""
    if low <= 0.0 <= high:
        return AxisNumbers((0.0,), ("0",))
    value = min(_round(low, high) or (low,), key=lambda one: len(f"{one:.6g}"))
    return AxisNumbers((value,), (f"{value:.6g}",))


def _round(low: float, high: float) -> tuple[float, ...]:
    inner = round_heights(low, high, TICKS)
    if not low < high:
        return (low,)
    if len(inner) < 2:
        return inner
    step, slack = inner[1] - inner[0], ZERO_OF_EXTENT * (high - low)
    before, after = inner[0] - step, inner[-1] + step
    return (*((before,) if before >= low - slack else ()), *inner, *((after,) if after <= high + slack else ()))


def _offset(values: tuple[float, ...], step: float) -> float:
    """What numbers are counted from: 0 where few digits tell them apart, else the roundest one beside them."""
    low, high = values[0], values[-1]
    if _power(max(abs(low), abs(high))) - _power(step) < MOST_DIGITS:
        return 0.0
    unit = 10.0 ** np.ceil(math.log10(high - low))
    nearest = float(np.rint(0.5 * (low + high) / unit) * unit)
    return nearest if low <= nearest <= high else float(np.floor(low / unit) * unit)


def _power(value: float) -> int:
    """The power of ten of the first digit of a number that is positive, for 9.9999999 of the next one."""
    return int(np.floor(math.log10(value) + ZERO_OF_EXTENT))


def _texts(values: list[float], step: float, power: int) -> tuple[str, ...]:
    digits = max(power - _power(step), 0)
    found = (f"{round(value / 10.0**power, digits) + 0.0:.{digits}f}" for value in values)
    return tuple(text.rstrip("0").rstrip(".") if "." in text else text for text in found)


def _added(value: float) -> str:
    return f"{'+' if value > 0.0 else '−'} {abs(value):.12g}"
