"""What is seen of filled polygons, as polygons that do not overlap: for pens, which cannot paint over anything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, stacked
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import determinant, linear_solution
from vectorplot.geometry.budget import in_pieces, in_turn, may_stop, slices
from vectorplot.geometry.mesh import TRIANGLE, next_positions
from vectorplot.geometry.records import Elements
from vectorplot.geometry.regions import (
    POLYGON,
    REGIONS_AT_ONCE,
    corners_of,
    grown,
    insides_of,
    mosaics,
    polygons_of,
    triangles_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.geometry.triangles import PAIRS_AT_ONCE, overlapping
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances import CLEARANCE_MM, EDGE_ON_SINE, GRID_MM, STEP_BORDER_MM

AREA_MM2 = GRID_MM * GRID_MM
"""Smaller polygons have no inside."""


def visible_fills(fills: Fills, page_from_world: Floats) -> Fills:
    """Polygons without common inner points that make the same picture: each without what is painted over it.

    Parameters
    ----------
    fills : Fills
        Each painted over those before it.
    page_from_world : (4, 4) array of float
        See Drawing: points3d of new corners lie on the planes of their polygons.

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
    solid, lines = fills.take(np.flatnonzero(sizes > 2)), fills.take(np.flatnonzero(sizes == 2))
    parts, source = without_holes(*visible_regions(solid))
    return Fills.joined(listed(solid, parts, source, page_from_world), lines)


def cut_out(fills: Fills, over: Fills, page_from_world: Floats) -> Fills:
    """The parts of polygons, see visible_fills, that do not lie under others; these are not among them."""
    mark = int(fills.item.max(initial=0)) + 1
    found = visible_fills(Fills.joined(fills, replace(over, item=np.full(len(over), mark))), page_from_world)
    return found.take(np.flatnonzero(found.item != mark))


def visible_regions(fills: Fills) -> tuple[Any, Ints]:
    """What is seen of polygons of three corners or more: polygons of shapely (n,), which may have holes, and the number
    (n,) of the one each is a part of, ascending.

    Errors as in visible_fills.
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

    What covers a whole one covers its parts, and it is looked at once for all of them. Errors as in visible_fills.
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
    whole_of = np.repeat(seen[row], count)
    cut = in_pieces(partial(shapely.intersection, grid_size=GRID_MM), REGIONS_AT_ONCE, whole_of, regions[part])
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
        regions[cut] = in_pieces(partial(shapely.difference, grid_size=GRID_MM), REGIONS_AT_ONCE, regions[cut], covers)
    left = np.flatnonzero(~hidden)
    parts, number = without_splinters(regions[left], GRID_MM)
    return parts, left[number]


def _regions(fills: Fills) -> Any:
    """(n,) polygons, or several, with the insides of fills; sides that run out and back again are left out, as no
    overlay takes areas and lines at once."""
    import shapely

    mended = partial(shapely.make_valid, method="structure", keep_collapsed=False)
    return in_pieces(mended, REGIONS_AT_ONCE, polygons_of(fills.points.T, fills.offsets))


def _overlaps(regions: Any, opaque: Bools) -> tuple[Ints, Ints, Bools]:
    """Pairs of regions and opaque ones painted over them that have inner points in common; and (n,) those that a single
    one hides, which are in no pair, neither of the two."""
    import shapely

    none = np.zeros(0, dtype=np.intp)
    if not len(regions):
        return none, none, np.zeros(0, dtype=np.bool_)
    over = np.flatnonzero(opaque)
    tree = shapely.STRtree(regions[over])
    pieces = in_turn(slices(len(regions), REGIONS_AT_ONCE))
    below, above = np.concatenate([np.add(tree.query(regions[some]), [[some.start], [0]]) for some in pieces], axis=1)
    above = over[above]
    later = above > below
    below, above = below[later], above[later]
    common = _common(regions, below, above)
    below, above = below[common], above[common]
    hidden = np.zeros(len(regions), dtype=np.bool_)
    hidden[below[in_pieces(shapely.covers, REGIONS_AT_ONCE, regions[above], regions[below])]] = True
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
    common[plain] = in_pieces(
        lambda one, other: overlapping(corners[..., one], corners[..., other]),
        PAIRS_AT_ONCE,
        below[plain],
        above[plain],
    )
    # What each region is asked of many others is looked up in it once for all.
    shapely.prepare(regions)
    for asked, answer in ((shapely.intersects, True), (shapely.touches, False)):
        pairs = regions[below[common]], regions[above[common]]
        common[common] = in_pieces(asked, REGIONS_AT_ONCE, *pairs) == answer
    return common


def listed(fills: Fills, parts: Any, source: Ints, page_from_world: Floats) -> Fills:
    """Polygons of shapely, without holes, in the colours of the fills they are parts of."""
    may_stop()
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

    Edge cases: of a fill that is seen edge-on, or has no area, the nearest place on its border.
    """
    may_stop()
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


# Polygons and what lies on them, painted so that nothing shines through at their borders.
#
# Viewers cover a pixel on the border of a polygon in part. Where a polygon is painted light and then dark up to its
# border, some of the light is left there: a light line runs between it and its dark neighbour. So each polygon gets
# what is seen at its border once: what is hidden there by what lies on it is cut away, and what one can see through is
# mixed with what lies below it. Farther inside the lower polygons stay whole, so that nothing from behind them is seen
# where those that lie on them end.

MARGIN_MM = 0.5
"""So far inside a polygon its border is not in the same pixel, from 72 dots per inch on, its seam included."""

MOST_LAYERS, MOST_CLEAR = 48, 8
"""Where more polygons lie on one, or more that one can see through, each of which cuts all below it, they stay as they
are."""


def flattened(base: Fills, overlays: Sequence[Overlay], page_from_world: Floats, plane: Ints | None = None) -> Overlay:
    """The polygons of base with what lies on them, each after its base polygon: the same picture, with at most one
    covering any place near a border of base. overlays: polygons within those of base that they come after, in their
    order on each other; plane (m,): consecutive polygons of one plane become one, with what lies on them;
    page_from_world (4,4) as in Drawing. Consecutive polygons of one colour on the same one are united; what lies on
    transparent polygons stays.
    Error: parts narrower than a few GRID_MM are left out. Edge cases: what is wholly covered is left out; stacks of
    more than MOST_LAYERS or MOST_CLEAR stay, but for the union of equal colours.
    """
    opaque = (base.opacity >= 1.0) & (base.kind != FillKind.BACKGROUND)
    layers = stacked([Overlay(base, np.arange(len(base))), *overlays])
    kept = _uncovered(base, layers, opaque)
    ground = np.append(True, layers.after[1:] != layers.after[:-1])[kept]
    layers = Overlay(layers.fills.take(kept), layers.after[kept])
    stack = _planes(base, opaque, np.arange(len(base)) if plane is None else plane)
    several = np.bincount(stack, minlength=len(base))[stack] > 1
    touched = opaque & (several | _reaching_borders(base, layers))
    which = np.flatnonzero(touched[layers.after])
    if not len(which):
        return layers
    heaps = _brought_together(Overlay(layers.fills.take(which), layers.after[which]), ground[which], stack)
    low = _within_limits(heaps)
    # A high heap on a polygon that is one anyway has nothing to be brought together.
    alone = ~low & ~several[heaps.stack]
    source, done = layers.fills.take(which), [heaps.take(np.flatnonzero(~low & ~alone))]
    if low.any():
        done.append(_cut_apart(base, stack, heaps.take(np.flatnonzero(low)), source))
    left = np.ones(len(base), dtype=np.bool_)
    left[heaps.stack[~alone]] = False
    rest = np.flatnonzero(left[stack[layers.after]])
    whole = Overlay(layers.fills.take(rest), layers.after[rest])
    return stacked([whole, *(_listed(some, source, page_from_world) for some in done)])


def _planes(base: Fills, opaque: Bools, plane: Ints) -> Ints:
    """(m,) for each polygon the first one of those that follow each other in its plane and look alike."""
    shaded = _shaded(base)
    colours = base.colours[base.offsets[:-1]].astype(np.intp)
    rows = np.column_stack([plane, base.item, base.kind, colours])
    new = np.ones(len(base), dtype=np.bool_)
    new[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    new |= shaded | ~opaque
    new[1:] |= shaded[:-1] | ~opaque[:-1]
    return np.maximum.accumulate(np.where(new, np.arange(len(base)), 0))


def _brought_together(layers: Overlay, ground: Bools, stack: Ints) -> _Layers:
    """Layers of stacks of one or more polygons of base, from below: of several those that have one colour and lie
    equally deep as one region. ground (n,): those that are polygons of base; stack (m,) the stack of each of these."""
    fills = layers.fills
    count = len(fills)
    of, number = stack[layers.after], np.arange(count)
    region = insides_of(polygons_of(fills.points.T, fills.offsets))
    every = _Layers(region, of, number, np.ones(count), np.zeros((count, 3)), fills.opacity, fills.kind)
    several = np.zeros(int(of.max()) + 1, dtype=np.bool_)
    several[of[layers.after != of]] = True
    some = several[of]
    depth = number.copy()
    depth[some] = _depths(region[some], layers.after[some], ground[some])
    tone = np.where(some, fills.colours[fills.offsets[:-1]].astype(np.intp) @ (65536, 256, 1), 0)
    order = np.lexsort((number, tone, depth, of))
    return _united(every.take(order), fills, depth[order])


def _depths(region: NDArray[np.object_], piece: Ints, ground: Bools) -> Ints:
    """(n,) on how many others regions lie, one on the other, on the same piece (n,): no two of one depth overlap, as
    pieces do not. ground (n,): those that are pieces; of some they are left out."""
    import shapely

    number = np.arange(len(piece))
    new = np.append(True, piece[1:] != piece[:-1])[: len(piece)]
    start = np.maximum.accumulate(np.where(new, number, 0))
    count = number - start
    above = np.repeat(number, count)
    below = np.arange(len(above)) - np.repeat(ragged.starts(count) - start, count)
    common = shapely.intersects(region[below], region[above])
    above, below = above[common], below[common]
    both = shapely.area(insides_of(shapely.intersection(region[below], region[above])))
    real = both > GRID_MM * np.minimum(shapely.length(region[below]), shapely.length(region[above]))
    above, below = above[real], below[real]
    depth = np.zeros(len(piece), dtype=np.intp)
    depth[~ground] = 1
    while True:
        deeper = depth.copy()
        np.maximum.at(deeper, above, depth[below] + 1)
        if (deeper == depth).all():
            return depth
        depth = deeper


def _uncovered(base: Fills, layers: Overlay, opaque: Bools) -> Ints:
    """The numbers of the polygons without those that lie below one as large as that of base."""
    if len(layers.fills) == len(base):
        return np.arange(len(base))
    area, _ = _measures(layers.fills)
    whole, around = _measures(base)
    covers = (area >= whole[layers.after] - GRID_MM * around[layers.after]) & (layers.fills.opacity >= 1.0)
    number = np.arange(len(area))
    top = np.full(len(base), -1, dtype=np.intp)
    np.maximum.at(top, layers.after[covers], number[covers])
    return np.flatnonzero((number >= top[layers.after]) | ~opaque[layers.after])


def _within_limits(layers: _Layers) -> Bools:
    """(n,) the layers of stacks of no more than can be cut apart in a short time."""
    clear = np.bincount(layers.stack, layers.opacity < 1.0)
    return np.asarray((np.bincount(layers.stack) <= MOST_LAYERS) & (clear <= MOST_CLEAR), dtype=np.bool_)[layers.stack]


def _measures(fills: Fills) -> tuple[Floats, Floats]:
    """(m,) the areas and (m,) the perimeters of polygons."""
    if not len(fills):
        return np.zeros(0), np.zeros(0)
    start, sizes = fills.offsets[:-1], np.diff(fills.offsets)
    arm = fills.points - np.repeat(fills.points[start], sizes, axis=0)
    after = arm[next_positions(fills.offsets, np.arange(len(arm)))]
    area = np.add.reduceat(cross(arm, after), start)
    return np.abs(area) / 2.0, np.add.reduceat(np.hypot(*(after - arm).T), start)


def _reaching_borders(base: Fills, layers: Overlay) -> Bools:
    """(n,) the polygons of base with something on them that comes near their border, or that one can see through."""
    import shapely

    result = np.zeros(len(base), dtype=np.bool_)
    deep = np.flatnonzero(np.bincount(layers.after, minlength=len(base)) > 1)
    if not len(deep):
        return result
    border = np.full(len(base), None, dtype=object)
    some = base.take(deep)
    border[deep] = shapely.boundary(polygons_of(some.points.T, some.offsets))
    first = np.append(True, layers.after[1:] != layers.after[:-1])
    on = np.flatnonzero(~first)
    parts = layers.fills.take(on)
    of = layers.after[on]
    far = shapely.distance(shapely.points(parts.points), border[np.repeat(of, np.diff(parts.offsets))])
    near = np.minimum.reduceat(far, parts.offsets[:-1]) < MARGIN_MM
    result[of[near | (parts.opacity < 1.0)]] = True
    return result


@dataclass(frozen=True, eq=False)
class _Layers(Elements):
    """Regions that lie on each other, those of one stack (n,) from below: source (n,) the fill that each has its colour
    and plane of, kept (n,) how much of this colour, and added (n,3) what is added to it; opacity (n,); kind (n,)
    FillKind values."""

    region: NDArray[np.object_]
    stack: Ints
    source: Ints
    kept: Floats
    added: Floats
    opacity: Floats
    kind: Ints

    @classmethod
    def joined(cls, *parts: _Layers) -> _Layers:
        return records.joined(parts)


def _cut_apart(base: Fills, stack: Ints, layers: _Layers, fills: Fills) -> _Layers:
    """The layers of stacks, cut: fills have their colours. stack (m,) of the polygons of base."""
    import shapely

    layers = _united(_mixed(layers, fills), fills)
    numbers, of = np.unique(layers.stack, return_inverse=True)
    below = np.flatnonzero(np.isin(stack, numbers))
    some = base.take(below)
    parts = insides_of(polygons_of(some.points.T, some.offsets))
    ground = unions(parts, np.searchsorted(numbers, stack[below]), None)
    inside = grown(insides_of(ground), -MARGIN_MM)
    above = _above(layers)
    hidden = in_pieces(shapely.covers, REGIONS_AT_ONCE, above, layers.region)
    cover = in_pieces(shapely.difference, REGIONS_AT_ONCE, above, inside[of])
    covered = np.flatnonzero(~shapely.is_empty(cover))
    region = layers.region.copy()
    region[covered] = insides_of(
        in_pieces(shapely.difference, REGIONS_AT_ONCE, region[covered], insides_of(cover[covered]))
    )
    return replace(layers, region=region).take(np.flatnonzero(~hidden))


def _above(layers: _Layers) -> NDArray[np.object_]:
    """(n,) the union of all that lies above each region in its stack, and CLEARANCE_MM around it."""
    import shapely

    count = len(layers.stack)
    result = np.full(count, shapely.Polygon(), dtype=object)
    last = np.append(layers.stack[1:] != layers.stack[:-1], True)[:count]
    ends = np.flatnonzero(last)
    from_top = np.repeat(ends, np.diff(ends, prepend=-1)) - np.arange(count)
    for depth in in_turn(range(1, int(from_top.max(initial=0)) + 1)):
        here = np.flatnonzero(from_top == depth)
        result[here] = insides_of(shapely.union(result[here + 1], layers.region[here + 1]))
    return np.asarray(insides_of(grown(result, CLEARANCE_MM)))


def _mixed(layers: _Layers, fills: Fills) -> _Layers:
    """The same with opaque parts of what lies below in place of what one can see through."""
    import shapely

    while True:
        may_stop()
        clear = np.flatnonzero(layers.opacity < 1.0)
        if not len(clear):
            return layers
        numbers, first = np.unique(layers.stack[clear], return_index=True)
        place = clear[first]
        of = np.searchsorted(numbers, layers.stack)
        own = np.append(numbers, -1)[of] == layers.stack
        veil = np.where(own, np.append(place, len(layers.stack))[of], len(layers.stack))
        number = np.arange(len(layers.stack))
        below = np.flatnonzero(number < veil)
        below = below[own[below]]
        under = layers.take(below)
        seen = insides_of(shapely.difference(under.region, _above(under)))
        seen = insides_of(shapely.intersection(seen, layers.region[veil[below]]))
        share = layers.opacity[veil[below]]
        tint = _means(fills)[layers.source[veil[below]]]
        veiled = replace(
            under,
            region=seen,
            kept=under.kept * (1.0 - share),
            added=under.added * (1.0 - share)[:, None] + tint * share[:, None],
            kind=layers.kind[veil[below]],
        )
        left = np.flatnonzero(number != veil)
        every = _Layers.joined(layers.take(left), veiled)
        position = np.concatenate([left, veil[below]])
        order = np.argsort(position, kind="stable")
        layers = every.take(order[~shapely.is_empty(every.region[order])])


def _means(fills: Fills) -> Floats:
    """(m,3) the mean colours of the corners of polygons."""
    total = np.add.reduceat(fills.colours.astype(np.float64), fills.offsets[:-1])
    return np.asarray(total / np.diff(fills.offsets)[:, None])


def _shaded(fills: Fills) -> Bools:
    """(m,) whether the corners of polygons differ in colour."""
    first = np.repeat(fills.colours[fills.offsets[:-1]], np.diff(fills.offsets), axis=0)
    return np.asarray(np.logical_or.reduceat((fills.colours != first).any(axis=1), fills.offsets[:-1]))


def _united(layers: _Layers, fills: Fills, depth: Ints | None = None) -> _Layers:
    """The same with neighbours in a stack that have one colour as one region; what one can see through only where
    neighbours have one depth (n,), so that they do not overlap."""
    colour = np.rint(layers.kept[:, None] * _means(fills)[layers.source] + layers.added)
    columns = np.column_stack([layers.stack, fills.item[layers.source], layers.kind, layers.opacity, colour])
    alone = _shaded(fills)[layers.source]
    clear = layers.opacity < 1.0
    new = np.ones(len(alone), dtype=np.bool_)
    new[1:] = (columns[1:] != columns[:-1]).any(axis=1) | alone[1:] | alone[:-1]
    new[1:] |= clear[1:] & (True if depth is None else depth[1:] != depth[:-1])
    if new.all():
        return layers
    leaders = layers.take(np.flatnonzero(new))
    several = np.flatnonzero(np.diff(np.append(np.flatnonzero(new), len(new))) > 1)
    run = np.cumsum(new) - 1
    region = leaders.region.copy()
    mine = np.flatnonzero(np.isin(run, several))
    region[several] = unions(layers.region[mine], np.searchsorted(several, run[mine]), None)
    return replace(leaders, region=region)


def _listed(layers: _Layers, fills: Fills, page_from_world: Floats) -> Overlay:
    """Regions as polygons without holes; shaded ones that are not convex as triangles."""

    parts, of = without_splinters(layers.region, GRID_MM)
    parts, of = without_holes(parts, of)
    parts, of = _convex_if_shaded(parts, of, layers, fills)
    flat, offsets = corners_of(parts)
    sizes = np.diff(offsets)
    source, owner = layers.source[of], np.repeat(of, sizes)
    colours = _colours_at(flat, fills, layers.source[owner])
    colours = np.rint(layers.kept[owner][:, None] * colours + layers.added[owner])
    made = Fills(
        np.ascontiguousarray(flat.T),
        offsets,
        np.clip(colours, 0.0, 255.0).astype(np.uint8),
        layers.opacity[of],
        fills.item[source],
        in_space(fills, flat.T, layers.source[owner], page_from_world),
        layers.kind[of],
    )
    return Overlay(made, layers.stack[of])


def _convex_if_shaded(parts: Any, of: Ints, layers: _Layers, fills: Fills) -> tuple[Any, Ints]:
    """Hulls in place of shaded polygons that are convex but for the grid, triangles in place of others."""
    import shapely

    shaded = _shaded(fills)[layers.source[of]]
    parts = np.where(shaded, shapely.simplify(parts, GRID_MM), parts)
    hull = shapely.convex_hull(parts)
    bent = shaded & (shapely.area(hull) - shapely.area(parts) > GRID_MM * shapely.length(parts))
    parts = np.where(shaded & ~bent, hull, parts)
    if not bent.any():
        return parts, of
    triangles, owner = triangles_of(parts[bent])
    every = np.concatenate([parts[~bent], triangles])
    number = np.concatenate([np.flatnonzero(~bent), np.flatnonzero(bent)[owner]])
    order = np.argsort(number, kind="stable")
    return every[order], of[number[order]]


def _colours_at(points: Floats, fills: Fills, source: Ints) -> Floats:
    """(c,3) the colours that fills have at points (2,c): of shaded ones those of the triangle of the fan that each
    point lies in."""
    first = fills.offsets[source]
    found = fills.colours[first].astype(np.float64)
    asked = np.flatnonzero(_shaded(fills)[source])
    best = np.full(len(asked), -np.inf)
    size = np.diff(fills.offsets)[source[asked]]
    for step in range(1, int(size.max(initial=2)) - 1):
        here = np.flatnonzero(size > step + 1)
        point = asked[here]
        corner = first[point][:, None] + np.array([0, step, step + 1])
        a, b, c = (fills.points[corner[:, k]] for k in range(3))
        p = points[:, point].T
        area = _turn(a, b, c)
        with np.errstate(divide="ignore", invalid="ignore"):
            weights = np.stack([_turn(p, b, c), _turn(a, p, c), _turn(a, b, p)]) / area
        weights = np.nan_to_num(weights, nan=-np.inf, posinf=-np.inf, neginf=-np.inf)
        inside = weights.min(axis=0)
        better = inside > best[here]
        best[here[better]] = inside[better]
        share = np.clip(weights[:, better], 0.0, 1.0)
        # Nothing of all three is left of a triangle that rounding makes of nothing.
        share[:, share.sum(axis=0) == 0.0] = 1.0
        share /= share.sum(axis=0)
        found[point[better]] = np.einsum("kn,nkd->nd", share, fills.colours[corner[better]].astype(np.float64))
    return found


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """(n,) twice the signed areas of triangles."""
    one, other = b - a, c - a
    return cross(one, other)


# Polygons that follow each other in one colour as one region.


def united(overlay: Overlay, sheet: Ints) -> Overlay:
    """The same picture with one region, cut open to its holes, in place of consecutive polygons of one colour, item and
    kind on the same polygon and of one sheet (m,), -1 for none. Shaded polygons, and transparent ones without a
    sheet, which may overlap, stay. Corners in space are those of the polygons, or interpolated.
    Error: new corners are off by GRID_MM at most; parts narrower than a few of these are left out.
    """
    import shapely

    fills = overlay.fills
    run = _runs(overlay, sheet)
    several = np.bincount(run, minlength=1)[run] > 1
    mine = np.flatnonzero(several)
    if not len(mine):
        return overlay
    _, first, of = np.unique(run[mine], return_index=True, return_inverse=True)
    some = fills.take(mine)
    regions = insides_of(polygons_of(some.points.T, some.offsets))
    region = unions(regions, of, GRID_MM)
    leader, kept = mine[first], np.flatnonzero(~several)
    parts, which = without_splinters(region, GRID_MM)
    parts, which = without_holes(shapely.simplify(parts, GRID_MM), which)
    source = leader[which]
    made = _regions_listed(some, parts, first[which])
    order = np.argsort(np.concatenate([kept, source]), kind="stable")
    after = np.concatenate([overlay.after[kept], overlay.after[source]])
    return Overlay(Fills.joined(fills.take(kept), made).take(order), after[order])


def visible_shades(painted: Overlay, smooth: Bools, page_from_world: Floats) -> Fills:
    """What is seen of polygons, see visible_fills, with one region, cut open to its holes, in place of those of one
    colour of an item, among the items that are smooth (i,). What one can see through stays in its parts.

    painted: the polygons; those that come after one number are parts of one, see visible_parts, those of -1 of none.
    Corners in space, errors as in united; borders of regions are off by less than STEP_BORDER_MM, on both sides alike.
    """
    import shapely

    fills = painted.fills
    whole = np.where(painted.after < 0, -1 - np.arange(len(fills)), painted.after)

    sizes = np.diff(fills.offsets)
    solid, lines = fills.take(np.flatnonzero(sizes >= TRIANGLE)), fills.take(np.flatnonzero(sizes < TRIANGLE))
    if not len(solid):
        return fills
    seen = visible_parts(solid, whole[sizes >= TRIANGLE])
    of_item = np.append(smooth, False)[solid.item] & (solid.opacity >= 1.0) & ~_are_shaded(solid)
    mine = of_item[seen.source]
    rest = listed(solid, *without_holes(seen.parts[~mine], seen.source[~mine]), page_from_world)
    parts, source, uncut = seen.parts[mine], seen.source[mine], seen.uncut[mine]
    rows = np.column_stack([solid.item, solid.kind, solid.colours[solid.offsets[:-1]]])[source]
    _, first, of = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    of = of.reshape(-1)
    # Those that nothing was taken from have whole sides in common, which is told fast.
    some, group = np.unique(of[uncut], return_inverse=True)
    every = np.concatenate([unions(parts[uncut], group.reshape(-1), None), parts[~uncut]])
    group = np.concatenate([some, of[~uncut]])
    regions, which = without_splinters(unions(every, group, GRID_MM), GRID_MM)
    regions, which = without_holes(shapely.coverage_simplify(regions, STEP_BORDER_MM), which)
    return Fills.joined(rest, _regions_listed(solid, regions, source[first][which]), lines)


def _runs(overlay: Overlay, sheet: Ints) -> Ints:
    """(m,) the number of the run of each polygon."""
    fills = overlay.fills
    colour = fills.colours[fills.offsets[:-1]]
    rows = np.column_stack([sheet, overlay.after, fills.item, fills.kind, fills.opacity, colour])
    alone = _are_shaded(fills) | (np.diff(fills.offsets) < 3) | ((fills.opacity < 1.0) & (sheet < 0))
    new = np.ones(len(fills), dtype=np.bool_)
    new[1:] = (rows[1:] != rows[:-1]).any(axis=1) | alone[1:] | alone[:-1]
    return np.cumsum(new) - 1


def _are_shaded(fills: Fills) -> Bools:
    """(m,) whether the corners of polygons differ in colour."""
    first = np.repeat(fills.colours[fills.offsets[:-1]], np.diff(fills.offsets), axis=0)
    differs = ragged.offsets((fills.colours != first).any(axis=1))[fills.offsets]
    return np.asarray(differs[1:] > differs[:-1])


def _regions_listed(fills: Fills, parts: Any, source: Ints) -> Fills:
    """Polygons of shapely, without holes, that are unions of fills, each in the colours of the fill source (n,)."""
    flat, offsets = corners_of(parts)
    points, in_space = _as_they_were(fills, flat.T)
    colours = fills.colours[fills.offsets[np.repeat(source, np.diff(offsets))]]
    return Fills(points, offsets, colours, fills.opacity[source], fills.item[source], in_space, fills.kind[source])


def _as_they_were(fills: Fills, points: Floats) -> tuple[Floats, Floats]:
    """(c,2) points of the page near corners of polygons, moved to these where the grid has moved them off, and (c,3)
    where they are in space: by the two nearest corners."""
    from scipy.spatial import cKDTree

    distance, near = cKDTree(fills.points).query(points, k=2)
    weight = 1.0 / np.maximum(distance, GRID_MM * GRID_MM)
    weight /= weight.sum(axis=1, keepdims=True)
    space = np.einsum("ck,ckd->cd", weight, fills.points3d[near])
    same = distance[:, 0] <= 2.0 * GRID_MM
    space[same] = fills.points3d[near[same, 0]]
    return np.where(same[:, None], fills.points[near[:, 0]], points), space
