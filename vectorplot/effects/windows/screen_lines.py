"""Thin transparent faces: real opacity where a format has it, sparse strokes and pixels where it has not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.scene import Scene
from vectorplot.shading.raster.screen import every_nth
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

FEWEST, MOST = 2, 4
"""Of transparent faces every second, third or fourth line or pixel is set."""

MOST_STROKES = 10_000_000
"""No screen has more strokes."""


@dataclass(frozen=True, eq=False)
class ScreenDoor:
    """Strokes that fill polygons sparsely: start, end (2,k), from left to right along the lines; polygon (k,),
    ascending."""

    start: Floats
    end: Floats
    polygon: Ints

    def __len__(self) -> int:
        return len(self.polygon)


def item_opacities(scene: Scene) -> Floats:
    """(i,) how opaque the items are, 0 to 1. Very thin material does not refract. Source: Glaeser, section 6.6."""
    return np.array([item.material.opacity for item in scene.items], dtype=np.float64)


def sparseness(opacity: ArrayLike) -> Ints:
    """(...) 1 for opaque things, else 2, 3 or 4: every how many-th line or pixel comes nearest to an opacity.

    Degenerate: what is clearer than a fifth still gets every fourth one; what is wholly clear gets 0: none at all.
    Source: Glaeser, section 6.6.
    """
    given = np.asarray(opacity, dtype=np.float64)
    nearest = np.clip(np.rint(1.0 / np.maximum(given, LEAST_DIVISOR)), FEWEST, MOST)
    return np.where(given >= 1.0, 1, np.where(given > 0.0, nearest, 0.0)).astype(np.intp)


def screen_door(points: Floats, offsets: Ints, pitch: float, every: ArrayLike, angle_deg: float = 45.0) -> ScreenDoor:
    """Polygons filled with every n-th of parallel lines, as a plotter can draw transparent faces.

    points (2 or more, c), offsets (m+1,): simple polygons, convex or not; pitch: distance of the lines that would fill
    a polygon densely, the width of the pen, in the units of the points; every (m,) or a number: which of these lines
    are drawn, 0 for none; angle_deg: from the x-axis. All polygons share one set of lines, so that neighbours fit.
    Errors: InputError for a pitch that is not positive, or so fine that there are more than MOST_STROKES strokes.
    Degenerate: polygons between two lines get no stroke.
    Source: Glaeser, section 6.6 (every second, third or fourth pixel), for pens.
    """
    if not 0.0 < pitch < np.inf:
        raise InputError(f"lines {pitch:g} apart fill nothing: expected a positive distance")
    count = len(offsets) - 1
    step = np.broadcast_to(np.asarray(every, dtype=np.intp), (count,))
    turn = np.radians(angle_deg)
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    u, v = matmul(along, points[:2]), matmul(across, points[:2])
    owner = ragged.owner(np.diff(offsets))
    after = next_positions(offsets, np.arange(len(u))) if count else owner
    drawn = step[owner] > 0
    distance = pitch * np.maximum(step[owner], 1)
    # Lines lie at odd multiples of half the distance, seldom through corners; a corner on a line counts as above it.
    here, there = v / distance - 0.5, v[after] / distance - 0.5
    low, high = np.ceil(np.minimum(here, there)), np.ceil(np.maximum(here, there))
    crossed = np.where(drawn, high - low, 0.0)
    if not crossed.sum() < MOST_STROKES:
        raise InputError(f"lines {pitch:g} apart are too fine: more than {MOST_STROKES} strokes")
    crossings = crossed.astype(np.intp)
    side = ragged.owner(crossings)
    line = low[side] + np.arange(len(side)) - np.repeat(ragged.starts(crossings), crossings)
    share = (line - here[side]) / (there - here)[side]
    place = u[side] + share * (u[after] - u)[side]
    order = np.lexsort((place, line, owner[side]))
    side, line, place = side[order], line[order], place[order]
    height = (line + 0.5) * distance[side]
    spots = along[:, None] * place + across[:, None] * height
    # Every line enters and leaves a polygon by turns.
    start, end = spots[:, 0::2], spots[:, 1::2]
    full = np.flatnonzero(place[1::2] > place[0::2])
    return ScreenDoor(start[:, full], end[:, full], owner[side[0::2][full]])


def screen_door_pixels(rows: int, columns: int, every: int) -> Bools:
    """(rows, columns) every n-th pixel: a checkerboard for 2, diagonals for 3, and knight's moves for 4.

    Errors: InputError for every below 1, or sizes that are negative. Source: Glaeser, section 6.6.
    """
    if every < 1 or rows < 0 or columns < 0:
        raise InputError(f"every {every}-th of {rows} x {columns} pixels: expected positive numbers")
    return every_nth(np.arange(rows)[:, None], np.arange(columns), every)
