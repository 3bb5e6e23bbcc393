import numpy as np
import pytest

from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_graph, formula_surface
from vectorplot.surfaces.graphs import Disc, graph, graph_over_disc
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-2.0, 2.0, -2.0, 2.0)


def formulas(*texts: str, variables: tuple[str, ...] = ("x", "y")) -> Formulas:
    return Formulas(tuple(parse_expression(text, variables) for text in texts))


ENDLESS = [
    *("1/(x^2+y^2)", "0.3/hypot(x,y)", "1/(x*y)", "x^y", "log(x^2+y^2)", "log(x)", "tan(x)", "1/(x-1/3)", "y/x"),
    *("exp(1/x)", "abs(x)^-0.1", "1/(x^2-y)", "1/cos(hypot(x,y))", "1e9/(x^2+y^2)", "1e-9/(x^2+y^2)"),
]


@pytest.mark.parametrize("text", ENDLESS)
def test_functions_that_run_to_infinity_are_cut_off_at_their_inner_fences(text: str) -> None:
    surface = formula_graph(formulas(text), SQUARE)
    assert surface.heights.limits is not None
    low, high = (float(limit[0]) for limit in surface.heights.limits)
    x, y = (a.ravel() for a in np.meshgrid(*SQUARE.grid(73, 71), indexing="ij"))
    with np.errstate(all="ignore"):
        free = formulas(text)(x, y)
    shown = surface.points(x, y)[:, 2]
    inside = np.isfinite(free) & (free >= low) & (free <= high)
    assert (np.isfinite(shown) == inside).all() and (shown[inside] == free[inside]).all()
    # Most of it is still there.
    assert inside.sum() > 0.6 * np.isfinite(free).sum()
    for slopes in surface.partials(x, y):
        assert not np.isfinite(slopes[~inside]).any()


ENDING = [
    *("atan2(y,x)", "sin(1/hypot(x,y))", "exp(5*x)", "1/(x^2+y^2+1e-4)", "exp(-1000*(x^2+y^2))", "sqrt(4-x^2-y^2)"),
    *("x*y/(x^2+y^2)", "cbrt(x)", "x^2+y^2", "hypot(x,y)^4", "floor(x)", "0*x+3", "sin(3*x)*cos(2*y)"),
]


@pytest.mark.parametrize("text", ENDING)
def test_functions_that_have_an_end_are_whole(text: str) -> None:
    assert formula_graph(formulas(text), SQUARE).heights.limits is None


def test_discs_surfaces_of_formulas_and_slow_functions_are_cut_off_too() -> None:
    assert graph_over_disc(lambda x, y: 1.0 / np.hypot(x, y), Disc(2.0)).plane.heights.limits is not None
    pole = formulas("u", "v", "1/u", variables=("u", "v"))
    surface = formula_surface(pole, Domain(-1.0, 1.0, 0.0, 1.0))
    limits = surface.function.limits
    assert limits is not None and np.isfinite(limits[0]).tolist() == [False, False, True]

    def one_at_a_time(x: float, y: float) -> float:
        return 1.0 / (x * x + y * y) if x else 0.0

    with pytest.warns(UserWarning):
        assert graph(one_at_a_time, SQUARE).heights.limits is not None
