"""The sides of the triangles of a mesh, as ways that are unfolded over them ask for them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.meshes.mesh_curves import FaceTriangles
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import dot, norm
from vectorplot.tolerances.of_extent import SETTLED_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


@dataclass(frozen=True, eq=False)
class TriangleSides:
    """The sides of triangles: those of triangle i are 3i, 3i+1 and 3i+2, each from one corner to the next.

    points (v,3); start, end (s,): vertices; lengths (s,); third_x, third_y (s,): where the third corner is, along the
    side from its start, and across; edge (s,); by_edge (s,), edge_offsets (e+1,): the sides on each edge, of however
    many triangles; at_vertex (s,), vertex_offsets (v+1,): those that begin at each vertex; passable (v,): whether
    shortest ways may go through: where more than a whole turn is around, and at borders; step: a typical length; slack:
    lengths that differ by less are one.
    """

    points: Floats
    start: Ints
    end: Ints
    lengths: Floats
    third_x: Floats
    third_y: Floats
    edge: Ints
    by_edge: Ints
    edge_offsets: Ints
    at_vertex: Ints
    vertex_offsets: Ints
    passable: Bools
    step: float
    slack: float

    def beyond(self, side: Ints) -> tuple[Ints, Ints]:
        """The sides (n,) of other triangles on the edges of sides (k,), and of which of these (n,)."""
        listed, offsets = ragged.take(self.edge_offsets, self.edge[side])
        own, found = ragged.owner(np.diff(offsets)), self.by_edge[listed]
        others = found != side[own]
        return found[others], own[others]

    def around(self, vertices: Ints) -> tuple[Ints, Ints]:
        """The sides (n,) that begin at vertices (k,), and at which of these (n,)."""
        listed, offsets = ragged.take(self.vertex_offsets, vertices)
        return self.at_vertex[listed], ragged.owner(np.diff(offsets))

    def middles(self, side: Ints) -> Floats:
        """(k,3) the middles of sides."""
        return np.asarray(0.5 * (self.points[self.start[side]] + self.points[self.end[side]]))

    def in_plane(self, side: Ints, points: Floats) -> tuple[Floats, Floats]:
        """Where points (n,3) of triangles are: along sides (n,) from their starts, and across."""
        way = self.points[self.end[side]] - self.points[self.start[side]]
        arm = points - self.points[self.start[side]]
        along = dot(arm, way) / np.maximum(self.lengths[side], LEAST_DIVISOR)
        part = along / np.maximum(self.lengths[side], LEAST_DIVISOR)
        return along, norm(arm - part[:, None] * way)


def following(side: Ints) -> Ints:
    """(k,) the sides after sides (k,) in their triangles."""
    return np.where(side % 3 == 2, side - 2, side + 1)


def triangle_sides(faces: FaceTriangles) -> TriangleSides:
    """The sides of triangles."""
    points, triangles = faces.mesh.vertices, faces.triangles
    start = triangles.ravel()
    after = following(np.arange(len(start)))
    end, third = start[after], start[following(after)]
    way = points[end] - points[start]
    lengths = norm(way)
    arm = points[third] - points[start]
    long = np.maximum(lengths, LEAST_DIVISOR)
    x = dot(arm, way) / long
    y = norm(arm - (x / long)[:, None] * way)
    count = len(points)
    _, edge, used = np.unique(
        np.minimum(start, end) * count + np.maximum(start, end), return_inverse=True, return_counts=True
    )
    angle = np.zeros(count)
    np.add.at(angle, start, arctan2(y, x))
    # Of two triangles at each of its edges as many sides begin at a vertex as edges meet there.
    passable = angle > 2.0 * np.pi + ZERO_OF_EXTENT
    for vertex in (start, end):
        passable[vertex[used[edge] != 2]] = True
    return TriangleSides(
        points,
        start,
        end,
        lengths,
        x,
        y,
        edge,
        np.argsort(edge, kind="stable"),
        ragged.offsets(used),
        np.argsort(start, kind="stable"),
        ragged.offsets(np.bincount(start, minlength=count)),
        passable,
        float(np.median(lengths)) if len(lengths) else 0.0,
        max(SETTLED_OF_EXTENT * faces.extent, faces.rounding),
    )
