"""Painter's orders that the shape gives, of graphs, solids of revolution and solids; how two convex outlines lie."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import cross
from vectorplot.scene.view import View
from vectorplot.textbook.separating_planes import spheres_power
from vectorplot.visibility.painter.face_splitting import eye_coordinate, slice_order
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.priority_tests import (
    APART,
    BEHIND,
    IN_FRONT,
    Bodies,
    body_relations,
    box_pairs,
    spheres_apart,
)

# The painter's order of function graphs over a grid, from any eye position, without a single comparison.


def graph_triangles(rows: int, columns: int) -> Ints:
    """The triangles over a grid of rows x columns patches.

    Parameters
    ----------
    rows, columns : int
        How many patches there are each way.

    Returns
    -------
    (2 rows columns, 3) array of int
        Corner (i, j) is the vertex i (columns + 1) + j. Patch k = i columns + j has the triangles 2 k, on the right of
        the diagonal from its corner (i, j) to (i + 1, j + 1), and 2 k + 1, on its left; counter-clockwise where x grows
        with i and y with j.

    Notes
    -----
    Source: Glaeser, section 5.4.

    Examples
    --------
    >>> from vectorplot.textbook import graph_triangles
    >>> graph_triangles(1, 2).tolist()
    [[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]]
    """
    corner = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)
    triangles = np.empty((rows, columns, 2, 3), dtype=np.intp)
    triangles[..., 0] = corner[..., None]
    triangles[..., 0, 1] = corner + columns + 1
    triangles[..., 0, 2] = triangles[..., 1, 1] = corner + columns + 2
    triangles[..., 1, 2] = corner + 1
    return triangles.reshape(-1, 3)


def graph_order(x: ArrayLike, y: ArrayLike, eye: ArrayLike) -> Ints:
    """The triangles of graph_triangles over some grid lines, back to front.

    Parameters
    ----------
    x : (m+1,) array_like of float
        Ascending.
    y : (n+1,) array_like of float
        Ascending.
    eye : (3,) or (4,) array_like of float
        In the coordinates of the grid, or (x, y, z, 0) for a direction towards it; its height does not matter.

    Returns
    -------
    (2 m n,) array of int
        Numbers of triangles.

    Raises
    ------
    InputError
        Where the lines do not ascend, or the eye is not finite.

    Notes
    -----
    On each axis the slices on one side of the eye come first, towards it, then those on the other side, and last the
    eye's own; of a patch the triangle beyond the vertical plane through the diagonal goes before the other one.

    Source: Glaeser, section 5.4, figure 7.

    Examples
    --------
    >>> from vectorplot.textbook import graph_order
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, 9, 3)).tolist()
    [0, 1, 2, 3]
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, -9, 3)).tolist()
    [3, 2, 1, 0]
    """
    lines = [np.asarray(line, dtype=np.float64) for line in (x, y)]
    place = np.asarray(eye, dtype=np.float64)
    row, column = (slice_order(line, eye_coordinate(place, axis)) for axis, line in enumerate(lines))
    cell = (row[:, None] * (len(lines[1]) - 1) + column).ravel()
    width, depth = (np.diff(line)[order] for line, order in zip(lines, (row, column), strict=True))
    if len(place) == 3:
        ahead, beside = (place[axis] - lines[axis][:-1][order] for axis, order in ((0, row), (1, column)))
    else:
        ahead, beside = place[0], place[1]
    # Where the eye is on the left of the diagonal the right triangle goes first.
    left = np.outer(width, np.broadcast_to(beside, depth.shape)) > np.outer(np.broadcast_to(ahead, width.shape), depth)
    nearer = left.ravel().astype(np.intp)
    return np.stack([2 * cell + 1 - nearer, 2 * cell + nearer], axis=1).ravel()


# How two convex outlines lie on each other in the image, and which is nearer where they meet.
#
# Depths are those after the projective map T2, which is linear along lines: both ends are mapped first, then
# interpolated (erratum G6-05). The larger depth is nearer to the eye.


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

    position: how the first lies on the second; first_depth, second_depth: the depths of the first and of the second at
    one common point of the image, where they differ most of all points looked at.
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

    Edge cases: a polygon without area contains nothing.

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

    Edge cases: outlines that only touch are disjoint; of two in the same place the first lies inside the second.

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


# The painter's order of polyhedral surfaces of revolution by rings, without a single comparison.


def sliced_meridian(meridian: ArrayLike) -> Floats:
    """The meridian with more points where it passes the height of one of its points.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius, not negative, and height.

    Returns
    -------
    (n, 2) array of float
        Every side lies between two neighbouring heights.

    Raises
    ------
    InputError
        For fewer than two points, negative radii, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 5.2, figure 3.

    Examples
    --------
    >>> from vectorplot.textbook import sliced_meridian
    >>> sliced_meridian([(0, 2), (2, 0), (1, 1)]).tolist()
    [[0.0, 2.0], [1.0, 1.0], [2.0, 0.0], [1.0, 1.0]]
    """
    line = _checked_rings(meridian)
    level = np.unique(line[:, 1])
    pieces = []
    for start, end in pairwise(line):
        low, high = sorted((start[1], end[1]))
        between = level[(level > low) & (level < high)]
        between = between if end[1] > start[1] else between[::-1]
        share = (between - start[1]) / (end[1] - start[1] or 1.0)
        pieces.append(
            np.concatenate([start[None], np.stack([start[0] + share * (end[0] - start[0]), between], axis=1)])
        )
    return np.concatenate([*pieces, line[-1:]])


def ring_order(meridian: ArrayLike, order: int, eye: ArrayLike) -> Ints:
    """The faces of a surface of revolution about the z-axis, back to front.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius and height, sliced as by sliced_meridian and not crossing itself.
    order : int
        How many faces go round.
    eye : (3,) or (4,) array_like of float
        In coordinates in which z is the axis, or (x, y, z, 0) for a direction towards it.

    Returns
    -------
    ((k-1) order,) array of int
        Face i order + j is swept by the side from point i to i+1 between the azimuths j and j+1 times 2 pi / order.

    Raises
    ------
    InputError
        Where a side of the meridian passes the height of a point, and for what sliced_meridian refuses.

    Notes
    -----
    Slices are drawn in the order of slice_order; within a slice first what the rays leave its rings through, outer
    rings before inner ones, then what they enter them through, inner rings before outer ones. Right wherever the eye
    is: above, below, inside.

    Source: Glaeser, section 5.2, figure 3; erratum G5-09.

    Examples
    --------
    >>> from vectorplot.textbook import ring_order
    >>> ring_order([(1, 0), (1, 1)], order=4, eye=(9, 1, 0.5)).tolist()
    [1, 2, 0, 3]
    """
    line = _checked_rings(meridian)
    place = np.asarray(eye, dtype=np.float64)
    radius, height = line[:-1], line[1:]
    low, high = np.minimum(radius[:, 1], height[:, 1]), np.maximum(radius[:, 1], height[:, 1])
    level = np.unique(line[:, 1])
    bottom, top = np.searchsorted(level, low), np.searchsorted(level, high)
    if (top - bottom > 1).any():
        raise InputError("a side of the meridian passes the height of another point: cut it there first")
    leading = _places(level, bottom, top, eye_coordinate(place, 2))
    entered = _entered(line, order, place)
    middle = (radius[:, 0] + height[:, 0]) / 2.0
    rank = np.argsort(np.argsort(middle, kind="stable"), kind="stable")[:, None]
    within = np.where(entered, rank, -1 - rank)
    return np.lexsort((within.ravel(), np.repeat(leading, order)))


def _checked_rings(meridian: ArrayLike) -> Floats:
    line = np.asarray(meridian, dtype=np.float64)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all() or (line[:, 0] < 0.0).any():
        raise InputError("a meridian has two points at least, each a radius, not negative, and a height")
    return line


def _places(level: Floats, bottom: Ints, top: Ints, eye: float) -> Ints:
    """(k,) the place in the order of drawing of sides between levels and, where bottom and top are the same, in one."""
    between = np.zeros(len(level), dtype=np.intp)
    if len(level) > 1:
        between[slice_order(level, eye)] = 2 * np.arange(len(level) - 1) + 1
    # A plane below the eye is drawn just after the slice below it, one above the eye after the slice above it.
    within = np.where(level < eye, np.append(0, between[: len(level) - 1] + 1), between + 1)
    within[-1:] = np.where(level[-1] < eye, within[-1], 0)
    return np.where(top > bottom, between[bottom], within[bottom])


def _entered(line: Floats, order: int, eye: Floats) -> Bools:
    """(k-1, order) whether rays to the eye come out of faces on the side away from the axis."""
    azimuth = 2.0 * np.pi * (np.arange(order) + 0.5) / order
    (radius, height), (rise_out, rise_up) = line[:-1].T, np.diff(line, axis=0).T
    # Upwards along the meridian the outside is on the right.
    sign = np.where(rise_up < 0.0, -1.0, 1.0)
    flatter = np.cos(np.pi / order)
    out = np.cos(azimuth) * eye[0] + np.sin(azimuth) * eye[1]
    finite = 1.0 if len(eye) == 3 else 0.0
    above = np.outer(sign * rise_up, out) - (sign * rise_out * flatter * eye[2])[:, None]
    return np.asarray(above - finite * (sign * flatter * (rise_up * radius - rise_out * height))[:, None] > 0.0)


# The order of solids by the power of the spheres around them, checked.


def sphere_order(view: View, faces: ImageFaces, bodies: Bodies) -> Ints | None:
    """(b,) numbers of convex bodies (see convex_bodies) back to front, by falling power of the eye to their spheres;
    None where that is wrong. Right for disjoint spheres; other pairs whose image boxes overlap are compared
    directly.
    Source: Glaeser, section 5.5, figure 9; erratum G5-03.
    """
    eye = np.array([0.0, 0.0, 1.0, 0.0]) if view.eye is None else view.eye
    power = spheres_power(bodies.sphere.T, eye)
    if not len(bodies):
        return bodies.item
    rows = [e.reduceat(row, bodies.offsets[:-1]) for row in bodies.corners for e in (np.minimum, np.maximum)]
    for first, second in box_pairs(np.stack(rows), view.tolerance):
        close = ~spheres_apart(bodies, first, second)
        a, b = first[close], second[close]
        codes = body_relations(view, faces, bodies, a, b)
        told = np.where(power[a] <= power[b], IN_FRONT, BEHIND)
        if ((codes != APART) & (codes != told)).any():
            return None
    return np.argsort(-power, kind="stable")
