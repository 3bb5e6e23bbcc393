"""Hulls by slabs and balls: whatever touches is near, and what is far apart along any way is not."""

import numpy as np
import pytest

from vectorplot.geometry.boxes import DIRECTIONS, SlabHulls


def hulls_of(sets):
    return SlabHulls.of(np.concatenate(sets), np.array([len(points) for points in sets]))


def rods(across, gap):
    """Two long rods of points side by side, a gap apart along the unit vector across."""
    along = np.cross(across, np.eye(3)[np.argmin(np.abs(across))])
    along = along / np.linalg.norm(along)
    t = np.linspace(-5.0, 5.0, 50)
    sides = (0.1 * np.cos(9 * t), across), (0.1 * np.sin(9 * t), np.cross(along, across))
    rod = sum((np.outer(x, way) for x, way in sides), np.outer(t, along))
    return rod, rod + (0.2 + gap) * np.asarray(across)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_sets_that_have_a_point_in_common_are_near(size):
    rng = np.random.default_rng(1)
    sets = [size * rng.normal(size=(20, 3)) * rng.uniform(0.01, 3.0, 3) for _ in range(40)]
    for k in range(1, 40):
        sets[k][0] = sets[k - 1][rng.integers(20)]
    i, j = hulls_of(sets).near(hulls_of(sets))
    found = set(zip(i.tolist(), j.tolist(), strict=True))
    assert {(k, k + 1) for k in range(39)} <= found
    assert all((b, a) in found for a, b in found)


def test_balls_on_a_lattice_that_boxes_do_not_separate_are_not_near():
    way = np.random.default_rng(2).normal(size=(500, 3))
    ball = way / np.linalg.norm(way, axis=1, keepdims=True)
    step = np.array([1.3, 1.3, 1.3])
    i, j = hulls_of([ball, ball + step]).near(hulls_of([ball, ball + step]))
    assert sorted(zip(i.tolist(), j.tolist(), strict=True)) == [(0, 0), (1, 1)]


@pytest.mark.parametrize("direction", DIRECTIONS[3:].tolist())
def test_slanted_rods_are_separated_across_every_direction(direction):
    first, second = rods(direction, 0.05)
    assert len(hulls_of([first]).near(hulls_of([second]))[0]) == 0


def test_widened_hulls_reach_as_far_as_they_say():
    first, second = rods((0.0, 1.0, 0.0), 1.0)
    for by, near in ((0.45, False), (0.55, True)):
        wide = hulls_of([first]).widened(np.array([by])), hulls_of([second]).widened(np.array([by]))
        assert (len(wide[0].near(wide[1])[0]) > 0) == near
