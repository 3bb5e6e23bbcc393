"""DXF for programs of computer-aided design: polylines, arcs, splines and hatches in mm."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.backends.page import Areas, Ink, PageMarks, PageStrokes, PageTexts, page_marks
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2, tan
from vectorplot.geometry.vectors import cross
from vectorplot.scene.labels import TYPE_SIZE
from vectorplot.tolerances import COINCIDENT_MM, LEAST_DIVISOR, WHOLE_TURN

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace


# The widths in hundredths of a mm that the format has.
_WIDTHS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211)

ROUNDED_MM = 1.0 / 1000.0
"""What places on the page are rounded to."""

_FORBIDDEN = str.maketrans(dict.fromkeys('<>/\\":;?*|=`', "_"))


def dxf_bytes(drawing: Drawing) -> bytes:
    """The drawing as a DXF file.

    Source: Autodesk, DXF reference.
    """
    page = page_marks(drawing)
    with _no_dates():
        return _bytes(page)


def _bytes(page: PageMarks) -> bytes:
    from ezdxf import units
    from ezdxf.filemanagement import new

    document = new("R2010", units=units.MM)
    width, height = page.width / 1000.0, page.height / 1000.0
    space = document.modelspace()
    space.reset_extents((0.0, 0.0, 0.0), (width, height, 0.0))
    space.reset_limits((0.0, 0.0), (width, height))
    for ink in page.inks:
        _layer(document, space, ink)
    # ezdxf names the classes of objects in the order of a set, which changes from process to process.
    document.classes.add_required_classes(document.dxfversion)
    document.classes.classes = dict(sorted(document.classes.classes.items()))
    text = io.StringIO()
    document.write(text)
    data: bytes = document.encode(text.getvalue())
    return data


@contextmanager
def _no_dates() -> Iterator[None]:
    """ezdxf writes when and under which number a file was made, unless it is told not to, for all of the program."""
    from ezdxf._options import options

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def _layer(document: Document, space: Modelspace, ink: Ink) -> None:
    name = ink.label.lstrip("%").translate(_FORBIDDEN)[:255]
    layer = document.layers.add(
        name,
        true_color=int(ink.pen.colour[1:], 16),
        lineweight=min(_WIDTHS, key=lambda width: abs(width - 100.0 * ink.pen.width_mm)),
        plot=not ink.label.startswith("%"),
    )
    layer.description = ink.label
    for part in ink.parts:
        if isinstance(part, Areas):
            _areas(space, part, name)
        elif isinstance(part, PageTexts):
            _texts(space, part, name)
        else:
            _strokes(space, part, name)


def _strokes(space: Modelspace, lines: PageStrokes, layer: str) -> None:
    points = lines.microns / 1000.0
    own = {"layer": layer}
    arcs = np.full(len(lines), -1)
    arcs[lines.arcs.stroke] = np.arange(len(lines.arcs))
    flags = np.stack([lines.closed, lines.curved, lines.curved & ~_are_straight(lines)], axis=1).tolist()
    rows = zip(pairwise(lines.offsets.tolist()), flags, arcs.tolist(), strict=True)
    for (begin, end), (closed, curved, bent), arc in rows:
        if arc >= 0:
            _arc(space, lines, arc, own)
        elif bent and (bulges := _bulges(points[begin:end])) is not None:
            corners = np.column_stack([points[begin:end:3], np.append(bulges, 0.0)])[: -1 if closed else None]
            space.add_lwpolyline(corners.tolist(), format="xyb", close=closed, dxfattribs=own)
        elif bent:
            _spline(space, points[begin:end], closed, own)
        elif curved:
            space.add_lwpolyline(points[[begin, end - 1]].tolist(), dxfattribs=own)
        else:
            space.add_lwpolyline(points[begin:end].tolist(), close=closed, dxfattribs=own)


def _bulges(control: Floats) -> Floats | None:
    """(s,) the bulges of the segments of a Bézier path, tangents of a quarter of their turns, where all of them are
    straight lines and arcs of circles within the rounding of the page; else None."""
    first, last = control[:-1:3], control[3::3]
    ahead, back = control[1::3] - first, last - control[2::3]
    chord = last - first
    length = np.hypot(*chord.T)
    half = arctan2(cross(ahead, chord), (ahead * chord).sum(axis=1))
    straight = np.abs(cross(ahead, chord)) + np.abs(cross(back, chord)) <= 2.0 * ROUNDED_MM * length
    half = np.where(straight, 0.0, half)
    # Handles of an arc with this turn, as they would be.
    handle = length / (3.0 * np.maximum(np.cos(half / 2.0) ** 2, LEAST_DIVISOR))
    cosine, sine = np.cos(half), np.sin(half)
    x, y = chord.T / np.maximum(length, LEAST_DIVISOR)
    begin = handle[:, None] * np.stack([cosine * x + sine * y, cosine * y - sine * x], axis=1)
    end = handle[:, None] * np.stack([cosine * x - sine * y, cosine * y + sine * x], axis=1)
    off = np.maximum(np.abs(begin - ahead), np.abs(end - back)).max(axis=1)
    if not (straight | (off <= 4.0 * ROUNDED_MM)).all():
        return None
    return np.asarray(tan(half / 2.0))


def _are_straight(lines: PageStrokes) -> Bools:
    """(m,) the strokes whose points, or control points, lie within a micron of the way from the first to the last one,
    in order: as the meridians of what is seen from above."""
    if not len(lines):
        return np.zeros(0, dtype=np.bool_)
    first, last = lines.offsets[:-1], lines.offsets[1:] - 1
    points, way = lines.microns.astype(np.float64), (lines.microns[last] - lines.microns[first]).astype(np.float64)
    owner = ragged.owner(np.diff(lines.offsets))
    arm, along = points - points[first][owner], way[owner]
    off = np.abs(cross(arm, along))
    part = (arm * along).sum(axis=1)
    back = np.diff(part, prepend=part[:1]) < 0.0
    back[first] = False
    length = np.hypot(*way.T)
    straight = (np.maximum.reduceat(off, first) <= length) & ~np.logical_or.reduceat(back, first)
    return np.asarray(straight & (length > 0.0))


def _texts(space: Modelspace, texts: PageTexts, layer: str) -> None:
    from ezdxf.enums import TextEntityAlignment

    anchors = {0.0: TextEntityAlignment.LEFT, 0.5: TextEntityAlignment.CENTER, 1.0: TextEntityAlignment.RIGHT}
    for point, size, turn, anchor, colour, string in zip(
        (texts.microns / 1000.0).tolist(),
        (texts.type_mm * TYPE_SIZE).tolist(),
        texts.turn_deg.tolist(),
        texts.anchor.tolist(),
        texts.colours,
        texts.plain,
        strict=True,
    ):
        own = {"layer": layer, "true_color": int(colour[1:], 16)}
        text = space.add_text(_as_it_stands(string), height=size, rotation=turn, dxfattribs=own)
        text.set_placement(point, align=anchors[anchor])


def _as_it_stands(string: str) -> str:
    """The text with what the format takes for codes spelled out."""
    return string.replace("%%", "%%%%%%").replace("^", "^ ")


def _arc(space: Modelspace, lines: PageStrokes, arc: int, own: dict[str, Any]) -> None:
    arcs = lines.arcs
    centre, first, second = arcs.centre[arc], arcs.first[arc], arcs.second[arc]
    start, end = sorted((float(arcs.start[arc]), float(arcs.end[arc])))
    if first[0] * second[1] < first[1] * second[0]:
        # The format knows ellipses that run counter-clockwise only.
        second, start, end = -second, -end, -start
    whole = end - start >= 2.0 * np.pi - WHOLE_TURN
    sizes = np.hypot(*first), np.hypot(*second)
    if abs(sizes[0] - sizes[1]) <= COINCIDENT_MM:
        if whole:
            space.add_circle(centre.tolist(), sizes[0], dxfattribs=own)
            return
        begin, stop = np.degrees(np.array([start, end]) + arctan2(first[1], first[0])).tolist()
        space.add_arc(centre.tolist(), sizes[0], begin, stop, dxfattribs=own)
        return
    if sizes[1] > sizes[0]:
        # The first semi-axis has to be the longer one.
        first, start, end = second, start - np.pi / 2.0, end - np.pi / 2.0
    if whole:
        start, end = 0.0, 2.0 * np.pi
    space.add_ellipse(
        centre.tolist(), (*first.tolist(), 0.0), float(min(sizes) / max(sizes)), start, end, dxfattribs=own
    )


def _spline(space: Modelspace, control: Floats, closed: bool, own: dict[str, Any]) -> None:
    """The Bézier segments of a path as a cubic B-spline with threefold knots, whose ends meet where it is closed."""
    segments = (len(control) - 1) // 3
    knots = np.repeat(np.arange(segments + 1), 3)
    spline = space.add_spline(dxfattribs={**own, "degree": 3})
    spline.closed = closed
    spline.control_points = np.column_stack([control, np.zeros(len(control))]).tolist()
    spline.knots = [0, *knots.tolist(), segments]


def _areas(space: Modelspace, areas: Areas, layer: str) -> None:
    if not len(areas):
        return
    points = areas.microns / 1000.0
    mean = np.add.reduceat(areas.colours.astype(np.float64), areas.offsets[:-1]) / areas.sizes[:, None]
    colours = (np.rint(mean).astype(np.intp) @ (65536, 256, 1)).tolist()
    # What is painted at the rims of groups is for readers that blend pixels.
    for k in np.flatnonzero(~areas.fringe).tolist():
        corners = points[areas.offsets[k] : areas.offsets[k + 1]].tolist()
        if len(corners) == 2:
            space.add_lwpolyline(corners, dxfattribs={"layer": layer, "true_color": colours[k]})
            continue
        hatch = space.add_hatch(dxfattribs={"layer": layer, "true_color": colours[k]})
        if areas.opacity[k] < 1.0:
            hatch.transparency = 1.0 - float(areas.opacity[k])
        hatch.paths.add_polyline_path(corners, is_closed=True)
