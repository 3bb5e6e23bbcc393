"""Which boxes overlap, against all pairs."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.boxes import overlapping_boxes, overlapping_pairs


def boxes(rng, count, size):
    low = rng.uniform(0.0, 1.0, (3, count))
    return low, low + rng.uniform(0.0, size, (3, count))


@pytest.mark.parametrize(
    ("many", "few", "size"), [(200, 150, 0.2), (300, 3, 0.9), (1, 1, 2.0), (0, 5, 0.1), (40, 0, 0.1)]
)
def test_every_pair_comes_once(many, few, size):
    rng = np.random.default_rng(many + few)
    one, two = boxes(rng, many, size), boxes(rng, few, 0.3)
    touch = (one[0][:, :, None] <= two[1][:, None]) & (two[0][:, None] <= one[1][:, :, None])
    found = list(zip(*(side.tolist() for side in overlapping_boxes(*one, *two)), strict=True))
    assert sorted(found) == [tuple(pair) for pair in np.argwhere(touch.all(axis=0)).tolist()]
    assert len(set(found)) == len(found)


def test_boxes_that_begin_at_one_place_are_found_once():
    low, high = np.zeros((3, 4)), np.ones((3, 4))
    i, j = overlapping_boxes(low, high, low, high)
    assert sorted(zip(i.tolist(), j.tolist(), strict=True)) == [(a, b) for a in range(4) for b in range(4)]


@pytest.mark.parametrize(
    ("count", "size"), [(800, 0.15), (500, np.array([[0.9], [0.01], [0.01]])), (300, 0.0), (120, np.inf), (0, 1.0)]
)
@pytest.mark.parametrize("steps", [10.0, 1e6])
def test_pairs_are_those_of_all_pairs_in_crowds_and_long_boxes_too(count, size, steps):
    """Strips, intervals that begin at one place, boxes without end: what is found is what all pairs say."""
    rng = np.random.default_rng(count)
    low = np.round(rng.uniform(0.0, 1.0, (3, count)) * steps) / steps
    high = low + size * np.round(rng.uniform(0.1, 1.0, (3, count)) * steps) / steps
    touch = ((low[:, :, None] <= high[:, None]) & (low[:, None] <= high[:, :, None])).all(axis=0)
    found = list(zip(*(side.tolist() for side in overlapping_pairs(low, high)), strict=True))
    assert sorted(found) == [(i, j) for i, j in np.argwhere(touch).tolist() if i < j]
    i, j = overlapping_boxes(low, high, low, high)
    assert sorted(zip(i.tolist(), j.tolist(), strict=True)) == [tuple(pair) for pair in np.argwhere(touch).tolist()]


def test_empty_boxes_overlap_nothing():
    rng = np.random.default_rng(9)
    low = np.round(rng.uniform(0.0, 1.0, (3, 800)), 3)
    high = low + 0.05
    low[:, 5::100], high[:, 5::100] = np.inf, -np.inf
    touch = ((low[:, :, None] <= high[:, None]) & (low[:, None] <= high[:, :, None])).all(axis=0)
    found = list(zip(*(side.tolist() for side in overlapping_pairs(low, high)), strict=True))
    assert sorted(found) == [(i, j) for i, j in np.argwhere(touch).tolist() if i < j]
