"""Smooth surfaces as meshes that know the true normals at their vertices, as fine as is asked for and no finer."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.features.edge_splitting import Demand, Net, refined
from vectorplot.features.level_nets import level_net
from vectorplot.features.normal_jumps import cut_where_normals_jump
from vectorplot.features.parametric.holes.holes import ways_between
from vectorplot.features.parametric.poles import poles
from vectorplot.features.patch_nets import TOO_LONG, Patch, first_net
from vectorplot.geometry.budget import USUAL as USUAL_BUDGET
from vectorplot.geometry.components import all_components, any_component
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.triangles.triangle_edges import edges_of
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.jumps import jumps
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.tolerances.of_angles import FLAT_COSINE, SAME_NORMAL_COSINE
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN

AROUND_POLE = 8
"""So many normals are compared at a pole."""


@dataclass(frozen=True, eq=False)
class Facets:
    """A mesh, and the unit normals (v,3) of the true surface at its vertices, NaN where it has none; complete: whether
    it is as fine as was asked for; sharp (v,): the vertices on sharp edges, with the normal of one side."""

    mesh: Mesh
    normals: Floats
    complete: bool
    sharp: Bools


def facets(shape: Surface | ImplicitSurface, demand: Demand, most: int = USUAL_BUDGET.facets) -> Facets:
    """Triangles of a smooth surface as fine as the demand says, every vertex on the surface.

    Triangles turn as u to v does; those of an implicit surface are counter-clockwise from where F > 0. Vertices on
    seams and at poles are one; neighbours of different sizes share their vertices.
    Error: the demand is kept at LOOKS of every side, and where it crosses a fold; what is smaller may be missed, and
    where it calls for more than most triangles it is not kept. Sides that lead into a hole end at its rim, and those
    along a rim follow it; cuspidal edges lie on sides, up to their chords.
    Errors: InputError for what is no smooth surface.
    Degenerate: triangles in holes, those without area, those beneath which the surface jumps, and, of surfaces with
    borders, those that fold over in a plane part, where their neighbours lie over them, are left out.
    Source: Glaeser, section 8.4 (polygonised surfaces).
    """
    if is_parametrised(shape):
        patch = Patch(shape, tuple(poles(shape)))
        return finished(patch, refined(first_net(shape, demand), patch, demand, most))
    if is_implicit(shape):
        level = level_net(shape)
        net = refined(level.net, level, demand, most)
        return _facets(net, np.zeros(len(net.vertices.points), dtype=np.bool_))
    raise InputError(f"a {type(shape).__name__} is no smooth surface")


def finished(patch: Patch, net: Net) -> Facets:
    """What comes of a net on a parametrised surface that is fine enough."""
    net, turned = cut_where_normals_jump(_without_jumps(patch.surface, net), patch)
    sharp = turned | patch.on_crease(net.vertices.places)
    apex = _at_apexes(patch, net.vertices.places)
    return _facets(_without_folds(net, sharp), sharp | apex, apex)


def _at_apexes(patch: Patch, places: Floats) -> Bools:
    """(n,) which places are at poles at which the normal depends on the way that leads there, as that of a cone."""
    found = np.zeros(len(places), dtype=np.bool_)
    domain = patch.surface.domain
    starts = (domain.u_start, domain.v_start)
    for pole in patch.poles:
        around = np.empty((AROUND_POLE, 2))
        across = 1 - pole.axis
        around[:, pole.axis] = pole.place
        around[:, across] = starts[across] + domain.size[across] * np.arange(AROUND_POLE) / AROUND_POLE
        normals = unit_normals(patch.surface, around[:, 0], around[:, 1])
        if (dot(normals, normals[:1]) < SAME_NORMAL_COSINE).any():
            found |= np.abs(places[:, pole.axis] - pole.place) <= ON_BORDER_OF_DOMAIN * domain.size[pole.axis]
    return found


def _without_folds(net: Net, sharp: Bools) -> Net:
    """The net without triangles that look against the only normal of all their corners: chords of lines that are bent
    within a plane lead over the corners behind them. sharp (v,): vertices with the normal of one side only.

    Where two triangles lie over a place and one beneath it looks the other way, one is left. Nets without borders keep
    them all: of a closed body nothing is seen that looks away.
    """
    points, normals = net.vertices.points[net.triangles], net.vertices.normals[net.triangles]
    area = cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    against = dot(area[:, None], normals) <= -FLAT_COSINE * norm(area)[:, None]
    either = sharp[net.triangles]
    folded = all_components(against | either) & any_component(against & ~either)
    if not folded.any() or (edges_of(net.triangles, len(sharp))[2] > 1).all():
        return net
    return replace(net, triangles=net.triangles[~folded])


def _without_jumps(surface: Surface, net: Net) -> Net:
    """The net without triangles with a side along which the surface jumps.

    Only sides that are long beside what the derivatives at both ends make of them are looked at.
    """
    places, points = net.vertices.places, net.vertices.points
    a, b = (x.ravel() for x in (net.triangles, np.roll(net.triangles, -1, axis=1)))
    way = ways_between(surface.domain, places[a, :2], places[b, :2])
    with np.errstate(all="ignore"):
        along_u, along_v = surface.partials(*places[:, :2].T)
        expected = [norm(along_u[k] * way[:, :1] + along_v[k] * way[:, 1:]) for k in (a, b)]
        long = norm(points[b] - points[a]) > TOO_LONG * np.maximum(*expected)
    side = np.flatnonzero(long)
    torn = np.zeros(len(a), dtype=np.bool_)
    torn[side] = jumps(surface, places[a][side, :2], places[a][side, :2] + way[side])
    return replace(net, triangles=net.triangles[~any_component(torn.reshape(-1, 3))])


def _facets(net: Net, sharp: Bools, apex: Bools | None = None) -> Facets:
    triangles = net.triangles[net.vertices.known[net.triangles].all(axis=1)]
    used, corners = np.unique(triangles, return_inverse=True)
    vertices = net.vertices.some(used)
    normals = vertices.normals if apex is None else np.where(apex[used, None], np.nan, vertices.normals)
    return Facets(Mesh.from_triangles(vertices.points, corners.reshape(-1, 3)), normals, not net.stopped, sharp[used])
