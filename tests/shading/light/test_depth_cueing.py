from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.shading.illumination import LEAST, MIDDLE, depth_shades, edge_shades, shade_numbers


@pytest.mark.capability("G4.4-depthcue")
def test_the_nearest_vertex_has_the_top_shade_and_the_farthest_a_fifth():
    assert depth_shades([-3.0, 5.0], -3.0, 5.0).tolist() == [LEAST, 1.0]
    assert shade_numbers(depth_shades([-3.0, 5.0], -3.0, 5.0), 32).tolist() == [6, 31]
    assert depth_shades([-90.0, 90.0], -3.0, 5.0).tolist() == [LEAST, 1.0]


@pytest.mark.capability("G4.4-depthcue")
@given(st.floats(-10, 10), st.floats(-10, 10))
def test_an_edge_has_the_mean_shade_of_its_ends(one, other):
    shade = edge_shades(one, other, -4.0, 6.0)
    exact = [LEAST + (1 - LEAST) * min(max((z + 4) / 10, 0), 1) for z in (one, other)]
    assert shade == pytest.approx(sum(exact) / 2, abs=1e-14)
    assert LEAST <= shade <= 1.0


@pytest.mark.capability("G4.4-depthcue")
def test_nearer_edges_are_never_darker():
    z = np.linspace(-5, 7, 100)
    assert (np.diff(edge_shades(z, z + 0.3, -4.0, 6.0)) >= 0).all()


def test_edges_without_depth_cueing_have_the_middle_shade():
    assert shade_numbers(MIDDLE, 32) == 16


def test_a_flat_scene_is_near():
    assert depth_shades([1.0, 2.0], 1.0, 1.0).tolist() == [1.0, 1.0]
