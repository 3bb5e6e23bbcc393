"""Mistakes in scene files: each is one line that names the file, the line and the item, and says what was expected."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.scene_texts import PYRAMID

from vectorplot.errors import InputError
from vectorplot.io import scene_language
from vectorplot.io.scene_language import parse_scene, read_scene

SLAB = "T translation base_points 0 0 0, 9 0 0, 9 9 0, 0 9 0 trans_vector 0 0 1"
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
            "CONE: expected one of vertices, revolution, translation, box, intersection, surface, curve, mesh, terrain",
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
        ("B gray prism 1 2 3", "B: there is no 'prism': a prism is a 'translation' with 'base_points'"),
        ("B Cuboid 1 2 3", "B: there is no 'Cuboid': expected 'box' and its three lengths"),
        (
            "A box 1 1 1 B box 1 1 1 C red union A, B",
            r"C: expected one of vertices, revolution, .*, mesh, terrain, got",
        ),
        ("A box 1 1 1\nB #c86414 box 1 1 1", r'<text>:2: B: .* \(behind # is a comment; .* colour "#c86414"\)'),
        ("A box 1 1 1\nB red # c86414", r"B: expected one of .*terrain, got the end of the file$"),
        ("B gray cone radius 1 height 2", "B: 'cone' is a surface: expected 'surface cone'"),
        ("\nB Sphere radius 1", "<text>:2: B: 'Sphere' is a surface: expected 'surface sphere'"),
        ("B box 1 1 1 RING gray circle 3", "RING: 'circle' is a curve: expected 'curve circle'"),
        ("B box 1 1 1 translation x", "B: expected a number for translation, got 'x'"),
        ("B box 1 1 1 translation nan 0 0", "'nan' is not a finite number"),
        ("B box 1 1 1 meridian 1 0 0", "B: is a 'box' already, 'meridian' does not fit"),
        ("B box 1 1 1 box 2 2 2", "B: a second 'box'"),
        ("box 1 1 1", "expected the name of an item, got 'box'"),
        ("7 box 1 1 1", "expected the name of an item, got '7'"),
        ('N "#c86414" box 1 1 1', "N: expected one of vertices, revolution"),
        ('N "#c86414" box 1 1 1', 'before a colour in quotes stands the word for it: colour "#c86414"'),
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
        ("A box 1 1 1 face_looks 7 red", "there is no face 7, faces run from 1 to 6"),
        ("T translation base_points 0 0 0, 1 0 0, 0 1 0 trans_vector 1 1 0", "T: trans_vector lies in the plane"),
        ("T translation base_points 0 0 0, 1 0 0, 0 1 0", "T: expected 'trans_vector', got the end"),
        (f"{SLAB} bore 5 5 0", "T: expected a number for a centre and a radius of the bore, got the end"),
        (f"{SLAB} bore 5 5 0 0", "T: a bore of radius 0: expected more than 0"),
        (f"{SLAB} bore 5 5 0 1, 8 8 0 2", "T: hole 2 reaches to the outline of the base"),
        (f"{SLAB} bore 3 3 0 1, 4 4 0 1", "T: holes 1 and 2 meet"),
        (f"{SLAB} cutout 3 3 1, 4 3 0, 4 4 0", "T: hole 1 and the base do not lie in one plane"),
        (f"{SLAB} cutout 3 3 0, 4 3", "T: expected a number for a point of the cutout, got the end"),
        ("B box 1 1 1 bore 0 0 0 1", "B: is a 'box' already, 'bore' does not fit"),
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
        ("camera iso view front", "camera: a second view"),
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


def test_a_word_that_does_not_belong_to_the_surface_before_it_is_said_to_be_one():
    with pytest.raises(InputError, match=r"'radius' is a word of the language, but none of what stands before it"):
        parse_scene("A surface torus radius 2 1")
    # What a camera has too is no camera's behind a surface.
    with pytest.raises(InputError, match=r"1: 'height' is a word .*: a cylinder has radius, bottom, top"):
        parse_scene("A surface cylinder radius 1 height 2")
    with pytest.raises(InputError, match=r"1: there is no 'turns': a helix has radius, rise"):
        parse_scene("A curve helix 1 0.2 turns 3")
