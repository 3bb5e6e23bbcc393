import numpy as np
import pytest
import shapely
from support.effort import several
from support.seen_rays import sight_rays, topmost, triangles
from support.triangle_rays import first_hits

from vectorplot.effects.decals import Decals
from vectorplot.effects.glass import refracting_items, seen_in_glass
from vectorplot.effects.refraction import refracted
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import hull_mesh
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import newell, project_faces

WATER = Material("transparent", 0.3, 4.0 / 3.0)
FLOOR = Mesh.from_polygons([(-6, -6, -2), (6, -6, -2), (6, 6, -2), (-6, 6, -2)], [[0, 1, 2, 3]])


def glass(mesh: Mesh, c: float) -> Item:
    return Item("GLASS", mesh, material=Material("transparent", 0.3, c), occludes=False)


def turned_box(random: np.random.Generator, half: np.ndarray, centre: np.ndarray) -> Mesh:
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix[:, 0] *= np.sign(np.linalg.det(matrix))
    mesh = box(-half, half)
    return Mesh(mesh.vertices @ matrix.T + centre, mesh.corners, mesh.offsets)


def random_scene(seed: int) -> tuple[Scene, Camera]:
    """Boxes on and over a floor, in, behind and through a block of glass; the glass comes last."""
    random = np.random.default_rng(seed)
    items = [
        Item(f"B{k}", turned_box(random, random.uniform(0.3, 1.2, 3), random.uniform((-3, -3, -2), (3, 3, 4))))
        for k in range(random.integers(1, 5))
    ]
    items.append(Item("FLOOR", FLOOR))
    block = turned_box(random, random.uniform(0.8, 2.5, 3), random.uniform(-2, 2, 3))
    items.append(glass(block, float(random.choice([1.2, 1.33, 1.5]))))
    eye = random.normal(size=3)
    eye *= random.uniform(9, 20) / np.linalg.norm(eye)
    eye[2] = abs(eye[2])
    return Scene(tuple(items)), Camera(eye=tuple(eye), target=(0.0, 0.0, 1.0), parallel=seed % 4 > 0)


class Picture:
    """A scene with a block of glass as its last item."""

    def __init__(self, scene: Scene, camera: Camera, tolerance: float = 1e-3) -> None:
        self.constant = scene.items[-1].material.refraction
        self.view: View = look(scene, camera)
        self.total = np.zeros(0, dtype=bool)
        projected = project_faces(self.view)
        self.painted = painters_order(self.view, projected).faces
        self.seen = seen_in_glass(scene, self.view, projected, self.painted, tolerance)
        self.own = self.view.face_item == len(scene.items) - 1
        normal = newell(self.view, np.arange(self.view.face_count))[0]
        self.normal = (normal / np.linalg.norm(normal, axis=0)).T
        self.triangles = triangles(self.view)

    def painted_at(self, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        top = topmost(self.painted.points, self.painted.offsets, samples)
        face = np.where(top >= 0, self.painted.source[top], -1)
        behind = np.where((face >= 0) & self.own[face], -1, -2)
        for window in np.unique(self.seen.window):
            shown = np.flatnonzero(self.seen.window == window)
            position, offsets = ragged.take(self.seen.offsets, shown)
            here = np.flatnonzero(top == window)
            at = topmost(self.seen.points[:, position], offsets, samples[:, here])
            behind[here] = np.where(at >= 0, self.seen.source[shown][at], -1)
        return face, behind

    def behind(self, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The face that each ray meets in the glass or behind it, -1 for none, -2 beside the glass, and where."""
        self.place = np.zeros((samples.shape[1], 3))
        face = self.true_at(samples)[1]
        return face, self.place

    def bounced(self, start: np.ndarray, ray: np.ndarray, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What rays meet that are reflected at a wall of the glass once, and where; -1 if they do not leave then."""
        ray = ray - 2.0 * (ray * normal).sum(axis=1)[:, None] * normal
        met, far = first_hits(start, ray, *self.triangles)
        place = start + np.where(np.isfinite(far), far, 0.0)[:, None] * ray
        out = np.flatnonzero((met >= 0) & self.own[met])
        outer, total = refracted(ray[out], self.normal[met[out]], 1.0 / self.constant)
        last, far = first_hits(place[out], outer, *self.triangles)
        met[out] = np.where(total, -1, last)
        place[out] = place[out] + np.where(np.isfinite(far), far, 0.0)[:, None] * outer
        return met, place

    def true_at(self, samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The face that each ray meets, and what it meets when it has been refracted into the glass and out of it."""
        origin, direction = sight_rays(self.view, samples)
        face, far = first_hits(origin, direction, *self.triangles)
        behind = np.full(len(face), -2)
        into = np.flatnonzero((face >= 0) & self.own[face])
        self.total = np.zeros(len(face), dtype=bool)
        if not len(into):
            return face, behind
        start = origin[into] + far[into, None] * direction[into]
        ray, _ = refracted(direction[into], self.normal[face[into]], self.constant)
        met, far = first_hits(start, ray, *self.triangles)
        place = start + np.where(np.isfinite(far), far, 0.0)[:, None] * ray
        out = np.flatnonzero((met >= 0) & self.own[met])
        leaving = start[out] + far[out, None] * ray[out]
        inner, wall = ray[out], met[out]
        ray, total = refracted(inner, self.normal[wall], 1.0 / self.constant)
        last, far = first_hits(leaving, ray, *self.triangles)
        place[out] = leaving + np.where(np.isfinite(far), far, 0.0)[:, None] * ray
        met[out] = last
        self.total = np.zeros(len(face), dtype=bool)
        self.total[into[out[total]]] = True
        again = out[total]
        met[again], place[again] = self.bounced(leaving[total], inner[total], self.normal[wall[total]])
        behind[into] = met
        self.place = np.zeros((len(face), 3))
        self.place[into] = place
        return face, behind


@pytest.mark.slow
@pytest.mark.capability("G6.6-solid")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("start", [0, 11])
def test_what_is_seen_in_glass_is_what_the_refracted_ray_meets(start: int) -> None:
    random = np.random.default_rng(start)
    checked = seen = bounced = paper = 0
    for seed in range(start, start + several(4, long=11)):
        picture = Picture(*random_scene(seed))
        view = picture.view
        of_glass = view.image[:, view.item_vertices[-2] :]
        low, high = of_glass.min(axis=1), of_glass.max(axis=1)
        samples = low[:, None] + random.uniform(size=(2, 200)) * (high - low)[:, None]
        face, behind = picture.true_at(samples)
        total = picture.total
        steady = np.ones(200, dtype=bool)
        for step in ([1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1]):
            near, beside = picture.true_at(samples + 4e-3 * np.array(step)[:, None])
            steady &= (near == face) & (beside == behind)
        painted, refracted_ones = picture.painted_at(samples)
        assert (painted == face)[steady].all()
        # In a perspective a face may reflect all light in parts only, and these show nothing.
        right = refracted_ones == behind
        right |= total & (refracted_ones == -1) & (view.eye is not None)
        assert right[steady].all()
        bounced += int((right & total & (refracted_ones >= 0))[steady].sum())
        paper += int((refracted_ones != behind)[steady].sum())
        checked += int(steady.sum())
        seen += int((behind >= 0)[steady].sum())
    assert checked > 500 and seen > 50 and bounced > 5 and paper < 0.25 * bounced


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", [7, 9])
def test_many_faces_show_what_the_refracted_ray_meets(seed: int) -> None:
    """Balls of sixty triangles: some lie with all their sides on one side of the ball's axis."""
    random = np.random.default_rng(seed)
    items = [
        Item(f"B{k}", turned_box(random, random.uniform(0.3, 1.2, 3), random.uniform((-4, -4, -2), (4, 4, 5))))
        for k in range(4)
    ]
    points = random.normal(size=(30, 3))
    ball = hull_mesh(1.8 * points / np.linalg.norm(points, axis=1)[:, None])
    scene = Scene((*items, Item("FLOOR", FLOOR), glass(ball, float(random.choice([1.2, 1.33, 1.5])))))
    eye = random.normal(size=3)
    eye *= random.uniform(7, 14) / np.linalg.norm(eye)
    picture = Picture(scene, Camera(eye=(eye[0], eye[1], abs(eye[2])), target=(0, 0, 0), parallel=seed == 9), 2e-3)
    of_glass = picture.view.image[:, picture.view.item_vertices[-2] :]
    low, high = of_glass.min(axis=1), of_glass.max(axis=1)
    samples = low[:, None] + random.uniform(size=(2, 400)) * (high - low)[:, None]
    face, behind = picture.true_at(samples)
    total = picture.total
    steady = np.ones(400, dtype=bool)
    for step in ([1, 0], [-1, 0], [0, 1], [0, -1]):
        near, beside = picture.true_at(samples + 6e-3 * np.array(step)[:, None])
        steady &= (near == face) & (beside == behind)
    painted, refracted_ones = picture.painted_at(samples)
    # Faces of balls do not show what they reflect.
    right = (refracted_ones == behind) | (total & (refracted_ones == -1))
    assert (painted == face)[steady].all() and right[steady].all()
    assert (behind >= 0)[steady].sum() > 50


POOL = [(-4, -2, -1), (4, -2, -1), (4, 2, -1), (-4, 2, -1), (-4, -2, 0.2), (4, -2, 0.2), (4, 2, 0.2), (-4, 2, 0.2)]


def pool(eye: tuple[float, float, float], parallel: bool = False) -> Picture:
    """A pool, open above, one unit deep, with water in it up to z = 0: its last item."""
    walls = Mesh.from_polygons(POOL, [[0, 1, 2, 3], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]])
    water = Item("WATER", box((-4, -2, -1), (4, 2, 0)), material=WATER, occludes=False)
    return Picture(Scene((Item("POOL", walls), water)), Camera(eye=eye, parallel=parallel), 2e-4)


def area_of(picture: Picture, face: int) -> float:
    """The area of the image of a face, as far as it is seen in the water: the last of several polygons is seen."""
    seen = picture.seen
    shapes = np.array([shapely.Polygon(p) for p in np.split(seen.points[:2].T, seen.offsets[1:-1])])
    found, above = shapely.Polygon(), shapely.Polygon()
    for own, shape in zip((seen.source == face)[::-1], shapes[::-1], strict=True):
        if own:
            found = found.union(shape.difference(above))
        above = above.union(shape)
    return float(found.area)


@pytest.mark.capability("G6.6-pool")
def test_the_floor_of_a_pool_seen_from_straight_above_is_nearer_by_the_constant() -> None:
    high = 40.0
    picture = pool((1e-3, 0.0, high))
    floor = area_of(picture, 0)
    scale = picture.view.focus / (picture.view.eye[2] - picture.view.points_of(np.zeros((1, 3)))[2, 0])
    width = 1.0 / picture.view.scale
    # Seen at the depth 3/4 under the surface: larger than it is at the depth 1.
    apparent = 8.0 * 4.0 * width**2 * (scale * high / (high + 0.75)) ** 2
    straight = 8.0 * 4.0 * width**2 * (scale * high / (high + 1.0)) ** 2
    assert abs(floor - apparent) < 0.1 * (apparent - straight)


@pytest.mark.capability("G6.6-pool")
@pytest.mark.parametrize("parallel", [False, True])
def test_the_floor_of_a_pool_appears_raised(parallel: bool) -> None:
    picture = pool((5.0, -12.0, 6.0), parallel)
    view = picture.view
    corners = view.image_of(view.points_of(np.array(POOL[:4])))
    surface = int(np.argmax(np.where(picture.own, view.axes[:, 2] @ picture.normal.T, -1.0)))
    floor = np.flatnonzero((picture.seen.source == 0) & (picture.seen.pane == surface))
    position, _ = ragged.take(picture.seen.offsets, floor)
    lowest = picture.seen.points[1, position].min()
    assert lowest > corners[1].min() + 0.01
    back = picture.seen.points[1, position].max()
    assert back > corners[1].max() + 0.01


def test_only_closed_convex_bodies_that_are_clear_refract() -> None:
    cube = box((0, 0, 0), (1, 1, 1))
    open_cube = Mesh(cube.vertices, cube.corners[4:], cube.offsets[1:] - 4)
    items = (
        glass(cube, 1.5),
        glass(cube, 1.0),
        glass(open_cube, 1.5),
        Item("SOLID", cube, material=Material("transparent", 0.5, 1.5), occludes=True),
    )
    scene = Scene(items)
    view = look(scene, Camera(eye=(5.0, 4.0, 3.0)))
    assert refracting_items(scene, view, project_faces(view)).tolist() == [True, False, False, False]


def test_glass_with_nothing_behind_it() -> None:
    picture = Picture(Scene((glass(box((0, 0, 0), (1, 1, 1)), 1.5),)), Camera(eye=(5.0, 4.0, 3.0)))
    assert len(picture.seen) == 0 and len(picture.painted) == 3


def triangles_on_faces(view: View, random: np.random.Generator) -> Decals:
    """A triangle on every face of the view, as large as a half of it or so."""
    parts = []
    for face in range(view.face_count):
        ring = view.points[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        parts.append(ring @ random.dirichlet(np.full(ring.shape[1], 0.3), 3).T)
    count = np.arange(view.face_count)
    none = np.zeros_like(count)
    points = np.concatenate(parts, axis=1)
    return Decals(points, np.arange(0, 3 * view.face_count + 1, 3), count, none, none, none - 1, none - 1, none)


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("start", [0, 8])
def test_what_lies_on_faces_behind_glass_is_where_the_refracted_ray_meets_it(start: int) -> None:
    random = np.random.default_rng(start)
    checked = marked = 0
    for seed in range(start, start + several(3, long=8)):
        scene, camera = random_scene(seed)
        picture = Picture(scene, camera)
        decals = triangles_on_faces(picture.view, random)
        projected = project_faces(picture.view)
        bare = picture.seen
        picture.seen = seen_in_glass(scene, picture.view, projected, picture.painted, 1e-3, decals)
        assert (picture.seen.decal < 0).sum() == len(bare)
        faces = picture.seen.take(np.flatnonzero(picture.seen.decal < 0))
        assert np.array_equal(faces.points, bare.points) and np.array_equal(faces.window, bare.window)
        corners = decals.points.T.reshape(-1, 3, 3)
        view = picture.view
        of_glass = view.image[:, view.item_vertices[-2] :]
        low, high = of_glass.min(axis=1), of_glass.max(axis=1)
        samples = low[:, None] + random.uniform(size=(2, 200)) * (high - low)[:, None]

        def true_at(samples: np.ndarray, picture: Picture = picture, corners: np.ndarray = corners) -> np.ndarray:
            """The face that each ray meets behind glass, plus a half where the triangle on it is met."""
            face, point = picture.behind(samples)
            a, b, c = np.moveaxis(corners[np.maximum(face, 0)], 1, 0)
            normal = np.cross(b - a, c - a)
            turns = [(np.cross(q - p, point - p) * normal).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))]
            return face + 0.5 * ((np.array(turns) >= 0.0).all(axis=0) & (face >= 0))

        true = true_at(samples)
        steady = np.ones(200, dtype=bool)
        for step in ([1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1]):
            steady &= true_at(samples + 4e-3 * np.array(step)[:, None]) == true
        top = topmost(picture.painted.points, picture.painted.offsets, samples)
        found = np.full(200, -2.0)
        for window in np.unique(picture.seen.window).tolist():
            here = np.flatnonzero(top == window)
            shown = picture.seen.take(np.flatnonzero(picture.seen.window == window))
            at = topmost(shown.points, shown.offsets, samples[:, here])
            found[here] = np.where(at >= 0, shown.source[at] + 0.5 * (shown.decal[at] >= 0), -1.0)
        # In a perspective parts near the border of total reflection are left out, faces and what lies on them.
        some = steady & (true >= 0) & ~((found == -1.0) & (view.eye is not None))
        assert (found == true)[some].all()
        checked += int(some.sum())
        marked += int((true % 1.0 > 0.0)[some].sum())
    assert checked > 30 and marked > 2
