"""Ways up the triangles of a terrain with a constant slope."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.integral.face_sites import face_sites
from vectorplot.features.integral.on_meshes.mesh_flows import Onward
from vectorplot.features.integral.on_meshes.mesh_sides import NO_SIDE, MeshSides, mesh_sides, outwards
from vectorplot.features.integral.sites import unit
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot
from vectorplot.tolerances.of_angles import FLAT_SLOPE


@dataclass(frozen=True, eq=False)
class Hillsides:
    """The triangles of a terrain and their sides; in each the steepest way up (f,3), the sine (f,) of its slope, NaN
    where it is level, and the way (f,3) to its left."""

    sides: MeshSides
    steepest: Floats
    sine: Floats
    left: Floats

    def directions(self, face: Ints, sine: Floats, side: Floats) -> Floats:
        """(k,3) up in faces (k,) with sines (k,) of slopes, to the left (1) or right (-1) of the steepest way; NaN
        where this is less steep."""
        with np.errstate(invalid="ignore"):
            part = sine / self.sine[face]
            across = side * np.sqrt(1.0 - part * part)
        return np.asarray(part[:, None] * self.steepest[face] + across[:, None] * self.left[face])


def hillsides_of(mesh: Mesh) -> Hillsides:
    """The hillsides of a mesh of triangles."""
    sides = mesh_sides(mesh)
    sites = face_sites(sides.mesh)
    up = sites.tangential(np.broadcast_to(np.array([0.0, 0.0, 1.0]), sites.normals.shape))
    sine = np.sqrt(dot(up, up))
    sine = np.where(sine > FLAT_SLOPE, sine, np.nan)
    steepest = unit(up)
    return Hillsides(sides, steepest, sine, cross(sites.normals, steepest))


@dataclass(frozen=True, eq=False)
class SlopeFlow:
    """Up with constant slopes: line k with sine[k], on side[k] of the steepest way; it ends where the ground is less
    steep, and where it had to slide along an edge."""

    hills: Hillsides
    sine: Floats
    side: Floats

    def directions(self, face: Ints, line: Ints) -> Floats:
        """(k,3) the directions of lines in faces (k,); NaN where these are less steep."""
        return self.hills.directions(face, self.sine[line], self.side[line])

    def over_edge(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the other face, where its direction leads away from the edge."""
        sides, other = self.hills.sides, self.hills.sides.across[side]
        face = np.where(other != NO_SIDE, sides.mesh.corner_face[other], -1)
        onward = self.directions(face, way.astype(np.intp))
        leads = (other != NO_SIDE) & (outwards(sides, other, onward) < 0.0)
        return _onward(np.where(leads, face, -1), onward, other)

    def over_vertex(self, side: Ints, directions: Floats, way: Floats) -> Onward:
        """Into the face whose direction leads away from the vertex, the nearest to the way it came of several."""
        sides = self.hills.sides
        listed, offsets = ragged.take(sides.vertex_offsets, sides.mesh.corners[side])
        around, owner = sides.at_vertex[listed], ragged.owner(np.diff(offsets))
        face, previous = sides.mesh.corner_face[around], sides.before[around]
        own = self.directions(face, way[owner].astype(np.intp))
        into = (outwards(sides, around, own) <= 0.0) & (outwards(sides, previous, own) <= 0.0)
        near = np.where(into, np.nan_to_num(dot(own, directions[owner])), -np.inf)
        best = np.lexsort((-near, owner))[ragged.starts(np.diff(offsets))]
        found = _onward(np.where(np.isfinite(near[best]), face[best], -1), own[best], around[best])
        return found._replace(second=previous[best])


def _onward(face: Ints, directions: Floats, first: Ints) -> Onward:
    none = np.full(len(face), NO_SIDE)
    return Onward(face, directions, first, none, np.zeros(len(face), dtype=np.bool_))
