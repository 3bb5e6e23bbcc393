"""Transparent polygons for pens: sparse parallel lines in their colour."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.fills_without_overlaps import in_space
from vectorplot.effects.windows.screen_lines import screen_door, sparseness


def screened(fills: Fills, pitch_mm: float, page_from_world: Floats) -> Fills:
    """The polygons, those that one can see through as every second, third or fourth of lines so far apart.

    The lines come after all polygons. page_from_world (4,4) as in Drawing.
    Errors and degenerate cases as of screen_door.
    Source: Glaeser, section 6.6 (every second, third or fourth pixel), for pens.
    """
    clear = (fills.opacity < 1.0) & (np.diff(fills.offsets) > 2)
    glass = fills.some(np.flatnonzero(clear))
    door = screen_door(glass.points.T, glass.offsets, pitch_mm, sparseness(glass.opacity))
    count = len(door)
    flat = np.stack([door.start, door.end], axis=2).reshape(2, -1).T
    first = glass.offsets[:-1]
    lines = Fills(
        np.ascontiguousarray(flat),
        np.arange(0, 2 * count + 1, 2),
        np.repeat(glass.colours[first][door.polygon], 2, axis=0),
        np.ones(count),
        glass.item[door.polygon],
        in_space(glass, flat, np.repeat(door.polygon, 2), page_from_world),
        np.full(count, int(FillKind.GLASS)),
    )
    return Fills.joined(fills.some(np.flatnonzero(~clear)), lines)
