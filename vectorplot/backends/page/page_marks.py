"""What every backend that makes a page draws: checked, clipped strokes and areas in thousandths of a millimetre.

A backend turns PageMarks into bytes and needs six primitives for it: a page, a pen, a polyline, a Bézier path, a filled
polygon, a shaded triangle. Because all of them draw the same integers, their pictures agree.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page.areas import Areas, areas
from vectorplot.backends.page.page_texts import PageTexts, page_texts, plain_text
from vectorplot.curves.bezier.clip_to_page import clipped_paths
from vectorplot.curves.bezier.elliptic_arcs import EllipseArcs
from vectorplot.curves.bezier.paths import BezierPaths
from vectorplot.drawing.drawing import STROKES, CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.curved_strokes import one_mark
from vectorplot.drawing.strokes.page_clip import Rectangle, clipped_parts
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.components import all_components

LARGEST_PAGE_MM = 1_000_000.0
"""A kilometre: cairo's coordinates wrap round at about three (2^23 points)."""

_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


@dataclass(frozen=True, eq=False)
class PageStrokes:
    """Strokes of one layer, as they appear on the page.

    microns (p,2) int64, y upwards; offsets (m+1,); closed (m,); curved (m,): a cubic Bézier path, the points of which
    are its first point and three more for each segment; the others are polylines. A curve lies on the page, its handles
    may reach beyond it. No two neighbouring points of a polyline are equal, an open one has two points or more and a
    closed one three or more. arcs: the curves that are arcs of ellipses, in mm, where a format can say so.
    """

    microns: Ints
    offsets: Ints
    closed: Bools
    curved: Bools
    arcs: EllipseArcs

    def __len__(self) -> int:
        return len(self.offsets) - 1


@dataclass(frozen=True, eq=False)
class Ink:
    """What one layer puts on the page: strokes, areas and texts in drawing order."""

    label: str
    pen: Pen
    parts: tuple[PageStrokes | Areas | PageTexts, ...]

    @property
    def areas(self) -> tuple[Areas, ...]:
        """The parts that are areas."""
        return tuple(part for part in self.parts if isinstance(part, Areas))


@dataclass(frozen=True, eq=False)
class PageMarks:
    """A page and its inks in drawing order. Width and height in microns; title: one line without control characters."""

    width: int
    height: int
    inks: tuple[Ink, ...]
    title: str


def page_marks(drawing: Drawing) -> PageMarks:
    """The drawing as a backend sees it: clipped to the page and rounded to thousandths of a millimetre.

    The label of a layer is its number from 1 and its name, with the prefix % if it is not to be plotted.
    Errors: InputError for a point, page or pen width that is not finite, a page without area or larger than
    LARGEST_PAGE_MM, a colour other than #rrggbb, an opacity that is not from 0 to 1. Degenerate: strokes without length
    and polygons without area are dropped.
    """
    check(drawing)
    inks = tuple(_ink(drawing, layer, number) for number, layer in enumerate(drawing.layers, start=1))
    width, height = (max(1, round(side * 1000.0)) for side in (drawing.width_mm, drawing.height_mm))
    return PageMarks(width, height, inks, plain_text(drawing.title))


def check(drawing: Drawing) -> None:
    """Refuse what no file can hold.

    Errors: as page_marks.
    """
    for side in (drawing.width_mm, drawing.height_mm):
        if not 0.0 < side <= LARGEST_PAGE_MM:
            size = f"{drawing.width_mm:g} x {drawing.height_mm:g} mm"
            raise InputError(f"page of {size}: sides must be more than 0 and at most {LARGEST_PAGE_MM:.0f} mm")
    for layer in drawing.layers:
        if not _COLOUR.fullmatch(layer.pen.colour):
            raise InputError(f"layer {layer.name!r}: colour {layer.pen.colour!r} is not #rrggbb")
        if not 0.0 < layer.pen.width_mm <= LARGEST_PAGE_MM:
            raise InputError(f"layer {layer.name!r}: pen width of {layer.pen.width_mm:g} mm")
        points = [paths.points for paths in layer.strokes]
        points += [mark.beziers.control for mark in layer.marks if isinstance(mark, CurvedStrokes)]
        points += [fills.points for fills in layer.fills]
        points += [array for some in layer.texts for array in (some.points, some.size_mm, some.turn_deg, some.anchor)]
        if not all(np.isfinite(some).all() for some in points):
            raise InputError(f"layer {layer.name!r}: a point on the page is not finite")
        if not all(((fills.opacity >= 0.0) & (fills.opacity <= 1.0)).all() for fills in layer.fills):
            raise InputError(f"layer {layer.name!r}: an opacity is not a number from 0 to 1")


def _ink(drawing: Drawing, layer: Layer, number: int) -> Ink:
    label = f"{'' if layer.plotted else '%'}{number} {plain_text(layer.name)}".rstrip()
    parts: list[PageStrokes | Areas | PageTexts] = []
    for kind, marks in groupby(layer.marks, _sort):
        some = tuple(marks)
        if kind is Fills:
            fills = Fills.joined(*(mark for mark in some if isinstance(mark, Fills)))
            parts.append(areas(fills, drawing.width_mm, drawing.height_mm))
        elif kind is Texts:
            parts.append(page_texts(Texts.joined([mark for mark in some if isinstance(mark, Texts)]), layer.pen.colour))
        else:
            parts.append(_lines(drawing, one_mark(tuple(mark for mark in some if isinstance(mark, STROKES)))))
    return Ink(label, layer.pen, tuple(parts))


def _sort(mark: object) -> type:
    """Marks of one sort that follow one another are drawn together."""
    return next(sort for sort in (Fills, Texts, object) if isinstance(mark, sort))


def _lines(drawing: Drawing, mark: CurvedStrokes) -> PageStrokes:
    page = (0.0, 0.0, drawing.width_mm, drawing.height_mm)
    drawn_straight = np.flatnonzero(np.diff(mark.beziers.offsets) == 0)
    lines, line = clipped_parts(chosen(mark.paths, drawn_straight), page, drawing.page_from_world)
    beziers, curve = clipped_paths(mark.beziers, np.array(page[:2]), np.array(page[2:]))
    straight, kept = _without_repeats(lines)
    curved, stays = _control_polygons(beziers)
    source = np.concatenate((drawn_straight[line[kept]], curve[stays]))
    order = np.argsort(source, kind="stable")
    count = np.concatenate((np.diff(straight.offsets), np.diff(curved.offsets)))[order]
    first = np.concatenate((straight.offsets[:-1], curved.offsets[:-1] + len(straight.microns)))[order]
    return PageStrokes(
        np.concatenate((straight.microns, curved.microns))[ragged.ranges(first, count)],
        ragged.offsets(count),
        np.concatenate((straight.closed, curved.closed))[order],
        order >= len(straight.closed),
        _whole_arcs(mark, page, source[order]),
    )


@dataclass(frozen=True, eq=False)
class _Rounded:
    """Strokes with points in microns (p,2), offsets (m+1,) and closed (m,)."""

    microns: Ints
    offsets: Ints
    closed: Bools


def _in_microns(points: Floats) -> Ints:
    return np.rint(points * 1000.0).astype(np.int64)


def _without_repeats(paths: Paths) -> tuple[_Rounded, Bools]:
    """The strokes rounded, without repeated points and without strokes of no length; (m,) which of them remain."""
    microns = _in_microns(paths.points)
    counts = np.diff(paths.offsets)
    filled = np.flatnonzero(counts > 0)
    starts, ends = paths.offsets[:-1][filled], paths.offsets[1:][filled]
    new = np.ones(len(microns), dtype=np.bool_)
    new[1:] = (microns[1:] != microns[:-1]).any(axis=1)
    new[starts] = True
    # The last run of equal points of a loop is dropped if it repeats the first point.
    seam = paths.closed[filled] & all_components(microns[starts] == microns[ends - 1])
    places = np.flatnonzero(new)
    last = places[np.searchsorted(places, ends) - 1]
    new[last[seam & (last > starts)]] = False
    counts = np.add.reduceat(new.astype(np.intp), starts) if len(filled) else counts[filled]
    long = counts > 1
    points = microns[new][np.repeat(long, counts)]
    remains = np.zeros(len(paths), dtype=np.bool_)
    remains[filled[long]] = True
    return _Rounded(points, ragged.offsets(counts[long]), (paths.closed[filled] & (counts > 2))[long]), remains


def _control_polygons(paths: BezierPaths) -> tuple[_Rounded, Bools]:
    """The control points of each path, one row; without paths that are no longer than the rounding; (m,) which of them
    remain."""
    control = _in_microns(paths.control)
    size = np.diff(paths.offsets)
    if not len(size):
        return _Rounded(np.zeros((0, 2), np.int64), paths.offsets, paths.closed), np.zeros(0, dtype=np.bool_)
    moves = (control != control[np.repeat(paths.offsets[:-1], size), :1]).any(axis=(1, 2))
    remains = np.logical_or.reduceat(moves, paths.offsets[:-1])
    control = control[np.repeat(remains, size)]
    offsets = ragged.offsets(3 * size[remains] + 1)
    heads = ragged.offsets(size[remains])[:-1]
    microns = np.insert(control[:, 1:].reshape(-1, 2), 3 * heads, control[heads, 0], axis=0)
    return _Rounded(microns, offsets, paths.closed[remains]), remains


def _whole_arcs(mark: CurvedStrokes, page: Rectangle, source: Ints) -> EllipseArcs:
    """The arcs of strokes that the page does not cut; source (m,): the stroke of the mark of each stroke that is drawn,
    ascending."""
    control = mark.beziers.control
    out = ((control < page[:2]) | (control > page[2:])).any(axis=(1, 2))
    owner = ragged.owner(np.diff(mark.beziers.offsets))
    cut = np.bincount(owner[out], minlength=len(mark))[mark.arcs.stroke] > 0
    arcs = mark.arcs.some(~cut & np.isin(mark.arcs.stroke, source))
    return replace(arcs, stroke=np.searchsorted(source, arcs.stroke))
