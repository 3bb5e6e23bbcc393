"""Faces with colours and materials of their own, in every verb and through what is done to meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import geometry
from vectorplot.drawing import Fills
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import Cut, FaceLook, FaceLooks
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene

CAMERA = vp.Camera((9.0, 7.0, 6.0), (1.0, 1.0, 1.0))
TOP, RIGHT, BACK = 5, 1, 2
LOOKS = {TOP: FaceLook("#ff0000"), RIGHT: FaceLook("#00ff00")}


def box(looks: dict[int, FaceLook] | None = None) -> Item:
    mesh = geometry.box((2, 2, 2))
    return Item("box", mesh, "#0000ff", face_looks=FaceLooks.of(mesh, LOOKS if looks is None else looks))


def hues(drawing: vp.Drawing) -> set[str]:
    """Which of red, green and blue colours of fills have."""
    fills = [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, Fills)]
    colours = np.concatenate([one.colours for one in fills])
    return {
        "rgb"[k] for k in range(3) if ((colours[:, k] > 0) & (np.delete(colours, k, axis=1) == 0).all(axis=1)).any()
    }


@pytest.mark.capability("G3.2-face")
def test_paint_and_render_show_faces_in_their_colours() -> None:
    scene = Scene((box(),))
    assert hues(vp.paint(scene, CAMERA)) == set("rgb")
    pixels = np.asarray(vp.render(scene, CAMERA, size=(80, 60)).pixels)[..., :3].reshape(-1, 3).astype(int)
    most = pixels - np.roll(pixels, 1, axis=1).clip(0) - np.roll(pixels, 2, axis=1)
    assert (most.max(axis=0) > 50).all()


@pytest.mark.capability("G3.2-face")
@pytest.mark.parametrize("way", ["triangles", "moved", "mirrored", "cut", "near", "exploded"])
def test_looks_stay_whatever_is_done_to_the_mesh(way: str) -> None:
    item, camera, scene = box(), CAMERA, None
    if way == "triangles":
        fans = [(f[0], f[k], f[k + 1]) for f in item.mesh.polygons() for k in (1, 2)]
        item = Item("box", vp.Mesh.from_triangles(item.mesh.vertices, fans), "#0000ff", face_looks=item.face_looks)
    elif way == "moved":
        item = item.moved(0.3, 0.2, 0.1).scaled(1.1)
    elif way == "mirrored":
        item = item.transformed(np.diag([1.0, -1.0, 1.0, 1.0])).moved(0.0, 2.0, 0.0)
    elif way == "cut":
        scene = Scene((item,), cuts=(Cut.of("x + y > 3"),))
    elif way == "near":
        camera = vp.Camera((9.0, 7.0, 6.0), (1.0, 1.0, 1.0), far=11.0)
    elif way == "exploded":
        scene = vp.exploded(Scene((item, Item("lid", geometry.box((2, 2, 1)).moved(0, 0, 2), "white"))), "z")
    assert set("rg") <= hues(vp.paint(scene or Scene((item,)), camera))


@pytest.mark.capability("G3.2-face")
def test_a_single_face_mirrors() -> None:
    floor = Item("floor", geometry.box((8, 8, 0.2)).moved(-3, -3, -0.3), "#ff0000")
    lights = (Light((6, 3, 9)),)

    def red_over_front(looks: dict[int, FaceLook]) -> bool:
        scene = Scene((box(looks), floor), lights=lights)
        pixels = np.asarray(vp.render(scene, vp.Camera((1, -9, 3), (1, 1, 1)), size=(60, 60)).pixels).astype(int)
        middle = pixels[30, 30]
        return bool(middle[0] > middle[2])

    assert red_over_front({0: FaceLook(material=Material("mirror"))})
    assert not red_over_front({BACK: FaceLook(material=Material("mirror"))})


@pytest.mark.capability("G3.2-face")
def test_the_language_gives_faces_looks_and_writes_them() -> None:
    text = """
        B blue box 2 2 2 face_looks 6 red , 2 3 colour "#00ff00" mirror
        P general vertices 0 0 0 , 1 0 0 , 0 1 0 , 0 0 1
          faces 1 3 2 red , 1 2 4 , 2 3 4 opacity 0.5 , 1 4 3 yellow
        """
    scene = parse_scene(text)
    for one in (scene, parse_scene(write_scene(scene))):
        first, second = one.items
        assert first.face_looks is not None
        assert second.face_looks is not None
        assert [first.face_looks.looks[k].colour if k >= 0 else None for k in first.face_looks.of_face] == [
            *(None, "#00ff00", "#00ff00", None, None, "red")
        ]
        assert first.face_looks.looks[first.face_looks.of_face[1]].material == Material("mirror")
        assert second.face_looks.of_face.tolist() == [0, -1, 1, -1]
        assert second.face_looks.looks[1].material == Material("normal", opacity=0.5)
        assert second.colour == "yellow"


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("face_looks 9 red", "there is no face 9, faces run from 1 to 6"),
        ("face_looks red", "expected the number of a face"),
        ("face_looks 1", "expected a colour or a material"),
    ],
)
def test_wrong_looks_are_told(words: str, cause: str) -> None:
    with pytest.raises(vp.InputError, match=cause):
        parse_scene(f"B box 1 1 1 {words}")


PYRAMID = """mtllib p.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0.5 0.5 1
usemtl a
f 4 3 2 1
usemtl the red
f 1 2 5
f 2 3 5
usemtl glass
f 3 4 5
usemtl a
f 4 1 5
"""
LIBRARY = "newmtl a\nKd 0 0 1\nnewmtl the red\nKd 1 0 0 # red\nNs 5\nnewmtl glass\nKd 0 1 0\nd 0.5\n"


def test_materials_of_obj_files_are_looks_of_faces(tmp_path: Path) -> None:
    (tmp_path / "p.obj").write_text(PYRAMID)
    (tmp_path / "p.mtl").write_text(LIBRARY)
    (tmp_path / "s.scene").write_text('P mesh "p.obj" face_looks 5 yellow')
    (item,) = vp.read(tmp_path / "p.obj").items
    assert item.face_looks is not None
    shown = [item.face_looks.looks[k] for k in item.face_looks.of_face]
    assert [look.colour for look in shown] == ["#0000ff", "#ff0000", "#ff0000", "#00ff00", "#0000ff"]
    assert shown[3].material == Material("normal", opacity=0.5)
    (item,) = vp.read(tmp_path / "s.scene").items
    assert item.face_looks is not None
    assert [item.face_looks.looks[k].colour for k in item.face_looks.of_face[2:]] == ["#ff0000", "#00ff00", "yellow"]


def test_one_material_is_the_colour_of_the_item(tmp_path: Path) -> None:
    (tmp_path / "p.obj").write_text(
        "\n".join(row for row in PYRAMID.split("\n") if "red" not in row and "glass" not in row)
    )
    (tmp_path / "p.mtl").write_text(LIBRARY)
    (item,) = vp.read(tmp_path / "p.obj").items
    assert (item.colour, item.face_looks) == ("#0000ff", None)


@pytest.mark.parametrize(
    ("library", "content", "told"),
    [
        ("gone.mtl", "", "p.obj:1: mtllib gone.mtl: no such file"),
        ("../p.mtl", LIBRARY, "p.obj:1: mtllib ../p.mtl: lies outside of the folder"),
        ("p.mtl", "newmtl a\nKd 1 x 0\n", "p.mtl:2: mtllib p.mtl: Kd needs numbers"),
        ("p.mtl", "newmtl a\nKd 1 0 0\n", "material the red is in no library"),
    ],
)
def test_a_library_that_gives_no_colours_is_one_warning(tmp_path: Path, library: str, content: str, told: str) -> None:
    folder = tmp_path / "deep"
    folder.mkdir()
    (folder / "p.obj").write_text(PYRAMID.replace("mtllib p.mtl", f"mtllib {library}"))
    if content:
        (folder / library).write_text(content)
    with pytest.warns(vp.InputWarning) as caught:
        vp.read(folder / "p.obj")
    assert len(caught) == 1
    assert told in str(caught[0].message)


@pytest.mark.parametrize(("kind", "most"), [("uchar", "255"), ("float", "1.0")])
def test_colours_of_faces_in_ply_files_are_their_looks(tmp_path: Path, kind: str, most: str) -> None:
    rows = [
        f"3 0 2 1 {most} 0 0 {most}",
        f"3 0 1 3 0 {most} 0 {most}",
        f"3 1 2 3 0 0 {most} 0",
        f"3 0 3 2 0 0 0 {most}",
    ]
    colours = "".join(f"property {kind} {name}\n" for name in ("red", "green", "blue", "alpha"))
    (tmp_path / "t.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face 4\nproperty list uchar int vertex_indices\n{colours}end_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + "\n".join(rows) + "\n"
    )
    (item,) = vp.read(tmp_path / "t.ply").items
    assert item.face_looks is not None
    shown = [item.face_looks.looks[k] for k in item.face_looks.of_face]
    assert [look.colour for look in shown] == ["#ff0000", "#00ff00", "#0000ff", "#000000"]
    assert [look.material for look in shown] == [None, None, Material("normal", opacity=0.0), None]


def inks(drawing: vp.Drawing) -> dict[str, float]:
    """How long the strokes of each layer are in the world."""
    found: dict[str, float] = {}
    for layer in drawing.layers:
        for paths in layer.strokes:
            way = np.diff(paths.points3d, axis=0)
            way[paths.offsets[1:-1] - 1] = 0.0
            found[layer.name] = found.get(layer.name, 0.0) + float(np.sqrt((way**2).sum(axis=1)).sum())
    return {name: length for name, length in found.items() if length}


SIDES = "faces 1 2 6 5 red, 2 3 7 6 green, 5 6 7 8, 3 4 8 7 , 4 1 5 8, 4 3 2 1 yellow"
CORNERS = "vertices 0 0 0, 2 0 0, 2 2 0, 0 2 0, 0 0 2, 2 0 2, 2 2 2, 0 2 2"
SHOWN = vp.Camera((7.0, -9.0, 6.0), (1.0, 1.0, 1.0))


@pytest.mark.capability("G3.2-face")
@pytest.mark.parametrize("move", [1.0, 1e6])
def test_layers_by_colour_go_by_the_face_that_is_seen_and_listed_first(move: float) -> None:
    scene = parse_scene(f"B blue general {CORNERS} {SIDES}").moved(move, 0.0, 0.0)
    camera = vp.Camera((7.0 + move, -9.0, 6.0), (1.0 + move, 1.0, 1.0))
    length = inks(vp.draw(scene, camera, layers="colour", lines=("contour", "crease")))
    # The front is red, with all four of its edges; the right side has two of what is left, and the top two.
    assert {name: round(one, 3) for name, one in length.items()} == {"red": 8.0, "green": 6.0, "blue": 4.0}
    by_kind = inks(vp.draw(scene, camera, layers="kind,colour", lines=("contour", "crease")))
    assert round(by_kind["visible red"], 3) == 4.0
    assert {layer.pen.colour for layer in vp.draw(scene, camera, layers="colour").layers} == {
        *("#c00000", "#1a7a1a", "#1f4fa3")
    }


def colours_of(drawing: vp.Drawing) -> set[str]:
    return {word for name in inks(drawing) for word in name.split() if word in ("red", "green", "blue", "yellow")}


FRONT = {"camera": vp.Camera((1.0, -9.0, 1.0), (1.0, 1.0, 1.0)), "layers": "colour"}


@pytest.mark.parametrize("way", ["patterns", "hatches", "cut", "wireframe", "panorama", "inside"])
def test_whatever_lies_on_a_face_has_its_colour(way: str) -> None:
    text = f"B blue general {CORNERS} {SIDES}"
    if way == "patterns":
        dots = parse_scene(text + " patterns face 1 polygon DOT white -1 -1, 1 -1, 0 1")
        assert "pattern red" in inks(vp.draw(dots, SHOWN, layers="kind,colour"))
    elif way == "hatches":
        hatches = inks(vp.draw(parse_scene(text + " hatch colour"), SHOWN, layers="colour"))
        assert {"hatch red", "hatch green", "hatch blue"} <= set(hatches)
    elif way == "cut":
        half = inks(vp.draw(vp.cut(parse_scene(text), "z > 1"), lines="boundary,contour", **FRONT))
        assert round(half["red"], 3) == 4.0
    elif way == "wireframe":
        assert colours_of(vp.draw(parse_scene(text), SHOWN, style="wireframe")) == {"red", "green", "blue"}
    elif way == "panorama":
        round_about = vp.panorama(parse_scene(text), (1.0, -3.0, 1.0), layers="colour", lines="contour,crease")
        assert colours_of(round_about) == {"red"}
    else:
        # Of an open box the back is seen from inside, past the front that is gone.
        opened = parse_scene(text.replace("general", "hollow").replace("3 4 8 7", "3 4 8 7 green") + " removed_faces 1")
        assert "green" in colours_of(vp.draw(opened, **FRONT))


def test_highlights_of_libraries_are_those_of_materials(tmp_path: Path) -> None:
    (tmp_path / "p.obj").write_text(PYRAMID)
    (tmp_path / "p.mtl").write_text(
        "newmtl a\nKd 0 0 0.5\nKs 0.5 0.25 0\nNs 64\nillum 2\n"
        "newmtl the red\nKd 1 0 0\nKs 1 1 1\nNs 0\n"
        "newmtl glass\nKd 0 1 0\nKs 1 1 1\nillum 1\nNs 20\nd 0.5\n"
    )
    (item,) = vp.read(tmp_path / "p.obj").items
    assert item.face_looks is not None
    shown = [item.face_looks.looks[k] for k in item.face_looks.of_face]
    # Half of the palette each; cos(b / 2)^64 is cos(b)^16.
    assert shown[0].material == Material("normal", diffuse=0.5, highlight=5.0, sharpness=16.0)
    assert shown[1].material is None
    assert shown[3].material == Material("normal", opacity=0.5)
