"""The faces that planes make in closed bodies: areas in the planes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.features.implicit.implicit_curves import implicit_plane_sections
from vectorplot.features.implicit.implicit_mesh import implicit_mesh
from vectorplot.features.implicit.implicit_tracing import ImplicitTracing
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.parametric.parameter_lines import domain_borders
from vectorplot.features.parametric.surface_sections import plane_sections
from vectorplot.geometry.cuts.divided_meshes import divided_mesh, section_sides
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.geometry.cuts.section_faces import PlaneFrame, region_of_sides, window
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.repair.circulation import unbalanced_vertices
from vectorplot.geometry.repair.degenerate import chosen_faces
from vectorplot.geometry.repair.pieces import pieces_of_faces
from vectorplot.geometry.repair.weld import close_points
from vectorplot.geometry.repair.winding import is_closed_oriented
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.surfaces.parts import smooth_parts
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_hole, is_implicit, is_parametrised
from vectorplot.tolerances.of_extent import CUT_FACE_CHORD_OF_EXTENT, SECTION_ENDS_OF_EXTENT

LOOKS = 33
"""Places along u and along v at which is looked whether a surface has holes."""


@dataclass(frozen=True, eq=False)
class Body:
    """What of an item is closed, and has an inside: its closed pieces of a mesh, or a closed surface."""

    item: Item

    @cached_property
    def closed(self) -> Mesh | Surface | ImplicitSurface | None:
        """The shape, or the part of it, that is closed; None where nothing is."""
        shape = self.item.shape
        if isinstance(shape, Mesh):
            return _closed_pieces(shape)
        if is_implicit(shape):
            return shape if is_closed_oriented(self._net) else None
        return shape if is_parametrised(shape) and _is_closed(shape) else None

    @cached_property
    def _net(self) -> Mesh:
        """The triangles of an implicit surface; none of other shapes."""
        shape = self.item.shape
        return implicit_mesh(shape, ImplicitTracing().cells).mesh if is_implicit(shape) else self.item.mesh

    @cached_property
    def is_open(self) -> bool:
        """Whether some of it is not closed."""
        closed = self.closed
        return closed is None or (isinstance(closed, Mesh) and closed.face_count < self.item.mesh.face_count)

    @cached_property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates."""
        shape = self.item.shape
        return shape.bounds if isinstance(shape, Mesh) else smooth_bounds(shape)

    def is_met_by(self, region: HalfSpaces) -> bool:
        """Whether a region reaches to the box around the body."""
        corners = self.bounds[np.array(list(np.ndindex(2, 2, 2))), np.arange(3)]
        return bool((region.heights(corners) > 0.0).any(axis=1).all())

    def is_opened_by(self, region: HalfSpaces) -> bool:
        """Whether a region takes away a part of a piece that is not closed, and leaves another."""
        shape = self.item.shape
        if is_curve(shape) or not self.is_open or not self.is_met_by(region):
            return False
        if isinstance(shape, Mesh):
            return _is_opened(shape, region)
        if is_implicit(shape):
            return _is_opened(self._net, region)
        if not is_parametrised(shape):
            return False
        u, v = np.meshgrid(*shape.domain.grid(LOOKS, LOOKS), indexing="ij")
        with np.errstate(all="ignore"):
            points = np.asarray(shape.points(u, v)).reshape(-1, 3)
        gone = (region.heights(points[np.isfinite(points).all(axis=1)]) > 0.0).all(axis=0)
        return bool(gone.any() and not gone.all())

    def face(
        self, frame: PlaneFrame, region: HalfSpaces, number: int, others: list[HalfSpaces], within: HalfSpaces | None
    ) -> Any:
        """The face that the body shows on a plane of a region when what is in the region is taken away: an area of
        shapely in the frame of the plane; nothing of it is in other regions, all of it is within one."""
        import shapely

        closed = self.closed
        if closed is None or not self.is_met_by(region):
            return shapely.Polygon()
        sides = (
            section_sides(closed, region, number)
            if isinstance(closed, Mesh)
            else _smooth_sides(closed, region, number, self.bounds)
        )
        area = region_of_sides(*frame.places(sides))
        if area.is_empty:
            return area
        left, bottom, right, top = shapely.bounds(area).tolist()
        wide = right - left, top - bottom
        around = (left - wide[0], bottom - wide[1], right + wide[0], top + wide[1])
        if len(region.normals) > 1:
            area = shapely.intersection(area, window(region, number, frame, around))
        for other in others:
            area = shapely.difference(area, window(other, -1, frame, around))
        return area if within is None else shapely.intersection(area, window(within, -1, frame, around))


def _closed_pieces(mesh: Mesh) -> Mesh | None:
    """The pieces of a mesh that close, and agree about the outside."""
    if mesh.present is not None:
        return None
    loose = unbalanced_vertices(len(mesh.vertices), mesh.corners, mesh.offsets)
    if not loose.any():
        return mesh if mesh.face_count else None
    number, piece = pieces_of_faces(len(mesh.vertices), mesh.corners, mesh.offsets)
    is_open = np.bincount(piece[mesh.corner_face], loose[mesh.corners], number) > 0
    return chosen_faces(mesh, ~is_open[piece]) if not is_open.all() else None


def _is_opened(mesh: Mesh, region: HalfSpaces) -> bool:
    """Whether a region parts a piece of a mesh that does not close."""
    number, piece = pieces_of_faces(len(mesh.vertices), mesh.corners, mesh.offsets)
    loose = unbalanced_vertices(len(mesh.vertices), mesh.corners, mesh.offsets)
    is_open = np.bincount(piece[mesh.corner_face], loose[mesh.corners], number) > 0
    if mesh.present is not None:
        is_open = np.ones(number, dtype=np.bool_)
    some = chosen_faces(mesh, is_open[piece])
    divided = divided_mesh(some, region)
    whole = divided.place >= 0
    if divided.inside.face_count and divided.outside.face_count > np.count_nonzero(whole):
        return True
    # A plane along edges parts pieces, but no face.
    number, piece = pieces_of_faces(len(some.vertices), some.corners, some.offsets)
    left = np.bincount(piece, whole, number)
    return bool(((left > 0) & (left < np.bincount(piece, minlength=number))).any())


def _is_closed(surface: Surface) -> bool:
    """Whether a surface has neither borders nor holes, as far as is looked."""
    u, v = np.meshgrid(*surface.domain.grid(LOOKS, LOOKS), indexing="ij")
    with np.errstate(all="ignore"):
        holed = is_hole(np.asarray(surface.points(u, v))).any()
    return not holed and not len(domain_borders(surface, Tracing()))


def _smooth_sides(surface: Surface | ImplicitSurface, region: HalfSpaces, number: int, bounds: Floats) -> Floats:
    """(2,s,3) chords of the section of a closed surface with a plane, their ends on it."""
    extent = float(np.ptp(bounds, axis=0).max())
    points, sides, count = [np.zeros((0, 3))], [np.zeros((2, 0), dtype=np.intp)], 0
    for found in _sections(surface, region, number, CUT_FACE_CHORD_OF_EXTENT * extent):
        points.append(found.points)
        sides.append(count + segments(found).T)
        count += len(found.points)
    every = np.concatenate(points)
    one = close_points(every, SECTION_ENDS_OF_EXTENT * extent)
    return every[one[np.concatenate(sides, axis=1)]]


def _sections(surface: Surface | ImplicitSurface, region: HalfSpaces, number: int, tolerance: float) -> list[Any]:
    """The sections of the smooth parts of a surface with a plane, their chords within a tolerance."""
    normal, offset = region.normals[number], region.offsets[number]
    if is_implicit(surface):
        return [implicit_plane_sections(surface, normal, offset, tracing=ImplicitTracing(tolerance=tolerance))]
    assert is_parametrised(surface)
    tracing = Tracing(tolerance=tolerance)
    return [plane_sections(part.surface, normal, offset, tracing=tracing) for part in smooth_parts(surface)]
