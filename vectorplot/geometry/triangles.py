"""Which triangles of the plane have inner points in common, and where points lie in the triangles of a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn, slices
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import nothing_beside
from vectorplot.geometry.vectors import cross, dot

if TYPE_CHECKING:
    from shapely import STRtree


PAIRS_AT_ONCE = 1 << 16
"""Pairs that are looked at at a time."""


def overlapping(one: Floats, other: Floats) -> Bools:
    """(k,) whether triangles one (2,3,k) and other (2,3,k), of either sense, have inner points in common: they have
    none where a side of one of them has the other one beyond it, or on it.

    Triangles that share corners are told apart exactly. Edge cases: those without area overlap nothing.
    Source: the theorem of separating axes, of which sides are enough for convex polygons.
    """
    parts = [slice(first, first + PAIRS_AT_ONCE) for first in range(0, one.shape[2], PAIRS_AT_ONCE)]
    found = [~(_beyond(one[..., k], other[..., k]) | _beyond(other[..., k], one[..., k])) for k in in_turn(parts)]
    return np.concatenate([np.zeros(0, dtype=np.bool_), *found])


def _beyond(one: Floats, other: Floats) -> Bools:
    """(k,) whether a side of one has all corners of the other on its outer side, or on it."""
    (x, y), (u, v) = one, other
    result = np.zeros(x.shape[1], dtype=np.bool_)
    for start, end, opposite in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        along, up = x[end] - x[start], y[end] - y[start]
        inner = along * (y[opposite] - y[start]) - up * (x[opposite] - x[start])
        side = (along * (v - y[start]) - up * (u - x[start])) * np.sign(inner)
        result |= side.max(axis=0) <= 0.0
    return result


# Where points lie in the triangles of a mesh.

PIECE = 1 << 14
"""Points that are looked up at a time."""


class TrianglePlaces(NamedTuple):
    """Which points (k,) are on triangles of a mesh, the corners (k,3) of these, the weights (k,3) of those, which add
    up to 1, and the faces (k,) that the triangles are parts of."""

    point: Ints
    corners: Ints
    weights: Floats
    face: Ints


@dataclass(frozen=True, eq=False)
class PlacedTriangles:
    """The triangles of a mesh, in which many points can be looked up, some now and some later."""

    mesh: Mesh

    def places(self, points: Floats) -> TrianglePlaces:
        """The places of those of some points (n,3) that are on the mesh, but for rounding: each in the triangle it is
        nearest to.

        Edge cases: points off the mesh are left out where no rectangle of a triangle has them, seen along the axis in
        which the mesh is thinnest; others have a place in the nearest triangle of those that have.
        """
        triangles, face = self._triangles
        found = []
        for piece in in_turn(slices(len(points), PIECE)):
            which, triangle, weights, off = self._around(points[piece], 0.0)
            order = np.lexsort((off, which))
            first = order[np.diff(which[order], prepend=-1) > 0]
            found.append((which[first] + piece.start, triangle[first], weights[first]))
        none = np.zeros(0, dtype=np.intp)
        place, triangle, weight = (
            np.concatenate(parts) for parts in zip((none, none, np.zeros((0, 3))), *found, strict=True)
        )
        return TrianglePlaces(place, triangles[triangle], weight, face[triangle])

    def faces_at(self, points: Floats, distance: float) -> tuple[Ints, Ints]:
        """Which of some points (n,3) are no farther than a distance from which faces (k,), of several where these meet:
        the numbers of both, some of them twice."""
        found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
        for piece in in_turn(slices(len(points), PIECE)):
            which, triangle, _, off = self._around(points[piece], distance)
            near = off <= distance
            found.append((which[near] + piece.start, self._triangles[1][triangle[near]]))
        point, face = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return point, face

    def _around(self, points: Floats, distance: float) -> tuple[Ints, Ints, Floats, Floats]:
        """Points (n,3) and the triangles whose rectangles they are no farther than a distance from: the numbers (k,) of
        both, the weights (k,3) of the nearest places and how far these are (k,)."""
        import shapely

        low, high = (points[:, self._flat] + side for side in (-distance, distance))
        which, triangle = self._tree.query(shapely.linestrings(np.stack([low, high], axis=1)))
        return which, triangle, *_weights(points[which], self.mesh.vertices[self._triangles[0][triangle]])

    @cached_property
    def _triangles(self) -> tuple[Ints, Ints]:
        """(t,3) their corners, and (t,) the faces they are parts of."""
        fans, face = ragged.fans(self.mesh.offsets)
        return self.mesh.corners[fans], face

    @cached_property
    def _flat(self) -> Ints:
        """(2,) the axes along which the mesh is largest."""
        return np.sort(np.argsort(np.ptp(self.mesh.bounds, axis=0), kind="stable")[1:])

    @cached_property
    def _tree(self) -> STRtree:
        """Their rectangles along these axes."""
        import shapely

        corners, near = self.mesh.vertices[self._triangles[0]][..., self._flat], nothing_beside(self.mesh.vertices)
        ends = [corners.min(axis=1) - near, corners.max(axis=1) + near]
        # Of what lies in a tree only the bounds count: a segment has those of a rectangle, and is made sooner.
        return shapely.STRtree(shapely.linestrings(np.stack(ends, axis=1)))


def _weights(points: Floats, corners: Floats) -> tuple[Floats, Floats]:
    """(k,3) weights of the corners (k,3,3) of triangles that give the places in them near points (k,3), and how far
    these are (k,)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = cross(b - a, c - a)
    area = dot(normal, normal)
    with np.errstate(all="ignore"):
        parts = [dot(cross(q - p, points - p), normal) / area for p, q in ((b, c), (c, a), (a, b))]
    weights = np.clip(np.nan_to_num(np.stack(parts, axis=1), nan=1.0), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    away = points - np.einsum("kc,kcx->kx", weights, corners)
    return weights, np.asarray(np.sqrt(dot(away, away)))
