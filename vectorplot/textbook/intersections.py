"""Where lines, planes, segments and convex polygons meet, many at once; planes in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import angle, cross, dot, length, normalize, point_on_line
from vectorplot.tolerances import INFINITE, PARALLEL_SINE, ROUNDING, ZERO_OF_EXTENT

# Planes in space, many at once.


@dataclass(frozen=True, eq=False)
class Plane:
    """Planes n.x = c.

    Parameters
    ----------
    normal : (..., 3) array of float
        Of any length but zero.
    point : (..., 3) array of float
        A point of each plane.

    Raises
    ------
    InputError
        For a normal without length.

    Notes
    -----
    The point is kept, and distances are measured from it, because n.x - c loses its digits far from the origin.

    Source: Glaeser, section 1.1, equations 8 to 10.

    Examples
    --------
    >>> from vectorplot.textbook import Plane
    >>> plane = Plane.through((0, 0, 2), (1, 0, 2), (0, 1, 2))
    >>> plane.normal.tolist(), plane.constant.item()
    ([0.0, 0.0, 1.0], 2.0)
    >>> plane.distance([(5, 5, 5), (0, 0, 0)]).tolist(), plane.side([(5, 5, 5), (0, 0, 0)]).tolist()
    ([3.0, -2.0], [1, -1])
    """

    normal: Floats
    point: Floats

    def __post_init__(self) -> None:
        for name in ("normal", "point"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))
        if not np.all(length(self.normal) > 0.0):
            raise InputError("a plane needs a normal that has a length")

    @classmethod
    def through(cls, p: ArrayLike, q: ArrayLike, r: ArrayLike) -> Plane:
        """The planes through three points each.

        p, q, r (...,3): they run counter-clockwise seen from the normal's tip; result: as many as there are triples of
        points.
        Errors: for three points on a line.
        """
        p, q, r = (np.asarray(x, dtype=np.float64) for x in (p, q, r))
        u, v = q - p, r - p
        normal = cross(u, v)
        size = np.maximum(np.abs(p), np.maximum(np.abs(q), np.abs(r))).max(axis=-1)
        noise = ROUNDING * size * np.maximum(length(u), length(v))
        if not np.all(length(normal) > np.maximum(PARALLEL_SINE * length(u) * length(v), noise)):
            raise InputError("three points on a line span no plane")
        return cls(normal, np.broadcast_to(p, normal.shape))

    @classmethod
    def of_equation(cls, normal: ArrayLike, constant: ArrayLike) -> Plane:
        """The planes n.x = c.

        normal (...,3): of any length but zero; constant (...): the c of each plane; result: with the point that is
        nearest to the origin.
        Errors: for a normal without length.
        """
        n = np.asarray(normal, dtype=np.float64)
        squared = dot(n, n)
        if not np.all(squared > 0.0):
            raise InputError("a plane needs a normal that has a length")
        return cls(n, n * (np.asarray(constant, dtype=np.float64) / squared)[..., None])

    @property
    def constant(self) -> Floats:
        """(...) the c of n.x = c."""
        return dot(self.normal, self.point)

    def distance(self, points: ArrayLike) -> Floats:
        """Signed distances of points.

        points (...,3): in space; result: (...) positive on the normal's side.
        """
        return np.asarray(dot(self.normal, np.asarray(points, dtype=np.float64) - self.point) / length(self.normal))

    def side(self, points: ArrayLike) -> NDArray[np.int8]:
        """The sides of the planes that points lie on.

        points (...,3): in space; result: (...) 1 on the normal's side, -1 on the other; a point in the plane counts as
        1.
        In the plane means: as near as rounding can tell. Exact signs for three given points: orient3d.
        """
        arm = np.asarray(points, dtype=np.float64) - self.point
        noise = ROUNDING * np.maximum(np.abs(points), np.abs(self.point)).max(axis=-1)
        return np.where(dot(self.normal, arm) < -noise * length(self.normal), -1, 1).astype(np.int8)


@dataclass(frozen=True, eq=False)
class LineCut:
    """Where lines are cut.

    point: (..., k) in the plane or in space; parameter: (...) how many directions from the line's first point;
    parallel: (...) whether the line is parallel to what should cut it.
    Edge cases: a line that lies in what should cut it is cut at its first point, parameter 0; one that never meets it
    is cut infinitely far out. Both are flagged parallel.
    """

    point: Floats
    parameter: Floats
    parallel: Bools


def line_and_plane(start: ArrayLike, direction: ArrayLike, plane: Plane) -> LineCut:
    """The points where lines start + t * direction pierce planes.

    start, direction (...,3): a point and a direction of each line; plane: one for all lines, or one for each; result:
    the points, and their parameters t.
    Edge cases: for lines that are parallel to the plane see LineCut.
    Source: Glaeser, section 1.3, equation 16; erratum G1-03.
    """
    a, d = np.asarray(start, dtype=np.float64), np.asarray(direction, dtype=np.float64)
    arm = plane.point - a
    below, rise = dot(plane.normal, arm), dot(plane.normal, d)
    size = length(plane.normal)
    parallel = np.abs(rise) <= PARALLEL_SINE * size * length(d)
    zero = np.maximum(ZERO_OF_EXTENT * length(arm), ROUNDING * np.maximum(np.abs(plane.point), np.abs(a)).max(axis=-1))
    return _cut(a, d, below, rise, parallel, np.abs(below) <= zero * size)


def line_and_line(a: ArrayLike, d: ArrayLike, b: ArrayLike, e: ArrayLike) -> LineCut:
    """The points where lines a + t d meet the coplanar lines b + s e, in the plane or in space (..., 2 or 3), with t.
    In space the equation is read along d x e, so upright planes will do; of skew lines it is the point of the first
    nearest to the second.
    Edge cases: parallel lines, see LineCut. Source: Glaeser, section 1.3, equations 17 to 20; erratum G1-01.
    """
    a, d, b, e = (np.asarray(x, dtype=np.float64) for x in (a, d, b, e))
    arm = b - a
    across, normal = _products(arm, e, d)
    squared = dot(normal, normal)
    parallel = squared <= (PARALLEL_SINE * length(d) * length(e)) ** 2
    off = length(_products(arm, d, d)[0])
    noise = ROUNDING * np.maximum(np.abs(a), np.abs(b)).max(axis=-1)
    same = off <= np.maximum(ZERO_OF_EXTENT * length(arm), noise) * length(d)
    return _cut(a, d, dot(across, normal), squared, parallel, same)


def _products(arm: Floats, e: Floats, d: Floats) -> tuple[Floats, Floats]:
    """arm x e and d x e as vectors (..., 1 or 3)."""
    first, second = cross(arm, e), cross(d, e)
    return (first[..., None], second[..., None]) if e.shape[-1] == 2 else (first, second)


def _cut(a: Floats, d: Floats, above: Floats, below: Floats, parallel: Bools, within: Bools) -> LineCut:
    t = np.where(parallel, np.where(within, 0.0, INFINITE), above / np.where(parallel, 1.0, below))
    a = np.broadcast_to(a, np.broadcast_shapes(a.shape, d.shape, (*t.shape, 1)))
    # Infinity times a zero component is no number.
    step = np.where(d == 0.0, 0.0, t[..., None] * np.where(d == 0.0, 1.0, d))
    return LineCut(np.asarray(a + step), t, np.broadcast_to(parallel, t.shape))


def segments(p1: ArrayLike, q1: ArrayLike, p2: ArrayLike, q2: ArrayLike) -> tuple[Floats, Floats, Bools]:
    """Parameters (...) on the lines of segments p1 q1 and p2 q2 (..., 2 or 3) where they meet, 0 at p and 1 at q, and
    whether they do; the segments cross where both lie in [0, 1].
    Edge cases: parallel or identical lines give False and infinite parameters. Source: Glaeser, section 1.3.
    """
    p1, q1, p2, q2 = (np.asarray(x, dtype=np.float64) for x in (p1, q1, p2, q2))
    first = line_and_line(p1, q1 - p1, p2, q2 - p2)
    second = line_and_line(p2, q2 - p2, p1, q1 - p1)
    parallel = first.parallel | second.parallel
    t1, t2 = (np.where(parallel, INFINITE, cut.parameter) for cut in (first, second))
    return t1, t2, np.asarray(~parallel)


def polygons_common_segment(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Bools]:
    """The segments in which planar convex polygons in space pierce each other, and whether there is one.

    Parameters
    ----------
    first : (..., n, 3) array_like of float
        Corners in either sense.
    second : (..., m, 3) array_like of float
        The same; leading axes are broadcast, so many pairs go at once.

    Returns
    -------
    (..., 2, 3) array of float
        Both ends; where there is no segment undefined numbers, but finite.
    (...) array of bool
        Whether there is one.

    Raises
    ------
    InputError
        For polygons of fewer than three corners.

    Notes
    -----
    Edge cases: none for parallel or coplanar polygons, and for polygons that touch in a single point; an edge of one
    that lies in the other counts.

    Source: Glaeser, section 1.3, equations 21 and 22; errata G1-01, G1-02, G1-03.

    Examples
    --------
    >>> from vectorplot.textbook import polygons_common_segment
    >>> floor = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)]
    >>> sail = [(1, 1, -1), (1, 1, 1), (1, 3, 0)]
    >>> ends, exists = polygons_common_segment(floor, sail)
    >>> ends.tolist(), exists.item()
    ([[1.0, 2.0, 0.0], [1.0, 1.0, 0.0]], True)
    """
    p, q = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    if p.shape[-2] < 3 or q.shape[-2] < 3:
        raise InputError("a polygon needs three corners")
    lead = np.broadcast_shapes(p.shape[:-2], q.shape[:-2])
    p, q = (np.broadcast_to(x, (*lead, *x.shape[-2:])) for x in (p, q))
    n, m = _area_vector(p), _area_vector(q)
    along = cross(n, m)
    flat = (length(n) == 0.0) | (length(m) == 0.0) | (length(along) <= PARALLEL_SINE * length(n) * length(m))
    along = along / np.where(flat, 1.0, length(along))[..., None]
    extent = np.maximum(np.ptp(p, axis=-2).max(axis=-1), np.ptp(q, axis=-2).max(axis=-1))
    largest = np.maximum(np.abs(p).max(axis=(-1, -2)), np.abs(q).max(axis=(-1, -2)))
    zero = np.maximum(ZERO_OF_EXTENT * extent, ROUNDING * largest)
    origin = p[..., 0, :]
    ends = [_trace(x, y, normal, along, origin, zero) for x, y, normal in ((p, q, m), (q, p, n))]
    low, high = (np.stack([end[k] for end in ends], axis=-1) for k in (0, 1))
    later, sooner = low.argmax(axis=-1), high.argmin(axis=-1)
    exists = ~flat & (high.min(axis=-1) - low.max(axis=-1) > zero)
    start = np.where((later == 0)[..., None], ends[0][2], ends[1][2])
    stop = np.where((sooner == 0)[..., None], ends[0][3], ends[1][3])
    return np.stack([start, stop], axis=-2), np.asarray(exists)


def _area_vector(polygon: Floats) -> Floats:
    arm = polygon - polygon[..., :1, :]
    return np.asarray(np.cross(arm, np.roll(arm, -1, axis=-2)).sum(axis=-2))


def _trace(
    polygon: Floats, other: Floats, normal: Floats, along: Floats, origin: Floats, zero: Floats
) -> tuple[Floats, Floats, Floats, Floats]:
    """Where a polygon meets the plane of the other one: smallest and largest parameter along a direction, and the
    points there; infinite parameters the wrong way round where it does not."""
    unit = normal / np.where(length(normal) > 0.0, length(normal), 1.0)[..., None]
    height = dot(polygon - other[..., :1, :], unit[..., None, :])
    height = np.where(np.abs(height) <= zero[..., None], 0.0, height)
    following = np.roll(height, -1, axis=-1)
    crosses = height * following < 0.0
    share = np.where(crosses, height / np.where(crosses, height - following, 1.0), 0.0)
    points = point_on_line(polygon, np.roll(polygon, -1, axis=-2), share)
    hit = crosses | (height == 0.0)
    t = dot(points - origin[..., None, :], along[..., None, :])
    low, high = np.where(hit, t, INFINITE), np.where(hit, t, -INFINITE)
    first = np.take_along_axis(points, low.argmin(axis=-1)[..., None, None], axis=-2)[..., 0, :]
    last = np.take_along_axis(points, high.argmax(axis=-1)[..., None, None], axis=-2)[..., 0, :]
    return low.min(axis=-1), high.max(axis=-1), first, last


def point_at_distance(p: ArrayLike, q: ArrayLike, distance: ArrayLike) -> Floats:
    """The points of lines PQ at some distance from P, towards Q.

    p, q: (..., k) two points of each line; distance: (...) negative distances lie beyond P; result: (..., k) points of
    the lines.
    Source: Glaeser, section 1.2, equation 13.
    """
    p, q = np.asarray(p, dtype=np.float64), np.asarray(q, dtype=np.float64)
    size = np.maximum(np.abs(p).max(axis=-1), np.abs(q).max(axis=-1))
    return np.asarray(p + np.asarray(distance)[..., None] * normalize(q - p, magnitude=size))


def angle_line_plane(direction: ArrayLike, normal: ArrayLike) -> Floats:
    """The angles between lines and planes given by their normals, in radians.

    direction: (..., 3) of the lines; normal: (..., 3) of the planes; result: (...) -pi/2 to pi/2: 0 in the plane,
    positive towards the normal.
    Source: Glaeser, section 1.2.
    """
    return np.asarray(np.pi / 2.0 - angle(direction, normal))


def angle_planes(normal: ArrayLike, other: ArrayLike) -> Floats:
    """The angles between planes: those of their normals, in radians.

    normal, other: (..., 3) of any length but zero; result: (...) 0 to pi.
    Source: Glaeser, section 1.2.
    """
    return angle(normal, other)


def lambert_cosine(normal: ArrayLike, point: ArrayLike, light: ArrayLike) -> Floats:
    """The cosines that say how brightly faces are lit: 1 facing the light, negative on the side turned away.

    normal: (..., 3) of the faces, of any length but zero; point: (..., 3) their barycentres; light: (..., 3) where the
    light stands, or (x, y, z, 0) for parallel rays that come from the direction (x, y, z); result: (...) -1 to 1.
    Source: Glaeser, sections 1.2 and 4.5.
    """
    light = np.asarray(light, dtype=np.float64)
    point = np.asarray(point, dtype=np.float64)
    if light.shape[-1] == 4:
        ray = light[..., :3] - light[..., 3:] * point
    else:
        ray = light - point
    return dot(normalize(normal), normalize(ray))


def from_spherical_coordinates(coordinates: ArrayLike) -> Floats:
    """The points with some distances, azimuths and elevations.

    coordinates: (..., 3) as spherical_coordinates gives them, angles in radians; result: (..., 3) in space.
    Source: Glaeser, section 2.4.
    """
    distance, azimuth, elevation = np.moveaxis(np.asarray(coordinates, dtype=np.float64), -1, 0)
    across = distance * np.cos(elevation)
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), distance * np.sin(elevation)], axis=-1)
