"""Surfaces cut into slices: each slice falls into ribbons, and ribbons are painted one after the other.

Through the eye goes an axis across the slices, and every sight line lies in one half-plane that ends in this axis:
ribbons in different sectors about it never hide one another. Along a sight line the distance from the axis grows.
Source: Glaeser, section 5.3, figures 4 and 5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import ABOUT_AXIS
from vectorplot.visibility.painter.cuts.cutting import cut_into_order
from vectorplot.visibility.painter.cuts.slices import cut_into_slices, pairs_in_slices, related, slice_order
from vectorplot.visibility.painter.cuts.splitting import dense
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points, polygons_of, view_points
from vectorplot.visibility.painter.mikado import component_ranks
from vectorplot.visibility.painter.pairs.box_pairs import box_pairs
from vectorplot.visibility.painter.pairs.face_pairs import drawn_before
from vectorplot.visibility.projected_faces import Bytes

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
    plane lie on it. Degenerate: pieces narrower than the tolerance
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
    known = related(faces, pairs.some(asked), view.tolerance)
    ahead, behind = drawn_before(faces, known.first, known.second, known.codes)
    across = of[ahead] != of[behind]
    rank = component_ranks(
        len(found),
        np.concatenate([*before, of[ahead[across]]]),
        np.concatenate([*after, of[behind[across]]]),
    )
    place = dense(found.place, rank)[of]
    left = pairs.some(~asked & (place[pairs.first] == place[pairs.second]))
    together = place[known.first] == place[known.second]
    both = records.joined((known.some(together), related(faces, left, view.tolerance)))
    pieces, places, _ = cut_into_order(faces, place, both, view.tolerance)
    return pieces.some(np.lexsort((pieces.rank, places)))


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
    lots = [number[np.stack(pair)] for pair in box_pairs(box, 0.0)]
    pairs = np.sort(np.concatenate([np.zeros((2, 0), dtype=np.intp), *lots], axis=1), axis=0)
    key = np.unique(pairs[0] * count + pairs[1])
    first, second = np.divmod(key, max(count, 1))
    return first[first != second], second[first != second]


def _key(count: int, first: Ints, second: Ints) -> Ints:
    """(n,) one number for each pair of ribbons."""
    return np.asarray(np.minimum(first, second) * count + np.maximum(first, second), dtype=np.intp)
