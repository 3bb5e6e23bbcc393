"""How much work a smooth surface may be before its picture is finished without the rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields

from vectorplot.errors import InputError

HOW = "a larger budget may do (--budget)"
"""How what was left out may be had all the same."""


@dataclass(frozen=True)
class Budget:
    """Limits of the work on the smooth surfaces of a picture, and on shortest ways: with them every picture ends.

    Parameters
    ----------
    cells : int
        Of one size that the domain of a surface is cut into around one family of curves.
    triangles : int
        That an implicit surface is cut into around one.
    points : int
        That the curves of one are refined to.
    pairs : int
        Of two chords, of a chord and a triangle, or of a sight line and a triangle, that come near each other in the
        image and are looked at closely.
    facets : int
        Triangles that a surface is painted or rendered by.
    pieces : int
        That faces which pierce one another are cut into to be painted in order.
    windows : int
        That the shortest ways on a mesh from one place are looked for through.

    Notes
    -----
    What a budget does not do for is left out, and a doubt or an InputWarning says so.

    Examples
    --------
    >>> from vectorplot import features, geometry, surfaces
    >>> tracing = features.Tracing(tolerance=1e-9, budget=geometry.Budget(points=100))
    >>> curves = features.contour(surfaces.Sphere(), (4, 0, 0), tracing=tracing)
    >>> len(curves), len(curves.doubts)
    (1, 1)
    """

    cells: int = 1 << 13
    triangles: int = 1 << 17
    points: int = 1 << 16
    pairs: int = 1 << 20
    facets: int = 1 << 18
    pieces: int = 1 << 15
    windows: int = 20_000_000


USUAL = Budget()
"""The budget where nothing else is said."""


def budget_of(factor: float) -> Budget:
    """The usual budget, so many times.

    Parameters
    ----------
    factor : float
        Positive; 1 is the usual budget.

    Returns
    -------
    Budget
        Every limit so many times as large, and 1 at least.

    Raises
    ------
    InputError
        Unless the factor is finite and positive.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.budget_of(2.0).points == 2 * geometry.Budget().points
    True
    """
    if not 0.0 < factor < math.inf:
        raise InputError(f"a budget of {factor:g}: expected a factor that is finite and positive")
    limits = (getattr(USUAL, limit.name) for limit in fields(Budget))
    # No array has more elements than that.
    return Budget(*(max(1, int(min(limit * factor, 2.0**62))) for limit in limits))


def unresolved(what: str) -> str:
    """The doubt that the budget did not do for something."""
    return f"{what}: {HOW}"


def unheard(part: float) -> None:
    """Whom long work tells the part of it that is done when nobody wants to know."""


def part_of(done: Callable[[float], None], number: int, count: int) -> Callable[[float], None]:
    """Whom the number-th of count equal parts of long work tells the part of it that is done."""
    return lambda part: done((number + part) / count)


def in_one_line(doubts: Iterable[str]) -> str:
    """The doubts about one thing, each once, as one sentence; what the budget did not do for comes last."""
    each = list(dict.fromkeys(doubts))
    spent = [text.removesuffix(f": {HOW}") for text in each if text.endswith(HOW)]
    rest = [text for text in each if not text.endswith(HOW)]
    return "; ".join([*rest, *([unresolved("; ".join(spent))] if spent else [])])


def line_each(doubts: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """The doubts about several things, each with the name of what it is about: one line for each of these."""
    about: dict[str, list[str]] = {}
    for name, text in doubts:
        about.setdefault(name, []).append(text)
    return tuple(f"{name}: {in_one_line(texts)}" for name, texts in about.items())
