"""Hulls against scipy, on lattices, of points on lines, and of many sets at once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from support.effort import several

from vectorplot.errors import InputError
from vectorplot.geometry.convex_polygons import convex_hull, convex_hulls, hull_mesh
from vectorplot.geometry.predicates import orient2d


@pytest.mark.slow
@pytest.mark.capability("G6.1-hull2d")
def test_hulls_of_random_points_are_those_of_scipy_in_one_call():
    random = np.random.default_rng(1)
    sizes = (int(random.integers(3, 60)) for _ in range(several(80, long=300)))
    sets = [random.normal(size=(size, 3)) * random.uniform(0.01, 9) for size in sizes]
    offsets = np.cumsum([0, *map(len, sets)])
    corner, ends = convex_hulls(np.concatenate(sets), offsets)
    for k, points in enumerate(sets):
        mine = corner[ends[k] : ends[k + 1]] - offsets[k]
        theirs = ConvexHull(points[:, :2]).vertices
        first = int(np.flatnonzero(theirs == mine[0])[0])
        assert np.roll(theirs, -first).tolist() == mine.tolist()
        assert mine.tolist() == convex_hull(points).tolist()


@pytest.mark.capability("G6.1-hull2d")
@given(st.lists(st.tuples(st.integers(-4, 4), st.integers(-4, 4)), min_size=1, max_size=40))
def test_hulls_of_lattice_points_with_twins_and_points_in_line(lattice):
    points = np.array(lattice, dtype=np.float64)
    hull = convex_hull(points)
    assert len(np.unique(points[hull], axis=0)) == len(hull)
    corner = points[hull]
    if len(hull) > 2:
        turn = orient2d(np.roll(corner, 1, axis=0), corner, np.roll(corner, -1, axis=0))
        assert (turn == 1).all(), "left turns only"
        side = orient2d(corner[:, None], np.roll(corner, -1, axis=0)[:, None], points[None])
        assert (side >= 0).all(), "all points inside"
        assert corner[0].tolist() == min(points.tolist())
    else:
        assert (orient2d(corner[0], corner[-1], points) == 0).all()
        assert {tuple(c) for c in corner} == {min(map(tuple, points)), max(map(tuple, points))}


def test_points_that_broke_the_printed_hull():
    assert sorted(convex_hull([(0, 0), (2, 0), (1, 1)]).tolist()) == [0, 1, 2]
    # The rightmost point first and the leftmost second; the leftmost last.
    assert sorted(convex_hull([(3, 0), (0, 0), (1, 1), (2, -1), (1, 0.5)]).tolist()) == [0, 1, 2, 3]
    assert sorted(convex_hull([(3, 0), (1, 1), (2, -1), (1, 0.5), (0, 0)]).tolist()) == [0, 1, 2, 4]


def test_far_from_the_origin_and_nearly_in_line():
    base = np.array([(0, 0), (1, 0), (2, 0), (2, 1), (0, 1), (1, 2.0**-20)], dtype=np.float64)
    assert convex_hull(base + 2.0**30).tolist() == [0, 2, 3, 4]
    assert len(convex_hull([(0, 0), (1, 1e-300), (2, 0), (1, 1)])) == 3
    assert len(convex_hull([(0, 0), (1, -1e-300), (2, 0), (1, 1)])) == 4


def test_no_points_one_point_and_wrong_points():
    assert convex_hull(np.zeros((0, 2))).tolist() == []
    assert convex_hull([(1, 2), (1, 2), (1, 2)]).tolist() == [0]
    corner, ends = convex_hulls(np.array([(0.0, 0), (1, 1), (1, 1), (5, 5)]), np.array([0, 0, 1, 1, 4, 4]))
    assert (corner.tolist(), ends.tolist()) == ([0, 1, 3], [0, 0, 1, 1, 3, 3])
    with pytest.raises(InputError, match="finite"):
        convex_hull([(0, 0), (np.nan, 1)])
    with pytest.raises(InputError, match="columns"):
        convex_hull([1.0, 2.0])


@pytest.mark.parametrize("seed", range(8))
def test_hulls_in_space(seed):
    random = np.random.default_rng(seed)
    points = random.normal(size=(40, 3)) * 10.0 ** (seed - 4) + (1e3 if seed == 4 else 0.0)
    mesh = hull_mesh(points)
    heights = np.einsum(
        "fk,fpk->fp", mesh.face_normals, points[None] - mesh.vertices[mesh.corners[mesh.offsets[:-1]]][:, None]
    )
    assert heights.max() <= 1e-9 * np.ptp(points)
    edges = len(mesh.corners) // 2
    assert len(mesh.vertices) - edges + mesh.face_count == 2
    scipy_hull = ConvexHull(points)
    assert len(mesh.vertices) == len(scipy_hull.vertices)
    volume = (mesh.area_vectors * mesh.vertices[mesh.corners[mesh.offsets[:-1]]]).sum()
    assert abs(volume) / 3.0 in (pytest.approx(scipy_hull.volume), pytest.approx(scipy_hull.volume * 2.0))


def test_the_hull_of_a_cube_has_six_squares():
    lattice = np.array([(x, y, z) for x in (0, 1, 2) for y in (0, 1, 2) for z in (0, 1, 2)], dtype=np.float64)
    corners = lattice[((lattice == 0) | (lattice == 2)).all(axis=1)]
    mesh = hull_mesh(corners)
    assert sorted(mesh.face_sizes.tolist()) == [4] * 6
    assert mesh.vertices.tolist() == corners.tolist()
    outwards = mesh.vertices[mesh.corners[mesh.offsets[:-1]]] - 1.0
    assert ((mesh.area_vectors * outwards).sum(axis=1) > 0).all()


def test_flat_points_have_no_hull_in_space():
    with pytest.raises(InputError, match="one plane"):
        hull_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0.3, 0.4, 0)])
    with pytest.raises(InputError, match="four points"):
        hull_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
