"""Text as polylines: what there are letters for, how large they are, and where they stand."""

from __future__ import annotations

import unicodedata

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.drawing.letters import lettered
from vectorplot.drawing.text_along import lettered_along
from vectorplot.geometry import box

ASCII = "".join(map(chr, range(33, 127)))
LATIN = "".join(c for c in map(chr, range(0xC0, 0x180)) if c.isalpha())
MISSING = "ÐÞðþĸŉŊŋŦŧĿŀſŲų"
GREEK = "ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩαβγδεζηθικλμνξοπρστυφχψωςάέήίόύώΐ"
CYRILLIC = "".join(map(chr, range(0x410, 0x450)))
SIGNS = "±×·÷≤≥≠∞→↑←↓∂∇∫√∠∥⊥∈°′″…–—−“”‘’„«»⌀µ½²³¹⁰ⁿ₀₁₂€£§•⌴⌵↧□"


@pytest.mark.parametrize("alphabet", [ASCII, GREEK, CYRILLIC, SIGNS], ids=["ascii", "greek", "cyrillic", "signs"])
def test_every_character_has_strokes_within_reach_of_its_line(alphabet: str) -> None:
    for character in alphabet:
        points = lettered(character, size_mm=21.0).strokes.points
        assert len(points) and -12.0 <= points[:, 1].min() and points[:, 1].max() <= 30.0, character


def test_latin_letters_have_their_accents() -> None:
    for character in set(LATIN) - set(MISSING):
        base = unicodedata.normalize("NFD", character)
        letter = lettered(character)
        assert len(letter), character
        if len(base) > 1 and base[0] not in "ij":
            assert len(letter) > len(lettered(base[0])), character
            assert len(letter) == len(lettered(base)), character


def test_dots_of_i_and_j_give_way_to_accents() -> None:
    assert len(lettered("í")) == len(lettered("i"))
    assert lettered("ı", size_mm=21.0).strokes.points[:, 1].max() == pytest.approx(14.0)


@pytest.mark.parametrize("text", ["漢", "①", "ℝ", "a\tb", "x\u0488", "\x07"])
def test_an_unknown_character_is_one_clear_line(text: str) -> None:
    with pytest.raises(vp.InputError, match=r"^there are no strokes for the character .* \(.*U\+[0-9A-F]{4}\)$"):
        lettered(text)


def test_fractions_and_numero_signs_keep_their_form() -> None:
    half, number = (lettered(sign, size_mm=21.0) for sign in "½№")
    assert half.boxes[0, 1, 0] < lettered("1/2", size_mm=21.0).boxes[0, 1, 0] and len(half) == 3
    assert np.allclose(number.strokes.points, lettered("Nº", size_mm=21.0).strokes.points)


@pytest.mark.parametrize("word", ["sum", "oint", "underline"])
def test_words_of_formulas_without_letters_are_refused_where_letters_are_strokes(word: str) -> None:
    label = vp.Label(f"$x \\in \\{word}{{R}}$", (0, 0, 0))
    scene = vp.Scene((vp.Item("BOX", box((1, 1, 1))),), labels=(label,))
    with pytest.raises(vp.InputError, match=rf"there are no strokes for \\{word} of the formula"):
        vp.draw(scene)
    assert vp.draw(scene, text="real").layers


@pytest.mark.parametrize("size", [0.0, -1.0, np.nan, np.inf])
def test_sizes_are_positive(size: float) -> None:
    with pytest.raises(vp.InputError, match="a size of"):
        lettered("A", size_mm=size)


@pytest.mark.parametrize("turn", [0.0, 30.0, 90.0, 200.0])
@pytest.mark.parametrize("size", [1e-6, 3.5, 1e6])
def test_size_place_and_turn_act_on_all_of_a_text(size: float, turn: float) -> None:
    text, at = "Two\nlines: é", np.array([3.0, -2.0]) * size
    plain = lettered(text, align="right", level="middle")
    turned = lettered(text, at, size_mm=size, align="right", level="middle", rotation_deg=turn)
    angle = np.radians(turn)
    matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    expected = plain.strokes.points * (size / 3.5) @ matrix.T + at
    assert np.allclose(turned.strokes.points, expected, rtol=0.0, atol=1e-9 * size)
    assert np.allclose(turned.boxes, plain.boxes * (size / 3.5) @ matrix.T + at, rtol=0.0, atol=1e-9 * size)


def test_alignment_and_levels_say_what_is_at_the_point() -> None:
    for align, x in (("left", 0), ("right", 1)):
        assert lettered("Text", align=align).bounds[x, 0] == pytest.approx(0.0)  # type: ignore[arg-type]
    for level, y in (("bottom", 0), ("top", 1)):
        assert lettered("Text\n(and more)", level=level).bounds[y, 1] == pytest.approx(0.0, abs=0.1)  # type: ignore[arg-type]
    middle = lettered("HI\nI H", align="centre", level="middle")
    assert middle.bounds.mean(axis=0)[0] == pytest.approx(0.0)
    assert np.ptp(middle.strokes.points[:, 1]) == pytest.approx(2.0 * middle.strokes.points[:, 1].max())
    assert lettered("EH").strokes.points[:, 1].min() == 0.0


def test_letters_lie_in_their_boxes_and_follow_one_another() -> None:
    found = lettered("MWAgjp|ÄQ@" * 3)
    low, high = found.bounds
    points = found.strokes.points
    assert (points[:, 0] >= low[0]).all() and (points[:, 0] <= high[0]).all()
    assert (points[:, 1] >= low[1] - 1e-12).all() and (points[:, 1] <= high[1] + 1e-12).all()
    starts = points[found.strokes.offsets[:-1], 0]
    assert (np.diff(starts) > -3.5).all()


@pytest.mark.parametrize("text", ["", " ", "\n\n", " \n "])
def test_blanks_have_no_strokes(text: str) -> None:
    found = lettered(text)
    assert len(found) == 0 and np.isfinite(found.bounds).all()


def test_a_text_along_a_straight_line_is_the_plain_text() -> None:
    along = lettered_along("Straight on", [(0.0, 5.0), (10.0, 5.0), (100.0, 5.0)], level="base")
    plain = lettered("Straight on", (50.0, 5.0), align="centre")
    assert np.allclose(along.strokes.points, plain.strokes.points, rtol=0.0, atol=1e-12)


def test_a_text_along_a_curve_is_never_upside_down() -> None:
    angle = np.linspace(0.1, 2.9, 60)
    arc = 40.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    one, other = lettered_along("arc", arc, at=0.4), lettered_along("arc", arc[::-1], at=0.6)
    assert np.allclose(one.strokes.points, other.strokes.points)
    middle = one.boxes.mean(axis=1)
    assert (np.diff(middle[:, 0]) > 0.0).all()
    assert np.hypot(*middle.T) == pytest.approx([40.0] * 3, abs=1.0)


@pytest.mark.parametrize("path", [[], [(1.0, 1.0)], [(1.0, 1.0), (1.0, 1.0)], [(0.0, 0.0), (np.nan, 1.0)]])
def test_a_text_along_nothing_is_refused(path: list[tuple[float, float]]) -> None:
    with pytest.raises(vp.InputError, match="the curve has no length"):
        lettered_along("A", path)


@pytest.mark.parametrize("lean_deg", [-14.0, -1.0, 0.0, 1.0, 14.0])
@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_nearly_upright_texts_along_lines_are_read_from_the_right(lean_deg, way):
    up = np.array([np.sin(np.radians(lean_deg)), np.cos(np.radians(lean_deg))])
    middles = lettered_along("20", 15.0 * way * np.array([-up, up])).boxes.mean(axis=1)
    across, along = np.diff(middles, axis=0)[0]
    assert across * up[1] == pytest.approx(along * up[0], abs=1e-9)
    assert middles[1, 1] > middles[0, 1]
    # Others begin on the left, as always.
    slanted = np.array([np.sin(np.radians(17.0)), -np.cos(np.radians(17.0))])
    middles = lettered_along("20", 15.0 * way * np.array([-slanted, slanted])).boxes.mean(axis=1)
    assert middles[1, 0] > middles[0, 0]
