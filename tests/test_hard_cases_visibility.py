"""The hard cases of visibility, 1 to 16, through the front door: a scene in, a drawing out."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from support.drawn import EVERY_EDGE, drawn, moved, on_page, plate, stroke_count

import vectorplot as vp
from vectorplot.geometry.predicates import orient3d
from vectorplot.testing import assert_drawing_is_right, assert_drawings_equal, edge_points
from vectorplot.testing.shapes import (
    box,
    box_on_table,
    coincident_faces,
    edge_on_plate,
    hollow_tube,
    l_prisms,
    moebius_strip,
    non_manifold_edge,
    open_mesh,
    rotation,
    scene_of,
    t_junction,
    touching_boxes,
)

CUBE = box((-1, -1, -1), (1, 1, 1))


def assert_right(scene: vp.Scene, camera: vp.Camera, *, fit: bool = True, samples: int = 400) -> int:
    """Every edge where rays see it, hidden where rays do not; and at least some points to compare."""
    drawing = vp.draw(scene, camera, lines=EVERY_EDGE, hidden="solid", fit=fit)
    shown, _ = edge_points(scene, samples)
    compared = assert_drawing_is_right(drawing, scene, camera, samples=samples, clearance=1e-4, must_show=shown)
    assert compared > samples // 4
    return compared


@pytest.mark.hard(1)
@pytest.mark.parametrize("parallel", [True, False])
def test_a_face_seen_edge_on_hides_nothing_and_its_edges_are_drawn_once(parallel: bool) -> None:
    scene = edge_on_plate()
    camera = vp.Camera((-6, 0, 0), (0, 0, 0), parallel=parallel)
    corners = scene.items[0].shape.vertices
    assert orient3d(camera.eye, *corners[:3]) == 0
    lines = drawn(vp.draw(scene, camera))
    assert len(lines.hidden) == 0
    nearest = lines.of(0)
    assert nearest.length == pytest.approx(2.0), "four edges, all of them behind the one at x = -1 or as long as it"
    front = lines.of(1)
    assert front.length == pytest.approx(4.0), "the front face of the box, nothing of it hidden"


@pytest.mark.hard(2)
@pytest.mark.parametrize("target", [(0, 0, 0.5), (3, 1.6, 0.2), (1.5, 4, 0.5), (1.5, 1.5, -3)])
def test_the_eye_inside_the_bounding_box_but_outside_the_solid(target: tuple[float, float, float]) -> None:
    scene = vp.Scene(
        l_prisms().items[:1] + scene_of(FAR=box((2.5, 2.5, 0), (3, 3, 1)), LOW=box((0, 0, -4), (3, 3, -3))).items
    )
    assert_right(scene, vp.Camera((1.5, 1.5, 0.5), target, fov_deg=120), fit=False, samples=800)


@pytest.mark.hard(3)
def test_the_eye_inside_a_solid_sees_its_inner_walls_and_nothing_mirrored() -> None:
    camera = vp.Camera((0.3, -0.2, 0.1), (1, -0.2, 0.1), fov_deg=150)
    drawing = vp.draw(scene_of(CUBE=CUBE), camera, page=vp.Page(200, 200, 10))
    lines = drawn(drawing)
    wall = lines.where((lines.world[:, :, 0] > 1 - 1e-9).all(axis=1))
    assert wall.visible.length == pytest.approx(8.0), "all four edges of the wall in front"
    right_up, left_up = on_page(drawing, np.array([[1, -1, 1], [1, 1, 1]]))
    assert right_up[0] > left_up[0] and right_up[1] > 100, "looking along x, y points to the left"
    assert_right(scene_of(CUBE=CUBE, OUTSIDE=box((2, -1, -1), (3, 1, 1))), camera)


@pytest.mark.hard(4)
@pytest.mark.spread
@pytest.mark.parametrize(
    "eye", [(1, 1, 1), (1, 0, 1), (1, 0.2, 0.1), (0, 0, 0)], ids=["vertex", "edge", "face", "middle"]
)
@pytest.mark.parametrize("target", [(0, 0, 0.1), (5, 4, 3), (1, -3, 1), (1, 3, -2)])
def test_the_eye_on_a_vertex_an_edge_or_a_face(eye: tuple, target: tuple) -> None:
    scene = scene_of(CUBE=CUBE, OTHER=box((3, 2, 1), (4, 3, 2)))
    for shown in (scene, scene_of(OPEN=open_mesh().items[0].shape)):
        camera = vp.Camera(eye, target, fov_deg=100)
        for fit in (True, False):
            drawing = vp.draw(shown, camera, lines=EVERY_EDGE, hidden="solid", fit=fit)
            lines = drawn(drawing)
            depth = (np.subtract(eye, lines.world) @ camera.direction).ravel()
            assert (depth > 0).all(), "nothing behind the eye"
            assert_drawing_is_right(drawing, shown, camera, samples=100, clearance=1e-4)


@pytest.mark.hard(5)
def test_an_edge_behind_the_eye_is_clipped_before_it_is_divided() -> None:
    floor = scene_of(FLOOR=plate((-1, -50), (1, 10), 0))
    camera = vp.Camera((0.0, 0.0, 1.0), (0.0, 10.0, 1.0), fov_deg=90)
    drawing = vp.draw(floor, camera, fit=False, page=vp.Page(200, 200, 10))
    lines = drawn(drawing)
    unit = 200 / 20  # Millimetres a unit in the plane through the target, which the far edge lies in.
    far = lines.where((lines.world[:, :, 1] > 10 - 1e-9).all(axis=1))
    assert sorted(far.page[:, :, 0].ravel()) == pytest.approx([100 - unit, 100 + unit])
    assert far.page[:, :, 1] == pytest.approx(100 - unit)
    sides = lines.where(np.ptp(lines.world[:, :, 1], axis=1) > 1)
    assert len(sides) == 2
    assert (lines.page[:, :, 1] < 100).all(), "all of the floor below the horizon"
    assert sides.page.min(axis=(1, 2)) == pytest.approx([10, 10]), "down to the margin"
    direction = np.abs(sides.page[:, 1] - sides.page[:, 0])
    assert direction[:, 0] == pytest.approx(direction[:, 1]), "both sides run to the vanishing point at 45 degrees"
    assert len(drawn(vp.draw(scene_of(BEHIND=box((-1, -9, 0), (1, -5, 2))), camera))) == 0


@pytest.mark.slow
@pytest.mark.hard(6)
def test_coincident_faces_in_any_order_give_the_same_drawing() -> None:
    scene = coincident_faces()
    camera = vp.Camera((0.3, -0.4, 8), (0, 0, 0))
    first = vp.draw(scene, camera, hidden="solid")
    lines = drawn(first)
    assert lines.visible.length == pytest.approx(12.0), "the plate once, and the smaller one in its plane"
    for order in permutations(scene.items):
        again = vp.draw(vp.Scene(order), camera, hidden="solid")
        assert_drawings_equal(first, again, 1e-6)
        below = [item.name for item in order].index("BELOW")
        assert set(drawn(again).of(below).hidden_by.tolist()) == {3, 4}, "by three plates, and some by itself"


@pytest.mark.hard(7)
@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("lift", [0.0, 1e-12, -1e-12])
def test_a_box_on_a_table_stands_on_whole_lines(lift: float, parallel: bool) -> None:
    table, block = (item.shape for item in box_on_table().items)
    up = np.eye(4)
    up[2, 3] = lift
    scene = scene_of(TABLE=table, BOX=block.transformed(up))
    camera = vp.Camera((5, -7, 4), (0, 0, 0), parallel=parallel)
    lines = drawn(vp.draw(scene, camera, lines=EVERY_EDGE)).visible
    inner = (np.abs(lines.world[:, :, 2]) < 1e-9).all(axis=1) & (np.abs(lines.world[:, :, 0]) < 1).all(axis=1)
    foot = lines.where(inner)
    assert len(foot) == 2, "two edges in one piece each, no stitching"
    assert foot.length == pytest.approx(1.1 + 0.9)
    assert_right(scene, camera)


@pytest.mark.slow
@pytest.mark.hard(8)
def test_coincident_edges_of_two_objects_are_stroked_once() -> None:
    beside = scene_of(LEFT=box((0, 0, 0), (1, 1, 1)), RIGHT=box((1, 0, 0), (2, 1, 1)))
    above = vp.Camera.view("top", (1, 0.5, 0.5), 5)
    assert drawn(vp.draw(beside, above)).length == pytest.approx(7.0)
    half = scene_of(LEFT=box((0, 0, 0), (1, 1, 1)), RIGHT=box((1, 0.25, 0), (2, 0.5, 1)))
    assert drawn(vp.draw(half, above)).length == pytest.approx(4.0 + 2.25)
    for camera in (vp.Camera((5, -7, 4), (1, 0.5, 0.5)), vp.Camera.view("iso", (1, 0.5, 0.5), 5)):
        once = vp.draw(touching_boxes(), camera, hidden="solid")
        twice = vp.draw(vp.Scene(touching_boxes().items * 2), camera, hidden="none")
        assert_drawings_equal(vp.draw(touching_boxes(), camera), twice, 1e-6)
        assert drawn(twice).length_mm == pytest.approx(drawn(once).visible.length_mm)


@pytest.mark.hard(9)
@pytest.mark.parametrize("hidden", ["solid", "dashed"])
def test_a_hidden_edge_that_projects_on_a_visible_one_is_dropped(hidden: str) -> None:
    lines = drawn(vp.draw(scene_of(CUBE=CUBE), vp.Camera.view("front", (0, 0, 0), 5), hidden=hidden))
    assert len(lines.hidden) == 0
    assert lines.visible.length == pytest.approx(8.0)
    iso = drawn(vp.draw(scene_of(CUBE=CUBE), vp.Camera.view("iso", (0, 0, 0), 5), hidden="solid"))
    assert iso.hidden.length == pytest.approx(6.0)
    assert iso.visible.length == pytest.approx(18.0)


def line_behind_a_vertex(seed: int, through: bool) -> tuple[vp.Scene, vp.Camera]:
    """A triangle before a plate whose one edge passes exactly behind a vertex: beside the triangle, or into it."""
    random = np.random.default_rng(seed)
    turn = rotation(random)
    eye = turn @ np.array([0.1, -0.2, 6.0])
    corners = np.array([(0, 0, 1), (1, -1, 1), (1, 1, 1)]) @ turn.T
    behind = corners[0] + 0.5 * (corners[0] - eye)
    along = turn @ (np.array([1.0, 0.1, 0.0]) if through else np.array([0.1, 1.0, 0.0]))
    down = turn @ np.array([0.0, 0.0, -2.0])
    start, end = behind - 2.5 * along, behind + (0.9 if through else 2.5) * along
    wall = vp.Mesh.from_polygons([start, end, end + down, start + down], [[0, 1, 2, 3]])
    scene = scene_of(TRIANGLE=vp.Mesh.from_triangles(corners, [[0, 1, 2]]), WALL=wall)
    return scene, vp.Camera(tuple(eye), tuple(turn @ np.zeros(3)))


@pytest.mark.hard(10)
@pytest.mark.capability("G7.2-zones")
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("through", [False, True])
def test_an_edge_through_a_vertex_of_the_occluder_changes_once_at_most(seed: int, through: bool) -> None:
    scene, camera = line_behind_a_vertex(seed, through)
    start, end = scene.items[1].shape.vertices[:2]
    lines = drawn(vp.draw(scene, camera, hidden="solid")).of(1)
    off = np.linalg.norm(np.cross(lines.world - start, end - start), axis=2) / np.linalg.norm(end - start)
    edge = lines.where((off < 1e-6).all(axis=1))
    whole = float(np.linalg.norm(end - start))
    assert edge.length == pytest.approx(whole, rel=1e-6)
    assert sorted(edge.hidden_by.tolist()) == ([0, 1] if through else [0])
    if through:
        assert edge.visible.length == pytest.approx(whole * 2.5 / 3.4, rel=1e-6)


@pytest.mark.hard(11)
@pytest.mark.parametrize("seed", range(6))
def test_no_light_leaks_through_a_t_junction(seed: int) -> None:
    turn = np.eye(4)
    turn[:3, :3] = rotation(np.random.default_rng(seed)) if seed else np.eye(3)
    scene = moved(t_junction(), turn)
    whole = scene_of(WALL=vp.Mesh.from_polygons([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [[0, 1, 2, 3]]))
    whole = vp.Scene(moved(whole, turn).items + scene.items[1:])
    for eye in ((0, -6, 0), (0.3, -6, 0.2), (-0.2, -4, 0), (0, -40, 0.4)):
        camera = vp.Camera(tuple(turn[:3, :3] @ eye), (0, 0, 0))
        behind, expected = (drawn(vp.draw(s, camera, lines=EVERY_EDGE, hidden="solid")).of(1) for s in (scene, whole))
        assert set(behind.hidden_by.tolist()) == {1, 2}, "by the wall, and some by the box itself"
        for count in (1, 2):
            lengths = [lines.where(lines.hidden_by == count).length for lines in (behind, expected)]
            assert lengths[0] == pytest.approx(lengths[1])


@pytest.mark.slow
@pytest.mark.hard(12)
def test_an_edge_with_three_faces_or_more_is_drawn() -> None:
    book, cubes = non_manifold_edge().items
    for angle in np.radians([5, 80, 95, 200, 275, 330]):
        camera = vp.Camera((9 * np.cos(angle), 9 * np.sin(angle), 0.5), (0, 0, 0.5))
        spine = drawn(vp.draw(vp.Scene((book,)), camera)).visible
        spine = spine.where((np.abs(spine.world[:, :, :2]) < 1e-9).all(axis=(1, 2)))
        hidden = assert_right(vp.Scene((book,)), camera) and len(spine) == 0
        assert hidden or spine.length == pytest.approx(1.0)
    flat = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0), (0, 0, 1), (0, 1, 1)]
    tee = scene_of(TEE=vp.Mesh.from_polygons(flat, [[0, 1, 2, 3], [0, 3, 4, 5], [0, 6, 7, 3]]))
    from_below = drawn(vp.draw(tee, vp.Camera((0.3, 0.4, -9), (0, 0, 0)))).visible
    assert from_below.of_kind("crease").length == pytest.approx(1.0), "two of the three faces are in one plane"
    assert_right(vp.Scene((cubes,)), vp.Camera((9, -7, 5), (3, 1, 0.5)))


@pytest.mark.hard(13)
def test_an_open_mesh_draws_its_border_and_hides_from_both_sides() -> None:
    scene = open_mesh()
    above = drawn(vp.draw(scene, vp.Camera((1, 0.5, 9), (1, 0.5, 0))))
    assert above.of_kind("boundary").length == pytest.approx(6.0), "the rim"
    assert above.length == pytest.approx(6.0 + 6.0 + 4.0), "and the bottom and the corners inside"
    assert_right(scene, vp.Camera((5, -4, 6), (1, 0.5, 0.5)))
    sheet = scene_of(ABOVE=box((-0.2, -0.2, 1), (0.2, 0.2, 1.2)), SHEET=plate((-1, -1), (1, 1), 0))
    sheet = vp.Scene((*sheet.items, *scene_of(BELOW=box((-0.2, -0.2, -1), (0.2, 0.2, -0.8))).items))
    for height, seen, unseen in ((7, 0, 2), (-7, 2, 0)):
        lines = drawn(vp.draw(sheet, vp.Camera((0.1, 0.2, height), (0, 0, 0)), hidden="solid"))
        assert len(lines.of(unseen).visible) == 0 and len(lines.of(unseen).hidden) > 0
        assert lines.of(seen).visible.length == pytest.approx(1.6), "the face that it turns to the eye"


@pytest.mark.hard(14)
def test_mixed_winding_changes_nothing() -> None:
    tube = hollow_tube().items[0].shape
    faces = tube.polygons()
    present = np.ones(len(faces), dtype=bool) if tube.present is None else tube.present
    mixed = [face[::-1] if k % 3 == 1 else face for k, face in enumerate(faces)]
    turned = vp.Mesh.from_polygons(tube.vertices, mixed, present=present)
    behind = hollow_tube().items[1:]
    for camera in (vp.Camera((8, -3, 2), (0, 0, 0)), vp.Camera((3, -7, 5), (0, 0, 0), parallel=True)):
        pair = [
            vp.draw(vp.Scene((vp.Item("TUBE", mesh), *behind)), camera, hidden="solid", lines=EVERY_EDGE)
            for mesh in (tube, turned)
        ]
        assert_drawings_equal(*pair, 1e-6)


@pytest.mark.hard(14)
def test_a_moebius_strip_is_read_with_a_warning_and_drawn_from_both_sides(tmp_path: Path) -> None:
    strip = moebius_strip()
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in strip.vertices.tolist()]
    rows += ["f " + " ".join(str(k + 1) for k in face) for face in strip.polygons()]
    (tmp_path / "strip.obj").write_text("\n".join(rows))
    with pytest.warns(vp.InputWarning, match="one-sided"):
        scene = vp.read(tmp_path / "strip.obj")
    for eye in ((6, -5, 4), (-3, 7, -5), (0.1, 0.2, 8)):
        assert_right(scene, vp.Camera(eye, (0, 0, 0)))
        assert drawn(vp.draw(scene, vp.Camera(eye, (0, 0, 0)))).of_kind("boundary").length > 5


def cube_triangles() -> list[np.ndarray]:
    triangles = [np.array(face)[[0, k, k + 1]] for face in CUBE.polygons() for k in (1, 2)]
    return [CUBE.vertices[triangle] for triangle in triangles]


@pytest.mark.hard(15)
def test_an_stl_soup_is_welded_and_shows_no_inner_diagonals(tmp_path: Path) -> None:
    rows = ["solid soup"]
    for triangle in cube_triangles():
        corners = "\n".join("vertex {} {} {}".format(*corner) for corner in triangle.tolist())
        rows.append(f"facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet")
    (tmp_path / "soup.stl").write_text("\n".join([*rows, "endsolid soup"]))
    soup = vp.read(tmp_path / "soup.stl")
    assert len(soup.vertices) == 8
    camera = vp.Camera((5, -7, 4), (0, 0, 0))
    drawing = vp.draw(soup, camera, hidden="solid")
    assert_drawings_equal(drawing, vp.draw(scene_of(CUBE=CUBE), camera, hidden="solid"), 1e-6)
    assert drawn(drawing).visible.length == pytest.approx(18.0)
    assert drawn(drawing).hidden.length == pytest.approx(6.0)


@pytest.mark.hard(16)
def test_triangles_without_area_are_dropped_and_counted(tmp_path: Path) -> None:
    rows = ["v {} {} {}".format(*vertex) for vertex in [*CUBE.vertices.tolist(), (0, -1, -1)]]
    rows += ["f " + " ".join(str(k + 1) for k in face) for face in CUBE.polygons()]
    (tmp_path / "good.obj").write_text("\n".join(rows))
    (tmp_path / "bad.obj").write_text("\n".join([*rows, "f 1 1 2", "f 1 9 2", "f 3 3 3"]))
    good = vp.read(tmp_path / "good.obj")
    with pytest.warns(vp.InputWarning, match="dropped 3 degenerate faces"):
        bad = vp.read(tmp_path / "bad.obj")
    camera = vp.Camera((5, -7, 4), (0, 0, 0))
    assert_drawings_equal(*(vp.draw(scene, camera, lines=EVERY_EDGE, hidden="solid") for scene in (good, bad)), 1e-6)


@pytest.mark.hard(16)
@pytest.mark.parametrize("points", [[(0, 0, 0), (1, 1, 1), (2, 2, 2)], [(1, 2, 3)] * 3])
def test_a_scene_of_one_triangle_without_area_hides_nothing(points: list) -> None:
    speck = scene_of(SPECK=vp.Mesh.from_triangles(points, [[0, 1, 2]]))
    for camera in (vp.Camera((5, -7, 4), (0, 0, 0)), vp.Camera((7, 7, 7), (1, 1, 1)), vp.Camera.view("top")):
        drawing = vp.draw(speck, camera, lines=EVERY_EDGE, hidden="solid")
        assert len(drawn(drawing).hidden) == 0
        assert stroke_count(drawing) <= 1, "a line along the ray, or of no length, is not stroked"
