"""Singular lines of implicit surfaces as curves, as fine as is asked for."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.implicit.implicit_tracing import ImplicitCurves, ImplicitTracing, curves_of_lines, no_curves
from vectorplot.features.implicit.singular.implicit_singular_lines import STRAYS
from vectorplot.features.implicit.singular.singular_equations import SingularEquations, onto_lines
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.polylines import Polylines, closed_round
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


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
