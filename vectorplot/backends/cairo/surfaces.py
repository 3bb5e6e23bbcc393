"""PostScript, EPS, PDF and PNG through cairo.

Cairo stores coordinates as 24.8 fixed point in device units. The device unit of PostScript and PDF is the point, so a
coordinate is at most 1/512 point = 0.0007 mm off, and what is clipped to the page can never wrap round.

Shaded triangles are meshes of the format, exact at any magnification; readers leave no gaps between the triangles of a
mesh. PostScript knows no opacity: where a polygon is transparent, cairo
puts a picture of 300 dots per inch.
"""

from __future__ import annotations

import io
import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.backends.cairo.areas_in_cairo import paint
from vectorplot.backends.cairo.gouraud import with_triangles_in_pdf, with_triangles_in_postscript
from vectorplot.backends.cairo.texts_in_cairo import show
from vectorplot.backends.page.areas import Areas
from vectorplot.backends.page.page_marks import PageMarks, PageStrokes, page_marks
from vectorplot.backends.page.page_texts import PageTexts
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import SEAM_MM
from vectorplot.errors import InputError
from vectorplot.shading.raster.png import DPI, Bytes, with_meaning

if TYPE_CHECKING:
    import cairo

POINTS_PER_MICRON = 72.0 / 25400.0

LARGEST_SIDE_PIXELS = 32767
"""Cairo's limit for the side of a picture."""

LARGEST_PICTURE_PIXELS = 100_000_000
"""400 MB in memory."""

_STROKES_AT_ONCE = 1000  # one huge path makes the rasterisers of all readers slow
_TITLE_LENGTH = 200  # cairo refuses comments of more than 255 characters


def ps_bytes(drawing: Drawing) -> bytes:
    """The drawing as a PostScript file of one page; fonts are in it where it has texts.

    Parameters
    ----------
    drawing : Drawing
        What the file holds.

    Returns
    -------
    bytes
        A whole file, in points of 1/72 inch; language level 2, or 3 if it has shaded triangles.

    Raises
    ------
    InputError
        For a point, page or pen width that is not finite, a page without area or too large, a colour other than
        #rrggbb, an opacity that is not from 0 to 1.

    Notes
    -----
    Degenerate: the bounding box of an empty drawing is the page.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> backends.ps_bytes(drawing).startswith(b"%!PS-Adobe-3.0")
    True
    """
    return _postscript(page_marks(drawing), eps=False)


def eps_bytes(drawing: Drawing) -> bytes:
    """The drawing as an encapsulated PostScript file, to be placed in documents; the bounding box is that of the ink.

    Parameters
    ----------
    drawing : Drawing
        What the file holds.

    Returns
    -------
    bytes
        As of ps_bytes, with the head of an encapsulated file.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Notes
    -----
    Degenerate: the bounding box of an empty drawing is the page.

    Source: Adobe, Encapsulated PostScript File Format Specification 3.0.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> backends.eps_bytes(drawing).splitlines()[0]
    b'%!PS-Adobe-3.0 EPSF-3.0'
    """
    return _postscript(page_marks(drawing), eps=True)


def whole_eps_bytes(drawing: Drawing) -> bytes:
    """The same, but the bounding box is the page, so that other things have their places on it.

    Errors: as eps_bytes.
    """
    page = page_marks(drawing)
    return _with_page_box(_postscript(page, eps=True), page)


def pdf_bytes(drawing: Drawing) -> bytes:
    """The drawing as a PDF file of one page.

    Parameters
    ----------
    drawing : Drawing
        What the file holds; its title becomes that of the file.

    Returns
    -------
    bytes
        The same for the same drawing: no date is in it.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Notes
    -----
    Degenerate: an empty drawing is an empty page.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> content = backends.pdf_bytes(drawing)
    >>> content.startswith(b"%PDF-"), content == backends.pdf_bytes(drawing)
    (True, True)
    """
    import cairo

    page = page_marks(drawing)
    stream = io.BytesIO()
    height = page.height * POINTS_PER_MICRON
    surface = cairo.PDFSurface(stream, page.width * POINTS_PER_MICRON, height)
    # Cairo writes the present time unless told otherwise; the same drawing must be the same file. This leaves it out.
    surface.set_metadata(cairo.PDFMetadata.CREATE_DATE, "")
    if page.title:
        surface.set_metadata(cairo.PDFMetadata.TITLE, page.title)
    draw_page(surface, page, height)
    surface.finish()
    return with_triangles_in_pdf(stream.getvalue())


def png_bytes(drawing: Drawing, dpi: float = DPI) -> bytes:
    """The drawing as a PNG picture on white, in sRGB and with its resolution in the file.

    Parameters
    ----------
    drawing : Drawing
        What the picture shows.
    dpi : float
        Pixels an inch.

    Returns
    -------
    bytes
        A picture of the size of the page, with three channels of 8 bits.

    Raises
    ------
    InputError
        For what ps_bytes refuses, a resolution that is not positive and finite, and a picture of more than 32767 pixels
        along a side or a hundred million in all.

    Notes
    -----
    Degenerate: an empty drawing is a white page; a page smaller than a pixel has one.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> empty = vp.Drawing(254, 127, ())
    >>> content = backends.png_bytes(empty, dpi=10)
    >>> int.from_bytes(content[16:20], "big"), int.from_bytes(content[20:24], "big")
    (100, 50)
    """
    stream = io.BytesIO()
    _raster(drawing, dpi).write_to_png(stream)
    return with_meaning(stream.getvalue(), dpi)


def drawing_pixels(drawing: Drawing, dpi: float = DPI) -> Bytes:
    """(rows, columns, 3) the pixels of the picture that png_bytes gives. Errors: as there."""
    surface = _raster(drawing, dpi)
    rows, stride = surface.get_height(), surface.get_stride()
    words = np.frombuffer(surface.get_data(), dtype=np.uint32).reshape(rows, stride // 4)[:, : surface.get_width()]
    return np.stack([words >> 16, words >> 8, words], axis=2).astype(np.uint8)


def _raster(drawing: Drawing, dpi: float) -> cairo.ImageSurface:
    import cairo

    page = page_marks(drawing)
    if not 0.0 < dpi < np.inf:
        raise InputError(f"resolution of {dpi:g} dpi")
    scale = dpi / 25400.0
    if max(page.width, page.height) * scale > LARGEST_SIDE_PIXELS or (
        page.width * scale * page.height * scale > LARGEST_PICTURE_PIXELS
    ):
        size = f"{page.width / 1e3:g} x {page.height / 1e3:g} mm"
        raise InputError(f"a page of {size} has too many pixels at {dpi:g} dpi")
    width, height = (max(1, round(side * scale)) for side in (page.width, page.height))
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, width, height)
    context = cairo.Context(surface)
    context.set_source_rgb(1.0, 1.0, 1.0)
    context.paint()
    _ink(context, page, scale, page.height * scale, max(SEAM_MM * 1000.0 * scale, 1.0))
    surface.flush()
    return surface


def _postscript(page: PageMarks, *, eps: bool) -> bytes:
    import cairo

    stream = io.BytesIO()
    # Cairo flips y about the next whole point; with a whole height the page keeps its lower left corner at the origin.
    width, height = _whole_points(page)
    surface = cairo.PSSurface(stream, width, height)
    shaded = any(areas.shaded.any() for ink in page.inks for areas in ink.areas)
    surface.restrict_to_level(cairo.PSLevel.LEVEL_3 if shaded else cairo.PSLevel.LEVEL_2)
    surface.set_eps(eps)
    if page.title:
        surface.dsc_comment(f"%%Title: ({postscript_string(page.title)})")
    draw_page(surface, page, height)
    surface.finish()
    text = with_triangles_in_postscript(re.sub(rb"(?m)^%%CreationDate:.*\n", b"", stream.getvalue(), count=1))
    if not any(len(part) for ink in page.inks for part in ink.parts):
        text = _with_page_box(text, page)
    return text


def postscript_string(text: str) -> str:
    """The text as it stands between the parentheses of a PostScript string: printable ASCII, specials escaped, cut to
    a length that cairo takes."""
    printable = "".join(c if " " <= c <= "~" else "?" for c in text)[: _TITLE_LENGTH // 2]
    return re.sub(r"([\\()])", r"\\\1", printable)


def _with_page_box(text: bytes, page: PageMarks) -> bytes:
    """The file with the page as bounding box. (Around an empty drawing cairo writes a box turned inside out.)"""
    width, height = _whole_points(page)
    # What is closer than whole points is left out.
    text = re.sub(rb"(?m)^%%HiResBoundingBox:.*\n", b"", text)
    return re.sub(rb"(?m)^%%(Page)?BoundingBox:.*$", rb"%%\1BoundingBox: 0 0 " + b"%d %d" % (width, height), text)


def _whole_points(page: PageMarks) -> tuple[int, int]:
    return math.ceil(page.width * POINTS_PER_MICRON), math.ceil(page.height * POINTS_PER_MICRON)


def draw_page(surface: cairo.Surface, page: PageMarks, height: float) -> None:
    """Draw a page of PostScript or PDF, and end it; height: of the page, in points."""
    import cairo

    context = cairo.Context(surface)
    _ink(context, page, POINTS_PER_MICRON, height, SEAM_MM * 1000.0 * POINTS_PER_MICRON)
    context.show_page()


def _ink(context: cairo.Context[Any], page: PageMarks, scale: float, height: float, seam: float) -> None:
    """Draw all inks; scale: device units per micron; height: of the page's lower border in them, from the top; seam:
    width of the line around opaque polygons."""
    import cairo

    context.set_line_cap(cairo.LINE_CAP_ROUND)
    context.set_line_join(cairo.LINE_JOIN_ROUND)
    for ink in page.inks:
        width = ink.pen.width_mm * 1000.0 * scale
        for part in ink.parts:
            if isinstance(part, Areas):
                paint(context, part, scale, height, width, seam)
            elif isinstance(part, PageTexts):
                show(context, part, scale, height)
            else:
                context.set_source_rgb(*(int(ink.pen.colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)))
                context.set_line_width(width)
                _stroke(context, part, scale, height)


def _stroke(context: cairo.Context[Any], lines: PageStrokes, scale: float, height: float) -> None:
    """Stroke the polylines and curves. Cairo takes one segment a call, so this loops over points."""
    points = (lines.microns * (scale, -scale) + (0.0, height)).tolist()
    move_to, line_to, curve_to = context.move_to, context.line_to, context.curve_to
    strokes = zip(lines.offsets[1:].tolist(), lines.closed.tolist(), lines.curved.tolist(), strict=True)
    start = 0
    for number, (end, closed, curved) in enumerate(strokes, start=1):
        move_to(*points[start])
        if curved:
            for i in range(start + 1, end, 3):
                curve_to(*points[i], *points[i + 1], *points[i + 2])
        else:
            for x, y in points[start + 1 : end]:
                line_to(x, y)
        if closed:
            context.close_path()
        if number % _STROKES_AT_ONCE == 0:
            context.stroke()
        start = end
    context.stroke()
