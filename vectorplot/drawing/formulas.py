"""Formulas of TeX in labels, where nobody sets them: the letters and signs that they name."""

from __future__ import annotations

import re
from functools import partial

from vectorplot.errors import InputError

FORMULA = re.compile(r"(?<!\\)\$([^$]+)(?<!\\)\$")
"""A formula of TeX between dollars."""

_GREEK_COMMANDS = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho varsigma sigma tau upsilon"
    " phi chi psi omega"
)
_NAMED = "times cdot le leq ge geq neq pm mp infty perp parallel angle circ in to cup cap partial nabla approx"
_LETTERS = dict(zip(_GREEK_COMMANDS.split(), "αβγδεζηθικλμνξοπρςστυφχψω", strict=True))
_SIGNS = {
    **_LETTERS,
    **{name.capitalize(): letter.upper() for name, letter in _LETTERS.items()},
    **dict(zip(_NAMED.split(), "×·≤≤≥≥≠±∓∞⊥∥∠°∈→∪∩∂∇~", strict=True)),
    **{"varepsilon": "ε", "varphi": "φ", "vartheta": "θ", "sqrt": "√", "quad": " ", "left": "", "right": ""},
    **{"langle": "⟨", "rangle": "⟩"},
}
_FONTS = frozenset(
    (
        "mathrm mathbf mathit mathsf mathtt mathcal mathbb mathfrak boldsymbol text textrm textbf textit operatorname"
    ).split()
)
"""What asks for letters of another font: strokes have one."""

_MARKS = {
    **dict.fromkeys(("hat", "widehat"), "\u0302"),
    **dict.fromkeys(("tilde", "widetilde"), "\u0303"),
    **dict.fromkeys(("bar", "overline"), "\u0304"),
    **{"dot": "\u0307", "ddot": "\u0308", "vec": "\u20d7"},
}
"""Accents, as the characters that stand behind the letter they are set over."""

_FUNCTIONS = frozenset(
    "sin cos tan cot sec csc arcsin arccos arctan sinh cosh tanh log ln lg exp min max sup inf lim det dim arg".split()
)
"""Words that are written as they are called."""

_LETTERED = frozenset((*_SIGNS, *_FUNCTIONS, *_FONTS, *_MARKS, "frac"))
"""Words that letters can say."""

_ONLY_TEX = frozenset(
    (
        "omicron vartheta varpi varrho digamma sum prod coprod int iint iiint oint ne sim simeq cong equiv propto ll"
        " gg subset supset subseteq supseteq ni notin mid ast star bullet wedge vee oplus otimes ominus setminus div"
        " rightarrow leftarrow Rightarrow Leftarrow leftrightarrow Leftrightarrow mapsto uparrow downarrow"
        " longrightarrow hookrightarrow triangle prime emptyset forall exists neg hbar ell Re Im aleph dots ldots"
        " cdots vdots ddots vert Vert lvert rvert lVert rVert lfloor rfloor lceil rceil lbrace rbrace big Big bigg"
        " Bigg bigl bigr Bigl Bigr dfrac tfrac binom underline overbrace underbrace qquad limits nolimits displaystyle"
        " textstyle scriptstyle top bot dagger ddagger square blacksquare smallsetminus varnothing lesssim gtrsim bmod"
        " pmod gcd hom ker Pr degree surd flat sharp natural"
    ).split()
)
"""Words of mathematics that only TeX sets."""

_WORD = re.compile(r"\\([A-Za-z]+)")
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|.|\\", re.DOTALL)
"""What TeX reads at once: a word, a sign behind a backslash, or a letter."""

_TABLES = re.compile(r"\\(?:begin|end)\{(?:[pbvVB]?matrix|smallmatrix|cases|aligned)\}")
"""The environments that formulas may have."""

_ESCAPES = frozenset(",;:!> {}|_%&#$\\")


_FIGURES = str.maketrans("0123456789+-n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ"), str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
"""High and low characters that most fonts have."""

_HIGH = str.maketrans(
    "0123456789+-=()abcdefghijklmnoprstuvwxyzABDEGHIJKLMNOPRTUWβγδφχθ",
    "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ᵃᵇᶜᵈᵉᶠᵍʰⁱʲᵏˡᵐⁿᵒᵖʳˢᵗᵘᵛʷˣʸᶻᴬᴮᴰᴱᴳᴴᴵᴶᴷᴸᴹᴺᴼᴾᴿᵀᵁᵂᵝᵞᵟᵠᵡᶿ",
)
_LOW = str.maketrans("0123456789+-=()aehijklmnoprstuvxβγρφχ", "₀₁₂₃₄₅₆₇₈₉₊₋₌₍₎ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓᵦᵧᵨᵩᵪ")
_Small = tuple[dict[int, int], dict[int, int]]
"""High and low characters for others."""

_FRACTION = re.compile(r"\\frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}")
_MARKED = re.compile(rf"\\({'|'.join(_MARKS)})(?![A-Za-z])\s*(?:\{{([^{{}}]*)\}}|(\\[A-Za-z]+|\S))")
_RAISED = re.compile(r"([\^_])(?:\{([^{}]*)\}|(\S))")


def checked_formula(formula: str) -> str:
    r"""The formula, if it is mathematics and nothing else: known words of TeX, and braces in pairs.

    A formula goes to LaTeX as it stands, where other words read files, run programs or end the formula.
    Errors: InputError that names the formula and what is wrong in it.
    """
    if "^^" in formula or not formula.isprintable():
        raise InputError(
            f"formula ${formula.encode('unicode_escape').decode()}$: ^^ and control characters have no place in it"
        )
    rest = _TABLES.sub(" ", formula)
    forbidden = "%#" if rest != formula else "%#&"
    depth = 0
    for token in _TOKEN.findall(rest):
        word = token[1:]
        if word.isalpha() and word.isascii() and token[0] == "\\":
            if word not in _LETTERED and word not in _ONLY_TEX:
                raise InputError(
                    f"formula ${formula}$: {token} is none of the words of mathematics that are let through"
                )
        elif token in forbidden or (token[0] == "\\" and (not word or word not in _ESCAPES)):
            raise InputError(f"formula ${formula}$: {token} has no place in it")
        depth += (token == "{") - (token == "}")
        if depth < 0:
            break
    if depth:
        raise InputError(f"formula ${formula}$: its braces are not in pairs")
    return formula


def without_formulas(text: str) -> str:
    r"""The text with formulas in plain letters: ``$\alpha_1^2$`` is α₁²; \$ is a dollar. What has no such letters,
    roots and matrices, loses its form."""
    return _plain(text, _FIGURES)


def _plain(text: str, small: _Small) -> str:
    """The same with these high and low characters."""
    return FORMULA.sub(lambda formula: _letters(checked_formula(formula.group(1)), small), text).replace(r"\$", "$")


def without_formulas_in_strokes(text: str) -> str:
    r"""The same for letters that nobody else can set. Errors: InputError for words of TeX that have no such letters."""
    for formula in FORMULA.findall(text):
        for word in _WORD.findall(checked_formula(formula)):
            if word not in _LETTERED:
                raise InputError(f"there are no strokes for \\{word} of the formula ${formula}$")
    return _plain(text, (_HIGH, _LOW))


def _letters(formula: str, small: _Small) -> str:
    found = _FRACTION.sub(r"\1/\2", formula)
    found = _MARKED.sub(partial(_marked, small), found)
    found = re.sub(r"\\([A-Za-z]+)( ?)", _sign, found)
    found = _RAISED.sub(partial(_raised, small), re.sub(r"\\[^A-Za-z]", " ", found))
    return re.sub(r"[{}]", "", found).strip()


def _marked(small: _Small, accent: re.Match[str]) -> str:
    """Each letter with the mark behind it."""
    letters = _letters(accent.group(2) or accent.group(3) or "", small)
    return "".join(letter + _MARKS[accent.group(1)] if letter.strip() else letter for letter in letters)


def _sign(word: re.Match[str]) -> str:
    name, blank = word.groups()
    if name in _FONTS:
        return ""
    return _SIGNS[name] + blank if name in _SIGNS else f"{name} "


def _raised(small: _Small, part: re.Match[str]) -> str:
    inner = part.group(2) or part.group(3) or ""
    made = inner.translate(small[0] if part.group(1) == "^" else small[1])
    return made if not set(made) & set(inner) else inner
