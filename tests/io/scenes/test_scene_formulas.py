"""Surfaces of formulas and of functions: all that is asked of them at once, and their exact derivatives."""

import numpy as np
import pytest

from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import (
    Formulas,
    formula_graph,
    formula_graph_over_disc,
    formula_implicit,
    formula_surface,
)
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import Disc, graph
from vectorplot.surfaces.surface import Domain, first_jets, second_jets

SQUARE = Domain(-1.0, 1.0, -1.0, 1.0)


def formulas(variables: str, *texts: str) -> Formulas:
    return Formulas(tuple(parse_expression(text, tuple(variables)) for text in texts))


SURFACES = {
    "graph": formula_graph(formulas("xy", "sin(x)*cos(y) + x^3"), SQUARE),
    "infinite slopes": formula_graph(formulas("xy", "sqrt(x) + y^2"), SQUARE),
    "cut off": formula_graph(formulas("xy", "1/(x - 0.1)"), SQUARE),
    "disc": formula_graph_over_disc(formulas("xy", "x^2*y"), Disc(1.0), hole=0.2),
    "of Python": graph(lambda x, y: np.sqrt(x) * np.cos(y), SQUARE),
    "not analytic": graph(lambda x, y: np.abs(np.asarray(x)) * y.real, SQUARE),
    "points of Python": surface_of_function(lambda u, v: (u, v, u * np.exp(v)), SQUARE),
    "three": formula_surface(formulas("uv", "u", "v", "u^2*exp(v) + sqrt(u)"), SQUARE),
}


@pytest.mark.parametrize("name", SURFACES)
def test_at_once_and_one_after_the_other_are_the_same(name):
    surface = SURFACES[name]
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, 5), np.linspace(-1.0, 1.0, 7), indexing="ij")
    alone = surface.points(u, v), *surface.partials(u, v), *surface.second_partials(u, v)
    for found, expected in zip(second_jets(surface, u, v), alone, strict=True):
        assert np.array_equal(found, expected, equal_nan=True)
    for found, expected in zip(first_jets(surface, u, v), alone[:3], strict=True):
        assert np.array_equal(found, expected, equal_nan=True)


def test_a_slope_without_end_takes_no_point_away():
    points, along_u, along_v = first_jets(SURFACES["infinite slopes"], np.array([0.0]), np.array([0.5]))
    assert points.tolist() == [[0.0, 0.5, 0.25]]
    assert np.isnan(along_u).all()
    assert along_v.tolist() == [[0.0, 1.0, 1.0]]


@pytest.mark.parametrize("name", ["graph", "disc"])
def test_second_derivatives_are_exact(name):
    surface, h = SURFACES[name], 2.0**-12
    u, v = np.full(3, 0.5), np.array([-0.3, 0.1, 0.7])
    uu, uv, vv = surface.second_partials(u, v)
    by_u = [(b - a) / (2 * h) for a, b in zip(surface.partials(u - h, v), surface.partials(u + h, v), strict=True)]
    by_v = (surface.partials(u, v + h)[1] - surface.partials(u, v - h)[1]) / (2 * h)
    for found, expected in ((uu, by_u[0]), (uv, by_u[1]), (vv, by_v)):
        assert np.allclose(found, expected, rtol=0.0, atol=10 * h * h)


def test_second_derivatives_of_an_implicit_formula():
    surface = formula_implicit(formulas("xyz", "x^2*y + y*z^3 - sin(x*z)"), np.array([[-1.0] * 3, [1.0] * 3]))
    x, y, z = 0.3, -0.4, 0.7
    sine, cosine = np.sin(x * z), np.cos(x * z)
    xz, yz = x * z * sine - cosine, 3 * z * z
    expected = [[2 * y + z * z * sine, 2 * x, xz], [2 * x, 0.0, yz], [xz, yz, 6 * y * z + x * x * sine]]
    assert np.allclose(surface.hessians(np.array([[x, y, z]]))[0], expected, rtol=1e-14, atol=1e-14)
