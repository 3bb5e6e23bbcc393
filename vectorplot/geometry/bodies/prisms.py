"""Prisms as meshes, with holes through them."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Sequence
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.bodies.solids import BOTH_CAPS, checked_points
from vectorplot.geometry.convex.convex_polygons import convex_polygon_parts, plane_axes
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import FLAT_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

MOST_HOLES = 5000
"""Round ones of 48 sides take ten seconds, and more than twice as long where they are twice as many."""


def prism(
    base_points: ArrayLike, vector: ArrayLike, *, caps: Collection[str] = BOTH_CAPS, holes: Sequence[ArrayLike] = ()
) -> Mesh:
    """The body that a planar polygon sweeps when it is moved along a vector.

    Parameters
    ----------
    base_points : (b, 3) array_like of float
        The base; one that runs clockwise about the vector is turned round.
    vector : (3,) array_like of float
        From the base to the top.
    caps : collection of {"bottom", "top"}
        Which of them are present.
    holes : sequence of (h, 3) array_like of float
        Polygons in the plane of the base, inside of it and apart from each other, either way round, at most 5000; holes
        go through the body. regular_polygon makes round ones.

    Returns
    -------
    Mesh
        2b vertices (the base, then the top), 3b edges; faces: the b sides in the order of the edges of the base, then
        bottom and top. With holes their corners follow those of the base, and their sides those of the base; bottom and
        top are several convex polygons each, between the same corners.

    Raises
    ------
    InputError
        For fewer than three points, points that are not finite, a vector in the plane of the base; for a hole that is
        not in the plane of the base, reaches beyond it or into another one; for too many of them.

    Warns
    -----
    InputWarning
        For a base that is not planar; it is used all the same.

    Notes
    -----
    Source: Glaeser, section 3.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.prism([(0, 0, 0), (1, 0, 0), (0, 1, 0)], (0, 0, 2)).polygons()
    [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5], [2, 1, 0], [3, 4, 5]]
    >>> hole = geometry.regular_polygon(48, 1, centre=(2, 2, 0))
    >>> plate = geometry.prism([(0, 0, 0), (9, 0, 0), (9, 4, 0), (0, 4, 0)], (0, 0, 1), holes=[hole])
    >>> geometry.is_closed_oriented(plate), round(geometry.body_record(plate).volume, 2)
    (True, 32.87)
    """
    body = swept_polygon(base_points, vector, caps=caps, holes=holes)
    if not is_planar(base_points):
        warnings.warn(NOT_PLANAR, InputWarning, stacklevel=2)
    return body


NOT_PLANAR = "base_points do not lie in one plane"
"""What is said of a base that is not planar."""


def is_planar(points: ArrayLike) -> bool:
    """Whether the corners of a polygon, points (b,3), lie in one plane, but for a millionth of its extent."""
    corners = np.asarray(points, dtype=np.float64)
    arm, extent = corners - corners[0], float(np.ptp(corners, axis=0).max())
    area = area_vector(corners)
    return not np.abs(matmul(arm, area)).max() > FLAT_OF_EXTENT * extent * float(norm(area))


def swept_polygon(
    base_points: ArrayLike, vector: ArrayLike, *, caps: Collection[str] = BOTH_CAPS, holes: Sequence[ArrayLike] = ()
) -> Mesh:
    """The body that prism makes, whether its base is planar or not, without a word about it. Errors: as of prism."""
    base = checked_points(base_points, "base_points")
    if len(base) < 3:
        raise InputError(f"a base needs at least three points, not {len(base)}")
    step = _vector(vector, "trans_vector")
    extent = max(float(np.ptp(base, axis=0).max()), LEAST_DIVISOR)
    area = area_vector(base)
    size = float(norm(area))
    height = float(matmul(area, step))
    if not abs(height) > ZERO_OF_EXTENT * size * float(norm(step)) or not size > ZERO_OF_EXTENT * extent * extent:
        raise InputError("trans_vector lies in the plane of the base, or the base has no area")
    normal = area / size
    rings = [base, *_checked_holes(base, normal, holes)]
    bottom, shown = _bottom(rings, normal), [cap in caps for cap in BOTH_CAPS]
    points = np.concatenate(rings)
    count, sizes = len(points), np.array([len(ring) for ring in rings])
    here, there = np.arange(count), ragged.following(ragged.offsets(sizes))
    sides = np.stack([here, there, there + count, here + count], axis=1)
    corners = np.concatenate([sides.reshape(-1), *(part[::-1] for part in bottom), *(part + count for part in bottom)])
    faces = np.concatenate([np.full(count, 4), np.tile([len(part) for part in bottom], 2)])
    present = np.repeat([True, *shown], [count, len(bottom), len(bottom)])
    body = Mesh(np.concatenate([points, points + step]), corners, ragged.offsets(faces), present)
    return body if height > 0.0 else body.reversed()


def area_vector(points: ArrayLike) -> Floats:
    """(3,) twice the area of a polygon with corners (b,3), along its normal."""
    corners = np.asarray(points, dtype=np.float64)
    arm = corners - corners[0]
    return np.asarray(np.cross(arm, np.roll(arm, -1, axis=0)).sum(axis=0))


def check_hole_count(count: int) -> None:
    """Errors: InputError for more holes than a prism has."""
    if count > MOST_HOLES:
        raise InputError(f"{count} holes, expected at most {MOST_HOLES}")


def _checked_holes(base: Floats, normal: Floats, holes: Sequence[ArrayLike]) -> list[Floats]:
    """The holes (h,3), clockwise about the normal of the base."""
    check_hole_count(len(holes))
    found = []
    for number, points in enumerate(holes, 1):
        hole = checked_points(points, f"hole {number}: its corners")
        if len(hole) < 3:
            raise InputError(f"hole {number} needs at least three points, not {len(hole)}")
        both = np.concatenate([base, hole])
        if np.abs(matmul(both - base[0], normal)).max() > FLAT_OF_EXTENT * float(np.ptp(both, axis=0).max()):
            raise InputError(f"hole {number} and the base do not lie in one plane")
        found.append(hole[::-1] if matmul(area_vector(hole), normal) > 0.0 else hole)
    return found


def _bottom(rings: list[Floats], normal: Floats) -> list[Ints]:
    """The polygons of a base, by the numbers of the corners of all rings: itself, or convex ones around holes."""
    if len(rings) == 1:
        return [np.arange(len(rings[0]))]
    import shapely

    axes = np.stack(plane_axes(normal), axis=1)
    outline, *holes = (matmul(ring - rings[0][0], axes) for ring in rings)
    whole, cut = shapely.Polygon(outline), [shapely.Polygon(hole) for hole in holes]
    for number, hole in enumerate(cut, 1):
        if not hole.is_valid or not hole.area > 0.0:
            raise InputError(f"hole {number} crosses itself, or has no area")
        if not whole.is_valid or not whole.contains_properly(hole):
            raise InputError(f"hole {number} reaches to the outline of the base, or beyond it")
    tree = shapely.STRtree(cut)
    one, other = tree.query(cut, predicate="intersects")
    met = np.flatnonzero(one < other)
    if len(met):
        raise InputError(f"holes {one[met[0]] + 1} and {other[met[0]] + 1} meet")
    return convex_polygon_parts(outline, holes)


def regular_polygon(
    count: int, radius: float, *, centre: ArrayLike = (0.0, 0.0, 0.0), normal: ArrayLike = (0.0, 0.0, 1.0)
) -> Floats:
    """The corners of a regular polygon, as many as a circle needs to look round.

    Parameters
    ----------
    count : int
        Of the corners, 3 or more.
    radius : float
        From the centre to the corners.
    centre : (3,) array_like of float
        In world units.
    normal : (3,) array_like of float
        Of the plane that it lies in; the corners run counter-clockwise about it.

    Returns
    -------
    (count, 3) array of float
        In space. The first corner of one in a horizontal plane is in the direction of x.

    Raises
    ------
    InputError
        For fewer than three corners, a radius that is not positive, a centre or a normal that is not three finite
        numbers, a normal of no length.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.regular_polygon(4, 2, centre=(5, 0, 1)).round(9).tolist()
    [[7.0, 0.0, 1.0], [5.0, 2.0, 1.0], [3.0, 0.0, 1.0], [5.0, -2.0, 1.0]]
    """
    if count < 3:
        raise InputError(f"a regular polygon needs at least three corners, not {count}")
    if not (isfinite(radius) and radius > 0.0):
        raise InputError(f"a regular polygon of radius {radius:g}: expected more than 0")
    middle = _vector(centre, "the centre of a regular polygon")
    up = _vector(normal, "the normal of a regular polygon")
    length = float(norm(up))
    if not length > 0.0:
        raise InputError("the normal of a regular polygon has no length")
    angle = 2.0 * np.pi / count * np.arange(count)
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    first, second = plane_axes(up / length)
    return np.asarray(middle + matmul(radius * around, np.stack([-second, first])))


def _vector(numbers: ArrayLike, what: str) -> Floats:
    vector = np.asarray(numbers, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f"{what} must be three finite numbers")
    return vector
