"""Conditions on implicit surfaces: their gradients against differences."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.conditions import ImplicitCentralContour, ImplicitIsophote, ImplicitPointIsophote, MeetsPlane
from vectorplot.surfaces.quadrics import implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus

TORUS = ImplicitTorus(3.0, 1.0)
CONDITIONS = {
    "central": ImplicitCentralContour(TORUS, (8, -3, 6)),
    "parallel": ImplicitIsophote(TORUS, (1, 2, 3)),
    "isophote": ImplicitIsophote(TORUS, (2, 1, 3), 0.3),
    "point isophote": ImplicitPointIsophote(TORUS, (5, 1, 3), 0.3),
    "implicit": implicit_sphere(2.0),
    "plane": MeetsPlane((1, 2, 3), 0.4),
}


@pytest.mark.parametrize("condition", CONDITIONS.values(), ids=CONDITIONS.keys())
def test_gradients_are_the_derivatives_of_values(condition):
    p = np.random.default_rng(1).uniform(-4, 4, size=(40, 3))
    h = 1e-5
    moved = [(condition.values(p + h * e) - condition.values(p - h * e)) / (2 * h) for e in np.eye(3)]
    gradients = condition.gradients(p)
    assert np.abs(gradients - np.stack(moved, axis=-1)).max() < 1e-6 * np.abs(gradients).max()
    grid = condition.values(p.reshape(5, 8, 3))
    assert np.array_equal(grid.ravel(), condition.values(p))


def test_wrong_numbers_are_named():
    for make in (lambda: ImplicitCentralContour(TORUS, (1, 2)), lambda: MeetsPlane((0, 0, 1), np.nan)):
        with pytest.raises(InputError):
            make()
    with pytest.raises(InputError, match="cosine"):
        ImplicitIsophote(TORUS, (0, 0, 1), 1.5)
