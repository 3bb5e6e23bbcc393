"""Surfaces cut by the faces of meshes."""

import numpy as np
import pytest

from vectorplot.features.contours_and_isophotes import plane_sections
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.intersections import mesh_section
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import rotation_about
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus

SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def block(low, high, present=None):
    grid = np.stack(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), axis=-1)
    return Mesh.from_polygons(grid.reshape(-1, 3), SIDES, present=present)


def cube(half=1.0):
    return block([-half] * 3, [half] * 3)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_a_sphere_through_the_faces_of_a_cube_gives_six_circles(scale, offset):
    far = np.array([offset, -offset, offset]) * scale
    mesh = block(far - scale, far + scale)
    section = mesh_section(Sphere(1.2 * scale, far), mesh)
    curves = section.curves
    assert len(section) == 6 and curves.closed.all() and not curves.doubts
    noise = 1e-11 if offset == 0.0 else 1e-8
    height = np.abs((curves.points - far) / scale).max(axis=1)
    assert np.abs(height - 1.0).max() < noise
    for k in range(6):
        own = slice(curves.offsets[k], curves.offsets[k + 1])
        assert len(np.unique(section.faces[own])) == 1


def test_a_curve_goes_over_edges_with_a_vertex_exactly_on_each():
    corner = np.array([0.1, 0.2, 0.3])
    section = mesh_section(Sphere(1.0), block(corner, [3.0] * 3))
    curves = section.curves
    assert len(section) == 1 and curves.closed.all()
    off = np.abs(curves.points - corner)
    assert off.min(axis=1).max() < 1e-12 and np.abs(np.linalg.norm(curves.points, axis=1) - 1).max() < 1e-12
    on_edges = (off < 1e-12).sum(axis=1) == 2
    assert on_edges.sum() == 3 and len(np.unique(section.faces)) == 3
    # The face of every segment holds both its ends.
    a, b = off, np.roll(off, -1, axis=0)
    held = (a < 1e-12) & (b < 1e-12)
    axis = np.array([0, 0, 1, 1, 2, 2])[section.faces]
    assert held[np.arange(len(axis)), axis].all()


def test_a_sphere_that_holds_the_middles_of_edges_cuts_off_corners():
    section = mesh_section(Sphere(1.5), cube())
    assert len(section) == 8 and section.curves.closed.all()
    assert np.abs(np.abs(section.curves.points).max(axis=1) - 1).max() < 1e-12


@pytest.mark.hard(40)
@pytest.mark.parametrize("above", [1e-4, 1e-7])
def test_caps_below_the_tessellation_are_found(above):
    section = mesh_section(Sphere(1.0 + above), cube())
    curves = section.curves
    assert len(section) == 6 and curves.closed.all() and len(curves.isolated) == 0
    radius = np.sqrt((1 + above) ** 2 - 1)
    away = np.sort(np.abs(curves.points), axis=1)
    assert np.abs(np.hypot(away[:, 0], away[:, 1]) - radius).max() < 1e-9


@pytest.mark.hard(43)
def test_a_sphere_in_a_cube_touches_its_faces_in_points():
    section = mesh_section(Sphere(1.0), cube())
    touched = Sphere(1.0).points(*section.curves.isolated.T)
    assert len(section) == 0 and len(touched) == 6
    assert np.abs(np.sort(np.abs(touched), axis=1) - (0, 0, 1)).max() < 1e-7


def test_faces_that_do_not_reach_the_surface_and_absent_ones_do_not_count():
    assert len(mesh_section(Sphere(1.0), cube(3.0))) == 0
    present = [True] * 5 + [False]
    assert len(mesh_section(Sphere(1.2), block([-1.0] * 3, [1.0] * 3, present))) == 5
    assert len(mesh_section(Sphere(1.2), Mesh.from_polygons(np.zeros((0, 3)), []))) == 0


def test_a_concave_face_cuts_where_it_is():
    corners = [[-2, -2, 0.2], [2, -2, 0.2], [2, 0.1, 0.2], [0.1, 0.1, 0.2], [0.1, 2, 0.2], [-2, 2, 0.2]]
    section = mesh_section(Sphere(1.0), Mesh.from_polygons(corners, [range(6)]))
    x, y, z = section.curves.points.T
    assert len(section) == 1 and not section.curves.closed.any()
    assert np.abs(z - 0.2).max() < 1e-12 and ((x < 0.1 + 1e-12) | (y < 0.1 + 1e-12)).all()
    ends = np.sort(section.curves[0][[0, -1], 0])
    assert np.abs(ends - [0.1, np.sqrt(0.95)]).max() < 1e-12


@pytest.mark.hard(38)
def test_a_face_through_a_saddle_gives_a_node():
    section = mesh_section(Torus(3.0, 1.0), block([-9, -2, -9], [9, 9, 9]))
    expected = plane_sections(Torus(3.0, 1.0), (0, 1, 0), [-2.0])
    assert len(section.curves.nodes) == 1 and len(section) == len(expected) and section.curves.closed.all()
    p = section.curves.points
    assert np.abs(p[:, 1] + 2).max() < 1e-9
    assert np.abs(Torus(3.0, 1.0).points(*section.curves.nodes.T) - (0, -2, 0)).max() < 1e-9


def test_the_same_curve_as_the_plane_and_round_it_once():
    section = mesh_section(
        Cylinder(1.0, -2.0, 2.0), block([-5, -5, -0.9], [5, 5, 1.0]), tracing=Tracing(tolerance=1e-4)
    )
    curves = section.curves
    assert len(section) == 2 and (np.abs(curves.turns) == (1, 0)).all()
    for k in range(2):
        length = np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum()
        assert abs(length - 2 * np.pi) < 1e-3


@pytest.mark.hard(44)
def test_a_patch_in_a_face_is_reported_without_noise():
    patch = surface_of_function(lambda u, v: (u, v, 0 * u + 1), Domain(-0.5, 0.5, -0.5, 0.5))
    section = mesh_section(patch, cube())
    assert len(section) == 0 and "coincide in an area" in section.curves.doubts[0]


@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("seed", range(24))
def test_boxes_in_any_place_cut_closed_curves_on_their_faces(seed):
    random = np.random.default_rng(seed)
    turn = rotation_about(random.normal(size=3), random.uniform(0, 3))
    middle, half = random.uniform(-1.5, 1.5, 3), random.uniform(0.2, 1.5, 3)
    mesh = block(-half, half)
    mesh = Mesh(mesh.vertices @ turn + middle, mesh.corners, mesh.offsets)
    section = mesh_section([Torus(1.5, 0.6), Sphere(1.3), Torus(2.0, 0.3)][seed % 3], mesh)
    curves = section.curves
    assert curves.closed.all() and not curves.doubts
    beyond = np.abs((curves.points - middle) @ turn.T) - half
    assert np.abs(beyond).min(axis=1).max(initial=0.0) < 1e-11 and beyond.max(initial=0.0) < 1e-9
    origin = mesh.vertices[mesh.corners[mesh.offsets[section.faces]]]
    normal = mesh.face_normals[section.faces]
    for k in range(len(curves)):
        own = slice(curves.offsets[k], curves.offsets[k + 1])
        for points in (curves.points[own], np.roll(curves.points[own], -1, axis=0)):
            assert np.abs(((points - origin[own]) * normal[own]).sum(axis=1)).max() < 1e-9


def test_a_face_that_is_not_planar_is_two_triangles():
    bent = Mesh.from_polygons([[-2, -2, 0], [2, -2, 0.5], [2, 2, 0], [-2, 2, 0.5]], [range(4)])
    section = mesh_section(Sphere(1.0), bent)
    assert len(section) == 1 and section.curves.closed.all()
    assert np.abs(np.linalg.norm(section.curves.points, axis=1) - 1).max() < 1e-12
