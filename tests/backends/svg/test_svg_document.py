from __future__ import annotations

import re
import time
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.backend_samples import drawing_of, paths_of
from support.effort import examples

from vectorplot.backends.svg import millimetres, svg_bytes, svg_text
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"


def test_the_page_is_in_mm_and_a_user_unit_is_one(sample):
    root = ET.fromstring(svg_bytes(sample))
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("120mm", "80mm", "0 0 120 80")


@pytest.mark.capability("G4.X-plotter")
def test_every_pen_is_a_top_level_inkscape_layer(sample):
    root = ET.fromstring(svg_bytes(sample))
    groups = root.findall(f"{SVG}g")
    assert [group.get(f"{INKSCAPE}label") for group in groups] == ["1 visible", "2 crease", "%3 layer2"]
    for group, layer in zip(groups, sample.layers, strict=True):
        assert group.get(f"{INKSCAPE}groupmode") == "layer"
        assert group.get("fill") == "none"
        assert group.get("stroke") == layer.pen.colour
        assert float(group.get("stroke-width")) == layer.pen.width_mm
        assert group.get("stroke-linecap") == group.get("stroke-linejoin") == "round"
        assert {child.tag for child in group} <= {f"{SVG}polyline", f"{SVG}polygon"}
        assert len(group)
    assert not any(word in svg_text(sample) for word in ("clipPath", "mask", "pattern", "transform"))


def test_y_is_flipped_and_decimals_are_short():
    drawing = drawing_of(paths_of([(0, 0), (10.5, 2.25), (7.1239, 80), (0.0004, 79.99)]))
    assert 'points="0,80 10.5,77.75 7.124,0 0,0.01"' in svg_text(drawing)


def test_a_closed_path_is_a_polygon_that_does_not_repeat_its_start():
    drawing = drawing_of(paths_of([(1, 1), (2, 1), (2, 2), (1.0001, 1.0001)], closed=True))
    assert '<polygon points="1,79 2,79 2,78"/>' in svg_text(drawing)


@given(st.lists(st.integers(0, 2_000_000_000), min_size=1, max_size=30))
def test_millimetres_are_decimals_without_needless_zeros(microns):
    table = millimetres(np.array(microns))
    for row, number in zip(table, microns, strict=True):
        whole, part = divmod(number, 1000)
        assert bytes(row[row != 0]).decode() == f"{whole}.{part:03d}".rstrip("0").rstrip(".")


@pytest.mark.hard(54)
def test_hard_54_coordinates_beyond_2_to_the_23_are_clipped_to_the_page():
    for far in (2.0**23 + 100, 1e9, 1e12):
        drawing = drawing_of(paths_of([(-far, 40), (far, 40)], [(60, -far), (60, far)], [(far, far), (2 * far, far)]))
        assert re.findall(r'points="(.*)"', svg_text(drawing)) == ["0,40 120,40", "60,80 60,0"]


@pytest.mark.hard(55)
def test_hard_55_an_empty_drawing_is_a_valid_page(empty):
    root = ET.fromstring(svg_bytes(empty))
    assert root.get("viewBox") == "0 0 120 80"
    assert ET.fromstring(svg_bytes(Drawing(10.0, 10.0, ()))).get("width") == "10mm"


@pytest.mark.hard(56)
def test_hard_56_paths_without_length_are_dropped():
    short = paths_of([(5, 5)], [], [(6, 6), (6, 6)], [(7, 7), (7.0001, 7.0001)], [(1, 1), (1, 1), (2, 1)])
    loops = paths_of([(5, 5)], [(6, 6), (6, 6)], [(8, 8), (9, 8), (8, 8)], closed=True)
    text = svg_text(drawing_of(short, loops))
    assert re.findall(r"<(poly\w+) points=\"(.*)\"", text) == [("polyline", "1,79 2,79"), ("polyline", "8,72 9,72")]


@pytest.mark.hard(60)
@pytest.mark.parametrize(
    "name", ['"><script>alert(1)</script>', "a\x00b\x08c\x1b\x7f\ud800\ufffe", "]]>&amp;\n--><!--"]
)
def test_hard_60_names_and_titles_are_escaped_and_stripped(name):
    drawing = drawing_of(paths_of([(1, 1), (2, 2)]), names=(name,), title=name)
    root = ET.fromstring(svg_bytes(drawing))
    assert {element.tag for element in root.iter()} == {SVG + tag for tag in ("svg", "title", "defs", "g", "polyline")}
    kept = name.translate(dict.fromkeys([0, 8, 27, 127, 0xD800, 0xFFFE])).replace("\n", " ")
    assert root.find(f"{SVG}title").text == kept
    assert root.find(f"{SVG}g").get(f"{INKSCAPE}label") == f"1 {kept}"


@settings(max_examples=examples(30))
@given(st.text(max_size=20), st.text(max_size=20))
def test_any_title_and_name_give_well_formed_xml(title, name):
    ET.fromstring(svg_bytes(drawing_of(paths_of([(1, 1), (2, 2)]), names=(name,), title=title)))


def test_ids_follow_the_content(sample, empty):
    ids = [set(re.findall(r' id="(.*?)"', svg_text(drawing))) for drawing in (sample, empty, sample)]
    assert len(ids[0]) == 3 and ids[0] == ids[2] and not ids[0] & ids[1]


@pytest.mark.slow
def test_300_000_points_take_little_more_than_their_text():
    random = np.random.default_rng(0)
    count = 100_000
    points = random.uniform(0.0, 200.0, (3 * count, 2))
    zero = np.zeros(count, dtype=np.intp)
    paths = Paths(points, np.arange(count + 1) * 3, zero > 0, zero, zero, zero, np.zeros((len(points), 3)))
    drawing = Drawing(210.0, 297.0, (Layer("visible", Pen(), (paths,)),))
    start = time.process_time()
    text = svg_bytes(drawing)
    seconds = time.process_time() - start
    # Beside the bare cost of spelling the numbers one by one, in the same process.
    start = time.process_time()
    " ".join(f"{x:.3f}" for x in points.ravel().tolist())
    bare = time.process_time() - start
    assert text.count(b"<polyline") == count
    assert seconds < 8.0 * bare
