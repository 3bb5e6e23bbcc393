"""Exact hidden lines: straight segments against convex occluders."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sized
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import intervals, ragged
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.polylines import joined
from vectorplot.scene.view import View, first_coincident
from vectorplot.tolerances import COVERED_MARGIN, SINGLE_LINE_SHARE
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import MAX_COVER_TESTS, Entries, Floats32, Grid, Pieces
from vectorplot.visibility.polyhedra.occluders import Occluders, face_occluders, solid_occluders
from vectorplot.visibility.projected_faces import CHUNK, ProjectedFaces

# Which pairs of a piece of a line and an occluder need a closer look: those that nothing in the image keeps apart.
#
# All of it is in single precision and errs on the side of the closer look. What is said of a piece or of an occluder is
# packed into single values of 16 bytes: so the processor fetches it at once.

Packed = NDArray[np.complex128]

SIDES = 2
"""So many sides of an outline are tried: the first ones, which for convex solids are the longest."""


@dataclass(frozen=True, eq=False)
class EarlyRejection:
    """Pieces and occluders in the image, packed.

    piece_boxes (p,): (right, -left, top, -bottom), boxes (k,): (left, -right, bottom, -top); ends (p,): x and y of the
    first end of each piece, then of the last; sides: for each of the SIDES (k,) lines as (a, b, c, 0), where
    a x + b y + c is below zero for what lies outside for certain.
    """

    piece_boxes: Packed
    boxes: Packed
    ends: Packed
    sides: tuple[Packed, ...]

    def passing(self, piece: Ints, occluder: Ints) -> Ints:
        """The pairs, by their positions, whose boxes overlap and of which no side of the outline keeps the piece
        outside."""
        passing = np.flatnonzero(_overlapping(self.piece_boxes.take(piece), self.boxes.take(occluder)))
        for side in self.sides:
            reaching = _reaching(self.ends.take(piece.take(passing)), side.take(occluder.take(passing)))
            passing = passing.compress(reaching)
        return passing


def early_rejection(view: View, grid: Grid, pieces: Pieces, occluders: Occluders) -> EarlyRejection:
    """The early rejection for pieces in a grid, which holds all of them, and occluders."""
    left, right, bottom, top = pieces.box
    piece_boxes = _packed(np.stack([right, -left, top, -bottom]))
    left, right, bottom, top = occluders.box
    boxes = _packed(np.stack([left, -right, bottom, -top]))
    return EarlyRejection(piece_boxes, boxes, _packed(pieces.ends), _sides(view, grid, occluders))


def _sides(view: View, grid: Grid, occluders: Occluders) -> tuple[Packed, ...]:
    """The first sides of every outline as lines in the image, moved outwards by more than what rounding may do."""
    reach = max(
        abs(grid.left),
        abs(grid.bottom),
        abs(grid.left + grid.cell * float(grid.columns[0])),
        abs(grid.bottom + grid.cell * float(grid.rows[0])),
    )
    last = occluders.offsets[1:] - 1
    sides = []
    for number in range(SIDES):
        plane = np.minimum(occluders.offsets[:-1] + occluders.behind + number, last)
        a, b, c, d = occluders.planes.take(plane, axis=1)
        shift = _shift(view, a, b, c) - d
        size = (np.abs(a) + np.abs(b)) * reach + np.abs(shift)
        # An occluder without an outline fills the image.
        outline = occluders.offsets[:-1] + occluders.behind <= last
        line = np.stack([a, b, shift + SINGLE_LINE_SHARE * size, np.zeros_like(a)]) / np.where(size > 0.0, size, 1.0)
        line[:3, ~outline] = [[0.0], [0.0], [1.0]]
        sides.append(_packed(line.astype(np.float32)))
    return tuple(sides)


def _shift(view: View, a: Floats, b: Floats, c: Floats) -> Floats:
    """What the middle of the image plane adds to the heights above planes with these normals."""
    if view.eye is None:
        x, y = view.target[:2]
        return np.asarray(a * x + b * y, dtype=np.float64)
    x, y, z = view.eye
    return np.asarray(a * x + b * y + c * (z - view.focus), dtype=np.float64)


def _packed(rows: Floats32) -> Packed:
    """(n,) columns (4,n) of single precision, each packed into one value."""
    return np.ascontiguousarray(rows.T).view(np.complex128).ravel()


def _overlapping(piece_box: Packed, box: Packed) -> Bools:
    """Which pairs of packed boxes overlap."""
    below = box.view(np.float32) < piece_box.view(np.float32)
    return np.asarray(below.view(np.uint32) == np.uint32(0x01010101), dtype=np.bool_)


def _reaching(ends: Packed, side: Packed) -> Bools:
    """Which pairs of packed ends and lines have an end that is not outside for certain."""
    x, y, last_x, last_y = ends.view(np.float32).reshape(-1, 4).T
    a, b, c, _ = side.view(np.float32).reshape(-1, 4).T
    return np.asarray(np.maximum(a * x + b * y, a * last_x + b * last_y) >= -c, dtype=np.bool_)


# One segment against one convex occluder, for many pairs at once.

FULL = 0.75
"""Pairs that are done with are taken out when they are more than the rest of this part."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Straight segments in the view's coordinates, all of them beyond the near plane.

    start, end (3,n): their ends, such as points_of of a view gives them.
    """

    start: Floats
    end: Floats

    def __len__(self) -> int:
        return int(self.start.shape[1])


@dataclass(frozen=True, eq=False)
class Hits:
    """Hidden intervals of single pairs: pair (h,) which one, low and high (h,) parameters, and side (h,): 0, or where
    the segment runs along a border of the occluder's shadow, 1 with the shadow on its left, -1 on its right."""

    pair: Ints
    low: Floats
    high: Floats
    side: Ints


def clip_pairs(
    view: View,
    segments: Segments,
    occluders: Occluders,
    segment: Ints,
    occluder: Ints,
    low: Floats,
    high: Floats,
    beyond: Bools,
) -> Hits:
    """What occluders hide of segments between the parameters low and high, pair by pair: one interval, since the points
    that a convex thing hides, itself included, are convex; the segment is clipped by the occluder's planes, those
    towards the eye first. beyond (n,): pairs wholly behind, not clipped by these. Distances below the view's
    tolerance are zero and do not hide; for a segment in a plane of the outline only the shadow's side counts.
    Source: Glaeser, section 7.2; errata G7-01 and G7-02.
    """
    skipped = occluders.behind.take(occluder) * beyond
    pair, reach = _over_first_plane(
        view, segments, occluders, segment, occluders.offsets.take(occluder) + skipped, beyond
    )
    low, high, side = low.take(pair), high.take(pair), np.zeros(len(pair), dtype=np.intp)
    of = segment.take(pair)
    ends = np.concatenate([segments.start.take(of, axis=1), segments.end.take(of, axis=1)])
    occluder, skipped = occluder.take(pair), skipped.take(pair)
    first, behind = occluders.offsets.take(occluder) + skipped, occluders.behind.take(occluder) - skipped
    count = occluders.offsets.take(occluder + 1) - first
    through = [(pair[:0], low[:0], high[:0], side[:0])]
    final = occluders.planes.shape[1] - 1
    for step in range(int(count.max(initial=0))):
        if step:
            reach = _heights(view, occluders, np.minimum(first + step, final), ends)
        at_start, at_end = reach
        product = at_start * at_end
        inside = np.maximum(at_start, at_end) > 0.0
        along = np.flatnonzero((product == 0.0) & (at_start == at_end) & (step >= behind))
        if len(along):
            inward = occluders.planes[:3].take(np.minimum(first[along] + step, final), axis=1)
            new = _shadow_side(view, ends[:3].take(along, axis=1), ends[3:].take(along, axis=1), inward)
            inside[along] = (side[along] == 0) | (side[along] == new)
            side[along] = new
        crossing = np.flatnonzero(product < 0.0)
        if len(crossing):
            begin, end = at_start.take(crossing), at_end.take(crossing)
            where, leaving = begin / (begin - end), begin > 0.0
            out, into = crossing.compress(leaving), crossing.compress(~leaving)
            high[out] = np.minimum(high.take(out), where.compress(leaving))
            low[into] = np.maximum(low.take(into), where.compress(~leaving))
        inside &= low < high
        last = inside & (count == step + 1)
        if last.any():
            done = np.flatnonzero(last)
            through.append((pair.take(done), low.take(done), high.take(done), side.take(done)))
            inside &= ~last
        if np.count_nonzero(inside) > FULL * len(inside):
            # Few are done with: they stay, marked by an empty interval, since moving the others costs more.
            np.putmask(high, ~inside, -1.0)
        else:
            kept = np.flatnonzero(inside)
            ends = ends.take(kept, axis=1)
            low, high = low.take(kept), high.take(kept)
            pair, side, first, count, behind = (of.take(kept) for of in (pair, side, first, count, behind))
    pair, low, high, side = (np.concatenate(column) for column in zip(*through, strict=True))
    return Hits(pair, low, high, side)


def _over_first_plane(
    view: View, segments: Segments, occluders: Occluders, segment: Ints, plane: Ints, beyond: Bools
) -> tuple[Ints, tuple[Floats, Floats]]:
    """The pairs of which the segment reaches over the first plane that is looked at, and both ends' distances from it.

    Most pairs of a mesh end here: the faces around a line do not hide it. A line in a plane of the outline stays.
    """
    a, b, c, d = (row.take(plane) for row in occluders.planes)
    x, y, z = (row.take(segment) for row in segments.start)
    at_start = a * x + b * y + c * z - d
    x, y, z = (row.take(segment) for row in segments.end)
    at_end = a * x + b * y + c * z - d
    least = np.where(beyond, -view.tolerance, view.tolerance)
    pair = np.flatnonzero(np.maximum(at_start, at_end) > least)
    return pair, (_snapped(at_start.take(pair), view.tolerance), _snapped(at_end.take(pair), view.tolerance))


def _heights(view: View, occluders: Occluders, plane: Ints, ends: Floats) -> tuple[Floats, Floats]:
    """Distances of both ends (6,n) of segments from planes, snapped to zero."""
    normals = occluders.planes.take(plane, axis=1)
    return _height(normals, ends[:3], view.tolerance), _height(normals, ends[3:], view.tolerance)


def _height(planes: Floats, points: Floats, tolerance: float) -> Floats:
    """Distances of points (3,n) from planes (4,n), snapped to zero."""
    height = planes[0] * points[0]
    term = planes[1] * points[1]
    height += term
    height += np.multiply(planes[2], points[2], out=term)
    height -= planes[3]
    return _snapped(height, tolerance)


def _snapped(distance: Floats, tolerance: float) -> Floats:
    distance *= np.abs(distance) > tolerance
    return distance


def _shadow_side(view: View, start: Floats, end: Floats, inward: Floats) -> Ints:
    """(n,) 1 where the inward normals (3,n) point to the left of start -> end in the image, else -1."""
    along = end - start
    if view.eye is None:
        left = np.stack([-along[1], along[0], np.zeros(along.shape[1])])
    else:
        left = cross(along, start - view.eye[:, None])
    return np.where((left * inward).sum(axis=0) > 0.0, 1, -1)


# Which cells of the image occluders cover, and which they touch.

LARGE_LEVEL = 2
"""What would be entered at this level or a coarser one is entered in finer cells, but only in those that its outline
touches, as long as it leaves many of them out: a long thin thing would be met by everything in its box."""

THIN = 0.8
"""A thing that touches at most so many of the finer cells in the cells it touches is entered in these."""


MANY_PIECES = 64
"""What is entered in a cell with more pieces is looked at in finer ones: that costs as much as to meet so many."""


AT_ONCE = 1 << 14
"""So many pairs of cells and planes are looked at in one step, or one plane for every cell."""


def covered_cells(view: View, grid: Grid, occluders: Occluders) -> Floats32:
    """(cells,) for each cell of the finest level, a depth beyond which everything in it is hidden by one occluder
    alone; infinite where there is none."""
    table = np.full(int(grid.first[-1]), np.inf, dtype=np.float32)
    occluder, column, row, level = _inner_cells(grid, occluders.box)
    if len(occluder):
        whole = _inside_outline(view, grid, occluders, (occluder, column, row, level), np.minimum, COVERED_MARGIN)
        cell = grid.numbers(column[whole], row[whole], level[whole])
        np.minimum.at(table, cell, occluders.farthest[occluder[whole]])
    for level_above in range(grid.levels - 1, 0, -1):
        rows, columns = int(grid.rows[level_above - 1]), int(grid.columns[level_above - 1])
        above = table[grid.first[level_above] : grid.first[level_above + 1]].reshape(int(grid.rows[level_above]), -1)
        below = table[grid.first[level_above - 1] : grid.first[level_above]].reshape(rows, columns)
        np.minimum(below, above.repeat(2, axis=0)[:rows].repeat(2, axis=1)[:, :columns], out=below)
    return table[: grid.first[1]]


def entered(view: View, grid: Grid, occluders: Occluders, which: Ints, held: Ints) -> Entries:
    """Some of the occluders, entered in the cells where they could hide something; large ones in finer cells as long as
    their own hold many pieces, held (cells,) of all levels, and they touch few of the finer ones."""
    box = occluders.box.take(which, axis=1)
    level = grids.entry_level(grid, box)
    thing, column, row = grids.touched(grid, box, level)
    occluder, level = which[thing], level[thing]
    large = level >= LARGE_LEVEL
    kept: list[tuple[Ints, ...]] = [(occluder[~large], column[~large], row[~large], level[~large])]
    thing, *cells = (part[large] for part in (thing, occluder, column, row, level))
    touching = _inside_outline(view, grid, occluders, tuple(cells), np.maximum, -COVERED_MARGIN)
    thing, *cells = (part.compress(touching) for part in (thing, *cells))
    while len(thing):
        many = held[grid.numbers(*cells[1:])] > MANY_PIECES
        kept.append(tuple(part[~many] for part in cells))
        thing, *cells = (part[many] for part in (thing, *cells))
        owner, finer = _finer(grid, *cells)
        filled = held[grid.numbers(*finer[1:])] > 0
        owner, finer = owner.compress(filled), tuple(part.compress(filled) for part in finer)
        touching = _inside_outline(view, grid, occluders, finer, np.maximum, -COVERED_MARGIN)
        owner = owner.compress(touching)
        count, made = np.bincount(thing, minlength=len(which)), np.bincount(thing[owner], minlength=len(which))
        thin = (made <= THIN * 4.0 * count)[thing]
        kept.append(tuple(part[~thin] for part in cells))
        goes_on = thin[owner]
        thing, cells = thing[owner[goes_on]], [part.compress(touching)[goes_on] for part in finer]
        last = cells[-1] == 0
        kept.append(tuple(part[last] for part in cells))
        thing, *cells = (part[~last] for part in (thing, *cells))
    return grids.entries(grid, *(np.concatenate(part) for part in zip(*kept, strict=True)))


def _finer(grid: Grid, occluder: Ints, column: Ints, row: Ints, level: Ints) -> tuple[Ints, tuple[Ints, ...]]:
    """The four cells below each of some cells, none of them of the finest level, that are in the grid; and which cell
    each is below."""
    owner = np.repeat(np.arange(len(occluder)), 4)
    step = np.tile(np.arange(4), len(occluder))
    finer = (occluder[owner], 2 * column[owner] + (step & 1), 2 * row[owner] + (step >> 1), level[owner] - 1)
    inside = (finer[1] < grid.columns[finer[3]]) & (finer[2] < grid.rows[finer[3]])
    return owner.compress(inside), tuple(part.compress(inside) for part in finer)


def _inside_outline(
    view: View,
    grid: Grid,
    occluders: Occluders,
    cells: tuple[Ints, ...],
    extreme: Callable[[Floats, float], Floats],
    margin: float,
) -> Bools:
    """Which cells, given as (occluder, column, row, level), have an extreme distance above the margin from every
    plane of an occluder's outline: with the minimum those that lie wholly inside it, with the maximum all those that
    touch it and a few near its corners."""
    occluder, column, row, level = cells
    size = grid.cell * (1 << level)
    corner = np.stack([grid.left + column * size, grid.bottom + row * size])
    if view.eye is None:
        base = np.concatenate([corner + view.target[:2, None], np.zeros((1, len(occluder)))])
    else:
        depth = np.full((1, len(occluder)), view.eye[2] - view.focus)
        base = np.concatenate([corner + view.eye[:2, None], depth])
    result = np.ones(len(occluder), dtype=np.bool_)
    last, step = occluders.offsets[1:] - 1, 0
    plane = occluders.offsets[occluder] + occluders.behind[occluder]
    left = np.arange(len(occluder))
    while len(left):
        # Of few cells many planes at once, of many one after the other, each of those that are left.
        width = max(AT_ONCE // len(left), 1)
        which = np.minimum(plane[left] + step + np.arange(width)[:, None], last[occluder[left]])
        a, b, c, d = occluders.planes.take(which, axis=1)
        distance = a * base[0, left] + b * base[1, left] + c * base[2, left] - d
        distance += (extreme(a, 0.0) + extreme(b, 0.0)) * size[left]
        inside = (distance > margin).all(axis=0)
        result[left[~inside]] = False
        step += width
        left = left[inside & (plane[left] + step <= last[occluder[left]])]
    return result


def _inner_cells(grid: Grid, box: Floats32) -> tuple[Ints, Ints, Ints, Ints]:
    """(occluder, column, row, level) of cells wholly inside the boxes (4,n)."""
    box = box.astype(np.float64)
    limits = [
        np.clip((box[0] - grid.left) / grid.cell, 0, grid.columns[0]),
        np.clip((box[1] - grid.left) / grid.cell, 0, grid.columns[0]),
        np.clip((box[2] - grid.bottom) / grid.cell, 0, grid.rows[0]),
        np.clip((box[3] - grid.bottom) / grid.cell, 0, grid.rows[0]),
    ]
    cells = (limits[1] - limits[0]) * (limits[3] - limits[2])
    level = np.ceil(np.log2(np.maximum(cells / MAX_COVER_TESTS, 1.0)) / 2.0).astype(np.intp)
    level = np.minimum(level, grid.levels - 1)
    scale = (1 << level).astype(np.float64)
    c0, c1 = np.ceil(limits[0] / scale).astype(np.intp), np.floor(limits[1] / scale).astype(np.intp)
    r0, r1 = np.ceil(limits[2] / scale).astype(np.intp), np.floor(limits[3] / scale).astype(np.intp)
    c1, r1 = np.minimum(c1, grid.columns[level]), np.minimum(r1, grid.rows[level])
    wide, tall = np.maximum(c1 - c0, 0), np.maximum(r1 - r0, 0)
    count = wide * tall
    occluder = ragged.owner(count)
    step = ragged.place(count)
    width = wide[occluder]
    return occluder, c0[occluder] + step % width, r0[occluder] + step // width, level[occluder]


PAIRS_AT_ONCE = 1 << 17
"""Pairs of a piece and an occluder handled at once."""

INTERVALS_AT_ONCE = 1 << 21
"""So many hidden intervals are found before those that overlap become one: in crowds lines are hidden by many things.
"""

Marked = tuple[Ints, Floats, Floats, Ints]
"""Hidden intervals of segments (n,), from low to high (n,), and their sides (n,), as of Hits."""

MOST_SLABS, IN_SLAB, ONE_SLAB = 24, 4000, 250
"""Occluders are tried front to back in slabs of equal number: hidden lines drop out early, near lines are not tried
against what is far. Each slab costs a little: there are at most so many, for so many occluders and pieces each; and one
for so few of either."""

FEWEST_CELLS, SEGMENTS_IN_CELL = 16.0, 64.0
"""The finest grid has at least so many cells along the longer side of the picture, however large the things in it; or
as many as would give each cell of a square so many segments."""

THIN_FACES, SOME_FACES = 2.0, 1 << 12
"""Cells are no larger than so many times the side of a square as large as the median of so many faces: long thin ones
mostly pass by what is in the box of one."""

SLIVER = 10.0
"""Parts shorter than so many tolerances are none."""

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Visibility:
    """Parts of segments, and by how many items each is hidden.

    segment: (k,) the segment each is a part of, ascending; low, high: (k,) from which parameter of the segment to
    which, 0 to 1; hidden_by: (k,) by how many items each part is hidden, 0 for visible ones.
    """

    segment: Ints
    low: Floats
    high: Floats
    hidden_by: Ints

    def __len__(self) -> int:
        return len(self.segment)


def unhidden(lines: Sized) -> Visibility:
    """Every segment or arc, from end to end, as if nothing hid it."""
    count = len(lines)
    return Visibility(np.arange(count), np.zeros(count), np.ones(count), np.zeros(count, dtype=np.intp))


def with_whole_lines(seen: Visibility, whole: Bools) -> Visibility:
    """What is seen of segments (n,) some of which, whole, nothing hides: the others are those that seen counts."""
    over = np.flatnonzero(whole)
    none = np.zeros(len(over), dtype=np.intp)
    segment = np.concatenate([np.flatnonzero(~whole)[seen.segment], over])
    order = np.argsort(segment, kind="stable")
    low, high = np.concatenate([seen.low, none]), np.concatenate([seen.high, none + 1.0])
    return Visibility(segment[order], low[order], high[order], np.concatenate([seen.hidden_by, none])[order])


def visible_parts(
    view: View, faces: ProjectedFaces, solid: Bools, segments: Segments, progress: Progress
) -> Visibility:
    """The visible parts of straight segments; solid (i,): see solid_items. What lies on an occluder or the border of
    its shadow is visible; a line along a border is hidden where both sides are. Parts below ten tolerances of the
    view are left out. Source: Glaeser, section 7.2.
    """
    gap = _gaps(view, segments)
    if not len(segments):
        return Visibility(*intervals.complement(0, *_nothing(), gap), np.zeros(0, dtype=np.intp))
    grid, pieces = _pieces(view, faces, segments)
    # Of bodies in one place one hides as much as all of them.
    once = first_coincident(view) == np.arange(len(solid))
    alone = replace(view, occludes=view.occludes & once)
    occluders = _occluders(alone, faces, solid & once, grid, grids.deepest(grid, pieces))
    cover = covered_cells(view, grid, occluders)
    covered = pieces.nearest > cover.take(pieces.row * grid.columns[0] + pieces.column)
    hidden_intervals = [
        (
            pieces.segment[covered],
            pieces.low[covered],
            pieces.high[covered],
            np.zeros(int(covered.sum()), dtype=np.intp),
        )
    ]
    pieces = pieces.take(~covered)
    alive = np.ones(len(pieces), dtype=np.bool_)
    fewer = min(len(occluders), len(pieces))
    slabs = min(max(fewer // IN_SLAB, 4), MOST_SLABS) if fewer > ONE_SLAB else 1
    count = 0
    for piece, hits, _ in _all_hits(view, grid, segments, pieces, occluders, alive, slabs, progress):
        of = piece.take(hits.pair)
        hidden_intervals.append((pieces.segment.take(of), hits.low, hits.high, hits.side))
        whole = (hits.side == 0) & (hits.low <= pieces.low.take(of)) & (hits.high >= pieces.high.take(of))
        alive[of.compress(whole)] = False
        count += len(of)
        if count > INTERVALS_AT_ONCE:
            hidden_intervals, count = [_merged(hidden_intervals, gap)], 0
            alive &= ~_hidden_whole(pieces, hidden_intervals[0])
    segment, low, high, side = (np.concatenate(column) for column in zip(*hidden_intervals, strict=True))
    owner, low, high = _resolved(segment, low, high, side, gap)
    long = high - low > gap[owner]
    owner, low, high = intervals.complement(len(segments), owner[long], low[long], high[long], gap)
    return Visibility(owner, low, high, np.zeros(len(owner), dtype=np.intp))


def counted_parts(
    view: View, faces: ProjectedFaces, solid: Bools, segments: Segments, progress: Progress
) -> Visibility:
    """All parts of straight segments, with the number of items that hide each.

    solid: (i,) as in solid_items: the items that hide as convex solids.
    Source: Glaeser, section 7.2.
    """
    gap = _gaps(view, segments)
    if not len(segments):
        return Visibility(*_nothing(), np.zeros(0, dtype=np.intp))
    grid, pieces = _pieces(view, faces, segments)
    occluders = _occluders(view, faces, solid, grid, grids.deepest(grid, pieces))
    alive = np.ones(len(pieces), dtype=np.bool_)
    items = len(view.item_vertices)
    found = [(np.zeros(0, dtype=np.intp), *_nothing()[1:], np.zeros(0, dtype=np.intp))]
    for piece, hits, occluder in _all_hits(view, grid, segments, pieces, occluders, alive, 1, progress):
        key = pieces.segment[piece[hits.pair]] * items + occluders.item[occluder[hits.pair]]
        found.append((key, hits.low, hits.high, hits.side))
    key, low, high, side = (np.concatenate(column) for column in zip(*found, strict=True))
    parts = _by_item(key, low, high, side, items, gap)
    owner, low, high, count = intervals.coverage(*parts)
    long = high - low > gap[owner]
    owner, low, high, count = owner[long], low[long], high[long], count[long]
    hidden, hidden_low, hidden_high = intervals.union(owner, low, high, gap)
    free = intervals.complement(len(segments), hidden, hidden_low, hidden_high, gap)
    owner, low, high = (np.concatenate([a, b]) for a, b in zip((owner, low, high), free, strict=True))
    count = np.concatenate([count, np.zeros(len(free[0]), dtype=np.intp)])
    order = np.lexsort((low, owner))
    return Visibility(owner[order], low[order], high[order], count[order])


def tried_pairs(view: View, faces: ProjectedFaces, solid: Bools, segments: Segments) -> int:
    """How many pairs of a piece of a segment and an occluder in one cell of the image visible_parts may try: what its
    work grows with, found in the time that it takes to sort them into cells.
    """
    if not len(segments):
        return 0
    grid, pieces = _pieces(view, faces, segments)
    occluders = _occluders(view, faces, solid, grid, grids.deepest(grid, pieces))
    if not len(occluders):
        return 0
    entries = entered(view, grid, occluders, np.arange(len(occluders)), grids.held(grid, pieces))
    count = 0
    for level in entries.levels():
        count += int(entries.of(grid.numbers(pieces.column >> level, pieces.row >> level, level))[1].sum())
    return count


def _nothing() -> tuple[Ints, Floats, Floats]:
    return np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0)


def _gaps(view: View, segments: Segments) -> Floats:
    """(n,) the parameter length of what is too short to count."""
    along = segments.end - segments.start
    length = np.sqrt((along * along).sum(axis=0))
    return np.minimum(SLIVER * view.tolerance / np.where(length > 0.0, length, 1.0), 1.0)


def _pieces(view: View, faces: ProjectedFaces, segments: Segments) -> tuple[Grid, Pieces]:
    """The segments cut by a grid that suits them."""
    start, end = view.image_of(segments.start), view.image_of(segments.end)
    near, far = view.depth_of(segments.start), view.depth_of(segments.end)
    low, high = np.minimum(start, end).min(axis=1), np.maximum(start, end).max(axis=1)
    extent = np.float32(max(high - low))
    sizes = np.minimum(np.maximum(faces.box[1] - faces.box[0], faces.box[3] - faces.box[2]), extent)
    fewest = max(FEWEST_CELLS, float(np.sqrt(len(segments) / SEGMENTS_IN_CELL)))
    typical = min(float(np.median(sizes)), float(extent) / fewest) if len(sizes) else float(extent)
    typical = min(typical, THIN_FACES * _mean_side(view)) if len(sizes) else typical
    cell = grids.cell_size(start, end, typical)
    area = float(np.prod(high - low))
    cell = max(cell, np.sqrt(area / (4.0 * (len(segments) + len(sizes)) + 1024.0)))
    grid = Grid.over((low[0], high[0], low[1], high[1]), cell)
    return grid, grids.cut(grid, start, end, near, far, view.eye is not None)


def _mean_side(view: View) -> float:
    """The side of a square as large as the median of the images of some faces."""
    some = np.arange(0, view.face_count, 1 + view.face_count // SOME_FACES)
    position, offsets = ragged.take(view.offsets, some)
    corner, after = view.corners[position], view.corners[view.after(position)]
    (x, y), (u, v) = view.image[:, corner], view.image[:, after]
    return float(np.sqrt(np.median(np.abs(np.add.reduceat(x * v - u * y, offsets[:-1]))) / 2.0))


def _occluders(view: View, faces: ProjectedFaces, solid: Bools, grid: Grid, deepest: Floats32) -> Occluders:
    """Everything that could hide a piece: convex solids as such, of other items the faces that reach a piece's cell."""
    hiding = view.occludes & ~solid
    kept = [np.zeros(0, dtype=np.intp)]

    def reaching(block: slice) -> Ints:
        near = grids.reaching(grid, deepest, faces.box[:, block], faces.nearest[block])
        near &= (faces.facing[block] != 0) & hiding[view.face_item[block]]
        return np.asarray(block.start + np.flatnonzero(near), dtype=np.intp)

    kept.extend(mapped(reaching, slices(view.face_count, CHUNK)))
    by_face = face_occluders(view, faces, np.concatenate(kept))
    if not solid.any():
        return by_face
    return joined([by_face, solid_occluders(view, faces, np.flatnonzero(solid))])


def _all_hits(
    view: View,
    grid: Grid,
    segments: Segments,
    pieces: Pieces,
    occluders: Occluders,
    alive: Bools,
    slabs: int,
    progress: Progress,
) -> Iterator[tuple[Ints, Hits, Ints]]:
    """Hidden intervals of pieces, front to back, with the piece and the occluder of every pair.

    Pieces that the caller marks as no longer alive are not tried again.
    """
    order = np.argsort(occluders.nearest, kind="stable")
    in_image = early_rejection(view, grid, pieces, occluders)
    held = grids.held(grid, pieces)

    def clipped(entries: Entries, some: tuple[Ints, Ints, Ints]) -> tuple[Ints, Hits, Ints]:
        which, begin, counts = some
        piece, occluder = np.repeat(which, counts), entries.thing.take(ragged.ranges(begin, counts))
        passing = in_image.passing(piece, occluder)
        piece, occluder = piece.take(passing), occluder.take(passing)
        close = np.flatnonzero(occluders.nearest.take(occluder) < pieces.farthest.take(piece))
        piece, occluder = piece.take(close), occluder.take(close)
        segment, low, high = pieces.segment.take(piece), pieces.low.take(piece), pieces.high.take(piece)
        beyond = pieces.nearest.take(piece) > occluders.farthest.take(occluder)
        return piece, clip_pairs(view, segments, occluders, segment, occluder, low, high, beyond), occluder

    bounds = np.linspace(0, len(order), slabs + 1).astype(np.intp)
    for begin, end in pairwise(bounds.tolist()):
        if begin == end:
            continue
        slab = order[begin:end]
        entries = entered(view, grid, occluders, slab, held)
        for level in entries.levels():
            which = np.flatnonzero(alive & (pieces.farthest > occluders.nearest[slab[0]]))
            at = grid.numbers(pieces.column.take(which) >> level, pieces.row.take(which) >> level, level)
            # A piece is in one block of a level only: whether it is still alive is the same for all of its pairs.
            yield from mapped(partial(clipped, entries), _blocks(which, *entries.of(at)))
        progress(float(end) / len(order))


def _blocks(which: Ints, begin: Ints, counts: Ints) -> Iterator[tuple[Ints, Ints, Ints]]:
    """Pieces (n,) in blocks of about as many pairs with the entries of their cells, counts of them from begin on."""
    full = np.flatnonzero(counts)
    which, begin, counts = which.take(full), begin.take(full), counts.take(full)
    for low, high in ragged.batches(counts, PAIRS_AT_ONCE):
        yield which[low:high], begin[low:high], counts[low:high]


def _resolved(segment: Ints, low: Floats, high: Floats, side: Ints, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """Disjoint hidden intervals; those of one side count where they meet those of the other."""
    if not side.any():
        return intervals.union(segment, low, high, gap)
    halved = np.zeros(len(gap), dtype=np.bool_)
    halved[segment[side != 0]] = True
    some = halved[segment]
    part = intervals.coverage(segment[some], low[some], high[some], side[some])[:3]
    rest = (segment[~some], low[~some], high[~some])
    owner, low, high = (np.concatenate(pair) for pair in zip(part, rest, strict=True))
    return intervals.union(owner, low, high, gap)


def _merged(found: list[Marked], gap: Floats) -> Marked:
    """Hidden intervals, those of both sides disjoint, before those of one."""
    segment, low, high, side = (np.concatenate(column) for column in zip(*found, strict=True))
    some = np.flatnonzero(side == 0)
    parts = intervals.union(segment.take(some), low.take(some), high.take(some), gap)
    rest = np.flatnonzero(side)
    none = np.zeros(len(parts[0]), dtype=np.intp)
    own = (column.take(rest) for column in (segment, low, high, side))
    segment, low, high, side = (np.concatenate(pair) for pair in zip((*parts, none), own, strict=True))
    return segment, low, high, side


def _hidden_whole(pieces: Pieces, hidden: Marked) -> Bools:
    """(p,) the pieces that one of the intervals of both sides, disjoint and in order, hides from end to end."""
    segment, low, high, side = hidden
    count = int(np.count_nonzero(side == 0))
    if not count:
        return np.zeros(len(pieces), dtype=np.bool_)
    place = np.searchsorted(segment[:count] + low[:count], pieces.segment + pieces.low, side="right") - 1
    at = np.maximum(place, 0)
    within = (low[at] <= pieces.low) & (high[at] >= pieces.high)
    return np.asarray((segment[at] == pieces.segment) & within, dtype=np.bool_)


def _by_item(
    key: Ints, low: Floats, high: Floats, side: Ints, items: int, gap: Floats
) -> tuple[Ints, Floats, Floats, Ints]:
    """OccludedIntervals (segment, low, high, side), disjoint within each key = segment * items + item and side."""
    unique, owner = np.unique(key, return_inverse=True)
    segment = unique // items
    halved = np.zeros(len(unique), dtype=np.bool_)
    halved[owner[side != 0]] = True
    both = ~halved[owner]
    parts = []
    for chosen, mark in ((both, 0), (~both & (side != -1), 1), (~both & (side != 1), -1)):
        of, start, end = intervals.union(owner[chosen], low[chosen], high[chosen], gap[segment])
        parts.append((segment[of], start, end, np.full(len(of), mark)))
    merged = [np.concatenate(column) for column in zip(*parts, strict=True)]
    return merged[0], merged[1], merged[2], merged[3]
