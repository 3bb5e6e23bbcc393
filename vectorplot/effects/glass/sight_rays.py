"""Sight rays that pass plane surfaces of transparent material, and where points are seen through them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.glass.refraction import seen_in_surface
from vectorplot.geometry.columns import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import MET_OF_EXTENT, SETTLED_OF_EXTENT, SIGHT_DIFFERENCE, SIGHT_SETTLED
from vectorplot.tolerances.of_lengths import SMALLEST_STEP_SHARE

MOST_STEPS = 40
"""Newton's iteration ends after so many steps: from straight rays it usually takes five."""

ACROSS, ALONG = np.array([[[SIGHT_DIFFERENCE], [0.0]], [[0.0], [SIGHT_DIFFERENCE]]])
"""The two of them."""

LONGEST_STEP = 0.3
"""No step of the iteration in a perspective is longer, in units of the image."""

TOUCHING = 2.0
"""Points up to so many tolerances before the last surface count as behind it."""

PAIRS_AT_ONCE = 1 << 20
"""Pairs of points and guides compared at once."""

POINTS_AT_ONCE = 1 << 15
"""Points whose rays are looked for at once: few enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class SightWays:
    """Ways of sight rays through plane surfaces, one after the other: normal, point (3,s,w) of s surfaces on w ways,
    the normals pointing the way the rays go; constant (s,) of the refraction at each, for rays in that direction;
    guides (2,w,g): images of rays that pass them, at which the search for others may begin, NaN where there is none."""

    normal: Floats
    point: Floats
    constant: Floats
    guides: Floats = field(default_factory=lambda: np.zeros((2, 1, 0)))

    def __len__(self) -> int:
        return int(self.normal.shape[2])

    def of(self, way: Ints) -> SightWays:
        """The ways of some rays; a single way stays the only one of all."""
        if len(self) == 1:
            return self
        return replace(self, normal=self.normal[:, :, way], point=self.point[:, :, way])


@dataclass(frozen=True, eq=False)
class Rays:
    """Sight rays behind a passage: entry (3,n) where they meet its first surface, place (3,n) its last one; direction
    (3,n) behind it; path (n,) between the two, each part divided by the constant of its material; passes (n,): whether
    the ray gets there at all."""

    entry: Floats
    place: Floats
    direction: Floats
    path: Floats
    passes: Bools


def sight_rays(view: View, image: Floats) -> tuple[Floats, Floats]:
    """Starting points and unit directions (3,n) of the rays through points (2,n) of the image."""
    if view.eye is None:
        start = np.concatenate([image + view.target[:2, None], np.zeros((1, image.shape[1]))])
        return start, np.tile([[0.0], [0.0], [-1.0]], image.shape[1])
    x, y = image / view.focus
    away = -1.0 / np.sqrt(1.0 + x * x + y * y)
    return np.tile(view.eye[:, None], image.shape[1]), np.stack([-x * away, -y * away, away])


def traced(view: View, sight_ways: SightWays, image: Floats) -> Rays:
    """The rays of points (2,n) of the image, each on the way of its number, or all on the only one.

    Degenerate: rays that miss a surface, or are totally reflected there, do not pass; their numbers mean nothing.
    Source: Glaeser, section 6.6, equation 3.
    """
    place, direction = sight_rays(view, image)
    passes = np.ones(image.shape[1], dtype=np.bool_)
    path, index = np.zeros(image.shape[1]), 1.0
    entry = place
    for number, constant in enumerate(sight_ways.constant.tolist()):
        normal, point = sight_ways.normal[:, number], sight_ways.point[:, number]
        slope = dot(normal, direction)
        onwards = slope > 0.0
        step = np.where(onwards, dot(normal, point - place) / np.where(onwards, slope, 1.0), 0.0)
        # Parallel rays have no beginning; behind the first surface, too, the others are thought without borders.
        passes &= onwards & ((step > 0.0) | (view.eye is None) | (number > 0))
        place = place + step * direction
        if number:
            path = path + step / index
        else:
            entry = place
        direction, total = _refracted(direction, normal, slope, constant)
        passes &= ~total
        index *= constant
    return Rays(entry, place, direction, path, passes)


def _refracted(direction: Floats, normal: Floats, slope: Floats, constant: float) -> tuple[Floats, Bools]:
    """What refraction.refracted does, for unit directions (3,n) towards the side of unit normals (3,n), or one for all,
    many times as fast; directions of totally reflected rays mean nothing."""
    along = (direction - slope * normal) / constant
    square = 1.0 - dot(along, along)
    return along + np.sqrt(np.maximum(square, 0.0)) * normal, square < 0.0


def virtual_points(view: View, sight_ways: SightWays, points: Floats, way: Ints | None = None) -> tuple[Floats, Bools]:
    """(3,n) where points (3,n) behind ways seem to be, and (n,) which are seen at all.

    way (n,): which of the ways light takes from each point (None: there is one only).
    A virtual point lies on the straight line on which the eye sees the point, and so far behind the first surface as
    light takes time to go there: what lies behind another point on a ray still does so. In a parallel projection the
    map is affine; rays of a perspective are found by Newton's iteration in the image.
    Degenerate: points that no ray through the surfaces, thought without borders, can reach are not seen.
    Source: Glaeser, section 6.6, equations 4 and 5 for one plane surface and for plates.
    """
    way = np.zeros(points.shape[1], dtype=np.intp) if way is None else way
    found, seen = np.empty_like(points), np.empty(points.shape[1], dtype=np.bool_)
    guided = _Guides.of(view, sight_ways)
    for low in range(0, points.shape[1], POINTS_AT_ONCE):
        some = slice(low, low + POINTS_AT_ONCE)
        own, there = sight_ways.of(way[some]), points[:, some]
        frame = np.broadcast_to(_frames(own.normal[:, -1]), (2, 3, there.shape[1]))
        image = _met(view, own, frame, there, _guesses(view, own, there, guided, way[some]))
        miss, rays, left = _missed(view, own, frame, there, image)
        behind = left * dot(own.normal[:, -1], rays.direction) >= -TOUCHING * view.tolerance
        seen[some] = rays.passes & (np.abs(miss).max(axis=0) <= MET_OF_EXTENT) & behind
        sight = sight_rays(view, image)[1]
        found[:, some] = rays.entry + (rays.path + left / float(np.prod(sight_ways.constant))) * sight
    return found, seen


def _met(view: View, sight_ways: SightWays, frame: Floats, points: Floats, image: Floats) -> Floats:
    """(2,n) the images of the rays that meet points (3,n), each on its way, by Newton's iteration from some (2,n)."""
    miss, rays, _ = _missed(view, sight_ways, frame, points, image)
    off = np.where(rays.passes, np.hypot(*miss), np.inf)
    share = np.ones(points.shape[1])
    going = np.flatnonzero(~(off <= SETTLED_OF_EXTENT))
    for _ in range(MOST_STEPS):
        if not len(going):
            break
        own, axes = sight_ways.of(going), frame[:, :, going]
        here, there, off_here = image[:, going], points[:, going], miss[:, going]
        # Both at once: of few points a ray takes no time, and a call of numpy's does.
        beside = np.concatenate([here + ACROSS, here + ALONG], axis=1)
        twice = np.tile(np.arange(len(going)), 2)
        both, _, _ = _missed(view, own.of(twice), axes[:, :, twice], there[:, twice], beside)
        across, along = both[:, : len(going)], both[:, len(going) :]
        step = _solved((across - off_here) / SIGHT_DIFFERENCE, (along - off_here) / SIGHT_DIFFERENCE, -off_here)
        length = np.sqrt((step * step).sum(axis=0))
        longest = np.inf if view.eye is None else LONGEST_STEP
        tried = here + step * np.minimum(share[going], longest / np.maximum(length, LONGEST_STEP))
        after, rays, _ = _missed(view, own, axes, there, tried)
        # A step that leads farther off, or beyond total reflection, is halved.
        reached = np.where(rays.passes, np.hypot(*after), np.inf)
        better = (reached < off[going]) | np.isinf(off[going]) | (length <= SIGHT_SETTLED)
        image[:, going], miss[:, going] = np.where(better, tried, here), np.where(better, after, off_here)
        off[going] = np.where(better, reached, off[going])
        share[going] = np.where(better, np.minimum(2.0 * share[going], 1.0), 0.5 * share[going])
        going = going[
            (length > SIGHT_SETTLED) & (share[going] > SMALLEST_STEP_SHARE) & ~(off[going] <= SETTLED_OF_EXTENT)
        ]
    return image


@dataclass(frozen=True, eq=False)
class _Guides:
    """Rays behind their ways: image (2,w,g), start and rate (2,w,g) across the frame of the last surface, the rate
    per unit of height, and height (w,g) where they start."""

    image: Floats
    start: Floats
    rate: Floats
    height: Floats

    @classmethod
    def of(cls, view: View, sight_ways: SightWays) -> _Guides | None:
        """The guides of ways, if they have any."""
        _, ways, count = sight_ways.guides.shape
        if not count or view.eye is None:
            return None
        own = sight_ways.of(np.repeat(np.arange(ways), count))
        rays = traced(view, own, sight_ways.guides.reshape(2, -1))
        normal = own.normal[:, -1]
        frame = _frames(normal)
        direction = rays.direction / dot(normal, rays.direction)
        start, rate = (np.stack([dot(axis, some) for axis in frame]) for some in (rays.place, direction))
        shape = (2, ways, count)
        height = dot(normal, rays.place).reshape(ways, count)
        return cls(sight_ways.guides, start.reshape(shape), rate.reshape(shape), height)

    def nearest(self, sight_ways: SightWays, points: Floats, way: Ints) -> Floats:
        """(2,n) the images of those that come nearest to points (3,n) on their ways; NaN where a way has none."""
        normal = sight_ways.normal[:, -1]
        high = dot(normal, points)
        place = np.stack([dot(axis, points) for axis in _frames(normal)])
        found = np.empty((2, points.shape[1]))
        step = PAIRS_AT_ONCE // self.image.shape[2] + 1
        for low in range(0, points.shape[1], step):
            some = slice(low, low + step)
            own = way[some]
            rise = high[some, None] - self.height[own]
            off = [self.start[k, own] + self.rate[k, own] * rise - place[k, some, None] for k in (0, 1)]
            square = off[0] * off[0] + off[1] * off[1]
            best = np.where(np.isnan(square), np.inf, square).argmin(axis=1)
            found[:, some] = self.image[:, own, best]
        return found


def _guesses(view: View, sight_ways: SightWays, points: Floats, guides: _Guides | None, way: Ints) -> Floats:
    """(2,n) images of rays that come near to points, or meet them: through one surface the rays are known; otherwise of
    the nearest guides, and of the straight line where there are none."""
    if view.eye is not None and len(sight_ways.constant) == 1:
        normal, corner = sight_ways.normal[:, 0], sight_ways.point[:, 0]
        below = points - np.minimum(dot(normal, points - corner), 0.0) * normal
        constant = float(sight_ways.constant[0])
        return view.image_of(seen_in_surface(view.eye, below.T, -normal.T, corner.T, constant).T)
    straight = view.image_of(points)
    if guides is None:
        return straight
    found = guides.nearest(sight_ways, points, way)
    return np.where(np.isnan(found), straight, found)


def _missed(
    view: View, sight_ways: SightWays, frame: Floats, points: Floats, image: Floats
) -> tuple[Floats, Rays, Floats]:
    """By how much (2,n) rays miss points, measured along the last surface; the rays, and how far behind it the points
    are, along the rays."""
    rays = traced(view, sight_ways, image)
    normal = sight_ways.normal[:, -1]
    slope = dot(normal, rays.direction)
    left = dot(normal, points - rays.place) / np.where(slope > 0.0, slope, 1.0)
    off = rays.place + left * rays.direction - points
    return np.stack([dot(frame[0], off), dot(frame[1], off)]), rays, left


def _frames(normal: Floats) -> Floats:
    """(2,3,n) two unit vectors normal to each other and to unit normals (3,n)."""
    axis = np.eye(3)[:, np.abs(normal).argmin(axis=0)]
    first = np.cross(axis, normal, axis=0)
    first /= np.sqrt(dot(first, first))
    return np.stack([first, np.cross(normal, first, axis=0)])


def _solved(first: Floats, second: Floats, right: Floats) -> Floats:
    """(2,n) solutions of pairs of equations with the columns first and second; 0 where there is none."""
    whole = first[0] * second[1] - second[0] * first[1]
    safe = np.where(whole != 0.0, whole, 1.0)
    x, y = right[0] * second[1] - second[0] * right[1], first[0] * right[1] - right[0] * first[1]
    return np.where(whole != 0.0, np.stack([x, y]) / safe, 0.0)
