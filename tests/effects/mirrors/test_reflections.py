from dataclasses import replace

import numpy as np
import pytest
from support.effort import several
from support.seen_rays import sight_rays, topmost, triangles
from support.triangle_rays import first_hits

from vectorplot.effects.mirrors import Mirrors, mirrored_view, mirrors, reflections
from vectorplot.effects.windows import SeenThrough
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import revolution
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import project_faces

MIRROR = Material("mirror")
RING = revolution(np.array([(1.2, 0, -0.5), (1.6, 0, 0), (1.2, 0, 0.5), (0.8, 0, 0), (1.2, 0, -0.5)]), 8)


def sheet(height: float, size: float = 5.0) -> Mesh:
    corners = [(-size, -size, height), (size, -size, height), (size, size, height), (-size, size, height)]
    return Mesh.from_polygons(corners, [[0, 1, 2, 3]])


def turned(mesh: Mesh, random: np.random.Generator, centre: np.ndarray) -> Mesh:
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix[:, 0] *= np.sign(np.linalg.det(matrix))
    return Mesh(mesh.vertices @ matrix.T + centre, mesh.corners, mesh.offsets)


def random_scene(seed: int) -> tuple[Scene, Camera]:
    """Boxes and rings, piercing each other and the mirrors: some sheets, some boxes."""
    random = np.random.default_rng(seed)
    items = []
    for k in range(random.integers(1, 8)):
        half = random.uniform(0.3, 1.2, 3)
        shape = box(-half, half) if k % 4 else RING
        items.append(Item(f"B{k}", turned(shape, random, random.uniform((-3, -3, -1), (3, 3, 5)))))
    for k in range(random.integers(1, 4)):
        half = random.uniform(0.5, 2.5, 3)
        shape = sheet(random.uniform(-3, 1)) if k % 2 else turned(box(-half, half), random, random.uniform(-4, 4, 3))
        items.append(Item(f"M{k}", shape, material=MIRROR))
    eye = random.normal(size=3)
    eye *= random.uniform(8, 20) / np.linalg.norm(eye)
    eye[2] = abs(eye[2])
    camera = Camera(eye=tuple(eye), target=(0.0, 0.0, 1.0), parallel=seed % 3 == 0)
    return Scene(tuple(items)), camera


class Picture:
    """A scene with its reflections."""

    def __init__(self, scene: Scene, camera: Camera) -> None:
        self.view: View = look(scene, camera)
        projected = project_faces(self.view)
        self.painted: ImageFaces = painters_order(self.view, projected).faces
        self.mirrors: Mirrors = mirrors(scene, self.view, projected)
        self.seen: SeenThrough = reflections(self.view, self.mirrors, self.painted)
        self.is_mirror = np.isin(np.arange(self.view.face_count), self.mirrors.face)

    def painted_at(self, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The face at each sample, and in mirrors the face of the double, -1 for none; -2 elsewhere."""
        top = topmost(self.painted.points, self.painted.offsets, samples)
        face = np.where(top >= 0, self.painted.source[top], -1)
        double = np.where((face >= 0) & self.is_mirror[face], -1, -2)
        for window in np.unique(self.seen.window):
            shown = np.flatnonzero(self.seen.window == window)
            position, offsets = ragged.take(self.seen.offsets, shown)
            here = np.flatnonzero(top == window)
            at = topmost(self.seen.points[:, position], offsets, samples[:, here])
            double[here] = np.where(at >= 0, self.seen.source[shown][at], -1)
        return face, double

    def true_at(self, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same by rays, mirrored where they meet a mirror."""
        corners, faces = triangles(self.view)
        origin, direction = sight_rays(self.view, samples)
        face, far = first_hits(origin, direction, corners, faces)
        double = np.full(len(face), -2)
        at = np.flatnonzero((face >= 0) & self.is_mirror[face])
        if len(at):
            plane = np.full(self.view.face_count, -1)
            plane[self.mirrors.face] = self.mirrors.plane
            normal = self.mirrors.normal[:, plane[face[at]]].T
            ray = direction[at]
            double[at], _ = first_hits(
                origin[at] + far[at, None] * ray,
                ray - 2.0 * (ray * normal).sum(axis=1, keepdims=True) * normal,
                corners,
                faces,
            )
        return face, double


@pytest.mark.slow
@pytest.mark.capability("G6.4-reflect")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("start", range(0, 100, 25))
def test_what_is_seen_in_a_mirror_is_what_the_mirrored_ray_meets(start: int) -> None:
    random = np.random.default_rng(start)
    seen = checked = 0
    scenes = several(6, long=25)
    for seed in range(start, start + scenes):
        picture = Picture(*random_scene(seed))
        low, high = picture.view.image.min(axis=1), picture.view.image.max(axis=1)
        samples = low[:, None] + random.uniform(size=(2, 150)) * (high - low)[:, None]
        steps = 2e-3 * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1]]).T
        # Samples and what is beside them in one call.
        near = [part.reshape(7, -1) for part in picture.true_at((samples[:, None] + steps[:, :, None]).reshape(2, -1))]
        face, double = (part[0] for part in near)
        steady = np.logical_and.reduce([(part == part[0]).all(axis=0) for part in near])
        painted, reflected = picture.painted_at(samples)
        assert (painted == face)[steady].all()
        assert (reflected == double)[steady].all()
        seen += int((double >= 0).sum())
        checked += int(steady.sum())
    assert seen > 20 and checked > 0.5 * scenes * 150


@pytest.mark.capability("G6.4-reflect")
def test_the_mirror_image_of_a_point() -> None:
    normal, point = np.array([[1.0], [2.0], [2.0]]) / 3.0, np.array([[5.0], [0.0], [0.0]])
    none = np.zeros(0, dtype=np.intp)
    image = Mirrors(normal, point, none, none).reflected(0, np.array([[3.0], [-2.0], [4.0]]))
    assert np.allclose(image[:, 0], [2.55555555555556, -2.88888888888889, 3.11111111111111], atol=1e-14)


def on_a_mirror(scale: float = 1.0, shift: float = 0.0) -> tuple[Scene, Camera]:
    """A box that stands on a mirror, and one that hangs above it."""
    shapes = (sheet(0.0), box((-1, -1, 0), (1, 1, 2)), box((1.5, 1.5, 1.0), (2.5, 2.5, 1.5)))
    moved = [Mesh(scale * m.vertices + shift, m.corners, m.offsets) for m in shapes]
    items = (Item("M", moved[0], material=MIRROR), Item("A", moved[1]), Item("B", moved[2]))
    eye = tuple(scale * np.array([9.0, -12.0, 5.0]) + shift)
    return Scene(items), Camera(eye=eye, target=(shift,) * 3)


def outlines(picture: Picture) -> list[tuple[int, np.ndarray]]:
    seen = picture.seen
    return [
        (int(face), seen.points[:, a:b])
        for face, a, b in zip(seen.source, seen.offsets[:-1], seen.offsets[1:], strict=True)
    ]


@pytest.mark.hard(19)
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_a_mirror_shows_the_same_at_any_size_and_place(scale: float, shift: float) -> None:
    plain, moved = Picture(*on_a_mirror()), Picture(*on_a_mirror(scale, shift))
    assert len(plain.seen) == len(moved.seen) > 5
    for (face, one), (other, two) in zip(outlines(plain), outlines(moved), strict=True):
        assert face == other and one.shape == two.shape
        assert np.allclose(one, two, atol=1e-7 if shift else 1e-12)


@pytest.mark.capability("G6.4-window-test")
def test_doubles_wholly_within_the_window_keep_every_digit_and_those_beside_it_are_not_looked_at() -> None:
    picture = Picture(*on_a_mirror())
    view, seen = picture.view, picture.seen
    doubles = image_points(view, picture.mirrors.reflected(0, view.points))
    assert {int(view.face_item[face]) for face in seen.source} == {1, 2}
    for face, polygon in outlines(picture):
        corners = doubles[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        assert {tuple(p) for p in polygon.T} == {tuple(p) for p in corners.T}
    # In a window that shows nothing of them there is nothing to sort.
    corner = np.array([[0.9], [1.0], [0.9], [1.0]]) * np.abs(view.image).max()
    assert len(mirrored_view(view, picture.mirrors, 0, corner)[0]) == 0


@pytest.mark.capability("G6.4-window-test")
def test_doubles_that_reach_beyond_the_window_end_at_its_border() -> None:
    shapes = (Item("M", sheet(0.0, 1.0), material=MIRROR), Item("A", box((-3, -0.5, 1), (3, 0.5, 2))))
    picture = Picture(Scene(shapes), Camera(eye=(1.0, -9.0, 6.0), target=(0.0, 0.0, 0.0)))
    mirror = int(np.argmax(picture.painted.source == picture.mirrors.face[0]))
    assert (picture.seen.window == mirror).all() and len(picture.seen)
    window = picture.painted.points[:2, picture.painted.offsets[mirror] : picture.painted.offsets[mirror + 1]]
    along = np.roll(window, -1, axis=1) - window
    arm = picture.seen.points[:2, :, None] - window[:, None, :]
    assert (along[0] * arm[1] - along[1] * arm[0] > -1e-12).all()
    assert np.ptp(picture.seen.points[0]) == pytest.approx(np.ptp(window[0]), rel=0.3)


@pytest.mark.slow
@pytest.mark.hard(32)
def test_the_order_of_the_items_does_not_matter() -> None:
    scene, camera = random_scene(4)
    back = replace(scene, items=scene.items[::-1])
    one, two = Picture(scene, camera), Picture(back, camera)
    random = np.random.default_rng(0)
    samples = random.uniform(one.view.image.min(axis=1), one.view.image.max(axis=1), (2000, 2)).T
    faces = np.argsort(-two.view.face_item, kind="stable")
    number = np.append(np.empty(len(faces), dtype=int), -1)
    number[faces] = np.arange(len(faces))
    number = np.append(number, -2)
    for a, b in zip(one.painted_at(samples), two.painted_at(samples), strict=True):
        assert (a == np.where(b < 0, b, number[b])).mean() > 0.999


def test_mirrors_seen_from_behind_or_edge_on_and_scenes_without_any() -> None:
    for eye in ((3.0, 2.0, -9.0), (3.0, 9.0, 0.0)):
        scene, _ = on_a_mirror()
        picture = Picture(scene, Camera(eye=eye, target=(0.0, 0.0, 0.0)))
        assert len(picture.seen) == len(picture.mirrors) == 0
    plain = Picture(Scene((Item("A", box((0, 0, 0), (1, 1, 1))),)), Camera(eye=(5.0, 4.0, 3.0)))
    assert len(plain.seen) == 0
    assert len(Picture(Scene(()), Camera(eye=(5.0, 4.0, 3.0))).seen) == 0


def test_tiles_in_one_plane_are_one_mirror() -> None:
    corners = [(x, y, 0) for y in range(4) for x in range(4)]
    faces = [[4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4] for y in range(3) for x in range(3)]
    tiles = Item("TILES", Mesh.from_polygons(corners, faces), material=MIRROR)
    scene = Scene((tiles, Item("A", box((1, 1, 0.5), (2, 2, 1.0)))))
    picture = Picture(scene, Camera(eye=(4.0, -6.0, 5.0), target=(1.5, 1.5, 0.0)))
    assert len(picture.mirrors) == 1 and len(picture.mirrors.face) == 9
    assert (np.diff(picture.seen.window) >= 0).all()
    assert (picture.painted.source[picture.seen.window] == picture.seen.pane).all()
