"""Unions of polyhedra: volumes and areas in closed form, points inside and outside, and what cannot be united."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.geometry import box, hull_mesh, polyhedron_union, prism, ragged, revolution, rotation_about
from vectorplot.geometry.vectors import solid_angles
from vectorplot.geometry.winding import edge_uses

L_SHAPE = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]


def volume(mesh):
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    return float((mesh.area_vectors * first).sum() / 6)


def area(mesh):
    return float(np.linalg.norm(mesh.area_vectors, axis=1).sum() / 2)


def windings(mesh, points):
    """How often a closed mesh winds around points: 1 inside, 0 outside."""
    triangles = mesh.vertices[mesh.corners[ragged.fans(mesh.offsets)[0]]]
    return [float(solid_angles(*(triangles[:, k] - p for k in range(3))).sum()) / (4 * np.pi) for p in points]


def inside(convex, points):
    first = convex.vertices[convex.corners[convex.offsets[:-1]]]
    return (((points[:, None] - first) * convex.face_normals).sum(axis=2) < 0).all(axis=1)


def turned(mesh):
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_about((1, 2, 3), 0.7)
    matrix[:3, 3] = 300, -200, 100
    return mesh.transformed(matrix)


def test_boxes_side_by_side_are_one_box_with_six_faces():
    body = polyhedron_union([box((1, 1, 1)).moved(x, y, 0) for x in range(3) for y in range(2)])
    assert (body.face_count, len(body.vertices), volume(body), area(body)) == (6, 8, 6.0, 22.0)
    assert edge_uses(body).agree.all()


@pytest.mark.parametrize("place", [lambda mesh: mesh, turned])
def test_voxels_are_bounded_where_one_has_no_neighbour(place):
    filled = np.random.default_rng(3).random((5, 5, 5)) < 0.55
    body = polyhedron_union([place(box((1, 1, 1)).moved(*cell)) for cell in np.argwhere(filled).tolist()])
    padded = np.pad(filled, 1).astype(int)
    faces = sum(int(np.abs(np.diff(padded, axis=axis)).sum()) for axis in range(3))
    assert body.is_closed
    assert area(body) == pytest.approx(faces, abs=1e-9)
    assert volume(body) == pytest.approx(filled.sum(), abs=1e-6)


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (box((1, 1, 1)), 8.0),
        (box((2, 2, 2)), 8.0),
        (box((1, 1, 1)).moved(0.5, 0.5, 0.5), 8.0),
        (box((1, 1, 1)).moved(0.5, 0.5, 1.5), 8.5),
        (box((1, 1, 1)).moved(0.5, 0.5, 2.0), 9.0),
        (box((1, 1, 1)).moved(2.0, 2.0, 2.0), 9.0),
        (box((1, 1, 1)).moved(2.0, 2.0, 0.0), 9.0),
        (box((1, 1, 1)).moved(5.0, 0.0, 0.0), 9.0),
        (box((4, 1, 1)).moved(-1.0, 0.5, 0.5), 10.0),
        (box((2, 2, 2)).moved(1e-13, 0.0, 0.0), 8.0),
    ],
)
def test_a_second_box_adds_what_is_outside_of_the_first(other, expected):
    body = polyhedron_union([box((2, 2, 2)), other])
    assert body.is_closed
    assert volume(body) == pytest.approx(expected, abs=1e-12)


def test_what_is_around_a_cavity_keeps_its_inner_faces():
    cells = [cell for cell in np.ndindex(3, 3, 3) if cell != (1, 1, 1)]
    body = polyhedron_union([box((1, 1, 1)).moved(*cell) for cell in cells])
    assert (volume(body), area(body), body.face_count) == (26.0, 60.0, 12)


@pytest.mark.slow
def test_vertices_keep_their_coordinates():
    one, two = turned(box((1, 2, 3))), turned(hull_mesh(np.random.default_rng(1).normal(size=(12, 3))))
    body = polyhedron_union([one, two])
    given_ones = {tuple(point) for mesh in (one, two) for point in mesh.vertices.tolist()}
    kept = [point for point in body.vertices.tolist() if tuple(point) in given_ones]
    outer = [p for mesh, other in ((one, two), (two, one)) for p in mesh.vertices[~inside(other, mesh.vertices)]]
    assert len(kept) == len(outer) > 8


@given(st.integers(0, 10_000))
@pytest.mark.slow
def test_points_are_in_the_union_where_they_are_in_a_body(seed):
    random = np.random.default_rng(seed)
    bodies = [hull_mesh(random.normal(size=(random.integers(4, 12), 3)) + random.normal(size=3)) for _ in range(4)]
    body, points = polyhedron_union(bodies), random.uniform(-2, 2, size=(30, 3))
    assert body.is_closed
    assert np.rint(windings(body, points)).tolist() == np.any([inside(one, points) for one in bodies], axis=0).tolist()


def test_one_body_stays_as_it_is_and_none_is_empty():
    tower = prism(L_SHAPE, (0, 0, 1))
    assert polyhedron_union([tower]) is tower
    assert polyhedron_union([]).face_count == 0


def test_open_bodies_and_missing_packages_are_told(monkeypatch):
    with pytest.raises(vp.InputError, match="body 2 of 2 is not closed"):
        polyhedron_union([box((1, 1, 1)), vp.Mesh.from_triangles(np.eye(3), [(0, 1, 2)])])
    monkeypatch.setitem(__import__("sys").modules, "manifold3d", None)
    with pytest.raises(vp.InputError, match=r"not convex needs manifold3d: pip install '.\[union\]'"):
        polyhedron_union([box((1, 1, 1)), prism(L_SHAPE, (0, 0, 1))])


def test_bodies_that_are_not_convex_are_united_by_another_library():
    pytest.importorskip("manifold3d")
    spool = revolution([(2, 0, 0), (1, 0, 1), (2, 0, 2)], order=8)
    body = polyhedron_union([prism(L_SHAPE, (0, 0, 1)), box((1, 1, 1)).moved(1, 1, 0)])
    assert (body.face_count, body.is_closed) == (6, True)
    assert volume(body) == pytest.approx(4.0, abs=1e-12)
    both = polyhedron_union([spool, spool.moved(0, 0, 2)])
    assert both.is_closed and volume(both) == pytest.approx(2 * volume(spool), rel=1e-12)


def test_bodies_that_touch_along_edges_of_facets_are_united():
    """The spigot of a housing begins in the plane of an edge inside of its wall."""
    pytest.importorskip("manifold3d")
    wall = revolution([(22, 0, 0), (60, 0, 0), (60, 0, 40), (50, 0, 40), (50, 0, 8), (22, 0, 8), (22, 0, 0)], 96)
    spigot = revolution([(12, 0, 50), (20, 0, 50), (20, 0, 84), (12, 0, 84), (12, 0, 50)], 64)
    turn = np.eye(4)
    turn[1:3, 1:3] = [(0, 1), (-1, 0)]
    spigot = spigot.transformed(turn).moved(0, 0, 24)
    body = polyhedron_union([wall, spigot])
    assert body.is_closed
    assert volume(wall) < volume(body) < volume(wall) + volume(spigot)
    assert body.bounds[1].tolist() == pytest.approx([60.0, 84.0, 44.0])
