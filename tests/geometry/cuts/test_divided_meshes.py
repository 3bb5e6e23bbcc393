"""Meshes divided by convex regions: nothing is lost, nothing is added, and what closed closes with its cut faces."""

import numpy as np
import pytest

from vectorplot.features import mesh_of_grid
from vectorplot.geometry import box
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import (
    HalfSpaces,
    PlaneFrame,
    divided_mesh,
    mesh_of_regions,
    region_of_sides,
    section_sides,
    window,
)
from vectorplot.surfaces import Torus

U = np.array([1.0, 2.0, -2.0]) / 3.0
SIDES = [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), tuple(U), tuple(np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0))]


def ring() -> Mesh:
    u, v = np.meshgrid(*Torus(2.0, 0.8).domain.grid(12, 8), indexing="ij")
    return mesh_of_grid(Torus(2.0, 0.8).points(u, v), closed_u=True, closed_v=True).reversed()


def elbow() -> Mesh:
    """A body whose top and bottom are not convex."""
    corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    points = [(x, y, z) for z in (0, 1) for x, y in corners]
    faces = [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *[[k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k] for k in range(6)]]
    return Mesh.from_polygons(points, faces)


SHAPES = {"cube": box((2, 2, 2)), "ring": ring(), "elbow": elbow()}
CUTS = [
    # Through the middle, through vertices, along faces and edges, several at once, and a box.
    HalfSpaces(SIDES[:1], (1.0,)),
    HalfSpaces(SIDES[1:2], (0.0,)),
    HalfSpaces(SIDES[2:3], (0.1,)),
    HalfSpaces(SIDES[:2], (1.0, -1.0)),
    HalfSpaces((SIDES[2], SIDES[3]), (0.0, 1.0)),
    HalfSpaces(((1.0, 0, 0), (-1.0, 0, 0), (0, 0, 1.0), (0, 1.0, 0)), (0.3, -1.2, 0.4, 0.2)),
]


def closed_by(mesh: Mesh, region: HalfSpaces) -> list[Mesh]:
    """The faces of a cut through a mesh."""
    found = []
    for number in range(len(region.normals)):
        frame = PlaneFrame.of(region, number, mesh.bounds.mean(axis=0))
        area = region_of_sides(*frame.places(section_sides(mesh, region, number)))
        if not area.is_empty:
            left, bottom, right, top = area.bounds
            far = (left - 1.0, bottom - 1.0, right + 1.0, top + 1.0)
            found.append(mesh_of_regions([(frame, area.intersection(window(region, number, frame, far)))]))
    return found


def volume(meshes: list[Mesh], about: np.ndarray) -> float:
    """Six times that of what all faces, which are plane, enclose together."""
    return sum(
        float(((mesh.vertices[mesh.corners[mesh.offsets[:-1]]] - about) * mesh.area_vectors).sum()) for mesh in meshes
    )


@pytest.mark.parametrize("region", CUTS)
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 3e6), (1.0, 1e5)])
def test_both_parts_close_with_the_faces_of_the_cut_and_are_together_what_was_cut(name, region, scale, shift):
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = shift
    mesh, moved = SHAPES[name].transformed(matrix), region.transformed(matrix)
    divided, faces = divided_mesh(mesh, moved), closed_by(mesh, moved)
    about = mesh.bounds.mean(axis=0)
    whole = volume([mesh], about)
    outside = volume([divided.outside, *faces], about)
    inside = volume([divided.inside, *[face.reversed() for face in faces]], about)
    allowed = 1e-6 * whole
    assert abs(outside + inside - whole) < allowed
    for part, shown in ((divided.outside, faces), (divided.inside, [face.reversed() for face in faces])):
        areas = sum((one.area_vectors.sum(axis=0) for one in [part, *shown]), np.zeros(3))
        assert np.abs(areas).max() < 1e-6 * np.abs(mesh.area_vectors).sum()
    # What is outside has no point in the region, and the other way round.
    middle = (
        divided.outside.vertices[divided.outside.corners].reshape(-1, 3) if divided.outside.face_count else about[None]
    )
    assert not (moved.heights(middle) > 1e-9 * scale * max(1.0, abs(shift) / scale)).all(axis=0).any()
    # Far off the origin volumes lose digits, but not that much.
    assert -allowed < inside < whole + allowed


def test_numbers_of_vertices_and_faces_do_not_matter():
    mesh, region = SHAPES["ring"], CUTS[4]
    rng = np.random.default_rng(5)
    order, faces = rng.permutation(len(mesh.vertices)), rng.permutation(mesh.face_count)
    polygons = mesh.polygons()
    other = Mesh.from_polygons(mesh.vertices[np.argsort(order)], [order[polygons[k]].tolist() for k in faces])
    one, two = divided_mesh(mesh, region), divided_mesh(other, region)
    assert one.outside.face_count == two.outside.face_count
    assert {tuple(p) for p in one.outside.vertices.round(12)} == {tuple(p) for p in two.outside.vertices.round(12)}


def test_a_face_in_the_plane_belongs_to_its_body():
    cube = SHAPES["cube"]
    above, below = HalfSpaces(((0.0, 0.0, 1.0),), (2.0,)), HalfSpaces(((0.0, 0.0, -1.0),), (-2.0,))
    assert divided_mesh(cube, above).outside.face_count == 6
    assert divided_mesh(cube, below).outside.face_count == 0
    assert not section_sides(cube, above, 0).size and not section_sides(cube, below, 0).size


def test_nested_loops_are_holes():
    inner = box((1, 1, 1)).moved(0.5, 0.5, 0.5).reversed()
    outer = box((2, 2, 2))
    hollow = Mesh(
        np.concatenate([outer.vertices, inner.vertices]),
        np.concatenate([outer.corners, inner.corners + 8]),
        np.concatenate([outer.offsets, outer.offsets[-1] + inner.offsets[1:]]),
    )
    tilted = HalfSpaces(((0.0, 0.6, 0.8),), (1.4,))
    sizes = [float(np.linalg.norm(closed_by(m, tilted)[0].area_vectors.sum(axis=0))) for m in (hollow, outer, inner)]
    assert sizes[0] == pytest.approx(sizes[1] - sizes[2], rel=1e-12) and sizes[2] > 1.0
