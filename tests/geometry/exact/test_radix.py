"""Orders of whole numbers against numpy's."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.ragged import radix_order


@pytest.mark.parametrize("bits", [1, 15, 16, 17, 32, 48, 63, 64])
@pytest.mark.parametrize("count", [0, 1, 2, 3000])
def test_the_order_is_that_of_a_stable_sort(bits, count):
    keys = np.random.default_rng(bits).integers(0, 2**bits, count, dtype=np.uint64)
    keys = np.concatenate((keys, keys[::3], np.array([0, 2**bits - 1], dtype=np.uint64)))
    assert radix_order(keys, bits).tolist() == np.argsort(keys, kind="stable").tolist()
