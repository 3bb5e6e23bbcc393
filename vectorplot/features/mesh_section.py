"""Where a parametrised surface meets the faces of a mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.features.contacts import contacts
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.sheets import MeshSheet, SurfaceSheet
from vectorplot.features.surface_curves import SurfaceCurves, no_curves
from vectorplot.features.surface_intersection import Joined, doubts_about, joined, repeats_dropped
from vectorplot.features.triangle_pairs import overlapping_triangles, piercings
from vectorplot.geometry.mesh import Floats, Ints, Mesh
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()


@dataclass(frozen=True, eq=False)
class MeshSection:
    """curves: on the surface; faces (n,): the face of the mesh in which the segment from every point to the next runs;
    the last point of an open curve has that of the segment before."""

    curves: SurfaceCurves
    faces: Ints

    def __len__(self) -> int:
        return len(self.curves)


def mesh_section(surface: Surface, mesh: Mesh, *, tracing: Tracing = DEFAULT) -> MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    In a face a curve is the section of the surface with the plane of the face; it goes on over edges, and every edge it
    crosses has a point of it, on the edge and on the surface. Faces that are not present are left out. tracing: columns
    and rows of the grid that the surface is polygonised by; tolerance (None: a thousandth of the smaller extent) and
    picture.
    Errors: InputError for a grid that is too coarse.
    Degenerate: a face that only touches the surface gives an isolated point; one that lies in it a doubt. Where more
    than two faces meet in an edge curves are joined in pairs.
    Source: Glaeser, section 8.4 (face-face sections).
    """
    one, two = SurfaceSheet(surface, tracing.columns, tracing.rows), MeshSheet(mesh)
    if not len(two.faces) or not len(one.tessellation.triangles):
        return MeshSection(no_curves(), np.zeros(0, dtype=np.intp))
    pairs = overlapping_triangles(one.tessellation, two.tessellation)
    found = piercings(one.tessellation, two.tessellation, pairs)
    # What happens where a plane goes on beside its face has nothing to do with the face.
    touching = contacts(one, two)
    all_ = joined(one, two, found, touching.of(two.holds(touching.two)), tracing, same=False)
    return _section(one, two, all_)


def _section(one: SurfaceSheet, two: MeshSheet, all_: Joined) -> MeshSection:
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
        doubts_about(all_),
    )
    return MeshSection(curves, two.faces[triangle])


def _both(one: SurfaceSheet, places: Floats, points: Floats) -> Floats:
    """(n,3) the points of the surface; those of the mesh are the same but for rounding, and lie in no hole."""
    on_surface = one.points(places)
    return np.where(np.isfinite(on_surface), on_surface, points[:, :3])
