"""Formulas of TeX in labels, where nobody sets them: the letters and signs that they name."""

from __future__ import annotations

import re

from vectorplot.errors import InputError, printable

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
    **{
        "langle": "<",
        "rangle": ">",
        "qquad": "  ",
        "vert": "|",
        "mid": "|",
        "prime": "′",
        "ldots": "...",
        "dots": "...",
    },
}
_ACCENTS = {
    **{"hat": "\u0302", "widehat": "\u0302", "tilde": "\u0303", "widetilde": "\u0303"},
    **{"bar": "\u0304", "overline": "\u0304", "dot": "\u0307", "ddot": "\u0308"},
    **{"vec": "\u20d7", "overrightarrow": "\u20d7"},
}
"""What stands over the letters that follow."""

_UPRIGHT = frozenset(
    "mathrm text textrm operatorname mathbf boldsymbol mathit mathsf mathcal mathbb mathfrak displaystyle".split()
)
"""What asks for letters of another kind, which strokes have not: they stay as they are."""

_FUNCTIONS = frozenset(
    "sin cos tan cot sec csc arcsin arccos arctan sinh cosh tanh log ln lg exp min max sup inf lim det dim arg".split()
)
"""Words that are written as they are called."""

_DRAWN = frozenset((*_SIGNS, *_ACCENTS, *_FUNCTIONS, *_UPRIGHT, "frac"))
"""The words that become letters."""

_SET = _DRAWN | frozenset(
    "dfrac tfrac binom underline overbrace underbrace sum prod int oint iint limits equiv propto sim simeq cong ll gg"
    " subset subseteq supset supseteq notin ni emptyset forall exists neg land lor wedge vee oplus ominus otimes oslash"
    " odot ast star bullet div setminus mapsto rightarrow leftarrow leftrightarrow Rightarrow Leftarrow Leftrightarrow"
    " uparrow downarrow implies iff gets colon triangle diamond surd dagger ell hbar Re Im aleph lvert rvert lVert"
    " rVert Vert lfloor rfloor lceil rceil cdots vdots ddots varrho varpi not mathring check breve acute grave stackrel"
    " big Big bigg Bigg bigl bigr Bigl Bigr bmod pmod mod top bot models vdash hom ker gcd Pr coth".split()
)
"""The words that LaTeX may be given: mathematics, and nothing that reads, writes, runs or defines anything."""

_WORD = re.compile(r"\\([A-Za-z]+)")

_HIGH = str.maketrans("0123456789+-n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ")
_LOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_FRACTION = re.compile(r"\\frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}")
_RAISED = re.compile(r"([\^_])(?:\{([^{}]*)\}|(\S))")

_TWICE = re.compile(r"\{\s*\{([^{}]*)\}\s*\}")
_ACCENTED = re.compile("([" + "".join(sorted(set(_ACCENTS.values()))) + r"])\s*(?:\{([^{}]*)\}|(\S))")


def without_formulas(text: str) -> str:
    r"""The text with formulas in plain letters: ``$\alpha_1^2$`` is α₁²; \$ is a dollar. What has no such letters,
    roots and matrices, loses its form."""
    return FORMULA.sub(lambda formula: _letters(formula.group(1)), text).replace(r"\$", "$")


def without_formulas_in_strokes(text: str) -> str:
    r"""The same for letters that nobody else can set. Errors: InputError for words of TeX that have no such letters."""
    for formula in FORMULA.findall(text):
        for word in _WORD.findall(formula):
            if word not in _DRAWN:
                raise InputError(f"there are no strokes for \\{word} of the formula ${formula}$")
    return without_formulas(text)


def checked_formula(formula: str) -> str:
    """The formula, which LaTeX may be given as it is.

    Errors: InputError for a word or a sign that is no mathematics, and for braces that do not match.
    """
    left = formula
    for word in _WORD.findall(left):
        if word not in _SET:
            raise InputError(f"\\{word} is no word for formulas: ${printable(formula)}$")
    # What is left of TeX's signs: comments, parameters, columns, ^^ for any character, ends of lines.
    left = re.sub(r"\\[,;:! {}|]", " ", _WORD.sub(" ", left))
    for sign in ("^^", "\\", "#", "%", "&", "~", "$", "\n", "\r"):
        if sign in left:
            raise InputError(f"{printable(sign)!r} has no place in the formula ${printable(formula)}$")
    depth = 0
    for sign in left:
        depth += (sign == "{") - (sign == "}")
        if depth < 0:
            break
    if depth:
        raise InputError(f"the braces of the formula ${printable(formula)}$ do not match")
    return formula


def _letters(formula: str) -> str:
    found = _FRACTION.sub(r"\1/\2", formula)
    found = re.sub(r"\\([A-Za-z]+)( ?)", _sign, found)
    while found != (single := _TWICE.sub(r"{\1}", found)):
        found = single
    found = _ACCENTED.sub(_accented, found)
    found = _RAISED.sub(_raised, re.sub(r"\\[^A-Za-z]", " ", found))
    return re.sub(r"[{}]", "", found).strip()


def _sign(word: re.Match[str]) -> str:
    name, blank = word.groups()
    if name in _UPRIGHT:
        return ""
    if name in _ACCENTS:
        return _ACCENTS[name]
    return _SIGNS[name] + blank if name in _SIGNS else f"{name} "


def _accented(part: re.Match[str]) -> str:
    mark, several, one = part.groups()
    return "".join(letter if letter.isspace() else letter + mark for letter in (several if one is None else one))


def _raised(part: re.Match[str]) -> str:
    inner = part.group(2) or part.group(3) or ""
    made = inner.translate(_HIGH if part.group(1) == "^" else _LOW)
    return made if not set(made) & set(inner) else inner
