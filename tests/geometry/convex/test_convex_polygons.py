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
