"""Nearest points of meshes, and the faces they are in."""

import numpy as np
import pytest

from vectorplot import Mesh
from vectorplot.errors import InputError
from vectorplot.features.nearest import nearest_on_mesh
from vectorplot.testing.shapes import box

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


def test_they_are_those_of_a_box_however_large_its_faces_are_next_to_others():
    rng = np.random.default_rng(3)
    tiny = CUBE.vertices * 1e-3 + (0.0, 0.0, 1.2)
    both = Mesh.from_polygons(
        np.concatenate([CUBE.vertices, tiny]), [*CUBE.polygons(), *([c + 8 for c in p] for p in CUBE.polygons())]
    )
    points = rng.uniform(-3.0, 3.0, (400, 3))
    points = points[(np.abs(points) > 1.0).any(axis=1)]
    found = nearest_on_mesh(both, points)
    feet = np.stack([np.clip(points, part.min(axis=0), part.max(axis=0)) for part in (CUBE.vertices, tiny)])
    expected = feet[np.linalg.norm(feet - points, axis=2).argmin(axis=0), np.arange(len(points))]
    assert np.abs(found.points - expected).max() < 1e-14
    assert np.abs(found.distances - np.linalg.norm(points - expected, axis=1)).max() < 1e-14
    inside = nearest_on_mesh(both, rng.uniform(-0.9, 0.9, (50, 3)))
    assert np.abs(np.abs(inside.points).max(axis=1) - 1.0).max() < 1e-15 and (inside.faces < 6).all()
    assert nearest_on_mesh(both, (0.0, 0.0, 1.3)).faces[0] >= 6


@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_on_edges_the_face_is_that_into_which_the_direction_leads(scale, offset):
    mesh = Mesh(CUBE.vertices * scale + offset, CUBE.corners, CUBE.offsets)
    edge, corner = ((np.array(p) * scale + offset) for p in ((1.0, -1.0, 0.3), (1.0, -1.0, 1.0)))
    for at, way, normal in (
        (edge, (-1.0, 0.0, 0.1), (0.0, -1.0, 0.0)),
        (edge, (0.0, 1.0, 0.1), (1.0, 0.0, 0.0)),
        (corner, (-1.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        (corner, (-1.0, 0.0, -1.0), (0.0, -1.0, 0.0)),
    ):
        found = nearest_on_mesh(mesh, at, way)
        assert np.array_equal(mesh.face_normals[found.faces[0]], normal)


def test_mistakes_about_them_are_told():
    with pytest.raises(InputError, match="points must be three finite numbers"):
        nearest_on_mesh(CUBE, (0.0, np.nan, 0.0))
    with pytest.raises(InputError, match="no faces"):
        nearest_on_mesh(Mesh.from_polygons(CUBE.vertices, []), (0.0, 0.0, 0.0))
