"""Formulas of TeX: mathematics is set everywhere, and nothing else gets to LaTeX."""

from __future__ import annotations

import pytest

from vectorplot.backends.tikz import latex
from vectorplot.drawing.formulas import without_formulas, without_formulas_in_strokes
from vectorplot.errors import InputError


@pytest.mark.parametrize(
    ("formula", "letters"),
    [
        (r"\alpha_1^2", "α₁²"),
        (r"\frac{a}{b}", "a/b"),
        (r"\mathbf{n}", "n"),
        (r"\vec{v}", "v\u20d7"),
        (r"\hat n \cdot \vec a_1", "n\u0302 · a\u20d7₁"),
        (r"\overline{AB}=\bar x", "A\u0304B\u0304=x\u0304"),
        (r"\tilde\alpha, \dot{\gamma}", "α\u0303, γ\u0307"),
        (r"\mathcal{F}\in\mathbb{R}^2", "F∈R²"),
        (r"\langle u\rangle", "⟨ u⟩"),
    ],
)
def test_the_usual_mathematics_is_set_by_strokes_and_by_latex(formula, letters):
    text = f"${formula}$"
    assert without_formulas(text) == without_formulas_in_strokes(text) == letters
    assert latex(text) == text


@pytest.mark.parametrize(
    ("formula", "letters", "in_fonts"),
    [
        (r"e^{3z}", "e³ᶻ", "e3z"),
        (r"x_{max}+v_{ij}^{(k)}", "xₘₐₓ+vᵢⱼ⁽ᵏ⁾", "xmax+vij(k)"),
        (r"\sigma^{\beta}_\rho", "σᵝᵨ", "σβρ"),
        (r"\vec{v}_b^q", "v\u20d7bq", "v\u20d7bq"),
    ],
)
def test_letters_are_high_and_low_in_strokes_where_fonts_may_not_have_them(formula, letters, in_fonts):
    assert without_formulas_in_strokes(f"${formula}$") == letters
    assert without_formulas(f"${formula}$") == in_fonts


def test_matrices_are_left_to_latex():
    text = r"$\begin{pmatrix} 1 & 0 \\ 0 & 1 \end{pmatrix}$"
    assert latex(text) == text
    with pytest.raises(InputError, match="no strokes for"):
        without_formulas_in_strokes(text)


@pytest.mark.hard(61)
@pytest.mark.parametrize(
    "formula",
    [
        r"\input{x}",
        r"\write18{ls}",
        r"\immediate\write18{ls}",
        r"\directlua{os.exit()}",
        r"x}\input{x}{",
        r"\csname input\endcsname",
        r"\catcode`\^=0",
        r"\def\a{b}",
        r"\end{tikzpicture}",
        r"\@@input x",
        "^^5cinput x",
        "a%b",
        r"a\\% b",
        r"a\\\\#b",
        r"a\\& b",
        "a#1",
        "a&b",
        "x}{",
        "{x",
        "a\nb",
        r"\begin{verbatim}",
    ],
)
@pytest.mark.parametrize("setter", [latex, without_formulas, without_formulas_in_strokes])
def test_what_is_no_mathematics_is_refused_in_one_line(formula, setter):
    with pytest.raises(InputError) as caught:
        setter(f"${formula} $")
    assert "\n" not in str(caught.value) and "formula" in str(caught.value)
