"""Exact hidden lines: straight segments against convex occluders."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.exact import intervals
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import mapped, slices
from vectorplot.scene.coincidence.twins import first_twins
from vectorplot.scene.view import View
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.covered_cells import covered_cells, entered
from vectorplot.visibility.polyhedra.grid import Entries, Floats32, Grid, Pieces
from vectorplot.visibility.polyhedra.occluders import Occluders, face_occluders, joined, solid_occluders
from vectorplot.visibility.polyhedra.pairs import Hits, Segments, clip_pairs
from vectorplot.visibility.polyhedra.sieve import sieve
from vectorplot.visibility.projected_faces import CHUNK, ProjectedFaces

PAIRS_AT_ONCE = 1 << 17
"""Pairs of a piece and an occluder handled at once."""

MOST_SLABS, IN_SLAB, ONE_SLAB = 24, 4000, 250
"""Occluders are tried front to back in slabs of equal number: hidden lines drop out early, near lines are not tried
against what is far. Each slab costs a little: there are at most so many, for so many occluders and pieces each; and one
for so few of either."""

FEWEST_CELLS, SEGMENTS_IN_CELL = 16.0, 64.0
"""The finest grid has at least so many cells along the longer side of the picture, however large the things in it; or
as many as would give each cell of a square so many segments."""

SLIVER = 10.0
"""Parts shorter than so many tolerances are none."""

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Visibility:
    """Parts of segments, and by how many items each is hidden.

    Parameters
    ----------
    segment : (k,) array of int
        The segment each is a part of, ascending.
    low, high : (k,) array of float
        From which parameter of the segment to which, 0 to 1; ascending along each segment.
    hidden_by : (k,) array of int
        By how many items each part is hidden, 0 for visible ones.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> view = scene.look(vp.Scene((vp.Item("wall", geometry.box((1, 2, 2))),)), vp.Camera((9, 1, 1), target=(0, 1, 1)))
    >>> faces = visibility.project_faces(view)
    >>> line = visibility.Segments(*(view.points_of(np.array([(2.0, y, 1.0)])) for y in (0.0, 2.0)))
    >>> parts = visibility.visible_parts(view, faces, visibility.solid_items(view, faces), line, lambda share: None)
    >>> isinstance(parts, visibility.Visibility), len(parts), parts.hidden_by.tolist()  # in front of the wall
    (True, 1, [0])
    """

    segment: Ints
    low: Floats
    high: Floats
    hidden_by: Ints

    def __len__(self) -> int:
        return len(self.segment)


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
    """The visible parts of straight segments.

    Parameters
    ----------
    view : View
        As of scene.look.
    faces : ProjectedFaces
        As of project_faces.
    solid : (i,) array of bool
        As of solid_items: the items that hide as convex solids.
    segments : Segments
        In the view's coordinates.
    progress : callable
        progress(share) is called while it works.

    Returns
    -------
    Visibility
        The visible parts only.

    Notes
    -----
    What lies on an occluder or on the border of its shadow is visible; a line along a border is hidden where both its
    sides are. Parts below ten tolerances of the view are left out.

    Source: Glaeser, section 7.2.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> camera = vp.Camera((9, 1, 1), target=(0, 1, 1), parallel=True)
    >>> view = scene.look(vp.Scene((vp.Item("wall", geometry.box((1, 2, 2))),)), camera)
    >>> faces = visibility.project_faces(view)
    >>> line = visibility.Segments(*(view.points_of(np.array([(-3.0, y, 1.0)])) for y in (-1.0, 3.0)))
    >>> parts = visibility.visible_parts(view, faces, visibility.solid_items(view, faces), line, lambda share: None)
    >>> parts.low.round(9).tolist(), parts.high.round(9).tolist()
    ([0.0, 0.75], [0.25, 1.0])
    """
    gap = _gaps(view, segments)
    if not len(segments):
        return Visibility(*intervals.complement(0, *_nothing(), gap), np.zeros(0, dtype=np.intp))
    grid, pieces = _pieces(view, faces, segments)
    # Of bodies in one place one hides as much as all of them.
    once = first_twins(view) == np.arange(len(solid))
    alone = replace(view, occludes=view.occludes & once)
    occluders = _occluders(alone, faces, solid & once, grid, grids.deepest(grid, pieces))
    cover = covered_cells(view, grid, occluders)
    covered = pieces.nearest > cover.take(pieces.row * grid.columns[0] + pieces.column)
    zones = [
        (
            pieces.segment[covered],
            pieces.low[covered],
            pieces.high[covered],
            np.zeros(int(covered.sum()), dtype=np.intp),
        )
    ]
    pieces = pieces.some(~covered)
    alive = np.ones(len(pieces), dtype=np.bool_)
    fewer = min(len(occluders), len(pieces))
    slabs = min(max(fewer // IN_SLAB, 4), MOST_SLABS) if fewer > ONE_SLAB else 1
    for piece, hits, _ in _all_hits(view, grid, segments, pieces, occluders, alive, slabs, progress):
        of = piece.take(hits.pair)
        zones.append((pieces.segment.take(of), hits.low, hits.high, hits.side))
        whole = (hits.side == 0) & (hits.low <= pieces.low.take(of)) & (hits.high >= pieces.high.take(of))
        alive[of.compress(whole)] = False
    segment, low, high, side = (np.concatenate(column) for column in zip(*zones, strict=True))
    owner, low, high = _resolved(segment, low, high, side, gap)
    long = high - low > gap[owner]
    owner, low, high = intervals.complement(len(segments), owner[long], low[long], high[long], gap)
    return Visibility(owner, low, high, np.zeros(len(owner), dtype=np.intp))


def counted_parts(
    view: View, faces: ProjectedFaces, solid: Bools, segments: Segments, progress: Progress
) -> Visibility:
    """All parts of straight segments, with the number of items that hide each.

    Parameters
    ----------
    view : View
        As of scene.look.
    faces : ProjectedFaces
        As of project_faces.
    solid : (i,) array of bool
        As of solid_items: the items that hide as convex solids.
    segments : Segments
        In the view's coordinates.
    progress : callable
        progress(share) is called while it works.

    Returns
    -------
    Visibility
        An item that hides itself counts once. The visible parts are those of visible_parts.

    Notes
    -----
    Source: Glaeser, section 7.2.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> camera = vp.Camera((9, 1, 1), target=(0, 1, 1), parallel=True)
    >>> view = scene.look(vp.Scene((vp.Item("wall", geometry.box((1, 2, 2))),)), camera)
    >>> faces = visibility.project_faces(view)
    >>> line = visibility.Segments(*(view.points_of(np.array([(-3.0, y, 1.0)])) for y in (-1.0, 3.0)))
    >>> parts = visibility.counted_parts(view, faces, visibility.solid_items(view, faces), line, lambda share: None)
    >>> parts.low.round(9).tolist(), parts.hidden_by.tolist()
    ([0.0, 0.25, 0.75], [0, 1, 0])
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

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> from vectorplot.visibility.polyhedra.hidden_lines import tried_pairs
    >>> view = scene.look(vp.Scene((vp.Item("wall", geometry.box((1, 2, 2))),)), vp.Camera((9, 1, 1), target=(0, 1, 1)))
    >>> faces = visibility.project_faces(view)
    >>> line = visibility.Segments(*(view.points_of(np.array([(-2.0, y, 1.0)])) for y in (0.5, 1.5)))
    >>> tried_pairs(view, faces, visibility.solid_items(view, faces), line) > 0
    True
    """
    if not len(segments):
        return 0
    grid, pieces = _pieces(view, faces, segments)
    occluders = _occluders(view, faces, solid, grid, grids.deepest(grid, pieces))
    if not len(occluders):
        return 0
    entries = entered(view, grid, occluders, np.arange(len(occluders)), len(pieces))
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
    cell = grids.cell_size(start, end, typical)
    area = float(np.prod(high - low))
    cell = max(cell, np.sqrt(area / (4.0 * (len(segments) + len(sizes)) + 1024.0)))
    grid = Grid.over((low[0], high[0], low[1], high[1]), cell)
    return grid, grids.cut(grid, start, end, near, far, view.eye is not None)


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
    return joined(by_face, solid_occluders(view, faces, np.flatnonzero(solid)))


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
    """Hidden zones of pieces, front to back, with the piece and the occluder of every pair.

    Pieces that the caller marks as no longer alive are not tried again.
    """
    order = np.argsort(occluders.nearest, kind="stable")
    in_image = sieve(view, grid, pieces, occluders)

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
        entries = entered(view, grid, occluders, slab, len(pieces))
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
    total = np.cumsum(counts)
    cuts = np.searchsorted(total, np.arange(PAIRS_AT_ONCE, int(total[-1]) if len(total) else 0, PAIRS_AT_ONCE)) + 1
    edges = np.unique(np.concatenate([[0], cuts, [len(counts)]]))
    for low, high in pairwise(edges.tolist()):
        yield which[low:high], begin[low:high], counts[low:high]


def _resolved(segment: Ints, low: Floats, high: Floats, side: Ints, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """Disjoint hidden zones; zones of one side count where they meet zones of the other."""
    if not side.any():
        return intervals.union(segment, low, high, gap)
    halved = np.zeros(len(gap), dtype=np.bool_)
    halved[segment[side != 0]] = True
    some = halved[segment]
    part = intervals.coverage(segment[some], low[some], high[some], side[some])[:3]
    rest = (segment[~some], low[~some], high[~some])
    owner, low, high = (np.concatenate(pair) for pair in zip(part, rest, strict=True))
    return intervals.union(owner, low, high, gap)


def _by_item(
    key: Ints, low: Floats, high: Floats, side: Ints, items: int, gap: Floats
) -> tuple[Ints, Floats, Floats, Ints]:
    """Zones (segment, low, high, side), disjoint within each key = segment * items + item and side."""
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
