"""Polygons and what lies on them, painted so that nothing shines through at their borders.

Viewers cover a pixel on the border of a polygon in part. Where a polygon is painted light and then dark up to its
border, some of the light is left there: a light line runs between it and its dark neighbour. So each polygon gets what
is seen at its border once: what is hidden there by what lies on it is cut away, and what one can see through is mixed
with what lies below it. Farther inside the lower polygons stay whole, so that nothing from behind them is seen where
those that lie on them end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.fills_without_overlaps import in_space
from vectorplot.drawing.painted_fills import Overlay, stacked
from vectorplot.geometry import ragged, records
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.regions import (
    corners_of,
    grown,
    insides_of,
    polygons_of,
    triangles_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.tolerances.of_the_page import CLEARANCE_MM, GRID_MM

MARGIN_MM = 0.5
"""So far inside a polygon its border is not in the same pixel, from 72 dots per inch on, its seam included."""

MOST_LAYERS, MOST_CLEAR = 48, 8
"""Where more polygons lie on one, or more that one can see through, each of which cuts all below it, they stay as they
are."""


def flattened(base: Fills, overlays: Sequence[Overlay], page_from_world: Floats, plane: Ints | None = None) -> Overlay:
    """The polygons of base with what lies on them, each after the one it lies on: the same picture, but that no more
    than one of them covers a place near the border of a polygon of base.

    overlays: polygons inside those of base that they come after, in the order in which they lie on each other. plane
    (m,): numbers of the planes of the polygons of base: those of one plane that follow each other become one, without
    borders between them, and so does what lies on them. page_from_world (4,4) as in Drawing. Polygons of one colour
    that follow each other on the same one become one. What lies on polygons that one can see through stays as it is.
    Error: parts narrower than a few of GRID_MM are left out.
    Degenerate: what is covered as a whole is left out; heaps of more than MOST_LAYERS or MOST_CLEAR stay as they are,
    but that what has one colour is brought together where several polygons are one.
    """
    opaque = (base.opacity >= 1.0) & (base.kind != FillKind.BACKGROUND)
    layers = stacked([Overlay(base, np.arange(len(base))), *overlays])
    kept = _uncovered(base, layers, opaque)
    ground = np.append(True, layers.after[1:] != layers.after[:-1])[kept]
    layers = Overlay(layers.fills.some(kept), layers.after[kept])
    stack = _planes(base, opaque, np.arange(len(base)) if plane is None else plane)
    several = np.bincount(stack, minlength=len(base))[stack] > 1
    touched = opaque & (several | _reaching_borders(base, layers))
    which = np.flatnonzero(touched[layers.after])
    if not len(which):
        return layers
    heaps = _brought_together(Overlay(layers.fills.some(which), layers.after[which]), ground[which], stack)
    low = _within_limits(heaps)
    # A high heap on a polygon that is one anyway has nothing to be brought together.
    alone = ~low & ~several[heaps.stack]
    source, done = layers.fills.some(which), [heaps.some(np.flatnonzero(~low & ~alone))]
    if low.any():
        done.append(_cut_apart(base, stack, heaps.some(np.flatnonzero(low)), source))
    left = np.ones(len(base), dtype=np.bool_)
    left[heaps.stack[~alone]] = False
    rest = np.flatnonzero(left[stack[layers.after]])
    whole = Overlay(layers.fills.some(rest), layers.after[rest])
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
    return _united(every.some(order), fills, depth[order])


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
    area = np.add.reduceat(arm[:, 0] * after[:, 1] - arm[:, 1] * after[:, 0], start)
    return np.abs(area) / 2.0, np.add.reduceat(np.hypot(*(after - arm).T), start)


def _reaching_borders(base: Fills, layers: Overlay) -> Bools:
    """(n,) the polygons of base with something on them that comes near their border, or that one can see through."""
    import shapely

    result = np.zeros(len(base), dtype=np.bool_)
    deep = np.flatnonzero(np.bincount(layers.after, minlength=len(base)) > 1)
    if not len(deep):
        return result
    border = np.full(len(base), None, dtype=object)
    some = base.some(deep)
    border[deep] = shapely.boundary(polygons_of(some.points.T, some.offsets))
    first = np.append(True, layers.after[1:] != layers.after[:-1])
    on = np.flatnonzero(~first)
    parts = layers.fills.some(on)
    of = layers.after[on]
    far = shapely.distance(shapely.points(parts.points), border[np.repeat(of, np.diff(parts.offsets))])
    near = np.minimum.reduceat(far, parts.offsets[:-1]) < MARGIN_MM
    result[of[near | (parts.opacity < 1.0)]] = True
    return result


@dataclass(frozen=True, eq=False)
class _Layers:
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

    def some(self, which: Ints) -> _Layers:
        return records.some(self, which)

    @classmethod
    def joined(cls, *parts: _Layers) -> _Layers:
        return records.joined(parts)


def _cut_apart(base: Fills, stack: Ints, layers: _Layers, fills: Fills) -> _Layers:
    """The layers of stacks, cut: fills have their colours. stack (m,) of the polygons of base."""
    import shapely

    layers = _united(_mixed(layers, fills), fills)
    numbers, of = np.unique(layers.stack, return_inverse=True)
    below = np.flatnonzero(np.isin(stack, numbers))
    some = base.some(below)
    parts = insides_of(polygons_of(some.points.T, some.offsets))
    ground = unions(parts, np.searchsorted(numbers, stack[below]), None)
    inside = grown(insides_of(ground), -MARGIN_MM)
    above = _above(layers)
    hidden = shapely.covers(above, layers.region)
    cover = shapely.difference(above, inside[of])
    covered = np.flatnonzero(~shapely.is_empty(cover))
    region = layers.region.copy()
    region[covered] = insides_of(shapely.difference(region[covered], insides_of(cover[covered])))
    return replace(layers, region=region).some(np.flatnonzero(~hidden))


def _above(layers: _Layers) -> NDArray[np.object_]:
    """(n,) the union of all that lies above each region in its stack, and CLEARANCE_MM around it."""
    import shapely

    count = len(layers.stack)
    result = np.full(count, shapely.Polygon(), dtype=object)
    last = np.append(layers.stack[1:] != layers.stack[:-1], True)[:count]
    ends = np.flatnonzero(last)
    from_top = np.repeat(ends, np.diff(ends, prepend=-1)) - np.arange(count)
    for depth in range(1, int(from_top.max(initial=0)) + 1):
        here = np.flatnonzero(from_top == depth)
        result[here] = insides_of(shapely.union(result[here + 1], layers.region[here + 1]))
    return np.asarray(insides_of(grown(result, CLEARANCE_MM)))


def _mixed(layers: _Layers, fills: Fills) -> _Layers:
    """The same with opaque parts of what lies below in place of what one can see through."""
    import shapely

    while True:
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
        under = layers.some(below)
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
        every = _Layers.joined(layers.some(left), veiled)
        position = np.concatenate([left, veil[below]])
        order = np.argsort(position, kind="stable")
        layers = every.some(order[~shapely.is_empty(every.region[order])])


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
    leaders = layers.some(np.flatnonzero(new))
    several = np.flatnonzero(np.diff(np.append(np.flatnonzero(new), len(new))) > 1)
    run = np.cumsum(new) - 1
    region = leaders.region.copy()
    mine = np.flatnonzero(np.isin(run, several))
    region[several] = unions(layers.region[mine], np.searchsorted(several, run[mine]), None)
    return replace(leaders, region=region)


def _listed(layers: _Layers, fills: Fills, page_from_world: Floats) -> Overlay:
    """Regions as polygons without holes; shaded ones that are not as they were as triangles."""
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
    """Triangles in place of shaded polygons that are not convex."""
    import shapely

    shaded = _shaded(fills)[layers.source[of]]
    hull = shapely.area(shapely.convex_hull(parts)) - shapely.area(parts)
    bent = shaded & (hull > GRID_MM * shapely.length(parts))
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
        share /= share.sum(axis=0)
        found[point[better]] = np.einsum("kn,nkd->nd", share, fills.colours[corner[better]].astype(np.float64))
    return found


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """(n,) twice the signed areas of triangles."""
    one, other = b - a, c - a
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
