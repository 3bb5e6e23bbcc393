"""Hard cases swept through their degeneracy: what is asked, what is true, and how far the answer may be from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vectorplot.arrays import Floats


@dataclass(frozen=True)
class Sweep:
    """A family of scenes with one knob, at 0 of which the scene is degenerate (or at infinity).

    hard: the numbers of the hard cases it sweeps; knob, answer: what is turned, and what is measured; values: of the
    knob, those of a test and those of the plot; found, truth: the answer of the package at a value, and the right one;
    room: how far they may be apart there; limit: the value from which on the package says that it cannot tell the case
    from the degenerate one, where there is such a value, and what that says.
    """

    name: str
    hard: tuple[int, ...]
    knob: str
    answer: str
    values: Floats
    found: Callable[[float], float]
    truth: Callable[[float], float]
    room: Callable[[float], float]
    limit: tuple[float, str] | None = None

    def error(self, value: float) -> float:
        """How far the answer at a value is from the truth."""
        return abs(self.found(value) - self.truth(value))
