"""Items that cover a plane once: their order is right wherever the eye is, and other meshes have none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.painted import nearest, sample_points, top_polygon

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import rotation_about
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.graphs import Disc, graph, vertical
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.height_fields import known_orders, plan_of
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.priority_tests import box_pairs, drawn_before, face_relations


def scattered(seed: int, count: int = 90) -> Mesh:
    """A rough field over a Delaunay triangulation, with holes, bays and islands, turned somehow in space."""
    from scipy.spatial import Delaunay

    random = np.random.default_rng(seed)
    plane = random.uniform(-1.0, 1.0, (count, 2))
    triangles = Delaunay(plane).simplices
    triangles = triangles[random.uniform(size=len(triangles)) < 0.7]
    turn = rotation_about(random.normal(size=3), float(random.uniform(0.0, 6.0)))
    used, corners = np.unique(triangles, return_inverse=True)
    points = np.column_stack([plane, random.uniform(0.0, 0.15, count)])[used]
    return Mesh.from_triangles(points @ turn, corners.reshape(-1, 3))


def wrong_pairs(view: View, faces: ImageFaces) -> int:
    """How many pairs of polygons in their order overlap the other way round."""
    wrong = 0
    for first, second in box_pairs(faces.box, view.tolerance):
        codes = face_relations(faces, first, second, view.tolerance)
        before, after = drawn_before(faces, first[codes > 0], second[codes > 0], codes[codes > 0])
        wrong += int((before > after).sum())
    return wrong


def field(seed: int, rows: int = 9, columns: int = 6, holes: bool = True) -> Mesh:
    """A rough field over lines at uneven distances; cells cut either way, with holes."""
    random = np.random.default_rng(seed)
    x, y = (np.cumsum(random.uniform(0.2, 1.0, n + 1)) for n in (rows, columns))
    vertices = np.stack([*np.meshgrid(x, y, indexing="ij"), random.uniform(0, 1.5, (rows + 1, columns + 1))], axis=-1)
    number = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    up = random.uniform(size=(rows, columns)) < 0.5
    one = np.where(up[..., None], np.stack([a, b, c], -1), np.stack([a, b, d], -1)).reshape(-1, 3)
    two = np.where(up[..., None], np.stack([a, c, d], -1), np.stack([b, c, d], -1)).reshape(-1, 3)
    triangles = random.permutation(np.concatenate([one, two]))
    kept = triangles[random.uniform(size=len(triangles)) < 0.9] if holes else triangles
    return Mesh.from_triangles(vertices.reshape(-1, 3), kept.ravel())


def seen_from_everywhere(mesh: Mesh, seed: int, parallel: bool) -> Camera:
    """A camera that looks at a mesh, or at a part of it from amid it."""
    random = np.random.default_rng(seed)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    eye = low + random.uniform(-1.0, 2.0, 3) * (high - low)
    target = low + random.uniform(0.2, 0.8, 3) * (high - low)
    return Camera(eye=tuple(eye), target=tuple(target), parallel=parallel)


@pytest.mark.slow
@pytest.mark.capability("G5.4-graph")
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("make", [field, scattered])
def test_what_is_in_front_comes_later(make, parallel: bool) -> None:
    for seed in range(25):
        mesh = make(seed)
        scene = Scene((Item("F", mesh),))
        view = look(scene, seen_from_everywhere(mesh, seed, parallel))
        known = known_orders(scene, view)
        assert list(known) == [0]
        painted = painters_order(view, known=known)
        assert wrong_pairs(view, painted.faces) == 0
        assert (painted.uncut, len(painted)) == (len(painters_order(view)),) * 2


@pytest.mark.slow
@given(st.integers(0, 10**6), st.booleans(), st.sampled_from([field, scattered]))
def test_what_is_in_front_comes_later_always(seed: int, parallel: bool, make) -> None:
    mesh = make(seed)
    scene = Scene((Item("F", mesh),))
    view = look(scene, seen_from_everywhere(mesh, seed, parallel))
    assert wrong_pairs(view, painters_order(view, known=known_orders(scene, view)).faces) == 0


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [False, True])
def test_what_else_is_in_the_picture_is_compared_and_only_that(monkeypatch, parallel: bool) -> None:
    compared = []

    def counted(faces, first, second, tolerance):
        compared.append(np.stack([faces.source[first], faces.source[second]]))
        return face_relations(faces, first, second, tolerance)

    monkeypatch.setattr("vectorplot.visibility.painter.painters_order.face_relations", counted)
    for seed in range(12):
        meshes = (field(seed), box((2.0, 1.0, 1.6), (3.0, 2.0, 2.5)), field(seed + 1, holes=False))
        low = meshes[2].transformed(np.array([[1, 0, 0, 0.4], [0, 1, 0, 0.3], [0, 0, 1, -1.7], [0, 0, 0, 1.0]]))
        scene = Scene((Item("F", meshes[0]), Item("B", meshes[1]), Item("G", low)))
        view = look(scene, seen_from_everywhere(meshes[0], seed, parallel))
        known = known_orders(scene, view)
        assert sorted(known) == [0, 2]
        compared.clear()
        painted = painters_order(view, known=known)
        assert wrong_pairs(view, painted.faces) == 0
        if compared and not len(painted.cycles):
            pairs = view.face_item[np.concatenate(compared, axis=1)]
            assert pairs.shape[1] and (pairs[0] != pairs[1]).all()


@pytest.mark.slow
def test_circles_with_other_things_are_cut_as_ever() -> None:
    x, y = np.meshgrid(np.linspace(0.0, 2.0, 9), np.linspace(0.0, 2.0, 9), indexing="ij")
    number = np.arange(81).reshape(9, 9)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    for height in (x - 1.0, 0.3 * np.sin(4.0 * x) * np.cos(3.0 * y)):
        one = Mesh.from_triangles(
            np.stack([x, y, height], axis=-1).reshape(-1, 3), quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
        )
        two = one.transformed(np.diag([1.0, 1.0, -1.0, 1.0]))
        scene = Scene((Item("A", one), Item("B", two), Item("C", box((0.5, 0.5, -0.5), (1.2, 1.2, 0.5)))))
        for eye in ((4.0, -5.0, 3.0), (1.0, 1.0, 6.0), (0.2, 0.3, 2.0)):
            view = look(scene, Camera(eye=eye, target=(1.0, 1.0, 0.0)))
            painted = painters_order(view, known=known_orders(scene, view))
            places = sample_points(view, 800)
            truth, sure = nearest(view, *places)
            top = top_polygon(painted.faces, *places)
            plain = painters_order(view)
            other = top_polygon(plain.faces, *places)
            same = np.append(painted.faces.source, -1)[top] == np.append(plain.faces.source, -1)[other]
            assert (truth[sure] > 0.0).any() and (~same & sure).sum() <= 2


@pytest.mark.parametrize("defect", ["twice", "folded", "torn"])
def test_what_covers_a_place_twice_has_no_known_order(defect: str) -> None:
    mesh = field(3, holes=False)
    vertices, triangles = mesh.vertices, mesh.corners.reshape(-1, 3)
    if defect == "twice":
        triangles = np.concatenate([triangles, triangles[:1]])
    elif defect == "folded":
        vertices = np.concatenate([vertices, vertices + np.array([0.3, 0.2, 1.0])])
        triangles = np.concatenate([triangles, triangles + len(mesh.vertices)])
    else:
        random = np.random.default_rng(0)
        middle = vertices[triangles].mean(axis=1, keepdims=True)
        vertices = (middle + 1.3 * (vertices[triangles] - middle)).reshape(-1, 3)
        triangles = random.permutation(np.arange(len(vertices)).reshape(-1, 3))
    scene = Scene((Item("F", Mesh.from_triangles(vertices, triangles)),))
    view = look(scene, Camera(eye=(9.0, -9.0, 7.0)))
    assert known_orders(scene, view) == {}


def test_closed_and_rolled_shapes_and_few_faces_have_no_known_order() -> None:
    turn = np.linspace(0.0, 5.0, 60)
    roll = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    wall = np.concatenate([np.column_stack([roll, np.full(60, z)]) for z in (0.0, 1.0)])
    quads = np.stack([np.arange(59), np.arange(1, 60), np.arange(61, 120), np.arange(60, 119)], axis=1)
    triangles = quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    ball = box((0, 0, 0), (1, 1, 1))
    flat = np.column_stack([wall[:, 0], np.zeros(120), wall[:, 2]])
    for mesh in (ball, Mesh.from_triangles(wall, triangles), Mesh.from_triangles(np.zeros((0, 3)), np.zeros(0, int))):
        scene = Scene((Item("A", mesh), Item("B", Mesh.from_triangles(flat * (1, 1, 0), triangles))))
        assert 0 not in known_orders(scene, look(scene, Camera(eye=(3.0, 4.0, 5.0))))


def test_walls_have_their_place_in_the_plan() -> None:
    x, y = np.meshgrid(np.arange(12.0), np.arange(9.0), indexing="ij")
    step = np.where(np.arange(12) == 6, 5.0, np.arange(12.0))
    height = np.where(np.arange(12) >= 6, 2.0, 0.0)
    vertices = np.stack([np.broadcast_to(step[:, None], x.shape), y, np.broadcast_to(height[:, None], x.shape)], -1)
    number = np.arange(108).reshape(12, 9)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    mesh = Mesh.from_triangles(vertices.reshape(-1, 3), quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))
    scene = Scene((Item("W", mesh),))
    for eye in ((-20.0, 3.0, 4.0), (20.0, 5.0, 9.0), (4.0, -9.0, 1.0)):
        view = look(scene, Camera(eye=eye, target=(5.0, 4.0, 1.0)))
        known = known_orders(scene, view)
        assert list(known) == [0]
        assert wrong_pairs(view, painters_order(view, known=known).faces) == 0


def test_a_plan_knows_what_lies_side_by_side() -> None:
    places = np.array([[0.0, 1.0, 1.0, 0.0, 3.0, 4.0, 3.0], [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0]])
    plan = plan_of(places, np.array([0, 1, 2, 0, 2, 3, 4, 5, 6]), np.array([0, 3, 6, 9]))
    assert plan is not None
    assert ((plan.left == 0) & (plan.right == 1) | (plan.left == 1) & (plan.right == 0)).sum() == 1
    # Gaps have every side but the four of the rectangle in common with something.
    assert 2 * len(plan.left) == 3 * plan.count - 4
    assert plan_of(places, np.array([0, 1, 2, 0, 1, 2]), np.array([0, 3, 6])) is None
    assert plan_of(places, np.array([0, 2, 1]), np.array([0, 3])) is None


def test_graphs_know_their_vertical_however_they_are_placed() -> None:
    turn = rotation_about((1.0, 2.0, 0.5), 0.7) * (1.0, 3.0, 0.5)
    for surface in (graph(np.hypot, Domain(0.0, 1.0, 0.0, 1.0)), graph(np.hypot, Disc(2.0))):
        assert vertical(surface).tolist() == [0.0, 0.0, 1.0]
        placed = PlacedSurface(PlacedSurface(surface, turn), turn, (1.0, 2.0, 3.0))
        up = np.diff(placed.points(0.25, 0.5)[None] + [[0.0] * 3, np.array([0.0, 0.0, 1.0]) @ turn @ turn], axis=0)[0]
        assert np.allclose(vertical(placed), up)
    assert vertical(box((0, 0, 0), (1, 1, 1))) is None


@pytest.mark.capability("G5.4-graph")
@pytest.mark.parametrize("seed", range(3))
def test_the_plan_tells_the_order_of_all_but_the_few_faces_whose_borders_cross_in_it(seed: int) -> None:
    mesh = field(seed, 14, 12, holes=False)
    random = np.random.default_rng(seed)
    # A triangle of its own across a corner of the border, above the rest or below it.
    x, y = mesh.vertices[:, :2].max(axis=0)
    more = np.array([(x - 0.1, y - 0.1), (x + 0.4, y + 0.1), (x + 0.1, y + 0.4)])
    points = np.column_stack([more, np.full(3, random.choice([-3.0, 3.0]))])
    corners = np.append(mesh.corners, len(mesh.vertices) + np.arange(3))
    lapped = Mesh.from_triangles(np.concatenate([mesh.vertices, points]), corners.reshape(-1, 3))
    scene = Scene((Item("lapped", lapped), Item("floor", box((-9.0, -9.0, -5.0), (20.0, 20.0, -4.0)))))
    view = look(scene, seen_from_everywhere(mesh, seed, parallel=bool(seed % 2)))
    known = known_orders(scene, view)
    assert len(known[0].face[known[0].face >= 0]) > 0.9 * len(lapped.offsets)
    assert wrong_pairs(view, painters_order(view, known=known).faces) == 0
