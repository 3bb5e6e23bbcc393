"""Assertions about curves that follow a field of directions, and about geodesics, on surfaces and on meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import SurfaceCurves
from vectorplot.features.mesh_integration import (
    NO_SIDE,
    MeshSides,
    corner_angles,
    face_field_flow,
    mesh_sides,
    starts_in_faces,
)
from vectorplot.features.nearest import nearest_on_mesh
from vectorplot.features.surface_points import BentFaces, Sites, unit
from vectorplot.features.tangent_fields import TangentField
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arcsin, arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.pictures.followed_lines import on_page
from vectorplot.surfaces.surface import Surface, is_parametrised
from vectorplot.testing.curves import Curves, assert_chords, assert_on_surface, places_near, polylines_of
from vectorplot.tolerances import LEAST_DIVISOR, ZERO_OF_EXTENT

# Curves that say themselves in which directions they run, as the assertions take them.


@dataclass(frozen=True, eq=False)
class KnownDirections:
    """Points (k,3) of curves, and unit vectors (k,3) in which they run; or, where these are known from a picture only,
    to which they are at right angles: normals of the planes through the eye in which they run."""

    points: Floats
    directions: Floats
    normal: bool

    def sines(self, tangents: Floats) -> Floats:
        """(...,k) of the angles by which unit tangents (...,k,3) are off, in space."""
        if self.normal:
            return np.abs(dot(tangents, self.directions))
        return norm(cross(tangents, np.broadcast_to(self.directions, tangents.shape)))


def known_directions(points: Curves | SurfaceCurves, surface: Surface) -> KnownDirections | None:
    """What curves on a surface, or the smooth strokes of a drawing, say of their directions; None where they say
    nothing."""
    if isinstance(points, SurfaceCurves):
        along_u, along_v = surface.partials(points.u, points.v)
        found = points.directions[:, :1] * along_u + points.directions[:, 1:] * along_v
        return _known(points.points, found, normal=False)
    if not isinstance(points, Drawing):
        return None
    every = [paths for layer in points.layers for paths in layer.strokes if len(paths)]
    if not every:
        return None
    at = np.concatenate([np.repeat(paths.points3d, 2, axis=0) for paths in every])
    angle = np.concatenate([paths.directions.ravel() for paths in every])
    # How the page sees the axes of space: what it sees of a tangent is this times the tangent.
    ways = np.stack([on_page(at, axis, points.page_from_world) for axis in np.eye(3)], axis=-1)
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return _known(at, cosine * ways[:, 1] - sine * ways[:, 0], normal=True)


def _known(points: Floats, vectors: Floats, *, normal: bool) -> KnownDirections | None:
    directions = unit(vectors)
    known = np.isfinite(directions).all(axis=1)
    return KnownDirections(points[known], directions[known], normal) if known.any() else None


# Whether curves on a mesh follow a field of directions, and whether they are geodesics.

LEAST = 100.0
"""Times what tells places apart that segments are long, at least, where their directions are looked at."""


@dataclass(frozen=True, eq=False)
class _Segments:
    """Segments of polylines on a mesh: starts and ends (s,3), the part of a face (s,) that each is in, the polyline
    (s,) it is of; slack: lengths below that are none."""

    sides: MeshSides
    start: Floats
    end: Floats
    face: Ints
    line: Ints
    slack: float

    @property
    def ways(self) -> Floats:
        """(s,3) unit vectors along them."""
        step = self.end - self.start
        return np.asarray(step / np.maximum(norm(step), LEAST_DIVISOR)[:, None])

    def corners(self) -> tuple[Ints, Ints]:
        """The sides of their faces one after the other, and the segment of each."""
        corner, offsets = ragged.take(self.sides.mesh.offsets, self.face)
        return corner, ragged.owner(np.diff(offsets))


def assert_mesh_integral_curve(points: Curves, mesh: Mesh, field: TangentField, tolerance: float) -> None:
    """Nothing, where every segment of curves has the direction of its face, or follows an edge that both sides lead to,
    or both away from. Errors: see assert_integral_curve."""
    own = _segments(points, mesh, tolerance)
    flow = face_field_flow(own.sides, BentFaces(mesh), field)
    candidates = flow.candidates[:, own.face]
    known = np.isfinite(candidates).all(axis=(0, 2))
    step, length = own.end - own.start, norm(own.end - own.start)
    across = np.where(known, norm(cross(candidates, np.broadcast_to(step, candidates.shape))).min(axis=0), np.inf)
    free = _in_valleys(own, flow.candidates[0], tolerance) | (length < LEAST * own.slack)
    wrong = (across > np.sin(min(tolerance, 0.5 * np.pi)) * length + own.slack) & ~free
    if field.directed:
        ahead = np.nan_to_num(dot(flow.candidates[0, own.face], step)) > 0.0
        count = np.bincount(own.line[~free], minlength=own.line[-1] + 1)
        with_it = np.bincount(own.line[~free], weights=ahead[~free], minlength=len(count))
        both = (with_it > 0.0) & (with_it < count)
        assert not both.any(), f"{int(both.sum())} curves follow the field here and run against it there"
    k = int(np.argmax(np.where(wrong, across / np.maximum(length, LEAST_DIVISOR), -1.0)))
    assert not wrong.any(), (
        f"{int(wrong.sum())} of {len(wrong)} segments are not on a curve of the field: the sine of the angle is "
        f"{across[k] / max(length[k], LEAST_DIVISOR):.4g} at the worst, {_name(own.start[k])}, "
        f"tolerance {tolerance:.4g}"
    )


def assert_mesh_geodesic(points: Curves, mesh: Mesh, tolerance: float) -> None:
    """Nothing, where curves are straight on unfolded faces, and turn no more than they must at vertices.

    Errors: see assert_geodesic.
    """
    own = _segments(points, mesh, tolerance)
    pair = np.flatnonzero(own.line[1:] == own.line[:-1])
    turn = np.zeros(len(pair))
    back, ahead = -own.ways[pair], own.ways[pair + 1]
    same = own.face[pair] == own.face[pair + 1]
    turn[same] = np.pi - _between(back[same], ahead[same])
    vertex, beyond = _at_vertices(own, pair, own.end[pair]), _at_vertices(own, pair + 1, own.end[pair])
    through = np.flatnonzero((vertex != NO_SIDE) & (beyond != NO_SIDE))
    turn[through] = _turns_at_vertices(own, vertex[through], back[through], beyond[through], ahead[through])
    over = np.flatnonzero(~same & ((vertex == NO_SIDE) | (beyond == NO_SIDE)))
    side = _common_sides(own, pair[over])
    assert (side != NO_SIDE).all(), (
        f"{int((side == NO_SIDE).sum())} segments lead to faces that no edge joins, "
        f"{_name(own.end[pair[over[np.argmin(side)]]])}"
    )
    edge = own.sides.along[side]
    turn[over] = np.pi - _between(back[over], edge) - _between(edge, ahead[over])
    # What is nearer than rounding can be told has no direction.
    short = np.minimum(norm(own.end - own.start)[pair], norm(own.end - own.start)[pair + 1])
    turn = np.where(short < LEAST * own.slack, 0.0, np.abs(turn) - own.slack / np.maximum(short, own.slack))
    k = int(np.argmax(turn)) if len(turn) else 0
    assert not (turn > tolerance).any(), (
        f"{int((turn > tolerance).sum())} of {len(turn)} points are not on a geodesic: it turns by {turn[k]:.4g} "
        f"at the worst, {_name(own.end[pair[k]])}, tolerance {tolerance:.4g}"
    )


def _segments(points: Curves, mesh: Mesh, tolerance: float) -> _Segments:
    if not 0.0 < tolerance < np.inf:
        raise InputError(f"tolerance {tolerance:g} must be positive and finite")
    sides = mesh_sides(mesh)
    slack = max(ZERO_OF_EXTENT * sides.extent, sides.rounding)
    lines = [np.asarray(line) for line in polylines_of(points)]
    lines = [line[np.append(True, norm(np.diff(line, axis=0)) > slack)] for line in lines]
    lines = [line for line in lines if len(line) > 1]
    assert lines, "there are no curves of two points: nothing to verify"
    start, end = (np.concatenate([line[a:b] for line in lines]) for a, b in ((0, -1), (1, None)))
    places = nearest_on_mesh(mesh, 0.5 * (start + end), end - start)
    k = int(np.argmax(places.distances))
    assert places.distances[k] <= tolerance * sides.extent, (
        f"a segment is {places.distances[k]:.4g} away from the mesh, {_name(0.5 * (start[k] + end[k]))}"
    )
    face, _ = starts_in_faces("curves", mesh, sides, places.faces, places.points)
    return _Segments(sides, start, end, face, ragged.owner([len(line) - 1 for line in lines]), slack)


def _in_valleys(own: _Segments, directions: Floats, tolerance: float) -> Bools:
    """(s,) which segments run along a side that both its faces, with directions (f,3), lead to, or both away from."""
    corner, segment = own.corners()
    sides = own.sides
    on = np.ones(len(corner), dtype=np.bool_)
    for end in (own.start, own.end):
        on &= np.abs(dot(end[segment] - sides.starts(corner), sides.inwards[corner])) <= own.slack
    corner, segment = corner[on], segment[on]
    least = np.sin(min(tolerance, 0.5 * np.pi))
    held = np.zeros(len(corner), dtype=np.bool_)
    across = sides.across[corner]
    for way in (1.0, -1.0):
        leads = [way * dot(sides.inwards[c], directions[sides.mesh.corner_face[c]]) > least for c in (corner, across)]
        held |= ~leads[0] & (~leads[1] | (across == NO_SIDE))
    result = np.zeros(len(own.face), dtype=np.bool_)
    result[segment[held]] = True
    return result


def _at_vertices(own: _Segments, segment: Ints, points: Floats) -> Ints:
    """(k,) the corners of the faces of segments (k,) at their ends (k,3), NO_SIDE where these are at none."""
    corner, offsets = ragged.take(own.sides.mesh.offsets, own.face[segment])
    of = ragged.owner(np.diff(offsets))
    at = norm(own.sides.starts(corner) - points[of]) <= own.slack
    found = np.full(len(segment), NO_SIDE)
    found[of[at]] = corner[at]
    return found


def _common_sides(own: _Segments, segment: Ints) -> Ints:
    """(k,) the sides of the faces of segments beyond which the faces of the next ones are."""
    corner, of = own.corners()
    sides = own.sides
    following = np.append(own.face[1:], own.face[-1:])
    beyond = np.where(sides.across[corner] == NO_SIDE, NO_SIDE, sides.mesh.corner_face[sides.across[corner]])
    here = np.abs(dot(own.end[of] - sides.starts(corner), sides.inwards[corner])) <= own.slack
    found = np.full(len(own.face), NO_SIDE)
    fits = (beyond == following[of]) & here
    found[of[fits]] = corner[fits]
    return found[segment]


def _turns_at_vertices(own: _Segments, corner: Ints, back: Floats, beyond: Ints, ahead: Floats) -> Floats:
    """(k,) by how much ways turn at vertices: from the faces of corners (k,), whence they come, to those of corners
    beyond (k,)."""
    left, total = _counter_clockwise(own, corner, back, beyond, ahead)
    right, _ = _counter_clockwise(own, beyond, ahead, corner, back)
    whole = np.isfinite(total)
    round_ = np.where(whole, total, 0.0)
    both = ((left, right), (right, left))
    left, right = (np.where(whole, np.minimum(one, round_ - other), one) for one, other in both)
    turned = np.abs(np.where(whole, left, 0.0) - np.where(whole, right, 0.0))
    short = np.maximum(np.pi - np.minimum(left, right), 0.0)
    return np.minimum(short, np.where(whole, turned, np.inf))


def _counter_clockwise(own: _Segments, corner: Ints, way: Floats, beyond: Ints, ahead: Floats) -> tuple[Floats, Floats]:
    """The angles (k,) from ways in the faces of corners to ways ahead in those of corners beyond, inf where a border is
    between, and those (k,) all round the vertices, inf where a border is."""
    sides = own.sides
    result, total = np.full(len(corner), np.inf), np.zeros(len(corner))
    passed = -_between(sides.along[corner], way)
    going, now = np.arange(len(corner)), corner
    while len(going):
        arm = passed[going] + _between(sides.along[now], ahead[going])
        there = (now == beyond[going]) & (arm >= 0.0)
        result[going[there]] = arm[there]
        wedge = corner_angles(sides, now)
        passed[going], total[going] = passed[going] + wedge, total[going] + wedge
        now = sides.across[sides.before[now]]
        total[going[now == NO_SIDE]] = np.inf
        more = (now != NO_SIDE) & (now != corner[going])
        going, now = going[more], now[more]
    return result, total


def _between(a: Floats, b: Floats) -> Floats:
    """(k,) the angles between vectors (k,3)."""
    return np.asarray(arctan2(norm(cross(a, b)), dot(a, b)))


def _name(point: Floats) -> str:
    return "(" + ", ".join(f"{x:.10g}" for x in point) + ")"


# Assertions about curves that follow a field of directions, and about geodesics.


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
        f"{int((~known).sum())} points where the field has no direction, {_name_of_field(own, int(np.argmin(known)))}"
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
        f"{error[k]:.4g} at the worst, {_name_of_field(own, k)}, tolerance {tolerance:.4g}"
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
    where = _name_of_field(own, k)
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


def _name_of_field(own: _Middles, k: int) -> str:
    """A point in words."""
    return f"{_at(own.points[k])} at u, v = {_at(own.places[k])[1:-1]}"


def _at(values: Floats) -> str:
    return f"({', '.join(f'{x:.10g}' for x in values)})"
