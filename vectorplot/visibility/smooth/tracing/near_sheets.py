"""Which of many sheets come near each other, judged by points of them all along several directions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.vectors import normalize

SLACK = 0.01
"""Part of its size that a tessellation may lie inside of its sheet."""

_DIAGONALS = [(1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)]
_CORNERS = [(1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)]

DIRECTIONS = normalize([(1, 0, 0), (0, 1, 0), (0, 0, 1), *_DIAGONALS, *_CORNERS])
"""(13,3) directions along which sheets are compared: to the faces, edges and corners of a cube."""


def near_sheets(points: Sequence[Floats]) -> list[tuple[int, int]]:
    """The pairs of sheets, each once and in order, that no plane across one of the directions separates, and no spheres
    around them; points (k,3): of the tessellation of each, NaN in holes.

    Degenerate: a sheet without points is near none.
    Source: Klosowski and others (1998), Efficient collision detection using bounding volume hierarchies of k-dops.
    """
    finite = [own[np.isfinite(own).all(axis=1)] for own in points]
    known = np.flatnonzero([len(own) > 0 for own in finite])
    if not len(known):
        return []
    own = np.concatenate(finite)
    sizes = np.array([len(finite[k]) for k in known.tolist()])
    first, of = ragged.starts(sizes), ragged.owner(sizes)
    along = DIRECTIONS @ own.T
    low, high = (best.reduceat(along, first, axis=1) for best in (np.minimum, np.maximum))
    slack = SLACK * (high - low)[:3].max(axis=0)
    low, high = low - slack, high + slack
    one, two = overlapping_boxes(low[:3], high[:3], low[:3], high[:3])
    one, two = one[one < two], two[one < two]
    near = ((low[3:, one] <= high[3:, two]) & (high[3:, one] >= low[3:, two])).all(axis=0)
    middle = 0.5 * (low[:3] + high[:3]).T
    radius = np.maximum.reduceat(np.linalg.norm(own - middle[of], axis=1), first) + slack
    near &= np.linalg.norm(middle[one] - middle[two], axis=1) <= radius[one] + radius[two]
    return _in_order(known[one[near]], known[two[near]])


def _in_order(one: Ints, two: Ints) -> list[tuple[int, int]]:
    order = np.lexsort((two, one))
    return list(zip(one[order].tolist(), two[order].tolist(), strict=True))
