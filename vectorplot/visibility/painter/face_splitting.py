"""Faces cut by planes until they have a painter's order: trees of planes, circles of overlap, slices and ribbons."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polylines import joined, take
from vectorplot.geometry.records import Elements
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.view import View
from vectorplot.tolerances import ABOUT_AXIS
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points, over_corners, polygons_of, view_points
from vectorplot.visibility.painter.priority_tests import (
    APART,
    STRADDLING,
    Codes,
    box_pairs,
    boxes_overlap,
    drawn_before,
    face_relations,
)
from vectorplot.visibility.painter.topological_order import component_ranks
from vectorplot.visibility.projected_faces import Bytes

# Faces above and below planes, and cut by them.


def heights_above(faces: ImageFaces, planes: Floats) -> Floats:
    """(c,) heights of the corners of faces above planes (5,n), one for each face."""
    x0, y0, h0, slope_x, slope_y = np.repeat(planes, np.diff(faces.offsets), axis=1)
    x, y, height = faces.points
    return np.asarray(height - h0 - slope_x * (x - x0) - slope_y * (y - y0), dtype=np.float64)


def height_span(faces: ImageFaces, which: Ints, planes: Floats) -> tuple[Floats, Floats]:
    """Least and largest height of the corners of some faces above planes (5,n)."""
    some = faces.take(which)
    height = heights_above(some, planes)
    if not len(which):
        return np.zeros(0), np.zeros(0)
    return np.minimum.reduceat(height, some.offsets[:-1]), np.maximum.reduceat(height, some.offsets[:-1])


def in_two(faces: ImageFaces, which: Ints, planes: Floats, steepness: Floats, tolerance: float) -> Bools:
    """(n,) whether planes (5,n) cut faces (n,) in two: both parts reach farther than what counts as on the plane."""
    low, high = height_span(faces, which, planes)
    limit = tolerance * np.maximum(faces.steepness[which], steepness)
    return np.asarray((low < -limit) & (high > limit), dtype=np.bool_)


def halves(faces: ImageFaces, planes: Floats, steepness: Floats, tolerance: float) -> tuple[ImageFaces, ImageFaces]:
    """The parts of faces below and above planes (5,n), one for each face; every face has both."""
    if not len(faces):
        return faces, faces
    limit = np.repeat(tolerance * np.maximum(faces.steepness, steepness), np.diff(faces.offsets))
    height = heights_above(faces, planes)
    height[np.abs(height) <= limit] = 0.0
    polygons = Polygons(faces.points.T, faces.offsets)
    parts = [cut_polygons(polygons, side * height)[0] for side in (-1.0, 1.0)]
    below, above = (
        ImageFaces(
            np.ascontiguousarray(part.points.T), part.offsets, faces.planes, faces.source, faces.rank, faces.bulges
        )
        for part in parts
    )
    return below, above


def dense(*keys: Ints) -> Ints:
    """(n,) ranks from 0 by several keys, the first one counting most; equal keys have equal ranks."""
    order = np.lexsort(keys[::-1])
    new = np.zeros(len(order), dtype=np.bool_)
    for key in keys:
        new[1:] |= key[order][1:] != key[order][:-1]
    rank = np.empty(len(order), dtype=np.intp)
    rank[order] = np.cumsum(new)
    return rank


# A tree of planes that orders anything, at the price of many cuts.

TRIED = 5
"""So many faces of each cell are tried as its dividing plane; the one that cuts least and divides most evenly is
taken."""

COST_OF_A_CUT = 4
"""A cut face weighs as much as so many faces more on one side than on the other."""

BELOW, WITHIN, ABOVE, ACROSS = 0, 1, 2, 3


@dataclass(frozen=True, eq=False)
class Partition:
    """Pieces of faces; parent (n,): the face each one comes from; rank (n,): in the order of drawing within its group;
    complete (n,): whether nothing lies across the plane of anything else in its cell."""

    faces: ImageFaces
    parent: Ints
    rank: Ints
    complete: Bools


def partitioned(faces: ImageFaces, group: Ints, tolerance: float, most: int) -> Partition:
    """The faces of each group cut by planes of faces until nothing lies across any of them, or there are most pieces.

    All cells of one level are divided at once. What lies below a plane is drawn first, then what lies in it, by rank,
    then what lies above; what is in a cell that was not divided any more, by the heights of the middles.
    Source: Fuchs, Kedem and Naylor, On visible surface generation by a priori tree structures (1980).
    """
    parent = np.arange(len(faces))
    cell = dense(group)
    open_cell = np.ones(len(faces), dtype=np.bool_)
    while True:
        open_cell &= np.bincount(cell)[cell] > 1
        active = np.flatnonzero(open_cell)
        if not len(active) or len(faces) > most:
            middle = faces.points[2]
            height = over_corners(np.minimum, middle, faces.offsets) + over_corners(np.maximum, middle, faces.offsets)
            return Partition(faces, parent, dense(cell, dense(np.where(open_cell, height, 0.0))), ~open_cell)
        knife = _dividing_faces(faces, cell, active, tolerance)
        side = _sides(faces, active, knife, tolerance)
        across = side == ACROSS
        whole = np.ones(len(faces), dtype=np.bool_)
        whole[active[across]] = False
        kept, cut = np.flatnonzero(whole), active[across]
        sides = np.full(len(faces), WITHIN, dtype=np.intp)
        sides[active] = side
        plane = knife[across]
        below, above = halves(faces.take(cut), faces.planes[:, plane], faces.steepness[plane], tolerance)
        level = np.zeros(len(faces), dtype=np.intp)
        in_plane = active[side == WITHIN]
        level[in_plane] = faces.rank[in_plane]
        open_cell[in_plane] = False
        source = np.concatenate([kept, cut, cut])
        faces = joined((faces.take(kept), below, above))
        half = np.full(len(cut), BELOW), np.full(len(cut), ABOVE)
        cell = dense(cell[source], np.concatenate([sides[kept], *half]), level[source])
        parent, open_cell = parent[source], open_cell[source]


def _dividing_faces(faces: ImageFaces, cell: Ints, active: Ints, tolerance: float) -> Ints:
    """(a,) for each active face the face that divides its cell."""
    order = active[np.lexsort((active, faces.rank[active], cell[active]))]
    starts = np.flatnonzero(np.concatenate([[True], cell[order][1:] != cell[order][:-1]]))
    sizes = np.diff(np.append(starts, len(order)))
    number = np.empty(len(cell), dtype=np.intp)
    number[order] = ragged.owner(sizes)
    mine = number[active]
    best, best_cost = np.zeros(len(starts), dtype=np.intp), np.full(len(starts), np.iinfo(np.intp).max)
    for attempt in range(TRIED):
        candidate = order[starts + (sizes - 1) * attempt // (TRIED - 1)]
        side = _sides(faces, active, candidate[mine], tolerance)
        count = [np.bincount(mine[side == s], minlength=len(starts)) for s in (BELOW, ABOVE, ACROSS)]
        cost = COST_OF_A_CUT * count[2] + np.abs(count[0] - count[1])
        better = cost < best_cost
        best, best_cost = np.where(better, candidate, best), np.where(better, cost, best_cost)
    return best[mine]


def _sides(faces: ImageFaces, which: Ints, knife: Ints, tolerance: float) -> Ints:
    """(k,) where some faces lie, seen from the planes of others."""
    low, high = height_span(faces, which, faces.planes[:, knife])
    limit = tolerance * np.maximum(faces.steepness[which], faces.steepness[knife])
    side = np.where(high > limit, np.where(low < -limit, ACROSS, ABOVE), np.where(low < -limit, BELOW, WITHIN))
    # A face lies in its own plane, whatever rounding says.
    return np.where(which == knife, WITHIN, side)


# Faces that pierce each other or lie on one another in circles, cut until there is an order.

MOST_ROUNDS = 64
"""After so many rounds of cutting what is still in circles is ordered by a tree of planes."""

LARGE_CIRCLE = 400
"""A circle of more faces than these is ordered by a tree of planes at once."""

PIERCED_BY = 4
"""A circle whose faces are pierced by more others than so many each in the mean is ordered by a tree of planes at once:
cut pair by pair its pieces, and even more so the pairs of them that have to be compared, grow faster."""

PIECES_OF_EACH = 4
"""A tree of planes may cut faces into so many pieces each in the mean, whatever the budget."""

PIECES_OF_TREES = 16
"""Trees may make so many times as many pieces as there may be cuts: nothing is compared pair by pair after them."""

SHARE_CUT = 8
"""Of a large circle one face in so many is cut in a round."""


@dataclass(frozen=True, eq=False)
class Pairs(Elements):
    """Faces whose images overlap: first, second (p,), and the codes of face_relations."""

    first: Ints
    second: Ints
    codes: Codes

    def __len__(self) -> int:
        return len(self.first)


def cut_into_order(
    faces: ImageFaces, group: Ints, pairs: Pairs, tolerance: float, most: int = USUAL.pieces
) -> tuple[ImageFaces, Ints, Bools]:
    """Faces cut as far as needed, for each one its place in the order of drawing, and whether that is right: what is in
    circles after most cuts is ordered by trees of planes, as far as these may go, and then by its heights.

    group (n,): faces of a lower group are known to go first; only within groups is anything compared. Faces that
    pierce each other are cut first, the larger one along the other's plane; then circles, at faces that lie on many
    and under many. Places may be equal: of such faces any order will do.
    Source: Newell, Newell and Sancha (1972); Fuchs, Kedem and Naylor (1980) for the large circles.
    """
    place, full = group, len(faces) + most
    circled = np.zeros(len(faces), dtype=np.bool_)
    for _ in range(MOST_ROUNDS):
        pairs = pairs.take((place[pairs.first] == place[pairs.second]) & (pairs.codes != APART))
        place = _sorted_out(faces, place, pairs)
        pairs = pairs.take(place[pairs.first] == place[pairs.second])
        crowded = _much_pierced(place, pairs)[place]
        circled |= crowded
        pairs = pairs.take(~crowded[pairs.first])
        if not len(pairs):
            break
        victim, knife = _cuts(faces, place, pairs, tolerance)
        # Steep faces may lie within the tolerance of a plane that they are said to reach through.
        halved = in_two(faces, victim, faces.planes[:, knife], faces.steepness[knife], tolerance)
        victim, knife = victim[halved], knife[halved]
        given_up = np.isin(place, place[pairs.first]) & ~np.isin(place, place[victim])
        circled |= given_up
        pairs = pairs.take(~given_up[pairs.first])
        if len(faces) + len(victim) > full:
            circled |= np.isin(place, place[victim])
            break
        faces, parent, children = _cut(faces, victim, faces.planes[:, knife], faces.steepness[knife], tolerance)
        place, circled = place[parent], circled[parent]
        pairs = _inherited(faces, pairs, children, tolerance)
    else:
        circled |= np.isin(place, place[pairs.first[place[pairs.first] == place[pairs.second]]])
    allowed = max(PIECES_OF_TREES * most, PIECES_OF_EACH * int(circled.sum()))
    return _with_trees(faces, place, circled, tolerance, allowed)


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
    found = partitioned(faces.take(left), place[left], tolerance, most)
    places = np.concatenate([place[done], place[left][found.parent]])
    ranks = np.concatenate([np.zeros(len(done), dtype=np.intp), found.rank])
    right = np.concatenate([np.ones(len(done), dtype=np.bool_), found.complete])
    return joined((faces.take(done), found.faces)), dense(places, ranks), right


def _sorted_out(faces: ImageFaces, place: Ints, pairs: Pairs) -> Ints:
    """The places told apart as far as the pairs do."""
    named = np.zeros(len(faces), dtype=np.bool_)
    named[pairs.first] = named[pairs.second] = True
    involved = np.flatnonzero(named)
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


def _cuts(faces: ImageFaces, place: Ints, pairs: Pairs, tolerance: float) -> tuple[Ints, Ints]:
    """Which faces to cut this round, each one once, and by whose planes. All pairs lie within circles."""
    straddling = pairs.codes == STRADDLING
    piercing = pairs.take(straddling)
    smaller = faces.rank[piercing.first] > faces.rank[piercing.second]
    victim = np.where(smaller, piercing.second, piercing.first)
    knife = np.where(smaller, piercing.first, piercing.second)
    pierced = np.zeros(int(place.max()) + 1, dtype=np.bool_)
    pierced[place[piercing.first]] = True
    size = np.bincount(place)
    rest = pairs.take(~pierced[place[pairs.first]] & (size[place[pairs.first]] <= LARGE_CIRCLE))
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
    below, above = halves(faces.take(victim), planes, steepness, tolerance)
    children = np.full((len(faces), 2), -1, dtype=np.intp)
    children[kept, 0] = np.arange(len(kept))
    children[victim, 0] = len(kept) + np.arange(len(victim))
    children[victim, 1] = len(kept) + len(victim) + np.arange(len(victim))
    return joined((faces.take(kept), below, above)), np.concatenate([kept, victim, victim]), children


def _inherited(faces: ImageFaces, pairs: Pairs, children: Ints, tolerance: float) -> Pairs:
    """The pairs of what became of the faces, compared anew where something was cut."""
    cut = (children[pairs.first, 1] >= 0) | (children[pairs.second, 1] >= 0)
    old, new = pairs.take(~cut), pairs.take(cut)
    first = np.concatenate([children[new.first, a] for a in (0, 0, 1, 1)])
    second = np.concatenate([children[new.second, b] for b in (0, 1, 0, 1)])
    there = np.flatnonzero((first >= 0) & (second >= 0))
    first, second = first.take(there), second.take(there)
    # Half of the parts of faces that overlap are apart: most of these in their boxes already.
    near = boxes_overlap(faces.box, first, second, tolerance)
    first, second = first[near], second[near]
    return Pairs(
        np.concatenate([children[old.first, 0], first]),
        np.concatenate([children[old.second, 0], second]),
        np.concatenate([old.codes, face_relations(faces, first, second, tolerance)]),
    )


# Shapes cut by parallel planes: of two slices the one on the far side of a plane between them is drawn first.


def slice_order(levels: ArrayLike, eye: float) -> Ints:
    """The slices between parallel planes, back to front.

    Parameters
    ----------
    levels : (k+1,) array_like of float
        Ascending: slice i lies between levels i and i+1.
    eye : float
        Of the same coordinate; infinite where the rays are parallel.

    Returns
    -------
    (k,) array of int
        The slices below the eye come first, upwards, then those above it, downwards, and last the one the eye is in.

    Raises
    ------
    InputError
        Where levels do not ascend, or are fewer than two.

    Notes
    -----
    Source: Glaeser, sections 5.2 to 5.4 (the plane through the eye).

    Examples
    --------
    >>> from vectorplot import visibility
    >>> visibility.slice_order([0.0, 1.0, 2.0, 3.0], eye=1.5).tolist()
    [0, 2, 1]
    """
    level = np.asarray(levels, dtype=np.float64)
    if level.ndim != 1 or len(level) < 2 or not (np.diff(level) > 0.0).all():
        raise InputError("the planes between slices must ascend, and be two at least")
    own = int(np.searchsorted(level, eye, side="right")) - 1
    count = len(level) - 1
    middle = np.arange(own, min(own + 1, count)) if own >= 0 else np.arange(0)
    return np.concatenate([np.arange(min(own, count)), np.arange(count - 1, own, -1), middle]).astype(np.intp)


def eye_coordinate(eye: ArrayLike, axis: int) -> float:
    """A coordinate of the eye (3,); of a direction towards the eye (x, y, z, 0) plus or minus infinity."""
    place = np.asarray(eye, dtype=np.float64)
    if place.shape not in ((3,), (4,)) or not np.isfinite(place).all() or (len(place) == 4 and place[3] != 0.0):
        raise InputError("an eye has three coordinates, a direction towards it is (x, y, z, 0)")
    if len(place) == 3:
        return float(place[axis])
    # Where the rays run along the planes the slices do not cover one another, whatever their order.
    return float("-inf") if place[axis] < 0.0 else float("inf")


def cut_into_slices(points: ArrayLike, offsets: Ints, axis: int, levels: ArrayLike) -> tuple[Polygons, Ints, Ints]:
    """Convex polygons cut by the planes where a coordinate has one of some levels.

    Parameters
    ----------
    points : (c, 3) array_like of float
        The corners of all polygons, one after the other.
    offsets : (n+1,) array of int
        Polygon i has the corners offsets[i] to offsets[i+1].
    axis : int
        Which coordinate: 0, 1 or 2.
    levels : (k,) array_like of float
        Ascending.

    Returns
    -------
    pieces : Polygons
        What the polygons fall into; new corners lie on the planes to the last digit.
    source : (p,) array of int
        The polygon each piece comes from.
    slices : (p,) array of int
        The slice each piece lies in, 0 below the first level, k above the last.

    Notes
    -----
    All polygons are halved at once, so that the price grows with the pieces and the logarithm of the levels.
    Edge cases: a polygon in one of the planes lies in the slice above it.

    Source: Glaeser, section 5.4, figure 6 (horizontal slices).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> corners = [(0, 0, 0), (1, 0, 0), (1, 0, 4), (0, 0, 4)]
    >>> pieces, source, slices = visibility.cut_into_slices(corners, np.array([0, 4]), axis=2, levels=[1.0, 3.0])
    >>> len(pieces), source.tolist(), slices.tolist()
    (3, [0, 0, 0], [0, 1, 2])
    """
    level = np.asarray(levels, dtype=np.float64)
    pieces, source = Polygons(np.array(points, dtype=np.float64), offsets), np.arange(len(offsets) - 1)
    if not len(source):
        return pieces, source, source
    coordinate = pieces.points[:, axis]
    first = np.searchsorted(level, np.minimum.reduceat(coordinate, offsets[:-1]), side="right")
    last = np.searchsorted(level, np.maximum.reduceat(coordinate, offsets[:-1]), side="left")
    while (across := last > first).any():
        whole, cut = np.flatnonzero(~across), np.flatnonzero(across)
        middle = (first[cut] + last[cut] + 1) // 2
        split = take(pieces, cut)
        limit = np.repeat(level[middle - 1], np.diff(split.offsets))
        height = split.points[:, axis] - limit
        below, above = (_cut_at(split, side * height, axis, level[middle - 1]) for side in (-1.0, 1.0))
        pieces = joined((take(pieces, whole), below, above))
        source = np.concatenate([source[whole], source[cut], source[cut]])
        first, last = (
            np.concatenate([first[whole], first[cut], middle]),
            np.concatenate([last[whole], middle - 1, last[cut]]),
        )
    return pieces, source, first


def _cut_at(polygons: Polygons, height: Floats, axis: int, level: Floats) -> Polygons:
    part, is_new = cut_polygons(polygons, height)
    part.points[is_new, axis] = np.repeat(level, np.diff(part.offsets))[is_new]
    return part


def sliced_order(faces: ImageFaces, place: Ints, tolerance: float) -> ImageFaces:
    """Faces back to front, where it is known of each in which slice it lies.

    Parameters
    ----------
    faces : ImageFaces
        As in image_faces.
    place : (n,) array of int
        The rank of each one's slice in the order of drawing, as in slice_order.
    tolerance : float
        What counts as distance zero, that of the view.

    Returns
    -------
    ImageFaces
        Only faces of one slice are compared, and cut where they must be.

    Notes
    -----
    The price grows with the faces, however many slices overlap in the image.

    Source: Glaeser, section 5.3 (ribbons of a slice by priority).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1))) for name in ("one", "two"))
    >>> view = scene.look(vp.Scene(cubes), vp.Camera((5, 4, 3)))
    >>> faces = visibility.image_faces(view, np.array([1, 2, 7, 8]))  # two of each cube
    >>> ordered = visibility.sliced_order(faces, np.array([1, 1, 0, 0]), view.tolerance)
    >>> view.face_item[ordered.source].tolist()
    [1, 1, 0, 0]
    """
    found = related(faces, pairs_in_slices(faces, place, tolerance), tolerance)
    pieces, places, _ = cut_into_order(faces, place, found, tolerance)
    return pieces.take(np.lexsort((pieces.rank, places)))


def pairs_in_slices(faces: ImageFaces, place: Ints, tolerance: float) -> Pairs:
    """Pairs of pieces of one slice whose boxes in the image overlap, not compared yet."""
    box = faces.box[:4].copy()
    # Side by side, so that only pieces of one slice meet.
    box[:2] += (float(np.ptp(box[:2])) + 1.0 if len(faces) else 1.0) * place
    batches = [np.zeros((2, 0), dtype=np.intp), *(np.stack(pair) for pair in box_pairs(box, tolerance))]
    first, second = np.concatenate(batches, axis=1)
    return Pairs(first, second, np.full(len(first), APART, dtype=np.int8))


def related(faces: ImageFaces, pairs: Pairs, tolerance: float) -> Pairs:
    """Those of some pairs whose images overlap, compared."""
    found = Pairs(pairs.first, pairs.second, face_relations(faces, pairs.first, pairs.second, tolerance))
    return found.take(found.codes != APART)


# Surfaces cut into slices: each slice falls into ribbons, and ribbons are painted one after the other.
#
# Through the eye goes an axis across the slices, and every sight line lies in one half-plane that ends in this axis:
# ribbons in different sectors about it never hide one another. Along a sight line the distance from the axis grows.
# Source: Glaeser, section 5.3, figures 4 and 5.

TURN = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class Slices:
    """A surface cut by parallel planes: faces (p pieces); slice_ (p,): 0 below the first plane; place (p,): the rank of
    the slice in the order of drawing; frame (3,3): its rows are two directions along the planes and their normal, in
    the view's coordinates; levels (k,): the heights of the planes along it."""

    faces: ImageFaces
    slice_: Ints
    place: Ints
    frame: Floats
    levels: Floats


@dataclass(frozen=True, eq=False)
class Ribbons:
    """The ribbons of a sliced surface: of_piece (p,) the ribbon of each piece; place (r,): of its slice; low, high
    (r,): the sector about the axis it is in, in radians, or, where sight lines are parallel, the strip; high is never
    more than a turn above low; nearest, farthest (r,): its distances from the axis."""

    of_piece: Ints
    place: Ints
    low: Floats
    high: Floats
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.place)


def in_slices(view: View, faces: ImageFaces, planes: Section) -> Slices:
    """Faces of a view cut by planes of the world.

    The planes of the pieces are those of the faces, to the last digit; corners within the tolerance of the view of a
    plane lie on it. Edge cases: pieces narrower than the tolerance
    of the view are left out; a face in one of the planes lies in the slice above it.
    Source: Glaeser, section 5.3.
    """
    normal = matmul(view.axes, np.array(planes.normal))
    frame = axis_frame(normal)
    levels = (np.unique(planes.offsets) - matmul(planes.normal, view.centre)) / view.scale
    points = matmul(view_points(view, faces.points).T, frame.T)
    above = np.minimum(np.searchsorted(levels, points[:, 2] - view.tolerance), len(levels) - 1)
    points[:, 2] = np.where(np.abs(points[:, 2] - levels[above]) <= view.tolerance, levels[above], points[:, 2])
    pieces, parent, slice_ = cut_into_slices(points, faces.offsets, 2, levels)
    made = polygons_of(
        image_points(view, np.ascontiguousarray((matmul(pieces.points, frame)).T)),
        pieces.offsets,
        np.arange(len(parent)),
        view.tolerance,
    )
    parent, slice_ = parent[made.source], slice_[made.source]
    found = ImageFaces(made.points, made.offsets, faces.planes[:, parent], faces.source[parent], faces.rank[parent])
    eye = float(matmul(normal, view.eye)) if view.eye is not None else float(np.copysign(np.inf, normal[2]))
    rank = np.empty(len(levels) + 1, dtype=np.intp)
    rank[slice_order(np.concatenate([[-np.inf], levels, [np.inf]]), eye)] = np.arange(len(rank))
    return Slices(found, slice_, rank[slice_], frame, levels)


def ribbons(view: View, facing: Bytes, slices: Slices) -> Ribbons:
    """The ribbons of a sliced surface: pieces of one slice that hang together by edges and show the same side.

    facing (f,): which side each face of the view shows.
    Source: Glaeser, section 5.3, figure 4.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    faces, count = slices.faces, len(slices.faces)
    one, other = _adjoining(view, slices)
    alike = facing[faces.source[one]] == facing[faces.source[other]]
    graph = coo_array((np.ones(int(alike.sum()), np.int8), (one[alike], other[alike])), shape=(count, count))
    number, of_piece = connected_components(graph.tocsr(), directed=False)
    of_piece = of_piece.astype(np.intp)
    place = np.zeros(number, dtype=np.intp)
    place[of_piece] = slices.place
    low, high, nearest, farthest = _about_axis(view, slices)
    least, most = np.full(number, np.inf), np.full(number, -np.inf)
    np.minimum.at(least, of_piece, nearest)
    np.maximum.at(most, of_piece, farthest)
    start, end = _sectors(of_piece, number, low, high, np.inf if view.eye is None else TURN)
    return Ribbons(of_piece, place, start, end, least, most)


def ribbon_order(view: View, slices: Slices, found: Ribbons) -> ImageFaces:
    """The pieces of a sliced surface back to front: slice by slice, in each ribbon by ribbon.

    Ribbons whose sectors overlap are compared: the one of larger distances from the axis goes first; where the
    distances do not tell, their faces do. Only ribbons that lie on one another in circles, or on themselves, are taken
    apart, and cut where there is no other way.
    Source: Glaeser, section 5.3, figure 5.
    """
    faces, of = slices.faces, found.of_piece
    first, second = _overlapping_sectors(found)
    decided = (found.nearest[first] > found.farthest[second] + ABOUT_AXIS) | (
        found.nearest[second] > found.farthest[first] + ABOUT_AXIS
    )
    farther = found.nearest[first] > found.farthest[second]
    before = [np.where(farther, first, second)[decided]]
    after = [np.where(farther, second, first)[decided]]
    unsure = np.unique(_key(len(found), first[~decided], second[~decided]))
    pairs = pairs_in_slices(faces, slices.place, view.tolerance)
    own = of[pairs.first] == of[pairs.second]
    asked = own | np.isin(_key(len(found), of[pairs.first], of[pairs.second]), unsure)
    known = related(faces, pairs.take(asked), view.tolerance)
    ahead, behind = drawn_before(faces, known.first, known.second, known.codes)
    across = of[ahead] != of[behind]
    rank = component_ranks(
        len(found),
        np.concatenate([*before, of[ahead[across]]]),
        np.concatenate([*after, of[behind[across]]]),
    )
    place = dense(found.place, rank)[of]
    left = pairs.take(~asked & (place[pairs.first] == place[pairs.second]))
    together = place[known.first] == place[known.second]
    both = records.joined((known.take(together), related(faces, left, view.tolerance)))
    pieces, places, _ = cut_into_order(faces, place, both, view.tolerance)
    return pieces.take(np.lexsort((pieces.rank, places)))


def _adjoining(view: View, slices: Slices) -> tuple[Ints, Ints]:
    """Pairs of pieces of one slice that have a part of an edge of the surface in common."""
    height = matmul(slices.frame[2], view.points)
    used = np.unique(slices.faces.source)
    position, ends = ragged.take(view.offsets, used)
    face = np.repeat(used, np.diff(ends))
    start, end = view.corners[position], view.corners[view.after(position)]
    side = np.minimum(start, end) * view.points.shape[1] + np.maximum(start, end)
    order = np.argsort(side, kind="stable")
    same = np.flatnonzero(side[order][1:] == side[order][:-1])
    one, other = order[same], order[same + 1]
    low = np.minimum(height[start[one]], height[end[one]])
    high = np.maximum(height[start[one]], height[end[one]])
    bottom = np.searchsorted(slices.levels, low, side="right")
    top = np.maximum(np.searchsorted(slices.levels, high, side="left"), bottom)
    sizes = top - bottom + 1
    edge = ragged.owner(sizes)
    level = ragged.place(sizes) + bottom[edge]
    first, second = (_pieces_at(slices, face[side][edge], level) for side in (one, other))
    there = (first >= 0) & (second >= 0)
    return first[there], second[there]


def _pieces_at(slices: Slices, face: Ints, slice_: Ints) -> Ints:
    """(n,) the pieces of faces in slices, -1 for none."""
    count = len(slices.levels) + 1
    keys, wanted = slices.faces.source * count + slices.slice_, face * count + slice_
    order = np.argsort(keys, kind="stable")
    at = order[np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)]
    return np.where(keys[at] == wanted, at, -1)


def _about_axis(view: View, slices: Slices) -> tuple[Floats, Floats, Floats, Floats]:
    """The sector of every piece about the axis through the eye, from low to high (p,), and its smallest and largest
    distance from it; where sight lines are parallel, the strip along them, and how far it is down them."""
    offsets = slices.faces.offsets
    level = matmul(slices.frame[:2], view_points(view, slices.faces.points))
    if view.eye is None:
        towards = slices.frame[:2, 2]
        length = float(np.hypot(*towards))
        ahead = towards / length if length > 0.0 else np.array([1.0, 0.0])
        across, down = ahead[0] * level[1] - ahead[1] * level[0], -(matmul(ahead, level))
        least, most = (reduce.reduceat([across, down], offsets[:-1], axis=1) for reduce in (np.minimum, np.maximum))
        return least[0], most[0], least[1], most[1]
    arm = level - (matmul(slices.frame[:2], view.eye))[:, None]
    after = arm[:, next_positions(offsets, np.arange(arm.shape[1]))]
    first = np.repeat(arm[:, offsets[:-1]], np.diff(offsets), axis=1)
    turned = arctan2(first[0] * arm[1] - first[1] * arm[0], (first * arm).sum(axis=0))
    start = arctan2(arm[1, offsets[:-1]], arm[0, offsets[:-1]])
    low, high = (start + reduce.reduceat(turned, offsets[:-1]) for reduce in (np.minimum, np.maximum))
    side = after - arm
    length = (side * side).sum(axis=0)
    along = np.clip(-(arm * side).sum(axis=0) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    nearest = np.minimum.reduceat(np.hypot(*(arm + along * side)), offsets[:-1])
    farthest = np.maximum.reduceat(np.hypot(*arm), offsets[:-1])
    double = arm[0] * after[1] - arm[1] * after[0]
    around = (np.minimum.reduceat(double, offsets[:-1]) > 0.0) | (np.maximum.reduceat(double, offsets[:-1]) < 0.0)
    # What the axis meets, or all but meets, is in all directions from it.
    around |= nearest <= ABOUT_AXIS * (1.0 + farthest)
    return (
        np.where(around, 0.0, low),
        np.where(around, TURN, high),
        np.where(around, 0.0, nearest),
        farthest,
    )


def _sectors(of: Ints, count: int, low: Floats, high: Floats, turn: float) -> tuple[Floats, Floats]:
    """(count,) the smallest sectors, from low to high, that hold some smaller ones, those of equal numbers of."""
    if not np.isfinite(turn):
        start, end = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(start, of, low)
        np.maximum.at(end, of, high)
        return start, end
    wide = high - low
    low = np.mod(low, turn)
    high = low + wide
    order = np.lexsort((low, of))
    owner, low, high = of[order], low[order], high[order]
    begins = np.flatnonzero(np.append(True, owner[1:] != owner[:-1])[: len(owner)])
    reach = np.maximum.accumulate(high + 4.0 * turn * owner) - 4.0 * turn * owner
    last = np.append(begins[1:], len(owner)) - 1
    over = np.repeat(reach[last] - turn, last - begins + 1)
    covered = np.append(-np.inf, reach[:-1])
    covered[begins] = -np.inf
    gap = np.maximum(low - np.maximum(covered, over), 0.0)
    best = np.lexsort((-gap, owner))[begins]
    return low[best], low[best] + turn - gap[best]


def _overlapping_sectors(found: Ribbons) -> tuple[Ints, Ints]:
    """Pairs of ribbons of one slice whose sectors overlap, the smaller number first."""
    count = len(found)
    over = np.flatnonzero(found.high > TURN)
    number = np.concatenate([np.arange(count), over])
    back = np.concatenate([np.zeros(count), np.full(len(over), TURN)])
    place = found.place[number].astype(np.float64)
    box = np.stack([found.low[number] - back - ABOUT_AXIS, found.high[number] - back + ABOUT_AXIS, place, place + 0.5])
    batches = [number[np.stack(pair)] for pair in box_pairs(box, 0.0)]
    pairs = np.sort(np.concatenate([np.zeros((2, 0), dtype=np.intp), *batches], axis=1), axis=0)
    key = np.unique(pairs[0] * count + pairs[1])
    first, second = np.divmod(key, max(count, 1))
    return first[first != second], second[first != second]


def _key(count: int, first: Ints, second: Ints) -> Ints:
    """(n,) one number for each pair of ribbons."""
    return np.asarray(np.minimum(first, second) * count + np.maximum(first, second), dtype=np.intp)
