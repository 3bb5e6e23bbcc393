"""The rims of the holes of a surface: lines inside its domain at which it ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.holes.holed_triangles import cut_at_holes
from vectorplot.features.parametric.holes.holes import beside_rim_chords, is_known
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import closed_round
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT

FINER = 2
"""Times as many columns and rows as other curves are traced on: a hole that no point of them is in may be missed."""


def hole_rims(surface: Surface, tracing: Tracing) -> SurfaceCurves:
    """The lines inside the domain at which a surface ends, because its points are not finite beyond: the rims of its
    holes, and of what is cut off where it runs to infinity; the hole is to their right.

    Degenerate: rims that run over a seam are cut there; holes smaller than half a cell of the grid may be missed.
    """
    domain = surface.domain
    columns, rows = FINER * tracing.columns, FINER * tracing.rows
    places = np.stack(np.meshgrid(*domain.grid(columns, rows), indexing="ij"), axis=-1).reshape(-1, 2)
    known = is_known(surface, places)
    if known.all() or not known.any():
        return no_curves()
    lower = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    right, upper = lower + rows + 1, lower + 1
    triangles = np.concatenate([np.stack([lower, right, right + 1], 1), np.stack([lower, right + 1, upper], 1)])
    cut = cut_at_holes(surface, places, triangles, known)
    if not len(cut.rims):
        return no_curves()
    branches = concat(cut.rims)
    lines = Traces.of(cut.places[branches.points], closed_round(branches))
    size = extent(surface)[0]
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance

    def image(places: Floats) -> Floats:
        points = surface.points(*wrapped(domain, *places.T))
        return points if tracing.picture is None else tracing.picture(points)

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return beside_rim_chords(surface, start, end, part)

    # Without a tolerance nothing is cut.
    finer = refined(lines, between, image, tolerance or np.inf, tracing.budget.points)
    kept, offsets = finer.lines.unrepeated(branches.closed)
    u, v = np.ascontiguousarray(finer.lines.points[kept].T)
    enough = bool(finer.enough.all())
    return replace(
        no_curves() if enough else no_curves((unresolved("rims of holes are off by more than the tolerance"),)),
        u=u,
        v=v,
        points=surface.points(*wrapped(domain, u, v)),
        offsets=offsets,
        closed=branches.closed,
        turns=np.zeros((len(branches), 2), dtype=np.intp),
        levels=np.zeros(len(branches)),
    )
