"""Drawings side by side in rows."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.sheets.sheet import Sheet
from vectorplot.errors import InputError
from vectorplot.scene.pages.page import Page
from vectorplot.scene.point_of_view import page_of
from vectorplot.scene.scene import Scene


def contact_sheet(
    drawings: Sequence[Drawing],
    page: Page | str = "A4",
    *,
    columns: int | None = None,
    gap_mm: float = 5.0,
    title: str = "",
) -> Drawing:
    """Drawings in rows from the upper left, each as large as its cell allows, in the middle of it.

    Parameters
    ----------
    drawings : sequence of Drawing
        In reading order.
    page : Page or str
        The sheet, as of Sheet; its margin stays empty.
    columns : int, optional
        How many stand side by side; where None, as many as make the smallest of them the largest.
    gap_mm : float
        Between cells.
    title : str
        What it shows.

    Returns
    -------
    Drawing
        As of Sheet.drawing.

    Raises
    ------
    InputError
        For a page that is none, or has no room for so many; for no columns; for a gap that is negative or not finite.

    Notes
    -----
    Degenerate: without drawings the sheet is empty.

    Examples
    --------
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> views = [vp.draw(triangle, view, page="80x60") for view in ("top", "iso", "bottom")]
    >>> vp.contact_sheet(views, "A4").width_mm
    210.0
    """
    sheet = Sheet(page, title)
    if columns is not None and columns < 1:
        raise InputError(f"a contact sheet in {columns} columns: expected one or more")
    if not 0.0 <= gap_mm < math.inf:
        raise InputError(f"a gap of {gap_mm:g} mm: expected a length that is finite and not negative")
    if not drawings:
        return sheet.drawing()
    paper, count = page_of(sheet.page, Scene(())), len(drawings)
    size = np.array([(drawing.width_mm, drawing.height_mm) for drawing in drawings])
    inside = np.array([paper.width_mm, paper.height_mm]) - 2.0 * paper.margin_mm
    tried = np.arange(1, count + 1) if columns is None else np.array([columns])
    cells = np.stack([tried, -(-count // tried)], axis=1)
    rooms = (inside - (cells - 1) * gap_mm) / cells
    best = int((rooms[:, None] / size).min(axis=(1, 2)).argmax())
    room, wide = rooms[best], int(tried[best])
    if not (room > 0.0).all():
        raise InputError(f"page {paper.width_mm:g}x{paper.height_mm:g} mm: no room for {count} drawings")
    scale = (room / size).min(axis=1)
    row, column = np.divmod(np.arange(count), wide)
    middle = np.stack([column + 0.5, cells[best, 1] - row - 0.5], axis=1) * room
    corner = paper.margin_mm + middle + np.stack([column, cells[best, 1] - 1 - row], axis=1) * gap_mm
    corner -= 0.5 * scale[:, None] * size
    for drawing, (x, y), factor in zip(drawings, corner.tolist(), scale.tolist(), strict=True):
        sheet = sheet.place(drawing, x, y, factor)
    return sheet.drawing()
