"""How two convex outlines lie on each other in the image, and which is nearer where they meet.

Depths are those after the projective map T2, which is linear along lines: both ends are mapped first, then interpolated
(erratum G6-05). The larger depth is nearer to the eye.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import cross


class Position(Enum):
    """How one convex outline lies on another.

    Examples
    --------
    >>> from vectorplot.textbook import Position
    >>> Position.CROSSING.value
    'the borders cross'
    >>> len(Position)
    4
    """

    DISJOINT = "no common inner points"
    CROSSING = "the borders cross"
    FIRST_IN_SECOND = "the first lies inside the second"
    SECOND_IN_FIRST = "the second lies inside the first"


@dataclass(frozen=True)
class RelativePosition:
    """The position of two outlines, and which of them is nearer.

    Parameters
    ----------
    position : Position
        How the first lies on the second.
    first_depth, second_depth : float
        The depths of the first and of the second at one common point of the image, where they differ most of all points
        looked at; NaN where there is none.

    Examples
    --------
    >>> from vectorplot.textbook import relative_position
    >>> low = [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    >>> far_off = [(5, 0, 3), (6, 0, 3), (6, 1, 3)]
    >>> relative_position(low, far_off)
    RelativePosition(position=<Position.DISJOINT: 'no common inner points'>, first_depth=nan, second_depth=nan)
    """

    position: Position
    first_depth: float
    second_depth: float


def in_convex_polygon(points: ArrayLike, polygon: ArrayLike) -> tuple[Bools, Floats]:
    """Which points lie inside a convex polygon or on its border, and the polygon's depth there.

    Parameters
    ----------
    points : (p, 2 or more) array_like of float
        x and y; further columns do not matter.
    polygon : (n, 3) array_like of float
        Corners of x, y and depth, wound either way.

    Returns
    -------
    (p,) array of bool
        Which points lie inside, or on the border.
    (p,) array of float
        The polygon's depth there, NaN outside.

    Raises
    ------
    InputError
        For fewer than three corners, or numbers that are not finite.

    Notes
    -----
    The chord from the first corner through a point leaves the polygon at a side; what lies on the chord is inside, and
    the depth on it is linear.

    Degenerate: a polygon without area contains nothing.

    Source: Glaeser, section 6.2, equations 1 and 2, figure 2; errata G6-05, G6-06.

    Examples
    --------
    >>> from vectorplot.textbook import in_convex_polygon
    >>> ramp = [(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)]
    >>> inside, depth = in_convex_polygon([(1, 2), (5, 2)], ramp)
    >>> inside.tolist(), depth.tolist()
    ([True, False], [1.0, nan])
    """
    corner, p = _checked(polygon), np.atleast_2d(np.asarray(points, dtype=np.float64))[:, :2]
    arm, out = corner[1:, :2] - corner[0, :2], p - corner[0, :2]
    side = arm[1:] - arm[:-1]
    turn = cross(arm[:-1], side)
    # A sector of the fan holds the point where it is between its two arms: half-open, so that none is missed.
    sign = 1.0 if turn.sum() > 0.0 else -1.0
    from_first, from_second = (sign * cross(a[None], out[:, None]) for a in (arm[:-1], arm[1:]))
    within = (from_first >= 0.0) & (from_second <= 0.0) & (sign * turn > 0.0)
    length = cross(out[:, None], side[None])
    # The side is met at out / share.
    share = np.where(within, length / np.where(turn != 0.0, turn, 1.0), np.inf)
    sector = share.argmin(axis=1)
    pick = np.arange(len(p))
    inside = share[pick, sector] <= 1.0
    along = cross(arm[:-1][sector], out) / np.where(length[pick, sector] != 0.0, length[pick, sector], 1.0)
    leaving = corner[1:-1, 2][sector] + along * (corner[2:, 2] - corner[1:-1, 2])[sector]
    depth = corner[0, 2] + np.where(inside, share[pick, sector], 0.0) * (leaving - corner[0, 2])
    return inside, np.where(inside, depth, np.nan)


def relative_position(first: ArrayLike, second: ArrayLike) -> RelativePosition:
    """How two convex outlines lie on each other.

    Parameters
    ----------
    first : (n, 3) array_like of float
        Corners of x, y and depth, wound either way.
    second : (m, 3) array_like of float
        The same.

    Returns
    -------
    RelativePosition
        With the depths of both where they differ most.

    Raises
    ------
    InputError
        For fewer than three corners, or numbers that are not finite.

    Notes
    -----
    The depths are compared where the borders cross and at corners of one inside the other; of these points that one
    counts where they differ most, so that a difference that rounding could make is told by another.

    Degenerate: outlines that only touch are disjoint; of two in the same place the first lies inside the second.

    Source: Glaeser, section 6.2; errata G5-02, G6-05, G6-06.

    Examples
    --------
    >>> from vectorplot.textbook import relative_position
    >>> large = [(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1)]
    >>> small = [(1, 1, 3), (2, 1, 3), (2, 2, 3)]
    >>> found = relative_position(large, small)
    >>> found.position.name, found.first_depth, found.second_depth
    ('SECOND_IN_FIRST', 1.0, 3.0)
    """
    one, two = _checked(first), _checked(second)
    if _kept_apart(one, two) or _kept_apart(two, one):
        return RelativePosition(Position.DISJOINT, np.nan, np.nan)
    first_inside, second_depth = in_convex_polygon(one, two)
    second_inside, first_depth = in_convex_polygon(two, one)
    depths = np.concatenate(
        [
            _crossings(one, two),
            np.stack([one[:, 2], second_depth], axis=1)[first_inside],
            np.stack([first_depth, two[:, 2]], axis=1)[second_inside],
        ]
    )
    if first_inside.all():
        return _widest(Position.FIRST_IN_SECOND, depths)
    return _widest(Position.SECOND_IN_FIRST if second_inside.all() else Position.CROSSING, depths)


def _checked(polygon: ArrayLike) -> Floats:
    corner = np.asarray(polygon, dtype=np.float64)
    if corner.ndim != 2 or corner.shape[1:] != (3,) or len(corner) < 3 or not np.isfinite(corner).all():
        raise InputError("an outline needs three corners at least, each of finite x, y and depth")
    return corner


def _kept_apart(one: Floats, two: Floats) -> bool:
    """Whether a side of one has all of two on its outer side, or on it."""
    along = np.roll(one, -1, axis=0)[:, :2] - one[:, :2]
    sign = 1.0 if cross(one[:, :2] - one[0, :2], along).sum() > 0.0 else -1.0
    height = sign * cross(along[:, None], two[None, :, :2] - one[:, None, :2])
    return bool((height.max(axis=1) <= 0.0)[(along != 0.0).any(axis=1)].any())


def _crossings(one: Floats, two: Floats) -> Floats:
    """(k,2) depths of both outlines where their sides cross; a side owns its start, not its end."""
    after_one, after_two = np.roll(one, -1, axis=0), np.roll(two, -1, axis=0)
    along, other = (after_one - one)[:, None, :2], (after_two - two)[None, :, :2]
    arm = two[None, :, :2] - one[:, None, :2]
    turn = cross(along, other)
    safe = np.where(turn != 0.0, turn, 1.0)
    t, u = cross(arm, other) / safe, cross(arm, along) / safe
    met = (turn != 0.0) & (t >= 0.0) & (t < 1.0) & (u >= 0.0) & (u < 1.0)
    i, j = np.nonzero(met)
    return np.stack(
        [one[i, 2] + t[met] * (after_one - one)[i, 2], two[j, 2] + u[met] * (after_two - two)[j, 2]], axis=1
    )


def _widest(position: Position, depths: Floats) -> RelativePosition:
    widest = depths[np.abs(depths[:, 0] - depths[:, 1]).argmax()] if len(depths) else np.full(2, np.nan)
    return RelativePosition(position, float(widest[0]), float(widest[1]))
