"""Where something changes along ways: as near as halving leads, in fewer calls, whatever the number of ways."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.chord_refinement import AT_ONCE, bisected


@pytest.mark.parametrize("count", [1, 3, 70, AT_ONCE, 3 * AT_ONCE])
def test_what_is_found_is_what_halving_finds(count: int) -> None:
    random = np.random.default_rng(count)
    low, high = random.uniform(-1.0, 0.0, count), random.uniform(1.0, 2.0, count)
    change = random.uniform(low, high)
    found_low, found_high = bisected(lambda way, t: t < change[way], low, high, 52)
    assert (found_low < change).all() and (found_high >= change).all()
    assert (found_high - found_low <= (high - low) * 0.5**52 + np.spacing(np.abs(high))).all()


def test_few_ways_take_few_calls() -> None:
    calls: list[int] = []
    bisected(lambda way, t: calls.append(len(t)) or t < 0.3, np.zeros(2), np.ones(2), 52)
    assert len(calls) == 13 and max(calls) == 30


def test_where_nothing_changes_high_is_given() -> None:
    low, high = bisected(lambda way, t: np.ones(len(t), dtype=np.bool_), np.zeros(2), np.full(2, 3.0), 20)
    assert (high == 3.0).all() and np.allclose(low, 3.0, atol=1e-5)


def test_without_ways_nothing_is_asked() -> None:
    low, high = bisected(lambda way, t: pytest.fail("asked"), np.zeros(0), np.zeros(0), 52)
    assert len(low) == len(high) == 0
