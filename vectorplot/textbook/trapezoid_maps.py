"""Trapezoids around what a lamp shows of a picture, and their maps onto a square, as the papers give them.

Three ways to the same map: step by step with as few operations as can be (Ressler), as a product of eight simple
matrices (Martin and Tan), and for any quadrilateral (Heckbert). Corners are (4, 2), counter-clockwise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, inverse_matrix, matmul
from vectorplot.geometry.elementary import power
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.shading.shadow_maps import ShadowMap, four_by_four, light_plane
from vectorplot.shading.trapezoids import FOCUS_LINE, Axis
from vectorplot.tolerances import PARALLEL_SINE

LARGEST_SHIFT = 1e4
"""Sides that meet farther away than this, in widths, run parallel: the map is affine."""

HALF_TURN = np.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class SquareMap:
    """The map of a trapezoid onto the square from -1 to 1.

    matrix: (3, 3) first corner to (-1, -1), second to (1, -1), third to (1, 1), fourth to (-1, 1); shift: d, how far
    the meeting point of the sides was moved; stretch: u.
    Source: Ressler, sections 4 and 5.
    """

    matrix: Floats
    shift: float
    stretch: float


def square_map(corners: ArrayLike) -> SquareMap:
    """The map of a trapezoid whose first and second corner are the ends of its top line onto the square from -1 to 1.

    Parameters
    ----------
    corners : (4, 2) array_like of float
        Counter-clockwise, as bounding_trapezoid gives them.

    Returns
    -------
    SquareMap
        Its matrix (3, 3) brings the corners to (-1, -1), (1, -1), (1, 1) and (-1, 1).

    Raises
    ------
    InputError
        For corners that are not finite, or without area.

    Notes
    -----
    A trapezoid whose base is the shorter one is turned by half a turn before and after.

    Edge cases: for parallel sides the affine map of the rectangle between first and third corner.

    Source: Ressler, sections 4 and 5, equations 20 to 42; errata N-03, N-05, N-06.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.textbook import square_map
    >>> corners = np.array([(-1, 0), (1, 0), (3, 4), (-3, 4)])
    >>> images = np.column_stack([corners, np.ones(4)]) @ square_map(corners).matrix.T
    >>> (images[:, :2] / images[:, 2:]).round(6).tolist()
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
    """
    p = _checked(corners)
    if _length(p[1] - p[0]) > _length(p[3] - p[2]):
        turned = square_map_of_wide_base(p[[2, 3, 0, 1]])
        return SquareMap(matmul(HALF_TURN, turned.matrix), turned.shift, turned.stretch)
    return square_map_of_wide_base(p)


def square_map_of_wide_base(p: Floats) -> SquareMap:
    """The map of a trapezoid (4, 2) whose base is not shorter than its top line."""
    y_a, x_a = (p[1] - p[0]) / _length(p[1] - p[0]) * (1.0, -1.0)
    m = np.eye(3)
    # Equation 23: first corner to the origin, top line along x.
    m[0] = y_a, -x_a, x_a * p[0, 1] - y_a * p[0, 0]
    m[1] = x_a, y_a, -(x_a * p[0, 0] + y_a * p[0, 1])
    x_c3, y_c3 = matmul(m[:2, :2], p[3]) + m[:2, 2]
    m[0] -= x_c3 / y_c3 * m[1]  # 27: the left side upright
    x_d1, x_d2 = matmul(m[0, :2], p[1]) + m[0, 2], matmul(m[0, :2], p[2]) + m[0, 2]
    widening = x_d2 - x_d1
    if not abs(y_c3) < LARGEST_SHIFT * widening:
        return SquareMap(_affine(m, x_d2, y_c3), np.inf, np.inf)
    d = x_d1 * y_c3 / widening
    m[1, 2] += d  # 30: the meeting point of the sides into the origin
    s_x, s_y = 2.0 / x_d2, 1.0 / (y_c3 + d)
    u = 2.0 * s_y * d / (1.0 - s_y * d)
    m[2] = s_y * m[1]  # 38: perspective, scaling and shift in one
    m[1] = (u + 1.0) * m[2] - (0.0, 0.0, u)
    m[0] = s_x * m[0] - m[2]
    return SquareMap(m, float(d), float(u))


def _affine(m: Floats, width: float, height: float) -> Floats:
    """Equations 41 and 42."""
    result = np.eye(3)
    result[0] = 2.0 / width * m[0] - (0.0, 0.0, 1.0)
    result[1] = 2.0 / height * m[1] - (0.0, 0.0, 1.0)
    return result


def recipe_factors(corners: ArrayLike) -> tuple[Floats, ...]:
    """The eight matrices (4, 4) T1, R, T2, H, S1, N, T3, S2, in the order in which they act, for a trapezoid whose
    first two corners are the ends of its base and whose third and fourth are those of its top line.

    Their product maps the corners to (-1, -1), (1, -1), (1, 1), (-1, 1) in x and y; z is what z / w is.
    Errors: InputError for parallel sides. Source: Martin and Tan, recipe, steps 1 to 8; errata R-01, R-02, R-03.
    """
    t = _checked(corners)
    points = np.column_stack([t, np.ones(4), np.ones(4)])
    meeting = np.array([*_meeting_point(t), 1.0, 1.0])
    factors: list[Floats] = []
    total = np.eye(4)

    def act(matrix: Floats) -> None:
        nonlocal total
        factors.append(matrix)
        total = matmul(matrix, total)

    act(_moved(-(t[2] + t[3]) / 2.0))
    x_u, y_u = (t[2] - t[3]) / _length(t[2] - t[3])
    act(_planar([[x_u, y_u], [y_u, -x_u]]))
    act(_moved(-(matmul(total, meeting))[:2]))
    middle = matmul(total, points[2] + points[3]) / 2.0
    act(_planar([[1.0, -middle[0] / middle[1]], [0.0, 1.0]]))
    corner = matmul(total, points[2])
    act(_planar([[1.0 / corner[0], 0.0], [0.0, 1.0 / corner[1]]]))
    perspective = np.eye(4)
    perspective[1, 3], perspective[3] = 1.0, (0.0, 1.0, 0.0, 0.0)
    act(perspective)
    base, top = matmul(total, points[0]), matmul(total, points[2])
    act(_moved(np.array([0.0, -(base[1] / base[3] + top[1] / top[3]) / 2.0])))
    base = matmul(total, points[0])
    act(_planar([[1.0, 0.0], [0.0, -base[3] / base[1]]]))
    return tuple(factors)


def recipe_matrix(corners: ArrayLike) -> Floats:
    """The map of a trapezoid onto the square from -1 to 1 as the product of eight simple matrices.

    corners (4,2): first the ends of its base, then those of its top line; result: (4,4) brings the corners to (-1, -1),
    (1, -1), (1, 1) and (-1, 1) in x and y; z is what z / w is.
    Source: Martin and Tan, recipe, steps 1 to 8; errata R-01, R-02, R-03.
    Errors: for corners that are not finite, or without area, and for parallel sides.
    """
    total = np.eye(4)
    for factor in recipe_factors(corners):
        total = matmul(factor, total)
    return total


def recipe_map(corners: ArrayLike) -> Floats:
    """(3, 3) the same map as recipe_matrix, up to a factor, for x, y and w alone: one row after the other.

    Errors: InputError for parallel sides. Source: Martin and Tan, recipe, optimised code; errata R-03, R-04.
    """
    t = _checked(corners)
    h = np.column_stack([t, np.ones(4)])
    a, b = (t[2] - t[3]) / 2.0
    meeting = _meeting_point(t)
    m = np.array([[a, b, 0.0], [b, -a, 0.0], [0.0, 0.0, 1.0]])
    m[:2, 2] = matmul(-m[:2, :2], meeting)
    (x2, y2), (x3, y3) = matmul(m[:2], h[2]), matmul(m[:2], h[3])
    m[0] -= m[1] * (x2 + x3) / (y2 + y3)
    m[:2] /= (matmul(m[:2], h[2]))[:, None]
    m[2] = m[1]
    m[1, 2] += 1.0
    base, top = matmul(m, h[0]), matmul(m, h[2])
    m[1] -= m[2] * (base[1] / base[2] + top[1] / top[2]) / 2.0
    base = matmul(m, h[0])
    m[1] *= -base[2] / base[1]
    return m


def quadrilateral_map(corners: ArrayLike) -> Floats:
    """(3, 3) the map of any convex quadrilateral: its corners, one after the other, to (-1, -1), (1, -1), (1, 1) and
    (-1, 1). Errors: InputError for three corners on a line.

    Source: Heckbert, Fundamentals of texture mapping and image warping, section 2.2.3.
    """
    p = _checked(corners)
    s = p[0] - p[1] + p[2] - p[3]
    u, v = p[1] - p[2], p[3] - p[2]
    turn = u[0] * v[1] - u[1] * v[0]
    if not abs(turn) > PARALLEL_SINE * _length(u) * _length(v):
        raise InputError("a quadrilateral with three corners on a line has no map onto a square")
    g, h = (s[0] * v[1] - s[1] * v[0]) / turn, (u[0] * s[1] - u[1] * s[0]) / turn
    unit = np.eye(3)
    unit[:2, 0], unit[:2, 1], unit[:2, 2] = p[1] - p[0] + g * p[1], p[3] - p[0] + h * p[3], p[0]
    unit[2, :2] = g, h
    square = np.array([[2.0, 0.0, -1.0], [0.0, 2.0, -1.0], [0.0, 0.0, 1.0]])
    return np.asarray(matmul(square, inverse_matrix(unit)))


def column_major(matrix: ArrayLike) -> Floats:
    """(16,) a matrix (3, 3) as four_by_four, column after column, as OpenGL takes it.

    Source: Martin and Tan, recipe."""
    return np.asarray(four_by_four(matrix).T.ravel())


def depth_row(nearest: float, farthest: float) -> Floats:
    """(4,) the row for z that carries eye coordinates z = -nearest to -1 and z = -farthest to 1, before the division.

    Errors: InputError unless nearest < farthest. Source: Ressler, equation 15; erratum N-07.
    """
    if not nearest < farthest:
        raise InputError(f"depths from {nearest:g} to {farthest:g} are no range")
    size = nearest - farthest
    return np.array([0.0, 0.0, 2.0 / size, (nearest + farthest) / size])


def _checked(corners: ArrayLike) -> Floats:
    p = np.asarray(corners, dtype=np.float64)
    if p.shape != (4, 2) or not np.isfinite(p).all():
        raise InputError("a quadrilateral needs four corners with two finite coordinates each")
    diagonals = p[2] - p[0], p[3] - p[1]
    turn = diagonals[0][0] * diagonals[1][1] - diagonals[0][1] * diagonals[1][0]
    if not abs(turn) > PARALLEL_SINE * _length(diagonals[0]) * _length(diagonals[1]):
        raise InputError("a quadrilateral without area has no map onto a square")
    return p


def _meeting_point(t: Floats) -> Floats:
    """(2,) where the sides meet. Errors: InputError where they run parallel."""
    one, two = t[3] - t[0], t[2] - t[1]
    turn = one[0] * two[1] - one[1] * two[0]
    if not abs(turn) > PARALLEL_SINE * _length(one) * _length(two):
        raise InputError("a trapezoid with parallel sides is a rectangle: its map is affine")
    arm = t[1] - t[0]
    return np.asarray(t[0] + (arm[0] * two[1] - arm[1] * two[0]) / turn * one)


def _length(arm: Floats) -> float:
    return float(np.hypot(arm[0], arm[1]))


def _moved(by: Floats) -> Floats:
    result = np.eye(4)
    result[:2, 3] = by
    return result


def _planar(rows: ArrayLike) -> Floats:
    result = np.eye(4)
    result[:2, :2] = rows
    return result


def vertices_with_own_depth(system: CoordinateSystem, texel_from_light: Floats, points: ArrayLike) -> Floats:
    """(n, 4) homogeneous points in texels whose depth, after division, is that of the lamp's own space.

    Right at the vertices (n, 3) only: within a triangle such depths are not interpolated linearly, and bend. Good for
    meshes much finer than the map; shadow_map corrects every texel instead.
    Errors: InputError for points behind the lamp.
    Source: Martin and Tan, recipe, polygon offset without fragment programs.
    """
    h = system.homogeneous(points)
    if not (h[:, 3] > 0.0).all():
        raise InputError("a point on or behind the neutral plane of the lamp has no image")
    texels = matmul(h, four_by_four(texel_from_light).T)
    texels[:, 2] = h[:, 2] / h[:, 3] * texels[:, 3]
    return np.asarray(texels)


def texels_per_unit(found: ShadowMap, points: ArrayLike) -> Floats:
    """How many texels there are on a unit of area of the lamp's image plane.

    Parameters
    ----------
    found : ShadowMap
        The map.
    points : (n, 3) array_like of float
        In the world.

    Returns
    -------
    (n,) array of float
        Where the points have their images.

    Raises
    ------
    InputError
        For points on or behind the neutral plane of the lamp.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> from vectorplot.textbook import texels_per_unit
    >>> roof, corners = [(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)], np.array([(0, 1, 2), (0, 2, 3)])
    >>> (found,) = shading.shadow_buffer(vp.Light((0, 0, 1), parallel=True), roof, corners, size=8).maps
    >>> texels_per_unit(found, [(0, 0, 0)]).round(6).tolist()
    [9.0]
    """
    p = light_plane(found.system, points)
    m = found.texel_from_light
    weight = matmul(p, m[2, :2]) + m[2, 2]
    return np.asarray(np.abs(determinant(m)) / power(np.abs(weight), 3))


LARGEST_ETA = 1000.0
"""In lengths of the trapezoid: where its sides meet farther away than this, it is a rectangle."""


def eta_of_focus(length: float, focus: float, line: float = FOCUS_LINE) -> float:
    """How far before the top line the sides meet, so that what lies at the distance focus behind it comes onto the
    focus line of the map.

    Infinite where the focus lies at that line already, or behind it: then the map is a rectangle.
    Errors: InputError unless focus, length and line are positive and the line lies within the map.
    Source: Ressler, section 2; formula of Martin and Tan as derived in erratum N-02.
    """
    if not (0.0 < focus < np.inf and 0.0 < length < np.inf and 0.0 < line < 1.0):
        raise InputError(f"a focus at {focus:g} of {length:g}, on the line {line:g}, is out of range")
    gap = line * length - focus
    return (1.0 - line) * length * focus / gap if gap > 0.0 else np.inf


def side_directions(points: ArrayLike, axis: Axis, eta: float) -> tuple[Floats, Floats]:
    """Unit vectors (2,) from the meeting point of the sides, eta before the top line, to the leftmost and to the
    rightmost of points (n, 2), found by their sines. Source: Ressler, equations 6 to 10."""
    q = axis.origin + (axis.top - eta) * axis.direction
    arm = np.asarray(points, dtype=np.float64) - q
    unit = arm / np.hypot(*arm.T)[:, None]
    sine = matmul(unit, axis.left)
    return unit[sine.argmax()], unit[sine.argmin()]


def trapezoid(points: ArrayLike, axis: Axis, eta: float) -> Floats:
    """The trapezoid around points in the lamp's image plane whose sides meet so far before its top line.

    points (n,2): images of what the eye sees; axis: the line of sight, with the top and the base line; eta: how far
    before the top line the sides meet, along the axis; result: (4,2) the corners: top left, top right, base right, base
    left, counter-clockwise.
    Source: Ressler, equations 11 to 14.
    Errors: for an eta that is not positive and finite.
    """
    if not 0.0 < eta < np.inf:
        raise InputError(f"the sides of a trapezoid cannot meet {eta:g} before its top line")
    left, right = side_directions(points, axis, eta)
    q = axis.origin + (axis.top - eta) * axis.direction
    far = eta + axis.length
    reach = [(eta, left), (eta, right), (far, right), (far, left)]
    return np.stack([q + t / (matmul(u, axis.direction)) * u for t, u in reach])


def widths(points: ArrayLike, axis: Axis) -> tuple[float, float]:
    """How far points (n, 2) lie to the left and, negative, to the right of the line of sight at most.

    Source: Ressler, equations 16 and 17; erratum N-01.
    """
    d = axis.across(points)
    return float(d.max()), float(d.min())


def rectangle(points: ArrayLike, axis: Axis) -> Floats:
    """(4, 2) the corners of the rectangle along the axis, in the order of trapezoid.

    Source: Ressler, equations 16 to 19; erratum N-01.
    """
    left, right = widths(points, axis)
    places = [(axis.top, left), (axis.top, right), (axis.base, right), (axis.base, left)]
    return np.stack([axis.origin + t * axis.direction + d * axis.left for t, d in places])


def bounding_trapezoid(points: ArrayLike, axis: Axis, focus: float, line: float = FOCUS_LINE) -> Floats:
    """The trapezoid around points in the lamp's image plane of which most of the map shows what is near the eye.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Images of what the eye sees.
    axis : Axis
        The line of sight, with the top and the base line.
    focus : float
        How far behind the top line the focus lies.
    line : float
        The part of the map, from the top line on, that shows what is nearer than the focus.

    Returns
    -------
    (4, 2) array of float
        The corners: top left, top right, base right, base left, counter-clockwise.

    Raises
    ------
    InputError
        Unless the focus is positive and the line lies within the map.

    Notes
    -----
    Edge cases: where its sides all but run parallel (duelling frusta), the rectangle.

    Source: Ressler, section 3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import line_of_sight
    >>> from vectorplot.textbook import bounding_trapezoid
    >>> frustum = [(-1, 0), (1, 0), (3, 4), (-3, 4)]
    >>> axis = line_of_sight(frustum, near=(0, 0), far=(0, 4))
    >>> bool(np.allclose(bounding_trapezoid(frustum, axis, focus=16 / 7), frustum))
    True
    >>> rectangle = [(-3, 0), (3, 0), (3, 4), (-3, 4)]
    >>> bool(np.allclose(bounding_trapezoid(frustum, axis, focus=3.2), rectangle))
    True
    """
    eta = eta_of_focus(axis.length, focus, line)
    return rectangle(points, axis) if eta > LARGEST_ETA * axis.length else trapezoid(points, axis, eta)
