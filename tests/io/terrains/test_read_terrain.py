"""Files of heights: grids and points, holes, and what is said of those that are wrong."""

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.effects.colour_maps import axis_numbers, coloured, with_box
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.read_file import read
from vectorplot.io.terrain_files import default_exaggeration, read_terrain
from vectorplot.scene.added_lines import round_sections, with_numbers
from vectorplot.scene.colour_scales import BoxAxes, Colouring
from vectorplot.scene.scene import together
from vectorplot.scene.surface_lines import round_heights
from vectorplot.surfaces.terrains import Terrain, terrain
from vectorplot.words import LineKind

HEAD = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n"


def written(folder, text, name="hill.asc"):
    path = folder / name
    path.write_text(text)
    return path


def test_rows_run_from_north_to_south_and_corners_are_those_of_cells(tmp_path):
    found = read_terrain(written(tmp_path, HEAD + "1 2 3\n4 5 -9999\n"))
    assert found.corner == (105.0, 205.0)
    assert found.cell == (10.0, 10.0)
    assert np.array_equal(found.heights, [[4, 1], [5, 2], [np.nan, 3]], equal_nan=True)
    centred = HEAD.replace("corner", "center").replace("cellsize 10", "dx 10\ndy 5").upper()
    found = read_terrain(written(tmp_path, centred + "1 2 3 4\n5 NaN\n"))
    assert (found.corner, found.cell) == ((100.0, 200.0), (10.0, 5.0))
    assert np.array_equal(found.heights, [[4, 1], [5, 2], [np.nan, 3]], equal_nan=True)


def test_files_with_a_byte_order_mark_are_read(tmp_path):
    mark = "\ufeff".encode()
    for name, text in (("hill.asc", HEAD + "1 2 3\n4 5 6\n"), ("four.xyz", "0 0 1\n1 0 2\n0 1 2\n1 1 5\n")):
        path = tmp_path / name
        path.write_bytes(mark + text.replace("\n", "\r\n").encode())
        assert np.isfinite(read_terrain(path).heights).all()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD + "1 2 3\n4 5\n", "hill.asc:8: the file ends after 5 of 3 x 2 heights"),
        (HEAD + "1 2 3\n4 5 6\n7\n", "hill.asc:9: more than the 3 x 2 heights that the head announces"),
        (HEAD + "1 2 3\n4 x 6\n", "hill.asc:8: expected a finite number, got 'x'"),
        (HEAD.replace("ncols 3", "ncols -3"), "hill.asc:1: ncols: expected a count, got '-3'"),
        (HEAD.replace("ncols 3", "ncols 1") + "1 2", "hill.asc: 1 columns and 2 rows, expected at least two of each"),
        (HEAD.replace("ncols 3", "ncols 99999999") + "1", "hill.asc: announces 199999998 heights, but has only"),
        (HEAD.replace("cellsize 10", "cellsize 0") + "1 2 3 4 5 6", "hill.asc:5: cellsize: 0 is not positive"),
        (HEAD.replace("xllcorner 100\n", "") + "1 2 3 4 5 6", "expected 'xllcorner' or 'xllcenter' in the head"),
        (HEAD.replace("nrows 2", "rows 2") + "1 2 3 4 5 6", "hill.asc:2: unknown word 'rows' in the head of a grid"),
        (HEAD + "-9999 " * 6, "hill.asc: nothing but holes"),
        ("hill\n1 2", "hill.asc: neither an ASCII grid"),
        ("0 0 1\n1 0\n1 1 2\n", "hill.asc:2: expected x, y and z, got 2 numbers"),
        ("0 0 1\n1 0 2\n", "hill.asc: 2 points, expected at least three"),
        ("0 0 1\n1 1 2\n2 2 3\n", "hill.asc: scattered heights: the points lie on one line"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path, text, said):
    with pytest.raises(InputError) as caught:
        read(written(tmp_path, text))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_points_on_a_grid_are_that_grid_in_any_order(tmp_path):
    x, y = np.meshgrid(500000 + 2.5 * np.arange(7), 5000000 + 2.5 * np.arange(5), indexing="ij")
    points = np.stack([x, y, np.arange(35.0).reshape(7, 5)], axis=-1).reshape(-1, 3)
    points = np.random.default_rng(3).permutation(points)[1:]
    lines = "\n".join(";".join(f"{value:.1f}" for value in row) + ";17" for row in points)
    found = read_terrain(written(tmp_path, "x;y;z;class\n" + lines, "survey.xyz"))
    assert (found.corner, found.cell, found.heights.shape) == ((500000.0, 5000000.0), (2.5, 2.5), (7, 5))
    assert found.holes.sum() == 1
    assert np.nansum(found.heights) == points[:, 2].sum()


def test_scattered_points_are_interpolated_with_nothing_beyond_their_hull(tmp_path):
    turn = np.random.default_rng(1).uniform(0, 2 * np.pi, 300)
    radius = np.sqrt(np.random.default_rng(2).uniform(0, 1, 300))
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    text = "# a disc\n" + "\n".join(f"{a:.6f} {b:.6f} {2 * a - b:.6f}" for a, b in zip(x, y, strict=True))
    found = read_terrain(written(tmp_path, text, "disc.xyz"))
    inside = ~found.holes
    assert 0.7 < inside.mean() < 0.85
    flat = 2 * found.points[..., 0] - found.points[..., 1]
    assert np.abs(found.heights - flat)[inside].max() < 1e-5


def test_the_suffix_of_molecules_is_told_by_content(tmp_path):
    assert read(written(tmp_path, "2\nhydrogen\nH 0 0 0\nH 0 0 0.74\n", "two.xyz")).items[0].name == "H1"
    assert (
        read(written(tmp_path, "0 0 1\n1 0 2\n0 1 2\n1 1 5\n", "four.xyz"), exaggeration=1).items[0].shape.face_count
        == 2
    )
    with pytest.raises(InputError, match=r"two\.xyz:1: a count, and then points without symbols"):
        read(written(tmp_path, "2\n\n0 0 0\n0 0 0.74\n", "two.xyz"))


def hills(m=40, n=30):
    x, y = np.meshgrid(np.linspace(0, 8, m), np.linspace(0, 6, n), indexing="ij")
    return np.sin(x) * np.cos(y)


def grid_text(land: Terrain) -> str:
    (m, n), (x, y) = land.heights.shape, land.corner
    head = f"ncols {m}\nnrows {n}\nxllcenter {x!r}\nyllcenter {y!r}\ndx {land.cell[0]!r}\ndy {land.cell[1]!r}\n"
    rows = (" ".join(map(repr, row)) for row in land.heights.T[::-1].tolist())
    return head + "\n".join(rows)


@pytest.mark.slow
def test_every_verb_takes_a_file_of_heights(tmp_path):
    heights = hills()
    heights[20:24, 10:14] = np.nan
    given = terrain(heights, (0, 8), (0, 6))
    path = written(tmp_path, grid_text(given))
    assert np.array_equal(read_terrain(path).heights, given.heights, equal_nan=True)
    scene = read(path, exaggeration=2.0)
    assert np.isclose(np.ptp(scene.bounds[:, 2]), 2.0 * (np.nanmax(heights) - np.nanmin(heights)))
    kinds = {kind for layer in vp.draw(scene).layers for mark in layer.marks for kind in mark.kind.tolist()}
    assert kinds >= {LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.SECTION, LineKind.INDEX}
    assert LineKind.CREASE not in kinds
    assert len(vp.paint(scene).layers) > 0
    assert np.ptp(vp.render(scene, size=(40, 30)).pixels) > 0


def test_heights_that_nobody_would_see_are_exaggerated_and_that_is_said(tmp_path):
    for scale, factor in ((1.0, 1.0), (0.01, 50.0), (1e-6, 5e5), (4000.0, 1e-4)):
        land = terrain(scale * hills(), (0, 8), (0, 6))
        assert default_exaggeration(land) == pytest.approx(factor)
    path = written(tmp_path, grid_text(terrain(0.01 * hills(8, 6), (0, 8), (0, 6))))
    with pytest.warns(InputWarning, match="heights are drawn 50 times as high"):
        read(path)
    with pytest.raises(InputError, match="heights are exaggerated of terrains only"):
        read(written(tmp_path, "BOX box 1 1 1", "box.scene"), exaggeration=2.0)


def test_numbers_at_heights_are_those_of_the_file_however_high_it_is_drawn(tmp_path):
    land = terrain(20.0 + 0.01 * hills(9, 7), (0, 8), (0, 6))
    path = written(tmp_path, grid_text(land))
    low, high = read_terrain(path).relief
    with pytest.warns(InputWarning, match="drawn 50 times as high"):
        scene = together([read(path), vp.Scene(())])
    assert scene.bounds[:, 2] == pytest.approx([50 * low, 50 * high])
    for sections in (scene.items[0].curves.sections, round_sections(scene)):
        heights = sorted(offset for section in sections for offset in section.offsets)
        assert np.array(heights) / 50.0 == pytest.approx(np.array(round_heights(low, high)))
    drawing = vp.draw(with_numbers(scene), "top", text="real")
    texts = [float(text) for layer in drawing.layers for mark in layer.marks for text in getattr(mark, "strings", ())]
    assert texts and low < min(texts) and max(texts) < high
    boxed, _ = with_box(replace(scene, box=BoxAxes()), vp.Camera.view("front"))
    upright = [label.text for label in boxed.labels if label.name.startswith("box 2 ")]
    assert upright == list(axis_numbers(low, high).texts)
    for by, ends in (("z", [low, high]), ("x", [0.0, 8.0])):
        bar = coloured(scene, Colouring(by))[1]
        assert [bar.low, bar.high] == pytest.approx(ends)


def test_verbs_take_arrays_of_heights_and_terrains():
    heights = hills(12, 9)
    for given in (heights, np.ma.masked_less(heights, -0.99), terrain(heights)):
        assert sum(len(layer.marks) for layer in vp.draw(given).layers) > 0
    with pytest.raises(TypeError):
        vp.draw(np.zeros((5, 3)))


def test_points_with_two_numbers_are_no_molecule(tmp_path):
    (tmp_path / "a.xyz").write_text("1 2\n3 4\n5 6\n")
    with pytest.raises(vp.InputError, match="expected x, y and z, got 2 numbers"):
        vp.read(tmp_path / "a.xyz")


@pytest.mark.parametrize("stray", [(1000.0, 1000.0, 0.0), (0.5, 0.5, -9999.0)])
def test_a_point_far_off_all_others_is_left_out_and_told(stray, tmp_path):
    place = np.random.default_rng(3).random((300, 2))
    points = np.column_stack([place, 0.1 * place.sum(axis=1)])
    np.savetxt(tmp_path / "a.xyz", np.vstack([points, stray]))
    with pytest.warns(vp.InputWarning, match="a point lies far off all others and is left out"):
        scene = vp.read(tmp_path / "a.xyz")
    assert np.ptp(scene.bounds, axis=0).max() < 1.1


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
@pytest.mark.parametrize("lines", ["none", "boundary", "section,index", "contour,boundary,section,index"])
def test_lines_that_are_asked_for_are_the_lines_of_a_terrain(verb, lines, tmp_path):
    path = tmp_path / "hill.asc"
    path.write_text("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 1 0\n1 3 1\n0 1 0\n", encoding="ascii")

    def shown(**how):
        layers = verb(path, vp.Camera((5, -7, 6), (1, 1, 0)), **how).layers
        return {vp.LineKind(kind).word for layer in layers for paths in layer.strokes for kind in paths.kind.tolist()}

    assert shown(lines=lines) == set(lines.split(",")) - {"none"}
    # Nothing but level lines, outlines and borders is drawn where nothing is said.
    assert shown() == ({"contour", "boundary", "section", "index"} if verb is vp.draw else set())


@pytest.mark.parametrize("written", ["-3.4028235e+38", "-3.402823466385289e+38", "-3.40282e+38", "-3.4028230607e38"])
def test_the_least_number_of_single_precision_is_a_hole_however_it_is_written(tmp_path, written):
    head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -3.4028234663852886e+38\n"
    (tmp_path / "x.asc").write_text(f"{head}1 2\n{written} 4\n", encoding="utf-8")
    assert np.isnan(read_terrain(tmp_path / "x.asc").heights).sum() == 1
