"""The assertions and the oracle can fail, and agree with closed forms and with other programs."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.hard_shapes import HARD_SHAPES
from support.triangle_rays import TriangleRays

from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.testing import (
    assert_drawing_is_right,
    assert_drawings_equal,
    edge_points,
    visible_by_rays,
)
from vectorplot.testing.shapes import box, bumpy_icosphere, grid_graph, honeycomb, prism, scene_of, torus_mesh, without
from vectorplot.testing.sight_rays import triangulated
from vectorplot.words import LineKind

LINE = [(10.0, 10.0), (50.0, 10.0), (50.0, 40.0)]


def drawing_of(*strokes, kind=LineKind.CONTOUR, hidden_by=0, closed=False, points3d=None, **fields):
    """A drawing of polylines in mm, all of one kind, each on a layer of its own."""
    layers = []
    for k, stroke in enumerate(strokes):
        points = np.array(stroke, dtype=float)
        space = np.c_[points, np.zeros(len(points))] if points3d is None else np.array(points3d[k], dtype=float)
        one = np.zeros(1, dtype=int)
        offsets = np.array([0, len(points)])
        paths = Paths(points, offsets, np.array([closed]), one + int(kind), one, one + hidden_by, space)
        layers.append(Layer("visible", Pen(), (paths,)))
    return Drawing(210.0, 297.0, tuple(layers), items=("A",), **fields)


def test_order_direction_and_splitting_do_not_matter():
    whole = drawing_of(LINE)
    pieces = drawing_of([(50, 40), (50, 25)], [(30, 10), (10, 10)], [(50, 26), (50, 10), (29, 10)], LINE[:2])
    assert_drawings_equal(whole, pieces, 1e-6)
    assert_drawings_equal(pieces, whole, 1e-6)


def test_a_closed_path_equals_its_segments():
    ring = drawing_of([(0, 0), (9, 0), (0, 9)], closed=True)
    assert_drawings_equal(ring, drawing_of([(0, 0), (9, 0)], [(0, 9), (0, 0)], [(0, 9), (9, 0)]), 1e-6)
    with pytest.raises(AssertionError, match="contour"):
        assert_drawings_equal(ring, drawing_of([(0, 0), (9, 0), (0, 9)]), 1e-6)


def test_points_drawn_twice_are_the_same_line():
    """A stroke may stand still: a segment of no length lies where another one does."""
    still = drawing_of([(0, 0), (0, 0), (9, 0), (9, 5), (9, 5)])
    assert_drawings_equal(still, still, 1e-6)
    assert_drawings_equal(still, drawing_of([(0, 0), (9, 0), (9, 5)]), 1e-6)
    with pytest.raises(AssertionError, match="contour"):
        assert_drawings_equal(drawing_of([(0, 0), (0, 0)]), drawing_of([(1, 0), (2, 0)]), 1e-6)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (
            drawing_of([*LINE[:2], (50, 39.5)]),
            r"visible contour: at \(50.0000, 40.0000\) mm the first .* is 0.5 mm away",
        ),
        (drawing_of([*LINE[:2], (50, 41.5)]), r"visible contour: at \(50.0000, 41.5000\) mm the second .* 1.5 mm away"),
        (drawing_of(LINE[:2], [(50, 10), (50, 20)], [(50, 24), (50, 40)]), r"at \(50.0000, 22.0000\) mm .* 2 mm away"),
        (drawing_of(LINE, kind=LineKind.CREASE), "visible (contour|crease): at .* has none at all"),
        (drawing_of(LINE, hidden_by=1), "hidden contour|visible contour"),
        (drawing_of(LINE, [(100, 100), (100, 100)]), r"at \(100.0000, 100.0000\)"),
        (drawing_of(), "none at all"),
    ],
)
def test_a_difference_is_named_with_its_worst_point(other, message):
    with pytest.raises(AssertionError, match=message):
        assert_drawings_equal(drawing_of(LINE), other, 0.01)


def test_pages_of_different_size_are_different():
    other = Drawing(297.0, 210.0, drawing_of(LINE).layers)
    with pytest.raises(AssertionError, match="210 x 297 mm, the second 297 x 210 mm"):
        assert_drawings_equal(drawing_of(LINE), other, 0.01)


@given(st.floats(0.0, 6.3), st.floats(0.2, 3.0))
def test_the_tolerance_is_a_distance_in_every_direction(angle, ratio):
    step = 0.01 * ratio * np.array([np.cos(angle), np.sin(angle)])
    moved = drawing_of(np.array(LINE) + step)
    if ratio < 0.99:
        assert_drawings_equal(drawing_of(LINE), moved, 0.01)
    elif ratio > 1.01:
        with pytest.raises(AssertionError):
            assert_drawings_equal(drawing_of(LINE), moved, 0.01)


def triangle_areas(mesh, triangles):
    a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2.0


@pytest.mark.parametrize("seed", range(6))
def test_ears_of_a_polygon_with_many_notches_cover_it_once(seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0.0, 2.0 * np.pi, 40))
    star = np.c_[np.cos(angle), np.sin(angle)] * random.uniform(0.2, 1.0, 40)[:, None]
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    mesh = Mesh.from_polygons(np.c_[star, np.zeros(40)] @ q.T + 5.0, [list(range(40))])
    triangles, faces = triangulated(mesh)
    assert len(triangles) == 38 and (faces == 0).all()
    areas = triangle_areas(mesh, triangles) @ mesh.face_normals[0]
    assert areas.min() > 0.0  # none turned over, hence none outside
    assert areas.sum() == pytest.approx(np.linalg.norm(mesh.area_vectors[0]) / 2.0, rel=1e-12)


@pytest.mark.spread
@pytest.mark.parametrize("offset", [0.0, 1e3])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_corners_that_are_straight_but_for_rounding_are_no_ears(scale, offset):
    """A comb with many corners along its back, turned anywhere: no ray can tell on which side of such an ear it is."""
    back = [(x, -1.0) for x in np.linspace(0.0, 9.0, 28)]
    teeth = [point for x in range(8, -1, -2) for point in [(x + 1, 0), (x + 1, 2), (x, 2), (x, 0)]]
    ring = np.array([*back, *teeth], dtype=float)
    for seed in range(20):
        turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
        mesh = Mesh.from_polygons((np.c_[ring, 0.0 * ring[:, 0]] @ turn.T + offset) * scale, [list(range(len(ring)))])
        triangles, _ = triangulated(mesh)
        areas = triangle_areas(mesh, triangles) @ mesh.face_normals[0]
        assert areas.min() > 1e-4 * scale**2
        assert areas.sum() == pytest.approx(19.0 * scale**2, rel=1e-9)


def test_a_notch_is_not_covered():
    mesh = prism([(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 1.0)
    scene = scene_of(CUP=mesh)
    below = [(0.5, 1.5, -1.0), (1.5, 1.5, -1.0), (2.5, 1.5, -1.0), (1.5, 0.5, -1.0)]
    camera = Camera((1.6, 0.7, 50.0), (1.5, 0.7, 0.0))
    assert visible_by_rays(scene, camera, below).hidden_by.tolist() == [1, 0, 1, 1]
    assert visible_by_rays(scene_of(CUP=without(mesh, 0, 1)), camera, below).hidden_by[:2].tolist() == [0, 0]


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_a_stack_of_plates_is_counted(parallel, scale, offset):
    plates = [box((-2, -2, z), (2, 2, z + 0.5)) for z in (0.0, 1.0, 2.0)]
    shift = np.array([offset, 0.0, 0.0])
    scene = scene_of(**{f"P{k}": Mesh(p.vertices * scale + shift, p.corners, p.offsets) for k, p in enumerate(plates)})
    camera = Camera(
        tuple(np.array([0.3, 0.2, 20.0]) * scale + shift), tuple(shift), up=(0.0, 1.0, 0.0), parallel=parallel
    )
    heights = np.array([2.5, 2.2, 2.0, 1.7, 1.5, 1.2, 0.7, -0.3])
    points = np.c_[np.full(8, 0.11), np.full(8, 0.23), heights] * scale + shift
    sight = visible_by_rays(scene, camera, points)
    # On the top of a plate: not hidden by it. Within a plate and on its bottom: hidden by it.
    assert sight.hidden_by.tolist() == [0, 1, 1, 1, 1, 2, 2, 3]
    assert (sight.clearance > 1e-4).all()
    assert visible_by_rays(scene, camera, points, items=[2]).hidden_by.tolist() == [0, 1, 1, 1, 1, 1, 1, 1]


def test_items_that_do_not_occlude_hide_nothing():
    scene = Scene((Item("GLASS", box((-1, -1, -1), (1, 1, 1)), occludes=False),))
    assert visible_by_rays(scene, Camera((5.0, 4.0, 3.0)), [(-2.0, -2.0, -1.5)]).hidden_by.tolist() == [0]


def test_what_is_behind_the_eye_hides_nothing():
    scene = scene_of(BEHIND=box((9, -1, -1), (10, 1, 1)), FRONT=box((0, -1, -1), (1, 1, 1)))
    sight = visible_by_rays(scene, Camera((5.0, 0.0, 0.0)), [(-1.0, 0.1, 0.1), (1.0, 0.1, 0.1)])
    assert sight.hidden_by.tolist() == [1, 0]


def test_clearance_is_the_distance_to_the_edge_that_hides():
    scene = scene_of(WALL=box((-1, 0, -1), (1, 0.5, 1)))
    camera = Camera((0.0, -10.0, 0.0), (0.0, 0.0, 0.0), parallel=True)
    offsets = np.array([1e-4, 1e-7, -1e-7, -1e-4])
    sight = visible_by_rays(scene, camera, np.c_[1.0 + offsets, np.full(4, 3.0), np.full(4, 0.123)])
    assert sight.hidden_by.tolist() == [0, 0, 1, 1]
    assert sight.clearance == pytest.approx(np.abs(offsets) / 2.0, rel=1e-6)


def test_a_face_seen_edge_on_hides_nothing():
    plate = HARD_SHAPES["edge-on plate"]
    sight = visible_by_rays(plate, Camera((-10.0, 0.0, 0.0), (0.0, 0.0, 0.0)), [(0.5, 0.0, 0.1), (0.5, 0.0, 0.2)])
    assert sight.hidden_by.tolist() == [0, 0]


@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
def test_every_family_is_seen_alike_by_embree(name):
    """Single precision is enough for points that keep their distance."""
    scene = HARD_SHAPES[name]
    middle = scene.bounds.mean(axis=0)
    eye = middle + np.array([1.3, -2.1, 1.7]) * (scene.bounds[1] - scene.bounds[0]).max()
    random = np.random.default_rng(1)
    points = random.uniform(*scene.bounds, (300, 3))
    sight = visible_by_rays(scene, Camera(tuple(eye), tuple(middle)), points)
    sure = sight.clearance >= 5e-4
    count = np.zeros(len(points), dtype=int)
    way = eye - points
    for item in scene.items:
        solid = TriangleRays(item.shape.vertices[triangulated(item.shape)[0]])
        count += solid.stopped(points, way, np.ones(len(way)))
    assert sure.mean() > 0.5
    assert (count[sure] == sight.hidden_by[sure]).all()


def test_clusters_of_a_large_mesh_change_nothing():
    """The two rounds of spheres only leave out what cannot matter."""
    scene = scene_of(BALL=bumpy_icosphere(4))
    camera = Camera((3.0, -4.0, 2.0))
    points, _ = edge_points(scene, 400, seed=2)
    facing = Mesh.from_triangles(scene.items[0].shape.vertices, scene.items[0].shape.corners.reshape(-1, 3))
    a, b, c = (facing.vertices[facing.corners[k::3]] for k in range(3))
    sight = visible_by_rays(scene, camera, points)
    for point, hidden, clearance in zip(points[:60], sight.hidden_by, sight.clearance, strict=False):
        way = np.array(camera.eye) - point
        p = np.cross(way, c - a)
        det = np.einsum("ij,ij->i", b - a, p)
        u = np.einsum("ij,ij->i", point - a, p) / det
        q = np.cross(point - a, b - a)
        v, t = q @ way / det, np.einsum("ij,ij->i", c - a, q) / det
        hit = (u > 0) & (v > 0) & (u + v < 1) & (t > 1e-6) & (t < 1)
        assert clearance < 1e-6 or bool(hidden) == bool(hit.any())


@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
def test_every_family_is_sound(name):
    scene = HARD_SHAPES[name]
    for item in scene.items:
        assert item.shape.face_count > 0
        assert (np.linalg.norm(item.shape.area_vectors, axis=1) > 0.0).all()
    points, owner = edge_points(scene, 50)
    assert points.shape == (50, 3) and owner.max() < len(scene.items)


def volume(mesh):
    triangles, _ = triangulated(mesh)
    a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6.0


def edge_counts(mesh):
    pairs = np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1)
    return np.unique(np.sort(pairs, axis=1), axis=0, return_counts=True)[1]


def test_closed_families_are_closed_and_turned_outwards():
    assert volume(box((0, 0, 0), (1, 2, 3))) == pytest.approx(6.0)
    assert volume(torus_mesh(96, 48)) == pytest.approx(2.0 * np.pi**2 * 2.0 * 0.8**2, rel=0.01)
    assert volume(bumpy_icosphere(4, bump=0.0)) == pytest.approx(4.0 / 3.0 * np.pi, rel=0.01)
    ell = HARD_SHAPES["L-shaped prisms"].items[0].shape
    assert volume(ell) == pytest.approx(3.0)
    for mesh in (torus_mesh(), bumpy_icosphere(3), ell, box((0, 0, 0), (1, 1, 1))):
        assert (edge_counts(mesh) == 2).all()
    assert bumpy_icosphere(5).face_count == 20480
    assert len(honeycomb().items) == 161
    assert (edge_counts(grid_graph(9)) == 1).sum() == 36


def test_a_moebius_strip_has_one_border():
    strip = HARD_SHAPES["Moebius strip"].items[0].shape
    pairs = np.sort(np.stack([strip.corners, strip.corners[strip.next_corner]], axis=1), axis=1)
    edges, count = np.unique(pairs, axis=0, return_counts=True)
    border = edges[count == 1]
    around = {int(a): [] for a in border.ravel()}
    for a, b in border.tolist():
        around[a].append(b)
        around[b].append(a)
    walked, here = {int(border[0, 0])}, int(border[0, 0])
    while following := [k for k in around[here] if k not in walked]:
        here = following[0]
        walked.add(here)
    assert len(walked) == len(around) == len(border)


PLATE_SCENE = scene_of(
    NEAR=Mesh.from_polygons([(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], [[0, 1, 2, 3]]),
    FAR=Mesh.from_polygons([(-2, 0.1, 0), (2, 0.1, 0), (2, 3, 0), (-2, 3, 0)], [[0, 1, 2, 3]]),
)
FROM_ABOVE = Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), parallel=True, height=20.0)


def drawn(*segments, hidden_by=0):
    """A drawing of segments in the world, 10 mm a unit, the origin at (100, 100) mm."""
    page = np.array([[10.0, 0, 0, 100.0], [0, 10.0, 0, 100.0], [0, 0, 0, 0], [0, 0, 0, 1.0]])
    flat = [[(100.0 + 10.0 * x, 100.0 + 10.0 * y) for x, y, _ in segment] for segment in segments]
    return drawing_of(*flat, hidden_by=hidden_by, points3d=segments, page_from_world=page)


def test_a_line_drawn_through_what_hides_it_is_found():
    right = drawn([(-2, 0.1, 0), (-1, 0.1, 0)], [(1, 0.1, 0), (2, 0.1, 0)])
    assert assert_drawing_is_right(right, PLATE_SCENE, FROM_ABOVE) > 1900
    with pytest.raises(AssertionError, match=r"of A is drawn as hidden by 0 items, rays find 1"):
        assert_drawing_is_right(drawn([(-2, 0.1, 0), (2, 0.1, 0)]), PLATE_SCENE, FROM_ABOVE)
    hidden = drawn([(-1, 0.1, 0), (1, 0.1, 0)], hidden_by=1)
    assert_drawing_is_right(hidden, PLATE_SCENE, FROM_ABOVE)


def test_a_visible_line_that_is_left_out_is_found():
    border = [(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2), (-1, -1, 2)]
    far = [(-1, 0.1, 0), (-2, 0.1, 0), (-2, 3, 0), (2, 3, 0), (2, 0.1, 0), (1, 0.1, 0)]
    points, _ = edge_points(PLATE_SCENE, 500)
    assert assert_drawing_is_right(drawn(border, far), PLATE_SCENE, FROM_ABOVE, must_show=points) > 2000
    with pytest.raises(AssertionError, match="visible points are not drawn"):
        assert_drawing_is_right(drawn(border, far[:-1]), PLATE_SCENE, FROM_ABOVE, must_show=points)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
def test_every_family_is_drawn_as_rays_see_it(name, parallel):
    scene = HARD_SHAPES[name]
    middle = scene.bounds.mean(axis=0)
    eye = middle + np.array([1.0, -2.0, 1.2]) * (scene.bounds[1] - scene.bounds[0]).max()
    camera = Camera(tuple(eye), tuple(middle), parallel=parallel)
    kinds = ("contour", "boundary", "crease", "edges", "intersection")
    drawing = draw(scene, camera, lines=kinds, hidden="solid")
    points, _ = edge_points(scene, 400)
    assert assert_drawing_is_right(drawing, scene, camera, samples=800, must_show=points) > 500


def test_rays_and_drawing_agree_about_the_surface_of_a_bent_quadrangle():
    height = np.random.default_rng(2).normal(size=49) * 0.4
    y, x = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 7), indexing="ij")
    first = (np.arange(6)[:, None] * 7 + np.arange(6)).ravel()
    cells = np.stack([first, first + 1, first + 8, first + 7], axis=1)
    scene = scene_of(
        BENT=Mesh.from_polygons(np.c_[x.ravel(), y.ravel(), height], cells.tolist()),
        BOX=box((-0.3, -0.3, -0.5), (0.3, 0.3, 0.4)),
    )
    for eye in ((5, -7, 4), (-2, 3, 5), (1, 1, -6)):
        camera = Camera(eye)
        shown, _ = edge_points(scene, 300)
        drawing = draw(scene, camera, hidden="solid", lines=("contour", "boundary", "crease", "edges"))
        assert assert_drawing_is_right(drawing, scene, camera, samples=600, must_show=shown) > 600
