"""Where something changes along ways, many at once: found as by halving, in fewer calls."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints

AT_ONCE = 1 << 10
"""Places that are looked at in one call, at least one on each way: few of them take about as long as one."""

MOST_HALVINGS = 4
"""What is left of a way is cut in one call as fine as by no more halvings than that."""


def narrowed(
    goes_on: Callable[[Ints, Floats], Bools], low: Floats, high: Floats, halvings: int
) -> tuple[Floats, Floats]:
    """(k,) the last parameters between low and high (k,) up to which something is as it is at low, and the first at
    which it is not, as near to each other as so many halvings lead.

    goes_on: takes which of the k ways (n,) and parameters (n,) on these to whether (n,) it is as at low there.
    Degenerate: of several changes one is found; where nothing changes it is taken to do so at high.
    """
    if not len(low):
        return low, high
    at_once = int(np.clip(np.log2(AT_ONCE / len(low)), 1, MOST_HALVINGS))
    parts = 1 << at_once
    way, inner = np.arange(len(low)), np.arange(1, parts)[:, None] / parts
    ways = np.tile(way, parts - 1)
    for _ in range(-(-halvings // at_once)):
        tried = low + inner * (high - low)
        alike = goes_on(ways, tried.ravel()).reshape(tried.shape)
        last = np.where(alike.all(axis=0), parts - 1, np.argmin(alike, axis=0))
        nodes = np.concatenate([low[None], tried, high[None]])
        low, high = nodes[last, way], nodes[last + 1, way]
    return low, high
