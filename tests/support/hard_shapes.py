"""The small scenes that are hard for one reason each, made once for all tests."""

from __future__ import annotations

from vectorplot.testing import hard_shapes

HARD_SHAPES = hard_shapes()
