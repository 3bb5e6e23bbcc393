"""Texts in SVG: text elements that readers set, search and copy."""

from __future__ import annotations

from xml.sax.saxutils import escape

from vectorplot.backends.page.page_texts import FONTS, PageTexts

_ANCHORS = {0.0: "start", 0.5: "middle", 1.0: "end"}


def text_elements(texts: PageTexts, height: int) -> bytes:
    """The text elements; y is flipped about the page height in microns, and so are the directions."""
    lines = []
    for x, y, size, turn, anchor, colour, string in texts.lines(texts.plain):
        across, down = f"{x / 1000.0:.10g}", f"{(height - y) / 1000.0:.10g}"
        turned = f' transform="rotate({-turn:g} {across},{down})"' if turn else ""
        lines.append(
            f'<text x="{across}" y="{down}" font-size="{size:g}" font-family="{FONTS}" stroke="none" fill="{colour}"'
            f' text-anchor="{_ANCHORS[anchor]}"{turned}>{escape(string)}</text>\n'
        )
    return "".join(lines).encode("utf-8")
