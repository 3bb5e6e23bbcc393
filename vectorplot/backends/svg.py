"""SVG for pen plotters and web pages: one Inkscape layer per pen, strokes only, millimetres.

svgwrite makes the document and its layers; the polylines of a layer are formatted in bulk and put in their places
afterwards, because an object for each of them would cost a hundred times as much.
"""

from __future__ import annotations

import hashlib
import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.backends.sheet import Ink, Sheet, sheet
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.mesh import Ints

_PLACE = "\0"  # cannot occur in the document: names and titles hold no control characters
_OPEN, _LOOP, _END = b"\1", b"\2", b"\3"
_ELEMENTS = (
    (_OPEN, b'<polyline points="'),
    (_LOOP, b'<polygon points="'),
    (_END, b'"/>\n'),
)
_POINTS_AT_ONCE = 1 << 16


def svg_text(drawing: Drawing) -> str:
    """The drawing as the text of an SVG file.

    Width and height in mm and a viewBox, so that a user unit is 1 mm; three decimals; y downwards. The layers are
    top-level groups labelled ``1 visible``, ``%2 hidden``; lines are polyline and polygon elements. Ids begin with a
    hash of the content, so that several drawings can share a web page; nothing else changes from run to run.
    Errors: InputError as vectorplot.backends.sheet. Degenerate: an empty drawing is an empty page.
    """
    return svg_bytes(drawing).decode("utf-8")


def svg_bytes(drawing: Drawing) -> bytes:
    """The drawing as the bytes of an SVG file in UTF-8; see svg_text."""
    page = sheet(drawing)
    bodies = [polylines(ink, page.height) for ink in page.inks]
    frame = _document(page, bodies).encode("utf-8").split(f"<!--{_PLACE}-->".encode())
    parts = [frame[0]]
    for body, after in zip(bodies, frame[1:], strict=True):
        parts += [b"\n", body, after]
    return b"".join(parts) + b"\n"


def polylines(ink: Ink, height: int) -> bytes:
    """The polyline and polygon elements of one layer; y is flipped about the page height in microns."""
    first, last = np.zeros(len(ink.microns), np.uint8), np.zeros(len(ink.microns), np.uint8)
    first[:] = ord(" ")
    first[ink.offsets[:-1]] = np.where(ink.closed, ord(_LOOP), ord(_OPEN))
    last[ink.offsets[1:] - 1] = ord(_END)
    blocks = []
    for start in range(0, len(ink.microns), _POINTS_AT_ONCE):
        block = slice(start, start + _POINTS_AT_ONCE)
        x, y = ink.microns[block].T
        blocks.append(_formatted(first[block], x, height - y, last[block]))
    text = b"".join(blocks)
    for token, element in _ELEMENTS:
        text = text.replace(token, element)
    return text


def _formatted(first: NDArray[np.uint8], x: Ints, y: Ints, last: NDArray[np.uint8]) -> bytes:
    """Rows of ``<first>x,y<last>`` as bytes; a zero in last is left out."""
    x_text, y_text = _millimetres(x), _millimetres(y)
    comma = np.full(len(x), ord(","), np.uint8)
    table = np.column_stack((first, x_text, comma, y_text, last))
    text: NDArray[np.uint8] = table[table != 0]
    return text.tobytes()


def _millimetres(microns: Ints) -> NDArray[np.uint8]:
    """Decimals in mm as rows of characters, with 0 where a row has no character: no leading or trailing zeros."""
    whole, part = np.divmod(microns.astype(np.uint32), np.uint32(1000))
    digits = len(str(int(whole.max(initial=0))))
    text = np.zeros((len(microns), digits + 4), np.uint8)
    rest = whole
    for column in range(digits - 1, -1, -1):
        rest, digit = np.divmod(rest, np.uint32(10))
        shown = (digit + rest > 0) | (column == digits - 1)
        text[:, column] = np.where(shown, digit + ord("0"), 0)
    text[:, digits] = np.where(part > 0, ord("."), 0)
    for column, unit in ((1, 100), (2, 10), (3, 1)):
        # A decimal is shown if it or a later one is not zero.
        shown = part % (unit * 10) > 0
        text[:, digits + column] = np.where(shown, part // unit % 10 + ord("0"), 0)
    return text


class _Place:
    """Stands in svgwrite's tree where the lines of a layer go."""

    elementname = "comment"

    def get_xml(self) -> Any:
        return ET.Comment(_PLACE)


def _document(page: Sheet, bodies: list[bytes]) -> str:
    """The page and its layers with a mark in place of their lines."""
    import svgwrite
    from svgwrite.extensions import Inkscape

    width, height = (f"{side / 1000.0:.10g}" for side in (page.width, page.height))
    document = svgwrite.Drawing(
        size=(f"{width}mm", f"{height}mm"), viewBox=f"0 0 {width} {height}", debug=False, profile="full"
    )
    layers = Inkscape(document)
    if page.title:
        document.set_desc(title=page.title)
    prefix = _content_hash(page, bodies)
    for number, ink in enumerate(page.inks, start=1):
        layer = layers.layer(
            label=ink.label,
            id=f"{prefix}-{number}",
            fill="none",
            stroke=ink.pen.colour.lower(),
            stroke_width=f"{ink.pen.width_mm:.6g}",
            stroke_linecap="round",
            stroke_linejoin="round",
        )
        layer.add(_Place())
        document.add(layer)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{document.tostring()}'


def _content_hash(page: Sheet, bodies: list[bytes]) -> str:
    """A prefix for ids, which must begin with a letter."""
    digest = hashlib.sha256(f"{page.width} {page.height} {page.title}".encode())
    for ink, body in zip(page.inks, bodies, strict=True):
        digest.update(f"\n{ink.label}\n{ink.pen}\n".encode())
        digest.update(body)
    return f"d{digest.hexdigest()[:12]}"
