"""Small flat polygons among shaded triangles are painted with these, in one mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vectorplot.backends.cairo import SMALL_MICRONS, in_meshes
from vectorplot.backends.page import Areas

TRIANGLE = [(0, 0), (400, 0), (0, 400)]
QUAD = [(0, 0), (500, 0), (500, 500), (0, 500)]
DART = [(0, 0), (500, 0), (120, 120), (0, 500)]
IN_A_LINE = [(0, 0), (250, 0), (500, 0), (500, 500), (0, 500)]
LARGE = [(0, 0), (2 * SMALL_MICRONS, 0), (2 * SMALL_MICRONS, 500), (0, 500)]


def areas(*polygons: list[tuple[int, int]], items: tuple[int, ...] = (), opacity: float = 1.0) -> Areas:
    """The first and the last one shaded, the others flat."""
    sizes, count = [len(polygon) for polygon in polygons], len(polygons)
    flat = np.repeat(np.arange(count), sizes)
    colours = np.repeat(40 * flat[:, None], 3, axis=1).astype(np.uint8)
    colours[[0, -1]] += 90
    none = np.full(count, -1)
    return Areas(
        np.concatenate(polygons),
        np.cumsum([0, *sizes]),
        colours,
        np.full(count, opacity),
        np.full(count, opacity < 1.0),
        none,
        none,
        np.zeros(count, dtype=bool),
        np.array(items or [0] * count),
        np.array(items or [0] * count),
    )


def test_a_row_of_triangles_and_small_polygons_is_one_mesh_that_covers_the_same() -> None:
    before = areas(TRIANGLE, QUAD, TRIANGLE, QUAD, TRIANGLE)
    after = in_meshes(before)
    assert before.runs.tolist() == [0, 1, 2, 3, 4, 5]
    assert after.runs.tolist() == [0, 7] and after.meshed.all() and (after.sizes == 3).all()
    assert after.microns[3:9].tolist() == [[0, 0], [500, 0], [500, 500], [0, 0], [500, 500], [0, 500]]
    assert (after.colours[3:9] == before.colours[3]).all()


@pytest.mark.parametrize("polygon", [DART, IN_A_LINE, LARGE])
def test_polygons_that_are_large_or_no_fans_stay(polygon: list[tuple[int, int]]) -> None:
    before = areas(TRIANGLE, polygon, TRIANGLE)
    assert in_meshes(before) is before
    assert in_meshes(areas(TRIANGLE, QUAD, polygon, TRIANGLE)).sizes.tolist() == [3, 3, 3, len(polygon), 3]


def test_polygons_of_other_items_transparent_ones_and_those_without_shaded_neighbours_stay() -> None:
    for before in (
        areas(TRIANGLE, QUAD, TRIANGLE, items=(0, 1, 0)),
        areas(TRIANGLE, QUAD, TRIANGLE, opacity=0.5),
        replace(areas(TRIANGLE, QUAD), colours=np.zeros((7, 3), np.uint8)),
    ):
        assert in_meshes(before) is before
