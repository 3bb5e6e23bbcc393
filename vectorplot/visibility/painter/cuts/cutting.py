"""Faces that pierce each other or lie on one another in circles, cut until there is an order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.budget import USUAL
from vectorplot.geometry.polylines import joined
from vectorplot.visibility.painter.cuts.space_partition import partitioned
from vectorplot.visibility.painter.cuts.splitting import dense, halves, height_span, in_two
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.mikado import component_ranks
from vectorplot.visibility.painter.pairs.face_pairs import (
    APART,
    STRADDLING,
    Codes,
    drawn_before,
    face_relations,
)

MOST_ROUNDS = 64
"""After so many rounds of cutting what is still in circles is ordered by a tree of planes."""

LARGE_CIRCLE = 400
"""A circle of more faces than these is ordered by a tree of planes at once."""

PIERCED_BY = 4
"""A circle whose faces are pierced by more others than so many each in the mean is ordered by a tree of planes at once:
cut pair by pair its pieces, and even more so the pairs of them that have to be compared, grow faster."""

PIECES_OF_EACH = 4
"""A tree of planes may cut faces into so many pieces each in the mean, whatever the budget."""

SHARE_CUT = 8
"""Of a large circle one face in so many is cut in a round."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Faces whose images overlap: first, second (p,), and the codes of face_relations."""

    first: Ints
    second: Ints
    codes: Codes

    def __len__(self) -> int:
        return len(self.first)

    def some(self, which: Ints | Bools) -> Pairs:
        """Some of the pairs."""
        return records.some(self, which)


def cut_into_order(
    faces: ImageFaces, group: Ints, pairs: Pairs, tolerance: float, most: int = USUAL.pieces
) -> tuple[ImageFaces, Ints, Bools]:
    """Faces cut as far as needed, for each one its place in the order of drawing, and whether that is right: what is in
    circles after most cuts is in order by its heights.

    group (n,): faces of a lower group are known to go first; only within groups is anything compared. Faces that
    pierce each other are cut first, the larger one along the other's plane; then circles, at faces that lie on many
    and under many. Places may be equal: of such faces any order will do.
    Source: Newell, Newell and Sancha (1972); Fuchs, Kedem and Naylor (1980) for the large circles.
    """
    place, full = group, len(faces) + most
    circled = np.zeros(len(faces), dtype=np.bool_)
    for number in range(MOST_ROUNDS):
        pairs = pairs.some((place[pairs.first] == place[pairs.second]) & (pairs.codes != APART))
        place = _sorted_out(faces, place, pairs)
        pairs = pairs.some(place[pairs.first] == place[pairs.second])
        crowded = _much_pierced(place, pairs)[place]
        circled |= crowded
        pairs = pairs.some(~crowded[pairs.first])
        if not len(pairs):
            break
        victim, knife = _cuts(faces, place, pairs, number, tolerance)
        # Steep faces may lie within the tolerance of a plane that they are said to reach through.
        halved = in_two(faces, victim, faces.planes[:, knife], faces.steepness[knife], tolerance)
        victim, knife = victim[halved], knife[halved]
        given_up = np.isin(place, place[pairs.first]) & ~np.isin(place, place[victim])
        circled |= given_up
        pairs = pairs.some(~given_up[pairs.first])
        if len(faces) + len(victim) > full:
            circled |= np.isin(place, place[victim])
            return _with_trees(faces, place, circled, tolerance, int(circled.sum()))
        faces, parent, children = _cut(faces, victim, faces.planes[:, knife], faces.steepness[knife], tolerance)
        place, circled = place[parent], circled[parent]
        pairs = _inherited(faces, pairs, children, tolerance)
    else:
        circled |= np.isin(place, place[pairs.first[place[pairs.first] == place[pairs.second]]])
    return _with_trees(faces, place, circled, tolerance, max(most, PIECES_OF_EACH * int(circled.sum())))


def _much_pierced(place: Ints, pairs: Pairs) -> Bools:
    """(p,) the places whose faces are pierced by more than PIERCED_BY others in the mean."""
    size = np.bincount(place)
    pierced = np.bincount(place[pairs.first[pairs.codes == STRADDLING]], minlength=len(size))
    return np.asarray(2 * pierced > PIERCED_BY * size, dtype=np.bool_)


def _with_trees(
    faces: ImageFaces, place: Ints, circled: Bools, tolerance: float, most: int
) -> tuple[ImageFaces, Ints, Bools]:
    """The faces in circles that were given up, ordered among the others by trees of planes that make most pieces."""
    if not circled.any():
        return faces, place, np.ones(len(faces), dtype=np.bool_)
    done, left = np.flatnonzero(~circled), np.flatnonzero(circled)
    found = partitioned(faces.some(left), place[left], tolerance, most)
    places = np.concatenate([place[done], place[left][found.parent]])
    ranks = np.concatenate([np.zeros(len(done), dtype=np.intp), found.rank])
    right = np.concatenate([np.ones(len(done), dtype=np.bool_), found.complete])
    return joined((faces.some(done), found.faces)), dense(places, ranks), right


def _sorted_out(faces: ImageFaces, place: Ints, pairs: Pairs) -> Ints:
    """The places told apart as far as the pairs do."""
    involved = np.unique(np.concatenate([pairs.first, pairs.second]))
    # Numbered by rank, so that nothing depends on the order in which the faces came.
    by_rank = np.lexsort((involved, faces.rank[involved]))
    number = np.empty(len(involved), dtype=np.intp)
    number[by_rank] = np.arange(len(involved))
    before, after = drawn_before(faces, pairs.first, pairs.second, pairs.codes)
    lookup = np.full(len(faces), -1, dtype=np.intp)
    lookup[involved] = number
    rank = np.full(len(faces), -1, dtype=np.intp)
    rank[involved] = component_ranks(len(involved), lookup[before], lookup[after])[number]
    return dense(place, rank)


def _cuts(faces: ImageFaces, place: Ints, pairs: Pairs, number: int, tolerance: float) -> tuple[Ints, Ints]:
    """Which faces to cut this round, each one once, and by whose planes. All pairs lie within circles."""
    straddling = pairs.codes == STRADDLING
    piercing = pairs.some(straddling)
    smaller = faces.rank[piercing.first] > faces.rank[piercing.second]
    victim = np.where(smaller, piercing.second, piercing.first)
    knife = np.where(smaller, piercing.first, piercing.second)
    pierced = np.zeros(int(place.max()) + 1, dtype=np.bool_)
    pierced[place[piercing.first]] = True
    size = np.bincount(place)
    rest = pairs.some(~pierced[place[pairs.first]] & (size[place[pairs.first]] <= LARGE_CIRCLE))
    chosen = _once(faces, victim, knife, np.zeros(len(victim)))
    victim, knife = victim[chosen], knife[chosen]
    if not len(rest):
        return victim, knife
    more, planes = _circle_cuts(faces, place, rest, tolerance)
    return np.concatenate([victim, more]), np.concatenate([knife, planes])


def _once(faces: ImageFaces, victim: Ints, knife: Ints, cost: Floats) -> Ints:
    """For each victim the knife of least cost."""
    order = np.lexsort((knife, faces.rank[knife], cost, victim))
    first = np.ones(len(order), dtype=np.bool_)
    first[1:] = victim[order][1:] != victim[order][:-1]
    return np.asarray(order[first], dtype=np.intp)


def _circle_cuts(faces: ImageFaces, place: Ints, pairs: Pairs, tolerance: float) -> tuple[Ints, Ints]:
    """Faces to cut in circles without piercing: those that lie on many and under many, where a plane halves them
    best."""
    before, after = drawn_before(faces, pairs.first, pairs.second, pairs.codes)
    under, on = (np.bincount(ends, minlength=len(faces)) for ends in (before, after))
    victim = np.concatenate([pairs.first, pairs.second])
    knife = np.concatenate([pairs.second, pairs.first])
    low, high = height_span(faces, victim, faces.planes[:, knife])
    limit = tolerance * np.maximum(faces.steepness[victim], faces.steepness[knife])
    splits = np.flatnonzero((low < -limit) & (high > limit))
    victim, knife, low, high = victim[splits], knife[splits], low[splits], high[splits]
    chosen = _once(faces, victim, knife, -np.minimum(high, -low) / (high - low))
    victim, knife = victim[chosen], knife[chosen]
    load = under[victim] * on[victim]
    order = np.lexsort((faces.rank[victim], -load, place[victim]))
    victim, knife = victim[order], knife[order]
    starts = np.flatnonzero(np.concatenate([[True], place[victim][1:] != place[victim][:-1]]))
    nth = np.arange(len(victim)) - np.repeat(starts, np.diff(np.append(starts, len(victim))))
    quota = np.maximum(np.bincount(place)[place[victim]] // SHARE_CUT, 1)
    kept = nth < quota
    return victim[kept], knife[kept]


def _cut(
    faces: ImageFaces, victim: Ints, planes: Floats, steepness: Floats, tolerance: float
) -> tuple[ImageFaces, Ints, Ints]:
    """The faces with some of them cut in two, the face each one comes from, and (n,2) what became of each face, -1 for
    nothing."""
    whole = np.ones(len(faces), dtype=np.bool_)
    whole[victim] = False
    kept = np.flatnonzero(whole)
    below, above = halves(faces.some(victim), planes, steepness, tolerance)
    children = np.full((len(faces), 2), -1, dtype=np.intp)
    children[kept, 0] = np.arange(len(kept))
    children[victim, 0] = len(kept) + np.arange(len(victim))
    children[victim, 1] = len(kept) + len(victim) + np.arange(len(victim))
    return joined((faces.some(kept), below, above)), np.concatenate([kept, victim, victim]), children


def _inherited(faces: ImageFaces, pairs: Pairs, children: Ints, tolerance: float) -> Pairs:
    """The pairs of what became of the faces, compared anew where something was cut."""
    cut = (children[pairs.first, 1] >= 0) | (children[pairs.second, 1] >= 0)
    old, new = pairs.some(~cut), pairs.some(cut)
    first = np.concatenate([children[new.first, a] for a in (0, 0, 1, 1)])
    second = np.concatenate([children[new.second, b] for b in (0, 1, 0, 1)])
    there = (first >= 0) & (second >= 0)
    first, second = first[there], second[there]
    return Pairs(
        np.concatenate([children[old.first, 0], first]),
        np.concatenate([children[old.second, 0], second]),
        np.concatenate([old.codes, face_relations(faces, first, second, tolerance)]),
    )
