import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, hollow_bodies, random_convex_solids, torus_mesh
from vectorplot.visibility.polyhedra.occluders import Occluders, face_occluders, solid_items, solid_occluders
from vectorplot.visibility.projected_faces import project_faces

CAMERA = Camera((6.0, -7.0, 5.0))


def hides(occluders: Occluders, points: np.ndarray) -> np.ndarray:
    """(k,n) which occluder hides which point (3,n)."""
    heights = occluders.planes[:3].T @ points - occluders.planes[3][:, None]
    return np.array(
        [(heights[a:b] > 1e-9).all(axis=0) for a, b in zip(occluders.offsets[:-1], occluders.offsets[1:], strict=True)]
    )


@pytest.mark.capability("G5.1-convex")
def test_a_convex_solid_hides_what_its_front_faces_hide() -> None:
    scene = random_convex_solids(6, 2)
    view = look(scene, CAMERA)
    faces = project_faces(view)
    items = np.flatnonzero(solid_items(view, faces))
    assert len(items) == 6
    points = np.random.default_rng(0).uniform(-1.5, 1.5, (3, 4000))
    by_solid = hides(solid_occluders(view, faces, items), points)
    which = np.flatnonzero(faces.facing > 0)
    by_face = hides(face_occluders(view, faces, which), points)
    for item in items:
        assert np.array_equal(by_solid[item], by_face[view.face_item[which] == item].any(axis=0))


@pytest.mark.capability("G5.1-hollow")
def test_a_hollow_body_hides_through_both_sides_of_its_faces() -> None:
    scene = hollow_bodies()
    view = look(scene, CAMERA)
    faces = project_faces(view)
    hollow = ~solid_items(view, faces)
    assert hollow[[item.shape.present is not None for item in scene.items]].all()
    backs = np.flatnonzero((faces.facing < 0) & hollow[view.face_item])
    inside = np.stack(
        [view.points[:, view.corners[view.offsets[f] : view.offsets[f + 1]]].mean(axis=1) for f in backs], 1
    )
    behind = inside - 0.2 * (view.eye[:, None] - inside)
    assert hides(face_occluders(view, faces, backs), behind).diagonal().all()


def test_only_closed_convex_bodies_seen_from_outside_are_solids() -> None:
    whole = box((-1, -1, -1), (1, 1, 1))
    opened = Mesh(whole.vertices, whole.corners, whole.offsets, np.arange(6) != 1)
    dented = Mesh(np.where(whole.vertices == whole.vertices[0], 0.1, whole.vertices), whole.corners, whole.offsets)
    scene = Scene(
        tuple(Item(str(k), mesh) for k, mesh in enumerate((whole, opened, whole.reversed(), torus_mesh(), dented)))
    )
    view = look(scene, CAMERA)
    assert solid_items(view, project_faces(view)).tolist()[:4] == [True, False, False, False]
    inside = look(Scene(scene.items[:1]), Camera((0.1, 0.2, 0.3), (3.0, 2.0, 1.0)))
    assert solid_items(inside, project_faces(inside)).tolist() == [False]


def test_what_does_not_occlude_is_no_solid() -> None:
    scene = Scene((Item("glass", box((-1, -1, -1), (1, 1, 1)), occludes=False),))
    view = look(scene, CAMERA)
    assert solid_items(view, project_faces(view)).tolist() == [False]


@pytest.mark.parametrize("times", [2, 3])
@pytest.mark.parametrize("flat", [False, True])
def test_faces_listed_several_times_hide_like_one(times: int, flat: bool) -> None:
    triangle = Mesh.from_polygons([[-2, -2, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2], [0, 2, 1]] * 2)
    once = triangle if flat else box((-1.0, -1.5, -0.5), (1.0, 1.5, 0.5))
    again = Mesh.from_polygons(once.vertices, once.polygons() * times)
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 4000))
    found = []
    for mesh in (once, again):
        view = look(Scene((Item("A", mesh),)), CAMERA)
        faces = project_faces(view)
        assert solid_items(view, faces).all()
        solid = hides(solid_occluders(view, faces, np.array([0])), points)[0]
        front = face_occluders(view, faces, np.flatnonzero(faces.facing > 0))
        assert (solid == hides(front, points).any(axis=0)).all()
        found.append(solid)
    assert found[0].any() and (found[0] == found[1]).all()
