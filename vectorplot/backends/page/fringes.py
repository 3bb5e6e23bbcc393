"""Parts of transparency groups that are of different items: where the one ends and the other begins there is an edge.

It is to be seen exactly where other sheets of these items end. So what is painted later is clipped to its own outline
there, and what is below goes on under it, as does the later one under the earlier one: fringes are painted before both.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.backends.cairo.mesh_borders import places_of
from vectorplot.drawing.fills import Colours
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import next_positions

REACH_MICRONS = 500.0
"""The width of fringes: more than a pixel of a screen of 72 dots per inch, slantwise as well."""

BESIDE_MICRONS = 10.0
"""So far beside the middle of a side it is looked at what is there: more than what rounding leaves between neighbours.
"""


def clipped_parts_of(group: Ints, item: Ints) -> Ints:
    """(m,) ascending numbers of the runs of polygons of one item in groups, -1 for the first run of each group and
    outside of groups (-1)."""
    new = np.ones(len(group), dtype=np.bool_)
    new[1:] = (group[1:] != group[:-1]) | (item[1:] != item[:-1])
    later = new & (group >= 0)
    later[1:] &= group[1:] == group[:-1]
    later[:1] = False
    starts = np.maximum.accumulate(np.where(new, np.arange(len(new)), 0))
    return np.where(later[starts], np.cumsum(later) - 1, -1) if len(group) else group


def _needed(corners: Ints, offsets: Ints, part: Ints, start: Ints, end: Ints, owner: Ints) -> Bools:
    """(s,) beside which sides of polygons, from corners start to end, something shows that is of another part: another
    part of the group, or what is beside the group where it is the part itself that is clipped (part >= 0)."""
    import shapely

    position = np.insert(np.arange(len(corners)), offsets[1:], offsets[:-1])
    rings = shapely.linearrings(corners[position], indices=ragged.owner(np.diff(offsets) + 1))
    tree = shapely.STRtree(shapely.polygons(rings))
    way = (corners[end] - corners[start]).astype(np.float64)
    out = np.stack((way[:, 1], -way[:, 0]), axis=1) * (BESIDE_MICRONS / np.hypot(*way.T))[:, None]
    beside = shapely.points((corners[start] + corners[end]) / 2.0 + out)
    point, polygon = tree.query(beside, predicate="dwithin", distance=BESIDE_MICRONS / 2.0)
    own = part[polygon] == part[owner[point]]
    inside, other = np.zeros((2, len(start)), dtype=np.bool_)
    inside[point[own]], other[point[~own]] = True, True
    return np.asarray(~inside & (other | (part[owner] >= 0)), dtype=np.bool_)


def fringes(microns: Ints, offsets: Ints, colours: Colours, which: Ints, part: Ints) -> tuple[Ints, Ints, Colours]:
    """Quadrilaterals outside of the sides of polygons beside which something else than their part is to be seen:
    corners (k,4,2) in microns, counter-clockwise, the polygon of each, ascending, and their colours (k,3).

    which: the polygons that are looked at; part (m,): those of one number are one.
    """
    position, ends = ragged.take(offsets, which)
    corners, owner = microns[position], which[ragged.owner(np.diff(ends))]
    after = next_positions(ends, np.arange(len(corners)))
    place = places_of(corners)
    own = part[owner] * np.int64(len(corners)) + place, part[owner] * np.int64(len(corners)) + place[after]
    forth, back = (np.stack(pair, axis=1) for pair in (own, own[::-1]))
    _, number = np.unique(np.concatenate((forth, back)), axis=0, return_inverse=True)
    number = number.ravel()
    side = np.flatnonzero(~np.isin(number[: len(corners)], number[len(corners) :]))
    side = side[_needed(corners, ends, part[which], side, after[side], ragged.owner(np.diff(ends))[side])]
    start, end = corners[side], corners[after[side]]
    way = (end - start).astype(np.float64)
    out = np.rint(np.stack((way[:, 1], -way[:, 0]), axis=1) * (REACH_MICRONS / np.hypot(*way.T))[:, None])
    quads = np.stack((start, start + out, end + out, end), axis=1).astype(np.int64)
    shades = colours[position]
    mean = (shades[side].astype(np.intp) + shades[after[side]] + 1) // 2
    return quads, owner[side], mean.astype(np.uint8)
