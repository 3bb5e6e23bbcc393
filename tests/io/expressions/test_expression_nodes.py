"""Several expressions evaluated as one."""

import numpy as np
import pytest

from vectorplot.io.expressions import OPERATIONS, Nodes, Program, parse_expression


def programmed(*texts: str) -> Program:
    nodes = Nodes()
    results = [nodes.joined(parse_expression(text, ("x", "y")).nodes) for text in texts]
    return Program.of(nodes.nodes, results)


def test_each_expression_has_its_own_value():
    x, y = np.linspace(-2.0, 2.0, 7), np.linspace(3.0, 4.0, 7)
    square, shared, plain, number = programmed("x^2 + y", "sin(x^2 + y)", "y", "2*3")({"x": x, "y": y})
    assert np.array_equal(square, x * x + y)
    assert np.array_equal(shared, np.sin(square))
    assert np.array_equal(plain, y)
    assert number == 6.0


@pytest.mark.parametrize("exponent", [2, 3, 4, 5, -2, 0.5])
def test_powers_are_those_of_numpy(exponent):
    x = np.array([-np.inf, -1e200, -1.5, -0.0, 0.0, 0.7, 1e-200, 3.0, np.inf, np.nan])
    (found,) = programmed(f"x^{exponent}")({"x": x})
    with np.errstate(all="ignore"):
        assert np.allclose(found, x**exponent, rtol=1e-15, atol=0.0, equal_nan=True)
        (turned,) = programmed(f"x^{exponent}")({"x": 1.5 + 0.5j * np.ones(2)})
        assert np.allclose(turned, (1.5 + 0.5j) ** exponent, rtol=1e-14)


def test_what_is_equal_is_computed_once(monkeypatch):
    asked: list[int] = []
    monkeypatch.setitem(OPERATIONS, "sin", lambda x: asked.append(len(x)) or np.sin(x))
    programmed("sin(x) + 1", "2*sin(x)")({"x": np.zeros(3)})
    assert asked == [3]
