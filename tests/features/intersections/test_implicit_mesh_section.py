"""Where implicit surfaces meet the faces of meshes."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.implicit_curves import ImplicitTracing
from vectorplot.features.intersections import ImplicitPatch, implicit_mesh_section, mesh_section
from vectorplot.features.polygonization import polygonized
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces.placed_surface import PlacedImplicit
from vectorplot.surfaces.quadrics import Quadric, Sphere, implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.testing import hausdorff
from vectorplot.testing.shapes import box

FINE = 1e-5


def curves(shape, mesh):
    found = implicit_mesh_section(shape, mesh, tracing=ImplicitTracing(tolerance=FINE)).curves
    assert found.doubts == ()
    return found


@pytest.mark.slow
def test_a_plane_cuts_a_circle_out_of_a_sphere() -> None:
    found = curves(implicit_sphere(1.5), box((0.3, -3.0, -3.0), (3.0, 3.0, 3.0)))
    assert len(found) == 1 and found.closed.all()
    assert np.abs(found.points[:, 0] - 0.3).max() < 1e-12
    assert np.abs(np.linalg.norm(found.points, axis=1) - 1.5).max() < 1e-12
    length = np.linalg.norm(np.diff(found[0], axis=0), axis=1).sum()
    assert np.isclose(length, 2.0 * np.pi * np.sqrt(1.5**2 - 0.3**2), rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("equation", "surface", "mesh"),
    [
        (implicit_sphere(1.5), Sphere(1.5), box((0.2, -0.4, -0.3), (2.0, 1.8, 0.9))),
        (ImplicitTorus(3.0, 1.0), Torus(3.0, 1.0), box((1.3, -1.1, -0.45), (5.1, 0.9, 2.2))),
        (ImplicitTorus(3.0, 1.0), Torus(3.0, 1.0), polygonized(implicit_sphere(1.7, (3.0, 0.4, 0.3)), 12)),
    ],
)
def test_the_parametrised_form_gives_the_same_curves(equation, surface, mesh) -> None:
    found = curves(equation, mesh)
    other = mesh_section(surface, mesh, tracing=Tracing(tolerance=FINE)).curves
    assert len(found) == len(other) and found.closed.all() and other.closed.all()
    assert hausdorff([found[k] for k in range(len(found))], [other[k] for k in range(len(other))]) < 10.0 * FINE


@pytest.mark.slow
def test_curves_end_on_the_sides_of_the_box() -> None:
    cut = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -1.0], np.array([[-1.2, -0.7, -1.2], [0.8, 1.2, 0.6]]))
    found = curves(cut, box((0.1, -3.0, -3.0), (3.0, 3.0, 3.0)))
    assert len(found) == 1 and not found.closed.any()
    ends = found.points[[0, -1]]
    assert sorted(np.round(ends[:, 1], 12).tolist())[0] == -0.7
    assert sorted(np.round(ends[:, 2], 12).tolist())[-1] == 0.6
    assert np.abs(np.linalg.norm(found.points, axis=1) - 1.0).max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_size_and_place_change_nothing(scale: float, offset: float) -> None:
    block = box((0.2, -0.4, -0.3), (2.0, 1.8, 0.9))
    here = curves(implicit_sphere(1.5), block)
    moved = PlacedImplicit(implicit_sphere(1.5), scale * np.eye(3), np.full(3, offset))
    there = implicit_mesh_section(
        moved,
        Mesh(scale * block.vertices + offset, block.corners, block.offsets),
        tracing=ImplicitTracing(tolerance=FINE * scale),
    ).curves
    back = [(there[k] - offset) / scale for k in range(len(there))]
    assert hausdorff([here[k] for k in range(len(here))], back) < 10.0 * FINE


def test_shapes_apart_have_no_curves() -> None:
    assert len(curves(implicit_sphere(1.0), box((2.0, 2.0, 2.0), (3.0, 3.0, 3.0)))) == 0
    empty = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, 1.0], np.array([[-1.0] * 3, [1.0] * 3]))
    assert len(curves(empty, box((-0.5, -0.5, -0.5), (3.0, 3.0, 3.0)))) == 0


def test_heights_of_a_patch_bend_as_the_surface_does() -> None:
    torus = ImplicitTorus(3.0, 1.0)
    patch = ImplicitPatch(torus, polygonized(torus, 24))
    at = np.array([[4.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 1.0]])
    # Two axes in the tangent plane, along the meridian and the parallel; the third along the normal.
    frames = np.array(
        [[[0, 0, 1], [0, 1, 0], [1, 0, 0]], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]]
    ).astype(float)
    expected = [np.diag([-1.0, -0.25]), np.diag([-1.0, 0.5]), np.diag([-1.0, 0.0])]
    assert np.allclose(patch.bends(at, frames), expected, atol=1e-9)


CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


@pytest.mark.slow
@pytest.mark.capability("G9.3-sections")
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_a_sphere_cuts_round_holes_into_the_faces_of_a_cube(scale, offset) -> None:
    shift = np.array([offset, 0.0, 0.0]) * scale
    mesh = Mesh(CUBE.vertices * scale + shift, CUBE.corners, CUBE.offsets)
    tracing = ImplicitTracing(tolerance=1e-4 * scale)
    digits = 1e-12 + 8.0 * np.spacing(offset)
    section = implicit_mesh_section(implicit_sphere(1.2 * scale, tuple(shift)), mesh, tracing=tracing)
    holes = section.curves
    assert len(holes) == 6 and holes.closed.all()
    p = (holes.points - shift) / scale
    assert np.abs(np.linalg.norm(p, axis=1) - 1.2).max() < digits
    assert np.abs((p * section.normals).sum(axis=1) - 1.0).max() < digits  # in the plane of the face it runs in
    for k in range(6):
        length = np.linalg.norm(np.diff(holes[k], axis=0), axis=1).sum() / scale
        assert abs(length - 2 * np.pi * np.sqrt(0.44)) < 2e-3
    # A larger one meets the edges: one closed curve around each corner, with a point on every edge it crosses.
    larger = implicit_mesh_section(implicit_sphere(1.5 * scale, tuple(shift)), mesh, tracing=tracing).curves
    assert len(larger) == 8 and larger.closed.all()
    # A closed curve repeats its first point.
    once = np.delete(larger.points, larger.offsets[1:] - 1, axis=0)
    edge = np.sort(np.abs(once - shift) / scale, axis=1)[:, 1] > 1.0 - digits
    assert edge.sum() == 24


def test_a_small_hole_in_a_large_face_is_found() -> None:
    found = curves(implicit_sphere(0.02, (1.0, 0.123, 0.456)), CUBE)
    assert len(found) == 1 and found.closed.all()
    assert np.ptp(found.points, axis=0).max() == pytest.approx(0.04, rel=1e-2)


def test_a_mesh_and_a_surface_far_from_each_other_have_no_curve() -> None:
    assert len(curves(implicit_sphere(1.0, (9.0, 9.0, 9.0)), CUBE)) == 0
    empty = Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3)))
    assert len(curves(implicit_sphere(1.0), empty)) == 0


@pytest.mark.slow
@pytest.mark.parametrize("off", [0.0, 0.3, 10.0, 1e6])
def test_a_face_in_a_plane_of_the_lattice_cuts_curves_without_a_gap(off):
    ring = 'surface implicit "(x^2+y^2+z^2+3)^2-16*(x^2+y^2)" box -3.1 3.1 -3.1 3.1 -1.1 1.1'
    # The lattice has points in the planes x = 0 and y = 0, in which one, two, and two sides of the boxes lie.
    for size, place in (("1 1 3", (1.5, 0.0, -1.5)), ("2 2 3", (0.0, 0.0, -1.5)), ("3.1 1 3", (0.0, -1.0, -1.5))):
        there = " ".join(repr(off + x) for x in place)
        scene = parse_scene(f"A {ring} translation {off} {off} {off}\nB box {size} translation {there}")
        shape, box = (item.shape for item in scene.items)
        found = implicit_mesh_section(shape, box).curves
        assert len(found) > 0 and found.closed.all() and not found.doubts
