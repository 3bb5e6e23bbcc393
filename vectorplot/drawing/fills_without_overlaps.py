"""What is seen of filled polygons, as polygons that do not overlap: for pens, which cannot paint over anything."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import Fills
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant, linear_solution
from vectorplot.geometry.mesh import TRIANGLE, next_positions
from vectorplot.geometry.regions import (
    POLYGON,
    corners_of,
    mosaics,
    polygons_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.geometry.triangles.overlapping_triangles import overlapping
from vectorplot.tolerances.of_angles import EDGE_ON_SINE
from vectorplot.tolerances.of_the_page import GRID_MM

AREA_MM2 = GRID_MM * GRID_MM
"""Smaller polygons have no inside."""


def visible_fills(fills: Fills, page_from_world: Floats) -> Fills:
    """Polygons without common inner points that make the same picture: each without what is painted over it.

    Parameters
    ----------
    fills : Fills
        Each painted over those before it.
    page_from_world : (4, 4) array of float
        As of Drawing: points3d of new corners lie on the planes of their polygons.

    Returns
    -------
    Fills
        Parts of the polygons.

    Notes
    -----
    Polygons that one can see through take nothing from what lies behind them. A shaded polygon has the mean colour of
    its corners; lines (two corners) stay as they are, on top.

    Error: corners move by a ten-thousandth of a mm at most, parts narrower than a few of these are left out.

    Source: Weiler and Atherton, Hidden surface removal using polygon area sorting (1977).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import Fills, visible_fills
    >>> below = [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]
    >>> above = [(20.0, 0.0), (60.0, 0.0), (60.0, 30.0), (20.0, 30.0)]
    >>> colours = np.array([(255, 0, 0), (0, 0, 255)], dtype=np.uint8)
    >>> fills = Fills.flat(np.array(below + above), np.array([0, 4, 8]), colours)
    >>> visible_fills(fills, np.eye(4)).points[:4, 0].max().item()
    20.0
    """
    sizes = np.diff(fills.offsets)
    solid, lines = fills.some(np.flatnonzero(sizes > 2)), fills.some(np.flatnonzero(sizes == 2))
    parts, source = without_holes(*visible_regions(solid))
    return Fills.joined(listed(solid, parts, source, page_from_world), lines)


def cut_out(fills: Fills, over: Fills, page_from_world: Floats) -> Fills:
    """The parts of polygons, as of visible_fills, that do not lie under others; these are not among them."""
    mark = int(fills.item.max(initial=0)) + 1
    found = visible_fills(Fills.joined(fills, replace(over, item=np.full(len(over), mark))), page_from_world)
    return found.some(np.flatnonzero(found.item != mark))


def visible_regions(fills: Fills) -> tuple[Any, Ints]:
    """What is seen of polygons of three corners or more: polygons of shapely (n,), which may have holes, and the number
    (n,) of the one each is a part of, ascending.

    Errors as of visible_fills.
    """
    return _seen(_regions(fills) if len(fills) else np.zeros(0, object), fills.opacity >= 1.0)


@dataclass(frozen=True, eq=False)
class PartsOfWholes:
    """What is seen of polygons: parts (n,), polygons of shapely, and source (n,), the polygon each is a part of; uncut
    (n,): whether it is that polygon, point by point."""

    parts: Any
    source: Ints
    uncut: Bools


def visible_parts(fills: Fills, whole: Ints) -> PartsOfWholes:
    """What is seen of polygons of three corners or more, those of one number (m,) convex parts of a convex one, that
    have whole sides in common, and that are painted one after the other but for what lies on them.

    What covers a whole one covers its parts, and it is looked at once for all of them. Errors as of visible_fills.
    """
    import shapely

    regions = _regions(fills)
    _, first, of = np.unique(whole, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    of, first = rank[of.reshape(-1)], first[order]
    several = np.bincount(of) > 1
    wholes = regions[first]
    inside = several[of]
    group = np.cumsum(several) - 1
    wholes[several] = mosaics(regions[inside], group[of[inside]])
    seen, number = _seen(wholes.copy(), fills.opacity[first] >= 1.0)
    same = (np.bincount(number, minlength=len(wholes))[number] == 1) & shapely.equals_identical(seen, wholes[number])
    left = np.flatnonzero(np.isin(of, number[same]) & inside)
    alone = np.flatnonzero(~several[number])
    # Of wholes that are covered in part: what is left of each, with each of its parts.
    row = np.flatnonzero(~same & several[number])
    starts, count = ragged.starts(counts := np.bincount(of, minlength=len(wholes))), counts[number[row]]
    by_whole = np.argsort(of, kind="stable")
    part = by_whole[ragged.ranges(starts[number[row]], count)]
    cut = shapely.intersection(np.repeat(seen[row], count), regions[part], grid_size=GRID_MM)
    cut, of_cut = without_splinters(cut, GRID_MM)
    parts = np.concatenate([regions[left], seen[alone], cut])
    source = np.concatenate([left, first[number[alone]], part[of_cut]])
    uncut = np.concatenate([np.ones(len(left), dtype=np.bool_), same[alone], np.zeros(len(cut), dtype=np.bool_)])
    order = np.argsort(source, kind="stable")
    return PartsOfWholes(parts[order], source[order], uncut[order])


def _seen(regions: Any, opaque: Bools) -> tuple[Any, Ints]:
    """What is seen of regions (n,), and the region of each part, ascending."""
    import shapely

    below, above, hidden = _overlaps(regions, opaque)
    cut, of = np.unique(below, return_inverse=True)
    if len(cut):
        covers = unions(regions[above], of, GRID_MM)
        regions[cut] = shapely.difference(regions[cut], covers, grid_size=GRID_MM)
    left = np.flatnonzero(~hidden)
    parts, number = without_splinters(regions[left], GRID_MM)
    return parts, left[number]


def _regions(fills: Fills) -> Any:
    """(n,) polygons, or several, with the insides of fills; sides that run out and back again are left out, as no
    overlay takes areas and lines at once."""
    import shapely

    return shapely.make_valid(polygons_of(fills.points.T, fills.offsets), method="structure", keep_collapsed=False)


def _overlaps(regions: Any, opaque: Bools) -> tuple[Ints, Ints, Bools]:
    """Pairs of regions and opaque ones painted over them that have inner points in common; and (n,) those that a single
    one hides, which are in no pair, neither of the two."""
    import shapely

    none = np.zeros(0, dtype=np.intp)
    if not len(regions):
        return none, none, np.zeros(0, dtype=np.bool_)
    over = np.flatnonzero(opaque)
    below, above = shapely.STRtree(regions[over]).query(regions)
    above = over[above]
    later = above > below
    below, above = below[later], above[later]
    common = _common(regions, below, above)
    below, above = below[common], above[common]
    hidden = np.zeros(len(regions), dtype=np.bool_)
    hidden[below[shapely.covers(regions[above], regions[below])]] = True
    hidden |= shapely.area(regions) <= AREA_MM2
    # What hides a hidden one hides whatever that one would.
    needed = ~hidden[below] & ~hidden[above]
    return below[needed], above[needed], hidden


def _common(regions: Any, below: Ints, above: Ints) -> Bools:
    """(k,) which pairs of regions have inner points in common."""
    import shapely

    # Most regions are triangles, and most of those that are near each other touch at most: a few products tell.
    three = (shapely.get_type_id(regions) == POLYGON) & (shapely.get_num_coordinates(regions) == TRIANGLE + 1)
    triangles = np.full((len(regions), TRIANGLE + 1, 2), np.nan)
    triangles[three] = shapely.get_coordinates(regions[three]).reshape(-1, TRIANGLE + 1, 2)
    corners = np.ascontiguousarray(triangles[:, :TRIANGLE].T)
    common = np.ones(len(below), dtype=np.bool_)
    plain = three[below] & three[above]
    common[plain] = overlapping(corners[..., below[plain]], corners[..., above[plain]])
    # What each region is asked of many others is looked up in it once for all.
    shapely.prepare(regions)
    common[common] = shapely.intersects(regions[below[common]], regions[above[common]])
    common[common] = ~shapely.touches(regions[below[common]], regions[above[common]])
    return common


def listed(fills: Fills, parts: Any, source: Ints, page_from_world: Floats) -> Fills:
    """Polygons of shapely, without holes, in the colours of the fills they are parts of."""
    flat, offsets = corners_of(parts)
    sizes = np.diff(offsets)
    total = np.add.reduceat(fills.colours.astype(np.float64), fills.offsets[:-1]) if len(fills) else fills.colours
    mean = np.rint(total / np.diff(fills.offsets)[:, None]).astype(np.uint8) if len(fills) else fills.colours
    corner = np.repeat(source, sizes)
    return Fills(
        np.ascontiguousarray(flat.T),
        offsets,
        mean[corner],
        fills.opacity[source],
        fills.item[source],
        in_space(fills, flat.T, corner, page_from_world),
        fills.kind[source],
    )


def in_space(fills: Fills, points: Floats, source: Ints, page_from_world: Floats) -> Floats:
    """(c,3) where the sight lines of points (c,2) of the page meet the planes of fills (c,).

    Degenerate: of a fill that is seen edge-on, or has no area, the nearest place on its border.
    """
    if not len(points):
        return np.zeros((0, 3))
    normal, place = planes_of_fills(fills)
    rows = page_from_world[:2, None] - points.T[:, :, None] * page_from_world[3]
    system = np.stack([rows[0, :, :3], rows[1, :, :3], normal[source]], axis=1)
    # From the first corner of the fill, so that digits are kept far from the origin.
    first = place[source]
    right = np.stack([-(rows[k, :, :3] * first).sum(axis=1) - rows[k, :, 3] for k in (0, 1)], axis=1)
    system[:, :2] /= (size := np.linalg.norm(system[:, :2], axis=2, keepdims=True))
    right = np.concatenate([right / size[..., 0], np.zeros((len(points), 1))], axis=1)
    steep = np.abs(determinant(system)) > EDGE_ON_SINE
    found = first.copy()
    found[steep] += linear_solution(system[steep], right[steep][..., None])[..., 0]
    if not steep.all():
        found[~steep] = _on_borders(fills, points[~steep], source[~steep])
    return found


def _on_borders(fills: Fills, points: Floats, source: Ints) -> Floats:
    """(c,3) the places in space on the borders of fills (c,) that come nearest to points (c,2) of the page."""
    start, sizes = ragged.take(fills.offsets, source)
    of = ragged.owner(np.diff(sizes))
    end = next_positions(fills.offsets, np.arange(len(fills.points)))[start]
    way = fills.points[end] - fills.points[start]
    square = (way * way).sum(axis=1)
    part = ((points[of] - fills.points[start]) * way).sum(axis=1) / np.where(square > 0.0, square, 1.0)
    part = np.clip(part, 0.0, 1.0)[:, None]
    off = fills.points[start] + part * way - points[of]
    nearest = np.lexsort(((off * off).sum(axis=1), of))[sizes[:-1]]
    one, two = fills.points3d[start[nearest]], fills.points3d[end[nearest]]
    return np.asarray(one + part[nearest] * (two - one))


def planes_of_fills(fills: Fills) -> tuple[Floats, Floats]:
    """(m,3) unit normals of polygons in space, zero for those without area, and (m,3) their first corners."""
    start, sizes = fills.offsets[:-1], np.diff(fills.offsets)
    first = fills.points3d[start]
    arm = fills.points3d - np.repeat(first, sizes, axis=0)
    after = arm[next_positions(fills.offsets, np.arange(len(arm)))]
    area = np.add.reduceat(np.cross(arm, after), start)
    length = np.linalg.norm(area, axis=1, keepdims=True)
    return area / np.where(length > 0.0, length, 1.0), first
