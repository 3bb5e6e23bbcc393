"""Assertions on curves: that they lie where they are said to lie, whoever traced them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import length, norm, normalize
from vectorplot.scene.light import Light
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import ImplicitSurface, Surface
from vectorplot.testing.curve_distance import Worst, worst_of_both
from vectorplot.testing.curve_points import CurvePoints, Curves, points_of, polylines_of
from vectorplot.testing.rays.nearest import nearest_places
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import ACCURACY_OF_TOLERANCE
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

AnySurface = Surface | ImplicitSurface


class Places(NamedTuple):
    """What a surface is at some points (n,3): distance (n,k) from k places on it near each, unit normals (n,k,3) and
    parameters (n,k,2) there (None: the surface has none), and the extent of the surface."""

    distance: Floats
    normals: Floats
    parameters: Floats | None
    extent: float

    def name(self, k: int, j: int) -> str:
        """The parameters of a place, in words."""
        if self.parameters is None:
            return ""
        u, v = self.parameters[k, j]
        return f" at u = {u:.10g}, v = {v:.10g}"


def assert_on_surface(points: Curves, surface: AnySurface, tolerance: float) -> None:
    """Nothing, where all points of curves lie within a distance of tolerance from a surface.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Where they shall lie.
    tolerance : float
        In world units.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its distance; for no points at all and points that are not finite.
    InputError
        For a tolerance that is not positive and finite, and for what is no surface or no curve in space.

    Notes
    -----
    The distance from an implicit surface is taken as abs(F) / abs(gradient of F), right to first order; from a
    parametrised one it is that of the nearest point found from a grid of parameters.

    Degenerate: where F is 0 the distance is 0, whatever the gradient.

    Examples
    --------
    >>> from vectorplot.surfaces import implicit_sphere
    >>> from vectorplot.testing import assert_on_surface
    >>> assert_on_surface([(1, 0, 0), (0, 1, 0), (0.6, 0, 0.8)], implicit_sphere(radius=1.0), tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    places = places_near(surface, found.points)
    _assert_near(found, places, tolerance, "the surface")


def assert_on_both(points: Curves, a: AnySurface, b: AnySurface, tolerance: float) -> None:
    """Nothing, where all points of curves lie within a distance of tolerance from two surfaces: their intersection.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    a, b : Surface or ImplicitSurface
        Where they shall lie.
    tolerance : float
        In world units.

    Raises
    ------
    AssertionError
        With the surface, the worst point, its parameters and its distance; see assert_on_surface.
    InputError
        For what assert_on_surface refuses.

    Examples
    --------
    >>> from vectorplot.surfaces import implicit_plane, implicit_sphere
    >>> from vectorplot.testing import assert_on_both
    >>> equator = [(1, 0, 0), (0.6, 0.8, 0), (0, 1, 0)]
    >>> plane = implicit_plane((0, 0, 0), (0, 0, 1), box=[(-1, -1, -1), (1, 1, 1)])
    >>> assert_on_both(equator, implicit_sphere(radius=1.0), plane, tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    for surface, name in ((a, "the first surface"), (b, "the second surface")):
        _assert_near(found, places_near(surface, found.points), tolerance, name)


def assert_contour(points: Curves, surface: AnySurface, eye: Camera | ArrayLike, tolerance: float) -> None:
    """Nothing, where all points of curves are points of the contour of a surface: n . (x - eye) = 0.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Whose contour it is.
    eye : Camera or (3,) array_like of float
        A camera, which may be parallel, or the place of the eye.
    tolerance : float
        The angle in radians that the sight ray may make with the tangent plane; and, times the extent of the surface,
        the distance that points may have from it.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its angle; for points without a normal; for what assert_on_surface
        finds.
    InputError
        For a tolerance that is not positive and finite, and for what is no surface or no curve in space.

    Notes
    -----
    Degenerate: of several sheets that meet in a point, one that fits is enough.

    Source: Glaeser, section 8.4, equation 27.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_contour
    >>> t = np.linspace(0.0, 2.0 * np.pi, 25)
    >>> equator = np.column_stack([np.cos(t), np.sin(t), 0.0 * t])
    >>> assert_contour(equator, Sphere(radius=1.0), vp.Camera.view("top"), tolerance=1e-9)
    """

    def error(rays: Floats, normals: Floats) -> Floats:
        across = length(np.cross(normals, rays))
        return np.asarray(np.abs(arctan2((normals * rays).sum(axis=-1), across)))

    found, places = _on(points, surface, tolerance)
    text = "not on the contour: the angle between sight ray and tangent plane"
    _assert_angle(found, places, error(_sight_rays(found.points, eye)[:, None], places.normals), tolerance, text)


def assert_isophote(
    points: Curves, surface: AnySurface, light: Light | ArrayLike, angle: float, tolerance: float
) -> None:
    """Nothing, where all points of curves are points of an isophote: normal and direction to the light make an angle.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Whose isophote it is.
    light : Light or (3,) array_like of float
        A light, which may be a point, or the direction to it.
    angle : float
        In radians, 0 to pi, with the surface's own normals: x_u cross x_v, or the gradient; on the other side it is pi
        less that.
    tolerance : float
        The difference of angles that is allowed, in radians; and, times the extent of the surface, the distance of
        points from it.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its angle; for points without a normal; for what assert_on_surface
        finds.
    InputError
        For an angle that is not between 0 and pi, a tolerance that is not positive and finite, and for what is no
        surface or no curve in space.

    Notes
    -----
    Degenerate: of several sheets that meet in a point, one that fits is enough.

    Source: Glaeser, section 8.4, equation 28.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_isophote
    >>> t = np.linspace(0.0, 2.0 * np.pi, 25)
    >>> circle = np.column_stack([0.8 * np.cos(t), 0.8 * np.sin(t), 0.6 + 0.0 * t])
    >>> assert_isophote(circle, Sphere(radius=1.0), (0, 0, 1), np.arccos(0.6), tolerance=1e-9)
    """
    if not 0.0 <= angle <= np.pi:
        raise InputError(f"isophote: an angle of {angle:g} is not between 0 and pi")
    found, places = _on(points, surface, tolerance)
    rays, normals = _light_rays(found.points, light)[:, None], places.normals
    error = np.abs(arctan2(length(np.cross(normals, rays)), (normals * rays).sum(axis=-1)) - angle)
    text = f"not on the isophote of {angle:.10g}: the difference of the angle between normal and light"
    _assert_angle(found, places, error, tolerance, text)


def assert_same_curve(a: Curves, b: Curves, tolerance: float, *, closed: bool = False) -> None:
    """Nothing, where two curves are within tolerance of each other everywhere, between their points too.

    Parameters
    ----------
    a, b : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3); of a drawing those in the world.
    tolerance : float
        The Hausdorff distance that is allowed.
    closed : bool
        Both close even where the last point does not repeat the first.

    Raises
    ------
    AssertionError
        With the worst point, where it is on its curve, and its distance from the other one.
    InputError
        For a tolerance that is not positive and finite, for what is no curve, and for one in the plane and one in
        space.

    Notes
    -----
    Direction, start, sampling and splitting do not matter: curves are compared as sets of points.

    Examples
    --------
    >>> from vectorplot.testing import assert_same_curve
    >>> assert_same_curve([(0, 0), (2, 0)], [[(2, 0), (1, 0)], [(1, 0), (0, 0)]], tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    worst = worst_of_both(a, b, closed=closed, accuracy=ACCURACY_OF_TOLERANCE * tolerance, enough=tolerance)
    assert worst.distance <= tolerance, _difference(worst, tolerance)


def assert_closed(curve: Curves, tolerance: float | None = None) -> None:
    """Nothing, where every curve ends where it starts.

    Parameters
    ----------
    curve : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3).
    tolerance : float, optional
        The gap that is allowed; 1e-9 of the extent of each curve where None.

    Raises
    ------
    AssertionError
        With the curve, its two ends and the gap between them; for curves of one place only, no points at all and points
        that are not finite.
    InputError
        For what is no curve.

    Examples
    --------
    >>> from vectorplot.testing import assert_closed
    >>> assert_closed([(0, 0), (1, 0), (1, 1), (0, 0)])
    >>> assert_closed([(0, 0), (1, 0), (1, 1)])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    AssertionError: 1 of 1 curves are open: from point 0, (0, 0), to point 2, (1, 1), there is a gap of 1.414, ...
    """
    found = points_of(curve)
    first = np.flatnonzero(found.place == 0)
    last = np.append(first[1:], len(found.points)) - 1
    extent = length(np.maximum.reduceat(found.points, first) - np.minimum.reduceat(found.points, first))
    gap = length(found.points[last] - found.points[first])
    assert (extent > 0.0).all(), f"curve {int(np.argmin(extent))} is a single place"
    allowed = ZERO_OF_EXTENT * extent if tolerance is None else np.full(len(first), tolerance)
    worst = int(np.argmax(gap / np.maximum(allowed, LEAST_DIVISOR)))
    assert gap[worst] <= allowed[worst], (
        f"{int((gap > allowed).sum())} of {len(first)} curves are open: from {found.name(int(first[worst]))}, to "
        f"{found.name(int(last[worst]))}, there is a gap of {gap[worst]:.4g}, tolerance {allowed[worst]:.4g}"
    )


class BranchCount(NamedTuple):
    """How many connected pieces curves have.

    Parameters
    ----------
    closed : int
        Pieces without a loose end.
    open : int
        Pieces with one or more.
    nodes : int
        At how many places more than two ends meet.

    Examples
    --------
    >>> from vectorplot.testing import branch_count
    >>> branch_count([[(0, 0), (1, 0)], [(0, 0), (0, 1)], [(0, 0), (-1, 0)]])
    BranchCount(closed=0, open=1, nodes=1)
    """

    closed: int
    open: int
    nodes: int


def branch_count(curves: Curves, tolerance: float | None = None) -> BranchCount:
    """How many branches there are when polylines are joined whose ends meet.

    Parameters
    ----------
    curves : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3); of a drawing those in the world. A closed one repeats its first point.
    tolerance : float, optional
        How far ends that meet may be apart; 1e-9 of the extent where None.

    Returns
    -------
    BranchCount
        Of closed ones, of open ones, and of nodes: the cutting of a curve into strokes does not count.

    Raises
    ------
    InputError
        For what is no curve.
    AssertionError
        For points that are not finite.

    Notes
    -----
    Degenerate: polylines of one place do not count at all; curves that cross between their ends are not joined.

    Examples
    --------
    >>> from vectorplot.testing import branch_count
    >>> halves = [[(0, 0), (1, 0), (1, 1)], [(1, 1), (0, 1), (0, 0)]]
    >>> branch_count(halves)
    BranchCount(closed=1, open=0, nodes=0)
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    parts = [part for part in polylines_of(curves) if np.ptp(part, axis=0).any()]
    if not parts:
        return BranchCount(0, 0, 0)
    ends = points_of([end for part in parts for end in (part[:1], part[-1:])]).points
    extent = float(norm(np.ptp(np.concatenate(parts), axis=0)))
    pairs = cKDTree(ends).query_pairs(
        ZERO_OF_EXTENT * extent if tolerance is None else tolerance, output_type="ndarray"
    )

    def groups(links: ArrayLike, count: int) -> tuple[int, Floats]:
        i, j = np.asarray(links).reshape(-1, 2).T
        return connected_components(coo_array((np.ones(len(i)), (i, j)), shape=(count, count)), directed=False)  # type: ignore[no-any-return]

    count, node = groups(pairs, len(ends))
    degree = np.bincount(node, minlength=count)
    branches, branch = groups(node.reshape(-1, 2), count)
    loose = np.bincount(branch[degree == 1], minlength=branches) > 0
    return BranchCount(int((~loose).sum()), int(loose.sum()), int((degree > 2).sum()))


def places_near(surface: AnySurface, points: Floats) -> Places:
    """The places of a surface near points (n,3); of an implicit surface the point itself stands for its place."""
    implicit = callable(getattr(surface, "gradients", None))
    if not implicit and not callable(getattr(surface, "partials", None)):
        raise InputError(f"{type(surface).__name__} is no surface: it has neither partials nor gradients")
    return _implicit_places(surface, points) if implicit else _parametrised_places(surface, points)  # type: ignore[arg-type]


def _implicit_places(surface: ImplicitSurface, points: Floats) -> Places:
    value, gradient = np.abs(surface.values(points)), surface.gradients(points)
    slope = length(gradient)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.where(value == 0.0, 0.0, value / slope)
        normals = gradient / slope[:, None]
    distance = np.where(np.isnan(distance), np.inf, distance)
    extent = float(norm(np.ptp(np.asarray(surface.box), axis=0)))
    return Places(distance[:, None], normals[:, None], None, extent)


def _parametrised_places(surface: Surface, points: Floats) -> Places:
    feet = nearest_places(surface, points)
    normals = unit_normals(surface, feet.u, feet.v)
    return Places(feet.distance, normals, np.stack([feet.u, feet.v], axis=-1), feet.extent)


def _points_in_space(points: Curves) -> CurvePoints:
    found = points_of(points)
    if found.points.shape[1] != 3:
        raise InputError("points on surfaces have three coordinates")
    return found


def _check_tolerance(tolerance: float) -> None:
    if not 0.0 < tolerance < np.inf:
        raise InputError(f"tolerance {tolerance:g} must be positive and finite")


def _on(points: Curves, surface: AnySurface, tolerance: float) -> tuple[CurvePoints, Places]:
    """Points and their places on a surface. Errors: AssertionError where they are not on it."""
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    places = places_near(surface, found.points)
    _assert_near(found, places, tolerance * places.extent, "the surface")
    return found, places


def _assert_near(found: CurvePoints, places: Places, tolerance: float, name: str) -> None:
    """Nothing where the nearest place of each point is within tolerance."""
    nearest = np.argmin(places.distance, axis=1)
    distance = places.distance[np.arange(len(nearest)), nearest]
    k = int(np.argmax(distance))
    assert distance[k] <= tolerance, (
        f"{int((distance > tolerance).sum())} of {len(distance)} points are not on {name}: the worst, "
        f"{found.name(k)}{places.name(k, int(nearest[k]))}, is {distance[k]:.4g} away, tolerance {tolerance:.4g}"
    )


def _assert_angle(found: CurvePoints, places: Places, error: Floats, tolerance: float, text: str) -> None:
    """Nothing where the angle is right on one sheet at least through each point."""
    sheet = places.distance <= tolerance * places.extent
    known = np.isfinite(error) & sheet
    lost = np.flatnonzero(~known.any(axis=1))
    assert not len(lost), f"{len(lost)} points have no normal, the first: {found.name(int(lost[0]))}"
    error = np.where(known, error, np.inf)
    best = np.argmin(error, axis=1)
    least = error[np.arange(len(best)), best]
    k = int(np.argmax(least))
    assert least[k] <= tolerance, (
        f"{int((least > tolerance).sum())} of {len(least)} points are {text} is {least[k]:.4g} at the worst, "
        f"{found.name(k)}{places.name(k, int(best[k]))}, tolerance {tolerance:.4g}"
    )


def _unit_arms(points: Floats, place: Floats) -> Floats:
    """(n,3) unit vectors from points to a place; NaN where they coincide."""
    arm = place - points
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(arm / length(arm)[:, None])


def _sight_rays(points: Floats, eye: Camera | ArrayLike) -> Floats:
    """(n,3) unit vectors to the eye."""
    if isinstance(eye, Camera) and eye.parallel:
        return np.broadcast_to(eye.direction, points.shape)
    return _unit_arms(points, vector("eye", eye.eye if isinstance(eye, Camera) else eye))


def _light_rays(points: Floats, light: Light | ArrayLike) -> Floats:
    """(n,3) unit vectors to the light."""
    if isinstance(light, Light) and not light.parallel:
        return _unit_arms(points, vector("light", light.position))
    direction = vector("light", light.position if isinstance(light, Light) else light)
    return np.broadcast_to(normalize(direction), points.shape)


def _difference(worst: Worst, tolerance: float) -> str:
    """One line on where a curve leaves the other one."""
    place = ", ".join(f"{x:.10g}" for x in worst.point)
    return (
        f"the curves differ: ({place}), at {worst.parameter:.6g} (index and share of the segment) of the "
        f"{worst.which} one's curve {worst.curve}, is {worst.distance:.4g} away from the other, "
        f"tolerance {tolerance:.4g}"
    )
