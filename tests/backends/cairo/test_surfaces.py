from __future__ import annotations

import math
import re
import struct
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.backend_samples import drawing_of, grey_of_png, paths_of, program, run
from support.effort import examples

from vectorplot.backends.cairo import eps_bytes, pdf_bytes, png_bytes, ps_bytes, whole_eps_bytes
from vectorplot.drawing.drawing import Drawing, Pen
from vectorplot.errors import InputError
from vectorplot.save import save

ALL = (ps_bytes, eps_bytes, pdf_bytes, png_bytes)
POINTS = 72 / 25.4


def bounding_box(text: bytes) -> list[int]:
    (box,) = re.findall(rb"(?m)^%%BoundingBox: (.*)$", text)
    return [int(word) for word in box.split()]


@pytest.mark.capability("G4.X-postscript")
@pytest.mark.parametrize("backend", [ps_bytes, eps_bytes])
def test_the_bounding_box_is_that_of_the_ink(backend):
    pen_mm = 0.5
    box = bounding_box(backend(drawing_of(paths_of([(20, 10), (70, 45)]))))
    expected = [(20 - pen_mm / 2), (10 - pen_mm / 2), (70 + pen_mm / 2), (45 + pen_mm / 2)]
    low, high = [math.floor(v * POINTS) for v in expected[:2]], [math.ceil(v * POINTS) for v in expected[2:]]
    assert np.abs(np.array(box) - [*low, *high]).max() <= 1
    assert all(a <= b * POINTS for a, b in zip(box[:2], expected[:2], strict=True))
    assert all(a >= b * POINTS for a, b in zip(box[2:], expected[2:], strict=True))


@pytest.mark.capability("G4.X-postscript")
@pytest.mark.parametrize("backend", [ps_bytes, eps_bytes])
def test_the_exact_box_of_the_ink_is_in_fractions_of_points(backend):
    pen_mm = 0.5
    text = backend(drawing_of(paths_of([(20, 10), (70, 45)])))
    (box,) = re.findall(rb"(?m)^%%HiResBoundingBox: (.*)$", text)
    found = np.array([float(word) for word in box.split()])
    expected = POINTS * np.array([20 - pen_mm / 2, 10 - pen_mm / 2, 70 + pen_mm / 2, 45 + pen_mm / 2])
    assert np.abs(found - expected).max() < 0.02


@pytest.mark.capability("G4.X-postscript")
def test_the_size_of_the_page_is_not_rounded():
    drawing = Drawing(123.4, 98.7, drawing_of(paths_of([(20, 10), (70, 45)])).layers)
    size = b"%.6f %.6f" % (123.4 * POINTS, 98.7 * POINTS)
    assert size + b" cairo_set_page_size" in ps_bytes(drawing)
    for text in (whole_eps_bytes(drawing), eps_bytes(Drawing(123.4, 98.7, ()))):
        assert b"%%HiResBoundingBox: 0.000000 0.000000 " + size in text
        assert b"%%BoundingBox: 0 0 350 280" in text


@pytest.mark.capability("G4.X-postscript")
def test_the_bounding_box_holds_what_ghostscript_measures(sample, tmp_path):
    save(sample, tmp_path / "a.eps")
    command = [program("gs"), "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-sDEVICE=bbox", str(tmp_path / "a.eps")]
    measured = subprocess.run(command, capture_output=True, timeout=600, check=True).stderr
    (ink,) = re.findall(rb"%%BoundingBox: (.*)", measured)
    box = bounding_box((tmp_path / "a.eps").read_bytes())
    assert np.abs(np.array([int(word) for word in ink.split()]) - box).max() <= 1


@pytest.mark.capability("G4.X-postscript")
def test_eps_keeps_to_the_rules_of_encapsulation(sample):
    text = eps_bytes(sample).decode("ascii")
    lines = text.splitlines()
    assert lines[0] == "%!PS-Adobe-3.0 EPSF-3.0"
    assert "%%LanguageLevel: 2" in lines
    words = set(re.findall(r"[A-Za-z]+", re.sub(r"(?m)^%.*$", "", text)))
    forbidden = """setpagedevice initgraphics initclip quit clear erasepage exitserver copypage framedevice grestoreall
        initmatrix letter legal note renderbands setglobal setshared startjob banddevice cleardictstack"""
    assert not words & set(forbidden.split())
    assert not words & {"findfont", "definefont"}
    assert text.count("showpage") == 1
    assert text.index("begin") < text.rindex("\nend\n")


def test_ps_stacks_are_left_as_found(sample, tmp_path):
    save(sample, tmp_path / "a.eps")
    probe = tmp_path / "probe.ps"
    probe.write_text(f"countdictstack ({tmp_path}/a.eps) run countdictstack sub = count = quit\n")
    arguments = ("-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-sDEVICE=nullpage", f"--permit-file-read={tmp_path}/")
    assert run("gs", *arguments, probe).split() == [b"0", b"0"]


@pytest.mark.hard(53)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("format", ["ps", "eps", "pdf", "png", "svg", "json"])
def test_hard_53_a_point_that_is_not_finite_is_refused_before_anything_is_written(tmp_path, value, format):
    drawing = drawing_of(paths_of([(1, 1), (2, value)]))
    with pytest.raises(InputError, match=r"layer 'visible': .* not finite"):
        save(drawing, tmp_path / f"a.{format}")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "change",
    [{"width_mm": np.nan}, {"width_mm": 0.0}, {"height_mm": -1.0}, {"height_mm": np.inf}, {"width_mm": 1e9}],
)
@pytest.mark.parametrize("backend", ALL)
def test_a_page_without_sense_is_refused(sample, change, backend):
    with pytest.raises(InputError, match="page"):
        backend(replace(sample, **change))


@pytest.mark.parametrize("pen", [{"width_mm": np.nan}, {"width_mm": 0.0}, {"colour": "red"}, {"colour": "#00000\n"}])
def test_a_pen_without_sense_is_refused(sample, pen):
    layer = replace(sample.layers[0], pen=replace(sample.layers[0].pen, **pen))
    with pytest.raises(InputError, match="layer 'visible'"):
        pdf_bytes(replace(sample, layers=(layer,)))


@pytest.mark.hard(54)
def test_hard_54_coordinates_beyond_2_to_the_23_do_not_wrap_round():
    near = drawing_of(paths_of([(0, 40), (120, 40)], [(60, 0), (60, 80)]))
    far = drawing_of(paths_of([(-1e9, 40), (1e9, 40)], [(60, -8388700), (60, 8388700)]))
    for backend in ALL:
        assert backend(near) == backend(far)


@pytest.mark.hard(55)
@pytest.mark.parametrize("backend", [ps_bytes, eps_bytes])
def test_hard_55_the_bounding_box_of_an_empty_drawing_is_the_page(empty, backend):
    assert bounding_box(backend(empty)) == [0, 0, math.ceil(120 * POINTS), math.ceil(80 * POINTS)]


@pytest.mark.hard(56)
def test_hard_56_a_path_without_length_makes_no_mark(empty):
    points = drawing_of(paths_of([(5, 5)], [(6, 6), (6, 6)], [(7, 7), (7.0001, 7)]))
    assert grey_of_png(png_bytes(points)).min() == 1.0
    assert eps_bytes(points) == eps_bytes(empty)


@pytest.mark.hard(61)
@pytest.mark.parametrize("backend", [ps_bytes, eps_bytes])
@pytest.mark.parametrize("newline", ["\n", "\r", "\r\n", "\x0c", "\x85", "\u2028", "\x0b"])
def test_hard_61_a_title_with_a_newline_is_one_comment_that_ghostscript_does_not_execute(tmp_path, backend, newline):
    attack = f"a{newline}(EXECUTED) = flush quit{newline}%%BoundingBox: 0 0 1 1"
    text = backend(drawing_of(paths_of([(20, 10), (70, 45)]), title=attack))
    (line,) = [line for line in re.split(rb"[\n\r\x0c]", text) if b"EXECUTED" in line]
    assert line == rb"%%Title: (a \(EXECUTED\) = flush quit %%BoundingBox: 0 0 1 1)"
    assert bounding_box(text)[2] > 100
    (tmp_path / "a.ps").write_bytes(text)
    assert run("gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-sDEVICE=nullpage", tmp_path / "a.ps") == b""


@pytest.mark.hard(62)
def test_hard_62_parentheses_and_backslashes_in_a_title_are_escaped():
    text = ps_bytes(drawing_of(title=r"a) b( c\ d é"))
    assert rb"%%Title: (a\) b\( c\\ d ?)" in text


@pytest.mark.slow
@settings(max_examples=examples(40))
@given(st.text(max_size=400))
def test_any_title_stays_in_its_comment(title):
    drawing = drawing_of(title=title)
    plain = ps_bytes(replace(drawing, title=""))
    assert re.sub(rb"(?m)^%%Title: \([ -~]*\)\n", b"", ps_bytes(drawing)) == plain
    pdf_bytes(drawing)


def test_the_png_has_its_resolution_and_a_white_page(sample):
    png = png_bytes(sample, dpi=200)
    width, height = struct.unpack(">II", png[16:24])
    assert (width, height) == (round(120 / 25.4 * 200), round(80 / 25.4 * 200))
    assert png[37:41] == b"sRGB" and png[41] == 0
    assert png[50:54] == b"pHYs" and struct.unpack(">IIB", png[54:63]) == (7874, 7874, 1)
    assert np.median(grey_of_png(png)) == 1.0


def test_colours_and_widths_reach_the_pixels():
    import io

    import cairo

    drawing = drawing_of(paths_of([(0, 40), (120, 40)]), pen=Pen(10.0, "#102030"))
    picture = cairo.ImageSurface.create_from_png(io.BytesIO(png_bytes(drawing, dpi=254)))
    pixels = np.frombuffer(picture.get_data(), np.uint8).reshape(picture.get_height(), -1, 4)[:, 600]
    inked = (pixels[:, :3] != 255).any(axis=1)
    assert inked.nonzero()[0].tolist() == list(range(350, 450))
    assert (pixels[inked, :3] == [0x30, 0x20, 0x10]).all()


def test_a_picture_of_absurd_size_is_refused(sample):
    for dpi in (1e5, 1e300, 0.0, -1.0, np.nan):
        with pytest.raises(InputError):
            png_bytes(sample, dpi=dpi)
