"""Curves cut at their events, and by how many sheets of each item every piece is hidden."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import GRAZING_ANGLE
from vectorplot.tolerances.of_extent import SAFE_IN_IMAGE
from vectorplot.visibility.smooth.clearances import clearances
from vectorplot.visibility.smooth.events.events import Events
from vectorplot.visibility.smooth.rays import Samples, counts_in_front
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tallies import Cells, Tally, all_tallies
from vectorplot.visibility.smooth.targets import Targets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.words import LineKind

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

    def some(self, which: Ints) -> Pieces:
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
    samples, clearance = _safest(view, sheets, curves, edges, edge_on, pieces.some(long), shortest)
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
    found, old = count(again.some(new)), np.flatnonzero(source >= 0)
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
    view: View, sheets: Sheets, curves: Curves, edges: Curves, edge_on: Bools, pieces: Pieces, tolerance: float
) -> tuple[Samples, Floats]:
    """The point of each piece whose image is farthest from those of edges, and how far that is; none where the sight
    line grazes a sheet of the point's own, which near by may bend either way."""
    begin, end = pieces.begin_chord + pieces.begin_part, pieces.end_chord + pieces.end_part
    at = begin + np.array(CANDIDATES)[:, None] * (end - begin)
    clear, all_pieces = np.full(at.shape, -np.inf), np.arange(len(pieces))

    def look(which: Ints) -> None:
        some = pieces.some(which)
        clear[1:, which] = _clear(view, curves, edges, edge_on, some, at[1:, which], tolerance)

    def best(which: Ints) -> Samples:
        place = at[np.argmax(clear[:, which], axis=0), which]
        chord = _chords_at(pieces.some(which), place)
        return samples_at(curves, edge_on, chord, place - chord)

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
    clear = np.empty(at.size)
    clear[~contour] = clearances(view, edges, points[~contour], tolerance)
    # A contour is an edge itself: what counts is the way to the ends of the piece.
    ends = [sight_lines.image(view, _on_chords(curves, c, p)) for c, p in _ends(pieces)]
    away = [np.linalg.norm(image - np.tile(e, (len(at), 1)), axis=1) for e in ends]
    clear[contour] = np.minimum(*away)[contour]
    return clear.reshape(at.shape)


def _chords_at(pieces: Pieces, at: Floats) -> Ints:
    """(..., k) the chords that places (..., k) of pieces (k,) lie on."""
    return np.asarray(np.minimum(at.astype(np.intp), pieces.end_chord))


def samples_at(curves: Curves, edge_on: Bools, chord: Ints, part: Floats) -> Samples:
    """Points of curves, to look from."""
    found, curve = curves.at(chord, part), curves.owner[chord]
    second = curves.second_sheet[curve]
    cuspidal = (curves.kind[curve] == LineKind.CREASE) & (second < 0)
    return Samples(
        found.points, curves.sheet[curve], found.places, second, found.second_places, edge_on[curve], cuspidal
    )


def _ends(pieces: Pieces) -> list[tuple[Ints, Floats]]:
    return [(pieces.begin_chord, pieces.begin_part), (pieces.end_chord, pieces.end_part)]


def _on_chords(curves: Curves, chord: Ints, part: Floats) -> Floats:
    return np.asarray(curves.points[chord] + part[:, None] * (curves.points[chord + 1] - curves.points[chord]))
