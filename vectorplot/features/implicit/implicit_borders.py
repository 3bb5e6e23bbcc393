"""Where implicit surfaces end: on the sides of their boxes, and at the rims of their holes."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.implicit.implicit_conditions import (
    MeetsPlane,
)
from vectorplot.features.implicit.implicit_refinement import curve_in_space, refined_chords
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.implicit_tracing import (
    ImplicitCurves,
    ImplicitTracing,
    all_curves,
    curves_of_lines,
    mesh_of,
    no_curves,
)
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT


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
