"""The scene language: its words, and every way of writing them."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from support.paths import DATA
from support.scene_texts import PYRAMID

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.solids import box, revolution
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.io.scene_language import parse_scene, read_scene
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.textbook.polyhedra import body_record
from vectorplot.words import PALETTES


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


def test_bores_and_cutouts_go_through_a_slab_and_stand_where_it_does():
    slab = "A translation base_points 0 0 0, 9 0 0, 9 9 0, 0 9 0 trans_vector 0 0 2"
    text = f"{slab} bore 2 2 0 1, 7 2 0 1 cutout 2 6 0, 3 6 0, 3 8 0 bore 6 6 0 2 cutout 4 3 0, 5 3 0, 5 4 0 scale 2"
    body = one(text).shape
    round_area = 24 * np.sin(2 * np.pi / 48)
    assert is_closed_oriented(body)
    assert body_record(body).volume == pytest.approx(16 * (81 - (1 + 1 + 4) * round_area - 1 - 0.5), rel=1e-9)
    assert body.face_sizes.tolist().count(4) >= 4 + 3 * 48 + 6
    assert one(f"{slab} bore 2 2 0 1").shape.bounds.tolist() == one(slab).shape.bounds.tolist()


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
    assert parse_scene("camera front target 1 2 3 height 7").camera == front
    assert front.parallel and front.height == 7 and front.target == (1, 2, 3)
    assert np.allclose(front.direction, [0, -1, 0])


def test_pages_by_size():
    assert parse_scene("page 300x200").page == Page(300, 200)
    assert parse_scene("page 150.5x99mm landscape margin 3").page == Page(150.5, 99, 3)
    assert parse_scene("page letter").page == Page(215.9, 279.4)
    assert parse_scene("page A4 portrait margin 5").page == Page(210, 297, 5)
    assert parse_scene("page 300x200 portrait").page == Page(200, 300)


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
        # Panes of windows and the like are open.
        is_open = item.name.split()[0] in ("PYRAMID", "LIGHT", "DARK", "PANE", "GLASS")
        assert item.mesh is not item.shape or is_closed_oriented(item.shape) or is_open, item.name


def test_empty_text_is_an_empty_scene():
    assert parse_scene("").items == () and parse_scene(" \n# nothing\n").items == ()


@pytest.mark.slow
@pytest.mark.capability("G3.L-mathobj")
def test_objects_that_are_no_polyhedra_have_words_too():
    text = "\n".join(
        [
            "RING surface torus 3 1",
            'SADDLE surface graph "x*y" x -1 1 y -1 1',
            'LEVEL surface implicit "x^2 + y^2 + z^2 - 1" box -2 2 -2 2 -2 2',
            'FREE surface function "u" "v" "u*v" u 0 1 v 0 1',
            "HILL surface landscape heights 0 1 0, 1 3 1, 0 1 0 x 0 2 y 0 2 akima",
            "LAND terrain heights 0 1 0, 1 3 1, 0 1 0",
            "LOAF surface torus 3 1 slices z 5",
            "BALL surface sphere 2",
            "WIRE curve akima 0 0 0, 1 0 1, 2 1 0, 3 3 1, 4 0 0",
        ]
    )
    scene = parse_scene(text)
    assert [item.name for item in scene.items] == [line.split()[0] for line in text.splitlines()]
    for item in scene.items:
        lines = vp.draw(vp.Scene((item,)), camera=vp.Camera((9.0, -12.0, 8.0)), page="60x60", tolerance_mm=0.2)
        assert sum(len(paths) for layer in lines.layers for paths in layer.strokes), item.name
