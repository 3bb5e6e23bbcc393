"""A tree of planes that orders anything, at the price of many cuts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import joined
from vectorplot.visibility.painter.cuts.splitting import dense, halves, height_span
from vectorplot.visibility.painter.image_faces import ImageFaces, over_corners

TRIED = 5
"""So many faces of each cell are tried as its dividing plane; the one that cuts least and divides most evenly is
taken."""

COST_OF_A_CUT = 4
"""A cut face weighs as much as so many faces more on one side than on the other."""

BELOW, WITHIN, ABOVE, ACROSS = 0, 1, 2, 3


@dataclass(frozen=True, eq=False)
class Partition:
    """Pieces of faces; parent (n,): the face each one comes from; rank (n,): in the order of drawing within its group;
    complete (n,): whether nothing lies across the plane of anything else in its cell."""

    faces: ImageFaces
    parent: Ints
    rank: Ints
    complete: Bools


def partitioned(faces: ImageFaces, group: Ints, tolerance: float, most: int) -> Partition:
    """The faces of each group cut by planes of faces until nothing lies across any of them, or there are most pieces.

    All cells of one level are divided at once. What lies below a plane is drawn first, then what lies in it, by rank,
    then what lies above; what is in a cell that was not divided any more, by the heights of the middles.
    Source: Fuchs, Kedem and Naylor, On visible surface generation by a priori tree structures (1980).
    """
    parent = np.arange(len(faces))
    cell = dense(group)
    open_cell = np.ones(len(faces), dtype=np.bool_)
    while True:
        open_cell &= np.bincount(cell)[cell] > 1
        active = np.flatnonzero(open_cell)
        if not len(active) or len(faces) > most:
            middle = faces.points[2]
            height = over_corners(np.minimum, middle, faces.offsets) + over_corners(np.maximum, middle, faces.offsets)
            return Partition(faces, parent, dense(cell, dense(np.where(open_cell, height, 0.0))), ~open_cell)
        knife = _dividing_faces(faces, cell, active, tolerance)
        side = _sides(faces, active, knife, tolerance)
        across = side == ACROSS
        whole = np.ones(len(faces), dtype=np.bool_)
        whole[active[across]] = False
        kept, cut = np.flatnonzero(whole), active[across]
        sides = np.full(len(faces), WITHIN, dtype=np.intp)
        sides[active] = side
        plane = knife[across]
        below, above = halves(faces.some(cut), faces.planes[:, plane], faces.steepness[plane], tolerance)
        level = np.zeros(len(faces), dtype=np.intp)
        in_plane = active[side == WITHIN]
        level[in_plane] = faces.rank[in_plane]
        open_cell[in_plane] = False
        source = np.concatenate([kept, cut, cut])
        faces = joined((faces.some(kept), below, above))
        half = np.full(len(cut), BELOW), np.full(len(cut), ABOVE)
        cell = dense(cell[source], np.concatenate([sides[kept], *half]), level[source])
        parent, open_cell = parent[source], open_cell[source]


def _dividing_faces(faces: ImageFaces, cell: Ints, active: Ints, tolerance: float) -> Ints:
    """(a,) for each active face the face that divides its cell."""
    order = active[np.lexsort((active, faces.rank[active], cell[active]))]
    starts = np.flatnonzero(np.concatenate([[True], cell[order][1:] != cell[order][:-1]]))
    sizes = np.diff(np.append(starts, len(order)))
    number = np.empty(len(cell), dtype=np.intp)
    number[order] = ragged.owner(sizes)
    mine = number[active]
    best, best_cost = np.zeros(len(starts), dtype=np.intp), np.full(len(starts), np.iinfo(np.intp).max)
    for attempt in range(TRIED):
        candidate = order[starts + (sizes - 1) * attempt // (TRIED - 1)]
        side = _sides(faces, active, candidate[mine], tolerance)
        count = [np.bincount(mine[side == s], minlength=len(starts)) for s in (BELOW, ABOVE, ACROSS)]
        cost = COST_OF_A_CUT * count[2] + np.abs(count[0] - count[1])
        better = cost < best_cost
        best, best_cost = np.where(better, candidate, best), np.where(better, cost, best_cost)
    return best[mine]


def _sides(faces: ImageFaces, which: Ints, knife: Ints, tolerance: float) -> Ints:
    """(k,) where some faces lie, seen from the planes of others."""
    low, high = height_span(faces, which, faces.planes[:, knife])
    limit = tolerance * np.maximum(faces.steepness[which], faces.steepness[knife])
    side = np.where(high > limit, np.where(low < -limit, ACROSS, ABOVE), np.where(low < -limit, BELOW, WITHIN))
    # A face lies in its own plane, whatever rounding says.
    return np.where(which == knife, WITHIN, side)
