"""Meshes taken apart along creases, and isophotes that end there."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.mesh_edge_lines import apart_at_creases
from vectorplot.features.mesh_lines import mesh_isophotes, mesh_point_light_isophotes, vertex_normals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines, even_cosines
from vectorplot.testing.shapes import box
from vectorplot.words import LineKind

LIGHT = np.array([0.6, -0.5, 0.7])


def can(count, scale=1.0, shift=0.0):
    """A prism with flat ends and a border of quadrilaterals in three rows."""
    turn = 2.0 * np.pi * np.arange(count) / count
    z = np.linspace(0.0, 2.0, 4)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    vertices = np.concatenate([np.column_stack([ring, np.full(count, height)]) for height in z])
    k, after = np.arange(count), (np.arange(count) + 1) % count
    faces = [(count * row + np.stack([k, after, after + count, k + count], axis=1)).tolist() for row in range(3)]
    ends = [k[::-1].tolist(), (3 * count + k).tolist()]
    return Mesh.from_polygons(scale * vertices + shift, [*(face for row in faces for face in row), *ends])


@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_isophotes_of_a_can_are_rulings_of_its_side(scale, shift):
    curves = mesh_isophotes(can(48, scale, shift), LIGHT, even_cosines(12), 25.0)
    points = (curves.points - shift) / scale
    assert len(curves) == 2 * 10 and not curves.closed.any()
    for k in range(len(curves)):
        own = points[curves.offsets[k] : curves.offsets[k + 1]]
        assert np.ptp(own[:, :2], axis=0).max() < 1e-8 and np.ptp(own[:, 2]) == pytest.approx(2.0)
        # Linear between normals that are 7.5 degrees apart.
        out = own[0, :2] / np.hypot(*own[0, :2])
        assert out @ LIGHT[:2] / np.linalg.norm(LIGHT) == pytest.approx(curves.levels[k], abs=4e-3)


def test_flat_faces_between_creases_have_none():
    for mesh in (box((0, 0, 0), (1, 2, 3)), can(8)):
        assert not len(mesh_isophotes(mesh, LIGHT, even_cosines(20), 25.0))
        assert len(mesh_isophotes(mesh, LIGHT, even_cosines(20), 100.0))


def test_a_lamp_near_flat_faces_has_circles_on_them():
    floor = np.stack(np.meshgrid(np.linspace(-1, 1, 41), np.linspace(-1, 1, 41), [0.0], indexing="ij"), axis=-1)
    points = floor.reshape(-1, 3)
    k = np.arange(41 * 40).reshape(41, 40)[:40]
    k = (41 * np.arange(40)[:, None] + np.arange(40)).ravel()
    mesh = Mesh.from_polygons(points, np.stack([k, k + 41, k + 42, k + 1], axis=1).tolist())
    curves = mesh_point_light_isophotes(mesh, (0, 0, 0.5), [0.8], 25.0)
    assert np.hypot(curves.points[:, 0], curves.points[:, 1]) == pytest.approx(0.375, abs=2e-3)


@pytest.mark.parametrize("angle", [1.0, 10.0, 30.0, 89.0, 91.0, 180.0])
def test_parts_have_the_faces_of_the_mesh_and_normals_within_the_angle_of_theirs(angle):
    mesh = can(24)
    apart = apart_at_creases(mesh, angle)
    assert np.array_equal(apart.vertices[apart.corners], mesh.vertices[mesh.corners])
    assert np.array_equal(apart.offsets, mesh.offsets)
    cosine = (vertex_normals(apart)[apart.corners] * mesh.face_normals[mesh.corner_face]).sum(axis=1)
    assert cosine.min() > np.cos(np.radians(angle)) - 1e-12
    # The sides turn by 15 degrees, the ends by 90.
    assert len(apart.vertices) == 24 * {1.0: 10, 10.0: 10, 30.0: 6, 89.0: 6}.get(angle, 4)
    assert (apart is mesh) == (angle > 90.0)


def test_draw_ends_them_where_it_draws_creases():
    lines = SurfaceLines(isophotes=even_cosines(12))
    lamp = (Light(tuple(LIGHT.tolist()), parallel=True),)
    scene = Scene((Item("can", can(48), curves=lines),), lights=lamp)
    for angle, expected in ((25.0, True), (120.0, False)):
        drawing = draw(scene, Camera((8, -9, 7), (0, 0, 1)), crease_angle_deg=angle, curves="polyline")
        strokes = [s for layer in drawing.layers for s in layer.strokes]
        inner = [
            0.5 * (s.points3d[s.offsets[k] : s.offsets[k + 1] - 1] + s.points3d[s.offsets[k] + 1 : s.offsets[k + 1]])
            for s in strokes
            for k in np.flatnonzero(s.kind == LineKind.ISOPHOTE).tolist()
        ]
        across_ends = np.hypot(*np.concatenate(inner)[:, :2].T) < 0.9
        assert across_ends.any() != expected


@pytest.mark.parametrize("angle", [-1.0, 181.0, float("nan")])
def test_angles_out_of_range_are_told(angle):
    with pytest.raises(InputError, match="crease angle"):
        mesh_isophotes(can(8), LIGHT, [0.5], angle)
