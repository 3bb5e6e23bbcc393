"""Sums and comparisons of components are those of numpy, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.vectors import (
    all_components,
    all_finite,
    any_component,
    component_sum,
    greatest_component,
    least_component,
)

SHAPES = ((3,), (0, 3), (40, 2), (40, 3), (5, 7, 3), (4, 7), (6, 1))


@pytest.mark.parametrize("shape", SHAPES)
def test_reductions_are_numpys_own(shape: tuple[int, ...]) -> None:
    values = np.random.default_rng(len(shape)).normal(size=shape)
    values.ravel()[::11] = np.nan
    assert np.array_equal(component_sum(values), values.sum(axis=-1), equal_nan=True)
    assert np.array_equal(least_component(values), values.min(axis=-1), equal_nan=True)
    assert np.array_equal(greatest_component(values), values.max(axis=-1), equal_nan=True)
    assert np.array_equal(all_components(values > 0.0), (values > 0.0).all(axis=-1))
    assert np.array_equal(any_component(values > 1.0), (values > 1.0).any(axis=-1))
    assert np.array_equal(all_finite(values), np.isfinite(values).all(axis=-1))


def test_axes_keep_their_order() -> None:
    corners = np.arange(24.0).reshape(2, 3, 4)
    assert greatest_component(corners.swapaxes(1, 2)).tolist() == corners.max(axis=1).tolist()
