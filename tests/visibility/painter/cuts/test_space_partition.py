"""Trees of planes: what they order, and where they stop."""

from __future__ import annotations

import numpy as np

from vectorplot.visibility.painter.face_splitting import partitioned
from vectorplot.visibility.painter.image_faces import polygons_of

COUNT = 60


def crossing_triangles():
    """Triangles anyhow in one place, most of which pierce most others."""
    points = np.random.default_rng(3).uniform(-1.0, 1.0, (3 * COUNT, 3)).T
    return polygons_of(points, np.arange(0, 3 * COUNT + 1, 3), np.arange(COUNT), 1e-9)


def test_all_is_in_order_where_there_are_pieces_enough():
    faces = crossing_triangles()
    found = partitioned(faces, np.zeros(len(faces), dtype=np.intp), 1e-9, 1 << 20)
    assert found.complete.all() and len(found.faces) > 10 * COUNT
    assert len(np.unique(found.rank)) == len(found.faces)


def test_work_ends_near_the_most_pieces_and_what_is_left_is_told():
    faces, most = crossing_triangles(), 4 * COUNT
    found = partitioned(faces, np.zeros(len(faces), dtype=np.intp), 1e-9, most)
    assert most < len(found.faces) <= 2 * most
    assert not found.complete.all()
    assert set(found.parent) == set(range(len(faces)))
