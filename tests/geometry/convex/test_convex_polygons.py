"""Plane polygons as unions of convex ones."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry.convex.convex_polygons import convex_polygon_parts, is_convex_polygon, signed_area


def test_a_polygon_with_a_hole():
    outer = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
    hole = np.array([[1.0, 1], [1, 3], [3, 3], [3, 1]])
    both = np.concatenate([outer, hole])
    parts = convex_polygon_parts(outer, [hole])
    assert sum(signed_area(both[part]) for part in parts) == pytest.approx(12)
    assert len(parts) <= 8 and all(is_convex_polygon(both[part]) for part in parts)


def test_a_polygon_that_crosses_itself_is_refused():
    with pytest.raises(InputError, match="crosses"):
        convex_polygon_parts([[0, 0], [2, 2], [2, 0], [0, 2], [-1, 1]])


@pytest.mark.parametrize("length", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("corners", [3, 5, 12])
def test_bores_in_long_bars_leave_convex_parts(length, corners):
    random = np.random.default_rng(corners)
    for _ in range(12):
        angles = np.arange(corners) * 2 * np.pi / corners + random.uniform(0, 6)
        middle = (random.uniform(1, length - 1), 0.5)
        hole = (middle + random.uniform(0.1, 0.45) * np.stack([np.cos(angles), np.sin(angles)], axis=1))[::-1]
        bar = np.array([(0.0, 0), (length, 0), (length, 1), (0, 1)])
        turned = random.uniform(0, 6)
        c, s = np.cos(turned), np.sin(turned)
        bar, hole = (np.stack([c * p[:, 0] - s * p[:, 1], s * p[:, 0] + c * p[:, 1]], axis=1) for p in (bar, hole))
        both = np.concatenate([bar, hole])
        parts = convex_polygon_parts(bar, [hole])
        area = length + signed_area(hole)
        assert sum(signed_area(both[part]) for part in parts) == pytest.approx(area, rel=1e-6)
        for part in parts:
            before, here, after = both[np.roll(part, 1)], both[part], both[np.roll(part, -1)]
            a, b = here - before, after - here
            longer = np.maximum(np.hypot(*a.T), np.hypot(*b.T))
            assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] >= -1.1e-9 * longer**2).all()
