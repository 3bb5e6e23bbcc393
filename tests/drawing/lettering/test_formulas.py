"""Formulas between dollars: mathematics in every kind of letters, and nothing else for LaTeX."""

from __future__ import annotations

import pytest

from vectorplot.backends.tikz.nodes import latex
from vectorplot.drawing.lettering.formulas import without_formulas
from vectorplot.drawing.lettering.labels.label_letters import LETTERS
from vectorplot.errors import InputError


@pytest.mark.parametrize(
    ("formula", "letters"),
    [
        (r"\mathbf{n}", "n"),
        (r"\vec{\mathbf{n}}", "n\u20d7"),
        (r"\hat n_1", "n\u0302₁"),
        (r"\overline{AB}", "A\u0304B\u0304"),
        (r"\dot{x}^2", "x\u0307²"),
        (r"\tilde\alpha", "α\u0303"),
        (r"x_{\bar{y}}", "xy\u0304"),
        (r"\langle\mathcal{A}\rangle", "<A>"),
        (r"\mathbb{R}^3", "R³"),
    ],
)
def test_usual_mathematics_is_lettered_everywhere(formula, letters):
    text = f"${formula}$"
    assert without_formulas(text) == letters
    strokes = LETTERS["strokes"].plain(text, size_mm=3.0)
    assert strokes.bounds.tolist() == LETTERS["strokes"].plain(letters, size_mm=3.0).bounds.tolist()
    assert latex(text) == text


@pytest.mark.parametrize(
    "formula",
    [
        *(rf"\{word} x" for word in "input include write18 directlua openin read csname def catcode loop par".split()),
        r"x}\input{a",
        r"}x{",
        "{x",
        "^^5cinput a",
        "a%b",
        "#1",
        "a&b",
        r"a\\b",
        "a\nb",
        r"\text{\immediate\write18{ls}}",
    ],
)
def test_latex_is_given_nothing_but_mathematics(formula):
    with pytest.raises(InputError, match="formula") as refused:
        latex(f"as ${formula}$ says")
    assert "\n" not in str(refused.value)
