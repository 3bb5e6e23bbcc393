"""Fonts of choice: named in files, or held by them."""

from __future__ import annotations

import base64
import re
import subprocess
from pathlib import Path

import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.geometry import box
from vectorplot.save import write

SCENE = vp.Scene((vp.Item("box", box((1.0, 2.0, 1.0))),), labels=(vp.Label("Ab", (0.0, 0.0, 0.0)),), title="Box")


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_svg_names_the_family_and_other_texts_have_none(verb) -> None:
    drawing = verb(SCENE, "front", text="real", font="TeX Gyre Termes", page="60x50", title="T")
    text = write(drawing, "svg").decode()
    assert len(re.findall(r"font-family=\"'TeX Gyre Termes', Helvetica", text)) == text.count("<text") == 2
    assert write(vp.panels([drawing, drawing], text="real"), "svg").decode().count("'TeX Gyre Termes'") == 6
    assert "Termes" not in write(verb(SCENE, "front", text="real"), "svg").decode()


def test_svg_holds_a_file_of_a_font(tmp_path: Path) -> None:
    font = tmp_path / "Own Font.ttf"
    font.write_bytes(b"\0\1\0\0 of no use, but all of it")
    text = write(vp.draw(SCENE, "front", text="real", font=str(font)), "svg").decode()
    (held,) = re.findall(r"url\(data:font/ttf;base64,([A-Za-z0-9+/=]+)\)", text)
    assert base64.b64decode(held) == font.read_bytes() and "font-family=\"'Own Font', " in text
    with pytest.raises(InputError, match=r"a file is for \.svg"):
        write(vp.draw(SCENE, "front", text="real", font=str(font)), "pdf")


@pytest.mark.slow
def test_pdf_holds_the_letters_it_uses(tmp_path: Path) -> None:
    vp.draw(SCENE, "front", text="real", font="DejaVu Serif").save(tmp_path / "box.pdf")
    fonts = subprocess.run(["pdffonts", tmp_path / "box.pdf"], capture_output=True, text=True, check=True).stdout
    assert re.search(r"\+DejaVu-?Serif\S* .* yes yes", fonts), fonts


@pytest.mark.parametrize("font", ["", "a'b", "Times\nRoman", "<b>", "no.ttf", "x;y"])
def test_what_is_no_font_is_told(font: str) -> None:
    with pytest.raises(InputError, match="font"):
        vp.draw(SCENE, "front", text="real", font=font)


def test_strokes_have_no_font() -> None:
    with pytest.raises(InputError, match="letters are strokes"):
        vp.draw(SCENE, "front", font="Times")
