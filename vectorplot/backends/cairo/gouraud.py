"""Meshes in PDF and PostScript files as triangles, where cairo writes patches of bicubic surfaces.

A patch takes 153 bytes that are not compressed; readers divide it into pieces, some of which they miss where it has
only three corners. The same file with shadings of type 4 (free-form triangles with colours at their corners) is a
twentieth as large, and exact.
Source: ISO 32000-1, section 8.7.4.5 (types 4 and 7) and 7.5 (structure of files); PostScript Language Reference, 4.9.3.
"""

from __future__ import annotations

import re
import zlib

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.backends.cairo.ascii85 import ascii85_decoded, ascii85_encoded

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
