import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look, pools
from vectorplot.shading.shadow_maps import aimed_system
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.testing.shapes import box, rotated_boxes
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces

CAMERAS = [
    Camera((8.0, -9.0, 7.0), (0.5, 0.2, -0.3), twist_deg=20.0),
    Camera((8.0, -9.0, 7.0), (0.5, 0.2, -0.3), parallel=True),
    Camera.view("top", (0.1, 0.2, 0.3), 4.0),
]


def world_image(view: View, points: np.ndarray) -> np.ndarray:
    """Images (n,2) in world units by the view's homogeneous matrix."""
    rows = np.column_stack([points, np.ones(len(points))]) @ view.image_from_world.T
    return rows[:, :2] / rows[:, 2:]


@pytest.mark.parametrize("camera", CAMERAS)
def test_points_come_back_to_the_world(camera: Camera) -> None:
    scene = rotated_boxes(5)
    view = look(scene, camera)
    assert np.allclose(view.world_of(view.points), scene.vertices, atol=1e-12)
    assert np.allclose(view.points_of(scene.vertices), view.points, atol=1e-12)


@pytest.mark.parametrize("camera", CAMERAS)
def test_image_and_matrix_agree(camera: Camera) -> None:
    scene = rotated_boxes(5)
    view = look(scene, camera)
    assert np.allclose(world_image(view, scene.vertices).T, view.scale * view.image, atol=1e-10)


@pytest.mark.capability("G3.1-screen-pool")
@pytest.mark.parametrize("camera", CAMERAS[:1])
def test_the_whole_pool_is_seen_as_point_by_point(camera: Camera) -> None:
    scene = rotated_boxes(6)
    view = look(scene, camera)
    system = CoordinateSystem.of_image(camera)
    for point, image, depth in zip(scene.vertices, view.image.T, view.depth, strict=True):
        x, y, z = system.from_world(point)
        factor = camera.distance / (view.focus * view.scale)
        assert np.allclose(view.scale * image * factor, (x, y), atol=1e-9)
        assert np.isclose(view.scale * depth, camera.distance - z, atol=1e-9)


@pytest.mark.capability("G3.1-light-pool")
@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_every_lights_pool_is_what_it_sees_point_by_point(count: int, size: float) -> None:
    """Those of all lights, the last one too (erratum G3-02), every point at its own place (erratum G3-05)."""
    boxes = rotated_boxes(6)
    meshes = [item.mesh for item in boxes.items]
    items = (Item(f"B{k}", Mesh(size * m.vertices, m.corners, m.offsets)) for k, m in enumerate(meshes))
    random = np.random.default_rng(count)
    lights = tuple(
        Light(tuple(size * random.uniform(20, 40, 3)), parallel=bool(k % 2), name=f"L{k}") for k in range(count)
    )
    scene = Scene(tuple(items), lights)
    middle = tuple(scene.bounds.mean(axis=0))
    for light in scene.lights:
        place = tuple(np.add(middle, light.position)) if light.parallel else light.position
        view = look(scene, Camera(place, middle, parallel=light.parallel))
        system = aimed_system(light, scene.vertices)
        for number, point in enumerate(scene.vertices):
            x, y, z = system.from_world(point)
            ahead = view.scale * (view.points[2, number] - view.target[2])
            assert ahead == pytest.approx(z, abs=1e-9 * size)
            scale = view.scale if light.parallel else view.scale * system.distance / (view.focus * view.scale)
            assert scale * view.image[:, number] == pytest.approx((x, y), abs=1e-8 * size)
        assert view.points.shape[1] == len(scene.vertices) == pools(scene).item_vertices[-1]


@pytest.mark.capability("G3.1-screen-pool")
def test_points_behind_the_eye_are_told() -> None:
    scene = Scene((Item("box", box((-1, -1, -1), (1, 1, 1))),))
    view = look(scene, Camera((0.0, 0.0, 0.5), (0.0, 0.0, -5.0)))
    assert (view.depth < view.near).sum() == 4
    assert np.isfinite(view.image).all()
    # Half of the points lie in the plane through the eye; the edges to the others are cut before they are divided.
    scene = Scene((Item("box", box((-1, -1, -1), (1, 1, 1))),))
    camera = Camera((0.0, 0.0, 1.0), (0.0, 0.0, -5.0), fov_deg=90.0)
    view = look(scene, camera)
    behind = view.depth < view.near
    assert behind.sum() == 4 and view.depth[behind] == pytest.approx(0.0, abs=1e-15)
    assert np.isfinite(view.image).all()
    seen = np.concatenate([p.points3d for layer in draw(scene, camera, fit=False).layers for p in layer.strokes])
    assert np.isfinite(seen).all() and (seen[:, 2] < 1.0).all() and seen[:, 2].min() == pytest.approx(-1.0)


def test_the_scene_fills_the_unit_box_wherever_it_is() -> None:
    mesh = box((0, 0, 0), (1, 2, 3))
    for scale, offset in ((1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        vertices = mesh.vertices * scale + offset
        scene = Scene((Item("box", Mesh(vertices, mesh.corners, mesh.offsets)),))
        middle = scene.bounds.mean(axis=0)
        view = look(scene, Camera(tuple(middle + np.array([5.0, -6.0, 4.0]) * scale), tuple(middle)))
        expected = look(Scene((Item("box", mesh),)), Camera((5.5, -5.0, 5.5), (0.5, 1.0, 1.5))).points
        assert np.allclose(view.points, expected, atol=1e-9)
        assert np.abs(view.points).max() <= np.sqrt(3.0)


def test_a_scene_lost_in_rounding_is_refused() -> None:
    mesh = box((0, 0, 0), (1e-9, 1e-9, 1e-9))
    lost = Scene((Item("speck", Mesh(mesh.vertices + 1e6, mesh.corners, mesh.offsets)),))
    with pytest.raises(InputError, match="too small"):
        look(lost, Camera((2e6, 0.0, 0.0), (1e6, 1e6, 1e6)))


def test_faces_that_are_not_present_are_left_out() -> None:
    closed = box((0, 0, 0), (1, 1, 1))
    present = np.arange(6) != 2
    scene = Scene((Item("a", closed), Item("b", Mesh(closed.vertices, closed.corners, closed.offsets, present))))
    view = look(scene, CAMERAS[0])
    assert np.bincount(view.face_item).tolist() == [6, 5]


@pytest.mark.capability("G5.1-facetypes")
@pytest.mark.parametrize("camera", CAMERAS)
def test_a_face_shows_the_side_that_looks_at_the_eye(camera: Camera) -> None:
    scene = rotated_boxes(8)
    facing = project_faces(look(scene, camera)).facing
    expected = []
    for item in scene.items:
        corner = item.shape.vertices[item.shape.corners[item.shape.offsets[:-1]]]
        ray = camera.direction if camera.parallel else np.asarray(camera.eye) - corner
        expected.append(np.sign((item.shape.face_normals * ray).sum(axis=1)))
    assert np.array_equal(facing, np.concatenate(expected).astype(np.int8))


@pytest.mark.capability("G5.1-facetypes")
@pytest.mark.hard(1)
def test_a_face_seen_edge_on_shows_neither_side() -> None:
    scene = Scene((Item("box", box((-1, -1, -1), (1, 1, 1))),))
    assert sorted(project_faces(look(scene, Camera.view("front"))).facing.tolist()) == [-1, 0, 0, 0, 0, 1]


def test_an_empty_scene_has_an_empty_view() -> None:
    view = look(Scene(()), Camera((1.0, 0.0, 0.0)))
    assert view.face_count == 0 and view.points.shape == (3, 0)


@pytest.mark.parametrize("camera", CAMERAS)
def test_smooth_items_have_no_points_and_no_faces_but_keep_their_numbers(camera: Camera) -> None:
    boxes = rotated_boxes(3).items
    mixed = Scene((Item("S1", Torus()), boxes[0], Item("S2", ImplicitTorus()), *boxes[1:], Item("S3", Torus())))
    view = look(mixed, camera)
    assert np.diff(view.item_vertices).tolist() == [0, 8, 0, 8, 8, 0]
    assert np.unique(view.face_item).tolist() == [1, 3, 4]
    assert len(view.occludes) == 6
    assert np.array_equal(view.world_of(view.points).round(9), mixed.vertices.round(9))
    assert not solid_items(view, project_faces(view))[[0, 2, 5]].any()


def test_a_scene_of_surfaces_alone_is_in_the_unit_box() -> None:
    view = look(Scene((Item("RING", Torus(3.0, 1.0)),)), CAMERAS[0])
    assert len(view) == 0 and view.points.shape == (3, 0)
    assert view.scale == pytest.approx(4.0)
