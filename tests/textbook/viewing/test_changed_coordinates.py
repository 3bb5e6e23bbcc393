from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.textbook import changed_coordinates
from vectorplot.textbook.viewing import with_target_as_origin

EYE, TARGET = (10.0, 5.0, 7.0), (1.0, 2.0, -1.0)
BOOK = Camera(eye=EYE, target=TARGET, twist_deg=np.degrees(0.3))
WINDOW = PixelWindow(800, 600)
component = st.floats(-3, 3)
point3 = st.tuples(component, component, component).map(np.array)


def cloud(count=200, seed=7):
    return np.random.default_rng(seed).uniform(-3, 3, (count, 3))


@pytest.mark.capability("G2.4-switch")
@given(point3)
def test_direct_switch_equals_the_way_through_the_world(p):
    screen = CoordinateSystem.of_screen(BOOK, WINDOW)
    light = CoordinateSystem.of_light((4, -6, 9), TARGET)
    there = changed_coordinates(screen.from_world(p), screen, light)
    assert np.allclose(there, light.from_world(p), atol=1e-11)
    assert np.allclose(changed_coordinates(there, light, screen), screen.from_world(p), atol=1e-8)
    assert np.allclose(changed_coordinates(p, CoordinateSystem.world(), light), light.from_world(p), atol=1e-15)


@pytest.mark.capability("G2.4-switch")
def test_a_point_has_the_same_number_in_the_pools_of_all_systems():
    pool = cloud()
    systems = [CoordinateSystem.world(), CoordinateSystem.of_screen(BOOK, WINDOW)]
    systems += [CoordinateSystem.of_light(lamp, TARGET) for lamp in [(4, -6, 9), (-8, 3, 11)]]
    pools = [system.from_world(pool) for system in systems]
    for one, here in zip(systems, pools, strict=True):
        for other, there in zip(systems, pools, strict=True):
            # By number from pool to pool, or point by point by way of the world.
            assert np.allclose(changed_coordinates(here, one, other), there, rtol=0, atol=1e-8)
            assert np.allclose(changed_coordinates(here[7], one, other), there[7], rtol=0, atol=1e-8)


@pytest.mark.capability("G2.4-target-origin")
def test_scene_and_centres_move_so_that_the_target_is_the_origin():
    pool, centres = cloud(), np.array([EYE, (4, -6, 9)])
    moved_pool, moved_centres, target = with_target_as_origin(TARGET, pool, centres, TARGET)
    assert np.array_equal(target, np.zeros(3))
    before = CoordinateSystem.of_light(centres[1], TARGET).from_world(pool)
    assert np.allclose(CoordinateSystem.of_light(moved_centres[1]).from_world(moved_pool), before, atol=1e-12)
