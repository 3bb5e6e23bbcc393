"""Small flat polygons among shaded triangles, as triangles of the same mesh.

A mesh that ends at every polygon of one colour has as many borders as there are such polygons: where a fine surface is
painted, the lines, skirts and clips along these would be most of the file.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.backends.page.areas import Areas
from vectorplot.geometry import ragged

SMALL_MICRONS = 1500
"""Wider and higher polygons keep their own borders, which are smoothed one by one; smaller ones hardly have any."""


def in_meshes(areas: Areas) -> Areas:
    """The same with the triangles of their fans in place of small convex polygons that stand in a row of solid ones of
    one item, group and part, some of which are shaded.

    Degenerate: polygons that are not convex, or begin with three corners in a line, stay.
    """
    if not areas.shaded.any():
        return areas
    small = np.flatnonzero(areas.solid & (areas.sizes > 3))
    small = small[_fan_out(areas, small)]
    split = np.zeros(len(areas), dtype=np.bool_)
    split[small] = True
    split &= _among_shaded(areas, areas.solid & ((areas.sizes == 3) | split))
    if not split.any():
        return areas
    count = np.where(split, areas.sizes - 2, 1)
    every, sizes = ragged.owner(count), np.repeat(np.where(split, 3, areas.sizes), count)
    corner = ragged.ranges(areas.offsets[every], sizes)
    beyond_first = np.ones(len(corner), dtype=np.bool_)
    beyond_first[ragged.starts(sizes)] = False
    corner += np.repeat(np.where(split[every], ragged.place(count), 0), sizes) * beyond_first
    return Areas(
        areas.microns[corner],
        ragged.offsets(sizes),
        areas.colours[corner],
        areas.opacity[every],
        areas.bare[every],
        areas.group[every],
        areas.part[every],
        areas.fringe[every],
        areas.item[every],
    )


def _fan_out(areas: Areas, which: Ints) -> Bools:
    """(w,) the polygons, of more than three corners, that are small, convex and the sum of their fans."""
    position, offsets = ragged.take(areas.offsets, which)
    points = areas.microns[position]
    if not len(which):
        return np.zeros(0, dtype=np.bool_)
    starts, after = offsets[:-1], ragged.following(offsets)
    size = np.maximum.reduceat(points, starts, axis=0) - np.minimum.reduceat(points, starts, axis=0)
    side = points[after] - points
    turns = _turns(side, side[after])
    arm = points - np.repeat(points[starts], np.diff(offsets), axis=0)
    fan = _turns(arm, arm[after])
    # The sides that begin or end in the first corner make no triangle.
    fan[starts] = fan[offsets[1:] - 1] = 1
    small = (size < SMALL_MICRONS).all(axis=1)
    return np.asarray(small & (np.minimum.reduceat(turns, starts) >= 0) & (np.minimum.reduceat(fan, starts) > 0))


def _turns(one: Ints, two: Ints) -> Ints:
    """(p,) positive where the second direction is to the left of the first."""
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def _among_shaded(areas: Areas, able: Bools) -> Bools:
    """(m,) which polygons are in a row of able ones of one item, group and part that has a shaded one."""
    new = np.ones(len(areas), dtype=np.bool_)
    new[1:] = able[1:] != able[:-1]
    for label in (areas.item, areas.group, areas.part):
        new[1:] |= label[1:] != label[:-1]
    row = np.cumsum(new) - 1
    return np.asarray(able & (np.bincount(row, weights=areas.shaded) > 0.0)[row])
