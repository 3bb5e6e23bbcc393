"""Nets of polyhedra: faces keep their shapes, nothing overlaps, and what is folded up again is the body."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.geometry import box, hull_mesh, polygons_of, prism, revolution
from vectorplot.geometry.nets import MOST_FACES, net_of

GOLDEN = (1 + 5**0.5) / 2
CORNERS = [
    *product((-1, 1), repeat=3),
    *(np.roll((0, a / GOLDEN, b * GOLDEN), k) for a, b in product((-1, 1), repeat=2) for k in range(3)),
]
DODECAHEDRON = hull_mesh(np.array(CORNERS, dtype=float))
L_SHAPE = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]


def assert_is_net(mesh, net, pieces=1):
    """Every face is congruent with that of the mesh, joined edges coincide, no two faces of a piece overlap, and folded
    back the corners are where they were."""
    own, corners = net.mesh, net.corners
    size = float(np.ptp(mesh.vertices, axis=0).max())
    assert int(net.piece.max()) + 1 == pieces
    for step in (own.next_corner, own.next_corner[own.next_corner]):
        lengths = np.linalg.norm(own.vertices[own.corners[step]] - own.vertices[own.corners], axis=1)
        assert np.linalg.norm(corners[step] - corners, axis=1) == pytest.approx(lengths, abs=1e-9 * size)
    one, two = net.first[net.joined], net.second[net.joined]
    assert corners[one] == pytest.approx(corners[own.next_corner[two]], abs=1e-9 * size)
    face = own.corner_face
    cosine, sine = net.turns[face].T
    x, y = (corners - net.shifts[face]).T
    back = (cosine * x + sine * y)[:, None] * net.frames[face, 0] + (cosine * y - sine * x)[:, None] * net.frames[
        face, 1
    ]
    assert back + net.origins[face] == pytest.approx(own.vertices[own.corners], abs=1e-9 * size)
    areas = polygons_of(corners.T, own.offsets)
    assert (shapely.area(areas) > 0).all()
    for piece in range(pieces):
        some = areas[net.piece == piece]
        assert shapely.union_all(some, grid_size=1e-9 * size).area == pytest.approx(shapely.area(some).sum(), rel=1e-7)
    assert shapely.area(areas).sum() == pytest.approx(np.linalg.norm(mesh.area_vectors, axis=1).sum() / 2)


def test_a_cube_becomes_a_cross():
    net = net_of(box((1, 1, 1)))
    assert_is_net(box((1, 1, 1)), net)
    assert (int(net.joined.sum()), int((~net.joined).sum())) == (5, 7)
    low, high = net.corners.min(axis=0), net.corners.max(axis=0)
    assert sorted((high - low).round(9).tolist()) == [3.0, 4.0]
    assert net.angle == pytest.approx(np.pi / 2)


@pytest.mark.parametrize(
    "mesh",
    [
        DODECAHEDRON,
        prism(L_SHAPE, (0, 0, 1)),
        revolution([(2, 0, 0), (1, 0, 1), (2, 0, 2)], order=8),
        revolution([(1, 0, 0), (0, 0, 2)], order=24),
        vp.Mesh.from_polygons(
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4)]
        ),
    ],
)
@pytest.mark.slow
def test_bodies_have_nets_in_one_piece(mesh):
    assert_is_net(mesh, net_of(mesh))


@given(st.integers(0, 10_000))
@pytest.mark.slow
def test_convex_hulls_have_nets_in_one_piece(seed):
    mesh = hull_mesh(np.random.default_rng(seed).normal(size=(14, 3)))
    assert_is_net(mesh, net_of(mesh))


@pytest.mark.slow
def test_a_cylinder_unrolls_whole_with_its_ends_at_it():
    net = net_of(revolution([(1, 0, 0), (1, 0, 2)], order=48))
    flat = np.abs(net.angle) < 0.5
    assert int((~net.joined[flat]).sum()) == 1
    width = 96 * np.sin(np.pi / 48)
    mantle = net.corners[(net.mesh.face_sizes == 4)[net.mesh.corner_face]]
    hull = shapely.convex_hull(shapely.MultiPoint(mantle))
    assert (hull.area, hull.length) == pytest.approx((2 * width, 2 * (2 + width)))


def test_cuts_inside_of_what_is_nearly_developable_are_closed_within_a_tolerance():
    u, v = np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5), indexing="ij")
    points = np.stack([u, v, 0.2 * u**2 + 1e-4 * v**2 * u], axis=-1).reshape(-1, 3)
    cells = [(i * 5 + j, (i + 1) * 5 + j, (i + 1) * 5 + j + 1, i * 5 + j + 1) for i in range(8) for j in range(4)]
    triangles = [t for a, b, c, d in cells for t in ((a, b, c), (a, c, d))]
    exact, near = (net_of(vp.Mesh.from_triangles(points, triangles), tolerance) for tolerance in (0.0, 1e-3))
    assert not exact.joined.all() and exact.gap < 1e-8
    assert near.joined.all() and 1e-6 < near.gap < 1e-3


def test_faces_that_are_not_convex_or_not_planar_or_not_there_are_no_trouble():
    bent = vp.Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0.3), (0, 1, 0)], [(0, 1, 2, 3)])
    assert net_of(bent).mesh.face_count == 2
    assert net_of(box((1, 1, 1), caps=())).mesh.face_count == 4


def test_two_bodies_are_two_pieces_and_too_many_faces_are_told():
    one = box((1, 1, 1))
    both = vp.Mesh(
        np.concatenate([one.vertices, one.vertices + 5]),
        np.concatenate([one.corners, one.corners + 8]),
        np.arange(0, 49, 4),
    )
    assert_is_net(both, net_of(both), pieces=2)
    with pytest.raises(vp.InputError, match="without faces"):
        net_of(vp.Mesh(np.zeros((0, 3)), np.zeros(0, dtype=int), np.zeros(1, dtype=int)))
    triangles = np.tile([(0, 1, 2)], (MOST_FACES + 1, 1))
    with pytest.raises(vp.InputError, match="a net has 50000 at most"):
        net_of(vp.Mesh.from_triangles(np.eye(3), triangles))


def test_what_overlaps_by_more_than_the_tolerance_is_found_however_long_the_faces_are_around():
    at = np.random.default_rng(50).normal(size=(60, 3))
    net = net_of(hull_mesh(100.0 * at / np.linalg.norm(at, axis=1, keepdims=True)), 0.02)
    areas = polygons_of(net.corners.T, net.mesh.offsets)
    assert net.piece.max() == 0
    assert shapely.area(areas).sum() - shapely.union_all(areas, grid_size=1e-6).area < 0.01
