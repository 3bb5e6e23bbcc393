"""Boxes that overlap, strip by strip, are those found one by one."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.boxes import BoxStrips


def one_by_one(low: np.ndarray, high: np.ndarray, others: BoxStrips) -> set[tuple[int, int]]:
    """Pairs of which each is looked at."""
    near = (low[:, :, None] <= others.high[:, None]) & (high[:, :, None] >= others.low[:, None])
    return set(zip(*(side.tolist() for side in np.nonzero(near.all(axis=0))), strict=True))


def chain(rng: np.random.Generator, count: int, length: int) -> BoxStrips:
    """Boxes that follow each other, as the chords of a curve do."""
    at = np.cumsum(rng.normal(size=(2, count)), axis=1)
    return BoxStrips(at, at + rng.uniform(0.0, 2.0, (2, count)), length)


@pytest.mark.parametrize("length", [1, 4, 16])
@pytest.mark.parametrize("count", [1, 4, 7, 60])
def test_pairs_are_those_found_one_by_one_and_each_is_found_once(count: int, length: int) -> None:
    rng = np.random.default_rng(count)
    one, two = chain(rng, count, length), chain(rng, 50, length)
    for found in (two.overlapping(one.low, one.high), one.overlapping_strips(two)):
        pairs = list(zip(*(side.tolist() for side in found), strict=True))
        assert len(set(pairs)) == len(pairs)
        assert set(pairs) == one_by_one(one.low, one.high, two)


def test_boxes_that_only_touch_overlap() -> None:
    one = BoxStrips(np.zeros((2, 1)), np.ones((2, 1)), 4)
    low = np.array([[1.0, 1.0], [1.0, 1.1]])
    assert [side.tolist() for side in one.overlapping(low, low + 1.0)] == [[0], [0]]


def test_nothing_overlaps_nothing() -> None:
    none = BoxStrips(np.zeros((2, 0)), np.zeros((2, 0)), 4)
    one = BoxStrips(np.zeros((2, 1)), np.ones((2, 1)), 4)
    for found in (one.overlapping(none.low, none.high), none.overlapping_strips(one), one.overlapping_strips(none)):
        assert [len(side) for side in found] == [0, 0]
