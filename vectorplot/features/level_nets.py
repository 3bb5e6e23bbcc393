"""Nets of triangles on surfaces given by an equation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.edge_splitting import Edges, Net, Vertices
from vectorplot.features.implicit.implicit_sides import BOXED, sides_of
from vectorplot.features.implicit.polygonize import onto_surface, polygonized, settled_from
from vectorplot.features.implicit.singular.implicit_singular_lines import SingularLines, singular_lines, usual_gradient
from vectorplot.features.implicit.singular.singular_set import led_into_singular_set
from vectorplot.features.patch_nets import HALF
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_values import VANISHED_GRADIENT

IMPLICIT_CELLS = 32
"""Cells along the longest side of an implicit surface's box."""


def level_net(surface: ImplicitSurface) -> Level:
    """An implicit surface with a mesh to begin with, that ends on its singular lines."""
    mesh = polygonized(surface, IMPLICIT_CELLS)
    lines = singular_lines(surface, mesh)
    if not len(lines):
        mesh = settled_from(surface, mesh, IMPLICIT_CELLS)[0]
    return Level(surface, led_into_singular_set(surface, mesh, lines), lines)


@dataclass(frozen=True, eq=False)
class Level:
    """An implicit surface between vertices, a mesh of it to begin with, and its singular lines; the places of vertices
    are the points."""

    surface: ImplicitSurface
    mesh: Mesh
    lines: SingularLines

    @cached_property
    def net(self) -> Net:
        """The triangles of the mesh."""
        return Net(self.at(self.mesh.vertices), self.mesh.corners.reshape(-1, 3))

    @cached_property
    def least(self) -> float:
        """The length of gradients that are not but for rounding."""
        return VANISHED_GRADIENT * usual_gradient(self.surface, self.mesh.vertices)

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        """The vertices over parts t of sides, on the surface; border: of sides at its borders."""
        first, last = start.points, end.points
        sides = sides_of(self.surface)
        fixed = sides.on(first) & sides.on(last)
        fixed[:, :BOXED] &= first == last
        length = np.linalg.norm(last - first, axis=1)
        between = first + t[:, None] * (last - first)
        points, _ = onto_surface(self.surface, between, reach=length, fixed=fixed)
        along = np.flatnonzero(np.isnan(start.normals).any(axis=1) & np.isnan(end.normals).any(axis=1))
        on_line, on = self.lines.onto(between[along], HALF * length[along])
        points[along[on]] = on_line[on]
        return self.at(np.clip(points, *sides.box))

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends of sides as they are."""
        return start, end

    def turned(self, places: Floats) -> Bools:
        """None: there are no rims."""
        return np.zeros(len(places), dtype=np.bool_)

    def nearer(self, edges: Edges) -> Vertices:
        """Those over the sides: they were looked for near these."""
        return edges.at

    def inside(self, places: Floats) -> Bools:
        """All of them."""
        return np.ones(len(places), dtype=np.bool_)

    def at(self, points: Floats) -> Vertices:
        """The vertices at some points (n,3) of the surface."""
        with np.errstate(all="ignore"):
            slopes = np.asarray(self.surface.gradients(points), dtype=np.float64)
            length = np.linalg.norm(slopes, axis=1, keepdims=True)
            normals = np.where(length > self.least, slopes / length, np.nan)
        return Vertices(points, points, normals)
