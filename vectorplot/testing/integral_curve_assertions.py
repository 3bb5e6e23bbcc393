"""Assertions about curves that follow a field of directions, and about geodesics."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.sites import Sites, unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.geometry.elementary import arcsin, arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.surface import Surface, is_parametrised
from vectorplot.testing.chord_assertions import assert_chords
from vectorplot.testing.curve_points import Curves, polylines_of
from vectorplot.testing.curves import assert_on_surface, places_near
from vectorplot.testing.known_directions import KnownDirections, known_directions
from vectorplot.testing.mesh_curve_assertions import assert_mesh_geodesic, assert_mesh_integral_curve
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


class _Middles(NamedTuple):
    """The inner points (k,3) of polylines, the curve (k,) of each, the chords (k,3) before and behind it, and its
    parameters and normal; extent: of the surface."""

    curve: Ints
    points: Floats
    before: Floats
    behind: Floats
    places: Floats
    normals: Floats
    extent: float


def assert_integral_curve(
    points: Curves | SurfaceCurves, surface: Surface | Mesh, field: TangentField, tolerance: float
) -> None:
    """Nothing, where curves follow a field of directions on a surface, or a mesh, all along.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths, Drawing or SurfaceCurves
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or Mesh
        On which they run.
    field : TangentField
        Such as ConstantElevation of the room features: then it is the elevation that is verified.
    tolerance : float
        The angle with the field that is allowed, in radians; and, times the extent of the surface, the distance of
        points from it.

    Raises
    ------
    AssertionError
        With the worst point and its angle; where one curve follows a directed field here and runs against it there;
        for points where the field has no direction; for what assert_on_surface finds.
    InputError
        For a tolerance that is not positive and finite, a surface without parameters, no curve in space.

    Notes
    -----
    Drawings and curves on surfaces mostly know their directions, which are verified wherever they do: those of a
    drawing in space too, as far as its eye can tell. Elsewhere the tangent at a point is that of the circle through it
    and its neighbours: off by the square of how far the curve turns between them, and ends are not looked at. Where
    directions are known, every chord is held to the field at both its ends, but for the angle by which the field turns
    between them, and for what points may be off. On a mesh every segment is: it has the direction of its face,
    or runs along an edge that the faces on both sides lead to, or both away from.

    Source: Glaeser, section 9.4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_integral_curve
    >>> t = np.linspace(0.0, 2.0 * np.pi, 401)
    >>> circle = np.column_stack([0.8 * np.cos(t), 0.8 * np.sin(t), 0.6 + 0.0 * t])
    >>> assert_integral_curve(circle, Sphere(), features.ConstantElevation(0.0), tolerance=1e-6)
    >>> found = features.integral_curves(Sphere(), features.loxodromes(1.0), (0.0, 0.0), length=1.5)
    >>> assert_integral_curve(found, Sphere(), features.loxodromes(1.0), tolerance=1e-10)
    """
    if isinstance(surface, Mesh):
        assert not isinstance(points, SurfaceCurves), "curves of a surface are on no mesh"
        assert_mesh_integral_curve(points, surface, field, tolerance)
        return
    lines = [points[k] for k in range(len(points))] if isinstance(points, SurfaceCurves) else points
    own = _middles(lines, surface, tolerance)
    said = known_directions(points, surface)
    if said is not None:
        _check_directions(said, surface, field, tolerance)
    # Of the circle through three points: chords weighted by each other's length.
    a, b = norm(own.before)[:, None], norm(own.behind)[:, None]
    tangents = own.before * (b / a) + own.behind * (a / b)
    tangents = tangents / np.maximum(norm(tangents), LEAST_DIVISOR)[:, None]
    candidates = field.tangents(Sites(surface, *np.ascontiguousarray(own.places.T)))
    known = np.isfinite(candidates).all(axis=(0, 2))
    assert known.all(), (
        f"{int((~known).sum())} points where the field has no direction, {_name(own, int(np.argmin(known)))}"
    )
    cosines = dot(candidates, tangents[None])
    sines = norm(cross(candidates, np.broadcast_to(tangents, candidates.shape)))
    if field.directed:
        ahead = np.bincount(own.curve, weights=(cosines[0] > 0.0).astype(np.float64))
        both = (ahead > 0.0) & (ahead < np.bincount(own.curve))
        assert not both.any(), f"{int(both.sum())} curves follow the field here and run against it there"
    error = arctan2(sines, np.abs(cosines)).min(axis=0)
    if said is not None:
        assert_chords(polylines_of(lines), surface, field, tolerance)
        return
    k = int(np.argmax(error))
    assert error[k] <= tolerance, (
        f"{int((error > tolerance).sum())} of {len(error)} points are not on a curve of the field: the angle is "
        f"{error[k]:.4g} at the worst, {_name(own, k)}, tolerance {tolerance:.4g}"
    )


def _check_directions(said: KnownDirections, surface: Surface, field: TangentField, tolerance: float) -> None:
    """Nothing, where curves run in the directions of the field, wherever it has one."""
    places = places_near(surface, said.points)
    assert places.parameters is not None
    u, v = places.parameters[np.arange(len(said.points)), np.argmin(places.distance, axis=1)].T
    candidates = field.tangents(Sites(surface, np.ascontiguousarray(u), np.ascontiguousarray(v)))
    with np.errstate(invalid="ignore"):
        angles = arcsin(np.minimum(said.sines(candidates), 1.0))
        error = np.where(np.isfinite(angles), angles, np.inf).min(axis=0)
    error[~np.isfinite(candidates).all(axis=(0, 2))] = 0.0
    k = int(np.argmax(error))
    where = ", ".join(f"{x:.10g}" for x in said.points[k])
    assert error[k] <= tolerance, (
        f"{int((error > tolerance).sum())} of {len(error)} directions are not those of the field: the angle is "
        f"{error[k]:.4g} at the worst, ({where}) at u, v = {u[k]:.10g}, {v[k]:.10g}, tolerance {tolerance:.4g}"
    )


def assert_geodesic(points: Curves | SurfaceCurves, surface: Surface | Mesh, tolerance: float) -> None:
    """Nothing, where curves are geodesics of a surface: seen along its normals they are straight; or of a mesh.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths, Drawing or SurfaceCurves
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or Mesh
        On which they run.
    tolerance : float
        The geodesic curvature that is allowed, times the extent of the surface; on a mesh the angle, in radians, by
        which they turn anywhere. And, times the extent, the distance of points from it.

    Raises
    ------
    AssertionError
        With the worst point and its curvature; for what assert_on_surface finds.
    InputError
        For a tolerance that is not positive and finite, a surface without parameters, no curve in space.

    Notes
    -----
    The curvature is that of the circle through three points, in the tangent plane of the middle one: off by how far
    neighbouring chords differ in length, and by the square of their length. Curves on surfaces that know their
    directions are held to these: the curvature is what they turn by along a chord, in the tangent planes at its ends;
    it is off by the square of its length only. On a mesh a curve is straight where the
    faces on both sides of an edge are unfolded; at a vertex there is as much angle on either side, or on neither less
    than half a turn, so that it is shortest there.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_geodesic
    >>> t = np.linspace(0.0, 2.0 * np.pi, 101)
    >>> assert_geodesic(np.column_stack([np.cos(t), 0.0 * t, np.sin(t)]), Sphere(), tolerance=1e-9)
    """
    if isinstance(surface, Mesh):
        assert not isinstance(points, SurfaceCurves), "curves of a surface are on no mesh"
        assert_mesh_geodesic(points, surface, tolerance)
        return
    lines = [points[k] for k in range(len(points))] if isinstance(points, SurfaceCurves) else points
    own = _middles(lines, surface, tolerance)
    a, b = own.before, own.behind
    area = dot(own.normals, cross(a, b))
    error = own.extent * np.abs(2.0 * area / np.maximum(norm(a) * norm(b) * norm(a + b), LEAST_DIVISOR))
    k = int(np.argmax(error))
    where = _name(own, k)
    if isinstance(points, SurfaceCurves) and np.isfinite(points.directions).any():
        start, turn = _turns(points, surface)
        error = own.extent * np.abs(turn)
        k = int(np.argmax(error))
        where = f"behind {_at(points.points[start[k]])}"
    assert error[k] <= tolerance, (
        f"{int((error > tolerance).sum())} of {len(error)} points are not on a geodesic: the geodesic curvature by the "
        f"extent is {error[k]:.4g} at the worst, {where}, tolerance {tolerance:.4g}"
    )


def _turns(curves: SurfaceCurves, surface: Surface) -> tuple[Ints, Floats]:
    """The points (k,) behind which chords with known directions begin, and by how much (k,) these turn along them, by
    their length, in the tangent planes at their ends."""
    start, end = segments(curves).T
    chord = curves.points[end] - curves.points[start]
    along_u, along_v = surface.partials(curves.u, curves.v)
    tangents = unit(curves.directions[:, :1] * along_u + curves.directions[:, 1:] * along_v)
    normals = unit(cross(along_u, along_v))
    length = norm(chord)
    sines = dot(normals[start], cross(tangents[start], chord)) + dot(normals[end], cross(chord, tangents[end]))
    turn = sines / np.maximum(length * length, LEAST_DIVISOR)
    known = np.isfinite(turn) & (length > 0.0)
    return start[known], turn[known]


def _middles(points: Curves, surface: Surface, tolerance: float) -> _Middles:
    if not is_parametrised(surface):
        raise InputError(f"{type(surface).__name__} is no surface with parameters")
    if not 0.0 < tolerance < np.inf:
        raise InputError(f"tolerance {tolerance:g} must be positive and finite")
    lines = [line for line in polylines_of(points) if len(line) > 2]
    assert lines, "there are no curves of three points: nothing to verify"
    inner = np.concatenate([line[1:-1] for line in lines])
    places = places_near(surface, inner)
    assert_on_surface(lines, surface, tolerance * places.extent)
    row = np.arange(len(inner))
    nearest = np.argmin(places.distance, axis=1)
    assert places.parameters is not None
    return _Middles(
        np.repeat(np.arange(len(lines)), [len(line) - 2 for line in lines]),
        inner,
        np.concatenate([line[1:-1] - line[:-2] for line in lines]),
        np.concatenate([line[2:] - line[1:-1] for line in lines]),
        places.parameters[row, nearest],
        places.normals[row, nearest],
        places.extent,
    )


def _name(own: _Middles, k: int) -> str:
    """A point in words."""
    return f"{_at(own.points[k])} at u, v = {_at(own.places[k])[1:-1]}"


def _at(values: Floats) -> str:
    return f"({', '.join(f'{x:.10g}' for x in values)})"
