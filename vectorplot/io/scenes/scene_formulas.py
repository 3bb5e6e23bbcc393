"""Surfaces and curves given by formulas in a scene file, with the exact derivatives of the formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, at_once
from vectorplot.curves.function_curve import FunctionCurve, curve_of_function
from vectorplot.io.expressions.expression import Expression
from vectorplot.io.expressions.expression_nodes import Nodes, Program
from vectorplot.surfaces.function_surface import FunctionSurface, surface_of_function
from vectorplot.surfaces.graphs.graph import Graph, PolarGraph, graph, graph_over_disc
from vectorplot.surfaces.graphs.graph_regions import Disc
from vectorplot.surfaces.implicit_function import ImplicitFunction, implicit_of_function
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True)
class Formulas:
    """One formula, or several that are the components of a vector, all in the same variables, as one function."""

    expressions: tuple[Expression, ...]

    def __call__(self, *parameters: Any) -> Any:
        """The values at arrays of parameters, in the order of the variables; a single one where none of these counts.
        Real parameters stay real beside complex ones."""
        results = self._program(dict(zip(self.expressions[0].variables, parameters, strict=True)))
        return tuple(results) if len(results) > 1 else results[0]

    @cached_property
    def _program(self) -> Program:
        # What the components have in common is computed a single time.
        nodes = Nodes()
        results = [nodes.joined(expression.nodes) for expression in self.expressions]
        return Program.of(nodes.nodes, results)

    def derivative(self, variable: str) -> Formulas:
        """The derivatives of all components."""
        return Formulas(tuple(expression.derivative(variable) for expression in self.expressions))

    def gradient(self) -> Formulas:
        """The derivatives of a single formula by all its variables."""
        (expression,) = self.expressions
        return Formulas(tuple(expression.derivative(variable) for variable in expression.variables))


def formula_curve(formulas: Formulas, start: float, end: float, *, closed: bool) -> FunctionCurve:
    """The curve of three formulas in t."""
    return curve_of_function(formulas, start, end, closed=closed, derivative=formulas.derivative("t"))


def formula_surface(formulas: Formulas, domain: Domain) -> FunctionSurface:
    """The surface of three formulas in u and v."""
    by_u, by_v = formulas.derivative("u"), formulas.derivative("v")
    second = (by_u.derivative("u"), by_u.derivative("v"), by_v.derivative("v"))
    surface = surface_of_function(formulas, domain, partials=(by_u, by_v), second_partials=second)
    return replace(surface, jets=_jets(surface.function, formulas, (by_u, by_v), second))


def formula_graph(formulas: Formulas, domain: Domain) -> Graph:
    """The graph of a formula in x and y above a rectangle."""
    slopes = formulas.derivative("x"), formulas.derivative("y")
    return _with_jets(graph(formulas, domain, slopes=slopes), formulas, slopes)


def formula_graph_over_disc(formulas: Formulas, disc: Disc, *, hole: float) -> PolarGraph:
    """The graph of a formula in x and y above a disc."""
    slopes = formulas.derivative("x"), formulas.derivative("y")
    polar = graph_over_disc(formulas, disc, hole=hole, slopes=slopes)
    return replace(polar, plane=_with_jets(polar.plane, formulas, slopes))


def formula_implicit(formulas: Formulas, box: Floats) -> ImplicitFunction:
    """The surface on which a formula in x, y and z is zero, within a box (2,3)."""
    gradient = formulas.gradient()
    by_x, by_y, by_z = (Formulas((slope,)) for slope in gradient.expressions)
    bends = (
        [by_x.derivative(name) for name in "xyz"] + [by_y.derivative(name) for name in "yz"] + [by_z.derivative("z")]
    )
    surface = implicit_of_function(formulas, box, gradient=gradient)
    return replace(surface, bends=at_once(surface.function, _joined(bends), len(bends)))


def _with_jets(surface: Graph, height: Formulas, slopes: tuple[Formulas, Formulas]) -> Graph:
    """A graph with the exact derivatives of its formula, all at once."""
    by_x, by_y = slopes
    second = (by_x.derivative("x"), by_x.derivative("y"), by_y.derivative("y"))
    return replace(surface, jets=_jets(surface.heights, height, slopes, second))


def _jets(
    function: NumericFunction, formulas: Formulas, first: Sequence[Formulas], second: Sequence[Formulas]
) -> tuple[NumericFunction, ...]:
    """Values and first derivatives at once, and these with the second ones; none where the function is cut off."""
    if function.limits is not None:
        return ()
    kinds = ((formulas, *first), (formulas, *first, *second))
    return tuple(at_once(function, _joined(parts), len(parts)) for parts in kinds)


def _joined(parts: Sequence[Formulas]) -> Formulas:
    return Formulas(tuple(expression for part in parts for expression in part.expressions))
