"""Real text in every format, as its readers see it."""

from __future__ import annotations

import subprocess
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from support.backend_samples import run

import vectorplot as vp
from vectorplot.backends.tikz import latex
from vectorplot.drawing import typeset, typeset_along
from vectorplot.drawing.formulas import without_formulas
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import box
from vectorplot.save import write

WORDS = ("<A & B>", "100% \\ {x}_1^2 ~ #7", "Größe: α ≤ π/2", "%%c", "東京")


@pytest.fixture(scope="module")
def labelled():
    labels = [vp.Label(word, vp.OnPage(20, 20 + 8 * k)) for k, word in enumerate(WORDS)]
    labels.append(vp.Label("behind", (0, 1, 0), hidden="dashed"))
    scene = vp.Scene((vp.Item("box", box((1, 1, 1))),), labels=tuple(labels))
    return vp.draw(scene, vp.Camera((6, -5, 4)), page=vp.Page(100, 80), text="real", title="Letters", frame=True)


def test_strokes_are_what_letters_are_unless_told_otherwise():
    scene = vp.Scene((vp.Item("box", box((1, 1, 1))),), labels=(vp.Label("A", (0, 0, 1)),))
    strokes, real = vp.draw(scene), vp.draw(scene, text="real")
    assert not any(layer.texts for layer in strokes.layers)
    assert [text.strings for layer in real.layers for text in layer.texts] == [("A",)]
    # Both stand in the same place, and lines end before both.
    (text,) = (text for layer in real.layers for text in layer.texts)
    letters = strokes.layers[-1].strokes[0].points
    assert (text.points[0, 1] == pytest.approx(letters[:, 1].min())) and len(real.layers) == len(strokes.layers)
    drawn = [[len(paths) for layer in one.layers[:-1] for paths in layer.strokes] for one in (strokes, real)]
    assert drawn[0] == drawn[1]


def test_labels_keep_their_distance_in_whatever_font():
    labels = [vp.Label(p, (0, 0, 0), place=p, name=p) for p in ("right", "left", "above")]
    drawing = vp.draw(vp.Scene((vp.Item("box", box((1, 1, 1))),), labels=tuple(labels)), text="real")
    (texts,) = drawing.layers[-1].texts
    assert dict(zip(texts.strings, texts.anchor.tolist(), strict=True)) == {"right": 0.0, "left": 1.0, "above": 0.5}


def test_svg_has_text_elements(labelled):
    root = ET.fromstring(write(labelled, "svg"))
    found = [one.text for one in root.iter("{http://www.w3.org/2000/svg}text")]
    assert found == [*WORDS, "behind", "Letters"]
    colours = [one.get("fill") for one in root.iter("{http://www.w3.org/2000/svg}text")]
    assert colours[5] == "#7f7f7f" and set(colours[:5]) == {"#000000"}


def test_letters_can_be_searched_in_pdf(labelled, tmp_path):
    (tmp_path / "a.pdf").write_bytes(write(labelled, "pdf"))
    text = run("pdftotext", tmp_path / "a.pdf", "-").decode()
    assert all(word in text for word in (WORDS[0], WORDS[1], WORDS[2], "behind", "Letters"))
    assert write(labelled, "pdf") == write(labelled, "pdf")
    (tmp_path / "a.ps").write_bytes(write(labelled, "ps"))
    assert b"Letters" in run("gs", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=txtwrite", "-o", "-", tmp_path / "a.ps")


def test_dxf_has_texts_as_high_as_capitals(labelled, tmp_path):
    import ezdxf

    (tmp_path / "a.dxf").write_bytes(write(labelled, "dxf"))
    document = ezdxf.readfile(tmp_path / "a.dxf")
    texts = document.modelspace().query("TEXT")
    assert [one.plain_text() for one in texts] == [*WORDS, "behind", "Letters"]
    assert texts[0].dxf.height == pytest.approx(3.5, abs=1e-3) and not document.audit().errors


def test_json_gives_texts_back(labelled, tmp_path):
    vp.save(labelled, tmp_path / "a.json")
    (back,) = vp.read(tmp_path / "a.json").layers[-1].texts
    given = Texts.joined([texts for layer in labelled.layers for texts in layer.texts])
    assert back.strings == given.strings
    for name in ("points", "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by"):
        assert np.array_equal(getattr(back, name), getattr(given, name)), name
    bad = write(labelled, "json").replace(b'"anchor": 0.5', b'"anchor": 3')
    (tmp_path / "b.json").write_bytes(bad)
    with pytest.raises(InputError, match="anchor"):
        vp.read(tmp_path / "b.json")


@pytest.mark.slow
def test_latex_sets_letters_over_a_pdf(labelled, tmp_path):
    other = [vp.Label("$\\alpha_1^2$ & more", vp.OnPage(20, 70)), vp.Label("n⃗ x² Ω", vp.OnPage(20, 60))]
    scene = vp.Scene((vp.Item("b", box((1, 1, 1))),), labels=tuple(other))
    drawing = vp.draw(scene, page=vp.Page(100, 80), text="real")
    vp.save_for_latex(drawing, tmp_path / "over_it.pdf")
    shown = write(labelled, "tex").replace("東京".encode(), b"Tokyo")
    (tmp_path / "whole.tex").write_bytes(shown)
    (tmp_path / "a.tex").write_text(
        "\\documentclass{article}\\usepackage{tikz}\\usepackage[paperwidth=100mm,paperheight=80mm,margin=0mm]{geometry}"
        "\\pagestyle{empty}\\parindent0pt\\begin{document}\\input{over_it}\\newpage\\input{whole}\\end{document}"
    )
    latex = ["pdflatex", "-interaction=batchmode", "-halt-on-error", "a.tex"]
    subprocess.run(latex, cwd=tmp_path, check=True, capture_output=True, timeout=600)
    text = run("pdftotext", tmp_path / "a.pdf", "-").decode()
    assert "& more" in text and "α" in text
    assert all(word in text for word in ("A & B", "100% \\ {x}", "#7", "Tokyo", "behind", "Letters"))
    # No letter is in the picture itself.
    assert not run("pdftotext", tmp_path / "over_it.pdf", "-").strip()


def test_the_box_of_an_eps_under_letters_is_the_page(tmp_path):
    drawing = vp.draw(vp.Scene((vp.Item("b", box((1, 1, 1))),), labels=(vp.Label("A", (0, 0, 1)),)), text="real")
    vp.save_for_latex(drawing, tmp_path / "a.eps")
    assert b"%%BoundingBox: 0 0 596 842" in (tmp_path / "a.eps").read_bytes()
    assert "\\includegraphics[hiresbb]{\\detokenize{a.eps}}" in (tmp_path / "a.tex").read_text()
    with pytest.raises(InputError, match="set by LaTeX"):
        vp.save_for_latex(drawing, tmp_path / "a.svg")


@pytest.mark.parametrize(
    ("text", "set_"),
    [
        ("a_b", "a\\_b"),
        ("$a_b$ & c", "$a_b$ \\& c"),
        ("5 $", "5 \\$"),
        (r"\$5 and \$6", r"\$5 and \$6"),
        ("x²y", r"x\textsuperscript{2}y"),
    ],
)
def test_only_formulas_are_code(text, set_):
    assert latex(text) == set_


def test_letters_along_a_curve_are_texts_of_their_own():
    path = [(0, 0), (30, 0), (60, 30)]
    word = typeset_along("Inn and", path).texts
    assert word.strings == tuple("Innand") and set(word.anchor) == {0.5}
    assert (word.turn_deg >= 0.0).all() and word.turn_deg[0] == 0.0 and word.turn_deg[-1] == pytest.approx(45.0)
    assert typeset_along("$x^2$", path).texts.strings == ("$x^2$",)


def test_room_is_that_of_strokes():
    from vectorplot.drawing import lettered

    for text in ("Ab", "Two\nlines", ""):
        assert np.allclose(typeset(text, (3, 4), align="centre").boxes, lettered(text, (3, 4), align="centre").boxes)


@pytest.mark.parametrize(
    ("formula", "plain"),
    [
        (r"$\alpha_1^2$ & 5 %", "α₁² & 5 %"),
        (r"$e = \frac{\sin\varepsilon}{\sin\alpha} < 1$", "e = sin ε/sin α < 1"),
        (r"$x_{max}$, \$5", "xmax, $5"),
        ("5 $", "5 $"),
    ],
)
def test_formulas_that_nobody_sets_are_plain_letters(formula, plain):
    assert without_formulas(formula) == plain
