"""Plane polygons: as unions of convex ones, and in the coordinates of their planes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def convex_polygon_parts(outline: ArrayLike, holes: Sequence[ArrayLike] = ()) -> list[Ints]:
    """Convex polygons that together cover a plane polygon.

    Parameters
    ----------
    outline : (n, 2) array_like of float
        Counter-clockwise.
    holes : sequence of (k, 2) array_like of float
        Clockwise.

    Returns
    -------
    list of (m,) array of int
        Numbers of points, counter-clockwise; the points are numbered through, the outline first.

    Raises
    ------
    InputError
        For an outline that crosses itself.

    Notes
    -----
    The parts are triangles of a constrained Delaunay triangulation, joined over the diagonals that convexity does not
    need.

    Degenerate: a convex outline without holes is its own part.

    Source: Glaeser, section 3.5; the joining is that of Hertel and Mehlhorn.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> angle = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    >>> [len(part) for part in geometry.convex_polygon_parts(angle)]
    [4, 4]
    """
    rings = [np.asarray(ring, dtype=np.float64).reshape(-1, 2) for ring in (outline, *holes)]
    if not len(rings) > 1 and is_convex_polygon(rings[0]):
        return [np.arange(len(rings[0]))]
    points = np.concatenate(rings)
    return _joined(points, _triangles(points, rings))


def is_convex_polygon(points: Floats) -> bool:
    """Whether a polygon turns left or goes straight on at every corner, and once round in all.

    Parameters
    ----------
    points : (n, 2) array of float
        The corners.

    Returns
    -------
    bool
        False for a convex polygon that runs clockwise.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    >>> geometry.is_convex_polygon(square), geometry.is_convex_polygon(square[::-1])
    (True, False)
    """
    sides = np.roll(points, -1, axis=0) - points
    after = np.roll(sides, -1, axis=0)
    turn = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
    zero = ZERO_OF_EXTENT * norm(sides) * norm(after)
    angles = arctan2(turn, np.einsum("ij,ij->i", sides, after))
    return bool((turn >= -zero).all() and abs(angles.sum() - 2.0 * np.pi) < 1.0)


def _triangles(points: Floats, rings: list[Floats]) -> Ints:
    """(t,3) counter-clockwise triangles of a polygon with holes, as point numbers."""
    import shapely

    polygon = shapely.Polygon(rings[0], rings[1:])
    if not polygon.is_valid:
        raise InputError("a polygon crosses itself")
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
    both, number = np.unique(np.concatenate([points, corners]), axis=0, return_inverse=True)
    first = np.full(len(both), -1, dtype=np.intp)
    first[number[: len(points)]] = np.arange(len(points))
    triangles = first[number[len(points) :]].reshape(-1, 3)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    clockwise = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    triangles[clockwise] = triangles[clockwise, ::-1]
    return triangles


def _joined(points: Floats, triangles: Ints) -> list[Ints]:
    """The triangles joined to convex polygons, diagonal by diagonal."""
    polygons: dict[int, list[int]] = dict(enumerate(triangles.tolist()))
    owner = {(p[k - 1], p[k]): number for number, p in polygons.items() for k in range(3)}
    flat = points.tolist()

    def bends_left(a: int, b: int, c: int) -> bool:
        """Or goes straight on: a corner that turns back is none of a convex polygon, however thin that is."""
        (ax, ay), (bx, by), (cx, cy) = flat[a], flat[b], flat[c]
        before, after = (bx - ax, by - ay), (cx - bx, cy - by)
        zero = ZERO_OF_EXTENT * math.hypot(*before) * math.hypot(*after)
        turn = before[0] * after[1] - before[1] * after[0]
        return bool(turn > zero or (turn >= -zero and before[0] * after[0] + before[1] * after[1] > 0.0))

    for a, b in list(owner):
        left, right = owner.get((a, b)), owner.get((b, a))
        if left is None or right is None or left == right:
            continue
        p, q = polygons[left], polygons[right]
        i, j = p.index(b), q.index(a)
        # The left polygon from b round to a, then the right one between a and b.
        whole = p[i:] + p[:i] + (q[j:] + q[:j])[1:-1]
        k = len(p) - 1
        if bends_left(whole[k - 1], whole[k], whole[k + 1]) and bends_left(whole[-1], whole[0], whole[1]):
            polygons[left] = whole
            del polygons[right], owner[a, b], owner[b, a]
            for n in range(len(whole)):
                owner[whole[n - 1], whole[n]] = left
    return [np.array(polygon, dtype=np.intp) for polygon in polygons.values()]


def flattened(points: Floats, normal: Floats) -> tuple[Floats, Ints]:
    """(n,2) a planar polygon in its plane, counter-clockwise about the normal, and the numbers (n,) of its points."""
    x, y = plane_axes(normal)
    flat = matmul(points - points[0], np.stack([x, y], axis=1))
    numbers = np.arange(len(points))
    if signed_area(flat) < 0.0:
        flat, numbers = flat[::-1], numbers[::-1]
    return flat, numbers


def plane_axes(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors that span the plane across a normal; right-handed with it."""
    x = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    x = x / norm(x)
    y = np.cross(normal, x)
    return x, y / norm(y)


def signed_area(points: Floats) -> float:
    """Area of a polygon (n,2), positive if it runs counter-clockwise."""
    arm = points - points[0]
    after = np.roll(arm, -1, axis=0)
    return 0.5 * float((arm[:, 0] * after[:, 1] - arm[:, 1] * after[:, 0]).sum())
