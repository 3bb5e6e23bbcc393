import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import average_normals, mesh_of_grid, triangulate_surface
from vectorplot.surfaces.quadrics import Sphere


def torus_grid(columns, rows, a=3.0, b=1.0):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, columns + 1), np.linspace(0, 2 * np.pi, rows + 1), indexing="ij")
    r = a + b * np.cos(v)
    normal = np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=-1)
    return np.stack([r * np.cos(u), r * np.sin(u), b * np.sin(v)], axis=-1), normal


def sphere_grid(columns, rows):
    u = np.linspace(0, 2 * np.pi, columns + 1)
    v = np.linspace(-np.pi / 2, np.pi / 2, rows + 1)
    u, v = np.meshgrid(u, v, indexing="ij")
    return np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=-1)


@pytest.mark.capability("G8.4-normals")
def test_average_normals_of_a_torus_are_within_h_squared_also_on_the_seams():
    errors = []
    for n in (20, 40, 80):
        grid, true = torus_grid(2 * n, n)
        found = average_normals(grid, closed_u=True, closed_v=True)
        errors.append(np.linalg.norm(found - true, axis=2).max())
        assert np.allclose(found[0], found[-1], atol=1e-12) and np.allclose(found[:, 0], found[:, -1], atol=1e-12)
    assert errors[0] < 0.02
    assert errors[0] / errors[1] > 3.5 and errors[1] / errors[2] > 3.5


@pytest.mark.capability("G8.4-normals")
def test_average_normals_of_a_sphere_are_within_h_squared_at_the_poles_too():
    inner, poles = [], []
    for n in (16, 32, 64):
        grid = sphere_grid(2 * n, n)
        error = np.linalg.norm(average_normals(grid, closed_u=True) - grid, axis=2)
        inner.append(error[:, 1:-1].max())
        poles.append(error[:, [0, -1]].max())
    assert inner[0] / inner[1] > 3.0 and inner[1] / inner[2] > 3.0
    # At a pole only the triangles of one meridian strip are left: half a step off, no zero vector, no spike.
    assert poles[2] < 0.05


@pytest.mark.capability("G8.4-normals")
def test_average_normal_of_a_plane_looks_to_the_side_of_x_u_cross_x_v():
    u, v = np.meshgrid(np.arange(4.0), np.arange(3.0), indexing="ij")
    assert np.array_equal(average_normals(np.stack([u, v, 0 * u], axis=-1))[..., 2], np.ones((4, 3)))


def test_repeated_points_and_holes_leave_no_nan():
    grid = np.zeros((3, 3, 3))
    grid[1, 1] = np.nan
    assert np.array_equal(average_normals(grid), np.zeros((3, 3, 3)))


@pytest.mark.capability("G8.4-triangulate")
def test_triangulation_has_two_triangles_a_cell_and_covers_each_cell_once():
    grid, _ = torus_grid(12, 8)
    triangles, normals = triangulate_surface(grid, closed_u=True, closed_v=True)
    assert triangles.shape == (2 * 12 * 8, 3) and normals.shape == grid.shape
    i, j = triangles // 9, triangles % 9
    area = (i[:, 1] - i[:, 0]) * (j[:, 2] - j[:, 0]) - (j[:, 1] - j[:, 0]) * (i[:, 2] - i[:, 0])
    assert (area == 1).all()
    cells, count = np.unique(i.min(axis=1) * 9 + j.min(axis=1), return_counts=True)
    assert len(cells) == 96 and (count == 2).all()


@pytest.mark.capability("G8.4-triangulate", "G8.4-zero-manifold")
def test_the_diagonal_follows_the_fold():
    # A roof whose ridge runs along the diagonals i + j = const: cutting across the ridge would chip it.
    i, j = np.meshgrid(np.arange(6.0), np.arange(6.0), indexing="ij")
    for fold, other in ((i + j, False), (i - j + 5.0, True)):
        grid = np.stack([i, j, -((fold - 5.0) ** 2)], axis=-1)
        triangles, _ = triangulate_surface(grid)
        a, c = triangles.min(axis=1), triangles.max(axis=1)
        along_main = (c - a == 7) & (np.sort(triangles, axis=1)[:, 1] - a != 0)
        assert along_main.all() == other or not along_main.any()
        ridge = np.sort(triangles, axis=1)
        spans = {tuple(sorted(pair)) for t in ridge for pair in ((t[0], t[1]), (t[1], t[2]), (t[0], t[2]))}
        diagonals = {(q - p) for p, q in spans if q - p not in (1, 6)}
        assert diagonals == ({7} if other else {5})


@pytest.mark.parametrize("shape", [(3, 3), (1, 3, 3), (3, 3, 2)])
def test_a_grid_needs_points_both_ways(shape):
    with pytest.raises(InputError, match="grid of points"):
        average_normals(np.zeros(shape))


@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_poles_are_one_vertex_and_close_the_mesh(scale, shift):
    u, v = np.meshgrid(*Sphere().domain.grid(36, 18), indexing="ij")
    points = scale * Sphere().points(u, v) + shift
    ball, turned = mesh_of_grid(points, closed_u=True), mesh_of_grid(points.transpose(1, 0, 2), closed_v=True)
    for mesh in (ball, turned):
        assert mesh.is_closed and len(mesh.vertices) == 36 * 17 + 2 and mesh.face_count == 2 * 36 * 17


def test_a_grid_with_a_row_that_is_not_finite_has_the_other_rows():
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0), indexing="ij")
    points = np.stack([x, y, np.zeros_like(x)], axis=2)
    points[0] = np.nan
    assert mesh_of_grid(points).face_count == 8
