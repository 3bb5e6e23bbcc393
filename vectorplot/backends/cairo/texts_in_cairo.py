"""Texts in PostScript, PDF and PNG: letters of a font that cairo finds, in the file where the format holds fonts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from vectorplot.backends.page.page_texts import PageTexts

if TYPE_CHECKING:
    import cairo

FAMILY = "sans-serif"
"""What the system says it is."""


def show(context: cairo.Context[Any], texts: PageTexts, scale: float, height: float) -> None:
    """Write the texts; scale: device units per micron; height: of the page's lower border in them, from the top."""
    import cairo

    context.select_font_face(FAMILY, cairo.FONT_SLANT_NORMAL, cairo.FONT_WEIGHT_NORMAL)
    for x, y, size, turn, anchor, colour, string in texts.lines(texts.plain):
        context.save()
        context.set_source_rgb(*(int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)))
        context.set_font_size(size * 1000.0 * scale)
        context.translate(x * scale, height - y * scale)
        context.rotate(-math.radians(turn))
        context.move_to(-anchor * context.text_extents(string).x_advance, 0.0)
        context.show_text(string)
        context.restore()
    context.new_path()
