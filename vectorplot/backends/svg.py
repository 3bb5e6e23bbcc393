"""SVG: one layer for each pen, filled and shaded polygons, gradients, texts, and drawings that move."""

from __future__ import annotations

import base64
import hashlib
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page import (
    FONTS,
    Areas,
    Ink,
    PageMarks,
    PageStrokes,
    PageTexts,
    Polygons,
    page_marks,
    plain_text,
    rounded,
)
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import SEAM_MM
from vectorplot.drawing.texts import is_font_file
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse, singular_decomposition
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take
from vectorplot.tolerances import ABOVE_WHOLE, ARC_DECIMAL_MM, LEAST_DIVISOR, NARROW_OF_LENGTH

# Coordinates as text, whole arrays at once.


def formatted(first: NDArray[np.uint8], x: Ints, y: Ints, last: NDArray[np.uint8]) -> bytes:
    """Rows of ``<first>x,y<last>`` as bytes, x and y in mm from thousandths of them; a zero in last is left out."""
    comma = np.full(len(x), ord(","), np.uint8)
    table = np.column_stack((first, millimetres(x), comma, millimetres(y), last))
    text: NDArray[np.uint8] = table[table != 0]
    return text.tobytes()


def millimetres(microns: Ints) -> NDArray[np.uint8]:
    """Decimals in mm as rows of characters, with 0 where a row has no character: no leading or trailing zeros."""
    whole, part = np.divmod(np.abs(microns).astype(np.uint32), np.uint32(1000))
    digits = len(str(int(whole.max(initial=0)))) + 1
    text = np.zeros((len(microns), digits + 4), np.uint8)
    text[:, 0] = np.where(microns < 0, ord("-"), 0)
    rest = whole
    for column in range(digits - 1, 0, -1):
        rest, digit = np.divmod(rest, np.uint32(10))
        shown = (digit + rest > 0) | (column == digits - 1)
        text[:, column] = np.where(shown, digit + ord("0"), 0)
    text[:, digits] = np.where(part > 0, ord("."), 0)
    for column, unit in ((1, 100), (2, 10), (3, 1)):
        # A decimal is shown if it or a later one is not zero.
        shown = part % (unit * 10) > 0
        text[:, digits + column] = np.where(shown, part // unit % 10 + ord("0"), 0)
    return text


def path_data(points: Ints, first: Ints, opening: NDArray[np.uint8], closing: NDArray[np.uint8]) -> bytes:
    """Polygons as the data of paths: their first points (m,) among all points (n,2), in thousandths of a mm, written
    whole after opening (m,), all others as ways from those before them; closing (m,) follows the last one, if it is not
    zero."""
    ways = np.diff(points, axis=0, prepend=points[:1])
    ways[first] = points[first]
    lead, last = np.zeros(len(points), np.uint8), np.zeros(len(points), np.uint8)
    second = np.delete(first + 1, np.flatnonzero(np.append(first[1:], len(points)) == first + 1))
    lead[ways[:, 0] >= 0] = ord(" ")
    lead[second] = ord("l")
    lead[first] = opening
    last[np.append(first[1:], len(points)) - 1] = closing
    comma = np.where(ways[:, 1] < 0, 0, ord(",")).astype(np.uint8)
    table = np.column_stack((lead, _short(ways[:, 0]), comma, _short(ways[:, 1]), last))
    text: NDArray[np.uint8] = table[table != 0]
    return text.tobytes()


def _short(microns: Ints) -> NDArray[np.uint8]:
    """The same as millimetres, without a zero before the point."""
    text = millimetres(microns)
    column = text.shape[1] - 5
    small = (np.abs(microns) < 1000) & (microns != 0)
    text[small, column] = 0
    return text


# Ramps of colours: what the shades of one palette lie on, so that gradients can be parts of one.

ERROR = 1.5
"""By how many steps of 255 colours may be off their ramp: three times what rounding makes of them."""

NONE = -1
"""No ramp."""


@dataclass(frozen=True, eq=False)
class Ramps:
    """Colours that lie between two each: ends (r,2,3) of the ramps; of_item: the number of the ramp of each item."""

    ends: Floats
    of_item: dict[int, int]

    def numbers(self, item: Ints) -> Ints:
        """(n,) the ramps of items (n,), NONE for those without one."""
        return np.array([self.of_item.get(number, NONE) for number in item.tolist()], dtype=np.intp)

    def parts(self, ramp: Ints, colours: Floats) -> Floats:
        """(n,k) where on their ramps (n,) colours (n,k,3) lie, from 0 to 1."""
        first, way = self.ends[ramp, 0], self.ends[ramp, 1] - self.ends[ramp, 0]
        return np.asarray(((colours - first[:, None]) * way[:, None]).sum(axis=2) / (way * way).sum(axis=1)[:, None])

    def on(self, ramp: Ints, colours: Floats) -> Floats:
        """Colours (n,k,3) moved onto their ramps (n,)."""
        first, way = self.ends[ramp, 0], self.ends[ramp, 1] - self.ends[ramp, 0]
        return np.asarray(first[:, None] + self.parts(ramp, colours)[..., None] * way[:, None])


def item_ramps(colours: Floats, item: Ints) -> Ramps:
    """The ramps of those items all of whose colours lie on one: colours (t,k,3) of parts of items (t,)."""
    ends, of_item = [np.zeros((0, 2, 3))], {}
    for number in np.unique(item).tolist():
        own = colours[item == number].reshape(-1, 3)
        first = own[np.argmax(((own - own[0]) ** 2).sum(axis=1))]
        last = own[np.argmax(((own - first) ** 2).sum(axis=1))]
        way = last - first
        if not way.any():
            continue
        part = matmul(own - first, way) / (matmul(way, way))
        if np.abs(own - first - part[:, None] * way).max() <= ERROR:
            of_item[number] = len(ends) - 1
            ends.append(np.stack((first, last))[None])
    return Ramps(np.concatenate(ends), of_item)


# Shaded triangles for formats that shade along one direction only.
#
# A triangle the colours of which change along one direction, as shades of one palette do, is exact. One that mixes
# three colours is cut into strips along the direction of its greatest change, so narrow that what changes across them
# cannot be seen.

SHADE_ERROR = 2.0
"""By how many steps of 255 a shaded piece that is painted in one colour may differ from what it should be."""

SMALLEST_MICRONS, NARROWEST_MICRONS = 250.0, 60.0
"""Triangles that are no longer, or no wider, than this are painted in one colour: less than a pixel of a screen."""


DARKEST, LIGHTEST = 0.0, 255.0
"""What there is of each of the three colours."""


@dataclass(frozen=True, eq=False)
class Strips:
    """Polygons with linear gradients: microns (p,2) int64, offsets (s+1,); triangle (s,) that each is a part of,
    ascending; ends (s,2,2) in microns from where to where the gradient runs; colours (s,2,3) there.

    Ends may lie beside the triangle, where colours go on beyond 0 and 255; what is shown there are these.
    """

    microns: Ints = field(metadata=EACH_POINT)
    offsets: Ints
    triangle: Ints = field(metadata=EACH_LINE)
    ends: Floats = field(metadata=EACH_LINE)
    colours: Floats = field(metadata=EACH_LINE)


def joined_strips(one: Strips, other: Strips) -> Strips:
    """The strips of both by their triangles."""
    both = joined((one, other))
    return take(both, np.argsort(both.triangle, kind="stable"))


def stops_of(colours: Floats) -> tuple[Floats, Ints, Ints]:
    """Where linear gradients (s,2,3) bend that show what colours there are: parts (k,) of the way, 0 and 1 among them,
    the colours (k,3) there, and the gradient (k,) of each, ascending."""
    start, way = colours[:, 0], colours[:, 1] - colours[:, 0]
    limit = np.array([DARKEST, LIGHTEST])[:, None]
    # What rounding leads back needs no stop.
    shown = np.rint(colours)
    beyond = np.stack([shown.min(axis=1) < DARKEST, shown.max(axis=1) > LIGHTEST], axis=1) & (way != 0.0)[:, None]
    part = (limit - start[:, None]) / np.where(beyond, way[:, None], 1.0)
    inner, *_ = within = np.nonzero(beyond & (part > 0.0) & (part < 1.0))
    ends = np.arange(len(colours))
    gradient = np.concatenate([ends, inner, ends])
    part = np.concatenate([np.zeros(len(ends)), part[within], np.ones(len(ends))])
    order = np.lexsort((part, gradient))
    gradient, part = gradient[order], part[order]
    found = np.clip(start[gradient] + part[:, None] * way[gradient], DARKEST, LIGHTEST)
    return part, np.rint(found).astype(np.intp), gradient


def nearly_flat(areas: Areas) -> Areas:
    """The same, but triangles that are very small or narrow, or the colours of which span no more than twice
    SHADE_ERROR, have the middle one."""
    which = np.flatnonzero(areas.shaded)
    corner = areas.offsets[which, None] + np.arange(3)
    of_corners = areas.colours[corner].astype(np.intp)
    low, high = of_corners.min(axis=1), of_corners.max(axis=1)
    sides = (areas.microns[corner] - areas.microns[np.roll(corner, 1, axis=1)]).astype(np.float64)
    near = ((high - low) <= 2.0 * SHADE_ERROR).all(axis=1)
    longest = np.hypot(sides[..., 0], sides[..., 1]).max(axis=1)
    width = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / longest
    near |= (longest <= SMALLEST_MICRONS) | (width <= NARROWEST_MICRONS)
    colours = areas.colours.copy()
    colours[corner[near]] = ((low + high) // 2)[near, None].astype(np.uint8)
    return replace(areas, colours=colours)


def strips_of(corners: Floats, colours: Floats) -> Strips:
    """Triangles with corners (t,3,2) in microns, shaded linearly from colours (t,3,3) there, as strips. No colour is
    off by more than SHADE_ERROR, and what rounding adds.

    The linear map from places to colours is, by its singular values, a change along one direction and a smaller one
    across it. A strip has the colours of its middle line.
    """
    slopes = _slopes(corners, colours)
    directions, sizes, _ = singular_decomposition(slopes)
    # On the page, where y runs downwards, the second direction is a quarter turn from the first, as clipping wants it.
    directions[:, :, 1] = np.stack([directions[:, 1, 0], -directions[:, 0, 0]], axis=1)
    local = matmul(corners - corners[:, :1], directions)
    low, high = local.min(axis=1), local.max(axis=1)
    number = np.ceil((high[:, 1] - low[:, 1]) * sizes[:, 1] / (2.0 * SHADE_ERROR))
    number = np.maximum(number, 1.0).astype(np.intp)
    owner = ragged.owner(number)
    step = ragged.place(number)
    width = ((high - low)[:, 1] / number)[owner]
    middle = low[owner, 1] + (step + 0.5) * width
    # Strips at the ends are wider, so that rounding cannot cut anything off.
    before, behind = np.where(step == 0, 1.0, 0.5) * width, np.where(step == number[owner] - 1, 1.0, 0.5) * width
    reach = (high - low).max(axis=1)[owner]
    slabs = _rectangles(low[owner, 0] - reach, high[owner, 0] + reach, middle - before, middle + behind)
    quads = corners[owner, :1] + matmul(slabs, directions[owner].transpose(0, 2, 1))
    microns, offsets, strip = _cut(corners[owner], quads)
    owner, middle = owner[strip], middle[strip]
    size = np.diff(offsets)
    from_first = microns - np.repeat(corners[owner, 0], size, axis=0)
    along = np.einsum("pi,pi->p", from_first, np.repeat(directions[owner, :, 0], size, axis=0))
    ways = np.stack([np.stack((end, middle), axis=-1) for end in _extremes(along, offsets)], axis=1)
    ways = matmul(ways, directions[owner].transpose(0, 2, 1))
    return Strips(microns, offsets, owner, corners[owner, :1] + ways, colours[owner, :1] + matmul(ways, slopes[owner]))


def _slopes(corners: Floats, colours: Floats) -> Floats:
    """(t,2,3): a way on the page times it is the change of colour. Across triangles too thin for that there is none."""
    sides, changes = corners[:, 1:] - corners[:, :1], colours[:, 1:] - colours[:, :1]
    return np.asarray(matmul(pseudo_inverse(sides, rcond=NARROW_OF_LENGTH), changes))


def _cut(triangles: Floats, quads: Floats) -> tuple[Ints, Ints, Ints]:
    """Triangles (s,3,2) clipped by quadrilaterals (s,4,2): corners, offsets, and which ones are left."""
    points, offsets, which = clipped_by_convex(
        triangles.reshape(-1, 2).T,
        np.arange(0, 3 * len(triangles) + 1, 3),
        quads.reshape(-1, 2).T,
        np.arange(0, 4 * len(quads) + 1, 4),
    )
    blank = np.zeros((points.shape[1], 3), dtype=np.uint8)
    microns, offsets, _, kept = rounded(Polygons(points.T / 1000.0, offsets, blank, which))
    return microns, offsets, which[kept]


def _rectangles(left: Floats, right: Floats, low: Floats, high: Floats) -> Floats:
    """(s,4,2) the corners of rectangles."""
    return np.stack(
        [np.stack(corner, axis=-1) for corner in ((left, low), (right, low), (right, high), (left, high))], 1
    )


def _extremes(values: Floats, offsets: Ints) -> tuple[Floats, Floats]:
    """Smallest and largest of the values of each polygon."""
    if len(offsets) == 1:
        return np.zeros(0), np.zeros(0)
    return np.minimum.reduceat(values, offsets[:-1]), np.maximum.reduceat(values, offsets[:-1])


# Filled polygons as SVG elements.

ID_PREFIX = b"\7"
"""Stands for the beginning of all ids, a hash of the content, which is not known before the content."""

LINE_SPAN = 8.0
"""Lines around gradients that span no more than so many steps of 255 have the colour in the middle."""

FLAT = 1.0 / 512.0
"""Gradients that are a smaller part of a ramp have their own colours."""

_RUN = b"\1"
_POLYGONS_AT_ONCE = 1 << 14


def area_elements(areas: Areas, pen_mm: float, name: str, height: int) -> bytes:
    """The path elements of filled polygons, with the gradients they need.

    pen_mm: width of lines; name: what the ids of these gradients have in common, behind the prefix of all ids;
    height: of the page in microns, about which y is flipped.
    """
    if not len(areas):
        return b""
    from vectorplot.backends.shaded_triangles import grown, underlaps

    pieces, strips, place, ramps = _with_strips(areas)
    alone = np.concatenate((place, place + 1))
    starts = np.union1d(pieces.runs[:-1], alone[alone < len(pieces)])
    laps = underlaps(pieces)
    stroked = np.logical_or.reduceat(laps.open, starts)
    heads = _heads(pieces, starts, stroked, pen_mm)
    seams = stroked[np.searchsorted(starts, place)]
    of_strips = _gradient_heads(strips, ramps, pieces, place, seams, name, height)
    for k, head in zip(np.searchsorted(starts, place).tolist(), of_strips, strict=True):
        heads[k] = head
    microns, offsets, parts = grown(pieces, laps)
    bodies = _data(microns, offsets, parts[starts], height).split(_RUN)[1:]
    # Parts lie within groups: they begin after them, and end before.
    for letter, rows in (("p", pieces.part_ends), ("g", pieces.group_ends)):
        begins, ends = np.searchsorted(starts, rows.T).tolist()
        for number, (begin, end) in enumerate(zip(begins, ends, strict=True)):
            first, last = rows[number].tolist()
            faint = f'opacity="{pieces.opacity[first]:.3g}" ' if letter == "g" else ""
            heads[begin] = _clip_head(pieces, first, last, f"{name}{letter}{number}", faint, height) + heads[begin]
            bodies[end - 1] += b"</g>\n"
    paths = b"".join([part for pair in zip(heads, bodies, strict=True) for part in pair])
    return f'<g stroke="none" stroke-width="{SEAM_MM:g}">\n'.encode() + paths + b"</g>\n"


def _clip_head(areas: Areas, first: int, last: int, name: str, opacity: str, height: int) -> bytes:
    """The outline of polygons from first to before last, which clips them, and the beginning of the element of their
    group."""
    corners, offsets = areas.outline(first, last)
    flipped = corners.astype(np.int64) * (1, -1) + (0, height)
    letters = (np.full(len(offsets) - 1, ord(letter), np.uint8) for letter in "MZ")
    identity = f"{ID_PREFIX.decode()}{name}"
    return (
        f'<clipPath id="{identity}"><path clip-rule="evenodd" d="'.encode()
        + path_data(flipped, offsets[:-1], *letters)
        + f'"/></clipPath>\n<g {opacity}clip-path="url(#{identity})">\n'.encode()
    )


def _data(microns: Ints, offsets: Ints, starts: Ints, height: int) -> bytes:
    """The data of all paths and the ends of their elements; each begins with a mark. starts: the first polygons of the
    runs that are painted by one path."""
    opening = np.full(len(offsets) - 1, ord("M"), np.uint8)
    opening[starts] = ord(_RUN)
    closing = np.where(np.diff(offsets) == 2, 0, ord("Z")).astype(np.uint8)
    flipped = microns * (1, -1) + (0, height)
    text = []
    for begin in range(0, len(opening), _POLYGONS_AT_ONCE):
        block = slice(begin, begin + _POLYGONS_AT_ONCE)
        own = offsets[begin : begin + _POLYGONS_AT_ONCE + 1]
        text.append(path_data(flipped[own[0] : own[-1]], own[:-1] - own[0], opening[block], closing[block]))
    end = b'"/>\n'
    return b"".join(text).replace(_RUN, end + _RUN)[len(end) :] + end


def _heads(areas: Areas, starts: Ints, stroked: Bools, pen_mm: float) -> list[bytes]:
    """The elements of the runs up to their data, those of flat polygons and lines; stroked: runs of polygons with a
    line around them."""
    packed = (areas.colours[areas.offsets[starts]].astype(np.intp) @ (65536, 256, 1)).tolist()
    line, opacity = (areas.sizes[starts] == 2).tolist(), areas.own_opacity[starts].tolist()
    heads = []
    for colour, is_line, seam, clear in zip(packed, line, stroked.tolist(), opacity, strict=True):
        what = "stroke" if is_line else "fill"
        faint = f' {what}-opacity="{clear:.3g}"' if clear < 1.0 else ""
        around = f' stroke-width="{pen_mm:.6g}"' if is_line else f' stroke="#{colour:06x}"' if seam else ""
        heads.append(f'<path {what}="#{colour:06x}"{around}{faint} d="M'.encode())
    return heads


def _gradient_heads(
    strips: Strips, ramps: Ramps, pieces: Areas, place: Ints, stroked: Bools, name: str, height: int
) -> list[bytes]:
    """Gradients, and the elements up to their data of the strips they paint, which stand at some places among all
    pieces. Those of one ramp share its colours: each runs from where the ramp would begin to where it would end."""
    ends = np.array((0.0, height)) + strips.ends * (1.0, -1.0)
    ramp = ramps.numbers(pieces.item[place])
    of_ramp = np.flatnonzero(ramp >= 0)
    low, high = ramps.parts(ramp[of_ramp], strips.colours[of_ramp]).T
    flat = np.abs(high - low) < FLAT
    ramp[of_ramp[flat]] = NONE
    of_ramp, low, high = of_ramp[~flat], low[~flat], high[~flat]
    slope = (ends[of_ramp, 1] - ends[of_ramp, 0]) / (high - low)[:, None]
    start = ends[of_ramp, 0] - low[:, None] * slope
    ends[of_ramp] = np.stack((start, start + slope), axis=1)
    numbers = (np.round(ends.reshape(-1, 4) / 1000.0, 2) + 0.0).tolist()
    own_stops = iter(_stops(strips.colours[ramp == NONE]))
    common = f"{ID_PREFIX.decode()}{name}"
    opacity = pieces.own_opacity[place].tolist()
    heads = [_shared_gradients(ramps, common)] if len(place) else []
    shown = np.clip(strips.colours, DARKEST, LIGHTEST)
    middles = (np.rint(shown.mean(axis=1)).astype(np.intp) @ (65536, 256, 1)).tolist()
    wide = (np.abs(shown[:, 1] - shown[:, 0]).max(axis=1) > LINE_SPAN).tolist()
    rows = zip(numbers, ramp.tolist(), opacity, stroked.tolist(), middles, wide, strict=True)
    for k, (run, number, clear, seam, middle, much) in enumerate(rows):
        x1, y1, x2, y2 = (f"{number:.7g}" for number in run)
        own, where = f"{common}{k}", f'x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"'
        if number == NONE:
            gradient = _gradient(own, f" {where}", next(own_stops))
        else:
            gradient = f'<linearGradient id="{own}" xlink:href="#{common}c{number}" {where}/>\n'
        faint = f' fill-opacity="{clear:.3g}"' if clear < 1.0 else ""
        line = f"url(#{own})" if much else f"#{middle:06x}"
        around = f' stroke="{line}"' if seam else ""
        heads.append(f'{gradient}<path fill="url(#{own})"{faint}{around} d="M')
    return [head.encode("ascii") for head in [*["".join(heads[:2])], *heads[2:]] if head]


def _shared_gradients(ramps: Ramps, common: str) -> str:
    return "".join(_gradient(f"{common}c{number}", "", stops) for number, stops in enumerate(_stops(ramps.ends)))


def _gradient(identity: str, where: str, stops: str) -> str:
    return f'<linearGradient id="{identity}" gradientUnits="userSpaceOnUse"{where}>{stops}</linearGradient>\n'


def _stops(colours: Floats) -> list[str]:
    """The stops of gradients (s,2,3)."""
    part, colour, gradient = stops_of(colours)
    where = [f'offset="{share:.4g}" ' if share else "" for share in part.tolist()]
    packed = (colour @ (65536, 256, 1)).tolist()
    texts = [f'<stop {place}stop-color="#{rgb:06x}"/>' for place, rgb in zip(where, packed, strict=True)]
    first = np.searchsorted(gradient, np.arange(len(colours) + 1)).tolist()
    return ["".join(texts[begin:end]) for begin, end in pairwise(first)]


def _gradients(areas: Areas, shaded: Ints, ramps: Ramps, ramp: Ints, colours: Floats) -> Strips:
    """The polygons with gradients that shaded triangles (t,), in colours (t,3,3), become: those of one ramp (t,) that
    follow each other and are connected one, as far as SHADE_ERROR allows; others strips."""
    corners = areas.microns[areas.offsets[shaded, None] + np.arange(3)]
    on = np.flatnonzero(ramp >= 0)
    off = np.flatnonzero(ramp < 0)
    values = ramps.parts(ramp[on], colours[on])
    tiny = (nearly_flat(areas).shaded != areas.shaded)[shaded]
    middle = (colours.min(axis=1) + colours.max(axis=1)) / 2.0
    colours = np.where(tiny[:, None, None], middle[:, None], colours)
    others = strips_of(corners[off].astype(np.float64), colours[off])
    others = replace(others, triangle=off[others.triangle])
    if not len(on):
        return others
    from vectorplot.backends.shaded_triangles import merged, slopes

    span = np.abs(ramps.ends[ramp[on], 1] - ramps.ends[ramp[on], 0]).max(axis=1)
    rows = np.column_stack([areas.item, areas.group, areas.own_opacity])[shaded[on]]
    follows = np.append(False, (np.diff(shaded[on]) == 1) & (rows[1:] == rows[:-1]).all(axis=1))
    found = merged(corners[on], values, follows & (rows[:, 2] == 1.0), SHADE_ERROR / span)
    middle, value, slope = slopes(found)
    direction = slope / np.maximum(np.hypot(*slope.T), LEAST_DIVISOR)[:, None]
    of = ragged.owner(np.diff(found.offsets))
    along = ((found.microns - middle[of]) * direction[of]).sum(axis=1)
    reach = np.stack([f.reduceat(along, found.offsets[:-1]) for f in (np.minimum, np.maximum)], axis=1)
    ends = middle[:, None] + reach[..., None] * direction[:, None]
    part = value[:, None] + reach * np.hypot(*slope.T)[:, None]
    first, last = ramps.ends[ramp[on[found.first]]].transpose(1, 0, 2)
    # A triangle that is too small for a gradient, alone.
    alone = tiny[on[found.first]] & (found.first == found.last)
    part = np.where(alone[:, None], value[:, None], part)
    shades = first[:, None] + part[..., None] * (last - first)[:, None]
    return joined_strips(others, Strips(found.microns, found.offsets, on[found.first], ends, shades))


def _with_strips(areas: Areas) -> tuple[Areas, Strips, Ints, Ramps]:
    """The areas with strips instead of the shaded triangles, the strips, where each one stands, and the ramps of
    colours."""
    shaded = np.flatnonzero(areas.shaded)
    corner = areas.offsets[shaded, None] + np.arange(3)
    colours = areas.colours[corner].astype(np.float64)
    ramps = item_ramps(colours, areas.item[shaded])
    ramp = ramps.numbers(areas.item[shaded])
    on = np.flatnonzero(ramp >= 0)
    colours[on] = ramps.on(ramp[on], colours[on])
    strips = _gradients(areas, shaded, ramps, ramp, colours)
    shown = np.clip(strips.colours, DARKEST, LIGHTEST)
    low, high = shown.min(axis=1), shown.max(axis=1)
    # What has nearly one colour has the middle one.
    flat = ((high - low) <= 2.0 * SHADE_ERROR).all(axis=1)
    others, owner = np.flatnonzero(~areas.shaded), shaded[strips.triangle]
    source = np.concatenate((others, owner))
    order = np.argsort(source, kind="stable")
    sizes = np.concatenate((areas.sizes[others], np.diff(strips.offsets)))
    corner, moved = (
        ragged.ranges(areas.offsets[others], areas.sizes[others]),
        ragged.ranges(ragged.offsets(sizes)[order], sizes[order]),
    )
    one_colour = np.repeat(np.rint((low + high) / 2.0).astype(np.uint8), np.diff(strips.offsets), axis=0)
    pieces = Areas(
        np.concatenate((areas.microns[corner], strips.microns))[moved],
        ragged.offsets(sizes[order]),
        np.concatenate((areas.colours[corner], one_colour))[moved],
        areas.opacity[source[order]],
        areas.bare[source[order]],
        areas.group[source[order]],
        areas.part[source[order]],
        areas.fringe[source[order]],
        areas.item[source[order]],
        areas.look[source[order]],
    )
    place = np.empty(len(order), dtype=np.intp)
    place[order] = np.arange(len(order))
    return pieces, take(strips, np.flatnonzero(~flat)), place[len(others) :][~flat], ramps


# Texts in SVG: text elements that readers set, search and copy.

_ANCHORS = {0.0: "start", 0.5: "middle", 1.0: "end"}


def text_elements(texts: PageTexts, height: int) -> bytes:
    """The text elements; y is flipped about the page height in microns, and so are the directions."""
    lines = []
    own = Path(texts.font).stem if is_font_file(texts.font) else texts.font
    fonts = f"'{own}', {FONTS}" if own else FONTS
    for x, y, size, turn, anchor, colour, string in texts.lines(texts.plain):
        across, down = f"{x / 1000.0:.10g}", f"{(height - y) / 1000.0:.10g}"
        turned = f' transform="rotate({-turn:g} {across},{down})"' if turn else ""
        lines.append(
            f'<text x="{across}" y="{down}" font-size="{size:g}" font-family="{fonts}" stroke="none" fill="{colour}"'
            f' text-anchor="{_ANCHORS[anchor]}"{turned}>{escape(string)}</text>\n'
        )
    return "".join(lines).encode("utf-8")


# SVG for pen plotters and web pages: one Inkscape layer per pen, millimetres.
#
# svgwrite makes the document and its layers; the strokes and areas of a layer are formatted in bulk and put in their
# places afterwards, because an object for each of them would cost a hundred times as much.

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

    Edge cases: an empty drawing is an empty page.
    """
    return svg_bytes(drawing).decode("utf-8")


def svg_bytes(drawing: Drawing) -> bytes:
    """The drawing as the bytes of an SVG file in UTF-8."""
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
    end = arcs.take(owner).points(arcs.start[owner] + (arcs.end - arcs.start)[owner] * (number / count[owner]))
    # The last end is that of the stroke, so that strokes that touch do so in the file too.
    end[last] = lines.microns[lines.offsets[arcs.stroke + 1] - 1] / 1000.0
    end[:, 1] = height / 1000.0 - end[:, 1]
    rows = np.column_stack((size.T[owner], tilt[owner], clockwise[owner], end)).tolist()
    parts = [f"A{_brief(a)} {_brief(b)} {_brief(c)} 0 {d:.0f} {_brief(x)},{_brief(y)}" for a, b, c, d, x, y in rows]
    ends = zip((last + 1).tolist(), count.tolist(), lines.closed[arcs.stroke].tolist(), strict=True)
    return [(" ".join(parts[k - n : k]) + ('Z"/>\n' if ring else '"/>\n')).encode("ascii") for k, n, ring in ends]


def _brief(number: float) -> str:
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
    files = {part.font for ink in page.inks for part in ink.parts if isinstance(part, PageTexts)}
    for file in sorted(filter(is_font_file, files)):
        try:
            held = base64.b64encode(Path(file).read_bytes()).decode()
            face = f"font-family:'{Path(file).stem}';src:url(data:font/{Path(file).suffix[1:].lower()};base64,{held})"
            document.embed_stylesheet(f"@font-face{{{face}}}")
        except OSError as error:
            raise InputError(error.strerror or "cannot be read", file=file) from None
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


# Several drawings as one SVG that moves by itself: SMIL, no script.

_SVG = re.compile(rb"^(.*?<svg\b[^>]*>)(?:<defs ?/>)?(.*)</svg>\s*$", re.DOTALL)
_TIME_DECIMALS = 6


def animated_svg_bytes(drawings: Iterable[Drawing], fps: float, title: str = "") -> bytes:
    """The drawings as the bytes of an SVG file that shows one after the other, again and again.

    Edge cases: no drawings are an empty picture.
    """
    head = b'<?xml version="1.0" encoding="utf-8"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="0" height="0">'
    shown: dict[bytes, list[int]] = {}
    count = 0
    for drawing in drawings:
        found = _SVG.match(svg_bytes(replace(drawing, title="")))
        if found is None:  # pragma: no cover
            raise AssertionError("an SVG without a root")
        head = found[1] if not count else head
        shown.setdefault(found[2], []).append(count)
        count += 1
    name = plain_text(title)
    parts = [head, f"<title>{escape(name)}</title>".encode() if name else b"", b"\n"]
    for body, frames in shown.items():
        hidden = b"" if frames[0] == 0 else b' visibility="hidden"'
        parts += [b"<g", hidden, b">", _visible(frames, count, fps), b"\n", body.strip(), b"\n</g>\n"]
    return b"".join([*parts, b"</svg>\n"])


def _visible(frames: list[int], count: int, fps: float) -> bytes:
    """The animation of a group that is visible in some frames of so many."""
    if len(frames) == count:
        return b""
    among = set(frames)
    times, values = [], []
    for frame in sorted({0, *frames, *(frame + 1 for frame in frames if frame + 1 < count)}):
        times.append(f"{frame / count:.{_TIME_DECIMALS}g}")
        values.append("visible" if frame in among else "hidden")
    said = f'values="{";".join(values)}" keyTimes="{";".join(times)}" dur="{count / fps:.{_TIME_DECIMALS}g}s"'
    return f'<animate attributeName="visibility" calcMode="discrete" {said} repeatCount="indefinite"/>'.encode()
