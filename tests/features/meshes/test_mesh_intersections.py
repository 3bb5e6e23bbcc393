import numpy as np
import pytest

from vectorplot.features.mesh_edge_lines import Faces
from vectorplot.features.mesh_intersections import Intersections, face_intersections
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.testing.shapes import box, bumpy_icosphere


def met(*meshes: Mesh) -> Intersections:
    """The intersections of several meshes, each a part."""
    first = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    corners = np.concatenate([m.corners + k for m, k in zip(meshes, first[:-1], strict=True)])
    sizes = np.concatenate([m.face_sizes for m in meshes])
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = np.concatenate([m.vertices for m in meshes]).T.copy()
    part = np.repeat(np.arange(len(meshes)), [m.face_count for m in meshes])
    none = np.zeros(len(sizes), dtype=np.int8)
    return face_intersections(Faces(points, corners, offsets, none[:0].astype(bool), none), part, 1e-9)


def length(found: Intersections) -> float:
    return float(np.sqrt(((found.end - found.start) ** 2).sum(axis=0)).sum())


@pytest.mark.hard(21)
def test_two_boxes_meet_in_a_closed_polygon() -> None:
    found = met(box((-1, -1, -1), (1, 1, 1)), box((0.5, -0.5, -0.5), (1.5, 0.5, 0.5)))
    assert np.isclose(length(found), 4.0)
    assert np.allclose(found.start[0], 1.0) and np.allclose(found.end[0], 1.0)


def test_two_spheres_meet_in_a_circle() -> None:
    sphere = bumpy_icosphere(4, bump=0.0)
    other = Mesh(sphere.vertices + np.array([0.7, 0.0, 0.0]), sphere.corners, sphere.offsets)
    found = met(sphere, other)
    assert np.isclose(length(found), 2.0 * np.pi * np.sqrt(1.0 - 0.35**2), rtol=2e-3)
    ends = np.round(np.concatenate([found.start, found.end], axis=1).T, 7)
    assert (np.unique(ends, axis=0, return_counts=True)[1] == 2).all()


def test_both_ends_lie_in_both_planes() -> None:
    random = np.random.default_rng(3)
    for _ in range(30):
        one, two = (Mesh.from_triangles(random.normal(size=(3, 3)), [[0, 1, 2]]) for _ in range(2))
        found = met(one, two)
        for mesh in (one, two):
            heights = (found.start.T - mesh.vertices[0]) @ mesh.face_normals[0]
            assert np.allclose(heights, 0.0, atol=1e-9)


def test_a_box_on_a_table_touches_along_its_base() -> None:
    found = met(box((-2, -2, -1), (2, 2, 0)), box((-1, -1, 0), (1, 1, 1)))
    assert np.isclose(length(found), 8.0)
    assert np.allclose(found.start[2], 0.0)


def test_apart_and_within_there_is_nothing() -> None:
    assert length(met(box((0, 0, 0), (1, 1, 1)), box((2, 0, 0), (3, 1, 1)))) == 0.0
    assert length(met(box((0, 0, 0), (3, 3, 3)), box((1, 1, 1), (2, 2, 2)))) == 0.0


def test_a_part_that_shares_all_its_points_with_another_is_met_too() -> None:
    big, small = box((-1, -1, -1), (1, 1, 1)), box((-0.25, -0.25, 0.5), (0.25, 0.25, 1.5))
    lid = int(np.argmax(big.face_normals[:, 2]))
    part = np.repeat([1, 2], [big.face_count, small.face_count])
    part[lid] = 0
    points = np.concatenate([big.vertices, small.vertices]).T.copy()
    corners = np.concatenate([big.corners, small.corners + len(big.vertices)])
    offsets = np.concatenate([big.offsets, small.offsets[1:] + big.offsets[-1]])
    none = np.zeros(len(part), dtype=np.int8)
    found = face_intersections(Faces(points, corners, offsets, none[:0].astype(bool), none), part, 1e-9)
    on_small = np.abs((found.start + found.end)[:2] / 2.0).max(axis=0) < 0.5
    assert np.isclose(np.linalg.norm((found.end - found.start)[:, on_small], axis=0).sum(), 2.0)


def test_the_order_of_parts_changes_nothing() -> None:
    one, two = box((-1, -1, -1), (1, 1, 1)), bumpy_icosphere(2)
    assert np.isclose(length(met(one, two)), length(met(two, one)))


@pytest.mark.slow
def test_long_thin_bars_meet_where_they_meet_two_by_two() -> None:
    rng = np.random.default_rng(4)
    bars = []
    centres, axes = rng.uniform(0.0, 1.0, (100, 3)), rng.normal(size=(100, 3))
    for centre, axis in zip(centres, axes, strict=True):
        bar = box((-0.01, -0.01, -0.6), (0.01, 0.01, 0.6))
        bars.append(Mesh(bar.vertices @ axis_frame(axis) + centre, bar.corners, bar.offsets))
    together = met(*bars)
    # Where the lines through their middles keep apart by more than bars are thick, there is nothing to meet.
    one, two = np.triu_indices(100, 1)
    normal = np.cross(axes[one], axes[two])
    away = np.abs(((centres[two] - centres[one]) * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)
    near = np.flatnonzero(away < 0.03)
    apart = [met(bars[i], bars[j]) for i, j in zip(one[near], two[near], strict=True)]
    assert len(together.one) == sum(len(pair.one) for pair in apart) > 100
    assert np.isclose(length(together), sum(map(length, apart)))


@pytest.mark.parametrize("plane", [(0, 1), (1, 2), (2, 0)])
@pytest.mark.parametrize("mirrored", [0, 1])
def test_segments_that_mirror_each_other_are_two(plane, mirrored):
    """Two walls cross on a floor: whatever axes mirror one line into the other, both are there, and none twice."""
    across, up = plane[mirrored], 3 - sum(plane)
    square = np.array([(-1.0, -1.0), (1.0, 1.0), (1.0, 1.0), (-1.0, -1.0)])
    one = np.zeros((4, 3))
    one[:, list(plane)], one[:, up] = square, (-1.0, -1.0, 2.0, 2.0)
    other, floor = one.copy(), np.zeros((4, 3))
    other[:, across] *= -1.0
    floor[:, list(plane)] = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    walls = [Mesh.from_polygons(corners, [[0, 1, 2, 3]]) for corners in (one, other, floor)]
    found = met(*walls)
    long = np.sqrt(((found.end - found.start) ** 2).sum(axis=0))
    assert np.allclose(np.sort(long), [8.0**0.5, 8.0**0.5, 3.0])
