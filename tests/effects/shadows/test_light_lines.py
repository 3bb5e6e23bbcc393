"""Terminators and the edges of shadows as kinds of lines: closed forms, rays, and what is no such line."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.drawn import Drawn, drawn
from support.grazing_rays import grazing_gaps, shadow_points
from support.light_by_rays import shone_on, towards, uncovered

import vectorplot as vp
from vectorplot.animation.animation_file import parse_animation
from vectorplot.curves import Circle
from vectorplot.geometry import box
from vectorplot.scene.light import Light
from vectorplot.surfaces import Capped, Cylinder, ImplicitTorus, Sphere, Torus, rod
from vectorplot.testing import visible_by_rays

SUN = Light((-2.0, -1.0, 2.5), parallel=True, name="SUN")
CAMERA = vp.Camera((5.0, -9.0, 7.0))
BOTH = "terminator,shadow"


def moved(item: vp.Item, x: float, y: float, z: float, size: float = 1.0) -> vp.Item:
    matrix = np.diag([size, size, size, 1.0])
    matrix[:3, 3] = x, y, z
    return item.transformed(matrix)


def block(name: str, corner: tuple[float, float, float], lengths: tuple[float, float, float], **how) -> vp.Item:
    return moved(vp.Item(name, box(lengths), **how), *corner)


def floor(z: float = 0.0, reach: float = 6.0, **how) -> vp.Item:
    corners = [(-reach, -reach, z), (reach, -reach, z), (reach, reach, z), (-reach, reach, z)]
    return vp.Item("floor", vp.Mesh.from_polygons(corners, [(0, 1, 2, 3)]), **how)


def lines_of(scene: vp.Scene, camera: vp.Camera | str = CAMERA, lines: str = BOTH, hidden: str = "solid") -> Drawn:
    return drawn(vp.draw(scene, camera, lines=lines, hidden=hidden, curves="polyline", tolerance_mm=0.1))


def on_lines(lines: Drawn) -> np.ndarray:
    return lines.world.reshape(-1, 3)


def test_the_terminator_of_a_ball_is_a_great_circle_and_its_shadow_an_ellipse():
    scene = vp.Scene((vp.Item("ball", Sphere(1.0)), floor(-1.0)), lights=(SUN,))
    found = lines_of(scene)
    way = np.array(SUN.position) / np.linalg.norm(SUN.position)
    points = on_lines(found.of_kind("terminator"))
    assert np.abs(points @ way).max() < 1e-9
    assert np.abs(np.linalg.norm(points, axis=1) - 1.0).max() < 1e-9
    assert found.of_kind("terminator").length == pytest.approx(2.0 * np.pi, rel=1e-3)
    shadow = on_lines(found.of_kind("shadow"))
    assert np.abs(shadow[:, 2] + 1.0).max() < 1e-9
    # Every ray through it touches the ball; where the ball begins to hide it a chord is cut.
    off = np.sort(np.abs(np.linalg.norm(np.cross(shadow, way), axis=1) - 1.0))
    assert off[:-8].max() < 1e-9 and off.max() < 1e-3
    minor, major = 1.0, 1.0 / way[2]
    h = ((major - minor) / (major + minor)) ** 2
    around = np.pi * (major + minor) * (1.0 + 3.0 * h / (10.0 + np.sqrt(4.0 - 3.0 * h)))
    assert found.of_kind("shadow").length == pytest.approx(around, rel=1e-3)


def test_a_lamp_near_a_ball_sees_less_than_half_of_it():
    lamp = Light((0.0, 0.0, 2.0))
    found = lines_of(vp.Scene((vp.Item("ball", Sphere(1.0)), floor(-1.5)), lights=(lamp,)))
    points = on_lines(found.of_kind("terminator"))
    assert np.abs((points * towards(lamp, points)).sum(axis=1)).max() < 1e-9
    # The contour from two radii away lies at half the radius; its cone has a half angle of thirty degrees.
    assert np.abs(points[:, 2] - 0.5).max() < 1e-9
    shadow = on_lines(found.of_kind("shadow"))
    assert np.abs(np.hypot(shadow[:, 0], shadow[:, 1]) - 3.5 / np.sqrt(3.0)).max() < 1e-3


def test_a_block_throws_the_outline_that_geometry_says():
    scene = vp.Scene((block("block", (0.0, 0.0, 0.0), (1.0, 1.0, 2.0)), floor()), lights=(SUN,))
    found = lines_of(scene)
    shadow = on_lines(found.of_kind("shadow"))
    assert np.abs(shadow[:, 2]).max() < 1e-9
    # The top is moved by two from the light, along the ground.
    shift = 2.0 * np.array([2.0, 1.0]) / 2.5
    expected = {(0.0, 1.0), (1.0, 0.0)} | {tuple((np.array(c) + shift).round(6)) for c in ((0, 1), (1, 1), (1, 0))}
    assert expected <= {tuple(row) for row in shadow[:, :2].round(6).tolist()}
    assert found.of_kind("shadow").length == pytest.approx(2.0 * np.linalg.norm(shift) + 2.0)
    turning = found.of_kind("terminator")
    # Six edges part faces that are turned to the light from those that are not; the two on the ground part nothing.
    assert turning.length == pytest.approx(2.0 + 2.0 + 1.0 + 1.0)


@pytest.mark.parametrize(
    "lamp",
    [Light((-3.0, -1.0, 0.9), parallel=True), Light((0.3, 0.2, 1.4))],
    ids=["low sun", "lamp within"],
)
def test_a_ring_shadows_itself(lamp):
    scene = vp.Scene((vp.Item("ring", Torus(2.0, 0.8)),), lights=(lamp,))
    drawing = vp.draw(scene, CAMERA, lines=BOTH, hidden="solid", curves="polyline", tolerance_mm=0.1)
    assert len(uncovered(scene, lamp, drawing, 0, 16)) == 0
    found = drawn(drawing)
    points = on_lines(found.of_kind("terminator"))
    assert len(points)
    tube = points - 2.0 * points * [1, 1, 0] / np.hypot(points[:, 0], points[:, 1])[:, None]
    assert np.abs((tube * towards(lamp, points)).sum(axis=1)).max() < 1e-9
    _changes_across(scene, lamp, found)


def test_a_lamp_on_the_axis_of_a_ring_sees_whole_circles_of_it_wherever_else_things_stand():
    lamp, far = 1.4, np.hypot(2.0, 1.4)
    turn = np.arctan2(lamp, -2.0) + np.array([1.0, -1.0]) * np.arccos(0.8 / far)
    scene = vp.Scene((vp.Item("ring", Torus(2.0, 0.8)), floor(-1.0)), lights=(Light((0.0, 0.0, lamp)),))
    found = lines_of(scene).of_kind("terminator")
    assert found.length == pytest.approx(2.0 * np.pi * (2.0 + 0.8 * np.cos(turn)).sum(), rel=1e-3)


def _changes_across(scene: vp.Scene, lamp: Light, found: Drawn, step: float = 2e-3) -> None:
    """Beside the middle of each edge of a shadow, but near terminators, one place gets light and the other does not."""
    lines, size = found.of_kind("shadow"), np.ptp(scene.bounds, axis=0).max()
    turning = cKDTree(on_lines(found.of_kind("terminator")))
    way = lines.world[:, 1] - lines.world[:, 0]
    middle = lines.world.mean(axis=1)
    clear = (np.linalg.norm(way, axis=1) > step * size) & (turning.query(middle)[0] > 0.1 * size)
    middle, way = middle[clear], way[clear]
    light = towards(lamp, middle)
    across = np.cross(way, light)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    one, two = (shone_on(scene, lamp, middle + step * size * (side * across + 4.0 * light))[0] for side in (0.5, -0.5))
    assert (one != two).all()


SCENES = {
    "blocks around a lamp": vp.Scene(
        (
            block("a", (-3.0, -3.0, 0.0), (1.0, 1.0, 2.0)),
            block("b", (2.0, 1.0, 0.0), (1.0, 2.0, 1.5)),
            moved(vp.Item("ball", Sphere(0.6)), 1.5, -1.5, 0.9),
            floor(-0.2, 4.0),
        ),
        lights=(Light((0.1, 0.2, 1.2)),),
    ),
    "balls": vp.Scene(
        (
            vp.Item("large", Sphere(1.0)),
            moved(vp.Item("middle", Sphere(0.5)), 1.6, 0.3, 0.9),
            moved(vp.Item("small", Sphere(0.3)), -0.2, -1.3, 1.2),
        ),
        lights=(Light((3.0, 0.5, 2.2), parallel=True),),
    ),
    "beam over ring": vp.Scene(
        (vp.Item("ring", Torus(2.0, 0.8)), block("beam", (-3.0, -0.3, 1.5), (6.0, 0.6, 0.4))),
        lights=(Light((1.0, -1.5, 4.0), parallel=True),),
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_wherever_light_ends_a_line_lies(name):
    scene = SCENES[name]
    drawing = vp.draw(scene, CAMERA, lines=BOTH, hidden="solid", curves="polyline", tolerance_mm=0.1)
    for number in range(len(scene.items)):
        left = uncovered(scene, scene.lights[0], drawing, number, 16)
        # Where a block stands on the floor nothing but the block begins.
        assert len(left) == 0, scene.items[number].name


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_light_grazes_something_on_its_way_to_the_edge_of_a_shadow(name):
    scene = SCENES[name]
    drawing = vp.draw(scene, CAMERA, lines="shadow", hidden="solid", curves="polyline", tolerance_mm=0.1)
    points, ends = shadow_points(drawing)
    gaps = grazing_gaps(scene, scene.lights[0], points)
    assert len(points) > 50
    # What the eye sees ends somewhere on a chord, a tenth of a mm beside the curve at most.
    assert gaps[~ends].max() < 1e-9 and gaps.max() < 0.1 / np.linalg.norm(drawing.page_from_world[0, :3])


@pytest.mark.parametrize("name", SCENES)
def test_what_is_seen_is_seen_by_rays(name):
    scene = SCENES[name]
    seen = lines_of(scene, hidden="none")
    inner = np.flatnonzero((seen.world[1:, 0] == seen.world[:-1, 1]).all(axis=1)) + 1
    points = seen.world[inner[:: max(len(inner) // 100, 1)], 0]
    sight = visible_by_rays(scene, CAMERA, points)
    assert (sight.hidden_by[sight.clearance > 1e-5] == 0).all()


def test_a_terminator_in_the_shadow_of_another_thing_is_none():
    board = block("board", (-3.0, -3.0, 2.0), (6.0, 6.0, 0.1))
    above = Light((0.0, 0.0, 1.0), parallel=True)
    scene = vp.Scene((vp.Item("ball", Sphere(1.0)), board), lights=(above,))
    ball = lines_of(scene).of(0)
    assert len(ball) == 0
    alone = replace(scene, items=(scene.items[0],))
    assert len(lines_of(alone).of_kind("terminator")) > 10


def test_a_face_that_is_seen_from_its_dark_side_has_no_shadow():
    board = block("board", (-1.0, -1.0, -2.0), (1.0, 1.0, 0.2))
    below = Light((0.3, 0.2, -1.0), parallel=True)
    scene = vp.Scene((floor(0.0), board), lights=(below,))
    assert len(lines_of(scene, "top").of(0)) == 0
    assert len(lines_of(scene, vp.Camera((3.0, -4.0, -6.0))).of(0)) > 0


def test_what_light_goes_through_throws_no_shadow_and_gets_none():
    glass = block("glass", (0.0, 0.0, 1.0), (1.0, 1.0, 0.2), material=vp.Material("transparent", opacity=0.3))
    scene = vp.Scene((floor(), glass), lights=(SUN,))
    assert len(lines_of(scene).of_kind("shadow")) == 0
    roof = block("roof", (-0.5, -0.5, 2.0), (3.0, 3.0, 0.2))
    both = lines_of(replace(scene, items=(*scene.items, roof))).of_kind("shadow")
    slant = 0.2 * np.hypot(2.0, 1.0) / 2.5
    assert both.of(0).length == pytest.approx(12.0 + 2.0 * slant) and len(both.of(1)) == 0


def test_light_goes_through_a_ball_of_glass():
    glass = vp.Item("glass", Sphere(1.0), material=vp.Material("transparent", opacity=0.3))
    bead = moved(vp.Item("bead", Sphere(0.3)), 1.6, 0.8, -2.0)
    scene = vp.Scene((floor(-4.0), moved(glass, 0.0, 0.0, 0.0), bead), lights=(SUN,))
    found = lines_of(scene)
    alone = lines_of(replace(scene, items=(scene.items[0], scene.items[2])))
    assert found.of(0).length == pytest.approx(alone.of(0).length, rel=1e-3)
    assert found.of(2).length == pytest.approx(alone.of(1).length, rel=1e-3)
    assert len(found.of(1).of_kind("terminator")) and not len(found.of(1).of_kind("shadow"))


def test_boxes_side_by_side_throw_one_shadow():
    one, two = block("one", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), block("two", (1.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    whole = block("whole", (0.0, 0.0, 0.0), (2.0, 1.0, 1.0))
    apart = lines_of(vp.Scene((floor(), one, two), lights=(SUN,)))
    together = lines_of(vp.Scene((floor(), whole), lights=(SUN,)))
    assert apart.of(0).length == pytest.approx(together.of(0).length)
    assert apart.of_kind("terminator").length == pytest.approx(together.of_kind("terminator").length)


def test_straight_from_above_upright_walls_turn_away_at_their_upper_edges():
    scene = vp.Scene((block("block", (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)), floor()), lights=(Light((0, 0, 1), True),))
    found = lines_of(scene)
    assert np.abs(on_lines(found.of_kind("terminator"))[:, 2] - 2.0).max() < 1e-12
    assert found.of_kind("shadow").length == pytest.approx(4.0)


def test_a_can_on_the_floor_has_two_rulings_and_half_a_rim():
    can = vp.Item("can", Capped(Cylinder(0.7, 0.0, 2.0)))
    found = lines_of(vp.Scene((can, floor()), lights=(SUN,)))
    turning = found.of_kind("terminator")
    assert turning.length == pytest.approx(2.0 * 2.0 + 0.7 * np.pi, rel=1e-3)
    shadow = on_lines(found.of_kind("shadow"))
    assert np.abs(shadow[:, 2]).max() < 1e-9


def test_a_surface_by_an_equation_has_the_lines_of_the_same_one_with_parameters():
    light = Light((-3.0, -1.0, 2.0), parallel=True)
    ball = moved(vp.Item("ball", Sphere(0.5)), -2.6, -0.4, 2.0)
    drawings = [
        drawn(vp.draw(vp.Scene((vp.Item("ring", shape), ball), (light,)), CAMERA, lines=BOTH, tolerance_mm=0.5))
        for shape in (Torus(2.0, 0.8), ImplicitTorus(2.0, 0.8))
    ]
    for word in ("terminator", "shadow"):
        one, two = (found.of_kind(word).of(0).length for found in drawings)
        assert one == pytest.approx(two, rel=1e-2) and one > 1.0


@pytest.mark.parametrize(("size", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_size_and_place_change_nothing(size, shift):
    scene = vp.Scene((block("block", (0.0, 0.0, 0.0), (1.0, 1.0, 2.0)), floor(), vp.Item("ball", Sphere(0.5))), (SUN,))
    other = replace(scene, items=tuple(moved(item, shift, 0.0, 0.0, size) for item in scene.items))
    camera = vp.Camera(tuple(size * np.array(CAMERA.eye) + [shift, 0.0, 0.0]), target=(shift, 0.0, 0.0))
    one, two = lines_of(scene), lines_of(other, camera)
    assert one.length_mm == pytest.approx(two.length_mm, rel=1e-5)


def test_nobody_pays_who_does_not_ask():
    scene = vp.Scene((vp.Item("ball", Sphere(1.0)), floor(-1.0)), lights=(SUN,))
    reports = []
    vp.draw(scene, CAMERA, explain=reports.append)
    assert "light and dark" not in [report.name for report in reports]
    vp.draw(scene, CAMERA, lines=BOTH, explain=reports.append)
    (told,) = {report.why for report in reports if report.name == "light and dark"}
    assert told == "terminators and edges of shadows of 1 light"


def test_lights_that_are_out_end_nowhere_and_without_lights_one_shines_from_the_upper_left():
    scene = vp.Scene((vp.Item("ball", Sphere(1.0)),))
    out = replace(scene, lights=(replace(SUN, intensity=0.0),))
    assert len(lines_of(out)) == 0
    assert len(lines_of(scene).of_kind("terminator")) > 0


def test_items_ask_for_them_and_other_verbs_draw_them():
    ball = vp.Item("ball", Sphere(1.0), lines=("contour", "terminator"))
    scene = vp.Scene((ball, floor(-1.0, lines=("boundary", "shadow"))), lights=(SUN,))
    found = drawn(vp.draw(scene, CAMERA))
    assert len(found.of(0).of_kind("terminator")) and not len(found.of(0).of_kind("shadow"))
    assert len(found.of(1).of_kind("shadow"))
    painted = vp.paint(scene, CAMERA, lines=BOTH)
    assert {"terminator", "shadow"} <= {layer.name for layer in painted.layers if len(layer.strokes)}
    plain, lined = (vp.render(scene, CAMERA, size=(60, 60), lines=lines) for lines in ("none", BOTH))
    assert (plain.pixels != lined.pixels).any()


def _block_and_ball(**how) -> vp.Scene:
    ball = vp.Item("ball", Sphere(1.0), lines=("contour", "terminator", "shadow")).moved(0.0, 0.0, 1.0)
    block_ = block("block", (-2.0, -2.0, -0.4), (4.0, 4.0, 0.4), lines=("contour", "crease", "shadow"))
    return vp.Scene((ball, block_), (SUN,), **how)


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["lines", "shading"])
def test_in_films_they_move_with_the_lamp(mode):
    text = "frames 3 light SUN direction linear at 0 -2 -1 2.5 at 1 2 -1 2.5"
    film = vp.animate(parse_animation(text, _block_and_ball(camera=CAMERA)), mode=mode, page="100x80", lines=BOTH)
    for number, x in enumerate((-2.0, 0.0, 2.0)):
        way = np.array([x, -1.0, 2.5]) / np.linalg.norm([x, -1.0, 2.5])
        found = drawn(film.picture(number))
        turning, shadow = (on_lines(found.of_kind(word)) for word in ("terminator", "shadow"))
        assert len(turning) > 10 and np.abs((turning - (0.0, 0.0, 1.0)) @ way).max() < 1e-9
        floor_ = shadow[np.abs(shadow[:, 2]) < 1e-9]
        off = np.abs(np.linalg.norm(np.cross(floor_ - (0.0, 0.0, 1.0), way), axis=1) - 1.0)
        assert len(floor_) > 10 and np.median(off) < 1e-9 and off.max() < 1e-2


@pytest.mark.slow
def test_sheets_have_those_of_items_that_ask_for_them():
    scene = _block_and_ball()
    sheet = vp.technical_sheet(scene, views="front,top,iso", scale="10:1")
    bare = replace(scene, items=tuple(replace(item, lines=None) for item in scene.items))
    plain = vp.technical_sheet(bare, views="front,top,iso", scale="10:1")
    found = {layer.name for layer in sheet.layers if any(map(len, layer.strokes))}
    assert {"terminator", "shadow"} <= found
    assert not {"terminator", "shadow"} & {layer.name for layer in plain.layers if any(map(len, layer.strokes))}
    views = [marks for layer in sheet.layers if layer.name == "terminator" for marks in layer.strokes]
    # The great circle is seen in each of the three views.
    assert len(views) == 3
    side_by_side = vp.contact_sheet([vp.draw(scene, CAMERA), vp.draw(scene, "top")])
    assert {"terminator", "shadow"} <= {layer.name for layer in side_by_side.layers if any(map(len, layer.strokes))}


def test_dashed_shadows_are_hidden_lines_behind_what_hides_them():
    scene = vp.Scene((block("block", (0.0, 0.0, 0.0), (1.0, 1.0, 2.0)), floor()), lights=(SUN,))
    back = lines_of(scene, vp.Camera((-6.0, -4.0, 1.0)))
    assert len(back.of_kind("shadow").hidden)


def test_lines_of_further_lamps_have_layers_with_their_numbers():
    lamps = (SUN, Light((3.0, -1.0, 2.0), parallel=True), replace(SUN, position=(0.0, 2.0, 2.0), intensity=0.0))
    scene = vp.Scene((block("block", (0.0, 0.0, 0.0), (1.0, 1.0, 2.0)), floor()), lamps)
    drawing = vp.draw(scene, CAMERA, lines=BOTH)
    filled = [layer.name for layer in drawing.layers if len(layer.strokes) and len(layer.strokes[0])]
    assert filled == ["terminator", "shadow", "terminator 2", "shadow 2"]
    second = next(layer for layer in drawing.layers if layer.name == "shadow 2").strokes[0]
    assert (second.points3d[:, 0] <= 1.0 + 1e-9).all()


def test_on_meshes_that_stand_for_smooth_shapes_terminators_run_across_faces():
    u, v = (axis.ravel() for axis in np.meshgrid(np.arange(24), np.arange(12), indexing="ij"))
    angle, height = np.pi * u / 12.0, np.pi * (v + 0.5) / 12.0
    points = np.stack([np.sin(height) * np.cos(angle), np.sin(height) * np.sin(angle), np.cos(height)], axis=1)
    quads = [
        (12 * a + b, 12 * a + b + 1, 12 * ((a + 1) % 24) + b + 1, 12 * ((a + 1) % 24) + b)
        for a in range(24)
        for b in range(11)
    ]
    caps = [tuple(12 * np.arange(24)), tuple(12 * np.arange(24)[::-1] + 11)]
    mesh = vp.Mesh.from_polygons(points, quads + caps)
    smooth = vp.SurfaceLines(smooth_contours=True)
    edges, across = (
        lines_of(vp.Scene((vp.Item("ball", mesh, **how),), (SUN,)), lines="terminator", hidden="solid")
        for how in ({}, {"curves": smooth})
    )
    way = np.array(SUN.position) / np.linalg.norm(SUN.position)
    off = [np.abs(on_lines(found) @ way).max() for found in (edges, across)]
    assert off[1] < 0.05 < off[0]
    assert across.length == pytest.approx(2.0 * np.pi, rel=0.03)


def test_without_anything_to_shine_on_there_are_no_lines():
    scene = vp.Scene((vp.Item("line", Circle((0, 0, 0), 1.0)),), (SUN,))
    found = drawn(vp.draw(scene, CAMERA, lines="curve,terminator,shadow"))
    assert len(found) and not len(found.of_kind("terminator", "shadow"))


@pytest.mark.slow
def test_a_can_on_a_can_throws_no_shadow_inside_of_it():
    cans = [vp.Item("lower", rod((0, 0, 0), (0, 0, 1), 1.0)), vp.Item("upper", rod((0, 0, 1), (0, 0, 2), 0.5))]
    lamp = Light((-7.0, -1.0, 3.0))
    points = on_lines(lines_of(vp.Scene(tuple(cans), (lamp,))).of(0).of_kind("shadow"))
    mantle = points[points[:, 2] < 1.0 - 1e-6]
    assert len(points) > 10 and ((mantle * [1, 1, 0] * (lamp.position - mantle)).sum(axis=1) > 0.0).all()
