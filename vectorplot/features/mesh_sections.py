"""Where a parametrised or an implicit surface meets the faces of a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, no_curves
from vectorplot.features.implicit_tracing import ImplicitCurves, ImplicitTracing, mesh_of
from vectorplot.features.implicit_tracing import no_curves as no_curves_of_implicit_tracing
from vectorplot.features.intersection_grids import FREE, Tessellation, finer_grids
from vectorplot.features.intersection_tracing import at_border
from vectorplot.features.intersections import Joined, doubts_about, joined, repeats_dropped
from vectorplot.features.patches import MeshPatch, SingleShape, SurfacePatch
from vectorplot.features.polygonization import BOXED, sides_of
from vectorplot.features.triangle_intersections import contacts, overlapping_triangles, piercings
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot, norm
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians
from vectorplot.tolerances import ON_MESH_BORDER

# Where a parametrised surface meets the faces of a mesh.

DEFAULT = Tracing()

MOST_BORDERS = 1000
"""Border edges of a mesh that ends of curves are looked for on."""


@dataclass(frozen=True, eq=False)
class MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    curves: on the surface; faces: (n,) the face of the mesh in which the segment from every point to the next runs;
    normals: (n, 3) its unit normal there, that of one of its triangles where it is not planar.
    """

    curves: SurfaceCurves
    faces: Ints
    normals: Floats

    def __len__(self) -> int:
        return len(self.curves)


def mesh_section(surface: Surface, mesh: Mesh, *, tracing: Tracing = DEFAULT) -> MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    Source: Glaeser, section 8.4 (face-face sections).
    """
    two = MeshPatch(mesh)
    for columns, rows in finer_grids(tracing.columns, tracing.rows):
        one = SurfacePatch(surface, columns, rows)
        if not len(two.faces) or not len(one.tessellation.triangles):
            return MeshSection(no_curves(), np.zeros(0, dtype=np.intp), np.zeros((0, 3)))
        pairs = overlapping_triangles(one, two)
        found = piercings(one.tessellation, two.tessellation, pairs)
        # What happens where a plane goes on beside its face has nothing to do with the face.
        touching = contacts(one, two)
        all_ = joined(one, two, found, touching.of(two.holds(touching.two)), tracing, same=False)
        faults = _faults(one, two, all_)
        if not faults:
            break
    return _section(one, two, all_, faults)


def _faults(one: SurfacePatch, two: MeshPatch, all_: Joined) -> int:
    """At how many places the surface crosses edges of the mesh elsewhere than its triangles do: points beside their
    face, chords without a curve, ends inside both shapes."""
    faults = int((~two.holds(all_.points.two)).sum()) + all_.unsure
    if not np.isfinite(one.tessellation.points).all():
        return faults
    ends = [c.part(k, k + 1) for c in all_.traces if not c.closed for k in (0, len(c) - 1)]
    if not ends:
        return faults
    own, other = np.concatenate([c.one for c in ends]), np.concatenate([c.two[:, :3] for c in ends])
    edges = two.tessellation.edges[two.edge_uses != 2]
    if len(edges) > MOST_BORDERS:
        return faults
    start, end = (two.tessellation.points[edges[:, k]] for k in (0, 1))
    way, arm = end - start, other[:, None] - start
    t = np.clip((arm * way).sum(axis=2) / (way * way).sum(axis=1), 0.0, 1.0)
    away = np.linalg.norm(arm - t[..., None] * way, axis=2).min(axis=1, initial=np.inf)
    return faults + int((~at_border(one, own) & ~(away <= ON_MESH_BORDER * two.size[0])).sum())


def _section(one: SurfacePatch, two: MeshPatch, all_: Joined, faults: int) -> MeshSection:
    """The curves on the surface."""
    kept, offsets, closed = repeats_dropped(all_)
    own, points = all_.points.one, all_.points.two
    last: Ints = np.flatnonzero(all_.points.last)
    first: Ints = np.concatenate([[0], last[:-1] + 1])[: len(last)].astype(np.intp)
    domain = one.surface.domain
    turns = np.where(closed[:, None], np.round((own[last] - own[first]) / domain.size), 0.0)
    turns = np.where((domain.closed_u, domain.closed_v), turns, 0.0).astype(np.intp)
    isolated = [one.home(x) for x in (all_.isolated.one, all_.nodes.one, all_.touching.one)]
    alone, nodes, touching = (np.stack(uv, axis=1) for uv in isolated)
    doubts = (f"the surface passes edges or corners of the mesh too closely at {faults} places",) if faults else ()
    triangle = np.rint(points[kept, 3]).astype(np.intp)
    curves = SurfaceCurves(
        own[kept, 0],
        own[kept, 1],
        _both(one, own[kept], points[kept]),
        offsets,
        closed,
        turns,
        np.zeros(len(closed)),
        alone,
        nodes,
        touching,
        doubts_about(all_) + doubts,
    )
    return MeshSection(curves, two.faces[triangle], two.normals(points[kept]))


def _both(one: SurfacePatch, places: Floats, points: Floats) -> Floats:
    """(n,3) the points of the surface; those of the mesh are the same but for rounding, and lie in no hole."""
    on_surface = one.points(places)
    return np.where(np.isfinite(on_surface), on_surface, points[:, :3])


# Where an implicit surface meets the faces of a mesh.

DEFAULT_IMPLICIT = ImplicitTracing()

ROUNDS = 3
"""Newton steps onto the surface, from places that are off it by no more than triangles are."""


@dataclass(frozen=True, eq=False)
class ImplicitPatch(SingleShape):
    """An implicit surface within its box as a patch of `intersections.patches`: places are its points; constraints 0,
    1, 2 the sides of the box across x, y and z, then planes that cut. mesh: the surface polygonised."""

    surface: ImplicitSurface
    mesh: Mesh

    @cached_property
    def tessellation(self) -> Tessellation:
        """The triangles of the mesh."""
        points, triangles = self.mesh.vertices, self.mesh.corners.reshape(-1, 3)
        edges, sides, uses = edges_of(triangles, len(points))
        border = np.asarray(uses == 1, dtype=np.bool_)
        on = sides_of(self.surface).on(points)
        common: Bools = on[edges[:, 0]] & on[edges[:, 1]]
        constraints = np.where(border & common.any(axis=1), common.argmax(axis=1), FREE)
        return Tessellation(
            points, triangles, points[triangles], np.arange(len(triangles)), edges, sides, constraints, border
        )

    @cached_property
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around the mesh, and its largest coordinate."""
        points = self.mesh.vertices
        return float(norm(np.ptp(points, axis=0))), float(np.abs(points).max())

    @cached_property
    def cell(self) -> float:
        """How large triangles are."""
        low, high = self.tessellation.boxes
        return float(np.median(np.linalg.norm(high - low, axis=0)))

    def points(self, places: Floats) -> Floats:
        """(k,3) the places, those a little off the surface brought onto it."""
        return self._onto(places)

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit gradients; NaN at singular points."""
        with np.errstate(all="ignore"):
            slopes = self.surface.gradients(places)
            return np.asarray(slopes / np.linalg.norm(slopes, axis=-1, keepdims=True))

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) places moved along the surface, not out of the box."""
        return self._onto(places + steps)

    def along_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) directions of the curves on the sides of the box."""
        return np.cross(self.normals(places), sides_of(self.surface).normals[constraints])

    def on_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) places put onto their sides of the box."""
        low, high = np.asarray(self.surface.box, dtype=np.float64)
        side = np.where(places - low < high - places, low, high)
        result, sides = np.where(constraints[:, None] == np.arange(3), side, places), sides_of(self.surface)
        for constraint in range(BOXED, len(sides.normals)):
            result[constraints == constraint] = sides.planes(constraint)[0].put(places[constraints == constraint])
        return result

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) second derivatives of the height above the first two axes of frames (k,3,3), along the third."""
        with np.errstate(all="ignore"):
            slope = np.einsum("kij,kj->ki", frames, self.surface.gradients(places))
            bend = np.einsum("kij,kjl,kml->kim", frames, hessians(self.surface, places), frames)
            # The height h of F(x, y, h) = 0: its derivatives by x and y, and of these once more.
            rise = -slope[:, :2] / slope[:, 2:]
            lift = np.concatenate([np.broadcast_to(np.eye(2), (len(places), 2, 2)), rise[:, :, None]], axis=2)
            return np.asarray(-np.einsum("kij,kjl,kml->kim", lift, bend, lift) / slope[:, 2, None, None])

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """The places."""
        return places

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) distances, in sizes of triangles."""
        return np.asarray(np.linalg.norm(places - others, axis=-1) / self.cell)

    def _onto(self, points: Floats) -> Floats:
        """(k,3) points of the box on the surface; those beyond a side of the box stay in it."""
        sides = sides_of(self.surface)
        x = sides.clipped(points)
        held = sides.on(x)
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                slopes = sides.along(self.surface.gradients(x), held)
                back = (self.surface.values(x) / dot(slopes, slopes))[:, None] * slopes
                x = sides.clipped(x - np.where(np.isfinite(back), back, 0.0))
        return x


@dataclass(frozen=True, eq=False)
class ImplicitMeshSection:
    """The curves in which an implicit surface meets the faces of a mesh.

    curves: on the surface; normals: (n, 3) the unit normal of the face of the mesh in which the segment from every
    point to the next runs.
    """

    curves: ImplicitCurves
    normals: Floats

    def __len__(self) -> int:
        return len(self.curves)


def implicit_mesh_section(
    surface: ImplicitSurface, mesh: Mesh, *, tracing: ImplicitTracing = DEFAULT_IMPLICIT
) -> ImplicitMeshSection:
    """The curves in which an implicit surface meets the faces of a mesh, within its box.

    Source: Glaeser, section 8.4 (face-face sections).
    """
    polygonised, doubts = mesh_of(surface, tracing)
    own = polygonised.mesh
    two = MeshPatch(mesh)
    if not own.face_count or not len(two.faces):
        return ImplicitMeshSection(no_curves_of_implicit_tracing(doubts), np.zeros((0, 3)))
    one = ImplicitPatch(surface, own)
    found = piercings(one.tessellation, two.tessellation, overlapping_triangles(one, two))
    # What happens where a plane goes on beside its face has nothing to do with the face.
    touching = contacts(one, two)
    plain = Tracing(tolerance=tracing.tolerance, picture=tracing.picture)
    all_ = joined(one, two, found, touching.of(two.holds(touching.two)), plain, same=False)
    kept, offsets, closed = repeats_dropped(all_)
    curves = ImplicitCurves(
        one.points(all_.points.one[kept]),
        offsets,
        closed,
        np.zeros(len(closed)),
        all_.isolated.points,
        all_.nodes.points,
        (*doubts, *doubts_about(all_)),
    )
    return ImplicitMeshSection(curves, two.normals(all_.points.two[kept]))
