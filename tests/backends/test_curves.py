"""Smooth strokes in files: Bézier paths and arcs that show what the polylines show."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.backend_samples import (
    DPI,
    assert_same_picture,
    drawing_of,
    grey_of_pgm,
    grey_of_png,
    missing,
    paths_of,
    run,
)
from support.pace import cpu_seconds

from vectorplot.backends.cairo import png_bytes
from vectorplot.backends.svg import svg_bytes
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Pen
from vectorplot.drawing.stroke_curves import curved_strokes
from vectorplot.drawing.strokes import concatenated
from vectorplot.errors import InputError
from vectorplot.save import FORMATS, save, write

SVG = "{http://www.w3.org/2000/svg}"
TOLERANCE = 0.02


def smooth(*lines, closed=False, tolerance=TOLERANCE):
    paths = paths_of(*lines, closed=closed)
    return curved_strokes(replace(paths, smooth=np.ones(len(paths), np.bool_)), tolerance)


def ellipse(t, a=30.0, b=18.0, turn=0.5, centre=(60.0, 40.0)):
    x, y = a * np.cos(t), b * np.sin(t)
    return np.column_stack((x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn))) + centre


def wave(t):
    return np.column_stack((-15 + 150 * t, 40 + 45 * np.sin(15 * t)))


FULL = np.linspace(0, 2 * np.pi, 201)[:-1]
T = np.linspace(0, 1, 1001)


@pytest.fixture(scope="module")
def curved() -> Drawing:
    """Ellipses and arcs of them, a loop that is none, a wave that leaves the page; straight strokes between them."""
    loop = ellipse(FULL) + 4 * np.column_stack((np.cos(3 * FULL), np.sin(2 * FULL)))
    open_ones = [ellipse(4 * T[::10]), ellipse(-2.5 * T[::10], 12, 12, 0, (20, 60)), wave(T), [(5, 5), (115, 6)]]
    both = concatenated((smooth(*open_ones[:3]).paths, paths_of(*open_ones[3:])))
    rings = smooth(ellipse(FULL, 20, 20), ellipse(FULL, 8, 20, 1.0), loop, closed=True)
    return drawing_of(curved_strokes(both, TOLERANCE), rings, title="Curves")


def as_polylines(drawing: Drawing) -> Drawing:
    return replace(drawing, layers=tuple(replace(layer, marks=layer.strokes) for layer in drawing.layers))


@pytest.fixture(scope="module")
def ours(curved) -> np.ndarray:
    """The picture of the polylines."""
    return grey_of_png(png_bytes(as_polylines(curved), dpi=DPI))


@pytest.mark.slow
def test_png_shows_what_the_polylines_show(curved, ours):
    assert_same_picture(ours, grey_of_png(png_bytes(curved, dpi=DPI)))


@pytest.mark.slow
def test_rsvg_shows_what_the_polylines_show(curved, ours, tmp_path):
    save(curved, tmp_path / "a.svg")
    png = run("rsvg-convert", "-d", DPI, "-p", DPI, "-b", "white", tmp_path / "a.svg")
    assert_same_picture(ours, grey_of_png(png))


@pytest.mark.slow
@pytest.mark.parametrize("format", ["ps", "eps"])
def test_ghostscript_shows_what_the_polylines_show(curved, ours, tmp_path, format):
    save(curved, tmp_path / f"a.{format}")
    assert len(re.findall(rb"\sc\s", write(curved, format))) > 20
    rows, columns = ours.shape
    options = ("-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dGraphicsAlphaBits=4", f"-r{DPI}", f"-g{columns}x{rows}")
    picture = run("gs", *options, "-dFIXEDMEDIA", "-sDEVICE=pgmraw", "-sOutputFile=%stdout", tmp_path / f"a.{format}")
    assert_same_picture(ours, grey_of_pgm(picture))


def test_poppler_shows_what_the_polylines_show(curved, ours, tmp_path):
    save(curved, tmp_path / "a.pdf")
    assert_same_picture(ours, grey_of_pgm(run("pdftoppm", "-r", DPI, tmp_path / "a.pdf")))


def test_svg_has_paths_for_smooth_strokes_only(curved):
    layers = ET.fromstring(svg_bytes(curved)).findall(f"{SVG}g")
    tags = [[child.tag.removeprefix(SVG) for child in layer] for layer in layers]
    assert tags[0][-1] == "polyline" and set(tags[0][:-1]) == {"path"}
    assert tags[1] == ["path"] * 3
    data = [child.get("d") for layer in layers for child in layer if child.tag == f"{SVG}path"]
    number = r"-?\d+(\.\d{1,3}(?=[ ,CAZ]|$))?"
    cubic = rf"M{number},{number}C{number},{number}( {number},{number})+Z?"
    assert all(re.fullmatch(cubic, d) for d in data if "A" not in d)
    assert sum("A" in d for d in data) == 4
    assert all(d.endswith("Z") for d in data[-3:])
    kept = ET.fromstring(svg_bytes(as_polylines(curved)))
    assert not list(kept.iter(f"{SVG}path"))


@pytest.mark.spread
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("angle", [0.3, 1.5, 2.9, 4.0, 6.0])
@pytest.mark.parametrize("turn", [0.0, 0.7, 2.0, 4.5])
def test_arcs_in_svg_are_those_of_the_stroke(angle, turn, backwards):
    t = 1.0 + np.linspace(0.0, angle, 60)
    drawing = drawing_of(smooth(ellipse(t[::-1] if backwards else t, turn=turn)))
    (path,) = ET.fromstring(svg_bytes(drawing)).iter(f"{SVG}path")
    parts = arc_points(path.get("d"))
    assert len(parts) == np.ceil(angle / (np.pi / 2))
    true = ellipse(1.0 + np.linspace(0.0, angle, 20001), turn=turn) * (1, -1) + (0, 80)
    for part in parts:
        off = shapely.distance(shapely.points(part), shapely.linestrings(true))
        assert off.max() < 0.001
    assert np.hypot(*(parts[0][0] - true[-1 if backwards else 0]).T) < 0.001
    assert np.hypot(*(parts[-1][-1] - true[0 if backwards else -1]).T) < 0.001


def arc_points(data):
    """Points on each arc of a path, by the endpoint parametrisation of the SVG recommendation, appendix F.6.5."""
    start, *arcs = data.removeprefix("M").split("A")
    here = np.array(start.split(","), dtype=float)
    found = []
    for arc in arcs:
        rx, ry, tilt, large, sweep, x, y = (float(word) for word in arc.replace(",", " ").split())
        turn = np.radians(tilt)
        rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        end = np.array([x, y])
        p = rotation @ (here - end) / 2
        scale = (rx * ry) ** 2 / ((rx * p[1]) ** 2 + (ry * p[0]) ** 2) - 1
        sign = 1 if large != sweep else -1
        c = sign * np.sqrt(max(scale, 0.0)) * np.array([rx * p[1] / ry, -ry * p[0] / rx])
        one, two = (np.arctan2(q[1] / ry, q[0] / rx) for q in (p - c, -p - c))
        step = (two - one) % (2 * np.pi)
        t = one + np.linspace(0, step if sweep else step - 2 * np.pi, 20)
        local = np.column_stack((rx * np.cos(t), ry * np.sin(t))) + c
        found.append(local @ rotation + (here + end) / 2)
        here = end
    return found


def test_a_circle_has_equal_radii_and_no_tilt():
    drawing = drawing_of(smooth(ellipse(FULL, 20, 20), closed=True))
    (path,) = ET.fromstring(svg_bytes(drawing)).iter(f"{SVG}path")
    assert re.fullmatch(r"M[\d.,]+(A20 20 0 0 [01] [\d.]+,[\d.]+ ?){4}Z", path.get("d"))


@pytest.mark.parametrize("format", FORMATS)
def test_the_same_curves_are_the_same_bytes(curved, format):
    assert write(curved, format) == write(curved, format)


def test_json_holds_the_polylines(curved):
    assert write(curved, "json") == write(as_polylines(curved), "json")


def test_strokes_stand_in_their_order():
    paths = concatenated((paths_of([(1, 1), (2, 2)]), smooth(wave(T[300:400])).paths, paths_of([(3, 3), (4, 5)])))
    mark = curved_strokes(paths, TOLERANCE)
    (layer,) = ET.fromstring(svg_bytes(drawing_of(mark))).findall(f"{SVG}g")
    assert [child.tag.removeprefix(SVG) for child in layer] == ["polyline", "path", "polyline"]


@pytest.mark.hard(54)
def test_hard_54_curves_are_cut_at_the_border_of_the_page():
    # The true curve runs far out; the file stays on the page but for handles.
    t = np.linspace(-1.0, 1.0, 4001)
    mark = smooth(np.column_stack((60 + 5e4 * t**3, 40 + 30 * np.sin(3 * t))), ellipse(FULL, 70, 30, 0))
    (layer,) = ET.fromstring(svg_bytes(drawing_of(mark))).findall(f"{SVG}g")
    data = [child.get("d") for child in layer]
    assert all("A" not in d for d in data)
    for d in data:
        numbers = np.array(re.findall(r"-?[\d.]+", d), dtype=float).reshape(-1, 2)
        ends = numbers[::3]
        assert (ends >= 0).all() and (ends <= (120, 80)).all()
        assert np.abs(numbers).max() < 400
    assert len(data) == 3  # the wide ellipse leaves the page on two sides


@pytest.mark.hard(53)
def test_hard_53_a_handle_that_is_not_finite_is_refused():
    mark = smooth(wave(T))
    mark.beziers.control[2, 1, 0] = np.nan
    with pytest.raises(InputError, match="not finite"):
        svg_bytes(drawing_of(mark))


@pytest.mark.hard(56)
def test_hard_56_curves_shorter_than_the_rounding_are_dropped():
    drawing = drawing_of(smooth(1e-5 * ellipse(FULL, centre=(0, 0)) + 10, tolerance=1e-5))
    (layer,) = ET.fromstring(svg_bytes(drawing)).findall(f"{SVG}g")
    assert len(layer) == 0


def test_vpype_reads_curves(curved, tmp_path):
    try:
        import vpype
    except ImportError:
        missing("vpype")
    mark = smooth(ellipse(FULL, 20, 20), closed=True)
    line = wave(np.linspace(0.2, 0.8, 20001)) * (1, 0.8) + (0, 8)
    open_one = smooth(line[::50])
    save(drawing_of(mark, open_one, pen=Pen(0.3)), tmp_path / "a.svg")
    document = vpype.read_multilayer_svg(str(tmp_path / "a.svg"), quantization=0.05)
    mm = 96.0 / 25.4
    assert [len(document.layers[i]) for i in (1, 2)] == [1, 1]
    length = np.hypot(*np.diff(line, axis=0).T).sum()
    assert [document.layers[i].length() / mm for i in (1, 2)] == pytest.approx([40 * np.pi, length], rel=2e-4)


@pytest.mark.slow
def test_100_000_segments_take_less_than_half_a_second():
    rng = np.random.default_rng(0)
    count, size = 1000, 100
    t = np.linspace(0, 1, 3 * size + 1)
    waves = rng.uniform(5, 9, (count, 2))
    lines = [np.column_stack((60 + 50 * np.sin(a * t), 40 + 30 * np.sin(b * t))) for a, b in waves]
    paths = paths_of(*lines)
    control = np.stack([np.stack((line[:-1:3], line[1::3], line[2::3], line[3::3]), axis=1) for line in lines])
    mark = smooth(*lines[:1])
    beziers = replace(
        mark.beziers,
        control=control.reshape(-1, 4, 2),
        offsets=np.arange(count + 1) * size,
        closed=np.zeros(count, np.bool_),
        error=np.zeros(count),
    )
    drawing = drawing_of(CurvedStrokes(paths, beziers, mark.arcs))
    with cpu_seconds(1.0):
        text = svg_bytes(drawing)
    assert text.count(b"<path") == count
