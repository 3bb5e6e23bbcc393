"""Scenes that are cut: what is drawn is what rays see of the true cut bodies, in every verb, from files too."""

import warnings

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.effects import cut_scene
from vectorplot.geometry import box, prism
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import Cut
from vectorplot.scene.scene import together
from vectorplot.surfaces import Cylinder, Ellipsoid, Sphere, Torus, rod
from vectorplot.testing.shapes import without

EYE = np.array([7.0, -11.0, 6.0])
CAMERA = vp.Camera(tuple(EYE), (0.0, 0.0, 0.0))


def strokes(drawing: vp.Drawing, *names: str) -> np.ndarray:
    """(n,3) points along the strokes of some layers, of all where none is named."""
    found = [np.zeros((0, 3))]
    for layer in drawing.layers:
        for one in layer.strokes if not names or layer.name in names else ():
            for k in range(len(one)):
                points = one.points3d[one.offsets[k] : one.offsets[k + 1]]
                points = np.concatenate([points, points[:1]]) if one.closed[k] else points
                part = np.linspace(0.05, 0.95, 7)[:, None, None]
                found.append((points[:-1] + part * (points[1:] - points[:-1])).reshape(-1, 3))
    return np.concatenate(found)


def lengths(drawing: vp.Drawing, leave_out: tuple[str, ...] = ("hatch",)) -> float:
    total = 0.0
    for layer in drawing.layers:
        for one in layer.strokes if layer.name not in leave_out else ():
            for k in range(len(one)):
                points = one.points[one.offsets[k] : one.offsets[k + 1]]
                total += float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
                total += float(np.linalg.norm(points[-1] - points[0])) if one.closed[k] else 0.0
    return total


def test_a_corner_cut_out_of_a_box_draws_the_lines_of_the_body_that_is_left():
    cut = vp.cut(vp.Scene((vp.Item("B", box((4, 4, 2))),)), "x > 2, y < 1")
    elbow = prism([(0, 0, 0), (2, 0, 0), (2, 1, 0), (4, 1, 0), (4, 4, 0), (0, 4, 0)], (0, 0, 2))
    kinds = "contour,boundary,crease,cut"
    page = vp.Page(100, 80)
    one = vp.draw(cut, CAMERA, page=page, lines=kinds, curves="polyline")
    two = vp.draw(vp.Scene((vp.Item("E", elbow),)), CAMERA, page=page, lines=kinds, curves="polyline")
    assert lengths(one) == pytest.approx(lengths(two), abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "scale"), [(Sphere(2.0), 1e-6), (Sphere(2.0), 1e6), (Ellipsoid((2.0, 1.5, 1.0)), 1.0)]
)
def test_what_is_drawn_of_a_cut_ball_is_what_rays_see(shape, scale):
    axes = np.array([2.0, 2.0, 2.0]) if isinstance(shape, Sphere) else np.array([2.0, 1.5, 1.0])
    normal, offset = np.array([2.0, -1.0, 2.0]) / 3.0, 0.4
    item = vp.Item("ball", shape).scaled(scale)
    cut = vp.cut(vp.Scene((item,)), f"2x - y + 2z > {3.0 * offset * scale!r}")
    camera = vp.Camera(tuple(scale * EYE), (0.0, 0.0, 0.0))
    drawing = vp.draw(cut, camera, page=vp.Page(100, 80), curves="polyline", tolerance_mm=0.005)
    points = strokes(drawing) / scale
    assert {"contour", "cut", "hatch"} <= {layer.name for layer in drawing.layers if len(layer.strokes[0])}
    # Where the ray enters the ball and the half space: both are convex, and so is what they have in common.
    way = points - EYE
    a, b = ((way / axes) ** 2).sum(axis=1), (way / axes) @ (EYE / axes)
    root = np.sqrt(np.maximum(b * b - a * (((EYE / axes) ** 2).sum() - 1.0), 0.0))
    slope, height = way @ normal, float(EYE @ normal) - offset
    plane = np.where(slope < 0.0, -height / slope, -np.inf)
    enter = np.maximum((-b - root) / a, plane)
    assert (enter > 1.0 - 2e-3).all()
    on_ball, on_plane = np.abs(((points / axes) ** 2).sum(axis=1) - 1.0) < 1e-3, np.abs(points @ normal - offset) < 1e-6
    assert (on_ball | on_plane).all() and (points @ normal < offset + 1e-6).all()
    hatch = strokes(drawing, "hatch") / scale
    assert (np.abs(hatch @ normal - offset) < 1e-9).all() and (((hatch / axes) ** 2).sum(axis=1) < 1.0 + 1e-4).all()


@pytest.mark.parametrize(
    ("shape", "text", "area"),
    [
        (Sphere(2.0), "z > 1", 3.0 * np.pi),
        (Torus(3.0, 1.0), "y = 0", 2.0 * np.pi),
        (Torus(3.0, 1.0), "z > 0", 12.0 * np.pi),
        (rod((0, 0, 0), (0, 0, 4), 1.0), "y < 0", 8.0),
        (box((2, 2, 2)), "x + y < 2", 4.0 * np.sqrt(2.0)),
    ],
)
def test_faces_of_cuts_have_the_area_of_the_true_section(shape, text, area):
    after = cut_scene(vp.cut(vp.Scene((vp.Item("S", shape),)), text), CAMERA)
    found = sum(float(np.linalg.norm(i.mesh.area_vectors, axis=1).sum()) for i in after.items if i.is_cut_face)
    # Area vectors are twice as long.
    assert found / 2.0 == pytest.approx(area, rel=2e-4)


@pytest.mark.slow
def test_smooth_surfaces_that_are_cut_alike_are_drawn_each_in_its_place():
    places, tube = (-4.0, 4.0), 0.5
    rings = [vp.Item(f"R{x}", Torus(2.0, tube).moved(x, 0, 0.1 * x), lines=("contour",)) for x in places]
    drawing = vp.draw(vp.cut(vp.Scene(tuple(rings)), "y < 0"), CAMERA)
    found = strokes(drawing, "cut").reshape(-1, 3)
    middles = np.array([(x + side, 0.0, 0.1 * x) for x in places for side in (-2.0, 2.0)])
    far = np.linalg.norm(found[:, None] - middles, axis=2)
    assert np.abs(found[:, 1]).max() < 1e-6 and np.abs(far.min(axis=1) - tube).max() < 1e-3
    assert set(np.argmin(far, axis=1)) == set(range(len(middles)))


def test_parts_that_touch_are_hatched_otherwise_and_parts_in_parts_are_cut_out():
    items = [vp.Item(f"P{k}", box((1, 1, 1)).moved(k, 0, 0)) for k in range(4)]
    items += [vp.Item("inner", box((0.5, 1, 0.5)).moved(0.25, 0, 0.25))]
    after = cut_scene(vp.cut(vp.Scene(tuple(items)), "y < 0.5"), CAMERA)
    faces = {item.name: item for item in after.items if item.is_cut_face}
    ways = {name: item.curves.sections[0].normal for name, item in faces.items()}
    for one, other in [("P0", "P1"), ("P1", "P2"), ("P2", "P3"), ("P0", "inner")]:
        spacings = [np.diff(faces[f"{name} cut"].curves.sections[0].offsets)[0] for name in (one, other)]
        turned = not np.allclose(ways[f"{one} cut"], ways[f"{other} cut"])
        assert turned or spacings[0] != pytest.approx(spacings[1])
    whole, left = (float(np.linalg.norm(faces[n].mesh.area_vectors.sum(axis=0))) for n in ("P1 cut", "P0 cut"))
    assert left == pytest.approx(0.75 * whole)


def test_open_meshes_have_no_faces_and_one_line_says_so():
    scene = vp.Scene((vp.Item("open", without(box((2, 2, 2)), 5)),))
    with pytest.warns(vp.InputWarning, match="open: open where cut") as told:
        after = cut_scene(vp.cut(scene, "x > 1"), CAMERA)
    assert len(told) == 1 and len(after.items) == 1


@pytest.mark.parametrize("text", ["x > 5", "x < 5", "x < 0", "x + y > 3.5, z > 2.5, x < 3", "x + z > 3.9, y < 0"])
def test_what_is_open_and_not_cut_is_not_told(text):
    scene = vp.Scene((vp.Item("open", without(box((2, 2, 2)), 5)), vp.Item("far", box((1, 1, 1)).moved(9, 9, 9))))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cut_scene(vp.cut(scene, text), CAMERA)


@pytest.mark.parametrize(("text", "told"), [("z > 0.5", True), ("z > 3", False), ("x + y > 1.5, z > 0.9", False)])
def test_open_surfaces_are_told_where_they_are_cut_alone(text, told):
    scene = vp.Scene((vp.Item("tube", Cylinder(1.0, 0.0, 1.0)),))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        cut_scene(vp.cut(scene, text), CAMERA)
    assert bool(found) == told


def test_planes_beyond_all_numbers_of_the_scene_have_a_side_of_the_eye():
    near, far = (Cut.of(text).region(CAMERA).normals for text in ("x = -1e308", "x = 1e308"))
    assert near == ((1.0, 0.0, 0.0),) and far == ((-1.0, -0.0, -0.0),)


@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_every_verb_cuts_and_files_say_the_same(verb):
    text = 'camera eye 7 -11 6 target 0 0 0\nA red box 2 2 2 solid\ncut "x > 1, y = 1" colour blue'
    scene = parse_scene(text)
    assert scene.cuts == (Cut.of("x > 1, y = 1", colour="blue"),)
    assert parse_scene(write_scene(scene)).cuts == scene.cuts
    plain = vp.cut(parse_scene(text.rpartition("\n")[0]), "x > 1, y = 1", colour="blue")
    size = {"size": (60, 40), "samples": 1} if verb == "render" else {}
    one, two = (getattr(vp, verb)(each, **size) for each in (scene, plain))
    if verb == "render":
        assert np.array_equal(one.pixels, two.pixels)
    else:
        assert len(one.layers) == len(two.layers)
        assert [i for i in one.items] == ["A", "A cut", "A cut 2"]


@pytest.mark.parametrize("away", ["ghost", "moved"])
def test_what_is_cut_away_is_a_ghost_or_moved(away):
    after = cut_scene(vp.cut(vp.Scene((vp.Item("A", box((2, 2, 2))),)), "x > 1", away), CAMERA)
    other = next(item for item in after.items if item.name == f"A {away}")
    assert np.ptp(other.mesh.bounds, axis=0).tolist() == [1.0, 2.0, 2.0]
    assert other.mesh.bounds[0].tolist() == ([1.0, 0.0, 0.0] if away == "ghost" else [2.0, 0.0, 0.0])
    drawing = vp.draw(replace_cuts(away), CAMERA)
    assert ("ghost" in [layer.name for layer in drawing.layers if len(layer.strokes[0])]) == (away == "ghost")


def replace_cuts(away: str) -> vp.Scene:
    return vp.cut(vp.Scene((vp.Item("A", box((2, 2, 2))),)), "x > 1", away)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("y", "expected conditions"),
        ("3 < 4", "x, y and z have no effect"),
        ("x = x", "x, y and z have no effect"),
        ("1e308x = -1e308x", "out of range"),
        ("1e-320x = 1", "out of range"),
        ("x = 1e400", "out of range"),
        ("q = 1", "is not a sum"),
        ("", "expected conditions"),
    ],
)
def test_what_is_no_condition_is_told_in_a_line(text, cause):
    with pytest.raises(vp.InputError, match=cause):
        Cut.of(text)


@pytest.mark.parametrize(
    ("condition", "said"), [("x = 1", "x = 1"), ("3x - 4z = 5", "0.6x - 0.8z = 1"), ("-z = 1", "-z = 1")]
)
def test_a_plane_that_is_seen_edge_on_has_no_side(condition, said):
    scene = vp.cut(vp.Scene((vp.Item("A", box((2, 2, 2))),)), condition)
    with pytest.raises(vp.InputError, match=f"the plane {said} is seen edge-on: say < or >"):
        cut_scene(scene, "front")


def test_the_command_cuts_and_explodes(tmp_path):
    (tmp_path / "a.scene").write_text("A red box 2 2 2 solid\nB blue box 1 1 1 solid translation 0 0 2")
    out = tmp_path / "a.json"
    assert run(["draw", str(tmp_path / "a.scene"), "--cut", "y=1", "--explode", "z,1.5", "-o", str(out)]) == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        text = out.read_text()
    assert '"kind": "cut"' in text and '"kind": "trace"' in text
    for axis in ("z", "0,0,1"):
        assert run(["draw", str(tmp_path / "a.scene"), "--cut", "y=1", "--explode", axis, "-o", str(out)]) == 0
        assert out.read_text() == text


def test_exploded_parts_keep_their_order_and_their_room():
    items = [vp.Item(name, box((1, 1, 1)).moved(0, 0, z)) for name, z in (("c", 5), ("a", 0), ("b", 0.5))]
    apart = vp.exploded(vp.Scene(tuple(items)), "z", 1.25)
    lows = {item.name: float(item.mesh.bounds[0, 2]) for item in apart.items if item.mesh.face_count}
    assert lows == {"a": 0.0, "b": 1.25, "c": 5.75}
    assert [item.name for item in apart.items[3:]] == ["b trace"]
    with pytest.raises(vp.InputError, match="a factor"):
        vp.exploded(vp.Scene(tuple(items)), "z", 0.5)


def test_parts_beside_each_other_move_as_one_and_come_from_what_they_stand_over():
    bolts = [vp.Item(f"bolt {k}", box((1, 1, 2)).moved(3 * k, 0, 1)) for k in range(3)]
    ring, hub = vp.Item("ring", box((3, 3, 2)).moved(0, 3, 1)), vp.Item("hub", box((1, 1, 2)).moved(1, 4, 1))
    apart = vp.exploded(vp.Scene((vp.Item("plate", box((9, 9, 1))), *bolts, ring, hub)), "z", 2.0)
    lows = [float(item.mesh.bounds[0, 2]) for item in apart.items[:6]]
    room = 11 / 6
    assert lows == pytest.approx([0, *[1 + room] * 4, 1 + 2 * room + 2])
    traces = {item.name: (item.shape.points(np.arange(2.0))[:, 2] - 1).tolist() for item in apart.items[6:]}
    assert traces["bolt 2 trace"] == pytest.approx([0, room])
    # The hub is drawn out of its ring.
    assert traces["hub trace"] == pytest.approx([room, 2 * room + 2])


def test_leaders_go_with_the_part_that_they_point_at_and_axes_stay():
    parts = [vp.Item("low", box((4, 4, 1))), vp.Item("high", box((2, 2, 1)).moved(1, 1, 1))]
    leaders = [vp.leader((4, 2, 0.5), (6, 2, 0.5), "1"), vp.leader((3, 2, 1.5), (6, 2, 1.5), "2")]
    shown = together([vp.Scene(tuple(parts)), *leaders, vp.axes(3, origin=(2, 2, 1.5))])
    apart = vp.exploded(shown, "z", 2.0)
    heights = {one.name: float(one.shape.points(np.zeros(()))[2]) for one in apart.items[2:-1]}
    assert heights == {"leader 1": 0.5, "leader 2": 2.5, "axis x": 1.5, "axis y": 1.5, "axis z": 1.5}


def _hatch(drawing: vp.Drawing) -> tuple[np.ndarray, np.ndarray]:
    """(n,2) directions and middles of the strokes that hatch."""
    ways, middles = [], []
    for layer in drawing.layers:
        for one in layer.strokes if layer.name.startswith("hatch") else ():
            ends = np.stack([one.points[one.offsets[:-1]], one.points[one.offsets[1:] - 1]])
            ways.append((ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0], axis=1)[:, None])
            middles.append(ends.mean(axis=0))
    return np.concatenate(ways), np.concatenate(middles)


@pytest.mark.parametrize(("size", "spacing", "angle"), [(1.0, 3.0, 30.0), (1e5, 1.5, -20.0)])
def test_hatches_of_cut_faces_are_so_many_mm_apart_on_the_page(size, spacing, angle):
    scene = vp.Scene((vp.Item("B", box((4 * size, 4 * size, 2 * size))),))
    cut = vp.cut(scene, f"y = {2 * size}", spacing_mm=spacing, angle_deg=angle)
    ways, middles = _hatch(vp.draw(cut, "front", page=vp.Page(100, 80)))
    assert np.degrees(np.arctan(ways[:, 1] / ways[:, 0])) == pytest.approx(angle, abs=1e-6)
    across = np.sort(middles @ np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))]))
    assert np.diff(across) == pytest.approx(spacing, abs=1e-6)
    assert np.ptp(across) > 30.0


def test_parts_that_touch_are_hatched_otherwise_in_mm_too():
    parts = tuple(vp.Item(f"{k}", box((4, 4, 2)).moved(0, 0, 2 * k)) for k in range(2))
    cut = cut_scene(vp.cut(vp.Scene(parts), "y = 2", spacing_mm=2.0, angle_deg=10.0), "front")
    hatches = [item.hatch for item in cut.items[2:]]
    assert {(one.spacing_mm, one.angle_deg) for one in hatches} == {(2.0, 10.0), (2.0, 100.0)}
    fine = cut_scene(vp.cut(vp.Scene(parts[:1]), "y = 2", spacing_mm=0.1), "front").items[1].hatch
    assert fine is not None and fine.width_mm == pytest.approx(0.05)


def test_files_and_the_command_say_the_spacing(tmp_path):
    scene = parse_scene('B red box solid 4 4 2 cut "y = 2" spacing 3 angle 30')
    assert scene.cuts == (Cut.of("y = 2", spacing_mm=3.0, angle_deg=30.0),)
    assert parse_scene(write_scene(scene)).cuts == scene.cuts
    bare, out = tmp_path / "b.scene", tmp_path / "o.json"
    bare.write_text("B red box solid 4 4 2")
    told = ["--cut", "y=2", "--cut-spacing", "3", "--cut-angle", "30", "--view", "front"]
    assert run(["draw", str(bare), "-o", str(out), *told]) == 0
    vp.save(vp.draw(scene, "front"), tmp_path / "p.json")
    assert len(out.read_text()) == pytest.approx(len((tmp_path / "p.json").read_text()), rel=0.2)
    for words, cause in (
        ("spacing 0.05", "0.1 mm or more"),
        ("spacing x", "expected a number"),
        ("spacin 3", "spacing"),
    ):
        with pytest.raises(vp.InputError, match=cause):
            parse_scene(f'B red box solid 4 4 2 cut "y = 2" {words}')


@pytest.mark.parametrize(
    ("text", "named"), [("y = 999", "y = 999"), ("x > -9, y < 9", "x > -9, y < 9"), ("x + y < 99", "0.707x")]
)
def test_a_cut_that_takes_everything_away_is_named(text, named):
    cube = vp.Scene((vp.Item("cube", vp.Mesh.from_triangles(np.eye(3), [(0, 1, 2)])),))
    with pytest.warns(vp.InputWarning, match=f"the cut .*{named}.* takes everything away"):
        vp.draw(vp.cut(cube, text), vp.Camera((4, -5, 3)))


def test_bodies_of_one_group_but_of_two_colours_are_hatched_as_two():
    """A shaft and a bush that are moved as one are two parts."""
    parts = [vp.Item(name, box((9, 9, 9)).moved(x, 0, 0), name, group="both") for name, x in (("red", 0), ("blue", 9))]
    one, other = cut_scene(vp.cut(vp.Scene(tuple(parts)), "y = 4"), "front").items[2:]
    assert not np.allclose(one.curves.sections[0].normal, other.curves.sections[0].normal)


def test_bodies_of_one_group_are_hatched_alike_and_their_neighbours_otherwise():
    wide, narrow, beside = (box((x, 8, 20)).moved(at, 0, 0) for x, at in ((40, 0), (3, 40), (40, 43)))
    parts = [vp.Item("plate", wide, group="FLANGE"), vp.Item("rim", narrow, group="FLANGE"), vp.Item("lid", beside)]
    faces = cut_scene(vp.cut(vp.Scene(tuple(parts)), "y = 4"), "front").items[3:]
    ways = []
    for face in faces:
        (section,) = face.curves.sections
        ways.append((np.round(section.normal, 9).tolist(), round(np.diff(section.offsets).mean(), 9)))
    plate, rim, lid = ways
    assert plate == rim and plate[0] != lid[0]
    # Strokes go on from body to body.
    starts = [np.array(face.curves.sections[0].offsets) / plate[1] for face in faces[:2]]
    assert np.ptp(np.concatenate(starts) % 1.0) == pytest.approx(0.0, abs=1e-6)
