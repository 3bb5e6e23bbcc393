"""Hidden lines by painting, on the page: blank faces back to front, and the lines on each of them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, interleaved
from vectorplot.geometry import ragged


def erased_fills(blank: Fills, lines: Fills, width_mm: float) -> Fills:
    """Blank polygons back to front, with visible lines of two corners, so wide, between them.

    A line comes right after the last of the polygons that touch it, so that none takes away half of its width:
    polygons may end beside a line anywhere, along its face or where the painter cut another one.
    Source: Glaeser, section 7.1, figure 1.
    """
    if not len(blank):
        return lines
    return interleaved(blank, [Overlay(lines, _last_touching(blank, lines, width_mm / 2.0))])


def line_fills(strokes: Paths, ink: Colours) -> Fills:
    """Every straight part of strokes as a line of two corners in the ink (m,3) of its stroke."""
    sizes = np.diff(strokes.offsets)
    owner = ragged.owner(sizes)
    start = np.arange(len(strokes.points))
    end = start + 1
    last = strokes.offsets[1:][sizes > 0] - 1
    end[last] = strokes.offsets[:-1][sizes > 0]
    drawn = np.ones(len(start), dtype=np.bool_)
    drawn[last] = strokes.closed[sizes > 0]
    start, end, owner = start[drawn], end[drawn], owner[drawn]
    ends = np.stack([start, end], axis=1).ravel()
    return Fills(
        strokes.points[ends],
        2 * np.arange(len(start) + 1),
        np.repeat(ink[owner], 2, axis=0),
        np.ones(len(start)),
        strokes.item[owner],
        strokes.points3d[ends],
        np.full(len(start), int(FillKind.EDGE)),
    )


def _last_touching(polygons: Fills, lines: Fills, distance: float) -> Ints:
    """(n,) the last of the polygons that come so near to each line; the first of all where none does."""
    import shapely

    sizes = np.diff(polygons.offsets)
    full = np.flatnonzero(sizes >= 3)
    corner = np.repeat(sizes >= 3, sizes)
    rings = shapely.linearrings(polygons.points[corner], indices=ragged.owner(sizes[full]))
    tree = shapely.STRtree(shapely.polygons(rings))
    segments = shapely.linestrings(lines.points.reshape(-1, 2, 2))
    line, polygon = tree.query(segments, predicate="dwithin", distance=distance)
    found = np.zeros(len(lines), dtype=np.intp)
    np.maximum.at(found, line, full[polygon])
    return found
