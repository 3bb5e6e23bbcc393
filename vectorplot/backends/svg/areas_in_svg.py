"""Filled polygons as SVG elements."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.page.areas import Areas
from vectorplot.backends.page.merged_triangles import merged, slopes
from vectorplot.backends.page.underlaps import grown, underlaps
from vectorplot.backends.svg.path_data import path_data
from vectorplot.backends.svg.ramps import NONE, Ramps, item_ramps
from vectorplot.backends.svg.shaded_strips import (
    DARKEST,
    LIGHTEST,
    SHADE_ERROR,
    Strips,
    joined_strips,
    nearly_flat,
    stops_of,
    strips_of,
)
from vectorplot.drawing.fills import SEAM_MM
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import some
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

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
    follow each other and hang together one, as far as SHADE_ERROR allows; others strips."""
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
    )
    place = np.empty(len(order), dtype=np.intp)
    place[order] = np.arange(len(order))
    return pieces, some(strips, np.flatnonzero(~flat)), place[len(others) :][~flat], ramps
