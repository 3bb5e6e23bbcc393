"""Boundary representations: bodies whose faces are surfaces trimmed by curves in u and v, and the edges of these."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.placed_curves import rows_and_shift
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.parameter_regions import ParameterRegions
from vectorplot.surfaces.placed_surface import MovableSurface, PlacedSurface
from vectorplot.surfaces.quadrics import EllipticSections, Profile
from vectorplot.surfaces.surface import Domain

# The surfaces of faces, with the parameters that CAD systems give them, over any part of their domains.


@dataclass(frozen=True, eq=False)
class Plane(MovableSurface):
    """The plane (unit u, unit v, 0)."""

    domain: Domain
    unit: float = 1.0

    dimensions = ("unit",)
    embedded = True

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return from_components(self.unit * np.asarray(u), self.unit * np.asarray(v), 0.0)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        zero = np.zeros(np.broadcast_shapes(np.shape(u), np.shape(v)))
        one = zero + self.unit
        return from_components(one, zero, zero), from_components(zero, one, zero)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        zero = np.zeros((*np.broadcast_shapes(np.shape(u), np.shape(v)), 3))
        return zero, zero, zero


class _Turned(EllipticSections):
    """A meridian turned about the z-axis: u is the angle in radians."""

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return 1.0, 1.0

    def _middle(self) -> Floats:
        return np.zeros(3)

    def about_origin(self) -> Self:
        """The surface itself."""
        return self


@dataclass(frozen=True, eq=False)
class TurnedLine(_Turned):
    """A cylinder or a cone: ((radius + growth v) cos u, (radius + growth v) sin u, rise v)."""

    over: Domain
    radius: float
    growth: float = 0.0
    rise: float = 1.0

    @property
    def domain(self) -> Domain:
        """The part of it that is looked at."""
        return self.over

    @property
    def dimensions(self) -> tuple[str, ...]:
        """All but the domain."""
        return "radius", "growth", "rise"

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros(np.broadcast_shapes(np.shape(v), np.shape(self.radius)))
        return (self.radius + self.growth * v, self.rise * v), (zero + self.growth, zero + self.rise), (zero, zero)


@dataclass(frozen=True, eq=False)
class TurnedCircle(_Turned):
    """A ball or a torus: ((major + minor cos v) cos u, (major + minor cos v) sin u, minor sin v)."""

    over: Domain
    major: float
    minor: float

    @property
    def domain(self) -> Domain:
        """The part of it that is looked at."""
        return self.over

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Both radii."""
        return "major", "minor"

    def _profile(self, v: Floats) -> Profile:
        across, up = self.minor * np.cos(v), self.minor * np.sin(v)
        return (self.major + across, up), (-up, across), (-across, -up)


# Bodies.


@dataclass(frozen=True, eq=False)
class BrepFace:
    """A surface, in a domain that reaches a little beyond its trims where it can; what the trims leave of that; whether
    the face is flat; turned: whether its normals point into the body."""

    surface: PlacedSurface
    region: ParameterRegions
    flat: bool
    turned: bool


@dataclass(frozen=True, eq=False)
class BrepEdges:
    """Edges (e,) as piecewise cubic curves, with one use (s,) for each face at which they end: kind (e,) as
    io.cad_files.EdgeKind numbers them; straight (e,); edge, face (s,): of each use, one after the other; offsets (s+1,)
    of its rows; per row (n,) points and slopes (n,3) by the number of the row, and places and turns (n,2) the same in
    u and v of the face. Uses of one edge have as many rows, at the same points."""

    kind: Ints
    straight: Bools
    edge: Ints
    face: Ints
    offsets: Ints
    points: Floats
    slopes: Floats
    places: Floats
    turns: Floats


@dataclass(frozen=True, eq=False)
class Brep:
    """A body as its boundary: faces and edges, and the triangles that stand for it where no surfaces are asked for."""

    trimmed_faces: tuple[BrepFace, ...]
    edges: BrepEdges
    mesh: Mesh

    @cached_property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates, within what the triangles are off."""
        return self.mesh.bounds

    def transformed(self, matrix: ArrayLike, mesh: Mesh | None = None) -> Brep:
        """The body under a matrix (4,4) that acts on columns; mesh: its triangles there, if they are made already."""
        rows, shift = rows_and_shift(matrix)
        faces = tuple(replace(face, surface=PlacedSurface(face.surface, rows, shift)) for face in self.trimmed_faces)
        edges = replace(
            self.edges,
            points=matmul(self.edges.points, np.asarray(rows)) + np.asarray(shift),
            slopes=matmul(self.edges.slopes, np.asarray(rows)),
        )
        return Brep(faces, edges, self.mesh.transformed(matrix) if mesh is None else mesh)
