"""A picture in a file of its own, and its texts for LaTeX to set over it."""

from __future__ import annotations

from dataclasses import replace

from vectorplot.backends.page.page_marks import page_marks
from vectorplot.backends.page.page_texts import PageTexts
from vectorplot.backends.tikz.nodes import text_nodes
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.texts import Texts


def without_texts(drawing: Drawing) -> Drawing:
    """The drawing with all its other marks."""
    layers = (
        replace(layer, marks=tuple(mark for mark in layer.marks if not isinstance(mark, Texts)))
        for layer in drawing.layers
    )
    return replace(drawing, layers=tuple(layers))


def overlay_bytes(drawing: Drawing, picture: str) -> bytes:
    r"""A tikzpicture of the size of the page: the file of this name, and the texts of the drawing as nodes over it.

    picture: the name that \includegraphics finds the rest of the drawing by, whose box is the page.
    """
    page = page_marks(drawing)
    head = (
        "% \\usepackage{tikz}\n"
        "\\begin{tikzpicture}[x=1mm,y=1mm]\n"
        f"\\useasboundingbox (0,0) rectangle ({page.width / 1000.0:.10g},{page.height / 1000.0:.10g});\n"
        "\\node[inner sep=0pt,outer sep=0pt,anchor=south west] at (0,0)"
        f" {{\\includegraphics{{\\detokenize{{{picture}}}}}}};\n"
    )
    nodes = b"".join(text_nodes(part) for ink in page.inks for part in ink.parts if isinstance(part, PageTexts))
    return head.encode("utf-8") + nodes + b"\\end{tikzpicture}\n"
