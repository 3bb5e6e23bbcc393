"""Where points lie in the triangles of a mesh."""

import numpy as np

from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.surfaces.quadrics import Sphere


def test_points_of_triangles_are_found_in_them_now_and_later():
    u, v = np.meshgrid(*Sphere().domain.grid(24, 12), indexing="ij")
    mesh = mesh_of_grid(Sphere().points(u, v), closed_u=True)
    random = np.random.default_rng(3)
    weights = random.dirichlet(np.ones(3), 200)
    faces = random.integers(mesh.face_count, size=200)
    fan = mesh.offsets[faces]
    corners = mesh.corners[np.stack([fan, fan + 1, fan + 2], axis=1)]
    points = np.einsum("kc,kcx->kx", weights, mesh.vertices[corners])
    triangles = PlacedTriangles(mesh)
    for batch in (points[:50], points):
        found = triangles.places(batch)
        on = np.einsum("kc,kcx->kx", found.weights, mesh.vertices[found.corners])
        assert found.point.tolist() == list(range(len(batch)))
        assert np.allclose(on, batch, rtol=0.0, atol=1e-9)
        assert np.array_equal(found.face, faces[: len(batch)])
    assert not len(triangles.places(points + 5.0).point)
