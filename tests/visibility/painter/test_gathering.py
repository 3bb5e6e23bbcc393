from __future__ import annotations

import numpy as np
import pytest

from vectorplot.arrays import Ints
from vectorplot.visibility.painter.image_faces import ImageFaces, polygons_of
from vectorplot.visibility.painter.painters_order import side_by_side


def squares(places) -> ImageFaces:
    """Squares of side 2 in the image, back to front."""
    corners = np.array([(0, 0), (2, 0), (2, 2), (0, 2)], dtype=np.float64)
    flat = (np.array(places, dtype=np.float64)[:, None] + corners).reshape(-1, 2)
    points = np.concatenate([flat.T, np.zeros((1, len(flat)))])
    return polygons_of(points, np.arange(0, len(flat) + 1, 4), np.arange(len(places)), 1e-9)


def runs(item: Ints) -> int:
    """How many runs of transparent polygons of one plane there are."""
    return int(((item >= 0) & (np.append(-2, item[:-1]) != item)).sum())


def test_planes_side_by_side_keep_the_order_of_what_overlaps():
    for seed in range(40):
        random = np.random.default_rng(seed)
        places = random.uniform(0.0, 12.0, (60, 2))
        faces = squares(places)
        plane = random.integers(-1, 12, 60)
        order = side_by_side(faces, plane, 1e-9)
        assert sorted(order) == list(range(60))
        place = np.argsort(order)
        over = (np.abs(places[:, None] - places) < 2.0 - 1e-9).all(axis=2)
        first, second = np.nonzero(np.triu(over, 1))
        assert (place[first] < place[second]).all(), seed
        assert runs(plane[order]) <= runs(plane)


@pytest.mark.hard(74)
def test_planes_whose_polygons_do_not_overlap_stand_together_whatever_lies_on_them():
    # Three sheets, one above the other, each of a row of squares that come in turn.
    row = [(2.0 * k, 0.0) for k in range(10)]
    faces = squares([place for place in row for _ in range(3)])
    plane = np.tile(np.arange(3), 10)
    assert runs(plane[side_by_side(faces, plane, 1e-9)]) == 3
