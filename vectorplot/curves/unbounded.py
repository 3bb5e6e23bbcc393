"""Functions that run to infinity: found by climbing, and cut off where nearly all of their values are left behind."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Floats

LOOKS = 61
"""Places along each side at which a function is looked at first: an odd number, but none in the very middle."""

FENCE = 1.5
"""Interquartile ranges beyond the quartiles at which a function that runs to infinity is cut off (Tukey's inner
fences)."""

CLIMBERS, CLIMBS = 8, 40
"""From how many of its extreme values a function is climbed, and how often the way is halved."""

FIRST_CLIMBS = 8
"""The climb after which a function that is not over its fence is left alone."""

HUGE = 1e100
"""Times the fence: who is there has met the largest numbers there are."""

AROUND = 5
"""Places along each side of the square around a climber."""

GROWS = 1.2
"""A function that has grown by this factor over the second half of the climb, which is finer than a millionth, has no
end."""

Limits = tuple[Floats, Floats]
"""Smallest and largest values (k,) of the components of a function; infinite where there are none."""


def limits_of(values: Callable[..., Floats], low: Floats, high: Floats, *, looks: int = LOOKS) -> Limits | None:
    """Where a function of two parameters, between low and high (2,), is cut off because it runs to infinity; None for
    one that does not.

    values(u, v) -> (n, k), NaN where the function has none. A component that grows without end about one of its
    extreme values is cut off at its inner fences, above and below.
    Degenerate: poles that all of the looks miss are not found; a function all but constant has no fences.
    Source: Tukey, Exploratory Data Analysis, 1977, chapter 2 (inner fences).
    """
    step = (high - low) / looks
    # Off the lines of symmetry, on which poles lie: they are beside some of the places.
    line = np.arange(looks) + 0.4871
    places = low + np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2) * step
    found = values(*places.T)
    floor, ceiling = np.full(found.shape[1], -np.inf), np.full(found.shape[1], np.inf)
    for k in range(found.shape[1]):
        own = found[:, k]
        known = np.flatnonzero(np.isfinite(own))
        if len(known) < CLIMBERS:
            continue
        first, middle, third = np.quantile(own[known], (0.25, 0.5, 0.75))
        fence = FENCE * (third - first)
        for sign, edge in ((1.0, third + fence), (-1.0, first - fence)):
            start = places[known[np.argsort(-sign * own[known], kind="stable")[:CLIMBERS]]]

            def height(u: Floats, v: Floats, k: int = k, sign: float = sign, middle: float = middle) -> Floats:
                return np.asarray(sign * (values(u, v)[:, k] - middle))

            if fence > 0.0 and _has_no_end(height, start, step, low, high, sign * (edge - middle)):
                floor[k], ceiling[k] = first - fence, third + fence
    return (floor, ceiling) if np.isfinite(floor).any() or np.isfinite(ceiling).any() else None


def _has_no_end(
    height: Callable[..., Floats], start: Floats, step: Floats, low: Floats, high: Floats, fence: float
) -> bool:
    """Whether a function grows on and on, over the fence, from one of the places (s,2), within squares about the best
    place so far that are halved each time."""
    at, best = start.copy(), height(*start.T)
    line = np.linspace(-1.0, 1.0, AROUND)
    square = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    half = best
    for climb in range(CLIMBS):
        tried = np.clip(at[:, None] + square * step * 0.5**climb, low, high)
        found = height(*tried.reshape(-1, 2).T).reshape(len(at), -1)
        found = np.where(np.isfinite(found), found, -np.inf)
        highest = np.argmax(found, axis=1)
        row = np.arange(len(at))
        better = found[row, highest] > best
        at[better], best = tried[row, highest][better], np.maximum(best, found[row, highest])
        if climb == FIRST_CLIMBS and not (best > fence).any():
            return False
        if climb == CLIMBS // 2:
            half = best
    return bool(((best / GROWS > half) | (best / HUGE > fence)).any())
