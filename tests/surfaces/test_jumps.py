import numpy as np
import pytest

from vectorplot.features.edge_splitting import Within
from vectorplot.features.tessellation import facets
from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_graph
from vectorplot.surfaces.graphs import Graph
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import StackedSurfaces, jumping_cells, jumps
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus

SQUARE = Domain(-2.0, 2.0, -2.0, 2.0)


def alone(own: Graph) -> StackedSurfaces:
    return StackedSurfaces((PlacedSurface(own, np.eye(3)),))


def surface(text: str) -> Graph:
    return formula_graph(Formulas((parse_expression(text, ("x", "y")),)), SQUARE)


@pytest.mark.slow
@pytest.mark.parametrize("text", ["atan2(y,x)", "floor(x)"])
def test_no_triangle_and_no_cell_bridges_a_jump(text: str) -> None:
    own = surface(text)
    mesh = facets(own, Within(lambda points: np.full(points.shape[:-1], 0.01))).mesh
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    assert len(corners) > 4
    steep = np.ptp(corners[..., 2], axis=1) / np.ptp(corners[..., :2], axis=1).max(axis=1)
    # Beside the origin atan2 is as steep as it likes.
    away = np.linalg.norm(corners[..., :2].mean(axis=1), axis=1) > 0.5
    assert steep[away].max() < 5.0
    u, v = SQUARE.grid(31, 29)
    points = own.points(*np.meshgrid(u, v, indexing="ij"))
    whole = ~jumping_cells(alone(own), u[None], v[None], points[None])[0]
    heights = points[..., 2]
    high = np.maximum.reduce([heights[1:, 1:], heights[:-1, 1:], heights[1:, :-1], heights[:-1, :-1]])
    low = np.minimum.reduce([heights[1:, 1:], heights[:-1, 1:], heights[1:, :-1], heights[:-1, :-1]])
    middle = np.hypot(*np.meshgrid(u[:-1] + np.diff(u) / 2, v[:-1] + np.diff(v) / 2, indexing="ij"))
    assert ((high - low)[whole & (middle > 0.5)] < 0.9).all()


@pytest.mark.parametrize("text", ["cbrt(x)", "sqrt(4-x^2-y^2)", "abs(x)", "exp(5*x)", "sin(30*x)", "1/(x^2+y^2+1e-4)"])
def test_what_is_only_steep_does_not_jump(text: str) -> None:
    own = surface(text)
    u, v = SQUARE.grid(31, 29)
    points = own.points(*np.meshgrid(u, v, indexing="ij"))
    assert not jumping_cells(alone(own), u[None], v[None], points[None]).any()


def test_jumps_are_told_one_by_one() -> None:
    start, end = np.array([[-1.0, -0.5], [1.0, -0.5], [-1.0, 0.1]]), np.array([[-1.0, 0.3], [1.0, 0.3], [-1.0, 0.3]])
    assert jumps(surface("atan2(y,x)"), start, end).tolist() == [True, False, False]
    assert not jumps(Torus(), np.zeros((3, 2)), np.array([[0.0, 6.0], [3.0, 3.0], [0.1, 0.0]])).any()
