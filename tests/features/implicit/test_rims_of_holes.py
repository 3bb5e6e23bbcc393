"""Implicit surfaces that end where their equation does, with a gradient without bound."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.implicit_curves import ImplicitTracing, implicit_borders, implicit_contour
from vectorplot.features.implicit_meshes import implicit_mesh
from vectorplot.surfaces import implicit_of_function

BOX = ((-1.2, -1.2, -1.0), (1.2, 1.2, 1.0))


def bowl(power: float):
    """z = 1/2 - (1 - r^2)^(1/power), up to the circle r = 1 in which points of usual lattices lie."""
    return implicit_of_function(lambda x, y, z: (0.5 - z) ** power + x**2 + y**2 - 1.0, BOX)


@pytest.mark.parametrize("cells", [24, 48])
def test_the_rim_has_no_notches(cells: int) -> None:
    tracing = ImplicitTracing(mesh=implicit_mesh(bowl(0.5), cells))
    rims = implicit_borders(bowl(0.5), tracing=tracing)
    at_rim = rims.points[np.abs(rims.points[:, 2] - 0.5) < 1e-9]
    assert len(at_rim) == len(rims.points)
    assert len(rims) == 1 and rims.closed.all()


@pytest.mark.slow
@pytest.mark.parametrize("power", [0.5, 0.6])
def test_contours_beside_the_rim_have_no_gaps(power: float) -> None:
    found = implicit_contour(bowl(power), (4.0, -6.0, 3.0))
    assert len(found) == 1 and found.closed.all()
