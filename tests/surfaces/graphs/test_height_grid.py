"""Grids of heights from scattered points, and with extra points."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.surfaces.graphs import densified_grid, grid_of_scattered
from vectorplot.surfaces.tori import Torus


def hills(x, y):
    return np.sin(2 * x) * np.cos(3 * y)


def scattered(count, seed=1):
    xy = np.concatenate(
        [np.random.default_rng(seed).uniform(-1, 1, size=(count, 2)), [[-1, -1], [1, -1], [1, 1], [-1, 1]]]
    )
    return np.column_stack([xy, hills(*xy.T)])


@pytest.mark.slow
@pytest.mark.capability("G9.3-polygonize")
def test_heights_of_scattered_points_converge():
    errors = []
    for count in (60, 1600):
        grid = grid_of_scattered(scattered(count), 20, 10)
        assert grid.shape == (21, 11, 3)
        errors.append(np.abs(grid[2:-2, 2:-2, 2] - hills(grid[..., 0], grid[..., 1])[2:-2, 2:-2]).max())
    assert errors[1] < 0.1 * errors[0] and errors[1] < 0.01


@pytest.mark.capability("G9.3-polygonize")
def test_the_surface_passes_through_the_points():
    x, y = np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 2, 4), indexing="ij")
    points = np.stack([x, y, hills(x, y)], axis=-1)
    order = np.random.default_rng(2).permutation(20)
    assert np.allclose(grid_of_scattered(points.reshape(-1, 3)[order], 4, 3), points, atol=1e-12)
    far = grid_of_scattered(points.reshape(-1, 3) * 1e6 + 1e9, 4, 3)
    assert np.allclose((far - 1e9) / 1e6, points, atol=1e-8)


@pytest.mark.capability("G9.3-polygonize")
def test_outside_the_hull_are_holes_and_the_mesh_leaves_them_out():
    grid = grid_of_scattered([(0, 0, 0), (1, 0, 1), (0, 1, 1)], 4, 4)
    assert np.isnan(grid[4, 4, 2])
    mesh = mesh_of_grid(grid)
    assert mesh.face_count == 16 and (mesh.face_normals[:, 2] > 0).all()
    assert abs(mesh.area_vectors[:, 2].sum() - 1.0) < 1e-12


@pytest.mark.capability("G9.3-polygonize")
def test_extra_points_lie_on_splines_and_the_given_ones_stay():
    x, y = np.meshgrid(np.linspace(0, 1, 12), np.linspace(0, 1, 9), indexing="ij")
    grid = np.stack([x, y, hills(x, y)], axis=-1)
    denser = densified_grid(grid, 4)
    assert denser.shape == (45, 33, 3) and np.array_equal(denser[::4, ::4], grid)
    assert np.abs(denser[..., 2] - hills(denser[..., 0], denser[..., 1])).max() < 0.01
    flat = densified_grid(np.stack([x, y, 2 * x - y], axis=-1)[:2, :2], 3)
    assert np.allclose(flat[..., 2], 2 * flat[..., 0] - flat[..., 1])


@pytest.mark.capability("G9.3-polygonize")
def test_closed_grids_become_closed_meshes():
    torus = Torus(3, 1)
    u, v = np.meshgrid(*torus.domain.grid(12, 8), indexing="ij")
    mesh = mesh_of_grid(torus.points(u, v), closed_u=True, closed_v=True)
    assert len(mesh.vertices) == 96 and mesh.face_count == 192 and is_closed_oriented(mesh)


@pytest.mark.hard(68)
def test_wrong_input_is_named():
    good = scattered(5)
    for call in (
        lambda: grid_of_scattered(good[:2], 2, 2),
        lambda: grid_of_scattered([(0, 0, 0), (1, 1, 0), (2, 2, 0)], 2, 2),
        lambda: grid_of_scattered([(0, 0, 0), (0, 1, 0), (0, 2, 0)], 2, 2),
        lambda: grid_of_scattered(good * np.nan, 2, 2),
        lambda: grid_of_scattered(good, 0, 2),
        lambda: grid_of_scattered(good, 10**6, 10**6),
        lambda: densified_grid(np.zeros((3, 3, 3)), 10**9),
        lambda: densified_grid(np.zeros((3, 3)), 2),
    ):
        with pytest.raises(InputError):
            call()
