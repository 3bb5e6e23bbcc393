"""SVG for pen plotters and web pages: one Inkscape layer per pen, millimetres.

svgwrite makes the document and its layers; the strokes and areas of a layer are formatted in bulk and put in their
places afterwards, because an object for each of them would cost a hundred times as much.
"""

from __future__ import annotations

import base64
import hashlib
import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Ints
from vectorplot.backends.page.areas import Areas
from vectorplot.backends.page.page_marks import Ink, PageMarks, PageStrokes, page_marks
from vectorplot.backends.page.page_texts import PageTexts
from vectorplot.backends.svg.areas_in_svg import ID_PREFIX, area_elements
from vectorplot.backends.svg.path_data import formatted
from vectorplot.backends.svg.texts_in_svg import text_elements
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.tolerances.of_parameters import ABOVE_WHOLE
from vectorplot.tolerances.of_the_page import ARC_DECIMAL_MM

_PLACE = "\0"  # cannot occur in the document: names and titles hold no control characters
_OPEN, _LOOP, _CURVE, _END, _RING, _ARC = b"\1", b"\2", b"\3", b"\4", b"\5", b"\6"
_ELEMENTS = (
    (_OPEN, b'<polyline points="'),
    (_LOOP, b'<polygon points="'),
    (_CURVE, b'<path d="M'),
    (_END, b'"/>\n'),
    (_RING, b'Z"/>\n'),
)
HASH_LENGTH = 6
"""Characters of 32 kinds each: two pictures have the same with a chance of one in a thousand million."""

_POINTS_AT_ONCE = 1 << 16
_WIDEST_ARC = np.pi / 2.0
"""The centre of a wider arc would depend too much on the decimals of its ends and radii."""


def svg_text(drawing: Drawing) -> str:
    """The drawing as the text of an SVG file.

    Parameters
    ----------
    drawing : Drawing
        What the file holds.

    Returns
    -------
    str
        A whole document, that browsers, editors and drivers of plotters read.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Notes
    -----
    Width and height in mm and a viewBox, so that a user unit is 1 mm; three decimals; y downwards. The layers are
    top-level groups labelled ``1 visible``, ``%2 hidden``; lines are polyline and polygon elements, curves are path
    elements with cubic segments, or with elliptic arcs where they are such; filled polygons are path elements, several
    neighbours of one colour in one, shaded ones have linear gradients; texts are text elements. Ids begin with a hash
    of the content, so that several drawings can share a web page; nothing else changes from run to run.

    Degenerate: an empty drawing is an empty page.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> text = backends.svg_text(drawing)
    >>> 'viewBox="0 0 210 297"' in text, text.count("<polygon")
    (True, 1)
    """
    return svg_bytes(drawing).decode("utf-8")


def svg_bytes(drawing: Drawing) -> bytes:
    """The drawing as the bytes of an SVG file in UTF-8.

    Parameters
    ----------
    drawing : Drawing
        What the file holds.

    Returns
    -------
    bytes
        The text that svg_text gives.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> backends.svg_bytes(vp.Drawing(100, 80, ())).decode() == backends.svg_text(vp.Drawing(100, 80, ()))
    True
    """
    page = page_marks(drawing)
    bodies = [_body(ink, number, page.height) for number, ink in enumerate(page.inks, start=1)]
    prefix = _content_hash(page, bodies)
    frame = _document(page, prefix).encode("utf-8").split(f"<!--{_PLACE}-->".encode())
    parts = [frame[0]]
    for body, after in zip(bodies, frame[1:], strict=True):
        parts += [b"\n", body.replace(ID_PREFIX, prefix.encode()), after]
    return b"".join(parts) + b"\n"


def _body(ink: Ink, number: int, height: int) -> bytes:
    """The elements of one layer."""
    found = []
    for place, part in enumerate(ink.parts):
        if isinstance(part, Areas):
            found.append(area_elements(part, ink.pen.width_mm, _letters(number, place), height))
        elif isinstance(part, PageTexts):
            found.append(text_elements(part, height))
        else:
            found.append(elements(part, height))
    return b"".join(found)


def _letters(number: int, place: int) -> str:
    """Letters that no other part of a layer has."""
    low = "abcdefghijklmnopqrstuvwxyz"
    layer = low[number - 1] if number <= len(low) else f"z{number}z"
    return layer + (low[place] if place < len(low) else f"z{place}z")


def elements(lines: PageStrokes, height: int) -> bytes:
    """The polyline, polygon and path elements of strokes; y is flipped about the page height in microns."""
    shown, first, last = _separators(lines)
    blocks = []
    for start in range(0, len(shown), _POINTS_AT_ONCE):
        block = slice(start, start + _POINTS_AT_ONCE)
        x, y = lines.microns[shown[block]].T
        blocks.append(formatted(first[block], x, height - y, last[block]))
    text = b"".join(blocks)
    for token, element in _ELEMENTS:
        text = text.replace(token, element)
    between = text.split(_ARC)
    return b"".join(part for pair in zip(between, [*_arc_data(lines, height), b""], strict=True) for part in pair)


def _separators(lines: PageStrokes) -> tuple[Ints, NDArray[np.uint8], NDArray[np.uint8]]:
    """The points that are written (k,), what stands before each of them and what after it.

    Of an arc only the first point: the place of its other data is marked.
    """
    starts, ends = lines.offsets[:-1], lines.offsets[1:]
    arc = np.zeros(len(starts), dtype=np.bool_)
    arc[lines.arcs.stroke] = True
    first, last = np.zeros(len(lines.microns), np.uint8), np.zeros(len(lines.microns), np.uint8)
    first[:] = ord(" ")
    first[starts] = np.where(lines.curved, ord(_CURVE), np.where(lines.closed, ord(_LOOP), ord(_OPEN)))
    first[starts[lines.curved] + 1] = ord("C")
    last[ends - 1] = np.where(lines.curved & lines.closed, ord(_RING), ord(_END))
    last[starts[arc]] = ord(_ARC)
    shown = ~np.repeat(arc, np.diff(lines.offsets))
    shown[starts] = True
    return np.flatnonzero(shown), first[shown], last[shown]


def _arc_data(lines: PageStrokes, height: int) -> list[bytes]:
    """For each arc the rest of its path element: parts of equal parameter length."""
    arcs = lines.arcs
    size = np.stack((np.hypot(*arcs.first.T), np.hypot(*arcs.second.T)))
    # In the file y goes down: angles and senses of turning are mirrored. The axes of a circle have no direction, and
    # those of an ellipse that lies flat are at 0 degrees, not now and then at what would be written as 180.
    tilt = np.degrees(arctan2(-arcs.first[:, 1], arcs.first[:, 0])).round(5) % 180.0
    tilt = np.where(np.abs(size[0] - size[1]) < ARC_DECIMAL_MM, 0.0, tilt)
    handed = arcs.first[:, 0] * arcs.second[:, 1] > arcs.first[:, 1] * arcs.second[:, 0]
    clockwise = handed != (arcs.end > arcs.start)
    count = np.maximum(np.ceil(np.abs(arcs.end - arcs.start) / _WIDEST_ARC - ABOVE_WHOLE), 1.0).astype(np.intp)
    owner = ragged.owner(count)
    last = np.cumsum(count) - 1
    number = np.arange(len(owner)) - np.repeat(last + 1 - count, count) + 1
    end = arcs.some(owner).points(arcs.start[owner] + (arcs.end - arcs.start)[owner] * (number / count[owner]))
    # The last end is that of the stroke, so that strokes that touch do so in the file too.
    end[last] = lines.microns[lines.offsets[arcs.stroke + 1] - 1] / 1000.0
    end[:, 1] = height / 1000.0 - end[:, 1]
    rows = np.column_stack((size.T[owner], tilt[owner], clockwise[owner], end)).tolist()
    parts = [f"A{_short(a)} {_short(b)} {_short(c)} 0 {d:.0f} {_short(x)},{_short(y)}" for a, b, c, d, x, y in rows]
    ends = zip((last + 1).tolist(), count.tolist(), lines.closed[arcs.stroke].tolist(), strict=True)
    return [(" ".join(parts[k - n : k]) + ('Z"/>\n' if ring else '"/>\n')).encode("ascii") for k, n, ring in ends]


def _short(number: float) -> str:
    """The number with the decimals of arcs, without needless zeros."""
    return f"{round(number / ARC_DECIMAL_MM) * ARC_DECIMAL_MM:.5f}".rstrip("0").rstrip(".")


class _Place:
    """Stands in svgwrite's tree where the lines of a layer go."""

    elementname = "comment"

    def get_xml(self) -> Any:
        return ET.Comment(_PLACE)


def _document(page: PageMarks, prefix: str) -> str:
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


def _content_hash(page: PageMarks, bodies: list[bytes]) -> str:
    """A prefix for ids, which must begin with a letter."""
    digest = hashlib.sha256(f"{page.width} {page.height} {page.title}".encode())
    for ink, body in zip(page.inks, bodies, strict=True):
        pen = f"Pen(width_mm={ink.pen.width_mm!r}, colour={ink.pen.colour!r})"
        digest.update(f"\n{ink.label}\n{pen}\n".encode())
        digest.update(body)
    return "d" + base64.b32encode(digest.digest())[:HASH_LENGTH].decode().lower()
