"""Smooth lines on meshes: sections, isophotes, contours."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.features.mesh_lines import (
    NO_FACE,
    mesh_contour_across_faces,
    mesh_isophote_edges,
    mesh_isophotes,
    mesh_level_lines,
    mesh_plane_sections,
    mesh_point_light_isophote_edges,
    mesh_point_light_isophotes,
    vertex_normals,
)
from vectorplot.features.polygonization import polygonized
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import repaired
from vectorplot.geometry.solids import box
from vectorplot.geometry.winding import edge_uses
from vectorplot.surfaces.quadrics import Sphere, implicit_cylinder, implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus
from vectorplot.testing import hausdorff
from vectorplot.words import LineKind

BALL = polygonized(implicit_sphere(1.0, (0.01, 0.02, 0.03)), 24)
RING = polygonized(ImplicitTorus(3, 1), 32)
CUBE = box((2.0, 2.0, 2.0))
LIGHT = np.array([2.0, 1.0, 3.0])
L_SHAPE = Mesh.from_polygons(
    [(x, y, z) for z in (0.0, 1.0) for x, y in ((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2))],
    [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *([k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6] for k in range(6))],
)


def globe(rows):
    sphere = Sphere(1.0)
    u, v = np.meshgrid(*sphere.domain.grid(2 * rows, rows), indexing="ij")
    points = sphere.points(u, v)
    points[:, [0, -1]] = [[[0, 0, -1], [0, 0, 1]]]
    return repaired(mesh_of_grid(points, closed_u=True), 1e-9)[0]


def lies_in_its_face(mesh, curves):
    """Largest distance of a segment's ends from the plane of its face."""
    worst = 0.0
    for k in range(len(curves)):
        p = curves[k]
        face = curves.faces[curves.offsets[k] : curves.offsets[k + 1]][: len(p) - 1]
        corner = mesh.vertices[mesh.corners[mesh.offsets[face]]]
        for end in (p[:-1], p[1:]):
            worst = max(worst, np.abs(((end - corner) * mesh.face_normals[face]).sum(axis=1)).max())
    return worst


def on_edges(mesh, points):
    """Largest distance of points from the nearest edge."""
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first]
    a, b = mesh.vertices[mesh.corners[corner]], mesh.vertices[mesh.corners[mesh.next_corner[corner]]]
    worst = 0.0
    for p in points:
        t = np.clip(((p - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1), 0, 1)
        worst = max(worst, np.linalg.norm(a + t[:, None] * (b - a) - p, axis=1).min())
    return worst


@pytest.mark.capability("G9.3-sections")
def test_every_point_of_a_section_is_on_an_edge_in_the_plane_and_its_segments_in_their_faces():
    n = np.array([1.0, 2.0, 2.0]) / 3.0
    curves = mesh_plane_sections(RING, n, [-1.0, 0.0, 0.7])
    assert curves.closed.all() and set(curves.levels) == {-1.0, 0.0, 0.7} and (curves.faces != NO_FACE).all()
    level = np.repeat(curves.levels, np.diff(curves.offsets))
    assert np.abs(curves.points @ n - level).max() < 1e-14
    assert on_edges(RING, curves.points[::7]) < 1e-14 and lies_in_its_face(RING, curves) < 1e-14


@pytest.mark.capability("G9.3-sections")
def test_sections_of_a_cube_are_polygons_without_needless_points():
    square = mesh_plane_sections(CUBE, (0, 0, 1), [CUBE.bounds[0, 2] + 0.5])
    assert len(square) == 1 and square.closed.all() and len(square.points) == 4
    middle = CUBE.bounds.mean(axis=0)
    n = np.ones(3) / np.sqrt(3)
    hexagon = mesh_plane_sections(CUBE, n, [middle @ n])
    assert len(hexagon.points) == 6
    assert np.allclose(np.linalg.norm(hexagon.points - middle, axis=1), np.sqrt(2))


def test_sections_of_faces_that_are_not_convex_are_whole():
    curves = mesh_plane_sections(L_SHAPE, (1.0, 1.0, 0.0), [2.5 / np.sqrt(2)])
    assert len(curves) == 2 and curves.closed.all() and len(curves.points) == 8
    assert lies_in_its_face(L_SHAPE, curves) < 1e-14
    flat = mesh_level_lines(L_SHAPE, [0.25])
    assert len(flat) == 1 and len(flat.points) == 6


@pytest.mark.hard(36)
@pytest.mark.parametrize("rows", [6, 12, 24])
@pytest.mark.parametrize("turn", [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
def test_contours_through_vertices_and_along_edges_are_one_polyline(rows, turn):
    """Seen along its axes a globe has a whole ring, or a meridian, of vertices on its contour."""
    mesh = globe(rows)
    way = np.array(turn) / np.linalg.norm(turn)
    found = mesh_contour_across_faces(mesh, 1e9 * way)
    assert len(found) == 1 and found.closed.all()
    assert np.abs(found.points @ way).max() < 0.1
    step = np.diff(found[0], axis=0)
    length = np.linalg.norm(step, axis=1)
    assert length.min() > 0.0 and 5.9 < length.sum() < 2.0 * np.pi, "once round, neither to and fro nor twice"


@pytest.mark.hard(36)
def test_sections_through_vertices_and_along_edges_are_one_polyline():
    # Through two opposite edges of a cube; through a vertex only; in a face.
    low, high = CUBE.bounds
    diagonal = mesh_plane_sections(CUBE, (1, -1, 0), [0.0])
    assert len(diagonal) == 1 and diagonal.closed.all()
    length = np.linalg.norm(np.diff(diagonal[0], axis=0), axis=1).sum()
    assert abs(length - 2 * (2 + np.sqrt(8))) < 1e-12
    corner = mesh_plane_sections(CUBE, (1, 1, 1), [high.sum() / np.sqrt(3), low.sum() / np.sqrt(3)])
    assert len(corner) == 0
    lid, floor = mesh_level_lines(CUBE, [high[2]]), mesh_level_lines(CUBE, [low[2]])
    assert len(lid) == 1 and lid.closed.all() and len(lid.points) == 4 and len(floor) == 0
    grid = mesh_level_lines(polygonized(ImplicitTorus(3, 1), 16), [0.0])
    assert len(grid) == 2 and grid.closed.all()


@pytest.mark.parametrize(
    "faces",
    [
        [[0, 0, 1, 2]],
        [[0, 0, 1, 2], [1, 1, 2], [1, 2, 0], [0, 2, 0]],
        [[0, 1, 2], [2, 1, 0]],
        [[0, 1, 2, 1, 0, 2]],
        [[0, 1, 0, 2, 0, 1, 2]],
    ],
)
def test_sections_of_faces_that_repeat_their_corners_have_points(faces):
    vertices = np.array([(4.5, 11.8, -1.9), (5.5, 1.8, 2.6), (9.7, 1.0, -1.0)])
    mesh = Mesh.from_polygons(vertices, faces)
    found = mesh_plane_sections(mesh, (0.0, 0.0, 1.0), np.linspace(-1.9, 2.6, 9))
    assert len(found) and (np.diff(found.offsets) > 1).all()
    assert len(found.offsets) - 1 == len(found.closed) == len(found.levels) and found.offsets[-1] == len(found.points)
    assert np.allclose(found.points[:, 2], np.repeat(found.levels, np.diff(found.offsets)))


def test_the_side_of_larger_values_is_on_the_left():
    for curves in (mesh_level_lines(BALL, [0.3]), mesh_isophotes(BALL, (0, 0, 1), [0.3])):
        p = curves[0]
        outwards = (p[1:] + p[:-1]) / 2 - (0.01, 0.02, 0.03)
        assert (np.cross(outwards, np.diff(p, axis=0))[:, 2] > 0).all()


def test_open_meshes_give_open_curves():
    tube = polygonized(implicit_cylinder(1.0, (0.1, 0, 0), (0, 0, 1), [[-2] * 3, [2] * 3]), 16)
    curves = mesh_plane_sections(tube, (1, 0, 0), [0.2])
    assert len(curves) == 2 and not curves.closed.any()
    assert all(sorted(curves[k][[0, -1], 2]) == [-2.0, 2.0] for k in range(2))
    assert (curves.faces == NO_FACE).sum() == 2


@settings(max_examples=examples(30))
@given(st.tuples(*[st.floats(-1, 1)] * 3), st.floats(-0.9, 0.9))
def test_sections_of_closed_meshes_close(normal, offset):
    n = np.array(normal)
    if np.linalg.norm(n) < 1e-3:
        return
    curves = mesh_plane_sections(BALL, n, [offset])
    assert len(curves) == 1 and curves.closed.all()
    assert np.abs(curves.points @ (n / np.linalg.norm(n)) - offset).max() < 1e-13


def test_an_empty_mesh_has_no_curve():
    empty = Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3)))
    assert len(mesh_plane_sections(empty, (0, 0, 1), [0.0])) == 0 and len(mesh_isophotes(empty, LIGHT, [0.5])) == 0


@pytest.mark.capability("G9.3-isophote")
def test_isophotes_across_faces_converge_to_the_circles_of_a_sphere():
    towards = LIGHT / np.linalg.norm(LIGHT)
    errors = []
    for cells in (12, 24, 48):
        mesh = globe(cells)
        curves = mesh_isophotes(mesh, LIGHT, [0.4])
        assert len(curves) == 1 and curves.closed.all() and lies_in_its_face(mesh, curves) < 1e-14
        errors.append(np.abs(curves.points @ towards - 0.4).max())
    assert errors[2] < errors[1] < errors[0] and errors[2] < 0.01


@pytest.mark.capability("G9.3-isophote")
def test_isophotes_along_edges_part_lighter_from_darker_faces():
    curves = mesh_isophote_edges(RING, LIGHT, [-0.3, 0.3])
    assert curves.closed.all() and len(curves)
    towards = LIGHT / np.linalg.norm(LIGHT)
    vertex = {tuple(p): k for k, p in enumerate(RING.vertices)}
    uses = {}
    for face, corners in enumerate(RING.polygons()):
        for k in range(3):
            uses[corners[k], corners[(k + 1) % 3]] = face
    for k in range(len(curves)):
        path = [vertex[tuple(p)] for p in curves[k]]
        face = curves.faces[curves.offsets[k] : curves.offsets[k + 1]]
        for a, b, own in zip(path[:-1], path[1:], face, strict=True):
            left, right = uses[a, b], uses[b, a]
            assert left == own
            assert RING.face_normals[left] @ towards >= curves.levels[k] > RING.face_normals[right] @ towards


def test_both_isophotes_are_near_each_other_and_point_lights_too():
    cell = 8.2 / 32
    pairs = (
        (mesh_isophotes(RING, LIGHT, [0.2]), mesh_isophote_edges(RING, LIGHT, [0.2])),
        (mesh_point_light_isophotes(RING, (9, 5, 7), [0.2]), mesh_point_light_isophote_edges(RING, (9, 5, 7), [0.2])),
    )
    for across, along in pairs:
        assert hausdorff([across[k] for k in range(len(across))], [along[k] for k in range(len(along))]) < 2.5 * cell


@pytest.mark.capability("G9.3-contour")
def test_contour_across_faces_comes_near_the_true_one():
    eye = np.array([8.0, -3.0, 6.0])
    errors = []
    for cells in (16, 32):
        mesh = globe(cells)
        curves = mesh_contour_across_faces(mesh, eye)
        assert len(curves) == 1 and curves.closed.all()
        errors.append(np.abs(curves.points @ eye - 1.0).max())
    assert errors[1] < 0.6 * errors[0]
    parallel = mesh_contour_across_faces(RING, (0, 1e9 * np.sin(1), 1e9 * np.cos(1)))
    assert len(parallel) == 2 and parallel.closed.all()


def test_vertex_normals_of_a_cube_look_along_its_diagonals_however_its_faces_are_cut():
    middle = CUBE.bounds.mean(axis=0)
    expected = (CUBE.vertices - middle) / np.sqrt(3)
    assert np.allclose(vertex_normals(CUBE), expected)
    fans = [[p[0], p[k], p[k + 1]] for p in CUBE.polygons() for k in (1, 2)]
    assert np.allclose(vertex_normals(Mesh.from_triangles(CUBE.vertices, fans)), expected)


def test_curves_become_strokes_and_smooth_paths():
    curves = mesh_level_lines(RING, [0.3])
    strokes = curves.strokes(LineKind.CONTOUR, 3)
    assert len(strokes) == len(curves) == 2 and set(strokes.item) == {3}
    assert np.array_equal(strokes.points[0], strokes.points[strokes.offsets[1] - 1])
    assert len(curves.smooth(0.05)) == 2


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_scaled_and_shifted_meshes_give_the_same_curves(scale, offset):
    shift = np.array([offset, 0.0, 0.0])
    mesh = Mesh((CUBE.vertices + shift) * scale, CUBE.corners, CUBE.offsets)
    middle = mesh.bounds.mean(axis=0)
    n = np.array([1.0, 2.0, 3.0]) / np.sqrt(14)
    assert len(mesh_plane_sections(mesh, n, [middle @ n]).points) == len(
        mesh_plane_sections(CUBE, n, [CUBE.bounds.mean(axis=0) @ n]).points
    )


def test_wrong_input_is_named():
    for call in (
        lambda: mesh_plane_sections(BALL, (0, 0, 0), [0.0]),
        lambda: mesh_level_lines(BALL, [np.inf]),
        lambda: mesh_isophotes(BALL, LIGHT, [2.0]),
        lambda: mesh_isophote_edges(BALL, (0, np.nan, 0), [0.0]),
    ):
        with pytest.raises(InputError):
            call()


def test_sections_by_many_planes_are_those_by_each(monkeypatch):
    u, v = np.meshgrid(*Sphere().domain.grid(24, 12), indexing="ij")
    ball, normal, offsets = mesh_of_grid(Sphere().points(u, v), closed_u=True), (1.0, 2.0, 2.0), np.linspace(-1, 1, 9)
    each = [mesh_plane_sections(ball, normal, d) for d in offsets]
    for at_once in (1, 3 * len(ball.corners), 1 << 20):
        monkeypatch.setattr("vectorplot.features.mesh_lines.TRIANGLES_AT_ONCE", at_once)
        whole = mesh_plane_sections(ball, normal, offsets)
        assert np.array_equal(whole.points, np.concatenate([own.points for own in each]))
        assert np.array_equal(whole.faces, np.concatenate([own.faces for own in each]))
        assert np.array_equal(whole.levels, np.concatenate([own.levels for own in each]))
        assert np.array_equal(whole.closed, np.concatenate([own.closed for own in each]))
