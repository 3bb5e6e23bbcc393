"""The scene language: every word, every way of writing it, and what is said about mistakes."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.paths import DATA, DOCS

from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.bodies_of_revolution import revolution
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.repair.adjacency import body_record
from vectorplot.geometry.repair.winding import is_closed_oriented
from vectorplot.geometry.solids import box
from vectorplot.io.scenes import scene_language
from vectorplot.io.scenes.reserved_words import RESERVED
from vectorplot.io.scenes.scene_item import CAP_WORDS
from vectorplot.io.scenes.scene_language import parse_scene, read_scene
from vectorplot.io.scenes.scene_reader import HANDLERS
from vectorplot.io.scenes.scene_words import FORM_WORDS, ITEM_WORDS
from vectorplot.scene.scene import Light, Page
from vectorplot.words import COLOURS, MATERIALS, PALETTES

PYRAMID = """PYRAMID metallic gray convex hollow
vertices
  2 0 0 , 1 2 0 , -1 2 0 , -2 0 0 , -1 -2 0 , 1 -2 0 ,
  2 0 4 , 1 2 1 , -1 2 1 , -2 0 4 , -1 -2 1 , 1 -2 1
edges
  1 2 , 2 3 , 3 4 , 4 5 , 5 6 , 6 1 ,
  7 8 , 8 9 , 9 10 , 10 11 , 11 12 , 12 7 ,
  1 7 , 2 8 , 3 9 , 4 10 , 5 11 , 6 12 , 7 10
faces
  1 2 3 4 5 6 ,
  1 2 8 7 , 2 3 9 8 , 3 4 10 9 , 4 5 11 10 ,
  5 6 12 11 , 6 1 7 12 , 10 11 12 7
"""


def one(text):
    scene = parse_scene(text)
    assert len(scene.items) == 1
    return scene.items[0]


def counts(item):
    record = body_record(item.shape)
    return record.vertex_count, record.edge_count, record.face_count


def same_mesh(a, b):
    return (
        np.array_equal(a.vertices, b.vertices)
        and np.array_equal(a.corners, b.corners)
        and np.array_equal(a.offsets, b.offsets)
        and (a.present is None) == (b.present is None)
        and (a.present is None or np.array_equal(a.present, b.present))
    )


# --- the kinds ---


@pytest.mark.capability("G3.0-reader")
@pytest.mark.capability("G3.3-general")
@pytest.mark.capability("G3.L-general")
@pytest.mark.parametrize("text", [PYRAMID, PYRAMID.replace(" ,", ","), PYRAMID.replace(" ,", ",").replace(", ", ",")])
def test_pyramid(text):
    item = one(text)
    assert (item.name, item.colour, item.material.word) == ("PYRAMID", "gray", "metallic")
    assert counts(item) == (12, 19, 8)
    assert item.shape.present is None


@pytest.mark.capability("G3.3-edges-from-faces")
def test_pyramid_without_its_edges():
    start, end = PYRAMID.index("edges"), PYRAMID.index("faces")
    assert same_mesh(one(PYRAMID[:start] + PYRAMID[end:]).shape, one(PYRAMID).shape)


@pytest.mark.capability("G3.L-revolution")
@pytest.mark.capability("G3.L-caps")
def test_bodies_of_revolution():
    cone = one("CONE green revolution solid\n meridian 4 0 0 , 0 0 7 order 30")
    assert counts(cone) == (31, 60, 31) and cone.colour == "green"
    assert body_record(cone.shape).volume == pytest.approx(116.430546857945, rel=1e-14), "TV19"
    cylinder = one("CYLINDER orange revolution hollow +bottom meridian 2.5 0 -5 , 2.5 0 5 order 40")
    assert counts(cylinder) == (80, 120, 42)
    assert cylinder.shape.present.tolist() == [True] * 41 + [False]
    closed = one("CYLINDER orange revolution solid meridian 2.5 0 -5 , 2.5 0 5 order 40")
    assert body_record(closed.shape).volume == pytest.approx(195.543081300289, rel=1e-14), "TV18"
    half = one("ROTSWEEP lightcyan revolution solid rot_angle 180\nmeridian 2 0 -5 , 3 0 -2 , 3 0 3 , 0 0 5 order 20")
    assert np.allclose(half.shape.vertices[27], [1.20508627395891, 2.74731997996517, -2], atol=1e-13)
    assert is_closed_oriented(half.shape)


@pytest.mark.capability("G3.L-caps")
@pytest.mark.parametrize(
    ("words", "present"),
    [("", [False, False]), ("+top", [False, True]), ("+bottom", [True, False]), ("+top +bottom", None)],
)
def test_both_caps_can_be_shown(words, present):
    for text in (
        f"A revolution hollow {words} meridian 1 0 0, 1 0 1 order 5",
        f"A translation hollow base_points 0 0 0, 1 0 0, 0 1 0 trans_vector 0 0 1 {words}",
        f"A box hollow 3 3 1 {words}",
        f"A box {words} hollow 3 3 1",
    ):
        shape = one(text).shape
        assert (None if shape.present is None else shape.present[-2:].tolist()) == present


@pytest.mark.capability("G3.L-translation")
def test_tv17_translational_sweep():
    item = one("""TRANSLATIONAL_SWEEP yellow translation solid
        base_points 0 2 0 , 0 -1.4 0, 0 -2 0.6 ,
                    0 -2 1.2 , 0 -1.4 1.6 , 0 2 1.6
        trans_vector -4.5 0 0""")
    assert counts(item) == (12, 18, 8)
    assert body_record(item.shape).volume == pytest.approx(27.45, rel=1e-14)


@pytest.mark.capability("G3.L-box")
def test_box_of_the_book():
    item = one("BOX gray box hollow 3 3 1 +bottom")
    assert counts(item) == (8, 12, 6)
    assert item.shape.present.sum() == 5 and not item.shape.present[5]


@pytest.mark.capability("G3.L-move")
def test_tv21_modifiers_act_in_file_order_about_the_origin():
    scene = parse_scene("""CUBE1 yellow box solid 6 6 6
            translation -3 -3 -3
        CUBE2 green box solid 6 6 6
            translation -3 -3 -3
            rotation x 40 rotation z 20""")
    assert [item.name for item in scene.items] == ["CUBE1", "CUBE2"]
    assert scene.items[0].shape.vertices[6].tolist() == [3, 3, 3]
    expected = [2.69260890284843, 1.37353104049071, 4.22649615841655]
    assert np.allclose(scene.items[1].shape.vertices[6], expected, atol=1e-13)


@pytest.mark.capability("G3.L-move")
def test_rotations_run_counter_clockwise_and_quarter_turns_are_exact():
    for axis, image in (("x", [3, -5, 4]), ("y", [5, 4, -3]), ("z", [-4, 3, 5])):
        corner = one(f"A box 3 4 5 rotation {axis} 90").shape.vertices[6]
        assert corner.tolist() == image
    assert one("A box 3 4 5 rotation z -270").shape.vertices[6].tolist() == [-4, 3, 5]
    assert one("A box 3 4 5 rotation z 3600000").shape.vertices[6].tolist() == [3, 4, 5]


@pytest.mark.capability("G3.L-move")
def test_translation_is_a_kind_or_a_modifier_by_its_position():
    item = one("A translation base_points 0 0 0, 1 0 0, 0 1 0 trans_vector 0 0 1 translation 5 0 0")
    assert item.shape.bounds.tolist() == [[5, 0, 0], [6, 1, 1]]


@pytest.mark.capability("G3.L-geom")
def test_general_bodies_keep_the_order_of_their_faces_and_convex_ones_are_turned():
    tetrahedron = "vertices 0 0 0, 1 0 0, 0 1 0, 0 0 1 faces 1 2 3, 1 2 4, 2 3 4, 1 4 3"
    listed = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    outwards = [[2, 1, 0], *listed[1:]]
    for word in ("general", "concave"):
        assert one(f"A {word} {tetrahedron}").shape.polygons() == listed
    for word in ("", "convex", "solid", "voll", "hollow"):
        assert one(f"A {word} {tetrahedron}").shape.polygons() == outwards


@pytest.mark.capability("G3.L-geom")
def test_voll_is_solid():
    assert same_mesh(one("A box voll 1 2 3").shape, one("A box solid 1 2 3").shape)


@pytest.mark.capability("G3.L-geom")
def test_a_body_called_convex_that_is_not_is_taken_as_it_is_with_a_warning():
    notch = "0 0 0, 4 0 0, 4 4 0, 2 1 0, 0 4 0"
    text = f"A convex vertices {notch}, {notch.replace(' 0,', ' 1,')[:-1]}1\nfaces 5 4 3 2 1, 6 7 8 9 10, 1 2 7 6"
    text += ", 2 3 8 7, 3 4 9 8, 4 5 10 9, 5 1 6 10"
    with pytest.warns(InputWarning, match="<text>:1: A: is not convex"):
        item = one(text)
    assert is_closed_oriented(item.shape)


def test_a_base_out_of_its_plane_is_said_with_the_name_of_the_item():
    with pytest.warns(InputWarning, match="<text>:2: T: base_points do not lie in one plane"):
        one("\nT translation base_points 0 0 0, 1 0 0, 1 1 0.2, 0 1 0 trans_vector 0 0 1")


# --- words about the look ---


@pytest.mark.capability("G3.L-colour")
@pytest.mark.capability("G3.L-light-dark")
@pytest.mark.capability("G3.L-pattern-colours")
def test_every_colour_is_known():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for colour in [p + q for p in ("", "light", "dark") for q in PALETTES] + ["white", "black", "red"]:
            assert one(f"A {colour} box 1 1 1").colour == colour
    assert len(PALETTES) == 8


@pytest.mark.capability("G3.L-colour")
def test_an_unknown_colour_is_said_and_gray_is_used():
    with pytest.warns(InputWarning, match=r"<text>:2: CUBE: unknown colour 'gren', gray is used .*'green'"):
        assert one("\nCUBE gren box 1 1 1").colour == "gray"
    assert one('CUBE colour "#ff8000" box 1 1 1').colour == "#ff8000"


def test_physical_properties():
    words = {"reflecting": "shiny", "matte": "mat"}
    for word in ("normal", "metallic", "shiny", "reflecting", "mat", "matte", "wood", "plastic", "mirror"):
        item = one(f"A {word} box 1 1 1")
        assert item.material.word == words.get(word, word)
        assert item.hides and item.material.opacity == 1.0
    glass = one("A transparent refraction 1.33 box 1 1 1")
    assert glass.material.word == "transparent" and glass.material.refraction == 1.33
    assert 0 < glass.material.opacity < 1 and not glass.hides
    assert one("A transparent opacity 0.2 occludes yes box 1 1 1").hides


def test_lines_and_removed_faces():
    item = one("A lines contour, crease box 1 1 1 removed_faces 1, 3")
    assert item.lines == ("contour", "crease")
    assert item.shape.present.tolist() == [False, True, False, True, True, True]
    assert one("A lines none box 1 1 1").lines == ()
    assert one("A box 1 1 1").lines is None


@pytest.mark.capability("G3.L-patterns")
@pytest.mark.capability("G3.L-pattern-colours")
def test_patterns_of_the_book():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        item = one("""CUBE gray box voll 10 10 10
            patterns face 1 polygon LEFT white -1 -1, 1 -1, 1 1, -1 1
                     face 2 polygon FRONT yellow -2 -2, 2 -2, 2 2, -2 2
            face 4 polygon BACK red   -4 -4, 4 -4, 4 4, -4 4
            face 6 polygon TOP1 cyan  -2 -2, 2 -2, 2 2, -2 2
            polygon TOP2 black  0 0, 4 0, 4 4, 0 4""")
    found = [(p.name, p.colour, p.face) for p in item.patterns]
    assert found == [
        ("LEFT", "white", 0), ("FRONT", "yellow", 1), ("BACK", "red", 3), ("TOP1", "cyan", 5), ("TOP2", "black", 5),
    ]  # fmt: skip
    assert item.patterns[0].points.tolist() == [[-1, -1], [1, -1], [1, 1], [-1, 1]]


# --- the scene as a whole ---


@pytest.mark.capability("G3.L-scene")
def test_what_is_said_about_the_scene():
    scene = parse_scene("""title "A town, \\"seen\\" from the hill"
        background lightblue
        page A3 landscape margin 12.5
        camera eye 1, -2, 3 target 0 0 1 up 0 1 1 twist 10 field_of_vision 40
        light SUN direction 3 -6 8
        light LAMP position 1 2 3 intensity 0.75 colour lightyellow
        light position 0 0 9""")
    assert scene.title == 'A town, "seen" from the hill' and scene.background == "lightblue"
    assert scene.page == Page(420, 297, 12.5)
    assert scene.camera == Camera((1, -2, 3), (0, 0, 1), up=(0, 1, 1), twist_deg=10, fov_deg=40)
    assert scene.lights == (
        Light((3, -6, 8), parallel=True, name="SUN"),
        Light((1, 2, 3), intensity=0.75, name="LAMP", colour="lightyellow"),
        Light((0, 0, 9)),
    )


@pytest.mark.capability("G3.L-scene")
def test_what_is_not_said_about_the_scene_is_left_open():
    scene = parse_scene("A box 1 1 1")
    assert (scene.camera, scene.page, scene.background, scene.lights, scene.title) == (None, None, None, (), "")


@pytest.mark.capability("G3.L-scene")
def test_parallel_cameras_and_main_views():
    assert parse_scene("camera eye 1 2 3 parallel height 5").camera == Camera((1, 2, 3), parallel=True, height=5)
    front = parse_scene("camera view front target 1 2 3 height 7").camera
    assert front.parallel and front.height == 7 and front.target == (1, 2, 3)
    assert np.allclose(front.direction, [0, -1, 0])


def test_pages_by_size():
    assert parse_scene("page 300x200").page == Page(300, 200)
    assert parse_scene("page 150.5x99mm landscape margin 3").page == Page(150.5, 99, 3)
    assert parse_scene("page letter").page == Page(215.9, 279.4)


@pytest.mark.capability("G3.L-comments")
def test_comments_run_to_the_end_of_the_line():
    item = one("# a cone\nCONE green# its colour\n revolution meridian 4 0 0, # first\n 0 0 7 # last\norder 30#\n#")
    assert counts(item) == (31, 60, 31)
    assert parse_scene('title "# no comment"').title == "# no comment"


@pytest.mark.capability("G3.1-object-names")
@pytest.mark.capability("G3.L-name")
def test_names_stand_in_the_order_of_the_file():
    scene = parse_scene('B box 1 1 1 A box 1 1 1 "my box" box 1 1 1 "camera" box 1 1 1 Straße box 1 1 1')
    assert [item.name for item in scene.items] == ["B", "A", "my box", "camera", "Straße"]


@pytest.mark.capability("G3.6-demo")
def test_an_intersection_is_drawn_in_place_of_its_parts():
    scene = parse_scene("""CONE gray revolution solid
            meridian 5 0 -10, 5 0 0, 0 0 11 order 45
        PRISM yellow revolution solid
            meridian 4 0 -12, 4 0 12 order 6
        PENCIL yellow solid intersection CONE PRISM translation 0 0 1
        LOOSE box 1 1 1""")
    assert [item.name for item in scene.items] == ["PENCIL", "LOOSE"]
    pencil = scene.items[0].shape
    assert is_closed_oriented(pencil) and pencil.bounds[:, 2].tolist() == pytest.approx([-9, 12])
    three = parse_scene("A box 2 2 2 B box 3 3 1 C box 1 3 3 D intersection A, B, C").items
    assert [i.name for i in three] == ["D"] and body_record(three[0].shape).volume == pytest.approx(2)


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize("order", range(6))
def test_words_may_stand_in_any_sensible_order(order):
    words = ["green", "solid", "metallic", "order 30", "meridian 4 0 0, 0 0 7", "revolution"]
    item = one("CONE " + " ".join(words[order:] + words[:order]))
    assert same_mesh(item.shape, revolution([[4, 0, 0], [0, 0, 7]], 30))
    assert (item.colour, item.material.word) == ("green", "metallic")
    late = one("BOX box 3 3 1 hollow +bottom gray")
    assert same_mesh(late.shape, box((3, 3, 1), caps=("bottom",)))


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize("path", sorted(DATA.glob("*.scene")), ids=lambda path: path.stem)
def test_every_scene_of_the_gallery_loads_without_a_warning(path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene = read_scene(path)
    assert scene.items and scene.title and scene.camera is not None
    for item in scene.items:
        assert (
            item.mesh is not item.shape or is_closed_oriented(item.shape) or item.name in ("PYRAMID", "LIGHT", "DARK")
        )


def test_empty_text_is_an_empty_scene():
    assert parse_scene("").items == () and parse_scene(" \n# nothing\n").items == ()


# --- mistakes ---

CONE = "CONE green revolution solid meridian 4 0 0 , 0 0 7 order 30"


@pytest.mark.capability("G3.0-reader")
@pytest.mark.capability("G3.L-name")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("\n\nCONE green revolutoin", "<text>:3: CONE: unknown word 'revolutoin', expected 'revolution'"),
        ("CONE green revolution\nmeridin 4 0 0", "<text>:2: CONE: expected 'meridian', got 'meridin'"),
        ("CONE revolution meridian 4 0 0, 0 0 7 ordr 30", "CONE: expected 'order', got 'ordr'"),
        ("CONE revolution meridian 4 0 0, 0 0 7", "CONE: expected 'order', got the end of the file"),
        ("CONE revolution meridian 4 0 0, 0 x 7 order 3", "expected a number for a point of the meridian, got 'x'"),
        ("CONE revolution meridian 4 0 0, 0 0 7 order 3.5", "CONE: expected a whole number for order, got '3.5'"),
        ("CONE revolution meridian 4 0 0, 0 0 7 order 1000000000", "CONE: order 1000000000: expected"),
        (
            "CONE",
            "CONE: expected one of vertices, revolution, translation, box, intersection, surface, curve, got",
        ),
        ("CONE 3 4", "CONE: expected one of .*, got '3'"),
        ("CONE green yellow box 1 1 1", "CONE: a second colour, 'yellow'"),
        ("B box 1 1", "<text>:1: B: expected a number for a length of the box, got the end of the file"),
        ("B box 1 nan 1", "B: a length of the box: 'nan' is not a finite number"),
        ("B box 1 inf 1", "'inf' is not a finite number"),
        ("B box 1 1e999 1", "'1e999' is not a finite number"),
        ("B box 1 0 1", "B: box 1 0 1: three finite lengths other than zero"),
        ("B box 1 1 1 4", "B: expected a word or the name of the next item, got '4'"),
        ("B box 1 1 1,", "B: expected a word or the name of the next item, got ','"),
        ("B box 1 1 1 rotation w 4", "B: expected an axis x, y or z after 'rotation', got 'w'"),
        ("B box 1 1 1 rotation x", "B: expected a number for the angle of a rotation, got the end of the file"),
        ("B box 1 1 1\nrotatoin x 40", r"rotatoin: expected one of .* \(or is 'rotatoin' meant to be 'rotation'\?\)"),
        ("B box 1 1 1\nlamp 1 2 3", r"lamp: expected one of .* \(or is 'lamp' meant to be 'light'\?\)"),
        ("B gray cone radius 1 height 2", "B: 'cone' is a surface: expected 'surface cone'"),
        ("\nB Sphere radius 1", "<text>:2: B: 'Sphere' is a surface: expected 'surface sphere'"),
        ("B box 1 1 1 RING gray circle 3", "RING: 'circle' is a curve: expected 'curve circle'"),
        ("B box 1 1 1 translation x", "B: expected a number for translation, got 'x'"),
        ("B box 1 1 1 translation nan 0 0", "'nan' is not a finite number"),
        ("B box 1 1 1 meridian 1 0 0", "B: is a 'box' already, 'meridian' does not fit"),
        ("B box 1 1 1 box 2 2 2", "B: a second 'box'"),
        ("box 1 1 1", "expected the name of an item, got 'box'"),
        ("7 box 1 1 1", "expected the name of an item, got '7'"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0\nfaces 1 2 4", "A: face 1 names vertex 4, there are 3"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0\nfaces 0 1 2", "A: face 1 names vertex 0, there are 3, counted from 1"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 -2 3", "A: face 1 names vertex -2"),
        (f"A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 {10**30}", "A: face 1 names vertex 1000"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2", "A: face 1 has fewer than three corners"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 3,", "expected a whole number for a vertex of a face, got the end"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 3.5", "expected a whole number for a vertex of a face, got '3.5'"),
        ("A vertices 0 0 0, 1 0, 0 1 0 faces 1 2 3", "expected a number for a vertex, got ','"),
        ("A vertices 0 0 0, 1 0 0, 0 1 nan faces 1 2 3", "a vertex: 'nan' is not a finite number"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0", "A: expected 'faces', got the end of the file"),
        ("A vertices 0 0 0, 1 0 0, 0 1 0 edges 1 5 faces 1 2 3", "A: edge 1 names vertex 5"),
        (
            "A vertices 0 0 0, 1 0 0, 1 1 0, 0 1 0 edges 1 2, 1 3 faces 1 2 3 4",
            r"A: edge 2 \(1 3\) is no side of a face",
        ),
        ("T translation base_points 0 0 0, 1 0 0, 0 1 0 trans_vector 1 1 0", "T: trans_vector lies in the plane"),
        ("T translation base_points 0 0 0, 1 0 0, 0 1 0", "T: expected 'trans_vector', got the end"),
        (CONE + "\nP intersection CONE, PRISM", "<text>:2: P: expected the name of an item before it, got 'PRISM'"),
        ("A box 1 1 1 B box 1 1 1 translation 5 0 0 P intersection A, B", "P: A and B have no volume in common"),
        ("B box 1 1 1 patterns polygon A red 0 0, 1 0, 0 1", "B: patterns: expected 'face' and its number"),
        (
            "B box 1 1 1 patterns face 7 polygon A red 0 0, 1 0, 0 1",
            "polygon A: there is no face 7, faces run from 1 to 6",
        ),
        ("B box 1 1 1 patterns face 1 polygon A red 0 0, 1 0", "polygon A has 2 points"),
        ("B box 1 1 1 patterns face 1 polygon A 0 0, 1 0", "polygon A: expected a colour, got '0'"),
        ("B box 1 1 1 removed_faces 9", "removed_faces: there is no face 9"),
        ("B box 1 1 1 lines silhouette", "lines: expected one of contour, .*, got 'silhouette'"),
        ("B box 1 1 1 opacity 2", "B: opacity 2 must lie between 0 and 1"),
        ("B box 1 1 1 occludes maybe", "B: occludes: expected yes or no, got 'maybe'"),
        ("camera target 0 0 0", "camera: expected 'eye'"),
        ("camera eye 0 0 0", "<text>:1: camera: the eye is in the target"),
        ("camera eye 0 0", "camera: expected a number for eye, got the end of the file"),
        ("camera eye 0 0 5 up 0 0 1", "camera: the up vector lies along the view"),
        ("camera eye 0 0 5 field_of_vision 180", "camera: field of vision 180 must lie between"),
        ("camera view sideways", "camera: expected a view"),
        ("camera eye 0 0 5\ncamera eye 0 0 6", "<text>:2: a second 'camera'"),
        ("page A4 margin 200", "<text>:1: a margin of 200 mm leaves nothing of the page"),
        ("page huge", "page 'huge': expected WIDTHxHEIGHT in mm or one of"),
        ("page 0x10", "page '0x10': expected"),
        ("light SUN 1 2 3", "light SUN: expected 'position' or 'direction', got '1'"),
        ("light SUN direction 0 0 0", "light SUN: the direction is zero"),
        ("light SUN position 0 0 9 colour mauve", "light SUN: expected a colour, got 'mauve'"),
        ("light SUN position 0 0 9 intensity 3", "light SUN: intensity 3 must lie between 0 and 1"),
        ("title Town", "expected a string in quotes after 'title', got 'Town'"),
        ('title "Town', 'a string lacks its closing "'),
        ('title "T\\q"', "is not a string"),
        ("background 7", "background: expected a colour, got '7'"),
        ("B box 1 1 1\x00", "<text>:1: a control character"),
    ],
)
def test_mistakes_name_line_item_and_the_word_expected(text, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_scene(text)
    assert caught.value.file == "<text>" and caught.value.line is not None
    assert "\n" not in str(caught.value)


@pytest.mark.capability("G3.0-reader")
def test_the_line_is_right_behind_comments_and_strings():
    text = '# one\ntitle "two # \\n"\n# three\nB box 1 1 1 # four\n# five\n  rotation # six\n  q 5'
    with pytest.raises(InputError, match=r"^<text>:7: B: expected an axis"):
        parse_scene(text)


@pytest.mark.hard(70)
def test_hard_70_expressions_are_not_evaluated():
    for word in ("__import__('os')", "1+1", "2*3", "0x10", "1/2"):
        with pytest.raises(InputError, match="expected a number"):
            parse_scene(f"B box {word} 1 1")


@pytest.mark.hard(65)
def test_hard_65_large_files_are_refused_before_they_are_read(tmp_path, monkeypatch):
    path = tmp_path / "large.scene"
    path.write_text("# " + "x" * 100)
    monkeypatch.setattr(scene_language, "MAX_FILE_BYTES", 50)
    with pytest.raises(InputError, match=r"large.scene: larger than"):
        read_scene(path)


@pytest.mark.hard(65)
def test_hard_65_the_number_of_items_is_bounded(monkeypatch):
    monkeypatch.setattr(scene_language, "MAX_ITEMS", 2)
    with pytest.raises(InputError, match=":3: C: more than 2 items"):
        parse_scene("A box 1 1 1\nB box 1 1 1\nC box 1 1 1")


@pytest.mark.hard(66)
def test_hard_66_wild_indices_and_nan_name_their_line():
    with pytest.raises(InputError, match="<text>:3: A: a vertex: 'NaN' is not a finite number"):
        parse_scene("A vertices\n 0 0 0,\n 1 NaN 0,\n 0 1 0 faces 1 2 3")
    with pytest.raises(InputError, match="<text>:2: A: face 2 names vertex 99"):
        parse_scene("A vertices 0 0 0, 1 0 0, 0 1 0\nfaces 1 2 3, 1 2 99")


def test_unreadable_files(tmp_path):
    with pytest.raises(InputError, match=r"nowhere.scene: No such file"):
        read_scene(tmp_path / "nowhere.scene")
    with pytest.raises(InputError, match="directory"):
        read_scene(tmp_path)
    binary = tmp_path / "binary.scene"
    binary.write_bytes(b"A box 1 1 1\n\xff\xfe\x00")
    with pytest.raises(InputError, match=r"binary.scene:2: not UTF-8"):
        read_scene(binary)
    marked = tmp_path / "marked.scene"
    marked.write_bytes(b"\xef\xbb\xbfA box 1 1 1\r\nB box 1 1 1\r\n")
    assert [item.name for item in read_scene(marked).items] == ["A", "B"]


SURFACES = """RING surface torus 3 1 parameter_lines 4 4 isophotes at 0 , 0.5 rotation x 30 scale 1 2 1
HILL surface graph "sin(x)*y" x -1 1 y -1 1 level_lines 3 SPRING surface helical 0.4 circle 0.5 centre 3 0 0 angle 0 90
BLOB surface implicit "x^2 + y^2 + z^2 - 1" box -2 2 -2 2 -2 2 sections normal 1 1 0 2 lines contour , section"""


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
@given(st.data())
def test_torn_texts_raise_input_errors_only(data):
    words = data.draw(
        st.sampled_from([PYRAMID, CONE, SURFACES, "camera eye 1 2 3 light L position 1 2 3 page A4"])
    ).split(" ")
    place = data.draw(st.integers(0, len(words)))
    wild = data.draw(
        st.sampled_from([*words, ",", '"', "#", "-1", "1e400", "x", "general", "patterns", "\\", "99", ""])
    )
    try:
        parse_scene(" ".join([*words[:place], wild, *words[place + data.draw(st.integers(0, 2)) :]]))
    except InputError as error:
        assert error.line is not None


DOCUMENTED = (DOCS / "scene-language.md").read_text().split("```")[1::2]


@pytest.mark.capability("G3.0-language")
def test_the_examples_of_the_documentation_are_scenes():
    examples = [text for text in DOCUMENTED if " = " not in text and "expected" not in text]
    names = [[item.name for item in parse_scene(text).items] for text in examples]
    capped = ["CAN", "CUP", "BOWL", "BEAM"]
    lines = [["EGG"], ["EGG", "RING", "ROAD", "BOX"], ["RING"]]
    surfaces = [["RING"], capped, ["SPRING", "VASE", "WAVES", "HEART"], *lines]
    curves = ["GLOBE", "COURSE", "SPRING", "KNOT"]
    splines = [["WIRE", "RING", "BOW", "ARC", "SAIL", "VASE"], ["HILLS"]]
    assert names == [["TOP", "MUG"], ["CUBE"], *surfaces, curves, *splines, ["PENCIL"], ["HOUSE"]]


@pytest.mark.capability("G3.0-language")
def test_every_word_of_the_language_is_documented():
    text = (DOCS / "scene-language.md").read_text()
    words = RESERVED - {c for p in PALETTES for c in ("light" + p, "dark" + p)}
    assert not [word for word in sorted(words) if f"`{word}`" not in text and f'"{word}"' not in text]


def test_every_word_of_an_item_has_what_reads_it():
    assert set(HANDLERS) == {*ITEM_WORDS, *FORM_WORDS, *CAP_WORDS, *COLOURS, *MATERIALS}


def test_a_word_that_does_not_belong_to_the_surface_before_it_is_said_to_be_one():
    with pytest.raises(InputError, match=r"'radius' is a word of the language, but none of what stands before it"):
        parse_scene("A surface torus radius 2 1")
