"""Neighbouring transparent polygons of one item, taken together: opaque to each other, transparent as a whole.

Blended one by one, polygons with a common side let the paper through along it, or cover it twice. A transparency group
is painted as if it were opaque, the lines along common sides included, and then blended once, inside its outline.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.components import any_component

SIDE_BY_SIDE_MICRONS = 30.0
"""Polygons that overlap by no more than a strip of about this width lie side by side: their corners are rounded to
microns, and a tenth of a pixel of a screen that is blended once, not twice, is not seen."""

MOST_NEIGHBOURS = 64
"""With more boxes than this across that of a polygon, in the mean, they lie over each other in heaps, and stay alone:
to compare all pairs would take longer than to draw them."""

FEW_CORNERS = 6
"""Polygons of no more corners are looked at side by side before their common part is made."""

_SHAPES_AT_ONCE = 256


def groups_of(microns: Ints, offsets: Ints, run: Ints, part: Ints) -> Ints:
    """(m,) the transparency groups of polygons, ascending from 0, and -1 for polygons that are in none.

    microns (p,2) corners, counter-clockwise; run (m,): neighbours of one number of at least 0 may share a group, as
    they are equally transparent; part (m,): neighbours of one number are of one item. Polygons of one group follow each
    other, and do not overlap, as what is seen through two of them is to be seen through both; at least two of a group
    touch. A group ends before an item of which a polygon overlaps it, or, where it begins amid one, before that
    polygon.
    Degenerate: polygons that cross themselves are in none, nor are those of a heap.
    """
    group = np.full(len(run), -1, dtype=np.intp)
    near = run[1:] == run[:-1]
    beside = np.zeros(len(run), dtype=np.bool_)
    beside[1:] |= near
    beside[:-1] |= near
    which = np.flatnonzero(beside & (run >= 0))
    if not len(which):
        return group
    import shapely

    sizes = np.diff(offsets)[which]
    corner = ragged.ranges(offsets[which], sizes)
    rings = shapely.linearrings(microns[corner], indices=ragged.owner(sizes))
    raw = shapely.polygons(rings)
    shapes = shapely.make_valid(raw)
    twisted = np.abs(shapely.area(shapes) - shapely.area(raw))
    simple = twisted <= np.maximum(SIDE_BY_SIDE_MICRONS * shapely.length(raw) / 2.0, 0.5)
    one, other = _neighbours(shapes, np.where(simple, run[which], -1))
    if not len(one):
        return group
    own = microns[corner], ragged.offsets(sizes)
    near = np.flatnonzero(~beside_a_side(*own, one, other) & ~beside_a_side(*own, other, one))
    common = shapely.intersection(shapes[one[near]], shapes[other[near]])
    over = np.zeros(len(one), dtype=np.bool_)
    over[near] = shapely.area(common) > SIDE_BY_SIDE_MICRONS * shapely.length(common) / 2.0
    new = np.append(True, (np.diff(which) > 1) | (np.diff(run[which]) != 0))
    new |= ~simple | np.append(False, ~simple[:-1])
    number = _split(new, part[which], one[over], other[over])
    touching = np.unique(number[one][number[one] == number[other]])
    member = np.isin(number, touching)
    group[which[member]] = np.searchsorted(touching, number[member])
    return group


def beside_a_side(microns: Ints, offsets: Ints, one: Ints, other: Ints) -> Bools:
    """(k,) whether polygons other (k,), counter-clockwise as all, lie on the outer side of a side of polygons one (k,)
    that are convex; of those with more than FEW_CORNERS, or of which one is not convex, it is not said."""
    sizes = np.diff(offsets)
    few = sizes <= FEW_CORNERS
    # Corners in tables, the last one repeated: (FEW_CORNERS, m).
    step = np.minimum(np.arange(FEW_CORNERS)[:, None], sizes - 1)
    table = microns[np.where(few, offsets[:-1] + step, 0)].astype(np.float64)
    way = np.roll(table, -1, axis=0) - table
    back = np.roll(way, 1, axis=0)
    # A corner repeated has no way: the turn at the last one is that of the polygon.
    turn = way[..., 0] * back[..., 1] - way[..., 1] * back[..., 0]
    row = np.arange(len(sizes))
    last = table[np.clip(sizes - 1, 0, FEW_CORNERS - 1), row]
    before, after = last - table[np.clip(sizes - 2, 0, FEW_CORNERS - 1), row], table[0] - last
    sound = few & (turn <= 0.0).all(axis=0) & (after[:, 0] * before[:, 1] - after[:, 1] * before[:, 0] <= 0.0)
    found = np.zeros(len(one), dtype=np.bool_)
    asked = np.flatnonzero(sound[one] & few[other])
    for side in range(FEW_CORNERS):
        start, along = table[side, one[asked]], way[side, one[asked]]
        arm = table[:, other[asked]] - start
        left = along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]
        found[asked] |= (left.max(axis=0) <= 0.0) & any_component(along)
    return found


def _neighbours(shapes: NDArray[np.object_], run: Ints) -> tuple[Ints, Ints]:
    """The pairs of shapes of one run that overlap or touch, the earlier one first; none at all if their boxes are in
    one another's way more often than MOST_NEIGHBOURS allows. Shapes of the run -1 have no neighbours."""
    import shapely

    tree, met, found = shapely.STRtree(shapes), 0, []
    for start in range(0, len(shapes), _SHAPES_AT_ONCE):
        one, other = tree.query(shapes[start : start + _SHAPES_AT_ONCE])
        met += len(one)
        if met > MOST_NEIGHBOURS * (len(shapes) + _SHAPES_AT_ONCE):
            return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
        one = one + start
        pair = (one < other) & (run[one] == run[other]) & (run[one] >= 0)
        one, other = one[pair], other[pair]
        found.append(np.stack((one, other))[:, shapely.intersects(shapes[one], shapes[other])])
    first, second = np.concatenate(found, axis=1)
    return first, second


def _split(new: Bools, part: Ints, one: Ints, other: Ints) -> Ints:
    """(n,) numbers of groups, ascending, that begin where new is true, and before each polygon (other) that overlaps an
    earlier one of its group (one), or before the part (n,) that it is of. They are as long as they can be."""
    number = np.arange(len(new))
    begins = np.maximum.accumulate(np.where(np.append(True, part[1:] != part[:-1])[: len(new)], number, 0))
    latest = np.where(new, number - 1, -1)
    np.maximum.at(latest, other, one)
    latest = np.maximum.accumulate(latest)
    starts, at = [], 0
    while at < len(new):
        starts.append(at)
        end = int(np.searchsorted(latest, at))
        at = int(begins[end]) if end < len(new) and not new[end] and begins[end] > at else end
    return np.searchsorted(np.array(starts), number, side="right") - 1


def outline(microns: Ints, offsets: Ints) -> tuple[Floats, Ints]:
    """The borders of the union of polygons, as rings to be filled by the rule of even and odd: corners (q,2) in whole
    microns, the first of each ring not repeated, and offsets (r+1,). Holes narrower than SIDE_BY_SIDE_MICRONS, which
    rounding leaves between neighbours, are filled, and parts that narrow beside others left out."""
    import shapely

    rings = shapely.linearrings(microns, indices=ragged.owner(np.diff(offsets)))
    # On the grid of the corners: crossings between it can cost the union whole polygons.
    united = shapely.union_all(shapely.make_valid(shapely.polygons(rings)), grid_size=1.0)
    parts = shapely.get_parts(united)
    borders = shapely.get_rings(parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON])
    enclosed = shapely.polygons(borders)
    wide = shapely.area(enclosed) > SIDE_BY_SIDE_MICRONS * shapely.length(enclosed) / 2.0
    borders = borders[wide] if wide.any() else borders
    corners, ring = shapely.get_coordinates(borders, return_index=True)
    first = np.append(True, ring[1:] != ring[:-1])[: len(ring)]
    return np.rint(corners[~first]), ragged.offsets(np.bincount(ring[~first], minlength=len(borders)))
