"""Polygons as they are seen through refracting surfaces: cut until straight sides will do."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.glass.sight_rays import SightWays, virtual_points
from vectorplot.geometry import polylines, ragged, records
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import over_corners

BLIND_ROUNDS = 2
"""Polygons of which no corner is seen are halved that often: there may be something in their midst."""

MOST_ROUNDS = 7
"""Sides of bent polygons are halved at most so many times; what then still reaches beyond the border of total
reflection is left out."""

MOST_TRIANGLES = 1 << 18
"""No bent polygons are halved any more when there are so many pieces."""

INNER = 4.0
"""Sides between two parts of one polygon, which nobody sees, may be so many times as far off as its outline."""


@dataclass(frozen=True, eq=False)
class Soup:
    """Convex polygons: points (3,c) in the view, offsets (n+1,), source (n,) the faces of the view, or whatever else,
    that they are of, way (n,) the way on which light takes from each to the eye."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    source: Ints = field(metadata=EACH_LINE)
    way: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.source)

    def some(self, which: Ints) -> Soup:
        """Some of the polygons."""
        return polylines.some(self, which)

    def on_ways(self, polygon: Ints, way: Ints) -> Soup:
        """Polygons (n,), each on a way (n,) of its own."""
        return replace(self.some(polygon), way=way)


def joined_soups(parts: list[Soup]) -> Soup:
    """The polygons of all."""
    none = np.zeros(0, dtype=np.intp)
    return polylines.joined((Soup(np.zeros((3, 0)), ragged.offsets(none), none, none), *parts))


def bent(view: View, sight_ways: SightWays, soup: Soup, windows: Floats, tolerance: float) -> Soup:
    """Polygons with virtual corners; in a perspective cut into triangles until their sides are straight enough.

    windows (4,w): smallest and largest x, smallest and largest y of what is looked at on each way. tolerance: how far
    sides of the polygons may be off the curves that they stand for, in units of the image.
    Left out are polygons with corners that are not seen, and triangles beside the windows.
    """
    if not len(soup):
        return soup
    if view.eye is None:
        return _moved(view, sight_ways, soup, windows)
    going = _fans(soup)
    done = []
    for number in range(MOST_ROUNDS + 1):
        points, seen = going.virtual(view, sight_ways)
        off, near = _bends(view, points, seen, windows[:, going.way])
        partly = ~seen.all(axis=0)
        hopeful = seen.any(axis=0) | (number < BLIND_ROUNDS)
        halved = (partly & hopeful) | (~partly & (off > tolerance * np.where(going.outer, 1.0, INNER)))
        halved &= near & (number < MOST_ROUNDS) & (len(going.way) <= MOST_TRIANGLES // 4)
        whole = ~halved.any(axis=0)
        fine = np.flatnonzero(whole & seen[:3].all(axis=0) & near)
        done.append(_as_soup(points[:, :3, fine], going.source[fine], going.way[fine]))
        going = going.halved(np.flatnonzero(~whole), halved)
        if not len(going.way):
            break
    return joined_soups(done)


@dataclass(frozen=True, eq=False)
class _Triangles:
    """Triangles: corners (3,3,t): coordinate, corner, triangle; outer (3,t): whether the side that begins at each
    corner is part of the outline of a polygon; source, way (t,) as of Soup."""

    corners: Floats = field(metadata=IN_COLUMNS)
    outer: Bools = field(metadata=IN_COLUMNS)
    source: Ints
    way: Ints

    def with_middles(self) -> Floats:
        """(3,6,t) the corners and then the middles of the sides that begin there."""
        return np.concatenate([self.corners, 0.5 * (self.corners + np.roll(self.corners, -1, axis=1))], axis=1)

    def virtual(self, view: View, sight_ways: SightWays) -> tuple[Floats, Bools]:
        """(3,6,t) where the corners and middles seem to be, and (6,t) which are seen."""
        points, seen = virtual_points(view, sight_ways, self.with_middles().reshape(3, -1), np.tile(self.way, 6))
        return points.reshape(3, 6, -1), seen.reshape(6, -1)

    def halved(self, which: Ints, sides: Bools) -> _Triangles:
        """What some (n,) of the triangles are cut into where sides (3,t) are to be halved."""
        count = sides[:, which].sum(axis=0)
        # Turned so that one halved side comes first, and of two the second one second.
        turn = np.where(count == 2, (sides[:, which].argmin(axis=0) + 1) % 3, sides[:, which].argmax(axis=0))
        order = (turn + np.arange(3)[:, None]) % 3
        points, outer = self.with_middles()[:, np.concatenate([order, order + 3]), which], self.outer[order, which]
        parts = []
        for number, pieces in PIECES.items():
            own = np.flatnonzero(count == number)
            from_side = np.concatenate([outer[:, own], np.zeros((1, len(own)), dtype=np.bool_)])
            for corner, side in pieces:
                parts.append(
                    _Triangles(
                        points[:, list(corner)][:, :, own],
                        from_side[list(side)],
                        self.source[which[own]],
                        self.way[which[own]],
                    )
                )
        return records.joined(parts)


PIECES = {
    1: (((0, 3, 2), (0, 3, 2)), ((3, 1, 2), (0, 1, 3))),
    2: (((3, 1, 4), (0, 1, 3)), ((0, 3, 4), (0, 3, 3)), ((0, 4, 2), (3, 1, 2))),
    3: (((0, 3, 5), (0, 3, 2)), ((3, 1, 4), (0, 1, 3)), ((5, 4, 2), (3, 1, 2)), ((3, 4, 5), (3, 3, 3))),
}
"""The parts of a triangle with 1, 2 or 3 halved sides, the first ones: their corners, of its own and the middles of its
sides; and of which of its sides their sides are parts: 3 stands for none."""


def _fans(soup: Soup) -> _Triangles:
    """Triangles from the first corners of polygons."""
    corner, owner = ragged.fans(soup.offsets)
    inner = np.zeros(len(owner), dtype=np.bool_)
    same = owner[1:] == owner[:-1]
    outer = np.stack([~np.append(inner[:1], same), ~inner, ~np.append(same, inner[:1])])
    return _Triangles(soup.points[:, corner.T], outer, soup.source[owner], soup.way[owner])


def _as_soup(corners: Floats, source: Ints, way: Ints) -> Soup:
    points = corners.transpose(0, 2, 1).reshape(3, -1)
    return Soup(points, np.arange(0, points.shape[1] + 1, 3), source, way)


def _moved(view: View, sight_ways: SightWays, soup: Soup, windows: Floats) -> Soup:
    """Polygons as they are seen in a parallel projection: they keep straight sides."""
    sizes = np.diff(soup.offsets)
    points, seen = virtual_points(view, sight_ways, soup.points, np.repeat(soup.way, sizes))
    image = view.image_of(points)
    box = np.stack([over_corners(e, row, soup.offsets) for row in image for e in (np.minimum, np.maximum)])
    kept = np.logical_and.reduceat(seen, soup.offsets[:-1]) & _meet(box, windows[:, soup.way])
    return Soup(points, soup.offsets, soup.source, soup.way).some(np.flatnonzero(kept))


def _bends(view: View, points: Floats, seen: Bools, windows: Floats) -> tuple[Floats, Bools]:
    """(3,n) how far the middles of the sides of triangles (3,6,n), corners and then middles, are off the straight lines
    in the image, and (n,) whether the triangles may be seen in windows (4,n).

    Of triangles that are seen (6,n) only partly, what is not is taken to be no farther off than they are wide.
    """
    image = view.image_of(points.reshape(3, -1)).reshape(2, 6, -1)
    off = image[:, 3:] - 0.5 * (image[:, :3] + np.roll(image[:, :3], -1, axis=1))
    bend = np.sqrt((off * off).sum(axis=0))
    low = np.where(seen, image, np.inf).min(axis=1)
    high = np.where(seen, image, -np.inf).max(axis=1)
    margin = np.where(seen.all(axis=0), bend.max(axis=0), (high - low).max(axis=0))
    box = np.stack([low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin])
    return bend, _meet(box, windows) | ~seen.any(axis=0)


def _meet(box: Floats, windows: Floats) -> Bools:
    """(n,) which rectangles (4,n), smallest and largest x, smallest and largest y, meet others (4,n)."""
    across = (box[1] >= windows[0]) & (box[0] <= windows[1])
    return np.asarray(across & (box[3] >= windows[2]) & (box[2] <= windows[3]), dtype=np.bool_)
