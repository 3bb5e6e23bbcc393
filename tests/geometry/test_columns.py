"""Vectors component by component: which columns say the same as an earlier one."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry import component_arrays as columns


@pytest.mark.parametrize("count", [0, 1, 7, 500])
def test_of_equal_columns_the_first_stays(count):
    rng = np.random.default_rng(count)
    some = rng.integers(-2, 2, (4, count)).astype(float)
    some[some == 0.0] *= rng.choice([-1.0, 1.0], int((some == 0.0).sum()))
    seen, first = set(), []
    for column in (some + 0.0).T.tolist():
        first.append(tuple(column) not in seen)
        seen.add(tuple(column))
    assert columns.first_of_equal(some).tolist() == first


def test_columns_that_share_a_key_are_told_apart(monkeypatch):
    monkeypatch.setattr(columns, "_MIX", (np.uint64(0), np.uint64(0)))
    some = np.array([[1.0, 2.0, 1.0, 3.0, 2.0], [0.0, 0.0, 0.0, 0.0, 1.0]])
    assert columns.first_of_equal(some).tolist() == [True, True, False, True, True]
