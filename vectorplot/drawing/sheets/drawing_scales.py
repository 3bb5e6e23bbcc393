"""Scales of technical drawings: lengths on paper to lengths of the thing."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from vectorplot.errors import InputError


@dataclass(frozen=True)
class DrawingScale:
    """How many mm on paper show how many units of the world, as in 1:2.

    Parameters
    ----------
    paper, world : float
        Of 1:2 these are 1 and 2.

    Raises
    ------
    InputError
        By `of`, for a text that says no scale.

    Examples
    --------
    >>> from vectorplot.drawing import DrawingScale
    >>> half = DrawingScale.of("1:2")
    >>> str(half), half.factor
    ('1:2', 0.5)
    """

    paper: float
    world: float

    @property
    def factor(self) -> float:
        """Mm on paper for a unit of the world."""
        return self.paper / self.world

    def __str__(self) -> str:
        return f"{_figures(self.paper)}:{_figures(self.world)}"

    @classmethod
    def of(cls, text: str) -> DrawingScale:
        """The scale that a text such as 1:2 or 5:1 says. Errors: InputError for another text, and numbers that are not
        finite and positive."""
        sides = re.fullmatch(r"\s*([^:]+):([^:]+)", str(text))
        try:
            paper, world = (float(side) for side in sides.groups()) if sides else (math.nan, math.nan)
        except ValueError:
            paper = world = math.nan
        if not (0.0 < paper < math.inf and 0.0 < world < math.inf and 0.0 < paper / world < math.inf):
            raise InputError(f"scale {text!r}: expected two numbers such as 1:2")
        return cls(paper, world)

    @classmethod
    def largest_standard(cls, factor: float) -> DrawingScale:
        """The largest standard scale with a factor no larger than one that is finite and positive.

        Source: ISO 5455, table 1 and clause 5: 1, 2 and 5 times powers of ten, beyond the table too.
        """
        power = math.floor(math.log10(factor))
        steps = [(digit, exponent) for exponent in (power - 1, power, power + 1) for digit in (1, 2, 5)]
        scales = [_standard(digit, exponent) for digit, exponent in steps]
        return max((scale for scale in scales if scale.factor <= factor), key=lambda scale: scale.factor)


def _standard(digit: int, exponent: int) -> DrawingScale:
    if exponent >= 0:
        return DrawingScale(digit * 10.0**exponent, 1.0)
    return DrawingScale(1.0, 10.0**-exponent / digit)


def _figures(number: float) -> str:
    return str(int(number)) if number.is_integer() else repr(number)
