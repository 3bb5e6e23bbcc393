"""Pictures for LaTeX, as LaTeX sets them."""

from __future__ import annotations

import re
import subprocess

import numpy as np
import pytest
from PIL import Image

import vectorplot as vp
from vectorplot.backends.cairo import drawing_pixels
from vectorplot.backends.json import read_drawing
from vectorplot.backends.page import page_marks
from vectorplot.backends.tikz import tikz_bytes
from vectorplot.errors import InputError
from vectorplot.save import write_for_latex
from vectorplot.surfaces import Cylinder, Sphere

DOCUMENT = (
    "\\documentclass{article}\\usepackage[paperwidth=%gmm,paperheight=%gmm,margin=0mm]{geometry}\\usepackage{tikz}"
    "\\parindent0pt\\topskip0pt\\pagestyle{empty}"
    "\\begin{document}\\hbox{\\vbox to 0pt{\\input{picture.tex}\\vss}}\\end{document}"
)


def set_by_latex(drawing, folder):
    """The page at 150 dpi as LaTeX sets it, and what it complains about."""
    (folder / "picture.tex").write_bytes(tikz_bytes(drawing))
    (folder / "document.tex").write_text(DOCUMENT % (drawing.width_mm, drawing.height_mm), encoding="ascii")
    latex = ["pdflatex", "-interaction=batchmode", "-halt-on-error", "document.tex"]
    subprocess.run(latex, cwd=folder, check=True, capture_output=True, timeout=600)
    poppler = ["pdftoppm", "-r", "150", "-singlefile", "document.pdf", "page"]
    subprocess.run(poppler, cwd=folder, check=True, timeout=600)
    log = (folder / "document.log").read_text(encoding="latin-1")
    return np.asarray(Image.open(folder / "page.ppm")).astype(int), log


def like_ours(drawing, seen):
    """The part of pixels that differ much from our own."""
    ours = drawing_pixels(drawing).astype(int)
    height, width = min(ours.shape[0], seen.shape[0]), min(ours.shape[1], seen.shape[1])
    assert max(abs(ours.shape[k] - seen.shape[k]) for k in range(2)) <= 1
    return float((np.abs(ours[:height, :width] - seen[:height, :width]).max(axis=2) > 128).mean())


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pencil", "curves"])
def test_latex_sets_lines_in_their_size_and_place(name, tmp_path):
    drawing = vp.draw(vp.read(f"data/{name}.scene"), page=vp.Page(148, 105, 10), hidden="dashed")
    seen, log = set_by_latex(drawing, tmp_path)
    assert like_ours(drawing, seen) < 2e-4 and "Overfull" not in log
    assert (seen.min(axis=2) < 128).mean() > 1e-3


def _balls_and_cans():
    ball, can = Sphere(1.0), Cylinder(1.0, 0.0, 2.0)
    cans = [vp.Item(f"CAN {k}", can).turned("y", 20.0 + 60.0 * k).moved(3.0 * k, 0.0, 0.0) for k in (1, 2, 3)]
    mirrored = cans[0].scaled(1.0, -1.0, 1.0).moved(-6.0, 0.0, 0.0)
    return vp.Scene((vp.Item("BALL", ball), *cans, mirrored))


@pytest.mark.slow
def test_arcs_end_where_their_strokes_do():
    drawing = vp.draw(_balls_and_cans(), "iso", page=vp.Page(120, 90, 10), hidden="solid")
    (ink, *more) = page_marks(drawing).inks
    parts = [part for one in (ink, *more) for part in one.parts]
    ends = [part.microns[part.offsets[1:][part.arcs.stroke] - 1] / 1000.0 for part in parts]
    closed = np.concatenate([part.closed[part.arcs.stroke] for part in parts])
    wanted = np.concatenate(ends)[~closed]
    number = r"(-?[0-9.]+)"
    found = []
    for x, y, _, turn, start, end, radii in re.findall(
        rf"draw \({number},{number}\) ({{\[rotate={number}\] )?arc\[start angle={number},end angle={number},(.*?)\]",
        tikz_bytes(drawing).decode("ascii"),
    ):
        a, *b = map(float, re.findall(number, radii))
        t, tilt = np.radians([float(start), float(end)]), np.radians(float(turn or 0.0))
        (dx, dy) = a * np.diff(np.cos(t)), (b or [a])[0] * np.diff(np.sin(t))
        way = np.concatenate([dx * np.cos(tilt) - dy * np.sin(tilt), dx * np.sin(tilt) + dy * np.cos(tilt)])
        found.append(np.add(way, (float(x), float(y))))
    assert len(found) == len(wanted) > 6 and closed.any()
    np.testing.assert_allclose(found, wanted, atol=2e-3)


@pytest.mark.slow
def test_latex_sets_arcs_where_other_formats_have_them(tmp_path):
    drawing = vp.draw(_balls_and_cans(), "iso", page=vp.Page(120, 90, 10), hidden="solid")
    seen, _ = set_by_latex(drawing, tmp_path)
    assert like_ours(drawing, seen) < 2e-4


@pytest.mark.slow
def test_latex_sets_filled_polygons_and_what_is_seen_through_them(tmp_path):
    box = vp.Mesh.from_triangles(
        [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    glass = vp.Material("transparent", opacity=0.4)
    scene = vp.Scene((vp.Item("A", box, "red"), vp.Item("B", box.moved(0.5, -0.5, 0.2), "blue", material=glass)))
    drawing = vp.paint(scene, vp.Camera((6, -9, 5), (1, 0, 1)), page=vp.Page(100, 80, 5))
    seen, _ = set_by_latex(drawing, tmp_path)
    assert like_ours(drawing, seen) < 2e-4
    assert len(np.unique(seen @ (1 << 16, 1 << 8, 1))) > 8


@pytest.mark.slow
def test_long_lines_are_several_paths_that_go_on_in_each_other(tmp_path):
    t = np.linspace(0.0, 40.0 * np.pi, 4000)
    points = np.stack([100.0 + t * np.cos(t) / 2.0, 100.0 + t * np.sin(t) / 2.0], axis=1)
    none, one = np.zeros(1, dtype=np.intp), np.array([0, len(points)])
    spiral = vp.Paths(points, one, none > 0, none, none, none, np.zeros((len(points), 3)))
    drawing = vp.Drawing(200.0, 200.0, (vp.Layer("% \\end{x} ü", vp.Pen(0.3, "#0000ff"), (spiral,)),), title="a%\\b\nc")
    text = tikz_bytes(drawing).decode("ascii")
    assert text.count("\\draw") == 4 and max(map(len, text.split("\n"))) < 400
    seen, _ = set_by_latex(drawing, tmp_path)
    assert like_ours(drawing, seen) < 2e-4


@pytest.mark.slow
def test_an_empty_picture_has_its_size_and_a_page_that_is_too_large_is_refused(tmp_path):
    seen, _ = set_by_latex(vp.Drawing(80.0, 60.0, ()), tmp_path)
    assert seen.min() == 255 and abs(seen.shape[1] - 80 / 25.4 * 150) <= 1
    with pytest.raises(InputError, match="TeX takes at most 5000 mm"):
        tikz_bytes(vp.Drawing(6000.0, 60.0, ()))


WIDTHS = (
    "\\documentclass{article}\\usepackage{tikz}\\begin{document}\\parindent0pt"
    "\\setbox0\\hbox{\\input{picture.tex}}\\setbox1\\hbox{\\small S}"
    "\\newlength\\wanted\\setlength\\wanted{%s}\\typeout{WIDTHS \\the\\wd0 \\the\\wanted}"
    "\\copy0\\input{picture.tex}\\end{document}"
)


def widths_in_latex(drawing, wanted, folder):
    """The width of the box that LaTeX sets a drawing in, and a length that it knows, both in points; its log."""
    (folder / "picture.tex").write_bytes(tikz_bytes(drawing))
    (folder / "document.tex").write_text(WIDTHS % wanted, encoding="ascii")
    latex = ["pdflatex", "-interaction=batchmode", "-halt-on-error", "document.tex"]
    subprocess.run(latex, cwd=folder, check=True, capture_output=True, timeout=600)
    log = (folder / "document.log").read_text(encoding="latin-1")
    return [float(width) for width in re.search(r"WIDTHS ([0-9.]+)pt([0-9.]+)pt", log).groups()], log


@pytest.mark.slow
@pytest.mark.parametrize(("width", "wanted"), [("115pt", "115pt"), (r"0.3\textwidth", r"0.3\textwidth")])
def test_a_figure_takes_its_width_and_no_blank_more(width, wanted, tmp_path):
    (found, right), log = widths_in_latex(vp.draw(SIGNED, width=width, text="real"), wanted, tmp_path)
    assert found == pytest.approx(right, abs=2e-3) and "Overfull" not in log


SIGNED = vp.Scene(
    (vp.Item("A", vp.Mesh.from_triangles([(0, 0, 0), (2, 0, 0), (0, 0, 2)], [(0, 1, 2)])),),
    labels=(vp.Label("P", (2, 0, 0), size_mm=r"\small"), vp.Label("Q", (0, 0, 2), size_mm="10pt")),
    page=vp.Page(80.0, 60.0, 2.0),
)


def test_lengths_are_parts_of_a_width_of_latex_and_letters_are_not():
    drawing = vp.draw(SIGNED, "front", width=r"0.8\linewidth", text="real")
    text = tikz_bytes(drawing).decode("ascii")
    assert drawing.width_mm == pytest.approx(0.8 * 345 * 25.4 / 72.27)
    assert f"[x={{0.8\\linewidth/{drawing.width_mm:.10g}}},y={{0.8\\linewidth/{drawing.width_mm:.10g}}}," in text
    assert "(0,0) rectangle (0.8\\linewidth," in text and text.endswith("\\end{tikzpicture}%\n")
    assert "font=\\small]" in text and "font=\\fontsize{10}{12}\\selectfont]" in text
    picture, over = write_for_latex(drawing, "pdf", "fig.pdf")
    assert b"\\includegraphics[width=0.8\\linewidth]{" in over and b"x={0.8\\linewidth/" in over
    assert b"/S /Transparency" not in picture and over.endswith(b"\\end{tikzpicture}%\n")
    # As numbers they are what article has.
    assert tikz_bytes(vp.draw(SIGNED, "front", width="276pt", text="real")).count(b"linewidth") == 0


def test_words_of_latex_come_through_json_and_others_do_not(tmp_path):
    file = tmp_path / "signed.json"
    vp.draw(SIGNED, "front", text="real").save(file)
    assert tikz_bytes(read_drawing(file)).count(b"font=\\small]") == 1
    content = file.read_text()
    assert '"latex": "\\\\small"' in content
    file.write_text(content.replace('"latex": "\\\\small"', '"latex": "\\\\input{x}"'))
    with pytest.raises(InputError, match="a size of"):
        read_drawing(file)
