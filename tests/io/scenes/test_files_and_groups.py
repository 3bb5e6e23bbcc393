"""Scene files made of other files, of groups, and of things that are repeated."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import rotation_z
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
TREE = "TRUNK orange box 1 1 3\nCROWN green surface sphere 2 translation 0.5 0.5 5\nlight SUN position 0 0 9"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "tip.obj").write_text(TETRAHEDRON)
    (tmp_path / "parts" / "tree.scene").write_text(TREE)
    return tmp_path


def scene_of_text(folder, text, name="main.scene"):
    (folder / name).write_text(text)
    return vp.read(folder / name)


def origins(scene, name):
    return np.array([item.mesh.vertices[0] for item in scene.items if item.name.split()[0] == name])


def test_a_mesh_of_a_file_is_an_items_shape(folder):
    scene = scene_of_text(folder, 'A red mesh "parts/tip.obj" lines contour scale 2 translation 5 0 0')
    (item,) = scene.items
    assert (item.colour, item.lines, item.mesh.face_count) == ("red", ("contour",), 4)
    assert item.mesh.bounds.tolist() == [[5, 0, 0], [7, 2, 2]]
    again = parse_scene(write_scene(scene))
    assert np.array_equal(again.items[0].mesh.vertices, item.mesh.vertices)
    assert scene_of_text(folder, 'A mesh "parts/tip.obj" B box 1 1 1 C intersection A B').items[0].name == "C"


def test_included_scenes_come_with_their_lights_moved_and_repeated(folder):
    scene = scene_of_text(folder, 'GROUND box 9 9 1 include "parts/tree.scene" translation 4 0 1 ring 3')
    names = [item.name for item in scene.items]
    assert names == ["GROUND", *(f"{name}{number}" for number in ("", " 2", " 3") for name in ("TRUNK", "CROWN"))]
    assert [light.name for light in scene.lights] == ["SUN"]
    at = [np.array([4.0, 0.0, 1.0]) @ rotation_z(np.radians(angle)) for angle in (0, 120, 240)]
    assert np.allclose(origins(scene, "TRUNK"), at)
    tops = [item.shape.points(np.array(0.0), np.array(np.pi / 2)) for item in scene.items if item.name[:5] == "CROWN"]
    assert np.allclose(tops, [(4.5, 0.5, 8.0) @ rotation_z(np.radians(angle)) for angle in (0, 120, 240)])
    assert len(parse_scene(write_scene(scene)).items) == 7


def test_names_are_relative_to_the_file_they_stand_in(folder):
    (folder / "parts" / "two.scene").write_text('include "tree.scene" TIP mesh "tip.obj"')
    assert len(scene_of_text(folder, 'include "parts/two.scene"').items) == 3


@pytest.mark.parametrize(
    ("words", "places"),
    [
        ("grid 3 apart 2", [(0, 0, 0), (2, 0, 0), (4, 0, 0)]),
        ("grid 1 2 2 apart 9 3 -4", [(0, 0, 0), (0, 3, 0), (0, 0, -4), (0, 3, -4)]),
        ("translation 1 0 0 ring 4", [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]),
        ("translation 0 1 0 ring x 2 translation 5 0 0", [(5, 1, 0), (5, -1, 0)]),
        ("grid 2 apart 1 scale 3 ring 1", [(0, 0, 0), (3, 0, 0)]),
        ("grid 2 apart 1 grid 1 2 apart 0 5", [(0, 0, 0), (1, 0, 0), (0, 5, 0), (1, 5, 0)]),
    ],
)
def test_items_are_repeated_where_the_modifiers_say(words, places):
    text = f"A box 1 1 1 {words}"
    scene = parse_scene(text)
    assert np.allclose(origins(scene, "A"), places, atol=1e-15)
    assert [item.name for item in scene.items] == ["A", *(f"A {k}" for k in range(2, len(places) + 1))]
    assert np.allclose(origins(parse_scene(write_scene(scene)), "A"), places, atol=1e-15)
    together = parse_scene(f"assembly A box 1 1 1 end {words}")
    assert np.allclose(origins(together, "A"), places, atol=1e-15)


def test_what_lies_on_an_item_is_repeated_with_it():
    (one, two) = parse_scene("A surface sphere 1 sections z at 0.5 parameter_lines 4 4 grid 1 1 2 apart 0 0 3").items
    assert (one.curves.sections[0].offsets, two.curves.columns) == ((0.5,), 4)
    (one, two) = parse_scene("assembly A surface sphere 1 sections z at 0.5 end grid 1 1 2 apart 0 0 3").items
    assert two.curves.sections[0].offsets == (3.5,)
    lit = parse_scene(
        "A surface sphere 1 isophotes 3 lit_by L grid 2 apart 3 light K position 1 1 1 light L position 0 0 9"
    )
    assert [item.curves.light for item in lit.items] == [1, 1]


def test_assemblies_stand_in_assemblies_and_intersections_in_them():
    text = "assembly A box 1 1 1 assembly B box 1 1 1 end grid 2 apart 2 end translation 0 0 5 ring 2"
    scene = parse_scene(text)
    assert [item.name for item in scene.items] == ["A", "B", "B 2", "A 2", "B 2", "B 2 2"]
    assert {item.mesh.vertices[0][2] for item in scene.items} == {5.0}
    cut = parse_scene("assembly A box 2 2 2 B box 1 1 1 C intersection A B end grid 2 apart 4")
    assert [item.name for item in cut.items] == ["C", "C 2"]
    kept = parse_scene("assembly A box 2 2 2 B box 1 1 1 end C intersection A B")
    assert [item.name for item in kept.items] == ["C"]


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ('\nA mesh "../up.obj"', 2, "A: '../up.obj' lies outside the folder of the scene"),
        ('A mesh "/etc/passwd.obj"', 1, "outside"),
        ('A mesh "gone.obj"', 1, "no such file"),
        ('A mesh "parts/tip.step"', 1, "expected a file that ends in .obj"),
        ("A mesh parts", 1, "expected the name of a file in quotes"),
        ('A mesh "parts/tip.obj" surface sphere', 1, "is a 'mesh' already"),
        ('include "main.scene"', 1, "'main.scene' includes itself"),
        ('\n\ninclude "a\\u0000b"', 3, "no name of a file|no such file"),
        ('include "parts"', 1, "no such file"),
        ("A box 1 1 1 ring 0", 1, "a ring of 0 copies"),
        ("A box 1 1 1 ring 1.5", 1, "whole number for the copies of a ring"),
        ("A box 1 1 1 grid 2 2 2 2 apart 1", 1, "grid: expected 'apart'"),
        ("A box 1 1 1 grid 2 2 apart 1", 1, "a distance of the grid"),
        ("A box 1 1 1 grid 1000 1000 apart 1 1", 1, "more than 100000 copies"),
        ("A box 1 1 1 ring 1000 ring 1000", 1, "more than 100000 copies"),
        ("A box 1 1 1\nassembly B box 1 1 1", 2, "assembly: expected 'end'"),
        ("assembly camera eye 1 1 1 end", 1, "assembly: expected an item"),
        ("A box 1 1 1 end", 1, "'end' without 'assembly' or 'union'"),
        ("assembly " * 20, 1, "more than 16 in one another"),
        ("assembly A surface sphere 1 isophotes 3 lit_by 1 end ring 2 light position 1 1 1", 1, "cannot be moved"),
    ],
)
def test_mistakes_are_told_with_file_and_line(folder, text, line, said):
    with pytest.raises(vp.InputError, match=said) as error:
        scene_of_text(folder, text)
    assert (error.value.file, error.value.line) == (str(folder / "main.scene"), line)


def test_mistakes_in_included_files_are_told_there(folder):
    (folder / "parts" / "tree.scene").write_text("\nTRUNK bx 1 1 3")
    with pytest.raises(vp.InputError, match="expected 'box'") as error:
        scene_of_text(folder, 'include "parts/tree.scene"')
    assert (error.value.file.endswith("tree.scene"), error.value.line) == (True, 2)


@pytest.mark.slow
def test_neither_circles_nor_links_nor_long_chains_lead_out(folder, tmp_path_factory):
    (folder / "a.scene").write_text('include "b.scene"')
    (folder / "b.scene").write_text('include "a.scene"')
    with pytest.raises(vp.InputError, match=r"b\.scene:1: include: 'a.scene' includes itself"):
        vp.read(folder / "a.scene")
    away = tmp_path_factory.mktemp("away") / "secret.obj"
    away.write_text(TETRAHEDRON)
    (folder / "link.obj").symlink_to(away)
    with pytest.raises(vp.InputError, match="lies outside"):
        scene_of_text(folder, 'A mesh "link.obj"')
    for number in range(20):
        (folder / f"{number}.scene").write_text(f'include "{number + 1}.scene"')
    with pytest.raises(vp.InputError, match="more than 16 scenes in one another"):
        vp.read(folder / "0.scene")
    # Ten files that include the next one ten times each.
    for number in range(10):
        (folder / f"{number}.scene").write_text(f'include "{number + 1}.scene" ' * 10)
    (folder / "10.scene").write_text("A box 1 1 1")
    with pytest.raises(vp.InputError, match="more than 1000 files"):
        vp.read(folder / "0.scene")


def test_a_text_without_a_file_names_no_files():
    for text in ('A mesh "a.obj"', 'include "a.scene"'):
        with pytest.raises(vp.InputError, match="a text without a file names no files"):
            parse_scene(text)
