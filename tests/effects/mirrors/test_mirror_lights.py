import numpy as np
import pytest
from support.effort import several
from support.seen_rays import topmost, triangles
from support.triangle_rays import first_hits

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.mirror_lights import MIRRORED_SHARE, LightDouble, light_doubles, mirror_light
from vectorplot.effects.mirrors import mirror_faces, mirrors_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import newell, project_faces

MIRROR = Material("mirror")
FLOOR = Mesh.from_polygons([(-6, -6, -2), (6, -6, -2), (6, 6, -2), (-6, 6, -2)], [[0, 1, 2, 3]])


def turned_box(random: np.random.Generator, half: np.ndarray, centre: np.ndarray) -> Mesh:
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix[:, 0] *= np.sign(np.linalg.det(matrix))
    mesh = box(-half, half)
    return Mesh(mesh.vertices @ matrix.T + centre, mesh.corners, mesh.offsets)


def some_faces(mesh: Mesh, count: int) -> Mesh:
    """The first faces of a mesh: fewer than all of a body are an open thing."""
    return Mesh(mesh.vertices, mesh.corners[: mesh.offsets[count]], mesh.offsets[: count + 1])


def random_scene(seed: int, mirror_faces: int = 6) -> tuple[Scene, Camera]:
    """Boxes over a floor, and a box that is a mirror, or some of its faces."""
    random = np.random.default_rng(seed)
    items = [
        Item(f"B{k}", turned_box(random, random.uniform(0.3, 1.2, 3), random.uniform((-3, -3, -1), (3, 3, 5))))
        for k in range(random.integers(1, 5))
    ]
    items.append(Item("FLOOR", FLOOR))
    mirror = turned_box(random, random.uniform(1.0, 2.5, 3), random.uniform(-4, 4, 3))
    items.append(Item("M", some_faces(mirror, mirror_faces), material=MIRROR))
    lights = (Light(tuple(8.0 * random.normal(size=3))), Light(tuple(random.normal(size=3)), parallel=True))
    eye = random.normal(size=3)
    eye *= random.uniform(8, 20) / np.linalg.norm(eye)
    eye[2] = abs(eye[2])
    return Scene(tuple(items), lights), Camera(eye=tuple(eye))


class Lit:
    """A scene with the light that its mirrors throw back, in the view, and the same by rays."""

    def __init__(self, scene: Scene, camera: Camera) -> None:
        self.view: View = look(scene, camera)
        self.projected = project_faces(self.view)
        self.mirrors = mirrors_of(self.view, mirror_faces(scene, self.view))
        self.doubles = light_doubles(self.view, self.mirrors, scene.lights)
        self.decals = mirror_light(self.view, self.mirrors, self.doubles, self.projected)
        self.normals = newell(self.view, np.arange(self.view.face_count))[0]
        self.triangles = triangles(self.view)

    def in_view(self, light: Light) -> np.ndarray:
        if light.parallel:
            return self.view.axes @ np.array(light.position) / np.linalg.norm(light.position)
        return self.view.points_of(np.array([light.position]))[:, 0]

    def by_rays(self, face: int, points: np.ndarray, double: LightDouble, light: Light) -> np.ndarray:
        """Which points (n,3) of a face the light reaches by way of the mirror."""
        place, source = self.in_view(double.light), self.in_view(light)
        normal, corner = self.mirrors.normal[:, double.plane], self.mirrors.point[:, double.plane]
        ray = np.broadcast_to(place, points.shape) if light.parallel else place - points
        to_eye = self.view.eye - points
        seen = (ray @ self.normals[:, face]) * (to_eye @ self.normals[:, face]) > 0.0
        hit, far = first_hits(points, ray, *self.triangles)
        seen &= np.isin(hit, self.mirrors.face[self.mirrors.plane == double.plane])
        seen &= ((points - corner) @ normal > 1e-9) & ((far < 1.0) | light.parallel)
        mirror = points + np.where(np.isfinite(far), far, 0.0)[:, None] * ray
        onwards = np.broadcast_to(source, points.shape) if light.parallel else source - mirror
        _, free = first_hits(mirror, onwards, *self.triangles)
        return seen & (np.isinf(free) | ((free >= 1.0) & (not light.parallel)))

    def by_decals(self, face: int, points: np.ndarray, number: int) -> np.ndarray:
        decals = self.decals
        mine = np.flatnonzero((decals.face == face) & (decals.level // 2 == number))
        axes = np.argsort(np.abs(self.normals[:, face]))[:2]
        lit = np.zeros(len(points), dtype=bool)
        for k in mine[np.argsort(decals.level[mine], kind="stable")]:
            ring = decals.points[axes, decals.offsets[k] : decals.offsets[k + 1]]
            lit[topmost(ring, np.array([0, ring.shape[1]]), points[:, axes].T) >= 0] = decals.light[k] >= 0
        return lit


@pytest.mark.slow
@pytest.mark.capability("G6.4-light-double")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("mirror_faces", [6, 5])
def test_light_by_way_of_mirrors_falls_where_rays_find_it(mirror_faces: int) -> None:
    random = np.random.default_rng(1)
    checked = bright = 0
    for seed in range(several(12, long=40)):
        scene, camera = random_scene(seed, mirror_faces)
        lit = Lit(scene, camera)
        for number, double in enumerate(lit.doubles):
            light = scene.lights[double.source]
            for face in drawn_faces(lit.view, lit.projected).tolist():
                corners = lit.view.points[:, lit.view.corners[lit.view.offsets[face] : lit.view.offsets[face + 1]]]
                points = (corners @ random.dirichlet(np.ones(corners.shape[1]), 20).T).T
                across = np.linalg.svd(lit.normals[:, face][None])[2][1:]
                steps = 2e-3 * np.concatenate([np.zeros((1, 3)), across, -across])
                # Places and their neighbours in one call: it takes longer than its rays.
                near = lit.by_rays(face, (points + steps[:, None]).reshape(-1, 3), double, light).reshape(5, -1)
                true, steady = near[0], (near == near[0]).all(axis=0)
                assert (lit.by_decals(face, points, number) == true)[steady].all()
                checked += int(steady.sum())
                bright += int(true.sum())
    assert checked > 2000 and bright > 60


@pytest.mark.capability("G6.4-light-double")
def test_the_double_of_a_light_is_its_mirror_image_and_weaker() -> None:
    mirror = Item("M", Mesh.from_polygons([(0, -5, -5), (0, 5, -5), (0, 5, 5), (0, -5, 5)], [[0, 1, 2, 3]]))
    mirror = Item("M", mirror.shape, material=MIRROR)
    lights = (
        Light((4.0, 1.0, 2.0), name="LAMP"),
        Light((3.0, 2.0, 1.0), parallel=True, intensity=0.8),
        Light((-1, 0, 0)),
    )
    scene = Scene((mirror,), lights)
    lit = Lit(scene, Camera(eye=(9.0, 3.0, 4.0)))
    assert [(d.source, d.plane) for d in lit.doubles] == [(0, 0), (1, 0)]
    lamp, sun = (d.light for d in lit.doubles)
    assert np.allclose(lamp.position, (-4.0, 1.0, 2.0), atol=1e-14) and lamp.name == "LAMP*"
    assert np.allclose(sun.position, (-3.0, 2.0, 1.0), atol=1e-14) and sun.parallel
    assert sun.intensity == MIRRORED_SHARE * 0.8
    assert np.isclose(lamp.intensity, MIRRORED_SHARE / np.sqrt(3.0))


@pytest.mark.spread
@pytest.mark.parametrize("sun", [(1.0, 0.0, 1.0), (2.0, -0.5, 3.0), (1.0, 1.0, 0.7)])
@pytest.mark.parametrize("eye", [(6.0, -9.0, 7.0), (2.0, 3.0, 9.0)])
@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize("parallel", [False, True])
def test_an_open_mirror_is_not_in_the_way_of_its_own_light(sun, eye, turn, parallel) -> None:
    corners = np.roll([(0, -1, 1), (0, 1, 1), (0, 1, 2), (0, -1, 2)], turn, axis=0)
    mirror = Item("M", Mesh.from_polygons(corners, [[0, 1, 2, 3]]), material=MIRROR)
    lights = (Light(sun, parallel=True), Light(tuple(9.0 * np.array(sun))))
    lit = Lit(Scene((mirror, Item("F", FLOOR)), lights), Camera(eye=eye, parallel=parallel, height=9.0))
    assert (lit.decals.light >= 0).all() and len(lit.decals) == 2


def test_a_window_throws_its_own_shape_on_the_floor() -> None:
    # The sun at 45 degrees: a mirror 2 wide and 1 high, upright over the floor at height 1.
    mirror = Mesh.from_polygons([(0, -1, 1), (0, 1, 1), (0, 1, 2), (0, -1, 2)], [[0, 1, 2, 3]])
    floor = Mesh.from_polygons([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [[0, 1, 2, 3]])
    items = (Item("M", mirror, material=MIRROR), Item("F", floor))
    scene = Scene(items, (Light((1.0, 0.0, 1.0), parallel=True),))
    lit = Lit(scene, Camera(eye=(6.0, -9.0, 7.0)))
    decals = lit.decals
    bright = decals.of(np.flatnonzero(decals.light == 0))
    assert (bright.kind == FillKind.LIGHT).all() and len(bright) == 1
    world = lit.view.world_of(bright.points)
    assert np.allclose(np.sort(world[:, 0]), [1, 1, 2, 2]) and np.allclose(np.sort(world[:, 1]), [-1, -1, 1, 1])


def test_no_light_comes_from_mirrors_that_are_not_lit() -> None:
    scene, camera = random_scene(0)
    dark = Lit(Scene(scene.items), camera)
    assert dark.doubles == () and len(dark.decals) == 0
    plain = Lit(Scene(scene.items[:-1], scene.lights), camera)
    assert plain.doubles == () and len(plain.decals) == 0
