"""What every backend that makes a page draws: checked, clipped strokes in thousandths of a millimetre.

A backend turns a Sheet into bytes and needs three primitives for it: a page, a pen, a polyline. Because all of them
draw the same integers, their pictures agree.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

import numpy as np

from vectorplot.drawing.clip import clipped
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.pieces import concatenated, offsets_of
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Bools, Ints

LARGEST_PAGE_MM = 1_000_000.0
"""A kilometre: cairo's coordinates wrap round at about three (2^23 points)."""

_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


@dataclass(frozen=True, eq=False)
class Ink:
    """The polylines of one layer, as they appear on the page.

    microns (p,2) int64, y upwards, all of them on the page; offsets (m+1,); closed (m,). No two neighbouring points are
    equal, an open polyline has two points or more and a closed one three or more.
    """

    label: str
    pen: Pen
    microns: Ints
    offsets: Ints
    closed: Bools


@dataclass(frozen=True, eq=False)
class Sheet:
    """A page and its inks in drawing order. Width and height in microns; title: one line without control characters."""

    width: int
    height: int
    inks: tuple[Ink, ...]
    title: str


def sheet(drawing: Drawing) -> Sheet:
    """The drawing as a backend sees it: clipped to the page and rounded to thousandths of a millimetre.

    The label of a layer is its number from 1 and its name, with the prefix % if it is not to be plotted.
    Errors: InputError for a point, page or pen width that is not finite, a page without area or larger than
    LARGEST_PAGE_MM, a colour other than #rrggbb. Degenerate: strokes without length are dropped.
    """
    check(drawing)
    inks = tuple(_ink(drawing, layer, number) for number, layer in enumerate(drawing.layers, start=1))
    width, height = (max(1, round(side * 1000.0)) for side in (drawing.width_mm, drawing.height_mm))
    return Sheet(width, height, inks, plain_text(drawing.title))


def check(drawing: Drawing) -> None:
    """Refuse what no file can hold.

    Errors: as sheet.
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
        for paths in layer.marks:
            if not np.isfinite(paths.points).all():
                raise InputError(f"layer {layer.name!r}: a point on the page is not finite")


def plain_text(text: str) -> str:
    """The text on one line, without control characters and what else XML forbids."""
    kept = (" " if c.isspace() else c for c in text if c.isspace() or unicodedata.category(c) not in ("Cc", "Cs", "Cn"))
    return " ".join("".join(kept).split())


def _ink(drawing: Drawing, layer: Layer, number: int) -> Ink:
    page = (0.0, 0.0, drawing.width_mm, drawing.height_mm)
    paths = concatenated(tuple(clipped(marks, page, drawing.page_from_world) for marks in layer.marks))
    label = f"{'' if layer.plotted else '%'}{number} {plain_text(layer.name)}".rstrip()
    return Ink(label, layer.pen, *_without_repeats(paths))


def _without_repeats(paths: Paths) -> tuple[Ints, Ints, Bools]:
    """Points in microns, offsets and closed flags; repeated points and strokes without length are gone."""
    microns = np.rint(paths.points * 1000.0).astype(np.int64)
    counts = np.diff(paths.offsets)
    filled = np.flatnonzero(counts > 0)
    starts, ends = paths.offsets[:-1][filled], paths.offsets[1:][filled]
    new = np.ones(len(microns), dtype=np.bool_)
    new[1:] = (microns[1:] != microns[:-1]).any(axis=1)
    new[starts] = True
    # The last run of equal points of a loop is dropped if it repeats the first point.
    seam = paths.closed[filled] & (microns[starts] == microns[ends - 1]).all(axis=1)
    places = np.flatnonzero(new)
    last = places[np.searchsorted(places, ends) - 1]
    new[last[seam & (last > starts)]] = False
    counts = np.add.reduceat(new.astype(np.intp), starts) if len(filled) else counts[filled]
    long = counts > 1
    points = microns[new][np.repeat(long, counts)]
    return points, offsets_of(counts[long]), (paths.closed[filled] & (counts > 2))[long]
