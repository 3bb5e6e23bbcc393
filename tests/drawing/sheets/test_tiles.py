"""A large page on several sheets: together they have all of it, and crosses where they meet."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely
from click.testing import CliRunner
from support.sample_paths import polylines

import vectorplot as vp
from vectorplot.cli.commands.draw import draw
from vectorplot.drawing import tiled
from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.tiles import ARM_MM, MARGIN_MM
from vectorplot.errors import InputError
from vectorplot.geometry import polygons_of


def page(*lines, width=120.0, height=60.0, **more):
    return vp.Drawing(width, height, (vp.Layer("lines", vp.Pen(0.3, "#c00000"), (polylines(*lines, **more),)),))


def strokes_of(drawing, first=0):
    """The strokes of layers but the first ones, as shapely's."""
    return shapely.union_all(
        [
            shapely.LineString(part if not shut else np.vstack([part, part[:1]]))
            for layer in drawing.layers[first:]
            for paths in layer.strokes
            for part, shut in zip(
                np.split(paths.points, paths.offsets[1:-1]) if len(paths) else [], paths.closed, strict=True
            )
        ]
    )


def put_together(sheets, wide, high):
    """The strokes of all sheets where they belong on the page."""
    rows = len(sheets)
    return shapely.union_all(
        [
            shapely.transform(
                strokes_of(sheet, first=1),
                lambda p, row=row, column=column: p - MARGIN_MM + [column * wide, (rows - 1 - row) * high],
            )
            for row, line in enumerate(sheets)
            for column, sheet in enumerate(line)
        ]
    )


def test_a_line_is_cut_at_the_borders_of_the_parts_and_nowhere_else():
    sheets = tiled(page([(5, 10), (115, 10)]), 3, 2)
    assert [[len(sheet.layers[1].strokes[0]) for sheet in row] for row in sheets] == [[0, 0, 0], [1, 1, 1]]
    ends = [np.sort(sheet.layers[1].strokes[0].points[:, 0]).tolist() for sheet in sheets[1]]
    assert ends == [[15.0, 50.0], [10.0, 50.0], [10.0, 45.0]]
    assert {(sheet.width_mm, sheet.height_mm) for row in sheets for sheet in row} == {(60.0, 50.0)}


def test_crosses_stand_at_the_corners_of_the_part_by_the_pen_of_the_picture():
    for sheet in tiled(page([(5, 10), (115, 50)]), 2, 1)[0]:
        layer = sheet.layers[0]
        (paths,) = layer.strokes
        assert (layer.name, layer.pen.colour, len(paths)) == ("registration", "#c00000", 8)
        assert stroke_lengths(paths) == pytest.approx(2.0 * ARM_MM)
        middles = np.unique(paths.points.reshape(-1, 2, 2).mean(axis=1), axis=0)
        assert middles.tolist() == [[10.0, 10.0], [10.0, 70.0], [70.0, 10.0], [70.0, 70.0]]


@cache
def page_to_cut(curves):
    return vp.draw("data/mixed.scene", page="A3", curves=curves, hatch=vp.Hatching("tone", 2.0), frame=True)


@pytest.mark.spread
@pytest.mark.parametrize("curves", ["bezier", "polyline"])
@pytest.mark.parametrize(("columns", "rows"), [(2, 2), (3, 1), (1, 1)])
def test_sheets_together_are_the_page(columns, rows, curves):
    whole = page_to_cut(curves)
    sheets = tiled(whole, columns, rows)
    found = put_together(sheets, whole.width_mm / columns, whole.height_mm / rows)
    expected = strokes_of(whole)
    assert found.length == pytest.approx(expected.length, rel=1e-6)
    assert shapely.hausdorff_distance(found, expected) < 1e-6
    for sheet in (sheet for row in sheets for sheet in row):
        box = shapely.box(MARGIN_MM, MARGIN_MM, sheet.width_mm - MARGIN_MM, sheet.height_mm - MARGIN_MM)
        assert box.buffer(1e-9).covers(strokes_of(sheet, first=1))


def test_the_matrix_of_a_sheet_takes_points_of_the_world_to_it():
    whole = vp.draw("data/house.scene", page="A3")
    for sheet in (sheet for row in tiled(whole, 2, 2) for sheet in row):
        for paths in (paths for layer in sheet.layers[1:] for paths in layer.strokes):
            image = np.column_stack([paths.points3d, np.ones(len(paths.points))]) @ sheet.page_from_world.T
            assert image[:, :2] / image[:, 3:] == pytest.approx(paths.points, abs=1e-3)


@pytest.mark.slow
def test_filled_polygons_are_cut_and_cover_the_page_together():
    whole = vp.paint("data/cubes.scene", page="A5", lines="contour")
    sheets = tiled(whole, 2, 2)
    wide, high = whole.width_mm / 2, whole.height_mm / 2
    area = 0.0
    for sheet in (sheet for row in sheets for sheet in row):
        (fills,) = sheet.layers[1].fills
        inside = fills.points - MARGIN_MM
        assert inside.min() >= -1e-9 and (inside.max(axis=0) <= [wide + 1e-9, high + 1e-9]).all()
        area += shapely.area(polygons_of(fills.points.T, fills.offsets)).sum()
        image = np.column_stack([fills.points3d, np.ones(len(fills.points))]) @ sheet.page_from_world.T
        faces = np.repeat(fills.item >= 0, np.diff(fills.offsets))
        assert (image[:, :2] / image[:, 3:])[faces] == pytest.approx(fills.points[faces], abs=1e-6)
    (fills,) = whole.layers[0].fills
    assert area == pytest.approx(shapely.area(polygons_of(fills.points.T, fills.offsets)).sum(), rel=1e-9)


def test_lines_among_fills_and_shades_are_cut_where_they_are():
    points = np.array([(0.0, 30), (120, 30), (0, 0), (120, 0), (120, 60)])
    colours = np.array([(9, 9, 9)] * 2 + [(0, 0, 0), (120, 0, 0), (120, 0, 0)], dtype=np.uint8)
    none = np.array([-1, -1])
    fills = Fills(points, np.array([0, 2, 5]), colours, np.ones(2), none, np.zeros((5, 3)), none + 1)
    left, right = (
        sheet.layers[1].fills[0] for sheet in tiled(vp.Drawing(120, 60, (vp.Layer("a", vp.Pen(), (fills,)),)), 2, 1)[0]
    )
    assert np.diff(left.offsets).tolist() == [2, 3] and np.diff(right.offsets).tolist() == [2, 4]
    for fills, low in ((left, 0.0), (right, 60.0)):
        x = fills.points[fills.offsets[1] :, 0] - MARGIN_MM + low
        assert fills.colours[fills.offsets[1] :, 0].tolist() == np.rint(x).tolist()


@pytest.mark.slow
def test_real_texts_are_on_the_sheets_that_they_reach():
    whole = vp.draw("data/house.scene", page="A5", title="House", text="real")
    found = [[sum(map(len, sheet.layers[-1].texts)) for sheet in row] for row in tiled(whole, 2, 2)]
    assert found == [[0, 0], [1, 1]]


@pytest.mark.parametrize("wrong", [(0, 1), (1, -1), (51, 1), (1.5, 1)])
def test_numbers_that_are_none_are_one_sentence(wrong):
    with pytest.raises(InputError, match="expected whole numbers from 1 to 50"):
        tiled(page([(0, 0), (1, 1)]), *wrong)
    with pytest.raises(InputError, match="margin of -1 mm around tiles"):
        tiled(page([(0, 0), (1, 1)]), 2, 2, margin_mm=-1.0)


# The option of the command.


def test_the_command_writes_the_whole_and_its_parts(tmp_path):
    out = tmp_path / "house.svg"
    result = CliRunner().invoke(draw, ["data/house.scene", "--page", "A3", "--tiles", "2x3", "-o", str(out), "-q"])
    assert result.exit_code == 0, result.output
    names = [f"house-{row}-{column}.svg" for row in (1, 2, 3) for column in (1, 2)]
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(["house.svg", *names])
    assert 'viewBox="0 0 168.5 160"' in (tmp_path / names[0]).read_text("utf-8")


def test_each_format_is_that_of_the_whole(tmp_path):
    out = tmp_path / "house.drawing"
    words = ["data/house.scene", "--tiles", "1x2", "--format", "json", "-o", str(out), "-q"]
    assert CliRunner().invoke(draw, words).exit_code == 0
    assert all(file.read_bytes().startswith(b"{") for file in tmp_path.iterdir()) and len([*tmp_path.iterdir()]) == 3


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--tiles", "2"], "is not COLUMNSxROWS"),
        (["--tiles", "2x0"], "is not COLUMNSxROWS"),
        (["--tiles", "2x2", "-o", "-", "--format", "svg"], "OUT must be a file"),
        (["--tiles", "2x2", "-o", "folder/"], "--tiles is of one picture"),
    ],
)
def test_what_makes_no_tiles_is_one_line(words, told, tmp_path, monkeypatch):
    house = f"{vp.__path__[0]}/../data/house.scene"
    monkeypatch.chdir(tmp_path)
    given = words if "-o" in words else [*words, "-o", "house.svg"]
    result = CliRunner().invoke(draw, [house, *given])
    assert result.exit_code == 2 and told in result.stderr
    assert not [*tmp_path.iterdir()]
