"""Pixels of polygons by scan lines: values at every crossing, and vertices that say nothing new."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.geometry.clipping import Polygons
from vectorplot.shading.pixel_coverage import polygon_pixels

COLUMNS, ROWS = 60, 50


def pixels(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pixels of a polygon, and its further columns there."""
    parts = list(polygon_pixels(Polygons.of(corners), COLUMNS, ROWS))
    none = np.zeros(0, dtype=np.intp), np.zeros((0, corners.shape[1] - 2))
    return (
        np.concatenate([none[0], *(part.pixel for part in parts)]),
        np.concatenate([none[1], *(part.values for part in parts)]),
    )


def plane(corners: np.ndarray) -> np.ndarray:
    """(n, 4) the corners with a depth and a shade, both linear in the picture."""
    x, y = corners.T
    return np.column_stack([corners, 3.0 + 0.25 * x - 0.125 * y, 90.0 - x + 0.5 * y])


STAR = np.array([(np.cos(a), np.sin(a)) for a in 4.0 * np.pi * np.arange(5) / 5.0]) * 20.0 + (30.0, 25.0)
COMB = np.array([(2, 2), (58, 2), (58, 40), (50, 8), (40, 45), (30, 8), (20, 48), (10, 8), (2, 46)], dtype=float)


SHAPES = {"a star": STAR, "a comb": COMB, "it backwards": COMB[::-1], "it on its side": COMB @ [[0, 0.8], [1, 0]]}


@pytest.mark.parametrize("name", SHAPES)
def test_every_crossing_of_a_scan_line_has_depth_and_shade(name: str) -> None:
    """Erratum G4-10: also those beyond the first two of a line, which polygons that are not convex have."""
    pixel, values = pixels(plane(SHAPES[name]))
    row, column = np.divmod(pixel, COLUMNS)
    assert (np.diff(np.flatnonzero(np.diff(pixel) > 1)) > 0).any(), "some lines are entered more than once"
    there = plane(np.column_stack([column, row]).astype(float))[:, 2:]
    # Corners stand on the grid of 1/256 pixel.
    assert len(pixel) > 200 and np.abs(values - there).max() < 2.0 / 256.0


@settings(max_examples=examples(100))
@given(st.lists(st.tuples(st.integers(0, 59), st.integers(0, 49)), min_size=3, max_size=7), st.data())
def test_a_vertex_that_repeats_another_changes_nothing(corners: list[tuple[int, int]], data: st.DataObject) -> None:
    """Erratum G4-13: its predecessor, or at the end the first one."""
    polygon = plane(np.array(corners, dtype=float))
    twice = data.draw(st.integers(0, len(corners) - 1))
    repeated = np.insert(polygon, twice, polygon[twice], axis=0)
    for other in (repeated, np.concatenate([polygon, polygon[:1]]), np.concatenate([repeated, repeated[:1]])):
        for mine, theirs in zip(pixels(polygon), pixels(other), strict=True):
            assert np.array_equal(mine, theirs)
