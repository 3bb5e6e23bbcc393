"""PostScript, EPS, PDF and PNG through cairo: filled and shaded polygons, texts, and PDF files of several pages."""

from __future__ import annotations

import io
import math
import re
import zlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page import (
    Areas,
    PageMarks,
    PageStrokes,
    PageTexts,
    border_sides,
    last_of_sides,
    outer_sides,
    page_marks,
    rings,
    shaded,
    skirts,
)
from vectorplot.backends.raster import smoothly_painted
from vectorplot.backends.shaded_triangles import Underlaps, grown, underlaps
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import SEAM_MM, FillKind, Fills
from vectorplot.drawing.sheets import Mark, moved_mark
from vectorplot.drawing.texts import is_font_file
from vectorplot.errors import InputError, not_installed
from vectorplot.geometry import ragged
from vectorplot.shading.image import DPI, Bytes, with_meaning

try:
    import cairo
except ImportError:
    raise not_installed("a drawing as PDF, PostScript, EPS, PNG or video", "pycairo", "cairo") from None

# Small flat polygons among shaded triangles, as triangles of the same mesh.
#
# A mesh that ends at every polygon of one colour has as many borders as there are such polygons: where a fine surface
# is painted, the lines, skirts and clips along these would be most of the file.

SMALL_MICRONS = 1500
"""Wider and higher polygons keep their own borders, which are smoothed one by one; smaller ones hardly have any."""


def in_meshes(areas: Areas) -> Areas:
    """The same with the triangles of their fans in place of small convex polygons that stand in a row of solid ones of
    one item, group and part, some of which are shaded.

    Edge cases: polygons that are not convex, or begin with three corners in a line, stay.
    """
    if not areas.shaded.any():
        return areas
    small = np.flatnonzero(areas.solid & (areas.sizes > 3))
    small = small[_fan_out(areas, small)]
    split = np.zeros(len(areas), dtype=np.bool_)
    split[small] = True
    split &= _among_shaded(areas, areas.solid & ((areas.sizes == 3) | split))
    if not split.any():
        return areas
    count = np.where(split, areas.sizes - 2, 1)
    every, sizes = ragged.owner(count), np.repeat(np.where(split, 3, areas.sizes), count)
    corner = ragged.ranges(areas.offsets[every], sizes)
    beyond_first = np.ones(len(corner), dtype=np.bool_)
    beyond_first[ragged.starts(sizes)] = False
    corner += np.repeat(np.where(split[every], ragged.place(count), 0), sizes) * beyond_first
    return Areas(
        areas.microns[corner],
        ragged.offsets(sizes),
        areas.colours[corner],
        areas.opacity[every],
        areas.bare[every],
        areas.group[every],
        areas.part[every],
        areas.fringe[every],
        areas.item[every],
        areas.look[every],
    )


def _fan_out(areas: Areas, which: Ints) -> Bools:
    """(w,) the polygons, of more than three corners, that are small, convex and the sum of their fans."""
    position, offsets = ragged.take(areas.offsets, which)
    points = areas.microns[position]
    if not len(which):
        return np.zeros(0, dtype=np.bool_)
    starts, after = offsets[:-1], ragged.following(offsets)
    size = np.maximum.reduceat(points, starts, axis=0) - np.minimum.reduceat(points, starts, axis=0)
    side = points[after] - points
    turns = _turns(side, side[after])
    arm = points - np.repeat(points[starts], np.diff(offsets), axis=0)
    fan = _turns(arm, arm[after])
    # The sides that begin or end in the first corner make no triangle.
    fan[starts] = fan[offsets[1:] - 1] = 1
    small = (size < SMALL_MICRONS).all(axis=1)
    return np.asarray(small & (np.minimum.reduceat(turns, starts) >= 0) & (np.minimum.reduceat(fan, starts) > 0))


def _turns(one: Ints, two: Ints) -> Ints:
    """(p,) positive where the second direction is to the left of the first."""
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def _among_shaded(areas: Areas, able: Bools) -> Bools:
    """(m,) which polygons are in a row of able ones of one item, group and part that has a shaded one."""
    new = np.ones(len(areas), dtype=np.bool_)
    new[1:] = able[1:] != able[:-1]
    for label in (areas.item, areas.group, areas.part):
        new[1:] |= label[1:] != label[:-1]
    row = np.cumsum(new) - 1
    return np.asarray(able & (np.bincount(row, weights=areas.shaded) > 0.0)[row])


# Filled polygons through cairo.

Corners = Any

GROUND_STEPS = 32.0
"""Shades of each colour below meshes."""


def paint(
    context: cairo.Context[Any], areas: Areas, scale: float, height: float, line_width: float, seam: float
) -> None:
    """Paint the polygons. Cairo takes one side a call, so this loops over points.

    scale: device units per micron; height: of the page's lower border in them, from the top; line_width: of polygons of
    two corners; seam: of the line around opaque ones amid a surface that have sides without a partner.
    """
    place, areas = _Place(scale, height), in_meshes(areas)
    laps = underlaps(areas)
    outlines, offsets, parts = grown(areas, laps)
    heads = areas.runs[:-1]
    colours = (areas.colours[areas.offsets[heads]] / 255.0).tolist()
    meshed, line = areas.meshed[heads].tolist(), (areas.sizes[heads] == 2).tolist()
    opacity = areas.own_opacity[heads].tolist()
    open_ = np.logical_or.reduceat(laps.open, heads).tolist() if len(heads) else []
    ends, part_ends = dict(areas.group_ends.tolist()), dict(areas.part_ends.tolist())
    end, part_end, clip = -1, -1, None
    for run, (first, last) in enumerate(pairwise(areas.runs.tolist())):
        if first in ends:
            end = ends[first]
            clip = _clip_of(areas, place, first, end)
            _begin_group(context, clip[0])
        if first in part_ends:
            part_end = part_ends[first]
            _begin_part(context, *_clip_of(areas, place, first, part_end))
        if meshed[run]:
            _paint_mesh(context, areas, place, laps, (first, last))
        else:
            starts = offsets[parts[first] : parts[last] + 1]
            _outline(context, place.of(outlines[starts[0] : starts[-1]]), (starts - starts[0]).tolist())
            red, green, blue = colours[run]
            context.set_source_rgba(red, green, blue, opacity[run])
            if line[run]:
                context.set_line_width(line_width)
                context.stroke()
            elif not open_[run]:
                context.fill()
            else:
                context.set_line_width(seam)
                context.fill_preserve()
                context.stroke()
        if last == part_end:
            context.restore()
            part_end = -1
        if clip is not None and last == end:
            _end_group(context, *clip, float(areas.opacity[first]))
            clip = None


@dataclass(frozen=True)
class _Place:
    """Where microns are on the device."""

    scale: float
    height: float

    def of(self, microns: NDArray[Any]) -> Corners:
        """Places (..., 2) on the device, as lists."""
        found: Corners = self.on_device(microns).tolist()
        return found

    def on_device(self, microns: NDArray[Any]) -> Floats:
        """Places (..., 2) on the device."""
        return np.asarray(microns * (self.scale, -self.scale) + (0.0, self.height))


def _paint_mesh(
    context: cairo.Context[Any], areas: Areas, place: _Place, laps: Underlaps, run: tuple[int, int]
) -> None:
    """Paint a run of shaded triangles as one mesh, on flat ones, and within its border: there are readers that smooth
    what is clipped, but not meshes, and others that do not smooth that either."""
    starts = areas.offsets[[run[0], run[1]]].tolist()
    corners, colours = areas.microns[starts[0] : starts[1]], areas.colours[starts[0] : starts[1]] / 255.0
    opacity = float(areas.own_opacity[run[0]])
    patches = corners.astype(np.float64).reshape(-1, 3, 2)[:, [0, 1, 2, 0]]
    at = np.arange(len(corners)).reshape(-1, 3)[:, [0, 1, 2, 0]]
    context.save()
    if opacity == 1.0:
        sides = border_sides(corners)
        seen = outer_sides(corners, sides[last_of_sides(corners, sides)])
        _ground(context, place, corners, colours.reshape(-1, 3, 3).mean(axis=1))
        patches = np.concatenate((skirts(corners, seen), patches))
        at = np.concatenate((seen[:, [0, 1, 1, 0]], at))
        path = [corners[ring] for ring in rings(corners, sides)]
        path += list(_underlaps_of(areas, laps, (starts[0], starts[1]), sides[:, 0]))
    else:
        # Meshes cover all of the pixels on their borders: where neighbours meet, things would be seen twice.
        path = list(corners.reshape(-1, 3, 2))
    sizes = [0, *(len(ring) for ring in path)]
    _outline(context, place.of(np.concatenate(path)), np.cumsum(sizes).tolist())
    context.clip()
    context.set_source(_mesh(place.on_device(patches), colours[at], opacity))
    context.paint()
    context.restore()


def _ground(context: cairo.Context[Any], place: _Place, corners: Ints, colours: Floats) -> None:
    """Fill triangles in about their colours, many at once by what encloses them together: what a reader forgets between
    the triangles of a mesh shows this."""
    steps, group = np.unique(np.rint(colours * GROUND_STEPS), axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind="stable")
    ends = np.searchsorted(group.ravel()[order], np.arange(1, len(steps) + 1)).tolist()
    triangles, start = corners.reshape(-1, 3, 2), 0
    for (red, green, blue), end in zip((steps / GROUND_STEPS).tolist(), ends, strict=True):
        some = triangles[order[start:end]].reshape(-1, 2)
        path = [some[ring] for ring in rings(some, border_sides(some))]
        if path:
            _outline(context, place.of(np.concatenate(path)), ragged.offsets([*map(len, path)]).tolist())
        context.set_source_rgb(red, green, blue)
        context.fill()
        start = end


def _underlaps_of(areas: Areas, laps: Underlaps, corners: tuple[int, int], border: Ints) -> Floats:
    """(k,4,2) what is added to a run of triangles under polygons of other runs, counter-clockwise; border: the corners
    of the run at which its border sides begin."""
    low, high = np.searchsorted(laps.side, corners)
    side = laps.side[low:high]
    strips = laps.added[np.isin(laps.along, border + corners[0])]
    which = np.isin(side - corners[0], border)
    side, near, far = side[which], laps.near[low:high][which], laps.far[low:high][which]
    end = np.where((side - corners[0]) % 3 == 2, side - 2, side + 1)
    return np.concatenate((np.stack((areas.microns[end], areas.microns[side], near, far), axis=1), strips))


def _clip_of(areas: Areas, place: _Place, first: int, last: int) -> tuple[Corners, list[int]]:
    """Corners of the outline of polygons from first to before last on the device, and where its rings begin."""
    corners, border = areas.outline(first, last)
    return place.of(corners), border.tolist()


def _begin_part(context: cairo.Context[Any], corners: Corners, rings: list[int]) -> None:
    """Paint inside of an outline from now on."""
    context.save()
    _outline(context, corners, rings)
    context.set_fill_rule(cairo.FILL_RULE_EVEN_ODD)
    context.clip()
    context.set_fill_rule(cairo.FILL_RULE_WINDING)


def _begin_group(context: cairo.Context[Any], corners: Corners) -> None:
    """Paint to a transparency group from now on, as large as the whole pixels or points around its outline."""
    places = np.array(corners).reshape(-1, 2)
    low, high = np.floor(places.min(axis=0)), np.ceil(places.max(axis=0))
    context.save()
    context.rectangle(*low.tolist(), *(high - low).tolist())
    context.clip()
    context.push_group()


def _end_group(context: cairo.Context[Any], corners: Corners, rings: list[int], opacity: float) -> None:
    """Blend the group inside its outline: a clip set before would cover the pixels on its border twice."""
    context.pop_group_to_source()
    _outline(context, corners, rings)
    context.set_fill_rule(cairo.FILL_RULE_EVEN_ODD)
    context.clip()
    context.paint_with_alpha(opacity)
    context.restore()


def _outline(context: cairo.Context[Any], points: Corners, starts: list[int]) -> None:
    """Add polygons to the path."""
    move_to, line_to, close_path = context.move_to, context.line_to, context.close_path
    for start, end in pairwise(starts):
        move_to(*points[start])
        for x, y in points[start + 1 : end]:
            line_to(x, y)
        if end - start > 2:
            close_path()


def _mesh(patches: Floats, colours: Floats, opacity: float) -> cairo.MeshPattern:
    """Patches (n,4,2) of four corners, the last of which may be the first one, shaded from colours (n,4,3). Cairo takes
    one corner a call."""
    mesh = cairo.MeshPattern()
    begin, move_to, line_to, shade, end = (
        mesh.begin_patch,
        mesh.move_to,
        mesh.line_to,
        mesh.set_corner_color_rgba,
        mesh.end_patch,
    )
    # Numbers in columns: a list for every corner would keep the collector of garbage busy.
    columns = np.concatenate((patches.reshape(-1, 8), colours.reshape(-1, 12)), axis=1).T.tolist()
    for ax, ay, bx, by, cx, cy, dx, dy, ar, ag, ab, br, bg, bb, cr, cg, cb, dr, dg, db in zip(*columns, strict=True):
        begin()
        move_to(ax, ay)
        line_to(bx, by)
        line_to(cx, cy)
        line_to(dx, dy)
        shade(0, ar, ag, ab, opacity)
        shade(1, br, bg, bb, opacity)
        shade(2, cr, cg, cb, opacity)
        shade(3, dr, dg, db, opacity)
        end()
    return mesh


# Bytes as printable text, four in five characters, as PostScript files hold them; in bulk.
#
# Source: PostScript Language Reference, section 3.13.3 (ASCII85Encode and ASCII85Decode).

_POWERS = 85 ** np.arange(4, -1, -1, dtype=np.int64)
_FIRST, _LAST, _ZEROS = ord("!"), b"u", b"z"
_LINE = 80


def ascii85_decoded(text: bytes) -> bytes:
    """The bytes that a text without its end mark stands for; white space in it is passed over.

    Edge cases: no text, no bytes.
    """
    digits = b"".join(text.split()).replace(_ZEROS, b"!!!!!")
    missing = -len(digits) % 5
    rows = np.frombuffer(digits + missing * _LAST, dtype=np.uint8).reshape(-1, 5).astype(np.int64) - _FIRST
    return (rows @ _POWERS).astype(">u4").tobytes()[: 4 * len(rows) - missing]


def ascii85_encoded(data: bytes) -> bytes:
    """The text of bytes, without an end mark, in lines of 80 characters; four zeros are one character.

    Edge cases: no bytes, no text.
    """
    missing = -len(data) % 4
    words = np.frombuffer(data + bytes(missing), dtype=">u4").astype(np.int64)
    digits = (words[:, None] // _POWERS % 85 + _FIRST).astype(np.uint8)
    size = np.full(len(words), 5)
    # The last word is written out, cut by as many characters as it lacks bytes.
    short = (words == 0) & (np.arange(len(words)) < len(words) - (missing > 0))
    digits[short, 0], size[short] = ord(_ZEROS), 1
    size[-1:] -= missing
    text = digits[np.arange(5) < size[:, None]].tobytes()
    return b"\n".join(text[start : start + _LINE] for start in range(0, len(text), _LINE))


# Meshes in PDF and PostScript files as triangles, where cairo writes patches of bicubic surfaces.
#
# A patch takes 153 bytes that are not compressed; readers divide it into pieces, some of which they miss where it has
# only three corners. The same file with shadings of type 4 (free-form triangles with colours at their corners) is a
# twentieth as large, and exact. Source: ISO 32000-1, section 8.7.4.5 (types 4 and 7) and 7.5 (structure of files);
# PostScript Language Reference, 4.9.3.

_HEAD = rb"<< /ShadingType 7\s+/ColorSpace /Device(RGB|Gray)\s+"
_BITS = rb"/BitsPerCoordinate 32\s+/BitsPerComponent 16\s+/BitsPerFlag 8\s+/Decode \[([^\]]*)\]\s+"
_IN_PDF = re.compile(_HEAD + _BITS + rb"/Length (\d+)\s+>>\s+stream\n")
_IN_PS = re.compile(
    rb"currentfile\n/ASCII85Decode filter /FlateDecode filter /ReusableStreamDecode filter\n([^~]*)~>\n"
    rb"/CairoData exch def\n\s*" + _HEAD + rb"/DataSource CairoData\s+" + _BITS + rb">>"
)
_OBJECT = re.compile(rb"(\d{10}) 00000 n")
_CORNERS = (0, 3, 6, 9)
"""The control points of a patch that are its corners."""

_BITS_OF_PLACES = 16
"""A place is off by less than one part in 130,000 of the size of the mesh."""


_PAGE_GROUP = re.compile(
    rb"(/Contents \d+ 0 R\n) +/Group <<\s+/Type /Group\s+/S /Transparency\s+/I true\s+/CS /DeviceRGB\s+>>"
)


def without_page_groups(data: bytes) -> bytes:
    """A PDF file of cairo with blanks where a page is said to be a group of transparency: TeX wants no more than one of
    these on a page of its own, and blends the same without."""
    return _PAGE_GROUP.sub(lambda found: found[1] + b" " * (len(found[0]) - len(found[1])), data)


def with_triangles_in_pdf(data: bytes) -> bytes:
    """A PDF file of cairo with triangles instead of patches."""
    table = data.rindex(b"\nxref\n") + 1
    offsets = sorted({int(found.group(1)) for found in _OBJECT.finditer(data, table)})
    parts, moved, size = [data[: offsets[0]]], {}, offsets[0]
    for start, end in zip(offsets, [*offsets[1:], table], strict=True):
        part = _triangles_in_object(data[start:end])
        moved[start] = size
        parts.append(part)
        size += len(part)
    tail = _OBJECT.sub(lambda found: b"%010d 00000 n" % moved[int(found.group(1))], data[table:])
    return b"".join(parts) + re.sub(rb"startxref\n\d+", b"startxref\n%d" % size, tail)


def _triangles_in_object(data: bytes) -> bytes:
    found = _IN_PDF.search(data[:400])
    if not found:
        return data
    space, decode, length = found.groups()
    begin, end = found.end(), found.end() + int(length)
    stream = zlib.compress(_free_triangles(data[begin:end], decode.count(b" ") // 2 - 2), 9)
    head = _dictionary(space, decode, b"/Length %d\n   /Filter /FlateDecode" % len(stream))
    return data[: found.start()] + head + b"\nstream\n" + stream + data[end:]


def with_triangles_in_postscript(data: bytes) -> bytes:
    """A PostScript file of cairo with triangles instead of patches."""

    def triangles(found: re.Match[bytes]) -> bytes:
        text, space, decode = found.groups()
        patches = zlib.decompress(ascii85_decoded(text))
        stream = ascii85_encoded(zlib.compress(_free_triangles(patches, decode.count(b" ") // 2 - 2), 9))
        head = _dictionary(space, decode, b"/DataSource CairoData")
        filters = b"currentfile\n/ASCII85Decode filter /FlateDecode filter /ReusableStreamDecode filter\n"
        # A line that begins with a percent sign could be taken for a comment of the document.
        return filters + re.sub(rb"(?m)^%", b" %", stream) + b"~>\n/CairoData exch def\n   " + head

    return _IN_PS.sub(triangles, data)


def _dictionary(space: bytes, decode: bytes, source: bytes) -> bytes:
    return (
        b"<< /ShadingType 4\n   /ColorSpace /Device%s\n   /BitsPerCoordinate %d\n   /BitsPerComponent 8\n"
        b"   /BitsPerFlag 8\n   /Decode [%s]\n   %s\n>>" % (space, _BITS_OF_PLACES, decode, source)
    )


def _free_triangles(data: bytes, channels: int) -> bytes:
    """The triangles of patches with four corners, the last of which may be the first one, as data of type 4."""
    size = 1 + 16 * 8 + 4 * channels * 2
    patches = np.frombuffer(data, dtype=np.uint8).reshape(-1, size)
    places = np.ascontiguousarray(patches[:, 1:129]).view(">u4").astype(np.uint64).reshape(-1, 16, 2)[:, _CORNERS]
    colours = np.ascontiguousarray(patches[:, 129:]).view(">u2").astype(np.uint32).reshape(-1, 4, channels)
    corner: Ints = np.array(((0, 1, 2), (0, 2, 3)))
    places, colours = places[:, corner].reshape(-1, 3, 2), colours[:, corner].reshape(-1, 3, channels)
    a, b, c = places[:, 0], places[:, 1], places[:, 2]
    real = (a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)
    places, colours = places[real].reshape(-1, 2), colours[real].reshape(-1, channels)
    most = (1 << _BITS_OF_PLACES) - 1
    short = ((places * most + (1 << 31)) // ((1 << 32) - 1)).astype(">u2")
    rows = np.zeros((len(places), 1 + 4 + channels), dtype=np.uint8)
    rows[:, 1:5] = short.view(np.uint8).reshape(-1, 4)
    rows[:, 5:] = (colours + 128) // 257
    return rows.tobytes()


# Texts in PostScript, PDF and PNG: letters of a font that cairo finds, in the file where the format holds fonts.

FAMILY = "sans-serif"
"""What the system says it is."""


def show(context: cairo.Context[Any], texts: PageTexts, scale: float, height: float) -> None:
    """Write the texts; scale: device units per micron; height: of the page's lower border in them, from the top."""
    if is_font_file(texts.font):
        raise InputError(f"font {texts.font}: a file is for .svg; others take installed fonts by their names")
    context.select_font_face(texts.font or FAMILY, cairo.FONT_SLANT_NORMAL, cairo.FONT_WEIGHT_NORMAL)
    for x, y, size, turn, anchor, colour, string in texts.lines(texts.plain):
        context.save()
        context.set_source_rgb(*(int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)))
        context.set_font_size(size * 1000.0 * scale)
        context.translate(x * scale, height - y * scale)
        context.rotate(-math.radians(turn))
        context.move_to(-anchor * context.text_extents(string).x_advance, 0.0)
        context.show_text(string)
        context.restore()
    context.new_path()


# PostScript, EPS, PDF and PNG through cairo.
#
# Cairo stores coordinates as 24.8 fixed point in device units. The device unit of PostScript and PDF is the point, so a
# coordinate is at most 1/512 point = 0.0007 mm off, and what is clipped to the page can never wrap round.
#
# Shaded triangles are meshes of the format, exact at any magnification; readers leave no gaps between the triangles of
# a mesh. PostScript knows no opacity: where a polygon is transparent, cairo puts a picture of 300 dots per inch.

POINTS_PER_MICRON = 72.0 / 25400.0

LARGEST_SIDE_PIXELS = 32767
"""Cairo's limit for the side of a picture."""

LARGEST_PICTURE_PIXELS = 100_000_000
"""400 MB in memory."""

BOX_UNITS, LARGEST_BOX_UNITS = 64.0, float(1 << 22)
"""In a point, when the exact box of the ink is measured; and on a side of the page at most, which cairo can hold."""

_STROKES_AT_ONCE = 1000  # one huge path makes the rasterisers of all readers slow
_TITLE_LENGTH = 200  # cairo refuses comments of more than 255 characters


def ps_bytes(drawing: Drawing) -> bytes:
    """The drawing as a PostScript file of one page; fonts are in it where it has texts.

    Edge cases: the bounding box of an empty drawing is the page.
    """
    return _postscript(page_marks(drawing), eps=False)


def eps_bytes(drawing: Drawing) -> bytes:
    """The drawing as an encapsulated PostScript file, to be placed in documents; the bounding box is that of the ink.

    Edge cases: the bounding box of an empty drawing is the page.
    Source: Adobe, Encapsulated PostScript File Format Specification 3.0.
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

    Edge cases: an empty drawing is an empty page.
    """
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
    return with_triangles_in_pdf(without_page_groups(stream.getvalue()))


def png_bytes(drawing: Drawing, dpi: float = DPI) -> bytes:
    """The drawing as a PNG picture on white, in sRGB and with its resolution in the file.

    Edge cases: an empty drawing is a white page; a page smaller than a pixel has one.
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
    below = _shaded_layers(drawing)
    pixels = np.full((height, width, 3), 255, dtype=np.uint8)
    if below:
        pixels = _painted(pixels, drawing, below, scale)
        page = page_marks(replace(drawing, layers=drawing.layers[below:]))
    surface = cairo.ImageSurface(cairo.FORMAT_RGB24, width, height)
    words = np.frombuffer(surface.get_data(), dtype=np.uint32).reshape(height, surface.get_stride() // 4)[:, :width]
    red, green, blue = pixels.astype(np.uint32).transpose(2, 0, 1)
    words[:] = red << 16 | green << 8 | blue
    surface.mark_dirty()
    _ink(cairo.Context(surface), page, scale, page.height * scale, max(SEAM_MM * 1000.0 * scale, 1.0))
    surface.flush()
    return surface


# Shaded polygons in pixels: cairo's meshes have no smooth borders, and take half a minute where others take seconds.

MOST_SAMPLES, FINEST = 1 << 26, 4
"""So many samples of all pixels are in memory at once, and so many there are along each side of one at most."""


def _shaded_layers(drawing: Drawing) -> int:
    """How many of the first layers consist of opaque polygons, shaded ones or bands of shade among them; 0 where there
    are none."""
    found, count = False, 0
    for layer in drawing.layers:
        if not layer.marks or not all(map(_is_opaque, layer.marks)):
            break
        count += 1
        found |= any(map(_is_finely_shaded, layer.marks))
    return count if found else 0


def _is_finely_shaded(mark: Mark) -> bool:
    """Whether there are shaded polygons, or bands of shade, of which some may be narrower than a pixel."""
    own = isinstance(mark, Fills) and (mark.kind == FillKind.BAND).any()
    return isinstance(mark, Fills) and bool(own or shaded(mark.colours, mark.offsets).any())


def _is_opaque(mark: Mark) -> bool:
    """Whether a mark is opaque polygons, with no lines among them."""
    return isinstance(mark, Fills) and bool((mark.opacity >= 1.0).all() and (np.diff(mark.offsets) > 2).all())


def _painted(pixels: Bytes, drawing: Drawing, count: int, scale: float) -> Bytes:
    """The pixels with the first layers over them, averaged from samples; scale: pixels a micron."""
    height, width = pixels.shape[:2]
    samples = int(np.clip(np.sqrt(MOST_SAMPLES / (height * width)), 1, FINEST))
    wide, high = (side / scale / 1000.0 for side in (width, height))
    # The page ends at the upper border, as for what is drawn over it.
    way = np.array([0.0, high - drawing.height_mm])
    marks = [moved_mark(mark, 1.0, way) for layer in drawing.layers[:count] for mark in layer.marks]
    return smoothly_painted(pixels, Drawing(wide, high, (Layer("", Pen(), tuple(marks)),)), samples)


def _postscript(page: PageMarks, *, eps: bool) -> bytes:
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
        return _with_page_box(text, page)
    text = _with_exact_box(text, _ink_box(page, height))
    return text if eps else _with_exact_paper(text, page)


def postscript_string(text: str) -> str:
    """The text as it stands between the parentheses of a PostScript string: printable ASCII, specials escaped, cut to
    a length that cairo takes."""
    printable = "".join(c if " " <= c <= "~" else "?" for c in text)[: _TITLE_LENGTH // 2]
    return re.sub(r"([\\()])", r"\\\1", printable)


def _with_page_box(text: bytes, page: PageMarks) -> bytes:
    """The file with the page as bounding box. (Around an empty drawing cairo writes a box turned inside out.)"""
    whole = rb"%%\1BoundingBox: 0 0 " + b"%d %d" % _whole_points(page)
    text = re.sub(rb"(?m)^%%(Page)?BoundingBox:.*$", whole, text)
    return _with_exact_paper(_with_exact_box(text, (0.0, 0.0, *_points(page))), page)


def _with_exact_box(text: bytes, box: tuple[float, ...]) -> bytes:
    """The file with the box that its BoundingBox, in whole points, is around."""
    text = re.sub(rb"(?m)^%%HiResBoundingBox:.*\n", b"", text)
    exact = b"%%HiResBoundingBox: " + b" ".join(b"%.6f" % side for side in box)
    return re.sub(rb"(?m)^%%BoundingBox:.*$", lambda found: found[0] + b"\n" + exact, text, count=1)


def _with_exact_paper(text: bytes, page: PageMarks) -> bytes:
    """The file with the size of the page in fractions of points, which cairo rounds up."""
    exact = b"%.6f %.6f" % _points(page)
    text = re.sub(rb"(?m)^(%%DocumentMedia: \S+) \d+ \d+", lambda found: found[1] + b" " + exact, text, count=1)
    return re.sub(rb"(?m)^\d+ \d+( cairo_set_page_size)$", lambda found: exact + found[1], text, count=1)


def _ink_box(page: PageMarks, height: float) -> tuple[float, ...]:
    """Left, lower, right and upper end of all that is drawn on the page, in points; height: see draw_page."""
    wide, high = _points(page)
    # Cairo tells whole units.
    finer = min(BOX_UNITS, LARGEST_BOX_UNITS / max(wide, high))
    surface = cairo.RecordingSurface(cairo.CONTENT_COLOR_ALPHA, None)
    scale = finer * POINTS_PER_MICRON
    _ink(cairo.Context(surface), page, scale, finer * height, SEAM_MM * 1000.0 * scale)
    left, top, across, down = (side / finer for side in surface.ink_extents())
    return max(left, 0.0), max(height - top - down, 0.0), min(left + across, wide), min(height - top, high)


def _points(page: PageMarks) -> tuple[float, float]:
    return page.width * POINTS_PER_MICRON, page.height * POINTS_PER_MICRON


def _whole_points(page: PageMarks) -> tuple[int, int]:
    wide, high = _points(page)
    return math.ceil(wide), math.ceil(high)


def draw_page(surface: cairo.Surface, page: PageMarks, height: float) -> None:
    """Draw a page of PostScript or PDF, and end it; height: of the page, in points."""
    context = cairo.Context(surface)
    _ink(context, page, POINTS_PER_MICRON, height, SEAM_MM * 1000.0 * POINTS_PER_MICRON)
    context.show_page()


def _ink(context: cairo.Context[Any], page: PageMarks, scale: float, height: float, seam: float) -> None:
    """Draw all inks; scale: device units per micron; height: of the page's lower border in them, from the top; seam:
    width of the line around opaque polygons."""
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


# Several drawings as the pages of one PDF file.


def pdf_pages_bytes(drawings: Iterable[Drawing], title: str = "") -> bytes:
    """The drawings as a PDF file with a page for each.

    Edge cases: no drawings are a file without pages.
    """
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
    return with_triangles_in_pdf(without_page_groups(stream.getvalue()))
