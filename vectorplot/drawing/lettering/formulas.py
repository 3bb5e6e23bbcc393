"""Formulas of TeX in labels, where nobody sets them: the letters and signs that they name."""

from __future__ import annotations

import re

from vectorplot.errors import InputError

FORMULA = re.compile(r"(?<!\\)\$([^$]+)(?<!\\)\$")
"""A formula of TeX between dollars."""

_GREEK = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho varsigma sigma tau upsilon"
    " phi chi psi omega"
)
_NAMED = "times cdot le leq ge geq neq pm mp infty perp parallel angle circ in to cup cap partial nabla approx"
_LETTERS = dict(zip(_GREEK.split(), "αβγδεζηθικλμνξοπρςστυφχψω", strict=True))
_SIGNS = {
    **_LETTERS,
    **{name.capitalize(): letter.upper() for name, letter in _LETTERS.items()},
    **dict(zip(_NAMED.split(), "×·≤≤≥≥≠±∓∞⊥∥∠°∈→∪∩∂∇~", strict=True)),
    **{"varepsilon": "ε", "varphi": "φ", "vartheta": "θ", "sqrt": "√", "quad": " ", "left": "", "right": ""},
}
_UPRIGHT = frozenset(("mathrm", "text", "textrm", "operatorname"))
"""What asks for letters as they are."""

_FUNCTIONS = frozenset(
    "sin cos tan cot sec csc arcsin arccos arctan sinh cosh tanh log ln lg exp min max sup inf lim det dim arg".split()
)
"""Words that are written as they are called."""

_WORD = re.compile(r"\\([A-Za-z]+)")

_HIGH = str.maketrans("0123456789+-n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ")
_LOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_FRACTION = re.compile(r"\\frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}")
_RAISED = re.compile(r"([\^_])(?:\{([^{}]*)\}|(\S))")


def without_formulas(text: str) -> str:
    r"""The text with formulas in plain letters: ``$\alpha_1^2$`` is α₁²; \$ is a dollar. What has no such letters,
    roots and matrices, loses its form."""
    return FORMULA.sub(lambda formula: _letters(formula.group(1)), text).replace(r"\$", "$")


def without_formulas_in_strokes(text: str) -> str:
    r"""The same for letters that nobody else can set. Errors: InputError for words of TeX that have no such letters."""
    for formula in FORMULA.findall(text):
        for word in _WORD.findall(formula):
            if word not in _SIGNS and word not in _FUNCTIONS and word not in _UPRIGHT and word != "frac":
                raise InputError(f"there are no strokes for \\{word} of the formula ${formula}$")
    return without_formulas(text)


def _letters(formula: str) -> str:
    found = _FRACTION.sub(r"\1/\2", formula)
    found = re.sub(r"\\([A-Za-z]+)( ?)", _sign, found)
    found = _RAISED.sub(_raised, re.sub(r"\\[^A-Za-z]", " ", found))
    return re.sub(r"[{}]", "", found).strip()


def _sign(word: re.Match[str]) -> str:
    name, blank = word.groups()
    if name in _UPRIGHT:
        return ""
    return _SIGNS[name] + blank if name in _SIGNS else f"{name} "


def _raised(part: re.Match[str]) -> str:
    inner = part.group(2) or part.group(3) or ""
    made = inner.translate(_HIGH if part.group(1) == "^" else _LOW)
    return made if not set(made) & set(inner) else inner
