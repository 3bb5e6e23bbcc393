"""Parallel lines cut off where they enter and leave regions, all at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged

MOST_STROKES = 10_000_000
"""No sheet of paper takes more strokes."""


@dataclass(frozen=True, eq=False)
class Scanned:
    """The parts (k,) of lines inside regions: region and line, ascending, and where along the line each begins and
    ends, low and high."""

    region: Ints
    line: Ints
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.region)


def scanned(u: Floats, v: Floats, offsets: Ints, region: Ints, spacing: Floats) -> Scanned:
    """The parts inside regions of lines along u: line k of a region is where v is k + 1/2 times its spacing.

    u, v (c,): corners of rings offsets (n+1,); region (n,): which each ring bounds, from outside or as a hole; spacing
    (r,) of regions. So neighbours of one spacing share their lines, and lines meet corners seldom: a corner on a line
    counts as above it.
    Errors: InputError for more than MOST_STROKES parts. Degenerate: regions between two lines have none.
    """
    of = np.repeat(region, np.diff(offsets))
    after = ragged.following(offsets)
    place = v / spacing[of] - 0.5
    here, there = place, place[after]
    low, high = np.ceil(np.minimum(here, there)), np.ceil(np.maximum(here, there))
    crossed = high - low
    if not crossed.sum() < 2 * MOST_STROKES:
        raise InputError(f"strokes {spacing.min():g} apart are too fine: more than {MOST_STROKES} of them")
    count = crossed.astype(np.intp)
    side = ragged.owner(count)
    line = low[side] + ragged.place(count)
    share = (line - here[side]) / (there - here)[side]
    along = u[side] + share * (u[after] - u)[side]
    order = np.lexsort((along, line, of[side]))
    side, line, along = side[order], line[order], along[order]
    # Every line enters and leaves a region by turns.
    low, high = along[0::2], along[1::2]
    full = np.flatnonzero(high > low)
    return Scanned(of[side[2 * full]], line[2 * full].astype(np.intp), low[full], high[full])
