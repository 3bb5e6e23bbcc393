"""Sight rays that pass plane surfaces of transparent material, and where points are seen through them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.effects.refraction import seen_in_surface
from vectorplot.geometry.mesh import Bools, Floats
from vectorplot.geometry.viewing import basis_of
from vectorplot.scene.view import View

MOST_STEPS = 40
"""Newton's iteration ends after so many steps: from straight rays it usually takes five."""

DIFFERENCE = 1e-6
"""Step in the image over which derivatives are taken as differences, in units of the view."""

ACROSS, ALONG = np.array([[[DIFFERENCE], [0.0]], [[0.0], [DIFFERENCE]]])
"""The two of them."""

SETTLED = 1e-14
"""Rays that a step moves by less, in units of the image, have been found."""

SMALLEST_SHARE = 1e-3
"""Where no larger part of a step leads nearer, nothing does."""

LONGEST_STEP = 0.3
"""No step of the iteration in a perspective is longer, in units of the image."""

TOUCHING = 2.0
"""Points up to so many tolerances before the last surface count as behind it."""

PAIRS_AT_ONCE = 1 << 20
"""Pairs of points and guides compared at once."""

MET = 1e-10
"""A ray that misses its point by less than this part of the extent meets it."""


@dataclass(frozen=True, eq=False)
class Passage:
    """Plane surfaces that sight rays pass one after the other: normal, point (3,s), the normals pointing the way the
    rays go, constant (s,) of the refraction at each, for rays in that direction; guides (2,g): images of rays that pass
    them, at which the search for others may begin."""

    normal: Floats
    point: Floats
    constant: Floats
    guides: Floats = field(default_factory=lambda: np.zeros((2, 0)))

    def __len__(self) -> int:
        return len(self.constant)


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


def traced(view: View, passage: Passage, image: Floats) -> Rays:
    """The rays of points (2,n) of the image through a passage of one surface or more.

    Degenerate: rays that miss a surface, or are totally reflected there, do not pass; their numbers mean nothing.
    Source: Glaeser, section 6.6, equation 3.
    """
    place, direction = sight_rays(view, image)
    passes = np.ones(image.shape[1], dtype=np.bool_)
    path, index = np.zeros(image.shape[1]), 1.0
    entry = place
    for number in range(len(passage)):
        normal, point = passage.normal[:, number], passage.point[:, number]
        slope = normal @ direction
        onwards = slope > 0.0
        step = np.where(onwards, normal @ (point[:, None] - place) / np.where(onwards, slope, 1.0), 0.0)
        # Parallel rays have no beginning; behind the first surface, too, the others are thought without borders.
        passes &= onwards & ((step > 0.0) | (view.eye is None) | (number > 0))
        place = place + step * direction
        if number:
            path = path + step / index
        else:
            entry = place
        direction, total = _refracted(direction, normal, float(passage.constant[number]))
        passes &= ~total
        index *= float(passage.constant[number])
    return Rays(entry, place, direction, path, passes)


def _refracted(direction: Floats, normal: Floats, constant: float) -> tuple[Floats, Bools]:
    """What refraction.refracted does, for unit directions (3,n) towards the side of one unit normal (3,), many times
    as fast; directions of totally reflected rays mean nothing."""
    along = (direction - (normal @ direction) * normal[:, None]) / constant
    square = 1.0 - (along[0] * along[0] + along[1] * along[1] + along[2] * along[2])
    return along + np.sqrt(np.maximum(square, 0.0)) * normal[:, None], square < 0.0


def virtual_points(view: View, passage: Passage, points: Floats) -> tuple[Floats, Bools]:
    """(3,n) where points (3,n) behind a passage seem to be, and (n,) which are seen at all.

    A virtual point lies on the straight line on which the eye sees the point, and so far behind the first surface as
    light takes time to go there: what lies behind another point on a ray still does so. In a parallel projection the
    map is affine; rays of a perspective are found by Newton's iteration in the image.
    Degenerate: points that no ray through the surfaces, thought without borders, can reach are not seen.
    Source: Glaeser, section 6.6, equations 4 and 5 for one plane surface and for plates.
    """
    axes = basis_of(passage.normal[:, -1])
    image = _guesses(view, passage, axes, points)
    miss, rays, _ = _missed(view, passage, axes, points, image)
    off = np.where(rays.passes, np.hypot(*miss), np.inf)
    share = np.ones(points.shape[1])
    going = np.arange(points.shape[1])
    for _ in range(MOST_STEPS):
        here, there = image[:, going], points[:, going]
        off_here = miss[:, going]
        across, _, _ = _missed(view, passage, axes, there, here + ACROSS)
        along, _, _ = _missed(view, passage, axes, there, here + ALONG)
        step = _solved((across - off_here) / DIFFERENCE, (along - off_here) / DIFFERENCE, -off_here)
        length = np.sqrt((step * step).sum(axis=0))
        longest = np.inf if view.eye is None else LONGEST_STEP
        tried = here + step * np.minimum(share[going], longest / np.maximum(length, LONGEST_STEP))
        after, rays, _ = _missed(view, passage, axes, there, tried)
        # A step that leads farther off, or beyond total reflection, is halved.
        reached = np.where(rays.passes, np.hypot(*after), np.inf)
        better = (reached < off[going]) | np.isinf(off[going]) | (length <= SETTLED)
        image[:, going], miss[:, going] = np.where(better, tried, here), np.where(better, after, off_here)
        off[going] = np.where(better, reached, off[going])
        share[going] = np.where(better, np.minimum(2.0 * share[going], 1.0), 0.5 * share[going])
        going = going[(length > SETTLED) & (share[going] > SMALLEST_SHARE)]
        if not len(going):
            break
    miss, rays, left = _missed(view, passage, axes, points, image)
    behind = left * (passage.normal[:, -1] @ rays.direction) >= -TOUCHING * view.tolerance
    seen = rays.passes & (np.abs(miss).max(axis=0) <= MET) & behind
    sight = sight_rays(view, image)[1]
    return rays.entry + (rays.path + left / float(np.prod(passage.constant))) * sight, seen


def _guesses(view: View, passage: Passage, axes: Floats, points: Floats) -> Floats:
    """(2,n) images of rays that come near to points, or meet them: through one surface the rays are known; otherwise of
    the nearest guides, and of the straight line where there are none."""
    count = passage.guides.shape[1]
    if view.eye is not None and len(passage) == 1:
        normal, corner = passage.normal[:, 0], passage.point[:, 0]
        below = points - np.minimum(normal @ (points - corner[:, None]), 0.0) * normal[:, None]
        return view.image_of(seen_in_surface(view.eye, below.T, -normal, corner, float(passage.constant[0])).T)
    if not count or view.eye is None:
        return view.image_of(points)
    rays = traced(view, passage, passage.guides)
    normal = passage.normal[:, -1]
    rate = axes[:2] @ (rays.direction / (normal @ rays.direction))
    start, height = axes[:2] @ rays.place, normal @ rays.place
    nearest = np.empty(points.shape[1], dtype=np.intp)
    for low in range(0, points.shape[1], PAIRS_AT_ONCE // count + 1):
        some = slice(low, low + PAIRS_AT_ONCE // count + 1)
        rise = (normal @ points[:, some])[:, None] - height
        place = axes[:2] @ points[:, some]
        off = [start[k] + rate[k] * rise - place[k][:, None] for k in (0, 1)]
        nearest[some] = (off[0] * off[0] + off[1] * off[1]).argmin(axis=1)
    return np.asarray(passage.guides[:, nearest])


def _missed(view: View, passage: Passage, axes: Floats, points: Floats, image: Floats) -> tuple[Floats, Rays, Floats]:
    """By how much (2,n) rays miss points, measured along the last surface; the rays, and how far behind it the points
    are, along the rays."""
    rays = traced(view, passage, image)
    normal = passage.normal[:, -1]
    slope = normal @ rays.direction
    left = normal @ (points - rays.place) / np.where(slope > 0.0, slope, 1.0)
    return axes[:2] @ (rays.place + left * rays.direction - points), rays, left


def _solved(first: Floats, second: Floats, right: Floats) -> Floats:
    """(2,n) solutions of pairs of equations with the columns first and second; 0 where there is none."""
    whole = first[0] * second[1] - second[0] * first[1]
    safe = np.where(whole != 0.0, whole, 1.0)
    x, y = right[0] * second[1] - second[0] * right[1], first[0] * right[1] - right[0] * first[1]
    return np.where(whole != 0.0, np.stack([x, y]) / safe, 0.0)
