"""The verb anamorphosis: what one sees in the mirror is the picture, by light that takes the shortest way."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.commands.anamorphosis import anamorphosis
from vectorplot.curves.bezier import bezier_points
from vectorplot.drawing.stroke_curves import one_mark
from vectorplot.geometry import box
from vectorplot.geometry.vectors import dot, norm
from vectorplot.pictures.anamorphosis import CurvedMirror, Setting, _fitted
from vectorplot.surfaces import Torus

TOLERANCE = 0.02
TURN = np.linspace(0.0, 2.0 * np.pi, 2001)
SEEN = [
    *(np.array([(x, 0.0), (x, 60.0)]) for x in (0.0, 17.0, 34.0, 50.0, 80.0)),
    *(np.array([(0.0, y), (80.0, y)]) for y in (0.0, 20.0, 31.0, 60.0)),
    np.array([(3.0, 5.0), (70.0, 55.0), (75.0, 8.0)]),
    np.column_stack([40.0 + 22.0 * np.cos(TURN), 30.0 + 22.0 * np.sin(TURN)]),
]
SEEN[-1][-1] = SEEN[-1][0]
"""A picture of straight lines, one with corners, and a circle in very short chords."""

MIRRORS = {
    "cylinder": vp.AnamorphicMirror("cylinder"),
    "low cylinder": vp.AnamorphicMirror(radius_mm=40.0, height_mm=60.0, viewer=(120.0, -500.0, 300.0)),
    "cone": vp.AnamorphicMirror("cone"),
    "cone from the side": vp.AnamorphicMirror("cone", radius_mm=30.0, height_mm=55.0, viewer=(20.0, -30.0, 300.0)),
    "none": vp.AnamorphicMirror("none"),
}


@cache
def picture():
    return vp.Drawing(100, 80, (vp.Layer("lines", vp.Pen(0.5, "#aa0000"), (vp.Paths.of_polylines(SEEN),)),))


@cache
def laid(name):
    return vp.anamorphosis(picture(), mirror=MIRRORS[name], tolerance_mm=TOLERANCE)


def setting_of(name) -> Setting:
    return _fitted(MIRRORS[name].curved, MIRRORS[name].eye, np.concatenate(SEEN), None)


def points_on(drawing, name, count):
    """Points on the strokes of a layer as they leave, on the paper around the mirror."""
    (layer,) = (layer for layer in drawing.layers if layer.name == name)
    strokes = one_mark(layer.marks)
    control, paths = strokes.beziers.control, strokes.paths
    each = max(2, count // max(len(control), 1))
    t = np.broadcast_to(np.linspace(0.0, 1.0, each), (len(control), each))
    parts = [bezier_points(control[:, None], t).reshape(-1, 2)]
    for k in np.flatnonzero(np.diff(strokes.beziers.offsets) == 0):
        own = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
        own = np.vstack([own, own[:1]]) if paths.closed[k] else own
        for a, b in pairwise(own):
            parts.append(a + np.linspace(0.0, 1.0, 20)[:, None] * (b - a))
    points = np.concatenate(parts) - drawing.page_from_world[:2, 3]
    return np.column_stack([points, np.zeros(len(points))])


def frames(mirror, places):
    """Two directions along the mirror at places: around its axis, and up along its straight lines."""
    around = np.column_stack([-places[:, 1], places[:, 0], np.zeros(len(places))])
    around /= norm(around)[:, None]
    if mirror.kind == "cylinder":
        return around, np.broadcast_to([0.0, 0.0, 1.0], places.shape)
    upwards = np.array([0.0, 0.0, mirror.height]) - places
    return around, upwards / norm(upwards)[:, None]


def place_of(mirror, turn, height):
    radius = mirror.radius if mirror.kind == "cylinder" else mirror.radius * (1.0 - height / mirror.height)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])


def shortest_ways(mirror, eye, paper):
    """Where light from points of the paper to the eye meets the mirror: its way is the shortest there, by steps of
    Newton along the mirror with slopes by differences; and the slopes that are left."""
    scale = mirror.radius
    turn = np.arctan2(paper[:, 1], paper[:, 0])
    if mirror.kind == "cylinder":
        # Half-way between the directions of the eye and of the paper.
        towards = np.arctan2(eye[1], eye[0])
        turn = towards + 0.5 * (np.remainder(turn - towards + np.pi, 2.0 * np.pi) - np.pi)
    height = np.full(len(paper), 0.3 * (mirror.height if mirror.kind == "cone" else scale))

    def slopes(turn, height):
        place = place_of(mirror, turn, height)
        bent = sum((place - end) / norm(place - end)[:, None] for end in (eye, paper))
        return np.stack([dot(bent, way) for way in frames(mirror, place)])

    for _ in range(60):
        now, h = slopes(turn, height), 1e-6
        by_turn = (slopes(turn + h, height) - slopes(turn - h, height)) / (2.0 * h)
        by_height = (slopes(turn, height + h * scale) - slopes(turn, height - h * scale)) / (2.0 * h * scale)
        # The first number is the slope around the axis, the second one that upwards.
        area = by_turn[0] * by_height[1] - by_turn[1] * by_height[0]
        step = (
            np.stack([by_height[1] * now[0] - by_height[0] * now[1], by_turn[0] * now[1] - by_turn[1] * now[0]]) / area
        )
        step *= np.minimum(1.0, 0.2 / np.maximum(np.abs(step[0]), np.abs(step[1]) / scale).clip(1e-9))
        turn, height = turn - step[0], height - step[1]
        if np.abs(step).max() < 1e-12:
            break
    return place_of(mirror, turn, height), np.abs(slopes(turn, height)).max()


def seen_in(setting, places):
    """Where on the drawing the eye sees what comes from places of the mirror."""
    sight = setting.centre - setting.eye
    ways = places - setting.eye
    off = (dot(sight, sight) / dot(ways, sight))[:, None] * ways - sight
    return setting.middle + np.column_stack([dot(off, setting.right), dot(off, setting.up)]) / setting.scale


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in MIRRORS if name != "none"])
def test_light_that_takes_the_shortest_way_shows_the_picture(name):
    setting = setting_of(name)
    paper = points_on(laid(name), "lines", 5_000)
    places, left = shortest_ways(setting.mirror, setting.eye, paper)
    assert left < 1e-9
    assert (places[:, 2] >= 0.0).all() and (places[:, 2] <= setting.mirror.height).all()
    picture_mm = setting.scale * shapely.distance(
        shapely.points(seen_in(setting, places)), shapely.MultiLineString(SEEN)
    )
    assert picture_mm.max() < TOLERANCE


@pytest.mark.parametrize("name", MIRRORS)
@pytest.mark.slow
def test_nothing_of_the_picture_is_missing_on_the_paper(name):
    setting = setting_of(name)
    seen = np.concatenate(
        [a + np.linspace(0.0, 1.0, 40)[:, None] * (b - a) for line in SEEN[:10] for a, b in pairwise(line)] + [SEEN[10]]
    )
    if setting.mirror.kind == "cone":
        tip = seen_in(setting, np.array([[0.0, 0.0, setting.mirror.height]]))
        seen = seen[setting.scale * norm(seen - tip) > 0.1]
    strokes = one_mark(laid(name).layers[0].marks)
    points, offsets = strokes.beziers.flattened(1e-4)
    lines = [part for part in np.split(points, offsets[1:-1]) if len(part)]
    paths = strokes.paths
    for k in np.flatnonzero(np.diff(strokes.beziers.offsets) == 0):
        own = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
        lines.append(np.vstack([own, own[:1]]) if paths.closed[k] else own)
    paper = setting.on_paper(seen) + laid(name).page_from_world[:2, 3]
    assert shapely.distance(shapely.points(paper), shapely.MultiLineString(lines)).max() < TOLERANCE


def test_without_a_mirror_the_paper_is_a_central_projection():
    eye, setting = np.array([0.0, -400.0, 150.0]), setting_of("none")
    paper = points_on(laid("none"), "lines", 2_000)
    ways = paper - eye
    sight = -eye / norm(eye)
    depth = dot(ways, sight)
    right, up = np.array([1.0, 0.0, 0.0]), np.cross([1.0, 0.0, 0.0], sight)
    flat = norm(eye) * np.column_stack([dot(ways, right), dot(ways, up)]) / depth[:, None]
    back = setting.middle + flat / setting.scale
    assert setting.scale * shapely.distance(shapely.points(back), shapely.MultiLineString(SEEN)).max() < TOLERANCE
    # A projection keeps straight lines straight: two points are enough for each.
    (paths,) = laid("none").layers[0].strokes
    assert sorted(np.diff(paths.offsets))[:10] == [2] * 9 + [3]


@pytest.mark.slow
def test_pens_layers_kinds_and_items_stay():
    scene = vp.Scene(
        (vp.Item("RING", Torus(3.0, 1.0), "red"), vp.Item("BOX", box((2, 2, 2))).moved(6, 0, 0)), title="Two"
    )
    drawn = vp.draw(scene, pens="0.4:#123456", layers="kind,object")
    found = vp.anamorphosis(drawn)
    assert found.items == ("RING", "BOX") and found.title == "Two"
    assert [(one.name, one.pen) for one in found.layers[:-3]] == [(one.name, one.pen) for one in drawn.layers]
    assert [one.name for one in found.layers[-3:]] == ["mirror", "viewer", "notes"]
    for before, after in zip(drawn.layers, found.layers, strict=False):
        (one,), (other,) = before.strokes, after.strokes
        assert one.item.tolist() == other.item.tolist() and one.closed.tolist() == other.closed.tolist()


@pytest.mark.slow
def test_the_marks_say_where_mirror_and_eye_are():
    found = vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror(radius_mm=30.0))
    mirror, viewer, _ = found.layers[-3:]
    middle = found.page_from_world[:2, 3]
    (mark,) = mirror.marks
    assert mark.arcs.centre.round(6).tolist() == [middle.round(6).tolist()]
    assert norm(mark.arcs.first).round(6).tolist() == [30.0]
    arrow = viewer.strokes[0].points - middle
    assert abs(arrow[:2, 0]).max() < 1e-9 and (arrow[:, 1] < -30.0).all() and arrow[1, 1] < arrow[0, 1]
    above = vp.anamorphosis(picture(), mirror="cone")
    assert len(above.layers[-3].strokes[0]) == 3 and not len(above.layers[-2].strokes[0])
    beside = vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror("none", viewer=(0.0, -30.0, 400.0)))
    cross = beside.layers[-2].strokes[0].points.mean(axis=0) - beside.page_from_world[:2, 3]
    assert cross == pytest.approx([0.0, -30.0])


@pytest.mark.slow
def test_what_is_seen_in_the_tip_of_a_cone_is_left_out():
    through = vp.Paths.of_polylines([[(0, 0), (80, 60)], [(0, 60), (80, 0), (80, 60)]])
    drawing = vp.Drawing(80, 60, (vp.Layer("lines", vp.Pen(), (through,)),))
    found = vp.anamorphosis(drawing, mirror="cone")
    (mark,) = found.layers[0].marks
    paths = mark.paths
    assert len(paths) == 4 and not paths.closed.any()
    ends = np.concatenate([paths.points[paths.offsets[:-1]], paths.points[paths.offsets[1:] - 1]])
    away = norm(ends - found.page_from_world[:2, 3])
    # The tip is seen on the circle that light reaches straight from there: the tangent of twice the half angle.
    assert np.sort(away)[-4:] == pytest.approx(50.0 * np.tan(2.0 * np.arctan(0.5)), abs=0.5)


@pytest.mark.slow
def test_the_drawing_grows_with_the_mirror():
    one, large = (
        vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror(radius_mm=radius), tolerance_mm=radius / 1024.0)
        for radius in (25.0, 25.0 * 1024.0)
    )
    a, b = (found.layers[0].strokes[0] for found in (one, large))
    assert a.offsets.tolist() == b.offsets.tolist()
    middles = [found.page_from_world[:2, 3] for found in (one, large)]
    assert np.abs((b.points - middles[1]) / 1024.0 - (a.points - middles[0])).max() < 1e-9


@pytest.mark.slow
def test_a_drawing_anywhere_on_its_page_is_seen_alike():
    moved = vp.Paths.of_polylines([line * 1024.0 + (2.0**20, -(2.0**21)) for line in SEEN[:10]])
    far = vp.anamorphosis(vp.Drawing(100, 80, (vp.Layer("lines", vp.Pen(), (moved,)),)))
    straight = vp.Drawing(100, 80, (vp.Layer("lines", vp.Pen(), (vp.Paths.of_polylines(SEEN[:10]),)),))
    near = vp.anamorphosis(straight)
    assert np.abs(far.layers[0].strokes[0].points - near.layers[0].strokes[0].points).max() < 1e-6


@pytest.mark.parametrize(
    ("told", "cause"),
    [
        ({"kind": "ball"}, "mirror"),
        ({"radius_mm": 0.0}, "expected a positive radius of at most 1000000 mm, got 0"),
        ({"radius_mm": 1e9}, "expected a positive radius of at most 1000000 mm, got 1e+09"),
        ({"viewer": (1e308, -1e308, 1e308)}, "expected three finite numbers of mm, at most 1000000, got (1e+308"),
        ({"kind": "cone", "height_mm": 20.0}, "is too flat to show the paper: make it higher than 25 mm"),
        ({"viewer": (0.0, 10.0, 300.0)}, "expected an eye beside the cylinder, more than 25 mm off its axis"),
        ({"viewer": (0.0, -400.0, -1.0)}, "expected an eye above the paper"),
        ({"kind": "cone", "viewer": (0.0, 0.0, 40.0)}, "an eye above the tip of the cone, higher than 50 mm"),
        ({"viewer": (0.0, -400.0)}, "expected three finite numbers"),
        ({"viewer": "above"}, "expected three finite numbers"),
        ({"radius_mm": "large"}, "radius_mm: expected a number"),
        ({"seen_mm": 60.0}, "does not fit in the cylinder, its longer side may have 49.99"),
        ({"seen_mm": 60.0, "kind": "cone"}, "does not fit in the cone, its longer side may have 40"),
        ({"kind": "none", "seen_mm": 1e6}, "does not fit seen from there"),
        ({"viewer": (0.0, -400.0, 1e-9)}, "nothing can be seen in the cylinder: look from higher up"),
    ],
)
@pytest.mark.slow
def test_a_mirror_that_cannot_be_is_said_in_one_line(told, cause):
    with pytest.raises(vp.InputError) as caught:
        vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror(**told))
    assert cause in caught.value.cause and "\n" not in caught.value.cause


@pytest.mark.slow
@pytest.mark.parametrize(
    ("told", "cause"),
    [
        ({"page": "80x80"}, "the page has 60 x 60 mm for it"),
        ({"page": "scale 1:2"}, "in true size, at no scale"),
        ({"mirror": "ball"}, "mirror 'ball': expected"),
        ({"mirror": 25.0}, "mirror: expected an AnamorphicMirror or a text such as 'cone', got 25.0"),
    ],
)
def test_a_page_or_a_mirror_that_cannot_be_is_said_in_one_line(told, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.anamorphosis(picture(), **told)


@pytest.mark.slow
def test_the_largest_picture_that_is_told_fits():
    with pytest.raises(vp.InputError) as caught:
        vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror(seen_mm=100.0))
    largest = float(caught.value.cause.split()[-2])
    assert vp.anamorphosis(picture(), mirror=vp.AnamorphicMirror(seen_mm=0.999 * largest)).width_mm > 100.0


@pytest.mark.slow
def test_a_picture_without_strokes_is_none():
    with pytest.raises(vp.InputError, match="no strokes"):
        vp.anamorphosis(vp.Drawing(100, 80, ()))
    point = vp.Paths.of_polylines([[(5.0, 5.0), (5.0, 5.0)]])
    with pytest.raises(vp.InputError, match="all of the picture is one point"):
        vp.anamorphosis(vp.Drawing(100, 80, (vp.Layer("point", vp.Pen(), (point,)),)))


@pytest.mark.slow
def test_filled_polygons_are_bent_too_but_not_around_a_cone():
    scene = vp.Scene((vp.Item("BOX", box((2, 2, 2))),), (vp.Light((1.0, -2.0, 3.0), parallel=True),))
    painted = vp.paint(scene, lines="contour", page="80x60")
    (before,) = painted.layers[0].fills
    found = vp.anamorphosis(painted)
    (fills,) = found.layers[0].fills
    assert len(fills) == len(before) and fills.kind.tolist() == before.kind.tolist()
    assert (np.diff(fills.offsets) >= np.diff(before.offsets)).all()
    # A polygon covers what its sides go round: those of a border of strokes cover as much as these say.
    polygons = [shapely.Polygon(own) for own in np.split(fills.points, fills.offsets[1:-1]) if len(own) > 2]
    (outline,) = (layer for layer in found.layers if layer.name == "contour")
    rings = one_mark(outline.marks).beziers.flattened(1e-3)
    border = shapely.Polygon(rings[0][rings[1][0] : rings[1][1]])
    assert (
        shapely.union_all(polygons).buffer(0.02).symmetric_difference(border.buffer(0.02)).area < 0.05 * border.length
    )
    with pytest.warns(vp.InputWarning, match="filled polygons and texts are left out"):
        assert not any(layer.fills for layer in vp.anamorphosis(painted, mirror="cone").layers)
    seen = vp.anamorphosis_view(painted)
    names = [layer.name for layer in seen.layers if any(map(len, layer.marks))]
    assert names.index("body") < names.index(painted.layers[0].name) < names.index("mirror")


@pytest.mark.slow
def test_the_view_from_the_eye_shows_the_picture_as_it_is():
    seen = vp.anamorphosis_view(picture())
    paper, lines, outline = seen.layers
    assert (lines.name, paper.name, outline.name) == ("lines", "paper lines", "mirror")
    (paths,) = lines.strokes
    setting = setting_of("cylinder")
    back = (paths.points - seen.page_from_world[:2, 3]) / setting.scale + setting.middle
    assert np.abs(back - np.concatenate([line[:-1] if k == 10 else line for k, line in enumerate(SEEN)])).max() < 1e-6
    body = shapely.convex_hull(shapely.multipoints(outline.strokes[0].points))
    assert shapely.within(shapely.multipoints(paths.points), body)
    assert shapely.disjoint(shapely.multipoints(paper.strokes[0].points), shapely.buffer(body, -0.01))


def run(*words):
    return CliRunner().invoke(anamorphosis, [str(word) for word in words])


@pytest.mark.slow
def test_the_command_writes_drawing_and_preview(tmp_path):
    cube = tmp_path / "cube.scene"
    cube.write_text("CUBE red box solid 1 1 1")
    out, preview = tmp_path / "laid.svg", tmp_path / "seen.svg"
    looks = ["--hidden", "dashed", "--hatch", "even", "--halo", "0.5"]
    result = run(cube, "-o", out, "--mirror", "cone", "--radius", "3cm", "--preview", preview, *looks, "-q")
    assert result.exit_code == 0, result.output
    assert b"mirror" in out.read_bytes() and b"hatch" in out.read_bytes() and b"paper" in preview.read_bytes()
    assert run(cube, "-o", out, "--preview", out).exit_code == 2
    assert run(cube, "-o", out, "--mirror", "ball").exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    "told",
    [
        {"viewer": (0.0, -25.01, 60.0)},
        {"viewer": (0.0, -100.0, 30.0), "height_mm": 200.0},
        {"kind": "cone", "viewer": (20.0, 0.0, 52.0)},
    ],
)
def test_what_lies_beside_the_viewer_makes_no_endless_page(told):
    """The picture is still to be seen on it, and strokes that lead behind the viewer as far as they are ahead."""
    seen = vp.anamorphosis_view(picture(), mirror=vp.AnamorphicMirror(**told))
    shown = next(layer for layer in seen.layers if layer.name == "lines")
    (mark,) = shown.strokes
    assert max(seen.width_mm, seen.height_mm) < 20.0 * np.ptp(mark.points, axis=0).max()
    paper = next(layer for layer in seen.layers if layer.name == "paper lines")
    assert sum(map(len, paper.strokes)) > 4


@pytest.mark.slow
def test_the_paper_is_seen_as_a_pinhole_shows_it():
    """Without the mirror before it: corners of the paper's strokes lie on those that are seen."""
    viewer = np.array([0.0, -100.0, 30.0])
    told = {"mirror": vp.AnamorphicMirror(viewer=tuple(viewer), height_mm=200.0), "curves": "polyline"}
    setting = _fitted(told["mirror"].curved, viewer, np.concatenate(SEEN), None)
    laid, seen = vp.anamorphosis(picture(), **told), vp.anamorphosis_view(picture(), **told)
    ways = np.insert(laid.layers[0].strokes[0].points - laid.page_from_world[:2, 3], 2, 0.0, axis=1) - viewer
    sight = setting.centre - viewer
    far = ways @ sight / (sight @ sight)
    off = ways[far > 0.0] / far[far > 0.0, None] - sight
    page = np.column_stack([off @ setting.right, off @ setting.up]) + seen.page_from_world[:2, 3]
    page = page[(np.abs(page - seen.page_from_world[:2, 3]) < 0.99 * norm(sight)).all(axis=1)]
    (mark,) = next(layer for layer in seen.layers if layer.name == "paper lines").strokes
    lines = shapely.union_all([shapely.linestrings(line) for line in np.split(mark.points, mark.offsets[1:-1])])
    assert len(page) > 50 and shapely.distance(shapely.points(page), lines).max() < 1e-9


@pytest.mark.slow
def test_polygons_alone_are_nothing_in_a_cone():
    painted = vp.paint(vp.Scene((vp.Item("BOX", box((2, 2, 2))),)), lines=(), page="80x60")
    with pytest.raises(vp.InputError, match="nothing to be seen in the mirror"):
        vp.anamorphosis(painted, mirror="cone")


@pytest.mark.slow
def test_the_command_bends_a_drawing_that_was_saved(tmp_path):
    vp.save(picture(), tmp_path / "picture.json")
    result = run(tmp_path / "picture.json", "-o", tmp_path / "laid.json", "--page", "A4", "--landscape", "-q")
    assert result.exit_code == 0, result.output
    found = vp.read(tmp_path / "laid.json")
    assert (found.width_mm, found.height_mm) == (297.0, 210.0)
    assert sum(len(strokes) for layer in found.layers for strokes in layer.strokes) > len(SEEN)
    result = run(tmp_path / "picture.json", "-o", tmp_path / "laid.json", "--hatch", "tone")
    assert result.exit_code == 2 and "--hatch does not go with a drawing that was saved" in result.output


def test_the_mirror_turns_light_by_the_law_of_reflection():
    generator, eye = np.random.default_rng(7), np.array([30.0, -200.0, 180.0])
    for mirror in (CurvedMirror("cylinder", 20.0, 70.0), CurvedMirror("cone", 20.0, 50.0)):
        ways = np.column_stack([generator.uniform(-15, 15, (500, 2)), generator.uniform(5, 40, 500)]) - eye
        places, paper = mirror.seen(eye, ways), mirror.on_paper(eye, ways)
        good = np.isfinite(paper).all(axis=1)
        assert good.sum() > 100
        away = np.column_stack([paper, np.zeros(len(paper))])[good] - places[good]
        sum_ = away / norm(away)[:, None] + (eye - places[good]) / norm(eye - places[good])[:, None]
        normal = mirror.normals(places[good])
        assert norm(np.cross(sum_ / norm(sum_)[:, None], normal / norm(normal)[:, None])).max() < 1e-12
