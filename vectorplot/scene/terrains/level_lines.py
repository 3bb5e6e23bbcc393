"""Heights of level lines: round ones, and every fifth of them heavier."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import log
from vectorplot.scene.surface_lines import MAX_LINES, Section
from vectorplot.tolerances.of_parameters import OFF_REGULAR_GRID

USUAL_COUNT = 20
"""Level lines between the lowest and the highest point, about."""

USUAL_EVERY = 5
"""Which of them are index lines."""

LARGEST_POWER = 300
"""The powers of ten up to this one, and down to its negative, are numbers of full precision."""

UP = (0.0, 0.0, 1.0)


def round_heights(low: float, high: float, count: int = USUAL_COUNT) -> tuple[float, ...]:
    """Round heights for level lines, evenly spaced between two heights.

    Parameters
    ----------
    low, high : float
        In world units.
    count : int
        About how many: the step is 1, 2 or 5 times a power of ten.

    Returns
    -------
    tuple of float
        The multiples of the step that are more than low and less than high, ascending.

    Raises
    ------
    InputError
        For heights that are not finite, and counts below 1 or above 10000.

    Notes
    -----
    Degenerate: none where both heights are the same.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.round_heights(3.0, 61.0, 10)
    (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0)
    """
    low, high = number("level lines: height", low), number("level lines: height", high)
    if not 1 <= count <= MAX_LINES:
        raise InputError(f"level lines: {count} of them, expected 1 to {MAX_LINES}")
    if not low < high:
        return ()
    power = int(np.floor(math.log10((high - low) / count)))
    # The last of the four is the first of the next power of ten.
    numerators = np.array([1.0, 2.0, 5.0, 10.0])
    best = int(np.abs(log(numerators * 10.0**power * count / (high - low))).argmin())
    step = float(numerators[best])
    first, last = (np.floor(height / step / 10.0**power) for height in (low, high))
    found = times_power_of_ten(step * np.arange(first, last + 2.0), power)
    return tuple(found[(found > low) & (found < high)].tolist())


def level_sections(heights: Sequence[float], every: int = USUAL_EVERY) -> tuple[Section, ...]:
    """Level lines, with every k-th of them an index line: of a kind of its own, and heavier.

    Parameters
    ----------
    heights : (n,) sequence of float
        In world units.
    every : int
        k; 0 for no index lines.

    Returns
    -------
    tuple of Section
        For the sections of SurfaceLines: the index lines, and the others.

    Raises
    ------
    InputError
        For a number below 0, and as of Section.

    Notes
    -----
    Index lines are those whose heights are multiples of k steps, where the heights are multiples of one step; else
    every k-th from the k-th one on.

    Examples
    --------
    >>> from vectorplot import scene
    >>> index, others = scene.level_sections([90, 100, 110, 120, 130, 140, 150, 160], every=5)
    >>> index.offsets, len(others.offsets)
    ((100.0, 150.0), 6)
    """
    return with_index_lines(Section(UP, tuple(heights)), every)


def with_index_lines(section: Section, every: int) -> tuple[Section, ...]:
    """The planes of a section, every k-th of them a section of index lines, as of `level_sections`; these alone are
    numbered, where the section is."""
    if every < 0:
        raise InputError(f"index lines: every {every}, expected 0 or more")
    if not every or not section.offsets:
        return (section,)
    levels = np.array(sorted(section.offsets))
    index = _index_numbers(levels) % every == 0
    heavy = replace(section, offsets=tuple(levels[index].tolist()), index=True)
    parts = heavy, replace(section, offsets=tuple(levels[~index].tolist()), numbered=False)
    return tuple(part for part in parts if part.offsets)


def _index_numbers(levels: Floats) -> Floats:
    """(n,) the number of each level: how many steps it is from zero, or its place, from 1."""
    place = np.arange(1.0, len(levels) + 1.0)
    if len(levels) < 2:
        return place
    step = (levels[-1] - levels[0]) / (len(levels) - 1)
    number = levels / step
    even = np.abs(number - np.round(number)).max() <= OFF_REGULAR_GRID
    return np.asarray(np.round(number) if even else place)


def times_power_of_ten(values: Floats, power: int) -> Floats:
    """The values times a power of ten, rounded once where that power is a number; powers beyond LARGEST_POWER in two
    steps."""
    if abs(power) > LARGEST_POWER:
        half = LARGEST_POWER if power > 0 else -LARGEST_POWER
        return times_power_of_ten(times_power_of_ten(values, half), power - half)
    return np.asarray(values * 10.0**power if power >= 0 else values / 10.0**-power)
