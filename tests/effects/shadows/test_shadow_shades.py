"""How dark shadows are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.effects.shadows.shadow_shades import LEVELS, shadow_shades
from vectorplot.shading.light.illumination import DIRECT_SHARE, shades

SHARES = st.lists(st.floats(0.0, 3.0), min_size=3, max_size=3)


@pytest.mark.capability("G6.3-shadow-shade")
def test_a_shadow_of_the_only_light_has_half_of_the_reduced_palette() -> None:
    share, cue = np.array([[0.2, 0.9, 1.0]]), np.array([0.0, 0.1, 0.2])
    assert np.allclose(shadow_shades(share, [1.0], [1, 1, 1], cue), 0.5 * DIRECT_SHARE * share[0] + cue)


@pytest.mark.capability("G6.3-shadow-shade")
@given(SHARES, SHARES)
def test_shades_fall_with_every_light_that_is_lacking_and_rise_with_depth(
    share: list[float], more: list[float]
) -> None:
    one = np.array(share)[:, None]
    lit = shades(one, [0.5, 0.7, 0.4])
    grades = [shadow_shades(one, [0.5, 0.7, 0.4], [mask])[0] for mask in (0, 1, 3, 7)]
    assert np.isclose(grades[0], lit[0]) and np.isclose(grades[3], 0.5 * lit[0])
    assert all(a >= b - 1e-12 for a, b in pairwise(grades))
    if min(share) > 1e-3:
        assert grades[0] > grades[1] > grades[2] > grades[3]
    soft = [shadow_shades(one, [0.5, 0.7, 0.4], [2], dimmed=[0], step=[k])[0] for k in range(1, LEVELS)]
    full = shadow_shades(one, [0.5, 0.7, 0.4], [2])[0]
    dark = shadow_shades(one, [0.5, 0.7, 0.4], [3])[0]
    steps = np.diff([full, *soft, dark])
    assert (steps <= 1e-12).all() and steps[1:-1].min() == pytest.approx(steps[1:-1].max(), abs=1e-12)
    assert steps.min() >= 1.01 * (dark - full) / (LEVELS - 1) - 1e-12
    brighter = shadow_shades(one + np.array(more)[:, None], [0.5, 0.7, 0.4], [7])[0]
    assert brighter >= grades[3] - 1e-12
    deeper = [shadow_shades(one, [0.5, 0.7, 0.4], [3], cue)[0] for cue in (0.0, 0.1, 0.2)]
    assert deeper[0] < deeper[1] < deeper[2]


def test_in_the_dark_nothing_is_lost() -> None:
    assert shadow_shades(np.zeros((2, 1)), [1.0, 1.0], [3], 0.1).tolist() == [0.1]
