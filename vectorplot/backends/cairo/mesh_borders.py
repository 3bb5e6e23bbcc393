"""Where the triangles of a mesh on the page end, and what is put around them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints

REACH_MICRONS = 450.0
"""The width of skirts."""

BESIDE_MICRONS = 40.0
"""So far from sides it is looked for what is next to them: less than what is put around them."""

LOOKS = np.array((0.01, 0.15, 0.3, 0.5, 0.7, 0.85, 0.99))
"""Where along sides."""


def border_sides(corners: Ints) -> Ints:
    """(s,2) the sides that more triangles have in one direction than in the other, by the numbers of their ends.

    corners (3 t, 2): whole coordinates; all triangles are counter-clockwise. Filled by the rule that counts turns,
    these sides enclose what the triangles cover together, overlapping ones too.
    """
    place = places_of(corners)
    start = np.arange(len(corners))
    end = start.reshape(-1, 3)[:, [1, 2, 0]].ravel()
    low, high = np.sort(np.stack((place[start], place[end])), axis=0)
    forth = np.where(place[start] == low, 1, -1)
    _, number = np.unique(low * len(corners) + high, return_inverse=True)
    surplus = np.bincount(number.ravel(), weights=forth).astype(np.intp)[number.ravel()]
    mine = np.flatnonzero(forth * surplus > 0)
    mine = mine[np.argsort(number.ravel()[mine], kind="stable")]
    of_side = number.ravel()[mine]
    first = np.searchsorted(of_side, of_side)
    kept = np.sort(mine[np.arange(len(mine)) - first < np.abs(surplus[mine])])
    return np.stack((start[kept], end[kept]), axis=1)


def last_of_sides(corners: Ints, sides: Ints) -> Ints:
    """Which of sides (s,2) are the last ones from their start to their end: where a surface folds over, the sides of
    two triangles are there, and the later one is seen."""
    place = places_of(corners)[sides]
    _, first = np.unique(place[::-1], axis=0, return_index=True)
    return np.sort(len(sides) - 1 - first)


def outer_sides(corners: Ints, sides: Ints) -> Ints:
    """Those of sides (s,2) of triangles (3 t, 2), counter-clockwise, with a place next to them, outside, that no
    triangle covers: where a surface folds over before itself its border needs nothing around it."""
    import shapely

    start, end = corners[sides[:, 0]].astype(np.float64), corners[sides[:, 1]].astype(np.float64)
    way = end - start
    out = np.stack((way[:, 1], -way[:, 0]), axis=1) * (BESIDE_MICRONS / np.hypot(*way.T))[:, None]
    places = start + LOOKS[:, None, None] * way + out
    closed = corners.reshape(-1, 3, 2)[:, [0, 1, 2, 0]].astype(np.float64)
    tree = shapely.STRtree(shapely.polygons(closed))
    inside = np.zeros(places.shape[0] * len(sides), dtype=np.bool_)
    inside[tree.query(shapely.points(places.reshape(-1, 2)), predicate="intersects")[0]] = True
    return sides[~inside.reshape(len(LOOKS), -1).all(axis=0)]


def places_of(corners: Ints) -> Ints:
    """(n,) numbers of different places; corners (n,2) whole coordinates."""
    return np.asarray(np.unique(corners[:, 0] << 32 | corners[:, 1] & 0xFFFFFFFF, return_inverse=True)[1].ravel())


def rings(corners: Ints, sides: Ints) -> list[list[int]]:
    """Sides of border_sides in closed rings, as numbers of corners. This loops over what is a border."""
    place = places_of(corners).tolist()
    leaving: dict[int, list[int]] = {}
    for number, (start, _) in enumerate(sides.tolist()):
        leaving.setdefault(place[start], []).append(number)
    ends = sides.tolist()
    found = []
    for place_, open_ in leaving.items():
        while open_:
            ring, at = [], place_
            while leaving.get(at):
                start, end = ends[leaving[at].pop()]
                ring.append(start)
                at = place[end]
            found.append(ring)
    return found


def skirts(corners: Ints, sides: Ints) -> Floats:
    """(s,4,2) rectangles outside along sides, longer than these; the first and the last corner belong to the start."""
    start, end = corners[sides[:, 0]].astype(np.float64), corners[sides[:, 1]].astype(np.float64)
    way = end - start
    way *= REACH_MICRONS / np.hypot(way[:, 0], way[:, 1])[:, None]
    out = np.stack((way[:, 1], -way[:, 0]), axis=1)
    return np.stack((start - way, end + way, end + way + out, start - way + out), axis=1)
