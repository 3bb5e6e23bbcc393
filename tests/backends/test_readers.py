"""Real readers open every format, and the pictures they make agree with the PNG of the same drawing."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
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

from vectorplot.backends.cairo import png_bytes
from vectorplot.save import FORMATS, save, write

GHOSTSCRIPT = ("-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dTextAlphaBits=4", "-dGraphicsAlphaBits=4", f"-r{DPI}")


def ghostscript(file, *options) -> np.ndarray:
    return grey_of_pgm(run("gs", *GHOSTSCRIPT, "-sDEVICE=pgmraw", "-sOutputFile=%stdout", *options, file))


@pytest.fixture(scope="module")
def ours(sample) -> np.ndarray:
    return grey_of_png(png_bytes(sample, dpi=DPI))


@pytest.mark.slow
def test_rsvg_shows_the_same_picture(sample, ours, tmp_path):
    save(sample, tmp_path / "a.svg")
    png = run("rsvg-convert", "-d", DPI, "-p", DPI, "-b", "white", tmp_path / "a.svg")
    assert_same_picture(ours, grey_of_png(png))


@pytest.mark.slow
@pytest.mark.capability("G4.X-postscript")
def test_ghostscript_shows_the_same_picture_of_a_ps_file(sample, ours, tmp_path):
    save(sample, tmp_path / "a.ps")
    rows, columns = ours.shape
    assert_same_picture(ours, ghostscript(tmp_path / "a.ps", f"-g{columns}x{rows}", "-dFIXEDMEDIA"))
    # Without being told, Ghostscript takes the page from the file: whole points.
    page = ghostscript(tmp_path / "a.ps").shape
    assert 0 <= page[0] - rows <= DPI / 72 and 0 <= page[1] - columns <= DPI / 72 + 1


@pytest.mark.capability("G4.X-postscript")
def test_ghostscript_shows_the_same_picture_of_an_eps_file(sample, ours, tmp_path):
    save(sample, tmp_path / "a.eps")
    rows, columns = ours.shape
    assert_same_picture(ours, ghostscript(tmp_path / "a.eps", f"-g{columns}x{rows}", "-dFIXEDMEDIA"))


def test_poppler_shows_the_same_picture_of_a_pdf_file(sample, ours, tmp_path):
    save(sample, tmp_path / "a.pdf")
    assert_same_picture(ours, grey_of_pgm(run("pdftoppm", "-r", DPI, tmp_path / "a.pdf")))


@pytest.mark.slow
def test_the_comparison_sees_a_shift_a_missing_line_and_a_wrong_width(sample, ours):
    wider = replace(sample, layers=(replace(sample.layers[0], pen=replace(sample.layers[0].pen, width_mm=0.8)),))
    fewer = replace(sample, layers=sample.layers[:2])
    for wrong in (np.roll(ours, 2, axis=1), np.roll(ours, 2, axis=0), *map(picture, (wider, fewer))):
        with pytest.raises(AssertionError):
            assert_same_picture(ours, wrong)


@pytest.fixture(scope="module")
def vpype_told(empty, sample, tmp_path_factory) -> list[str]:
    """What the command of vpype tells of the empty drawing, and then, when it has read it too, of the other one."""
    files = [tmp_path_factory.mktemp("vpype") / f"{number}.svg" for number in range(2)]
    for drawing, file in zip((empty, sample), files, strict=True):
        save(drawing, file)
    told = run("vpype", "read", files[0], "stat", "read", files[1], "stat").decode()
    return told.split("= Stats =")[1:]


def picture(drawing) -> np.ndarray:
    return grey_of_png(png_bytes(drawing, dpi=DPI))


@pytest.mark.capability("G4.X-plotter")
def test_vpype_reads_layers_lengths_pens_and_page(sample, tmp_path):
    try:
        import vpype
    except ImportError:
        missing("vpype")
    save(sample, tmp_path / "a.svg")
    document = vpype.read_multilayer_svg(str(tmp_path / "a.svg"), quantization=0.1)
    mm = 96.0 / 25.4
    assert document.page_size == pytest.approx((120 * mm, 80 * mm))
    assert sorted(document.layers) == [1, 2, 3]
    assert [len(document.layers[i]) for i in (1, 2)] == [12, 1]
    angle = np.linspace(0.0, np.pi / 2, 12)
    lengths = np.hypot(90 * np.cos(angle), 60 * np.sin(angle)).sum(), 5 * 40 * np.sin(2 * np.pi / 5)
    # Closed forms: the rays of the fan, the sides of the star.
    assert [document.layers[i].length() / mm for i in (1, 2)] == pytest.approx(lengths, abs=0.01)
    assert document.layers[2].property("vp_color") == vpype.Color("#c02010")
    assert document.layers[2].property("vp_pen_width") / mm == pytest.approx(0.3)
    assert document.layers[1].property("vp_name") == "1 visible"
    left, top, right, bottom = (side / mm for side in document.bounds())
    assert left >= 0 and top >= 0 and right <= 120.001 and bottom <= 80.001


@pytest.mark.slow
@pytest.mark.capability("G4.X-plotter")
def test_the_command_of_vpype_reads_and_counts(vpype_told):
    report = vpype_told[1]
    assert len(re.findall(r"(?m)^Layer \d+$", report)) == 3
    assert "Path count: 12" in report


@pytest.mark.slow
@pytest.mark.hard(55)
@pytest.mark.parametrize("format", FORMATS)
def test_readers_open_an_empty_drawing(empty, tmp_path, format, request):
    file = tmp_path / f"a.{format}"
    save(empty, file)
    if format in ("ps", "eps"):
        assert ghostscript(file, "-g1417x945", "-dFIXEDMEDIA").min() == 1.0
    elif format == "pdf":
        assert grey_of_pgm(run("pdftoppm", "-r", DPI, file)).min() == 1.0
    elif format == "svg":
        assert grey_of_png(run("rsvg-convert", "-b", "white", file)).min() == 1.0
        assert "Layer count: 0" in request.getfixturevalue("vpype_told")[0]
    elif format == "png":
        assert grey_of_png(file.read_bytes()).min() == 1.0


@pytest.mark.capability("G4.1-device")
@pytest.mark.parametrize("format", FORMATS)
def test_one_drawing_goes_to_every_device(sample, format):
    """Each device gets the drawing and nothing else."""
    starts = {
        "svg": b"<?xml",
        "ps": b"%!PS-Adobe-3.0\n",
        "eps": b"%!PS-Adobe-3.0 EPSF-3.0\n",
        "pdf": b"%PDF-1.",
        "png": b"\x89PNG",
        "tex": b"% A sample (of lines)\n\\begin{tikzpicture}",
        "dxf": b"  0\nSECTION\n",
        "json": b'{"format": "vectorplot-drawing"',
    }
    assert write(sample, format).startswith(starts[format])


@pytest.mark.capability("G4.1-device")
def test_svg_and_postscript_put_the_same_point_within_five_microns():
    """The coordinates in both files are those of the drawing."""
    random = np.random.default_rng(3)
    points = random.uniform((0.0, 0.0), (210.0, 297.0), (400, 2))
    drawing = drawing_of(paths_of(*points.reshape(-1, 2, 2)), width=210.0, height=297.0)
    y_down = points * (1, -1) + (0, 297)

    svg = ET.fromstring(write(drawing, "svg"))
    texts = [e.get("points").replace(",", " ").split() for e in svg.iter("{http://www.w3.org/2000/svg}polyline")]
    assert np.abs(np.array(texts, float).reshape(-1, 2) - y_down).max() <= 0.0005 + 1e-9

    body = write(drawing, "eps").decode().split("rectclip", 1)[1]
    found = re.findall(r"([\d.]+)\s+([\d.]+)\s+[ml]\b", body)
    height = np.ceil(297 * 72 / 25.4)
    error = np.abs((np.array(found, float) * (1, -1) + (0, height)) * 25.4 / 72.0 - points).max()
    print(f"largest error in PostScript {error:.5f} mm")
    assert error <= 0.005
