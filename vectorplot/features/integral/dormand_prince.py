"""Steps of differential equations by the method of Dormand and Prince, many at once, and what is between their ends."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import records

STAGES = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
"""What the rates at earlier stages count at each later one; the last row gives the step of order 5."""

ERRORS = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
"""The step less that of order 4."""

BETWEEN = (
    -12715105075 / 11282082432,
    0.0,
    87487479700 / 32700410799,
    -10690763975 / 1880347072,
    701980252875 / 199316789632,
    -1453857185 / 822651844,
    69997945 / 29380423,
)
"""The part of order 4 of the way between the ends of a step."""

ORDER = 5

Rates = Callable[[Floats], Floats]
"""Takes states (k,d) to their derivatives (k,d)."""


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps from states start (k,d): the one by which each leads on, move (k,d); error (k,d): what it differs from that
    of one order less; rates (2,k,d) at both ends, times the length of the step; bend (k,d): the rest of what is
    between.

    Source: Dormand and Prince, A family of embedded Runge-Kutta formulae (1980); Hairer, Norsett and Wanner, Solving
    ordinary differential equations I, section II.6, for what is between.
    """

    start: Floats
    move: Floats
    error: Floats
    first: Floats
    last: Floats
    bend: Floats

    def at(self, part: Floats) -> Floats:
        """(k,d) the states at parts (k,) of the steps."""
        x = part[:, None]
        y = 1.0 - x
        rise = self.first - self.move
        return np.asarray(
            self.start + x * (self.move + y * (rise + x * (self.move - self.last - rise + y * self.bend)))
        )

    def slopes(self, part: Floats) -> Floats:
        """(k,d) the derivatives there of the states by the part."""
        x = part[:, None]
        y = 1.0 - x
        rise = self.first - self.move
        bent = self.move - self.last - rise
        between = rise + x * (bent + y * self.bend)
        way = self.move + y * between
        return np.asarray(way + x * (y * (bent + (y - x) * self.bend) - between))

    def some(self, which: Ints) -> Steps:
        """Some of the steps."""
        return records.some(self, which)


def steps(rates: Rates, start: Floats, first: Floats, length: Floats) -> Steps:
    """Steps of lengths (k,) from states start (k,d) with derivatives first (k,d) there."""
    h = length[:, None]
    found, move = [h * first], start
    for row in STAGES:
        move = _sum(row, found)
        found.append(h * rates(start + move))
    return Steps(start, move, _sum(ERRORS, found), found[0], found[-1], _sum(BETWEEN, found))


def _sum(weights: tuple[float, ...], parts: list[Floats]) -> Floats:
    total = weights[0] * parts[0]
    for weight, part in zip(weights[1:], parts[1:], strict=False):
        if weight:
            total = total + weight * part
    return total
