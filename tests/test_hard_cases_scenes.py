"""The hard cases of visibility, 17 to 27 and 30 to 32: sizes, numbers, cameras, changes of a whole scene."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from support.drawn import EVERY_EDGE, drawn, moved, on_page, plate, stroke_count
from support.pace import cpu_seconds
from support.paths import TESTS

import vectorplot as vp
from vectorplot.testing import assert_drawing_is_right, assert_drawings_equal, edge_points
from vectorplot.testing.drawings import worst_uncovered
from vectorplot.testing.shapes import (
    box,
    cyclic_bars,
    honeycomb,
    l_prisms,
    prism,
    rotated_boxes,
    scene_of,
    sliver,
)

RELATIVE = 190.0 * 1e-9
"""One part in a thousand million of the picture, in mm."""


def dyadic_scene() -> vp.Scene:
    """Boxes that touch, stand on and pierce each other, all of whose coordinates survive an offset of 2^20 exactly."""
    return scene_of(
        TABLE=box((-2, -1.5, -0.25), (2, 1.5, 0)),
        BOX=box((-0.5, -0.5, 0), (0.625, 0.5, 0.75)),
        BESIDE=box((0.625, -0.5, 0), (1.25, 0.25, 0.5)),
        THROUGH=box((-1.75, -0.25, 0.25), (1.75, 0.125, 0.375)),
        ELL=prism([(-1.5, 0.75), (0, 0.75), (0, 1), (-1, 1), (-1, 1.25), (-1.5, 1.25)], 0.0, 1.0),
    )


@pytest.mark.hard(17)
def test_a_sliver_a_hundred_million_times_longer_than_wide_hides_what_is_behind_it() -> None:
    needle = sliver().items[0].shape
    low = vp.Mesh.from_polygons([(-1, 1, -1), (1, 1, -1), (1, 1, 5e-9), (-1, 1, 5e-9)], [[0, 1, 2, 3]])
    scene = vp.Scene((vp.Item("NEEDLE", needle, lines=()), vp.Item("LOW", low)))
    edge = drawn(vp.draw(scene, vp.Camera.view("front", (0, 0, 0), 5), hidden="solid"))
    edge = edge.where((edge.world[:, :, 2] > 0).all(axis=1))
    assert edge.hidden.length == pytest.approx(1.5, rel=1e-6), "2e-8 (1 - |x|) is above 5e-9 where |x| < 3/4"
    assert edge.visible.length == pytest.approx(0.5, rel=1e-6)
    camera = vp.Camera((1, -5, 3), (0, 0, 0))
    behind = box((-0.5, 1, -0.5), (0.5, 2, 0.5))
    with_it, alone = (
        drawn(vp.draw(scene_of(BOX=behind, N=needle), camera)),
        drawn(vp.draw(scene_of(BOX=behind), camera)),
    )
    assert with_it.of(0).length == pytest.approx(alone.length, abs=1e-6), "not more than its width is gone"


@pytest.mark.hard(17)
def test_a_wall_of_slivers_has_no_gaps() -> None:
    heights = np.concatenate([[-1.0], np.repeat(np.linspace(-0.9, 0.9, 40), 2), [1.0]])
    heights[1:-1:2] -= 1e-8
    count = len(heights)
    vertices = [(x, 0.0, z) for x in (-1.0, 1.0) for z in heights]
    faces = [[k, k + count, k + count + 1, k + 1] for k in range(count - 1)]
    scene = scene_of(WALL=vp.Mesh.from_polygons(vertices, faces), BOX=box((-0.5, 1, -0.5), (0.5, 2, 0.5)))
    for eye in ((0, -6, 0), (0.2, -5, 0.3), (0, -7, -0.25)):
        for parallel in (True, False):
            behind = drawn(vp.draw(scene, vp.Camera(eye, (0, 0, 0), parallel=parallel), hidden="solid")).of(1)
            assert len(behind.visible) == 0 and behind.hidden.length > 3


@pytest.mark.hard(18)
@pytest.mark.parametrize("parallel", [True, False])
def test_an_offset_of_a_million_gives_the_same_drawing(parallel: bool) -> None:
    offset = np.array([2.0**20, -(2.0**20), 2.0**20])
    shift = np.eye(4)
    shift[:3, 3] = offset
    here, eye, target = dyadic_scene(), np.array([5.0, -7.0, 4.0]), np.array([0.0, 0.25, 0.25])
    there = moved(here, shift)
    assert (there.vertices - offset == here.vertices).all()
    for hidden in ("none", "solid"):
        pair = [
            vp.draw(scene, vp.Camera(tuple(eye + away), tuple(target + away), parallel=parallel), hidden=hidden)
            for scene, away in ((here, 0.0), (there, offset))
        ]
        assert_drawings_equal(*pair, RELATIVE)
        assert stroke_count(pair[0]) == stroke_count(pair[1])


@pytest.mark.hard(19)
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1e6, 1e-50, 1e50])
@pytest.mark.parametrize("parallel", [True, False])
def test_any_scale_gives_the_same_drawing(scale: float, parallel: bool) -> None:
    here = dyadic_scene()
    there = moved(here, np.diag([scale, scale, scale, 1.0]))
    eye, target = np.array([5.0, -7.0, 4.0]), np.array([0.0, 0.25, 0.25])
    for hidden in ("none", "solid"):
        pair = [
            vp.draw(scene, vp.Camera(tuple(eye * size), tuple(target * size), parallel=parallel), hidden=hidden)
            for scene, size in ((here, 1.0), (there, scale))
        ]
        assert_drawings_equal(*pair, RELATIVE)
        assert stroke_count(pair[0]) == stroke_count(pair[1])


@pytest.mark.slow
@pytest.mark.hard(20)
def test_three_bars_that_overlap_in_a_ring() -> None:
    scene = cyclic_bars()
    drawing = vp.draw(scene, vp.Camera((0, 0, 9), (0, 0, 0), up=(0, 1, 0)), hidden="solid")
    lines = drawn(drawing)
    seen = [lines.of(k).visible.length for k in range(3)]
    assert seen == pytest.approx([seen[0]] * 3), "they look the same when turned by 120 degrees"
    alone = drawn(vp.draw(vp.Scene(scene.items[:1]), vp.Camera((0, 0, 9), (0, 0, 0), up=(0, 1, 0))))
    assert 0.5 < alone.length - seen[0] < 2.5, "each hides a part of the next"
    shown, _ = edge_points(scene, 500)
    for eye in ((0, 0, 9), (1, 2, 9), (-2, 1, -9)):
        camera = vp.Camera(eye, (0, 0, 0))
        drawing = vp.draw(scene, camera, hidden="solid", lines=EVERY_EDGE)
        assert assert_drawing_is_right(drawing, scene, camera, samples=500, must_show=shown) > 500


@pytest.mark.hard(21)
def test_interpenetrating_boxes_meet_in_segments_at_which_their_edges_switch() -> None:
    scene = scene_of(BLOCK=box((-1, -1, -1), (1, 1, 1)), ROD=box((-0.5, -0.5, -2), (0.5, 0.5, 2)))
    drawing = vp.draw(scene, vp.Camera((4, -6, 5), (0, 0, 0)), hidden="solid")
    lines = drawn(drawing)
    cut = lines.of_kind("intersection")
    assert cut.length == pytest.approx(8.0), "a square in the top, and one in the bottom"
    assert cut.visible.length == pytest.approx(2.0), "two sides of the upper one"
    assert np.abs(cut.world[:, :, 2]) == pytest.approx(1.0)
    rod = lines.of(1).visible
    upright = rod.where(np.ptp(rod.world[:, :, 2], axis=1) > 0.5)
    low, high = upright.world[:, :, 2].min(axis=1), upright.world[:, :, 2].max(axis=1)
    above = low > 0
    assert above.sum() == 3
    assert (low[above], high[above]) == (pytest.approx([1.0] * 3), pytest.approx([2.0] * 3))
    without = vp.draw(scene, vp.Camera((4, -6, 5), (0, 0, 0)), lines=("contour", "crease"))
    assert len(drawn(without).of_kind("intersection")) == 0


@pytest.mark.hard(22)
@pytest.mark.capability("G7.2-zones")
def test_an_object_that_is_wholly_hidden_is_in_the_hidden_layer() -> None:
    scene = scene_of(WALL=box((-3, 0, -3), (3, 0.1, 3)), CUBE=box((-1, 1, -1), (1, 3, 1)))
    camera = vp.Camera((0.5, -8, 0.25), (0, 0, 0))
    drawing = vp.draw(scene, camera, hidden="solid")
    layers = [layer for layer in drawing.layers if any((marks.item == 1).any() for marks in layer.strokes)]
    assert [(layer.name, layer.plotted) for layer in layers] == [("hidden", True)]
    assert drawn(drawing).of(1).hidden.length == pytest.approx(24.0), "all its edges"
    plain = vp.draw(scene, camera)
    assert len(drawn(plain).of(1)) == 0 and plain.items == ("WALL", "CUBE")
    assert_drawings_equal(plain, vp.draw(vp.Scene(scene.items[:1]), camera), 1e-9)


@pytest.mark.hard(23)
@pytest.mark.parametrize("angle", [1e-9, 1e-8, 1e-7, 1e-6])
def test_edges_that_cross_at_a_tiny_angle_cross_within_both(angle: float) -> None:
    corners = [(-1, -1, 1), (1, -1, 1), (1, 0.5 * angle, 1), (-1, -1.5 * angle, 1)]
    front = vp.Item("FRONT", vp.Mesh.from_polygons(corners, [[0, 1, 2, 3]]), lines=())
    back = vp.Item("BACK", plate((-0.9, -1), (0.9, 0), 0))
    for order in ((front, back), (back, front)):
        lines = drawn(vp.draw(vp.Scene(order), vp.Camera.view("top", (0, 0, 0), 5), hidden="solid"))
        # Along x: the side edges reach out over the tilted edge as well, by its height there.
        way = np.abs(lines.world[:, 1] - lines.world[:, 0])
        edge = lines.where((np.abs(lines.world[:, :, 1]) < 1e-5).all(axis=1) & (way[:, 0] > way[:, 1]))
        assert edge.length == pytest.approx(1.8)
        # A thousand millionth of the picture is no distance: there the edge lies on the border, which does not hide.
        expected = (1.8, 0.0) if angle == 1e-9 else (1.4, 0.4)
        assert (edge.visible.length, edge.hidden.length) == pytest.approx(expected, rel=1e-6)
        assert len(edge.visible) <= 1 and len(edge.hidden) <= 1, "one state change at most"


@pytest.mark.hard(24)
@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("gap", [2.5e-9, 1e-8, 1e-6])
def test_of_two_plates_a_thousand_millionth_apart_the_near_one_wins(gap: float, parallel: bool) -> None:
    scene = scene_of(LARGE=plate((-1, -1), (1, 1), gap), SMALL=plate((-0.5, -0.5), (0.5, 0.5), 0.0))
    for order in (scene.items, scene.items[::-1]):
        small = [item.name for item in order].index("SMALL")
        for height, wins in ((6, "LARGE"), (-6, "SMALL")):
            camera = vp.Camera((0.1, 0.2, height), (0, 0, 0), parallel=parallel)
            lines = drawn(vp.draw(vp.Scene(order), camera, hidden="solid"))
            assert lines.of(1 - small).visible.length == pytest.approx(8.0), "its outline is all around"
            assert lines.of(small).visible.length == pytest.approx(4.0 if wins == "SMALL" else 0.0)
            assert lines.of(small).hidden.length == pytest.approx(0.0 if wins == "SMALL" else 4.0)


def cylinder(sides: int, rings: int) -> vp.Mesh:
    """An upright cylinder of radius 1 whose wall has rings of faces one above the other."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.c_[np.cos(angle), np.sin(angle)]
    levels = np.linspace(0.0, 3.0, rings + 1)
    vertices = np.concatenate([np.c_[ring, np.full(sides, z)] for z in levels])
    k, after = np.arange(sides), (np.arange(sides) + 1) % sides
    walls = [np.stack([k, after, after + sides, k + sides], axis=1) + level * sides for level in range(rings)]
    faces = [list(range(sides))[::-1], (np.arange(sides) + rings * sides).tolist()]
    return vp.Mesh.from_polygons(vertices, faces + np.concatenate(walls).tolist())


@pytest.mark.slow
@pytest.mark.hard(25)
@pytest.mark.parametrize("lines", [("contour", "crease", "boundary"), EVERY_EDGE])
def test_a_cylinder_along_its_axis_is_one_closed_stroke(lines: tuple[str, ...]) -> None:
    tube = scene_of(TUBE=cylinder(500, 12))
    with cpu_seconds(5.0):
        drawing = vp.draw(tube, vp.Camera.view("top", (0, 0, 0), 9), lines=lines, hidden="solid")
        central = vp.draw(tube, vp.Camera((0, 0, 12), (0, 0, 0)), lines=lines)
    perimeter = 500 * 2 * np.sin(np.pi / 500)
    assert stroke_count(drawing) == 1
    assert drawn(drawing).length == pytest.approx(perimeter, rel=1e-4)
    assert stroke_count(central) == 1, "the rim; all the rest is behind the top"
    assert drawn(central).length == pytest.approx(perimeter, rel=1e-4)


@pytest.mark.slow
@pytest.mark.hard(26)
def test_a_honeycomb_of_161_cells_is_bounded_reports_progress_and_can_be_stopped() -> None:
    scene = honeycomb()
    assert len(scene.items) == 161
    camera = vp.Camera((9, -14, 20), (0, 0, 0))
    calls: list[tuple[str, float]] = []
    with cpu_seconds(10.0):
        drawing = vp.draw(scene, camera, hidden="solid", progress=lambda stage, part: calls.append((stage, part)))
    of_stage: dict[str, list[float]] = {}
    for stage, part in calls:
        of_stage.setdefault(stage, []).append(part)
    assert all(0.0 <= parts[0] and parts == sorted(parts) and parts[-1] <= 1.0 for parts in of_stage.values())
    assert any(len(parts) > 1 and parts[-1] == 1.0 for parts in of_stage.values()), (
        "hidden lines report how far they are"
    )
    shown, _ = edge_points(scene, 300)
    assert_drawing_is_right(drawing, scene, camera, samples=600, clearance=1e-4, must_show=shown)

    def stop(stage: str, part: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vp.draw(scene, camera, progress=stop)


MILLION = """
import sys
import numpy as np
import vectorplot as vp
from vectorplot.geometry.vectors import greatest_component, least_component
from vectorplot.pictures.pipeline import peak_mb
from vectorplot.testing import visible_by_rays
from vectorplot.testing.shapes import grid_graph
sys.path.insert(0, sys.argv[1])
from support.drawn import drawn, on_page
mesh = grid_graph(710)
assert mesh.face_count > 1_000_000
scene = vp.Scene((vp.Item("GRAPH", mesh),))
camera = vp.Camera((2.5, -3.1, 1.2), (0, 0, 0))
before = peak_mb()
# On one thread: what several hold at once depends on when each of them is served.
drawing = vp.draw(scene, camera, hidden="solid", jobs=1)
peak = peak_mb()
lines = drawn(drawing)
random = np.random.default_rng(1)
which = random.integers(len(lines), size=60)
at = random.random(60)[:, None]
points = lines.world[which, 0] * (1 - at) + lines.world[which, 1] * at
# Only the triangles near a sample on the page are asked: a million rays' worth of brute force would take minutes.
place = on_page(drawing, mesh.vertices)[mesh.corners].reshape(-1, 3, 2)
low, high = least_component(place.swapaxes(1, 2)) - 0.5, greatest_component(place.swapaxes(1, 2)) + 0.5
near = np.zeros(len(low), dtype=bool)
for x, y in on_page(drawing, points):
    near |= (low[:, 0] < x) & (x < high[:, 0]) & (low[:, 1] < y) & (y < high[:, 1])
some = vp.Mesh.from_triangles(mesh.vertices, mesh.corners.reshape(-1, 3)[near])
sight = visible_by_rays(vp.Scene((vp.Item("NEAR", some),)), camera, points)
sure = sight.clearance > 1e-6
wrong = sure & (sight.hidden_by != lines.hidden_by[which])
print(peak, peak - before, sure.sum(), wrong.sum(), (lines.hidden_by[which][sure] > 0).sum())
"""


@pytest.mark.slow
@pytest.mark.hard(27)
def test_a_million_triangles_stay_below_a_ceiling_and_agree_with_rays() -> None:
    here = TESTS
    result = subprocess.run([sys.executable, "-c", MILLION, str(here)], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stderr
    peak, grown, sure, wrong, hidden = map(float, result.stdout.split())
    assert peak < 600 and grown < 400, "megabytes"
    assert wrong == 0 and sure > 30 and 5 < hidden < sure - 5


@pytest.mark.hard(30)
def test_up_along_the_view_is_an_error_and_without_up_there_is_a_fallback() -> None:
    with pytest.raises(vp.InputError, match="up vector"):
        vp.Camera((0, 0, 5), (0, 0, 0), up=(0, 0, 1))
    scene = scene_of(FLAG=plate((0, 0), (2, 1), 0))
    for height in (5, -5):
        camera = vp.Camera((0, 0, height), (0, 0, 0))
        drawing = vp.draw(scene, camera)
        assert drawn(drawing).length == pytest.approx(6.0)
        almost = vp.Camera((1e-7, 0, height), (0, 0, 0))
        corners = scene.items[0].shape.vertices
        assert on_page(drawing, corners) == pytest.approx(on_page(vp.draw(scene, almost), corners), abs=1e-4), (
            "as if the eye stood on the positive x-axis"
        )


@pytest.mark.slow
@pytest.mark.hard(31)
def test_parallel_and_far_central_projection_converge() -> None:
    scene = vp.Scene(dyadic_scene().items + l_prisms().items)
    direction = np.array([5.0, -7.0, 4.0]) / np.sqrt(90.0)
    target = np.array([0.5, 0.25, 0.25])
    limit = vp.draw(scene, vp.Camera(tuple(target + direction), tuple(target), parallel=True), hidden="solid")
    corners = scene.vertices
    off = []
    for distance in (1e2, 1e3, 1e4, 1e6):
        far = vp.draw(scene, vp.Camera(tuple(target + distance * direction), tuple(target)), hidden="solid")
        off.append(float(np.abs(on_page(far, corners) - on_page(limit, corners)).max()))
    assert np.divide(off[:-1], off[1:]) == pytest.approx([10.0, 10.0, 100.0], rel=0.2)
    assert_drawings_equal(far, limit, 2.0 * off[-1])
    assert drawn(far).visible.length == pytest.approx(drawn(limit).visible.length, rel=1e-4)


@pytest.mark.slow
@pytest.mark.hard(32)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", range(4))
def test_permuting_the_objects_changes_nothing(seed: int) -> None:
    scene = vp.Scene(rotated_boxes(20, seed).items + dyadic_scene().items)
    camera = vp.Camera((9, -14, 8), (0, 0, 0))
    order = np.random.default_rng(seed).permutation(len(scene.items))
    shuffled = vp.Scene(tuple(scene.items[k] for k in order))
    for hidden in ("none", "solid"):
        first, second = (vp.draw(s, camera, hidden=hidden) for s in (scene, shuffled))
        assert_drawings_equal(first, second, 1e-3)
        assert drawn(first).length_mm == pytest.approx(drawn(second).length_mm, rel=1e-6)


@pytest.mark.hard(32)
@pytest.mark.parametrize("seed", range(4))
def test_an_object_behind_changes_nothing_and_one_in_front_only_hides(seed: int) -> None:
    scene = rotated_boxes(20, seed)
    camera = vp.Camera((9, -14, 8), (0, 0, 0))
    wall = scene_of(WALL=box((-2, -2, -2), (2, 2, 2)))
    # A small one behind the middle of the largest body, as seen from the eye.
    largest = max((item.shape for item in scene.items), key=lambda mesh: float(np.prod(np.ptp(mesh.vertices, axis=0))))
    middle = largest.vertices.mean(axis=0)
    sight = (middle - camera.eye) / np.linalg.norm(middle - camera.eye)
    place = np.diag([0.02, 0.02, 0.02, 1.0])
    place[:3, 3] = middle + 3.0 * sight
    behind = vp.Scene(scene.items + moved(wall, place).items)
    before, after = (vp.draw(s, camera, fit=False) for s in (scene, behind))
    assert len(drawn(after).of(len(scene.items))) == 0, "it is hidden"
    assert_drawings_equal(before, after, 1e-9)
    # A large one half before the scene; where it pierces it, new lines are right.
    place = np.eye(4)
    place[:3, 3] = 4.0 * camera.direction + np.array([1.0, 1.0, 0.0])
    front = drawn(vp.draw(vp.Scene(scene.items + moved(wall, place).items), camera, fit=False))
    kept = front.where((front.item < len(scene.items)) & (front.kind != vp.LineKind.INTERSECTION))
    was = drawn(before)
    assert kept.length_mm < was.length_mm
    assert worst_uncovered(kept.page, was.page, 1e-3) is None, "nothing is visible that was not"
