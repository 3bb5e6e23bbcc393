"""Where meshes on the page end."""

from __future__ import annotations

import numpy as np

from vectorplot.backends.page import border_sides, outer_sides

LARGE = np.array([(0, 0), (90_000, 0), (0, 90_000)])
SMALL = np.array([(10_000, 10_000), (20_000, 10_000), (10_000, 20_000)])


def outer(*triangles: np.ndarray) -> int:
    corners = np.concatenate(triangles).astype(np.int64)
    return len(outer_sides(corners, border_sides(corners)))


def test_a_fold_before_the_same_mesh_is_no_outer_side():
    assert outer(LARGE, SMALL) == 3
    assert outer(LARGE, SMALL + 200_000) == 6


def test_a_side_that_sticks_out_is_an_outer_side():
    """Two sides of the small triangle lie partly over the large one."""
    assert outer(LARGE, SMALL - (15_000, 0)) == 6
