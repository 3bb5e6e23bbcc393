"""Bodies of a scene as one: which ones, under what name, and what becomes of labels, pens and cuts."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.surfaces import Sphere


def cubes(**looks):
    """Three cubes in a row that touch, and one away from them."""
    return tuple(
        vp.Item(name, box((1, 1, 1)).moved(x, 0, 0), **looks) for name, x in zip("abcd", (0, 1, 2, 9), strict=True)
    )


def test_what_touches_and_looks_alike_is_one():
    a, b, c, d = cubes()
    scene = vp.united(vp.Scene((a, b, vp.Item("c", c.shape, "red"), d, vp.Item("e", Sphere(1.0)))))
    assert [item.name for item in scene.items] == ["a", "c", "d", "e"]
    assert scene.items[0].mesh.face_count == 6 and isinstance(scene.items[3].shape, Sphere)


def test_what_has_patterns_or_lines_of_its_own_stays():
    a, b, _, d = cubes()
    window = vp.Pattern("window", "blue", 0, np.array([(0, 0), (0.1, 0), (0, 0.1)]))
    lined = parse_scene("c box 1 1 1 translation 2 0 0 sections z 3").items[0]
    scene = vp.united(vp.Scene((a, vp.Item("b", b.shape, patterns=(window,)), lined, d)))
    assert [item.name for item in scene.items] == ["a", "b", "c", "d"]


def test_a_drawing_has_no_lines_where_bodies_meet():
    camera, page = vp.Camera(eye=(5, -8, 6), target=(1.5, 0.5, 0.5)), vp.Page(100, 80)
    one, whole = vp.united(vp.Scene(cubes()[:3])), vp.Scene((vp.Item("a", box((3, 1, 1))),))
    drawn, expected = (vp.draw(scene, camera, page=page, lines="contour,crease,edges") for scene in (one, whole))
    lengths = [sum(len(layer.strokes[0]) for layer in drawing.layers) for drawing in (drawn, expected)]
    assert lengths[0] == lengths[1]
    assert vp.draw(vp.Scene(cubes()[:3]), camera, page=page).layers != drawn.layers


def test_labels_pens_and_cuts_follow():
    label, other = vp.Label("P", vp.AtVertex("b", 2)), vp.Label("Q", vp.AtVertex("d", 0))
    scene = vp.cut(vp.Scene(cubes(), labels=(label, other)), "y = 0.5", items=["b", "d"])
    made = vp.united(scene)
    assert made.labels[0].at == tuple(cubes()[1].mesh.vertices[2]) and made.labels[1] == other
    assert made.cuts[0].items == ("a", "d")
    text = "page A5\na box 1 1 1 b box 1 1 1 translation 1 0 0 pen b 0.7 camera iso"
    assert vp.united(parse_scene(text)).inks.pens == {"a": vp.united(parse_scene(text)).inks.pens["a"]}


def test_only_scenes_are_united():
    with pytest.raises(TypeError, match="united takes a Scene"):
        vp.united(box((1, 1, 1)))


def test_a_union_of_a_scene_file_is_one_item_moved_and_repeated():
    text = "union TOWER A orange box 1 1 1 B red box 1 1 1 translation 0 0 1 end translation 5 0 0 ring 2"
    scene = parse_scene(text)
    assert [(item.name, item.colour, item.mesh.face_count) for item in scene.items] == [
        ("TOWER", "orange", 6),
        ("TOWER 2", "orange", 6),
    ]
    assert scene.items[0].mesh.bounds.tolist() == [[5, 0, 0], [6, 1, 2]]
    assert scene.items[0].place == ("<text>", 1)
    again = parse_scene(write_scene(scene))
    assert np.array_equal(again.items[1].mesh.vertices, scene.items[1].mesh.vertices)


def test_unions_hold_groups_and_are_parts_of_other_items():
    text = """union U assembly A box 1 1 1 end grid 2 apart 1 B box 1 1 1 C box 2 2 2 D intersection B C end
              E box 9 9 9 F intersection U E"""
    scene = parse_scene(text)
    assert [item.name for item in scene.items] == ["F"]
    assert scene.items[0].mesh.bounds.tolist() == [[0, 0, 0], [2, 1, 1]]


@pytest.mark.parametrize(
    ("text", "line", "cause"),
    [
        ("\nunion", 2, "union: expected the name of the body, got the end of the file"),
        ("union end", 1, "union: expected the name of the body, got 'end'"),
        ("union U A box 1 1 1", 1, "union: expected 'end' behind its items, got the end of the file"),
        ("union U end", 1, "U: a union of no items"),
        ("union U camera iso end", 1, "union: expected an item or 'end', got 'camera'"),
        ("union U A box 1 1 1 B surface sphere 1 end", 1, "U: B is a surface: only solids are united"),
        ("union U A box 1 1 1 B curve circle 1 end", 1, "U: B is a curve: only solids are united"),
        ("union U A box hollow 1 1 1 B box 1 1 1 end", 1, "U: A is not closed: only solids are united"),
        (
            "union U A box 1 1 1 face_looks 1 red B box 1 1 1 end",
            1,
            "U: A has patterns or looks of single faces: they do not go with a union",
        ),
    ],
)
def test_what_cannot_be_united_is_told_with_its_line(text, line, cause):
    with pytest.raises(vp.InputError) as caught:
        parse_scene(text)
    assert (caught.value.line, caught.value.cause) == (line, cause)


@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_the_option_unites_what_a_file_holds(verb, tmp_path):
    from vectorplot.cli.main import run

    path = tmp_path / "row.scene"
    path.write_text("page A6 camera iso ROW box 1 1 1 grid 3 apart 1")
    whole = tmp_path / "whole.scene"
    whole.write_text("page A6 camera iso ROW box 3 1 1")
    for name, option in (("row", ["--union"]), ("whole", [])):
        assert run([verb, str(tmp_path / f"{name}.scene"), "-o", str(tmp_path / f"{name}.svg"), *option]) == 0
    sizes = [(tmp_path / f"{name}.svg").read_text().count("M") for name in ("row", "whole")]
    assert sizes[0] == sizes[1]


def test_facets_of_bores_are_no_creases_of_a_union():
    text = """union U A translation base_points 0 0 0, 9 0 0, 9 9 0, 0 9 0 trans_vector 0 0 2 bore 4 4 0 2
              B box 9 1 5 end camera eye 20 -30 40 target 4 4 1"""
    drawing = vp.draw(parse_scene(text), page=vp.Page(100, 80), lines="crease")
    drawn = np.concatenate([paths.points3d for layer in drawing.layers for paths in layer.strokes])
    # Of the bore there are both rims, and nothing between them.
    bored = drawn[np.hypot(drawn[:, 0] - 4, drawn[:, 1] - 4) < 2.1]
    assert len(bored) and np.isin(bored[:, 2].round(9), (0.0, 2.0)).all()
    upright = [
        paths.points3d[a:b]
        for layer in drawing.layers
        for paths in layer.strokes
        for a, b in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)
    ]
    assert not any(np.ptp(one[:, 2]) > 1.0 and np.hypot(*(one[0, :2] - 4)) < 2.1 for one in upright)
