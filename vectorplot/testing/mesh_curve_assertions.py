"""Whether curves on a mesh follow a field of directions, and whether they are geodesics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.bent_faces import BentFaces
from vectorplot.features.integral.on_meshes.mesh_flows import corner_angles, face_field_flow
from vectorplot.features.integral.on_meshes.mesh_integral_curves import starts_in_faces
from vectorplot.features.integral.on_meshes.mesh_sides import NO_SIDE, MeshSides, mesh_sides
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.meshes.nearest_on_mesh import nearest_on_mesh
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.testing.curve_points import Curves, polylines_of
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

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
    or both away from. Errors: as of assert_integral_curve."""
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

    Errors: as of assert_geodesic.
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
