"""What smooth surfaces hide of curves and lines: the second engine, as a sentence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget, unheard, unresolved
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.tolerances import GRAZING_ANGLE, LEAST_DIVISOR, LEAST_PART, SAFE_IN_IMAGE, TOUCHING_OF_EXTENT
from vectorplot.visibility.polyhedra.lines import Lines
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.crossings import crossings
from vectorplot.visibility.smooth.curve_families import StraightLines
from vectorplot.visibility.smooth.events import Events, all_events, edge_on_curves, facing_of, own_events
from vectorplot.visibility.smooth.lines_on_several_sheets import Stretches
from vectorplot.visibility.smooth.piercings import piercings
from vectorplot.visibility.smooth.rays import Cells, Samples, Tally, Targets, all_tallies, counts_in_front, targets_of
from vectorplot.visibility.smooth.scene_curves import TracedScene
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import ChordParts, Curves, together
from vectorplot.words import LineKind

# How far from the images of edges sight lines pass.

TOGETHER = 8
"""So many chords that follow each other are searched as one line."""

BEYOND = 4.0
"""A point on a border is as safe as one so many times what is safe away from it, and no safer."""


def clearances(view: View, edges: Curves, points: Floats, tolerance: float) -> Floats:
    """(k,) distances in the image of points (k,3) from the nearest edge, those from borders on which points lie left
    out: what ends in a point is not in front of it on either side. tolerance: how far chords are off their curves.
    """
    if not len(points):
        return np.zeros(0)
    image, chord = sight_lines.image(view, points), edges.chords
    border = edges.kind[edges.owner[chord]] == LineKind.BOUNDARY
    distance = _distances(view, edges, chord[~border], image)
    nearest, from_border = _nearest_chords(view, edges, chord[border], image)
    on = np.flatnonzero(nearest >= 0)
    on = on[_lies_on(view, edges, nearest[on], points[on], tolerance)]
    if len(on):
        reach = BEYOND * SAFE_IN_IMAGE
        which, other = _chords_within(view, edges, chord[border], image[on], reach)
        apart = ~_lies_on(view, edges, other, points[on[which]], tolerance)
        which, other = on[which[apart]], other[apart]
        from_border[on] = reach
        np.minimum.at(from_border, which, _from_chords(view, edges, other, image[which]))
    return np.minimum(distance, from_border)


def clearances_before(view: View, edges: Curves, points: Floats, tolerance: float) -> Floats:
    """(k,) the same of points that are near edges, where those that are farther away than the points do not count: no
    more than a little farther than what is safe. What is seen in front of a point they do not change."""
    if not len(points):
        return np.zeros(0)
    image, clear = sight_lines.image(view, points), np.full(len(points), BEYOND * SAFE_IN_IMAGE)
    which, chord = _chords_within(view, edges, edges.chords, image, BEYOND * SAFE_IN_IMAGE)
    depth = sight_lines.depth(view, edges.points)
    before = np.minimum(depth[chord], depth[chord + 1]) <= sight_lines.depth(view, points)[which] + TOUCHING_OF_EXTENT
    which, chord = which[before], chord[before]
    border = edges.kind[edges.owner[chord]] == LineKind.BOUNDARY
    counts = ~(border & _lies_on(view, edges, chord, points[which], tolerance))
    which, chord = which[counts], chord[counts]
    np.minimum.at(clear, which, _from_chords(view, edges, chord, image[which]))
    return clear


def _distances(view: View, edges: Curves, chord: Ints, image: Floats) -> Floats:
    """(k,) distances of points (k,2) of the image from the nearest of some chords, infinite without any."""
    import shapely

    distance = np.full(len(image), np.inf)
    if len(chord):
        # Chords that follow each other are few geometries, which are made and searched in less time than many.
        follows = np.append(False, np.diff(chord) == 1)
        first = np.flatnonzero(~follows)
        sizes = np.diff(np.append(first, len(chord)))
        first = np.flatnonzero(~follows | (ragged.place(sizes) % TOGETHER == 0))
        sizes = np.diff(np.append(first, len(chord)))
        points = sight_lines.image(view, edges.points[ragged.ranges(chord[first], sizes + 1)])
        lines = shapely.linestrings(points, indices=ragged.owner(sizes + 1))
        (which, _), found = shapely.STRtree(lines).query_nearest(
            shapely.points(image), return_distance=True, all_matches=False
        )
        distance[which] = found
    return distance


def _nearest_chords(view: View, edges: Curves, chord: Ints, image: Floats) -> tuple[Ints, Floats]:
    """Of some chords the nearest to each point (k,2) of the image, and its distance; -1 and infinity without any."""
    import shapely

    number, distance = np.full(len(image), -1), np.full(len(image), np.inf)
    if len(chord):
        tree = shapely.STRtree(_lines(view, edges, chord))
        (which, nearest), found = tree.query_nearest(shapely.points(image), return_distance=True, all_matches=False)
        number[which], distance[which] = chord[nearest], found
    return number, distance


def _chords_within(view: View, edges: Curves, chord: Ints, image: Floats, reach: float) -> tuple[Ints, Ints]:
    """The pairs of a point (k,2) of the image and one of some chords that come within reach of each other."""
    import shapely

    tree = shapely.STRtree(_lines(view, edges, chord))
    which, near = tree.query(shapely.points(image), predicate="dwithin", distance=reach)
    return which, chord[near]


def _from_chords(view: View, edges: Curves, chord: Ints, image: Floats) -> Floats:
    """(k,) distances of points (k,2) of the image from a chord each."""
    start, end = (sight_lines.image(view, edges.points[at]) for at in (chord, chord + 1))
    way = end - start
    part = np.clip(dot(image - start, way) / np.maximum(dot(way, way), LEAST_DIVISOR), 0.0, 1.0)
    return norm(start + part[:, None] * way - image)


def _lines(view: View, edges: Curves, chord: Ints) -> NDArray[np.object_]:
    """(k,) chords in the image."""
    import shapely

    ends = sight_lines.image(view, edges.points)
    return np.asarray(shapely.linestrings(np.stack([ends[chord], ends[chord + 1]], axis=1)))


def _lies_on(view: View, edges: Curves, chord: Ints, points: Floats, tolerance: float) -> Bools:
    """(k,) whether points (k,3) on chords lie on chords of edges, in space."""
    start, way = edges.points[chord], edges.points[chord + 1] - edges.points[chord]
    arm = points - start
    part = np.clip(dot(arm, way) / np.maximum(dot(way, way), LEAST_DIVISOR), 0.0, 1.0)
    away = arm - part[:, None] * way
    size = 1.0 if view.eye is None else sight_lines.depth(view, points) / view.focus
    return np.asarray(np.sqrt(dot(away, away)) <= tolerance * size)


# Curves cut at their events, and by how many sheets of each item every piece is hidden.

CANDIDATES = (0.5, 0.3, 0.7, 0.12, 0.88)
"""Parts of a piece at which its safest point is looked for."""

ENOUGH = 2.0
"""So many times as far from edges as is safe, a point is as good as one farther away."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Parts of curves between events.

    curve (p,); begin_chord, begin_part, end_chord, end_part (p,): from where to where; change: by how much the number
    of sheets of items in front rises at the beginning of pieces. Along each curve in order.
    """

    curve: Ints
    begin_chord: Ints
    begin_part: Floats
    end_chord: Ints
    end_part: Floats
    change: Tally

    def __len__(self) -> int:
        return len(self.curve)

    def take(self, which: Ints) -> Pieces:
        """Some of the pieces."""
        begin, end = (self.begin_chord[which], self.begin_part[which]), (self.end_chord[which], self.end_part[which])
        return Pieces(self.curve[which], *begin, *end, self.change.of_rows(which))


def cut(curves: Curves, events: Events) -> Pieces:
    """The pieces between events; several events at one place are one."""
    owner = curves.owner[events.chord]
    order = np.lexsort((events.part, events.chord))
    chord, part = events.chord[order], events.part[order]
    place = chord + part
    new = np.ones(len(order), dtype=np.bool_)
    new[1:] = (place[1:] != place[:-1]) | (owner[order][1:] != owner[order][:-1])
    group = np.cumsum(new) - 1
    change = Tally(len(curves) + group, events.item[order], events.change[order])
    chord, part, curve = chord[new], part[new], owner[order][new]
    # Each curve begins with a piece at its first point; the other pieces begin at events.
    all_curves = np.arange(len(curves))
    curve = np.concatenate([all_curves, curve])
    chord = np.concatenate([curves.offsets[:-1], chord])
    part = np.concatenate([np.zeros(len(curves)), part])
    # The first piece of a curve stays first even if an event lies at its very beginning.
    first = np.arange(len(curve)) < len(curves)
    order = np.lexsort((chord + part, ~first, curve))
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    curve, chord, part, change = curve[order], chord[order], part[order], change.in_rows(number)
    last = np.append(curve[1:] != curve[:-1], True)
    end_chord = np.where(last, curves.offsets[curve + 1] - 2, np.append(chord[1:], 0))
    end_part = np.where(last, 1.0, np.append(part[1:], 0.0))
    return Pieces(curve, chord, part, end_chord, end_part, change)


@dataclass(frozen=True, eq=False)
class Counts:
    """Sight lines of pieces: in_front, the number of sheets of items that they meet; safe (p,), whether they pass all
    edges at a distance; taken (p,), whether a piece has one, as one at least of every curve; unlooked: the items for
    which the budget did not do."""

    in_front: Tally
    safe: Bools
    taken: Bools
    unlooked: tuple[int, ...] = ()


def counted(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    stretches: Stretches,
    edges: Curves,
    edge_on: Bools,
    pieces: Pieces,
    shortest: float,
    pairs: int,
) -> Counts:
    """The sight line of the safest point of every piece that is not shorter than the shortest that can be seen: where a
    surface winds into a point there may be any number of others, each behind all of its turns.

    edges: folds and borders, near whose images sight lines are not trusted; edge_on (m,): curves that are contours;
    pairs: what the budget has for all sight lines together.
    """
    long = _seen(view, curves, pieces, shortest)
    samples, clearance = _safest(view, sheets, curves, stretches, edges, edge_on, pieces.take(long), shortest)
    found, unlooked = counts_in_front(view, sheets, targets, samples, pairs)
    safe, taken = np.zeros(len(pieces), dtype=np.bool_), np.zeros(len(pieces), dtype=np.bool_)
    safe[long], taken[long] = clearance > SAFE_IN_IMAGE, True
    safe[long[unlooked.row]] = False
    return Counts(found.in_rows(long), safe, taken, tuple(np.unique(unlooked.item).tolist()))


def lengths_in_image(view: View, curves: Curves, pieces: Pieces) -> Floats:
    """(p,) lengths of pieces in the image, along chords."""
    image = sight_lines.image(view, curves.points)
    step = np.zeros(len(image))
    step[1:] = np.linalg.norm(np.diff(image, axis=0), axis=1)
    reach = np.append(np.cumsum(step), 0.0)

    def along(chord: Ints, part: Floats) -> Floats:
        return np.asarray(reach[chord] + part * (reach[chord + 1] - reach[chord]))

    return along(pieces.end_chord, pieces.end_part) - along(pieces.begin_chord, pieces.begin_part)


def _seen(view: View, curves: Curves, pieces: Pieces, shortest: float) -> Ints:
    """The pieces that are not shorter than the shortest in the image, and the longest one of every curve."""
    length = lengths_in_image(view, curves, pieces)
    if not len(pieces):
        return np.zeros(0, dtype=np.intp)
    first = np.flatnonzero(np.diff(pieces.curve, prepend=-1))
    longest = np.maximum.reduceat(np.nan_to_num(length), first)[np.searchsorted(pieces.curve[first], pieces.curve)]
    return np.flatnonzero(~(length < np.minimum(shortest, longest)))


def recounted(pieces: Pieces, counts: Counts, again: Pieces, count: Callable[[Pieces], Counts]) -> Counts:
    """The sight lines of pieces that are cut again: of those that were there before what is known of them, of the
    others what count finds."""
    places = [[p.curve, p.begin_chord, p.begin_part, p.end_chord, p.end_part] for p in (pieces, again)]
    rows = [np.concatenate(pair) for pair in zip(*places, strict=True)]
    order = np.lexsort(rows)
    new_one = np.logical_or.reduce([np.diff(row[order], prepend=np.nan) != 0.0 for row in rows])
    number = np.empty_like(order)
    number[order] = np.cumsum(new_one) - 1
    known = np.full(len(number), -1)
    known[number[: len(pieces)]] = np.arange(len(pieces))
    source = known[number[len(pieces) :]]
    new = np.flatnonzero(source < 0)
    found, old = count(again.take(new)), np.flatnonzero(source >= 0)
    in_front = all_tallies([counts.in_front.of_rows(source[old]).in_rows(old), found.in_front.in_rows(new)])
    safe, taken = counts.safe[source], counts.taken[source]
    safe[new], taken[new] = found.safe, found.taken
    return Counts(in_front, safe, taken, tuple(sorted({*counts.unlooked, *found.unlooked})))


def carried(pieces: Pieces, counts: Counts) -> Tally:
    """The number of sheets of items in front of every piece, where there are some: what its sight line says; if that is
    not safe, what the nearest safe one on its curve says, and the changes between. Where no sight line of a curve is
    safe each stands for its own piece, and the nearest one for a piece that has none."""
    source = _nearest(pieces, counts.safe)
    source = np.where(source < 0, _nearest(pieces, counts.taken), source)
    cells = Cells.of(pieces.curve, [pieces.change, counts.in_front])
    total, in_front = np.cumsum(cells.values(pieces.change)), cells.values(counts.in_front)
    there = np.arange(len(total)) + source[cells.piece] - cells.piece
    value = in_front[there] + total - total[there]
    some = np.flatnonzero(value > 0)
    return Tally(cells.piece[some], cells.item[some], value[some])


def believed(pieces: Pieces, counts: Counts) -> Counts:
    """The same, all sight lines between two that are safe and do not agree taken for safe: changes there were told
    wrongly, as where a curve passes so near to a cusp that its other branch is no more behind it than rounding, and one
    sight line close to an edge misleads only about its own piece."""
    safe = counts.safe.copy()
    safe[suspects(pieces, counts)] = True
    return counts if counts.unlooked else replace(counts, safe=safe & counts.taken)


def suspects(pieces: Pieces, counts: Counts) -> Ints:
    """The pieces between two safe sight lines that do not agree, with those of the sight lines themselves."""
    before, after = _disagreeing(pieces, counts)
    mark = np.zeros(len(pieces) + 1, dtype=np.intp)
    np.add.at(mark, before, 1)
    np.add.at(mark, after + 1, -1)
    return np.flatnonzero(np.cumsum(mark)[:-1] > 0)


def _disagreeing(pieces: Pieces, counts: Counts) -> tuple[Ints, Ints]:
    """The pieces (w,) with safe sight lines of which the next one (w,) on their curve does not follow by the changes
    between."""
    safe = np.flatnonzero(counts.safe)
    after = np.full(len(pieces), -1)
    on = pieces.curve[safe[:-1]] == pieces.curve[safe[1:]]
    after[safe[:-1][on]] = safe[1:][on]
    cells = Cells.of(pieces.curve, [pieces.change, counts.in_front])
    level = cells.values(counts.in_front) - np.cumsum(cells.values(pieces.change))
    first = np.flatnonzero(after[cells.piece] >= 0)
    before = cells.piece[first]
    wrong = np.unique(before[level[first] != level[first + after[before] - before]])
    return wrong, after[wrong]


def _nearest(pieces: Pieces, known: Bools) -> Ints:
    """(p,) of the pieces of its curve that are known the nearest to every piece; -1 where there is none."""
    number, curve = np.arange(len(pieces)), pieces.curve
    before = np.maximum.accumulate(np.where(known, number, -1))
    after = np.minimum.accumulate(np.where(known, number, len(pieces))[::-1])[::-1]
    has_before = (before >= 0) & (curve[np.maximum(before, 0)] == curve)
    has_after = (after < len(pieces)) & (curve[np.minimum(after, len(pieces) - 1)] == curve)
    nearer = has_before & (~has_after | (number - before <= after - number))
    return np.asarray(np.where(nearer, before, np.where(has_after, after, -1)))


def _safest(
    view: View,
    sheets: Sheets,
    curves: Curves,
    stretches: Stretches,
    edges: Curves,
    edge_on: Bools,
    pieces: Pieces,
    tolerance: float,
) -> tuple[Samples, Floats]:
    """The point of each piece whose image is farthest from those of edges, and how far that is; none where the sight
    line grazes a sheet of the point's own, which near by may bend either way."""
    begin, end = pieces.begin_chord + pieces.begin_part, pieces.end_chord + pieces.end_part
    at = begin + np.array(CANDIDATES)[:, None] * (end - begin)
    clear, all_pieces = np.full(at.shape, -np.inf), np.arange(len(pieces))

    def look(which: Ints) -> None:
        some = pieces.take(which)
        clear[1:, which] = _clear(view, curves, edges, edge_on, some, at[1:, which], tolerance)

    def best(which: Ints) -> Samples:
        place = at[np.argmax(clear[:, which], axis=0), which]
        chord = _chords_at(pieces.take(which), place)
        return samples_at(curves, stretches, edge_on, chord, place - chord)

    clear[0] = _clear(view, curves, edges, edge_on, pieces, at[:1], tolerance)[0]
    # The others are looked at only where the first one is not good enough.
    look(np.flatnonzero(edge_on[pieces.curve] | ~(clear[0] > ENOUGH * SAFE_IN_IMAGE)))
    samples = best(all_pieces)
    grazing = np.flatnonzero(_graze(view, sheets, samples))
    if not len(grazing):
        return samples, clear.max(axis=0)
    look(grazing[np.isneginf(clear[1, grazing])])
    for _ in CANDIDATES:
        clear[np.argmax(clear[:, grazing], axis=0), grazing] = 0.0
        grazing = grazing[_graze(view, sheets, best(grazing))]
    return best(all_pieces), clear.max(axis=0)


def _graze(view: View, sheets: Sheets, samples: Samples) -> Bools:
    """(k,) whether the sight lines of samples graze a sheet on which they lie, but for those of contours."""
    found, way = np.zeros(len(samples), dtype=np.bool_), sight_lines.sight(view, samples.points)
    for number, places, contour in samples.own:
        on = np.flatnonzero((number >= 0) & ~contour)
        cosine = dot(sheets.normals(number[on], places[on]), way[on])
        found[on] |= np.abs(cosine) <= GRAZING_ANGLE * norm(way[on])
    return found


def _clear(
    view: View, curves: Curves, edges: Curves, edge_on: Bools, pieces: Pieces, at: Floats, tolerance: float
) -> Floats:
    """(c,k) how far the images of places (c,k) of pieces (k,) are from those of edges."""
    chord = _chords_at(pieces, at)
    points = _on_chords(curves, chord.ravel(), (at - chord).ravel())
    image = sight_lines.image(view, points)
    contour = np.tile(edge_on[pieces.curve], len(at))
    clear = np.full(at.size, np.inf)
    clear[~contour] = clearances(view, edges, points[~contour], tolerance)
    near = np.flatnonzero(~contour & (clear <= SAFE_IN_IMAGE))
    clear[near] = clearances_before(view, edges, points[near], tolerance)
    # A contour is an edge itself: what counts is the way to the ends of the piece.
    ends = [sight_lines.image(view, _on_chords(curves, c, p)) for c, p in _ends(pieces)]
    away = [np.linalg.norm(image - np.tile(e, (len(at), 1)), axis=1) for e in ends]
    clear[contour] = np.minimum(*away)[contour]
    return clear.reshape(at.shape)


def _chords_at(pieces: Pieces, at: Floats) -> Ints:
    """(..., k) the chords that places (..., k) of pieces (k,) lie on."""
    return np.asarray(np.minimum(at.astype(np.intp), pieces.end_chord))


def samples_at(curves: Curves, stretches: Stretches, edge_on: Bools, chord: Ints, part: Floats) -> Samples:
    """Points of curves, to look from; stretches: of the curves, on further sheets."""
    found, curve = curves.at(chord, part), curves.owner[chord]
    second = curves.second_sheet[curve]
    row, own = stretches.of_chords(chord)
    sizes = np.bincount(row, minlength=len(chord))
    column = 1 + ragged.place(sizes)
    others = np.full((len(chord), 1 + int(sizes.max(initial=0))), -1)
    places = np.full((*others.shape, 3), np.nan)
    others[:, 0], places[:, 0] = second, found.second_places
    others[row, column] = stretches.curves.second_sheet[stretches.curves.owner[own]]
    places[row, column] = stretches.curves.at(own, part[row]).second_places
    cuspidal = (curves.kind[curve] == LineKind.CREASE) & (second < 0)
    return Samples(found.points, curves.sheet[curve], found.places, others, places, edge_on[curve], cuspidal)


def _ends(pieces: Pieces) -> list[tuple[Ints, Floats]]:
    return [(pieces.begin_chord, pieces.begin_part), (pieces.end_chord, pieces.end_part)]


def _on_chords(curves: Curves, chord: Ints, part: Floats) -> Floats:
    return np.asarray(curves.points[chord] + part[:, None] * (curves.points[chord + 1] - curves.points[chord]))


# Runs of equally hidden pieces; those too short to be drawn go to their neighbours.


def without_short_runs(view: View, curves: Curves, pieces: Pieces, hidden_by: Ints, shortest: float) -> Ints:
    """(p,) the same numbers; runs shorter than this in the image have that of the nearest longer one on their curve.

    Edge cases: a curve that has only short runs stays as it is.
    """
    if not len(pieces):
        return hidden_by
    new = np.ones(len(pieces), dtype=np.bool_)
    new[1:] = (pieces.curve[1:] != pieces.curve[:-1]) | (hidden_by[1:] != hidden_by[:-1])
    run = np.cumsum(new) - 1
    curve, value = pieces.curve[new], hidden_by[new]
    length = np.bincount(run, weights=lengths_in_image(view, curves, pieces))
    first, last = np.searchsorted(curve, curve), np.searchsorted(curve, curve, side="right") - 1
    # The first and the last run of a closed curve are one if they are equal.
    number = np.arange(len(curve))
    round_ = curves.closed[curve] & (value[first] == value[last]) & (first != last)
    around = length[first] + length[last]
    length = np.where(round_ & ((number == first) | (number == last)), around, length)
    long = length >= shortest
    before = np.maximum.accumulate(np.where(long, number, -1))
    after = np.minimum.accumulate(np.where(long, number, len(curve))[::-1])[::-1]
    has_before = (before >= first) & (before >= 0)
    has_after = after <= last
    nearer = has_before & (~has_after | (number - before <= after - number))
    source = np.where(nearer, before, np.where(has_after, after, number))
    return np.asarray(value[source][run])


# Events that were not found: sight lines on both sides of a place disagree, and those between tell where.

LOOKS = 16
"""Parts of a suspicious piece at whose ends sight lines are taken."""

ROUNDS, PARTS = 10, 16
"""How often, and into how many parts, what is left is cut: as fine as by forty halvings, in a quarter of the calls."""

SHARE = 8
"""The first sight lines and those that follow get one in so many of the budget's pairs each: missed events are few."""


def missed_events(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    stretches: Stretches,
    edge_on: Bools,
    pieces: Pieces,
    counts: Counts,
    pairs: int,
) -> tuple[Events, tuple[int, ...]]:
    """Events inside pieces whose count does not follow from that of a neighbour by the changes between; and the items
    for which the budget's pairs, a share for the first sight lines and one for those that follow, did not do.

    Where a change alone was told wrongly nothing is found, and the sight lines of the pieces stand.
    """

    def count(at: Floats, last: Ints, pairs: int) -> tuple[Tally, Tally]:
        chord = np.minimum(at.astype(np.intp), last)
        samples = samples_at(curves, stretches, edge_on, chord, at - chord)
        return counts_in_front(view, sheets, targets, samples, max(1, pairs))

    suspicious = suspects(pieces, counts)
    begin = (pieces.begin_chord + pieces.begin_part)[suspicious]
    end = (pieces.end_chord + pieces.end_part)[suspicious]
    # Neither end is looked at: there the count changes.
    shares = (np.arange(LOOKS) + 0.5) / LOOKS
    at = begin[:, None] + shares * (end - begin)[:, None]
    tally, unlooked = count(at.ravel(), np.repeat(pieces.end_chord[suspicious], LOOKS), pairs // SHARE)
    short = {*unlooked.item.tolist()}
    columns = _Columns.of(tally, LOOKS)
    found = columns.table(tally, np.arange(len(suspicious)), LOOKS)
    seen = _are_seen(unlooked, len(suspicious), LOOKS)
    piece, look = np.nonzero((found[:, 1:] != found[:, :-1]).any(axis=2) & seen[:, 1:] & seen[:, :-1])
    low, high = at[piece, look], at[piece, look + 1]
    below, above = found[piece, look], found[piece, look + 1]
    last = pieces.end_chord[suspicious][piece]
    row = np.arange(len(piece))
    inner, change = np.arange(1, PARTS) / PARTS, above - below
    # From here on nothing else is looked at than what changes.
    which, column = np.nonzero(change)
    item = columns.items_of(piece[which], column)
    targets = targets.take(np.isin(sheets.item[targets.sheet], np.unique(item)))
    for _ in range(ROUNDS):
        if not len(row):
            break
        between = low[row, None] + inner * (high - low)[row, None]
        tally, unlooked = count(between.ravel(), np.repeat(last[row], PARTS - 1), pairs // SHARE // ROUNDS)
        short |= {*unlooked.item.tolist()}
        # What the budget does not do for stays where it is.
        on = np.flatnonzero(_are_seen(unlooked, len(row), PARTS - 1).all(axis=1))
        alike = columns.table(tally, piece[row], PARTS - 1) == below[row, None]
        same = (alike | (change[row, None] == 0)).all(axis=2)[on]
        row, between = row[on], between[on]
        first = np.where(same.all(axis=1), PARTS - 1, np.argmin(same, axis=1))
        ends = np.concatenate([low[row, None], between, high[row, None]], axis=1)
        low[row], high[row] = ends[np.arange(len(row)), first], ends[np.arange(len(row)), first + 1]
    chord = np.minimum(low.astype(np.intp), last)
    events = Events(chord[which], (low - chord)[which], item, change[which, column])
    return events, tuple(sorted(short))


@dataclass(frozen=True, eq=False)
class _Columns:
    """The items that suspicious pieces have in front of them, each piece its own: suspects and items (c,) in ascending
    order, as one number; items: how many there are; first (s+1,): the first one of each suspect."""

    key: Ints
    items: int
    first: Ints

    @classmethod
    def of(cls, tally: Tally, looks: int) -> _Columns:
        """Those that a tally of so many sight lines of each suspect tells of."""
        items = int(tally.item.max(initial=0)) + 1
        key = np.unique(tally.row // looks * items + tally.item)
        last = int(key[-1]) // items if len(key) else -1
        return cls(key, items, np.searchsorted(key, np.arange(last + 2) * items))

    def table(self, tally: Tally, suspects: Ints, looks: int) -> Ints:
        """(k, looks, columns) the numbers by columns; tally: of so many sight lines of each of some suspects (k,)."""
        row, look = np.divmod(tally.row, looks)
        known = np.flatnonzero(tally.item < self.items)
        key = suspects[row[known]] * self.items + tally.item[known]
        at = np.searchsorted(self.key, key)
        there = np.flatnonzero(at < len(self.key))
        there = there[self.key[at[there]] == key[there]]
        known, at = known[there], at[there]
        result = np.zeros((len(suspects), looks, int(np.diff(self.first).max(initial=0))), dtype=np.intp)
        column = at - self.first[suspects[row[known]]]
        np.add.at(result, (row[known], look[known], column), tally.value[known])
        return result

    def items_of(self, suspects: Ints, columns: Ints) -> Ints:
        """(k,) the items of columns (k,) of suspects (k,)."""
        return np.asarray(self.key[self.first[suspects] + columns] % self.items)


def _are_seen(unlooked: Tally, rows: int, looks: int) -> Bools:
    """(rows, looks) the sight lines for which the budget did for all items."""
    result = np.ones(rows * looks, dtype=np.bool_)
    result[unlooked.row] = False
    return result.reshape(rows, looks)


@dataclass(frozen=True, eq=False)
class HiddenCurves:
    """Pieces of curves, and the number (p,) of items with smooth surfaces that hide each; short: items for which the
    budget did not do."""

    pieces: Pieces
    hidden_by: Ints
    short: tuple[int, ...]


def hidden_curves(
    view: View,
    traced: TracedScene,
    curves: Curves,
    tolerance: float,
    budget: Budget,
    done: Callable[[float], None],
) -> HiddenCurves:
    """By how many items with smooth surfaces each piece of the curves is hidden.

    traced: the sheets, and the edges of those that hide; tolerance: how far chords are off their curves, in the image;
    done: is told the part of the work that is done.
    The number of sheets in front of a curve changes only where its image crosses that of a fold or border in front, at
    a cusp of a contour, and where it pierces a sheet or passes the contour of its own: there the curves are cut. Then
    each piece is decided once, by the sight line of its safest point, or by the changes from a neighbour. Runs shorter
    than two tolerances are none.
    Source: Glaeser, section 8.4 and figure 13 for what is drawn; the decisions are this package's own.
    """
    # Only items with sheets that hide are counted: a scene may have thousands of others.
    hiding = np.unique(traced.sheets.item[traced.sheets.hides])
    sheets = replace(traced.sheets, counted_as=np.searchsorted(hiding, traced.sheets.item))
    edges = replace(traced.edges, item=np.searchsorted(hiding, traced.edges.item))
    targets = targets_of(view, sheets)
    facing = facing_of(view, sheets, curves)
    edge_on = edge_on_curves(curves, facing)
    own = own_events(view, sheets, curves, traced.stretches, facing, edge_on)
    done(0.2)
    crossed, short_of_crossings = crossings(view, sheets, curves, edges, edge_on, tolerance, budget.pairs)
    done(0.4)
    pierced, short_of_piercings = piercings(
        view, sheets, targets, curves, traced.stretches, traced.meets_itself, budget.pairs
    )
    done(0.6)
    events = all_events([own, crossed, pierced])
    pieces = cut(curves, events)

    once = _once(edges)

    def count(pieces: Pieces) -> Counts:
        return counted(view, sheets, targets, curves, traced.stretches, once, edge_on, pieces, tolerance, budget.pairs)

    counts = count(pieces)
    done(0.8)
    more, short_of_halvings = missed_events(
        view, sheets, targets, curves, traced.stretches, edge_on, pieces, counts, budget.pairs
    )
    if len(more):
        again = cut(curves, all_events([events, more]))
        pieces, counts = again, recounted(pieces, counts, again, count)
    unlooked = [*short_of_piercings, *short_of_halvings, *counts.unlooked]
    short = {*short_of_crossings, *hiding[unlooked].tolist()} if unlooked else {*short_of_crossings}
    hidden_by = np.bincount(carried(pieces, believed(pieces, counts)).row, minlength=len(pieces))
    hidden_by = without_short_runs(view, curves, pieces, hidden_by, 2.0 * tolerance)
    return HiddenCurves(pieces, hidden_by, tuple(sorted(short)))


def _once(edges: Curves) -> Curves:
    """The edges without those that are others again, as the borders of two faces at one edge are."""
    if not len(edges):
        return edges
    begin, end = edges.offsets[:-1], edges.offsets[1:] - 1
    ends = [edges.points[at] for at in (begin, begin + 1, end)]
    _, first = np.unique(np.column_stack([*ends, edges.kind, end - begin]), axis=0, return_index=True)
    return edges.take(np.sort(first))


def cut_curves(sheets: Sheets, curves: Curves, found: HiddenCurves) -> tuple[Floats, Floats, ChordParts, Ints]:
    """The chords of all pieces on sheets, cut at events: start and end (c,3), which parts of chords, hidden_by (c,)."""
    pieces = found.pieces
    count = pieces.end_chord - pieces.begin_chord + 1
    first = ragged.starts(count)
    owner = ragged.owner(count)
    step = np.arange(len(owner)) - first[owner]
    chord = pieces.begin_chord[owner] + step
    start, end = curves.points[chord].copy(), curves.points[chord + 1].copy()
    begin_part, end_part = np.zeros(len(chord)), np.ones(len(chord))
    begin_part[first], end_part[first + count - 1] = pieces.begin_part, pieces.end_part
    inner = np.flatnonzero(pieces.begin_part > 0.0)
    start[first[inner]] = curves.at(pieces.begin_chord[inner], pieces.begin_part[inner]).points
    inner = np.flatnonzero(pieces.end_part < 1.0)
    end[(first + count - 1)[inner]] = curves.at(pieces.end_chord[inner], pieces.end_part[inner]).points
    return start, end, ChordParts(sheets, curves, chord, begin_part, end_part), found.hidden_by[owner]


# Curves of smooth surfaces as lines for the engine of polyhedra, and its lines cut by smooth surfaces.


def cut_lines_and_chords(
    view: View,
    traced: TracedScene,
    lines: Lines,
    tolerance: float,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> tuple[Lines, tuple[tuple[int, str], ...]]:
    """Straight lines and the chords of curves, all cut where smooth surfaces begin or end to hide them; and items with
    a doubt about each that could not be decided.

    tolerance: how far chords are off their curves, in the image; budget: of the work; done: is told the part of it that
    is done.
    """
    curves = together([traced.curves, _straight(lines)])
    found = hidden_curves(view, traced, curves, tolerance, budget, done)
    doubts = tuple((item, unresolved("lines in front of or behind it may be drawn wrong")) for item in found.short)
    return _as_lines(traced, lines, curves, found), doubts


def whole_lines_and_chords(traced: TracedScene, lines: Lines) -> Lines:
    """Straight lines and the chords of curves, from end to end, as if nothing hid them."""
    curves = together([traced.curves, _straight(lines)])
    pieces = cut(curves, all_events([]))
    whole = HiddenCurves(pieces, np.zeros(len(pieces), dtype=np.intp), ())
    return _as_lines(traced, lines, curves, whole)


def _as_lines(traced: TracedScene, lines: Lines, curves: Curves, found: HiddenCurves) -> Lines:
    """The chords of pieces of curves: those of the scene, and after them the straight lines."""
    start, end, chords, behind = cut_curves(traced.sheets, curves, found)
    long = (start != end).any(axis=1) & (chords.end - chords.begin > LEAST_PART)
    start, end, chords, behind = start[long], end[long], chords.take(long), behind[long]
    chord, curve = chords.chord, curves.owner[chords.chord]
    smooth = curve < len(traced.curves)
    side = np.zeros(len(chord), dtype=np.intp)
    side[~smooth] = lines.side[curve[~smooth] - len(traced.curves)]
    aside = np.zeros((3, len(chord)))
    aside[:, ~smooth] = lines.aside[:, curve[~smooth] - len(traced.curves)]
    side[smooth] = curves.side[curve[smooth]]
    behind = behind + curves.behind[curve]
    chords = replace(chords, chord=np.where(smooth, chord, -1))
    kind, item, lamp = curves.kind[curve], curves.item[curve], curves.lamp[curve]
    return Lines(start.T, end.T, kind, item, side, smooth, behind, aside, chords, lamp)


def _straight(lines: Lines) -> Curves:
    """Lines as curves of two points."""
    count = len(lines)
    points = np.stack([lines.start.T, lines.end.T], axis=1).reshape(-1, 3)
    none = np.full_like(points, np.nan)
    return Curves(
        points,
        points,
        none,
        np.arange(0, 2 * count + 1, 2),
        np.zeros(count, dtype=np.bool_),
        lines.kind,
        lines.item,
        np.zeros(count, dtype=np.intp),
        np.zeros(count),
        (StraightLines(),),
        lamp=lines.lamp,
    )
