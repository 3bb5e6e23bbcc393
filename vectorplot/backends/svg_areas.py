"""Filled polygons as SVG elements."""

from __future__ import annotations

import numpy as np

from vectorplot.backends.areas import Areas
from vectorplot.backends.strips import Strips, strips_of
from vectorplot.backends.svg_numbers import formatted
from vectorplot.drawing.fills import SEAM_MM
from vectorplot.drawing.pieces import offsets_of, ranges
from vectorplot.geometry.mesh import Floats, Ints

ID_PREFIX = b"\7"
"""Stands for the beginning of all ids, a hash of the content, which is not known before the content."""

_RUN = b"\1"
_POINTS_AT_ONCE = 1 << 16


def area_elements(areas: Areas, pen_mm: float, name: str, height: int) -> bytes:
    """The path elements of filled polygons, with the gradients they need.

    pen_mm: width of lines; name: what the ids of these gradients have in common, behind the prefix of all ids;
    height: of the page in microns, about which y is flipped.
    """
    if not len(areas):
        return b""
    pieces, strips, place = _with_strips(areas)
    alone = np.concatenate((place, place + 1))
    starts = np.union1d(pieces.runs[:-1], alone[alone < len(pieces)])
    heads = _heads(pieces, starts, pen_mm)
    of_strips = _gradient_heads(strips, pieces.own_opacity[place], name, height)
    for k, head in zip(np.searchsorted(starts, place).tolist(), of_strips, strict=True):
        heads[k] = head
    bodies = _data(pieces, starts, height).split(_RUN)[1:]
    begins, ends = np.searchsorted(starts, pieces.group_ends.T).tolist()
    numbers = pieces.group[pieces.group_ends[:, 0]].tolist()
    for number, begin, end in zip(numbers, begins, ends, strict=True):
        heads[begin] = _group_head(areas, number, name, height) + heads[begin]
        bodies[end - 1] += b"</g>\n"
    paths = b"".join([part for pair in zip(heads, bodies, strict=True) for part in pair])
    return f'<g stroke-width="{SEAM_MM:g}">\n'.encode() + paths + b"</g>\n"


def _group_head(areas: Areas, number: int, name: str, height: int) -> bytes:
    """The outline of a transparency group, which clips it, and the beginning of its element."""
    corners, offsets = areas.group_outline(number)
    x, y = corners.astype(np.int64).T
    first, last = np.full(len(x), ord(" "), np.uint8), np.zeros(len(x), np.uint8)
    first[offsets[:-1]], last[offsets[1:] - 1] = ord("M"), ord("Z")
    identity = f"{ID_PREFIX.decode()}-{name}-group-{number}"
    opacity = areas.opacity[areas.group_ends[number, 0]]
    return (
        f'<clipPath id="{identity}"><path clip-rule="evenodd" d="'.encode()
        + formatted(first, x, height - y, last)
        + f'"/></clipPath>\n<g opacity="{opacity:.3g}" clip-path="url(#{identity})">\n'.encode()
    )


def _data(areas: Areas, starts: Ints, height: int) -> bytes:
    """The data of all paths and the ends of their elements; each begins with a mark. starts: the first polygons of the
    runs that are painted by one path."""
    at, ends = areas.offsets[:-1], areas.offsets[1:]
    first = np.full(len(areas.microns), ord(" "), np.uint8)
    first[at] = ord("M")
    first[at[starts]] = ord(_RUN)
    last = np.zeros(len(areas.microns), np.uint8)
    last[ends - 1] = np.where(areas.sizes == 2, 0, ord("Z"))
    text = []
    for start in range(0, len(first), _POINTS_AT_ONCE):
        block = slice(start, start + _POINTS_AT_ONCE)
        x, y = areas.microns[block].T
        text.append(formatted(first[block], x, height - y, last[block]))
    end = b'"/>\n'
    return b"".join(text).replace(_RUN, end + _RUN)[len(end) :] + end


def _heads(areas: Areas, starts: Ints, pen_mm: float) -> list[bytes]:
    """The elements of the runs up to their data, those of flat polygons and lines."""
    packed = areas.colours[areas.offsets[starts]].astype(np.intp) @ (65536, 256, 1)
    heads = [b'<path fill="#%06x" stroke="#%06x" d="M' % (c, c) for c in packed.tolist()]
    line, clear, bare = areas.sizes[starts] == 2, areas.own_opacity[starts] < 1.0, areas.bare[starts]
    for k in np.flatnonzero(line | bare).tolist():
        opacity = f"{areas.opacity[starts[k]]:.3g}"
        if line[k]:
            faint = f' stroke-opacity="{opacity}"' if clear[k] else ""
            head = f'<path stroke="#{packed[k]:06x}" stroke-width="{pen_mm:.6g}"{faint} d="M'
        else:
            faint = f' fill-opacity="{opacity}"' if clear[k] else ""
            head = f'<path fill="#{packed[k]:06x}" stroke="none"{faint} d="M'
        heads[k] = head.encode("ascii")
    return heads


def _gradient_heads(strips: Strips, opacity: Floats, name: str, height: int) -> list[bytes]:
    """Gradients, and the elements up to their data of the strips they paint."""
    flipped = np.array((0.0, height)) + strips.ends * (1.0, -1.0)
    numbers = np.round(flipped.reshape(-1, 4) / 1000.0, 3) + 0.0
    packed = (strips.colours.astype(np.intp) @ (65536, 256, 1)).tolist()
    heads = []
    for k, (ends, (low, high), clear) in enumerate(zip(numbers.tolist(), packed, opacity.tolist(), strict=True)):
        x1, y1, x2, y2 = (f"{number:.9g}" for number in ends)
        identity = f"{ID_PREFIX.decode()}-{name}-{k}"
        rest = f'stroke="none" fill-opacity="{clear:.3g}"' if clear < 1.0 else f'stroke="url(#{identity})"'
        heads.append(
            f'<linearGradient id="{identity}" gradientUnits="userSpaceOnUse" x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}">'
            f'<stop stop-color="#{low:06x}"/><stop offset="1" stop-color="#{high:06x}"/></linearGradient>\n'
            f'<path fill="url(#{identity})" {rest} d="M'
        )
    return [head.encode("ascii") for head in heads]


def _with_strips(areas: Areas) -> tuple[Areas, Strips, Ints]:
    """The areas with strips instead of the shaded triangles, the strips, and where each one stands."""
    shaded = np.flatnonzero(areas.shaded)
    corner = areas.offsets[shaded, None] + np.arange(3)
    strips = strips_of(areas.microns[corner].astype(np.float64), areas.colours[corner].astype(np.float64))
    others, owner = np.flatnonzero(~areas.shaded), shaded[strips.triangle]
    source = np.concatenate((others, owner))
    order = np.argsort(source, kind="stable")
    sizes = np.concatenate((areas.sizes[others], np.diff(strips.offsets)))
    corner, moved = ranges(areas.offsets[others], areas.sizes[others]), ranges(offsets_of(sizes)[order], sizes[order])
    one_colour = np.repeat(strips.colours[:, 0], np.diff(strips.offsets), axis=0)
    pieces = Areas(
        np.concatenate((areas.microns[corner], strips.microns))[moved],
        offsets_of(sizes[order]),
        np.concatenate((areas.colours[corner], one_colour))[moved],
        areas.opacity[source[order]],
        areas.bare[source[order]],
        areas.group[source[order]],
    )
    return pieces, strips, np.flatnonzero(order >= len(others))
