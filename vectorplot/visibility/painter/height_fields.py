"""The painter's order, without comparisons, of items that cover a plane once, such as graphs of functions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.graphs import vertical
from vectorplot.visibility.painter.topological_order import Precedence
from vectorplot.visibility.projected_faces import newell

# Polygons that cover a part of the plane once: the gaps between them filled, and which ones lie side by side.

MOST_BORDER = 1 << 13
"""Sides on the border of a plan at most: filling its gaps takes a second where so many of them are in one line."""

MOST_NEIGHBOURS = 64
"""With more boxes of other sides than this across that of a side on the border, in the mean, it is no border."""

SIDES_AT_ONCE = 256
"""Sides looked up at once."""

ROUNDS = 8
"""So often polygons whose borders cross are left out of a plan."""

SHARE_LEFT_OUT = 1.0 / 16.0
"""Where more of all polygons would be left out, they are no plan."""

MARGIN = 0.5
"""The gaps around a plan reach so many times its size beyond it."""


@dataclass(frozen=True, eq=False)
class Plan:
    """Convex polygons side by side, and triangles in the gaps between them: together they fill a rectangle, and of any
    two that a line meets one after the other the sides tell.

    start, end (2,s): sides of two polygons; left, right (s,): the polygons on both sides of the way from start to end,
    gaps numbered after the others; count: how many there are in all.
    """

    start: Floats
    end: Floats
    left: Ints
    right: Ints
    count: int


def largest_plan(places: Floats, corners: Ints, offsets: Ints) -> tuple[Plan, Ints] | None:
    """The plan of polygons as in plan_of, and which ones it is of (k,): all of them, or those that are left without the
    few whose borders cross; None where too many do, or they overlap otherwise."""
    kept = np.arange(len(offsets) - 1)
    fewest = (1.0 - SHARE_LEFT_OUT) * len(kept)
    for _ in range(ROUNDS):
        corner, ends = ragged.take(offsets, kept)
        plan = plan_of(places, corners[corner], ends)
        if plan is not None:
            return plan, kept
        crossing = _crossing(places, corners[corner], ends)
        kept = np.delete(kept, crossing)
        if not len(crossing) or len(kept) < fewest:
            break
    return None


def _crossing(places: Floats, corners: Ints, offsets: Ints) -> Ints:
    """The polygons with a side on the border that another such side crosses, or runs along in part; none where these
    are in one another's way more often than MOST_NEIGHBOURS allows."""
    import shapely

    start, end, face = _border(places, corners, offsets)
    none = np.zeros(0, dtype=np.intp)
    if len(face) > MOST_BORDER:
        return none
    sides = shapely.linestrings(np.stack([places[:, start].T, places[:, end].T], axis=1))
    tree, met, found = shapely.STRtree(sides), 0, [none]
    for low in in_turn(range(0, len(sides), SIDES_AT_ONCE)):
        one, other = tree.query(sides[low : low + SIDES_AT_ONCE])
        met += len(one)
        if met > MOST_NEIGHBOURS * (len(sides) + SIDES_AT_ONCE):
            return none
        one += low
        across = shapely.crosses(sides[one], sides[other]) | shapely.overlaps(sides[one], sides[other])
        found.append(one[across])
    return np.unique(face[np.concatenate(found)])


def _border(places: Floats, corners: Ints, offsets: Ints) -> tuple[Ints, Ints, Ints]:
    """The sides, from start to end (s,), that no other polygon has, and whose they are; nothing where two run the same
    way."""
    start, end = corners, corners[ragged.following(offsets)]
    face = ragged.owner(np.diff(offsets))
    one, other = _paired(start, end, places.shape[1])
    single = np.full(len(start), one is not None)
    single[one] = single[other] = False
    return start[single], end[single], face[single]


def plan_of(places: Floats, corners: Ints, offsets: Ints) -> Plan | None:
    """The plan of polygons with corners at places (2,v), all counter-clockwise; None where they overlap, or do not
    share their sides as a whole.

    The sides that no other polygon has, and a rectangle around all, bound the gaps, which are triangulated. If then
    every side is run along once each way, all of the rectangle is covered equally often, which is once.
    Source: Chew, Constrained Delaunay triangulations (1989), as GEOS has it.
    """
    following = ragged.following(offsets)
    start, end = corners, corners[following]
    face = ragged.owner(np.diff(offsets))
    one, other = _paired(start, end, places.shape[1])
    if one is None or other is None:
        return None
    single = np.ones(len(start), dtype=np.bool_)
    single[one] = single[other] = False
    border = np.flatnonzero(single)
    if len(border) > MOST_BORDER:
        return None
    filled = _filled(places, start[border], end[border], face[border], len(offsets) - 1)
    if filled is None:
        return None
    return Plan(
        np.concatenate([places[:, start[one]], filled.start], axis=1),
        np.concatenate([places[:, end[one]], filled.end], axis=1),
        np.concatenate([face[one], filled.left]),
        np.concatenate([face[other], filled.right]),
        filled.count,
    )


def _paired(start: Ints, end: Ints, count: int) -> tuple[Ints, Ints] | tuple[None, None]:
    """The sides, from start to end (n,), whose way back is another one: these ones, and those others; nothing where two
    run the same way."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = 2 * (low * count + high) + (start > end)
    bits = len(key).bit_length()
    if len(key) and int(count).bit_length() * 2 + 1 + bits < 63:
        packed = np.sort((key << bits) | np.arange(len(key)))
        order, key = packed & ((1 << bits) - 1), packed >> bits
    else:
        order = np.argsort(key, kind="stable")
        key = key[order]
    step = np.diff(key)
    if (step == 0).any():
        return None, None
    first = np.flatnonzero((step == 1) & (key[:-1] % 2 == 0))
    return order[first], order[first + 1]


def _filled(places: Floats, start: Ints, end: Ints, face: Ints, count: int) -> Plan | None:
    """The plan of what is around polygons: of the sides on their border, and of the gaps beside these."""
    place, number = _distinct(places, np.concatenate([start, end]))
    start, end = number[: len(start)], number[len(start) :]
    gaps = _gaps(place, start, end)
    size = len(place) + 4
    after = np.roll(gaps, -1, axis=1)
    a, b = np.concatenate([start, gaps.ravel()]), np.concatenate([end, after.ravel()])
    owner = np.concatenate([face, count + np.repeat(np.arange(len(gaps)), 3)])
    one, other = _paired(a, b, size)
    if one is None or other is None or (gaps < 0).any():
        return None
    # Only the four sides of the rectangle have nothing beyond them.
    if 2 * len(one) != len(a) - 4:
        return None
    every = np.concatenate([place, _rectangle(place)])
    return Plan(every[a[one]].T, every[b[one]].T, owner[one], owner[other], count + len(gaps))


def _distinct(places: Floats, corner: Ints) -> tuple[Floats, Ints]:
    """The places (m,2) of some corners, each one once, and the number of each corner's."""
    used, local = np.unique(corner, return_inverse=True)
    where = np.ascontiguousarray(places[:, used].T) + 0.0
    same, number = np.unique(where, axis=0, return_inverse=True)
    return same, number.ravel()[local]


def _rectangle(place: Floats) -> Floats:
    """(4,2) the corners of a rectangle around places (m,2), counter-clockwise."""
    low, high = place.min(axis=0), place.max(axis=0)
    margin = MARGIN * (high - low)
    (left, bottom), (right, top) = low - margin, high + margin
    return np.array([(left, bottom), (right, bottom), (right, top), (left, top)])


def _gaps(place: Floats, start: Ints, end: Ints) -> Ints:
    """(g,3) triangles, counter-clockwise, of what the sides from start to end bound on their right, inside the
    rectangle whose corners are numbered after places (m,2); -1 for corners that are none of these."""
    import shapely

    # Sides that were run along both ways are seams, and bound nothing.
    key, back = start * len(place) + end, end * len(place) + start
    outer = np.flatnonzero(~np.isin(key, back))
    frame = _rectangle(place)
    every = np.concatenate([place, frame])
    ring = len(place) + np.arange(4)
    first, last = np.concatenate([start[outer], ring]), np.concatenate([end[outer], np.roll(ring, -1)])
    cells = shapely.get_parts(shapely.polygonize(shapely.linestrings(np.stack([every[first], every[last]], axis=1))))
    gaps = cells[~_covered(cells, every, key[outer], len(place))]
    try:
        triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(gaps))
    except shapely.errors.GEOSException:
        # Of sides that cross there are cells that are no polygons.
        return np.full((1, 3), -1)
    rings = shapely.get_exterior_ring(triangles)
    corner = shapely.get_coordinates(rings).reshape(-1, 4, 2)[:, :3]
    turned = np.where(shapely.is_ccw(rings)[:, None, None], corner, corner[:, ::-1])
    return _numbers(every, turned.reshape(-1, 2)).reshape(-1, 3)


def _covered(cells: NDArray[np.object_], every: Floats, keys: Ints, count: int) -> Bools:
    """(c,) whether cells have a polygon inside of them: one with a side on their border, keys start * count + end."""
    import shapely

    rings = shapely.get_exterior_ring(cells)
    points, ring = shapely.get_coordinates(rings, return_index=True)
    first = np.searchsorted(ring, np.arange(len(cells)))
    one, two = (_numbers(every, points[at]) for at in (first, first + 1))
    ccw = shapely.is_ccw(rings)
    start, end = np.where(ccw, one, two), np.where(ccw, two, one)
    return np.asarray((start < count) & (end < count) & np.isin(start * count + end, keys))


def _numbers(every: Floats, points: Floats) -> Ints:
    """(n,) which of some different places (m,2) points (n,2) are, -1 for none."""
    _, same = np.unique(np.concatenate([every, points + 0.0]), axis=0, return_inverse=True)
    number = np.full(int(same.max()) + 1, -1, dtype=np.intp)
    number[same.ravel()[: len(every)]] = np.arange(len(every))
    return np.asarray(number[same.ravel()[len(every) :]])


FEWEST = 64
"""Of items with fewer faces it is not worth asking for a plan."""

LOOKS = 256
"""So many faces are asked first whether all of an item may be turned to one side."""

STEPS = 64
"""Steps of the search for a direction to which they are turned."""

LEAST_MEAN = 0.1
"""The mean of unit normals of a shape that is closed, or nearly so, is no longer than this."""

FIELD_MARGIN = 0.05
"""In each step the worst of the normals comes to be turned so far to the direction: the cosine of some 87 degrees."""


def known_orders(scene: Scene, view: View) -> dict[int, Precedence]:
    """For every item with FEWEST faces or more that all show the same side along some direction, and there cover
    nothing twice, what has to be drawn before what.

    scene: with the shapes that the faces of the view stand for. The directions that are tried are that of the height
    of graphs, the axes of the world, and where the faces show to in the mean.
    """
    found = {}
    first = np.searchsorted(view.face_item, np.arange(len(scene.items) + 1))
    for number in np.flatnonzero(np.diff(first) >= FEWEST).tolist():
        face = np.arange(first[number], first[number + 1])
        for direction in _directions(scene, view, number, face):
            order = field_order(view, face, direction)
            if order is not None:
                found[number] = order
                break
    return found


def _directions(scene: Scene, view: View, number: int, face: Ints) -> Iterator[Floats]:
    """Directions (3,) of the view along which all faces of an item may show the same side."""
    own = vertical(scene.items[number].shape)
    if own is not None:
        yield matmul(view.axes, own)
        return
    some = face[:: -(-len(face) // LOOKS)]
    normal, longest, _ = newell(view, some)
    for direction in (*view.axes.T[::-1], _all_along(normal)):
        if direction is not None and _side(direction, normal, view.tolerance * longest):
            yield direction


def _all_along(normal: Floats) -> Floats | None:
    """(3,) a unit vector along which all of some normals (3,n) are turned to, if there is one and it is found.

    Source: Agmon, The relaxation method for linear inequalities (1954).
    """
    length = np.sqrt((normal * normal).sum(axis=0))
    unit = normal[:, length > 0.0] / length[length > 0.0]
    mean = unit.mean(axis=1) if unit.shape[1] else np.zeros(3)
    for _ in range(STEPS):
        size = float(np.sqrt(matmul(mean, mean)))
        # Of closed shapes nothing is left in the mean.
        if size < LEAST_MEAN:
            return None
        mean /= size
        along = matmul(mean, unit)
        worst = int(along.argmin())
        if along[worst] > 0.0:
            break
        mean += (FIELD_MARGIN - along[worst]) * unit[:, worst]
    return mean


def field_order(view: View, face: Ints, direction: Floats) -> Precedence | None:
    """What has to be drawn before what of some consecutive faces (f,) of a view; None if they do not all show the same
    side along a direction (3,), or their plan across it overlaps itself. A few faces whose borders cross in it are left
    out.

    A plane along the direction through a side of two faces has the eye on one side: the face on the other side goes
    first. So wherever the eye is, and whatever the heights are; gaps of the plan, which sight lines cross as well, are
    filled.
    Source: Glaeser, section 5.4, figure 7; De Floriani, Falcidieno, Nagy and Pienovi, On sorting triangles in a
    Delaunay tessellation (1991).
    """
    frame = axis_frame(direction)
    normal, longest, _ = newell(view, face)
    frame[1:] *= _side(frame[2], normal, view.tolerance * longest)
    if not frame[1:].any():
        return None
    corners = view.corners[view.offsets[face[0]] : view.offsets[face[-1] + 1]]
    found = largest_plan(matmul(frame[:2], view.points), corners, ragged.offsets(view.face_sizes[face]))
    if found is None:
        return None
    plan, kept = found
    before, after = _across_sides(plan, view, frame[:2])
    return Precedence(np.append(face[kept], np.full(plan.count - len(kept), -1)), before, after)


def _side(direction: Floats, normal: Floats, zero: Floats) -> int:
    """1 if all faces with normals (3,f) show their outside along a direction (3,), or are edge-on, as far as zero (f,)
    tells, -1 if they show their inside, 0 if they differ."""
    along = matmul(direction, normal)
    if not (np.abs(along) > zero).any():
        return 0
    return int((along >= -zero).all()) - int((along <= zero).all())


def _across_sides(plan: Plan, view: View, frame: Floats) -> tuple[Ints, Ints]:
    """What has to be drawn before what of a plan, whose directions are the rows of frame (2,3).

    Sides that the eye sees end-on in the plan are crossed by no sight line.
    """
    way = plan.end - plan.start
    toward = matmul(frame, view.eye[:, None]) - plan.start if view.eye is not None else frame[:, 2:]
    turn = way[0] * toward[1] - way[1] * toward[0]
    limit = view.tolerance * np.hypot(*toward)
    on_left, on_right = turn > limit, turn < -limit
    return (
        np.concatenate([plan.right[on_left], plan.left[on_right]]),
        np.concatenate([plan.left[on_left], plan.right[on_right]]),
    )
