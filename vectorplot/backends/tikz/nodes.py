"""Texts as nodes of PGF/TikZ: set by LaTeX in the document's fonts."""

from __future__ import annotations

import unicodedata

from vectorplot.backends.page.page_texts import PageTexts
from vectorplot.backends.tikz.colours import colour_of
from vectorplot.drawing.lettering.formulas import FORMULA, checked_formula
from vectorplot.drawing.lettering.hershey import clusters
from vectorplot.scene.pages.paper import MM_PER_POINT

LEADING = 1.2
"""From line to line, in sizes of type."""

_ANCHORS = {0.0: "base west", 0.5: "base", 1.0: "base east"}

_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\char34{}",
}

_GREEK = (
    "\\alpha \\beta \\gamma \\delta \\varepsilon \\zeta \\eta \\theta \\iota \\kappa \\lambda \\mu \\nu \\xi o \\pi"
    " \\rho \\varsigma \\sigma \\tau \\upsilon \\varphi \\chi \\psi \\omega"
)
_GREEK_CAPITALS = (
    "A B \\Gamma \\Delta E Z H \\Theta I K \\Lambda M N \\Xi O \\Pi P \\Sigma T \\Upsilon \\Phi X \\Psi \\Omega"
)
_RELATIONS = (
    "\\pm \\mp \\times \\cdot \\leq \\geq \\neq \\equiv \\propto \\infty \\surd \\subset \\cup \\supset \\cap"
    " \\in \\rightarrow \\uparrow \\leftarrow \\downarrow \\partial \\nabla \\int \\div \\parallel \\perp \\angle"
    " \\exists \\oslash ^\\circ - ' ''"
)
_SIGNS = {
    **dict(zip("αβγδεζηθικλμνξοπρςστυφχψω", _GREEK.split(), strict=True)),
    **dict(zip("ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩ", _GREEK_CAPITALS.split(), strict=True)),
    **dict(zip("±∓×·≤≥≠≡∝∞√⊂∪⊃∩∈→↑←↓∂∇∫÷∥⊥∠∃⌀°−′″", _RELATIONS.split(), strict=True)),
}
"""Characters that LaTeX's usual fonts lack, in the words of its formulas."""

_OVER = {
    "\u0302": "\\hat",
    "\u0303": "\\tilde",
    "\u0304": "\\bar",
    "\u0307": "\\dot",
    "\u0308": "\\ddot",
    "\u20d7": "\\vec",
}
"""Accents over letters that no character has with them."""


def text_nodes(texts: PageTexts) -> bytes:
    """A node for each line, of its size of type, on the line that its letters stand on."""
    lines = []
    for x, y, size, turn, anchor, colour, string in texts.lines(texts.strings):
        points = size / MM_PER_POINT
        font = f"\\fontsize{{{points:.4g}bp}}{{{LEADING * points:.4g}bp}}\\selectfont"
        turned = f",rotate={turn:g}" if turn else ""
        head = f"inner sep=0pt,outer sep=0pt,anchor={_ANCHORS[anchor]},text={colour_of(int(colour[1:], 16))}{turned}"
        lines.append(f"\\node[{head},font={font}] at ({x / 1000.0:.10g},{y / 1000.0:.10g}) {{{latex(string)}}};\n")
    return "".join(lines).encode("utf-8")


def latex(text: str) -> str:
    """The text for LaTeX: mathematics between dollars stays as it is, all else is read as it stands; \\$ is a dollar.

    Errors: InputError for what is no mathematics between dollars.
    """
    parts = FORMULA.split(text)
    return "".join(
        f"${checked_formula(part)}$" if k % 2 else _plain(part.replace(r"\$", "$")) for k, part in enumerate(parts)
    )


def _plain(text: str) -> str:
    return "".join(map(_accented, clusters(text)))


def _accented(cluster: str) -> str:
    found = _letter(cluster[0])
    for mark in cluster[1:]:
        found = f"\\ensuremath{{{_OVER[mark]}{{{found}}}}}" if mark in _OVER else found + mark
    return found


def _letter(character: str) -> str:
    if character in _SPECIAL:
        return _SPECIAL[character]
    if character in _SIGNS:
        return f"\\ensuremath{{{_SIGNS[character]}}}"
    form, _, codes = unicodedata.decomposition(character).partition(" ")
    if form in ("<super>", "<sub>"):
        inner = "".join(_letter(chr(int(code, 16))) for code in codes.split())
        return f"\\text{form[1:-1]}script{{{inner}}}"
    return character
