"""Technical sheets: views in line, exact scales, what stands around them; measured by a real reader."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from itertools import chain

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.cli.verbs import vectorplot
from vectorplot.drawing.drawing import CurvedStrokes
from vectorplot.geometry import box, prism, regular_polygon
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.sheet_annotations import round_edges
from vectorplot.testing import assert_drawings_equal

BRICK = vp.Item("brick", box((40, 20, 10)))


def layer(drawing, name):
    return next((layer for layer in drawing.layers if layer.name == name), None)


def strokes_of(drawing, name):
    """The polylines of a layer, each with the name of its item."""
    found = []
    for paths in layer(drawing, name).strokes:
        parts = np.split(paths.points, paths.offsets[1:-1])[: len(paths)]
        found += [
            (drawing.items[k] if k >= 0 else "", part) for k, part in zip(paths.item.tolist(), parts, strict=True)
        ]
    return found


def outlines(drawing):
    """(k,2,2) the bounds of the contours that hang together, from left to right."""
    boxes = np.array([(points.min(axis=0), points.max(axis=0)) for _, points in strokes_of(drawing, "contour")])
    return boxes[np.argsort(boxes[:, 0, 0])]


@pytest.mark.parametrize(("projection", "way"), [("first", -1), ("third", 1)])
def test_views_stand_in_line_at_the_scale(projection, way):
    sheet = vp.technical_sheet(BRICK, views="front,top,left", scale="2:1", projection=projection)
    boxes = {tuple(np.round(np.ptp(one, axis=0), 6).tolist()): one for one in outlines(sheet)}
    front, top, left = boxes[80.0, 20.0], boxes[80.0, 40.0], boxes[40.0, 20.0]
    assert np.allclose(front[:, 0], top[:, 0]) and np.allclose(front[:, 1], left[:, 1])
    assert np.sign(top[0, 1] - front[0, 1]) == way and np.sign(left[0, 0] - front[0, 0]) == -way


def test_a_cube_of_a_centimetre_measures_one_in_the_pdf(tmp_path):
    """Poppler at 508 dpi: 20 pixels a millimetre, one of them for rounding."""
    sheet = vp.technical_sheet(vp.Item("cube", box((10, 10, 10))), views="front", scale="1:1", page="A5")
    (outline,) = outlines(sheet)
    assert np.ptp(outline, axis=0).tolist() == [10.0, 10.0]
    vp.save(sheet, tmp_path / "cube.pdf")
    corner = [int(20 * (outline[0, 0] - 5)), int(20 * (sheet.height_mm - outline[1, 1] - 5))]
    places = chain.from_iterable(zip("-x -y -W -H".split(), map(str, [*corner, 400, 400]), strict=True))
    command = ["pdftoppm", "-r", "508", "-gray", *places, str(tmp_path / "cube.pdf"), str(tmp_path / "cube")]
    subprocess.run(command, check=True)
    header, pixels = (tmp_path / "cube-1.pgm").read_bytes().split(b"255\n", 1)
    dark = np.frombuffer(pixels, dtype=np.uint8).reshape(400, 400) < 128
    for along in (dark.any(axis=0), dark.any(axis=1)):
        places = np.flatnonzero(along)
        # The pen of 0.5 mm stands half outside.
        assert abs(np.ptp(places) + 1 - 20 * 10.5) <= 1, header


def test_scales_fit_or_say_which_would():
    assert vp.technical_sheet(BRICK, page="A4").title == "2:1"
    assert vp.technical_sheet(BRICK.scaled(1e-3), page="A4").title == "2000:1"
    with pytest.raises(vp.InputError, match=r"scale 5:1: too large for 4 views on .* that fits is 2:1"):
        vp.technical_sheet(BRICK, scale="5:1")
    with pytest.raises(vp.InputError, match="no room"):
        vp.technical_sheet(BRICK, page="50x50")
    with pytest.raises(vp.InputError, match="did you mean 'front'"):
        vp.technical_sheet(BRICK, views="frnt")
    with pytest.raises(vp.InputError, match="each once"):
        vp.technical_sheet(BRICK, views="top,top")


@pytest.mark.slow
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_dimensions_of_the_whole_are_three_and_mm_on_paper(size):
    moved = BRICK.moved(30, 1, 7).scaled(size)
    plain, told = (vp.technical_sheet(moved, dimensions=given) for given in (False, True))
    lines = [points for name, points in strokes_of(told, "label") if name.startswith("dimension")]
    factor = float(told.title.split(":")[0]) / float(told.title.split(":")[1])
    lengths = sorted(float(np.hypot(*np.ptp(points, axis=0))) for points in lines)
    assert np.allclose(lengths, factor * size * np.array([10.0, 20.0, 40.0]))
    beside = [points for name, points in strokes_of(told, "label") if name.startswith("extension")]
    assert np.allclose([np.hypot(*np.ptp(points, axis=0)) for points in beside], 11.0)
    assert len(outlines(told)) == len(outlines(plain))


def test_a_scenes_own_dimensions_are_in_the_view_that_is_square_to_them():
    along_x = vp.dimension((0, 0, 0), (40, 0, 0), (0, 0, -8), gap=1, beyond=2)
    without, only = (
        vp.technical_sheet([BRICK, *added], views="top,front,left", scale="1:1") for added in ((), (along_x,))
    )
    names = set(only.items) - set(without.items)
    found = [points for name, points in strokes_of(only, "label") if name in names]
    lengths = sorted(float(np.abs(np.ptp(points, axis=0)).sum()) for points in found)
    assert np.allclose(lengths, [9.0, 9.0, 40.0])


def test_nothing_hides_dimensions_and_leaders_of_a_view():
    behind, leader = vp.dimension((0, 20, 0), (40, 20, 0), (0, 0, 5)), vp.leader((20, 10, 5), (50, 10, 9), "1")
    sheet = vp.technical_sheet([BRICK, behind, leader], views="front", scale="1:1")
    assert layer(sheet, "hidden") is None
    lengths = [np.hypot(*np.ptp(part, axis=0)) for name, part in strokes_of(sheet, "label") if name[:6] == "leader"]
    assert lengths == pytest.approx([np.hypot(30, 4)])


def test_radii_and_diameters_are_where_their_circle_is_one():
    holes = [regular_polygon(24, 4, centre=(x, 10, 0)) for x in (8, 30)]
    plate = prism([(0, 0, 0), (40, 0, 0), (40, 20, 0), (0, 20, 0)], (0, 0, 4), holes=holes)
    notes = [
        vp.diameter((8, 10, 4), (12, 10, 4)),
        vp.radius((30, 10, 0), (34, 10, 0)),
        vp.diameter((9, 0, 2), (12, 0, 2)),
    ]
    sheet = vp.technical_sheet([vp.Item("plate", plate), *notes], views="front,top", scale="1:1")
    boxes = [(box[:, 1].mean(), np.ptp(box[:, 1])) for box in outlines(sheet)]
    front, top = (next(y for y, high in boxes if high == pytest.approx(wanted)) for wanted in (4.0, 20.0))
    height = {name: float(part[:, 1].mean()) for name, part in strokes_of(sheet, "label") if name}
    assert height == pytest.approx({"diameter ø8": top, "radius R4": top, "diameter ø6": front})


def test_what_is_square_to_no_view_is_told_but_leaders_are_shown():
    leader = vp.leader((40, 20, 10), (60, 35, 19), "2")
    notes = [vp.dimension((0, 0, 0), (0, 20, 0), (-8, 0, 0)), vp.centre_line((20, 10, -3), (20, 10, 13)), leader]
    with pytest.warns(vp.InputWarning, match="^square to no view and not shown: dimension 20$"):
        sheet = vp.technical_sheet([BRICK, *notes], views="front,left", scale="1:1")
    names = [name for name, _ in strokes_of(sheet, "label")]
    assert names.count("leader 2") == 1 and "dimension 20" not in names


def test_without_a_title_block_views_have_the_whole_page(tmp_path):
    asked = {"views": "front,top", "page": "100x74", "scale": "1:1"}
    with pytest.raises(vp.InputError, match=r"no room for 2 views above the title block$"):
        vp.technical_sheet(BRICK, **asked)
    figure = vp.technical_sheet(BRICK, block=False, **asked)
    assert [one.name for one in figure.layers if one.marks] == ["contour"]
    assert outlines(figure)[:, 0, 1].min() < 20.0
    (tmp_path / "b.scene").write_text("brick gray box solid 40 20 10")
    told = ["--views", "front,top", "--page", "100x74", "--scale", "1:1", "--no-block", "-q"]
    assert run(["sheet", str(tmp_path / "b.scene"), "-o", str(tmp_path / "b.svg"), *told]) == 0
    vp.save(figure, tmp_path / "figure.svg")
    assert (tmp_path / "b.svg").read_text() == (tmp_path / "figure.svg").read_text()


@pytest.mark.parametrize("words", [["--page", "A3", "--landscape"], ["--page", "A3 landscape"]])
def test_sheets_lie_on_the_side_that_is_asked_for(words, tmp_path):
    (tmp_path / "b.scene").write_text("brick gray box solid 40 20 400")
    out = tmp_path / "b.json"
    assert run(["sheet", str(tmp_path / "b.scene"), "-o", str(out), *words]) == 0
    assert '"page_mm": [420.0, 297.0]' in out.read_text().replace("\n", " ")


def test_measures_are_in_mm_whatever_the_unit_of_the_part_is():
    small = BRICK.scaled(0.1)
    asked = {"views": "front,left", "scale": "1:1", "dimensions": True}
    assert_drawings_equal(vp.technical_sheet(small, unit="cm", **asked), vp.technical_sheet(BRICK, **asked))
    with pytest.raises(vp.InputError, match="unit 'km'"):
        vp.technical_sheet(BRICK, unit="km")


def test_the_name_of_a_mesh_file_is_its_title_unless_it_has_one(tmp_path):
    path = tmp_path / "lid.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    asked = ["--views", "front", "--page", "A5", "--unit", "in", "-q"]
    for more, title in (([], "lid"), (["--title", "Cover"], "Cover")):
        assert run(["sheet", str(path), "-o", str(tmp_path / "lid.svg"), *asked, *more]) == 0
        assert f"<title>{title}, 2:1</title>" in (tmp_path / "lid.svg").read_text()


@pytest.mark.slow
def test_a_frame_has_zones_and_the_block_its_words(tmp_path):
    plain, framed = (
        vp.technical_sheet(BRICK, frame=frame, title="Brick", projection="third") for frame in (False, True)
    )
    assert layer(framed, "rules").strokes[0].points.min() == 5.0
    assert layer(plain, "frame").strokes[0].points[:, 0].max() == plain.width_mm - 10.0
    with pytest.raises(vp.InputError, match="margin"):
        vp.technical_sheet(BRICK, frame=True, page=vp.Page(420, 297, 4))
    with pytest.raises(vp.InputError, match="no room for"):
        vp.technical_sheet(BRICK, title="W" * 200)
    with pytest.raises(vp.InputError, match="title block"):
        vp.technical_sheet(BRICK, title="\u4e00")


@pytest.mark.slow
def test_a_scene_has_its_title_in_the_block_unless_another_is_asked_for_or_it_has_no_room():
    scene = vp.Scene((BRICK,), title="Brick of a wall")
    titled, other, none = vp.technical_sheet(scene), vp.technical_sheet(scene, title="Stone"), vp.technical_sheet(BRICK)
    assert (titled.title, other.title, none.title) == ("Brick of a wall, 2:1", "Stone, 2:1", "2:1")
    assert_drawings_equal(titled, vp.technical_sheet(BRICK, title=scene.title))
    for title in ("W" * 200, "\u4e00"):
        untitled = vp.technical_sheet(replace(scene, title=title))
        assert untitled.title == f"{title}, 2:1"
        assert_drawings_equal(replace(untitled, title=none.title), none)


@pytest.mark.parametrize("suffix", ["svg", "ps", "pdf", "dxf", "tex", "png"])
def test_the_command_writes_every_format(suffix, tmp_path):
    scene = tmp_path / "brick.scene"
    scene.write_text("BRICK gray box solid 40 20 10\n")
    asked = ["--scale", "1:1", "--views", "front", "--page", "A5", "--frame", "--dimensions"]
    vectorplot(["sheet", str(scene), "-o", str(tmp_path / f"s.{suffix}"), *asked], standalone_mode=False)
    assert (tmp_path / f"s.{suffix}").stat().st_size > 1000


def test_short_hidden_lines_show_a_gap():
    """Two sides of a pin behind a plate, 4 mm on the page: each is two dashes with a gap of 1 mm."""
    items = [vp.Item("plate", box((80, 10, 8))), vp.Item("pin", box((10, 10, 8)).moved(30, 10, 0))]
    sheet = vp.technical_sheet(items, views="front", scale="1:2", page="A4")
    upright = [points for _, points in strokes_of(sheet, "hidden") if np.ptp(points[:, 0]) < 1e-9]
    assert [float(np.ptp(points[:, 1])) for points in upright] == pytest.approx([1.5] * 4)


def test_a_section_has_its_line_its_letters_and_its_hatches():
    sheet = vp.technical_sheet(BRICK, views="front,top", section="y=12", scale="1:1")
    *views, seen = outlines(sheet)
    assert np.allclose(np.ptp(seen, axis=0), (40, 10))
    hatches = np.concatenate([points for _, points in strokes_of(sheet, "hatch")]).reshape(-1, 2, 2)
    ways = np.diff(hatches, axis=1)[:, 0]
    assert len(ways) > 10 and np.allclose(np.abs(ways[:, 0]), np.abs(ways[:, 1]))
    assert (hatches >= seen[0] - 1e-6).all() and (hatches <= seen[1] + 1e-6).all()
    front, top = sorted(views, key=lambda one: float(one[1, 1] - one[0, 1]))
    line = np.concatenate([points for _, points in strokes_of(sheet, "cutting line")])
    # 12 from the front side, which is below in the view from above.
    assert np.allclose(line[:, 1], top[0, 1] + 12.0)
    assert line[:, 0].min() < top[0, 0] and line[:, 0].max() > top[1, 0]
    assert np.allclose(seen[:, 1], front[:, 1])


@pytest.mark.parametrize(
    ("section", "cause"),
    [("y=99", "beside the part, where y is 0 to 20"), ("w=1", "expected x, y or z"), ("y", "such as")],
)
def test_sections_that_are_none(section, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.technical_sheet(BRICK, section=section)


@pytest.mark.slow
@pytest.mark.parametrize("projection", ["first", "third"])
def test_sections_of_every_axis_stand_apart_from_all_views(projection):
    sheet = vp.technical_sheet(
        BRICK, section=["x=20", "y=10", "z=5"], projection=projection, dimensions=True, frame=True
    )
    names = {layer.name: layer for layer in sheet.layers}
    assert {"cutting line", "cutting ends", "hatch"} <= set(names)
    assert sum(len(paths) for paths in names["cutting ends"].strokes) == 6
    points = np.concatenate([points for name in ("hatch", "contour") for _, points in strokes_of(sheet, name)])
    assert (points > 20).all() and (points < (400, 287)).all()


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e5])
def test_round_edges_of_a_mesh_get_their_centre_lines(size):
    """A shaft along x: two circles on one axis, one centre line and one mark."""
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rings = [np.column_stack([np.full(24, x), 5 + r * np.cos(turn), 5 + r * np.sin(turn)]) for x, r in ((0, 3), (9, 3))]
    faces = [(k, (k + 1) % 24, 24 + (k + 1) % 24, 24 + k) for k in range(24)]
    shaft = vp.Mesh.from_polygons(np.concatenate(rings) * size, [*faces, range(23, -1, -1), range(24, 48)])
    edges = round_edges(shaft, 25.0)
    assert [edge.axis for edge in edges] == [0, 0] and np.allclose([edge.radius for edge in edges], 3 * size)
    assert not round_edges(box((1, 2, 3)), 25.0)
    sheet = vp.technical_sheet(shaft, centre_lines=True, views="front,top,left")
    lines = {name for name, _ in strokes_of(sheet, "centre")}
    assert lines == {"centre line", "centre mark", "centre mark 2"}


def test_several_parts_become_the_pages_of_one_pdf(tmp_path, capsys):
    parts = [tmp_path / f"{name}.scene" for name in "ab"]
    for path, length in zip(parts, (40, 20), strict=True):
        path.write_text(f"PART{length} red box solid {length} 20 10")
    out = tmp_path / "all.pdf"
    asked = ["--views", "front", "--page", "A5", "--scale", "1:1"]
    assert run(["sheet", *map(str, parts), "-o", str(out), *asked, "-q"]) == 0
    told = subprocess.run(["pdfinfo", str(out)], capture_output=True, text=True, check=True).stdout
    assert "Pages:           2" in told
    pages = [
        vp.technical_sheet(path, views="front", page="A5", scale="1:1", sheet=f"{n}/2")
        for n, path in enumerate(parts, 1)
    ]
    vp.save(pages, tmp_path / "python.pdf")
    assert out.read_bytes() == (tmp_path / "python.pdf").read_bytes()
    assert [np.ptp(outlines(page)[0], axis=0)[0] for page in pages] == pytest.approx([40.0, 20.0])
    assert run(["sheet", *map(str, parts), "-o", str(tmp_path / "all.svg")]) == 2
    assert "OUT must end in .pdf" in capsys.readouterr().err
    assert run(["sheet", *map(str, parts), "-o", str(tmp_path / "big.pdf"), "--scale", "20:1"]) == 1
    assert f"{parts[0]}: " in capsys.readouterr().err
    assert not (tmp_path / "big.pdf").exists()
    for several, name in (([], "none.pdf"), (pages, "all.svg")):
        with pytest.raises(vp.InputError, match="are the pages"):
            vp.save(several, tmp_path / name)


def test_parts_with_y_upwards_stand():
    """Front and back 40 wide and 20 high, from the left 10 wide."""
    sheet = vp.technical_sheet(BRICK, views="front,left", scale="1:1", up=(0, 1, 0))
    assert {tuple(np.round(np.ptp(one, axis=0), 6).tolist()) for one in outlines(sheet)} == {(40, 20), (10, 20)}


@pytest.mark.slow
def test_what_places_itself_leaves_what_the_user_has_written():
    """Dimensions of the whole stand outside of others; marks of sections keep clear of labels and numbers."""
    told = ['dimension "20 ±0,1" from 0 0 0 to 0 0 20 offset -10 0 0 gap 1 beyond 2']
    told += ["dimension from 0 0 0 to 80 0 0 offset 0 0 -8 gap 1 beyond 2", 'label P "Plan (1)" at 40 25 30']
    scene = parse_scene("\n".join(["B gray box 80 50 30", *told]))
    sheet = vp.technical_sheet(scene, dimensions=True, section="x=40", page="A4")
    lines = [(name, points) for name, points in strokes_of(sheet, "label") if name.startswith("dimension")]
    upright = {name: points[:, 0].min() for name, points in lines if np.ptp(points[:, 0]) < 1e-6}
    (own,) = (x for name, x in upright.items() if name.startswith("dimension 20"))
    assert upright["dimension 30"] == pytest.approx(own - 11.0)
    level = sorted(points[:, 1].min() for name, points in lines if name.startswith("dimension 80"))
    assert level[1] - level[0] > 10.0
    boxes = np.array(
        [(points.min(axis=0), points.max(axis=0)) for name, points in strokes_of(sheet, "label") if not name]
    )
    line = np.concatenate([np.linspace(*points[[0, -1]], 50) for _, points in strokes_of(sheet, "cutting line")])
    assert not ((line[:, None] > boxes[:, 0]) & (line[:, None] < boxes[:, 1])).all(axis=2).any()
    large = np.ptp(boxes[:, :, 1], axis=1) > 4.9
    marks, letters = boxes[large], boxes[~large & (np.ptp(boxes[:, :, 1], axis=1) > 2.0)]
    meet = (marks[:, None, 0] < letters[:, 1]) & (marks[:, None, 1] > letters[:, 0])
    assert len(marks) >= 4 and len(letters) > 20 and not meet.all(axis=2).any()


def test_circles_of_meshes_are_arcs_on_sheets_that_ask_for_them():
    plate = prism(regular_polygon(48, 15.0), (0, 0, 4))
    told = {"views": "top", "scale": "1:1"}
    radii = []
    for curves in ("bezier", "arcs"):
        marks = layer(vp.technical_sheet(plate, **told, curves=curves), "contour").marks
        arcs = [arc for mark in marks if isinstance(mark, CurvedStrokes) for arc in mark.arcs.first]
        radii.append([float(np.hypot(*arc).round(3)) for arc in arcs])
    assert radii == [[], [15.0]]
    with pytest.raises(vp.InputError, match="curves"):
        vp.technical_sheet(plate, **told, curves="splines")
