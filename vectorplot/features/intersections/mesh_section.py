"""Where a parametrised surface meets the faces of a mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.intersections.contacts import contacts
from vectorplot.features.intersections.curve_ends import at_border
from vectorplot.features.intersections.joined_courses import Joined, doubts_about, joined, repeats_dropped
from vectorplot.features.intersections.patches import MeshPatch
from vectorplot.features.intersections.surface_patches import SurfacePatch
from vectorplot.features.intersections.triangle_pairs import overlapping_triangles, piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.features.tessellation import finer_grids
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import ON_MESH_BORDER

DEFAULT = Tracing()

MOST_BORDERS = 1000
"""Border edges of a mesh that ends of curves are looked for on."""


@dataclass(frozen=True, eq=False)
class MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    Parameters
    ----------
    curves : SurfaceCurves
        On the surface.
    faces : (n,) array of int
        The face of the mesh in which the segment from every point to the next runs; the last point of an open curve has
        that of the segment before.
    normals : (n, 3) array of float
        Its unit normal there, that of one of its triangles where it is not planar.

    Examples
    --------
    >>> from vectorplot import features, geometry, surfaces
    >>> ball, cube = surfaces.Sphere(1.2, centre=(1, 1, 1)), geometry.box((2, 2, 2))
    >>> section = features.mesh_section(ball, cube, tracing=features.Tracing(columns=15, rows=15))
    >>> isinstance(section, features.MeshSection), section.normals.shape == section.curves.points.shape
    (True, True)
    """

    curves: SurfaceCurves
    faces: Ints
    normals: Floats

    def __len__(self) -> int:
        return len(self.curves)


def mesh_section(surface: Surface, mesh: Mesh, *, tracing: Tracing = DEFAULT) -> MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    Parameters
    ----------
    surface : Surface
        On which they are traced.
    mesh : Mesh
        Faces that are not present are left out.
    tracing : Tracing
        columns and rows of the grid that the surface is polygonised by; tolerance (a thousandth of the smaller extent
        where None) and picture.

    Returns
    -------
    MeshSection
        The curves on the surface; faces (n,) and normals (n, 3): the face of the mesh in which the segment from every
        point to the next runs, and its unit normal there.

    Raises
    ------
    InputError
        For a grid that is too coarse.

    Notes
    -----
    In a face a curve is the section of the surface with the plane of the face; it goes on over edges, and every edge it
    crosses has a point of it, on the edge and on the surface. Degenerate: a face that only touches the surface gives an
    isolated point; one that lies in it a doubt. Where more than two faces meet in an edge curves are joined in pairs.
    Where the triangles cross edges otherwise than the surface (it passes a corner, or grazes an edge) the grid is
    refined, up to 2^17 cells; the rest is a doubt.

    Source: Glaeser, section 8.4 (face-face sections).

    Examples
    --------
    >>> from vectorplot import features, geometry, surfaces
    >>> ball, cube = surfaces.Sphere(1.2, centre=(1, 1, 1)), geometry.box((2, 2, 2))
    >>> section = features.mesh_section(ball, cube, tracing=features.Tracing(columns=15, rows=15))
    >>> len(section), sorted({int(face) for face in section.faces})  # a circle in each face
    (6, [0, 1, 2, 3, 4, 5])
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
    ends = [c.part(k, k + 1) for c in all_.courses if not c.closed for k in (0, len(c) - 1)]
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
