"""Edges, neighbours and records."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.paths import DATA

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box, polyhedron
from vectorplot.geometry.winding import NO_FACE, mesh_edges
from vectorplot.io.read_file import read
from vectorplot.pictures.draw import draw
from vectorplot.scene.light import Light
from vectorplot.scene.view import look
from vectorplot.shading.shaded_faces import face_middles, face_normals, face_shades, view_lights
from vectorplot.textbook.orders import priorities, view_objects, wholly_hidden
from vectorplot.textbook.polyhedra import body_record, common_edge, contour_branches, face_records, neighbour_faces
from vectorplot.textbook.separating_planes import FIRST_ABOVE, separations
from vectorplot.visibility.painter.priority_tests import BEHIND, IN_FRONT
from vectorplot.words import MATERIALS, check_colour

VERTICES = [
    [2, 0, 0], [1, 2, 0], [-1, 2, 0], [-2, 0, 0], [-1, -2, 0], [1, -2, 0],
    [2, 0, 4], [1, 2, 1], [-1, 2, 1], [-2, 0, 4], [-1, -2, 1], [1, -2, 1],
]  # fmt: skip
FACES = ["1 2 3 4 5 6", "1 2 8 7", "2 3 9 8", "3 4 10 9", "4 5 11 10", "5 6 12 11", "6 1 7 12", "10 11 12 7"]
EDGES = (
    "1 2 , 2 3 , 3 4 , 4 5 , 5 6 , 6 1 , 7 8 , 8 9 , 9 10 , 10 11 , 11 12 , 12 7 , "
    "1 7 , 2 8 , 3 9 , 4 10 , 5 11 , 6 12 , 7 10"
)


def pyramid() -> Mesh:
    return polyhedron(VERTICES, [[int(v) - 1 for v in face.split()] for face in FACES])


@pytest.mark.capability("G3.3-edges-from-faces")
@pytest.mark.capability("G3.3-general")
def test_pyramid_has_the_19_edges_of_the_list_from_its_faces_alone():
    mesh = pyramid()
    listed = sorted(sorted(int(v) - 1 for v in pair.split()) for pair in EDGES.split(","))
    assert mesh_edges(mesh).tolist() == listed
    record = body_record(mesh)
    assert (record.vertex_count, record.edge_count, record.face_count) == (12, 19, 8)


@pytest.mark.capability("G3.2-orient")
def test_pyramid_bottom_is_flipped_and_all_eight_faces_look_outwards():
    mesh = pyramid()
    assert mesh.polygons()[0] == [5, 4, 3, 2, 1, 0]
    assert mesh.polygons()[1:] == [[int(v) - 1 for v in face.split()] for face in FACES[1:]]
    assert (np.einsum("ij,ij->i", mesh.face_normals, face_records(mesh).barycentres - [0, 0, 1]) > 0).all()


@pytest.mark.capability("G3.2-polyhedron")
def test_tv16_pyramid_barycentre_and_hull():
    scipy_spatial = pytest.importorskip("scipy.spatial")
    record = body_record(pyramid())
    assert np.allclose(record.barycentre, [0, 0, 1], atol=1e-15)
    assert scipy_spatial.ConvexHull(np.array(VERTICES)).volume == pytest.approx(32)
    closed = polyhedron(VERTICES, [*pyramid().polygons(), [6, 7, 8, 9]])
    assert body_record(closed).volume == pytest.approx(32)
    assert record.max_radius == pytest.approx(np.sqrt(13))
    assert np.array_equal(record.bounds, [[-2, -2, 0], [2, 2, 4]])


@pytest.mark.capability("G3.2-face")
def test_face_records_hold_the_planes_of_all_corners():
    for mesh in (pyramid(), box((1, 2, 3)), box((1, 2, 3), placement=(1, 0, 0, 1e6, 0, 1, 0, 0, 0, 0, 1, 0))):
        records = face_records(mesh)
        heights = np.einsum("ij,ij->i", records.normals[mesh.corner_face], mesh.vertices[mesh.corners])
        assert np.allclose(heights, records.constants[mesh.corner_face], rtol=1e-15, atol=1e-9)
        assert np.allclose(np.linalg.norm(records.normals, axis=1), 1.0)
        means = [mesh.vertices[polygon].mean(axis=0) for polygon in mesh.polygons()]
        assert np.allclose(records.barycentres, means, atol=1e-9)


@pytest.mark.capability("G3.2-neighbours")
def test_neighbourhood_is_symmetric_and_border_edges_have_no_neighbour():
    mesh = pyramid()
    across = neighbour_faces(mesh)
    for corner, neighbour in enumerate(across.tolist()):
        edge = {int(mesh.corners[corner]), int(mesh.corners[mesh.next_corner[corner]])}
        if neighbour == NO_FACE:
            assert edge in ({6, 7}, {7, 8}, {8, 9}, {6, 9})
            continue
        own = int(mesh.corner_face[corner])
        back = [k for k in range(mesh.offsets[neighbour], mesh.offsets[neighbour + 1]) if across[k] == own]
        assert any({int(mesh.corners[k]), int(mesh.corners[mesh.next_corner[k]])} == edge for k in back)
    assert np.count_nonzero(across == NO_FACE) == 4


@pytest.mark.capability("G3.3-common-edge")
def test_common_edge_by_positions_in_the_first_face():
    mesh = box((1, 1, 1))
    assert common_edge(mesh, 0, 2) is None
    first, second = common_edge(mesh, 0, 1)
    assert {mesh.polygons()[0][first], mesh.polygons()[0][second]} == {1, 5}
    # The edge between the first and the second vertex, and the one that closes the polygon, are found too.
    assert common_edge(mesh, 0, 4) == (0, 1)
    assert common_edge(mesh, 0, 3) == (3, 0)


@pytest.mark.capability("G3.3-common-edge")
@pytest.mark.capability("G3.3-edges-from-faces")
def test_faces_that_share_vertices_which_are_no_neighbours_have_no_common_edge():
    mesh = Mesh.from_polygons(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 1], [0, 1, 1]], [[0, 1, 2, 3], [0, 4, 2, 5]]
    )
    assert common_edge(mesh, 0, 1) is None
    assert len(mesh_edges(mesh)) == 8


def test_an_edge_of_three_faces_has_no_single_neighbour():
    mesh = Mesh.from_polygons(
        [[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    )
    assert (neighbour_faces(mesh) == NO_FACE).all()


@pytest.mark.capability("G3.2-polyhedron", "G3.2-face")
@pytest.mark.parametrize("name", ["pencil", "cubes", "pyramid", "town", "table", "interpenetrating"])
def test_all_that_is_recorded_of_the_objects_of_a_scene_fits_together(name):
    scene = read(DATA / f"{name}.scene")
    items = [item for item in scene.items if item.mesh.present is None]
    scene = replace(scene, items=tuple(items))
    assert len({item.name for item in items}) == len(items)
    for item in items:
        check_colour(item.colour)
        mesh, record, faces = item.mesh, body_record(item.mesh), face_records(item.mesh)
        assert item.material.word in MATERIALS
        assert (record.vertex_count, record.face_count) == (len(mesh.vertices), mesh.face_count)
        assert record.edge_count == len(mesh_edges(mesh))
        size = float(np.ptp(record.bounds, axis=0).max())
        away = np.linalg.norm(mesh.vertices - record.barycentre, axis=1)
        assert away.max() == pytest.approx(record.max_radius)
        assert (mesh.vertices >= record.bounds[0]).all() and (mesh.vertices <= record.bounds[1]).all()
        heights = np.einsum("ij,ij->i", faces.normals[mesh.corner_face], mesh.vertices[mesh.corners])
        assert np.abs(heights - faces.constants[mesh.corner_face]).max() < 1e-9 * size
        known = faces.neighbours >= 0
        assert np.isin(mesh.corner_face[known], faces.neighbours).all()
        assert faces.neighbours.max() < mesh.face_count
    # In every system, of the eye or a light: boxes, priorities, and what is obscured.
    middle = tuple(scene.bounds.mean(axis=0).tolist())
    systems = [
        scene.camera,
        *(Camera(tuple(np.add(middle, li.position)), middle, parallel=True) for li in scene.lights),
    ]
    for camera in systems:
        objects = view_objects(look(scene, camera))
        points, first_vertex = objects.view.points, objects.view.item_vertices
        image = objects.view.image
        for k in range(len(items)):
            own = slice(first_vertex[k], first_vertex[k + 1])
            low, high = objects.box[0:4:2, k], objects.box[1:4:2, k]
            assert (low >= image[:, own].min(axis=1) - 1e-6).all() and (high <= image[:, own].max(axis=1) + 1e-6).all()
            centre, radius = objects.around.spheres[k, :3], objects.around.spheres[k, 3]
            assert np.linalg.norm(points[:, own].T - centre, axis=1).max() <= radius + 1e-9
        table = priorities(objects)
        assert np.array_equal(table == IN_FRONT, (table == BEHIND).T)
        obscured = wholly_hidden(objects)
        assert obscured.shape == (len(items),) and not obscured.all()
        seen = {int(k) for layer in draw(scene, camera).layers for paths in layer.strokes for k in paths.item}
        assert not seen & set(np.flatnonzero(obscured).tolist())
        # The contour of each: the edges between faces that look at this eye or light and others, joined to closed ones.
        centre = (*camera.direction, 0.0) if camera.parallel else camera.eye
        for item in items:
            corner = item.mesh.vertices[item.mesh.corners[item.mesh.offsets[:-1]]]
            way = np.array(camera.direction) if camera.parallel else np.array(camera.eye) - corner
            looks = (item.mesh.face_normals * way).sum(axis=1) > 1e-9 * np.abs(way).max()
            across = neighbour_faces(item.mesh)
            contour = contour_branches(item.mesh, centre)
            assert contour.closed.all() and len(contour.points) >= 3
            if (across != NO_FACE).all():
                assert 2 * len(contour.points) == (looks[item.mesh.corner_face] != looks[across]).sum()
        # The planes that keep two objects apart do so, as the record of the pair says.
        first, second = np.triu_indices(len(items), 1)
        record = separations(objects.around, first, second)
        for k in np.flatnonzero(np.abs(record.info) == FIRST_ABOVE):
            for sign, item in ((record.info[k], first[k]), (-record.info[k], second[k])):
                own = points[:, first_vertex[item] : first_vertex[item + 1]]
                assert (sign * (record.planes[k, :3] @ own - record.planes[k, 3]) >= -1e-8).all()


@pytest.mark.capability("G3.2-face")
@pytest.mark.parametrize("name", ["pencil", "cubes", "town", "table"])
def test_incidence_shade_and_dark_flag_of_every_face_in_every_lights_system(name):
    scene = read(DATA / f"{name}.scene")
    lights = (Light((3, -4, 5), parallel=True, intensity=1.0), Light((-60, 30, 90), intensity=0.7))
    scene = replace(scene, lights=lights)
    view = look(scene, scene.camera)
    here = view_lights(view, lights)
    found = face_shades(view, scene.items, here)
    normals, middles = face_normals(view), face_middles(view)
    towards_eye = view.eye[:, None] - middles
    seen = (normals * towards_eye).sum(axis=0) > 1e-9
    for number, light in enumerate(here):
        place = np.array(light.position)[:, None]
        way = np.broadcast_to(place, middles.shape) if light.parallel else place - middles
        incidence = (normals * way).sum(axis=0) / np.linalg.norm(way, axis=0)
        sure = (np.abs(incidence) > 1e-9) & seen
        assert np.array_equal(found.backlit[number][sure], incidence[sure] < 0)
        assert (found.shares[number] >= 0).all()
    assert ((found.total >= 0) & (found.total <= 1)).all()
