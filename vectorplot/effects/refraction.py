"""Refraction at plane surfaces: Snell's law, sight rays, virtual points, and polygons seen through them.

Source: Glaeser, section 6.6, figure 11.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import polylines, ragged, records
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.elementary import arcsin, arctan, tan
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.vectors import normalize
from vectorplot.scene.view import View
from vectorplot.tolerances import (
    IN_SURFACE_OF_DISTANCE,
    MET_OF_EXTENT,
    ROUNDING,
    SETTLED_OF_EXTENT,
    SIGHT_DIFFERENCE,
    SIGHT_SETTLED,
    SMALLEST_STEP_SHARE,
    ULP,
)
from vectorplot.visibility.painter.image_faces import over_corners

# Light that enters and leaves transparent material: Snell's law in the plane and in space, and its inversion.
#
# The constant c of a refraction is sin(alpha) / sin(beta), alpha the angle between ray and normal on the side the ray
# comes from, beta on the other side: about 4/3 for a ray that enters water, 3/4 for one that leaves it.

MOST_STEPS = 100
"""Newton's iteration for a ray from point to point ends after so many steps; it has never been seen to take 40."""


def angle_of_refraction(alpha: ArrayLike, c: ArrayLike) -> Floats:
    """The angle beta between a refracted ray and the normal, of which sin(alpha) = c sin(beta).

    Parameters
    ----------
    alpha : (...) array_like of float
        The angle between ray and normal on the side that the ray comes from, in radians.
    c : (...) array_like of float
        The constant of Snell's law, about 4/3 for rays into water and 3/4 for those out of it.

    Returns
    -------
    (...) array of float
        In radians; NaN where the ray is totally reflected.

    Raises
    ------
    InputError
        For a constant that is not positive and finite.

    Notes
    -----
    Source: Glaeser, section 6.6, equation 3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> beta = effects.angle_of_refraction(np.radians([0.0, 30.0, 60.0]), 4 / 3)
    >>> np.degrees(beta).round(2).tolist()
    [0.0, 22.02, 40.51]
    >>> np.isnan(effects.angle_of_refraction(np.radians(60.0), 3 / 4)).item()
    True
    """
    sine = np.sin(np.asarray(alpha, dtype=np.float64)) / _constant(c)
    beta = arcsin(np.clip(sine, -1.0, 1.0))
    return np.asarray(np.where(np.abs(sine) <= 1.0, beta, np.nan))


def plate_shift(alpha: ArrayLike, thickness: ArrayLike, c: ArrayLike) -> Floats:
    """How far a plane-parallel plate shifts a ray, measured along the plate: a (tan(alpha) - tan(beta)).

    Parameters
    ----------
    alpha : (...) array_like of float
        The angle of incidence, in radians.
    thickness : (...) array_like of float
        Of the plate, in world units: the a of the equation.
    c : (...) array_like of float
        See angle_of_refraction, for rays into the plate.

    Returns
    -------
    (...) array of float
        In the units of the thickness; NaN where the ray does not enter.

    Raises
    ------
    InputError
        For a constant that is not positive and finite.

    Notes
    -----
    The ray leaves the plate in its old direction; across itself it is shifted by cos(alpha) times this.

    Source: Glaeser, section 6.6, equation 4, figure 11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> effects.plate_shift(np.radians([0.0, 45.0]), 10.0, 1.5).round(3).tolist()
    [0.0, 4.655]
    """
    alpha = np.asarray(alpha, dtype=np.float64)
    beta = angle_of_refraction(alpha, c)
    return np.asarray(np.asarray(thickness, dtype=np.float64) * (tan(alpha) - tan(beta)))


def refracted(directions: ArrayLike, normals: ArrayLike, c: ArrayLike) -> tuple[Floats, Bools]:
    """The directions of rays behind surfaces with some normals.

    Parameters
    ----------
    directions : (..., 3) array_like of float
        Of the rays, of any length.
    normals : (..., 3) array_like of float
        Of the surfaces, of any length, to either side.
    c : (...) array_like of float
        See angle_of_refraction, for rays in these directions.

    Returns
    -------
    (..., 3) array of float
        Unit vectors.
    (...) array of bool
        Which rays are totally reflected: these get the direction in which they go on.

    Raises
    ------
    InputError
        For vectors without length and constants that are not positive and finite.

    Notes
    -----
    Source: Glaeser, section 6.6, equation 3; section 8.5, equation 30.

    Examples
    --------
    >>> from vectorplot import effects
    >>> into_water, reflected = effects.refracted((1, 0, -1), (0, 0, 1), 4 / 3)
    >>> into_water.round(3).tolist(), reflected.item()
    ([0.53, 0.0, -0.848], False)
    >>> back, reflected = effects.refracted((2, 0, 1), (0, 0, 1), 3 / 4)
    >>> back.round(3).tolist(), reflected.item()
    ([0.894, 0.0, -0.447], True)
    """
    d, n, c = normalize(directions), normalize(normals), _constant(c)[..., None]
    height = (d * n).sum(axis=-1, keepdims=True)
    along = (d - height * n) / c
    square = 1.0 - (along * along).sum(axis=-1, keepdims=True)
    total = square < 0.0
    through = along + np.copysign(np.sqrt(np.maximum(square, 0.0)), height) * n
    result = np.where(total, d - 2.0 * height * n, normalize(through))
    return np.asarray(result), np.asarray(total[..., 0], dtype=np.bool_)


def tangents_of_rays(p1: ArrayLike, p2: ArrayLike, a: ArrayLike, c: ArrayLike) -> tuple[Floats, Floats]:
    """(...) tan(alpha) and tan(beta) of the ray from a point below a plane surface to an eye above it: (p2 - a)
    tan(alpha) + a tan(beta) = p1 to a few rounding steps. p1: distance of eye and point along the surface; p2:
    height of the eye above the point; a: depth of the point; c: constant of rays from the eye into the water.
    Edge cases: an eye right above looks straight down; a point in the surface is seen in place or, from the denser
    side, at the angle of total reflection if smaller. Errors: InputError for numbers not finite, a < 0, p2 <= a, c <=
    0. Source: Glaeser, section 6.6, equations 4 and 5; erratum G6-11.
    """
    p1, p2, a, c = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (p1, p2, a, c)))
    above = p2 - a
    if not (np.isfinite(p1).all() and np.isfinite(p2).all() and (a >= 0.0).all() and (above > 0.0).all()):
        raise InputError("a ray into the water needs finite distances, a depth >= 0 and an eye above the surface")
    c = _constant(c)
    # By the tangent t on the thinner side, where it is the larger one, the equation is concave for t > 0: Newton's
    # iteration from 0 climbs to the zero and never passes it.
    swap = c < 1.0
    ratio = np.where(swap, 1.0 / c, c)
    target = np.abs(p1)
    near, far = np.where(swap, a, above), np.where(swap, above, a)
    near = np.maximum(near, IN_SURFACE_OF_DISTANCE * (far + target))
    t = np.zeros(target.shape)
    error_ratio = (ratio - 1.0) * (ratio + 1.0)
    for _ in in_turn(range(MOST_STEPS)):
        root = np.sqrt(ratio * ratio + error_ratio * t * t)
        slope = near + far * (ratio / root) ** 2 / root
        step = (target - near * t - far * t / root) / slope
        before, t = t, np.maximum(t + step, t)
        if (t - before <= ULP * t).all():
            break
    other = t / np.sqrt(ratio * ratio + error_ratio * t * t)
    sign = np.sign(p1)
    return np.asarray(sign * np.where(swap, other, t)), np.asarray(sign * np.where(swap, t, other))


def inverse_refraction(p1: ArrayLike, p2: ArrayLike, a: ArrayLike, c: ArrayLike) -> Floats:
    """The angles of incidence at which an eye above a plane surface sees points below it.

    Parameters
    ----------
    p1 : (...) array_like of float
        How far the eye is from the point, measured along the surface.
    p2 : (...) array_like of float
        How high the eye is above the point.
    a : (...) array_like of float
        How deep the point is below the surface, so that the eye is p2 - a above it.
    c : (...) array_like of float
        See angle_of_refraction, for rays from the eye into the water.

    Returns
    -------
    (...) array of float
        The angle alpha between ray and normal on the eye's side, in radians.

    Raises
    ------
    InputError
        For numbers that are not finite, a < 0 or p2 <= a, and constants that are not positive and finite.

    Notes
    -----
    (p2 - a) tan(alpha) + a tan(beta) = p1 to a few rounding steps.

    Edge cases: an eye right above the point looks straight down; a point in the surface is seen where it is, or, from
    the denser side, at the angle of total reflection if that is smaller.

    Source: Glaeser, section 6.6, equations 4 and 5; erratum G6-11 (the equation is algebraic).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import effects
    >>> alpha = effects.inverse_refraction(p1=3.0, p2=4.0, a=2.0, c=4 / 3)
    >>> round(np.degrees(alpha).item(), 2)
    42.41
    >>> beta = effects.angle_of_refraction(alpha, 4 / 3)
    >>> round((2.0 * np.tan(alpha) + 2.0 * np.tan(beta)).item(), 9)
    3.0
    """
    return np.asarray(arctan(tangents_of_rays(p1, p2, a, c)[0]))


def seen_in_surface(eye: ArrayLike, points: ArrayLike, normal: ArrayLike, on_surface: ArrayLike, c: float) -> Floats:
    """Where in a plane surface an eye above it sees points that lie below it.

    Parameters
    ----------
    eye : (3,) array_like of float
        Above the surface.
    points : (n, 3) array_like of float
        Below it, or in it.
    normal : (3,) or (n, 3) array_like of float
        Of the surface, towards the eye, of any length.
    on_surface : (3,) or (n, 3) array_like of float
        A point of the plane, or one for each point.
    c : float
        See angle_of_refraction, for rays from the eye into the material.

    Returns
    -------
    (n, 3) array of float
        Points of the surface: the picture of the pool has them where their points are.

    Raises
    ------
    InputError
        For points above the surface, an eye that is not above it, coordinates that are not finite, a normal without
        length and a constant that is not positive and finite.

    Notes
    -----
    Edge cases: points above the surface by no more than rounding are in it; for those in it and right below the eye see
    inverse_refraction.

    Source: Glaeser, section 6.6, figure 12 (the swimming pool).

    Examples
    --------
    >>> from vectorplot import effects
    >>> coins = [(0, 0, -2), (3, 0, -2)]
    >>> effects.seen_in_surface((0, 0, 2), coins, (0, 0, 1), (0, 0, 0), 4 / 3).round(2).tolist()
    [[0.0, 0.0, 0.0], [1.83, 0.0, 0.0]]
    """
    n = normalize(normal)
    e, p, origin = (np.asarray(x, dtype=np.float64) for x in (eye, points, on_surface))
    high, deep = ((e - origin) * n).sum(axis=-1), -((p - origin) * n).sum(axis=-1)
    noise = ROUNDING * max(float(np.abs(x).max(initial=0.0)) for x in (e, p, origin))
    deep = np.where((deep < 0.0) & (deep >= -noise), 0.0, deep)
    arm = p - e
    along = arm + (high + deep)[:, None] * n
    far = np.sqrt((along * along).sum(axis=1))
    tangent, _ = tangents_of_rays(far, high + deep, deep, c)
    share = high * tangent / np.where(far > 0.0, far, 1.0)
    return np.asarray(e - high[..., None] * n + share[:, None] * along)


def _constant(c: ArrayLike) -> Floats:
    """The constants as an array. Errors: InputError where one is not positive and finite."""
    constant = np.asarray(c, dtype=np.float64)
    if not ((constant > 0.0) & (constant < np.inf)).all():
        raise InputError("the constant of a refraction must be a positive number")
    return constant


# Sight rays that pass plane surfaces of transparent material, and where points are seen through them.

MOST_RAY_STEPS = 40
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


PLACES = 8
"""At so many places on a segment, less one, it is looked whether it is seen behind two surfaces."""

SEEN_HALVINGS = 40
"""So often the way between two of them is halved until it is known where it is seen no more."""


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

    def with_guides_of(self, ways: Ints) -> SightWays:
        """A single way, that of the first of some (k,) that are the same but for their guides, which are those of
        all."""
        one = slice(ways[0], ways[0] + 1)
        guides = self.guides[:, ways].reshape(2, 1, -1)
        return replace(self, normal=self.normal[:, :, one], point=self.point[:, :, one], guides=guides)

    def virtual(self, view: View, points: Floats, way: Ints) -> tuple[Floats, Bools]:
        """As BentRays."""
        return virtual_points(view, self, points, way)

    def seen_parts(self, view: View, start: Floats, end: Floats) -> tuple[Ints, Floats, Floats]:
        """As BentRays. All behind one surface is seen; where rays leave by another one, ends of what is seen are found
        by halving between places on the way."""
        every = np.arange(start.shape[1])
        if len(self.constant) == 1:
            return every, start, end
        shares = np.linspace(0.0, 1.0, PLACES + 1)
        points = start[..., None] + shares * (end - start)[..., None]
        _, seen = self.virtual(view, points.reshape(3, -1), np.zeros(points[0].size, dtype=np.intp))
        seen = seen.reshape(-1, PLACES + 1)
        which, place = np.nonzero(seen[:, 1:] | seen[:, :-1])
        low, high = shares[place], shares[place + 1]
        at_low, at_high = seen[which, place], seen[which, place + 1]
        ends = np.flatnonzero(at_low != at_high)
        base, run = start[:, which[ends]], (end - start)[:, which[ends]]
        near, far = (
            np.where(at_low[ends], one, other) for one, other in ((low[ends], high[ends]), (high[ends], low[ends]))
        )

        def goes_on(way: Ints, share: Floats) -> Bools:
            part = near[way] + share * (far - near)[way]
            none = np.zeros(len(way), dtype=np.intp)
            return self.virtual(view, base[:, way] + part * run[:, way], none)[1]

        last, _ = bisected(goes_on, np.zeros(len(ends)), np.ones(len(ends)), SEEN_HALVINGS)
        until = near + last * (far - near)
        low[ends], high[ends] = np.minimum(near, until), np.maximum(near, until)
        begin, run = start[:, which], (end - start)[:, which]
        return which, begin + low * run, np.where(high < 1.0, begin + high * run, end[:, which])


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

    Edge cases: rays that miss a surface, or are totally reflected there, do not pass; their numbers mean nothing.
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
    """(3,n) where points (3,n) behind refracting surfaces seem to be, and (n,) which are seen at all. way (n,): the
    path of light of each point, None for a single one. A virtual point lies on the ray on which the eye sees the
    point, as far behind the first surface as light takes time, so depth order along a ray is kept. Parallel
    projections give an affine map; perspective rays are found by Newton's method.
    Edge cases: points that no ray reaches, even without borders, are not seen. Source: Glaeser, section 6.6, equations
    4 and 5.
    """
    way = np.zeros(points.shape[1], dtype=np.intp) if way is None else way
    found, seen = np.empty_like(points), np.empty(points.shape[1], dtype=np.bool_)
    guided = _Guides.of(view, sight_ways)
    for low in in_turn(range(0, points.shape[1], POINTS_AT_ONCE)):
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
    for _ in in_turn(range(MOST_RAY_STEPS)):
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


# Polygons as they are seen through refracting surfaces: cut until straight sides will do.

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
class Soup(LineElements):
    """Convex polygons: points (3,c) in the view, offsets (n+1,), source (n,) the faces of the view, or whatever else,
    that they are of, way (n,) the way on which light takes from each to the eye."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    source: Ints = field(metadata=EACH_LINE)
    way: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.source)

    def on_ways(self, polygon: Ints, way: Ints) -> Soup:
        """Polygons (n,), each on a way (n,) of its own."""
        return replace(self.take(polygon), way=way)


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
    for number in in_turn(range(MOST_ROUNDS + 1)):
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
    corner is part of the outline of a polygon; source, way (t,) as in Soup."""

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
    return Soup(points, soup.offsets, soup.source, soup.way).take(np.flatnonzero(kept))


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
