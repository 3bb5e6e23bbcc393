"""Several drawings as the pages of one PDF file."""

from __future__ import annotations

import io
from collections.abc import Iterable

from vectorplot.backends.cairo.gouraud import with_triangles_in_pdf
from vectorplot.backends.cairo.surfaces import POINTS_PER_MICRON, draw_page
from vectorplot.backends.page.page_marks import page_marks
from vectorplot.drawing.drawing import Drawing


def pdf_pages_bytes(drawings: Iterable[Drawing], title: str = "") -> bytes:
    """The drawings as a PDF file with a page for each.

    Parameters
    ----------
    drawings : iterable of Drawing
        What the pages hold, one after the other; only one of them is in memory at a time.
    title : str
        That of the file.

    Returns
    -------
    bytes
        The same for the same drawings: no date is in it.

    Raises
    ------
    InputError
        For what ps_bytes refuses.

    Notes
    -----
    Degenerate: no drawings are a file without pages.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> content = backends.pdf_pages_bytes([vp.Drawing(100, 80, ()), vp.Drawing(80, 100, ())])
    >>> content.startswith(b"%PDF-"), b"/Count 2" in content
    (True, True)
    """
    import cairo

    stream = io.BytesIO()
    surface = cairo.PDFSurface(stream, 1.0, 1.0)
    surface.set_metadata(cairo.PDFMetadata.CREATE_DATE, "")
    if title:
        surface.set_metadata(cairo.PDFMetadata.TITLE, title)
    for drawing in drawings:
        page = page_marks(drawing)
        height = page.height * POINTS_PER_MICRON
        surface.set_size(page.width * POINTS_PER_MICRON, height)
        draw_page(surface, page, height)
    surface.finish()
    return with_triangles_in_pdf(stream.getvalue())
