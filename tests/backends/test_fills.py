"""Filled polygons in files: what real readers show."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.backend_samples import paths_of, run
from support.effort import several
from support.fill_samples import colour_at, fan, flat, page_of, pictures, rgb, shaded
from support.svg_fills import HREF, points_of

from vectorplot.backends.cairo import eps_bytes, png_bytes, ps_bytes
from vectorplot.backends.json import json_bytes, read_drawing
from vectorplot.backends.svg import svg_bytes, svg_text
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import SEAM_MM, FillKind, Fills
from vectorplot.errors import InputError
from vectorplot.save import FORMATS, save, write

RED, GREEN, BLUE, DARK = (255, 0, 0), (0, 255, 0), (0, 0, 255), (16, 20, 24)
SQUARE = [(5, 5), (25, 5), (25, 25), (5, 25)]
SVG = "{http://www.w3.org/2000/svg}"


def moved(polygon, dx, dy):
    return [(x + dx, y + dy) for x, y in polygon]


def sample() -> Drawing:
    """Flat polygons, one with a hole cut open, one off the page; shaded ones; a transparent one; lines."""
    hole = [(42, 5), (58, 5), (58, 15), (42, 15), (42, 5), (46, 8), (46, 12), (54, 12), (54, 8), (46, 8)]
    some = flat([SQUARE, moved(SQUARE, 10, 10), hole, [(50, 30), (90, 30), (90, 60)]], [RED, GREEN, DARK, BLUE])
    gradient = shaded(
        [[(30, 20), (44, 22), (36, 38)], [(2, 27), (15, 28), (8, 39)]], [[RED, GREEN, BLUE], [DARK, DARK, RED]]
    )
    glass = flat([moved(SQUARE, 5, 12)], [BLUE], opacity=0.5, kind=FillKind.GLASS)
    lines = flat([[(1, 1), (59, 2)], [(1, 2), (30, 3)]], [GREEN, RED], kind=FillKind.EDGE)
    return page_of(some, gradient, paths_of([(1, 20), (59, 24)]), glass, lines, items=("box",), title="areas")


@pytest.mark.slow
@pytest.mark.capability("G4.X-postscript")
def test_every_reader_shows_the_colours_that_are_there(tmp_path):
    drawing = sample()
    for name, picture in pictures(drawing, tmp_path).items():
        places = {(8, 8): RED, (32, 20): GREEN, (44, 13): DARK, (50, 10): (255, 255, 255), (58, 33): BLUE}
        mixed = {(12, 20): (128, 0, 128), (20, 20): (0, 128, 128), (12, 36): (128, 128, 255)}
        thirds = {(36.66, 26.66): (85, 85, 85), (33, 20.6): (203, 50, 2)}
        for (x, y), colour in {**places, **mixed, **thirds}.items():
            seen = colour_at(picture, x, y, 40)
            # Poppler paints triangles in pieces of nearly one colour.
            assert np.abs(np.array(seen) - colour).max() <= (6 if (x, y) not in places else 1), (name, x, y, seen)


@pytest.mark.slow
def test_all_readers_agree(tmp_path):
    seen = pictures(sample(), tmp_path)
    own = seen.pop("png")
    rows, columns = (side // 6 * 6 for side in own.shape[:2])
    for name, picture in seen.items():
        difference = np.abs(picture[:rows, :columns].astype(float) - own[:rows, :columns])
        blocks = difference.reshape(rows // 6, 6, columns // 6, 6, 3).mean(axis=(1, 3))
        # A page of 472.4 rows has 472 or 473, so that readers may be half a pixel apart.
        assert difference.mean() < 2.5 and blocks.max() < 80, (name, difference.mean(), blocks.max())


def grid(cells) -> np.ndarray:
    """(n,3,2) triangles of a slanted, wavy grid that covers the whole page."""
    u, v = np.meshgrid(np.linspace(-35, 75, cells + 1), np.linspace(-10, 50, cells + 1))
    places = np.stack((u + 0.3 * v + np.sin(v), v + 0.4 * np.sin(u / 3)), axis=-1).reshape(-1, 2)
    corner = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    above = corner + cells + 1
    return places[np.stack((corner, corner + 1, above + 1, corner, above + 1, above), axis=1).reshape(-1, 3)]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("kind", ["flat", "shaded", "both"])
@pytest.mark.parametrize("shape", ["fan", "grid"])
def test_no_seam_between_dark_neighbours_on_white_paper(shape, kind, tmp_path):
    triangles = fan((30, 20), 60, 97) if shape == "fan" else grid(14)
    dark = [(DARK[0] + k % 2, *DARK[1:]) for k in range(len(triangles))]
    bright = [[(10, 10, 10), (30, 10, 25), (25, 40, 10)]] * len(triangles)
    fills = shaded(list(triangles), bright) if kind == "shaded" else flat(list(triangles), dark)
    if kind == "both":
        fills = Fills.joined(shaded(list(triangles[::2]), bright[::2]), flat(list(triangles[1::2]), dark[1::2]))
    for name, picture in pictures(page_of(fills), tmp_path).items():
        inner = picture[2:-3, 2:-3]
        assert inner.max() <= (45 if kind != "flat" else 30), (name, inner.max())


def test_the_seam_test_would_see_a_seam(tmp_path):
    """Without seams the paper shines through."""
    triangles = fan((30, 20), 60, 97)
    apart = [shapely.Polygon(triangle).buffer(-1e-3).exterior.coords[:-1] for triangle in triangles]
    text = svg_text(page_of(flat(apart, [(16 + k % 2, 20, 24) for k in range(97)])))
    (tmp_path / "a.svg").write_text(re.sub(r'stroke="#1[01]1418"', 'stroke="none"', text))
    assert rgb(run("rsvg-convert", "-d", 300, "-p", 300, "-b", "white", tmp_path / "a.svg"))[2:-3, 2:-3].max() > 60


def test_shaded_neighbours_one_sees_through_do_not_cover_their_common_sides_twice():
    triangles = fan((30.0, 20.0), 15.0, 24)
    colours = [[(0, 60, 60), (0, 70, 70), (0, 90, 90)]] * len(triangles)
    picture = rgb(png_bytes(page_of(shaded(triangles, colours, opacity=0.4)), 150))
    row, column = np.indices(picture.shape[:2])
    inside = np.hypot(row - picture.shape[0] / 2.0, column - picture.shape[1] / 2.0) < 13.0 * 150.0 / 25.4
    red = picture[..., 0][inside]
    # Once covered it is 0.6 of the white; twice would be 0.36.
    assert red.min() >= 0.6 * 255 - 3 and red.max() <= 0.84 * 255


@pytest.mark.slow
def test_a_polygon_alone_is_as_large_as_it_is(tmp_path):
    for name, picture in pictures(page_of(flat([SQUARE], [DARK]), width=30, height=30), tmp_path, dpi=1270).items():
        row = picture[750, :, 0] < 128  # 50 pixels a mm
        assert row.sum() == pytest.approx(20 * 50, abs=2), name


@pytest.mark.slow
def test_marks_are_drawn_in_their_order(tmp_path):
    stroke = paths_of([(0, 15), (60, 15)])
    over = page_of(flat([SQUARE], [RED]), stroke, flat([moved(SQUARE, 25, 0)], [GREEN]))
    for name, picture in pictures(over, tmp_path).items():
        assert colour_at(picture, 10, 15, 40) == [0, 0, 0], name
        assert colour_at(picture, 40, 15, 40) == list(GREEN), name


@pytest.mark.slow
def test_fills_and_edges_may_alternate_in_one_mark(tmp_path):
    """Polygons of two corners are lines: erasing by painting needs no marks of its own for every face."""
    faces = [SQUARE, SQUARE[:2], SQUARE[1:3], moved(SQUARE, 10, 0)]
    erased = page_of(flat(faces, [(255, 255, 255), DARK, DARK, (255, 255, 255)]))
    for name, picture in pictures(erased, tmp_path).items():
        assert colour_at(picture, 10, 5, 40) == list(DARK), name
        assert colour_at(picture, 25, 15, 40) == [255, 255, 255], name
    assert svg_text(erased).count('stroke-width="0.5"') == 2  # the layer's, and both lines in one path


@pytest.mark.slow
def test_neighbours_of_one_colour_are_one_path_and_look_the_same(tmp_path):
    rng = np.random.default_rng(4)
    corners = rng.uniform(0, 40, (60, 3, 2)) * (1.5, 1)  # either turn, overlapping
    together = page_of(flat(list(corners), [DARK] * 60))
    apart = page_of(flat(list(corners), [(16 + k % 2, 20, 24) for k in range(60)]))
    assert svg_text(together).count("<path") == 1 and svg_text(apart).count("<path") == 60
    for one, other in zip(*(pictures(d, tmp_path, dpi=150).values() for d in (together, apart)), strict=True):
        assert np.abs(one - other).mean() < 0.5
        assert ((one > 128) != (other > 128)).mean() < 1e-3


def test_svg_is_well_formed_and_says_only_what_it_must():
    drawing = replace(
        sample(), title='"><script>alert(1)</script>', layers=(replace(sample().layers[0], name='"><x>'),)
    )
    root = ET.fromstring(svg_bytes(drawing))
    (layer,) = root.findall(f"{SVG}g")
    assert '"><x>' in next(value for key, value in layer.items() if key.endswith("label"))
    paths = list(layer.iter(f"{SVG}path"))
    assert {path.get("fill") for path in paths} >= {"#ff0000", "#00ff00", "#101418"}
    ids = [node.get("id") for node in root.iter(f"{SVG}linearGradient")]
    assert ids and len(set(ids)) == len(ids)
    assert all(identity.startswith(layer.get("id").split("-")[0]) for identity in ids)
    used = {path.get("fill") for path in paths if path.get("fill", "").startswith("url")}
    shared = {node.get(HREF)[1:] for node in root.iter(f"{SVG}linearGradient") if node.get(HREF)}
    assert used == {f"url(#{identity})" for identity in set(ids) - shared}
    assert all(
        1 <= len(re.findall("M", path.get("d"))) and path.get("d").count("M") >= path.get("d").count("Z")
        for path in paths
    )
    assert "nan" not in svg_text(drawing) and "\7" not in svg_text(drawing)


def test_a_small_file_to_the_letter():
    fills = flat(
        [[(1, 1), (2, 1), (2, 2.5)], [(1, 1), (2, 2.5), (1, 2.5)], [(3, 1), (4, 1), (4, 2)], [(1, 3), (4, 3)]],
        [RED, RED, BLUE, GREEN],
        opacity=[1, 1, 0.25, 1],
    )
    body = svg_text(page_of(fills, width=5, height=4)).split('stroke-width="0.5">\n', 1)[1]
    assert body == (
        '<g stroke="none" stroke-width="0.15">\n'
        '<path fill="#ff0000" d="M1,3l1,0 0-1.5-.385,0-.615,.923ZM1,3l1-1.5-1,0Z"/>\n'
        '<path fill="#0000ff" fill-opacity="0.25" d="M3,3l1,0 0-1Z"/>\n'
        '<path stroke="#00ff00" stroke-width="0.5" d="M1,1l3,0"/>\n'
        "</g>\n</g></svg>\n"
    )


@pytest.mark.hard(57)
@pytest.mark.parametrize("format", FORMATS)
def test_the_same_fills_are_the_same_bytes(format):
    assert write(sample(), format) == write(sample(), format)


def test_postscript_has_the_level_it_needs():
    assert b"%%LanguageLevel: 2" in ps_bytes(page_of(flat([SQUARE], [RED])))
    graded = ps_bytes(page_of(shaded([SQUARE], [[RED, GREEN, BLUE, RED]])))
    assert b"%%LanguageLevel: 3" in graded and b"ShadingType 4" in graded
    assert b"/ImageType" not in graded


def test_the_bounding_box_of_an_eps_file_is_that_of_the_areas():
    box = re.search(rb"%%BoundingBox: (.*)", eps_bytes(page_of(flat([[(10, 10), (30, 10), (30, 20)]], [RED]))))
    numbers = np.array(box.group(1).split(), dtype=float) / 72 * 25.4
    assert np.allclose(numbers, (10, 10, 30, 20), atol=0.6)


def test_json_gives_back_what_was_written(tmp_path):
    drawing = sample()
    save(drawing, tmp_path / "a.json")
    back = read_drawing(tmp_path / "a.json")
    assert back.layers[0].name == "fills"
    ours, (theirs,) = Fills.joined(*drawing.layers[0].fills), back.layers[0].fills
    for name in ("points", "offsets", "colours", "opacity", "points3d", "kind"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name
    assert (theirs.item == ours.item).all()
    assert json_bytes(back) == json_bytes(drawing)


def test_json_keeps_to_the_contract():
    fills = shaded([[(1, 2), (3, 4), (5, 7)], [(0, 0), (1, 0), (0, 1)]], [[RED, GREEN, BLUE], [DARK] * 3], item=[0, -1])
    data = json.loads(json_bytes(page_of(fills, items=('100% "a"',))))
    assert list(data) == ["format", "version", "page_mm", "page_from_world", "strokes", "fills"]
    assert data["fills"][0] == {
        "kind": "face",
        "item": '100% "a"',
        "colour": ["#ff0000", "#00ff00", "#0000ff"],
        "opacity": 1.0,
        "points": [[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]],
        "points3d": [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0], [5.0, 7.0, 0.0]],
    }
    assert data["fills"][1]["colour"] == "#101418" and data["fills"][1]["item"] == ""


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"kind": "fog"}, "unknown word"),
        ({"item": 3}, "expected str"),
        ({"colour": "red"}, "#rrggbb"),
        ({"colour": ["#000000"]}, "#rrggbb"),
        ({"colour": "#00000g"}, "#rrggbb"),
        ({"opacity": 1.5}, "opacity"),
        ({"opacity": "1"}, "opacity"),
        ({"points": [[1, 2]]}, "number"),
        ({"points": [[1, 2], [1, 2], [1, None]]}, "points"),
        ({"points3d": None}, "points3d"),
    ],
)
def test_bad_json_is_refused(change, cause, tmp_path):
    data = json.loads(json_bytes(page_of(flat([SQUARE[:3]], [RED]))))
    data["fills"][0].update(change)
    (tmp_path / "a.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=cause) as caught:
        read_drawing(tmp_path / "a.json")
    assert "\n" not in str(caught.value)


@pytest.mark.hard(53)
@pytest.mark.parametrize("format", FORMATS)
def test_hard_53_fills_that_are_not_finite_are_refused(format):
    good = flat([SQUARE], [RED])
    for bad in (
        replace(good, points=good.points * np.nan),
        replace(good, points=good.points + np.inf),
        replace(good, opacity=np.array([np.nan])),
        replace(good, opacity=np.array([1.1])),
    ):
        with pytest.raises(InputError, match="faces"):
            write(page_of(bad), format)


@pytest.mark.hard(55)
@pytest.mark.parametrize("format", FORMATS)
def test_hard_55_no_polygons_are_a_valid_page(format, tmp_path):
    nothing = page_of(Fills.empty(), flat([[(100, 100), (110, 100), (105, 110)]], [RED]))
    assert write(nothing, format)
    if format in ("ps", "eps"):
        assert b"%%BoundingBox: 0 0 171 114" in write(nothing, format)


def test_layers_without_fills_are_what_they_were():
    drawing = Drawing(60.0, 40.0, (Layer("visible", Pen(), (paths_of([(1, 1), (9, 9)]),)),))
    assert "<path" not in svg_text(drawing) and '<polyline points="1,39 9,31"/>' in svg_text(drawing)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_any_polygons_make_files_that_can_be_read(seed, tmp_path):
    """Of no to seven corners, crossing themselves, tiny, huge, far away, clear, of any colours."""
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 8, 60)
    total = int(sizes.sum())
    points = rng.uniform(-20, 80, (total, 2)) * np.where(
        rng.random((total, 1)) < 0.05, 10.0 ** rng.integers(-9, 12), 1.0
    )
    colours = rng.integers(0, 256, (total, 3)).astype(np.uint8)
    offsets = np.concatenate(([0], np.cumsum(sizes)))
    alike = np.repeat(rng.random(60) < 0.5, sizes)
    colours[alike] = colours[np.minimum(np.repeat(offsets[:-1], sizes), total - 1)][alike]
    opacity = np.where(rng.random(60) < 0.3, rng.random(60), 1.0)
    none = np.zeros(60, dtype=np.intp)
    fills = Fills(points, offsets, colours, opacity, none, np.column_stack((points, points[:, 0])), none)
    drawing = page_of(fills, items=("x",))
    root = ET.fromstring(svg_bytes(drawing))
    for path in root.iter(f"{SVG}path"):
        for points in points_of(path):
            assert points.min() >= -3.0 * SEAM_MM and points.max() <= 60 + 3.0 * SEAM_MM
    save(drawing, tmp_path / "a.json")
    assert np.array_equal(read_drawing(tmp_path / "a.json").layers[0].fills[0].points, fills.points)
    if seed < several(1, long=3):
        assert len({picture.shape[1] // 8 for picture in pictures(drawing, tmp_path, dpi=100).values()}) == 1
