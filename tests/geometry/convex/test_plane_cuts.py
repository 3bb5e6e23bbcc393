"""Convex polygons cut by planes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.arrays import Floats
from vectorplot.geometry.polygon_cuts import PlaneBundles, crossings_of, cut_by_planes, planes_of, polygon_areas

SQUARE = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 0.0]])
ONE = np.array([0, 4])
ZERO = np.zeros(1, dtype=np.intp)


def bundle(*planes: tuple[float, float, float, float]) -> PlaneBundles:
    return PlaneBundles(np.array(planes).reshape(-1, 4).T, np.array([0, len(planes)]))


def area(points: Floats, offsets: Floats) -> Floats:
    normal, _ = polygon_areas(points, offsets)
    return np.sqrt((normal * normal).sum(axis=0)) / 2.0


def test_planes_go_through_their_points() -> None:
    plane = planes_of(np.array([[0.0, 0.0], [0.0, 3.0], [2.0, 4.0]]), np.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]))
    assert np.allclose(plane, [[0, 0], [0, 0.6], [1, 0.8], [3, 3.6]])


def test_a_square_cut_twice_is_a_pentagon() -> None:
    s = np.sqrt(0.5)
    part = cut_by_planes(SQUARE, ONE, bundle((s, s, 0.0, 0.5 * s), (0.0, 0.0, 1.0, -1.0)), ZERO, ZERO, 1e-9)
    assert len(part) == 1 and not part.whole[0] and part.points.shape[1] == 5
    assert np.isclose(area(part.points, part.offsets)[0], 1.0 - 0.125)
    twice = cut_by_planes(SQUARE, ONE, bundle((s, s, 0, 0.5 * s), (-s, -s, 0, -1.5 * s)), ZERO, ZERO, 1e-9)
    assert twice.points.shape[1] == 6 and np.isclose(area(twice.points, twice.offsets)[0], 0.75)


def test_what_nothing_cuts_keeps_every_digit() -> None:
    part = cut_by_planes(SQUARE + 0.1, ONE, bundle((1.0, 0.0, 0.0, 0.1 - 1e-12)), ZERO, ZERO, 1e-9)
    assert part.whole[0] and np.array_equal(part.points, SQUARE + 0.1)


def test_no_planes_leave_all() -> None:
    assert cut_by_planes(SQUARE, ONE, bundle(), ZERO, ZERO, 1e-9).whole.tolist() == [True]


@pytest.mark.parametrize("plane", [(1.0, 0.0, 0.0, 1.0), (-1.0, 0.0, 0.0, 1e-10), (0.0, 0.0, 1.0, 0.0)])
def test_touching_leaves_nothing(plane: tuple[float, float, float, float]) -> None:
    assert len(cut_by_planes(SQUARE, ONE, bundle(plane), ZERO, ZERO, 1e-9)) == 0


def test_nothing_in_nothing_out() -> None:
    none = np.zeros(0, dtype=np.intp)
    assert len(cut_by_planes(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), bundle(), none, none, 1e-9)) == 0
    assert len(cut_by_planes(SQUARE, ONE, bundle((1.0, 0.0, 0.0, 0.0)), none, none, 1e-9)) == 0


@pytest.mark.slow
@given(st.integers(0, 10_000))
def test_parts_on_both_sides_add_up_and_lie_on_their_sides(seed: int) -> None:
    random = np.random.default_rng(seed)
    sizes = random.integers(3, 12, 6)
    angle = [np.sort(random.uniform(0.0, 2.0 * np.pi, n)) for n in sizes]
    frames = [np.linalg.qr(random.normal(size=(3, 2)))[0] for _ in sizes]
    points = np.concatenate([f @ [np.cos(a), np.sin(a)] for f, a in zip(frames, angle, strict=True)], axis=1)
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    planes = planes_of(random.normal(size=(3, 5)), 0.5 * random.normal(size=(3, 5)))
    polygon, plane = (x.ravel() for x in np.meshgrid(np.arange(6), np.arange(5)))
    total = np.zeros(len(polygon))
    for sign in (1.0, -1.0):
        bundles = PlaneBundles(sign * planes, np.arange(6))
        parts = cut_by_planes(points, offsets, bundles, polygon, plane, 1e-9)
        total[parts.pair] += area(parts.points, parts.offsets)
        mine = np.repeat(plane[parts.pair], np.diff(parts.offsets))
        height = sign * ((planes[:3, mine] * parts.points).sum(axis=0) - planes[3, mine])
        assert (height >= -2e-9).all()
    assert np.allclose(total, area(points, offsets)[polygon], atol=1e-7)


def test_crossings_name_only_planes_that_cut() -> None:
    planes = bundle((1.0, 0.0, 0.0, -1.0), (1.0, 0.0, 0.0, 0.5), (0.0, 1.0, 0.0, 0.25))
    found = crossings_of(SQUARE, ONE, planes, ZERO, ZERO, 1e-9)
    assert found.offsets.tolist() == [0, 2] and np.array_equal(found.planes[3], [0.5, 0.25])
