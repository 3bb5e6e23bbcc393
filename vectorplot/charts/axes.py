"""Logarithmic axes: their ends, and where they are marked and how."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.elementary import log
from vectorplot.tolerances.of_measuring import PLAIN_NUMBER

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

        Degenerate: no such value gives the axis from 0.1 to 10, a single one a power of ten about it.
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
