"""The verb develop: what is cut, folded and carried along, on paper in true size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.commands.develop import develop
from vectorplot.geometry import box, revolution
from vectorplot.io import parse_scene
from vectorplot.surfaces import Cylinder

PIPES = """A gray surface cylinder 20 -50 50 rotation z 90
           B gray surface cylinder 14 0 60 rotation y 90"""


def strokes(drawing, name):
    """The strokes of a layer, as shapely's lines."""
    (layer,) = (layer for layer in drawing.layers if layer.name == name)
    lines = []
    for paths in layer.strokes:
        for part, closed in zip(np.split(paths.points, paths.offsets[1:-1]), paths.closed, strict=True):
            lines.append(shapely.LineString(np.vstack([part, part[:1]]) if closed else part))
    return lines


def length(drawing, name):
    return sum(line.length for line in strokes(drawing, name))


@pytest.mark.slow
def test_a_cube_is_cut_around_and_folded_in_true_size():
    drawing = vp.development(box((20, 20, 20)))
    assert (round(drawing.width_mm), round(drawing.height_mm)) == (100, 80)
    (outline,) = strokes(drawing, "cut")
    assert outline.length == pytest.approx(14 * 20) and shapely.Polygon(outline.coords).area == pytest.approx(6 * 400)
    folds = [line for line in strokes(drawing, "mountain fold")]
    assert all(line.length <= 3.0 + 1e-9 for line in folds)


@pytest.mark.parametrize(
    ("how", "factor"), [({"unit": "cm"}, 10.0), ({"scale": "1:2"}, 0.5), ({"unit": "in", "scale": "2:1"}, 50.8)]
)
def test_scale_and_unit(how, factor):
    assert length(vp.development(box((2, 2, 2)), **how), "cut") == pytest.approx(28 * factor)


@pytest.mark.slow
def test_valley_folds_are_told_from_mountain_folds():
    spool = revolution([(20, 0, 0), (10, 0, 10), (20, 0, 20)], order=6)
    names = [layer.name for layer in vp.development(spool).layers]
    assert names == ["cut", "mountain fold", "valley fold"]
    assert "valley fold" not in [layer.name for layer in vp.development(spool, crease_angle_deg=150).layers]


@pytest.mark.slow
def test_each_pair_of_sides_has_a_tab_and_two_equal_numbers():
    plain, drawing = (vp.development(box((20, 20, 20)), tabs_mm=tabs, numbers=True) for tabs in (0.0, 5.0))
    (outline,) = strokes(drawing, "cut")
    foot = 5.0 / np.tan(np.pi / 3)
    assert shapely.Polygon(outline.coords).area == pytest.approx(2400 + 7 * 5.0 * (20 - foot))
    assert shapely.Polygon(outline.coords).is_valid
    # 1 has a stroke, and so have 2, 3, 5, 6 and 7; 4 has two.
    assert len(strokes(plain, "label")) == len(strokes(drawing, "label")) >= 14


@pytest.mark.slow
def test_two_pipes_have_their_curve_on_both():
    drawing = vp.development(parse_scene(PIPES))
    assert length(drawing, "cut") == pytest.approx(2 * (2 * np.pi * 20 + 100) + 2 * (2 * np.pi * 14 + 60), abs=1e-3)
    curve = vp.draw(parse_scene(PIPES), lines="intersection", hidden="solid").layers
    assert curve
    angle = np.linspace(0, 2 * np.pi, 20001)
    y, z = 14 * np.cos(angle), 14 * np.sin(angle)
    rim = np.stack([np.sqrt(400 - y**2), y, z], axis=1)
    once = np.linalg.norm(np.diff(rim, axis=0), axis=1).sum()
    assert length(drawing, "intersection") == pytest.approx(2 * once, rel=1e-3)


@pytest.mark.slow
def test_bodies_with_caps_are_mantle_and_caps():
    drawing = vp.development(parse_scene("C gray surface cone 15 40 capped"))
    side = np.hypot(15, 40)
    assert length(drawing, "cut") == pytest.approx(2 * side + 2 * 2 * np.pi * 15, abs=0.05)


@pytest.mark.slow
def test_sections_patterns_and_parameter_lines_are_carried_along():
    text = """DIE gray box 20 20 20 sections z 1 patterns face 1 polygon P red -3 -3, 3 -3, 3 3, -3 3
              CAN gray surface cylinder 10 0 30 sections z at 15 parameter_lines 4 0 translation 100 0 0"""
    drawing = vp.development(parse_scene(text))
    assert length(drawing, "section") == pytest.approx(4 * 20 + 2 * np.pi * 10, abs=0.01)
    assert length(drawing, "pattern") == pytest.approx(24)
    assert length(drawing, "visible") == pytest.approx(3 * 30)


def test_meshes_that_meet_have_the_line_too():
    drawing = vp.development((vp.Item("a", box((20, 20, 20))), vp.Item("b", box((10, 10, 40)).moved(5, 5, 10))))
    assert length(drawing, "intersection") == pytest.approx(2 * 40)


@pytest.mark.slow
def test_what_is_nearly_developable_is_told():
    u, v = np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5), indexing="ij")
    points = 50 * np.stack([u, v, 0.2 * u**2 + 1e-5 * v**2 * u], axis=-1).reshape(-1, 3)
    cells = [(i * 5 + j, (i + 1) * 5 + j, (i + 1) * 5 + j + 1, i * 5 + j + 1) for i in range(8) for j in range(4)]
    mesh = vp.Mesh.from_triangles(points, [t for a, b, c, d in cells for t in ((a, b, c), (a, c, d))])
    with pytest.warns(vp.InputWarning, match=r"sheet: developed as if corners up to 0\.\d+ mm apart were one"):
        drawing = vp.development(vp.Item("sheet", mesh))
    assert length(drawing, "cut") == pytest.approx(
        shapely.union_all(strokes(drawing, "cut")).convex_hull.length, rel=1e-3
    )


def test_what_cannot_be_developed_is_told():
    with pytest.raises(vp.InputError, match="BALL: is not developable"):
        vp.development(parse_scene("BALL gray surface sphere 1"))
    with pytest.warns(vp.InputWarning, match=r"BALL: is not developable: .*; it is left out"):
        vp.development(parse_scene("BALL gray surface sphere 1 DIE gray box 1 1 1"))
    with pytest.raises(vp.InputError, match="nothing to develop"):
        vp.development(parse_scene("LOOP gray curve circle 1"))
    with pytest.raises(vp.InputError, match=r"the pieces take 400 x 300 mm, the page has 277 x 190 mm for them"):
        vp.development(box((100, 100, 100)), page="A4 landscape")
    with pytest.raises(vp.InputError, match="tabs of -1 mm"):
        vp.development(box((1, 1, 1)), tabs_mm=-1)
    with pytest.raises(vp.InputError, match="unit"):
        vp.development(box((1, 1, 1)), unit="mile")


def test_the_command_writes_a_page_and_its_parts(tmp_path):
    words = ["data/box.scene", "--unit", "cm", "--tabs", "5", "--tiles", "2x1", "-q", "-o", str(tmp_path / "net.svg")]
    result = CliRunner().invoke(develop, words)
    assert result.exit_code == 0, result.output
    assert sorted(file.name for file in tmp_path.iterdir()) == ["net-1-1.svg", "net-1-2.svg", "net.svg"]
    assert 'inkscape:label="1 cut"' in (tmp_path / "net.svg").read_text()


RIMS = [
    ("cylinder 20 0 40 capped", [20, 20], 40.0),
    ("frustum 25 12 30 capped", [25, 12], np.hypot(30, 13)),
    ("cone 15 30 capped", [15], np.hypot(30, 15)),
]


@pytest.mark.parametrize(("body", "radii", "seam"), RIMS)
def test_curved_rims_have_teeth_on_one_of_both_pieces(body, radii, seam):
    net = vp.development(parse_scene(f"CAN surface {body}"), tabs_mm=5)
    around = 2 * np.pi * np.array(radii)
    # A dash of 3 mm and a gap of 1.5.
    assert 1.5 * length(net, "mountain fold") == pytest.approx(around.sum() + seam, rel=0.04)
    # Of each tooth two slanting sides and what is between them, of the seam as well; and the other piece of each rim.
    teeth = np.ceil(around / 7.5)
    slant, narrower = 5 / np.sin(np.radians(60)), 10 / np.tan(np.radians(60))
    cut = around + teeth * (2 * slant - narrower) + around
    assert length(net, "cut") == pytest.approx(cut.sum() + 2 * seam + 2 * slant - narrower, rel=0.02)


def test_what_is_tiny_is_told_by_the_command(tmp_path):
    (tmp_path / "die.scene").write_text("DIE box 1 1 1", encoding="utf-8")
    ways = [["die.scene", "-o", "die.svg"], ["die.scene", "-o", "die.svg", "--unit", "cm"]]
    told = [
        CliRunner().invoke(develop, [str(tmp_path / way[0]), "-o", str(tmp_path / way[2]), *way[3:]]) for way in ways
    ]
    assert "is 4 x 3 mm: --unit cm or m" in told[0].output and not told[1].output


@pytest.mark.parametrize(
    ("shape", "at"),
    [
        (box((40, 30, 20)), (20, 0, 10)),
        (box((40, 30, 20)), (20, 15, 0)),
        (box((40, 30, 20)), (40, 10, 10)),
        (box((40, 30, 20)).moved(1e6, -1e6, 0), (1e6 + 20, -1e6, 10)),
        (Cylinder(10, 0, 30), (0, -10, 15)),
    ],
    ids=["front", "base", "side", "far away", "cylinder"],
)
@pytest.mark.parametrize("unit", ["mm", "cm"])
def test_labels_on_bodies_are_written_on_their_developments(shape, at, unit):
    scene = vp.Scene((vp.Item("body", shape),), labels=(vp.Label("L", at, size_mm=5), vp.Label("M", (9, 9, 1e3))))
    drawing = vp.development(scene, unit=unit)
    bare = vp.development(replace(scene, labels=()), unit=unit)
    (letters,) = [layer.strokes[0] for layer in drawing.layers if layer.name == "label"]
    points = letters.points
    one, corner, other = points
    long, short = sorted((one - corner, other - corner), key=np.linalg.norm, reverse=True)
    # As large as is asked for, whatever the unit, and not mirrored.
    assert np.linalg.norm([long, short], axis=1) == pytest.approx([5.0, 2.0 * 5.0 / 3.5])
    assert long[0] * short[1] < long[1] * short[0]
    assert (points > 10 - 5).all() and (points < np.array([drawing.width_mm, drawing.height_mm]) - 5).all()
    assert (drawing.width_mm, drawing.height_mm) == (bare.width_mm, bare.height_mm)


def test_formulas_are_plain_letters_on_developments():
    def letters(text):
        scene = vp.Scene((vp.Item("box", box((30, 20, 10))),), labels=(vp.Label(text, (15, 10, 10)),))
        return next(layer.strokes[0].points for layer in vp.development(scene).layers if layer.name == "label")

    assert np.array_equal(letters(r"$\sigma^2$"), letters("σ²"))
    with pytest.raises(vp.InputError, match=r"there are no strokes for \\sum"):
        letters(r"$\sum$")


def test_letters_stand_level_and_in_the_middle_of_what_they_name():
    scene = vp.Scene((vp.Item("can", Cylinder(10, 0, 30)),), labels=(vp.Label("I", (0, -10, 20), size_mm=5),))
    layers = {layer.name: layer.strokes[0].points for layer in vp.development(scene).layers}
    letter, side = layers["label"], layers["cut"]
    assert np.ptp(letter[:, 0]) == pytest.approx(0.0, abs=1e-6)
    assert np.ptp(letter[:, 1]) == pytest.approx(5.0)
    # Three quarters around from where u is 0, two thirds up; the piece may lie on its head.
    place = (letter.mean(axis=0) - side.min(axis=0)) / np.ptp(side, axis=0) - 0.5
    assert np.sign(place[0]) * place == pytest.approx([0.25, 1 / 6], abs=1e-3)
