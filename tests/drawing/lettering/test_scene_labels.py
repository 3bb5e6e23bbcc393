"""Labels in pictures: hidden with what they name, apart from lines and each other, in every verb and format."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.curves import Circle, Line
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import chosen
from vectorplot.drawing.text_along import grown, outside_boxes, outside_others
from vectorplot.geometry import box
from vectorplot.save import FORMATS, write
from vectorplot.scene import look
from vectorplot.surfaces import Cylinder, ImplicitTorus, Sphere, Torus
from vectorplot.testing.rays import visible_by_rays
from vectorplot.tolerances import NEAR_SURFACE_OF_EXTENT
from vectorplot.visibility.hidden_points import points_hidden_by
from vectorplot.visibility.projected_faces import project_faces

NAMES = "ABCDEFGH"
CUBE = vp.Item("CUBE", box((2, 2, 2)))
CAMERA = vp.Camera((6, -5, 4), target=(1, 1, 1))
PAGE = vp.Page(100, 80)


def labelled(size: float = 1.0, away: float = 0.0, **more: object) -> vp.Scene:
    item = replace(CUBE, shape=replace(CUBE.mesh, vertices=CUBE.mesh.vertices * size + away))
    labels = tuple(vp.Label(name, vp.AtVertex("CUBE", k), **more) for k, name in enumerate(NAMES))  # type: ignore[arg-type]
    eye, target = (np.array(at) * size + away for at in (CAMERA.eye, CAMERA.target))
    return vp.Scene((item,), camera=vp.Camera(tuple(eye), tuple(target)), labels=labels)


def letters(drawing: vp.Drawing) -> Paths:
    (layer,) = (layer for layer in drawing.layers if layer.name == "label")
    return layer.strokes[0]


def both_letters(drawing: vp.Drawing) -> tuple[Paths, Paths]:
    """The letters of what is visible, and those of what is hidden, which stand on the layer of hidden lines."""
    (hidden,) = (layer for layer in drawing.layers if layer.name == "hidden")
    assert hidden.pen.width_mm < 0.2
    return letters(drawing), hidden.strokes[-1]


def lines(drawing: vp.Drawing) -> shapely.MultiLineString:
    paths = [chosen(p, p.item >= 0) for layer in drawing.layers if layer.name != "label" for p in layer.strokes]
    found = [p.points[a:b][[*range(b - a), *([0] if c else [])]] for p in paths for a, b, c in strokes(p)]
    return shapely.MultiLineString([line for line in found if len(line) > 1])


def strokes(paths: Paths) -> list[tuple[int, int, bool]]:
    ends = paths.offsets.tolist()
    return list(zip(ends[:-1], ends[1:], paths.closed.tolist(), strict=True))


def test_labels_are_hidden_with_what_they_name() -> None:
    plain = letters(vp.draw(labelled(), page=PAGE))
    every = letters(vp.draw(labelled(hidden="solid"), page=PAGE))
    shown, faint = both_letters(vp.draw(labelled(), page=PAGE, hidden="dashed"))
    assert (plain.hidden_by == 0).all() and (every.hidden_by > 0).sum() >= 1
    assert (shown.hidden_by == 0).all() and (faint.hidden_by > 0).all() and len(faint) > 0
    assert len(shown) + len(faint) == len(every) > len(plain) > 0
    assert (plain.kind == vp.LineKind.LABEL).all()
    hidden = every.points[np.repeat(every.hidden_by, np.diff(every.offsets)) > 0]
    assert len(hidden) and (np.ptp(hidden, axis=0) < 5.0).all()


def test_without_labels_nothing_changes_and_nothing_loads() -> None:
    drawing = vp.draw(replace(labelled(), labels=()), page=PAGE)
    assert "label" not in [layer.name for layer in drawing.layers]


@pytest.mark.parametrize(("size", "away"), [(1.0, 0.0), (2.0**-20, 0.0), (2.0**20, 0.0), (1.0, 2.0**17)])
def test_size_and_place_of_the_scene_change_nothing(size: float, away: float) -> None:
    here, there = (letters(vp.draw(scene, page=PAGE)) for scene in (labelled(), labelled(size, away)))
    assert np.allclose(here.points, there.points, rtol=0.0, atol=1e-4)


@pytest.mark.slow
def test_lines_stop_before_letters_and_labels_keep_apart() -> None:
    ring = vp.Item("RING", Circle((1.0, 1.0, 1.0), radius=3.0))
    scene = replace(labelled(), items=(CUBE, ring))
    scene = replace(scene, labels=(*scene.labels, vp.Label("ring", vp.Along("RING", 0.75))))
    drawing = vp.draw(scene, page=PAGE, hidden="dashed")
    drawn, written = lines(drawing), letters(drawing)
    groups = shapely.MultiLineString([written.points[a:b] for a, b, _ in strokes(written)])
    assert shapely.distance(drawn, groups) >= 0.55
    bare = lines(vp.draw(replace(scene, labels=()), page=PAGE, hidden="solid"))
    assert shapely.hausdorff_distance(shapely.intersection(drawn.buffer(0.1), bare), drawn) < 0.2


def test_lines_to_labels_end_before_the_letters_of_others() -> None:
    corners = np.array([(2.0, -1.0), (4.0, -1.0), (4.0, 1.0), (2.0, 1.0)])
    lines = np.array([[(0.0, 0.0), (10.0, 0.0)], [(0.0, 5.0), (10.0, 5.0)]])
    boxes, owner = np.stack([corners, corners + np.array((5.0, 0.0))]), np.array([3, 1])
    parts, line = outside_others(lines, np.array([1, 2]), boxes, owner)
    assert line.tolist() == [0, 0, 1]
    assert parts == pytest.approx(np.array([[(0, 0), (2, 0)], [(4, 0), (10, 0)], [(0, 5), (10, 5)]]))
    parts, line = outside_others(lines[:0], owner[:0], boxes, owner)
    assert parts.shape == (0, 2, 2) and line.shape == (0,)


def test_leaders_do_not_run_through_the_letters_of_others() -> None:
    places = ("right", "above_right", "above", "above_left", "left", "below_left", "below", "below_right")
    around = [vp.Label("MMM", (0, 0, 2), f"{place}", place=place) for place in places]
    lines = []
    for labels in (around, [*around, vp.Label("far", (0, 0, 2))]):
        found = letters(vp.draw(replace(labelled(), labels=tuple(labels)), page=PAGE))
        lines.append({tuple(map(tuple, found.points[a:b].tolist())) for a, b, _ in strokes(found)})
    near, far = (shapely.union_all([*map(shapely.linestrings, one)]) for one in (lines[0], lines[1] - lines[0]))
    assert lines[0] < lines[1] and shapely.distance(near, far) > 0.2


@pytest.mark.slow
def test_labels_that_name_one_place_stand_apart_with_leaders() -> None:
    labels = tuple(vp.Label(f"name {k}", (0, 0, 2)) for k in range(12))
    found = letters(vp.draw(replace(labelled(), labels=labels), page=PAGE))
    texts = {}
    for k in range(12):
        alone = vp.draw(replace(labelled(), labels=labels[: k + 1]), page=PAGE)
        texts[k] = len(letters(alone))
    assert len(found) == texts[11] > texts[0] * 11
    middles = [found.points[a:b].mean(axis=0) for a, b, _ in strokes(found)]
    assert np.ptp(np.array(middles), axis=0).min() > 8.0
    inside = (found.points > 0.0) & (found.points < (100.0, 80.0))
    assert inside.all()


@pytest.mark.parametrize("format_", FORMATS)
def test_every_format_has_the_letters(format_: str) -> None:
    with_letters, without = (
        write(vp.draw(scene, page=PAGE), format_) for scene in (labelled(), replace(labelled(), labels=()))
    )
    assert len(with_letters) > len(without)


def test_json_gives_the_letters_back() -> None:
    import json

    drawing = vp.draw(labelled(), page=PAGE)
    strokes_ = json.loads(write(drawing, "json"))["strokes"]
    assert sum(stroke["kind"] == "label" for stroke in strokes_) == len(letters(drawing))
    written = letters(drawing)
    image = np.column_stack([written.points3d, np.ones(len(written.points))]) @ drawing.page_from_world.T
    assert np.allclose(image[:, :2] / image[:, 3:], written.points, rtol=0.0, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("asked", ["none", "contour,crease"])
def test_paint_and_render_show_the_same_labels(asked: str) -> None:
    drawn, painted = (
        letters(verb(labelled(), page=PAGE)) for verb in (vp.draw, lambda s, **o: vp.paint(s, lines=asked, **o))
    )
    assert len(drawn) == len(painted)
    size = (200, 160)
    one, other = (
        vp.render(scene, size=size, lines=asked, fit=False).pixels
        for scene in (labelled(), replace(labelled(), labels=()))
    )
    changed = (one != other).any(axis=2).sum()
    assert 50 < changed < 4000


@pytest.mark.parametrize("style", ["wireframe", "depth-cue"])
def test_wireframes_show_all_labels_in_a_colour_that_is_seen(style: str) -> None:
    drawing = vp.draw(labelled(), page=PAGE, style=style)  # type: ignore[arg-type]
    assert len(letters(drawing)) == len(letters(vp.draw(labelled(hidden="solid"), page=PAGE)))
    assert drawing.layers[-1].pen.colour == "#ffffff"


@pytest.mark.parametrize("layers", ["kind", "object", "colour"])
def test_labels_have_a_layer_of_their_own(layers: str) -> None:
    names = [layer.name for layer in vp.draw(labelled(), page=PAGE, layers=layers).layers]  # type: ignore[arg-type]
    assert names[-1] == "label" and (layers != "kind" or names[-2] == "index")


def test_unknown_characters_name_the_label() -> None:
    with pytest.raises(vp.InputError, match="label X: there are no strokes for the character '漢'"):
        vp.draw(replace(labelled(), labels=(vp.Label("漢", (0, 0, 0), "X"),)))


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [True, False])
def test_hidden_points_agree_with_rays(parallel: bool) -> None:
    rng = np.random.default_rng(3)
    items = (
        vp.Item("box", box((2, 2, 2))),
        vp.Item("ball", Sphere(1.0, (3.0, 1.0, 1.0))),
        vp.Item("ring", Torus(1.5, 0.4, (1.0, 3.5, 1.0))),
        vp.Item("glass", box((9, 0.1, 9)), material=vp.Material("transparent")),
    )
    scene, camera = vp.Scene(items), replace(vp.Camera((9, -7, 5), (1, 1, 1)), parallel=parallel)
    points = rng.uniform((-2, -2, -1), (5, 5, 3), (300, 3))
    view = look(scene, camera)
    found = points_hidden_by(scene, view, project_faces(view), view.points_of(points))
    truth = visible_by_rays(scene, camera, points)
    sure = truth.clearance > 2.0 * NEAR_SURFACE_OF_EXTENT
    assert sure.sum() > 250 and (found[sure] == truth.hidden_by[sure]).all() and 0 < (found > 0).sum() < 300


@pytest.mark.parametrize("away", [0.0, 2.0**17])
@pytest.mark.parametrize("shape", ["cube", "sphere", "torus", "implicit torus"])
def test_what_is_written_beside_a_surface_by_rounding_lies_on_it(shape: str, away: float) -> None:
    body, points, normals = places_on(shape, np.random.default_rng(4))
    scene = vp.Scene((vp.Item("BODY", body).moved(away, 0, 0),))
    eye, there = np.array([8.0, -5.0, 6.0]), np.array([away, 0.0, 0.0])
    view = look(scene, vp.Camera(tuple(eye + there), tuple(there)))
    faces, extent = project_faces(view), float(np.ptp(scene.bounds, axis=0).max())

    def hidden(off: float) -> np.ndarray:
        off_it = points + off * extent * normals + there
        return points_hidden_by(scene, view, faces, view.points_of(off_it)) > 0

    sight = eye - points
    facing = (normals * sight).sum(axis=1) / np.linalg.norm(sight, axis=1)
    seen = ~hidden(1e-3) & (facing > 0.05)
    assert seen.sum() > 30
    for off in (0.0, -1e-9, -3e-6, -3e-5, -NEAR_SURFACE_OF_EXTENT, 3e-6):
        assert not hidden(off)[seen].any() and hidden(off)[facing < -0.05].all()
    assert hidden(-10 * NEAR_SURFACE_OF_EXTENT)[seen].all()


def places_on(shape: str, rng: np.random.Generator) -> tuple[object, np.ndarray, np.ndarray]:
    """A body, places on it (100,3), and the normals there."""
    u, v = rng.uniform(0.0, 2.0 * np.pi, (2, 100))
    round_ = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=1)
    if shape == "sphere":
        return Sphere(2.0), 2.0 * round_, round_
    if shape == "cube":
        side, axis = rng.integers(0, 2, 100), rng.integers(0, 3, 100)
        normals = np.zeros((100, 3))
        normals[np.arange(100), axis] = 2.0 * side - 1.0
        return box((2, 2, 2)), np.where(normals != 0.0, 1.0 + normals, rng.uniform(0.1, 1.9, (100, 3))), normals
    ring = 3.0 * np.stack([np.cos(u), np.sin(u), np.zeros(100)], axis=1)
    return (Torus if shape == "torus" else ImplicitTorus)(3.0, 1.0), ring + round_, round_


def test_vertices_seen_exactly_through_edges_are_hidden() -> None:
    view = look(vp.Scene((CUBE,)), vp.Camera((5, 5, 5), (1, 1, 1), parallel=True))
    corners = view.points_of(np.array([(0.0, 0, 0), (2, 2, 2), (2, 0, 0), (1, 1, 2)]))
    assert points_hidden_by(vp.Scene((CUBE,)), view, project_faces(view), corners).tolist() == [1, 0, 0, 0]


@pytest.mark.parametrize("away", [0.0, 2.0**17])
@pytest.mark.parametrize("shape", ["cube", "cylinder", "sphere"])
def test_what_lies_on_the_border_of_what_is_before_it_is_not_hidden(shape: str, away: float) -> None:
    bodies = {"cube": box((2, 2, 2)), "cylinder": Cylinder(1.0, 0.0, 2.0), "sphere": Sphere(1.0, (0.0, 0.0, 1.0))}
    at = (1.0, 1.0, 0.0) if shape == "cube" else (0.0, 0.0, 0.0)
    scene = vp.Scene((vp.Item("BODY", bodies[shape]).moved(away, 0, 0),))
    view = look(scene, vp.Camera.view("front"))
    offsets = [(0, 0, 2), (0, 2, 2), (0, 0, 0), (0, 0.5, 1), (0, 5, 2), (0, 5, 0), (0, 5, 1.9), (0, 5, 2.1)]
    points = view.points_of(np.array(offsets) + at + (away, 0, 0))
    found = points_hidden_by(scene, view, project_faces(view), points).tolist()
    assert found == [0, 0, 0, 1, 0, 0, 1, 0]


def test_a_name_in_a_face_that_is_seen_edge_on_is_shown() -> None:
    labels = (vp.Label("A", (1, 1, 2)), vp.Label("C", (0, 0, 2)))
    shown, both = (
        letters(vp.draw(replace(labelled(), labels=labels, camera=None), "front", page=PAGE, hidden=hidden))
        for hidden in ("none", "dashed")
    )
    assert (both.hidden_by == 0).all() and len(shown) == len(both)


@pytest.mark.parametrize("layers", ["kind", "object", "colour"])
def test_hidden_letters_are_whole_and_leave_visible_lines_whole(layers: str) -> None:
    def drawn(*labels: vp.Label) -> vp.Drawing:
        scene = replace(labelled(), labels=labels)
        return vp.draw(scene, page=PAGE, hidden="dashed", layers=layers)  # type: ignore[arg-type]

    # One of them stands on visible lines, the other one on hidden ones.
    hidden = [vp.Label("MMMM", (0, 1.9, 0.1), place="centre"), vp.Label("M", (0, 2, 0), "two", place="centre")]
    bare, named = drawn(), drawn(*hidden)
    solid = drawn(*(replace(label, hidden="solid") for label in hidden))
    shown, faint = both_letters(named)
    assert len(shown) == 0 and len(faint) == len(letters(solid))
    lengths = []
    for drawing in (bare, named, solid):
        every = [paths for layer in drawing.layers if layer.name != "label" for paths in layer.strokes]
        visible, behind = (
            sum(
                np.hypot(*np.diff(paths.points[a:b], axis=0).T).sum()
                for paths in every
                for (a, b, _), by, kind in zip(strokes(paths), paths.hidden_by, paths.kind, strict=True)
                if (by > 0) == is_hidden and kind != vp.LineKind.LABEL
            )
            for is_hidden in (False, True)
        )
        lengths.append((visible, behind))
    (whole, behind), (kept, fewer), (cut, _) = lengths
    assert kept == pytest.approx(whole) and cut < whole - 1.0 and fewer < behind - 1.0


@pytest.mark.slow
def test_what_is_hidden_in_painted_pictures_has_thin_letters_too() -> None:
    drawing = vp.paint(labelled(hidden="dashed"), page=PAGE)
    shown, faint = both_letters(drawing)
    assert (shown.hidden_by == 0).all() and (faint.hidden_by > 0).all() and len(faint) > 0
    images = [vp.render(labelled(hidden=hidden), size=(200, 160)).pixels for hidden in ("none", "dashed", "solid")]
    ink = [int((255 - image.astype(int)).sum()) for image in images]
    assert ink[0] != ink[1] != ink[2]


def test_what_lies_in_boxes_is_cut_away_and_nothing_else() -> None:
    rng = np.random.default_rng(5)
    sizes = rng.integers(0, 6, 60)
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = rng.uniform(0, 50, (offsets[-1], 2))
    none = np.zeros(60, dtype=np.intp)
    closed = (rng.random(60) < 0.3) & (sizes > 2)
    paths = Paths(points, offsets, closed, none, np.arange(60), none, np.column_stack([points, points[:, 0]]))
    corner = rng.uniform(5, 40, (8, 1, 2))
    turn = np.array([(np.cos(a), np.sin(a)) for a in rng.uniform(0, 6, 8)])
    square = np.array([(0.0, 0.0), (9.0, 0.0), (9.0, 4.0), (0.0, 4.0)])
    boxes = corner + square @ np.stack([turn, turn[:, ::-1] * (-1, 1)], axis=1)
    boxes = grown(boxes, 0.5)
    cut = outside_boxes(paths, boxes, np.eye(4))
    mask = shapely.union_all(shapely.polygons(boxes))
    assert shapely.area(shapely.polygons(boxes)) == pytest.approx(50.0)
    before, after = (
        shapely.MultiLineString(
            [p.points[a:b][[*range(b - a), *([0] if c else [])]] for a, b, c in strokes(p) if b - a > 1]
        )
        for p in (paths, cut)
    )
    assert after.length == pytest.approx(sum(shapely.difference(line, mask).length for line in before.geoms))
    assert max(shapely.intersection(line, mask.buffer(-1e-6)).length for line in after.geoms) < 1e-6
    assert (np.diff(cut.item) >= 0).all()


@pytest.mark.parametrize("letter", ["h", "height"])
def test_a_label_along_a_curve_that_is_seen_end_on_stands_beside_it(letter: str) -> None:
    up = vp.Item("UP", Line((0, 0, 0), (0, 0, 4)), "black")
    scene = vp.Scene((up, vp.Item("BOX", box((2, 2, 2)))), labels=(vp.Label(letter, vp.Along("UP")),))
    written = [letters(vp.draw(scene, camera)) for camera in ("front", "top")]
    assert written[0].points.shape == written[1].points.shape
    width, height = np.ptp(written[1].points, axis=0)
    assert width > height or len(letter) == 1


@pytest.mark.parametrize("text", ["strokes", "real"])
@pytest.mark.parametrize("vertex", range(8))
def test_labels_beside_the_edge_of_the_page_stay_on_it(vertex: int, text: str) -> None:
    labels = (vp.Label("a name that is almost as wide as the page", vp.AtVertex("CUBE", vertex), size_mm=2.5),)
    page = vp.Page(100, 80, 5)
    drawing = vp.draw(replace(labelled(), labels=labels), page=page, hidden="solid", text=text)
    (layer,) = (layer for layer in drawing.layers if layer.name == "label")
    found = layer.strokes[0].points if text == "strokes" else layer.texts[0].points
    room = 0.0 if text == "strokes" else 0.5 * layer.texts[0].room_mm
    left = found[:, 0] - (0.0 if text == "strokes" else layer.texts[0].anchor * layer.texts[0].room_mm)
    assert left.min() >= 0.5 and (left + 2.0 * room).max() <= 99.5
    assert found[:, 1].min() >= 0.5 and found[:, 1].max() <= 79.5


@pytest.mark.parametrize("text", ["strokes", "real"])
def test_labels_that_are_wider_than_the_page_are_broken_at_blanks(text: str, recwarn: pytest.WarningsRecorder) -> None:
    said = "a name that is much wider than the page of the picture\nand goes on"
    scene = replace(labelled(), labels=(vp.Label(said, (2, 2, 2), "long"),))
    drawing = vp.draw(scene, page=vp.Page(100, 80, 5), hidden="solid", text=text)
    assert not recwarn.list
    (layer,) = (layer for layer in drawing.layers if layer.name == "label")
    if text == "real":
        first, second, third = layer.texts[0].strings
        assert (
            f"{first} {second}" == "a name that is much wider than the page of the picture" and third == "and goes on"
        )
    else:
        points = layer.strokes[0].points
        assert points[:, 0].min() > 0.0 and points[:, 0].max() < 100.0


@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_labels_that_cannot_be_kept_on_the_page_are_told_once(verb: str) -> None:
    wide = "a_name_that_is_much_wider_than_the_page_of_the_picture"
    labels = (
        vp.Label(wide, (2, 2, 2), "long"),
        vp.Label("told where", vp.AtVertex("CUBE", 6), "placed", 12.0, "right"),
        vp.Label("Figure", vp.OnPage(99, 2), place="centre"),
        vp.Label("Text", vp.OnPage(0, 2), place="centre"),
        vp.Label("fits", (2, 0, 2)),
    )
    scene = replace(labelled(), labels=labels)
    with pytest.warns(vp.InputWarning) as told:
        if verb == "render":
            vp.render(scene, size=(378, 302), samples=1)
        else:
            getattr(vp, verb)(scene, page=PAGE)
    (one,) = (str(warning.message) for warning in told)
    assert one == "label long, label placed, label Figure and 1 more: letters leave the page"


def test_sheets_that_are_cut_to_their_picture_have_room_for_labels_and_nothing_is_told(recwarn) -> None:  # type: ignore[no-untyped-def]
    labels = (vp.Label("told where to stand", vp.AtVertex("CUBE", 6), "placed", 12.0, "right"),)
    assert vp.draw(replace(labelled(), labels=labels), page="fit").width_mm > 250.0
    assert not recwarn.list
