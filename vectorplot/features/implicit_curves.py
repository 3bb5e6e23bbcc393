"""Curves on implicit surfaces: contours, isophotes, intersections, sections, level lines."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import vector
from vectorplot.errors import InputError
from vectorplot.features.conditions import MeetsPlane, SpatialCondition
from vectorplot.features.contours_and_isophotes import direction_across, in_planes, levels_of
from vectorplot.features.implicit_singular_lines import STRAYS, SingularEquations, onto_lines
from vectorplot.features.implicit_tracing import (
    ImplicitCurves,
    ImplicitTracing,
    all_curves,
    curves_in_space,
    curves_of_lines,
    mesh_of,
    no_curves,
)
from vectorplot.features.polygonization import (
    ImplicitCentralContour,
    ImplicitIsophote,
    ImplicitPointIsophote,
    curve_in_space,
    refined_chords,
    sides_of,
)
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.polylines import Polylines, closed_round, take
from vectorplot.geometry.vectors import cross, norm, normalize
from vectorplot.geometry.winding import edge_uses
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances import CHORD_OF_EXTENT, LEAST_DIVISOR, TOUCHING_SHEETS_SINE, ZERO_OF_EXTENT

DEFAULT = ImplicitTracing()


def implicit_contour(surface: ImplicitSurface, eye: ArrayLike, *, tracing: ImplicitTracing = DEFAULT) -> ImplicitCurves:
    """The points x of an implicit surface with N.(x - eye) = 0, N the unit gradient of F.

    eye: (3,) in world coordinates.
    Source: Glaeser, section 8.4, equations 25 to 27.
    """
    place = vector("contour: eye", eye)
    condition = ImplicitCentralContour(surface, place)
    return curves_in_space(surface, condition, size=condition.farthest, tracing=tracing)


def implicit_parallel_contour(
    surface: ImplicitSurface, direction: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The points of an implicit surface with N.d = 0, N the unit gradient of F: seen along d it turns away there.

    direction: (3,) d, of any length, towards the eye.
    Edge cases: as for `implicit_contour`.
    Source: Glaeser, section 8.4, equation 27 for an eye at infinity.
    """
    towards = vector("contour: direction", direction)
    return curves_in_space(surface, ImplicitIsophote(surface, towards), size=1.0, tracing=tracing)


def implicit_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in parallel light, N the unit gradient of F, l the light.

    light: (3,) l, of any length, towards the light; cosines: (k,) c, -1 to 1.
    Edge cases: a flat part at just that angle gives no lines, and a doubt; c = 1 gives isolated points.
    Source: Glaeser, section 8.4, equation 28.
    """
    return _family(surface, lambda c: (ImplicitIsophote(surface, light, c), 1.0), levels_of(cosines), tracing)


def implicit_point_light_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in the light of a point, l from the surface to the light.

    light: (3,) where the light stands, in world coordinates; cosines: (k,) c, -1 to 1.
    Edge cases: as for `implicit_isophotes`.
    Source: Glaeser, section 8.4, equation 28.
    """
    return _family(surface, lambda c: (ImplicitPointIsophote(surface, light, c), 1.0), levels_of(cosines), tracing)


def implicit_intersection(
    surface: ImplicitSurface, other: ImplicitSurface, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves in which two implicit surfaces meet, within the box of the first.

    Edge cases: surfaces that touch in a point give an isolated one; that coincide in an area, a doubt.
    Source: Glaeser, section 8.4, equation 29.
    """
    own, _ = mesh_of(surface, tracing)
    mesh, tracing = own.mesh, replace(tracing, mesh=own)
    if not mesh.face_count:
        return no_curves()
    long = np.linalg.norm(other.gradients(mesh.vertices), axis=1)
    slope = float(np.quantile(long[np.isfinite(long)], 0.95)) if np.isfinite(long).any() else 0.0
    size = slope * float(np.ptp(np.asarray(surface.box), axis=0).max())
    return curves_in_space(surface, other, size=size or 1.0, tracing=tracing)


def implicit_plane_sections(
    surface: ImplicitSurface, normal: ArrayLike, offsets: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The sections of an implicit surface with the parallel planes n.x = d, n the unit normal.

    normal: (3,) of any length; offsets: (k,) d, in world units.
    Edge cases: as for `implicit_intersection`.
    Source: Glaeser, section 8.4, equation 29.
    """
    levels = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise InputError("plane sections: offsets must be finite numbers")
    n = normalize(vector("plane sections: normal", normal))
    size = float(np.ptp(np.asarray(surface.box), axis=0).max())
    return _family(surface, lambda d: (MeetsPlane(n, d), size), levels, tracing)


def _family(
    surface: ImplicitSurface,
    condition: Callable[[float], tuple[SpatialCondition, float]],
    levels: Floats,
    tracing: ImplicitTracing,
) -> ImplicitCurves:
    """The curves of each level, on one mesh."""
    mesh, doubts = mesh_of(surface, tracing)
    tracing = replace(tracing, mesh=mesh)
    families = []
    for level in levels.tolist():
        one, size = condition(level)
        families.append(curves_in_space(surface, one, size=size, tracing=tracing, level=level))
    return all_curves([no_curves(doubts), *families])


def implicit_tangent_sections(
    surface: ImplicitSurface, normal: Floats, levels: Floats, *, tracing: ImplicitTracing
) -> ImplicitCurves:
    """The curves along which one of the planes n.x = d, n a unit normal, d of levels (k,), touches an implicit surface,
    with d as level: see tangent_sections."""
    found = implicit_parallel_contour(surface, direction_across(normal), tracing=tracing)
    alone = replace(found, isolated=found.isolated[:0], nodes=found.nodes[:0], doubts=())
    return in_planes(alone, normal, levels, ZERO_OF_EXTENT * float(np.ptp(np.asarray(surface.box), axis=0).max()))


def without_touching(surface: ImplicitSurface, normal: Floats, curves: ImplicitCurves) -> ImplicitCurves:
    """Sections by planes of a unit normal, those left out along which planes only touch the surface."""
    if not len(curves):
        return curves
    gradients = surface.gradients(curves.points)
    sines = norm(cross(gradients, normal)) > TOUCHING_SHEETS_SINE * norm(gradients)
    return take(curves, np.logical_or.reduceat(sines, curves.offsets[:-1]))


# Where implicit surfaces end: on the sides of their boxes, and at the rims of their holes.


def implicit_borders(surface: ImplicitSurface, *, tracing: ImplicitTracing) -> ImplicitCurves:
    """Where an implicit surface ends: its curves on the sides of its box and on planes that cut it, divided at the
    edges of these, and the rims of its holes. The surface is on the left, seen from where F > 0.

    Rims of holes, where F is not finite, are known to a cell of the lattice only, and a doubt says so.
    """
    own, _ = mesh_of(surface, tracing)
    mesh = own.mesh
    if not mesh.face_count:
        return no_curves()
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first[uses.count == 1]]
    a, b = mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]
    known = sides_of(surface)
    sides = known.on(mesh.vertices)
    # On singular lines sheets go on in each other, with vertices of their own.
    ends = ~(own.on_line[a] & own.on_line[b])
    a, b = a[ends], b[ends]
    common = sides[a] & sides[b]
    # A border does not run on through a singular line: there others hide it, or cease to.
    edges = np.stack([a, b], axis=1)
    on_line = own.on_line[edges]
    vertices = np.concatenate([mesh.vertices, mesh.vertices[edges[on_line]]])
    edges[on_line] = len(mesh.vertices) + np.arange(np.count_nonzero(on_line))
    a, b = edges.T
    families = [
        _border(surface, vertices, a, b, side, np.flatnonzero(common[:, side]), tracing)
        for side in range(common.shape[1])
    ]
    rims = np.flatnonzero(~common.any(axis=1))
    if len(rims):
        families.append(_rims(vertices, a[rims], b[rims]))
    return all_curves(families)


def _border(
    surface: ImplicitSurface, vertices: Floats, a: Ints, b: Ints, side: int, chosen: Ints, tracing: ImplicitTracing
) -> ImplicitCurves:
    """The borders on the two sides of the box across an axis, or on a plane that cuts, from the edges a, b (e,) that
    are chosen."""
    known = sides_of(surface)
    extent = float(np.ptp(known.box, axis=0).max())
    families = []
    for plane in known.planes(side):
        here = chosen[plane.holds(vertices[a[chosen]], known.nothing)]
        branches = concat(np.stack([a[here], b[here]], axis=1))
        if not len(branches):
            continue
        lines = Traces.of(vertices[branches.points], closed_round(branches))
        curve = curve_in_space(surface, MeetsPlane(plane.normal, plane.offset), extent)
        tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
        most = tracing.budget.points
        finer = refined_chords(curve, lines, tolerance, tracing.picture, most)
        points = plane.put(finer.lines.points)
        texts = [
            (finer.unsure.any(), f"{finer.unsure.sum()} chords of a border could not be refined"),
            (not finer.enough.all(), unresolved("borders are off by more than the tolerance")),
        ]
        doubts = tuple(text for said, text in texts if said)
        families.append(curves_of_lines(Traces(points, finer.lines.last), branches.closed, doubts=doubts))
    return all_curves(families)


def _rims(vertices: Floats, a: Ints, b: Ints) -> ImplicitCurves:
    """The rims of holes, as they are in the mesh."""
    branches = concat(np.stack([a, b], axis=1))
    none, doubt = np.zeros((0, 3)), "the rim of a hole of an implicit surface is known to a cell only"
    return ImplicitCurves(
        vertices[branches.points], branches.offsets, branches.closed, np.zeros(len(branches)), none, none, (doubt,)
    )


# Singular lines of implicit surfaces as curves, as fine as is asked for.


def refined_line(equations: SingularEquations, lines: Polylines, tracing: ImplicitTracing) -> ImplicitCurves:
    """The lines on which equations hold, with points put in until chords stay within the tolerance of the tracing."""

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        way = end - start
        long = np.linalg.norm(way, axis=1)
        across = way / np.maximum(long, LEAST_DIVISOR)[:, None]
        return onto_lines(equations, start + part[:, None] * way, STRAYS * long, across=across)

    if not len(lines):
        return no_curves()
    tolerance = CHORD_OF_EXTENT * equations.extent if tracing.tolerance is None else tracing.tolerance
    start = Traces.of(lines.points, closed_round(lines))
    finer = refined(start, between, tracing.picture or (lambda points: points), tolerance, tracing.budget.points)
    short = () if finer.enough.all() else (unresolved("singular lines are off by more than the tolerance"),)
    return curves_of_lines(finer.lines, lines.closed, doubts=short)
