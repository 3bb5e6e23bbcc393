"""The convex faces that lines run across, with all that their sides are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances.of_extent import ROUNDING_OF_POINTS, ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

NO_SIDE = -1


@dataclass(frozen=True, eq=False)
class MeshSides:
    """Plane convex faces, and their sides: side c (one of all) runs from corner c of its face to the next one.

    mesh: of convex faces alone, those that are present; source (f,): the face of the given mesh that each is (a part
    of); along, inwards (c,3): unit vectors of the sides, and at right angles to them in the faces, into these; lengths
    (c,); before, after (c,): the sides next to each in its face; across (c,): the same side seen from the other face,
    NO_SIDE at borders, where more than two faces meet, and where two do not agree which side is outside; at_vertex
    (c,), vertex_offsets (v+1,): the sides that begin at each vertex; slack (c,): what cosines with a side may be wrong
    by; extent; rounding: what points may be wrong by.
    """

    mesh: Mesh
    source: Ints
    along: Floats
    inwards: Floats
    lengths: Floats
    before: Ints
    after: Ints
    across: Ints
    at_vertex: Ints
    vertex_offsets: Ints
    slack: Floats
    extent: float
    rounding: float

    def starts(self, side: Ints) -> Floats:
        """(k,3) where sides begin."""
        return self._starts.take(side, axis=0)

    def ends(self, side: Ints) -> Floats:
        """(k,3) where sides end."""
        return self._starts.take(self.after[side], axis=0)

    @cached_property
    def _starts(self) -> Floats:
        """(c,3) where all sides begin."""
        return self.mesh.vertices[self.mesh.corners]


def mesh_sides(given: Mesh) -> MeshSides:
    """The sides of the faces of a mesh that are present."""
    low, high = given.bounds
    extent = float((high - low).max())
    faces = convex_faces(given.vertices.T, given.corners, given.offsets, ZERO_OF_EXTENT * extent)
    corners, offsets, source = faces.corners, faces.offsets, faces.source
    if given.present is not None:
        shown = np.flatnonzero(given.present[source])
        chosen, offsets = ragged.take(offsets, shown)
        corners, source = corners[chosen], source[shown]
    mesh = Mesh(given.vertices, corners, offsets)
    after = mesh.next_corner
    step = mesh.vertices[corners[after]] - mesh.vertices[corners]
    lengths = norm(step)
    along = step / np.maximum(lengths, LEAST_DIVISOR)[:, None]
    uses = edge_uses(mesh)
    pair = uses.first[uses.agree]
    across = np.full(len(corners), NO_SIDE, dtype=np.intp)
    across[uses.corner[pair]], across[uses.corner[pair + 1]] = uses.corner[pair + 1], uses.corner[pair]
    rounding = ROUNDING_OF_POINTS * max(float(np.abs(given.bounds).max()), extent)
    return MeshSides(
        mesh,
        source,
        along,
        cross(mesh.face_normals[mesh.corner_face], along),
        lengths,
        ragged.preceding(offsets),
        after,
        across,
        np.argsort(corners, kind="stable"),
        ragged.offsets(np.bincount(corners, minlength=len(mesh.vertices))),
        rounding / np.maximum(lengths, rounding + LEAST_DIVISOR),
        extent,
        rounding,
    )


def outwards(sides: MeshSides, side: Ints, directions: Floats) -> Floats:
    """(k,) how fast points with directions (k,3) in the faces of sides (k,) come nearer to these; zero along them."""
    speed = -dot(sides.inwards.take(side, axis=0), directions)
    return np.where(np.abs(speed) <= sides.slack[side], 0.0, speed)
