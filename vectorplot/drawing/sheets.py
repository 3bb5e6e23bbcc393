"""Sheets of paper: drawings side by side, frames, scales and title blocks of technical drawings."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import NO_CURVE, CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.letters import Lettering, lettered, typeset
from vectorplot.drawing.pens import PENS
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import norm
from vectorplot.scene.labels import capital_height
from vectorplot.scene.page import Page
from vectorplot.scene.placement import page_of
from vectorplot.scene.scene import Scene
from vectorplot.words import LineKind

# Several drawings on one sheet of paper.

NO_ITEM = -1

Mark = Paths | CurvedStrokes | Fills | Texts


@dataclass(frozen=True, eq=False)
class PlacedDrawing:
    """A drawing on a sheet: where its lower left corner is, in mm, and how many times larger it is there."""

    drawing: Drawing
    x_mm: float
    y_mm: float
    scale: float


@dataclass(frozen=True, eq=False)
class Sheet:
    """A sheet of paper with drawings on it.

    Parameters
    ----------
    page : Page or str
        Or its name or size, such as "A3", "A3 landscape" or "200x150".
    title : str
        What it shows.
    drawings : tuple of PlacedDrawing
        What is on it, in drawing order; place adds to them.

    Raises
    ------
    InputError
        For a page that is none.

    Examples
    --------
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> one = vp.draw(triangle, "top", page="60x60")
    >>> sheet = vp.Sheet("A5 landscape").place(one, 10, 10).place(one, 110, 10, scale=1.5)
    >>> sheet.drawing()
    <Drawing '': 210x148 mm, marks: contour 2>
    """

    page: Page | str = "A4"
    title: str = ""
    drawings: tuple[PlacedDrawing, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "page", page_of(self.page, Scene(())))

    def place(self, drawing: Drawing, x_mm: float, y_mm: float, scale: float = 1.0) -> Sheet:
        """The sheet with one more drawing on it.

        Parameters
        ----------
        drawing : Drawing
            What is put on top of the others.
        x_mm, y_mm : float
            Where the lower left corner of its page goes, from that of the sheet.
        scale : float
            How many times larger it is there.

        Returns
        -------
        Sheet
            A new one.

        Raises
        ------
        InputError
            For places that are not finite, and a scale that is not finite and positive.

        Notes
        -----
        Nothing is cut off at the edges of either page.

        Examples
        --------
        >>> import vectorplot as vp
        >>> empty = vp.draw([], page="40x40")
        >>> len(vp.Sheet("A4").place(empty, 20, 30).place(empty, 80, 30).drawings)
        2
        """
        if not (math.isfinite(x_mm) and math.isfinite(y_mm)):
            raise InputError(f"a drawing at {x_mm:g}, {y_mm:g} mm: not a place on a sheet")
        if not 0.0 < scale < math.inf:
            raise InputError(f"a drawing {scale:g} times larger: expected a number that is finite and positive")
        return replace(self, drawings=(*self.drawings, PlacedDrawing(drawing, x_mm, y_mm, scale)))

    def drawing(self) -> Drawing:
        """All of the sheet as one drawing.

        Returns
        -------
        Drawing
            Layers of one name and pen are one, where the first of them is, and there are no empty ones; items of one
            name are one. Strokes, curves and fills are those of the drawings, moved and scaled, pens as wide as they
            were; points3d are those of the world still, and page_from_world is the identity, as the drawings need not
            look at the world alike.

        Notes
        -----
        A layer lies below the next one in all drawings: so these lie beside each other, or the lower ones do not show
        fills of later layers.
        """
        names = tuple(dict.fromkeys(name for placed in self.drawings for name in placed.drawing.items))
        number = {name: index for index, name in enumerate(names)}
        merged: dict[tuple[str, Pen, bool], list[Mark]] = {}
        curves = 0
        for placed in self.drawings:
            of_item = np.array([*(number[name] for name in placed.drawing.items), NO_ITEM], dtype=np.intp)
            taken = curves
            for layer in placed.drawing.layers:
                marks = merged.setdefault((layer.name, layer.pen, layer.plotted), [])
                moved = (moved_mark(mark, placed.scale, np.array([placed.x_mm, placed.y_mm])) for mark in layer.marks)
                marks.extend(_renumbered(mark, of_item, taken) for mark in moved)
                curves = max((curves, *(taken + int(paths.curve.max(initial=-1)) + 1 for paths in layer.strokes)))
        drawn = {key: tuple(mark for mark in marks if len(mark)) for key, marks in merged.items()}
        layers = tuple(Layer(name, pen, marks, plotted) for (name, pen, plotted), marks in drawn.items() if marks)
        page = page_of(self.page, Scene(()))
        font = next((placed.drawing.font for placed in self.drawings if placed.drawing.font), "")
        return Drawing(page.width_mm, page.height_mm, layers, names, self.title, font=font)


def moved_mark(mark: Mark, scale: float, by: Floats) -> Mark:
    """A mark scale times larger about the lower left corner of its page, and then moved by (2,) mm."""
    if isinstance(mark, Texts):
        points = scale * mark.points + by
        return replace(mark, points=points, size_mm=scale * mark.size_mm, room_mm=scale * mark.room_mm)
    if isinstance(mark, Fills):
        return replace(mark, points=scale * mark.points + by)
    if isinstance(mark, Paths):
        return _moved_paths(mark, scale, by)
    beziers = replace(mark.beziers, control=scale * mark.beziers.control + by, error=scale * mark.beziers.error)
    arcs = replace(
        mark.arcs,
        centre=scale * mark.arcs.centre + by,
        first=scale * mark.arcs.first,
        second=scale * mark.arcs.second,
    )
    return CurvedStrokes(_moved_paths(mark.paths, scale, by), beziers, arcs)


def _moved_paths(paths: Paths, scale: float, by: Floats) -> Paths:
    return replace(paths, points=scale * paths.points + by, handles=scale * paths.handles)


def _renumbered(mark: Mark, of_item: Ints, curves: int) -> Mark:
    """A mark with new numbers (n+1,) of its items, the last one that of none, and of its curves, so many more."""
    if isinstance(mark, Texts):
        return mark
    if isinstance(mark, Fills):
        return replace(mark, item=of_item[mark.item])
    if isinstance(mark, Paths):
        return _renumbered_paths(mark, of_item, curves)
    return replace(mark, paths=_renumbered_paths(mark.paths, of_item, curves))


def _renumbered_paths(paths: Paths, of_item: Ints, curves: int) -> Paths:
    curve = np.where(paths.curve < 0, paths.curve, paths.curve + curves)
    return replace(paths, item=of_item[paths.item], curve=curve)


# Drawings side by side in rows.


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
        The sheet, see Sheet; its margin stays empty.
    columns : int, optional
        How many stand side by side; where None, as many as make the smallest of them the largest.
    gap_mm : float
        Between cells.
    title : str
        What it shows.

    Returns
    -------
    Drawing
        See Sheet.drawing.

    Raises
    ------
    InputError
        For a page that is none, or has no room for so many; for no columns; for a gap that is negative or not finite.

    Notes
    -----
    Edge cases: without drawings the sheet is empty.

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


# Panels of a figure: side by side on one line, lettered, and at one scale.

PANEL_GAP_MM = 5.0
"""Between panels."""

LETTER_GAP = 0.6
"""From panels to their letters, in heights of these."""

MOST_PANELS = 26
"""A letter each."""


def panels(
    drawings: Sequence[Drawing],
    *,
    gap_mm: float = PANEL_GAP_MM,
    letters: str = "a)",
    size_mm: float | str = 3.5,
    text: Literal["strokes", "real"] | None = None,
    title: str = "",
    margin_mm: float = 0.0,
) -> Drawing:
    """A figure of drawings in a row, which stand on one line, with letters above them.

    Parameters
    ----------
    drawings : sequence of Drawing
        From left to right. They keep their sizes: drawn on pages at one scale (page="scale 1:2") they have that scale.
    gap_mm : float
        Between their pages.
    letters : str
        How the first one is called, with the letter that counts: "a)", "(a)", "A"; nothing for no letters.
    size_mm : float or str
        Height of the capitals of letters, or their size of type as in "10pt".
    text : {"strokes", "real"}, optional
        Letters of a pen, or texts in a font (None: texts, if some drawing has texts).
    title : str
        What the figure shows.
    margin_mm : float
        Around the row: a half of the width of pens that draw the edges of pages.

    Returns
    -------
    Drawing
        On a page that is as large as the row and its margin. What is lowest in every panel, but for its labels,
        stands on one line, and so do the letters.

    Raises
    ------
    InputError
        For no drawings or more than 26, for letters without an a or A, and for a gap or a margin that is negative or
        not finite.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> sizes = [vp.draw(box((2 * k, 2, k)), "front", page="scale 5:1") for k in (1, 2, 3)]
    >>> figure = vp.panels(sizes)
    >>> figure.width_mm == sum(one.width_mm for one in sizes) + 2 * 5
    True
    """
    if not 0 < len(drawings) <= MOST_PANELS:
        raise InputError(f"a figure of {len(drawings)} panels: expected 1 to {MOST_PANELS}")
    if not 0.0 <= gap_mm < math.inf:
        raise InputError(f"a gap of {gap_mm:g} mm: expected a length that is finite and not negative")
    if not 0.0 <= margin_mm < math.inf:
        raise InputError(f"a margin of {margin_mm:g} mm: expected a length that is finite and not negative")
    found = re.search("a", letters, re.IGNORECASE)
    if letters and not found:
        raise InputError(f"letters of panels {letters!r}: expected the first one, with an a or A, such as 'a)'")
    size = capital_height(size_mm)
    foot = np.array([_lowest_mm(drawing) for drawing in drawings])
    low = margin_mm + foot.max() - foot
    left = margin_mm + np.cumsum([0.0, *(drawing.width_mm + gap_mm for drawing in drawings)])
    high = float(max(y + drawing.height_mm for y, drawing in zip(low.tolist(), drawings, strict=True)))
    row = 0.0 if found is None else (1.0 + 2.0 * LETTER_GAP) * size
    sheet = Sheet(Page(float(left[-1]) - gap_mm + margin_mm, high + row + margin_mm, 0.0), title)
    for drawing, x, y in zip(drawings, left.tolist(), low.tolist(), strict=False):
        sheet = sheet.place(drawing, x, y)
    whole = sheet.drawing()
    if found is None:
        return whole
    if text is None:
        text = "real" if any(layer.texts for drawing in drawings for layer in drawing.layers) else "strokes"
    set_ = lettered if text == "strokes" else typeset
    names = [letters[: found.start()] + chr(ord(found[0]) + k) + letters[found.end() :] for k in range(len(drawings))]
    made = [
        set_(name, (x, high + LETTER_GAP * size), size_mm=size) for name, x in zip(names, left.tolist(), strict=False)
    ]
    strokes = [one.strokes[k] for one in made for k in range(len(one.strokes))]
    texts = Texts.joined([one.texts for one in made])
    marks: tuple[Mark, ...] = (*([page_strokes(strokes)] if strokes else []), *([texts] if len(texts) else []))
    return replace(whole, layers=(*whole.layers, Layer("panels", PENS["label"], marks)))


def _lowest_mm(drawing: Drawing) -> float:
    """The lowest height of what is drawn, its labels not among it; that of the page where there is nothing."""
    kinds = (int(LineKind.LABEL), int(LineKind.CENTRE))
    lowest = math.inf
    for layer in drawing.layers:
        for mark in layer.marks:
            if isinstance(mark, Texts) or layer.name in BESIDE_PICTURES:
                continue
            if isinstance(mark, Fills):
                points = mark.points
            else:
                paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
                named = np.isin(paths.kind, kinds)
                points = paths.points[~np.repeat(named, np.diff(paths.offsets))]
            lowest = min(lowest, float(points[:, 1].min(initial=math.inf)))
    return lowest if lowest < math.inf else 0.0


BESIDE_PICTURES = ("frame", "colour bar", "scale bar", "panels")
"""Layers of what stands around a picture."""


def shared_scale(
    drawings: Sequence[Drawing], width_mm: float, gap_mm: float = PANEL_GAP_MM, others: Sequence[Drawing] = ()
) -> float:
    """The mm for a unit of the world at which pictures side by side have a width together.

    drawings: of the pictures, on pages as large as these; gap_mm: between panels; others: the same pictures at another
    scale, if what is beside them, such as a colour bar, does not grow with it.
    Errors: InputError for central projections, which have no scale, and where there is no room.
    """
    left, slope = width_mm - (len(drawings) - 1) * gap_mm, 0.0
    for number, (drawing, other) in enumerate(zip(drawings, others or drawings, strict=True), start=1):
        if any(drawing.page_from_world[3, :3]):
            which = f"panel {number} of {len(drawings)} is in perspective"
            raise InputError(f"panels at one scale need parallel projections, such as main views: {which}")
        scale, second = (float(norm(one.page_from_world[0, :3])) for one in (drawing, other))
        grows = drawing.width_mm / scale if second == scale else (drawing.width_mm - other.width_mm) / (scale - second)
        left -= drawing.width_mm - grows * scale
        slope += grows
    if not (left > 0.0 and slope > 0.0):
        raise InputError(f"{width_mm:g} mm: no room for {len(drawings)} panels")
    return left / slope


# Strokes that belong to the sheet and to nothing in the world: frames, title blocks, marks, letters.


def page_strokes(lines: Sequence[Floats], rings: Sequence[Floats] = ()) -> Paths:
    """Open and closed polylines on the page, in mm; their points in the world are those of the page at height 0."""
    every = [*rings, *lines]
    points = np.array([*chain(*every)]).reshape(-1, 2)
    count = len(every)
    return Paths(
        points,
        ragged.offsets([len(line) for line in every]),
        np.arange(count) < len(rings),
        np.full(count, int(LineKind.LABEL)),
        np.full(count, NO_ITEM),
        np.zeros(count, dtype=np.intp),
        np.column_stack([points, np.zeros(len(points))]),
        curve=np.full(count, NO_CURVE),
    )


def rectangle(left: float, low: float, right: float, top: float) -> Floats:
    """(4,2) its corners, counter-clockwise."""
    return np.array([(left, low), (right, low), (right, top), (left, top)])


def letter_layer(letterings: Sequence[Lettering], lines: Sequence[Floats] = ()) -> Layer:
    """The layer of letters on the page, in strokes or in a font, and of thin lines that belong to them."""
    strokes = [text.strokes[k] for text in letterings for k in range(len(text.strokes))]
    marks: tuple[Mark, ...] = (page_strokes([*lines, *strokes]), Texts.joined([text.texts for text in letterings]))
    return Layer("label", PENS["label"], tuple(mark for mark in marks if len(mark)))
