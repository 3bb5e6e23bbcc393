"""Dimensions that keep clear of each other on sheets, their units and standards; threads, balloons, title blocks."""

from __future__ import annotations

import subprocess
from dataclasses import replace

import numpy as np
import pytest
from technical.test_technical_sheet import BRICK, layer, strokes_of

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.geometry import box
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.pictures.sheet_annotations import parts_of, written_on
from vectorplot.testing import assert_drawings_equal


def words_of(sheet):
    return [string for one in sheet.layers for real in one.texts for string in real.strings]


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, 0.5])
def test_dimension_lines_that_would_be_on_each_other_stand_side_by_side(factor):
    """Three of them at one height: the shortest stays, the others are 8 mm farther each, and those in a chain stay."""
    out = (0, 0, -10)
    notes = [vp.dimension((0, 0, 0), (end, 0, 0), out, gap=1, beyond=2) for end in (40, 30, 20)]
    chain = vp.chain_dimension([(0, 0, 10), (20, 0, 10), (40, 0, 10)], (0, 0, 9), gap=1)
    scale = {1.0: "1:1", 0.5: "1:2"}[factor]
    sheet = vp.technical_sheet([BRICK, *notes, chain], views="front", scale=scale)
    heights = {}
    for name, part in strokes_of(sheet, "label"):
        if name.startswith("dimension"):
            heights.setdefault(round(float(np.ptp(part[:, 0])) / factor), []).append(float(part[:, 1].mean()))
    low = min(heights[20])
    assert min(heights[30]) == pytest.approx(low - 8.0) and min(heights[40]) == pytest.approx(low - 16.0)
    above = sorted(y for own in heights.values() for y in own)[-2:]
    assert above[0] == pytest.approx(above[1])


@pytest.mark.slow
def test_letters_of_a_narrow_chain_are_on_no_others():
    points = [(x, 0, 10) for x in (0, 2, 4, 11, 13, 20, 40)]
    chain = vp.chain_dimension(points, (0, 0, 9), gap=1)
    sheet = vp.technical_sheet([BRICK, chain], views="front", scale="1:1", block=False, text="real")
    texts = tuple(replace(one, marks=one.texts) for one in sheet.layers)
    boxes = written_on(replace(sheet, layers=texts))
    one, other = np.triu_indices(len(boxes), 1)
    meet = ((boxes[one, 0] < boxes[other, 1]) & (boxes[one, 1] > boxes[other, 0])).all(axis=1)
    assert len(boxes) == 6 and not meet.any()


@pytest.mark.slow
def test_measures_of_a_running_dimension_have_room_for_letters():
    points = [(x, 0, 0) for x in (0, 1, 2, 30)]
    sheet = vp.technical_sheet([BRICK, vp.ordinate_dimension(points, (0, 0, -5))], views="front", scale="1:1")
    ends = sorted(float(part[:, 0].mean()) for name, part in strokes_of(sheet, "label") if name.endswith("measure"))
    assert np.diff(ends).min() == pytest.approx(6.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("told", "wanted"),
    [
        ({}, {"40 ±0.1", "20", "5:1", "mm"}),
        ({"unit": "in"}, {"1016 ±2.54", "508", "mm"}),
        ({"unit": "in", "measured_in": "in"}, {"40 ±0.1", "20", "in"}),
        ({"measured_in": "in", "decimals": 3, "standard": "asme"}, {"1.575 ±.004", ".787", "in"}),
        ({"decimals": 2, "zeros": True, "comma": True}, {"40,00 ±0,10", "20,00"}),
        ({"standard": "asme", "decimals": 1}, {"40 ±0.1", "20"}),
    ],
)
def test_all_measures_of_a_sheet_are_in_one_unit(told, wanted):
    own = vp.dimension((0, 0, 0), (40, 0, 0), (0, 0, -8), "<> ±<0.1>")
    sheet = vp.technical_sheet([BRICK, own], views="front,left", dimensions=True, text="real", **told)
    assert wanted <= set(words_of(sheet))


@pytest.mark.slow
def test_standards_have_their_projection_page_and_scales():
    iso, asme = (vp.technical_sheet(BRICK.scaled(3.0), views="front,top", standard=one) for one in ("iso", "asme"))
    assert (iso.width_mm, asme.width_mm) == (420.0, pytest.approx(431.8))
    large = [
        vp.technical_sheet(BRICK.scaled(0.9), page="A4", standard=one, views="front,top,left").title
        for one in ("iso", "asme")
    ]
    assert large == ["2:1", "4:1"]
    small = [vp.technical_sheet(BRICK.scaled(9.0), page="A4", standard=one).title for one in ("iso", "asme")]
    assert small == ["1:5", "1:4"]
    with pytest.raises(vp.InputError, match="standard 'din'"):
        vp.technical_sheet(BRICK, standard="din")


@pytest.mark.slow
def test_threads_are_thin_lines_along_them_and_three_quarters_of_a_circle():
    text = "B box 40 20 10 threaded_hole from 20 10 10 to 20 10 0 radius 4 thread from 0 5 5 to 9 5 5 radius 2"
    sheet = vp.technical_sheet(parse_scene(text), views="front,top,left", section="y=10", scale="1:1")
    every = [*strokes_of(sheet, "label"), *strokes_of(sheet, "hidden")]
    named = [(name, part) for name, part in every if "thread" in name]
    arc = next(part for name, part in named if name == "threaded hole arc" and np.ptp(part[:, 1]) > 4)
    steps = np.hypot(*np.diff(arc, axis=0).T).sum()
    assert steps == pytest.approx(1.5 * np.pi * 4, rel=1e-3)
    long = [part for name, part in strokes_of(sheet, "label") if name.startswith("thread line")]
    assert len(long) == 4 and all(np.ptp(part, axis=0).max() == pytest.approx(9.0) for part in long)
    # Hidden in the views from the side, and drawn where the section goes through the axis.
    assert any(name.startswith("threaded hole line") for name, _ in strokes_of(sheet, "hidden"))
    shown = [part for name, part in strokes_of(sheet, "label") if name.startswith("threaded hole line")]
    assert len(shown) == 2 and abs(shown[0][0, 0] - shown[1][0, 0]) == pytest.approx(8.0)


def assembly():
    items = [vp.Item(f"leg_{k}", box((2, 2, 20)).moved(*at, 0)) for k, at in enumerate(((0, 0), (38, 0)), start=1)]
    screw = (vp.Item("head", box((4, 4, 2)), group="screw"), vp.Item("shank", box((2, 2, 6)), group="screw"))
    return [*items, vp.Item("top", box((40, 20, 4)).moved(0, 0, 20)), *(one.moved(10, 8, 26) for one in screw)]


def test_parts_are_counted_by_their_names_and_groups():
    scene = vp.Scene(tuple(assembly()))
    assert [(part.name, len(part.pieces)) for part in parts_of(scene)] == [("leg", 2), ("top", 1), ("screw", 1)]
    assert [(one.title, len(one)) for one in vp.part_scenes(scene)] == [("leg", 1), ("top", 1), ("screw", 2)]
    other = vp.Scene((*scene.items, vp.Item("leg_3", box((2, 2, 19)))))
    assert [part.name for part in parts_of(other)] == ["leg", "top", "screw", "leg_3"]


@pytest.mark.slow
def test_balloons_have_lines_that_end_on_their_parts_and_cross_nowhere():
    sheet = vp.technical_sheet(assembly(), balloons=True, parts_list=True, text="real")
    words = words_of(sheet)
    assert {"ITEM", "QTY", "NAME", "leg", "top", "screw", "2"} <= set(words)
    lines = np.array([part for _, part in strokes_of(sheet, "thin") if len(part) == 2 and np.ptp(part) > 3.0])
    lines = lines[np.hypot(*(lines[:, 1] - lines[:, 0]).T) > 4.0]
    assert len(lines) >= 3
    edges = np.concatenate([part for _, part in strokes_of(sheet, "contour")])
    rings = [part for _, part in strokes_of(sheet, "thin") if len(part) == 64]
    assert len(rings) == 3 and all(np.ptp(ring, axis=0) == pytest.approx([10.0, 10.0], rel=1e-2) for ring in rings)
    assert all(np.hypot(*(edges - ring.mean(axis=0)).T).min() > 5.0 for ring in rings)
    plain = vp.technical_sheet(assembly())
    assert layer(plain, "thin") is None or len(strokes_of(plain, "thin")) < len(strokes_of(sheet, "thin"))


def test_free_fields_have_rows_of_their_own_or_stand_where_the_template_says(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text(
        "width = 120\nsymbol = 0.25\nsymbol_rows = 1\n[[row]]\nheight = 10\nletters = 4\n"
        'cells = [{name = "Part", text = "{title} of {material}"}]\n'
        "[[row]]\nheight = 8\n"
        'cells = [{name = "M", text = "{scale} {unit}", share = 2}, {name = "D", text = "{who}"}]\n'
    )
    fields = {"Material": "S235", "Finish": "zinc"}
    usual = vp.technical_sheet(BRICK, title="Brick", fields=fields, text="real", views="front")
    own = vp.technical_sheet(BRICK, title="Brick", fields=fields, text="real", views="front", block_template=path)
    assert {"MATERIAL", "S235", "FINISH", "zinc", "TITLE", "Brick"} <= set(words_of(usual))
    told = set(words_of(own))
    assert {"Part", "Brick of S235", "FINISH", "zinc", "M"} <= told and not {"TITLE", "MATERIAL"} & told
    frame = np.concatenate([part for _, part in strokes_of(own, "frame")])
    assert np.ptp(frame, axis=0) == pytest.approx([120.0, 27.0])


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("width = 100", "there is no 'row'"),
        ("[[row]]\nheight = 10", "there is no 'cells'"),
        ('[[row]]\nheight = 0\ncells = [{name = "A"}]', "positive heights"),
        ("[[row", "block.toml:1"),
        ('[[row]]\nheight = "x"\ncells = []', r"\[\[row\]\]"),
    ],
)
def test_templates_that_are_none(text, cause, tmp_path):
    path = tmp_path / "block.toml"
    path.write_text(text)
    with pytest.raises(vp.InputError, match=cause):
        vp.technical_sheet(BRICK, block_template=path)


@pytest.mark.slow
def test_letters_of_sheets_are_real_where_asked_for(tmp_path):
    sheet = vp.technical_sheet(BRICK, views="front", section="y=10", frame=True, title="Brick", text="real")
    assert {"A-A", "A", "Brick", "SCALE", "1"} <= set(words_of(sheet))
    (tmp_path / "b.scene").write_text("B box 40 20 10")
    out = tmp_path / "b.pdf"
    assert run(["sheet", str(tmp_path / "b.scene"), "-o", str(out), "--text", "real", "--title", "Brick", "-q"]) == 0
    told = subprocess.run(["pdftotext", str(out), "-"], capture_output=True, text=True, check=True).stdout
    assert "Brick" in told
    assert run(["sheet", str(tmp_path / "b.scene"), "-o", str(out), "--text", "latex", "--title", "Brick", "-q"]) == 0
    assert "Brick" in (tmp_path / "b.tex").read_text()
    assert run(["sheet", str(tmp_path / "b.scene"), "-o", str(tmp_path / "b.svg"), "--text", "latex"]) == 2


@pytest.mark.slow
def test_a_sheet_of_each_part_follows_that_of_the_whole(tmp_path, capsys):
    scene = tmp_path / "a.scene"
    scene.write_text("LEG_1 box 2 2 20 LEG_2 box 2 2 20 translation 38 0 0 TOP box 40 20 4 translation 0 0 20")
    out = tmp_path / "a.pdf"
    asked = ["sheet", str(scene), "-o", str(out), "--each-part", "--parts-list", "--text", "real", "-q"]
    assert run([*asked, "--explode", "TOP=0,0,30"]) == 0
    pages = subprocess.run(["pdftotext", "-layout", str(out), "-"], capture_output=True, text=True, check=True).stdout
    first, leg, top, _ = pages.split("\f")
    assert "1/3" in first and "QTY" in first
    assert "2/3" in leg and "LEG" in leg and "QTY" not in leg and "TOP" in top
    assert run(["sheet", str(scene), "-o", str(tmp_path / "a.svg"), "--each-part"]) == 2
    assert "the sheets of parts become the pages of a PDF" in capsys.readouterr().err
    assert run(["sheet", str(scene), "-o", str(out), "--field", "MATERIAL"]) == 2
    assert "expected NAME=TEXT" in capsys.readouterr().err
    assert run(["sheet", str(scene), "-o", str(out), "--explode", "z", "--explode", "TOP=0,0,1"]) == 2


SHEET = """PART gray box 40 20 10
sheet views front, top scale 2:1 page A4 section "x=20" dimensions frame no_block author "V. Plot"
  field "MATERIAL" "S235" interrupted "x=25..35" standard asme measured_in mm"""


def test_what_a_scene_says_of_its_sheet_is_what_the_arguments_say():
    scene = parse_scene(SHEET)
    told = {"views": "front,top", "scale": "2:1", "page": "A4", "section": "x=20", "dimensions": True, "frame": True}
    told |= {"block": False, "interrupted": ["x=25..35"], "standard": "asme"}
    plain = parse_scene(SHEET.splitlines()[0])
    assert_drawings_equal(vp.technical_sheet(scene), vp.technical_sheet(plain, **told))
    # What is asked for goes before what the scene says.
    other = vp.technical_sheet(scene, section=(), frame=False, scale="1:1")
    assert_drawings_equal(other, vp.technical_sheet(plain, **{**told, "section": (), "frame": False, "scale": "1:1"}))
    assert parse_scene(write_scene(scene)).sheet == scene.sheet
    assert scene.sheet.said["fields"] == (("MATERIAL", "S235"),)


@pytest.mark.slow
def test_hidden_lines_of_sheets_are_dashed_or_left_out(tmp_path):
    text = "PART translation base_points 0 0 0, 40 0 0, 40 20 0, 0 20 0 trans_vector 0 0 10 bore 20 10 0 4"
    (dashed, none), said = (
        [vp.technical_sheet(parse_scene(text), views="front", hidden=word) for word in (None, "none")],
        vp.technical_sheet(parse_scene(f"{text}\nsheet hidden none"), views="front"),
    )
    assert "hidden" in {layer.name for layer in dashed.layers if layer.strokes}
    assert "hidden" not in {layer.name for layer in none.layers if layer.strokes}
    assert_drawings_equal(none, said)
    (tmp_path / "a.scene").write_text(text)
    assert run(["sheet", str(tmp_path / "a.scene"), "-o", str(tmp_path / "a.svg"), "--hidden", "none"]) == 0
    assert "hidden" not in (tmp_path / "a.svg").read_text(encoding="utf-8")
    with pytest.raises(vp.InputError, match="hidden"):
        vp.technical_sheet(parse_scene(text), hidden="dotted")


def test_fields_of_the_command_are_beside_those_of_the_scene(tmp_path):
    path = tmp_path / "part.scene"
    path.write_text('PART box 4 2 1\nsheet field "MATERIAL" "S235" field "MASS" "1 kg"', encoding="utf-8")
    out = tmp_path / "part.svg"
    assert run(["sheet", str(path), "-o", str(out), "--field", "MASS=2 kg", "--text", "real"]) == 0
    written = out.read_text(encoding="utf-8")
    assert "S235" in written and "2 kg" in written and "1 kg" not in written


@pytest.mark.parametrize(
    ("said", "cause"),
    [
        ("sheet", "expected one of dimensions"),
        ("sheet scale 1to2", "scale '1to2'"),
        ("sheet page A99", "sheet: "),
        ("sheet section y=2", "expected a text in quotes"),
        ("sheet frame frame", "a second 'frame'"),
        ("sheet views front, frnt", "expected one of front"),
        ("sheet unit km", "sheet: unit: expected one of mm, cm, m, in"),
        ('sheet block_template "a.toml"', "names no files"),
        ("sheet frame dimension", "unknown word 'dimension'|dimension: "),
    ],
)
def test_sheets_of_scenes_that_cannot_be(said, cause):
    with pytest.raises(vp.InputError, match=cause):
        parse_scene(f"PART box 4 2 1\n{said}")


def test_materials_are_a_column_of_the_list_and_a_field_of_each_part(tmp_path):
    text = 'A box 4 2 1\nB box 1 1 1 translation 0 0 1\nsheet views iso parts_list made_of "A" "S235"'
    sheet = vp.technical_sheet(parse_scene(text), made_of={"B": "brass"}, text="real")
    assert {"MATERIAL", "S235", "brass"} <= set(words_of(sheet))
    assert "MATERIAL" not in words_of(vp.technical_sheet(parse_scene(text.partition("made_of")[0]), text="real"))
    with pytest.raises(vp.InputError, match="made of: part 'C': expected one of A, B"):
        vp.technical_sheet(parse_scene(text), made_of={"C": "gold"})
    (tmp_path / "two.scene").write_text(text, encoding="utf-8")
    out = tmp_path / "two.pdf"
    assert run(["sheet", str(tmp_path / "two.scene"), "-o", str(out), "--each-part", "--text", "real"]) == 0
    pages = [
        subprocess.run(["pdftotext", "-f", page, "-l", page, str(out), "-"], capture_output=True, check=True).stdout
        for page in "23"
    ]
    assert b"S235" in pages[0] and b"S235" not in pages[1]


@pytest.mark.slow
def test_parts_that_a_view_does_not_show_have_no_balloon_and_are_told():
    parts = parse_scene("CASE box 20 20 20\nCORE red box 4 4 4 translation 8 8 8\nLID box 20 20 2 translation 0 0 20")
    with pytest.warns(vp.InputWarning, match="CORE: no balloon, for nothing is seen in that view; --explode"):
        sheet = vp.technical_sheet(parts, views="iso", balloons=True, parts_list=True, text="real")
    assert "CORE" in words_of(sheet) and {"1", "3"} <= set(words_of(sheet))


@pytest.mark.parametrize("axis", [0, 2])
def test_dimensions_of_the_whole_begin_where_the_part_ends(axis):
    """A hub of 10 on a plate of 40, its foot above the lowest end of a pin: no line begins in the air."""
    part = [box((40, 20, 4)), box((10, 10, 20)).moved(15, 5, 4), box((2, 2, 6)).moved(19, 9, -6)]
    sheet = vp.technical_sheet(part, views="front", scale="1:1", dimensions=True)
    whole = np.concatenate([points for _, points in strokes_of(sheet, "contour")])
    (left, low), (right, top) = whole.min(axis=0), whole.max(axis=0)
    wanted = f"extension {(40, 0, 30)[axis]}"
    ends = [points.tolist() for name, points in strokes_of(sheet, "label") if name.startswith(wanted)]
    begins = sorted(max(points, key=lambda point: point[1 if axis == 0 else 0]) for points in ends)
    expected = [(left, low + 5.0), (right, low + 5.0)] if axis == 0 else [(left + 14.0, top), (left + 18.0, low)]
    assert np.allclose(begins, expected)


def test_dimensions_of_parts_that_are_moved_apart_leave_traces_out():
    """A pin of 30 that is moved out of its plate by 40: the trace begins at its foot, 8 below the plate."""
    scene = vp.Scene((vp.Item("plate", box((40, 20, 10))), vp.Item("pin", box((4, 4, 30)).moved(18, 8, -8))))
    sheet = vp.technical_sheet(vp.exploded(scene, {"pin": (0, 0, 40)}), views="front", dimensions=True, text="real")
    strings = [string for layer in sheet.layers for texts in layer.texts for string in texts.strings]
    assert "62" in strings and "40" in strings
