import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, cyclic_bars, interpenetrating_boxes, rotated_boxes
from vectorplot.textbook.framebuffer import Erased, erasing_edges, interleaved
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points
from vectorplot.visibility.painter.painters_order import painters_order

CAMERA = Camera(eye=(9.0, -12.0, 7.0))


def painted(scene: Scene, camera: Camera = CAMERA) -> tuple[View, ImageFaces, Erased]:
    view = look(scene, camera)
    faces = painters_order(view).faces
    return view, faces, erasing_edges(view, faces)


def left_over(faces: ImageFaces, erased: Erased, share: float) -> np.ndarray:
    """(e,) whether the points that divide edges like this are covered by no later polygon."""
    spots = (1.0 - share) * erased.start[:2] + share * erased.end[:2]
    after = np.repeat(np.arange(len(faces)), np.diff(erased.first))
    seen = np.ones(len(erased), dtype=bool)
    for k in range(len(faces)):
        ring = faces.points[:2, faces.offsets[k] : faces.offsets[k + 1]]
        along = np.roll(ring, -1, axis=1) - ring
        length = np.hypot(*along)
        height = (
            along[0][:, None] * (spots[1] - ring[1][:, None]) - along[1][:, None] * (spots[0] - ring[0][:, None])
        ) / length[:, None]
        seen &= ~((height > 1e-7).all(axis=0) & (after < k))
    return seen


def visible(view: View, points: np.ndarray) -> np.ndarray:
    """(n,) whether nothing is between points (3,n) of the view and the eye."""
    seen = np.ones(points.shape[1], dtype=bool)
    ray = view.eye[:, None] - points
    for face in range(view.face_count):
        ring = view.points[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        normal = np.cross(ring[:, 1] - ring[:, 0], ring[:, 2] - ring[:, 0])
        slope = normal @ ray
        with np.errstate(divide="ignore", invalid="ignore"):
            far = normal @ (ring[:, :1] - points) / slope
            place = points + far * ray
        side = np.roll(ring, -1, axis=1) - ring
        inside = np.ones(points.shape[1], dtype=bool)
        for k in range(ring.shape[1]):
            inside &= normal @ np.cross(side[:, k, None], place - ring[:, k, None], axis=0) > 0.0
        seen &= ~(inside & (far > 1e-6))
    return seen


def in_space(view: View, points: np.ndarray) -> np.ndarray:
    """(3,n) the points of the view with these images and heights."""
    depth = view.focus**2 / (points[2] + view.focus)
    return np.stack([*(points[:2] * depth / view.focus + view.eye[:2, None]), view.eye[2] - depth])


@pytest.mark.slow
@pytest.mark.capability("G7.1-screen-hl")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", range(6))
def test_what_is_left_of_the_edges_is_what_the_eye_sees(seed: int) -> None:
    scene = rotated_boxes(12, seed) if seed else interpenetrating_boxes()
    view, faces, erased = painted(scene, Camera(eye=(9.0 + seed, -12.0, 7.0 - 2 * seed)))
    compared = 0
    along = erased.end - erased.start
    for share in (0.21, 0.5, 0.83):
        near = [visible(view, in_space(view, erased.start + at * along)) for at in (share, share - 0.01, share + 0.01)]
        steady = (near[0] == near[1]) & (near[0] == near[2])
        assert (left_over(faces, erased, share) == near[0])[steady].all()
        compared += int(steady.sum())
    assert compared > 50


@pytest.mark.hard(20)
@pytest.mark.hard(21)
@pytest.mark.parametrize("scene", [cyclic_bars(), interpenetrating_boxes()])
def test_cuts_of_the_painter_are_no_edges(scene: Scene) -> None:
    view, faces, erased = painted(scene)
    assert len(faces) > 0
    start, end = (
        image_points(view, view.points[:, view.corners]),
        image_points(view, view.points[:, view.corners[view.after(np.arange(len(view.corners)))]]),
    )
    for a, b in zip(erased.start[:2].T, erased.end[:2].T, strict=True):
        on = np.ones(start.shape[1], dtype=bool)
        for spot in (a, b):
            along, arm = end[:2] - start[:2], spot[:, None] - start[:2]
            on &= np.abs(along[0] * arm[1] - along[1] * arm[0]) < 1e-8
        assert on.any()


def test_every_edge_of_an_uncut_box_that_faces_the_eye_is_drawn_by_each_of_its_faces() -> None:
    _, faces, erased = painted(Scene((Item("A", box((0, 0, 0), (1, 2, 3))),)))
    assert len(faces) == 3 and len(erased) == 12
    assert np.diff(erased.first).tolist() == [4, 4, 4]
    assert sum(len(starts.T) for _, starts, _ in interleaved(faces, erased)) == 12


def test_diagonals_are_not_drawn_and_sides_can_be_chosen() -> None:
    ell = Mesh.from_polygons([(0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 4, 0), (0, 4, 0)], [[0, 1, 2, 3, 4, 5]])
    view, faces, erased = painted(Scene((Item("ELL", ell),)))
    assert view.is_triangular and len(erased) == 6
    none = erasing_edges(view, faces, np.zeros(len(view.corners), dtype=bool))
    assert len(none) == 0 and len(none.first) == len(faces) + 1


@pytest.mark.hard(5)
def test_edges_that_reach_behind_the_eye_end_at_the_near_plane() -> None:
    long = Scene((Item("LONG", box((-1, -50, -2), (1, 50, -1))),))
    view, _, erased = painted(long, Camera(eye=(0.0, 0.0, 0.0), target=(0.0, 5.0, -1.0)))
    assert np.isfinite(erased.start).all() and np.isfinite(erased.end).all() and len(erased) >= 3
    nearest = []
    for end in (erased.start, erased.end):
        place = in_space(view, end)
        depth = view.eye[2] - place[2]
        assert (depth > view.near * (1.0 - 1e-6)).all()
        nearest.append(depth)
        # Every end lies on an edge of the box: on two of its six planes.
        x, y, z = view.world_of(place).T
        on = [np.abs(np.abs(x) - 1), np.abs(np.abs(y) - 50), np.minimum(np.abs(z + 1), np.abs(z + 2))]
        assert (np.sum(np.array(on) < 1e-5, axis=0) >= 2).all()
    # The long edges run from far away up to the near plane.
    cut = np.isclose(np.minimum(*nearest), view.near, rtol=1e-6)
    assert cut.sum() >= 2 and (np.maximum(*nearest)[cut] > 1000.0 * view.near).all()


@pytest.mark.hard(55)
def test_nothing_in_nothing_out() -> None:
    _, faces, erased = painted(Scene(()))
    assert len(faces) == len(erased) == 0 and erased.first.tolist() == [0]
